"""What differs between triangulations of one dimension and another: one table of functions each.

`delone.plane` has the table of triangles in 2-D, `delone.space` that of tetrahedra in 3-D.
`delone.triangulation` calls them; no other place asks how many coordinates there are.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ParamSpec, Protocol, TypeVar

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
    delaunay : callable
        Simplices and neighbors of the Delaunay triangulation, of points and workers.
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
    delaunay: Callable[[Floats, int], tuple[Indices, Indices]]


P = ParamSpec("P")
T = TypeVar("T")


def only(ndim: int, instead: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Give an attribute to objects of one dimension.

    Parameters
    ----------
    ndim : int
        The number of coordinates that it needs.
    instead : str
        What to use in other dimensions.

    Returns
    -------
    callable
        A decorator of getters and methods. In other dimensions they raise an AttributeError, so
        that ``hasattr`` is right about properties.
    """

    def decorate(method: Callable[P, T]) -> Callable[P, T]:
        @functools.wraps(method)
        def checked(*args: P.args, **kwargs: P.kwargs) -> T:
            owner: Any = args[0]
            if owner.ndim != ndim:
                raise AttributeError(
                    f"{method.__name__} is only available in {ndim}-D: {instead}", obj=owner
                )
            return method(*args, **kwargs)

        return checked

    return decorate
