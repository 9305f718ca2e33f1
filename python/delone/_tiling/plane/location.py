"""Point location in triangles: the nearest points of boundary edges, and walks along segments."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["Stretch", "across_line", "along", "located", "on_edges", "stretches"]


class Stretch(NamedTuple):
    """Consecutive triangles along a segment, all kept or all removed."""

    # In the numbering of the tiling of the hull.
    whole: Indices
    # In the numbering of kept triangles; -1 if they are removed.
    kept: Indices

    @property
    def is_kept(self) -> bool:
        """Whether they are kept."""
        return bool(self.kept[0] >= 0)


def located(
    index: _core.Locator2, xi: Floats, workers: int
) -> tuple[Indices, Floats, Indices, Indices, Floats]:
    """Locate points, (k, 2): the fields of `delone._tiling.location.Location` except `nearest`."""
    found = index.locate(xi, workers)
    weights = np.column_stack((1.0 - found.along, found.along))
    return found.simplex, found.weights, found.beside, found.edge, weights


def on_edges(points: Floats, edge: Indices, weights: Floats) -> Floats:
    """Return points on edges, (k, 2); if one of the two weights is 1, exactly that end."""
    start, end = points[edge[:, 0]], points[edge[:, 1]]
    return weights[:, :1] * start + weights[:, 1:] * end


def along(
    index: _core.Locator2,
    tiling: tuple[Floats, Indices, Indices],
    number: Indices | None,
    a: Floats,
    b: Floats,
) -> Indices:
    """Return the triangles along a segment from a to b, in the numbering of `number`.

    `index` and `tiling` are those of the whole hull. `number` contains the row of each triangle
    among those that are kept, -1 if removed and at the end; None keeps all. Unless it is None, a
    and b must differ.
    """
    kept = [part.kept for part in stretches(index, tiling, number, a, b) if part.is_kept]
    return np.concatenate([np.empty(0, dtype=np.int32), *kept])


def stretches(
    index: _core.Locator2,
    tiling: tuple[Floats, Indices, Indices],
    number: Indices | None,
    a: Floats,
    b: Floats,
) -> list[Stretch]:
    """Return the triangles like `along`, in parts, and the removed ones between them."""
    met = index.along(a, b)
    if number is None:
        return [Stretch(met, met)] if len(met) else []
    found = number[met]
    removed = found < 0
    found[removed] = number[across_line(*tiling, met[removed], a, b)]
    ends = np.flatnonzero(np.diff(found >= 0)) + 1
    pairs = zip(np.split(met, ends), np.split(found, ends), strict=True)
    return [Stretch(*pair) for pair in pairs if len(pair[0])]


def across_line(  # noqa: PLR0917 (a tiling is three arrays)
    points: Floats, simplices: Indices, neighbors: Indices, triangle: Indices, a: Floats, b: Floats
) -> Indices:
    """Return the neighbors of triangles across edges on the line through two points, -1 if none."""
    corners = points[simplices[triangle]].reshape(-1, 2)
    start, end = np.broadcast_to(a, corners.shape).copy(), np.broadcast_to(b, corners.shape).copy()
    off = (_core.orient2d(start, end, corners) != 0).reshape(-1, 3)
    found = neighbors[triangle, off.argmax(axis=1)]
    return np.where(off.sum(axis=1) == 1, found, np.int32(-1))
