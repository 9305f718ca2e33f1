"""The Euclidean minimum spanning tree."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone.graphs.graph import Graph
from delone.graphs.skeleton import skeleton

if TYPE_CHECKING:
    from delone.graphs.skeleton import Points

__all__ = ["minimum_spanning_tree"]


def minimum_spanning_tree(
    points: Points, *, workers: int | None = None, planar: bool = False
) -> Graph:
    """Return the Euclidean minimum spanning tree: the shortest edges that connect all points.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Finite coordinates in any unit. A `Delaunay` is used directly; of any other triangulation or
        hull, only the points are used.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Returns
    -------
    Graph
        A tree, with one edge fewer than there are distinct points.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, 2) or (n, 3).
    InputError
        `points` is periodic, or `workers` is not one of its choices.

    See Also
    --------
    Graph.with_duplicates : Also connects coincident rows, by edges of length zero.

    Notes
    -----
    Kruskal's algorithm (1956) on Delaunay edges, which contain the tree (M. I. Shamos and D. Hoey,
    "Closest-point problems", 1975). Lengths are compared exactly. Of edges with the same length,
    the one whose lexicographically smaller end, then whose other end, has the smaller coordinates
    comes first. This is a total order of the pairs of points, so a set of points has one tree,
    whatever the order of its rows, and scaling by a power of two leaves it unchanged.

    Coincident rows are one vertex, the first; the others have no edges and are in
    ``Graph.duplicates``. O(n log n) time in 2-D, in 3-D O(m log m) for m Delaunay edges.

    Examples
    --------
    >>> from delone.graphs import minimum_spanning_tree
    >>> tree = minimum_spanning_tree([(0, 0), (3, 0), (3, 4), (9, 9)])
    >>> tree.edges.tolist(), tree.lengths[:2]
    ([[0, 1], [1, 2], [2, 3]], array([3., 4.]))
    """
    base = skeleton(points, workers=workers, planar=planar)
    tiling, ndim = base.tiling, base.points.shape[1]
    if ndim == 2 and tiling is not None:
        edges = _core.spanning_triangles2(tiling, base.workers)
    else:
        edges = _core.spanning(base.adjacency, base.workers)
    kind = "minimum spanning tree"
    made = Graph._made(base.points, edges, base.duplicates, kind=kind, workers=workers)
    return made._refer(points)
