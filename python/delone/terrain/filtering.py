"""Ground points in lidar: progressive densification of a triangulation (P. Axelsson, 2000).

A coarse triangulation of the lowest points of cells is below buildings and trees. Each pass inserts
points that are close to their triangle and form a small angle with it at its corners: of the points
nearest to the same corner, the one with the smallest angle. So the triangulation climbs gradual
slopes and stays below whatever rises steeply. The mesh is dynamic: a pass only inserts points and
never retriangulates.

P. Axelsson, "DEM generation from laser scanner data using adaptive TIN models", International
Archives of Photogrammetry and Remote Sensing 33, B4, 2000.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_flag, as_least, as_number
from delone._base.counting import agreed, counted
from delone._base.immutable import ReadOnly, sealed
from delone._base.numbers import as_nonnegative, as_positive
from delone._base.units import METERS, lengths_of_crs
from delone.dynamic.dynamic import Dynamic
from delone.errors import InputError
from delone.terrain import building, slopes
from delone.terrain.agreement import Agreement, agreement

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices, Rows

__all__ = ["Ground", "ground"]

# Defaults in meters. Axelsson's angle and distance are medians of the data; these are close to
# those of urban ground. A cell is wider than most buildings.
_METERS = {"cell": 20.0, "distance": 1.4, "edge": 1.0, "thickness": 0.1, "low": 1.0}
# At most this many points below a gap are measurement errors; more are a pit. With fewer points
# around than the second number, no point is rejected.
_FEW, _MANY = 5, 20
# The maximum number of cells along an axis.
_MOST_CELLS = 1 << 30
# Number of points that are measured at a time.
_BLOCK = 1 << 19


class _Limits(NamedTuple):
    """The parameters, in the unit of the points."""

    cell: float
    distance: float
    edge: float
    thickness: float
    low: float
    sine: float  # of the angle
    tangent: float
    mirror: bool


@dataclass(frozen=True, eq=False, kw_only=True)
class Ground(ReadOnly):
    """Which points are ground.

    Parameters
    ----------
    mask : ndarray of bool, shape (n,)
        Which points are ground.
    outliers : ndarray of bool, shape (n,)
        Which points are measurement errors below the ground.
    seeds : int
        The number of points with which the triangulation began.
    added : tuple of int
        The number of points that each pass added to the triangulation.
    converged : bool
        Whether the last pass added none, so that further passes would change nothing.

    Examples
    --------
    See `ground`.
    """

    mask: Bools
    outliers: Bools
    seeds: int
    added: tuple[int, ...]
    converged: bool

    def __len__(self) -> int:
        return len(self.mask)

    def __repr__(self) -> str:
        found = int(np.count_nonzero(self.mask))
        passes = f"{len(self.added)} {agreed(len(self.added), 'pass', 'passes')}"
        end = "" if self.converged else ", not converged"
        low = int(np.count_nonzero(self.outliers))
        beside = f", {counted(low, 'low outlier')}" if low else ""
        return f"<Ground: {found} of {counted(len(self), 'point')}{beside}; {passes}{end}>"

    def compare(self, reference: ArrayLike) -> Agreement:
        """Compare with a reference classification.

        Parameters
        ----------
        reference : array_like of bool, shape (n,)
            Which points are ground.

        Returns
        -------
        Agreement
            Cohen's kappa, and the type I and type II errors.

        Raises
        ------
        InputError
            `reference` does not have one boolean for each point.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.terrain import ground
        >>> x, y = np.meshgrid(np.arange(40.0), np.arange(40.0))
        >>> house = (abs(x - 20) < 6) & (abs(y - 20) < 6)
        >>> found = ground(np.column_stack((x.ravel(), y.ravel(), 5.0 * house.ravel())))
        >>> found.compare(~house.ravel())
        <Agreement: kappa 1.000, type I 0.0 %, type II 0.0 %>
        """
        return agreement(self.mask, reference)


def ground(
    points: Any,
    *,
    cell: float | None = None,
    angle: float = 6.0,
    distance: float | None = None,
    mirror: bool = True,
    edge: float | None = None,
    thickness: float | None = None,
    low: float | None = None,
    max_iter: int = 50,
    crs: Any = None,
    planar: bool = False,
    workers: int | None = None,
) -> Ground:
    """Find the ground among the points of a lidar survey, by progressive TIN densification.

    Parameters
    ----------
    points : array_like, shape (n, 3), or PointSet with heights
        The points, with x, y and heights in one unit of length.
    cell : float, optional
        Width of the cells whose lowest points form the first surface: larger than the largest
        building. By default 20 m.
    angle : float, optional
        Largest angle, in degrees, between a triangle and the line from one of its corners to a
        point that is added to the surface.
    distance : float, optional
        Largest distance of such a point from the plane of the triangle. By default 1.4 m.
    mirror : bool, optional
        In triangles steeper than `angle`, test a point that fails a second time, at its mirror
        image about the highest corner, with its own height: this finds edges of embankments.
    edge : float, optional
        Triangles whose edges are all shorter than this get no more points. By default 1 m.
    thickness : float, optional
        Finally, all points within this vertical distance of the surface are ground: the noise of
        the survey. By default 0.1 m.
    low : float, optional
        Up to five points in a cell and its neighbors that are lower than all others there by more
        than this are outliers, if there are at least 20 points. By default 1 m.
    max_iter : int, optional
        Maximum number of passes. Each adds at most three points in each triangle, those with the
        smallest angles near its corners.
    crs : optional
        Coordinate reference system, as for `TIN.from_points`. If it is in feet, the defaults are
        converted; if it is unknown, the numbers above are used.
    planar : bool, optional
        Whether longitudes and latitudes are intentional, without a warning.
    workers : int, optional
        Maximum number of threads; by default one per core.

    Returns
    -------
    Ground
        A mask of the points, and a report.

    Raises
    ------
    InputError
        There are no points, or a parameter is out of range.
    ShapeError, DtypeError, NonFiniteError, MemoryError
        As for `TIN.from_points`.

    Warns
    -----
    GeographicWarning
        x and y are degrees.

    Notes
    -----
    The result does not depend on the order of the points, except for rounding errors of distances
    and angles that are exactly at a limit. What is ground is an estimate, but the triangulation
    itself is exact: each pass inserts points into a `Dynamic`.

    Beyond the lowest points, the surface extends to four points outside the corners of the survey,
    each with the height of the nearest lowest point.

    Each pass tests all remaining points, in time roughly proportional to their number.

    References
    ----------
    P. Axelsson, "DEM generation from laser scanner data using adaptive TIN models", International
    Archives of Photogrammetry and Remote Sensing 33, B4, 2000.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.terrain import TIN, ground
    >>> x, y = np.meshgrid(np.arange(60.0), np.arange(60.0))
    >>> house = (abs(x - 30) < 6) & (abs(y - 30) < 6)
    >>> xyz = np.column_stack((x.ravel(), y.ravel(), (x / 20 + 6 * house).ravel()))
    >>> found = ground(xyz)
    >>> found
    <Ground: 3479 of 3600 points; 29 passes>
    >>> TIN.from_points(xyz[found.mask]).heights((30, 30)).round(2)
    np.float64(1.5)
    """
    flat, z, system, _ = building.bare(points, crs=crs, units=None, planar=planar)
    if not len(z):
        raise InputError("there are no points, so there is no ground")
    given = {"cell": cell, "distance": distance, "edge": edge, "thickness": thickness, "low": low}
    limits = _limits(given, angle, mirror, lengths_of_crs(system))
    passes = as_least(max_iter, 1, name="max_iter")
    own = _cells(flat, limits.cell)
    outliers = z < _lowest_kept(own, z, limits.low)
    surface = _Surface(flat, z, _seeds(flat, z, own, outliers), limits.cell, workers)
    left = np.flatnonzero(~outliers & ~surface.joined)
    seeds, added = int(surface.joined.sum()), []
    # Each pass but the last adds a point, and their number is limited.
    for _ in range(passes):
        chosen = _chosen(surface, left, limits)
        added.append(len(chosen))
        if not len(chosen):
            break
        surface.join(chosen)
        left = left[~surface.joined[left]]
    mask = surface.joined.copy()
    for rows in _blocks(left):
        near = np.abs(surface.seen(surface.places(rows)).above) <= limits.thickness
        mask[rows[near]] = True
    return Ground(
        mask=sealed(mask),
        outliers=sealed(outliers),
        seeds=seeds,
        added=tuple(added),
        converged=added[-1] == 0,
    )


def _limits(given: dict[str, Any], angle: Any, mirror: Any, unit: str | None) -> _Limits:
    """Check the parameters, with defaults in the unit of the points."""
    found = {}
    for name, value in given.items():
        default = _METERS[name] / METERS[unit or "m"]
        check = as_positive if name in ("cell", "distance", "low") else as_nonnegative
        found[name] = check(default if value is None else value, name=name, finite=True)
    steep = as_number(angle, name="angle")
    if not 0 < steep < 90:
        raise InputError(f"angle must be between 0 and 90 degrees, got {angle!r:.60}")
    turn = np.radians(steep)
    return _Limits(
        **found,
        sine=float(np.sin(turn)),
        tangent=float(np.tan(turn)),
        mirror=as_flag(mirror, name="mirror"),
    )


class _Cells(NamedTuple):
    """The cells of points: those with points, in order, and the cell of each point."""

    keys: Rows  # of the cells, ascending
    stride: int  # of the keys of adjacent cells
    cell: Rows  # of each point, a row of `keys`


def _cells(flat: Floats, width: float) -> _Cells:
    low = flat.min(axis=0)
    span = np.ptp(flat, axis=0)
    with np.errstate(over="ignore"):
        many = not (span / width < _MOST_CELLS).all()
    if many or (low - width == low).any():
        raise InputError(
            f"cell={width:g} is too small for points that extend over {span[0]:g} x {span[1]:g}"
        )
    column, row = np.floor((flat - low) / width).astype(np.int64).T
    # One empty cell on each side, so that neighbors have fixed differences of numbers.
    stride = int(row.max()) + 3
    keys, cell = np.unique((column + 1) * stride + row + 1, return_inverse=True)
    return _Cells(keys, stride, cell.ravel())


def _lowest_kept(cells: _Cells, z: Floats, gap: float) -> Floats:
    """Return, for each point, the height below which points of its cell are outliers."""
    order = np.lexsort((z, cells.cell))
    first = np.searchsorted(cells.cell[order], np.arange(len(cells.keys)))
    rank = np.arange(len(order)) - first[cells.cell[order]]
    few = rank <= _FEW
    own = np.full((len(cells.keys) + 1, _FEW + 1), np.inf)
    own[cells.cell[order[few]], rank[few]] = z[order[few]]
    # The lowest points of each cell and of those around it.
    around, number = [], np.zeros(len(cells.keys), dtype=np.int64)
    counts = np.append(np.bincount(cells.cell), 0)
    for step in [x * cells.stride + y for x in (-1, 0, 1) for y in (-1, 0, 1)]:
        at = np.searchsorted(cells.keys, cells.keys + step)
        at[at == len(cells.keys)] = 0
        there = cells.keys[at] == cells.keys + step
        at = np.where(there, at, -1)
        around.append(own[at])
        number += counts[at]
    lowest = np.sort(np.concatenate(around, axis=1), axis=1)[:, : _FEW + 1]
    known = np.isfinite(lowest[:, 1:])
    with np.errstate(invalid="ignore", over="ignore"):
        jump = (np.diff(lowest, axis=1) > gap) & known
    jump[number < _MANY] = False
    kept: Floats = np.where(jump, lowest[:, 1:], -np.inf).max(axis=1)[cells.cell]
    return kept


def _seeds(flat: Floats, z: Floats, cells: _Cells, outliers: Bools) -> Rows:
    """Return the lowest point of each cell; of several, the first by coordinates."""
    rows = np.flatnonzero(~outliers)
    order = rows[np.lexsort((flat[rows, 1], flat[rows, 0], z[rows], cells.cell[rows]))]
    _, first = np.unique(cells.cell[order], return_index=True)
    return order[first]


class _Seen(NamedTuple):
    """Points in relation to the triangles below or above them."""

    simplex: Indices
    above: Floats  # the vertical distance from the plane
    away: Floats  # the distance from the plane
    sine: Floats  # of the largest angle between the plane and the lines from the corners
    nearest: Rows  # the number of the nearest corner


class _Surface:
    """A dynamic triangulation of four corners and the points inserted so far."""

    def __init__(
        self, flat: Floats, z: Floats, rows: Rows, width: float, workers: int | None
    ) -> None:
        self._flat, self._z = flat, z
        low, high = flat.min(axis=0) - width, flat.max(axis=0) + width
        box = np.array([low, (high[0], low[1]), high, (low[0], high[1])])
        self._mesh = Dynamic(flat[rows], planar=True, workers=workers)
        self._heights = np.concatenate((z[rows], z[rows][self._mesh.nearest(box)]))
        self._mesh.insert(box)
        self.joined = np.zeros(len(z), dtype=bool)
        self.joined[rows] = True
        self._look()

    def _look(self) -> None:
        """Take the arrays of the current triangles."""
        self.points, self.simplices = self._mesh.points, self._mesh.simplices
        self.gradients = slopes.gradient(self.points, self._heights, self.simplices)

    def join(self, rows: Rows) -> None:
        """Insert points."""
        self._mesh.insert(self._flat[rows])
        self._heights = np.concatenate((self._heights, self._z[rows]))
        self.joined[rows] = True
        self._look()

    def places(self, rows: Rows) -> Floats:
        """Return points, (k, 3)."""
        return np.column_stack((self._flat[rows], self._z[rows]))

    def seen(self, places: Floats) -> _Seen:
        """Measure points that are inside the corners."""
        simplex = self._mesh.find_simplex(places[:, :2])
        corners, slope = self.simplices[simplex], self.gradients[simplex]
        from_first = places[:, :2] - self.points[corners[:, 0]]
        plane = self._heights[corners[:, 0]] + (from_first * slope).sum(axis=1)
        above = places[:, 2] - plane
        away = np.abs(above) / np.sqrt(1 + (slope**2).sum(axis=1))
        sine = np.zeros(len(places))
        shortest, nearest = np.full(len(places), np.inf), np.zeros(len(places), dtype=np.int64)
        for number, corner in enumerate(corners.T):
            across = places[:, :2] - self.points[corner]
            length = np.sqrt((across**2).sum(axis=1) + (places[:, 2] - self._heights[corner]) ** 2)
            np.maximum(sine, away / np.where(length > 0, length, np.inf), out=sine)
            nearest[length < shortest] = number
            np.minimum(shortest, length, out=shortest)
        return _Seen(simplex, above, away, sine, nearest)

    def mirrored(self, places: Floats, simplex: Indices) -> tuple[Floats, Bools]:
        """Return the mirror images at the highest corners, and which are inside."""
        corners = self.simplices[simplex]
        top = corners[np.arange(len(corners)), self._heights[corners].argmax(axis=1)]
        image = np.column_stack((2 * self.points[top] - places[:, :2], places[:, 2]))
        return image, self._mesh.find_simplex(image[:, :2]) >= 0

    @property
    def longest(self) -> Floats:
        """The length of the longest edge of each triangle."""
        corners = self.points[self.simplices]
        along = corners - corners[:, [1, 2, 0]]
        return np.asarray(np.hypot(along[..., 0], along[..., 1]).max(axis=1))


def _chosen(surface: _Surface, left: Rows, limits: _Limits) -> Rows:
    """Return the points to insert: the smallest angle for each triangle and corner."""
    large = surface.longest > limits.edge
    steep = np.hypot(*surface.gradients.T) > limits.tangent
    found = []
    for rows in _blocks(left):
        places = surface.places(rows)
        seen = surface.seen(places)
        fits = (seen.away <= limits.distance) & (seen.sine <= limits.sine)
        if limits.mirror:
            again = np.flatnonzero(~fits & steep[seen.simplex])
            image, inside = surface.mirrored(places[again], seen.simplex[again])
            again, image = again[inside], image[inside]
            other = surface.seen(image)
            fits[again] = (other.away <= limits.distance) & (other.sine <= limits.sine)
        fits &= large[seen.simplex]
        third = 3 * seen.simplex.astype(np.int64) + seen.nearest
        found.append((rows[fits], third[fits], seen.sine[fits]))
    if not found:
        return left
    rows, third, sine = (np.concatenate(part) for part in zip(*found, strict=True))
    x, y, z = surface.places(rows).T
    order = np.lexsort((z, y, x, sine, third))
    _, first = np.unique(third[order], return_index=True)
    chosen: Rows = rows[order[first]]
    return chosen


def _blocks(rows: Rows) -> list[Rows]:
    return [rows[start : start + _BLOCK] for start in range(0, len(rows), _BLOCK)]
