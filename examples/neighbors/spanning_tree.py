"""
The minimum spanning tree of many points
========================================

The edges of the Euclidean minimum spanning tree are Delaunay edges. So instead of all pairs of points, fewer than
three edges per point need to be considered, and the tree of 200,000 points takes a fraction of a second.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt

from delone.datasets import uniform
from delone.graphs import delaunay_graph, minimum_spanning_tree

# %%
# The length of the tree divided by the square root of the number of points tends to a constant, which is known
# from simulations: about 0.633.

points = uniform(200_000, seed=1)
tree = minimum_spanning_tree(points)
assert tree.nedges == len(points) - 1
assert tree.ncomponents == 1
constant = tree.lengths.sum() / len(points) ** 0.5
print(f"length / sqrt(n) = {constant:.3f}")
assert 0.62 < constant < 0.66

# %%
# The tree of fewer points, drawn over their triangulation.

few = uniform(400, seed=3)
figure, ax = plt.subplots(figsize=(6, 6), layout="constrained")
delaunay_graph(few).plot(ax, color="0.85", linewidth=0.8, vertices=False)
minimum_spanning_tree(few).plot(ax, linewidth=1.6)
ax.set(title="Minimum spanning tree of 400 points", xticks=[], yticks=[])
plt.show()
