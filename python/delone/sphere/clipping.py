"""Cells of directions clipped to a region of polygons with arcs of great circles as sides.

The ridges of the diagram and the sides of the region are arcs of one constrained triangulation,
whose crossings are split. Each part between arcs belongs to one cell and is either inside or
outside the region; its triangles belong to that cell. So cells may have several parts and holes,
and their areas sum to that of the region despite rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._tiling.plane.topology import half_edges
from delone.errors import InputError
from delone.sphere.constrained import WINDINGS, ConstrainedDelaunay, Given, most_added
from delone.sphere.geometry import read
from delone.sphere.sides import Origin

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices, Rows
    from delone.sphere.cells import Cells

__all__ = [
    "Clipped",
    "Region",
    "Whole",
    "as_region",
    "clipped",
    "loaded_region",
    "saved_region",
    "sums",
    "whole_rings",
]

# Ridges can be half a great circle long; for pieces up to this length, the shorter arc is unique.
_LONGEST = np.pi / 2
# Narrower parts are artifacts of rounded vertices and crossings, which are off by about 2e-16.
_WIDTH = 2.0**-49


class Whole(NamedTuple):
    """A diagram to clip: cells, lengths of ridges and unit vectors of sites."""

    cells: Cells
    lengths: Floats
    points: Floats
    # The sites nearest to vectors.
    nearest: Callable[[Floats], Indices]


class Region(NamedTuple):
    """Polygons: the vectors of their corners, and their sides."""

    vectors: Floats
    given: Given


def as_region(
    clip: Any, winding: str, sides: str | None, *, degrees: bool, workers: int | None
) -> Region | None:
    """Return the region that arguments of `Voronoi` describe; None for the whole sphere."""
    if clip is None or isinstance(clip, Region):
        return clip
    vectors, given, whole = read(
        clip, winding, degrees=degrees, workers=workers, sides=sides, name="clip"
    )
    if whole is not None:
        return None
    if not len(given.origin.rings) or not given.origin.rings.all():
        raise InputError("clip must be polygons, and nothing else")
    return Region(vectors, given)


def saved_region(region: Region | None) -> dict[str, NDArray[Any]]:
    """Return a region as arrays for a file; empty arrays if there is no region."""
    if region is None:
        none = np.empty((0, 2), dtype=np.int32)
        region = Region(np.empty((0, 3)), Given(none, Origin.of_arrays(0), "ccw", 0))
    given = region.given
    return {
        "corners": region.vectors,
        "sides": given.segments,
        "geometries": given.origin.geometries,
        "outer": given.origin.outer,
        "winding": np.array([WINDINGS.index(given.winding)], dtype=np.int64),
    }


def loaded_region(arrays: dict[str, NDArray[Any]]) -> Region | None:
    """Return the region that `saved_region` turned into arrays."""
    sides = arrays["sides"]
    if not len(sides):
        return None
    origin = Origin(arrays["geometries"], np.ones(len(sides), dtype=bool), arrays["outer"])
    corners = arrays["corners"]
    return Region(corners, Given(sides, origin, WINDINGS[arrays["winding"][0]], len(corners)))


@dataclass(frozen=True, eq=False)
class Clipped:
    """Clipped cells."""

    # The triangulation of ridges and sides.
    mesh: ConstrainedDelaunay
    # (m,): the row of the site whose cell a triangle is part of; -1 outside the region.
    cell: Indices

    def areas(self, npoints: int) -> Floats:
        """Return the areas of the cells by the rows of their sites, (n,), on the unit sphere."""
        inside = self.cell >= 0
        return sums(self.cell[inside], self.mesh.areas[inside], npoints)

    def ridges(self) -> tuple[NDArray[np.int64], Floats]:
        """Return the pairs of cells that share a border, (r, 2), and its length on the unit sphere.

        Borders not longer than rounding errors are left out.
        """
        mesh = self.mesh
        t, k = np.nonzero(self.border)
        beside = self.cell[mesh.neighbors[t, k]]
        once = self.cell[t] < beside
        t, k, beside = t[once], k[once], beside[once]
        tail, head = (mesh.points[each] for each in half_edges(mesh.simplices, t, k))
        length = 2 * np.arcsin(np.minimum(np.linalg.norm(tail - head, axis=1) / 2, 1.0))
        every = np.column_stack((self.cell[t], beside)).astype(np.int64)
        pairs, row = np.unique(every, axis=0, return_inverse=True)
        total = sums(row.ravel(), length, len(pairs))
        return pairs[total > _WIDTH], total[total > _WIDTH]

    @cached_property
    def border(self) -> Bools:
        """Whether the cell ends at the edge opposite each corner of a triangle, (m, 3)."""
        beside = np.append(self.cell, np.int32(-1))[self.mesh.neighbors]
        found: Bools = (self.cell >= 0)[:, None] & (beside != self.cell[:, None])
        return found

    def border_edges(self) -> tuple[Indices, Indices]:
        """Return tails and heads of the edges at which cells end, each once."""
        t, k = np.nonzero(self.border)
        tail, head = half_edges(self.mesh.simplices, t, k)
        beside = np.append(self.cell, np.int32(-1))[self.mesh.neighbors[t, k]]
        once = (beside < 0) | (tail < head)
        return tail[once], head[once]

    def rings(self) -> list[tuple[int, int, list[int]]]:
        """Return the rings of all cells: the cell, the part of it, and corners as rows."""
        mesh, border = self.mesh, self.border.ravel()
        neighbors = mesh.neighbors
        edges = np.flatnonzero(border)
        # From each edge to the next one around its head, across triangles of the same cell.
        after = _next_in_triangle(edges)
        active = np.flatnonzero(~border[after])
        # Terminates: a full turn around the vertex returns to the edge itself, which is a border.
        while len(active):
            t, k = np.divmod(after[active], 3)
            across = neighbors[t, k]
            twin = 3 * across + (neighbors[across] == t[:, None]).argmax(axis=1)
            after[active] = _next_in_triangle(twin)
            active = active[~border[after[active]]]
        tails = half_edges(mesh.simplices, *np.divmod(edges, 3))[0].tolist()
        place = np.full(len(border), -1)
        place[edges] = np.arange(len(edges))
        follows = place[after].tolist()
        part = _core.components2(neighbors, self.border | (self.cell < 0)[:, None])[edges // 3]
        found, seen = [], [False] * len(edges)
        for start, (cell, piece) in enumerate(zip(self.cell[edges // 3], part, strict=True)):
            ring: list[int] = []
            at = start
            while not seen[at]:
                seen[at] = True
                ring.append(tails[at])
                at = follows[at]
            if ring:
                found.append((int(cell), int(piece), ring))
        return found

    def polygons(self, npoints: int) -> list[list[list[Floats]]]:
        """Return for each row the parts of its cell, each as rings of unit vectors."""
        parts: dict[tuple[int, int], list[list[int]]] = {}
        for cell, piece, ring in self.rings():
            parts.setdefault((cell, piece), []).append(ring)
        found: list[list[list[Floats]]] = [[] for _ in range(npoints)]
        points = self.mesh.points
        for (cell, _), rings in sorted(parts.items()):
            if len(rings) > 1:
                rings.sort(key=lambda ring: _area_left(points[ring]))
            found[cell].append([points[ring] for ring in rings])
        return found


def clipped(whole: Whole, region: Region, workers: int | None) -> Clipped:
    """Return the clipped cells of a diagram."""
    vectors, ends = _pieces(whole.cells, whole.lengths, whole.points)
    sides, origin = region.given.segments, region.given.origin
    given = Given(
        np.concatenate((ends, sides + np.int32(len(vectors)))),
        Origin(
            np.concatenate((np.full(len(ends), -1, dtype=np.int32), origin.geometries)),
            np.concatenate((np.zeros(len(ends), dtype=bool), origin.rings)),
            np.concatenate((np.zeros(len(ends), dtype=bool), origin.outer)),
        ),
        region.given.winding,
        len(vectors) + len(region.vectors),
    )
    # With fewer than three sites, all arcs may be on one great circle, so points off it are added.
    few = np.eye(3) if len(whole.cells.ends) < 3 else np.empty((0, 3))
    every = np.concatenate((vectors, region.vectors, few, -few))
    mesh = ConstrainedDelaunay._of_geometries(
        every, given, most_added("split", None), True, workers
    )
    component = mesh._component
    # A point in each part between arcs: in its largest triangle.
    order = np.lexsort((-mesh.areas, component))
    first = order[np.searchsorted(component[order], np.arange(component.max() + 1))]
    cell = whole.nearest(mesh.points[mesh.simplices[first]].sum(axis=1))
    cell[mesh.polygon_of_simplex[first] < 0] = -1
    if not (cell >= 0).any():
        raise InputError("clip has no area")
    cell = _without_slivers(mesh, component, cell)[component]
    return Clipped(mesh, cell)


def _without_slivers(mesh: ConstrainedDelaunay, component: Indices, cell: Indices) -> Indices:
    """Assign parts not wider than rounding errors to the cells along their longest sides."""
    count = len(cell)
    t, k = np.nonzero(mesh.constrained & (mesh.neighbors >= 0))
    tails, heads = (mesh.points[each] for each in half_edges(mesh.simplices, t, k))
    length = np.linalg.norm(tails - heads, axis=1)
    here, there = component[t], component[mesh.neighbors[t, k]]
    area, perimeter = sums(component, mesh.areas, count), sums(here, length, count)
    thin = (cell >= 0) & (area < _WIDTH / 2 * perimeter)
    if not thin.any():
        return cell
    of_thin = np.flatnonzero(thin[here])
    of_thin = of_thin[np.argsort(-length[of_thin], kind="stable")]
    found, open_ = cell.copy(), thin.copy()
    # Each round settles the parts next to settled ones; enclosed parts remain unchanged.
    for _ in range(count):
        beside = of_thin[
            open_[here[of_thin]] & ~open_[there[of_thin]] & (found[there[of_thin]] >= 0)
        ]
        part, row = np.unique(here[beside], return_index=True)
        if not len(part):
            break
        found[part] = found[there[beside[row]]]
        open_[part] = False
    return found


def _pieces(cells: Cells, lengths: Floats, points: Floats) -> tuple[Floats, Indices]:
    """Return vectors, and pieces of ridges as pairs of their rows."""
    start, end = cells.ends.T
    long, middle = _middles(cells, lengths, points)
    number = np.arange(len(long), dtype=np.int32) + len(cells.vertices)
    first = np.column_stack((start, end))
    first[long, 1] = number
    second = np.column_stack((number, end[long]))
    vectors = np.concatenate((cells.vertices, middle))
    return vectors, np.concatenate((first, second)).astype(np.int32)


def _middles(cells: Cells, lengths: Floats, points: Floats) -> tuple[Rows, Floats]:
    """Return the ridges that may be half a great circle long, and their midpoints."""
    if cells.middles is not None:
        return np.arange(len(cells.ends)), cells.middles
    start = cells.ends[:, 0]
    long = np.flatnonzero(lengths > _LONGEST)
    left, right = (points[cells.sites[long, j]] for j in (0, 1))
    ahead = np.cross(left - right, cells.vertices[start[long]])
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    half = lengths[long, None] / 2
    return long, np.cos(half) * cells.vertices[start[long]] + np.sin(half) * ahead


def whole_rings(
    cells: Cells, lengths: Floats, points: Floats, regions: list[list[int]]
) -> list[list[list[Floats]]]:
    """Return for each row the rings of its whole cell as unit vectors, with arcs below half a turn.

    Long ridges have their midpoints as corners.
    """
    long, middles = _middles(cells, lengths, points)
    # Sorted by the site to the left of a ridge and by its first vertex.
    between: dict[tuple[int, int], Floats] = {}
    for ridge, middle in zip(long.tolist(), middles, strict=True):
        for site, start in zip(
            cells.sites[ridge].tolist(), cells.ends[ridge].tolist(), strict=True
        ):
            between[site, start] = middle
    found: list[list[list[Floats]]] = [[] for _ in range(len(cells.cell))]
    for row in np.flatnonzero(cells.cell >= 0).tolist():
        ring = []
        for vertex in regions[cells.cell[row]]:
            ring.append(cells.vertices[vertex])
            if (row, vertex) in between:
                ring.append(between[row, vertex])
        found[row] = [[np.array(ring)]]
    return found


def sums(rows: NDArray[np.integer], shares: Floats, count: int) -> Floats:
    """Return the sum of the weights of each row, (count,)."""
    return np.bincount(rows, weights=shares, minlength=count).astype(np.float64)


def _next_in_triangle(edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the edges that start where others end; 3 t + k is opposite corner k of triangle t."""
    found: NDArray[np.int64] = edges - edges % 3 + (edges + 1) % 3
    return found


def _area_left(ring: Floats) -> float:
    """Return the area to the left of a ring of unit vectors, 0 to 4 pi, rounded."""
    before, after = np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0)
    arriving, leaving = np.cross(before, ring), np.cross(ring, after)
    turns = np.arctan2(
        np.einsum("ij,ij->i", np.cross(arriving, leaving), ring),
        np.einsum("ij,ij->i", arriving, leaving),
    )
    return float((2 * np.pi - turns.sum()) % (4 * np.pi))
