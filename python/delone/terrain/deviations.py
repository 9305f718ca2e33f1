"""The vertical distance of points from a surface, proven exactly.

The weights of the corners of a triangle are areas between the point and its edges. The surface is n
/ w above the point, where n is the sum of the weights times the heights above the point, and w the
sum of the weights. Each term of n results from at most 7 rounded operations, and each term of w
from at most 5, so 16 units of rounding times the sums of absolute values bound the errors of both.
Where that is not enough to decide, fractions decide.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from delone._base.counting import counted
from delone._base.immutable import ReadOnly

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices, Rows

__all__ = ["Deviations", "deviations"]

_ROUNDINGS = 16 * 2.0**-53
# Number of points that are compared at a time.
_BLOCK = 1 << 18


@dataclass(frozen=True, eq=False, kw_only=True)
class Deviations(ReadOnly):
    """How far points are from a surface; truthy if none is farther than a limit.

    Parameters
    ----------
    limit : float
        The largest vertical distance that is allowed.
    distances : ndarray of float64, shape (n,)
        The vertical distances, rounded; NaN outside the surface.
    above : ndarray of int64
        The points that are farther than `limit`, exactly.
    outside : ndarray of int64
        The points outside the surface.

    Examples
    --------
    See `Simplification.validate`.
    """

    limit: float
    distances: Floats
    above: Rows
    outside: Rows

    def __bool__(self) -> bool:
        return not len(self.above) and not len(self.outside)

    def __repr__(self) -> str:
        above = f"{len(self.above)} above" if len(self.above) else "none above"
        beyond = f", {len(self.outside)} outside" if len(self.outside) else ""
        points = counted(len(self.distances), "point")
        return f"<Deviations of {points}: {above} {self.limit:g}{beyond}>"


class Mesh(Protocol):
    """Triangles in which points can be located: those of a mesh, or of a surface."""

    @property
    def points(self) -> Floats:
        """Vertices, (n, 2)."""

    @property
    def npoints(self) -> int:
        """Number of vertices."""

    @property
    def simplices(self) -> Indices:
        """Triangles, (m, 3)."""

    def find_simplex(self, xi: ArrayLike) -> Indices:
        """The triangles at positions."""


class _Part(NamedTuple):
    """Some points in their triangles."""

    points: Floats  # (n, 3)
    corners: Floats  # (n, 3, 3)


def deviations(mesh: Mesh, kept: Bools, z: Floats, points: Floats, limit: float) -> Deviations:
    """Compare points with a surface over the triangles of a mesh that are kept."""
    home = _homes(mesh, kept, points[:, :2])
    raised = np.column_stack((mesh.points, z))
    distances = np.full(len(points), np.nan)
    above: Bools = np.zeros(len(points), dtype=bool)
    inside = (home >= 0) & kept[home]
    for start in range(0, len(points), _BLOCK):
        rows = np.flatnonzero(inside[start : start + _BLOCK]) + start
        part = _Part(points[rows], raised[mesh.simplices[home[rows]]])
        distances[rows], certain, above[rows] = _compared(part, limit)
        for k in np.flatnonzero(~certain).tolist():
            above[rows[k]] = _distance(part.points[k], part.corners[k]) > Fraction(limit)
    return Deviations(
        limit=limit,
        distances=distances,
        above=np.flatnonzero(above),
        outside=np.flatnonzero(~inside),
    )


def _homes(mesh: Mesh, kept: Bools, places: Floats) -> Indices:
    """The triangles of points; at vertices one that is kept, if there is any."""
    home = mesh.find_simplex(places)
    chosen = np.flatnonzero(kept)
    of_vertex = np.full(mesh.npoints, -1, dtype=np.int32)
    of_vertex[mesh.simplices[chosen]] = chosen[:, None]
    rows = np.flatnonzero((home >= 0) & ~kept[home])
    corners = mesh.simplices[home[rows]]
    same = (mesh.points[corners] == places[rows, None]).all(axis=2)
    own = of_vertex[corners[same]]
    rows = rows[same.any(axis=1)]
    home[rows[own >= 0]] = own[own >= 0]
    return home


def _compared(part: _Part, limit: float) -> tuple[Floats, Bools, Bools]:
    """The distances, which of them are certainly above the limit or not, and which are above."""
    with np.errstate(all="ignore"):
        x, y, z = np.moveaxis(part.corners - part.points[:, None], -1, 0)
        nx, ny = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
        # The edge from each corner to the next; its weight is that of the third corner.
        weights = np.roll(nx * y - ny * x, -1, axis=1)
        sizes = np.roll(np.abs(nx * y) + np.abs(ny * x), -1, axis=1)
        n, w = np.abs((weights * z).sum(axis=1)), np.abs(weights.sum(axis=1))
        slack = _ROUNDINGS * (sizes * np.abs(z)).sum(axis=1) + 2.0**-900
        width = _ROUNDINGS * sizes.sum(axis=1) + 2.0**-1000
        below = n + slack <= limit * (w - width) * (1 - _ROUNDINGS)
        over = n - slack > limit * (w + width) * (1 + _ROUNDINGS)
        level = (z == 0).all(axis=1)
        found = np.where(level, 0.0, n / w)
    return found, below | over | level, over & ~level


def _distance(point: Floats, corners: Floats) -> Fraction:
    """The exact distance."""
    x, y, z = map(Fraction, point.tolist())
    a, b, c = (
        [Fraction(v) - o for v, o in zip(corner, (x, y, z), strict=True)]
        for corner in corners.tolist()
    )
    weights = [p[0] * q[1] - p[1] * q[0] for p, q in ((b, c), (c, a), (a, b))]
    rise = sum(w * corner[2] for w, corner in zip(weights, (a, b, c), strict=True))
    return abs(Fraction(rise) / sum(weights))
