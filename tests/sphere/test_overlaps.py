"""Overlaps of grids: sums, known counts, what changes nothing, files, and refused arguments."""

from __future__ import annotations

import itertools
import json
import pickle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import _core, sphere
from delone.errors import DtypeError, InputError
from delone.sphere import Grid, Overlaps
from tiers import seeds

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def degrees(step: float) -> Grid:
    return Grid.from_lonlat(np.arange(0, 361, step), np.arange(-90, 91, step))


def cubed(n: int) -> Floats:
    """Corners of the cells of a cubed sphere, (6 n^2, 4, 3)."""
    t = np.tan(np.linspace(-np.pi / 4, np.pi / 4, n + 1))
    t = (t - t[::-1]) / 2
    t[0], t[-1] = -1, 1
    a, b = np.meshgrid(t, t)
    one = np.ones_like(a)
    faces = ((one, a, b), (-a, one, b), (-one, -a, b), (a, -one, b), (-b, a, one), (b, a, -one))
    found = []
    for face in faces:
        v = np.stack(face, axis=-1)
        found.append(np.stack((v[:-1, :-1], v[:-1, 1:], v[1:, 1:], v[1:, :-1]), axis=2))
    return np.concatenate([x.reshape(-1, 4, 3) for x in found])


def worst(overlaps: Overlaps) -> float:
    shares = overlaps.covered_source, overlaps.covered_target
    return max(float(abs(share - 1).max()) for share in shares)


def test_nested_grids_have_the_pairs_of_theory() -> None:
    coarse, fine = Grid.from_mesh(cubed(4)), Grid.from_mesh(cubed(8))
    assert len(Overlaps(coarse, fine).areas) == 384
    same = Overlaps(coarse, coarse)
    assert np.array_equal(same.indices, np.arange(96))
    assert np.allclose(same.areas, coarse.areas, rtol=1e-15)
    # Cells with arcs in rows: a northern side bulges into the next row, except at the equator.
    lon, lat = np.meshgrid(np.arange(0, 361, 10.0), np.arange(-90, 91, 10.0))
    arcs = Grid.from_curvilinear(lon, lat)
    found = Overlaps(arcs, degrees(10))
    assert len(found.areas) == 648 + 16 * 36
    assert worst(found) < 1e-14
    halves = Overlaps(degrees(5), degrees(10))
    assert len(halves.areas) == degrees(5).ncells


