"""Arcs and polygons of triangulations and diagrams of directions, for pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["plot_diagram", "plot_mesh"]


def plot_mesh(mesh: Any, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
    """Draw a triangulation."""
    from delone.plot.globe import plot_globe

    tails, heads = (mesh.points[mesh.edges[:, k]] for k in (0, 1))
    steps = heads - tails
    length = 2 * np.arcsin(np.minimum(np.linalg.norm(steps, axis=1) / 2, 1.0))
    return plot_globe(
        ax,
        points=mesh.points,
        arcs=(tails, _towards(tails, np.cross(tails, steps)), length),
        count=mesh.nsimplex,
        found=mesh.find_simplex,
        sites=points,
        **options,
    )


def plot_diagram(diagram: Any, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
    """Draw a diagram; values are those of rows."""
    from delone.plot.globe import plot_globe

    mesh, sites = diagram.triangulation, diagram.points

    def found(places: Floats) -> Indices:
        if mesh is not None:
            rows: Indices = mesh.nearest(places)
            return rows
        near = [(part @ sites.T).argmax(axis=1) for part in np.array_split(places, 1000)]
        return np.concatenate(near).astype(np.int32)

    left, right = (sites[diagram.ridge_points[:, k]] for k in (0, 1))
    start = diagram.vertices[diagram.ridge_vertices[:, 0]]
    return plot_globe(
        ax,
        points=sites,
        arcs=(start, _towards(start, left - right), diagram.ridge_lengths / diagram.radius),
        count=diagram.npoints,
        found=found,
        sites=points,
        **options,
    )


def _towards(start: Floats, normals: Floats) -> Floats:
    """The unit vectors at the start of arcs with these normals to their left."""
    ahead = np.cross(normals, start)
    found: Floats = ahead / np.maximum(np.linalg.norm(ahead, axis=1), 1e-300)[:, None]
    return found
