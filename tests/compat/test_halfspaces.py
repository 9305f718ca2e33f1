"""The drop-in for SciPy's HalfspaceIntersection, beside SciPy's own and beside fractions."""

from __future__ import annotations

import copy
import math
import pickle
from fractions import Fraction
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from delone import DtypeError, ShapeError
from delone.compat.scipy import DimensionError, HalfspaceIntersection, QhullError
from delone.voronoi.halfspaces import common_part

spatial = pytest.importorskip("scipy.spatial")

SQUARE = np.array([(-1.0, 0, 0), (1, 0, -1), (0, -1, 0), (0, 1, -1)])
PYRAMID = np.array([(1.0, 0, 1, -1), (-1, 0, 1, -1), (0, 1, 1, -1), (0, -1, 1, -1), (0, 0, -1, 0)])


def tangents(count: int, d: int, seed: int, far: float = 0.0) -> tuple[Any, Any]:
    """Half-spaces about a ball, some of them redundant, and a point inside."""
    rng = np.random.default_rng(seed)
    normals = rng.standard_normal((count, d))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    radii = rng.uniform(0.8, 2.0, count)
    center = far * (1 + rng.random(d))
    scale = rng.uniform(0.1, 9, (count, 1))
    rows = np.column_stack((normals, -radii - normals @ center)) * scale
    return rows, center + rng.uniform(-0.2, 0.2, d)


def exact_corners(rows: Any) -> set[tuple[Fraction, ...]]:
    """All points of d boundaries that no half-space leaves out, by brute force."""
    d = rows.shape[1] - 1
    exact = [[Fraction(x) for x in row] for row in rows.tolist()]
    found = set()
    for chosen in combinations(exact, d):
        point = solved([[*row[:d], -row[d]] for row in chosen])
        if point is not None and all(
            sum(a * x for a, x in zip(row, point, strict=False)) + row[d] <= 0 for row in exact
        ):
            found.add(tuple(point))
    return found


def solved(matrix: list[list[Fraction]]) -> list[Fraction] | None:
    """Gauss and Jordan's elimination."""
    count = len(matrix)
    for k in range(count):
        pivot = next((i for i in range(k, count) if matrix[i][k]), None)
        if pivot is None:
            return None
        matrix[k], matrix[pivot] = matrix[pivot], matrix[k]
        matrix[k] = [x / matrix[k][k] for x in matrix[k]]
        for i in range(count):
            if i != k:
                factor = matrix[i][k]
                matrix[i] = [x - factor * y for x, y in zip(matrix[i], matrix[k], strict=True)]
    return [row[count] for row in matrix]


def is_turned(rows: Any, point: Any, facet: list[int]) -> bool:
    """Whether the first vertices of a dual facet are counter-clockwise as seen from outside."""
    d = len(point)
    inside = [Fraction(x) for x in point.tolist()]
    dual = []
    for row in facet[:d]:
        *normal, end = map(Fraction, rows[row].tolist())
        slack = sum(a * x for a, x in zip(normal, inside, strict=True)) + end
        dual.append([-a / slack for a in normal])
    if d == 2:
        (a, b), (c, e) = dual
        return a * e > b * c
    (a, b, c), v, w = dual
    return a * (v[1] * w[2] - v[2] * w[1]) > b * (v[0] * w[2] - v[2] * w[0]) - c * (
        v[0] * w[1] - v[1] * w[0]
    )


def by_facets(found: Any) -> dict[frozenset[int], Any]:
    return {
        frozenset(facet): corner
        for facet, corner in zip(found.dual_facets, found.intersections, strict=True)
    }


