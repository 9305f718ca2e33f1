"""Predict the cost of a triangulation from triangulations of samples."""

from __future__ import annotations

import math
import time
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone._base.arrays import require_finite
from delone._base.counting import grouped
from delone._base.immutable import own_copy
from delone._tiling.higher.dimension import MOST
from delone._tiling.higher.size import peak_bytes, sample_size
from delone._tiling.higher.thin import NearlyFlatWarning
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats

__all__ = ["Estimate", "estimate"]

# Each sample contains one in this many points, if that is enough.
_SHARES = 64, 8
# Minimum number of sample points per corner of a simplex; inputs this small are not sampled.
_FEW = 8
# Bytes of a row number, and of a coordinate.
_ROW, _COORDINATE = 4, 8


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """The predicted size, memory and time of a triangulation.

    Parameters
    ----------
    npoints, ndim : int
        The number of points and the dimension.
    simplices : int
        The predicted number of simplices.
    nbytes : int
        Memory of the result, in bytes: points, simplices and neighbors.
    peak : int
        Peak memory during the computation, in bytes.
    seconds : float
        Time on this machine, in seconds.

    Examples
    --------
    >>> import numpy as np
    >>> import delone
    >>> cost = delone.estimate(np.random.default_rng(0).random((3000, 4)))
    >>> 60_000 < cost.simplices < 110_000
    True
    """

    npoints: int
    ndim: int
    simplices: int
    nbytes: int
    peak: int
    seconds: float

    def __str__(self) -> str:
        return (
            f"{grouped(self.npoints)} points in {self.ndim}-D: about {grouped(self.simplices)} "
            f"simplices, {_size(self.nbytes)} ({_size(self.peak)} at most), {self.seconds:.1f} s"
        )


def estimate(points: ArrayLike, *, seed: int = 0) -> Estimate:
    """Predict the size, memory and time of a Delaunay triangulation.

    Parameters
    ----------
    points : array_like, shape (n, d)
        Finite coordinates, two to eight for each point.
    seed : int, optional
        Seed of the random samples.

    Returns
    -------
    Estimate
        Simplices, bytes and seconds.

    Raises
    ------
    NonFiniteError, ShapeError, DtypeError
        As for `Delaunay`.
    DegenerateInputError
        The points do not span a simplex.

    Notes
    -----
    Two random samples are triangulated, with 1/64 and 1/8 of the points, or with fewer if these
    would take more than a few seconds. The number of simplices per point is modeled as
    a - b n^(-1/d), because points near the hull have fewer simplices; a and b are fitted to the
    samples. Points on a surface or in clusters may not follow this model. The estimate can then be
    off by a factor, but not by an order of magnitude. The time per simplex is that of the larger
    sample.

    Examples
    --------
    >>> import numpy as np
    >>> import delone
    >>> table = np.random.default_rng(0).random((2000, 5))
    >>> cost = delone.estimate(table)
    >>> mesh = delone.Delaunay(table)
    >>> abs(cost.simplices / mesh.nsimplex - 1) < 0.2
    True
    """
    own = own_copy(points, ndim=None, most=MOST)
    require_finite(own)
    n, d = own.shape
    order = np.random.default_rng(seed).permutation(n)
    counts = []
    seconds = 0.0
    for share in _SHARES:
        least = _FEW * (d + 1)
        size = min(n, max(n // share, least * (1 if share == _SHARES[0] else 4)))
        size = size if size == n else sample_size(size, d)
        start = time.perf_counter()
        made = _sampled(own, order, size)
        # Time is proportional to the number of simplices; the overhead of a call is negligible.
        seconds = (time.perf_counter() - start) / made.nsimplex
        counts.append((size, made.nsimplex / size))
    simplices = _extrapolated(counts, n, d)
    result = simplices * 2 * _ROW * (d + 1) + n * d * _COORDINATE
    peak = peak_bytes(simplices, d) + n * d * _COORDINATE
    return Estimate(
        npoints=n,
        ndim=d,
        simplices=simplices,
        nbytes=result,
        peak=peak,
        seconds=seconds * simplices,
    )


def _sampled(points: Floats, order: np.ndarray, size: int) -> Delaunay:
    """Triangulate the first `size` points of an order, or more if these do not span a simplex."""
    while True:
        try:
            with warnings.catch_warnings():
                # Samples of nearly flat points are nearly flat; the triangulation will warn.
                warnings.simplefilter("ignore", NearlyFlatWarning)
                return Delaunay(points[order[:size]], workers=1, planar=True)
        except DegenerateInputError:
            if size == len(points):
                raise
            size = min(len(points), 4 * size)


def _extrapolated(counts: list[tuple[int, float]], n: int, d: int) -> int:
    """Predict the number of simplices of n points from the simplices per point of two samples."""
    (few, low), (many, high) = counts
    if many in (n, few):
        return round(high * n)
    # Fit a - b m^(-1/d) to both; if the number decreases from one to the other, b is 0.
    b = max(0.0, (high - low) / (math.pow(few, -1 / d) - math.pow(many, -1 / d)))
    return round((high + b * (math.pow(many, -1 / d) - math.pow(n, -1 / d))) * n)


def _size(nbytes: int) -> str:
    """Return a number of bytes with a unit."""
    for unit in ("B", "kB", "MB"):
        if nbytes < 1000:
            return f"{nbytes} {unit}"
        nbytes //= 1000
    return f"{grouped(nbytes)} GB"
