"""HDBSCAN: clusters of varying density, from a minimum spanning tree by mutual reachability."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_least, as_workers
from delone._base.numbers import as_nonnegative
from delone.cluster.condensed import binary, condensed_tree
from delone.cluster.estimator import Clusterer, numbered
from delone.cluster.selection import labeled, memberships, selected
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = ["HDBSCAN"]


class HDBSCAN(Clusterer):
    """Clusters of varying density, with the interface of ``sklearn.cluster.HDBSCAN``; exact.

    Parameters
    ----------
    min_cluster_size : int, optional
        At least 2: the smallest number of rows that form a cluster.
    min_samples : int, optional
        At least 1: the core distance of a row is the distance to its `min_samples`-th nearest row,
        including the row itself, as in scikit-learn. By default `min_cluster_size`.
    cluster_selection_epsilon : float, optional
        Clusters that split from each other at a smaller distance are not split.
    max_cluster_size : int, optional
        With ``"eom"``, larger clusters are not selected.
    metric : {"euclidean", "l2"}, optional
        Other metrics raise an error.
    cluster_selection_method : {"eom", "leaf"}, optional
        ``"eom"`` selects the clusters with the largest sum of stabilities (excess of mass),
        ``"leaf"`` those that are not split.
    allow_single_cluster : bool, optional
        Whether all points may be one cluster.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Attributes
    ----------
    labels_ : ndarray of int32, shape (n,)
        The cluster of each row, or -1 for noise. Clusters are numbered from 0 on by their first
        rows.
    probabilities_ : ndarray of float64, shape (n,)
        How long each row remains in its cluster as the distance shrinks, relative to the row that
        remains longest; 0 for noise.
    condensed_tree_ : ndarray, shape (m,)
        A structured array with ``parent``, ``child``, ``lambda_val`` and ``child_size``: the rows
        (children below n) and clusters (from n on, n being the root) that leave each cluster.
    crs_ : str or None
        The reference system that the points declared, as a GeoDataFrame does.
    n_features_in_ : int
        Number of coordinates, 2 or 3.

    Notes
    -----
    R. J. G. B. Campello, D. Moulavi and J. Sander, "Density-based clustering based on hierarchical
    density estimates" (2013). The mutual reachability of two points is the maximum of their
    distance and both core distances. All of these are compared exactly. Edges of equal weight are
    removed together, as in the paper: a cluster may split into more than two parts, and ties need
    no choice. So the clusters do not depend on the order of the rows, and scaling by a power of two
    leaves them unchanged. Only stabilities are sums of doubles.

    If no weights are equal, the clusters are those of scikit-learn, up to their numbering. With
    `min_samples` above 2, some weights are always equal, because a core distance is the weight of
    several edges; scikit-learn then splits in an order that depends on the rows. scikit-learn's
    alpha is always 1 here. Rows with the same coordinates count separately.

    The minimum spanning tree of all pairs is found by Boruvka's algorithm in a tree of boxes; it is
    not part of the Delaunay graph if `min_samples` exceeds 2. About O(n log n) time for scattered
    points, and O(n) memory. Time is quadratic if only some squared distances exceed the range of
    doubles.

    With `min_samples` above n, no row has a core distance, and all rows are noise. A single point
    is noise; so are points that all coincide, unless `allow_single_cluster` is set. Points on one
    line or in one plane are not special cases.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.cluster import HDBSCAN
    >>> random = np.random.default_rng(1)
    >>> points = np.concatenate([random.normal(x, 0.1, (100, 2)) for x in (0, 1, 5)])
    >>> model = HDBSCAN(min_cluster_size=20).fit(points)
    >>> np.unique(model.labels_)
    array([0, 1, 2], dtype=int32)
    """

    condensed_tree_: NDArray[np.void]
    probabilities_: Floats

    def __init__(
        self,
        min_cluster_size: int = 5,
        *,
        min_samples: int | None = None,
        cluster_selection_epsilon: float = 0.0,
        max_cluster_size: int | None = None,
        metric: str = "euclidean",
        cluster_selection_method: str = "eom",
        allow_single_cluster: bool = False,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        self.min_cluster_size = min_cluster_size
        self.min_samples = min_samples
        self.cluster_selection_epsilon = cluster_selection_epsilon
        self.max_cluster_size = max_cluster_size
        self.metric = metric
        self.cluster_selection_method = cluster_selection_method
        self.allow_single_cluster = allow_single_cluster
        self.workers = workers
        self.planar = planar

    def _cluster(self, given: ArrayLike) -> None:
        least = as_least(self.min_cluster_size, 2, name="min_cluster_size")
        samples = least
        if self.min_samples is not None:
            samples = as_least(self.min_samples, 1, name="min_samples")
        largest = None
        if self.max_cluster_size is not None:
            largest = as_least(self.max_cluster_size, 1, name="max_cluster_size")
        epsilon = as_nonnegative(self.cluster_selection_epsilon, name="cluster_selection_epsilon")
        methods = ("eom", "leaf")
        name = "cluster_selection_method"
        method = as_choice(self.cluster_selection_method, methods, name=name)
        single = as_flag(self.allow_single_cluster, name="allow_single_cluster")
        workers = as_workers(self.workers)
        points = self._points(given)
        tree = condensed_tree(
            points, samples=samples, least=least, epsilon=epsilon, workers=workers
        )
        if len(points) < 2 or samples > len(points):
            chosen = []
        else:
            chosen = selected(tree, method=method, epsilon=epsilon, single=single, largest=largest)
        labels = labeled(tree, chosen, epsilon=epsilon)
        self.labels_ = numbered(labels)
        self.probabilities_ = memberships(tree, labels)
        self.condensed_tree_ = tree.table()

    def to_hdbscan(self) -> NDArray[np.void]:
        """Return the condensed tree with binary splits, as the package hdbscan expects.

        Returns
        -------
        ndarray, shape (m,)
            The fields of `condensed_tree_`. Where a cluster splits into more than two parts, all
            but one of these are in an additional cluster without its own rows, which splits at the
            same lambda. ``hdbscan.plots.CondensedTree(model.to_hdbscan())`` plots it.

        Raises
        ------
        InputError
            The estimator has not been fitted.

        Notes
        -----
        Clusters are numbered differently from `condensed_tree_` if there are such splits. The order
        in which the parts are split off has no meaning. O(m log m) time.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.cluster import HDBSCAN
        >>> x = np.array([0, 1, 2, 10, 11, 12, 20, 21, 22])
        >>> model = HDBSCAN(3, min_samples=1).fit(np.column_stack((x, 0 * x)))
        >>> trees = model.condensed_tree_, model.to_hdbscan()
        >>> [int((tree["child_size"] > 1).sum()) for tree in trees]
        [3, 4]
        """
        table = getattr(self, "condensed_tree_", None)
        if table is None:
            raise InputError("this HDBSCAN has not been fitted: call fit first")
        return binary(table)
