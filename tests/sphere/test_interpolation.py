"""Interpolation on the sphere: at the sites, against harmonics, at the date line and the poles."""

from __future__ import annotations

import pickle
from fractions import Fraction

import numpy as np
import pytest

from delone import sphere
from delone.errors import (
    ConflictingValuesError,
    DegenerateInputError,
    DirectionError,
    DtypeError,
    InputError,
    NonFiniteError,
    ShapeError,
)
from delone.sphere import outside

SQUARE = [(-10, -10), (10, -10), (10, 10), (-10, 10)]


def scattered(count, seed=1):
    xyz = np.random.default_rng(seed).normal(size=(count, 3))
    return xyz / np.linalg.norm(xyz, axis=1, keepdims=True)


def globe(step):
    lon, lat = np.meshgrid(np.arange(-180, 180, step), np.arange(-90 + step, 90, step))
    return np.vstack((np.column_stack((lon.ravel(), lat.ravel())), [(0, -90), (0, 90)]))


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.Nearest])
@pytest.mark.parametrize("sites", [globe(15.0), scattered(300), scattered(50) * 7.3e-200])
def test_bit_for_bit_at_the_sites(kind, sites):
    values = np.random.default_rng(2).normal(size=(len(sites), 2))
    assert (kind(sites, values)(sites) == values).all()


def test_bit_for_bit_at_sites_one_centimeter_apart():
    east, north = np.meshgrid(np.arange(20), np.arange(20))
    sites = np.column_stack((179.9999999 + 9e-8 * east.ravel(), 89.9 + 9e-8 * north.ravel()))
    values = np.arange(400.0)
    assert (sphere.Linear(sites, values)(sites) == values).all()


def test_weights_are_those_of_rational_determinants():
    sites = scattered(60)
    mesh = sphere.Delaunay(xyz=sites)
    queries = scattered(100, seed=5)
    table = sphere.Linear(mesh).weights_at(queries)
    exact = [[Fraction(x) for x in p] for p in sites.tolist()]

    def det(a, b, c):
        return (
            a[0] * (b[1] * c[2] - b[2] * c[1])
            - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
        )

    for i, (query, t) in enumerate(zip(queries.tolist(), mesh.find_simplex(queries), strict=True)):
        a, b, c = mesh.simplices[t].tolist()
        q = [Fraction(x) for x in query]
        shares = (
            det(q, exact[b], exact[c]),
            det(q, exact[c], exact[a]),
            det(q, exact[a], exact[b]),
        )
        part = slice(table.indptr[i], table.indptr[i + 1])
        assert table.indices[part].tolist() == [a, b, c]
        want = [float(s / sum(shares)) for s in shares]
        np.testing.assert_allclose(table.weights[part], want, rtol=1e-10, atol=1e-15)


@pytest.mark.deep
def test_constants_and_the_order_of_linear_functions():
    queries = scattered(3000, seed=3)
    slope = np.array([1.0, -2.0, 0.5])
    errors = []
    for step in (12.0, 6.0, 3.0):
        mesh = sphere.Delaunay(lonlat=globe(step))
        fields = np.column_stack((np.full(mesh.npoints, 3.7), mesh.points @ slope))
        found = sphere.Linear(mesh, fields)(queries)
        np.testing.assert_allclose(found[:, 0], 3.7, rtol=1e-15)
        errors.append(np.abs(found[:, 1] - queries @ slope).max())
        # The point of the flat triangle is nearer to the center by at most 1 - cos(radius).
        radius = np.arccos(np.clip(mesh.circumcenters @ mesh.points.T, -1, 1)).min(axis=1).max()
        assert errors[-1] <= np.linalg.norm(slope) * (1 - np.cos(radius)) * (1 + 1e-9)
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4, rel=0.15)


def test_the_date_line_and_the_poles_are_places_like_any_other():
    mesh = sphere.Delaunay(xyz=scattered(500))
    interpolant = sphere.Linear(mesh, mesh.points[:, 0] + mesh.points[:, 2] ** 2)
    lat = np.linspace(-90, 90, 181)
    east, west = (np.column_stack((np.full(181, lon), lat)) for lon in (180.0, -180.0))
    assert (interpolant(east) == interpolant(west)).all()
    near = interpolant(east - np.array((1e-9, 0))), interpolant(west + np.array((1e-9, 0)))
    np.testing.assert_allclose(*near, atol=1e-9)
    for pole in (-90.0, 90.0):
        around = np.column_stack((np.arange(360.0), np.full(360, pole * (1 - 1e-11))))
        np.testing.assert_allclose(interpolant(around), interpolant((0, pole)), atol=1e-9)
        there = np.column_stack((np.arange(360.0), np.full(360, pole)))
        assert (interpolant(there) == interpolant((0, pole))).all()


