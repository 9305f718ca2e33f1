"""Improvement that keeps only the surface: sliding vertices, removed tetrahedra."""

from __future__ import annotations

import itertools
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import InputError, TetMesh
from tetrahedra import volume

# A box with a facet on every axis, in exact coordinates that differ by axis.
LOW, HIGH = np.array([-1.0, 0.5, 3.0]), np.array([1.0, 2.25, 4.5])


def box(count: int, rim: int, seed: int = 0) -> np.ndarray:
    """Points in a box, on its sides and edges, and its corners, at the end."""
    rng = np.random.default_rng(seed)
    inside, sides = rng.random((count, 3)), rng.random((rim, 3))
    for i in range(rim):
        sides[i, i % 3] = i // 3 % 2
    edges = rng.random((24, 3))
    for i in range(24):
        edges[i, (i % 3, (i + 1) % 3)] = i // 3 % 2, i // 6 % 2
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    return LOW + (HIGH - LOW) * np.concatenate((inside, sides, edges, corners))


def sides_of(points: np.ndarray) -> np.ndarray:
    """Which of the six sides of the box each point is exactly on."""
    return np.concatenate((points == LOW, points == HIGH), axis=1)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.sampled(1)
def test_vertices_slide_in_flat_sides_and_straight_edges(seed: int) -> None:
    points = box(200, 120, seed)
    given = points, delone.Delaunay(points).simplices
    kept = delone.improve(given, boundary="faces")
    mesh = delone.improve(given, boundary="surface")
    report = mesh.report
    moved = (mesh.points != points).any(axis=1)
    on = sides_of(points)
    # The points of sides and edges stay on each of them, and some of both kinds move.
    assert np.array_equal(sides_of(mesh.points)[on.any(axis=1)], on[on.any(axis=1)])
    assert moved[on.sum(axis=1) == 1].any() and moved[on.sum(axis=1) == 2].any()
    assert not moved[on.sum(axis=1) == 3].any()
    assert report.boundary_moves >= moved[on.any(axis=1)].sum() > 0
    assert report.surface_distance == report.tetrahedra_removed == 0
    assert volume(mesh.points, mesh.simplices) == volume(*given)
    assert report.smallest_after > kept.report.smallest_after
    assert kept.report.boundary_moves == 0
    assert mesh.validate()


def test_fixed_points_do_not_slide() -> None:
    points = box(200, 120)
    rim = sides_of(points).any(axis=1)
    given = points, delone.Delaunay(points).simplices
    mesh = delone.improve(given, boundary="surface", fixed=rim)
    assert np.array_equal(mesh.points[rim], points[rim])
    assert mesh.report.boundary_moves == 0
    assert mesh.report.moves > 0
    still = delone.improve(given, boundary="surface", smooth=False)
    assert np.array_equal(still.points, points)


def test_the_order_of_rows_changes_nothing() -> None:
    points = box(120, 90)
    order = np.random.default_rng(1).permutation(len(points))
    one = delone.improve(delone.Delaunay(points), boundary="surface", tolerance=0.1)
    two = delone.improve(delone.Delaunay(points[order]), boundary="surface", tolerance=0.1)
    assert np.array_equal(one.points[order], two.points)
    first = {tuple(sorted(v)) for v in one.simplices.tolist()}
    assert first == {tuple(sorted(order[v].tolist())) for v in two.simplices}


@pytest.mark.parametrize("power", [-1000, -900, -400, -30, 300, 1000])
def test_powers_of_two_change_nothing(power: int) -> None:
    points = box(120, 90)[:-8]
    one = delone.improve(delone.Delaunay(points), boundary="surface", tolerance=0.1)
    scaled = np.ldexp(points, power)
    two = delone.improve(
        delone.Delaunay(scaled), boundary="surface", tolerance=float(np.ldexp(0.1, power))
    )
    assert one.report.boundary_moves > 0 < one.report.tetrahedra_removed
    assert np.array_equal(np.ldexp(one.points, power), two.points)
    assert np.array_equal(one.simplices, two.simplices)
    assert np.ldexp(one.report.surface_distance, power) == two.report.surface_distance


@pytest.mark.parametrize("power", [-1019, -1022, -1060])
def test_subnormal_coordinates_are_valid(power: int) -> None:
    # They have fewer bits, so results differ from those of other scales.
    points = np.ldexp(np.random.default_rng(0).random((60, 3)), power)
    assert delone.improve(delone.Delaunay(points)).validate()


