"""Rasters: an interpolant on the nodes of a regular grid.

A node is the center of a cell; rows go from the lowest to the highest y. Nodes are evaluated in
blocks of rows, so that little memory is needed beyond the result, whose size is checked before
anything is computed.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_callback, as_count, as_number, as_plain_array, wrong_shape
from delone._base.counting import gigabytes, grouped
from delone._base.decimals import exact, multiples, outer, spacing
from delone._base.renames import renamed
from delone._base.values import require_real
from delone.errors import InputError, ShapeError
from delone.interpolate.base import Interpolator, as_max_distance
from delone.interpolate.methods import interpolator
from delone.interpolate.space import SPACE, refuse
from delone.memory import free_memory

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["Grid", "as_nodes", "grid", "raster_nodes", "require_memory"]

# Queries per block: few enough for their coordinates and weights to stay in the cache.
_BLOCK = 1 << 18
# Memory besides the result: a block of queries, and room for further use of the result.
_SPARE = 1 << 26
# Both ends of a box and their difference are rounded, and may have been computed from others.
_ROUNDINGS = 4


@renamed(cell="cell_size")
@dataclass(frozen=True, eq=False)
class Grid:
    """Values on the nodes of a regular grid.

    Parameters
    ----------
    values : ndarray, shape (rows, columns) or (rows, columns, ...)
        Values; NaN where undefined.
    x : ndarray of float64, shape (columns,)
        x coordinates, ascending.
    y : ndarray of float64, shape (rows,)
        y coordinates, ascending.

    Examples
    --------
    >>> from delone.interpolate import grid
    >>> found = grid([(0, 0), (4, 0), (4, 4), (0, 4)], [0.0, 4.0, 4.0, 0.0], resolution=2)
    >>> found.values
    array([[1., 3.],
           [1., 3.]])
    >>> found.extent
    (0.0, 4.0, 0.0, 4.0)
    """

    values: NDArray[Any]
    x: Floats
    y: Floats

    @property
    def cell_size(self) -> tuple[float, float]:
        """Width and height of a cell; 0 if there is only one."""
        return float(spacing(self.x)), float(spacing(self.y))

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom and top of the outermost cells, in the order of ``imshow``."""
        return *outer(self.x), *outer(self.y)

    def to_xarray(self, *, name: str | None = None, crs: str | None = None) -> Any:
        """Return the grid as an xarray.DataArray (extra ``xarray``).

        Parameters
        ----------
        name : str, optional
            Name of the values.
        crs : str, optional
            Coordinate reference system, stored as an attribute.

        Returns
        -------
        xarray.DataArray
            An array with the dimensions ``y`` and ``x``, then ``value0``, ``value1``, ... if there
            are several values at each node. It shares memory with the grid.

        Raises
        ------
        MissingExtraError
            xarray is not installed.

        Examples
        --------
        >>> from delone.interpolate import grid
        >>> ramp = grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], x=[0, 1, 2], y=[0, 2])
        >>> ramp.to_xarray(name="height").sel(x=1, y=2).item()
        3.0
        """
        from delone._base.extras import require

        xarray = require("xarray", extra="xarray", what="a DataArray")
        further = [f"value{k}" for k in range(self.values.ndim - 2)]
        return xarray.DataArray(
            self.values,
            dims=("y", "x", *further),
            coords={"y": self.y, "x": self.x},
            name=name,
            attrs={} if crs is None else {"crs": crs},
        )

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the values in colors (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default those of a new pyplot figure.
        **options
            As for `delone.plot.plot_raster`: ``contours``, ``shade``, ``cmap``, ``colorbar``,
            ``label``, ``title``.

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            The values are complex, there are several at each node, or none is finite.

        Examples
        --------
        >>> import matplotlib
        >>> matplotlib.use("Agg")
        >>> from delone.interpolate import grid
        >>> ramp = grid([(0, 0), (4, 0), (4, 4), (0, 4)], [0.0, 4.0, 4.0, 0.0], shape=(40, 40))
        >>> ramp.plot(contours=4).get_aspect()
        1.0
        """
        from delone.plot import plot_raster

        if self.values.ndim != 2 or self.values.dtype.kind == "c":
            raise InputError(
                f"a plot shows one real value at each node, not values of shape "
                f"{self.values.shape} and dtype {self.values.dtype}; plot "
                "Grid(part, grid.x, grid.y), where part has one"
            )
        return plot_raster(self.values, self.x, self.y, ax, **options)

    def __repr__(self) -> str:
        size = " x ".join(map(str, (len(self.x), len(self.y), *self.values.shape[2:])))
        span = "complex values"
        if self.values.dtype.kind != "c":
            # These ignore NaN and copy nothing.
            low, high = (each.reduce(self.values, axis=None) for each in (np.fmin, np.fmax))
            span = "no values" if np.isnan(low) else f"{low:.6g} to {high:.6g}"
        left, right, bottom, top = (f"{bound:.6g}" for bound in self.extent)
        return f"<Grid of {size} nodes, x {left} to {right}, y {bottom} to {top}: {span}>"


def grid(
    points: ArrayLike | Triangulation | PeriodicDelaunay | Interpolator,
    values: ArrayLike | None = None,
    *,
    resolution: float | tuple[float, float] | None = None,
    shape: tuple[int, int] | None = None,
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    bounds: Sequence[float] | None = None,
    method: str = "linear",
    max_distance: float | None = None,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Grid:
    """Interpolate scattered values to a raster.

    Parameters
    ----------
    points : array_like, shape (n, 2), a triangulation, or an interpolator
        Sites, or a triangulation or interpolator of them.
    values : array_like, shape (n,) or (n, ...), optional
        Values at the sites; by default the interpolator's own.
    resolution : float or pair of float, optional
        Width and height of a cell, in the units of the points.
    shape : pair of int, optional
        Numbers of columns and rows, instead of `resolution`.
    x, y : array_like, shape (columns,) and (rows,), optional
        The nodes themselves, ascending, instead of `resolution`.
    bounds : sequence of four floats, optional
        Left, bottom, right and top of the raster; by default the bounding box of the points.
    method : str, optional
        As in `interpolator`; not together with an interpolator.
    max_distance : float, optional
        Nodes farther than this from the nearest site get NaN; by default there is no limit.
    progress : callable, optional
        Called from time to time with the fraction of the nodes that is done, from 0 to 1.
    **options
        Options of the interpolator: ``extrapolate``, ``tolerance``, ``duplicates``, ``nan``,
        ``workers``, ``planar``.

    Returns
    -------
    Grid
        Values and nodes.

    Raises
    ------
    InputError
        Not exactly one of `resolution`, `shape` and nodes is given, or they do not define a raster;
        `max_distance` is negative or NaN.
    MemoryError
        The result would not fit into free memory; raised before anything is computed.

    Notes
    -----
    If the size of the box is not a multiple of the cell size, the box is extended to the right and
    to the top.

    Examples
    --------
    >>> from delone.interpolate import grid
    >>> ramp = grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], x=[0, 1, 2], y=[0, 2])
    >>> ramp.values
    array([[0., 1., 2.],
           [2., 3., 4.]])
    """
    limit, tell = as_max_distance(max_distance), as_callback(progress, name="progress")
    if isinstance(points, Interpolator):
        if options or method != "linear":
            raise InputError("method and options cannot be given with an existing interpolator")
        made = points
    else:
        made = interpolator(points, values, method, **options)
        values = None
    if made._ndim >= SPACE:
        refuse("a raster", "call the interpolator with the query points")
    field = made._field_of(values)
    nodes_x, nodes_y = _nodes(made, resolution, shape, x, y, bounds)
    require_memory(len(nodes_x), len(nodes_y), field.columns.shape[1])
    dtype = np.complex128 if field.is_complex else np.float64
    found = np.empty((len(nodes_y), len(nodes_x), *field.trailing), dtype)
    rows = max(1, _BLOCK // len(nodes_x))
    for start in range(0, len(nodes_y), rows):
        some = nodes_y[start : start + rows]
        queries = np.stack(np.meshgrid(nodes_x, some), axis=-1)
        found[start : start + rows] = made(queries, values=values, max_distance=limit)
        if tell is not None:
            tell(min(1.0, (start + rows) / len(nodes_y)))
    return Grid(found, nodes_x, nodes_y)


def _nodes(  # noqa: PLR0917
    made: Interpolator,
    resolution: float | tuple[float, float] | None,
    shape: tuple[int, int] | None,
    x: ArrayLike | None,
    y: ArrayLike | None,
    bounds: Sequence[float] | None,
) -> tuple[Floats, Floats]:
    if x is None and y is None:
        return raster_nodes(made._box, resolution=resolution, shape=shape, bounds=bounds)
    if x is None or y is None or not (resolution is None and shape is None and bounds is None):
        raise InputError("give both x and y, without resolution, shape or bounds")
    return as_nodes(x, "x"), as_nodes(y, "y")


def raster_nodes(
    box: tuple[Sequence[float], Sequence[float]],
    *,
    resolution: float | tuple[float, float] | None = None,
    shape: tuple[int, int] | None = None,
    bounds: Sequence[float] | None = None,
    room: Callable[[int, int], None] | None = None,
) -> tuple[Floats, Floats]:
    """The nodes of a raster, x and y: the centers of its cells, ascending.

    `box` contains the smallest and largest coordinates, used if there are no `bounds`. `room` is
    called with columns and rows before anything is allocated, and raises if there is no room for
    such a raster; by default it must fit into memory.
    """
    if (resolution is None) == (shape is None):
        raise InputError("give one of resolution, shape, or x and y")
    low, high = box if bounds is None else _bounded(bounds)
    if shape is not None:
        counts = [as_count(count, name="shape") for count in _listed(shape, "shape", 2)]
        if min(counts) < 1:
            raise InputError(f"shape must be two numbers of at least 1, got {shape!r:.80}")
        cells = []
    else:
        side: Any = resolution
        given = [side] * 2 if _is_one(side) else side
        cells = [as_number(cell, name="resolution") for cell in _listed(given, "resolution", 2)]
        if not all(0 < cell < math.inf for cell in cells):
            raise InputError(f"resolution must be above 0, got {resolution!r:.80}")
        counts = [max(1, _cells(low[k], high[k], cells[k])) for k in range(2)]
    columns, rows = counts
    if room is None:
        require_memory(columns, rows, 1)
    else:
        room(columns, rows)
        require_memory(columns + rows, 1, 1)
    steps = [exact(cell) for cell in cells] or [
        (exact(high[k]) - exact(low[k])) / counts[k] for k in range(2)
    ]
    x, y = (_centers(low[k], steps[k], counts[k]) for k in range(2))
    return x, y


def _centers(low: float, step: Fraction, count: int) -> Floats:
    """Centers of cells: the doubles nearest to the decimal numbers."""
    try:
        return multiples(exact(low) + step / 2, step, range(count))
    except OverflowError:
        raise InputError(
            "cells go beyond the range of doubles; choose smaller ones, or bounds"
        ) from None


def _listed(given: Any, name: str, count: int) -> list[Any]:
    """A sequence of exactly `count` items, as a list."""
    found = [] if _is_one(given) else list(given)
    if len(found) != count:
        raise ShapeError(f"{name} must be {count} numbers, got {given!r:.60}")
    return found


def _is_one(given: Any) -> bool:
    """Whether this is one item, not a sequence; rows of unequal length are a sequence."""
    if isinstance(given, str | bytes) or not hasattr(given, "__getitem__"):
        return True
    return getattr(given, "ndim", 1) == 0 or isinstance(given, Mapping)


def _cells(low: float, high: float, cell: float) -> int:
    """How many cells cover a length; an excess within rounding error does not add a cell."""
    length, side = exact(high) - exact(low), exact(cell)
    count = math.ceil(length / side)
    if count > sys.float_info.max:
        raise InputError(f"cells of {cell} are too small for a box of {float(length):g}")
    excess = length - (count - 1) * side
    return count - 1 if excess <= _ROUNDINGS * np.spacing(max(abs(low), abs(high))) else count


def _bounded(bounds: Sequence[float]) -> tuple[list[float], list[float]]:
    box = [as_number(bound, name="bounds") for bound in _listed(bounds, "bounds", 4)]
    if not (box[0] < box[2] and box[1] < box[3] and np.isfinite(box).all()):
        raise InputError(f"bounds must be left, bottom, right, top; got {bounds!r:.80}")
    return box[:2], box[2:]


def as_nodes(nodes: ArrayLike, name: str) -> Floats:
    """Return the nodes of a raster along one axis, finite and ascending."""
    given = as_plain_array(nodes, name)
    require_real(given, name)
    array = given.astype(np.float64)
    if array.ndim != 1 or not len(array):
        raise wrong_shape(name, "(k,) with k of at least 1", array)
    if not np.isfinite(array).all() or not (np.diff(array) > 0).all():
        raise InputError(f"{name} must be finite and ascending")
    return array


def require_memory(columns: int, rows: int, values: int) -> None:
    """Raise MemoryError if cells with `values` numbers of 8 bytes do not fit into free memory."""
    needed = 8 * columns * rows * max(1, values)
    free = free_memory()
    if needed > sys.maxsize or (free is not None and needed + _SPARE > free):
        known = "" if free is None else f", and {gigabytes(free)} is free"
        raise MemoryError(
            f"a raster of {grouped(columns)} x {grouped(rows)} cells needs {gigabytes(needed)}"
            f"{known}; choose larger cells, or a part with bounds"
        )
