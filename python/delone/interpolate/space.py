"""Interpolation in 3-D: extrapolation beyond the hull, gradients in tetrahedra.

These are the parts of the interpolators that differ between 2-D and 3-D. On a face of the hull the
interpolants here depend on its three corners, exactly or almost, and extrapolation treats them as
linear there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._tiling import measures
from delone.errors import InputError
from delone.interpolate.hull import Terms

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone._tiling.location import Location
    from delone._tiling.triangulation import Triangulation

__all__ = ["SPACE", "face_terms", "hull_gradients", "refuse", "slopes"]

SPACE = 3


def refuse(what: str, instead: str) -> None:
    """Raise InputError for what is only available in 2-D; `instead` is what to use otherwise."""
    raise InputError(f"{what} is only available in 2-D; in more dimensions {instead}")


def face_terms(place: Location, step: Floats, *, base: bool = True) -> Terms:
    """The terms of a linear interpolant on the hull, and of a `step`, (k, 3), away from it.

    Without `base` only the step counts. There are no slopes if no gradients are used.
    """
    weights = place.weights if base else np.zeros_like(place.weights)
    slopes = place.weights[..., None] * step[:, None]
    return Terms(place.facet, weights, slopes if step.any() else None)


def slopes(points: Floats, corners: Indices, columns: Floats) -> Floats:
    """The gradients, (k, c, d), of linear functions on simplices, (k, d + 1), none flat."""
    # The rows of these maps are the gradients of the barycentric coordinates.
    maps = measures.transform(points, corners)[:, :-1]
    rise = columns[corners[:, :-1]] - columns[corners[:, -1:]]
    found: Floats = np.einsum("kic,kij->kcj", rise, maps)
    return found


def hull_gradients(mesh: Triangulation, columns: Floats, workers: int) -> Floats:
    """The gradients, (n, c, 3), of the best-fitting linear functions at the hull; 0 elsewhere.

    Neighbors are weighted by the inverse square of their distance, limited by the rounding of the
    values where they nearly coincide. If they do not determine the gradient, or only barely, their
    neighbors are used as well; if these also lie in one plane, the slope across it is 0.
    """
    found = np.zeros((mesh.npoints, columns.shape[1], SPACE))
    rows = np.unique(mesh.boundary)
    around = mesh.vertex_neighbor_vertices
    found[rows] = _core.gradients_local3(mesh.points, *around, columns, rows, workers)
    return found
