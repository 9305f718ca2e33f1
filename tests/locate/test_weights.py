"""The core's interpolation weights against their definitions in exact numbers."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import Delaunay, _core
from rational import Vector, area, exact

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

KINDS = ["sibson", "laplace", "sibson1", "farin"]


def locator(points: Floats) -> tuple[Delaunay, _core.Locator2]:
    mesh = Delaunay(points)
    return mesh, _core.Locator2(mesh.points, mesh.simplices, mesh.neighbors)


def nearer(cell: list[Vector], a: Vector, b: Vector) -> list[Vector]:
    """The part of a convex polygon that is nearer to `a` than to `b`."""

    def excess(p: Vector) -> Fraction:
        to_a, to_b = ((p[0] - s[0]) ** 2 + (p[1] - s[1]) ** 2 for s in (a, b))
        return to_a - to_b

    part = []
    for p, q in zip(cell, cell[1:] + cell[:1], strict=True):
        at_p, at_q = excess(p), excess(q)
        if at_p <= 0:
            part.append(p)
        if at_p * at_q < 0:
            t = at_p / (at_p - at_q)
            part.append((p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])))
    return part


def sibson(points: Floats, query: Floats) -> list[Fraction]:
    """Shares of the query's Voronoi cell that belonged to each site, by clipping."""
    *sites, q = exact([*points, query])
    far = 10**40 * (1 + max(abs(x) for p in sites for x in p))
    cell = [(-far, -far), (far, -far), (far, far), (-far, far)]
    for site in sites:
        cell = nearer(cell, q, site)
    taken = []
    for site in sites:
        part = cell
        for other in sites:
            if other != site:
                part = nearer(part, site, other)
        taken.append(area(part))
    return [a / area(cell) for a in taken]


def point_sets() -> dict[str, Floats]:
    rng = np.random.default_rng(5)
    lattice = np.unique(rng.integers(0, 5, (16, 2)), axis=0).astype(float)
    return {
        "anywhere": rng.random((14, 2)),
        "lattice": lattice,
        "map": rng.random((14, 2)) * 100 + (500_000, 5_000_000),
        "thin": rng.random((14, 2)) * (1, 1e-6),
        "tiny": lattice * 2.0**-1000,
        "huge": lattice * 2.0**400,
    }


@pytest.mark.parametrize("name", sorted(point_sets()))
@pytest.mark.sampled(3)
def test_sibson_weights_are_areas(name: str) -> None:
    points = point_sets()[name]
    mesh, index = locator(points)
    rng = np.random.default_rng(6)
    shares = rng.dirichlet((1, 1, 1), 12)
    corners = points[mesh.simplices[rng.integers(mesh.nsimplex, size=12)]]
    inner = mesh.edges[~np.isin(mesh.edges, mesh.hull).all(axis=1)][:6]
    middles = points[inner].sum(axis=1) / 2
    queries = np.concatenate(((corners * shares[..., None]).sum(axis=1), middles))
    table = index.natural("sibson", queries, None, 1)
    indptr, indices, weights, triangle = table.indptr, table.indices, table.weights, table.simplex
    assert table.slopes is None
    for i in np.flatnonzero(triangle >= 0):
        row = slice(indptr[i], indptr[i + 1])
        assert (weights[row] >= 0).all()
        found = np.zeros(len(points))
        found[indices[row]] = weights[row]
        expected = sibson(points, queries[i])
        errors = [abs(Fraction(w) - e) for w, e in zip(found, expected, strict=True)]
        assert max(errors) < 1e-13, queries[i]


@pytest.mark.parametrize("kind", KINDS)
def test_weights_on_the_hull_and_at_sites(kind: str) -> None:
    rng = np.random.default_rng(7)
    points = np.concatenate(([(0, 0), (8, 0), (8, 8), (0, 8), (3, 0)], rng.random((20, 2)) * 8))
    _, index = locator(points)
    queries = np.array([(1, 0), (7, 0), (8, 2), (3, 0), (-1, 3), (np.nan, 3)], dtype=float)
    table = index.natural(kind, queries, None, 1)
    indptr, indices, weights = table.indptr, table.indices, table.weights
    slopes, triangle = table.slopes, table.simplex
    ranges = [slice(start, end) for start, end in pairwise(indptr)]
    rows = [dict(zip(indices[r], weights[r], strict=True)) for r in ranges]
    assert (triangle[:4] >= 0).all() and triangle[4:].tolist() == [-1, -1]
    assert rows[3] == {4: 1.0} and rows[4] == rows[5] == {}
    if slopes is None:
        assert rows[0] == pytest.approx({0: 2 / 3, 4: 1 / 3})
        assert rows[1] == pytest.approx({1: 4 / 5, 4: 1 / 5})
        assert rows[2] == pytest.approx({1: 3 / 4, 2: 1 / 4})
    # The same beside the hull, up to the distance.
    near = queries[:3] + np.array([(0, 1e-13), (0, 1e-13), (-1e-13, 0)])
    values = rng.random((25, 1))
    gradients = rng.random((25, 1, 2))
    on, beside = (
        index.natural_values(kind, values, gradients, q.copy(), None, 0, 1)
        for q in (queries[:3], near)
    )
    assert on == pytest.approx(beside, abs=1e-11)


