"""Proofs of periodic triangulations: true for what is right, false for each kind of damage."""

from __future__ import annotations

import math
from dataclasses import fields
from fractions import Fraction
from itertools import combinations, product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from delone.errors import DegenerateInputError
from delone.periodic import PeriodicDelaunay
from lifted import regular, standing
from rational import exact

Periods = tuple[float | None, float | None]
Corner = tuple[int, int, int]
ALL: list[Periods] = [(8.0, 6.0), (8.0, None), (None, 6.0)]


def damaged(mesh: PeriodicDelaunay, **arrays: Any) -> PeriodicDelaunay:
    return PeriodicDelaunay._from_arrays({**mesh._arrays(), **arrays})


def facing(simplices: Any, offsets: Any) -> NDArray[np.int32]:
    """For the edge opposite corner k of each triangle t its reverse, as 3 t + k; -1 without one."""

    def edge(t: int, i: int, j: int) -> tuple[int, ...]:
        moved = (offsets[t, j] - offsets[t, i]).tolist()
        return int(simplices[t, i]), int(simplices[t, j]), *moved

    at = {
        edge(t, (k + 1) % 3, (k + 2) % 3): 3 * t + k
        for t in range(len(simplices))
        for k in range(3)
    }
    found = [
        at.get(edge(t, (k + 2) % 3, (k + 1) % 3), -1)
        for t in range(len(simplices))
        for k in range(3)
    ]
    return np.array(found, dtype=np.int32).reshape(-1, 3)


