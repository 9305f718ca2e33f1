"""Warn of points that are in a flat except for rounding, such as fractions that add up to one.

The points span all dimensions, but by rounding errors only, so simplices are very thin. The normal
of the best flat is the last singular vector of the centered columns, each divided by its extent.
The QR decomposition before that costs O(n d^2), little compared with a triangulation.
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
        normal = np.linalg.svd(np.linalg.qr(scaled, mode="r"))[2][-1]
        distance = np.abs(scaled @ normal).max()
    if distance > _ROUNDINGS * (np.abs(normal) * unit).sum():
        return
    column = int(np.flatnonzero(np.abs(normal) >= np.abs(normal).max() / 2)[-1])
    warnings.warn(
        f"points lie in a flat of dimension {d - 1} except for rounding errors, so simplices in "
        f"{d}-D are very thin: leave out a column, for example column {column}, or pass exact "
        'coordinates, such as integers, with flat="project"',
        NearlyFlatWarning,
        stacklevel=caller_level(),
    )
