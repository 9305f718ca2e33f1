"""Linear interpolation at the points of a hull that are nearest to queries, in any dimension.

The nearest point is the one of smallest norm in the hull of the differences from the query, which
an active set method finds (P. Wolfe, "Finding the nearest point in a polytope", Mathematical
Programming 11, 1976). It is rounded, so it may be outside by its last bits. Then it is moved toward
the mean of the points until the exact location finds a simplex.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Floats, Indices, Rows

    # Rows of corners of queries, (k, d + 1), -1 outside, and their weights.
    Within = Callable[[Floats], tuple[Indices, Floats]]

__all__ = ["nearest_in_box", "nearest_terms"]

# How far points are moved toward the mean of the points, one after another.
_SHARES = (0.0, *(2.0**-k for k in range(50, 9, -5)))
# Steps of the active set for each coordinate; the method is finite, and takes about two.
_STEPS = 100
_EPS = float(np.finfo(float).eps)


def nearest_in_box(low: Floats, high: Floats, queries: Floats, within: Within) -> tuple[
    Indices, Floats
]:  # fmt: skip
    """Return corners and weights at the nearest points of a box; infinite queries have none."""
    finite = np.all(np.isfinite(queries), axis=1, keepdims=True)
    return within(np.where(finite, np.clip(queries, low, high), np.nan))


def nearest_terms(points: Floats, rows: Rows, queries: Floats, within: Within) -> tuple[
    Indices, Floats
]:  # fmt: skip
    """Return corners and weights at queries, or at the nearest points of the hull of `rows`.

    Queries with a coordinate that is not finite have none.
    """
    corners, weights = within(queries)
    left = np.flatnonzero((corners[:, 0] < 0) & np.all(np.isfinite(queries), axis=1))
    if not len(left):
        return corners, weights
    corners, weights = corners.copy(), weights.copy()
    sites = points[rows]
    middle = (sites / len(sites)).sum(axis=0)
    places = np.empty((len(left), points.shape[1]))
    for k, row in enumerate(left.tolist()):
        active, shares = _nearest(sites, queries[row])
        places[k] = shares @ sites[active]
        # If no simplex is found, the corners of a face of the hull.
        corners[row], weights[row] = 0, 0.0
        corners[row, : len(active)] = rows[active]
        weights[row, : len(active)] = shares
    for share in _SHARES:
        found, parts = within((1 - share) * places + share * middle)
        inside = found[:, 0] >= 0
        corners[left[inside]], weights[left[inside]] = found[inside], parts[inside]
        left, places = left[~inside], places[~inside]
        if not len(left):
            break
    return corners, weights


def _nearest(points: Floats, query: Floats) -> tuple[Rows, Floats]:
    """Return points of the hull whose combination is nearest to a query, and their weights.

    There are at most d + 1 of them.
    """
    # By halves, since a difference may be larger than any double.
    ends = points / 2 - query / 2
    ends /= np.abs(ends).max()
    norms = np.linalg.norm(ends, axis=1)
    size = float(norms.max())
    active, shares = [int(norms.argmin())], np.ones(1)
    place = ends[active[0]]
    for _ in range(_STEPS * (points.shape[1] + 1)):
        products = ends @ place
        best = int(products.argmin())
        gap = place @ place - products[best]
        if best in active or gap <= 4 * _EPS * size * np.linalg.norm(place):
            break
        trial, parts = _reduced(ends, [*active, best], np.append(shares, 0.0))
        new = parts @ ends[trial]
        if new @ new >= place @ place:
            break
        active, shares, place = trial, parts, new
    return np.array(active, dtype=np.int64), shares


def _reduced(ends: Floats, active: list[int], shares: Floats) -> tuple[list[int], Floats]:
    """Return the points, and weights, of the nearest point of the hull of active ones.

    Each step removes one of them, so there are at most as many.
    """
    while len(active) > 1:
        base, sides = ends[active[0]], ends[active[1:]] - ends[active[0]]
        rest = np.linalg.lstsq(sides.T, -base, rcond=None)[0]
        wanted = np.append(1 - rest.sum(), rest)
        if (wanted > 0).all():
            return active, wanted
        # As far toward the nearest point of their plane as possible without a negative weight.
        falling = np.flatnonzero(wanted <= 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios = shares[falling] / (shares[falling] - wanted[falling])
        ratios = np.where(np.isfinite(ratios), ratios, 0.0)
        least = float(ratios.min())
        shares = np.maximum(shares + least * (wanted - shares), 0.0)
        gone = int(falling[ratios.argmin()])
        active = active[:gone] + active[gone + 1 :]
        shares = np.delete(shares, gone)
        shares /= shares.sum()
    return active, np.ones(1)
