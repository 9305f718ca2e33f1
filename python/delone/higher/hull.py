"""Convex hulls in four to eight dimensions: their arrays, and measures of facets."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core, measures

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._types import Floats, Indices

__all__ = ["areas", "hull_arrays", "normals"]


def hull_arrays(points: Floats) -> dict[str, NDArray[Any]]:
    """Return the arrays of a hull; `polygons` are the vertices of facets, ascending."""
    found = _core.hull_n(points)
    d = found.simplices.shape[1]
    # Each corner once for each facet, as one number.
    owner = np.repeat(found.facet_of, d).astype(np.int64)
    keys = np.unique(owner * len(points) + found.simplices.reshape(-1))
    facet, polygons = np.divmod(keys, len(points))
    starts = np.searchsorted(facet, np.arange(int(found.facet_of.max(initial=-1)) + 2))
    vertices = np.unique(found.simplices).astype(np.int32)
    repeats = np.isin(found.duplicates[:, 1], vertices)
    return {
        "simplices": found.simplices,
        "neighbors": found.neighbors,
        "vertices": vertices,
        "facet_of": found.facet_of,
        "polygons": polygons.astype(np.int32),
        "starts": starts.astype(np.int32),
        "duplicates": np.ascontiguousarray(found.duplicates[repeats]),
    }


def _cones(points: Floats, facets: Indices, vertices: Indices) -> tuple[Indices, Floats]:
    """Return simplices of facets and a vertex off each, and the maps to their coordinates.

    Rounded distances choose the vertex; that it is off the plane is decided exactly.
    """
    # Vertices at the ends of the axes are off the planes of most facets.
    ends = np.unique((points[vertices].argmin(axis=0), points[vertices].argmax(axis=0)))
    cones = np.column_stack((_farthest(points, facets, vertices[ends])[:, 0], facets))
    flat = np.flatnonzero(_core.orientations_n(points, cones, 1) == 0)
    for row, order in zip(flat, _farthest(points, facets[flat], vertices), strict=True):
        tried = np.column_stack(
            (order, np.broadcast_to(facets[row], (len(order), cones.shape[1] - 1)))
        )
        off = np.flatnonzero(_core.orientations_n(points, tried.astype(np.int32), 1))
        cones[row, 0] = order[off[0]]
    return cones, measures.transform(points, cones)


def _farthest(points: Floats, facets: Indices, among: Indices) -> Indices:
    """Return rows of points for each facet, the farthest from its plane first, by rounding."""
    corners = points[facets]
    steps = corners[:, 1:] - corners[:, :1]
    with np.errstate(all="ignore"):
        scaled = steps / np.abs(steps).max(axis=(1, 2), keepdims=True)
        rough = np.linalg.svd(np.nan_to_num(scaled))[2][:, -1]
        away = np.abs(np.einsum("kd,kvd->kv", rough, points[among][None] - corners[:, :1]))
    order = np.argsort(-np.nan_to_num(away, nan=-1.0), axis=1, kind="stable")
    found: Indices = among[order].astype(np.int32)
    return found


def normals(points: Floats, facets: Indices, vertices: Indices) -> Floats:
    """Return outer unit normals of facets, (k, d), with errors below 1e-12."""
    _, maps = _cones(points, facets, vertices)
    # The coordinate of the point inside falls toward the facet.
    inward = maps[:, 0]
    with np.errstate(all="ignore"):
        scaled = inward / np.abs(inward).max(axis=1, keepdims=True)
        found: Floats = -scaled / _lengths(scaled)[:, None]
    return found


def areas(points: Floats, facets: Indices, vertices: Indices, workers: int | None) -> Floats:
    """Return the (d - 1)-dimensional areas of facets, with a relative error below 1e-12."""
    cones, maps = _cones(points, facets, vertices)
    # The volume of a cone is its base times its height over d; the height is 1 over the slope.
    slope = _lengths(maps[:, 0])
    volumes = np.abs(measures.sizes(points, cones, workers))
    found: Floats = volumes * points.shape[1] * slope
    return found


def _lengths(rows: Floats) -> Floats:
    """Return lengths of rows, (k,), without overflow."""
    return np.array([math.hypot(*row) for row in rows.tolist()])
