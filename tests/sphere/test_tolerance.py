"""Directions just outside a hull on the sphere, which a tolerance includes."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import sphere

# The rim of this hull has an arc on the equator, from -45 to 45 degrees of longitude.
CORNERS = [(1, -1, 0), (1, 1, 0), (0, 0, 1)]
# A direction, and the angle to the rim in degrees: below the arc, beside its ends, and far away.
PLACES = [
    ((1, 0, -1), 45.0),
    ((3, 1, -np.sqrt(10)), 45.0),
    ((-1, 1, 0), 90.0),
    ((-1, 0, -1), 120.0),
    ((0, 1, -1), 60.0),
]


@pytest.mark.parametrize("place", PLACES, ids=str)
@pytest.mark.parametrize("scale", [1.0, 2.0**-300, 3.0])
def test_angles_are_compared_exactly(place: tuple[Any, float], scale: float) -> None:
    vector, angle = np.array(place[0], dtype=float) * scale, place[1]
    mesh = sphere.Delaunay(xyz=CORNERS)
    if place == PLACES[1]:
        # Rounded, so that it is a little above or below.
        x, y, z = map(Fraction, vector.tolist())
        more = z * z > x * x + y * y
        assert mesh.find_simplex(vector, tolerance=45) == (-1 if more else 0)
        return
    assert mesh.find_simplex(vector) == -1
    assert mesh.find_simplex(vector, tolerance=angle) == 0
    assert mesh.find_simplex(vector, tolerance=np.nextafter(angle, 0)) == -1
    assert mesh.find_simplex(vector, tolerance=np.inf) == 0
    # In radians the double nearest to 45 degrees is below it, and so are most others.
    radians = sphere.Delaunay(xyz=CORNERS, degrees=False)
    below = np.radians(angle)
    assert radians.find_simplex(vector, tolerance=np.nextafter(below, 4)) == 0
    assert radians.find_simplex(vector, tolerance=np.nextafter(below, 0)) == -1


def test_ends_that_are_not_numbers_stay_outside() -> None:
    mesh = sphere.Delaunay(xyz=CORNERS)
    queries = [(np.nan, 0, 0), (0, 0, 0), (np.inf, 1, 1)]
    assert mesh.find_simplex(queries, tolerance=180).tolist() == [-1, -1, -1]
    for wrong in (-1, np.nan):
        with pytest.raises(delone.InputError, match="tolerance must be"):
            mesh.find_simplex((1, 1, 1), tolerance=wrong)
    whole = sphere.Delaunay(lonlat=[(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)])
    assert (whole.find_simplex(np.eye(3), tolerance=5) == whole.find_simplex(np.eye(3))).all()


def region(seed: int) -> sphere.Delaunay:
    """Stations of a region at the date line."""
    rng = np.random.default_rng(seed)
    lonlat = np.column_stack((rng.uniform(170, 190, 80), rng.uniform(50, 60, 80)))
    return sphere.Delaunay(lonlat=lonlat)


@pytest.mark.parametrize("seed", range(3))
def test_places_on_sides_are_inside(seed: int) -> None:
    mesh = region(seed)
    rng = np.random.default_rng(seed)
    a, b = mesh.points[mesh.boundary[:, 0]], mesh.points[mesh.boundary[:, 1]]
    share = rng.random((len(a), 1))
    queries = a + share * (b - a)
    plain = mesh.find_simplex(queries)
    assert (plain < 0).any()
    found = mesh.find_simplex(queries, tolerance=1e-12)
    assert (found >= 0).all()
    # In the triangle of that side.
    corners = mesh.simplices[found]
    assert ((corners == mesh.boundary[:, :1]).any(axis=1)).all()
    assert ((corners == mesh.boundary[:, 1:]).any(axis=1)).all()


@pytest.mark.parametrize("seed", range(3))
def test_what_is_near_is_that_of_angles(seed: int) -> None:
    mesh = region(seed)
    rng = np.random.default_rng(seed + 10)
    queries = np.column_stack((rng.uniform(165, 195, 500), rng.uniform(46, 64, 500)))
    vectors = sphere.Delaunay(lonlat=queries).points
    # By dense places on the rim.
    a, b = mesh.points[mesh.boundary[:, 0]], mesh.points[mesh.boundary[:, 1]]
    steps = np.linspace(0, 1, 2000)[:, None, None]
    rim = (a + steps * (b - a)).reshape(-1, 3)
    rim /= np.linalg.norm(rim, axis=1, keepdims=True)
    away = np.degrees(np.arccos(np.minimum((vectors @ rim.T).max(axis=1), 1)))
    found = mesh.find_simplex(queries, tolerance=1.5)
    clear = np.abs(away - 1.5) > 1e-3
    expected = (mesh.find_simplex(queries) >= 0) | (away < 1.5)
    assert np.array_equal((found >= 0)[clear], expected[clear])


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.NaturalNeighbor, sphere.Nearest])
def test_values_near_the_rim_are_those_at_it(kind: Any) -> None:
    mesh = region(1)
    values = np.arange(float(mesh.npoints))
    rng = np.random.default_rng(0)
    queries = np.column_stack((rng.uniform(165, 195, 300), rng.uniform(46, 64, 300)))
    inside = mesh.find_simplex(queries) >= 0
    near = mesh.find_simplex(queries, tolerance=1.0) >= 0
    assert inside.sum() < near.sum() < len(queries)
    found = kind(mesh, values, extrapolate="nan", tolerance=1.0)(queries)
    nearest = kind(mesh, values, extrapolate="nearest")(queries)
    assert np.array_equal(found, np.where(near, nearest, np.nan), equal_nan=True)
    with pytest.raises(delone.InputError, match=rf"{(~near).sum()} of 300 queries are outside"):
        kind(mesh, values, extrapolate="raise", tolerance=1.0)(queries)
    assert kind(mesh, values, extrapolate="raise", tolerance=1.0)(queries[near]).shape == (
        near.sum(),
    )
    with pytest.raises(delone.InputError, match="tolerance must be"):
        kind(mesh, values, tolerance=-1)
