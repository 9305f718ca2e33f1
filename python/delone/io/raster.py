"""Raster output: GeoTIFF, NetCDF, CSV and plots.

GeoTIFF needs rasterio (extra ``raster``), NetCDF xarray (extra ``xarray``), plots matplotlib.

A raster is any object with `values` (rows, columns), `x` and `y`, with rows from the lowest to the
highest y, as `delone.interpolate.grid` returns it. Formats with another order are converted here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone._base.atomic import replacing
from delone._base.decimals import outer, spacing
from delone._base.extras import require
from delone._base.files import path_of
from delone._base.georeference import as_crs
from delone.errors import FileFormatError, InputError
from delone.io.geotiff import write_geotiff
from delone.io.pointset import names_height
from delone.io.referencing import cf_attributes, warn_if_left_out

if TYPE_CHECKING:
    import os
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["raster_suffixes", "raster_writer", "write_raster"]

# Node spacings whose relative difference is below this are equal up to rounding.
_EVEN = 1e-6


class Raster(Protocol):
    """The interface of a raster."""

    @property
    def values(self) -> NDArray[Any]:
        """Values, (rows, columns)."""

    @property
    def x(self) -> Floats:
        """Coordinates of the columns, (columns,), ascending."""

    @property
    def y(self) -> Floats:
        """Coordinates of the rows, (rows,), ascending."""


def raster_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `write_raster` writes.

    Returns
    -------
    tuple of str
        The suffixes, with the dot.

    Examples
    --------
    >>> from delone.io import raster_suffixes
    >>> ".tif" in raster_suffixes()
    True
    """
    return tuple(_WRITERS)


def write_raster(
    path: str | os.PathLike[str],
    raster: Raster,
    *,
    name: str = "z",
    crs: Any = None,
    units: str | None = None,
) -> None:
    """Write a raster to a file; the suffix determines the format.

    Parameters
    ----------
    path : str or path-like
        TIF or TIFF, NC, CSV (one line ``x,y,value`` for each node with a value), PNG or SVG. An
        existing file is replaced only once the new one is complete.
    raster : Grid
        Real values of shape (rows, columns), as `delone.interpolate.grid` returns them.
    name : str, optional
        Name of the values, in formats that store names. In plots, names of heights (z, elevation,
        depth and the like) are shaded, which changes the colors; others have the exact colors of
        the color bar.
    crs : str, int or pyproj.CRS, optional
        Coordinate reference system, for GeoTIFF, NetCDF and the labels of plots. Nothing is
        transformed.
    units : str, optional
        The units of the values, such as ``"m"``, for GeoTIFF and NetCDF.

    Warns
    -----
    CRSWarning
        `crs` is given, but the format cannot store it.

    Raises
    ------
    InputError
        `raster` is not a raster; an array without nodes, for example.
    FileFormatError
        Unknown suffix; complex values, or several values per node; cells that a GeoTIFF cannot
        represent because nodes are not evenly spaced.
    MissingExtraError
        The library for this format is not installed.
    OutputError
        The file cannot be written; it is also an OSError.

    Notes
    -----
    A GeoTIFF starts with the highest row, as is customary; NaN marks cells without a value.

    NetCDF follows the CF conventions 1.8: nodes have axes and, if `crs` is given, the standard
    names and units of its coordinates; the values have a ``grid_mapping``, a variable with the
    parameters and the WKT of the system, which requires pyproj (extra ``geo``).

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.interpolate import grid
    >>> from delone.io import write_raster
    >>> ramp = grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], resolution=2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_raster(Path(folder) / "ramp.csv", ramp)
    ...     print((Path(folder) / "ramp.csv").read_text())
    x,y,z
    1.0,1.0,2.0
    3.0,1.0,4.0
    1.0,3.0,4.0
    <BLANKLINE>
    """
    _require_raster(raster)
    write = raster_writer(path)
    system = as_crs(crs)
    warn_if_left_out(path, system, WITH_CRS)
    with replacing(path) as temporary:
        write(temporary, raster, name=name, crs=system, units=units)


def raster_writer(path: str | os.PathLike[str]) -> Callable[..., None]:
    """Return the function that writes this suffix in place, after importing its library."""
    file = path_of(path)
    if file.suffix.lower() not in _WRITERS:
        raise FileFormatError(
            f"{file}: cannot write rasters with this suffix; known are {' '.join(_WRITERS)}"
        )
    module, extra, write = _WRITERS[file.suffix.lower()]
    if module is not None:
        require(module, extra=extra, what=f"writing {file.suffix} files")
    return write


