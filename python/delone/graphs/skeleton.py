"""The Delaunay graph from which other graphs are filtered, even for points that span no area."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_workers, require_finite
from delone._base.georeference import warn_of_degrees
from delone._base.immutable import own_copy
from delone._tiling.complex import Stored, points_alone
from delone._tiling.dimension import FLAT_OR_SOLID
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError
from delone.graphs.coincident import repeated
from delone.graphs.scale import rescaled

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices

    Points = ArrayLike | Stored

__all__ = ["Skeleton", "coordinates", "joined", "skeleton"]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Distinct points and their Delaunay edges, which are listed on first use."""

    points: Floats
    duplicates: Indices  # (k, 2): rows that repeat earlier rows, and these
    workers: int
    mesh: Delaunay | None = None  # None if the points span less than their dimension
    flat_edges: Indices | None = None  # then these
    is_chain: bool = False  # all points on one line

    @property
    def edges(self) -> Indices:
        """The edges, each the smaller row first, ascending."""
        if self.flat_edges is not None:
            return self.flat_edges
        assert self.mesh is not None
        return self.mesh.edges

    @property
    def adjacency(self) -> tuple[Floats, Indices, Indices, Indices]:
        """Points, edges, and the neighbors of rows: the arguments of the core's functions.

        The points are in a unit in which squares are doubles, as in `tiling`.
        """
        points, _ = rescaled(self.points)
        if self.mesh is not None:
            return points, self.edges, *self.mesh.vertex_neighbor_vertices
        return points, self.edges, *_core.around(self.edges, len(points))

    @property
    def tiling(self) -> tuple[Floats, Indices, Indices] | None:
        """Points, simplices and neighbors, if there are any."""
        if self.mesh is None:
            return None
        return rescaled(self.points)[0], self.mesh.simplices, self.mesh.neighbors


def coordinates(points: Points, *, ndim: int | None, planar: bool) -> Floats:
    """Return finite points that cannot be changed; for a triangulation or graph, its points."""
    if not isinstance(points, Stored):
        own = own_copy(points, ndim=ndim)
        warn_of_degrees(points, own, planar=planar)
        require_finite(own)
        return own
    if getattr(points, "periods", None) is not None:
        raise InputError(
            "graphs of periodic points are not available, since their edges cross the periods; "
            "PeriodicDelaunay has edges"
        )
    held = points_alone(points, what="a graph", needs=("periods",))
    if held.shape[1] not in FLAT_OR_SOLID:
        raise InputError(
            f"graphs are only available in 2-D and 3-D: points are {held.shape[1]}-D; edges of a "
            f"{type(points).__name__} exist in every dimension"
        )
    if ndim not in (None, held.shape[1]):
        raise InputError(f"this graph is only available in {ndim}-D: points are {held.shape[1]}-D")
    return held


def skeleton(
    points: Points, *, workers: int | None, planar: bool, ndim: int | None = None
) -> Skeleton:
    """Return the Delaunay graph of points; a `Delaunay` triangulation is used directly."""
    own = coordinates(points, ndim=ndim, planar=planar)
    threads = as_workers(workers)
    if isinstance(points, Delaunay):
        return _of_mesh(points, threads)
    if not len(own):
        return Skeleton(own, _no_rows(), threads, flat_edges=_no_rows(), is_chain=True)
    try:
        return _of_mesh(Delaunay(own, workers=workers, planar=True), threads)
    except DegenerateInputError as error:
        plane = error.plane
        if plane is None:
            chain = np.column_stack((error.chain[:-1], error.chain[1:])).astype(np.int32)
            edges = joined(np.sort(chain, axis=1))
            return Skeleton(own, repeated(own), threads, flat_edges=edges, is_chain=True)
        edges = _core.edges(plane.simplices, plane.neighbors, len(own), threads)
        return Skeleton(own, plane.duplicates, threads, flat_edges=edges)


def joined(*edges: Indices) -> Indices:
    """Return edges of several arrays, each the smaller row first, as ascending rows."""
    both = np.concatenate(edges)
    return np.ascontiguousarray(both[np.lexsort((both[:, 1], both[:, 0]))])


def _of_mesh(mesh: Delaunay, threads: int) -> Skeleton:
    return Skeleton(mesh.points, mesh._duplicates, threads, mesh=mesh)


def _no_rows() -> Indices:
    return np.empty((0, 2), dtype=np.int32)
