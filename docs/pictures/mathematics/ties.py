"""Pictures of the tie rule: one edge, and a grid."""

import numpy as np
from drawing import BLUE, GRAY, ORANGE, circle, dots, edges, label, lines, panels

from delone import Delaunay


def edge() -> None:
    """An edge whose four points are cocircular, before and after its flip."""
    u, v, p, q = np.array([(0, 5), (3, -4), (-5, 0), (4, 3)], dtype=float)
    names = {"u": (u, (0, 11)), "v": (v, (4, -11)), "p": (p, (-11, 0)), "q": (q, (10, 6))}
    row = panels("$p$ is the smallest: $uv$ is flipped", "the fan from $p$", width=3.6)
    for ax, diagonal, color in zip(row, ((u, v), (p, q)), (ORANGE, BLUE), strict=True):
        circle(ax, (0, 0), 5, GRAY, linestyle=":")
        ring = np.array((u, p, v, q, u))
        ax.plot(*ring.T, color=BLUE, linewidth=1.4)
        lines(ax, [diagonal], color, linewidth=2.6)
        dots(ax, (u, v, q), size=30)
        dots(ax, p, ORANGE, 50)
        for name, (point, shift) in names.items():
            label(ax, point, f"${name}$", shift)
        ax.set(xlim=(-6.4, 6.2), ylim=(-6, 6.4))


def grid() -> None:
    """A lattice whose ties are broken by chance, and by the rule."""
    x, y = np.meshgrid(np.arange(7.0), np.arange(7.0))
    points = np.column_stack((x.ravel(), y.ravel()))
    shaken = points + 1e-9 * np.random.default_rng(2).normal(size=points.shape)
    row = panels("left to chance", "the rule chooses")
    for ax, mesh in zip(row, (Delaunay(shaken), Delaunay(points)), strict=True):
        inner = [abs(np.linalg.det(np.diff(points[t], axis=0))) > 0.5 for t in mesh.simplices]
        edges(ax, points, mesh.simplices[inner], BLUE)
        dots(ax, points)
