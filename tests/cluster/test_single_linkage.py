"""Single linkage against SciPy and against its definition, in fractions."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from scipy.cluster import hierarchy

import density
from clustered import LARGE, SMALL, partition
from delone import Delaunay
from delone.cluster import single_linkage
from delone.errors import DtypeError, InputError, NonFiniteError, ShapeError


@pytest.mark.parametrize("name", SMALL)
def test_labels_are_components_of_short_distances(name: str) -> None:
    points = np.random.default_rng(3).permutation(SMALL[name])
    exact = [tuple(map(density.Fraction, row)) for row in points.tolist()]
    weights = density.distances(exact)
    found = single_linkage(points)
    limits = {*found.linkage[:, 2], 0.0}
    limits |= {float(np.nextafter(limit, side)) for limit in limits for side in (0, np.inf)}
    for limit in limits:
        expected = density.at_most(weights, range(len(points)), density.Fraction(limit) ** 2)
        assert partition(found.labels(height=limit)) == expected


@pytest.mark.parametrize("name", SMALL)
def test_merges_are_consistent(name: str) -> None:
    points = SMALL[name]
    n = len(points)
    found = single_linkage(points, workers=2)
    merges = found.linkage
    assert merges.shape == (n - 1, 4)
    assert (np.diff(merges[:, 2]) >= 0).all()
    assert (merges[:, 0] < merges[:, 1]).all()
    clusters = {i: frozenset([i]) for i in range(n)}
    for i, (one, other, _, size) in enumerate(merges.tolist()):
        clusters[n + i] = clusters.pop(int(one)) | clusters.pop(int(other))
        assert len(clusters[n + i]) == size
        labels = found.labels(n_clusters=n - 1 - i)
        assert partition(labels) == set(clusters.values())
    assert partition(found.labels(n_clusters=n)) == {frozenset([i]) for i in range(n)}


@pytest.mark.parametrize("d", [2, 3])
def test_without_ties_it_is_the_linkage_of_scipy(d: int) -> None:
    points = np.random.default_rng(d).random((700, d))
    expected = hierarchy.linkage(points, "single")
    found = single_linkage(points).linkage
    assert np.allclose(found, expected, rtol=1e-14)
    assert hierarchy.is_valid_linkage(found, throw=True)
    drawn, peer = (hierarchy.dendrogram(merges, no_plot=True) for merges in (found, expected))
    assert drawn["leaves"] == peer["leaves"]
    assert np.allclose(drawn["dcoord"], peer["dcoord"])


@pytest.mark.parametrize("name", LARGE)
def test_rows_and_units_do_not_matter(name: str) -> None:
    points = LARGE[name]
    order = np.random.default_rng(0).permutation(len(points))
    one, other = (
        single_linkage(points, workers=1),
        single_linkage(points[order] * 2.0**70, workers=3),
    )
    assert np.array_equal(one.linkage[:, 2:] * (2.0**70, 1), other.linkage[:, 2:])
    for count in (2, 40, len(points) // 2):
        labels = np.empty(len(points), dtype=np.int32)
        labels[order] = other.labels(n_clusters=count)
        first = {frozenset(np.flatnonzero(labels == k)) for k in range(count)}
        assert first == partition(one.labels(n_clusters=count))


def test_equal_distances_are_equal_doubles() -> None:
    # 65 = 1 + 64 = 16 + 49.
    found = single_linkage([(0, 0), (1, 8), (100, 0), (107, 4)])
    assert found.linkage[0, 2] == found.linkage[1, 2] == np.sqrt(65)
    assert found.labels(height=np.sqrt(65)).tolist() == [0, 1, 2, 3]
    assert found.labels(height=np.nextafter(np.sqrt(65), 9)).tolist() == [0, 0, 1, 1]


@pytest.mark.parametrize("d", [2, 3])
def test_few_points_have_few_merges(d: int) -> None:
    none, one = single_linkage(np.empty((0, d))), single_linkage(np.zeros((1, d)))
    assert none.linkage.shape == one.linkage.shape == (0, 4)
    assert none.labels(height=1).tolist() == none.labels(n_clusters=0).tolist() == []
    assert one.labels(height=0).tolist() == one.labels(n_clusters=1).tolist() == [0]
    same = single_linkage(np.ones((4, d)))
    assert same.linkage.tolist() == [[0, 1, 0, 2], [2, 4, 0, 3], [3, 5, 0, 4]]


def test_a_triangulation_is_used_and_results_can_be_pickled() -> None:
    mesh = Delaunay(np.random.default_rng(0).random((50, 2)))
    found = single_linkage(mesh)
    assert np.shares_memory(found.points, mesh.points)
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.linkage, found.linkage)
    assert not found.linkage.flags.writeable
    with pytest.raises(AttributeError):
        found.linkage = 3  # type: ignore[misc]


def test_wrong_arguments_are_refused() -> None:
    found = single_linkage([(0, 0), (1, 0), (5, 0)])
    for options in ({}, {"height": 1, "n_clusters": 2}, {"height": -1}, {"height": np.nan}):
        with pytest.raises(InputError):
            found.labels(**options)  # type: ignore[arg-type]
    for count in (0, 4):
        with pytest.raises(InputError, match="from 1 to the 3 points"):
            found.labels(n_clusters=count)
    with pytest.raises(DtypeError):
        found.labels(n_clusters=1.5)  # type: ignore[arg-type]
    with pytest.raises(ShapeError):
        single_linkage(np.zeros((5, 4)))
    with pytest.raises(NonFiniteError):
        single_linkage([(0, 0), (np.nan, 1)])
