"""
Slope and gradient of a field between scattered points
======================================================

An interpolant has a gradient everywhere, so no finite differences on a raster are needed. Applied to the depths of a
survey, it gives the slope of the sea floor, in degrees.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import baja
from delone.interpolate import Linear, NaturalNeighbor

survey = baja()
near = (np.abs(survey.points - (250.5, 23.5)) < 0.75).all(axis=1)
degrees, depth = survey.points[near], survey.z[near]
per_degree = 111_195 * np.array((np.cos(np.radians(23.5)), 1))
meters = (degrees - (249.75, 22.75)) * per_degree

# %%
# "farin" has continuous derivatives. ``gradients="plane"`` is the most robust estimate of the gradients where
# soundings lie along tracks. :meth:`delone.interpolate.Linear.gradient` returns one slope per triangle.

smooth = NaturalNeighbor(meters, depth, kind="farin", gradients="plane", duplicates="mean")
flat = Linear(meters, depth, duplicates="mean")
x, y = np.meshgrid(np.linspace(0, 150_000, 151), np.linspace(0, 165_000, 166))
nodes = np.stack((x, y), axis=-1)
known = smooth.distance(nodes) < 12_000


def slope(gradient):
    """Return the slope in degrees."""
    return np.where(
        known, np.degrees(np.arctan(np.hypot(gradient[..., 0], gradient[..., 1]))), np.nan
    )


facets, surface = slope(flat.gradient(nodes)), slope(smooth.gradient(nodes))
for name, values in (("linear", facets), ("farin", surface)):
    print(
        f"{name:7} median slope {np.nanmedian(values):.2f} degrees, 99 % below {np.nanpercentile(values, 99):.1f}"
    )

# %%
# A common mistake is a slope in meters per degree: with positions in degrees and depths in meters, every slope is
# nearly vertical.

wrong = Linear(degrees, depth, duplicates="mean").gradient(nodes / per_degree + (249.75, 22.75))
print(f"positions in degrees: median slope {np.nanmedian(slope(wrong)):.1f} degrees")
assert np.nanmedian(slope(wrong)) > 80

# %%
# The slope of the facets, the slope of the smooth surface, and the depth with arrows downhill.

figure, axes = plt.subplots(1, 3, figsize=(11.4, 4.3), layout="constrained", sharey=True)
for ax, values, title in zip(
    axes, (facets, surface), ("Slope, linear", "Slope, natural neighbor"), strict=False
):
    image = ax.pcolormesh(
        x / 1e3, y / 1e3, values, vmin=0, vmax=15, cmap="magma_r", rasterized=True
    )
    ax.set(title=title, aspect="equal", xlabel="km")
figure.colorbar(image, ax=axes[:2], label="degrees", extend="max", shrink=0.8)
bottom = np.where(known, smooth(nodes), np.nan)
image = axes[2].pcolormesh(
    x / 1e3, y / 1e3, bottom, vmin=-4500, vmax=0, cmap="viridis", rasterized=True
)
some = np.s_[5::12, 5::12]
down = -smooth.gradient(nodes[some])
down = down / np.hypot(down[..., :1], down[..., 1:])
axes[2].quiver(
    x[some] / 1e3,
    y[some] / 1e3,
    *np.where(known[some], np.moveaxis(down, -1, 0), np.nan),
    color="white",
)
axes[2].set(title="Depth, downhill", aspect="equal", xlabel="km")
figure.colorbar(image, ax=axes[2], label="m", extend="min", shrink=0.8)
plt.show()
