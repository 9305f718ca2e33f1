"""Triangulations drawn on axes: as triangles, or where these are too small to be seen an image."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from delone._arrays import as_flag, as_optional_flag
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InputError
from delone.extras import require
from delone.io.heights import as_values
from delone.plot import cartography
from delone.plot.colours import add_bar, scale, shaded
from delone.plot.shading import Raster, facet_light, point_density, rasterize, relief
from delone.refine.meshed import Mesh as QualityMesh

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.delaunay import Delaunay

    Floats = NDArray[np.float64]
    Mesh: TypeAlias = Delaunay | ConstrainedDelaunay | QualityMesh

__all__ = ["plot", "require_drawable", "require_flat"]

# A triangle of fewer pixels than this is no triangle to the eye.
_VISIBLE = 14.0
_MOST_CIRCLES = 3000
_FEW_CIRCLES = 60  # so few that each is to be seen whole, with its centre
_DRAWABLE = 1e-305, 1e305  # matplotlib scales and pads by factors of up to a hundred
_MOST_DOTS = 2000
_INK, _RIM, _DOT, _CIRCLE = "#35506b", "#b3372f", "#17324d", "#d98b2b"

_SEGMENTED = (ConstrainedDelaunay, QualityMesh)


def plot(
    triangulation: Mesh,
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
) -> Any:
    """Draw a triangulation.

    Parameters
    ----------
    triangulation : Delaunay, RegularTriangulation, ConstrainedDelaunay or Mesh, in the plane
        What to draw.
    ax : matplotlib Axes, optional
        Where to draw; by default on the axes of a new pyplot figure.
    z : array_like of float, shape (n,), optional
        Heights: triangles are coloured by them.
    hull : bool, optional
        Draw the convex hull; of a constrained triangulation the boundary, where it is no segment.
    circumcircles : bool, optional
        Draw the circle through the corners of each triangle, for up to 3000 triangles.
    vertices : bool, optional
        Draw the points. By default where there are few enough to be told apart.
    cmap : str or matplotlib Colormap, optional
        Colours of z. By default those of land, or of water where nothing lies above zero.
    shade : bool, optional
        Add light and shadow to the colors of z. They then differ from those of the color bar, so
        this is for terrain. By default only with ``colorbar=False``, and where there are 2000
        triangles or more.
    colorbar : bool, optional
        Add the scale of the colours.
    title : str, optional
        Title of the axes.
    segments : bool, optional
        Draw the segments of a constrained triangulation as bold lines.

    Returns
    -------
    matplotlib Axes
        What was drawn on.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    InputError
        `triangulation` is none in the plane; `z` has the wrong length or no finite value; there
        are too many triangles for circles.

    Notes
    -----
    Triangles smaller than 14 pixels on average are drawn as an image: the surface of z, or without
    z the density of points. Colours reach from the first to the last but one hundredth of the
    values; beyond that they stay.

    A `ConstrainedDelaunay` without z has its regions in colours, such that those at one segment
    differ; triangles without a label are grey, holes stay white.

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from delone import Delaunay
    >>> from delone.plot import plot
    >>> ax = plot(Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]), circumcircles=True)
    >>> ax.get_aspect()
    1.0
    """
    require("matplotlib", extra="plot", what="drawing")
    require_flat(triangulation)
    for name, flag in {"hull": hull, "circumcircles": circumcircles, "segments": segments}.items():
        as_flag(flag, name=name)
    as_optional_flag(vertices, name="vertices")
    if circumcircles and triangulation.nsimplex > _MOST_CIRCLES:
        raise InputError(
            f"the circles of {triangulation.nsimplex} triangles would hide each other; "
            f"circumcircles is for up to {_MOST_CIRCLES}"
        )
    heights = as_values(z, triangulation.npoints)
    require_drawable(triangulation, heights)
    if ax is None:
        _, ax = require("matplotlib.pyplot", extra="plot", what="drawing").subplots()
    look: dict[str, Any] = {
        "cmap": cmap,
        "shade": as_optional_flag(shade, name="shade"),
        "colorbar": as_flag(colorbar, name="colorbar"),
    }
    pixels = _pixels(ax, triangulation)
    dense = _is_dense(triangulation, pixels)
    constrained = triangulation if isinstance(triangulation, _SEGMENTED) else None
    if constrained is not None and (heights is None or not constrained.nsimplex):
        cartography.draw_regions(ax, constrained, max(pixels) if dense else None)
    elif dense:
        _draw_image(ax, triangulation, heights, pixels=max(pixels), **look)
    else:
        _draw_triangles(ax, triangulation, heights, **look)
    if constrained is not None and segments:
        cartography.draw_segments(ax, constrained)
    if hull:
        _draw_hull(ax, triangulation)
    if circumcircles:
        _draw_circles(ax, triangulation)
    if vertices or (vertices is None and triangulation.npoints <= _MOST_DOTS):
        _draw_dots(ax, _dots(triangulation))
    _finish(ax, triangulation, circumcircles, title)
    return ax


def require_flat(triangulation: Mesh) -> None:
    """Refuse what is no triangulation of delone in the plane, and say what draws it."""
    corners = np.shape(getattr(triangulation, "simplices", ()))[1:]
    if corners == (3,) and hasattr(triangulation, "edges") and hasattr(triangulation, "min_bound"):
        return
    kind = type(triangulation)
    if getattr(triangulation, "ndim", 2) == 3 and corners:
        raise InputError(
            f"this {kind.__name__} is in space, and matplotlib draws what is in the plane: "
            "use delone.scene"
        )
    own = hasattr(triangulation, "plot")
    hint = "use its own plot()" if own else "draw delone.Delaunay(points)"
    raise InputError(
        f"{kind.__module__}.{kind.__name__} is no triangulation in the plane that can be drawn: "
        f"{hint}"
    )


def require_drawable(triangulation: Mesh, heights: Floats | None) -> None:
    """Refuse what matplotlib's transforms overflow on, and heights of which nothing shows."""
    if heights is not None and not (finite := np.isfinite(heights)).all():
        rows = np.flatnonzero(~finite)
        if triangulation.nsimplex and not finite[triangulation.simplices].all(axis=1).any():
            raise InputError(f"no triangle has a finite z at each corner; row {rows[0]} has none")
    far = max(np.abs(triangulation.min_bound).max(), np.abs(triangulation.max_bound).max())
    # Halves, since the extent itself may overflow.
    near = (triangulation.max_bound / 2 - triangulation.min_bound / 2).max()
    if far > _DRAWABLE[1] or near < _DRAWABLE[0]:
        raise InputError(
            "a picture cannot hold coordinates beyond 1e305 or an extent below 1e-305; "
            "multiply the points by a power of two first, which changes no triangle"
        )


