"""
Triangulate mixtures: compositions whose fractions add up to one
================================================================

Mixtures of four parts, such as minerals, alloys or solvents, have four fractions that add up to one. The points have
four coordinates but lie in a flat with three dimensions, so no five of them are the corners of a simplex in 4-D.
``flat="project"`` triangulates them in the flat, where distances treat all four parts alike.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

import delone
from delone import ConvexHull, Delaunay

rng = np.random.default_rng(4)
names = "A", "B", "C", "D"
# Samples in whole percentages, as in published tables. The largest remainders are rounded up, so that each row adds up to
# 100.
measured = 100 * rng.dirichlet(np.full(4, 0.8), 90)
percent = np.floor(measured)
for row, rest in zip(percent, measured - percent, strict=True):
    row[np.argsort(rest)[4 - round(100 - row.sum()) :]] += 1
percent = np.unique(np.vstack((100 * np.eye(4), percent)), axis=0)
assert (percent.sum(axis=1) == 100).all()

# %%
# Without this argument, an error says which dimension the flat has, and what to do.

try:
    Delaunay(percent)
except delone.DegenerateInputError as error:
    print(error)

mesh = Delaunay(percent, flat="project")
hull = ConvexHull(percent, flat="project")
print(mesh, hull, sep="\n")
# The tetrahedra fill the hull, which contains all possible mixtures.
assert np.isclose(mesh.volumes.sum(), hull.volume)
assert len(hull.vertices) == 4

# %%
# Pass whole percentages, or other integers with the same sum in each row. Fractions are rounded: 0.06, 0.57 and 0.37
# add up to 0.9999999999999999. Such points are not exactly in one flat, and are triangulated in 4-D, with thin simplices.

fractions = percent / 100
off = (fractions.sum(axis=1) != 1).sum()
print(f"sums other than 1: {off} of {len(fractions)}")
print(Delaunay(fractions))

# %%
# You can also leave out a column, but this changes distances, because one part no longer counts. Which samples are
# neighbors then depends on the column.


def pairs(mesh):
    """Return the edges as a set."""
    return set(map(tuple, np.sort(mesh.edges, axis=1).tolist()))


own = pairs(mesh)
for k, name in enumerate(names):
    other = pairs(Delaunay(np.delete(percent, k, axis=1)))
    print(f"without {name}: {len(other - own)} of {len(other)} edges are different")

# %%
# Which samples make a given composition, and which properties will the mixture have? The barycentric coordinates are the
# proportions in which to mix the samples at the corners of the tetrahedron. They also interpolate the melting point.

melting = 900 + 3 * percent @ [1, 2, 4, 3] - 0.11 * percent[:, 0] * percent[:, 3]
sought = np.array([35, 25, 15, 25])
place = mesh.locate(sought)
corners = mesh.simplices[place.simplex]
for share, row in zip(place.barycentric, percent[corners], strict=True):
    print(f"{share:.2f} of", " ".join(f"{x:.0f}{n}" for x, n in zip(row, names, strict=True)))
assert np.allclose(place.barycentric @ percent[corners], sought)
print(f"{place.barycentric @ melting[corners]:.0f} degrees")

# %%
# Compositions are points in a tetrahedron with one part at each corner. Lines connect samples that are neighbors. The
# figure on the right shows the interpolated melting points of mixtures with 10 % of D.

corner = np.array([[0, 0, 0], [1, 0, 0], [0.5, 0.75**0.5, 0], [0.5, 0.75**0.5 / 3, (2 / 3) ** 0.5]])
at = percent / 100 @ corner
figure = plt.figure(figsize=(9.4, 4.2), layout="constrained")
axes = figure.add_subplot(1, 2, 1, projection="3d")
for edge in mesh.edges:
    axes.plot(*at[edge].T, color="tab:blue", linewidth=0.4, alpha=0.5)
colors = axes.scatter(*at.T, c=melting, s=22, depthshade=False)
for name, p in zip(names, corner, strict=True):
    axes.text(*(p + 0.12 * (p - corner.mean(axis=0))), name, fontsize=12, ha="center")
axes.set_axis_off()
axes.set_box_aspect((1, 0.9, 0.85), zoom=1.25)
axes.view_init(18, -38)
_ = axes.set_title("Samples and their neighbors")

y, x = np.mgrid[0:0.87:260j, 0:1:300j]
c = y / corner[2, 1]
b = x - c / 2
mixture = np.stack((90 * (1 - b - c), 90 * b, 90 * c, np.full_like(b, 10)), axis=-1)
place = mesh.locate(mixture)
value = (place.barycentric * melting[mesh.simplices[place.simplex]]).sum(axis=-1)
value[place.simplex < 0] = np.nan
beside = figure.add_subplot(1, 2, 2)
beside.imshow(value, origin="lower", extent=(0, 1, 0, 0.87), norm=colors.norm)
for name, p, turn in zip("ABC", corner, ((-0.04, -0.02), (0.04, -0.02), (0, 0.03)), strict=False):
    beside.text(*(p[:2] + turn), name, fontsize=12, ha="center", va="center")
beside.set_axis_off()
beside.set_title("Section with 10 % of D", pad=18)
_ = figure.colorbar(colors, ax=beside, label="melting point in degrees", shrink=0.8)
