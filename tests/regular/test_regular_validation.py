"""Proofs of regular triangulations: true for what is right, false for each kind of damage."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay
from delone._tiling.plane import topology
from delone._tiling.space import topology as space
from delone.errors import DegenerateInputError
from delone.regular import RegularTriangulation
from delone.regular_validation import RegularReport, RegularSpaceReport
from lifted import regular
from rational import exact

if TYPE_CHECKING:
    from conftest import CorpusCase

DIMENSIONS = [2, 3]


def damaged(mesh: RegularTriangulation, **arrays: Any) -> RegularTriangulation:
    return RegularTriangulation._from_arrays({**mesh._arrays(), **arrays})


def with_simplices(mesh: RegularTriangulation, simplices: Any) -> RegularTriangulation:
    """Another triangulation of the same points; neighbors follow from the simplices."""
    rows = np.ascontiguousarray(simplices, dtype=np.int32)
    beyond = topology.neighbors(rows, mesh.npoints) if mesh.ndim == 2 else space.neighbors(rows)
    return damaged(mesh, simplices=rows, neighbors=beyond)


def faults(mesh: RegularTriangulation) -> set[str]:
    report = mesh.validate()
    found = {each.name for each in fields(report) if getattr(report, each.name).size}
    assert bool(report) == (not found)
    assert all(f"  {name}: " in str(report) for name in found)
    return found


def scattered(ndim: int, seed: int = 1, n: int = 60, heavy: float = 0.5) -> RegularTriangulation:
    rng = np.random.default_rng(seed)
    points = rng.random((n, ndim))
    return RegularTriangulation(points, rng.random(n) * heavy * n ** (-2 / ndim))


def lattice(ndim: int, side: int = 4) -> Any:
    axes = np.meshgrid(*[np.arange(float(side))] * ndim, indexing="ij")
    return np.stack(axes, axis=-1).reshape(-1, ndim)


def flipped(mesh: RegularTriangulation, t: int, k: int) -> Any:
    """The triangles after a flip of the edge opposite corner k of triangle t."""
    other = int(mesh.neighbors[t, k])
    j = mesh.neighbors[other].tolist().index(t)
    p, u, v = np.roll(mesh.simplices[t], -k).tolist()
    q = int(mesh.simplices[other, j])
    simplices = mesh.simplices.copy()
    simplices[t], simplices[other] = (p, u, q), (q, v, p)
    return simplices


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("heavy", [0, 0.5, 2, 20])
def test_scattered_sites_are_proven(ndim: int, heavy: float) -> None:
    mesh = scattered(ndim, n=400, heavy=heavy)
    report = mesh.validate()
    assert report, report
    assert str(report) == "a canonical regular triangulation"
    assert isinstance(report, RegularReport if ndim == 2 else RegularSpaceReport)
    assert (len(mesh.hidden) > 0) == (heavy > 0)


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("exponent", [0, 500, -500])
@pytest.mark.parametrize("most", [1, 2, 3, 6])
def test_lattices_with_ties_and_duplicates_are_proven(ndim: int, exponent: int, most: int) -> None:
    rng = np.random.default_rng(most)
    points = lattice(ndim)
    points = np.concatenate((points, points[rng.integers(0, len(points), 30)], -points[:1]))
    weights = rng.integers(0, most, len(points)).astype(float)
    # All numbers are small integers times a power of two: nothing is rounded.
    mesh = RegularTriangulation(np.ldexp(points, exponent), np.ldexp(weights, 2 * exponent))
    assert faults(mesh) == set()
    assert len(mesh.duplicate_of) == len(points) and len(mesh._duplicates)


def test_the_corpus_is_proven(corpus_case: CorpusCase) -> None:
    points = corpus_case.points[:1500]
    rng = np.random.default_rng(len(points))
    with np.errstate(over="ignore", under="ignore"):
        weights = rng.random(len(points)) * np.ptp(points / 2, axis=0).prod() * 4 / len(points)
    for each in (np.zeros(len(points)), np.where(np.isfinite(weights), weights, 1e300)):
        try:
            mesh = RegularTriangulation(points, each, planar=True)
        except DegenerateInputError:
            continue
        assert faults(mesh) == set()


@pytest.mark.parametrize("ndim", DIMENSIONS)
@pytest.mark.parametrize("seed", range(40))
@pytest.mark.sampled(22)
def test_the_verdict_is_that_of_fractions(ndim: int, seed: int) -> None:
    """Triangulations for other weights, at the weights in question."""
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 3, (8 if ndim == 3 else 9, ndim)).astype(float)
    points = np.unique(points, axis=0)
    weights = rng.integers(0, 3, len(points)).astype(float)
    sites = exact(np.column_stack((points, weights)))
    expected = regular(sites)
    verdicts = set()
    for _ in range(8):
        near = weights + rng.integers(-1, 2, len(points)) * (rng.random(len(points)) < 0.3)
        try:
            mesh = RegularTriangulation(points, near)
        except DegenerateInputError:
            continue
        found = {frozenset(row) for row in mesh.simplices.tolist()}
        report = damaged(mesh, weights=weights).validate()
        assert bool(report) == (found == expected), report
        verdicts.add(bool(report))
    assert verdicts or not expected


def test_both_verdicts_of_fractions_are_met() -> None:
    """Sites of four weights at five places: all triangulations against all weights."""
    points = np.array([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)], dtype=float)
    choices = [
        np.array([0, 0, a, b, c], dtype=float)
        for a in (0, 1)
        for b in (0, 1)
        for c in (-3, -2, -1, 0)
    ]
    meshes = [RegularTriangulation(points, weights) for weights in choices]
    wrong = set()
    for weights in choices:
        expected = regular(exact(np.column_stack((points, weights))))
        for mesh in meshes:
            found = {frozenset(row) for row in mesh.simplices.tolist()}
            names = faults(damaged(mesh, weights=weights))
            assert (not names) == (found == expected)
            wrong |= names
    assert wrong == {"delaunay", "ties", "hidden"}


def test_a_flipped_edge_is_found() -> None:
    mesh = scattered(2)
    made = 0
    for t in range(mesh.nsimplex):
        other = with_simplices(mesh, flipped(mesh, t, 0)) if mesh.neighbors[t, 0] >= 0 else mesh
        if other is not mesh and (other.areas > 0).all() and not len(other.validate().orientation):
            made += 1
            assert faults(other) == {"delaunay"}
            pair = sorted((t, int(mesh.neighbors[t, 0])))
            assert pair in np.sort(other.validate().delaunay, axis=1).tolist()
    assert made > 10


def test_the_other_diagonal_of_a_lattice_is_found() -> None:
    points = lattice(2, 5)
    mesh = RegularTriangulation(points, np.zeros(len(points)))
    # Two triangles share each diagonal; no other edge can be flipped.
    for t, k in np.argwhere(mesh.neighbors >= 0).tolist():
        u, v = np.delete(mesh.simplices[t], k)
        if (points[u] != points[v]).all():
            other = with_simplices(mesh, flipped(mesh, t, k))
            assert faults(other) == {"ties"}
            assert len(other.validate().ties) == 1


def test_the_other_diagonals_of_a_lattice_in_space_are_found() -> None:
    points = lattice(3, 3)
    mesh = RegularTriangulation(points, np.zeros(len(points)))
    # The triangulation of the mirror image, mirrored.
    mirror = RegularTriangulation(points * (-1, 1, 1), np.zeros(len(points)))
    assert faults(with_simplices(mesh, mirror.simplices[:, [1, 0, 2, 3]])) == {"ties"}


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_swapped_neighbors_are_found(ndim: int) -> None:
    mesh = scattered(ndim)
    neighbors = mesh.neighbors.copy()
    neighbors[5, [0, 1]] = neighbors[5, [1, 0]]
    assert faults(damaged(mesh, neighbors=neighbors)) >= {"neighbors"}
    assert 5 in damaged(mesh, neighbors=neighbors).validate().neighbors


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_a_vertex_that_is_hidden_is_found(ndim: int) -> None:
    mesh = scattered(ndim, heavy=1.5)
    inner = np.setdiff1d(np.unique(mesh.simplices), mesh.hull)
    assert len(mesh.hidden) and len(inner)
    for v in inner[:8].tolist():
        kept = np.setdiff1d(np.arange(mesh.npoints), v)
        rest = RegularTriangulation(mesh.points[kept], mesh.weights[kept])
        # Without this vertex others may come out of hiding; they are right.
        other = with_simplices(mesh, kept[rest.simplices])
        assert faults(other) == {"hidden"}
        assert other.validate().hidden.tolist() == [v]


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_a_corner_of_the_hull_that_is_left_out_is_found(ndim: int) -> None:
    mesh = scattered(ndim)
    v = int(mesh.hull[0])
    kept = np.setdiff1d(np.arange(mesh.npoints), v)
    rest = RegularTriangulation(mesh.points[kept], mesh.weights[kept])
    other = with_simplices(mesh, kept[rest.simplices])
    assert faults(other) == {"missing"}
    assert other.validate().missing.tolist() == [v]


def test_a_vertex_on_a_side_of_the_hull_is_judged_on_its_line() -> None:
    points = [(0, 0), (2, 0), (0, 2), (1, 0)]
    with_it = RegularTriangulation(points, [0, 0, 0, 0])
    without = RegularTriangulation(points, [0, 0, 0, -1])
    assert (with_it.nsimplex, without.nsimplex) == (2, 1)
    assert faults(damaged(without, weights=np.zeros(4))) == {"hidden"}
    # On a tie the point between the two others is hidden.
    tie = np.array([0, 0, 0, -1.0])
    assert faults(damaged(without, weights=tie)) == set()
    assert faults(damaged(with_it, weights=tie)) == {"ties"}
    assert faults(damaged(with_it, weights=tie * 2)) == {"delaunay"}


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_a_vertex_that_should_be_hidden_is_found(ndim: int) -> None:
    mesh = scattered(ndim, heavy=0)
    weights = np.zeros(mesh.npoints)
    inner = np.setdiff1d(np.arange(mesh.npoints), mesh.hull)
    weights[inner[0]] = -1.0
    assert faults(damaged(mesh, weights=weights)) == {"delaunay"}


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_rows_with_the_same_coordinates(ndim: int) -> None:
    points = np.concatenate((lattice(ndim, 3), lattice(ndim, 3)[:3], lattice(ndim, 3)[:2]))
    n = 3**ndim
    weights = np.zeros(len(points))
    weights[[n, n + 3]] = 1.0
    mesh = RegularTriangulation(points, weights)
    assert faults(mesh) == set()
    # Rows n and n + 3 stand for point 0, with one weight; rows 1, n + 1 and n + 4 are point 1.
    assert mesh._duplicates.tolist() == [[n + 1, 1], [n + 2, 2], [n + 3, n], [n + 4, 1]]
    for used, instead in [(n, 0), (n, n + 3), (1, n + 1)]:
        simplices = np.where(mesh.simplices == used, instead, mesh.simplices)
        other = damaged(mesh, simplices=simplices.astype(np.int32))
        assert "repeats" in faults(other)
        assert other.validate().repeats.tolist() == [instead]
    listed = mesh._duplicates
    for wrong, culprits in [
        (listed[:-1], [n + 4]),
        (np.concatenate((listed, [[0, n]])), [0]),
        (np.where(listed == n, 0, listed), [n + 3]),
        (listed[::-1], [n + 1, n + 2, n + 3, n + 4]),
    ]:
        other = damaged(mesh, duplicates=wrong.astype(np.int32))
        assert faults(other) == {"duplicates"}
        assert other.validate().duplicates.tolist() == culprits


@pytest.mark.parametrize("ndim", DIMENSIONS)
def test_simplices_that_do_not_tile_are_found(ndim: int) -> None:
    mesh = scattered(ndim)
    turned = mesh.simplices.copy()
    turned[3, [0, 1]] = turned[3, [1, 0]]
    report = damaged(mesh, simplices=turned).validate()
    assert report.orientation.tolist() == [3] and len(report.neighbors)
    twice = damaged(
        mesh,
        simplices=np.concatenate((mesh.simplices, mesh.simplices[:1])),
        neighbors=np.concatenate((mesh.neighbors, mesh.neighbors[:1])),
    )
    assert ("edges" if ndim == 2 else "facets") in faults(twice)
    inner = int(np.flatnonzero((mesh.neighbors >= 0).all(axis=1))[0])
    hole = with_simplices(mesh, np.delete(mesh.simplices, inner, axis=0))
    assert "hull" in faults(hole)
    none = np.empty((0, ndim + 1), dtype=np.int32)
    empty = damaged(mesh, simplices=none, neighbors=none)
    assert faults(empty) == {"missing"}
    assert len(empty.validate().missing) == mesh.npoints


def test_without_weights_it_agrees_with_the_proof_of_delaunay() -> None:
    points = np.random.default_rng(4).random((300, 2))
    mesh = Delaunay(points)
    same = RegularTriangulation(points, np.full(300, 7.0))
    wrong = flipped(same, *np.argwhere(same.neighbors >= 0)[0])
    of_points = Delaunay._from_arrays(
        {**mesh._arrays(), "simplices": wrong, "neighbors": topology.neighbors(wrong, 300)}
    ).validate()
    weighted = with_simplices(same, wrong).validate()
    for name in ("orientation", "edges", "neighbors", "hull", "delaunay", "ties", "count"):
        np.testing.assert_array_equal(getattr(of_points, name), getattr(weighted, name))
