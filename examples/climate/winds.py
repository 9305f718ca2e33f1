"""
Winds across a pole
===================

Winds are given by their components to the east and to the north, and near a pole these directions rotate with
longitude. If the components are interpolated as two scalar fields, a wind over the North Pole is too weak and has the
wrong direction. Interpolated as vectors, it is correct.

Install: ``pip install "delone[plot,xarray]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray

import delone.xarray

random = np.random.default_rng(3)
stations = delone.sphere.Delaunay(xyz=random.normal(size=(2500, 3))).lonlat


def wind(lonlat):
    """Return a wind, (..., 2), that circles around a place in Alaska, in m/s."""
    lon, lat = np.radians(lonlat[..., 0]), np.radians(lonlat[..., 1])
    axis = 20 * np.array((-0.35, -0.2, 0.9))
    up = axis[0] * np.cos(lon) + axis[1] * np.sin(lon)
    return np.stack(
        (
            axis[2] * np.cos(lat) - np.sin(lat) * up,
            axis[0] * np.sin(lon) - axis[1] * np.cos(lon),
        ),
        axis=-1,
    )


# %%
# ``vectors_at`` moves the vector of each station along the great circle to the query before it combines them. A
# common mistake is to interpolate the components separately.

made = delone.sphere.Linear(stations, wind(stations))
for latitude in (0, 60, 80, 88, 89.5):
    ring = np.stack(np.broadcast_arrays(np.arange(-180.0, 180), latitude), axis=-1)
    numbers, vectors = (np.abs(found(ring) - wind(ring)).max() for found in (made, made.vectors_at))
    print(f"{latitude:5} degrees north: largest error {numbers:5.2f} m/s, as vectors {vectors:.2f}")
    assert vectors < 0.1

# %%
# In a Dataset, the standard names of the CF conventions identify the components. The grid nodes at the pole all
# have the same vector, expressed in the directions of each meridian.

dataset = xarray.Dataset(
    {
        "u": ("station", wind(stations)[:, 0], {"standard_name": "eastward_wind"}),
        "v": ("station", wind(stations)[:, 1], {"standard_name": "northward_wind"}),
    },
    coords={"lon": ("station", stations[:, 0]), "lat": ("station", stations[:, 1])},
)
lon, lat = np.arange(-180, 180, 15.0), np.array([77.0, 81.0, 85.0, 88.0, 90.0])
field = dataset.delone.interp(lon, lat)
pole = field.sel(lat=90)
print("speed at the pole, from each meridian:", np.unique(np.hypot(pole.u, pole.v).round(6)))
plain = dataset.delone.interp(lon, lat, vectors=[])
assert np.ptp(np.hypot(pole.u, pole.v).values) < 1e-9

# %%
# The view from above the pole. The longitude determines how the arrows to the east and north are rotated on the map.

figure, axes = plt.subplots(1, 2, figsize=(8.4, 4.3), layout="constrained")
turn = np.radians(lon)
for ax, found, title in zip(axes, (plain, field), ("two fields", "vectors"), strict=True):
    away = 90 - lat[:, None]
    x, y = away * np.sin(turn), -away * np.cos(turn)
    u, v = found.u.values, found.v.values
    across = u * np.cos(turn) - v * np.sin(turn)
    up = u * np.sin(turn) + v * np.cos(turn)
    speed = np.hypot(u, v)
    arrows = ax.quiver(
        x, y, across, up, speed, cmap="viridis", scale=160, width=0.005, clim=(0, 12)
    )
    ax.set(title=title, aspect="equal", xticks=[], yticks=[], xlim=(-15, 15), ylim=(-15, 15))
    for distance in (5, 10):
        ax.add_patch(plt.Circle((0, 0), distance, fill=False, color="0.8", lw=0.6))
figure.colorbar(arrows, ax=axes, label="m/s")
plt.show()
