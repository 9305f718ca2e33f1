"""Input of the drop-in for the package ``triangle``: tables, meshes to refine, attributes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, as_segments, as_simplices, wrong_shape
from delone._base.counting import counted, listed
from delone._base.duplicates import first_rows
from delone._base.values import as_labels, require_real
from delone._tiling.plane import topology
from delone.errors import CrossingSegmentsError, InputError, NonFiniteError, ShapeError
from delone.refine import domains
from delone.refine.domains import Domain, Lines
from delone.refine.meshed import Mesh
from delone.refine.rounds import MOST_ADDED, as_min_angle

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows

__all__ = ["Given", "Switches", "again", "interpolated", "keys_of", "not_reached", "rows_of"]

# Rows that messages name.
_FIRST = 5


class Switches(NamedTuple):
    """The parsed switches."""

    on: frozenset[str]
    angle: float
    area: float | None
    steiner: int | None
    fixed: bool | str


class Given(NamedTuple):
    """The given triangles of switch r, counter-clockwise."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    # (m, 3): whether the edge opposite each vertex is a segment or a boundary edge.
    walls: Bools
    # (m,): the region between walls, which no triangle of a refined mesh leaves.
    part: Indices
    index: Any

    @classmethod
    def of(cls, triangles: Any, segments: Indices, points: Floats) -> Given:
        """Turn the triangles counter-clockwise, with the first of equal points as corners."""
        rows = as_simplices(triangles, len(points), 2, name="triangles")
        if not len(rows):
            raise InputError("triangles has no rows, so there is nothing to refine")
        simplices = first_rows(points)[rows].astype(np.int32)
        a, b, c = (np.ascontiguousarray(points[simplices[:, k]]) for k in range(3))
        sides = _core.orient2d(a, b, c)
        if not sides.all():
            flat = np.flatnonzero(sides == 0)
            raise InputError(
                f"triangles without an area cannot be refined: {listed(flat, _FIRST)}; remove them"
            )
        turned = sides < 0
        simplices = np.where(turned[:, None], simplices[:, [0, 2, 1]], simplices).astype(np.int32)
        neighbors = topology.neighbors(simplices, len(points))
        keys = _keys_of_sides(simplices, len(points))
        walls = (neighbors < 0) | topology.among(keys, keys_of(segments, len(points)))
        part = _core.components2(neighbors, walls)
        index = _core.Locator2(points, simplices, neighbors)
        return cls(points, simplices, neighbors, walls, part, index)

    def homes(self, points: Floats, simplices: Indices, neighbors: Indices, part: Indices) -> Rows:
        """Return the given triangle from which each triangle of a refined mesh gets its properties.

        `part` is the region of each triangle, and decides: the triangle at its rounded center
        counts only if it is in the same region. Others take that of a neighbor there.
        """
        place = self.index.locate(np.ascontiguousarray(points[simplices].mean(axis=1)), 1)
        homes: Rows = np.where(place.simplex >= 0, place.simplex, place.beside).astype(np.int64)
        homes[self.part[homes] != part] = -1
        beside = np.append(part, -1)[neighbors] == part[:, None]
        # Each round finds a home for some triangle, or is the last one.
        while True:
            bare = np.flatnonzero(homes < 0)
            near = np.where(beside[bare], np.append(homes, -1)[neighbors[bare]], -1)
            side = (near >= 0).argmax(axis=1)
            found = near[np.arange(len(bare)), side]
            if not (found >= 0).any():
                break
            homes[bare] = found
        homes[bare] = self._firsts()[part[bare]]
        return homes

    def _firsts(self) -> Rows:
        """Return the triangle of each region whose corners are smallest, by x, then by y."""
        rank = np.empty(len(self.points), dtype=np.int64)
        rank[np.lexsort(self.points.T[::-1])] = np.arange(len(self.points))
        order = np.lexsort(np.sort(rank[self.simplices], axis=1).T[::-1])
        found = np.empty(int(self.part.max()) + 1, dtype=np.int64)
        # The last value assigned remains.
        found[self.part[order[::-1]]] = order[::-1]
        return found


def rows_of(values: Any, columns: int | None, name: str, count: int | None = None) -> Floats:
    """Convert a table of `columns` numbers; a vector is a column, and None has no rows."""
    if values is None:
        return np.empty((0, columns or 1))
    given = as_plain_array(values, name)
    require_real(given, name, kinds="biuf")
    array = given.astype(np.float64)
    if array.ndim == 1:
        array = array[:, None] if columns is None else array.reshape(-1, columns)
    if array.ndim != 2 or (columns is not None and len(array) and array.shape[1] != columns):
        raise wrong_shape(name, f"(k, {columns or 'c'})", array)
    if count is not None and len(array) != count:
        raise ShapeError(f"{name} must have {count} rows, got {len(array)}")
    return array


