"""Interpolants on the sphere under exact symmetries, turns about the axis, and other threads."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from delone import sphere

KINDS = {
    "linear": sphere.Linear,
    "nearest": sphere.Nearest,
    "sibson": sphere.NaturalNeighbor,
    "laplace": lambda *args, **more: sphere.NaturalNeighbor(*args, kind="laplace", **more),
}
SMOOTH = [name for name in KINDS if name != "nearest"]


def scattered(count, seed=1):
    xyz = np.random.default_rng(seed).normal(size=(count, 3))
    return xyz / np.linalg.norm(xyz, axis=1, keepdims=True)


SITES, QUERIES = scattered(150), scattered(300, seed=2)
VALUES = np.random.default_rng(3).normal(size=150)
# Axes permuted and negated: the 48 symmetries of the cube, whose half are mirrors.
TURNS = [
    (list(axes), np.array(signs))
    for axes in itertools.permutations(range(3))
    for signs in itertools.product((1.0, -1.0), repeat=3)
]


def turned(vectors, turn):
    axes, signs = turn
    return vectors[..., axes] * signs


@pytest.mark.parametrize("name", KINDS)
def test_values_turn_with_the_sphere(name):
    want = KINDS[name](SITES, VALUES)(QUERIES)
    for turn in TURNS:
        found = KINDS[name](turned(SITES, turn), VALUES)(turned(QUERIES, turn))
        np.testing.assert_allclose(found, want, rtol=0, atol=1e-11)


@pytest.mark.parametrize("name", SMOOTH)
def test_gradients_turn_with_the_sphere(name):
    want = KINDS[name](SITES, VALUES).gradient(QUERIES)
    length = np.linalg.norm(want, axis=-1)
    for turn in TURNS:
        found = KINDS[name](turned(SITES, turn), VALUES).gradient(turned(QUERIES, turn))
        np.testing.assert_allclose(np.linalg.norm(found, axis=-1), length, rtol=1e-8, atol=1e-9)
        axes, signs = turn
        if axes[2] == 2:
            # North stays north or becomes south; mirrors of the meridians exchange east and west.
            east = signs[0] * signs[1] * (1 if axes[0] == 0 else -1)
            np.testing.assert_allclose(found, want * (east, signs[2]), rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("name", KINDS)
def test_a_turn_of_all_longitudes(name):
    mesh = sphere.Delaunay(xyz=SITES)
    places = mesh.lonlat
    queries = sphere.Delaunay(xyz=QUERIES).lonlat
    want = KINDS[name](places, VALUES)(queries)
    for turn in (90.0, -180.0, 360.0):
        moved = np.array([turn, 0.0])
        found = KINDS[name](places + moved, VALUES)(queries + moved)
        np.testing.assert_allclose(found, want, rtol=0, atol=1e-10)


@pytest.mark.parametrize("name", KINDS)
def test_threads_do_not_matter(name):
    sites, queries = scattered(2500, seed=4), scattered(9000, seed=5)
    values = np.column_stack((sites[:, 0], np.arange(2500.0)))
    one, three = (KINDS[name](sites, values, workers=count) for count in (1, 3))
    np.testing.assert_array_equal(one(queries), three(queries))
    np.testing.assert_array_equal(one.distance(queries), three.distance(queries))
    first, second = one.weights_at(queries), three.weights_at(queries)
    np.testing.assert_array_equal(first.indptr, second.indptr)
    np.testing.assert_array_equal(first.indices, second.indices)
    np.testing.assert_array_equal(first.weights, second.weights)
    np.testing.assert_array_equal(first @ values, one(queries))
    # Queries do not depend on those beside them.
    some = np.array([0, 1, 1023, 1024, 4095, 4096, 8191, 8192, 8999])
    np.testing.assert_array_equal(one(queries[some]), one(queries)[some])
    if name != "nearest":
        np.testing.assert_array_equal(one.gradient(queries), three.gradient(queries))


@pytest.mark.parametrize("name", SMOOTH)
def test_harmonics_of_each_degree_converge(name):
    queries = scattered(1500, seed=6)

    def harmonic(xyz, degree):
        # The real part of (x + i y)^l and the zonal one.
        x, y, z = xyz.T
        series = np.zeros(degree + 1)
        series[degree] = 1
        return ((x + 1j * y) ** degree).real + np.polynomial.legendre.legval(z, series)

    for degree in (1, 2, 4, 6):
        errors = []
        for count in (1000, 4000):
            sites = scattered(count, seed=7)
            made = KINDS[name](sites, harmonic(sites, degree))
            gap = made(queries) - harmonic(queries, degree)
            errors.append(np.sqrt(np.mean(gap**2)))
        # Edges half as long: a quarter of the error, roughly, as the sites are scattered.
        assert errors[1] < 0.35 * errors[0]
        assert errors[1] < 3e-3 * degree * (degree + 1)
