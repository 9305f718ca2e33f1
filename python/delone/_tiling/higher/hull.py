"""Convex hulls in four to eight dimensions: their arrays, and measures of facets."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._tiling import measures
from delone._tiling.higher import flats
from delone._tiling.higher.flats import advised, flat_of
from delone._tiling.higher.topology import distinct
from delone.errors import DegenerateInputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["areas", "hull_arrays", "normals", "orientations", "sizes"]


def hull_arrays(points: Floats, *, stays: bool = False) -> dict[str, NDArray[Any]]:
    """Return the arrays of a hull; `polygons` lists the vertices of each facet, ascending.

    With `stays`, points may lie in a flat, and the hull stays in it.
    """
    try:
        found: Any = _core.hull_n(points)
    except DegenerateInputError as error:
        if not stays:
            raise advised(error) from None
        found = flat_of(points, error).hull()
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


def orientations(points: Floats, simplices: Indices, axes: list[int] | None) -> Indices:
    """Return the signs of determinants, exactly: those of the axes of a flat, if there is one."""
    if axes is not None:
        return flats.orientations(np.ascontiguousarray(points[:, axes]), simplices)
    return _core.orientations_n(points, simplices, as_workers(None))


def sizes(points: Floats, simplices: Indices, workers: int | None) -> Floats:
    """Return the measures of simplices, which may be in a flat."""
    if simplices.shape[1] <= points.shape[1]:
        return flats.sizes(points, simplices)
    return measures.sizes(points, simplices, workers)


def normals(points: Floats, facets: Indices, inside: Indices) -> Floats:
    """Return outer unit normals of facets, (k, d), with errors below 1e-12.

    `inside` is, for each facet, the row of a point of the hull that is not in its plane.
    """
    if facets.shape[1] < points.shape[1]:
        return flats.normals(points, facets, inside)
    maps = measures.transform(points, np.column_stack((inside, facets)))
    # The coordinate of the interior point decreases toward the facet.
    inward = maps[:, 0]
    with np.errstate(all="ignore"):
        scaled = inward / np.abs(inward).max(axis=1, keepdims=True)
        found: Floats = -scaled / _lengths(scaled)[:, None]
    return found


def areas(points: Floats, facets: Indices, inside: Indices, workers: int | None) -> Floats:
    """Return the (d - 1)-dimensional areas of facets, with a relative error below 1e-12."""
    if facets.shape[1] < points.shape[1]:
        return flats.sizes(points, facets)
    cones = np.column_stack((inside, facets))
    # The volume of a cone is base times height divided by d; the height is 1 / slope.
    slope = _lengths(measures.transform(points, cones)[:, 0])
    volumes = np.abs(measures.sizes(points, cones, workers))
    found: Floats = volumes * points.shape[1] * slope
    return found


def _lengths(rows: Floats) -> Floats:
    """Return lengths of rows, (k,), without overflow."""
    return np.array([math.hypot(*row) for row in rows.tolist()])
