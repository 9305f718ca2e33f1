"""Vectors on the sphere: against parallel transport in 3-D, at the poles, and under rotations."""

from __future__ import annotations

import pickle
from functools import partial

import numpy as np
import pytest

from delone import sphere
from delone.errors import (
    ConflictingValuesError,
    DirectionError,
    DtypeError,
    InputError,
    NonFiniteError,
    ShapeError,
)

KINDS = {
    "linear": sphere.Linear,
    "nearest": sphere.Nearest,
    "sibson": sphere.NaturalNeighbor,
    "laplace": partial(sphere.NaturalNeighbor, kind="laplace"),
}
AXIS = np.array([6.0, 3.0, 2.0]) / 7


def scattered(count, seed=1):
    xyz = np.random.default_rng(seed).normal(size=(count, 3))
    return xyz / np.linalg.norm(xyz, axis=1, keepdims=True)


def directions(lonlat):
    lon, lat = np.radians(lonlat).T
    return np.column_stack((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))


def frames(places):
    """East and north, (2, n, 3), at unit vectors or at longitudes and latitudes."""
    if places.shape[1] == 2:
        lon, places = np.radians(places[:, 0]), directions(places)
    else:
        lon = np.arctan2(places[:, 1], places[:, 0])
    east = np.column_stack((-np.sin(lon), np.cos(lon), np.zeros(len(lon))))
    return np.stack((east, np.cross(places, east)))


def components(vectors, places):
    """Components, (n, 2), of tangent vectors at places."""
    return np.einsum("akj,kj->ka", frames(places), vectors)


def in_space(found, places):
    """Tangent vectors of components."""
    return np.einsum("akj,ka->kj", frames(places), found)


def rotation(places):
    """The components of a solid rotation about a tilted axis."""
    xyz = directions(places) if places.shape[1] == 2 else places
    return components(np.cross(AXIS, xyz), places)


def transported(v, p, q):
    """The vector of the issue: moved from p to q along the great circle."""
    return v - (q @ v) / (1 + p @ q) * (p + q)


@pytest.mark.parametrize("kind", KINDS)
def test_errors_of_a_solid_rotation_do_not_grow_towards_the_poles(kind):
    sites = scattered(4000, seed=0)
    wind = KINDS[kind](sites, rotation(sites))
    # Equal areas at each latitude: a band of half a degree is a cap at the pole.
    errors, plain = {}, {}
    for latitude in (0.0, 60.0, 80.0, 88.0, 89.5, -89.5):
        places = np.column_stack((np.linspace(-180, 179, 360), np.full(360, latitude)))
        errors[latitude] = np.abs(wind.vectors_at(places) - rotation(places)).max()
        plain[latitude] = np.abs(wind(places) - rotation(places)).max()
    limit = 0.07 if kind == "nearest" else 0.003
    assert max(errors.values()) < limit
    assert max(errors.values()) < 1.1 * errors[0.0]
    # As two fields of numbers they are wrong there.
    assert min(plain[88.0], plain[89.5], plain[-89.5]) > 0.5


