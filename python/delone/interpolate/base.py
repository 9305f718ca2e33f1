"""Base class of the interpolators: sites, policies for values, queries of any shape.

A subclass computes the interpolant and its derivatives inside the hull (`_derived`), the terms
beyond the hull (`_terms`), and the weights of the sites (`_table`). Everything else is here: the
mesh, the policies for NaN, duplicates and extrapolation, shapes, complex numbers.

There are two kinds of rows of points: the caller's, and those of the mesh, which omits the rows
that ``nan="drop"`` removed.
"""

from __future__ import annotations

import copy
import functools
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_queries, as_workers
from delone._base.counting import agreed
from delone._base.georeference import crs_of, warn_of_degrees
from delone._base.immutable import own_copy
from delone._base.numbers import as_nonnegative
from delone._base.renames import renamed
from delone._tiling import location, measures
from delone._tiling.higher.dimension import MOST
from delone._tiling.plane import slivers, topology
from delone._tiling.triangulation import Triangulation, require_whole
from delone.delaunay import Delaunay
from delone.errors import DtypeError, InputError
from delone.interpolate.hull import summed
from delone.interpolate.policies import Policies
from delone.interpolate.repeated import repeated
from delone.interpolate.space import SPACE
from delone.interpolate.values import (
    DUPLICATES,
    NAN,
    Field,
    as_field,
    differing,
    no_values,
    of_field,
)
from delone.interpolate.weights import joined
from delone.periodic import PeriodicDelaunay

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone._tiling.location import Location
    from delone.interpolate.hull import Terms
    from delone.interpolate.repeated import Repeated
    from delone.interpolate.weights import Table, Weights

    # A field, and interpolators of parts of its values.
    Parts = tuple[Field, list[tuple[Rows, Any]]]

__all__ = ["Interpolator", "Sheet", "as_max_distance", "shaped_derivatives"]

_NAMED = 5
# The maximum number of coordinates; a grid needs no triangulation.
_MOST_COLUMNS = 64
# The fraction of the way to the middle of a triangle at which derivatives at its side are
# evaluated, and how many units in the last place away it must be.
_BEHIND = 2.0**-30
_CLEAR = 64


