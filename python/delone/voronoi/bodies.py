"""The cells of a 3-D diagram within its clip, and their measures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone._core import ClippedCells3, Diagram3
    from delone.voronoi.polyhedra import Polyhedron

__all__ = ["Bodies", "Body"]


class Body(NamedTuple):
    """One cell: its corners, its faces as rows of them, and the ridge of each face.

    Faces are counter-clockwise as seen from outside; the ridge of a face of the clip is negative.
    The corners of an unbounded cell are its vertices; it has no faces.
    """

    vertices: Floats
    faces: tuple[Indices, ...]
    ridges: Indices


_EMPTY = Body(np.empty((0, 3)), (), np.empty(0, dtype=np.int32))


class Bodies:
    """The clipped cells of 3-D sites, in the order of the cells, and their measures.

    `volumes` and `areas`, (c,), are infinite for unbounded cells; `centroids`, (c, 3), are NaN for
    unbounded and empty ones.
    """

    def __init__(
        self,
        points: Floats,
        weights: Floats | None,
        dual: Diagram3,
        clip: Polyhedron | None,
        workers: int,
    ) -> None:
        self._dual = dual
        self._cuts: ClippedCells3 | None = None
        if clip is None:
            measures = _core.measures3(points, weights, dual, workers)
        else:
            self._cuts = _core.voronoi_clip3(
                points, weights, dual, clip.points, clip.starts, clip.corners, clip.planes, workers
            )
            measures = self._cuts.measures
        self.volumes, self.areas = measures.volumes, measures.areas
        self.centroids, self._ridge_areas = measures.centroids, measures.ridge_areas
        self._cut_as = np.full(len(self.volumes), -1, dtype=np.int64)
        if self._cuts is not None:
            self._cut_as[self._cuts.cut] = np.arange(len(self._cuts.cut))

    def ridge_sizes(self) -> Floats:
        """Return the area of each clipped ridge; infinite for an unbounded one."""
        return self._ridge_areas

    def body(self, cell: int) -> Body:
        """Return one cell; -1 is an empty one."""
        if cell < 0:
            return _EMPTY
        number = int(self._cut_as[cell])
        if self._cuts is None or number < 0:
            return self._whole(cell)
        return _cut(self._cuts, number)

    def _whole(self, cell: int) -> Body:
        dual = self._dual
        start, end = dual.region_ridge_starts[cell : cell + 2]
        ridges = dual.region_ridges[start:end]
        faces = []
        for ridge in ridges.tolist():
            first, last = dual.ridge_starts[ridge : ridge + 2]
            face = dual.ridge_entries[first:last]
            faces.append(face if dual.sites[ridge, 0] == dual.site[cell] else face[::-1])
        used = np.unique(np.concatenate([*faces, np.empty(0, dtype=np.int32)]))
        unbounded = not faces or int(used[0]) < 0
        used = used[used >= 0].astype(np.int64)
        if unbounded:
            return _EMPTY._replace(vertices=dual.vertices[used])
        renamed = tuple(np.searchsorted(used, face).astype(np.int32) for face in faces)
        return Body(dual.vertices[used], renamed, ridges)


def _cut(cells: ClippedCells3, number: int) -> Body:
    """Return one of the cells cut by the clip."""
    begin, end = cells.point_starts[number : number + 2]
    first, last = cells.face_starts[number : number + 2]
    bounds = cells.corner_starts[first : last + 1]
    corners = cells.corners[bounds[0] : bounds[-1]] - begin
    faces = np.split(corners, bounds[1:-1] - bounds[0]) if last > first else []
    return Body(cells.points[begin:end], tuple(faces), cells.labels[first:last])
