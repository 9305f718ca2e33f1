"""Exact assertions about triangulations, for this package's tests and for everybody else's.

Nothing here uses the compiled core: coordinates become Python integers at one common power of two,
which no arithmetic on them can round, and every test is a few lines of textbook geometry over NumPy
arrays of such integers. What passes is the Delaunay triangulation of the real numbers that the
doubles denote. Two-dimensional.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._arrays import as_points, require_finite
from delone.errors import DtypeError, ShapeError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    Indices = NDArray[np.int64]
    Integers = NDArray[np.object_]

__all__ = ["assert_delaunay", "same_triangles", "triangle_set"]

_SHOWN = 5


def assert_delaunay(
    points: ArrayLike,
    simplices: ArrayLike,
    *,
    neighbors: ArrayLike | None = None,
    canonical: bool = True,
) -> None:
    """Assert, exactly, that triangles are the Delaunay triangulation of points.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates.
    simplices : array_like of int, shape (m, 3)
        Vertices of the triangles, as rows of `points`.
    neighbors : array_like of int, shape (m, 3), optional
        The triangle opposite each vertex, -1 outside. By default neighbours are not looked at.
    canonical : bool, optional
        Whether cocircular vertices must be fanned from their lexicographically smallest one, as
        delone does. False accepts every Delaunay triangulation.

    Raises
    ------
    AssertionError
        Names what is wrong and the first culprits, with their coordinates.
    InputError
        `points` is no array of finite points.

    Notes
    -----
    Checked are: the type and range of indices; that all triangles are counter-clockwise, no
    directed edge is used twice, every distinct point is a vertex, and of equal points only the
    first; that the boundary is the exact convex hull, with the points on its edges as vertices;
    that there are 2n - h - 2 triangles, of the same area as the hull; that each inner edge is
    locally Delaunay, and canonical where four points share a circle; that neighbours are those
    across the edges. Of points which span no area, only the empty triangulation passes.

    O(n log n) exact operations, for 10,000 points well below a second. That the local test suffices
    is shown by Delaunay, B. (1934), "Sur la sphère vide".

    Examples
    --------
    >>> from delone.testing import assert_delaunay
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    >>> assert_delaunay(square, [(0, 1, 2), (0, 2, 3)])
    >>> assert_delaunay(square, [(0, 1, 3), (1, 2, 3)], canonical=False)
    >>> assert_delaunay(square, [(0, 1, 3), (1, 2, 3)])
    Traceback (most recent call last):
    ...
    AssertionError: 1 edge is not canonical: the smallest of four cocircular points is not on it:
      edge 1 (1.0, 0.0), 3 (0.0, 1.0) between 0 (0.0, 0.0), 2 (1.0, 1.0)
    """
    points = as_points(points, ndim=2)
    require_finite(points)
    triangles = _as_triangles(simplices, len(points))
    mesh = _Mesh.of(points, triangles)
    if _spans_no_area(mesh):
        _require(len(triangles) == 0, f"{len(triangles)} triangles of points that span no area")
    else:
        _assert_vertices(mesh)
        _assert_counter_clockwise(mesh)
        _assert_hull_and_area(mesh)
        _assert_locally_delaunay(mesh, canonical)
    if neighbors is not None:
        _assert_neighbors(mesh, neighbors)


def triangle_set(simplices: ArrayLike) -> set[tuple[int, int, int]]:
    """Return triangles as a set of triples, each turned so that its smallest vertex is first.

    Parameters
    ----------
    simplices : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    set of tuple of int
        Two arrays give the same set when they hold the same triangles with the same orientation,
        in whatever order and from whichever vertex on.

    Raises
    ------
    ShapeError, DtypeError
        `simplices` is no array of integers of shape (m, 3), nor empty.

    Examples
    --------
    >>> from delone.testing import triangle_set
    >>> sorted(triangle_set([(3, 2, 0), (1, 2, 3)]))
    [(0, 3, 2), (1, 2, 3)]
    """
    return set(_turned(simplices, "simplices"))


def same_triangles(a: ArrayLike, b: ArrayLike) -> bool:
    """Tell whether two arrays hold the same triangles with the same orientation.

    Parameters
    ----------
    a, b : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    bool
        False also where one of them holds a triangle more often than the other.

    Raises
    ------
    ShapeError, DtypeError
        `a` or `b` is no array of integers of shape (m, 3), nor empty.

    Examples
    --------
    >>> from delone.testing import same_triangles
    >>> same_triangles([(0, 1, 2), (0, 2, 3)], [(2, 3, 0), (1, 2, 0)])
    True
    """
    return sorted(_turned(a, "a")) == sorted(_turned(b, "b"))


def _turned(simplices: ArrayLike, name: str) -> list[tuple[int, int, int]]:
    """Triangles as triples, each from its smallest vertex on."""
    try:
        triangles = np.asarray(simplices)
    except ValueError as error:
        raise ShapeError(f"{name} has rows of unequal length: {error}") from error
    if triangles.shape in ((0,), (0, 3)):
        return []
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise ShapeError(f"{name} must have shape (m, 3), got {triangles.shape}")
    if triangles.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers, got dtype {triangles.dtype}")
    start = triangles.argmin(axis=1)[:, None]
    turned = np.take_along_axis(triangles, (start + np.arange(3)) % 3, axis=1)
    return [(a, b, c) for a, b, c in turned.tolist()]


class _Mesh(NamedTuple):
    """Triangles with exact coordinates and what every check needs of them."""

    points: NDArray[np.float64]
    triangles: Indices
    x: Integers
    y: Integers
    order: Indices  # rows sorted by x, then y, then row
    rank: Indices  # equal for equal points, ascending lexicographically
    first: Indices  # of each row, the first row with the same coordinates

    @classmethod
    def of(cls, points: NDArray[np.float64], triangles: Indices) -> _Mesh:
        x, y = _scaled_to_integers(points)
        flat = points + 0.0  # makes -0.0 the same as 0.0
        order = np.lexsort((flat[:, 1], flat[:, 0]))
        fresh = np.ones(len(points), dtype=bool)
        fresh[1:] = (flat[order[1:]] != flat[order[:-1]]).any(axis=1)
        group = np.cumsum(fresh) - 1
        rank = np.empty(len(points), dtype=np.int64)
        rank[order] = group
        # lexsort is stable, so the first of each group is the smallest row.
        return cls(points, triangles, x, y, order, rank, order[fresh][rank])

    def name(self, rows: Iterable[int]) -> str:
        """Rows with their coordinates, for error messages."""
        return ", ".join(f"{row} {tuple(self.points[row].tolist())}" for row in rows)


def _scaled_to_integers(points: NDArray[np.float64]) -> tuple[Integers, Integers]:
    """Multiply all coordinates by the power of two that makes the finest of them an integer."""
    fraction, exponent = np.frexp(points)
    mantissa = np.ldexp(fraction, 53).astype(np.int64)
    exponent = exponent.astype(np.int64) - 53
    # Short mantissas keep the integers short: strip the trailing zero bits.
    lowest_bit = mantissa & -mantissa
    zeros = np.frexp(lowest_bit.astype(np.float64))[1].astype(np.int64) - 1
    zeros[mantissa == 0] = 0
    mantissa >>= zeros
    exponent += zeros
    used = exponent[mantissa != 0]
    shift = exponent - (used.min() if used.size else 0)
    shift[mantissa == 0] = 0
    integers = np.left_shift(mantissa.astype(object), shift.astype(object))
    return integers[:, 0], integers[:, 1]


def _orient(mesh: _Mesh, a: Any, b: Any, c: Any) -> Any:
    """Twice the signed area of triangles, exactly; a, b, c are rows or arrays of rows."""
    x, y = mesh.x, mesh.y
    return (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a])


def _incircle(mesh: _Mesh, a: Indices, b: Indices, c: Indices, d: Indices) -> Integers:
    """Positive where d is inside the circle of the counter-clockwise triangle a, b, c."""
    ax, ay = mesh.x[a] - mesh.x[d], mesh.y[a] - mesh.y[d]
    bx, by = mesh.x[b] - mesh.x[d], mesh.y[b] - mesh.y[d]
    cx, cy = mesh.x[c] - mesh.x[d], mesh.y[c] - mesh.y[d]
    determinant: Integers = (
        (ax * ax + ay * ay) * (bx * cy - by * cx)
        + (bx * bx + by * by) * (cx * ay - cy * ax)
        + (cx * cx + cy * cy) * (ax * by - ay * bx)
    )
    return determinant


def _as_triangles(simplices: ArrayLike, npoints: int) -> Indices:
    array = np.asarray(simplices)
    if array.size == 0:
        array = array.astype(np.int64).reshape(-1, 3)
    _require(array.dtype.kind in "iu", f"simplices must hold integers, got dtype {array.dtype}")
    _require(
        array.ndim == 2 and array.shape[1] == 3,
        f"simplices must have shape (m, 3), got {array.shape}",
    )
    bad = ((array < 0) | (array >= npoints)).any(axis=1)
    _assert_none(
        [f"triangle {t}: {array[t].tolist()}" for t in np.flatnonzero(bad)[:_SHOWN]],
        int(bad.sum()),
        f"has a vertex outside the rows 0 to {npoints - 1}",
        "triangle",
    )
    return array.astype(np.int64)


def _require(condition: bool, message: str) -> None:
    """Assert, also where Python runs with -O and drops assert statements."""
    if not condition:
        raise AssertionError(message)


def _assert_none(culprits: list[str], count: int, fault: str, noun: str) -> None:
    """Fail if there are culprits, listing the first of them below one sentence."""
    if count == 0:
        return
    if count > 1:
        noun += "s"
        fault = fault.replace("is ", "are ", 1).replace("has ", "have ", 1)
    more = "\n  ..." if count > len(culprits) else ""
    raise AssertionError(f"{count} {noun} {fault}:\n  " + "\n  ".join(culprits) + more)


def _hull(mesh: _Mesh) -> list[int]:
    """Counter-clockwise hull from the smallest point on, with the points on its edges.

    Andrew, A. M. (1979), "Another efficient algorithm for convex hulls in two dimensions": one
    chain below and one above, here popping right turns only, so that collinear points stay.
    """
    rows = mesh.order[mesh.first[mesh.order] == mesh.order].tolist()

    def chain(rows: list[int]) -> list[int]:
        kept: list[int] = []
        for row in rows:
            while len(kept) > 1 and _orient(mesh, kept[-2], kept[-1], row) < 0:
                kept.pop()
            kept.append(row)
        return kept[:-1]

    return chain(rows) + chain(rows[::-1])


def _spans_no_area(mesh: _Mesh) -> bool:
    rows = np.unique(mesh.first)
    if len(rows) < 3:
        return True
    # The smallest and the largest point differ, so they span the line, if there is one.
    low, high = int(mesh.order[0]), int(mesh.order[-1])
    return not (_orient(mesh, low, high, rows) != 0).any()


def _assert_vertices(mesh: _Mesh) -> None:
    used = np.zeros(len(mesh.points), dtype=bool)
    used[mesh.triangles] = True
    is_first = mesh.first == np.arange(len(mesh.points))
    repeats = np.flatnonzero(used & ~is_first)
    _assert_none(
        [f"{mesh.name([row])} repeats row {mesh.first[row]}" for row in repeats[:_SHOWN].tolist()],
        len(repeats),
        "is used in spite of an earlier equal row",
        "row",
    )
    lost = np.flatnonzero(is_first & ~used)
    _assert_none(
        [mesh.name([row]) for row in lost[:_SHOWN].tolist()],
        len(lost),
        "is no vertex of any triangle",
        "point",
    )


def _assert_counter_clockwise(mesh: _Mesh) -> None:
    a, b, c = mesh.triangles.T
    turned = np.flatnonzero(_orient(mesh, a, b, c) <= 0)
    _assert_none(
        [f"triangle {t}: {mesh.name(mesh.triangles[t].tolist())}" for t in turned[:_SHOWN]],
        len(turned),
        "is not counter-clockwise",
        "triangle",
    )
    keys, counts = np.unique(_directed_edges(mesh), return_counts=True)
    doubled = keys[counts > 1]
    n = len(mesh.points)
    _assert_none(
        [f"edge {mesh.name((key // n, key % n))}" for key in doubled[:_SHOWN].tolist()],
        len(doubled),
        "is used more than once in the same direction",
        "edge",
    )


def _directed_edges(mesh: _Mesh) -> Indices:
    """Edges opposite the vertices, as one number u * n + v each, of shape (3 m,)."""
    u, v = mesh.triangles[:, [1, 2, 0]].ravel(), mesh.triangles[:, [2, 0, 1]].ravel()
    keys: Indices = u * len(mesh.points) + v
    return keys


def _opposite_corners(mesh: _Mesh) -> Indices:
    """Of each corner 3 t + k, the corner beyond the edge opposite it, or -1 on the boundary."""
    n, keys = len(mesh.points), _directed_edges(mesh)
    order = np.argsort(keys)
    reverse = keys % n * n + keys // n
    place = np.minimum(np.searchsorted(keys, reverse, sorter=order), max(len(keys) - 1, 0))
    corners: Indices = np.where(keys[order[place]] == reverse, order[place], -1)
    return corners


def _assert_hull_and_area(mesh: _Mesh) -> None:
    n, hull = len(mesh.points), _hull(mesh)
    keys = _directed_edges(mesh)
    found = set(keys[_opposite_corners(mesh) < 0].tolist())
    wanted = {u * n + v for u, v in zip(hull, hull[1:] + hull[:1], strict=True)}
    for keys_left, fault in (
        (sorted(found - wanted), "is on the boundary, but not on the convex hull"),
        (sorted(wanted - found), "is on the convex hull, but not on the boundary"),
    ):
        _assert_none(
            [f"edge {mesh.name((key // n, key % n))}" for key in keys_left[:_SHOWN]],
            len(keys_left),
            fault,
            "edge",
        )
    # Count and area follow from what was asserted so far: they check the checks.
    distinct, m = len(np.unique(mesh.first)), len(mesh.triangles)
    expected = 2 * distinct - len(hull) - 2
    _require(
        m == expected,
        f"{m} triangles, but {distinct} distinct points of which {len(hull)} are on the hull "
        f"have {expected}",
    )
    corners = np.array(hull)
    area = _orient(mesh, *mesh.triangles.T).sum()
    hull_area = _orient(mesh, corners[0], corners[:-1], corners[1:]).sum()
    _require(area == hull_area, "the triangles have not the area of the hull")


def _assert_locally_delaunay(mesh: _Mesh, canonical: bool) -> None:
    opposite = _opposite_corners(mesh)
    corner = np.flatnonzero(opposite > np.arange(len(opposite)))  # each inner edge once
    t, k = np.divmod(corner, 3)
    p, u, v = (mesh.triangles[t, (k + i) % 3] for i in range(3))
    q = mesh.triangles.ravel()[opposite[corner]]
    inside = _incircle(mesh, p, u, v, q)

    def edges(which: Indices) -> list[str]:
        return [
            f"edge {mesh.name(sorted((u[i], v[i])))} between {mesh.name(sorted((p[i], q[i])))}"
            for i in which[:_SHOWN].tolist()
        ]

    wrong = np.flatnonzero(inside > 0)
    _assert_none(edges(wrong), len(wrong), "is not locally Delaunay", "edge")
    if not canonical:
        return
    rank = mesh.rank
    apex_smallest = np.minimum(rank[p], rank[q]) < np.minimum(rank[u], rank[v])
    tied = np.flatnonzero((inside == 0) & apex_smallest)
    fault = "is not canonical: the smallest of four cocircular points is not on it"
    _assert_none(edges(tied), len(tied), fault, "edge")


def _assert_neighbors(mesh: _Mesh, neighbors: ArrayLike) -> None:
    array = np.asarray(neighbors)
    if array.size == 0:
        array = array.astype(np.int64).reshape(-1, 3)
    _require(array.dtype.kind in "iu", f"neighbors must hold integers, got dtype {array.dtype}")
    _require(
        array.shape == mesh.triangles.shape,
        f"neighbors must have shape {mesh.triangles.shape}, got {array.shape}",
    )
    if len(array) == 0:
        return
    opposite = _opposite_corners(mesh)
    wanted = np.where(opposite < 0, -1, opposite // 3).reshape(-1, 3)
    wrong = np.flatnonzero((array != wanted).any(axis=1))
    _assert_none(
        [f"triangle {t}: {array[t].tolist()}, not {wanted[t].tolist()}" for t in wrong[:_SHOWN]],
        len(wrong),
        "has wrong neighbours",
        "triangle",
    )
