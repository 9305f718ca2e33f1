"""Answers of the core to the questions of figures, under the names that stored.js looks for."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from delone import Delaunay

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

Points = list[list[float]]

WIDE = (0, 0, 1000, 600)


def key(name: str, *parts: Iterable[float]) -> str:
    """Return the name of an answer, as `keyOf` of stored.js does."""
    return ":".join([name, *(" ".join(map(number, part)) for part in parts)])


def number(value: float) -> str:
    """Return a number as JavaScript writes it."""
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return "NaN" if math.isnan(value) else f"{'-' * (value < 0)}Infinity"
    return str(int(value)) if value == int(value) else repr(float(value))


def flat(rows: Any) -> list[Any]:
    """Return the numbers of an array in one list."""
    return [value for row in rows for value in row]


def delaunay(points: Sequence[Sequence[float]]) -> dict[str, Any]:
    """Return the answer about the triangles of points."""
    return {key("delaunay", flat(points)): flat(Delaunay(points).simplices.tolist())}


def picture(
    points: Points, triangles: list[int], view: tuple[float, float, float, float] = WIDE
) -> dict[str, Any]:
    """Return what the first picture shows."""
    faces = [triangles[t : t + 3] for t in range(0, len(triangles), 3)]
    return {"points": points, "triangles": faces, "view": view}


def plain(points: Points, view: tuple[float, float, float, float] = WIDE) -> dict[str, Any]:
    """Return a figure that asks for the triangles of its points alone."""
    answers = delaunay(points)
    shown = picture(points, next(iter(answers.values())), view)
    return {"points": points, "answers": answers, "picture": shown}
