"""Refined tetrahedra: sizes, shapes, faces, exact validity, reports, files and refusals."""

from __future__ import annotations

import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.errors import BudgetExceededError, DtypeError, InputError, LimitError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from delone._base.types import Floats, Indices

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


def surface(points: Any) -> tuple[Floats, Indices]:
    hull = delone.ConvexHull(points)
    return hull.points, hull.simplices


def ball(n: int = 400) -> tuple[Floats, Indices]:
    k = np.arange(n) + 0.5
    z, angle = 1 - 2 * k / n, np.pi * (1 + 5**0.5) * k
    r = np.sqrt(1 - z * z)
    return surface(np.column_stack((r * np.cos(angle), r * np.sin(angle), z)))


def volume(mesh: delone.TetMesh) -> Fraction:
    """Six times the volume."""
    total = Fraction(0)
    for corners in mesh.points[mesh.simplices].tolist():
        a, b, c, d = ([Fraction(x) for x in p] for p in corners)
        u, v, w = ([x - y for x, y in zip(p, a, strict=True)] for p in (b, c, d))
        total += (
            u[0] * (v[1] * w[2] - v[2] * w[1])
            - u[1] * (v[0] * w[2] - v[2] * w[0])
            + u[2] * (v[0] * w[1] - v[1] * w[0])
        )
    return total


def excess(mesh: delone.TetMesh, sizes: Any) -> Floats:
    corners = mesh.points[mesh.simplices]
    edges = [corners[:, i] - corners[:, j] for i in range(4) for j in range(i)]
    longest = np.max([np.linalg.norm(e, axis=1) for e in edges], axis=0)
    return np.maximum(np.cbrt(6 * 2**0.5 * mesh.volumes), longest / 2) / sizes


@pytest.mark.parametrize("turn", [np.eye(3), TURN], ids=["straight", "turned"])
@pytest.mark.parametrize("size", [0.4, 0.21])
def test_a_cube_is_refined_to_a_size(turn: Floats, size: float) -> None:
    mesh = delone.tetrahedralize(*surface(CORNERS @ turn), boundary="surface", size=size)
    assert mesh.validate()
    assert len(mesh.report.too_large) == 0
    assert mesh.report.improvement is not None and mesh.report.improvement.ok
    assert excess(mesh, size).max() <= 1 + 1e-9
    # No more than twice as many as tetrahedra of a third of the largest volume.
    assert mesh.nsimplex < 6 * 6 * 2**0.5 / size**3
    assert abs(volume(mesh) - 6) < Fraction(1, 10**14)
    assert mesh.quality().smallest_dihedral.min() >= 20
    assert mesh.report.surface_distance < 1e-14


def test_without_faces_that_may_be_divided_these_stay() -> None:
    points, faces = ball()
    mesh = delone.tetrahedralize(points, faces, size=0.4)
    assert mesh.validate()
    assert volume(mesh) == volume(delone.tetrahedralize(points, faces))
    assert np.array_equal(mesh.points[: len(points)], points)
    assert np.array_equal(np.sort(mesh.input_faces, axis=1), np.sort(faces, axis=1))
    inside = mesh.nadded - np.isin(np.arange(len(points), mesh.npoints), mesh.input_faces).sum()
    assert inside == mesh.nadded == mesh.report.for_sizes + mesh.report.for_shapes > 20
    assert mesh.report.on_segments == mesh.report.on_facets == 0
    assert mesh.report.surface_distance == 0


def test_sizes_follow_a_function() -> None:
    def size(p: Floats) -> Floats:
        return 0.06 + 0.3 * np.linalg.norm(p - [1, 1, 1], axis=1)

    mesh = delone.tetrahedralize(*surface(CORNERS), boundary="surface", size=size)
    centers = mesh.points[mesh.simplices].mean(axis=1)
    assert excess(mesh, size(centers)).max() <= 1.02
    near = np.linalg.norm(centers - [1, 1, 1], axis=1) < 0.3
    # Far away, tetrahedra are large: a constant size would take twenty times as many.
    assert near.sum() > 60 and mesh.nsimplex < 4000


def test_a_small_size_between_the_first_points_is_found() -> None:
    def size(p: Floats) -> Floats:
        return np.where(np.linalg.norm(p - [0.37, 0.61, 0.42], axis=1) < 0.12, 0.05, 1.0)

    mesh = delone.tetrahedralize(*surface(CORNERS), boundary="surface", size=size)
    centers = mesh.points[mesh.simplices].mean(axis=1)
    inside = size(centers) < 1
    assert inside.sum() > 50
    assert excess(mesh, 1.0)[inside].max() <= 0.05 * (1 + 1e-9)


