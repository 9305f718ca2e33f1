"""Concave hulls: against a plain program on fractions, and against shapely."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import shapely

import delone
from alpha_values import lattice

_RANDOM = np.random.default_rng(3)
_ANGLES = np.linspace(0, 2 * np.pi, 150)
_SETS = {
    "random": _RANDOM.random((70, 2)),
    "lattice": lattice(6, 5),
    "letter": np.concatenate((lattice(3, 20), lattice(20, 3))),
    "ring": np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))
    * _RANDOM.uniform(0.8, 1, 150)[:, None],
    "far": _RANDOM.random((50, 2)) + 1e6,
}


def _square(points, a, b):
    return sum((Fraction(x) - Fraction(y)) ** 2 for x, y in zip(points[a], points[b], strict=True))


def _dug(mesh, limit):
    """Return the triangles that remain: every step looks at all of the boundary."""
    points = mesh.points.tolist()
    kept = {t: tuple(row) for t, row in enumerate(mesh.simplices.tolist())}
    while True:
        sides = {}
        for t, (a, b, c) in kept.items():
            for edge, apex in (((a, b), c), ((b, c), a), ((c, a), b)):
                sides.setdefault(frozenset(edge), []).append((t, apex))
        bare = {edge: found[0] for edge, found in sides.items() if len(found) == 1}
        on = set().union(*bare)
        ready = []
        for edge, (t, apex) in bare.items():
            a, b = sorted(edge, key=lambda v: points[v])
            square = _square(points, a, b)
            if apex not in on and square > Fraction(limit) ** 2:
                ready.append((square, points[a], points[b], t))
        if not ready:
            return set(kept)
        del kept[max(ready)[-1]]


@pytest.mark.parametrize("share", [0, 0.2, 0.5, 0.9])
@pytest.mark.parametrize("name", _SETS)
def test_hulls_are_those_of_a_plain_program(name, share):
    mesh = delone.Delaunay(_SETS[name])
    along = mesh.points[mesh.edges[:, 0]] - mesh.points[mesh.edges[:, 1]]
    limit = float(np.quantile(np.hypot(*along.T), share)) if share else 0.0
    hull = delone.concave_hull(mesh, max_edge=limit)
    assert set(np.flatnonzero(hull.is_kept).tolist()) == _dug(mesh, limit)
    polygon = hull.polygon()
    assert polygon.is_valid
    assert polygon.area == pytest.approx(hull.area)
    assert hull.is_manifold
    assert hull.nparts == 1
    assert shapely.covers(polygon, shapely.points(mesh.points)).all()


@pytest.mark.parametrize("ratio", [0, 0.05, 0.3, 0.7, 1])
def test_shapely_has_the_same(ratio):
    # Without ties; its limit is a rounded number, too.
    points = np.random.default_rng(9).random((400, 2))
    ours = delone.concave_hull(points, ratio=ratio).polygon()
    theirs = shapely.concave_hull(shapely.multipoints(points), ratio=ratio)
    assert ours.symmetric_difference(theirs).area < 1e-9 * theirs.area


@pytest.mark.parametrize("name", _SETS)
@pytest.mark.parametrize("holes", [False, True])
def test_rows_scales_and_workers_change_nothing(name, holes):
    points = _SETS[name]
    expected = delone.concave_hull(points, ratio=0.2, holes=holes, workers=1).polygon()
    shuffle = np.random.default_rng(2).permutation(len(points))
    again = delone.concave_hull(points[shuffle], ratio=0.2, holes=holes, workers=3).polygon()
    assert again.equals_exact(expected, 0)
    scaled = delone.concave_hull(points * 2.0**-70, ratio=0.2, holes=holes).polygon()
    assert shapely.transform(scaled, lambda at: at * 2.0**70).equals_exact(expected, 0)


def test_holes_are_apart():
    angles = _RANDOM.uniform(0, 2 * np.pi, 900)
    radii = _RANDOM.uniform(2, 3, 900)
    points = np.column_stack((radii * np.cos(angles), radii * np.sin(angles)))
    points = np.concatenate((points, points + np.array((5.5, 0))))
    plain = delone.concave_hull(points, max_edge=0.9).polygon()
    hull = delone.concave_hull(points, max_edge=0.9, holes=True)
    polygon = hull.polygon()
    assert (len(plain.interiors), len(polygon.interiors)) == (0, 2)
    assert polygon.is_valid
    assert hull.is_manifold
    assert shapely.covers(polygon, shapely.points(points)).all()


def test_a_ratio_of_one_keeps_the_convex_hull():
    points = lattice(4, 4)
    assert delone.concave_hull(points, ratio=1).area == 9
    assert delone.concave_hull(points, max_edge=np.inf).area == 9
    # Not longer than the limit.
    assert delone.concave_hull([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], max_edge=4).area == 16


def test_solids_keep_every_point():
    points = np.random.default_rng(5).random((300, 3))
    for ratio in (0, 0.3, 1):
        hull = delone.concave_hull(points, ratio=ratio)
        assert len(np.unique(hull.simplices)) == 300
        other = delone.concave_hull(points[::-1].copy(), ratio=ratio)
        assert other.volume == hull.volume
    assert hull.is_manifold
    assert hull.volume == pytest.approx(delone.ConvexHull(points).volume)
    faces = points[delone.concave_hull(points, ratio=0.3).boundary]
    assert np.linalg.det(faces).sum() / 6 == pytest.approx(
        delone.concave_hull(points, ratio=0.3).volume
    )


@pytest.mark.parametrize(
    "points",
    [np.empty((0, 2)), [(1, 1)], [(0, 0), (1, 1)], [(0, 0), (1, 1), (2, 2)], np.ones((4, 2))],
    ids=len,
)
def test_points_without_an_area_have_an_empty_hull(points):
    hull = delone.concave_hull(points, ratio=0.5)
    assert (hull.area, len(hull.simplices), len(hull.boundary)) == (0, 0, 0)
    assert hull.polygon().is_empty


def test_wrong_input():
    points = [(0, 0), (1, 0), (0, 1)]
    for options in ({}, {"max_edge": 1, "ratio": 1}):
        with pytest.raises(delone.InputError, match="either"):
            delone.concave_hull(points, **options)
    for ratio in (-0.1, 1.1, np.nan):
        with pytest.raises(delone.InputError, match="from 0 to 1"):
            delone.concave_hull(points, ratio=ratio)
    for length in (-1, np.nan):
        with pytest.raises(delone.InputError, match="at least 0"):
            delone.concave_hull(points, max_edge=length)
    with pytest.raises(delone.InputError, match="2-D"):
        delone.concave_hull(np.eye(4, 3), ratio=0, holes=True)
    with pytest.raises(delone.InputError, match="2-D"):
        delone.concave_hull(np.eye(4, 3), ratio=0).polygons()
    with pytest.raises(delone.NonFiniteError):
        delone.concave_hull([(0, np.inf)], ratio=0)
