"""Delaunay triangulations in four to eight dimensions."""

from __future__ import annotations

import math
import pickle
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import delone
from delone import Delaunay
from delone.validation import HigherReport, validate

# Points, and simplices that several dimensions make of them.
SIZES = {4: 60, 5: 40, 6: 24, 7: 16, 8: 14}


def some(d: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((SIZES[d], d))


def as_sets(simplices: np.ndarray) -> set[tuple[int, ...]]:
    return set(map(tuple, np.sort(simplices, axis=1).tolist()))


def determinant(rows: list[list[Fraction]]) -> Fraction:
    """The determinant by elimination."""
    found, left = Fraction(1), [list(row) for row in rows]
    for k in range(len(left)):
        pivot = next((i for i in range(k, len(left)) if left[i][k]), None)
        if pivot is None:
            return Fraction(0)
        if pivot != k:
            left[k], left[pivot] = left[pivot], left[k]
            found = -found
        found *= left[k][k]
        for i in range(k + 1, len(left)):
            factor = left[i][k] / left[k][k]
            left[i] = [x - factor * y for x, y in zip(left[i], left[k], strict=True)]
    return found


def exact_volume(corners: np.ndarray) -> Fraction:
    rows = [[Fraction(x) for x in row] for row in corners.tolist()]
    steps = [[x - o for x, o in zip(row, rows[0], strict=True)] for row in rows[1:]]
    return determinant(steps) / math.factorial(len(steps))


@pytest.mark.parametrize("d", SIZES)
def test_simplices_are_those_of_scipy_in_general_position(d: int) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = some(d)
    mesh, theirs = Delaunay(points), spatial.Delaunay(points)
    assert as_sets(mesh.simplices) == as_sets(theirs.simplices)
    assert mesh.ndim == d
    assert mesh.nsimplex == len(theirs.simplices)
    assert as_sets(mesh.convex_hull) == as_sets(theirs.convex_hull)
    assert set(mesh.hull.tolist()) == set(theirs.convex_hull.ravel().tolist())
    hull = spatial.ConvexHull(points)
    assert mesh.volumes.sum() == pytest.approx(hull.volume, rel=1e-12)


@pytest.mark.parametrize("d", SIZES)
def test_every_simplex_is_positive_and_neighbors_share_facets(d: int) -> None:
    mesh = Delaunay(some(d, 1))
    assert mesh.validate()
    for row in range(0, mesh.nsimplex, max(1, mesh.nsimplex // 40)):
        volume = exact_volume(mesh.points[mesh.simplices[row]])
        assert volume > 0
        assert abs(Fraction(mesh.volumes[row]) - volume) <= volume * Fraction(1e-14)
        for k, other in enumerate(mesh.neighbors[row].tolist()):
            mine = {*mesh.simplices[row].tolist()} - {int(mesh.simplices[row, k])}
            if other >= 0:
                assert len(mine & {*mesh.simplices[other].tolist()}) == d
                assert row in mesh.neighbors[other]


def test_facets_of_the_boundary_have_the_inside_in_front() -> None:
    mesh = Delaunay(some(4, 2))
    center = mesh.points.mean(axis=0)
    # With an inner point as the first corner, they are positively oriented, as in 2-D and 3-D.
    for ndim in (2, 3, 4):
        mesh = Delaunay(np.random.default_rng(ndim).random((30, ndim)))
        center = mesh.points.mean(axis=0)
        for facet in mesh.boundary:
            assert exact_volume(np.vstack((center, mesh.points[facet]))) > 0


def test_a_grid_with_uneven_steps_has_the_simplices_of_kuhn() -> None:
    axes = [0.1, 0.7, 1.1], [5.0, 9.0], [-1.0, 0.0, 3e3], [2.0, 2.5]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 4)
    mesh = Delaunay(points)
    assert mesh.nsimplex == math.factorial(4) * 2 * 1 * 2 * 1
    assert mesh.validate()
    along = np.sort(points[mesh.simplices].sum(axis=2), axis=1)
    assert (np.diff(along, axis=1) > 0).all()


@pytest.mark.parametrize("d", SIZES)
def test_the_order_of_rows_does_not_matter(d: int) -> None:
    random = np.random.default_rng(d)
    # Few different coordinates: ties, duplicates, flat parts of the hull.
    points = random.integers(0, 3, (SIZES[d], d)).astype(float)
    points[: d + 1] = np.vstack((np.zeros(d), np.eye(d)))
    order = random.permutation(len(points))
    mesh, other = Delaunay(points), Delaunay(points[order])
    coordinates = {tuple(sorted(map(tuple, points[row].tolist()))) for row in mesh.simplices}
    moved = {tuple(sorted(map(tuple, points[order][row].tolist()))) for row in other.simplices}
    assert coordinates == moved
    assert mesh.validate()
    assert (mesh.points[mesh.duplicate_of] == mesh.points).all()
    assert len(np.unique(mesh.duplicate_of)) == len(np.unique(points, axis=0))


def test_faults_are_named() -> None:
    mesh = Delaunay(some(4, 3))
    simplices, neighbors = mesh.simplices.copy(), mesh.neighbors.copy()
    simplices[3, [0, 1]] = simplices[3, [1, 0]]
    report = validate(mesh.points, simplices, neighbors=neighbors)
    assert isinstance(report, HigherReport)
    assert report.orientation.tolist() == [3]
    assert "1 simplex is not positively oriented: 3" in str(report)
    assert validate(mesh.points, mesh.simplices)
    missing = validate(np.vstack((mesh.points, mesh.points.mean(axis=0))), mesh.simplices)
    assert missing.missing.tolist() == [len(mesh.points)]
    moved = mesh.points.copy()
    inner = np.setdiff1d(np.arange(mesh.npoints), mesh.hull)[0]
    corner = mesh.vertex_neighbor_vertices[1][mesh.vertex_neighbor_vertices[0][inner]]
    moved[inner] += (moved[corner] - moved[inner]) / 4
    wrong = validate(moved, mesh.simplices)
    assert not wrong
    assert len(wrong.delaunay) or len(wrong.orientation)
    twice = validate(
        mesh.points,
        np.vstack((mesh.simplices, mesh.simplices)),
        neighbors=np.vstack(
            (mesh.neighbors, np.where(mesh.neighbors < 0, -1, mesh.neighbors + mesh.nsimplex))
        ),
    )
    assert twice.overlaps.tolist() == [mesh.nsimplex]


def test_files_and_pickles(tmp_path: Path) -> None:
    mesh = Delaunay(some(5, 4))
    path = tmp_path / "mesh.npz"
    mesh.save(path)
    loaded = Delaunay.load(path)
    for again in (loaded, pickle.loads(pickle.dumps(mesh))):
        assert (again.simplices == mesh.simplices).all()
        assert (again.points == mesh.points).all()
        assert again.validate()
    arrays = dict(np.load(path))
    for name in ("simplices", "neighbors"):
        arrays[name][7, :2] = arrays[name][7, 1::-1]
    np.savez(tmp_path / "other.npz", **arrays)
    with pytest.raises(delone.FileFormatError, match="simplex 7 is not positively oriented"):
        Delaunay.load(tmp_path / "other.npz")


def test_points_are_located() -> None:
    for d in SIZES:
        mesh = Delaunay(some(d, 5))
        random = np.random.default_rng(d)
        shares = random.dirichlet(np.ones(d + 1), 50)
        rows = random.integers(0, mesh.nsimplex, 50)
        places = np.einsum("kc,kcd->kd", shares, mesh.points[mesh.simplices[rows]])
        assert mesh.find_simplex(places).tolist() == rows.tolist()
        found = mesh.locate(places)
        assert np.abs(found.barycentric - shares).max() < 1e-9
        assert mesh.find_simplex(mesh.points[:5] * 3 + 4).tolist() == [-1] * 5
        assert mesh.find_simplex(np.full(d, np.nan)) == -1
        at = mesh.locate(mesh.points)
        assert (np.sort(at.barycentric, axis=1)[:, -1] == 1).all()
        assert mesh.nearest(mesh.points + 1e-9).tolist() == list(range(mesh.npoints))


def test_measures_agree_with_those_of_rounded_arithmetic() -> None:
    for d in (4, 6):
        mesh = Delaunay(some(d, 6))
        corners = mesh.points[mesh.simplices]
        steps = corners[:, :-1] - corners[:, -1:]
        inverse = np.linalg.inv(steps.transpose(0, 2, 1))
        assert np.abs(mesh.transform[:, :d] / inverse - 1).max() < 1e-6
        assert (mesh.transform[:, d] == corners[:, -1]).all()
        radii = np.linalg.norm(corners - mesh.circumcenters[:, None], axis=2)
        assert np.abs(radii / radii[:, :1] - 1).max() < 1e-9
        pairs = {tuple(sorted((a, b))) for row in mesh.simplices.tolist() for a in row for b in row}
        assert [*map(tuple, mesh.edges.tolist())] == sorted(p for p in pairs if p[0] != p[1])


@pytest.mark.parametrize(
    "name",
    [
        "plot",
        "quality",
        "faces",
        "areas",
        "walk",
        "to_meshio",
        "to_pyvista",
        "to_skfem",
        "to_geopandas",
        "to_matplotlib",
        "to_dolfinx_arrays",
    ],
)
def test_what_needs_a_plane_or_space_does_not_exist(name: str) -> None:
    mesh = Delaunay(some(4, 7))
    assert not hasattr(mesh, name)
    with pytest.raises(AttributeError, match=f"{name} is only available in 2-D"):
        getattr(mesh, name)
    assert hasattr(Delaunay(some(4, 7)[:, :2]), name)


def test_advice_is_about_the_dimension() -> None:
    hull = delone.ConvexHull(some(5, 5))
    with pytest.raises(AttributeError, match="only available in 2-D: use `save`"):
        hull.to_geopandas()
    with pytest.raises(AttributeError, match="only available in 2-D: write the surface with"):
        delone.ConvexHull(some(5, 3)[:, :3]).to_geopandas()
    with pytest.raises(delone.DegenerateInputError, match="at least 8 that span all dimensions"):
        Delaunay(np.repeat(some(7)[:3], 4, axis=0))


def test_bad_points_are_refused_by_rows() -> None:
    points = some(6, 8)
    with pytest.raises(delone.ShapeError, match=r"got \(24, 9\); to interpolate .* use .*Linear"):
        Delaunay(np.ones((24, 9)))
    with pytest.raises(delone.DegenerateInputError, match="5 distinct points are too few") as few:
        Delaunay(points[:5])
    assert few.value.reason == "too few points"
    assert few.value.chain.tolist() == [0, 1, 2, 3, 4]
    points[:, 4] = points[:, 1] - points[:, 0]
    points[:, 5] = 2.0
    points = np.round(points * 1024) / 1024
    points[:, 4] = points[:, 1] - points[:, 0]
    with pytest.raises(delone.DegenerateInputError, match="in a flat of dimension 4") as flat:
        Delaunay(points)
    assert flat.value.reason == "flat"
    spanning = points[flat.value.chain]
    assert np.linalg.matrix_rank(spanning[1:] - spanning[0]) == len(spanning) - 1 == 4
    points[5, 2] = np.inf
    with pytest.raises(delone.NonFiniteError) as infinite:
        Delaunay(points)
    assert infinite.value.rows.tolist() == [5]
    with pytest.raises(delone.InputError, match="'auto', 'bowyer-watson' in 6-D"):
        Delaunay(points, method="sweep")
    with pytest.raises(delone.InputError, match="tolerance is only available in 2-D and 3-D"):
        Delaunay(some(4)).find_simplex(some(4), tolerance=1.0)


def test_every_range_of_doubles() -> None:
    points = np.round(some(4, 9) * 64)
    expected = as_sets(Delaunay(points).simplices)
    for power in (-1060, -300, 200, 1000):
        mesh = Delaunay(np.ldexp(points, power))
        assert as_sets(mesh.simplices) == expected
        assert mesh.find_simplex(mesh.points[3]) >= 0


def test_others_refuse_more_dimensions_by_name() -> None:
    mesh = Delaunay(some(4))
    calls = (
        lambda: delone.graphs.delaunay_graph(mesh),
        lambda: delone.graphs.gabriel(mesh),
        lambda: delone.cluster.single_linkage(mesh),
        lambda: delone.concave_hull(mesh, ratio=0.5),
        lambda: delone.Dynamic(mesh),
        lambda: delone.Voronoi(mesh.points, clip="box"),
        lambda: delone.interpolate.CloughTocher(mesh, np.zeros(mesh.npoints)),
        lambda: delone.interpolate.grid(mesh, np.zeros(mesh.npoints), resolution=0.1),
        lambda: delone.io.write_mesh("mesh.vtu", mesh),
        lambda: delone.plot.plot(mesh),
    )
    for call in calls:
        with pytest.raises(delone.DeloneError, match=r"-D|coordinates|shape|points"):
            call()
