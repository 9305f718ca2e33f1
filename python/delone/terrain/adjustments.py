"""What the construction of a surface changed in its input: merged points, level polygons."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone._base.counting import counted
from delone._base.immutable import ReadOnly

if TYPE_CHECKING:
    from delone._base.types import Floats
    from delone.terrain.joining import Joined
    from delone.terrain.leveling import Level

__all__ = ["Adjustments", "adjustments_of"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Adjustments(ReadOnly):
    """What `TIN.from_points` changed because of `snap` and `level`.

    Parameters
    ----------
    points_moved : int
        The number of points that moved because they were merged with others or with lines.
    line_points_moved : int
        The number of points of lines that were merged with others.
    largest_move : float
        The largest distance that a point moved; 0 if none moved.
    points_leveled : int
        The number of points that were left out inside level polygons, on their shores, or closer to
        a shore than `snap`.
    levels : ndarray of float64, shape (k,)
        The height of each level polygon; NaN where a feature has no geometry.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> points = [(0, 0, 1), (9, 0, 2), (9, 9, 3), (0, 9, 2), (5, 5, 1.5), (5, 5.001, 1.5)]
    >>> lake = [(4, 4), (6, 4), (6, 6), (4, 6)]
    >>> TIN.from_points(points, snap=0.01).adjustments
    <Adjustments: 1 point moved by at most 0.001>
    >>> TIN.from_points(points, level=[lake]).adjustments
    <Adjustments: 2 points in 1 level polygon left out>
    """

    points_moved: int
    line_points_moved: int
    largest_move: float
    points_leveled: int
    levels: Floats

    def __repr__(self) -> str:
        parts = []
        moved = self.points_moved + self.line_points_moved
        if moved or not len(self.levels):
            parts.append(f"{counted(moved, 'point')} moved by at most {self.largest_move:.6g}")
        if len(self.levels):
            polygons = counted(len(self.levels), "level polygon")
            parts.append(f"{counted(self.points_leveled, 'point')} in {polygons} left out")
        return f"<Adjustments: {', '.join(parts)}>"

    def _text(self) -> str:
        """The numbers as text for files."""
        return json.dumps({**vars(self), "levels": self.levels.tolist()})

    @classmethod
    def _of_text(cls, text: str) -> Adjustments:
        """Parse what `_text` wrote."""
        numbers = json.loads(text)
        levels = np.array(numbers.pop("levels"), dtype=np.float64)
        return cls(levels=levels, **numbers)


def adjustments_of(merged: Joined | None, level: Level | None) -> Adjustments | None:
    """Return what was changed; None if no change was requested."""
    if merged is None and level is None:
        return None
    return Adjustments(
        points_moved=0 if merged is None else merged.points_moved,
        line_points_moved=0 if merged is None else merged.line_points_moved,
        largest_move=0.0 if merged is None else merged.largest_move,
        points_leveled=(0 if level is None else int((~level.outside).sum()))
        + (0 if merged is None else merged.points_leveled),
        levels=np.empty(0) if level is None else level.heights,
    )
