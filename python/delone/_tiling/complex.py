"""The base class of everything that consists of points and simplices: arrays, files, exchange.

An object is filled once from its arrays and never changes. Pickles, `save` and `load`, and the
methods that draw and convert are the same for all; a class names its arrays in `_ARRAYS` and
documents them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self, SupportsIndex

import numpy as np

from delone._base.georeference import crs_of
from delone._base.immutable import Immutable, kept, sealed
from delone._tiling.dimension import FLAT_OR_SOLID, only
from delone.errors import InputError

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import Parts

    Arrays = Mapping[str, NDArray[Any]]
    # Names and seconds; the dictionary is made on request.
    Stages = dict[str, float] | tuple[tuple[str, float], ...]

__all__ = ["Complex", "Drawn", "Exchanged", "Filed", "Referenced", "Stored", "points_alone"]


def points_alone(
    given: Stored, *, what: str, needs: tuple[str, ...] = ("periods", "weights")
) -> Floats:
    """Return the points of an object for `what`; raise if what it `needs` or the sphere is lost."""
    name = type(given).__name__
    if hasattr(given, "lonlat"):
        raise InputError(
            f"{what} is not available on the sphere: the points of this {name} are directions: "
            "pass projected coordinates, or its points for chords through the sphere"
        )
    for lost in needs:
        if getattr(given, lost, None) is not None:
            raise InputError(
                f"{what} would lose the {lost} of a {name}: pass its points if that is meant"
            )
    found: Floats = getattr(given, "points")  # noqa: B009
    return found


class Referenced(Immutable):
    """An immutable object with the reference system of its points."""

    __slots__ = ("_system",)

    _system: str | None

    @property
    def crs(self) -> str | None:
        """The reference system of the points, if they declared one, as a GeoDataFrame does."""
        # Set only if there is one: most points are arrays.
        return getattr(self, "_system", None)

    def _refer(self, data: Any) -> Self:
        """Take the reference system that data declare, and return the object."""
        if type(data) is not np.ndarray and (found := crs_of(data)) is not None:
            object.__setattr__(self, "_system", found)
        return self

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        made: Any = self.__reduce__()
        system = getattr(self, "_system", None)
        return made if system is None else (*made[:2], system)

    def __setstate__(self, system: str) -> None:
        object.__setattr__(self, "_system", system)


class Drawn:
    """An object that has a picture."""

    __slots__ = ()

    def _drawn(self) -> Any:
        """Return what is drawn."""
        return self

    @only(FLAT_OR_SOLID, "draw two or three of the columns of its points")
    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw with matplotlib (extra ``plot``) or, in 3-D, with PyVista (extra ``pyvista``).

        Parameters
        ----------
        ax : matplotlib Axes or pyvista Plotter, optional
            Where to draw; by default on a new one.
        **options
            As for `delone.plot.plot`.

        Returns
        -------
        matplotlib Axes or pyvista Plotter
            Where it is drawn.

        Raises
        ------
        MissingExtraError
            The library is not installed.
        InputError
            An option does not exist for this kind of object or has a wrong value, or there is
            nothing to draw.

        Examples
        --------
        >>> from delone import Delaunay
        >>> ax = Delaunay([(0, 0), (1, 0), (0, 1)]).plot()
        >>> ax.get_aspect()
        1.0
        """
        from delone.plot import plot

        return plot(self._drawn(), ax, **options)


class Exchanged(Referenced, Drawn):
    """An object that is drawn and converted by its parts: points and simplices."""

    __slots__ = ()

    def _parts(self) -> Parts:
        """Return what other libraries take."""
        raise NotImplementedError

    def _raised_parts(self) -> Parts:
        """Return the same with heights, if there are any."""
        return self._parts()

    @only(FLAT_OR_SOLID, "meshio has no cells of more dimensions; use `save`")
    def to_meshio(self, *, order: int = 1) -> Any:
        """Convert to a meshio mesh (extra ``mesh``).

        Parameters
        ----------
        order : {1, 2}, optional
            With 2, elements of second order, with a node in the middle of each edge: nodes are the
            points and then the `edges`, row by row.

        Returns
        -------
        meshio.Mesh
            The simplices, and segments as lines, with regions and markers as values. If segments
            have markers, like those of a `Mesh`, both are also Gmsh tags: regions from 1 on,
            markers unchanged. 2-D points get z = 0, those of a `TIN` their heights.

        Raises
        ------
        InputError
            `order` is neither 1 nor 2.
        MissingExtraError
            meshio is not installed.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).to_meshio().cells_dict["triangle"].shape
        (1, 3)
        """
        from delone.exchange.meshio import to_meshio

        return to_meshio(self._raised_parts(), order=order)

    @only(FLAT_OR_SOLID, "PyVista has no cells of more dimensions")
    def to_pyvista(self, *, order: int = 1) -> Any:
        """Convert to a PyVista mesh (extra ``pyvista``).

        Parameters
        ----------
        order : {1, 2}, optional
            With 2, elements of second order, with a node in the middle of each edge: nodes are the
            points and then the `edges`, row by row.

        Returns
        -------
        pyvista.PolyData or pyvista.UnstructuredGrid
            Edges and triangles as a surface, 2-D points at z = 0, and those of a `TIN` at their
            heights; tetrahedra as a grid. Values of simplices and points, such as regions, are its
            data.

        Raises
        ------
        InputError
            `order` is neither 1 nor 2.
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone import Delaunay
        >>> Delaunay([(0, 0), (1, 0), (0, 1)]).to_pyvista().n_cells
        1
        """
        from delone.exchange.pyvista import to_pyvista

        return to_pyvista(self._raised_parts(), order=order)