@pytest.mark.parametrize(
    ("count", "d"), [*((c, d) for c in (6, 40, 300) for d in (2, 3)), (200, 4), (60, 5), (30, 6)]
)
@pytest.mark.parametrize("far", [0.0, 500.0])
def test_attributes_beside_scipy(d: int, count: int, far: float) -> None:
    rows, point = tangents(count, d, seed=count + d, far=far)
    ours, theirs = HalfspaceIntersection(rows, point), spatial.HalfspaceIntersection(rows, point)
    bounded = np.isfinite(ours.intersections).all()
    assert bounded or count == 6
    for name in ("ndim", "nineq"):
        assert getattr(ours, name) == getattr(theirs, name)
    for name in ("dual_volume", "dual_area"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), rel=1e-9)
    np.testing.assert_allclose(ours.dual_points, theirs.dual_points, rtol=1e-9)
    for name in ("halfspaces", "interior_point"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name))
    mine, other = by_facets(ours), by_facets(theirs)
    assert mine.keys() == other.keys()
    for facet, corner in mine.items():
        if np.isfinite(corner).all():
            np.testing.assert_allclose(corner, other[facet], rtol=1e-8, atol=1e-8)
    normal = dict(zip(map(frozenset, ours.dual_facets), ours.dual_equations, strict=True))
    for facet, equation in zip(theirs.dual_facets, theirs.dual_equations, strict=True):
        np.testing.assert_allclose(normal[frozenset(facet)], equation, atol=1e-7)
    assert ours.dual_vertices.dtype == theirs.dual_vertices.dtype
    assert ours.dual_vertices.tolist() == theirs.dual_vertices.tolist()


@pytest.mark.parametrize("d", [2, 3, 4, 5])
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.sampled(8)
def test_corners_are_those_of_fractions(d: int, seed: int) -> None:
    """Small integers: many boundaries through one point, multiples and redundant half-spaces."""
    rng = np.random.default_rng(seed)
    box = np.column_stack((np.vstack((np.eye(d), -np.eye(d))), np.full(2 * d, -4.0)))
    normals = rng.integers(-2, 3, ({2: 16, 3: 11, 4: 7, 5: 3}[d], d)).astype(float)
    rows = np.vstack((box, np.column_stack((normals, -rng.integers(1, 5, len(normals))))))
    if d < 5:
        rows = np.vstack((rows, 3 * rows[: 8 - d], 0.1 * rows[2:5]))
    point = rng.uniform(-0.1, 0.1, d)
    found = HalfspaceIntersection(rows, point)
    expected = exact_corners(np.unique(rows, axis=0))
    rounded = {tuple(float(x) for x in corner) for corner in expected}
    assert len(found.intersections) == len(rounded)
    near = np.array(sorted(rounded))
    for corner in found.intersections:
        assert np.abs(near - corner).max(axis=1).min() < 1e-14
    # Exactly the half-spaces through a corner, but for redundant ones.
    for facet, corner in zip(found.dual_facets, found.intersections, strict=True):
        assert len(facet) == len(set(facet)) >= d
        assert np.abs(rows[facet, :-1] @ corner + rows[facet, -1]).max() < 1e-13
    kept = set(found.dual_vertices.tolist())
    assert kept == {row for facet in found.dual_facets for row in facet}
    assert exact_corners(rows[sorted(kept)]) == expected
    for row in [*kept][:: d - 1]:
        fewer = exact_corners(rows[sorted(kept - {row})])
        assert fewer != expected
    if d < 4:
        for facet, corner in zip(found.dual_facets, found.intersections, strict=True):
            assert is_turned(rows, point, facet), corner


@pytest.mark.parametrize("point", [(0, 0, 0.3), (0.1, 0.02, 0.3), (0.123, -0.217, 0.111)])
def test_four_sides_through_one_corner(point: Any) -> None:
    ours = HalfspaceIntersection(PYRAMID, np.array(point))
    theirs = spatial.HalfspaceIntersection(PYRAMID, np.array(point))
    assert {*map(frozenset, ours.dual_facets)} == {*map(frozenset, theirs.dual_facets)}
    (top,) = (facet for facet in ours.dual_facets if len(facet) == 4)
    # In order around it, and so opposite sides are opposite.
    assert {top[0], top[2]} in ({0, 1}, {2, 3})
    apex = ours.intersections[ours.dual_facets.index(top)]
    np.testing.assert_allclose(apex, [0, 0, 1], atol=1e-15)
    triangles = HalfspaceIntersection(PYRAMID, np.array(point), qhull_options="Qt")
    assert [len(facet) for facet in triangles.dual_facets] == [3] * 6
    assert np.count_nonzero(triangles.intersections[:, 2] > 0.5) == 2
    assert len(spatial.HalfspaceIntersection(PYRAMID, np.array(point), qhull_options="Qt")
               .dual_facets) == 6  # fmt: skip


