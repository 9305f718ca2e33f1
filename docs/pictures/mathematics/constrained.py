"""Pictures of constrained triangulations: what a segment hides, how it is inserted and split."""

import numpy as np
from drawing import (
    BLUE,
    GRAY,
    INK,
    ORANGE,
    Points,
    circle,
    circumcircle,
    dots,
    edges,
    fill,
    label,
    lines,
    panels,
    spread,
)
from matplotlib.axes import Axes

from delone import ConstrainedDelaunay, Delaunay
from delone.predicates import orient2d


def visible() -> None:
    """A point in a circumcircle, seen from the triangle, and hidden by a segment."""
    points = np.array(
        [(0, 0), (4, 0), (2, 2.6), (1.9, -1.3), (-1.4, -0.7), (5.4, -0.6)], dtype=float
    )
    free, split = np.array([(0, 4), (4, 3), (3, 5), (5, 1)]), np.array([(0, 1)])
    row = panels("$v$ is visible: not allowed", "hidden by a segment: allowed", width=3.9)
    for ax, segments in zip(row, (free[:0], split), strict=True):
        fill(ax, [points[:3]], BLUE, 0.2)
        circle(ax, *circumcircle(*points[:3]))
        lines(ax, points[[(0, 1), (1, 2), (2, 0)]], BLUE, linewidth=1.2)
        lines(ax, points[segments], INK, linewidth=3)
        sight = np.array([(2, 0.9), points[3]])
        end = 0.06 + sight[1] if len(segments) == 0 else np.array((1.96, 0.04))
        ax.annotate("", end, sight[0], arrowprops={"arrowstyle": "->", "color": INK})
        dots(ax, points[:3], size=30)
        dots(ax, points[3], ORANGE, 50)
        label(ax, points[3], "$v$", (11, -3))
        label(ax, sight[0], "$x$", (-2, 8))
        label(ax, points[2], "$t$", (0, -34))


def insertion() -> None:
    """The triangles that a segment crosses, the two polygons, and what fills them."""
    points = spread(30, 11)
    a, b = (int(np.hypot(*(points - end).T).argmin()) for end in ((0.05, 0.35), (0.95, 0.65)))
    before, after = Delaunay(points), ConstrainedDelaunay(points, [(a, b)])
    kept = {tuple(t) for t in np.sort(after.simplices)}
    gone = np.array([tuple(sorted(t)) not in kept for t in before.simplices])
    was = {tuple(t) for t in np.sort(before.simplices)}
    new = np.array([tuple(sorted(t)) not in was for t in after.simplices])
    row = panels("edges that $ab$ crosses", "two polygons", "their triangulations")
    edges(row[0], points, before.simplices)
    ends = points[before.edges]
    sides = [orient2d(points[a], points[b], ends[:, k]) for k in (0, 1)]
    sides += [orient2d(ends[:, 0], ends[:, 1], points[k]) for k in (a, b)]
    crossed = (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)
    lines(row[0], ends[crossed], ORANGE, linewidth=2)
    edges(row[1], points, before.simplices[~gone])
    above = orient2d(points[a], points[b], points[after.simplices].mean(axis=1)) > 0
    for ax in row[1:]:
        fill(ax, points[after.simplices[new & above]], ORANGE)
        fill(ax, points[after.simplices[new & ~above]], BLUE)
    edges(row[2], points, after.simplices)
    for ax in row:
        lines(ax, [points[[a, b]]], INK, linewidth=2.4)
        dots(ax, points)
        label(ax, points[a], "$a$", (-9, 0))
        label(ax, points[b], "$b$", (9, 0))


def _cross(u: Points, v: Points) -> float:
    return float(u[0] * v[1] - u[1] * v[0])


def rounding() -> None:
    """Two segments on a coarse grid, their crossing, and where their pieces meet."""
    a, b, c, d = np.array([(0, 1), (7, 4), (1, 5), (6, 0)], dtype=float)
    t = _cross(c - a, d - c) / _cross(b - a, d - c)
    crossing = a + t * (b - a)
    rounded = np.round(crossing)
    (ax,) = panels("", width=5, height=3.6)
    x, y = np.meshgrid(np.arange(8), np.arange(6))
    dots(ax, np.column_stack((x.ravel(), y.ravel())), "#c8c8c8", 7)
    lines(ax, ((a, b), (c, d)), GRAY, linestyle=(0, (4, 3)), linewidth=1.2)
    for end in (a, b, c, d):
        lines(ax, [(end, rounded)], BLUE, linewidth=2)
    dots(ax, (a, b, c, d), size=36)
    dots(ax, rounded, ORANGE, 50)
    ax.plot(*crossing, "x", color=INK, markersize=8, markeredgewidth=2, zorder=5)
    for end, name, shift in zip(
        (a, b, c, d), "abcd", ((-9, 0), (9, 0), (-9, 0), (9, 0)), strict=True
    ):
        label(ax, end, f"${name}$", shift)
    label(ax, crossing, "$x$", (11, 3))


def _halved(angle: float, rounds: int) -> list[Points]:
    """Two sides of a corner, as distances from it, each split where the other encroaches."""
    sides = [np.array([0, 1.0]), np.array([0, 0.8])]
    for k in range(rounds):
        mine, other = sides[k % 2], sides[1 - k % 2][1:]
        middle = (mine[1:] + mine[:-1]) / 2
        room = np.hypot(
            other[:, None] * np.cos(angle) - middle, other[:, None] * np.sin(angle)
        ).min(axis=0)
        split = room < (mine[1:] - mine[:-1]) / 2
        sides[k % 2] = np.sort(np.concatenate((mine, middle[split])))
    return sides


def _corner(ax: Axes, sides: list[Points], angle: float) -> None:
    for distances, turn in zip(sides, (0, angle), strict=True):
        direction = np.array((np.cos(turn), np.sin(turn)))
        lines(ax, [(0 * direction, distances.max() * direction)], BLUE, linewidth=1.6)
        dots(ax, distances[:, None] * direction)


def shells() -> None:
    """A sharp corner, split at midpoints again and again, and on common circles."""
    angle = np.radians(25)
    left, right = panels(
        "midpoints: no end", "distances that are powers of two", width=4.6, height=2.6
    )
    _corner(left, _halved(angle, 14), angle)
    tips = np.array([(1, 0), 0.8 * np.array((np.cos(angle), np.sin(angle)))])
    mesh = ConstrainedDelaunay([(0, 0), *tips], [(0, 1), (0, 2)], conforming=True)
    far = np.hypot(*mesh.points.T)
    upper = mesh.points[:, 1] > 0
    sides = [np.append(0, far[~upper & (far > 0)]), np.append(0, far[upper])]
    _corner(right, sides, angle)
    for radius in np.intersect1d(*(np.round(side, 9) for side in sides))[1:]:
        turn = np.linspace(-0.25, angle + 0.25, 60)
        right.plot(radius * np.cos(turn), radius * np.sin(turn), color=ORANGE, linewidth=1.2)
