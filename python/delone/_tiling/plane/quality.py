"""Quality of triangles: angles, areas, ratios, and exact comparison with a bound on angles.

The core computes the measures in stages: values that suffer cancellation in thin triangles are
computed again with more digits. `below` compares squares of cosines exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np

from delone import _core
from delone._base.arrays import as_mesh, as_points, as_simplices, as_workers
from delone._tiling.measures import Measures

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Quality", "below", "measured", "smallest_corners", "squared_cosine"]

# Squared cosines that are simple fractions, for which rounding would give a different double.
_SIMPLE = {30.0: 0.75, 45.0: 0.5}


@dataclass(frozen=True, eq=False, kw_only=True)
class Quality(Measures):
    """Quality measures of triangles, one entry per triangle.

    Parameters
    ----------
    smallest_angle, largest_angle : ndarray of float64, shape (m,)
        In degrees.
    area : ndarray of float64, shape (m,)
        In the square of the unit of the points.
    radius_ratio : ndarray of float64, shape (m,)
        Twice the inradius divided by the circumradius: 1 for equilateral triangles, near 0 for thin
        ones.
    edge_ratio : ndarray of float64, shape (m,)
        The longest edge divided by the shortest: at least 1.

    Examples
    --------
    >>> import delone
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> quality = delone.mesh(square).quality()
    >>> quality.smallest_angle
    array([45., 45.])
    >>> print(quality)
    2 triangles           least      1 %     10 %   median     90 %     99 %     most
    smallest angle           45       45       45       45       45       45       45
    largest angle            90       90       90       90       90       90       90
    area                    0.5      0.5      0.5      0.5      0.5      0.5      0.5
    radius ratio          0.828    0.828    0.828    0.828    0.828    0.828    0.828
    edge ratio             1.41     1.41     1.41     1.41     1.41     1.41     1.41
    """

    smallest_angle: Floats
    largest_angle: Floats
    area: Floats
    radius_ratio: Floats
    edge_ratio: Floats

    _noun = "triangle"

    @classmethod
    def of(cls, points: ArrayLike, simplices: ArrayLike, *, workers: int | None = None) -> Quality:
        """Measure triangles given by arrays, from any source.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            Coordinates.
        simplices : array_like of int, shape (m, 3)
            Rows of the corners of each triangle, counterclockwise.
        workers : int, optional
            Maximum number of threads; by default one per core. The result does not depend on it.

        Returns
        -------
        Quality
            The measures. They mean nothing where coordinates are NaN or corners coincide.

        Raises
        ------
        InputError
            An array has the wrong shape, or a row is out of range.

        Notes
        -----
        O(m) time.

        Examples
        --------
        >>> from delone import Quality
        >>> Quality.of([(0, 0), (2, 0), (0, 2)], [(0, 1, 2)]).smallest_angle
        array([45.])
        """
        rows = as_points(points, ndim=2)
        return measured(rows, as_simplices(simplices, len(rows), 2), workers)

    def plot(self, ax: Any = None, *, bound: float | None = None) -> Any:
        """Draw a histogram of the smallest and the largest angles (extra ``plot``).

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
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> ax = delone.mesh(square, max_area=0.01).quality().plot(bound=30)
        >>> ax.get_xlabel()
        'angle in degrees'
        """
        from delone.plot import draw_angles

        return draw_angles(self.smallest_angle, self.largest_angle, ax=ax, bound=bound)


def measured(points: Floats, simplices: Indices, workers: int | None = None) -> Quality:
    """Measure triangles."""
    found = _core.qualities(*as_mesh(points, simplices), as_workers(workers))
    return Quality(
        **{each.name: column for each, column in zip(fields(Quality), found, strict=True)}
    )


def smallest_corners(points: Floats, simplices: Indices) -> Indices:
    """Return the corner of each triangle that has its smallest angle: 0, 1 or 2."""
    corners = points[simplices]
    # Halve the coordinates, so that no difference overflows.
    sides = 0.5 * corners[:, [2, 0, 1]] - 0.5 * corners[:, [1, 2, 0]]
    lengths = np.hypot(sides[..., 0], sides[..., 1])
    found: Indices = lengths.argmin(axis=1).astype(np.int32)
    return found


def squared_cosine(degrees: float) -> float:
    """Return the square of the cosine of an angle from 0 to 60 degrees, exact for 30 and 45."""
    return _SIMPLE.get(degrees, math.cos(math.radians(degrees)) ** 2)


def below(
    points: Floats, simplices: Indices, min_angle: float, workers: int | None = None
) -> NDArray[np.int64]:
    """Return the triangles that have an angle below a bound from 0 to 60 degrees, ascending.

    Exact for the double that `squared_cosine` returns: an angle is smaller if the square of its
    cosine is larger.
    """
    bound = squared_cosine(min_angle)
    return np.flatnonzero(_core.below2(*as_mesh(points, simplices), bound, as_workers(workers)))
