"""A picture of constrained triangulations, drawn from what delone computes."""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

from delone import ConstrainedDelaunay, Delaunay, from_geometry

INK, PALE, ORANGE, RIM = "#16324f", "#b9c4ce", "#d9742b", "#b3372f"

# An island with a long bay in its north and a narrow one in its west.
COAST = [
    (0, 0), (4, -1), (9, -0.6), (12, 0.4), (12.6, 3.4), (11.4, 6.6), (8.6, 8.2), (7.4, 5.2),
    (6.2, 8), (3, 8.4), (0.6, 6.6), (3.6, 4.4), (-0.4, 4.8), (-1, 2.6),
]  # fmt: skip

Points = NDArray[np.float64]


def _coast(corners: Points, levels: int, rough: float, seed: int) -> Points:
    """Break each side of a ring in its middle, sideways, again and again."""
    random = np.random.default_rng(seed)
    ring = corners
    for _ in range(levels):
        step = np.roll(ring, -1, axis=0) - ring
        aside = step[:, ::-1] * (-1, 1) * random.uniform(-rough, rough, (len(ring), 1))
        middle = ring + step / 2 + aside
        ring = np.stack((ring, middle), axis=1).reshape(-1, 2)
    return ring


def island() -> None:
    """Segments; what Delaunay does to them; regions; the outline without the lake, conforming."""
    coast = _coast(np.array(COAST, dtype=float), 1, 0.16, 4)
    lake = _coast(np.array([(6.2, 2.4), (8.8, 2.2), (8.6, 4.1), (6.6, 4.4)]), 1, 0.2, 3)
    land = {"type": "Polygon", "coordinates": [coast.tolist(), lake.tolist()]}
    road = {"type": "LineString", "coordinates": [(-1.5, 2.2), (5, 1), (10.6, 1.4), (13.6, 4.6)]}
    both = [land, road]
    mesh = from_geometry(both)
    inside = from_geometry(both, boundary="outline", holes=[lake.mean(axis=0)], conforming=True)
    _, grid = plt.subplots(2, 2, figsize=(10, 7.9), layout="constrained")
    titles = (
        "Delaunay triangulation of the points;\norange: segments that are not edges",
        "constrained: all segments, bold, are edges;\na color for each region",
        'boundary="outline", and the lake a hole',
        "conforming: orange vertices make all\nsegments Delaunay edges",
    )
    only = from_geometry(both, boundary="outline", holes=[lake.mean(axis=0)])
    for ax, title in zip(grid.flat, titles, strict=True):
        ax.set_title(title, fontsize="medium")
    _plain(grid[0, 0], mesh)
    mesh.plot(grid[0, 1], vertices=False)
    only.plot(grid[1, 0], vertices=False)
    inside.plot(grid[1, 1], vertices=False)
    new = inside.points[only.npoints :]
    grid[1, 1].plot(*new.T, "o", color=ORANGE, markersize=3.2, zorder=5)
    for ax in grid.flat:
        ax.set(xlim=(-1.9, 14), ylim=(-1.6, 8.9))
        ax.set_axis_off()


def _plain(ax: plt.Axes, mesh: ConstrainedDelaunay) -> None:
    """The triangulation without constraints, and the segments that it lacks."""
    plain = Delaunay(mesh.points[: mesh.npoints - mesh.nadded])
    plain.plot(ax, vertices=False)
    there = set(map(tuple, plain.edges.tolist()))
    missing = [pair for pair in mesh.input_segments.tolist() if tuple(sorted(pair)) not in there]
    for pair in mesh.input_segments.tolist():
        color, width = (ORANGE, 2.6) if pair in missing else (INK, 1.4)
        ax.plot(*plain.points[pair].T, color=color, linewidth=width, zorder=4)
