"""Points beyond a side by a rounding: the distance that counts as inside, exactly."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay, datasets
from delone.compat import scipy as drop_in
from delone.errors import InputError


@pytest.mark.parametrize("ndim", [2, 3])
def test_points_on_sides_are_found(ndim: int) -> None:
    mesh = Delaunay(datasets.uniform(60, ndim=ndim, seed=3))
    hull = mesh.convex_hull
    shares = np.random.default_rng(0).dirichlet(np.ones(ndim), size=len(hull))
    places = np.einsum("kj,kjd->kd", shares, mesh.points[hull])
    exact = mesh.find_simplex(places)
    found = mesh.find_simplex(places, tolerance=1e-14)
    assert (exact < 0).any() and (found >= 0).all()
    assert np.array_equal(found[exact >= 0], exact[exact >= 0])
    # A triangle with that side, which the query is beyond.
    for row in np.flatnonzero(exact < 0):
        assert set(hull[row]) <= set(mesh.simplices[found[row]])
    assert (mesh.find_simplex(places + 5, tolerance=1.0) < 0).all()
    assert (mesh.find_simplex(places + 5, tolerance=np.inf) >= 0).all()
    assert (mesh.find_simplex(places + np.nan, tolerance=np.inf) < 0).all()


@pytest.mark.parametrize("ndim", [2, 3])
def test_the_distance_is_compared_exactly(ndim: int) -> None:
    corners = np.vstack([np.zeros(ndim), 4 * np.eye(ndim)])
    mesh = Delaunay(corners)
    tiny = 2.0**-1000
    # Beyond a side, a corner and, in 3-D, an edge: 3, 5 and 5 away.
    for away in ([1.0, -3.0], [-3.0, -4.0]) if ndim == 2 else ([1, 1, -3.0], [1, -3.0, -4.0]):
        query: Any = np.array(away)
        distance = 3.0 if sum(x < 0 for x in away) == 1 else 5.0
        assert mesh.find_simplex(query, tolerance=distance) == 0
        assert mesh.find_simplex(query, tolerance=np.nextafter(distance, 0)) == -1
    query = np.ones(ndim)
    query[-1] = -tiny
    assert mesh.find_simplex(query, tolerance=tiny) == 0
    assert mesh.find_simplex(query, tolerance=tiny / 2) == -1


def test_holes_and_bad_tolerances() -> None:
    points = [(0, 0), (6, 0), (0, 6), (1, 1), (2, 1), (1, 2)]
    mesh = ConstrainedDelaunay(points, [(3, 4), (4, 5), (5, 3)], holes=[(1.2, 1.2)])
    assert mesh.find_simplex((1.2, 1.125), tolerance=0.125) >= 0
    assert mesh.find_simplex((1.2, 1.125), tolerance=0.124) == -1
    for bad in (-1.0, float("nan")):
        with pytest.raises(InputError, match="tolerance must be at least 0"):
            mesh.find_simplex((0, 0), tolerance=bad)


@pytest.mark.parametrize("ndim", [2, 3])
def test_the_drop_in_honors_its_tolerance(ndim: int) -> None:
    corners = np.vstack([np.zeros(ndim), 4 * np.eye(ndim)])
    tri = drop_in.Delaunay(corners)
    query = np.ones(ndim)
    query[-1] = -0.5
    # Its weight of the last corner is -1/8.
    assert tri.find_simplex(query) == tri.find_simplex(query, tol=0.124) == -1
    assert tri.find_simplex(query, tol=0.125) == 0
    assert tri.find_simplex([query, corners[1]], tol=0.2).tolist() == [0, 0]
    assert Fraction(0.125) == Fraction(1, 8)
