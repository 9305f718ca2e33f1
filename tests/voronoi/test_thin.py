"""Cells that rounding has taken are named."""

from __future__ import annotations

import warnings
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from delone import Voronoi
from delone.voronoi import ThinCellWarning

EPS = 2.0**-52
CLUSTER = 1 + EPS * np.array([(i, j) for i in range(6) for j in range(6)], dtype=float)


def test_cells_of_a_cluster_a_few_units_wide_are_named() -> None:
    points = np.concatenate((CLUSTER, [(0, 0), (3, 0), (0, 3), (3, 3)]))
    diagram = Voronoi(points, clip="box")
    with pytest.warns(ThinCellWarning, match=r"rows 1, 2, 3, 4, 6, 7, 8, 9, \.\.\.") as caught:
        areas = diagram.cell_areas
    assert (areas == 0).sum() == 20
    assert set(np.flatnonzero(areas == 0)) <= set(diagram.thin_cells.tolist())
    assert caught[0].filename == __file__
    message: Any = caught[0].message
    assert message.rows.tolist() == diagram.thin_cells.tolist()
    # What is named is what an exact area is not known of: the strips between sites on one line.
    rest = np.setdiff1d(np.arange(40), diagram.thin_cells)
    assert (areas[rest] > 0.1).all()


def test_strips_within_an_outline_are_named() -> None:
    shapely = pytest.importorskip("shapely")
    points = [(1 + k * EPS, 0.5) for k in range(8)]
    diagram = Voronoi(points, clip=shapely.Polygon([(0, 0), (2, 0), (2, 1), (1, 1.5), (0, 1)]))
    with pytest.warns(ThinCellWarning, match="6 cells are"):
        assert diagram.cell_areas.sum() == pytest.approx(2.5)
    assert diagram.thin_cells.tolist() == [1, 2, 3, 4, 5, 6]


def test_an_outline_a_few_units_wide_leaves_cells_that_are_named() -> None:
    shapely = pytest.importorskip("shapely")
    points = np.random.default_rng(0).random((20, 2))
    needle = shapely.Polygon([(0.1, 0.5), (0.9, 0.5), (0.9, 0.5 + 3 * EPS / 4)])
    diagram = Voronoi(points, clip=needle)
    with pytest.warns(ThinCellWarning):
        kept = diagram.cell_areas > 0
    assert diagram.thin_cells.tolist() == np.flatnonzero(kept).tolist()


def test_a_site_alone_is_named_by_all_of_its_rows() -> None:
    points = np.array([(1.0, 0.0), (1 + EPS, 0.0), (1 + 2 * EPS, 0.0), (1 + EPS, 0.0)])
    diagram = Voronoi(points, clip=(0, -1, 2, 1))
    with pytest.warns(ThinCellWarning, match="rows 1, 3"):
        assert diagram.cell_areas.tolist()[1] in (0.0, 2 * EPS, 4 * EPS)
    assert diagram.thin_cells.tolist() == [1, 3]


@pytest.mark.parametrize(
    ("points", "clip"),
    [
        (np.random.default_rng(1).random((300, 2)), "box"),
        (np.random.default_rng(1).random((300, 2)) * [1, 1e-300], "box"),
        (np.random.default_rng(1).random((300, 2)) * 1e-200, None),
        (np.random.default_rng(1).random((300, 2)) * 1e-3 + 5e6, "box"),
        ([(0, 0), (1, 0), (0, 1), (50, 50)], (-1, -1, 2, 2)),
        ([(0.5, 0.5)], (0, 0, 5e-324, 1e300)),
        (np.random.default_rng(2).random((60, 3)), "box"),
        (np.random.default_rng(2).random((60, 3)) * [1, 1, 1e-100], "box"),
        (np.random.default_rng(2).random((60, 3)) * 1e-150, "box"),
    ],
)
def test_cells_that_are_small_or_flat_or_empty_are_not(points: Any, clip: Any) -> None:
    diagram = Voronoi(points, clip=clip)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert not np.isnan(diagram.cell_areas).any()
    assert not len(diagram.thin_cells)


@pytest.mark.parametrize("seed", range(5))
def test_areas_of_cells_that_are_not_named_have_digits(seed: int) -> None:
    """Clusters of spacings around the unit in the last place, against exact strips."""
    rng = np.random.default_rng(seed)
    steps = np.unique(rng.integers(1, 2 ** rng.integers(1, 30, 12)))
    points = np.column_stack((1 + EPS * np.cumsum(steps), np.zeros(len(steps))))
    diagram = Voronoi(points, clip=(0, -1, 2, 1))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ThinCellWarning)
        areas = diagram.cell_areas
    x = [Fraction(c) for c in points[:, 0].tolist()]
    middle = [Fraction(0), *((p + q) / 2 for p, q in pairwise(x)), Fraction(2)]
    sizes = [2 * (q - p) for p, q in pairwise(middle)]
    for row, (found, size) in enumerate(zip(areas.tolist(), sizes, strict=True)):
        if row not in diagram.thin_cells:
            assert abs(Fraction(found) - size) < size


def test_volumes_that_rounding_has_taken_are_named() -> None:
    points = [(1 + k * EPS, 0.5, 0.5) for k in range(4)]
    points += [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2), (2, 2, 2)]
    diagram = Voronoi(points, clip="box")
    with pytest.warns(ThinCellWarning, match="volumes"):
        lost = np.flatnonzero(diagram.cell_volumes == 0)
    assert len(lost) and diagram.thin_cells.tolist() == lost.tolist()