@pytest.mark.parametrize("seed", seeds(3, deep=40))
def test_rotated_grids_conserve(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    source = Grid.from_mesh(cubed(6) @ turn)
    for target in (
        degrees(15),
        Grid.from_healpix(4),
        Grid.from_gaussian(4, "octahedral"),
        Grid.from_mesh(cubed(6)),
        Grid.from_voronoi(sphere.Voronoi(xyz=rng.normal(size=(80, 3)))),
        Grid.from_lonlat([0, 360], np.arange(-90, 91, 18.0)),
    ):
        there, back = Overlaps(source, target), Overlaps(target, source)
        assert worst(there) < 1e-14
        assert worst(back) < 1e-14
        assert abs(there.areas.sum() / (4 * np.pi) - 1) < 1e-14
        assert len(there.areas) == len(back.areas)
        assert abs(there.matrix - back.matrix.T).max() < 1e-15


# The last one has cells of 3 cm on the Earth.
@pytest.mark.parametrize("size", [0.3, 1e-3, 1e-6, 5e-8])
def test_small_cells_are_as_right_as_large_ones(size: float) -> None:
    center, rng = np.array([0.3, -0.7, 0.4]), np.random.default_rng(2)
    a, b = np.linalg.svd(center[None])[2][1:]
    t = np.linspace(-1, 1, 6)
    x, y = np.meshgrid(t, t)

    def grid(angle: float, width: float) -> Grid:
        u = width * (np.cos(angle) * x - np.sin(angle) * y)
        v = width * (np.sin(angle) * x + np.cos(angle) * y)
        place = center / np.linalg.norm(center) + u[..., None] * a + v[..., None] * b
        around = place[:-1, :-1], place[:-1, 1:], place[1:, 1:], place[1:, :-1]
        return Grid.from_mesh(np.stack(around, axis=2).reshape(-1, 4, 3), merge=0)

    inner, outer = grid(rng.uniform(0, 1), size / 4), grid(0.0, size)
    assert abs(Overlaps(inner, outer).covered_source - 1).max() < 2e-15


def test_rows_that_end_in_a_small_cell() -> None:
    # Products of directions do not tell corners apart that are 1e-8 away from the center.
    ring = [(1, -1e-9, 0), (1, 0, -1e-8), (1, 1e-9, 0), (1, 0, 1e-8)]
    cell = Grid.from_mesh([ring], merge=0)
    edges = np.degrees(1e-8 * np.linspace(-1, 1, 9))
    parts = [
        Overlaps(cell, Grid.from_lonlat([-1, 1], edges[k : k + 2])).areas.sum() for k in range(8)
    ]
    assert parts == pytest.approx(parts[::-1], rel=1e-9)
    assert sum(parts) == pytest.approx(cell.areas[0], rel=1e-12)


def test_how_cells_are_written_changes_no_bit() -> None:
    rng, corners = np.random.default_rng(5), cubed(5)
    cells = []
    for ring in corners:
        k = int(rng.integers(4))
        other = np.roll(ring, k, axis=0)
        if rng.random() < 0.5:
            other = other[::-1]
        cells.append(np.insert(other, k, 4 * other[k], axis=0))
    source, other = Grid.from_mesh(corners), Grid.from_mesh(np.array(cells))
    for target in (Grid.from_healpix(4), degrees(15), source):
        one, two = Overlaps(source, target), Overlaps(other, target)
        assert np.array_equal(one.indices, two.indices)
        assert np.array_equal(one.areas, two.areas)
        one, two = Overlaps(target, source, workers=1), Overlaps(target, other, workers=3)
        assert np.array_equal(one.indices, two.indices)
        assert np.array_equal(one.areas, two.areas)
    lon, lat = np.arange(0, 361, 15), np.arange(-90, 91, 15)
    one = Overlaps(source, Grid.from_lonlat(lon, lat)).matrix.toarray().reshape(12, 24, -1)
    two = Overlaps(source, Grid.from_lonlat(lon[::-1], lat[::-1])).matrix.toarray()
    assert np.array_equal(one, two.reshape(12, 24, -1)[::-1, ::-1])


def test_corners_in_sides_and_holes() -> None:
    # A cell with a corner in each side is the same cell.
    corners = cubed(3)
    middles = corners + np.roll(corners, -1, axis=1)
    more = np.stack((corners, middles), axis=2).reshape(-1, 8, 3)
    for target in (Grid.from_mesh(cubed(4)), degrees(30)):
        one, two = (Overlaps(Grid.from_mesh(c, merge=0), target).matrix for c in (corners, more))
        assert abs(one - two).max() < 1e-15
    shapely = pytest.importorskip("shapely")
    whole, hole = shapely.box(-20, -20, 20, 20), shapely.box(-9, -9, 7, 8)
    cells = Grid.from_polygons([whole - hole, hole, whole])
    for target in (degrees(5), Grid.from_healpix(8)):
        table = Overlaps(cells, target).matrix.toarray()
        assert abs(table[:, 0] + table[:, 1] - table[:, 2]).max() < 1e-16
        assert abs(table.sum(axis=0) - cells.areas).max() < 1e-14


def test_cells_around_poles() -> None:
    shapely = pytest.importorskip("shapely")
    for sign in (1, -1):
        ring = [(lon, sign * (70 + 5 * (lon % 60 == 0))) for lon in range(0, 360, 20)]
        cap = Grid.from_mesh(lonlat=[ring])
        found = Overlaps(cap, degrees(5))
        assert abs(found.covered_source[0] - 1) < 1e-14
        assert (found.covered_target > 1 - 1e-14).sum() >= 2 * 72
        # The same cell cut at 180 degrees and completed at the edge of the map.
        flat = Grid.from_polygons(cap.to_geopandas().geometry)
        assert abs(flat.areas[0] / cap.areas[0] - 1) < 1e-5
        assert isinstance(cap.to_geopandas().geometry[0], shapely.Polygon)


def test_files_keep_areas(tmp_path: Path) -> None:
    made = Overlaps(Grid.from_healpix(2), degrees(30))
    made.save(tmp_path / "areas.npz")
    again = Overlaps.load(tmp_path / "areas.npz")
    for other in (again, pickle.loads(pickle.dumps(made))):
        for name in ("indptr", "indices", "areas", "covered_source", "covered_target"):
            assert np.array_equal(getattr(other, name), getattr(made, name))
        assert other.source_shape == (48,)
        assert other.target_shape == (6, 12)
        assert repr(other) == repr(made)
    assert again.source is None
    assert made.source is not None


@pytest.mark.parametrize(
    ("name", "edit", "message"),
    [
        ("indptr", lambda a: a[:-1], "do not match"),
        ("indptr", lambda a: a[::-1].copy(), "partition"),
        ("indptr", lambda a: np.where(a == a[2], a[-1] + 1, a), "descends"),
        ("indices", lambda a: a + 40, "indices"),
        ("areas", lambda a: -a, "positive"),
        ("areas", lambda a: a * np.nan, "positive"),
        ("target_sums", lambda a: a[1:], "target_sums"),
        ("source_areas", lambda a: a - 9, "wrong area"),
        ("source_shape", lambda a: a + 1, "source_shape"),
    ],
)
def test_edited_files(
    tmp_path: Path, name: str, edit: Callable[[NDArray[Any]], NDArray[Any]], message: str
) -> None:
    path = tmp_path / "areas.npz"
    Overlaps(Grid.from_healpix(2), degrees(30)).save(path)
    with np.load(path) as archive:
        arrays = dict(archive)
    arrays[name] = edit(arrays[name])
    np.savez(path, **arrays)
    with pytest.raises(delone.FileFormatError, match=message):
        Overlaps.load(path)


def test_what_is_refused() -> None:
    with pytest.raises(delone.DtypeError, match=r"target must be a sphere\.Grid, got int"):
        Overlaps(Grid.from_healpix(1), 3)  # type: ignore[arg-type]


def test_the_report_names_cells() -> None:
    region = Grid.from_lonlat([0, 10, 20, 25], [0, 10])
    report = Overlaps(region, degrees(10)).report
    assert report.npairs == 3
    assert report.target_partly.tolist() == [9 * 36 + 2]
    assert len(report.target_outside) == 645
    twice = Grid.from_mesh(lonlat=[[(0, 1), (9, 1), (9, 9), (0, 9)]] * 2)
    assert Overlaps(region, twice).report.source_repeatedly.tolist() == [0]
    assert len(Overlaps(twice, region).report.source_repeatedly) == 0
    assert len(Overlaps(twice, twice).report.target_repeatedly) == 2


def test_cells_beyond_the_first_lot() -> None:
    """Cells are prepared by lots of 1,024; both grids have several, in threads or not."""
    fine, other = Grid.from_healpix(16), Grid.from_healpix(20)
    assert min(fine.ncells, other.ncells) > 2 * 1024
    for source, target in ((fine, other), (other, fine)):
        one = Overlaps(source, target, workers=1)
        assert np.allclose(one.covered_target, 1, rtol=0, atol=1e-13)
        assert np.allclose(one.covered_source, 1, rtol=0, atol=1e-13)
        many = Overlaps(source, target, workers=3)
        assert np.array_equal(one.indices, many.indices)
        assert one.areas.tobytes() == many.areas.tobytes()


SIGNS = np.array(np.meshgrid([1, -1], [1, -1], [1, -1])).T.reshape(8, 3)
CORPUS = Path(__file__).parents[1] / "corpus" / "sphere"


def hard(name: str) -> Floats:
    """Vectors of the corpus."""
    case = json.loads((CORPUS / f"{name}.json").read_text(encoding="utf-8"))
    return np.array(case["points"], dtype=np.float64)


def test_a_triangle_around_a_pole() -> None:
    source = Grid.from_mesh(xyz=[hard("triangle-around-a-pole")])
    for step in (90, 30, 7.5):
        assert abs(Overlaps(source, degrees(step)).covered_source - 1) < 1e-14
    # One row from pole to pole.
    lunes = Grid.from_lonlat(np.arange(0, 361, 20), np.array([-90.0, 90.0]))
    fine = Grid.from_lonlat(np.arange(0, 361, 20), np.arange(-90, 91, 10))
    parts = [Overlaps(source, grid).covered_target * grid.areas for grid in (lunes, fine)]
    assert np.allclose(parts[0], parts[1].reshape(18, 18).sum(axis=0), rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("seed", seeds(6, deep=60))
def test_triangles_that_span_continents(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rings = rng.normal(size=(40, 3, 3)) if seed % 2 else rng.integers(-4, 5, size=(40, 3, 3))
    # Triangles with area whose corners are well within a hemisphere.
    rings = rings[np.abs(np.linalg.det(rings)) > 1e-6].astype(np.float64)
    rows = Grid.from_lonlat(
        np.arange(0, 361, 45), np.array([-90.0, *np.sort(rng.uniform(-90, 90, 4)), 90.0])
    )
    source = Grid.from_mesh(rings)
    octants = Grid.from_mesh([np.diag(s).astype(float) for s in SIGNS])
    for target in (rows, octants):
        assert np.abs(Overlaps(source, target).covered_source - 1).max() < 1e-13
        assert np.abs(Overlaps(target, source).covered_target - 1).max() < 1e-13


def test_a_ring_that_runs_around_twice_is_refused() -> None:
    with pytest.raises(delone.DirectionError, match="cross"):
        Grid.from_mesh(xyz=[hard("ring-that-runs-around-twice")])


def test_triangles_that_touch_share_nothing() -> None:
    vectors = hard("triangles-that-meet-at-the-equator")
    upper, lower = (Grid.from_mesh(xyz=[part], merge=0) for part in np.split(vectors, [4]))
    assert Overlaps(upper, lower).areas.size == Overlaps(lower, upper).areas.size == 0


@pytest.mark.parametrize("step", [0.5, 1, 2.5, 7.5, 20, 90, 120])
@pytest.mark.parametrize("shift", [5e-14, 1e-11, 2e-9, 1 / 3, 20 / 3, -1e-13, 180.1])
def test_full_turns_whose_last_meridian_is_rounded(step: float, shift: float) -> None:
    """A shift plus 360 degrees is rounded, so a turn ends before or after its start."""
    given = np.arange(0, 360 + step / 2, step)
    latitudes = np.array([-90.0, -20.0, 0.0, 90.0])
    plain, shifted = Grid.from_lonlat(given, latitudes), Grid.from_lonlat(given + shift, latitudes)
    cells = Grid.from_lonlat(np.arange(-175.0, 180.0, 50.0), [-80.0, 10.0, 75.0])
    for source, target in itertools.permutations((plain, shifted), 2):
        found = Overlaps(source, target)
        assert found.areas.sum() == pytest.approx(4 * np.pi, rel=1e-13)
        assert found.covered_source == pytest.approx(1, rel=1e-9)
        assert found.covered_target == pytest.approx(1, rel=1e-9)
    for source in (plain, shifted):
        assert Overlaps(source, cells).covered_target == pytest.approx(1, rel=1e-9)
    assert shifted.areas.sum() == pytest.approx(4 * np.pi, rel=1e-13)


@pytest.mark.parametrize("beyond", [0.0, 1e-16, -1e-16, 3e-17])
@pytest.mark.parametrize("count", [3, 4, 7])
def test_the_pairs_of_a_turn_whose_last_meridian_is_beyond_the_first(
    count: int, beyond: float
) -> None:
    """Grids end where they start; the core is given a meridian that does not."""
    angle = np.linspace(0, 2 * np.pi, count + 1)[:-1]
    meridians = np.column_stack((np.cos(angle), np.sin(angle)))
    numbers = np.append(np.arange(count), -1).astype(np.int32)

    def band(last: float) -> Any:
        turn = np.concatenate((meridians, [(1.0, last)]))
        starts = np.array([0, count + 1])
        return _core.CellGrid.rows(np.array([[-1.0, 1.0]]), starts, turn, numbers, count)

    other = Grid.from_lonlat(np.arange(0, 361, 45.0), [-45, 0, 45])._made
    given, right = band(beyond), band(0.0)
    for shared, expected in (
        (given.overlaps(other, 1), right.overlaps(other, 1)),
        (other.overlaps(given, 1), other.overlaps(right, 1)),
    ):
        assert shared.indptr.tolist() == expected.indptr.tolist()
        assert np.allclose(shared.areas, expected.areas, rtol=1e-14, atol=0)


@pytest.mark.parametrize("lon", [[0, 90, 180, 270, 360], [0, 0.001, 30, 360], [0, 1e-6, 1e-5, 360]])
def test_cells_from_pole_to_pole(lon: list[float]) -> None:
    for lunes in (Grid.from_lonlat(lon, [-90, 90]), Grid.from_lonlat(lon, [-89.9999, 89.9999])):
        for other in (Grid.from_healpix(4), degrees(10), Grid.from_mesh(cubed(3))):
            shared = Overlaps(other, lunes)
            assert np.allclose(shared.covered_target, 1, rtol=1e-14)
            assert shared.covered_source.max() < 1 + 1e-14
            assert shared.areas.sum() == pytest.approx(lunes.areas.sum(), rel=1e-14)


@pytest.mark.parametrize("diagram", [None, 3, delone.Voronoi([(0, 0), (1, 0), (0, 1)])])
def test_cells_of_other_things_than_diagrams(diagram: Any) -> None:
    with pytest.raises(DtypeError, match=r"delone\.sphere\.Voronoi"):
        Grid.from_voronoi(diagram)


def test_more_than_a_turn_is_refused() -> None:
    with pytest.raises(InputError, match="turn"):
        _ = Overlaps(Grid.from_lonlat([0.0, 200.0, 360.0, 370.0], [0.0, 10.0]), degrees(90))


@pytest.mark.parametrize("size", [217, 184])
def test_shortest_sides(size: int) -> None:
    ring = hard(f"quadrilateral-with-a-side-of-1e-{size}")
    octants = np.concatenate([np.diag(s) for s in SIGNS]).astype(np.float64)
    cells = [(ring, [0, 4]), (octants, np.arange(0, 25, 3))]
    one, all_of_it = (
        _core.CellGrid.polygons(
            vectors,
            np.array(starts, dtype=np.int64),
            np.arange(len(starts), dtype=np.int64),
            np.zeros(len(starts) - 1, dtype=np.bool_),
        )
        for vectors, starts in cells
    )
    whole = one.check(True, 1).areas
    for found in (one.overlaps(all_of_it, 1).first, all_of_it.overlaps(one, 1).second):
        assert found == pytest.approx(whole, rel=1e-14, abs=0)


def test_a_concave_cell_with_a_corner_opposite_to_the_pole_of_its_parts() -> None:
    """Two arms from the south pole, whose parts in the north are measured from their other end."""
    arms = [(0, 0, -1), (0.5, 0.3, 1), (1, 0, -0.2), (0.5, -0.3, 1)]
    for axes in itertools.permutations(range(3)):
        cell = Grid.from_mesh(np.array([arms])[:, :, axes], winding="smaller")
        assert len(cell.report.concave) == 1
        for other in (Grid.from_healpix(8), cell):
            shared = Overlaps(cell, other)
            assert abs(shared.covered_source[0] - 1) < 1e-15
            assert (shared.areas > 0).all()
            again = Overlaps(other, cell)
            assert np.allclose(np.sort(again.areas), np.sort(shared.areas), rtol=1e-13, atol=0)


def test_a_long_cell_whose_first_corner_is_in_its_middle() -> None:
    """Its latitudes follow from the farthest corner; rows of a reduced grid are asked for alone."""
    rows = Grid.from_gaussian(24, "octahedral")
    for lon in (180.0, 170.0):
        long = Grid.from_mesh(lonlat=[[(lon, -40), (lon, 60), (lon - 5, 10)]], winding="smaller")
        shared = Overlaps(long, rows)
        assert abs(shared.covered_source[0] - 1) < 1e-14
        assert abs(shared.areas.sum() / long.areas[0] - 1) < 1e-14


def test_concave_cells_with_a_corner_in_their_middle() -> None:
    """The place outside of a cell, opposite to its middle, is then opposite to that corner."""
    notched = [(-1, 1, -1), (-1, -1, 1), (1, -1, -1), (-1, -1, -1)]
    octants = np.array(list(itertools.product((-1, 1), repeat=3)))[:, None] * np.eye(3)
    for signs in octants.sum(axis=1):
        cell = Grid.from_mesh(np.array([notched]) * signs, winding="smaller")
        assert len(cell.report.concave) == 1
        for other in (cell, Grid.from_mesh(octants), Grid.from_gaussian(4)):
            for found in (Overlaps(cell, other).areas, Overlaps(other, cell).areas):
                assert found.sum() == pytest.approx(2 * np.pi / 3, rel=1e-15)


def test_long_sides_of_a_cell_with_many_corners() -> None:
    """Sides are found by boxes that hold their arcs, which bulge between the ends."""
    many = [(lon, -0.3 * (k % 2)) for k, lon in enumerate(np.linspace(0, 80, 71))]
    source = Grid.from_mesh(lonlat=[[*many, (40, 75)]])
    assert source.report.concave.tolist() == [0]
    for target in (Grid.from_healpix(16), Grid.from_healpix(1)):
        for overlaps in (Overlaps(source, target), Overlaps(target, source)):
            covered = overlaps.areas.sum() / source.areas[0]
            assert covered == pytest.approx(1, rel=1e-13)
