"""Contour lines and bands of a surface: levels, results and their exports."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from delone import _core
from delone._base.arrays import (
    LARGEST_LIMIT,
    as_count,
    as_index,
    as_plain_array,
    as_workers,
    require_finite,
)
from delone._base.counting import counted
from delone._base.decimals import exact, multiples
from delone._base.extras import require
from delone._base.immutable import ReadOnly, sealed
from delone._base.numbers import as_finite, as_nonnegative, as_positive
from delone._base.renames import renamed
from delone._base.values import require_real
from delone._tiling.complex import Filed
from delone._tiling.plane import topology
from delone.errors import BudgetExceededError, InputError
from delone.terrain.labeling import Labels, labels_of
from delone.terrain.layer import Layer
from delone.terrain.slivers import drawn
from delone.terrain.small import Rings, ring_areas, without_small
from delone.terrain.surface import on_surface

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.exchange.parts import Parts
    from delone.terrain.surface import Sheet, Surface

__all__ = [
    "MOST",
    "Bands",
    "Contours",
    "Drawn",
    "Finish",
    "bands",
    "finished",
    "levels_of",
    "lines",
]

# Points of contours that a call may compute by default: about 3 GB, including working memory.
MOST = 50_000_000
# The maximum number of smoothing rounds.
_MOST_ROUNDS = 5
# The arrays of lines and of areas in files.
_LINES = ("points", "starts", "level", "index", "levels")
_AREAS = ("points", "ring_starts", "polygon_starts", "low", "high")
# The counts of what is left out.
_LINES_LEFT_OUT = ("left_out", "short", "small", "straightened")
_AREAS_LEFT_OUT = ("left_out", "small", "straightened", "flattened")
# The maximum number of levels that an interval may give.
_LEVELS = 1_000_000


@dataclass(frozen=True, eq=False, kw_only=True)
class Contours(ReadOnly, Filed, Layer):
    """Contour lines, in the order of their levels.

    Parameters
    ----------
    points : ndarray of float64, shape (p, 2)
        The points of all lines, one line after another. A closed line ends with its first point.
    starts : ndarray of int64, shape (k + 1,)
        The start of each line in `points`, and the end of the last.
    level : ndarray of float64, shape (k,)
        The level of each line.
    index : ndarray of bool, shape (k,)
        Whether the line is an index contour.
    levels : ndarray of float64
        All levels, including those without lines.
    left_out : int, optional
        The number of triangles at the outline that are left out because they are thinner than the
        resolution of the coordinates, so that lines in them would cross. Usually 0.
    short : int, optional
        The number of lines that are left out because they are shorter than `min_length`.
    small : int, optional
        The number of closed lines that are left out because they enclose less than `min_area`.
    straightened : int, optional
        The number of points that are left out because of `simplify`.
    crs : str, optional
        Coordinate reference system.
    units : str, optional
        The unit of heights.

    Notes
    -----
    The columns of `to_geopandas` are ``level``, ``index`` and the geometry.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> hill = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)]
    >>> found = TIN.from_points(hill).contours(interval=1)
    >>> found.level.tolist(), found.closed.tolist()
    ([1.0, 2.0], [True, True])
    """

    points: Floats
    starts: Rows
    level: Floats
    index: Bools
    levels: Floats
    left_out: int = 0
    short: int = 0
    small: int = 0
    straightened: int = 0
    crs: str | None = None
    units: str | None = None

    _ELEMENTS: ClassVar[str] = "lines"
    _SAVES_CRS: ClassVar[bool] = True

    def _saved(self) -> dict[str, NDArray[Any]]:
        return _arrays_of(self, _LINES, _LINES_LEFT_OUT)

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls(**_arguments_of(arrays, _LINES, _LINES_LEFT_OUT))

    def __len__(self) -> int:
        return len(self.level)

    def __repr__(self) -> str:
        return f"<Contours of {counted(len(self.levels), 'level')}: {counted(len(self), 'line')}>"

    @property
    def closed(self) -> Bools:
        """Whether each line is closed, (k,)."""
        first, last = self.points[self.starts[:-1]], self.points[self.starts[1:] - 1]
        found: Bools = sealed((first == last).all(axis=1))
        return found

    def coordinates(self, line: int) -> Floats:
        """Return the points of a line.

        Parameters
        ----------
        line : int
            Its number.

        Returns
        -------
        ndarray of float64, shape (j, 2)
            The points, with higher ground to the left of the line.

        Examples
        --------
        See `TIN.contours`.
        """
        return self.points[self.starts[line] : self.starts[line + 1]]

    def labels(
        self, *, length: float | None = None, spacing: float | None = None, index: bool = False
    ) -> Labels:
        """Return positions for labels along the lines.

        Parameters
        ----------
        length : float, optional
            The length of a label in the unit of the points; by default a fortieth of the extent.
        spacing : float, optional
            The distance between labels along a line; by default each line has one label.
        index : bool, optional
            Whether only index contours are labeled.

        Returns
        -------
        Labels
            Positions where the lines are straightest, angles, texts, and the number of lines that
            are too short for a label.

        Raises
        ------
        InputError
            `length` or `spacing` is not above 0, or there would be more than a million labels.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (40, 0, 0), (40, 40, 8), (0, 40, 8)])
        >>> tin.contours(interval=1).labels(index=True).text
        ('5',)
        """
        return labels_of(
            [self.coordinates(k) for k in range(len(self))],
            self.level,
            self.index,
            index=index,
            length=length,
            spacing=spacing,
            crs=self.crs,
        )

    def to_shapely(self) -> NDArray[Any]:
        """Return the lines as geometries (extra ``geo``).

        Returns
        -------
        ndarray of shapely.LineString, shape (k,)
            The lines, with the level as third coordinate.

        Raises
        ------
        MissingExtraError
            shapely is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.contours([4.0]).to_shapely()[0].wkt
        'LINESTRING Z (0 2 4, 2 2 4, 4 2 4)'
        """
        shapely = require("shapely", extra="geo", what="geometries")
        z = np.repeat(self.level, np.diff(self.starts))
        found: NDArray[Any] = shapely.from_ragged_array(
            shapely.GeometryType.LINESTRING, np.column_stack((self.points, z)), (self.starts,)
        )
        return found

    def _parts(self) -> Parts:
        """The pieces of the lines between neighboring points, at their heights."""
        from delone.exchange.parts import Parts

        size = np.diff(self.starts)
        first = np.delete(np.arange(len(self.points)), self.starts[1:] - 1)
        line = np.repeat(np.arange(len(self), dtype=np.int32), size - 1)
        return Parts(
            np.column_stack((self.points, np.repeat(self.level, size))),
            np.column_stack((first, first + 1)).astype(np.int32),
            of_simplices={"line": line, "level": self.level[line]},
            crs=self.crs,
        )

    def to_meshio(self) -> Any:
        """Convert to a meshio mesh (extra ``mesh``).

        Returns
        -------
        meshio.Mesh
            Each piece of a line between neighboring points as a cell, at its height, with the
            number and the ``level`` of its line.

        Raises
        ------
        MissingExtraError
            meshio is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.contours([2.0]).to_meshio().points[:, 2].tolist()
        [2.0, 2.0, 2.0]
        """
        from delone.exchange.meshio import to_meshio

        return to_meshio(self._parts())

    def to_pyvista(self) -> Any:
        """Convert to PyVista lines (extra ``pyvista``), at their heights.

        Returns
        -------
        pyvista.PolyData
            As `to_meshio`.

        Raises
        ------
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.contours([2.0]).to_pyvista().cell_data["level"]
        pyvista_ndarray([2., 2.])
        """
        from delone.exchange.pyvista import to_pyvista

        return to_pyvista(self._parts())

    def _geometries(self) -> NDArray[Any]:
        return self.to_shapely()

    def _fields(self) -> dict[str, Any]:
        return {"level": self.level, "index": self.index}

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the lines, index contours wider (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            Properties of matplotlib's lines, such as ``color`` and ``linestyle``; and ``labels``,
            the result of `labels`, or True for labels on index contours (on all contours if there
            are no index contours).

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> ax = tin.contours(interval=1).plot()
        """
        from delone.plot.lines import plot_labels, plot_lines

        labels = options.pop("labels", None)
        if labels is True:
            labels = self.labels(index=bool(self.index.any()))
        runs = [self.coordinates(k) for k in range(len(self))]
        axes = plot_lines(runs, np.where(self.index, 1.2, 0.5), ax, **options)
        if labels:
            plot_labels(labels.points, labels.angle, labels.text, axes)
        return axes


