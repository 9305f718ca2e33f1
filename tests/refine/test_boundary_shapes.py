"""Points on faces and edges for shapes, and faces that are flat within a tolerance."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.errors import InputError

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


def prism(sides: int, height: float) -> tuple[Floats, Indices]:
    """A prism with long and thin sides."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.column_stack((np.cos(angle), np.sin(angle)))
    points = np.vstack([np.column_stack((ring, np.full(sides, z))) for z in (0.0, height)])
    hull = delone.ConvexHull(points)
    return points, hull.simplices


def wedge(angle: float) -> tuple[Floats, Indices]:
    """A wedge whose large faces meet at a small angle, in radians."""
    top = 4 * np.tan(angle)
    points = [(0, 0, 0), (4, 0, 0), (4, 0, top), (0, 3, 0), (4, 3, 0), (4, 3, top)]
    hull = delone.ConvexHull(points)
    return hull.points, hull.simplices


def meshed(given: tuple[Any, Any], **options: Any) -> Any:
    mesh = delone.tetrahedralize(*given, boundary="surface", radius_edge=2, **options)
    assert mesh.validate()
    return mesh


def smallest(mesh: delone.TetMesh) -> float:
    return float(mesh.quality().smallest_dihedral.min())


@pytest.mark.parametrize("sides", [24, 60])
def test_long_and_thin_sides_are_divided(sides: int) -> None:
    given = prism(sides, 5.0)
    before = delone.tetrahedralize(*given, radius_edge=2, min_angle=20)
    mesh = meshed(given)
    assert mesh.report.on_segments > sides
    assert smallest(mesh) > 15 > smallest(before)


def test_all_ratios_are_reached_where_no_angle_is_small() -> None:
    # A slab: its tetrahedra are flat unless its faces are divided.
    points = [(x, y, z) for x in (0, 4) for y in (0, 4) for z in (0.0, 0.5)]
    hull = delone.ConvexHull(points)
    mesh = meshed((hull.points, hull.simplices), min_angle=0)
    assert mesh.report.on_facets
    assert len(mesh.report.above_ratio) == 0
    assert mesh.report.largest_radius_edge <= 2
    # About as many as are needed: cells of the slab's thickness, in a few layers.
    assert mesh.nsimplex < 40 * 64


@pytest.mark.parametrize("degrees", [0.5, 2, 10, 30])
def test_sharp_angles_end(degrees: float) -> None:
    given = wedge(np.radians(degrees))
    mesh = meshed(given)
    assert not mesh.report.exhausted
    # The floor is half of the shortest edge, an eighth of it for flat faces.
    edge = 4 * np.tan(np.radians(degrees))
    assert mesh.report.added < 400 * (4 / edge) ** 2 + 4000
    edges = np.linalg.norm(np.diff(mesh.points[mesh.input_faces[:, [0, 1, 2, 0]]], axis=1), axis=2)
    assert edges.min() >= edge / 8 - 1e-12


def test_without_a_bound_on_shapes_faces_stay() -> None:
    given = prism(24, 5.0)
    mesh = delone.tetrahedralize(*given, boundary="surface", size=100)
    less = delone.tetrahedralize(*given, boundary="surface").refine(
        radius_edge=None, boundary="surface"
    )
    assert mesh.report.on_segments and not less.report.on_segments


@pytest.mark.parametrize("power", [-200, 300])
def test_powers_of_two_change_nothing(power: int) -> None:
    points, faces = prism(12, 4.0)
    noise = np.random.default_rng(0).uniform(-1e-7, 1e-7, points.shape)
    options = {"boundary": "surface", "radius_edge": 2}
    scale = 2.0**power
    mesh = delone.tetrahedralize(points + noise, faces, tolerance=1e-5, **options)
    scaled = delone.tetrahedralize(
        (points + noise) * scale, faces, tolerance=1e-5 * scale, **options
    )
    assert np.array_equal(mesh.simplices, scaled.simplices)
    assert np.array_equal(mesh.points * scale, scaled.points)


def box(count: int) -> tuple[Floats, Indices]:
    """A box with a lattice of points on each side, turned, in single precision."""
    at = np.linspace(0, 1, count)
    lattice = np.array([(x, y, z) for x in at for y in at for z in at])
    outer = lattice[((lattice == 0) | (lattice == 1)).any(axis=1)]
    filled = delone.Delaunay(outer)
    simplex, corner = np.nonzero(filled.neighbors < 0)
    others = np.array([(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)])
    points = (outer @ TURN).astype(np.float32).astype(float)
    return points, filled.simplices[simplex[:, None], others[corner]]


