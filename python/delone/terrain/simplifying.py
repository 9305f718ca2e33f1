"""Simplification: greedy insertion of points until the surface is within a maximum error.

Vertices on lines, on the outline and at corners of the hull are kept. The core inserts the others
where the error is largest, and returns their order; each surface is triangulated from the first
part of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_least, as_workers
from delone._base.counting import counted
from delone._base.immutable import ReadOnly
from delone._base.numbers import as_nonnegative
from delone._tiling.plane.topology import among, edge_keys
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InputError
from delone.terrain.building import Built
from delone.terrain.deviations import Deviations, deviations
from delone.terrain.surface import on_surface

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.terrain.surface import Surface

__all__ = [
    "KEEP",
    "Ground",
    "Simplification",
    "ground_of",
    "ground_of_points",
    "inside_of",
    "simplified",
]

KEEP = ("breaklines", "hard", "boundary")
# Extents within this factor of 1, as powers of two, are not scaled.
_USUAL = 200
# The core cannot number more triangles.
_MOST = 2**31 - 1


class Ground(NamedTuple):
    """Points of a surface, and which parts of it are kept."""

    points: Floats
    z: Floats
    fixed: Rows  # vertices that stay
    free: Rows  # all others
    segments: Indices  # (q, 2), edges that stay
    soft: Bools
    outline: Indices  # (o, 2), those of them with the surface on their left and none on their right
    crs: str | None
    units: str | None
    workers: int | None


class _Part(NamedTuple):
    """A triangulation of some rows, and its triangles of the surface."""

    mesh: ConstrainedDelaunay
    kept: Bools
    z: Floats
    soft: Bools


@dataclass(frozen=True, eq=False, kw_only=True)
class Simplification(ReadOnly):
    """All levels of detail of a surface, coarsest first.

    Create one with `TIN.simplification`.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The points with their heights.
    fixed : ndarray of int64, shape (f,)
        The points that all levels contain, as rows: on lines that are kept, on the outline, and
        corners of the hull.
    order : ndarray of int32, shape (k,)
        The point that each further level adds.
    errors : ndarray of float64, shape (k + 1,)
        For each level, the largest vertical distance of a point from its surface, rounded up.
    triangles : ndarray of int32, shape (k + 1,)
        The number of triangles of each level.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.terrain import TIN
    >>> x, y = np.meshgrid(np.arange(33.0), np.arange(33.0))
    >>> hill = np.column_stack((x.ravel(), y.ravel(), 20 - np.hypot(x - 16, y - 16).ravel()))
    >>> levels = TIN.from_points(hill).simplification(max_error=0.5)
    >>> levels
    <Simplification of 1089 points: 2 to 50 triangles, errors 22.6274 to 0.483282>
    >>> [levels.surface(max_error=error).nsimplex for error in (8, 2, 0.5)]
    [4, 12, 50]
    """

    points: Floats
    fixed: Rows
    order: Indices
    errors: Floats
    triangles: Indices
    _ground: Ground
    _made: Callable[[Built, int | None], Any]

    def __len__(self) -> int:
        return len(self.errors)

    def __repr__(self) -> str:
        low, high = self.triangles[[0, -1]].tolist()
        first, last = self.errors[[0, -1]].tolist()
        return (
            f"<Simplification of {counted(len(self.points), 'point')}: {low} to "
            f"{counted(high, 'triangle')}, errors {first:.6g} to {last:.6g}>"
        )

    def surface(self, *, max_error: float | None = None, max_triangles: int | None = None) -> Any:
        """Return the surface of a level.

        Parameters
        ----------
        max_error : float, optional
            Return the first level whose error is at most this.
        max_triangles : int, optional
            Instead, return the level with the smallest error among those with at most this many
            triangles.

        Returns
        -------
        TIN
            The surface.

        Raises
        ------
        InputError
            Not exactly one of the two is given, or no level satisfies it: the finest one has a
            larger error, or the coarsest one has more triangles.

        Examples
        --------
        See `Simplification`.
        """
        error, most = as_goal(max_error, max_triangles)
        return self._made(_built(self._ground, self._level(error, most)), self._ground.workers)

    def validate(
        self, *, max_error: float | None = None, max_triangles: int | None = None
    ) -> Deviations:
        """Prove the error of a level in exact arithmetic, independently of the core.

        Parameters
        ----------
        max_error, max_triangles
            As for `surface`.

        Returns
        -------
        Deviations
            Truthy if no point is farther from the surface than the error of the level, or than
            `max_error`.

        Raises
        ------
        InputError
            As for `surface`.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (1, 2, 1), (3, 2, 2)]
        >>> levels = TIN.from_points(points).simplification(max_error=0)
        >>> levels.validate(max_error=1)
        <Deviations of 6 points: none above 1>
        """
        error, most = as_goal(max_error, max_triangles)
        rows = self._level(error, most)
        limit = float(self.errors[len(rows) - len(self.fixed)]) if max_error is None else error
        part = _part(self._ground, rows)
        checked = np.concatenate((self.fixed, self._ground.free))
        return deviations(part.mesh, part.kept, part.z, self.points[checked], limit)

    def _level(self, error: float, most: int) -> Rows:
        """The vertices of a level."""
        if most == _MOST:
            reached = self.errors <= error
            k = int(np.argmax(reached))
            if not reached[k]:
                raise InputError(
                    f"max_error={error:g} is below the error of the finest level, "
                    f"{self.errors.min():.6g}: make a simplification with it"
                )
        else:
            few = int(np.searchsorted(self.triangles, most, side="right"))
            if few == 0:
                raise InputError(too_few(most, int(self.triangles[0])))
            k = int(np.argmin(self.errors[:few]))
        return np.concatenate((self.fixed, self.order[:k]))


def too_few(most: int, present: int) -> str:
    """Return the message that lines and outline alone need more triangles."""
    return (
        f"max_triangles={most} is below the {counted(present, 'triangle')} of lines, outline and "
        'hull: allow more, or choose keep="boundary"'
    )


def as_goal(max_error: Any, max_triangles: Any) -> tuple[float, int]:
    """Return the error and the number of triangles at which to stop; one of them is given."""
    if (max_error is None) == (max_triangles is None):
        raise InputError("give one of max_error and max_triangles")
    if max_triangles is not None:
        return 0.0, min(as_least(max_triangles, 1, name="max_triangles"), _MOST - 1)
    return as_nonnegative(max_error, name="max_error", finite=True), _MOST


def ground_of(tin: Surface, keep: str) -> Ground:
    """Return which parts of a surface are kept, and which may be removed."""
    as_choice(keep, KEEP, name="keep")
    count = tin.npoints
    ends = tin.simplices[:, [[1, 2], [2, 0], [0, 1]]][tin.neighbors < 0]
    outer = _keys(ends, count)
    beyond = _keys(tin._left_out()[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), count)
    # Beyond the outline are triangles that are left out; otherwise, the edge is on the hull.
    outline = ends[among(outer, beyond)]
    lines = _keys(tin.breaklines, count)
    stays = among(lines, outer) | (keep == "breaklines") | ((keep == "hard") & ~tin.soft)
    on = on_surface(tin)
    stays &= on[tin.breaklines].all(axis=1)
    bare = ~among(_keys(outline, count), lines)
    segments = np.concatenate((tin.breaklines[stays], outline[bare]))
    soft = np.append(tin.soft[stays], np.ones(np.count_nonzero(bare), dtype=bool))
    rows = np.flatnonzero(on)
    corners, _ = _core.hull2(tin.points[rows])
    fixed = np.zeros(count, dtype=bool)
    fixed[segments] = fixed[rows[corners]] = True
    return Ground(
        tin.points,
        tin.z,
        np.flatnonzero(fixed),
        np.flatnonzero(on & ~fixed),
        segments,
        soft,
        outline,
        tin.crs,
        tin.units,
        tin.workers,
    )


def ground_of_points(  # noqa: PLR0917
    points: Floats,
    z: Floats,
    crs: str | None,
    units: str | None,
    workers: int | None,
    rim: Rows | None = None,
) -> Ground:
    """Return points without lines, of which only the corners of the hull are kept.

    `rim` may name some of the points, among which are all corners.
    """
    fixed = np.zeros(len(points), dtype=bool)
    if rim is None or len(rim) < 3:
        fixed[_core.hull2(points)[0]] = True
    else:
        fixed[rim[_core.hull2(points[rim])[0]]] = True
    if np.count_nonzero(fixed) < 3:
        # On one line: the error names all of them.
        fixed[:] = True
    none = np.empty((0, 2), dtype=np.int32)
    soft = np.empty(0, dtype=bool)
    rows = np.flatnonzero(fixed), np.flatnonzero(~fixed)
    return Ground(points, z, *rows, none, soft, none, crs, units, workers)


def simplified(
    ground: Ground, made: Callable[[Built, int | None], Any], max_error: Any, max_triangles: Any
) -> Simplification:
    """Order the points by greedy insertion, until a goal is reached."""
    error, most = as_goal(max_error, max_triangles)
    coarse = _part(ground, ground.fixed)
    present = int(np.count_nonzero(coarse.kept))
    if present > most:
        raise InputError(too_few(most, present))
    mesh, free, workers = coarse.mesh, ground.free, as_workers(ground.workers)
    (places, corners), _ = _scaled(ground.points[free], mesh.points)
    (z, heights), rise = _scaled(ground.z[free], coarse.z)
    goal = float(np.nextafter(np.ldexp(error, -rise), 0.0)) if rise else error
    found = _core.simplify2(
        _Sheet(corners, mesh.simplices, mesh.neighbors, heights),
        mesh.segments,
        present,
        places,
        z,
        goal,
        most,
        workers,
    )
    errors = found.errors
    if rise:
        with np.errstate(over="ignore"):
            larger = np.nextafter(np.ldexp(errors, rise), np.where(errors > 0, np.inf, 0))
        # Rounded up, but what reaches the goal is within the error that was asked for.
        errors = np.where(errors <= goal, np.minimum(larger, error), larger)
    return Simplification(
        points=np.column_stack((ground.points, ground.z)),
        fixed=ground.fixed,
        order=free[found.order].astype(np.int32),
        errors=errors,
        triangles=found.triangles,
        _ground=ground,
        _made=made,
    )


class _Sheet(NamedTuple):
    """What the core needs of a surface."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


