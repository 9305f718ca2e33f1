"""
Means of a field over continents and islands
============================================

The mean of a gridded field over an area depends on the part of each grid cell that lies in the area. A common
shortcut is to use the cells whose centers are inside. It is inaccurate for small areas and misses the smallest ones.

Install: ``pip install "delone[geo,plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import shapely

from delone import datasets, sphere

# %%
# The land of the Earth: 127 polygons, the largest first. Countries and catchments work the same way, as a GeoDataFrame.

polygons = [shapely.Polygon(rings[0], rings[1:]) for rings in datasets.land()["coordinates"]]
land = sphere.Grid.from_polygons(polygons)
print(land, land.report)

# %%
# A field on cells of 2.5 degrees, as in reanalyses: a temperature that falls with latitude.

field_grid = sphere.Grid.from_lonlat(np.arange(-180, 181, 2.5), np.arange(-90, 91, 2.5))
lon, lat = np.radians(field_grid.centers_lonlat.T)
celsius = -25 + 55 * np.cos(lat) ** 2 + 5 * np.sin(lat) + 3 * np.sin(3 * lon) * np.cos(lat)

# %%
# "normalized" is the mean over the covered part. The same weights work for all times and levels.

overlaps = sphere.Overlaps(field_grid, land)
means = overlaps.to_weights("normalized").apply(celsius)
assert np.isfinite(means).all()

# %%
# The shortcut: cells whose centers are inside, each with its area.

coast = sphere.from_geometry(polygons)
inside = coast.polygon_of_simplex[coast.find_simplex(field_grid.centers_lonlat)]
weights = np.where(inside >= 0, field_grid.areas, 0)
owner = np.maximum(inside, 0)
sums = np.bincount(owner, weights, len(polygons))
with np.errstate(invalid="ignore"):
    shortcut = np.bincount(owner, weights * celsius, len(polygons)) / sums
missed = int((sums == 0).sum())
away = np.abs(shortcut - means)
print(f"{missed} of {len(polygons)} areas contain no center of a cell")
print(f"largest error of the others: {np.nanmax(away):.1f} °C")
for k, name in enumerate(("Eurasia and Africa", "Antarctica", "the Americas")):
    print(f"{name:20} {means[k]:6.2f}, by centers {shortcut[k]:6.2f}")
assert missed > 0

# %%
# The means on a map, and the error of the shortcut against the size of the area.

figure, axes = plt.subplots(2, 1, figsize=(8, 8.2), layout="constrained", height_ratios=(3, 2))
land.to_geopandas({"mean": means}).plot(
    "mean", ax=axes[0], legend=True, edgecolor="0.3", lw=0.4, legend_kwds={"shrink": 0.7}
)
axes[0].set(title="Mean temperature of each land mass, °C", xlabel="longitude", ylabel="latitude")
axes[0].set_aspect("equal")
size = land.areas * 6371.0088**2
known = np.isfinite(away)
axes[1].loglog(size[known], np.maximum(away[known], 1e-3), "o", ms=4, label="one center or more")
marks = axes[1].get_xaxis_transform()
axes[1].plot(
    size[~known],
    np.full(missed, 0.03),
    "x",
    color="C3",
    transform=marks,
    label="no center inside, no value",
)
axes[1].set(xlabel="area, km²", ylabel="error, °C", title="Error of the means by centers of cells")
axes[1].set_ylim(bottom=3e-4)
axes[1].legend()
plt.show()
