"""Which clusters of a condensed tree are selected, and the labels that follow."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.cluster.condensed import CondensedTree

__all__ = ["labeled", "memberships", "selected"]


def selected(
    tree: CondensedTree, *, method: str, epsilon: float, single: bool, largest: int | None
) -> list[int]:
    """Return the selected clusters, ascending; none is inside another."""
    parents = tree.parents.tolist()
    kids: list[list[int]] = [[] for _ in parents]
    for cluster, parent in enumerate(parents[1:], start=1):
        kids[parent].append(cluster)
    if method == "leaf":
        chosen = [cluster for cluster in range(1, len(parents)) if not kids[cluster]]
        if not chosen and single:
            chosen = [0]
    else:
        chosen = _of_excess_of_mass(tree, kids, single=single, largest=largest)
    if epsilon > 0 and chosen and chosen != [0]:
        chosen = _merged(tree, parents, chosen, single=single)
    return chosen


def _of_excess_of_mass(
    tree: CondensedTree, kids: list[list[int]], *, single: bool, largest: int | None
) -> list[int]:
    """Return clusters with the largest sum of stabilities."""
    total = tree.stabilities.tolist()
    sizes = tree.sizes.tolist()
    is_chosen = [True] * len(total)
    for cluster in range(len(total) - 1, -1, -1):
        if cluster == 0 and not single:
            is_chosen[0] = False
            break
        # Summed without intermediate rounding, so that the order does not matter.
        below = math.fsum(total[kid] for kid in kids[cluster])
        is_large = largest is not None and sizes[cluster] > largest
        if below > total[cluster] or is_large:
            is_chosen[cluster], total[cluster] = False, below
    found, inside = [], [False] * len(total)
    for cluster in range(len(total)):
        if inside[cluster] or is_chosen[cluster]:
            for kid in kids[cluster]:
                inside[kid] = True
        if is_chosen[cluster] and not inside[cluster]:
            found.append(cluster)
    return found


def _merged(
    tree: CondensedTree, parents: list[int], chosen: list[int], *, single: bool
) -> list[int]:
    """Return clusters that split off at the given distance or above it.

    A cluster that begins below it is replaced by the first ancestor that begins above it.
    """
    births = tree.births.tolist()
    found: set[int] = set()
    for start in chosen:
        cluster = start
        if births[start] < tree.below:
            while True:
                parent = parents[cluster]
                if parent <= 0:
                    # At the root: the root itself if it is a cluster, otherwise the cluster below
                    # it.
                    cluster = 0 if single else cluster
                    break
                cluster = parent
                if births[cluster] >= tree.up_to:
                    break
        found.add(cluster)
    # Without those inside others.
    outer = set(found)
    for cluster in found:
        above = parents[cluster]
        while above >= 0:
            if above in found:
                outer.discard(cluster)
                break
            above = parents[above]
    return sorted(outer)


def labeled(tree: CondensedTree, chosen: list[int], *, epsilon: float) -> NDArray[np.int64]:
    """Return the selected cluster of each row, or -1."""
    home = np.full(len(tree.parents), -1)
    home[chosen] = chosen
    for cluster, parent in enumerate(tree.parents.tolist()):
        if home[cluster] < 0 and parent >= 0:
            home[cluster] = home[parent]
    found = home[tree.clusters]
    if chosen == [0]:
        # For the root, the rows that remain to the end, or up to the given distance.
        most = tree.up_to - 1 if epsilon > 0 else int(tree.deaths[0])
        found[tree.levels > most] = -1
    return found


def memberships(tree: CondensedTree, labels: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return how long each row remains in its cluster, relative to the last row, from 0 to 1."""
    found = np.zeros(len(labels))
    inside = labels >= 0
    own = tree.heights[tree.levels[inside]]
    least = tree.heights[tree.deaths[labels[inside]]]
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.minimum(least / own, 1.0)
    # Distances may be zero, or exceed the range of doubles.
    found[inside] = np.where((own > 0) & np.isfinite(least), share, 1.0)
    return found
