"""What is right and wrong with a peer's constrained triangulation, by exact predicates.

Without crossings: every distinct point is used, every segment is an edge or a chain of edges
through points on it, every other edge is locally Delaunay, and there are 2n - h - 2 triangles. With
crossings a peer's vertices are its own, and the triangles are judged as a tiling alone: each turns
left, no two share a directed edge, and their number is 2n - h - 2 for the h edges of one triangle.
"""

from itertools import pairwise

import judge
import numpy as np
from adapters import Points, Simplices, complex_keys, rows_of
from lines import Lines, Segments
from numpy.typing import NDArray

from delone import predicates

# Chains are looked for where no more segments than these are no edges.
MOST_CHAINS = 20_000


def edges_of(simplices: Simplices) -> NDArray[np.int64]:
    """Return the directed edges of triangles."""
    corner = simplices.astype(np.int64)
    return np.concatenate([corner[:, [0, 1]], corner[:, [1, 2]], corner[:, [2, 0]]])


def chain(points: Points, distinct: NDArray[np.int32], segment: Segments) -> Segments:
    """Return the rows on a segment, ends included, from one end to the other."""
    a, b = points[segment]
    box = (points[distinct] >= np.minimum(a, b)) & (points[distinct] <= np.maximum(a, b))
    near = distinct[box.all(axis=1)]
    on = near[predicates.orient2d(a, b, points[near]) == 0]
    return on[np.argsort(np.abs(points[on] - a).sum(axis=1), kind="stable")]


def laid(points: Points, segments: Segments, simplices: Simplices) -> tuple[Segments, int]:
    """Return the edges that segments have become, and how many segments are not all there."""
    present = np.unique(judge.edge_keys(edges_of(simplices)))
    segments = segments[segments[:, 0] != segments[:, 1]]
    there = np.isin(judge.edge_keys(segments), present)
    missing = segments[~there]
    if len(missing) > MOST_CHAINS:
        return segments[there], len(missing)
    distinct, pieces, lost = np.unique(simplices), [segments[there]], 0
    for segment in missing:
        rows = np.array(list(pairwise(chain(points, distinct, segment))), dtype=np.int32)
        whole = np.isin(judge.edge_keys(rows), present).all()
        pieces += [rows] if whole else []
        lost += not whole
    return np.concatenate(pieces), lost


def verdict(lines: Lines, corners: NDArray[np.float64], expected: int) -> str:
    """Say in a few words what is wrong, or that the answer is exact; `expected` triangles."""
    points = lines.points
    simplices = rows_of(points, corners.reshape(-1, 2)).reshape(-1, 3)
    if (points[simplices] != corners).any():
        return "adds vertices"
    segments = rows_of(points, points[lines.segments].reshape(-1, 2)).reshape(-1, 2)
    pieces, lost = laid(points, segments, simplices)
    wrong = judge.wrong_edges(points, simplices, pieces)
    unused = judge.distinct(points) - len(np.unique(simplices))
    faults = [
        (unused, f"loses {unused:,} points"),
        (lost, f"loses {lost:,} segments"),
        (wrong, f"{wrong:,} edges wrong"),
        (len(simplices) - expected, f"{len(simplices) - expected:+,} triangles"),
    ]
    return ", ".join(words for count, words in faults if count) or "exact"


def tiling(corners: NDArray[np.float64]) -> str:
    """Say what is wrong with triangles as a tiling, or how many vertices it has."""
    points = np.unique(complex_keys(corners.reshape(-1, 2)))
    simplices = np.searchsorted(points, complex_keys(corners.reshape(-1, 2))).reshape(-1, 3)
    turned = int(np.count_nonzero(predicates.orient2d(*corners.swapaxes(0, 1)) <= 0))
    edges = edges_of(simplices)
    ways = edges[:, 0] << 32 | edges[:, 1]
    twice = len(ways) - len(np.unique(ways))
    hull = 2 * len(np.unique(judge.edge_keys(edges))) - len(edges)
    extra = len(simplices) - (2 * len(points) - hull - 2)
    faults = [
        (turned, f"{turned:,} triangles turned"),
        (twice, f"{twice:,} edges twice"),
        (extra, f"{extra:+,} triangles"),
    ]
    return (
        ", ".join(words for count, words in faults if count) or f"valid, {len(points):,} vertices"
    )
