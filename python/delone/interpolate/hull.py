"""Extrapolation beyond the hull: terms at the nearest point of the boundary and a step from it.

On a boundary edge, the interpolants here depend only on its two ends: linearly or, for the smooth
ones, as the cubic with their values and gradients. They are evaluated there without deciding on
which side of the edge the rounded nearest point lies.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone._tiling.location import Location

__all__ = ["Terms", "edge_terms", "plane_gradients", "summed"]


class Terms(NamedTuple):
    """Vertices with weights of their values and gradients, the same number for each query."""

    rows: Indices  # (k, v)
    weights: Floats  # of the values, (k, v)
    slopes: Floats | None  # weights of the gradients, (k, v, d)


def edge_terms(
    points: Floats, place: Location, step: Floats, *, cubic: bool, base: bool = True
) -> Terms:
    """The terms of an interpolant on the boundary, and of a `step`, (k, 2), away from it.

    With `cubic` it is the cubic of values and gradients at the ends, otherwise linear; without
    `base` only the step counts. Steps use the gradients of the ends, interpolated linearly along
    the edge, which is continuous at corners of the hull as well. The triangle at the boundary is
    not used: it is often so thin that its plane is meaningless.
    """
    s = place.weights[:, 1]
    shares = place.weights
    slopes = shares[..., None] * step[:, None]
    weights = np.zeros_like(shares)
    if base and cubic:
        weights = np.stack(((1 - s) ** 2 * (1 + 2 * s), s**2 * (3 - 2 * s)), axis=1)
        tangents = np.stack((s * (1 - s) ** 2, -(s**2) * (1 - s)), axis=1)
        # By halves, as an edge may be longer than any double; a tangent is a seventh at most.
        half = points[place.facet[:, 1]] / 2 - points[place.facet[:, 0]] / 2
        slopes += 2 * (tangents[..., None] * half[:, None])
    elif base:
        weights = shares
    return Terms(place.facet, weights, slopes if cubic or step.any() else None)


def plane_gradients(
    points: Floats, neighborhood: tuple[Indices, Indices], columns: Floats, workers: int
) -> Floats:
    """The gradients, (n, c, 2), of the planes through points that best fit their neighbors."""
    return _core.gradients_local2(points, *neighborhood, columns, 1, workers)


def summed(terms: Terms, columns: Floats, gradients: Floats | None) -> Floats:
    """The sums of terms, (k, c).

    Values with zero weight are not read, so their NaN or sign of zero has no effect.
    """
    found = np.full((len(terms.rows), columns.shape[1]), -0.0)
    for k in range(terms.rows.shape[1]):
        rows, weight = terms.rows[:, k], terms.weights[:, k, None]
        found += np.where(weight == 0, -0.0, weight * columns[rows])
        if terms.slopes is not None and gradients is not None:
            slope = terms.slopes[:, k]
            rise = np.einsum("kcj,kj->kc", gradients[rows], slope)
            found += np.where((slope == 0).all(axis=1)[:, None], -0.0, rise)
    return found
