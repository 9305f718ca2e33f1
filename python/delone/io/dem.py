"""Rasters of heights as points: GeoTIFF and ESRI ASCII grids with rasterio, NetCDF with xarray.

Each cell with a height becomes a point at its center; GDAL converts rasters whose pixels are
points. Only the driver for the suffix may open a file, and no other file is read except the .prj
file of an ASCII grid. Sizes are checked first, and then rows are read one after another.
"""

from __future__ import annotations

import os
import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_least, as_number
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.files import path_of, reading_as, require_there
from delone._base.georeference import caller_level
from delone.errors import FileFormatError, InputError
from delone.io.companions import require_companion
from delone.io.netcdf import Heights, is_netcdf, read_heights
from delone.io.nodata import as_nodata, is_nodata, require_declared
from delone.io.pointset import PointSet
from delone.io.surfacefile import LeftOutWarning
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from delone._base.types import Floats

__all__ = ["as_bounds", "is_raster", "read_cells", "read_points", "read_raster"]

_DRIVERS = {".tif": "GTiff", ".tiff": "GTiff", ".asc": "AAIGrid"}
# A triangulation of this many points takes about 10 GB.
MOST_POINTS = 50_000_000
# Bytes of a block, or of a row, which GDAL keeps in memory whatever part of it is read.
_LARGEST_BLOCK = 1 << 30
# Bytes of a .prj file.
_LONGEST_SYSTEM = 1 << 16
_OPTIONS = {
    "GDAL_DISABLE_READDIR_ON_OPEN": "EMPTY_DIR",
    "GDAL_PAM_ENABLED": "NO",
    "GDAL_GEOREF_SOURCES": "INTERNAL",
}


def is_raster(path: Path) -> bool:
    """Return whether `read_raster` reads files with this suffix."""
    return path.suffix.lower() in _DRIVERS or is_netcdf(path)


def read_points(
    path: Path, *, columns: Sequence[str | int] | None, attributes: Sequence[str], layer: str | None
) -> PointSet:
    """Read the cells of a raster; see `delone.io.read_points`. A layer is a band."""
    if columns is not None or attributes:
        raise FileFormatError(f"{path}: rasters have heights of cells, and no columns to choose")
    if layer is None or is_netcdf(path):
        return read_raster(path, band=layer)
    if not (layer.isascii() and layer.isdecimal() and len(layer) < 6):
        raise FileFormatError(f"{path}: the layers of a raster are bands: 1, 2, ...")
    return read_raster(path, band=int(layer))


