"""Differences of rasters of heights, cell by cell: from another raster, a surface, or a plane.

Cells are compared in place: two rasters must have the same cells, and nothing is resampled or
reprojected. A surface or plane is evaluated at the center of each cell.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.counting import counted
from delone._base.decimals import spacing
from delone._base.georeference import as_known_crs, is_geographic, same_crs, warn_of_unknown
from delone._base.immutable import ReadOnly
from delone._base.units import area_units, as_units, require_same_units, volume_units
from delone._tiling.plane.geometry import total
from delone.errors import InputError
from delone.terrain.slopes import cells_of
from delone.terrain.volumes import plane_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["Difference", "difference"]

# Centers that differ by less than this fraction of a cell are the same: files store them rounded.
_SAME = 1e-6
# Number of nodes at which a surface is evaluated at a time.
_BLOCK = 1 << 18


@dataclass(frozen=True, eq=False, kw_only=True)
class Difference(ReadOnly):
    """The heights of a raster minus those of something else, in each cell.

    Parameters
    ----------
    values : ndarray of float64, shape (rows, columns)
        The differences: positive where the raster is above. NaN where either has no height.
    x : ndarray of float64, shape (columns,)
        x coordinates of the centers of cells, ascending.
    y : ndarray of float64, shape (rows,)
        y coordinates of the centers of cells, ascending.
    missing : int
        The number of cells in which the raster has no height.
    missing_other : int
        The number of cells in which the other one has no height: nodata, or outside its surface.
    crs : str, optional
        Coordinate reference system.
    units : str, optional
        The unit of heights.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import Grid
    >>> from delone.terrain import difference
    >>> x, y = np.arange(3.0), np.arange(2.0)
    >>> difference(Grid(np.array([[1.0, 2, 3], [4, 5, np.nan]]), x, y), 3.0)
    <Difference of 5 cells: -2 to 2, mean 0, 1 cell without>
    """

    values: Floats
    x: Floats
    y: Floats
    missing: int
    missing_other: int
    crs: str | None = None
    units: str | None = None

    def __repr__(self) -> str:
        empty = self.values.size - self.count
        text = f"<Difference of {counted(self.count, 'cell')}"
        if self.count:
            text += f": {self.min:.6g} to {self.max:.6g}, mean {self.mean:.6g}"
        return text + (f", {counted(empty, 'cell')} without>" if empty else ">")

    @property
    def _known(self) -> Floats:
        found: Floats = self.values[np.isfinite(self.values)]
        return found

    @property
    def count(self) -> int:
        """The number of cells in which both have a height."""
        return len(self._known)

    @property
    def min(self) -> float:
        """The smallest difference; NaN if no cell has one."""
        return float(self._known.min()) if self.count else float("nan")

    @property
    def max(self) -> float:
        """The largest difference; NaN if no cell has one."""
        return float(self._known.max()) if self.count else float("nan")

    @property
    def mean(self) -> float:
        """The mean of the differences; NaN if no cell has one."""
        return total(self._known) / self.count if self.count else float("nan")

    @property
    def rms(self) -> float:
        """The root of the mean square of the differences; NaN if no cell has one."""
        largest = max(abs(self.min), abs(self.max)) if self.count else float("nan")
        if not largest > 0:
            return largest
        # In units of the largest one, so that no square overflows or underflows.
        return float(largest * np.sqrt(np.mean((self._known / largest) ** 2)))

    @property
    def cut(self) -> float:
        """The volume of the raster above the other: differences above 0 times areas of cells."""
        return self._volume(np.maximum)

    @property
    def fill(self) -> float:
        """The volume of the raster below the other: differences below 0 times areas of cells."""
        return -self._volume(np.minimum)

    @property
    def net(self) -> float:
        """Fill minus cut: the volume to bring in, or, if negative, to take away."""
        return self.fill - self.cut

    @property
    def area(self) -> float:
        """The area of the cells in which both have a height."""
        return total(self._areas[np.isfinite(self.values)])

    @property
    def volume_units(self) -> str | None:
        """The unit of volumes, such as m3, or "ft m2" for heights in feet; None if unknown."""
        return volume_units(self.crs, self.units)

    @property
    def area_units(self) -> str | None:
        """The unit of areas, such as m2; None if the reference system is unknown."""
        return area_units(self.crs)

    def _volume(self, side: Any) -> float:
        values = side(np.nan_to_num(self.values, nan=0.0), 0.0)
        return total((values * self._areas).ravel())

    @property
    def _areas(self) -> Floats:
        """The area of each cell, which extends halfway to each neighbor."""
        if self.crs is not None and is_geographic(self.crs):
            raise InputError(
                f"cells are in degrees ({self.crs:.60}), so they have no area on a plane: project "
                "the rasters (gdalwarp -t_srs)"
            )
        return np.multiply.outer(_widths(self.y), _widths(self.x))

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the differences: red where the raster is above, blue where it is below.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            ``cmap``, ``colorbar``, ``title``, and ``limit``, the difference at the ends of the
            colors; by default, one hundredth of the differences exceeds it. White is always 0.

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            No cell has a difference, or `limit` is not above 0.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.interpolate import Grid
        >>> from delone.terrain import difference
        >>> x, y = np.arange(3.0), np.arange(2.0)
        >>> difference(Grid(np.array([[1.0, 2, 3], [4, 5, 6]]), x, y), 3.0).plot().get_aspect()
        1.0
        """
        from delone.plot.raster import plot_difference

        label = "difference" + ("" if self.units is None else f" ({self.units})")
        return plot_difference(self.values, self.x, self.y, ax, label=label, **options)


