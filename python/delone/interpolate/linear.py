"""Linear interpolation: on each triangle or tetrahedron, from the values at its corners."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._arrays import as_workers
from delone.errors import InputError
from delone.higher.dimension import MOST
from delone.interpolate.base import Interpolator
from delone.interpolate.hull import Terms, edge_terms, plane_gradients, summed
from delone.interpolate.rectilinear import Rectilinear, rectilinear
from delone.interpolate.space import SPACE, face_terms, hull_gradients, slopes
from delone.interpolate.values import chosen
from delone.interpolate.weights import Weights, rectangular
from delone.location import Location

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._types import Floats, Indices
    from delone.periodic import PeriodicDelaunay
    from delone.triangulation import Triangulation

__all__ = ["Linear"]

# Policies that have values outside.
_BEYOND = ("nearest", "linear")


class Linear(Interpolator):
    """Piecewise linear interpolation on triangles, tetrahedra, or simplices of more dimensions.

    Parameters
    ----------
    points : array_like, shape (n, d), or a triangulation
        Sites with two to eight coordinates, or with up to 64 if they are a grid. A triangulation of
        delone is used directly, including constrained and regular ones and, in 3-D, a `TetMesh`;
        its own boundary replaces the hull. A periodic one,
        ``PeriodicDelaunay(points, (360, None))``, makes the interpolant periodic as well.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    method : {"auto", "mesh", "grid"}, optional
        ``"mesh"`` triangulates the points. ``"grid"`` requires all points of a rectilinear grid, in
        any order and with even or uneven steps, and needs no triangulation: time and memory follow
        the number of points, whatever their number of coordinates. The values are the same up to
        rounding. ``"auto"`` does this with grids from 4-D on, and triangulates everything else.
    extrapolate : {"nan", "nearest", "linear", "raise"}, optional
        Behavior outside the hull: NaN; the value at the nearest point of the hull; linear
        extrapolation from that point, with the gradients of the planes that best fit its sites and
        their neighbors; an error. From 4-D on, NaN or an error.
    tolerance : float, optional
        Queries outside at most this far from the hull, in the unit of the points, are inside: they
        have the value at the nearest point of the hull. By default 0. Half of the points on a side
        that is not parallel to an axis are outside by a rounding error. The distance is compared
        exactly. Only in 2-D and 3-D.
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
    rounding. Inside the hull, including its boundary, the result is NaN only if a value is. The
    time of a query is that of its point location: O(1), because the core sorts queries along a
    space-filling curve.

    On a periodic triangulation, queries are moved into one period, and the sites are copied as
    often as needed, at least twice on each side. In a periodic direction, there is no outside.

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

    A table of four columns, here of a function that is linear in each cell:

    >>> axes = np.meshgrid([0, 1, 4], [0, 2], [5, 6], [1, 2, 3])
    >>> table = np.stack(axes, axis=-1).reshape(-1, 4)
    >>> engine = Linear(table, table.sum(axis=1))
    >>> engine
    <Linear on a grid of 3 x 2 x 2 x 3 points>
    >>> engine([(2.5, 1, 5.5, 2.5), (5, 1, 5.5, 2.5)])
    array([11.5,  nan])
    """

    _MOST: ClassVar[int] = 64

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        method: str = "auto",
        extrapolate: str = "nan",
        tolerance: float = 0.0,
        duplicates: str = "raise",
        nan: str = "raise",
        respect_constraints: bool = False,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        self._method = chosen("method", method, ("auto", "mesh", "grid"))
        self._grid: Rectilinear | None = None
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
        if self._method == "grid" and self._held is not None:
            raise InputError(
                "method='grid' needs the points of a rectilinear grid, all of them, and not a "
                "triangulation: choose method='auto'"
            )

    def _tiled(self) -> Triangulation | None:
        sites = self._sites if self._kept is None else self._sites[self._kept]
        self._grid = None
        if self._given is None and self._periodic is None and self._wants_grid():
            self._grid = rectilinear(sites)
        if self._grid is not None:
            return None
        if self._ndim > MOST:
            raise InputError(
                f"points with {self._ndim} coordinates are only interpolated on a rectilinear "
                f"grid, with a value at each node: triangulations have at most {MOST} dimensions; "
                "choose fewer columns"
            )
        return super()._tiled()

    def _wants_grid(self) -> bool:
        """Whether a grid is evaluated without triangles; in 2-D and 3-D only on request."""
        if self._method == "auto":
            return self._ndim > SPACE
        if self._method == "grid" and (self._tolerance or self._extrapolate in _BEYOND):
            raise InputError(
                "method='grid' has no values outside of the grid: choose extrapolate='nan' or "
                "'raise', without tolerance"
            )
        return self._method == "grid"

    def _first_rows(self) -> Indices:
        if self._grid is None:
            return super()._first_rows()
        return np.arange(self._grid.rows.size, dtype=np.int32)

    def _located(self, queries: Floats) -> Location:
        if self._grid is None:
            return super()._located(queries)
        # Only whether they are inside.
        inside = self._grid.find(queries).inside
        count, d = queries.shape
        nowhere, none = np.full((count, d), np.nan), np.full((count, d), -1, np.int32)
        number = np.where(inside, 0, -1).astype(np.int32)
        weights = np.full((count, d + 1), np.nan)
        return Location(number, weights, nowhere, none[:, 0].copy(), none, nowhere)

    def __repr__(self) -> str:
        if self._grid is None:
            return super().__repr__()
        shape = " x ".join(str(len(axis)) for axis in self._grid.axes)
        return f"<Linear on a grid of {shape} points>"

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        if self._grid is not None:
            along = self._grid.gradients if order else self._grid.values
            return along(queries, columns)
        if self._ndim >= SPACE:
            return self._in_space(queries, columns, order)
        found: Floats = self._sheet.locator.linear(
            columns, queries, order, as_workers(self._workers)
        )
        return found

    def _in_space(self, queries: Floats, columns: Floats, order: int) -> Floats:
        """Values or gradients in the simplices that contain the queries."""
        mesh = self._mesh
        index: Any = mesh._locator
        simplex, weights = index.within(queries, as_workers(self._workers))
        known = np.flatnonzero(simplex >= 0)
        corners = mesh.simplices[simplex[known]]
        shape = (len(queries), columns.shape[1])
        found = np.full(shape if order == 0 else (*shape, self._ndim), np.nan)
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
        if self._grid is not None:
            cells = self._grid.find(queries)
            if self._extrapolate == "raise":
                self._left(queries, None)
            width = queries.shape[1] + 1
            rows = np.full((len(queries), width), -1, np.int32)
            shares = np.full((len(queries), width), np.nan)
            rows[cells.inside], shares[cells.inside] = cells.corners, cells.weights
            return Weights(*rectangular(rows, shares), shape, self)
        place = self._located(queries)
        weights, simplices = place.barycentric, self._sheet.simplices
        # Without triangles there is no row to use for queries outside.
        corners = (
            simplices[place.simplex] if len(simplices) else np.full(weights.shape, -1, np.int32)
        )
        table = rectangular(corners, weights)
        return Weights(*self._completed(table, queries, weights), shape, self)
