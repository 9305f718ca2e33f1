"""Conservative weights on the sphere compared with YAC, their application, and memory; in turns.

Both make their cells from the same arrays of corners in the timed call, and use one thread. YAC is
left out where it is not installed; it needs an MPI library, such as the package ``openmpi``. Areas
in the plane are compared with ``geopandas.overlay``, and transferred columns with tobler, if these
are installed. Memory is what grids, overlaps and weights need beyond what the process held, in a
process of its own.
``python benchmarks/regrid.py --help`` has options.
"""

import argparse
import contextlib
import importlib.util
import itertools
import subprocess
import sys
import time
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import memory
import numpy as np
from sphere import Calls, directions, table

from delone import Overlaps, Voronoi, datasets, sphere

# The second grid of most rows, in degrees.
LON, LAT = np.arange(361.0), np.arange(-90.0, 91.0)
NAMES = map("grid {}".format, itertools.count())
# Widths of cells, in radians: from 290 km on the Earth to 3 cm.
WIDTHS = 4.5e-2, 5e-4, 5e-5, 5e-6, 5e-8, 5e-9
# Levels times months of a field.
FIELDS = 47 * 12


class Cells:
    """Polygons by the places of their corners, as both programs take them."""

    def __init__(self, vectors: Any, starts: Any, digits: int = 12) -> None:
        # Corners that differ by rounding are one.
        _, first, self.corners = np.unique(
            vectors.round(digits), axis=0, return_index=True, return_inverse=True
        )
        self.corners, self.starts = self.corners.ravel(), starts
        self.places = vectors[first]
        x, y, z = self.places.T
        self.lonlat = np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))

    def delone(self, workers: int = 1) -> sphere.Grid:
        """A grid of delone."""
        corners = self.places[self.corners]
        return sphere.Grid.from_mesh(corners, self.starts, merge=0.0, workers=workers)

    def yac(self, yac: Any) -> Any:
        """A grid of YAC."""
        counts = np.diff(self.starts).astype(np.int32)
        corners = self.corners.astype(np.int32)
        return yac.BasicGrid.unstruct_new(next(NAMES), counts, *self.lonlat, corners)


class Degrees:
    """Cells of one degree between meridians and parallels."""

    def delone(self, workers: int = 1) -> sphere.Grid:
        """A grid of delone."""
        return sphere.Grid.from_lonlat(LON, LAT, workers=workers)

    def yac(self, yac: Any) -> Any:
        """A grid of YAC."""
        lon, lat = np.radians(LON), np.radians(LAT)
        return yac.BasicGrid.reg_2d_new(next(NAMES), lon[:-1], lat, cyclic=[True, False])


