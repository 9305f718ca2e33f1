"""Periodic triangulations against plain ones of copies; against fractions where copies round."""

from __future__ import annotations

import itertools
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import Delaunay, RegularTriangulation
from delone.errors import DegenerateInputError, DtypeError, InputError, NonFiniteError
from delone.periodic import PeriodicDelaunay
from tiers import examples

Corner = tuple[int, int, int]


def normal(triangle: list[Corner]) -> frozenset[Corner]:
    """A triangle of copies as a class of translates: its least corner is not moved."""
    row, x, y = min(triangle)
    del row
    return frozenset((r, i - x, j - y) for r, i, j in triangle)


def classes(mesh: PeriodicDelaunay) -> set[frozenset[Corner]]:
    return {
        normal([(row, *offset) for row, offset in zip(rows, offsets, strict=True)])
        for rows, offsets in zip(mesh.simplices.tolist(), mesh.offsets.tolist(), strict=True)
    }


def of_copies(points: Any, periods: tuple[float | None, float | None]) -> set[frozenset[Corner]]:
    """The same from a plain triangulation of copies that are exact, two periods to each side."""
    steps = [[0] if length is None else [-2, -1, 0, 1, 2] for length in periods]
    copies = [(r, i, j) for i in steps[0] for j in steps[1] for r in range(len(points))]
    lengths = np.array([length or 0 for length in periods], dtype=float)
    at = np.array([points[r] + np.array([i, j]) * lengths for r, i, j in copies])
    mesh = Delaunay(at)
    corners = [[copies[v] for v in row] for row in mesh.simplices.tolist()]
    return {normal(c) for c in corners if any((i, j) == (0, 0) for _, i, j in c)}


SITES = st.lists(
    st.tuples(st.integers(0, 7), st.integers(0, 5)), min_size=1, max_size=14, unique=True
)


@settings(max_examples=examples(30, deep=300), deadline=None)
@given(SITES, st.sampled_from([(8, 6), (8, 8), (40, 6), (8.5, 6.25)]))
def test_triangles_are_those_of_exact_copies(
    sites: list[tuple[int, int]], periods: tuple[float, float]
) -> None:
    points = np.array(sites, dtype=float)
    mesh = PeriodicDelaunay(points, periods)
    assert classes(mesh) == of_copies(points, periods)
    assert mesh.nsimplex == 2 * len(sites) and len(mesh.edges) == 3 * len(sites)


@settings(max_examples=examples(20, deep=200), deadline=None)
@given(SITES, st.sampled_from([(8, None), (None, 6), (8.5, None), (None, 30)]))
def test_one_period_is_enough(
    sites: list[tuple[int, int]], periods: tuple[float | None, float | None]
) -> None:
    points = np.array(sites, dtype=float)
    along = 1 if periods[1] is None else 0
    if len(np.unique(points[:, along])) == 1:
        with pytest.raises(DegenerateInputError):
            PeriodicDelaunay(points, periods)
        return
    mesh = PeriodicDelaunay(points, periods)
    assert classes(mesh) == of_copies(points, periods)
    assert (mesh.neighbors < 0).any()


@pytest.mark.deep
def test_no_copy_is_in_a_circle_where_copies_are_no_doubles() -> None:
    rng = np.random.default_rng(1)
    points = rng.random((30, 2)) * [0.3, 1.1]
    periods = (0.3, 1.1)
    mesh = PeriodicDelaunay(points, periods)
    assert mesh.nsimplex == 60
    lengths = [Fraction(length) for length in periods]

    def at(row: int, offset: list[int]) -> tuple[Fraction, ...]:
        pair = zip(points[row].tolist(), offset, lengths, strict=True)
        return tuple(Fraction(x) + k * length for x, k, length in pair)

    def inside(a: Any, b: Any, c: Any, d: Any) -> Fraction:
        (ax, ay), (bx, by), (cx, cy) = ((p[0] - d[0], p[1] - d[1]) for p in (a, b, c))
        return (
            (ax * ax + ay * ay) * (bx * cy - by * cx)
            + (bx * bx + by * by) * (cx * ay - cy * ax)
            + (cx * cx + cy * cy) * (ax * by - ay * bx)
        )

    everyone = [
        at(row, [i, j]) for row in range(30) for i, j in itertools.product(range(-2, 3), repeat=2)
    ]
    area = Fraction(0)
    for rows, offsets in zip(mesh.simplices.tolist(), mesh.offsets.tolist(), strict=True):
        a, b, c = (at(row, offset) for row, offset in zip(rows, offsets, strict=True))
        twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        assert twice > 0
        area += twice / 2
        assert all(inside(a, b, c, d) <= 0 for d in everyone)
    assert area == lengths[0] * lengths[1]


def dyadic(points: Any) -> Any:
    """Points whose copies are doubles, and so are their differences."""
    return np.floor(np.asarray(points) * 2**20) / 2**20


