"""What the pictures of the pages of mathematics are drawn with."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from numpy.typing import ArrayLike, NDArray

BLUE, ORANGE, GRAY, PALE, INK = "#2f6f9f", "#d9742b", "#9a9a9a", "#dbe7f0", "#303030"

Points = NDArray[np.float64]
Rows = NDArray[np.int32]


def panels(*titles: str, width: float = 3.4, height: float = 3.4, rows: int = 1) -> list[Axes]:
    """Axes without frames, in rows, with equal scales."""
    columns = len(titles) // rows
    size = (width * columns, height * rows)
    _, row = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    for ax, title in zip(row.flat, titles, strict=True):
        ax.set_title(title, fontsize=10)
        ax.set_aspect("equal")
        ax.set_axis_off()
    return list(row.flat)


def edges(ax: Axes, points: Points, simplices: Rows, color: str = GRAY) -> None:
    """The edges of triangles."""
    ax.triplot(*points.T, simplices, color=color, linewidth=1)


def fill(ax: Axes, shapes: ArrayLike, color: str, alpha: float = 0.3) -> None:
    """Polygons, as arrays of corners."""
    ax.add_collection(PolyCollection(list(shapes), facecolor=color, alpha=alpha, edgecolor="none"))
    ax.autoscale_view()


def lines(ax: Axes, pairs: ArrayLike, color: str = INK, **style: object) -> None:
    """Straight lines, as pairs of points."""
    ax.add_collection(LineCollection(list(pairs), color=color, **style))
    ax.autoscale_view()


def dots(ax: Axes, points: ArrayLike, color: str = INK, size: float = 18) -> None:
    """Points."""
    ax.scatter(*np.atleast_2d(points).T, s=size, color=color, zorder=4)


def circle(
    ax: Axes, center: ArrayLike, radius: float, color: str = ORANGE, **style: object
) -> None:
    """A circle that is not filled."""
    style = {"linewidth": 1.3} | style
    turn = np.linspace(0, 2 * np.pi, 200)
    ring = np.asarray(center) + radius * np.column_stack((np.cos(turn), np.sin(turn)))
    ax.plot(*ring.T, color=color, **style)


def circumcircle(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> tuple[Points, float]:
    """The center and the radius of the circle through three points."""
    a, u, v = np.asarray(a), np.subtract(b, a), np.subtract(c, a)
    away = np.linalg.solve(2 * np.array((u, v)), (u @ u, v @ v))
    return a + away, float(np.hypot(*away))


def label(ax: Axes, point: ArrayLike, text: str, shift: ArrayLike, color: str = INK) -> None:
    """A name next to a point, shifted by typographic points."""
    ax.annotate(
        text, point, shift, textcoords="offset points", color=color, ha="center", va="center"
    )


def spread(n: int, seed: int) -> Points:
    """Points of the unit square that keep apart: each is the best of twenty, by distance."""
    random = np.random.default_rng(seed)
    points = [random.random(2)]
    while len(points) < n:
        candidates = random.random((20, 2))
        apart = np.hypot(*(candidates[:, None] - np.array(points)).T).min(axis=0)
        points.append(candidates[apart.argmax()])
    return np.array(points)


def panels3(*titles: str, width: float = 3.6, height: float = 3.6, zoom: float = 1.0) -> list[Axes]:
    """A row of equal axes for 3-D."""
    figure = plt.figure(figsize=(width * len(titles), height), layout="constrained")
    row = []
    for k, title in enumerate(titles):
        ax = figure.add_subplot(1, len(titles), k + 1, projection="3d", computed_zorder=False)
        ax.set_title(title, fontsize=10)
        ax.set_axis_off()
        ax.set_box_aspect((1, 1, 1), zoom=zoom)
        row.append(ax)
    return row


def faces(ax: Axes, shapes: ArrayLike, color: str, alpha: float = 0.5, line: str = INK) -> None:
    """Polygons in 3-D, as arrays of corners."""
    style = {"facecolor": color, "edgecolor": line, "alpha": alpha, "linewidth": 0.9}
    ax.add_collection3d(Poly3DCollection(list(shapes), **style))
