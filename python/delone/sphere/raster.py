"""Rasters of longitudes and latitudes: the part of the sphere that they cover, and their nodes."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_number
from delone.interpolate.raster import raster_nodes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats
    from delone.sphere.delaunay import Delaunay

__all__ = ["globe_nodes"]

_POLES = ((0.0, 0.0, -1.0), (0.0, 0.0, 1.0))
# Longitudes shifted by a turn or converted from radians may miss whole degrees by this much.
_DIGITS = 13


def globe_nodes(
    mesh: Delaunay,
    lonlat: Floats,
    *,
    resolution: Any = None,
    shape: tuple[int, int] | None = None,
    bounds: Sequence[float] | None = None,
) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes of nodes in degrees, ascending.

    `lonlat` has the sites of the mesh in degrees. Without `bounds`, cells of a given resolution end
    at its multiples. Bounds may cross the date line: then the left one exceeds the right one.
    """
    if bounds is not None:
        bounds = [as_number(bound, name="bounds") for bound in bounds]
        if len(bounds) == 4 and bounds[0] > bounds[2]:
            bounds[2] += 360.0
        return raster_nodes(((), ()), resolution=resolution, shape=shape, bounds=bounds)
    poles = [mesh.covers_sphere or int(mesh.find_simplex(pole)) >= 0 for pole in _POLES]
    west, east = _longitudes(lonlat[:, 0], whole=any(poles))
    low = -90.0 if poles[0] else float(lonlat[:, 1].min())
    high = 90.0 if poles[1] else float(lonlat[:, 1].max())
    box = ((west, low), (east, high))
    nodes = raster_nodes(box, resolution=resolution, shape=shape)
    if shape is not None:
        return nodes
    sides = np.broadcast_to(np.asarray(resolution, dtype=np.float64), 2).tolist()
    across = _aligned(west, east, sides[0], whole=any(poles))
    up = _aligned(low, high, sides[1], whole=poles[0])
    return across, up[np.abs(up) <= 90.0]


def _longitudes(longitudes: Floats, *, whole: bool) -> tuple[float, float]:
    """The smallest interval of longitudes with all sites, or -180 to 180 for the whole turn."""
    if whole:
        west = -180.0 if (longitudes < 0).any() else 0.0
        return west, west + 360.0
    turned = np.unique(np.mod(longitudes + 180.0, 360.0) - 180.0)
    # If the widest gap is at least half a turn, all sites are on one side, and no pole is inside.
    gaps = np.diff(turned, append=turned[0] + 360.0)
    last = int(gaps.argmax())
    if last == len(turned) - 1:
        return float(turned[0]), float(turned[-1])
    return float(turned[last + 1]), float(turned[last] + 360.0)


def _aligned(low: float, high: float, side: float, *, whole: bool) -> Floats:
    """Centers of cells from `low` to `high` whose edges are multiples of their side.

    They are decimal numbers: each center is the double nearest to its decimal. If `whole`, cells
    start at `low`, and no center is at or beyond `high`.
    """
    step = Fraction(repr(side))
    first, last = (Fraction(f"{bound:.{_DIGITS}g}") for bound in (low, high))
    start = first if whole else step * math.floor(first / step)
    count = max(1, math.ceil((last - start) / step - (Fraction(1, 2) if whole else 0)))
    return np.array([float(start + step * (2 * k + 1) / 2) for k in range(count)])
