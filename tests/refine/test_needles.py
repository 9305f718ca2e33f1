"""Needles as thin as the last place of a double, around which edges are locally Delaunay, too."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

import delone

U = 2.0**-52
TINY = 5e-324


def ring(count: int) -> list[tuple[int, int]]:
    return [(i, (i + 1) % count) for i in range(count)]


# Each had edges with a vertex inside the circle of the triangle beyond: a segment was split at a
# rounded place outside the circle of a needle, and nobody looked at the edges of the new vertex.
CASES: dict[str, tuple[list[tuple[float, float]], list[tuple[int, int]], dict[str, Any]]] = {
    "two lines one place apart": (
        [(0, 2 + 2 * U), (3 - 2 * U, 2), (0, 2 + 2 * U), (0, 1 - U / 2), (3, 2 + 2 * U),
         (2 + 2 * U, 2), (2, 2 - U), (1, 1 - U / 2)],
        ring(8),
        {"min_angle": 30, "max_area": 0.9},
    ),
    "frozen needles": (
        [(3, 2 + 2 * U), (3 + 2 * U, 3 + 2 * U), (2, 3 - 2 * U), (3, 1), (3 - 2 * U, TINY),
         (2 + 2 * U, -TINY), (2 - U, 2 - U)],
        [*ring(7), (4, 0), (0, 6)],
        {"min_angle": 25, "max_area": 0.012, "fixed": "boundary"},
    ),
    "a budget that ends": (
        [(2 - U, 2 - U), (3 - 2 * U, 3 - 2 * U), (2 - U, TINY), (3 + 2 * U, 1 - U / 2), (3, TINY),
         (2, 1 - U / 2), (3 + 2 * U, 0), (1, 0)],
        [*ring(8), (5, 4)],
        {"min_angle": 30, "max_points": 4000},
    ),
    "subnormal ends": (
        [(1, 1), (TINY, 2 - U), (1 - U / 2, 1), (2 - U, TINY), (-TINY, 2 - U), (-TINY, 1 - U / 2),
         (3 + 2 * U, -TINY), (2 - U, 3)],
        [*ring(8), (5, 3), (0, 5)],
        {"min_angle": 25, "max_points": 4000},
    ),
    "lines that meet in a needle": (
        [(2, 3 + 2 * U), (2 + 2 * U, -TINY), (3 + 2 * U, 3), (3 + 2 * U, 2 + 2 * U), (2, 1),
         (3 - 2 * U, 2 + 2 * U), (1, 2 - U)],
        [*ring(7), (5, 1), (3, 4)],
        {"min_angle": 30, "max_area": 0.09, "max_points": 4000},
    ),
}  # fmt: skip


def in_circle(a: Any, b: Any, c: Any, d: Any) -> bool:
    """Whether d lies strictly in the circle of the counter-clockwise triangle abc, in fractions."""
    rows = [(x - d[0], y - d[1]) for x, y in (a, b, c)]
    (ax, ay), (bx, by), (cx, cy) = rows
    la, lb, lc = (x * x + y * y for x, y in rows)
    return bool(la * (bx * cy - by * cx) - lb * (ax * cy - ay * cx) + lc * (ax * by - ay * bx) > 0)


def not_delaunay(mesh: delone.Mesh) -> list[tuple[int, int]]:
    """The inner edges without a segment beyond which a vertex is in the circle."""
    points = [tuple(map(Fraction, p)) for p in mesh.points.tolist()]
    segments = {frozenset(s) for s in mesh.segments.tolist()}
    apex = {}
    for t in mesh.simplices.tolist():
        for k in range(3):
            apex[t[k], t[k - 2]] = t[k - 1]
    return [
        (a, b)
        for (a, b), c in apex.items()
        if a < b and (b, a) in apex and frozenset((a, b)) not in segments
        if in_circle(*(points[v] for v in (a, b, c, apex[b, a])))
    ]


@pytest.mark.parametrize("name", CASES)
def test_every_edge_without_a_segment_is_locally_delaunay(name: str) -> None:
    points, segments, options = CASES[name]
    mesh = delone.mesh((points, segments), crossing="split", **options)
    assert not_delaunay(mesh) == []


@pytest.mark.filterwarnings("error")
def test_needles_whose_centres_are_beyond_the_range_stay_in_silence() -> None:
    points = [(TINY, 3), (2 + 4 * U, 2 + 2 * U), (0, -TINY), (0, 2), (3, 1), (2, 2), (TINY, 1 + U)]
    points += [(0, 2 - U), (-TINY, 2 - U)]
    segments = [*ring(9), (6, 8), (7, 3)]
    options = {"min_angle": 20, "max_area": 0.25, "max_points": 1500, "crossing": "split"}
    mesh = delone.mesh((points, segments), smooth=1, **options)
    assert not_delaunay(mesh) == []
