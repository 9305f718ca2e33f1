"""
Global fields across the date line
==================================

Longitudes 179.9 and -179.9 are neighbors, but planar code puts them at opposite ends of the map. A triangulation with a
period of 360 degrees joins the two ends, and the interpolant has no seam.

Install: ``pip install "delone[plot]"``.
"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from delone import PeriodicDelaunay
from delone.datasets import uniform
from delone.interpolate import NaturalNeighbor

stations = uniform(700, seed=6) * (360, 120) - (180, 60)


def temperature(longitude, latitude):
    """Return an air temperature: warm at the equator, and warmest near the date line."""
    warm_pool = 6 * np.cos(np.radians(longitude - 170)) * np.exp(-((latitude / 22) ** 2))
    return 26 * np.cos(np.radians(latitude)) ** 1.5 + warm_pool


values = temperature(*stations.T)

# %%
# Both interpolants get the same values. ``periods=(360, None)`` repeats the points in x but not in y. Queries may
# have any longitude, and those of the map run from 20 to 380.

longitude, latitude = np.meshgrid(np.arange(20, 380.5, 1.0), np.arange(-55, 55.5, 1.0))
east = np.where(longitude > 180, longitude - 360, longitude)
planar = NaturalNeighbor(stations, values)(np.stack((east, latitude), axis=-1))
around = NaturalNeighbor(PeriodicDelaunay(stations, periods=(360, None)), values)
joined = around(np.stack((longitude, latitude), axis=-1))
truth = temperature(longitude, latitude)
print(
    f"planar: {np.isnan(planar).sum()} nodes without a value, largest error {np.nanmax(np.abs(planar - truth)):.1f} C"
)
print(
    f"period: {np.isnan(joined).sum()} nodes without a value, largest error {np.nanmax(np.abs(joined - truth)):.1f} C"
)
assert np.isnan(planar).sum() > np.isnan(joined).sum()

# %%
# A common mistake is to mix longitudes from -180 to 180 with longitudes from 0 to 360: then the same stations are
# in the plane twice, or queries are outside. With a period, both are the same location.

assert np.allclose(around([(190.0, 5.0)]), around([(-170.0, 5.0)]), rtol=0, atol=1e-9)
print(
    "planar at 190 E:",
    NaturalNeighbor(stations, values)([(190.0, 5.0)]),
    "with a period:",
    around([(190.0, 5.0)]).round(2),
)

# %%
# Distances are still planar: a degree of longitude counts as much at 55 degrees north as at the equator, and there
# are no poles. For high latitudes, project the points, or interpolate on the sphere, as in the example "Stations to a
# global grid".


def data_folder():
    """Return the folder ``data`` next to the examples, even when this runs as a notebook."""
    here = Path(__file__).parent if "__file__" in globals() else Path.cwd()
    return next(folder / "data" for folder in (here, *here.parents) if (folder / "data").is_dir())


land = json.loads((data_folder() / "land.geojson").read_text())["features"][0]["geometry"][
    "coordinates"
]
figure, axes = plt.subplots(2, 1, figsize=(6.4, 7.4), layout="constrained", sharex=True)
for ax, field, title in zip(axes, (planar, joined), ("Planar", "periods=(360, None)"), strict=True):
    image = ax.contourf(
        longitude, latitude, field, levels=np.arange(8, 33, 2), cmap="RdYlBu_r", extend="both"
    )
    for ring, *_ in land:
        for shift in (0, 360):
            ax.fill(
                np.array(ring)[:, 0] + shift, np.array(ring)[:, 1], color="0.75", ec="0.45", lw=0.5
            )
    ax.plot(stations[:, 0] % 360, stations[:, 1], ".", color="black", ms=1.5)
    ax.axvline(180, color="black", lw=0.8, ls="--")
    ax.set(title=title, xlim=(70, 290), ylim=(-55, 55), ylabel="degrees north", aspect="equal")
axes[1].set(xlabel="degrees east")
figure.colorbar(image, ax=axes, label="temperature in C", orientation="horizontal", shrink=0.8)
plt.show()
