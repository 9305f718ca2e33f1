"""Whole numbers that a file announces, refused where no file can hold so many."""

from __future__ import annotations

from delone.errors import FileFormatError

__all__ = ["announced"]

# Any number of items or bytes has fewer digits. Python refuses to read very long numbers, too, with
# an error that does not name the file.
_DIGITS = 18


def announced(digits: str | bytes, source: str) -> int:
    """Return a number that a file announces.

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
        It has more than 18 digits.

    Examples
    --------
    >>> from delone.io.counts import announced
    >>> announced("00042", "survey.xyz")
    42
    >>> announced("9" * 5000, "survey.xyz")
    Traceback (most recent call last):
    ...
    delone.errors.FileFormatError: survey.xyz is torn: it announces a number of 5000 digits
    """
    text = digits.decode("ascii") if isinstance(digits, bytes) else digits.strip()
    short = text.lstrip("0") or "0"
    if len(short) > _DIGITS:
        raise FileFormatError(f"{source} is torn: it announces a number of {len(short)} digits")
    return int(short)
