"""The class TetMesh: tetrahedra that are no Delaunay triangulation any more, or never were one.

Unlike a `Delaunay` of points in space it may have any boundary, and of what follows from its arrays
only that is here which holds for all of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._arrays import as_number
from delone.counting import counted
from delone.errors import DtypeError
from delone.exchange.parts import Parts
from delone.immutable import Immutable, kept, sealed
from delone.space import location as places
from delone.space import topology
from delone.space.quality import TetQuality, measured

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.improve.report import ImproveReport

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["TetMesh"]

_ARRAYS = ("points", "simplices", "neighbors", "region")


class TetMesh(Immutable):
    """A mesh of tetrahedra, as `delone.improve` makes it.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 3)
        The coordinates, row for row those that were given, some of them moved.
    simplices : ndarray of int32, shape (m, 4)
        The tetrahedra as rows of `points`, positively oriented.
    neighbors : ndarray of int32, shape (m, 4)
        ``neighbors[t, k]`` is the tetrahedron across the face opposite vertex k of tetrahedron t;
        -1 outside.
    region : ndarray of int32, shape (m,)
        The region of each tetrahedron.
    report : ImproveReport
        What was changed, angles before and after, and what is left.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. Tetrahedra are in an order that hangs on
    coordinates alone.

    Examples
    --------
    >>> import delone
    >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
    >>> mesh = delone.improve(corner)
    >>> mesh
    <TetMesh of 4 points: 1 tetrahedron>
    >>> mesh.boundary.shape, mesh.volumes
    ((4, 3), array([0.16666667]))
    """

    __slots__ = ("_neighbors", "_points", "_region", "_report",
                 "_simplices")  # fmt: skip

    _neighbors: Indices
    _points: Floats
    _region: Indices
    _report: ImproveReport
    _simplices: Indices

    def __init__(self, *given: Any, **options: Any) -> None:
        raise DtypeError("a TetMesh is made by delone.improve(mesh), not by its class")

    @classmethod
    def _of(cls, arrays: dict[str, NDArray[Any]], report: ImproveReport) -> Self:
        mesh = cls.__new__(cls)
        mesh._hold(report=report, **{name: sealed(arrays[name]) for name in _ARRAYS})
        return mesh

    @property
    def points(self) -> Floats:
        """The coordinates, (n, 3)."""
        return self._points

    @property
    def simplices(self) -> Indices:
        """The tetrahedra as rows of `points`, (m, 4), positively oriented."""
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The tetrahedron opposite each vertex, (m, 4); -1 outside."""
        return self._neighbors

    @property
    def region(self) -> Indices:
        """The region of each tetrahedron, (m,); 0 where none were given."""
        return self._region

    @property
    def report(self) -> ImproveReport:
        """What was changed, angles before and after, and what is left."""
        return self._report

    @property
    def ndim(self) -> int:
        """Number of coordinates, 3."""
        return 3

    @property
    def npoints(self) -> int:
        """Number of points, those that no tetrahedron uses included."""
        return len(self._points)

    @property
    def nsimplex(self) -> int:
        """Number of tetrahedra."""
        return len(self._simplices)

    @property
    @kept
    def boundary(self) -> Indices:
        """The faces with one tetrahedron, (h, 3), counter-clockwise seen from outside."""
        return sealed(topology.boundary_faces(self._simplices, self._neighbors))

    @property
    @kept
    def edges(self) -> Indices:
        """Every edge once, (k, 2): the smaller vertex first, rows ascending."""
        return sealed(topology.edges(self._simplices, self.npoints))

    @property
    def volumes(self) -> Floats:
        """Volumes of the tetrahedra, (m,), in the cube of the unit of the points."""
        return self.quality().volume

    @kept
    def quality(self) -> TetQuality:
        """Measure the tetrahedra.

        Returns
        -------
        TetQuality
            Smallest and largest dihedral angles, volumes, ratios of radii and of edges.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().largest_dihedral
        array([90.])
        """
        return measured(self._points, self._simplices)

    @property
    @kept
    def _locator(self) -> _core.Locator3:
        return _core.Locator3(self._points, self._simplices, self._neighbors)

    def find_simplex(self, xi: ArrayLike) -> Indices:
        """Tell which tetrahedra hold points, exactly.

        Parameters
        ----------
        xi : array_like, shape (..., 3)
            Points to locate. NaN and infinity are outside.

        Returns
        -------
        ndarray of int32, shape (...)
            The tetrahedron that has the point inside or on its boundary, the first one where there
            are several, or -1 where there is none: outside, or in a hole.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in space.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).find_simplex([(0.25, 0.25, 0.25), (1, 1, 1)])
        array([ 0, -1], dtype=int32)
        """
        return places.find(self._locator, xi, None)

    def locate(self, xi: ArrayLike) -> places.SpaceLocation:
        """Tell where points lie: tetrahedron, weights of its corners, nearest boundary point.

        Parameters
        ----------
        xi : array_like, shape (..., 3)
            Points to locate.

        Returns
        -------
        SpaceLocation
            With fields `simplex`, `barycentric`, `nearest`, `beside`, `face`, `shares`.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is no array of real points in space.

        Notes
        -----
        As `Delaunay.locate`, with any boundary: a tree of boxes says what a walk cannot where that
        is not convex, and what is nearest.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> place = delone.improve(corner).locate((0.25, 0.25, -3))
        >>> place.nearest, place.face.tolist()
        (array([0.25, 0.25, 0.  ]), [0, 2, 1])
        """
        return places.locate(self._locator, self._points, xi, None)

    def to_meshio(self) -> Any:
        """Return the mesh as a mesh of meshio.

        Returns
        -------
        meshio.Mesh
            Tetrahedra with their ``region`` and ``smallest_dihedral``.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``mesh``).

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).to_meshio().cells_dict["tetra"].shape
        (1, 4)
        """
        from delone.exchange.meshio import to_meshio

        return to_meshio(self._parts())

    def to_pyvista(self) -> Any:
        """Return the mesh as an unstructured grid of PyVista.

        Returns
        -------
        pyvista.UnstructuredGrid
            With ``region`` and ``smallest_dihedral`` of tetrahedra.

        Raises
        ------
        MissingExtraError
            The library is not installed (extra ``pyvista``).

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).to_pyvista().n_cells  # doctest: +SKIP
        1
        """
        from delone.exchange.pyvista import to_pyvista

        return to_pyvista(self._parts())

    def plot(self, plotter: Any = None, *, below: float | None = None) -> Any:
        """Draw the surface and the tetrahedra with small dihedral angles (extra ``pyvista``).

        Parameters
        ----------
        plotter : pyvista.Plotter, optional
            Where to draw; by default a new one.
        below : float, optional
            Up to which smallest dihedral angle, in degrees; by default the goal of the report.

        Returns
        -------
        pyvista.Plotter
            What was drawn on; ``show()`` shows it.

        Raises
        ------
        MissingExtraError
            The library is not installed.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).plot().show()  # doctest: +SKIP
        """
        from delone.plot import plot

        bound = self._report.min_angle if below is None else as_number(below, name="below")
        return plot(self, plotter, below=bound)

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = {name: getattr(self, f"_{name}") for name in _ARRAYS}
        return type(self)._of, (arrays, self._report)

    def _parts(self) -> Parts:
        """What other libraries and files take."""
        values: dict[str, NDArray[Any]] = {
            "region": self._region,
            "smallest_dihedral": self.quality().smallest_dihedral,
        }
        return Parts(self._points, self._simplices, of_simplices=values)

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):
            return "<TetMesh of nothing yet>"
        tetrahedra = counted(self.nsimplex, "tetrahedron")
        return f"<TetMesh of {counted(self.npoints, 'point')}: {tetrahedra}>"