def bent(mesh: delone.TetMesh, given: tuple[Floats, Indices]) -> Floats:
    """The largest distance of vertices on faces from the planes of the box's sides."""
    used = np.unique(mesh.input_faces)
    local = mesh.points[used] @ TURN.T
    off: Floats = np.abs(np.concatenate((local, local - 1), axis=1)).min(axis=1)
    return off


def test_nearly_flat_sides_are_joined() -> None:
    given = box(5)
    exact, joined = (meshed(given, size=0.1, tolerance=t) for t in (None, 1e-6))
    # Of the edges of the lattice, those of the box are left.
    assert joined.report.on_segments < exact.report.on_segments / 3
    assert 2e-6 < joined.report.surface_distance < 2.001e-6
    assert bent(joined, given).max() < 2e-6
    assert joined.quality().smallest_dihedral.min() >= 20
    half = meshed(given, size=0.1, tolerance=1e-9)
    assert half.report.on_segments > exact.report.on_segments / 2


def test_facets_do_not_drift_over_many_parts() -> None:
    """A strip that bends a little at each edge is not flat, however small the bends are."""
    steps = np.linspace(0, 1.2, 60)
    arc = np.column_stack((np.cos(steps), np.zeros(60), np.sin(steps)))
    ring = np.vstack((arc, [(0.2, 0, 0), (0.2, 0, 0.3)][:1]))
    points = np.vstack((ring, ring + np.array((0, 1, 0))))
    n = len(ring)
    faces = [(k, (k + 1) % n, n + (k + 1) % n) for k in range(n)]
    faces += [(k, n + (k + 1) % n, n + k) for k in range(n)]
    faces += [(n - 1, k + 1, k) for k in range(n - 2)]
    faces += [(2 * n - 1, n + k, n + k + 1) for k in range(n - 2)]
    tolerance = 1e-3
    mesh = delone.tetrahedralize(
        points, faces, boundary="surface", inside="enclosed", size=0.08, tolerance=tolerance
    )
    assert mesh.validate()
    assert mesh.report.on_facets
    # All points of the arc's faces are still near the arc.
    used = mesh.points[np.unique(mesh.input_faces)]
    radius = np.hypot(used[:, 0], used[:, 2])
    flat = np.abs(steps[1] - steps[0]) ** 2 / 8
    outer = used[(radius > 0.95) & (used[:, 1] > 0) & (used[:, 1] < 1)]
    near = np.hypot(outer[:, 0], outer[:, 2])
    on_arc = (np.arctan2(outer[:, 2], outer[:, 0]) > 1e-9) & (
        np.arctan2(outer[:, 2], outer[:, 0]) < 1.1
    )
    assert np.abs(near[on_arc] - 1).max() < 2 * tolerance + flat


def test_markers_separate_nearly_flat_sides() -> None:
    points, faces = box(3)
    markers = np.arange(len(faces)) % 2
    mesh = meshed((points, faces), size=0.2, tolerance=1e-5, face_markers=markers)
    areas = [np.zeros(2), np.zeros(2)]
    for total, (at, rows, own) in zip(
        areas,
        [(points, faces, markers), (mesh.points, mesh.input_faces, mesh.face_markers)],
        strict=True,
    ):
        a, b, c = (at[rows[:, k]] for k in range(3))
        np.add.at(total, own, np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2)
    assert np.allclose(*areas, atol=1e-5)


def test_sides_that_would_cross_are_refused() -> None:
    """Two blocks with rough sides that fit into each other, closer than the tolerance."""
    points, faces = box(6)
    local = np.round(points @ TURN.T, 3)
    rng = np.random.default_rng(5)
    rough = local.copy()
    side = local[:, 0] == 0
    rough[side, 0] += rng.uniform(-0.02, 0.02, int(side.sum()))
    twin = rough * [1, 1, 1]
    twin[~side] *= [-1, 1, 1]
    twin[side, 0] -= 0.001
    both = np.vstack((rough, twin))
    rows = np.vstack((faces, faces[:, [0, 2, 1]] + len(points)))
    meshed((both, rows), size=0.2)
    with pytest.raises(
        InputError, match=r"faces \d+ and \d+ would cross .* tolerance=0.03: give a"
    ):
        meshed((both, rows), size=0.05, tolerance=0.03)


LIP = np.array([(0, 0), (1, 0), (1, 0.05), (0.3, 0.05), (0.3, 0.5), (0, 0.5)])


