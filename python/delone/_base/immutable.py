"""Base classes of immutable objects, which any number of threads may share.

Attributes derived from an object are computed on first use and kept; its arrays are read-only.
"""

from __future__ import annotations

import functools
import inspect
import threading
from typing import TYPE_CHECKING, Any, NoReturn, Self, TypeVar

import numpy as np

from delone._base.arrays import as_points
from delone._base.blocks import copied
from delone.errors import DtypeError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

__all__ = ["Immutable", "ReadOnly", "kept", "made_by", "own_copy", "sealed"]


class Immutable:
    """An object whose attributes are set once; the base of public classes."""

    __slots__ = ("__weakref__", "_cache", "_lock")

    _cache: dict[str, Any]
    _lock: threading.RLock

    def _hold(self, **values: Any) -> None:
        """Set all attributes once, each under its name with a leading underscore."""
        if hasattr(self, "_cache"):
            name = type(self).__name__
            raise AttributeError(f"a {name} never changes: create a new one")
        put = object.__setattr__
        put(self, "_cache", {})
        put(self, "_lock", threading.RLock())
        for name, value in values.items():
            put(self, "_" + name, value)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __delattr__(self, name: str) -> NoReturn:
        raise AttributeError(f"a {type(self).__name__} cannot be changed: {name}")

    def __setattr__(self, name: str, value: object) -> NoReturn:
        self.__delattr__(name)


class ReadOnly:
    """The base of frozen dataclasses with arrays that are read-only, even after unpickling."""

    def __post_init__(self) -> None:
        self._protect()

    def _protect(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False

    def __setstate__(self, state: dict[str, Any]) -> None:
        # NumPy does not pickle the writeable flag of arrays.
        vars(self).update(state)
        self._protect()

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


K = TypeVar("K", bound=type)


def made_by(how: str) -> Callable[[K], K]:
    """Give a class that functions create a constructor whose error says `how` to get an object."""

    def decorate(kind: K) -> K:
        def refuse(self: Any, *_: Any, **__: Any) -> NoReturn:
            raise DtypeError(how)

        kind.__init__ = refuse  # type: ignore[misc]
        kind.__signature__ = inspect.Signature()  # type: ignore[attr-defined]
        return kind

    return decorate


T = TypeVar("T")
Of = TypeVar("Of", bound=Immutable)


def kept(compute: Callable[[Of], T]) -> Callable[[Of], T]:
    """Compute once per object, even if several threads need it at the same time."""
    name = compute.__name__

    @functools.wraps(compute)
    def get(self: Of) -> T:
        cache = self._cache
        if name not in cache:
            with self._lock:
                if name not in cache:
                    cache[name] = compute(self)
        value: T = cache[name]
        return value

    return get


def sealed(array: NDArray[Any]) -> NDArray[Any]:
    """Return a read-only array that cannot be made writeable, not even through its base."""
    array.flags.writeable = False
    # An array that owns its memory can always be made writeable again, and a view reaches it
    # through its base. Arrays that own memory of the core cannot; other arrays get a memoryview as
    # their base, which cannot either.
    base = array.base
    if isinstance(base, np.ndarray):
        base.flags.writeable = False
        base = base.base
    if type(base).__name__ == "PySliceContainer":
        return array
    return np.asarray(array.data)


def own_copy(
    points: ArrayLike, *, ndim: int | None = 2, most: int = 3, few: bool | None = None
) -> NDArray[np.float64]:
    """Return points, like `as_points`, that cannot be changed, even while the core runs."""
    array = as_points(points, ndim=ndim, most=most, few=few)
    if array is points:
        return copied(array)
    if isinstance(points, list | tuple):
        return array
    if isinstance(points, np.ndarray) and not np.may_share_memory(points, array):
        return array
    return copied(array)
