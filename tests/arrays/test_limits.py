"""Arguments that mean "at most" take any integer, however large."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import InputError
from delone.compat.triangle import triangulate
from delone.interpolate import CloughTocher, NaturalNeighbor

if TYPE_CHECKING:
    from collections.abc import Callable

CORNERS = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
SOLID = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2, 3)]
VALUES = [1.0, 2.0, 3.0, 5.0]

CALLS: dict[str, Callable[[int], Any]] = {
    "mesh": lambda n: delone.mesh((CORNERS, RING), max_area=0.1, max_points=n).points,
    "Mesh.refine": lambda n: delone.mesh((CORNERS, RING)).refine(max_area=0.1, max_points=n).points,
    "Mesh.refine, marked": lambda n: (
        delone.mesh((CORNERS, RING)).refine([0], max_area=0.1, max_points=n).points
    ),
    "Mesh.smooth": lambda n: delone.mesh((CORNERS, RING), max_area=0.1).smooth(min(n, 2)).points,
    "ConstrainedDelaunay": lambda n: (
        delone.ConstrainedDelaunay(
            CORNERS, [(0, 2), (1, 3)], crossing="split", conforming=True, max_points=n
        ).points
    ),
    "improve": lambda n: delone.improve(SOLID, max_iter=n).points,
    "lloyd": lambda n: delone.lloyd(CORNERS, (0, 0, 1, 1), max_iter=n, tol=0.1).points,
    "CloughTocher": lambda n: CloughTocher(CORNERS, VALUES, max_iter=n)([(0.5, 0.25)]),
    "NaturalNeighbor": lambda n: NaturalNeighbor(CORNERS, VALUES, gradients="global", max_iter=n)(
        [(0.5, 0.25)]
    ),
    "triangle": lambda n: triangulate({"vertices": CORNERS, "segments": RING}, f"pa0.1S{n}")[
        "vertices"
    ],
}


@pytest.mark.parametrize("limit", [2**31, 2**63, 2**64, 10**30, 10**400])
@pytest.mark.parametrize("name", CALLS)
def test_a_limit_beyond_all_integers_of_the_core(name: str, limit: int) -> None:
    assert np.array_equal(CALLS[name](limit), CALLS[name](10**6))


@pytest.mark.parametrize("name", [name for name in CALLS if name != "triangle"])
def test_a_negative_limit_is_an_error(name: str) -> None:
    with pytest.raises(InputError, match="at least 0"):
        CALLS[name](-1)