def lip() -> tuple[Floats, Indices]:
    """A block with a thin lip."""
    n = len(LIP)
    points = np.array([(x, y, z) for y in (0, 1) for x, z in LIP], dtype=float)
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [(i, j, n + j), (i, n + j, n + i)]
    for a, b, c in ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)):
        faces += [(a, c, b), (n + a, n + b, n + c)]
    return points, np.array(faces)


@pytest.mark.parametrize(
    ("options"),
    [
        {"size": 0.15, "tolerance": 0.1},
        {"radius_edge": 2, "tolerance": 0.051},
        {"size": 0.2, "tolerance": 0.4},
    ],
)
def test_the_sides_of_a_sheet_thinner_than_the_tolerance_are_not_joined(
    options: dict[str, Any],
) -> None:
    mesh = delone.tetrahedralize(*lip(), boundary="surface", inside="enclosed", **options)
    assert mesh.validate()
    assert mesh.volumes.sum() == pytest.approx(0.185, rel=1e-12)


def test_thin_layers_and_voids_keep_their_volumes() -> None:
    def slab(low: float, high: float, inset: float) -> Floats:
        at = (inset, 1 - inset)
        return np.array([(x, y, z) for x in at for y in at for z in (low, high)])

    def closed(*bodies: Floats) -> tuple[Floats, Indices]:
        hulls = [delone.ConvexHull(body) for body in bodies]
        starts = np.cumsum([0, *(len(hull.points) for hull in hulls)])
        faces = [h.simplices + s for h, s in zip(hulls, starts[:-1], strict=True)]
        return np.concatenate([hull.points for hull in hulls]), np.concatenate(faces)

    plate = closed(slab(0, 0.01, 0))
    assert meshed(plate, tolerance=0.0101).volumes.sum() == pytest.approx(0.01, rel=1e-12)
    void = closed(slab(0, 1, 0), slab(0.5, 0.52, 0.2))
    mesh = meshed(void, tolerance=0.021, inside="parity", size=0.3)
    assert mesh.volumes.sum() == pytest.approx(1 - 0.36 * 0.02, rel=1e-12)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerance": 0.1}, "imprint=True, or for boundary"),
        ({"tolerance": 0.1, "size": 1}, "imprint=True, or for boundary"),
        ({"tolerance": 0.1, "boundary": "surface"}, "imprint=True, or for boundary"),
        ({"tolerance": -1, "boundary": "surface", "size": 1}, "tolerance"),
        ({"tolerance": np.nan, "boundary": "surface", "size": 1}, "tolerance"),
        ({"tolerance": np.inf, "boundary": "surface", "size": 1}, "tolerance"),
        ({"tolerance": 3, "boundary": "surface", "size": 1}, "larger than the mesh, which extends"),
        ({"tolerance": 1e308, "boundary": "surface", "size": 1}, "larger than the mesh"),
    ],
)
def test_wrong_tolerances_are_named(options: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        delone.tetrahedralize(*prism(6, 1.0), **options)
    with pytest.raises(InputError, match="tolerance needs boundary"):
        delone.tetrahedralize(*prism(6, 1.0)).refine(size=1, tolerance=0.1)


def test_the_order_of_rows_does_not_matter() -> None:
    points, faces = box(3)
    rng = np.random.default_rng(1)
    options: dict[str, Any] = {"size": 0.3, "tolerance": 1e-5}
    mesh = meshed((points, faces), **options)
    order, rows = rng.permutation(len(points)), rng.permutation(len(faces))
    place = np.argsort(order)
    other = meshed((points[order], place[faces][rows]), **options)

    def corners(m: Any) -> Any:
        return {frozenset(map(tuple, c)) for c in m.points[m.simplices].tolist()}

    assert corners(mesh) == corners(other)


def test_joined_sides_enclose_nearly_the_same_volume() -> None:
    given = box(4)
    mesh = meshed(given, size=0.2, tolerance=1e-6)
    total = Fraction(0)
    for row in mesh.points[mesh.simplices].tolist():
        a, b, c, d = ([Fraction(x) for x in p] for p in row)
        u, v, w = ([y - x for x, y in zip(a, p, strict=True)] for p in (b, c, d))
        total += (
            u[0] * (v[1] * w[2] - v[2] * w[1])
            - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0])
        )
    assert abs(total / 6 - 1) < Fraction(12, 10**6)
    assert all(a <= b for a, b in pairwise(sorted(mesh.volumes.tolist())))


