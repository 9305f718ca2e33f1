"""What a diagram hands out besides arrays: rays, neighbours, one cell."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Cell", "Neighbors", "Rays"]


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
        Of length 1.
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
