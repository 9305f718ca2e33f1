"""Weights of sites at queries: computed once, applied to many fields.

Row i of the table lists the sites that contribute to query i and their weights. Smooth interpolants
also have weights of the gradients of the sites, which are estimated again for each field. A query
without a result has an empty row and gets NaN.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.extras import require
from delone._base.renames import renamed
from delone.errors import InputError
from delone.interpolate.values import as_field

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.interpolate.hull import Terms
    from delone.interpolate.policies import Policies

    Table: TypeAlias = tuple[NDArray[np.int64], Indices, Floats, Floats | None]

_PLANE = 2

__all__ = ["Sites", "Weights", "joined", "rectangular"]


class Sites(Protocol):
    """The interface of an interpolator that a table needs."""

    @property
    def npoints(self) -> int:
        """Number of points that the caller gave."""

    @property
    def workers(self) -> int | None:
        """Number of threads."""

    @property
    def _policies(self) -> Policies:
        """How values are treated, and which of the caller's rows a table refers to."""

    def _gradients(self, columns: Floats) -> Floats | None:
        """Gradients (n, c, 2) of these columns, if the interpolant needs them."""


@renamed(shape="query_shape")
@dataclass(frozen=True, eq=False)
class Weights:
    """The sites that contribute to each query, with their weights.

    Parameters
    ----------
    indptr : ndarray of int64, shape (k + 1,)
        The entries of query i, in the order of the flattened queries, are ``indptr[i]`` to
        ``indptr[i + 1]``. There are none if the query has no result.
    rows : ndarray of int32, shape (nnz,)
        Sites in the interpolator's numbering; `indices` contains the caller's rows.
    weights : ndarray of float64, shape (nnz,)
        Their weights; they sum to 1 for each query, up to rounding.
    slopes : ndarray of float64, shape (nnz, d), or None
        Weights of their gradients, if the interpolant uses them.
    query_shape : tuple of int
        Shape of the queries, without their last axis.
    sites : Interpolator
        The interpolator that made the table. Without `slopes`, a pickled table contains only its
        policies, not its triangulation.

    Examples
    --------
    >>> from delone.interpolate import Linear
    >>> table = Linear([(0, 0), (1, 0), (0, 1)]).weights_at([(0.25, 0.25), (1, 0)])
    >>> table.apply([0.0, 4.0, 8.0])
    array([3., 4.])
    >>> table.indptr.tolist()
    [0, 3, 4]
    """

    indptr: NDArray[np.int64]
    rows: Indices
    weights: Floats
    slopes: Floats | None
    query_shape: tuple[int, ...]
    sites: Sites

    def __len__(self) -> int:
        return len(self.indptr) - 1

    def __reduce__(self) -> tuple[Any, ...]:
        # Only gradients need triangles.
        sites = self.sites if self.slopes is not None else self.sites._policies
        return type(self), (
            self.indptr,
            self.rows,
            self.weights,
            self.slopes,
            self.query_shape,
            sites,
        )

    @property
    def indices(self) -> Indices:
        """The rows of the caller's points, (nnz,); for duplicates, the row whose value is used.

        If duplicates take their mean, smallest or largest value, it is the first of them.
        """
        found: Indices = self.sites._policies.caller_rows()[self.rows]
        return found

    def apply(self, values: ArrayLike) -> NDArray[Any]:
        """Interpolate a field.

        Parameters
        ----------
        values : array_like, shape (n,) or (n, ...)
            Real or complex numbers.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, then that of one value; NaN where there is no result.

        Raises
        ------
        ShapeError, DtypeError
            The number of values is not that of the points, or they are not numeric.
        InputError
            The policies of the interpolator reject them.

        Notes
        -----
        Sites that ``nan="drop"`` removed when the table was made remain removed; NaN at another
        site propagates to the queries to which it contributes.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> table = Linear([(0, 0), (1, 0), (0, 1)]).weights_at((0.5, 0.5))
        >>> [float(table.apply(month)) for month in ([0, 1, 2], [0, 3, 5])]
        [1.5, 4.0]
        """
        field = as_field(values, self.sites.npoints)
        columns = self.sites._policies._settled(field)
        slopes, threads = self.slopes, as_workers(self.sites.workers)
        gradients = None if slopes is None else self.sites._gradients(columns)
        plane = slopes if slopes is not None and slopes.shape[1] == _PLANE else None
        found = _core.combine2(
            self.indptr,
            self.rows,
            self.weights,
            columns,
            plane,
            None if plane is None else gradients,
            threads,
        )
        if slopes is not None and plane is None and gradients is not None:
            self._add_gradients(found, slopes, gradients)
        return field.shaped(found, self.query_shape)

    def _add_gradients(self, found: Floats, slopes: Floats, gradients: Floats) -> None:
        """Add the contribution of gradients in 3-D, which only affects queries beyond the hull."""
        entries = np.flatnonzero((slopes != 0).any(axis=1))
        owner = np.searchsorted(self.indptr, entries, side="right") - 1
        rise = np.einsum("kcj,kj->kc", gradients[self.rows[entries]], slopes[entries])
        np.add.at(found, owner, rise)

    def __matmul__(self, values: ArrayLike) -> NDArray[Any]:
        return self.apply(values)

    def csr(self) -> Any:
        """Return the table as a SciPy sparse matrix, whose product with values is `apply`.

        Returns
        -------
        scipy.sparse.csr_array, shape (k, n)
            The weights, for flattened queries. Rows without a result contain one NaN. With
            ``duplicates="mean"``, points that coincide share their weight.

        Raises
        ------
        MissingExtraError
            SciPy is not installed.
        InputError
            The interpolant needs gradients, which cannot be computed by a matrix product: smooth
            methods, and all with ``extrapolate="linear"``. Or the policy takes the smallest or
            largest value of points that coincide, which is not linear.

        Examples
        --------
        >>> from delone.interpolate import Linear
        >>> table = Linear([(0, 0), (1, 0), (0, 1)]).weights_at([(0.25, 0.25), (1, 0)])
        >>> (table.csr() @ [0.0, 4.0, 8.0]).tolist()
        [3.0, 4.0]
        """
        if self.slopes is not None:
            raise InputError(
                "this interpolant needs gradients, which a matrix cannot represent; use apply"
            )
        csr_array = require("scipy.sparse", extra="graph", what="a sparse matrix").csr_array
        groups = self.sites._policies.mixed_rows()
        empty = np.flatnonzero(np.diff(self.indptr) == 0)
        ends = self.indptr[empty]
        indptr = self.indptr + np.concatenate(([0], np.cumsum(np.diff(self.indptr) == 0)))
        rows = self.indices if groups is None else self.rows
        parts = (np.insert(self.weights, ends, np.nan), np.insert(rows, ends, 0), indptr)
        if groups is None:
            return csr_array(parts, shape=(len(self), self.sites.npoints))
        starts, members = groups
        share = np.repeat(1.0 / np.diff(starts), np.diff(starts))
        mixing = csr_array((share, members, starts), shape=(len(starts) - 1, self.sites.npoints))
        return csr_array(parts, shape=(len(self), len(starts) - 1)) @ mixing