def test_continuous_across_edges():
    mesh = sphere.Delaunay(xyz=scattered(80))
    interpolant = sphere.Linear(mesh, np.random.default_rng(4).normal(size=80))
    a, b = mesh.points[mesh.edges[:, 0]], mesh.points[mesh.edges[:, 1]]
    across = 1e-10 * np.cross(a, b)
    middle = 0.3 * a + 0.7 * b
    np.testing.assert_allclose(
        interpolant(middle + across), interpolant(middle - across), atol=1e-7
    )


def test_nearest_is_brute_force():
    sites, queries = scattered(200), scattered(500, seed=9)
    found = sphere.Nearest(sites, np.arange(200))(queries)
    assert (found == (queries @ sites.T).argmax(axis=1)).all()


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.Nearest])
def test_the_order_and_the_lengths_of_rows_do_not_matter(kind):
    rng = np.random.default_rng(6)
    sites, queries, values = scattered(200), scattered(400, seed=7), rng.normal(size=200)
    order = rng.permutation(200)
    longer = sites[order] * 2.0 ** rng.integers(-40, 40, size=(200, 1))
    again = kind(longer, values[order])(queries * 8.0)
    np.testing.assert_allclose(again, kind(sites, values)(queries), rtol=0, atol=1e-14)


def test_outside_of_a_hull():
    queries = [(0, 0), (0, 50), (180, 0), (-60, -60)]
    values = [1.0, 2.0, 3.0, 4.0]
    assert np.isnan(sphere.Linear(SQUARE, values)(queries)).tolist() == [False, True, True, True]
    found = sphere.Linear(SQUARE, values, extrapolate="nearest")(queries)
    # North of the middle of the northern edge; beyond a corner.
    assert found[1] == pytest.approx(3.5, abs=1e-12)
    assert found[3] == 1.0
    assert sphere.Nearest(SQUARE, values)((-60, -60)) == 1.0
    assert np.isnan(sphere.Nearest(SQUARE, values, extrapolate="nan")((-60, -60)))
    for kind in (sphere.Linear, sphere.Nearest):
        refusing = kind(SQUARE, values, extrapolate="raise")
        refusing([(0, 0), (float("nan"), 0)])
        with pytest.raises(InputError, match="2 of 4 queries are outside the hull: rows 1, 3"):
            refusing([(float("nan"), 0), (0, 50), (0, 0), (180, 0)])


def test_the_nearest_point_of_the_hull_is_brute_force():
    rng = np.random.default_rng(8)
    mesh = sphere.Delaunay(xyz=np.column_stack((rng.normal(size=(30, 2)), np.ones(30))))
    queries = scattered(300, seed=10)
    queries = queries[mesh.find_simplex(queries) < 0]
    place = sphere.Linear(mesh, mesh.points, extrapolate="nearest")(queries)
    place /= np.linalg.norm(place, axis=1, keepdims=True)
    share = np.linspace(0, 1, 2001)[:, None, None]
    a, b = mesh.points[mesh.boundary[:, 0]], mesh.points[mesh.boundary[:, 1]]
    samples = ((1 - share) * a + share * b).reshape(-1, 3)
    samples /= np.linalg.norm(samples, axis=1, keepdims=True)
    best = (queries @ samples.T).max(axis=1)
    found = np.einsum("kj,kj->k", queries, place)
    assert (found >= best - 1e-12).all()
    np.testing.assert_allclose(found, best, atol=1e-5)


