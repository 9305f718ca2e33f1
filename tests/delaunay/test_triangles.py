"""The triangles themselves: exact, canonical, the same however the points come."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import DegenerateInputError, Delaunay, _core, datasets, reference
from delone.testing import assert_delaunay, same_triangles, triangle_set
from tiers import examples

if TYPE_CHECKING:
    from numpy.typing import NDArray

METHODS = _core.methods2()
GENERATORS = sorted(datasets.GENERATORS)
DOUBLE = st.floats(allow_nan=False, allow_infinity=False)


def check(points: Any) -> Delaunay:
    mesh = Delaunay(points)
    assert_delaunay(points, mesh.simplices, neighbors=mesh.neighbors)
    report = mesh.validate()
    assert report, str(report)
    return mesh


def places(mesh: Delaunay) -> set[tuple[int, int, int]]:
    """Triangles by the lexicographic rank of their corners, whatever the rows."""
    _, rank = np.unique(mesh.points + 0.0, axis=0, return_inverse=True)
    return triangle_set(rank.reshape(-1)[mesh.simplices])


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("n", [5, 60, 3000])
def test_every_generator_exactly(name: str, n: int) -> None:
    check(datasets.GENERATORS[name](n, seed=n))


@pytest.mark.parametrize("name", GENERATORS)
def test_the_reference_says_the_same(name: str) -> None:
    points = datasets.GENERATORS[name](40, seed=4)
    assert same_triangles(Delaunay(points).simplices, reference.bowyer_watson(points))


def test_the_corpus_exactly(corpus_case: Any) -> None:
    check(corpus_case.points)


def test_degenerate_inputs_say_why(degenerate_case: Any) -> None:
    with pytest.raises(DegenerateInputError) as caught:
        Delaunay(degenerate_case.points)
    assert caught.value.reason == degenerate_case.reason
    rows = caught.value.chain
    points = degenerate_case.points + 0.0
    assert len(rows) == len(np.unique(points, axis=0)) if len(points) else len(rows) == 0
    ordered = points[rows].tolist()
    assert ordered == sorted(ordered) or ordered == sorted(ordered, reverse=True)
    for row in rows.tolist():
        assert row == int(np.flatnonzero((points == points[row]).all(axis=1))[0])


def hard_points(name: str) -> NDArray[np.float64]:
    points: NDArray[np.float64] = datasets.GENERATORS[name](300, seed=6)
    return points


@pytest.mark.parametrize("name", GENERATORS)
def test_order_of_rows_does_not_show(name: str) -> None:
    points = hard_points(name)
    expected = places(Delaunay(points))
    for seed in range(3):
        shuffled = np.random.default_rng(seed).permutation(points)
        assert places(Delaunay(shuffled)) == expected
    assert places(Delaunay(points[::-1])) == expected


@pytest.mark.parametrize("name", [name for name in GENERATORS if name != "mixed_exponents"])
@pytest.mark.parametrize("exponent", [-600, -3, 1, 600])
def test_powers_of_two_scale_triangles(name: str, exponent: int) -> None:
    # Coordinates must stay exact: none of these generators comes near the ends of the range.
    points = hard_points(name)
    scaled = np.ldexp(points, exponent)
    if not np.array_equal(np.ldexp(scaled, -exponent), points):
        pytest.fail("the scaled coordinates are rounded")
    assert same_triangles(Delaunay(scaled).simplices, Delaunay(points).simplices)


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("offset", [(1.0, -3.0), (499_000.0, 5_200_000.0), (2.0**40, 2.0**40)])
def test_exact_translations_keep_triangles(name: str, offset: tuple[float, float]) -> None:
    # On a lattice of 2**-10, below 2**41, every sum is exact.
    with np.errstate(over="ignore"):
        points = np.clip(np.round(np.clip(hard_points(name), -1e6, 1e6) * 1024) / 1024, -1e6, 1e6)
    moved = points + offset
    assert np.array_equal(moved - offset, points)
    try:
        expected = Delaunay(points)
    except DegenerateInputError:
        with pytest.raises(DegenerateInputError):
            Delaunay(moved)
        return
    assert same_triangles(Delaunay(moved).simplices, expected.simplices)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.sampled(3)
def test_workers_do_not_show(method: str) -> None:
    # Enough points for several blocks, each of which a thread may take.
    points = datasets.gaussian_clusters(60_000)
    expected = Delaunay(points, method=method, workers=1)
    for workers in (None, 2, 5, 64):
        mesh = Delaunay(points, method=method, workers=workers)
        assert np.array_equal(mesh.simplices, expected.simplices)
        assert np.array_equal(mesh.neighbors, expected.neighbors)
    assert same_triangles(expected.simplices, Delaunay(points).simplices)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["uniform", "grid", "duplicates", "circle"])
def test_order_of_triangles_is_that_of_the_points(name: str, method: str) -> None:
    points = datasets.GENERATORS[name](2000, seed=5)
    shuffled = np.random.default_rng(1).permutation(points)
    one, two = Delaunay(points, method=method), Delaunay(shuffled, method=method)
    assert np.array_equal(points[one.simplices], shuffled[two.simplices])
    assert np.array_equal(one.neighbors, two.neighbors)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_is_documented_and_exact(method: str) -> None:
    assert Delaunay.__doc__ is not None
    assert f'"{method}"' in Delaunay.__doc__
    for name in ("uniform", "grid", "near_collinear", "duplicates"):
        points = datasets.GENERATORS[name](700, seed=2)
        mesh = Delaunay(points, method=method)
        assert_delaunay(points, mesh.simplices, neighbors=mesh.neighbors)


@settings(max_examples=examples(40, deep=400))
@given(st.data())
def test_small_lattices(data: st.DataObject) -> None:
    side = data.draw(st.integers(3, 6))
    coordinate = st.integers(0, side - 1)
    points = data.draw(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=side**2))
    compare_with_reference(points)


@settings(max_examples=examples(20, deep=200))
@given(st.lists(st.tuples(DOUBLE, DOUBLE), min_size=3, max_size=12))
def test_any_doubles(points: list[tuple[float, float]]) -> None:
    compare_with_reference(points)


@settings(max_examples=examples(20, deep=200))
@given(
    st.lists(
        st.tuples(st.integers(-2, 2), st.integers(-2, 2)), min_size=4, max_size=12, unique=True
    ),
    st.sampled_from([0.1, 1 / 3, 1e-310, 1e300, 2.0**-1074]),
    st.sampled_from([0.0, 1.0, 1e6]),
)
def test_rounded_lattices(points: list[tuple[int, int]], step: float, offset: float) -> None:
    with np.errstate(over="ignore"):
        rounded = np.array(points) * step + offset
    compare_with_reference(rounded.tolist())


def compare_with_reference(points: list[Any]) -> None:
    try:
        expected = reference.bowyer_watson(points)
    except DegenerateInputError as error:
        with pytest.raises(DegenerateInputError) as caught:
            Delaunay(points)
        assert caught.value.reason == error.reason
        return
    mesh = Delaunay(points)
    assert same_triangles(mesh.simplices, expected)
    assert_delaunay(points, mesh.simplices, neighbors=mesh.neighbors)
    assert mesh.validate()


@pytest.mark.parametrize("side", [3, 4, 5, 6])
def test_full_lattices_fan_each_cell_from_its_smallest_corner(side: int) -> None:
    points = [(x, y) for x in range(side) for y in range(side)]
    mesh = check(points)
    diagonals = {
        (u, v) for u, v in mesh.edges.tolist() if u // side != v // side and u % side != v % side
    }
    # Rows are in lexicographic order, so that a cell's smallest corner is its first row.
    assert diagonals == {
        (x * side + y, (x + 1) * side + y + 1) for x in range(side - 1) for y in range(side - 1)
    }
