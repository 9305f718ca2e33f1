"""Convex hulls: exact, of extreme points alone, the same however the points come."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import (
    ConvexHull,
    DegenerateInputError,
    Delaunay,
    NonFiniteError,
    ShapeError,
    datasets,
    predicates,
)
from tiers import examples

if TYPE_CHECKING:
    from numpy.typing import NDArray

PLANE, SPACE = sorted(datasets.GENERATORS), sorted(datasets.GENERATORS3)
SMALL = st.integers(-2, 2).map(float)
DOUBLE = st.floats(allow_nan=False, allow_infinity=False)


def every(n: int) -> list[Any]:
    plane = [pytest.param(datasets.GENERATORS[name](n, seed=n), id=f"2-{name}") for name in PLANE]
    space = [pytest.param(datasets.GENERATORS3[name](n, seed=n), id=f"3-{name}") for name in SPACE]
    return plane + space


def turn(points: NDArray[np.float64], corners: Any, x: Any) -> Any:
    """Positive where x is beyond facets, exactly."""
    ends = [points[corners[:, k]] for k in range(corners.shape[1])]
    if points.shape[1] == 2:
        return -predicates.orient2d(*ends, x)
    return predicates.orient3d(*ends, x)


def check(points: NDArray[np.float64]) -> ConvexHull:
    hull = ConvexHull(points)
    d = points.shape[1]
    # Nothing is beyond a simplex, and no simplex is flat.
    for x in np.unique(points, axis=0):
        assert (turn(points, hull.simplices, x[None]) <= 0).all()
    # Neighbours share all vertices but one, and the surface is a sphere.
    for i, simplex in enumerate(hull.simplices.tolist()):
        assert len(set(simplex)) == d
        for k in range(d):
            other = hull.neighbors[i, k]
            shared = set(simplex) & set(hull.simplices[other].tolist())
            assert shared == set(simplex) - {simplex[k]}
    vertices = set(hull.vertices.tolist())
    assert vertices == set(hull.simplices.ravel().tolist())
    if d == 3:
        assert 2 * len(vertices) - 4 == hull.nsimplex
        check_facets(hull)
    # Vertices are first rows, and extreme: without one, the hull is another.
    _, first = np.unique(points + 0.0, axis=0, return_index=True)
    assert vertices <= set(first.tolist())
    for row, simplex, vertex in hull.coplanar.tolist():
        assert (points[row] == points[vertex]).all()
        assert row > vertex
        assert vertex in hull.simplices[simplex]
    return hull


def check_facets(hull: ConvexHull) -> None:
    """Facets are the largest flat parts, convex, with no vertex in the middle of an edge."""
    points = hull.points
    for i, facet in enumerate(hull.facets):
        triangles = hull.simplices[hull.facet_of == i]
        assert len(triangles) == len(facet) - 2
        assert set(triangles.ravel().tolist()) == set(facet.tolist())
        assert points[facet[0]].tolist() == min(points[facet].tolist())
        for x in points[facet]:
            assert (turn(points, triangles, x[None]) == 0).all()
    beyond = hull.facet_of[hull.neighbors]
    for i, k in np.argwhere(beyond != hull.facet_of[:, None]).tolist():
        other = hull.simplices[hull.neighbors[i, k]]
        (far,) = set(other.tolist()) - set(hull.simplices[i].tolist())
        assert turn(points, hull.simplices[i : i + 1], points[far]) < 0


@pytest.mark.parametrize("points", every(60))
def test_every_generator_exactly(points: NDArray[np.float64]) -> None:
    check(points)


@pytest.mark.parametrize("points", every(400))
def test_order_leaves_no_trace(points: NDArray[np.float64]) -> None:
    hull = ConvexHull(points)
    rng = np.random.default_rng(0)
    for _ in range(3):
        other = ConvexHull(rng.permutation(points))
        # Not as sets: the arrays themselves, but for the numbers of the rows.
        assert (other.points[other.simplices] == hull.points[hull.simplices]).all()
        assert (other.neighbors == hull.neighbors).all()
        assert (other.facet_of == hull.facet_of).all()
        assert np.array_equal(other.equations, hull.equations)
        assert (other.volume, other.area) == (hull.volume, hull.area)


@pytest.mark.parametrize("points", every(60))
def test_it_is_the_boundary_of_the_triangulation_of_its_vertices(
    points: NDArray[np.float64],
) -> None:
    hull = ConvexHull(points)
    mesh = Delaunay(points[hull.vertices])
    found = {frozenset(map(tuple, s)) for s in mesh.points[mesh.convex_hull].tolist()}
    assert found == {frozenset(map(tuple, s)) for s in points[hull.simplices].tolist()}
    whole = mesh.areas if mesh.ndim == 2 else mesh.volumes
    assert hull.volume == pytest.approx(whole.sum(), rel=1e-12)


def in_ball(n: int, seed: int) -> NDArray[np.float64]:
    rng = np.random.default_rng(seed)
    ways = rng.normal(size=(n, 3))
    return ways * (rng.random(n) ** (1 / 3) / np.linalg.norm(ways, axis=1))[:, None]


def layered() -> NDArray[np.float64]:
    """Two shells a few units in the last place apart, and all points twice."""
    ball = in_ball(150, 3)
    shell = ball / np.linalg.norm(ball, axis=1)[:, None]
    both = np.concatenate((shell, np.nextafter(shell, 0), shell * (1 - 2.0**-50), ball))
    return np.concatenate((both, both[::-1]))


@pytest.mark.parametrize(
    "points",
    [
        pytest.param(in_ball(1000, 0), id="ball"),
        pytest.param(in_ball(600, 1) * (1, 1e-4, 1e5) + (1e3, 0, 0), id="flattened"),
        pytest.param(in_ball(600, 1) + 1e12, id="far-away"),
        pytest.param(in_ball(600, 2) * 2.0**-1040, id="subnormal"),
        pytest.param(in_ball(600, 2) * 2.0**1020, id="huge"),
        pytest.param(np.repeat(in_ball(200, 4), 3, axis=0), id="thrice"),
        pytest.param(layered(), id="layered"),
        pytest.param(np.round(in_ball(900, 5) * 6), id="rounded"),
        pytest.param(np.round(in_ball(900, 6) * 40) * (1, 0, 0) + in_ball(900, 7) ** 9, id="spine"),
    ],
)
@pytest.mark.sampled(3)
def test_what_cells_leave_out_is_inside(points: NDArray[np.float64]) -> None:
    """So many points that most are told to be inside by their direction and depth."""
    hull = check(points)
    order = np.random.default_rng(0).permutation(len(points))
    other = check(points[order])
    assert sorted(map(tuple, points[hull.vertices].tolist())) == sorted(
        map(tuple, points[order][other.vertices].tolist())
    )


@given(st.integers(2, 3).flatmap(lambda d: st.lists(st.tuples(*[SMALL] * d), max_size=16)))
@settings(max_examples=examples(30, deep=300), deadline=None)
def test_small_integers(points: list[Any]) -> None:
    attempt(points)


@given(st.integers(2, 3).flatmap(lambda d: st.lists(st.tuples(*[DOUBLE] * d), max_size=10)))
@settings(max_examples=examples(20, deep=200), deadline=None)
def test_any_doubles(points: list[Any]) -> None:
    attempt(points)


def attempt(points: list[Any]) -> None:
    if not points:
        return
    array = np.array(points)
    try:
        Delaunay(array)
    except DegenerateInputError as error:
        with pytest.raises(DegenerateInputError) as caught:
            ConvexHull(array)
        assert caught.value.reason == error.reason
        return
    check(array)


def test_extreme_points_by_another_hand() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    for d in (2, 3):
        points = np.random.default_rng(d).standard_normal((500, d))
        hull, other = ConvexHull(points), spatial.ConvexHull(points)
        assert set(hull.vertices.tolist()) == set(other.vertices.tolist())
        assert hull.volume == pytest.approx(other.volume)
        assert hull.area == pytest.approx(other.area)
        mine = {
            frozenset(s): e for s, e in zip(hull.simplices.tolist(), hull.equations, strict=True)
        }
        for simplex, equation in zip(other.simplices.tolist(), other.equations, strict=True):
            assert mine[frozenset(simplex)] == pytest.approx(equation)


def test_large_facets_are_triangulated_by_the_delaunay_rule() -> None:
    ring = datasets.pythagorean_circle(108)
    points = np.concatenate([np.column_stack((ring, np.full(108, z))) for z in (0.0, 5.0)])
    hull = check(points)
    lids = [facet for facet in hull.facets if len(facet) > 4]
    assert [len(facet) for facet in lids] == [108, 108]
    for i, facet in enumerate(hull.facets):
        if len(facet) == 108:
            # All are on one circle: a fan from the smallest.
            assert (hull.simplices[hull.facet_of == i] == facet[0]).any(axis=1).all()


def test_equations_and_measures_far_away() -> None:
    cube = datasets.GENERATORS3["grid"](27)
    for scale, shift in ((2.0**-300, 0.0), (1.0, 2.0**40), (2.0**300, 0.0)):
        hull = ConvexHull(cube * scale + shift)
        assert hull.volume == pytest.approx(8 * scale**3, abs=0)
        assert hull.area == pytest.approx(24 * scale**2, abs=0)
        normals = {tuple(row) for row in hull.equations[:, :3].tolist()}
        assert normals == {(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)}
        assert hull.facets[0].shape == (4,)
    assert ConvexHull(cube * 5e-324).area == 0
    assert ConvexHull(cube * 2.0**1000).volume == np.inf


def test_volume_of_a_sliver_is_accurate() -> None:
    thin = np.array([(0, 0, 0), (1, 0, 0.1), (0, 1, 0.2), (1, 1, 0.3)])  # 0.1 + 0.2 is not 0.3
    a, b, c, d = ([Fraction(x) for x in p] for p in thin.tolist())
    hull = ConvexHull(thin)
    u, v, w = ([x - y for x, y in zip(p, a, strict=True)] for p in (b, c, d))
    determinant = sum(
        u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3)
    )
    assert hull.volume == pytest.approx(float(abs(determinant) / 6), rel=1e-13)


@pytest.mark.filterwarnings("error")
def test_measures_beyond_the_range_are_infinite() -> None:
    """Sums of finite terms, sides beyond the range, and an offset whose partial sums are."""
    far = 1e308
    triangle = ConvexHull([(0, 0), (far, 0), (0, far)])
    assert (triangle.area, triangle.volume) == (np.inf, np.inf)
    corner = ConvexHull([(0, 0, 0), (1e154, 0, 0), (0, 1e154, 0), (0, 0, 1e154)])
    assert (corner.area, corner.volume) == (np.inf, np.inf)
    assert ConvexHull([(-far, 0), (far, 0), (0, 1)]).area == np.inf
    most = float(np.finfo(float).max)
    points = [(-most, -most, most), (1, 1, -most), (1e-300, -1e300, -1e300), (-most, 0, 0)]
    equations = ConvexHull([*points, (most, 1e300, most)]).equations
    assert np.isfinite(equations).all()
    assert equations[0, 3] == pytest.approx(-most / np.sqrt(3), rel=1e-12)


def test_attributes_in_the_plane() -> None:
    hull = ConvexHull([(0, 0), (4, 0), (4, 3), (2, 3), (0, 3), (1, 1), (4, 3)])
    assert hull.vertices.tolist() == [0, 1, 2, 4]
    assert hull.simplices.tolist() == [[0, 1], [1, 2], [2, 4], [4, 0]]
    assert hull.neighbors.tolist() == [[1, 3], [2, 0], [3, 1], [0, 2]]
    assert hull.equations.tolist() == [[0, -1, 0], [1, 0, -4], [0, 1, -3], [-1, 0, 0]]
    assert (hull.volume, hull.area) == (12.0, 14.0)
    assert hull.coplanar.tolist() == [[6, 1, 2]]
    assert [facet.tolist() for facet in hull.facets] == hull.simplices.tolist()
    assert repr(hull) == "<ConvexHull of 7 points: 4 vertices>"
    assert (hull.min_bound.tolist(), hull.max_bound.tolist()) == ([0, 0], [4, 3])


def test_objects_do_not_change() -> None:
    hull = ConvexHull(datasets.GENERATORS3["uniform"](30))
    other = pickle.loads(pickle.dumps(hull))
    assert (other.simplices == hull.simplices).all()
    assert other.volume == hull.volume
    assert copy.copy(hull) is copy.deepcopy(hull) is hull
    with pytest.raises(AttributeError):
        hull.volume = 1  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        hull.simplices[0] = 0
    with pytest.raises(AttributeError):
        hull.__init__(hull.points)  # type: ignore[misc]


def test_what_is_refused() -> None:
    with pytest.raises(NonFiniteError):
        ConvexHull([(0, 0), (1, 0), (0, np.inf)])
    with pytest.raises(ShapeError):
        ConvexHull(np.zeros((15, 9)))
    for points in (np.zeros((0, 3)), np.zeros((0, 2)), [(1, 1)], [(1, 1, 1)]):
        with pytest.raises(DegenerateInputError):
            ConvexHull(points)


CUBE = np.array([(x, y, z) for x in (0.0, 1) for y in (0.0, 1) for z in (0.0, 1)])


@pytest.mark.parametrize("points", [CUBE[:, :2], CUBE, np.vstack((CUBE, CUBE / 2 + 0.25))])
@pytest.mark.parametrize(
    ("name", "field"),
    [
        ("vertices", "vertices"),
        ("polygons", "facets"),
        ("facet_of", "facets"),
        ("starts", "facets"),
    ],
)
def test_wrong_vertices_and_facets_are_found(points: np.ndarray, name: str, field: str) -> None:
    hull = ConvexHull(points)
    assert hull.validate()
    right = hull._arrays()[name]
    if name == "starts":
        wrong = right.copy()
        wrong[1] += 2 if hull.ndim == 2 else 1
    else:
        wrong = right[:-1] if name == "vertices" else np.roll(right, 1)
    report = ConvexHull._from_arrays(hull._arrays() | {name: wrong}).validate()
    assert not report
    assert len(getattr(report, field))
    assert field in str(report)
