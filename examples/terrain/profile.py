"""
Profile along a line
====================

Heights along a line over lidar points: from one street across a canal to another street, and across a road ramp.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.terrain import TIN

survey = ahn3()
ground = survey.attributes["classification"] == 2
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]
tin = TIN.from_points(points, max_edge=6)
line = np.array([(8.0, 30), (58, 38), (96, 20)])
profile = tin.profile(line)
print(tin)
print(profile)

# %%
# The profile has a point at each edge that the line crosses: it follows the surface exactly and is not sampled. Where
# the line leaves the surface, over the canal, there is a gap. A common mistake is to triangulate without ``max_edge``
# or a boundary: then the surface spans the canal, and the profile has a bridge that does not exist.

spanned = TIN.from_points(points).profile(line)
print(f"{np.isnan(profile.z).sum()} gaps, {np.isnan(spanned.z).sum()} without max_edge")

figure, (plan, ax) = plt.subplots(
    1, 2, figsize=(11, 4), layout="constrained", width_ratios=(1, 2.2)
)
shade = tin.raster("hillshade", resolution=0.5, z_factor=3)
plan.imshow(shade.values, origin="lower", extent=(0, 100, 0, 100), cmap="gray")
plan.plot(*line.T, color="tab:red", marker="o", markersize=4)
plan.set(title="Plan, hillshade", xlabel="m", ylabel="m")
ax.plot(spanned.distances, spanned.z, color="0.7", label="without max_edge")
profile.plot(ax, color="tab:red", label="surface")
ax.axvline(np.hypot(*(line[1] - line[0])), color="0.8", linewidth=0.8, linestyle="--")
ax.set(title="Profile, ten times as high as long", xlabel="distance in m", ylabel="height in m")
ax.set_aspect(10)
ax.legend(loc="upper left")

# %%
# ``line_of_sight`` tests whether one point is visible from another, here from an eye height of 1.7 m. The obstruction
# is the first vertex of the profile above the line.

sight = tin.line_of_sight(line[0], line[2], height=1.7)
x, y, z = sight.obstruction
print(f"visible: {bool(sight)}; first obstruction at ({x:.1f}, {y:.1f}), {z:.2f} m high")
plt.show()