def test_planes_through_one_edge() -> None:
    """A redundant half-space that touches an edge, whose dual point is between two others."""
    rng = np.random.default_rng(3)
    cube = np.column_stack((np.vstack((np.eye(3), -np.eye(3))), np.full(6, -1.0)))
    for _ in range(150):
        turned = cube.copy()
        skew = np.eye(3) * 4 + rng.integers(-1, 2, (3, 3))
        turned[:, :3] = cube[:, :3] @ skew
        first, second = rng.integers(1, 10, (2, 3, 1))
        rows = np.vstack(
            (turned, first * turned[0] + second * turned[1], second * turned[1] + first * turned[2])
        )
        point = np.linalg.solve(skew, rng.uniform(-0.5, 0.5, 3))
        found = HalfspaceIntersection(rows, point)
        assert len(found.intersections) == 8
        assert found.dual_vertices.tolist() == list(range(6))
        np.testing.assert_allclose(np.abs(found.intersections @ skew.T), 1, atol=1e-14)


def signs(d: int) -> Any:
    return np.stack(np.meshgrid(*d * [[-1.0, 1.0]]), axis=-1).reshape(-1, d)


@pytest.mark.parametrize("d", range(2, 9))
@pytest.mark.deep("6", "7", "8")
def test_cubes_and_cross_polytopes_in_all_dimensions(d: int) -> None:
    rng = np.random.default_rng(d)
    point = rng.uniform(-0.1, 0.1, d)
    sides = np.vstack((np.eye(d), -np.eye(d)))
    # A touching half-space at each of some faces, which is redundant.
    touching = np.array([[*(signs(d)[0] * (np.arange(d) < k)), -float(k)] for k in range(2, d + 1)])
    cube = HalfspaceIntersection(
        np.vstack((np.column_stack((sides, np.full(2 * d, -1.0))), touching * 3)), point
    )
    assert cube.dual_vertices.tolist() == list(range(2 * d))
    assert {tuple(corner) for corner in cube.intersections.round(14)} == {*map(tuple, signs(d))}
    for facet, corner in zip(cube.dual_facets, cube.intersections, strict=True):
        assert {*facet} == {*np.flatnonzero(sides @ corner > 0.5).tolist()}
    # A dual cube in 8-D has 80,640 simplices.
    if d > 7:
        return
    # All corners of the cross-polytope are in 2^(d - 1) of its 2^d sides.
    rows = np.column_stack((signs(d), np.full(2**d, -1.0)))
    cross = HalfspaceIntersection(rows, point / d)
    assert {tuple(corner) for corner in cross.intersections.round(14)} == {*map(tuple, sides)}
    for facet, corner in zip(cross.dual_facets, cross.intersections, strict=True):
        assert {*facet} == {*np.flatnonzero(signs(d) @ corner > 0.5).tolist()}
    # The sides of the dual cube, triangulated.
    split = HalfspaceIntersection(rows, point / d, qhull_options="Qt")
    assert {len(cell) for cell in split.dual_facets} == {d}
    duals = split.dual_points[split.dual_facets]
    volume = np.abs(np.linalg.det(duals)).sum() / math.factorial(d)
    assert volume == pytest.approx(cross.dual_volume, rel=1e-12)


@pytest.mark.parametrize("d", range(2, 9))
@pytest.mark.parametrize("ulps", [-1, 0, 1])
def test_what_a_half_space_cuts_off_is_exact(d: int, ulps: int) -> None:
    """Dual points are rounded by more than what is cut off."""
    sides = np.column_stack((np.vstack((np.eye(d), -np.eye(d))), np.full(2 * d, -1.0)))
    cut = [*np.ones(d), -(d + ulps * np.spacing(float(d)))]
    point = np.random.default_rng(d).uniform(-0.9, 0.3, d)
    found = HalfspaceIntersection(np.vstack((sides, cut)), point)
    assert (2 * d in found.dual_vertices) == (ulps < 0)
    # In place of one corner there are d.
    assert len(found.intersections) == 2**d + (d - 1 if ulps < 0 else 0)


