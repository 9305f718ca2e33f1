"""The class Delaunay: a triangulation of points in the plane as immutable arrays.

The core makes `simplices` and `neighbors`; everything else here follows from them on first use
(`topology` without coordinates, `geometry` with them) and is kept. Objects never change after the
constructor, so any number of threads may use one.
"""

from __future__ import annotations

import functools
import threading
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

import numpy as np

from delone import _core, geometry, topology
from delone._arrays import as_points, as_vectors, as_workers
from delone.errors import InputError, InternalError
from delone.validation import ValidationReport

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Delaunay"]

T = TypeVar("T")


def _kept(compute: Callable[[Delaunay], T]) -> Callable[[Delaunay], T]:
    """Compute once for each object, also where several threads ask at the same time."""
    name = compute.__name__

    @functools.wraps(compute)
    def get(self: Delaunay) -> T:
        cache = self._cache
        if name not in cache:
            with self._lock:
                if name not in cache:
                    cache[name] = compute(self)
        value: T = cache[name]
        return value

    return get


def _sealed(array: NDArray[Any]) -> NDArray[Any]:
    """Return an array over memory of ours that neither it nor its base can make writeable."""
    # The owner of memory may always ask for writing again, and a view leads to it by its base; the
    # base of this array is a memoryview, which cannot.
    array.flags.writeable = False
    return np.asarray(array.data)


