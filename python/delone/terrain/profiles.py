"""Heights along lines: profiles, geometries on the surface, and lines of sight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_number, as_points, require_finite
from delone.errors import InputError, ShapeError
from delone.extras import require
from delone.immutable import ReadOnly
from delone.terrain.lines import line_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.terrain.surface import Surface

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Profile", "Sight", "drape", "parts_of", "profile", "sight"]

# Heights of a surface are rounded: by this share of the largest height they may exceed a line of
# sight that they touch.
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False, kw_only=True)
class Profile(ReadOnly):
    """Heights along a line.

    Parameters
    ----------
    distance : ndarray of float64, shape (k,)
        Distances from the start of the line, horizontally.
    z : ndarray of float64, shape (k,)
        Heights there. Between two parts of the line that are on the surface there is a NaN, as
        plots expect it.
    points : ndarray of float64, shape (k, 2)
        The positions.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
    >>> tin.profile([(-1, 1), (1, 1)])
    <Profile of 2 points over 2: heights 2 to 2>
    """

    distance: Floats
    z: Floats
    points: Floats

    def __len__(self) -> int:
        return len(self.z)

    def __repr__(self) -> str:
        low, high = np.fmin.reduce(self.z, initial=np.nan), np.fmax.reduce(self.z, initial=np.nan)
        span = "no heights" if np.isnan(low) else f"heights {low:.6g} to {high:.6g}"
        length = float(self.distance[-1]) if len(self) else 0.0
        return f"<Profile of {len(self)} points over {length:.6g}: {span}>"

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Plot heights over distances (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; by default new ones.
        **options
            Options of ``Axes.plot``, such as ``color``.

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
        >>> tin.profile([(1, 1), (1, 4)]).plot().get_xlabel()
        'distance'
        """
        from delone.plot.lines import plot_profile

        return plot_profile(self.distance, self.z, ax, **options)


@dataclass(frozen=True, eq=False, kw_only=True)
class Sight(ReadOnly):
    """Whether a target is visible; truthy if it is.

    Parameters
    ----------
    visible : bool
        Whether the surface is nowhere above the line of sight.
    obstruction : ndarray of float64, shape (3,), or None
        The first corner of the profile that is above it.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)])
    >>> tin.line_of_sight((0, 2), (4, 2), height=1).obstruction.tolist()
    [2.0, 2.0, 3.0]
    """

    visible: bool
    obstruction: Floats | None

    def __bool__(self) -> bool:
        return self.visible


class _Part(NamedTuple):
    """A part of a segment that is on the surface: shares of the way, and heights."""

    share: Floats
    z: Floats


def profile(tin: Surface, line: Any) -> Profile:
    """Return the heights along a line."""
    points = line_of(line, name="line")
    lengths = np.hypot(*np.diff(points, axis=0).T)
    start = 0.0
    rows: list[Floats] = []
    for a, b, length in zip(points[:-1], points[1:], lengths.tolist(), strict=True):
        for part in parts_of(tin, a, b):
            places = a + part.share[:, None] * (b - a)
            places[part.share == 1] = b
            table = np.column_stack((start + part.share * length, part.z, places))
            if rows and rows[-1][-1, 0] < table[0, 0]:
                gap = table[:1].copy()
                gap[0, 1] = np.nan
                rows.append(gap)
            rows.append(table)
        start += length
    table = np.concatenate(rows) if rows else np.empty((0, 4))
    again = np.zeros(len(table), dtype=bool)
    again[1:] = (table[1:, [0, 2, 3]] == table[:-1, [0, 2, 3]]).all(axis=1)
    again[1:] &= (table[1:, 1] == table[:-1, 1]) & ~np.isnan(table[1:, 1])
    table = table[~again]
    return Profile(distance=table[:, 0].copy(), z=table[:, 1].copy(), points=table[:, 2:].copy())


def parts_of(tin: Surface, a: Floats, b: Floats) -> list[_Part]:
    """Return the parts of a segment that are on the surface."""
    if (a == b).all():
        z = tin.heights(a[None])
        return [] if np.isnan(z[0]) else [_Part(np.zeros(1), z)]
    met = tin.walk(a, b)
    if not len(met):
        return []
    enter, leave = _crossings(tin, met, a, b)
    # A triangle that has a corner in common with the next one belongs to the same part.
    corners = tin.simplices[met]
    joined = (corners[:-1, :, None] == corners[1:, None, :]).any(axis=(1, 2))
    ends = np.append(np.flatnonzero(~joined), len(met) - 1)
    parts = []
    first = 0
    for last in ends.tolist():
        share = np.append(enter.share[first : last + 1], leave.share[last])
        z = np.append(enter.z[first : last + 1], leave.z[last])
        share = np.maximum.accumulate(share)
        parts.append(_Part(share, z))
        first = last + 1
    return parts


