"""
Low-poly picture of an image
============================

Points are placed where an image has detail and triangulated, and each triangle is filled with its mean color: the
low-poly style of posters and icons.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import Delaunay

# %%
# The image is a landscape computed from formulas, so the example needs no file. To use your own image, read it with
# ``plt.imread(path)[..., :3]``.

height, width = 240, 360
y, x = np.mgrid[0:height, 0:width]
sky = np.stack((0.95 - 0.5 * y / height, 0.65 - 0.1 * y / height, 0.45 + 0.4 * y / height), axis=-1)
sun = np.hypot(x - 260, y - 80) < 34
picture = np.where(sun[..., None], (1.0, 0.9, 0.55), sky)
ridges = [(150, 24, 0.020, (0.45, 0.35, 0.50)), (185, 16, 0.045, (0.28, 0.25, 0.40))]
for base, swing, waves, color in [*ridges, (215, 8, 0.110, (0.13, 0.15, 0.25))]:
    ridge = base - swing * (np.sin(waves * x) + 0.6 * np.sin(2.7 * waves * x + 1))
    picture = np.where((y > ridge)[..., None], color, picture)

# %%
# Detail is where colors change. Points are drawn at random, with a probability that increases with the detail. A few
# are drawn anywhere, so that plain areas also have triangles. The corners of the image complete the hull.

change = np.hypot(*np.gradient(picture.mean(axis=2)))
share = (change / change.sum() + 0.25 / change.size).ravel()
random = np.random.default_rng(2)
pixel = random.choice(change.size, 1400, replace=False, p=share / share.sum())
corners = [(0, 0), (width - 1, 0), (width - 1, height - 1), (0, height - 1)]
points = np.concatenate((corners, np.column_stack((pixel % width, pixel // width)))).astype(float)
mesh = Delaunay(points)

# %%
# The color of a triangle is the mean of its pixels: :meth:`~delone.Delaunay.find_simplex` returns the triangle that
# contains each pixel. A triangle without any pixel gets the color at its center.

triangle = mesh.find_simplex(np.column_stack((x.ravel(), y.ravel())))
number = np.bincount(triangle, minlength=mesh.nsimplex)
total = np.stack(
    [np.bincount(triangle, picture[..., c].ravel(), mesh.nsimplex) for c in range(3)], axis=1
)
center = mesh.points[mesh.simplices].mean(axis=1).astype(int)
color = np.where(
    number[:, None] > 0, total / np.maximum(number, 1)[:, None], picture[center[:, 1], center[:, 0]]
)
assert (triangle >= 0).all()

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8), layout="constrained")
left.imshow(picture)
left.set(title="The image", xticks=[], yticks=[])
faces = plt.matplotlib.collections.PolyCollection(mesh.points[mesh.simplices], facecolors=color)
faces.set(edgecolors=color, linewidths=0.4)
right.add_collection(faces)
right.set(title=f"{mesh.nsimplex} triangles", xticks=[], yticks=[], aspect="equal")
right.set(xlim=(0, width - 1), ylim=(height - 1, 0))
plt.show()

# %%
# A common mistake is to draw faces without edges: white lines remain between them, because the renderer smooths each
# border separately. Edges in the color of the face, 0.4 wide, close the gaps. Another mistake is the direction of y:
# rows of an image are counted from the top, so the limits are reversed.
