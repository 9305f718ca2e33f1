"""Volumes and dihedral angles of tetrahedra in fractions."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np

from rational import cross, dot, exact, minus

__all__ = ["FACES", "determinant", "sharpest", "volume"]

FACES = ((1, 3, 2), (0, 2, 3), (0, 3, 1), (0, 1, 2))


def determinant(a: Any, b: Any, c: Any) -> Any:
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def volume(points: np.ndarray, simplices: np.ndarray) -> Fraction:
    """Six times the volume; every tetrahedron must be positive."""
    p = exact(points)
    total = Fraction(0)
    for a, b, c, d in simplices.tolist():
        six = determinant(*(minus(p[v], p[a]) for v in (b, c, d)))
        assert six > 0
        total += six
    return total


def sharpest(points: np.ndarray, simplices: np.ndarray) -> Fraction:
    """The largest squared cosine of an acute dihedral angle: that of the smallest angle."""
    p = exact(points)
    worst = Fraction(0)
    for v in simplices.tolist():
        n = [cross(minus(p[v[j]], p[v[i]]), minus(p[v[k]], p[v[i]])) for i, j, k in FACES]
        for a, b in itertools.combinations(n, 2):
            cosine = -dot(a, b)
            if cosine > 0:
                worst = max(worst, cosine * cosine / (dot(a, a) * dot(b, b)))
    return worst
