"""Checks of numeric arguments: one function, with one message, for each kind of range."""

from __future__ import annotations

import math
from typing import Any

from delone._base.arrays import as_number
from delone.errors import InputError

__all__ = ["as_between", "as_finite", "as_nonnegative", "as_positive", "as_share"]


def as_positive(value: Any, *, name: str, finite: bool = False) -> float:
    """Return a number above 0, which may be infinite unless `finite`."""
    number = as_number(value, name=name)
    return _checked(number, number > 0, "above 0", value, name, finite)


def as_nonnegative(value: Any, *, name: str, finite: bool = False) -> float:
    """Return a number of at least 0, which may be infinite unless `finite`."""
    number = as_number(value, name=name)
    return _checked(number, number >= 0, "at least 0", value, name, finite)


def as_share(value: Any, *, name: str, most: float = 1) -> float:
    """Return a number above 0 and at most `most`."""
    number = as_number(value, name=name)
    return _checked(number, 0 < number <= most, f"above 0 and at most {most}", value, name)


def as_between(value: Any, low: float, high: float, *, name: str) -> float:
    """Return a number in a closed range."""
    number = as_number(value, name=name)
    return _checked(number, low <= number <= high, f"from {low} to {high}", value, name)


def as_finite(value: Any, *, name: str) -> float:
    """Return a finite number."""
    number = as_number(value, name=name)
    return _checked(number, math.isfinite(number), "finite", value, name)


def _checked(  # noqa: PLR0917
    number: float, right: bool, wanted: str, value: Any, name: str, finite: bool = False
) -> float:
    if right and not (finite and math.isinf(number)):
        return number
    also = " and finite" if finite else ""
    raise InputError(f"{name} must be {wanted}{also}, got {value!r:.80}")
