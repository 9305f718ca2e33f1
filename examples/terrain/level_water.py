"""
A level canal
=============

Water returns few lidar pulses, and triangles that span it slope from bank to bank. ``level`` makes the canal flat, and
``snap`` merges lidar points with a surveyed line along the quay.

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
# The canal is a polygon, and the line was surveyed along the foot of the eastern quay. The polygon has no heights, so
# the water gets the lowest height along its shore. Points in the polygon or on its shore are left out and counted.

canal = np.array([(7, 100), (9.5, 60), (12.5, 8), (19.5, 8), (20.5, 30), (18, 75), (17, 100)])
axis = np.array([(22.5, 98), (23.2, 80), (24.4, 60), (25.6, 40), (26.4, 25)])
box = (points[:, 0] < 40) & (points[:, 1] < 100)
rough = TIN.from_points(points[box], duplicates="min")
level = TIN.from_points(points[box], duplicates="min", level=[canal], breaklines=[axis])
print(rough)
print(level, level.adjustments)
print(f"water at {level.heights((15, 40)):.2f} m; without level {rough.heights((15, 40)):.2f} m")

# %%
# Points a few centimeters from the line form thin triangles next to it. With ``snap=0.1``, points closer than 10 cm to
# the line become points of the line, and points closer than 10 cm to each other become one. No point moves farther than
# that, and only x and y change.

snapped = TIN.from_points(
    points[box], duplicates="mean", level=[canal], breaklines=[axis], snap=0.1
)
print(snapped, snapped.adjustments)
for name, tin in {"without": level, "with": snapped}.items():
    angles = tin.quality().smallest_angle
    print(f"{name} snap: {np.count_nonzero(angles < 5)} triangles with an angle below 5 degrees")

# %%
# The maps show heights, and the triangles along two meters of the line. A common mistake is to give water the mean
# height of its banks: in places, it would then be above them.

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
