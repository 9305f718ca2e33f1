"""Outlines with holes as shapely polygons."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone._base.extras import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["to_polygons"]


class _Outline(Protocol):
    @property
    def coordinates(self) -> NDArray[np.float64]: ...

    @property
    def ring(self) -> NDArray[np.int64]: ...

    @property
    def nshells(self) -> int: ...

    @property
    def polygon(self) -> NDArray[np.int64]: ...


def to_polygons(outline: _Outline) -> NDArray[Any]:
    """Return a shapely polygon for each shell, in the order of shells."""
    shapely = require("shapely", extra="geo", what="polygons")
    if not outline.nshells:
        return np.empty(0, dtype=object)
    rings = shapely.linearrings(outline.coordinates, indices=outline.ring)
    shells, holes = rings[: outline.nshells], rings[outline.nshells :]
    found: NDArray[Any] = shapely.polygons(shells)
    # Only polygons with holes are created again, because shapely needs each number separately.
    for number in np.unique(outline.polygon):
        first, last = np.searchsorted(outline.polygon, (number, number + 1))
        found[number] = shapely.polygons(shells[number], holes=holes[first:last])
    return found
