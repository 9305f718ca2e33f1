"""Linear interpolation: on each triangle or tetrahedron by the values at its corners."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._arrays import as_workers
from delone.interpolate.base import Interpolator
from delone.interpolate.hull import Terms, edge_terms, plane_gradients, summed
from delone.interpolate.space import SPACE, face_terms, hull_gradients, slopes
from delone.interpolate.weights import Weights, rectangular

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["Linear"]


class Linear(Interpolator):
    """Piecewise linear interpolation on the triangles, in space on the tetrahedra.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Sites. A triangulation of delone is used as it is, constrained ones included. A periodic
        one, ``PeriodicDelaunay(points, (360, None))``, makes the interpolant periodic as well.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. They may be left out where calls bring theirs.
    extrapolate : {"nan", "nearest", "linear", "error"}, optional
        What there is outside of the hull: NaN; the value at the nearest point of the hull; from
        there on the slope of the planes that fit its sites and their neighbours best; an error.
    duplicates : {"error", "mean", "first", "last", "min", "max"}, optional
        Which value a point has that comes several times with different ones.
    nan : {"error", "drop", "propagate"}, optional
        What becomes of sites whose value is NaN or infinite: an error that names them; the sites
        are left out of the triangulation, unless a constraint needs them, which is an error as
        well; the triangles at them have no value.
    respect_constraints : bool, optional
        Accepted as by the other interpolators: triangles never cross a constraint.
    workers : int, optional
        Number of threads; by default one for each core. The answer is the same.
    planar : bool, optional
        Whether longitudes and latitudes are meant as coordinates of a plane; otherwise points that
        say they are in degrees (by a reference system or names of columns) are warned of.

    Raises
    ------
    InputError
        An argument is none of its choices; values differ at a point with ``duplicates="error"``.
    NonFiniteError
        A coordinate, or with ``nan="error"`` a value, is NaN or infinite.
    DegenerateInputError
        The sites span no area.
    ShapeError, DtypeError
        Arrays do not fit, or hold no numbers.

    Notes
    -----
    At a site the value comes back bit for bit; linear functions are reproduced up to rounding.
    Inside of the hull, its boundary included, the answer is never NaN unless a value is. Each query
    costs its location: O(1) in order along a space-filling curve, which the core sees to.

    On a periodic triangulation queries are moved into one period, and the sites are copied as far
    as they matter: at least twice on each side. In a direction with a period there is no outside.

    See Also
    --------
    CloughTocher : Smooth, from values and estimated gradients.
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
        found: Floats = self._mesh._locator.linear(
            columns, queries, order, as_workers(self._workers)
        )
        return found

    def _in_space(self, queries: Floats, columns: Floats, order: int) -> Floats:
        """Values, or slopes, in the tetrahedra that hold queries."""
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

    def gradients(self, columns: Floats) -> Floats | None:
        """Return gradients at the sites, which count beyond the hull alone."""
        if self._extrapolate != "linear":
            return None
        mesh = self._mesh
        if self._ndim == SPACE:
            return hull_gradients(mesh, columns, as_workers(self._workers))
        around = mesh.vertex_neighbor_vertices
        return plane_gradients(mesh.points, around, columns, as_workers(self._workers))

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        place = self._located(queries)
        weights, simplices = place.barycentric, self._mesh.simplices
        # Without a triangle there is no row that could stand for none.
        corners = (
            simplices[place.simplex] if len(simplices) else np.full(weights.shape, -1, np.int32)
        )
        table = rectangular(corners, weights)
        return Weights(*self._completed(table, queries, weights), shape, self)
