"""Points and segments that differ by roundings only are made to coincide.

Without that, a polygon whose edge is meant to be on edges of a surface would leave triangles of the
ground beside it that are as narrow as a rounding, with heights of the ground next to those of the
polygon.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.terrain.pads import Pad

    Floats = NDArray[np.float64]
    Rows = NDArray[np.int64]

__all__ = ["closeness", "settled", "threaded"]

# Distances of so many roundings are none.
_ROUNDINGS = 64
_EPS = float(np.finfo(np.float64).eps)


def closeness(*points: Floats) -> float:
    """Return the distance below which points coincide: roundings of the largest coordinate."""
    return _ROUNDINGS * _EPS * max(float(np.abs(each).max()) for each in points)


def settled(pad: Pad, points: Floats) -> Pad:
    """Return a pad whose points are those of a surface where they are as close as that."""
    limit = closeness(points, pad.points)
    moved = pad.points.copy()
    for row, place in enumerate(pad.points):
        away = np.abs(points - place).max(axis=1)
        nearest = int(away.argmin())
        if away[nearest] <= limit:
            moved[row] = points[nearest]
    return pad._replace(points=moved)


def threaded(points: Floats, segments: Rows, vertices: Rows) -> Rows:
    """Return segments that pass through those vertices that are close to them."""
    limit = closeness(points)
    starts, stops = (points[segments[:, k]] for k in range(2))
    found: list[tuple[int, float, int]] = []
    if len(segments) <= len(vertices):
        places = points[vertices]
        for row, (a, b) in enumerate(zip(starts, stops, strict=True)):
            beside = _between(a[None], b[None], places, limit)
            found += [(row, share, int(vertices[at])) for at, share in beside]
    else:
        for vertex in vertices.tolist():
            beside = _between(starts, stops, points[vertex][None], limit)
            found += [(row, share, vertex) for row, share in beside]
    if not found:
        return segments
    found.sort()
    parts = {row: [int(segments[row, 0])] for row, _, _ in found}
    for row, _, vertex in found:
        parts[row].append(vertex)
    chains = [segments[np.setdiff1d(np.arange(len(segments)), list(parts))]]
    for row, chain in parts.items():
        chain.append(int(segments[row, 1]))
        chains.append(np.column_stack((chain[:-1], chain[1:])))
    return np.concatenate(chains)


def _between(a: Floats, b: Floats, places: Floats, limit: float) -> list[tuple[int, float]]:
    """Return which places are beside which segments: one of them, or one of the others."""
    along = b - a
    length = np.hypot(*along.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = along / length[:, None]
        from_a = places - a
        way = (from_a * unit).sum(axis=1)
        across = np.abs(unit[:, 0] * from_a[:, 1] - unit[:, 1] * from_a[:, 0])
    rows = np.flatnonzero((across <= limit) & (way > limit) & (way < length - limit))
    return [(int(row), float((way / length)[row])) for row in rows]
