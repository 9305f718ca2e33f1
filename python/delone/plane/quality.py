"""How good triangles are: angles, areas, ratios, and the exact comparison with a bound of angles.

Measures are rounded, but right: each triangle is scaled to its own size, so that nothing exceeds
the range of doubles, and areas that cancel in thin ones are computed with more digits. `below`
decides by squares of cosines; where these are too close to the bound to tell, it goes on with
fractions, so that its answer is exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.plane.geometry import areas
from delone.plane.measures import Measures

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Quality", "below", "measured", "smallest_corners", "squared_cosine"]

# Triangles worked on at once, so that temporary arrays stay small.
_BLOCK = 1 << 17
# Differences of larger coordinates may exceed the range of doubles.
_LARGE = 1e300
# Areas below this share of the two shorter sides' product have lost too many bits.
_THIN = 2.0**-5
# Squares that differ by a smaller part are compared exactly: some eight roundings each.
_UNSURE = 1e-13
# Squared cosines that are simple fractions, and whose double is another number.
_SIMPLE = {30.0: 0.75, 45.0: 0.5}


@dataclass(frozen=True, eq=False, kw_only=True)
class Quality(Measures):
    """Measures of the triangles of a mesh, one entry for each.

    Parameters
    ----------
    smallest_angle, largest_angle : ndarray of float64, shape (m,)
        In degrees.
    area : ndarray of float64, shape (m,)
        In the square of the unit of the points.
    radius_ratio : ndarray of float64, shape (m,)
        Twice the radius of the inscribed circle, as a share of that of the circumscribed one: 1 for
        an equilateral triangle, towards 0 for thin ones.
    edge_ratio : ndarray of float64, shape (m,)
        The longest edge in lengths of the shortest: at least 1.

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

    def plot(self, ax: Any = None, *, bound: float | None = None) -> Any:
        """Draw the histogram of the smallest and the largest angles (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        bound : float, optional
            An angle to be marked, in degrees.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

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


def measured(points: Floats, simplices: Indices) -> Quality:
    """Measure triangles.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    Returns
    -------
    Quality
        The measures.
    """
    found = np.empty((4, len(simplices)))
    for block, lengths, twice, dots in _blocks(points, simplices):
        ordered = np.sort(lengths, axis=0)
        dots.sort(axis=0)
        found[0, block] = np.degrees(np.arctan2(twice, dots[2]))
        found[1, block] = np.degrees(np.arctan2(twice, dots[0]))
        # Where squares of lengths leave the range, ratios are infinite or NaN.
        with np.errstate(all="ignore"):
            around = lengths.sum(axis=0) * lengths.prod(axis=0)
            found[2, block] = 4 * twice * (twice / around)
            found[3, block] = ordered[2] / ordered[0]
    return Quality(
        smallest_angle=found[0],
        largest_angle=found[1],
        area=areas(points, simplices),
        radius_ratio=found[2],
        edge_ratio=found[3],
    )


def _blocks(points: Floats, simplices: Indices) -> Iterator[tuple[slice, Floats, Floats, Floats]]:
    """Lengths of edges, twice the area, and the dot products at corners, block by block."""
    for start in range(0, len(simplices), _BLOCK):
        block = slice(start, start + _BLOCK)
        corners = points[simplices[block]]
        largest = np.abs(corners).max(axis=(1, 2), initial=0)
        corners = np.where((largest > _LARGE)[:, None, None], 0.5 * corners, corners)
        # The edge opposite each corner, in a unit of its own that rounds nothing.
        sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
        unit = -np.frexp(np.abs(sides).max(axis=(1, 2)))[1][:, None, None]
        sides = np.ldexp(sides, unit)
        x, y = sides[..., 0].T, sides[..., 1].T
        lengths = np.hypot(x, y)
        crosses = np.array([x[k - 2] * y[k - 1] - y[k - 2] * x[k - 1] for k in range(3)])
        dots = np.array([-(x[k - 2] * x[k - 1] + y[k - 2] * y[k - 1]) for k in range(3)])
        # All three are twice the area; the one of the two shorter sides is rounded least.
        best = lengths.argmax(axis=0)
        twice = np.abs(np.take_along_axis(crosses, best[None], axis=0)[0])
        beside = lengths.prod(axis=0) / lengths.max(axis=0)
        thin = np.flatnonzero(~(twice > _THIN * beside))
        if len(thin):
            rows = np.arange(3 * len(thin), dtype=np.int32).reshape(-1, 3)
            scaled = np.ldexp(corners[thin], unit[thin])
            twice[thin] = 2 * areas(scaled.reshape(-1, 2), rows)
        yield block, lengths, twice, dots


def smallest_corners(points: Floats, simplices: Indices) -> Indices:
    """Return the corner of each triangle where its smallest angle is.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.

    Returns
    -------
    ndarray of int32, shape (m,)
        0, 1 or 2.
    """
    found = np.empty(len(simplices), dtype=np.int32)
    for block, lengths, _, _ in _blocks(points, simplices):
        found[block] = lengths.argmin(axis=0)
    return found


def squared_cosine(degrees: float) -> float:
    """Return the square of the cosine of an angle, the bound that `below` compares with.

    Parameters
    ----------
    degrees : float
        From 0 to 60.

    Returns
    -------
    float
        Of 30 and 45 degrees exactly the square; of others a double next to it.

    Examples
    --------
    >>> from delone.plane.quality import squared_cosine
    >>> squared_cosine(30)
    0.75
    """
    return _SIMPLE.get(degrees, math.cos(math.radians(degrees)) ** 2)


def below(points: Floats, simplices: Indices, min_angle: float) -> NDArray[np.int64]:
    """Return the triangles that have an angle below a bound.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        Coordinates.
    simplices : ndarray of int32, shape (m, 3)
        Triangles.
    min_angle : float
        The bound in degrees, from 0 to 60.

    Returns
    -------
    ndarray of int64, shape (k,)
        Triangles, ascending.

    Notes
    -----
    Exact for the double `squared_cosine`: an angle is smaller where the square of its cosine is
    larger.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plane.quality import below
    >>> points = np.array([(0.0, 0), (1, 0), (0, 1), (0, 0.5)])
    >>> below(points, np.array([(0, 1, 2), (0, 1, 3)]), 45)
    array([1])
    """
    bound = squared_cosine(min_angle)
    found = np.zeros(len(simplices), dtype=bool)
    for block, lengths, _, dots in _blocks(points, simplices):
        corner = lengths.argmin(axis=0)[None]
        square = np.take_along_axis(dots, corner, axis=0)[0] ** 2
        beside = np.take_along_axis(np.roll(lengths, -1, axis=0) * np.roll(lengths, 1, axis=0),
                                    corner, axis=0)[0] ** 2  # fmt: skip
        small = square > bound * beside
        for i in np.flatnonzero(~(np.abs(square - bound * beside) > _UNSURE * beside)).tolist():
            small[i] = _is_below(points[simplices[block][i]], bound)
        found[block] = small
    return np.flatnonzero(found)


def _is_below(corners: Floats, bound: float) -> bool:
    p = [[Fraction(x) for x in corner] for corner in corners.tolist()]
    for k in range(3):
        (ax, ay), (bx, by) = ((q[0] - p[k][0], q[1] - p[k][1]) for q in (p[k - 2], p[k - 1]))
        dot = ax * bx + ay * by
        if dot > 0 and dot * dot > (ax * ax + ay * ay) * (bx * bx + by * by) * Fraction(bound):
            return True
    return False
