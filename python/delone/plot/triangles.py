"""2-D triangulations on axes: as triangles, or as an image if these are too small to see."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from delone._base.arrays import as_flag, as_optional_flag
from delone._base.extras import require
from delone._base.values import as_values
from delone.errors import InputError
from delone.plot import cartography
from delone.plot.axes import draw_dots, frame, new_axes, pixels, require_bounds, thin
from delone.plot.circles import bounds_with_circles, draw_circles, require_few
from delone.plot.colors import add_bar, as_cmap, scale, shaded, show
from delone.plot.protocols import hint, kind_of, segmented
from delone.plot.shading import facet_light, point_density, rasterize, relief
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats
    from delone.plot.protocols import Hulled, Triangles

__all__ = ["plot", "require_drawable", "require_flat"]

# A triangle of fewer pixels than this is not recognizable.
_VISIBLE = 14.0
_INK, _RIM = "#35506b", "#b3372f"


def plot(
    mesh: Triangles,
    ax: Any = None,
    *,
    z: ArrayLike | None = None,
    hull: bool = True,
    circumcircles: bool = False,
    vertices: bool | None = None,
    cmap: Any = None,
    shade: bool | None = None,
    colorbar: bool = True,
    title: str | None = None,
    segments: bool = True,
    edges: bool | None = None,
) -> Any:
    """Draw a 2-D triangulation; for the options see `delone.plot.plot`."""
    require("matplotlib", extra="plot", what="drawing")
    require_flat(mesh)
    for name, flag in {"hull": hull, "circumcircles": circumcircles, "segments": segments}.items():
        as_flag(flag, name=name)
    dots = as_optional_flag(vertices, name="vertices")
    lined = as_optional_flag(edges, name="edges")
    look: dict[str, Any] = {
        "cmap": as_cmap(cmap),
        "shade": as_optional_flag(shade, name="shade"),
        "colorbar": as_flag(colorbar, name="colorbar"),
    }
    if circumcircles:
        require_few(mesh)
    heights = as_values(z, mesh.npoints)
    require_drawable(mesh, heights)
    ax = new_axes(ax)
    _draw_areas(ax, mesh, heights, look, lined)
    constrained = segmented(mesh)
    if constrained is not None and segments:
        cartography.draw_segments(ax, constrained)
    if hull:
        _draw_hull(ax, mesh)
    if circumcircles:
        draw_circles(ax, mesh)
    draw_dots(ax, _dots(mesh), dots, count=mesh.npoints)
    low, high = bounds_with_circles(mesh) if circumcircles else (mesh.min_bound, mesh.max_bound)
    margin = 0.02 * float((mesh.max_bound - mesh.min_bound).max())
    frame(ax, low, high, title, margin=margin)
    return ax


def require_flat(mesh: Any) -> None:
    """Reject anything but a 2-D triangulation, and name what draws it."""
    kind = kind_of(mesh)
    if kind == "triangles":
        return
    if kind in {"tetrahedra", "cells3"}:
        instead = "delone.plot.plot draws it with PyVista"
    else:
        instead = "delone.plot.plot draws it" if kind else hint(mesh)
    name = f"{type(mesh).__module__}.{type(mesh).__name__}"
    raise InputError(f"a {name} is not a 2-D triangulation: {instead}")


def require_drawable(mesh: Triangles, heights: Floats | None) -> None:
    """Reject coordinates that overflow in matplotlib's transforms, and heights without effect."""
    if heights is not None and not (finite := np.isfinite(heights)).all():
        rows = np.flatnonzero(~finite)
        if mesh.nsimplex and not finite[mesh.simplices].all(axis=1).any():
            raise InputError(f"no triangle has a finite z at each corner; row {rows[0]} has none")
    require_bounds(mesh.min_bound, mesh.max_bound)


