"""A picture for each of the five methods, drawn from what delone itself computes."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

import delone
from delone import Delaunay, predicates

BLUE, ORANGE, GREY = "#2f6f9f", "#d9822b", "#8a8a8a"

Points = NDArray[np.float64]


def _axes(n: int) -> list[Axes]:
    _, axes = plt.subplots(1, n, figsize=(3.4 * n, 3.4), layout="constrained", squeeze=False)
    for ax in axes[0]:
        ax.set_aspect("equal")
        ax.set_axis_off()
    return list(axes[0])


def _edges(ax: Axes, points: Points, simplices: NDArray[np.int32], color: str = GREY) -> None:
    ax.triplot(*points.T, simplices, color=color, linewidth=0.9)


def _fill(ax: Axes, points: Points, simplices: NDArray[np.int32], color: str) -> None:
    for triangle in simplices:
        ax.fill(*points[triangle].T, color=color, alpha=0.28, linewidth=0)


def _dots(ax: Axes, points: Points, color: str = "black", size: float = 14) -> None:
    ax.scatter(*points.T, s=size, color=color, zorder=3)


def cavity() -> None:
    """Bowyer-Watson: the circles that hold the new point, the hole, the star."""
    points = np.random.default_rng(12).random((28, 2))
    new = np.array([0.52, 0.5])
    before, after = Delaunay(points), Delaunay(np.vstack((points, new)))
    corners = [points[before.simplices[:, k]] for k in range(3)]
    conflict = predicates.incircle(*corners, new) > 0
    left, middle, right = _axes(3)
    _edges(left, points, before.simplices)
    _fill(left, points, before.simplices[conflict], ORANGE)
    for centre, corner in zip(before.circumcenters[conflict], corners[0][conflict], strict=True):
        radius = np.hypot(*(centre - corner))
        left.add_patch(plt.Circle(centre, radius, fill=False, color=ORANGE, linewidth=0.8))
    _edges(middle, points, before.simplices[~conflict])
    _edges(right, after.points, after.simplices)
    star = (after.simplices == len(points)).any(axis=1)
    _fill(right, after.points, after.simplices[star], BLUE)
    titles = "circles that hold the point", "the cavity", "its star"
    for ax, title in zip((left, middle, right), titles, strict=True):
        _dots(ax, points)
        _dots(ax, new[None], ORANGE, 34)
        ax.set(xlim=(-0.06, 1.06), ylim=(-0.06, 1.06), title=title)


def flips() -> None:
    """Incremental: Lawson's flips, from a bad triangulation to Delaunay's."""
    points = np.random.default_rng(5).random((14, 2))
    skewed = points * [1.0, 0.05]
    result = delone.lawson(points, Delaunay(skewed).simplices, record=True)
    assert result.sequence is not None
    left, middle, right = _axes(3)
    u, v, p, q = result.sequence[0]
    _edges(left, points, Delaunay(skewed).simplices)
    left.plot(*points[[u, v]].T, color=ORANGE, linewidth=2.5)
    left.plot(*points[[p, q]].T, color=BLUE, linewidth=2.5, linestyle="--")
    left.set_title("the first flip: the orange edge\nbecomes the blue one")
    _edges(middle, points, Delaunay(skewed).simplices, "#d0d0d0")
    for u, v, p, q in result.sequence:
        middle.plot(*points[[u, v]].T, color=ORANGE, linewidth=0.9, alpha=0.6)
        middle.plot(*points[[p, q]].T, color=BLUE, linewidth=0.9, alpha=0.6)
    middle.set_title(f"all {result.flips} flips")
    _edges(right, points, result.simplices, BLUE)
    right.set_title("no edge is left to flip")
    for ax in (left, middle, right):
        _dots(ax, points)


def seam() -> None:
    """Divide and conquer: two triangulations and what the merge puts between them."""
    points = np.random.default_rng(3).random((60, 2))
    left_half = points[:, 0] < np.median(points[:, 0])
    halves = [points[left_half] - [0.06, 0], points[~left_half] + [0.06, 0]]
    whole = Delaunay(points)
    sides = left_half[whole.simplices].sum(axis=1)
    before, after = _axes(2)
    for half, color in zip(halves, (BLUE, ORANGE), strict=True):
        _edges(before, half, Delaunay(half).simplices, color)
        _dots(before, half)
    before.set_title("two halves")
    for count, color in ((3, BLUE), (0, ORANGE)):
        _edges(after, points, whole.simplices[sides == count], color)
    between = whole.simplices[(sides > 0) & (sides < 3)]
    _fill(after, points, between, GREY)
    _edges(after, points, between, "black")
    _dots(after, points)
    after.set_title("merged: the seam in black")


def beach() -> None:
    """Fortune's sweep: the beach line, and the triangles that are final."""
    points = np.random.default_rng(8).random((24, 2))
    mesh = Delaunay(points)
    line = 0.62
    behind = points[points[:, 0] < line]
    y = np.linspace(-0.15, 1.15, 800)
    # x of the points as far from a site as from the line: a parabola a site; the rightmost counts.
    arcs = (line + behind[:, :1]) / 2 - (y - behind[:, 1:]) ** 2 / (2 * (line - behind[:, :1]))
    radius = np.hypot(*(mesh.circumcenters - points[mesh.simplices[:, 0]]).T)
    final = mesh.circumcenters[:, 0] + radius < line
    (ax,) = _axes(1)
    ax.figure.set_size_inches(5.2, 4.6)
    _edges(ax, points, mesh.simplices, "#dddddd")
    _fill(ax, points, mesh.simplices[final], BLUE)
    _edges(ax, points, mesh.simplices[final], BLUE)
    for arc in arcs:
        ax.plot(arc, y, color=ORANGE, linewidth=0.5, alpha=0.45)
    ax.plot(arcs.max(axis=0), y, color=ORANGE, linewidth=2.2)
    ax.axvline(line, color="black", linewidth=1.2)
    _dots(ax, points)
    ax.set(xlim=(-0.1, 1.08), ylim=(-0.08, 1.08), title="sweep line, beach line, final triangles")


def paraboloid() -> None:
    """Lifting: the lower hull of the lifted points, and its shadow in the plane."""
    points = np.random.default_rng(4).random((40, 2)) * 2 - 1
    mesh = Delaunay(points, method="lifting")
    heights = (points**2).sum(axis=1)
    figure = plt.figure(figsize=(5.6, 5.0), layout="constrained")
    ax = figure.add_subplot(projection="3d")
    ax.plot_trisurf(
        *points.T, heights, triangles=mesh.simplices, color=ORANGE, edgecolor="black",
        linewidth=0.5, alpha=0.75,
    )  # fmt: skip
    floor = -1.3
    for triangle in mesh.simplices:
        ring = points[[*triangle, triangle[0]]]
        ax.plot(*ring.T, floor, color=BLUE, linewidth=0.8)
    for (x, y), z in zip(points, heights, strict=True):
        ax.plot([x, x], [y, y], [floor, z], color=GREY, linewidth=0.3)
    ax.set(zlim=(floor, 2), title="the lower hull above, Delaunay below")
    ax.set_axis_off()
    ax.view_init(elev=16, azim=-62)