def _widths(nodes: Floats) -> Floats:
    """Return the sizes of cells along an axis; a single cell has size 1."""
    if len(nodes) < 2:
        return np.ones(len(nodes))
    middle = (nodes[1:] + nodes[:-1]) / 2
    first, last = 2 * nodes[0] - middle[0], 2 * nodes[-1] - middle[-1]
    return np.diff(np.concatenate(([first], middle, [last])))


class _Raster(NamedTuple):
    """Heights with ascending x and y, their reference system, and what messages call them."""

    values: Floats
    x: Floats
    y: Floats
    crs: str | None
    name: str


def difference(
    dem: Any,
    other: Any,
    *,
    band: int | str | None = None,
    other_band: int | str | None = None,
    bounds: Sequence[float] | None = None,
    nodata: float | None = None,
    crs: Any = None,
    units: str | None = None,
) -> Difference:
    """Subtract another raster, a surface or a plane from a raster of heights, cell by cell.

    Parameters
    ----------
    dem : delone.interpolate.Grid, xarray.DataArray, str or path-like
        Heights at the centers of cells, or a file of them: GeoTIFF, ESRI ASCII grid or NetCDF.
    other : raster as `dem`, TIN, float, or triple of float
        What is subtracted: a raster with the same cells, the heights of a surface at the centers of
        the cells, a height, or a plane (a, b, c) with the heights c + a x + b y.
    band, other_band : int or str, optional
        For files: the band, counted from 1, or the NetCDF variable, as for `delone.io.read_raster`.
    bounds : sequence of four float, optional
        Left, bottom, right and top. In both rasters, only cells whose centers are inside or on the
        border are used.
    nodata : float, optional
        The value of cells without a height, besides NaN and the one that a file declares; NaN if
        all values are heights.
    crs : optional
        The reference system of rasters that declare none.
    units : str, optional
        The unit of heights, such as ``"m"``, ``"ft"`` or ``"us-ft"``; by default that of a TIN.

    Returns
    -------
    Difference
        The differences, a raster that `delone.io.write_raster` writes, and the number of cells in
        which one has no height.

    Raises
    ------
    InputError
        The rasters have different cells, or are in different reference systems; the message says
        how to match them. Or heights are in different units, or an argument has an invalid type.
    FileFormatError, MissingExtraError, OSError As for `delone.io.read_raster`; or a raster in a
    file is rotated.

    Warns
    -----
    CRSWarning
        Only one reference system is known, and it is assumed for both.

    See Also
    --------
    TIN.volume_to : The volume between two surfaces that are linear in triangles, without cells.

    Notes
    -----
    Centers are the same if they differ by at most a millionth of a cell. Nothing is resampled: to
    compare rasters with different cells, make a TIN of one of them, which is linear between its
    nodes. The time is linear in the number of cells; with a TIN, it includes locating each cell.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import Grid
    >>> from delone.terrain import TIN, difference
    >>> x, y = np.arange(4.0), np.arange(3.0)
    >>> after = Grid(np.full((3, 4), 6.0), x, y)
    >>> before = TIN.from_points([(0, 0, 4), (3, 0, 7), (3, 2, 7), (0, 2, 4)])
    >>> found = difference(after, before)
    >>> found.values[0].tolist(), found.cut, found.fill
    ([2.0, 1.0, 0.0, -1.0], 9.0, 3.0)
    """
    chosen = {"bounds": bounds, "nodata": nodata}
    first = _raster_of(dem, band, "dem", **chosen)
    system = as_known_crs(crs)
    if hasattr(other, "_sheet"):
        if other_band is not None:
            raise InputError("other_band is for files of rasters, and other is a surface")
        known = _common_system(first.crs or system, other.crs, first.name, "the surface")
        heights, unit = _on_nodes(other, first.x, first.y), other.units
    elif _is_raster(other):
        second = _raster_of(other, other_band, "other", **chosen)
        known = _common_system(first.crs or system, second.crs or system, first.name, second.name)
        _require_same_cells(first, second)
        heights, unit = second.values, None
    else:
        if other_band is not None:
            raise InputError("other_band is for files of rasters, and other is a height or plane")
        a, b, c = plane_of(other)
        known, unit = first.crs or system, None
        heights = np.add.outer(b * first.y, a * first.x) + c
    stated = as_units(units)
    require_same_units(stated, unit, what="units and the surface")
    return Difference(
        values=first.values - heights,
        x=first.x.copy(),
        y=first.y.copy(),
        missing=int(np.isnan(first.values).sum()),
        missing_other=int(np.isnan(heights).sum()),
        crs=known,
        units=stated or unit,
    )


