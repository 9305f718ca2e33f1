"""Interpolation on the sphere: linear, by natural neighbors, and by the nearest site.

The base class `_Interpolator` handles policies and fields, as in `delone.interpolate`; a subclass
finds the sites of each query and their weights. The module `vectors` converts these weights to
those of vectors.
"""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_flag, as_plain_array, as_workers
from delone._base.counting import agreed
from delone._base.numbers import as_nonnegative, as_positive
from delone._base.renames import renamed
from delone.errors import DtypeError, InputError, ShapeError
from delone.interpolate.base import as_max_distance, shaped_derivatives
from delone.interpolate.hull import Terms
from delone.interpolate.policies import Policies
from delone.interpolate.values import DUPLICATES, NAN, as_field, differing, no_values, of_field
from delone.interpolate.weights import Weights, joined, rectangular
from delone.sphere.coordinates import numbers_of, queries_of
from delone.sphere.delaunay import Delaunay
from delone.sphere.outside import arc_weights
from delone.sphere.vectors import VectorInterpolation, polar_rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.interpolate.values import Field
    from delone.interpolate.weights import Table

    # A field, and interpolators of parts of its values.
    Parts = tuple[Field, list[tuple[Rows, Any]]]

__all__ = ["Linear", "NaturalNeighbor", "Nearest"]

_NAMED = 5


