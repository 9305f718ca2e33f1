"""
Ground points in lidar
======================

Roofs and trees are removed from a lidar survey, using only positions and heights. The picture shows the ground points,
and the ground surface below the houses.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.terrain import TIN, ground

survey = ahn3()
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))
found = ground(points)
print(found)
print("points of each pass:", found.added)

# %%
# The points of the sample are classified. Type I errors are ground points that are missed; type II errors are other
# points that are mistaken for ground. A common mistake is a cell that is narrower than a roof.

reference = survey.attributes["classification"] == 2
print(found.compare(reference))
print("cells of 5 m:", ground(points, cell=5).compare(reference))

# %%
# Left: all points, by height. Middle: the ground points. Right: the hillshade of their triangulation.

figure, axes = plt.subplots(1, 3, figsize=(11, 4), layout="constrained", sharex=True, sharey=True)
low, high = np.percentile(points[:, 2], (1, 99))
for ax, rows, title in zip(
    axes[:2], (np.ones(len(points), dtype=bool), found.mask), ("all points", "ground"), strict=True
):
    x, y, z = points[rows][::4].T
    drawn = ax.scatter(x, y, c=z, s=0.4, vmin=low, vmax=high)
    ax.set(title=title, aspect="equal", xlabel="m")
figure.colorbar(drawn, ax=axes[:2], label="height in m", shrink=0.8)
tin = TIN.from_points(points[found.mask], duplicates="min")
shade = tin.hillshade()
axes[2].tripcolor(tin.to_matplotlib(), facecolors=shade, cmap="gray", vmin=0, vmax=1)
axes[2].set(title="hillshade of the ground", aspect="equal", xlabel="m")
plt.show()
