"""Points that span no volume: the typed error, with what they span instead."""

from __future__ import annotations

import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from delone import (
    ConvexHull,
    DegenerateInputError,
    Delaunay,
    RegularTriangulation,
    Voronoi,
    datasets,
)
from delone.testing import same_triangles, triangle_set

PLANES = [
    ((1, 0, 0), (0, 1, 0)),
    ((1, 0, 1), (0, 1, 2)),
    ((0, 1, 0), (0, 0, 1)),
    ((0, 0, 1), (1, 0, 0)),
]


def error_of(points: Any) -> DegenerateInputError:
    with pytest.raises(DegenerateInputError) as caught:
        Delaunay(points)
    with pytest.raises(DegenerateInputError) as again:
        ConvexHull(points)
    assert again.value.reason == caught.value.reason
    copy = pickle.loads(pickle.dumps(caught.value))
    assert copy.reason == caught.value.reason
    return caught.value


@pytest.mark.parametrize("name", ["uniform", "grid", "pythagorean_circle", "duplicates"])
@pytest.mark.parametrize("u", [(1, 0, 0), (0, 1, 0), (0, 0, 1)])
def test_coordinate_planes_are_triangulated_as_the_plane_is(name: str, u: Any) -> None:
    flat = datasets.GENERATORS[name](60)
    axis = u.index(1)
    # Axes in cyclic order, so that counter-clockwise is seen from where the third grows.
    points = np.zeros((60, 3))
    points[:, [(axis + 1) % 3, (axis + 2) % 3]] = flat
    points[:, axis] = 7
    error = error_of(points)
    assert error.reason == "coplanar"
    wanted = Delaunay(flat)
    if axis == 1:  # the lexicographic order is another one, and so are ties
        mirrored = Delaunay(flat[:, ::-1])
        turned = [(a, c, b) for a, b, c in mirrored.simplices.tolist()]
        assert same_triangles(error.plane.simplices, turned)
    else:
        assert same_triangles(error.plane.simplices, wanted.simplices)
        assert sorted(error.plane.convex_hull.tolist()) == sorted(wanted.convex_hull.tolist())
    assert error.plane.duplicates.tolist() == wanted.coplanar[:, [0, 2]].tolist()