def read_raster(
    path: str | os.PathLike[str],
    *,
    band: int | str | None = None,
    step: int = 1,
    bounds: Sequence[float] | None = None,
    nodata: float | None = None,
    max_points: int = MOST_POINTS,
) -> PointSet:
    r"""Read the heights of a raster as points at the centers of its cells.

    Parameters
    ----------
    path : str or path-like
        GeoTIFF (.tif, .tiff), ESRI ASCII grid (.asc), or NetCDF (.nc) with coordinates for rows and
        columns.
    band : int or str, optional
        The band, from 1, or the name of the variable in a NetCDF file; required if there are
        several.
    step : int, optional
        Read every `step`-th row and column, starting with the first.
    bounds : sequence of four float, optional
        Left, bottom, right and top: read only cells whose centers are inside or on the border. Only
        this part of the file is read, and `max_points` applies to its cells.
    nodata : float, optional
        The value of cells without a height, in addition to the one that the file declares. NaN says
        that all values are heights, even those that look like nodata.
    max_points : int, optional
        Maximum number of cells to read, including those without a height.

    Returns
    -------
    PointSet
        Points row by row in the order of the file (in GeoTIFF and ASCII grids from the top), with
        heights `z` and the reference system of the file. Scale and offset of the band, if any, are
        applied.

    Raises
    ------
    FileNotFoundError
        There is no such file.
    FileFormatError
        The file is truncated or not what its suffix says; it has no georeference, no such band,
        complex values or no cell with a height; it has more than `max_points` cells, in which case
        the message gives a `step` that is large enough; or cells have a constant such as -9999 that
        the file does not declare as nodata and that is outside the range of all other heights by
        more than this range.
    InputError
        `bounds` are not four finite numbers in this order, or contain no cell.
    MissingExtraError
        rasterio (extra ``raster``) or, for NetCDF, xarray and netCDF4 (extra ``xarray``) are not
        installed.

    Warns
    -----
    LeftOutWarning
        Cells have no height: nodata, masked, NaN or infinite. The message says how many.

    Notes
    -----
    Rotated and sheared rasters give rotated and sheared points. Memory is needed for the points and
    one row of blocks. No other file is read except the .prj file of an ASCII grid, for its
    reference system: world files (.tfw) are ignored.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone.io import read_raster
    >>> text = "ncols 2\nnrows 2\nxllcorner 10\nyllcorner 20\ncellsize 4\n5 6\n7 8\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "dem.asc"
    ...     _ = file.write_text(text)
    ...     survey = read_raster(file)
    >>> survey.points[0].tolist(), survey.z.tolist()
    ([12.0, 26.0], [5.0, 6.0, 7.0, 8.0])
    """
    file = path_of(path)
    step = as_least(step, 1, name="step")
    most = as_least(max_points, 1, name="max_points")
    box, empty_value = as_bounds(bounds), as_nodata(nodata)
    if is_netcdf(file):
        return _of_netcdf(file, band, step, box, empty_value, most)
    with _of_band(file, band) as (raster, number):
        window = _window(raster, box, step)
        _check_size(raster, number, window, most, file)
        points, z, empty = _cells(raster, number, window, box, empty_value)
        crs = None if raster.crs is None else str(raster.crs.to_string())
    check_system(crs, str(file))
    if not len(points):
        if box is not None and not empty:
            raise _outside(file, box)
        raise FileFormatError(f"{file}: no cell has a height")
    _tell_empty(file, empty)
    return PointSet(points=points, z=z, crs=crs, source=str(file))


def read_cells(
    path: Path,
    *,
    band: int | str | None = None,
    step: int = 1,
    bounds: Sequence[float] | None = None,
    nodata: float | None = None,
    max_points: int = MOST_POINTS,
) -> Heights:
    """Read the heights of an upright raster as a grid, NaN where there is none.

    Rows and columns are in the order of the file; arguments and errors are those of `read_raster`.
    """
    step, box = as_least(step, 1, name="step"), as_bounds(bounds)
    empty = as_nodata(nodata)
    if is_netcdf(path):
        return read_heights(path, band, step, box, empty, max_points)
    with _of_band(path, band) as (raster, number):
        a, b, c, d, e, f = raster.transform[:6]
        if b != 0 or d != 0:
            raise FileFormatError(
                f"{path} is rotated, so its cells have no rows and columns of one y and x: write "
                "an upright raster with gdalwarp"
            )
        window = _window(raster, box, step)
        if not (len(window.rows) and len(window.columns)):
            raise _outside(path, box)
        _check_size(raster, number, window, max_points, path)
        values = _values(raster, number, window, empty)
        crs = None if raster.crs is None else str(raster.crs.to_string())
    check_system(crs, str(path))
    x, y = (
        size * (np.array(numbers) + 0.5) + origin
        for size, origin, numbers in ((a, c, window.columns), (e, f, window.rows))
    )
    return Heights(values, x, y, crs)


def _values(raster: Any, band: int, window: _Window, nodata: float | None) -> Floats:
    """Return the heights of cells, NaN where there is none."""
    scale, offset = raster.scales[band - 1], raster.offsets[band - 1]
    found = np.full((len(window.rows), len(window.columns)), np.nan)
    columns = int(window.columns[0]), int(window.columns[-1]) + 1
    for at, row in enumerate(window.rows):
        read = raster.read(band, window=((row, row + 1), columns), masked=True)
        values = np.ma.getdata(read)[0, :: window.columns.step]
        without = np.ma.getmaskarray(read)[0, :: window.columns.step]
        there = ~without & np.isfinite(values) & ~is_nodata(values, nodata)
        found[at, there] = values[there]
    require_declared(found[np.isfinite(found)], nodata, str(raster.name))
    return found if (scale, offset) == (1, 0) else found * scale + offset


