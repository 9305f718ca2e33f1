"""
Mesh sizes by distance: fine near a hole and a slit
===================================================

A plate with a round hole and a slit is meshed with small triangles at both and large ones far away. Sizes can also be any
other function of position, a raster or a field of another mesh. A histogram of the angles shows the quality.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone

# %%
# The plate as GeoJSON: an outer ring, then holes. Closing a ring is optional, and its direction has no effect.

angle = np.linspace(0, 2 * np.pi, 64, endpoint=False)
hole = np.column_stack((2 + 0.5 * np.cos(angle), 1.5 + 0.5 * np.sin(angle)))
plate = {
    "type": "Polygon",
    "coordinates": [[(0, 0), (6, 0), (6, 3), (0, 3)], hole.tolist()],
}
slit = {"type": "LineString", "coordinates": [(4.2, 0.8), (5.0, 2.2)]}


# The edge length is 0.04 at the hole and the slit, and grows by a quarter of the distance from them.
ring = {"type": "LineString", "coordinates": [*hole.tolist(), hole[0].tolist()]}
size = delone.SizeByDistance([ring, slit], near=0.04, growth=0.25)
print(size)

uniform = delone.mesh([plate, slit], size=0.04)
graded = delone.mesh([plate, slit], size=size)
print(f"{uniform.nsimplex:,} triangles of one size, {graded.nsimplex:,} of growing size")
print(graded.report)

# %%
# Points can be moved to better positions: smoothing increases typical angles, and the bound of 30 degrees still
# holds.

smooth = graded.smooth(10, "odt")
for name, mesh in (("refined", graded), ("smoothed", smooth)):
    quality = mesh.quality()
    print(
        f"{name}: smallest angle {quality.smallest_angle.min():.1f}, "
        f"median {np.median(quality.smallest_angle):.1f} degrees"
    )

# %%
# Coarsening removes points where the bound on angles allows it, here in the right half. A single call never removes two
# neighbors; repeat it to remove more.

coarse = uniform
for _ in range(5):
    coarse = coarse.coarsen(coarse.points[coarse.simplices, 0].mean(axis=1) > 3)
print(f"coarser: {uniform.nsimplex:,} to {coarse.nsimplex:,} triangles")

# %%
# A common mistake is a size in the wrong unit, for example millimeters for a plate in meters. It raises an error
# before the mesh is computed.

try:
    delone.mesh([plate, slit], size=lambda points: size(points) / 1000)
except delone.BudgetExceededError as error:
    print(error)

# %%
# The mesh, and the angles before and after smoothing.

figure, axes = plt.subplot_mosaic(
    [["mesh", "mesh"], ["before", "after"]],
    figsize=(8, 7.5),
    height_ratios=[1.5, 1],
    layout="constrained",
)
smooth.plot(
    axes["mesh"],
    vertices=False,
    title=f"{smooth.nsimplex:,} triangles, finer at the hole and the slit",
)
graded.plot_quality(axes["before"]).set(title="Angles, refined")
smooth.plot_quality(axes["after"]).set(title="Angles, smoothed")
plt.show()
