"""Voronoi diagrams side by side: arrays of whole diagrams, and cells cut to an outline.

    python benchmarks/voronoi.py [--n 1000000] [--cells 100000] [--outline FILE] [--rounds 3]

Each peer works in processes of its own, whose first call is cold and the others warm, and they take
turns, round by round. Whole diagrams: points in, arrays out, for delone, SciPy (vertices, ridges,
regions as SciPy gives them) and, where its headers are installed, CGAL, with its Voronoi adaptor
and straight from its triangulation; shapely's ``voronoi_polygons`` gives geometries. Cut to an
outline: delone's polygons in the order of the sites, against the usual way, ``voronoi_polygons``
and then ``intersection`` of each cell. The outline is the largest polygon of a file of polygons,
such as the land of Natural Earth (of which that is Afro-Eurasia), by default a star of 60,000
corners.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import crates
import numpy as np
import report
import shapely
from adapters import Adapter
from rounds import HEAD, Module, Program, compete

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

# Seconds that a run may take.
LIMIT = 300.0


def star(corners: int = 60_000) -> shapely.Polygon:
    """A ragged outline of many corners, always the same."""
    rng = np.random.default_rng(1)
    angle = np.sort(rng.random(corners)) * 2 * np.pi
    waves = sum(
        rng.random() / k * np.sin(k * angle + 7 * rng.random()) for k in (1, 2, 3, 5, 8, 40)
    )
    radius = 1 + 0.2 * waves + 0.002 * rng.random(corners)
    return shapely.Polygon(np.column_stack((radius * np.cos(angle), radius * np.sin(angle))))


def largest(path: str) -> shapely.Polygon:
    import geopandas

    # GDAL reads compressed files by another name.
    frame = geopandas.read_file(f"/vsigzip/{path}" if path.endswith(".gz") else path)
    parts = shapely.get_parts(np.asarray(frame.geometry.values))
    return parts[np.argmax(shapely.area(parts))]


def within(outline: shapely.Polygon, n: int) -> Any:
    """Uniform sites inside an outline."""
    rng = np.random.default_rng(2)
    left, bottom, right, top = outline.bounds
    shapely.prepare(outline)
    sites = np.empty((0, 2))
    while len(sites) < n:
        more = rng.random((n, 2)) * [right - left, top - bottom] + [left, bottom]
        sites = np.concatenate((sites, more[shapely.contains_xy(outline, more)]))
    return sites[:n]


def delone(workers: int) -> Adapter:
    """Delone's arrays."""
    from delone import Voronoi, __version__

    def call(points: Any) -> Any:
        diagram = Voronoi(points, workers=workers)
        arrays = diagram.vertices, diagram.ridge_points, diagram.ridge_rows
        return *arrays, diagram.region_rows, diagram.point_region

    return Adapter(call, _nothing, __version__)


def scipy() -> Adapter:
    """SciPy's lists."""
    import scipy.spatial

    def call(points: Any) -> Any:
        diagram = scipy.spatial.Voronoi(points)
        return diagram.regions, diagram.ridge_vertices

    return Adapter(call, _nothing, scipy.__version__)


def shapely_cells() -> Adapter:
    """The geometries of shapely."""
    return Adapter(
        lambda points: shapely.get_parts(shapely.voronoi_polygons(shapely.multipoints(points))),
        _nothing,
        shapely.__version__,
    )


def delone_cut() -> Adapter:
    """Delone's polygons inside the outline."""
    from delone import Voronoi, __version__

    def call(given: tuple[Any, Any]) -> Any:
        sites, outline = given
        return Voronoi(sites, clip=outline).polygons()

    return Adapter(call, _nothing, __version__, _sites_and_outline)


def usual_cut() -> Adapter:
    """The usual way: all cells, and then the intersection of each with the outline."""

    def call(given: tuple[Any, Any]) -> Any:
        sites, outline = given
        found = shapely.voronoi_polygons(shapely.multipoints(sites), extend_to=outline.envelope)
        return shapely.intersection(shapely.get_parts(found), outline)

    return Adapter(call, _nothing, shapely.__version__, _sites_and_outline)


def _nothing(points: Any, answer: Any) -> Any:
    """No judge reads the answers."""
    del points, answer
    return np.empty(0)


def _sites_and_outline(file: str) -> tuple[Any, Any]:
    return np.load(file), shapely.from_wkb(Path(file).with_suffix(".wkb").read_bytes())


WHOLE: dict[str, Callable[[], Adapter]] = {
    "delone": lambda: delone(1),
    "delone, 2 workers": lambda: delone(2),
    "scipy": scipy,
    "shapely voronoi_polygons": shapely_cells,
}
CUT: dict[str, Callable[[], Adapter]] = {
    "delone, cut": delone_cut,
    "voronoi_polygons, then intersection": usual_cut,
}
PEERS = WHOLE | CUT
CGAL = ("CGAL Voronoi adaptor", "CGAL, dual by hand")


def table(
    title: str, names: Iterable[str], file: Path, programs: list[Program], given: Any
) -> None:
    """Print the table of one input."""
    peers = [Module(name, file, module="voronoi", limit=LIMIT) for name in names]
    compete([*peers, *programs], given.rounds, given.warm)
    base = peers[0].times
    rows = [[peer.times.name, *peer.times.cells(base)] for peer in [*peers, *programs]]
    print(f"\n{title}\n\n{report.table(['peer', *HEAD], rows)}", flush=True)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--n", type=int, default=1_000_000)
    options.add_argument("--cells", type=int, default=100_000)
    options.add_argument("--outline")
    options.add_argument("--rounds", type=int, default=3, help="processes of each peer")
    options.add_argument("--warm", type=int, default=1, help="warm runs in each")
    given = options.parse_known_args()[0]
    print(report.machine())
    points = np.random.default_rng(0).random((given.n, 2))
    outline = largest(given.outline) if given.outline else star()
    sites = within(outline, given.cells)
    cgal = crates.build_cgal("cgal_voronoi")
    with tempfile.TemporaryDirectory() as folder:
        raw, file, cut = (Path(folder) / name for name in ("points", "whole.npy", "cut.npy"))
        points.astype("<f8").tofile(raw)
        np.save(file, points)
        np.save(cut, sites)
        cut.with_suffix(".wkb").write_bytes(shapely.to_wkb(outline))
        programs = [Program(cgal, raw, name, name) for name in CGAL] if cgal else []
        table(f"{given.n:,} uniform sites, whole diagram", WHOLE, file, programs, given)
        corners = shapely.get_num_coordinates(outline)
        title = f"{given.cells:,} sites in an outline of {corners:,} corners"
        table(title, CUT, cut, [], given)


if __name__ == "__main__":
    main()
