"""
Tetrahedra in a cloud of points
===============================

Points in 3-D are triangulated with tetrahedra, as exact and canonical as triangles in 2-D. The boundary of the
result is the convex hull.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone

random = np.random.default_rng(4)
directions = random.normal(size=(1500, 3))
directions /= np.linalg.norm(directions, axis=1)[:, None]
cloud = directions * random.uniform(0.5, 1, (1500, 1)) ** (1 / 3) * (2.0, 1.4, 1.0)
solid = delone.Delaunay(cloud)
print(solid)
assert solid.validate()

# %%
# The volumes of the tetrahedra add up to that of the hull.

hull = delone.ConvexHull(cloud)
print(f"{solid.volumes.sum():.6f} = {hull.volume:.6f}, {len(hull.vertices)} vertices on the hull")
assert np.isclose(solid.volumes.sum(), hull.volume)

# %%
# The hull as a surface, colored by height.

figure, ax = plt.subplots(figsize=(7, 5), subplot_kw={"projection": "3d"})
ax.plot_trisurf(
    *cloud.T, triangles=hull.simplices, cmap="viridis", edgecolor="white", linewidth=0.2
)
ax.set(title="Convex hull of 1,500 points", box_aspect=(2.0, 1.4, 1.0))
plt.show()
