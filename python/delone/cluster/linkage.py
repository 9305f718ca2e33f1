"""Single linkage clustering from the Euclidean minimum spanning tree."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_count, as_workers
from delone._base.counting import counted
from delone._base.immutable import Immutable, kept, sealed
from delone._base.numbers import as_nonnegative
from delone.errors import InputError
from delone.graphs import Graph, minimum_spanning_tree

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone.graphs.skeleton import Points

__all__ = ["SingleLinkage", "single_linkage"]


class SingleLinkage(Immutable):
    """The merges of single linkage clustering: the result of `single_linkage`.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The coordinates.
    tree : Graph
        The minimum spanning tree.
    linkage : ndarray of float64, shape (n - 1, 4)
        The merges, in the format of ``scipy.cluster.hierarchy``.
    npoints : int
        Number of points, including duplicates.

    Examples
    --------
    >>> from delone.cluster import single_linkage
    >>> found = single_linkage([(0, 0), (1, 0), (5, 0), (5, 2)])
    >>> found
    <SingleLinkage of 4 points>
    >>> found.linkage
    array([[0., 1., 1., 2.],
           [2., 3., 2., 2.],
           [4., 5., 4., 4.]])
    """

    __slots__ = ("_tree", "_workers")

    _tree: Graph
    _workers: int | None

    def __init__(self, tree: Graph, workers: int | None = None) -> None:
        self._hold(tree=tree, workers=workers)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._tree, self._workers)

    def __repr__(self) -> str:
        return f"<SingleLinkage of {counted(self.npoints, 'point')}>"

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""
        return self._tree.points

    @property
    def tree(self) -> Graph:
        """The minimum spanning tree."""
        return self._tree

    @property
    def npoints(self) -> int:
        """Number of points, including duplicates."""
        return self._tree.npoints

    @property
    @kept
    def linkage(self) -> Floats:
        """The merges, (n - 1, 4): two clusters, their distance, and the number of points in both.

        Clusters below n are rows; merge i creates cluster n + i. Distances ascend and are correctly
        rounded. If distances are equal, the edge of the tree whose ends have the smaller
        coordinates comes first; duplicates are merged at distance zero.
        """
        tree = self._tree
        if tree.npoints < 2:
            return sealed(np.empty((0, 4)))
        workers = as_workers(self._workers)
        return sealed(_core.linkage(tree.points, tree.edges, tree.duplicates, workers))

    def labels(self, *, height: float | None = None, n_clusters: int | None = None) -> Indices:
        """Cut the hierarchy at a distance, or into a number of clusters.

        Parameters
        ----------
        height : float, optional
            Points are in one cluster if steps of at most this length lead from one to the other.
        n_clusters : int, optional
            From 1 to the number of points: the number of clusters.

        Returns
        -------
        ndarray of int32, shape (n,)
            The cluster of each row. Clusters are numbered from 0 on by their first rows.

        Raises
        ------
        InputError
            Not exactly one of the two is given, `height` is negative or NaN, or `n_clusters` is out
            of range.
        DtypeError
            `height` is not a number, or `n_clusters` not an integer.

        Notes
        -----
        `height` is compared exactly with the lengths of the tree. With `n_clusters`, the last
        merges are undone; of merges at the same distance, those with the larger coordinates are
        undone first. O(n) time after `linkage`.

        Examples
        --------
        >>> from delone.cluster import single_linkage
        >>> found = single_linkage([(0, 0), (1, 0), (5, 0), (5, 2)])
        >>> found.labels(height=2), found.labels(n_clusters=3)
        (array([0, 0, 1, 1], dtype=int32), array([0, 0, 1, 2], dtype=int32))
        """
        if (height is None) == (n_clusters is None):
            raise InputError("labels needs one of height= and n_clusters=")
        if height is not None:
            limit = as_nonnegative(height, name="height")
            return self._tree.prune(max_length=limit).components()
        wanted = as_count(0 if n_clusters is None else n_clusters, name="n_clusters")
        n = self.npoints
        if not min(n, 1) <= wanted <= n:
            raise InputError(
                f"n_clusters must be from 1 to the {counted(n, 'point')}, got {wanted}"
            )
        if wanted == n:
            return sealed(np.arange(n, dtype=np.int32))
        return sealed(_core.graph_components(self._joined(n - wanted), n))

    def _joined(self, count: int) -> Indices:
        """Return a pair of rows for each of the first merges, (count, 2)."""
        n = self.npoints
        parts = self.linkage[:count, :2].astype(np.int64)
        # Any row of each cluster: that of its first part, found by following first parts.
        row = np.concatenate((np.arange(n), parts[:, 0]))
        while (row >= n).any():
            row = row[row]
        return row[parts].astype(np.int32)


def single_linkage(
    points: Points, *, workers: int | None = None, planar: bool = False
) -> SingleLinkage:
    """Cluster points by single linkage: repeatedly merge the two nearest clusters.

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
    SingleLinkage
        Its ``linkage`` contains the merges in SciPy's format; its method ``labels`` returns the
        clusters.

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
    delone.graphs.minimum_spanning_tree : The tree that the merges follow.

    Notes
    -----
    The merges are the edges of the minimum spanning tree in the order of their lengths, which are
    compared exactly (J. C. Gower and G. J. S. Ross, "Minimum spanning trees and single linkage
    cluster analysis", 1969). The tree is a subgraph of the Delaunay graph: this takes O(n log n)
    time and O(n) memory in 2-D, and in 3-D those of the triangulation. Unlike in
    ``scipy.cluster.hierarchy.linkage``, the distances of all pairs are never computed.

    Rows with the same coordinates are merged first, at distance zero. No points, or a single one,
    have no merges; points on one line or in one plane are not special cases.

    Examples
    --------
    >>> from scipy.cluster.hierarchy import dendrogram
    >>> from delone.cluster import single_linkage
    >>> found = single_linkage([(0, 0), (1, 0), (5, 0), (5, 2)])
    >>> found.labels(n_clusters=2)
    array([0, 0, 1, 1], dtype=int32)
    >>> dendrogram(found.linkage, no_plot=True)["leaves"]
    [0, 1, 2, 3]
    """
    return SingleLinkage(minimum_spanning_tree(points, workers=workers, planar=planar), workers)
