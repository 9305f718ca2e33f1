"""Improved tetrahedra, judged exactly: volumes, orientation, boundary, neighbours, angles."""

from __future__ import annotations

import copy
import itertools
import pickle
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import DtypeError, InputError, NonFiniteError, ShapeError, TetMesh
from rational import cross, dot, exact, minus
from tetrahedra import FACES, determinant, sharpest, volume
from tiers import seeds

Tetrahedra = tuple[np.ndarray, np.ndarray]


def outside(simplices: np.ndarray) -> set[tuple[int, ...]]:
    """The faces of one tetrahedron, turned so that the smallest vertex is first."""
    sides: dict[frozenset[int], list[tuple[int, ...]]] = {}
    for v in simplices.tolist():
        for face in FACES:
            corners = [v[k] for k in face]
            first = corners.index(min(corners))
            sides.setdefault(frozenset(corners), []).append(
                tuple(corners[first:] + corners[:first])
            )
    assert max(map(len, sides.values())) <= 2
    return {s[0] for s in sides.values() if len(s) == 1}


def checked(given: Tetrahedra, **options: Any) -> TetMesh:
    """An improvement of which all that is promised has been checked."""
    points, simplices = given
    mesh = delone.improve(given, **options)
    assert volume(mesh.points, mesh.simplices) == volume(points, simplices)
    assert sharpest(mesh.points, mesh.simplices) <= sharpest(points, simplices)
    assert mesh.report.smallest_after >= mesh.report.smallest_before - 1e-9
    walls = outside(mesh.simplices)
    if options.get("boundary", "faces") == "faces":
        assert walls == outside(simplices)
    rim = np.unique(list(itertools.chain(*outside(simplices))))
    assert np.array_equal(mesh.points[rim], points[rim])
    added = range(len(points), mesh.npoints)
    assert set(np.unique(mesh.simplices)) == set(np.unique(simplices)) | set(added)
    assert {tuple(sorted(f)) for f in walls} == {tuple(sorted(f)) for f in mesh.boundary.tolist()}
    for t, row in enumerate(mesh.neighbors.tolist()):
        for k, u in enumerate(row):
            if u >= 0:
                face = set(mesh.simplices[t].tolist()) - {int(mesh.simplices[t, k])}
                assert face < set(mesh.simplices[u].tolist())
                assert t in mesh.neighbors[u]
    return mesh


def delaunay(points: np.ndarray) -> Tetrahedra:
    """Delaunay tetrahedra; none of them is flat."""
    return points, delone.Delaunay(points).simplices


def uniform(count: int, seed: int = 0) -> Tetrahedra:
    return delaunay(np.random.default_rng(seed).random((count, 3)))


def ball(count: int, rim: int) -> Tetrahedra:
    """Points inside a sphere and well spaced ones on it."""
    rng = np.random.default_rng(1)
    i = np.arange(rim) + 0.5
    angle, z = np.pi * (1 + 5**0.5) * i, 1 - 2 * i / rim
    r = np.sqrt(1 - z * z)
    inner = rng.normal(size=(count, 3))
    inner *= (0.9 * rng.random(count) ** (1 / 3) / np.linalg.norm(inner, axis=1))[:, None]
    return delaunay(np.concatenate((np.column_stack((r * np.cos(angle), r * np.sin(angle), z)),
                                    inner)))  # fmt: skip


def lattice(side: int, jitter: float) -> Tetrahedra:
    points = np.array(list(itertools.product(range(side), repeat=3)), dtype=float)
    inner = ((points > 0) & (points < side - 1)).all(axis=1)
    points[inner] += np.random.default_rng(2).uniform(-jitter, jitter, (inner.sum(), 3))
    return delaunay(points)


OCTAHEDRON = (
    np.array([(0, 0, 0), (1, 0, 0.01), (1, 1, 0), (0, 1, 0.01), (0.5, 0.5, 1), (0.5, 0.5, -1)]),
    np.array([(0, 1, 2, 3), (0, 1, 3, 4), (1, 2, 3, 4), (1, 0, 2, 5), (0, 3, 2, 5)]),
)


