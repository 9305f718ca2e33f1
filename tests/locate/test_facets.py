"""The facet of the boundary that is nearest to a query outside is the nearest one of fractions."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import ConstrainedDelaunay, DegenerateInputError, Delaunay
from rational import exact, from_segment

if TYPE_CHECKING:
    from numpy.typing import NDArray

CASE = Path(__file__).parents[1] / "corpus" / "corner-one-ulp-from-a-query.json"


def check(mesh: Delaunay | ConstrainedDelaunay, queries: Any) -> None:
    """The facet has the least distance, and its weights are those of the nearest point."""
    points, xi = exact(mesh.points), exact(queries)
    found = mesh.locate(queries)
    for q, simplex, facet, weights in zip(
        xi, found.simplex, found.facet.tolist(), found.weights.tolist(), strict=True
    ):
        if simplex >= 0:
            continue
        least = min(from_segment(q, points[u], points[v])[0] for u, v in mesh.boundary.tolist())
        u, v = (points[vertex] for vertex in facet)
        away, foot = from_segment(q, u, v)
        assert away == least
        axis = 0 if abs(v[0] - u[0]) > abs(v[1] - u[1]) else 1
        share = (foot[axis] - u[axis]) / (v[axis] - u[axis])
        assert abs(Fraction(weights[1]) - share) < Fraction(1, 10**11)


def beside(rng: np.random.Generator, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Queries a few units in the last place from points, and far from them."""
    near = points[rng.integers(len(points), size=20)]
    for _ in range(3):
        near = np.where(rng.random(near.shape) < 0.5, np.nextafter(near, 1e308), near)
        near = np.where(rng.random(near.shape) < 0.5, np.nextafter(near, -1e308), near)
    return np.vstack((near, rng.uniform(-3, 4, (10, 2))))


def test_one_ulp_beyond_a_corner() -> None:
    mesh = Delaunay(json.loads(CASE.read_text(encoding="utf-8"))["points"])
    check(mesh, [(0.9298816563209579, 0.6124784919414578)])


@pytest.mark.parametrize(
    ("points", "query"),
    [
        ([(3, 2), (1, 3), (2, 3), (1, 0)], (0.9999999999999999, 5e-324)),
        ([(-2e300, 3e300), (-2e300, -1e300), (0, -2e300)], (-2.0000000000000004e300, -1e300)),
        ([(1.5e308, -7.5e307), (7.5e307, -7.5e307), (-5e-324, 1e-323), (0, -5e-324)], (2e84, 0.0)),
    ],
)
def test_ends_of_the_range(points: list[tuple[float, float]], query: tuple[float, float]) -> None:
    check(Delaunay(points), [query])


@given(st.integers(0, 2**32 - 1), st.integers(0, 2))
def test_of_a_convex_hull(seed: int, kind: int) -> None:
    rng = np.random.default_rng(seed)
    points = (
        rng.random((12, 2)),
        rng.integers(-3, 4, (15, 2)).astype(float),
        np.ldexp(rng.normal(size=(9, 2)), rng.integers(-300, 300, (9, 2))),
    )[kind]
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    lattice = rng.integers(-6, 7, (10, 2)).astype(float)
    check(mesh, np.vstack((beside(rng, points), lattice)))


@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 1.0, 1e6]))
def test_of_a_boundary_that_is_not_convex(seed: int, far: float) -> None:
    """A square with a notch and a hole; queries in both, outside, and far away."""
    rng = np.random.default_rng(seed)
    ring = np.array([(0, 0), (4, 0), (2, 2), (4, 4), (0, 4)]) + rng.uniform(-0.1, 0.1, (5, 2))
    hole = np.array([(0.5, 1.5), (1.5, 1.5), (1.5, 2.5), (0.5, 2.5)])
    points = np.vstack((ring, hole))
    segments = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0), (5, 6), (6, 7), (7, 8), (8, 5)]
    mesh = ConstrainedDelaunay(points, segments, boundary="outline", holes=[(1.0, 2.0)])
    inside = rng.uniform(0.5, 2.5, (10, 2))
    middle = np.array([(1.0, 2.0), (1.25, 2.0), (1.0, 1.75)])
    check(mesh, np.vstack((beside(rng, points) + far, inside, middle)))
