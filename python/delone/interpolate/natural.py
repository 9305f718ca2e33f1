"""Natural neighbor interpolation: weights from the Voronoi cells that a query would take over.

Sibson's weights are areas (R. Sibson, "A vector identity for the Dirichlet tessellation", 1980),
Laplace's are lengths over distances (N. H. Christ, R. Friedberg and T. D. Lee, "Weights of links
and plaquettes in a random lattice", 1982). Sibson's C1 interpolant ("A brief description of natural
neighbor interpolation", 1981) and Farin's ("Surfaces over Dirichlet tessellations", 1990) add
gradients at the sites.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_workers
from delone.delaunay import Delaunay
from delone.errors import InputError
from delone.interpolate.hull import Terms, edge_terms, plane_gradients
from delone.interpolate.smooth import Smooth
from delone.interpolate.space import SPACE, face_terms, hull_gradients, refuse
from delone.interpolate.weights import Weights

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats
    from delone._tiling.triangulation import Triangulation
    from delone.periodic import PeriodicDelaunay

__all__ = ["KINDS", "NaturalNeighbor"]

KINDS = ("sibson", "laplace", "sibson1", "farin")
_WITH_GRADIENTS = ("sibson1", "farin")


class NaturalNeighbor(Smooth):
    """Natural neighbor interpolation, C1 everywhere or except at the sites.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Sites; in 3-D the kind must be ``"laplace"``. A constrained triangulation needs
        ``respect_constraints=True``.
    values : array_like, shape (n,) or (n, ...), optional
        Real or complex values at the sites. Optional if each call passes its own values.
    kind : {"sibson", "laplace", "sibson1", "farin"}, optional
        Sibson's weights by area, C1 except at the sites; Laplace's weights by length, continuous
        and faster; Sibson's and Farin's interpolants from values and gradients, C1 everywhere.
    gradients : {"local", "plane", "global"}, optional
        How ``"sibson1"`` and ``"farin"`` estimate gradients at the sites; as in `CloughTocher`.
    tol, max_iter : optional
        As in `CloughTocher`.
    extrapolate : {"nan", "nearest", "linear", "raise"}, optional
        Behavior outside the hull: NaN; the value at the nearest point of the hull; linear
        extrapolation from that point, as in `Linear` or with the gradients of the kind; an error.
    tolerance : float, optional
        Queries outside at most this far from the hull are inside; as in `Linear`.
    duplicates, nan : str, optional
        As in `Linear`.
    respect_constraints : bool, optional
        On a constrained triangulation, neighbors must be visible, not hidden by a constraint.
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
    The weights of ``"sibson"`` and ``"laplace"`` are nonnegative, sum to 1 and have the query as
    their weighted mean. Linear functions are therefore reproduced up to rounding, even next to
    sites that almost coincide; where doubles cannot compute the weights, integers do. On an edge of
    the hull the interpolant is linear. ``"farin"`` with local gradients reproduces quadratic
    functions, and ``"sibson1"`` spherical ones (multiples of x² + y² plus a linear function), as
    far as the gradients do: see `CloughTocher`. Each query takes time linear in the number of its
    neighbors, about six. In 3-D, where the weights are areas over distances and there are about
    fifteen neighbors, values and weights are available but no derivatives. At a site the
    derivatives of ``"sibson"`` and ``"laplace"`` do not exist and are NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.interpolate import NaturalNeighbor
    >>> sites = np.array([(0, 0), (4, 0), (4, 4), (0, 4), (2, 3)])
    >>> area = NaturalNeighbor(sites, [0.0, 4.0, 8.0, 4.0, 5.0])
    >>> area([(2, 1), (2, 3), (3, 0)]).round(12)
    array([3., 5., 3.])
    >>> table = area.weights_at((2, 1))
    >>> (table.weights @ sites[table.indices]).round(12)
    array([2., 1.])
    """

    def __init__(
        self,
        points: ArrayLike | Triangulation | PeriodicDelaunay,
        values: ArrayLike | None = None,
        *,
        kind: str = "sibson",
        gradients: str = "local",
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
        self._kind = as_choice(kind, KINDS, name="kind")
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
        barred = self._respect_constraints and self._constrained
        if not (barred or isinstance(self._mesh, Delaunay)):
            raise InputError(
                "natural neighbors need a Delaunay triangulation; on a constrained one "
                "choose respect_constraints=True, or pass its points"
            )

    def _check_space(self, given: Triangulation | None) -> None:
        if given is not None and not isinstance(given, Delaunay):
            raise InputError(
                "in 3-D the sites of natural neighbors must be points or a Delaunay triangulation "
                f"of them, not a {type(given).__name__}; `Linear` takes it"
            )
        if self._kind != "laplace":
            refuse(f"kind={self._kind!r}", "choose kind='laplace'")

    def _needed(self) -> dict[str, bool]:
        rings = self._kind in _WITH_GRADIENTS and self._estimate == "global"
        return {"far": True, "rings": rings}

    @property
    def kind(self) -> str:
        """The kind of weights."""
        return self._kind

    def _gradients(self, columns: Floats) -> Floats | None:  # type: ignore[override]
        """Return gradients at the sites, or None if the kind needs none."""
        if self._kind in _WITH_GRADIENTS:
            return super()._gradients(columns)
        if self._extrapolate != "linear":
            return None
        threads = as_workers(self._workers)
        if self._ndim == SPACE:
            return hull_gradients(self._mesh, columns, threads)
        return plane_gradients(self._sheet.points, self._around(), columns, threads)

    def _require_gradients(self) -> None:
        if self._kind in _WITH_GRADIENTS:
            return
        if self._ndim == SPACE:
            refuse("site_gradients", f"kind={self._kind!r} has no gradients at the sites")
        instead = " or ".join(f"kind={kind!r}" for kind in _WITH_GRADIENTS)
        raise InputError(
            f"kind={self._kind!r:.80} has no gradients at the sites: choose {instead}, "
            "or get the gradient of the interpolant anywhere else with gradient(xi)"
        )

    def _derived(self, queries: Floats, columns: Floats, order: int) -> Floats:
        if self._ndim == SPACE:
            return self._in_space(queries, columns, order)
        sheet = self._sheet
        found: Floats = sheet.locator.natural_values(
            self._kind,
            columns,
            self._gradients(columns) if self._kind in _WITH_GRADIENTS else None,
            queries,
            sheet.barrier,
            order,
            as_workers(self._workers),
        )
        return found

    def _in_space(self, queries: Floats, columns: Floats, order: int) -> Floats:
        """Values from weights."""
        if order:
            refuse("the gradient of kind='laplace'", "Linear has one")
        threads = as_workers(self._workers)
        found = self._sheet.locator.laplace(queries, threads)
        table = found.indptr, found.indices, found.weights
        return _core.combine2(*table, columns, None, None, threads)

    def _terms(self, place: Any, step: Floats, base: bool) -> Terms:
        if self._ndim == SPACE:
            return face_terms(place, step, base=base)
        cubic = self._kind in _WITH_GRADIENTS
        return edge_terms(self._sheet.points, place, step, cubic=cubic, base=base)

    def _table(self, queries: Floats, shape: tuple[int, ...]) -> Weights:
        sheet, threads = self._sheet, as_workers(self._workers)
        if self._ndim == SPACE:
            found = sheet.locator.laplace(queries, threads)
        else:
            found = sheet.locator.natural(self._kind, queries, sheet.barrier, threads)
        inner = (found.indptr, found.indices, found.weights, found.slopes)
        known = np.where(found.simplex >= 0, 0.0, np.nan)[:, None]
        return Weights(*self._completed(inner, queries, known), shape, self)
