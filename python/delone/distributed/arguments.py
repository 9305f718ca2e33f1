"""Validation of arguments other than points: paths, column names, classes, callbacks."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from delone._base.arrays import as_count
from delone._base.files import not_a_path
from delone.errors import DtypeError, InputError

__all__ = ["as_classes", "as_names", "as_path"]


def as_path(path: Any, *, name: str) -> Path:
    """Return a path, without null characters."""
    if isinstance(path, str | os.PathLike) and isinstance(text := os.fspath(path), str):
        if "\0" in text:
            raise InputError(f"{name} contains a null character: {text!r:.60}")
        # Otherwise ~ would be the name of a folder, which nobody wants.
        return Path(path).expanduser()
    raise not_a_path(path, name)


def as_names(names: Any, *, name: str, places: bool = False) -> tuple[Any, ...]:
    """Return column names or, if `places`, column numbers from 0; a single string is an error."""
    wanted = f"{name} must be a sequence of column names" + (" or numbers" if places else "")
    found = tuple(_sequence(names, wanted))
    for one in found:
        if places and not isinstance(one, str):
            as_count(one, name=f"{name}: a column number")
        elif not isinstance(one, str):
            raise DtypeError(f"{wanted}, got {one!r:.60} among them")
        elif not one:
            raise InputError(f"{wanted}, and none may be empty")
        if found.count(one) > 1:
            raise InputError(f"{name}: {one!r:.80} is repeated")
    return tuple(one if isinstance(one, str) else int(one) for one in found)


def as_classes(classes: Any) -> tuple[int, ...]:
    """Return numbers of classes of LAS files, 0 to 255."""
    wanted = "classes must be a sequence of integers from 0 to 255"
    found = tuple(as_count(one, name="a class") for one in _sequence(classes, wanted))
    if not found or max(found) > 255:
        raise InputError(f"{wanted}, got {list(found)}")
    return found


def _sequence(values: Any, wanted: str) -> Sequence[Any]:
    if isinstance(values, np.ndarray):
        values = values.tolist()
    if not isinstance(values, Sequence) or isinstance(values, str | bytes):
        raise DtypeError(f"{wanted}, got {values!r:.60}")
    return values
