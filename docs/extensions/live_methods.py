"""What the figure of the five methods starts with: their steps, recorded on `delone.reference`.

Each recorder follows the textbook and returns steps as those of the core for pages: what a step is,
the triangles that it removes and adds, and what else its picture shows.
"""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any

from live_answers import Points, flat, key, picture

from delone.reference import bowyer_watson, circumcircle, incircle_canonical, orient
from delone.reference.flips import Edge, flip
from delone.reference.insertion import (
    INFINITE,
    Triangle,
    boundary,
    first_triangle,
    in_conflict,
    smallest_first,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    Step = dict[str, Any]

PLACED: Points = [
    [120, 110], [860, 90], [470, 540], [500, 290], [290, 370], [690, 380], [330, 90], [640, 170],
    [880, 500], [180, 510], [560, 60], [730, 520],
]  # fmt: skip


def step(kind: str, removed: Iterable[Triangle], added: Iterable[Triangle], **more: Any) -> Step:
    """Return a step; triangles with the vertex at infinity are left out."""
    return {
        "kind": kind,
        **{
            name: flat(sorted(smallest_first(t) for t in triangles if INFINITE not in t))
            for name, triangles in (("removed", removed), ("added", added))
        },
        **more,
    }


def ghosts(first: Triangle) -> list[Triangle]:
    """Return a triangle and those beyond its edges."""
    a, b, c = first
    return [first, (b, a, INFINITE), (c, b, INFINITE), (a, c, INFINITE)]


def cavities(points: Points) -> list[Step]:
    """Record Bowyer-Watson in the order of the rows."""
    rows = list(range(len(points)))
    first = first_triangle(points, rows)  # type: ignore[arg-type]
    triangles = set(ghosts(first))
    steps = [step("start", [], [first])]
    for row in rows:
        if row in first:
            continue
        bad = {t for t in triangles if in_conflict(points, t, row)}  # type: ignore[arg-type]
        star = {(u, v, row) for u, v in boundary(bad)}
        triangles = triangles - bad | star
        steps.append(step("insert", bad, star, point=row))
    return steps


def splits(points: Points) -> list[Step]:
    """Record insertion with flips in the order of the rows, for points in general position."""
    rows = list(range(len(points)))
    first = first_triangle(points, rows)  # type: ignore[arg-type]
    apex: dict[Edge, int] = {
        edge: row
        for a, b, c in ghosts(first)
        for edge, row in (((a, b), c), ((b, c), a), ((c, a), b))
    }
    steps = [step("start", [], [first])]
    for row in rows:
        if row not in first:
            steps += split(points, apex, row)
    return steps


def split(points: Points, apex: dict[Edge, int], row: int) -> list[Step]:
    """Insert a point into the triangle that contains it, or join it to the hull; then flip."""
    triangles = list(dict.fromkeys(smallest_first((u, v, w)) for (u, v), w in apex.items()))
    home = [t for t in triangles if contains(points, t, row)]
    around = boundary(home)
    for u, v in [edge for t in home for edge in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))]:
        del apex[u, v]
    ends = [(t[k], t[(k + 1) % 3]) for t in home for k in range(3)]
    ends = [edge for edge in ends if edge in around]
    for u, v in ends:
        apex[u, v], apex[v, row], apex[row, u] = row, u, v
    steps = [step("insert", home, [(u, v, row) for u, v in ends], point=row)]
    waiting = [edge for edge in ends if INFINITE not in edge]
    while waiting:
        u, v = waiting.pop()
        q = apex[v, u]
        corners = [points[k] for k in (u, v, row, q)]
        if q == INFINITE or incircle_canonical(*corners) <= 0:
            continue
        flip(apex, u, v)
        pair = {"point": row, "before": [u, v], "after": [row, q]}
        steps.append(step("flip", [(u, v, row), (v, u, q)], [(row, u, q), (q, v, row)], **pair))
        waiting += [(u, q), (q, v)]
    return steps


def contains(points: Points, triangle: Triangle, row: int) -> bool:
    """Return whether a triangle, or the half-plane of a ghost, contains a point."""
    if INFINITE in triangle:
        return in_conflict(points, triangle, row)  # type: ignore[arg-type]
    ends = ((triangle[k - 1], triangle[k]) for k in range(3))
    return all(orient(points[u], points[v], points[row]) > 0 for u, v in ends)


def merges(points: Points) -> list[Step]:
    """Record halving, from left to right, and the merges."""
    steps: list[Step] = []

    def solve(part: list[int]) -> set[Triangle]:
        made = (
            {
                smallest_first((part[a], part[b], part[c]))
                for a, b, c in bowyer_watson([points[row] for row in part])
            }
            if len(part) > 2
            else set()
        )
        if len(part) < 4:
            steps.extend([step("start", [], made)] if made else [])
            return made
        left, right = part[: len(part) // 2], part[len(part) // 2 :]
        before = solve(left) | solve(right)
        halves = {"left": left, "right": right}
        steps.append(step("merge", before - made, made - before, **halves))
        return made

    solve(sorted(range(len(points)), key=lambda row: points[row]))
    return steps


def events(points: Points) -> list[Step]:
    """Record the triangles in the order in which a sweep from left to right finds them."""
    found = []
    for triangle in bowyer_watson(points):
        circle = circumcircle(*(points[row] for row in triangle))
        x, y, radius = *map(float, circle.center), math.sqrt(circle.squared_radius)
        found.append((x + radius, y, step("event", [], [triangle], circle=[x, y, radius])))
    return [each for _, _, each in sorted(found, key=lambda event: event[:2])]


def wraps(points: Points) -> list[Step]:
    """Record the wrapping of the lower hull of the lifted points, facet by facet.

    As `wrapSteps` of methods/wrap.js.
    """
    rows = range(len(points))
    u = min(rows, key=lambda row: points[row])
    v = next(v for v in rows if v != u and not any(
        orient(points[u], points[v], points[w]) < 0 for w in rows))  # fmt: skip
    waiting, done, steps = deque([(u, v)]), set(), []
    while waiting:
        u, v = waiting.popleft()
        left = [w for w in rows if orient(points[u], points[v], points[w]) > 0]
        if (u, v) in done or not left:
            continue
        w = left[0]
        for other in left[1:]:
            if incircle_canonical(*(points[row] for row in (u, v, w, other))) > 0:
                w = other
        done |= {(u, v), (v, w), (w, u)}
        waiting += [(w, v), (u, w)]
        steps.append(step("wrap", [], [(u, v, w)], before=[u, v], point=w))
    return steps


METHODS: dict[str, Callable[[Points], list[Step]]] = {
    "bowyer-watson": cavities,
    "incremental": splits,
    "divide-and-conquer": merges,
    "sweep": events,
    "lifting": wraps,
}


def methods() -> dict[str, Any]:
    """Return the figure of the five methods."""
    answers = {
        key("method", [name], flat(PLACED)): record(PLACED) for name, record in METHODS.items()
    }
    triangles = flat(bowyer_watson(PLACED))
    return {"points": PLACED, "answers": answers, "picture": picture(PLACED, triangles)}


FIGURES = {"methods": methods}
