"""Points that span no volume: the typed error, with what they span instead."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from delone import ConvexHull, DegenerateInputError, Delaunay, Voronoi, datasets
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
