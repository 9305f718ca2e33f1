"""Triangles as sets, for comparison in any order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.uneven import uneven
from delone.errors import DtypeError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def triangle_set(simplices: ArrayLike) -> set[tuple[int, int, int]]:
    """Return triangles as a set of triples, each rotated so that its smallest vertex is first.

    Parameters
    ----------
    simplices : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    set of tuple of int
        Two arrays have equal sets if they contain the same triangles with the same orientation, in
        any order and starting at any vertex.

    Raises
    ------
    ShapeError, DtypeError
        `simplices` is neither an integer array of shape (m, 3) nor empty.

    Examples
    --------
    >>> from delone.testing import triangle_set
    >>> sorted(triangle_set([(3, 2, 0), (1, 2, 3)]))
    [(0, 3, 2), (1, 2, 3)]
    """
    return set(_turned(simplices, "simplices"))


def same_triangles(a: ArrayLike, b: ArrayLike) -> bool:
    """Return whether two arrays contain the same triangles with the same orientation.

    Parameters
    ----------
    a, b : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    bool
        Also False if a triangle occurs more often in one of them than in the other.

    Raises
    ------
    ShapeError, DtypeError
        `a` or `b` is neither an integer array of shape (m, 3) nor empty.

    Examples
    --------
    >>> from delone.testing import same_triangles
    >>> same_triangles([(0, 1, 2), (0, 2, 3)], [(2, 3, 0), (1, 2, 0)])
    True
    """
    return sorted(_turned(a, "a")) == sorted(_turned(b, "b"))


def same_tetrahedra(a: ArrayLike, b: ArrayLike) -> bool:
    """Return whether two arrays contain the same tetrahedra with the same orientation.

    Parameters
    ----------
    a, b : array_like of int, shape (m, 4)
        Vertices of the tetrahedra.

    Returns
    -------
    bool
        Also False if a tetrahedron occurs more often in one of them than in the other.

    Raises
    ------
    ShapeError, DtypeError
        `a` or `b` is neither an integer array of shape (m, 4) nor empty.

    Examples
    --------
    >>> from delone.testing import same_tetrahedra
    >>> same_tetrahedra([(0, 1, 2, 3)], [(2, 0, 1, 3)])
    True
    >>> same_tetrahedra([(0, 1, 2, 3)], [(1, 0, 2, 3)])
    False
    """
    return _even(a, "a") == _even(b, "b")


def _even(simplices: ArrayLike, name: str) -> list[tuple[int, ...]]:
    """Tetrahedra with ascending vertices; an odd permutation exchanges the last two."""
    array = _rows(simplices, name, 4)
    pairs = [(i, j) for i in range(4) for j in range(i + 1, 4)]
    odd = sum((array[:, i] > array[:, j]).astype(int) for i, j in pairs) % 2 == 1
    turned = np.sort(array, axis=1)
    turned[odd] = turned[odd][:, [0, 1, 3, 2]]
    return sorted(map(tuple, turned.tolist()))


def _turned(simplices: ArrayLike, name: str) -> list[tuple[int, int, int]]:
    """Triangles as triples, each starting at its smallest vertex."""
    triangles = _rows(simplices, name, 3)
    start = triangles.argmin(axis=1)[:, None]
    turned = np.take_along_axis(triangles, (start + np.arange(3)) % 3, axis=1)
    return [(a, b, c) for a, b, c in turned.tolist()]


def _rows(simplices: ArrayLike, name: str, width: int) -> NDArray[np.integer]:
    try:
        array = np.asarray(simplices)
    except ValueError as error:
        raise ShapeError(uneven(simplices, name)) from error
    if array.shape in ((0,), (0, width)):
        return np.empty((0, width), dtype=np.int64)
    if array.ndim != 2 or array.shape[1] != width:
        raise ShapeError(f"{name} must have shape (m, {width}), got {array.shape}")
    if array.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers, got dtype {array.dtype}")
    return array
