"""The construction of a TIN from points and lines."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_choice,
    as_flag,
    as_points,
    as_workers,
    require_finite,
    wrong_shape,
)
from delone._base.blocks import blocks
from delone._base.georeference import (
    as_known_crs,
    caller_level,
    common_crs,
    crs_of,
    is_geographic,
    same_crs,
    warn_of_degrees,
    warn_of_unknown,
)
from delone._base.numbers import as_nonnegative, as_positive
from delone._base.units import (
    UnitsWarning,
    as_units,
    heights_of_crs,
    lengths_of_crs,
    require_same_units,
    warn_of_units,
)
from delone._tiling.plane.topology import among, edge_keys, triangles_among
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.membership import inside
from delone.delaunay import Delaunay
from delone.errors import ConflictingValuesError, InputError
from delone.terrain.adjustments import Adjustments, adjustments_of
from delone.terrain.extent import Part, refuse_crossing_rings, within, without_outer
from delone.terrain.gathering import LEVEL, SOFT, Lines, gathered
from delone.terrain.heights import (
    POLICIES,
    Claims,
    claims_of_lines,
    claims_of_points,
    on_ground,
    resolved,
)
from delone.terrain.joining import joined
from delone.terrain.leveling import Level, leveled, require_level
from delone.terrain.lines import Ring, lines_of, rings_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.terrain.surface import Surface

__all__ = [
    "Built",
    "bare",
    "build",
    "compact",
    "degrees_of",
    "is_soft",
    "peeled",
    "settled_units",
    "stated_units",
    "system_of",
]


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
    adjustments: Adjustments | None = None


def build(
    xyz: Any,
    *,
    breaklines: Any,
    soft_breaklines: Any,
    boundary: Any,
    holes: Any,
    islands: Any,
    max_edge: float | None,
    voids: bool,
    duplicates: str,
    crossing: str,
    tolerance: float,
    snap: float,
    level: Any,
    crs: Any,
    units: Any,
    planar: bool,
    workers: int | None,
    surface_of: Callable[..., Surface],
) -> Built:
    """Triangulate points and lines, and give each vertex a height.

    `surface_of` returns the surface of points, with `breaklines`, for lines without heights.
    """
    as_choice(duplicates, POLICIES, name="duplicates")
    as_choice(crossing, POLICIES, name="crossing")
    allowed, near = (
        as_nonnegative(value, name=name, finite=True)
        for name, value in (("tolerance", tolerance), ("snap", snap))
    )
    limit = None if max_edge is None else as_positive(max_edge, name="max_edge")
    if as_flag(voids, name="voids") and limit is None:
        raise InputError("voids=True needs max_edge: longer edges span a void")
    lined = (breaklines, soft_breaklines, boundary, holes, islands, level)
    if limit is None and not near and all(each is None for each in lined):
        return _without_lines(
            bare(xyz, crs=crs, units=units, planar=planar),
            {"duplicates": duplicates, "crossing": crossing, "tolerance": allowed},
            workers,
        )
    points = _points_of(xyz)
    system = system_of(crs, xyz)
    if system is None:
        other = (breaklines, soft_breaklines, boundary, holes, islands)
        system = system_of(None, *(common_crs(each) for each in other))
        if system is not None:
            warn_of_unknown(system, known="lines", unknown="the points")
    heights_in = settled_units(units, system, None, str(system))
    warn_of_degrees(xyz, points[:, :2], planar=planar, by=degrees_of(system))
    rings = [
        rings_of(each, name=name, crs=system)
        for name, each in (("boundary", boundary), ("holes", holes), ("islands", islands))
    ]
    _refuse_wrong_rings(boundary, *rings)
    given = [
        [Ring(line) for line in lines_of(each, name=name, crs=system)]
        for name, each in (("breaklines", breaklines), ("soft_breaklines", soft_breaklines))
    ]
    every = points
    kept = np.ones(len(every), dtype=bool)
    lakes: Level | None = None
    if level is not None:
        # Sides are divided, so that a shore does not cause long edges next to it.
        longest = np.inf if limit is None else limit / 2
        lakes = leveled(level, points, system, longest, surface_of)
        kept, points = lakes.outside.copy(), points[lakes.outside]
    shores = [] if lakes is None else lakes.shores
    around = [shore.points for shore in shores]
    lines = gathered(
        [*given, *rings, shores],
        points,
        lambda ground: surface_of(ground, **({"breaklines": around} if around else {})),
    )
    with _rows_of(kept):
        merged = joined(points, lines, near, duplicates, allowed) if near else None
    if merged is not None:
        points, lines = merged.points[merged.kept], merged.lines
        kept[np.flatnonzero(kept)[~merged.kept]] = False
    rows = np.concatenate((points[:, :2], lines.points[:, :2]))
    mesh = ConstrainedDelaunay(
        rows,
        lines.segments + len(points),
        crossing="split",
        workers=workers,
        planar=True,
    )
    with _rows_of(kept):
        heights = _heights(
            mesh, points, lines, duplicates=duplicates, crossing=crossing, tolerance=allowed
        )
    covered = within(mesh, lines)
    level_ = inside(mesh, np.where(lines.kinds == LEVEL, lines.polygons, -1).astype(np.int32))
    if lakes is not None:
        require_level(mesh, heights, level_, covered, lakes.heights)
    part = Part(mesh, heights, covered, is_soft(mesh, lines))
    mesh, heights, found, soft = without_outer(part, lines)
    if limit is not None:
        lake = triangles_among(mesh.simplices, part.mesh.simplices[level_ & covered])
        found = peeled(mesh, found, limit, voids=voids) | (lake & found)
    made = compact(mesh, heights, found, soft, system, heights_in)
    return made._replace(adjustments=adjustments_of(merged, lakes))


def _refuse_wrong_rings(boundary: Any, *rings: list[Ring]) -> None:
    """Reject a boundary without rings, and rings that cross each other."""
    if boundary is not None and not rings[0]:
        raise InputError("boundary is empty: leave it out for the convex hull")
    refuse_crossing_rings("boundary and holes", *rings)


def _without_lines(
    given: tuple[Floats, Floats, str | None, str | None],
    policies: dict[str, Any],
    workers: int | None,
) -> Built:
    """Triangulate points alone: only points at the same place have several heights."""
    flat, z, system, heights_in = given
    mesh = Delaunay(flat, planar=True, workers=workers)
    first = mesh.duplicate_of
    rows = np.flatnonzero(first != np.arange(mesh.npoints))
    points, simplices = mesh.points, mesh.simplices
    if len(rows):
        several = np.unique(np.concatenate((first[rows], rows)))
        claims = claims_of_points(first[several], z[several], several)
        nothing = claims.among(np.zeros(len(several), dtype=bool))
        found = resolved(points, claims, nothing, **policies)
        z[first[rows]] = found[first[rows]]
        used = np.ones(len(points), dtype=bool)
        used[rows] = False
        points, z, simplices = points[used], z[used], _renumbered(used, simplices)
    kept, none = np.ones(len(simplices), dtype=bool), np.empty((0, 2), dtype=np.int32)
    soft = np.empty(0, dtype=bool)
    return Built(points, z, simplices, mesh.neighbors, kept, none, soft, system, heights_in)


@contextmanager
def _rows_of(kept: Bools) -> Iterator[None]:
    """Make errors name rows of all points, including those that are left out."""
    try:
        yield
    except ConflictingValuesError as error:
        numbers = np.flatnonzero(kept)
        if len(numbers) == len(kept):
            raise
        further = np.arange(error.rows.max(initial=0) + 1 - len(numbers)) + len(kept)
        rows = np.concatenate((numbers, further.clip(0)))[error.rows]
        raise ConflictingValuesError(str(error), rows=rows) from None


def bare(
    xyz: Any, *, crs: Any, units: Any, planar: bool
) -> tuple[Floats, Floats, str | None, str | None]:
    """Return positions, heights, reference system and units of points without lines."""
    if _is_point_set(xyz) and xyz.z is not None and _are_finite(xyz.points, xyz.z):
        # Without a copy of all columns.
        flat, z = xyz.points, np.array(xyz.z, dtype=np.float64)
    else:
        points = _points_of(xyz)
        flat, z = np.ascontiguousarray(points[:, :2]), np.ascontiguousarray(points[:, 2])
    system = system_of(crs, xyz)
    heights_in = settled_units(units, system, None, str(system))
    warn_of_degrees(xyz, flat, planar=planar, by=degrees_of(system))
    return flat, z, system, heights_in


def _are_finite(*arrays: Floats) -> bool:
    return all(bool(np.isfinite(array).all()) for array in arrays)


def _heights(mesh: ConstrainedDelaunay, points: Floats, lines: Lines, **policies: Any) -> Floats:
    """Return the height of each row of a triangulation of points and lines."""
    count = len(points)
    z = np.concatenate((points[:, 2], lines.points[:, 2]))
    rows = np.arange(count, len(z))
    own = claims_of_points(mesh.duplicate_of[rows], lines.points[:, 2], rows)
    between, row = claims_of_lines(mesh, z)
    # A segment between two points on the ground has no height of its own.
    without: Bools = np.all(lines.draped[lines.segments[row]], axis=1)
    found = resolved(
        mesh.points,
        claims_of_points(mesh.duplicate_of[:count], points[:, 2]),
        Claims.joined([own.among(~lines.draped), between.among(~without)]),
        **policies,
    )
    ground = Claims.joined([own.among(lines.draped), between.among(without)])
    return on_ground(found, ground.among(~np.isnan(ground.z)))


def _points_of(xyz: Any) -> Floats:
    """Return points with heights, (n, 3), finite."""
    if _is_point_set(xyz):
        if xyz.z is None:
            raise InputError("the points have no heights: name their column (x, y and z)")
        found = np.column_stack((xyz.points, xyz.z))
    else:
        found = as_points(xyz, name="xyz")
        if found.shape[1] != 3:
            raise wrong_shape("xyz", "(n, 3)", found)
    require_finite(found, name="xyz")
    return found


def _is_point_set(xyz: Any) -> bool:
    return hasattr(xyz, "points") and hasattr(xyz, "attributes")


def system_of(crs: Any, *data: Any) -> str | None:
    """Return the one reference system that is given or declared by data."""
    found = as_known_crs(crs)
    for each in data:
        other = each if isinstance(each, str) else crs_of(each)
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


def stated_units(given: Any, stated: str | None, by: str) -> str | None:
    """Return the unit of heights, given or stated by a file; warn if these differ."""
    units = as_units(given)
    if units is not None and stated is not None and units != stated:
        warnings.warn(
            f"{by:.60} states heights in {stated}, and units={given!r:.20} is used instead: leave "
            "units out if the file is right",
            UnitsWarning,
            stacklevel=caller_level(),
        )
    return units or stated


def settled_units(given: Any, system: str | None, lengths: str | None, by: str) -> str | None:
    """Return the unit of heights, given or of the system; warn if x and y have a different one.

    `lengths` is the unit of x and y that the data declare, and `by` is their file.
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


