"""The Delaunay graph from which other graphs are filtered, also of points that span no area."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._arrays import as_workers, require_finite
from delone.complex import Complex
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError
from delone.georeference import warn_of_degrees
from delone.graphs.coincident import repeated
from delone.immutable import own_copy
from delone.periodic import PeriodicDelaunay

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Points = ArrayLike | Complex

__all__ = ["Skeleton", "coordinates", "joined", "skeleton"]


class Skeleton(NamedTuple):
    """The Delaunay edges of distinct points, and what the core needs to filter them."""

    points: Floats
    duplicates: Indices  # (k, 2): rows that repeat earlier rows, and these
    edges: Indices
    starts: Indices
    neighbors: Indices
    simplices: Indices | None  # None if the points span less than their dimension
    beside: Indices | None  # neighbors of simplices
    workers: int
    is_chain: bool = False  # all points on one line

    @property
    def adjacency(self) -> tuple[Floats, Indices, Indices, Indices]:
        """What the functions of the core take."""
        return self.points, self.edges, self.starts, self.neighbors


def coordinates(points: Points, *, ndim: int | None, planar: bool) -> Floats:
    """Return finite points that nobody else can change; of a triangulation or hull, its points."""
    if isinstance(points, Complex):
        if isinstance(points, PeriodicDelaunay):
            raise InputError(
                "graphs of periodic points are not available: their edges cross the periods; use "
                "the edges of the PeriodicDelaunay itself"
            )
        if ndim not in (None, points.ndim):
            raise InputError(
                f"this graph is only available in {ndim}-D, not of {points.ndim}-D points"
            )
        return points.points
    own = own_copy(points, ndim=ndim)
    warn_of_degrees(points, own, planar=planar)
    require_finite(own)
    return own


def skeleton(
    points: Points, *, workers: int | None, planar: bool, ndim: int | None = None
) -> Skeleton:
    """Return the Delaunay graph of points; a `Delaunay` triangulation is used as it is."""
    own = coordinates(points, ndim=ndim, planar=planar)
    threads = as_workers(workers)
    if isinstance(points, Delaunay):
        return _of_mesh(points, threads)
    if not len(own):
        return _flat(own, np.empty((0, 2), np.int32), _no_edges(), threads)
    try:
        return _of_mesh(Delaunay(own, workers=workers, planar=True), threads)
    except DegenerateInputError as error:
        if error.plane is None:
            chain = _edges(error.chain[:-1], error.chain[1:])
            return _flat(own, repeated(own), chain, threads, is_chain=True)
        plane = error.plane
        edges = _core.edges2(plane.simplices, plane.neighbors, len(own), threads)
        return _flat(own, plane.duplicates, edges, threads)


def joined(*edges: Indices) -> Indices:
    """Return edges of several arrays, each the smaller row first, as ascending rows."""
    both = np.concatenate(edges)
    return np.ascontiguousarray(both[np.lexsort((both[:, 1], both[:, 0]))])


def _of_mesh(mesh: Delaunay, threads: int) -> Skeleton:
    starts, neighbors = mesh.vertex_neighbor_vertices
    return Skeleton(
        mesh.points,
        mesh._duplicates,
        mesh.edges,
        starts,
        neighbors,
        mesh.simplices,
        mesh.neighbors,
        threads,
    )


def _flat(
    points: Floats, duplicates: Indices, edges: Indices, threads: int, **options: Any
) -> Skeleton:
    starts, neighbors = _core.around(edges, len(points))
    return Skeleton(points, duplicates, edges, starts, neighbors, None, None, threads, **options)


def _edges(start: NDArray[np.int64], end: NDArray[np.int64]) -> Indices:
    return joined(np.sort(np.column_stack((start, end)), axis=1).astype(np.int32))


def _no_edges() -> Indices:
    return np.empty((0, 2), dtype=np.int32)
