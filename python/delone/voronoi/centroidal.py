"""Centroidal Voronoi diagrams: sites move to the centroids of their cells, repeatedly.

Lloyd's method moves each site to its centroid, by the gradient of the energy divided by twice the
mass of the cell. The quasi-Newton method L-BFGS starts with this step and estimates the curvature
of the energy from the last steps.

S. P. Lloyd, "Least squares quantization in PCM", IEEE Transactions on Information Theory 28 (1982);
Q. Du, V. Faber and M. Gunzburger, "Centroidal Voronoi tessellations", SIAM Review 41 (1999);
J. Nocedal, "Updating quasi-Newton matrices with limited storage", Mathematics of Computation 35
(1980); Y. Liu, W. Wang, B. Lévy et al., "On centroidal Voronoi tessellation: energy smoothness and
fast computation", ACM Transactions on Graphics 28 (2009).
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_callback, as_choice, as_limit, as_number
from delone._base.immutable import ReadOnly
from delone._base.values import require_real
from delone.errors import InputError
from delone.voronoi import outline
from delone.voronoi.diagram import Voronoi

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

    Density = Callable[[Floats], ArrayLike]

__all__ = ["LloydResult", "lloyd"]

# J. Radon's seven points of degree 5 on a triangle: barycentric coordinates and weights.
_ROOT = math.sqrt(15)
_CENTER = [1 / 3] * 3
_NEAR, _FAR = (6 - _ROOT) / 21, (6 + _ROOT) / 21
_PLACES = np.array(
    [_CENTER]
    + [np.roll([1 - 2 * _NEAR, _NEAR, _NEAR], k).tolist() for k in range(3)]
    + [np.roll([1 - 2 * _FAR, _FAR, _FAR], k).tolist() for k in range(3)]
)
_SHARES = np.array([9 / 40] + [(155 - _ROOT) / 1200] * 3 + [(155 + _ROOT) / 1200] * 3)


_METHODS = ("lloyd", "l-bfgs")
# Steps that L-BFGS remembers, as in Liu et al.; successively shorter attempts before a direction is
# abandoned; the fraction of the slope by which the energy must decrease; the relative rounding
# error allowed for the energy.
_MEMORY, _TRIES, _FALL, _ROUNDING = 7, 4, 1e-4, 1e-14


@dataclass(frozen=True, eq=False, kw_only=True)
class LloydResult(ReadOnly):
    """The result of `lloyd`.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites at their final positions.
    diagram : Voronoi
        Their diagram, clipped.
    iterations : int
        Number of steps.
    converged : bool
        Whether no site was farther than `tol` from the centroid of its cell before the last step;
        False without `tol`.
    displacements : ndarray of float64, shape (iterations,)
        The largest distance of a site from the centroid of its cell, before each step. With Lloyd's
        method, this is the largest step.
    energies : ndarray of float64, shape (iterations + 1,)
        The integral of density times squared distance to the nearest site, before the first step
        and after each.
    empty : ndarray of int64, shape (k,)
        Sites without a cell within the clip, which therefore did not move in the last step.
    evaluations : int
        Number of diagrams that were computed: one more than the number of steps, plus those of the
        steps that L-BFGS rejected.

    Examples
    --------
    >>> from delone import lloyd
    >>> result = lloyd([(0.1, 0.5), (0.3, 0.5)], (0, 0, 1, 1), max_iter=3)
    >>> result.iterations, result.converged, len(result.energies), result.evaluations
    (3, False, 4, 4)
    """

    points: Floats
    diagram: Voronoi
    iterations: int
    converged: bool
    displacements: Floats
    energies: Floats
    empty: NDArray[np.int64]
    evaluations: int


def lloyd(
    points: ArrayLike,
    clip: Any,
    *,
    max_iter: int = 100,
    tol: float | None = None,
    density: Density | None = None,
    method: str = "lloyd",
    progress: Callable[[int, float, float], object] | None = None,
    workers: int | None = None,
) -> LloydResult:
    """Move sites to the centroids of their cells until they converge.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        The initial sites.
    clip : "box", sequence of 4 floats, or geometry
        The domain, as for `Voronoi`. ``"box"`` is the bounding box of the initial sites.
    max_iter : int, optional
        Maximum number of steps.
    tol : float, optional
        Stop when no site is farther than this from the centroid of its cell, in the unit of the
        points.
    density : callable, optional
        Takes positions, (k, 2), and returns a nonnegative number for each, (k,), not all 0: sites
        are denser where it is larger. It may be called for positions outside a nonconvex outline,
        but within its bounding box. By default, it is 1 everywhere.
    method : {"lloyd", "l-bfgs"}, optional
        How to compute steps: move each site to its centroid, or use a quasi-Newton method, which
        needs fewer steps to converge.
    progress : callable, optional
        Called after each step with its number (from 1), the largest distance of a site from the
        centroid of its cell before it, and the energy.
    workers : int, optional
        Maximum number of threads; by default one per core.

    Returns
    -------
    LloydResult
        Sites, their diagram, and the history of the iteration.

    Raises
    ------
    InputError
        `clip` is None or not accepted by `Voronoi`; `max_iter` or `tol` is negative; `method` is
        unknown; or `density` returns the wrong number of values, values that are negative or not
        finite, or only zeros.
    DtypeError
        `max_iter` is not an integer, `tol` not a number, `density` or `progress` not a function,
        or `density` does not return numbers.

    Notes
    -----
    The energy decreases with each step, and sites converge to positions where each is the centroid
    of its cell: usually a local minimum. Convergence of Lloyd's method is linear and slows down
    with the number of sites. L-BFGS converges in several times fewer steps, usually to a different,
    slightly lower minimum; if it finds no descent direction, it makes a step of Lloyd's method.

    Integrals are exact up to rounding without `density`; with it, they use its values at seven
    positions in each triangle between the centroid of a cell and an edge. A site whose cell is
    empty does not move, and sites with the same coordinates stay together.

    Examples
    --------
    >>> from delone import lloyd
    >>> result = lloyd([(0.1, 0.5), (0.3, 0.5)], (0, 0, 1, 1), tol=1e-9)
    >>> result.converged, result.points.round(6).tolist()
    (True, [[0.25, 0.5], [0.75, 0.5]])
    """
    if clip is None:
        raise InputError("lloyd needs a clip: without one, some cells have no centroids")
    max_iter = as_limit(max_iter, name="max_iter")
    tol = None if tol is None else as_number(tol, name="tol")
    if tol is not None and not tol >= 0:
        raise InputError(f"tol must not be negative, got {tol}")
    for name, function in (("density", density), ("progress", progress)):
        as_callback(function, name=name)
    quasi_newton = as_choice(method, _METHODS, name="method") == "l-bfgs"
    diagram = Voronoi(points, clip=clip, workers=workers)
    if diagram.ndim != 2:
        raise InputError("lloyd is only available in 2-D; 3-D diagrams have cell_centroids")
    domain = diagram.clip
    unit = outline.unit_of(np.array(getattr(domain, "bounds", domain)))
    if unit != 1:
        scaled = outline.as_scaled(domain, unit)
        found_in_units = lloyd(
            diagram.points * unit,
            scaled,
            max_iter=max_iter,
            tol=None if tol is None else tol * unit,
            density=None if density is None else lambda places: density(places / unit),
            method=method,
            progress=None
            if progress is None
            else lambda step, away, energy: progress(step, away / unit, float(_back(energy, unit))),
            workers=workers,
        )
        found = _scaled_back(found_in_units, domain, unit, workers)
    else:
        found = _iterated(
            diagram, max_iter, tol, density=density, quasi_newton=quasi_newton, progress=progress
        )
    found.diagram._refer(diagram)
    return found


def _iterated(
    diagram: Voronoi,
    max_iter: int,
    tol: float | None,
    *,
    density: Density | None,
    quasi_newton: bool,
    progress: Callable[[int, float, float], object] | None,
) -> LloydResult:
    """Move the sites of a diagram until they converge or reach the maximum number of steps."""
    workers = diagram._workers
    at = _state(diagram, density)
    displacements: list[float] = []
    energies = [at.energy]
    converged = False
    memory = _Memory()
    evaluations = 1
    while len(displacements) < max_iter and not converged:
        away = float(np.hypot(*(at.centers - at.sites).T).max())
        converged = tol is not None and away <= tol
        found = None
        if quasi_newton and not converged:
            found, tries = _descent(at, memory, density, workers)
            evaluations += tries
        if found is None:
            memory.forget()
            found = _state(Voronoi(at.centers, clip=diagram._cells.clip, workers=workers), density)
            evaluations += 1
        if quasi_newton:
            memory.learn(at, found)
        at = found
        displacements.append(away)
        energies.append(at.energy)
        if progress is not None:
            progress(len(displacements), away, at.energy)
    return LloydResult(
        points=at.diagram.points,
        diagram=at.diagram,
        iterations=len(displacements),
        converged=converged,
        displacements=np.array(displacements),
        energies=np.array(energies),
        empty=np.flatnonzero(at.diagram.cell_areas == 0),
        evaluations=evaluations,
    )


def _back(energy: Any, unit: float) -> Any:
    """Return an energy, a fourth power of lengths, that was computed in other units."""
    with np.errstate(over="ignore", under="ignore"):
        return np.multiply(energy, 1 / unit) / unit / unit / unit


def _scaled_back(result: LloydResult, domain: Any, unit: float, workers: int | None) -> LloydResult:
    """Return a result that was computed in units of a power of two, to avoid overflow."""
    diagram = Voronoi(result.points / unit, clip=domain, workers=workers)
    return replace(
        result,
        points=diagram.points,
        diagram=diagram,
        displacements=result.displacements / unit,
        energies=_back(result.energies, unit),
    )


class _State(NamedTuple):
    """Sites, their diagram, its centroids and masses, and the energy."""

    diagram: Voronoi
    sites: Floats
    centers: Floats
    masses: Floats
    energy: float

    @property
    def gradient(self) -> Floats:
        """The derivative of the energy with respect to each coordinate."""
        slopes: Floats = 2 * self.masses[:, None] * (self.sites - self.centers)
        return slopes


class _Memory:
    """The last steps and the change of the gradient on each, from which L-BFGS computes steps."""

    def __init__(self) -> None:
        self._steps: deque[tuple[Floats, Floats, float]] = deque(maxlen=_MEMORY)

    def forget(self) -> None:
        """Remove all steps."""
        self._steps.clear()

    def learn(self, before: _State, after: _State) -> None:
        """Add a step along which the energy is convex; others would corrupt the estimate."""
        step, change = after.sites - before.sites, after.gradient - before.gradient
        product = float((step * change).sum())
        if product > 0:
            self._steps.append((step, change, product))

    def direction(self, at: _State) -> Floats:
        """Return the step to where the gradient should vanish: initially that of Lloyd's method."""
        with np.errstate(divide="ignore"):
            inverse = np.where(at.masses > 0, 0.5 / at.masses, 0.0)[:, None]
        rest = at.gradient
        shares = []
        for step, change, product in reversed(self._steps):
            share = float((step * rest).sum()) / product
            shares.append(share)
            rest = rest - share * change
        scale = 1.0
        if self._steps:
            _, change, product = self._steps[-1]
            scale = product / float((change * change * inverse).sum())
        found: Floats = scale * inverse * rest
        for (step, change, product), share in zip(self._steps, reversed(shares), strict=True):
            back = float((change * found).sum()) / product
            found = found + (share - back) * step
        return -found