def test_sizes_of_a_mesh_with_values() -> None:
    background = delone.Delaunay(np.vstack((CORNERS, [(0.5, 0.5, 0.5)])))
    lengths = np.where(background.points[:, 0] > 0.9, 0.1, 0.5)
    mesh = delone.tetrahedralize(*surface(CORNERS), boundary="surface", size=(background, lengths))
    x = mesh.points[mesh.simplices].mean(axis=1)[:, 0]
    assert mesh.volumes[x > 0.8].mean() < mesh.volumes[x < 0.3].mean() / 8


def test_regions_have_their_own_sizes_and_keep_the_wall() -> None:
    points = np.vstack((CORNERS, CORNERS + np.array([1, 0, 0])))
    faces = delone.ConvexHull(CORNERS).simplices
    both = np.vstack((faces, faces + 8))
    seeds = [(0.5, 0.5, 0.5), (1.5, 0.5, 0.5)]
    mesh = delone.tetrahedralize(
        points, both, regions=seeds, boundary="surface", size={0: 0.5, 1: 0.2}
    )
    assert mesh.validate()
    for region, size in ((0, 0.5), (1, 0.2)):
        own = mesh.region == region
        assert excess(mesh, size)[own].max() <= 1 + 1e-9
        assert abs(mesh.volumes[own].sum() - 1) < 1e-12
    wall = np.flatnonzero((mesh.points[mesh.input_faces][:, :, 0] == 1).all(axis=1))
    assert len(wall) > 20
    area = np.linalg.norm(
        np.cross(*np.moveaxis(np.diff(mesh.points[mesh.input_faces[wall]], axis=1), 1, 0)), axis=1
    )
    assert abs(area.sum() / 2 - 1) < 1e-12


