"""Simplices of second order: a node in the middle of each edge, the same for all that share it.

Nodes are the points, then one for each edge, in the order of the edges by their points. Those of a
simplex are its corners and then its edges, in VTK's order, which meshio also uses.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError
from delone.exchange.parts import Parts

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from delone._base.types import Indices

__all__ = ["SIDES", "as_order", "middles", "of_order"]

# The edges of a segment, triangle and tetrahedron, by corners, in VTK's order.
SIDES: dict[int, tuple[tuple[int, int], ...]] = {
    2: ((0, 1),),
    3: ((0, 1), (1, 2), (2, 0)),
    4: ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
}


def as_order(order: Any) -> int:
    """Return the order of elements, 1 or 2."""
    if isinstance(order, int | np.integer) and order in (1, 2) and order is not True:
        return int(order)
    raise InputError(f"order must be 1 or 2, got {order!r:.60}: there are no higher elements")


def of_order(parts: Parts, order: int, of_nodes: Mapping[str, NDArray[Any]] | None = None) -> Parts:
    """Return parts of that order; `of_nodes` are further values of all nodes.

    In the middle of an edge, real values of points are the means of both ends. Markers are those
    of the segment or face with this edge; other whole numbers are 0.
    """
    if order in (1, parts.order):
        return parts
    if "row" in parts.of_points:
        raise InputError("triangles that share no points have no edges in common: pass order=1")
    edges, (of_simplices, of_segments) = middles(parts)
    n, segments = len(parts.points), parts.segments
    values = {name: _extended(own, edges) for name, own in parts.of_points.items()}
    if segments is not None and {"marker"} <= values.keys() & parts.of_segments.keys():
        values["marker"][n + of_segments] = parts.of_segments["marker"][:, None]
    if segments is not None:
        segments = np.concatenate((segments, n + of_segments), axis=1).astype(np.int32)
    return parts._replace(
        points=_extended(parts.points, edges),
        simplices=np.concatenate((parts.simplices, n + of_simplices), axis=1).astype(np.int32),
        of_points={**values, **(of_nodes or {})},
        segments=segments,
        order=2,
    )


def middles(parts: Parts) -> tuple[Indices, tuple[NDArray[np.int64], NDArray[np.int64]]]:
    """Return all edges, (e, 2), and the rows of the edges of simplices and of segments.

    Edges are sorted by their points; those of segments that are not edges of a simplex come last.
    """
    n = np.int64(len(parts.points))
    own = _keys(parts.simplices, n)
    keys, of_simplices = np.unique(own, return_inverse=True)
    segments = parts.segments
    further = np.empty((0, 0), dtype=np.int64) if segments is None else _keys(segments, n)
    keys = np.concatenate((keys, np.setdiff1d(further, keys)))
    order = np.argsort(keys, kind="stable")
    of_segments = order[np.searchsorted(keys[order], further)]
    edges: Indices = np.column_stack(np.divmod(keys, n)).astype(np.int32)
    return edges, (of_simplices.reshape(own.shape), of_segments)


def _keys(simplices: Indices, n: np.int64) -> NDArray[np.int64]:
    """A number for each edge of each simplex, the same in both directions."""
    pairs = np.sort(simplices.astype(np.int64)[:, SIDES[simplices.shape[1]]], axis=2)
    found: NDArray[np.int64] = pairs[..., 0] * n + pairs[..., 1]
    return found


def _extended(values: NDArray[Any], edges: Indices) -> NDArray[Any]:
    """Return the values of points, followed by those in the middle of edges."""
    a, b = values[edges[:, 0]], values[edges[:, 1]]
    if values.dtype.kind != "f":
        return np.concatenate((values, np.zeros_like(a)))
    with np.errstate(over="ignore", invalid="ignore"):
        found = (a + b) / 2
        # The sum of the largest numbers is infinite; their halves are exact.
        found = np.where(np.isinf(found), a / 2 + b / 2, found)
    return np.concatenate((values, found.astype(values.dtype)))
