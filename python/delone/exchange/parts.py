"""The parts of a mesh: points, simplices and segments as plain arrays, and their values."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

import numpy as np

from delone._base.arrays import as_points, as_simplices
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices

    Values = Mapping[str, NDArray[Any]]

__all__ = [
    "Given",
    "HasParts",
    "Parts",
    "boundary",
    "boundary_segments",
    "facet_segments",
    "kind_of",
    "parts_of",
    "with_third",
]

_NONE: Values = MappingProxyType({})
# By the numbers of corners and coordinates.
_KINDS = {
    (2, 2): "edges",
    (2, 3): "edges",
    (3, 2): "triangles",
    (3, 3): "surface",
    (4, 3): "tetrahedra",
}
# For simplices of second order, by the number of nodes.
_CORNERS = {3: 2, 6: 3, 10: 4}
# The facet opposite each corner: edges with the triangle to their left, faces seen from outside.
_FACETS = {3: ((1, 2), (2, 0), (0, 1)), 4: ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))}


class Parts(NamedTuple):
    """The arrays of a mesh and the values of its points, simplices and segments."""

    points: Floats  # (n, 2 or 3)
    simplices: Indices  # (m, k): edges, triangles or tetrahedra
    of_points: Values = _NONE  # arrays of length n, as of_simplices are of length m
    of_simplices: Values = _NONE
    # (q, 2): edges of the input, (q, 3) of tetrahedra: faces; None for a mesh without such
    segments: Indices | None = None
    of_segments: Values = _NONE
    crs: str | None = None
    # 2 if simplices and segments have a node in the middle of each edge, after their corners.
    order: int = 1


class HasParts(Protocol):
    """A mesh that describes itself by its parts."""

    @property
    def points(self) -> Floats:
        """The coordinates, (n, d)."""

    @property
    def simplices(self) -> Indices:
        """The simplices, (m, k)."""

    @property
    def npoints(self) -> int:
        """Number of points."""

    @property
    def nsimplex(self) -> int:
        """Number of simplices."""

    def _parts(self) -> Parts:
        """The arrays and their values."""


Given: TypeAlias = "Parts | HasParts | tuple[ArrayLike, ArrayLike]"


def parts_of(mesh: Any) -> Parts:
    """Return the parts of a mesh, or of arrays, which are checked and have no values."""
    if isinstance(mesh, Parts):
        return mesh
    if hasattr(mesh, "_parts"):
        found: Parts = mesh._parts()
        return found
    if hasattr(mesh, "points") and hasattr(mesh, "simplices"):
        return _checked(mesh.points, mesh.simplices)
    if isinstance(mesh, tuple | list) and len(mesh) == 2:
        return _checked(*mesh)
    raise DtypeError(f"a mesh is needed, or a pair (points, simplices), got {mesh!r:.60}")


def _checked(points: ArrayLike, simplices: ArrayLike) -> Parts:
    places = as_points(points)
    width = np.shape(simplices)[-1:] or (0,)
    # Triangles may form a surface; everything else has one more corner than coordinates.
    corners = 3 if width == (3,) else places.shape[1] + 1
    return Parts(places, as_simplices(simplices, len(places), corners - 1))


def kind_of(parts: Parts, *, what: str, kinds: tuple[str, ...] = ()) -> str:
    """Tell what the simplices are, "surface" for triangles in 3-D; raise if that is not in `kinds`.

    `what` is requested; it begins the error message.
    """
    corners, coordinates = parts.simplices.shape[1], parts.points.shape[1]
    if parts.order == 2:
        corners = _CORNERS[corners]
    kind = _KINDS.get((corners, coordinates))
    if kind is None:
        raise InputError(
            f"simplices with {corners} vertices in {coordinates}-D are not a mesh: triangles and "
            "tetrahedra can be converted"
        )
    if kinds and kind not in kinds:
        shown = {"surface": "a surface in 3-D", "edges": "edges"}.get(kind, kind)
        raise InputError(f"{what} cannot be made of {shown}, only of {' or '.join(kinds)}")
    return kind


def with_third(points: Floats) -> Floats:
    """Return a copy of points with a third coordinate, zero if there was none."""
    found = np.zeros((len(points), 3))
    found[:, : points.shape[1]] = points
    return found


def boundary(simplices: Indices) -> Indices:
    """Return the facets, (h, k - 1), of only one triangle or positively oriented tetrahedron.

    Edges have the triangle to their left; faces are counter-clockwise as seen from outside.
    """
    facets = _facets(simplices)
    _, place, count = np.unique(_keys(facets), return_inverse=True, return_counts=True)
    found: Indices = facets[count[place] == 1]
    return found


def facet_segments(parts: Parts) -> tuple[Indices, NDArray[np.int64]]:
    """Return the segments that are edges of triangles, (s, k - 1), and their rows among all.

    Segments in a hole are not edges of triangles, and have no place in finite element meshes. For
    tetrahedra, segments are faces.
    """
    return _segments_among(parts, _facets(parts.simplices))


def boundary_segments(parts: Parts) -> tuple[Indices, NDArray[np.int64]]:
    """Return the segments that are edges of only one triangle, like `facet_segments`."""
    return _segments_among(parts, boundary(parts.simplices))


def _segments_among(parts: Parts, sides: Indices) -> tuple[Indices, NDArray[np.int64]]:
    segments, width = parts.segments, sides.shape[1]
    if segments is None or segments.shape[1] != width:
        return np.empty((0, width), dtype=np.int32), np.empty(0, dtype=np.int64)
    both = _keys(np.concatenate((segments, sides)))
    rows = np.flatnonzero(np.isin(both[: len(segments)], both[len(segments) :]))
    return segments[rows], rows


def _facets(simplices: Indices) -> Indices:
    width = simplices.shape[1]
    found: Indices = simplices[:, _FACETS[width]].reshape(-1, width - 1)
    return found


def _keys(facets: Indices) -> NDArray[np.int64]:
    """A number for each facet, the same for the same corners in any order."""
    corners = np.sort(facets, axis=1).astype(np.int64)
    key = corners[:, 0]
    for column in corners.T[1:]:
        # The numbers so far leave room for the next corner.
        key = np.unique(key, return_inverse=True)[1] * (int(corners.max(initial=0)) + 1) + column
    return key
