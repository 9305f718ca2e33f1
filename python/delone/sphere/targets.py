"""Both sides of a regridding of xarray objects: grids, with the dimensions of fields on them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.extras import require
from delone.errors import DtypeError
from delone.sphere.formats import (
    Choices,
    describing,
    kept_of_target,
    read_cells,
    variables_of,
)
from delone.sphere.grid import Grid
from delone.sphere.named import named_grid

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Side", "side_of"]

_DIMS = {2: ("y", "x"), 3: ("face", "y", "x")}


class Side(NamedTuple):
    """A grid, and the dimensions and coordinates of fields on it."""

    grid: Grid
    # The dimensions of fields; None if the shape of each field determines them.
    dims: tuple[Any, ...] | None
    # Coordinates and other variables of results, and attributes of their fields.
    coords: dict[Any, Any]
    others: dict[Any, Any]
    attrs: dict[str, str]
    # Variables that describe the grid and are left out of results for fields on it.
    describing: frozenset[str]


def side_of(given: Any, choices: Choices, name: str) -> Side:
    """Return the side of a `Grid`, of a grid with a name, or of a dataset."""
    if isinstance(given, str):
        given = named_grid(given, workers=choices.workers)
    if isinstance(given, Grid):
        dims, coords, others = _of_grid(given)
        return Side(given, dims if name == "target" else None, coords, others, {}, frozenset())
    if not hasattr(given, "dims") and not hasattr(given, "face_node_connectivity"):
        raise DtypeError(
            f"{name} must be a sphere.Grid, an xarray dataset, or the name of a grid, got "
            f"{type(given).__name__}"
        )
    cells = read_cells(given, choices)
    grid = Grid._of_cells(cells, choices.merge, choices.workers)
    variables = variables_of(given) if hasattr(given, "dims") else {}
    names = describing(variables, cells)
    dims, coords, others = _of_grid(grid)
    attrs: dict[str, str] = {}
    if cells.dims:
        own, attrs = kept_of_target(variables, cells)
        dims, coords, others = cells.dims, {}, {}
        for key, part in variables.items():
            if key not in own and key not in (cells.coords or ()):
                continue
            # Centers are coordinates; other variables of the grid are next to the fields.
            place = coords if key in (cells.coords or ()) else others
            place[key] = (part.dims, part.values, dict(part.attrs))
        for dim in set(cells.dims) & set(variables) - set(coords):
            part = variables[str(dim)]
            coords[dim] = (part.dims, part.values, dict(part.attrs))
            others.pop(dim, None)
        if not cells.coords:
            coords |= _centers(grid, cells.dims)
    known = cells.dims or (None if name == "source" else dims)
    return Side(grid, known, coords, others, attrs, frozenset(names))


def _of_grid(grid: Grid) -> tuple[tuple[Any, ...], dict[Any, Any], dict[Any, Any]]:
    """Return dimensions, coordinates and bounds of fields on a grid."""
    if grid.bounds is None:
        shape = grid.grid_shape
        dims = _DIMS.get(len(shape), ("cell",))
        return dims, _centers(grid, dims), {}
    coords: dict[Any, Any] = {}
    others: dict[Any, Any] = {}
    for axis, (name, edges) in enumerate(zip(("lon", "lat"), grid.bounds, strict=True)):
        attrs = _attrs(axis) | {"bounds": f"{name}_bnds"}
        coords[name] = ((name,), edges[:-1] + np.diff(edges) / 2, attrs)
        others[f"{name}_bnds"] = ((name, "bnds"), np.column_stack((edges[:-1], edges[1:])), {})
    return ("lat", "lon"), coords, others


def _attrs(axis: int) -> dict[str, str]:
    word, unit = (("longitude", "degrees_east"), ("latitude", "degrees_north"))[axis]
    return {"standard_name": word, "units": unit}


def _centers(grid: Grid, dims: tuple[Any, ...]) -> dict[Any, Any]:
    """Return longitudes and latitudes of cells."""
    found: dict[Any, tuple[Any, NDArray[np.float64], dict[str, str]]] = {}
    for axis, name in enumerate(("lon", "lat")):
        if name not in dims:
            values = grid.centers_lonlat[:, axis].reshape(grid.grid_shape)
            found[name] = (dims, values, _attrs(axis))
    return found


def dataset_of(side: Side) -> Any:
    """Return a dataset with the coordinates and bounds of a side."""
    xarray = require("xarray", extra="xarray", what="a dataset of a grid")
    return xarray.Dataset(side.others, coords=side.coords)
