"""Small surfaces of triangles, and an exact judge of tetrahedra inside them, in fractions."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import combinations, product
from math import cos, pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from rational import cross, dot, exact, minus

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rational import Vector

    Surface = tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]

# The triangles of a box whose corners are numbered by x, y and z, seen from outside.
BOX = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
BOX += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def box(low: Sequence[float], high: Sequence[float]) -> Surface:
    points = np.array(list(product(*zip(low, high, strict=True))), dtype=float)
    return points, np.array(BOX)


def joined(*surfaces: Surface) -> Surface:
    """All in one, vertices apart."""
    points, faces, count = [], [], 0
    for places, rows in surfaces:
        points.append(places)
        faces.append(np.asarray(rows) + count)
        count += len(places)
    return np.concatenate(points), np.concatenate(faces)


def schoenhardt(twist: float = -pi / 6, height: float = 1.0) -> Surface:
    """A prism whose top is turned, with edges folded inward: it has no tetrahedra of its own."""
    low = [(cos(2 * pi * k / 3), sin(2 * pi * k / 3), 0.0) for k in range(3)]
    high = [(cos(2 * pi * k / 3 + twist), sin(2 * pi * k / 3 + twist), height) for k in range(3)]
    faces = [(0, 2, 1), (3, 4, 5)]
    for k in range(3):
        j = (k + 1) % 3
        # The diagonal from the low corner j to the high corner k is reflex for a negative twist.
        faces += [(k, j, 3 + k), (j, 3 + j, 3 + k)]
    return np.array(low + high), np.array(faces)


def torus(major: int = 8, minor: int = 5) -> Surface:
    """A ring around the z-axis."""
    points = [
        (
            (3 + cos(2 * pi * j / minor)) * cos(2 * pi * i / major),
            (3 + cos(2 * pi * j / minor)) * sin(2 * pi * i / major),
            sin(2 * pi * j / minor),
        )
        for i in range(major)
        for j in range(minor)
    ]
    faces = []
    for i, j in product(range(major), range(minor)):
        a, b = i * minor + j, i * minor + (j + 1) % minor
        c, d = (i + 1) % major * minor + j, (i + 1) % major * minor + (j + 1) % minor
        faces += [(a, c, d), (a, d, b)]
    return np.array(points), np.array(faces)


def six(a: Vector, b: Vector, c: Vector, d: Vector) -> Fraction:
    """Six times the volume of a tetrahedron; positive for the unit corner."""
    return dot(minus(b, a), cross(minus(c, a), minus(d, a)))


def volume(points: Any, faces: Any) -> Fraction:
    """The signed volume that triangles enclose."""
    places = exact(points)
    corners = [[places[i] for i in face] for face in np.asarray(faces).tolist()]
    return sum((dot(a, cross(b, c)) for a, b, c in corners), Fraction(0)) / 6


def filled(points: Any, simplices: Any) -> Fraction:
    """The volume of tetrahedra, each of which must be positive."""
    places = exact(points)
    sixths = [six(*[places[i] for i in row]) for row in np.asarray(simplices).tolist()]
    assert all(value > 0 for value in sixths)
    return sum(sixths, Fraction(0)) / 6


def triangles(simplices: Any) -> Counter[frozenset[int]]:
    """How many tetrahedra have each triangle."""
    rows = np.asarray(simplices).tolist()
    return Counter(frozenset(face) for row in rows for face in combinations(row, 3))


def covered(points: Any, face: Sequence[int], parts: Any) -> bool:
    """Whether triangles in the plane of a face, which do not overlap, cover it exactly."""
    places = exact(points)

    def normal(row: Sequence[int]) -> Vector:
        a, b, c = (places[i] for i in row)
        return cross(minus(b, a), minus(c, a))

    whole = normal(face)
    shares = [normal(row) for row in parts]
    edges = [(face[k - 1], face[k]) for k in range(3)]
    inside = all(
        dot(cross(minus(places[b], places[a]), minus(places[i], places[a])), whole) >= 0
        for row in parts
        for i in row
        for a, b in edges
    )
    flat = all(dot(minus(places[i], places[face[0]]), whole) == 0 for row in parts for i in row)
    size = sum((abs(dot(share, whole)) for share in shares), Fraction(0))
    return inside and flat and size == dot(whole, whole)


def inside_number(points: Any, faces: Any, place: Vector) -> int:
    """The winding number at a place not on the surface, by a ray in a direction that hits no edge.

    Directions are tried until none of the triangles is hit at its rim.
    """
    places = exact(points)
    rows = [[places[i] for i in face] for face in np.asarray(faces).tolist()]
    for seed in range(1, 1000):
        way = tuple(map(Fraction, (1, seed, seed * seed)))
        number, clear = 0, True
        for a, b, c in rows:
            u, v, w = (minus(p, place) for p in (a, b, c))
            # Signs of the tetrahedra of the ray with the edges, and of the normal along the ray.
            turns = [dot(way, cross(p, q)) for p, q in ((u, v), (v, w), (w, u))]
            along = dot(way, cross(minus(b, a), minus(c, a)))
            if along == 0 or not (all(t > 0 for t in turns) or all(t < 0 for t in turns)):
                clear &= not (all(t >= 0 for t in turns) or all(t <= 0 for t in turns))
                continue
            ahead = dot(u, cross(minus(b, a), minus(c, a)))
            if (ahead > 0) == (along > 0) and ahead != 0:
                number += 1 if along > 0 else -1
        if clear:
            return number
    raise AssertionError("every ray hits an edge")


def center(points: Any, row: Sequence[int]) -> Vector:
    """The mean of the corners of a simplex."""
    corners = [exact(points)[i] for i in row]
    return tuple(sum(values, Fraction(0)) / len(corners) for values in zip(*corners, strict=True))
