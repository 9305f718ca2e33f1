"""Grids by short names, such as 1x1 and healpix:64."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from delone.errors import InputError
from delone.sphere.grid import Grid

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["NAMES", "named_grid"]

NAMES = "1x1 (degrees of longitude and latitude), healpix:64, healpix:64:nested, n80, o80"
_NUMBER = r"(\d+(?:\.\d*)?|\.\d+)"


def named_grid(name: str, *, workers: int | None = None) -> Grid:
    """Return the grid with a name: see `NAMES`."""
    text = name.strip().casefold()
    if found := re.fullmatch(f"{_NUMBER}x{_NUMBER}", text):
        return Grid.from_lonlat(
            _edges(found[1], 0, 360, name), _edges(found[2], -90, 90, name), workers=workers
        )
    if found := re.fullmatch(r"healpix:(\d+)(?::(ring|nested|nest))?", text):
        order = "ring" if found[2] in {None, "ring"} else "nested"
        return Grid.from_healpix(int(found[1]), order, workers=workers)
    if found := re.fullmatch(r"([no])(\d+)", text):
        points = "octahedral" if found[1] == "o" else None
        return Grid.from_gaussian(int(found[2]), points, workers=workers)
    raise InputError(f"no grid is called {name!r:.60}; names are {NAMES}")


def _edges(step: str, low: int, high: int, name: str) -> NDArray[np.float64]:
    """Return edges of equal cells of a decimal number of degrees."""
    size = Fraction(step)
    count = (high - low) / size if size else Fraction(0)
    if not count or count.denominator != 1:
        raise InputError(f"{name!r:.60}: {step} degrees do not divide {high - low} degrees")
    found: NDArray[np.float64] = low + (high - low) * np.arange(int(count) + 1) / int(count)
    return found
