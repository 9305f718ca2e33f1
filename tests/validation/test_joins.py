"""Equal facets in lists, against dictionaries of their vertices."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from delone import Delaunay, ShapeError, _core


@pytest.mark.parametrize("width", [2, 3])
@pytest.mark.parametrize("directed", [False, True])
def test_the_first_equal_row(width: int, directed: bool) -> None:
    """Few vertices, so that rows repeat in all orders, and some wanted rows are in none."""
    rng = np.random.default_rng(width)
    facets = rng.integers(0, 5, (40, width), dtype=np.int32)
    wanted = rng.integers(-1, 7, (60, width), dtype=np.int32)
    rows: dict[tuple[int, ...], int] = {}
    for row, facet in enumerate(facets.tolist()):
        rows.setdefault(tuple(facet if directed else sorted(facet)), row)
    expected = [rows.get(tuple(w if directed else sorted(w)), -1) for w in wanted.tolist()]
    assert set(expected) > {-1}
    assert _core.facet_rows(facets, wanted, 5, directed).tolist() == expected


@pytest.mark.parametrize("d", [2, 3])
def test_neighbors_of_part_of_a_triangulation(d: int) -> None:
    rng = np.random.default_rng(d)
    simplices = Delaunay(rng.random((50, d))).simplices
    simplices = simplices[rng.permutation(len(simplices))[: len(simplices) * 2 // 3]]
    of: dict[frozenset[int], list[int]] = {}
    for t, corners in enumerate(simplices.tolist()):
        for facet in combinations(corners, d):
            of.setdefault(frozenset(facet), []).append(t)
    found = _core.facet_neighbors(simplices, 50)
    for t, corners in enumerate(simplices.tolist()):
        for k, corner in enumerate(corners):
            others = [u for u in of[frozenset(corners) - {corner}] if u != t]
            assert [found[t, k]] == (others or [-1])


def test_rows_out_of_range_are_refused() -> None:
    with pytest.raises(ShapeError, match="outside 0"):
        _core.facet_neighbors(np.array([(0, 1, 3)], dtype=np.int32), 3)
    none = np.empty((0, 2), dtype=np.int32)
    assert _core.facet_rows(none, none, 0, True).shape == (0,)
    with pytest.raises(ShapeError, match="wanted has 3 columns, not 2"):
        _core.facet_rows(none, np.empty((0, 3), dtype=np.int32), 0, True)
