"""What the figures of flips start with: a scan from left to right, and the flips of the core."""

from __future__ import annotations

from typing import Any

from live_answers import Points, flat, key, picture

import delone
from delone.reference import orient

FOUR: Points = [[60, 310], [450, 80], [760, 370], [370, 620]]
TALL = (0, 0, 820, 680)
SQUARE = (0, 0, 600, 600)
FLIPPED: Points = [
    [90, 120], [120, 410], [150, 520], [210, 60], [240, 380], [280, 480], [320, 220], [370, 110],
    [400, 540], [520, 500], [550, 330],
]  # fmt: skip


def scan(points: Points) -> list[tuple[int, int, int]]:
    """Join each point, from left to right, with the edges of the hull that it sees.

    As `scan` of the core for pages, for points of which the first three are not on one line.
    """
    rows = sorted(range(len(points)), key=lambda row: points[row])
    a, b, c = rows[:3]
    hull = [a, b, c] if orient(points[a], points[b], points[c]) > 0 else [b, a, c]
    found = [(hull[0], hull[1], hull[2])]
    for row in rows[3:]:
        n = len(hull)
        ends = [(hull[k], hull[(k + 1) % n]) for k in range(n)]
        sees = [orient(points[u], points[v], points[row]) < 0 for u, v in ends]
        first = next(k for k in range(n) if sees[k] and not sees[k - 1])
        turned = [(first + k) % n for k in range(n)]
        found += [(ends[k][1], ends[k][0], row) for k in turned if sees[k]]
        hull = [hull[first], row, *(hull[k] for k in turned if not sees[k])]
    return found


def flips(points: Points) -> dict[str, Any]:
    """Return the answer about the flips of points, from the triangles of a scan."""
    start = scan(points)
    result = delone.lawson(points, start, record=True)
    assert result.sequence is not None
    return {
        key("flips", flat(points)): {
            "start": flat(start),
            "sequence": flat(result.sequence.tolist()),
        }
    }


def quad() -> dict[str, Any]:
    """Return the figure of four points and two diagonals."""
    shown = picture(FOUR, [0, 1, 2, 0, 2, 3], TALL)
    return {"points": FOUR, "answers": {}, "picture": shown}


def lawson() -> dict[str, Any]:
    """Return the figure of Lawson's flips."""
    answers = flips(FLIPPED)
    (found,) = answers.values()
    return {
        "points": FLIPPED,
        "answers": answers,
        "picture": picture(FLIPPED, found["start"], SQUARE),
    }


FIGURES = {"quad": quad, "lawson": lawson}
