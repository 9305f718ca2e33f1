"""The message for nested sequences that no array can hold, in place of NumPy's."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["uneven"]


# NumPy's limit on the number of dimensions.
_DEEPEST = 64


def uneven(given: Any, name: str) -> str:
    """Say which row is the first whose length differs from that of the first row."""
    where: list[str] = []
    for _ in range(_DEEPEST):
        rows = list(given)
        sizes = [_length(row) for row in rows]
        for row, size in enumerate(sizes):
            if size != sizes[0]:
                first, other = (
                    f"row {k} {'is a single value' if sizes[k] is None else f'has {sizes[k]}'}"
                    for k in (0, row)
                )
                inside = f" in row {', '.join(where)}" if where else ""
                return f"{name} has rows of unequal length{inside}: {first}, {other}"
        inner = next((k for k, row in enumerate(rows) if not _is_array(row)), None)
        if inner is None:
            return f"{name} has rows of unequal shape"
        given = rows[inner]
        where.append(str(inner))
    return f"{name} is too deeply nested"


def _is_array(row: Any) -> bool:
    try:
        np.asarray(row)
    except ValueError:
        return False
    return True


def _length(row: Any) -> int | None:
    return len(row) if hasattr(row, "__len__") and not isinstance(row, str | bytes) else None
