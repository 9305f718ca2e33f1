"""What a diagram hands out besides arrays: rays, neighbours, one cell."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from delone.errors import DtypeError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Cell", "Neighbors", "Rays", "as_site"]


class Rays(NamedTuple):
    """The ridges that go on for ever, each with where it begins and whither it goes.

    A ridge between two sites alone, or between neighbours among sites on one line, is a line: it
    has two rays, in opposite directions from one origin.

    Parameters
    ----------
    ridge : ndarray of int32, shape (k,)
        The ridge.
    origin : ndarray of float64, shape (k, 2)
        Its one vertex; on a line, the point nearest to both sites.
    direction : ndarray of float64, shape (k, 2)
        Of length 1. In space origins and directions have three columns.

    Examples
    --------
    >>> from delone import Voronoi
    >>> rays = Voronoi([(0, 0), (2, 0), (0, 2)]).rays
    >>> rays.origin[0].tolist(), rays.direction[0].tolist()
    ([1.0, 1.0], [0.0, -1.0])
    """

    ridge: Indices
    origin: Floats
    direction: Floats


class Neighbors(NamedTuple):
    """The neighbours of all sites as compressed rows.

    Parameters
    ----------
    indptr : ndarray of int32, shape (n + 1,)
        Where those of each site begin: ``indices[indptr[i]:indptr[i + 1]]``.
    indices : ndarray of int32, shape (k,)
        The neighbours of each site, ascending.
    lengths : ndarray of float64, shape (k,)
        The length of the edge that both cells have in common.

    Examples
    --------
    >>> from delone import Voronoi
    >>> strips = Voronoi([(0, 0), (2, 0), (4, 0)], clip=(-1, -1, 5, 1))
    >>> indptr, indices, lengths = strips.neighbors
    >>> indices[indptr[1]:indptr[2]].tolist(), lengths[indptr[1]:indptr[2]].tolist()
    ([0, 2], [2.0, 2.0])
    """

    indptr: Indices
    indices: Indices
    lengths: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class Cell:
    """One cell of a diagram.

    Parameters
    ----------
    site : int
        Row of the site.
    vertices : ndarray of float64, shape (k, 2)
        The vertices of the whole cell, counter-clockwise. An unbounded one begins after the ray
        that comes in and ends before the one that goes out.
    bounded : bool
        Whether the whole cell is bounded.
    parts : tuple of tuple of ndarray of float64, shape (j, 2)
        What is left of it within the clip: for each part its rings, the outer one first, each
        without repetition of its first corner. Empty where nothing is left, and for an unbounded
        cell that is not clipped.
    neighbors : ndarray of int32, shape (j,)
        The sites of the cells beside it.
    lengths : ndarray of float64, shape (j,)
        Of the edges common with them.
    area, perimeter : float
        As in the diagram.
    centroid : ndarray of float64, shape (2,)
        As in the diagram.

    Examples
    --------
    >>> from delone import Voronoi
    >>> cell = Voronoi([(0, 0), (2, 0), (4, 0)], clip=(-1, -1, 5, 1)).cell(1)
    >>> cell.bounded, cell.area, cell.centroid.tolist(), cell.neighbors.tolist()
    (False, 4.0, [2.0, 0.0], [0, 2])
    """

    site: int
    vertices: Floats
    bounded: bool
    parts: tuple[tuple[Floats, ...], ...]
    neighbors: Indices
    lengths: Floats
    area: float
    perimeter: float
    centroid: Floats


def as_site(i: Any) -> int:
    """Return the row of a site as a Python integer.

    Parameters
    ----------
    i : int
        What the caller passed.

    Returns
    -------
    int
        The row, of which it is not known whether it is there.

    Raises
    ------
    DtypeError
        It is no integer.

    Examples
    --------
    >>> from delone.voronoi.cells import as_site
    >>> as_site(2)
    2
    """
    try:
        return operator.index(i)
    except TypeError:
        raise DtypeError(f"i must be the row of a site, got {i!r:.60}") from None
