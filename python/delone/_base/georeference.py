"""Coordinate reference systems of input data, and the warning about degrees.

Everything that delone computes is planar. Longitudes and latitudes are used unchanged, which is
rarely intended: a degree of longitude is shorter near the poles, and 179.9 is next to -179.9. Data
that are known to be in degrees therefore cause a warning. Plain arrays carry no such information
and cause none.
"""

from __future__ import annotations

import importlib
import importlib.util
import re
import sys
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "CRSWarning",
    "GeographicWarning",
    "as_crs",
    "as_degrees",
    "as_known_crs",
    "beyond_degrees",
    "caller_level",
    "column_words",
    "common_crs",
    "crs_of",
    "degrees_in",
    "is_geographic",
    "is_known",
    "may_be_degrees",
    "message_of_degrees",
    "names_degrees",
    "parsed",
    "same_crs",
    "transformed",
    "warn_of_degrees",
    "warn_of_unknown",
]

_LONGITUDE = {"lon", "long", "lng", "longitude"}
_LATITUDE = {"lat", "latitude"}
# Systems that are recognized without pyproj.
_GEOGRAPHIC = re.compile(
    r"\s*(EPSG:(4326|4979|4258|4269)$|OGC:CRS84|GEOG|\+proj=longlat)", re.IGNORECASE
)
# Longitudes may span two turns; no latitude is beyond a pole.
_WIDEST, _HIGHEST = 720.0, 90.0


class GeographicWarning(UserWarning):
    """Longitudes and latitudes are used as planar coordinates.

    Examples
    --------
    >>> import warnings
    >>> import delone
    >>> warnings.simplefilter("error", delone.GeographicWarning)
    >>> survey = delone.datasets.baja()
    >>> try:
    ...     delone.Delaunay(survey)
    ... except delone.GeographicWarning as warning:
    ...     print(str(warning)[:39])
    points are longitudes and latitudes (EP
    >>> delone.Delaunay(survey, planar=True).nsimplex > 0
    True
    >>> warnings.simplefilter("default", delone.GeographicWarning)
    """


class CRSWarning(UserWarning):
    """A reference system is unknown, or is lost.

    Data that could declare their system and do not are used with data in a known system, as if
    they were in the same one; or a file is written without it, because its format cannot store it.

    Examples
    --------
    >>> from delone import CRSWarning
    >>> issubclass(CRSWarning, UserWarning)
    True
    """


def as_crs(crs: Any, *, name: str = "crs") -> str | None:
    """Return a reference system as text: authority and code if available, else WKT; None for None.

    Takes text, the number of an EPSG code, or an object with ``to_string``, such as pyproj.CRS.
    """
    if crs is None or isinstance(crs, str):
        return crs or None
    if isinstance(crs, int | np.integer) and not isinstance(crs, bool):
        return f"EPSG:{int(crs)}"
    if hasattr(crs, "to_string"):
        return str(crs.to_string())
    raise DtypeError(f"{name} must be a reference system such as 'EPSG:28992', got {crs!r:.60}")


def as_known_crs(crs: Any, *, name: str = "crs") -> str | None:
    """Return a reference system like `as_crs`; reject one that pyproj, if installed, rejects."""
    found = as_crs(crs, name=name)
    if found is None or is_known(found):
        return found
    raise InputError(
        f"{name} must be a reference system such as 'EPSG:28992'; pyproj does not know {crs!r:.60}"
    )


def crs_of(data: Any) -> str | None:
    """Return the reference system that data declare in an attribute ``crs``; None without one."""
    # GeoDataFrames without a geometry column raise an error.
    try:
        found = getattr(data, "crs", None)
    except Exception:
        return None
    return as_crs(found) if isinstance(found, str) or hasattr(found, "to_string") else None


