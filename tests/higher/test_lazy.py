"""Linear interpolation without a triangulation: the values are those of the mesh."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import delone
from delone import Delaunay, _core
from delone._base import blocks
from delone.compat import scipy
from delone.interpolate import Linear, lazily


def clouds(d: int) -> dict[str, np.ndarray]:
    """Points in general position, on a lattice, on a sphere, repeated, thin."""
    random = np.random.default_rng(d)
    normal = random.normal(size=(80, d))
    lattice = random.integers(0, 3, (90, d)) / 3.0
    uniform = random.random((120, d))
    return {
        "uniform": uniform,
        "lattice": lattice,
        "sphere": normal / np.linalg.norm(normal, axis=1, keepdims=True),
        "repeated": np.vstack((uniform[:40], uniform[10:30])),
        "thin": uniform * np.append(np.ones(d - 1), 1e-9) + 1e3,
        "tiny": uniform * 1e-300,
    }


@pytest.mark.parametrize("kind", clouds(2))
@pytest.mark.parametrize("d", [2, 3, 4, 5])
def test_values_are_those_of_the_mesh(d: int, kind: str) -> None:
    points = clouds(d)[kind]
    random = np.random.default_rng(7)
    values = points / np.abs(points).max() @ np.arange(1.0, d + 1) + random.random()
    options = {"duplicates": "mean", "workers": 1}
    lazy, mesh = (Linear(points, values**2, method=m, **options) for m in ("lazy", "mesh"))
    low, high = points.min(axis=0), points.max(axis=0)
    middle = points[random.integers(0, len(points), (60, 2))].mean(axis=1)
    queries = np.vstack((low + random.random((60, d)) * (high - low), middle, high[None] * 2))
    found, expected = lazy(queries), mesh(queries)
    assert np.array_equal(np.isnan(found), np.isnan(expected))
    known = np.isfinite(found)
    assert known.any()
    assert np.abs(found - expected)[known].max() < 1e-12 * np.abs(expected[known]).max()
    # At a site, bit for bit.
    assert np.array_equal(lazy(points), mesh(points))
    weights = lazy.weights_at(queries[known]) @ values**2
    assert np.abs(weights - found[known]).max() < 1e-12 * np.abs(found[known]).max()
    # Strictly inside a simplex, slopes are those of the same simplex.
    place = mesh.triangulation.locate(queries)
    inner = (place.simplex >= 0) & (place.barycentric > 1e-9).all(axis=1)
    slopes, right = lazy.gradient(queries[inner]), mesh.gradient(queries[inner])
    assert np.abs(slopes - right).max(initial=0) <= 1e-9 * np.abs(right).max(initial=0)
    # The outside is that of the hull, exactly.
    assert np.array_equal(np.isnan(found), mesh.triangulation.find_simplex(queries) < 0)


def test_the_simplex_does_not_depend_on_workers_rows_or_powers_of_two() -> None:
    random = np.random.default_rng(3)
    points = random.random((200, 6))
    queries = np.vstack((random.random((300, 6)), points[:40]))
    corners, weights = _core.LazyN(points).within(queries, 1)
    again, same = _core.LazyN(points).within(queries, 3)
    assert np.array_equal(corners, again)
    assert np.array_equal(weights, same, equal_nan=True)
    order = random.permutation(200)
    moved, shares = _core.LazyN(points[order]).within(queries, 1)
    inside = corners[:, 0] >= 0
    assert 10 < inside.sum() < 340
    assert np.array_equal(order[moved[inside]], corners[inside])
    assert np.array_equal(shares, weights, equal_nan=True)
    scaled, shares = _core.LazyN(points * 2.0**500).within(queries * 2.0**500, 1)
    assert np.array_equal(scaled, corners)
    assert np.array_equal(shares, weights, equal_nan=True)


@pytest.mark.parametrize("d", [9, 16, 40])
def test_many_coordinates(d: int) -> None:
    random = np.random.default_rng(d)
    points, slope = random.random((4 * d, d)), np.arange(1.0, d + 1)
    field = Linear(points, points @ slope)
    assert repr(field) == f"<Linear on {4 * d} points in {d}-D>"
    queries = random.dirichlet(np.ones(4 * d), 12) @ points
    assert field(queries) == pytest.approx(queries @ slope, rel=1e-12)
    assert field.gradient(queries) == pytest.approx(np.tile(slope, (12, 1)), rel=1e-6)
    assert (field(points) == points @ slope).all()
    assert np.isnan(field(np.full(d, 2.0)))
    # Each simplex is Delaunay: no site is inside its sphere by more than rounding.
    corners, weights = _core.LazyN(points).within(queries, 1)
    for v, w, q in zip(points[corners], weights, queries, strict=True):
        assert w.min() >= 0
        assert w @ v == pytest.approx(q, rel=1e-12)
        center = np.linalg.solve(2 * (v[1:] - v[0]), ((v[1:] - v[0]) ** 2).sum(axis=1)) + v[0]
        reach = np.linalg.norm(v - center, axis=1)
        assert np.linalg.norm(points - center, axis=1).min() > reach.max() * (1 - 1e-7)


def test_policies_hold() -> None:
    random = np.random.default_rng(1)
    points = random.random((60, 10))
    values = random.random((60, 2))
    values[5, 0] = np.nan
    queries = random.dirichlet(np.ones(60), 5) @ points
    assert np.isfinite(Linear(points, values, nan="drop")(queries)).all()
    with pytest.raises(delone.InputError, match="first: 5"):
        Linear(points, values)
    with pytest.raises(delone.InputError, match="1 of 2 queries is outside the hull: row 1"):
        Linear(points, points[:, 0], extrapolate="raise")([queries[0], queries[0] + 3])
    twice = Linear(np.vstack((points, points[:1])), np.arange(61.0), duplicates="mean")
    assert twice(points[0]) == 30
    field = Linear(points, points[:, 0])
    again = pickle.loads(pickle.dumps(field))
    assert np.array_equal(again(queries), field(queries))
    complex_valued = Linear(points, points[:, 0] + 1j * points[:, 1])(queries)
    assert complex_valued == pytest.approx(queries[:, 0] + 1j * queries[:, 1], rel=1e-12)


def test_what_cannot_be_lazy_is_refused() -> None:
    points = np.random.default_rng(0).random((30, 3))
    values = points[:, 0]
    with pytest.raises(delone.InputError, match="method='lazy' needs points"):
        Linear(Delaunay(points), values, method="lazy")
    with pytest.raises(delone.InputError, match="at most 8 dimensions; choose method='lazy'"):
        Linear(np.random.default_rng(0).random((30, 9)), np.zeros(30), method="mesh")
    flat = np.column_stack((points, points.sum(axis=1), np.zeros((30, 7))))
    with pytest.raises(delone.DegenerateInputError, match="flat of dimension"):
        Linear(flat, values)
    with pytest.raises(delone.ShapeError):
        _core.LazyN(points).within(np.zeros((2, 4)), 1)


def test_what_does_not_fit_into_memory_is_lazy(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(0)
    points = random.random((3000, 6))
    monkeypatch.setattr("delone._tiling.higher.size.free_memory", lambda: 10**8)
    field = Linear(points, points.sum(axis=1))
    assert repr(field) == "<Linear on 3000 points in 6-D>"
    assert field(np.full(6, 0.5)) == pytest.approx(3, rel=1e-12)
    with pytest.raises(delone.TooLargeError, match=r'Linear\(method="lazy"\)'):
        Linear(points, points.sum(axis=1), method="mesh")
    with pytest.raises(delone.TooLargeError):
        delone.RegularTriangulation(points, points[:, 0])


def test_drop_ins_need_no_triangulation() -> None:
    random = np.random.default_rng(6)
    points = random.random((120, 10))
    values = points @ np.arange(10.0)
    inside = random.dirichlet(np.ones(120), 4) @ points
    queries = np.vstack((inside, [np.full(10, 2.0)]))
    found = scipy.LinearNDInterpolator(points, values, fill_value=-1)
    assert found.tri is None
    assert found(queries) == pytest.approx([*(inside @ np.arange(10.0)), -1], rel=1e-12)
    scaled = scipy.LinearNDInterpolator(points * np.arange(1.0, 11), values, rescale=True)
    assert scaled(inside * np.arange(1.0, 11)) == pytest.approx(found(inside), rel=1e-9)
    assert np.isnan(scipy.griddata(points, values, queries)[-1])
    with pytest.raises(scipy.QhullError, match="flat of dimension"):
        scipy.LinearNDInterpolator(points * np.append(np.ones(9), 0), values)
    with pytest.raises(scipy.DimensionError, match="up to 64"):
        scipy.LinearNDInterpolator(random.random((80, 65)), np.zeros(80))


def test_values_and_gradients_do_not_depend_on_the_size_of_blocks(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(8)
    grid = np.stack(np.meshgrid(*4 * [[0.0, 1.0, 3.0]]), axis=-1).reshape(-1, 4)
    for points, method in (
        (random.random((60, 4)), "lazy"),
        (random.random((60, 4)), "mesh"),
        (random.random((60, 9)), "lazy"),
        (grid, "grid"),
    ):
        field = Linear(points, random.random((len(points), 2)), method=method)
        corners = random.dirichlet(np.ones(len(points)), 40) @ points
        # Queries outside as well, so that rows in blocks are not rows of queries.
        queries = np.where(random.random((40, 1)) < 0.2, 5.0, corners)
        values, gradients = field(queries), field.gradient(queries)
        assert np.isnan(values).any()
        with monkeypatch.context() as patch:
            patch.setattr(blocks, "ROWS", 7)
            patch.setattr(lazily, "ROWS", 7 * points.shape[1] ** 2)
            assert np.array_equal(field(queries), values, equal_nan=True)
            assert np.array_equal(field.gradient(queries), gradients, equal_nan=True)
