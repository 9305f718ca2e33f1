"""Triangulations larger than what one task of any loop takes, checked by integers in NumPy.

There are two blocks from 2^13 points on, and more from 2^15; the arrays of a mesh are written in
tasks of 2^12 triangles, and the loops of the methods look at the watch every few thousand steps.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, _core
from delone.validation import validate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Integers = NDArray[np.int64]

METHODS = tuple(_core.methods2())
# Up to these no product of an in-circle determinant overflows 64 bits.
SIDE = 1 << 14


def scattered(count: int) -> Integers:
    """Points on a fine lattice with the corners of its square, and every hundredth twice."""
    dice = np.random.default_rng(count)
    corners = np.array([(0, 0), (SIDE, 0), (SIDE, SIDE), (0, SIDE)])
    points = np.concatenate([corners, dice.integers(0, SIDE + 1, (count, 2))])
    return dice.permutation(np.concatenate([points, points[::100]]))


def lattice(count: int) -> Integers:
    """Points each of which ties with others, in any order, and every hundredth twice."""
    side = int(count**0.5)
    points = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    return np.random.default_rng(count).permutation(np.concatenate([points, points[::100]]))


def cross(u: Integers, v: Integers) -> Integers:
    found: Integers = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return found


def neighbors_of(simplices: NDArray[np.int32]) -> NDArray[np.int64]:
    """The triangle across each edge, found by sorting edges."""
    m = len(simplices)
    ends = np.stack([simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]]], axis=2).reshape(-1, 2)
    key = ends.astype(np.int64) @ [1 << 32, 1]
    back = ends[:, ::-1].astype(np.int64) @ [1 << 32, 1]
    order = np.argsort(key)
    assert (np.diff(key[order]) > 0).all()
    at = np.minimum(np.searchsorted(key, back, sorter=order), 3 * m - 1)
    found = np.where(key[order[at]] == back, order[at] // 3, -1)
    return found.reshape(m, 3)


def require_canonical(points: Integers, mesh: Delaunay) -> None:
    """All that makes it the canonical triangulation of points whose hull is their box."""
    simplices, neighbors = mesh.simplices, mesh.neighbors
    assert np.array_equal(neighbors, neighbors_of(simplices))
    _, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    assert np.array_equal(mesh.duplicate_of, first[inverse.ravel()])
    assert np.array_equal(np.unique(simplices), np.sort(first))
    a, b, c = (points[simplices[:, k]] for k in range(3))
    doubled = cross(b - a, c - a)
    assert (doubled > 0).all()
    assert doubled.sum() == 2 * np.prod(np.ptp(points, axis=0))
    t, k = np.nonzero(neighbors >= 0)
    other = neighbors[t, k]
    t, k, other = t[t < other], k[t < other], other[t < other]
    u, v, p = (simplices[t, (k + j) % 3] for j in (1, 2, 0))
    q = simplices[other].sum(axis=1) - u - v
    u, v, p, q = (points[row] for row in (u, v, p, q))
    lifted = [((w - q) ** 2).sum(axis=1) for w in (u, v, p)]
    inside = (
        lifted[0] * cross(v - q, p - q)
        + lifted[1] * cross(p - q, u - q)
        + lifted[2] * cross(u - q, v - q)
    )
    assert (inside <= 0).all()
    # The edge between cocircular triangles ends in the smallest of their four vertices.
    ties = inside == 0
    u, v, p, q = (w[ties] @ [1 << 32, 1] for w in (u, v, p, q))
    assert (np.minimum(u, v) < np.minimum(p, q)).all()


@pytest.mark.parametrize("generator", [scattered, lattice])
@pytest.mark.parametrize("method", METHODS)
def test_every_method_beyond_its_tasks(method: str, generator: Any) -> None:
    points = generator(20_000)
    mesh = Delaunay(points, method=method, workers=2)
    assert mesh.nsimplex > 2 * (1 << 14)
    require_canonical(points, mesh)


@pytest.mark.parametrize("generator", [scattered, lattice])
def test_blocks(generator: Any) -> None:
    points = generator((1 << 17) + 3000)
    require_canonical(points, Delaunay(points, workers=3))


def test_blocks_of_tetrahedra() -> None:
    """A tenth of the points is in the seam of the two, whose loops have tasks of 2^14 records."""
    side = 1 << 19
    dice = np.random.default_rng(5)
    corners = np.array([(x, y, z) for x in (0, side) for y in (0, side) for z in (0, side)])
    points = np.concatenate([corners, dice.integers(0, side + 1, ((1 << 17) + 2000, 3))])
    mesh = Delaunay(points, workers=3)
    assert "seam" in dict(mesh.stages)
    simplices, neighbors = mesh.simplices, mesh.neighbors
    a, b, c, d = (points[simplices[:, k]] for k in range(4))
    sixfold = ((a - d) * np.cross(c - d, b - d)).sum(axis=1)
    assert (sixfold > 0).all()
    assert sixfold.sum() == 6 * side**3
    for k in range(4):
        beyond = neighbors[:, k]
        t = np.flatnonzero(beyond >= 0)
        theirs = simplices[beyond[t]]
        shared = [(theirs == simplices[t, j, None]).any(axis=1) for j in range(4) if j != k]
        assert np.all(shared)
        assert (neighbors[beyond[t]] == t[:, None]).any(axis=1).all()
    assert mesh.validate()


@pytest.mark.parametrize("ndim", [2, 3])
def test_faults_beyond_the_first_steps_are_found(ndim: int) -> None:
    """The last simplex is turned around, and its neighbours do not fit."""
    points = np.random.default_rng(ndim).random((20_000 if ndim == 2 else 3000, ndim))
    mesh = Delaunay(points)
    assert mesh.nsimplex > 1 << 14
    simplices = mesh.simplices.copy()
    simplices[-1, :2] = simplices[-1, 1::-1]
    report = validate(points, simplices, neighbors=mesh.neighbors)
    assert report.orientation.tolist() == [mesh.nsimplex - 1]
    neighbors = mesh.neighbors.copy()
    last = int(np.flatnonzero((neighbors >= 0).all(axis=1))[-1])
    neighbors[last, :2] = neighbors[last, 1::-1]
    report = validate(points, mesh.simplices, neighbors=neighbors)
    assert last in report.neighbors.tolist()
