"""Regular triangulations against the exact hull of the lifted points, and laws they obey."""

from __future__ import annotations

import itertools
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import Delaunay
from delone.errors import DegenerateInputError, NonFiniteError, ShapeError
from delone.regular import RegularTriangulation
from tiers import examples


def triangles(mesh: Any) -> set[frozenset[int]]:
    return {frozenset(row) for row in mesh.simplices.tolist()}


def lifted(points: Any, weights: Any) -> list[tuple[Fraction, Fraction, Fraction]]:
    """Points on the paraboloid, lowered by their weights."""
    found = []
    for (x, y), w in zip(np.asarray(points, float).tolist(), list(weights), strict=True):
        fx, fy = Fraction(x), Fraction(y)
        found.append((fx, fy, fx * fx + fy * fy - Fraction(float(w))))
    return found


def below(a: Any, b: Any, c: Any, d: Any) -> Fraction:
    """Positive where d lies below the plane of a, b, c, which are counter-clockwise."""
    rows = [[p[k] - d[k] for k in range(3)] for p in (a, b, c)]
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = rows
    return az * (bx * cy - by * cx) + bz * (cx * ay - cy * ax) + cz * (ax * by - ay * bx)


def turn(a: Any, b: Any, c: Any) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def perturbed(lifts: list[Any], bits: int) -> list[Any]:
    """The lifts with real infinitesimals: powers of one that is small beyond the data's gaps."""
    order = sorted(range(len(lifts)), key=lambda i: lifts[i][:2])
    eps = Fraction(1, 2**bits)
    found = list(lifts)
    for rank, i in enumerate(order):
        x, y, z = lifts[i]
        found[i] = (x, y, z - eps ** (2 * rank + 1))
    return found


def lower_hull(lifts: list[Any]) -> set[frozenset[int]]:
    """All triangles with no point below their plane."""
    found = set()
    for i, j, k in itertools.combinations(range(len(lifts)), 3):
        side = turn(lifts[i], lifts[j], lifts[k])
        if side == 0:
            continue
        a, b, c = (i, j, k) if side > 0 else (i, k, j)
        rest = (d for d in range(len(lifts)) if d not in (i, j, k))
        if all(below(lifts[a], lifts[b], lifts[c], lifts[d]) < 0 for d in rest):
            found.add(frozenset((i, j, k)))
    return found


def assert_is_the_lower_hull(points: Any, weights: Any, bits: int = 200) -> None:
    lifts = perturbed(lifted(points, weights), bits)
    expected = lower_hull(lifts)
    if not expected:
        with pytest.raises(DegenerateInputError):
            RegularTriangulation(points, weights)
        return
    mesh = RegularTriangulation(points, weights)
    assert triangles(mesh) == expected
    corners = {i for triangle in expected for i in triangle}
    assert mesh.hidden.tolist() == sorted(set(range(len(points))) - corners)


SITES = st.lists(
    st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=3, max_size=9, unique=True
)


@settings(max_examples=examples(24, deep=240), deadline=None)
@given(SITES, st.lists(st.integers(-3, 12), min_size=9, max_size=9))
def test_triangles_are_the_lower_side_of_the_lifted_hull(
    sites: list[tuple[int, int]], weights: list[int]
) -> None:
    assert_is_the_lower_hull(sites, weights[: len(sites)])


