"""The check of regions: areas bounded by segments, found independently by a flood fill."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from delone._base.arrays import as_points, require_finite
from delone.testing.exact import (
    Mesh,
    as_rows,
    assert_none,
    opposite_corners,
    orient,
    require,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.testing.exact import Indices

    Bools = NDArray[np.bool_]


class BoundedMesh(Protocol):
    """The attributes that are checked; `delone.ConstrainedDelaunay` has them."""

    @property
    def points(self) -> ArrayLike:
        """Coordinates, (n, 2)."""

    @property
    def simplices(self) -> ArrayLike:
        """Triangles, (m, 3)."""

    @property
    def constrained(self) -> ArrayLike:
        """Whether the edge opposite each vertex is a segment, (m, 3)."""


def assert_regions(
    mesh: BoundedMesh,
    labels: ArrayLike,
    *,
    seeds: ArrayLike | None = None,
    seed_labels: ArrayLike | None = None,
) -> None:
    """Assert that labels of triangles correspond to the areas bounded by segments.

    Parameters
    ----------
    mesh : ConstrainedDelaunay, ConstrainedArrays or the like
        Its attributes `points`, `simplices` and `constrained` are used.
    labels : array_like of int, shape (m,)
        The label of each triangle.
    seeds : array_like, shape (k, 2), optional
        Points whose areas are labeled. By default each area has its own label.
    seed_labels : array_like of int, shape (k,), optional
        The labels of the areas of the seeds, by default their rows. The first seed in an area is
        used; seeds outside and on a segment, including its ends, are ignored. An area without a
        seed has label -1.

    Raises
    ------
    AssertionError
        Names the triangles whose labels are wrong.
    InputError
        The points or the seeds are not an array of finite points.

    Notes
    -----
    Areas are found by a flood fill in plain Python, from triangle to triangle across edges that are
    not constrained; adjacency is computed from the triangles themselves. O(m log m), and O(m) exact
    tests for each seed.

    Examples
    --------
    >>> from delone.testing import ConstrainedArrays, assert_regions
    >>> mesh = ConstrainedArrays(
    ...     points=[(0, 0), (2, -1), (4, 0), (2, 1)],
    ...     simplices=[(0, 1, 2), (0, 2, 3)],
    ...     neighbors=[(-1, 1, -1), (-1, -1, 0)],
    ...     segments=[(0, 2)],
    ...     segment_source=([0, 1], [0]),
    ...     constrained=[(False, True, False), (False, False, True)],
    ... )
    >>> assert_regions(mesh, [0, 1])
    >>> assert_regions(mesh, [-1, 7], seeds=[(2, 0.5)], seed_labels=[7])
    >>> assert_regions(mesh, [0, 0])
    Traceback (most recent call last):
    ...
    AssertionError: 1 triangle has the label of another area:
      triangle 1: 0
    """
    points = as_points(mesh.points, ndim=2)
    require_finite(points)
    triangles = as_rows(mesh.simplices, len(points))
    places = points if seeds is None else np.vstack((points, as_points(seeds, ndim=2)))
    require_finite(places, name="seeds")
    exact = Mesh.of(places, triangles)
    flags = np.asarray(mesh.constrained, dtype=bool).reshape(-1, 3)
    found = np.asarray(labels)
    fits = found.shape == (len(triangles),) and flags.shape == triangles.shape
    require(fits, f"labels must have shape ({len(triangles)},), got {found.shape}")
    area = _areas(exact, flags)
    if seeds is None:
        _assert_told_apart(area, found)
        return
    rows = np.arange(len(points), len(places))
    given = rows - len(points) if seed_labels is None else np.asarray(seed_labels)
    wanted = np.full(int(area.max(initial=-1)) + 1, -1, dtype=np.int64)
    for seed, label in reversed(list(zip(rows.tolist(), given.tolist(), strict=True))):
        holds = _holding(exact, flags, seed)
        if holds is not None:
            wanted[area[holds]] = label
    _assert_labels(found, wanted[area], "has the wrong label")


def _areas(exact: Mesh, flags: Bools) -> Indices:
    """The area of each triangle, numbered from 0 in the order of their first triangles."""
    opposite = opposite_corners(exact)
    beyond = np.where((opposite < 0) | flags.ravel(), -1, opposite // 3).reshape(-1, 3).tolist()
    area = [-1] * len(beyond)
    count = 0
    for start in range(len(beyond)):
        if area[start] >= 0:
            continue
        area[start], waiting = count, [start]
        while waiting:
            for other in beyond[waiting.pop()]:
                if other >= 0 and area[other] < 0:
                    area[other] = count
                    waiting.append(other)
        count += 1
    return np.array(area, dtype=np.int64)


def _assert_told_apart(area: Indices, found: NDArray[np.integer]) -> None:
    """Assert that two triangles have the same label if and only if they are in the same area."""
    _, first = np.unique(area, return_index=True)
    of_area = found[first]
    _assert_labels(found, of_area[area], "does not have the label of its area")
    _, kept = np.unique(of_area, return_index=True)
    shared = first[np.setdiff1d(np.arange(len(first)), kept)]
    fault = "has the label of another area"
    assert_none(shared, lambda t: f"triangle {t}: {found[t]}", fault, "triangle")


def _assert_labels(found: NDArray[np.integer], wanted: NDArray[np.integer], fault: str) -> None:
    wrong = np.flatnonzero(found != wanted)
    assert_none(wrong, lambda t: f"triangle {t}: {found[t]}, not {wanted[t]}", fault, "triangle")


def _holding(exact: Mesh, flags: Bools, seed: int) -> int | None:
    """A triangle that contains a seed; None outside and on segments."""
    a, b, c = exact.triangles.T
    sides = np.stack([orient(exact, u, v, seed) for u, v in ((b, c), (c, a), (a, b))], axis=1)
    holding = np.flatnonzero((sides >= 0).all(axis=1))
    on_segment = bool(((sides[holding] == 0) & flags[holding]).any())
    return None if on_segment or len(holding) == 0 else int(holding[0])
