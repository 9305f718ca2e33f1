"""
A cubed-sphere model on cells of 1 degree
=========================================

The fields of a model on a cubed sphere are regridded to longitudes and latitudes in three ways: by areas, to first and
second order, which preserves totals, and by bilinear interpolation between the centers of the cells.

Install: ``pip install "delone[plot,xarray]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray

import delone.xarray
from delone import datasets

# %%
# GEOS writes the corners of the cells of six faces. Here each face has 24 x 24 cells, at equal angles.

a = np.tan(np.linspace(-np.pi / 4, np.pi / 4, 25))
u, v = np.meshgrid(a, a)
one = np.ones_like(u)
faces = [(one, u, v), (-u, one, v), (-one, -u, v), (u, -one, v), (-v, u, one), (v, u, -one)]
x, y, z = np.moveaxis(np.array(faces), 1, 0)
lon, lat = np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
model = xarray.Dataset(
    {"corner_lons": (("nf", "yc", "xc"), lon), "corner_lats": (("nf", "yc", "xc"), lat)}
)


# %%
# A vortex has steep gradients, so the methods differ. Values are those at the centers.


def vortex(centers: np.ndarray) -> np.ndarray:
    """The vortex by Nair and Jablonowski (2008) around a point at 45 degrees north, and a belt."""
    east, north = np.radians(centers.T)
    pole = np.radians((-120, 45))
    turned = np.arctan2(
        np.cos(north) * np.sin(east - pole[0]),
        np.cos(north) * np.sin(pole[1]) * np.cos(east - pole[0]) - np.cos(pole[1]) * np.sin(north),
    )
    height = np.sin(north) * np.sin(pole[1]) + np.cos(north) * np.cos(pole[1]) * np.cos(
        east - pole[0]
    )
    r = 3 * np.sqrt(np.maximum(1 - height**2, 1e-30))
    speed = 1.5 * np.sqrt(3) / np.cosh(r) ** 2 * np.tanh(r)
    return 1 - np.tanh(r / 5 * np.sin(turned - 6 * speed / r)) + np.cos(north) ** 4


grid = delone.xarray.Regridder(model, "1x1").source
print(grid)
model["tracer"] = (("nf", "y", "x"), vortex(grid.centers_lonlat).reshape(6, 24, 24))

# %%
# The three methods. The first two preserve totals.

options = {
    "first order": {"method": "conservative"},
    "second order": {"method": "conservative", "order": 2},
    "bilinear": {"method": "bilinear"},
}
found, errors = {}, {}
before = (model.tracer.values.ravel() * grid.areas).sum()
for name, chosen in options.items():
    regridder = delone.xarray.Regridder(model, "1x1", dims=("nf", "y", "x"), **chosen)
    found[name] = regridder(model.tracer)
    wanted = vortex(regridder.target.centers_lonlat)
    areas = regridder.target.areas
    away = found[name].values.ravel() - wanted
    errors[name] = np.sqrt((away**2 * areas).sum() / (wanted**2 * areas).sum())
    after = (found[name].values.ravel() * areas).sum()
    print(f"{name:12}  error {errors[name]:.4f}, change of the total {after / before - 1:+.0e}")
assert errors["second order"] < errors["first order"]

# %%
# The model's cells, and the three results around the vortex.

figure, axes = plt.subplots(2, 2, figsize=(10, 6.4), layout="constrained")
window = (-180, 5, -60, 85)
shown = {"on the cubed sphere": (grid, model.tracer.values)} | {
    name: (regridder.target, values.values) for name, values in found.items()
}
for ax, (name, (cells, values)) in zip(axes.flat, shown.items(), strict=True):
    cells.plot(ax, values=values, bounds=window, sides=False, coast=datasets.land(), title=name)
plt.show()
