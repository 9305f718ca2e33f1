"""Holes in the coverage of grids, against graphs of the cells that are left out."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import sphere
from delone.sphere import Grid, near_sides
from delone.sphere.holes import _left_of_arcs

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from delone._base.types import Floats

    Box = tuple[Fraction, Fraction, int]


def parts(count: int, pairs: Iterable[tuple[int, int]]) -> int:
    """The number of connected parts of a graph, one node at a time."""
    near: list[list[int]] = [[] for _ in range(count)]
    for a, b in pairs:
        near[a].append(b)
        near[b].append(a)
    seen, found = set(), 0
    for first in range(count):
        found += first not in seen
        todo = [first]
        while todo:
            at = todo.pop()
            if at not in seen:
                seen.add(at)
                todo += near[at]
    return found


def meet(a: set[Any], b: set[Any]) -> bool:
    return bool(a & b)


def checked(grid: Grid, left_out: list[int], touch: Callable[[int, int], int]) -> None:
    """Compare with a graph; `touch` is 0 for cells apart, 1 at a corner, 2 along a side."""
    faults = grid.validate()
    assert faults
    rest = [k for k in range(grid.ncells + len(left_out)) if k not in set(left_out)]
    joined = [(i, j) for i, j in combinations(range(len(rest)), 2) if touch(rest[i], rest[j]) == 2]
    outside = combinations(range(len(left_out)), 2)
    meeting = [(i, j) for i, j in outside if touch(left_out[i], left_out[j])]
    assert faults.holes == parts(len(left_out), meeting)
    assert len(faults.rims) == faults.holes + parts(len(rest), joined) - 1
    beside = {i for i, k in enumerate(rest) if any(touch(k, m) == 2 for m in left_out)}
    assert set(np.concatenate([*faults.rims, []]).astype(int).tolist()) == beside
    assert faults.slivers == 0
    assert all((np.diff(rim) > 0).all() for rim in faults.rims)


@pytest.mark.parametrize("share", [0.1, 0.4, 0.7])
@pytest.mark.parametrize("name", ["healpix", "voronoi", "curvilinear"])
def test_cells_with_common_corners(name: str, share: float) -> None:
    rng = np.random.default_rng(int(10 * share))
    sites = rng.normal(size=(150, 3))
    whole = {
        "healpix": lambda: Grid.from_healpix(4),
        "voronoi": lambda: Grid.from_voronoi(sphere.Voronoi(xyz=sites)),
        "curvilinear": lambda: Grid.from_curvilinear(
            *np.meshgrid(np.arange(0, 361, 30), np.arange(-90, 91, 15))
        ),
    }[name]()
    vectors, starts, _ = whole.rings
    rings = [[tuple(v) for v in vectors[a:b].tolist()] for a, b in pairwise(starts)]
    corners = [set(ring) for ring in rings]
    count = len(rings)
    left_out = np.flatnonzero(rng.random(count) < share).tolist()
    kept = [k for k in range(count) if k not in left_out]
    ends = np.cumsum([0, *(len(rings[k]) for k in kept)])
    turned = [rings[k][:: rng.choice([-1, 1])] for k in kept]
    grid = Grid.from_mesh(np.concatenate(turned), ends, merge=0)
    checked(grid, left_out, lambda a, b: min(len(corners[a] & corners[b]), 2))


def boxes_of(numbers: list[int]) -> list[Box]:
    """West and width of each cell as parts of a turn, and its row."""
    return [
        (Fraction(k, n), Fraction(1, n), row) for row, n in enumerate(numbers) for k in range(n)
    ]


def touching(a: Box, b: Box, rows: int) -> int:
    """0 for cells apart, 1 for those with a common point, 2 for those with a common side."""
    if abs(a[2] - b[2]) > 1:
        return 0
    if a[2] == b[2]:
        beside = (a[0] + a[1] - b[0]) % 1 == 0 or (b[0] + b[1] - a[0]) % 1 == 0
        return 2 if beside else int(a[2] in {0, rows - 1})
    ahead, behind = (b[0] - a[0]) % 1, (a[0] - b[0]) % 1
    if ahead < a[1] or behind < b[1]:
        return 2
    return int(ahead == a[1] or behind == b[1])


@pytest.mark.parametrize("share", [0.1, 0.4, 0.7])
@pytest.mark.parametrize(
    "numbers", [[3, 7, 7, 3], [4, 8, 12, 18, 18, 9, 6, 6], [6], [5, 5], [1, 4, 8, 3, 1]]
)
def test_rows_with_corners_in_sides(numbers: list[int], share: float) -> None:
    xarray = pytest.importorskip("xarray")
    rng = np.random.default_rng(int(10 * share))
    cells = boxes_of(numbers)
    left_out = np.flatnonzero(rng.random(len(cells)) < share).tolist()
    kept = rng.permutation([k for k in range(len(cells)) if k not in left_out]).tolist()
    lat = np.linspace(-90, 90, len(numbers) + 1)
    west = np.array([float(360 * cells[k][0]) for k in kept])
    east = np.array([float(360 * (cells[k][0] + cells[k][1])) for k in kept])
    south, north = (lat[[cells[k][2] + up for k in kept]] for up in (0, 1))
    coords = {}
    for name, low, high, unit in (
        ("lon", west, east, "degrees_east"),
        ("lat", south, north, "degrees_north"),
    ):
        coords[name] = ("cell", (low + high) / 2, {"units": unit, "bounds": f"{name}_bnds"})
        coords[f"{name}_bnds"] = (("cell", "two"), np.column_stack((low, high)), {})
    grid = Grid.from_dataset(xarray.Dataset(coords=coords))
    assert grid.edges == "parallel"
    order = {k: i for i, k in enumerate(kept)}
    names = [*kept, *left_out]
    again = [names.index(k) for k in left_out]
    assert sorted(again) == list(range(len(order), len(names)))
    rows = len(numbers)
    checked(grid, again, lambda a, b: touching(cells[names[a]], cells[names[b]], rows))


def quad(west: float, south: float, east: float, north: float) -> list[tuple[float, float]]:
    return [(west, south), (east, south), (east, north), (west, north)]


@pytest.mark.parametrize("turn", [0, 1, 2])
def test_corners_in_arcs(turn: int) -> None:
    # A frame whose sides are on the equator and on a meridian, and a bridge across its hole whose
    # corners are in these sides, but not at their ends.
    frame = [
        quad(-30, -30, 30, 0),
        quad(-60, 0, -30, 40),
        quad(-30, 40, 30, 60),
        quad(30, 0, 60, 40),
    ]
    link = [quad(-30, -30, -60, 0)[::1], quad(30, -30, 60, 0)]
    top = [quad(-60, 40, -30, 60), quad(30, 40, 60, 60)]
    bridge = [(-10, 0), (10, 0), (10, 20), (-10, 20)]
    beside = [(-30, 0), (-10, 0), (-10, 20), (-30, 20)]

    def holes(cells: list[Any], slivers: int = 0) -> int | None:
        vectors = sphere.Delaunay(lonlat=np.concatenate(cells)).vectors
        vectors = np.roll(vectors, turn, axis=1).reshape(-1, 4, 3)
        faults = Grid.from_mesh(vectors).validate()
        assert faults.slivers <= slivers
        return faults.holes

    ring = frame + link + top
    assert holes(ring) == 2
    # Joined in the middle of a side, it is no island.
    assert holes([*ring, bridge]) == 2
    assert len(Grid.from_mesh(lonlat=np.array([*ring, bridge])).validate().rims) == 2
    # From the equator to the meridian of 30 degrees west, whose corners are rounded.
    assert holes([*ring, bridge, beside], slivers=1) == 2


def test_sides_beyond_the_first_lot(monkeypatch: pytest.MonkeyPatch) -> None:
    inner, outer = block(3, -0.25, 0.25), block(6, -0.75, 0.75)
    outer = outer[np.abs(outer.mean(axis=1)[:, 1:]).max(axis=1) > 0.25]
    grid = Grid.from_mesh(np.concatenate((outer, inner)) @ turned_by(2))
    faults = grid.validate()
    assert (faults.holes, faults.slivers) == (1, 4)
    monkeypatch.setattr(near_sides, "_LOT", 5)
    other = grid.validate()
    assert (other.holes, other.slivers) == (1, 4)
    assert [rim.tolist() for rim in other.rims] == [rim.tolist() for rim in faults.rims]


def test_a_bridge_between_sides() -> None:
    # Two cells on the equator, and one on the meridian of 90 degrees, that no corners connect.
    low = [(0, -30), (80, -30), (80, 0), (0, 0)]
    high = [(90, 5), (130, 5), (130, 70), (90, 80)]
    middle = [(70, 0), (90, 10), (90, 20), (60, 0)]
    for cells, holes, rims in (
        ([low, high], 1, 2),
        ([low, high, middle], 1, 1),
        ([low, middle], 1, 1),
        ([high, middle], 1, 1),
    ):
        faults = Grid.from_mesh(lonlat=cells).validate()
        assert (faults.holes, len(faults.rims)) == (holes, rims)
    # A second bridge closes a ring.
    second = [(20, 0), (90, 40), (90, 50), (10, 0)]
    faults = Grid.from_mesh(lonlat=[low, high, middle, second]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (2, [[0, 1, 2, 3]] * 2)


@pytest.mark.parametrize("seed", range(8))
def test_corners_that_rounding_puts_beside_a_side(seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b, far, near = np.array([(1.0, 0, 0), (0, 1, 0), (1, 1, 1), (1, 1, -1)])
    a, b = a + 0.3 * rng.normal(size=3), b + 0.3 * rng.normal(size=3)
    c, d = 0.7 * a + 0.3 * b, 0.3 * a + 0.7 * b
    cells = np.array([(far, a, b), (near, c, a), (near, d, c), (near, b, d)])
    for order in ([0, 1, 2, 3], [3, 1, 2, 0]):
        faults = Grid.from_mesh(cells[order], merge=0).validate()
        assert faults
        # Corners exactly on the side leave no sliver.
        assert faults.slivers <= 1
        assert faults.holes == 1
        assert [rim.tolist() for rim in faults.rims] == [[0, 1, 3]]
    # A gap of a thousandth of a side is none. The other corner still joins the cells.
    gap = 1e-3 * (near - far)
    cells[1, 1] += gap
    cells[2, 2] += gap
    faults = Grid.from_mesh(cells, merge=0).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (1, [[0, 1, 2, 3]])
    cells[2, 1] += gap
    cells[3, 2] += gap
    faults = Grid.from_mesh(cells, merge=0).validate()
    assert (faults.holes, len(faults.rims), faults.slivers) == (1, 2, 0)


def test_a_refined_region_leaves_no_hole() -> None:
    # Corners in the middle of sides are rounded, all around the region.
    rng = np.random.default_rng(0)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    lon, lat = np.meshgrid(np.arange(-3, 4) / 6, np.arange(-3, 4) / 6)
    place = np.dstack((np.ones_like(lon), lon, lat)) @ turn

    def cells(p: Floats) -> Floats:
        return np.stack((p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]), axis=2).reshape(-1, 4, 3)

    inner = place[1:6, 1:6]
    fine = np.empty((9, 9, 3))
    fine[::2, ::2] = inner
    fine[1::2, ::2] = (inner[:-1] + inner[1:]) / 2
    fine[:, 1::2] = (fine[:, :-1:2] + fine[:, 2::2]) / 2
    coarse = cells(place).reshape(6, 6, 4, 3)
    outer = np.ones((6, 6), dtype=bool)
    outer[1:5, 1:5] = False
    grid = Grid.from_mesh(np.concatenate((coarse[outer], cells(fine))))
    faults = grid.validate()
    assert (faults.holes, len(faults.rims)) == (1, 1)
    assert 0 < faults.slivers <= 16
    assert "1 hole, " in repr(faults)
    assert len(faults.rims[0]) == 20


def block(numbers: int, low: float, high: float, shift: float = 0.0) -> Floats:
    """Cells of a gnomonic block on the plane x = 1."""
    steps = np.linspace(low, high, numbers + 1)
    y, z = np.meshgrid(steps + shift, steps + shift)
    p = np.dstack((np.ones_like(y), y, z))
    return np.stack((p[:-1, :-1], p[:-1, 1:], p[1:, 1:], p[1:, :-1]), axis=2).reshape(-1, 4, 3)


@pytest.mark.parametrize("seed", range(1, 4))
@pytest.mark.parametrize("inside", [(2, 1), (3, 2), (5, 3), (7, 4), (20, 7), (8, 1)])
def test_blocks_with_corners_of_their_own_on_both_sides(inside: tuple[int, int], seed: int) -> None:
    fine, coarse = inside
    inner, outer = block(fine, -0.25, 0.25), block(3 * coarse, -0.75, 0.75)
    outer = outer[np.abs(outer.mean(axis=1)[:, 1:]).max(axis=1) > 0.25]
    cells = np.concatenate((outer, inner)) @ turned_by(seed)
    faults = Grid.from_mesh(cells).validate()
    assert faults
    assert (faults.holes, len(faults.rims)) == (1, 1)
    assert len(faults.rims[0]) == 12 * coarse - 4
    # A chain of sides between common corners is one: several if `coarse` divides `fine`.
    parts = np.gcd(fine, coarse)
    assert faults.slivers == 4 * parts
    # A cell of the block that is missing is a hole again.
    rest = Grid.from_mesh(np.delete(cells, len(outer), axis=0)).validate()
    assert (rest.holes, len(rest.rims)) == (2, 2)
    # So is all of it, and a block that is smaller by a thousandth has a gap around it.
    assert Grid.from_mesh(cells[: len(outer)]).validate().holes == 2
    less = np.concatenate((outer, block(fine, -0.24975, 0.24975))) @ turned_by(seed)
    faults = Grid.from_mesh(less).validate()
    assert (faults.holes, len(faults.rims), faults.slivers) == (2, 3, 0)


@pytest.mark.parametrize("seed", range(1, 5))
def test_blocks_without_common_corners(seed: int) -> None:
    # All corners of the inner block are in sides, and all are rounded.
    inner = block(4, -0.25, 0.25)
    y, z = (np.array([-0.75, -0.25, 0.25, 0.75]) for _ in range(2))
    frame = [
        [(y[0], z[0]), (y[2], z[0]), (y[2], z[1]), (y[0], z[1])],
        [(y[2], z[0]), (y[3], z[0]), (y[3], z[2]), (y[2], z[2])],
        [(y[1], z[2]), (y[3], z[2]), (y[3], z[3]), (y[1], z[3])],
        [(y[0], z[1]), (y[1], z[1]), (y[1], z[3]), (y[0], z[3])],
    ]
    around = np.insert(np.array(frame), 0, 1.0, axis=2)
    faults = Grid.from_mesh(np.concatenate((around, inner)) @ turned_by(seed)).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (1, [[0, 1, 2, 3]])
    assert faults.slivers > 0


@pytest.mark.parametrize("west", [0, 30, 33.3, -77])
@pytest.mark.parametrize("steps", [(10, 15), (12, 20), (6, 10)])
def test_rows_of_different_heights_that_meet_at_a_meridian(
    steps: tuple[int, int], west: float
) -> None:
    cells = []
    for begin, step in zip((west - 40, west), steps, strict=True):
        lon, lat = np.arange(begin, begin + 40, 10), np.arange(-60, 60, step)
        cells += [quad(x, y, x + 10, y + step) for x in lon for y in lat]
    faults = Grid.from_mesh(lonlat=cells).validate()
    assert (faults.holes, len(faults.rims)) == (1, 1)
    assert len(faults.rims[0]) == 2 * 8 + 120 // steps[0] + 120 // steps[1] - 4


@pytest.mark.parametrize("seed", range(4))
def test_rounded_corners_that_are_not_merged(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = block(5, -0.5, 0.5) @ turned_by(seed)
    cells /= np.linalg.norm(cells, axis=2, keepdims=True)
    cells += rng.choice([-(2.0**-53), 0, 2.0**-53], size=cells.shape)
    faults = Grid.from_mesh(cells, merge=0).validate()
    assert (faults.holes, len(faults.rims), len(faults.rims[0])) == (1, 1, 16)
    assert 0 < faults.slivers <= 40
    faults = Grid.from_mesh(np.delete(cells, 12, axis=0), merge=0).validate()
    assert (faults.holes, sorted(len(rim) for rim in faults.rims)) == (2, [4, 16])


@pytest.mark.parametrize("seed", range(4))
def test_sides_that_cross_are_not_counted(seed: int) -> None:
    # Corners of two cells overlap by 1e-14 of them.
    cells = np.concatenate((block(1, -0.5, 0), block(1, 0, 0.5, -2e-8))) @ turned_by(seed)
    faults = Grid.from_mesh(cells).validate()
    assert faults
    assert (faults.holes, faults.rims, faults.slivers) == (None, (), 0)
    assert "holes not counted because sides cross" in repr(faults)


def test_many_corners_on_a_long_side() -> None:
    # Parts of the side are halved until there are few corners near each.
    turn = turned_by(1)
    y = np.linspace(-1, 1, 3000)
    low = np.column_stack((np.ones_like(y), y, 0 * y))
    high = low + np.array([0, 0, 1e-2])
    fine = np.stack((low[:-1], low[1:], high[1:], high[:-1]), axis=1)
    coarse = np.array([[(1, 1, 0), (1, -1, 0), (1, -1, -1), (1, 1, -1)]])
    faults = Grid.from_mesh(np.concatenate((fine, coarse)) @ turn).validate()
    assert (faults.holes, len(faults.rims), faults.slivers) == (1, 1, 1)


def test_cells_of_several_rings() -> None:
    shapely = pytest.importorskip("shapely")
    hole = quad(2, 2, 4, 4)
    cells = [shapely.Polygon(quad(0, 0, 10, 10), [hole, quad(6, 6, 8, 8)])]
    faults = Grid.from_polygons(cells).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (3, [[0]] * 3)
    faults = Grid.from_polygons([*cells, shapely.Polygon(hole)]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (2, [[0]] * 2)
    # An island in the hole is a second ring around the same part of the sphere.
    faults = Grid.from_polygons([*cells, shapely.box(2.5, 2.5, 3, 3)]).validate()
    assert (faults.holes, len(faults.rims)) == (3, 4)
    apart = shapely.MultiPolygon([shapely.box(0, 0, 9, 9), shapely.box(180, 0, 190, 9)])
    faults = Grid.from_polygons([apart, shapely.box(80, 0, 90, 9)]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (1, [[0], [0], [1]])
    near = shapely.MultiPolygon([shapely.box(0, 0, 5, 5), shapely.box(10, 0, 15, 5)])
    faults = Grid.from_polygons([near]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (1, [[0], [0]])
    faults = Grid.from_polygons([near, shapely.box(5, 0, 10, 5)]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (1, [[0, 1]])
    ring = shapely.Polygon(quad(0, 0, 10, 10), [quad(2, 2, 8, 8)])
    island = shapely.MultiPolygon([ring, shapely.box(4, 4, 6, 6)])
    faults = Grid.from_polygons([island]).validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (2, [[0]] * 3)
    # An ocean as one cell: its holes are the land.
    land = [quad(0, 0, 20, 20), quad(60, -20, 90, 0)]
    ocean = shapely.Polygon([(0, -65), (120, -65), (240, -65)], land)
    faults = Grid.from_polygons([ocean], winding="ccw").validate()
    assert (faults.holes, [rim.tolist() for rim in faults.rims]) == (3, [[0]] * 3)


def test_without_cells_and_with_overlaps() -> None:
    point = [(0, 0), (10, 0), (0, 0), (10, 0)]
    faults = Grid.from_mesh(lonlat=[point]).validate()
    assert (faults.holes, faults.rims) == (1, ())
    two = Grid.from_mesh(lonlat=[quad(0, 0, 10, 10), quad(5, 0, 15, 10)]).validate()
    assert not two
    assert (two.holes, two.rims, two.slivers) == (None, (), 0)
    assert "hole" not in repr(two)
    assert Grid.from_mesh(lonlat=[quad(0, 0, 9, 9), quad(9, 9, 19, 19)]).validate().holes == 1


def turned_by(seed: int) -> Floats:
    """A rotation; none for seed 0."""
    if not seed:
        return np.eye(3)
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.asarray(turn * np.sign(np.linalg.det(turn)))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("step", [15, 30, 90])
def test_half_spheres_and_lunes(step: int, seed: int) -> None:
    # The ring around the hole has opposite corners.
    for west_east, south_north in (
        ((0, 360), (0, 90)),
        ((0, 360), (-90, 0)),
        ((0, 180), (-90, 90)),
        ((0, 270), (-90, 90)),
        ((30, 120), (-90, 90)),
    ):
        lon, lat = (np.arange(a, b + 1, step) for a, b in (west_east, south_north))
        vectors, starts, _ = Grid.from_curvilinear(*np.meshgrid(lon, lat)).rings
        faults = Grid.from_mesh(vectors @ turned_by(seed), starts).validate()
        assert (faults.holes, len(faults.rims), faults.slivers) == (1, 1, 0)


@pytest.mark.parametrize("seed", range(4))
def test_an_octahedron_without_some_faces(seed: int) -> None:
    signs = np.array(np.meshgrid([1, -1], [1, -1], [1, -1])).reshape(3, 8).T
    faces = np.stack([np.diag(each) for each in signs.tolist()]) @ turned_by(seed)
    for left_out in [*combinations(range(8), 2), (0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 4, 5)]:
        # Faces with two common signs share a side, those with one a corner.
        apart = len(left_out) == 2 and (signs[left_out[0]] == -signs[left_out[1]]).all()
        kept = [k for k in range(8) if k not in left_out]
        faults = Grid.from_mesh(faces[kept], winding="smaller").validate()
        assert (faults.holes, faults.slivers) == (2 if apart else 1, 0)


@pytest.mark.parametrize("seed", range(4))
def test_the_area_of_a_ring_does_not_depend_on_its_first_corner(seed: int) -> None:
    x, y, z = turned_by(seed)
    ring = [x, y, -x, -y]
    for corners, area in (([x, y, -x, z], np.pi), (ring, 2 * np.pi), ([x, y, z], np.pi / 2)):
        for first in range(len(corners)):
            found = _left_of_arcs(np.roll(corners, first, axis=0))
            assert abs(found) == pytest.approx(area, abs=1e-14)
    # Along a half circle and back, at a distance of rounding errors.
    there = [np.cos(a) * x + np.sin(a) * y for a in np.linspace(0, np.pi, 30)]
    back = [p + 1e-16 * z for p in there[-2:0:-1]]
    for first in (0, 7, 30, 45):
        assert abs(_left_of_arcs(np.roll([*there, *back], first, axis=0))) < 1e-14


def test_vectors_of_different_lengths() -> None:
    vectors: Floats = np.array(
        [(1, 2, 3), (3, 2, 1), (2, 5, 1), (3, 6, 9), (9, 6, 3), (4, -1, 2.0)]
    )
    cells = vectors.reshape(2, 3, 3)
    assert len(Grid.from_mesh(cells, merge=0).validate().rims) == 1


@pytest.mark.parametrize("n", [4, 16])
def test_grids_of_the_library_have_no_holes(n: int) -> None:
    for grid in (
        Grid.from_gaussian(n, "octahedral"),
        Grid.from_gaussian(n),
        Grid.from_healpix(n),
        Grid.from_lonlat(np.linspace(-180, 180, 3 * n + 1) + 0.1, np.linspace(-90, 90, n)),
    ):
        faults = grid.validate()
        assert (faults.holes, faults.rims, faults.slivers) == (0, (), 0)
        assert "hole" not in repr(faults)