def rectangular(rows: Indices, weights: Floats) -> Table:
    """A table from a fixed number of sites per query, (k, m), without zeros and NaN.

    Rows are arbitrary where the weight is NaN; all weights of a query without a result are.
    """
    # NaN is neither.
    keep = (weights > 0) | (weights < 0)
    count, width = weights.shape
    if keep.all():
        indptr = np.arange(0, count * width + 1, width, dtype=np.int64)
        return indptr, rows.reshape(-1), weights.reshape(-1), None
    indptr = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(keep.sum(axis=1), out=indptr[1:])
    return indptr, rows[keep], weights[keep], None


def joined(inner: Table, outside: NDArray[np.int64], terms: Terms) -> Table:
    """Insert the terms of the queries outside, ascending, into the empty rows of a table."""
    indptr, rows, weights, slopes = inner
    counts = (terms.weights != 0) & ~np.isnan(terms.weights)
    if terms.slopes is not None:
        counts |= (terms.slopes != 0).any(axis=2)
        slopes = np.zeros((len(rows), terms.slopes.shape[2])) if slopes is None else slopes
    number = counts.sum(axis=1)
    place = np.repeat(indptr[outside], number)
    count = np.diff(indptr)
    count[outside] = number
    indptr = np.concatenate(([0], np.cumsum(count)))
    rows = np.insert(rows, place, terms.rows[counts])
    weights = np.insert(weights, place, terms.weights[counts])
    if slopes is not None:
        more = np.zeros((len(place), 2)) if terms.slopes is None else terms.slopes[counts]
        slopes = np.insert(slopes, place, more, axis=0)
    return indptr, rows, weights, slopes
