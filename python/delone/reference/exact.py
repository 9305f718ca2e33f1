"""Signs and circles of exact points.

A float is exactly one rational number, so arithmetic on `fractions.Fraction` (or on integers) gives
the true sign of any polynomial in the coordinates. Signs follow the package: `orient` is positive
for a left turn, `incircle` is positive inside a counter-clockwise circle.

The empty-circle test is due to Delaunay, B. (1934), "Sur la sphère vide", Bulletin de l'Académie
des Sciences de l'URSS, Classe des sciences mathématiques et naturelles 6, 793-800.
"""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from numbers import Rational
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from delone._base.counting import agreed
from delone.errors import DegenerateInputError, NonFiniteError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Sequence

ExactNumber: TypeAlias = int | Fraction
ExactPoint: TypeAlias = tuple[ExactNumber, ExactNumber]


class Circle(NamedTuple):
    """A circle with rational center.

    Parameters
    ----------
    center : tuple of Fraction
        Its center.
    squared_radius : Fraction
        The square of its radius, which is rational even if the radius is not.

    Examples
    --------
    >>> from delone.reference import circumcircle
    >>> circle = circumcircle((0, 0), (2, 0), (0, 2))
    >>> str(circle.center[0]), str(circle.squared_radius)
    ('1', '2')
    """

    center: tuple[Fraction, Fraction]
    squared_radius: Fraction


def exact_point(point: Sequence[Any]) -> ExactPoint:
    """Return the two coordinates of a point as exact numbers.

    Parameters
    ----------
    point : sequence of two numbers
        Integers, floats of any precision, fractions or decimals.

    Returns
    -------
    tuple of int or Fraction
        The same values.

    Raises
    ------
    ValueError, OverflowError
        The value is NaN or infinity.

    Examples
    --------
    >>> from delone.reference import exact_point
    >>> exact_point((3, 0.5))
    (3, Fraction(1, 2))
    """
    x, y = point
    return exact_number(x), exact_number(y)