@pytest.mark.parametrize(("u", "v"), PLANES)
def test_order_leaves_no_trace_in_tilted_planes(u: Any, v: Any) -> None:
    a, b = np.random.default_rng(0).integers(0, 5, (2, 40, 1))
    points = (a * u + b * v).astype(np.float64)
    plane = error_of(points).plane
    _, rank = np.unique(points, axis=0, return_inverse=True)
    order = np.random.default_rng(1).permutation(40)
    other = error_of(points[order]).plane
    one = triangle_set(rank.reshape(-1)[plane.simplices])
    assert triangle_set(rank.reshape(-1)[order][other.simplices]) == one
    corners = plane.points[plane.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (normals == normals[0] * (normals[:, :1] / normals[0, 0] if normals[0, 0] else 1)).any()
    assert next(x for x in normals[0][::-1] if x) > 0
    for t, row in enumerate(plane.neighbors.tolist()):
        for k, beyond in enumerate(row):
            if beyond >= 0:
                shared = set(plane.simplices[t].tolist()) & set(plane.simplices[beyond].tolist())
                assert shared == set(plane.simplices[t].tolist()) - {int(plane.simplices[t, k])}


def test_lines_and_few_points() -> None:
    line = np.array([(3, 3, 3), (0, 0, 0), (1, 1, 1), (0, 0, 0), (2, 2, 2)], dtype=np.float64)
    error = error_of(line)
    assert (error.reason, error.chain.tolist(), error.plane) == ("collinear", [1, 2, 4, 0], None)
    error = error_of([(1, 0, 0), (0, 0, 0), (1, 0, 0), (0, 1, 0)])
    assert error.reason == "too few points"
    assert triangle_set(error.plane.simplices) == {(0, 3, 1)}
    assert error.plane.duplicates.tolist() == [[2, 0]]
    assert error_of([(1, 2, 3)] * 3).chain.tolist() == [0]
    assert error_of([(0, 0, 0), (2, 2, 2), (1, 1, 1)]).chain.tolist() == [0, 2, 1]
    assert error_of(np.zeros((0, 3))).chain.tolist() == []


def test_planes_at_the_ends_of_the_range() -> None:
    square = np.array([(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], dtype=np.float64)
    for scale in (5e-324, 2.0**-1060, 2.0**1023, np.finfo(float).max):
        plane = error_of(square * scale).plane
        assert triangle_set(plane.simplices) == {(0, 1, 2), (0, 2, 3)}


@pytest.mark.parametrize("scale", [1.0, 2.0**-1040, 2.0**1000])
def test_circumcentres_are_the_vertices_of_the_diagram_of_the_plane(scale: float) -> None:
    a, b = np.random.default_rng(1).random((2, 30, 1)) * 8
    points = (a.round(3) * (1, 0, 1) + b.round(3) * (0, 1, 2)).round(3)
    points[:, 2] = points[:, 0] + 2 * points[:, 1]
    points = np.round(points * 2**10) * scale
    points[:, 2] = points[:, 0] + 2 * points[:, 1]
    with pytest.raises(DegenerateInputError) as caught:
        Voronoi(points)
    plane = caught.value.plane
    centers = plane.circumcenters
    away = plane.points[plane.simplices] / scale - centers[:, None] / scale
    radii = np.sqrt((away**2).sum(axis=2))
    assert radii == pytest.approx(np.repeat(radii[:, :1], 3, axis=1), rel=1e-9)
    upright = (centers @ (1, 2, -1)) / scale
    assert np.abs(upright).max() < 1e-6 * np.abs(centers / scale).max()


def dot(p: Any, q: Any) -> Any:
    return sum(x * y for x, y in zip(p, q, strict=True))


def weighted_plane(points: Any, weights: Any) -> Any:
    with pytest.raises(DegenerateInputError) as caught:
        RegularTriangulation(points, weights)
    assert caught.value.reason == "coplanar"
    return caught.value.plane


@pytest.mark.parametrize("scale", [1.0, 2.0**-500, 2.0**480])
@pytest.mark.parametrize("axis", [0, 2])
def test_weighted_coordinate_planes_are_regular_as_the_plane_is(axis: int, scale: float) -> None:
    rng = np.random.default_rng(5)
    flat = rng.integers(0, 9, (90, 2)).astype(float)
    weights = rng.integers(0, 12, 90).astype(float)
    points = np.full((90, 3), 5.0)
    points[:, [(axis + 1) % 3, (axis + 2) % 3]] = flat
    plane = weighted_plane(points * scale, weights * scale**2)
    wanted = RegularTriangulation(flat, weights)
    assert len(wanted.hidden) > 10 and len(wanted.coplanar)
    assert same_triangles(plane.simplices, wanted.simplices)
    assert plane.hidden.tolist() == wanted.hidden.tolist()
    assert plane.duplicates.tolist() == wanted.coplanar[:, [0, 2]].tolist()
    assert sorted(plane.convex_hull.tolist()) == sorted(wanted.convex_hull.tolist())
    for t, row in enumerate(plane.neighbors.tolist()):
        for k, beyond in enumerate(row):
            if beyond >= 0:
                shared = set(plane.simplices[t].tolist()) & set(plane.simplices[beyond].tolist())
                assert shared == set(plane.simplices[t].tolist()) - {int(plane.simplices[t, k])}


@pytest.mark.parametrize(("u", "v"), PLANES)
def test_weighted_triangles_of_tilted_planes_have_empty_spheres(u: Any, v: Any) -> None:
    """In the plane each triangle has a centre to which no site has less power than its corners."""
    rng = np.random.default_rng(6)
    a, b = rng.integers(0, 30, (2, 40, 1))
    points = (a * u + b * v + (1, 2, 3)).astype(np.float64)
    weights = rng.integers(0, 60, 40).astype(float)
    plane = weighted_plane(points, weights)
    assert len(plane.hidden)
    at = [tuple(map(Fraction, p)) for p in points.tolist()]
    heavy = [Fraction(w) for w in weights.tolist()]
    for t, triangle in enumerate(plane.simplices.tolist()):
        o, p, q = triangle
        e, f = ([x - y for x, y in zip(at[i], at[o], strict=True)] for i in (p, q))
        # The centre o + r e + s f has equal power to all three.
        right = [(dot(g, g) + heavy[o] - heavy[i]) / 2 for g, i in ((e, p), (f, q))]
        ee, ef, ff = dot(e, e), dot(e, f), dot(f, f)
        det = ee * ff - ef * ef
        r, s = (right[0] * ff - right[1] * ef) / det, (right[1] * ee - right[0] * ef) / det
        center = [c + r * x + s * y for c, x, y in zip(at[o], e, f, strict=True)]
        away = [[x - c for x, c in zip(i, center, strict=True)] for i in at]
        power = [dot(d, d) - w for d, w in zip(away, heavy, strict=True)]
        assert power[o] == power[p] == power[q] == min(power)
        assert plane.circumcenters[t] == pytest.approx([float(c) for c in center], abs=1e-9)


def test_equal_weights_are_none_and_order_leaves_no_trace() -> None:
    a, b = np.random.default_rng(0).integers(0, 5, (2, 40, 1))
    points = (a * (1, 0, 1) + b * (0, 1, 2)).astype(np.float64)
    wanted = error_of(points).plane
    found = weighted_plane(points, np.full(40, 3.5))
    assert same_triangles(found.simplices, wanted.simplices)
    assert found.duplicates.tolist() == wanted.duplicates.tolist()
    weights = np.random.default_rng(1).integers(0, 4, 40).astype(float)
    one = weighted_plane(points, weights)
    order = np.random.default_rng(2).permutation(40)
    other = weighted_plane(points[order], weights[order])
    _, rank = np.unique(points, axis=0, return_inverse=True)
    rank = rank.reshape(-1)
    left, right = rank[one.simplices], rank[order][other.simplices]
    assert triangle_set(left) == triangle_set(right)


def test_three_weighted_points_have_their_triangle() -> None:
    with pytest.raises(DegenerateInputError) as caught:
        RegularTriangulation([(0, 0, 0), (4, 0, 0), (0, 4, 0)], [0, 1, 2])
    assert caught.value.reason == "too few points"
    assert triangle_set(caught.value.plane.simplices) == {(0, 1, 2)}
    with pytest.raises(DegenerateInputError) as caught:
        Voronoi([(0, 0, 1), (4, 0, 1), (4, 4, 1), (0, 4, 1), (2, 2, 1)], weights=[0, 0, 0, 0, 4])
    centers = caught.value.plane.circumcenters
    expected = [(-1, 2, 1), (2, -1, 1), (2, 5, 1), (5, 2, 1)]
    assert sorted(map(tuple, centers.tolist())) == expected
    with pytest.raises(DegenerateInputError) as caught:
        RegularTriangulation([(0, 0, 0), (1, 1, 1), (2, 2, 2), (3, 3, 3)], [0, 0, 0, 0])
    assert caught.value.reason == "collinear" and caught.value.plane is None
