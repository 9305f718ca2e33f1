"""Interpolation by the nearest site: constant on each cell of the Voronoi diagram."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone._base.arrays import as_workers
from delone._tiling import location
from delone._tiling.higher.dimension import MOST
from delone.interpolate.base import Interpolator
from delone.interpolate.weights import Weights, rectangular

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["Nearest"]


class Nearest(Interpolator):
    """The value of the nearest site.

    Parameters
    ----------
    points : array_like, shape (n, d), or a triangulation
        Sites with two to eight coordinates, or the vertices of a delone triangulation.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nearest", "nan", "raise"}, optional
        Behavior outside the hull: the value of the nearest site, as inside; NaN; an error.
    tolerance : float, optional
        Queries outside at most this far from the hull are inside; as in `Linear`.
    duplicates : {"raise", "mean", "first", "last", "min", "max"}, optional
        The value of points that coincide but have different values.
    nan : {"raise", "drop", "propagate"}, optional
        How to treat sites whose value is NaN or infinite; as in `Linear`.
    respect_constraints : bool, optional
        On a constrained triangulation, use the nearest site that is visible from the query, not
        hidden by a constraint.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        As in `Linear`.

    Raises
    ------
    InputError, NonFiniteError, DegenerateInputError, ShapeError, DtypeError
        As in `Linear`.

    Notes
    -----
    The nearest site is exact: distances are compared by predicates, and of equally near sites the
    one with the smallest row is used. If constraints are respected, rounded distances are compared
    among the neighbors that the query would have as a vertex; the nearest visible site is always
    among them.

    Examples
    --------
    >>> from delone.interpolate import Nearest
    >>> kind = Nearest([(0, 0), (1, 0), (0, 1)], [10, 20, 30])
    >>> kind([(0.9, 0.2), (0.1, 5), (float("nan"), 0)])
    array([20., 30., nan])
    """

    EXTRAPOLATE: ClassVar[tuple[str, ...]] = ("nearest", "nan", "raise")
    _MOST: ClassVar[int] = MOST

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        extrapolate: str = "nearest",
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        respect_constraints: bool = False,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        super().__init__(
            points,
            values,
            extrapolate=extrapolate,
            tolerance=tolerance,
            duplicates=duplicates,
            nan=nan,
            respect_constraints=respect_constraints,
            workers=workers,
            planar=planar,
        )

    def _skipped(self) -> Bools:
        return np.zeros(0, dtype=bool)  # no value depends on a triangle

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        rows = self._rows(queries)
        known = rows >= 0
        if order:
            found = np.full((len(rows), columns.shape[1], self._ndim), np.nan)
            found[known] = 0.0
            return found
        return np.where(known[:, None], columns[rows], np.nan)

    def _interpolated(self, queries: Floats, columns: Floats) -> Floats:
        return self._derived(queries, columns, 0)

    def _sloped(self, queries: Floats, columns: Floats) -> Floats:
        return self._derived(queries, columns, 1)

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        rows = self._rows(queries)[:, None]
        table = rectangular(rows, np.where(rows >= 0, 1.0, np.nan))
        return Weights(*table, shape, self)

    def _rows(self, queries: Floats) -> Indices:
        """The site of each query, -1 if there is none."""
        if self._respect_constraints and self._constrained:
            return self._seen(queries)
        mesh = self._mesh
        rows = location.nearest(mesh._dimension, mesh._sites, queries, self._workers)
        if self._extrapolate == "nearest":
            return rows
        place = self._located(queries)
        inside = place.simplex >= 0
        if self._extrapolate == "raise" or self._tolerance:
            near, _, within = self._left(queries, None)
            inside[near[within]] = True
        return np.where(inside, rows, np.int32(-1))

    def _seen(self, queries: Floats) -> Indices:
        """The nearest of the neighbors that each query would have in the constrained mesh."""
        mesh = self._mesh
        barrier = mesh.constrained  # type: ignore[attr-defined]
        natural = mesh._locator.natural("laplace", queries, barrier, as_workers(self._workers))
        indptr, rows = natural.indptr, natural.indices
        found = np.full(len(queries), -1, dtype=np.int32)
        count = np.diff(indptr)
        some = np.flatnonzero(count)
        if some.size:
            owner = np.repeat(np.arange(len(queries)), count)
            distance = np.hypot(*(mesh.points[rows] - queries[owner]).T)
            order = np.lexsort((rows, distance, owner))
            found[some] = rows[order[indptr[some]]]
        if self._extrapolate != "nan" or self._tolerance:
            outside, place, _ = self._left(queries, None)
            end = np.where(place.weights[:, 1] <= 0.5, *place.facet.T)
            found[outside] = end
        return found
