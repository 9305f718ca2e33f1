"""Numbers with their nouns, for sentences and representations."""

from __future__ import annotations

__all__ = ["counted"]

# Nouns that do not take an s.
_MANY = {"tetrahedron": "tetrahedra", "vertex": "vertices", "pass": "passes"}


def counted(count: int, noun: str) -> str:
    """Return a number and its noun.

    Parameters
    ----------
    count : int
        How many there are.
    noun : str
        The noun for one.

    Returns
    -------
    str
        Both, the noun in the plural unless there is one.

    Examples
    --------
    >>> from delone.counting import counted
    >>> counted(1, "point"), counted(2, "point"), counted(0, "vertex")
    ('1 point', '2 points', '0 vertices')
    """
    return f"{count} {noun if count == 1 else _MANY.get(noun, noun + 's')}"
