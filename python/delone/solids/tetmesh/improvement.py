"""The function `improve`: checks the input, calls the core and creates the mesh with its report.

The core makes the changes (its module comment names the papers); this module validates the input.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_callback,
    as_choice,
    as_flag,
    as_limit,
    as_points,
    as_simplices,
    require_finite,
)
from delone._base.counting import agreed, counted
from delone._base.values import as_labels
from delone.errors import DtypeError, InputError, ShapeError
from delone.solids.tetmesh import improving, walls
from delone.solids.tetmesh.relaxing import mesh_of
from delone.solids.tetmesh.tetmesh import TetMesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices

__all__ = ["BOUNDARIES", "improve"]

BOUNDARIES = ("faces", "surface")
CONTRACT = ("added", "all", "none")
_INDEX_MAX = int(np.iinfo(np.int32).max)


def improve(
    mesh: Any,
    *,
    min_angle: float = 20.0,
    flips: bool = True,
    smooth: bool = True,
    exude: bool = False,
    boundary: str = "faces",
    tolerance: float = 0.0,
    region: ArrayLike | None = None,
    fixed: ArrayLike | None = None,
    max_points: int = 0,
    contract: str = "added",
    max_iter: int = 30,
    progress: Callable[[int, int], object] | None = None,
) -> TetMesh:
    """Improve the tetrahedra of a mesh: remove slivers.

    Parameters
    ----------
    mesh : Delaunay, TetMesh or tuple of two arrays
        A 3-D triangulation, or ``(points, simplices)`` with shapes (n, 3) and (m, 4): positively
        oriented tetrahedra that do not overlap.
    min_angle : float, optional
        The goal for the smallest dihedral angle of each tetrahedron, in degrees, from 0 to 70.528.
        Tetrahedra below the goal are processed, and so are those with a dihedral angle that is
        within half of it of 180 degrees.
    flips : bool, optional
        Whether to remove edges and faces (flips).
    smooth : bool, optional
        Whether to move interior vertices, and those that `boundary` lets move.
    exude : bool, optional
        Whether to start with sliver exudation: interior vertices get weights for which the
        tetrahedra around them in the regular triangulation are better.
    boundary : {"faces", "surface"}, optional
        What is preserved of the boundary: its triangles; or only the surface, so that exactly
        coplanar triangles may be flipped, and vertices inside flat facets and straight edges of
        the boundary and of regions move in them. With the triangles, all `input_faces` of a
        TetMesh are preserved, those inside included; with the surface, the result has none.
    tolerance : float, optional
        With ``boundary="surface"``, tetrahedra at the boundary that stay below the goal are removed
        if the boundary remains within this distance of where it was, in the unit of the points.
        The report has the number of such tetrahedra and a bound on the distance. They are also
        removed when `max_iter` is reached. By default 0:
        the mesh fills exactly the same space.
    region : array_like of int, shape (m,), optional
        A number for each tetrahedron. Faces between different numbers are preserved like the
        boundary. By default that of a TetMesh.
    fixed : array_like of bool, shape (n,), or of int, optional
        Points that must not move: a mask, or rows.
    max_points : int, optional
        Maximum number of added points, by default 0. Points are added inside regions, near
        tetrahedra below the goal that the other changes do not improve enough.
    contract : {"added", "all", "none"}, optional
        Which points inside regions may be removed, by contracting one of their edges, where that
        improves tetrahedra below the goal more than other changes do: those that were added to a
        TetMesh; all, so that rows of input points may be left without a tetrahedron; or none.
    max_iter : int, optional
        Maximum number of passes over the tetrahedra below the goal.
    progress : callable, optional
        Called after each pass with its number and the number of tetrahedra below the goal.

    Returns
    -------
    TetMesh
        The improved mesh, immutable: the same rows of input points, some of them moved, followed by
        added points, which `nadded` counts; and different tetrahedra that fill the same space, or
        with a tolerance nearly the same. Its
        ``report`` contains the angles before and after, the changes by kind, and the remaining
        tetrahedra below the goal, with causes.

    Raises
    ------
    InputError
        A tetrahedron is flat or negatively oriented; two are on one side of a face; tetrahedra
        overlap at an interior vertex; two used rows have the same coordinates; or an argument is
        invalid.
    ShapeError, DtypeError, NonFiniteError
        The arrays are not 3-D points and tetrahedra.
    KeyboardInterrupt
        Ctrl-C was pressed.

    Notes
    -----
    There are five kinds of changes: removing an edge, with the best triangulation of the ring
    around it (G. T. Klincsek 1980; J. R. Shewchuk 2002), with the 3-2, 4-4 and 2-2 flips as special
    cases; the inverse, removing the faces between two vertices, as in the 2-3 flip; moving a vertex
    to the position where the worst tetrahedron around it is best (L. A. Freitag and C.
    Ollivier-Gooch 1997); contracting an edge, which removes a point; and, with `max_points`,
    replacing the tetrahedra of a cavity by those that join a new vertex to its boundary (B. M.
    Klingner and J. R. Shewchuk 2007). Vertices are inserted near the worst tetrahedra first.
    Exudation (S.-W. Cheng et al. 2000) lets the star of a
    vertex grow with its weight, up to a fifth of the squared distance to the nearest vertex; on a
    Delaunay triangulation, and without the other kinds of changes, the result is the regular
    triangulation with the weights of the report. The quality is the smallest sine of the dihedral
    angles, doubled for obtuse angles, so that large angles become smaller too.

    Each change raises the worst quality of the tetrahedra that it affects, and does not lower the
    smallest angle among them; bounds on rounding errors prove this, and new tetrahedra are
    positively oriented by the exact predicate. So the smallest dihedral angle of a mesh never
    becomes smaller, and the iteration terminates, since no state repeats.

    Scaling all coordinates by a power of two changes nothing, as long as neither they nor those of
    the result are subnormal (below 2.3e-308): these have fewer bits, and less is improved.

    With ``boundary="surface"``, a boundary vertex moves only if all boundary triangles around it
    are exactly in one plane, or if it is exactly between two neighbors on an edge where planes
    meet, and only to positions that are exactly in the same planes. Planes and edges that are
    parallel to axes have such positions everywhere, others only with simple coordinates.

    A tetrahedron with one or two faces on the boundary can be removed within the tolerance. The
    removals add up: the bound on the distance at a vertex is the sum of the thicknesses of all
    tetrahedra removed there, so that the whole old boundary is within the tolerance of the new
    one and the other way round. No point loses its last tetrahedron.

    Points on a side that is not parallel to an axis are off its plane by rounding errors. The hull
    is exact, so some of these points lie just behind its facets. A tetrahedron on such a facet with
    a vertex deeper inside would contain them. Every triangulation of these points therefore has
    tetrahedra this thin. The report gives them the cause ``"rounding"``. A `tolerance` of a few
    times the rounding errors removes them.

    The result is independent of the order of rows. One thread is used. If the goal is reached, the
    time is about 10 microseconds per tetrahedron, and up to ten times that if points are dense next
    to large boundary triangles; each search for the place of a new point takes about 0.2
    milliseconds. Memory is linear.

    Neighbors are recomputed. Overlaps are only detected among tetrahedra around a common vertex.

    Examples
    --------
    Six points, four of which form a sliver, nearly a square:

    >>> import delone
    >>> points = [(0, 0, 0), (1, 0, 0.01), (1, 1, 0), (0, 1, 0.01), (0.5, 0.5, 1), (0.5, 0.5, -1)]
    >>> sliver = [(0, 1, 2, 3), (0, 1, 3, 4), (1, 2, 3, 4), (1, 0, 2, 5), (0, 3, 2, 5)]
    >>> better = delone.improve((points, sliver))
    >>> print(f"{better.report.smallest_before:.1f}, {better.report.smallest_after:.1f}")
    1.1, 50.5

    The same mesh with an added point instead of flips:

    >>> finer = delone.improve((points, sliver), flips=False, max_points=10)
    >>> finer.nadded, f"{finer.report.smallest_after:.1f}"
    (1, '50.5')
    """
    points, simplices, own = _given(mesh)
    labels = _labels(region, own, len(simplices))
    walled = isinstance(mesh, TetMesh) and len(mesh.input_faces) > 0 and boundary == "faces"
    kept = walls.Kept.of(simplices, mesh.neighbors, mesh.input_faces, labels) if walled else None
    held = improving.as_held(fixed, len(points))
    goal = improving.as_goal(min_angle)
    kinds = (
        as_flag(flips, name="flips"),
        as_flag(smooth, name="smooth"),
        as_flag(exude, name="exude"),
    )
    removable = _removable(mesh, as_choice(contract, CONTRACT, name="contract"), len(points))
    surface = as_choice(boundary, BOUNDARIES, name="boundary") == "surface"
    nearby = improving.as_tolerance(tolerance, boundary)
    passes = as_limit(max_iter, name="max_iter")
    most = min(as_limit(max_points, name="max_points"), _INDEX_MAX - len(points))
    as_callback(progress, name="progress")
    given = points, simplices, labels if kept is None else kept.labels
    added = len(points) - (mesh.nadded if isinstance(mesh, TetMesh) else 0)
    of_points = improving.Points(held, removable, added)
    made, judged, after = improving.improved(
        given,
        of_points,
        goal,
        kinds=kinds,
        surface=(surface, nearby),
        limits=(passes, most),
        progress=progress,
    )
    if kept is not None:
        of_faces: TetMesh = mesh_of(mesh, kept, made, judged, after)
        return of_faces
    arrays: dict[str, NDArray[Any]] = {
        "points": made.points,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "region": made.labels,
    }
    if isinstance(mesh, TetMesh):
        # The boundary is the same surface, or nearly, and leaves the same spaces empty.
        arrays["holes"] = mesh.holes
    better = TetMesh._of(arrays, judged, len(made.points) - added)
    better._cache["quality"] = after
    return better


def _removable(mesh: Any, contract: str, count: int) -> Bools:
    if contract == "all":
        return np.ones(count, dtype=bool)
    nadded = mesh.nadded if contract == "added" and isinstance(mesh, TetMesh) else 0
    return np.arange(count) >= count - nadded if nadded else np.empty(0, dtype=bool)


def _given(mesh: Any) -> tuple[Floats, Indices, Indices | None]:
    """Return points, tetrahedra and regions."""
    if isinstance(mesh, tuple | list):
        if len(mesh) != 2:
            raise ShapeError(f"mesh must be (points, simplices), got {len(mesh)} items")
        points = as_points(mesh[0], ndim=3)
        simplices = as_simplices(mesh[1], len(points), 3)
    else:
        corners = np.shape(getattr(mesh, "simplices", ()))[1:]
        if getattr(mesh, "ndim", None) != 3 or corners != (4,):
            raise DtypeError(
                "mesh must be a 3-D Delaunay, a TetMesh, or (points, simplices), "
                f"got {type(mesh).__name__}"
            )
        points, simplices = mesh.points, mesh.simplices
    if not len(simplices):
        raise InputError("mesh has no tetrahedra")
    require_finite(points)
    _require_positive(points, simplices)
    return points, simplices, mesh.region if isinstance(mesh, TetMesh) else None


def _require_positive(points: Floats, simplices: Indices) -> None:
    corners = (np.ascontiguousarray(points[simplices[:, k]]) for k in range(4))
    signs = _core.orient3d(*corners)
    for sign, what in ((-1, "negatively oriented: swap two vertices of each"), (0, "flat")):
        rows = np.flatnonzero(signs == sign)
        if len(rows):
            noun = counted(len(rows), "tetrahedron")
            verb = agreed(len(rows), "is", "are")
            raise InputError(f"{noun} {verb} {what}; first: {rows[0]}")


def _labels(region: ArrayLike | None, own: Indices | None, count: int) -> Indices:
    if region is None:
        return np.empty(0, dtype=np.int32) if own is None else own
    return as_labels(region, count, name="region")
