"""Counts that a file declares, rejected if no file can contain that many items."""

from __future__ import annotations

from delone.errors import FileFormatError

__all__ = ["announced"]

# Every count of items or bytes has fewer digits. Python also rejects very long numbers,
# with an error that does not name the file.
_DIGITS = 18


def announced(digits: str | bytes, source: str) -> int:
    """Parse a count that a file declares: decimal digits, nothing else."""
    text = digits.decode("ascii") if isinstance(digits, bytes) else digits.strip()
    short = text.lstrip("0") or "0"
    if len(short) > _DIGITS:
        raise FileFormatError(f"{source} is corrupt: it declares a number of {len(short)} digits")
    return int(short)
