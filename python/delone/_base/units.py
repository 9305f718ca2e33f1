"""Units of length: their names, those of reference systems, and which ones must not be mixed.

Heights in feet over coordinates in meters give slopes and volumes that look plausible and are
wrong. So units that are known to differ are an error or cause a warning; unknown units do not.
"""

from __future__ import annotations

import warnings
from typing import Any

from delone._base.georeference import caller_level, parsed
from delone.errors import DtypeError, InputError

__all__ = [
    "METERS",
    "UnitsWarning",
    "area_units",
    "as_units",
    "heights_of_crs",
    "lengths_of_crs",
    "require_same_units",
    "volume_units",
    "warn_of_units",
]

# The length of each unit in meters.
METERS = {
    "mm": 0.001,
    "cm": 0.01,
    "m": 1.0,
    "km": 1000.0,
    "in": 0.0254,
    "ft": 0.3048,
    "us-ft": 1200 / 3937,
    "mi": 1609.344,
}
_WORDS = {
    "millimeter": "mm",
    "centimeter": "cm",
    "meter": "m",
    "metre": "m",
    "kilometer": "km",
    "inch": "in",
    "inches": "in",
    "foot": "ft",
    "feet": "ft",
    "international foot": "ft",
    "ussurveyfoot": "us-ft",
    "us survey foot": "us-ft",
    "us survey feet": "us-ft",
    "ftus": "us-ft",
    "mile": "mi",
}
# The two feet differ by two parts per million.
_SAME = 1e-9


class UnitsWarning(UserWarning):
    """Heights are in a different unit from x and y.

    Examples
    --------
    >>> from delone import UnitsWarning
    >>> issubclass(UnitsWarning, UserWarning)
    True
    """


def as_units(units: Any, *, name: str = "units") -> str | None:
    """Return the short name of a unit of length, a key of `METERS`; None for None."""
    if units is None:
        return None
    if not isinstance(units, str):
        raise DtypeError(f"{name} must be a unit such as 'm' or 'ft', got {units!r:.60}")
    word = units.strip().casefold()
    found = word if word in METERS else _WORDS.get(word, _WORDS.get(word.removesuffix("s")))
    if found is None:
        raise InputError(
            f"{name} must be a unit of length ({', '.join(METERS)}), got {units!r:.60}"
        )
    return found


def lengths_of_crs(crs: str | None) -> str | None:
    """Return the unit of x and y of a reference system; None if unknown, or an angle."""
    return _of_axes(crs, vertical=False)


def heights_of_crs(crs: str | None) -> str | None:
    """Return the unit of the vertical axis of a reference system; None without one."""
    return _of_axes(crs, vertical=True)


def _of_axes(crs: str | None, *, vertical: bool) -> str | None:
    system = None if crs is None else parsed(crs)
    if system is None:
        return None
    for axis in system.axis_info:
        if (axis.direction in ("up", "down")) == vertical:
            if axis.unit_name in ("degree", "radian", "grad"):
                return None
            return _of_length(axis.unit_conversion_factor)
    return None


def _of_length(meters: float) -> str | None:
    for unit, length in METERS.items():
        if abs(length - meters) <= _SAME * length:
            return unit
    return None


def area_units(crs: str | None) -> str | None:
    """Return the unit of areas in a reference system, such as m2; None if unknown."""
    lengths = lengths_of_crs(crs)
    return None if lengths is None else f"{lengths}2"


def volume_units(crs: str | None, heights: str | None) -> str | None:
    """Return the unit of volumes, such as m3, or "ft m2" for heights in feet over meters."""
    lengths = lengths_of_crs(crs)
    if lengths is None or heights is None:
        return None
    return f"{lengths}3" if lengths == heights else f"{heights} {lengths}2"


def require_same_units(a: str | None, b: str | None, *, what: str) -> None:
    """Reject two units of heights that are known to differ."""
    if a is not None and b is not None and a != b:
        raise InputError(
            f"{what}: heights are in {a} and in {b}: multiply those in {b} by "
            f"{METERS[b] / METERS[a]:.12g} first"
        )


def warn_of_units(lengths: str | None, heights: str | None, *, by: str) -> None:
    """Warn if heights are known to be in a different unit from x and y; `by` says from what."""
    if lengths is None or heights is None or lengths == heights:
        return
    warnings.warn(
        f"x and y are in {lengths} and heights in {heights} ({by:.60}): slopes and volumes mix "
        f"both. Multiply the heights by {METERS[heights] / METERS[lengths]:.12g}",
        UnitsWarning,
        stacklevel=caller_level(),
    )
