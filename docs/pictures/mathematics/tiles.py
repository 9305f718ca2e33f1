"""Pictures of tiles: who owns a point, which triangles are certain, what a query finds."""

import numpy as np
from drawing import (
    BLUE,
    GRAY,
    INK,
    ORANGE,
    Points,
    Rows,
    circle,
    circumcircle,
    dots,
    edges,
    fill,
    lines,
    panels,
)
from matplotlib.axes import Axes

from delone import Delaunay

CUT, MARGIN = 0.5, 0.05


def _known() -> tuple[Points, Points, np.ndarray]:
    """All points, those that the lower left of four tiles knows, and which of these it owns."""
    points = np.random.default_rng(12).random((260, 2))
    hull = np.isin(np.arange(len(points)), Delaunay(points).hull)
    near = (points <= CUT + MARGIN).all(axis=1)
    known = points[near | hull]
    return points, known, (known < CUT).all(axis=1)


def _frame(ax: Axes) -> None:
    lines(ax, [((CUT, -0.02), (CUT, 1.02)), ((-0.02, CUT), (1.02, CUT))], INK, linewidth=1.6)
    box = np.array([(-0.02, CUT + MARGIN), (CUT + MARGIN, CUT + MARGIN), (CUT + MARGIN, -0.02)])
    ax.plot(*box.T, color=INK, linewidth=1.2, linestyle=(0, (4, 3)))


def _disks(points: Points, simplices: Rows) -> list[tuple[Points, float]]:
    return [circumcircle(*points[t]) for t in simplices]


def certain() -> None:
    """What a tile knows, and the triangles whose circumdisks lie in its box."""
    points, known, own = _known()
    mesh = Delaunay(known)
    left, right = panels(
        "what the lower left tile knows", "certain triangles of its points", width=4.2
    )
    dots(left, points, "#cfcfcf", 8)
    dots(left, known[~own], GRAY, 14)
    dots(left, known[own], BLUE, 14)
    touch = own[mesh.simplices].any(axis=1)
    sure = np.array([(c + r <= CUT + MARGIN).all() for c, r in _disks(known, mesh.simplices)])
    fill(right, known[mesh.simplices[touch & sure]], BLUE, 0.35)
    fill(right, known[mesh.simplices[touch & ~sure]], ORANGE, 0.35)
    edges(right, known, mesh.simplices[touch], GRAY)
    dots(right, known[own], BLUE, 10)
    for ax in (left, right):
        _frame(ax)
        ax.set(xlim=(-0.03, 1.03), ylim=(-0.03, 1.03))


def query() -> None:
    """A triangle that is not certain, the points that another tile returns, and the result."""
    points, known, own = _known()
    mesh, whole = Delaunay(known), Delaunay(points)
    there = {tuple(map(tuple, np.sort(points[t], axis=0))) for t in whole.simplices}
    wrong = [
        t
        for t in mesh.simplices[own[mesh.simplices].any(axis=1)]
        if tuple(map(tuple, np.sort(known[t], axis=0))) not in there
    ]
    chosen = min(wrong, key=lambda t: circumcircle(*known[t])[1])
    center, radius = circumcircle(*known[chosen])
    answer = points[np.hypot(*(points - center).T) < radius * (1 - 1e-9)]
    after = Delaunay(np.vstack((known, answer)))
    row = panels(
        "its disk leaves the box; another tile\nhas orange points in it",
        "after they are inserted",
        width=4.2,
    )
    edges(row[0], known, mesh.simplices, GRAY)
    fill(row[0], [known[chosen]], ORANGE, 0.4)
    edges(row[1], after.points, after.simplices, GRAY)
    for ax, shown in zip(row, (known, after.points), strict=True):
        _frame(ax)
        circle(ax, center, radius)
        dots(ax, shown, GRAY, 10)
        dots(ax, known[own], BLUE, 14)
        dots(ax, answer, ORANGE, 40)
        ax.set(xlim=center[0] + np.array((-2.6, 2.6)) * radius)
        ax.set(ylim=center[1] + np.array((-2.6, 2.6)) * radius)
