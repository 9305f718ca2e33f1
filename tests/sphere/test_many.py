"""Directions so many that both sides of a plane are triangulated apart and joined.

The seam is checked in integers, edge by edge; the rest is what other orders, lengths and numbers of
workers must not change.
"""

from __future__ import annotations

import numpy as np
import pytest

import directions as oracle
from delone import sphere

MANY = 20_000


def scattered(rng):
    return rng.normal(size=(MANY, 3))


def lattice(rng):
    """Many ties, points on all planes, and the same direction from different vectors."""
    vectors = rng.integers(-16, 17, (MANY, 3)).astype(float)
    return vectors[vectors.any(axis=1)]


def degrees(_):
    """A grid with poles, the date line by both names, and the equator on a plane."""
    lon, lat = np.meshgrid(np.linspace(-180, 180, 181), np.linspace(-90, 90, 101))
    return sphere.Delaunay(lonlat=np.column_stack([lon.ravel(), lat.ravel()])).vectors


def two_caps(rng):
    """Rings far from each other, with nothing between them but a few directions."""
    vectors = rng.normal(size=(MANY, 3))
    vectors[:, 2] += np.copysign(2.5, vectors[:, 2])
    return vectors


def coast(rng):
    """Half of the sphere is dense, with gaps in the other half across all planes."""
    vectors = rng.normal(size=(MANY, 3))
    x, y, z = vectors.T
    sparse = (np.sin(3 * x) + np.cos(4 * y) + z > 0.3) & (rng.random(MANY) > 0.02)
    return np.concatenate((vectors[~sparse], vectors[: MANY // 2]))


KINDS = {f.__name__: f for f in (scattered, lattice, degrees, two_caps, coast)}


def in_order(corners):
    """Triangles in one order, each from its smallest row."""
    k = corners.argmin(axis=1)
    turned = corners[np.arange(len(corners))[:, None], (k[:, None] + np.arange(3)) % 3]
    return turned[np.lexsort(turned.T[::-1])]


def rows(mesh):
    return in_order(mesh.duplicate_of[mesh.simplices])


@pytest.mark.parametrize("kind", KINDS)
def test_the_seam_is_delaunay(kind):
    rng = np.random.default_rng(3)
    mesh = sphere.Delaunay(xyz=KINDS[kind](rng))
    vectors, simplices, neighbors = mesh.vectors, mesh.simplices, mesh.neighbors
    assert mesh.covers_sphere
    assert mesh.nsimplex == 2 * (mesh.npoints - len(mesh.duplicates)) - 4
    # Each neighbor has the same edge the other way around.
    for k in range(3):
        beside = neighbors[:, k]
        back = (neighbors[beside] == np.arange(mesh.nsimplex)[:, None]).argmax(axis=1)
        ends = simplices[:, [(k + 1) % 3, (k + 2) % 3]]
        others = np.stack([simplices[beside, (back + 2) % 3], simplices[beside, (back + 1) % 3]])
        assert np.array_equal(ends, others.T)
    for axis in range(3):
        sides = vectors[simplices][:, :, axis] > 0
        crossing = np.flatnonzero(sides.any(axis=1) & ~sides.all(axis=1))
        for t in rng.choice(crossing, min(len(crossing), 250), replace=False).tolist():
            a, b, c = (oracle.whole(v) for v in vectors[simplices[t]])
            assert oracle.orient(a, b, c) > 0
            for beside in neighbors[t].tolist():
                (apex,) = set(simplices[beside].tolist()) - set(simplices[t].tolist())
                assert not oracle.is_inside(a, b, c, oracle.whole(vectors[apex]))


@pytest.mark.parametrize("kind", KINDS)
def test_order_and_lengths_of_many_do_not_matter(kind):
    rng = np.random.default_rng(4)
    vectors = KINDS[kind](rng)
    vectors = np.delete(vectors, sphere.Delaunay(xyz=vectors).duplicates[:, 0], axis=0)
    base = rows(sphere.Delaunay(xyz=vectors))
    order = rng.permutation(len(vectors))
    lengths = 2.0 ** rng.integers(-40, 40, len(vectors))[:, None]
    moved = sphere.Delaunay(xyz=(vectors * lengths)[order])
    assert len(moved.duplicates) == 0
    assert np.array_equal(in_order(order[moved.simplices]), base)


@pytest.mark.parametrize("kind", KINDS)
def test_workers_make_the_same_arrays(kind):
    vectors = KINDS[kind](np.random.default_rng(5))
    one = sphere.Delaunay(xyz=vectors, workers=1)
    for workers in (2, 3):
        other = sphere.Delaunay(xyz=vectors, workers=workers)
        for name in ("simplices", "neighbors", "duplicates"):
            assert np.array_equal(getattr(other, name), getattr(one, name)), name


def test_symmetries_move_the_triangles_along():
    # Other planes divide the directions then.
    vectors = scattered(np.random.default_rng(6)) * [1.0, 1.0, 0.25]
    base = rows(sphere.Delaunay(xyz=vectors))
    for axes in ([1, 2, 0], [2, 0, 1]):
        assert np.array_equal(rows(sphere.Delaunay(xyz=vectors[:, axes])), base)
        turned = vectors[:, axes] * [-1.0, -1.0, 1.0]
        assert np.array_equal(rows(sphere.Delaunay(xyz=turned)), base)


def test_arcs_across_the_seam():
    vectors = scattered(np.random.default_rng(7))
    ring = [(3.0, 0.5, 0.5), (-1.0, 3.0, -0.5), (-1.0, -3.0, 0.5)]
    vectors = np.concatenate((ring, vectors))
    mesh = sphere.ConstrainedDelaunay(xyz=vectors, segments=[(0, 1), (1, 2), (2, 0)])
    assert mesh.nsimplex == 2 * len(vectors) - 4
    assert int(mesh.region.max()) == 1
    again = sphere.ConstrainedDelaunay(xyz=vectors, segments=[(0, 1), (1, 2), (2, 0)], workers=2)
    assert np.array_equal(again.simplices, mesh.simplices)
    assert np.array_equal(again.constrained, mesh.constrained)


def test_rows_repeated_in_both_halves():
    vectors = scattered(np.random.default_rng(8))
    # The same vectors again backwards, the first ones in front of all.
    mesh = sphere.Delaunay(xyz=np.concatenate((vectors, vectors[::-1], vectors[::-1] * 2.0)))
    backwards = np.arange(MANY)[::-1]
    names = np.concatenate((np.arange(MANY), backwards, backwards))
    assert np.array_equal(mesh.duplicate_of, names)
    assert np.array_equal(mesh.duplicates[:, 0], np.arange(MANY, 3 * MANY))
    assert np.array_equal(rows(mesh), rows(sphere.Delaunay(xyz=vectors)))
