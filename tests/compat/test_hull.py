"""The drop-in for SciPy's ConvexHull, and Delaunay in space, beside SciPy's own."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from delone.compat.scipy import ConvexHull, Delaunay, DimensionError, QhullError

spatial = pytest.importorskip("scipy.spatial")


@pytest.mark.parametrize("d", [2, 3])
def test_attributes_beside_scipy(d: int) -> None:
    points = np.random.default_rng(d).standard_normal((60, d))
    ours, theirs = ConvexHull(points), spatial.ConvexHull(points)
    for name in ("ndim", "npoints", "nsimplex", "good"):
        assert getattr(ours, name) == getattr(theirs, name)
    for name in ("vertices", "simplices", "neighbors", "equations", "coplanar", "min_bound"):
        mine, other = getattr(ours, name), getattr(theirs, name)
        assert (mine.dtype, mine.shape) == (other.dtype, other.shape)
        mine[:] = 0  # as in SciPy, arrays are the caller's
    again = ConvexHull(points)
    assert again.volume == pytest.approx(theirs.volume)
    assert again.area == pytest.approx(theirs.area)
    assert again.points is points
    assert set(again.vertices.tolist()) == set(theirs.vertices.tolist())


@pytest.mark.parametrize("options", ["QG4", "QG-4", "QG7 Qt"])
@pytest.mark.parametrize("d", [2, 3])
def test_visible_facets_beside_scipy(options: str, d: int) -> None:
    for seed in range(5):
        points = np.random.default_rng(seed).standard_normal((12, d))
        sides = [
            {frozenset(s): bool(g) for s, g in zip(h.simplices.tolist(), h.good, strict=True)}
            for h in (
                ConvexHull(points, qhull_options=options),
                spatial.ConvexHull(points, qhull_options=options),
            )
        ]
        assert sides[0] == sides[1]


def test_added_points() -> None:
    points = np.random.default_rng(0).standard_normal((40, 3))
    hull = ConvexHull(points[:10], incremental=True)
    hull.add_points(points[10:])
    assert (hull.simplices == ConvexHull(points).simplices).all()
    with pytest.raises(ValueError, match="3 coordinates"):
        hull.add_points([(0, 0)])
    hull.close()
    with pytest.raises(RuntimeError):
        hull.add_points(points)


def test_what_is_refused() -> None:
    line = [(0, 0), (1, 1), (2, 2)]
    for wrong, error in (
        (line, QhullError),
        (np.zeros((6, 9)), DimensionError),
        (np.zeros((6, 4)), QhullError),
        ([(0, 0), (1, 0), (0, np.nan)], ValueError),
        ([(0, 0), (1, 0), (0, np.inf)], QhullError),
        (np.zeros((0, 2)), ValueError),
    ):
        with pytest.raises(error):
            ConvexHull(wrong)
    with pytest.raises(QhullError):
        ConvexHull([*line, (0, 1)], qhull_options="Qk")
    with pytest.raises(QhullError):
        ConvexHull([*line, (0, 1)], qhull_options="QG9")


def test_duplicates_with_qc() -> None:
    square = [(0, 0), (1, 0), (1, 1), (0, 1), (1, 1), (0.5, 0.5), (0.5, 0.5)]
    assert len(ConvexHull(square).coplanar) == 0
    ((row, facet, vertex),) = ConvexHull(square, qhull_options="Qc").coplanar.tolist()
    assert (row, vertex) == (4, 2)
    assert 2 in ConvexHull(square).simplices[facet]


def test_tetrahedra_beside_scipy() -> None:
    points = np.random.default_rng(4).random((50, 3))
    ours, theirs = Delaunay(points), spatial.Delaunay(points)
    keys = [{frozenset(s) for s in t.simplices.tolist()} for t in (ours, theirs)]
    assert keys[0] == keys[1]
    order = {frozenset(s): i for i, s in enumerate(theirs.simplices.tolist())}
    same = [order[frozenset(s)] for s in ours.simplices.tolist()]
    assert np.allclose(ours.equations, theirs.equations[same])
    assert ours.paraboloid_scale == pytest.approx(theirs.paraboloid_scale)
    assert ours.paraboloid_shift == pytest.approx(theirs.paraboloid_shift)
    queries = np.random.default_rng(5).random((100, 3))
    found: Any = ours.find_simplex(queries)
    assert (np.where(found >= 0, np.array(same)[found], -1) == theirs.find_simplex(queries)).all()
    assert np.allclose(ours.plane_distance(queries[0]), theirs.plane_distance(queries[0])[same])
    assert ours.transform.shape == theirs.transform.shape
    with pytest.raises(DimensionError):
        Delaunay(points, furthest_site=True)
    flat = [(x, y, x + y) for x, y in itertools.product(range(3), repeat=2)]
    with pytest.raises(QhullError):
        Delaunay(flat)