def _crossings(tin: Surface, met: Indices, a: Floats, b: Floats) -> tuple[_Part, _Part]:
    """Return where a segment enters and leaves triangles that it meets."""
    corners = tin.simplices[met]
    # The edge opposite each corner, from the smaller row on: both triangles compute the same.
    ends = np.sort(corners[:, [[1, 2], [2, 0], [0, 1]]], axis=2)
    p, q = (tin.points[ends[..., k]] for k in range(2))
    apex = tin.points[corners]
    inward = np.sign(_cross(q - p, apex - p))
    from_a, from_b = _cross(q - p, a - p) * inward, _cross(q - p, b - p) * inward
    with np.errstate(divide="ignore", invalid="ignore"):
        share = from_a / (from_a - from_b)
        along = _cross(a - p, b - a) / _cross(q - p, b - a)
    along = np.clip(along, 0, 1)
    low, high = (tin.z[ends[..., k]] for k in range(2))
    z = low + along * (high - low)
    z = np.where(along == 1, high, z)
    inside = tin.heights(np.stack((a, b)))
    rows = np.arange(len(met))
    entered = np.where((from_a < 0) & (from_b >= 0), share, -np.inf)
    left = np.where((from_b < 0) & (from_a >= 0), share, np.inf)
    k, j = entered.argmax(axis=1), left.argmin(axis=1)
    starts, stops = entered[rows, k], left[rows, j]
    enter = _Part(
        np.where(starts == -np.inf, 0.0, starts), np.where(starts == -np.inf, inside[0], z[rows, k])
    )
    leave = _Part(
        np.where(stops == np.inf, 1.0, stops), np.where(stops == np.inf, inside[1], z[rows, j])
    )
    return enter, leave


def _cross(u: Floats, v: Floats) -> Floats:
    found: Floats = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return found


def drape(tin: Surface, geometry: Any) -> Any:
    """Return a geometry with the heights of the surface."""
    shapely = require("shapely", extra="geo", what="geometries")
    if not hasattr(geometry, "geom_type"):
        raise InputError(f"a geometry of shapely is needed, got {geometry!r:.60}")
    kind = geometry.geom_type
    if geometry.is_empty:
        return geometry
    if hasattr(geometry, "geoms"):
        return type(geometry)([drape(tin, part) for part in geometry.geoms])
    if kind == "Point":
        place = np.array([[geometry.x, geometry.y]])
        return shapely.Point(*place[0], _on(tin.heights(place), place)[0])
    if kind == "Polygon":
        rings = [_draped(tin, ring) for ring in (geometry.exterior, *geometry.interiors)]
        return shapely.Polygon(rings[0], rings[1:])
    return type(geometry)(_draped(tin, geometry))


def _draped(tin: Surface, line: Any) -> Floats:
    places = np.asarray(line.coords)[:, :2]
    _on(tin.heights(places), places)
    found = profile(tin, places)
    _on(found.z, found.points)
    return np.column_stack((found.points, found.z))


def _on(z: Floats, places: Floats) -> Floats:
    """Refuse heights of which one is NaN."""
    outside = np.flatnonzero(np.isnan(z))
    if len(outside):
        x, y = places[outside[0]]
        raise InputError(f"({x:.10g}, {y:.10g}) is outside of the surface")
    return z


def sight(tin: Surface, a: ArrayLike, b: ArrayLike, height: float, target: float) -> Sight:
    """Return whether a target is visible from an observer."""
    ends = []
    for name, place in (("a", a), ("b", b)):
        row = as_points(np.asarray(place)[None], ndim=2, name=name)
        if row.shape != (1, 2):
            raise ShapeError(f"{name} must be one point, got shape {np.shape(place)}")
        require_finite(row, name=name)
        ends.append(row)
    places = np.concatenate(ends)
    above = [as_number(height, name="height"), as_number(target, name="target")]
    z = _on(tin.heights(places), places) + above
    if (places[0] == places[1]).all():
        return Sight(visible=True, obstruction=None)
    found = profile(tin, places)
    share = found.distance / np.hypot(*(places[1] - places[0]))
    line = z[0] + share * (z[1] - z[0])
    slack = _ROUNDING * float(np.abs(np.append(tin.z[:0], [*z, np.nanmax(np.abs(found.z))])).max())
    hidden = np.flatnonzero((found.z > line + slack) & (share > 0) & (share < 1))
    if not len(hidden):
        return Sight(visible=True, obstruction=None)
    first = hidden[0]
    return Sight(visible=False, obstruction=np.append(found.points[first], found.z[first]))
