"""Linear interpolation: on each triangle or tetrahedron, from the values at its corners."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._base.arrays import as_choice, as_workers
from delone._base.blocks import blocks
from delone._tiling.higher.dimension import MOST
from delone._tiling.location import Location
from delone.errors import InputError
from delone.interpolate.base import Interpolator
from delone.interpolate.beyond import nearest_in_box, nearest_terms
from delone.interpolate.hull import Terms, edge_terms, plane_gradients, summed
from delone.interpolate.lazily import Lazily
from delone.interpolate.rectilinear import Rectilinear, rectilinear
from delone.interpolate.space import SPACE, face_terms, hull_gradients, slopes
from delone.interpolate.weights import Weights, rectangular
from delone.memory import TooLargeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["Linear"]

# What the methods without a mesh need.
_NEEDED = {
    "grid": "the points of a rectilinear grid, all of them",
    "lazy": "points that are not periodic",
}


class Linear(Interpolator):
    """Piecewise linear interpolation on triangles, tetrahedra, or simplices of higher dimension.

    Parameters
    ----------
    points : array_like, shape (n, d), or a triangulation
        Sites with two to eight coordinates, or up to 64 if no mesh is needed (see `method`). A
        delone triangulation is used directly, including constrained and regular ones and, in 3-D, a
        `TetMesh`; its own boundary replaces the hull. With a periodic triangulation, such as
        ``PeriodicDelaunay(points, (360, None))``, the interpolant is periodic as well.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    method : {"auto", "mesh", "lazy", "grid"}, optional
        ``"mesh"`` triangulates the points. ``"lazy"`` finds only the simplex that contains each
        query, with a proof, and does not triangulate: memory is proportional to the number of
        points, and a query takes longer than in a mesh. ``"grid"`` requires all points of a
        rectilinear grid, in any order and with even or uneven spacing, and sorts the local
        coordinates of a query within its cell. The values are the same up to rounding. ``"auto"``
        selects ``"grid"`` for grids from 4-D on. For other points, it selects ``"mesh"`` with up to
        eight coordinates, and ``"lazy"`` with more, or if the triangulation would not fit into
        memory.
    extrapolate : {"nan", "nearest", "linear", "raise"}, optional
        Behavior outside the hull: NaN; the value at the nearest point of the hull; linear
        extrapolation from that point, with the gradients of the planes that best fit its sites and
        their neighbors; or an error. ``"linear"`` is only available in 2-D and 3-D, with a mesh.
    tolerance : float, optional
        Queries outside the hull, but at most this far from it, in the unit of the points, count as
        inside and have the value at the nearest point of the hull. The default is 0. About half of
        the points on a side that is not parallel to an axis are outside by a rounding error. The
        distance is compared exactly. Only in 2-D and 3-D.
    duplicates : {"raise", "mean", "first", "last", "min", "max"}, optional
        Which value to use if points coincide but have different values.
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
        The sites do not span a simplex.
    ShapeError, DtypeError
        Arrays have the wrong shape, or are not numeric.

    Warns
    -----
    NearlyFlatWarning
        From 4-D on, with a mesh: the points lie in a flat except for rounding errors.

    Notes
    -----
    At a site the value is reproduced exactly, bit for bit; linear functions are reproduced up to
    rounding. Inside the hull, including its boundary, the result is NaN only if a value is. The
    time of a query is that of its point location: O(1) in a mesh, because the core sorts queries
    along a space-filling curve. With ``method="lazy"``, each query solves a linear program with
    d + 1 rows: about 0.1 ms in 4-D, 1 ms in 20-D and 10 ms in 50-D for 2,000 points. A query in the
    same simplex as the previous one takes microseconds.

    On a periodic triangulation, queries are moved into one period, and the sites are copied as
    often as needed, at least twice on each side. In a periodic direction, no query is outside.

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

    A table with four columns, here of a function that is linear in each cell:

    >>> axes = np.meshgrid([0, 1, 4], [0, 2], [5, 6], [1, 2, 3])
    >>> table = np.stack(axes, axis=-1).reshape(-1, 4)
    >>> engine = Linear(table, table.sum(axis=1))
    >>> engine
    <Linear on a grid of 3 x 2 x 2 x 3 points>
    >>> engine([(2.5, 1, 5.5, 2.5), (5, 1, 5.5, 2.5)])
    array([11.5,  nan])

    Scattered points with 20 coordinates, without a triangulation:

    >>> cloud = np.random.default_rng(1).random((500, 20))
    >>> Linear(cloud, cloud.sum(axis=1))(np.full(20, 0.5)).round(12)
    np.float64(10.0)
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
        self._method = as_choice(method, ("auto", "mesh", "lazy", "grid"), name="method")
        # What is evaluated instead of a triangulation.
        self._implicit: Rectilinear | Lazily | None = None
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
        if self._method in _NEEDED and self._implicit is None:
            raise InputError(
                f"method={self._method!r:.20} needs {_NEEDED[self._method]}, and not a "
                "triangulation: choose method='auto'"
            )

    def _tiled(self) -> Triangulation | None:
        sites = self._sites if self._kept is None else self._sites[self._kept]
        self._implicit = None
        if self._given is None and self._periodic is None and self._wants_no_mesh():
            self._implicit = self._without_mesh(sites)
        if self._implicit is not None:
            return None
        if self._ndim > MOST:
            raise InputError(
                f"points with {self._ndim} coordinates cannot be triangulated: triangulations have "
                f"at most {MOST} dimensions; choose method='lazy' or 'auto'"
            )
        try:
            return super()._tiled()
        except TooLargeError:
            # Only from 4-D on.
            if self._method != "auto" or self._given is not None:
                raise
        self._implicit = Lazily(np.ascontiguousarray(sites), as_workers(self._workers))
        return None

    def _without_mesh(self, sites: Floats) -> Rectilinear | Lazily | None:
        """Return the grid or the lazy sites that evaluate queries; None if a mesh is needed."""
        grid = rectilinear(sites) if self._method != "lazy" else None
        if grid is not None or self._method == "grid":
            return grid
        is_lazy = self._method == "lazy" or self._ndim > MOST
        return Lazily(np.ascontiguousarray(sites), as_workers(self._workers)) if is_lazy else None

    def _wants_no_mesh(self) -> bool:
        """Whether a mesh can be avoided; in 2-D and 3-D, only on request."""
        if self._method == "auto":
            return self._ndim > SPACE
        if self._method != "mesh" and (self._tolerance or self._extrapolate == "linear"):
            raise InputError(
                f"method={self._method!r:.20} has no gradients at the hull and no tolerance: "
                "choose extrapolate='nan', 'nearest' or 'raise'"
            )
        return self._method != "mesh"

    def _first_rows(self) -> Indices:
        return super()._first_rows() if self._implicit is None else self._implicit.first

    def _located(self, queries: Floats) -> Location:
        if self._implicit is None:
            return super()._located(queries)
        # Only whether they are inside.
        corners, _ = self._implicit.within(queries)
        count, d = queries.shape
        nowhere, none = np.full((count, d), np.nan), np.full((count, d), -1, np.int32)
        number = np.where(corners[:, 0] >= 0, 0, -1).astype(np.int32)
        weights = np.full((count, d + 1), np.nan)
        return Location(number, weights, nowhere, none[:, 0].copy(), none, nowhere)

    def __repr__(self) -> str:
        return super().__repr__() if self._implicit is None else f"<Linear on {self._implicit}>"

    @property
    def _projects(self) -> bool:
        """Whether queries outside have terms of simplices at the nearest points of the hull."""
        higher = self._implicit is not None or self._ndim > SPACE
        return higher and self._extrapolate == "nearest"

    def _at_nearest(self, queries: Floats) -> tuple[Indices, Floats]:
        """Return the corners of simplices, (k, d + 1), and weights; outside, those at the hull."""
        if isinstance(self._implicit, Rectilinear):
            low, high = (np.array([axis[k] for axis in self._implicit.axes]) for k in (0, -1))
            return nearest_in_box(low, high, queries, self._implicit.within)
        if self._implicit is not None:
            every = np.arange(len(self._implicit.points), dtype=np.int64)
            return nearest_terms(self._implicit.points, every, queries, self._implicit.within)
        rows = np.unique(self._mesh.boundary).astype(np.int64)
        return nearest_terms(self._mesh.points, rows, queries, self._corners_of)

    def _corners_of(self, queries: Floats) -> tuple[Indices, Floats]:
        """Return the corners of simplices of the mesh, -1 outside, and weights."""
        index: Any = self._mesh._locator
        simplex, weights = index.within(queries, as_workers(self._workers))
        corners = np.where(simplex[:, None] >= 0, self._mesh.simplices[simplex], np.int32(-1))
        return corners, weights

    def _interpolated(self, queries: Floats, columns: Floats) -> Floats:
        if not self._projects:
            return super()._interpolated(queries, columns)
        found = np.full((len(queries), columns.shape[1]), np.nan)
        for block in blocks(len(queries)):
            corners, weights = self._at_nearest(queries[block])
            known = np.flatnonzero(corners[:, 0] >= 0)
            found[block][known] = summed(Terms(corners[known], weights[known], None), columns, None)
        return found

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        if self._implicit is not None:
            along = self._implicit.gradients if order else self._implicit.values
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
        if self._projects:
            return Weights(*rectangular(*self._at_nearest(queries)), shape, self)
        if self._implicit is not None:
            if self._extrapolate == "raise":
                self._left(queries, None)
            return Weights(*rectangular(*self._implicit.within(queries)), shape, self)
        place = self._located(queries)
        weights, simplices = place.barycentric, self._sheet.simplices
        # If there are no triangles, `simplices` cannot be indexed, and all queries are outside.
        corners = (
            simplices[place.simplex] if len(simplices) else np.full(weights.shape, -1, np.int32)
        )
        table = rectangular(corners, weights)
        return Weights(*self._completed(table, queries, weights), shape, self)
