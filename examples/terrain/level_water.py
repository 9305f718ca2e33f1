"""
A canal that is level
=====================

Water gives few lidar returns, and triangles that span it are inclined from bank to bank. ``level`` makes the canal flat,
and ``snap`` merges lidar points with the surveyed line of the quay.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.terrain import TIN

survey = ahn3()
ground = survey.attributes["classification"] == 2
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]

# %%
# The canal as a polygon, and a line that was surveyed along the foot of the eastern quay. The polygon has no heights, so
# the water has the lowest height along its shore. Points inside or on the shore are left out and counted.

canal = np.array([(7, 100), (9.5, 60), (12.5, 8), (19.5, 8), (20.5, 30), (18, 75), (17, 100)])
axis = np.array([(22.5, 98), (23.2, 80), (24.4, 60), (25.6, 40), (26.4, 25)])
box = (points[:, 0] < 40) & (points[:, 1] < 100)
rough = TIN.from_points(points[box], duplicates="min")
level = TIN.from_points(points[box], duplicates="min", level=[canal], breaklines=[axis])
print(rough)
print(level, level.adjustments)
print(f"water at {level.heights((15, 40)):.2f} m; without level {rough.heights((15, 40)):.2f} m")

# %%
# Points a few centimeters from the line give thin triangles beside it. With ``snap=0.1``, points that are nearer than 10 cm
# to the line become points of it, and points nearer than 10 cm to each other become one. The longest move is at most that,
# and only x and y change.

snapped = TIN.from_points(
    points[box], duplicates="mean", level=[canal], breaklines=[axis], snap=0.1
)
print(snapped, snapped.adjustments)
for name, tin in {"without": level, "with": snapped}.items():
    angles = tin.quality().smallest_angle
    print(f"{name} snap: {np.count_nonzero(angles < 5)} triangles with an angle below 5 degrees")

# %%
# Heights on the map, and the triangles along two meters of the line. A common mistake is to give water the mean height of
# its banks: it would be above them in places.

figure, axes = plt.subplots(1, 4, figsize=(11, 5.6), layout="constrained")
for ax, tin, title in zip(axes, (rough, level), ("Points only", "Level canal"), strict=False):
    faces = ax.tripcolor(tin.to_matplotlib(), tin.z, cmap="viridis", vmin=-0.4, vmax=0.4)
    ax.plot(*axis.T, color="firebrick", linewidth=1)
    ax.set(title=title, aspect="equal", xlabel="m", xlim=(0, 30), ylim=(0, 100))
figure.colorbar(faces, ax=axes[:2], label="height in m")
for ax, tin, title in zip(axes[2:], (level, snapped), ("Without snap", "With snap"), strict=True):
    ax.triplot(tin.to_matplotlib(), color="tab:blue", linewidth=0.8)
    ax.plot(*axis.T, color="firebrick", linewidth=1.5)
    ax.set(title=title, aspect="equal", xlabel="m", xlim=(24.3, 25.3), ylim=(53, 55))
plt.show()