def test_markers_are_inherited_and_separate_facets() -> None:
    points, faces = surface(CORNERS)
    centers = points[faces].mean(axis=1)
    markers = 1 + 2 * np.argmax(np.abs(centers - 0.5), axis=1) + (centers.max(axis=1) == 1)
    mesh = delone.tetrahedralize(points, faces, face_markers=markers, boundary="surface", size=0.3)
    middle = mesh.points[mesh.input_faces].mean(axis=1)
    again = 1 + 2 * np.argmax(np.abs(middle - 0.5), axis=1) + (middle.max(axis=1) == 1)
    assert np.array_equal(mesh.face_markers, again)
    assert np.array_equal(markers[mesh.face_source], mesh.face_markers)
    # All faces look outward, as the given ones.
    corners = mesh.points[mesh.input_faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (((middle - 0.5) * normals).sum(axis=1) > 0).all()


def test_shapes_are_bounded_inside_a_ball() -> None:
    points, faces = ball()
    poor = delone.tetrahedralize(points, faces)
    mesh = delone.tetrahedralize(points, faces, radius_edge=1.3)
    angles = mesh.quality().smallest_dihedral
    assert poor.quality().smallest_dihedral.min() < 2
    assert angles.min() > 10
    assert mesh.report.for_shapes > 10
    assert len(mesh.report.above_ratio) < len(angles) / 5


@pytest.mark.parametrize("boundary", ["faces", "surface"])
def test_marked_tetrahedra_become_smaller(boundary: str) -> None:
    mesh = delone.tetrahedralize(*surface(CORNERS), boundary="surface", size=0.35)
    corner = np.linalg.norm(mesh.points[mesh.simplices].mean(axis=1), axis=1) < 0.5
    finer = mesh.refine(corner, ratio=0.2, boundary=boundary)
    assert finer.validate()
    centers = finer.points[finer.simplices].mean(axis=1)
    place = mesh.find_simplex(centers)
    asked = np.where(corner[place], 0.2 * mesh.volumes[place], np.inf)
    too_large = finer.volumes > asked * (1 + 1e-6)
    if boundary == "surface":
        assert not too_large.any()
    assert np.isin(np.flatnonzero(too_large), finer.report.too_large).all()
    # By number, the same.
    again = mesh.refine(np.flatnonzero(corner), ratio=0.2, boundary=boundary)
    assert np.array_equal(again.points, finer.points)


def test_a_mesh_without_faces_is_refined() -> None:
    rng = np.random.default_rng(3)
    mesh = delone.improve(delone.Delaunay(rng.random((60, 3))))
    finer = mesh.refine(size=0.15, boundary="surface")
    assert finer.validate()
    assert len(finer.input_faces) == 0
    assert (
        excess(finer, 0.15)[np.setdiff1d(np.arange(finer.nsimplex), finer.report.too_large)].max()
        <= 1.01
    )
    assert len(finer.report.too_large) < finer.nsimplex / 50


def test_sheets_inside_are_kept() -> None:
    points = np.vstack((CORNERS * 3, CORNERS[:, [0, 1, 2]] * [1, 1, 0] + 1))
    cube = delone.ConvexHull(points[:8]).simplices
    sheet = [(8, 10, 14), (8, 14, 12)]
    mesh = delone.tetrahedralize(points, np.vstack((cube, sheet)), boundary="surface", size=0.7)
    assert mesh.validate()
    inner = (mesh.points[mesh.input_faces][:, :, 2] == 1).all(axis=1)
    assert inner.sum() > 6
    corners = mesh.points[mesh.input_faces[inner]]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert abs(area.sum() / 2 - 1) < 1e-12


def test_the_order_of_rows_does_not_matter() -> None:
    points, faces = ball(150)
    rng = np.random.default_rng(5)
    order, rows = rng.permutation(len(points)), rng.permutation(len(faces))
    back = np.argsort(order)
    one = delone.tetrahedralize(points, faces, boundary="surface", size=0.3)
    two = delone.tetrahedralize(points[order], back[faces][rows], boundary="surface", size=0.3)
    key = [{frozenset(map(tuple, c)) for c in m.points[m.simplices].tolist()} for m in (one, two)]
    assert key[0] == key[1]
    scaled = delone.tetrahedralize(
        points * 2.0**-40, faces, boundary="surface", size=0.3 * 2.0**-40
    )
    assert np.array_equal(scaled.points, one.points * 2.0**-40)


def test_files_and_pickles_keep_the_report(tmp_path: Path) -> None:
    mesh = delone.tetrahedralize(*surface(CORNERS), boundary="surface", size=0.3)
    twice = mesh.refine(size=0.25)
    for made in (mesh, twice, mesh.refine(size=0.25, min_angle=0)):
        path = tmp_path / "mesh.npz"
        made.save(path)
        for again in (delone.TetMesh.load(path), pickle.loads(pickle.dumps(made))):
            assert np.array_equal(again.simplices, made.simplices)
            assert str(again.report) == str(made.report)
            assert again.report.ok == made.report.ok
            assert np.array_equal(again.report.too_large, made.report.too_large)
    assert twice.report.recovery is not None


def test_a_limit_stops_it_or_refuses_before() -> None:
    coarse = delone.tetrahedralize(*surface(CORNERS))
    with pytest.raises(BudgetExceededError, match="tetrahedra, that is about") as caught:
        coarse.refine(size=1e-3, boundary="surface", max_points=10_000)
    assert caught.value.limit == 10_000 < caught.value.found
    stopped = coarse.refine(size=0.1, boundary="surface", max_points=2_500)
    assert stopped.validate()
    assert stopped.report.exhausted and stopped.report.added == 2_500
    assert len(stopped.report.too_large) and not stopped.report.ok


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"size": 0}, InputError, "size must be above 0"),
        ({"size": float("nan")}, InputError, "size must be above 0"),
        ({"size": "small"}, InputError, "size must be a number, a mapping"),
        ({"max_volume": -1}, InputError, "max_volume must be above 0"),
        ({"size": {7: 0.1}}, InputError, "there is no region 7; the regions are 0"),
        ({"size": lambda p: np.where(p[:, 0] > 0.5, -1.0, 1.0)}, InputError, r"at \(0\.\d+, "),
        ({"size": lambda p: np.ones(3)}, InputError, "one length for each of"),
        ({"size": lambda p: np.array(["a"] * len(p))}, DtypeError, "real numbers"),
        ({"radius_edge": 0.5}, InputError, "radius_edge must be at least 1"),
        ({"radius_edge": float("nan")}, InputError, "radius_edge must be at least 1"),
        (
            {"size": (delone.Delaunay([(0, 0), (1, 0), (0, 1)]), [1, 1, 1])},
            InputError,
            "2-D, not 3-D",
        ),
        ({"min_angle": 71}, InputError, "min_angle must be from 0"),
        ({"ratio": 0}, InputError, "ratio must be above 0"),
        ({"boundary": "none"}, InputError, "boundary must be one of"),
        ({"marked": [99]}, InputError, "rows of tetrahedra, from 0 to 5, got 99"),
        ({"marked": [True]}, ShapeError, "marked must have shape"),
        ({"max_points": -1}, InputError, "max_points"),
        ({"progress": 3}, DtypeError, "progress must be a function"),
    ],
)
def test_wrong_arguments_are_named(options: dict[str, Any], error: type, words: str) -> None:
    coarse = delone.tetrahedralize(*surface(CORNERS))
    with pytest.raises(error, match=words):
        coarse.refine(**options)


