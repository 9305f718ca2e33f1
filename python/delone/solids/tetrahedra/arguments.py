"""The arguments of `tetrahedralize`, checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.arrays import as_limit, as_plain_array, as_points, as_workers, require_finite
from delone._base.values import as_labels
from delone.solids.surface.check import as_faces
from delone.solids.tetrahedra.seeds import as_hole_seeds, as_region_seeds

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices
    from delone.solids.surface import ImprintedSurface
    from delone.solids.tetrahedra.sources import Given

__all__ = ["Task", "task"]

# Points that may be added by default: far more than any valid surface of a survey needed.
_LEAST_LIMIT = 1_000_000
_LIMIT_PER_FACE = 10


class Task(NamedTuple):
    """A surface to be filled, and options."""

    points: Floats
    faces: Indices
    markers: Indices
    holes: Floats
    regions: Floats
    labels: Indices
    extra: Floats
    limit: int
    workers: int | None

    def imprinted(self, cut: ImprintedSurface) -> Task:
        """Return the task with the surface cut at itself; parts inherit markers."""
        return self._replace(points=cut.points, faces=cut.faces, markers=self.markers[cut.source])


def task(
    surface: Given, extra_points: ArrayLike | None, max_points: int | None, workers: int | None
) -> Task:
    """Return checked arguments."""
    points, faces = as_faces(surface.points, surface.faces)
    require_finite(points)
    as_workers(workers)
    most = max(_LEAST_LIMIT, _LIMIT_PER_FACE * len(faces))
    regions, labels = as_region_seeds(surface.regions)
    return Task(
        points=points,
        faces=faces,
        markers=as_labels(surface.markers, len(faces), name="face_markers"),
        holes=as_hole_seeds(surface.holes),
        regions=regions,
        labels=labels,
        extra=_as_extra(extra_points),
        limit=as_limit(most if max_points is None else max_points, name="max_points"),
        workers=workers,
    )


def _as_extra(points: ArrayLike | None) -> Floats:
    array = np.empty((0, 3)) if points is None else as_plain_array(points, "extra_points")
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 3))
    found = as_points(array, ndim=3, name="extra_points")
    require_finite(found, name="extra_points")
    return found
