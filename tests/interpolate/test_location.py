"""locate, nearest and walk against their definitions."""

from __future__ import annotations

import threading
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from delone import ConstrainedDelaunay, Delaunay, datasets
from delone.errors import DtypeError, NonFiniteError, ShapeError
from delone.predicates import orient2d


@pytest.mark.parametrize("name", ["uniform", "grid", "circle", "near_collinear", "duplicates"])
def test_weights_are_those_of_a_mean(name: str) -> None:
    mesh = Delaunay(datasets.GENERATORS[name](200, seed=1))
    rng = np.random.default_rng(2)
    queries = mesh.min_bound + rng.random((300, 2)) * (mesh.max_bound - mesh.min_bound)
    place = mesh.locate(queries)
    assert np.array_equal(place.simplex, mesh.find_simplex(queries))
    inside = place.simplex >= 0
    weights = place.barycentric[inside]
    assert (weights >= 0).all()
    np.testing.assert_allclose(weights.sum(axis=1), 1, rtol=4e-16)
    means = np.einsum("kv,kvj->kj", weights, mesh.points[mesh.simplices[place.simplex[inside]]])
    size = np.abs(mesh.points).max()
    np.testing.assert_allclose(means, queries[inside], rtol=0, atol=1e-13 * size)
    assert np.array_equal(place.closest[inside], queries[inside])
    assert (place.beside[inside] == -1).all() and np.isnan(place.weights[inside]).all()


def test_weights_at_sites_are_exactly_one() -> None:
    mesh = Delaunay(datasets.tilted_grid(400))
    place = mesh.locate(mesh.points)
    best = place.barycentric.argmax(axis=1)
    rows = np.arange(mesh.npoints)
    assert np.array_equal(mesh.simplices[place.simplex, best], rows)
    assert (place.barycentric[rows, best] == 1).all()
    assert (np.sort(place.barycentric, axis=1)[:, :2] == 0).all()


def test_outside_the_nearest_point_of_the_hull() -> None:
    mesh = Delaunay(datasets.uniform(60, seed=4))
    queries = np.random.default_rng(5).random((80, 2)) * 4 - 1.5
    place = mesh.locate(queries)
    ring = mesh.points[mesh.hull].tolist()
    edges = list(zip(ring, ring[1:] + ring[:1], strict=True))
    for i in np.flatnonzero(place.simplex < 0):
        best = min(squared_distance(queries[i], u, v) for u, v in edges)
        gap = queries[i] - place.closest[i]
        assert float(gap @ gap) == pytest.approx(float(best), rel=1e-12)
        u, v = place.facet[i]
        assert {u, v} <= set(mesh.simplices[place.beside[i]].tolist())
        assert orient2d(mesh.points[u], mesh.points[v], queries[i]) < 0
        assert 0 <= place.weights[i, 1] <= 1


def squared_distance(q: Any, u: Any, v: Any) -> Fraction:
    (qx, qy), (ux, uy), (vx, vy) = ([Fraction(float(x)) for x in point] for point in (q, u, v))
    dx, dy = vx - ux, vy - uy
    s = ((qx - ux) * dx + (qy - uy) * dy) / (dx * dx + dy * dy)
    s = min(max(s, Fraction(0)), Fraction(1))
    return (qx - ux - s * dx) ** 2 + (qy - uy - s * dy) ** 2


def test_what_is_no_number_is_nowhere() -> None:
    mesh = Delaunay(datasets.uniform(50))
    place = mesh.locate([(np.nan, 0.5), (np.inf, 0.5)])
    assert place.simplex.tolist() == place.beside.tolist() == [-1, -1]
    assert np.isnan(place.barycentric).all() and np.isnan(place.closest).all()
    assert mesh.nearest([(np.nan, 0.5), (0.5, -np.inf)]).tolist() == [-1, -1]


