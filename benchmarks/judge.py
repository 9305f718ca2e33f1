"""What is right and wrong with a peer's triangles, by exact predicates.

Judged are the points that no triangle uses, the edges whose circles are not empty, and the number
of triangles, which falls short of 2n - h - 2 (n distinct points, h of them on the hull) where the
union is not convex. Ties may be broken in any way.
"""

import numpy as np
from adapters import Points, Simplices, complex_keys
from numpy.typing import NDArray

from delone import predicates

CHUNK = 1 << 20


def distinct(points: Points) -> int:
    """Count the distinct points."""
    return len(np.unique(complex_keys(points)))


def edge_keys(edges: NDArray[np.integer]) -> NDArray[np.int64]:
    """Return one number for each edge, (k, 2), whichever way it runs."""
    ends = np.sort(edges.astype(np.int64), axis=1)
    return ends[:, 0] << 32 | ends[:, 1]


def interior_edges(simplices: Simplices) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the corners (a, b, c) and the far vertex d across each edge of two triangles."""
    corner = simplices.astype(np.int64)
    edges = np.concatenate([corner[:, [1, 2, 0]], corner[:, [2, 0, 1]], corner[:, [0, 1, 2]]])
    key = edge_keys(edges[:, :2])
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(key[order][1:] == key[order][:-1])
    one, other = order[same], order[same + 1]
    return edges[one], edges[other, 2]


def wrong_edges(points: Points, simplices: Simplices, fixed: Simplices | None = None) -> int:
    """Count the interior edges that are not locally Delaunay, and that are not `fixed`, (k, 2)."""
    triangles, far = interior_edges(simplices)
    if fixed is not None:
        free = ~np.isin(edge_keys(triangles[:, :2]), edge_keys(fixed))
        triangles, far = triangles[free], far[free]
    wrong = 0
    for start in range(0, len(far), CHUNK):
        a, b, c = points[triangles[start : start + CHUNK]].swapaxes(0, 1)
        inside = predicates.incircle(a, b, c, points[far[start : start + CHUNK]])
        wrong += int(np.count_nonzero(inside * predicates.orient2d(a, b, c) > 0))
    return wrong


def verdict(points: Points, simplices: Simplices, expected: int) -> str:
    """Say in a few words what is wrong, or that the answer is exact.

    `expected` is the number of triangles, 2n - h - 2.
    """
    faults = []
    lost = distinct(points) - distinct(points[np.unique(simplices)])
    if lost:
        faults.append(f"loses {lost:,} points")
    wrong = wrong_edges(points, simplices)
    if wrong:
        faults.append(f"{wrong:,} edges wrong")
    if not lost and len(simplices) != expected:
        faults.append(f"{expected - len(simplices):+,} triangles missing at the hull")
    return ", ".join(faults) or "exact"
