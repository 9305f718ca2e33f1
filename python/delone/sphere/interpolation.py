"""Interpolation on the sphere: linear on spherical triangles, and by the nearest site.

The base class `_Interpolator` has the policies and the fields, which are those of
`delone.interpolate`; a subclass has the sites of each query and their weights.
"""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone import _core
from delone._arrays import as_flag, as_plain_array, as_workers
from delone.counting import agreed
from delone.errors import DtypeError, InputError, ShapeError
from delone.interpolate.values import DUPLICATES, NAN, as_field, chosen, require_finite_values
from delone.interpolate.weights import Weights, rectangular
from delone.sphere.coordinates import queries_of
from delone.sphere.delaunay import Delaunay
from delone.sphere.outside import arc_weights

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.interpolate.values import Field

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]

__all__ = ["Linear", "Nearest"]

_NAMED = 5


class _Interpolator:
    """Sites, fields and policies; the base of the public classes."""

    EXTRAPOLATE: ClassVar[tuple[str, ...]] = ("nan", "nearest", "raise")

    def __init__(
        self,
        points: ArrayLike | Delaunay,
        values: ArrayLike | None = None,
        *,
        extrapolate: str = "nan",
        duplicates: str = "raise",
        nan: str = "raise",
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        self._extrapolate = chosen("extrapolate", extrapolate, self.EXTRAPOLATE)
        self._duplicates = chosen("duplicates", duplicates, DUPLICATES)
        self._nan = chosen("nan", nan, NAN)
        as_workers(workers)
        self._workers = workers
        as_flag(degrees, name="degrees")
        self._all: Delaunay = (
            points if isinstance(points, Delaunay) else _triangulated(points, degrees, workers)
        )
        self._degrees = self._all._degrees
        self._mesh = self._all
        self._kept: Rows | None = None
        self._field: tuple[Field, _Interpolator, Floats] | None = None
        self._other: _Interpolator | None = None
        if values is not None:
            field = as_field(values, self.npoints)
            owner = self._for(field)
            self._field = (field, owner, owner.settled(field))

    @property
    def npoints(self) -> int:
        """Number of sites given, including duplicates and dropped ones."""
        return self._all.npoints

    @property
    def workers(self) -> int | None:
        """Number of threads; None for one per core."""
        return self._workers

    @property
    def triangulation(self) -> Delaunay:
        """The triangulation of the sites, without those that ``nan="drop"`` removed."""
        return self._mesh if self._field is None else self._field[1]._mesh

    def __call__(self, xi: ArrayLike, *, values: ArrayLike | None = None) -> NDArray[Any]:
        """Interpolate.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length. NaN
            and vectors of length zero give NaN.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites; by default the values given to the constructor.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, without their last axis, followed by that of one value.

        Raises
        ------
        DirectionError
            A latitude is beyond a pole, or a longitude has more than three turns.
        ShapeError, DtypeError
            `xi` or `values` have the wrong shape, or are not numeric.
        NonFiniteError
            A value is not finite and ``nan="raise"``.
        InputError
            No values were given; duplicates have different values; a query is outside the hull and
            ``extrapolate="raise"``.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(170, 0), (-170, 0), (180, 10), (180, -10)]
        >>> sphere.Linear(sites, [1.0, 3.0, 2.0, 2.0])([(180, 0), (-180, 0), (0, 0)])
        array([ 2.,  2., nan])
        """
        if values is not None:
            field = as_field(values, self.npoints)
            owner = self._for(field)
            columns = owner.settled(field)
        elif self._field is not None:
            field, owner, columns = self._field
        else:
            raise InputError("no values: pass them to the constructor or to the call")
        table = owner._table(xi)
        found = _core.combine2(
            table.indptr, table.rows, table.weights, columns, None, None, as_workers(self._workers)
        )
        return field.shaped(found, table.shape)

    def weights(self, xi: ArrayLike) -> Weights:
        """Return the sites that contribute to each query, with their weights.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.

        Returns
        -------
        delone.interpolate.Weights
            A table that interpolates any number of fields, with one product for each.

        Raises
        ------
        DirectionError, ShapeError, DtypeError
            As for values.
        InputError
            A query is outside the hull and ``extrapolate="raise"``.

        Examples
        --------
        >>> from delone import sphere
        >>> table = sphere.Linear([(170, 0), (-170, 0), (180, 10)]).weights([(180, 0), (170, 0)])
        >>> (table @ [1.0, 3.0, 9.0]).round(9), (table @ [0.0, 8.0, 9.0]).round(9)
        (array([2., 1.]), array([4., 0.]))
        """
        return (self if self._field is None else self._field[1])._table(xi)

    def settled(self, field: Field) -> Floats:
        """Return values for the vertices, after the policies."""
        if self._kept is not None:
            field = field.at(self._kept)
        if self._nan == "raise":
            require_finite_values(field)
        return field.merged(self._mesh.duplicate_of, self._duplicates).columns

    def gradients(self, columns: Floats) -> None:
        """Return None: no method here needs gradients."""

    def caller_rows(self) -> Indices:
        """Return the caller's row for each row of the mesh."""
        rows = np.arange(self._mesh.npoints, dtype=np.int32)
        if self._duplicates == "last":
            # Assignments to the same row happen in order, so the last one wins.
            rows[self._mesh.duplicate_of] = rows.copy()
        return self._as_given(rows)

    def mixed_rows(self) -> tuple[Rows, Indices] | None:
        """Return the groups of the caller's rows that are averaged; None if none are."""
        if self._duplicates not in ("mean", "min", "max") or not len(self._mesh.duplicates):
            return None
        if self._duplicates != "mean":
            raise InputError(
                f"duplicates={self._duplicates!r} selects one value of the points that coincide, "
                "which depends on the values; use apply"
            )
        # The rows of a group are adjacent in `order`; each of its rows lists the whole group.
        first = self._mesh.duplicate_of
        order = np.argsort(first, kind="stable")
        starts = np.searchsorted(first[order], first)
        counts = np.bincount(first)[first]
        indptr = np.concatenate(([0], np.cumsum(counts)))
        within = np.arange(indptr[-1]) - np.repeat(indptr[:-1] - starts, counts)
        return indptr, self._as_given(order[within])

    def _as_given(self, rows: NDArray[np.integer]) -> Indices:
        """The caller's rows for the given rows of the mesh."""
        return (rows if self._kept is None else self._kept[rows]).astype(np.int32)

    def _for(self, field: Field) -> _Interpolator:
        """The interpolator without the sites that ``nan="drop"`` removes for a field."""
        dropped = field.not_finite
        if self._nan != "drop" or not dropped.size:
            return self
        kept = np.delete(np.arange(self.npoints), dropped)
        other = self._other
        if other is None or other._kept is None or not np.array_equal(other._kept, kept):
            other = copy.copy(self)
            other._kept, other._field, other._other = kept, None, None
            vectors = self._all.vectors[kept]
            other._mesh = Delaunay(xyz=vectors, degrees=self._degrees, workers=self._workers)
            self._other = other
        return other

    def _table(self, xi: ArrayLike) -> Weights:
        """Weights of the sites in the mesh."""
        queries = queries_of(xi, degrees=self._degrees, workers=self._workers)
        shape = queries.shape[:-1]
        flat = queries.reshape(-1, 3)
        known = np.flatnonzero(np.isfinite(flat).all(axis=1) & flat.any(axis=1))
        rows, weights = self._weighted(flat[known], known, len(flat))
        all_rows = np.zeros((len(flat), rows.shape[1]), dtype=np.int32)
        all_weights = np.full(all_rows.shape, np.nan)
        all_rows[known], all_weights[known] = rows, weights
        return Weights(*rectangular(all_rows, all_weights), shape, self)

    def _weighted(self, queries: Floats, names: Rows, count: int) -> tuple[Indices, Floats]:
        """Rows of the mesh and weights for directions, (k, m); NaN for no result.

        Errors use `names`, the numbers of the queries among `count`.
        """
        raise NotImplementedError

    def _inside(self, queries: Floats, names: Rows, count: int) -> Indices:
        """The triangle of each query, -1 outside; raises if that is the policy."""
        simplex = self._mesh.find_simplex(queries)
        missed = names[simplex < 0]
        if self._extrapolate != "raise" or not missed.size:
            return simplex
        first = ", ".join(map(str, missed[:_NAMED].tolist()))
        more = ", ..." if len(missed) > _NAMED else ""
        raise InputError(
            f"xi: {len(missed)} of {count} {agreed(count, 'query', 'queries')} "
            f"{agreed(len(missed), 'is', 'are')} outside the hull: "
            f"{agreed(len(missed), 'row', 'rows')} {first}{more}; "
            "choose extrapolate='nan' or 'nearest'"
        )

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"_other": None}

    def __repr__(self) -> str:
        return f"<{type(self).__name__} on {self.triangulation!r}>"


