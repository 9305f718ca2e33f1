"""The class ConstrainedDelaunay: a triangulation whose edges include given segments.

The core triangulates the whole convex hull; `segmented` stores these triangles and determines which
of them are kept. This module contains construction, queries, validation and files. Walks use all
triangles of the hull, so they pass through holes and bays.

Chew, L. P. (1989), "Constrained Delaunay triangulations", Algorithmica 4, 97-108.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import (
    as_choice,
    as_flag,
    as_limit,
    as_seeds,
    as_segments,
    as_workers,
)
from delone._base.counting import agreed, counted
from delone._base.georeference import crs_of, warn_of_degrees
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling import location
from delone._tiling.plane import topology
from delone.constrained import regions
from delone.constrained.editing import Editing
from delone.constrained.segmented import Given, Options, Origin, Segmented
from delone.constrained.validation import ConstrainedReport, validate
from delone.errors import InputError, InternalError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.exchange.parts import Parts

__all__ = ["ConstrainedDelaunay"]

# How many vertices a call may add by default: about 1.5 GiB of arrays.
_MOST_ADDED = 4_000_000
# The third is for polygons only.
_BOUNDARIES = ("hull", "outline", "polygons")
_CROSSINGS = ("raise", "split")
_METHODS = tuple(_core.methods2())
# Fewer points are never shared among threads, and counting cores takes as long as some
# triangulations.
_FEW = 1000
_NO_SEEDS = sealed(np.empty((0, 2)))
_NO_LABELS = sealed(np.empty(0, dtype=np.int32))


class ConstrainedDelaunay(Segmented):
    """Constrained Delaunay triangulation of points and segments in 2-D.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates, as for `Delaunay`.
    segments : array_like of int, shape (s, 2)
        Edges that the triangulation must contain, as pairs of rows of `points`. They may repeat,
        overlap, have zero length or pass through points; `report` lists those that do. May be
        empty.
    holes : array_like, shape (h, 2), optional
        Seeds of holes: the region around each seed, bounded by segments, is removed.
    regions : array_like, shape (k, 2) or (k, 3), optional
        Seeds of regions: the triangles of the region around each seed get its label in `region`.
        The label is the third column (an integer of at least 0), or the row of the seed. Without
        seeds, regions are numbered from 0.
    boundary : {"hull", "outline"}, optional
        What is triangulated: the convex hull, or only the part that cannot be reached from outside
        without crossing a segment.
    crossing : {"raise", "split"}, optional
        Whether crossing segments raise an error, or are split at a new vertex.
    conforming : bool, optional
        Add vertices on segments until the diametral circle of each subsegment has no vertex inside,
        so that each subsegment is an edge of some unconstrained Delaunay triangulation of all
        vertices. (If there are other vertices on the circle, that may not be the canonical one.)
    max_points : int, optional
        Maximum number of added vertices; by default 4,000,000. It also limits the number of pairs
        of crossing segments that are examined: 8 per vertex, plus a million.
    method, workers, planar : optional
        As for `Delaunay`. The result does not depend on `method` and `workers`.

    Attributes
    ----------
    points : ndarray of float64, shape (n + nadded, 2)
        The input rows, then the added vertices.
    simplices : ndarray of int32, shape (m, 3)
        The triangles, without removed ones, as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1 if
        there is none, or it was removed.
    constrained : ndarray of bool, shape (m, 3)
        Whether the edge opposite vertex k of triangle t is part of a segment.
    segments : ndarray of int32, shape (q, 2)
        The subsegments: the edges into which points and crossings split the segments.

    Raises
    ------
    CrossingSegmentsError
        Segments cross, and `crossing` is ``"raise"``; ``error.pairs`` lists all pairs of rows, and
        ``error.points`` where they cross.
    BudgetExceededError
        More than `max_points` vertices would have to be added, or more segments cross than it
        allows; ``error.found`` is the number found.
    InputError
        A segment refers to a row that `points` does not have, a label is not an integer of at least
        0, or an option is not one of its choices. The message names the rows.
    DegenerateInputError, NonFiniteError, ShapeError, DtypeError, MemoryError, KeyboardInterrupt
        As for `Delaunay`; seeds must be finite as well.

    Notes
    -----
    Each edge that is not a subsegment is locally Delaunay: no vertex that is visible from its
    triangles lies inside their circumcircles (D. T. Lee and A. K. Lin, "Generalized Delaunay
    triangulation for planar graphs", 1986; Chew 1989). Ties between cocircular points are broken by
    coordinates as in `Delaunay`, so one set of points and segments has one triangulation, whatever
    the order of the rows, and without segments the triangles are those of `Delaunay`.

    A crossing is split at the exact intersection of the two input rows, rounded once to the nearest
    doubles; vertices that ``conforming=True`` adds are rounded as well. Segments then pass through
    rounded vertices and may bend there by the rounding error; the triangulation is always valid.

    To make the triangulation conforming, subsegments are split in half, or near corners at powers
    of two, so that segments that meet at sharp angles stop encroaching on each other (J. Ruppert,
    "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995). Subsegments
    between adjacent doubles cannot be split and remain unchanged.

    Two segments that meet at an input point do not count as crossing: both pass through it. Rows of
    `points` that are vertices only of removed triangles belong to no triangle. A seed that lies on
    a segment or outside has no effect; `report` lists it.

    All arrays are read-only, and attributes cannot be set. Attributes that are not listed above,
    such as `region` and `report`, are computed on first use and kept; holes and
    ``boundary="outline"`` are applied immediately, in linear time.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> outer = [(0, 0), (6, 0), (6, 6), (0, 6)]
    >>> inner = [(2, 2), (4, 2), (4, 4), (2, 4)]
    >>> rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    >>> mesh = ConstrainedDelaunay(outer + inner, rings, holes=[(3, 3)])
    >>> mesh
    <ConstrainedDelaunay of 8 points and 8 segments: 8 triangles>
    >>> float(mesh.areas.sum())
    32.0
    >>> bool(mesh.validate())
    True
    """

    __slots__ = ()

    _SAVES_CRS = True

    def __init__(
        self,
        points: ArrayLike,
        segments: ArrayLike,
        *,
        holes: ArrayLike | None = None,
        regions: ArrayLike | None = None,
        boundary: str = "hull",
        crossing: str = "raise",
        conforming: bool = False,
        max_points: int | None = None,
        method: str = "auto",
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        as_choice(boundary, _BOUNDARIES[:2], name="boundary")
        as_choice(crossing, _CROSSINGS, name="crossing")
        conforming = as_flag(conforming, name="conforming")
        most = _budget(max_points)
        as_choice(method, _METHODS, name="method")
        own = own_copy(points)
        warn_of_degrees(points, own, planar=planar)
        rows = _own(as_segments(segments, len(own)), segments)
        given = _given(rows, Origin.of_arrays(len(rows)), holes, regions)
        labeled = len(given.regions) > 0
        system = None if type(points) is np.ndarray else crs_of(points)
        choices = boundary, crossing, conforming, most, method, workers
        options = Options(*choices, labeled, crs=system)
        self._compute(own, given, options)

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
        as_choice(choices["boundary"], _BOUNDARIES, name="boundary")
        as_choice(choices["crossing"], _CROSSINGS, name="crossing")
        as_choice(choices["method"], _METHODS, name="method")
        choices["max_points"] = _budget(choices["max_points"])
        mesh = cls.__new__(cls)
        given = _given(segments, Origin._make(map(sealed, origin)), holes, regions)
        mesh._compute(points, given, Options(labeled=len(given.regions) > 0, **choices))
        return mesh

    def _compute(self, points: Floats, given: Given, options: Options) -> None:
        """Let the core triangulate, and store the result with the input."""
        few = options.workers is None and len(points) < _FEW
        try:
            made, stages, areas = _core.constrained2(
                points,
                given.segments,
                options.crossing == "split",
                options.conforming,
                options.max_points,
                options.method,
                1 if few else as_workers(options.workers),
                given.origin.polygons if options.boundary == "polygons" else None,
            )
        except InternalError as error:
            error.points = points
            raise
        if len(made.added):
            points = np.concatenate((points, made.added))
        self._set(points, given, made, options, dict(stages), areas=areas)

    def triangles_along(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the triangles that a straight line meets, in order.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Start and end of the line, inside or outside.

        Returns
        -------
        ndarray of int32, shape (k,)
            The triangles that have more than one point of the line, in order from a to b. Parts in
            holes and outside are skipped. Where the line runs along an edge, it is the triangle to
            the left, or the only one. A line of zero length is located as a point.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            `a` or `b` is not a finite 2-D point.

        Notes
        -----
        Exact. Linear in the number of triangles met, after a walk to the first.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 2)])
        >>> met = mesh.triangles_along((0.5, 1.5), (1.5, 0.5))
        >>> len(met), mesh.neighbors[met[0]].tolist().count(met[1])
        (2, 1)
        """
        return self.walk(a, b)

    def segments_crossing(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the subsegments that a straight line crosses, in order.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Start and end of the line, inside or outside.

        Returns
        -------
        ndarray of int32, shape (k,)
            Rows of `segments`, in the order of their crossings from a to b, including those in
            holes and outside the outline.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            `a` or `b` is not a finite 2-D point.

        Notes
        -----
        Exact. Two lines cross if they have one common point that is an endpoint of neither: a
        subsegment that only touches the line, or lies along it, does not cross it.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 2)])
        >>> mesh.segments[mesh.segments_crossing((0.5, 1.5), (1.5, 0.5))].tolist()
        [[0, 2]]
        """
        start, end = location.segment_ends(a, b)
        tiling, along = self._tiles(), self._whole_locator.along(start, end)
        found = regions.crossed(tiling, along, start, end)
        keys, order = self._keys_of_segments
        wanted = topology.edge_keys(found[:, 0], found[:, 1], self.npoints)
        rows: Indices = order[np.searchsorted(keys, wanted)]
        return rows

    @property
    @kept
    def _keys_of_segments(self) -> tuple[NDArray[np.int64], Indices]:
        """The sorted keys of the subsegments, and their rows."""
        keys = topology.edge_keys(self.segments[:, 0], self.segments[:, 1], self.npoints)
        order = np.argsort(keys)
        return keys[order], order.astype(np.int32)

    def edit(self) -> Editing[Self]:
        """Return a context manager that collects changes and creates a changed copy.

        Returns
        -------
        Editing
            Collects the changes; see its documentation.

        Notes
        -----
        The triangulation itself never changes. Since triangulations are canonical, the result is
        the same as that of triangulating the changed input.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 2)])
        >>> with mesh.edit() as edit:
        ...     edit.remove_segment(0, 2)
        ...     edit.insert_segment(1, 3)
        >>> edit.result.segments
        array([[1, 3]], dtype=int32)
        """
        return Editing(self)

    def _arguments(self) -> dict[str, Any]:
        """The arguments of the constructor other than points and segments."""
        arguments: dict[str, Any] = self._options._asdict()
        if arguments.pop("labeled"):
            seeds, labels = self._given.regions, self._given.labels
            arguments["regions"] = np.column_stack((seeds, labels))
        return arguments | {"holes": self._given.holes}

    def validate(self) -> ConstrainedReport:
        """Prove that this is the canonical constrained triangulation, or list the faults.

        Returns
        -------
        ConstrainedReport
            Truthy if there are no faults: triangles are counter-clockwise and tile the exact convex
            hull, each edge is a subsegment or locally Delaunay, ties are broken canonically, and
            the subsegments of each row form a path from one endpoint to the other, which is
            straight if the row has neither crossings nor added vertices.

        Notes
        -----
        Exact, in about the time of the triangulation. Removed triangles are checked as well.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> print(ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], []).validate())
        a canonical constrained Delaunay triangulation
        """
        ends = self.duplicate_of[self._given.segments]
        conforming = self._options.conforming
        return validate(self._points, self._made, ends, conforming=conforming)

    @property
    def crs(self) -> str | None:
        """Coordinate reference system, as ``"EPSG:28992"`` or WKT; None for arrays."""
        return self._options.crs

    def _with_crs(self, crs: str | None) -> Self:
        """The same triangulation, declared to be in another reference system."""
        options = self._options._replace(crs=crs)
        return self._restored(self._points, self._given, self._made, options, self._stages)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        values = {"region": self.region}
        if self._given.origin.rings.any():
            values["polygon"] = self.polygon_of_simplex
        return Parts(
            self._points,
            self._simplices,
            of_simplices=values,
            segments=self.segments,
            crs=self.crs,
        )

    def _saved(self) -> dict[str, NDArray[Any]]:
        options = self._options
        choices = (
            _BOUNDARIES.index(options.boundary),
            _CROSSINGS.index(options.crossing),
            options.labeled,
            options.conforming,
            options.max_points,
        )
        crs = {} if self.crs is None else {"crs": np.array(self.crs)}
        return self._columns() | {"options": np.array(choices, dtype=np.int64)} | crs

    def _columns(self) -> dict[str, NDArray[Any]]:
        """The contents of a file other than the options, by their names in the file."""
        made, given, origin = self._made, self._given, self._given.origin
        return {
            "points": self._points,
            "simplices": made.simplices,
            "neighbors": made.neighbors,
            "duplicates": made.duplicates,
            "constrained": made.constrained,
            "added": made.added,
            "segments": made.segments,
            "source_start": made.source_start,
            "source": made.source,
            "forward": made.forward,
            "zero": made.zero,
            "through": made.through,
            "crossings": made.crossings,
            "input": given.segments,
            "geometries": origin.geometries,
            "rings": origin.rings,
            "parts": origin.parts,
            "holes": given.holes,
            "regions": given.regions,
            "labels": given.labels,
        }

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        boundary, crossing, labeled, conforming, max_points = arrays.pop("options").tolist()
        crs = arrays.pop("crs", None)
        options = Options(
            boundary=_BOUNDARIES[boundary],
            crossing=_CROSSINGS[crossing],
            conforming=bool(conforming),
            max_points=max_points,
            method="auto",
            workers=None,
            labeled=bool(labeled),
            crs=None if crs is None else str(crs),
        )
        points = arrays.pop("points")
        origin = Origin(*(arrays.pop(name) for name in Origin._fields))
        given = Given(
            arrays.pop("input"), origin, *(arrays.pop(name) for name in Given._fields[2:])
        )
        made = _core.ConstrainedTriangulation(**arrays)
        return cls._restored(points, given, made, options, {})

    def _described(self) -> str:
        points = counted(self.npoints, "point")
        if self.nadded:
            points += f" ({self.nadded} added)"
        given = counted(len(self.input_segments), "segment")
        return f"{points} and {given}: {counted(self.nsimplex, 'triangle')}"


def _given(
    segments: Indices,
    origin: Origin,
    holes: ArrayLike | None,
    regions: ArrayLike | None,
) -> Given:
    """Return the caller's input other than points, read-only; `origin` is so already."""
    segments = sealed(segments)
    if holes is None and regions is None:
        return Given(segments, origin, _NO_SEEDS, _NO_SEEDS, _NO_LABELS)
    seeds = as_seeds(regions, name="regions", columns=3)
    places = sealed(as_seeds(holes, name="holes").copy())
    return Given(segments, origin, places, sealed(seeds[:, :2].copy()), sealed(_labels(seeds)))


def _budget(max_points: int | None) -> int:
    if max_points is None:
        return _MOST_ADDED
    return as_limit(max_points, name="max_points")


def _own(array: Indices, given: ArrayLike) -> Indices:
    if array is given:
        return array.copy()
    if isinstance(given, list | tuple) or not np.may_share_memory(array, np.asarray(given)):
        return array
    return array.copy()


def _labels(seeds: Floats) -> Indices:
    """Return the third column of seeds as integers, or their rows."""
    if seeds.shape[1] == 2:
        return np.arange(len(seeds), dtype=np.int32)
    given = seeds[:, 2]
    wrong = np.flatnonzero((given != np.floor(given)) | (given < 0) | (given > 2**31 - 1))
    if wrong.size:
        rows = ", ".join(map(str, wrong[:10].tolist()))
        raise InputError(
            f"regions: {len(wrong)} of {counted(len(seeds), 'label')} (the third column) "
            f"{agreed(len(wrong), 'is not an integer', 'are not integers')} from 0 to 2**31 - 1; "
            f"{agreed(len(wrong), 'row', 'rows')} {rows}"
        )
    return given.astype(np.int32)
