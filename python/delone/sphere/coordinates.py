"""Longitudes and latitudes, or vectors of any length, as the vectors that represent directions.

The core converts angles with its own sines and cosines, so that all platforms agree. Degrees are
reduced exactly; the doubles nearest to pi / 2 and pi are the poles and the date line in radians.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_flag,
    as_plain_array,
    as_points,
    as_vectors,
    as_workers,
    require_finite,
    wrong_shape,
)
from delone._base.counting import agreed, counted
from delone._base.georeference import caller_level, crs_of, parsed
from delone._base.immutable import own_copy
from delone._base.numbers import as_positive
from delone.errors import DirectionError, DtypeError, InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats

__all__ = [
    "BEYOND",
    "LongitudeWarning",
    "as_step",
    "directions_of",
    "lonlat_of",
    "numbers_of",
    "queries_of",
    "units_of",
]

# Latitudes of corners beyond a pole by a rounding error of float32 mean the pole.
BEYOND = 1 + 2.0**-22
# Longitudes beyond this many turns are a mistake, such as a wrong unit.
_TURNS = 3


class LongitudeWarning(UserWarning):
    """Longitudes span more than 360 degrees: those from 0 to 360 seem to be mixed with others.

    Examples
    --------
    >>> import warnings
    >>> from delone import sphere
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     warnings.simplefilter("always")
    ...     mesh = sphere.Delaunay(lonlat=[(-170, 0), (190, 0), (350, 10), (10, 20)])
    >>> caught[0].category.__name__, mesh.duplicates.tolist()
    ('LongitudeWarning', [[1, 0]])
    """


def directions_of(
    lonlat: ArrayLike | None,
    xyz: ArrayLike | None,
    *,
    degrees: bool,
    workers: int | None,
    any_turns: bool = False,
) -> Floats:
    """Return one of two kinds of input as vectors, (n, 3), that nobody else can change.

    Longitudes of more than one turn cause a warning, unless `any_turns`, as corners of cells have.
    Latitudes of such corners that are beyond a pole by a rounding error of float32 are the pole.
    """
    if (lonlat is None) == (xyz is None):
        given = "neither" if lonlat is None else "both"
        raise DtypeError(f"give one of lonlat=(n, 2) and xyz=(n, 3), got {given}")
    if xyz is not None:
        vectors = own_copy(xyz, ndim=None)
        if vectors.shape[1] != 3:
            raise ShapeError(f"xyz must have shape (n, 3), got {vectors.shape}: see lonlat")
        return vectors
    _refuse_projected(lonlat, "lonlat")
    degrees = as_flag(degrees, name="degrees")
    angles = as_points(lonlat, name="lonlat")  # type: ignore[arg-type]
    angles = angles if degrees else _quarters(angles, lonlat)
    if angles.shape[1] != 2:
        raise ShapeError(f"lonlat must have shape (n, 2), got {angles.shape}: see xyz")
    require_finite(angles, name="lonlat")
    if any_turns:
        angles = _at_poles(angles, 90.0 if degrees else math.pi / 2)
    _refuse_angles(angles, degrees=degrees, name="lonlat")
    if not any_turns:
        _warn_of_turns(angles, degrees=degrees)
    return _core.sphere_directions(angles, degrees, as_workers(workers))


def queries_of(xi: ArrayLike, *, degrees: bool, workers: int | None) -> Floats:
    """Return queries as vectors, (..., 3), from longitudes and latitudes, (..., 2), or vectors."""
    xi = numbers_of(xi, "xi")
    array = as_plain_array(xi, "xi")
    columns = array.shape[-1] if array.ndim else 0
    if columns not in {2, 3}:
        raise wrong_shape("xi", "(..., 2) or (..., 3)", array)
    if columns == 3:
        return as_vectors(xi, 3, name="xi")
    angles = as_vectors(xi, 2, name="xi")
    angles = angles if degrees else _quarters(angles, array)
    flat = angles.reshape(-1, 2)
    _refuse_angles(flat, degrees=degrees, name="xi")
    vectors = _core.sphere_directions(flat, degrees, as_workers(workers))
    return vectors.reshape((*angles.shape[:-1], 3))


def numbers_of(given: Any, name: str) -> Any:
    """Return shapely points and tables of them as longitudes and latitudes; others as given."""
    _refuse_projected(given, name)
    array = as_plain_array(given, name)
    return as_vectors(given, 2, name=name) if array.dtype.kind == "O" else given


def _refuse_projected(given: Any, name: str) -> None:
    """Reject input that declares a reference system whose coordinates are not angles."""
    system = None if type(given) is np.ndarray else crs_of(given)
    known = None if system is None else parsed(system)
    if known is not None and not known.is_geographic:
        raise InputError(
            f"{name} are coordinates of {system:.60}, not longitudes and latitudes: "
            "transform them to EPSG:4326 first, as to_crs does, or use the classes of the plane"
        )


def as_step(step: Any) -> float:
    """Return the largest distance between points of a drawn arc, in degrees, checked."""
    width = as_positive(step, name="step", finite=True)
    return width


def units_of(vectors: Floats, workers: int | None) -> Floats:
    """Return the unit vectors of vectors, rounded, (n, 3)."""
    return _core.sphere_units(vectors, as_workers(workers))


def lonlat_of(vectors: Floats) -> Floats:
    """Return the longitudes, -180 to 180, and latitudes of vectors in degrees, (n, 2)."""
    # Squares of long vectors may overflow.
    x, y, z = (vectors / np.abs(vectors).max(axis=1, keepdims=True)).T
    radians = np.column_stack((np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))))
    degrees: Floats = np.degrees(radians)
    return degrees


def _quarters(angles: Floats, given: Any) -> Floats:
    """Return angles in radians, with the float32 values of quarter turns replaced by doubles.

    The float32 nearest to pi / 2 is beyond the double nearest to it; both mean the pole.
    """
    kind = getattr(given, "dtype", None)
    if kind not in (np.float32, np.float16):
        return angles
    turns = np.arange(-4 * _TURNS, 4 * _TURNS + 1) * (math.pi / 2)
    short = turns.astype(kind).astype(np.float64)
    at = np.minimum(np.searchsorted(short, angles), len(short) - 1)
    return np.where(short[at] == angles, turns[at], angles)


def _at_poles(angles: Floats, quarter: float) -> Floats:
    """Return angles with latitudes beyond a pole by a rounding error set to the pole."""
    far = np.abs(angles[:, 1])
    beyond = (far > quarter) & (far <= quarter * BEYOND)
    if beyond.any():
        angles = angles.copy()
        angles[beyond, 1] = np.copysign(quarter, angles[beyond, 1])
    return angles


def _refuse_angles(angles: Floats, *, degrees: bool, name: str) -> None:
    """Reject latitudes beyond the poles and longitudes of many turns; NaN passes."""
    quarter, unit = (90.0, "degrees") if degrees else (math.pi / 2, "radians")
    beyond = np.abs(angles[:, 1]) > quarter
    if beyond.any():
        hint = f"latitudes are from -{quarter:g} to {quarter:g} {unit}"
        if np.nanmax(np.abs(angles[:, 0])) <= quarter:
            hint = "the first column is the longitude, the second the latitude"
        raise _refusal(beyond, f"{name}: {{}} a latitude beyond a pole, {{}}: {hint}")
    wide = np.abs(angles[:, 0]) > 4 * quarter * _TURNS
    if wide.any():
        hint = f"longitudes are in {unit}, at most {_TURNS} turns"
        raise _refusal(wide, f"{name}: {{}} a longitude of many turns, {{}}: {hint}")


def _refusal(rows: Bools, message: str) -> DirectionError:
    """Return the error about rows, whose count and first number complete the message."""
    found = np.flatnonzero(rows)
    count = len(found)
    subject = f"{counted(count, 'row')} {agreed(count, 'has', 'have')}"
    text = message.format(subject, f"first row {found[0]}")
    return DirectionError(text, rows=found[:10], count=count)


def _warn_of_turns(angles: Floats, *, degrees: bool) -> None:
    """Warn if longitudes span more than one turn."""
    if not len(angles):
        return
    turn = 360.0 if degrees else 2 * math.pi
    longitudes = angles[:, 0]
    west, east = int(longitudes.argmin()), int(longitudes.argmax())
    if longitudes[east] - longitudes[west] > turn:
        message = (
            f"longitudes span more than one turn, from {longitudes[west]:g} (row {west}) to "
            f"{longitudes[east]:g} (row {east}): they are taken modulo {turn:g}, so 190 and -170 "
            "degrees are one meridian"
        )
        warnings.warn(message, LongitudeWarning, stacklevel=caller_level())