def _of_netcdf(  # noqa: PLR0917
    path: Path,
    name: int | str | None,
    step: int,
    box: tuple[float, ...] | None,
    nodata: float | None,
    most: int,
) -> PointSet:
    """Read the nodes of a variable that have a height."""
    found = read_heights(path, name, step, box, nodata, most)
    nodes = np.stack(np.meshgrid(found.x, found.y), axis=-1).reshape(-1, 2)
    z = found.values.ravel()
    there = np.isfinite(z)
    if not there.any():
        raise FileFormatError(f"{path}: no node has a height")
    _tell_empty(path, int(len(z) - there.sum()))
    return PointSet(points=nodes[there], z=z[there], crs=found.crs, source=str(path))


def _tell_empty(path: Path, empty: int) -> None:
    if empty:
        message = f"{path}: {counted(empty, 'cell')} without a height left out"
        warnings.warn(message, LeftOutWarning, stacklevel=caller_level())


@contextmanager
def _opened(path: Path) -> Iterator[Any]:
    """Yield the dataset of a file; errors of rasterio and GDAL are FileFormatErrors."""
    driver = _DRIVERS.get(path.suffix.lower())
    if driver is None:
        raise FileFormatError(f"{path} is not a raster; known are {' '.join(_DRIVERS)}")
    rasterio = require("rasterio", extra="raster", what="reading rasters")
    require_there(path)
    name = os.path.abspath(path)
    if name.startswith("/vsi"):
        raise FileFormatError(f"{path}: names that begin with /vsi are reserved by GDAL")
    _check_beside(path, driver)
    with reading_as(path, path.suffix), warnings.catch_warnings(), rasterio.Env(**_OPTIONS):
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(name, driver=driver) as raster:
            if raster.transform.is_identity:
                raise FileFormatError(
                    f"{path} has no georeference of its own (ground control points and world "
                    "files do not count): write it with gdal_translate or gdalwarp"
                )
            yield raster


def _check_beside(path: Path, driver: str) -> None:
    """Check the file that GDAL reads together with an ASCII grid."""
    if driver != "AAIGrid":
        return
    for suffix in (".prj", ".PRJ"):
        system = path.with_suffix(suffix)
        if not os.path.lexists(system):
            continue
        require_companion(path, system)
        if system.stat().st_size > _LONGEST_SYSTEM:
            raise FileFormatError(f"{system} is too long for a reference system")
        check_system(system.read_text(encoding="latin-1"), str(system))


@contextmanager
def _of_band(path: Path, band: int | str | None) -> Iterator[tuple[Any, int]]:
    """Yield the dataset of a file and the number of a band."""
    if isinstance(band, str):
        raise InputError(f"{path}: names of variables are for NetCDF; band is a number from 1 on")
    wanted = None if band is None else as_least(band, 1, name="band")
    with _opened(path) as raster:
        yield raster, _band(raster, wanted, path)


def _outside(path: Path, box: tuple[float, ...] | None) -> InputError:
    return InputError(f"{path}: no center of a cell is inside bounds={box}")


def _band(raster: Any, band: int | None, path: Path) -> int:
    if band is None and raster.count > 1:
        raise FileFormatError(
            f"{path} has {raster.count} bands: choose one with band (--layer), from 1"
        )
    number = 1 if band is None else band
    if number > raster.count:
        raise FileFormatError(f"{path} has no band {number}, only {raster.count}")
    if raster.dtypes[number - 1].startswith("complex"):
        raise FileFormatError(f"{path}: band {number} has complex values, not heights")
    return number


def as_bounds(given: Any) -> tuple[float, float, float, float] | None:
    """Return left, bottom, right and top; None for everything."""
    if given is None:
        return None
    try:
        left, bottom, right, top = (as_number(each, name="bounds") for each in given)
    except (TypeError, ValueError):
        raise InputError(
            f"bounds must be four numbers: left, bottom, right, top; got {given!r:.60}"
        ) from None
    if not (np.isfinite((left, bottom, right, top)).all() and left <= right and bottom <= top):
        raise InputError(
            f"bounds must be finite, and left, bottom, right, top in this order; got {given!r:.60}"
        )
    return left, bottom, right, top


class _Window(NamedTuple):
    """The rows and columns of a raster that are read."""

    rows: range
    columns: range