def test_the_interface_of_regions_stays_in_its_plane() -> None:
    rng = np.random.default_rng(5)
    points = np.concatenate((box(150, 90), LOW + (HIGH - LOW) * rng.random((60, 3))))
    points[-60:, 0] = 0
    triangulation = delone.Delaunay(points)
    # Tetrahedra that cross the plane are left out: the two regions meet in parts of it.
    x = points[triangulation.simplices][:, :, 0]
    left, right = (x <= 0).all(axis=1), (x >= 0).all(axis=1)
    simplices, region = triangulation.simplices[left | right], right[left | right].astype(int)
    mesh = delone.improve((points, simplices), region=region, boundary="surface")
    moved = (mesh.points != points).any(axis=1)
    assert moved[-60:].any()
    assert (mesh.points[-60:, 0] == 0).all()
    for k in range(2):
        before = volume(points, simplices[region == k])
        assert volume(mesh.points, mesh.simplices[mesh.region == k]) == before


def test_a_vertex_where_planes_meet_at_an_angle_stays() -> None:
    """A pyramid over a bent base: its middle is on two facets, but on no straight edge."""
    bend = 2.0**-40
    points = np.array(
        [(0, 0, 0), (1, 0, 0), (0, 1, bend), (-1, bend, 0), (0, -1, bend), (0.3, 0.2, -0.05)],
        dtype=float,
    )
    base = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)]
    simplices = np.array([(b, a, c, 5) for a, b, c in base])
    mesh = delone.improve((points, simplices), boundary="surface", min_angle=60)
    assert np.array_equal(mesh.points[:5], points[:5])