@pytest.mark.parametrize("seed", range(4))
def test_the_same_for_doubles_of_any_size(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scale = [1.0, 1e-150, 1e150, 1e-160][seed % 4]
    points = rng.random((9, 2)) * scale
    weights = rng.random(9) * 0.3 * scale * scale
    # No ties here: one infinitesimal below all gaps will do.
    assert_is_the_lower_hull(points, weights, bits=2500)


def test_without_weights_it_is_the_delaunay_triangulation() -> None:
    grid = np.stack(np.meshgrid(np.arange(9.0), np.arange(7.0)), axis=-1).reshape(-1, 2)
    for points in (grid, np.random.default_rng(1).random((2000, 2))):
        for weight in (0.0, 3.75):
            mesh = RegularTriangulation(points, np.full(len(points), weight))
            assert triangles(mesh) == triangles(Delaunay(points))
            assert len(mesh.hidden) == 0


def test_neighbours_are_mutual_and_every_edge_is_locally_regular() -> None:
    rng = np.random.default_rng(2)
    points, weights = rng.random((600, 2)), rng.random(600) * 5e-3
    mesh = RegularTriangulation(points, weights)
    assert 0 < len(mesh.hidden) < 300
    lifts = lifted(points, weights)
    edges = 0
    for t, row in enumerate(mesh.neighbors.tolist()):
        a, b, c = (lifts[v] for v in mesh.simplices[t])
        assert turn(a, b, c) > 0
        for k, other in enumerate(row):
            if other < 0:
                continue
            back = mesh.neighbors[other].tolist().index(t)
            assert set(np.delete(mesh.simplices[t], k)) == set(
                np.delete(mesh.simplices[other], back)
            )
            assert below(a, b, c, lifts[mesh.simplices[other][back]]) < 0
            edges += 1
    assert mesh.areas.sum() == pytest.approx(Delaunay(points).areas.sum())
    # Hidden points lie above the triangle that holds them.
    for i in mesh.hidden[:50].tolist():
        inside = [
            s
            for s in mesh.simplices.tolist()
            if all(turn(lifts[s[j]], lifts[s[(j + 1) % 3]], lifts[i]) >= 0 for j in range(3))
        ]
        assert inside and below(*(lifts[v] for v in inside[0]), lifts[i]) < 0


@pytest.mark.parametrize("seed", range(5))
def test_the_order_of_rows_does_not_matter(seed: int) -> None:
    rng = np.random.default_rng(3)
    points, weights = rng.integers(0, 15, (200, 2)).astype(float), rng.integers(0, 9, 200)
    points, first = np.unique(points, axis=0, return_index=True)
    weights = weights[first].astype(float)
    order = np.random.default_rng(seed).permutation(len(points))
    expected = triangles(RegularTriangulation(points, weights))
    shuffled = RegularTriangulation(points[order], weights[order])
    assert {frozenset(order[list(t)].tolist()) for t in triangles(shuffled)} == expected


def test_of_equal_points_the_heaviest_counts() -> None:
    points = [(0, 0), (4, 0), (0, 4), (1, 1), (1, 1), (1, 1), (1, 1)]
    mesh = RegularTriangulation(points, [0, 0, 0, 1, 2, 2, 0])
    assert triangles(mesh) == {frozenset(t) for t in [(0, 1, 4), (1, 2, 4), (0, 2, 4)]}
    assert mesh.hidden.tolist() == [3, 6]
    assert mesh.duplicate_of.tolist() == [0, 1, 2, 3, 4, 4, 6]
    assert repr(mesh) == "<RegularTriangulation of 7 points (1 duplicate, 2 hidden): 3 triangles>"


def test_sites_in_line_have_a_chain_without_the_hidden_ones() -> None:
    points = [(3, 6), (0, 0), (1, 2), (2, 4), (4, 8)]
    with pytest.raises(DegenerateInputError) as caught:
        RegularTriangulation(points, [0, 0, -5, 0, 0])
    assert caught.value.reason == "collinear"
    assert caught.value.chain.tolist() == [1, 3, 0, 4]
    with pytest.raises(DegenerateInputError) as caught:
        # The middle one of three lifts on one line is no corner.
        RegularTriangulation([(0, 0), (1, 0), (2, 0)], [0, -1, 0])
    assert caught.value.chain.tolist() == [0, 2]


def test_bad_weights_are_refused_by_name() -> None:
    points = [(0, 0), (1, 0), (0, 1)]
    with pytest.raises(ShapeError, match=r"\(3,\)"):
        RegularTriangulation(points, [1, 2])
    with pytest.raises(NonFiniteError) as caught:
        RegularTriangulation(points, [1, np.nan, np.inf])
    assert caught.value.rows.tolist() == [1, 2]
    with pytest.raises(NonFiniteError):
        RegularTriangulation([(0, 0), (np.nan, 0), (0, 1)], [1, 2, 3])


def test_it_pickles() -> None:
    mesh = RegularTriangulation([(0, 0), (4, 0), (0, 4), (1, 1)], [0, 0, 0, 1])
    again = pickle.loads(pickle.dumps(mesh))
    assert triangles(again) == triangles(mesh)
    assert again.weights.tolist() == [0, 0, 0, 1]
