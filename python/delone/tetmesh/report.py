"""What an improvement did: changes by kind, angles before and after, and what is left and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.counting import counted
from delone.immutable import ReadOnly
from delone.space import quality
from delone.space.quality import EDGES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import ImprovedMesh

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["CAUSES", "COUNTS", "ImproveReport", "report"]

CAUSES = ("angle", "boundary", "budget", "other")
_ANGLE, _BOUNDARY, _BUDGET, _OTHER = range(4)
# The fields of a report that count.
COUNTS = (
    "edge_removals",
    "boundary_flips",
    "face_removals",
    "moves",
    "exudations",
    "refused",
    "passes",
    "exhausted",
)
_SHOWN = 5
_BAR = 40


@dataclass(frozen=True, eq=False, kw_only=True)
class ImproveReport(ReadOnly):
    """What an improvement did; truthy when no dihedral angle is below the goal.

    Parameters
    ----------
    min_angle : float
        The goal for the smallest dihedral angles, in degrees.
    smallest_before, smallest_after, largest_before, largest_after : float
        The smallest and the largest dihedral angle, in degrees.
    bounds : ndarray of float64, shape (k + 1,)
        Bounds of classes of smallest dihedral angles, in degrees.
    before, after : ndarray of int64, shape (k,)
        How many tetrahedra there were and are in each class.
    edge_removals, boundary_flips, face_removals, moves : int
        How often an edge inside was removed (3-2, 4-4 and so on), an edge of the boundary (2-2 and
        so on), faces between two vertices (2-3 and so on), and how often a vertex was moved.
    exudations : int
        How many vertices were given a weight.
    weights : ndarray of float64, shape (n,)
        These weights, in the square of the unit of the points, and nought elsewhere.
    refused : int
        How many changes were refused although the worst quality would have risen: a smallest angle
        would have fallen, or rounding did not allow to tell.
    passes : int
        How many passes there were.
    exhausted : bool
        Whether the limit on passes ended the work while it still gained.
    below : ndarray of int64, shape (j,)
        The tetrahedra that are below the goal, ascending.
    cause : ndarray of str, shape (j,)
        For each of these ``"angle"`` (the boundary has this angle there), ``"boundary"`` (all four
        vertices are on the boundary, or fixed), ``"budget"`` (the limit on passes) or ``"other"``
        (no single removal or move is better).

    Attributes
    ----------
    ok : bool
        True when no tetrahedron is below the goal.

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
    exudations: int
    weights: Floats
    refused: int
    passes: int
    exhausted: bool
    below: NDArray[np.int64]
    cause: NDArray[np.str_]

    @property
    def ok(self) -> bool:
        """True when no tetrahedron is below the goal."""
        return not len(self.below)

    def __bool__(self) -> bool:
        return self.ok

    def __str__(self) -> str:
        lines = [
            f"dihedral angles from {self.smallest_before:.4g} to {self.largest_before:.4g} degrees "
            f"before, {self.smallest_after:.4g} to {self.largest_after:.4g} after",
            f"{counted(self.edge_removals + self.boundary_flips, 'edge')} and "
            f"{counted(self.face_removals, 'set')} of faces removed, "
            f"{counted(self.moves, 'move')} of vertices in {counted(self.passes, 'pass')}",
        ]
        if self.exudations:
            lines.append(f"{counted(self.exudations, 'weight')} given to vertices")
        lines += self._histogram()
        for cause, what in _SENTENCES.items():
            rows = self.below[self.cause == cause]
            if len(rows):
                shown = ", ".join(map(str, rows[:_SHOWN].tolist()))
                more = ", ..." if len(rows) > _SHOWN else ""
                noun = counted(len(rows), "tetrahedron")
                lines.append(f"{noun} below {self.min_angle:.4g} {what}: {shown}{more}")
        if self.exhausted:
            lines.append("the limit on passes ended the work")
        return "\n".join(lines)

    def _histogram(self) -> list[str]:
        most = max(int(self.before.max(initial=0)), int(self.after.max(initial=0)), 1)
        lines = ["smallest dihedral angle    before     after"]
        for low, high, was, now in zip(
            self.bounds[:-1], self.bounds[1:], self.before, self.after, strict=True
        ):
            bar = "#" * int(np.ceil(_BAR * now / most))
            lines.append(f"{low:10.4g} to {high:<10.4g}{was:>10}{now:>10}  {bar}".rstrip())
        return lines

    def plot(self, ax: Any = None) -> Any:
        """Draw the histograms of the smallest dihedral angles (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

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
    "angle": "by the angle of the boundary there",
    "boundary": "with all vertices on the boundary",
    "budget": "for want of passes",
    "other": "that no single change makes better",
}


def report(
    before: quality.TetQuality, made: ImprovedMesh, fixed: NDArray[np.bool_], min_angle: float
) -> tuple[ImproveReport, quality.TetQuality]:
    """Judge improved tetrahedra.

    Parameters
    ----------
    before : TetQuality
        The measures of what there was.
    made : ImprovedMesh
        What the core has made of it.
    fixed : ndarray of bool, shape (n,)
        Points that may not move.
    min_angle : float
        The goal in degrees.

    Returns
    -------
    report : ImproveReport
        The judgement.
    after : TetQuality
        The measures now.
    """
    points, simplices, counts = made.points, made.simplices, made.counts
    exhausted = made.exhausted
    after = quality.measured(points, simplices)
    was, bounds = before.histogram()
    now, _ = after.histogram()
    below = np.flatnonzero(after.smallest_dihedral < min_angle)
    walls = _walls(made.neighbors, made.labels)
    cause = np.full(len(below), _BUDGET if exhausted else _OTHER)
    held = _on_walls(simplices, walls, len(points)) | fixed
    cause[held[simplices[below]].all(axis=1)] = _BOUNDARY
    cause[_forced(points, simplices[below], walls[below], min_angle)] = _ANGLE
    judged = ImproveReport(
        min_angle=min_angle,
        smallest_before=float(before.smallest_dihedral.min(initial=180.0)),
        smallest_after=float(after.smallest_dihedral.min(initial=180.0)),
        largest_before=float(before.largest_dihedral.max(initial=0.0)),
        largest_after=float(after.largest_dihedral.max(initial=0.0)),
        bounds=bounds,
        before=was,
        after=now,
        edge_removals=counts.edges - counts.boundary,
        boundary_flips=counts.boundary,
        face_removals=counts.faces,
        moves=counts.moves,
        exudations=counts.weights,
        weights=made.weights,
        refused=counts.refused,
        passes=counts.passes,
        exhausted=exhausted,
        below=below,
        cause=np.array(CAUSES)[cause],
    )
    return judged, after


def _walls(neighbors: Indices, region: Indices) -> NDArray[np.bool_]:
    """Tell of each face whether nothing is behind it, or another region."""
    outside = neighbors < 0
    other: NDArray[np.bool_] = region[neighbors] != region[:, None]
    return outside | other


def _on_walls(simplices: Indices, walls: NDArray[np.bool_], npoints: int) -> NDArray[np.bool_]:
    held = np.zeros(npoints, dtype=bool)
    for k, face in enumerate(quality.FACES):
        held[simplices[walls[:, k]][:, list(face)]] = True
    return held


def _forced(
    points: Floats, simplices: Indices, walls: NDArray[np.bool_], min_angle: float
) -> NDArray[np.bool_]:
    """Tell which tetrahedra have a small dihedral angle between two walls."""
    angles = quality.dihedral_angles(points, simplices)
    forced = np.zeros(len(simplices), dtype=bool)
    for e, (i, j) in enumerate(EDGES):
        k, m = (c for c in range(4) if c not in (i, j))
        forced |= walls[:, k] & walls[:, m] & (angles[:, e] < min_angle)
    return forced