def _pixels(ax: Any, triangulation: Mesh) -> tuple[int, int]:
    """Return the pixels that the data will have across and up."""
    box = ax.get_window_extent()
    width, height = (triangulation.max_bound - triangulation.min_bound).tolist()
    scale = min(box.width / width, box.height / height)
    return max(1, round(width * scale)), max(1, round(height * scale))


def _is_dense(triangulation: Mesh, pixels: tuple[int, int]) -> bool:
    return pixels[0] * pixels[1] < _VISIBLE * triangulation.nsimplex


def _draw_image(
    ax: Any,
    triangulation: Mesh,
    z: Floats | None,
    *,
    pixels: int,
    cmap: Any,
    shade: bool | None,
    colorbar: bool,
) -> None:
    if z is None:
        _draw_density(ax, triangulation, pixels, cmap, colorbar)
        return
    raster = rasterize(triangulation, z, pixels)
    colours = scale(raster.values, cmap)
    rgba = colours.to_rgba(raster.values)
    if shade or (shade is None and not colorbar):
        rgba[..., :3] = shaded(rgba[..., :3], relief(raster))
    rgba[..., 3] = np.isfinite(raster.values)
    _show(ax, raster, rgba)
    if colorbar:
        add_bar(ax, colours, z, "z")


def _draw_density(ax: Any, triangulation: Mesh, pixels: int, cmap: Any, colorbar: bool) -> None:
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    # A coarser grid than the screen's: else most of it would be one point or none.
    fewer = int(np.clip(np.sqrt(triangulation.npoints / 4), 50, pixels))
    raster = point_density(triangulation, fewer)
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


def _show(ax: Any, raster: Raster, rgba: Floats) -> None:
    image = np.round(rgba * 255).astype(np.uint8)
    ax.imshow(image, extent=raster.extent, origin="lower", interpolation="auto", zorder=0)


