"""DBSCAN: clusters of one density."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_least, as_workers
from delone._base.numbers import as_nonnegative
from delone.cluster.estimator import Clusterer, numbered
from delone.graphs.scale import rescaled

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = ["DBSCAN"]


class DBSCAN(Clusterer):
    """Clusters of one density, with the interface of ``sklearn.cluster.DBSCAN``; exact.

    Parameters
    ----------
    eps : float, optional
        At least 0, used exactly as given: points at this distance are neighbors. With 0, only rows
        with the same coordinates are neighbors. It may be infinite.
    min_samples : int, optional
        At least 1: a core point has this many rows within `eps`, including itself.
    metric : {"euclidean", "l2"}, optional
        Other metrics raise an error.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Attributes
    ----------
    labels_ : ndarray of int32, shape (n,)
        The cluster of each row, or -1 for noise. Clusters are numbered from 0 on by their first
        rows.
    core_sample_indices_ : ndarray of int32, shape (m,)
        The rows of core points, ascending.
    components_ : ndarray of float64, shape (m, d)
        The core points.
    crs_ : str or None
        The reference system that the points declared, as a GeoDataFrame does.
    n_features_in_ : int
        Number of coordinates, 2 or 3.

    Notes
    -----
    M. Ester, H.-P. Kriegel, J. Sander and X. Xu, "A density-based algorithm for discovering
    clusters in large spatial databases with noise" (1996). Core points within `eps` of each other
    are in one cluster. Another point within `eps` of core points belongs to the cluster of the
    nearest one; if several are equally near, to that with the lexicographically smallest
    coordinates. scikit-learn assigns it to the cluster that reaches it first. All squared distances
    are compared exactly. So the clusters do not depend on the order of the rows, and scaling points
    and `eps` by a power of two leaves them unchanged.

    Rows with the same coordinates count separately. With `min_samples` above n, all points are
    noise. Points on one line or in one plane are not special cases.

    Points are counted, and core points joined, in a tree of boxes: about O(n log n) time for
    scattered points and a small `min_samples`, whatever `eps` is; memory is O(n).

    Examples
    --------
    >>> from delone.cluster import DBSCAN
    >>> model = DBSCAN(eps=1, min_samples=3).fit([(0, 0), (1, 0), (0, 1), (5, 5), (1, 1)])
    >>> model.labels_, model.core_sample_indices_
    (array([ 0,  0,  0, -1,  0], dtype=int32), array([0, 1, 2, 4], dtype=int32))
    """

    core_sample_indices_: NDArray[np.int32]
    components_: Floats

    def __init__(
        self,
        eps: float = 0.5,
        *,
        min_samples: int = 5,
        metric: str = "euclidean",
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        self.eps = eps
        self.min_samples = min_samples
        self.metric = metric
        self.workers = workers
        self.planar = planar

    def _cluster(self, given: ArrayLike) -> None:
        eps = as_nonnegative(self.eps, name="eps")
        samples = as_least(self.min_samples, 1, name="min_samples")
        workers = as_workers(self.workers)
        points = self._points(given)
        # A count above that of all rows represents every larger one.
        scaled, exponent = rescaled(points, eps)
        reach = float(np.ldexp(eps, exponent))
        clusters, is_core = _core.density(scaled, reach, min(samples, len(points) + 1), workers)
        self.labels_ = numbered(clusters)
        self.core_sample_indices_ = np.flatnonzero(is_core).astype(np.int32)
        self.components_ = points[self.core_sample_indices_]
