"""What a diagram of space hands out besides arrays: neighbours, a cell; and what a clip leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._core import ClippedCells3, Diagram3
    from delone.voronoi.polyhedra import Polyhedron

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Bodies", "SpaceCell", "SpaceNeighbors"]


class SpaceNeighbors(NamedTuple):
    """The neighbours of all sites in space as compressed rows.

    Parameters
    ----------
    indptr : ndarray of int32, shape (n + 1,)
        Where those of each site begin: ``indices[indptr[i]:indptr[i + 1]]``.
    indices : ndarray of int32, shape (k,)
        The neighbours of each site, ascending.
    areas : ndarray of float64, shape (k,)
        The area of the face that both cells have in common.

    Examples
    --------
    >>> from delone import Voronoi
    >>> grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
    >>> indptr, indices, areas = Voronoi(grid).neighbors
    >>> indices[indptr[13]:indptr[14]].tolist()
    [4, 10, 12, 14, 16, 22]
    """

    indptr: Indices
    indices: Indices
    areas: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class SpaceCell:
    """One cell of a diagram of space.

    Parameters
    ----------
    site : int
        Row of the site.
    bounded : bool
        Whether the whole cell is bounded.
    vertices : ndarray of float64, shape (k, 3)
        The corners of what is left of the cell within the clip; without a clip the vertices of the
        whole cell.
    faces : tuple of ndarray of int32
        The faces, as rows of `vertices`, counter-clockwise from outside. Empty where nothing is
        left, and for an unbounded cell that is not clipped.
    beyond : ndarray of int32, shape (f,)
        The site on the other side of each face; -1 for a face of the clip.
    neighbors : ndarray of int32, shape (j,)
        The sites of the cells beside it.
    areas : ndarray of float64, shape (j,)
        Of the faces common with them.
    volume, area : float
        Of the cell, and of its surface; as in the diagram.
    centroid : ndarray of float64, shape (3,)
        As in the diagram.

    Examples
    --------
    >>> from delone import Voronoi
    >>> grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
    >>> cell = Voronoi(grid).cell(13)
    >>> cell.bounded, len(cell.vertices), [len(face) for face in cell.faces]
    (True, 8, [4, 4, 4, 4, 4, 4])
    """

    site: int
    bounded: bool
    vertices: Floats
    faces: tuple[Indices, ...]
    beyond: Indices
    neighbors: Indices
    areas: Floats
    volume: float
    area: float
    centroid: Floats


class Bodies:
    """What is left of the cells, in the order of the cells, and its measures.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The sites.
    weights : ndarray of float64, shape (n,), optional
        Their weights.
    dual : Diagram3
        The diagram.
    clip : Polyhedron, optional
        Where cells end.
    workers : int
        How many threads may work.

    Attributes
    ----------
    volumes, areas : ndarray of float64, shape (c,)
        Measures; infinite for cells that have no end.
    centroids : ndarray of float64, shape (c, 3)
        Centres of gravity; NaN where there is none.
    ridge_areas : ndarray of float64, shape (r,)
        How large what is left of each ridge is.
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
        self.clipped = clip is not None
        self.volumes, self.areas = measures.volumes, measures.areas
        self.centroids, self.ridge_areas = measures.centroids, measures.ridge_areas
        self._body = np.full(len(self.volumes), -1, dtype=np.int64)
        if self._cuts is not None:
            self._body[self._cuts.cut] = np.arange(len(self._cuts.cut))

    def shape(self, cell: int) -> tuple[Floats, tuple[Indices, ...], Indices]:
        """Return corners, faces (rows of these) and the ridge of each face, negative for none.

        Parameters
        ----------
        cell : int
            Which cell.

        Returns
        -------
        corners : ndarray of float64, shape (k, 3)
            Corners of what is left.
        faces : tuple of ndarray of int32
            Counter-clockwise from outside; none where the cell has no end.
        ridges : ndarray of int32, shape (f,)
            Ridges of faces.
        """
        body = int(self._body[cell])
        if self._cuts is None or body < 0:
            return self._whole(cell)
        return _cut(self._cuts, body)

    def _whole(self, cell: int) -> tuple[Floats, tuple[Indices, ...], Indices]:
        dual = self._dual
        start, end = dual.region_ridge_starts[cell : cell + 2]
        ridges = dual.region_ridges[start:end]
        faces = []
        for ridge in ridges.tolist():
            first, last = dual.ridge_starts[ridge : ridge + 2]
            face = dual.ridge_entries[first:last]
            faces.append(face if dual.sites[ridge, 0] == dual.site[cell] else face[::-1])
        used = np.unique(np.concatenate([*faces, np.empty(0, dtype=np.int32)]))
        is_open = not faces or int(used[0]) < 0
        used = used[used >= 0].astype(np.int64)
        if is_open:
            return dual.vertices[used], (), np.empty(0, dtype=np.int32)
        renamed = tuple(np.searchsorted(used, face).astype(np.int32) for face in faces)
        return dual.vertices[used], renamed, ridges


def _cut(cells: ClippedCells3, body: int) -> tuple[Floats, tuple[Indices, ...], Indices]:
    """Corners, faces and ridges of one of the cells that the clip has cut."""
    begin, end = cells.point_starts[body : body + 2]
    first, last = cells.face_starts[body : body + 2]
    bounds = cells.corner_starts[first : last + 1]
    corners = cells.corners[bounds[0] : bounds[-1]] - begin
    faces = np.split(corners, bounds[1:-1] - bounds[0]) if last > first else []
    return cells.points[begin:end], tuple(faces), cells.labels[first:last]
