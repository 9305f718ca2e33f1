"""
A thousand time steps between stations
======================================

Water levels at scattered gauges are interpolated to a raster by natural neighbors, for every hour of six weeks. The
weights depend only on the positions, so they are computed once; each hour is then a product with a sparse matrix.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone.datasets import uniform
from delone.interpolate import NaturalNeighbor

gauges = 100 * uniform(300, seed=8)
x, y = np.meshgrid(np.arange(5.0, 95.0, 2.0), np.arange(5.0, 95.0, 2.0))
weights = NaturalNeighbor(gauges).weights_at(np.stack((x, y), axis=-1))
print(weights)

# %%
# The levels of one hour: a tide with a period of 12.42 hours that travels east, with spring and neap tides.


def levels(hour):
    """Return the level at each gauge."""
    phase = 2 * np.pi * hour / 12.42
    tide = np.cos(phase - gauges[:, 0] / 40) * (1 + 0.3 * np.cos(phase / 29))
    return tide - gauges[:, 1] / 500


highest, when = -np.inf, 0
for hour in range(1000):
    surface = weights @ levels(hour)
    if np.nanmax(surface) > highest:
        highest, when = float(np.nanmax(surface)), hour
    assert np.nanmax(surface) <= levels(hour).max() + 1e-12
print(f"highest water {highest:.3f}, in hour {when}")

# %%
# Three of the hours.

figure, axes = plt.subplots(1, 3, figsize=(10, 3.6), layout="constrained", sharey=True)
for ax, hour in zip(axes, (when, when + 3, when + 6), strict=True):
    image = ax.pcolormesh(x, y, weights @ levels(hour), vmin=-1.5, vmax=1.5, cmap="RdBu_r")
    ax.plot(*gauges.T, ".", color="0.3", ms=1.5)
    ax.set(title=f"Water level, hour {hour}", aspect="equal", xlabel="km")
figure.colorbar(image, ax=axes, label="level in m")
plt.show()
