"""The vertex nearest to a point, in a triangulation that need not be Delaunay."""

from __future__ import annotations

import numpy as np
import pytest

from delone import RegularTriangulation


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("seed", range(5))
def test_nearest_is_by_distance_and_not_by_power(ndim: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 40, (60, ndim)).astype(float)
    mesh = RegularTriangulation(points, rng.integers(0, 600, 60).astype(float))
    assert len(mesh.hidden)
    queries = rng.integers(-10, 50, (200, ndim)).astype(float)
    vertices = np.unique(mesh.simplices)
    # Squares of differences of small integers are exact.
    squares = ((queries[:, None] - points[vertices]) ** 2).sum(axis=2)
    assert mesh.nearest(queries).tolist() == vertices[squares.argmin(axis=1)].tolist()
