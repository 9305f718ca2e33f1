"""Coordinate reference systems of input data, and the warning about degrees.

Everything that delone computes is planar. Longitudes and latitudes are taken as they are, which is
rarely what is meant: a degree of longitude is shorter near the poles, and 179.9 is next to -179.9.
So what is plainly in degrees is worth a warning. Plain arrays say nothing of themselves, and none
is given for them.
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
# What is recognized without pyproj.
_GEOGRAPHIC = re.compile(
    r"\s*(EPSG:(4326|4979|4258|4269)$|OGC:CRS84|GEOG|\+proj=longlat)", re.IGNORECASE
)
# Longitudes may be counted twice around; no latitude is beyond a pole.
_WIDEST, _HIGHEST = 720.0, 90.0


class GeographicWarning(UserWarning):
    """Longitudes and latitudes are about to be taken for coordinates of a plane.

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
    """A file is written without the reference system, for which its format has no place.

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
        What the argument is called in error messages.

    Returns
    -------
    str or None
        Authority and code where there are some, else WKT; None for none.

    Raises
    ------
    DtypeError
        It is none of these.

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
    raise DtypeError(f"{name} must be a reference system, as 'EPSG:28992', got {crs!r:.60}")


def crs_of(data: Any) -> str | None:
    """Return the reference system that data say they have.

    Parameters
    ----------
    data : object
        A GeoSeries, GeoDataFrame, `delone.io.PointSet` or anything else with an attribute ``crs``.

    Returns
    -------
    str or None
        None where they say nothing.

    Examples
    --------
    >>> from delone.datasets import ahn3
    >>> from delone.georeference import crs_of
    >>> crs_of(ahn3()), crs_of([(0, 0), (1, 1)])
    ('EPSG:28992', None)
    """
    # GeoDataFrames without geometry refuse to be asked.
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
        As `delone.from_geometry` takes them.

    Returns
    -------
    str or None
        None where nothing says.

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
                f"geometries are in {_short(found)} and in {_short(crs)}: bring them to one "
                "reference system, for example by to_crs of geopandas"
            )
        found = found or crs
    return found


def same_crs(a: str, b: str) -> bool:
    """Tell whether two texts name one reference system.

    Parameters
    ----------
    a, b : str
        Texts as `as_crs` returns them.

    Returns
    -------
    bool
        As pyproj says; without it, whether they are equal.

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
    """Tell whether a text is the name of a reference system.

    Parameters
    ----------
    crs : str
        Text as `as_crs` returns it.

    Returns
    -------
    bool
        As pyproj says; without it always True.

    Examples
    --------
    >>> from delone.georeference import is_known
    >>> is_known("EPSG:28992")
    True
    """
    return _parsed(crs) is not None or not _has_pyproj()


def is_geographic(crs: str) -> bool:
    """Tell whether coordinates of a reference system are longitudes and latitudes.

    Parameters
    ----------
    crs : str
        Text as `as_crs` returns it.

    Returns
    -------
    bool
        As pyproj says; without it, whether the text is one of the common ones.

    Examples
    --------
    >>> from delone.georeference import is_geographic
    >>> is_geographic("EPSG:4326"), is_geographic("EPSG:28992")
    (True, False)
    """
    known = _parsed(crs)
    return bool(_GEOGRAPHIC.match(crs)) if known is None else bool(known.is_geographic)


def names_degrees(names: Any) -> bool:
    """Tell whether columns are called longitude and latitude.

    Parameters
    ----------
    names : iterable of str
        Names of columns; units and further words behind the first word do not count.

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
    """Say by what data are recognized as longitudes and latitudes.

    Parameters
    ----------
    data : object
        What was given as points or geometries.

    Returns
    -------
    str or None
        The reference system or the names of columns; None where nothing says so. What the system
        says counts more than names.
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
    """Warn where data are longitudes and latitudes, unless they are meant to be planar.

    Parameters
    ----------
    data : object
        What was given.
    coordinates : ndarray of float64, shape (n, d)
        Its coordinates. Where they are too large for degrees nothing is said: files without a
        reference system may be taken for one in degrees.
    planar : bool
        Whether coordinates are meant as those of a plane, whatever they are.
    name : str, optional
        What the argument is called.
    by : str, optional
        By what they are known already; nothing is asked of the data then.

    Warns
    -----
    GeographicWarning
        They are longitudes and latitudes.
    """
    if planar is False and by is None and type(data) is np.ndarray:
        return  # who triangulates in a loop waits for this
    if not isinstance(planar, bool | np.bool_):
        raise DtypeError(f"planar must be True or False, got {planar!r:.60}")
    if planar:
        return
    found = by or degrees_in(data)
    if found and may_be_degrees(coordinates):
        warnings.warn(message_of_degrees(name, found), GeographicWarning, stacklevel=_level())


def may_be_degrees(coordinates: NDArray[np.float64]) -> bool:
    """Tell whether coordinates are in the range of longitudes and latitudes.

    Parameters
    ----------
    coordinates : ndarray of float64, shape (n, d)
        Coordinates, longitudes first.

    Returns
    -------
    bool
        Whether all that are finite are.

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
    """Return what is said of longitudes and latitudes.

    Parameters
    ----------
    what : str
        What they are.
    by : str
        By what they are known.

    Returns
    -------
    str
        One sentence.
    """
    return (
        f"{what} are longitudes and latitudes ({by}), taken as coordinates of a plane: distances "
        "are distorted, and 179.9 is far from -179.9. Project them first, or give planar=True"
    )


def _level() -> int:
    """The stack level of the first caller outside of the package."""
    level, frame = 2, sys._getframe(2)
    while frame.f_back is not None and str(frame.f_globals.get("__name__")).startswith("delone."):
        level, frame = level + 1, frame.f_back
    return level


def _short(crs: str) -> str:
    """Authority and code, or the name that WKT begins with."""
    named = re.match(r'\s*\w+\["([^"]+)"', crs)
    return named[1] if named else crs[:60]


def _has_pyproj() -> bool:
    return importlib.util.find_spec("pyproj") is not None


def _parsed(crs: str) -> Any:
    """The system as pyproj has it; None without pyproj, and for what it does not know."""
    if not _has_pyproj():
        return None
    pyproj = importlib.import_module("pyproj")
    try:
        return pyproj.CRS.from_user_input(crs)
    except (pyproj.exceptions.CRSError, ValueError):
        return None
