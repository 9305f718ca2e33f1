"""
An island with a lake and a road
================================

The coast is a fractal ring of more than a thousand segments, rough enough to cross itself. A lake is a hole, a road
crosses the island, and the land north and south of it are two regions. In a *conforming* triangulation, vertices
are added until every segment is a Delaunay edge.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay, from_geometry, triangulate_polygon
from delone.testing import same_triangles


def fractal(corners, levels, seed):
    """Repeatedly split each side of a ring in the middle, and move the new corner sideways."""
    random = np.random.default_rng(seed)
    ring = np.array(corners, dtype=float)
    for _ in range(levels):
        step = np.roll(ring, -1, axis=0) - ring
        aside = step[:, ::-1] * (-1, 1) * random.uniform(-0.35, 0.35, (len(ring), 1))
        ring = np.stack((ring, ring + step / 2 + aside), axis=1).reshape(-1, 2)
    return ring


coast = fractal([(0, 0), (9, -1), (12, 5), (4, 8), (-1, 5)], levels=8, seed=7)
lake = [(4.0, 3.0), (6.0, 3.0), (6.0, 4.0), (4.0, 4.0)]
land = {"type": "Polygon", "coordinates": [coast.tolist(), lake]}
road = {"type": "LineString", "coordinates": [(-3, 2), (5, 1.5), (15, 2.5)]}

# %%
# :func:`~delone.from_geometry` accepts GeoJSON, shapely and GeoPandas objects. ``boundary="polygons"`` removes the
# triangles outside the coast and inside the lake. Each seed of ``regions`` names the region that contains it.

mesh = from_geometry(
    [land, road], boundary="polygons", regions=[(5, 5, 1), (5, 1, 2)], conforming=True
)
assert mesh.validate()
print(f"{len(mesh.input_segments):,} segments, {len(mesh.report.crossings)} crossings")
print(f"{mesh.nadded:,} vertices added, {mesh.nsimplex:,} triangles")

# %%
# The regions, and the segments as lines.

figure, ax = plt.subplots(figsize=(7, 5), layout="constrained")
mesh.plot(ax)
ax.set(title="North and south of a road, without the lake")
plt.show()

# %%
# Two checks: without a boundary, the triangles are those of the vertices alone, and the areas agree with
# :func:`~delone.triangulate_polygon`, which triangulates without adding points.

whole = from_geometry([land, road], conforming=True)
assert same_triangles(whole.simplices, Delaunay(whole.points).simplices)

points, simplices = triangulate_polygon(land)
u, v = points[simplices[:, 1:]].swapaxes(0, 1) - points[simplices[:, 0]]
area = np.sum(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
north = mesh.areas[mesh.region == 1].sum()
print(f"area {area:.4f}, of which {north:.4f} is north of the road")
assert np.isclose(area, mesh.areas.sum())
