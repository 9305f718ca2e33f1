"""
The minimum spanning tree of many points
========================================

The Euclidean minimum spanning tree lies in the Delaunay edges. So of all pairs of points, fewer than three per
point need to be considered, and the tree of 200,000 points takes a second.

Install: ``pip install "delone[plot]" scipy``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from scipy.sparse import coo_array
from scipy.sparse.csgraph import minimum_spanning_tree

from delone import Delaunay
from delone.datasets import uniform


def spanning_tree(points):
    """Return the triangulation, and the minimum spanning tree as a sparse matrix of lengths."""
    mesh = Delaunay(points)
    start, end = mesh.edges.T
    length = np.linalg.norm(mesh.points[start] - mesh.points[end], axis=1)
    graph = coo_array((length, (start, end)), shape=(len(points), len(points)))
    return mesh, minimum_spanning_tree(graph.tocsr()).tocoo()


# %%
# The length of the tree divided by the square root of the number of points tends to a constant, which is known
# from simulations: about 0.633.

points = uniform(200_000, seed=1)
mesh, tree = spanning_tree(points)
assert tree.nnz == len(points) - 1
print(f"{len(mesh.edges):,} Delaunay edges, {tree.nnz:,} in the tree")
print(f"length / sqrt(n) = {tree.sum() / len(points) ** 0.5:.3f}")

# %%
# The tree of fewer points, on their triangulation.

few = uniform(400, seed=3)
mesh, tree = spanning_tree(few)
figure, ax = plt.subplots(figsize=(6, 6), layout="constrained")
ax.triplot(mesh.to_matplotlib(), color="0.85", linewidth=0.8)
ax.add_collection(LineCollection(few[np.column_stack((tree.row, tree.col))], color="tab:blue"))
ax.plot(*few.T, ".", color="0.2", ms=4)
ax.set(title="Minimum spanning tree of 400 points", aspect="equal", xticks=[], yticks=[])
plt.show()
