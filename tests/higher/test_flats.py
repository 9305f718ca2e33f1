"""Triangulations and hulls of points in a flat of fewer dimensions than they have coordinates."""

from __future__ import annotations

import pickle
import re
import warnings
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.oracles.tiers import seeds

import delone
from delone import ConvexHull, Delaunay
from delone.interpolate import Linear

# Coordinates and dimensions of flats, and how many points.
CASES = [
    (4, 2, 12),
    (4, 3, 10),
    (5, 2, 12),
    (5, 4, 9),
    (6, 3, 10),
    (7, 5, 9),
    (8, 2, 12),
    (8, 6, 10),
]


def tilted(d: int, k: int, n: int, seed: int) -> np.ndarray:
    """Points with small integer coordinates in a flat: ties and duplicates."""
    random = np.random.default_rng((d, k, seed))
    while True:
        basis = random.integers(-2, 3, (k, d))
        points = random.integers(0, 4, (n, k)) @ basis + random.integers(0, 3, d)
        if np.linalg.matrix_rank(points[1:] - points[0]) == k:
            return points.astype(float)


def solved(rows: list[list[Fraction]]) -> list[Fraction] | None:
    """The solution of linear equations, the last column on the right; None if not unique."""
    left, width = [list(row) for row in rows], len(rows[0]) - 1
    for k in range(width):
        pivot = next((i for i in range(k, len(left)) if left[i][k]), None)
        if pivot is None:
            return None
        left[k], left[pivot] = left[pivot], left[k]
        left[k] = [x / left[k][k] for x in left[k]]
        for i in range(len(left)):
            if i != k and left[i][k]:
                left[i] = [x - left[i][k] * y for x, y in zip(left[i], left[k], strict=True)]
    return [left[k][width] for k in range(width)]


def in_conflict(simplex: list[tuple[Fraction, ...]], p: tuple[Fraction, ...]) -> bool | None:
    """Whether a point is in the perturbed sphere of a simplex of the flat; None if it is flat."""
    size = len(simplex)
    # Barycentric coordinates: all coordinates, and their sum, are reproduced.
    rows = [[v[j] for v in simplex] + [p[j]] for j in range(len(p))]
    shares = solved([*rows, [Fraction(1)] * (size + 1)])
    if shares is None:
        return None
    square = lambda q: sum(x * x for x in q)  # noqa: E731
    power = square(p) - sum(s * square(v) for s, v in zip(shares, simplex, strict=True))
    if power:
        return power < 0
    involved = [(v, s) for v, s in zip(simplex, shares, strict=True) if s]
    least, share = min([*involved, (p, Fraction(-1))])
    return least == p or share < 0


def defined(points: np.ndarray, k: int) -> set[tuple[tuple[Fraction, ...], ...]]:
    """The simplices by the definition, from all subsets of k + 1 distinct points."""
    distinct = sorted({tuple(map(Fraction, row)) for row in points.tolist()})
    found = set()
    for simplex in combinations(distinct, k + 1):
        others = (p for p in distinct if p not in simplex)
        conflicts = [in_conflict(list(simplex), p) for p in others]
        if not any(each is None or each for each in conflicts) and conflicts:
            found.add(simplex)
    return found


def corners_of(points: np.ndarray, simplices: np.ndarray) -> set[tuple[tuple[float, ...], ...]]:
    return {tuple(sorted(map(tuple, points[row].tolist()))) for row in simplices}


@pytest.mark.parametrize(("d", "k", "n"), CASES)
@pytest.mark.parametrize("seed", seeds(2, deep=12))
def test_simplices_are_those_of_the_definition(d: int, k: int, n: int, seed: int) -> None:
    points = tilted(d, k, n, seed)
    mesh = Delaunay(points, flat="project")
    assert mesh.simplices.shape[1] == mesh.neighbors.shape[1] == k + 1
    assert corners_of(points, mesh.simplices) == defined(points, k)
    assert mesh.validate()
    assert (points[mesh.duplicate_of] == points).all()