@renamed(rings="ring_starts", polygons="polygon_starts")
@dataclass(frozen=True, eq=False, kw_only=True)
class Bands(ReadOnly, Filed, Layer):
    """The areas between contours, in the order of their heights.

    Parameters
    ----------
    points : ndarray of float64, shape (p, 2)
        The points of all rings, one ring after another. Each ring ends with its first point.
    ring_starts : ndarray of int64, shape (r + 1,)
        The start of each ring in `points`, and the end of the last.
    polygon_starts : ndarray of int64, shape (k + 1,)
        The start of each polygon in the rings: its outer ring, counter-clockwise, then its holes.
    low, high : ndarray of float64, shape (k,)
        The lowest and highest possible height in each polygon: levels, or the lowest height of the
        surface below the first level and the highest above the last.
    left_out : int, optional
        The number of triangles at the outline that are left out because they are thinner than the
        resolution of the coordinates, so that lines in them would cross. Usually 0.
    small : int, optional
        The number of polygons that were merged into the one around them because of `min_area`.
        There, the surface is above `high` or below `low`.
    straightened : int, optional
        The number of points that are left out of borders because of `simplify`.
    flattened : int, optional
        The number of polygons that are left out because their simplified border is an edge of the
        outline, so that they have no area.
    crs : str, optional
        Coordinate reference system.
    units : str, optional
        The unit of heights.

    Notes
    -----
    The columns of `to_geopandas` are ``low``, ``high`` and the geometry.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> hill = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)]
    >>> found = TIN.from_points(hill).bands([1.5])
    >>> found.low.tolist(), found.high.tolist()
    ([0.0, 1.5], [1.5, 3.0])
    """

    points: Floats
    ring_starts: Rows
    polygon_starts: Rows
    low: Floats
    high: Floats
    left_out: int = 0
    small: int = 0
    straightened: int = 0
    flattened: int = 0
    crs: str | None = None
    units: str | None = None

    _ELEMENTS: ClassVar[str] = "polygons"
    _SAVES_CRS: ClassVar[bool] = True

    def _saved(self) -> dict[str, NDArray[Any]]:
        return _arrays_of(self, _AREAS, _AREAS_LEFT_OUT)

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls(**_arguments_of(arrays, _AREAS, _AREAS_LEFT_OUT))

    def __len__(self) -> int:
        return len(self.low)

    def __repr__(self) -> str:
        ranges = len(np.unique(self.low))
        return f"<Bands of {counted(ranges, 'range')}: {counted(len(self), 'polygon')}>"

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the polygons, colored by height (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            ``cmap``, ``colorbar``, ``title``, and properties of matplotlib's lines for outlines,
            such as ``color``, ``linewidth`` and ``linestyle``.

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            An option does not exist.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> ax = tin.bands(interval=2).plot(linewidth=1)
        """
        from delone.plot.bands import plot_bands

        rings = [self.points[a:b] for a, b in pairwise(self.ring_starts.tolist())]
        polygons = [rings[a:b] for a, b in pairwise(self.polygon_starts.tolist())]
        return plot_bands(polygons, self.low, self.high, ax, **options)

    def to_shapely(self) -> NDArray[Any]:
        """Return the polygons as geometries (extra ``geo``).

        Returns
        -------
        ndarray of shapely.Polygon, shape (k,)
            Valid polygons.

        Raises
        ------
        MissingExtraError
            shapely is not installed.

        Notes
        -----
        Polygons share their vertices and do not overlap. `shapely.coverage_is_valid` may be False
        nevertheless: it examines the rings of a polygon one by one, so at a vertex where a hole
        touches its outer ring, it treats the area next to the polygon as part of it.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> [polygon.area for polygon in tin.bands([2.0]).to_shapely()]
        [4.0, 12.0]
        """
        shapely = require("shapely", extra="geo", what="geometries")
        found: NDArray[Any] = shapely.from_ragged_array(
            shapely.GeometryType.POLYGON, self.points, (self.ring_starts, self.polygon_starts)
        )
        return found

    def _geometries(self) -> NDArray[Any]:
        return self.to_shapely()

    def _fields(self) -> dict[str, Any]:
        return {"low": self.low, "high": self.high}


def _arrays_of(
    made: Any, names: tuple[str, ...], counts: tuple[str, ...]
) -> dict[str, NDArray[Any]]:
    """Return the arrays of a file, with counts as one array."""
    found = {name: np.asarray(getattr(made, name)) for name in names}
    numbers = np.array([getattr(made, name) for name in counts], dtype=np.int64)
    texts = {name: np.array(getattr(made, name) or "") for name in ("crs", "units")}
    return found | {"counts": numbers} | texts


def _arguments_of(
    arrays: dict[str, NDArray[Any]], names: tuple[str, ...], counts: tuple[str, ...]
) -> dict[str, Any]:
    """Return the arguments of a constructor from the arrays of a file."""
    found: dict[str, Any] = {name: arrays[name] for name in names}
    found |= dict(zip(counts, arrays["counts"].tolist(), strict=True))
    return found | {name: str(arrays.get(name, "")) or None for name in ("crs", "units")}


def levels_of(
    extremes: Callable[[], tuple[float, float]],
    levels: ArrayLike | None,
    interval: float | None,
    base: float,
    index: int,
) -> tuple[Floats, Bools]:
    """Return ascending levels, each once, and which are index contours.

    An interval gives the levels between the smallest and the largest height, which `extremes`
    returns.
    """
    if (levels is None) == (interval is None):
        raise InputError("give either levels= or interval=")
    if interval is None:
        given = as_plain_array(levels, "levels")
        require_real(given, "levels")
        found = given.astype(np.float64).reshape(-1, 1)
        require_finite(found, name="levels")
        found = np.unique(found)
        return found, np.zeros(len(found), dtype=bool)
    step = as_positive(interval, name="interval", finite=True)
    start = as_finite(base, name="base")
    every, (low, high) = as_count(index, name="index"), extremes()
    first, last = ((each - start) / step for each in (low, high))
    if not last - first < _LEVELS:
        raise BudgetExceededError(
            f"an interval of {step:g} gives {last - first:.3g} levels between the heights "
            f"{low:g} and {high:g}; at most {_LEVELS} are possible",
            limit=_LEVELS,
            found=LARGEST_LIMIT if not last - first < LARGEST_LIMIT else int(last - first),
        )
    return _multiples(low, high, exact(start), exact(step), every)


def _multiples(
    low: float, high: float, start: Fraction, step: Fraction, every: int
) -> tuple[Floats, Bools]:
    """Return the doubles nearest to multiples between two heights; every `every`-th one."""
    # One more on each side: a height may be the double that is nearest to a multiple.
    first, last = (Fraction(each) - start for each in (low, high))
    numbers = np.arange(math.ceil(first / step) - 1, math.floor(last / step) + 2)
    try:
        found = multiples(start, step, numbers.tolist())
    except OverflowError:
        numbers = numbers[1:-1]
        found = multiples(start, step, numbers.tolist())
    within = (found >= low) & (found <= high)
    marked = numbers % every == 0 if every else np.zeros(len(numbers), dtype=bool)
    return found[within], np.asarray(marked)[within]


class Drawn(NamedTuple):
    """Lines as the core computes them, with the level number of each, and triangles left out."""

    points: Floats
    starts: Rows
    level: NDArray[np.int32]
    left_out: int
    outline: Floats | None  # its edges, (k, 2, 2), needed to simplify lines


class Finish(NamedTuple):
    """What is done with lines after they are computed."""

    smooth: int
    min_length: float
    min_area: float
    simplify: float

    @classmethod
    def of(cls, smooth: Any, min_length: Any, min_area: Any, simplify: Any) -> Finish:
        """Check the options."""
        return cls(
            as_index(smooth, 0, _MOST_ROUNDS, name="smooth"),
            as_nonnegative(min_length, name="min_length", finite=True),
            as_nonnegative(min_area, name="min_area", finite=True),
            as_nonnegative(simplify, name="simplify", finite=True),
        )

    @property
    def factor(self) -> int:
        """The largest factor by which smoothing multiplies points: each round doubles them."""
        return 1 << self.smooth


def lines(tin: Surface, levels: Floats, marked: Bools, max_points: int, finish: Finish) -> Contours:
    """Return the contours of a surface."""
    made, sheet, left_out = _within(_core.contour_lines2, tin, levels, max_points, finish.factor)
    outline = _outline(sheet) if finish.simplify else None
    drawing = Drawn(made.points, made.starts, made.levels, left_out, outline)
    return finished(drawing, (levels, marked), finish, tin, tin.crs, tin.units)


def finished(  # noqa: PLR0917
    drawing: Drawn,
    of: tuple[Floats, Bools],
    finish: Finish,
    tin: Surface | None,
    crs: str | None,
    units: str | None,
) -> Contours:
    """Smooth lines, leave out small ones, and simplify the rest.

    Smoothing keeps corners on hard breaklines of `tin`, if there is one.
    """
    from delone.terrain.generalizing import simplified
    from delone.terrain.smoothing import smoothed

    points, starts, level, left_out, outline = drawing
    levels, marked = of
    every = len(level)
    if finish.smooth:
        points, starts = smoothed(points, starts, tin, finish.smooth)
    small = 0
    if finish.min_area:
        closed = (points[starts[:-1]] == points[starts[1:] - 1]).all(axis=1)
        kept = ~closed | (np.abs(ring_areas(points, starts)) >= finish.min_area)
        small = int((~kept).sum())
        points, starts, level = *_only(points, starts, kept), level[kept]
    if finish.min_length:
        kept = _lengths(points, starts) >= finish.min_length
        points, starts, level = *_only(points, starts, kept), level[kept]
    before = len(points)
    if finish.simplify:
        points, starts = simplified(points, starts, finish.simplify, outline)
    return Contours(
        points=points,
        starts=starts,
        level=levels[level],
        index=marked[level],
        levels=levels,
        left_out=left_out,
        short=every - len(level) - small,
        small=small,
        straightened=before - len(points),
        crs=crs,
        units=units,
    )


def _outline(sheet: Sheet) -> Floats:
    """Return the edges at the outline of a surface, (k, 2, 2)."""
    return sheet.points[topology.boundary_edges(sheet.simplices, sheet.neighbors)]


def _lengths(points: Floats, starts: Rows) -> Floats:
    """Return the lengths of lines, rounded."""
    steps = np.zeros(len(points))
    steps[1:] = np.hypot(*np.diff(points, axis=0).T)
    # Not from the end of a line to the start of the next; each line has at least two points.
    steps[starts[:-1]] = 0.0
    return np.add.reduceat(steps, starts[:-1]) if len(starts) > 1 else np.zeros(0)


def _only(points: Floats, starts: Rows, kept: Bools) -> tuple[Floats, Rows]:
    """Return the points and starts of the lines that are kept."""
    counts = np.diff(starts)
    ends = np.concatenate(([0], np.cumsum(counts[kept])))
    return np.ascontiguousarray(points[np.repeat(kept, counts)]), ends


def _within(
    compute: Any, tin: Surface, levels: Floats, max_points: int, factor: int
) -> tuple[Any, Sheet, int]:
    """Compute contours that have at most `max_points` points after multiplication by `factor`.

    The core counts them before it computes them. Also return the surface that they belong to, and
    the number of triangles that were left out.
    """
    limit, workers = as_count(max_points, name="max_points"), as_workers(tin.workers)
    try:
        return drawn(
            lambda sheet, *how: compute(sheet, levels, limit // factor, *how, workers),
            tin._sheet(),
        )
    except BudgetExceededError as error:
        found = error.found * factor
        most = "" if factor == 1 else "at most "
        raise BudgetExceededError(
            f"{counted(len(levels), 'level')} would give contours of {most}{found:,} points, more "
            f"than {limit:,}: choose fewer levels, or raise max_points",
            limit=limit,
            found=found,
        ) from error


def bands(tin: Surface, levels: Floats, min_area: float, simplify: float, max_points: int) -> Bands:
    """Return the polygons between contours of a surface."""
    from delone.terrain.borders import simplified_borders
    from delone.terrain.holes import with_holes_inside

    smallest, tolerance = (
        as_nonnegative(min_area, name="min_area", finite=True),
        as_nonnegative(simplify, name="simplify", finite=True),
    )
    made, _, left_out = _within(_core.contour_bands2, tin, levels, max_points, 1)
    used = tin.z[on_surface(tin)]
    ends = np.concatenate(([used.min()], levels, [used.max()]))
    drawing = Rings(made.points, made.rings, made.polygons)
    found, rows = with_holes_inside(drawing, made.bands), np.arange(len(made.bands))
    if smallest:
        found, rows = without_small(found, smallest)
    small, straightened, flattened = len(made.bands) - len(rows), 0, 0
    if tolerance and len(rows):
        before = len(rows)
        found, left, straightened = simplified_borders(found, made.bands[rows], tolerance)
        rows = rows[left]
        flattened = before - len(rows)
    band = made.bands[rows]
    return Bands(
        points=found.points,
        ring_starts=found.rings,
        polygon_starts=found.polygons,
        low=ends[band],
        high=ends[band + 1],
        left_out=left_out,
        small=small,
        straightened=straightened,
        flattened=flattened,
        crs=tin.crs,
        units=tin.units,
    )
