"""Natural neighbours against areas and lengths of clipped Voronoi cells in fractions."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import Delaunay, datasets
from delone.errors import DegenerateInputError, InputError
from delone.interpolate import NaturalNeighbor
from delone.predicates import orient2d
from delone.reference import natural_weights

KINDS = ["sibson", "laplace"]


def compare(points: Any, queries: Any, kind: str) -> int:
    """Compare with the definition where the query is strictly inside; return how often."""
    mesh = Delaunay(points)
    table = NaturalNeighbor(mesh, kind=kind).weights_at(queries)
    ring = mesh.points[mesh.hull]
    count = 0
    for i, query in enumerate(queries):
        if (orient2d(ring, np.roll(ring, -1, axis=0), query) <= 0).any():
            continue
        exact = natural_weights(points.tolist(), query.tolist(), kind=kind)
        entries = slice(table.indptr[i], table.indptr[i + 1])
        found = dict(zip(table.indices[entries].tolist(), table.weights[entries], strict=True))
        for row in exact.keys() | found.keys():
            assert found.get(row, 0.0) == pytest.approx(float(exact.get(row, 0)), abs=1e-13)
        count += 1
    return count


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", ["uniform", "grid", "circle", "integer_lattice"])
@pytest.mark.sampled(3)
def test_weights_are_those_of_the_definition(name: str, kind: str) -> None:
    points = np.unique(datasets.GENERATORS[name](16, seed=2), axis=0)
    rng = np.random.default_rng(3)
    low, high = points.min(axis=0), points.max(axis=0)
    queries = low + rng.random((25, 2)) * (high - low)
    mesh = Delaunay(points)
    halves = points[mesh.edges].mean(axis=1)
    assert compare(points, np.concatenate((queries, halves, mesh.circumcenters)), kind) > 10


@given(
    st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=4, max_size=12, unique=True),
    st.tuples(st.integers(0, 12), st.integers(0, 12)),
    st.sampled_from(KINDS),
)
def test_on_lattices_where_everything_is_cocircular(
    sites: list[tuple[int, int]], thirds: tuple[int, int], kind: str
) -> None:
    points = np.array(sites, dtype=float)
    try:
        compare(points, np.array([thirds]) / 3, kind)
    except DegenerateInputError:
        return


def test_the_definition_by_hand() -> None:
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    assert natural_weights(square, (1, 1)) == dict.fromkeys(range(4), Fraction(1, 4))
    assert natural_weights(square, (2, 2)) == {2: Fraction(1)}
    for bad in ((1, 0), (3, 3)):
        with pytest.raises(InputError, match="inside"):
            natural_weights(square, bad)
    with pytest.raises(InputError, match="kind"):
        natural_weights(square, (1, 1), kind="farin")


@pytest.mark.parametrize("kind", [*KINDS, "sibson1", "farin"])
def test_on_hull_edges_the_two_ends_count(kind: str) -> None:
    mesh = Delaunay(datasets.uniform(60, seed=4))
    u, v = mesh.convex_hull.T
    some = np.array([(0.25, 0.75)])
    queries = some[:, :1] * mesh.points[u] + some[:, 1:] * mesh.points[v]
    queries = queries[mesh.find_simplex(queries) >= 0]
    square = Delaunay([(0, 0), (4, 0), (4, 4), (0, 4), (2, 3)])
    made = NaturalNeighbor(square, [0.0, 4.0, 8.0, 4.0, 5.0], kind=kind)
    np.testing.assert_allclose(made([(1, 0), (4, 1), (3, 4)]), [1, 5, 7], rtol=1e-12)
    values = np.random.default_rng(5).random(60)
    assert np.isfinite(NaturalNeighbor(mesh, values, kind=kind)(queries)).all()


@pytest.mark.parametrize("kind", ["sibson1", "farin"])
def test_with_gradients_round_functions_are_reproduced(kind: str) -> None:
    points = datasets.uniform(150, seed=6)
    values = ((points - 0.4) ** 2).sum(axis=1)
    made = NaturalNeighbor(points, values, kind=kind, extrapolate="raise")
    queries = 0.2 + 0.6 * np.random.default_rng(7).random((100, 2))
    np.testing.assert_allclose(made(queries), ((queries - 0.4) ** 2).sum(axis=1), atol=1e-11)
    some = points[:10]
    np.testing.assert_allclose(made.gradient(some), 2 * (some - 0.4), atol=1e-9)


def test_farin_reproduces_all_quadratic_functions() -> None:
    points = datasets.uniform(150, seed=8)
    x, y = points.T
    made = NaturalNeighbor(points, x * y - y * y, kind="farin")
    qx, qy = queries = 0.2 + 0.6 * np.random.default_rng(9).random((2, 100))
    np.testing.assert_allclose(made(queries.T), qx * qy - qy * qy, atol=1e-11)


@pytest.mark.parametrize("kind", [*KINDS, "sibson1", "farin"])
def test_gradients_are_derivatives(kind: str) -> None:
    points = datasets.uniform(100, seed=10)
    values = np.sin(5 * points[:, 0]) * points[:, 1]
    made = NaturalNeighbor(points, values, kind=kind)
    queries = 0.2 + 0.6 * np.random.default_rng(11).random((200, 2))
    step = 1e-6
    slopes = [(made(queries + d) - made(queries - d)) / (2 * step) for d in step * np.eye(2)]
    if kind == "laplace":  # continuous only: a few differences go over a kink
        off = np.abs(made.gradient(queries) - np.transpose(slopes)).max(axis=1)
        assert np.quantile(off, 0.9) < 1e-5
    else:
        np.testing.assert_allclose(made.gradient(queries), np.transpose(slopes), atol=1e-5)


@pytest.mark.parametrize("kind", ["sibson1", "farin"])
def test_smooth_at_sites(kind: str) -> None:
    points = datasets.uniform(80, seed=12)
    made = NaturalNeighbor(points, np.cos(4 * points[:, 0]) + points[:, 1], kind=kind)
    inner = points[(np.abs(points - 0.5) < 0.3).all(axis=1)]
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    for site in inner[:10]:
        around = site + 1e-7 * np.column_stack((np.cos(turn), np.sin(turn)))
        slopes = made.gradient(around)
        np.testing.assert_allclose(slopes, np.tile(made.gradient(site), (12, 1)), atol=1e-4)


@pytest.mark.parametrize("extrapolate", ["nan", "linear"])
@pytest.mark.parametrize("kind", KINDS)
def test_kinds_without_gradients_say_which_have_them(kind: str, extrapolate: str) -> None:
    points = datasets.uniform(30, seed=1)
    found = NaturalNeighbor(points, points[:, 0], kind=kind, extrapolate=extrapolate)
    with pytest.raises(InputError, match=f"kind='{kind}'.*'sibson1' or kind='farin'"):
        found.site_gradients()
    with pytest.raises(InputError, match=f"kind='{kind}'"):
        found.site_gradients(values=points[:, 1])
