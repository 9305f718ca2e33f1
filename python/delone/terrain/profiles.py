"""Heights along lines: profiles, geometries on the surface, and lines of sight."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_number
from delone._base.extras import require
from delone._base.georeference import caller_level
from delone._base.immutable import ReadOnly
from delone._base.renames import renamed
from delone._tiling import measures
from delone._tiling.location import segment_ends
from delone.errors import InputError
from delone.terrain.lines import line_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.terrain.surface import Surface

__all__ = ["Profile", "Sight", "drape", "parts_of", "profile", "sight"]

# Heights of a surface are rounded: by this fraction of the largest height, they may exceed a line
# of sight that they touch.
_ROUNDING = 1e-12


@renamed(distance="distances")
@dataclass(frozen=True, eq=False, kw_only=True)
class Profile(ReadOnly):
    """Heights along a line.

    Parameters
    ----------
    distances : ndarray of float64, shape (k,)
        Horizontal distances from the start of the line.
    z : ndarray of float64, shape (k,)
        Heights there. Parts of the line that are on the surface are separated by NaN, as plots
        expect. A part may be a single point, where the line touches a corner of the surface.
    points : ndarray of float64, shape (k, 2)
        The positions.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
    >>> tin.profile([(-1, 1), (1, 1)])
    <Profile of 2 points over 2: heights 2 to 2>
    """

    distances: Floats
    z: Floats
    points: Floats

    def __len__(self) -> int:
        return len(self.z)

    def __repr__(self) -> str:
        low, high = np.fmin.reduce(self.z, initial=np.nan), np.fmax.reduce(self.z, initial=np.nan)
        span = "no heights" if np.isnan(low) else f"heights {low:.6g} to {high:.6g}"
        length = float(self.distances[-1]) if len(self) else 0.0
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

        return plot_profile(self.distances, self.z, ax, **options)


@dataclass(frozen=True, eq=False, kw_only=True)
class Sight(ReadOnly):
    """Whether a target is visible; truthy if it is.

    Parameters
    ----------
    visible : bool
        Whether the surface is nowhere above the line of sight.
    obstruction : ndarray of float64, shape (3,), or None
        The first point of the profile that is above that line; None if the target is visible.

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
    """A part of a segment that is on the surface: fractions along it, heights and positions."""

    share: Floats
    z: Floats
    places: Floats


def profile(tin: Surface, line: Any) -> Profile:
    """Return the heights along a line."""
    points = line_of(line, name="line", crs=tin.crs)
    lengths = np.hypot(*np.diff(points, axis=0).T)
    start = 0.0
    rows: list[Floats] = []
    for a, b, length in zip(points[:-1], points[1:], lengths.tolist(), strict=True):
        for k, part in enumerate(parts_of(tin, a, b)):
            table = np.column_stack((start + part.share * length, part.z, part.places))
            # Two parts of one segment have a gap between them, however short.
            if rows and (k or (rows[-1][-1, 2:] != table[0, 2:]).any()):
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
    return Profile(distances=table[:, 0].copy(), z=table[:, 1].copy(), points=table[:, 2:].copy())


def warn_of_no_points(found: Profile) -> Profile:
    """Warn if a profile is empty because its line is outside the surface; return the profile."""
    if not len(found):
        warnings.warn(
            "the line is outside the surface: the profile has no points",
            UserWarning,
            stacklevel=caller_level(),
        )
    return found


def parts_of(tin: Surface, a: Floats, b: Floats) -> list[_Part]:
    """Return the parts of a segment that are on the surface, including single points."""
    if (a == b).all():
        return _end(tin, a, 0.0)
    found: list[_Part] = []
    runs = tin._stretches(a, b)
    # Corners that are on a part are not separate parts.
    kept = [tin.simplices[run.kept] for run in runs if run.is_kept and len(runs) > 1]
    inside = np.concatenate([np.empty((0, 3), dtype=np.int32), *kept])
    for run in runs:
        if run.is_kept:
            found.append(_part(tin, run.kept, a, b))
        else:
            found += _touched(tin, np.setdiff1d(tin._tiling()[0][run.whole], inside), a, b)
    if not runs:
        # Outside of the hull, or through a corner of it.
        found = _touched(tin, tin.hull, a, b)
    if not (found and (found[0].places[0] == a).all()):
        found = _end(tin, a, 0.0) + found
    if not (found and (found[-1].places[-1] == b).all()):
        found += _end(tin, b, 1.0)
    return found


