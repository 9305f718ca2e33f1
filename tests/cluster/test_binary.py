"""The condensed tree for the package hdbscan: each cluster splits into two or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from clustered import SMALL
from delone import InputError
from delone.cluster import HDBSCAN

if TYPE_CHECKING:
    from numpy.typing import NDArray


def plotted(tree: NDArray[np.void]) -> tuple[dict[int, float], dict[int, float]]:
    """What ``hdbscan.plots.CondensedTree.get_plot_data`` does first: places of all clusters."""
    root, last = int(tree["parent"].min()), int(tree["parent"].max())
    inner = tree[tree["child_size"] > 1]
    leaves = [c for c in range(root, last + 1) if c not in inner["parent"]]
    across = {leaf: float(i) for i, leaf in enumerate(leaves)}
    up = {root: 0.0}
    for cluster in range(last, root - 1, -1):
        split = inner[inner["parent"] == cluster]
        if len(split) > 1:
            left, right = split["child"].tolist()
            across[cluster] = (across[left] + across[right]) / 2
            up[left], up[right] = split["lambda_val"]
    assert set(across) == set(up) == set(range(root, last + 1))
    return across, up


def families(tree: NDArray[np.void]) -> set[tuple[frozenset[int], float]]:
    """The rows and the birth of each cluster that has rows of its own."""
    root = int(tree["parent"].min())
    born = {int(row["child"]): float(row["lambda_val"]) for row in tree if row["child"] >= root}
    found = set()
    for cluster in (root, *born):
        below, rows = [cluster], []
        while below:
            at = below.pop()
            own = tree["child"][tree["parent"] == at].tolist()
            rows += [child for child in own if child < root]
            below += [child for child in own if child >= root]
        if (tree["child"][tree["parent"] == cluster] < root).any() or cluster == root:
            found.add((frozenset(rows), born.get(cluster, 0.0)))
        if cluster != root:
            assert tree["child_size"][tree["child"] == cluster] == len(rows)
    return found


def groups(count: int) -> NDArray[np.float64]:
    x = np.concatenate([10.0 * i + np.arange(3) for i in range(count)])
    return np.column_stack((x, 0 * x))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_a_split_into_many_is_one_of_two_and_two(count: int) -> None:
    model = HDBSCAN(3, min_samples=1).fit(groups(count))
    tree = model.to_hdbscan()
    across, _ = plotted(tree)
    assert len(across) == 2 * count - 1
    assert families(tree) == families(model.condensed_tree_)


@pytest.mark.parametrize("name", sorted(SMALL))
def test_each_tree_is_binary_and_has_the_same_clusters(name: str) -> None:
    model = HDBSCAN(2, min_samples=1).fit(SMALL[name])
    plotted(model.to_hdbscan())
    assert families(model.condensed_tree_) <= families(model.to_hdbscan())


def test_an_estimator_that_is_not_fitted_has_no_tree() -> None:
    with pytest.raises(InputError, match="call fit"):
        HDBSCAN().to_hdbscan()
