"""The nearest site against fractions, rows against lists, and the report of validation."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import Delaunay, Voronoi
from delone.errors import DegenerateInputError, InputError, ShapeError
from delone.voronoi.rows import as_lists, from_the_gap, one_gap
from rational import dot, exact, minus
from tiers import examples


def brute(points: Any, queries: Any) -> list[int]:
    """The nearest rows, the least of equally near ones, in fractions."""
    sites = exact(points)
    found = []
    for q in exact(queries):
        away = [dot(minus(q, p), minus(q, p)) for p in sites]
        found.append(away.index(min(away)))
    return found


coordinates = st.integers(0, 5).map(lambda k: k / 4)


@settings(max_examples=examples(16, deep=160), deadline=None)
@given(st.data())
def test_the_nearest_site_is_that_of_fractions(data: Any) -> None:
    ndim = data.draw(st.sampled_from([2, 3]))
    row = st.tuples(*[coordinates] * ndim)
    points = data.draw(st.lists(row, min_size=1, max_size=9))
    queries = data.draw(st.lists(row, min_size=1, max_size=9))
    try:
        diagram = Voronoi(points)
    except DegenerateInputError:
        assert ndim == 3
        return
    assert diagram.nearest(queries).tolist() == brute(points, queries)


@pytest.mark.parametrize("step", [(1, 0), (3, 7), (0, -1), (2**-540, 2**-541), (2.0**1000, 0)])
@pytest.mark.parametrize("count", [1, 2, 3, 10])
def test_the_nearest_of_sites_on_one_line(step: tuple[float, float], count: int) -> None:
    rng = np.random.default_rng(count)
    places = rng.permutation(np.arange(count, dtype=float) - count // 2)
    points = np.concatenate((places, places[:2]))[:, None] * step
    assert Voronoi(points).triangulation is None
    # On the line and beside it, at ties and one unit in the last place from them.
    ties = (points[:-1] + points[1:]) / 2
    queries = np.concatenate(
        (
            ties,
            np.nextafter(ties, np.inf),
            np.nextafter(ties, -np.inf),
            ties + np.array([-step[1], step[0]]) * 3.0,
            rng.normal(size=(30, 2)) * max(map(abs, step)) * count,
            points,
        )
    )
    diagram = Voronoi(points, clip="box" if (np.ptp(points, axis=0) > 0).all() else None)
    assert diagram.nearest(queries).tolist() == brute(points, queries)


def test_ties_of_far_sites_need_exact_arithmetic() -> None:
    # The bisector of a and b is a double away from where rounding puts it.
    points = np.array([(2.0**53 + 2, 1), (1, 1)])
    query = np.array([2.0**52 + 1.5, 1])
    assert brute(points, query + np.array([(0, 0), (-1, 0), (1, 0)])) == [0, 1, 0]
    for shift in (-1, -0.5, 0, 0.5, 1):
        at = query + np.array([shift, 0])
        assert Voronoi(points).nearest(at) == brute(points, [at])[0]


def test_shapes_and_what_is_not_finite() -> None:
    for points in ([(0, 0), (1, 1), (2, 2)], [(0, 0), (1, 1), (2, 0)]):
        diagram = Voronoi(points)
        assert diagram.nearest((0.9, 1)).shape == ()
        assert diagram.nearest(np.zeros((2, 3, 2))).shape == (2, 3)
        found = diagram.nearest([(np.nan, 0), (0, np.inf), (2, 0.5)])
        assert found.tolist() == [-1, -1, brute(points, [(2, 0.5)])[0]]
        assert found.dtype == np.int32
        assert diagram.nearest(np.empty((0, 2))).tolist() == []
        with pytest.raises(ShapeError):
            diagram.nearest((1, 2, 3))


def test_weights_and_periods_have_no_nearest() -> None:
    for options in ({"weights": [1, 2, 3]}, {"periods": (5, 5)}):
        with pytest.raises(InputError, match="without weights and periods"):
            Voronoi([(0, 0), (1, 1), (2, 0)], **options).nearest((0, 0))  # type: ignore[arg-type]


def test_the_clip_does_not_matter() -> None:
    points = np.random.default_rng(5).random((50, 2))
    queries = np.random.default_rng(6).random((50, 2)) * 3 - 1
    clipped = Voronoi(points, clip=(0.4, 0.4, 0.6, 0.6))
    assert np.array_equal(clipped.nearest(queries), Delaunay(points).nearest(queries))
    assert clipped.nearest(queries).tolist() == brute(points, queries)


@pytest.mark.parametrize(
    "points",
    [
        np.random.default_rng(7).random((60, 2)),
        [(0, 0), (1, 1), (2, 2), (1, 1)],
        [(3, 4)],
        # A vertex beyond the range of doubles.
        [(0, 0), (1, 0), (0.5, 5e-324), (0.5, 1)],
        np.random.default_rng(8).random((60, 3)),
        np.stack(np.meshgrid(*[np.arange(3.0)] * 3), axis=-1).reshape(-1, 3),
    ],
)
def test_rows_are_the_lists(points: Any) -> None:
    diagram = Voronoi(points)
    for lists, rows in (
        (diagram.ridge_vertices, diagram.ridge_rows),
        (diagram.regions, diagram.region_rows),
    ):
        assert as_lists(*rows) == lists
        indptr, indices = rows
        assert indptr.dtype == indices.dtype == np.int32
        assert not indptr.flags.writeable and not indices.flags.writeable
        assert len(indptr) == len(lists) + 1 and indptr[-1] == len(indices)
        for each in lists:
            assert each.count(-1) <= 2
            assert all(v >= 0 or each[i - 1] >= 0 or len(each) < 3 for i, v in enumerate(each))
    assert all(-1 not in ridge[1:] or ridge == [-1, -1] for ridge in diagram.ridge_vertices)
    assert list(diagram.ridge_dict.values()) == diagram.ridge_vertices


def test_the_report_is_that_of_the_triangulation() -> None:
    for ndim in (2, 3):
        diagram = Voronoi(np.random.default_rng(9).random((30, ndim)))
        assert diagram.triangulation is not None
        report: Any = diagram.validate()
        assert report and type(report) is type(diagram.triangulation.validate())  # type: ignore[union-attr]
    line = Voronoi([(0, 0), (1, 1)])
    assert line.triangulation is None
    assert line.validate() and not len(line.validate().missing)


def test_a_wrong_triangulation_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    diagram = Voronoi([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])
    wrong = Delaunay._from_arrays(
        {
            "points": np.array([(0.0, 0), (4, 0), (4, 3), (1, 1)]),
            "simplices": np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32),
            "neighbors": np.array([(-1, 1, -1), (-1, -1, 0)], dtype=np.int32),
            "duplicates": np.empty((0, 2), dtype=np.int32),
        }
    )
    object.__setattr__(diagram._cells, "mesh", wrong)
    assert not diagram.validate()


def test_workers_are_those_given() -> None:
    assert Voronoi([(0, 0)]).workers is None
    assert Voronoi(np.random.default_rng(0).random((9, 3)), workers=2).workers == 2
    for bad in (0, 1.5, True):
        with pytest.raises(InputError):
            Voronoi([(0, 0)], workers=bad)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("scale", "share"), [(1.0, 1e-16), (2.0**600, 1e-16), (2.0**-530, 2.0**-14)]
)
def test_points_near_bisectors_are_compared_exactly(scale: float, share: float) -> None:
    # Products are rounded by more than these points are away from the bisector; the small ones are
    # subnormal.
    rng = np.random.default_rng(10)
    for _ in range(100):
        points = rng.random((2, 2)) * scale
        step = points[1] - points[0]
        far = rng.normal(size=(20, 1)) * 3 * np.array([-step[1], step[0]])
        queries = points.mean(axis=0) + far + rng.normal(size=(20, 2)) * share * np.abs(far)
        assert Voronoi(points).nearest(queries).tolist() == brute(points, queries)


def one_gap_by_one(region: list[int]) -> list[int]:
    kept = [v for i, v in enumerate(region) if v >= 0 or region[i - 1] >= 0]
    return kept or region[:1]


def from_the_gap_by_one(ridge: list[int]) -> list[int]:
    gap = next((i for i, v in enumerate(ridge) if v < 0), None)
    if gap is None:
        return ridge
    return [-1, *(v for v in ridge[gap:] + ridge[:gap] if v >= 0)]


@given(st.lists(st.lists(st.integers(-1, 3), max_size=6), max_size=6))
def test_gaps_of_rows_are_those_of_lists(lists: list[list[int]]) -> None:
    starts = np.cumsum([0, *map(len, lists)]).astype(np.int32)
    entries = np.array([v for each in lists for v in each], dtype=np.int32)
    assert as_lists(*one_gap(starts, entries)) == [one_gap_by_one(each) for each in lists]
    turned = as_lists(*from_the_gap(starts, entries))
    assert turned == [from_the_gap_by_one(each) for each in lists]


def test_strips_and_the_whole_plane_have_one_gap() -> None:
    assert Voronoi([(0, 0), (2, 2), (1, 1)]).regions == [[-1]] * 3
    assert Voronoi([(1, 1)]).regions == [[]]
