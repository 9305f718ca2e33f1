"""Graphs of nearest neighbors, which need no triangulation."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone import _core
from delone._base.arrays import as_choice, as_flag, as_least, as_workers
from delone._base.counting import counted
from delone.errors import InputError
from delone.graphs.coincident import repeated
from delone.graphs.graph import Graph
from delone.graphs.scale import rescaled
from delone.graphs.skeleton import coordinates

if TYPE_CHECKING:
    from delone.graphs.skeleton import Points

__all__ = ["nearest_neighbors", "sphere_of_influence"]


def nearest_neighbors(
    points: Points,
    k: int,
    *,
    directed: bool = False,
    workers: int | None = None,
    planar: bool = False,
) -> Graph:
    """Return the graph of the k nearest neighbors of each point.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Finite coordinates in any unit; for a triangulation or hull, its points.
    k : int
        From 1 to the number of distinct points minus one.
    directed : bool, optional
        Whether edges lead from each point to its neighbors. By default, two points are joined if
        one of them is a neighbor of the other.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Returns
    -------
    Graph
        Its edges. A directed graph has k for each distinct point, all ``(i, j)`` of one i in
        consecutive rows.

    Raises
    ------
    InputError
        `k` is out of range, or `points` is periodic.
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, 2) or (n, 3), or `k` is not an integer.

    Notes
    -----
    Squared distances are compared exactly; of equally near points, the lexicographically smaller
    one is nearer. So the graph does not depend on the order of the rows. It is not part of the
    Delaunay graph, and it may be disconnected: see `Graph.components`.

    Coincident rows are one vertex, the first, and not neighbors of each other; the others have no
    edges and are in ``Graph.duplicates``.

    By branch and bound in a tree of boxes along a Hilbert curve (N. Roussopoulos, S. Kelley and F.
    Vincent, "Nearest neighbor queries", 1995): about O(n (log n + k)) time for scattered points,
    less than for the triangulation and a search in it. It is quadratic if only some squared
    distances exceed the range of doubles.

    Examples
    --------
    >>> from delone.graphs import nearest_neighbors
    >>> points = [(0, 0), (1, 0), (3, 0), (7, 0)]
    >>> nearest_neighbors(points, 1).edges.tolist()
    [[0, 1], [1, 2], [2, 3]]
    >>> nearest_neighbors(points, 1, directed=True).edges.tolist()
    [[0, 1], [1, 0], [2, 1], [3, 2]]
    """
    count, one_way = as_least(k, 1, name="k"), as_flag(directed, name="directed")
    own = coordinates(points, ndim=None, planar=planar)
    threads = as_workers(workers)
    if not 1 <= count < len(own):
        _require_k(count, len(own), len(repeated(own)))
    edges, duplicates = _core.knn(rescaled(own)[0], count, one_way, threads)
    _require_k(count, len(own), len(duplicates))
    kind = f"{count} nearest neighbors"
    made = Graph._made(own, edges, duplicates, directed=one_way, kind=kind, workers=workers)
    return made._refer(points)


def sphere_of_influence(
    points: Points,
    *,
    boundary: str = "closed",
    workers: int | None = None,
    planar: bool = False,
) -> Graph:
    """Return the sphere of influence graph: points whose nearest-neighbor spheres meet.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        Finite coordinates in any unit; for a triangulation or hull, its points.
    boundary : {"closed", "open"}, optional
        Whether two spheres that only touch are neighbors (``"closed"``) or not.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Returns
    -------
    Graph
        Its edges. Two points alone are neighbors; a single point has no edges.

    Raises
    ------
    InputError
        `boundary` is not one of its choices, or `points` is periodic.
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, 2) or (n, 3).

    Notes
    -----
    Each point has a sphere around it, through its nearest neighbor. Two points a and b, with radii
    r and s, are neighbors if ``|a - b| <= r + s``; with ``"open"``, ``<`` (G. T. Toussaint, "A
    graph-theoretical primal sketch", 1988). Sums of roots are compared exactly. It is not part of
    the Delaunay graph, and it may be disconnected: see `Graph.components`.

    Coincident rows are one vertex, the first, and do not count as neighbors of each other; the
    others have no edges and are in ``Graph.duplicates``.

    The number of edges is O(n). By a tree of boxes with the largest radius in each, about
    O(n log n) time for scattered points.

    Examples
    --------
    >>> from delone.graphs import sphere_of_influence
    >>> sphere_of_influence([(0, 0), (1, 0), (3, 0), (9, 0), (10, 0)]).edges.tolist()
    [[0, 1], [0, 2], [1, 2], [3, 4]]
    """
    closed = as_choice(boundary, ("closed", "open"), name="boundary") == "closed"
    own = coordinates(points, ndim=None, planar=planar)
    edges, duplicates = _core.influence(rescaled(own)[0], closed, as_workers(workers))
    made = Graph._made(own, edges, duplicates, kind="sphere of influence", workers=workers)
    return made._refer(points)


def _require_k(k: int, rows: int, duplicates: int) -> None:
    """Reject a number of neighbors that not every distinct point has."""
    most = rows - duplicates - 1
    if 1 <= k <= most:
        return
    if most < 1:
        there = counted(rows - duplicates, "distinct point")
        raise InputError(
            f"k = {k!s:.60}: {there}, so there are no neighbors; at least two are needed"
        )
    raise InputError(
        f"k must be from 1 to {most}, one less than the distinct points, got {k!s:.60}"
    )
