"""Periodic diagrams against plain ones of copies, and laws of the torus."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import PeriodicDelaunay
from delone.errors import InputError, LimitError, NonFiniteError
from delone.voronoi import Voronoi
from tiers import examples


def copies(points: Any, periods: tuple[float, float]) -> Any:
    """The points, and behind them all copies up to two periods away."""
    steps = [(i, j) for i in range(-2, 3) for j in range(-2, 3) if (i, j) != (0, 0)]
    return np.concatenate([points, *(points + np.array(s) * periods for s in steps)])


def corners(diagram: Voronoi, row: int) -> list[list[float]]:
    return sorted(np.round(diagram.cell(row).vertices, 9).tolist())


@settings(max_examples=examples(16, deep=160), deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 5)), min_size=1, max_size=12, unique=True),
    st.sampled_from([(8, 6), (8, 8), (24, 6)]),
)
def test_cells_are_those_of_copies(
    sites: list[tuple[int, int]], periods: tuple[float, float]
) -> None:
    points = np.array(sites, dtype=float)
    diagram = Voronoi(points, periods=periods)
    plain = Voronoi(copies(points, periods))
    for row in range(len(points)):
        assert corners(diagram, row) == corners(plain, row)
        assert diagram.cell_areas[row] == pytest.approx(plain.cell_areas[row])
    assert diagram.cell_areas.sum() == pytest.approx(periods[0] * periods[1])
    # Ridges: each between two sites once, seen from the first one.
    ends = diagram.vertices[np.array(diagram.ridge_vertices)]
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
    diagram = Voronoi(points, periods=(0.3, 1.1))
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
    diagram = Voronoi(grid, periods=(6, 5))
    assert diagram.cell_areas.tolist() == [1.0] * 30
    assert len(diagram.ridge_points) == 60
    assert [len(region) for region in diagram.regions] == [4] * 30
    assert repr(diagram).endswith("60 ridges, periodic>")


def test_duplicates_share_their_cell() -> None:
    diagram = Voronoi([(0, 0), (0.5, 0.5), (0, 0)], periods=(1, 1))
    assert diagram.cell_areas.tolist() == [0.5] * 3
    assert diagram.duplicate_of.tolist() == [0, 1, 0]
    assert len(diagram.rays.ridge) == 0


def test_it_can_be_drawn_and_tabled() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    shapely = pytest.importorskip("shapely")
    diagram = Voronoi(np.random.default_rng(2).random((50, 2)), periods=(1, 1))
    assert len(diagram.plot().collections[0].get_paths()) == 50
    strip = Voronoi(diagram.points, periods=(None, 1))
    assert len(strip.plot().collections[0].get_paths()) == 50
    assert shapely.is_valid(diagram.polygons()).all()


STRIPS = [(8, None), (None, 6), (8.5, None), (None, 30)]


def in_strip(points: Any, weights: Any, periods: Any, box: Any) -> tuple[Any, Any, Any]:
    """A diagram in a strip, the plain one of copies in a wide box, and the period."""
    lengths = np.array([length or 0.0 for length in periods])
    steps = [step for step in range(-2, 3) if step]
    everyone = np.concatenate([points, *(points + step * lengths for step in steps)])
    heavy = None if weights is None else np.tile(weights, 5)
    wide = np.where(np.isfinite(box), box, [-500, -500, 500, 500])
    diagram = Voronoi(points, weights=weights, periods=periods, clip=box)
    return diagram, Voronoi(everyone, weights=heavy, clip=wide), lengths.max()


@settings(max_examples=examples(24, deep=240), deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 7), st.integers(0, 5), st.integers(-3, 6)),
        min_size=1,
        max_size=10,
        unique_by=lambda site: site[:2],
    ),
    st.sampled_from(STRIPS),
    st.booleans(),
)
def test_one_period_makes_strips(
    sites: list[tuple[int, int, int]], periods: Any, heavy: bool
) -> None:
    table = np.array(sites, dtype=float)
    points, weights = table[:, :2], table[:, 2] if heavy else None
    box = (-np.inf, -2, np.inf, 7) if periods[1] is None else (-1, -np.inf, 9, np.inf)
    diagram, plain, width = in_strip(points, weights, periods, box)
    assert diagram.cell_areas.sum() == pytest.approx(width * (9 if periods[1] is None else 10))
    assert diagram.cell_areas == pytest.approx(plain.cell_areas[: len(points)])
    assert diagram.cell_perimeters == pytest.approx(plain.cell_perimeters[: len(points)])
    assert diagram.cell_centroids == pytest.approx(plain.cell_centroids[: len(points)], nan_ok=True)
    for row in range(len(points)):
        found, expected = diagram.cell(row), plain.cell(row)
        assert corners(diagram, row) == corners(plain, row)
        assert found.bounded == expected.bounded
        rings = [sorted(np.round(part[0], 9).tolist()) for part in found.parts]
        assert rings == [sorted(np.round(part[0], 9).tolist()) for part in expected.parts]
        # Neighbours of a cell: with several translates of one site it is one neighbour.
        beside = sorted(zip(np.round(found.sizes, 9), found.neighbors.tolist(), strict=True))
        theirs: dict[int, float] = {}
        for j, length in zip(expected.neighbors % len(points), expected.sizes, strict=True):
            theirs[int(j)] = theirs.get(int(j), 0.0) + float(length)
        total: dict[int, float] = {}
        for length, j in beside:
            total[j] = total.get(j, 0.0) + float(length)
        assert {j: x for j, x in total.items() if x > 1e-9} == pytest.approx(
            {j: x for j, x in theirs.items() if x > 1e-9}, abs=1e-8
        )


@pytest.mark.parametrize("periods", STRIPS)
def test_open_cells_of_a_strip_have_rays_across_it(periods: Any) -> None:
    points = np.random.default_rng(3).integers(0, 6, (12, 2)).astype(float)
    diagram = Voronoi(points, periods=periods)
    ridge, origin, direction = diagram.rays
    axis = 1 if periods[1] is None else 0
    assert len(ridge) > 0 and (np.abs(direction[:, axis]) == 1).all()
    assert (direction[:, 1 - axis] == 0).all()
    lengths = np.array([length or 0.0 for length in periods])
    far = origin + 50 * direction
    a = points[diagram.ridge_points[ridge, 0]]
    b = points[diagram.ridge_points[ridge, 1]] + diagram.ridge_offsets[ridge] * lengths
    assert np.allclose(np.hypot(*(far - a).T), np.hypot(*(far - b).T))
    everyone = np.concatenate([points + k * lengths for k in range(-3, 4)])
    nearest = np.hypot(*(far[:, None] - everyone).T).T.min(axis=1)
    assert np.allclose(nearest, np.hypot(*(far - a).T))


def test_sites_on_a_line_along_the_period_have_strips() -> None:
    diagram = Voronoi([(4, 0), (1, 0), (4, 0)], periods=(8, None), clip=(-np.inf, -1, np.inf, 1))
    assert diagram.triangulation is None
    assert diagram.cell_areas.tolist() == [8.0, 8.0, 8.0]
    assert diagram.duplicate_of.tolist() == [0, 1, 0]
    assert diagram.ridge_points.tolist() == [[1, 0], [0, 1]]
    assert diagram.ridge_offsets.tolist() == [[0, 0], [1, 0]]
    one = Voronoi([(3, 5)], periods=(None, 2), clip=(0, -np.inf, 10, np.inf))
    assert sorted(one.cell(0).parts[0][0].tolist()) == [[0, 4], [0, 6], [10, 4], [10, 6]]
    heavy = Voronoi([(0, 0), (1, 0), (4, 0)], weights=[9, 0, 0], periods=(8, None))
    assert heavy.hidden.tolist() == [1]
    assert heavy.periods == (8.0, None)


@settings(max_examples=examples(16, deep=160), deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 7), st.integers(0, 5), st.integers(-3, 6)),
        min_size=1,
        max_size=10,
        unique_by=lambda site: site[:2],
    ),
    st.sampled_from([(8, 6), (8, 8), (24, 6)]),
)
def test_weights_go_with_periods(sites: list[tuple[int, int, int]], periods: Any) -> None:
    table = np.array(sites, dtype=float)
    points, weights = table[:, :2], table[:, 2]
    diagram = Voronoi(points, weights=weights, periods=periods)
    plain = Voronoi(copies(points, periods), weights=np.tile(weights, 25))
    assert diagram.hidden.tolist() == [row for row in plain.hidden if row < len(points)]
    assert diagram.cell_areas == pytest.approx(plain.cell_areas[: len(points)])
    for row in range(len(points)):
        assert corners(diagram, row) == corners(plain, row)


@pytest.mark.parametrize("seed", range(3))
def test_twice_the_period_has_every_weighted_cell_twice(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, weights = rng.random((500, 2)), rng.random(500) * [1e-5, 1e-3, 0.02][seed]
    one = Voronoi(points, weights=weights, periods=(1, 1))
    both = np.concatenate((points, points + np.array([1.0, 0.0])))
    two = Voronoi(both, weights=np.tile(weights, 2), periods=(2, 1))
    assert two.hidden.tolist() == [*one.hidden, *(one.hidden + 500)]
    assert two.cell_areas == pytest.approx(np.tile(one.cell_areas, 2), rel=1e-9, abs=1e-12)
    assert one.cell_areas.sum() == pytest.approx(1)


def test_equal_weights_change_no_periodic_diagram() -> None:
    points = np.random.default_rng(6).random((200, 2))
    plain, heavy = (
        Voronoi(points, periods=(1, 1)),
        Voronoi(points, periods=(1, 1), weights=np.full(200, 3.5)),
    )
    assert np.array_equal(plain.vertices, heavy.vertices)
    assert np.array_equal(plain.ridge_points, heavy.ridge_points)


def test_of_equal_sites_the_heaviest_has_the_cell() -> None:
    points = [(0, 0), (0.5, 0.5), (0, 0), (0, 0)]
    diagram = Voronoi(points, weights=[0, 0, 0.1, 0.1], periods=(1, 1))
    assert diagram.hidden.tolist() == [0]
    assert diagram.duplicate_of.tolist() == [0, 1, 2, 2]
    assert diagram.cell_areas[2] == diagram.cell_areas[3] > diagram.cell_areas[1] > 0
    with pytest.raises(NonFiniteError):
        Voronoi(points, weights=[0, 0, 0, np.nan], periods=(1, 1))


def test_periods_as_long_as_the_range() -> None:
    period = 1.7e308
    places = [(0.0, 0.0), (period / 2, 0.0), (0.0, period / 2), (period / 4, period / 4)]
    with np.errstate(all="raise"):
        assert PeriodicDelaunay(places, (period, period)).nsimplex == 8
        assert np.isfinite(Voronoi(places, periods=(period, period)).vertices).all()
        for periods in ((period, None), (None, period)):
            with pytest.raises(LimitError, match="beyond the range"):
                Voronoi(places, periods=periods)
        areas = Voronoi(np.array(places) / 8, periods=(period / 8, None)).cell_areas
        assert np.isinf(areas[[0, 1, 2]]).all()
        assert np.isfinite(Voronoi(np.array(places) / 8, periods=(period / 8,) * 2).vertices).all()


def test_vertices_beyond_the_range_are_refused() -> None:
    flat = [(0.0, 0.0), (0.5, 5e-324)]
    with pytest.raises(LimitError, match="beyond the range"):
        Voronoi(flat, periods=(1, None))


def test_what_does_not_go_together_is_refused() -> None:
    points = [(0, 0), (0.5, 0.25)]
    for clip in ("box", (0, 0, 1, 1), object()):
        with pytest.raises(InputError, match="not available with two periods"):
            Voronoi(points, periods=(1, 1), clip=clip)
    shapely = pytest.importorskip("shapely")
    for clip in ("hull", (0, 0, 1, 1), (-np.inf, 0, np.inf), shapely.box(0, 0, 1, 1), 5):
        with pytest.raises(InputError, match=r"'box' or four numbers \(-inf, ymin, inf, ymax\)"):
            Voronoi(points, periods=(1, None), clip=clip)
    with pytest.raises(InputError, match="no area"):
        Voronoi(points, periods=(None, 1), clip=(2, -np.inf, 2, np.inf))
    with pytest.raises(InputError, match="apart in x"):
        Voronoi(points, periods=(0.5, 1))
