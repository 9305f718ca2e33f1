"""Alpha complexes by their definition, in fractions: balls from linear equations."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np


def _solved(matrix, right):
    """Solve a system of fractions whose matrix is regular."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    for i in range(len(rows)):
        pivot = next(j for j in range(i, len(rows)) if rows[j][i] != 0)
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for j in range(len(rows)):
            if j != i:
                rows[j] = [x - rows[j][i] * y for x, y in zip(rows[j], rows[i], strict=True)]
    return [row[-1] for row in rows]


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def ball(corners, weights):
    """Return the center and the squared radius of the smallest ball orthogonal to sites."""
    first, *others = corners
    vectors = [[x - y for x, y in zip(p, first, strict=True)] for p in others]
    heights = [_dot(v, v) + weights[0] - w for v, w in zip(vectors, weights[1:], strict=True)]
    gram = [[2 * _dot(v, u) for u in vectors] for v in vectors]
    shares = _solved(gram, heights) if vectors else []
    center = [
        x + sum(share * v[k] for share, v in zip(shares, vectors, strict=True))
        for k, x in enumerate(first)
    ]
    away = [x - y for x, y in zip(center, first, strict=True)]
    return center, _dot(away, away) - weights[0]


def exact(array):
    return [[Fraction(float(x)) for x in row] for row in array]


def values(points, tops, weights=None):
    """Return the exact value of every face of the simplices `tops`, by its sorted rows."""
    at = exact(points)
    heavy = (
        [Fraction(float(w)) for w in weights] if weights is not None else [Fraction(0)] * len(at)
    )
    found = {}
    size = len(tops[0]) if len(tops) else 0
    levels = [set() for _ in range(size)]
    for top in tops:
        for k in range(size):
            levels[k].update(combinations(sorted(map(int, top)), k + 1))
    for k in range(size - 1, -1, -1):
        for face in levels[k]:
            center, square = ball([at[i] for i in face], [heavy[i] for i in face])
            if k == size - 1 or not _is_met(center, square, at, heavy, face):
                found[face] = square
                continue
            cofaces = (each for each in levels[k + 1] if set(face) < set(each))
            found[face] = min(found[each] for each in cofaces)
    return found


def _is_met(center, square, at, heavy, face):
    """Tell whether a site is in conflict with a ball."""
    for i, p in enumerate(at):
        away = [x - y for x, y in zip(p, center, strict=True)]
        if i not in face and _dot(away, away) - heavy[i] < square:
            return True
    return False


def listed(complex):
    """Return the values of all simplices of an `AlphaComplex`, by their sorted rows."""
    return {
        tuple(sorted(row)): value
        for k in range(complex.dimension + 1)
        for row, value in zip(
            complex.simplices_of(k).tolist(), complex.values_of(k).tolist(), strict=True
        )
    }


def as_coordinates(complex, found):
    """Return values by the sorted coordinates of the corners."""
    at = [tuple(row) for row in complex.points.tolist()]
    return {tuple(sorted(at[i] for i in face)): value for face, value in found.items()}


def lattice(*sizes):
    grids = np.meshgrid(*(np.arange(n, dtype=float) for n in sizes))
    return np.column_stack([grid.ravel() for grid in grids])
