"""Clough-Tocher: three cubics per triangle, with continuous first derivatives.

The scheme is the reduced one: the derivative across an edge is linear along it, in the direction
that joins the centroids of its two triangles (P. Alfeld, "A trivariate Clough-Tocher scheme for
tetrahedral data", 1984; G. Farin, "Triangular Bernstein-Bézier patches", 1986). Gradients at the
sites minimize the curvature along the edges (G. M. Nielson, "A method for interpolating scattered
data based upon a minimum norm network", 1983) or come from a least-squares quadric.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_workers
from delone.interpolate.smooth import Smooth
from delone.interpolate.space import refuse
from delone.interpolate.weights import Weights

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["CloughTocher"]


class CloughTocher(Smooth):
    """Piecewise cubic interpolation with continuous first derivatives.

    Parameters
    ----------
    points : array_like, shape (n, 2), or a triangulation
        Sites.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    gradients : {"global", "local", "plane"}, optional
        How gradients at the sites are estimated. ``"global"``: minimize the total curvature along
        all edges, as SciPy does. ``"local"``: at each site, the quadric through it that best fits
        its neighbors and their neighbors, with nearer ones weighted more, unless the quadric
        oscillates. ``"plane"``: the plane that best fits the neighbors. A quadric oscillates if it
        changes with the values more than three times as much as the plane does, as between the
        tracks of soundings; the plane is then used instead.
    tol : float, optional
        Change at which the global estimation stops, relative to the gradient, or to the range of
        the values divided by the longer side of the bounding box of the sites if that is larger.
        The result is therefore independent of the units of length and of the values.
    max_iter : int, optional
        Maximum number of sweeps; if it is reached, a `GradientWarning` is issued.
    extrapolate : {"nan", "nearest", "linear", "raise"}, optional
        Behavior outside the hull: NaN; the value at the nearest point of the hull; linear
        extrapolation from that point with the gradients of its sites; an error.
    tolerance : float, optional
        Queries outside at most this far from the hull are inside; as in `Linear`.
    duplicates, nan : str, optional
        As in `Linear`.
    respect_constraints : bool, optional
        On a constrained triangulation, the surface may break along constraints, and only the values
        on a constraint affect both of its sides.
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
    Local gradients reproduce linear and quadratic functions up to rounding, and global ones
    reproduce linear functions up to `tol`. Next to sites whose distance is below 1e-5 of the
    distance to other sites, a rounding error of up to about 1e-11 of the values remains, and across
    the edge between them the first derivatives may differ; near sites within 1e-10 of a line it is
    about 1e-8. Global gradients rely on the slope between two sites however close they are; choose
    ``"local"`` for such data. If a site has more than 32 neighbors, other sites use those around
    them and some of the rest. Local gradients take O(n log n), and each sweep of the global
    estimation O(n); few sweeps are needed if the sites are evenly spread. Unknown values
    (``nan="propagate"``) do not affect the gradients of other sites. A slope beyond the range of
    doubles is ignored.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import CloughTocher
    >>> x, y = np.random.default_rng(3).random((2, 200))
    >>> bowl = CloughTocher(np.column_stack((x, y)), x**2 + y**2, gradients="local")
    >>> bowl((0.5, 0.5)).round(9), bowl.gradient((0.5, 0.5)).round(9)
    (np.float64(0.5), array([1., 1.]))
    >>> bowl.hessian((0.5, 0.5)).round(6) + 0.0
    array([[2., 0.],
           [0., 2.]])
    """

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        gradients: str = "global",
        tol: float = 1e-6,
        max_iter: int = 400,
        extrapolate: str = "nan",
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
            gradients=gradients,
            tol=tol,
            max_iter=max_iter,
            extrapolate=extrapolate,
            tolerance=tolerance,
            duplicates=duplicates,
            nan=nan,
            respect_constraints=respect_constraints,
            workers=workers,
            planar=planar,
        )

    def _check_space(self, given: Triangulation | None) -> None:
        refuse("CloughTocher", "choose Linear, or NaturalNeighbor with kind='laplace'")

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        sheet = self._sheet
        found: Floats = sheet.locator.clough_tocher(
            columns,
            self._gradients(columns),
            queries,
            sheet.barrier,
            order,
            as_workers(self._workers),
        )
        return found

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        sheet = self._sheet
        found = sheet.locator.clough_tocher_weights(
            queries, sheet.barrier, as_workers(self._workers)
        )
        triangle, weights, slopes = found.simplex, found.weights, found.slopes
        counts = (triangle >= 0)[:, None] & ((weights != 0) | (slopes != 0).any(axis=2))
        indptr = np.concatenate(([0], np.cumsum(counts.sum(axis=1))))
        query, corner = np.nonzero(counts)
        vertices = sheet.simplices[triangle[query], corner]
        table = (indptr, vertices, weights[counts], slopes[counts])
        return Weights(*self._completed(table, queries, weights), shape, self)
