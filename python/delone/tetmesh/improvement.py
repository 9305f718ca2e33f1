"""Improvement of tetrahedra: what is given goes through the core, and comes back with a report.

The core makes the changes (its head names the papers); here are the inputs and what is wrong with
them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._arrays import (
    as_choice,
    as_count,
    as_flag,
    as_number,
    as_plain_array,
    as_points,
    as_simplices,
    require_finite,
)
from delone.counting import counted
from delone.errors import DtypeError, InputError, ShapeError
from delone.space import quality
from delone.tetmesh import report
from delone.tetmesh.tetmesh import TetMesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["BOUNDARIES", "improve"]

BOUNDARIES = ("faces", "surface")
# The smallest angle of the regular tetrahedron, acos(1/3).
_MOST = 70.528
_INDEX_MAX = int(np.iinfo(np.int32).max)


def improve(
    mesh: Any,
    *,
    min_angle: float = 20.0,
    flips: bool = True,
    smooth: bool = True,
    exude: bool = False,
    boundary: str = "faces",
    region: ArrayLike | None = None,
    fixed: ArrayLike | None = None,
    max_iter: int = 30,
    progress: Callable[[int, int], object] | None = None,
) -> TetMesh:
    """Make the tetrahedra of a mesh better: remove slivers.

    Parameters
    ----------
    mesh : Delaunay, TetMesh or tuple of two arrays
        What is improved: a triangulation of points in space, or ``(points, simplices)`` with shapes
        (n, 3) and (m, 4), positively oriented tetrahedra that do not overlap.
    min_angle : float, optional
        The goal for the smallest dihedral angle of each tetrahedron, in degrees, from 0 to 70.528.
        Tetrahedra below it are worked on, and those with a dihedral angle half as far from 180.
    flips : bool, optional
        Whether edges and faces are removed.
    smooth : bool, optional
        Whether vertices inside move.
    exude : bool, optional
        Whether, before all else, vertices inside get weights with which the tetrahedra around them
        in the regular triangulation are better: sliver exudation.
    boundary : {"faces", "surface"}, optional
        What of the boundary stays: its triangles; or the surface, so that triangles in exactly one
        plane may be flipped. Its vertices never move.
    region : array_like of int, shape (m,), optional
        A number for each tetrahedron. Faces between different numbers stay, as the boundary does.
        By default that of a TetMesh.
    fixed : array_like of bool, shape (n,), or of int, optional
        Points that do not move: a mask, or rows.
    max_iter : int, optional
        How many passes over the tetrahedra below the goal there are at most.
    progress : callable, optional
        Called after each pass with its number and how many tetrahedra are below the goal.

    Returns
    -------
    TetMesh
        The better mesh, immutable: the same rows of points, some of them moved, and other
        tetrahedra that fill the same space. Its ``report`` has the angles before and after, the
        changes by kind, and what is left and why.

    Raises
    ------
    InputError
        A tetrahedron is flat or negatively oriented; three have one face; some overlap at a vertex
        inside; two used rows are one point; or an argument is not what it is to be.
    ShapeError, DtypeError, NonFiniteError
        The arrays are no points in space and tetrahedra.
    KeyboardInterrupt
        Ctrl-C was pressed.

    Notes
    -----
    Three kinds of changes: the removal of an edge, with the best triangulation of the ring around
    it (G. T. Klincsek 1980; J. R. Shewchuk 2002), of which the flips 3-2, 4-4 and 2-2 are special
    cases; its inverse, the removal of faces between two vertices, as in the flip 2-3; and the move
    of a vertex to where the worst tetrahedron around it is best (L. A. Freitag and C. Ollivier-
    Gooch 1997). Exudation (S.-W. Cheng et al. 2000) lets the star of a vertex grow as its weight
    does, up to a fifth of the squared distance to the nearest vertex; on a Delaunay triangulation,
    and without the other kinds, the result is the regular triangulation with the weights of the
    report. The quality is the smallest sine of the dihedral angles, where obtuse ones count
    twice, so that large angles become smaller too.

    Each change raises the worst quality of the tetrahedra that it touches, and does not lower the
    smallest angle among them; this is proven by bounds of the rounding errors, and new tetrahedra
    are positively oriented by the exact predicate. So the smallest dihedral angle of a mesh never
    becomes smaller, and the work ends: no state comes back. Vertices on the boundary stay, also
    those inside its sides.

    The result does not hang on the order of rows, and the work is done on one thread. Where the
    goal is reached time is some 10 microseconds a tetrahedron, and up to ten times that where
    points crowd against large triangles of the boundary. Memory is linear.

    Neighbours are made anew. That tetrahedra overlap is found out only where it shows at one
    vertex.

    Examples
    --------
    Six points of which four make a sliver, nearly a square:

    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0.01), (1, 1, 0), (0, 1, 0.01), (0.5, 0.5, 1), (0.5, 0.5, -1)]
    >>> sliver = [(0, 1, 2, 3), (0, 1, 3, 4), (1, 2, 3, 4), (1, 0, 2, 5), (0, 3, 2, 5)]
    >>> better = delone.improve((points, sliver))
    >>> print(f"{better.report.smallest_before:.1f}, {better.report.smallest_after:.1f}")
    1.1, 50.5
    """
    points, simplices, own = _given(mesh)
    labels = _labels(region, own, len(simplices))
    held = _mask(fixed, len(points))
    goal = _angle(min_angle)
    kinds = (
        as_flag(flips, name="flips"),
        as_flag(smooth, name="smooth"),
        as_flag(exude, name="exude"),
    )
    turn = as_choice(boundary, BOUNDARIES, name="boundary") == "surface"
    # More than the core counts are as many as it likes.
    passes = min(as_count(max_iter, name="max_iter"), _INDEX_MAX)
    if progress is not None and not callable(progress):
        raise DtypeError(f"progress must be callable, got {progress!r}")
    try:
        made = _core.improve3(points, simplices, labels, held, goal, *kinds, turn, passes, progress)
    except ShapeError as error:
        raise InputError(*error.args) from None
    before = quality.measured(points, simplices)
    if not len(held):
        held = np.zeros(len(points), dtype=bool)
    judged, after = report.report(before, made, held, goal)
    arrays: dict[str, NDArray[Any]] = {
        "points": made.points,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "region": made.labels,
    }
    better = TetMesh._of(arrays, judged)
    better._cache["quality"] = after
    return better


def _given(mesh: Any) -> tuple[Floats, Indices, Indices | None]:
    """Points, tetrahedra and regions."""
    if isinstance(mesh, tuple | list):
        if len(mesh) != 2:
            raise ShapeError(f"mesh must be (points, simplices), got {len(mesh)} things")
        points = as_points(mesh[0], ndim=3)
        simplices = as_simplices(mesh[1], len(points), 3)
    else:
        corners = np.shape(getattr(mesh, "simplices", ()))[1:]
        if getattr(mesh, "ndim", None) != 3 or corners != (4,):
            raise DtypeError(
                "mesh must be a Delaunay of points in space, a TetMesh, or (points, simplices), "
                f"got {type(mesh).__name__}"
            )
        points, simplices = mesh.points, mesh.simplices
    if not len(simplices):
        raise InputError("there are no tetrahedra")
    require_finite(points)
    _require_positive(points, simplices)
    return points, simplices, mesh.region if isinstance(mesh, TetMesh) else None


def _require_positive(points: Floats, simplices: Indices) -> None:
    corners = (np.ascontiguousarray(points[simplices[:, k]]) for k in range(4))
    signs = _core.orient3d(*corners)
    for sign, what in ((-1, "negatively oriented: swap two of their vertices"), (0, "flat")):
        rows = np.flatnonzero(signs == sign)
        if len(rows):
            noun = counted(len(rows), "tetrahedron")
            verb = "is" if len(rows) == 1 else "are"
            raise InputError(f"{noun} {verb} {what}; first: {rows[0]}")


def _labels(region: ArrayLike | None, own: Indices | None, count: int) -> Indices:
    if region is None:
        return np.empty(0, dtype=np.int32) if own is None else own
    array = as_plain_array(region, "region")
    if array.dtype.kind not in "iu":
        raise DtypeError(f"region must be integers, got {array.dtype}")
    if array.shape != (count,):
        raise ShapeError(f"region must have shape ({count},), got {array.shape}")
    if array.size and (array.min() < -_INDEX_MAX or array.max() > _INDEX_MAX):
        raise InputError("region must have numbers of 32 bits")
    return np.ascontiguousarray(array, dtype=np.int32)


def _mask(fixed: ArrayLike | None, count: int) -> Bools:
    if fixed is None:
        return np.empty(0, dtype=bool)
    array = as_plain_array(fixed, "fixed")
    if array.dtype == bool:
        if array.shape != (count,):
            raise ShapeError(f"fixed must have shape ({count},), got {array.shape}")
        return np.ascontiguousarray(array)
    held = np.zeros(count, dtype=bool)
    if array.shape == (0,):
        return held
    if array.dtype.kind not in "iu":
        raise DtypeError(f"fixed must be booleans or rows, got {array.dtype}")
    if array.ndim != 1:
        raise ShapeError(f"fixed must have one axis, got shape {array.shape}")
    if array.min() < 0 or array.max() >= count:
        raise InputError(f"fixed must be rows of points, from 0 to {count - 1}")
    held[array] = True
    return held


def _angle(value: float) -> float:
    goal = as_number(value, name="min_angle")
    if not 0 <= goal <= _MOST:
        raise InputError(f"min_angle must be from 0 to {_MOST}, got {value!r}")
    return goal
