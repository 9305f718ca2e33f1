"""Road networks whose segments come, go and move: each state is that of a new triangulation."""

from __future__ import annotations

import numpy as np
import pytest

import delone
from delone import ConstrainedDelaunay, Dynamic
from tiers import seeds


class Network:
    """Roads as segments between handles, and what is left of the input."""

    def __init__(self, seed: int) -> None:
        self.draw = np.random.default_rng(seed)
        points, ends = self._streets()
        self.live = Dynamic(points, crossing="split")
        self.live.insert_segments(ends)

    def _streets(self) -> tuple[list[tuple[float, float]], list[tuple[int, int]]]:
        """Blocks, alleys that end on a street, roads across, and doubled lanes."""
        draw = self.draw
        points: list[tuple[float, float]] = []
        ends: list[tuple[int, int]] = []
        turn = draw.uniform(0, np.pi) if draw.random() < 0.5 else 0.0
        shift = draw.choice([0.0, 500_000.0])
        cos, sin = np.cos(turn), np.sin(turn)

        def at(x: float, y: float) -> int:
            points.append((cos * x - sin * y + shift, sin * x + cos * y + shift))
            return len(points) - 1

        size = int(draw.integers(2, 5))
        for k in range(size):
            ends.append((at(0, 10 * k), at(10 * (size - 1), 10 * k)))
            if draw.random() < 0.7:
                ends.append((at(10 * k, 0), at(10 * k, 10 * (size - 1))))
        for _ in range(int(draw.integers(1, 5))):
            # An alley whose end is on a street up to rounding, another near to it.
            street = ends[int(draw.integers(len(ends)))]
            a, b = (np.array(points[row]) for row in street)
            share = draw.integers(1, 8) / 8 if draw.random() < 0.5 else draw.random()
            place = a + share * (b - a)
            points.append((float(place[0]), float(place[1])))
            away = place + draw.normal(0, 6, 2)
            points.append((float(away[0]), float(away[1])))
            ends.append((len(points) - 2, len(points) - 1))
        for _ in range(int(draw.integers(1, 4))):
            # A road across, and sometimes a lane beside it, which has an end with it in common.
            a, b = at(*draw.uniform(-5, 35, 2)), at(*draw.uniform(-5, 35, 2))
            ends.append((a, b))
            if draw.random() < 0.5:
                x, y = points[b]
                points.append((x + draw.choice([1e-9, 0.5]), y))
                ends.append((a, len(points) - 1))
        # The same place again, as data sets have it.
        points.append(points[int(draw.integers(len(points)))])
        return points, ends

    def edit(self) -> None:
        """Change something."""
        live, draw = self.live, self.draw
        segments = live.segment_handles
        crossed = live.crossings[:, 2] if len(segments) else np.empty(0, dtype=np.int64)
        own = np.setdiff1d(live.handles, crossed)
        free = np.setdiff1d(own, live.input_segments)
        kind = draw.integers(6)
        if kind == 0 and len(segments) > 1:
            live.remove_segments(draw.choice(segments, min(2, len(segments)), replace=False))
        elif kind == 1 and len(segments):
            # An end of a road moves, a little or across others.
            end = int(draw.choice(live.input_segments.ravel()))
            place = live.points[live.rows_of([end])[0]]
            live.move([end], [place + draw.normal(0, draw.choice([0.1, 8.0]), 2)])
        elif kind == 2 and len(own) > 1:
            live.insert_segments([draw.choice(own, 2, replace=False)])
        elif kind == 3 and len(segments):
            # A point on a road.
            a, b = live.points[live.rows_of(live.input_segments[0])]
            live.insert([a + draw.integers(1, 4) / 4 * (b - a)])
        elif kind == 4 and len(free):
            live.remove(draw.choice(free, 1))
        elif len(segments):
            live.remove(draw.choice(live.input_segments.ravel(), 1), segments="remove")

    def check(self) -> None:
        """Compare with a new triangulation of what is left."""
        live = self.live
        crossings, segments = live.crossings, live.segment_handles
        assert np.isin(crossings[:, 2], live.handles).all()
        assert np.isin(crossings[:, :2], segments).all()
        if not live.nsimplex:
            return
        added = np.setdiff1d(crossings[:, 2], live.input_segments)
        kept = live.handles[~np.isin(live.handles, live._plane().segments().added)]
        assert set(live.handles.tolist()) - set(kept.tolist()) <= set(added.tolist())
        rows = np.searchsorted(kept, live.input_segments)
        fresh = ConstrainedDelaunay(
            live.points[live.rows_of(kept)], rows, crossing="split", planar=True
        )
        assert len(fresh.points) == len(live)
        assert placed(fresh.points, fresh.simplices) == placed(live.points, live.simplices)
        assert placed(fresh.points, fresh.segments) == placed(live.points, live.segments)
        one = fresh.report.crossings
        ours = np.column_stack(
            (np.searchsorted(segments, crossings[:, :2]), live.rows_of(crossings[:, 2]))
        )
        assert met(fresh.points, one) == met(live.points, ours)
        assert live.validate()


def placed(points: np.ndarray, rows: np.ndarray) -> set[tuple[tuple[float, ...], ...]]:
    """Simplices as places, in ascending order each."""
    return {tuple(sorted(map(tuple, each))) for each in points[rows].tolist()}


def met(points: np.ndarray, crossings: np.ndarray) -> set[tuple[int, int, float, float]]:
    """Pairs of segments and the places where they cross."""
    return {(min(a, b), max(a, b), *points[row].tolist()) for a, b, row in crossings.tolist()}


@pytest.mark.parametrize("seed", seeds(40, deep=1500))
def test_each_state_is_that_of_a_new_triangulation(seed: int) -> None:
    network = Network(seed)
    network.check()
    for _ in range(7):
        try:
            network.edit()
        except delone.BudgetExceededError:
            continue
        network.check()
