"""Pictures of interpolated fields, drawn from what delone itself computes."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LightSource

from delone import datasets
from delone.interpolate import Linear, grid, interpolator

# Meters between contour lines, and how near to a ship's track the sea floor is known, in degrees.
CONTOURS = np.arange(-7000, 0, 500)
KNOWN = 0.35


def sea_floor() -> None:
    """The soundings off Baja California as a map of the sea floor, and where they were taken."""
    survey = datasets.baja()
    made = interpolator(survey, survey.z, "sibson", duplicates="mean", planar=True)
    sea = grid(made, resolution=0.0125, max_distance=KNOWN)
    figure, ax = plt.subplots(figsize=(8.4, 8.2), layout="constrained")
    ax.set_facecolor("#e9e3d3")
    sea.plot(ax, contours=CONTOURS, label="meters", shade=True)
    ax.plot(*survey.points.T, ",", color="black", alpha=0.12)
    ax.set(
        xlabel="degrees east",
        ylabel="degrees north",
        title=f"{len(survey.points):,} soundings off Baja California, natural neighbors",
    )
    ax.set_aspect(1 / np.cos(np.radians(25)))
    figure.canvas.draw()


def six_methods() -> None:
    """One field, eighty sites, six interpolants in slanting light."""
    points = np.concatenate((datasets.uniform(76, seed=4), [(0, 0), (1, 0), (1, 1), (0, 1)]))
    x, y = points.T
    values = np.sin(7 * x) * np.cos(5 * y) + x
    _, axes = plt.subplots(2, 3, figsize=(9, 6.2), layout="constrained")
    names = ("nearest", "linear", "laplace", "sibson", "farin", "clough-tocher")
    sun = LightSource(azdeg=315, altdeg=40)
    for ax, name in zip(axes.flat, names, strict=True):
        found = grid(points, values, shape=(300, 300), method=name)
        picture = sun.shade(
            found.values, plt.get_cmap("viridis"), vert_exag=40, blend_mode="soft", vmin=-1, vmax=2
        )
        ax.imshow(picture, extent=found.extent, origin="lower")
        ax.plot(x, y, ".", color="black", markersize=2.5)
        ax.set(title=name, xticks=[], yticks=[])


def beyond() -> None:
    """The same sites, and the values outside their hull."""
    points = 0.25 + 0.5 * datasets.uniform(40, seed=6)
    values = points[:, 0] + np.sin(6 * points[:, 1])
    _, axes = plt.subplots(1, 3, figsize=(9, 3.2), layout="constrained")
    nodes = np.linspace(0, 1, 240)
    for ax, policy in zip(axes, ("nan", "nearest", "linear"), strict=True):
        made = Linear(points, values, extrapolate=policy)
        found = grid(made, x=nodes, y=nodes)
        ax.contourf(nodes, nodes, found.values, levels=np.linspace(-1.5, 2.5, 25), extend="both")
        ring = made.triangulation.points[made.triangulation.hull]
        ax.fill(*ring.T, fill=False, edgecolor="white", linewidth=1)
        ax.plot(*points.T, ".", color="black", markersize=3)
        ax.set(title=f'extrapolate="{policy}"', aspect="equal", xticks=[], yticks=[])
