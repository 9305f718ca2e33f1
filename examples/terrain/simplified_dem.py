"""
A raster as a few hundred triangles
===================================

An elevation model of 40,000 cells becomes a surface of a few hundred triangles. A breakline is kept, and at no cell
does the surface differ from the raster by more than the bound.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.interpolate import Grid
from delone.terrain import TIN, difference

# %%
# A valley between hills, with a dike across it.

x = y = np.arange(0.5, 200)
east, north = np.meshgrid(x, y)
hills = 12 * np.exp(-((east - 50) ** 2 + (north - 140) ** 2) / 2500)
hills += 18 * np.exp(-((east - 150) ** 2 + (north - 60) ** 2) / 3600)
dike = np.clip(9 - np.abs(north - 100 - 0.1 * east) / 2, 0, None)
model = Grid(np.maximum(hills, dike), x, y)
crest = [(0.5, 100.05, 9), (199.5, 119.95, 9)]

# %%
# The bound of ``simplify`` holds at every point of the original surface; these points are the centers of cells here.
# Breaklines are kept, so the crest of the dike remains sharp.

tin = TIN.from_raster(model, breaklines=[crest])
coarse = tin.simplify(max_error=0.25)
print(tin)
print(coarse, f"{coarse.nsimplex / tin.nsimplex:.2%} of the triangles")

# %%
# ``max_triangles`` gives the number of triangles instead of the error. With ``keep="boundary"``, lines inside may be
# removed. Here, the surface then needs more triangles.

few = tin.simplify(max_triangles=300)
loose = tin.simplify(max_error=0.25, keep="boundary")
print(few)
print(loose)

# %%
# The difference from the raster at each cell is an independent check. Without a raster to compare with, use
# ``tin.simplification(max_error=0.25).validate(max_error=0.25)``. A common mistake is to use every tenth cell instead:
# the dike then has gaps.

found = difference(model, coarse, units="m")
print(found)
assert np.nanmax(np.abs(found.values)) <= 0.25 + 1e-9
tenth = TIN.from_raster(Grid(model.values[5::10, 5::10], x[5::10], y[5::10]))
print(f"every tenth cell, {tenth.nsimplex} triangles:", difference(model, tenth, units="m"))

figure, axes = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
shade = coarse.hillshade(z_factor=2)
axes[0].tripcolor(coarse.to_matplotlib(), shade, cmap="gray", vmin=0, vmax=1)
axes[0].triplot(coarse.to_matplotlib(), color="tab:blue", linewidth=0.4)
axes[0].set(title=f"{coarse.nsimplex} triangles", aspect="equal", xlabel="m", ylabel="m")
found.plot(axes[1], title="Raster minus surface", limit=0.25)
plt.show()
