"""Pictures of slivers, and of what removes them."""

import matplotlib.pyplot as plt
import numpy as np
from drawing import BLUE, GRAY, INK, ORANGE, faces, panels3

import delone

FACES = np.array([(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
# Four points that are nearly a square, and one on either side.
POINTS = np.array([(0, 0, 0), (1, 0, 0.01), (1, 1, 0), (0, 1, 0.01), (0.5, 0.5, 1), (0.5, 0.5, -1)])


def _smallest(points: np.ndarray, simplices: np.ndarray) -> float:
    """The smallest dihedral angle of tetrahedra, in degrees."""
    found = []
    for corners in points[simplices]:
        # The gradients of the barycentric coordinates are normal to the faces.
        normals = np.linalg.inv(np.column_stack((corners, np.ones(4))))[:3].T
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        cosines = -(normals @ normals.T)[np.triu_indices(4, 1)]
        found.append(np.degrees(np.arccos(cosines.max())))
    return min(found)


def sliver() -> None:
    """A regular tetrahedron and a sliver, each in its circumsphere."""
    row = panels3("a good tetrahedron", "a sliver in the same sphere", zoom=1.3)
    good = np.array([(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1)]) / np.sqrt(3)
    flat = np.array([(1, 0, 0.12), (0, 1, -0.12), (-1, 0, 0.12), (0, -1, -0.12)])
    flat /= np.hypot(1, 0.12)
    turn = np.linspace(0, 2 * np.pi, 100)
    for ax, points, color in zip(row, (good, flat), (BLUE, ORANGE), strict=True):
        ring = np.column_stack((np.cos(turn), np.sin(turn), 0 * turn))
        for order in ((0, 1, 2), (0, 2, 1), (2, 0, 1)):
            ax.plot(*ring[:, order].T, color="#c4c4c4", linewidth=1)
        faces(ax, points[FACES], color, 0.3)
        ax.scatter(*points.T, color=INK, s=22, depthshade=False, zorder=9)
        ax.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
        ax.view_init(elev=18, azim=-58)


def removal() -> None:
    """A sliver amid four tetrahedra, and the four around a new edge that replace all five."""
    before = np.array([(0, 1, 2, 3), (0, 1, 3, 4), (1, 2, 3, 4), (0, 1, 2, 5), (0, 2, 3, 5)])
    after = np.array([(k, (k + 1) % 4, 4, 5) for k in range(4)])
    angles = [_smallest(POINTS, simplices) for simplices in (before, after)]
    titles = (
        f"five tetrahedra, one a sliver:\n{angles[0]:.1f}° or more",
        f"four around the orange edge:\n{angles[1]:.0f}° or more",
    )
    row = panels3(*titles, height=3.4, zoom=1.25)
    for ax, simplices in zip(row, (before, after), strict=True):
        pairs = {tuple(sorted(t[[i, j]])) for t in simplices for i in range(4) for j in range(i)}
        for pair in sorted(pairs):
            ax.plot(*POINTS[list(pair)].T, color=BLUE, linewidth=1.1)
        ax.scatter(*POINTS.T, color=INK, s=18, depthshade=False, zorder=9)
        ax.set(xlim=(-0.3, 1.3), ylim=(-0.3, 1.3), zlim=(-0.9, 0.9))
        ax.view_init(elev=20, azim=-68)
    faces(row[0], POINTS[:4][FACES], ORANGE, 0.6, ORANGE)
    faces(row[1], POINTS[after[0]][FACES], BLUE, 0.2, BLUE)
    row[1].plot(*POINTS[4:].T, color=ORANGE, linewidth=3, zorder=8)


def ascent() -> None:
    """The smallest angles of the tetrahedra at a vertex while it moves along a line."""
    corners = np.array([(0, 0, 0), (1.3, 0.1, 0), (0.2, 1.1, 0.1), (0.4, 0.3, 1.2), (1, 0.9, 0.8)])
    hull = delone.ConvexHull(corners).simplices
    way = np.linspace(0.02, 0.98, 200)
    start, end = corners[hull[0]].mean(axis=0), corners[3:].mean(axis=0)
    angles = np.array(
        [
            [
                _smallest(np.vstack((corners[face], start + s * (end - start))), np.arange(4)[None])
                for face in hull
            ]
            for s in way
        ]
    )
    worst = angles.min(axis=1)
    _, ax = plt.subplots(figsize=(6, 3.4), layout="constrained")
    ax.plot(way, angles, color=GRAY, linewidth=1)
    ax.plot(way, worst, color=BLUE, linewidth=2.6, label="the smallest of all")
    best = int(worst.argmax())
    ax.plot(way[best], worst[best], "o", color=ORANGE, markersize=9, label="the best position")
    ax.set(
        xlabel="position of the vertex on a line", ylabel="smallest angle, degrees", ylim=(0, None)
    )
    ax.legend(frameon=False)
