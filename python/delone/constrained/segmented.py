"""The state of a constrained triangulation, and attributes derived from segments and seeds.

`_given` contains the input other than points, and `_made` the result of the core: the triangles of
the whole convex hull, and subsegments with their rows. `simplices` and similar arrays contain only
the triangles that are kept; `_number` maps all triangles to these.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.immutable import kept, sealed
from delone._base.renames import renamed
from delone._tiling.triangulation import PointTriangulation
from delone.constrained import regions, segments

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices
    from delone.constrained.segments import SegmentReport

    Areas = tuple[Indices, Indices]

__all__ = ["Given", "Options", "Origin", "Segmented"]


# Origins of few segments.
_NO_ROWS = sealed(np.full(1000, -1, dtype=np.int32))
_NO_RINGS = sealed(np.zeros(1000, dtype=bool))


class Options(NamedTuple):
    """The options of a constrained triangulation."""

    boundary: str
    crossing: str
    conforming: bool
    max_points: int
    method: str
    workers: int | None
    labeled: bool
    # The reference system of the geometries, if they have one.
    crs: str | None = None


class Origin(NamedTuple):
    """Where each input segment came from."""

    # (s,): its geometry, -1 without one.
    geometries: Indices
    # (s,): whether it is the side of a ring.
    rings: Bools
    # (s,): its ring or line, numbered over all geometries, -1 without one.
    parts: Indices

    @classmethod
    def of_arrays(cls, count: int) -> Origin:
        """Return the origin of segments that did not come from geometries, read-only."""
        if count <= len(_NO_ROWS):
            none = _NO_ROWS[:count]
            return cls(none, _NO_RINGS[:count], none)
        none = sealed(np.full(count, -1, dtype=np.int32))
        return cls(none, sealed(np.zeros(count, dtype=bool)), none)

    @property
    def polygons(self) -> Indices:
        """The polygon that each segment is a side of, (s,), or -1."""
        return np.where(self.rings, self.geometries, np.int32(-1))


class Given(NamedTuple):
    """The input of a constrained triangulation other than points and options."""

    # (s, 2): the segments.
    segments: Indices
    origin: Origin
    # (h, 2): seeds of holes.
    holes: Floats
    # (r, 2): seeds of regions.
    regions: Floats
    # (r,): their labels.
    labels: Indices

    def sealed(self) -> Given:
        """Return a copy with read-only arrays."""
        return Given(
            segments=sealed(self.segments),
            origin=Origin._make(map(sealed, self.origin)),
            holes=sealed(self.holes),
            regions=sealed(self.regions),
            labels=sealed(self.labels),
        )


@renamed(polygon="polygon_of_simplex")
class Segmented(segments.SegmentArrays, PointTriangulation):
    """A triangulation whose edges include segments, with regions between them."""

    __slots__ = ("_constrained", "_given", "_made", "_number", "_options")

    _constrained: Bools
    _given: Given
    _made: _core.ConstrainedTriangulation
    _number: Indices | None
    _options: Options

    def _set(
        self,
        points: Floats,
        given: Given,
        made: _core.ConstrainedTriangulation,
        options: Options,
        stages: Any,
        *,
        areas: Areas | None = None,
    ) -> None:
        """Set everything; arrays other than the points cannot be made writeable.

        `areas` are the components and their polygons, if the core has found them.
        """
        put = object.__setattr__
        put(self, "_given", given)
        put(self, "_made", made)
        put(self, "_options", options)
        put(self, "_points", sealed(points))
        simplices, neighbors, constrained = made.simplices, made.neighbors, made.constrained
        removed, found = self._removed(areas)
        number = None
        if removed is not None:
            rows = np.flatnonzero(~removed)
            # The last entry is for the index -1.
            number = np.full(len(removed) + 1, -1, dtype=np.int32)
            number[rows] = np.arange(len(rows), dtype=np.int32)
            simplices, constrained = sealed(simplices[rows]), sealed(constrained[rows])
            neighbors = sealed(number[neighbors[rows]])
        self._hold(
            number=number,
            duplicates=made.duplicates,
            simplices=simplices,
            neighbors=neighbors,
            constrained=constrained,
            stages=stages,
            workers=options.workers,
        )
        self._cache.update(found)

    def _removed(self, areas: Areas | None) -> tuple[Bools | None, dict[str, Indices]]:
        """Return which triangles of the hull are in holes or outside; None if all are kept.

        The second result has what was found on the way, by the names of its attributes.
        """
        holes, boundary = self._given.holes, self._options.boundary
        if boundary == "hull" and not len(holes):
            return None, {}
        if boundary == "polygons":
            component, polygons = areas or self._areas()
            found = {"_component": component, "_polygons": polygons}
            removed = polygons < 0
        else:
            component = self._components()
            found = {"_component": component}
            removed = np.zeros(int(component.max()) + 1, dtype=bool)
            if boundary == "outline":
                removed = regions.outside(self._tiles(), component)
        if len(holes):
            triangle, on_segment = self._located(holes)
            removed[component[triangle[(triangle >= 0) & ~on_segment]]] = True
        return removed[component] if removed.any() else None, found

    def _areas(self) -> Areas:
        """Return the component of each triangle of the hull, and the polygon of each component."""
        return _core.areas2(self._made, self._given.segments, self._given.origin.polygons)

    @property
    @kept
    def _polygons(self) -> Indices:
        """The first polygon that contains each component, or -1."""
        return self._areas()[1]

    def _tiles(self) -> regions.Tiling:
        made = self._made
        return regions.Tiling(self._points, made.simplices, made.neighbors, made.constrained)

    def _components(self) -> Indices:
        return _core.components2(self._made.neighbors, self._made.constrained)

    @property
    @kept
    def _component(self) -> Indices:
        """The component of each triangle of the hull, between segments."""
        return self._components()

    def _located(self, seeds: Floats) -> tuple[Indices, Bools]:
        """Return the triangles of the hull that contain seeds, and which seeds lie on segments."""
        workers = as_workers(self._options.workers)
        return regions.located(self._tiles(), seeds, self._made.segments, workers)

    def _tiling(self) -> tuple[Indices, Indices]:
        return self._made.simplices, self._made.neighbors

    @property
    def constrained(self) -> Bools:
        """Whether the edge opposite each vertex is part of a segment, (m, 3)."""
        return self._constrained

    @property
    def nadded(self) -> int:
        """Number of added vertices; they are the last rows of `points`."""
        return len(self._made.added)

    @property
    def part_of_segment(self) -> Indices:
        """The ring or line that each of `input_segments` is part of, (s,); -1 for arrays.

        Rings and lines are numbered from 0 over all geometries, in the order of their coordinates:
        the outer ring of a polygon first, then its holes.
        """
        return self._given.origin.parts

    @property
    @kept
    def polygon_of_simplex(self) -> Indices:
        """The first polygon that contains each triangle, (m,), as the number of its geometry.

        -1 if there is none, and in triangulations of arrays. A point is inside if the rings of the
        geometry wind around it an odd number of times. If an edit has removed a side of its rings,
        a geometry has no inside.
        """
        return sealed(self._only_kept(self._polygons[self._component]))

    @property
    @kept
    def region(self) -> Indices:
        """The region of each triangle, (m,): the same where no segment separates triangles.

        With region seeds, it is the label of the first seed in the region, -1 without one. Without
        seeds, regions are numbered from 0 in the order of their smallest triangles. Triangles are
        compared by their smallest corners, then their middle ones, then their largest; corners by
        x, then y. So the numbers do not depend on the order of rows.
        """
        component = self._component
        if self._options.labeled:
            label, _ = self._labeled(component)
            return sealed(self._only_kept(label))
        return sealed(
            _core.numbered_components(self._points, self._simplices, self._only_kept(component))
        )

    def _only_kept(self, values: Indices) -> Indices:
        return values if self._number is None else values[self._number[:-1] >= 0]

    def _labeled(self, component: Indices) -> tuple[Indices, Indices]:
        triangle, on_segment = self._located(self._given.regions)
        valid = (triangle >= 0) & ~on_segment & ~self._is_removed(triangle)
        of_seed = np.where(valid, component[triangle], -1)
        return regions.labels(component, of_seed, self._given.labels)

    def _is_removed(self, triangle: Indices) -> Bools:
        if self._number is None:
            return np.zeros(len(triangle), dtype=bool)
        removed: Bools = (triangle >= 0) & (self._number[triangle] < 0)
        return removed

    @property
    @kept
    def report(self) -> SegmentReport:
        """The input report: duplicates, overlaps, crossings and more, row by row."""
        made, ends = self._made, self.duplicate_of[self._given.segments]
        crossings = made.crossings
        known = np.concatenate((crossings[:, [0, 2]], crossings[:, [1, 2]], made.through))
        hole, hole_on_segment = self._located(self._given.holes)
        triangle, on_segment = self._located(self._given.regions)
        outside = (triangle < 0) | (self._is_removed(triangle) & ~on_segment)
        report = segments.SegmentReport(
            **segments.listed(made, ends),
            steiner=segments.steiner_rows(
                made.segments, made.source_start, made.source, known, ends
            ),
            holes_outside=_rows(hole < 0),
            holes_on_segment=_rows(hole_on_segment),
            regions_outside=_rows(outside),
            regions_on_segment=_rows(on_segment),
            open_ends=self._open_ends(),
        )
        if not len(self._given.regions):
            return report
        return replace(report, regions_repeated=self._labeled(self._component)[1])

    def _open_ends(self) -> Indices:
        """Return vertices outside at which the outline is open."""
        if self._options.boundary != "outline":
            return np.empty(0, dtype=np.int32)
        return segments.open_ends(self._made.segments, self._simplices, len(self._points))

    def _arguments(self) -> dict[str, Any]:
        """Return the arguments of the constructor other than points and segments."""
        raise NotImplementedError

    @classmethod
    def _of_geometries(
        cls,
        points: Floats,
        segments: Indices,
        origin: Origin,
        *,
        holes: ArrayLike | None,
        regions: ArrayLike | None = None,
        **choices: Any,
    ) -> Self:
        """Triangulate private arrays, with the origin of each segment."""
        raise NotImplementedError

    @classmethod
    def _restored(
        cls,
        points: Floats,
        given: Given,
        made: _core.ConstrainedTriangulation,
        options: Options,
        stages: Any,
    ) -> Self:
        mesh = cls.__new__(cls)
        made = _core.ConstrainedTriangulation(*map(sealed, made.arrays()))
        mesh._set(points, given.sealed(), made, options, stages)
        return mesh

    def __reduce__(self) -> tuple[Any, ...]:
        whole = self._points, self._given, self._made
        return type(self)._restored, (*whole, self._options, self._stages)


def _rows(marked: Bools) -> Indices:
    return np.flatnonzero(marked).astype(np.int32)
