"""Base of the drop-ins for SciPy's Qhull classes: errors, points, incremental mode."""

from __future__ import annotations

from contextlib import contextmanager
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import delaunay
from delone._base.arrays import as_points, as_vectors, is_masked
from delone._tiling.plane import topology
from delone.compat.furthest import furthest_site as furthest_triangles
from delone.compat.qhull_options import DELAUNAY, QhullOptionError, QhullOptions
from delone.errors import DegenerateInputError, DtypeError, InputError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

    class QhullError(RuntimeError):
        """Degenerate input or an unknown option: ``scipy.spatial.QhullError``."""

else:
    try:
        from scipy.spatial import QhullError
    except ImportError:

        class QhullError(RuntimeError):
            """Degenerate input or an unknown option; SciPy's own class if SciPy is installed."""

            # Users know it by this name.
            __module__ = "delone.compat.scipy"


__all__ = [
    "DimensionError",
    "Incremental",
    "QhullError",
    "as_low_points",
    "as_queries",
    "read_options",
    "told_as_qhull_does",
    "triangulate",
    "unboxed",
    "unmasked",
]


class DimensionError(InputError, NotImplementedError):
    """The points have too many coordinates."""

    __module__ = "delone.compat.scipy"


class Incremental:
    """Points, and results that change when points are added; base of the drop-ins."""

    # Its name in messages.
    _what: str = DELAUNAY
    # The maximum number of coordinates of points.
    _most: int = 3

    # Only for triangulations and diagrams.
    furthest_site: bool
    _open: bool
    _options: QhullOptions
    _points: Floats

    def _begin(self, points: ArrayLike, options: str | None, incremental: bool) -> None:
        """Parse the options, then set the points."""
        self._open = bool(incremental)
        self._options = read_options(options, incremental=self._open, what=self._what)
        if self._options.furthest:
            self.furthest_site = True
        most = 2 if getattr(self, "furthest_site", False) else self._most
        self._set(as_low_points(points, most))

    def _set(self, points: Floats) -> None:
        """Compute the results for the points; nothing changes if that fails."""
        raise NotImplementedError

    def _forget(self) -> None:
        """Clear results that were computed on first use."""
        for name in list(self.__dict__):
            if isinstance(getattr(type(self), name, None), cached_property):
                del self.__dict__[name]

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Add points, and update everything.

        Parameters
        ----------
        points : array_like, shape (k, ndim)
            Points to append to `points`.
        restart : bool, optional
            Accepted as in SciPy, without effect.

        Raises
        ------
        RuntimeError
            `incremental` was not set, or `close` has been called.
        QhullError, ValueError
            As in the constructor; nothing is changed.

        Notes
        -----
        `Delaunay` inserts the points into its mesh, and copies the arrays. `Voronoi` and
        `ConvexHull` compute everything again.

        Examples
        --------
        >>> from delone.compat.scipy import ConvexHull, Delaunay, Voronoi
        >>> tri = Delaunay([(0, 0), (1, 0), (0, 1)], incremental=True)
        >>> tri.add_points([(1, 1)])
        >>> tri.nsimplex
        2
        >>> hull = ConvexHull([(0, 0), (1, 0), (0, 1)], incremental=True)
        >>> hull.add_points([(1, 1)])
        >>> hull.volume
        1.0
        >>> vor = Voronoi([(0, 0), (2, 0), (0, 2)], incremental=True)
        >>> vor.add_points([(2, 2)])
        >>> vor.vertices
        array([[1., 1.]])
        """
        if not self._open:
            raise RuntimeError("points can only be added with incremental=True, and before close()")
        ndim = self._points.shape[1]
        more = as_low_points(points, self._most, like=ndim)
        _require_coordinates(more, ndim)
        self._append(more)

    def _append(self, more: Floats) -> None:
        """Compute the results with more points; nothing changes if that fails."""
        self._set(np.concatenate((self._points, more)))

    def close(self) -> None:
        """End incremental mode; `add_points` raises from then on."""
        self._open = False

    @property
    def points(self) -> Floats:
        """Coordinates, (npoints, ndim)."""
        return self._points


def read_options(options: str | None, *, incremental: bool, what: str) -> QhullOptions:
    """Parse an option string; errors have SciPy's types."""
    try:
        return QhullOptions.parse(options, incremental=incremental, what=what)
    except QhullOptionError as error:
        raise QhullError(str(error)) from error