@pytest.mark.parametrize(("d", "k", "n"), CASES)
def test_the_order_of_rows_and_powers_of_two_do_not_matter(d: int, k: int, n: int) -> None:
    points = tilted(d, k, 3 * n, 7)
    wanted = corners_of(points, Delaunay(points, flat="project").simplices)
    facets = corners_of(points, ConvexHull(points, flat="project").simplices)
    order = np.random.default_rng(0).permutation(len(points))
    for moved, scale in (
        (points[order], 1.0),
        (points * 2.0**-300, 2.0**-300),
        (points * 2.0**400, 2.0**400),
    ):
        made = Delaunay(moved, flat="project").simplices
        assert corners_of(moved / scale, made) == wanted
        assert corners_of(moved / scale, ConvexHull(moved, flat="project").simplices) == facets


@pytest.mark.parametrize("k", [2, 3, 4])
def test_a_coordinate_flat_has_the_triangulation_of_its_columns(k: int) -> None:
    random = np.random.default_rng(k)
    low = random.integers(0, 4, (30, k)) / 3
    for columns in ([*range(k)], [*range(5 - k, 5)]):
        points = np.full((30, 5), 0.7)
        points[:, columns] = low
        mesh, own = Delaunay(points, flat="project"), Delaunay(low)
        assert corners_of(low, mesh.simplices) == corners_of(low, own.simplices)
        hull, plain = ConvexHull(points, flat="project"), ConvexHull(low)
        assert hull.vertices.tolist() == sorted(plain.vertices.tolist())
        assert corners_of(low, hull.simplices) == corners_of(low, plain.simplices)
        assert hull.volume == pytest.approx(plain.volume, rel=1e-12)
        assert hull.area == pytest.approx(plain.area, rel=1e-12)
        sizes = own.areas if k == 2 else own.volumes
        assert mesh.volumes.sum() == pytest.approx(sizes.sum(), rel=1e-12)
        equations = hull.equations[:, [*columns, 5]]
        assert sorted(equations.round(9).tolist()) == sorted(plain.equations.round(9).tolist())


@pytest.mark.parametrize(("d", "k", "n"), CASES)
def test_what_follows_from_simplices(d: int, k: int, n: int) -> None:
    points = tilted(d, k, 2 * n, 3)
    mesh, hull = Delaunay(points, flat="project"), ConvexHull(points, flat="project")
    corners = points[mesh.simplices]
    distances = np.linalg.norm(corners - mesh.circumcenters[:, None], axis=2)
    assert distances == pytest.approx(distances[:, :1] * np.ones(k + 1), rel=1e-6)
    # The centers are in the flat.
    basis = np.linalg.svd(points - points[0])[2][k:]
    off = (mesh.circumcenters - points[0]) @ basis.T
    assert np.abs(off).max() < 1e-9 * np.abs(mesh.circumcenters).max()
    # Sizes by Gram's determinant.
    steps = corners[:, 1:] - corners[:, :1]
    gram = np.linalg.det(steps @ steps.swapaxes(1, 2))
    assert mesh.volumes**2 * float(np.prod(np.arange(1, k + 1)) ** 2) == pytest.approx(
        gram, rel=1e-6
    )
    assert hull.volume == pytest.approx(mesh.volumes.sum(), rel=1e-9)
    assert hull.validate()
    sides = points @ hull.equations[:, :-1].T + hull.equations[:, -1]
    assert sides.max() < 1e-9
    on = (np.abs(sides) < 1e-9)[hull.simplices, np.arange(len(hull.simplices))[:, None]]
    assert on.all()
    assert np.abs(hull.equations[:, :-1] @ basis.T).max() < 1e-9
    assert set(map(tuple, np.sort(mesh.convex_hull, axis=1).tolist()))
    assert len(hull.edges) == len(
        {tuple(sorted(e)) for f in hull.simplices.tolist() for e in combinations(f, 2)}
    )
    assert len(mesh.vertex_neighbor_vertices[1]) == 2 * len(mesh.edges)


