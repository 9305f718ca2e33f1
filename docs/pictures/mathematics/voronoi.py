"""Pictures of duals: a diagram over its triangulation, ties, and power cells."""

import numpy as np
from drawing import (
    BLUE,
    GRAY,
    INK,
    ORANGE,
    circle,
    circumcircle,
    dots,
    edges,
    fill,
    lines,
    panels,
    spread,
)
from matplotlib.axes import Axes

from delone import Delaunay, RegularTriangulation, Voronoi


def _cells(ax: Axes, diagram: Voronoi, color: str = ORANGE) -> None:
    for k in range(diagram.npoints):
        for ring, *_ in diagram.cell(k).parts:
            closed = np.vstack((ring, ring[:1]))
            ax.plot(*closed.T, color=color, linewidth=1.5)


def dual() -> None:
    """A triangle and its vertex, an edge and its ridge, a point and its cell."""
    points = spread(16, 8)
    mesh, diagram = Delaunay(points), Voronoi(points, clip=(-0.2, -0.2, 1.2, 1.2))
    titles = "a triangle: a vertex", "an edge: a ridge", "a point: a cell"
    row = panels(*titles)
    home = int(mesh.find_simplex((0.48, 0.5)))
    corners = mesh.simplices[home]
    center, radius = circumcircle(*points[corners])
    fill(row[0], [points[corners]], BLUE, 0.35)
    circle(row[0], center, radius, INK, linestyle=":")
    dots(row[0], center, ORANGE, 60)
    u, v = corners[:2]
    beside = mesh.simplices[(mesh.simplices == u).any(axis=1) & (mesh.simplices == v).any(axis=1)]
    ridge = [circumcircle(*points[t])[0] for t in beside]
    cell = diagram.cell(int(u)).parts[0][0]
    fill(row[2], [cell], ORANGE, 0.3)
    for ax in row:
        edges(ax, points, mesh.simplices, "#9dbcd3")
        _cells(ax, diagram, "#eab68f")
        dots(ax, points)
    lines(row[1], [points[[u, v]]], BLUE, linewidth=3)
    lines(row[1], [ridge], ORANGE, linewidth=3)
    dots(row[2], points[u], BLUE, 60)


def shared() -> None:
    """One vertex of many triangles: the edges that split a cocircular polygon have no ridge."""
    ring = [(5, 0), (4, 3), (0, 5), (-4, 3), (-5, 0), (-4, -3), (0, -5), (4, -3)]
    points = np.array([*ring, (9, 7), (-8, 8), (-9, -7), (8, -8)], dtype=float)
    mesh, diagram = Delaunay(points), Voronoi(points, clip=(-11, -11, 11, 11))
    (ax,) = panels("", width=4.2, height=4.2)
    edges(ax, points, mesh.simplices, BLUE)
    _cells(ax, diagram)
    circle(ax, (0, 0), 5, INK, linestyle=":")
    dots(ax, points)
    dots(ax, (0, 0), ORANGE, 60)


def power() -> None:
    """Cells without weights, and with them: circles whose squared radii are the weights."""
    points = spread(15, 21)
    radii = np.random.default_rng(4).uniform(0.03, 0.2, len(points))
    near = int(np.hypot(*(points - 0.5).T).argmin())
    radii[near] = 0.2
    points, radii = np.vstack((points, points[near] + (0.07, 0.05))), np.append(radii, 0.02)
    box = (-0.2, -0.2, 1.2, 1.2)
    left, right = panels("Voronoi cells", "power cells", width=4)
    _cells(left, Voronoi(points, clip=box))
    _cells(right, Voronoi(points, weights=radii**2, clip=box))
    mesh = RegularTriangulation(points, radii**2)
    edges(left, points, Delaunay(points).simplices, "#9dbcd3")
    edges(right, points, mesh.simplices, "#9dbcd3")
    for center, radius in zip(points, radii, strict=True):
        circle(right, center, radius, GRAY, linewidth=1)
    hidden = np.setdiff1d(np.arange(len(points)), mesh.simplices)
    for ax in (left, right):
        dots(ax, points)
    dots(right, points[hidden], INK, 40)
    dots(right, points[hidden], "white", 14)