def fields(points: Floats) -> tuple[Floats, Floats]:
    """Columns 1, x, y, x^2 + y^2, x y, x^2, and their gradients."""
    x, y = points.T
    one, nil = np.ones_like(x), np.zeros_like(x)
    values = np.stack([one, x, y, x * x + y * y, x * y, x * x], axis=1)
    by_x = np.stack([nil, one, nil, 2 * x, y, 2 * x], axis=1)
    by_y = np.stack([nil, nil, one, 2 * y, x, nil], axis=1)
    return values, np.stack([by_x, by_y], axis=-1)


@pytest.mark.parametrize(
    ("kind", "exact_columns"),
    [("sibson", 3), ("laplace", 3), ("sibson1", 4), ("farin", 6), ("clough_tocher", 6)],
)
def test_polynomials_come_back_with_their_derivatives(kind: str, exact_columns: int) -> None:
    rng = np.random.default_rng(8)
    points = rng.random((300, 2))
    _, index = locator(points)
    queries = rng.random((2000, 2))
    queries = queries[index.find(queries, 1) >= 0]
    values, gradients = fields(points)
    expected, slopes = fields(queries)

    def evaluate(order: int) -> Floats:
        if kind == "clough_tocher":
            return index.clough_tocher(values, gradients, queries, None, order, 2)
        return index.natural_values(kind, values, gradients, queries, None, order, 2)

    used = slice(exact_columns)
    assert evaluate(0)[:, used] == pytest.approx(expected[:, used], abs=1e-13)
    errors = np.abs(evaluate(1) - slopes)[:, used]
    assert np.median(errors) < 1e-13 and np.quantile(errors, 0.99) < 1e-9
    hessian = np.zeros((6, 3))
    hessian[3], hessian[4], hessian[5] = (2, 0, 2), (0, 1, 0), (2, 0, 0)
    errors = np.abs(evaluate(2) - hessian)[:, used]
    assert np.median(errors) < 1e-11 and np.quantile(errors, 0.95) < 1e-7


@pytest.mark.parametrize("kind", [*KINDS, "clough_tocher"])
def test_derivatives_are_limits_of_differences(kind: str) -> None:
    rng = np.random.default_rng(9)
    points = rng.random((100, 2))
    _, index = locator(points)
    values, gradients = rng.random((100, 2)), rng.random((100, 2, 2))
    queries = 0.2 + 0.6 * rng.random((500, 2))
    step = 1e-6

    def evaluate(at: Floats, order: int) -> Floats:
        if kind == "clough_tocher":
            return index.clough_tocher(values, gradients, at, None, order, 1)
        return index.natural_values(kind, values, gradients, at, None, order, 1)

    for order, pick in ((1, [0, 1]), (2, [[0, 1], [1, 2]])):
        found = evaluate(queries, order)
        for axis in range(2):
            way = step * np.eye(2)[axis]
            after, before = (evaluate(q, order - 1) for q in (queries + way, queries - way))
            limit = (after - before) / (2 * step)
            error = np.abs(found[:, :, pick[axis]] - limit)
            assert np.median(error) < 1e-6 * (1 + np.median(np.abs(limit)))