@pytest.mark.parametrize("k", [2, 3])
@pytest.mark.parametrize("power", [0, 2, 4, 8, 30, 140])
def test_measures_of_thin_simplices_have_small_errors(k: int, power: int) -> None:
    """In a coordinate flat, measures are those of its columns, whatever their scales."""
    random = np.random.default_rng((k, power))
    scales = 10.0 ** np.array([-power, power, 0])[:k]
    plain = random.random((9, k)) * scales
    points = np.column_stack((plain, np.full((9, 5 - k), 7.0)))
    mesh, other = Delaunay(points, flat="project"), Delaunay(plain)
    order = [np.lexsort(np.sort(each.simplices, axis=1).T) for each in (mesh, other)]
    assert np.array_equal(
        *(np.sort(m.simplices[o], axis=1) for m, o in zip((mesh, other), order, strict=True))
    )
    sizes = other.areas if k == 2 else other.volumes
    assert mesh.volumes[order[0]] == pytest.approx(sizes[order[1]], rel=1e-11)
    for own, want in zip(
        mesh.circumcenters[order[0]].T, other.circumcenters[order[1]].T, strict=False
    ):
        assert own == pytest.approx(want, rel=1e-9)
    assert mesh.circumcenters[:, k:] == pytest.approx(7.0, rel=1e-12)
    hull, flat = ConvexHull(points, flat="project"), ConvexHull(plain)
    assert hull.volume == pytest.approx(flat.volume, rel=1e-11)
    assert hull.area == pytest.approx(flat.area, rel=1e-11)
    normals = [
        each.equations[np.lexsort(np.sort(each.simplices, axis=1).T)] for each in (hull, flat)
    ]
    assert normals[0][:, :k] == pytest.approx(normals[1][:, :k], abs=1e-12)


def test_measures_at_the_ends_of_the_range() -> None:
    """Squares and products of steps overflow and underflow, results do not or are infinite."""
    for power in (-1070, -700, 600, 1000):
        flat = 2.0**power * np.array(
            [(0, 0, 0, 0), (6, 0, 0, 6), (0, 4, 4, 0), (6, 4, 4, 6), (1, 1, 1, 1)]
        )
        mesh = Delaunay(flat, flat="project")
        one = Delaunay(flat / 2.0**power, flat="project")
        assert np.array_equal(mesh.simplices, one.simplices)
        with np.errstate(over="ignore", under="ignore"):
            want = np.ldexp(one.volumes, 2 * power)
        assert mesh.volumes == pytest.approx(want, rel=1e-12, abs=5e-324)
        assert np.isfinite(mesh.circumcenters).all()


def test_queries_are_projected_along_the_other_axes() -> None:
    # The third and fourth coordinate follow from the first two.
    low = np.random.default_rng(1).integers(0, 9, (20, 2)).astype(float)
    points = np.column_stack((low, low.sum(axis=1), 3 - low[:, 0]))
    mesh, hull = Delaunay(points, flat="project"), ConvexHull(points, flat="project")
    place = mesh.locate(points.mean(axis=0) + np.array([0, 0, 5, -5]))
    corners = points[mesh.simplices[place.simplex]]
    assert place.barycentric.shape == (3,)
    assert place.barycentric @ corners == pytest.approx(points.mean(axis=0))
    assert (mesh.find_simplex(points) >= 0).all()
    assert mesh.find_simplex([(-9, 0, -9, 12)]).tolist() == [-1]
    assert np.isnan(mesh.locate((-9, 0, -9, 12)).barycentric).all()
    assert hull.contains([points[3], points[3] + [0, 0, 1, 1], (-9, 0, -9, 12)]).tolist() == [
        True,
        True,
        False,
    ]
    assert (mesh.nearest(points) == mesh.duplicate_of).all()
    # All coordinates count.
    queries = points + np.array([0, 0, 0.1, 0])
    near = mesh.nearest(queries)
    squares = ((points[:, None] - queries) ** 2).sum(axis=2)
    assert np.allclose(squares[near, np.arange(20)], squares.min(axis=0))
    assert mesh.nearest([(np.nan, 0, 0, 0)]).tolist() == [-1]


@pytest.mark.parametrize(("d", "k", "n"), CASES)
def test_the_nearest_vertex_is_that_of_integers(d: int, k: int, n: int) -> None:
    points = tilted(d, k, 3 * n, 7)
    mesh = Delaunay(points, flat="project")
    # Many of these points are at the same distance from several vertices.
    queries = np.random.default_rng(d).integers(-4, 9, (300, d)) / 2
    queries[::2] = points[np.random.default_rng(k).integers(0, len(points), (150, 2))].mean(axis=1)
    squares = ((2 * queries[:, None] - 2 * points) ** 2).astype(np.int64).sum(axis=2)
    assert (np.sort(squares, axis=1)[:, 0] == np.sort(squares, axis=1)[:, 1]).sum() > 5
    # The first of equal rows is the vertex, and the first of several vertices is found.
    for workers in (1, 2):
        again = Delaunay(points, flat="project", workers=workers)
        assert np.array_equal(again.nearest(queries), squares.argmin(axis=1))
    assert mesh.nearest(queries.reshape(3, 100, d)).shape == (3, 100)
    assert mesh.nearest(np.full((1, d), np.inf)).tolist() == [-1]