def common_crs(geometries: Any) -> str | None:
    """Return the one system of geometries, or of all tables in a list or tuple; None without.

    Tables without one are assumed to be in the same system, with a warning.
    """
    parts = geometries if isinstance(geometries, list | tuple) else [geometries]
    found: str | None = None
    is_unknown = False
    for part in parts:
        crs = crs_of(part)
        if crs is None:
            is_unknown = is_unknown or hasattr(part, "crs")
            continue
        if found is not None and not same_crs(found, crs):
            raise InputError(
                f"geometries are in {_short(found)} and in {_short(crs)}: transform them to one "
                "reference system, for example with geopandas to_crs"
            )
        found = found or crs
    if is_unknown and found is not None:
        warn_of_unknown(found, known="some geometries", unknown="others")
    return found


def transformed(
    data: Any, points: NDArray[np.float64], target: str | None, *, name: str, to: str
) -> NDArray[np.float64]:
    """Return points of `data`, x and y first, in the reference system of other data.

    If both systems are known and different, pyproj transforms. If one of them is unknown, both are
    assumed to be the same, with a warning if data could declare one. `to` describes the other data.
    """
    source = common_crs(data)
    if source is None or target is None:
        if source is not None:
            warn_of_unknown(source, known=name, unknown=to)
        elif target is not None and _could_declare(data):
            warn_of_unknown(target, known=to, unknown=name)
        return points
    if same_crs(source, target):
        return points
    pyproj = require("pyproj", extra="geo", what=f"{_short(source)} to {_short(target)}")
    convert = pyproj.Transformer.from_crs(source, target, always_xy=True)
    moved = points.copy()
    moved[:, 0], moved[:, 1] = convert.transform(points[:, 0], points[:, 1])
    lost = np.isfinite(points[:, :2]).all(axis=1) & ~np.isfinite(moved[:, :2]).all(axis=1)
    if lost.any():
        x, y = points[lost][0, :2]
        raise InputError(
            f"{name}: ({x:.10g}, {y:.10g}) has no place in {_short(target)}: it is not in "
            f"{_short(source)}, which the data declare"
        )
    return moved


def warn_of_unknown(system: str, *, known: str, unknown: str) -> None:
    """Warn that data without a reference system are assumed to be in that of other data."""
    warnings.warn(
        f"the reference system of {known} is {_short(system)}; that of {unknown} is unknown, and "
        "assumed to be the same",
        CRSWarning,
        stacklevel=caller_level(),
    )


def _could_declare(data: Any) -> bool:
    """Return whether data have an attribute for their reference system."""
    parts = data if isinstance(data, list | tuple) else [data]
    return any(hasattr(part, "crs") for part in parts)


def same_crs(a: str, b: str) -> bool:
    """Return whether two results of `as_crs` denote one system; without pyproj, whether equal."""
    if a == b:
        return True
    first, second = parsed(a), parsed(b)
    return first is not None and second is not None and bool(first == second)


def as_degrees(
    coordinates: NDArray[np.float64], crs: str | None, *, name: str
) -> NDArray[np.float64]:
    """Return coordinates in a reference system, (n, 2), as longitudes and latitudes in degrees.

    Without a system, they are assumed to be such; coordinates in other systems are transformed with
    pyproj, and rejected without it.
    """
    if crs is None or is_geographic(crs):
        return coordinates
    if not _has_pyproj() or parsed(crs) is None:
        raise InputError(
            f"{name}: longitudes and latitudes are needed, and {_short(crs)} has others: transform "
            'them, for example with geopandas to_crs("EPSG:4326"), or pip install "delone[geo]"'
        )
    pyproj = importlib.import_module("pyproj")
    change = pyproj.Transformer.from_crs(crs, "OGC:CRS84", always_xy=True)
    found = np.column_stack(change.transform(*coordinates.T))
    lost = np.flatnonzero(~np.isfinite(found).all(axis=1) & np.isfinite(coordinates).all(axis=1))
    if len(lost):
        place = tuple(coordinates[lost[0]].tolist())
        raise InputError(
            f"{name}: {_short(crs)} has no longitude and latitude for {place}: is it the system of "
            "these coordinates?"
        )
    return found


