"""Clusters by their definitions: every pair of rows, in fractions.

Rows may coincide. Squared distances and weights are fractions; clusters are sets of rows.
"""

from __future__ import annotations

from decimal import Decimal, localcontext
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from proximity import squared

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from proximity import Point

Rows = frozenset[int]
Weight = dict[tuple[int, int], Fraction]


def parts(rows: Iterable[int], joined: Callable[[int, int], bool]) -> set[Rows]:
    """Connected components, by growing one after the other."""
    left, found = set(rows), set()
    while left:
        grown, edge = set(), {left.pop()}
        while edge:
            grown |= edge
            edge = {j for j in left if any(joined(i, j) for i in edge)}
            left -= edge
        found.add(frozenset(grown))
    return found


def cores(points: Sequence[Point], k: int) -> list[Fraction]:
    """Squared distances to the k-th nearest row, the row itself included."""
    return [sorted(squared(p, q) for q in points)[k - 1] for p in points]


def reach(points: Sequence[Point], k: int) -> Weight:
    """The squared mutual reachability of all pairs."""
    core = cores(points, k)
    return {
        (i, j): max(squared(points[i], points[j]), core[i], core[j])
        for i, j in combinations(range(len(points)), 2)
    }


def distances(points: Sequence[Point]) -> Weight:
    return {(i, j): squared(points[i], points[j]) for i, j in combinations(range(len(points)), 2)}


def at_most(weights: Weight, rows: Iterable[int], limit: Fraction) -> set[Rows]:
    """The components by weights up to a limit."""
    return parts(rows, lambda i, j: weights.get((min(i, j), max(i, j)), limit + 1) <= limit)


class Cluster(NamedTuple):
    """A cluster of the condensed tree."""

    rows: Rows
    birth: Fraction | None  # the squared distance where it splits off; None for the root
    leaves: dict[int, Fraction]  # rows that leave it last, and the squared distances where
    inner: list[Cluster]


def condensed(weights: Weight, rows: Rows, least: int, birth: Fraction | None = None) -> Cluster:
    """The condensed tree: components are split at all edges of their largest weight at once."""
    leaves: dict[int, Fraction] = {}
    component = rows
    while True:
        levels = sorted({weights[pair] for pair in combinations(sorted(component), 2)})
        top = next(level for level in levels if len(at_most(weights, component, level)) == 1)
        lower = {pair: weight for pair, weight in weights.items() if weight < top}
        split = at_most(lower, component, top)
        large = {part for part in split if len(part) >= least}
        leaves |= {row: top for part in split - large for row in part}
        if len(large) > 1:
            inner = [condensed(weights, part, least, top) for part in large]
            return Cluster(rows, birth, leaves, inner)
        if not large:
            return Cluster(rows, birth, leaves, [])
        (component,) = large


def rate(square: Fraction | None) -> Decimal:
    """One over the root of a square: infinite for 0, 0 for none."""
    if square is None:
        return Decimal(0)
    if square == 0:
        return Decimal("Infinity")
    return (Decimal(square.denominator) / Decimal(square.numerator)).sqrt()


def everything(cluster: Cluster) -> list[Cluster]:
    return [cluster, *(found for inner in cluster.inner for found in everything(inner))]


def stability(cluster: Cluster) -> Decimal:
    birth = rate(cluster.birth)
    gone = [rate(level) for level in cluster.leaves.values()]
    gone += [rate(inner.birth) for inner in cluster.inner for _ in inner.rows]
    return sum((level - birth for level in gone), Decimal(0))


class Choice(NamedTuple):
    clusters: list[Cluster]
    value: Decimal
    is_near: bool  # a comparison was a tie, or too near to one for doubles


def excess_of_mass(cluster: Cluster, *, may_be_chosen: bool, largest: int | None) -> Choice:
    inner = [excess_of_mass(i, may_be_chosen=True, largest=largest) for i in cluster.inner]
    below = sum((choice.value for choice in inner), Decimal(0))
    chosen = [found for choice in inner for found in choice.clusters]
    near = any(choice.is_near for choice in inner)
    if not may_be_chosen:
        return Choice(chosen, below, near)
    own = stability(cluster)
    if largest is not None and len(cluster.rows) > largest:
        return Choice(chosen, below, near)
    if inner and own.is_finite() and below.is_finite():
        near = near or abs(own - below) < Decimal("1e-12") * own
    return Choice(chosen, below, near) if below > own else Choice([cluster], own, near)


def hdbscan(
    points: Sequence[Point],
    *,
    least: int,
    samples: int,
    method: str = "eom",
    single: bool = False,
    largest: int | None = None,
) -> tuple[list[Rows], bool]:
    """The selected clusters, each with the rows that have its label; whether a tie was near."""
    with localcontext(prec=60):
        root = condensed(reach(points, samples), frozenset(range(len(points))), least)
        if method == "leaf":
            chosen = [c for c in everything(root) if not c.inner and (c is not root or single)]
            near = False
        else:
            chosen, _, near = excess_of_mass(root, may_be_chosen=single, largest=largest)
    if chosen == [root]:
        last = min([*root.leaves.values(), *(i.birth for i in root.inner if i.birth is not None)])
        inside = {row for c in root.inner for row in c.rows}
        rows = {row for row, level in root.leaves.items() if level <= last} | inside
        return [frozenset(rows)], near
    return [c.rows for c in chosen], near


def dbscan(
    points: Sequence[Point], eps: Fraction, samples: int
) -> tuple[set[int], dict[int, Rows]]:
    """Core rows, and the core rows of the cluster of each row that is not noise."""
    n, limit = len(points), eps**2
    core = {i for i in range(n) if sum(squared(points[i], q) <= limit for q in points) >= samples}
    clusters = at_most(distances(points), core, limit)
    home = {row: cluster for cluster in clusters for row in cluster}
    found: dict[int, Rows] = {}
    for i in range(n):
        near = sorted((squared(points[i], points[j]), points[j], j) for j in core)
        if i in core:
            found[i] = home[i]
        elif near and near[0][0] <= limit:
            found[i] = home[near[0][2]]
    return core, found
