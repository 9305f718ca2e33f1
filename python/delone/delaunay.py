"""The class Delaunay: a 2-D or 3-D Delaunay triangulation as immutable arrays.

The core makes `simplices` and `neighbors`; what follows from them is in `triangulation` and, where
there are three coordinates, in `space`. Here is what only a Delaunay triangulation has: its
construction, proof, and files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self, overload

from delone import _core
from delone._arrays import as_workers
from delone.counting import counted
from delone.errors import DegenerateInputError, DtypeError, InputError, InternalError
from delone.georeference import warn_of_degrees
from delone.immutable import own_copy
from delone.space.plane import plane_of
from delone.space.spatial import Spatial
from delone.validation import ValidationReport, of_tetrahedra, of_triangles

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping, Sequence

    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from delone.periodic import PeriodicDelaunay

__all__ = ["Delaunay"]

# In space cavities along a curve are the one method; both names mean it.
_METHODS2 = _core.methods2()
_METHODS3 = ["auto", "bowyer-watson"]
# Arguments of scipy.spatial.Delaunay that have no meaning here.
_SCIPY = ("furthest_site", "incremental", "qhull_options")
# Fewer points are never shared among threads.
_FEW = 1000


class Delaunay(Spatial):
    """The Delaunay triangulation of points in the plane, or of points in space.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or PointSet
        Finite coordinates, in any unit: floats of up to 64 bits, integers up to 2**53. They are
        copied and taken as the exact numbers which they denote. Three columns are points in space:
        of a surface with heights, give the first two.
    periodic : tuple of two floats or None, optional
        ``(Lx, Ly)``: the points come again after these distances in x and in y; None for a
        direction in which they do not. Then the result is no `Delaunay` but a
        `delone.PeriodicDelaunay`, with offsets of corners and of edges.
    method : str, optional
        How to compute it: ``"auto"`` (what is fastest), ``"bowyer-watson"`` (cavities, along a
        space-filling curve), ``"divide-and-conquer"`` (halves, merged), ``"incremental"``
        (randomised insertion and flips), ``"sweep"`` (a line over the plane) or ``"lifting"`` (the
        convex hull of points lifted to a paraboloid). The triangles are the same. In space, and
        with `periodic`, the choices are ``"auto"`` and ``"bowyer-watson"``.
    workers : int, optional
        How many threads may work; by default one for each core. The answer is the same.
    planar : bool, optional
        Whether longitudes and latitudes are meant as coordinates of a plane; otherwise points that
        say they are in degrees (by a reference system or names of columns) are warned of.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    simplices : ndarray of int32, shape (m, d + 1)
        The simplices as rows of `points`: triangles, counter-clockwise, or tetrahedra, positively
        oriented. (The second, third and fourth vertex, seen from the first, go round clockwise; the
        determinant of the vectors from the first to the others is positive.)
    neighbors : ndarray of int32, shape (m, d + 1)
        ``neighbors[t, k]`` is the simplex across the edge or face opposite vertex k of simplex t;
        -1 outside.
    ndim : int
        The number of coordinates, 2 or 3.
    npoints, nsimplex : int
        Numbers of points (rows, duplicates included) and of simplices.
    min_bound, max_bound : ndarray of float64, shape (d,)
        The least and the greatest coordinates.

    Raises
    ------
    DegenerateInputError
        Fewer than d + 1 points are distinct, or all lie on one line; ``error.chain`` has them in
        order. Or points in space all lie in one plane; ``error.plane`` is its triangulation.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` tells where.
    ShapeError, DtypeError
        `points` is no array of real points in the plane or in space.
    InputError
        `method` or `workers` is none of its choices.
    LimitError
        There are more than 2**28 points in the plane or 2**27 in space, or more than 2**30
        tetrahedra. `delone.distributed` has no such limit in the plane.
    MemoryError
        There is not enough memory.
    KeyboardInterrupt
        Ctrl-C was pressed. Nothing is left behind.

    Warns
    -----
    GeographicWarning
        The points say that they are longitudes and latitudes; see `planar`.

    Notes
    -----
    The answer is exact: it is that of the real numbers, whatever their range. Each distinct point
    is a vertex, those in the middle of a side of the convex hull included; of rows with the same
    coordinates (-0.0 and 0.0 are the same) the first is the vertex. Where more than three points
    lie on one circle and none inside, their polygon is fanned from its lexicographically smallest
    vertex, so that one set of points has one triangulation, however its rows are ordered. In space
    the same perturbation decides about points on one sphere, and no tetrahedron is flat.

    Names, dtypes and meanings are those of ``scipy.spatial.Delaunay``. All arrays are read-only,
    attributes cannot be set, and ``copy.copy`` and ``copy.deepcopy`` return the object itself.
    Whatever is not listed above is computed on first use and kept.

    Time is O(n log n) with a small constant, most of it linear. ``"auto"`` picks cavity insertion
    along a Hilbert curve, in blocks of a k-d tree that are merged: on scattered points no method
    was faster where it was measured. Blocks of lattices, which divide and conquer does sooner, go
    to it, and so does a block whose triangles are so thin that insertion exceeds its budget of
    work, as on two lines that nearly coincide.

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

    The corners of a cube and its centre:

    >>> cube = Delaunay([(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)] + [(1, 1, 1)])
    >>> cube
    <Delaunay of 9 points: 12 tetrahedra>
    >>> cube.volumes.sum(), cube.convex_hull.shape
    (np.float64(8.0), (12, 3))
    """

    __slots__ = ()

    # A periodic set has no hull, and corners of its triangles have offsets: what comes of it is
    # another class, for which no method here would be right.
    @overload
    def __new__(
        cls,
        points: ArrayLike = ...,
        *,
        method: str = ...,
        workers: int | None = ...,
        planar: bool = ...,
    ) -> Self: ...
    @overload
    def __new__(  # type: ignore[misc]
        cls,
        points: ArrayLike,
        *,
        periodic: Sequence[float | None],
        method: str = ...,
        workers: int | None = ...,
        planar: bool = ...,
    ) -> PeriodicDelaunay: ...
    def __new__(  # type: ignore[misc]
        cls,
        points: ArrayLike = (),
        *,
        periodic: Sequence[float | None] | None = None,
        method: str = "auto",
        workers: int | None = None,
        planar: bool = False,
        **unknown: Any,
    ) -> Self | PeriodicDelaunay:
        """Make a `Delaunay`; with periods, a `PeriodicDelaunay`."""
        _refuse_options(unknown)
        if periodic is None:
            return super().__new__(cls)
        from delone.periodic import PeriodicDelaunay

        if cls is not Delaunay:
            raise InputError(f"periodic goes with Delaunay itself, not with {cls.__name__}")
        if not isinstance(method, str) or method not in ("auto", "bowyer-watson"):
            raise InputError(f"periodic goes with 'auto' and 'bowyer-watson', got {method!r}")
        as_workers(workers)
        return PeriodicDelaunay(points, periodic)

    def __init__(
        self,
        points: ArrayLike,
        *,
        periodic: None = None,
        method: str = "auto",
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        if hasattr(self, "_points"):
            raise AttributeError("a Delaunay never changes: make another one")
        own = own_copy(points, ndim=None)
        warn_of_degrees(points, own, planar=planar)
        # Few points are one task, and to count cores takes as long as some of them.
        threads = 1 if workers is None and len(own) < _FEW else as_workers(workers)
        methods = _METHODS2 if own.shape[1] == 2 else _METHODS3
        if not isinstance(method, str) or method not in methods:
            names = ", ".join(map(repr, methods))
            where = "" if own.shape[1] == 2 else " in space"
            raise InputError(f"method must be one of {names}{where}, got {method!r}")
        try:
            made = _triangles(own, method, threads)
        except InternalError as error:
            error.points = own
            raise
        arrays: dict[str, NDArray[Any]] = {
            "points": own,
            "simplices": made.simplices,
            "neighbors": made.neighbors,
            "duplicates": made.duplicates,
        }
        self._fill(arrays, dict(made.stages), workers)

    @property
    def _sites(self) -> tuple[_core.Locator2, None]:
        return self._locator, None

    def validate(self) -> ValidationReport:
        """Prove that this is the canonical Delaunay triangulation, or name the culprits.

        Returns
        -------
        ValidationReport
            Truthy when all is right: simplices positively oriented and tiling the exact hull,
            neighbours mutual, each distinct point a vertex, each edge or face locally Delaunay,
            ties broken canonically.

        Notes
        -----
        Exact, in about the time of the triangulation.

        Examples
        --------
        >>> from delone import Delaunay
        >>> print(Delaunay([(0, 0), (1, 0), (0, 1)]).validate())
        a canonical Delaunay triangulation
        """
        if self.ndim == 3:
            solid = _core.validate3(self._points, self._simplices, self._neighbors)
            return of_tetrahedra(solid)
        flat = _core.validate2(self._points, self._simplices, self._neighbors)
        return of_triangles(flat)

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

        kind = archive.DELAUNAY if self.ndim == 2 else archive.DELAUNAY3
        archive.write(path, self._arrays(), kind)

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

        Examples
        --------
        See `save`.
        """
        from delone import archive

        kinds = (archive.DELAUNAY, archive.DELAUNAY3)
        return cls._from_arrays(archive.read(path, kinds), {}, None)

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {
            "points": self._points,
            "simplices": self._simplices,
            "neighbors": self._neighbors,
            "duplicates": self._duplicates,
        }

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):  # the constructor failed, or has not run
            return "<Delaunay of nothing yet>"
        points = counted(self.npoints, "point")
        duplicates = len(self._duplicates)
        if duplicates:
            points += f" ({counted(duplicates, 'duplicate')})"
        simplex = "triangle" if self.ndim == 2 else "tetrahedron"
        return f"<Delaunay of {points}: {counted(self.nsimplex, simplex)}>"


def _refuse_options(unknown: Mapping[str, Any]) -> None:
    """Refuse arguments that there are not, and say who takes those of SciPy."""
    for name in unknown:
        if name in _SCIPY:
            raise DtypeError(
                f"delone.Delaunay takes no {name}, which is SciPy's: leave it out, or use "
                "delone.compat.scipy.Delaunay, which takes what SciPy takes"
            )
        raise TypeError(f"Delaunay() got an unexpected keyword argument {name!r}")


def _triangles(points: NDArray[np.float64], method: str, workers: int) -> _core.Triangulation:
    """The triangulation, as the core gives it."""
    if points.shape[1] == 2:
        return _core.triangulate2(points, method, workers)
    try:
        return _core.triangulate3(points, workers)
    except DegenerateInputError as error:
        if error.reason == "coplanar" or len(error.chain) == 3:
            error.plane = plane_of(points, workers)
        raise
