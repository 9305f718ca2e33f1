"""The Euclidean minimum spanning tree of a million points: it lies in the Delaunay edges.

Of all pairs of points, only the Delaunay edges need to be considered: fewer than three per point.
Needs SciPy. Run it: ``python examples/spanning_tree.py``.
"""

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree

from delone import Delaunay
from delone.datasets import uniform

POINTS = 1_000_000


def main() -> None:
    """Find the tree and compare its length with what theory expects."""
    mesh = Delaunay(uniform(POINTS, seed=1))
    start, end = mesh.edges.T
    length = np.linalg.norm(mesh.points[start] - mesh.points[end], axis=1)
    graph = coo_array((length, (start, end)), shape=(POINTS, POINTS))
    tree = minimum_spanning_tree(graph.tocsr())

    assert tree.nnz == POINTS - 1
    print(f"{len(mesh.edges):,} Delaunay edges, {tree.nnz:,} in the tree")
    # The length of the tree over sqrt(n) tends to a constant, known by simulation as about 0.633.
    print(f"length / sqrt(n) = {tree.sum() / POINTS**0.5:.3f}")


if __name__ == "__main__":
    main()
