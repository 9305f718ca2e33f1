"""HDBSCAN against its definition, in fractions, and against scikit-learn without ties."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sklearn.cluster

import density
from clustered import SMALL, partition
from delone import datasets
from delone.cluster import DBSCAN, HDBSCAN

if TYPE_CHECKING:
    from numpy.typing import NDArray

CASES = [
    (name, samples) for name in SMALL for samples in (1, 2, 3, 5) if len(SMALL[name]) >= samples
]


@pytest.mark.parametrize(("name", "samples"), CASES)
@pytest.mark.parametrize("least", [2, 4])
@pytest.mark.sampled(23)
def test_the_condensed_tree_is_that_of_the_definition(name: str, samples: int, least: int) -> None:
    points = SMALL[name]
    n = len(points)
    exact = [tuple(map(density.Fraction, row)) for row in points.tolist()]
    root = density.condensed(density.reach(exact, samples), frozenset(range(n)), least)
    table = HDBSCAN(least, min_samples=samples).fit(points).condensed_tree_
    below: dict[int, set[int]] = {}
    for row in table[::-1]:
        below.setdefault(int(row["parent"]), set())
    inner = {int(row["child"]): row for row in table if row["child"] >= n}

    def rows(cluster: int) -> frozenset[int]:
        own = table[table["parent"] == cluster]["child"]
        found = {int(child) for child in own if child < n}
        return frozenset(found.union(*(rows(int(child)) for child in own if child >= n)))

    def rate(square: density.Fraction) -> float:
        return 1 / root_of(square) if square else np.inf

    expected = density.everything(root)
    assert {rows(n), *(rows(c) for c in inner)} == {c.rows for c in expected}
    for cluster in expected:
        (number,) = [c for c in (n, *inner) if rows(c) == cluster.rows]
        own = table[(table["parent"] == number) & (table["child"] < n)]
        assert {int(c) for c in own["child"]} == set(cluster.leaves)
        for child, rate_of in zip(own["child"], own["lambda_val"], strict=True):
            assert rate_of == pytest.approx(rate(cluster.leaves[int(child)]), rel=1e-15)
        if cluster.birth is not None:
            assert inner[number]["child_size"] == len(cluster.rows)
            assert inner[number]["lambda_val"] == pytest.approx(rate(cluster.birth), rel=1e-15)


def root_of(square: density.Fraction) -> float:
    with density.localcontext(prec=60):
        return float((density.Decimal(square.numerator) / square.denominator).sqrt())


@pytest.mark.parametrize(("name", "samples"), CASES)
@pytest.mark.parametrize(
    "options",
    [
        {"least": 2},
        {"least": 4},
        {"least": 3, "single": True},
        {"least": 3, "method": "leaf"},
        {"least": 6, "method": "leaf", "single": True},
        {"least": 2, "largest": 6, "single": True},
    ],
    ids=str,
)
@pytest.mark.deep(
    "{'least': 2, 'largest': 6, 'single': True}-mixed exponents-1",
    "{'least': 2, 'largest': 6, 'single': True}-mixed exponents-2",
    "{'least': 3, 'method': 'leaf'}-mixed exponents-2",
    "{'least': 3, 'single': True}-mixed exponents-1",
)
@pytest.mark.sampled(70)
def test_the_labels_are_those_of_the_definition(
    name: str, samples: int, options: dict[str, Any]
) -> None:
    points = np.random.default_rng(1).permutation(SMALL[name])
    exact = [tuple(map(density.Fraction, row)) for row in points.tolist()]
    expected, near = density.hdbscan(exact, samples=samples, **options)
    model = HDBSCAN(
        options["least"],
        min_samples=samples,
        cluster_selection_method=options.get("method", "eom"),
        allow_single_cluster=options.get("single", False),
        max_cluster_size=options.get("largest"),
    ).fit(points)
    found = partition(model.labels_)
    assert (model.probabilities_[model.labels_ < 0] == 0).all()
    assert all(model.probabilities_[sorted(rows)].max() == 1 for rows in found)
    assert near or found == set(expected)


def pairs(one: NDArray[Any], other: NDArray[Any]) -> set[tuple[int, int]]:
    return set(zip(one.tolist(), other.tolist(), strict=True))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("seed", range(6))
def test_without_ties_the_labels_are_those_of_scikit_learn(d: int, seed: int) -> None:
    # With one or two samples, weights are distances, which all differ.
    random = np.random.default_rng(seed)
    points = np.concatenate(
        [random.normal(random.random(d), s, (150, d)) for s in (0.02, 0.1, 0.2)]
    )
    options = {
        "min_cluster_size": int(random.integers(2, 15)),
        "min_samples": int(random.integers(1, 3)),
        "cluster_selection_method": ("eom", "leaf")[seed % 2],
        "max_cluster_size": (None, 60)[seed // 2 % 2],
    }
    model = HDBSCAN(**options).fit(points)
    peer = sklearn.cluster.HDBSCAN(**options, copy=True).fit(points)
    both = pairs(model.labels_, peer.labels_)
    assert len(both) == len(set(model.labels_)) == len(set(peer.labels_))

    assert np.allclose(model.probabilities_, peer.probabilities_)


def test_equal_core_distances_are_ties() -> None:
    # The core distance of the middle is 10, the weight of its edges to both groups: it is in
    # neither. Other implementations give it to one of them.
    x = [0, 1, 2, 3, 10, 17, 18, 19, 20]
    model = HDBSCAN(3, min_samples=4).fit([(value, 0) for value in x])
    assert model.labels_.tolist() == [0, 0, 0, 0, -1, 1, 1, 1, 1]


@pytest.mark.parametrize(
    ("epsilon", "expected"),
    [
        # Pairs at distance 1, two of them 3 apart, and 9 to the others.
        (0, [0, 0, 1, 1, 2, 2, 3, 3]),
        (3, [0, 0, 1, 1, 2, 2, 3, 3]),
        (np.nextafter(3, 4), [0, 0, 0, 0, 1, 1, 1, 1]),
        (9, [0, 0, 0, 0, 1, 1, 1, 1]),
        (10, [0, 0, 0, 0, 1, 1, 1, 1]),
    ],
)
def test_epsilon_is_compared_exactly(epsilon: float, expected: list[int]) -> None:
    x = np.array([0, 1, 4, 5, 14, 15, 18, 19.0])
    points = np.column_stack((x, np.zeros(8)))
    options = {"min_samples": 1, "cluster_selection_method": "leaf"}
    model = HDBSCAN(2, cluster_selection_epsilon=epsilon, **options).fit(points)
    assert model.labels_.tolist() == expected
    # With a root that may be selected, only the largest one reaches it.
    model.set_params(allow_single_cluster=True)
    assert model.fit_predict(points).tolist() == ([0] * 8 if epsilon >= 9 else expected)


def test_probabilities_are_ratios_of_distances() -> None:
    x = np.array([0, 1, 2, 4, 100, 101, 102, 104.0])
    model = HDBSCAN(3, min_samples=1).fit(np.column_stack((x, x * 0)))
    assert model.labels_.tolist() == [0, 0, 0, 0, 1, 1, 1, 1]
    assert model.probabilities_.tolist() == [1, 1, 1, 0.5] * 2


def test_coincident_rows_have_no_distance() -> None:
    points = np.repeat([[0.0, 0], [5, 0], [0, 7]], 4, axis=0)
    model = HDBSCAN(3, min_samples=4).fit(points)
    assert model.labels_.tolist() == [0] * 4 + [1] * 4 + [2] * 4
    assert (model.probabilities_ == 1).all()
    assert np.isinf(model.condensed_tree_["lambda_val"]).sum() == 12
    same = np.ones((6, 3))
    assert (HDBSCAN(3).fit_predict(same) == -1).all()
    assert (HDBSCAN(3, allow_single_cluster=True).fit_predict(same) == 0).all()


@pytest.mark.parametrize("n", range(5))
@pytest.mark.parametrize("d", [2, 3])
def test_fewer_points_than_samples_are_noise(n: int, d: int) -> None:
    points = np.arange(n * d, dtype=float).reshape(n, d)
    model = HDBSCAN(2, min_samples=5, allow_single_cluster=True).fit(points)
    assert model.labels_.tolist() == [-1] * n
    assert model.probabilities_.tolist() == [0] * n
    assert model.condensed_tree_["lambda_val"].tolist() == [0] * n
    assert model.condensed_tree_["parent"].tolist() == [n] * n


def test_labels_can_be_written() -> None:
    points = datasets.gaussian_clusters(60)
    for model in (HDBSCAN(5).fit(points), DBSCAN(0.1).fit(points)):
        model.labels_[:] = 7
        assert set(model.labels_.tolist()) == {7}
