"""Rasters to files: GeoTIFF, NetCDF, CSV and pictures.

GeoTIFF needs rasterio (extra ``raster``), NetCDF xarray (extra ``xarray``), pictures matplotlib.

A raster is anything with `values` (rows, columns), `x` and `y`, its rows from the lowest to the
highest y, as `delone.interpolate.grid` makes it. What a format orders otherwise is turned here.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone.atomic import replacing
from delone.errors import FileFormatError, InputError
from delone.extras import require
from delone.georeference import as_crs
from delone.io.geotiff import write_geotiff
from delone.io.pointset import names_height
from delone.io.referencing import cf_attributes, warn_if_left_out

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["raster_suffixes", "raster_writer", "write_raster"]

# Differences of nodes that are the same but for rounding.
_EVEN = 1e-6


class Raster(Protocol):
    """What is written."""

    @property
    def values(self) -> NDArray[Any]:
        """Values, (rows, columns)."""

    @property
    def x(self) -> Floats:
        """Abscissas, (columns,), ascending."""

    @property
    def y(self) -> Floats:
        """Ordinates, (rows,), ascending."""


def raster_suffixes() -> tuple[str, ...]:
    """Return the suffixes of the files that `write_raster` writes.

    Returns
    -------
    tuple of str
        With the dot.

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
    """Write a raster to a file; its suffix tells the format.

    Parameters
    ----------
    path : str or path-like
        TIF or TIFF, NC, CSV (one line ``x,y,value`` for each node that has a value), PNG or SVG. A
        file that is there is replaced when the new one is whole.
    raster : Grid
        Real values of shape (rows, columns), as `delone.interpolate.grid` returns them.
    name : str, optional
        What the values are called, in the formats that have names. In pictures, names of heights
        (z, elevation, depth and the like) have light and shadow, which change the colors; others
        have the colors of the color bar.
    crs : str, int or pyproj.CRS, optional
        Coordinate reference system, for GeoTIFF, NetCDF and the labels of pictures. Nothing is
        transformed.
    units : str, optional
        The unit of the values, as ``"m"``, for GeoTIFF and NetCDF.

    Warns
    -----
    CRSWarning
        `crs` is given, and the format has no place for it.

    Raises
    ------
    InputError
        `raster` is no raster, as an array without nodes is none.
    FileFormatError
        Unknown suffix; complex or several values a node; cells that a GeoTIFF cannot have, because
        nodes are not evenly spaced.
    MissingExtraError
        The library for this format is not installed.
    OutputError
        The file cannot be written; an OSError as well.

    Notes
    -----
    A GeoTIFF has its highest row first, as is customary; NaN marks cells without a value.

    NetCDF follows the CF conventions 1.8: nodes have axes and, where `crs` is given, the standard
    names and units of its coordinates; the values have a ``grid_mapping``, a variable with the
    parameters and the WKT of the system, for which pyproj (extra ``geo``) is needed.

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
    with replacing(path) as beside:
        write(beside, raster, name=name, crs=system, units=units)


def raster_writer(path: str | os.PathLike[str]) -> Callable[..., None]:
    """Return the function that writes rasters to files of this suffix, its library at hand.

    Parameters
    ----------
    path : str or path-like
        The file to be written.

    Returns
    -------
    callable
        Takes what `write_raster` takes, and writes in place.

    Raises
    ------
    FileFormatError
        Unknown suffix.
    MissingExtraError
        The library for this format is not installed.
    """
    file = Path(path)
    if file.suffix.lower() not in _WRITERS:
        raise FileFormatError(f"{file}: cannot write rasters to it; known are {' '.join(_WRITERS)}")
    module, extra, write = _WRITERS[file.suffix.lower()]
    if module is not None:
        require(module, extra=extra, what=f"writing {file.suffix} files")
    return write


def _require_raster(raster: Any) -> None:
    """Refuse what has no nodes."""
    if not all(hasattr(raster, each) for each in ("values", "x", "y")):
        kind = type(raster).__name__
        raise InputError(
            f"a {kind} is no raster, as it does not say where its nodes are: give what "
            "delone.interpolate.grid returns, or delone.interpolate.Grid(values, x, y) with the "
            "nodes x and y, both ascending"
        )


def _checked(path: Path, raster: Raster) -> Floats:
    values = np.asarray(raster.values)
    if values.dtype.kind == "c":
        raise FileFormatError(f"{path}: complex values; write their real and imaginary parts apart")
    if values.shape != (len(raster.y), len(raster.x)):
        raise FileFormatError(f"{path}: a raster has one value a node, this one {values.shape[2:]}")
    return values.astype(np.float64, copy=False)


def _cell(nodes: Floats, path: Path) -> float:
    """The distance of nodes, which a GeoTIFF wants to be the same everywhere."""
    if len(nodes) < 2:
        raise FileFormatError(f"{path}: a GeoTIFF needs two rows and two columns for its cells")
    steps = np.diff(nodes)
    step = float((nodes[-1] - nodes[0]) / (len(nodes) - 1))
    if np.abs(steps - step).max() > _EVEN * step:
        raise FileFormatError(
            f"{path}: the cells of a GeoTIFF are all of one size; use .nc or .csv"
        )
    return step


def _write_geotiff(
    path: Path, raster: Raster, *, name: str, crs: str | None, units: str | None = None
) -> None:
    values = _checked(path, raster)
    width, height = _cell(raster.x, path), _cell(raster.y, path)
    corner = float(raster.x[0] - width / 2), float(raster.y[-1] + height / 2)
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
        # A variable of no dimension, of which the attributes count alone.
        data["crs"] = ((), np.int32(0), mapping)
        own["grid_mapping"] = "crs"
    nodes = {"y": ("y", raster.y, up), "x": ("x", raster.x, across)}
    file = xarray.Dataset(data, coords=nodes, attrs={"Conventions": "CF-1.8"})
    plain = {"_FillValue": None}
    packed = {where: {"zlib": True, "_FillValue": np.nan}, "x": plain, "y": plain}
    try:
        file.to_netcdf(path, encoding=packed, engine="netcdf4")
    except RuntimeError as error:
        # What HDF5 cannot write is no more than that to netCDF4.
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
