"""The exact check of constrained Delaunay triangulations.

A triangulation is the constrained Delaunay triangulation of its points and segments if the segments
are chains of edges, and every other edge is locally Delaunay: Chew, L. P. (1989), "Constrained
Delaunay triangulations", Algorithmica 4, 97-108.
"""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from delone._base.arrays import as_flag, as_points, require_finite
from delone.testing.checks import (
    assert_counter_clockwise,
    assert_hull_and_area,
    assert_locally_delaunay,
    assert_neighbors,
    assert_vertices,
)
from delone.testing.exact import (
    Mesh,
    as_rows,
    assert_none,
    directed_edges,
    hull_of,
    opposite_corners,
    orient,
    require,
    spans_no_area,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.testing.exact import Indices

    Bools = NDArray[np.bool_]

_ULPS = 4


class ConstrainedMesh(Protocol):
    """The attributes that are checked; `delone.ConstrainedDelaunay` has them."""

    @property
    def points(self) -> ArrayLike:
        """Coordinates, (n, 2)."""

    @property
    def simplices(self) -> ArrayLike:
        """Triangles, (m, 3)."""

    @property
    def neighbors(self) -> ArrayLike:
        """The triangle opposite each vertex, (m, 3)."""

    @property
    def segments(self) -> ArrayLike:
        """Subsegments, (q, 2)."""

    @property
    def segment_source(self) -> tuple[ArrayLike, ArrayLike]:
        """The given rows that cover each subsegment, as compressed rows (indptr, indices)."""

    @property
    def constrained(self) -> ArrayLike:
        """Whether the edge opposite each vertex is a subsegment, (m, 3)."""


class ConstrainedArrays(NamedTuple):
    """A constrained triangulation from any source, to be checked.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates, including those of added vertices.
    simplices, neighbors : array_like of int, shape (m, 3)
        Vertices of the triangles, and the triangle opposite each vertex, -1 outside.
    segments : array_like of int, shape (q, 2)
        The subsegments: pairs of vertices.
    segment_source : tuple of array_like of int
        ``(indptr, indices)``: the rows of the given segments that cover subsegment i are
        ``indices[indptr[i]:indptr[i + 1]]``, ascending.
    constrained : array_like of bool, shape (m, 3)
        Whether the edge opposite each vertex is a subsegment.
    """

    points: ArrayLike
    simplices: ArrayLike
    neighbors: ArrayLike
    segments: ArrayLike
    segment_source: tuple[ArrayLike, ArrayLike]
    constrained: ArrayLike

    @classmethod
    def of(
        cls,
        points: ArrayLike,
        simplices: ArrayLike,
        sources: Mapping[tuple[int, int], Sequence[int]],
    ) -> ConstrainedArrays:
        """Derive the other fields from triangles and the sources of subsegments.

        Parameters
        ----------
        points : array_like, shape (n, 2)
            Finite coordinates.
        simplices : array_like of int, shape (m, 3)
            Vertices of the triangles.
        sources : mapping of tuple of int to sequence of int
            Each subsegment with the rows that cover it, as
            `delone.reference.constrained_delaunay` returns them.

        Returns
        -------
        ConstrainedArrays
            The arrays, with neighbors and flags, which are then correct by construction.

        Examples
        --------
        >>> from delone.reference import constrained_delaunay
        >>> from delone.testing import ConstrainedArrays
        >>> kite = [(0, 0), (2, -1), (4, 0), (2, 1)]
        >>> ConstrainedArrays.of(kite, *constrained_delaunay(kite, [(0, 2)])).neighbors
        array([[-1,  1, -1],
               [-1, -1,  0]])
        """
        exact = Mesh.of(as_points(points, ndim=2), as_rows(simplices, len(np.asarray(points))))
        opposite = opposite_corners(exact)
        edges = {frozenset(edge) for edge in sources}
        flags = [
            frozenset((t[k - 1], t[k - 2])) in edges
            for t in exact.triangles.tolist()
            for k in range(3)
        ]
        return cls(
            points,
            exact.triangles,
            np.where(opposite < 0, -1, opposite // 3).reshape(-1, 3),
            np.array(list(sources), dtype=np.int64).reshape(-1, 2),
            (
                np.cumsum([0, *map(len, sources.values())]),
                np.array([row for rows in sources.values() for row in rows], dtype=np.int64),
            ),
            np.array(flags, dtype=bool).reshape(-1, 3),
        )


def assert_constrained_delaunay(
    mesh: ConstrainedMesh,
    segments: ArrayLike,
    *,
    complete: bool = True,
    split: bool = False,
    tolerance: float | None = None,
    canonical: bool = True,
) -> None:
    """Assert, exactly, that triangles are the constrained Delaunay triangulation of segments.

    Parameters
    ----------
    mesh : ConstrainedDelaunay, ConstrainedArrays or the like
        Its attributes `points`, `simplices`, `neighbors`, `segments`, `segment_source` and
        `constrained` are checked, see `ConstrainedArrays`.
    segments : array_like of int, shape (s, 2)
        The given segments, as rows of the points.
    complete : bool, optional
        Whether the triangles cover the convex hull. Pass False if some have been removed: then
        points need not be vertices, the boundary may consist of subsegments as well as hull edges,
        and subsegments need not be edges; they are still listed.
    split : bool, optional
        Whether vertices were added where segments cross, at points that had to be rounded. A
        segment may then be a chain of edges that deviates from its line by `tolerance`.
    tolerance : float, optional
        The largest distance between a vertex and a segment that passes through it, with `split`.
        By default four times the distance from the largest absolute coordinate to the next double.
    canonical : bool, optional
        Whether cocircular vertices must be fanned from their lexicographically smallest one, as far
        as segments permit. False accepts every constrained Delaunay triangulation.

    Raises
    ------
    AssertionError
        Names the fault and the first elements that have it, with their coordinates.
    InputError
        The points are not an array of finite points.

    Notes
    -----
    The checks include those of `assert_delaunay`: indices, orientation, edges, vertices, hull,
    count, area and neighbors. In addition, each subsegment is listed once, is an edge, and is
    flagged on both sides, and no other edge is flagged; the subsegments of each given row form a
    chain from end to end without reversing direction, all on its line; and every inner edge that is
    not a subsegment is locally Delaunay. With `split`, all vertices of a row are near it instead.
    If the triangles tile the hull, no two subsegments cross.

    O(n log n) exact operations for n points and subsegments. Chew (1989).

    Examples
    --------
    A kite whose longer diagonal is a segment:

    >>> from delone.testing import ConstrainedArrays, assert_constrained_delaunay
    >>> mesh = ConstrainedArrays(
    ...     points=[(0, 0), (2, -1), (4, 0), (2, 1)],
    ...     simplices=[(0, 1, 2), (0, 2, 3)],
    ...     neighbors=[(-1, 1, -1), (-1, -1, 0)],
    ...     segments=[(0, 2)],
    ...     segment_source=([0, 1], [0]),
    ...     constrained=[(False, True, False), (False, False, True)],
    ... )
    >>> assert_constrained_delaunay(mesh, [(0, 2)])
    >>> assert_constrained_delaunay(mesh, [(0, 2), (1, 2)])
    Traceback (most recent call last):
    ...
    AssertionError: 1 segment is not covered from end to end:
      row 1: 1 (2.0, -1.0), 2 (4.0, 0.0)
    """
    for name, flag in {"complete": complete, "split": split, "canonical": canonical}.items():
        as_flag(flag, name=name)
    exact = _exact(mesh)
    if complete and spans_no_area(exact):
        require(
            len(exact.triangles) == 0,
            f"{len(exact.triangles)} triangles of points that span no area",
        )
    elif complete:
        assert_vertices(exact, exact.triangles)
        assert_counter_clockwise(exact)
        assert_hull_and_area(exact)
    else:
        assert_counter_clockwise(exact)
    assert_neighbors(exact, mesh.neighbors)
    given = as_rows(segments, len(exact.points), name="segments", noun="segment", width=2)
    pieces = _Pieces.of(mesh, exact, given)
    flags = _flags(mesh, exact)
    _assert_flagged(exact, pieces, flags, complete)
    if not complete:
        _assert_boundary(exact, flags)
    if split:
        _assert_near(exact, pieces, _tolerance(exact, tolerance))
    else:
        _assert_on_line(exact, pieces)
    _assert_chains(exact, pieces)
    assert_locally_delaunay(exact, canonical, flags)


def _exact(mesh: ConstrainedMesh) -> Mesh:
    points = as_points(mesh.points, ndim=2)
    require_finite(points)
    return Mesh.of(points, as_rows(mesh.simplices, len(points)))


def _flags(mesh: ConstrainedMesh, exact: Mesh) -> Bools:
    flags = np.asarray(mesh.constrained)
    if flags.size == 0:
        flags = flags.astype(bool).reshape(-1, 3)
    require(flags.dtype == bool, f"constrained must contain booleans, got dtype {flags.dtype}")
    shape = exact.triangles.shape
    require(flags.shape == shape, f"constrained must have shape {shape}, got {flags.shape}")
    return flags


class _Pieces(NamedTuple):
    """Subsegments and their sources: entry i says that `row[i]` covers `piece[i]`."""

    ends: Indices  # (q, 2)
    given: Indices  # (s, 2), the lexicographically smaller end first; of equal points the first row
    piece: Indices
    row: Indices

    @classmethod
    def of(cls, mesh: ConstrainedMesh, exact: Mesh, given: Indices) -> _Pieces:
        ends = as_rows(
            mesh.segments, len(exact.points), name="mesh.segments", noun="subsegment", width=2
        )
        indptr, row = (np.asarray(array) for array in mesh.segment_source)
        count = len(ends)
        shaped = indptr.shape == (count + 1,) and row.ndim == 1
        require(shaped, f"segment_source does not match {count} subsegments")
        ends_fit = indptr[0] == 0 and indptr[-1] == len(row) and (np.diff(indptr) > 0).all()
        require(bool(ends_fit), "segment_source has a subsegment without a row")
        in_range = len(row) == 0 or bool(row.min() >= 0 and row.max() < len(given))
        require(in_range, f"segment_source names rows outside 0 to {len(given) - 1}")
        piece = np.repeat(np.arange(count), np.diff(indptr))
        unsorted = np.flatnonzero((np.diff(piece) == 0) & (np.diff(row) <= 0))
        assert_none(
            unsorted,
            lambda i: f"subsegment {piece[i]}: {row[piece == piece[i]]}",
            "has rows in segment_source that are not ascending",
            "subsegment",
        )
        own = exact.first[given]
        swap = exact.rank[own[:, 0]] > exact.rank[own[:, 1]]
        own = np.where(swap[:, None], own[:, ::-1], own)
        return cls(ends, own, piece, row.astype(np.int64))


def _assert_flagged(exact: Mesh, pieces: _Pieces, flags: Bools, complete: bool) -> None:
    """Assert that subsegments are edges, listed once, and flagged, and other edges are not."""
    n = len(exact.points)

    def undirected(u: Indices, v: Indices) -> Indices:
        return np.minimum(u, v) * n + np.maximum(u, v)

    def side(corner: int) -> str:
        return f"triangle {corner // 3}: {exact.edge(edges[corner])}"

    wanted, counts = np.unique(undirected(*pieces.ends.T), return_counts=True)
    assert_none(wanted[counts > 1], exact.edge, "is listed more than once", "subsegment")
    edges = undirected(*np.divmod(directed_edges(exact), n))
    if complete:
        lost = wanted[~np.isin(wanted, edges)]
        assert_none(lost, exact.edge, "is not an edge of a triangle", "subsegment")
    right = np.isin(edges, wanted)
    for wrong, fault in (
        (right & ~flags.ravel(), "is a subsegment, but not flagged as constrained"),
        (~right & flags.ravel(), "is flagged as constrained, but is not a subsegment"),
    ):
        assert_none(np.flatnonzero(wrong), side, fault, "edge side")


def _assert_boundary(exact: Mesh, flags: Bools) -> None:
    """Assert that the boundary is flagged or on the hull, if triangles have been removed."""
    n, hull = len(exact.points), hull_of(exact)
    on_hull = [u * n + v for u, v in zip(hull, hull[1:] + hull[:1], strict=True)]
    keys = directed_edges(exact)
    bare = keys[(opposite_corners(exact) < 0) & ~flags.ravel() & ~np.isin(keys, on_hull)]
    fault = "is on the boundary, but neither a subsegment nor on the convex hull"
    assert_none(bare, exact.edge, fault, "edge")


def _named(exact: Mesh, pieces: _Pieces) -> Callable[[int], str]:
    """Return a function that names an entry: the row and the subsegment."""

    def name(i: int) -> str:
        ends = exact.name(pieces.ends[pieces.piece[i]].tolist())
        return f"row {pieces.row[i]}: subsegment {pieces.piece[i]} from {ends}"

    return name


def _assert_on_line(exact: Mesh, pieces: _Pieces) -> None:
    """Assert that both ends of each subsegment are on the lines of all its rows."""
    (a, b), (u, v) = pieces.given[pieces.row].T, pieces.ends[pieces.piece].T
    off = (orient(exact, a, b, u) != 0) | (orient(exact, a, b, v) != 0) | (a == b)
    fault = "is not on the line of its row"
    assert_none(np.flatnonzero(off), _named(exact, pieces), fault, "subsegment")


def _assert_chains(exact: Mesh, pieces: _Pieces) -> None:
    """Assert that the subsegments of each row lead from end to end and never turn back.

    In the order in which a segment runs from its smaller end, x does not decrease, and y is
    monotonic; rounding preserves that.
    """
    low, high = pieces.given.T
    entries = pieces.ends[pieces.piece]
    falls = exact.y[high] < exact.y[low]
    place = np.where(falls[pieces.row][:, None], exact.mirrored()[entries], exact.rank[entries])
    turned = place[:, 0] > place[:, 1]
    entries = np.where(turned[:, None], entries[:, ::-1], entries)
    order = np.lexsort((place.min(axis=1, initial=len(exact.points)), pieces.row))
    row, (u, v) = pieces.row[order], entries[order].T
    y_up = np.where(falls[row], -1, 1)
    new = np.ones(len(row), dtype=bool)
    new[1:] = row[1:] != row[:-1]
    wrong = u != np.where(new, low[row], np.roll(v, 1))
    wrong |= np.roll(new, -1) & (v != high[row])
    wrong |= (exact.y[v] - exact.y[u]) * y_up < 0
    bare = np.setdiff1d(np.flatnonzero(low != high), row)
    rows = np.union1d(row[wrong], bare)
    assert_none(
        rows,
        lambda row: f"row {row}: {exact.name(pieces.given[row].tolist())}",
        "is not covered from end to end",
        "segment",
    )


def _tolerance(exact: Mesh, tolerance: float | None) -> Fraction:
    """The tolerance in units of the integer coordinates."""
    if tolerance is None:
        largest = float(np.abs(exact.points).max(initial=0.0))
        tolerance = _ULPS * math.ulp(largest)
    return Fraction(tolerance) / Fraction(2) ** exact.exponent


def _assert_near(exact: Mesh, pieces: _Pieces, tolerance: Fraction) -> None:
    """Assert that both ends of each subsegment are near all its rows."""
    a, b = pieces.given[pieces.row].T
    far = np.zeros(len(a), dtype=bool)
    for w in pieces.ends[pieces.piece].T:
        far |= _beyond(exact, a, b, w, tolerance)
    fault = f"is more than {float(tolerance * Fraction(2) ** exact.exponent)} away from its row"
    assert_none(np.flatnonzero(far), _named(exact, pieces), fault, "subsegment")


def _beyond(exact: Mesh, a: Indices, b: Indices, w: Indices, tolerance: Fraction) -> Any:
    """Return which points w are farther from the segments ab than the tolerance."""
    x, y = exact.x, exact.y
    dx, dy = x[b] - x[a], y[b] - y[a]
    along = dx * (x[w] - x[a]) + dy * (y[w] - y[a])
    length = dx * dx + dy * dy
    nearest = np.where(along <= 0, a, b)
    to_end = (x[w] - x[nearest]) ** 2 + (y[w] - y[nearest]) ** 2
    # Both sides times the squared denominator of the tolerance, so that they are integers.
    over, under = tolerance.denominator**2, tolerance.numerator**2
    beside = (along > 0) & (along < length)
    from_line = orient(exact, a, b, w) ** 2 * over > length * under
    return np.where(beside, from_line, to_end * over > under)
