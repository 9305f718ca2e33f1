"""Warn of points that are in a flat except for rounding, such as fractions that add up to one.

The points span all dimensions, but by rounding errors only, so simplices are very thin. The normals
of the best flat are the last singular vectors of the centered columns, each divided by its extent:
as many as have all points within rounding errors. The QR decomposition before that costs O(n d^2),
little compared with a triangulation.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from delone._base.georeference import caller_level

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["NearlyFlatWarning", "warn_of_rounding"]

# Distances from the flat in units of what one rounding of each coordinate can cause. Seen: 0.3 to
# 5 where columns are rounded sums of others, and more than 10**12 where they are not.
_ROUNDINGS = 64.0
# Nothing is said where so many roundings are a larger part of the extent of a column than this.
_COARSE = 1e-3


class NearlyFlatWarning(UserWarning):
    """Points with four or more coordinates lie in a flat except for rounding errors.

    Examples
    --------
    >>> import warnings
    >>> import numpy as np
    >>> import delone
    >>> fractions = np.random.default_rng(0).dirichlet(np.ones(4), 30)
    >>> with warnings.catch_warnings(record=True) as caught:
    ...     mesh = delone.Delaunay(fractions)
    >>> caught[0].category.__name__
    'NearlyFlatWarning'
    >>> mesh = delone.Delaunay(fractions[:, :3])
    """


def warn_of_rounding(points: Floats) -> None:
    """Warn if points that span all dimensions are in a flat except for rounding."""
    d = points.shape[1]
    with np.errstate(all="ignore"):
        centered = points - points.mean(axis=0)
        extent = np.abs(centered).max(axis=0)
        scaled = centered / extent
        unit = np.finfo(np.float64).eps * np.abs(points).max(axis=0) / extent
        # Coordinates of few bits beside a large offset may be exact, and a rounding is large there.
        if not np.isfinite(scaled).all() or not _ROUNDINGS * unit.max() < _COARSE:
            return
        vectors = np.linalg.svd(np.linalg.qr(scaled, mode="r"))[2]
        distance = np.abs(scaled @ vectors.T).max(axis=0)
    near = distance <= _ROUNDINGS * (np.abs(vectors) @ unit)
    # The last ones, as far as all of them are normals.
    count = int(np.logical_and.accumulate(near[::-1]).sum())
    if not count:
        return
    columns = _dependent(vectors[-count:])
    named = f"column {columns[0]}" if count == 1 else f"columns {', '.join(map(str, columns))}"
    warnings.warn(
        f"points lie in a flat of dimension {d - count} except for rounding errors, so simplices "
        f"in {d}-D are very thin: leave out {'a column' if count == 1 else f'{count} columns'}, "
        f"for example {named}, or pass exact coordinates, such as integers, with "
        'flat="project"',
        NearlyFlatWarning,
        stacklevel=caller_level(),
    )


def _dependent(normals: Floats) -> list[int]:
    """Return as many columns as there are normals, such that the others determine them."""
    rest, found = normals.copy(), []
    for _ in range(len(normals)):
        # Elimination: of the columns that are about as good, the last one.
        size = np.abs(rest).max(axis=0)
        column = int(np.flatnonzero(size >= size.max() / 2)[-1])
        row = int(np.abs(rest[:, column]).argmax())
        rest -= np.outer(rest[:, column] / rest[row, column], rest[row])
        rest[:, column] = 0.0
        found.append(column)
    return sorted(found)