@pytest.mark.parametrize("shape", [(2,), (0, 2), (3, 4, 2), (2, 0, 2)])
def test_any_leading_shape(shape: tuple[int, ...]) -> None:
    mesh = Delaunay(datasets.uniform(50))
    queries = np.random.default_rng(0).random(shape)
    place = mesh.locate(queries)
    assert place.simplex.shape == place.beside.shape == shape[:-1]
    assert place.barycentric.shape == (*shape[:-1], 3)
    assert place.closest.shape == place.facet.shape == shape
    assert mesh.nearest(queries).shape == shape[:-1]


@pytest.mark.parametrize("name", ["uniform", "grid", "duplicates", "integer_lattice"])
def test_nearest_is_the_nearest_and_the_first_of_equals(name: str) -> None:
    points = datasets.GENERATORS[name](150, seed=3)
    mesh = Delaunay(points)
    rng = np.random.default_rng(6)
    low, high = mesh.min_bound, mesh.max_bound
    queries = low - 0.3 * (high - low) + rng.random((120, 2)) * 1.6 * (high - low)
    # Halfway between points, where ties are.
    halves = (points[rng.integers(0, 150, 60)] + points[rng.integers(0, 150, 60)]) / 2
    queries = np.concatenate((queries, halves, points[:20]))
    exact = [tuple(map(Fraction, point)) for point in points.tolist()]
    for query, found in zip(queries.tolist(), mesh.nearest(queries).tolist(), strict=True):
        x, y = map(Fraction, query)
        distance = [(x - px) ** 2 + (y - py) ** 2 for px, py in exact]
        assert found == distance.index(min(distance))


def test_walk_meets_all_triangles_on_the_way() -> None:
    mesh = Delaunay(datasets.uniform(300, seed=7))
    a, b = (-0.1, 0.2), (1.1, 0.7)
    found = mesh.walk(a, b)
    line = mesh.points[mesh.simplices]
    sides = orient2d(np.array(a), np.array(b), line)
    crossed = (sides.min(axis=1) < 0) & (sides.max(axis=1) > 0)
    assert set(found.tolist()) == set(np.flatnonzero(crossed).tolist())
    assert (mesh.neighbors[found[:-1]] == found[1:, None]).any(axis=1).all()
    back = mesh.walk(b, a)
    assert np.array_equal(back, found[::-1])
    assert mesh.walk(a, a).size == 0
    assert mesh.walk((0.5, 0.5), (0.5, 0.5)).tolist() == [int(mesh.find_simplex((0.5, 0.5)))]


def with_holes(kind: str) -> Any:
    """A square with a square hole, and another that touches it in a corner; or a comb."""
    lattice = np.stack(np.meshgrid(np.arange(9.0), np.arange(9.0)), axis=-1).reshape(-1, 2)
    outline = [(0, 0), (8, 0), (8, 8), (0, 8)]
    holes = [[(2, 2), (4, 2), (4, 4), (2, 4)], [(4, 4), (6, 4), (6, 6), (4, 6)]]
    comb = [(0, 0), (8, 0), (8, 8), (6, 8), (6, 2), (5, 2), (5, 8), (3, 8), (3, 1), (1, 1), (0, 8)]
    rings = [comb] if kind.endswith("comb") else [outline, *holes]
    points = [(float(x), float(y)) for ring in rings for x, y in ring]
    points = list(dict.fromkeys(points))
    ends = [
        (points.index(a), points.index(b))
        for ring in rings
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True)
    ]
    seeds = [] if kind.endswith("comb") else [(3, 3.5), (5, 5.5)]
    if kind.startswith("mesh"):
        return delone.mesh((points, ends), holes=seeds, max_area=0.7)
    known = set(points)
    points += [point for point in map(tuple, lattice.tolist()) if point not in known]
    return ConstrainedDelaunay(points, ends, holes=seeds, boundary="outline")