def test_a_sliver_in_an_octahedron_goes() -> None:
    mesh = checked(OCTAHEDRON)
    assert mesh.nsimplex == 4
    assert mesh.report.ok
    assert (mesh.report.edge_removals, mesh.report.moves) == (1, 0)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.sampled(1)
def test_slivers_of_uniform_points_go(seed: int) -> None:
    given = uniform(300, seed)
    mesh = checked(given)
    report = mesh.report
    assert report.smallest_before < 1
    assert len(report.below) < (report.before[:4].sum()) / 4
    assert report.before.sum() == len(given[1])
    assert report.after.sum() == mesh.nsimplex
    # Away from the boundary little is left.
    rim = np.unique(mesh.boundary)
    inner = ~np.isin(mesh.simplices, rim).any(axis=1)
    assert mesh.quality().smallest_dihedral[inner].min() > 8


def test_a_ball_reaches_its_goal() -> None:
    mesh = checked(ball(400, 200), min_angle=15)
    assert mesh.report.ok
    assert mesh.report.smallest_after >= 15
    assert mesh.report.smallest_before < 3


def test_a_jittered_lattice_reaches_its_goal() -> None:
    mesh = checked(lattice(7, 0.3), min_angle=15)
    assert mesh.report.ok


@pytest.mark.parametrize("jitter", [1e-9, 1e-15])
def test_a_lattice_all_but_cospherical(jitter: float) -> None:
    mesh = checked(lattice(5, jitter))
    assert mesh.report.smallest_before < 1e-6
    assert mesh.report.ok


def test_a_delaunay_triangulation_is_taken_as_it_is() -> None:
    points, simplices = uniform(100)
    rows = np.concatenate((points, points[:3]))
    tri = delone.Delaunay(rows)
    mesh = delone.improve(tri)
    assert np.array_equal(mesh.simplices, delone.improve((points, simplices)).simplices)
    assert np.array_equal(mesh.points[100:], rows[100:])
    quality = tri.quality()
    assert isinstance(quality, delone.TetQuality)
    assert quality.smallest_dihedral.min() == mesh.report.smallest_before
    assert isinstance(delone.Delaunay(points[:, :2]).quality(), delone.Quality)


def test_flips_alone_move_nothing() -> None:
    given = uniform(300)
    mesh = checked(given, smooth=False)
    assert np.array_equal(mesh.points, given[0])
    assert mesh.report.moves == 0
    assert mesh.report.edge_removals > 0 < mesh.report.face_removals


def test_moves_alone_keep_tetrahedra() -> None:
    given = uniform(300)
    mesh = checked(given, flips=False)
    assert {tuple(sorted(t)) for t in mesh.simplices.tolist()} == {
        tuple(sorted(t)) for t in given[1].tolist()
    }
    assert mesh.report.moves > 0 == mesh.report.edge_removals + mesh.report.face_removals
    assert mesh.report.after[:2].sum() < mesh.report.before[:2].sum()


def lifted(a: Any, weight: Fraction, b: Any) -> list[Fraction]:
    e = minus(a, b)
    return [*e, dot(e, e) - weight]


@pytest.mark.deep
def test_exudation_alone_makes_a_regular_triangulation() -> None:
    """Across each face the far vertex is above the plane of the lifted corners, exactly."""
    given = uniform(300)
    mesh = checked(given, flips=False, smooth=False, exude=True)
    report = mesh.report
    assert np.array_equal(mesh.points, given[0])
    assert report.exudations == np.count_nonzero(report.weights) > 20
    assert report.after[:2].sum() < report.before[:2].sum()
    p, w = exact(mesh.points), [Fraction(x) for x in report.weights.tolist()]
    for t, row in enumerate(mesh.neighbors.tolist()):
        for u in (u for u in row if u > t):
            far = (set(mesh.simplices[u].tolist()) - set(mesh.simplices[t].tolist())).pop()
            rows = [lifted(p[v], w[v] - w[far], p[far]) for v in mesh.simplices[t].tolist()]
            # The determinant of order four, by its last column.
            value = sum(
                (-1) ** (i + 1) * rows[i][3]
                * determinant(*(rows[j][:3] for j in range(4) if j != i))
                for i in range(4)
            )  # fmt: skip
            assert value >= 0
    both = checked(given, exude=True)
    assert both.report.exudations == report.exudations


