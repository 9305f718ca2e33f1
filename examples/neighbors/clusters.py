"""
Clusters without choosing a distance (HDBSCAN)
==============================================

HDBSCAN finds dense groups of points, whatever their density. Here they are buildings in a lidar cloud: roofs are
dense, walls are not, and you need not know the distance between buildings.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.cluster import DBSCAN, HDBSCAN
from delone.datasets import ahn3

# %%
# The points classified as buildings in the survey (class 6), in 3-D. A building has at least 300 points.

survey = ahn3()
roof = survey.attributes["classification"] == 6
xyz = np.column_stack((survey.points, survey.z))[roof]
model = HDBSCAN(min_cluster_size=300, min_samples=10).fit(xyz)
sizes = np.bincount(model.labels_[model.labels_ >= 0])
print(
    f"{len(sizes)} clusters of {sizes.tolist()} points, {np.sum(model.labels_ < 0)} points of noise"
)
assert len(sizes) == 5

# %%
# A common mistake is to choose a distance that suits only part of the data. DBSCAN needs one. Half a meter is more
# than the distance between most neighbors, but scans leave gaps in roofs and walls, so buildings are split.

short = DBSCAN(eps=0.5, min_samples=10).fit(xyz)
print(f"DBSCAN, 0.5 m: {short.labels_.max() + 1} clusters, {np.mean(short.labels_ < 0):.0%} noise")

# %%
# Both results, seen from above.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.8), layout="constrained")
shown = {"HDBSCAN, 300 points": model.labels_, "DBSCAN, 0.5 m": short.labels_}
for ax, (title, labels) in zip(axes, shown.items(), strict=True):
    noise = labels < 0
    # The largest clusters first, so that they have different colors.
    order = np.argsort(-np.bincount(labels[~noise]))
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    ax.scatter(*survey.points[~roof][::20].T, s=0.4, color="0.9", linewidths=0)
    ax.scatter(
        *xyz[~noise, :2].T, c=rank[labels[~noise]] % 10, s=0.6, cmap="tab10", vmax=9, linewidths=0
    )
    ax.scatter(*xyz[noise, :2].T, s=0.6, color="black", linewidths=0)
    count = labels.max() + 1
    ax.set(title=f"{title}: {count} clusters", aspect="equal", xticks=[], yticks=[])
plt.show()
