"""Arcs and polygons of triangulations and diagrams of directions, for plots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["plot_diagram", "plot_mesh"]


def plot_mesh(mesh: Any, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
    """Draw a triangulation."""
    from delone.plot.globe import plot_globe

    tails, heads = (mesh.points[mesh.edges[:, k]] for k in (0, 1))
    return plot_globe(
        ax,
        points=mesh.points,
        arcs=_between(tails, heads),
        count=mesh.nsimplex,
        found=mesh.find_simplex,
        sites=points,
        **options,
    )


def plot_diagram(diagram: Any, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
    """Draw a diagram; there is a value for each row."""
    from delone.plot.globe import plot_globe

    sites, left = diagram.points, diagram._left
    if left is None:
        one, other = (sites[diagram.ridge_points[:, k]] for k in (0, 1))
        start = diagram.vertices[diagram.ridge_vertices[:, 0]]
        arcs = start, _toward(start, one - other), diagram.ridge_lengths / diagram.radius
        found = diagram._nearest
    else:
        arcs = _between(*(left.mesh.points[ends] for ends in left.border_edges()))
        cell = np.append(left.cell, np.int32(-1))

        def found(places: Floats) -> Indices:
            rows: Indices = cell[left.mesh._ask(places, left.mesh._locator.find)]
            return rows

    return plot_globe(
        ax,
        points=sites,
        arcs=arcs,
        count=diagram.npoints,
        found=found,
        sites=points,
        **options,
    )


def _between(tails: Floats, heads: Floats) -> tuple[Floats, Floats, Floats]:
    """Where arcs start, where they lead from there, and their lengths."""
    steps = heads - tails
    length = 2 * np.arcsin(np.minimum(np.linalg.norm(steps, axis=1) / 2, 1.0))
    return tails, _toward(tails, np.cross(tails, steps)), length


def _toward(start: Floats, normals: Floats) -> Floats:
    """The unit vectors at the start of arcs with these normals to their left."""
    ahead = np.cross(normals, start)
    found: Floats = ahead / np.maximum(np.linalg.norm(ahead, axis=1), 1e-300)[:, None]
    return found
