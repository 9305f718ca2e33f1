"""Quality of tetrahedra: dihedral angles, volumes, ratios of radii and of edges.

The core computes the measures in stages: values that suffer cancellation in slivers are computed
again with more digits, and angles near 0 and 180 degrees are as accurate as others.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_mesh, as_number, as_points, as_simplices, as_workers
from delone._tiling.measures import Measures
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["EDGES", "FACES", "TetQuality", "dihedral_angles", "measured"]

# Corners of the face opposite each corner, with that corner on the positive side.
FACES = ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))
# The edges of a tetrahedron as corners.
EDGES = ((0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3))
# Smallest bin width of a histogram in degrees: narrower bins are a mistake, and would fill memory.
_NARROWEST = 0.001


@dataclass(frozen=True, eq=False, kw_only=True)
class TetQuality(Measures):
    """Quality measures of tetrahedra, one entry per tetrahedron.

    Parameters
    ----------
    smallest_dihedral, largest_dihedral : ndarray of float64, shape (m,)
        Dihedral angles in degrees, between two faces at an edge. The smallest angle of a
        tetrahedron is at most acos(1/3), about 70.53 degrees, that of the regular tetrahedron; if
        it is near 0, the tetrahedron is a sliver, or worse.
    volume : ndarray of float64, shape (m,)
        In the cube of the unit of the points.
    radius_ratio : ndarray of float64, shape (m,)
        Three times the inradius divided by the circumradius: 1 for regular tetrahedra, near 0 for
        flat and thin ones.
    edge_ratio : ndarray of float64, shape (m,)
        The longest edge divided by the shortest: at least 1.

    Notes
    -----
    The relative error of each value is below 1e-13, also for slivers and needles, unless it is
    beyond the range of doubles (then inf, or rounded to a subnormal number).

    Examples
    --------
    >>> import delone
    >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
    >>> quality = delone.improve(corner).quality()
    >>> print(quality)
    1 tetrahedron         least      1 %     10 %   median     90 %     99 %     most
    smallest dihedral      54.7     54.7     54.7     54.7     54.7     54.7     54.7
    largest dihedral         90       90       90       90       90       90       90
    volume                0.167    0.167    0.167    0.167    0.167    0.167    0.167
    radius ratio          0.732    0.732    0.732    0.732    0.732    0.732    0.732
    edge ratio             1.41     1.41     1.41     1.41     1.41     1.41     1.41
    """

    smallest_dihedral: Floats
    largest_dihedral: Floats
    volume: Floats
    radius_ratio: Floats
    edge_ratio: Floats

    _noun = "tetrahedron"

    def histogram(self, width: float = 5.0) -> tuple[NDArray[np.int64], Floats]:
        """Count tetrahedra by smallest dihedral angle.

        Parameters
        ----------
        width : float, optional
            Bin width in degrees, from 0.001 to 180.

        Returns
        -------
        counts : ndarray of int64, shape (k,)
            Number of tetrahedra in each bin.
        bounds : ndarray of float64, shape (k + 1,)
            The bin edges, from 0 to above 70.53 degrees.

        Raises
        ------
        InputError
            `width` is not a number in this range.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> delone.improve(corner).quality().histogram(25)
        (array([0, 0, 1]), array([ 0., 25., 50., 75.]))
        """
        step = as_number(width, name="width")
        if not _NARROWEST <= step <= 180:
            raise InputError(f"width must be from {_NARROWEST} to 180 degrees, got {width!r:.80}")
        most = np.degrees(np.arccos(1 / 3))
        bounds: Floats = step * np.arange(int(np.ceil(most / step)) + 1, dtype=np.float64)
        # The angle of the regular tetrahedron may be rounded to above the last edge.
        counts, _ = np.histogram(np.minimum(self.smallest_dihedral, bounds[-1]), bounds)
        return counts.astype(np.int64), bounds

    @classmethod
    def of(
        cls, points: ArrayLike, simplices: ArrayLike, *, workers: int | None = None
    ) -> TetQuality:
        """Measure tetrahedra given by arrays, from any source.

        Parameters
        ----------
        points : array_like, shape (n, 3)
            Coordinates.
        simplices : array_like of int, shape (m, 4)
            Rows of the corners of each tetrahedron, positively oriented.
        workers : int, optional
            Maximum number of threads; by default one per core. The result does not depend on it.

        Returns
        -------
        TetQuality
            The measures. They mean nothing where coordinates are NaN or corners are coplanar.

        Raises
        ------
        InputError
            An array has the wrong shape, or a row is out of range.

        Notes
        -----
        O(m) time.

        Examples
        --------
        >>> from delone import TetQuality
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
        >>> TetQuality.of(corner, [(0, 1, 2, 3)]).largest_dihedral
        array([90.])
        """
        rows = as_points(points, ndim=3)
        return measured(rows, as_simplices(simplices, len(rows), 3), workers)

    def plot(self, ax: Any = None, *, bound: float | None = None) -> Any:
        """Draw a histogram of the smallest and the largest dihedral angles (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        bound : float, optional
            An angle to mark, in degrees.

        Returns
        -------
        matplotlib Axes
            The axes.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> import delone
        >>> corner = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
        >>> ax = delone.improve(corner).quality().plot(bound=20)
        >>> ax.get_ylabel()
        'tetrahedra'
        """
        from delone.plot import draw_angles

        ax = draw_angles(self.smallest_dihedral, self.largest_dihedral, ax=ax, bound=bound)
        ax.set_xlabel("dihedral angle in degrees")
        ax.set_ylabel("tetrahedra")
        return ax


def measured(points: Floats, simplices: Indices, workers: int | None = None) -> TetQuality:
    """Measure positively oriented tetrahedra."""
    found = _core.qualities(*as_mesh(points, simplices), as_workers(workers))
    return TetQuality(
        **{each.name: column for each, column in zip(fields(TetQuality), found, strict=True)}
    )


def dihedral_angles(points: Floats, simplices: Indices, workers: int | None = None) -> Floats:
    """Return dihedral angles in degrees, (m, 6), at the edges between corners as in `EDGES`."""
    return _core.dihedral_angles3(*as_mesh(points, simplices), as_workers(workers))
