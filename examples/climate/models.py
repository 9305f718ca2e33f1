"""
Regrid a model on an unstructured mesh with xarray
==================================================

One call regrids a dataset on a UGRID mesh to cells of 3 degrees. It contains sea ice, so the missing values change
from month to month, but the weights stay the same.

Install: ``pip install "delone[plot,xarray]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray

import delone.xarray
from delone import datasets, sphere

# %%
# Like an MPAS mesh, this mesh consists of the cells of a Voronoi diagram, here of 2,500 sites. This is how a UGRID
# file describes it: longitudes and latitudes of nodes, and the nodes of each face, padded with -1.

k = np.arange(2500)
z = 1 - (2 * k + 1) / 2500
turn = np.pi * (1 + 5**0.5) * k
sites = np.column_stack((np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z))
diagram = sphere.Voronoi(xyz=sites)
starts, nodes = diagram.region_rows
faces = np.full((2500, int(np.diff(starts).max())), -1)
for row, cell in enumerate(diagram.point_region):
    own = nodes[starts[cell] : starts[cell + 1]]
    faces[row, : len(own)] = own
x, y, up = diagram.vertices.T
ocean = xarray.Dataset(
    {
        "mesh": ((), 0, {"cf_role": "mesh_topology", "topology_dimension": 2, "node_coordinates": "nx ny",
                         "face_node_connectivity": "faces"}),
        "nx": ("node", np.degrees(np.arctan2(y, x)), {"units": "degrees_east"}),
        "ny": ("node", np.degrees(np.arctan2(up, np.hypot(x, y))), {"units": "degrees_north"}),
        "faces": (("face", "most"), faces, {"start_index": 0}),
    }
)  # fmt: skip

# %%
# The thickness of sea ice in twelve months, missing on land and where there is no ice, as float32.

lat = np.degrees(np.arcsin(sites[:, 2]))
coast = sphere.from_geometry(datasets.land())
on_land = coast.polygon_of_simplex[coast.find_simplex(sites)] >= 0
month = np.arange(12)[:, None]
edge = 66 - 8 * np.cos(2 * np.pi * (month - 2) / 12) * np.sign(lat)
thick = np.where((np.abs(lat) > edge) & ~on_land, (np.abs(lat) - edge) / 8, np.nan)
ocean["ice"] = (
    ("month", "face"),
    thick.astype(np.float32),
    {"units": "m", "mesh": "mesh", "location": "face"},
)

# %%
# "normalized" is the mean over the part of a cell that has ice. Cells with ice on less than half of their area are
# missing.

found = ocean.delone.regrid("3x3", method="normalized", skipna=True, min_fraction=0.5)
print(found.ice.dims, found.ice.dtype, found.ice.attrs)
assert found.ice.shape == (12, 60, 120)

# %%
# "conservative" keeps the volume of ice in each month.

regridder = delone.xarray.Regridder(ocean, "3x3", method="conservative")
kept = regridder(ocean, skipna=True).ice
before = np.nansum(thick.astype(np.float32) * regridder.source.areas, axis=1, dtype=float)
after = np.nansum(kept.values.reshape(12, -1) * regridder.target.areas, axis=1, dtype=float)
print("largest change of a volume:", f"{abs(after / before - 1).max():.0e}")
assert np.allclose(before, after, rtol=1e-6)

# %%
# Maps of the mesh and of the result in March and September. White cells are land or open water.

figure, axes = plt.subplots(2, 2, figsize=(12, 6.4), layout="constrained")
land = datasets.land()
for column, (name, row) in enumerate((("March", 2), ("September", 8))):
    regridder.source.plot(
        axes[0, column],
        values=thick[row],
        coast=land,
        title=f"Thickness of ice in {name} on the mesh, m",
    )
    regridder.target.plot(
        axes[1, column],
        values=found.ice.values[row],
        sides=False,
        coast=land,
        title=f"{name}, on cells of 3 degrees, m",
    )
for ax in axes.flat:
    # All maps have the same colors.
    ax.images[0].set_clim(0, 4)
plt.show()
