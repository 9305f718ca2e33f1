"""The arguments of `Dynamic`: points, or objects whose points are used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_plain_array, as_points, as_queries, refuse_hidden
from delone._base.immutable import own_copy
from delone._base.values import refuse_rounded, require_real
from delone._tiling.complex import Stored
from delone.constrained import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.dynamic.segments import FEW
from delone.errors import InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = ["as_any_values", "as_ndim", "as_values", "given_points", "own_points"]

_LARGEST_EXACT_INTEGER = 2**53


def given_points(points: Any) -> Any:
    """The points of accepted objects; others are rejected by name."""
    if not isinstance(points, Stored):
        return points
    if isinstance(points, Delaunay | ConstrainedDelaunay):
        return points.points
    name = type(points).__name__
    raise InputError(
        f"Dynamic takes points, a Delaunay or a ConstrainedDelaunay, not a {name}, of which "
        "only the points would be left: pass its points, and its segments if it has any"
    )


def as_ndim(ndim: int | None) -> int | None:
    """Return a number of coordinates, checked."""
    if ndim not in (None, 2, 3):
        raise ShapeError(f"ndim must be 2 or 3, got {ndim!r:.80}")
    return ndim


def own_points(points: ArrayLike, ndim: int, crs: str | None) -> Floats:
    """Return points that cannot change while the core runs, in a reference system."""
    array = as_points(points, ndim=ndim)
    if type(points) is not np.ndarray and hasattr(points, "crs"):
        array = as_queries(points, ndim, crs, name="points", to="the triangulation")
    return array if len(array) <= FEW else own_copy(array, ndim=ndim)


def as_any_values(values: ArrayLike) -> NDArray[Any]:
    """Return values of any dtype as an array; none may be masked."""
    refuse_hidden(values, "values")
    return as_plain_array(values, "values")


def as_values(values: ArrayLike) -> NDArray[Any]:
    """Return values to interpolate as doubles or complex numbers, without rounding."""
    array = as_any_values(values)
    if array.size:
        require_real(array, "values", kinds="iufc")
    if array.dtype in (np.float64, np.complex128):
        return array
    plain = array.astype(np.complex128 if array.dtype.kind == "c" else np.float64)
    refuse_rounded(array, plain, "values")
    return plain
