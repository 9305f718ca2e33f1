"""Constrained triangulations as maps: a color for each region, bold lines for segments.

Regions take the colors of a palette in turn, the largest first, and skip those of their neighbors:
a greedy coloring, in the order of D. J. A. Welsh and M. B. Powell, "An upper bound for the
chromatic number of a graph and its application to timetabling problems", 1967, by area instead of
degree.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.plot.axes import thin
from delone.plot.colors import show
from delone.plot.shading import facet_values
from delone.plot.style import EDGES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone.plot.protocols import Segmented

__all__ = ["color_of_regions", "draw_boundary", "draw_regions", "draw_segments"]

_PALETTE = (
    "#c9dcea", "#f4dfae", "#c8e0bd", "#f0c9bd", "#d8cde8", "#bfe0dc", "#e9d3b7", "#dfe6a8",
    "#f3cfdd", "#cfd5db",
)  # fmt: skip
_NO_LABEL = "#f1f1f1"
_SEGMENT, _EDGE = "#16324f", "#5f6f7e"
# matplotlib's renderer fails on a single line with very many corners.
_PART = 20_000


def color_of_regions(mesh: Segmented) -> Indices:
    """Return the color of each triangle by its region, (m,), from 0 to 9; -1 without a label.

    Regions that share a segment differ, as long as there are enough colors. O(m log m) time, and a
    step of Python for each region.
    """
    region = mesh.region
    names, compact = np.unique(region, return_inverse=True)
    area = np.bincount(compact, weights=mesh.areas, minlength=len(names))
    start, beside = _adjacency(mesh, compact, len(names))
    color = np.full(len(names), -1, dtype=np.int32)
    turn = 0
    for i in np.lexsort((names, -area)).tolist():
        if names[i] < 0:
            continue
        taken = set(color[beside[start[i] : start[i + 1]]].tolist())
        free = (c % len(_PALETTE) for c in range(turn, turn + len(_PALETTE)))
        color[i] = next((c for c in free if c not in taken), turn % len(_PALETTE))
        turn = int(color[i]) + 1
    return color[compact]


def _adjacency(
    mesh: Segmented, compact: NDArray[np.intp], count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the neighbors of each region as compressed rows."""
    rows, corner = np.nonzero(mesh.neighbors >= 0)
    here, there = compact[rows], compact[mesh.neighbors[rows, corner]]
    keys = np.unique(here[here != there].astype(np.int64) * count + there[here != there])
    start = np.searchsorted(keys, np.arange(count + 1) * count)
    return start, keys % count


def draw_regions(ax: Any, mesh: Segmented, pixels: int | None) -> None:
    """Draw triangles in the colors of their regions, or an image of `pixels` on its longer side."""
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    # The last color is for triangles without a label, which have number -1.
    rgb = np.array([colors.to_rgb(each) for each in (*_PALETTE, _NO_LABEL)])
    color = color_of_regions(mesh)
    if pixels is None:
        _draw_facets(ax, mesh, rgb[color])
        return
    raster = facet_values(mesh, color, pixels)
    inside = np.isfinite(raster.values)
    rgba = np.zeros((*inside.shape, 4))
    rgba[inside, :3] = rgb[raster.values[inside].astype(np.int32)]
    rgba[inside, 3] = 1
    show(ax, rgba, raster.extent)


def _draw_facets(ax: Any, mesh: Segmented, rgb: Floats) -> None:
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    facets = collections.PolyCollection(
        mesh.points[mesh.simplices],
        facecolors=rgb,
        edgecolors=_EDGE,
        linewidths=thin(mesh.nsimplex, 0.8),
        zorder=1,
        gid=EDGES,
    )
    ax.add_collection(facets, autolim=False)


def draw_segments(ax: Any, mesh: Segmented) -> None:
    """Draw the subsegments on kept triangles as bold lines."""
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


def _kept_segments(mesh: Segmented) -> Indices:
    """Return the subsegments that are edges of kept triangles, in their order."""
    rows, corner = np.nonzero(mesh.constrained)
    ends = mesh.simplices[rows, (corner + 1) % 3], mesh.simplices[rows, (corner + 2) % 3]
    n = np.int64(mesh.npoints)
    wanted = np.minimum(*ends) * n + np.maximum(*ends)
    pairs = mesh.segments
    keys = pairs.min(axis=1, initial=mesh.npoints) * n + pairs.max(axis=1, initial=0)
    kept: Indices = pairs[np.isin(keys, wanted)]
    return kept


def _line(points: Floats, pairs: Indices) -> Floats:
    """Return one line through all pairs, with NaN between pairs that are not connected."""
    lifted = np.ones(len(pairs), dtype=bool)
    lifted[1:] = pairs[1:, 0] != pairs[:-1, 1]
    steps = np.column_stack((np.full(len(pairs), -1), pairs)).ravel()
    stays = np.column_stack((lifted, lifted, np.ones(len(pairs), dtype=bool))).ravel()
    vertex = steps[stays]
    line: Floats = points[vertex]
    line[vertex < 0] = np.nan
    return line


def draw_boundary(ax: Any, mesh: Segmented, color: str) -> None:
    """Draw the boundary edges that are not segments."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    rows, corner = np.nonzero((mesh.neighbors < 0) & ~mesh.constrained)
    ends = mesh.simplices[rows, (corner + 1) % 3], mesh.simplices[rows, (corner + 2) % 3]
    lines = collections.LineCollection(
        mesh.points[np.column_stack(ends)], colors=color, linewidths=1.4, zorder=2
    )
    ax.add_collection(lines, autolim=False)
