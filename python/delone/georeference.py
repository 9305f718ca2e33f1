"""Coordinate reference systems of input data, and the warning about degrees.

Everything that delone computes is planar. Longitudes and latitudes are used as they are, which is
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

from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "CRSWarning",
    "GeographicWarning",
    "as_crs",
    "common_crs",
    "crs_of",
    "degrees_in",
    "is_geographic",
    "is_known",
    "may_be_degrees",
    "message_of_degrees",
    "names_degrees",
    "same_crs",
    "warn_of_degrees",
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
    """A file is written without the reference system, because its format cannot store one.

    Examples
    --------
    >>> from delone import CRSWarning
    >>> issubclass(CRSWarning, UserWarning)
    True
    """


def as_crs(crs: Any, *, name: str = "crs") -> str | None:
    """Return a reference system as text.

    Parameters
    ----------
    crs : str, int, pyproj.CRS or None
        ``"EPSG:28992"``, the number of an EPSG code, WKT, or an object that has ``to_string``.
    name : str, optional
        Name of the argument in error messages.

    Returns
    -------
    str or None
        Authority and code if available, else WKT; None for None.

    Raises
    ------
    DtypeError
        It is not one of these.

    Examples
    --------
    >>> from delone.georeference import as_crs
    >>> as_crs(28992)
    'EPSG:28992'
    """
    if crs is None or isinstance(crs, str):
        return crs or None
    if isinstance(crs, int | np.integer) and not isinstance(crs, bool):
        return f"EPSG:{int(crs)}"
    if hasattr(crs, "to_string"):
        return str(crs.to_string())
    raise DtypeError(f"{name} must be a reference system such as 'EPSG:28992', got {crs!r:.60}")


def crs_of(data: Any) -> str | None:
    """Return the reference system that data declare.

    Parameters
    ----------
    data : object
        A GeoSeries, GeoDataFrame, `delone.io.PointSet` or anything else with an attribute ``crs``.

    Returns
    -------
    str or None
        The reference system; None if they declare none.

    Examples
    --------
    >>> from delone.datasets import ahn3
    >>> from delone.georeference import crs_of
    >>> crs_of(ahn3()), crs_of([(0, 0), (1, 1)])
    ('EPSG:28992', None)
    """
    # GeoDataFrames without a geometry column raise an error.
    try:
        found = getattr(data, "crs", None)
    except Exception:
        return None
    return as_crs(found) if isinstance(found, str) or hasattr(found, "to_string") else None


def common_crs(geometries: Any) -> str | None:
    """Return the reference system of geometries, or of all tables in a list or tuple of them.

    Parameters
    ----------
    geometries : object
        As for `delone.from_geometry`.

    Returns
    -------
    str or None
        The reference system; None if none is declared.

    Raises
    ------
    InputError
        Two parts have different systems.
    """
    parts = geometries if isinstance(geometries, list | tuple) else [geometries]
    found: str | None = None
    for part in parts:
        crs = crs_of(part)
        if crs is None:
            continue
        if found is not None and not same_crs(found, crs):
            raise InputError(
                f"geometries are in {_short(found)} and in {_short(crs)}: transform them to one "
                "reference system, for example with geopandas to_crs"
            )
        found = found or crs
    return found


def same_crs(a: str, b: str) -> bool:
    """Return whether two strings denote the same reference system.

    Parameters
    ----------
    a, b : str
        Strings as returned by `as_crs`.

    Returns
    -------
    bool
        According to pyproj; without it, whether they are equal.

    Examples
    --------
    >>> from delone.georeference import same_crs
    >>> same_crs("EPSG:28992", "EPSG:28992")
    True
    """
    if a == b:
        return True
    first, second = _parsed(a), _parsed(b)
    return first is not None and second is not None and bool(first == second)


def is_known(crs: str) -> bool:
    """Return whether a string denotes a reference system.

    Parameters
    ----------
    crs : str
        String as returned by `as_crs`.

    Returns
    -------
    bool
        According to pyproj; without it always True.

    Examples
    --------
    >>> from delone.georeference import is_known
    >>> is_known("EPSG:28992")
    True
    """
    return _parsed(crs) is not None or not _has_pyproj()


def is_geographic(crs: str) -> bool:
    """Return whether coordinates of a reference system are longitudes and latitudes.

    Parameters
    ----------
    crs : str
        String as returned by `as_crs`.

    Returns
    -------
    bool
        According to pyproj; without it, whether it is one of the common ones.

    Examples
    --------
    >>> from delone.georeference import is_geographic
    >>> is_geographic("EPSG:4326"), is_geographic("EPSG:28992")
    (True, False)
    """
    known = _parsed(crs)
    return bool(_GEOGRAPHIC.match(crs)) if known is None else bool(known.is_geographic)


def names_degrees(names: Any) -> bool:
    """Return whether columns are named longitude and latitude.

    Parameters
    ----------
    names : iterable of str
        Names of columns; units and other words after the first are ignored.

    Returns
    -------
    bool
        Whether both are among them.

    Examples
    --------
    >>> from delone.georeference import names_degrees
    >>> names_degrees(["Longitude [deg]", "LAT", "depth"]), names_degrees(["x", "lat"])
    (True, False)
    """
    words = {found[0] for name in names if (found := re.findall(r"[a-z]+", str(name).casefold()))}
    return bool(words & _LONGITUDE and words & _LATITUDE)


def degrees_in(data: Any) -> str | None:
    """Return what identifies data as longitudes and latitudes.

    Parameters
    ----------
    data : object
        The points or geometries.

    Returns
    -------
    str or None
        The reference system or the names of columns; None if they are not identified. The system
        takes precedence over names.
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

    Parameters
    ----------
    data : object
        The points or geometries.
    coordinates : ndarray of float64, shape (n, d)
        The coordinates. If they are too large for degrees there is no warning: a library may assume
        degrees for files without a reference system.
    planar : bool
        Whether the coordinates are declared to be planar, whatever they are.
    name : str, optional
        Name of the argument.
    by : str, optional
        What identifies them, if already known; the data are then not examined.

    Warns
    -----
    GeographicWarning
        The data are longitudes and latitudes.
    """
    if planar is False and by is None and type(data) is np.ndarray:
        return  # hot path for small inputs
    if not isinstance(planar, bool | np.bool_):
        raise DtypeError(f"planar must be True or False, got {planar!r:.60}")
    if planar:
        return
    found = by or degrees_in(data)
    if found and may_be_degrees(coordinates):
        warnings.warn(message_of_degrees(name, found), GeographicWarning, stacklevel=caller_level())


def may_be_degrees(coordinates: NDArray[np.float64]) -> bool:
    """Return whether coordinates are in the range of longitudes and latitudes.

    Parameters
    ----------
    coordinates : ndarray of float64, shape (n, d)
        Coordinates, longitudes first.

    Returns
    -------
    bool
        Whether all finite coordinates are in the range.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.georeference import may_be_degrees
    >>> may_be_degrees(np.array([(4.5, 52.0)])), may_be_degrees(np.array([(85000.0, 446000.0)]))
    (True, False)
    """
    with np.errstate(invalid="ignore"):
        far = (np.abs(coordinates[:, 0]) > _WIDEST) | (np.abs(coordinates[:, 1]) > _HIGHEST)
    return not bool((far & np.isfinite(coordinates).all(axis=1)).any())


def message_of_degrees(what: str, by: str) -> str:
    """Return the message about longitudes and latitudes.

    Parameters
    ----------
    what : str
        Name of the data.
    by : str
        What identifies them.

    Returns
    -------
    str
        One sentence.
    """
    return (
        f"{what} are longitudes and latitudes ({by}), used as planar coordinates: distances "
        "are distorted, and 179.9 is far from -179.9. Project them first, or give planar=True"
    )


def caller_level() -> int:
    """Return the stack level of the first caller outside of the package, for a warning.

    Returns
    -------
    int
        For ``warnings.warn`` in the function that calls this one.
    """
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


def _parsed(crs: str) -> Any:
    """The pyproj object; None without pyproj, and for unknown systems."""
    if not _has_pyproj():
        return None
    pyproj = importlib.import_module("pyproj")
    try:
        return pyproj.CRS.from_user_input(crs)
    except (pyproj.exceptions.CRSError, ValueError):
        return None
