"""
Mean over an area from unevenly spread stations: Thiessen weights
=================================================================

Rain gauges are dense near towns, so their plain mean is biased toward the towns. Weighting each gauge by the area of
its Voronoi cell, clipped to the outline, is the method of Thiessen polygons.

Install: ``pip install "delone[plot]"``.
"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.path import Path as Path2D

from delone import Voronoi


def data_folder():
    """Return the folder ``data`` next to the examples, even when this runs as a notebook."""
    here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
    return next(folder / "data" for folder in (here, *here.parents) if (folder / "data").is_dir())


outline = json.loads((data_folder() / "gotland.geojson").read_text())["geometry"]["coordinates"][0]
south_west = np.min(outline, axis=0)
per_degree = 111.195 * np.array((np.cos(np.radians(57.5)), 1))
island = {"type": "Polygon", "coordinates": [((outline - south_west) * per_degree).tolist()]}

# %%
# Gauges on land, most of them near the town on the west coast, and a month of rain: more in the south. Areas need an
# equal-area plane; degrees scaled to kilometers are accurate enough for an island of 130 km.

random = np.random.default_rng(2)
near_town = random.normal((13, 79), 7, (60, 2))
elsewhere = random.uniform((0, 0), (60, 115), (45, 2))
gauges = np.concatenate((near_town, elsewhere))
gauges = gauges[Path2D(island["coordinates"][0]).contains_points(gauges)]


def rain(east, north):
    """Return the month's rain in millimeters."""
    return 95 - 0.55 * north + 8 * np.sin(east / 12)


cells = Voronoi(gauges, clip=island)
weights = cells.cell_areas / cells.cell_areas.sum()
print(
    f"{np.count_nonzero(weights)} of {len(gauges)} cells reach the island of {cells.cell_areas.sum():.0f} square km"
)

# %%
# The weighted mean costs one product for each month. Compare with the mean over a raster of the true field.

measured = rain(*gauges.T)
x, y = np.meshgrid(np.arange(0.25, 70, 0.5), np.arange(0.25, 130, 0.5))
nodes = np.stack((x, y), axis=-1)
one = Voronoi(nodes.reshape(-1, 2), clip=island).cell_areas
truth = np.average(rain(x, y).ravel(), weights=one)
print(
    f"true {truth:.1f} mm, Thiessen {weights @ measured:.1f} mm, plain mean {measured.mean():.1f} mm"
)
assert abs(weights @ measured - truth) < abs(measured.mean() - truth)

# %%
# A common mistake is to keep the weights when a gauge fails: the weights of the others no longer add up to 1. Either
# divide by the sum of the remaining weights, or compute the cells of the working gauges, which gives the area to the
# neighbors.

failed = measured.copy()
failed[np.argmax(weights)] = np.nan
works = np.isfinite(failed)
again = Voronoi(gauges[works], clip=island).cell_areas
print(
    f"weights kept {weights[works] @ failed[works]:.1f} mm, divided {np.average(failed[works], weights=weights[works]):.1f} mm,"
)
print(f"new cells {np.average(failed[works], weights=again):.1f} mm, NaN kept {weights @ failed}")

# %%
# The cells, colored by rain and by weight.

figure, axes = plt.subplots(1, 2, figsize=(7, 5.4), layout="constrained", sharey=True)
shown = (
    ("Rain at the nearest gauge", "mm", "YlGnBu", np.where(weights > 0, measured, np.nan)),
    ("Thiessen weights", "%", "OrRd", 100 * weights),
)
for ax, (title, unit, colors, values) in zip(axes, shown, strict=True):
    cells.plot(ax, values=values, cmap=colors, colorbar=False)
    figure.colorbar(ax.collections[0], ax=ax, label=unit, shrink=0.7)
    ax.set(title=title, aspect="equal", xlabel="km")
axes[0].set(ylabel="km")
plt.show()
