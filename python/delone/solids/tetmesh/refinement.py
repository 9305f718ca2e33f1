"""Refinement of tetrahedra: points are added for sizes and shapes, then slivers are removed.

The core adds the points (its module comment names the papers); this module evaluates sizes in
rounds, keeps faces and their attributes, and judges the result.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_callback, as_choice, as_limit, as_number
from delone._base.counting import agreed, counted, listed
from delone._base.immutable import ReadOnly
from delone._base.numbers import as_share
from delone._tiling.sizes import chosen
from delone._tiling.space.locking import sides
from delone._tiling.space.topology import FACES
from delone.errors import InputError, LimitError
from delone.solids.tetmesh import improving
from delone.solids.tetmesh.lengths import Lengths, length_of
from delone.solids.tetmesh.recovery import RecoveryReport
from delone.solids.tetmesh.report import ImproveReport
from delone.solids.tetmesh.walls import Kept

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices, Rows
    from delone._core import RefinedTetrahedra

__all__ = [
    "REFINEMENT_COUNTS",
    "REFINEMENT_FLOATS",
    "Bounds",
    "RefinementReport",
    "as_bounds",
    "refined",
]

# Twelve million tetrahedra, in about 4 GB.
MOST_ADDED = 2_000_000
# The goal for dihedral angles, in degrees, unless another one is given.
_GOAL = 20.0
_BOUNDARIES = ("faces", "surface")
# Each round halves edges at most; 80 rounds span any ratio of sizes.
_MOST_ROUNDS = 80
# Moving vertices makes some tetrahedra too large again: these are refined again, this many times.
_AGAIN = 2
# The limit on passes of an improvement.
_PASSES = 30
# Sizes are met up to the rounding of volumes and edges.
_ROUNDING = 1e-9
_SHOWN = 5
# Products of coordinates are doubles if the largest coordinate is in this range.
_USUAL = 1e-60, 1e60
# The fields of a report that are counts, and those that are numbers.
REFINEMENT_COUNTS = ("on_segments", "on_facets", "for_shapes", "for_sizes", "exhausted")
REFINEMENT_FLOATS = ("radius_edge", "largest_radius_edge", "largest_size_ratio", "surface_distance")


@dataclass(frozen=True, eq=False, kw_only=True)
class RefinementReport(ReadOnly):
    """The report of a refinement of tetrahedra; truthy if all bounds are met.

    Parameters
    ----------
    on_segments, on_facets : int
        Numbers of points that were added on edges where planar parts of the faces end, and inside
        planar parts.
    for_shapes, for_sizes : int
        Numbers of points that were added between the faces, for shapes and for sizes.
    exhausted : bool
        Whether the limit on points was reached.
    radius_edge : float
        The bound on the circumradius divided by the shortest edge, infinite for none.
    largest_radius_edge : float
        The largest such ratio in the mesh.
    largest_size_ratio : float
        The largest ratio of a tetrahedron to its size; at most 1 if sizes are met.
    surface_distance : float
        An upper bound on the distance of the faces of the mesh from the input faces: points on
        faces are rounded to doubles, and a `tolerance` allows twice as much.
    too_large : ndarray of int64, shape (k,)
        The tetrahedra that are larger than their sizes, ascending.
    above_ratio : ndarray of int64, shape (j,)
        The tetrahedra with a ratio above `radius_edge`, ascending.
    improvement : ImproveReport or None
        What removed slivers after the last point; None with ``min_angle=0``.
    recovery : RecoveryReport or None
        What `delone.tetrahedralize` did before the refinement.

    Attributes
    ----------
    ok : bool
        True if the limit was not reached, and no tetrahedron is too large, above the ratio, or
        below the goal of the improvement.
    added : int
        Total number of added points.

    Examples
    --------
    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    >>> mesh = delone.tetrahedralize(points, faces, boundary="surface", size=0.3)
    >>> mesh.report.ok, mesh.report.largest_size_ratio <= 1
    (True, True)
    """

    on_segments: int
    on_facets: int
    for_shapes: int
    for_sizes: int
    exhausted: bool
    radius_edge: float
    largest_radius_edge: float
    largest_size_ratio: float
    surface_distance: float
    too_large: Rows
    above_ratio: Rows
    improvement: ImproveReport | None
    recovery: RecoveryReport | None

    @property
    def added(self) -> int:
        """Total number of added points."""
        return self.on_segments + self.on_facets + self.for_shapes + self.for_sizes

    @property
    def ok(self) -> bool:
        """True if the limit was not reached and all bounds are met."""
        better = self.improvement is None or self.improvement.ok
        return better and not (self.exhausted or len(self.too_large) or len(self.above_ratio))

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        lines = [
            f"{counted(self.added, 'point')} added: {self.on_segments} on edges and "
            f"{self.on_facets} on faces of the surface, {self.for_sizes} for sizes, "
            f"{self.for_shapes} for shapes"
        ]
        if self.exhausted:
            lines.append("the limit on points was reached")
        if self.on_segments or self.on_facets:
            lines.append(f"points on faces are within {self.surface_distance:.2g} of them")
        for rows, words in (
            (self.too_large, f"larger than the size, by up to {self.largest_size_ratio:.3g}"),
            (
                self.above_ratio,
                f"above the ratio {self.radius_edge:g}, up to {self.largest_radius_edge:.3g}",
            ),
        ):
            if len(rows):
                verb = agreed(len(rows), "is", "are")
                noun = counted(len(rows), "tetrahedron")
                lines.append(f"{noun} {verb} {words}: {listed(rows, _SHOWN)}")
        if self.improvement is not None:
            lines.append(str(self.improvement))
        return "\n".join(lines)


class Bounds(NamedTuple):
    """What a refinement must reach, and its limits."""

    ratio: float
    radius_edge: float
    size: Any
    max_volume: Any
    min_angle: float
    split: bool
    tolerance: float
    max_points: int
    progress: Callable[[int], object] | None


def as_bounds(
    *,
    ratio: float,
    radius_edge: float | None,
    size: Any,
    max_volume: Any,
    min_angle: float | None,
    boundary: str,
    tolerance: float,
    max_points: int | None,
    progress: Callable[[int], object] | None,
) -> Bounds:
    """Return checked arguments; sizes are checked with the mesh."""
    share = as_share(ratio, name="ratio")
    bound = np.inf if radius_edge is None else as_number(radius_edge, name="radius_edge")
    if not bound >= 1:
        raise InputError(
            f"radius_edge must be at least 1, or None for no bound, got {radius_edge!r:.80}"
        )
    return Bounds(
        ratio=share,
        radius_edge=float(bound),
        size=size,
        max_volume=max_volume,
        min_angle=improving.as_goal(_GOAL if min_angle is None else min_angle),
        split=as_choice(boundary, _BOUNDARIES, name="boundary") == "surface",
        tolerance=improving.as_tolerance(tolerance, boundary),
        max_points=MOST_ADDED if max_points is None else as_limit(max_points, name="max_points"),
        progress=as_callback(progress, name="progress"),
    )


class _State(NamedTuple):
    """A mesh during refinement, with all faces that stay; points are divided by `unit`."""

    unit: float
    points: Floats
    simplices: Indices
    labels: Indices
    # (k, 3): the input faces, then others on the boundary and between regions.
    faces: Indices
    # (k,): what is one facet in any case, the marker, and the row of `faces` before.
    sources: Indices
    markers: Indices
    rows: Indices


def refined(mesh: Any, marked: ArrayLike | None, bounds: Bounds) -> Any:
    """Return a finer TetMesh; see ``TetMesh.refine``."""
    start = state = _started(mesh)
    corners = start.points[start.simplices]
    volumes = _volumes(corners)
    further = None
    if marked is not None:
        rows = chosen(marked, mesh.nsimplex, "tetrahedra")
        further = _size_function(mesh, rows, length_of(bounds.ratio * volumes[rows]) * start.unit)
    extent = float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    if bounds.tolerance >= extent * start.unit:
        raise InputError(
            f"tolerance={bounds.tolerance:g} is larger than the mesh, which extends over "
            f"{extent * start.unit:g}: give it in the unit of the points"
        )
    regions, scale = np.unique(mesh.region), (extent, start.unit)
    lengths = Lengths(bounds.size, bounds.max_volume, regions, scale, further)
    lengths.require_within(corners, mesh.region, volumes, bounds.max_points)
    total = dict.fromkeys(REFINEMENT_COUNTS, 0)
    improvement, left = None, bounds.max_points
    for turn in range(1 + _AGAIN):
        made, enough = _rounds(state, lengths, bounds, left)
        counts = [made.on_segments, made.on_facets, made.for_shapes, made.for_sizes, not enough]
        for name, count in zip(REFINEMENT_COUNTS, counts, strict=True):
            total[name] += count
        left -= sum(counts[:-1])
        if turn and not sum(counts[:-1]):
            break
        state = _continued(state, made)
        if not bounds.min_angle:
            break
        state, improvement = _improved(state, bounds, left)
        total["for_shapes"] += improvement.points_added
        left -= improvement.points_added
        excess = _excess(state.points, state.simplices, lengths.at(*_placed(state)))
        if not enough or excess.max(initial=0) <= 1 + _ROUNDING:
            break
    return _finished(mesh, (start, state), (total, improvement), lengths, bounds)


def _started(mesh: Any) -> _State:
    """Return a mesh with all faces of its boundary and between its regions."""
    given = np.ascontiguousarray(mesh.input_faces, dtype=np.int32)
    across = mesh.neighbors
    border = (across < 0) | (mesh.region[across] != mesh.region[:, None])
    # Those between regions from the tetrahedron with the smaller number.
    border &= (across < 0) | (across > np.arange(len(across))[:, None])
    if len(given):
        border &= sides(mesh.simplices, given, mesh.npoints).face < 0
    simplex, corner = np.nonzero(border)
    further = mesh.simplices[simplex[:, None], np.array(FACES)[corner]]
    faces = np.concatenate((given, further.astype(np.int32)))
    count = len(further)
    sources = np.unique(mesh.face_source, return_inverse=True)[1].reshape(-1)
    markers = np.unique(mesh.face_markers, return_inverse=True)[1].reshape(-1)
    beyond = int(sources.max(initial=-1)) + 1
    other = int(markers.max(initial=-1)) + 1
    unit = _unit(mesh.points[mesh.simplices.ravel()])
    return _State(
        unit=unit,
        points=mesh.points / unit,
        simplices=mesh.simplices,
        labels=mesh.region,
        faces=np.ascontiguousarray(faces),
        sources=np.concatenate((sources, beyond + np.arange(count))).astype(np.int32),
        markers=np.concatenate((markers, np.full(count, other))).astype(np.int32),
        rows=np.arange(len(faces), dtype=np.int32),
    )


def _rounds(
    state: _State, lengths: Lengths, bounds: Bounds, limit: int
) -> tuple[RefinedTetrahedra, bool]:
    """Let the core add points, at most `limit`; sizes are requested between its rounds."""
    refinement = _core.Refinement3(
        state.points,
        state.simplices,
        state.labels,
        (state.faces, state.sources, state.markers),
        (bounds.split, bounds.tolerance / state.unit),
        bounds.radius_edge,
    )
    enough, added = True, 0
    for turn in range(_MOST_ROUNDS):
        corners, labels = refinement.fresh()
        complies = refinement.comply(lengths.at(corners.reshape(-1, 4, 3), labels), lengths.varies)
        if turn and complies:
            break
        before = added
        enough, added = refinement.refine(limit - added, bounds.progress)
        # With constant sizes, new tetrahedra have those of the old ones.
        if not enough or (turn and added == before) or not lengths.varies:
            break
    return refinement.export(), enough


def _continued(state: _State, made: RefinedTetrahedra) -> _State:
    """Return the state that the core made of another one."""
    return state._replace(
        points=made.points,
        simplices=made.simplices,
        labels=made.labels,
        faces=made.faces,
        sources=state.sources[made.face_rows],
        markers=state.markers[made.face_rows],
        rows=state.rows[made.face_rows],
    )


def _improved(state: _State, bounds: Bounds, left: int) -> tuple[_State, ImproveReport]:
    """Return a mesh with better tetrahedra and at most `left` more points, and the report."""
    neighbors = _core.facet_neighbors(state.simplices, len(state.points))
    kept = Kept.of(state.simplices, neighbors, state.faces, state.labels)
    free = improving.Points.free(len(state.points))
    tell = bounds.progress
    made, report, _ = improving.improved(
        (state.points, state.simplices, kept.labels),
        free,
        bounds.min_angle,
        limits=(_PASSES, left),
        progress=None if tell is None else lambda *_: tell(bounds.max_points - left),
    )
    return (
        state._replace(points=made.points, simplices=made.simplices, labels=kept.own[made.labels]),
        report,
    )


def _placed(state: _State) -> tuple[Floats, Indices]:
    return state.points[state.simplices], state.labels


def _finished(
    mesh: Any,
    states: tuple[_State, _State],
    done: tuple[dict[str, int], ImproveReport | None],
    lengths: Lengths,
    bounds: Bounds,
) -> Any:
    """Return the mesh of the last state, with its report."""
    (start, state), (total, improvement) = states, done
    if bounds.tolerance:
        _require_apart(mesh, state, bounds.tolerance)
    simplices = np.ascontiguousarray(state.simplices)
    excess = _excess(state.points, simplices, lengths.at(*_placed(state)))
    shapes = _radius_edge(state.points[simplices])
    with np.errstate(over="ignore"):
        points = state.points * start.unit
    if not np.array_equal(points / start.unit, state.points):
        raise LimitError(
            "between these points, no added point is a double of full accuracy: scale the "
            "coordinates"
        )
    own = state.rows < len(mesh.input_faces)
    rows = state.rows[own]
    report = RefinementReport(
        **{name: total[name] for name in REFINEMENT_COUNTS[:-1]},
        exhausted=bool(total["exhausted"]),
        radius_edge=bounds.radius_edge,
        largest_radius_edge=float(shapes.max(initial=0.0)),
        largest_size_ratio=float(excess.max(initial=0.0)),
        surface_distance=_distance(start, state, bounds.tolerance / start.unit) * start.unit,
        too_large=np.flatnonzero(excess > 1 + _ROUNDING),
        above_ratio=np.flatnonzero(shapes > bounds.radius_edge * (1 + _ROUNDING)),
        improvement=improvement,
        recovery=_recovery(mesh.report),
    )
    arrays: dict[str, NDArray[Any]] = {
        "points": points,
        "simplices": simplices,
        "neighbors": _core.facet_neighbors(simplices, len(points)),
        "region": state.labels,
        "input_faces": state.faces[own],
        "face_source": mesh.face_source[rows],
        "face_markers": mesh.face_markers[rows],
        "holes": mesh.holes,
    }
    nadded = mesh.nadded + len(points) - mesh.npoints
    return type(mesh)._of(arrays, report, nadded, mesh._workers)


def _require_apart(mesh: Any, state: _State, tolerance: float) -> None:
    """Require that faces that moved within the tolerance do not cross others."""
    faces = np.ascontiguousarray(state.faces)
    found = _core.check_surface3(state.points, faces, 1, 0).pairs
    if found.ncrossing:
        rows = state.rows[found.faces[0]]
        own = rows < len(mesh.face_source)
        named = f" {' and '.join(map(str, mesh.face_source[rows]))}" if own.all() else ""
        raise InputError(
            f"faces{named} would cross if they were moved by tolerance={tolerance:g}: give a "
            "tolerance that is smaller than the gaps between faces"
        )


def _recovery(report: ImproveReport | RecoveryReport | RefinementReport) -> RecoveryReport | None:
    if isinstance(report, RefinementReport):
        return report.recovery
    return report if isinstance(report, RecoveryReport) else None


def _unit(points: Floats) -> float:
    """Return 1, or the power of two with which products of coordinates remain doubles."""
    largest = float(np.abs(points).max())
    return 1.0 if _USUAL[0] <= largest <= _USUAL[1] else 2.0 ** int(np.frexp(largest)[1] - 1)


def _size_function(
    mesh: Any, rows: NDArray[np.intp], lengths: Floats
) -> Callable[[Floats], Floats]:
    """Return a size function that asks for these lengths in chosen tetrahedra."""
    sizes = np.full(mesh.nsimplex, np.inf)
    sizes[rows] = lengths

    def size(positions: Floats) -> Floats:
        found = mesh.locate(positions)
        return np.asarray(sizes[np.where(found.simplex >= 0, found.simplex, found.beside)])

    return size


def _excess(points: Floats, simplices: Indices, sizes: Floats) -> Floats:
    """Return by which factor each tetrahedron is larger than its size, as the core measures it."""
    corners = points[simplices]
    found: Floats = np.maximum(length_of(_volumes(corners)), _longest(corners) / 2) / sizes
    return found


def _volumes(corners: Floats) -> Floats:
    sides = corners[:, 1:] - corners[:, :1]
    normals = np.cross(sides[:, 0], sides[:, 1])
    volumes: Floats = np.abs(np.einsum("ij,ij->i", normals, sides[:, 2])) / 6
    return volumes


def _longest(corners: Floats) -> Floats:
    ends = corners[:, [1, 2, 3, 0, 2, 3]] - corners[:, [0, 1, 2, 3, 0, 1]]
    found: Floats = np.linalg.norm(ends, axis=2).max(axis=1)
    return found


def _radius_edge(corners: Floats) -> Floats:
    """Return the circumradius divided by the shortest edge; infinite beyond the doubles."""
    a, b, c = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 0)
    ends = corners[:, [1, 2, 3, 0, 2, 3]] - corners[:, [0, 1, 2, 3, 0, 1]]
    shortest = np.linalg.norm(ends, axis=2).min(axis=1)
    normal = np.cross(a, b)
    squares = [(x * x).sum(axis=1)[:, None] for x in (a, b, c)]
    center = squares[2] * normal + squares[0] * np.cross(b, c) + squares[1] * np.cross(c, a)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        radius = np.linalg.norm(center, axis=1) / (2 * np.abs((normal * c).sum(axis=1)))
        found: Floats = np.nan_to_num(radius / shortest, nan=np.inf)
    return found


def _distance(start: _State, state: _State, tolerance: float) -> float:
    """Return a bound on the distance of faces from the input faces."""
    # The measure is off by a few rounding errors of coordinates.
    rounding = float(16 * np.finfo(np.float64).eps * np.abs(start.points).max())
    if tolerance:
        # The old and the new faces of a planar part are between two planes.
        return 2 * tolerance + rounding
    new = state.faces >= len(start.points)
    at = np.flatnonzero(new.any(axis=1))
    if not len(at):
        return 0.0
    a, b, c = np.moveaxis(start.points[start.faces[state.rows[at]]], 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    off = np.abs(((state.points[state.faces[at]] - a[:, None]) * normal[:, None]).sum(axis=2))
    return float(off[new[at]].max() + rounding)
