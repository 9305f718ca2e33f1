"""Point location in tetrahedra: the nearest points of boundary faces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from delone import _core
    from delone._base.types import Floats, Indices

__all__ = ["located", "on_faces"]


def located(
    index: _core.Locator3, xi: Floats, workers: int
) -> tuple[Indices, Floats, Indices, Indices, Floats]:
    """Locate points, (k, 3): the fields of `delone._tiling.location.Location` except `nearest`."""
    found = index.locate(xi, workers)
    return found.simplex, found.weights, found.beside, found.face, found.shares


def on_faces(points: Floats, face: Indices, weights: Floats) -> Floats:
    """Return points on triangles, inside their boxes; exactly the corner if one weight is 1."""
    corners = points[face]
    found: Floats = np.clip(
        (weights[..., None] * corners).sum(axis=1), corners.min(axis=1), corners.max(axis=1)
    )
    return found
