"""
Cell areas and neighbor counts of a tissue
==========================================

Microscopes show the nuclei of a tissue, but often not the membranes. Voronoi cells around the nuclei, clipped to the
outline of the tissue, approximate the cells: their areas, shapes and numbers of neighbors.

Install: ``pip install "delone[plot,geo]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import shapely

from delone import Voronoi, lloyd

# %%
# Nuclei are not too close to each other, so they are slightly relaxed random points, in an outline in micrometers.

angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
radius = 100 * (1 + 0.12 * np.cos(3 * angle) + 0.05 * np.sin(5 * angle))
outline = shapely.Polygon(np.column_stack((1.4 * radius * np.cos(angle), radius * np.sin(angle))))
random = np.random.default_rng(7).uniform((-170, -130), (170, 130), (900, 2))
inside = shapely.contains_xy(outline, random)
nuclei = lloyd(random[inside], outline, max_iter=4).points
cells = Voronoi(nuclei, clip=outline)
assert np.isclose(cells.cell_areas.sum(), outline.area)

# %%
# Neighbors are cells that share an edge within the outline, stored in compressed rows. Clipping removes neighbors
# of cells at the outline, so the statistics omit these cells.

indptr, indices, lengths = cells.neighbors
count = np.diff(indptr)
whole = ~shapely.intersects(cells.polygons(), outline.boundary)
shape = cells.cell_perimeters / np.sqrt(cells.cell_areas)
print(f"{len(nuclei)} cells, {np.count_nonzero(whole)} of them not at the outline")
print(f"area {cells.cell_areas[whole].mean():.1f} ± {cells.cell_areas[whole].std():.1f} µm²")
print(f"neighbors {count[whole].mean():.2f}, perimeter / sqrt(area) {shape[whole].mean():.2f}")

# %%
# Lewis' law of tissues: cells with more neighbors are larger.

figure, (left, right) = plt.subplots(
    1, 2, figsize=(9, 4), width_ratios=(3, 2), layout="constrained"
)
colors = plt.get_cmap("RdYlBu_r", 5)
cells.plot(left, values=np.where(whole, count, np.nan), cmap=colors, points=False, colorbar=False)
scale = plt.cm.ScalarMappable(plt.Normalize(3.5, 8.5), colors)
figure.colorbar(scale, ax=left, ticks=range(4, 9), label="number of neighbors", shrink=0.8)
left.set(title="Cells at the outline are left out", xlabel="µm", ylabel="µm")
sizes = range(4, 9)
right.boxplot([cells.cell_areas[whole & (count == n)] for n in sizes], tick_labels=sizes)
right.set(title="Lewis' law", xlabel="number of neighbors", ylabel="area in µm²")
plt.show()

# %%
# A common mistake is to forget the outline. Cells at the border then extend far beyond the tissue or are unbounded,
# and their areas distort every mean.

whole_plane = Voronoi(nuclei).cell_areas
print(f"without an outline: {np.count_nonzero(np.isinf(whole_plane))} infinite areas, ", end="")
print(f"the largest finite one is {whole_plane[np.isfinite(whole_plane)].max():,.0f} µm²")
