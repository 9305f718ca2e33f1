"""Pictures of surfaces filled with tetrahedra, drawn from what delone computes."""

from itertools import pairwise

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import delone

_SKIN, _CUT, _EDGE, _POINT = "#c6dbef", "#fdae6b", "#31536e", "#cb181d"
_FACES = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]


def flange(size: float = 0.16) -> tuple[np.ndarray, np.ndarray]:
    """Return a disk with five holes, as points and triangles seen from outside."""

    def ring(center: tuple[float, float], radius: float) -> np.ndarray:
        count = max(12, round(2 * np.pi * radius / size))
        turn = 2 * np.pi * np.arange(count) / count
        return np.array(center) + radius * np.column_stack((np.cos(turn), np.sin(turn)))

    around = [(0.95 * np.cos(t), 0.95 * np.sin(t)) for t in np.pi * (np.arange(4) / 2 + 0.25)]
    holes = [(0.0, 0.0), *around]
    rings = [ring((0, 0), 1.4), ring((0, 0), 0.5), *(ring(center, 0.22) for center in around)]
    start = np.cumsum([0, *map(len, rings)])
    segments = np.concatenate(
        [
            np.column_stack((np.arange(a, b), np.roll(np.arange(a, b), -1)))
            for a, b in pairwise(start.tolist())
        ]
    )
    top = delone.mesh(
        (np.concatenate(rings), segments), holes=holes, max_area=0.6 * size**2, fixed=True
    )
    n, height = top.npoints, 0.5
    points = np.column_stack((np.tile(top.points, (2, 1)), np.repeat((0.0, height), n)))
    # Edges of the boundary, with the mesh to their left.
    a, b = top.boundary.T
    walls = np.concatenate((np.stack((a, b, b + n), 1), np.stack((a, b + n, a + n), 1)))
    return points, np.concatenate((top.simplices[:, ::-1], top.simplices + n, walls))


def _draw(ax, points, triangles, **look) -> None:
    # Translucent triangles get no shade.
    shade = "alpha" not in look
    faces = Poly3DCollection(points[triangles], edgecolors=_EDGE, shade=shade, **look)
    ax.add_collection3d(faces)


def _frame(ax, points, zoom=1.3, **view) -> None:
    low, high = points.min(axis=0), points.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low, zoom=zoom)
    ax.view_init(**view)
    ax.set_axis_off()


def _axes(count: int, size: tuple[float, float]):
    _, row = plt.subplots(
        1, count, figsize=size, layout="constrained", subplot_kw={"projection": "3d"}
    )
    return row


def cut() -> None:
    """Draw a part, and its tetrahedra behind a plane."""
    points, faces = flange()
    mesh = delone.tetrahedralize(points, faces)
    left, right = _axes(2, (11, 4.0))
    _draw(left, points, faces, facecolors=_SKIN, linewidths=0.3)
    behind = mesh.points[mesh.simplices].mean(axis=1)[:, 1] > 0
    shown = mesh.simplices[behind][:, _FACES].reshape(-1, 3)
    keys = np.sort(shown, axis=1)
    _, first, count = np.unique(keys, axis=0, return_index=True, return_counts=True)
    outer = shown[first[count == 1]]
    skin = {tuple(sorted(face)) for face in mesh.input_faces.tolist()}
    own = np.array([tuple(sorted(face)) in skin for face in outer.tolist()])
    _draw(right, mesh.points, outer, facecolors=np.where(own, _SKIN, _CUT), linewidths=0.3)
    for ax in (left, right):
        _frame(ax, points, zoom=1.2, elev=38, azim=-70)
    left.set_title(f"{len(faces):,} triangles", fontsize="medium")
    right.set_title(f"{mesh.nsimplex:,} tetrahedra, cut open", fontsize="medium")


def schoenhardt() -> None:
    """Draw a Schoenhardt polyhedron, and the tetrahedra around its one point."""
    turn = 2 * np.pi * np.arange(3) / 3
    low = np.column_stack((np.cos(turn), np.sin(turn), np.zeros(3)))
    top = np.column_stack((np.cos(turn - np.pi / 6), np.sin(turn - np.pi / 6), np.full(3, 1.4)))
    points = np.concatenate((low, top))
    faces = [(0, 2, 1), (3, 4, 5)]
    for k in range(3):
        j = (k + 1) % 3
        faces += [(k, j, 3 + k), (j, 3 + j, 3 + k)]
    mesh = delone.tetrahedralize(points, faces)
    left, right = _axes(2, (9, 4.2))
    _draw(left, points, np.array(faces), facecolors=_SKIN, alpha=0.35, linewidths=1.2)
    center = mesh.points[6]
    for row in mesh.simplices:
        corners = mesh.points[row]
        apart = corners + 1.1 * (corners.mean(axis=0) - center)
        _draw(right, apart, np.array(_FACES), facecolors=_SKIN, alpha=0.6, linewidths=0.8)
        right.scatter(*apart[row == 6].T, color=_POINT, s=14, depthshade=False, zorder=10)
    left.scatter(*center, color=_POINT, s=40, depthshade=False, zorder=10)
    left.computed_zorder = right.computed_zorder = False
    _frame(left, points, zoom=1.2, elev=14, azim=-40)
    _frame(right, points * 1.7 - (0, 0, 0.5), zoom=1.3, elev=14, azim=-40)
    left.set_title("8 triangles, and the one point that they need", fontsize="medium")
    right.set_title(f"{mesh.nsimplex} tetrahedra around it, moved apart", fontsize="medium")


def sizes() -> None:
    """Draw a box with tetrahedra of one size, and with small ones near a corner."""
    corners = np.stack(np.meshgrid((0, 4), (0, 3), (0, 2), indexing="ij"), axis=-1).reshape(-1, 3)
    hull = delone.ConvexHull(corners)

    def near(positions: np.ndarray) -> np.ndarray:
        return 0.15 + 0.25 * np.linalg.norm(positions - (0, 0, 2), axis=1)

    for ax, size in zip(_axes(2, (11, 4.0)), (0.5, near), strict=True):
        mesh = delone.tetrahedralize(hull.points, hull.simplices, boundary="surface", size=size)
        behind = mesh.points[mesh.simplices].mean(axis=1)[:, 1] > 1
        shown = mesh.simplices[behind][:, _FACES].reshape(-1, 3)
        _, first, count = np.unique(
            np.sort(shown, axis=1), axis=0, return_index=True, return_counts=True
        )
        outer = shown[first[count == 1]]
        skin = {tuple(sorted(face)) for face in mesh.input_faces.tolist()}
        own = np.array([tuple(sorted(face)) in skin for face in outer.tolist()])
        _draw(ax, mesh.points, outer, facecolors=np.where(own, _SKIN, _CUT), linewidths=0.3)
        _frame(ax, mesh.points, elev=22, azim=-70)
