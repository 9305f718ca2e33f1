"""Beyond the hull linear functions stay linear, beside sites that nearly coincide as well."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from delone import Delaunay
from delone.interpolate import Linear, NaturalNeighbor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# What rounded values leave of slopes, see NEAR and NOISY of the core.
TOLERANCE = 1e-9


def lattice(ndim: int, size: int = 3) -> Floats:
    return np.array(list(product(range(size), repeat=ndim)), dtype=float)


def plane(points: Floats) -> Floats:
    return points @ np.arange(1.0, points.shape[1] + 1) + 0.25


def check(points: Floats, queries: Floats, scale: int = 0, gap: float = np.inf) -> None:
    """Both interpolators go on as the linear function that they have inside.

    A site may have twins at the distance `gap` for its only neighbors. If they are farther than
    CLOSE of the core, its slope is theirs, with the rounding error of the values over the gap.
    """
    tolerance = TOLERANCE + (8 * np.finfo(float).eps / gap if gap > 2.0**-34 else 0)
    points = np.unique(points, axis=0)
    values, wanted = plane(points), plane(queries)
    points, queries = np.ldexp(points, scale), np.ldexp(queries, scale)
    size = max(np.abs(values).max(), np.abs(wanted).max())
    mesh = Delaunay(points)
    for interpolator in (
        Linear(mesh, values, extrapolate="linear"),
        NaturalNeighbor(mesh, values, kind="laplace", extrapolate="linear"),
    ):
        np.testing.assert_allclose(interpolator(queries), wanted, rtol=0, atol=tolerance * size)
        table = interpolator.weights_at(queries)
        np.testing.assert_allclose(table @ values, wanted, rtol=0, atol=tolerance * size)


def around(rng: np.random.Generator, ndim: int) -> Floats:
    return rng.uniform(-4, 6, (20, ndim))


@pytest.mark.parametrize("ndim", [2, 3])
def test_beside_one_site_that_comes_twice_but_for_a_rounding(ndim: int) -> None:
    for twin in lattice(ndim):
        for axis in range(ndim):
            other = twin.copy()
            other[axis] = np.nextafter(twin[axis], 9)
            check(np.vstack((lattice(ndim), other)), np.array([(5.0, 0.5, 0.5)[:ndim]]))


@pytest.mark.parametrize("ndim", [2, 3])
@example(seed=568, on_lattice=True, count=5, exponent=-52, scale=-1)
@given(
    seed=st.integers(0, 2**32 - 1),
    on_lattice=st.booleans(),
    count=st.integers(1, 12),
    exponent=st.integers(-53, -10),
    scale=st.integers(-900, 900),
)
def test_beside_twins_at_any_gap_and_scale(  # noqa: PLR0917 (what is drawn)
    ndim: int, seed: int, on_lattice: bool, count: int, exponent: int, scale: int
) -> None:
    rng = np.random.default_rng(seed)
    base = lattice(ndim) if on_lattice else rng.random((20, ndim)) * 2
    steps = np.ldexp(rng.integers(-2, 3, (count, ndim)), exponent)
    twins = base[rng.integers(len(base), size=count)]
    # Where a step is lost, the next double is taken.
    moved = np.where(twins + steps == twins, np.nextafter(twins, 9), twins + steps)
    check(np.vstack((base, moved)), around(rng, ndim), scale, 2.0**exponent)


def test_beside_several_twins_of_a_site_in_2d() -> None:
    """Some site of the hull has only neighbors within a few units in the last place."""
    rng = np.random.default_rng(579)
    base = lattice(2)
    steps = np.ldexp(rng.integers(-2, 3, (9, 2)), -53)
    twins = base[rng.integers(len(base), size=9)]
    moved = np.where(twins + steps == twins, np.nextafter(twins, 9), twins + steps)
    check(np.vstack((base, moved)), around(rng, 2))


def test_beside_clusters_of_sites_that_nearly_coincide() -> None:
    """Vertices in their middle have no other neighbors."""
    rng = np.random.default_rng(1)
    for corner in ((2.0, 2.0, 2.0), (2.0, 1.0, 1.0), (0.0, 2.0, 1.0)):
        for ndim in (2, 3):
            cluster = np.array(corner[:ndim]) + lattice(ndim) * 2.0**-50
            check(np.vstack((lattice(ndim), cluster)), around(rng, ndim))
            scattered = np.array(corner[:ndim]) + rng.normal(size=(60, ndim)) * 1e-13
            check(np.vstack((lattice(ndim), scattered)), around(rng, ndim))


def test_beside_a_fine_lattice_at_a_corner_of_the_hull() -> None:
    """Its outermost site has others only behind several rings of neighbors."""
    fine = 2.0 + lattice(2, 7) * 3e-14
    check(np.vstack((lattice(2), fine)), around(np.random.default_rng(1), 2))


@given(st.integers(0, 2**32 - 1), st.integers(-3, 0), st.integers(-3, 0))
def test_beside_needles_and_slivers(seed: int, thin: int, flat: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.random((15, 3)) * (1, 10.0**thin, 10.0**flat)
    turn = np.array([(2, -2, 1), (1, 2, 2), (2, 1, -2)]) / 3
    check(points @ turn, around(rng, 3))


def test_hubs_and_thin_sheets_have_slopes() -> None:
    """Two sites have all others of a sheet for neighbors, which hardly tell a slope across it."""
    rng = np.random.default_rng(2)
    flat = np.column_stack((rng.random((400, 2)), np.zeros(400)))
    apexes = np.array([(0.5, 0.5, 1e-6), (0.5, 0.5, -1e-6)])
    points = np.vstack((flat, apexes))
    mesh = Delaunay(points)
    assert np.diff(mesh.vertex_neighbor_vertices[0]).max() > 300
    beside = np.column_stack((rng.uniform(-2, 3, (30, 2)), np.zeros(30)))
    values = points @ (1.0, 2.0, 0.0)
    found = Linear(mesh, values, extrapolate="linear")(beside)
    np.testing.assert_allclose(found, beside @ (1.0, 2.0, 0.0), atol=1e-9)


def test_what_lies_in_one_plane_has_no_slope_across_it() -> None:
    """Where no ring of neighbors leaves the plane as far as doubles tell."""
    square = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0.5, 0.5, 1e-14)])
    height = Linear(square, square[:, 0] + 3.0, extrapolate="linear")
    np.testing.assert_allclose(height([(0.25, 0.5, 7.0), (-1.0, 0.5, 0.0)]), (3.25, 2.0), atol=1e-9)


def test_values_that_are_not_known_do_not_count_in_slopes() -> None:
    points = lattice(3)
    values = plane(points)
    values[13] = np.nan  # the middle
    beyond = np.array([(5.0, 0.5, 0.5), (-3.0, 1.5, 0.5)])
    found = Linear(points, values, extrapolate="linear", nan="propagate")(beyond)
    np.testing.assert_allclose(found, plane(beyond), atol=1e-12)


@pytest.mark.parametrize("columns", [1, 3])
def test_columns_have_slopes_of_their_own(columns: int) -> None:
    points, rng = lattice(3), np.random.default_rng(3)
    slopes = rng.normal(size=(3, columns))
    beyond = around(rng, 3)
    fields: Any = points @ slopes
    found = Linear(points, fields, extrapolate="linear")(beyond)
    np.testing.assert_allclose(found, beyond @ slopes, atol=1e-12)