def circle(n: int) -> Any:
    angles = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return 0.5 + 0.25 * np.column_stack((np.cos(angles), np.sin(angles)))


RNG = np.random.default_rng(5)
SETS = {
    "scattered": RNG.random((300, 2)),
    "grid": np.stack(np.meshgrid(np.arange(16), np.arange(16)), axis=-1).reshape(-1, 2) / 16,
    "ties": np.unique(RNG.integers(0, 32, (250, 2)), axis=0) / 32,
    "in one corner": RNG.random((200, 2)) / 16,
    "a hole": [p for p in RNG.random((400, 2)) if np.hypot(*(p - 0.5)) > 0.3],
    "clusters": (RNG.random((5, 1, 2)) * 0.9 + RNG.random((5, 50, 2)) / 64).reshape(-1, 2),
    "a circle": circle(200),
    "a steep line": np.column_stack((np.arange(100) / 128, np.arange(100) / 1024)),
    "a cross": np.concatenate([[(k / 64, 0.5), (0.5, k / 64)] for k in range(64)]),
    "repeated": np.tile(RNG.random((90, 2)), (3, 1)),
}


@pytest.mark.parametrize("periods", [(1.0, 1.0), (1.0, None), (None, 1.0), (1.0, 4.0)])
@pytest.mark.parametrize("kind", SETS)
def test_many_points_have_the_triangles_of_copies(
    kind: str, periods: tuple[float | None, float | None]
) -> None:
    points = dyadic(SETS[kind])
    mesh = PeriodicDelaunay(points, periods)
    distinct = np.unique(points, axis=0)
    first = np.array([np.flatnonzero((points == p).all(axis=1))[0] for p in distinct])
    expected = of_copies(points[first], periods)
    assert classes(mesh) == {normal([(int(first[r]), i, j) for r, i, j in t]) for t in expected}
    assert len(classes(mesh)) == mesh.nsimplex
    assert mesh.validate()
    assert mesh.offsets[:, 0].any() == 0
    assert (mesh.simplices[:, 0] == mesh.simplices.min(axis=1)).all()
    plain = PeriodicDelaunay(points, periods, workers=1)
    assert np.array_equal(plain.simplices, mesh.simplices)


def test_triangles_do_not_depend_on_the_order_of_rows_or_the_unit() -> None:
    rng = np.random.default_rng(8)
    points = rng.random((500, 2))
    order = rng.permutation(len(points))
    mesh = PeriodicDelaunay(points, (1, 1))
    mixed = PeriodicDelaunay(points[order], (1, 1))
    assert classes(mesh) == {
        normal([(int(order[r]), i, j) for r, i, j in t]) for t in classes(mixed)
    }
    for unit in (2.0**-900, 2.0**900):
        scaled = PeriodicDelaunay(points * unit, (unit, unit))
        assert classes(scaled) == classes(mesh)


@pytest.mark.parametrize("heavy", [0.001, 0.02, 0.5])
@pytest.mark.parametrize("periods", [(1.0, 1.0), (1.0, None)])
def test_many_weighted_points_have_the_triangles_of_copies(
    heavy: float, periods: tuple[float | None, float | None]
) -> None:
    rng = np.random.default_rng(9)
    points = dyadic(rng.random((300, 2)))
    weights = dyadic(rng.random(300) ** 8) * heavy
    steps = [[0] if length is None else [-2, -1, 0, 1, 2] for length in periods]
    copies = [(r, i, j) for i in steps[0] for j in steps[1] for r in range(len(points))]
    at = np.array([points[r] + (i, j) for r, i, j in copies])
    whole = RegularTriangulation(at, weights[[r for r, _, _ in copies]])
    corners = [[copies[v] for v in row] for row in whole.simplices.tolist()]
    expected = {normal(c) for c in corners if any((i, j) == (0, 0) for _, i, j in c)}
    mesh = PeriodicDelaunay(points, periods, weights=weights)
    assert classes(mesh) == expected
    assert mesh.validate()


@pytest.mark.parametrize("shift", [(0.25, 0.0), (-3.0, 5.5)])
def test_where_a_period_begins_does_not_matter(shift: tuple[float, float]) -> None:
    points = np.random.default_rng(5).integers(0, 32, (60, 2)) / 32
    points = np.unique(points, axis=0)
    moved = points + shift
    moved[:, 0] -= np.floor(moved[:, 0] + 0.5)

    def sizes(mesh: PeriodicDelaunay) -> list[float]:
        d = mesh.points[mesh.edges[:, 1]] + mesh.edge_offsets - mesh.points[mesh.edges[:, 0]]
        return sorted((d * d).sum(axis=1).tolist())

    assert sizes(PeriodicDelaunay(points, (1, 1))) == sizes(PeriodicDelaunay(moved, (1, 1)))


