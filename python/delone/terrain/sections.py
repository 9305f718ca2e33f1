"""Profiles of several surfaces along one line, and cross sections along an alignment."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._base.arrays import as_number, as_plain_array
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.immutable import ReadOnly, sealed
from delone._base.numbers import as_finite, as_positive
from delone.errors import BudgetExceededError, DtypeError, InputError
from delone.terrain.layer import Layer
from delone.terrain.lines import line_of
from delone.terrain.profiles import profile
from delone.terrain.volumes import goal_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Rows
    from delone.terrain.surface import Surface

__all__ = ["CrossSections", "Profiles", "cross_sections", "profiles"]

# The maximum number of stations.
_STATIONS = 100_000
# Distances that differ by at most this fraction of the length of the line are one row, and a
# station this close to a corner of the alignment is at the corner: both differ only by rounding
# errors.
_ROUNDING = 1e-12
_END, _GAP, _PLAIN = range(3)  # kinds of rows, in the order in which they follow each other
# Names of surfaces must not be those of other columns.
_TAKEN = ("distance", "station", "offset", "x", "y")


@dataclass(frozen=True, eq=False, kw_only=True)
class Profiles(ReadOnly):
    """Heights of several surfaces along one line, at common distances.

    Parameters
    ----------
    distances : ndarray of float64, shape (k,)
        Horizontal distances from the start of the line: wherever one of the surfaces has an edge or
        ends, and at the points of the line.
    z : ndarray of float64, shape (k, s)
        The height of each surface there; NaN outside it.
    points : ndarray of float64, shape (k, 2)
        The positions.
    names : tuple of str
        The names of the surfaces.
    crs, units : str, optional
        The reference system, and the unit of heights.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> ground = TIN.from_points([(0, 0, 0), (8, 0, 0), (8, 8, 8), (0, 8, 8)])
    >>> design = TIN.from_points([(0, 0, 3), (8, 0, 3), (8, 4, 3), (0, 4, 3)])
    >>> found = ground.profiles([(1, 0), (1, 8)], {"design": design})
    >>> found
    <Profiles of 2 surfaces: 5 points over 8>
    >>> found.to_pandas()[["distance", "surface", "design"]].values.tolist()[1:3]
    [[0.5, 0.5, 3.0], [1.0, 1.0, 3.0]]
    """

    distances: Floats
    z: Floats
    points: Floats
    names: tuple[str, ...]
    crs: str | None = None
    units: str | None = None

    def __len__(self) -> int:
        return len(self.distances)

    def __repr__(self) -> str:
        length = float(self.distances[-1]) if len(self) else 0.0
        return (
            f"<Profiles of {counted(len(self.names), 'surface')}: {counted(len(self), 'point')} "
            f"over {length:.6g}>"
        )

    def to_pandas(self, data: Any = None) -> Any:
        """Return a table (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each row of the table.

        Returns
        -------
        pandas.DataFrame
            ``distance``, a column with the heights of each surface, ``x`` and ``y``. A surface has
            a gap, or ends, where its height is NaN.

        Raises
        ------
        MissingExtraError
            pandas is not installed.
        InputError
            `data` does not have one row for each, or has a column with the same name as one of the
            table.

        Examples
        --------
        See `TIN.profiles`.
        """
        from delone.exchange.geopandas import columns_beside

        heights = dict(zip(self.names, self.z.T, strict=True))
        x, y = self.points.T
        own = {"distance": self.distances} | heights | {"x": x, "y": y}
        return columns_beside(own, data, of="rows")

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the heights of all surfaces over distances (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            Options of ``Axes.plot`` for all lines, such as ``linewidth``.

        Returns
        -------
        matplotlib Axes
            The axes, with a legend.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (8, 0, 0), (8, 8, 8), (0, 8, 8)])
        >>> design = TIN.from_points([(0, 0, 3), (8, 0, 3), (8, 4, 3), (0, 4, 3)])
        >>> ax = ground.profiles([(1, 0), (1, 8)], {"design": design}).plot()
        """
        from delone.plot.lines import plot_profiles

        return plot_profiles(self.distances, self.z, self.names, ax, **options)


@dataclass(frozen=True, eq=False, kw_only=True)
class CrossSections(ReadOnly, Layer):
    """Profiles across an alignment, one for each station.

    Parameters
    ----------
    stations : ndarray of float64, shape (k,)
        Distances along the alignment, plus `start`.
    centers : ndarray of float64, shape (k, 2)
        The positions of the stations.
    ends : ndarray of float64, shape (k, 2, 2)
        The left and the right end of each section.
    left : float
        The distance from the left end to the alignment.
    sections : tuple of Profiles
        The heights along each section, from left to right.
    crs, units : str, optional
        The reference system, and the unit of heights.

    Notes
    -----
    The columns of `to_geopandas` are ``station`` and the geometry, the line from left to right.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 9), (0, 90, 9)])
    >>> found = ground.cross_sections([(20, 20), (80, 20)], interval=25, left=10)
    >>> found
    <CrossSections of 1 surface: 4 stations from 0 to 60, 10 to the left, 10 to the right>
    >>> found.offsets_of(0).round(9).tolist(), found.sections[0].z.ravel().round(9).tolist()
    ([-10.0, 0.0, 10.0], [3.0, 2.0, 1.0])
    """

    stations: Floats
    centers: Floats
    ends: Floats
    left: float
    right: float
    sections: tuple[Profiles, ...]
    crs: str | None = None
    units: str | None = None

    _ELEMENTS: ClassVar[str] = "sections"

    def __len__(self) -> int:
        return len(self.stations)

    def __repr__(self) -> str:
        low, high = self.stations[0], self.stations[-1]
        return (
            f"<CrossSections of {counted(len(self.sections[0].names), 'surface')}: "
            f"{counted(len(self), 'station')} from {low:.6g} to {high:.6g}, "
            f"{self.left:.6g} to the left, {self.right:.6g} to the right>"
        )

    def offsets_of(self, section: int) -> Floats:
        """Return the distances from the alignment of the points of a section.

        Parameters
        ----------
        section : int
            Its number.

        Returns
        -------
        ndarray of float64, shape (j,)
            Negative to the left of the alignment, as seen in its direction.

        Examples
        --------
        See `CrossSections`.
        """
        return sealed(self.sections[section].distances - self.left)

    def to_pandas(self, data: Any = None) -> Any:
        """Return one table of all sections (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each section; its values are repeated in all rows
            of the section.

        Returns
        -------
        pandas.DataFrame
            ``station``, ``offset`` (negative to the left), a column with the heights of each
            surface, ``x`` and ``y``.

        Raises
        ------
        MissingExtraError
            pandas is not installed.
        InputError
            `data` does not have one row for each section, or has a column with the same name as one
            of the table.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 9), (0, 90, 9)])
        >>> table = ground.cross_sections([(20, 20), (80, 20)], interval=60, left=5).to_pandas()
        >>> table.groupby("station").surface.max().round(9).tolist()
        [2.5, 2.5]
        """
        from delone.exchange.geopandas import columns_beside

        sizes = [len(one) for one in self.sections]
        offsets = [self.offsets_of(row) for row in range(len(self))]
        heights = np.concatenate([one.z for one in self.sections])
        x, y = np.concatenate([one.points for one in self.sections]).T
        own = {"station": np.repeat(self.stations, sizes), "offset": np.concatenate(offsets)}
        own |= dict(zip(self.sections[0].names, heights.T, strict=True)) | {"x": x, "y": y}
        return columns_beside(own, data, of="sections", repeats=sizes)

    def _geometries(self) -> NDArray[Any]:
        shapely = require("shapely", extra="geo", what="geometries")
        found: NDArray[Any] = shapely.linestrings(self.ends)
        return found

    def _fields(self) -> dict[str, Any]:
        return {"station": self.stations}

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot the sections in plan, with their stations (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            Properties of matplotlib's lines, such as ``color``.

        Returns
        -------
        matplotlib Axes
            The axes. ``sections[k].plot()`` draws one section, and `figure` draws all.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 9), (0, 90, 9)])
        >>> ax = ground.cross_sections([(20, 20), (80, 20)], interval=20, left=5).plot()
        """
        from delone.plot.lines import plot_stations

        return plot_stations(self.ends, self.centers, self.stations, ax, **options)

    def figure(self, *, columns: int = 3) -> Any:
        """Draw all sections side by side, at the same scale (extra ``plot``).

        Parameters
        ----------
        columns : int, optional
            The number of sections in a row.

        Returns
        -------
        matplotlib Figure
            A figure with axes for each section, in the order of the stations.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            `columns` is below 1.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 9), (0, 90, 9)])
        >>> figure = ground.cross_sections([(20, 20), (80, 20)], interval=20, left=5).figure()
        >>> len(figure.axes)
        4
        """
        from delone.plot.sections import draw_sections

        tables = [(self.offsets_of(k), one.z) for k, one in enumerate(self.sections)]
        return draw_sections(self.stations, tables, self.sections[0].names, columns)


def named(tin: Surface, others: Any, name: str) -> dict[str, Surface]:
    """Return a surface and the others to compare with it, by name."""
    if others is None:
        others = {}
    elif hasattr(others, "_sheet"):
        others = {"other": others}
    elif not isinstance(others, Mapping):
        others = {f"other {k + 1}": other for k, other in enumerate(others)}
    if name in others or set(_TAKEN) & {name, *others}:
        raise InputError(
            f"the names of surfaces must differ, and not be one of {', '.join(_TAKEN)}; got "
            f"{', '.join(map(repr, [name, *others]))}"
        )
    for key, other in others.items():
        if not hasattr(other, "_sheet"):
            raise DtypeError(f"surface {key!r:.40} must be a TIN, got {type(other).__name__}")
        goal_of(tin, other)
    return {name: tin, **others}


def profiles(tin: Surface, line: Any, others: Any, name: str) -> Profiles:
    """Return the heights of surfaces along a line."""
    surfaces = named(tin, others, name)
    return _common(surfaces, line_of(line, name="line", crs=tin.crs), tin)


def _common(surfaces: Mapping[str, Surface], line: Floats, tin: Surface) -> Profiles:
    """Return profiles along a line with common distances."""
    found = [profile(each, line) for each in surfaces.values()]
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
    known = [~np.isnan(one.z) for one in found]
    every = np.sort(
        np.concatenate([one.distances[at] for one, at in zip(found, known, strict=True)])
    )
    common = every[np.append(True, np.diff(every) > _ROUNDING * along[-1])[: len(every)]]
    places = np.column_stack([np.interp(common, along, axis) for axis in line.T])
    parts, gaps = [], []
    for k, (one, at) in enumerate(zip(found, known, strict=True)):
        # Each distance is replaced by the common one from which it differs only by rounding.
        row = np.searchsorted(common, one.distances, side="right") - 1
        places[row[at]] = one.points[at]
        own = _split(common[np.maximum(row, 0)] if len(common) else one.distances, one.z)
        parts.append(own)
        gaps += [(k, before[0][-1], after[0][0]) for before, after in pairwise(own)]
    rows, own_rows = _rows(common, gaps, len(found))
    distances = common[rows[:, 0]] if len(rows) else np.empty(0)
    return Profiles(
        distances=distances,
        z=np.column_stack(
            [
                _heights(column, distances, own)
                for column, own in zip(own_rows.T, parts, strict=True)
            ]
        ),
        points=places[rows[:, 0]],
        names=tuple(surfaces),
        crs=tin.crs,
        units=tin.units,
    )


def _split(distances: Floats, z: Floats) -> list[tuple[Floats, Floats]]:
    """Return the distances and heights of the parts of a profile between gaps."""
    gaps = np.flatnonzero(np.isnan(z)).tolist()
    return [
        (distances[start:stop], z[start:stop])
        for start, stop in zip([0, *(gap + 1 for gap in gaps)], [*gaps, len(z)], strict=True)
        if stop > start
    ]


def _rows(common: Floats, gaps: list[tuple[int, float, float]], count: int) -> tuple[Rows, Rows]:
    """Return the rows of a table as distances and kinds, (r, 2), and what each surface has there.

    Where nothing lies between two parts of a surface, there is a row with a gap before the second
    one; if both are at one distance, also one with the end of the first. In such rows, all surfaces
    with a part that starts there also have a gap.
    """
    kinds = [(k, _PLAIN) for k in range(len(common))]
    starting: dict[int, list[tuple[int, int]]] = {}
    for surface, end, start in gaps:
        before, after = np.searchsorted(common, (end, start)).tolist()
        starting.setdefault(after, []).append((surface, before))
    for after, several in starting.items():
        nearest = max(before for _, before in several)
        kinds += [(after, _GAP)] if after - nearest < 2 else []
        kinds += [(after, _END)] if after == nearest else []
    rows = np.array(sorted(kinds), dtype=np.int64).reshape(-1, 2)
    own = np.full((len(rows), count), _PLAIN)
    for row, (at, kind) in enumerate(rows.tolist()):
        for surface, before in starting.get(at, ()) if kind != _PLAIN else ():
            own[row, surface] = _END if kind == _END and before == at else _GAP
    return rows, own


def _heights(own: Rows, distances: Floats, parts: list[tuple[Floats, Floats]]) -> Floats:
    """Return the heights of a surface in the rows of a table."""
    first, last = np.full((2, len(own)), np.nan)
    for found, several in ((last, parts), (first, parts[::-1])):
        for at, z in several:
            within = (distances >= at[0]) & (distances <= at[-1])
            found[within] = np.interp(distances[within], at, z)
    heights = np.where(own == _END, first, last)
    heights[own == _GAP] = np.nan
    return heights


def cross_sections(  # noqa: PLR0917
    tin: Surface,
    line: Any,
    interval: float | None,
    stations: ArrayLike | None,
    start: float,
    left: float,
    right: float | None,
    others: Any,
    name: str,
) -> CrossSections:
    """Return profiles across an alignment."""
    surfaces = named(tin, others, name)
    alignment = line_of(line, name="line", crs=tin.crs)
    widths = [as_number(left, name="left")]
    widths.append(widths[0] if right is None else as_number(right, name="right"))
    for side, width in zip(("left", "right"), widths, strict=True):
        if not (np.isfinite(width) and width >= 0):
            raise InputError(f"{side} must be finite and at least 0, got {width:g}")
    if not max(widths):
        raise InputError("left and right are both 0: cross sections have no length")
    moved = np.append(True, (np.diff(alignment, axis=0) != 0).any(axis=1))
    alignment = alignment[moved]
    along = np.append(0.0, np.cumsum(np.hypot(*np.diff(alignment, axis=0).T)))
    origin = as_number(start, name="start")
    at = _stations(along[-1], interval, stations, origin)
    centers, aside = _across(alignment, along, at)
    ends = np.stack((centers - widths[0] * aside, centers + widths[1] * aside), axis=1)
    return CrossSections(
        stations=at + origin,
        centers=centers,
        ends=ends,
        left=float(widths[0]),
        right=float(widths[1]),
        sections=tuple(_common(surfaces, section, tin) for section in ends),
        crs=tin.crs,
        units=tin.units,
    )


def _stations(
    length: float, interval: float | None, stations: ArrayLike | None, origin: float
) -> Floats:
    """Return distances from the start of an alignment."""
    if (interval is None) == (stations is None):
        raise InputError("give either an interval or stations")
    as_finite(origin, name="start")
    if stations is not None:
        given = as_plain_array(stations, "stations")
        if given.ndim != 1 or given.dtype.kind not in "iuf":
            raise DtypeError("stations must be a row of real numbers")
        at = given.astype(np.float64) - origin
        slack = _ROUNDING * (length + abs(origin))
        bad = np.flatnonzero(~((at >= -slack) & (at <= length + slack)))
        if len(bad):
            raise InputError(
                f"{counted(len(bad), 'station')} outside the line, which has stations from "
                f"{origin:.10g} to {origin + length:.10g}; first row {bad[0]}: {given[bad[0]]:.10g}"
            )
        if not len(at):
            raise InputError("stations is empty")
        return np.clip(at, 0.0, length)
    step = as_positive(interval, name="interval", finite=True)
    if not length / step < _STATIONS:
        raise BudgetExceededError(
            f"an interval of {step:g} gives {length / step:.3g} stations on {length:.6g}; at most "
            f"{_STATIONS:,} are possible",
            limit=_STATIONS,
            found=int(min(length / step, 2.0**62)),
        )
    every = np.arange(math.floor(length / step) + 1).astype(np.float64) * step
    # The end, unless a multiple is there up to rounding.
    return np.append(every[length - every > _ROUNDING * length], length)


def _across(line: Floats, along: Floats, at: Floats) -> tuple[Floats, Floats]:
    """Return positions on a line, and unit vectors to the right of it.

    At a corner, the vector bisects the angle; for a line that turns back, it is that of the first
    segment.
    """
    steps = np.diff(line, axis=0)
    ways = steps / np.hypot(*steps.T)[:, None]
    before = np.clip(np.searchsorted(along, at, side="left") - 1, 0, len(ways) - 1)
    after = np.clip(np.searchsorted(along, at, side="right") - 1, 0, len(ways) - 1)
    # Stations within a rounding error of a corner are at the corner.
    later = np.clip(np.searchsorted(along, at), 1, len(along) - 1)
    near = np.where(at - along[later - 1] < along[later] - at, later - 1, later)
    corner = np.abs(along[near] - at) <= _ROUNDING * along[-1]
    before = np.where(corner, np.maximum(near - 1, 0), before)
    after = np.where(corner, np.minimum(near, len(ways) - 1), after)
    way = ways[before] + ways[after]
    size: Floats = np.hypot(*way.T)
    back = size <= _ROUNDING
    way[back], size[back] = ways[before[back]], 1.0
    way /= size[:, None]
    share = ((at - along[before]) / np.diff(along)[before])[:, None]
    centers = line[before] + share * steps[before]
    centers[corner] = line[near[corner]]
    return centers, np.column_stack((way[:, 1], -way[:, 0]))