def max_areas(values: Any, count: int | None = None) -> Floats:
    """Return the largest area of each triangle; infinity and what is not above 0 set none."""
    given = rows_of(values, None, "triangle_max_area", count)[:, 0]
    wrong = np.flatnonzero(np.isnan(given))
    if len(wrong):
        raise NonFiniteError(
            f"triangle_max_area is NaN in {listed(wrong, _FIRST)}",
            rows=wrong[:_FIRST],
            count=len(wrong),
        )
    return given


def keys_of(edges: Indices, npoints: int) -> NDArray[np.int64]:
    """A key for each edge, the same in both directions."""
    return topology.edge_keys(edges[:, 0], edges[:, 1], npoints)


def again(
    tri: Mapping[str, Any], points: Floats, switches: Switches
) -> tuple[Mesh, Floats | None, Given]:
    """Refine given triangles.

    Returns the mesh, the attributes of the given triangles that its triangles inherit, and the
    given triangles.
    """
    if "triangles" not in tri:
        raise InputError("switch r needs the key 'triangles'")
    given = as_segments(tri.get("segments", ()), len(points))
    segments = first_rows(points)[given].astype(np.int32)
    base = Given.of(tri["triangles"], segments, points)
    domain = _domain(tri, base, segments, switches)
    caps = _caps(tri, domain, base, switches)
    most = MOST_ADDED if switches.steiner is None else switches.steiner
    bound = as_min_angle(switches.angle)
    made, counts = domains.refined(
        domain, caps, bound, most, circles="D" in switches.on, sizes_yield=True
    )
    found = Mesh._of(made, counts, bound, {}, None)
    attributes = None
    if tri.get("triangle_attributes") is not None:
        count = len(base.simplices)
        table = rows_of(tri["triangle_attributes"], None, "triangle_attributes", count)
        attributes = table[_homes_of(found, base)]
    return found, attributes, base


def _homes_of(found: Mesh, base: Given) -> Rows:
    return base.homes(found.points, found.simplices, found.neighbors, found.region)


def _domain(tri: Mapping[str, Any], base: Given, given: Indices, switches: Switches) -> Domain:
    """The given triangles, made Delaunay between segments and boundary; regions are their parts."""
    points, simplices, neighbors = base.points, base.simplices, base.neighbors
    markers = as_labels(tri.get("segment_markers"), len(given), name="segment_markers")
    rim = topology.boundary_edges(simplices, neighbors)
    n = len(points)
    rim_keys = keys_of(rim, n)
    bare = ~topology.among(rim_keys, keys_of(given, n))
    ends = np.concatenate((given, rim[bare])).astype(np.int32)
    _, first = np.unique(keys_of(ends, n), return_index=True)
    first.sort()
    ends = ends[first]
    try:
        made, _ = domains.triangulated(points, ends, rim, np.zeros(len(rim), np.int32), None)
    except CrossingSegmentsError as error:
        x, y = error.points[0].tolist()
        error.args = (f"triangles overlap, or segments cross their outline, first at ({x}, {y})",)
        raise
    marks = np.append(markers, np.zeros(int(bare.sum()), dtype=np.int32))[first]
    own = np.flatnonzero(first < len(given))
    counts = (first < len(given)).astype(np.int64)
    on_rim = topology.among(keys_of(ends, n), rim_keys)
    frozen = np.full(len(ends), switches.fixed is True) | (bool(switches.fixed) & on_rim)
    lines = Lines(
        ends,
        np.concatenate(([0], np.cumsum(counts))),
        first[own].astype(np.int32),
        np.ones(len(own), dtype=bool),
        frozen,
        marks,
        np.full(len(ends), -1, dtype=np.int32),
    )
    of_points = as_labels(tri.get("vertex_markers"), n, name="vertex_markers")
    return Domain(
        points=points,
        point_source=np.arange(n, dtype=np.int32),
        point_markers=of_points,
        on=np.full(n, -1, dtype=np.int32),
        simplices=made.simplices,
        neighbors=made.neighbors,
        labels=_parts_in(made, base),
        regions=np.arange(int(base.part.max()) + 1, dtype=np.int32),
        lines=lines,
        walls=domains.Pieces.of(made),
    )


