"""The class Delaunay: a Delaunay triangulation in 2 to 8 dimensions as immutable arrays.

The core computes `simplices` and `neighbors`; what follows from them is in `triangulation`. This
module contains construction and proof.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Never, Self, TypedDict, Unpack

from delone import _core
from delone._base.arrays import as_choice, as_workers
from delone._base.counting import counted
from delone._base.georeference import warn_of_degrees
from delone._base.immutable import own_copy
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.flats import Flat, advised, flat_of
from delone._tiling.higher.size import require_room
from delone._tiling.higher.thin import warn_of_rounding
from delone._tiling.space.plane import plane_of
from delone._tiling.triangulation import PointTriangulation
from delone.errors import DegenerateInputError, DtypeError, InputError, InternalError
from delone.validation import HigherReport, judged

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Indices
    from delone.validation import ValidationReport

__all__ = ["Delaunay"]

# From 3-D on, there is one method; both names select it.
_METHODS = _core.methods2(), ["auto", "bowyer-watson"]
# Arguments of scipy.spatial.Delaunay that have no meaning here, and those of other classes.
_INSTEAD = {
    "furthest_site": "use delone.compat.scipy.Delaunay",
    "incremental": "use delone.Dynamic(points), or delone.compat.scipy.Delaunay",
    "qhull_options": "leave it out, or use delone.compat.scipy.Delaunay",
    "periodic": "use delone.PeriodicDelaunay(points, periods)",
    "periods": "use delone.PeriodicDelaunay(points, periods)",
    "segments": "use delone.ConstrainedDelaunay(points, segments)",
    "weights": "use delone.RegularTriangulation(points, weights)",
}
# From this many coordinates on, `flat` and `max_bytes` are available.
_MANY = 4
_FLAT_ELSEWHERE = (
    'flat="project" is only available from 4-D on: leave it out; for 3-D points in one plane, '
    "use `error.plane` of the DegenerateInputError"
)
# Fewer points are never shared among threads.
_FEW = 1000


class _Elsewhere(TypedDict, total=False):
    furthest_site: Never
    incremental: Never
    qhull_options: Never
    periodic: Never
    periods: Never
    segments: Never
    weights: Never


class Delaunay(PointTriangulation):
    """The Delaunay triangulation of points with two to eight coordinates.

    Parameters
    ----------
    points : array_like, shape (n, d), or PointSet
        Finite coordinates, in any unit: floats of up to 64 bits, integers up to 2**53. They are
        copied, and results are exact for them. There are as many dimensions as columns, from two to
        eight: for a surface with heights, pass only the first two columns.
    method : str, optional
        The algorithm: ``"auto"`` (the fastest, the default), ``"bowyer-watson"`` (cavity insertion
        along a space-filling curve), ``"divide-and-conquer"`` (merging halves), ``"incremental"``
        (randomized insertion and flips), ``"sweep"`` (a sweep line) or ``"lifting"`` (the convex
        hull of the points lifted to a paraboloid). The triangles do not depend on it. In more
        dimensions the choices are ``"auto"`` and ``"bowyer-watson"``.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it. From
        4-D on, the simplices are found on one thread.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane; otherwise points known to be in
        degrees (from a reference system or column names) cause a warning.
    max_bytes : int, optional
        From 4-D on: the maximum memory of the triangulation; by default the free memory. If samples
        predict more, `TooLargeError` is raised before the computation. See Notes.
    flat : {"raise", "project"}, optional
        From 4-D on, what to do with points that all lie in a flat of k < d dimensions: raise
        DegenerateInputError (the default), or triangulate them in the flat. `simplices` then have
        k + 1 corners, and are Delaunay by the distances in the flat. See Notes.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (m, d + 1)
        The simplices as rows of `points`: triangles, counter-clockwise, or simplices of more
        corners, positively oriented: the determinant of the vectors from the first corner to the
        others is positive. (In 3-D, seen from the first, the other three turn clockwise.)
    neighbors : ndarray of int32, shape (m, d + 1)
        ``neighbors[t, k]`` is the simplex across the edge or face opposite vertex k of simplex t;
        -1 outside.
    ndim : int
        The number of coordinates.
    npoints, nsimplex : int
        Numbers of points (rows, including duplicates) and of simplices.
    min_bound, max_bound : ndarray of float64, shape (d,)
        The smallest and the largest coordinate along each axis.

    Raises
    ------
    DegenerateInputError
        Fewer than d + 1 points are distinct, or all lie on one line; ``error.chain`` lists them in
        order. Or 3-D points all lie in one plane; ``error.plane`` is its triangulation. Or points
        with more coordinates all lie in a flat of fewer dimensions; ``error.chain`` lists rows that
        span it, one more than its dimension.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` lists the first such rows.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, d), with d from 2 to 8.
    InputError
        `method` or `workers` is not one of its choices.
    LimitError
        There are more than 2**28 points in 2-D or 2**27 in 3-D, more than 2**30 tetrahedra, or more
        than 2**28 simplices in higher dimensions. `delone.distributed` has no such limit in 2-D.
    TooLargeError
        From 4-D on: the simplices would not fit into memory, or `max_bytes`; it is a MemoryError.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. No partial result remains.

    Warns
    -----
    GeographicWarning
        The points are known to be longitudes and latitudes; see `planar`.
    NearlyFlatWarning
        From 4-D on: the points lie in a flat except for rounding errors.

    Notes
    -----
    The result is exact for the given doubles, whatever their range. Each distinct point is a
    vertex, including those in the middle of a side of the convex hull; of rows with the same
    coordinates (-0.0 and 0.0 are the same) the first is the vertex. If more than three points lie
    on one empty circle, their polygon is fanned from its lexicographically smallest vertex, so a
    set of points has one triangulation, independent of the order of its rows. In more dimensions,
    the same perturbation decides ties between points on one sphere, and no simplex is flat: a grid,
    even with uneven steps, gets the d! simplices of Kuhn's triangulation in each cell.

    The number of simplices grows fast with the number of dimensions: uniform points have 2
    triangles each, 6.8 tetrahedra, and about 30, 150 and 600 simplices in 4-D, 5-D and 6-D, and
    3,700 in 8-D. From 4-D on there are no pictures, exports or measures of shape. If uniform points
    would take more than an eighth of the memory, samples of up to half of the points are
    triangulated first, in a few seconds, and their sizes extrapolated. The prediction may be off
    by a factor of two. `delone.estimate` predicts any triangulation more precisely.

    In a flat (``flat="project"``), the first k coordinates that determine the others decide
    orientation and location: `simplices` are positively oriented in these, and queries are
    projected to the flat along the other axes. `volumes` and `circumcenters` are those in the flat,
    up to rounding, and `transform` is not available.

    Names, dtypes and meanings are those of ``scipy.spatial.Delaunay``. All arrays are read-only,
    attributes cannot be set, and ``copy.copy`` and ``copy.deepcopy`` return the object itself.
    Attributes that are not listed above are computed on first use and kept.

    Time is O(n log n) with a small constant; most of the work is linear. ``"auto"`` selects cavity
    insertion along a Hilbert curve, in blocks of a k-d tree that are merged: on scattered points it
    was the fastest method measured. Blocks of lattices use divide and conquer, which is faster for
    them. So do blocks whose triangles are so thin that insertion exceeds its work budget, as on two
    lines that nearly coincide.

    ========================  =========================================  =======================
    `method`                  paper                                      time
    ========================  =========================================  =======================
    ``"bowyer-watson"``       Bowyer; Watson (both 1981)                 O(n log n), by a budget
    ``"divide-and-conquer"``  Guibas and Stolfi (1985); Dwyer (1987)     O(n log n)
    ``"incremental"``         Lawson (1977); Guibas, Knuth and Sharir    O(n log n) expected
                              (1992)
    ``"sweep"``               Fortune (1987)                             O(n log n)
    ``"lifting"``             Brown (1979); Clarkson and Shor (1989)     O(n log n) expected,
                                                                         O(n log² n) where
                                                                         degrees are high
    ========================  =========================================  =======================

    The first two use all `workers`; the others find the triangles on one thread.

    Examples
    --------
    >>> from delone import Delaunay
    >>> mesh = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    >>> mesh
    <Delaunay of 5 points: 4 triangles>
    >>> mesh.simplices.shape, len(mesh.edges), mesh.areas.sum()
    ((4, 3), 8, np.float64(12.0))
    >>> bool(mesh.validate())
    True

    The corners of a cube and its center:

    >>> cube = Delaunay([(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)] + [(1, 1, 1)])
    >>> cube
    <Delaunay of 9 points: 12 tetrahedra>
    >>> cube.volumes.sum(), cube.convex_hull.shape
    (np.float64(8.0), (12, 3))

    A table with four columns:

    >>> import numpy as np
    >>> table = Delaunay(np.stack(np.meshgrid(*4 * [range(3)]), axis=-1).reshape(-1, 4))
    >>> table
    <Delaunay of 81 points: 384 simplices>
    >>> int(table.find_simplex((0.5, 0.25, 1.75, 1))) >= 0
    True
    """

    __slots__ = ()

    def __init__(
        self,
        points: ArrayLike,
        *,
        method: str = "auto",
        workers: int | None = None,
        planar: bool = False,
        max_bytes: int | None = None,
        flat: str = "raise",
        **unknown: Unpack[_Elsewhere],
    ) -> None:
        if unknown:
            _refuse_options(unknown)
        stays = as_choice(flat, ("raise", "project"), name="flat") == "project"
        # Three points span a plane, however many coordinates they have.
        own = own_copy(points, ndim=None, most=MOST, few=stays)
        warn_of_degrees(points, own, planar=planar)
        # Few points are one task, and counting cores takes as long as some triangulations.
        threads = 1 if workers is None and len(own) < _FEW else as_workers(workers)
        _require_room(own, max_bytes)
        if stays and own.shape[1] < _MANY:
            raise InputError(_FLAT_ELSEWHERE)
        methods = _METHODS[own.shape[1] > 2]
        if not isinstance(method, str) or method not in methods:
            names = ", ".join(map(repr, methods))
            where = "" if own.shape[1] == 2 else f" in {own.shape[1]}-D"
            raise InputError(f"method must be one of {names}{where}, got {method!r:.80}")
        try:
            arrays, stages = _triangles(own, method, threads, stays=stays)
        except InternalError as error:
            error.points = own
            raise
        if _MANY <= own.shape[1] < arrays["simplices"].shape[1]:
            warn_of_rounding(own)
        self._fill({"points": own} | arrays, stages, workers)
        self._refer(points)

    def _saved(self) -> dict[str, NDArray[Any]]:
        # In a flat, the triangulation is recomputed.
        return {"points": self._points} if self._is_flat else super()._saved()

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        if "simplices" in arrays:
            return super()._loaded(arrays)
        return cls(arrays["points"], flat="project", planar=True)

    @property
    def _sites(self) -> tuple[Any, Indices | None]:
        return self._locator, None

    def validate(self) -> ValidationReport:
        """Prove that this is the canonical Delaunay triangulation, or list the faults.

        Returns
        -------
        ValidationReport
            Truthy if there are no faults: simplices are positively oriented and tile the exact
            hull, neighbors are mutual, each distinct point is a vertex, each edge or face is
            locally Delaunay, and ties are broken canonically.

        Notes
        -----
        The proof is exact and takes about as long as the triangulation.

        Examples
        --------
        >>> from delone import Delaunay
        >>> print(Delaunay([(0, 0), (1, 0), (0, 1)]).validate())
        a canonical Delaunay triangulation
        """
        if self._is_flat:
            faults = Flat(self._points, self._simplices[0]).faults
            return HigherReport._of(faults(self._simplices, self._neighbors))
        return judged(self._points, self._simplices, self._neighbors)

    def _described(self) -> str:
        points = counted(self.npoints, "point")
        if duplicates := len(self._duplicates):
            points += f" ({counted(duplicates, 'duplicate')})"
        return f"{points}: {counted(self.nsimplex, self._dimension.simplex)}"


def _refuse_options(unknown: Mapping[str, Any]) -> None:
    """Reject unknown arguments; for those of SciPy and of other classes, name the class."""
    for name in unknown:
        if name in _INSTEAD:
            raise DtypeError(f"delone.Delaunay does not accept {name}: {_INSTEAD[name]}")
        raise TypeError(f"Delaunay() got an unexpected keyword argument {name!r:.80}")


def _require_room(points: NDArray[np.float64], max_bytes: int | None) -> None:
    if points.shape[1] > 3:
        require_room(points, max_bytes)
    elif max_bytes is not None:
        raise InputError("max_bytes is only available from 4-D on, where simplices are many")


def _triangles(
    points: NDArray[np.float64], method: str, workers: int, *, stays: bool
) -> tuple[dict[str, NDArray[Any]], Any]:
    """Return the arrays of the triangulation and the seconds of its stages.

    With `stays`, points may lie in a flat, and the triangulation stays in it.
    """
    try:
        if points.shape[1] == 2:
            made = _core.triangulate2(points, method, workers)
        elif points.shape[1] > 3:
            made = _core.triangulate_n(points)
        else:
            made = _in_space(points, workers)
    except DegenerateInputError as error:
        if points.shape[1] < _MANY:
            raise
        if not stays:
            raise advised(error) from None
        made = flat_of(points, error).triangulated()
    arrays = {
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "duplicates": made.duplicates,
    }
    return arrays, made.stages


def _in_space(points: NDArray[np.float64], workers: int) -> _core.Triangulation:
    """Return the triangulation of 3-D points, as the core returns it."""
    try:
        return _core.triangulate3(points, workers)
    except DegenerateInputError as error:
        if error.reason == "coplanar" or len(error.chain) == 3:
            error.plane = plane_of(points, workers)
        raise
