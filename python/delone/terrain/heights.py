"""The heights of vertices: of points, of lines, and where lines meet.

Each vertex has *claims*: the heights of the points there, and those of the lines that pass through
it. Claims that differ are resolved by the policies of the caller, or raise an error that has their
coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone.counting import counted
from delone.errors import ConflictingValuesError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.constrained.delaunay import ConstrainedDelaunay

    Floats = NDArray[np.float64]
    Rows = NDArray[np.int64]

__all__ = ["POLICIES", "Claims", "claims_of_lines", "resolved"]

POLICIES = ("raise", "min", "max", "mean")
_REDUCE = {"min": np.minimum, "max": np.maximum}
# Heights on a line are rounded: differences up to this share of the largest height are none.
_ROUNDING = 1e-12
_SHOWN = 5


class Claims(NamedTuple):
    """Heights that are claimed at vertices."""

    vertex: Rows
    z: Floats


def claims_of_lines(mesh: ConstrainedDelaunay, z: Floats, npoints: int) -> Claims:
    """Return the claims of the lines: of their own points, and where they pass through vertices.

    The points of lines are those from row `npoints` on; `z` has the height of each row.
    """
    own = np.arange(npoints, len(z))
    vertex, height = [mesh.duplicate_of[own].astype(np.int64)], [z[own]]
    crossings, through = mesh.report.crossings, mesh.report.through
    for row, place in (
        (crossings[:, 0], crossings[:, 2]),
        (crossings[:, 1], crossings[:, 2]),
        (through[:, 0], through[:, 1]),
    ):
        vertex.append(place.astype(np.int64))
        height.append(_along(mesh, z, row, place))
    return Claims(np.concatenate(vertex), np.concatenate(height))


def _along(
    mesh: ConstrainedDelaunay, z: Floats, row: NDArray[np.int32], vertex: NDArray[np.int32]
) -> Floats:
    """The heights of segments at vertices on them."""
    a, b = mesh.input_segments[row].T
    part = mesh.points[vertex] - mesh.points[a]
    whole = mesh.points[b] - mesh.points[a]
    share = np.clip(np.hypot(*part.T) / np.hypot(*whole.T), 0, 1)
    found: Floats = z[a] + share * (z[b] - z[a])
    return found


def resolved(
    points: Floats,
    of_points: Claims,
    of_lines: Claims,
    *,
    duplicates: str,
    crossing: str,
) -> Floats:
    """Return one height for each row of `points`: NaN where nothing is claimed."""
    count = len(points)
    scale = max(np.abs(each.z).max(initial=0.0) for each in (of_points, of_lines))
    slack = float(_ROUNDING * scale)
    first = _reduced(points, of_points, duplicates, 0.0, "points", "duplicates")
    second = _reduced(points, of_lines, crossing, slack, "lines", "crossing")
    if not len(of_lines.z):
        return first
    claims = [
        Claims(np.flatnonzero(~np.isnan(each)), each[~np.isnan(each)]) for each in (second, first)
    ]
    both = Claims(*(np.concatenate(columns) for columns in zip(*claims, strict=True)))
    found = _reduced(points, both, duplicates, slack, "a line and a point", "duplicates")
    assert len(found) == count
    return found


def _reduced(  # noqa: PLR0917
    points: Floats, claims: Claims, policy: str, slack: float, what: str, option: str
) -> Floats:
    """Reduce the claims at each vertex to one; the first one if they are equal."""
    found = np.full(len(points), np.nan)
    vertex, z = claims
    found[vertex[::-1]] = z[::-1]
    low, high = found.copy(), found.copy()
    np.minimum.at(low, vertex, z)
    np.maximum.at(high, vertex, z)
    different = np.flatnonzero(high - low > slack)
    if not len(different):
        return found
    if policy == "raise":
        raise _conflict(points, different, low, high, what, option)
    if policy == "mean":
        total, number = np.zeros(len(points)), np.zeros(len(points))
        np.add.at(total, vertex, z)
        np.add.at(number, vertex, 1)
        found[different] = total[different] / number[different]
    else:
        found[different] = (low if policy == "min" else high)[different]
    return found


def _conflict(  # noqa: PLR0917
    points: Floats, rows: Rows, low: Floats, high: Floats, what: str, option: str
) -> ConflictingValuesError:
    shown = ", ".join(
        f"({x:.10g}, {y:.10g}): {low[row]:.6g} to {high[row]:.6g}"
        for row, (x, y) in zip(rows[:_SHOWN].tolist(), points[rows[:_SHOWN]], strict=True)
    )
    more = ", ..." if len(rows) > _SHOWN else ""
    return ConflictingValuesError(
        f"{what} have different heights at {counted(len(rows), 'place')}: {shown}{more}. Correct "
        f'them, or choose {option}="min", "max" or "mean"',
        rows=np.column_stack((rows, rows)),
    )