@pytest.mark.parametrize("d", [4, 6])
def test_a_cone_without_an_end_in_more_dimensions(d: int) -> None:
    # The coordinates are not negative, and the first is at most 1.
    rows = np.column_stack((np.vstack((-np.eye(d), np.eye(d)[0])), np.zeros(d + 1)))
    rows[-1, -1] = -1
    found = HalfspaceIntersection(rows, np.full(d, 0.25))
    ends = np.isfinite(found.intersections).all(axis=1)
    assert ends.sum() == 2
    assert np.isinf(found.intersections[~ends]).all()
    # Along the other coordinates.
    assert len(found.dual_facets) == 2 + d - 1
    inner = found.dual_points @ found.dual_equations[:, :-1].T + found.dual_equations[:, -1]
    assert inner.max() < 1e-14
    for facet, heights in zip(found.dual_facets, inner.T, strict=True):
        assert {*facet} == {*np.flatnonzero(heights > -1e-14).tolist()}


def test_corners_are_those_of_double_description() -> None:
    rows, point = tangents(60, 3, seed=4)
    rows = np.round(rows * 4)
    rows = rows[rows @ [*point, 1] < 0]
    corners, faces, of = common_part(rows)
    found = HalfspaceIntersection(rows, point)
    assert found.dual_vertices.tolist() == of
    key = {frozenset(of[f] for f, face in enumerate(faces) if k in face): c
           for k, c in enumerate(corners)}  # fmt: skip
    mine = by_facets(found)
    assert mine.keys() == key.keys()
    for facet, corner in mine.items():
        np.testing.assert_allclose(corner, key[facet], rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("d", [2, 3])
def test_multiples_of_a_half_space_are_one(d: int) -> None:
    for seed in range(20):
        rows, point = tangents(30, d, seed)
        rows = np.round(rows * 2**20) / 2**20  # so that small multiples are exact
        plain = HalfspaceIntersection(rows, point)
        found = HalfspaceIntersection(np.vstack((rows, 3 * rows, 7 * rows, rows)), point)
        assert by_facets(plain).keys() == by_facets(found).keys()
        assert found.dual_vertices.tolist() == plain.dual_vertices.tolist()


def test_a_plane_that_misses_an_edge_by_rounding_cuts_it_off() -> None:
    cube = np.column_stack((np.vstack((np.eye(3), -np.eye(3))), np.full(6, -1.0)))
    missed = (0.1, 0.7, 0, -np.nextafter(0.1 + 0.7, 0))
    assert sum(map(Fraction, missed)) > 0
    found = HalfspaceIntersection(np.vstack((cube, missed)), np.array([0.2, -0.3, 0.1]))
    assert len(found.intersections) == 10
    assert 6 in found.dual_vertices


def test_without_an_end() -> None:
    wedge = np.array([(-1.0, 0, 0), (0, -1, 0), (1, -1, -3)])
    found = HalfspaceIntersection(wedge, np.array([1.0, 1]))
    assert sorted(found.intersections.tolist()) == [[0, 0], [3, 0], [np.inf, np.inf]]
    (beyond,) = np.flatnonzero(np.isinf(found.intersections[:, 0]))
    assert set(found.dual_facets[beyond]) == {0, 2}
    # Parallel sides, which meet nowhere, whatever rounding makes of their dual points.
    strip = np.array([(0.1, 0.3, -0.7), (-0.1, -0.3, -0.2), (0.3, -0.1, -1)])
    found = HalfspaceIntersection(strip, np.array([0.01, 0.03]))
    assert np.isinf(found.intersections).sum() == 2
    with pytest.raises(QhullError, match="no corner"):
        HalfspaceIntersection(SQUARE[:2], np.array([0.5, 0.5]))
    prism = np.column_stack((SQUARE[:, :2], np.zeros(4), SQUARE[:, 2]))
    with pytest.raises(QhullError, match="no corner"):
        HalfspaceIntersection(prism, np.array([0.5, 0.5, 0]))


def same(found: Any, other: Any) -> None:
    """Whether two intersections of the same half-spaces are equal."""
    assert found.dual_facets == other.dual_facets
    for name in ("halfspaces", "dual_points", "dual_vertices", "intersections", "dual_equations"):
        np.testing.assert_array_equal(getattr(found, name), getattr(other, name))
    assert found.dual_volume == pytest.approx(other.dual_volume, rel=1e-12)
    assert found.dual_area == pytest.approx(other.dual_area, rel=1e-12)


@pytest.mark.parametrize("options", ["", "Qt"])
@pytest.mark.parametrize("d", [2, 3, 4])
def test_half_spaces_are_added(d: int, options: str) -> None:
    rows, point = tangents(60, d, seed=1)
    # Some of the first half-spaces are multiples of later ones, and some become redundant.
    rows[3], rows[50:54] = 2 * rows[40], rows[10:14] * np.r_[d * [1.0], 0.6]
    found = HalfspaceIntersection(rows[:30], point, incremental=True, qhull_options=options)
    before = found.dual_vertices
    for start, end in ((30, 31), (31, 31), (31, 50), (50, 60)):
        found.add_halfspaces(rows[start:end].reshape(-1, d + 1))
        same(found, HalfspaceIntersection(rows[:end], point, qhull_options=options))
    whole = HalfspaceIntersection(rows, point, qhull_options=options)
    assert not {*before.tolist()} <= {*found.dual_vertices.tolist()}
    outside = np.r_[np.eye(d)[0], 50]
    for more in (outside, np.vstack((rows[:2], outside, outside))):
        with pytest.raises(QhullError, match=f"half-space {60 + 2 * (more.ndim - 1)}, "):
            found.add_halfspaces(more)
    with pytest.raises(ValueError, match="shape"):
        found.add_halfspaces([np.ones(d)])
    assert found.nineq == 60
    same(found, whole)
    found.close()
    for closed in (found, whole):
        with pytest.raises(RuntimeError):
            closed.add_halfspaces(rows)


@pytest.mark.parametrize("d", [2, 3, 4, 6])
def test_corners_and_planes_are_rounded_once(d: int) -> None:
    for seed, far in enumerate((0.0, 500.0, 5e6)):
        rows, point = tangents(8 * d if d < 6 else 20, d, seed, far)
        found = HalfspaceIntersection(rows, point)
        inside = [*map(Fraction, point.tolist())]
        for facet, corner, plane in zip(
            found.dual_facets, found.intersections, found.dual_equations, strict=True
        ):
            exact = solved([[*map(Fraction, row[:d]), -Fraction(row[d])]
                            for row in rows[facet].tolist()])  # fmt: skip
            assert exact is not None
            step = [x - p for x, p in zip(exact, inside, strict=True)]
            if np.isfinite(corner).all():
                # Not all corners that two roundings change by a unit are excluded by the bound.
                assert np.abs(corner - [*map(float, exact)]).max() <= np.spacing(abs(corner)).max()
                assert (corner == [*map(float, exact)]).mean() > 0.9
            length = math.sqrt(sum(x * x for x in step))
            sign = 1 if np.isfinite(corner).all() else -1
            expected = [*(float(sign * x) / length for x in step), -sign / length]
            np.testing.assert_allclose(plane, expected, rtol=1e-14, atol=1e-15)


@pytest.mark.parametrize("d", [2, 3, 5])
def test_nothing_depends_on_rows_and_units(d: int) -> None:
    rng = np.random.default_rng(d)
    sides = np.column_stack((signs(d), np.full(2**d, -1.0)))
    # Many boundaries through the corners of a cross-polytope, and some that cut one off.
    rows = np.vstack((sides, [[*np.eye(d)[0], -0.5]], rng.integers(1, 4, (6, d + 1)) * -1.0))
    point = rng.uniform(-0.4, 0.1, d) / d
    for options in ("", "Qt"):
        found = HalfspaceIntersection(rows, point, qhull_options=options)
        facets = {frozenset(facet) for facet in found.dual_facets}
        order = rng.permutation(len(rows))
        mixed = HalfspaceIntersection(rows[order], point, qhull_options=options)
        assert {frozenset(order[facet].tolist()) for facet in mixed.dual_facets} == facets
        powers = 2.0 ** rng.integers(-200, 200, (len(rows), 1))
        same_units = HalfspaceIntersection(rows * powers, point, qhull_options=options)
        assert same_units.dual_facets == found.dual_facets
        np.testing.assert_array_equal(same_units.intersections, found.intersections)
        np.testing.assert_array_equal(same_units.dual_points, found.dual_points)
        # The whole space times a power of two.
        unit = 2.0**70
        scaled = HalfspaceIntersection(rows * np.r_[np.ones(d), unit], point * unit,
                                       qhull_options=options)  # fmt: skip
        assert scaled.dual_facets == found.dual_facets
        np.testing.assert_array_equal(scaled.intersections, found.intersections * unit)


def test_numbers_of_any_size() -> None:
    # The box from -1e-160 to 1e160 in both coordinates, which products of doubles do not reach.
    rows = np.array(
        [(1e-150, 0, -1e10), (-1e150, 0, -1e-10), (0, 1e-200, -1e-40), (0, -1, -1e-160)]
    )
    found = HalfspaceIntersection(rows, np.zeros(2))
    expected = np.array([(x, y) for x in (-1e-160, 1e160) for y in (-1e-160, 1e160)])
    places = {tuple(corner) for corner in found.intersections}
    assert len(places) == 4
    for corner in expected:
        assert any(np.allclose(corner, place, rtol=1e-15, atol=0) for place in places)
    assert [*map(len, found.dual_facets)] == 4 * [2]
    with pytest.raises(QhullError, match="too close to the boundary of half-space 1"):
        HalfspaceIntersection([(1, 0, -1), (-1e200, 0, -1e-200), (0, 1, -1)], [0, 0])


def test_what_holds_everywhere_is_redundant() -> None:
    # 0 x - 1 <= 0: its boundary is at infinity.
    everywhere = np.vstack((SQUARE, [(0, 0, -1)]))
    found = HalfspaceIntersection(everywhere, np.array([0.3, 0.6]))
    assert found.dual_vertices.tolist() == [0, 1, 2, 3]
    assert found.dual_points[4].tolist() == [0, 0]
    # Without an end, its boundary takes the place of infinity.
    found = HalfspaceIntersection(everywhere[[0, 2, 4]], np.array([0.3, 0.6]))
    assert found.dual_facets == [[0, 1], [2, 0], [1, 2]]
    assert np.isinf(found.intersections).all(axis=1).tolist() == [False, True, True]
    with pytest.raises(QhullError, match="half-space 4, "):
        HalfspaceIntersection(np.vstack((SQUARE, [(0, 0, 0)])), np.array([0.3, 0.6]))


def test_a_cone_has_no_dual_volume() -> None:
    with pytest.raises(QhullError, match=r"all boundaries meet in \[2\.0, 3\.0\]"):
        HalfspaceIntersection([(-1, 0, 2), (0, -1, 3), (-1, -1, 5)], [5, 5])
    with pytest.raises(QhullError, match="no corner"):
        HalfspaceIntersection(np.empty((0, 3)), [5, 5])


@pytest.mark.parametrize("name", ["outside", "on a side", "nan point", "infinite"])
def test_a_point_that_is_not_inside(name: str) -> None:
    point = {"outside": (5.0, 1), "on a side": (1.0, 0.5), "nan point": (np.nan, 0.5)}
    rows = SQUARE + np.array([0, 0, np.inf if name == "infinite" else 0])
    for kind in (spatial.HalfspaceIntersection, HalfspaceIntersection):
        with pytest.raises(QhullError):
            kind(rows, np.array(point.get(name, (0.5, 0.5))))


def test_whether_the_point_is_inside_is_exact() -> None:
    # 0.1 x + 0.3 y - 0.4 at (1, 1) is negative by less than an ulp, as doubles go.
    row = (0.1, 0.3, -0.4)
    value = sum(map(Fraction, row))
    assert 0 < abs(value) < Fraction(1, 2**54)
    turned = row if value < 0 else tuple(-x for x in row)
    wide = np.array([(-1.0, 0, -9), (1, 0, -9), (0, -1, -9), (0, 1, -9), turned])
    assert HalfspaceIntersection(wide, np.array([1.0, 1])).nineq == 5
    with pytest.raises(QhullError, match="half-space 4"):
        HalfspaceIntersection(np.vstack((wide[:4], -wide[4:])), np.array([1.0, 1]))


def test_what_is_refused_as_scipy_refuses_it() -> None:
    inside = np.array([0.5, 0.5])
    for kind in (spatial.HalfspaceIntersection, HalfspaceIntersection):
        for rows, point in (
            (SQUARE, np.array([0.5, 0.5, 0.5])),
            (SQUARE * np.nan, inside),
            (np.ma.masked_array(SQUARE), inside),
        ):
            with pytest.raises(ValueError):
                kind(rows, point)
        with pytest.raises(QhullError):
            kind(SQUARE, inside, qhull_options="Qk")
        with pytest.raises(QhullError):
            kind(SQUARE[:2], inside)
    with pytest.raises(DimensionError, match=r"scipy\.spatial"):
        HalfspaceIntersection(np.ones((6, 10)), np.zeros(9))
    with pytest.raises(ValueError, match="intersection of half-spaces"):
        HalfspaceIntersection(SQUARE, inside, qhull_options="A-0.9")


def test_lists_and_integers_are_taken() -> None:
    found = HalfspaceIntersection(SQUARE.astype(int).tolist(), [0.5, 0.25])
    assert sorted(found.intersections.tolist()) == [[0, 0], [0, 1], [1, 0], [1, 1]]


@pytest.mark.parametrize("shift", [0.0, 5.4e6])
def test_far_from_the_origin(shift: float) -> None:
    rows = SQUARE.copy()
    rows[:, 2] -= rows[:, :2] @ [shift, shift]
    found = HalfspaceIntersection(rows, np.array([shift + 0.3, shift + 0.7]))
    assert sorted((found.intersections - shift).tolist()) == [[0, 0], [0, 1], [1, 0], [1, 1]]


@pytest.mark.parametrize("options", ["", "Qt"])
@pytest.mark.parametrize("copied", [copy.deepcopy, lambda each: pickle.loads(pickle.dumps(each))])
def test_copies_are_the_same_and_can_grow(copied: Any, options: str) -> None:
    rows, point = tangents(40, 3, seed=4)
    given = HalfspaceIntersection(rows[:30], point, incremental=True, qhull_options=options)
    given.add_halfspaces(rows[30:35])
    other = copied(given)
    for step in range(2):
        assert np.array_equal(given.intersections, other.intersections)
        assert np.array_equal(given.dual_points, other.dual_points)
        assert np.array_equal(given.dual_equations, other.dual_equations)
        assert given.dual_facets == other.dual_facets
        assert (given.dual_volume, given.nineq) == (other.dual_volume, 35 + 5 * step)
        if not step:
            for each in (given, other):
                each.add_halfspaces(rows[35:])
    given.close()
    with pytest.raises(RuntimeError, match="closed"):
        copied(given).add_halfspaces(rows[:1])


def test_later_changes_of_the_arrays_have_no_effect() -> None:
    rows, point = SQUARE.copy(), np.array([0.5, 0.5])
    found = HalfspaceIntersection(rows, point, incremental=True)
    rows[:], point[:] = 9, 7
    found.add_halfspaces([(1, 1, -1.5)])
    right = HalfspaceIntersection(np.vstack((SQUARE, [(1, 1, -1.5)])), [0.5, 0.5])
    assert np.array_equal(found.intersections, right.intersections)
    assert np.array_equal(found.halfspaces, right.halfspaces)


def test_points_and_rows_that_are_no_real_numbers() -> None:
    half = [0.5, 0.5]
    for rows, point, error, words in (
        (SQUARE, np.ma.masked_array(half, [True, False]), DtypeError, "point must not be a masked"),
        (SQUARE, np.array([0.5, 0.5j]), DtypeError, "interior_point must hold real numbers"),
        (SQUARE, ["0.5", "0.5"], DtypeError, "interior_point must hold real numbers"),
        (SQUARE, [[1], [1, 2]], ShapeError, "interior_point has rows of unequal length"),
        ([[object()] * 3] * 4, half, DtypeError, "halfspaces must contain real numbers"),
        ([[10**400, 0, -1], [0, 1, -1]], half, DtypeError, "halfspaces must contain real numbers"),
        ([[1, 2, 3], [1, 2]], half, ShapeError, "halfspaces has rows of unequal length"),
    ):
        with pytest.raises(error, match=words):
            HalfspaceIntersection(rows, point)