def _descent(
    at: _State, memory: _Memory, density: Density | None, workers: int | None
) -> tuple[_State | None, int]:
    """Return an L-BFGS step that lowers the energy and keeps all cells, and the tries."""
    step = memory.direction(at)
    slope = float((at.gradient * step).sum())
    filled = int((at.masses > 0).sum())
    tries = 0
    while slope < 0 and tries < _TRIES:
        share = 0.5**tries
        tries += 1
        moved = Voronoi(at.sites + share * step, clip=at.diagram._cells.clip, workers=workers)
        found = _state(moved, density)
        enough = at.energy + _FALL * share * slope + _ROUNDING * at.energy
        if found.energy <= enough and int((found.masses > 0).sum()) >= filled:
            return found, tries
    return None, tries


def _state(diagram: Voronoi, density: Density | None) -> _State:
    """Return the diagram of sites with masses, centroids and the energy."""
    clipped, region = diagram._left, diagram.point_region
    cell, begin, end = clipped.edges()
    origin = clipped.centroids
    a, b = begin - origin[cell], end - origin[cell]
    # Signed, so that rings around holes and notches are subtracted.
    size = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    site = diagram.points[diagram._cells.dual.site]
    centers = site.copy()
    if density is None:
        mass = clipped.areas
        filled = mass > 0
        centers[filled] = origin[filled]
        # The integral of x.x over a triangle with corners 0, a and b.
        inertia = size / 6 * ((a + b) * (a + b) - a * b).sum(axis=1)
        step = centers - site
        energy = float(inertia.sum() + (mass * (step * step).sum(axis=1)).sum())
        return _State(diagram, diagram.points, centers[region], mass[region], energy)
    mass, moment, energy = np.zeros(len(origin)), np.zeros_like(origin), 0.0
    for place, share in zip(_PLACES, _SHARES, strict=True):
        at = place[1] * a + place[2] * b
        amount = share * size * _density(density, at + origin[cell])
        mass += np.bincount(cell, amount, len(origin))
        for k in range(2):
            moment[:, k] += np.bincount(cell, amount * at[:, k], len(origin))
        away = at + (origin - site)[cell]
        energy += float((amount * (away * away).sum(axis=1)).sum())
    filled = mass > 0
    if not filled.any():
        raise InputError("density returned only zeros: no cell has a centroid")
    centers[filled] = origin[filled] + moment[filled] / mass[filled, None]
    return _State(diagram, diagram.points, centers[region], mass[region], energy)


def _density(density: Density, places: Floats) -> Floats:
    given = np.asarray(density(places))
    require_real(given, "the result of density", kinds="biuf")
    values = given.astype(np.float64)
    if values.shape != (len(places),):
        raise InputError(f"density returned shape {values.shape} for {len(places)} places")
    if not (np.isfinite(values) & (values >= 0)).all():
        wrong = int(np.flatnonzero(~(np.isfinite(values) & (values >= 0)))[0])
        raise InputError(
            f"density returned {values[wrong]} at {places[wrong].tolist()}: it must be finite and "
            f"not negative"
        )
    return values