def test_neighbours_are_mutual() -> None:
    mesh = PeriodicDelaunay(np.random.default_rng(6).random((100, 2)), (1, 1))
    for t, row in enumerate(mesh.neighbors.tolist()):
        for k, other in enumerate(row):
            assert t in mesh.neighbors[other]
            edge = sorted(int(v) for v in np.delete(mesh.simplices[t], k))
            others = [sorted(np.delete(mesh.simplices[other], j).tolist()) for j in range(3)]
            assert edge in others


def test_duplicates_have_no_triangles() -> None:
    mesh = PeriodicDelaunay([(0, 0), (0.5, 0.25), (0, 0), (-0.0, 0)], (1, 1))
    assert mesh.nsimplex == 4
    assert set(mesh.simplices.reshape(-1).tolist()) == {0, 1}
    assert mesh.duplicate_of.tolist() == [0, 1, 0, 0]


def test_nothing_can_be_changed_and_it_pickles() -> None:
    mesh = PeriodicDelaunay([(0, 0), (0.5, 0.25)], (1, None))
    with pytest.raises(AttributeError):
        mesh.simplices = None  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        mesh.offsets[0] = 1
    again = pickle.loads(pickle.dumps(mesh))
    assert classes(again) == classes(mesh) and again.periods == (1, None)


@pytest.mark.parametrize(
    ("points", "periods", "message"),
    [
        ([(0, 0), (1, 0)], (1, 1), "rows 0 and 1 lie 1.0 apart in x"),
        ([(0, 0), (0.5, 3)], (1, 2), "apart in y"),
        ([(0, 0)], (None, None), "no number.*use delone.Delaunay"),
        ([(0, 0)], (0, 1), "positive"),
        ([(0, 0)], (1, np.inf), "finite"),
        ([(0, 0)], 3, "two values, each a number or None"),
        ([(0, 0)], (True, 1), "two values, each a number or None"),
    ],
)
def test_bad_periods_are_refused(points: Any, periods: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        PeriodicDelaunay(points, periods)


@pytest.mark.parametrize("name", ["periods", "periodic"])
def test_delaunay_names_the_class_that_takes_periods(name: str) -> None:
    with pytest.raises(DtypeError, match="PeriodicDelaunay"):
        Delaunay([(0, 0), (1, 0), (0, 1)], **{name: (1, None)})  # type: ignore[arg-type]


def test_workers_are_checked() -> None:
    with pytest.raises(InputError, match="workers"):
        PeriodicDelaunay([(0, 0), (0.5, 0.5)], periods=(1, 1), workers=0)
    assert PeriodicDelaunay([(0, 0), (0.5, 0.5)], periods=(1, 1), workers=2).workers == 2


def test_bad_points_are_refused() -> None:
    with pytest.raises(NonFiniteError):
        PeriodicDelaunay([(0, np.nan)], (1, 1))
    with pytest.raises(DegenerateInputError):
        PeriodicDelaunay(np.empty((0, 2)), (1, 1))
    with pytest.raises(DegenerateInputError):
        PeriodicDelaunay([(0, 0), (0.5, 0)], (1, None))


@pytest.mark.parametrize("axis", [0, 1])
def test_points_further_apart_than_any_double(axis: int) -> None:
    points = np.zeros((2, 2))
    points[:, axis], points[:, 1 - axis] = (1.79e308, -1.79e308), (0, 1)
    periods = (10.0, 10.0)
    with pytest.raises(InputError, match=r"rows 1 and 0 lie more than 1\.79\S+e\+308 apart"):
        PeriodicDelaunay(points, periods)


@pytest.mark.parametrize("periods", [(8, 6), (8, None), (None, 6)])
def test_partners_are_the_same_edge_seen_from_the_other_side(periods: Any) -> None:
    points = np.unique(np.random.default_rng(17).integers(0, 6, (25, 2)), axis=0).astype(float)
    mesh = PeriodicDelaunay(points, periods)
    partners = mesh.partners
    assert partners.shape == mesh.simplices.shape
    assert (partners < 0).any() == (None in periods)
    corners = np.dstack((mesh.simplices, mesh.offsets))
    for t, k in np.argwhere(partners >= 0).tolist():
        other, j = divmod(int(partners[t, k]), 3)
        assert mesh.neighbors[t, k] == other
        assert partners[other, j] == 3 * t + k
        # The edge of the one is that of the other turned round, and moved by whole periods.
        here, there = (
            corners[t, [(k + 1) % 3, (k + 2) % 3]],
            corners[other, [(j + 2) % 3, (j + 1) % 3]],
        )
        assert here[:, 0].tolist() == there[:, 0].tolist()
        moved = here[:, 1:] - there[:, 1:]
        assert (moved[0] == moved[1]).all()
    assert ((partners < 0) == (mesh.neighbors < 0)).all()
