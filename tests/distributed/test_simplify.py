"""Simplified tiles: the bound at each point by a judge on fractions, and no cracks."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from pyarrow import parquet

from delone import ConstrainedDelaunay, datasets, distributed
from delone._tiling.plane import topology
from delone.distributed.read import simplifying
from delone.distributed.read.assembling import Piece, assembled
from delone.distributed.store.output import tile_names
from delone.errors import FileFormatError, InputError, InternalError
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Points = NDArray[np.float64]


def survey() -> Points:
    """Soundings, without those that repeat a place."""
    baja = datasets.baja()
    points = np.column_stack([baja.points, baja.z])[::5]
    _, first = np.unique(points[:, :2], axis=0, return_index=True)
    return points[np.sort(first)]


def cliffs() -> Points:
    """A lattice with a cliff in it, and points on cuts wherever they are."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(40.0), np.arange(25.0)))
    return np.column_stack([x, y, 30 * (x + y / 2 > 31) + np.sin(x) * np.cos(y / 2)])


def slanted() -> Points:
    """A lattice along a diamond: cuts meet the hull where its sides are slanted."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(-20.0, 21), np.arange(-20.0, 21)))
    inside = abs(x) + abs(y) <= 20
    x, y = x[inside], y[inside]
    return np.column_stack([x / 3, y / 3, np.hypot(x, y) + (x % 5 == 0)])


def straight() -> Points:
    """Points along a slanted line, on the hull up to rounding, and scattered ones beside it."""
    dice = np.random.default_rng(3)
    way = np.sort(dice.random(150))
    side = np.column_stack([0.1 + 9.6 * way, 0.2 + 1.1 * way])
    xy = np.concatenate([side, [3.0, 2.0] + dice.random((600, 2)) * [5, 7]])
    return np.column_stack([xy, np.sin(3 * xy[:, 0]) + np.cos(5 * xy[:, 1]) + dice.random(len(xy))])


POINTS = {"survey": survey, "cliffs": cliffs, "slanted": slanted, "straight": straight}


def judge(tin: TIN, points: Points) -> list[Fraction | None]:
    """The exact distance of each point from the surface, by a loop; None if it is outside."""
    corners = np.column_stack((tin.points, tin.z))[tin.simplices]
    low, high = corners[:, :, :2].min(axis=1), corners[:, :, :2].max(axis=1)
    found: list[Fraction | None] = []
    for point in points:
        near = ((low <= point[:2]) & (point[:2] <= high)).all(axis=1)
        found.append(None)
        x, y, z = map(Fraction, point.tolist())
        for k in np.flatnonzero(near).tolist():
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (
                tuple(map(Fraction, corner)) for corner in corners[k].tolist()
            )
            u = (bx - x) * (cy - y) - (by - y) * (cx - x)
            v = (cx - x) * (ay - y) - (cy - y) * (ax - x)
            w = (ax - x) * (by - y) - (ay - y) * (bx - x)
            if min(u, v, w) >= 0:
                found[-1] = abs((u * az + v * bz + w * cz) / (u + v + w) - z)
                break
    return found


def edges_once(tin: TIN) -> int:
    """The number of edges with one triangle: those of the outline, if there is no crack."""
    ends = np.sort(tin.simplices[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    count = Counter(map(tuple, ends.tolist()))
    assert max(count.values()) == 2
    return sum(number == 1 for number in count.values())


@pytest.fixture(scope="module", params=list(POINTS))
def tiled(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[distributed.TiledDelaunay, Points]:
    points = POINTS[request.param]()
    if len(points) > 2000:
        points = points[::6]
    folder = tmp_path_factory.mktemp(request.param) / "tin"
    tiles = distributed.triangulate(points, folder, tile_points=len(points) // 9)
    assert tiles.ntiles > 6
    return tiles, points


@pytest.mark.parametrize("share", [0.2, 0.01, 0.0])
def test_the_bound_holds_at_each_point(tiled: Any, share: float) -> None:
    tiles, points = tiled
    error = share * float(np.ptp(points[:, 2]))
    tin = tiles.simplify(max_error=error)
    found = judge(tin, points)
    assert None not in found
    assert max(distance for distance in found if distance is not None) <= Fraction(error)
    assert all(simplifying.prove(tiles, tin, error))
    if share == 0.2:
        assert tin.npoints < len(points) / 2


def test_there_is_no_crack(tiled: Any) -> None:
    tiles, points = tiled
    tin = tiles.simplify(max_error=0.1 * float(np.ptp(points[:, 2])))
    assert tin.validate()
    outline = edges_once(tin)
    # One cycle: each vertex of it has two of these edges.
    ends = tin.simplices[:, [[1, 2], [2, 0], [0, 1]]][tin.neighbors < 0]
    assert outline == len(ends) == len(np.unique(ends))
    whole = TIN.from_points(points)
    assert tin.areas.sum() == pytest.approx(whole.areas.sum(), rel=1e-12)
    # Lines along cuts are parallel to an axis, and soft.
    sides = tin.points[tin.breaklines]
    parallel = (sides[:, 0] == sides[:, 1]).any(axis=1)
    hull = np.isin(tin.breaklines, ends).all(axis=1)
    assert (parallel | hull).all() and parallel.any() and tin.soft.all()


def test_triangles_are_those_of_all_points_with_the_lines(tiled: Any) -> None:
    tiles, points = tiled
    for share in (0.2, 0.01):
        tin = tiles.simplify(max_error=share * float(np.ptp(points[:, 2])))
        mesh = ConstrainedDelaunay(tin.points, tin.breaklines, planar=True)
        every, some = (
            {tuple(sorted(each)) for each in found.tolist()}
            for found in (mesh.simplices, tin.simplices)
        )
        left_out = {tuple(sorted(each)) for each in tin._left_out().tolist()}
        assert every == some | left_out and not some & left_out
        assert len(every) == len(tin.simplices) + len(tin._left_out())
        # What is left out is beyond the hull of the survey, up to rounding.
        assert tin.areas.sum() == pytest.approx(mesh.areas.sum(), rel=1e-12)
        assert len(np.unique(tin.points, axis=0)) == len(np.unique(tin.simplices)) == tin.npoints
        # Each line is a segment, and no segment is on the hull.
        pairs = {tuple(sorted(each)) for each in mesh.segments.tolist()}
        assert pairs == set(map(tuple, tin.breaklines.tolist()))
        outer = topology.boundary_edges(mesh.simplices, mesh.neighbors)
        assert not pairs & {tuple(sorted(each)) for each in outer.tolist()}


def test_rounded_ends_of_cuts_leave_triangles_out(tmp_path: Path) -> None:
    points = straight()
    tiles = distributed.triangulate(points, tmp_path / "tin", tile_points=len(points) // 12)
    tin = tiles.simplify(max_error=0.05)
    assert len(tin._left_out()) > 0
    assert tin.validate()
    # What is beside them does not depend on them: the edges between are lines.
    ends = [[1, 2], [2, 0], [0, 1]]
    inner, outer = (
        {frozenset(edge) for edge in each[:, ends].reshape(-1, 2).tolist()}
        for each in (tin.simplices, tin._left_out())
    )
    assert inner & outer <= set(map(frozenset, tin.breaklines.tolist()))


def square(x: float, z: float = 0.0) -> Piece:
    corners = np.array([(x, 0, 0), (x + 1, 0, 0), (x + 1, 1, z), (x, 1, 0)])
    simplices = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
    return Piece(corners, simplices, np.array([(-1, 1, -1), (-1, -1, 0)], dtype=np.int32))


def triangle(*corners: tuple[float, float, float]) -> Piece:
    alone = np.full((1, 3), -1, dtype=np.int32)
    return Piece(np.array(corners), np.array([(0, 1, 2)], dtype=np.int32), alone)


def test_pieces_that_do_not_fit_are_an_error() -> None:
    made = assembled([square(0), square(1)], None)
    assert len(made.points) == 6 and made.kept.all() and len(made.segments) == 1
    assert topology.neighbors(made.simplices, 6).tolist() == made.neighbors.tolist()
    for pieces, message in (
        ([square(0), square(0)], "overlap"),
        (
            [
                triangle((1, 0, 0), (2, 0, 0), (1, 1, 0)),
                square(0),
                triangle((1, 0, 0), (2, 1, 0), (1, 1, 0)),
            ],
            "overlap",
        ),
        ([square(0), square(2)], "borders of simplified tiles differ"),
        ([square(0, z=1), square(1)], "different heights"),
    ):
        with pytest.raises(InternalError, match=message):
            assembled(pieces, None)


def test_one_tile_is_one_piece(tmp_path: Path) -> None:
    points = survey()[::4]
    tiles = distributed.triangulate(points, tmp_path / "tin")
    assert tiles.ntiles == 1
    found, right = tiles.simplify(max_error=50), TIN.from_points(points).simplify(max_error=50)
    rows = [each.xyz[np.lexsort(each.xyz.T)] for each in (found, right)]
    assert np.array_equal(*rows)
    assert found.nsimplex == right.nsimplex and not len(found.breaklines)


def test_lines_cost_few_triangles(tmp_path: Path) -> None:
    points = survey()
    tiles = distributed.triangulate(points, tmp_path / "tin", tile_points=len(points) // 9)
    one = TIN.from_points(points).simplify(max_error=80)
    assert one.nsimplex < tiles.simplify(max_error=80).nsimplex < 1.1 * one.nsimplex


def test_other_values_and_wrong_arguments(tmp_path: Path) -> None:
    points = survey()[::4]
    path = tmp_path / "points.csv"
    depth = np.where(np.arange(len(points)) == 7, np.nan, -points[:, 2])
    table = np.column_stack([points, depth, 2 * points[:, 2]])
    np.savetxt(path, table, delimiter=",", header="x,y,z,depth,twice", comments="")
    tiles = distributed.triangulate(
        path, tmp_path / "tin", tile_points=600, attributes=["depth", "twice"]
    )
    assert tiles.simplify(max_error=100, values="twice").z.min() == 2 * points[:, 2].min()
    with pytest.raises(InputError, match=r"depth is NaN or infinite at 1 point .* row 7: "):
        tiles.simplify(max_error=100, values="depth")
    with pytest.raises(InputError, match="has no 'slope'"):
        tiles.simplify(max_error=100, values="slope")
    with pytest.raises(InputError, match="at least 0 and finite, got -1"):
        tiles.simplify(max_error=-1)
    with pytest.raises(InputError, match="executor must be"):
        tiles.simplify(max_error=1, executor="threads")


def test_tiles_that_were_replaced_are_an_error(tmp_path: Path) -> None:
    tiles = distributed.triangulate(cliffs(), tmp_path / "tin", tile_points=120)
    first, second = (tiles.store.path(tile_names(k)[0]) for k in range(2))
    content = first.read_bytes()
    first.write_bytes(content[: len(content) // 2])
    with pytest.raises(FileFormatError, match="is truncated"):
        tiles.simplify(max_error=1)
    first.write_bytes(content)
    table = parquet.read_table(second)
    parquet.write_table(table.slice(0, 50), second)
    with pytest.raises(FileFormatError, match="tile 1 does not have the points of its manifest"):
        tiles.simplify(max_error=1)


def test_a_cluster_gives_the_same(tmp_path: Path) -> None:
    library = pytest.importorskip("distributed")
    points = survey()[::4]
    tiles = distributed.triangulate(points, tmp_path / "tin", tile_points=500)
    with library.Client(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    ) as client:
        found = tiles.simplify(max_error=80, executor=client)
    right = tiles.simplify(max_error=80)
    assert np.array_equal(found.xyz, right.xyz)
    assert np.array_equal(found.simplices, right.simplices)


def test_a_flat_survey_has_lines_of_two_points(tmp_path: Path) -> None:
    grid = cliffs()
    grid[:, 2] = 3 + grid[:, 0] / 4
    tiles = distributed.triangulate(grid, tmp_path / "tin", tile_points=120)
    tin = tiles.simplify(max_error=1e-9)
    # Corners of the hull, and the places where cuts meet each other and the hull.
    assert tin.npoints <= 4 + 4 * tiles.ntiles
    assert np.isin([0.0, 39.0], tin.points[:, 0]).all()


def test_lines_that_end_at_one_place_agree_on_its_height() -> None:
    cuts = [
        simplifying._Cut(0, 5.0, 0.0, 9.0),
        simplifying._Cut(1, 4.0, 0.0, 5.0),
        simplifying._Cut(1, 4.0, 5.0, 9.0),
    ]
    ends = [[(5.0, 0.0, 1.0), (5.0, 9.0, 1.0)], [(0.0, 4.0, 2.0), (5.0, 4.0, 3.0)]]
    lines = [np.array(line) for line in [*ends, [(5.0, 4.0, 3.5), (9.0, 4.0, 2.0)]]]
    found = simplifying._meeting(cuts, lines)
    assert [points.tolist() for points, _ in found] == [
        [[5, 0, 1], [5, 4, 3], [5, 9, 1]],
        [[0, 4, 2], [5, 4, 3]],
        [[5, 4, 3], [9, 4, 2]],
    ]
    assert found[0][1].all()


def test_of_equal_points_the_first_counts(tmp_path: Path) -> None:
    points = cliffs()
    again = np.add(points[::7], (0, 0, 50))
    dice = np.random.default_rng(2)
    both = np.concatenate([points, again])[dice.permutation(len(points) + len(again))]
    _, first = np.unique(both[:, :2], axis=0, return_index=True)
    tiles = distributed.triangulate(both, tmp_path / "tin", tile_points=120)
    tin = tiles.simplify(max_error=2)
    found = judge(tin, both[np.sort(first)])
    assert max(distance for distance in found if distance is not None) <= 2
    assert None not in found
    proven = simplifying.prove(tiles, tin, 2)
    assert all(proven) and sum(len(each.distances) for each in proven) == len(points)