class Linear(_Interpolator):
    """Piecewise linear interpolation on the triangles of a sphere.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Sites: longitudes and latitudes, or vectors of any length; or their triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nan", "nearest", "raise"}, optional
        Behavior outside of a hull: NaN; the value at the nearest point of the hull; an error.
    duplicates : {"raise", "mean", "first", "last", "min", "max"}, optional
        The value of sites that have the same direction but different values.
    nan : {"raise", "drop", "propagate"}, optional
        How to treat sites whose value is NaN or infinite: raise an error that names them; remove
        them from the triangulation; keep them, so that the triangles at them have no value.
    degrees : bool, optional
        Whether longitudes and latitudes, of sites and queries, are in degrees (the default) or in
        radians; that of the triangulation, if one is given.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Raises
    ------
    InputError
        An argument is not one of its choices; values differ at a direction with
        ``duplicates="raise"`` (`ConflictingValuesError`).
    NonFiniteError
        A coordinate, or with ``nan="raise"`` a value, is NaN or infinite.
    DegenerateInputError
        Fewer than three directions are distinct, or all are on one great circle.
    DirectionError
        A vector is zero, a latitude is beyond a pole, or a longitude has more than three turns.
    ShapeError, DtypeError
        Arrays have the wrong shape, or are not numeric.

    Notes
    -----
    The weight of a corner is proportional to the determinant of the query and the other two
    corners: the barycentric weights of the point where the ray to the query meets the plane of the
    corners. They are continuous, the date line and the poles included. At a site the value is
    reproduced exactly, bit for bit; constants are reproduced up to rounding, and smooth functions
    up to the square of the length of the edges.

    Triangles are found exactly. Weights are rounded, from rounded unit vectors: across a triangle
    whose height is below about 1e-15 they are arbitrary, but not negative. Each query costs its
    point location; outside of a hull, ``extrapolate="nearest"`` compares all edges of the boundary.

    See Also
    --------
    delone.interpolate.Linear : The same in the plane and in 3-D.

    Examples
    --------
    >>> from delone import sphere
    >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
    >>> warmth = sphere.Linear(sites, [-30.0, 25.0, 27.0, 28.0, 26.0, -50.0])
    >>> warmth([(90, 0), (45, 0), (0, -90)])
    array([ 27.,  26., -50.])
    >>> warmth([0, 0, 1])
    array(-30.)
    """

    def _weighted(self, queries: Floats, names: Rows, count: int) -> tuple[Indices, Floats]:
        simplex = self._inside(queries, names, count)
        units = _core.sphere_units(queries, as_workers(self._workers))
        rows = self._mesh.simplices[simplex]
        weights = _barycentric(self._mesh.points, rows, units)
        lost = np.flatnonzero((simplex >= 0) & np.isnan(weights[:, 0]))
        if lost.size:
            # The corners are one point after rounding.
            rows[lost] = self._mesh.nearest(queries[lost])[:, None]
            weights[lost] = (1.0, 0.0, 0.0)
        outside = np.flatnonzero(simplex < 0)
        weights[outside] = np.nan
        if self._extrapolate == "nearest" and outside.size:
            ends, shares = arc_weights(self._mesh.points, self._mesh.boundary, units[outside])
            rows[outside, :2], weights[outside, :2] = ends, shares
            weights[outside, 2] = 0.0
        return rows, weights


