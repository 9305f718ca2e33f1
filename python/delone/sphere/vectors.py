"""Vectors on the sphere by their components to the east and to the north.

East at a site is not east at a query: near a pole, directions rotate with the longitude. A vector
is moved to the query along the great circle between them, by parallel transport. This rotates its
components by an angle that depends only on the two places, so a table of weights becomes two: the
weights times the cosines, and times the sines. Every interpolant with such a table moves vectors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, as_workers
from delone._base.blocks import blocks
from delone.errors import InputError, ShapeError
from delone.interpolate.base import as_max_distance
from delone.interpolate.values import as_field, no_values
from delone.sphere.coordinates import numbers_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Rows
    from delone.interpolate.values import Field
    from delone.interpolate.weights import Weights
    from delone.sphere.delaunay import Delaunay

    Complexes = NDArray[np.complex128]
    # A field, the interpolator of its sites, and its values after the policies.
    Settled = tuple[Field, Any, Floats]

__all__ = ["VectorInterpolation", "Vectors", "polar_rows"]

# Avoids division by zero.
_TINY = 2.0**-1022


class Polar(NamedTuple):
    """The caller's rows at the poles, whose longitudes define east."""

    rows: Rows
    # The longitude of the first row at the same pole, in radians, used for all of them.
    longitudes: Floats
    # (cosine, sine) of the rotations from the meridians of the rows to that one.
    turns: Floats


def polar_rows(lonlat: ArrayLike, vectors: Floats, degrees: bool) -> Polar | None:
    """Return the rows of longitudes and latitudes that are at a pole; None if there are none."""
    rows = np.flatnonzero(~vectors[:, :2].any(axis=1))
    if not rows.size:
        return None
    given = np.asarray(lonlat, dtype=np.float64)[rows, 0]
    up = vectors[rows, 2] > 0
    first = np.where(up, given[up.argmax()], given[up.argmin()])
    # At the South Pole, rotations are seen from the other side.
    apart = np.where(up, given - first, first - given)
    # The cosines and sines of the core are exact for quarter turns.
    circle = np.column_stack((apart, np.zeros(len(apart))))
    turns = _core.sphere_directions(circle, degrees, 1)[:, :2]
    return Polar(rows, np.radians(first) if degrees else first, turns)


def longitudes_of(xi: ArrayLike, degrees: bool) -> Floats | None:
    """Return the longitudes of queries in radians, flattened; None for queries given as vectors."""
    array = as_plain_array(numbers_of(xi, "xi"), "xi")
    if array.shape[-1] != 2:
        return None
    longitudes = np.asarray(array[..., 0], dtype=np.float64).ravel()
    return np.radians(longitudes) if degrees else longitudes


class _Halves(NamedTuple):
    """Cosines and sines of half the longitudes and latitudes of places."""

    across: tuple[Floats, Floats]
    up: tuple[Floats, Floats]

    @classmethod
    def of(cls, vectors: Floats, longitudes: Floats) -> _Halves:
        """Those of directions; `longitudes` are those of directions at a pole."""
        # Negative zeros would point west.
        x, y, z = vectors.T + 0.0
        # Squares of long vectors may overflow, and NumPy's functions differ in their last bits.
        largest = np.abs(vectors).max(axis=1, initial=0.0)
        power = -np.frexp(largest)[1]
        turn = np.arctan2(np.ldexp(y, power), np.ldexp(x, power))
        across = np.where((x == 0) & (y == 0), longitudes, turn) / 2
        up = np.arctan2(z / largest, np.hypot(x / largest, y / largest)) / 2
        return cls((np.cos(across), np.sin(across)), (np.cos(up), np.sin(up)))

    def at(self, rows: Any) -> _Halves:
        """Return those of some places, or of one for each entry."""
        (a, b), (c, d) = self
        return _Halves((a[rows], b[rows]), (c[rows], d[rows]))


def _turns(start: _Halves, end: _Halves) -> tuple[Floats, Floats]:
    """Cosines and sines of the rotations of components from some points to others.

    By Napier's analogies, tan(turn / 2) = -tan(longitudes / 2) sin(mean latitude) / cos(half the
    difference of latitudes).
    """
    (ca, sa), (cu, su) = start
    (cb, sb), (cv, sv) = end
    sine = (su * cv + cu * sv) * (sb * ca - cb * sa)
    cosine = (cu * cv + su * sv) * (cb * ca + sb * sa)
    # The squared length of the mean of two unit vectors. It is 0 only for opposite ones, which
    # have no unique great circle; the weights of such sites are 0, as all others are nearer.
    square = np.maximum(cosine * cosine + sine * sine, _TINY)
    return (cosine * cosine - sine * sine) / square, -2.0 * cosine * sine / square