def is_soft(mesh: ConstrainedDelaunay, lines: Lines) -> Bools:
    """Which subsegments are on soft breaklines only."""
    start, source = mesh.segment_source
    hard = np.append(lines.kinds[source] != SOFT, False)
    found: Bools = np.add.reduceat(hard, start[:-1]) == 0 if len(start) > 1 else hard[:0]
    return found


def peeled(mesh: ConstrainedDelaunay, kept: Bools, limit: float, *, voids: bool) -> Bools:
    """Remove triangles from outside as long as their outer edge is longer than `limit`.

    With `voids`, all triangles with such an edge are removed. Segments count as short.
    """
    kept, neighbors = kept.copy(), mesh.neighbors
    long = _longer(mesh, limit) & ~mesh.constrained
    if voids:
        # The rest has no long edge, so nothing else is removed from outside.
        return kept & ~long.any(axis=1)
    candidates: NDArray[Any] = np.arange(len(neighbors))
    # Terminates: each round removes at least one triangle.
    while len(candidates):
        around = neighbors[candidates]
        outer = (around < 0) | ~kept[around]
        gone = candidates[(outer & long[candidates]).any(axis=1) & kept[candidates]]
        kept[gone] = False
        around = np.unique(neighbors[gone])
        candidates = around[(around >= 0) & kept[around]]
    return kept


