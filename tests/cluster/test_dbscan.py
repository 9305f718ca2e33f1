"""DBSCAN against its definition, in fractions, and against scikit-learn."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
import sklearn.cluster

import density
from clustered import SMALL, partition
from delone.cluster import DBSCAN, single_linkage


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("samples", [1, 2, 3, 5, 9])
@pytest.mark.sampled(15)
def test_the_clusters_are_those_of_the_definition(name: str, samples: int) -> None:
    points = np.random.default_rng(3).permutation(SMALL[name])
    exact = [tuple(map(Fraction, row)) for row in points.tolist()]
    heights = np.unique(single_linkage(points).linkage[:, 2])
    # Around the distances of the points, where ties are.
    chosen = [0.0, *heights[:: max(1, len(heights) // 5)], 1.5 * heights[-1], 4 * heights[-1]]
    limits = {
        side for eps in chosen for side in (eps, np.nextafter(eps, 0), np.nextafter(eps, 1e308))
    }
    for eps in limits:
        core, homes = density.dbscan(exact, Fraction(eps), samples)
        model = DBSCAN(eps, min_samples=samples, workers=2).fit(points)
        assert set(model.core_sample_indices_.tolist()) == core
        assert np.array_equal(model.components_, points[sorted(core)])
        assert set(np.flatnonzero(model.labels_ >= 0).tolist()) == set(homes)
        clusters = {home: {row for row in homes if homes[row] == home} for home in homes.values()}
        assert partition(model.labels_) == {frozenset(rows) for rows in clusters.values()}


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("seed", range(5))
def test_core_points_are_those_of_scikit_learn(d: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    points = np.concatenate(
        [random.normal(random.random(d), s, (400, d)) for s in (0.02, 0.1, 0.2)]
    )
    for eps, samples in ((0.005, 2), (0.03, 4), (0.1, 20), (0.3, 100), (5, 3)):
        model = DBSCAN(eps, min_samples=samples).fit(points)
        peer = sklearn.cluster.DBSCAN(eps=eps, min_samples=samples).fit(points)
        core = model.core_sample_indices_
        assert np.array_equal(core, peer.core_sample_indices_)
        both = set(zip(model.labels_[core].tolist(), peer.labels_[core].tolist(), strict=True))
        assert len(both) == len({one for one, _ in both}) == len({other for _, other in both})
        assert np.array_equal(model.labels_ < 0, peer.labels_ < 0)


def test_a_border_point_belongs_to_the_nearest_core_point() -> None:
    left, right = [(0, 0), (-1, 0), (0, 1), (0, -1)], [(2, 0), (3, 0), (2, 1), (2, -1)]
    # Both centers are core points, and within the distance of the point between them.
    for x, is_left in ((0.95, True), (1, True), (1.05, False)):
        model = DBSCAN(1.1, min_samples=4).fit([*right, *left, (x, 0)])
        assert model.core_sample_indices_.tolist() == [0, 4]
        assert model.labels_.tolist() == [0] * 4 + [1] * 4 + [int(is_left)]


def test_the_distance_is_used_as_it_is() -> None:
    # 0.1 + 0.2 is more than 0.3, and sqrt(2) squared is more than 2.
    assert DBSCAN(0.3, min_samples=2).fit_predict([(0, 0), (0.1 + 0.2, 0)]).tolist() == [-1, -1]
    assert DBSCAN(0.1 + 0.2, min_samples=2).fit_predict([(0, 0), (0.1 + 0.2, 0)]).tolist() == [0, 0]
    diagonal = [(0, 0), (1, 1)]
    assert DBSCAN(np.sqrt(2), min_samples=2).fit_predict(diagonal).tolist() == [0, 0]
    below = np.nextafter(np.sqrt(2), 0)
    assert DBSCAN(below, min_samples=2).fit_predict(diagonal).tolist() == [-1, -1]


def test_duplicates_count() -> None:
    points = [(0, 0), (5, 5), (0, 0), (0, 0), (9, 9), (5, 5)]
    assert DBSCAN(0, min_samples=3).fit_predict(points).tolist() == [0, -1, 0, 0, -1, -1]
    assert DBSCAN(0, min_samples=1).fit_predict(points).tolist() == [0, 1, 0, 0, 2, 1]
    assert DBSCAN(np.inf, min_samples=6).fit_predict(points).tolist() == [0] * 6
    assert DBSCAN(np.inf, min_samples=7).fit_predict(points).tolist() == [-1] * 6


@pytest.mark.parametrize("d", [2, 3])
def test_few_points(d: int) -> None:
    assert DBSCAN(1).fit_predict(np.empty((0, d))).tolist() == []
    assert DBSCAN(1).fit_predict(np.zeros((1, d))).tolist() == [-1]
    assert DBSCAN(1, min_samples=1).fit_predict(np.zeros((1, d))).tolist() == [0]
    assert DBSCAN(1, min_samples=10**30).fit_predict(np.zeros((3, d))).tolist() == [-1] * 3


def test_dense_sets_are_not_compared_pair_by_pair() -> None:
    # All 2 * 10^10 pairs are within the distance.
    points = np.random.default_rng(0).random((200_000, 2))
    model = DBSCAN(2, min_samples=200_000).fit(points)
    assert len(model.core_sample_indices_) == 200_000
    assert (model.labels_ == 0).all()