def test_nothing_is_done_without_leave() -> None:
    given = uniform(100)
    for options in ({"flips": False, "smooth": False}, {"max_iter": 0}, {"min_angle": 0}):
        mesh = delone.improve(given, **options)
        assert np.array_equal(mesh.points, given[0])
        assert len(mesh.simplices) == len(given[1])


@pytest.mark.deep
def test_a_second_run_starts_where_the_first_ended() -> None:
    first = delone.improve(uniform(300), max_iter=1000)
    again = checked((first.points, first.simplices), max_iter=1000)
    assert len(again.report.below) <= 1.2 * len(first.report.below)
    assert again.report.smallest_before == first.report.smallest_after
    done = delone.improve(ball(400, 200), min_angle=15)
    same = delone.improve(done, min_angle=15)
    assert {tuple(sorted(t)) for t in same.simplices.tolist()} == {
        tuple(sorted(t)) for t in done.simplices.tolist()
    }
    assert np.array_equal(same.points, done.points)
    assert same.report.passes == 0


def test_rows_may_come_in_any_order() -> None:
    points, simplices = uniform(200)
    mesh = delone.improve((points, simplices))
    rng = np.random.default_rng(5)
    order = rng.permutation(len(points))
    row = np.argsort(order)
    even = np.array([(0, 1, 2, 3), (1, 2, 0, 3), (3, 2, 1, 0), (2, 3, 0, 1)])
    mixed = row[simplices][rng.permutation(len(simplices))]
    mixed = np.take_along_axis(mixed, even[rng.integers(4, size=len(mixed))], axis=1)
    other = delone.improve((points[order], mixed))
    assert np.array_equal(mesh.points, other.points[row])
    assert np.array_equal(mesh.simplices, order[other.simplices])
    assert np.array_equal(mesh.neighbors, other.neighbors)


def test_powers_of_two_and_signs_of_zero_change_nothing() -> None:
    points, simplices = lattice(4, 0.3)
    mesh = delone.improve((points, simplices))
    for factor in (2.0**-300, 0.25, 2.0**500):
        scaled = delone.improve((points * factor, simplices))
        assert np.array_equal(scaled.points, mesh.points * factor)
        assert np.array_equal(scaled.simplices, mesh.simplices)
    signed = np.where(points == 0, -0.0, points)
    assert np.array_equal(delone.improve((signed, simplices)).simplices, mesh.simplices)


def test_regions_are_kept_apart() -> None:
    points, simplices = lattice(6, 0.3)
    centers = points[simplices].mean(axis=1)
    region = (centers[:, 0] > 2.4).astype(int) + 7
    mesh = delone.improve((points, simplices), region=region)
    for number in (7, 8):
        old, new = simplices[region == number], mesh.simplices[mesh.region == number]
        assert outside(old) == outside(new)
        assert volume(points, old) == volume(mesh.points, new)
    again = delone.improve(mesh, min_angle=25)
    assert set(again.region.tolist()) == {7, 8}
    assert outside(mesh.simplices[mesh.region == 7]) == outside(again.simplices[again.region == 7])


@pytest.mark.deep
def test_fixed_points_stay() -> None:
    points, simplices = uniform(300)
    rows = np.arange(0, 300, 2)
    mesh = checked((points, simplices), fixed=rows)
    assert np.array_equal(mesh.points[rows], points[rows])
    mask = np.zeros(300, dtype=bool)
    mask[rows] = True
    same = delone.improve((points, simplices), fixed=mask)
    assert np.array_equal(same.points, mesh.points)
    still = delone.improve((points, simplices), fixed=np.arange(300))
    assert np.array_equal(still.points, points)


