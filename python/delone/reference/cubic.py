"""The Clough-Tocher interpolant on one triangle, ordinate by ordinate, in exact arithmetic.

The triangle is split at its centroid, and each part has a cubic in Bernstein-Bézier form. Values
and gradients at the corners determine the ordinates on and next to the edges. Smoothness inside
determines the rest except one for each edge: there the derivative across the edge, in the direction
that joins the centroid of the triangle with that of the adjacent triangle, is made linear along the
edge (P. Alfeld, "A trivariate Clough-Tocher scheme for tetrahedral data", 1984). At the boundary
the direction is that to the midpoint of the edge.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from delone.errors import InputError
from delone.reference.exact import ExactNumber, ExactPoint, exact_point, orient

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["clough_tocher"]


def clough_tocher(
    corners: Sequence[Sequence[Any]],
    values: Sequence[Any],
    gradients: Sequence[Sequence[Any]],
    beyond: Sequence[Sequence[Any] | None],
    query: Sequence[Any],
) -> Fraction:
    """Return the value of the interpolant at a point of a triangle.

    Parameters
    ----------
    corners : sequence of three points
        The triangle.
    values : sequence of three numbers
        Values at the corners.
    gradients : sequence of three pairs of numbers
        Derivatives with respect to x and y at the corners.
    beyond : sequence of three points or None
        The opposite vertex across the edge opposite each corner; None at the boundary.
    query : sequence of two numbers
        A point of the triangle, including its boundary.

    Returns
    -------
    Fraction
        The exact value.

    Raises
    ------
    InputError
        The query is outside the triangle.

    Examples
    --------
    The function that is 1 at one corner, with gradient 0 at all three:

    >>> from delone.reference import clough_tocher
    >>> flat = [(0, 0)] * 3
    >>> str(clough_tocher([(0, 0), (3, 0), (0, 3)], [1, 0, 0], flat, [None] * 3, (1, 1)))
    '1/3'
    """
    v = [exact_point(corner) for corner in corners]
    f = [Fraction(value) for value in values]
    g = [exact_point(gradient) for gradient in gradients]
    far = [None if point is None else exact_point(point) for point in beyond]
    share = _barycentric(v, exact_point(query))
    if min(share) < 0:
        raise InputError("the query is outside the triangle")
    k = share.index(min(share))
    i, j = (k + 1) % 3, (k + 2) % 3
    net = _net(v, f, g, far)
    s, t, u = share[i] - share[k], share[j] - share[k], 3 * share[k]
    return (
        s**3 * f[i]
        + 3 * s * s * t * net["edge", i, j]
        + 3 * s * t * t * net["edge", j, i]
        + t**3 * f[j]
        + 3 * u * (s * s * net["spoke", i] + 2 * s * t * net["middle", k] + t * t * net["spoke", j])
        + 3 * u * u * (s * net["inner", i] + t * net["inner", j])
        + u**3 * net["center",]
    )


def _net(
    v: list[ExactPoint], f: list[Fraction], g: list[ExactPoint], far: list[ExactPoint | None]
) -> dict[tuple[Any, ...], Fraction]:
    """The ordinates by position.

    ``edge, i, j``: on the edge from corner i to corner j, a third of the way; ``spoke, i``: a third
    of the way from corner i to the centroid; ``middle, k``: within the part opposite corner k;
    ``inner, i``: two thirds from corner i to the centroid; ``center``: there.
    """
    net: dict[tuple[Any, ...], Fraction] = {}
    for i in range(3):
        for j in {0, 1, 2} - {i}:
            rise = g[i][0] * (v[j][0] - v[i][0]) + g[i][1] * (v[j][1] - v[i][1])
            net["edge", i, j] = f[i] + Fraction(rise) / 3
        # In the tangent plane through the value at the corner.
        net["spoke", i] = (f[i] + sum(net["edge", i, j] for j in {0, 1, 2} - {i})) / 3
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        m = _crossing(v, k, far[k])
        one_end = m * f[i] + (1 - m) * net["edge", i, j] - net["spoke", i]
        other_end = m * net["edge", j, i] + (1 - m) * f[j] - net["spoke", j]
        middle = m * net["edge", i, j] + (1 - m) * net["edge", j, i]
        net["middle", k] = middle - (one_end + other_end) / 2
    for i in range(3):
        beside = [net["middle", k] for k in range(3) if k != i]
        net["inner", i] = (net["spoke", i] + sum(beside)) / 3
    net["center",] = (net["inner", 0] + net["inner", 1] + net["inner", 2]) / 3
    return net


def _crossing(v: list[ExactPoint], k: int, far: ExactPoint | None) -> Fraction:
    """Where the line through the centroids meets the edge: the weight of the corner after k."""
    if far is None:
        return Fraction(1, 2)
    share = _barycentric(v, far)
    return (1 + share[(k + 1) % 3] - share[k]) / (3 * (1 - share[k]))


def _barycentric(v: list[ExactPoint], q: ExactPoint) -> list[Fraction]:
    def cross(a: ExactPoint, b: ExactPoint, c: ExactPoint) -> ExactNumber:
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    if orient(*v) == 0:
        raise InputError("the triangle is flat")
    whole = cross(*v)
    return [Fraction(cross(q, v[(k + 1) % 3], v[(k + 2) % 3])) / whole for k in range(3)]
