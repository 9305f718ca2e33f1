"""Graphs and clusters of points whose squared distances leave the range of doubles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import graphs
from delone.cluster import DBSCAN, HDBSCAN, single_linkage
from delone.graphs.scale import rescaled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

POWERS = [-1000, -660, 660, 1000]
MAKERS: dict[str, Any] = {
    "relative neighborhood": graphs.relative_neighborhood,
    "lunes": lambda points: graphs.beta_skeleton(points, 1.5),
    "circles": lambda points: graphs.beta_skeleton(points, 1.5, kind="circle"),
    "gabriel": lambda points: graphs.gabriel(points, boundary="open"),
    "nearest": lambda points: graphs.nearest_neighbors(points, 5),
    "influence": graphs.sphere_of_influence,
    "tree": graphs.minimum_spanning_tree,
}


def clouds(ndim: int) -> list[Floats]:
    rng = np.random.default_rng(0)
    return [rng.random((1500, ndim)), rng.integers(0, 12, (600, ndim)).astype(float)]


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize(
    ("name", "ndim"),
    [(name, ndim) for name in MAKERS for ndim in (2, 3) if (name, ndim) != ("circles", 3)],
)
def test_graphs_are_those_of_other_units(name: str, ndim: int, power: int) -> None:
    for points in clouds(ndim):
        wanted = MAKERS[name](points)
        found = MAKERS[name](np.ldexp(points, power))
        assert np.array_equal(found.edges, wanted.edges)
        assert np.array_equal(found.points, np.ldexp(points, power))


def test_the_urquhart_graph_is_that_of_other_units() -> None:
    points = clouds(2)[0]
    for power in POWERS:
        found = graphs.urquhart(np.ldexp(points, power))
        assert np.array_equal(found.edges, graphs.urquhart(points).edges)


@pytest.mark.parametrize("power", POWERS)
@pytest.mark.parametrize("ndim", [2, 3])
def test_clusters_are_those_of_other_units(ndim: int, power: int) -> None:
    rng = np.random.default_rng(1)
    points = np.vstack([rng.normal(x, 0.1, (150, ndim)) for x in (0, 1, 5)])
    scaled = np.ldexp(points, power)
    options = {"min_cluster_size": 10, "cluster_selection_epsilon": 0.25}
    wanted = HDBSCAN(**options).fit(points)
    options["cluster_selection_epsilon"] = float(np.ldexp(0.25, power))
    found = HDBSCAN(**options).fit(scaled)
    assert wanted.labels_.max() >= 1
    assert np.array_equal(found.labels_, wanted.labels_)
    np.testing.assert_array_equal(found.probabilities_, wanted.probabilities_)
    density = DBSCAN(eps=0.125, min_samples=4).fit(points)
    far = DBSCAN(eps=float(np.ldexp(0.125, power)), min_samples=4).fit(scaled)
    assert len(np.unique(density.labels_)) > 2
    assert np.array_equal(far.labels_, density.labels_)
    assert np.array_equal(far.core_sample_indices_, density.core_sample_indices_)
    heights = single_linkage(points).linkage[:, 2]
    if power != -1000:  # where they are no longer exact
        assert np.array_equal(single_linkage(scaled).linkage[:, 2], np.ldexp(heights, power))


def test_only_what_is_exact_is_rescaled() -> None:
    points = np.array([(1.0, 2.0), (0.0, -3.0)])
    assert rescaled(points) == (points, 0)
    for power in (-900, 900):
        found, exponent = rescaled(np.ldexp(points, power), 0.0)
        assert np.abs(found).max() == 0.75 and exponent == -power - 2
        assert np.array_equal(np.ldexp(found, -exponent), np.ldexp(points, power))
    for mixed in ([(1e300, 1e-300), (0, 1)], [(1e-300, 0), (5e-324, 0)]):
        kept, exponent = rescaled(np.array(mixed, dtype=float))
        assert exponent == (0 if mixed[0][0] > 1 else exponent)
        assert np.array_equal(np.ldexp(kept, -exponent), mixed)
    # A length that would not be the same.
    assert rescaled(np.full((2, 2), 1e300), 5e-324)[1] == 0
    assert rescaled(np.full((2, 2), 1e-300), np.inf)[1] != 0


def test_lengths_far_beyond_all_others_are_compared() -> None:
    points = np.ldexp(clouds(2)[0], 900)
    assert (DBSCAN(eps=np.inf, min_samples=2).fit(points).labels_ == 0).all()
    assert (DBSCAN(eps=5e-324, min_samples=2).fit(points).labels_ == -1).all()