def orient(a: Sequence[Any], b: Sequence[Any], c: Sequence[Any]) -> int:
    """Return on which side of the line from a to b the point c lies.

    Parameters
    ----------
    a, b, c : sequence of two numbers
        Points.

    Returns
    -------
    int
        1 if c lies to the left (a, b, c turn counter-clockwise), -1 to the right, 0 on the line.

    Examples
    --------
    >>> from delone.reference import orient
    >>> orient((0, 0), (1, 0), (0, 5e-324))
    1
    >>> orient((0, 0), (1, 1), (3, 3))
    0
    """
    (ax, ay), (bx, by), (cx, cy) = map(exact_point, (a, b, c))
    return sign((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


def incircle(a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any]) -> int:
    """Return whether d lies inside the circle through a, b and c.

    Parameters
    ----------
    a, b, c : sequence of two numbers
        Points on the circle, counter-clockwise; clockwise, the sign is reversed.
    d : sequence of two numbers
        The point to test.

    Returns
    -------
    int
        1 inside, 0 on the circle, -1 outside.

    Notes
    -----
    This is the sign of a determinant: each point is lifted to the paraboloid z = x² + y², and d is
    inside the circle if and only if its lifted image lies below the plane through the other three.

    Examples
    --------
    >>> from delone.reference import incircle
    >>> square = (0, 0), (1, 0), (1, 1)
    >>> incircle(*square, (0.5, 0.5)), incircle(*square, (0, 1)), incircle(*square, (0, 1.5))
    (1, 0, -1)
    """
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = map(exact_point, (a, b, c, d))
    ax, ay, bx, by, cx, cy = ax - dx, ay - dy, bx - dx, by - dy, cx - dx, cy - dy
    return sign(
        (ax * ax + ay * ay) * (bx * cy - by * cx)
        + (bx * bx + by * by) * (cx * ay - cy * ax)
        + (cx * cx + cy * cy) * (ax * by - ay * bx)
    )


def incircle_canonical(
    a: Sequence[Any], b: Sequence[Any], c: Sequence[Any], d: Sequence[Any]
) -> int:
    """Return whether d lies inside the circle through a, b and c, with every tie broken.

    Parameters
    ----------
    a, b, c : sequence of two numbers
        Points on the circle, counter-clockwise; clockwise, the sign is reversed.
    d : sequence of two numbers
        The point to test.

    Returns
    -------
    int
        1 inside, -1 outside; 0 only if all four are on one line or two of them coincide.

    Notes
    -----
    The lifted point of each vertex is lowered by an infinitesimal amount, which is infinitely
    larger for the lexicographically smaller of any two points. If the four are cocircular, only the
    amount of the smallest of them matters: lowering d moves it inside, and lowering a corner of the
    triangle tilts the plane by the barycentric coordinate of that corner at d. The result depends
    only on coordinates, never on the order of the points.

    Examples
    --------
    The corner (0, 0) of the square is the smallest, so it sees the opposite one:

    >>> from delone.reference import incircle_canonical
    >>> incircle_canonical((0, 0), (1, 0), (1, 1), (0, 1))
    -1
    >>> incircle_canonical((1, 0), (1, 1), (0, 1), (0, 0))
    1
    """
    found = incircle(a, b, c, d)
    if found != 0:
        return found
    a, b, c, d = map(exact_point, (a, b, c, d))
    smallest = min(a, b, c, d)
    if smallest == d:
        return orient(a, b, c)
    if smallest == a:
        return -orient(d, b, c)
    if smallest == b:
        return -orient(a, d, c)
    return -orient(a, b, d)


def circumcircle(a: Sequence[Any], b: Sequence[Any], c: Sequence[Any]) -> Circle:
    """Return the circle through three points.

    Parameters
    ----------
    a, b, c : sequence of two numbers
        Points that are not on one line.

    Returns
    -------
    Circle
        Its center and squared radius, exactly.

    Raises
    ------
    DegenerateInputError
        The points are on one line.

    Examples
    --------
    >>> from delone.reference import circumcircle
    >>> circumcircle((0, 0), (4, 0), (2, 1))
    Circle(center=(Fraction(2, 1), Fraction(-3, 2)), squared_radius=Fraction(25, 4))
    """
    (ax, ay), (bx, by), (cx, cy) = map(exact_point, (a, b, c))
    bx, by, cx, cy = bx - ax, by - ay, cx - ax, cy - ay
    twice_cross = 2 * (bx * cy - by * cx)
    if twice_cross == 0:
        raise DegenerateInputError(
            "no circle passes through points on one line", reason="collinear"
        )
    b_square, c_square = bx * bx + by * by, cx * cx + cy * cy
    x = Fraction(cy * b_square - by * c_square) / twice_cross
    y = Fraction(bx * c_square - cx * b_square) / twice_cross
    return Circle((ax + x, ay + y), x * x + y * y)


def exact_number(value: Any) -> ExactNumber:
    """Convert an integer, a float of any precision, a fraction or a decimal to an exact number.

    Raises ValueError or OverflowError for NaN and infinity.
    """
    if isinstance(value, int | Fraction):
        return value
    if isinstance(value, Rational):  # NumPy's integers, which would overflow silently
        return Fraction(int(value.numerator), int(value.denominator))
    return Fraction(*value.as_integer_ratio())


def sign(number: ExactNumber) -> int:
    """Return the sign of a number: 1, 0 or -1."""
    return (number > 0) - (number < 0)


def exact_rows(points: Sequence[Sequence[Any]], ndim: int = 2) -> list[tuple[Any, ...]]:
    """Return points as exact integers, multiplied by the least common multiple of denominators.

    That does not change any orientation, circle or sphere test, and integers are several times
    faster than fractions.
    """
    exact, bad = [], []
    for row, point in enumerate(points):
        if len(point) != ndim:
            words = {2: "two", 3: "three"}
            raise ShapeError(
                f"points must have {words[ndim]} coordinates; row {row} has {len(point)}"
            )
        try:
            exact.append([exact_number(x) for x in point])
        except (ValueError, OverflowError):
            bad.append(row)
    if bad:
        raise NonFiniteError(
            f"{len(bad)} {agreed(len(bad), 'row holds', 'rows hold')} NaN or infinity; "
            f"first: {bad[0]}",
            rows=bad,
            count=len(bad),
        )
    scale = lcm(*(Fraction(number).denominator for point in exact for number in point))
    return [tuple(int(x * scale) for x in point) for point in exact]


def first_rows(points: Sequence[tuple[Any, ...]]) -> list[int]:
    """Return the rows of the distinct points, each at its first occurrence, ascending."""
    first: dict[tuple[Any, ...], int] = {}
    for row, point in enumerate(points):
        first.setdefault(point, row)
    return list(first.values())