def _is_raster(given: Any) -> bool:
    named = isinstance(given, str | os.PathLike)
    return named or all(hasattr(given, name) for name in ("values", "x", "y"))


def _raster_of(given: Any, band: Any, name: str, *, bounds: Any, nodata: Any) -> _Raster:
    """Return a raster with ascending coordinates."""
    from delone.io.dem import as_bounds, read_cells
    from delone.io.netcdf import heights_of_array, is_array
    from delone.io.nodata import as_nodata, is_nodata, require_declared

    box, empty, crs = as_bounds(bounds), as_nodata(nodata), None
    if isinstance(given, str | os.PathLike):
        name = str(given)
        values, x, y, crs = read_cells(Path(given), band=band, bounds=bounds, nodata=nodata)
    elif band is not None:
        raise InputError(f"{name}: bands are for files of rasters: give a path, or a slice")
    elif is_array(given):
        values, x, y, crs = heights_of_array(given, box, empty)
    else:
        values, x, y = cells_of(given)
        values = np.where(is_nodata(values, empty) | ~np.isfinite(values), np.nan, values)
        require_declared(values[np.isfinite(values)], empty, name, file=False)
        if box is not None:
            columns, rows = (x >= box[0]) & (x <= box[2]), (y >= box[1]) & (y <= box[3])
            values, x, y = values[np.ix_(rows, columns)], x[columns], y[rows]
            if not values.size:
                raise InputError(f"{name}: no node of the raster is inside bounds={box}")
    if (np.diff(x) < 0).all():
        values, x = values[:, ::-1], x[::-1]
    if (np.diff(y) < 0).all():
        values, y = values[::-1], y[::-1]
    for axis, nodes in (("x", x), ("y", y)):
        if not ((np.diff(nodes) > 0).all() and np.isfinite(nodes).all()):
            raise InputError(f"{name}: {axis} must be finite and ascend, or descend")
    values, x, y = (np.ascontiguousarray(each) for each in (values, x, y))
    return _Raster(values, x, y, crs, name)