@renamed(weights="weights_at")
class _Interpolator(VectorInterpolation):
    """Sites, fields and policies; the base of the public classes."""

    EXTRAPOLATE: ClassVar[tuple[str, ...]] = ("nan", "nearest", "raise")

    def __init__(
        self,
        points: ArrayLike | Delaunay,
        values: ArrayLike | None = None,
        *,
        extrapolate: str = "nan",
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        self._extrapolate = as_choice(extrapolate, self.EXTRAPOLATE, name="extrapolate")
        self._tolerance = as_nonnegative(tolerance, name="tolerance")
        self._duplicates = as_choice(duplicates, DUPLICATES, name="duplicates")
        self._nan = as_choice(nan, NAN, name="nan")
        as_workers(workers)
        self._workers = workers
        as_flag(degrees, name="degrees")
        self._all: Delaunay
        self._polar = None
        if isinstance(points, Delaunay):
            self._all = points
        else:
            self._all, lonlat = _triangulated(points, degrees, workers)
            if lonlat is not None:
                self._polar = polar_rows(lonlat, self._all.vectors, degrees)
        self._degrees = self._all._degrees
        self._mesh = self._all
        self._kept: Rows | None = None
        self._field: tuple[Field, _Interpolator, Floats] | None = None
        # Interpolators of the last call that leave rows out, by the rows that they keep.
        self._others: dict[bytes, _Interpolator] = {}
        self._parts: Parts | None = None
        if values is not None:
            field = as_field(values, self.npoints)
            self._parts = self._narrowed(field) if self._differ(field) else None
            if self._parts is None:
                owner = self._for(field)
                self._field = (field, owner, owner._settled(field))

    @property
    def npoints(self) -> int:
        """Number of given sites, including duplicates and dropped ones."""
        return self._all.npoints

    @property
    def workers(self) -> int | None:
        """Number of threads; None for one per core."""
        return self._workers

    @property
    def triangulation(self) -> Delaunay:
        """The triangulation of the sites, without those that ``nan="drop"`` removed.

        If it removed different sites from several fields, there is no such triangulation, and this
        raises InputError.
        """
        self._require_one()
        return self._mesh if self._field is None else self._field[1]._mesh

    def __call__(
        self,
        xi: ArrayLike,
        *,
        values: ArrayLike | None = None,
        max_distance: float | None = None,
    ) -> NDArray[Any]:
        """Interpolate.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length. NaN
            and vectors of length zero give NaN.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites; by default the values given to the constructor.
        max_distance : float, optional
            Queries farther than this angle from the nearest site get NaN; in the unit of
            `distance`. By default, there is no limit.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, without their last axis, followed by that of one value.

        Raises
        ------
        DirectionError
            A latitude is beyond a pole, or a longitude exceeds three turns.
        ShapeError, DtypeError
            `xi` or `values` have the wrong shape, or are not numeric.
        NonFiniteError
            A value is not finite and ``nan="raise"``.
        InputError
            No values were given; duplicates have different values; a query is outside the hull and
            ``extrapolate="raise"``; `max_distance` is negative or NaN.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(170, 0), (-170, 0), (180, 10), (180, -10)]
        >>> warmth = sphere.Linear(sites, [1.0, 3.0, 2.0, 2.0])
        >>> warmth([(180, 0), (-180, 0), (0, 0)])
        array([ 2.,  2., nan])
        >>> warmth([(180, 0), (180, 9)], max_distance=5)
        array([nan,  2.])
        """
        limit = as_max_distance(max_distance)
        if several := self._several(values):
            field, narrow = several
            return field.joined([(k, part(xi, max_distance=limit)) for k, part in narrow])
        field, owner, columns = self._with(values)
        table = owner._table(xi)
        found = _core.combine2(
            table.indptr, table.rows, table.weights, columns, None, None, as_workers(self._workers)
        )
        if limit is not None:
            found[~(owner._distance(xi) <= limit).ravel()] = np.nan
        return field.shaped(found, table.query_shape)

    def distance(self, xi: ArrayLike) -> Floats:
        """Return the angle from each query to the nearest site.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.

        Returns
        -------
        ndarray of float64, shape (...)
            Angles, in degrees unless the constructor was given radians; NaN for NaN and vectors of
            length zero.

        Raises
        ------
        DirectionError, ShapeError, DtypeError
            As for values.

        Notes
        -----
        The nearest site is found exactly; the angle is rounded. Sites that ``nan="drop"`` removed
        are ignored.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(170, 0), (-170, 0), (180, 10)]
        >>> sphere.Linear(sites).distance([(-172, 0), (180, 85)]).round(9)
        array([ 2., 75.])
        """
        self._require_one()
        return (self if self._field is None else self._field[1])._distance(xi)

    def _distance(self, xi: ArrayLike) -> Floats:
        """The angle to the nearest site of the mesh."""
        mesh = self._mesh
        flat, known, shape = self._queries(xi)
        found = np.full(len(flat), np.nan)
        rows = mesh.nearest(flat[known])
        units = _core.sphere_units(flat[known], as_workers(self._workers))
        step = units - mesh.points[rows]
        angle = 2 * np.arcsin(np.minimum(np.sqrt(np.einsum("kj,kj->k", step, step)) / 2, 1.0))
        found[known] = np.degrees(angle) if self._degrees else angle
        return found.reshape(shape)

    def weights_at(self, xi: ArrayLike) -> Weights:
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
        >>> table = sphere.Linear([(170, 0), (-170, 0), (180, 10)]).weights_at([(180, 0), (170, 0)])
        >>> (table @ [1.0, 3.0, 9.0]).round(9), (table @ [0.0, 8.0, 9.0]).round(9)
        (array([2., 1.]), array([4., 0.]))
        """
        self._require_one()
        return (self if self._field is None else self._field[1])._table(xi)

    @property
    def _policies(self) -> Policies:
        """How values are treated, and which of the caller's rows a table refers to."""
        mesh = self._mesh
        return Policies(
            npoints=self.npoints,
            workers=self._workers,
            duplicates=self._duplicates,
            nan=self._nan,
            kept=self._kept,
            first=mesh.duplicate_of if len(mesh.duplicates) else None,
            count=mesh.npoints,
        )

    def _settled(self, field: Field) -> Floats:
        """Return values of the vertices, after applying the policies."""
        return self._policies._settled(field)

    def _gradients(self, columns: Floats) -> None:
        """Return None: no method here needs gradients at the sites."""

    def _with(self, values: ArrayLike | None) -> tuple[Field, _Interpolator, Floats]:
        """Return the field, the interpolator of its sites, and its values after the policies."""
        if values is not None:
            field = as_field(values, self.npoints)
            owner = self._for(field)
            return field, owner, owner._settled(field)
        if self._field is None:
            raise no_values()
        return self._field

    def _for(self, field: Field) -> _Interpolator:
        """The interpolator without the sites that ``nan="drop"`` removes for a field."""
        dropped = field.not_finite
        if self._nan != "drop" or not dropped.size:
            return self
        owner = self._without(np.delete(np.arange(self.npoints), dropped))
        assert owner._kept is not None
        self._others = {owner._kept.tobytes(): owner}
        return owner

    def _without(self, kept: Rows) -> _Interpolator:
        """The interpolator of some rows, without values."""
        other = self._others.get(kept.tobytes())
        if other is None:
            other = copy.copy(self)
            other._kept, other._field, other._others, other._parts = kept, None, {}, None
            vectors = self._all.vectors[kept]
            other._mesh = Delaunay(xyz=vectors, degrees=self._degrees, workers=self._workers)
        return other

    def _differ(self, field: Field) -> bool:
        """Whether ``nan="drop"`` removes different sites from the values of a field."""
        return self._nan == "drop" and len(field.patterns()) > 1

    def _several(self, values: ArrayLike | None) -> Parts | None:
        """Return parts of a field that drop different sites for NaN; None if all drop the same."""
        if values is None or self._nan != "drop":
            return self._parts if values is None else None
        field = as_field(values, self.npoints)
        return self._narrowed(field) if self._differ(field) else None

    def _narrowed(self, field: Field) -> Parts:
        """Return, for each pattern of missing values, an interpolator with its values."""
        found: list[tuple[Rows, Any]] = []
        used: dict[bytes, _Interpolator] = {}
        for which in field.patterns():
            part, narrow = field.only(which), copy.copy(self)
            dropped = part.not_finite
            owner: _Interpolator = self
            with of_field(which[0]):
                if dropped.size:
                    kept = np.delete(np.arange(self.npoints), dropped)
                    owner = used[kept.tobytes()] = self._without(kept)
                narrow._field = part, owner, owner._settled(part)
            narrow._parts = None
            found.append((which, narrow))
        self._others = used
        return field, found

    def _require_one(self) -> None:
        """Raise if fields have different sites: the result depends on the sites."""
        if self._parts is not None:
            raise differing(len(self._parts[1]))

    def _queries(self, xi: ArrayLike) -> tuple[Floats, Rows, tuple[int, ...]]:
        """Return vectors of queries, (k, 3), the rows with a direction, and the leading shape."""
        queries = queries_of(xi, degrees=self._degrees, workers=self._workers)
        flat = queries.reshape(-1, 3)
        known = np.flatnonzero(np.isfinite(flat).all(axis=1) & flat.any(axis=1))
        return flat, known, queries.shape[:-1]

    def _table(self, xi: ArrayLike) -> Weights:
        """Weights of the sites in the mesh."""
        flat, known, shape = self._queries(xi)
        indptr, rows, weights, _ = self._weighted(flat[known], known, len(flat))
        counts = np.zeros(len(flat) + 1, dtype=np.int64)
        counts[known + 1] = np.diff(indptr)
        return Weights(np.cumsum(counts), rows, weights, None, shape, self)

    def _weighted(self, queries: Floats, names: Rows, count: int) -> Table:
        """Return rows of the mesh and weights for directions; none where there is no result.

        Errors use `names`, the numbers of these queries among all `count`.
        """
        raise NotImplementedError

    def _inside(self, queries: Floats, names: Rows, count: int) -> tuple[Indices, Bools]:
        """Return the triangle of each query, -1 outside, and which of those the tolerance includes.

        Raise if others are outside and the policy is to raise.
        """
        simplex, near = self._mesh.find_simplex(queries), np.zeros(len(queries), dtype=bool)
        if self._tolerance and not self._mesh.covers_sphere:
            near[self._mesh._nearby(queries, simplex, self._tolerance)[0]] = True
        missed = names[(simplex < 0) & ~near]
        if self._extrapolate != "raise" or not missed.size:
            return simplex, near
        first = ", ".join(map(str, missed[:_NAMED].tolist()))
        more = ", ..." if len(missed) > _NAMED else ""
        raise InputError(
            f"xi: {len(missed)} of {count} {agreed(count, 'query', 'queries')} "
            f"{agreed(len(missed), 'is', 'are')} outside the hull: "
            f"{agreed(len(missed), 'row', 'rows')} {first}{more}; "
            "choose extrapolate='nan' or 'nearest'"
        )

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"_others": {}}

    def __repr__(self) -> str:
        owner = self if self._field is None else self._field[1]
        return f"<{type(self).__name__} on {owner._mesh!r}>"


