"""All lines of a surface as segments; lines without heights are draped over the points."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.errors import InputError
from delone.terrain.profiles import parts_of, profile

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.terrain.lines import Ring
    from delone.terrain.surface import Surface

__all__ = [
    "BOUNDARY",
    "HARD",
    "HOLE",
    "HULL",
    "ISLAND",
    "LEVEL",
    "SOFT",
    "Lines",
    "gathered",
    "off_ground",
]

# The kinds of lines. The last two are shores of level polygons, and the hull of all heights if
# rings leave it.
HARD, SOFT, BOUNDARY, HOLE, ISLAND, LEVEL, HULL = range(7)


class Lines(NamedTuple):
    """All lines: their points, segments between them, and the kind of each segment."""

    points: Floats  # (p, 3), heights NaN outside the ground
    draped: Bools  # (p,), whether the height is that of the ground
    segments: Indices  # (s, 2), rows of `points`
    kinds: NDArray[np.int8]
    polygons: Indices  # (s,), the polygon of each side of a ring, -1 for others

    @classmethod
    def joined(cls, lines: list[tuple[int, int, Floats, Bools]]) -> Lines:
        """Combine lines: the kind and polygon of each, its points, and which are draped."""
        counts = np.array([len(points) for _, _, points, _ in lines], dtype=np.int64)
        sides = np.maximum(counts - 1, 0)
        ends = np.cumsum(counts)
        first = np.delete(np.arange(counts.sum()), ends[counts > 0] - 1)
        return cls(
            np.concatenate([np.empty((0, 3)), *(points for _, _, points, _ in lines)]),
            np.concatenate([np.empty(0, dtype=bool), *(draped for *_, draped in lines)]),
            np.column_stack((first, first + 1)).astype(np.int32),
            np.repeat(np.array([kind for kind, *_ in lines], dtype=np.int8), sides),
            np.repeat(np.array([polygon for _, polygon, *_ in lines], dtype=np.int32), sides),
        )


def gathered(
    given: list[list[Ring]], points: Floats, surface_of: Callable[[Floats], Surface]
) -> Lines:
    """Gather the lines of each kind, and drape those without heights over the points."""
    found: list[tuple[int, int, Floats, Bools]] = []
    ground: Surface | None = None
    for kind, lines in enumerate(given):
        for line, polygon in lines:
            without = np.isnan(line[:, 2])
            table, draped = line, without
            if without.any():
                ground = ground or surface_of(points)
                table = _on_ground(line, ground, ring=kind >= BOUNDARY)
                draped = np.ones(len(table), dtype=bool) if without.all() else without
            found.append((kind, -1 if polygon is None else polygon, table, draped))
    if any(np.isnan(table[:, 2]).any() for _, _, table, _ in found):
        known = [points, *(table[~np.isnan(table[:, 2])] for _, _, table, _ in found)]
        hull = _hull(np.concatenate(known))
        found.append((HULL, 0, hull, np.ones(len(hull), dtype=bool)))
    return Lines.joined(found)


def _hull(points: Floats) -> Floats:
    """The convex hull of points with heights, as a closed ring."""
    mesh = ConstrainedDelaunay(points[:, :2], np.empty((0, 2), dtype=np.int32), planar=True)
    ring = mesh.hull
    return points[np.append(ring, ring[:1])]


def _on_ground(line: Floats, ground: Surface, *, ring: bool) -> Floats:
    """Return a line with heights: those of the surface of the points, if it has none itself.

    The points of rings without any height are NaN outside that surface; others must be on it.
    """
    places, without = np.ascontiguousarray(line[:, :2]), np.isnan(line[:, 2])
    z = np.where(without, ground.heights(places), line[:, 2])
    if np.isnan(z).any() and not (ring and without.all()):
        raise off_ground(*places[np.isnan(z)][0].tolist())
    if not without.all():
        return np.column_stack((places, z))
    if not np.isnan(z).any():
        section = profile(ground, places)
        return np.column_stack((section.points, section.z))
    tables = [np.append(places[0], z[0])[None]]
    for k in range(len(places) - 1):
        # The surface of points is convex: a segment has at most one part on it.
        for part in parts_of(ground, places[k], places[k + 1]):
            between = (part.share > 0) & (part.share < 1)
            tables.append(np.column_stack((part.places, part.z))[between])
        tables.append(np.append(places[k + 1], z[k + 1])[None])
    table = np.concatenate(tables)
    again = (table[1:, :2] == table[:-1, :2]).all(axis=1)
    chain: Floats = table[np.append(True, ~again)]
    return chain


def off_ground(x: float, y: float) -> InputError:
    """Return the error that a line without heights leaves the surface of the points."""
    return InputError(
        f"a line without heights is outside the points at ({x:.10g}, {y:.10g}): give it heights "
        "there, or clip it to the hull of the points"
    )
