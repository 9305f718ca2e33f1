"""Measures of tetrahedra: volumes, circumcenters, barycentric transforms.

The core computes them in stages: values that suffer cancellation in slivers are computed again with
more digits. Points must be finite, and tetrahedra exactly positively oriented.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone._arrays import as_mesh, as_workers

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["circumcenters", "face_areas", "face_normals", "transform", "volumes"]


def volumes(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return volumes; the relative error is below 1e-13 within the range of doubles."""
    return _core.volumes3(*as_mesh(points, simplices), as_workers(workers))


def transform(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return affine maps to barycentric coordinates, (m, 4, 3).

    The inverse of the matrix whose columns are the vectors from the last corner to the first three,
    and below it the last corner. Each row has an error below 1e-13 of its length, if within
    doubles.
    """
    return _core.transforms3(*as_mesh(points, simplices), as_workers(workers))


def circumcenters(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return circumcenters, within 4 units in the last place; infinite beyond doubles."""
    return _core.circumcenters3(*as_mesh(points, simplices), as_workers(workers))


def face_normals(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return unit normals of 3-D triangles, none degenerate, with errors below 1e-14.

    They point to the side from which the triangle is counter-clockwise.
    """
    return _core.face_normals3(*as_mesh(points, faces), as_workers(workers))


def face_areas(points: Floats, faces: Indices, workers: int | None = None) -> Floats:
    """Return areas of 3-D triangles; the relative error is below 1e-14 within doubles."""
    return _core.face_areas3(*as_mesh(points, faces), as_workers(workers))
