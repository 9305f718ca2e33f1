"""Linear interpolation: on each triangle or tetrahedron, from the values at its corners."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_workers
from delone.interpolate.base import Interpolator
from delone.interpolate.hull import Terms, edge_terms, plane_gradients, summed
from delone.interpolate.space import SPACE, face_terms, hull_gradients, slopes
from delone.interpolate.weights import Weights, rectangular

if TYPE_CHECKING:
    from delone._types import Floats

__all__ = ["Linear"]


class Linear(Interpolator):
    """Piecewise linear interpolation on triangles, or on tetrahedra in 3-D.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Sites. A triangulation of delone is used as it is: constrained and regular ones and, in 3-D,
        a `TetMesh` as well; its own boundary takes the place of the hull. A periodic one,
        ``PeriodicDelaunay(points, (360, None))``, makes the interpolant periodic as well.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    extrapolate : {"nan", "nearest", "linear", "raise"}, optional
        Behavior outside the hull: NaN; the value at the nearest point of the hull; linear
        extrapolation from there, with the gradients of the planes that best fit its sites and their
        neighbors; an error.
    tolerance : float, optional
        Queries outside at most this far from the hull, in the unit of the points, are inside: they
        have the value at the nearest point of the hull. By default 0. Half of the points on a side
        that is not parallel to an axis are outside by a rounding. The distance is compared exactly.
    duplicates : {"raise", "mean", "first", "last", "min", "max"}, optional
        The value of points that coincide but have different values.
    nan : {"raise", "drop", "propagate"}, optional
        How to treat sites whose value is NaN or infinite: raise an error that names them; remove
        them from the triangulation (an error if a constraint needs them, or if a regular
        triangulation or `TetMesh` is given); keep them, so that the triangles at them have no
        value.
    respect_constraints : bool, optional
        Accepted for consistency with the other interpolators: triangles never cross constraints.
    workers : int, optional
        Number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane; otherwise points known to be in
        degrees (from a reference system or column names) cause a warning.

    Raises
    ------
    InputError
        An argument is not one of its choices; values differ at a point with ``duplicates="raise"``.
    NonFiniteError
        A coordinate, or with ``nan="raise"`` a value, is NaN or infinite.
    DegenerateInputError
        The sites span no area.
    ShapeError, DtypeError
        Arrays have the wrong shape, or are not numeric.

    Notes
    -----
    At a site the value is reproduced exactly, bit for bit; linear functions are reproduced up to
    rounding. Inside the hull, including its boundary, the result is NaN only if a value is. Each
    query costs its point location: O(1) in the order of a space-filling curve, into which the core
    sorts the queries.

    On a periodic triangulation, queries are moved into one period, and the sites are copied as far
    as they matter: at least twice on each side. In a periodic direction there is no outside.

    See Also
    --------
    CloughTocher : Smooth interpolation from values and estimated gradients.
    NaturalNeighbor : Weights that change smoothly from site to site.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import Linear
    >>> sites = np.array([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    >>> height = Linear(sites, [0.0, 4.0, 7.0, 3.0, 5.0])
    >>> height([(2, 1), (2, 0), (9, 9)])
    array([ 5.,  2., nan])
    >>> height.gradient((2, 0.5))
    array([1., 3.])
    >>> Linear(sites, [0.0, 4.0, 7.0, 3.0, 5.0], extrapolate="nearest")((9, 9))
    array(7.)
    """

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        if self._ndim == SPACE:
            return self._in_space(queries, columns, order)
        found: Floats = self._sheet.locator.linear(
            columns, queries, order, as_workers(self._workers)
        )
        return found

    def _in_space(self, queries: Floats, columns: Floats, order: int) -> Floats:
        """Values or gradients in the tetrahedra that contain the queries."""
        mesh = self._mesh
        index: Any = mesh._locator
        simplex, weights = index.within(queries, as_workers(self._workers))
        known = np.flatnonzero(simplex >= 0)
        corners = mesh.simplices[simplex[known]]
        shape = (len(queries), columns.shape[1])
        found = np.full(shape if order == 0 else (*shape, SPACE), np.nan)
        if order == 0:
            found[known] = summed(Terms(corners, weights[known], None), columns, None)
        else:
            found[known] = slopes(mesh.points, corners, columns)
        return found

    def _terms(self, place: Any, step: Floats, base: bool) -> Terms:
        if self._ndim == SPACE:
            return face_terms(place, step, base=base)
        return edge_terms(self._mesh.points, place, step, cubic=False, base=base)

    def _gradients(self, columns: Floats) -> Floats | None:
        """Return gradients at the sites, which are used only beyond the hull."""
        if self._extrapolate != "linear":
            return None
        mesh = self._mesh
        if self._ndim == SPACE:
            return hull_gradients(mesh, columns, as_workers(self._workers))
        return plane_gradients(mesh.points, self._around(), columns, as_workers(self._workers))

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        place = self._located(queries)
        weights, simplices = place.barycentric, self._sheet.simplices
        # Without triangles there is no row to use for queries outside.
        corners = (
            simplices[place.simplex] if len(simplices) else np.full(weights.shape, -1, np.int32)
        )
        table = rectangular(corners, weights)
        return Weights(*self._completed(table, queries, weights), shape, self)