def cubed_sphere(n: int) -> Cells:
    """The cells of a cubed sphere with n rows of equal angles on each face."""
    turns = np.tan(np.linspace(-np.pi / 4, np.pi / 4, n + 1))
    x, y = np.meshgrid(turns, turns)
    face = np.stack((np.ones_like(x), x, y), axis=2)
    around = (face[:-1, :-1], face[:-1, 1:], face[1:, 1:], face[1:, :-1])
    one = np.stack(around, axis=2).reshape(-1, 3)
    sides = [one, one * (-1, -1, 1)]
    corners = np.concatenate([np.roll(side, k, axis=1) for side in sides for k in range(3)])
    corners /= np.linalg.norm(corners, axis=1)[:, None]
    return Cells(corners, np.arange(len(corners) // 4 + 1) * 4)


def healpix(nside: int) -> Cells:
    """The pixels of HEALPix."""
    corners = sphere.Grid.from_healpix(nside).rings[0]
    return Cells(corners, np.arange(len(corners) // 4 + 1) * 4)


def voronoi(count: int, seed: int) -> Cells:
    """The Voronoi cells of directions."""
    made = sphere.Grid.from_voronoi(sphere.Voronoi(xyz=directions(count, seed)))
    return Cells(*made.rings[:2])


def patch(width: float, share: float, seed: int) -> Cells:
    """Voronoi cells of a mean width in a square, whose side is a share of 25 such widths."""
    center, east, north = np.array([(0.48, 0.6, 0.64), (0.8, 0.0, -0.6), (-0.36, 0.8, -0.48)])
    half = 12.5 * width * share
    count = round((25 * share) ** 2)
    x, y = np.random.default_rng(seed).uniform(-half, half, (2, count, 1))
    sites = np.concatenate((center + x * east + y * north, directions(300, 9)))
    vectors, starts, _ = sphere.Grid.from_voronoi(sphere.Voronoi(xyz=sites)).rings
    # Without the cells at the edge, whose corners are far away.
    flat = vectors / (vectors @ center)[:, None] - center
    inside = (np.abs(flat).max(axis=1) < half) & (vectors @ center > 0)
    whole = np.minimum.reduceat(inside, starts[:-1])
    counts = np.diff(starts)
    corners = vectors[np.repeat(whole, counts)]
    return Cells(corners, np.append(0, np.cumsum(counts[whole])), digits=20)


def ours(source: Any, target: Any, workers: int = 1) -> Any:
    """Weights of delone, from arrays."""
    grids = source.delone(workers), target.delone(workers)
    return sphere.Overlaps(*grids, workers=workers).to_weights("conservative")


def theirs(
    yac: Any, source: Any, target: Any, sizes: tuple[int, int], rest: float | None = None
) -> Any:
    """Weights of YAC, from arrays; centers are not used, but must be there.

    Cells that are not covered get the value `rest`; by default, YAC leaves them as they are.
    """
    place, fields = yac.yac_location.YAC_LOC_CELL, []
    for cells, count in zip((source, target), sizes, strict=True):
        grid = cells.yac(yac)
        field = yac.InterpField(grid.add_coordinates(place, np.zeros(count), np.zeros(count)))
        grid.set_global_index(place, np.arange(count))
        fields.append((grid, field))
    stack = yac.InterpolationStack()
    stack.add_conservative(
        order=1,
        enforced_conserv=False,
        partial_coverage=False,
        normalisation=yac.yac_interp_method_conserv_normalisation.YAC_INTERP_CONSERV_DESTAREA,
    )
    if rest is not None:
        stack.add_fixed(rest)
    return yac.compute_weights(stack, fields[0][1], fields[1][1])


def beside_yac(cases: dict[str, tuple[Any, Any]], runs: int) -> None:
    """Weights by both, and how far each is from constants."""
    yac: Any = SimpleNamespace()
    with contextlib.suppress(ImportError):
        import yac.core as yac
    for title, (source, target) in cases.items():
        weights = ours(source, target)
        sizes = len(weights.source_areas), len(weights.target_areas)
        calls: Calls = {
            "delone": lambda s=source, t=target: ours(s, t),
            "delone, two workers": lambda s=source, t=target: ours(s, t, 2),
        }
        ones = np.ones(sizes[0])
        off = abs(weights.apply(ones) - 1).max()
        print(f"\n{title}: {len(weights.values):,} weights; constants differ by {off:.1e}", end="")
        if hasattr(yac, "compute_weights"):
            calls["YAC"] = lambda s=source, t=target, n=sizes: theirs(yac, s, t, n)
            applied = calls["YAC"]().get_interpolation(collection_size=1)
            off = abs(applied(ones[None]) - 1).max()
            print(f", and by {off:.1e} of YAC", end="")
        print()
        table(title, calls, runs)


def beside_yac_by_size() -> None:
    """How far constants are from themselves, for cells of different sizes.

    All cells of the target are covered. YAC leaves out those of which it finds less.
    """
    yac: Any = SimpleNamespace()
    with contextlib.suppress(ImportError):
        import yac.core as yac
    print("\n| width of cells, radians | weights | cells | delone | YAC | not mapped by YAC |")
    print("|---|---|---|---|---|---|")
    for width in WIDTHS:
        source, target = patch(width, 1.0, 1), patch(width, 0.6, 2)
        weights = ours(source, target)
        sizes = len(weights.source_areas), len(weights.target_areas)
        ones = np.ones(sizes[0])
        off = f"{abs(weights.apply(ones) - 1).max():.1e}"
        other, left = "-", "-"
        if hasattr(yac, "compute_weights"):
            applied = theirs(yac, source, target, sizes, -1.0).get_interpolation(collection_size=1)
            found = np.ravel(applied(ones[None]))
            # No share of a field of ones is negative.
            mapped = found[found >= 0]
            other = f"{abs(mapped - 1).max():.1e}" if len(mapped) else "-"
            left = f"{len(found) - len(mapped)}"
        count = f"{len(weights.values):,} | {sizes[1]}"
        print(f"| {width:g} | {count} | {off} | {other} | {left} |", flush=True)


def hexagons(bounds: Any, side: float) -> Any:
    """Hexagons over a box, whose neighbors share their corners exactly."""
    import geopandas
    import shapely

    left, bottom, right, top = bounds
    width, height = np.sqrt(3) * side, 1.5 * side
    rows = np.arange(int((top - bottom) / height) + 2)
    columns = np.arange(int((right - left) / width) + 2)
    row, column = (x.ravel() for x in np.meshgrid(rows, columns))
    across = 2 * column[:, None] + row[:, None] % 2 + np.array([1, 0, -1, -1, 0, 1])
    up = 3 * row[:, None] + np.array([1, 2, 1, -1, -2, -1])
    corners = np.stack((left + across * width / 2, bottom + up * side / 2), axis=2)
    return geopandas.GeoDataFrame(geometry=list(shapely.polygons(corners)))


def beside_overlay(runs: int) -> None:
    """Areas that polygons share with hexagons, in the plane."""
    import geopandas
    import shapely

    sites = np.random.default_rng(1).random((20_000, 2))
    districts = Voronoi(sites, clip=(0, 0, 1, 1)).polygons()
    whole = shapely.get_parts(shapely.geometry.shape(datasets.land()))
    # On an equal-area map, in kilometers.
    to_map = lambda x: 6371 * np.column_stack((np.radians(x[:, 0]), np.sin(np.radians(x[:, 1]))))  # noqa: E731
    land = shapely.make_valid(shapely.transform(whole, to_map)).tolist()
    for title, shapes, side in (("districts", districts, 0.005), ("land masses", land, 100.0)):
        source = geopandas.GeoDataFrame(geometry=list(shapes))
        target = hexagons(source.total_bounds, side)
        shared = Overlaps(source, target, workers=1)
        off = np.nanmax(abs(shared.covered_source - 1))
        one, other = (
            x.assign(**{name: range(len(x))}) for x, name in ((source, "i"), (target, "j"))
        )
        calls: Calls = {
            "delone": lambda s=source, t=target: Overlaps(s, t, workers=1),
            "geopandas.overlay": lambda s=one, t=other: geopandas.overlay(s, t).area,
        }
        name = f"{len(source):,} {title} and {len(target):,} hexagons"
        print(f"\n{name}: {len(shared.areas):,} pairs; covered shares differ from 1 by {off:.1e}")
        with warnings.catch_warnings():
            # About pieces that are lines and points.
            warnings.simplefilter("ignore", UserWarning)
            table(name, calls, runs)
        if importlib.util.find_spec("tobler"):
            beside_tobler(name, source, target, runs)


def beside_tobler(name: str, source: Any, target: Any, runs: int) -> None:
    """Amounts and means of polygons, transferred to hexagons."""
    from tobler.area_weighted import area_interpolate

    rng = np.random.default_rng(2)
    data = source.assign(people=rng.integers(1, 1000, len(source)), income=rng.random(len(source)))
    methods = {"people": "sum", "income": "normalized"}

    def shared() -> Any:
        return Overlaps(data, target, workers=1).transfer(data, methods)

    def interpolated() -> Any:
        return area_interpolate(
            data, target, extensive_variables=["people"], intensive_variables=["income"],
            allocate_total=False,
        )  # fmt: skip

    one, other = shared(), interpolated()
    print()
    for column in methods:
        mine, its = np.asarray(one[column]), np.asarray(other[column])
        covered = np.isfinite(mine)
        off = (abs(its - mine)[covered] / mine[covered]).max()
        rest = f"{(its[~covered] == 0).sum()} of {(~covered).sum()} uncovered cells are 0"
        print(f"{column}: tobler differs by {off:.1e} of the value; {rest}")
    lost = [abs(np.nansum(made["people"]) / data.people.sum() - 1) for made in (one, other)]
    print("totals differ by {:.1e}, and by {:.1e} of tobler".format(*lost))
    table(f"{name}, two columns", {"delone": shared, "tobler": interpolated}, runs)


def application(nside: int, runs: int) -> None:
    """Fields of levels and months in float32, and those of which a part is missing."""
    weights = ours(healpix(nside), Degrees())
    shape = FIELDS, len(weights.source_areas)
    fields = np.random.default_rng(0).random(shape, dtype=np.float32)
    parts = np.where(fields < 0.1, np.float32(np.nan), fields)
    calls: Calls = {
        "all values": lambda: weights.apply(fields),
        "a tenth missing": lambda: weights.apply(parts, skipna=True),
    }
    table(f"{FIELDS} fields of {shape[1]:,} cells to 1 degree", calls, runs)


def held(nside: int, step: float) -> None:
    """Print the seconds, the weights, and the bytes at the peak and of what is returned."""
    lon, lat = np.arange(0, 360 + step / 2, step), np.arange(-90, 90 + step / 2, step)
    begin, start = memory.start(), time.perf_counter()
    source = sphere.Grid.from_healpix(nside, workers=1)
    first = memory.peak() - begin
    overlaps = sphere.Overlaps(source, sphere.Grid.from_lonlat(lon, lat), workers=1)
    weights = overlaps.to_weights("conservative")
    seconds = time.perf_counter() - start
    size = weights.values.nbytes + weights.indices.nbytes + weights.indptr.nbytes
    print(source.ncells, len(weights.values), seconds, first, memory.peak() - begin, size)


def peaks(largest: int) -> None:
    """Print the memory of HEALPix to 0.25 degrees, each in a process of its own."""
    print(
        "\n| nside | cells | weights | s | peak MB | of it the grid | bytes a cell | weights MB |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for nside in (largest // 4, largest // 2, largest):
        command = [sys.executable, str(Path(__file__)), "--held", str(nside)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        cells, count, seconds, first, peak, size = map(float, done.stdout.split())
        print(
            f"| {nside} | {cells:,.0f} | {count:,.0f} | {seconds:.3g} | {peak / 1e6:.0f} | "
            f"{first / 1e6:.0f} | {peak / cells:.0f} | {size / 1e6:.0f} |",
            flush=True,
        )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--nside", type=int, default=64, help="of HEALPix beside YAC")
    parser.add_argument("--cube", type=int, default=60, help="rows of a face of the cubed sphere")
    parser.add_argument("--sites", type=int, default=100_000, help="of Voronoi cells")
    parser.add_argument("--largest", type=int, default=256, help="of HEALPix to 0.25 degrees")
    parser.add_argument("--runs", type=int, default=5, help="of each call")
    parser.add_argument("--held", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.held:
        held(options.held, 0.25)
        return
    cases = {
        f"cubed sphere {options.cube} to 1 degree": (cubed_sphere(options.cube), Degrees()),
        f"HEALPix {options.nside} to 1 degree": (healpix(options.nside), Degrees()),
        f"Voronoi {options.sites:,} to {options.sites:,}": (
            voronoi(options.sites, 1),
            voronoi(options.sites, 2),
        ),
    }
    beside_yac(cases, options.runs)
    beside_yac_by_size()
    if importlib.util.find_spec("geopandas"):
        beside_overlay(options.runs)
    application(options.nside, options.runs)
    peaks(options.largest)


if __name__ == "__main__":
    main()
