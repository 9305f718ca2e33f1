"""What terrain functions need from a surface, which the class TIN provides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._tiling.plane.location import Stretch

__all__ = ["Located", "Sheet", "Surface", "on_surface"]


class Sheet(Protocol):
    """The arrays that the core takes."""

    @property
    def points(self) -> Floats:
        """Vertices, (n, 2)."""

    @property
    def simplices(self) -> Indices:
        """Triangles, (m, 3)."""

    @property
    def neighbors(self) -> Indices:
        """The triangle opposite each vertex, (m, 3)."""

    @property
    def heights(self) -> Floats:
        """Heights of the vertices, (n,)."""


class Located(Protocol):
    """Where points lie."""

    @property
    def simplex(self) -> Indices:
        """The triangle of each point, -1 outside."""

    @property
    def barycentric(self) -> Floats:
        """The weights of its corners."""


class Surface(Protocol):
    """A triangulated surface."""

    @property
    def points(self) -> Floats:
        """Vertices, (n, 2)."""

    @property
    def npoints(self) -> int:
        """Number of vertices."""

    @property
    def z(self) -> Floats:
        """Heights of the vertices, (n,)."""

    @property
    def simplices(self) -> Indices:
        """Triangles, (m, 3)."""

    @property
    def breaklines(self) -> Indices:
        """Edges on lines, (q, 2)."""

    @property
    def soft(self) -> Bools:
        """Which of them are soft, (q,)."""

    @property
    def crs(self) -> str | None:
        """Coordinate reference system."""

    @property
    def units(self) -> str | None:
        """The unit of heights."""

    @property
    def workers(self) -> int | None:
        """Maximum number of threads."""

    @property
    def min_bound(self) -> Floats:
        """The smallest coordinates."""

    @property
    def max_bound(self) -> Floats:
        """The largest coordinates."""

    @property
    def nsimplex(self) -> int:
        """Number of triangles."""

    @property
    def neighbors(self) -> Indices:
        """The triangle opposite each vertex, (m, 3)."""

    @property
    def gradients(self) -> Floats:
        """Gradients of the triangles, (m, 2)."""

    @property
    def slope(self) -> Floats:
        """Slopes of the triangles."""

    @property
    def aspect(self) -> Floats:
        """Directions that the triangles face."""

    def _sheet(self) -> Sheet:
        """The arrays that the core takes."""

    def _left_out(self) -> Indices:
        """Triangles of the hull that are not part of the surface."""

    def heights(self, xy: ArrayLike, *, tolerance: float = 0.0) -> Floats:
        """Heights at positions."""

    def hillshade(self, *, azimuth: float, altitude: float, z_factor: float) -> Floats:
        """Brightness of the triangles."""

    def find_simplex(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Indices:
        """The triangles at positions."""

    def nearest(self, xi: ArrayLike) -> Indices:
        """The vertices that are nearest to positions."""

    def locate(self, xi: ArrayLike, *, tolerance: float = 0.0) -> Located:
        """Triangles and weights at positions."""

    @property
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull."""

    def _stretches(self, a: Floats, b: Floats) -> list[Stretch]:
        """The triangles of the hull along a segment, in parts that are on the surface or not."""

    def _tiling(self) -> tuple[Indices, Indices]:
        """The triangles of the convex hull, and their neighbors."""


def on_surface(tin: Surface) -> Bools:
    """Return which points are corners of triangles; all points if there are no triangles.

    With a boundary, other points may be outside the surface.
    """
    used = np.zeros(tin.npoints, dtype=bool)
    used[tin.simplices] = True
    return used if used.any() else ~used