def apart(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The distance of each point from the nearest of the triangles, (k, 3, 3)."""
    best = np.full(len(points), np.inf)
    for a, b, c in triangles:
        ab, ac = b - a, c - a
        normal = np.cross(ab, ac)
        # The foot on the plane, in barycentric coordinates.
        u = np.cross(points - a, ac) @ normal / (normal @ normal)
        v = np.cross(ab, points - a) @ normal / (normal @ normal)
        over = (u >= 0) & (v >= 0) & (u + v <= 1)
        height = np.abs((points - a) @ normal) / np.sqrt(normal @ normal)
        best[over] = np.minimum(best[over], height[over])
        for p, q in ((a, b), (b, c), (c, a)):
            along = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            foot = p + along[:, None] * (q - p)
            best = np.minimum(best, np.sqrt(((points - foot) ** 2).sum(axis=1)))
    return best


def spots(triangles: np.ndarray, seed: int) -> np.ndarray:
    """Some random points of each triangle, and its corners."""
    weights = np.random.default_rng(seed).dirichlet(np.ones(3), (len(triangles), 6))
    return np.concatenate(((weights @ triangles).reshape(-1, 3), triangles.reshape(-1, 3)))


@pytest.mark.parametrize("tolerance", [0.02, 0.1])
def test_the_boundary_remains_within_the_tolerance(tolerance: float) -> None:
    points = np.random.default_rng(3).random((250, 3))
    given = delone.Delaunay(points)
    mesh = delone.improve(given, boundary="surface", tolerance=tolerance)
    report = mesh.report
    assert report.tetrahedra_removed > 0
    assert 0 < report.surface_distance <= tolerance
    # The boundary is a closed surface, every point has a tetrahedron, and the rest is as before.
    assert mesh.validate()
    assert set(np.unique(mesh.simplices)) == set(range(len(points)))
    assert volume(mesh.points, mesh.simplices) < volume(points, given.simplices)
    old, new = points[given.boundary], mesh.points[mesh.boundary]
    limit = report.surface_distance * (1 + 1e-9)
    assert apart(spots(old, 1), new).max() <= limit
    there = apart(spots(new, 2), old).max()
    assert limit / 20 < there <= limit
    assert f"removed at the boundary, which remains within {report.surface_distance:.2g}" in str(
        report
    )


def test_a_larger_tolerance_removes_more() -> None:
    points = np.random.default_rng(3).random((250, 3))
    smallest, removed = [], []
    for tolerance in (0.0, 0.02, 0.1):
        report = delone.improve(
            delone.Delaunay(points), boundary="surface", tolerance=tolerance
        ).report
        smallest.append(report.smallest_after)
        removed.append(report.tetrahedra_removed)
    assert removed[0] == 0
    assert removed[0] < removed[1] < removed[2]
    assert smallest[0] < smallest[1] <= smallest[2]


def test_the_rounding_of_rotated_boxes_is_removed() -> None:
    turn, _ = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))
    points = box(300, 150) @ turn
    before = delone.improve(delone.Delaunay(points), boundary="surface").report
    after = delone.improve(delone.Delaunay(points), boundary="surface", tolerance=1e-11).report
    assert (before.cause == "rounding").sum() > 20
    assert (after.cause == "rounding").sum() < (before.cause == "rounding").sum() * 0.6
    assert after.surface_distance <= 1e-11


def test_a_wall_between_regions_is_not_removed() -> None:
    # A sliver on the boundary, each of whose neighbors has another region.
    points = np.array(
        [(0, 0, 0), (2, 2, 0), (2, 0, 0.01), (0, 2, 0.01), (1, 1, 2), (1, 1, 3)], float
    )
    simplices = np.array([(0, 1, 2, 3), (0, 2, 3, 4), (1, 3, 2, 4)])
    signs = [np.linalg.det(points[v[1:]] - points[v[0]]) for v in simplices]
    simplices = np.array(
        [v if s > 0 else v[[1, 0, 2, 3]] for v, s in zip(simplices, signs, strict=True)]
    )
    options = {"boundary": "surface", "tolerance": 0.1, "flips": False, "smooth": False}
    one = delone.improve((points, simplices), **options)
    assert one.report.tetrahedra_removed == 1
    assert one.nsimplex == 2
    assert 0.01 <= one.report.surface_distance < 0.0100001
    two = delone.improve((points, simplices), region=[0, 1, 1], **options)
    assert two.report.tetrahedra_removed == 0


def test_the_report_is_saved(tmp_path: Path) -> None:
    points = np.random.default_rng(3).random((150, 3))
    mesh = delone.improve(delone.Delaunay(points), boundary="surface", tolerance=0.1)
    mesh.save(tmp_path / "mesh.npz")
    again = TetMesh.load(tmp_path / "mesh.npz").report
    for name in ("tetrahedra_removed", "boundary_moves", "surface_distance"):
        assert getattr(again, name) == getattr(mesh.report, name)
    assert again.tetrahedra_removed > 0


@pytest.mark.parametrize("tolerance", [-1.0, np.nan, np.inf, "1"])
def test_a_tolerance_is_a_distance(tolerance: object) -> None:
    with pytest.raises((InputError, TypeError), match="tolerance"):
        delone.improve(delone.Delaunay(box(20, 12)), boundary="surface", tolerance=tolerance)


def test_a_tolerance_needs_the_surface() -> None:
    with pytest.raises(InputError, match='tolerance needs boundary="surface"'):
        delone.improve(delone.Delaunay(box(20, 12)), tolerance=0.1)


def test_volumes_of_removed_tetrahedra_add_up() -> None:
    """What is removed is small: at most the tolerance times the area of the boundary."""
    points = np.random.default_rng(8).random((200, 3))
    given = delone.Delaunay(points)
    mesh = delone.improve(given, boundary="surface", tolerance=0.05)
    corners = points[given.boundary]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = float(np.sqrt((normals**2).sum(axis=1)).sum() / 2)
    lost = volume(points, given.simplices) - volume(mesh.points, mesh.simplices)
    assert 0 < lost <= Fraction(0.05 * area) * 6


def umbrellas(faces: np.ndarray) -> bool:
    """Whether each edge has two faces, and the faces around each vertex form one cycle."""
    around: dict[int, dict[int, int]] = {}
    for a, b, c in faces.tolist():
        for u, v, w in ((a, b, c), (b, c, a), (c, a, b)):
            ahead = around.setdefault(u, {})
            if v in ahead:
                return False
            ahead[v] = w
    for ahead in around.values():
        met, here = set(), next(iter(ahead))
        while here in ahead and here not in met:
            met.add(here)
            here = ahead[here]
        if len(met) < len(ahead):
            return False
    return True


@pytest.mark.parametrize("seed", range(4))
def test_thin_plates_stay_whole(seed: int) -> None:
    """Everything is within the tolerance: only what would pinch the boundary remains."""
    points = np.random.default_rng(seed).random((120, 3)) * (1, 1, 0.04)
    given = delone.Delaunay(points)
    mesh = delone.improve(given, boundary="surface", tolerance=0.5)
    assert mesh.report.tetrahedra_removed > 20
    assert mesh.validate()
    assert umbrellas(mesh.boundary)
    v, f = len(np.unique(mesh.boundary)), len(mesh.boundary)
    assert v - f / 2 == 2
    assert set(np.unique(mesh.simplices)) == set(range(len(points)))


def oriented(points: np.ndarray, simplices: list[tuple[int, ...]]) -> np.ndarray:
    """Tetrahedra with two corners swapped where that makes them positive."""
    made = np.array(simplices)
    a, b, c, d = (points[made[:, k]] for k in range(4))
    negative = (np.cross(b - a, c - a) * (d - a)).sum(axis=1) < 0
    made[negative] = made[negative][:, [1, 0, 2, 3]]
    return made


@pytest.mark.parametrize("x", [0.1, 0.3, -0.3])
def test_the_front_of_a_slit_stays(x: float) -> None:
    """All walls at its middle vertex are in one plane, but on one side of the front."""
    points = np.array([(-0.5, -1, 0), (x, 0.2, 0), (0.5, 1, 0), (2, 0.1, 0), (2, -0.1, 0),
                       (1, 0, 1.5), (-1.5, 0, 0.6), (-1.5, 0, -0.6), (1, 0, -1.5)])  # fmt: skip
    # Around the front, from the upper side of the slit to the lower one.
    ring = [3, 5, 6, 7, 8, 4]
    both = [(x, y, end, 1) for x, y in itertools.pairwise(ring) for end in (0, 2)]
    mesh = delone.improve((points, oriented(points, both)), boundary="surface", min_angle=60)
    # Inside a straight edge it may slide along it, at a corner of the front it stays.
    place = mesh.points[1]
    assert (place[0], place[2]) == (place[1] / 2 if x == 0.1 else x, 0)
    assert x == 0.1 or place[1] == 0.2
    assert mesh.validate()


def test_bodies_that_touch_with_other_diagonals_keep_one() -> None:
    points = np.array([(0.1, -0.1, 0), (0.7, -0.3, 0), (1.2, 1.2, 0), (0.1, 1.1, 0),
                       (0.6, 1.4, 0.9), (-0.5, 1.2, -0.2)])  # fmt: skip
    both = [(0, 1, 2, 4), (0, 2, 3, 4), (0, 1, 3, 5), (1, 2, 3, 5)]
    given = points, oriented(points, both)
    mesh = delone.improve(given, boundary="surface", min_angle=60, smooth=False)
    assert mesh.validate()
    # Each body alone gets the better diagonal.
    alone = [
        delone.improve(
            (points, given[1][k : k + 2]), boundary="surface", min_angle=60, smooth=False
        )
        for k in (0, 2)
    ]
    assert sum(one.report.boundary_flips for one in alone) == 1


@pytest.mark.parametrize("second", [(0, 1, 2, 4), (0, 1, 2, 3)])
def test_tetrahedra_on_one_side_of_a_face_are_refused(second: tuple[int, ...]) -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.1, 0.1, 2), (9, 9, 9)])
    # The rows of the input are named, not the order of the coordinates.
    points = points[::-1].copy()
    simplices = 5 - oriented(points[::-1], [(0, 1, 2, 3), second])
    with pytest.raises(InputError, match=r"on the same side of the face of rows (5|4|3|2), "):
        delone.improve((points, simplices))


def test_the_limit_on_passes_does_not_stop_removals() -> None:
    points = np.random.default_rng(3).random((250, 3))
    options = {"boundary": "surface", "tolerance": 0.1}
    removed = [
        delone.improve(delone.Delaunay(points), max_iter=k, **options).report.tetrahedra_removed
        for k in (0, 1)
    ]
    assert all(removed)


@pytest.mark.parametrize("seed", range(6))
def test_both_sides_of_an_interface_stay_positive(seed: int) -> None:
    """A vertex on it moves as far as the tetrahedra of both regions allow."""
    rng = np.random.default_rng(seed)
    points = box(120, 60, seed)
    points = np.concatenate((points, LOW + (HIGH - LOW) * rng.random((40, 3))))
    points[-40:, 0] = 0
    triangulation = delone.Delaunay(points)
    x = points[triangulation.simplices][:, :, 0]
    left, right = (x <= 0).all(axis=1), (x >= 0).all(axis=1)
    simplices, region = triangulation.simplices[left | right], right[left | right].astype(int)
    mesh = delone.improve((points, simplices), region=region, boundary="surface", min_angle=40)
    assert (mesh.points[-40:] != points[-40:]).any()
    assert mesh.validate()
    assert mesh.report.smallest_after >= mesh.report.smallest_before


def test_a_sliver_that_joins_two_parts_stays() -> None:
    """Without it, these would have only an edge in common."""
    points = np.array([(0, -1, 0), (0, 1, 0), (-1, 0, -0.1), (1, 0, -0.1), (0, -2, -1), (0, 2, -1)])
    both = oriented(points, [(0, 1, 2, 3), (0, 2, 3, 4), (1, 2, 3, 5)])
    options = {"boundary": "surface", "tolerance": 0.5, "flips": False, "smooth": False}
    mesh = delone.improve((points, both), **options)
    assert (mesh.report.tetrahedra_removed, mesh.nsimplex) == (0, 3)
    # With tetrahedra around the edge, it is removed.
    points = np.concatenate((points, [(0, 0, -3)]))
    ring = [(0, 1, 2, 3), (0, 2, 3, 4), (1, 2, 3, 5), (2, 3, 4, 6), (2, 3, 5, 6)]
    mesh = delone.improve((points, oriented(points, ring)), **options)
    assert (mesh.report.tetrahedra_removed, mesh.nsimplex) == (1, 4)
    assert mesh.validate()
