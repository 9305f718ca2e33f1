"""Tetrahedra: exact, canonical, the same however the points come."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import (
    DegenerateInputError,
    Delaunay,
    InputError,
    NonFiniteError,
    ShapeError,
    datasets,
    reference,
)
from delone.testing import assert_delaunay, same_tetrahedra
from tiers import examples

if TYPE_CHECKING:
    from numpy.typing import NDArray

GENERATORS = sorted(datasets.GENERATORS3)
DOUBLE = st.floats(allow_nan=False, allow_infinity=False)
SMALL = st.integers(-2, 2).map(float)


def check(points: Any) -> Delaunay:
    mesh = Delaunay(points)
    assert_delaunay(points, mesh.simplices, neighbors=mesh.neighbors)
    report = mesh.validate()
    assert report, str(report)
    return mesh


def places(mesh: Delaunay) -> NDArray[np.int64]:
    """Tetrahedra by the lexicographic rank of their corners, whatever the rows."""
    _, rank = np.unique(mesh.points + 0.0, axis=0, return_inverse=True)
    return rank.reshape(-1)[mesh.simplices]


def lattice(side: int) -> NDArray[np.float64]:
    return np.array(list(itertools.product(range(side), repeat=3)), dtype=np.float64)


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("n", [8, 60, 600])
@pytest.mark.deep("60-mixed_exponents", "600-mixed_exponents")
@pytest.mark.sampled(6)
def test_every_generator_exactly(name: str, n: int) -> None:
    check(datasets.GENERATORS3[name](n, seed=n))


@pytest.mark.parametrize("name", GENERATORS)
def test_the_reference_says_the_same(name: str) -> None:
    points = datasets.GENERATORS3[name](24, seed=4)
    assert same_tetrahedra(Delaunay(points).simplices, reference.bowyer_watson(points.tolist()))


@pytest.mark.parametrize("name", GENERATORS)
def test_neither_order_nor_workers_matter(name: str) -> None:
    points = datasets.GENERATORS3[name](300, seed=2)
    wanted = Delaunay(points, workers=1)
    many = Delaunay(points, workers=3)
    assert (many.simplices == wanted.simplices).all()
    assert (many.neighbors == wanted.neighbors).all()
    rng = np.random.default_rng(0)
    for _ in range(3):
        permuted = Delaunay(rng.permutation(points))
        assert same_tetrahedra(places(permuted), places(wanted))


def test_many_workers_give_the_same_arrays() -> None:
    points = datasets.GENERATORS3["uniform"](40_000)
    wanted, many = Delaunay(points, workers=1), Delaunay(points, workers=3)
    assert (many.simplices == wanted.simplices).all()
    assert (many.neighbors == wanted.neighbors).all()
    assert many.validate()


@pytest.mark.parametrize("side", [2, 3, 4])
@pytest.mark.parametrize("seed", range(6))
def test_lattices_in_any_order(side: int, seed: int) -> None:
    points = lattice(side)
    wanted = places(Delaunay(points))
    mesh = check(np.random.default_rng(seed).permutation(points))
    assert same_tetrahedra(places(mesh), wanted)
    assert mesh.volumes.sum() == pytest.approx((side - 1) ** 3)


def test_all_orders_of_a_small_set() -> None:
    points = lattice(2)[[0, 1, 2, 4, 7]]
    wanted = places(Delaunay(points))
    for order in itertools.permutations(range(5)):
        assert same_tetrahedra(places(Delaunay(points[list(order)])), wanted)


@pytest.mark.parametrize("power", [-1000, -3, 40, 1000])
def test_powers_of_two_change_nothing(power: int) -> None:
    points = datasets.GENERATORS3["integer_lattice"](60)
    assert same_tetrahedra(Delaunay(np.ldexp(points, power)).simplices, Delaunay(points).simplices)


def test_exact_translations_change_nothing() -> None:
    points = datasets.GENERATORS3["integer_lattice"](60)
    moved = Delaunay(points + np.array((2.0**50, -(2.0**40), 3.0)))
    assert same_tetrahedra(moved.simplices, Delaunay(points).simplices)


@given(st.lists(st.tuples(SMALL, SMALL, SMALL), min_size=0, max_size=14))
@settings(max_examples=examples(30, deep=300), deadline=None)
def test_small_integers_by_the_reference(points: list[Any]) -> None:
    compare(points)


@given(st.lists(st.tuples(DOUBLE, DOUBLE, DOUBLE), min_size=4, max_size=9))
@settings(max_examples=examples(20, deep=200), deadline=None)
def test_any_doubles_by_the_reference(points: list[Any]) -> None:
    compare(points)


def compare(points: list[Any]) -> None:
    array = np.array(points, dtype=np.float64).reshape(-1, 3)
    try:
        wanted = reference.bowyer_watson(points) if points else []
    except DegenerateInputError as error:
        with pytest.raises(DegenerateInputError) as caught:
            Delaunay(array)
        assert caught.value.reason == error.reason
        return
    if not points:
        with pytest.raises(DegenerateInputError):
            Delaunay(array)
        return
    mesh = Delaunay(array)
    assert same_tetrahedra(mesh.simplices, wanted)
    assert_delaunay(array, mesh.simplices, neighbors=mesh.neighbors)
    assert mesh.validate()


def test_a_wrong_tetrahedron_is_found() -> None:
    points = datasets.GENERATORS3["uniform"](30)
    mesh = Delaunay(points)
    for wrong in (mesh.simplices[1:], mesh.simplices[:, [1, 0, 2, 3]]):
        with pytest.raises(AssertionError):
            assert_delaunay(points, wrong)


def test_another_diagonal_is_not_canonical() -> None:
    cube = lattice(2)
    # The five tetrahedra of a cube: a Delaunay triangulation, but not the canonical one.
    five = [(0, 5, 3, 6), (0, 4, 5, 6), (0, 5, 1, 3), (0, 3, 2, 6), (3, 5, 7, 6)]
    turned = [t if reference.orient3d(*cube[list(t)]) > 0 else (t[1], t[0], *t[2:]) for t in five]
    assert_delaunay(cube, turned, canonical=False)
    with pytest.raises(AssertionError, match="not canonical"):
        assert_delaunay(cube, turned)
    assert len(Delaunay(cube).simplices) == 6


def test_what_is_refused() -> None:
    with pytest.raises(ShapeError, match=r"d from 2 to 8, got \(3, 5\); transpose it"):
        Delaunay(np.zeros((3, 5)))
    with pytest.raises(InputError, match="in 3-D"):
        Delaunay(lattice(2), method="sweep")
    with pytest.raises(NonFiniteError) as caught:
        Delaunay([(0, 0, 0), (1, 0, np.nan), (0, 1, 0), (0, 0, 1)])
    assert caught.value.rows.tolist() == [1]
    assert Delaunay(lattice(2), method="bowyer-watson").nsimplex == 6