def test_thin_faces_are_named_as_the_cause() -> None:
    mesh = delone.tetrahedralize(*prism(24, 5.0), radius_edge=2, min_angle=20)
    report = mesh.report.improvement
    assert report is not None
    rows = report.below[report.cause == "face"]
    assert len(rows)
    assert "thin face of the boundary" in str(report)
    # Each has a face on the boundary with an angle below the goal, and no angle between two faces.
    for row in rows.tolist():
        angles = []
        for k in range(4):
            if mesh.neighbors[row, k] < 0:
                a, b, c = mesh.points[np.delete(mesh.simplices[row], k)]
                for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                    u, v = q - p, r - p
                    angles.append(np.degrees(np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v)))
        assert min(angles) < 20
    # Other causes have no such face.
    other = report.below[~np.isin(report.cause, ("face", "angle", "rounding"))]
    for row in other.tolist():
        for k in range(4):
            if mesh.neighbors[row, k] < 0:
                a, b, c = mesh.points[np.delete(mesh.simplices[row], k)]
                for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                    u, v = q - p, r - p
                    assert np.arctan2(np.linalg.norm(np.cross(u, v)), u @ v) > np.radians(19.99)


def plane_angles(mesh: delone.TetMesh) -> Floats:
    """The smallest angle of each face, in degrees."""
    corners = mesh.points[mesh.input_faces]
    found = []
    for k in range(3):
        u, v = corners[:, k - 2] - corners[:, k], corners[:, k - 1] - corners[:, k]
        across = np.linalg.norm(np.cross(u, v), axis=1)
        found.append(np.degrees(np.arctan2(across, (u * v).sum(axis=1))))
    angles: Floats = np.min(found, axis=0)
    return angles


def test_caps_are_part_of_a_nearly_flat_side() -> None:
    """At the upper front edge of a cube, a triangle is lower than the tolerance."""
    corners = [
        (0, 0, 1),
        (1, 0, 1),
        (1, 1, 1),
        (0, 1, 1),
        (0, 0, 0),
        (1, 0, 0),
        (1, 1, 0),
        (0, 1, 0),
    ]
    points = np.array([*corners, (0.5, 1e-4, 1 - 1e-4)])
    faces = [(0, 8, 3), (8, 2, 3), (8, 1, 2), (0, 1, 8), (4, 5, 1), (4, 1, 0), (5, 6, 2), (5, 2, 1)]
    faces += [(6, 7, 3), (6, 3, 2), (7, 4, 0), (7, 0, 3), (4, 7, 6), (4, 6, 5)]
    joined = meshed((points, faces), size=0.3, tolerance=1e-3)
    assert plane_angles(joined).min() > 5
    assert plane_angles(meshed((points, faces), size=0.3)).min() < 0.1


def test_walls_far_from_a_bad_tetrahedron_are_not_divided() -> None:
    # A pipe: the centers of many tetrahedra lie beyond its opposite side.
    n = 24
    angle = 2 * np.pi * np.arange(n) / n
    ring = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(n)))
    up, thin = np.array([0, 0, 3.0]), np.array([0.6, 0.6, 1])
    points = np.concatenate((ring, ring + up, thin * ring + up, thin * ring))
    k, after = np.arange(n), (np.arange(n) + 1) % n
    faces = [
        np.column_stack(rows)
        for low, high in ((0, n), (n, 2 * n), (2 * n, 3 * n), (3 * n, 0))
        for rows in ((low + k, low + after, high + after), (low + k, high + after, high + k))
    ]
    mesh = meshed((points, np.concatenate(faces)), min_angle=0)
    assert mesh.nsimplex < 1700


def test_points_at_equal_distances_from_a_sharp_corner_request_none() -> None:
    corner = np.radians(15)
    base = np.array([(0, 0), (4, 0), (4 * np.cos(corner), 4 * np.sin(corner))])
    hull = delone.ConvexHull(
        np.vstack([np.column_stack((base, np.full(3, z))) for z in (0.0, 1.0)])
    )
    mesh = meshed((hull.points, hull.simplices), min_angle=0)
    assert 0 < mesh.report.on_segments <= 5


def test_ratios_below_two_request_no_points_on_the_surface() -> None:
    counts = []
    for ratio in (1.3, 2.0):
        mesh = delone.tetrahedralize(
            *prism(12, 2.0), boundary="surface", radius_edge=ratio, min_angle=0
        )
        counts.append(mesh.report.on_segments)
    assert 0 < counts[0] < 1.5 * counts[1]
