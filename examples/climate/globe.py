"""
Stations to a global grid
=========================

Values at stations all over the Earth are interpolated to a grid of one degree, on the sphere: there is no seam at the
date line, and no gap at the poles. In the plane of longitudes and latitudes, the date line and the poles are edges of
the map.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import sphere
from delone.interpolate import NaturalNeighbor

random = np.random.default_rng(11)
vectors = random.normal(size=(900, 3))
longitude = np.degrees(np.arctan2(vectors[:, 1], vectors[:, 0]))
latitude = np.degrees(np.arctan2(vectors[:, 2], np.hypot(vectors[:, 0], vectors[:, 1])))
stations = np.column_stack((longitude, latitude))


def temperature(places):
    """Return an air temperature with waves around the Earth, which vanish at the poles."""
    lon, lat = np.radians(places[..., 0]), np.radians(places[..., 1])
    waves = 9 * np.sin(3 * lon + 1) * np.cos(lat) ** 3
    return 34 * np.cos(lat) ** 2 - 12 + waves + 6 * np.cos(lon - 2.8) * np.cos(lat) * np.sin(lat)


values = temperature(stations)

# %%
# The grid has longitudes from 0 to 360, and the stations from -180 to 180; on the sphere, they are the same
# meridians. The nodes of the first row are all at one pole, and those of the last row at the other. Each pole gets
# one value.

lon, lat = np.arange(0, 360.5, 1.0), np.arange(-90, 90.5, 1.0)
nodes = np.stack(np.meshgrid(lon, lat), axis=-1)
globe = sphere.NaturalNeighbor(stations, values)
found = globe(nodes)
truth = temperature(nodes)
assert np.isfinite(found).all()
assert np.ptp(found[0]) == 0 and np.ptp(found[-1]) == 0
assert (found[:, 0] == found[:, -1]).all()

# %%
# For comparison, the plane of longitudes and latitudes. ``degrees`` are first converted to the convention of the
# stations.

degrees = np.where(nodes[..., :1] > 180, nodes - (360, 0), nodes)
plane = NaturalNeighbor(stations, values)(degrees)
area = np.broadcast_to(np.cos(np.radians(lat))[:, None], truth.shape)
for name, field in (("plane", plane), ("sphere", found)):
    known = np.isfinite(field)
    mean = np.sqrt(np.average((field - truth)[known] ** 2, weights=area[known]))
    north = np.nanmax(np.abs(field - truth)[lat >= 75])
    print(
        f"{name:7}{(~known).sum():6} nodes without a value, root mean square error {mean:.2f} C, "
        f"largest error north of 75 degrees {north:.1f} C"
    )

# %%
# Weights work for any number of fields: here for one per month, with a single product. The gradient has components to
# the east and north, and is per meter if you pass the radius of the Earth.

table = globe.weights_at(nodes)
months = values[:, None] + 5 * np.sin(np.radians(latitude))[:, None] * np.cos(
    np.arange(12) / 6 * np.pi
)
year = table @ months
assert year.shape == (181, 361, 12)
steep = globe.gradient([(20.0, 50.0)], radius=6371.0)
print("degrees C per km, toward east and north:", steep.round(4).tolist())

# %%
# The seam and the gap are clearly visible from above the North Pole.

panels = [("Plane: error", plane - truth), ("Sphere: error", found - truth)]
figure = plt.figure(figsize=(8.4, 7.6), layout="constrained")
axes = figure.subplot_mosaic([["map", "map"], ["plane", "sphere"]], height_ratios=(1, 1.1))
image = axes["map"].pcolormesh(lon, lat, found, cmap="RdYlBu_r", shading="gouraud")
axes["map"].plot(longitude % 360, latitude, ".", color="black", ms=2)
axes["map"].set(
    title="Sphere: temperature", aspect="equal", xlabel="degrees east", ylabel="degrees north"
)
figure.colorbar(image, ax=axes["map"], label="C")

cap = lat >= 45
turn, away = np.radians(nodes[cap][..., 0]), 90 - nodes[cap][..., 1]
for ax, (title, field) in zip((axes["plane"], axes["sphere"]), panels, strict=True):
    image = ax.pcolormesh(
        away * np.sin(turn), -away * np.cos(turn), field[cap], cmap="PuOr", vmin=-2, vmax=2,
        shading="gouraud",
    )  # fmt: skip
    ax.set(
        title=title,
        aspect="equal",
        xticks=[],
        yticks=[],
        facecolor="0.6",
        xlim=(-45, 45),
        ylim=(-45, 45),
    )
    ax.text(0, 44, "180", ha="center", va="top")
figure.colorbar(image, ax=[axes["plane"], axes["sphere"]], label="C", extend="both")
plt.show()
