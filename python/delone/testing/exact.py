"""Simplices with exact integer coordinates: signs, edges, the hull, and assertions.

All coordinates are multiplied by one power of two that makes each of them an integer. NumPy stores
them as Python integers, so that no product of them is ever rounded.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import ArrayLike, NDArray

    Indices = NDArray[np.int64]
    Integers = NDArray[np.object_]

_SHOWN = 5


class Mesh(NamedTuple):
    """Triangles with exact coordinates and the data that every check needs."""

    points: NDArray[np.float64]
    triangles: Indices
    x: Integers
    y: Integers
    order: Indices  # rows sorted by x, then y, then row
    rank: Indices  # equal for equal points, ascending lexicographically
    first: Indices  # for each row, the first row with the same coordinates
    exponent: int  # coordinates are x and y times two to this power

    @classmethod
    def of(cls, points: NDArray[np.float64], triangles: Indices) -> Mesh:
        """Convert finite points and triangles whose indices are in range."""
        integers, exponent = integers_of(points)
        x, y = integers.T
        return cls(points, triangles, x, y, *ranked(points), exponent)

    def mirrored(self) -> Indices:
        """The position of each row in the order by ascending x, then descending y."""
        place = np.empty(len(self.points), dtype=np.int64)
        flat = self.points + 0.0
        place[np.lexsort((-flat[:, 1], flat[:, 0]))] = np.arange(len(place))
        return place

    def name(self, rows: Iterable[int]) -> str:
        """Rows with their coordinates, for error messages."""
        return ", ".join(f"{row} {tuple(self.points[row].tolist())}" for row in rows)

    def edge(self, key: int) -> str:
        """An edge u * n + v, for error messages."""
        return f"edge {self.name(divmod(key, len(self.points)))}"

    def triangle(self, t: int) -> str:
        """A triangle with its corners, for error messages."""
        return f"triangle {t}: {self.name(self.triangles[t].tolist())}"


class SpaceMesh(NamedTuple):
    """Tetrahedra with exact coordinates and the data that every check needs."""

    points: NDArray[np.float64]
    tetrahedra: Indices
    at: Integers  # (n, 3)
    rank: Indices  # equal for equal points, ascending lexicographically
    first: Indices  # for each row, the first row with the same coordinates

    @classmethod
    def of(cls, points: NDArray[np.float64], tetrahedra: Indices) -> SpaceMesh:
        """Convert finite points and tetrahedra whose indices are in range."""
        _, rank, first = ranked(points)
        return cls(points, tetrahedra, integers_of(points)[0], rank, first)

    def name(self, rows: Iterable[int]) -> str:
        """Rows with their coordinates, for error messages."""
        return ", ".join(f"{row} {tuple(self.points[row].tolist())}" for row in rows)

    def tetrahedron(self, t: int) -> str:
        """A tetrahedron with its corners, for error messages."""
        return f"tetrahedron {t}: {self.name(self.tetrahedra[t].tolist())}"


def ranked(points: NDArray[np.float64]) -> tuple[Indices, Indices, Indices]:
    """The rows in lexicographic order, and for each row its rank and the first equal row."""
    flat = points + 0.0  # makes -0.0 the same as 0.0
    order = np.lexsort(flat.T[::-1])
    fresh = np.ones(len(points), dtype=bool)
    fresh[1:] = (flat[order[1:]] != flat[order[:-1]]).any(axis=1)
    rank = np.empty(len(points), dtype=np.int64)
    rank[order] = np.cumsum(fresh) - 1
    # lexsort is stable, so the first of each group is the smallest row.
    return order, rank, order[fresh][rank]


def integers_of(points: NDArray[np.float64]) -> tuple[Integers, int]:
    """Coordinates, (n, d), multiplied by the power of two that makes all of them integers."""
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
    lowest = int(used.min()) if used.size else 0
    shift = exponent - lowest
    shift[mantissa == 0] = 0
    integers = np.left_shift(mantissa.astype(object), shift.astype(object))
    return integers, lowest


def orient(mesh: Mesh, a: Any, b: Any, c: Any) -> Any:
    """Twice the signed area of triangles, exactly; a, b, c are rows or arrays of rows."""
    x, y = mesh.x, mesh.y
    return (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a])


def incircle(mesh: Mesh, a: Indices, b: Indices, c: Indices, d: Indices) -> Integers:
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


def as_rows(
    rows: ArrayLike,
    npoints: int,
    *,
    name: str = "simplices",
    noun: str = "triangle",
    width: int = 3,
) -> Indices:
    """Convert rows of vertices to an array; assert its dtype, shape and range."""
    array = np.asarray(rows)
    if array.size == 0:
        array = array.astype(np.int64).reshape(-1, width)
    require(array.dtype.kind in "iu", f"{name} must hold integers, got dtype {array.dtype}")
    require(
        array.ndim == 2 and array.shape[1] == width,
        f"{name} must have shape ({'q' if width == 2 else 'm'}, {width}), got {array.shape}",
    )
    bad = np.flatnonzero(((array < 0) | (array >= npoints)).any(axis=1))
    fault = f"has a vertex outside the rows 0 to {npoints - 1}"
    assert_none(bad, lambda t: f"{noun} {t}: {array[t].tolist()}", fault, noun)
    return array.astype(np.int64)


def require(condition: bool, message: str) -> None:
    """Assert a condition, even if Python runs with -O, which removes assert statements."""
    if not condition:
        raise AssertionError(message)


def assert_none(wrong: Any, name: Callable[[Any], str], fault: str, noun: str) -> None:
    """Fail if an array or list has elements, and name the first of them."""
    count = len(wrong)
    if count == 0:
        return
    if count > 1:
        noun += "s"
        noun = noun.replace("tetrahedrons", "tetrahedra")
        fault = fault.replace("is ", "are ", 1).replace("has ", "have ", 1)
    named = [name(each) for each in wrong[:_SHOWN]] + ["..."] * (count > _SHOWN)
    raise AssertionError("\n  ".join((f"{count} {noun} {fault}:", *named)))


def hull_of(mesh: Mesh) -> list[int]:
    """The counter-clockwise hull, starting at the smallest point, with the points on its edges.

    Andrew, A. M. (1979), "Another efficient algorithm for convex hulls in two dimensions": a lower
    chain and an upper chain, popping only right turns, so that collinear points are kept.
    """
    rows = mesh.order[mesh.first[mesh.order] == mesh.order].tolist()

    def chain(rows: list[int]) -> list[int]:
        kept: list[int] = []
        for row in rows:
            while len(kept) > 1 and orient(mesh, kept[-2], kept[-1], row) < 0:
                kept.pop()
            kept.append(row)
        return kept[:-1]

    return chain(rows) + chain(rows[::-1])


def spans_no_area(mesh: Mesh) -> bool:
    """Return whether all points lie on one line."""
    rows = np.unique(mesh.first)
    if len(rows) < 3:
        return True
    # The smallest and the largest point are different, so they span the line, if any.
    low, high = int(mesh.order[0]), int(mesh.order[-1])
    return not (orient(mesh, low, high, rows) != 0).any()


def directed_edges(mesh: Mesh) -> Indices:
    """Edges opposite the vertices, each as one number u * n + v, of shape (3 m,)."""
    u, v = mesh.triangles[:, [1, 2, 0]].ravel(), mesh.triangles[:, [2, 0, 1]].ravel()
    keys: Indices = u * len(mesh.points) + v
    return keys


def opposite_corners(mesh: Mesh) -> Indices:
    """For each corner 3 t + k, the corner beyond the edge opposite it, or -1 on the boundary."""
    n, keys = len(mesh.points), directed_edges(mesh)
    order = np.argsort(keys)
    reverse = keys % n * n + keys // n
    place = np.minimum(np.searchsorted(keys, reverse, sorter=order), max(len(keys) - 1, 0))
    corners: Indices = np.where(keys[order[place]] == reverse, order[place], -1)
    return corners
