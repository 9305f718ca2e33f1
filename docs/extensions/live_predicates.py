"""What the figures of rounded predicates start with: exact signs, and points that nearly tie.

The coordinates come from the four basic operations alone, which round in the same way everywhere.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from live_answers import Points, delaunay, picture, plain

from delone import predicates

SIDE = 64  # cells of a picture of signs in each direction
MIDDLE = 0.5
EXPONENTS = tuple(range(47, 54))  # of the distance of neighboring cells
FIXED = {
    "orient2d": ((12.0, 12.0), (24.0, 24.0)),
    "incircle": ((24.0, 0.5), (24.0, 24.0), (0.5, 24.0)),
}
SQUARE = (0, 0, 600, 600)
# Tangents of half the angle of each point on the circle.
HALVES = (0.1, 2.4, -1.3, 0.6, -5.0, -0.45, 1.2, 7.0, -0.1)
ORDER = (0, 1, 4, 2, 8, 5, 3, 12, 6, 9, 7, 13, 10, 11, 14, 15)
TURN, DISTANCE = 0.22, 110.0


def cells(exponent: int) -> np.ndarray:
    """Return the points of a picture of signs, row by row from below."""
    steps = MIDDLE + np.arange(-SIDE // 2, SIDE // 2) * 2.0**-exponent
    x, y = np.meshgrid(steps, steps)
    return np.column_stack((x.ravel(), y.ravel()))


def signs() -> dict[str, Any]:
    """Return the figure of signs near a line and near a circle: 0, 1, 2 for -1, 0, 1."""
    answers = {}
    for name, fixed in FIXED.items():
        for exponent in EXPONENTS:
            found = getattr(predicates, name)(*map(np.array, fixed), cells(exponent))
            answers[f"signs:{name}:{exponent}"] = "".join(map(str, (found + 1).tolist()))
    corners: Points = [[0, 0], [63, 63], [0, 63], [63, 0]]
    return {
        "points": [[30, 35]],
        "fixed": {name: np.ravel(fixed).tolist() for name, fixed in FIXED.items()},
        "exponents": list(EXPONENTS),
        "answers": answers,
        "picture": picture(corners, [0, 1, 2], (-0.5, -0.5, 63.5, 63.5)),
    }


def unit(half: float) -> tuple[float, float]:
    """Return cosine and sine of an angle, from the tangent of its half."""
    square = half * half
    return (1 - square) / (1 + square), 2 * half / (1 + square)


def around() -> Points:
    """Return points of a circle, rounded."""
    return [[300 + 270 * x, 300 + 270 * y] for x, y in map(unit, HALVES)]


def lattice() -> Points:
    """Return the points of a square grid that is rotated, rounded."""
    c, s = unit(TURN)
    found = []
    for row in ORDER:
        x, y = (row % 4 - 1.5) * DISTANCE, (row // 4 - 1.5) * DISTANCE
        found.append([300 + c * x - s * y, 300 + s * x + c * y])
    return found


def prefixes(points: Points) -> dict[str, Any]:
    """Return a figure that asks for the triangles of the first points, of all counts."""
    figure = plain(points, SQUARE)
    for count in range(3, len(points)):
        figure["answers"] |= delaunay(points[:count])
    return figure


def ring() -> dict[str, Any]:
    """Return the figure of points nearly on a circle."""
    return prefixes(around())


def turned() -> dict[str, Any]:
    """Return the figure of a rotated grid."""
    return prefixes(lattice())


FIGURES = {"signs": signs, "ring": ring, "turned": turned}
