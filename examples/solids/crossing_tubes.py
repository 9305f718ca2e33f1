"""
Faces that cross
================

Two closed tubes that intersect do not bound a solid: :func:`delone.check_surface` finds every pair of faces that
cross, exactly.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import delone


def tube(radius, length, sides=36, rings=24):
    """Return a closed tube along the x-axis, with outward normals."""
    turn = 2 * np.pi * np.arange(sides) / sides
    circle = radius * np.column_stack((np.cos(turn), np.sin(turn)))
    along = np.linspace(-length / 2, length / 2, rings)
    wall = np.column_stack((np.repeat(along, sides), np.tile(circle, (rings, 1))))
    points = np.concatenate((wall, [(along[0], 0, 0), (along[-1], 0, 0)]))
    i, j = np.divmod(np.arange((rings - 1) * sides), sides)
    a, b = i * sides + j, i * sides + (j + 1) % sides
    faces = [np.stack((a, b, a + sides), 1), np.stack((b, b + sides, a + sides), 1)]
    rim, end = np.arange(sides), len(wall)
    faces.append(np.stack((rim, np.full(sides, end), np.roll(rim, -1)), 1))
    last = rim + (rings - 1) * sides
    faces.append(np.stack((last, np.roll(last, -1), np.full(sides, end + 1)), 1))
    return points, np.concatenate(faces)


points, faces = tube(1.0, 5.0)
alone = delone.check_surface(points, faces)
print(alone)
assert alone
assert alone.volume > 0

# %%
# A second tube crosses it. The result is falsy, and ``pairs`` contains the rows of the faces.

across = points[:, [1, 0, 2]] * (0.7, 1.0, -0.7) + (0.3, 0.0, 0.4)
both = np.concatenate((points, across))
rows = np.concatenate((faces, faces + len(points)))
check = delone.check_surface(both, rows)
print(check)
assert not check
assert check.ncrossing == len(check.pairs)
assert check.ncomponents == 2

# %%
# The faces that cross, in red. They show where the surface must be cut to repair it.

crossing = np.zeros(len(rows), dtype=bool)
crossing[check.pairs.ravel()] = True
figure, ax = plt.subplots(figsize=(7, 5.5), subplot_kw={"projection": "3d"})
ax.add_collection3d(
    Poly3DCollection(
        both[rows],
        facecolors=np.where(crossing, "#cb181d", "#c6dbef"),
        edgecolors="#4a6984",
        linewidths=0.2,
    )
)
ax.set(xlim=(-2.5, 2.5), ylim=(-2.5, 2.5), zlim=(-1.6, 1.6), box_aspect=(5, 5, 3.2))
ax.set(title=f"{check.ncrossing} pairs of faces that cross")
plt.show()