def test_three_points_span_a_plane() -> None:
    for d in (4, 5, 8):
        points = np.eye(3, d)
        mesh, hull = Delaunay(points, flat="project"), ConvexHull(points, flat="project")
        assert sorted(mesh.simplices[0].tolist()) == [0, 1, 2]
        assert mesh.volumes == pytest.approx([3**0.5 / 2])
        assert (len(hull.simplices), len(hull.vertices)) == (3, 3)
        assert hull.area == pytest.approx(3 * 2**0.5)
        assert mesh.validate()
        assert hull.validate()
        # As a list, and as a pickle.
        assert len(Delaunay(points.tolist(), flat="project").simplices) == 1
        again = pickle.loads(pickle.dumps(mesh))
        assert np.array_equal(again.simplices, mesh.simplices)
        # Two points are on a line, and without the argument, three rows of five columns are
        # probably three lists of coordinates.
        needs = "; simplices in a flat need three that are not on one line"
        line = np.outer(np.arange(3.0), np.ones(d))
        for made in (Delaunay, ConvexHull):
            with pytest.raises(delone.DegenerateInputError) as caught:
                made(points[:2], flat="project")
            assert str(caught.value) == f"all points are on one line, through rows 0 and 1{needs}"
            with pytest.raises(delone.DegenerateInputError, match=f"on one line, .*{needs}$"):
                made(line, flat="project")
            with pytest.raises(delone.DegenerateInputError) as caught:
                made(points[[1, 1]], flat="project")
            assert str(caught.value) == f"all points are equal to row 0{needs}"
            with pytest.raises(delone.DegenerateInputError) as caught:
                made(points[:0], flat="project")
            assert str(caught.value) == f"there are no points{needs}"
            advice = 'transpose it, or if these are three points, pass flat="project"$'
            with pytest.raises(delone.ShapeError, match=advice):
                made(points)
            # Two points have no triangle, and no class takes more columns.
            for wrong in (points[:2], np.eye(3, 9)):
                with pytest.raises(delone.ShapeError, match=r"transpose it$"):
                    made(wrong)
        with pytest.raises(delone.ShapeError, match=r"transpose it$"):
            delone.Voronoi(points)


def test_files_pickles_and_faults(tmp_path: Path) -> None:
    points = tilted(6, 3, 20, 4)
    both: tuple[Any, ...] = Delaunay(points, flat="project"), ConvexHull(points, flat="project")
    for made in both:
        again = pickle.loads(pickle.dumps(made))
        made.save(tmp_path / "flat.npz")
        loaded = type(made).load(tmp_path / "flat.npz")
        for other in (again, loaded):
            assert (other.simplices == made.simplices).all()
            assert (other.neighbors == made.neighbors).all()
            assert repr(other) == repr(made)
    mesh = both[0]
    assert repr(mesh).endswith("tetrahedra>")
    moved = mesh.points.copy()
    # Another metric: the projections are the same, the triangulation is not Delaunay any more.
    moved[:, 3:] *= 4
    wrong = Delaunay._from_arrays(mesh._arrays() | {"points": moved})
    assert not wrong.validate()


def test_whole_dimensions_are_as_without_it() -> None:
    points = np.random.default_rng(2).random((40, 4))
    assert (Delaunay(points, flat="project").simplices == Delaunay(points).simplices).all()
    assert (ConvexHull(points, flat="project").simplices == ConvexHull(points).simplices).all()