@pytest.mark.parametrize("seed", seeds(2, deep=10))
def test_added_points_make_angles_larger(seed: int) -> None:
    # Most slivers have all four vertices on the hull.
    points = np.random.default_rng(seed).normal(size=(100, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    tri = delone.Delaunay(points)
    without = delone.improve(tri)
    mesh = checked((tri.points, tri.simplices), max_points=200)
    assert 0 < mesh.nadded == mesh.report.points_added == mesh.npoints - len(points) <= 200
    assert mesh.report.smallest_after > without.report.smallest_after
    assert f"{mesh.nadded} points added" in str(mesh.report)
    few = checked((tri.points, tri.simplices), max_points=3)
    assert few.nadded == 3


def test_added_points_of_a_mesh_are_its_last_rows() -> None:
    points = [
        (0, 0, 0),
        (4, 0, 0),
        (4, 4, 0),
        (0, 4, 0),
        (0, 0, 1),
        (4, 0, 1),
        (4, 4, 1),
        (0, 4, 1),
    ]
    sides = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    faces = [face for a, b, c, d in sides for face in ((a, b, c), (a, c, d))]
    markers = np.arange(12)
    box = delone.tetrahedralize(np.array(points, float), faces, face_markers=markers)
    mesh = delone.improve(box, min_angle=40, max_points=50)
    changed = mesh.report.points_added - mesh.report.points_removed
    assert mesh.nadded == box.nadded + changed > box.nadded
    assert np.array_equal(mesh.points[:8], points)
    assert np.array_equal(mesh.input_faces, box.input_faces)
    assert np.array_equal(mesh.face_markers, box.face_markers)
    assert mesh.validate().ok
    again = delone.improve(
        mesh, min_angle=40, max_points=50, flips=False, smooth=False, contract="none"
    )
    assert again.nadded == mesh.nadded + again.report.points_added
    copied = pickle.loads(pickle.dumps(mesh))
    assert copied.nadded == mesh.nadded
    assert copied.report.points_added == mesh.report.points_added


def test_flat_sides_may_be_flipped() -> None:
    """Two tetrahedra over a kite whose long diagonal is an edge of the flat side below."""
    points = np.array([(0, -4, 0), (0, 4, 0), (1, 0, 0), (-1, 0, 0), (0, 0, 1.0)])
    kite = points, np.array([(0, 2, 1, 4), (0, 1, 3, 4)])
    kept = checked(kite, min_angle=60)
    assert kept.report.edge_removals + kept.report.boundary_flips == 0
    cube = lattice(5, 0.0)[0]
    shear = cube[:, 0] + 0.3 * cube[:, 1]
    given = delaunay(np.column_stack((shear, cube[:, 1:])))
    mesh = checked(given, min_angle=60, boundary="surface", smooth=False)
    assert mesh.report.boundary_flips > 0
    assert outside(mesh.simplices) != outside(given[1])
    area = sum(np.linalg.norm(np.cross(*(mesh.points[f[1:]] - mesh.points[f[0]])))
               for f in mesh.boundary)  # fmt: skip
    before = [list(f) for f in outside(given[1])]
    was = sum(np.linalg.norm(np.cross(*(given[0][f[1:]] - given[0][f[0]]))) for f in before)
    assert area == pytest.approx(was, rel=1e-12)


def test_angles_between_walls_are_named(tmp_path: Path) -> None:
    """A sheet inside rises from an edge of a box by a small angle; the edge is named."""
    low = np.array([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)])
    points = np.concatenate((low, low + np.array((0, 0, 4)), [(4, 0, 0.5), (4, 4, 0.5)]))
    box = delone.ConvexHull(points[:8]).simplices
    # A sheet from one edge of the box upward: 7.1 degrees above the bottom, 83 degrees elsewhere.
    faces = np.concatenate((box, [(0, 8, 9), (0, 9, 3)]))
    mesh = delone.tetrahedralize(points, faces, imprint=True, min_angle=20, size=1.5)
    report = mesh.report.improvement
    assert report is not None
    forced = report.cause == "angle"
    assert forced.any()
    ends = mesh.points[report.wall_edges[forced]]
    assert (ends[:, :, [0, 2]] == 0).all()
    for row, edge in zip(report.below[forced], report.wall_edges[forced], strict=True):
        assert np.isin(edge, mesh.simplices[row]).all()
    mesh.save(tmp_path / "wedge.npz")
    loaded = TetMesh.load(tmp_path / "wedge.npz")
    assert (loaded.report.improvement.wall_edges == report.wall_edges).all()


def test_what_is_left_has_its_cause() -> None:
    flat = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.3, 0.3, 0.01)])
    report = delone.improve((flat, [(0, 1, 2, 3)])).report
    assert report.cause.tolist() == ["angle"]
    # All edges of the base have angles below the goal; the smallest one is at y = 0.
    report = delone.improve(
        (flat + np.array((0, 0.05, 0)) * (flat[:, 2:] > 0), [(0, 1, 2, 3)])
    ).report
    assert report.wall_edges.tolist() == [[0, 1]]
    assert "1 edge of the boundary has such an angle, between the points 0 to 1" in str(report)
    # As thin as rounding: that is the cause, although all faces are walls.
    report = delone.improve((flat * (1, 1, 2.0**-50), [(0, 1, 2, 3)])).report
    assert (report.cause.tolist(), report.wall_edges.tolist()) == (["rounding"], [[-1, -1]])
    hull = ball(0, 40)
    left = delone.improve(hull, min_angle=30).report
    assert set(left.cause.tolist()) <= {"angle", "boundary"}
    forced = left.cause == "angle"
    assert ((left.wall_edges >= 0).all(axis=1) == forced).all()
    assert (left.wall_edges[~forced] == -1).all()
    assert len(left.below)
    assert "boundary" in str(left)
    cut = delone.improve(uniform(300), max_iter=1).report
    assert cut.exhausted
    assert "budget" in cut.cause.tolist()
    assert "stopped at the limit on passes" in str(cut)