def _part(ground: Ground, rows: Rows) -> _Part:
    """Triangulate some of the points, with all lines that are kept."""
    number = np.full(len(ground.points), -1, dtype=np.int32)
    number[rows] = np.arange(len(rows), dtype=np.int32)
    mesh = ConstrainedDelaunay(
        ground.points[rows], number[ground.segments], planar=True, workers=ground.workers
    )
    keys = _keys(number[ground.segments], len(rows))
    order = np.argsort(keys)
    found = np.searchsorted(keys[order], _keys(mesh.segments, len(rows)))
    soft = ground.soft[order][found]
    return _Part(mesh, inside_of(mesh, number[ground.outline]), ground.z[rows], soft)


def _keys(edges: NDArray[np.integer], count: int) -> Rows:
    """The keys of edges, (..., 2)."""
    return edge_keys(edges[..., 0], edges[..., 1], count)


def inside_of(mesh: ConstrainedDelaunay, outline: Indices) -> Bools:
    """Which triangles are connected to the left side of the outline; all if there is none."""
    count = len(mesh.simplices)
    if not len(outline):
        return np.ones(count, dtype=bool)
    ends = mesh.simplices[:, [[1, 2], [2, 0], [0, 1]]].astype(np.int64)
    directed = ends[..., 0] * mesh.npoints + ends[..., 1]
    walls = _keys(outline, mesh.npoints)
    open_ = (mesh.neighbors >= 0) & ~among(_keys(ends, mesh.npoints), walls)
    own = np.broadcast_to(np.arange(count, dtype=np.int32)[:, None], open_.shape)
    pairs = np.column_stack((own[open_], mesh.neighbors[open_]))
    label = _core.graph_components(np.ascontiguousarray(pairs), count)
    left = among(directed, outline[:, 0].astype(np.int64) * mesh.npoints + outline[:, 1])
    chosen = np.zeros(count, dtype=bool)
    chosen[label[left.any(axis=1)]] = True
    return chosen[label]


def _built(ground: Ground, rows: Rows) -> Built:
    """The arrays of the surface of some of the points."""
    mesh, kept, z, soft = _part(ground, rows)
    return Built(
        mesh.points,
        z,
        mesh.simplices,
        mesh.neighbors,
        kept,
        mesh.segments,
        soft,
        ground.crs,
        ground.units,
    )


def _scaled(*arrays: Floats) -> tuple[list[Floats], int]:
    """Divide by a power of two if products of such numbers would overflow or underflow."""
    most = max(float(np.abs(each).max(initial=0.0)) for each in arrays)
    exponent = math.frexp(most)[1]
    if abs(exponent) > _USUAL:
        smaller = [np.ldexp(each, -exponent) for each in arrays]
        # If numbers would be rounded, nothing is scaled, and all points are inserted.
        if all(map(np.array_equal, (np.ldexp(each, exponent) for each in smaller), arrays)):
            return smaller, exponent
    return list(arrays), 0
