"""The class RegularTriangulation: triangulations of weighted points, dual to power diagrams.

Sites are lifted by their weights, and the core takes the lower side of their hull. What follows
from triangles or tetrahedra is in `triangulation` and `space`, as for all such classes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._arrays import as_plain_array, as_vectors
from delone.counting import agreed, counted
from delone.errors import DegenerateInputError, InternalError, NonFiniteError, ShapeError
from delone.georeference import warn_of_degrees
from delone.immutable import kept, own_copy, sealed
from delone.space.plane import plane_of, twins
from delone.space.spatial import Spatial

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["RegularTriangulation", "as_weights", "triangulated"]

_SPACE = 3


class RegularTriangulation(Spatial):
    """The regular (weighted Delaunay) triangulation of points in the plane or in space.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
        Finite coordinates, taken as the exact numbers which they denote.
    weights : array_like, shape (n,)
        Finite weights, in the square of the unit of the points: the square of a radius, if points
        are thought of as circles. Adding one number to all of them changes nothing.
    planar : bool, optional
        As for `Delaunay`: longitudes and latitudes are meant as coordinates of a plane.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    weights : ndarray of float64, shape (n,)
        The weights.
    simplices : ndarray of int32, shape (m, d + 1)
        The triangles, counter-clockwise, or tetrahedra, positively oriented, as rows of `points`.
    neighbors : ndarray of int32, shape (m, d + 1)
        The simplex opposite each vertex; -1 outside.

    Raises
    ------
    DegenerateInputError
        Fewer than d + 1 points are distinct, or all lie on one line; ``error.chain`` has those in
        the plane that are not hidden, in order, in space all. Or points in space lie in one plane;
        ``error.plane`` is its regular triangulation.
    NonFiniteError
        A coordinate or weight is NaN or infinite; ``error.rows`` tells where.
    ShapeError
        There are not as many weights as points.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. Nothing is left behind.

    Notes
    -----
    The simplices are the lower side of the hull of the points lifted to ``x**2 + y**2 - w``, in
    space to ``x**2 + y**2 + z**2 - w``. A point whose lift lies above it is *hidden*: no place has
    its least power there, and it is no vertex. With equal weights this is the Delaunay
    triangulation.

    The answer is exact, and unique: ties are broken as in `delone.Delaunay`, so that a point whose
    lift lies on the hull without being a corner of it is hidden. Of points with the same
    coordinates the heaviest counts, the others are hidden; of equally heavy ones the first row is
    the vertex, and the others are its duplicates.

    The method is insertion by cavities along a Hilbert curve (Bowyer; Watson, both 1981), in
    O(n log n) on usual inputs, on one thread.

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

    _weights: Floats

    def __init__(self, points: ArrayLike, weights: ArrayLike, *, planar: bool = False) -> None:
        if hasattr(self, "_points"):
            raise AttributeError("a RegularTriangulation never changes: make another one")
        own = own_copy(points, ndim=None)
        warn_of_degrees(points, own, planar=planar)
        own_weights = as_weights(weights, len(own))
        arrays, chain = triangulated(own, own_weights)
        if not len(arrays["simplices"]):
            raise _degenerate(own, chain)
        self._fill(arrays, {}, None)

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

    def _arrays(self) -> dict[str, NDArray[Any]]:
        names = ("points", "weights", "simplices", "neighbors", "duplicates")
        return {name: getattr(self, f"_{name}") for name in names}

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):  # the constructor failed, or has not run
            return "<RegularTriangulation of nothing yet>"
        points = counted(self.npoints, "point")
        notes = []
        if duplicates := len(self._duplicates):
            notes.append(counted(duplicates, "duplicate"))
        if hidden := len(self.hidden):
            notes.append(f"{hidden} hidden")
        noted = f" ({', '.join(notes)})" if notes else ""
        simplex = "tetrahedron" if self.ndim == _SPACE else "triangle"
        return f"<RegularTriangulation of {points}{noted}: {counted(self.nsimplex, simplex)}>"


def as_weights(weights: ArrayLike, npoints: int) -> Floats:
    """Return weights that no one else can change, one for each point.

    Parameters
    ----------
    weights : array_like, shape (npoints,)
        Finite numbers.
    npoints : int
        Number of points.

    Returns
    -------
    ndarray of float64, shape (npoints,)
        A copy.

    Raises
    ------
    ShapeError
        There are more or fewer.
    NonFiniteError
        One is NaN or infinite.
    """
    shape = as_plain_array(weights, "weights").shape
    if shape != (npoints,):
        raise ShapeError(f"weights must have shape ({npoints},), one for each point, got {shape}")
    found = as_vectors(weights, npoints, name="weights").copy() if npoints else np.empty(0)
    bad = np.flatnonzero(~np.isfinite(found))
    if len(bad):
        raise NonFiniteError(
            f"{len(bad)} {agreed(len(bad), 'weight is', 'weights are')} NaN or infinite; "
            f"first: {bad[0]}",
            rows=bad[:10],
            count=len(bad),
        )
    return found


def triangulated(points: Floats, weights: Floats) -> tuple[dict[str, NDArray[Any]], Indices]:
    """Return the arrays of a regular triangulation, also where it has no triangle.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2) or (n, 3)
        Coordinates.
    weights : ndarray of float64, shape (n,)
        Finite weights.

    Returns
    -------
    arrays : dict of ndarray
        What a `RegularTriangulation` holds.
    chain : ndarray of int32
        Where all points of the plane lie on one line, those that are not hidden, in order.

    Raises
    ------
    DegenerateInputError
        Points in space lie in one plane; ``error.plane`` has its triangulation.
    """
    try:
        regular = _core.regular3 if points.shape[1] == _SPACE else _core.regular2
        made = regular(points, weights)
    except InternalError as error:
        error.points = np.column_stack((points, weights))
        raise
    except DegenerateInputError as error:
        if error.reason == "coplanar" or len(error.chain) == 3:
            error.plane = plane_of(points, weights=weights)
        raise
    arrays: dict[str, NDArray[Any]] = {
        "points": points,
        "weights": weights,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "duplicates": twins(made.stands_for, weights),
    }
    return arrays, made.chain


def _degenerate(points: Floats, chain: Indices) -> DegenerateInputError:
    distinct = len(np.unique(points + 0.0, axis=0))
    reason = "too few points" if distinct < 3 else "collinear"
    return DegenerateInputError(
        f"the {counted(distinct, 'distinct point')} span no triangle; `chain` has those that are "
        f"not hidden, in order",
        reason=reason,
        chain=chain,
    )
