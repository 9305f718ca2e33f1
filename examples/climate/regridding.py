"""
Conservative regridding of HEALPix to longitudes and latitudes
==============================================================

A field on HEALPix pixels is regridded to cells of 3 degrees. At coasts, cells are partly covered, so preserving totals
and preserving means give different results.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import datasets, sphere

# %%
# The field has values at sea only, like the temperature of an ocean model.

source = sphere.Grid.from_healpix(24)
places = source.centers_lonlat
coast = sphere.from_geometry(datasets.land())
at_sea = coast.polygon_of_simplex[coast.find_simplex(places)] < 0
lon, lat = np.radians(places.T)
field = np.where(at_sea, 15 + 12 * np.cos(2 * lat) + 3 * np.sin(4 * lon) * np.cos(lat), np.nan)

# %%
# The areas that cells share are computed once. They add up to the areas of the cells.

target = sphere.Grid.from_lonlat(np.arange(-180, 181, 3), np.arange(-90, 91, 3))
overlaps = sphere.Overlaps(source, target)
print(overlaps)
print(f"largest error of a covered share: {abs(overlaps.covered_target - 1).max():.1e}")

# %%
# "conservative" preserves the total; "normalized" is the mean over the part that has values.

conservative = overlaps.to_weights("conservative").apply(field, skipna=True)
means = overlaps.to_weights("normalized").apply(field, skipna=True)
total = np.nansum(field * source.areas)
kept = np.nansum(conservative.ravel() * target.areas)
print(f"totals: {total:.12f}, {kept:.12f}")
assert np.isclose(total, kept, rtol=1e-13)

# %%
# The ratio of the two results is the fraction of a cell that is sea.

figure, axes = plt.subplots(3, 1, figsize=(7, 10), layout="constrained", sharex=True)
edges = np.arange(-180, 181, 3), np.arange(-90, 91, 3)
for ax, values, title in zip(
    axes,
    (conservative, means, conservative / means),
    (
        "conservative: totals are preserved, °C",
        "normalized: means at sea, °C",
        "their ratio: the fraction that is sea",
    ),
    strict=True,
):
    colors = ax.pcolormesh(*edges, values, cmap="viridis")
    figure.colorbar(colors, ax=ax)
    ax.set(title=title, aspect="equal", ylabel="latitude")
axes[-1].set_xlabel("longitude")
plt.show()
