"""
An unstructured ocean with land
===============================

Ocean models on triangles, such as FESOM, have values at nodes and no nodes on land. Each node represents the
cell around it, so the cells end at the coasts, and the fraction of each target cell that is sea is known.

Install: ``pip install "delone[plot,xarray]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import xarray

import delone.xarray
from delone import datasets, sphere

# %%
# A mesh for this example: triangles between 6,000 directions, without those whose center is on land.

count = 6000
k = np.arange(count)
z = 1 - (2 * k + 1) / count
turn = np.pi * (1 + 5**0.5) * k
sites = np.column_stack((np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z))
everywhere = sphere.Delaunay(xyz=sites)
coast = sphere.from_geometry(datasets.land())
middles = everywhere.points[everywhere.simplices].mean(axis=1)
at_sea = coast.polygon_of_simplex[coast.find_simplex(middles)] < 0
nodes, triangles = np.unique(everywhere.simplices[at_sea], return_inverse=True)
triangles = triangles.reshape(-1, 3)
lon, lat = everywhere.lonlat[nodes].T
print(f"{len(nodes):,} nodes, {len(triangles):,} triangles")

# %%
# The file of the model follows the UGRID conventions; its temperatures are at nodes.

ocean = xarray.Dataset(
    {
        "mesh": ((), 0, {"cf_role": "mesh_topology", "topology_dimension": 2, "node_coordinates": "lon lat",
                         "face_node_connectivity": "triangles"}),
        "triangles": (("face", "three"), triangles, {"start_index": 0}),
        "sst": (("time", "node"), np.stack([28 * np.cos(np.radians(lat)) ** 2 - 1 + season * lat / 30
                                            for season in (-1, 1)]).astype(np.float32),
                {"units": "degC", "mesh": "mesh", "location": "node"}),
    },
    coords={
        "lon": ("node", lon, {"units": "degrees_east"}),
        "lat": ("node", lat, {"units": "degrees_north"}),
    },
)  # fmt: skip

# %%
# ``cells="nodes"`` uses the cells around nodes. Target cells of 2 degrees of which less than half is sea are missing.

regridder = delone.xarray.Regridder(ocean, "2x2", method="normalized", cells="nodes")
print(regridder)
found = regridder(ocean, min_fraction=0.5)
print(found.sst.dims, found.sst.dtype)
assert found.sst.shape == (2, 90, 180)

# %%
# The result of "conservative" has the same total as the model's cells.

flux = delone.xarray.Regridder(ocean, "2x2", method="conservative", cells="nodes")
before = (ocean.sst.values[0].astype(float) * flux.source.areas).sum()
after = np.nansum(flux(ocean).sst.values[0].ravel().astype(float) * flux.target.areas)
print(f"totals: {before:.6f}, {after:.6f}")
assert np.isclose(before, after, rtol=1e-6)

# %%
# The model's cells, the sea surface temperature on cells of 2 degrees, and the fraction of each cell that is sea.

land = datasets.land()
figure, axes = plt.subplots(3, 1, figsize=(7.5, 11), layout="constrained")
window = (-100, 0, 20, 60)
regridder.source.plot(axes[0], values=ocean.sst.values[0], coast=land, bounds=window, sides=True,
                      title="Cells around the nodes of the model, °C")  # fmt: skip
regridder.target.plot(axes[1], values=found.sst.values[0], sides=False, coast=land,
                      title="On cells of 2 degrees, °C")  # fmt: skip
for ax in axes[:2]:
    # Both maps have the same colors.
    ax.images[0].set_clim(-4, 28)
regridder.target.plot(axes[2], values=regridder.weights.fractions, sides=False, coast=land,
                      title="Fraction of each cell that the model covers", cmap="cividis")  # fmt: skip
plt.show()
