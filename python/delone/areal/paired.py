"""The base of what cells of two grids have in common: areas, or weights, as compressed rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone._base.immutable import Immutable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Rows

__all__ = ["Paired", "added", "row_sums"]


class Paired(Immutable):
    """Entries of target cells for source cells, and the areas and shapes of both grids."""

    __slots__ = ()

    # Starts, source cells and values of the entries; of source and target, areas and shapes.
    _rows: tuple[Rows, NDArray[np.int32], Floats]
    _areas: tuple[Floats, Floats]
    _shapes: tuple[tuple[int, ...], tuple[int, ...]]

    @property
    def indptr(self) -> Rows:
        """Where the entries of each target cell start, and their number, (ntarget + 1,)."""
        return self._rows[0]

    @property
    def indices(self) -> NDArray[np.int32]:
        """Source cells, ascending in each row, (k,)."""
        return self._rows[1]

    @property
    def source_areas(self) -> Floats:
        """Areas of the source cells, on the sphere in steradians."""
        return self._areas[0]

    @property
    def target_areas(self) -> Floats:
        """Areas of the target cells, on the sphere in steradians."""
        return self._areas[1]

    @property
    def source_shape(self) -> tuple[int, ...]:
        """The shape of fields on the source."""
        return self._shapes[0]

    @property
    def target_shape(self) -> tuple[int, ...]:
        """The shape of fields on the target."""
        return self._shapes[1]

    @property
    def matrix(self) -> Any:
        """The entries as a SciPy sparse matrix, (ntarget, nsource) (extra ``graph``)."""
        sparse = require("scipy.sparse", extra="graph", what="a sparse matrix")
        shape = len(self._areas[1]), len(self._areas[0])
        return sparse.csr_matrix((self._rows[2], self._rows[1], self._rows[0]), shape=shape)


def row_sums(indptr: Rows, values: Floats) -> Floats:
    """Return the sums of rows."""
    found = np.zeros(len(indptr) - 1)
    used = np.flatnonzero(np.diff(indptr))
    if len(used):
        found[used] = np.add.reduceat(values, indptr[used])
    return found


def added(
    rows: Rows, columns: Rows, values: Floats, count: int
) -> tuple[Rows, NDArray[np.int32], Floats]:
    """Return entries as compressed rows; those of the same pair are added."""
    order = np.lexsort((columns, rows))
    rows, columns, values = rows[order], columns[order], values[order]
    first = np.ones(len(rows), dtype=bool)
    first[1:] = (rows[1:] != rows[:-1]) | (columns[1:] != columns[:-1])
    starts = np.flatnonzero(first)
    sums = np.add.reduceat(values, starts) if len(starts) else values
    counts = np.bincount(rows[starts], minlength=count)
    indptr = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    return indptr, columns[starts].astype(np.int32), sums
