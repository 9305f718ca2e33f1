"""
Cross sections of a design
==========================

Sections across an axis every few meters, with the ground and a design in one drawing, as a contractor stakes them out.

Install: ``pip install "delone[plot,geo,dxf]"``.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import ahn3
from delone.io import write_drawing
from delone.terrain import TIN

survey = ahn3()
ground = np.flatnonzero(survey.attributes["classification"] == 2)[::8]
points = np.column_stack((survey.points - survey.points.min(axis=0), survey.z))[ground]
before = TIN.from_points(points, max_edge=6)
pad = [(64.0, 32), (79, 28), (84, 46), (69, 50)]
after = before.embank(pad, 1.6, cut=1 / 2, fill=1 / 3)

# %%
# Stations every 4 m, 14 m to both sides. The last station is the end of the axis, whatever its distance. Each
# section has a point wherever it crosses an edge of either surface, so differences between the surfaces are also exact
# between the points.

axis = [(60.0, 43), (75, 39), (88, 35)]
sections = before.cross_sections(
    axis, interval=4, left=14, others={"design": after}, name="ground", start=100
)
print(sections)
table = sections.to_pandas()
table["depth"] = table["design"] - table["ground"]
print(table.groupby("station")["depth"].agg(["min", "max"]).round(2))

# %%
# A common mistake is to measure offsets along a bend of the axis: at a corner, the section bisects the angle.

sections.figure(columns=3)

figure, ax = plt.subplots(figsize=(6.4, 5.4), layout="constrained")
ax.tripcolor(after.to_matplotlib(), facecolors=after.hillshade(), cmap="gray", vmin=0, vmax=1)
contours = after.contours(interval=0.25, index=4)
contours.plot(ax, colors="0.35", labels=contours.labels(length=5, index=True))
sections.plot(ax, colors="firebrick")
ax.set(title="Sections in plan", xlabel="m", ylabel="m", xlim=(48, 100), ylim=(15, 65))

# %%
# The same sections as a drawing for CAD, with frames, labels and a layer for each surface.

with tempfile.TemporaryDirectory() as folder:
    drawing = Path(folder) / "sections.dxf"
    write_drawing(drawing, sections, exaggeration=2, units="m")
    print(f"{drawing.stat().st_size / 1024:.0f} KiB")
plt.show()
