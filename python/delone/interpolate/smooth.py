"""Base of interpolants with gradients: gradient estimation, and breaks along constraints.

If constraints are respected, the triangles are cut along them: a vertex on a constraint has one row
for each sector between the constraints around it, with a gradient estimated from the vertices of
that sector. Only the values on a constraint then affect both of its sides.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_limit, as_workers
from delone._base.numbers import as_positive
from delone.interpolate.base import Interpolator, Sheet, shaped_derivatives
from delone.interpolate.hull import Terms, edge_terms
from delone.interpolate.space import SPACE, refuse

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["GRADIENTS", "GradientWarning", "Smooth", "cut"]

GRADIENTS = ("global", "local", "plane")

_DEGREES = {"local": 2, "plane": 1}


class GradientWarning(UserWarning):
    """The estimation of gradients stopped before it converged: `max_iter` was reached."""


class Smooth(Interpolator):
    """Interpolation from values and gradients; the base of `CloughTocher` and `NaturalNeighbor`."""

    # Below this size, convergence is by absolute change; None for a scale-invariant choice.
    _floor: float | None = None

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        gradients: str,
        tol: float,
        max_iter: int,
        **options: Any,
    ) -> None:
        self._estimate = as_choice(gradients, GRADIENTS, name="gradients")
        self._tol = as_positive(tol, name="tol")
        self._maxiter = as_limit(max_iter, name="max_iter")
        super().__init__(points, values, **options)

    def hessian(self, xi: ArrayLike, *, values: ArrayLike | None = None) -> NDArray[Any]:
        """Return the second derivatives of the interpolant.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Queries.
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites.

        Returns
        -------
        ndarray of float64 or complex128
            The shape of the queries, then that of one value, then (2, 2). NaN outside the hull.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError, InputError
            As for values; or the sites are in 3-D.

        Examples
        --------
        See `CloughTocher`.
        """
        if self._ndim == SPACE:
            refuse("hessian", "only values are available")
        if several := self._several(values):
            field, narrow = several
            return field.joined([(k, part.hessian(xi)) for k, part in narrow], 2)
        interpolator, field, columns = self._with(values)
        queries, shape = interpolator._queries(xi)
        found = interpolator._derived(queries, columns, 2)
        if interpolator._skipped().any():
            rows, place, within = interpolator._left(queries, found[..., 0], refuses=False)
            inside = np.flatnonzero(within)
            interpolator._fill_beside(found, columns, 2, rows[inside], place.at(inside))
        full = shaped_derivatives(found[..., [0, 1, 1, 2]], field, shape)
        return full.reshape((*full.shape[:-1], 2, 2))

    def site_gradients(self, *, values: ArrayLike | None = None) -> NDArray[Any]:
        """Return the gradients at the sites, which define the interpolant.

        Parameters
        ----------
        values : array_like, shape (n,) or (n, ...), optional
            Another field on the same sites.

        Returns
        -------
        ndarray of float64 or complex128
            One for each point of `triangulation`, in the shape of one value and 2. If constraints
            are respected, points on them have one on each side; the further ones follow the others.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError, InputError
            As for values; or the interpolant does not use gradients, as with natural neighbors of
            the kinds ``"sibson"`` and ``"laplace"``.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.interpolate import CloughTocher
        >>> points = np.random.default_rng(3).random((200, 2))
        >>> bowl = CloughTocher(points, (points**2).sum(axis=1), gradients="local")
        >>> np.allclose(bowl.site_gradients(), 2 * points)
        True
        """
        self._require_gradients()
        self._require_one(values)
        interpolator, field, columns = self._with(values)
        found = interpolator._gradients(columns)
        return shaped_derivatives(found, field, found.shape[:1])

    def _needed(self) -> dict[str, bool]:
        return {"rings": self._estimate == "global"}

    def _require_gradients(self) -> None:
        """Raise if the interpolant does not use gradients at the sites."""

    def _gradients(self, columns: Floats) -> Floats:
        """Return gradients at the sites; see `Interpolator.gradients`."""
        own = self._field is not None and columns is self._field[1]
        if own and "gradients" in self._cache:
            known: Floats = self._cache["gradients"]
            return known
        found = self._estimated(columns)
        if self._repeated is not None:
            # Copies at the rim have incomplete neighborhoods.
            found = found[self._repeated.unmoved(len(found))]
        if own:
            self._cache["gradients"] = found
        return found

    def _estimated(self, columns: Floats) -> Floats:
        points, workers = self._sheet.points, as_workers(self._workers)
        around = self._around()
        if self._estimate in _DEGREES:
            degree = _DEGREES[self._estimate]
            return _core.gradients_local2(points, *around, columns, degree, workers)
        found, iterations = _core.gradients_global2(
            points, *around, columns, self._tol, self._maxiter, workers, self._floor
        )
        if len(columns) and not iterations.all():
            warnings.warn(
                f"gradients did not converge to tol={self._tol} in {self._maxiter} iterations",
                GradientWarning,
                stacklevel=5,
            )
        return found

    @property
    def _source(self) -> Indices | None:
        return self._sheet.source if self._respect_constraints and self._constrained else None

    def _laid_out(self) -> Sheet:
        sheet, mesh = super()._laid_out(), self._mesh
        if not (self._respect_constraints and self._constrained):
            return sheet
        barrier: Bools = mesh.constrained  # type: ignore[attr-defined]
        if len(sheet.simplices) < mesh.nsimplex:
            barrier = barrier[~self._skipped()]
        barrier = np.ascontiguousarray(barrier)
        simplices, source = cut(sheet.simplices, sheet.neighbors, barrier, mesh.npoints)
        points = mesh.points[source]
        index = mesh._dimension.locator(points, simplices, sheet.neighbors)
        return Sheet(points, simplices, sheet.neighbors, index, barrier, source)

    def _terms(self, place: Any, step: Floats, base: bool) -> Terms:
        return edge_terms(self._sheet.points, place, step, cubic=True, base=base)


def cut(
    simplices: Indices, neighbors: Indices, barrier: Bools, npoints: int
) -> tuple[Indices, Indices]:
    """Split vertices into one row for each sector between the barriers around them.

    Returns triangles, in which rows from `npoints` on are further sectors, and the vertex of each
    row. Corners of triangles that share an edge without a barrier are joined; labels spread along
    rings of corners with jumps, in O(log degree) rounds.
    """
    label = _joined(_corner_pairs(simplices, neighbors, ~barrier), simplices.size)
    first, sector = np.unique(label, return_inverse=True)
    vertex = simplices.reshape(-1)[first]
    _, keeps = np.unique(vertex, return_index=True)
    row = np.empty(len(first), dtype=np.int32)
    further = np.delete(np.arange(len(first)), keeps)
    row[keeps] = vertex[keeps]
    row[further] = npoints + np.arange(len(further))
    source = np.concatenate((np.arange(npoints), vertex[further])).astype(np.int32)
    return row[sector.reshape(-1)].reshape(-1, 3), source


def _corner_pairs(simplices: Indices, neighbors: Indices, is_open: Bools) -> NDArray[np.int64]:
    """Corners (as 3 t + k) at the same vertex in two triangles that share an open edge."""
    t, k = np.nonzero(is_open & (neighbors >= 0))
    beyond = neighbors[t, k].astype(np.int64)
    pairs = []
    for side in (1, 2):
        here = (k + side) % 3
        there = (simplices[beyond] == simplices[t, here][:, None]).argmax(axis=1)
        pairs.append(np.column_stack((3 * t + here, 3 * beyond + there)))
    return np.concatenate(pairs)


def _joined(pairs: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """The smallest element of the set of each element, when pairs are joined."""
    label = np.arange(count)
    while True:
        before = label.copy()
        np.minimum.at(label, pairs[:, 0], label[pairs[:, 1]])
        # A label is itself an element of the set; its own label is at most as large.
        label = label[label]
        if np.array_equal(label, before):
            return label
