"""A picture of quality meshes, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np

import delone


def island() -> None:
    """The triangulation of an outline; 30 degrees; a size that varies; its angles."""
    angle = np.arange(60) * 2 * np.pi / 60
    length = 4 * (1 + 0.28 * np.sin(3 * angle) + 0.12 * np.cos(7 * angle))
    ring = np.column_stack((length * np.cos(angle), length * np.sin(angle)))
    lake = np.array([(0.6, 0.2), (1.6, 0.5), (1.2, 1.4), (0.3, 1.1)])
    shape = {"type": "Polygon", "coordinates": [ring.tolist(), lake.tolist()]}
    _, grid = plt.subplots(2, 2, figsize=(10, 8.6), layout="constrained")
    delone.from_geometry(shape, boundary="polygons").plot(grid[0, 0], vertices=False)
    plain = delone.mesh(shape)
    plain.plot(grid[0, 1], vertices=False)
    fine = delone.mesh(shape, size=lambda xy: 0.12 + 0.16 * np.hypot(*(xy - (0.9, 0.8)).T))
    fine.plot(grid[1, 0], vertices=False)
    fine.plot_quality(grid[1, 1])
    titles = (
        "the constrained triangulation",
        f"no angle below 30 degrees: {plain.nsimplex} triangles",
        f"finer at the lake: {fine.nsimplex} triangles",
        "angles of the third mesh",
    )
    for ax, title in zip(grid.flat, titles, strict=True):
        ax.set_title(title, fontsize="medium")
        ax.set(xlabel=ax.get_xlabel() if ax is grid[1, 1] else "")
    for ax in grid.flat[:3]:
        ax.set_axis_off()
