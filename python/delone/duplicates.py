"""Rows of points that repeat earlier rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["first_rows"]


def first_rows(points: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return for each point the first row with the same coordinates.

    Parameters
    ----------
    points : ndarray of float64, shape (n, d)
        Coordinates.

    Returns
    -------
    ndarray of int64, shape (n,)
        Rows.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.duplicates import first_rows
    >>> first_rows(np.array([(1.0, 2), (0, 0), (1, 2)])).tolist()
    [0, 1, 0]
    """
    order = np.lexsort(points.T)
    ordered = points[order]
    new = np.ones(len(order), dtype=bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # The sort is stable, so that the first of equal rows comes first.
    first = np.empty(len(order), dtype=np.int64)
    first[order] = order[np.flatnonzero(new)][np.cumsum(new) - 1]
    return first
