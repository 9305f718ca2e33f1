"""The report of an improvement: changes by kind, angles before and after, and what is left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.counting import agreed, counted, listed
from delone._base.immutable import ReadOnly
from delone._tiling.space import quality
from delone._tiling.space.quality import EDGES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone._core import ImprovedMesh, ImprovementCounts

__all__ = ["CAUSES", "COUNTS", "Changed", "ImproveReport", "report"]

CAUSES = ("angle", "boundary", "budget", "other", "rounding", "face")
_ANGLE, _BOUNDARY, _BUDGET, _OTHER, _ROUNDING, _FACE = range(6)
# Coordinates of rotated points have several rounding errors each: a product for every axis, their
# sum, and a shift. In thin tetrahedra, all four points are off their plane.
_ROUNDINGS = 16
# The fields of a report that are counts.
COUNTS = (
    "edge_removals",
    "boundary_flips",
    "face_removals",
    "moves",
    "boundary_moves",
    "tetrahedra_removed",
    "exudations",
    "points_added",
    "points_removed",
    "refused",
    "passes",
    "exhausted",
)
_SHOWN = 5
_BAR = 40


class Changed(NamedTuple):
    """Tetrahedra that the core has changed, with the rows of the remaining points."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    labels: Indices
    weights: Floats
    counts: ImprovementCounts
    distance: float
    exhausted: bool
    # Which rows of the core remain.
    left: Bools

    @classmethod
    def of(cls, made: ImprovedMesh, added: int) -> Changed:
        """Return a mesh of the core, without the points from row `added` on that were removed."""
        points, simplices, weights = made.points, made.simplices, made.weights
        left = np.ones(len(points), dtype=bool)
        if made.counts.removed:
            left[added:] = False
            left[simplices] = True
        rest = (
            made.neighbors,
            made.labels,
            weights[left],
            made.counts,
            made.distance,
            made.exhausted,
        )
        number = _number(left)
        return cls(points[left], number[simplices], *rest, left)

    def renumbered(self, rows: Indices) -> Indices:
        """Convert rows of the core, none of them removed, to rows of these points."""
        return _number(self.left)[rows]


def _number(left: Bools) -> Indices:
    return (np.cumsum(left) - 1).astype(np.int32)


