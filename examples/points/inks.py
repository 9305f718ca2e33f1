"""
Compute the gamut of a printer: inks within limits, and the colors that they print
==================================================================================

A printer mixes four inks, each from 0 to 1. Paper absorbs only a limited total amount of ink, so the printable
recipes are a part of the cube in 4-D: an intersection of half-spaces. The colors of these recipes fill a solid in
3-D, the gamut.

Install: ``pip install "delone[plot]"``.
"""

import matplotlib.pyplot as plt
import numpy as np

from delone import ConvexHull
from delone.compat.scipy import HalfspaceIntersection

inks = "cyan", "magenta", "yellow", "black"
# Rows a, b for a @ recipe + b <= 0: each ink between 0 and 1, at most 2.4 in total, at most 1.8 without black,
# and at most 2 of cyan and yellow, which the first limits already imply.
sides = np.vstack((np.eye(4), -np.eye(4)))
limits = np.vstack(
    (
        np.column_stack((sides, np.repeat([-1.0, 0.0], 4))),
        (1, 1, 1, 1, -2.4),
        (1, 1, 1, 0, -1.8),
        (1, 0, 1, 0, -2.0),
    )
)
allowed = HalfspaceIntersection(limits, np.full(4, 0.3))
print(f"{len(allowed.intersections)} corners")
print("redundant limits:", np.setdiff1d(np.arange(len(limits)), allowed.dual_vertices).tolist())

# %%
# ``dual_facets`` lists the limits that meet at each corner: at most corners, four. This is decided exactly for the
# given doubles 2.4 and 1.8. The volume of the hull of the corners is the fraction of all recipes that are printable,
# and ``contains`` tests whether a recipe is one of them.

print("limits at each corner:", np.unique([len(facet) for facet in allowed.dual_facets]).tolist())
recipes = ConvexHull(allowed.intersections)
print(f"{100 * recipes.volume:.1f} % of all recipes")
dark = [(1, 1, 1, 1), (0.6, 0.5, 0.5, 0.8), (0.2, 0.2, 0.2, 1)]
print(dict(zip(dark, recipes.contains(dark).tolist(), strict=True)))


# %%
# A simple model of printing: each colored ink absorbs most of one third of the spectrum and some of the other two, and
# black absorbs nearly everything. The result is in CIELAB, a color space in which equal distances look about equal.

absorbed = np.array([(0.92, 0.35, 0.12), (0.18, 0.9, 0.3), (0.03, 0.12, 0.92), (0.96, 0.96, 0.96)])
to_xyz = np.array([(0.4124, 0.3576, 0.1805), (0.2126, 0.7152, 0.0722), (0.0193, 0.1192, 0.9505)])


def lab(recipe):
    """Return lightness, green to red, and blue to yellow, (..., 3), of recipes (..., 4)."""
    light = 0.95 * np.prod(1 - recipe[..., :, None] * absorbed, axis=-2)
    x, y, z = np.moveaxis(np.cbrt(light @ to_xyz.T / to_xyz.sum(axis=1)), -1, 0)
    return np.stack((116 * y - 16, 500 * (x - y), 200 * (y - z)), axis=-1)


rng = np.random.default_rng(0)
steps = np.stack(np.meshgrid(*4 * [np.linspace(0, 1, 13)], indexing="ij"), axis=-1).reshape(-1, 4)
printable = np.vstack((steps[recipes.contains(steps)], allowed.intersections))
with_limits, without = ConvexHull(lab(printable)), ConvexHull(lab(steps))
print(f"the limits cost {100 * (1 - with_limits.volume / without.volume):.0f} % of the gamut")

# %%
# Which colors of an image can be printed? A common mistake is to test each of the three coordinates against its
# range. This accepts many colors that cannot be printed, because the gamut is far from a box.

low, high = with_limits.min_bound, with_limits.max_bound
colors = rng.uniform(low, high, (20_000, 3))
print(f"{100 * with_limits.contains(colors).mean():.0f} % of the colors in the box are printable")

# %%
# Plot sections at three values of lightness: in color, the gamut within the limits; as an outline, the gamut without
# limits.

figure, axes = plt.subplots(1, 3, figsize=(9.4, 3.9), layout="constrained", sharey=True)
a, b = np.meshgrid(np.linspace(-75, 90, 180), np.linspace(-75, 100, 180))
from_xyz = np.linalg.inv(to_xyz)
for axis, lightness in zip(axes, (35, 55, 75), strict=True):
    section = np.stack((np.full_like(a, lightness), a, b), axis=-1)
    y = (lightness + 16) / 116
    cubes = np.stack((y + a / 500, np.full_like(a, y), y - b / 200), axis=-1) ** 3
    shown = np.clip(cubes * to_xyz.sum(axis=1) @ from_xyz.T, 0, 1) ** (1 / 2.2)
    alpha = with_limits.contains(section)[..., None].astype(float)
    axis.imshow(np.concatenate((shown, alpha), axis=-1), origin="lower", extent=(-75, 90, -75, 100))
    inside = without.contains(section).astype(float)
    axis.contour(a, b, inside, levels=[0.5], colors="0.3", linewidths=0.9)
    axis.set(xlabel="a* (green to red)", title=f"L* = {lightness}")
_ = axes[0].set_ylabel("b* (blue to yellow)")
