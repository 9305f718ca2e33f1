"""Validation of triangulations of directions, listing the elements that are wrong.

Signs are exact. What they prove: triangles with positive determinants, and cones from the direction
opposite a place to the boundary edges that have the place on their left, are a closed surface that
covers all directions equally often; the place is in one triangle, so each direction is covered
once. Edges are locally Delaunay and the boundary turns left, so the surface is the convex hull.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from delone._tiling.plane import topology
from delone.constrained.validation import OfSegments, bent_rows, uncovered_rows
from delone.sphere.exact import circles, cross, dot, turns, turns_at, whole
from delone.validation import ValidationReport, fault

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._core import ConstrainedTriangulation
    from delone.validation import Sentences

    Rows = NDArray[np.integer]

__all__ = ["ConstrainedSphereReport", "SphereReport", "validate", "validate_constrained"]


@dataclass(frozen=True, eq=False, kw_only=True)
class SphereReport(ValidationReport):
    """The result of ``validate()`` of triangulations of directions: truthy if they are correct.

    Every field is an array of faulty elements, which is empty if there are none. If orientations,
    edges, neighbors, `missing`, `repeats` or `count` are wrong, the others are not examined.

    Parameters
    ----------
    orientation, edges, neighbors, missing, delaunay, ties, count : ndarray of int
        As in `ValidationReport`.
    hull : ndarray of int, shape (k, 2)
        Boundary edges behind which the boundary turns right, or that have the middle of the first
        triangle on their right.
    repeats : ndarray of int, shape (k,)
        Rows of duplicates whose direction is not that of their vertex.
    overlaps : ndarray of int, shape (k,)
        Other triangles that contain the middle of the first one.

    Attributes
    ----------
    ok : bool
        True if there are no faults.

    Examples
    --------
    >>> from delone import sphere
    >>> mesh = sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90), (-135, -35)])
    >>> print(mesh.validate())
    a canonical Delaunay triangulation of directions
    """

    overlaps: Rows = fault("triangle overlaps the first one", "triangles overlap the first one")

    _SUBJECT: ClassVar[str] = "a canonical Delaunay triangulation of directions"
    _SAID: ClassVar[Sentences] = {
        "orientation": (
            "triangle is not counter-clockwise seen from outside",
            "triangles are not counter-clockwise seen from outside",
        ),
        "repeats": (
            "duplicate has a different direction from its vertex",
            "duplicates have different directions from their vertices",
        ),
    }


@dataclass(frozen=True, eq=False, kw_only=True)
class ConstrainedSphereReport(OfSegments, SphereReport):
    """The result of ``sphere.ConstrainedDelaunay.validate()``: truthy if it is correct.

    The fields of `SphereReport` mean the same as there, but `delaunay` and `ties` leave out pairs
    of triangles with a subsegment between them.

    Parameters
    ----------
    orientation, edges, neighbors, hull, missing, repeats, delaunay, ties, count, overlaps : ndarray
        As in `SphereReport`.
    flags : ndarray of int, shape (k,)
        Triangles with an edge that is flagged as part of an arc but is not, or the reverse.
    absent : ndarray of int, shape (k, 2)
        Subsegments that are not edges of triangles.
    uncovered : ndarray of int, shape (k,)
        Rows of segments whose subsegments do not form a path from one end to the other.
    bent : ndarray of int, shape (k, 2)
        Rows of segments, and vertices on their paths that are not exactly on the arc. Rows through
        crossings may bend, because these are rounded; so may rows that a bent row crosses.

    Attributes
    ----------
    ok : bool
        True if there are no faults.

    Examples
    --------
    >>> from delone import sphere
    >>> sites = [(0, 0), (90, 0), (0, 90), (-135, -35)]
    >>> print(sphere.ConstrainedDelaunay(lonlat=sites, segments=[(0, 3)]).validate())
    a canonical constrained Delaunay triangulation of directions
    """

    _SUBJECT: ClassVar[str] = "a canonical constrained Delaunay triangulation of directions"


def validate(
    vectors: Floats, units: Floats, simplices: Indices, neighbors: Indices, duplicates: Indices
) -> SphereReport:
    """Check the triangles of directions; `units` are the rounded unit vectors."""
    return SphereReport(**_faults(vectors, units, (simplices, neighbors, duplicates), None))


def validate_constrained(
    vectors: Floats, units: Floats, made: ConstrainedTriangulation, ends: Indices, added: int
) -> ConstrainedSphereReport:
    """Check triangles and arcs; `ends`, (s, 2), are those of the input segments.

    The last `added` directions are crossings.
    """
    tail, head = made.simplices[:, [1, 2, 0]], made.simplices[:, [2, 0, 1]]
    edges = topology.edge_keys(tail, head, len(vectors))
    keys = topology.edge_keys(made.segments[:, 0], made.segments[:, 1], len(vectors))
    wanted = topology.among(edges, keys)

    def is_off(first: Indices, last: Indices, vertex: Indices) -> Bools:
        return _is_off(vectors, first, last, vertex)

    return ConstrainedSphereReport(
        **_faults(vectors, units, (made.simplices, made.neighbors, made.duplicates), wanted),
        flags=np.flatnonzero((wanted != made.constrained).any(axis=1)),
        absent=made.segments[~topology.among(keys, edges.ravel())],
        uncovered=uncovered_rows(made, ends, len(vectors)),
        bent=bent_rows(made, ends, len(vectors), len(vectors) - added, is_off),
    )


def _faults(
    vectors: Floats, units: Floats, arrays: tuple[Indices, Indices, Indices], exempt: Bools | None
) -> dict[str, Rows]:
    """Return the fields of a report; edges marked as exempt, (m, 3), are not checked."""
    simplices, neighbors, duplicates = arrays
    faults = _faults_of_topology(simplices, neighbors, len(vectors), duplicates)
    corners = [vectors[simplices[:, k]] for k in range(3)]
    faults["orientation"] = np.flatnonzero(turns(*corners) <= 0)
    faults["repeats"] = duplicates[~_same(vectors, duplicates), 0]
    if any(len(each) for each in faults.values()):
        return faults
    middle = _middle(vectors[simplices[0]])
    return faults | {
        "hull": _off_hull(vectors, units, topology.boundary_edges(simplices, neighbors), middle),
        "overlaps": _overlaps(vectors, units, simplices, middle),
        **_faults_of_circles(vectors, units, simplices, neighbors, exempt),
    }


def _faults_of_topology(
    simplices: Indices, neighbors: Indices, npoints: int, duplicates: Indices
) -> dict[str, Rows]:
    tail, head = (simplices[:, k].ravel().astype(np.int64) for k in ([1, 2, 0], [2, 0, 1]))
    keys = np.sort(tail * npoints + head)
    twice = np.unique(keys[1:][keys[1:] == keys[:-1]])
    faults: dict[str, Rows] = {"edges": np.column_stack(np.divmod(twice, npoints))}
    if not len(twice):
        expected = topology.neighbors(simplices, npoints)
        faults["neighbors"] = np.flatnonzero((expected != neighbors).any(axis=1))
    is_missing = np.ones(npoints, dtype=bool)
    is_missing[simplices] = is_missing[duplicates[:, 0]] = False
    faults["missing"] = np.flatnonzero(is_missing)
    h = int((neighbors < 0).sum())
    expected_count = 2 * (npoints - len(duplicates)) - (h + 2 if h else 4)
    if expected_count != len(simplices):
        faults["count"] = np.array([expected_count, len(simplices)])
    return faults


def _same(vectors: Floats, rows: Indices) -> Bools:
    """Return whether both of each pair of rows have the same direction."""
    pairs = [[whole(vectors[v].tolist()) for v in pair] for pair in rows.tolist()]
    return np.array([a == b for a, b in pairs], dtype=bool)


def _middle(corners: Floats) -> tuple[int, int, int]:
    """Return integers inside a triangle: the sum of its corners, of similar lengths."""
    parts = [whole(vector) for vector in corners.tolist()]
    sizes = [max(map(abs, part)) for part in parts]
    scaled = [
        [x * (max(sizes) // size) for x in part] for part, size in zip(parts, sizes, strict=True)
    ]
    x, y, z = (sum(coordinates) for coordinates in zip(*scaled, strict=True))
    return x, y, z


def _off_hull(
    vectors: Floats, units: Floats, boundary: Indices, middle: tuple[int, int, int]
) -> Indices:
    """Return boundary edges with the middle on their right, or followed by a right turn."""
    if not len(boundary):
        return boundary
    wrong = turns_at(vectors, units, boundary, middle) <= 0
    order = np.argsort(boundary[:, 0])
    place = np.minimum(np.searchsorted(boundary[order, 0], boundary[:, 1]), len(order) - 1)
    after = boundary[order[place], 1]
    wrong |= turns(*(vectors[v] for v in (boundary[:, 0], boundary[:, 1], after))) < 0
    return boundary[wrong]


def _overlaps(
    vectors: Floats, units: Floats, simplices: Indices, middle: tuple[int, int, int]
) -> Rows:
    """Return the triangles other than the first that contain its middle."""
    rows = np.arange(1, len(simplices))
    for k in range(3):
        edges = simplices[rows][:, [k, (k + 1) % 3]]
        rows = rows[turns_at(vectors, units, edges, middle) >= 0]
    return rows


def _faults_of_circles(
    vectors: Floats, units: Floats, simplices: Indices, neighbors: Indices, exempt: Bools | None
) -> dict[str, Rows]:
    """Return the pairs of triangles that are not locally Delaunay, and those with wrong ties."""
    checked = neighbors > np.arange(len(neighbors))[:, None]
    if exempt is not None:
        checked &= ~exempt
    t, k = np.nonzero(checked)
    beside = neighbors[t, k]
    corner = (neighbors[beside] == t[:, None]).argmax(axis=1)
    four = np.column_stack((simplices[t], simplices[beside, corner]))
    plain, broken = circles(vectors, units, four)
    pairs = np.column_stack((t, beside))
    return {"delaunay": pairs[plain > 0], "ties": pairs[(plain == 0) & (broken > 0)]}


def _is_off(vectors: Floats, first: Indices, last: Indices, vertex: Indices) -> Bools:
    """Return which directions are not on the shorter arc between two others."""
    off: Bools = turns(vectors[first], vectors[last], vectors[vertex]) != 0
    for row in np.flatnonzero(~off & (vertex != first) & (vertex != last)).tolist():
        a, b, x = (whole(vectors[each[row]].tolist()) for each in (first, last, vertex))
        normal = cross(a, b)
        off[row] = dot(cross(normal, a), x) < 0 or dot(cross(normal, b), x) > 0
    return off
