"""Areas and normals of triangles in 3-D.

The core computes them in stages: values that suffer cancellation are computed again with more
digits. Points must be finite.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone._base.arrays import as_mesh, as_workers

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["face_areas", "face_normals"]


def face_normals(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return unit normals of 3-D triangles, none degenerate, with errors below 1e-14.

    They point to the side from which the triangle is counter-clockwise.
    """
    return _core.face_normals3(*as_mesh(points, faces), as_workers(workers))


def face_areas(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return areas of 3-D triangles; the relative error is below 1e-14 within doubles."""
    return _core.face_areas3(*as_mesh(points, faces), as_workers(workers))
