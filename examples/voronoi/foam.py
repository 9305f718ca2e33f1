"""
Power diagram of bubbles or grains of different sizes
=====================================================

Bubbles of a foam, grains of a metal and atoms of an alloy have different radii. A power diagram, also called Laguerre
or radical tessellation, uses the squared radii as weights: no cell border then cuts a disk.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection
from matplotlib.patches import Circle

from delone import Voronoi

# %%
# Disks of random sizes, placed one after another without overlaps, the largest first.

random = np.random.default_rng(3)
radii = np.sort(random.lognormal(np.log(0.018), 0.5, 330).clip(0.008, 0.09))[::-1]
centers = np.empty((0, 2))
for radius in radii:
    tries = random.uniform(radius, 1 - radius, (5000, 2))
    gaps = np.linalg.norm(tries[:, None] - centers, axis=2) - radii[: len(centers)]
    free = (gaps > radius).all(axis=1)
    centers = np.vstack((centers, tries[np.argmax(free)]))
    assert free.any()

# %%
# The cells with and without weights, in the unit square.

box = (0, 0, 1, 1)
plain = Voronoi(centers, clip=box)
power = Voronoi(centers, weights=radii**2, clip=box)
fill = np.pi * radii**2


def cut(diagram):
    """Return which disks are cut by a border between cells: those closer to it than their radius."""
    first, second = diagram.ridge_points.T
    apart = centers[second] - centers[first]
    distance = np.linalg.norm(apart, axis=1)
    weights = np.zeros(len(radii)) if diagram.weights is None else diagram.weights
    from_first = (distance**2 + weights[first] - weights[second]) / (2 * distance)
    found = np.zeros(len(radii), bool)
    found[first[from_first < radii[first]]] = True
    found[second[distance - from_first < radii[second]]] = True
    return found


for name, diagram in (("Voronoi", plain), ("power", power)):
    print(f"{name}: {np.count_nonzero(cut(diagram))} of {len(radii)} disks are cut", end=", ")
    print(f"correlation of cell and disk area {np.corrcoef(diagram.cell_areas, fill)[0, 1]:.3f}")
assert not cut(power).any()

# %%
# Disks that are cut by a border are red.

figure, axes = plt.subplots(1, 2, figsize=(9, 4.8), layout="constrained")
for ax, diagram, title in zip(axes, (plain, power), ("Voronoi", "Power diagram"), strict=True):
    diagram.plot(ax, points=False)
    wrong = cut(diagram)
    for rows, color in ((~wrong, "tab:blue"), (wrong, "tab:red")):
        disks = [Circle(*disk) for disk in zip(centers[rows], radii[rows], strict=True)]
        ax.add_collection(PatchCollection(disks, facecolor=color, alpha=0.6))
    ax.set(title=f"{title}: {np.count_nonzero(wrong)} disks cut", xticks=[], yticks=[])
plt.show()

# %%
# A common mistake is to pass radii instead of squared radii. Weights are in squared units of the points. If they are
# too large, small disks lose their cells: they are *hidden*.

mistaken = Voronoi(centers, weights=radii, clip=box)
print(f"with radii as weights, {len(mistaken.hidden)} of {len(radii)} disks have no cell")