KINDS = ["constrained", "constrained comb", "mesh", "mesh comb"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.sampled(2)
def test_location_with_holes(kind: str) -> None:
    mesh = with_holes(kind)
    rng = np.random.default_rng(8)
    queries = np.concatenate(
        (rng.random((300, 2)) * 10 - 1, rng.integers(-1, 20, (200, 2)) / 2, mesh.points)
    )
    corners = mesh.points[mesh.simplices]
    found = mesh.find_simplex(queries)
    place = mesh.locate(queries)
    assert np.array_equal(place.simplex, found)
    exact = [tuple(map(Fraction, point)) for point in mesh.points.tolist()]
    used = np.unique(mesh.simplices).tolist()
    for query, simplex, nearest in zip(queries, found, mesh.nearest(queries), strict=True):
        sides = [orient2d(corners[:, k], corners[:, (k + 1) % 3], query) >= 0 for k in range(3)]
        holders = np.flatnonzero(np.logical_and.reduce(sides))
        assert simplex == (holders[0] if len(holders) else -1)
        x, y = map(Fraction, query.tolist())
        distance = {v: (x - exact[v][0]) ** 2 + (y - exact[v][1]) ** 2 for v in used}
        assert distance[nearest] == min(distance.values())
        assert nearest == min(v for v in used if distance[v] == distance[nearest])
    # Beside: the nearest of all boundary edges.
    outside = np.flatnonzero(found < 0)
    tail, head = mesh.points[mesh.boundary].swapaxes(0, 1)
    way = head - tail
    for row in outside:
        share = ((queries[row] - tail) * way).sum(axis=1) / (way * way).sum(axis=1)
        near = tail + np.clip(share, 0, 1)[:, None] * way
        least = np.hypot(*(near - queries[row]).T).min()
        assert np.hypot(*(place.closest[row] - queries[row])) == pytest.approx(least, abs=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.sampled(2)
def test_walks_skip_holes(kind: str) -> None:
    mesh = with_holes(kind)
    rng = np.random.default_rng(9)
    ends = [*(rng.random((40, 2, 2)) * 10 - 1), *rng.integers(0, 17, (60, 2, 2)) / 2]
    corners = mesh.points[mesh.simplices]
    for a, b in ends:
        found = mesh.walk(a, b)
        if (a == b).all():
            assert found.tolist() == [t for t in [int(mesh.find_simplex(a))] if t >= 0]
            continue
        shares = {t: part for t in range(mesh.nsimplex) if (part := common(corners[t], a, b))}
        assert set(found.tolist()) <= set(shares)
        parts = [shares[t] for t in found.tolist()]
        assert parts == sorted(parts)
        # What is left out shares an edge, and its part, with one that is there.
        assert set(shares.values()) == set(parts)


def common(corners: Any, a: Any, b: Any) -> tuple[Fraction, Fraction] | None:
    """From where to where a segment is in a triangle, where that is more than a point."""
    low, high = Fraction(0), Fraction(1)
    points = [tuple(map(Fraction, corner.tolist())) for corner in corners]
    start, end = (tuple(map(Fraction, map(float, p))) for p in (a, b))
    for (ux, uy), (vx, vy) in zip(points, points[1:] + points[:1], strict=True):
        at = [(vx - ux) * (y - uy) - (vy - uy) * (x - ux) for x, y in (start, end)]
        if at[0] < 0 and at[1] < 0:
            return None
        if at[0] < 0 or at[1] < 0:
            cut = at[0] / (at[0] - at[1])
            low, high = (max(low, cut), high) if at[0] < 0 else (low, min(high, cut))
    return (low, high) if low < high else None


def test_nothing_is_near_no_triangle() -> None:
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
    mesh = ConstrainedDelaunay(square, ring, holes=[(0.5, 0.25)])
    assert mesh.nsimplex == 0
    assert mesh.nearest([(0, 0), (2, 2)]).tolist() == [-1, -1]
    assert mesh.find_simplex((0, 0)) == -1 and mesh.locate((0, 0)).simplex == -1
    assert mesh.walk((0, 0), (1, 1)).size == 0


def test_bad_input_is_refused() -> None:
    mesh = Delaunay(datasets.uniform(20))
    for method in (mesh.locate, mesh.nearest):
        with pytest.raises(ShapeError, match="xi"):
            method([(1, 2, 3)])
        with pytest.raises(DtypeError, match="xi"):
            method([(1j, 0)])
    for bad in ([(0, 0), (1, 1)], (1, 2, 3)):
        with pytest.raises(ShapeError):
            mesh.walk(bad, (0, 0))
    for bad in ((0.0, np.nan), (np.inf, 0)):
        with pytest.raises(NonFiniteError, match="b: "):
            mesh.walk((0, 0), bad)


def test_many_threads_may_ask_at_once() -> None:
    mesh = Delaunay(datasets.uniform(5000), workers=1)
    queries = np.random.default_rng(8).random((20_000, 2))
    found: list[Any] = []
    threads = [
        threading.Thread(target=lambda: found.append(mesh.locate(queries).barycentric))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    expected = Delaunay(mesh.points, workers=3).locate(queries).barycentric
    assert len(found) == 4
    for each in found:
        np.testing.assert_array_equal(each, expected)


@pytest.mark.parametrize("scale", [4.4e307, 4.5e307, 6e307, 8.9e307])
def test_the_nearest_point_of_an_outline_that_spans_the_range_of_doubles(scale: float) -> None:
    corners = np.array([(-2, -2), (2, -2), (2, 2), (0, -1), (-2, 2.0)])
    ring = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0)]
    queries = np.array([(0.2, 1), (0.9, 1.9), (2.01, 0), (-2, 2.01), (-0.5, 1)])
    plain = ConstrainedDelaunay(corners, ring, boundary="outline").locate(queries)
    vast = ConstrainedDelaunay(corners * scale, ring, boundary="outline").locate(queries * scale)
    np.testing.assert_allclose(vast.closest / scale, plain.closest, rtol=1e-14)


def nearest_exactly(corners: Any, query: Any) -> tuple[Fraction, list[Fraction]]:
    """Squared distance and nearest point of a closed chain."""
    best = []
    q = [Fraction(x) for x in query]
    for u, v in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        a, b = ([Fraction(x) for x in p] for p in (u.tolist(), v.tolist()))
        way = [y - x for x, y in zip(a, b, strict=True)]
        along = sum((z - x) * w for x, z, w in zip(a, q, way, strict=True))
        share = min(max(along / sum(w * w for w in way), Fraction(0)), Fraction(1))
        at = [x + share * w for x, w in zip(a, way, strict=True)]
        best.append((sum((z - x) ** 2 for x, z in zip(at, q, strict=True)), at))
    return min(best, key=lambda found: found[0])


@pytest.mark.parametrize("exponent", [0, 3, 8, 15, 16, 20, 100, 300])
def test_the_nearest_point_keeps_its_digits_far_away(exponent: int) -> None:
    rng = np.random.default_rng(exponent)
    mesh = Delaunay(rng.integers(-9, 10, (12, 2)).astype(np.float64))
    corners = mesh.points[mesh.hull]
    ways = np.roll(corners, -1, axis=0) - corners
    # Straight out from places on the edges, and anywhere.
    out = np.column_stack([ways[:, 1], -ways[:, 0]]) * 10.0**exponent
    queries = np.concatenate(
        [corners + 0.5 * ways + out, rng.normal(size=(40, 2)) * np.abs(out).max()]
    )
    queries = queries[mesh.find_simplex(queries) < 0]
    found = mesh.locate(queries).closest
    for query, point in zip(queries.tolist(), found, strict=True):
        _, right = nearest_exactly(corners, query)
        assert np.abs(point - np.array([float(x) for x in right])).max() <= 2e-11