@dataclass(frozen=True, eq=False)
class Vectors:
    """Weights of sites at queries, for vectors: `table` times the cosines and sines of turns."""

    table: Weights
    cosines: Floats
    sines: Floats
    polar: Polar | None

    def apply(self, values: ArrayLike) -> NDArray[Any]:
        """Interpolate components, (n, 2, ...), at the queries: their shape, then (2, ...)."""
        policies = self.table.sites._policies
        refuse_ordered(policies.duplicates)
        pairs = paired(values, policies.npoints, self.polar)
        columns = policies._settled(as_field(pairs, len(pairs)))
        return unpaired(self.combined(columns), *shape_of(values))

    def combined(self, columns: Floats) -> Complexes:
        """Interpolate settled columns, (m, 2 k), as numbers east + north i: (..., k)."""
        table, threads = self.table, as_workers(self.table.sites.workers)
        along, across = (
            _core.combine2(table.indptr, table.rows, part, columns, None, None, threads)
            for part in (self.cosines, self.sines)
        )
        along[:, 0::2] -= across[:, 1::2]
        along[:, 1::2] += across[:, 0::2]
        found: Complexes = along.view(np.complex128)
        return found.reshape((*table.query_shape, found.shape[1]))


def transports(
    table: Weights,
    sites: tuple[Floats, Polar | None],
    queries: tuple[Floats, Floats | None],
) -> Vectors:
    """Return the table for vectors, from sites and queries as vectors with longitudes at poles.

    Rows of `sites` are those of the caller; the table has the rows of `table.sites`.
    """
    (vectors, polar), kept = sites, table.sites._policies.kept
    at_poles = np.zeros(len(vectors))
    if polar is not None:
        at_poles[polar.rows] = polar.longitudes
    if kept is not None:
        vectors, at_poles = vectors[kept], at_poles[kept]
    start = _Halves.of(vectors, at_poles)
    given = np.zeros(len(queries[0])) if queries[1] is None else queries[1]
    # Queries without a direction have no entries.
    with np.errstate(invalid="ignore"):
        end = _Halves.of(queries[0], given)
    owners = np.repeat(np.arange(len(table)), np.diff(table.indptr))
    cosines, sines = np.empty((2, len(owners)))
    for part in blocks(len(owners)):
        cosines[part], sines[part] = _turns(start.at(table.rows[part]), end.at(owners[part]))
        cosines[part] *= table.weights[part]
        sines[part] *= table.weights[part]
    return Vectors(table, cosines, sines, polar)


def refuse_ordered(duplicates: str) -> None:
    """Reject policies that compare values, because vectors have no order."""
    if duplicates in ("min", "max"):
        raise InputError(f"duplicates={duplicates!r:.20}: vectors have no order; choose 'mean'")


def shape_of(values: ArrayLike) -> tuple[tuple[int, ...], bool]:
    """Return the shape of the values of one point, and whether they are complex."""
    array = as_plain_array(values, "values")
    return array.shape[1:], array.dtype.kind == "c"


def paired(values: ArrayLike, count: int, polar: Polar | None) -> Complexes:
    """Components, (n, 2, ...), as numbers east + north i, (n, k); rows at a pole on one meridian.

    Complex components are two vectors, one of real and one of imaginary parts. A vector with a part
    that is not finite is NaN in all its parts.
    """
    field = as_field(values, count)
    if not field.trailing or field.trailing[0] != 2:
        shape = (count, *field.trailing)
        raise ShapeError(
            f"values must have shape ({count}, 2) or ({count}, 2, ...), components to the east and "
            f"to the north, got {shape}"
        )
    width, parts = math.prod(field.trailing[1:]), 2 if field.is_complex else 1
    # Axes: points, components, vectors, real and imaginary parts.
    split = field.columns.reshape(count, 2, width, parts)
    lost = ~np.isfinite(split).all(axis=(1, 3))
    pairs = np.empty((count, width, parts), dtype=np.complex128)
    pairs.real, pairs.imag = split[:, 0], split[:, 1]
    pairs[lost] = complex(np.nan, np.nan)
    if polar is not None:
        cosine, sine = polar.turns.T[:, :, None, None]
        at = pairs[polar.rows]
        pairs.real[polar.rows] = cosine * at.real - sine * at.imag
        pairs.imag[polar.rows] = cosine * at.imag + sine * at.real
    return pairs.reshape(count, width * parts)


