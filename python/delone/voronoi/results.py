"""What a diagram returns besides arrays: rays, neighbors, a cell."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from delone.errors import DtypeError

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

__all__ = ["Cell", "Neighbors", "PolyhedralCell", "Rays", "as_site"]


class Rays(NamedTuple):
    """The unbounded ridges, with their origins and directions.

    In 2-D, the ridge between two sites without others, or between neighbors among collinear sites,
    is a line: it has two rays, in opposite directions from one origin. In 3-D each unbounded ridge
    has two rays, between which it lies.

    Parameters
    ----------
    ridge : ndarray of int32, shape (k,)
        The ridge.
    origin : ndarray of float64, shape (k, d)
        The vertex where the ray begins; on a line, the point nearest to both sites.
    direction : ndarray of float64, shape (k, d)
        Of length 1.

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
    """The neighbors of all sites as compressed rows.

    Parameters
    ----------
    indptr : ndarray of int32, shape (n + 1,)
        Where those of each site begin: ``indices[indptr[i]:indptr[i + 1]]``.
    indices : ndarray of int32, shape (k,)
        The neighbors of each site, ascending.
    sizes : ndarray of float64, shape (k,)
        The length of the edge, in 3-D the area of the face, that both cells share.

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
    sizes: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class Cell:
    """One cell of a 2-D diagram.

    Parameters
    ----------
    site : int
        Row of the site.
    vertices : ndarray of float64, shape (k, 2)
        The vertices of the whole cell, counter-clockwise. Those of an unbounded cell begin after
        the incoming ray and end before the outgoing one.
    bounded : bool
        Whether the whole cell is bounded.
    parts : tuple of tuple of ndarray of float64, shape (j, 2)
        The clipped cell: for each part its rings, the outer one first, each without repetition of
        its first corner. Empty if nothing is left, and for an unbounded cell without a clip.
    neighbors : ndarray of int32, shape (j,)
        The sites of the neighboring cells.
    sizes : ndarray of float64, shape (j,)
        Lengths of the edges shared with them.
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
    sizes: Floats
    area: float
    perimeter: float
    centroid: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class PolyhedralCell:
    """One cell of a 3-D diagram.

    Parameters
    ----------
    site : int
        Row of the site.
    vertices : ndarray of float64, shape (k, 3)
        The corners of the clipped cell; without a clip, the vertices of the whole cell.
    bounded : bool
        Whether the whole cell is bounded.
    faces : tuple of ndarray of int32
        The faces, as rows of `vertices`, counter-clockwise as seen from outside. Empty if nothing
        is left, and for an unbounded cell without a clip.
    beyond : ndarray of int32, shape (f,)
        The site on the other side of each face; -1 for a face of the clip.
    neighbors : ndarray of int32, shape (j,)
        The sites of the neighboring cells.
    sizes : ndarray of float64, shape (j,)
        Areas of the faces shared with them.
    volume, area : float
        Of the cell, and of its surface; as in the diagram.
    centroid : ndarray of float64, shape (3,)
        As in the diagram.

    Examples
    --------
    >>> from delone import Voronoi
    >>> grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
    >>> cell = Voronoi(grid).cell(13)
    >>> cell.bounded, len(cell.vertices), [len(face) for face in cell.faces]
    (True, 8, [4, 4, 4, 4, 4, 4])
    """

    site: int
    vertices: Floats
    bounded: bool
    faces: tuple[Indices, ...]
    beyond: Indices
    neighbors: Indices
    sizes: Floats
    volume: float
    area: float
    centroid: Floats


def as_site(i: Any, count: int) -> int:
    """Return the row of one of `count` sites, from 0; negative ones count from the end."""
    try:
        row = operator.index(i)
    except TypeError:
        raise DtypeError(f"i must be the row of a site, got {i!r:.60}") from None
    if not -count <= row < count:
        raise IndexError(f"there is no such site: i must be a row, from 0 to {count - 1}")
    return row % count
