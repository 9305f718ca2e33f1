"""What the figures of failure modes start with."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from live_answers import Points, delaunay, flat, key, picture

import delone

if TYPE_CHECKING:
    from collections.abc import Iterable

LOW = (0, 0, 1000, 420)
# Parts of the way that a row moves, in the order of the steps.
NEARER = (0, 0.5, 0.9, 0.99, 1)
LOWER = (1, 0.4, 0.1, 0.01, 0)
FACTORS = (1, 2, 5, 20, 50, 100, 1000)

TWICE: Points = [
    [80, 60], [420, 40], [600, 230], [920, 80], [880, 360], [400, 290], [110, 350], [250, 200],
    [700, 130],
]  # fmt: skip
LINE: Points = [[80 + 140 * k, 160] for k in range(7)]
LINE[3] = [500, 360]
GRID: Points = [[320 + 120 * i, 30 + 120 * j] for j in range(4) for i in range(4)]
NORTH: Points = [
    [60, 80], [170, 330], [240, 170], [300, 50], [330, 260], [390, 380], [430, 140], [500, 300],
    [530, 60], [590, 200], [640, 350], [690, 110], [760, 260], [810, 40], [850, 370], [930, 190],
]  # fmt: skip
EASTING, NORTHING = 500_000, 5_400_000
GAPS: Points = [
    [90, 60], [360, 40], [640, 70], [500, 220], [910, 110], [860, 350], [690, 260], [330, 360],
    [120, 300], [270, 190],
]  # fmt: skip
HULL: Points = [
    [60, 40], [500, 42], [940, 40], [928, 200], [940, 390], [610, 372], [60, 390], [100, 210],
    [290, 150], [400, 290], [620, 180], [780, 290], [770, 120],
]  # fmt: skip


def outcome(points: Points) -> dict[str, Any]:
    """Return the answer about the triangles of points, which may be an error."""
    try:
        return delaunay(points)
    except delone.DeloneError as error:
        said = {"error": str(error), "name": type(error).__name__}
        return {key("delaunay", flat(points)): said}


def figure(points: Points, asked: Iterable[Points], **more: Any) -> dict[str, Any]:
    """Return a figure that asks for the triangles of these sets of points."""
    answers: dict[str, Any] = {}
    for each in asked:
        answers |= outcome(each)
    shown = delone.Delaunay(points).simplices.ravel().tolist()
    view = more.pop("view", LOW)
    return {
        "points": points,
        "answers": answers,
        "picture": picture(points, shown, view),
        **more,
    }


def part(points: Points, row: int, to: Iterable[float], share: float) -> Points:
    """Return points with one row moved a part of the way to a place, to whole numbers."""
    at = [math.floor(p + (q - p) * share + 0.5) for p, q in zip(points[row], to, strict=True)]
    return [*points[:row], at, *points[row + 1 :]]


def twice() -> dict[str, Any]:
    """Return the figure of a point that moves onto another."""
    asked = [part(TWICE, 5, TWICE[2], share) for share in NEARER]
    return figure(TWICE, asked, shares=NEARER)


def line() -> dict[str, Any]:
    """Return the figure of points that come to lie on one line."""
    asked = [part(LINE, 3, (LINE[3][0], 160), 1 - share) for share in LOWER]
    return figure(LINE, asked, shares=LOWER)


def grid() -> dict[str, Any]:
    """Return the figure of a grid, with its rows in two orders."""
    return figure(GRID, [GRID, GRID[::-1]])


def degrees() -> dict[str, Any]:
    """Return the figure of a map at 60 degrees north, where a degree east is half as long."""
    return figure(NORTH, [NORTH, [[2 * x, y] for x, y in NORTH]])


def survey() -> Points:
    """Return points of a small survey, in meters, to centimeters."""
    places = np.random.default_rng(3).random((24, 2)) * (9.2, 3.4) + 0.4
    rounded: Points = np.round(places, 2).tolist()
    # Two points that are 15 cm apart: one place in single precision.
    return [*rounded, [6.4, 1.95], [6.4, 2.1]]


def offset() -> dict[str, Any]:
    """Return the figure of a survey with large coordinates in single precision."""
    points = survey()
    single = [[near(x, EASTING), near(y, NORTHING)] for x, y in points]
    local = [[near(x, 0), near(y, 0)] for x, y in points]
    view = (0, 0, 10, 4.2)
    return figure(points, [points, single, local], view=view, origin=[EASTING, NORTHING])


def near(value: float, origin: int) -> float:
    """Return what single precision leaves of a place relative to an origin."""
    return float(np.float32(origin + value)) - origin


def missing() -> dict[str, Any]:
    """Return the figure of coordinates that are not numbers."""
    nan, inf = math.nan, math.inf
    one = [*GAPS[:3], [nan, 220], *GAPS[4:]]
    two = [*GAPS[:3], [nan, 220], *GAPS[4:6], [690, inf], *GAPS[7:]]
    coded = [*GAPS[:3], [-9999, 220], *GAPS[4:]]
    return figure(GAPS, [GAPS, one, two, coded, GAPS[:3] + GAPS[4:]])


def enclosing() -> dict[str, Any]:
    """Return the figure of a large triangle around the points."""
    asked = [HULL + around(factor) for factor in FACTORS]
    return figure(HULL, [HULL, *asked], factors=FACTORS)


def around(factor: int) -> Points:
    """Return the corners of the triangle that a textbook puts around the points."""
    xs, ys = zip(*HULL, strict=True)
    x, y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    far = max(max(xs) - min(xs), max(ys) - min(ys)) * factor
    return [[x - far, y - far], [x + far, y - far], [x, y + far]]


FIGURES = {
    "degrees": degrees,
    "enclosing": enclosing,
    "grid": grid,
    "line": line,
    "missing": missing,
    "offset": offset,
    "twice": twice,
}
