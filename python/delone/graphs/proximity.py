"""Graphs whose edges have an empty region: filters of the Delaunay graph."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_number
from delone.errors import InputError
from delone.graphs.graph import Graph
from delone.graphs.skeleton import joined, skeleton

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.graphs.skeleton import Points, Skeleton

__all__ = ["beta_skeleton", "delaunay_graph", "gabriel", "relative_neighborhood", "urquhart"]

_BOUNDARIES = ("closed", "open")


def delaunay_graph(points: Points, *, workers: int | None = None, planar: bool = False) -> Graph:
    """Return the graph of the Delaunay edges of points.

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
        The edges of ``Delaunay(points)``. Points on one line are joined into a path, and coplanar
        3-D points by the triangulation of their plane. A single point has no edges.

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
    Graph : Creates a graph of any edges, such as ``Graph(mesh.points, mesh.edges)``.

    Notes
    -----
    Two points are neighbors if some circle, or sphere, through both has no point inside (B.
    Delaunay, 1934). Where more than three points are on such a circle, the edges are those of the
    canonical triangulation, which depends on coordinates only. Coincident rows are one vertex, the
    first; the others have no edges and are in ``Graph.duplicates``. O(n log n) time in 2-D.

    Examples
    --------
    >>> from delone.graphs import delaunay_graph
    >>> delaunay_graph([(0, 0), (1, 0), (1, 1), (0, 1)])
    <Graph of 4 points: Delaunay, 5 edges, 1 component>
    """
    base = skeleton(points, workers=workers, planar=planar)
    return _graph(points, base, base.edges, "Delaunay", workers)


def gabriel(
    points: Points,
    *,
    boundary: str = "closed",
    workers: int | None = None,
    planar: bool = False,
) -> Graph:
    """Return the Gabriel graph: edges whose diametral circle or sphere is empty.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        As for `delaunay_graph`.
    boundary : {"closed", "open"}, optional
        Whether a point on the circle removes the edge. ``"closed"``: it does; this is the
        definition of Gabriel and Sokal. ``"open"``: only a point inside does.
    workers, planar : optional
        As for `delaunay_graph`.

    Returns
    -------
    Graph
        Its edges. Points on one line are joined into a path; a single point has no edges.

    Raises
    ------
    InputError
        `boundary` is not one of its choices; otherwise as for `delaunay_graph`.

    Notes
    -----
    Two points a and b are neighbors if no other point sees them at a right or obtuse angle: for no
    point p is ``(a - p) @ (b - p) <= 0`` (K. R. Gabriel and R. R. Sokal, "A new statistical
    approach to geographic variation analysis", 1969); with ``"open"``, ``< 0``. The sign is exact.

    The closed graph is part of the Delaunay triangulation and contains the relative neighborhood
    graph; the Delaunay neighbors of one end decide whether an edge belongs to it, in 2-D the
    opposite corners of its triangles (see :doc:`/mathematics/graphs`). The open graph has more
    edges where points are cocircular: on a grid, all sides and both diagonals of each square,
    whichever of them the triangulation contains. Those that are not Delaunay edges are searched
    from the corners of cocircular simplices.

    Coincident rows are one vertex, the first; the others have no edges and are in
    ``Graph.duplicates``. O(n log n) time in 2-D, in 3-D linear in the Delaunay edges after the
    triangulation; ``"open"`` takes O(log n) more for each cocircular corner of regular sets.

    Examples
    --------
    >>> from delone.graphs import gabriel
    >>> grid = [(x, y) for x in range(30) for y in range(30)]
    >>> len(gabriel(grid).edges), len(gabriel(grid, boundary="open").edges)
    (1740, 3422)
    """
    closed = as_choice(boundary, _BOUNDARIES, name="boundary") == "closed"
    base = skeleton(points, workers=workers, planar=planar)
    return _graph(points, base, _balls(base, closed=closed), "Gabriel", workers)


def relative_neighborhood(
    points: Points, *, workers: int | None = None, planar: bool = False
) -> Graph:
    """Return the relative neighborhood graph: edges without a point nearer to both ends.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        As for `delaunay_graph`.
    workers, planar : optional
        As for `delaunay_graph`.

    Returns
    -------
    Graph
        Its edges; connected. Points on one line are joined into a path; a single point has no
        edges.

    Raises
    ------
    InputError
        As for `delaunay_graph`, as are other errors.

    Notes
    -----
    Two points a and b are neighbors if no other point p is nearer to both than they are to each
    other, ``max(|p - a|, |p - b|) < |a - b|``: the lune between them is empty (G. T. Toussaint, in
    "Pattern Recognition" 12, 1980). The lune is open: in an
    equilateral triangle all three edges remain. Squared distances are compared exactly.

    The graph contains the minimum spanning tree and is part of the closed Gabriel and, in 2-D, of
    the Urquhart graph. A point in the lune need not be a Delaunay neighbor of either end. So after
    the neighbors, all points are searched in a tree of boxes; only boxes that do not meet both
    balls are skipped. O(n log n) time in 2-D for points of bounded density.

    Coincident rows are one vertex, the first; the others have no edges and are in
    ``Graph.duplicates``.

    Examples
    --------
    >>> from delone.graphs import relative_neighborhood
    >>> relative_neighborhood([(0, 0), (2, 0), (1, 1)]).edges
    array([[0, 2],
           [1, 2]], dtype=int32)
    """
    base = skeleton(points, workers=workers, planar=planar)
    edges = _filtered(base, "lune", 2.0, closed=False)
    return _graph(points, base, edges, "relative neighborhood", workers)


def urquhart(points: Points, *, workers: int | None = None, planar: bool = False) -> Graph:
    """Return the Urquhart graph: Delaunay edges without the longest one of each triangle; 2-D only.

    Parameters
    ----------
    points : array_like, shape (n, 2), or a triangulation
        As for `delaunay_graph`.
    workers, planar : optional
        As for `delaunay_graph`.

    Returns
    -------
    Graph
        Its edges; connected. Points on one line are joined into a path; a single point has no
        edges.

    Raises
    ------
    InputError
        The points are 3-D; otherwise as for `delaunay_graph`.

    Notes
    -----
    From each Delaunay triangle, the edge that is strictly longer than both others is removed (R. B.
    Urquhart, in "Electronics Letters" 16, 1980). If two edges are equally long and the longest,
    both remain. So the relative neighborhood graph is always part of this graph. Lengths are
    compared exactly. With cocircular points, the triangles are those of the canonical
    triangulation. O(n log n) time, most of it for the triangulation.

    Coincident rows are one vertex, the first; the others have no edges and are in
    ``Graph.duplicates``.

    Examples
    --------
    >>> from delone.graphs import urquhart
    >>> urquhart([(0, 0), (4, 0), (4, 3), (0, 3)]).edges
    array([[0, 1],
           [0, 3],
           [1, 2],
           [2, 3]], dtype=int32)
    """
    base = skeleton(points, workers=workers, planar=planar, ndim=2)
    if base.tiling is None:
        return _graph(points, base, base.edges, "Urquhart", workers)
    edges = _core.of_triangles2(base.tiling, "longest", 1.0, False, base.workers)
    return _graph(points, base, edges, "Urquhart", workers)


def beta_skeleton(
    points: Points,
    beta: float,
    *,
    kind: str = "lune",
    boundary: str = "closed",
    workers: int | None = None,
    planar: bool = False,
) -> Graph:
    """Return a beta skeleton, for a parameter from 1 to 2.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3), or a triangulation
        As for `delaunay_graph`.
    beta : float
        From 1 to 2, used exactly as given: the larger, the fewer edges.
    kind : {"lune", "circle"}, optional
        The region that must be empty. ``"lune"``: the intersection of two balls with a radius of
        beta / 2 times the length, through one end each and with centers on the line of the edge.
        ``"circle"``, 2-D only: the union of the two disks of this radius through both ends.
    boundary : {"closed", "open"}, optional
        Whether a point on the boundary of the region removes the edge (``"closed"``) or not.
    workers, planar : optional
        As for `delaunay_graph`.

    Returns
    -------
    Graph
        Its edges. Points on one line are joined into a path; a single point has no edges.

    Raises
    ------
    InputError
        `beta` is not from 1 to 2, `kind` or `boundary` is not one of its choices, or `kind` is
        ``"circle"`` in 3-D; otherwise as for `delaunay_graph`.

    Notes
    -----
    D. G. Kirkpatrick and J. D. Radke, "A framework for computational morphology", 1985. With beta =
    1 both kinds are the `gabriel` graph of the same boundary. With beta = 2 the open lune is that
    of the `relative_neighborhood` graph. With lunes, the graph contains the spanning tree, so it is
    connected. With circles and beta above 1, it may not be: `Graph.components` numbers the parts.

    All signs are computed with integers, for any double beta. The neighbors of an edge decide
    circles; a search in a tree of boxes decides lunes, as for `relative_neighborhood`. O(n log n)
    time in 2-D for points of bounded density.

    Coincident rows are one vertex, the first; the others have no edges and are in
    ``Graph.duplicates``.

    Examples
    --------
    >>> from delone.datasets import uniform
    >>> from delone.graphs import beta_skeleton
    >>> points = uniform(1000)
    >>> [len(beta_skeleton(points, beta).edges) for beta in (1, 1.5, 2)]
    [1935, 1457, 1247]
    >>> beta_skeleton(points, 1.5, kind="circle").ncomponents > 1
    True
    """
    parameter = as_number(beta, name="beta")
    if not 1 <= parameter <= 2:
        raise InputError(f"beta must be a number from 1 to 2, got {beta!r:.60}")
    as_choice(kind, ("lune", "circle"), name="kind")
    closed = as_choice(boundary, _BOUNDARIES, name="boundary") == "closed"
    base = skeleton(points, workers=workers, planar=planar)
    if kind == "circle" and base.points.shape[1] == 3:
        raise InputError("kind='circle' is only available in 2-D: use kind='lune'")
    if parameter == 1:
        edges = _balls(base, closed=closed)
    else:
        edges = _filtered(base, kind, parameter, closed=closed)
    return _graph(points, base, edges, f"beta skeleton ({kind}, {parameter:g})", workers)


def _balls(base: Skeleton, *, closed: bool) -> NDArray[np.int32]:
    """Return the edges whose diametral ball is empty."""
    edges = _filtered(base, "ball", 1.0, closed=closed)
    if closed or base.is_chain or not len(edges):
        return edges
    _, simplices, beside = base.tiling or (None, None, None)
    far = _core.antipodes(base.adjacency, simplices, beside, base.workers)
    return joined(edges, far) if len(far) else edges


def _filtered(base: Skeleton, region: str, beta: float, *, closed: bool) -> NDArray[np.int32]:
    """Return the Delaunay edges whose region is empty."""
    if base.points.shape[1] == 3 or region == "lune" or base.tiling is None:
        return _core.proximity(base.adjacency, region, beta, closed, base.workers)
    return _core.of_triangles2(base.tiling, region, beta, closed, base.workers)


def _graph(
    points: Points, base: Skeleton, edges: NDArray[np.int32], kind: str, workers: int | None
) -> Graph:
    made = Graph._made(base.points, edges, base.duplicates, kind=kind, workers=workers)
    return made._refer(points)
