"""What an object must have to be drawn: protocols instead of delone's classes."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = [
    "Cells2",
    "Cells3",
    "Hull2",
    "Hulled",
    "Linked",
    "Periodic",
    "Segmented",
    "Simplices",
    "Triangles",
    "has",
    "hint",
    "is_quality_mesh",
    "kind_of",
    "segmented",
]


class Simplices(Protocol):
    """Points and the simplices between them."""

    @property
    def points(self) -> Floats:
        """Coordinates, (n, d)."""

    @property
    def simplices(self) -> Indices:
        """Rows of `points`, (m, k)."""


class Triangles(Simplices, Protocol):
    """A 2-D triangulation."""

    @property
    def npoints(self) -> int:
        """Number of points."""

    @property
    def nsimplex(self) -> int:
        """Number of triangles."""

    @property
    def edges(self) -> Indices:
        """The edges, (e, 2)."""

    @property
    def circumcenters(self) -> Floats:
        """The center of the circle through the corners of each triangle, (m, 2)."""

    @property
    def min_bound(self) -> Floats:
        """The smallest coordinates, (2,)."""

    @property
    def max_bound(self) -> Floats:
        """The largest coordinates, (2,)."""

    def find_simplex(self, xi: Any, /) -> Any:
        """Return the triangle that contains each point, -1 outside."""


class Hulled(Triangles, Protocol):
    """A 2-D triangulation that fills the convex hull of its points."""

    @property
    def hull(self) -> NDArray[np.integer[Any]]:
        """The vertices on the convex hull, counterclockwise, (h,)."""


class Segmented(Triangles, Protocol):
    """A 2-D triangulation with segments and regions."""

    @property
    def neighbors(self) -> Indices:
        """The triangle opposite each corner, (m, 3); -1 outside."""

    @property
    def constrained(self) -> NDArray[np.bool_]:
        """Which edges are on segments, (m, 3)."""

    @property
    def segments(self) -> Indices:
        """The subsegments, (s, 2)."""

    @property
    def region(self) -> NDArray[Any]:
        """The label of each triangle, (m,); negative for no label."""

    @property
    def areas(self) -> Floats:
        """The areas of the triangles, (m,)."""


class Outlined(Protocol):
    """The triangles of a 2-D triangulation that are kept."""

    @property
    def points(self) -> Floats:
        """Coordinates, (n, 2)."""

    @property
    def simplices(self) -> Indices:
        """The triangles, (k, 3)."""

    @property
    def is_kept(self) -> NDArray[np.bool_]:
        """Whether each triangle of the triangulation is kept, (m,)."""

    @property
    def boundary(self) -> Indices:
        """The edges with a triangle on one side only, (b, 2)."""


class Hull2(Protocol):
    """A 2-D convex hull."""

    @property
    def points(self) -> Floats:
        """Coordinates, (n, 2)."""

    @property
    def vertices(self) -> Indices:
        """The extreme points, counterclockwise, (v,)."""


class Linked(Protocol):
    """A graph."""

    @property
    def points(self) -> Floats:
        """Coordinates, (n, d)."""

    @property
    def edges(self) -> Indices:
        """Rows of `points`, (m, 2)."""

    @property
    def lengths(self) -> Floats:
        """The lengths of the edges, (m,)."""


class Periodic(Protocol):
    """A periodic 2-D triangulation."""

    @property
    def points(self) -> Floats:
        """The points of one period, (n, 2)."""

    @property
    def periods(self) -> tuple[float | None, float | None]:
        """The periods in x and y; None for a direction without a period."""

    @property
    def corners(self) -> Floats:
        """The corners of the triangles, (m, 3, 2)."""


class Cells2(Protocol):
    """A 2-D Voronoi diagram."""

    @property
    def points(self) -> Floats:
        """The sites, (n, 2)."""

    @property
    def npoints(self) -> int:
        """Number of sites."""

    @property
    def weights(self) -> Floats | None:
        """The weights of the sites, (n,); None without weights."""

    @property
    def clip(self) -> Any:
        """Where cells end: a box, a geometry with ``bounds``, or None."""

    @property
    def periods(self) -> tuple[float | None, float | None] | None:
        """The periods in x and y; None without periods."""

    @property
    def duplicate_of(self) -> Indices:
        """The first row with the same coordinates, (n,)."""

    @property
    def hidden(self) -> Indices:
        """The rows without a cell."""

    def cell(self, i: int, /) -> Any:
        """Return the cell of a site, whose ``parts`` are tuples of rings."""


class Cells3(Protocol):
    """A 3-D Voronoi diagram."""

    @property
    def points(self) -> Floats:
        """The sites, (n, 3)."""

    def to_pyvista(self) -> Any:
        """Return the cells as polyhedra."""


def has(thing: Any, *names: str) -> bool:
    """Tell whether an object has all of these attributes, without computing any."""
    missing = object()
    return all(inspect.getattr_static(thing, name, missing) is not missing for name in names)


def segmented(mesh: Triangles) -> Segmented | None:
    """Return the triangulation itself if it has segments and regions, else None."""
    names = ("region", "segments", "constrained", "neighbors", "areas")
    return cast("Segmented", mesh) if has(mesh, *names) else None


def is_quality_mesh(mesh: Any) -> bool:
    """Tell whether an object is a quality mesh, that is, plots its own angles."""
    return has(mesh, "plot_quality")


def kind_of(thing: Any) -> str:
    """Tell what an object is drawn as; "" for anything else.

    Triangular surfaces in 3-D are also "tetrahedra".
    """
    d, corners = (_columns(thing, name) for name in ("points", "simplices"))
    if has(thing, "edges", "lengths") and not corners:
        return {2: "graph2", 3: "graph3"}.get(d, "")
    if has(thing, "ridge_points", "cell"):
        return {2: "cells2", 3: "cells3"}.get(d, "")
    if d == 2 and has(thing, "is_kept", "boundary"):
        return "kept"
    if d == 2 and corners == 3:
        if has(thing, "periods", "corners"):
            return "periodic"
        return "triangles" if has(thing, "edges", "min_bound", "find_simplex") else ""
    is_hull = d == corners == 2 and has(thing, "vertices")
    is_solid = d == 3 and corners in (3, 4)
    return "hull" if is_hull else "tetrahedra" if is_solid else ""


def hint(thing: Any) -> str:
    """Return what to do instead of drawing an object that cannot be drawn."""
    return "use its own plot()" if hasattr(thing, "plot") else "draw delone.Delaunay(points)"


def _columns(thing: Any, name: str) -> int:
    """Return the number of columns of an attribute, 0 if it is not a table."""
    shape: tuple[int, ...] = np.shape(getattr(thing, name)) if has(thing, name) else ()
    return shape[1] if len(shape) == 2 else 0
