"""Faults of cells on the sphere, by the core's numbers, and the errors for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone._base.counting import agreed, counted
from delone.errors import DirectionError

if TYPE_CHECKING:
    from delone._base.types import Rows

__all__ = ["CROSSING", "EMPTY", "FAULTS", "LARGE", "fault_error"]

EMPTY, LARGE, CROSSING = 1, 3, 4
# Faults that make a cell unusable, and what to do about each.
FAULTS = {
    2: ("a side that joins opposite directions", "add a corner between them"),
    LARGE: (
        "corners that no hemisphere contains",
        "give winding= to Grid.from_mesh or Grid.from_polygons, or split such cells",
    ),
    CROSSING: (
        "sides that cross or are repeated",
        'repair them, for example with shapely.make_valid and method="structure"',
    ),
}


def fault_error(fault: int, rows: Rows) -> DirectionError:
    """Return an error for cells with a fault."""
    count, (what, cure) = len(rows), FAULTS[fault]
    cells = f"{counted(count, 'cell')} {agreed(count, 'has', 'have')} {what}"
    message = f"{cells}, first cell {rows[0]}: {cure}"
    return DirectionError(message, rows=rows[:10].tolist(), count=count)
