"""
Regrid station data with xarray, with missing values
====================================================

A Dataset of stations becomes a Dataset on a grid, with all variables, days and attributes. On days when a station is
missing, there is a hole around it, unless a triangulation of the other stations fills the gap.

Install: ``pip install "delone[plot,xarray]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray

import delone.xarray
from delone.datasets import uniform
from delone.interpolate import grid

random = np.random.default_rng(9)
east, north = (400 * uniform(120, seed=14)).T
days = np.datetime64("2026-01-01") + np.arange(30)
phase = np.arange(30)[:, None] / 4
wave = np.sin(east / 90 + phase) + np.cos(north / 110 - phase)
stations = xarray.Dataset(
    {
        "temperature": (("time", "station"), 9 + 3 * wave, {"units": "degC"}),
        "wind": (("time", "station"), 7 + 2 * np.roll(wave, 3, axis=0), {"units": "m s-1"}),
        "country": ("time", np.full(30, "NL")),
    },
    coords={"time": days, "x": ("station", east), "y": ("station", north)},
)
gone = random.random(stations.temperature.shape) < 0.03
stations["temperature"] = stations.temperature.where(~gone)
print(f"{int(gone.sum())} of {gone.size} temperatures are missing")

# %%
# One call is enough. The triangulation and the weights are computed once for all days and variables. NaN propagates to
# the grid nodes that the station contributes to.

field = stations.delone.grid(resolution=5.0, method="sibson")
print(field.temperature.dims, field.temperature.attrs, list(field.data_vars))
holes = field.temperature.isnull().mean(("y", "x")) - field.wind.isnull().mean(("y", "x"))
print(f"on the worst day the gaps cover {float(holes.max()):.0%} of the map")

# %%
# To fill the gaps, triangulate the stations of that day: ``nan="drop"``. The accessor does not do this,
# because the triangles then differ from day to day. A common mistake is to ask it to:

day = int(holes.values.argmax())
try:
    stations.delone.grid(resolution=5.0, nan="drop")
except delone.InputError as error:
    print(error)

points = np.column_stack((east, north))

filled = grid(
    points, stations.temperature.values[day], x=field.x, y=field.y, method="sibson", nan="drop"
)

# %%
# A day with holes, the same day filled, and one location over time.

figure, axes = plt.subplots(1, 3, figsize=(11.4, 3.6), layout="constrained")
known = stations.temperature[day].notnull()
for ax, values, title in zip(
    axes, (field.temperature[day].values, filled.values), ("propagate", "drop"), strict=False
):
    image = ax.pcolormesh(
        field.x, field.y, values, vmin=3, vmax=15, cmap="RdYlBu_r", rasterized=True
    )
    ax.plot(east[known], north[known], ".", color="black", ms=2)
    ax.plot(east[~known], north[~known], "x", color="black", ms=6)
    ax.set(title=f'nan="{title}"', aspect="equal", xlabel="km", facecolor="0.9")
figure.colorbar(image, ax=axes[:2], label="temperature in C")
here = stations.delone.interp(
    xarray.DataArray([200.0], dims="place"), xarray.DataArray([150.0], dims="place")
)
here.temperature.isel(place=0).plot(ax=axes[2], marker=".", label="temperature in C")
here.wind.isel(place=0).plot(ax=axes[2], marker=".", label="wind in m/s")
axes[2].set(title="At x = 200 km, y = 150 km", xlabel="", ylabel="")
axes[2].tick_params(axis="x", rotation=30)
axes[2].legend()
plt.show()
