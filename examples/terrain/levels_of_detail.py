"""
Fewer triangles with a bound on the error
=========================================

The ground of a lidar survey is reduced to a fraction of its triangles. No point is farther than 5 cm from the
surface, and the same run gives coarser levels of detail.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.terrain import TIN

survey = ahn3()
ground = survey.attributes["classification"] == 2
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]
tin = TIN.from_points(points, max_edge=6, duplicates="min")

# %%
# One run inserts points into a coarse surface, always the point that is farthest from it. Each prefix of the sequence
# is a level of detail; its error is rounded upward, so that it holds for all points.

levels = tin.simplification(max_error=0.05)
print(levels)
for error in (0.4, 0.2, 0.1, 0.05):
    level = levels.surface(max_error=error)
    print(f"{error:.2f} m: {level.nsimplex:6d} of {tin.nsimplex} triangles")

# %%
# The check of a level is independent of the insertion: it compares each point with the surface in exact arithmetic. A
# common mistake is to measure the error at the vertices of the coarse surface, where it is always 0.

proof = levels.validate(max_error=0.1)
print(proof, f"the farthest point is {np.nanmax(proof.distances):.4f} m off")

# %%
# Three levels, and the error as a function of the number of triangles.

figure, axes = plt.subplots(2, 2, figsize=(8, 7.5), layout="constrained")
for ax, error in zip(axes.flat, (0.4, 0.2, 0.1), strict=False):
    level = levels.surface(max_error=error)
    heights = ax.tripcolor(
        level.to_matplotlib(), level.hillshade(), cmap="gray", vmin=0.3, vmax=1, edgecolors="none"
    )
    ax.triplot(level.to_matplotlib(), color="tab:blue", linewidth=0.3)
    ax.set(title=f"{error} m: {level.nsimplex} triangles", aspect="equal", xlabel="m", ylabel="m")
chart = axes[1, 1]
chart.loglog(levels.triangles, levels.errors, linewidth=1)
chart.set(title="All levels", xlabel="triangles", ylabel="error in m")
plt.show()
