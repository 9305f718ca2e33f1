"""
Roads that cross: split at crossings and find the shortest path
===============================================================

Lines that were drawn without vertices at their crossings become a network: ``crossing="split"`` adds a vertex at each
crossing, and the report lists them. SciPy finds the shortest path along the edges.

Install: ``pip install "delone[plot]" scipy``.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

import delone

# %%
# Forty straight roads, each with its two ends, in meters.

random = np.random.default_rng(12)
start = random.uniform(0, 1000, (40, 2))
heading = random.choice([0.2, 1.8], 40) + random.normal(0, 0.15, 40)
length = random.uniform(250, 800, 40)
end = start + length[:, None] * np.column_stack((np.cos(heading), np.sin(heading)))
points = np.vstack((start, end))
roads = np.column_stack((np.arange(40), np.arange(40, 80)))

# %%
# By default, segments that cross raise an error that lists all crossings, not only the first.

try:
    delone.ConstrainedDelaunay(points, roads)
except delone.CrossingSegmentsError as error:
    print(f"{len(error.pairs)} crossings, the first of roads {error.pairs[0]} at {error.points[0]}")

mesh = delone.ConstrainedDelaunay(points, roads, crossing="split")
crossings = mesh.report.crossings
assert len(crossings) == len(np.unique(crossings[:, :2], axis=0))
print(f"{len(roads)} roads, {len(mesh.segments)} pieces, {mesh.npoints - len(points)} new vertices")

# %%
# Each row of ``report.crossings`` has two roads and their common vertex, and ``segment_source`` has the road of each
# piece. The pieces are the edges of a graph.

pieces = mesh.segments
meters = np.linalg.norm(np.subtract(*mesh.points[pieces].swapaxes(0, 1)), axis=1)
graph = coo_matrix((meters, pieces.T), shape=(mesh.npoints,) * 2).tocsr()
first, rows = mesh.segment_source
road = rows[first[:-1]]
busiest = np.bincount(crossings[:, :2].ravel()).argmax()
print(f"road {busiest} has {np.sum(road == busiest)} pieces")

# %%
# The shortest path between the two vertices of the largest connected component that are farthest apart by road.

_, part = connected_components(graph, directed=False)
inside = np.flatnonzero(part == np.bincount(part).argmax())
distance, before = dijkstra(graph, directed=False, indices=inside, return_predecessors=True)
row, goal = np.unravel_index(np.where(np.isinf(distance), -1, distance).argmax(), distance.shape)
path = [goal]
while path[-1] != inside[row]:
    path.append(before[row, path[-1]])
print(f"{distance[row, goal]:,.0f} m by road over {len(path) - 2} crossings and ends")

# %%
# A common mistake is a road that ends just short of the road that it should join. A gap of one millimeter is enough:
# there is no crossing, and no path. To find such places, compute the distances from the ends of roads to the other
# roads. Bridges are the opposite case: their lines cross, but there is no junction; triangulate them separately.

short = [(0, 0), (10, 0), (5, 3), (5, 0.001)], [(0, 1), (2, 3)]
assert len(delone.ConstrainedDelaunay(*short, crossing="split").segments) == 2
touching = [(0, 0), (10, 0), (5, 3), (5, 0)], [(0, 1), (2, 3)]
assert len(delone.ConstrainedDelaunay(*touching).segments) == 3

# %%
# The network: crossings as dots, the path in red.

figure, ax = plt.subplots(figsize=(7, 6), layout="constrained")
ax.plot(*mesh.points[pieces].transpose(2, 1, 0), color="0.55", linewidth=1.2)
ax.plot(*mesh.points[crossings[:, 2]].T, "o", color="black", markersize=3, label="crossings")
ax.plot(*mesh.points[path].T, color="crimson", linewidth=3, label="longest shortest path")
ax.set(aspect="equal", xlabel="m", ylabel="m", title="Roads, split where they cross")
ax.legend(loc="upper left")
plt.show()
