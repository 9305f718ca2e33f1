"""The contents of a file of points, and recognition of its coordinate columns.

A column is recognized by words that are common in surveying and mapping. If a header contains none
of them, nothing is guessed: two wrong columns would give a perfect triangulation of nonsense.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import counted
from delone.errors import FileFormatError
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import DTypeLike, NDArray

    Column = str | int

__all__ = ["PointSet", "choose_columns", "find_column", "names_height"]

_WORDS = {
    "x": {
        "x", "lon", "long", "lng", "longitude", "easting", "east", "e", "xcoord", "coordx",
        "decimallongitude", "locationlong", "gpslon", "gpslong", "gpslng", "gpslongitude",
    },
    "y": {
        "y", "lat", "latitude", "northing", "north", "n", "ycoord", "coordy",
        "decimallatitude", "locationlat", "gpslat", "gpslatitude",
    },
    "z": {
        "z", "h", "height", "elevation", "elev", "alt", "altitude", "depth", "bathymetry",
        "topography", "zcoord", "coordz", "gpsalt", "gpsaltitude", "gpselevation",
    },
}  # fmt: skip
# Number of characters of a reference system to show.
_SHORT = 40
# A column number has fewer digits.
_DIGITS = 9
_UNITS = {"m", "ft", "km", "mm", "cm", "deg", "degrees", "degree", "meters", "metres", "feet", "dd"}


@dataclass(frozen=True, eq=False, kw_only=True)
class PointSet:
    """The points of a file, row by row.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Horizontal coordinates, in the units of the file.
    z : ndarray of float64, shape (n,), optional
        Heights; None if the file has none.
    attributes : mapping of str to ndarray, optional
        Further values of each point, as requested.
    crs : str, optional
        Coordinate reference system, such as ``"EPSG:28992"``, or in WKT; None if the file has none.
    source : str, optional
        The file.
    columns : tuple of str, optional
        Names of the columns of x, y and z; empty if they have none.

    Notes
    -----
    A PointSet can be passed wherever points are expected; NumPy converts it to `points`. delone
    can then tell whether they are longitudes and latitudes: see `delone.GeographicWarning`.

    Examples
    --------
    >>> import delone, numpy as np
    >>> from delone.io import PointSet
    >>> survey = PointSet(points=np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]))
    >>> len(survey), delone.Delaunay(survey)
    (3, <Delaunay of 3 points: 1 triangle>)
    """

    points: NDArray[np.float64]
    z: NDArray[np.float64] | None = None
    attributes: Mapping[str, NDArray[Any]] = field(default_factory=lambda: MappingProxyType({}))
    crs: str | None = None
    source: str = ""
    columns: tuple[str, ...] = ()

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        """The horizontal coordinates."""
        found = self.points if dtype is None else self.points.astype(dtype, copy=False)
        return found.copy() if copy else found

    def __post_init__(self) -> None:
        check_system(self.crs, self.source)

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        columns = {"x": self.points[:, 0], "y": self.points[:, 1]}
        if self.z is not None:
            columns["z"] = self.z
        parts = [f"{name} {_span(column)}" for name, column in columns.items() if len(self)]
        if self.attributes:
            parts.append("attributes " + " ".join(self.attributes))
        if self.crs is not None:
            parts.append(_first_line(self.crs))
        text = f"<PointSet of {counted(len(self), 'point')}"
        return text + (": " + ", ".join(parts) if parts else "") + ">"


def _span(column: NDArray[np.float64]) -> str:
    """The smallest and the largest number, ignoring NaN."""
    low, high = (each.reduce(column) for each in (np.fmin, np.fmax))
    return "unknown" if np.isnan(low) else f"{low:.6g} to {high:.6g}"


def _first_line(crs: str) -> str:
    """The name of a reference system, or the beginning of its definition."""
    line = crs.strip().partition("\n")[0]
    return line if len(line) <= _SHORT else line[:_SHORT] + "..."


def find_column(names: Sequence[str], wanted: Column, source: str) -> int:
    """Return the position of a column given by name, in any case, or by number from 0.

    A string of digits is a number unless it is a name.
    """
    text = str(wanted).strip()
    folded = [name.strip().casefold() for name in names]
    if not isinstance(wanted, int):
        if names.count(text) > 1:
            raise FileFormatError(
                f"{source} has {names.count(text)} columns {text!r:.40}: choose one by its number"
            )
        if text in names:
            return list(names).index(text)
        if folded.count(text.casefold()) == 1:
            return folded.index(text.casefold())
    if text.isdecimal() and len(text) <= _DIGITS and int(text) < len(names):
        return int(text)
    raise FileFormatError(f"{source} has no column {text!r:.40}; its columns are {_listed(names)}")


def names_height(name: str) -> bool:
    """Return whether a name is one of the usual words for height or depth: "Depth [m]"."""
    return _word(name) in _WORDS["z"]


def choose_columns(
    names: Sequence[str], columns: Sequence[Column] | None, source: str, *, named: bool
) -> list[int]:
    """Return the positions of x, y and, if there is one, z among the numeric columns.

    Without `columns` they are recognized by name, or are the first ones if these are not `named`.
    """
    if columns is not None:
        if len(columns) not in (2, 3):
            raise FileFormatError(f"{source}: give two or three columns (x,y or x,y,z)")
        return [find_column(names, column, source) for column in columns]
    if not named:
        if len(names) < 2:
            raise FileFormatError(f"{source} has fewer than two numeric columns")
        return list(range(min(len(names), 3)))
    found = {role: _recognized(names, role, source) for role in _WORDS}
    if found["x"] is None or found["y"] is None:
        raise FileFormatError(
            f"{source}: which columns are x and y? Choose them (--columns x,y or x,y,z) from "
            f"{_listed(names)}"
        )
    return [position for position in found.values() if position is not None]


def _recognized(names: Sequence[str], role: str, source: str) -> int | None:
    words = [_word(name) for name in names]
    # The single letter takes precedence over every synonym.
    wins = role if role in words else next((word for word in words if word in _WORDS[role]), None)
    if wins is None:
        return None
    if words.count(wins) > 1:
        raise FileFormatError(
            f"{source}: which column is {role}? {words.count(wins)} are named {wins}; choose "
            f"(--columns) by number from 0 among {_listed(names)}"
        )
    return words.index(wins)


def _word(name: str) -> str:
    """Reduce a name to its word: ``Depth [m]`` to depth, ``X_COORD`` to xcoord."""
    parts = re.findall(r"[a-z]+|\d+", name.casefold())
    if len(parts) > 1 and parts[-1] in _UNITS:
        parts.pop()
    return "".join(parts)


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(names[:20])
    return shown + (", ..." if len(names) > 20 else "") if names else "none"
