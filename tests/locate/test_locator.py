"""The core's locator against definitions in exact numbers, on triangulations of every kind."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, Dynamic, _core
from delone.errors import DegenerateInputError, ShapeError
from delone.interpolate import Linear
from delone.predicates import orient2d
from tiers import seeds

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

SEEDS = range(6)


def flipped(mesh: Delaunay, flips: int, seed: int) -> Indices:
    """Triangles after flips of random edges in strictly convex quadrilaterals: not Delaunay."""
    rng = np.random.default_rng(seed)
    points, triangles = mesh.points, mesh.simplices.copy()
    for _ in range(flips):
        neighbors = _core.neighbors2(triangles, len(points))
        t, k = int(rng.integers(len(triangles))), int(rng.integers(3))
        s = int(neighbors[t, k])
        if s < 0:
            continue
        a, b, c = (int(triangles[t, (k + i) % 3]) for i in range(3))
        d = int(triangles[s, np.flatnonzero(neighbors[s] == t)[0]])
        turns = orient2d(points[[a, a]], points[[b, d]], points[[d, c]])
        if (turns > 0).all():
            triangles[t], triangles[s] = (a, b, d), (a, d, c)
    return triangles


def locator(points: Floats, triangles: Indices) -> _core.Locator2:
    return _core.Locator2(points, triangles, _core.neighbors2(triangles, len(points)))


def cases(seed: int, offset: float = 0) -> list[tuple[Floats, Indices, Floats]]:
    """Points, triangles and queries: on a lattice and anywhere, Delaunay and not."""
    rng = np.random.default_rng(seed)
    lattice = rng.integers(0, 7, (30, 2)).astype(float)
    uniform = rng.random((50, 2))
    between = np.concatenate((uniform[:20], (uniform[:20] + uniform[20:40]) / 2))
    queries = [rng.integers(-2, 16, (60, 2)) / 2, np.concatenate((between, rng.random((20, 2))))]
    found = []
    for near, asked in zip((lattice, uniform), queries, strict=True):
        points = near + offset
        mesh = Delaunay(points)
        for triangles in (mesh.simplices.copy(), flipped(mesh, 80, seed)):
            found.append((points, triangles, asked + offset))
    return found


def first_holders(points: Floats, triangles: Indices, queries: Floats) -> list[int]:
    """The first triangle whose closed area has each query."""
    corners = points[triangles]
    found = []
    for query in queries:
        sides = [orient2d(corners[:, k], corners[:, (k + 1) % 3], query) >= 0 for k in range(3)]
        rows = np.flatnonzero(np.logical_and.reduce(sides))
        found.append(int(rows[0]) if len(rows) else -1)
    return found


@pytest.mark.parametrize("seed", SEEDS)
def test_the_first_holder_on_any_tiling(seed: int) -> None:
    for points, triangles, queries in cases(seed):
        expected = first_holders(points, triangles, queries)
        index = locator(points, triangles)
        for workers in (1, 2):
            assert index.find(queries, workers).tolist() == expected
        assert [index.find(q[None].copy(), 1)[0] for q in queries] == expected
        neighbors = _core.neighbors2(triangles, len(points))
        assert _core.find_simplex2(points, triangles, neighbors, queries, 1).tolist() == expected


@pytest.mark.parametrize("seed", SEEDS)
def test_holes_hold_nothing_and_hide_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for points, triangles, queries in cases(seed):
        some = np.ascontiguousarray(triangles[rng.random(len(triangles)) < 0.6])
        expected = first_holders(points, some, queries)
        assert locator(points, some).find(queries, 1).tolist() == expected


def inside(points: Floats, triangle: Any, a: Any, b: Any) -> tuple[Fraction, Fraction] | None:
    """The part of the segment in a closed triangle, where that is more than a point."""
    low, high = Fraction(0), Fraction(1)
    p, q = ([Fraction(x) for x in end] for end in (a, b))
    corners = [[Fraction(x) for x in points[v]] for v in triangle]
    for u, v in zip(corners, corners[1:] + corners[:1], strict=True):
        way = (v[0] - u[0], v[1] - u[1])
        at_a, at_b = (way[0] * (x[1] - u[1]) - way[1] * (x[0] - u[0]) for x in (p, q))
        if at_a < 0 and at_b < 0:
            return None
        if at_a < 0:
            low = max(low, at_a / (at_a - at_b))
        elif at_b < 0:
            high = min(high, at_a / (at_a - at_b))
    return (low, high) if low < high else None


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.sampled(3)
def test_segments_meet_what_they_cross_in_order(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for points, triangles, queries in cases(seed):
        index = locator(points, triangles)
        for a, b in queries[rng.integers(len(queries), size=(40, 2))]:
            if (a == b).all():
                continue
            met = index.along(a.copy(), b.copy()).tolist()
            each = ((t, inside(points, triangles[t], a, b)) for t in range(len(triangles)))
            parts = {t: part for t, part in each if part is not None}
            assert [parts[t] for t in met] == sorted(set(parts.values()))
            for t in met:
                beside = [s for s, part in parts.items() if part == parts[t]]
                middles = points[triangles[beside]].mean(axis=1)
                sides = (b - a)[0] * (middles - a)[:, 1] - (b - a)[1] * (middles - a)[:, 0]
                assert t == beside[int(np.argmax(sides))]


def test_a_segment_of_no_length_is_a_query() -> None:
    mesh = Delaunay([(0, 0), (1, 0), (0, 1), (1, 1)])
    index = locator(mesh.points, mesh.simplices)
    for query in np.array([(0.5, 0.5), (0, 0), (0.25, 0.5), (2, 2)], dtype=float):
        found = index.find(query[None].copy(), 1).tolist()
        assert index.along(query, query).tolist() == [t for t in found if t >= 0]


@pytest.mark.parametrize("scale", [1.0, 2.0**-1060, 2.0**1000])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_nearest_vertex(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 9, (40, 2)).astype(np.float64) * scale
    queries = rng.integers(-6, 26, (80, 2)).astype(np.float64) / 2 * scale
    found = locator(points, Delaunay(points).simplices).nearest(queries, 1)
    exact = [[Fraction(x) for x in p] for p in points]
    for query, vertex in zip(queries, found, strict=True):
        x, y = (Fraction(c) for c in query)
        distances = [(p[0] - x) ** 2 + (p[1] - y) ** 2 for p in exact]
        assert vertex == distances.index(min(distances))


def wheel(kind: str, count: int) -> Floats:
    """A vertex with very many neighbors, or a circle with very many vertices."""
    angle = np.arange(count) * 2 * np.pi / count
    rim = np.column_stack((np.cos(angle), np.sin(angle)))
    if kind == "hub":
        return np.concatenate(([(0.0, 0.0)], rim * (1 + 1e-9 * np.sin(7 * angle)[:, None])))
    if kind == "parabola":
        x = np.arange(-count // 2, count // 2, dtype=np.float64)
        return np.concatenate(([(0.0, 2.0 * count * count)], np.column_stack((x, x * x))))
    # Primitive triples: all at distance 1105 * 5 * 29 from the origin, exactly.
    radius = 1105 * 5 * 29
    x = np.arange(radius + 1)
    y = np.sqrt(radius**2 - x**2).round()
    on = x**2 + y**2 == radius**2
    quarter = np.column_stack((x, y))[on]
    return np.unique(
        np.concatenate([quarter * s for s in ((1, 1), (1, -1), (-1, 1), (-1, -1))]), axis=0
    )


@pytest.mark.parametrize("calls", ["one", "many"])
@pytest.mark.parametrize("kind", ["hub", "parabola", "circle"])
@pytest.mark.sampled(3)
def test_the_nearest_vertex_beside_hubs(kind: str, calls: str) -> None:
    points = wheel(kind, 300)[np.random.default_rng(0).permutation(len(wheel(kind, 300)))]
    rng = np.random.default_rng(1)
    low, high = points.min(axis=0), points.max(axis=0)
    anywhere = low - 0.2 * (high - low) + rng.random((60, 2)) * 1.4 * (high - low)
    pairs = points[rng.integers(len(points), size=(20, 2))].mean(axis=1)
    queries = np.concatenate((anywhere, points[::7], pairs, [(0.0, 0.0)], anywhere * 1e-3))
    index = locator(points, Delaunay(points).simplices)
    if calls == "one":
        found = index.nearest(queries, 1)
    else:
        found = np.concatenate([index.nearest(query[None].copy(), 1) for query in queries])
    exact = [[Fraction(x) for x in p] for p in points.tolist()]
    for query, vertex in zip(queries.tolist(), found.tolist(), strict=True):
        x, y = (Fraction(c) for c in query)
        distances = [(p[0] - x) ** 2 + (p[1] - y) ** 2 for p in exact]
        assert vertex == distances.index(min(distances))


@pytest.mark.parametrize("seed", SEEDS)
def test_weights_and_nearest_points(seed: int) -> None:
    for points, triangles, queries in cases(seed, 5_000_000):
        index = locator(points, triangles)
        place = index.locate(queries, 2)
        triangle, weights, beside = place.simplex, place.weights, place.beside
        edge, along = place.edge, place.along
        assert np.array_equal(triangle, index.find(queries, 1))
        held = triangle >= 0
        corners = points[triangles[triangle[held]]]
        assert (weights[held] >= 0).all()
        assert np.abs(weights[held].sum(axis=1) - 1).max() <= 3e-16
        back = ((corners - queries[held, None]) * weights[held, :, None]).sum(axis=1)
        assert np.abs(back).max() < 1e-14
        at_site = (corners == queries[held, None]).all(axis=2)
        assert np.array_equal(weights[held] == 1, at_site)
        assert (
            (beside[held] == -1).all() and (edge[held] == -1).all() and np.isnan(along[held]).all()
        )
        assert np.isnan(weights[~held]).all()
        hull = points[Delaunay(points).hull]
        for query, (u, v), share in zip(queries[~held], edge[~held], along[~held], strict=True):
            assert 0 <= share <= 1
            distance = np.hypot(*(points[u] + share * (points[v] - points[u]) - query))
            assert distance == pytest.approx(to_polygon(hull, query), abs=1e-8)


def to_polygon(corners: Floats, query: Floats) -> float:
    """The distance to the nearest point of a closed chain."""
    ways = np.roll(corners, -1, axis=0) - corners
    share = ((query - corners) * ways).sum(axis=1) / (ways**2).sum(axis=1)
    nearest = corners + np.clip(share, 0, 1)[:, None] * ways
    return float(np.hypot(*(nearest - query).T).min())


def test_what_is_not_finite_is_nowhere() -> None:
    mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
    index = locator(mesh.points, mesh.simplices)
    bad = np.array([(np.nan, 0), (0, np.inf)])
    assert index.find(bad, 1).tolist() == index.nearest(bad, 1).tolist() == [-1, -1]
    place = index.locate(bad, 1)
    assert place.simplex.tolist() == place.beside.tolist() == [-1, -1]
    assert np.isnan(place.weights).all() and np.isnan(place.along).all()
    assert (place.edge == -1).all()
    with pytest.raises(ShapeError, match="must be finite"):
        index.along(bad[0], bad[1])


def test_arrays_that_contradict_themselves_are_refused() -> None:
    points = np.zeros((3, 2))
    row = np.array([[0, 1, 2]], dtype=np.int32)
    outside = np.full((1, 3), -1, dtype=np.int32)
    with pytest.raises(ShapeError, match="simplices"):
        _core.Locator2(points, row + 1, outside)
    with pytest.raises(ShapeError, match="neighbors"):
        _core.Locator2(points, row, row + 7)
    with pytest.raises(ShapeError, match="length"):
        _core.Locator2(points, row, outside[:0])


def test_nothing_holds_nothing() -> None:
    none = np.zeros((0, 3), dtype=np.int32)
    index = _core.Locator2(np.zeros((0, 2)), none, none)
    assert index.find(np.zeros((5, 2)), 1).tolist() == [-1] * 5
    assert index.along(np.zeros(2), np.ones(2)).tolist() == []


def test_the_arrays_outlive_their_names() -> None:
    mesh = Delaunay(np.random.default_rng(0).random((1000, 2)))
    queries = np.random.default_rng(1).random((1000, 2))
    expected = mesh.find_simplex(queries)
    index = locator(mesh.points.copy(), mesh.simplices.copy())
    del mesh
    assert np.array_equal(index.find(queries, 1), expected)


@pytest.mark.parametrize("order", ["random", "raster", "clusters"])
def test_order_and_workers_do_not_show(order: str) -> None:
    rng = np.random.default_rng(4)
    points = rng.random((5000, 2))
    queries = rng.random((40_000, 2))
    if order == "raster":
        steps = np.arange(200) / 199
        queries = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    elif order == "clusters":  # Deeper than one level of the curve, and some far away.
        queries = rng.random((40_000, 2)) * 1e-9 + points[rng.integers(3, size=40_000)]
        queries[::100] *= 1e6
    index = locator(points, Delaunay(points).simplices)
    found = index.find(queries, 1)
    assert np.array_equal(index.find(queries, 3), found)
    some = rng.permutation(len(queries))[:500]
    assert [index.find(queries[i : i + 1], 1)[0] for i in some] == found[some].tolist()


class TestWeightsOnEdges:
    """Weights where one axis is larger than the other by up to all powers of two that exist."""

    EXPONENTS = (-1074, -1050, -1022, -600, -300, 0, 300, 600, 900, 1015)

    def test_an_edge_that_is_tiny_beside_its_coordinates(self) -> None:
        points = [(1.7e308, 5e-324), (1e300, 2.2250738585072014e-308), (1.7e308, -5e-324)]
        middle = [(1.7e308, -0.0)]
        mesh = Delaunay(points)
        found = mesh.locate(middle)
        weights = dict(zip(mesh.simplices[found.simplex[0]], found.barycentric[0], strict=True))
        assert weights == {0: 0.5, 1: 0.0, 2: 0.5}
        assert Linear(points, [1.0, 5.0, 3.0])(middle) == 2.0
        assert Dynamic(points).interpolate(middle, [1.0, 5.0, 3.0]) == 2.0

    @pytest.mark.parametrize("dimension", [2, 3])
    @pytest.mark.parametrize("seed", seeds(2, deep=8))
    def test_shares_of_an_edge(self, dimension: int, seed: int) -> None:
        rng = np.random.default_rng(seed)

        def number(most: int) -> Fraction:
            exponent = int(rng.choice(self.EXPONENTS))
            return int(rng.integers(-most, most + 1)) * Fraction(2) ** exponent

        judged = 0
        for _ in range(1500):
            place, step = ([number(most) for _ in range(dimension)] for most in (15, 3))
            before, after = (int(n) for n in rng.integers(1, 8, 2))
            ends = [
                [x - before * s for x, s in zip(place, step, strict=True)],
                [x + after * s for x, s in zip(place, step, strict=True)],
            ]
            rest = [[number(15) for _ in range(dimension)] for _ in range(dimension - 1)]
            rows = [[float(x) for x in row] for row in (*ends, *rest, place)]
            if [[Fraction(x) for x in row] for row in rows[:2]] != ends or not any(step):
                continue
            try:
                mesh = Delaunay(rows[:-1])
            except DegenerateInputError:
                continue
            found = mesh.locate(rows[-1:])
            right = {0: Fraction(after, before + after), 1: Fraction(before, before + after)}
            corners = mesh.simplices[found.simplex[0]].tolist()
            for vertex, weight in zip(corners, found.barycentric[0].tolist(), strict=True):
                assert abs(Fraction(weight) - right.get(vertex, 0)) <= Fraction(2) ** -51
            judged += 1
        assert judged > 20
