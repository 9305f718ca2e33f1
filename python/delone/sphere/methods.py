"""Interpolators on the sphere by name, for xarray objects and the command line."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice
from delone.errors import InputError
from delone.sphere.coordinates import queries_of
from delone.sphere.interpolation import Linear, NaturalNeighbor, Nearest
from delone.sphere.raster import globe_nodes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from delone.interpolate.weights import Weights
    from delone.sphere.vectors import Vectors

__all__ = ["METHODS", "directions", "globe_nodes", "interpolator", "vector_weights"]

METHODS: Mapping[str, tuple[type[Linear | NaturalNeighbor | Nearest], dict[str, Any]]] = {
    "linear": (Linear, {}),
    "nearest": (Nearest, {}),
    "sibson": (NaturalNeighbor, {"kind": "sibson"}),
    "laplace": (NaturalNeighbor, {"kind": "laplace"}),
}


def interpolator(
    points: ArrayLike, values: ArrayLike | None = None, method: str = "linear", **options: Any
) -> Linear | NaturalNeighbor | Nearest:
    """Return an interpolator of sites on the sphere by the name of its method."""
    kind, fixed = METHODS[as_choice(method, tuple(METHODS), name="method")]
    known = [name for name in [*inspect.signature(kind).parameters][2:] if name not in fixed]
    for name in options:
        if name not in known:
            raise InputError(
                f"{name} is not an option of {method!r:.80} on the sphere; its options are "
                f"{', '.join(known)}"
            )
    return kind(points, values, **fixed, **options)


def directions(lonlat: NDArray[np.float64], *, degrees: bool) -> NDArray[np.float64]:
    """Return longitudes and latitudes, (..., 2), as vectors, (..., 3); NaN stays NaN."""
    return queries_of(lonlat, degrees=degrees, workers=None)


def vector_weights(
    made: Linear | NaturalNeighbor | Nearest,
    table: Weights,
    lonlat: NDArray[np.float64],
    *,
    degrees: bool,
) -> Vectors:
    """Return the table for vectors at longitudes and latitudes, from the table for numbers."""
    longitudes = np.radians(lonlat[..., 0]) if degrees else lonlat[..., 0]
    return made._transports(directions(lonlat, degrees=degrees), table, longitudes.ravel())