def test_errors_of_functions_arrive() -> None:
    def size(p: Floats) -> Floats:
        raise KeyError("my own")

    def stop(added: int) -> None:
        raise ZeroDivisionError

    coarse = delone.tetrahedralize(*surface(CORNERS))
    with pytest.raises(KeyError, match="my own"):
        coarse.refine(size=size)
    with pytest.raises(ZeroDivisionError):
        coarse.refine(size=0.04, boundary="surface", progress=stop)


def _poisson(mesh: delone.TetMesh) -> float:
    """The largest error of u in -div grad u = 6, u = 0 on the unit sphere: u = 1 - r^2."""
    sparse = pytest.importorskip("scipy.sparse")
    linalg = pytest.importorskip("scipy.sparse.linalg")
    corners = mesh.points[mesh.simplices]
    edges = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 2)
    gradients = np.linalg.inv(edges)
    gradients = np.concatenate((-gradients.sum(axis=1, keepdims=True), gradients), axis=1)
    local = np.einsum("mix,mjx,m->mij", gradients, gradients, mesh.volumes)
    rows = np.repeat(mesh.simplices, 4, axis=1).ravel()
    columns = np.tile(mesh.simplices, (1, 4)).ravel()
    matrix = sparse.csr_matrix((local.ravel(), (rows, columns)), (mesh.npoints,) * 2)
    load = np.zeros(mesh.npoints)
    np.add.at(load, mesh.simplices, (6 * mesh.volumes / 4)[:, None])
    used = np.unique(mesh.simplices)
    free = np.setdiff1d(used, mesh.input_faces)
    found = np.zeros(mesh.npoints)
    found[free] = linalg.spsolve(matrix[free][:, free].tocsc(), load[free])
    exact = 1 - (mesh.points**2).sum(axis=1)
    return float(np.abs(found - exact)[used].max())


def test_poisson_on_a_ball_converges_at_second_order() -> None:
    errors = []
    for n, size in ((150, 0.36), (600, 0.18), (2400, 0.09)):
        errors.append(_poisson(delone.tetrahedralize(*ball(n), size=size)))
    assert errors[0] > 3 * errors[1] > 9 * errors[2]
    assert errors[2] < 0.02


def test_functions_of_sizes_are_called_with_positions_in_the_mesh() -> None:
    seen: list[Floats] = []

    def size(p: Floats) -> Floats:
        seen.append(p)
        return np.full(len(p), 0.4)

    function: Callable[[Floats], Floats] = size
    delone.tetrahedralize(*surface(CORNERS), size=function)
    everything = np.concatenate(seen)
    assert everything.shape[1] == 3 and (everything > 0).all() and (everything < 1).all()


@pytest.mark.parametrize("power", [-1000, -500, 400, 1000])
def test_sizes_of_any_magnitude(power: int) -> None:
    points, faces = surface(CORNERS + 0.5)
    one = delone.tetrahedralize(points, faces, boundary="surface", size=0.4)
    factor = 2.0**power
    two = delone.tetrahedralize(points * factor, faces, boundary="surface", size=0.4 * factor)
    assert np.array_equal(two.points, one.points * factor)
    assert two.report.largest_size_ratio == one.report.largest_size_ratio > 0.5
    assert two.report.surface_distance == one.report.surface_distance * factor

    def size(p: Floats) -> Floats:
        assert (p > 0.4 * factor).all() and (p < 1.6 * factor).all()
        return np.full(len(p), 0.5 * factor)

    varying = delone.tetrahedralize(points * factor, faces, boundary="surface", size=size)
    assert 0.5 < varying.report.largest_size_ratio <= 1
    corner = varying.refine([0], ratio=0.2, boundary="surface")
    assert corner.nsimplex > varying.nsimplex


def test_points_without_room_between_them_are_refused() -> None:
    points, faces = surface(CORNERS * 3 * 5e-324)
    with pytest.raises(LimitError, match="scale the coordinates"):
        delone.tetrahedralize(points, faces, boundary="surface", size=5e-324)
