"""The heights of vertices: of points, of lines, and where lines meet.

Each vertex has *claims*: the heights of the points there, and those of the lines that pass through
it. Claims that differ are resolved by the policies of the caller, or raise an error that contains
their coordinates.

The claim of a line between its own points has an error bound: the slope of the line times the
rounding error of the coordinates. Claims differ if their intervals have no height in common. Lines
without heights have no claims: they get the other heights there, or the height of the ground.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.counting import counted
from delone.errors import ConflictingValuesError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.constrained.delaunay import ConstrainedDelaunay

__all__ = [
    "POLICIES",
    "Claims",
    "claims_of_lines",
    "claims_of_points",
    "conflict",
    "on_ground",
    "resolved",
]

POLICIES = ("raise", "min", "max", "mean")
# Both ends of a line, the vertex on it and its fraction of the line are each rounded once.
_ROUNDINGS = 4
_EPS = float(np.finfo(np.float64).eps)
_SHOWN = 5
# Numbers of digits of heights in messages: the first one that shows a difference is used.
_DIGITS = (6, 9, 12, 17)


class Claims(NamedTuple):
    """Heights that are claimed at vertices."""

    vertex: Rows
    z: Floats
    bound: Floats  # by how much rounding may have changed each height
    row: Rows  # of all points, to name a claim

    @classmethod
    def joined(cls, parts: list[Claims]) -> Claims:
        """Combine several."""
        parts = [part for part in parts if len(part.vertex)] or parts[:1]
        if len(parts) == 1:
            return parts[0]
        return cls(*(np.concatenate(column) for column in zip(*parts, strict=True)))

    def among(self, rows: Bools) -> Claims:
        """Return some of the claims."""
        return Claims(self.vertex[rows], self.z[rows], self.bound[rows], self.row[rows])


def claims_of_points(vertex: NDArray[np.int32], z: Floats, row: Rows | None = None) -> Claims:
    """Return the claims of points, whose heights are exact; they are numbered from 0 by default."""
    rows = np.arange(len(z)) if row is None else row
    return Claims(vertex.astype(np.int64), z, np.zeros(len(z)), rows)


def claims_of_lines(mesh: ConstrainedDelaunay, z: Floats) -> tuple[Claims, Rows]:
    """Return the claims of lines where they cross or pass through vertices, and their segments.

    `z` contains the height of each row of points.
    """
    # The whole report would list repeated and overlapping segments as well.
    crossings, through = mesh._made.crossings, mesh._made.through
    row = np.concatenate((crossings[:, 0], crossings[:, 1], through[:, 0]))
    vertex = np.concatenate((crossings[:, 2], crossings[:, 2], through[:, 1]))
    return _along(mesh, z, row, vertex), row.astype(np.int64)


def _along(
    mesh: ConstrainedDelaunay, z: Floats, row: NDArray[np.int32], vertex: NDArray[np.int32]
) -> Claims:
    """The claims of segments at vertices on them."""
    a, b = mesh.input_segments[row].T
    # Start at the smaller end, so that the direction of a segment does not matter.
    (ax, ay), (bx, by) = mesh.points[a].T, mesh.points[b].T
    turned = (ax > bx) | ((ax == bx) & (ay > by))
    a, b = np.where(turned, b, a), np.where(turned, a, b)
    part = mesh.points[vertex] - mesh.points[a]
    whole = mesh.points[b] - mesh.points[a]
    length = np.hypot(*whole.T)
    rise = z[b] - z[a]
    found = z[a] + np.clip(np.hypot(*part.T) / length, 0, 1) * rise
    # Where a segment is bent, its vertices are next to it.
    beside = np.abs(whole[:, 0] * part[:, 1] - whole[:, 1] * part[:, 0]) / length
    largest = np.abs(mesh.points[np.column_stack((a, b, vertex))]).max(axis=(1, 2), initial=0.0)
    moved = beside + _ROUNDINGS * np.spacing(largest)
    bound = np.abs(rise) / length * moved + _ROUNDINGS * _EPS * (np.abs(z[a]) + np.abs(z[b]))
    return Claims(vertex.astype(np.int64), found, bound, vertex.astype(np.int64))


def resolved(
    points: Floats,
    of_points: Claims,
    of_lines: Claims,
    *,
    duplicates: str,
    crossing: str,
    tolerance: float = 0.0,
) -> Floats:
    """Return one height for each row of `points`: NaN where nothing is claimed."""
    first = _reduced(points, of_points, duplicates, tolerance, "points", "duplicates")
    second = _reduced(points, of_lines, crossing, tolerance, "lines", "crossing")
    both = Claims.joined([second, first])
    alone = not (len(first.vertex) and len(second.vertex))
    last = (
        both
        if alone
        else _reduced(points, both, duplicates, tolerance, "a line and a point", "duplicates")
    )
    found = np.full(len(points), np.nan)
    found[last.vertex] = last.z
    return found


def on_ground(z: Floats, claims: Claims) -> Floats:
    """Return heights, with those of the ground if there are none: the lowest of several.

    They are heights of one surface and differ only by rounding errors.
    """
    missing = claims.among(np.isnan(z[claims.vertex]))
    found = z.copy()
    found[missing.vertex] = np.inf
    np.minimum.at(found, missing.vertex, missing.z)
    return found


def _reduced(  # noqa: PLR0917
    points: Floats, claims: Claims, policy: str, tolerance: float, what: str, option: str
) -> Claims:
    """Reduce the claims at each vertex to one: the most accurate one if they agree."""
    several = np.bincount(claims.vertex, minlength=len(points))[claims.vertex] > 1
    if not several.any():
        return claims
    # Most vertices have one claim; only the others are sorted.
    alone, claims = claims.among(~several), claims.among(several)
    order = np.lexsort((claims.z, claims.bound, claims.vertex))
    vertex, first = np.unique(claims.vertex[order], return_index=True)
    z, bound = claims.z[order][first], claims.bound[order][first]
    at = np.searchsorted(vertex, claims.vertex)
    low, high = np.full(len(z), np.inf), np.full(len(z), -np.inf)
    least, most = high.copy(), low.copy()
    np.minimum.at(low, at, claims.z)
    np.maximum.at(high, at, claims.z)
    # Intervals overlap if the largest lower end is not above the smallest upper end.
    np.maximum.at(least, at, claims.z - claims.bound)
    np.minimum.at(most, at, claims.z + claims.bound)
    with np.errstate(over="ignore"):
        different = np.flatnonzero(least - most > tolerance)
    if policy == "raise" and len(different):
        places = vertex[different]
        rows = _lowest_and_highest(claims)[different]
        raise conflict(points[places], rows, low[different], high[different], what, option)
    if policy == "mean":
        total, number = np.bincount(at, claims.z), np.bincount(at)
        z[different] = total[different] / number[different]
    else:
        z[different] = (low if policy == "min" else high)[different]
    return Claims.joined([alone, Claims(vertex, z, bound, claims.row[order][first])])


def _lowest_and_highest(claims: Claims) -> Rows:
    """Return the rows of the lowest and the highest claim at each vertex, the later row first."""
    order = np.lexsort((claims.row, claims.z, claims.vertex))
    vertex, row = claims.vertex[order], claims.row[order]
    last = np.append(vertex[1:] != vertex[:-1], True)
    pairs = np.column_stack((row[np.append(True, last[:-1])], row[last]))
    return np.sort(pairs, axis=1)[:, ::-1]


def conflict(  # noqa: PLR0917
    places: Floats, rows: Rows, low: Floats, high: Floats, what: str, option: str
) -> ConflictingValuesError:
    """Return the error that heights differ at places, each with two rows."""
    shown = ", ".join(
        f"({x:.10g}, {y:.10g}): {_range(*span)}"
        for (x, y), *span in zip(places[:_SHOWN], low.tolist(), high.tolist(), strict=False)
    )
    more = ", ..." if len(rows) > _SHOWN else ""
    return ConflictingValuesError(
        f"{what} have different heights at {counted(len(rows), 'place')}: {shown}{more}. Correct "
        f'them, choose {option}="min", "max" or "mean", or give tolerance=, the largest difference '
        "of heights that are equal",
        rows=rows,
    )


def _range(low: float, high: float) -> str:
    """Return two heights as text, with enough digits to show that they differ."""
    for digits in _DIGITS:
        first, second = f"{low:.{digits}g}", f"{high:.{digits}g}"
        if first != second:
            break
    return f"{first} to {second}"
