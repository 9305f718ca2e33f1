"""Drop-in replacements for SciPy's interpolators of scattered points, in two and more dimensions.

`delone.compat.scipy` exports these names. Signatures, attributes, shapes and errors are SciPy's.
Differences:

* At a site, the value is reproduced bit for bit, and on the hull it is never the fill value; a
  query that is outside by a rounding error is outside, because there is no tolerance.
* From 3-D on, `tri` is a `delone.Delaunay`. With more than eight coordinates, or if the simplices
  would not fit into memory, there is no triangulation: `tri` is None, and linear interpolation
  finds the simplex of each query separately. More than 64 coordinates raise a `DimensionError`.
* Of equally near sites, the one with the smallest row is used.
* Norms other than the Euclidean one (`p`) are left to SciPy's tree; `eps` and `tree_options` have
  no effect.
* A ``scipy.spatial.Delaunay`` is replaced by its points.
"""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import delaunay
from delone._base.arrays import is_masked, wrong_shape
from delone._base.extras import require
from delone._tiling.higher.dimension import MOST
from delone.compat.qhull import DimensionError, QhullError, as_low_points, unboxed, unmasked
from delone.compat.scipy_delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError, ShapeError
from delone.interpolate import CloughTocher, Linear
from delone.interpolate.values import as_field
from delone.memory import TooLargeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = [
    "CloughTocher2DInterpolator",
    "LinearNDInterpolator",
    "NearestNDInterpolator",
    "estimate_gradients_2d_global",
    "griddata",
]

_SPACE = 3
# The maximum number of coordinates for interpolation.
_MOST = 64
# Distances compared at a time if all points lie on one line.
_BLOCK = 1 << 22


class _Scale:
    """Points translated and scaled to the unit square, if requested."""

    def __init__(self, points: Floats, wanted: bool) -> None:
        self.offset = self.scale = None
        if wanted and len(points):
            extent = np.ptp(points, axis=0)
            self.offset, self.scale = points.mean(axis=0), np.where(extent > 0, extent, 1.0)

    def __call__(self, points: Floats) -> Floats:
        if self.offset is None or self.scale is None:
            return points
        scaled: Floats = (points - self.offset) / self.scale
        return scaled


class _Triangulated:
    """Base of the interpolators on triangles."""

    # The maximum number of coordinates of sites.
    _most: int = _MOST
    points: Floats
    values: NDArray[Any]
    tri: Any
    fill_value: Any
    _interpolator: Linear | CloughTocher

    def _set(self, points: Any, values: ArrayLike, fill_value: Any, rescale: bool) -> None:
        """Triangulate, and set SciPy's attributes."""
        self.tri = None
        if hasattr(points, "simplices"):
            if rescale:
                raise InputError(
                    "Rescaling is not supported when passing a Delaunay triangulation as "
                    "``points``."
                )
            self.tri = points
            self.points = np.asarray(points.points)
        else:
            self.points = _coordinates(points)
        _require_few(self, self.points, self._most)
        self._scale = _Scale(self.points, rescale)
        if self.points.shape[1] >= _SPACE:
            self._mesh: delaunay.Delaunay | None = self._in_space()
        else:
            own = self.tri if isinstance(self.tri, Delaunay) else None
            if own is None:
                own = Delaunay(self._scale(self.points))
            if self.tri is None:
                self.tri = own
            if own.furthest_site:
                raise InputError("cannot interpolate on a furthest-site triangulation")
            self._mesh = own._mesh
        self.values = _numbers(values)
        self.is_complex = self.values.dtype.kind == "c"
        self.fill_value = (complex if self.is_complex else float)(fill_value)

    def _in_space(self) -> delaunay.Delaunay | None:
        """The triangulation of points in 3-D or more, stored as `tri` unless one was given.

        None if it has too many dimensions, or would not fit into memory.
        """
        if isinstance(self.tri, delaunay.Delaunay):
            return self.tri
        if self.points.shape[1] > MOST:
            return None
        try:
            mesh = delaunay.Delaunay(self._scale(self.points))
        except TooLargeError:
            return None
        except DegenerateInputError as error:
            raise QhullError(str(error)) from error
        if self.tri is None:
            self.tri = mesh
        return mesh

    def __call__(self, *args: ArrayLike) -> NDArray[Any]:
        """Interpolate at points.

        Parameters
        ----------
        *args
            One array of shape (..., d), a tuple of d arrays, or the d arrays themselves.

        Returns
        -------
        ndarray of float64 or complex128
            Values; the fill value outside the hull.

        Raises
        ------
        ValueError
            The points have a different dimension than the sites, or are not numeric.

        Examples
        --------
        >>> from delone.compat.scipy import LinearNDInterpolator
        >>> height = LinearNDInterpolator([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0])
        >>> height([(1, 1), (9, 9)]), height([1, 2], [1, 0])
        (array([ 4., nan]), array([4., 3.]))
        """
        queries = self._scale(_queries(args, self.points.shape[1]))
        found = self._interpolator(queries)
        # A complex NaN fills both parts, as in SciPy.
        if self.is_complex or not np.isnan(self.fill_value):
            found[self._outside(queries)] = self.fill_value
        return found

    def _outside(self, queries: Floats) -> NDArray[np.bool_]:
        """Whether queries are outside the hull."""
        if self._mesh is not None:
            found: NDArray[np.bool_] = self._mesh.find_simplex(queries) < 0
            return found
        table = self._interpolator.weights_at(queries)
        empty: NDArray[np.bool_] = np.diff(table.indptr) == 0
        return empty.reshape(queries.shape[:-1])


