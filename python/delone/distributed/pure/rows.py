"""Records of points, as they pass from the source through the tiles to the output.

A row is a record of its number in the source, its coordinates and its attributes. Of rows with
equal coordinates, the one with the smallest number is the vertex, wherever they meet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import DtypeError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    Rows = NDArray[np.void]

__all__ = ["coordinates", "first_of_each", "make_rows", "record", "widen", "widened"]

_FIXED = ("id", "x", "y", "z")
# Doubles represent every integer up to here.
_EXACT = 1 << 53


def record(attributes: Mapping[str, str], *, heights: bool) -> np.dtype[np.void]:
    """Return the dtype of rows with these attributes, given as names and dtypes."""
    fields: list[tuple[str, str]] = [("id", "<u8"), ("x", "<f8"), ("y", "<f8")]
    if heights:
        fields.append(("z", "<f8"))
    return np.dtype(fields + [(name, kind) for name, kind in attributes.items()])


def make_rows(
    first: int,
    points: NDArray[np.float64],
    z: NDArray[np.float64] | None,
    attributes: Mapping[str, NDArray[Any]],
) -> Rows:
    """Return rows numbered from `first` on."""
    kinds = {name: np.asarray(values).dtype.str for name, values in attributes.items()}
    rows = np.empty(len(points), dtype=record(kinds, heights=z is not None))
    rows["id"] = np.arange(first, first + len(points), dtype=np.uint64)
    rows["x"], rows["y"] = points[:, 0], points[:, 1]
    if z is not None:
        rows["z"] = z
    for name, values in attributes.items():
        rows[name] = values
    return rows


def widened(types: Sequence[np.dtype[np.void]]) -> np.dtype[np.void]:
    """Return a dtype that can store the attributes of all `types`, whose names are equal."""
    names = types[0].names or ()
    kinds = {
        name: np.result_type(*{t[name] for t in types}).str for name in names if name not in _FIXED
    }
    return record(kinds, heights="z" in names)


def widen(rows: Rows, kind: np.dtype[np.void]) -> Rows:
    """Convert rows to a dtype found by `widened`.

    An attribute that is an integer in some files and a float in others, or has gaps, is rejected if
    a value is not representable as a double.
    """
    for name in kind.names or ():
        if rows.dtype[name].kind in "iu" and kind[name].kind == "f":
            values = rows[name]
            lost = np.flatnonzero((values > _EXACT) | (values.astype(np.float64) < -_EXACT))
            if len(lost):
                raise DtypeError(
                    f"attribute {name!r:.80} has integers in some files and floats or gaps in "
                    f"others; {values[lost[0]]} of row {rows['id'][lost[0]]} is beyond the 2**53 "
                    "up to which a double can represent every integer"
                )
    return rows.astype(kind)


def coordinates(rows: Rows) -> NDArray[np.float64]:
    """Return the coordinates of rows, (n, 2), contiguous."""
    points = np.empty((len(rows), 2))
    points[:, 0], points[:, 1] = rows["x"], rows["y"]
    return points


def first_of_each(rows: Rows) -> Rows:
    """Return rows sorted by number, without repeated numbers."""
    return rows[np.unique(rows["id"], return_index=True)[1]]