class Delaunay:
    """The Delaunay triangulation of points in the plane.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates, in any unit: floats of up to 64 bits, integers up to 2**53. They are
        copied and taken as the exact numbers which they denote.
    method : str, optional
        How to compute it: ``"auto"`` (what is fastest), ``"bowyer-watson"`` (cavities, along a
        space-filling curve), ``"divide-and-conquer"`` (halves, merged), ``"incremental"``
        (randomised insertion and flips), ``"sweep"`` (a line over the plane) or ``"lifting"`` (the
        convex hull of points lifted to a paraboloid). The triangles are the same.
    workers : int, optional
        How many threads may work; by default one for each core. The answer is the same.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The coordinates.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        outside.
    ndim : int
        The number of coordinates, 2.
    npoints, nsimplex : int
        Numbers of points (rows, duplicates included) and of triangles.
    min_bound, max_bound : ndarray of float64, shape (2,)
        The least and the greatest coordinates.

    Raises
    ------
    DegenerateInputError
        Fewer than three points are distinct, or all lie on one line; ``error.chain`` has them in
        order.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` tells where.
    ShapeError, DtypeError
        `points` is no array of real points in the plane.
    InputError
        `method` or `workers` is none of its choices.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. Nothing is left behind.

    Notes
    -----
    The answer is exact: it is that of the real numbers, whatever their range. Each distinct point
    is a vertex, those in the middle of a side of the convex hull included; of rows with the same
    coordinates (-0.0 and 0.0 are the same) the first is the vertex. Where more than three points
    lie on one circle and none inside, their polygon is fanned from its lexicographically smallest
    vertex, so that one set of points has one triangulation, however its rows are ordered.

    Names, dtypes and meanings are those of ``scipy.spatial.Delaunay``. All arrays are read-only,
    attributes cannot be set, and ``copy.copy`` and ``copy.deepcopy`` return the object itself.
    Whatever is not listed above is computed on first use and kept.

    Time is O(n log n) with a small constant, most of it linear. ``"auto"`` picks cavity insertion
    along a Hilbert curve, in blocks of a k-d tree that are merged: it was the fastest wherever it
    was measured. A block whose triangles are so thin that insertion exceeds its budget of work, as
    on two lines that nearly coincide, goes to divide and conquer.

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

    The first two work with all `workers`; the others find their triangles on one thread.

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
    """

    __slots__ = (
        "__weakref__",
        "_cache",
        "_duplicates",
        "_lock",
        "_neighbors",
        "_points",
        "_simplices",
        "_stages",
        "_workers",
    )

    _cache: dict[str, Any]
    _duplicates: Indices
    _lock: threading.RLock
    _neighbors: Indices
    _points: Floats
    _simplices: Indices
    _stages: dict[str, float]
    _workers: int | None

    def __init__(
        self, points: ArrayLike, *, method: str = "auto", workers: int | None = None
    ) -> None:
        if hasattr(self, "_points"):
            raise AttributeError("a Delaunay never changes: make another one")
        methods = _core.methods2()
        if method not in methods:
            names = ", ".join(map(repr, methods))
            raise InputError(f"method must be one of {names}, got {method!r}")
        threads = as_workers(workers)
        own = _own_copy(points)
        try:
            simplices, neighbors, duplicates, stages = _core.triangulate2(own, method, threads)
        except InternalError as error:
            error.points = own
            raise
        arrays: dict[str, NDArray[Any]] = {
            "points": own,
            "simplices": simplices,
            "neighbors": neighbors,
            "duplicates": duplicates,
        }
        self._fill(arrays, dict(stages), workers)

    def _fill(
        self, arrays: dict[str, NDArray[Any]], stages: dict[str, float], workers: int | None
    ) -> None:
        """Set everything there is; afterwards nothing can be set."""
        values = {
            "_cache": {},
            "_lock": threading.RLock(),
            "_stages": stages,
            "_workers": workers,
        }
        values |= {f"_{name}": _sealed(array) for name, array in arrays.items()}
        for name, value in values.items():
            object.__setattr__(self, name, value)

    @property
    def points(self) -> Floats:
        """The coordinates, (n, 2)."""
        return self._points

    @property
    def simplices(self) -> Indices:
        """The triangles as rows of `points`, (m, 3), counter-clockwise."""
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The triangle opposite each vertex, (m, 3); -1 outside."""
        return self._neighbors

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2."""
        return 2

    @property
    def npoints(self) -> int:
        """Number of points, duplicates included."""
        return len(self._points)

    @property
    def nsimplex(self) -> int:
        """Number of triangles."""
        return len(self._simplices)

    @property
    def stages(self) -> dict[str, float]:
        """Seconds of each part of the construction; empty after loading from a file."""
        return dict(self._stages)

    @property
    @_kept
    def min_bound(self) -> Floats:
        """The least coordinates, (2,)."""
        return _sealed(self._points.min(axis=0))

    @property
    @_kept
    def max_bound(self) -> Floats:
        """The greatest coordinates, (2,)."""
        return _sealed(self._points.max(axis=0))

    @property
    @_kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        return _sealed(topology.edges(self._simplices, self._neighbors, self.npoints))

    @property
    @_kept
    def convex_hull(self) -> Indices:
        """The edges of the convex hull, (h, 2), each with the triangulation to its left.

        Their order is that of the triangles; `hull` has the vertices in order.
        """
        return _sealed(topology.boundary_edges(self._simplices, self._neighbors))

    @property
    @_kept
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull, (h,), counter-clockwise, collinear ones included.

        The first is the lexicographically smallest point.
        """
        rows = self.convex_hull[:, 0]
        x, y = self._points[rows].T
        start = int(rows[np.lexsort((y, x))[0]])
        return _sealed(topology.boundary_next(self.convex_hull, start))

    @property
    @_kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates."""
        first = np.arange(self.npoints, dtype=np.int32)
        first[self._duplicates[:, 0]] = self._duplicates[:, 1]
        return _sealed(first)

    @property
    @_kept
    def vertex_to_simplex(self) -> Indices:
        """A triangle of each point, (n,): the first one that has it or its duplicate as vertex."""
        first = topology.vertex_to_simplex(self._simplices, self.npoints)
        return _sealed(first[self.duplicate_of])

    @property
    @_kept
    def coplanar(self) -> Indices:
        """The rows that are no vertices, (k, 3): row, a triangle of its vertex, its vertex.

        These are the duplicates; no other point is ever left out.
        """
        row, first = self._duplicates.T
        return _sealed(np.column_stack((row, self.vertex_to_simplex[first], first)))

    @property
    @_kept
    def vertex_neighbor_vertices(self) -> tuple[Indices, Indices]:
        """Neighbours of vertices as compressed rows (indptr, indices).

        Those of vertex v are ``indices[indptr[v]:indptr[v + 1]]``, ascending. A duplicate has none.
        """
        indptr, indices = topology.vertex_neighbor_vertices(self.edges, self.npoints)
        return _sealed(indptr), _sealed(indices)

    @property
    @_kept
    def transform(self) -> Floats:
        """Affine maps to barycentric coordinates, (m, 3, 2).

        With ``inverse, r = transform[t, :2], transform[t, 2]``, where r is the last vertex of
        triangle t, ``c = inverse @ (x - r)`` are the first two barycentric coordinates of x, and
        ``1 - c.sum()`` is the third. No triangle is flat, so no row is NaN, however thin the
        triangle; entries have a relative error below 1e-13. What exceeds the range of doubles is
        infinite.
        """
        return _sealed(geometry.transform(self._points, self._simplices))

    @property
    @_kept
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points.

        All positive, with a relative error below 1e-13, except beyond the range of doubles.
        """
        return _sealed(geometry.areas(self._points, self._simplices))

    @property
    @_kept
    def circumcenters(self) -> Floats:
        """Centres of the circles through the corners of triangles, (m, 2).

        With an error below 1e-13 of the radius, and the rounding of the result. Those of thin
        triangles are far away, and infinite beyond the range of doubles.
        """
        return _sealed(geometry.circumcenters(self._points, self._simplices))

    def find_simplex(
        self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None
    ) -> Indices:
        """Tell which triangles hold points.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Points to locate. NaN and infinity are outside.
        bruteforce : bool, optional
            Accepted as in SciPy. No search is exhaustive: the walk cannot fail.
        tol : float, optional
            Accepted as in SciPy. It has no effect: the answer is exact.

        Returns
        -------
        ndarray of int32, shape (...)
            The triangle that has the point inside or on its boundary, the first one where there are
            several, or -1 where there is none. The shape is () for a single point.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in the plane.

        Notes
        -----
        Points are taken along a space-filling curve, and each is reached by a visibility walk from
        the one before; for k points that takes O(k log k + walks) time, whatever their order. A
        visibility walk ends in every Delaunay triangulation (L. De Floriani et al., "On sorting
        triangles in a Delaunay tessellation", 1991).

        Examples
        --------
        >>> from delone import Delaunay
        >>> mesh = Delaunay([(0, 0), (1, 0), (0, 1)])
        >>> mesh.find_simplex([(0.25, 0.25), (0.5, 0.5), (0.75, 0.75)])
        array([ 0,  0, -1], dtype=int32)
        """
        queries = as_vectors(xi, 2, name="xi")
        found = _core.find_simplex2(
            self._points,
            self._simplices,
            self._neighbors,
            queries.reshape(-1, 2),
            as_workers(self._workers),
        )
        return found.reshape(queries.shape[:-1])

    def validate(self) -> ValidationReport:
        """Prove that this is the canonical Delaunay triangulation, or name the culprits.

        Returns
        -------
        ValidationReport
            Truthy when all is right: triangles counter-clockwise and tiling the exact convex hull,
            neighbours mutual, each distinct point a vertex, each edge locally Delaunay, ties broken
            canonically.

        Notes
        -----
        Exact, in about the time of the triangulation.

        Examples
        --------
        >>> from delone import Delaunay
        >>> print(Delaunay([(0, 0), (1, 0), (0, 1)]).validate())
        a canonical Delaunay triangulation
        """
        found = _core.validate2(self._points, self._simplices, self._neighbors)
        return ValidationReport.from_culprits(found)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangulation with matplotlib (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        **options
            As in `delone.plot.plot`.

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
        >>> from delone import Delaunay
        >>> ax = Delaunay([(0, 0), (1, 0), (0, 1)]).plot()
        >>> ax.get_aspect()
        1.0
        """
        from delone.plot import plot

        return plot(self, ax=ax, **options)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the triangulation to an .npz file, whole or not at all.

        Parameters
        ----------
        path : str or path-like
            The file. No suffix is added.

        Raises
        ------
        OSError
            The file cannot be written, or is no regular file; what was there before is as it was.
        TypeError
            `path` is no path. File objects are refused.

        Notes
        -----
        Of a symbolic link the target is written. A file that is there keeps its permissions.

        See Also
        --------
        load : The way back.

        Examples
        --------
        >>> import os, tempfile
        >>> from delone import Delaunay
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "mesh.npz")
        ...     Delaunay([(0, 0), (1, 0), (0, 1)]).save(path)
        ...     Delaunay.load(path)
        <Delaunay of 3 points: 1 triangle>
        """
        from delone import archive

        archive.write(path, self._arrays())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Delaunay:
        """Read a triangulation that `save` wrote.

        Parameters
        ----------
        path : str or path-like
            The file.

        Returns
        -------
        Delaunay
            The triangulation, not computed again.

        Raises
        ------
        FileFormatError
            The file is torn or of another kind, or its arrays contradict each other.
        OSError
            The file cannot be read, or is no regular file.
        TypeError
            `path` is no path. File objects are refused.

        Notes
        -----
        Checked in linear time are shapes, dtypes, ranges, duplicates, mutual neighbours,
        orientations and the boundary. `validate` proves the rest.
        """
        from delone import archive

        return cls._from_arrays(archive.read(path), {}, None)

    @classmethod
    def _from_arrays(
        cls, arrays: dict[str, NDArray[Any]], stages: dict[str, float], workers: int | None
    ) -> Delaunay:
        mesh = cls.__new__(cls)
        mesh._fill(arrays, stages, workers)
        return mesh

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {
            "points": self._points,
            "simplices": self._simplices,
            "neighbors": self._neighbors,
            "duplicates": self._duplicates,
        }

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._from_arrays, (self._arrays(), self._stages, self._workers)

    def __copy__(self) -> Delaunay:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Delaunay:
        return self

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"a Delaunay triangulation cannot be changed: {name}")

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a Delaunay triangulation cannot be changed: {name}")

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):  # the constructor failed, or has not run
            return "<Delaunay of nothing yet>"
        points = _counted(self.npoints, "point")
        duplicates = len(self._duplicates)
        if duplicates:
            points += f" ({_counted(duplicates, 'duplicate')})"
        return f"<Delaunay of {points}: {_counted(self.nsimplex, 'triangle')}>"


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _own_copy(points: ArrayLike) -> Floats:
    """Return points that no one else can change, neither now nor while the core runs."""
    array = as_points(points, ndim=2)
    if isinstance(points, list | tuple):
        return array
    if isinstance(points, np.ndarray) and not np.may_share_memory(points, array):
        return array
    return array.copy()