class Nearest(_Interpolator):
    """The value of the site at the smallest angle.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Sites: longitudes and latitudes, or vectors of any length; or their triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nearest", "nan", "raise"}, optional
        Behavior outside of a hull: the value of the nearest site, as inside; NaN; an error.
    duplicates, nan, degrees, workers
        As in `Linear`.

    Raises
    ------
    InputError, NonFiniteError, DegenerateInputError, DirectionError, ShapeError, DtypeError
        As in `Linear`.

    Notes
    -----
    The nearest site is exact, square roots included; of equally near sites the one with the
    smallest row is used.

    See Also
    --------
    delone.interpolate.Nearest : The same in the plane and in 3-D.

    Examples
    --------
    >>> from delone import sphere
    >>> kind = sphere.Nearest([(170, 0), (-170, 0), (180, 10), (180, -10)], [10, 20, 30, 40])
    >>> kind([(-171, 1), (0, 89), (float("nan"), 0)])
    array([20., 30., nan])
    """

    EXTRAPOLATE: ClassVar[tuple[str, ...]] = ("nearest", "nan", "raise")

    def __init__(
        self,
        points: ArrayLike | Delaunay,
        values: ArrayLike | None = None,
        *,
        extrapolate: str = "nearest",
        duplicates: str = "raise",
        nan: str = "raise",
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        super().__init__(
            points,
            values,
            extrapolate=extrapolate,
            duplicates=duplicates,
            nan=nan,
            degrees=degrees,
            workers=workers,
        )

    def _weighted(self, queries: Floats, names: Rows, count: int) -> tuple[Indices, Floats]:
        rows = self._mesh.nearest(queries)[:, None]
        weights = np.ones(rows.shape)
        if self._extrapolate != "nearest":
            weights[self._inside(queries, names, count) < 0] = np.nan
        return rows, weights


def _triangulated(points: Any, degrees: bool, workers: int | None) -> Delaunay:
    """The triangulation of longitudes and latitudes, (n, 2), or of vectors, (n, 3)."""
    if hasattr(points, "simplices"):
        raise DtypeError(f"{type(points).__name__} is not a sphere.Delaunay; pass its points")
    shape = as_plain_array(points, "points").shape
    if len(shape) != 2 or shape[1] not in {2, 3}:
        raise ShapeError(f"points must have shape (n, 2) or (n, 3), got {shape}")
    if shape[1] == 2:
        return Delaunay(lonlat=points, degrees=degrees, workers=workers)
    return Delaunay(xyz=points, degrees=degrees, workers=workers)


def _barycentric(points: Floats, rows: Indices, units: Floats) -> Floats:
    """The weights of three corners, (k, 3), at directions; NaN if all vanish.

    From differences to the query, so that a corner that equals it gets all of the weight.
    """
    steps = points[rows] - units[:, None]
    weights = np.empty((len(units), 3))
    for k in range(3):
        normal = np.cross(steps[:, (k + 1) % 3], steps[:, (k + 2) % 3])
        weights[:, k] = np.maximum(np.einsum("kj,kj->k", units, normal), 0.0)
    with np.errstate(invalid="ignore"):
        shares: Floats = weights / weights.sum(axis=1, keepdims=True)
    return shares
