"""Pictures of surfaces and the faces that cross, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

import delone

_PLAIN, _OTHER, _BAD = "#c6dbef", "#fdd0a2", "#cb181d"


def _torus(turns: int, around: int) -> tuple[np.ndarray, np.ndarray]:
    i, j = (a.ravel() for a in np.meshgrid(np.arange(turns), np.arange(around), indexing="ij"))
    u, v = 2 * np.pi * i / turns, 2 * np.pi * j / around
    r = 1 + 0.38 * np.cos(v)
    points = np.column_stack((r * np.cos(u), r * np.sin(u), 0.38 * np.sin(v)))
    a, b = i * around + j, (i + 1) % turns * around + j
    c, d = i * around + (j + 1) % around, (i + 1) % turns * around + (j + 1) % around
    return points, np.concatenate((np.stack((a, b, c), 1), np.stack((b, d, c), 1)))


def crossing() -> None:
    """Draw two tori: linked, and pushed into each other, with the faces that cross."""
    points, faces = _torus(40, 18)
    upright = points[:, [0, 2, 1]] * (1, -1, 1)
    _, row = plt.subplots(
        1, 2, figsize=(11, 4.6), layout="constrained", subplot_kw={"projection": "3d"}
    )
    for ax, shift in zip(row, (1.0, 0.55), strict=True):
        both = np.concatenate((points, upright + np.array((shift, 0, 0))))
        rows = np.concatenate((faces, faces + len(points)))
        check = delone.check_surface(both, rows)
        colors = np.repeat(np.array([_PLAIN, _OTHER]), len(faces))
        colors[check.pairs[check.crossing].ravel()] = _BAD
        ax.add_collection3d(
            Poly3DCollection(both[rows], facecolors=colors, edgecolors="#4a6984", linewidths=0.2)
        )
        low, high = both.min(axis=0), both.max(axis=0)
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        ax.set_box_aspect(high - low, zoom=1.3)
        ax.view_init(elev=28, azim=-62)
        ax.set_axis_off()
        what = f"{check.nregions} regions, volume {check.volume:.2f}" if check else "not valid"
        ax.set_title(f"{check.ncrossing} pairs of faces cross: {what}", fontsize="medium")