def test_errors_name_it_and_what_it_cannot_do() -> None:
    points = tilted(5, 3, 12, 5)
    for made in (Delaunay, ConvexHull):
        with pytest.raises(delone.DegenerateInputError, match='or pass flat="project"') as caught:
            made(points)
        assert len(caught.value.chain) == 4
        with pytest.raises(delone.InputError, match="flat must be one of 'raise', 'project'"):
            made(points, flat="flat")
        for low in (points[:, :2], points[:, :3]):
            with pytest.raises(delone.InputError, match="only available from 4-D on"):
                made(low, flat="project")
        line = np.arange(9.0)[:, None] * [1, 2, 3, 4, 5]
        for few in (line, line[:1], line[:0]):
            with pytest.raises(delone.DegenerateInputError) as caught:
                made(few, flat="project")
            assert "or pass flat" not in str(caught.value)
    # Fewer points than coordinates may span a flat.
    assert Delaunay(points[:4], flat="project").nsimplex >= 1
    mesh = Delaunay(points, flat="project")
    with pytest.raises(AttributeError, match="transform is not available for points in a flat"):
        _ = mesh.transform
    with pytest.raises(delone.InputError, match="points of the triangulation lie in a flat"):
        Linear(mesh, points[:, 0])
    with pytest.raises(delone.InputError, match="points of the triangulation lie in a flat"):
        delone.AlphaComplex(mesh)


def test_points_that_rounding_takes_out_of_a_flat_are_told() -> None:
    random = np.random.default_rng(5)
    fractions = random.dirichlet(np.ones(5), 60)
    told = "in a flat of dimension 4 except for rounding errors, .* 5-D .* for example column 4,"
    for made in (Delaunay, ConvexHull):
        with pytest.warns(delone.NearlyFlatWarning, match=told) as caught:
            assert made(fractions).simplices.shape[1] > 4
        assert caught[0].filename == __file__
        with pytest.warns(delone.NearlyFlatWarning, match=told):
            made(fractions, flat="project")
    # A column that depends on some others, in other units, far from the origin.
    points = random.random((40, 6)) * [1, 1e-6, 1e6, 1, 1, 1] + [0, 0, 0, 0, 1e3, 0]
    points[:, 2] = points[:, 1] * 2.54e6 - points[:, 4] / 3
    with pytest.warns(delone.NearlyFlatWarning, match="for example column [124],"):
        Delaunay(points)
    # Flats that are asked for, and points that span all dimensions by more than rounding.
    whole = random.integers(0, 9, (40, 5)).astype(float)
    whole[:, 4] = 30 - whole[:, :4].sum(axis=1)
    thin = random.random((60, 5)) * [1, 1, 1, 1, 1e-9]
    noisy = fractions + 1e-13 * random.random((60, 5))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for made in (Delaunay, ConvexHull):
            made(whole, flat="project")
            made(fractions[:, :4])
            made(fractions[:, :3])
            made(thin)
            made(noisy)
            made(np.vstack((np.zeros(5), np.eye(5))))
            made(1e300 * random.random((12, 5)))
            delone.estimate(fractions)
            made(1e15 + random.integers(0, 9, (40, 5)))
    with pytest.warns(delone.NearlyFlatWarning, match=told) as caught:
        delone.RegularTriangulation(fractions, random.random(60) / 100)
    assert caught[0].filename == __file__


@pytest.mark.parametrize("d", range(4, 9))
def test_the_flat_has_its_dimension(d: int) -> None:
    random = np.random.default_rng(d)
    for k in range(1, d + 1):
        base = np.zeros((k, d))
        base[:, :k] = np.eye(k)
        base[:, k:] = random.random((k, d - k)) - 0.5
        points = random.random((16, k)) @ base[:, random.permutation(d)] * 7 + random.random(d)
        # Hulls are quick in many dimensions; so are triangulations of few points.
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", delone.NearlyFlatWarning)
            ConvexHull(points)
        told = [str(each.message) for each in caught]
        if k == d:
            assert told == []
            continue
        (message,) = told
        assert f"in a flat of dimension {k} except" in message
        left = re.search(r"for example columns? ([\d, ]+), or pass", message)
        assert left is not None
        columns = [int(each) for each in left[1].split(", ")]
        assert len(set(columns)) == len(columns) == d - k
        # The other columns span the flat, and by more than rounding.
        kept = np.delete(points - points.mean(axis=0), columns, axis=1)
        assert np.linalg.svd(kept, compute_uv=False)[-1] > 1e-3
