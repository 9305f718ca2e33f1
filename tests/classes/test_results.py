"""Results are compared by identity, as arrays have no single truth."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator
from dataclasses import fields, is_dataclass

import pytest

import delone

ARRAYS = ("NDArray", "Floats", "Indices", "Rows", "Bools", "Handles", "Masks")


def results() -> Iterator[type]:
    """Yield the data classes of the package that hold arrays, but for those of programs."""
    for module in pkgutil.walk_packages(delone.__path__, "delone."):
        if module.name.endswith("__main__"):
            continue
        for value in vars(importlib.import_module(module.name)).values():
            own = isinstance(value, type) and value.__module__ == module.name
            if own and is_dataclass(value) and any(_is_array(each.type) for each in fields(value)):
                yield value


def _is_array(annotation: object) -> bool:
    text = str(annotation)
    return "Callable" not in text and any(word in text for word in ARRAYS)


@pytest.mark.parametrize("kind", list(results()), ids=lambda kind: kind.__qualname__)
def test_results_of_arrays_are_equal_to_themselves_alone(kind: type) -> None:
    assert kind.__eq__ is object.__eq__
    assert kind.__hash__ is object.__hash__
