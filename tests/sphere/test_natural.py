"""Natural neighbors and gradients on the sphere: against clipped cells, symmetries, harmonics."""

from __future__ import annotations

import numpy as np
import pytest

from delone import sphere
from delone.errors import InputError

KINDS = ("sibson", "laplace")
SQUARE = [(-10, -10), (10, -10), (10, 10), (-10, 10)]


def scattered(count, seed=1):
    xyz = np.random.default_rng(seed).normal(size=(count, 3))
    return xyz / np.linalg.norm(xyz, axis=1, keepdims=True)


def harmonic(xyz):
    x, y, z = np.asarray(xyz).T
    return 1.0 + x * y + z * (x * x - y * y) + 0.5 * (3 * z * z - 1)


def harmonic_gradient(xyz):
    """Towards east and north."""
    x, y, z = np.asarray(xyz).T
    full = np.stack((y + 2 * z * x, x - 2 * z * y, x * x - y * y + 3 * z), axis=1)
    across = np.hypot(x, y)
    east = np.stack((-y / across, x / across, 0 * x), axis=1)
    north = np.cross(xyz, east)
    return np.stack(((full * east).sum(axis=1), (full * north).sum(axis=1)), axis=1)


def clipped(polygon, normal, limit):
    """The part of a convex polygon, (k, 2), with normal . y <= limit."""
    heights = [p @ normal - limit for p in polygon]
    found = []
    for i, (p, h) in enumerate(zip(polygon, heights, strict=True)):
        q, g = polygon[i - 1], heights[i - 1]
        if (g > 0) != (h > 0):
            found.append(q + (p - q) * g / (g - h))
        if h <= 0:
            found.append(p)
    return found