@dataclass(frozen=True, eq=False, kw_only=True)
class ImproveReport(ReadOnly):
    """The result of an improvement; truthy if no dihedral angle is below the goal.

    Parameters
    ----------
    min_angle : float
        The goal for the smallest dihedral angles, in degrees.
    smallest_before, smallest_after, largest_before, largest_after : float
        The smallest and the largest dihedral angle, in degrees.
    bounds : ndarray of float64, shape (k + 1,)
        Bin edges of the histograms of smallest dihedral angles, in degrees.
    before, after : ndarray of int64, shape (k,)
        Number of tetrahedra in each bin, before and after.
    edge_removals, boundary_flips, face_removals, moves, boundary_moves : int
        Numbers of removals of interior edges (3-2, 4-4 and so on), of boundary edges (2-2 and so
        on), of the faces between two vertices (2-3 and so on), of moves of vertices, and of those
        on the boundary or between regions among them.
    tetrahedra_removed : int
        Number of tetrahedra that were removed at the boundary, within the tolerance.
    surface_distance : float
        An upper bound on the distance between the boundary and the original one; 0 if no
        tetrahedron was removed.
    exudations : int
        Number of vertices that got a weight.
    points_added, points_removed : int
        Numbers of points that were added and removed.
    weights : ndarray of float64, shape (n,)
        The weights of vertices, in the square of the unit of the points; 0 for other points.
    refused : int
        Number of changes that would have raised the worst quality but were rejected: a smallest
        angle would have become smaller, or rounding left it undecided.
    passes : int
        Number of passes.
    exhausted : bool
        Whether the limit on passes was reached while passes still made progress.
    below : ndarray of int64, shape (j,)
        The tetrahedra below the goal, ascending.
    cause : ndarray of str, shape (j,)
        For each of these, ``"rounding"`` (it is as thin as the rounding errors of coordinates: up
        to 16 times that of the largest), ``"angle"`` (the boundary has this angle), ``"face"`` (one
        of its faces is on the boundary, and has a plane angle below the goal), ``"boundary"`` (all
        four vertices are on the boundary, or fixed), ``"budget"`` (the limit on passes) or
        ``"other"`` (no single removal or move is an improvement).
    wall_edges : ndarray of int64, shape (j, 2)
        For the cause ``"angle"``, the edge at which two faces of the boundary, of regions or of the
        input form the smallest such angle in the tetrahedron, as rows of points; otherwise -1.

    Attributes
    ----------
    ok : bool
        True if no tetrahedron is below the goal.

    Examples
    --------
    >>> import delone
    >>> flat = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.3, 0.3, 0.01)], [(0, 1, 2, 3)]
    >>> report = delone.improve(flat).report
    >>> bool(report), report.cause.tolist()
    (False, ['angle'])
    """

    min_angle: float
    smallest_before: float
    smallest_after: float
    largest_before: float
    largest_after: float
    bounds: Floats
    before: NDArray[np.int64]
    after: NDArray[np.int64]
    edge_removals: int
    boundary_flips: int
    face_removals: int
    moves: int
    boundary_moves: int
    tetrahedra_removed: int
    surface_distance: float
    exudations: int
    weights: Floats
    points_added: int
    points_removed: int
    refused: int
    passes: int
    exhausted: bool
    below: NDArray[np.int64]
    cause: NDArray[np.str_]
    wall_edges: Rows

    @property
    def ok(self) -> bool:
        """True if no tetrahedron is below the goal."""
        return not len(self.below)

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        lines = [
            f"dihedral angles from {self.smallest_before:.4g} to {self.largest_before:.4g} degrees "
            f"before, {self.smallest_after:.4g} to {self.largest_after:.4g} after",
            f"{counted(self.edge_removals + self.boundary_flips, 'edge')} and "
            f"{counted(self.face_removals, 'set')} of faces removed, "
            f"{counted(self.moves, 'vertex move')} in {counted(self.passes, 'pass')}",
        ]
        if self.points_added:
            lines.append(f"{counted(self.points_added, 'point')} added")
        if self.points_removed:
            lines.append(f"{counted(self.points_removed, 'point')} removed")
        if self.tetrahedra_removed:
            lines.append(
                f"{counted(self.tetrahedra_removed, 'tetrahedron')} removed at the boundary, which "
                f"remains within {self.surface_distance:.2g}"
            )
        if self.exudations:
            lines.append(f"{counted(self.exudations, 'weight')} assigned to vertices")
        lines += self._histogram()
        for cause, what in _SENTENCES.items():
            rows = self.below[self.cause == cause]
            if len(rows):
                noun = counted(len(rows), "tetrahedron")
                shown = listed(rows, _SHOWN)
                lines.append(f"{noun} below {self.min_angle:.4g} {what}: {shown}")
        edges = np.unique(self.wall_edges[self.wall_edges[:, 0] >= 0], axis=0)
        if len(edges):
            shown = ", ".join(f"{a} to {b}" for a, b in edges[:_SHOWN].tolist())
            more = ", ..." if len(edges) > _SHOWN else ""
            verb = agreed(len(edges), "has", "have")
            lines.append(
                f"{counted(len(edges), 'edge')} of the boundary {verb} such an angle, between the "
                f"points {shown}{more}"
            )
        if self.exhausted:
            lines.append("stopped at the limit on passes")
        return "\n".join(lines)

    def _histogram(self) -> list[str]:
        largest = max(int(self.before.max(initial=0)), int(self.after.max(initial=0)), 1)
        lines = ["smallest dihedral angle    before     after"]
        for low, high, before, after in zip(
            self.bounds[:-1], self.bounds[1:], self.before, self.after, strict=True
        ):
            bar = "#" * int(np.ceil(_BAR * after / largest))
            lines.append(f"{low:10.4g} to {high:<10.4g}{before:>10}{after:>10}  {bar}".rstrip())
        return lines

    def plot(self, ax: Any = None) -> Any:
        """Draw histograms of the smallest dihedral angles (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.

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
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).report.plot().get_ylabel()
        'tetrahedra'
        """
        from delone.plot import draw_histograms

        return draw_histograms(
            self.bounds, {"before": self.before, "after": self.after}, ax=ax, bound=self.min_angle
        )


_SENTENCES = {
    "rounding": "as thin as the rounding of coordinates",
    "angle": "because of the angle of the boundary",
    "face": "at a thin face of the boundary, which has a plane angle below that",
    "boundary": "with all vertices fixed or on the boundary",
    "budget": "because of the limit on passes",
    "other": "that no single change improves",
}


