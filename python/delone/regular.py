"""The class RegularTriangulation: triangulations of weighted points, dual to power diagrams.

The core computes the lower convex hull of the sites, lifted by their weights. Properties that
follow from the simplices are in `triangulation`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, as_vectors, as_workers
from delone._base.counting import agreed, counted
from delone._base.georeference import warn_of_degrees
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.size import require_room
from delone._tiling.higher.thin import warn_of_rounding
from delone._tiling.space.plane import plane_of, repeated_rows
from delone._tiling.triangulation import PointTriangulation
from delone.errors import DegenerateInputError, InternalError, NonFiniteError, ShapeError
from delone.regular_validation import validate_regular

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.regular_validation import RegularHigherReport, RegularReport, RegularSpaceReport

__all__ = ["RegularTriangulation"]

_SPACE = 3


class RegularTriangulation(PointTriangulation):
    """The regular (weighted Delaunay) triangulation of points with two to eight coordinates.

    Parameters
    ----------
    points : array_like, shape (n, d)
        Finite coordinates, two to eight for each point. Results are exact for the given doubles.
    weights : array_like, shape (n,)
        Finite weights, in squared units of the points: squared radii, if points represent circles
        or spheres. Adding a constant to all weights does not change the result.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    weights : ndarray of float64, shape (n,)
        The weights.
    simplices : ndarray of int32, shape (m, d + 1)
        The triangles, counter-clockwise, or the tetrahedra or simplices, positively oriented, as
        rows of `points`.
    neighbors : ndarray of int32, shape (m, d + 1)
        The simplex opposite each vertex; -1 outside.

    Raises
    ------
    DegenerateInputError
        Fewer than d + 1 points are distinct, or all points lie in a flat of lower dimension. On a
        line, ``error.chain`` lists them in order, in 2-D without the hidden ones. If 3-D points lie
        in one plane, ``error.plane`` is their regular triangulation.
    NonFiniteError
        A coordinate or weight is NaN or infinite; ``error.rows`` lists the first such rows.
    ShapeError
        The number of weights differs from the number of points.
    InputError
        `workers` is not a positive integer.
    TooLargeError
        From 4-D on: the triangulation would not fit into the free memory.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. No partial result remains.

    Warns
    -----
    NearlyFlatWarning
        From 4-D on: the points lie in a flat except for rounding errors.

    Notes
    -----
    The simplices are the projection of the lower convex hull of the points, each lifted to its
    squared distance from the origin minus its weight: in 2-D, to ``x**2 + y**2 - w``. A point whose
    lift lies above the hull is *hidden*: its power is not the smallest anywhere, so it is not a
    vertex. With equal weights, the result is the Delaunay triangulation.

    The result is exact and unique. Ties are broken as in `delone.Delaunay`, so a point whose lift
    lies on the hull but is not a corner of it is hidden. If points have the same coordinates, the
    one with the largest weight is used, and the others are hidden. If their weights are also equal,
    the first row is the vertex, and the others are its duplicates.

    The method is cavity insertion along a Hilbert curve (Bowyer; Watson, both 1981). It takes
    O(n log n) time on typical inputs.

    References
    ----------
    F. Aurenhammer, "Power diagrams: properties, algorithms and applications", SIAM Journal on
    Computing 16 (1987).

    Examples
    --------
    >>> from delone import RegularTriangulation
    >>> points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]
    >>> RegularTriangulation(points, [0, 0, 0, 0, 0])
    <RegularTriangulation of 5 points: 4 triangles>
    >>> light = RegularTriangulation(points, [0, 0, 0, 0, -8])
    >>> light
    <RegularTriangulation of 5 points (1 hidden): 2 triangles>
    >>> light.hidden
    array([4], dtype=int32)
    """

    __slots__ = ("_weights",)

    _ARRAYS = ("points", "weights", "simplices", "neighbors", "duplicates")

    _weights: Floats

    def __init__(
        self,
        points: ArrayLike,
        weights: ArrayLike,
        *,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        own = own_copy(points, ndim=None, most=MOST)
        warn_of_degrees(points, own, planar=planar)
        own_weights = as_weights(weights, len(own))
        if workers is not None:
            as_workers(workers)
        if own.shape[1] > _SPACE:
            require_room(own, None, limited=False)
        arrays, chain = triangulated(own, own_weights, workers)
        if not len(arrays["simplices"]):
            raise _degenerate(own, chain)
        if own.shape[1] > _SPACE:
            warn_of_rounding(own)
        self._fill(arrays, {}, workers)
        self._refer(points)

    @property
    def weights(self) -> Floats:
        """The weights, (n,)."""
        return self._weights

    @property
    @kept
    def hidden(self) -> Indices:
        """The rows that are neither vertices nor duplicates of vertices, ascending."""
        seen = np.zeros(self.npoints, dtype=bool)
        seen[self._simplices] = True
        return sealed(np.flatnonzero(~seen[self.duplicate_of]).astype(np.int32))

    def validate(self) -> RegularReport | RegularSpaceReport | RegularHigherReport:
        """Prove that this is the canonical regular triangulation, or list the faults.

        Returns
        -------
        RegularReport, in 3-D RegularSpaceReport, in more dimensions RegularHigherReport
            Truthy if there are no faults: simplices are positively oriented and tile the exact
            hull, neighbors are mutual, each edge or face is locally regular, ties are broken
            canonically, each vertex is the first of the heaviest rows with its coordinates,
            duplicates are listed, and each hidden point is above the simplex that contains it.

        Notes
        -----
        The proof is exact. It sorts the points, and takes linear time in the number of simplices,
        with a short walk to each hidden point.

        Examples
        --------
        >>> from delone import RegularTriangulation
        >>> mesh = RegularTriangulation([(0, 0), (4, 0), (0, 4), (1, 1)], [0, 0, 0, -9])
        >>> print(mesh.validate())
        a canonical regular triangulation
        """
        return validate_regular(
            self._points, self._weights, self._simplices, self._neighbors, self._duplicates
        )

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {"points": self._points, "weights": self._weights}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls(arrays["points"], arrays["weights"], planar=True)

    def _described(self) -> str:
        notes = []
        if duplicates := len(self._duplicates):
            notes.append(counted(duplicates, "duplicate"))
        if hidden := len(self.hidden):
            notes.append(f"{hidden} hidden")
        noted = f" ({', '.join(notes)})" if notes else ""
        simplices = counted(self.nsimplex, self._dimension.simplex)
        return f"{counted(self.npoints, 'point')}{noted}: {simplices}"


def as_weights(weights: ArrayLike, npoints: int) -> Floats:
    """Return a copy of finite weights, one for each point, that cannot be changed from outside."""
    shape = as_plain_array(weights, "weights").shape
    if shape != (npoints,):
        raise ShapeError(f"weights must have shape ({npoints},), one for each point, got {shape}")
    found = as_vectors(weights, npoints, name="weights").copy() if npoints else np.empty(0)
    bad = np.flatnonzero(~np.isfinite(found))
    if len(bad):
        raise NonFiniteError(
            f"{len(bad)} {agreed(len(bad), 'weight is', 'weights are')} NaN or infinite; "
            f"first: row {bad[0]}",
            rows=bad[:10],
            count=len(bad),
        )
    return found


def triangulated(
    points: Floats, weights: Floats, workers: int | None
) -> tuple[dict[str, NDArray[Any]], Indices]:
    """Return the arrays of a `RegularTriangulation`, even without triangles, and the chain.

    If all 2-D points lie on one line, the chain lists those that are not hidden, in order. The
    error for coplanar 3-D points contains their triangulation as ``error.plane``.
    """
    threads = as_workers(workers)
    try:
        made = _core.regular(points, weights, threads)
    except InternalError as error:
        error.points = np.column_stack((points, weights))
        raise
    except DegenerateInputError as error:
        if points.shape[1] == _SPACE and (error.reason == "coplanar" or len(error.chain) == 3):
            error.plane = plane_of(points, threads, weights)
        raise
    arrays: dict[str, NDArray[Any]] = {
        "points": points,
        "weights": weights,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "duplicates": repeated_rows(made.stands_for, weights),
    }
    return arrays, made.chain


def _degenerate(points: Floats, chain: Indices) -> DegenerateInputError:
    distinct = len(np.unique(points + 0.0, axis=0))
    reason = "too few points" if distinct < 3 else "collinear"
    return DegenerateInputError(
        f"the {counted(distinct, 'distinct point')} span no triangle; `error.chain` lists those "
        f"that are not hidden, in order",
        reason=reason,
        chain=chain,
    )