def test_progress_is_told_and_may_stop_it() -> None:
    told: list[tuple[int, int]] = []
    mesh = delone.improve(uniform(300), progress=lambda *at: told.append(at))
    assert [number for number, _ in told] == list(range(1, mesh.report.passes + 1))

    def stop(number: int, below: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        delone.improve(uniform(300), progress=stop)


def test_a_mesh_is_immutable_and_travels() -> None:
    mesh = delone.improve(uniform(50))
    assert repr(mesh) == f"<TetMesh of 50 points: {mesh.nsimplex} tetrahedra>"
    with pytest.raises(AttributeError):
        mesh.points = mesh.points  # type: ignore[misc]
    with pytest.raises(AttributeError):
        del mesh._points
    with pytest.raises(ValueError, match="read-only"):
        mesh.points[0] = 0
    other = pickle.loads(pickle.dumps(mesh))
    assert np.array_equal(other.simplices, mesh.simplices)
    assert other.report.smallest_after == mesh.report.smallest_after
    assert copy.copy(mesh) is mesh is copy.deepcopy(mesh)
    v, e, f = 50, len(mesh.edges), (4 * mesh.nsimplex + len(mesh.boundary)) // 2
    assert v - e + f - mesh.nsimplex == 1
    assert repr(TetMesh.__new__(TetMesh)) == "<TetMesh of nothing yet>"


@pytest.mark.parametrize("given", [(), ([(0, 0, 0)],), (None, None)])
def test_the_class_is_not_called(given: tuple[Any, ...]) -> None:
    with pytest.raises(DtypeError, match=r"delone\.improve"):
        TetMesh(*given)


def test_the_volume_is_that_of_the_hull() -> None:
    mesh = delone.improve(uniform(100))
    assert mesh.volumes.sum() == pytest.approx(float(volume(mesh.points, mesh.simplices) / 6))


CORNER = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1.0), (0, 0, 2), (0, 0, 0)])


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ((CORNER, [(1, 0, 2, 3)]), InputError, "1 tetrahedron is negatively oriented.*first: 0"),
        ((CORNER, [(0, 1, 2, 3), (0, 3, 4, 1)]), InputError, "1 tetrahedron is flat; first: 1"),
        ((CORNER, [(0, 1, 2, 2)]), InputError, "flat"),
        ((CORNER, [(0, 1, 2, 3), (5, 1, 2, 4)]), InputError, "rows 0 and 5 are the same point"),
        ((CORNER, [(0, 1, 2, 3), (0, 1, 2, 4), (0, 1, 2, 3)]), InputError, "on the same side"),
        ((CORNER, [(0, 1, 2, 9)]), InputError, "9"),
        ((CORNER, [(0, 1, 2)]), ShapeError, "shape"),
        ((CORNER[:, :2], [(0, 1, 2, 3)]), ShapeError, "points"),
        ((CORNER, np.empty((0, 4), dtype=int)), InputError, "no tetrahedra"),
        ((np.where(CORNER == 2, np.nan, CORNER), [(0, 1, 2, 3)]), NonFiniteError, "NaN"),
        ((CORNER,), ShapeError, "points, simplices"),
        ((CORNER, [(0.5, 1, 2, 3)]), DtypeError, "integer"),
        ("mesh", DtypeError, "mesh must be a 3-D Delaunay"),
        (delone.Delaunay([(0, 0), (1, 0), (0, 1)]), DtypeError, "Delaunay"),
    ],
)
def test_what_is_no_mesh_is_refused(given: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        delone.improve(given)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"min_angle": -1}, InputError),
        ({"min_angle": 71}, InputError),
        ({"min_angle": np.nan}, InputError),
        ({"min_angle": "steep"}, DtypeError),
        ({"boundary": "any"}, InputError),
        ({"max_iter": -1}, InputError),
        ({"max_iter": 1.5}, DtypeError),
        ({"region": [0.5]}, DtypeError),
        ({"region": [1, 2]}, ShapeError),
        ({"region": [2**40]}, InputError),
        ({"fixed": [True]}, ShapeError),
        ({"fixed": [7]}, InputError),
        ({"fixed": [0.5]}, DtypeError),
        ({"fixed": [[1]]}, ShapeError),
        ({"progress": 3}, DtypeError),
        ({"flips": "a"}, DtypeError),
        ({"flips": None}, DtypeError),
        ({"smooth": 1}, DtypeError),
        ({"exude": "no"}, DtypeError),
    ],
)
def test_options_are_checked(options: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        delone.improve((CORNER, [(0, 1, 2, 3)]), **options)


def test_passes_may_be_any_number() -> None:
    given = (CORNER, [(0, 1, 2, 3)])
    assert delone.improve(given, max_iter=10**30).report.passes == (
        delone.improve(given).report.passes
    )
    assert delone.improve(given, flips=np.False_).nsimplex == 1


def test_tetrahedra_that_overlap_at_a_vertex_are_refused() -> None:
    """Two stars around one vertex, each closed."""
    outer = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1.0)])
    points = np.concatenate(([(0, 0, 0)], outer, 2 * outer))
    star = np.array([(0, 1, 3, 2), (0, 1, 2, 4), (0, 2, 3, 4), (0, 3, 1, 4)])
    signs = delone.predicates.orient3d(*(points[star[:, k]] for k in range(4)))
    star[signs < 0] = star[signs < 0][:, [1, 0, 2, 3]]
    other = np.where(star > 0, star + 4, 0)
    assert delone.improve((points, star)).nsimplex == 4
    with pytest.raises(InputError, match="overlap"):
        delone.improve((points, np.concatenate((star, other))))