@pytest.mark.parametrize("kind", KINDS)
def test_weights_of_vectors_moved_in_space(kind):
    sites, queries = scattered(150), scattered(200, seed=5)
    values = np.random.default_rng(2).normal(size=(150, 2))
    made = KINDS[kind](sites, values)
    table, vectors = made.weights_at(queries), in_space(values, sites)
    want = np.zeros((200, 3))
    for k, query in enumerate(queries):
        for entry in range(table.indptr[k], table.indptr[k + 1]):
            row = table.indices[entry]
            want[k] += table.weights[entry] * transported(vectors[row], sites[row], query)
    np.testing.assert_allclose(made.vectors_at(queries), components(want, queries), atol=1e-14)
    # Longitudes and latitudes are the same queries.
    lonlat = sphere.Delaunay(xyz=queries).lonlat
    np.testing.assert_allclose(made.vectors_at(lonlat), made.vectors_at(queries), atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_rotating_the_sphere_rotates_the_answer(kind):
    sites, queries = scattered(300), scattered(200, seed=5)
    vectors = np.cross(sites, np.random.default_rng(3).normal(size=(300, 3)))
    turn, _ = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    found = KINDS[kind](sites, components(vectors, sites)).vectors_at(queries)
    turned = sites @ turn.T
    again = KINDS[kind](turned, components(vectors @ turn.T, turned)).vectors_at(queries @ turn.T)
    want = in_space(found, queries) @ turn.T
    np.testing.assert_allclose(in_space(again, queries @ turn.T), want, atol=1e-12)


def test_a_vector_is_turned_and_never_stretched():
    # Also far beyond a hull, where the great circle to the query is long.
    sites, queries = scattered(60) + np.array((0, 0, 2)), scattered(500, seed=5)
    values = np.random.default_rng(2).normal(size=(60, 2))
    made = sphere.Nearest(sites, values)
    rows = made.weights_at(queries).indices
    assert made.distance(queries).max() > 120
    lengths = np.hypot(*made.vectors_at(queries).T)
    np.testing.assert_allclose(lengths, np.hypot(*values[rows].T), rtol=1e-14)
    units = sphere.Delaunay(xyz=sites).points
    want = [
        transported(v, units[row], q)
        for v, row, q in zip(in_space(values, units)[rows], rows, queries, strict=True)
    ]
    found = in_space(made.vectors_at(queries), queries)
    np.testing.assert_allclose(found, want, atol=1e-13)


def test_bit_for_bit_at_the_sites_poles_included():
    lon, lat = np.meshgrid(np.arange(-180, 180, 15.0), np.arange(-75, 80, 15.0))
    grid = np.column_stack((lon.ravel(), lat.ravel()))
    sites = np.vstack((grid, [(33.3, -90), (-170.1, 90)]))
    values = np.random.default_rng(2).normal(size=(len(sites), 2, 3))
    for kind in KINDS.values():
        assert (kind(sites, values).vectors_at(sites) == values).all()
    radians = np.radians(sites)
    made = sphere.Linear(radians, values, degrees=False)
    assert (made.vectors_at(radians) == values).all()


@pytest.mark.parametrize("degrees", [True, False])
def test_longitudes_of_rows_decide_at_the_poles(degrees):
    unit = 1.0 if degrees else np.pi / 180
    lon = np.arange(-180, 540, 30.0)
    for pole in (90.0, -90.0):
        there = np.column_stack((lon, np.full(len(lon), pole)))
        around = np.column_stack((lon[:12], np.full(12, 0.8 * pole)))
        made = sphere.Linear(unit * around, rotation(around), degrees=degrees)
        found = made.vectors_at(unit * there)
        # One vector in space, with components of each meridian.
        vectors = in_space(found, there)
        np.testing.assert_allclose(vectors, np.broadcast_to(vectors[0], vectors.shape), atol=1e-14)
        np.testing.assert_allclose(found, rotation(there), atol=0.05)
        # A pole as a vector has longitude 0, whatever the signs of its zeros.
        zero = made.vectors_at([(0.0, 0.0, pole), (-0.0, -0.0, pole), (-0.0, 0.0, pole)])
        np.testing.assert_array_equal(
            zero, np.broadcast_to(made.vectors_at(unit * there[6]), (3, 2))
        )
        # As a site: the value is that of the meridian of its longitude.
        row = int(np.flatnonzero(lon == 150)[0])
        sites = np.vstack((around, there[row]))
        values = np.vstack((rotation(around), rotation(there)[row]))
        near = np.column_stack((lon, np.full(len(lon), pole * (1 - 1e-9))))
        made = sphere.Linear(unit * sites, values, degrees=degrees)
        np.testing.assert_allclose(made.vectors_at(unit * near), rotation(near), atol=1e-7)
        # In a triangulation it has longitude 0.
        mesh = sphere.Delaunay(lonlat=unit * sites, degrees=degrees)
        values[-1] = rotation(np.array([(0.0, pole)]))
        made = sphere.Linear(mesh, values)
        np.testing.assert_allclose(made.vectors_at(unit * near), rotation(near), atol=1e-7)


def test_all_rows_of_a_grid_at_a_pole_are_one_vector():
    lon, lat = np.meshgrid(np.arange(0, 360, 10.0), np.arange(-90, 91, 10.0))
    sites = np.column_stack((lon.ravel(), lat.ravel()))
    values = rotation(sites)
    queries = np.column_stack((np.arange(0, 360, 7.0), np.full(52, 89.0)))
    for pole in (1, -1):
        places = queries * (1, pole)
        found = sphere.Linear(sites, duplicates="mean").vectors_at(places, values=values)
        np.testing.assert_allclose(found, rotation(places), atol=2e-3)
    first = sphere.Linear(sites, values, duplicates="first")
    np.testing.assert_allclose(first.vectors_at(places), rotation(places), atol=2e-3)
    # Quarter turns are exact, others are rounded: these rows differ in their last digits.
    with pytest.raises(ConflictingValuesError, match="choose duplicates='mean'"):
        sphere.Linear(sites).vectors_at(places, values=values)
    quarters = [(0, 90), (90, 90), (180, 90), (270, 90), (0, 0), (120, 0), (240, 0)]
    wind = [(1, 2), (2, -1), (-1, -2), (-2, 1), (0, 0), (0, 0), (0, 0)]
    np.testing.assert_allclose(
        sphere.Linear(quarters).vectors_at((90, 90), values=wind), (2, -1), rtol=1e-15
    )
    south = np.array(quarters) * (1, -1)
    wind = [(1, 2), (-2, 1), (-1, -2), (2, -1), (0, 0), (0, 0), (0, 0)]
    found = sphere.Linear(south).vectors_at([(90, -90), (0, -90)], values=wind)
    np.testing.assert_allclose(found, [(-2, 1), (1, 2)], rtol=1e-15)


def test_missing_components():
    sites = scattered(200)
    values = np.stack((rotation(sites), 2 * rotation(sites)), axis=2)
    gaps = values.copy()
    gaps[5, 0, 0] = np.nan
    gaps[[7, 8], 1, 1] = np.inf
    queries = scattered(300, seed=5)
    with pytest.raises(NonFiniteError, match="values: 3 of 200 rows"):
        sphere.Linear(sites).vectors_at(queries, values=gaps)
    kept = sphere.Linear(sites, nan="propagate").vectors_at(queries, values=gaps)
    table = sphere.Linear(sites).weights_at(queries)
    owners = np.repeat(np.arange(300), np.diff(table.indptr))
    for field, rows in ((0, [5]), (1, [7, 8])):
        lost = np.zeros(300, dtype=bool)
        lost[owners[np.isin(table.indices, rows)]] = True
        # Both components are lost, of this field alone.
        assert lost.any()
        assert (np.isnan(kept[:, :, field]) == lost[:, None]).all()
    dropped = sphere.Linear(sites, nan="drop").vectors_at(queries, values=gaps)
    held = sphere.Linear(sites, gaps, nan="drop").vectors_at(queries)
    assert (dropped == held).all()
    for field, rows in ((0, [5]), (1, [7, 8])):
        rest = np.delete(np.arange(200), rows)
        alone = sphere.Linear(sites[rest], values[rest, :, field]).vectors_at(queries)
        assert (dropped[:, :, field] == alone).all()


def test_dropped_rows_at_the_poles():
    around = [(lon, 80.0) for lon in range(0, 360, 30)]
    sites = np.array([(77.0, 90.0), (200.0, 90.0), *around])
    values = rotation(sites)
    values[0] = np.nan
    made = sphere.Linear(sites, values, nan="drop")
    near = np.array([(10.0, 89.999), (250.0, 89.999)])
    np.testing.assert_allclose(made.vectors_at(near), rotation(near), atol=1e-4)
    np.testing.assert_allclose(made.vectors_at(sites[:2]), rotation(sites[:2]), atol=1e-15)


def test_complex_components_and_shapes():
    sites, queries = scattered(100), scattered(24, seed=5).reshape(4, 6, 3)
    real = np.random.default_rng(2).normal(size=(100, 2, 5, 3))
    imaginary = np.random.default_rng(3).normal(size=(100, 2, 5, 3))
    made = sphere.NaturalNeighbor(sites)
    both = made.vectors_at(queries, values=real + 1j * imaginary)
    assert both.shape == (4, 6, 2, 5, 3) and both.dtype == np.complex128
    assert (both.real == made.vectors_at(queries, values=real)).all()
    assert (both.imag == made.vectors_at(queries, values=imaginary)).all()
    one = made.vectors_at(queries[0, 0], values=real[:, :, 0, 0].astype(np.float32))
    assert one.shape == (2,) and one.dtype == np.float64
    assert made.vectors_at(queries[:0], values=real).shape == (0, 6, 2, 5, 3)
    assert made.vectors_at(queries, values=real[:, :, :0]).shape == (4, 6, 2, 0, 3)
    gap = (real + 1j * imaginary)[:, :, 0, 0]
    gap[3, 0] = complex(np.nan, 0)
    rest = np.delete(np.arange(100), 3)
    found = sphere.Linear(sites, gap, nan="drop").vectors_at(queries)
    assert (found == sphere.Linear(sites[rest], gap[rest]).vectors_at(queries)).all()


def test_queries_without_a_direction_or_too_far():
    sites = scattered(100)
    sites = sites[sites[:, 2] > 0]
    made = sphere.Linear(sites, rotation(sites))
    found = made.vectors_at([(0, 0, 0), (np.nan, 0, 1), (0, 0, -1), (0, 0, 1), (0.1, 0.2, 1e200)])
    assert np.isnan(found[:3]).all() and np.isfinite(found[3:]).all()
    assert np.isnan(made.vectors_at([(np.nan, 90), (0, np.nan)])).all()
    near = made.vectors_at(sites[:4] + 0.01, max_distance=0.1)
    assert np.isnan(near).all()
    assert np.isfinite(made.vectors_at(sites[:4], max_distance=0.1)).all()
    beyond = sphere.Linear(sites, rotation(sites), extrapolate="nearest").vectors_at((0, -89.0))
    assert np.isfinite(beyond).all()


def test_lengths_of_vectors_do_not_matter():
    sites = scattered(80)
    values = np.random.default_rng(2).normal(size=(80, 2))
    queries = scattered(50, seed=5)
    want = sphere.Linear(sites, values).vectors_at(queries)
    for factor in (2.0**-1000, 2.0**1000):
        found = sphere.Linear(factor * sites, values).vectors_at(factor * queries)
        np.testing.assert_array_equal(found, want)


def test_mistakes_are_named():
    sites = scattered(20)
    made = sphere.Linear(sites)
    with pytest.raises(InputError, match="no values"):
        made.vectors_at((0, 0))
    for wrong in (np.zeros(20), np.zeros((20, 3)), np.zeros((2, 20))):
        with pytest.raises(ShapeError, match=r"values must have shape \(20, 2\)|\(20,\) or"):
            made.vectors_at((0, 0), values=wrong)
    with pytest.raises(DtypeError):
        made.vectors_at((0, 0), values=np.full((20, 2), "a"))
    with pytest.raises(DirectionError):
        made.vectors_at((0, 91), values=np.zeros((20, 2)))
    with pytest.raises(InputError, match="max_distance"):
        made.vectors_at((0, 0), values=np.zeros((20, 2)), max_distance=-1)
    for policy in ("min", "max"):
        with pytest.raises(InputError, match="vectors have no order; choose 'mean'"):
            sphere.Linear(sites, duplicates=policy).vectors_at((0, 0), values=np.zeros((20, 2)))
    outside = sphere.Linear(sites[sites[:, 2] > 0], extrapolate="raise")
    with pytest.raises(InputError, match="outside the hull"):
        outside.vectors_at((0, -90), values=np.zeros((outside.npoints, 2)))


def test_pickles_and_threads():
    sites = np.vstack((sphere.Delaunay(xyz=scattered(400)).lonlat, [(45.0, 90.0)]))
    values = rotation(sites)
    queries = scattered(100, seed=5)
    made = sphere.Linear(sites, values, workers=3)
    want = made.vectors_at(queries)
    assert (pickle.loads(pickle.dumps(made)).vectors_at(queries) == want).all()
    assert (sphere.Linear(sites, values, workers=1).vectors_at(queries) == want).all()


def test_many_entries_are_those_of_few():
    sites = scattered(200)
    values = np.random.default_rng(2).normal(size=(200, 2))
    made = sphere.NaturalNeighbor(sites, values)
    queries = scattered(30000, seed=5)
    found = made.vectors_at(queries)
    some = np.arange(0, 30000, 1000)
    assert (made.vectors_at(queries[some]) == found[some]).all()


def test_policies_of_interpolators_are_no_methods_of_users():
    for kind in (sphere.Linear, sphere.Nearest, sphere.NaturalNeighbor):
        public = {name for name in dir(kind) if not name.startswith("_")}
        shared = {"distance", "npoints", "triangulation", "weights_at", "workers"}
        # An old name raises an error with the new one.
        assert public - {"gradient", "weights"} == shared | {"EXTRAPOLATE", "vectors_at"}