def is_known(crs: str) -> bool:
    """Return whether a string denotes a reference system; without pyproj always True."""
    return parsed(crs) is not None or not _has_pyproj()


def is_geographic(crs: str) -> bool:
    """Return whether coordinates are degrees; without pyproj, for common systems."""
    known = parsed(crs)
    return bool(_GEOGRAPHIC.match(crs)) if known is None else bool(known.is_geographic)


def column_words(name: Any) -> set[str]:
    """Return the words in the name of a column: "decimalLongitude" has "longitude"."""
    return {each.casefold() for each in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", str(name))}


def names_degrees(names: Any) -> bool:
    """Return whether columns are named longitude and latitude; units after names are ignored."""
    words = {word for name in names for word in column_words(name)}
    return bool(words & _LONGITUDE and words & _LATITUDE)


def degrees_in(data: Any) -> str | None:
    """Return the reference system or column names that identify degrees; None if nothing does.

    The system takes precedence over names.
    """
    if isinstance(data, np.ndarray | list | tuple):
        return None
    crs = crs_of(data)
    if crs is not None:
        return _short(crs) if is_geographic(crs) else None
    names = getattr(data, "columns", None)
    if names is None or isinstance(names, str) or not hasattr(names, "__iter__"):
        return None
    listed = [str(name) for name in names]
    return f"columns {', '.join(listed)}" if names_degrees(listed) else None


def warn_of_degrees(
    data: Any,
    coordinates: NDArray[np.float64],
    *,
    planar: bool,
    name: str = "points",
    by: str | None = None,
) -> None:
    """Warn if data are longitudes and latitudes, unless they are declared to be planar.

    `by` is what identifies them, if known. Coordinates too large for degrees cause no warning:
    libraries may assume degrees for files without a reference system.
    """
    if planar is False and by is None and type(data) is np.ndarray:
        return  # hot path for small inputs
    if not isinstance(planar, bool | np.bool_):
        raise DtypeError(f"planar must be True (planar coordinates) or False, got {planar!r:.60}")
    if planar:
        return
    found = by or degrees_in(data)
    if found and may_be_degrees(coordinates):
        warnings.warn(message_of_degrees(name, found), GeographicWarning, stacklevel=caller_level())


def may_be_degrees(coordinates: NDArray[np.float64]) -> bool:
    """Return whether all finite coordinates, longitudes first, are in the range of degrees."""
    return not bool(beyond_degrees(coordinates).any())


def beyond_degrees(coordinates: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return which rows of finite coordinates are not in the range of degrees."""
    with np.errstate(invalid="ignore"):
        far = (np.abs(coordinates[:, 0]) > _WIDEST) | (np.abs(coordinates[:, 1]) > _HIGHEST)
    return np.asarray(far & np.isfinite(coordinates).all(axis=1))


def message_of_degrees(what: str, by: str) -> str:
    """Return the message that `what` are longitudes and latitudes, as identified `by` something."""
    return (
        f"{what} are longitudes and latitudes ({by}), used as planar coordinates: distances "
        "are distorted, and 179.9 is far from -179.9. Project them first, triangulate them on the "
        "sphere with delone.sphere, or give planar=True"
    )


def caller_level() -> int:
    """Return the stack level of the first caller outside the package, for ``warnings.warn``."""
    level, frame = 2, sys._getframe(2)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("delone."):
        level, frame = level + 1, frame.f_back
    return level


def _short(crs: str) -> str:
    """Authority and code, or the name at the beginning of WKT."""
    named = re.match(r'\s*\w+\["([^"]+)"', crs)
    return named[1] if named else crs[:60]


def _has_pyproj() -> bool:
    return importlib.util.find_spec("pyproj") is not None


def parsed(crs: str) -> Any:
    """Return the pyproj object; None without pyproj, and for unknown systems."""
    if not _has_pyproj():
        return None
    pyproj = importlib.import_module("pyproj")
    try:
        return pyproj.CRS.from_user_input(crs)
    except (pyproj.exceptions.CRSError, ValueError):
        return None
