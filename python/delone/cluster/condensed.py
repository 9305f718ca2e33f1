"""The condensed tree of HDBSCAN, as the core returns it and as a table."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.immutable import sealed
from delone.graphs.scale import rescaled

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["CondensedTree", "binary", "condensed_tree"]

_TABLE = [
    ("parent", np.int64),
    ("child", np.int64),
    ("lambda_val", float),
    ("child_size", np.int64),
]


@dataclass(frozen=True, eq=False)
class CondensedTree:
    """Clusters of at least a size; cluster 0 is the root, and parents have smaller numbers.

    Levels number the distances where something changes, ascending.
    """

    clusters: Indices  # (n,): the cluster that each row leaves last
    levels: Indices  # (n,): the level where it does
    parents: Indices  # (c,): -1 for the root
    births: Indices  # (c,): the level where a cluster splits from its parent, -1 for the root
    deaths: Indices  # (c,): the lowest level where something leaves it
    sizes: Indices  # (c,)
    stabilities: Floats  # (c,), in some unit
    heights: Floats  # the distance of each level
    below: int  # levels below cluster_selection_epsilon
    up_to: int  # levels up to it

    @property
    def lambdas(self) -> Floats:
        """One over the distance of each level; 0 if it is beyond doubles, infinite for zero."""
        with np.errstate(divide="ignore", over="ignore"):
            found: Floats = 1 / self.heights
            return found

    def table(self) -> NDArray[np.void]:
        """Return rows and clusters that leave clusters; clusters are numbered from n on."""
        n = len(self.clusters)
        count = n + len(self.parents) - 1
        lambdas = self.lambdas
        table = np.empty(count, dtype=_TABLE)
        table["parent"][:n] = self.clusters + n
        table["parent"][n:] = self.parents[1:] + n
        table["child"] = np.concatenate((np.arange(n), n + np.arange(1, len(self.parents))))
        table["lambda_val"] = lambdas[np.concatenate((self.levels, self.births[1:]))]
        table["child_size"][:n] = 1
        table["child_size"][n:] = self.sizes[1:]
        return sealed(table[np.lexsort((table["child"], table["parent"]))])


def condensed_tree(
    points: Floats, *, samples: int, least: int, epsilon: float, workers: int
) -> CondensedTree:
    """Return the condensed tree of points, by mutual reachability."""
    n = len(points)
    if n >= 2 and samples <= n:
        scaled, exponent = rescaled(points, epsilon)
        reach = float(np.ldexp(epsilon, exponent))
        found = _core.condensed(scaled, samples, least, reach, workers)
        made = CondensedTree(*found[:8], *found[8])
        return replace(made, heights=np.ldexp(made.heights, -exponent)) if exponent else made
    # Core distances do not exist, so all rows leave the root at the start.
    zeros, root = np.zeros(n, dtype=np.int32), np.array([-1], dtype=np.int32)
    return CondensedTree(
        clusters=zeros,
        levels=zeros,
        parents=root,
        births=root,
        deaths=root + 1,
        sizes=np.array([n], dtype=np.int32),
        stabilities=np.zeros(1),
        heights=np.array([np.inf]),
        below=0,
        up_to=0,
    )


def binary(table: NDArray[np.void]) -> NDArray[np.void]:
    """Return a table of `CondensedTree.table` in which no cluster splits into more than two.

    If there are more, all but the first are in a cluster without its own rows, which splits at the
    same lambda, and so on. Parents have smaller numbers, and all numbers from the root on are used.
    """
    root = int(table["parent"].min())
    inner = table[table["child"] >= root]
    kids: dict[int, list[int]] = {}
    for i, parent in enumerate(inner["parent"].tolist()):
        kids.setdefault(parent, []).append(i)
    number = {root: root}
    rows: list[tuple[int, int, float, int]] = []
    for cluster in range(root, root + len(inner) + 1):
        # The number of a cluster is known, because those of its parents are smaller.
        holder, left = number[cluster], kids.get(cluster, [])
        while left:  # Terminates: one less in each round
            parts = [left] if len(left) == 1 else [left[:1], left[1:]]
            for part in parts:
                new = root + 1 + len(rows)
                size = int(inner["child_size"][part].sum())
                rows.append((holder, new, inner["lambda_val"][part[0]], size))
                if len(part) == 1:
                    number[int(inner["child"][part[0]])] = new
            left, holder = (left[1:], new) if len(left) > 2 else ([], new)
    leaves = table[table["child"] < root].copy()
    leaves["parent"] = [number[parent] for parent in leaves["parent"].tolist()]
    found = np.concatenate((leaves, np.array(rows, dtype=_TABLE)))
    return found[np.lexsort((found["child"], found["parent"]))]