def _parts_in(made: _core.ConstrainedTriangulation, base: Given) -> Indices:
    """Return the part of the given triangles that contains each triangle, -1 outside.

    Both have the walls as edges, and the parts to the left of them are the same.
    """
    n = len(base.points)
    walls = topology.among(
        _keys_of_sides(made.simplices, n), _keys_of_sides(base.simplices, n)[base.walls]
    )
    edges = np.column_stack(topology.half_edges(base.simplices, *np.nonzero(base.walls)))
    labels = base.part[np.nonzero(base.walls)[0]]
    return domains.labels_beside((made.simplices, made.neighbors, walls), edges, labels, n)


def _keys_of_sides(simplices: Indices, npoints: int) -> NDArray[np.int64]:
    """Return the key of the edge opposite each vertex, (m, 3)."""
    return topology.edge_keys(simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]], npoints)


def _caps(tri: Mapping[str, Any], domain: Domain, base: Given, switches: Switches) -> Floats:
    caps = np.full(len(domain.simplices), math.inf)
    inside = domain.labels >= 0
    if switches.area is not None:
        caps[inside] = switches.area
    elif "a" in switches.on and tri.get("triangle_max_area") is not None:
        count = len(tri["triangles"])
        given = max_areas(tri["triangle_max_area"], count)
        number = np.full(len(inside) + 1, -1)
        number[:-1][inside] = np.arange(np.count_nonzero(inside))
        wanted = given[
            base.homes(
                domain.points,
                domain.simplices[inside],
                number[domain.neighbors[inside]],
                domain.labels[inside],
            )
        ]
        caps[inside] = np.where(wanted > 0, wanted, math.inf)
    return caps


def not_reached(tri: Mapping[str, Any], found: Mesh, base: Any, switches: Switches) -> str | None:
    """A warning about triangles that violate bounds because segments stay whole, or None.

    `base` are the triangles before points were added: ConstrainedDelaunay, or `Given`.
    """
    if not switches.fixed:
        return None
    # The refinement compared areas with different rounding.
    large = int(np.count_nonzero(found.areas > (1 + 1e-12) * _allowed(tri, found, base, switches)))
    small = int(np.count_nonzero(found.report.cause == "frozen"))
    missed = []
    if large:
        missed.append(f"{counted(large, 'triangle')} larger than requested")
    if small:
        missed.append(
            f"{counted(small, 'triangle')} with an angle below {switches.angle:g} degrees"
        )
    if not missed:
        return None
    return f"switch Y forbids splitting segments and leaves {' and '.join(missed)}"


def _allowed(tri: Mapping[str, Any], found: Mesh, base: Any, switches: Switches) -> Floats | float:
    """Return the maximum area for each triangle of a mesh."""
    if switches.area is not None or "a" not in switches.on:
        return math.inf if switches.area is None else switches.area
    if isinstance(base, Given):
        if tri.get("triangle_max_area") is None:
            return math.inf
        given = max_areas(tri["triangle_max_area"])
        wanted = given[_homes_of(found, base)]
    else:
        areas = rows_of(tri.get("regions"), 4, "regions")[:, 3]
        if not len(areas):
            return math.inf
        # The last row is for triangles without a seed, with number -1.
        wanted = np.append(areas, 0.0)[found.region]
    return np.where(wanted > 0, wanted, math.inf)


def interpolated(found: Mesh, values: Floats, base: Any) -> Floats:
    """Values at the points of a mesh, linearly interpolated in the input mesh `base`.

    `values`, (n, k), belong to the given vertices, and are unchanged there.
    """
    out = np.empty((found.npoints, values.shape[1]))
    old = found.point_source >= 0
    out[old] = values[found.point_source[old]]
    places = np.ascontiguousarray(found.points[~old])
    if not len(places):
        return out
    if isinstance(base, Given):
        simplices, index = base.simplices, base.index
    else:
        simplices, index = base.simplices, base._locator
    place = index.locate(places, 1)
    inside = place.simplex >= 0
    full = _with_crossings(values, base)
    new = np.empty((len(places), values.shape[1]))
    corners = full[simplices[place.simplex[inside]]]
    new[inside] = (corners * place.weights[inside][..., None]).sum(axis=1)
    a, b = full[place.edge[~inside]].transpose(1, 0, 2)
    t = place.along[~inside][:, None]
    new[~inside] = a * (1 - t) + b * t
    out[~old] = new
    return out


def _with_crossings(values: Floats, base: Any) -> Floats:
    """Values of vertices added at crossings: the mean of those of their neighbors."""
    if isinstance(base, Given) or not base.nadded:
        return values
    full = np.concatenate((values, np.full((base.nadded, values.shape[1]), np.nan)))
    indptr, indices = base.vertex_neighbor_vertices
    for v in range(len(values), len(full)):
        full[v] = np.nanmean(full[indices[indptr[v] : indptr[v + 1]]], axis=0)
    return full
