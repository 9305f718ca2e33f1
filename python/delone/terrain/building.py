"""The construction of a TIN from points and lines."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_choice, as_number, as_points, require_finite
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.counting import counted
from delone.errors import CrossingSegmentsError, InputError, ShapeError
from delone.georeference import (
    as_known_crs,
    caller_level,
    crs_of,
    is_geographic,
    same_crs,
    warn_of_degrees,
)
from delone.terrain.heights import (
    POLICIES,
    Claims,
    claims_of_lines,
    claims_of_points,
    on_ground,
    resolved,
)
from delone.terrain.lines import lines_of, rings_of
from delone.terrain.profiles import profile
from delone.units import (
    UnitsWarning,
    as_units,
    heights_of_crs,
    lengths_of_crs,
    require_same_units,
    warn_of_units,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone.terrain.surface import Surface

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = [
    "HARD",
    "SOFT",
    "Built",
    "Lines",
    "build",
    "compact",
    "degrees_of",
    "is_soft",
    "peeled",
    "settled_units",
    "system_of",
]

# The kinds of lines.
HARD, SOFT, _BOUNDARY, _HOLE = range(4)


class Built(NamedTuple):
    """The arrays of a TIN."""

    points: Floats
    z: Floats
    simplices: Indices
    neighbors: Indices
    kept: Bools
    segments: Indices
    soft: Bools
    crs: str | None
    units: str | None


class Lines(NamedTuple):
    """All lines: their points, segments between them, and the kind of each segment."""

    points: Floats  # (p, 3)
    draped: Bools  # (p,), whether the height is that of the ground
    segments: Indices  # (s, 2), rows of `points`
    kinds: NDArray[np.int8]
    rings: dict[int, list[Floats]]


def build(
    xyz: Any,
    *,
    breaklines: Any,
    soft_breaklines: Any,
    boundary: Any,
    holes: Any,
    max_edge: float | None,
    duplicates: str,
    crossing: str,
    tolerance: float,
    crs: Any,
    units: Any,
    planar: bool,
    workers: int | None,
    surface_of: Callable[[Floats], Surface],
) -> Built:
    """Triangulate points and lines, and give each vertex a height.

    `surface_of` returns the surface of points alone, for lines without heights.
    """
    as_choice(duplicates, POLICIES, name="duplicates")
    as_choice(crossing, POLICIES, name="crossing")
    allowed = as_tolerance(tolerance)
    points = _points_of(xyz)
    system = system_of(crs, xyz, breaklines, soft_breaklines, boundary, holes)
    heights_in = settled_units(units, system, None, str(system))
    warn_of_degrees(xyz, points[:, :2], planar=planar, by=degrees_of(system))
    lines = _gathered(
        [
            lines_of(breaklines, name="breaklines"),
            lines_of(soft_breaklines, name="soft_breaklines"),
            rings_of(boundary, name="boundary"),
            rings_of(holes, name="holes"),
        ],
        points,
        surface_of,
    )
    _refuse_crossing_rings(lines)
    rows = np.concatenate((points[:, :2], lines.points[:, :2]))
    mesh = ConstrainedDelaunay(
        rows,
        lines.segments + len(points),
        crossing="split",
        workers=workers,
        planar=True,
    )
    heights = _heights(
        mesh, points, lines, duplicates=duplicates, crossing=crossing, tolerance=allowed
    )
    kept = _within(mesh, lines)
    soft = is_soft(mesh, lines)
    if max_edge is not None:
        limit = as_number(max_edge, name="max_edge")
        if not limit > 0:
            raise InputError(f"max_edge must be above 0, got {max_edge!r}")
        kept = peeled(mesh.points, mesh.simplices, mesh.neighbors, kept, mesh.constrained, limit)
    return compact(mesh, heights, kept, soft, system, heights_in)


def as_tolerance(given: Any) -> float:
    """Return the largest difference of heights that are equal."""
    found = as_number(given, name="tolerance")
    if not 0 <= found < np.inf:
        raise InputError(f"tolerance must be a difference of heights from 0 on, got {given!r:.60}")
    return found


def _heights(mesh: ConstrainedDelaunay, points: Floats, lines: Lines, **policies: Any) -> Floats:
    """Return the height of each row of a triangulation of points and lines."""
    count = len(points)
    z = np.concatenate((points[:, 2], lines.points[:, 2]))
    own = claims_of_points(mesh.duplicate_of[count : len(z)], lines.points[:, 2])
    between, row = claims_of_lines(mesh, z)
    # A segment between two points on the ground has no height of its own.
    without: Bools = np.all(lines.draped[lines.segments[row]], axis=1)
    found = resolved(
        mesh.points,
        claims_of_points(mesh.duplicate_of[:count], points[:, 2]),
        Claims.joined([own.among(~lines.draped), between.among(~without)]),
        **policies,
    )
    return on_ground(found, Claims.joined([own.among(lines.draped), between.among(without)]))


def _points_of(xyz: Any) -> Floats:
    """Return points with heights, (n, 3), finite."""
    z = getattr(xyz, "z", None)
    if hasattr(xyz, "points") and hasattr(xyz, "attributes"):  # a PointSet
        if z is None:
            raise InputError("the points have no heights: name their column (x, y and z)")
        found = np.column_stack((xyz.points, z))
    else:
        found = as_points(xyz, name="xyz")
        if found.shape[1] != 3:
            raise ShapeError(f"xyz must have shape (n, 3), got {found.shape}")
    require_finite(found, name="xyz")
    return found


def system_of(crs: Any, *data: Any) -> str | None:
    """Return the one reference system that is given or declared by data."""
    found = as_known_crs(crs)
    for each in data:
        other = crs_of(each)
        if other is None:
            continue
        if found is not None and not same_crs(found, other):
            raise InputError(
                f"points and lines are in {found:.60} and in {other:.60}: transform them"
            )
        found = found or other
    return found


def degrees_of(system: str | None) -> str | None:
    """Return a system whose coordinates are degrees; None for all others."""
    return system[:60] if system is not None and is_geographic(system) else None


def settled_units(given: Any, system: str | None, lengths: str | None, by: str) -> str | None:
    """Return the unit of heights, given or that of the system; warn if x and y have another one.

    `lengths` is the unit of x and y that data declare, `by` their file.
    """
    vertical, horizontal = heights_of_crs(system), lengths_of_crs(system)
    units = as_units(given) or vertical
    require_same_units(units, vertical, what=f"units and the vertical axis of {system!s:.60}")
    if lengths is not None and horizontal is not None and lengths != horizontal:
        warnings.warn(
            f"{by}: x and y are in {lengths}, but those of {system!s:.60} in {horizontal}",
            UnitsWarning,
            stacklevel=caller_level(),
        )
    warn_of_units(lengths or horizontal, units, by=by)
    return units


def _gathered(
    given: list[list[Floats]], points: Floats, surface_of: Callable[[Floats], Surface]
) -> Lines:
    """Gather the lines of each kind, and put those without heights onto the points."""
    parts: list[Floats] = [np.empty((0, 3))]
    draped: list[Bools] = [np.empty(0, dtype=bool)]
    segments: list[NDArray[np.int64]] = [np.empty((0, 2), dtype=np.int64)]
    kinds: list[NDArray[np.int8]] = [np.empty(0, dtype=np.int8)]
    count = 0
    ground: Surface | None = None
    for kind, lines in enumerate(given):
        for line in lines:
            without = np.isnan(line[:, 2])
            found = [line]
            if without.any():
                ground = ground or surface_of(points)
                found = _on_ground(line, ground, outside=kind >= _BOUNDARY)
            for part in found:
                first = count + np.arange(len(part) - 1)
                segments.append(np.column_stack((first, first + 1)))
                kinds.append(np.full(len(first), kind, dtype=np.int8))
                parts.append(part)
                draped.append(np.ones(len(part), dtype=bool) if without.all() else without)
                count += len(part)
    return Lines(
        np.concatenate(parts),
        np.concatenate(draped),
        np.concatenate(segments).astype(np.int32),
        np.concatenate(kinds),
        {_BOUNDARY: given[_BOUNDARY], _HOLE: given[_HOLE]},
    )


def _on_ground(line: Floats, ground: Surface, *, outside: bool) -> list[Floats]:
    """Return a line with heights: its parts on the surface of the points, if it has none itself.

    Parts `outside` of that surface may be left out of lines without any height; otherwise they are
    an error.
    """
    places, without = np.ascontiguousarray(line[:, :2]), np.isnan(line[:, 2])
    if not without.all():
        z = np.where(without, ground.heights(places), line[:, 2])
        if np.isnan(z).any():
            raise _off_ground(*places[np.isnan(z)][0].tolist())
        return [np.column_stack((places, z))]
    found = profile(ground, places)
    off = np.isnan(found.z)
    outer = np.isnan(ground.heights(places))
    if not outside and (off.any() or outer.any()):
        raise _off_ground(*(places[outer][0] if outer.any() else found.points[off][0]).tolist())
    table = np.column_stack((found.points, found.z))
    parts = [part[~np.isnan(part[:, 2])] for part in np.split(table, np.flatnonzero(off))]
    return [part for part in parts if len(part) > 1]


def _off_ground(x: float, y: float) -> InputError:
    return InputError(
        f"a line without heights is outside of the points at ({x:.10g}, {y:.10g}): give it heights "
        "there"
    )


def _refuse_crossing_rings(lines: Lines) -> None:
    """Refuse a boundary or hole that crosses itself or another one."""
    rings = [ring[:, :2] for kind in (_BOUNDARY, _HOLE) for ring in lines.rings[kind]]
    if not rings:
        return
    ends = np.cumsum([len(ring) for ring in rings]) - 1
    row = np.delete(np.arange(ends[-1] + 1), ends)
    try:
        ConstrainedDelaunay(np.concatenate(rings), np.column_stack((row, row + 1)), planar=True)
    except CrossingSegmentsError as error:
        x, y = error.points[0]
        raise CrossingSegmentsError(
            f"boundary and holes cross at {counted(len(error.points), 'place')}, first ({x:.10g}, "
            f"{y:.10g})",
            pairs=error.pairs,
            points=error.points,
        ) from error


def _within(mesh: ConstrainedDelaunay, lines: Lines) -> Bools:
    """Which triangles are inside of the boundary and outside of the holes."""
    if not (lines.rings[_BOUNDARY] or lines.rings[_HOLE]):
        return np.ones(mesh.nsimplex, dtype=bool)
    # Rings are segments: a region between segments is inside or outside as a whole, and its largest
    # triangle decides.
    largest = np.lexsort((mesh.areas, mesh.region))
    last = np.flatnonzero(np.diff(mesh.region[largest], append=-1))
    centers = mesh.points[mesh.simplices[largest[last]]].mean(axis=1)
    inside = np.ones(len(centers), dtype=bool)
    if lines.rings[_BOUNDARY]:
        inside = _odd(centers, lines.rings[_BOUNDARY])
    for hole in lines.rings[_HOLE]:
        inside &= ~_odd(centers, [hole])
    number = np.zeros(int(mesh.region.max()) + 1, dtype=bool)
    number[mesh.region[largest[last]]] = inside
    found: Bools = number[mesh.region]
    return found


def _odd(centers: Floats, rings: list[Floats]) -> Bools:
    """Which points are inside of an odd number of rings."""
    odd = np.zeros(len(centers), dtype=bool)
    for ring in rings:
        a, b = ring[:-1, :2], ring[1:, :2]
        for i, (x, y) in enumerate(centers):
            crosses = (a[:, 1] > y) != (b[:, 1] > y)
            p, q = a[crosses], b[crosses]
            at = p[:, 0] + (y - p[:, 1]) / (q[:, 1] - p[:, 1]) * (q[:, 0] - p[:, 0])
            odd[i] ^= bool(np.count_nonzero(at > x) % 2)
    return odd


def is_soft(mesh: ConstrainedDelaunay, lines: Lines) -> Bools:
    """Which subsegments are on soft breaklines only."""
    start, source = mesh.segment_source
    hard = np.append(lines.kinds[source] != SOFT, False)
    found: Bools = np.add.reduceat(hard, start[:-1]) == 0 if len(start) > 1 else hard[:0]
    return found


def peeled(  # noqa: PLR0917
    points: Floats,
    simplices: Indices,
    neighbors: Indices,
    kept: Bools,
    constrained: Bools,
    limit: float,
) -> Bools:
    """Remove triangles from outside as long as their outer edge is longer than `limit`.

    Each round removes at least one triangle, so it ends. Segments are never outer edges of what is
    removed.
    """
    kept = kept.copy()
    ends = points[simplices[:, [[1, 2], [2, 0], [0, 1]]]]
    long = np.hypot(*np.moveaxis(ends[:, :, 1] - ends[:, :, 0], -1, 0)) > limit
    candidates: NDArray[Any] = np.arange(len(simplices))
    while len(candidates):
        around = neighbors[candidates]
        outer = (around < 0) | ~kept[around]
        gone = candidates[
            (outer & (long & ~constrained)[candidates]).any(axis=1) & kept[candidates]
        ]
        kept[gone] = False
        around = np.unique(neighbors[gone])
        candidates = around[(around >= 0) & kept[around]]
    return kept


def compact(  # noqa: PLR0917
    mesh: ConstrainedDelaunay,
    z: Floats,
    kept: Bools,
    soft: Bools,
    crs: str | None,
    units: str | None,
) -> Built:
    """Leave out rows that are duplicates; all others are vertices."""
    if not kept.any():
        raise InputError("no triangle is left: max_edge is too small, or the boundary is empty")
    used = mesh.duplicate_of == np.arange(mesh.npoints)
    number = np.asarray(np.cumsum(used) - 1, dtype=np.int32)
    return Built(
        mesh.points[used],
        z[used],
        number[mesh.simplices].astype(np.int32),
        mesh.neighbors.copy(),
        kept,
        number[mesh.segments].astype(np.int32),
        soft,
        crs,
        units,
    )
