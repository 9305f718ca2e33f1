"""Pictures of the definition: circles, the paraboloid, and triangles beyond the hull."""

import numpy as np
from drawing import (
    BLUE,
    GRAY,
    INK,
    ORANGE,
    PALE,
    circle,
    circumcircle,
    dots,
    edges,
    faces,
    fill,
    label,
    lines,
    panels,
    panels3,
    spread,
)

from delone import Delaunay
from delone.predicates import orient2d


def flip() -> None:
    """One edge, before and after its flip, and the circles on its sides."""
    points = np.array([(0, 0), (2, 0), (3, 2), (0, 1)], dtype=float)
    row = panels("not locally Delaunay: smallest angle 15.3°", "locally Delaunay: 26.6°", width=4)
    for ax, mesh in zip(row, ([(0, 1, 2), (0, 2, 3)], [(1, 2, 3), (0, 1, 3)]), strict=True):
        triangles = np.array(mesh, np.int32)
        edges(ax, points, triangles, BLUE)
        for triangle, color in zip(triangles, (ORANGE, GRAY), strict=True):
            circle(ax, *circumcircle(*points[triangle]), color)
        common = [k for k in range(4) if (triangles == k).any(axis=1).all()]
        lines(ax, [points[common]], BLUE, linewidth=2.6)
        dots(ax, points, size=30)
        ax.set(xlim=(-1.2, 3.9), ylim=(-1.6, 3.8))


def lifting() -> None:
    """A circle, the plane through its lift, and a point on either side."""
    (ax,) = panels3("", width=5.6, height=4.6, zoom=1.2)
    center, radius, floor = np.array([0.2, 0.1]), 0.5, -0.9
    turn = np.linspace(0, 2 * np.pi, 121)
    round_ = np.column_stack((np.cos(turn), np.sin(turn)))
    ring = center + radius * round_
    rise = 2 * center
    height = radius**2 - center @ center

    def up(p: np.ndarray) -> np.ndarray:
        return np.column_stack((p, (p**2).sum(axis=-1)))

    far, angle = np.meshgrid(np.linspace(0, 0.95, 12), turn)
    x, y = far * np.cos(angle), far * np.sin(angle)
    ax.plot_surface(
        x, y, far**2, color=PALE, alpha=0.35, rstride=10, cstride=2, edgecolor="#b5cbdc"
    )
    ax.plot(*ring.T, floor, color=ORANGE)
    ax.plot(*up(ring).T, color=ORANGE, linewidth=2)
    corners = center + 0.62 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    faces(ax, [np.column_stack((corners, corners @ rise + height))], ORANGE, 0.18, ORANGE)
    abc = ring[[15, 52, 98]]
    faces(ax, [np.column_stack((abc, np.full(3, floor)))], ORANGE, 0.35)
    faces(ax, [up(abc)], ORANGE, 0.35)
    for point, name, color in (
        (center - (0.28, 0.2), "inside", BLUE),
        ((-0.62, 0.1), "outside", INK),
    ):
        p = np.array(point)
        foot, top = np.append(p, floor), np.append(p, p @ p)
        ax.plot(*np.array((foot, top)).T, color=color, linewidth=1, linestyle=":")
        ax.scatter(*np.array((foot, top)).T, color=color, s=30, depthshade=False, zorder=9)
        ax.text(p[0] - 0.04, p[1], -0.4, name, color=color, ha="right", va="center")
    ax.set(xlim=(-0.8, 0.8), ylim=(-0.8, 0.8), zlim=(floor, 0.9))
    ax.view_init(elev=14, azim=-68)


def ghosts() -> None:
    """Ghost triangles outside the hull, and those in whose half-planes a new point lies."""
    points = spread(14, 3)
    new = np.array([1.22, 0.28])
    before, after = Delaunay(points), Delaunay(np.vstack((points, new)))
    hull = before.hull
    u, v = points[hull], points[np.roll(hull, -1)]
    middle = points.mean(axis=0)
    seen = orient2d(u, v, new) < 0
    left, right = panels("ghosts, joined to a vertex at infinity", "after the insertion", width=4)
    strips = np.stack((u, v, middle + 2 * (v - middle), middle + 2 * (u - middle)), axis=1)
    fill(left, strips, GRAY, 0.15)
    fill(left, strips[seen], ORANGE, 0.4)
    lines(left, strips[:, [0, 3]], GRAY, linestyle=(0, (3, 2)), linewidth=1)
    edges(left, points, before.simplices, BLUE)
    star = (after.simplices == len(points)).any(axis=1)
    edges(right, after.points, after.simplices, BLUE)
    fill(right, after.points[after.simplices[star]], ORANGE, 0.4)
    for ax in (left, right):
        dots(ax, points)
        dots(ax, new, ORANGE, 40)
        ax.set(xlim=(-0.5, 1.55), ylim=(-0.5, 1.5))
    label(left, new, "new point", (10, -14))