def _draw_areas(
    ax: Any, mesh: Triangles, z: Floats | None, look: dict[str, Any], lined: bool | None
) -> None:
    """Draw regions, the surface, or edges; as an image if the triangles are too small to see."""
    size = pixels(ax, mesh.min_bound, mesh.max_bound)
    # Areas are drawn as an image if triangles are too small to see; requested edges are drawn on
    # top.
    dense = size[0] * size[1] < _VISIBLE * mesh.nsimplex
    constrained = segmented(mesh)
    if constrained is not None and (z is None or not constrained.nsimplex):
        cartography.draw_regions(ax, constrained, max(size) if dense else None)
    elif dense:
        _draw_image(ax, mesh, z, size=max(size), **look)
    else:
        _draw_triangles(ax, mesh, z, lined is not False, **look)
        return
    if lined and dense:
        _draw_edges(ax, mesh, thin(mesh.nsimplex), _INK)


def _draw_image(
    ax: Any,
    mesh: Triangles,
    z: Floats | None,
    *,
    size: int,
    cmap: Any,
    shade: bool | None,
    colorbar: bool,
) -> None:
    if z is None:
        _draw_density(ax, mesh, size, cmap, colorbar)
        return
    raster = rasterize(mesh, z, size)
    mapped = scale(raster.values, cmap)
    rgba = mapped.to_rgba(raster.values)
    if shade or (shade is None and not colorbar):
        rgba[..., :3] = shaded(rgba[..., :3], relief(raster))
    rgba[..., 3] = np.isfinite(raster.values)
    show(ax, rgba, raster.extent)
    if colorbar:
        add_bar(ax, mapped, z, "z")


def _draw_density(ax: Any, mesh: Triangles, size: int, cmap: Any, colorbar: bool) -> None:
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    # A coarser grid than the screen's: otherwise, most cells would contain one point or none.
    fewer = int(np.clip(np.sqrt(mesh.npoints / 4), 50, size))
    raster = point_density(mesh, fewer)
    image = ax.imshow(
        raster.values,
        extent=raster.extent,
        origin="lower",
        cmap=cmap or "viridis",
        norm=colors.LogNorm() if np.nanmin(raster.values) < np.nanmax(raster.values) else None,
        interpolation="nearest",
        zorder=0,
    )
    if colorbar:
        ax.figure.colorbar(image, ax=ax, label="points per unit of area", shrink=0.75, pad=0.02)


def _draw_triangles(
    ax: Any,
    mesh: Triangles,
    z: Floats | None,
    lined: bool,
    *,
    cmap: Any,
    shade: bool | None,
    colorbar: bool,
) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    points, simplices = mesh.points, mesh.simplices
    width = thin(mesh.nsimplex)
    if z is None:
        if lined:
            _draw_edges(ax, mesh, width, _INK)
        return
    means = z[simplices].mean(axis=1)
    mapped = scale(means, cmap)
    rgba = mapped.to_rgba(means)
    if shade or (shade is None and not colorbar and len(simplices) >= 2000):
        rgba[:, :3] = shaded(rgba[:, :3], facet_light(points, z, simplices))
    rgba[~np.isfinite(means)] = 0
    facets = collections.PolyCollection(
        points[simplices], facecolors=rgba, edgecolors="face", linewidths=0.5 * width, zorder=1
    )
    ax.add_collection(facets, autolim=False)
    # Fainter where there are many, so that they do not darken the colors.
    if lined:
        _draw_edges(ax, mesh, 0.5 * width, (0, 0, 0, width / 3))
    if colorbar:
        add_bar(ax, mapped, means, "z")


def _draw_edges(ax: Any, mesh: Triangles, width: float, color: Any) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    lines = collections.LineCollection(
        mesh.points[mesh.edges], colors=[color], linewidths=width, zorder=1, gid=EDGES
    )
    ax.add_collection(lines, autolim=False)


def _draw_hull(ax: Any, mesh: Triangles) -> None:
    constrained = segmented(mesh)
    if constrained is not None:
        cartography.draw_boundary(ax, constrained, _RIM)
        return
    hull = cast("Hulled", mesh).hull
    ring = mesh.points[np.append(hull, hull[0])]
    ax.plot(*ring.T, color=_RIM, linewidth=1.4, solid_joinstyle="round", zorder=3)


def _dots(mesh: Triangles) -> Floats:
    """Return the points to draw: none where triangles have been removed."""
    if segmented(mesh) is None:
        return mesh.points
    found: Floats = mesh.points[np.unique(mesh.simplices)]
    return found
