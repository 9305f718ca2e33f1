"""
Cut and fill of a building pad
==============================

A level pad with side slopes next to a road ramp: how much earth must be removed or added, and where.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection

import delone
from delone.datasets import ahn3
from delone.terrain import TIN

survey = ahn3()
ground = np.flatnonzero(survey.attributes["classification"] == 2)[::8]
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]
before = TIN.from_points(points, max_edge=6)

# %%
# The pad is 1.6 m high. Slopes rise to the ground at 1 : 2 in cut and fall to it at 1 : 3 in fill. They meet the
# ground at the daylight line. Corners are rounded.

pad = np.array([(64.0, 32), (79, 28), (84, 46), (69, 50)])
after = before.embank(pad, 1.6, cut=1 / 2, fill=1 / 3)
volume = before.volume_to(after)
print(after)
print(volume)

# %%
# Bisection finds the height of the pad at which cut and fill are equal: then no earth is brought in or taken
# away.

low, high = 1.0, 2.5
for _ in range(8):
    middle = (low + high) / 2
    balance = before.volume_to(before.embank(pad, middle, cut=1 / 2, fill=1 / 3)).net
    low, high = (low, middle) if balance > 0 else (middle, high)
after = before.embank(pad, middle, cut=1 / 2, fill=1 / 3)
volume = before.volume_to(after)
print(f"balanced at {middle:.3f} m: cut {volume.cut:.1f}, fill {volume.fill:.1f} cubic meters")

# %%
# The quantities of each half of the pad, as a table. ``coverage`` would be below 1 where the survey does not reach.

west, east = pad[[0, 3]], pad[[1, 2]]
middle_line = (west + east) / 2
halves = [np.vstack((west, middle_line[::-1])), np.vstack((middle_line, east[::-1]))]
table = before.volumes_to(after, halves).to_pandas({"half": ["west", "east"]})
print(table[["half", "cut", "fill", "area", "coverage"]].round(2).to_string(index=False))

# %%
# A pad too close to the edge of the survey cannot be built: the error says where. A common mistake is to
# clip the survey to the pad, which leaves no room for the slopes.

try:
    before.embank(pad + np.array([12, 0]), 8.0, slope=1 / 3)
except delone.OutsideError as error:
    print(error)

# %%
# The work to be done: the change of height in each triangle of the ground, the pad, and contours of the design.

figure, ax = plt.subplots(figsize=(7.5, 6), layout="constrained")
change = volume.mean_height
faces = ax.tripcolor(
    before.to_matplotlib(),
    np.where(np.abs(change) > 1e-6, change, np.nan),
    cmap="RdBu",
    vmin=-1,
    vmax=1,
)
figure.colorbar(faces, label="fill (blue) and cut (red) in m")
after.contours(interval=0.25, index=4).plot(ax, colors="0.4")
edges = after.points[after.breaklines[~after.soft]]
ax.add_collection(LineCollection(edges, colors="black", linewidths=0.8))
ax.text(*pad.mean(axis=0), f"{middle:.2f} m", ha="center", weight="bold")
ax.set(
    title=f"Cut {volume.cut:.0f} and fill {volume.fill:.0f} cubic meters",
    xlabel="m",
    ylabel="m",
    aspect="equal",
    xlim=(52, 98),
    ylim=(18, 62),
)
plt.show()