def test_points_that_nothing_uses_stay() -> None:
    points = np.concatenate((OCTAHEDRON[0], [(9, 9, 9), (0, 0, 0)]))
    mesh = delone.improve((points, OCTAHEDRON[1]))
    assert np.array_equal(mesh.points, points)


@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
def test_files_hold_the_mesh(suffix: str, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    mesh = delone.improve(uniform(50))
    path = tmp_path / f"mesh{suffix}"
    delone.io.write_mesh(path, mesh, attributes={"weight": np.arange(50.0)})
    read = meshio.read(path)
    assert np.array_equal(read.points, mesh.points)
    assert np.array_equal(read.cells_dict["tetra"], mesh.simplices)
    angles = read.cell_data["smallest_dihedral"][0]
    assert np.array_equal(np.ravel(angles), mesh.quality().smallest_dihedral)
    assert np.array_equal(np.ravel(read.point_data["weight"]), np.arange(50.0))


def test_meshio_takes_it() -> None:
    pytest.importorskip("meshio")
    points, simplices = uniform(30)
    points, halves = np.concatenate((points, points + 2)), (simplices, simplices + 30)
    region = np.repeat([7, 4], len(simplices))
    mesh = delone.improve((points, np.concatenate(halves)), region=region, smooth=False)
    found = mesh.to_meshio()
    assert np.array_equal(found.points, points)
    assert [block.type for block in found.cells] == ["tetra"]
    assert np.array_equal(found.cells_dict["tetra"], mesh.simplices)
    assert list(found.cell_data) == ["region", "smallest_dihedral"]
    side = found.points[found.cells_dict["tetra"][:, 0], 0] > 1.5
    assert np.array_equal(found.cell_data["region"][0], np.where(side, 4, 7))
    angles = found.cell_data["smallest_dihedral"][0]
    assert np.array_equal(angles, mesh.quality().smallest_dihedral)


def test_files_of_the_plane_refuse_it(tmp_path: Path) -> None:
    mesh = delone.improve(uniform(50))
    for name in ("mesh.geojson", "mesh.stl"):
        with pytest.raises(delone.FileFormatError, match=r"tetrahedra|TetMesh"):
            delone.io.write_mesh(tmp_path / name, mesh)
    with pytest.raises(delone.FileFormatError, match="heights"):
        delone.io.write_mesh(tmp_path / "mesh.vtu", mesh, z=np.zeros(50))
    assert not list(tmp_path.iterdir())


def test_pyvista_takes_it() -> None:
    pytest.importorskip("pyvista")
    mesh = delone.improve(uniform(50))
    grid = mesh.to_pyvista()
    assert (grid.n_cells, grid.n_points) == (mesh.nsimplex, 50)
    assert mesh.plot() is not None


def test_the_report_draws_itself() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    report = delone.improve(uniform(50)).report
    ax = report.plot()
    assert len(ax.patches) == 2 * len(report.before)
    assert ax.get_yscale() == "log"


def box(turned: bool) -> np.ndarray:
    """Points of the sides of a box, and others inside, turned or not."""
    rng = np.random.default_rng(3)
    axis = np.linspace(0, 1, 7)
    grid = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    sides = grid[((grid == 0) | (grid == 1)).any(axis=1)]
    points = np.concatenate((sides, 0.1 + 0.8 * rng.random((60, 3))))
    if not turned:
        return points
    (a, b), (c, d) = (np.cos([0.7, 0.4]), np.sin([0.7, 0.4]))
    turn = np.array([[a, -c, 0], [c, a, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, b, -d], [0, d, b]]
    return points @ turn.T


def thickness(corners: list[Any]) -> Fraction:
    """The square of the smallest height of a tetrahedron."""
    p, q, r = (minus(end, corners[0]) for end in corners[1:])
    across = [cross(p, q), cross(q, r), cross(r, p), cross(minus(q, p), minus(r, p))]
    return dot(across[0], r) ** 2 / max(dot(each, each) for each in across)


def test_a_turned_box_says_which_tetrahedra_are_as_thin_as_the_rounding() -> None:
    straight = delone.improve(delone.Delaunay(box(turned=False)))
    assert straight.report.ok
    mesh = delone.improve(delone.Delaunay(box(turned=True)))
    report = mesh.report
    thin = report.cause == "rounding"
    assert (report.wall_edges[thin] == -1).all()
    limit = (16 * Fraction(2) ** -53 * Fraction(float(np.abs(mesh.points).max()))) ** 2
    for row, is_thin in zip(report.below, thin, strict=True):
        corners = exact(mesh.points[mesh.simplices[row]])
        assert (thickness(corners) <= limit) == is_thin
    assert thin.sum() > 400
    assert "as thin as the rounding of coordinates" in str(report)
    # Without these, the turned box is as good as the straight one, within a factor of two.
    rest = np.delete(mesh.simplices, report.below[thin], axis=0)
    better = delone.improve((mesh.points, rest))
    assert not (better.report.cause == "rounding").any()
    assert better.report.smallest_after > straight.report.smallest_after / 2
    assert better.quality().volume.sum() == pytest.approx(1, rel=1e-12)
    assert len(np.unique(better.simplices)) == len(mesh.points)