def area(polygon):
    if len(polygon) < 3:
        return 0.0
    x, y = np.array(polygon).T
    return 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def cell_weights(sites, query, kind):
    """Weights from the cells of a diagram in the tangent plane, by clipping with all sites."""
    axis = np.eye(3)[np.abs(query).argmin()]
    first = np.cross(query, axis)
    first /= np.linalg.norm(first)
    plane = np.stack((first, np.cross(query, first)), axis=1)
    p, m = sites @ plane, 1 - sites @ query
    cell = [np.array(corner) * 1e3 for corner in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    for i in range(len(sites)):
        cell = clipped(cell, p[i], m[i])
    weights = np.zeros(len(sites))
    for i in range(len(sites)):
        if kind == "sibson":
            part = cell
            for j in range(len(sites)):
                if j != i:
                    part = clipped(part, p[j] - p[i], m[j] - m[i])
            weights[i] = area(part)
        else:
            on = [y for y in cell if abs(p[i] @ y - m[i]) < 1e-9]
            if len(on) > 1:
                length = max(np.linalg.norm(a - b) for a in on for b in on)
                weights[i] = length / np.linalg.norm(p[i])
    return weights / weights.sum()


def rows_of(table, count):
    flat = np.zeros((len(table), count))
    np.add.at(
        flat,
        (np.repeat(np.arange(len(table)), np.diff(table.indptr)), table.indices),
        table.weights,
    )
    return flat


@pytest.mark.parametrize("kind", KINDS)
def test_weights_are_those_of_clipped_cells(kind):
    sites, queries = scattered(40), scattered(60, seed=5)
    table = sphere.NaturalNeighbor(sites, kind=kind).weights_at(queries)
    want = [cell_weights(sites, query, kind) for query in queries]
    np.testing.assert_allclose(rows_of(table, 40), want, atol=1e-8)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("spacing", [1.0, 1e-5, 1e-9])
def test_weights_are_positive_and_center_on_the_query(kind, spacing):
    # A patch with the given spacing beside the pole, or the whole sphere.
    rng = np.random.default_rng(4)
    if spacing == 1.0:
        sites, queries = scattered(500), scattered(3000, seed=2)
    else:
        flat = rng.uniform(-20, 20, size=(3500, 2)) * spacing
        places = np.column_stack((flat, np.ones(3500)))
        sites, queries = places[:500], 0.7 * places[500:]
    mesh = sphere.Delaunay(xyz=sites)
    table = sphere.NaturalNeighbor(mesh, kind=kind).weights_at(queries)
    inside = mesh.find_simplex(queries) >= 0
    assert inside.sum() > 2500
    assert (table.weights > 0).all()
    found = rows_of(table, 500)[inside]
    np.testing.assert_allclose(found.sum(axis=1), 1, rtol=1e-14)
    units = queries[inside] / np.linalg.norm(queries[inside], axis=1, keepdims=True)
    mean = found @ mesh.points
    off = np.linalg.norm(np.cross(mean, units), axis=1)
    assert off.max() < 1e-9 * spacing + 1e-15


@pytest.mark.parametrize("kind", KINDS)
def test_bit_for_bit_at_the_sites(kind):
    values = np.random.default_rng(2).normal(size=(300, 2))
    for sites in (scattered(300), scattered(300) * 7.3e-200):
        assert (sphere.NaturalNeighbor(sites, values, kind=kind)(sites * 4.0) == values).all()
    east, north = np.meshgrid(np.arange(20), np.arange(20))
    close = np.column_stack((179.9999999 + 9e-8 * east.ravel(), 89.9 + 9e-8 * north.ravel()))
    values = np.arange(400.0)
    assert (sphere.NaturalNeighbor(close, values, kind=kind)(close) == values).all()


@pytest.mark.parametrize("kind", KINDS)
def test_symmetries_order_lengths_and_workers(kind):
    rng = np.random.default_rng(6)
    sites, queries, values = scattered(300), scattered(3000, seed=7), rng.normal(size=300)
    want = sphere.NaturalNeighbor(sites, values, kind=kind, workers=1)(queries)
    again = sphere.NaturalNeighbor(sites, values, kind=kind, workers=3)(queries)
    np.testing.assert_array_equal(again, want)
    # Each query alone: shares of the loop do not matter.
    single = sphere.NaturalNeighbor(sites, values, kind=kind)
    for i in (0, 1023, 1024, 1025, 2047, 2048, 2999):
        assert single(queries[i]) == want[i]
    order = rng.permutation(300)
    longer = sites[order] * 2.0 ** rng.integers(-40, 40, size=(300, 1))
    np.testing.assert_allclose(
        sphere.NaturalNeighbor(longer, values[order], kind=kind)(queries), want, atol=1e-12
    )
    turned = sphere.NaturalNeighbor(-sites[:, [1, 2, 0]], values, kind=kind)
    np.testing.assert_allclose(turned(-queries[:, [1, 2, 0]]), want, atol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_continuous_where_neighbors_change(kind):
    # Across edges and across the circles of triangles.
    mesh = sphere.Delaunay(xyz=scattered(80))
    interpolant = sphere.NaturalNeighbor(mesh, np.random.default_rng(4).normal(size=80), kind=kind)
    a, b = mesh.points[mesh.edges[:, 0]], mesh.points[mesh.edges[:, 1]]
    across = 1e-10 * np.cross(a, b)
    middle = 0.3 * a + 0.7 * b
    np.testing.assert_allclose(
        interpolant(middle + across), interpolant(middle - across), atol=1e-7
    )
    center, corner = mesh.circumcenters, mesh.points[mesh.simplices[:, 0]]
    side = np.cross(center, corner)
    radius = np.arccos((center * corner).sum(axis=1))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    inner, outer = (
        np.cos(angle)[:, None] * center + np.sin(angle)[:, None] * side
        for angle in (radius * (1 - 1e-10), radius * (1 + 1e-10))
    )
    np.testing.assert_allclose(interpolant(inner), interpolant(outer), atol=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_harmonics_converge(kind):
    queries = scattered(2000, seed=3)
    errors = []
    for count in (500, 2000, 8000):
        mesh = sphere.Delaunay(xyz=scattered(count))
        found = sphere.NaturalNeighbor(mesh, harmonic(mesh.points), kind=kind)(queries)
        errors.append(np.sqrt(np.mean((found - harmonic(queries)) ** 2)))
    # Spacing halves from one to the next, and errors are of second order.
    assert errors[0] / errors[1] > 3
    assert errors[1] / errors[2] > 3


@pytest.mark.parametrize("method", ["linear", *KINDS])
def test_gradients_are_slopes(method):
    mesh = sphere.Delaunay(xyz=scattered(400))
    fields = np.stack((harmonic(mesh.points), mesh.points[:, 0]), axis=1)
    kind = sphere.Linear if method == "linear" else sphere.NaturalNeighbor
    options = {} if method == "linear" else {"kind": method}
    interpolant = kind(mesh, fields, **options)
    lonlat = sphere.Delaunay(xyz=scattered(3000, seed=3)).lonlat
    lonlat = lonlat[np.abs(lonlat[:, 1]) < 89]
    found = interpolant.gradient(lonlat)
    assert found.shape == (len(lonlat), 2, 2)
    step = 1e-5
    east = np.column_stack((step / np.cos(np.radians(lonlat[:, 1])), 0 * lonlat[:, 1]))
    north = np.array((0.0, step))
    slopes = np.stack(
        [
            (interpolant(lonlat + way) - interpolant(lonlat - way)) / (2 * np.radians(step))
            for way in (east, north)
        ],
        axis=-1,
    )
    # A few queries lie so near an edge or a circle that the slope changes within the step.
    close = np.abs(found - slopes).max(axis=(1, 2)) < 1e-3
    assert close.mean() > 0.99
    np.testing.assert_allclose(found[close], slopes[close], atol=1e-3)


@pytest.mark.parametrize("method", ["linear", *KINDS])
def test_gradients_converge_and_take_a_radius(method):
    kind = sphere.Linear if method == "linear" else sphere.NaturalNeighbor
    options = {} if method == "linear" else {"kind": method}
    queries = scattered(2000, seed=3)
    want = harmonic_gradient(queries)
    errors = []
    for count in (1000, 16000):
        mesh = sphere.Delaunay(xyz=scattered(count))
        interpolant = kind(mesh, harmonic(mesh.points), **options)
        found = interpolant.gradient(queries)
        errors.append(np.median(np.abs(found - want)))
        np.testing.assert_allclose(
            interpolant.gradient(queries, radius=6371.0), found / 6371.0, rtol=1e-14
        )
        alone = interpolant.gradient(queries[1500])
        np.testing.assert_array_equal(alone, found[1500])
    assert errors[0] / errors[1] > 3


def test_gradients_at_poles_sites_and_outside():
    # f = x: towards the direction of longitude 0, seen from both poles.
    mesh = sphere.Delaunay(
        xyz=[(1, 1, 1), (-1, 1, 1), (0, -1, 1), (1, 1, -1), (-1, 1, -1), (0, -1, -1)]
    )
    linear = sphere.Linear(mesh, mesh.points[:, 0])
    for pole, sign in ((90.0, -1.0), (-90.0, 1.0)):
        east, north = linear.gradient((0, pole))
        assert np.sign(north) == sign
        assert abs(east) < 1e-15
    natural = sphere.NaturalNeighbor(SQUARE, [1.0, 2.0, 3.0, 4.0])
    assert np.isnan(natural.gradient([(10, 10), (60, 0), (np.nan, 0)])).all()
    assert np.isfinite(natural.gradient((0, 1))).all()
    for radius in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InputError, match="radius must be above 0"):
            natural.gradient((0, 1), radius=radius)


@pytest.mark.parametrize("kind", KINDS)
def test_the_boundary_of_a_hull_is_linear(kind):
    rng = np.random.default_rng(8)
    mesh = sphere.Delaunay(xyz=np.column_stack((rng.normal(size=(60, 2)), np.ones(60))))
    values = rng.normal(size=60)
    natural = sphere.NaturalNeighbor(mesh, values, kind=kind, extrapolate="nearest")
    linear = sphere.Linear(mesh, values, extrapolate="nearest")
    outside = scattered(300, seed=10)
    outside = outside[mesh.find_simplex(outside) < 0]
    np.testing.assert_array_equal(natural(outside), linear(outside))
    a, b = mesh.points[mesh.boundary[:, 0]], mesh.points[mesh.boundary[:, 1]]
    inward = np.cross(a, b)
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    for share in (0.2, 0.5, 0.9):
        on = (1 - share) * a + share * b
        np.testing.assert_allclose(natural(on + 1e-9 * inward), linear(on), atol=1e-5)
    assert np.isnan(sphere.NaturalNeighbor(mesh, values, kind=kind)(outside)).all()
    refusing = sphere.NaturalNeighbor(mesh, values, kind=kind, extrapolate="raise")
    with pytest.raises(InputError, match="outside the hull: row 1"):
        refusing([(0, 0, 1), (0, 0, -1)])


@pytest.mark.parametrize("kind", KINDS)
def test_date_line_and_poles(kind):
    mesh = sphere.Delaunay(xyz=scattered(500))
    interpolant = sphere.NaturalNeighbor(mesh, harmonic(mesh.points), kind=kind)
    lat = np.linspace(-90, 90, 181)
    east, west = (np.column_stack((np.full(181, lon), lat)) for lon in (180.0, -180.0))
    assert (interpolant(east) == interpolant(west)).all()
    for pole in (-90.0, 90.0):
        around = np.column_stack((np.arange(360.0), np.full(360, pole * (1 - 1e-11))))
        np.testing.assert_allclose(interpolant(around), interpolant((0, pole)), atol=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_policies_for_values(kind):
    sites = scattered(200)
    values = harmonic(sites)
    values[[3, 40]] = np.nan
    dropped = sphere.NaturalNeighbor(sites, values, kind=kind, nan="drop")
    assert np.isfinite(dropped(sites)).all()
    assert np.isfinite(dropped.gradient(scattered(50, seed=9))).all()
    propagated = sphere.NaturalNeighbor(sites, values, kind=kind, nan="propagate")
    assert np.isnan(propagated(sites[3]))
    assert propagated(sites[5]) == values[5]
    both = sphere.NaturalNeighbor(SQUARE, [1.0, 2.0, 3.0, 4.0], kind=kind)
    found = both([(np.nan, 0), SQUARE[1], (90, 0), (0, np.nan), SQUARE[3]])
    np.testing.assert_array_equal(found, [np.nan, 2.0, np.nan, np.nan, 4.0])
    with pytest.raises(InputError, match="kind must be one of 'sibson', 'laplace'"):
        sphere.NaturalNeighbor(SQUARE, kind="farin")
