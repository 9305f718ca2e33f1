"""Numbers with their nouns and verbs, for sentences and representations."""

from __future__ import annotations

__all__ = ["agreed", "counted"]

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


def agreed(count: int, one: str, many: str) -> str:
    """Return the words that go with a number.

    Parameters
    ----------
    count : int
        How many there are.
    one, many : str
        What is said of one, and of any other number.

    Returns
    -------
    str
        One of both.

    Examples
    --------
    >>> from delone.counting import agreed
    >>> agreed(1, "point comes", "points come"), agreed(2, "is", "are")
    ('point comes', 'are')
    """
    return one if count == 1 else many
