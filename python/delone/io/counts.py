"""Counts that a file declares, rejected if no file can contain so many items."""

from __future__ import annotations

from delone.errors import FileFormatError

__all__ = ["announced"]

# Every count of items or bytes has fewer digits. Python also refuses to parse very long numbers,
# with an error that does not name the file.
_DIGITS = 18


def announced(digits: str | bytes, source: str) -> int:
    """Parse a count that a file declares.

    Parameters
    ----------
    digits : str or bytes
        Decimal digits, nothing else.
    source : str
        The file, for the error message.

    Returns
    -------
    int
        The number.

    Raises
    ------
    FileFormatError
        The count has more than 18 digits.

    Examples
    --------
    >>> from delone.io.counts import announced
    >>> announced("00042", "survey.xyz")
    42
    >>> announced("9" * 5000, "survey.xyz")
    Traceback (most recent call last):
    ...
    delone.errors.FileFormatError: survey.xyz is corrupt: it declares a number of 5000 digits
    """
    text = digits.decode("ascii") if isinstance(digits, bytes) else digits.strip()
    short = text.lstrip("0") or "0"
    if len(short) > _DIGITS:
        raise FileFormatError(f"{source} is corrupt: it declares a number of {len(short)} digits")
    return int(short)