def _end(tin: Surface, place: Floats, share: float) -> list[_Part]:
    """The part that is an end of a segment, if it is on the surface."""
    z = tin.heights(place[None])
    return [] if np.isnan(z[0]) else [_Part(np.full(1, share), z, place[None].copy())]


def _touched(tin: Surface, vertices: NDArray[np.integer], a: Floats, b: Floats) -> list[_Part]:
    """The parts that are vertices of the surface between the ends of a segment, in order."""
    places = tin.points[vertices]
    start, end = (np.broadcast_to(each, places.shape).copy() for each in (a, b))
    # Along a segment, the coordinate in which its ends differ more gives an exact order.
    axis = int(np.abs(b - a).argmax())
    low, high = sorted((a[axis], b[axis]))
    on = (low < places[:, axis]) & (places[:, axis] < high)
    on[on] = _core.orient2d(start[on], end[on], places[on]) == 0
    on[on] = ~np.isnan(tin.heights(places[on]))
    found = vertices[on]
    order = np.argsort(tin.points[found, axis])
    found = found[order if a[axis] < b[axis] else order[::-1]]
    way = b - a
    shares = np.clip((tin.points[found] - a) @ way / (way @ way), 0, 1)
    return [
        _Part(shares[[k]], tin.z[[vertex]], tin.points[[vertex]])
        for k, vertex in enumerate(found.tolist())
    ]


def _part(tin: Surface, met: Indices, a: Floats, b: Floats) -> _Part:
    """Return the part of a segment in triangles each of which touches the next one on it."""
    corners = tin.simplices[met]
    first, last = _opening(tin, corners[0], a, b), _opening(tin, corners[-1], b, a)
    sides = _between(corners)
    sides = np.concatenate([side for side in (first, sides, last) if side is not None])
    found = _crossings(tin, sides, a, b)
    # The ends of the segment, if they are on the surface.
    ends = [
        _Part(np.full(1, share), _height(tin, triangle, end), end[None])
        for side, share, triangle, end in ((first, 0.0, met[0], a), (last, 1.0, met[-1], b))
        if side is None
    ]
    before, after = ends[: first is None], ends[first is None :]
    share, z, places = (
        np.concatenate(column) for column in zip(*before, found, *after, strict=True)
    )
    return _Part(np.maximum.accumulate(share), z, places)


def _height(tin: Surface, triangle: int, place: Floats) -> Floats:
    """The height at a place in a triangle."""
    z = tin.heights(place[None])
    if not np.isnan(z[0]):
        return z
    corner = tin.simplices[triangle, 0]
    apart = place - tin.points[corner]
    return np.atleast_1d(tin.z[corner] + tin.gradients[triangle] @ apart)


def _opening(tin: Surface, corners: Indices, a: Floats, b: Floats) -> Indices | None:
    """Return the side through which the segment from a enters a triangle; None if a is in it."""
    tail, head = corners[[1, 2, 0]], corners[[2, 0, 1]]
    start, end = (np.broadcast_to(each, (3, 2)).copy() for each in (a, b))
    beyond = _core.orient2d(tin.points[tail], tin.points[head], start) < 0
    if not beyond.any():
        return None
    one, two = (_core.orient2d(start, end, tin.points[each]) for each in (tail, head))
    crossed = np.flatnonzero(beyond & (one * two <= 0) & ((one != 0) | (two != 0)))
    # If two sides meet on the segment, either one will do: it passes through their corner.
    return np.column_stack((tail, head))[crossed[:1]]


def _between(corners: Indices) -> Indices:
    """Return what each triangle has in common with the next: a side, or a corner twice."""
    common = (corners[:-1, :, None] == corners[1:, None, :]).any(axis=2)
    # Corners in common first.
    order = np.argsort(~common, axis=1, kind="stable")
    sides = np.take_along_axis(corners[:-1], order, axis=1)[:, :2]
    single = common.sum(axis=1) == 1
    sides[single, 1] = sides[single, 0]
    return sides