def report(
    before: quality.TetQuality, made: Changed, fixed: NDArray[np.bool_], min_angle: float
) -> tuple[ImproveReport, quality.TetQuality]:
    """Return the report of an improvement, and the measures of the result.

    `before` are the measures of the input, `fixed`, (n,), the points that must not move.
    """
    points, simplices, counts = made.points, made.simplices, made.counts
    after = quality.measured(points, simplices)
    histogram_before, bounds = before.histogram()
    histogram_after, _ = after.histogram()
    below = np.flatnonzero(after.smallest_dihedral < min_angle)
    walls = _walls(made.neighbors, made.labels)
    cause = np.full(len(below), _BUDGET if made.exhausted else _OTHER)
    held = _on_walls(simplices, walls, len(points)) | fixed
    cause[held[simplices[below]].all(axis=1)] = _BOUNDARY
    thin = _plane_angles(points, simplices[below]) < min_angle
    cause[(thin & walls[below]).any(axis=1)] = _FACE
    wall_edges = _wall_edges(points, simplices[below], walls[below], min_angle)
    cause[wall_edges[:, 0] >= 0] = _ANGLE
    cause[_thin(points, simplices[below], after.volume[below])] = _ROUNDING
    wall_edges[cause != _ANGLE] = -1
    judged = ImproveReport(
        min_angle=min_angle,
        smallest_before=float(before.smallest_dihedral.min(initial=180.0)),
        smallest_after=float(after.smallest_dihedral.min(initial=180.0)),
        largest_before=float(before.largest_dihedral.max(initial=0.0)),
        largest_after=float(after.largest_dihedral.max(initial=0.0)),
        bounds=bounds,
        before=histogram_before,
        after=histogram_after,
        edge_removals=counts.edges - counts.boundary,
        boundary_flips=counts.boundary,
        face_removals=counts.faces,
        moves=counts.moves,
        boundary_moves=counts.slides,
        tetrahedra_removed=counts.peeled,
        surface_distance=made.distance,
        exudations=counts.weights,
        weights=made.weights,
        points_added=counts.added,
        points_removed=counts.removed,
        refused=counts.refused,
        passes=counts.passes,
        exhausted=made.exhausted,
        below=below,
        cause=np.array(CAUSES)[cause],
        wall_edges=wall_edges,
    )
    return judged, after


def _thin(points: Floats, simplices: Indices, volume: Floats) -> NDArray[np.bool_]:
    """Return which tetrahedra are as thin as the rounding of the largest coordinate."""
    corners = points[simplices]
    spread = np.abs(corners).max(initial=0.0)
    # Relative to a corner, in units of the largest coordinate: products stay within the doubles.
    unit = spread if spread > 0 else 1.0
    sides = (corners[:, 1:] - corners[:, :1]) / unit
    a, b, c = sides[:, 0], sides[:, 1], sides[:, 2]
    doubled = [np.cross(a, b), np.cross(b, c), np.cross(c, a), np.cross(b - a, c - a)]
    largest = np.max([np.sqrt((each**2).sum(axis=1)) for each in doubled], axis=0)
    height = 6 * (volume / unit / unit / unit)
    rounding = _ROUNDINGS * np.finfo(np.float64).eps / 2
    found: NDArray[np.bool_] = height <= rounding * largest
    return found


def _walls(neighbors: Indices, region: Indices) -> NDArray[np.bool_]:
    """Return which faces are on the boundary or between two regions."""
    outside = neighbors < 0
    between: NDArray[np.bool_] = region[neighbors] != region[:, None]
    return outside | between


def _on_walls(simplices: Indices, walls: NDArray[np.bool_], npoints: int) -> NDArray[np.bool_]:
    held = np.zeros(npoints, dtype=bool)
    for k, face in enumerate(quality.FACES):
        held[simplices[walls[:, k]][:, list(face)]] = True
    return held


def _plane_angles(points: Floats, simplices: Indices) -> Floats:
    """Return the smallest angle of the face opposite each corner, in degrees, shape (m, 4)."""
    found = np.empty((len(simplices), 4))
    for k, face in enumerate(quality.FACES):
        corners = points[simplices[:, list(face)]]
        # Relative to the longest side, so that products stay within the doubles.
        sides = corners[:, [1, 2, 0]] - corners
        lengths = np.linalg.norm(sides / np.abs(sides).max(axis=(1, 2))[:, None, None], axis=2)
        shortest, middle, longest = np.sort(lengths, axis=1).T
        # The half-angle formula for the angle opposite the shortest side is stable for needles.
        between = (shortest - (longest - middle)) * (shortest + (longest - middle))
        half = np.sqrt(np.maximum(between, 0) / (4 * longest * middle))
        found[:, k] = np.degrees(2 * np.arcsin(np.minimum(half, 1)))
    return found


def _wall_edges(
    points: Floats, simplices: Indices, walls: NDArray[np.bool_], min_angle: float
) -> NDArray[np.int64]:
    """Return the edge with the smallest dihedral angle below the goal between two walls, or -1."""
    angles = quality.dihedral_angles(points, simplices)
    found = np.full((len(simplices), 2), -1, dtype=np.int64)
    smallest = np.full(len(simplices), min_angle)
    for e, (i, j) in enumerate(EDGES):
        k, m = (c for c in range(4) if c not in (i, j))
        smaller = walls[:, k] & walls[:, m] & (angles[:, e] < smallest)
        found[smaller] = np.sort(simplices[smaller][:, [i, j]], axis=1)
        smallest[smaller] = angles[smaller, e]
    return found
