"""`snap`: which points are merged with which, judged by loops over all pairs."""

from math import hypot

import numpy as np
import pytest

from delone import BudgetExceededError, ConflictingValuesError, InputError
from delone.terrain import TIN
from delone.terrain.merging import merged, near_segments, onto

LIMIT = 0.3


def clusters(seed, count=300):
    random = np.random.default_rng(seed)
    xy = random.random((count, 2)) * 8
    # Some on a lattice, so that distances are equal, and some twice.
    xy[::3] = np.round(xy[::3] * 4) / 4
    xy[5::40] = xy[4::40][: len(xy[5::40])]
    return xy


def greedy(places, order, limit, fixed):
    """The rule, in its words: in order, each is kept unless it is near one that is kept."""
    kept = [k for k in range(len(places)) if fixed[k]]
    for k in np.argsort(order):
        if not fixed[k] and all(hypot(*(places[k] - places[j])) >= limit for j in kept):
            kept.append(k)
    found = places.copy()
    for k in set(range(len(places))) - set(kept):
        best = min(kept, key=lambda j: (hypot(*(places[k] - places[j])), order[j]))
        found[k] = places[best]
    return found


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("some_fixed", [False, True])
def test_points_are_merged_by_the_rule(seed, some_fixed):
    places = clusters(seed)
    order = np.empty(len(places), dtype=np.int64)
    order[np.lexsort(places.T[::-1])] = np.arange(len(places))
    fixed = np.random.default_rng(seed).random(len(places)) < 0.1 * some_fixed
    found = merged(places, order, LIMIT, fixed)
    assert np.array_equal(found.places, greedy(places, order, LIMIT, fixed))
    assert np.array_equal(found.moved, (found.places != places).any(axis=1))
    left = np.unique(found.places[~fixed], axis=0)
    apart = np.hypot(*(left[:, None] - left[None]).transpose(2, 0, 1))
    assert some_fixed or apart[apart > 0].min() >= LIMIT


@pytest.mark.parametrize("seed", range(4))
def test_points_move_to_the_nearest_target(seed):
    places, targets = clusters(seed), np.unique(clusters(seed + 10, 60), axis=0)
    found = onto(places, targets, LIMIT)
    away = np.hypot(*(places[:, None] - targets[None]).transpose(2, 0, 1))
    near = away.min(axis=1) < LIMIT
    assert np.array_equal(found.moved, near)
    assert np.array_equal(found.places[~near], places[~near])
    # Targets are in the order of coordinates, and argmin takes the first.
    assert np.array_equal(found.places[near], targets[away.argmin(axis=1)][near])


@pytest.mark.parametrize("seed", range(4))
def test_points_beside_segments_are_found(seed):
    random = np.random.default_rng(seed)
    places = clusters(seed)
    ends = random.random((25, 2, 2)) * 8
    ends[::5, 1] = ends[::5, 0] + 0.01
    row, segment, share, distance = near_segments(places, ends, LIMIT)
    expected = {}
    for k, place in enumerate(places):
        for j, (a, b) in enumerate(ends):
            along = b - a
            t = (place - a) @ along / (along @ along)
            d = abs((place - a)[0] * along[1] - (place - a)[1] * along[0]) / hypot(*along)
            if 0 < t < 1 and d < LIMIT and d < expected.get(k, (9,))[0]:
                expected[k] = d, j, t
    assert row.tolist() == sorted(expected)
    assert len(row) > 30
    for k, j, t, d in zip(row.tolist(), segment.tolist(), share, distance, strict=True):
        assert (j, t, d) == (expected[k][1], pytest.approx(expected[k][2]), expected[k][0])