class Sheet(NamedTuple):
    """Simplices as they are evaluated: without slivers, and cut along constraints if respected."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    locator: Any
    # The edges that nothing crosses, (m, 3).
    barrier: Bools | None = None
    # The row of the mesh for each row; None if they are the same.
    source: Indices | None = None


@renamed(weights="weights_at")
class Interpolator:
    """Interpolation of scattered data; the base of the public classes.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Sites. A delone triangulation is used directly if the method allows it; a periodic one
        makes the interpolant periodic.
    values : array_like, shape (n,) or (n, ...), optional
        Values at the sites.
    extrapolate, tolerance, duplicates, nan, respect_constraints, workers, planar
        As in `Linear`.

    Examples
    --------
    >>> from delone.interpolate import Interpolator, Linear
    >>> isinstance(Linear([(0, 0), (4, 0), (0, 4)]), Interpolator)
    True
    """

    EXTRAPOLATE: ClassVar[tuple[str, ...]] = ("nan", "nearest", "linear", "raise")
    # The maximum number of coordinates of sites.
    _MOST: ClassVar[int] = 3

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        extrapolate: str = "nan",
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        respect_constraints: bool = False,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        self._extrapolate = as_choice(extrapolate, self.EXTRAPOLATE, name="extrapolate")
        self._tolerance = as_nonnegative(tolerance, name="tolerance")
        self._duplicates = as_choice(duplicates, DUPLICATES, name="duplicates")
        self._nan = as_choice(nan, NAN, name="nan")
        self._workers = workers
        self._respect_constraints = as_flag(respect_constraints, name="respect_constraints")
        self._cache: dict[str, Any] = {}
        # Interpolators of the last call that leave rows out, by the rows that they keep.
        self._others: dict[bytes, Any] = {}
        self._parts: Parts | None = None
        as_workers(workers)
        given = points if isinstance(points, Triangulation) else None
        require_whole(given, "interpolation")
        self._periodic = points if isinstance(points, PeriodicDelaunay) else None
        self._repeated: Repeated | None = None
        known = given if self._periodic is None else self._periodic
        self._sites: Floats = _own(points) if known is None else known.points
        self._crs = crs_of(points) if known is None else known.crs
        if known is None:
            warn_of_degrees(points, self._sites, planar=planar)
        if self._ndim > SPACE:
            self._check_higher()
        elif self._ndim == SPACE:
            self._check_space(given)
        self._constrained = getattr(given, "constrained", None) is not None
        field = None if values is None else as_field(values, len(self._sites))
        # The points alone do not determine any other kind of triangulation.
        self._given = None if isinstance(given, Delaunay) else given
        several = field is not None and self._nan == "drop" and len(field.patterns()) > 1
        self._kept = None if several else self._kept_rows(field)
        self._held: Triangulation | None = (
            self._tiled() if given is None or self._kept is not None else given
        )
        if field is not None and several:
            self._field, self._parts = None, (field, self._narrowed(field))
        else:
            self._field = None if field is None else (field, self._settled(field))

    @property
    def _ndim(self) -> int:
        """Number of coordinates."""
        return int(self._sites.shape[1])

    @property
    def _mesh(self) -> Triangulation:
        """The triangulation; made now if values do not need it."""
        if self._held is None:
            self._held = self._triangulated()
        return self._held

    @property
    def triangulation(self) -> Triangulation:
        """The triangulation of the sites, without those that ``nan="drop"`` removed.

        For periodic sites, that of as many copies as are needed; the copies of a site are adjacent.
        If it removed different sites from several fields, there is no such triangulation, and this
        raises InputError.
        """
        self._require_one()
        return self._mesh

    @property
    def _box(self) -> tuple[list[float], list[float]]:
        """Smallest and largest coordinates of the sites; for periodic sites, one period."""
        low, high = self._mesh.min_bound.copy(), self._mesh.max_bound.copy()
        if self._repeated is not None:
            for axis, length in enumerate(self._repeated.periods):
                if length is not None:
                    low[axis] = self._repeated.low[axis]
                    high[axis] = low[axis] + length
        return low.tolist(), high.tolist()

    @property
    def npoints(self) -> int:
        """Number of sites given, including duplicates and dropped ones."""
        return len(self._sites)

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
        xi : array_like, shape (..., d)
            Queries. NaN gives NaN; so does infinity, unless ``extrapolate="raise"`` rejects it.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites; by default the values given to the constructor.
        max_distance : float, optional
            Queries farther than this from the nearest site get NaN; by default there is no limit.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries followed by the shape of one value.

        Raises
        ------
        ShapeError, DtypeError
            `xi` or `values` have the wrong shape, or are not numeric.
        NonFiniteError
            A value is not finite and ``nan="raise"``.
        InputError
            No values were given; duplicates have different values; a query (infinity included) is
            outside the hull and ``extrapolate="raise"``; `max_distance` is negative or NaN.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> height = Linear([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0])
        >>> height([(1, 1), (9, 9)])
        array([ 4., nan])
        >>> height((1, 1), values=[0.0, 0.0, 8.0])
        array(2.)
        >>> height([(1, 1), (2, 2)], max_distance=2)
        array([ 4., nan])
        """
        limit = as_max_distance(max_distance)
        if several := self._several(values):
            field, narrow = several
            return field.joined([(k, part(xi, max_distance=limit)) for k, part in narrow])
        interpolator, field, columns = self._with(values)
        queries, shape = interpolator._queries(xi)
        found = interpolator._interpolated(queries, columns)
        if limit is not None:
            found[~(interpolator._distance(queries) <= limit)] = np.nan
        return field.shaped(found, shape)

    def distance(self, xi: ArrayLike) -> Floats:
        """Return the distance from each query to the nearest site.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Queries.

        Returns
        -------
        ndarray of float64, shape (...)
            Distances in the units of the sites; NaN where a coordinate is NaN or infinite.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of points with the dimension of the sites.

        Notes
        -----
        The nearest site is found exactly; the distance is rounded. Sites that ``nan="drop"``
        removed are ignored.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> Linear([(0, 0), (4, 0), (0, 4)]).distance([(1, 0), (7, 4)])
        array([1., 5.])
        """
        self._require_one()
        queries, shape = self._queries(xi)
        return self._distance(queries).reshape(shape)

    def _distance(self, flat: Floats) -> Floats:
        mesh = self._mesh
        rows = location.nearest(mesh._dimension, mesh._sites, flat, self._workers)
        with np.errstate(over="ignore", invalid="ignore"):
            step = flat - mesh.points[rows]
            found = functools.reduce(np.hypot, step.T)
        return np.where(rows >= 0, found, np.nan)

    def gradient(self, xi: ArrayLike, *, values: ArrayLike | None = None) -> NDArray[Any]:
        """Return the gradient of the interpolant.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Queries.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, then that of one value, then d: the derivatives by x and y,
            and in 3-D by z. Outside the hull NaN or, with ``extrapolate="linear"``, the gradient of
            the extrapolation.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError, InputError
            As for values; or the method has no derivatives, such as natural neighbors in 3-D.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> height = Linear([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0])
        >>> height.gradient([(1, 1), (9, 9)])
        array([[ 1.,  2.],
               [nan, nan]])
        """
        if several := self._several(values):
            field, narrow = several
            return field.joined([(k, part.gradient(xi)) for k, part in narrow], 1)
        interpolator, field, columns = self._with(values)
        queries, shape = interpolator._queries(xi)
        return shaped_derivatives(interpolator._sloped(queries, columns), field, shape)

    def weights_at(self, xi: ArrayLike) -> Weights:
        """Return the sites that contribute to each query, with their weights.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Queries.

        Returns
        -------
        Weights
            A table that interpolates any number of fields, with one product for each.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of points with the dimension of the sites.
        InputError
            A query is outside the hull and ``extrapolate="raise"``.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> table = Linear([(0, 0), (4, 0), (0, 4)]).weights_at([(1, 1), (2, 2)])
        >>> table @ [1.0, 5.0, 9.0], table @ [0.0, 0.0, 8.0]
        (array([4., 7.]), array([2., 4.]))
        """
        self._require_one()
        return self._table(*self._queries(xi))

    # Implemented by subclasses.

    def _check_space(self, given: Triangulation | None) -> None:
        """Raise for what is only available in 2-D."""

    def _check_higher(self) -> None:
        """Reject options that need the nearest points of the hull, or that 4-D and higher lack."""
        if self._ndim > self._MOST:
            others = "Linear and Nearest accept" if self._ndim <= MOST else "Linear accepts"
            raise InputError(
                f"{type(self).__name__} is only available with up to {self._MOST} coordinates: "
                f"{others} points with {self._ndim}"
            )
        if self._tolerance or self._extrapolate == "linear":
            option = "tolerance" if self._tolerance else f"extrapolate={self._extrapolate!r}"
            raise InputError(
                f"{option} is only available in 2-D and 3-D, and the points have {self._ndim} "
                "coordinates; extrapolate='nearest' has a value everywhere"
            )

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        """Values (k, c), derivatives (k, c, d) or second ones (k, c, 3); NaN outside."""
        raise NotImplementedError

    def _terms(self, place: Any, step: Floats, base: bool) -> Terms:
        """The terms for a step away from the nearest points of the hull."""
        raise NotImplementedError

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        """Weights for the rows of `settled`."""
        raise NotImplementedError

    def _gradients(self, columns: Floats) -> Floats | None:
        """Return gradients at the sites, or None if the interpolant needs none.

        Parameters
        ----------
        columns : ndarray of float64, shape (n, c)
            Values at the sites, as `settled` returns them.

        Returns
        -------
        ndarray of float64, shape (n, c, 2), or None
            Derivatives by x and y.
        """
        return None

    def _needed(self) -> dict[str, bool]:
        """The arguments of `repeated` that say how far periodic sites must be copied."""
        return {}

    # Shared by subclasses.

    def _queries(self, xi: ArrayLike) -> tuple[Floats, tuple[int, ...]]:
        """Flattened queries, moved into the period of the sites, and their leading axes."""
        queries = as_queries(xi, self._ndim, self._crs)
        flat = queries.reshape(-1, self._ndim)
        return flat if self._repeated is None else self._repeated.wrapped(flat), queries.shape[:-1]

    @property
    def crs(self) -> str | None:
        """The reference system of the sites, if they declared one, as a GeoDataFrame does."""
        return self._crs

    @property
    def workers(self) -> int | None:
        """Number of threads; None for one per core."""
        return self._workers

    @property
    def _policies(self) -> Policies:
        """How values are treated, and which of the caller's rows a table refers to."""
        if "policies" not in self._cache:
            again = self._repeated
            first = self._first_rows() if again is None else again.duplicate_of
            coincide = (first != np.arange(len(first))).any()
            self._cache["policies"] = Policies(
                npoints=self.npoints,
                workers=self._workers,
                duplicates=self._duplicates,
                nan=self._nan,
                kept=self._kept,
                # Of periodic sites, not of copies: rounding may make those of others equal.
                first=first if coincide else None,
                count=len(first),
                copies=1 if again is None else len(again.moves),
                source=self._source,
            )
        made: Policies = self._cache["policies"]
        return made

    @property
    def _source(self) -> Indices | None:
        """The vertex for each row of a table; None if they are the same."""
        return None

    def _settled(self, field: Field) -> Floats:
        """Apply the policies and return values for the rows of a table.

        Parameters
        ----------
        field : Field
            Values in the caller's rows.

        Returns
        -------
        ndarray of float64
            One row for each row of a table.

        Raises
        ------
        InputError
            A policy rejects them.
        """
        return self._policies._settled(field)

    def _interpolated(self, queries: Floats, columns: Floats) -> Floats:
        found = self._derived(queries, columns, 0)
        rows, place, _ = self._left(queries, found)
        if rows.size:
            terms = self._terms_beyond(queries[rows], place)
            found[rows] = summed(terms, columns, self._gradients(columns))
        return found

    def _sloped(self, queries: Floats, columns: Floats) -> Floats:
        found = self._derived(queries, columns, 1)
        rows, place, within = self._left(queries, found[..., 0])
        if self._extrapolate != "linear":
            inside = np.flatnonzero(within)
            self._fill_beside(found, columns, 1, rows[inside], place.at(inside))
            return found
        for axis, step in enumerate(np.eye(self._ndim)) if rows.size else ():
            terms = self._terms(place, np.tile(step, (len(rows), 1)), False)
            found[rows, :, axis] = summed(terms, columns, self._gradients(columns))
        return found

    def _fill_beside(
        self, found: Floats, columns: Floats, order: int, rows: Rows, place: Location
    ) -> None:
        """Set derivatives next to the sheet to those just inside its side, in the next simplex."""
        if rows.size:
            sheet = self._sheet
            corners = sheet.points[sheet.simplices[place.beside]]
            middle = (corners / corners.shape[1]).sum(axis=1)
            way = middle - place.closest
            # Far enough that rounding does not bring it back.
            unit = np.spacing(np.abs(middle).max(axis=1)) / np.abs(way).max(axis=1)
            share = np.clip(_CLEAR * unit, _BEHIND, 0.5)
            behind = place.closest + share[:, None] * way
            found[rows] = self._derived(behind, columns, order)

    def _completed(self, table: Table, queries: Floats, known: Floats) -> Table:
        """The table of queries inside, extended by the terms of the others that have some."""
        rows, place, _ = self._left(queries, known)
        return joined(table, rows, self._terms_beyond(queries[rows], place)) if rows.size else table

    def _terms_beyond(self, queries: Floats, place: Any) -> Terms:
        step = queries - place.closest
        if self._extrapolate != "linear":
            step = np.zeros_like(step)
        return self._terms(place, step, True)

    def _left(
        self, queries: Floats, found: Floats | None, *, refuses: bool = True
    ) -> tuple[Rows, Location, Bools]:
        """The finite queries in no triangle of the sheet that have values, with their places.

        Those inside the hull, in slivers or by `tolerance`, are marked; those outside are left out
        if they have no value, and raise if that is the policy and `refuses`.
        """
        suspects = np.arange(len(queries))
        if found is not None and found.shape[1]:
            suspects = np.flatnonzero(np.isnan(found[:, 0]))
        exact = not (self._tolerance or self._skipped().any())
        if self._extrapolate == "nan" and exact:
            suspects = suspects[:0]
        place = self._located(queries[suspects])
        within = np.zeros(len(suspects), dtype=bool)
        if not exact:
            found_in = self._mesh.find_simplex(queries[suspects], tolerance=self._tolerance)
            within = (place.simplex < 0) & (found_in >= 0)
        if self._extrapolate == "raise" and refuses:
            # Not by `beside`, which is -1 for infinite queries and for meshes without triangles.
            missed = (place.simplex < 0) & ~within & ~np.isnan(queries[suspects]).any(axis=1)
            self._refuse(suspects[missed], len(queries))
        taken = place.beside >= 0
        if self._extrapolate == "nan":
            taken &= within
        rows = np.flatnonzero(taken)
        return suspects[rows], place.at(rows), within[rows]

    def _refuse(self, rows: Rows, count: int) -> None:
        if not rows.size:
            return
        first = ", ".join(map(str, rows[:_NAMED].tolist()))
        more = ", ..." if len(rows) > _NAMED else ""
        *most, last = (f"'{each}'" for each in self.EXTRAPOLATE if each != "raise")
        raise InputError(
            f"xi: {len(rows)} of {count} {agreed(count, 'query', 'queries')} "
            f"{agreed(len(rows), 'is', 'are')} outside the hull: "
            f"{agreed(len(rows), 'row', 'rows')} {first}{more}; "
            f"choose extrapolate={', '.join(most)} or {last}"
        )

    def _located(self, queries: Floats) -> Location:
        """Locate queries in the triangles that are evaluated."""
        sheet, dimension = self._sheet, self._mesh._dimension
        return location.locate(dimension, sheet.locator, sheet.points, queries, self._workers)

    @property
    def _sheet(self) -> Sheet:
        if "sheet" not in self._cache:
            self._cache["sheet"] = self._laid_out()
        sheet: Sheet = self._cache["sheet"]
        return sheet

    def _laid_out(self) -> Sheet:
        mesh, skipped = self._mesh, self._skipped()
        if not skipped.any():
            return Sheet(mesh.points, mesh.simplices, mesh.neighbors, mesh._locator)
        left = slivers.without(mesh.simplices, mesh.neighbors, skipped)
        return Sheet(mesh.points, *left, mesh._dimension.locator(mesh.points, *left))

    def _skipped(self) -> Bools:
        """The slivers at the hull, which are not evaluated, or an empty mask.

        Their sides skip sites that lie on a straight side of the hull up to rounding.
        """
        if "skipped" not in self._cache:
            held = self._held if self._ndim == len("xy") else None
            self._cache["skipped"] = (
                np.zeros(0, dtype=bool)
                if held is None
                else slivers.at_outline(held.points, held.simplices, held.neighbors)
            )
        skipped: Bools = self._cache["skipped"]
        return skipped

    def _around(self) -> tuple[Indices, Indices]:
        """Return neighbors of the rows of the sheet, as compressed rows (indptr, indices)."""
        mesh, sheet = self._mesh, self._sheet
        if sheet.simplices is mesh.simplices:
            return mesh.vertex_neighbor_vertices
        if "around" not in self._cache:
            edges = (
                measures.edges(sheet.simplices, sheet.neighbors, mesh.npoints, self._workers)
                if sheet.source is None
                else _sides(sheet.simplices)
            )
            self._cache["around"] = topology.vertex_neighbor_vertices(edges, len(sheet.points))
        around: tuple[Indices, Indices] = self._cache["around"]
        return around

    def _field_of(self, values: ArrayLike | None) -> Field:
        """Return the values as a field, by default those of the constructor.

        Parameters
        ----------
        values : array_like or None
            Values at the sites.

        Returns
        -------
        Field
            Before the policies.

        Raises
        ------
        InputError
            There are none.
        """
        if values is not None:
            return as_field(values, len(self._sites))
        if self._parts is not None:
            return self._parts[0]
        if self._field is None:
            raise no_values()
        return self._field[0]

    def _with(self, values: ArrayLike | None) -> tuple[Self, Field, Floats]:
        """The interpolator, the field, its settled columns; None: the constructor's values."""
        if values is None and self._field is not None:
            return self, *self._field
        field = self._field_of(values)
        kept = self._kept_rows(field)
        if self._nan != "drop" or _same(kept, self._kept):
            return self, field, self._settled(field)
        other = self._without(kept)
        self._others = {_key(kept): other}
        return other, field, other._settled(field)

    def _several(self, values: ArrayLike | None) -> Parts | None:
        """Parts of a field whose sites differ by ``nan="drop"``; None if all have the same."""
        if values is None or self._nan != "drop":
            return self._parts if values is None else None
        field = self._field_of(values)
        return (field, self._narrowed(field)) if len(field.patterns()) > 1 else None

    def _narrowed(self, field: Field) -> list[tuple[Rows, Any]]:
        """An interpolator for each pattern of missing values, with its part of the values."""
        found: list[tuple[Rows, Any]] = []
        used: dict[bytes, Any] = {}
        for which in field.patterns():
            part = field.only(which)
            kept = self._kept_rows(part)
            with of_field(which[0]):
                owner = self._without(kept)
                used[_key(kept)] = owner
                narrow = copy.copy(owner)
                # Gradients are those of a field.
                narrow._cache = {k: v for k, v in owner._cache.items() if k != "gradients"}
                narrow._field = part, narrow._settled(part)
            found.append((which, narrow))
        self._others = used
        return found

    def _without(self, kept: Rows | None) -> Self:
        """The interpolator of some rows, without values."""
        other = self._others.get(_key(kept))
        if other is None:
            other = copy.copy(self)
            other._kept, other._cache, other._others = kept, {}, {}
            other._field, other._parts = None, None
            if not _same(kept, self._kept):
                other._held = other._tiled()
        return other

    def _require_one(self, values: ArrayLike | None = None) -> None:
        """Reject what depends on the sites if fields have different ones."""
        several = self._several(values)
        if several is not None:
            raise differing(len(several[1]))

    def _kept_rows(self, field: Field | None) -> Rows | None:
        if self._nan != "drop" or field is None or not (dropped := field.not_finite).size:
            return None
        return np.delete(np.arange(len(field)), dropped)

    def _first_rows(self) -> Indices:
        """The first row of each site with the same coordinates."""
        return self._mesh.duplicate_of

    def _tiled(self) -> Triangulation | None:
        """The triangulation that values need; None if they need none."""
        return self._triangulated()

    def _triangulated(self) -> Triangulation:
        if self._given is not None:
            return self._given if self._kept is None else _with_only(self._given, self._kept)
        sites = self._sites if self._kept is None else self._sites[self._kept]
        if self._periodic is not None:
            mesh = self._periodic
            if self._kept is not None:
                mesh = PeriodicDelaunay(sites, mesh.periods)
            self._repeated = repeated(mesh, **self._needed())
            sites = self._repeated.copies(sites)
        return Delaunay(sites, workers=self._workers)

    def __getstate__(self) -> dict[str, Any]:
        # Spatial indices are not pickled; they are rebuilt.
        return self.__dict__ | {"_cache": {}, "_others": {}}

    def __repr__(self) -> str:
        return f"<{type(self).__name__} on {self._mesh!r}>"


