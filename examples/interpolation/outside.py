"""
Extrapolation, and masks far from the data
==========================================

Interpolation ends at the convex hull of the sites, which says little about where the data are dense. This example
masks the parts of a raster that are farther than 25 km from the nearest site, and shows the choices for points outside
the hull.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import InputError
from delone.datasets import uniform
from delone.interpolate import Linear

candidates = 200 * uniform(600, seed=12)
radius = np.hypot(*(candidates - 100).T)
angle = np.arctan2(*(candidates - 100).T)
sites = candidates[(radius > 55) & (radius < 85) & (np.abs(angle) < 2.6)]
salinity = 35 - 0.02 * sites[:, 0] + 0.4 * np.sin(sites[:, 1] / 20)
x, y = np.meshgrid(np.linspace(0, 200, 301), np.linspace(0, 200, 301))
nodes = np.stack((x, y), axis=-1)
print(f"{len(sites)} sites")

# %%
# ``max_distance=`` is in the units of the coordinates. It also masks inside the hull: here in the middle of a ring of
# sites, which long triangles span. ``distance()`` returns the distances, for your own masks or for shading.

inside = Linear(sites, salinity)
plain = inside(nodes)
masked = inside(nodes, max_distance=25)
assert np.nanmax(inside.distance(nodes)[np.isfinite(masked)]) <= 25

# %%
# ``extrapolate=`` is for points outside. A common mistake is to treat an extrapolated trend as data: linear
# extrapolation leaves the range of the values. With ``extrapolate="raise"``, a program stops instead.

nearest = Linear(sites, salinity, extrapolate="nearest")(nodes)
linear = Linear(sites, salinity, extrapolate="linear")(nodes)
for name, values in (("none", plain), ("nearest", nearest), ("linear", linear)):
    print(
        f"{name:8} {np.nanmin(values):.1f} to {np.nanmax(values):.1f}, {np.isnan(values).mean():.0%} without a value"
    )
assert np.nanmin(nearest) >= salinity.min() - 1e-9
try:
    Linear(sites, salinity, extrapolate="raise")([(100, 100), (0, 0)])
except InputError as error:
    print(error)

# %%
# Four rasters of the same sites.

figure, axes = plt.subplots(
    2, 2, figsize=(7.4, 6.6), layout="constrained", sharex=True, sharey=True
)
choices = (
    ("Convex hull: NaN outside", plain),
    ("max_distance=25", masked),
    ('extrapolate="nearest"', nearest),
    ('extrapolate="linear"', linear),
)
for ax, (title, values) in zip(axes.flat, choices, strict=True):
    image = ax.contourf(
        x, y, values, levels=np.arange(30.5, 36.1, 0.5), cmap="viridis", extend="both"
    )
    ax.plot(*sites.T, ".", color="black", ms=2.5)
    ax.set(title=title, aspect="equal", facecolor="0.9")
for ax in axes[1]:
    ax.set(xlabel="km")
figure.colorbar(image, ax=axes, label="salinity")
plt.show()
