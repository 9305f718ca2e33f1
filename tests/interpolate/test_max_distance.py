"""Values that are too far from any site: none, by the exact nearest site."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, datasets
from delone.errors import DtypeError, InputError
from delone.interpolate import Linear, Nearest, grid, interpolator
from delone.interpolate.methods import METHODS

SITES = datasets.uniform(60, seed=4)
VALUES = 2 * SITES[:, 0] - SITES[:, 1]


def nearest_distance(queries: Any, sites: Any) -> Any:
    """The distance to the nearest of all sites, one by one."""
    steps = np.asarray(queries)[..., None, :] - np.asarray(sites)
    return np.sqrt((steps**2).sum(axis=-1)).min(axis=-1)


@pytest.mark.parametrize("ndim", [2, 3])
def test_the_distance_is_that_of_the_nearest_site(ndim: int) -> None:
    sites = datasets.uniform(80, ndim=ndim)
    queries = 3 * datasets.uniform(300, seed=1, ndim=ndim).reshape(3, 100, ndim) - 1
    found = Linear(sites).distance(queries)
    assert found.shape == (3, 100)
    np.testing.assert_allclose(found, nearest_distance(queries, sites), rtol=1e-14)
    assert (Linear(sites).distance(sites) == 0).all()


def test_at_the_limit_there_is_a_value_and_an_ulp_beyond_none() -> None:
    made = Linear([(0, 0), (8, 0), (0, 8)], [0.0, 8.0, 8.0])
    assert made((3, 0), max_distance=3) == 3
    assert np.isnan(made((np.nextafter(3, 4), 0), max_distance=3))
    assert made((0, 0), max_distance=0) == 0
    assert made((3, 3), max_distance=np.inf) == 6
    # 3, 4, 5: no rounding decides.
    assert Fraction(float(made.distance((3, 4)))) == 5 - Fraction(0)
    assert made.distance([(np.nan, 0), (np.inf, 0)]).tolist() == pytest.approx(
        [np.nan, np.nan], nan_ok=True
    )
    assert np.isnan(made((1e308, -1e308), max_distance=np.inf))


@pytest.mark.parametrize("method", [*METHODS])
def test_rasters_of_all_methods(method: str) -> None:
    whole = grid(SITES, VALUES, shape=(40, 30), method=method)
    masked = grid(SITES, VALUES, shape=(40, 30), method=method, max_distance=0.06)
    far = nearest_distance(np.stack(np.meshgrid(whole.x, whole.y), axis=-1), SITES) > 0.06
    assert 0.2 < far.mean() < 0.8
    np.testing.assert_array_equal(masked.values, np.where(far, np.nan, whole.values))
    of_made = grid(interpolator(SITES, VALUES, method), shape=(40, 30), max_distance=0.06)
    np.testing.assert_array_equal(of_made.values, masked.values)


def test_extrapolation_and_several_complex_values() -> None:
    fields = np.column_stack((VALUES, 1j * VALUES))
    made = Linear(SITES, fields, extrapolate="nearest")
    queries = np.array([(1.05, 0.5), (3.0, 0.5)])
    found = made(queries, max_distance=0.3)
    assert np.isfinite(found[0]).all() and np.isnan(found[1]).all()
    assert np.isfinite(made(queries)).all()


def test_sites_that_are_dropped_do_not_count() -> None:
    values = VALUES.copy()
    values[SITES[:, 0] < 0.5] = np.nan
    query = (0.1, 0.5)
    assert Nearest(SITES, values, nan="propagate").distance(query) < 0.2
    made = Nearest(SITES, values, nan="drop")
    assert made.distance(query) == pytest.approx(nearest_distance(query, SITES[SITES[:, 0] >= 0.5]))
    assert np.isnan(made(query, max_distance=0.2))
    assert np.isfinite(made(query))
    # Another field has other sites.
    assert np.isfinite(made(query, values=VALUES, max_distance=0.2))
    assert np.isnan(Nearest(SITES, nan="drop")(query, values=values, max_distance=0.2))


def test_distances_do_not_end_at_constraints() -> None:
    comb = ConstrainedDelaunay([(0, 0), (6, 0), (6, 6), (0, 6), (3, 2)], [(0, 2)])
    assert Linear(comb).distance((3, 3.0)) == 1


@pytest.mark.parametrize("bad", [-1, np.nan, -np.inf])
def test_what_is_no_distance_is_refused(bad: float) -> None:
    with pytest.raises(InputError, match="max_distance must be at least 0"):
        grid(SITES, VALUES, shape=(2, 2), max_distance=bad)
    with pytest.raises(InputError, match="max_distance must be at least 0"):
        Linear(SITES, VALUES)((0, 0), max_distance=bad)
    with pytest.raises(DtypeError, match="max_distance must be a real number"):
        grid(SITES, VALUES, shape=(2, 2), max_distance="3")  # type: ignore[arg-type]


def test_arrays_of_xarray() -> None:
    xarray = pytest.importorskip("xarray")
    import delone.xarray  # noqa: F401 (it registers the accessors)

    x, y = SITES.T
    data = xarray.Dataset(
        {"height": (("time", "site"), [VALUES, -VALUES], {"units": "m"})},
        coords={"x": ("site", x), "y": ("site", y)},
    )
    expected = grid(SITES, VALUES, shape=(20, 10), max_distance=0.1)
    found = data.delone.grid(shape=(20, 10), max_distance=0.1).height
    assert found.dims == ("time", "y", "x") and found.attrs == {"units": "m"}
    np.testing.assert_allclose(found.values[0], expected.values, atol=1e-14)
    np.testing.assert_allclose(found.values[1], -expected.values, atol=1e-14)
    assert np.isnan(expected.values).any() and np.isfinite(expected.values).any()
    with pytest.raises(InputError, match="max_distance"):
        data.height.delone.grid(shape=(2, 2), max_distance=-1)
