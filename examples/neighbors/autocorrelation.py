"""
How similar are neighbors: Moran's I of a survey
================================================

Spatial statistics start with a graph of neighbors. The Gabriel graph has few edges, adapts to the density of the
points, and connects all of them; nearest neighbors are mostly on the same ship track.

Install: ``pip install "delone[plot]" scipy``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import baja
from delone.graphs import gabriel, nearest_neighbors

# %%
# Soundings off Baja California, in kilometers around the middle of the survey. Almost 2,000 rows repeat the position
# of another row. They are reported, and the graph connects the other rows.

survey = baja()
middle = survey.points.mean(axis=0)
scale = 111.2 * np.array([np.cos(np.radians(middle[1])), 1.0])
points = (survey.points - middle) * scale
graphs = {"Gabriel": gabriel(points), "6 nearest": nearest_neighbors(points, 6)}
for graph in graphs.values():
    print(graph)
distinct = np.setdiff1d(np.arange(len(points)), graphs["Gabriel"].duplicates[:, 0])

# %%
# Moran's I compares the depths of neighbors: 1 if they are equal, 0 if they are unrelated. ``to_csr`` returns the
# matrix of neighbors.


def moran(graph, z):
    """Return Moran's I with all weights equal to one."""
    w = graph.subgraph(distinct).to_csr(weights="binary")
    deviation = z[distinct] - z[distinct].mean()
    return len(distinct) / w.sum() * (deviation @ (w @ deviation)) / (deviation @ deviation)


shuffled = np.random.default_rng(1).permutation(survey.z)
for name, graph in graphs.items():
    print(f"{name}: I = {moran(graph, survey.z):.4f}, shuffled {moran(graph, shuffled):.4f}")
    assert moran(graph, survey.z) > 0.9
    assert abs(moran(graph, shuffled)) < 0.02

# %%
# Part of the survey: Gabriel edges connect the tracks; nearest neighbors are mostly along them.

window = np.flatnonzero((np.abs(points - (20, -60)) < 25).all(axis=1))
figure, axes = plt.subplots(1, 2, figsize=(9, 4.6), layout="constrained", sharey=True)
for ax, (name, graph) in zip(axes, graphs.items(), strict=True):
    part = graph.subgraph(window)
    part.plot(ax, linewidth=0.8, vertices=False)
    ax.set(title=f"{name}: {part.nedges} edges", xlabel="km")
plt.show()
