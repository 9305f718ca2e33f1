"""Centroidal diagrams by Lloyd's method: sites go to the centroids of their cells, repeatedly.

S. P. Lloyd, "Least squares quantization in PCM", IEEE Transactions on Information Theory 28 (1982);
Q. Du, V. Faber and M. Gunzburger, "Centroidal Voronoi tessellations", SIAM Review 41 (1999).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError
from delone.voronoi.diagram import Voronoi

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
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


@dataclass(frozen=True, eq=False, kw_only=True)
class LloydResult:
    """What Lloyd's method came to.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites where they are now.
    diagram : Voronoi
        Their diagram, clipped.
    iterations : int
        How often the sites were moved.
    converged : bool
        Whether the last step moved no site by more than `tol`; False where there was no `tol`.
    displacements : ndarray of float64, shape (iterations,)
        How far the site that moved furthest went, in each step.
    energies : ndarray of float64, shape (iterations + 1,)
        The integral of density times squared distance to the nearest site, before the first step
        and after each.
    empty : ndarray of int64, shape (k,)
        Sites that have no cell within the clip, and so have not moved in the last step.
    """

    points: Floats
    diagram: Voronoi
    iterations: int
    converged: bool
    displacements: Floats
    energies: Floats
    empty: NDArray[np.int64]


def lloyd(
    points: ArrayLike,
    clip: Any,
    *,
    iterations: int = 100,
    tol: float | None = None,
    density: Density | None = None,
    progress: Callable[[int, float, float], object] | None = None,
    workers: int | None = None,
) -> LloydResult:
    """Move sites to the centroids of their cells until they rest there.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Where the sites are at first.
    clip : "box", sequence of 4 floats, or geometry
        The domain, as for `Voronoi`. ``"box"`` is the box of the sites as they are at first.
    iterations : int, optional
        How many steps to make at most.
    tol : float, optional
        End as soon as no site moves further than this, in the unit of the points.
    density : callable, optional
        Takes places, (k, 2), and returns a positive number for each, (k,): sites will be denser
        where it is larger. It may be asked for places outside an outline that is not convex, but
        within its box. By default it is 1 everywhere.
    progress : callable, optional
        Is told after each step its number (from 1), how far the site that moved furthest went, and
        the energy.
    workers : int, optional
        How many threads may work; by default one for each core.

    Returns
    -------
    LloydResult
        Sites, their diagram, and how it went.

    Raises
    ------
    InputError
        `clip` is None or not what `Voronoi` takes; `iterations` or `tol` is negative; or `density`
        returns another number of values, or some that are negative or not finite.

    Notes
    -----
    The energy falls with each step, and sites converge to a place where each is the centroid of its
    cell: a local minimum, as a rule. Convergence is linear and slows down with the number of sites.

    Integrals are exact up to rounding without `density`, and take its values at seven places in
    each triangle between a cell's centroid and an edge with it. A site whose cell is empty stays
    where it is, and sites with the same coordinates stay together.

    Examples
    --------
    >>> from delone import lloyd
    >>> result = lloyd([(0.1, 0.5), (0.3, 0.5)], (0, 0, 1, 1), tol=1e-9)
    >>> result.converged, result.points.round(6).tolist()
    (True, [[0.25, 0.5], [0.75, 0.5]])
    """
    if clip is None:
        raise InputError("lloyd needs a clip: without one, cells have no centroids")
    if iterations < 0:
        raise InputError(f"iterations must not be negative, got {iterations}")
    if tol is not None and not tol >= 0:
        raise InputError(f"tol must not be negative, got {tol}")
    diagram = Voronoi(points, clip=clip, workers=workers)
    domain = diagram.clip
    centers, energy = _step(diagram, density)
    displacements: list[float] = []
    energies = [energy]
    converged = False
    while len(displacements) < iterations and not converged:
        moved = float(np.hypot(*(centers - diagram.points).T).max())
        diagram = Voronoi(centers, clip=domain, workers=workers)
        centers, energy = _step(diagram, density)
        displacements.append(moved)
        energies.append(energy)
        converged = tol is not None and moved <= tol
        if progress is not None:
            progress(len(displacements), moved, energy)
    return LloydResult(
        points=diagram.points,
        diagram=diagram,
        iterations=len(displacements),
        converged=converged,
        displacements=np.array(displacements),
        energies=np.array(energies),
        empty=np.flatnonzero(diagram.cell_areas == 0),
    )


def _step(diagram: Voronoi, density: Density | None) -> tuple[Floats, float]:
    """Where the sites go next, and the energy as they are."""
    clipped, region = diagram._clipped, diagram.point_region
    cell, begin, end = clipped.edges()
    origin = clipped.centroids
    a, b = begin - origin[cell], end - origin[cell]
    # Signed, so that rings around holes and notches take away what others have counted.
    size = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2
    site = diagram.points[diagram._dual["site"]]
    mass, moment, energy = np.zeros(len(origin)), np.zeros_like(origin), 0.0
    for place, share in zip(_PLACES, _SHARES, strict=True):
        at = place[1] * a + place[2] * b
        amount = share * size * _density(density, at + origin[cell])
        mass += np.bincount(cell, amount, len(origin))
        for k in range(2):
            moment[:, k] += np.bincount(cell, amount * at[:, k], len(origin))
        way = at + (origin - site)[cell]
        energy += float((amount * (way * way).sum(axis=1)).sum())
    centers = site.copy()
    filled = mass > 0
    centers[filled] = origin[filled] + moment[filled] / mass[filled, None]
    return centers[region], energy


def _density(density: Density | None, places: Floats) -> Floats | float:
    if density is None:
        return 1.0
    values = np.asarray(density(places), dtype=np.float64)
    if values.shape != (len(places),):
        raise InputError(f"density returned shape {values.shape} for {len(places)} places")
    if not (np.isfinite(values) & (values >= 0)).all():
        wrong = int(np.flatnonzero(~(np.isfinite(values) & (values >= 0)))[0])
        raise InputError(
            f"density returned {values[wrong]} at {places[wrong].tolist()}: it must be finite and "
            f"not negative"
        )
    return values