def _window(raster: Any, box: tuple[float, ...] | None, step: int) -> _Window:
    """Return the rows and columns in which centers can be inside a box."""
    shape = raster.height, raster.width
    if box is None:
        return _Window(*(range(0, count, step) for count in shape))
    left, bottom, right, top = box
    a, b, c, d, e, f = (~raster.transform)[:6]
    corners = [(x, y) for x in (left, right) for y in (bottom, top)]
    # The positions of the corners of the box, along rows and columns.
    along = [d * x + e * y + f for x, y in corners], [a * x + b * y + c for x, y in corners]
    found = []
    for count, places in zip(shape, along, strict=True):
        # One more on each side: the centers decide. Numbers are clipped before they become
        # integers.
        first, last = (min(max(each, -2.0), count + 2.0) for each in (min(places), max(places)))
        start, stop = max(0, int(first) - 1), max(0, min(count, int(last) + 2))
        # The rows and columns of a window are some of those that are read without one.
        found.append(range(start + -start % step, stop, step))
    rows, columns = found
    a, b, c, d, e, f = raster.transform[:6]
    if b == 0 and d == 0:
        rows = _inside(rows, e, f, bottom, top)
        columns = _inside(columns, a, c, left, right)
    return _Window(rows, columns)


def _inside(numbers: range, size: float, origin: float, low: float, high: float) -> range:
    """Return the rows or columns of an upright raster whose centers are from `low` to `high`."""
    nodes = size * (np.array(numbers) + 0.5) + origin
    at = np.flatnonzero((nodes >= low) & (nodes <= high))
    return numbers[at[0] : at[-1] + 1] if len(at) else numbers[:0]


def _check_size(raster: Any, band: int, window: _Window, most: int, path: Path) -> None:
    """Reject rasters that would not fit into memory, before anything is read."""
    step = window.rows.step
    rows, columns = (step * len(each) for each in window)
    count = len(window.rows) * len(window.columns)
    if count > most:
        least = max(step, int((rows * columns / most) ** 0.5))
        while -(-rows // least) * -(-columns // least) > most:  # ends at one cell
            least += 1 + least // 1000
        raise FileFormatError(
            f"{path} has {raster.width} x {raster.height} cells, {count} to read, and at most "
            f"{most} are read (max_points): leave out rows and columns with step={least} "
            "(--step), or read a part with bounds (--window)"
        )
    high, wide = raster.block_shapes[band - 1]
    size = np.dtype(raster.dtypes[band - 1]).itemsize
    if max(high * wide, raster.width) * size > _LARGEST_BLOCK:
        raise FileFormatError(f"{path} has blocks of {wide} x {high} cells, too large to read")


def _cells(
    raster: Any, band: int, window: _Window, box: tuple[float, ...] | None, nodata: float | None
) -> tuple[Floats, Floats, int]:
    """Return centers and heights of cells, and the number of cells without a height."""
    scale, offset = raster.scales[band - 1], raster.offsets[band - 1]
    a, b, c, d, e, f = raster.transform[:6]
    columns = np.array(window.columns, dtype=np.int64)
    points, heights, empty = [np.empty((0, 2))], [np.empty(0)], 0
    across = columns + 0.5
    # Row by row: GDAL keeps the blocks of a row of blocks until it is done.
    for row in window.rows if len(columns) else ():
        part = (row, row + 1), (int(columns[0]), int(columns[-1]) + 1)
        read = raster.read(band, window=part, masked=True)
        values = np.ma.getdata(read)[0, :: window.columns.step]
        without = np.ma.getmaskarray(read)[0, :: window.columns.step]
        there = ~without & np.isfinite(values) & ~is_nodata(values, nodata)
        down = row + 0.5
        x, y = a * across + (b * down + c), d * across + (e * down + f)
        if box is not None:
            inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
            there, x, y = there[inside], x[inside], y[inside]
            values = values[inside]
        points.append(np.column_stack((x, y))[there])
        heights.append(values[there].astype(np.float64))
        empty += int(len(there) - there.sum())
    z = np.concatenate(heights)
    require_declared(z, nodata, str(raster.name))
    return np.concatenate(points), z if (scale, offset) == (1, 0) else z * scale + offset, empty
