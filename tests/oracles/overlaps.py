"""Areas that cells on the sphere share, with 50 digits: an oracle without any code of the core.

Polygons are signed fans of triangles, which are clipped by the planes of each other's sides. The
area between a great circle and the equator has a closed form, so parallels need no quadrature: the
integral of the sine of the latitude over the longitude along an arc is its change of longitude
minus the area of the triangle of the arc and the pole.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache
from itertools import pairwise
from typing import Any

Vector = list[Decimal]

__all__ = ["polygon_area", "shared_by_box", "shared_by_polygons"]

DIGITS = 50
# Lengths and angles below this are zero: inputs are doubles, and degenerate parts have no area.
_TINY = Decimal(10) ** -45


def _atan_series(x: Decimal) -> Decimal:
    """The arc tangent of a small number."""
    square, term, total, k = x * x, x, x, 1
    while abs(term) > Decimal(10) ** -(DIGITS + 5):
        term = -term * square
        k += 2
        total += term / k
    return total


@cache
def _pi() -> Decimal:
    """Machin's formula; first called with all digits."""
    return 4 * (4 * _atan_series(Decimal(1) / 5) - _atan_series(Decimal(1) / 239))


def _atan2(y: Decimal, x: Decimal) -> Decimal:
    """The angle of a vector, from -pi to pi."""
    if not x and not y:
        return Decimal(0)
    if abs(y) > abs(x):
        quarter = _pi() / 2 if y > 0 else -_pi() / 2
        return quarter - _atan2(x, abs(y)) * (1 if y > 0 else -1)
    if x < 0:
        return (_pi() if y >= 0 else -_pi()) - _atan2(y, -x)
    t = y / x
    # Each step halves the angle.
    for _ in range(4):
        t = t / (1 + (1 + t * t).sqrt())
    return 16 * _atan_series(t)


def _vector(p: Any) -> Vector:
    return [Decimal(float(x)) for x in p]


def _cross(a: Vector, b: Vector) -> Vector:
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def _dot(a: Vector, b: Vector) -> Decimal:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(a: Vector) -> Vector:
    length = _dot(a, a).sqrt()
    return [x / length for x in a]


def _clip(ring: list[Vector], n: Vector) -> list[Vector]:
    """The part of a convex ring on the positive side of a plane."""
    found = []
    for k, p in enumerate(ring):
        q = ring[(k + 1) % len(ring)]
        s, t = _dot(n, p), _dot(n, q)
        if s >= 0:
            found.append(p)
        if s * t < 0:
            found.append(_unit([abs(t) * x + abs(s) * y for x, y in zip(p, q, strict=True)]))
    return found


def _triangle(a: Vector, b: Vector, c: Vector) -> Decimal:
    """The signed area of a triangle (Van Oosterom and Strackee)."""
    volume = _dot(a, _cross(b, c))
    return 2 * _atan2(volume, 1 + _dot(a, b) + _dot(b, c) + _dot(c, a))


def _area(ring: list[Vector]) -> Decimal:
    return sum((_triangle(ring[0], b, c) for b, c in pairwise(ring[1:])), Decimal(0))


def _fan(ring: Any) -> list[tuple[int, list[Vector]]]:
    """A ring as signed triangles from its first corner, counter-clockwise each."""
    r = [_unit(_vector(p)) for p in ring]
    found = []
    for b, c in pairwise(r[1:]):
        turn = _dot(r[0], _cross(b, c))
        if turn > 0:
            found.append((1, [r[0], b, c]))
        elif turn < 0:
            found.append((-1, [r[0], c, b]))
    return found


def polygon_area(ring: Any) -> Decimal:
    """The signed area of a ring."""
    with localcontext() as context:
        context.prec = DIGITS
        return sum((sign * _area(part) for sign, part in _fan(ring)), Decimal(0))


def shared_by_polygons(p: Any, q: Any) -> Decimal:
    """The area that two rings share, both counter-clockwise."""
    with localcontext() as context:
        context.prec = DIGITS
        total = Decimal(0)
        for sign, first in _fan(p):
            for other, second in _fan(q):
                part = first
                for k in range(3):
                    part = _clip(part, _cross(second[k], second[(k + 1) % 3]))
                    if len(part) < 3:
                        break
                if len(part) > 2:
                    total += sign * other * _area(part)
        return total


def _sine(t: float) -> Decimal:
    """The sine of a latitude by its tangent."""
    if t in (float("inf"), float("-inf")):
        return Decimal(1) if t > 0 else Decimal(-1)
    d = Decimal(float(t))
    return d / (1 + d * d).sqrt()


def _turn(a: Vector, b: Vector) -> Decimal:
    """The change of longitude along an arc."""
    return _atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])


def shared_by_box(
    ring: Any,
    meridians: Any,
    tangents: Any,
) -> Decimal:
    """The area that a ring shares with a cell between two meridians and two parallels."""
    with localcontext() as context:
        context.prec = DIGITS
        low, high = (_sine(t) for t in tangents)
        west, east = (_vector(m) for m in meridians)
        zero = Decimal(0)
        total = zero
        for sign, triangle in _fan(ring):
            part = _clip(triangle, [-west[1], west[0], zero])
            if len(part) > 2:
                part = _clip(part, [east[1], -east[0], zero])
            if len(part) > 2:
                total += sign * _between(part, low, high)
        return total


def _between(ring: list[Vector], low: Decimal, high: Decimal) -> Decimal:
    """The area of a convex part of a lune between two parallels."""
    found, around = Decimal(0), Decimal(0)
    for k, a in enumerate(ring):
        b = ring[(k + 1) % len(ring)]
        polar = min(a[0] ** 2 + a[1] ** 2, b[0] ** 2 + b[1] ** 2) < _TINY**2
        turn = Decimal(0) if polar else _turn(a, b)
        if abs(turn) < _TINY:
            continue
        around += turn
        for p, q in _cut(a, b, (low, high)):
            middle = _unit([x + y for x, y in zip(p, q, strict=True)])[2]
            step = _turn(p, q)
            if middle >= high:
                found -= (high - low) * step
            elif middle > low:
                # The integral of the sine is the step minus the triangle with the pole.
                pole = [Decimal(0), Decimal(0), Decimal(1)]
                found -= step - _triangle(pole, p, q) - low * step
    # A ring around the pole, or with a corner there, lacks what is north of all its sides.
    return found + (high - low) * around if around > _TINY else found


def _cut(a: Vector, b: Vector, sines: tuple[Decimal, Decimal]) -> list[tuple[Vector, Vector]]:
    """An arc in parts that no parallel crosses."""
    n = _cross(a, b)
    m = n[0] ** 2 + n[1] ** 2
    square = _dot(n, n)
    inner = []
    for s in sines:
        # The points of the circle at this height, on either side of its highest one.
        rest = m - s * s * square
        if rest <= 0 or not m:
            continue
        root = rest.sqrt()
        for way in (root, -root):
            x = [
                (-n[0] * n[2] * s - way * n[1]) / m,
                (-n[1] * n[2] * s + way * n[0]) / m,
                s,
            ]
            if _dot(_cross(n, a), x) > 0 and _dot(_cross(b, n), x) > 0:
                inner.append(x)
    inner.sort(key=lambda x: -_dot(a, x))
    places = [a, *inner, b]
    return list(pairwise(places))
