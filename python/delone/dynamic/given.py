"""What callers of `Dynamic` give: points, or what is taken whole for its points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._arrays import as_points
from delone.complex import Stored
from delone.constrained import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.dynamic.segments import FEW
from delone.errors import InputError, ShapeError
from delone.immutable import own_copy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

__all__ = ["as_ndim", "given_points", "own_points"]


def given_points(points: Any) -> Any:
    """The points of what is taken whole; others are refused by name."""
    if not isinstance(points, Stored):
        return points
    if isinstance(points, Delaunay | ConstrainedDelaunay):
        return points.points
    name = type(points).__name__
    raise InputError(
        f"Dynamic takes points, a Delaunay or a ConstrainedDelaunay, not a {name}, of which the "
        "points alone would be left: pass its points, and its segments if it has some"
    )


def as_ndim(ndim: int | None) -> int | None:
    """Return a number of coordinates, checked."""
    if ndim not in (None, 2, 3):
        raise ShapeError(f"ndim must be 2 or 3, got {ndim!r:.80}")
    return ndim


def own_points(points: ArrayLike, ndim: int) -> Floats:
    """Return points that nobody changes while the core runs."""
    array = as_points(points, ndim=ndim)
    return array if len(array) <= FEW else own_copy(points, ndim=ndim)
