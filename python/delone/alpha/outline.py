"""The rings around triangles, sorted: shells, and the holes of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Outline", "rings_of"]


@dataclass(frozen=True, eq=False)
class Outline:
    """Closed rings: their coordinates, the ring of each, and the polygon of each hole."""

    coordinates: Floats  # (c, 2): shells, then holes, the first point of each repeated
    ring: NDArray[np.int64]  # (c,)
    nshells: int
    polygon: NDArray[np.int64]  # (holes,), ascending


def rings_of(points: Floats, simplices: Indices, neighbors: Indices, labels: Indices) -> Outline:
    """Return the rings of triangles with the given parts, sorted."""
    vertices, starts, parts, outer = _core.alpha_rings2(points, simplices, neighbors, labels)
    first, second = points[vertices[starts[:-1]]], points[vertices[starts[:-1] + 1]]
    rank = np.empty(len(parts), dtype=np.int64)
    keys = second[:, 1], second[:, 0], first[:, 1], first[:, 0]
    rank[np.lexsort(keys)] = np.arange(len(parts))
    shells = np.flatnonzero(outer)
    shells = shells[np.argsort(rank[shells])]
    of_part = np.zeros(len(parts), dtype=np.int64)
    of_part[parts[shells]] = np.arange(len(shells))
    holes = np.flatnonzero(~outer)
    holes = holes[np.lexsort((rank[holes], of_part[parts[holes]]))]
    order = np.concatenate((shells, holes))
    sizes = np.diff(starts)[order]
    # Each ring, with its first point repeated at the end.
    ring = np.repeat(np.arange(len(order)), sizes + 1)
    begin = np.cumsum(sizes + 1) - (sizes + 1)
    within = np.arange(len(ring)) - begin[ring]
    at = vertices[starts[:-1][order][ring] + within % sizes[ring]] if len(ring) else vertices[:0]
    return Outline(points[at], ring, len(shells), of_part[parts[holes]])