def test_the_order_of_rows_changes_nothing():
    random = np.random.default_rng(1)
    points = np.column_stack((clusters(2), random.random(300)))
    lines = [np.column_stack((random.random((5, 2)) * 8, random.random(5))) for _ in range(4)]
    options = {"snap": LIMIT, "duplicates": "max", "crossing": "max"}
    one = TIN.from_points(points, breaklines=lines, **options)
    shuffled = points[random.permutation(300)]
    two = TIN.from_points(shuffled, breaklines=[line[::-1] for line in lines[::-1]], **options)
    for tin in (one, two):
        assert tin.adjustments.points_moved > 30
        assert 0.2 < tin.adjustments.largest_move < LIMIT
    assert vars(one.adjustments) | {"levels": 0} == vars(two.adjustments) | {"levels": 0}
    rows = [tin.xyz[np.lexsort(tin.xyz.T)] for tin in (one, two)]
    assert np.array_equal(*rows)


SQUARE = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]


def test_points_become_part_of_lines():
    line = [(2, 5, 1), (8, 5, 1)]
    # The second is beside the line, too, but near its end.
    points = [*SQUARE, (5, 5.01, 1), (2.003, 5.005, 1), (5, 5.5, 0)]
    tin = TIN.from_points(points, breaklines=[line], snap=0.02)
    changes = tin.adjustments
    assert (changes.points_moved, changes.line_points_moved) == (2, 0)
    assert changes.largest_move == pytest.approx(0.01)
    assert tin.npoints == 4 + 1 + 2
    assert len(tin.breaklines) == 1
    assert TIN.from_points(points, breaklines=[line]).npoints == 4 + 3 + 2


def test_other_heights_beside_a_line_are_contradictions():
    line = [(2, 5, 1), (8, 5, 1)]
    points = [*SQUARE, (5, 5.01, 4), (6, 5.01, 1.5)]
    with pytest.raises(ConflictingValuesError, match=r"at 2 places: \(5, 5.01\): 1 to 4") as caught:
        TIN.from_points(points, breaklines=[line], snap=0.02)
    assert caught.value.rows[:, 0].tolist() == [4, 5]
    for policy, z in (("min", 1), ("max", 4), ("mean", 2.5)):
        tin = TIN.from_points(points, breaklines=[line], snap=0.02, duplicates=policy, tolerance=1)
        assert tin.heights([(5, 5), (6, 5)])[0] == z
        assert len(tin.breaklines) == 2
    tin = TIN.from_points(points, breaklines=[line], snap=0.02, tolerance=5)
    assert (tin.heights([(5, 5), (6, 5)]) == 1).all()


def test_lines_without_heights_take_the_points_beside_them():
    line = np.array([(2.0, 5), (8, 5)])
    points = [*SQUARE, (5, 5.01, 4)]
    tin = TIN.from_points(points, breaklines=[line], snap=0.02)
    assert tin.heights((5, 5)) == pytest.approx(4, abs=0.01)
    assert tin.npoints < TIN.from_points(points, breaklines=[line]).npoints
    assert tin.validate()


def test_ends_of_lines_meet_and_boundaries_stay():
    lines = [[(1, 1, 0), (5, 5, 0)], [(5.01, 5, 0), (9, 1, 0)]]
    tin = TIN.from_points(SQUARE, breaklines=lines, snap=0.05)
    assert tin.adjustments.line_points_moved == 1
    # The first in the order of x and y is kept.
    assert (5.01, 5.0) not in set(map(tuple, tin.points.tolist()))
    assert tin.npoints == 7
    other = [[(1, 1, 0), (5, 5, 0)], [(5.01, 5, 3), (9, 1, 0)]]
    with pytest.raises(ConflictingValuesError, match="lines have different heights"):
        TIN.from_points(SQUARE, breaklines=other, snap=0.05)
    fence = [(0.01, 0.01), (9.99, 0.01), (9.99, 9.99), (0.01, 9.99)]
    tin = TIN.from_points(SQUARE, breaklines=[[(5, 0.02, 0), (5, 5, 0)]], boundary=fence, snap=0.1)
    assert set(fence) <= set(map(tuple, tin.points.tolist()))
    assert tin.adjustments.points_moved == 4


