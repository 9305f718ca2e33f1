"""Constrained triangulations drawn as maps: a colour for each region, bold lines for segments.

Regions take the colours of a palette in turn, the largest first, and skip those that a neighbour
has: a greedy colouring, in the order of D. J. A. Welsh and M. B. Powell, "An upper bound for the
chromatic number of a graph and its application to timetabling problems", 1967, by area in place of
degree. What needs a matplotlib gets its axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.extras import require
from delone.plot.shading import facet_values

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.constrained.delaunay import ConstrainedDelaunay
    from delone.refine.meshed import Mesh

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["colour_of_regions", "draw_boundary", "draw_regions", "draw_segments"]

_PALETTE = (
    "#c9dcea", "#f4dfae", "#c8e0bd", "#f0c9bd", "#d8cde8", "#bfe0dc", "#e9d3b7", "#dfe6a8",
    "#f3cfdd", "#cfd5db",
)  # fmt: skip
_NO_LABEL = "#f1f1f1"
_SEGMENT, _EDGE = "#16324f", "#5f6f7e"
# matplotlib's renderer gives up on a single line of very many corners.
_PART = 20_000


def colour_of_regions(mesh: ConstrainedDelaunay | Mesh) -> Indices:
    """Choose a colour for each triangle, by its region.

    Parameters
    ----------
    mesh : ConstrainedDelaunay or Mesh
        The triangulation.

    Returns
    -------
    ndarray of int32, shape (m,)
        Numbers of colours from 0 to 9, -1 for triangles without a label.

    Notes
    -----
    Regions that share a segment differ, as long as the colours go round. Linear but for a sort, and
    a step of Python for each region.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> from delone.plot.cartography import colour_of_regions
    >>> mesh = ConstrainedDelaunay([(0, 0), (3, 0), (3, 1), (0, 1)], [(0, 2)])
    >>> sorted(colour_of_regions(mesh).tolist())
    [0, 1]
    """
    region = mesh.region
    names, compact = np.unique(region, return_inverse=True)
    area = np.bincount(compact, weights=mesh.areas, minlength=len(names))
    start, beside = _adjacency(mesh, compact, len(names))
    colour = np.full(len(names), -1, dtype=np.int32)
    turn = 0
    for i in np.lexsort((names, -area)).tolist():
        if names[i] < 0:
            continue
        taken = set(colour[beside[start[i] : start[i + 1]]].tolist())
        free = (c % len(_PALETTE) for c in range(turn, turn + len(_PALETTE)))
        colour[i] = next((c for c in free if c not in taken), turn % len(_PALETTE))
        turn = int(colour[i]) + 1
    return colour[compact]


def _adjacency(
    mesh: ConstrainedDelaunay | Mesh, compact: NDArray[np.intp], count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the regions beside each region as compressed rows."""
    rows, corner = np.nonzero(mesh.neighbors >= 0)
    here, there = compact[rows], compact[mesh.neighbors[rows, corner]]
    keys = np.unique(here[here != there].astype(np.int64) * count + there[here != there])
    start = np.searchsorted(keys, np.arange(count + 1) * count)
    return start, keys % count


def draw_regions(ax: Any, mesh: ConstrainedDelaunay | Mesh, pixels: int | None) -> None:
    """Draw the triangles in the colours of their regions.

    Parameters
    ----------
    ax : matplotlib Axes
        Where to draw.
    mesh : ConstrainedDelaunay or Mesh
        What to draw.
    pixels : int or None
        Draw an image with so many pixels along its longer side, or triangles for None.
    """
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    # The colour of what has no label is the last one, which -1 stands for.
    rgb = np.array([colors.to_rgb(each) for each in (*_PALETTE, _NO_LABEL)])
    colour = colour_of_regions(mesh)
    if pixels is None:
        _draw_facets(ax, mesh, rgb[colour])
        return
    raster = facet_values(mesh, colour, pixels)
    inside = np.isfinite(raster.values)
    rgba = np.zeros((*inside.shape, 4))
    rgba[inside, :3] = rgb[raster.values[inside].astype(np.int32)]
    rgba[inside, 3] = 1
    image = np.round(rgba * 255).astype(np.uint8)
    ax.imshow(image, extent=raster.extent, origin="lower", interpolation="auto", zorder=0)


def _draw_facets(ax: Any, mesh: ConstrainedDelaunay | Mesh, rgb: Floats) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    facets = collections.PolyCollection(
        mesh.points[mesh.simplices],
        facecolors=rgb,
        edgecolors=_EDGE,
        linewidths=_thin(mesh.nsimplex),
        zorder=1,
    )
    ax.add_collection(facets, autolim=False)


def _thin(count: int) -> float:
    return float(np.clip(30 / np.sqrt(max(count, 1)), 0.15, 0.8))


def draw_segments(ax: Any, mesh: ConstrainedDelaunay | Mesh) -> None:
    """Draw the subsegments at kept triangles as bold lines.

    Parameters
    ----------
    ax : matplotlib Axes
        Where to draw.
    mesh : ConstrainedDelaunay or Mesh
        What to draw.
    """
    pairs = _kept_segments(mesh)
    width = float(np.clip(90 / np.sqrt(max(len(pairs), 1)), 0.6, 2.4))
    for start in range(0, len(pairs), _PART):
        line = _line(mesh.points, pairs[start : start + _PART])
        ax.plot(
            *line.T,
            color=_SEGMENT,
            linewidth=width,
            solid_capstyle="round",
            solid_joinstyle="round",
            scalex=False,
            scaley=False,
            zorder=3,
            gid="segments",
        )


def _kept_segments(mesh: ConstrainedDelaunay | Mesh) -> Indices:
    """Return the subsegments that a kept triangle has for an edge, in their order."""
    rows, corner = np.nonzero(mesh.constrained)
    ends = mesh.simplices[rows, (corner + 1) % 3], mesh.simplices[rows, (corner + 2) % 3]
    n = np.int64(mesh.npoints)
    wanted = np.minimum(*ends) * n + np.maximum(*ends)
    pairs = mesh.segments
    keys = pairs.min(axis=1, initial=mesh.npoints) * n + pairs.max(axis=1, initial=0)
    kept: Indices = pairs[np.isin(keys, wanted)]
    return kept


def _line(points: Floats, pairs: Indices) -> Floats:
    """Return one line through all pairs, NaN where it is lifted: most pairs follow each other."""
    lifted = np.ones(len(pairs), dtype=bool)
    lifted[1:] = pairs[1:, 0] != pairs[:-1, 1]
    steps = np.column_stack((np.full(len(pairs), -1), pairs)).ravel()
    stays = np.column_stack((lifted, lifted, np.ones(len(pairs), dtype=bool))).ravel()
    vertex = steps[stays]
    line: Floats = points[vertex]
    line[vertex < 0] = np.nan
    return line


def draw_boundary(ax: Any, mesh: ConstrainedDelaunay | Mesh, color: str) -> None:
    """Draw those edges on the boundary that are no segments.

    Parameters
    ----------
    ax : matplotlib Axes
        Where to draw.
    mesh : ConstrainedDelaunay or Mesh
        What to draw.
    color : str
        The colour of the lines.
    """
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    rows, corner = np.nonzero((mesh.neighbors < 0) & ~mesh.constrained)
    ends = mesh.simplices[rows, (corner + 1) % 3], mesh.simplices[rows, (corner + 2) % 3]
    lines = collections.LineCollection(
        mesh.points[np.column_stack(ends)], colors=color, linewidths=1.4, zorder=2
    )
    ax.add_collection(lines, autolim=False)
