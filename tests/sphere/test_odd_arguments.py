"""Arguments of grids, overlaps and weights that are nothing of the kind raise errors of delone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid, Overlaps, Weights

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

ODD: list[Any] = [
    *(None, 3, -1, 2.5, float("nan"), True, "x", b"x", 10**400, object(), [], {}, [None]),
    *([[1, 2], [3]], np.array([np.nan]), np.zeros((2, 2, 2)), np.ma.masked_all(3), len),
]
LONLAT = Grid.from_lonlat(np.arange(0, 361, 60), np.arange(-90, 91, 60))
PIXELS = Grid.from_healpix(2)
SHARED = Overlaps(LONLAT, PIXELS)
WEIGHTS = SHARED.to_weights()
FIELD = np.zeros(LONLAT.ncells)
TRIANGLE: Any = [[(0, 0), (1, 0), (1, 1)]]
PLANE = delone.Overlaps(TRIANGLE, TRIANGLE)
CORNERS = [(0, 0), (1, 0), (1, 1)]

CALLS: dict[str, Callable[[Any], object]] = {
    "lon": lambda x: Grid.from_lonlat(x, [0, 1]),
    "lat": lambda x: Grid.from_lonlat([0, 1], x),
    "corners": lambda x: Grid.from_curvilinear(np.zeros((2, 2)), x),
    "xyz": lambda x: Grid.from_mesh(x, [0, 3]),
    "starts": lambda x: Grid.from_mesh(np.eye(3), x),
    "merge": lambda x: Grid.from_mesh(np.eye(3), [0, 3], merge=x),
    "winding": lambda x: Grid.from_mesh(np.eye(3), [0, 3], winding=x),
    "degrees": lambda x: Grid.from_mesh(lonlat=CORNERS, starts=[0, 3], degrees=x),
    "workers": lambda x: Grid.from_mesh(np.eye(3), [0, 3], workers=x),
    "geometries": Grid.from_polygons,
    "diagram": Grid.from_voronoi,
    "nside": Grid.from_healpix,
    "order": lambda x: Grid.from_healpix(2, x),
    "n": Grid.from_gaussian,
    "points": lambda x: Grid.from_gaussian(1, x),
    "dataset": Grid.from_dataset,
    "source": lambda x: Overlaps(x, PIXELS),
    "target": lambda x: Overlaps(LONLAT, x),
    "method": SHARED.to_weights,
    "source_mask": lambda x: SHARED.to_weights(source_mask=x),
    "values": WEIGHTS.apply,
    "skipna": lambda x: WEIGHTS.apply(FIELD, skipna=x),
    "min_fraction": lambda x: WEIGHTS.apply(FIELD, min_fraction=x),
    "between": lambda x: Weights.between(x, PIXELS, "nearest"),
    "between target": lambda x: Weights.between(LONLAT, x, "nearest"),
    "between method": lambda x: Weights.between(LONLAT, PIXELS, x),
    "plane": lambda x: delone.Overlaps(x, TRIANGLE),
    "data": lambda x: PLANE.transfer(x, {"a": "sum"}),
    "column": lambda x: PLANE.transfer({"a": x}, {"a": "sum"}),
    "methods": lambda x: PLANE.transfer({"a": [1]}, x),
    "method of a column": lambda x: PLANE.transfer({"a": [1]}, {"a": x}),
    "table": LONLAT.to_geopandas,
    "step": lambda x: LONLAT.to_geopandas(step=x),
    "crs": lambda x: LONLAT.to_geopandas(crs=x),
}


def only_errors_of_delone(call: Callable[[Any], object]) -> None:
    refused = 0
    for given in ODD:
        try:
            call(given)
        except delone.DeloneError as error:
            assert str(error)
            refused += 1
    assert refused > len(ODD) // 2


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", CALLS)
def test_arguments(name: str) -> None:
    only_errors_of_delone(CALLS[name])


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["values", "bounds", "coast", "resolution"])
def test_options_of_plots(name: str) -> None:
    pytest.importorskip("matplotlib")
    values = {} if name == "values" else {"values": FIELD}
    only_errors_of_delone(lambda x: LONLAT.plot(**values, **{name: x}))


@pytest.mark.parametrize("name", ["name", "coords", "edges", "degrees", "infer_bounds", "cells"])
def test_options_of_datasets(name: str) -> None:
    xarray = pytest.importorskip("xarray")
    lon, lat = (
        (axis, np.arange(low, high, 30.0), {"units": unit})
        for axis, low, high, unit in (
            ("lon", 15, 360, "degrees_east"),
            ("lat", -75, 90, "degrees_north"),
        )
    )
    ds = xarray.Dataset(coords={"lon": lon, "lat": lat})
    only_errors_of_delone(lambda x: Grid.from_dataset(ds, **{"infer_bounds": True, name: x}))


def test_paths_and_grids_of_map_files(tmp_path: Path) -> None:
    pytest.importorskip("netCDF4")
    for given in (None, 3, [], b"x"):
        with pytest.raises(delone.DtypeError, match=r"^path must be a string"):
            WEIGHTS.to_netcdf(given)
        with pytest.raises(delone.DtypeError, match=r"^path must be a string"):
            SHARED.save(given)
    for odd in (3, "x", [PIXELS]):
        with pytest.raises(delone.DtypeError, match=r"^target must be a sphere\.Grid, got"):
            WEIGHTS.to_netcdf(tmp_path / "map.nc", target=odd)