def _crossings(tin: Surface, sides: Indices, a: Floats, b: Floats) -> _Part:
    """Return where a segment passes through sides, or through a corner of them."""
    u, v = np.sort(sides, axis=1).T
    points, count = tin.points, len(u)
    start, end = (np.broadcast_to(each, (count, 2)).copy() for each in (a, b))
    on_u, on_v = (_core.orient2d(start, end, points[each]) == 0 for each in (u, v))
    # With a factor that is a power of two, products neither overflow nor vanish.
    given = points[u], points[v], start, end
    largest = max(float(np.abs(each).max(initial=0.0)) for each in given)
    one, two, tail, head = (np.ldexp(each, -math.frexp(largest)[1]) for each in given)
    # Areas have small relative errors, so that fractions are right even in needles.
    of_u, of_v = (_areas(tail, head, each) for each in (one, two))
    of_a, of_b = (_areas(one, two, each) for each in (tail, head))
    with np.errstate(invalid="ignore"):
        along, share = of_u / (of_u + of_v), of_a / (of_a + of_b)
    with np.errstate(over="ignore", invalid="ignore"):
        z = tin.z[u] + along * (tin.z[v] - tin.z[u])
    far = np.flatnonzero(~np.isfinite(z))
    low, high = tin.z[u[far]] / 2, tin.z[v[far]] / 2
    z[far] = 2 * (low + along[far] * (high - low))
    places = start + share[:, None] * (end - start)
    vertex = np.where(on_u, u, v)
    at = np.flatnonzero(on_u | on_v)
    z[at], places[at] = tin.z[vertex[at]], points[vertex[at]]
    way = head[at] - tail[at]
    part = np.where(on_u[:, None], one, two)[at] - tail[at]
    share[at] = (part * way).sum(axis=1) / (way * way).sum(axis=1)
    return _Part(np.clip(share, 0, 1), z, places)


def _areas(a: Floats, b: Floats, c: Floats) -> Floats:
    """The areas of triangles, without a sign."""
    rows = np.arange(3 * len(a), dtype=np.int32).reshape(3, -1).T
    return np.abs(measures.sizes(np.concatenate((a, b, c)), np.ascontiguousarray(rows)))


def drape(tin: Surface, geometry: Any) -> Any:
    """Return a geometry with the heights of the surface."""
    shapely = require("shapely", extra="geo", what="geometries")
    if not hasattr(geometry, "geom_type"):
        raise InputError(f"a shapely geometry is needed, got {geometry!r:.60}")
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
    gaps = np.flatnonzero(np.isnan(found.z))
    if len(gaps):
        (ax, ay), (bx, by) = found.points[gaps[0] - 1], found.points[gaps[0] + 1]
        raise InputError(
            f"what is between ({ax:.10g}, {ay:.10g}) and ({bx:.10g}, {by:.10g}) is outside the "
            "surface"
        )
    return np.column_stack((found.points, found.z))


def _on(z: Floats, places: Floats) -> Floats:
    """Reject heights with a NaN among them."""
    outside = np.flatnonzero(np.isnan(z))
    if len(outside):
        x, y = places[outside[0]]
        raise InputError(f"({x:.10g}, {y:.10g}) is outside the surface")
    return z


def sight(tin: Surface, a: ArrayLike, b: ArrayLike, height: float, target: float) -> Sight:
    """Return whether a target is visible from an observer."""
    ends = [end[None] for end in segment_ends(a, b)]
    places = np.concatenate(ends)
    above = [as_number(height, name="height"), as_number(target, name="target")]
    z = _on(tin.heights(places), places) + above
    if (places[0] == places[1]).all():
        return Sight(visible=True, obstruction=None)
    found = profile(tin, places)
    share = found.distances / np.hypot(*(places[1] - places[0]))
    line = z[0] + share * (z[1] - z[0])
    largest = np.fmax.reduce(np.abs(np.concatenate((found.z, z))))
    slack = _ROUNDING * float(largest)
    hidden = np.flatnonzero((found.z > line + slack) & (share > 0) & (share < 1))
    if not len(hidden):
        return Sight(visible=True, obstruction=None)
    first = hidden[0]
    return Sight(visible=False, obstruction=np.append(found.points[first], found.z[first]))