@contextmanager
def told_as_qhull_does(points: Floats, what: str = DELAUNAY) -> Iterator[None]:
    """Convert errors about points to those that SciPy raises.

    `what` is the result that does not exist if the points span no area or volume.
    """
    if len(points) == 0:
        raise ShapeError("no points given")
    try:
        yield
    except DegenerateInputError as error:
        reason = str(error).partition(":")[0]
        raise QhullError(f"{reason}: there is no {what}") from error
    except NonFiniteError as error:
        # SciPy checks for NaN itself and leaves infinity to Qhull.
        if np.isnan(points).any():
            raise
        raise QhullError(str(error)) from error


def triangulate(points: Floats, furthest: bool, what: str = DELAUNAY) -> delaunay.Delaunay:
    """Triangulate as SciPy does; errors have SciPy's types.

    `furthest`: circles contain all points, rather than none.
    """
    with told_as_qhull_does(points, what):
        mesh = delaunay.Delaunay(points)
    if not furthest:
        return mesh
    simplices = furthest_triangles(mesh.points, mesh.hull)
    arrays: dict[str, NDArray[Any]] = {
        "points": mesh.points,
        "simplices": simplices,
        "neighbors": topology.neighbors(simplices, mesh.npoints),
        "duplicates": np.empty((0, 2), dtype=np.int32),
    }
    return delaunay.Delaunay._from_arrays(arrays, {}, None)


def as_low_points(points: ArrayLike, most: int, *, like: int | None = None) -> Floats:
    """Convert as SciPy does if that is exact; errors have SciPy's types. At most `most` axes.

    For a few points, `like` is the number of coordinates of the others.
    """
    ndim = 2 if most == 2 else None
    if is_masked(points):
        return as_points(points, ndim=ndim, most=most)  # which names it in its error
    try:
        array = np.asarray(points)
    except ValueError:
        return as_points(points, ndim=ndim, most=most)
    if array.ndim != 2:
        raise ShapeError(f"points must have two dimensions (npoints, ndim), got {array.shape}")
    if array.shape[1] < 2:
        raise ShapeError(f"points must have at least two coordinates, got shape {array.shape}")
    if array.shape[1] > most:
        named = {2: "in 2-D", 3: "in 2-D and 3-D"}
        where = named.get(most, f"in up to {most} dimensions")
        raise DimensionError(
            f"this function of delone.compat.scipy is only available {where}; for "
            f"{array.shape[1]} coordinates use scipy.spatial"
        )
    if array.dtype.kind in "bO":
        return unboxed(array)
    if array.shape[1] == like:
        ndim = like
    return as_points(points, ndim=ndim, most=most)


def unboxed(array: NDArray[Any], name: str = "points") -> Floats:
    """Convert booleans and Python objects to numbers; DtypeError if that is not exact."""
    numbers = array.astype(np.float64)
    if array.dtype.kind == "O" and not ((numbers == array) | np.isnan(numbers)).all():
        wrong = array[(numbers != array) & ~np.isnan(numbers)]
        raise DtypeError(f"{name} contain {wrong.flat[0]!r:.80}, which float64 cannot represent")
    return numbers


def unmasked(array: NDArray[Any]) -> NDArray[Any]:
    """A plain array, with NaN for masked entries; the same array if nothing is masked."""
    if not is_masked(array):
        return array
    plain = np.asarray(array.data)
    if not np.ma.is_masked(array):
        return plain
    if plain.dtype.kind in "biu":
        plain = plain.astype(np.float64)
    found: NDArray[Any] = np.where(np.ma.getmaskarray(array), np.nan, plain)
    return found


def _require_coordinates(points: NDArray[Any], ndim: int) -> None:
    if points.shape[-1] != ndim:
        raise ShapeError(f"points must have {ndim} coordinates, got shape {points.shape}")


def as_queries(xi: ArrayLike, ndim: int) -> Floats:
    """Convert query points, (..., ndim), as SciPy does if that is exact."""
    array = unmasked(np.asanyarray(xi))
    if array.ndim == 0:
        raise IndexError("points to locate need a last axis of coordinates, got a single value")
    _require_coordinates(array, ndim)
    return unboxed(array) if array.dtype.kind in "bO" else as_vectors(array, ndim, name="xi")
