"""Errors for old names, which give the new name until 0.1.0.

A class with the decorator `renamed` does not have its old names, not even for ``hasattr``; reading
one raises AttributeError with the name to use.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Renamed", "renamed"]

K = TypeVar("K", bound=type)


class Renamed:
    """An attribute that now has a different name."""

    def __init__(self, old: str, new: str) -> None:
        self._old, self._new = old, new

    def __get__(self, owner: Any, kind: type) -> NoReturn:
        message = f"{kind.__name__}.{self._old} is now {kind.__name__}.{self._new}"
        raise AttributeError(message, name=self._old, obj=kind if owner is None else owner)


def renamed(**names: str) -> Callable[[K], K]:
    """Give a class and its subclasses errors that state the new names of attributes.

    Parameters
    ----------
    **names
        New names by old ones.
    """

    def decorate(kind: K) -> K:
        for old, new in names.items():
            setattr(kind, old, Renamed(old, new))
        return kind

    return decorate