def _key(kept: Rows | None) -> bytes:
    return b"" if kept is None else kept.tobytes()


def _own(points: Any) -> Floats:
    if hasattr(points, "simplices"):
        raise DtypeError(f"{type(points).__name__} is not a delone triangulation; pass its points")
    return own_copy(points, ndim=None, most=_MOST_COLUMNS)


def _with_only(mesh: Any, kept: Rows) -> Triangulation:
    """A constrained triangulation with some points removed; no constraint may need them."""
    if not hasattr(mesh, "constrained"):
        raise InputError(
            f"nan='drop' would remove points from a {type(mesh).__name__}; choose nan='propagate', "
            "or pass the points that have values"
        )
    dropped = np.delete(np.arange(mesh.npoints), kept)
    needed = np.intersect1d(mesh.duplicate_of[dropped], mesh.segments)
    if not hasattr(mesh, "edit") or mesh.nadded or needed.size:
        rows = dropped[np.isin(mesh.duplicate_of[dropped], needed)]
        first = ", ".join(map(str, rows[:_NAMED].tolist()))
        which = f"; constraints need rows {first}" if rows.size else ""
        raise InputError(
            "nan='drop' would remove vertices from a constrained triangulation" + which
        )
    with mesh.edit() as edit:
        edit.remove_points(dropped)
    result: Triangulation = edit.result
    return result


def as_max_distance(max_distance: float | None) -> float | None:
    """Validate the largest distance from a site at which there are values; None for no limit."""
    if max_distance is None:
        return None
    limit = as_nonnegative(max_distance, name="max_distance")
    return limit


def _same(a: Rows | None, b: Rows | None) -> bool:
    return (a is b) if a is None or b is None else np.array_equal(a, b)


def shaped_derivatives(derivatives: Floats, field: Field, leading: tuple[int, ...]) -> NDArray[Any]:
    """Derivatives of real columns, (k, c, d), in the dtype of the values.

    The shape is that of the queries, then that of one value, then d.
    """
    found: NDArray[Any] = derivatives
    if field.is_complex:
        found = found[:, 0::2] + 1j * found[:, 1::2]
    return found.reshape(leading + field.trailing + derivatives.shape[2:])


def _sides(simplices: Indices) -> Indices:
    """Each side of triangles that are cut along constraints, ascending, from the smaller vertex."""
    pairs = np.sort(simplices[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    sides: Indices = np.unique(pairs, axis=0)
    return sides