class LinearNDInterpolator(_Triangulated):
    """Piecewise linear interpolation with the interface of SciPy.

    Parameters
    ----------
    points : array_like, shape (npoints, d), tuple of d arrays, or Delaunay
        Sites with two to 64 coordinates, or a triangulation of them.
    values : array_like, shape (npoints, ...)
        Real or complex values.
    fill_value : float, optional
        Value outside the hull.
    rescale : bool, optional
        Triangulate the points after scaling them to the unit cube.

    Raises
    ------
    QhullError
        The points span no area, or in 3-D no volume.
    ValueError
        Array shapes do not match; rescaling is requested for a triangulation.

    See Also
    --------
    delone.interpolate.Linear : Extrapolation, weights, slopes, policies.

    Examples
    --------
    >>> from delone.compat.scipy import LinearNDInterpolator
    >>> height = LinearNDInterpolator([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0], fill_value=-1)
    >>> height([1, 9], [1, 9])
    array([ 4., -1.])
    """

    def __init__(
        self,
        points: Any,
        values: ArrayLike,
        fill_value: Any = np.nan,
        rescale: bool = False,
    ) -> None:
        self._set(points, values, fill_value, rescale)
        policies: Any = {"duplicates": "first", "nan": "propagate"}
        if self._mesh is not None:
            self._interpolator = Linear(self._mesh, self.values, **policies)
            return
        sites = self._scale(self.points)
        try:
            self._interpolator = Linear(sites, self.values, method="lazy", **policies)
        except DegenerateInputError as error:
            raise QhullError(str(error)) from error


class CloughTocher2DInterpolator(_Triangulated):
    """Piecewise cubic, smooth interpolation with the interface of SciPy.

    Parameters
    ----------
    points : array_like, shape (npoints, 2), tuple of two arrays, or Delaunay
        Sites, or a triangulation of them.
    values : array_like, shape (npoints, ...)
        Real or complex values.
    fill_value : float, optional
        Value outside the hull.
    tol : float, optional
        Tolerance of the estimation of gradients: relative for gradients above 1 and absolute for
        others, as in SciPy.
    maxiter : int, optional
        Maximum number of sweeps.
    rescale : bool, optional
        Triangulate the points after scaling them to the unit square.

    Attributes
    ----------
    grad : ndarray, shape (npoints, nvalues, 2)
        Gradients at the sites, which may be modified.

    Raises
    ------
    QhullError
        The points span no area.
    DimensionError
        The points do not have two coordinates.
    ValueError
        Array shapes do not match; rescaling is requested for a triangulation.

    See Also
    --------
    delone.interpolate.CloughTocher : Extrapolation, weights, derivatives, policies.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.compat.scipy import CloughTocher2DInterpolator
    >>> points = [(0, 0), (4, 0), (0, 4), (4, 4), (1, 2)]
    >>> plane = CloughTocher2DInterpolator(points, [0, 4, 8, 12, 5])
    >>> plane(3, 1).round(4)
    np.float64(5.0)
    """

    _most = 2

    def __init__(  # noqa: PLR0917 (as in SciPy)
        self,
        points: Any,
        values: ArrayLike,
        fill_value: Any = np.nan,
        tol: float = 1e-6,
        maxiter: int = 400,
        rescale: bool = False,
    ) -> None:
        self._set(points, values, fill_value, rescale)
        mesh: Any = self._mesh
        self._interpolator = _GivenGradients(
            mesh, self.values, tol=tol, max_iter=maxiter, duplicates="first", nan="propagate"
        )
        found = self._interpolator.site_gradients()
        self.grad = np.ascontiguousarray(found.reshape(len(found), -1, 2))

    def __call__(self, *args: ArrayLike) -> NDArray[Any]:
        """Interpolate at points, like `LinearNDInterpolator`."""
        self._interpolator.given = self.grad  # type: ignore[union-attr]
        return super().__call__(*args)