def unpaired(found: Complexes, trailing: tuple[int, ...], is_complex: bool) -> NDArray[Any]:
    """Numbers east + north i, (..., k), as components, of shape (...) + trailing."""
    leading, parts = found.shape[:-1], 2 if is_complex else 1
    split = found.view(np.float64).reshape((*leading, found.shape[-1] // parts, parts, 2))
    result: NDArray[Any] = np.ascontiguousarray(np.moveaxis(split, -1, -3))
    if is_complex:
        result = result.view(np.complex128)
    return result.reshape(leading + trailing)


class VectorInterpolation:
    """Interpolation of vectors with the weights of a subclass; the base of the public classes."""

    _all: Delaunay
    _degrees: bool
    _duplicates: str
    _field: Settled | None
    _parts: tuple[Field, list[tuple[Rows, Any]]] | None
    _polar: Polar | None

    def vectors_at(
        self,
        xi: ArrayLike,
        *,
        values: ArrayLike | None = None,
        max_distance: float | None = None,
    ) -> NDArray[Any]:
        """Interpolate tangent vectors, such as winds, by their components to the east and north.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.
        values : array_like, shape (n, 2) or (n, 2, ...), optional
            Components at the sites, to the east and to the north, in any unit; by default the
            values given to the constructor.
        max_distance : float, optional
            As for values.

        Returns
        -------
        ndarray of float64 or complex128
            Components to the east and north at the queries: the shape of the queries, without their
            last axis, followed by that of one value, (2, ...).

        Raises
        ------
        ShapeError
            The values do not have the shape (n, 2) or (n, 2, ...); or as for values.
        InputError
            ``duplicates`` is "min" or "max", as vectors have no order; or as for values.
        DirectionError, DtypeError, NonFiniteError
            As for values.

        Notes
        -----
        Each vector is moved from its site p to the query q by parallel transport along the great
        circle between them, v - (q·v) / (1 + p·q) (p + q), and the moved vectors are combined with
        the weights. Interpolating components as two fields is wrong near the poles, where east
        rotates with the longitude; here errors are the same everywhere. Sites opposite a query have
        no weight.

        At a pole, east and north are those of the meridian of the row's longitude, for sites and
        for queries given as longitudes and latitudes. For a pole given as a vector, and for one in
        a `sphere.Delaunay`, the longitude is 0. So all rows of a grid at a pole may represent one
        vector; they are duplicates, and ``duplicates="mean"`` averages them as vectors.

        A vector is missing, for the policy of ``nan``, if one of its components is.

        Examples
        --------
        A wind across the North Pole, from Greenwich to the date line:

        >>> from delone import sphere
        >>> sites = [(0, 80), (90, 80), (180, 80), (-90, 80)]
        >>> wind = sphere.Linear(sites, [(0, 10), (10, 0), (0, -10), (-10, 0)])
        >>> wind.vectors_at([(0, 85), (0, 90), (90, 90), (180, 85)]).round(6) + 0.0
        array([[  0.,  10.],
               [  0.,  10.],
               [ 10.,   0.],
               [  0., -10.]])
        >>> wind((0, 90)).round(6) + 0.0
        array([0., 0.])
        """
        limit = as_max_distance(max_distance)
        refuse_ordered(self._duplicates)
        given = self._given() if values is None else values
        pairs = paired(given, self.npoints, self._polar)
        if several := self._several(pairs):
            field, narrow = several
            parts = [(k, part._moved(xi, part._field, limit)) for k, part in narrow]
            return unpaired(field.joined(parts), *shape_of(given))
        return unpaired(self._moved(xi, self._with(pairs), limit), *shape_of(given))

    def _moved(self, xi: ArrayLike, settled: Settled, limit: float | None) -> Complexes:
        """Vectors as numbers, east + north i, interpolated: (..., k)."""
        _, owner, columns = settled
        found: Complexes = owner._transports(xi).combined(columns)
        if limit is not None:
            found[~(owner._distance(xi) <= limit)] = complex(np.nan, np.nan)
        return found

    def _transports(
        self, xi: ArrayLike, table: Weights | None = None, longitudes: Floats | None = None
    ) -> Vectors:
        """The table for vectors, from the table for numbers if that is known.

        `longitudes` are those of queries as vectors, in radians.
        """
        if longitudes is None:
            longitudes = longitudes_of(xi, self._degrees)
        table = self._table(xi) if table is None else table
        queries, _, _ = self._queries(xi)
        return transports(table, (self._all.vectors, self._polar), (queries, longitudes))

    def _given(self) -> NDArray[Any]:
        """The values of the constructor."""
        held = self._field if self._parts is None else self._parts
        if held is None:
            raise no_values()
        field = held[0]
        return field.shaped(field.columns, (self.npoints,))

    if TYPE_CHECKING:

        @property
        def npoints(self) -> int:
            """Number of sites given."""

        def _distance(self, xi: ArrayLike) -> Floats: ...
        def _queries(self, xi: ArrayLike) -> tuple[Floats, Rows, tuple[int, ...]]: ...
        def _several(
            self, values: ArrayLike | None
        ) -> tuple[Field, list[tuple[Rows, Any]]] | None: ...
        def _table(self, xi: ArrayLike) -> Weights: ...
        def _with(self, values: ArrayLike | None) -> Settled: ...