def test_shapes_units_and_complex_values():
    values = np.arange(8.0).reshape(4, 2)
    queries = np.array([[(0, 0), (1, 2), (3, 4)], [(5, 5), (9, 9), (60, 0)]])
    interpolant = sphere.Linear(SQUARE, values)
    found = interpolant(queries)
    assert found.shape == (2, 3, 2)
    mesh = sphere.Delaunay(lonlat=np.radians(SQUARE), degrees=False)
    assert mesh.npoints == 4
    turned = sphere.Linear(mesh, values)(np.radians(queries))
    np.testing.assert_allclose(turned, found, atol=1e-13)
    as_complex = sphere.Linear(SQUARE, values[:, 0] + 1j * values[:, 1])(queries)
    np.testing.assert_array_equal(as_complex.real, found[..., 0])
    np.testing.assert_array_equal(as_complex.imag, found[..., 1])
    assert interpolant((0, 0)).shape == (2,)
    assert interpolant(np.empty((0, 2))).shape == (0, 2)
    assert np.isnan(interpolant([(0.0, 0.0, 0.0), (np.nan, 0.0, 1.0)])).all()
    again = pickle.loads(pickle.dumps(interpolant))
    np.testing.assert_array_equal(again(queries), found)
    assert repr(interpolant) == "<Linear on <Delaunay of 4 directions: 2 triangles>>"


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.Nearest])
def test_weights_serve_other_fields(kind):
    sites, queries = scattered(100), scattered(50, seed=2).reshape(5, 10, 3)
    interpolant = kind(sites)
    table = interpolant.weights_at(queries)
    for seed in (1, 2):
        field = np.random.default_rng(seed).normal(size=(100, 3))
        found = interpolant(queries, values=field)
        assert (table @ field == found).all()
        flat = np.zeros((50, 100))
        owner = np.repeat(np.arange(50), np.diff(table.indptr))
        np.add.at(flat, (owner, table.indices), table.weights)
        np.testing.assert_allclose((flat @ field).reshape(5, 10, 3), found, atol=1e-15)


def test_duplicates():
    sites = [*SQUARE, (370, 10), (-350, 10)]
    values = [0.0, 0.0, 6.0, 0.0, 6.0, 9.0]
    with (
        pytest.warns(sphere.LongitudeWarning),
        pytest.raises(ConflictingValuesError, match="rows 5 and 2") as caught,
    ):
        sphere.Linear(sites, values)
    assert caught.value.rows.tolist() == [[5, 2]]
    wanted = {"mean": 7.0, "first": 6.0, "last": 9.0, "min": 6.0, "max": 9.0}
    with pytest.warns(sphere.LongitudeWarning):
        mesh = sphere.Delaunay(lonlat=sites)
    for policy, value in wanted.items():
        for kind in (sphere.Linear, sphere.Nearest):
            interpolant = kind(mesh, values, duplicates=policy)
            assert interpolant((10, 10)) == value
            assert interpolant.weights_at((10, 10)).apply(values) == value
    last = sphere.Linear(mesh, duplicates="last").weights_at((10, 10))
    assert last.indices.tolist() == [5]


def test_the_matrix_of_duplicates():
    pytest.importorskip("scipy")
    mesh = sphere.Delaunay(xyz=[(1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 2, 0)])
    values = [3.0, 4.0, 5.0, 8.0]
    table = sphere.Linear(mesh, duplicates="mean").weights_at([(1, 2, 1), (0, 3, 0), (-1, 0, 0)])
    found = table.csr() @ values
    np.testing.assert_allclose(found, table @ values, rtol=1e-15)
    assert found[1] == 6.0


def test_values_that_are_not_finite():
    sites = globe(30.0)
    values = sites[:, 1].copy()
    values[[3, 40]] = np.nan, np.inf
    with pytest.raises(NonFiniteError) as caught:
        sphere.Linear(sites, values)
    assert caught.value.rows.tolist() == [3, 40]
    propagated = sphere.Linear(sites, values, nan="propagate")
    assert np.isnan(propagated(sites[3]))
    assert propagated(sites[5]) == values[5]
    dropped = sphere.Linear(sites, values, nan="drop")
    assert np.isfinite(dropped(sites)).all()
    assert len(dropped.triangulation.vectors) == len(sites) - 2
    some = np.delete(np.arange(len(sites)), [3, 40])
    assert (dropped(sites[some]) == values[some]).all()
    # The rows of a table are the caller's; another field has other gaps.
    table = dropped.weights_at(sites[some])
    assert table.indices.tolist() == some.tolist()
    whole = dropped(sites, values=sites[:, 1])
    assert (whole == sites[:, 1]).all()


