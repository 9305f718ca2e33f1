"""
Height bands with fewer points
==============================

The areas between the contours of a rough surface, once with all points of their borders and once with a tenth of them. Adjacent
polygons still share their borders, so they neither overlap nor leave gaps.

Install: ``pip install "delone[plot,geo]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
import shapely

from delone.terrain import TIN

# %%
# Two hills, measured at random points with an error of up to 0.5 m. The border of a band has a point on each triangle edge that
# it crosses.

random = np.random.default_rng(8)
xy = random.random((12_000, 2)) * 200
x, y = xy.T
hills = 20 * np.exp(-((x - 80) ** 2 + (y - 110) ** 2) / 2400)
hills += 12 * np.exp(-((x - 150) ** 2 + (y - 50) ** 2) / 800)
tin = TIN.from_points(np.column_stack((xy, hills + 0.5 * random.random(len(xy)))))

# %%
# ``min_area`` merges small polygons into those around them. ``simplify`` leaves out points that are within a given distance of
# the simplified border, here 1.5 m.

every = tin.bands(interval=2, min_area=20)
few = tin.bands(interval=2, min_area=20, simplify=1.5)
for bands in (every, few):
    print(bands, f"with {len(np.unique(bands.points, axis=0))} points")

# %%
# A common mistake is to simplify each polygon by itself. Neighbors then get different borders and overlap.


def overlap(polygons):
    """Return by how much the areas of polygons exceed the area that they cover."""
    return shapely.area(polygons).sum() - shapely.union_all(polygons).area


together = few.to_shapely()
alone = shapely.simplify(every.to_shapely(), 1.5)
print(f"simplified together, they overlap by {abs(overlap(together)):.1f} m²")
print(f"each simplified by itself, they overlap by {overlap(alone):.1f} m²")
assert shapely.is_valid(together).all()
assert abs(overlap(together)) < 1e-6 < overlap(alone)

# %%
# Part of both maps, with borders in black. On the outline of the surface, all points stay.

figure, axes = plt.subplots(1, 2, figsize=(10.5, 4.8), layout="constrained", sharey=True)
for ax, bands, title in zip(axes, (every, few), ("All points", "simplify=1.5"), strict=True):
    bands.plot(ax, cmap="terrain", color="black", linewidth=0.7, colorbar=ax is axes[1])
    ax.set(title=title, xlabel="m", xlim=(100, 200), ylim=(0, 100))
axes[0].set(ylabel="m")
plt.show()