class _Continuous(_Interpolator):
    """Interpolants whose weights, and their derivatives, the core computes."""

    _kind: str

    def gradient(
        self, xi: ArrayLike, *, values: ArrayLike | None = None, radius: float = 1.0
    ) -> NDArray[Any]:
        """Return the gradient of the interpolant, a tangent vector.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites.
        radius : float, optional
            Radius of the sphere. By default 1: derivatives are per radian, whatever the unit of
            longitudes and latitudes. With 6371008.8, they are per meter on the Earth.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, without their last axis, then that of one value, then 2: the
            derivatives to the east and north. NaN outside a hull. At a pole, east and north are
            those of the meridian of longitude 0.

        Raises
        ------
        InputError
            `radius` is not positive; or as for values.
        DirectionError, ShapeError, DtypeError, NonFiniteError
            As for values.

        Notes
        -----
        The derivatives are those of the weights, by automatic differentiation. On an edge, where a
        linear interpolant has several gradients, the result is that of the triangle with the
        smallest number. At a site, natural neighbor interpolants have no gradient: it is NaN.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(170, 0), (-170, 0), (180, 10), (180, -10)]
        >>> per_radian = sphere.Linear(sites, [1.0, 3.0, 2.0, 2.0]).gradient((180, 1))
        >>> per_radian.round(3), (per_radian / 6371.0).round(6)
        (array([5.672, 0.   ]), array([0.00089, 0.     ]))
        """
        radius = as_positive(radius, name="radius", finite=True)
        if several := self._several(values):
            field, narrow = several
            return field.joined([(k, part.gradient(xi, radius=radius)) for k, part in narrow], 1)
        field, owner, columns = self._with(values)
        assert isinstance(owner, _Continuous)
        flat, known, shape = self._queries(xi)
        simplex = np.full(len(flat), -1, dtype=np.int32)
        simplex[known], _ = owner._inside(flat[known], known, len(flat))
        threads = as_workers(self._workers)
        found = owner._mesh._locator.weights(self._kind, flat, simplex, True, threads)
        slopes = found.slopes
        assert slopes is not None
        parts = [
            _core.combine2(found.indptr, found.indices, part, columns, None, None, threads)
            for part in np.ascontiguousarray(slopes.T)
        ]
        return shaped_derivatives(np.stack(parts, axis=-1) / radius, field, shape)

    def _weighted(self, queries: Floats, names: Rows, count: int) -> Table:
        simplex, near = self._inside(queries, names, count)
        threads = as_workers(self._workers)
        found = self._mesh._locator.weights(self._kind, queries, simplex, False, threads)
        inner = (found.indptr, found.indices, found.weights, None)
        empty = np.flatnonzero(np.diff(found.indptr) == 0)
        if self._extrapolate != "nearest":
            empty = empty[(simplex[empty] >= 0) | near[empty]]
        if not empty.size:
            return inner
        return joined(inner, empty, self._completed(queries[empty], simplex[empty]))

    def _completed(self, queries: Floats, simplex: Indices) -> Terms:
        """Return weights of queries outside, and of those whose corners coincide when rounded."""
        rows = np.zeros((len(queries), 2), dtype=np.int32)
        weights = np.zeros(rows.shape)
        lost = simplex >= 0
        rows[lost] = self._mesh.nearest(queries[lost])[:, None]
        weights[lost] = (1.0, 0.0)
        if not lost.all():
            units = _core.sphere_units(queries[~lost], as_workers(self._workers))
            arcs = arc_weights(self._mesh.points, self._mesh.boundary, units)
            rows[~lost], weights[~lost] = arcs
        return Terms(rows, weights, None)


