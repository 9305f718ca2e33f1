"""Sizes by position: functions, background meshes and rasters, evaluated and checked.

A size is an edge length. Its meaning for triangles and tetrahedra is defined where it is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_plain_array
from delone._base.values import as_marks, require_real
from delone._tiling.triangulation import Triangulation
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats

__all__ = ["checked", "chosen", "evaluator", "formatted", "is_number", "require_region", "rounded"]

_NOUNS = {2: "triangles", 3: "tetrahedra"}


def is_number(value: Any) -> bool:
    """Return whether a size is one number."""
    return isinstance(value, int | float | np.integer | np.floating)


def formatted(position: Floats) -> str:
    """Return a position with all digits."""
    return f"({', '.join(map(repr, position.tolist()))})"


def checked(sizes: Any, positions: Floats) -> Floats:
    """Return the lengths that a size function returned for positions, all above 0."""
    given = np.asarray(sizes)
    require_real(given, "the result of size")
    found = given.astype(np.float64)
    if found.ndim == 0:
        found = np.full(len(positions), float(found))
    if found.shape != (len(positions),):
        raise InputError(
            f"size must return one length for each of {len(positions)} positions, got shape "
            f"{found.shape}"
        )
    wrong = np.flatnonzero(~(found > 0))
    if wrong.size:
        raise InputError(
            f"size is {found[wrong[0]]} at {formatted(positions[wrong[0]])}, but must be above 0; "
            f"{len(wrong)} of {len(positions)} values are wrong"
        )
    return found


def chosen(marked: ArrayLike, count: int, nouns: str) -> NDArray[np.intp]:
    """Return the numbers of marked simplices, given as a mask or as numbers."""
    return np.flatnonzero(as_marks(marked, count, name="marked", of=nouns))


def require_region(region: Any, known: set[int], name: str) -> None:
    """Reject a size for a region that does not exist."""
    if region not in known:
        first = ", ".join(map(str, sorted(known)[:10]))
        raise InputError(f"{name}: there is no region {region!r:.80}; the regions are {first}")


def evaluator(size: Any, ndim: int = 2) -> Callable[[Floats], Floats]:
    """Return a function from positions to lengths."""
    if ndim == 2 and hasattr(size, "dims") and hasattr(size, "coords"):
        return _of_raster(size)
    if isinstance(size, tuple) and len(size) == 2 and isinstance(size[0], Triangulation):
        if size[0].ndim != ndim:
            raise InputError(f"size is given on a triangulation in {size[0].ndim}-D, not {ndim}-D")
        return _of_background(*size)
    if callable(size):
        function: Callable[[Floats], Floats] = size
        return function
    kinds = ["a number", "a mapping from regions", "a function of positions"]
    kinds += ["a pair of a triangulation and its values"] + (["a DataArray"] if ndim == 2 else [])
    raise InputError(f"size must be {', '.join(kinds[:-1])}, or {kinds[-1]}, got {size!r:.60}")


def _of_background(mesh: Triangulation, values: Any) -> Callable[[Floats], Floats]:
    """Interpolate linearly on a triangulation; outside, use its nearest point."""
    given = as_plain_array(values, "size")
    if given.dtype.kind not in "iuf":
        raise DtypeError(f"size must have real numbers as values, got dtype {given.dtype}")
    if given.shape != (mesh.npoints,):
        raise InputError(
            f"size has values of shape {given.shape} for the {mesh.npoints} points of its mesh"
        )
    lengths = given.astype(np.float64)
    if not mesh.nsimplex:
        raise InputError(f"size is given on a triangulation without {_NOUNS[mesh.ndim]}")
    checked(lengths, mesh.points)

    def at(positions: Floats) -> Floats:
        place = mesh.locate(positions)
        corners = mesh.simplices[place.simplex]
        found: Floats = (lengths[corners] * place.barycentric).sum(axis=-1)
        outside = np.flatnonzero(place.simplex < 0)
        if outside.size:
            shares = place.weights[outside]
            found[outside] = (lengths[place.facet[outside]] * shares).sum(axis=-1)
        return found

    return at


def _of_raster(raster: Any) -> Callable[[Floats], Floats]:
    """Interpolate linearly between the centers of cells; outside, use the nearest cell."""
    if len(raster.dims) != 2:
        raise InputError(f"size must have the dimensions y and x, got {raster.dims}")
    axes = [np.asarray(raster[name].values, dtype=np.float64) for name in raster.dims]
    values = np.asarray(raster.values, dtype=np.float64)
    for axis in (0, 1):
        if len(axes[axis]) > 1 and axes[axis][0] > axes[axis][-1]:
            axes[axis], values = axes[axis][::-1], np.flip(values, axis)
        if not (np.diff(axes[axis]) > 0).all():
            raise InputError(f"the coordinates {raster.dims[axis]} of size are not monotonic")

    def at(positions: Floats) -> Floats:
        # The last dimension is x, as in rasters.
        (i, s), (j, t) = (_between(axes[k], positions[:, 1 - k]) for k in (0, 1))
        k, m = np.minimum(i + 1, len(axes[0]) - 1), np.minimum(j + 1, len(axes[1]) - 1)
        upper = values[i, j] * (1 - t) + values[i, m] * t
        lower = values[k, j] * (1 - t) + values[k, m] * t
        found: Floats = upper * (1 - s) + lower * s
        gap = np.flatnonzero(np.isnan(found))
        if gap.size:
            # Next to a cell without a value, use the nearest cell.
            found[gap] = values[np.where(s < 0.5, i, k), np.where(t < 0.5, j, m)][gap]
        return found

    return at


def _between(axis: Floats, at: Floats) -> tuple[NDArray[np.intp], Floats]:
    """Return the index of the coordinate below, and the fraction of the interval to the next."""
    if len(axis) == 1:
        return np.zeros(len(at), dtype=np.intp), np.zeros(len(at))
    i = np.clip(np.searchsorted(axis, at, side="right") - 1, 0, len(axis) - 2)
    share: Floats = np.clip((at - axis[i]) / (axis[i + 1] - axis[i]), 0, 1)
    return i, share


def rounded(number: float) -> str:
    """Return a large number with two digits: more would overstate the accuracy of an estimate."""
    if number < 1000:
        return f"{number:.0f}"
    scale = 10 ** (int(math.log10(number)) - 1) if number < 1e15 else 1
    return f"{round(number / scale) * scale:,}" if number < 1e15 else f"{number:.1e}"
