"""Weights in tetrahedra, and shares on faces of the hull, against fractions: to a few roundings."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import DegenerateInputError, Delaunay
from rational import cross, dot, exact, from_triangle, minus, ulps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from rational import Vector

    Floats = NDArray[np.float64]

# Units in the last place of each weight by itself, however small it is; shares that are smaller
# than a rounding of the largest may have fewer digits.
WORST = 64


def volume(a: Vector, b: Vector, c: Vector, d: Vector) -> Fraction:
    return dot(minus(b, a), cross(minus(c, a), minus(d, a)))


def weights(q: Vector, corners: Sequence[Vector]) -> list[Fraction]:
    whole = volume(*corners)
    return [
        volume(*(q if i == k else corner for i, corner in enumerate(corners))) / whole
        for k in range(4)
    ]


def shares(q: Vector, corners: Sequence[Vector]) -> list[Fraction]:
    """Those of the nearest point of a triangle."""
    _, foot = from_triangle(q, corners)
    e, f, u = (minus(p, corners[0]) for p in (corners[1], corners[2], foot))
    ee, ef, ff, ue, uf = dot(e, e), dot(e, f), dot(f, f), dot(u, e), dot(u, f)
    whole = ee * ff - ef * ef
    v, w = (ff * ue - ef * uf) / whole, (ee * uf - ef * ue) / whole
    return [1 - v - w, v, w]


def twins(points: Floats, rng: np.random.Generator) -> Floats:
    """The points, and some again a unit in the last place away."""
    others = points[rng.integers(len(points), size=4)]
    axes = rng.integers(3, size=4)
    others[range(4), axes] = np.nextafter(others[range(4), axes], rng.choice([-9, 9], 4))
    return np.unique(np.vstack((points, others)), axis=0)


LATTICE = np.array(list(product(range(3), repeat=3)), dtype=float)


def sets(rng: np.random.Generator) -> dict[str, Floats]:
    tilted = rng.random((15, 3))
    tilted[:, 2] = tilted[:, 0] + 1e-14 * tilted[:, 2]
    return {
        "lattice": LATTICE,
        "lattice with twins": twins(LATTICE, rng),
        "scattered with twins": twins(rng.random((15, 3)), rng),
        "needles": rng.random((15, 3)) * (1, 1e-9, 1e-9),
        "sheet": rng.random((15, 3)) * (1, 1, 1e-12),
        "tilted sheet": tilted,
        "slivers": LATTICE + 1e-15 * rng.integers(-2, 3, LATTICE.shape),
        "far": np.array((4e6, 5e5, 1e3)) + rng.random((15, 3)),
    }


@pytest.mark.parametrize("name", sorted(sets(np.random.default_rng(0))))
@given(seed=st.integers(0, 2**32 - 1), scale=st.integers(-900, 900))
@pytest.mark.sampled(3)
def test_each_weight_has_its_digits(name: str, seed: int, scale: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.ldexp(sets(rng)[name], scale)
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    low, high = points.min(axis=0), points.max(axis=0)
    inside = rng.dirichlet((1, 1, 1, 1), 6)
    simplex = points[mesh.simplices[rng.integers(mesh.nsimplex, size=6)]]
    beside = low + (high - low) * rng.uniform(-2, 3, (6, 3))
    queries = np.vstack(((inside[..., None] * simplex).sum(axis=1), beside))
    place, sites = mesh.locate(queries), exact(mesh.points)
    for row, q in enumerate(exact(queries)):
        if place.simplex[row] >= 0:
            corners = [sites[v] for v in mesh.simplices[place.simplex[row]]]
            found, wanted = place.barycentric[row], weights(q, corners)
        else:
            corners = [sites[v] for v in place.facet[row]]
            found, wanted = place.weights[row], shares(q, corners)
        for one, other in zip(found.tolist(), wanted, strict=True):
            lost = abs(Fraction(one) - other)
            small = place.simplex[row] < 0 and lost <= Fraction(1, 2**53)
            assert small or ((one == 0) if other == 0 else ulps(one, other) <= WORST)