def with_triangles(mesh: PeriodicDelaunay, simplices: Any, offsets: Any) -> PeriodicDelaunay:
    """Other triangles of the same points; neighbors follow from them."""
    simplices, offsets = simplices.astype(np.int32), offsets - offsets[:, :1]
    partners = facing(simplices, offsets)
    return damaged(
        mesh,
        simplices=simplices,
        offsets=offsets.astype(np.int32),
        partners=partners,
        neighbors=np.where(partners < 0, -1, partners // 3).astype(np.int32),
    )


def faults(mesh: PeriodicDelaunay) -> set[str]:
    report = mesh.validate()
    found = {each.name for each in fields(report) if getattr(report, each.name).size}
    assert bool(report) == (not found)
    assert all(f"  {name}: " in str(report) for name in found)
    return found


def scattered(periods: Periods, heavy: float | None = None, n: int = 80) -> PeriodicDelaunay:
    rng = np.random.default_rng(n)
    points = rng.random((n, 2)) * (8, 6)
    weights = None if heavy is None else rng.random(n) * heavy * 48 / n
    return PeriodicDelaunay(points, periods, weights=weights)


def flipped(mesh: PeriodicDelaunay, t: int, k: int) -> tuple[Any, Any]:
    """The triangles after a flip of the edge opposite corner k of triangle t."""
    other, j = divmod(int(mesh.partners[t, k]), 3)
    rows, moved = mesh.simplices.copy(), mesh.offsets.copy()
    here, there = [(k + i) % 3 for i in range(3)], [(j + i) % 3 for i in range(3)]
    (p, u, v), (op, ou, ov) = rows[t, here], moved[t, here]
    q, oq = rows[other, there[0]], moved[other, there[0]] + ou - moved[other, there[2]]
    rows[t], rows[other] = (p, u, q), (q, v, p)
    moved[t], moved[other] = (op, ou, oq), (oq, ov, op)
    return rows, moved


def classes(mesh: PeriodicDelaunay) -> set[frozenset[Corner]]:
    return {
        normal([(row, *offset) for row, offset in zip(rows, offsets, strict=True)])
        for rows, offsets in zip(mesh.simplices.tolist(), mesh.offsets.tolist(), strict=True)
    }


def normal(triangle: list[Corner]) -> frozenset[Corner]:
    _, x, y = min(triangle)
    return frozenset((r, i - x, j - y) for r, i, j in triangle)


def by_fractions(points: Any, weights: Any, periods: Periods) -> set[frozenset[Corner]]:
    """All classes of triangles of copies that have no lifted copy below."""
    sites = exact(np.column_stack((points, weights)))
    lengths = [None if length is None else Fraction(length) for length in periods]
    steps = [[0] if length is None else [0, -1, 1, -2, 2] for length in lengths]
    moves = list(product(*steps))
    copies = [(row, *move) for move in moves for row in sorted(set(standing(sites)))]
    at = [
        (*(x + k * (length or 0) for x, k, length in zip(sites[r], (i, j), lengths, strict=False)),
         sites[r][2])
        for r, i, j in copies
    ]  # fmt: skip
    near = [c for c, (_, i, j) in enumerate(copies) if max(abs(i), abs(j)) < 2]
    own = {c for c, (_, i, j) in enumerate(copies) if (i, j) == (0, 0)}
    among = [c for c in combinations(near, 3) if own & set(c)]
    return {normal([copies[c] for c in found]) for found in regular(at, among)}


@pytest.mark.parametrize("periods", ALL)
@pytest.mark.parametrize("heavy", [None, 0, 0.5, 5])
@pytest.mark.parametrize("n", [3, 20, 500])
def test_scattered_sites_are_proven(periods: Periods, heavy: float | None, n: int) -> None:
    mesh = scattered(periods, heavy, n)
    report = mesh.validate()
    assert report, report
    assert str(report) == "a canonical periodic triangulation"


@pytest.mark.parametrize("periods", ALL)
@pytest.mark.parametrize("most", [None, 1, 3, 9])
@pytest.mark.parametrize("exponent", [0, 500, -500])
def test_lattices_with_ties_and_duplicates_are_proven(
    periods: Periods, most: int | None, exponent: int
) -> None:
    rng = np.random.default_rng(most)
    points = np.stack(np.meshgrid(np.arange(8.0), np.arange(6.0)), axis=-1).reshape(-1, 2)
    points = np.concatenate((points, points[rng.integers(0, 48, 20)]))
    weights = None
    if most is not None:
        weights = np.ldexp(rng.integers(0, most, len(points)).astype(float), 2 * exponent)
    scaled: Any = [None if length is None else math.ldexp(length, exponent) for length in periods]
    mesh = PeriodicDelaunay(np.ldexp(points, exponent), scaled, weights=weights)
    assert faults(mesh) == set()
    if most == 9:
        assert len(mesh.hidden)


@pytest.mark.parametrize("points", [[(0.5, 0.25)], [(0, 0), (0.1, 0.2)], [(1e-300, 0), (0, 1)]])
@pytest.mark.parametrize("periods", [(1.1, 1.3), (3, 1000), (1.1, None)])
def test_few_points_are_proven(points: Any, periods: Periods) -> None:
    for weights in (None, np.arange(len(points)) * 0.25):
        try:
            mesh = PeriodicDelaunay(points, periods, weights=weights)
        except DegenerateInputError:
            continue
        assert faults(mesh) == set()


def test_walks_to_hidden_points_across_many_short_periods() -> None:
    rng = np.random.default_rng(3)
    points = rng.random((60, 2)) * (1, 4000)
    mesh = PeriodicDelaunay(points, (1, 4000), weights=rng.random(60) * 9000)
    assert len(mesh.hidden) > 5
    assert faults(mesh) == set()


@pytest.mark.parametrize("periods", [(3.0, 2.0), (3.0, None), (None, 2.0), (0.1 * 30, 0.7 * 3)])
@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.sampled(4)
def test_the_verdict_is_that_of_fractions(periods: Periods, weighted: bool, seed: int) -> None:
    """Triangulations for other weights, at the weights in question."""
    rng = np.random.default_rng(seed)
    points = np.unique(rng.integers(0, 2, (4, 2)) + rng.integers(0, 2, (4, 1)) * (1, 0), axis=0)
    weights = rng.integers(0, 3, len(points)) * 0.5 if weighted else np.zeros(len(points))
    expected = by_fractions(points, weights, periods)
    met = 0
    for turn in range(6):
        shift = 0 if turn == 0 else rng.integers(-2, 3, len(points)) * 0.5
        try:
            mesh = PeriodicDelaunay(points, periods, weights=weights + shift)
        except DegenerateInputError:
            continue
        other = damaged(mesh, weights=weights if weighted else np.empty(0))
        assert bool(other.validate()) == (classes(mesh) == expected), other.validate()
        met += 1
    assert met or not expected


@pytest.mark.parametrize("periods", ALL)
@pytest.mark.parametrize("heavy", [None, 0.5])
def test_a_flipped_edge_is_found(periods: Periods, heavy: float | None) -> None:
    mesh = scattered(periods, heavy)
    made = 0
    for t in np.flatnonzero(mesh.partners[:, 0] >= 0).tolist():
        simplices, offsets = flipped(mesh, t, 0)
        if (damaged(mesh, simplices=simplices, offsets=offsets).areas <= 0).any():
            continue
        other = with_triangles(mesh, simplices, offsets)
        found = faults(other)
        if "offsets" not in found:
            assert found == {"delaunay"}
            pair = sorted((t, int(mesh.neighbors[t, 0])))
            assert pair in np.sort(other.validate().delaunay, axis=1).tolist()
            made += 1
    assert made > 10


@pytest.mark.parametrize("periods", ALL)
@pytest.mark.parametrize("heavy", [None, 0])
def test_the_other_diagonal_of_a_lattice_is_found(periods: Periods, heavy: float | None) -> None:
    points = np.stack(np.meshgrid(np.arange(8.0), np.arange(6.0)), axis=-1).reshape(-1, 2)
    weights = None if heavy is None else np.zeros(48)
    mesh = PeriodicDelaunay(points, periods, weights=weights)
    corners, made = mesh.corners, 0
    for t, k in np.argwhere(mesh.partners >= 0).tolist():
        u, v = np.delete(corners[t], k, axis=0)
        if (u != v).all():
            other = with_triangles(mesh, *flipped(mesh, t, k))
            if not len(other.validate().offsets):
                assert faults(other) == {"ties"}
                assert len(other.validate().ties) == 1
                made += 1
    assert made > 40


@pytest.mark.parametrize("periods", ALL)
def test_wrong_offsets_are_found(periods: Periods) -> None:
    mesh = scattered(periods)
    axis = 0 if periods[0] else 1
    for step in (-1, 1):
        offsets = mesh.offsets.copy()
        offsets[7, 1, axis] += step
        found = damaged(mesh, offsets=offsets).validate()
        assert 7 in found.neighbors or found.offsets.tolist() == [7]
    unmoved = int(np.flatnonzero((mesh.offsets == 0).all(axis=(1, 2)))[0])
    for corner, move in [(0, 1), (1, 2), (2, -(2**31))]:
        offsets = mesh.offsets.copy()
        offsets[unmoved, corner, axis] = move
        assert faults(damaged(mesh, offsets=offsets)) == {"offsets"}
        assert damaged(mesh, offsets=offsets).validate().offsets.tolist() == [unmoved]
    offsets = mesh.offsets.copy()
    offsets[unmoved, 1, 1 - axis] = 1
    assert faults(damaged(mesh, offsets=offsets)) & {"offsets", "neighbors"}
    if None in periods:
        assert faults(damaged(mesh, offsets=offsets)) == {"offsets"}


@pytest.mark.parametrize("periods", ALL)
def test_wrong_neighbors_and_partners_are_found(periods: Periods) -> None:
    mesh = scattered(periods)
    for name in ("neighbors", "partners"):
        wrong = getattr(mesh, name).copy()
        wrong[4, [0, 1]] = wrong[4, [1, 0]]
        other = damaged(mesh, **{name: wrong})
        assert "neighbors" in faults(other)
        assert 4 in other.validate().neighbors
    partners = mesh.partners.copy()
    t = int(np.flatnonzero((partners >= 0).all(axis=1))[0])
    partners[t, 0] = -1
    assert t in damaged(mesh, partners=partners).validate().neighbors
    neighbors = mesh.neighbors.copy()
    neighbors[t, 0] = -1
    assert faults(damaged(mesh, neighbors=neighbors, partners=partners)) >= {"neighbors", "hull"}


@pytest.mark.parametrize("periods", ALL)
def test_a_hidden_vertex_is_found(periods: Periods) -> None:
    for heavy in (None, 2.0):
        mesh = scattered(periods, heavy)
        for v in np.setdiff1d(np.unique(mesh.simplices), mesh.boundary)[:5].tolist():
            kept = np.setdiff1d(np.arange(mesh.npoints), v)
            weights = None if mesh.weights is None else mesh.weights[kept]
            rest = PeriodicDelaunay(mesh.points[kept], periods, weights=weights)
            other = with_triangles(mesh, kept[rest.simplices], rest.offsets)
            name = "missing" if heavy is None else "hidden"
            assert faults(other) == {name}
            assert getattr(other.validate(), name).tolist() == [v]


@pytest.mark.parametrize("periods", ALL[1:])
@pytest.mark.parametrize("heavy", [None, 0.5])
def test_a_strip_that_ends_too_early_is_found(periods: Periods, heavy: float | None) -> None:
    mesh = scattered(periods, heavy)
    axis = 1 if periods[1] is None else 0
    for v in (int(mesh.points[:, axis].argmin()), int(mesh.points[:, axis].argmax())):
        kept = np.setdiff1d(np.arange(mesh.npoints), v)
        weights = None if mesh.weights is None else mesh.weights[kept]
        rest = PeriodicDelaunay(mesh.points[kept], periods, weights=weights)
        other = with_triangles(mesh, kept[rest.simplices], rest.offsets)
        assert "hull" in faults(other)


@pytest.mark.parametrize("periods", ALL)
@pytest.mark.parametrize("heavy", [None, 0])
def test_two_triangulations_on_top_of_each_other_are_found(
    periods: Periods, heavy: float | None
) -> None:
    """Each point is a vertex of one of them, and all edges are locally Delaunay."""
    mesh = scattered(periods, heavy)
    axis = 1 if periods[1] is None else 0
    points = mesh.points.copy()
    points[:4, axis], points[4:8, axis] = points[:, axis].min(), points[:, axis].max()
    halves = [np.arange(k, mesh.npoints, 2) for k in range(2)]
    meshes = [PeriodicDelaunay(points[half], periods) for half in halves]
    simplices = np.concatenate(
        [half[each.simplices] for half, each in zip(halves, meshes, strict=True)]
    )
    offsets = np.concatenate([each.offsets for each in meshes])
    other = with_triangles(damaged(mesh, points=points), simplices, offsets)
    assert faults(other) == {"layers"}
    assert other.validate().layers.tolist() == [2]
    assert "triangles cover the plane 2 times" in str(other.validate())


@pytest.mark.parametrize("periods", ALL)
def test_the_same_triangles_twice_are_found(periods: Periods) -> None:
    mesh = scattered(periods)
    m = mesh.nsimplex
    again = [np.where(each < 0, -1, each + step).astype(np.int32)
             for each, step in ((mesh.neighbors, m), (mesh.partners, 3 * m))]  # fmt: skip
    other = damaged(
        mesh,
        simplices=np.concatenate((mesh.simplices, mesh.simplices)),
        offsets=np.concatenate((mesh.offsets, mesh.offsets)),
        neighbors=np.concatenate((mesh.neighbors, again[0])),
        partners=np.concatenate((mesh.partners, again[1])),
    )
    report = other.validate()
    assert faults(other) == {"layers", "count"}
    edges = 2 * len(mesh.boundary)
    assert report.count.tolist() == [2 * mesh.npoints - edges, 2 * m]


@pytest.mark.parametrize("periods", ALL)
def test_other_damage_is_found(periods: Periods) -> None:
    mesh = scattered(periods)
    rows, moved = mesh.simplices[:, [0, 2, 1]], mesh.offsets[:, [0, 2, 1]]
    assert faults(with_triangles(mesh, rows, moved)) >= {"orientation"}
    none = np.empty((0, 3), dtype=np.int32)
    empty = damaged(
        mesh, simplices=none, neighbors=none, partners=none, offsets=none.reshape(-1, 3, 2)
    )
    assert faults(empty) == {"missing", "layers"}
    kept = np.arange(mesh.nsimplex) != 9
    hole = with_triangles(mesh, mesh.simplices[kept], mesh.offsets[kept])
    assert "hull" in faults(hole)


@pytest.mark.parametrize("periods", ALL)
def test_a_row_for_which_another_one_stands_is_found(periods: Periods) -> None:
    mesh = scattered(periods)
    points = np.concatenate((mesh.points, mesh.points[:3]))
    n = mesh.npoints
    twin = PeriodicDelaunay(points, periods)
    assert faults(twin) == set()
    simplices = np.where(twin.simplices == 1, n + 1, twin.simplices)
    other = damaged(twin, simplices=simplices)
    assert faults(other) == {"repeats"}
    assert other.validate().repeats.tolist() == [n + 1]
    weights = np.zeros(n + 3)
    weights[n + 1] = 1e-9
    heavier = PeriodicDelaunay(points, periods, weights=weights)
    assert faults(heavier) == set()
    assert damaged(twin, weights=weights).validate().repeats.tolist() == [1]


@pytest.mark.parametrize("most", [None, 0.002, 0.02])
def test_hidden_rows_are_those_without_a_triangle(most: float | None) -> None:
    rng = np.random.default_rng(8)
    points = rng.random((60, 2))
    points = np.concatenate((points, points[:15]))
    weights = None if most is None else rng.random(75) * most
    mesh = PeriodicDelaunay(points, (1, 1), weights=weights)
    corners = set(mesh.simplices.ravel().tolist())
    first = mesh.duplicate_of.tolist()
    wanted = [row for row in range(75) if first[row] not in corners]
    assert mesh.hidden.tolist() == wanted
    assert bool(wanted) == (most is not None)