def _require_raster(raster: Any) -> None:
    """Reject objects without nodes."""
    if not all(hasattr(raster, each) for each in ("values", "x", "y")):
        kind = type(raster).__name__
        raise InputError(
            f"an object of type {kind} is not a raster, because it has no nodes: pass the "
            "result of delone.interpolate.grid, or delone.interpolate.Grid(values, x, y) with the "
            "nodes x and y, both ascending"
        )


def _checked(path: Path, raster: Raster) -> Floats:
    values = np.asarray(raster.values)
    if values.dtype.kind == "c":
        raise FileFormatError(
            f"{path}: complex values; write their real and imaginary parts separately"
        )
    if values.shape != (len(raster.y), len(raster.x)):
        raise FileFormatError(
            f"{path}: a raster file has one value per node, not of shape {values.shape[2:]}"
        )
    return values.astype(np.float64, copy=False)


def _cell(nodes: Floats, path: Path) -> float:
    """The spacing of nodes, which must be constant in a GeoTIFF."""
    if len(nodes) < 2:
        raise FileFormatError(f"{path}: a GeoTIFF needs at least two rows and two columns")
    steps = np.diff(nodes)
    step = float(spacing(nodes))
    if np.abs(steps - step).max() > _EVEN * step:
        raise FileFormatError(
            f"{path}: the cells of a GeoTIFF must have the same size; use .nc or .csv"
        )
    return step


def _write_geotiff(
    path: Path, raster: Raster, *, name: str, crs: str | None, units: str | None = None
) -> None:
    values = _checked(path, raster)
    width, height = _cell(raster.x, path), _cell(raster.y, path)
    corner = outer(raster.x)[0], outer(raster.y)[1]
    cell = width, height
    write_geotiff(path, values, corner=corner, cell=cell, name=name, crs=crs, units=units)


def _write_netcdf(
    path: Path, raster: Raster, *, name: str, crs: str | None, units: str | None = None
) -> None:
    xarray = require("xarray", extra="xarray", what="writing NetCDF files")
    values = _checked(path, raster)
    mapping, across, up = cf_attributes(crs)
    own = {"long_name": name} | ({} if units is None else {"units": units})
    where = name if name != "crs" else "values"
    data: dict[str, Any] = {where: (("y", "x"), values, own)}
    if mapping is not None:
        # A variable without dimensions; only its attributes matter.
        data["crs"] = ((), np.int32(0), mapping)
        own["grid_mapping"] = "crs"
    nodes = {"y": ("y", raster.y, up), "x": ("x", raster.x, across)}
    file = xarray.Dataset(data, coords=nodes, attrs={"Conventions": "CF-1.8"})
    plain = {"_FillValue": None}
    packed = {where: {"zlib": True, "_FillValue": np.nan}, "x": plain, "y": plain}
    try:
        file.to_netcdf(path, encoding=packed, engine="netcdf4")
    except RuntimeError as error:
        # netCDF4 reports a failed write of HDF5 only as a RuntimeError.
        raise OSError(str(error)) from error


def _write_csv(
    path: Path, raster: Raster, *, name: str, crs: str | None, units: str | None = None
) -> None:
    values = _checked(path, raster)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(f"x,y,{name}\n")
        for y, row in zip(raster.y.tolist(), values, strict=True):
            known = np.flatnonzero(np.isfinite(row))
            file.writelines(
                f"{x!r},{y!r},{z!r}\n"
                for x, z in zip(raster.x[known].tolist(), row[known].tolist(), strict=True)
            )


def _write_picture(
    path: Path, raster: Raster, *, name: str, crs: str | None, units: str | None = None
) -> None:
    from delone.plot.raster import draw_raster

    values, terrain = _checked(path, raster), names_height(name)
    draw_raster(path, values, raster.x, raster.y, label=name, shade=terrain, crs=crs)


WITH_CRS = (".tif", ".tiff", ".nc", ".png", ".svg")
_WRITERS: dict[str, tuple[str | None, str, Callable[..., None]]] = {
    **dict.fromkeys((".tif", ".tiff"), ("rasterio", "raster", _write_geotiff)),
    ".nc": ("netCDF4", "xarray", _write_netcdf),
    ".csv": (None, "", _write_csv),
    **dict.fromkeys((".png", ".svg"), ("matplotlib.figure", "plot", _write_picture)),
}
