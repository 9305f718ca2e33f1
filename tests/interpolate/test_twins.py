"""Sites that all but coincide: weights are those of the definition, linear functions linear."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from delone import Delaunay
from delone.interpolate import NaturalNeighbor
from delone.predicates import orient2d
from delone.reference import natural_weights

KINDS = ["sibson", "laplace"]

SITES = np.array([(0.06, 0.3), (0.15, 0.86), (0.97, 0.85), (0.98, 0.02), (0.01, 0.57)])


def weights(points: Any, query: Any, kind: str) -> Any:
    table = NaturalNeighbor(points, kind=kind).weights_at(query)
    full = np.zeros(len(points))
    full[table.indices] = table.weights
    return full


def agree(points: Any, query: Any, kind: str) -> None:
    """Compare with the definition in fractions, where the query is strictly inside."""
    ring = points[Delaunay(points).hull]
    if (orient2d(ring, np.roll(ring, -1, axis=0), query) <= 0).any():
        return
    exact = natural_weights(points.tolist(), query.tolist(), kind=kind)
    wanted = [float(exact.get(row, 0)) for row in range(len(points))]
    found = weights(points, query, kind)
    np.testing.assert_allclose(found, wanted, atol=1e-12)
    np.testing.assert_allclose(found @ points, query, atol=1e-12 * np.abs(points).max())


@pytest.mark.parametrize("kind", KINDS)
def test_of_twins_by_one_unit_in_the_last_place(kind: str) -> None:
    points = np.vstack((SITES, np.nextafter(SITES[0], 1)))
    agree(points, np.array((0.68, 0.66)), kind)


@pytest.mark.parametrize("kind", KINDS)
@given(
    st.lists(
        st.tuples(
            st.floats(0, 2 * np.pi),
            st.floats(-16, -9).map(lambda x: 10.0**x),
            st.integers(0, 4),
        ),
        min_size=1,
        max_size=4,
    ),
    st.tuples(st.floats(0.05, 0.95), st.floats(0.05, 0.95)),
)
def test_of_twins_at_any_gap(
    kind: str, twins: list[tuple[float, float, int]], place: tuple[float, float]
) -> None:
    further = [
        np.nextafter(SITES[i], 1) + gap * np.array((np.cos(turn), np.sin(turn)))
        for turn, gap, i in twins
    ]
    points = np.unique(np.vstack((SITES, further)), axis=0)
    agree(points, np.array(place), kind)


@pytest.mark.parametrize("kind", KINDS)
@given(st.integers(-1074, -20), st.integers(-1000, 960), st.booleans())
# Squares times cosines of the needle between the twins are subnormal, its area is not.
@example(-277, -199, False)
def test_of_twins_far_closer_than_doubles_tell_elsewhere(
    kind: str, exponent: int, scale: int, upright: bool
) -> None:
    gap = np.ldexp(1.0, max(exponent, -1074 - scale))
    base = [(0, 0), (1, 0), (2, 0), (3, 0), (4, 0), (2, 1)]
    further = (2 if upright else 2 + gap, gap)
    points = np.unique(np.array([*base, further], dtype=float), axis=0)
    agree(np.ldexp(points, scale), np.ldexp((1.5, 0.5), scale), kind)


@pytest.mark.parametrize("kind", KINDS)
def test_rings_whose_ends_meet(kind: str) -> None:
    turn = np.linspace(0, 2 * np.pi, 17)
    ring = np.column_stack((np.cos(turn), np.sin(turn)))
    points = np.vstack([k * ring for k in (1, 2, 3)])
    queries = np.random.default_rng(0).uniform(-2, 2, (2000, 2))
    slope = np.array((1.0, -2.0))
    made = NaturalNeighbor(points, points @ slope, kind=kind)
    np.testing.assert_allclose(made(queries), queries @ slope, atol=1e-13)
    np.testing.assert_allclose(made.gradient(queries), np.tile(slope, (2000, 1)), atol=1e-10)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_beside_twins(kind: str) -> None:
    """By areas, twins share what one of them alone would have."""
    points = np.vstack((SITES, np.nextafter(SITES[0], 1)))
    values = np.array([1.0, -2.0, 0.5, 3.0, 1.5, 1.0])
    query = np.array((0.3, 0.4))
    single = NaturalNeighbor(SITES, values[:5], kind=kind)
    double = NaturalNeighbor(points, values, kind=kind)
    if kind == "sibson":
        np.testing.assert_allclose(double(query), single(query), rtol=1e-12)
        np.testing.assert_allclose(double.gradient(query), single.gradient(query), rtol=1e-9)
    step = 1e-5
    slopes = [(double(query + d) - double(query - d)) / (2 * step) for d in step * np.eye(2)]
    np.testing.assert_allclose(double.gradient(query), slopes, rtol=1e-6)