def test_weights_and_values_agree() -> None:
    rng = np.random.default_rng(10)
    points = rng.random((200, 2))
    mesh, index = locator(points)
    values, gradients = rng.random((200, 3)), rng.random((200, 3, 2))
    queries = np.concatenate((rng.random((500, 2)) * 1.2, points[:20]))
    for kind in KINDS:
        table = index.natural(kind, queries, None, 1)
        used = None if table.slopes is None else gradients
        rows = table.indptr, table.indices, table.weights
        combined = _core.combine2(*rows, values, table.slopes, used, 2)
        direct = index.natural_values(kind, values, used, queries, None, 0, 2)
        assert combined == pytest.approx(direct, abs=1e-13, nan_ok=True)
        assert np.array_equal(combined[-20:], values[:20])
    found = index.clough_tocher_weights(queries, None, 2)
    corners = mesh.simplices[found.simplex]
    combined = (found.weights[..., None] * values[corners]).sum(axis=1)
    combined += (found.slopes[:, :, None] * gradients[corners]).sum(axis=(1, 3))
    direct = index.clough_tocher(values, gradients, queries, None, 0, 1)
    assert combined == pytest.approx(direct, abs=1e-13, nan_ok=True)


@pytest.mark.deep
def test_scipys_scheme_and_gradients() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    rng = np.random.default_rng(11)
    points, values = rng.random((300, 2)), rng.random((300, 2))
    theirs = interpolate.CloughTocher2DInterpolator(points, values, tol=1e-9, maxiter=1000)
    mesh, index = locator(points)
    indptr, indices = mesh.vertex_neighbor_vertices
    gradients, sweeps = _core.gradients_global2(points, indptr, indices, values, 1e-9, 1000, 2)
    assert (sweeps > 1).all()
    assert gradients == pytest.approx(theirs.grad, abs=1e-7)
    queries = rng.random((3000, 2))
    found = index.clough_tocher(values, gradients, queries, None, 0, 1)
    assert found == pytest.approx(theirs(queries), abs=1e-8, nan_ok=True)
    _, sweeps = _core.gradients_global2(points, indptr, indices, values, 1e-9, 2, 1)
    assert sweeps.tolist() == [0, 0]


@pytest.mark.parametrize(("degree", "columns"), [(1, 3), (2, 6)])
def test_local_gradients_of_polynomials(degree: int, columns: int) -> None:
    points = np.random.default_rng(12).random((200, 2))
    indptr, indices = Delaunay(points).vertex_neighbor_vertices
    values, gradients = fields(points)
    found = _core.gradients_local2(points, indptr, indices, values, degree, 2)
    assert found[:, :columns] == pytest.approx(gradients[:, :columns], abs=1e-9)


@pytest.mark.parametrize("kind", ["linear", "nearest", "sibson", "laplace"])
def test_leaving_one_out(kind: str) -> None:
    rng = np.random.default_rng(13)
    circle = np.exp(2j * np.pi * rng.random(80))  # Its centre has all for neighbours.
    points = np.concatenate((np.stack([circle.real, circle.imag], axis=1), [(0, 0)]))
    points = np.concatenate((points, rng.random((60, 2)) / 8 + 0.2))
    _, index = locator(points)
    values = rng.random((len(points), 1))
    table = index.leave_one_out(kind, 2)
    rows = table.indptr, table.indices, table.weights
    found = _core.combine2(*rows, values, None, None, 1)
    for i in range(len(points)):
        others = np.delete(points, i, axis=0)
        _, rest = locator(others)
        query, known = points[i : i + 1], np.delete(values, i, axis=0)
        if kind == "linear":
            expected = rest.linear(known, query, 0, 1)
        elif kind == "nearest":
            expected = known[rest.nearest(query, 1)]
        else:
            expected = rest.natural_values(kind, known, None, query, None, 0, 1)
        assert found[i] == pytest.approx(expected[0], abs=1e-12, nan_ok=True)


def test_what_does_not_fit_is_refused() -> None:
    points = np.random.default_rng(14).random((20, 2))
    _, index = locator(points)
    values = np.zeros((20, 1))
    with pytest.raises(ValueError, match="kind"):
        index.natural("cubic", points, None, 1)
    with pytest.raises(ValueError, match="order"):
        index.linear(values, points, 3, 1)
    with pytest.raises(ValueError, match="row for each"):
        index.linear(values[:19], points, 0, 1)
    with pytest.raises(ValueError, match="gradients"):
        index.natural_values("farin", values, None, points, None, 0, 1)
    with pytest.raises(ValueError, match="barrier"):
        index.natural("sibson", points, np.zeros((1, 3), dtype=bool), 1)
    start = np.array([0, 1], dtype=np.int64)
    with pytest.raises(ValueError, match="outside"):
        one = np.ones(1, dtype=np.int32)
        _core.combine2(start, 20 * one, np.ones(1), values, None, None, 1)