def _draw_triangles(
    ax: Any,
    triangulation: Mesh,
    z: Floats | None,
    *,
    cmap: Any,
    shade: bool | None,
    colorbar: bool,
) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    points, simplices = triangulation.points, triangulation.simplices
    thin = float(np.clip(30 / np.sqrt(triangulation.nsimplex), 0.15, 1.0))
    if z is None:
        lines = collections.LineCollection(
            points[triangulation.edges], colors=_INK, linewidths=thin, zorder=1
        )
        ax.add_collection(lines, autolim=False)
        return
    means = z[simplices].mean(axis=1)
    colours = scale(means, cmap)
    rgba = colours.to_rgba(means)
    if shade or (shade is None and not colorbar and len(simplices) >= 2000):
        rgba[:, :3] = shaded(rgba[:, :3], facet_light(points, z, simplices))
    rgba[~np.isfinite(means)] = 0
    facets = collections.PolyCollection(
        points[simplices], facecolors=rgba, edgecolors="face", linewidths=0.5 * thin, zorder=1
    )
    ax.add_collection(facets, autolim=False)
    # Fainter where there are many, so that they do not darken the colors.
    lines = collections.LineCollection(
        points[triangulation.edges], colors=[(0, 0, 0, thin / 3)], linewidths=0.5 * thin, zorder=1
    )
    ax.add_collection(lines, autolim=False)
    if colorbar:
        add_bar(ax, colours, means, "z")


def _draw_hull(ax: Any, triangulation: Mesh) -> None:
    if isinstance(triangulation, _SEGMENTED):
        cartography.draw_boundary(ax, triangulation, _RIM)
        return
    ring = triangulation.points[np.append(triangulation.hull, triangulation.hull[0])]
    ax.plot(*ring.T, color=_RIM, linewidth=1.4, solid_joinstyle="round", zorder=3)


def _draw_circles(ax: Any, triangulation: Mesh) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    centres, radii = _circles(triangulation)
    circles = collections.EllipseCollection(
        2 * radii,
        2 * radii,
        np.zeros(len(radii)),
        units="xy",
        offsets=centres,
        transOffset=ax.transData,
        facecolors="none",
        edgecolors=_CIRCLE,
        linewidths=0.7,
        alpha=0.8,
        zorder=2,
    )
    ax.add_collection(circles, autolim=False)
    if len(centres) <= _FEW_CIRCLES:
        ax.plot(*centres.T, "+", color=_CIRCLE, markersize=5, scalex=False, scaley=False, zorder=2)


def _circles(triangulation: Mesh) -> tuple[Floats, Floats]:
    centres = triangulation.circumcenters
    corner = triangulation.points[triangulation.simplices[:, 0]]
    radii = np.hypot(*(centres - corner).T)
    drawn = np.isfinite(centres).all(axis=1) & np.isfinite(radii)
    return centres[drawn], radii[drawn]


def _dots(triangulation: Mesh) -> Floats:
    """Return the points to be drawn: none that lies where triangles have been removed."""
    if isinstance(triangulation, ConstrainedDelaunay):
        return triangulation.points[np.unique(triangulation.simplices)]
    return triangulation.points


def _draw_dots(ax: Any, points: Floats) -> None:
    size = float(np.clip(60 / np.sqrt(max(len(points), 1)), 0.8, 5.0))
    ax.plot(*points.T, "o", color=_DOT, markersize=size, markeredgewidth=0, zorder=4)


def _finish(ax: Any, triangulation: Mesh, circumcircles: bool, title: str | None) -> None:
    """Set limits, aspect and ticks that say the coordinates as they are."""
    ticker = require("matplotlib.ticker", extra="plot", what="drawing")
    low, high = triangulation.min_bound, triangulation.max_bound
    margin = 0.02 * float((high - low).max())
    if circumcircles:
        # Circles of flat triangles may be as large as they like; the points must stay visible.
        centres, radii = _circles(triangulation)
        share = 1.0 if len(radii) <= _FEW_CIRCLES else 0.15
        limit = share * float((high - low).max())
        low = np.maximum((centres - radii[:, None]).min(axis=0, initial=np.inf), low - limit)
        high = np.minimum((centres + radii[:, None]).max(axis=0, initial=-np.inf), high + limit)
        low, high = (
            np.minimum(low, triangulation.min_bound),
            np.maximum(high, triangulation.max_bound),
        )
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    largest = float(np.abs((low, high)).max())
    plain = largest == 0 or 1e-4 < largest < 1e9
    across, up = _pixels(ax, triangulation)
    # Side by side a label needs about an inch, so that long coordinates do not run into each other.
    for axis, pixels, inches in ((ax.xaxis, across, 1.0), (ax.yaxis, up, 0.5)):
        bins = int(np.clip(pixels / ax.figure.dpi / inches, 1, 7))
        axis.set_major_locator(ticker.MaxNLocator(nbins=bins, steps=[1, 2, 5, 10]))
        formatter = ticker.ScalarFormatter(useOffset=False)
        formatter.set_scientific(not plain)
        axis.set_major_formatter(formatter)
    if title:
        ax.set_title(title, fontsize="medium")