class Linear(_Continuous):
    """Piecewise linear interpolation on the triangles of a sphere.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Sites: longitudes and latitudes, or vectors of any length; or their triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nan", "nearest", "raise"}, optional
        Behavior outside a hull: NaN; the value at the nearest point of the hull; an error.
    tolerance : float, optional
        Queries outside a hull, at most this angle from its boundary, get the value at its nearest
        point; in degrees or radians, as `degrees` says, and decided exactly. Gradients there are
        NaN.
    duplicates : {"raise", "mean", "first", "last", "min", "max"}, optional
        The value of sites that have the same direction but different values.
    nan : {"raise", "drop", "propagate"}, optional
        How to treat sites whose value is NaN or infinite: raise an error that names them; remove
        them from the triangulation; or keep them, so that the triangles at them give NaN.
    degrees : bool, optional
        Whether longitudes and latitudes of sites and queries are in degrees (the default) or in
        radians. If a triangulation is given, its unit is used instead.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Raises
    ------
    InputError
        An argument is not one of the allowed choices; sites with the same direction have different
        values and ``duplicates="raise"`` (`ConflictingValuesError`).
    NonFiniteError
        A coordinate, or with ``nan="raise"`` a value, is NaN or infinite.
    DegenerateInputError
        There are fewer than three distinct directions, or all are on one great circle.
    DirectionError
        A vector is zero, a latitude is beyond a pole, or a longitude exceeds three turns.
    ShapeError, DtypeError
        Arrays have the wrong shape, or are not numeric.

    Notes
    -----
    The weight of a corner is proportional to the determinant of the query and the other two
    corners: the barycentric weights of the point where the ray to the query meets the plane of the
    corners. They are continuous, including at the date line and the poles. At a site, the value is
    reproduced exactly, bit for bit. Constants are reproduced up to rounding, and smooth functions
    with an error proportional to the square of the edge length.

    Triangles are found exactly. Weights are rounded, from rounded unit vectors: across a triangle
    whose height is below about 1e-15 they are arbitrary, but not negative. The cost of a
    query is that of locating it; outside a hull, ``extrapolate="nearest"`` compares all edges of
    the boundary.

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

    _kind = "linear"


class NaturalNeighbor(_Continuous):
    """Natural neighbor interpolation on the sphere.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Sites: longitudes and latitudes, or vectors of any length; or their triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    kind : {"sibson", "laplace"}, optional
        Sibson's weights by area, C1 except at the sites; or Laplace's by length, continuous and
        faster.
    extrapolate, tolerance, duplicates, nan, degrees, workers
        As in `Linear`.

    Raises
    ------
    InputError, NonFiniteError, DegenerateInputError, DirectionError, ShapeError, DtypeError
        As in `Linear`.

    Notes
    -----
    The neighbors are the corners of all triangles whose circle contains the query, exactly. Their
    weights are those of the plane after projection from the center to the tangent plane at the
    query, where great circles are lines. They depend on the area that the Voronoi cell of the
    query takes from that of the neighbor, or on the length of their common side. They are
    nonnegative and sum to 1, and the weighted mean of the sites has the direction of the query, as
    with `Linear`; on the boundary of a hull, the interpolant is linear. So the date line and the
    poles are not special, and you need not choose a projection. Values at sites are reproduced
    exactly. Where rounding loses more than nine digits, as between sites that almost coincide, the
    weights are those of `Linear`.

    Each query takes time linear in the number of its neighbors, about six.

    References
    ----------
    R. Sibson, "A vector identity for the Dirichlet tessellation", 1980; T. Langer, A. Belyaev and
    H.-P. Seidel, "Spherical barycentric coordinates", 2006.

    See Also
    --------
    delone.interpolate.NaturalNeighbor : The same in the plane and in 3-D.

    Examples
    --------
    >>> from delone import sphere
    >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
    >>> warmth = sphere.NaturalNeighbor(sites, [-30.0, 25.0, 27.0, 28.0, 26.0, -50.0])
    >>> warmth([(90, 0), (45, 0), (180, 45)]).round(2)
    array([27.  , 16.33,  3.03])
    """

    def __init__(
        self,
        points: ArrayLike | Delaunay,
        values: ArrayLike | None = None,
        *,
        kind: str = "sibson",
        extrapolate: str = "nan",
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        self._kind = as_choice(kind, ("sibson", "laplace"), name="kind")
        super().__init__(
            points,
            values,
            extrapolate=extrapolate,
            tolerance=tolerance,
            duplicates=duplicates,
            nan=nan,
            degrees=degrees,
            workers=workers,
        )


class Nearest(_Interpolator):
    """Interpolation by the value of the nearest site, the one at the smallest angle.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or Delaunay
        Sites: longitudes and latitudes, or vectors of any length; or their triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nearest", "nan", "raise"}, optional
        Behavior outside a hull: the value of the nearest site, as inside; NaN; an error.
    tolerance, duplicates, nan, degrees, workers
        As in `Linear`.

    Raises
    ------
    InputError, NonFiniteError, DegenerateInputError, DirectionError, ShapeError, DtypeError
        As in `Linear`.

    Notes
    -----
    The nearest site is found exactly, square roots included; of equally near sites, the one with
    the smallest row is used.

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
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        super().__init__(
            points,
            values,
            extrapolate=extrapolate,
            tolerance=tolerance,
            duplicates=duplicates,
            nan=nan,
            degrees=degrees,
            workers=workers,
        )

    def _weighted(self, queries: Floats, names: Rows, count: int) -> Table:
        rows = self._mesh.nearest(queries)[:, None]
        weights = np.ones(rows.shape)
        if self._extrapolate != "nearest":
            simplex, near = self._inside(queries, names, count)
            weights[(simplex < 0) & ~near] = np.nan
        return rectangular(rows, weights)


def _triangulated(
    points: Any, degrees: bool, workers: int | None
) -> tuple[Delaunay, ArrayLike | None]:
    """Return the triangulation of sites, and their longitudes and latitudes unless vectors."""
    if hasattr(points, "points"):
        raise DtypeError(f"{type(points).__name__} is not a sphere.Delaunay; pass its points")
    points = numbers_of(points, "points")
    shape = as_plain_array(points, "points").shape
    if len(shape) != 2 or shape[1] not in {2, 3}:
        raise ShapeError(f"points must have shape (n, 2) or (n, 3), got {shape}")
    if shape[1] == 2:
        return Delaunay(lonlat=points, degrees=degrees, workers=workers), points
    return Delaunay(xyz=points, degrees=degrees, workers=workers), None
