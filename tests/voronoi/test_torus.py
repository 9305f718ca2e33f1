"""Periodic diagrams against plain ones of copies, and laws of the torus."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone.errors import InputError
from delone.voronoi import Voronoi


def copies(points: Any, periods: tuple[float, float]) -> Any:
    """The points, and behind them all copies up to two periods away."""
    steps = [(i, j) for i in range(-2, 3) for j in range(-2, 3) if (i, j) != (0, 0)]
    return np.concatenate([points, *(points + np.array(s) * periods for s in steps)])


def corners(diagram: Voronoi, row: int) -> list[list[float]]:
    return sorted(np.round(diagram.cell(row).vertices, 9).tolist())


@settings(max_examples=80, deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 5)), min_size=1, max_size=12, unique=True),
    st.sampled_from([(8, 6), (8, 8), (24, 6)]),
)
def test_cells_are_those_of_copies(
    sites: list[tuple[int, int]], periods: tuple[float, float]
) -> None:
    points = np.array(sites, dtype=float)
    diagram = Voronoi(points, periodic=periods)
    plain = Voronoi(copies(points, periods))
    for row in range(len(points)):
        assert corners(diagram, row) == corners(plain, row)
        assert diagram.cell_areas[row] == pytest.approx(plain.cell_areas[row])
    assert diagram.cell_areas.sum() == pytest.approx(periods[0] * periods[1])
    # Ridges: each between two sites once, seen from the first one.
    ends = diagram.vertices[diagram.ridge_vertices]
    a = points[diagram.ridge_points[:, 0]]
    b = points[diagram.ridge_points[:, 1]] + diagram.ridge_offsets * np.array(periods)
    for end in ends.swapaxes(0, 1):
        assert np.allclose(np.hypot(*(end - a).T), np.hypot(*(end - b).T))
    assert (np.hypot(*(ends[:, 1] - ends[:, 0]).T) > 1e-9).all()
    # Vertices, ridges and cells of a torus: V - E + F = 0, with one of each class of translates.
    classes = np.unique(np.round(diagram.vertices % periods, 6) % periods, axis=0)
    assert len(classes) - len(ends) + len(points) == 0


def test_periods_that_no_double_holds() -> None:
    points = np.random.default_rng(1).random((300, 2)) * [0.3, 1.1]
    diagram = Voronoi(points, periodic=(0.3, 1.1))
    assert diagram.cell_areas.sum() == pytest.approx(0.33)
    indptr, indices, lengths = diagram.neighbors
    assert len(indices) == 2 * len(diagram.ridge_points) == 6 * 300
    whole = Voronoi(copies(points, (0.3, 1.1)))
    assert np.allclose(diagram.cell_areas, whole.cell_areas[:300])
    assert np.allclose(diagram.cell_centroids, whole.cell_centroids[:300])
    assert np.allclose(diagram.cell_perimeters, whole.cell_perimeters[:300])
    assert len(indptr) == 301 and (lengths > 0).all()


def test_a_grid_has_squares_for_cells() -> None:
    grid = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), axis=-1).reshape(-1, 2)
    diagram = Voronoi(grid, periodic=(6, 5))
    assert diagram.cell_areas.tolist() == [1.0] * 30
    assert len(diagram.ridge_points) == 60
    assert [len(region) for region in diagram.regions] == [4] * 30
    assert repr(diagram).endswith("60 ridges, periodic>")


def test_duplicates_share_their_cell() -> None:
    diagram = Voronoi([(0, 0), (0.5, 0.5), (0, 0)], periodic=(1, 1))
    assert diagram.cell_areas.tolist() == [0.5] * 3
    assert diagram.duplicate_of.tolist() == [0, 1, 0]
    assert len(diagram.rays.ridge) == 0


def test_it_can_be_drawn_and_tabled() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    shapely = pytest.importorskip("shapely")
    diagram = Voronoi(np.random.default_rng(2).random((50, 2)), periodic=(1, 1))
    assert len(diagram.plot().collections[0].get_paths()) == 50
    assert shapely.is_valid(diagram.polygons()).all()


def test_what_does_not_go_together_is_refused() -> None:
    points = [(0, 0), (0.5, 0.25)]
    with pytest.raises(InputError, match="neither clip nor weights"):
        Voronoi(points, periodic=(1, 1), clip="box")
    with pytest.raises(InputError, match="neither clip nor weights"):
        Voronoi(points, periodic=(1, 1), weights=[1, 2])
    with pytest.raises(InputError, match="a period in x and in y"):
        Voronoi(points, periodic=(1, None))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="apart in x"):
        Voronoi(points, periodic=(0.5, 1))
