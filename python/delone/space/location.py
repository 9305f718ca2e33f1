"""Where points lie in a triangulation of space: the tetrahedron and the weights of its corners.

The core keeps an index of starts for the walks (`Locator3`); a triangulation makes it on the first
query and holds it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from delone._arrays import as_vectors, as_workers

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from delone import _core

__all__ = ["SpaceLocation", "locate"]


@dataclass(frozen=True, eq=False)
class SpaceLocation:
    """Where points lie in space.

    Parameters
    ----------
    simplex : ndarray of int32, shape (...)
        The tetrahedron that holds the point, the first one where there are several; -1 outside.
    barycentric : ndarray of float64, shape (..., 4)
        Weights of the corners of that tetrahedron: none below 0, of sum 1 up to rounding, exactly 1
        at a corner. NaN outside.
    """

    simplex: NDArray[np.int32]
    barycentric: NDArray[np.float64]

    def at(self, rows: NDArray[np.integer]) -> SpaceLocation:
        """Return some of the places.

        Parameters
        ----------
        rows : ndarray of int
            Which, along the first axis.

        Returns
        -------
        SpaceLocation
            Those.
        """
        return SpaceLocation(self.simplex[rows], self.barycentric[rows])


def locate(index: _core.Locator3, xi: ArrayLike, workers: int | None) -> SpaceLocation:
    """Tell where queries lie.

    Parameters
    ----------
    index : Locator3
        The core's index over the tetrahedra.
    xi : array_like, shape (..., 3)
        Queries.
    workers : int or None
        Number of threads.

    Returns
    -------
    SpaceLocation
        In the shape of the queries.

    Raises
    ------
    ShapeError, DtypeError
        `xi` is no array of real points in space.
    """
    queries = as_vectors(xi, 3, name="xi")
    leading = queries.shape[:-1]
    simplex, barycentric, _ = index.locate(queries.reshape(-1, 3), as_workers(workers))
    return SpaceLocation(simplex.reshape(leading), barycentric.reshape((*leading, 4)))
