"""Power diagrams: least powers, tiling, hidden sites, and what is left of them without weights."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone.errors import DegenerateInputError, NonFiniteError, ShapeError
from delone.voronoi import Voronoi
from rational import area, exact
from tiers import examples


def weighted(n: int, spread: float, seed: int = 0) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    return rng.random((n, 2)), rng.random(n) * spread


@pytest.mark.parametrize("spread", [1e-4, 0.05, 0.5])
def test_a_random_query_is_in_the_cell_with_the_least_power(spread: float) -> None:
    points, weights = weighted(300, spread)
    diagram = Voronoi(points, weights=weights, clip=(-1, -1, 2, 2))
    queries = np.random.default_rng(1).random((300, 2)) * 3 - 1
    power = ((queries[:, None] - points) ** 2).sum(axis=2) - weights
    for query, site in zip(queries, power.argmin(axis=1), strict=True):
        assert site not in diagram.hidden
        ring = diagram.cell(int(site)).parts[0][0]
        along, towards = np.roll(ring, -1, axis=0) - ring, query - ring
        assert (along[:, 0] * towards[:, 1] - along[:, 1] * towards[:, 0] > -1e-12).all()


@settings(max_examples=examples(30, deep=300), deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(-4, 9)),
        min_size=1,
        max_size=14,
    )
)
def test_cells_tile_a_box_exactly(sites: list[tuple[int, int, int]]) -> None:
    table = np.array(sites, dtype=float)
    diagram = Voronoi(table[:, :2], weights=table[:, 2], clip=(-2, -3, 6, 7))
    rows = np.setdiff1d(np.unique(diagram.duplicate_of), diagram.hidden)
    rings = [part[0] for row in rows for part in diagram.cell(int(row)).parts]
    assert sum(area(exact(ring)) for ring in rings) == 80
    assert diagram.cell_areas[rows].sum() == pytest.approx(80)
    # The least power at the centroid of what is left of a cell is that of its site.
    for row in rows[diagram.cell_areas[rows] > 1e-9]:
        power = ((table[:, :2] - diagram.cell_centroids[row]) ** 2).sum(axis=1) - table[:, 2]
        assert power[row] == pytest.approx(power.min(), abs=1e-9)


def test_vertices_have_equal_power_to_their_sites() -> None:
    points, weights = weighted(300, 0.01, seed=2)
    diagram = Voronoi(points, weights=weights)
    mesh = diagram.triangulation
    assert mesh is not None
    near = np.abs(diagram.vertices[diagram.simplex_vertices]).max(axis=1) < 10
    at = diagram.vertices[diagram.simplex_vertices][near]
    corners = mesh.simplices[near]
    power = ((at[:, None] - points[corners]) ** 2).sum(axis=2) - weights[corners]
    assert np.allclose(power, power[:, :1], rtol=0, atol=1e-12)


def test_equal_weights_change_nothing() -> None:
    points, _ = weighted(200, 1.0, seed=3)
    plain, heavy = Voronoi(points), Voronoi(points, weights=np.full(200, 2.5))
    assert np.allclose(sorted(plain.vertices.tolist()), sorted(heavy.vertices.tolist()))
    pairs = [{frozenset(p) for p in d.ridge_points.tolist()} for d in (plain, heavy)]
    assert pairs[0] == pairs[1]
    assert len(plain.hidden) == len(heavy.hidden) == 0


def test_a_hidden_site_has_no_cell() -> None:
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]
    diagram = Voronoi(points, weights=[0, 0, 0, 0, -8], clip=(0, 0, 4, 4))
    assert diagram.hidden.tolist() == [4]
    assert diagram.point_region[4] == -1
    assert diagram.cell_areas.tolist() == [4.0, 4.0, 4.0, 4.0, 0.0]
    assert np.isnan(diagram.cell_centroids[4]).all()
    cell = diagram.cell(4)
    assert (cell.site, cell.parts, len(cell.neighbors), cell.area) == (4, (), 0, 0.0)
    shapely = pytest.importorskip("shapely")
    assert shapely.is_empty(diagram.polygons()).tolist() == [False] * 4 + [True]


def test_sites_in_line_and_alone() -> None:
    line = [(0, 0), (1, 0), (2, 0), (6, 0)]
    diagram = Voronoi(line, weights=[0, -9, 0, 8], clip=(-1, -1, 7, 1))
    assert diagram.hidden.tolist() == [1]
    # The axis between 2 and 6 lies where x * x - ... are equal: at 4 - 8 / (2 * 4) = 3.
    assert diagram.cell_areas.tolist() == [4.0, 0.0, 4.0, 8.0]
    _ridge, origin, _ = diagram.rays
    assert origin[::2].tolist() == [[1.0, 0.0], [3.0, 0.0]]
    pair = Voronoi([(0, 0), (0, 0)], weights=[1, 2], clip=(0, 0, 1, 1))
    assert pair.cell_areas.tolist() == [0.0, 1.0]
    twin = Voronoi([(0, 0), (0, 0)], weights=[2, 2], clip=(0, 0, 1, 1))
    assert twin.cell_areas.tolist() == [1.0, 1.0]
    assert twin.duplicate_of.tolist() == [0, 0]


def test_bad_weights_are_refused() -> None:
    with pytest.raises(ShapeError):
        Voronoi([(0, 0), (1, 0)], weights=[1])
    with pytest.raises(NonFiniteError):
        Voronoi([(0, 0), (1, 0)], weights=[1, np.inf])
    with pytest.raises(DegenerateInputError):
        Voronoi(np.empty((0, 2)), weights=[])
