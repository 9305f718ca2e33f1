"""What differs between triangulations of one dimension and another: one table of functions each.

`delone.plane` has the table of triangles in 2-D, `delone.space` that of tetrahedra in 3-D.
`delone.triangulation` calls them; no other place asks how many coordinates there are.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from delone.measures import Measures

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Dimension", "Locator", "only"]


class Locator(Protocol):
    """The index of the core for point location; any number of threads may use one."""

    def find(self, xi: Floats, workers: int) -> Indices:
        """Return the simplices that hold points."""

    def nearest(self, xi: Floats, workers: int) -> Indices:
        """Return the vertices nearest to points; the simplices must be Delaunay."""


@dataclass(frozen=True)
class Dimension:
    """The functions of one dimension, by one name each in all of them.

    Parameters
    ----------
    ndim : int
        Number of coordinates.
    simplex : str
        What a simplex is called.
    boundary : callable
        Facets with a simplex on one side, of simplices and neighbors.
    hull : callable
        Vertices of the boundary, of points and boundary.
    edges : callable
        Every edge once, of simplices, neighbors, the number of points and workers.
    faces : callable
        Every triangle once, of the same.
    sizes, circumcenters, transform : callable
        Areas or volumes, centers and affine maps, of points, simplices and workers.
    quality : callable
        The measures of shape, of points, simplices and workers.
    locator : callable
        The index for point location, of points, simplices and neighbors.
    located : callable
        Where points lie, of the index, points and workers: simplices, their weights, the simplices
        beside, facets of the boundary, and weights of their corners.
    on_facets : callable
        Points of facets, of points, facets and the weights of their corners.
    delaunay : callable or None
        Simplices and neighbors of the Delaunay triangulation, of points and workers; None if the
        index finds the nearest vertex in any triangulation.
    """

    ndim: int
    simplex: str
    boundary: Callable[[Indices, Indices], Indices]
    hull: Callable[[Floats, Indices], NDArray[np.int64]]
    edges: Callable[[Indices, Indices, int, int | None], Indices]
    faces: Callable[[Indices, Indices, int, int | None], Indices]
    sizes: Callable[[Floats, Indices, int | None], Floats]
    circumcenters: Callable[[Floats, Indices, int | None], Floats]
    transform: Callable[[Floats, Indices, int | None], Floats]
    quality: Callable[[Floats, Indices, int | None], Measures]
    locator: Callable[[Floats, Indices, Indices], Any]
    located: Callable[[Any, Floats, int], tuple[Indices, Floats, Indices, Indices, Floats]]
    on_facets: Callable[[Floats, Indices, Floats], Floats]
    delaunay: Callable[[Floats, int], tuple[Indices, Indices]] | None


F = TypeVar("F", bound="Callable[..., Any]")


def only(ndim: int, instead: str) -> Callable[[F], F]:
    """Give a method, or the getter of a property, to objects of one dimension.

    Parameters
    ----------
    ndim : int
        The number of coordinates that it needs.
    instead : str
        What to use in other dimensions.

    Returns
    -------
    callable
        A decorator. In other dimensions the attribute does not exist, also for ``hasattr``.
    """

    def decorate(method: F) -> F:
        found: Any = _Only(method, ndim, instead)
        return found  # type: ignore[no-any-return]

    return decorate


class _Only:
    """A method that objects of other dimensions do not have."""

    def __init__(self, method: Callable[..., Any], ndim: int, instead: str) -> None:
        functools.update_wrapper(self, method)
        self._method, self._ndim, self._instead = method, ndim, instead

    def __get__(self, owner: Any, kind: type | None = None) -> Any:
        if owner is None:
            return self._method
        self._check(owner)
        return self._method.__get__(owner, kind)

    def __call__(self, owner: Any, *args: Any, **kwargs: Any) -> Any:
        self._check(owner)
        return self._method(owner, *args, **kwargs)

    def _check(self, owner: Any) -> None:
        if owner.ndim != self._ndim:
            name = self._method.__name__
            message = f"{name} is only available in {self._ndim}-D: {self._instead}"
            raise AttributeError(message, name=name, obj=owner)
