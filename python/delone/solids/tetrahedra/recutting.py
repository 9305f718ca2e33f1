"""Retriangulation of flat parts: edges between triangles in one plane are flipped.

In each flat part the result is its constrained Delaunay triangulation, with all vertices and all
edges to other planes. Edges of 3-D Delaunay triangulations are also Delaunay in each plane, so
fewer of these triangles have to be recovered than of others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone.solids.tetmesh.planes import PLANES

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.solids.tetrahedra.covering import Parts

__all__ = ["Recut", "recut", "uncut"]


class Recut(NamedTuple):
    """Parts after flips, and what they replace."""

    # Row by row; the source of parts that flips join is the first of these.
    before: Parts
    parts: Parts
    # (k,): rows whose sources were joined.
    rows: Rows

    def reported(self, there: Bools) -> dict[str, NDArray[np.int64]]:
        """Return the entries of a report for the parts `there`, which flips do not change."""
        rows = self.rows[there[self.rows]]
        sources = np.column_stack((self.before.source[rows], self.parts.source[rows]))
        return {
            "recut": self.before.faces[rows].astype(np.int64),
            "recut_source": sources.astype(np.int64),
        }


class _Edges(NamedTuple):
    """Edges from a to b of a triangle t with the corner c, and back of u with the corner d."""

    t: Rows
    u: Rows
    a: Indices
    b: Indices
    c: Indices
    d: Indices

    def at(self, rows: Rows | Bools) -> _Edges:
        t, u, a, b, c, d = self
        return _Edges(t[rows], u[rows], a[rows], b[rows], c[rows], d[rows])


def recut(points: Floats, parts: Parts, markers: Indices) -> Recut:
    """Triangulate each plane part again.

    Triangles are joined across edges of exactly two of them, which are in one plane, oriented
    alike, with the same marker and the same cover. An edge that is flipped never returns, as in
    all Delaunay triangulations by flips, so this terminates; ties are broken as in 3-D, so the
    result is unique.
    """
    npoints = len(points)
    soft = _soft(points, parts, markers)
    dirty = np.zeros(len(parts.faces), dtype=bool)
    dirty[soft.t] = dirty[soft.u] = True
    rows = np.flatnonzero(dirty)
    faces = parts.faces.copy()
    locked = np.setdiff1d(_keys(faces[rows], npoints)[0], _key(soft.a, soft.b, npoints))
    joined = [np.empty((0, 2), dtype=np.int32)]
    while True:
        edges = _pairs(faces[rows], npoints)
        edges = edges._replace(t=rows[edges.t], u=rows[edges.u])
        edges = edges.at(dirty[edges.t] | dirty[edges.u])
        edges = edges.at(~_among(_key(edges.a, edges.b, npoints), locked))
        wrong = edges.at(_is_wrong(points, edges))
        if not len(wrong.t):
            return _result(parts, faces, np.concatenate(joined))
        dirty[:] = False
        dirty[wrong.t] = dirty[wrong.u] = True
        flipped = wrong.at(_apart(wrong, len(faces)))
        faces[flipped.t] = np.column_stack((flipped.c, flipped.a, flipped.d))
        faces[flipped.u] = np.column_stack((flipped.d, flipped.b, flipped.c))
        joined.append(np.column_stack((flipped.t, flipped.u)).astype(np.int32))


def _soft(points: Floats, parts: Parts, markers: Indices) -> _Edges:
    """Return edges that may be flipped, if their triangles have that shape."""
    edges = _pairs(parts.faces, len(points))
    for value in (markers[parts.source], parts.number, parts.net):
        edges = edges.at(value[edges.t] == value[edges.u])
    corners = (points[v] for v in (edges.a, edges.b, edges.c, edges.d))
    return edges.at(_core.orient3d(*corners) == 0)


def _pairs(faces: Indices, npoints: int) -> _Edges:
    """Return edges of exactly two triangles that pass them in opposite directions, by vertices."""
    keys, forward = _keys(faces, npoints)
    order = np.lexsort((~forward, keys))
    keys, forward = keys[order], forward[order]
    starts = np.flatnonzero(np.diff(keys, prepend=-1))
    two = starts[np.diff(starts, append=len(keys)) == 2]
    two = two[forward[two] & ~forward[two + 1]]
    first, second = order[two], order[two + 1]
    # Half-edge k * m + t is opposite the corner k of triangle t.
    count = max(len(faces), 1)
    t, u = first % count, second % count
    i, j = first // count, second // count
    return _Edges(t, u, faces[t, i - 2], faces[t, i - 1], faces[t, i], faces[u, j])


def _keys(faces: Indices, npoints: int) -> tuple[Rows, Bools]:
    """Return a number for each edge, and whether it goes from the smaller vertex to the larger."""
    a, b = faces[:, [1, 2, 0]].T.ravel(), faces[:, [2, 0, 1]].T.ravel()
    return _key(a, b, npoints), a < b


def _key(a: Indices, b: Indices, npoints: int) -> Rows:
    return np.minimum(a, b).astype(np.int64) * npoints + np.maximum(a, b)


def _among(keys: Rows, ascending: Rows) -> Bools:
    if not len(ascending):
        return np.zeros(len(keys), dtype=bool)
    at = np.minimum(np.searchsorted(ascending, keys), len(ascending) - 1)
    found: Bools = ascending[at] == keys
    return found


def _is_wrong(points: Floats, edges: _Edges) -> Bools:
    """Return which edges are not Delaunay in their planes."""
    a, b, c, d = (points[v] for v in edges[2:])
    # A sphere through an apex outside the plane meets the plane in the circle.
    apex = _beside(a, b, c)
    inside = _core.insphere(a, b, c, apex, d, True) * _core.orient3d(a, b, c, apex)
    # If d is in the circle beyond the edge, c and d see each other across the edge.
    wrong: Bools = inside > 0
    return wrong


def _beside(a: Floats, b: Floats, c: Floats) -> Floats:
    """Return points outside the planes of triangles, about as far as these are large."""
    made = a.copy()
    with np.errstate(over="ignore"):
        size = np.maximum(np.abs(b - a), np.abs(c - a)).max(axis=1)
    size = np.minimum(size, np.finfo(float).max)
    todo = np.arange(len(a))
    for dropped, kept in enumerate(PLANES):
        flat = (np.ascontiguousarray(p[todo][:, kept]) for p in (a, b, c))
        turned = _core.orient2d(*flat) != 0
        rows, todo = todo[turned], todo[~turned]
        at = a[rows, dropped]
        # Toward zero, where there is no overflow.
        moved = at - np.copysign(size[rows], at)
        made[rows, dropped] = np.where(moved == at, np.nextafter(at, -np.copysign(1.0, at)), moved)
    return made


def _apart(edges: _Edges, nfaces: int) -> Bools:
    """Return edges no two of which have a triangle in common: of neighbors, the first."""
    number = np.arange(len(edges.t))
    first = np.full(nfaces, len(number))
    np.minimum.at(first, edges.t, number)
    np.minimum.at(first, edges.u, number)
    found: Bools = (first[edges.t] == number) & (first[edges.u] == number)
    return found


def _result(parts: Parts, faces: Indices, joined: Indices) -> Recut:
    """Return the parts with their sources: what flips join has the first one."""
    label = _core.graph_components(joined, len(faces))
    first = np.full(int(label.max(initial=-1)) + 1, np.iinfo(np.int32).max, dtype=np.int32)
    np.minimum.at(first, label, parts.source)
    source = first[label]
    changed = np.unique(source[np.unique(joined)])
    # Parts of a source that flips leave alone belong to what it covers.
    rows = np.flatnonzero(_among(source.astype(np.int64), changed.astype(np.int64)))
    return Recut(parts, parts._replace(faces=faces, source=source), rows)


def uncut(parts: Parts) -> Recut:
    """Return parts that remain unchanged."""
    return Recut(parts, parts, np.empty(0, dtype=np.int64))