def _common_system(a: str | None, b: str | None, first: str, second: str) -> str | None:
    """Return the one reference system of two things."""
    if a is not None and b is not None and not same_crs(a, b):
        raise InputError(
            f"{first:.60} is in {a:.60}, and {second:.60} in {b:.60}: reproject one of them "
            f"(gdalwarp -t_srs), which resamples a raster, or transform the points"
        )
    if (a is None) != (b is None):
        known, unknown = (first, second) if b is None else (second, first)
        warn_of_unknown(str(a or b), known=f"{known:.60}", unknown=f"{unknown:.60}")
    return a or b


def _require_same_cells(a: _Raster, b: _Raster) -> None:
    """Reject rasters with different cells, and say how to match them."""
    sizes = [abs(float(spacing(nodes))) for nodes in (a.x, a.y)]
    limits = [_SAME * (size or 1.0) for size in sizes]
    pairs = list(zip((a.x, a.y), (b.x, b.y), limits, strict=True))
    if all(len(p) == len(q) and np.abs(p - q).max() <= limit for p, q, limit in pairs):
        return
    shared = [_shared(p, q, limit) for p, q, limit in pairs]
    text = "; ".join(f"{each.name:.60} has {_cells_text(each)}" for each in (a, b))
    if all(shared):
        (left, right), (bottom, top) = (span for span in shared if span)
        half_x, half_y = (size / 2 for size in sizes)
        box = f"({left - half_x:.10g}, {bottom - half_y:.10g}, {right + half_x:.10g}, "
        cure = f"they have cells in common, so compare these with bounds={box}{top + half_y:.10g})"
    else:
        cure = (
            "compare one of them with a surface of the other, difference(dem, "
            "TIN.from_raster(other)), or resample it (gdalwarp -tr -te)"
        )
    raise InputError(f"the rasters have different cells: {text}: {cure}")


def _shared(p: Floats, q: Floats, limit: float) -> tuple[float, float] | None:
    """Return the first and last node that two axes have in common; None if others lie between.

    From the first to the last, both axes must have the same nodes.
    """
    low, high = max(p[0], q[0]) - limit, min(p[-1], q[-1]) + limit
    mine, others = p[(p >= low) & (p <= high)], q[(q >= low) & (q <= high)]
    if not len(mine) or len(mine) != len(others) or np.abs(mine - others).max() > limit:
        return None
    return float(mine[0]), float(mine[-1])


def _cells_text(raster: _Raster) -> str:
    width, height = (float(spacing(nodes)) for nodes in (raster.x, raster.y))
    return (
        f"{len(raster.x)} x {len(raster.y)} cells of {width:.10g} x {height:.10g}, the first at "
        f"({raster.x[0]:.10g}, {raster.y[0]:.10g})"
    )


def _on_nodes(tin: Any, x: Floats, y: Floats) -> Floats:
    """Return the heights of a surface at nodes, in blocks of rows."""
    found = np.empty((len(y), len(x)))
    rows = max(1, _BLOCK // len(x))
    for start in range(0, len(y), rows):
        nodes = np.stack(np.meshgrid(x, y[start : start + rows]), axis=-1)
        found[start : start + rows] = tin.heights(nodes)
    return found
