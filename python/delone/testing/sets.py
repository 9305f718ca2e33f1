"""Triangles as sets, for comparison whatever their order."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone.errors import DtypeError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def triangle_set(simplices: ArrayLike) -> set[tuple[int, int, int]]:
    """Return triangles as a set of triples, each turned so that its smallest vertex is first.

    Parameters
    ----------
    simplices : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    set of tuple of int
        Two arrays give the same set when they hold the same triangles with the same orientation,
        in whatever order and from whichever vertex on.

    Raises
    ------
    ShapeError, DtypeError
        `simplices` is no array of integers of shape (m, 3), nor empty.

    Examples
    --------
    >>> from delone.testing import triangle_set
    >>> sorted(triangle_set([(3, 2, 0), (1, 2, 3)]))
    [(0, 3, 2), (1, 2, 3)]
    """
    return set(_turned(simplices, "simplices"))


def same_triangles(a: ArrayLike, b: ArrayLike) -> bool:
    """Tell whether two arrays hold the same triangles with the same orientation.

    Parameters
    ----------
    a, b : array_like of int, shape (m, 3)
        Vertices of the triangles.

    Returns
    -------
    bool
        False also where one of them holds a triangle more often than the other.

    Raises
    ------
    ShapeError, DtypeError
        `a` or `b` is no array of integers of shape (m, 3), nor empty.

    Examples
    --------
    >>> from delone.testing import same_triangles
    >>> same_triangles([(0, 1, 2), (0, 2, 3)], [(2, 3, 0), (1, 2, 0)])
    True
    """
    return sorted(_turned(a, "a")) == sorted(_turned(b, "b"))


def _turned(simplices: ArrayLike, name: str) -> list[tuple[int, int, int]]:
    """Triangles as triples, each from its smallest vertex on."""
    try:
        triangles = np.asarray(simplices)
    except ValueError as error:
        raise ShapeError(f"{name} has rows of unequal length: {error}") from error
    if triangles.shape in ((0,), (0, 3)):
        return []
    if triangles.ndim != 2 or triangles.shape[1] != 3:
        raise ShapeError(f"{name} must have shape (m, 3), got {triangles.shape}")
    if triangles.dtype.kind not in "iu":
        raise DtypeError(f"{name} must hold integers, got dtype {triangles.dtype}")
    start = triangles.argmin(axis=1)[:, None]
    turned = np.take_along_axis(triangles, (start + np.arange(3)) % 3, axis=1)
    return [(a, b, c) for a, b, c in turned.tolist()]
