"""Neighbours of arbitrary triangles, from the core."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import Delaunay, _core, datasets
from delone.errors import ShapeError

ROWS = st.lists(st.permutations(range(6)).map(lambda p: p[:3]), max_size=8)


def by_search(simplices: list[list[int]]) -> list[list[int]] | tuple[int, int]:
    """The neighbours, or a directed edge that occurs twice."""
    sides: dict[tuple[int, int], int] = {}
    for t, (a, b, c) in enumerate(simplices):
        for edge in ((a, b), (b, c), (c, a)):
            if edge in sides:
                return edge
            sides[edge] = t
    return [[sides.get(e, -1) for e in ((c, b), (a, c), (b, a))] for a, b, c in simplices]


@given(ROWS)
def test_neighbours_are_those_across_the_edges(simplices: list[list[int]]) -> None:
    array = np.array(simplices, dtype=np.int32).reshape(-1, 3)
    expected = by_search(simplices)
    if isinstance(expected, list):
        assert _core.neighbors2(array, 6).tolist() == expected
        return
    with pytest.raises(ShapeError, match="occurs twice") as caught:
        _core.neighbors2(array, 6)
    words = str(caught.value).split()
    u, v = int(words[3]), int(words[5])
    edges = [e for a, b, c in simplices for e in ((a, b), (b, c), (c, a))]
    assert edges.count((u, v)) > 1


@pytest.mark.parametrize("points", [datasets.uniform(500), datasets.grid(400)])
def test_neighbours_of_a_triangulation(points: np.ndarray) -> None:
    mesh = Delaunay(points)
    found = _core.neighbors2(np.array(mesh.simplices), len(points))
    assert found.dtype == np.int32
    assert np.array_equal(found, mesh.neighbors)


def test_vertices_out_of_range_are_refused() -> None:
    with pytest.raises(ShapeError, match="outside"):
        _core.neighbors2(np.array([[0, 1, 3]], dtype=np.int32), 3)
    with pytest.raises(ShapeError, match="vertex 1 twice"):
        _core.neighbors2(np.array([[0, 1, 1]], dtype=np.int32), 3)
