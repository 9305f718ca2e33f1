"""Interpolators on the sphere by name, for xarray objects and the command line."""

from __future__ import annotations

import inspect
import math
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError
from delone.georeference import caller_level
from delone.interpolate.values import chosen
from delone.sphere.coordinates import LongitudeWarning
from delone.sphere.interpolation import Linear, NaturalNeighbor, Nearest

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

__all__ = ["METHODS", "interpolator", "warn_of_conventions"]

METHODS: Mapping[str, tuple[type[Linear | NaturalNeighbor | Nearest], dict[str, Any]]] = {
    "linear": (Linear, {}),
    "nearest": (Nearest, {}),
    "sibson": (NaturalNeighbor, {"kind": "sibson"}),
    "laplace": (NaturalNeighbor, {"kind": "laplace"}),
}


def interpolator(
    method: str, points: ArrayLike, **options: Any
) -> Linear | NaturalNeighbor | Nearest:
    """Return an interpolator of sites on the sphere by the name of its method."""
    kind, fixed = METHODS[chosen("method", method, tuple(METHODS))]
    known = [name for name in [*inspect.signature(kind).parameters][1:] if name not in fixed]
    for name in options:
        if name not in known:
            raise InputError(
                f"{name} is not an option of {method!r} on the sphere; its options are "
                f"{', '.join(known)}"
            )
    return kind(points, **fixed, **options)


def warn_of_conventions(
    sites: NDArray[np.float64], targets: NDArray[np.float64], *, degrees: bool
) -> None:
    """Warn if longitudes of sites are from 0 to 360 and those of targets from -180 to 180."""
    if not (np.isfinite(sites).any() and np.isfinite(targets).any()):
        return
    half = 180.0 if degrees else math.pi
    ranges = [(float(np.nanmin(part)), float(np.nanmax(part))) for part in (sites, targets)]
    (west, east), (low, high) = ranges
    if (east > half and low < 0) or (west < 0 and high > half):
        message = (
            f"longitudes of the points are from {west:g} to {east:g}, those of the targets from "
            f"{low:g} to {high:g}: both are taken modulo {2 * half:g}, and the result has the "
            "longitudes of the targets"
        )
        warnings.warn(message, LongitudeWarning, stacklevel=caller_level())
