"""
Separate buildings in a lidar cloud
===================================

Points that can be reached from each other in small steps belong together. The minimum spanning tree contains all
necessary steps: after its long edges are removed, each part is a building.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.graphs import minimum_spanning_tree

# %%
# The points on roofs and walls in 3-D, as classified in the survey (class 6).

survey = ahn3()
roof = survey.attributes["classification"] == 6
xyz = np.column_stack((survey.points, survey.z))[roof]
tree = minimum_spanning_tree(xyz)
print(tree)
print(f"99 % of the steps are below {np.percentile(tree.lengths, 99):.2f} m")

# %%
# Buildings are more than 2 m apart, and no step within a building is longer. Smaller parts are antennas, birds and
# points of the wrong class.

parts = tree.prune(max_length=2.0)
label = parts.components()
size = np.bincount(label)
buildings = np.flatnonzero(size >= 100)
print(
    f"{parts.ncomponents} parts, {len(buildings)} with at least 100 points: {size[buildings].tolist()}"
)
assert len(buildings) == 5

# %%
# Seen from above, with a color for each building.

colors = np.full(len(size), -1)
colors[buildings[np.argsort(-size[buildings])]] = np.arange(len(buildings))
shade = colors[label]
figure, ax = plt.subplots(figsize=(6.4, 6), layout="constrained")
ax.scatter(*survey.points[~roof][::20].T, s=0.5, color="0.85", linewidths=0)
ax.scatter(*xyz[shade >= 0, :2].T, c=shade[shade >= 0], s=1, cmap="Set1", vmax=8, linewidths=0)
ax.plot(*xyz[shade < 0, :2].T, "kx", ms=5)
ax.set(title="Five buildings, and points that belong to none", aspect="equal", xticks=[], yticks=[])
plt.show()