def test_errors():
    with pytest.raises(InputError, match="no values"):
        sphere.Linear(SQUARE)((0, 0))
    with pytest.raises(InputError, match="extrapolate must be one of 'nan', 'nearest', 'raise'"):
        sphere.Linear(SQUARE, extrapolate="linear")
    with pytest.raises(InputError, match="nan must be"):
        sphere.Nearest(SQUARE, nan="omit")
    with pytest.raises(ShapeError, match="values"):
        sphere.Linear(SQUARE, [1.0, 2.0])
    with pytest.raises(ShapeError, match="points must have shape"):
        sphere.Linear([1.0, 2.0, 3.0])
    with pytest.raises(ShapeError, match="xi"):
        sphere.Linear(SQUARE, [1, 2, 3, 4])([1.0])
    with pytest.raises(DirectionError):
        sphere.Linear(SQUARE, [1, 2, 3, 4])((0, 91))
    with pytest.raises(DegenerateInputError):
        sphere.Linear([(0, 0), (1, 0), (2, 0)])
    with pytest.raises(DtypeError, match="degrees"):
        sphere.Linear(SQUARE, degrees="yes")


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.Nearest])
def test_queries_without_a_direction_leave_the_others_in_place(kind):
    interpolant = kind(SQUARE, [1.0, 2.0, 3.0, 4.0])
    found = interpolant([(np.nan, 0), SQUARE[1], (0, np.nan), SQUARE[3]])
    np.testing.assert_array_equal(found, [np.nan, 2.0, np.nan, 4.0])


def test_blocks_do_not_matter_outside_of_a_hull(monkeypatch):
    interpolant = sphere.Linear(SQUARE, [1.0, 2.0, 3.0, 4.0], extrapolate="nearest")
    queries = scattered(100)
    found = interpolant(queries)
    monkeypatch.setattr(outside, "_BLOCK", 28)
    np.testing.assert_array_equal(interpolant(queries), found)


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.NaturalNeighbor, sphere.Nearest])
def test_no_value_far_from_all_sites(kind):
    sites = scattered(60)
    queries = scattered(400, seed=7).reshape(20, 20, 3)
    made = kind(sites, np.arange(120.0).reshape(60, 2))
    far = made.distance(queries)
    limit = float(np.median(far))
    found = made(queries, max_distance=limit)
    assert (np.isnan(found) == (far > limit)[..., None]).all()
    near = far <= limit
    assert (found[near] == made(queries)[near]).all()
    # A limit is an angle, in the unit of the sites; it is part of what is kept.
    assert np.isnan(made(queries[0, 0], max_distance=far[0, 0] * 0.99)).all()
    assert np.isfinite(made(queries[0, 0], max_distance=far[0, 0])).all()
    radians = kind(sites, np.arange(60.0), degrees=False)
    assert np.isnan(radians(queries, max_distance=np.radians(limit))).sum() == (~near).sum()
    for wrong in (-1.0, np.nan):
        with pytest.raises(InputError, match="max_distance"):
            made(queries, max_distance=wrong)


def test_distances_are_from_the_sites_that_are_left():
    sites = [(0, 0), (10, 0), (10, 10), (0, 10), (5, 5)]
    made = sphere.Linear(sites, nan="drop")
    values = [1.0, 1.0, 1.0, 1.0, np.nan]
    assert made((5, 5), max_distance=1, values=np.ones(5)) == 1
    assert np.isnan(made((5, 5), max_distance=1, values=values))
    assert made((5, 5), max_distance=8, values=values) == pytest.approx(1)


@pytest.mark.parametrize("kind", [sphere.Linear, sphere.NaturalNeighbor])
def test_corners_whose_areas_underflow(kind):
    def near(tiny):
        rows = [
            (-1, 0, 0),
            (0, 1, 1),
            (0, -1, 1),
            (0, 0, -1),
            (1, 0, 0),
            (1, tiny, 0),
            (1, 0, tiny),
        ]
        return rows, (1, 0.8 * tiny, 0.1 * tiny), (1, 0.1 * tiny, 0.8 * tiny)

    values = np.arange(10.0, 17.0) ** 2
    # Weights of corners 1e-30 apart are as good as any.
    sites, first, second = near(1e-30)
    want = [0.1 * 14**2 + 0.8 * 15**2 + 0.1 * 16**2, 0.1 * 14**2 + 0.1 * 15**2 + 0.8 * 16**2]
    np.testing.assert_allclose(kind(sites, values)([first, second]), want, rtol=1e-13)
    # Where areas are below all numbers, the nearest corner.
    sites, first, second = near(1e-200)
    made = kind(sites, values)
    assert (made(sites) == values).all()
    assert made([first, second]).tolist() == [15.0**2, 16.0**2]
    table = made.weights_at([first, second])
    assert (table.indices.tolist(), table.weights.tolist()) == ([5, 6], [1.0, 1.0])
