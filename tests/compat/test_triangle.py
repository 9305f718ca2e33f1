"""What the drop-in for the package ``triangle`` refuses, and how."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone.compat.triangle import convex_hull, delaunay, triangulate, voronoi
from delone.errors import DtypeError, InputError, ShapeError

SQUARE: dict[str, Any] = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)]}


@pytest.mark.parametrize("tri", [None, 5, [(0, 0), (1, 0), (0, 1)]])
def test_what_is_no_mapping(tri: Any) -> None:
    with pytest.raises(DtypeError, match="tri must be a mapping"):
        triangulate(tri)


@pytest.mark.parametrize("opts", [None, 5, b"q"])
def test_switches_that_are_no_string(opts: Any) -> None:
    with pytest.raises(DtypeError, match="opts must be a string"):
        triangulate(SQUARE, opts)


def test_without_segments_nothing_is_enclosed() -> None:
    with pytest.raises(InputError, match="no ring of segments encloses anything"):
        triangulate(SQUARE, "p")
    assert len(triangulate(SQUARE, "pc")["triangles"]) == 2


@pytest.mark.parametrize("call", [delaunay, convex_hull, voronoi])
def test_points_are_of_the_plane(call: Any) -> None:
    with pytest.raises(ShapeError, match=r"pts must have shape \(n, 2\), got \(5, 3\)"):
        call(np.eye(5, 3))