def test_points_alone():
    points = [*SQUARE, (5, 5, 1), (5.001, 5, 1), (5.001, 5.001, 1)]
    tin = TIN.from_points(points, snap=0.01)
    assert tin.npoints == 5
    assert tin.heights((5, 5)) == 1
    assert tin.adjustments.points_moved == 2
    assert tin.adjustments.largest_move == pytest.approx(hypot(0.001, 0.001))
    assert TIN.from_points(points).adjustments is None
    # Exactly as far is not nearer.
    assert TIN.from_points([*SQUARE, (5, 5, 0), (5.5, 5, 0)], snap=0.5).npoints == 6
    with pytest.raises(ConflictingValuesError) as caught:
        TIN.from_points([*SQUARE, (5, 5, 1), (5.001, 5, 2)], snap=0.01)
    assert caught.value.rows.tolist() == [[5, 4]]


def test_bad_distances():
    for bad in (-1, np.nan, np.inf):
        with pytest.raises(InputError, match="snap must be at least 0"):
            TIN.from_points(SQUARE, snap=bad)
    many = np.random.default_rng(0).random((20_000, 3)) * [1, 1, 0]
    with pytest.raises(BudgetExceededError, match="simplify"):
        TIN.from_points(many, snap=0.9)


def test_a_large_survey_keeps_most_points():
    points = np.random.default_rng(0).random((100_000, 3)) * [1000, 1000, 0]
    tin = TIN.from_points(points, snap=0.5)
    assert tin.npoints == 100_000 - tin.adjustments.points_moved
    assert 2000 < tin.adjustments.points_moved < 10_000


@pytest.mark.parametrize("y", [5.02, 5.0, 4.98])
def test_ends_meet_the_sides_of_other_lines(y):
    """An end that nearly reaches a line, or is a little beyond it, is on it."""
    lines = [[(2, 5, 0), (8, 5, 6)], [(5, y, 3), (5, 9, 3)]]
    tin = TIN.from_points(SQUARE, breaklines=lines, snap=0.05)
    assert tin.npoints == 8 and tin.heights((5, 5)) == 3
    assert tin.adjustments.line_points_moved == (y != 5)
    assert tin.adjustments.largest_move == pytest.approx(abs(y - 5))
    sides = {frozenset(map(tuple, tin.points[row].tolist())) for row in tin.breaklines}
    assert sides == {
        frozenset({(5.0, 5.0), other}) for other in ((2.0, 5.0), (8.0, 5.0), (5.0, 9.0))
    }


def test_ends_that_are_too_high_or_far():
    high = [[(2, 5, 0), (8, 5, 6)], [(5, 5.02, 4), (5, 9, 3)]]
    with pytest.raises(ConflictingValuesError, match="lines have different heights"):
        TIN.from_points(SQUARE, breaklines=high, snap=0.05)
    tin = TIN.from_points(SQUARE, breaklines=high, snap=0.05, tolerance=2)
    assert tin.heights((5, 5)) == 4
    tin = TIN.from_points(SQUARE, breaklines=high, snap=0.01)
    assert tin.adjustments.line_points_moved == 0 and tin.npoints == 8
    # Lines without heights take those of the others.
    bare = [[(2, 5, 0), (8, 5, 6)], [(5, 5.02), (5, 9)]]
    tin = TIN.from_points(SQUARE, breaklines=bare, snap=0.05)
    assert tin.heights((5, 5)) == pytest.approx(3) and tin.npoints == 8
    # Rings have no ends, and corners of lines are not ends.
    bend = [[(2, 5, 0), (8, 5, 0)], [(3, 8, 0), (5, 5.02, 0), (7, 8, 0)]]
    assert TIN.from_points(SQUARE, breaklines=bend, snap=0.05).adjustments.line_points_moved == 0
