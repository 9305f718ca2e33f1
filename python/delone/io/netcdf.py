"""Heights on the nodes of rectilinear grids in NetCDF files and xarray objects (CF conventions).

The last two dimensions of a variable are its rows and columns, in either order; other dimensions
must have a single entry. Values are read as they are stored, so that fill values are compared
exactly.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.extras import require
from delone._base.files import reading_as, require_there
from delone.errors import FileFormatError, InputError
from delone.io.nodata import is_nodata, require_declared
from delone.io.systems import check_system

if TYPE_CHECKING:
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["Heights", "heights_of_array", "is_array", "is_netcdf", "read_heights"]

_ACROSS = {"x", "lon", "longitude", "easting", "rlon", "xc", "projection_x_coordinate"}
_UP = {"y", "lat", "latitude", "northing", "rlat", "yc", "projection_y_coordinate"}
_GLOBE = "EPSG:4326"


class Heights(NamedTuple):
    """Heights on a grid; NaN where there is none."""

    values: Floats  # (rows, columns)
    x: Floats
    y: Floats
    crs: str | None


def is_netcdf(path: Path) -> bool:
    """Return whether the suffix is a NetCDF suffix."""
    return path.suffix.lower() == ".nc"


def read_heights(  # noqa: PLR0917
    path: Path,
    name: int | str | None,
    step: int,
    box: tuple[float, ...] | None,
    nodata: float | None,
    most: int,
) -> Heights:
    """Read a variable of a file: every `step`-th row and column inside a box."""
    xarray = require("xarray", extra="xarray", what="reading NetCDF")
    require("netCDF4", extra="xarray", what="reading NetCDF")
    if name is not None and not isinstance(name, str):
        raise InputError(f"{path}: band must be the name of a variable of NetCDF, got {name!r:.40}")
    require_there(path)
    with reading_as(path, "NetCDF"):
        file = xarray.open_dataset(
            path, engine="netcdf4", mask_and_scale=False, decode_times=False, decode_coords="all"
        )
    with file, reading_as(path, "NetCDF"):
        found = _selected(_variable(file, name, path), step, box, nodata, most, str(path))
    check_system(found.crs, str(path))
    return found


def heights_of_array(
    array: Any, box: tuple[float, ...] | None = None, nodata: float | None = None
) -> Heights:
    """Return the heights of an xarray.DataArray."""
    where = "the DataArray"
    if not _is_grid(array):
        raise InputError(
            f"{where} has dimensions {tuple(map(str, array.dims))}: a raster has two, with "
            "coordinates that are numbers"
        )
    if any(array.sizes[each] > 1 for each in array.dims[:-2]):
        raise InputError(
            f"{where} has dimensions {tuple(map(str, array.dims))}: choose one raster with isel"
        )
    flat = array.isel(dict.fromkeys(array.dims[:-2], 0), drop=True)
    try:
        return _selected(flat, 1, box, nodata, None, where)
    except FileFormatError as error:
        raise InputError(str(error)) from None


def is_array(data: Any) -> bool:
    """Return whether data look like an xarray.DataArray."""
    return all(hasattr(data, each) for each in ("dims", "coords", "isel", "attrs", "sizes"))


def _selected(  # noqa: PLR0917
    variable: Any,
    step: int,
    box: tuple[float, ...] | None,
    nodata: float | None,
    most: int | None,
    where: str,
) -> Heights:
    """Return every `step`-th row and column inside a box; nothing else is loaded."""
    across, up = _axes(variable, where)
    x, y = (np.asarray(variable[axis].values, dtype=np.float64) for axis in (across, up))
    columns, rows = np.arange(0, len(x), step), np.arange(0, len(y), step)
    if box is not None:
        columns = columns[(x[columns] >= box[0]) & (x[columns] <= box[2])]
        rows = rows[(y[rows] >= box[1]) & (y[rows] <= box[3])]
        if not (len(columns) and len(rows)):
            raise InputError(f"{where}: no node is inside bounds={box}")
    if most is not None and len(columns) * len(rows) > most:
        raise FileFormatError(
            f"{where} has {len(columns) * len(rows)} nodes to read, and at most {most} are read "
            "(max_points): leave out rows and columns with step (--step), or read a part with "
            "bounds (--window)"
        )
    part = variable.isel({across: columns, up: rows}).transpose(up, across)
    values = _heights(np.asarray(part.values), variable.attrs, nodata, where)
    return Heights(values, x[columns], y[rows], _system(variable))


def _variable(file: Any, name: str | None, path: Path) -> Any:
    """Return the variable of the heights, without dimensions of one entry."""
    grids = [each for each in file.data_vars if _is_grid(file[each])]
    if name is None and len(grids) == 1:
        name = grids[0]
    if name is None or name not in file.data_vars:
        names = ", ".join(map(str, grids[:20])) or "none"
        raise FileFormatError(
            f"{path} has no variable {name!r:.80}; on grids are {names}"
            if name is not None
            else f"{path}: choose a variable with band (--layer); on grids are {names}"
        )
    found = file[name]
    if not _is_grid(found):
        raise FileFormatError(
            f"{path}: {name!r:.80} has no rows and columns with coordinates of their own, so it is "
            "not a raster; points of other grids are for delone.sphere.Grid"
        )
    longer = [str(each) for each in found.dims[:-2] if found.sizes[each] > 1]
    if longer:
        sizes = ", ".join(f"{found.sizes[each]} of {each}" for each in longer)
        chosen = ", ".join(f"{each}=0" for each in longer)
        raise FileFormatError(
            f"{path}: {name!r:.80} has {sizes}: choose one with xarray, and pass "
            f"xarray.open_dataset(path)[{name!r:.80}].isel({chosen}) to TIN.from_raster"
        )
    return found.isel(dict.fromkeys(found.dims[:-2], 0), drop=True)


def _is_grid(variable: Any) -> bool:
    return (
        variable.ndim >= 2
        and variable.dtype.kind in "fiu"
        and len(set(variable.dims)) == variable.ndim
        and all(each in variable.coords for each in variable.dims[-2:])
        and all(variable.coords[each].dtype.kind in "fiu" for each in variable.dims[-2:])
    )


def _axes(variable: Any, where: str) -> tuple[str, str]:
    """Return the dimensions of x and of y."""
    found: dict[str, list[str]] = {"X": [], "Y": []}
    for each in variable.dims:
        attributes = variable.coords[each].attrs
        words = {str(each).lower(), str(attributes.get("standard_name", "")).lower()}
        axis = str(attributes.get("axis", "")).upper()
        if axis not in found:
            axis = "X" if words & _ACROSS else "Y" if words & _UP else ""
        if axis:
            found[axis].append(each)
    if not all(len(names) == 1 for names in found.values()):
        raise FileFormatError(
            f"{where}: which of {' and '.join(map(str, variable.dims))} is x is unknown: name them "
            "x and y, lon and lat, or give them the attribute axis"
        )
    return found["X"][0], found["Y"][0]


def _heights(values: Any, attributes: Any, nodata: float | None, where: str) -> Floats:
    """Return values as heights: scaled, and NaN where there is none."""
    without = is_nodata(values, nodata)
    for name in ("_FillValue", "missing_value"):
        for number in np.atleast_1d(attributes.get(name, ())):
            without |= is_nodata(values, float(number))
    found: Floats = values.astype(np.float64)
    found[without | ~np.isfinite(found)] = np.nan
    require_declared(found[np.isfinite(found)], nodata, where)
    scale, offset = (
        float(attributes.get(name, other))
        for name, other in (("scale_factor", 1), ("add_offset", 0))
    )
    if (scale, offset) != (1, 0):
        found = found * scale + offset
    return found


def _system(array: Any) -> str | None:
    """Return the reference system of an xarray.DataArray: of its grid mapping or attributes."""
    name = array.encoding.get("grid_mapping", array.attrs.get("grid_mapping", ""))
    mappings = [name, "spatial_ref", "crs"]
    for each in mappings:
        attributes = array.coords[each].attrs if each in array.coords else {}
        for key in ("crs_wkt", "spatial_ref"):
            if isinstance(attributes.get(key), str) and attributes[key].strip():
                return _short(attributes[key])
        if "grid_mapping_name" in attributes:
            pyproj = require("pyproj", extra="geo", what="reading a reference system of NetCDF")
            try:
                return str(pyproj.CRS.from_cf(attributes).to_string())
            except (pyproj.exceptions.CRSError, ValueError, KeyError, TypeError):
                return None
    if isinstance(array.attrs.get("crs"), str):
        return str(array.attrs["crs"])
    units = {str(array.coords[each].attrs.get("units", "")) for each in array.dims[-2:]}
    return _GLOBE if units & {"degrees_east", "degree_east", "degrees_E"} else None


def _short(text: str) -> str:
    """Return authority and code of a system in WKT, if pyproj is installed and recognizes it."""
    try:
        import pyproj
    except ImportError:
        return text
    try:
        return str(pyproj.CRS.from_user_input(text).to_string())
    except (pyproj.exceptions.CRSError, ValueError):
        return text
