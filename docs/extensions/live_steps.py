"""What the figures of the course start with: points, and the answers of the core for them.

A figure asks its core questions such as "the triangles of these points". `FIGURES` has a function
for each figure that gives its points and the answers to all questions that its sliders lead to;
they are stored with the site, so that the figures work, up to dragging, without the compiled core.
The points have small integer coordinates, for which the arithmetic of a browser is exact.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import live_cells
import live_domains
import live_failures
import live_flips
import live_methods
import live_predicates
import live_space
from live_answers import Points, delaunay, plain

if TYPE_CHECKING:
    from collections.abc import Callable

SCATTERED: Points = [
    [120, 130], [310, 60], [520, 150], [760, 70], [900, 230], [680, 260], [430, 290],
    [200, 330], [80, 500], [330, 520], [560, 430], [620, 560], [860, 490],
]  # fmt: skip
FIVE: Points = [[0, 0], [4, 0], [4, 3], [0, 3], [2, 1]]
# Early points span the figure, later ones fall inside, and two beyond the hull.
INSERTED: Points = [
    [150, 110], [820, 80], [500, 540], [470, 230], [330, 330], [640, 300], [420, 130],
    [520, 390], [860, 470], [560, 180], [140, 430],
]  # fmt: skip


def circle() -> dict[str, Any]:
    """Return the figure of empty circles."""
    return plain(SCATTERED)


def five() -> dict[str, Any]:
    """Return the figure of five points, also without the last."""
    figure = plain(FIVE, (-2.4, -4.3, 6.4, 5.3))
    figure["answers"] |= delaunay(FIVE[:4])
    return figure


def insertion() -> dict[str, Any]:
    """Return the figure of Bowyer-Watson: the triangles after each insertion."""
    figure = plain(INSERTED)
    for count in range(3, len(INSERTED)):
        figure["answers"] |= delaunay(INSERTED[:count])
    return figure


FIGURES: dict[str, Callable[[], dict[str, Any]]] = {
    "circle": circle,
    "five": five,
    "insertion": insertion,
    "constrained": live_domains.constrained,
    "lift": live_cells.lift,
    "refined": live_domains.refined,
    "sliver": live_space.sliver,
    "slivers": live_space.slivers,
    "voronoi": live_cells.voronoi,
    **live_predicates.FIGURES,
    **live_flips.FIGURES,
    **live_methods.FIGURES,
    **live_failures.FIGURES,
}


@cache
def stored(name: str) -> dict[str, Any]:
    """Return points, answers and the first picture of a figure."""
    return FIGURES[name]()
