"""What differs between triangulations of different dimensions: one table of functions for each.

`plane` contains the table for triangles in 2-D, `space` that for tetrahedra in 3-D, and `higher`
those for simplices in four to eight dimensions. `triangulation` calls them; no other module checks
the number of coordinates.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone._tiling.measures import Measures

__all__ = ["FLAT_OR_SOLID", "Dimension", "Locator", "absent", "only"]


class Locator(Protocol):
    """The index of the core for point location; any number of threads may use one."""

    def find(self, xi: Floats, workers: int) -> Indices:
        """Return the simplices that contain points."""

    def nearest(self, xi: Floats, workers: int) -> Indices:
        """Return the vertices nearest to points; the simplices must be Delaunay."""


@dataclass(frozen=True)
class Dimension:
    """The functions of one dimension, with the same names in each; a last int is `workers`."""

    ndim: int
    simplex: str
    # Facets with a simplex on one side, of simplices and neighbors.
    boundary: Callable[[Indices, Indices], Indices]
    # Vertices of the boundary.
    hull: Callable[[Floats, Indices], NDArray[np.int64]]
    # Every triangle once; also takes the number of points.
    faces: Callable[[Indices, Indices, int, int | None], Indices]
    # The shapes of points and simplices.
    quality: Callable[[Floats, Indices, int | None], Measures]
    # The index for point location.
    locator: Callable[[Floats, Indices, Indices], Any]
    # Simplices, their weights, simplices beside, facets of the boundary, weights of their corners.
    located: Callable[[Any, Floats, int], tuple[Indices, Floats, Indices, Indices, Floats]]
    # Points of facets by the weights of their corners.
    on_facets: Callable[[Floats, Indices, Floats], Floats]
    # Simplices and neighbors; None if the index finds nearest vertices in any triangulation.
    delaunay: Callable[[Floats, int], tuple[Indices, Indices]] | None


F = TypeVar("F", bound="Callable[..., Any]")

# Dimensions that are not listed individually.
_MANY = 3
# The number of dimensions beyond which other libraries have no cells.
_SPACE = 3
# Dimensions with plots, mesh files and measures of shape.
FLAT_OR_SOLID = (2, 3)


def absent(*_: Any) -> Any:
    """Replace a function that a dimension does not have; `only` hides its attributes."""
    raise NotImplementedError


def only(
    ndim: int | tuple[int, ...], instead: str, *, beyond: str | None = None
) -> Callable[[F], F]:
    """Restrict a method, or the getter of a property, to instances of one or several dimensions.

    In other dimensions, the attribute does not exist, not even for ``hasattr``; the error says what
    to use `instead`, and in more than three dimensions what to use `beyond` these.
    """

    def decorate(method: F) -> F:
        found: Any = _Only(method, (ndim,) if isinstance(ndim, int) else ndim, instead, beyond)
        return found  # type: ignore[no-any-return]

    return decorate


class _Only:
    """A method that instances of other dimensions do not have."""

    def __init__(
        self, method: Callable[..., Any], ndim: tuple[int, ...], instead: str, beyond: str | None
    ) -> None:
        functools.update_wrapper(self, method)
        self._method, self._ndim, self._instead, self._beyond = method, ndim, instead, beyond

    def __get__(self, owner: Any, kind: type | None = None) -> Any:
        if owner is None:
            return self._method
        self._check(owner)
        return self._method.__get__(owner, kind)

    def __call__(self, owner: Any, *args: Any, **kwargs: Any) -> Any:
        self._check(owner)
        return self._method(owner, *args, **kwargs)

    def _check(self, owner: Any) -> None:
        # Classes without a number of coordinates, such as those of the sphere, are drawn in 2-D or
        # 3-D.
        if getattr(owner, "ndim", self._ndim[0]) not in self._ndim:
            name = self._method.__name__
            where = " and ".join(f"{d}-D" for d in self._ndim[:2])
            where = where if len(self._ndim) < _MANY else f"{self._ndim[0]}-D and more dimensions"
            far = self._beyond is not None and owner.ndim > _SPACE
            message = f"{name} is only available in {where}: "
            message += str(self._beyond if far else self._instead)
            raise AttributeError(message, name=name, obj=owner)
