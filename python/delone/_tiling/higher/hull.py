"""Convex hulls in four to eight dimensions: their arrays, and measures of facets."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._tiling import measures
from delone._tiling.higher.topology import distinct

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["areas", "hull_arrays", "normals"]


def hull_arrays(points: Floats) -> dict[str, NDArray[Any]]:
    """Return the arrays of a hull; `polygons` lists the vertices of each facet, ascending."""
    found = _core.hull_n(points)
    d = found.simplices.shape[1]
    # Encode each distinct pair of facet and corner as one number.
    owner = np.repeat(found.facet_of, d).astype(np.int64)
    keys = distinct(owner * len(points) + found.simplices.reshape(-1))
    facet, polygons = np.divmod(keys, len(points))
    starts = np.searchsorted(facet, np.arange(int(found.facet_of.max(initial=-1)) + 2))
    vertices = np.unique(found.simplices).astype(np.int32)
    repeats = np.isin(found.duplicates[:, 1], vertices)
    return {
        "simplices": found.simplices,
        "neighbors": found.neighbors,
        "vertices": vertices,
        "facet_of": found.facet_of,
        "inside": found.inside,
        "polygons": polygons.astype(np.int32),
        "starts": starts.astype(np.int32),
        "duplicates": np.ascontiguousarray(found.duplicates[repeats]),
    }


def normals(points: Floats, facets: Indices, inside: Indices) -> Floats:
    """Return outer unit normals of facets, (k, d), with errors below 1e-12.

    `inside` is, for each facet, the row of a point of the hull that is not in its plane.
    """
    maps = measures.transform(points, np.column_stack((inside, facets)))
    # The coordinate of the interior point decreases toward the facet.
    inward = maps[:, 0]
    with np.errstate(all="ignore"):
        scaled = inward / np.abs(inward).max(axis=1, keepdims=True)
        found: Floats = -scaled / _lengths(scaled)[:, None]
    return found


def areas(points: Floats, facets: Indices, inside: Indices, workers: int | None) -> Floats:
    """Return the (d - 1)-dimensional areas of facets, with a relative error below 1e-12."""
    cones = np.column_stack((inside, facets))
    # The volume of a cone is base times height divided by d; the height is 1 / slope.
    slope = _lengths(measures.transform(points, cones)[:, 0])
    volumes = np.abs(measures.sizes(points, cones, workers))
    found: Floats = volumes * points.shape[1] * slope
    return found


def _lengths(rows: Floats) -> Floats:
    """Return lengths of rows, (k,), without overflow."""
    return np.array([math.hypot(*row) for row in rows.tolist()])