class _GivenGradients(CloughTocher):
    """Clough-Tocher interpolation with gradients that the user may modify."""

    given: NDArray[Any] | None = None
    _floor = 1.0

    def _gradients(self, columns: Floats) -> Floats:
        """Return the gradients given, or the estimated ones if there are none."""
        if self.given is None:
            return super()._gradients(columns)
        if self.given.dtype.kind != "c":
            return np.ascontiguousarray(self.given, dtype=np.float64)
        parts = np.stack((self.given.real, self.given.imag), axis=2)
        return np.ascontiguousarray(parts.reshape(len(parts), -1, 2))


class NearestNDInterpolator:
    """Interpolation by the nearest site with the interface of SciPy.

    Parameters
    ----------
    x : array_like, shape (npoints, d), or tuple of d arrays
        Sites with two to eight coordinates.
    y : array_like, shape (npoints, ...)
        Real or complex values.
    rescale : bool, optional
        Measure distances between points that are scaled to the unit cube.
    tree_options : dict, optional
        Accepted as in SciPy, without effect.

    Raises
    ------
    DimensionError
        The points have more than eight coordinates.
    ValueError
        Array shapes do not match.

    See Also
    --------
    delone.interpolate.Nearest : Weights, policies.

    Examples
    --------
    >>> from delone.compat.scipy import NearestNDInterpolator
    >>> NearestNDInterpolator([(0, 0), (1, 0), (0, 1)], [10, 20, 30])(0.9, 5.0)
    array(30.)
    """

    def __init__(
        self,
        x: Any,
        y: ArrayLike,
        rescale: bool = False,
        tree_options: dict[str, Any] | None = None,
    ) -> None:
        self.points = _coordinates(x)
        _require_few(self, self.points, MOST)
        self.values = _numbers(y)
        self._scale = _Scale(self.points, rescale)
        self._field = as_field(self.values, len(self.points))
        self._scaled = np.ascontiguousarray(self._scale(self.points))
        try:
            self._mesh: delaunay.Delaunay | None = delaunay.Delaunay(self._scaled)
        except DegenerateInputError as error:
            self._mesh, self._chain = None, error.chain

    def __call__(
        self,
        *args: ArrayLike,
        eps: float = 0,
        p: float = 2,
        distance_upper_bound: float = np.inf,
        workers: int = 1,
    ) -> NDArray[Any]:
        """Return the values of the nearest sites.

        Parameters
        ----------
        *args
            One array of shape (..., d), a tuple of d arrays, or the d arrays themselves.
        eps, workers
            Accepted as in SciPy, without effect.
        p : float, optional
            The norm by which distances are measured; norms other than 2 are left to SciPy.
        distance_upper_bound : float, optional
            Sites at this distance or farther are ignored.

        Returns
        -------
        ndarray of float64 or complex128
            Values; NaN if no site is near enough.
        """
        ndim = self.points.shape[1]
        queries = self._scale(_queries(args, ndim))
        flat = queries.reshape(-1, ndim)
        if not len(self.points):
            none = np.full((len(flat), self._field.columns.shape[1]), np.nan)
            return self._field.shaped(none, queries.shape[:-1])
        rows = self._nearest(flat, p)
        offset = self._scaled[rows] - flat
        with np.errstate(over="ignore"):  # infinity is beyond any bound
            distance = np.linalg.norm(offset, ord=p, axis=1)
        # NaN is not below the bound.
        counts = (rows >= 0) & (distance < distance_upper_bound)
        found = np.where(counts[:, None], self._field.columns[rows], np.nan)
        return self._field.shaped(found, queries.shape[:-1])

    def _nearest(self, queries: Floats, p: float) -> NDArray[np.integer]:
        if p != 2:
            return self._nearest_by_tree(queries, p)
        if self._mesh is not None:
            return self._mesh.nearest(queries)
        sites = self._scaled[self._chain]
        found = np.full(len(queries), -1)
        finite = np.flatnonzero(np.isfinite(queries).all(axis=1))
        share = max(1, _BLOCK // len(sites))
        for start in range(0, len(finite), share):
            some = finite[start : start + share]
            offset = queries[some, None] - sites
            distance = functools.reduce(np.hypot, np.moveaxis(offset, -1, 0))
            found[some] = self._chain[distance.argmin(axis=1)]
        return found

    def _nearest_by_tree(self, queries: Floats, p: float) -> NDArray[np.integer]:
        spatial = require("scipy.spatial", extra="graph", what="a norm other than p=2")
        rows: NDArray[np.integer] = spatial.KDTree(self._scaled).query(queries, p=p)[1]
        return rows


def griddata(  # noqa: PLR0917 (as in SciPy)
    points: Any,
    values: ArrayLike,
    xi: Any,
    method: str = "linear",
    fill_value: Any = np.nan,
    rescale: bool = False,
) -> NDArray[Any]:
    """Interpolate scattered values with the interface of SciPy.

    Parameters
    ----------
    points : array_like, shape (n, d), or tuple of d arrays
        Sites with two to 64 coordinates, for ``"nearest"`` two to eight; or 1-D sites of shape (n,)
        or (n, 1).
    values : array_like, shape (n, ...)
        Real or complex values.
    xi : array_like, shape (..., d), or tuple of d arrays
        Where to interpolate.
    method : {"linear", "nearest", "cubic"}, optional
        `LinearNDInterpolator`, `NearestNDInterpolator` or, in 2-D, `CloughTocher2DInterpolator`.
        1-D data are interpolated by SciPy: cubic is its spline.
    fill_value : float, optional
        Value outside the hull; without effect for ``"nearest"``.
    rescale : bool, optional
        Scale the points to the unit cube first.

    Returns
    -------
    ndarray of float64 or complex128
        Values.

    Raises
    ------
    ValueError
        The method is unknown; array shapes do not match.
    DimensionError
        The points have more coordinates than the method accepts.
    MissingExtraError
        The points are 1-D, and SciPy is not installed.

    Examples
    --------
    >>> from delone.compat.scipy import griddata
    >>> griddata([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0], ([1, 9], [1, 9]), method="nearest")
    array([1., 5.])
    """
    if _is_line(points):
        return _on_line(points, values, xi, method, fill_value, rescale)
    if method == "nearest":
        return NearestNDInterpolator(points, values, rescale=rescale)(xi)
    if method == "linear":
        linear = LinearNDInterpolator(points, values, fill_value=fill_value, rescale=rescale)
        return linear(xi)
    if method == "cubic":
        cubic = CloughTocher2DInterpolator(points, values, fill_value=fill_value, rescale=rescale)
        return cubic(xi)
    raise InputError(
        f"unknown interpolation method {method!r:.80}; choose linear, nearest or cubic"
    )


def _is_line(points: Any) -> bool:
    """Whether points have one coordinate each."""
    if isinstance(points, tuple) and points and np.ndim(points[0]) == 1:
        return len(points) == 1
    shape = np.shape(points)
    return len(shape) == 1 or (len(shape) == 2 and shape[1] == 1)


def _on_line(  # noqa: PLR0917 (as in SciPy)
    points: Any, values: ArrayLike, xi: Any, method: str, fill_value: Any, rescale: bool
) -> NDArray[Any]:
    """Interpolate 1-D points with SciPy, as no triangulation is needed."""
    interpolate = require("scipy.interpolate", extra="graph", what="griddata of 1-D points")
    line = points[0] if isinstance(points, tuple) and np.ndim(points[0]) == 1 else points
    found: NDArray[Any] = interpolate.griddata(
        _real_points(line),
        _numbers(values),
        tuple(map(_real_queries, xi)) if isinstance(xi, tuple) else _real_queries(xi),
        method=method,
        fill_value=fill_value,
        rescale=rescale,
    )
    return found


def estimate_gradients_2d_global(
    tri: Any, y: ArrayLike, maxiter: int = 400, tol: float = 1e-6
) -> NDArray[Any]:
    """Estimate gradients at the points of a triangulation that minimize the curvature along edges.

    Parameters
    ----------
    tri : Delaunay
        A triangulation.
    y : array_like, shape (npoints, ...)
        Values.
    maxiter : int, optional
        Maximum number of sweeps.
    tol : float, optional
        Change at which sweeps stop: relative for gradients above 1 and absolute for others.

    Returns
    -------
    ndarray of float64 or complex128
        The shape of the values, then 2.

    Examples
    --------
    >>> from delone.compat.scipy import Delaunay, estimate_gradients_2d_global
    >>> tri = Delaunay([(0, 0), (1, 0), (0, 1), (1, 1)])
    >>> estimate_gradients_2d_global(tri, [0.0, 2.0, 3.0, 5.0])[0].round(4)
    array([2., 3.])
    """
    made = CloughTocher2DInterpolator(tri, y, tol=tol, maxiter=maxiter)
    return made.grad.reshape((*np.shape(y), 2))


def _require_few(owner: object, points: Floats, most: int) -> None:
    """Reject sites with more coordinates than an interpolator accepts."""
    if points.shape[1] > most:
        name = "2-D points" if most == 2 else f"points with up to {most} coordinates"
        raise DimensionError(
            f"{type(owner).__name__} interpolates {name}, got {points.shape[1]} coordinates: use "
            "LinearNDInterpolator"
        )


def _coordinates(points: Any) -> Floats:
    """Points from an array, or from one array for each coordinate, as in SciPy."""
    if isinstance(points, tuple) and points and np.ndim(points[0]) == 1:
        lengths = {np.shape(part) for part in points}
        if len(lengths) > 1:
            raise ShapeError(f"coordinate arrays have different shapes: {sorted(lengths)}")
        points = np.column_stack([_real_points(part) for part in points])
    shape = np.shape(points)
    if len(shape) == 1 or (len(shape) == 2 and shape[1] == 1):
        raise DimensionError(
            "delone interpolates in 2 and more dimensions; in 1-D use griddata or scipy.interpolate"
        )
    return as_low_points(_real_points(points), _MOST)


def _real_points(points: ArrayLike) -> NDArray[Any]:
    """Sites as a plain array; masked entries raise."""
    if is_masked(points) and np.ma.is_masked(points):
        mask = np.ma.getmaskarray(points)
        row = int(np.flatnonzero(mask.reshape(len(mask), -1).any(axis=1))[0])
        raise InputError(f"points: row {row} is masked; remove unknown points")
    return unmasked(np.asanyarray(points))


def _real_queries(xi: ArrayLike) -> Floats:
    """Queries as plain numbers, NaN if masked."""
    return np.asarray(unmasked(np.asanyarray(xi)), dtype=np.float64)


def _numbers(values: ArrayLike) -> NDArray[Any]:
    """Values as in SciPy: booleans and objects become floats, masked values NaN."""
    array = unmasked(np.asanyarray(values))
    return unboxed(array, "values") if array.dtype.kind in "bO" else array


def _queries(args: tuple[Any, ...], ndim: int) -> Floats:
    """Queries from an array, a tuple of arrays, or several arguments, as in SciPy."""
    parts = args[0] if len(args) == 1 else args
    if isinstance(parts, tuple):
        if len(parts) != ndim:
            raise ShapeError(f"queries need {ndim} coordinates, got {len(parts)}")
        return np.stack(np.broadcast_arrays(*map(_real_queries, parts)), axis=-1)
    xi = _real_queries(parts)
    if xi.ndim == 1 and xi.size % ndim == 0:
        return xi.reshape(-1, ndim)
    if xi.ndim == 0 or xi.shape[-1] != ndim:
        raise wrong_shape("queries", f"(..., {ndim})", xi)
    return np.ascontiguousarray(xi)