class Filed:
    """An object that can be saved and loaded."""

    __slots__ = ()

    # Whether the arrays of a file contain the reference system.
    _SAVES_CRS: ClassVar[bool] = False

    def _saved(self) -> dict[str, NDArray[Any]]:
        """Return the arrays of a file."""
        raise NotImplementedError

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """Return the object of the arrays of a file, which have been checked."""
        raise NotImplementedError

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write to an .npz file, atomically.

        Parameters
        ----------
        path : str or path-like
            The file. No suffix is added.

        Raises
        ------
        OSError
            The file cannot be written, or is not a regular file; an existing file is unchanged.
        TypeError
            `path` is not a path. File objects are not accepted.

        See Also
        --------
        load : The inverse.

        Notes
        -----
        A symbolic link is followed. An existing file keeps its permissions. The file contains what
        `load` needs to restore the object bit for bit, and no code.

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
        from delone._tiling import archive

        arrays, system = self._saved(), getattr(self, "_system", None)
        if system is not None:
            arrays["crs"] = np.array(system)
        archive.write(path, arrays, self._stored_as())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a file that `save` wrote.

        Parameters
        ----------
        path : str or path-like
            The file.

        Returns
        -------
        Self
            The object. `stages` is empty, and `workers` is None.

        Raises
        ------
        FileFormatError
            The file is truncated or of another class, or its arrays contradict each other.
        OSError
            The file cannot be read, or is not a regular file.
        TypeError
            `path` is not a path. File objects are not accepted.

        Notes
        -----
        Shapes, dtypes, ranges, duplicates, mutual neighbors and orientations are checked in linear
        time; `validate` proves the rest. A `ConvexHull`, `RegularTriangulation`,
        `PeriodicDelaunay`, `AlphaShape` and `Voronoi` are recomputed from their input.

        Examples
        --------
        See `save`.
        """
        from delone._tiling import archive

        arrays = archive.read(path, cls._stored_as())
        system = None if cls._SAVES_CRS else arrays.pop("crs", None)
        try:
            made = cls._loaded(arrays)
        except InputError as error:
            # Arrays that are the input of a constructor.
            raise archive.refusal(path, error) from error
        if isinstance(made, Referenced) and system is not None:
            made.__setstate__(str(system))
        return made

    @classmethod
    def _stored_as(cls) -> str:
        """Return the name of the class, or of the public class that it extends."""
        from delone._tiling.archive.kinds import KINDS

        return next(each.__name__ for each in cls.__mro__ if each.__name__ in KINDS)


class Stored(Referenced, Filed):
    """An immutable object that can be saved, loaded and pickled."""

    __slots__ = ("_workers",)

    _workers: int | None

    @property
    def workers(self) -> int | None:
        """Maximum number of threads; None for one per core. The result does not depend on it."""
        return self._workers

    def _described(self) -> str:
        """Return what `repr` says after "of"."""
        raise NotImplementedError

    def __repr__(self) -> str:
        if not hasattr(self, "_cache"):  # the constructor failed, or has not run
            return f"<{type(self).__name__} of nothing yet>"
        return f"<{type(self).__name__} of {self._described()}>"


class Complex(Stored, Exchanged):
    """Points and simplices as read-only arrays."""

    __slots__ = ("_neighbors", "_points", "_simplices", "_stages")

    # The names of the object's parts; each has a slot with an underscore.
    _ARRAYS: ClassVar[tuple[str, ...]] = ("points", "simplices", "neighbors")

    _neighbors: Indices
    _points: Floats
    _simplices: Indices
    _stages: Stages

    def _fill(self, arrays: Arrays, stages: Stages, workers: int | None) -> None:
        """Set everything; afterward nothing can be set."""
        self._hold(
            stages=stages,
            workers=workers,
            **{name: sealed(array) for name, array in arrays.items()},
        )

    @classmethod
    def _from_arrays(
        cls,
        arrays: Arrays,
        stages: Stages = (),
        workers: int | None = None,
    ) -> Self:
        made = cls.__new__(cls)
        made._fill(arrays, stages, workers)
        return made

    def _arrays(self) -> dict[str, NDArray[Any]]:
        return {name: getattr(self, f"_{name}") for name in self._ARRAYS}

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._arrays()

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._from_arrays(arrays)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._from_arrays, (self._arrays(), self._stages, self._workers)

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d), where d is `ndim`."""
        return self._points

    @property
    def simplices(self) -> Indices:
        """The simplices as rows of `points`."""
        return self._simplices

    @property
    def neighbors(self) -> Indices:
        """The simplex opposite each vertex, in the shape of `simplices`; -1 outside."""
        return self._neighbors

    @property
    def ndim(self) -> int:
        """Number of coordinates."""
        return int(self._points.shape[1])

    @property
    def npoints(self) -> int:
        """Number of points, including duplicates and points without a simplex."""
        return len(self._points)

    @property
    def nsimplex(self) -> int:
        """Number of simplices."""
        return len(self._simplices)

    @property
    def stages(self) -> dict[str, float]:
        """Seconds of each part of the construction; empty after loading from a file."""
        return dict(self._stages)

    @property
    @kept
    def min_bound(self) -> Floats:
        """The smallest coordinates, (d,)."""
        return sealed(self._points.min(axis=0))

    @property
    @kept
    def max_bound(self) -> Floats:
        """The largest coordinates, (d,)."""
        return sealed(self._points.max(axis=0))

    def _parts(self) -> Parts:
        """Return what other libraries take."""
        from delone.exchange.parts import Parts

        return Parts(self._points, self._simplices, crs=self.crs)
