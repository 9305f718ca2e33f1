"""Linear interpolation on a rectilinear grid, without its triangulation.

The corners of a grid cell are cospherical, and its canonical triangulation is Kuhn's, even if the
spacing is uneven: each simplex follows a path from the lowest corner to the highest, one axis at a
time. The simplex that contains a query takes the axes in descending order of the query's local
coordinates within the cell. So sorting d numbers finds its corners, and the values equal those of
the Delaunay triangulation up to rounding.

H. W. Kuhn, "Some combinatorial lemmas in topology" (1960).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone._base.blocks import blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices

__all__ = ["Rectilinear", "rectilinear"]


class Cells(NamedTuple):
    """The simplices that contain queries; some queries are outside the grid."""

    # Whether each query is in the grid; the other fields describe only those that are.
    inside: Bools
    # Axes in the order of the path, (k, d), and the rows along it, (k, d + 1).
    axes: NDArray[np.intp]
    corners: Indices
    # Weights of these rows, (k, d + 1), and side lengths of the cells, (k, d).
    weights: Floats
    steps: Floats


class Rectilinear(NamedTuple):
    """The coordinates along each axis, ascending, and the row of the point at each node."""

    axes: tuple[Floats, ...]
    rows: Indices

    def find(self, queries: Floats) -> Cells:
        """Return the simplices that contain queries, (k, d). O(d log n) for each."""
        count, d = queries.shape
        inside = np.ones(count, dtype=bool)
        for k, axis in enumerate(self.axes):
            inside &= (queries[:, k] >= axis[0]) & (queries[:, k] <= axis[-1])
        at = queries[inside]
        node = np.empty(at.shape, dtype=np.intp)
        share, steps = np.empty_like(at), np.empty_like(at)
        for k, axis in enumerate(self.axes):
            low = np.clip(np.searchsorted(axis, at[:, k], side="right") - 1, 0, len(axis) - 2)
            node[:, k] = low
            share[:, k], steps[:, k] = _share(at[:, k], axis[low], axis[low + 1])
        # The order of equal shares does not matter: the corner between them has weight 0.
        order = np.argsort(-share, axis=1, kind="stable")
        strides = np.cumprod([1, *(len(axis) for axis in self.axes[:0:-1])])[::-1]
        number = np.empty((len(at), d + 1), dtype=np.intp)
        number[:, 0] = node @ strides
        np.cumsum(strides[order], axis=1, out=number[:, 1:])
        number[:, 1:] += number[:, :1]
        along = np.take_along_axis(share, order, axis=1)
        ends = np.ones(len(at)), np.zeros(len(at))
        weights = -np.diff(np.column_stack((ends[0], along, ends[1])), axis=1)
        return Cells(inside, order, self.rows[number], weights, steps)

    @property
    def first(self) -> Indices:
        """The first row of each site with the same coordinates."""
        return np.arange(self.rows.size, dtype=np.int32)

    def within(self, queries: Floats) -> tuple[Indices, Floats]:
        """Return rows of corners, (k, d + 1), -1 outside, and their weights, NaN outside."""
        cells = self.find(queries)
        width = queries.shape[1] + 1
        rows = np.full((len(queries), width), -1, np.int32)
        weights = np.full((len(queries), width), np.nan)
        rows[cells.inside], weights[cells.inside] = cells.corners, cells.weights
        return rows, weights

    def values(self, queries: Floats, columns: Floats) -> Floats:
        """Return values, (k, c), NaN outside."""
        found = np.full((len(queries), columns.shape[1]), np.nan)
        for block in blocks(len(queries)):
            cells = self.find(queries[block])
            sums = np.zeros((len(cells.corners), columns.shape[1]))
            for k in range(cells.corners.shape[1]):
                weight = cells.weights[:, k, None]
                # A corner with weight 0 has no effect, even if its value is NaN.
                sums += np.where(weight == 0, 0.0, weight * columns[cells.corners[:, k]])
            found[block][cells.inside] = sums
        return found

    def gradients(self, queries: Floats, columns: Floats) -> Floats:
        """Return gradients, (k, c, d), NaN outside."""
        count, d = queries.shape
        found = np.full((count, columns.shape[1], d), np.nan)
        for block in blocks(count):
            cells = self.find(queries[block])
            # Each step of a path changes one coordinate.
            rise = np.diff(columns[cells.corners], axis=1)
            slopes = np.empty((len(rise), columns.shape[1], d))
            axes = np.broadcast_to(cells.axes[:, None, :], slopes.shape)
            step = np.take_along_axis(cells.steps, cells.axes, axis=1)
            np.put_along_axis(slopes, axes, rise.transpose(0, 2, 1) / step[:, None, :], axis=2)
            found[block][cells.inside] = slopes
        return found

    def __str__(self) -> str:
        return f"a grid of {' x '.join(str(len(axis)) for axis in self.axes)} points"


def _share(at: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Return the positions between two coordinates, from 0 to 1, and the distance of the two."""
    with np.errstate(over="ignore", invalid="ignore"):
        step = high - low
        share = (at - low) / step
        # Halve the numbers, because a step can exceed the largest double.
        far = ~np.isfinite(step)
        share[far] = (at[far] / 2 - low[far] / 2) / (high[far] / 2 - low[far] / 2)
    return share, step


def rectilinear(points: Floats) -> Rectilinear | None:
    """Return the grid of points, (n, d), in any order; None if they are not a complete grid."""
    count, d = points.shape
    if count < 2**d or not np.isfinite(points).all():
        return None
    axes, shape, number = [], 1, np.zeros(count, dtype=np.intp)
    for k in range(d):
        axis, at = np.unique(points[:, k], return_inverse=True)
        shape *= len(axis)
        # The number of nodes of a grid is the product of the lengths of its axes.
        if len(axis) < 2 or shape > count:
            return None
        axes.append(axis)
        number = number * len(axis) + at
    if shape != count:
        return None
    rows = np.full(count, -1, dtype=np.int32)
    rows[number] = np.arange(count, dtype=np.int32)
    return None if (rows < 0).any() else Rectilinear(tuple(axes), rows)
