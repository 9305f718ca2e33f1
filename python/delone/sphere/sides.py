"""Sides of polygons in longitudes and latitudes: arcs, or straight lines on a map.

Two points have one shorter arc, unless they are opposite. On a map, more sides are defined: a side
from pole to pole runs along its meridian, one from -180 to 180 along its parallel, and a rectangle
from -180 to 180 and pole to pole is the whole sphere, although its sides cancel out.
"""

from __future__ import annotations

import warnings
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._base.counting import agreed, counted
from delone._base.duplicates import first_rows
from delone._base.georeference import caller_level
from delone.constrained import geodata
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.constrained.geodata import Parts

__all__ = ["SIDES", "Origin", "PolygonWarning", "divided", "whole_sphere"]

SIDES = ("arc", "parallel")
# At middle latitudes, longer arcs leave the parallel of their ends by more than a degree.
_LONG = np.radians(30.0)
# Number of pieces of a quarter turn, of one degree each.
_PIECES = 90


class Origin(NamedTuple):
    """Where each input segment came from."""

    # (s,): its geometry, or -1 if it has none.
    geometries: Indices
    # (s,): whether it is the side of a ring.
    rings: Bools
    # (s,): whether it is the side of the outer ring of a polygon.
    outer: Bools

    @classmethod
    def of_arrays(cls, count: int) -> Origin:
        """Return the origin of segments that did not come from geometries."""
        none = np.zeros(count, dtype=bool)
        return cls(np.full(count, -1, dtype=np.int32), none, none.copy())


class PolygonWarning(UserWarning):
    """A polygon on the sphere may differ from what its author intended.

    Examples
    --------
    >>> import warnings
    >>> from delone import sphere
    >>> box = {"type": "Polygon", "coordinates": [[(-60, 30), (60, 30), (60, 60), (-60, 60)]]}
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     mesh = sphere.from_geometry(box)
    ...     mesh = sphere.from_geometry(box, sides="parallel")
    >>> [each.category.__name__ for each in caught]
    ['PolygonWarning']
    """


def divided(parts: Parts, sides: str | None, quarter: float, *, name: str) -> Parts:
    """Return parts with points inserted into their sides so that each piece is a unique arc.

    `quarter` is 90 degrees in the unit of the coordinates.
    """
    ends, part = geodata.steps_of(parts)
    tail, head = parts.coordinates[ends[:, 0]], parts.coordinates[ends[:, 1]]
    across, up = (np.abs(each) for each in (head - tail).T)
    # From pole to pole along a meridian.
    count = np.where((across == 0) & (up == 2 * quarter), 2, 1)
    if sides == "parallel":
        degrees = np.maximum(across, up) * (_PIECES / quarter)
        count = np.maximum(count, np.where(across > 0, np.ceil(degrees), 1).astype(np.int64))
    else:
        polar = (np.abs(tail[:, 1]) == quarter) & (tail[:, 1] == head[:, 1])
        turn = np.flatnonzero((across == 4 * quarter) & (up == 0) & ~polar)
        if len(turn):
            place = tuple(tail[turn[0]].tolist())
            raise InputError(
                f"{name}: {counted(len(turn), 'side')} {agreed(len(turn), 'is', 'are')} a whole "
                f"turn long, first from {place} in geometry {parts.geometries[part[turn[0]]]}: "
                'arcs have no such length; sides="parallel" follows the parallel'
            )
        if sides is None:
            _warn_of_long(tail * (np.pi / 2 / quarter), head * (np.pi / 2 / quarter), name)
    return _inserted(parts, ends, count)


def _inserted(parts: Parts, ends: NDArray[np.int64], count: NDArray[np.int64]) -> Parts:
    """Return parts whose sides are divided into equal pieces; `count` gives their number."""
    if not (count > 1).any():
        return parts
    rows = np.ones(len(parts.coordinates), dtype=np.int64)
    rows[ends[:, 0]] = count
    step = np.zeros_like(parts.coordinates)
    step[ends[:, 0]] = parts.coordinates[ends[:, 1]] - parts.coordinates[ends[:, 0]]
    starts = np.concatenate(([0], np.cumsum(rows)))
    of = np.repeat(np.arange(len(rows)), rows)
    share = (np.arange(len(of)) - starts[of]) / rows[of]
    return parts._replace(
        coordinates=parts.coordinates[of] + step[of] * share[:, None], starts=starts[parts.starts]
    )


def _warn_of_long(tail: Floats, head: Floats, name: str) -> None:
    """Warn about arcs that are far from the straight line on a map; angles are in radians."""
    half = (head - tail) / 2
    chord = np.sin(half[:, 1]) ** 2 + np.cos(tail[:, 1]) * np.cos(head[:, 1]) * (
        np.sin(half[:, 0]) ** 2
    )
    same = (half[:, 0] == 0) | ((tail[:, 1] == 0) & (head[:, 1] == 0))
    long = np.flatnonzero((chord > np.sin(_LONG / 2) ** 2) & ~same)
    if len(long):
        first = [tuple(np.degrees(each[long[0]]).round(6).tolist()) for each in (tail, head)]
        warnings.warn(
            f"{name}: {counted(len(long), 'side')} {agreed(len(long), 'is', 'are')} longer than 30 "
            f"degrees, first from {first[0]} to {first[1]}: the arc of a great circle leaves the "
            'straight line of a map. sides="parallel" follows the line; sides="arc" says that arcs '
            "are meant",
            PolygonWarning,
            stacklevel=caller_level(),
        )


def whole_sphere(parts: Parts, vectors: Floats, ends: Indices, origin: Origin) -> int | None:
    """Return the first geometry whose sides cancel out although it has an area on the map."""
    # Degrees are reduced exactly, so all coordinates of one point have equal vectors.
    sides = np.sort(first_rows(vectors)[ends], axis=1).astype(np.int32)
    rings = origin.rings & (sides[:, 0] != sides[:, 1])
    sides = sides[rings]
    # The first row of the same side, combined with the geometry into one number.
    side = _core.facet_rows(sides, sides, len(vectors), True)
    keys = origin.geometries[rings].astype(np.int64) * max(len(side), 1) + side
    found, times = np.unique(keys, return_counts=True)
    bounded = found[times % 2 == 1] // max(len(side), 1)
    for geometry in np.setdiff1d(parts.geometries[parts.kinds == geodata.EXTERIOR], bounded):
        if _area(parts, geometry) != 0:
            return int(geometry)
    return None


def _area(parts: Parts, geometry: np.integer) -> Fraction:
    """Return twice the area of the outer rings of a geometry on the map, exactly."""
    total = Fraction(0)
    for k in np.flatnonzero((parts.geometries == geometry) & (parts.kinds == geodata.EXTERIOR)):
        ring = parts.coordinates[parts.starts[k] : parts.starts[k + 1]].tolist()
        exact = [(Fraction(x), Fraction(y)) for x, y in ring]
        turn = sum(
            (a[0] * b[1] - b[0] * a[1] for a, b in zip(exact, exact[1:] + exact[:1], strict=True)),
            Fraction(0),
        )
        total += abs(turn)
    return total
