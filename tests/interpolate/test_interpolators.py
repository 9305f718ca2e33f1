"""What all interpolators promise: sites bit for bit, no NaN inside, linear functions, policies."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import Delaunay, datasets
from delone.errors import DegenerateInputError, DtypeError, InputError, NonFiniteError, ShapeError
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor, Nearest, interpolator
from delone.interpolate.methods import METHODS

ALL = sorted(METHODS)
SIMPLE = ("linear", "nearest", "sibson", "laplace")
BETWEEN = [name for name in ALL if name != "nearest"]
SETS = ["uniform", "grid", "tilted_grid", "circle", "duplicates", "integer_lattice"]


def linear(points: Any) -> Any:
    return 1 + 2 * points[..., 0] - 3 * points[..., 1]


def tolerance(name: str) -> float:
    # Gradients of the global estimation stop at a tolerance of 1e-6.
    return 1e-5 if name == "clough-tocher" else 1e-10


def places(mesh: Delaunay, seed: int = 1) -> Any:
    """Queries in triangles, on edges, on hull edges and at sites, all of them inside."""
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet((1, 1, 1), mesh.nsimplex)
    within = np.einsum("kv,kvj->kj", weights, mesh.points[mesh.simplices])
    u, v = mesh.edges.T
    halves = mesh.points[u] / 2 + mesh.points[v] / 2
    queries = np.concatenate((within, halves, mesh.points))
    return queries[mesh.find_simplex(queries) >= 0]


@pytest.mark.parametrize("points", SETS)
@pytest.mark.parametrize("method", ALL)
def test_sites_come_back_bit_for_bit(method: str, points: str) -> None:
    mesh = Delaunay(datasets.GENERATORS[points](200, seed=2))
    values = np.random.default_rng(3).normal(size=mesh.npoints) * 1e3
    values[::7] = -0.0
    values = values[mesh.duplicate_of]
    found = interpolator(mesh, values, method)(mesh.points)
    assert found.tobytes() == values.tobytes()
    assert (
        interpolator(mesh, method=method).weights_at(mesh.points) @ values
    ).tobytes() == values.tobytes()


@pytest.mark.parametrize("points", SETS)
@pytest.mark.parametrize("method", ALL)
@pytest.mark.deep("farin-circle", "sibson-circle", "sibson1-circle")
def test_inside_there_is_always_a_value(method: str, points: str) -> None:
    mesh = Delaunay(datasets.GENERATORS[points](200, seed=4))
    values = linear(mesh.points)
    queries = places(mesh)
    found = interpolator(mesh, values, method)(queries)
    assert np.isfinite(found).all()
    if method in SIMPLE:
        spread = 1e-12 * np.abs(values).max()
        assert found.min() >= values.min() - spread and found.max() <= values.max() + spread


@pytest.mark.parametrize("points", SETS)
@pytest.mark.parametrize("method", BETWEEN)
@pytest.mark.deep("farin-circle", "sibson-circle", "sibson1-circle")
def test_linear_functions_are_reproduced(method: str, points: str) -> None:
    mesh = Delaunay(datasets.GENERATORS[points](200, seed=5))
    made = interpolator(mesh, linear(mesh.points), method, extrapolate="linear")
    inside = places(mesh)
    outside = mesh.min_bound + (mesh.max_bound - mesh.min_bound) * [(-0.5, 0.3), (1.4, 1.6)]
    size = np.abs(linear(mesh.points)).max()
    for queries in (inside, outside):
        np.testing.assert_allclose(
            made(queries), linear(queries), rtol=0, atol=tolerance(method) * size
        )
    some = inside[:: max(1, len(inside) // 50)]
    slopes = made.gradient(some)
    known = np.isfinite(slopes).all(axis=1)
    assert known.any()
    expected = np.tile((2.0, -3.0), (known.sum(), 1))
    np.testing.assert_allclose(slopes[known], expected, atol=1e-4)


@pytest.mark.parametrize("extrapolate", ["nan", "nearest", "linear"])
@pytest.mark.parametrize("method", ALL)
def test_weights_say_the_same_as_calls(method: str, extrapolate: str) -> None:
    if method == "nearest" and extrapolate == "linear":
        with pytest.raises(InputError, match="extrapolate must be one of"):
            Nearest(datasets.uniform(9), extrapolate=extrapolate)
        return
    rng = np.random.default_rng(6)
    points, queries = rng.random((80, 2)), rng.random((200, 2)) * 1.8 - 0.4
    values = rng.normal(size=(80, 3)) + 1j * rng.normal(size=(80, 3))
    made = interpolator(points, values, method, extrapolate=extrapolate)
    table = made.weights_at(queries)
    np.testing.assert_allclose(table.apply(values), made(queries), rtol=1e-12, atol=1e-12)
    assert len(table) == 200 and table.indices.max() < 80
    sums = np.add.reduceat(table.weights, table.indptr[:-1][np.diff(table.indptr) > 0])
    np.testing.assert_allclose(sums, 1, rtol=1e-12)
    assert (table.slopes is None) == (method in SIMPLE and extrapolate != "linear")
    if table.slopes is None:
        np.testing.assert_allclose(table.csr() @ values, made(queries), rtol=1e-12, atol=1e-12)
    else:
        with pytest.raises(InputError, match="gradients"):
            table.csr()


@pytest.mark.parametrize("method", ALL)
def test_shapes_and_kinds(method: str) -> None:
    rng = np.random.default_rng(7)
    points = rng.random((40, 2))
    made = interpolator(points, method=method)
    queries = rng.random((3, 5, 2)) * 0.4 + 0.3
    for values in (
        rng.random(40),
        rng.random((40, 2)),
        rng.random((40, 2, 3)) * 1j,
        np.arange(40),
        rng.random(40).astype(np.float32),
        rng.random((40, 0)),
        rng.random(40).astype(">f8"),
        rng.random(40).tolist(),
    ):
        found = made(queries, values=values)
        array = np.asarray(values)
        assert found.shape == (3, 5, *array.shape[1:])
        assert found.dtype == (np.complex128 if array.dtype.kind == "c" else np.float64)
        assert made.gradient(queries, values=values).shape == (3, 5, *array.shape[1:], 2)
        if array.ndim == 3:
            one = made(queries, values=array[:, 1, 2].imag)
            np.testing.assert_allclose(found[..., 1, 2].imag, one, rtol=1e-12, atol=1e-14)
    assert made((0.5, 0.5), values=np.ones(40)).shape == ()
    for nothing in (np.empty((0, 2)), []):
        assert made(nothing, values=np.ones((40, 3))).shape == (0, 3)


@pytest.mark.parametrize("method", ALL)
def test_queries_that_are_no_numbers(method: str) -> None:
    points = datasets.uniform(30)
    for extrapolate in ("nan", "nearest", "raise"):
        made = interpolator(points, linear(points), method, extrapolate=extrapolate)
        found = made([(np.nan, 0.5), (0.5, np.nan), tuple(points[3])])
        assert np.isnan(found[:2]).all() and found[2] == linear(points)[3]
        if extrapolate != "raise":
            assert np.isnan(made([(0.5, np.inf), (-np.inf, 0.5)])).all()


@pytest.mark.parametrize("extrapolate", ["nearest", "linear"])
@pytest.mark.parametrize("method", [name for name in ALL if name != "nearest"])
def test_beyond_a_hull_that_spans_the_range_of_doubles(method: str, extrapolate: str) -> None:
    corners = np.array([(-1.0, -1), (1, -1), (1, 1), (-1, 1), (0, 0)])
    values = np.array([1.0, 2, 3, 4, 2.5])
    queries = np.array([(1.03, 1.03), (0, 1.03), (-1.03, 0.2)])
    plain = interpolator(corners, values, method, extrapolate=extrapolate)
    vast = interpolator(corners * 1.7e308, values, method, extrapolate=extrapolate)
    found = vast(queries * 1.7e308)
    # Estimated gradients converge at different rates.
    np.testing.assert_allclose(found, plain(queries), atol=0.02)
    np.testing.assert_allclose(vast.weights_at(queries * 1.7e308) @ values, found, rtol=1e-12)


@pytest.mark.parametrize("method", ALL)
def test_extrapolation(method: str) -> None:
    points = np.array([(0, 0), (4, 0), (4, 4), (0, 4), (2, 3), (1, 1.5)])
    values = np.array([1.0, 3.0, 7.0, 5.0, -2.0, 4.0])
    far = np.array([(9, -3), (-1, 9), (2, 9), (-3, 1)])
    assert np.isnan(interpolator(points, values, method, extrapolate="nan")(far)).all()
    at_hull = np.array([(4, 0), (0, 4), (2, 4), (0, 1)])
    if method != "nearest":
        made = interpolator(points, values, method, extrapolate="nearest")
        np.testing.assert_allclose(made(far), made(at_hull), rtol=1e-12)
        assert made(far)[:2].tolist() == [3.0, 5.0]
        on = interpolator(points, values, method, extrapolate="linear")
        slope = on.gradient(far)
        expected = on(at_hull) + ((far - at_hull) * slope).sum(axis=1)
        np.testing.assert_allclose(on(far), expected, rtol=1e-12)
    with pytest.raises(InputError, match=r"xi: 2 of 3 queries are outside.*rows 0, 2"):
        refused = interpolator(points, values, method, extrapolate="raise")
        refused([(9, 9), (2, 2), (-1, 0)])
    assert np.isfinite(refused([(2, 2), (4, 4)])).all()
    with pytest.raises(InputError, match="outside"):
        refused.weights_at([(9, 9)])


@pytest.mark.parametrize("method", ALL)
def test_duplicates(method: str) -> None:
    points = datasets.uniform(20)
    twice = np.concatenate((points, points[[3, 3, 5]]))
    values = np.concatenate((linear(points), [10.0, 40.0], linear(points[5:6])))
    first = values[3]
    with pytest.raises(InputError, match="2 duplicates have a different value: rows 20 and 3,"):
        interpolator(twice, values, method)
    expected = {
        "first": first,
        "last": 40.0,
        "mean": first + ((10.0 - first) + (40.0 - first)) / 3,
        "min": min(first, 10.0),
        "max": 40.0,
    }
    for policy, value in expected.items():
        made = interpolator(twice, values, method, duplicates=policy)
        assert made(points[3]) == value
        assert made(points[5]) == values[5]
        assert made.weights_at(points[[3]]).apply(values)[0] == value
    same = values.copy()
    same[20:22] = first
    assert interpolator(twice, same, method)(points[3]) == first
    with pytest.raises(InputError, match="no order"):
        interpolator(twice, values * 1j, method, duplicates="min")


@pytest.mark.parametrize("method", SIMPLE)
@pytest.mark.parametrize("drop", [False, True])
def test_matrices_share_duplicates(method: str, drop: bool) -> None:
    points = datasets.uniform(30)
    points = np.concatenate((points[20:22], points, points[[3, 3, 5, 8]]))
    values = np.random.default_rng(4).normal(size=len(points))
    if drop:
        values[[4, 33, 9]] = np.nan
    queries = np.concatenate((np.random.default_rng(5).random((100, 2)), points))
    for policy in ("first", "last", "mean"):
        made = interpolator(
            points, values, method, duplicates=policy, nan="drop" if drop else "raise"
        )
        matrix = made.weights_at(queries).csr()
        assert matrix.shape == (136, 36)
        found = matrix[:, ~np.isnan(values)] @ values[~np.isnan(values)]
        np.testing.assert_allclose(found, made(queries), rtol=1e-12, atol=1e-14)
    for policy in ("min", "max"):
        with pytest.raises(InputError, match="use apply"):
            interpolator(points, method=method, duplicates=policy).weights_at(queries).csr()
        interpolator(points[2:32], method=method, duplicates=policy).weights_at(queries).csr()


def test_a_mean_of_equal_values_is_that_value() -> None:
    points = np.concatenate((datasets.uniform(10), np.repeat(datasets.uniform(1), 6, axis=0)))
    values = np.full(len(points), 0.1)
    assert (Linear(points, values, duplicates="mean")(points) == 0.1).all()


@pytest.mark.parametrize("method", ALL)
def test_nan_among_values(method: str) -> None:
    points = datasets.uniform(60, seed=9)
    values = linear(points)
    values[[4, 11]] = np.nan, np.inf
    with pytest.raises(NonFiniteError, match="first: 4, 11") as caught:
        interpolator(points, values, method)
    assert caught.value.rows.tolist() == [4, 11] and caught.value.count == 2
    without = interpolator(points, values, method, nan="drop")
    rest = np.delete(np.arange(60), [4, 11])
    queries = np.random.default_rng(1).random((50, 2))
    plain = interpolator(points[rest], values[rest], method)
    np.testing.assert_array_equal(without(queries), plain(queries))
    # Another field with all its values, and one with other gaps.
    np.testing.assert_array_equal(
        without(queries, values=linear(points)),
        interpolator(points, linear(points), method)(queries),
    )
    assert not np.isin(without.weights_at(queries).indices, (4, 11)).any()
    np.testing.assert_allclose(without.weights_at(queries) @ values, plain(queries), rtol=1e-12)
    through = interpolator(points, values, method, nan="propagate")
    near = through(points[4])
    assert np.isnan(near) and through(points[11]) == np.inf


@pytest.mark.parametrize("gradients", ["global", "local", "plane"])
@pytest.mark.parametrize("method", ["clough-tocher", "farin", "sibson1"])
def test_gaps_stay_where_they_are(method: str, gradients: str) -> None:
    points = datasets.uniform(200, seed=9)
    values = np.column_stack((linear(points), linear(points)))
    values[50, 1] = np.nan
    queries = np.random.default_rng(1).random((1000, 2))
    made = interpolator(points, values, method, nan="propagate", gradients=gradients)
    found = made(queries)
    # Gradients come from the values that are there; they reproduce what is linear.
    weights = made.weights_at(queries)
    owner = np.repeat(np.arange(1000), np.diff(weights.indptr))
    touched = np.isin(np.arange(1000), owner[weights.indices == 50])
    inside = np.isfinite(found[:, 0])
    assert 0 < touched.sum() < 50
    np.testing.assert_array_equal(np.isfinite(found[:, 1]), inside & ~touched)
    rest = inside & ~touched
    np.testing.assert_allclose(found[rest, 1], linear(queries[rest]), atol=1e-4)


def test_nan_does_not_leave_its_triangles() -> None:
    points = np.array([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], dtype=float)
    made = Linear(points, [np.nan, 1.0, 2.0, 3.0, 4.0], nan="propagate")
    assert made([(4, 0), (4, 2), (3, 1), (3, 2)]).tolist() == [1.0, 1.5, 2.5, 2.75]
    assert np.isnan(made((1, 1)))


@pytest.mark.parametrize("kind", [Linear, Nearest, CloughTocher, NaturalNeighbor])
def test_bad_arguments(kind: Any) -> None:
    points = datasets.uniform(20)
    for option in ("extrapolate", "duplicates", "nan"):
        with pytest.raises(InputError, match=f"{option} must be one of"):
            kind(points, linear(points), **{option: "quite"})
    with pytest.raises(InputError, match="workers"):
        kind(points, workers=0)
    for bad in (linear(points)[:-1], 3.0, linear(points)[None]):
        with pytest.raises(ShapeError, match=r"values must have shape \(20,\) or \(20, ...\)"):
            kind(points, bad)
    for bad in (["a"] * 20, [None] * 20, np.ma.masked_less(linear(points), 1)):
        with pytest.raises(DtypeError, match="values"):
            kind(points, bad)
    with pytest.raises(DtypeError, match="row 7"):
        kind(points, np.where(np.arange(20) == 7, 2**53 + 1, 0))
    with pytest.raises(InputError, match="no values"):
        kind(points)((0.5, 0.5))
    with pytest.raises(ShapeError, match="xi"):
        kind(points, linear(points))((1, 2, 3))
    with pytest.raises(DegenerateInputError):
        kind([(0, 0), (1, 1), (2, 2)], [1, 2, 3])
    with pytest.raises(NonFiniteError):
        kind([(0, 0), (1, np.nan), (2, 1)], [1, 2, 3])


def test_bad_methods() -> None:
    points = datasets.uniform(20)
    with pytest.raises(InputError, match="method must be one of"):
        interpolator(points, method="kriging")
    with pytest.raises(InputError, match="kind must be one of"):
        NaturalNeighbor(points, kind="voronoi")
    with pytest.raises(InputError, match="gradients must be one of"):
        CloughTocher(points, gradients="none")
    with pytest.raises(InputError, match="tol"):
        CloughTocher(points, tol=0.0)
    spatial = pytest.importorskip("scipy.spatial")
    with pytest.raises(DtypeError, match="pass its points"):
        Linear(spatial.Delaunay(points), linear(points))


@pytest.mark.parametrize("method", ALL)
def test_neither_workers_nor_company_show(method: str) -> None:
    points = datasets.uniform(2000)
    values = np.sin(7 * points[:, 0]) * points[:, 1]
    queries = np.random.default_rng(2).random((30_000, 2))
    one = interpolator(points, values, method, workers=1)(queries)
    np.testing.assert_array_equal(interpolator(points, values, method, workers=3)(queries), one)
    order = np.random.default_rng(3).permutation(len(queries))[:9000]
    np.testing.assert_array_equal(
        interpolator(points, values, method, workers=2)(queries[order]), one[order]
    )


@pytest.mark.parametrize("method", ALL)
def test_pickles(method: str) -> None:
    points = datasets.uniform(40)
    made = interpolator(points, linear(points), method)
    queries = np.random.default_rng(4).random((20, 2))
    expected = made(queries)
    again = pickle.loads(pickle.dumps(made))
    np.testing.assert_array_equal(again(queries), expected)
    table = pickle.loads(pickle.dumps(made.weights_at(queries)))
    np.testing.assert_allclose(table @ linear(points), expected, rtol=1e-12)


@given(
    st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=5, max_size=25, unique=True),
    st.tuples(st.integers(0, 24), st.integers(0, 24)),
)
def test_weights_are_a_mean_that_is_the_query(
    sites: list[tuple[int, int]], quarters: tuple[int, int]
) -> None:
    points = np.array(sites, dtype=float)
    try:
        mesh = Delaunay(points)
    except DegenerateInputError:
        return
    query = np.array(quarters) / 4
    for made in (Linear(mesh), NaturalNeighbor(mesh), NaturalNeighbor(mesh, kind="laplace")):
        table = made.weights_at(query)
        if int(mesh.find_simplex(query)) < 0:
            assert table.weights.size == 0 and np.isnan(table @ points[:, 0])
            continue
        assert (table.weights > 0).all()
        np.testing.assert_allclose(table.weights.sum(), 1, rtol=1e-14)
        np.testing.assert_allclose(table.weights @ points[table.indices], query, atol=1e-13)


@pytest.mark.parametrize("duplicates", ["mean", "first", "last", "max"])
@pytest.mark.parametrize("method", ["linear", "nearest", "sibson"])
def test_pickled_tables_of_weights_have_no_triangulation(method: str, duplicates: str) -> None:
    points = datasets.uniform(20_000)
    points[-1] = points[0]
    values = linear(points)
    values[[0, 5]] = 7.0, np.nan
    made = interpolator(points, values, method, duplicates=duplicates, nan="drop")
    table = made.weights_at([(0.3, 0.4), points[0], (0.6, 0.1)])
    data = pickle.dumps(table)
    # The rows that are kept and those that coincide: 12 bytes a site.
    assert len(data) < 300_000
    again = pickle.loads(data)
    np.testing.assert_array_equal(again @ values, table @ values)
    np.testing.assert_array_equal(again @ values, made([(0.3, 0.4), points[0], (0.6, 0.1)]))
    assert np.array_equal(again.indices, table.indices)
    assert repr(pickle.loads(pickle.dumps(again)) @ values) == repr(again @ values)
    if duplicates != "max":
        np.testing.assert_allclose(again.csr() @ np.nan_to_num(values), table @ values)
    plain = interpolator(datasets.uniform(20_000), method=method).weights_at((0.5, 0.5))
    assert len(pickle.dumps(plain)) < 2_000


def test_pickled_tables_with_gradients_keep_what_these_need() -> None:
    points = datasets.uniform(500)
    made = interpolator(points, linear(points), "clough-tocher")
    again = pickle.loads(pickle.dumps(made.weights_at((0.5, 0.5))))
    np.testing.assert_allclose(again @ (3 * linear(points)), 3 * made((0.5, 0.5)), rtol=1e-9)