def _longer(mesh: ConstrainedDelaunay, limit: float) -> Bools:
    """Whether the edge opposite each corner of a triangle is longer than a number, exactly."""
    ends = mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]]
    along = mesh.points[ends[..., 1]] - mesh.points[ends[..., 0]]
    length = np.hypot(along[..., 0], along[..., 1])
    found: Bools = length > limit
    # Lengths have a few rounding errors, and tiny ones a whole unit; the core decides close cases.
    near = np.abs(length - limit) <= limit * 2.0**-48 + 2.0**-1070
    if near.any():
        unit = np.array([(0.0, 0.0), (limit, 0.0)])
        short = _core.not_longer(mesh.points, ends[near], unit, as_workers(mesh.workers))
        keys = edge_keys(ends[near][:, 0], ends[near][:, 1], mesh.npoints)
        found[near] = ~among(keys, edge_keys(short[:, 0], short[:, 1], mesh.npoints))
    return found


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
        raise InputError(
            "no triangle is left: max_edge is too small, or the boundary is empty or does not meet "
            "the points; do both have the same reference system?"
        )
    used = mesh.duplicate_of == np.arange(mesh.npoints)
    return Built(
        mesh.points[used],
        z[used],
        _renumbered(used, mesh.simplices),
        mesh.neighbors,
        kept,
        _renumbered(used, mesh.segments),
        soft,
        crs,
        units,
    )


def _renumbered(used: Bools, simplices: Indices) -> Indices:
    """Return simplices whose corners are numbered among the rows in use."""
    number = np.cumsum(used, dtype=np.int32)
    number -= 1
    found = np.empty_like(simplices)
    for rows in blocks(len(simplices)):
        # Every corner is a row; with the default mode, NumPy would copy the result once more.
        np.take(number, simplices[rows], out=found[rows], mode="clip")
    return found
