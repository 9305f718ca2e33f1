"""Labels of contours: where a line is straightest, along it, and readable from below."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._base.arrays import as_number
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.immutable import ReadOnly
from delone.errors import InputError
from delone.terrain.layer import Layer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["Labels", "labels_of"]

# Positions that are compared for a label, and the default length of one, as a fraction of the
# extent.
_PLACES, _LENGTH = 32, 1 / 40
# The maximum number of labels.
_MOST = 1_000_000


@dataclass(frozen=True, eq=False, kw_only=True)
class Labels(ReadOnly, Layer):
    """Where the labels of contours are, and what they say.

    Parameters
    ----------
    points : ndarray of float64, shape (k, 2)
        The middle of each label, on its line.
    angle : ndarray of float64, shape (k,)
        The direction of the text in degrees, counterclockwise from the x axis: above -90 and at
        most 90.
    text : tuple of str
        The texts.
    line : ndarray of int64, shape (k,)
        The number of the line in the contours.
    level : ndarray of float64, shape (k,)
        Its level.
    index : ndarray of bool, shape (k,)
        Whether it is an index contour.
    length : float
        The length of a label for which the positions were chosen.
    short : int
        The number of lines without a label because they are shorter than two labels.
    crs : str, optional
        Coordinate reference system.

    Notes
    -----
    The columns of `to_geopandas` are ``level``, ``index``, ``text``, ``angle``, ``line`` and the
    geometry, a point.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> tin = TIN.from_points([(0, 0, 0), (40, 0, 0), (40, 40, 8), (0, 40, 8)])
    >>> found = tin.contours([3, 6]).labels(length=5)
    >>> found
    <Labels of contours: 2 labels, 0 lines too short>
    >>> found.text, found.angle.tolist(), found.points.round(1).tolist()
    (('3', '6'), [0.0, 0.0], [[20.0, 15.0], [20.0, 30.0]])
    """

    points: Floats
    angle: Floats
    text: tuple[str, ...]
    line: Rows
    level: Floats
    index: Bools
    length: float
    short: int = 0
    crs: str | None = None

    _ELEMENTS: ClassVar[str] = "labels"

    def __len__(self) -> int:
        return len(self.text)

    def __repr__(self) -> str:
        short = counted(self.short, "line")
        return f"<Labels of contours: {counted(len(self), 'label')}, {short} too short>"

    def _geometries(self) -> NDArray[Any]:
        shapely = require("shapely", extra="geo", what="geometries")
        found: NDArray[Any] = shapely.points(self.points)
        return found

    def _fields(self) -> dict[str, Any]:
        names = ("level", "index", "text", "angle", "line")
        return {name: getattr(self, name) for name in names} | {"text": list(self.text)}


def labels_of(
    lines: Sequence[Floats],
    level: Floats,
    marked: Bools,
    *,
    index: bool,
    length: float | None,
    spacing: float | None,
    crs: str | None,
) -> Labels:
    """Return labels for the requested lines."""
    extent = max((float(np.ptp(line, axis=0).max()) for line in lines), default=0.0)
    size = extent * _LENGTH if length is None else as_number(length, name="length")
    apart = math.inf if spacing is None else as_number(spacing, name="spacing")
    if not (0 < size < math.inf or not len(lines)) or not apart > 0:
        raise InputError("length and spacing must be above 0, and length finite")
    found: list[tuple[int, Floats, float]] = []
    short = 0
    for row in np.flatnonzero(marked | (not index)).tolist():
        along = np.append(0.0, np.cumsum(np.hypot(*np.diff(lines[row], axis=0).T)))
        if along[-1] < 2 * size:
            short += 1
            continue
        count = max(1, math.floor(along[-1] / max(apart, 2 * size)))
        if len(found) + count > _MOST:
            raise InputError(f"there would be more than {_MOST:,} labels: choose a larger spacing")
        found += [(row, *each) for each in _placed(lines[row], along, size, count)]
    rows = np.array([row for row, _, _ in found], dtype=np.int64)
    return Labels(
        points=np.array([place for _, place, _ in found]).reshape(-1, 2),
        angle=np.array([angle for _, _, angle in found], dtype=np.float64),
        text=tuple(f"{level[row]:.10g}" for row in rows),
        line=rows,
        level=level[rows],
        index=marked[rows],
        length=size,
        short=short,
        crs=crs,
    )


def _placed(line: Floats, along: Floats, size: float, count: int) -> list[tuple[Floats, float]]:
    """Return the midpoints and angles of labels, each in its part of a line."""
    found = []
    ends = np.linspace(0.0, along[-1], count + 1)
    for start, stop in pairwise(ends.tolist()):
        # A label stays within its part; among equally good positions, the middle is preferred.
        at = np.linspace(start + size / 2, stop - size / 2, _PLACES + 1)
        at = at[np.argsort(np.abs(at - (start + stop) / 2), kind="stable")]
        first, middle, last = (_on(line, along, at + shift) for shift in (-size / 2, 0, size / 2))
        chord = np.hypot(*(last - first).T)
        # Lines within a hundredth of straight count as straight, where the middle is better.
        best = int((chord >= chord.max() - size / 100).argmax())
        x, y = (last - first)[best]
        angle = math.degrees(math.atan2(y, x))
        if angle > 90:
            angle -= 180
        elif angle <= -90:
            angle += 180
        found.append((middle[best], angle + 0.0))
    return found


def _on(line: Floats, along: Floats, at: Floats) -> Floats:
    return np.column_stack([np.interp(at, along, axis) for axis in line.T])
