"""The class ConstrainedDelaunay: a triangulation that has given segments among its edges.

The core makes the triangles of the whole convex hull; `segmented` holds them and says which of
them are kept. Here are construction, search, proof and files. Walks go through the whole, so that
they pass through holes and around bays.

Chew, L. P. (1989), "Constrained Delaunay triangulations", Algorithmica 4, 97-108.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core, location
from delone._arrays import (
    as_choice,
    as_count,
    as_flag,
    as_seeds,
    as_segments,
    as_workers,
)
from delone.constrained import regions
from delone.constrained.editing import Editing
from delone.constrained.segmented import Given, Options, Origin, Segmented
from delone.constrained.validation import ConstrainedReport, validate
from delone.counting import counted
from delone.errors import InputError, InternalError
from delone.georeference import warn_of_degrees
from delone.immutable import kept, own_copy
from delone.plane import topology

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import Parts

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["ConstrainedDelaunay"]

# What vertices a call may add unless it says otherwise: about 1.5 GiB of arrays.
_MOST_ADDED = 4_000_000
# The third is for polygons alone.
_BOUNDARIES = ("hull", "outline", "polygons")
_CROSSINGS = ("raise", "split")


class ConstrainedDelaunay(Segmented):
    """The constrained Delaunay triangulation of points and segments in the plane.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Finite coordinates, as for `Delaunay`.
    segments : array_like of int, shape (s, 2)
        Edges that the triangulation must have, as pairs of rows of `points`. They may repeat,
        overlap, have no length or run through points; `report` says which do. Empty is fine.
    holes : array_like, shape (h, 2), optional
        Seeds of holes: the triangles of the area around each are removed, up to the segments.
    regions : array_like, shape (k, 2) or (k, 3), optional
        Seeds of regions: the triangles of the area around each get its label in `region`, the third
        column (an integer of at least 0) or else its row. Without seeds, areas are numbered from 0.
    boundary : {"hull", "outline"}, optional
        What is triangulated: the convex hull, or only what cannot be reached from outside of it
        without crossing a segment.
    crossing : {"raise", "split"}, optional
        Whether segments that cross are an error, or get a vertex where they do.
    conforming : bool, optional
        Add vertices on segments until the circle over each subsegment holds no vertex in its
        inside, so that each is an edge of a plain Delaunay triangulation of all vertices. (On a
        circle with other vertices it may not be that of the canonical one.)
    max_points : int, optional
        How many vertices may be added; by default 4,000,000. It bounds the pairs of crossing
        segments that are looked at, too, at 8 for each vertex and a million more.
    method, workers, planar : optional
        As for `Delaunay`. The answer is the same.

    Attributes
    ----------
    points : ndarray of float64, shape (n + nadded, 2)
        The rows that were given, then the vertices that were added.
    simplices : ndarray of int32, shape (m, 3)
        The triangles that are kept, as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        where there is none, or it was removed.
    constrained : ndarray of bool, shape (m, 3)
        Whether the edge opposite vertex k of triangle t is part of a segment.
    segments : ndarray of int32, shape (q, 2)
        The subsegments: the edges into which points and crossings divide the segments.

    Raises
    ------
    CrossingSegmentsError
        Segments cross, and `crossing` is ``"raise"``; ``error.pairs`` names all pairs of rows,
        ``error.points`` where they cross.
    BudgetExceededError
        More than `max_points` would have to be added, or more segments cross than it allows for;
        ``error.found`` of them were found.
    InputError
        A segment has an end that is no row of `points`, a label is no integer of at least 0, or an
        option is none of its choices. The message names the rows.
    DegenerateInputError, NonFiniteError, ShapeError, DtypeError, MemoryError, KeyboardInterrupt
        As for `Delaunay`; seeds must be finite, too.

    Notes
    -----
    Each edge that is no subsegment is locally Delaunay: no vertex that is visible from its
    triangles lies inside their circles (D. T. Lee and A. K. Lin, "Generalized Delaunay
    triangulation for planar graphs", 1986; Chew 1989). Ties between cocircular points go by
    coordinates as in `Delaunay`, so that one set of points and segments has one triangulation,
    however its rows are ordered, and no segments give the triangles of `Delaunay`.

    A crossing that is split gets the exact intersection of the two rows given, rounded once to the
    nearest doubles, and vertices that ``conforming=True`` adds are rounded as well. Segments then
    run through rounded vertices, and may bend there by that much; the triangulation is always
    valid.

    To conform, subsegments are halved, or near corners cut at powers of two, so that segments that
    meet at sharp angles stop disturbing each other (J. Ruppert, "A Delaunay refinement algorithm
    for quality 2-dimensional mesh generation", 1995). Subsegments between neighbouring doubles
    cannot be cut and stay as they are.

    Two segments that cross where a point of the input lies do not count as crossing: both run
    through it. Rows of `points` that lie in removed triangles only are no corners of any triangle.
    A seed that lies on a segment or outside has no effect; `report` names it.

    All arrays are read-only, attributes cannot be set. What is not listed above, such as `region`
    and `report`, is computed on first use and kept; holes and ``boundary="outline"`` are found at
    once, in linear time.

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
        options = Options(
            boundary=as_choice(boundary, _BOUNDARIES[:2], name="boundary"),
            crossing=as_choice(crossing, _CROSSINGS, name="crossing"),
            conforming=as_flag(conforming, name="conforming"),
            max_points=_budget(max_points),
            method=as_choice(method, tuple(_core.methods2()), name="method"),
            workers=workers,
            labelled=False,
        )
        own = own_copy(points)
        warn_of_degrees(points, own, planar=planar)
        rows = _own(as_segments(segments, len(own)), segments)
        given = _given(rows, Origin.of_arrays(len(rows)), holes, regions)
        self._compute(own, given, options._replace(labelled=len(given.regions) > 0))

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
        """Triangulate arrays of ours, with the origin of each segment."""
        as_choice(choices["boundary"], _BOUNDARIES, name="boundary")
        as_choice(choices["crossing"], _CROSSINGS, name="crossing")
        as_choice(choices["method"], tuple(_core.methods2()), name="method")
        choices["max_points"] = _budget(choices["max_points"])
        mesh = cls.__new__(cls)
        given = _given(segments, origin, holes, regions)
        mesh._compute(points, given, Options(labelled=len(given.regions) > 0, **choices))
        return mesh

    def _compute(self, points: Floats, given: Given, options: Options) -> None:
        """Let the core triangulate, and hold what it made beside what was given."""
        try:
            made, stages = _core.constrained2(
                points,
                given.segments,
                options.crossing == "split",
                options.conforming,
                options.max_points,
                options.method,
                as_workers(options.workers),
            )
        except InternalError as error:
            error.points = points
            raise
        if len(made.added):
            points = np.concatenate((points, made.added))
        self._set(points, given, made, options, dict(stages))

    def triangles_along(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the triangles that a straight way meets, in order.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Where the way begins and where it ends, outside or inside.

        Returns
        -------
        ndarray of int32, shape (k,)
            Triangles that have more than a point of the way, in their order from a to b. Where it
            leads through a hole or outside, nothing stands for that part. Where it runs along an
            edge, the triangle to the left of it, unless there is none; a way without length is a
            point to be found.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            `a` or `b` is no finite point in the plane.

        Notes
        -----
        Exact. Linear in the number of triangles met, after a walk to the first.

        Examples
        --------
        >>> from delone import ConstrainedDelaunay
        >>> mesh = ConstrainedDelaunay([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 2)])
        >>> way = mesh.triangles_along((0.5, 1.5), (1.5, 0.5))
        >>> len(way), mesh.neighbors[way[0]].tolist().count(way[1])
        (2, 1)
        """
        return self.walk(a, b)

    def segments_crossing(self, a: ArrayLike, b: ArrayLike) -> Indices:
        """Return the subsegments that a straight way crosses, in order.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            Where the way begins and where it ends, outside or inside.

        Returns
        -------
        ndarray of int32, shape (k,)
            Rows of `segments`, in the order of their crossings from a to b. Those in holes and
            outside of the outline count, too.

        Raises
        ------
        ShapeError, DtypeError, NonFiniteError
            `a` or `b` is no finite point in the plane.

        Notes
        -----
        Exact. To cross is to have one point in common that is an end of neither: a subsegment that
        only touches the way, or lies along it, does not cross it.

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
        """The subsegments as numbers in order, and their rows."""
        keys = topology.edge_keys(self.segments[:, 0], self.segments[:, 1], self.npoints)
        order = np.argsort(keys)
        return keys[order], order.astype(np.int32)

    def edit(self) -> Editing[Self]:
        """Return a context that collects changes and makes another triangulation of them.

        Returns
        -------
        Editing
            What takes the changes; see there.

        Notes
        -----
        The triangulation itself never changes. Since it is canonical, the outcome is the same as
        that of a new triangulation of the changed input.

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
        """What the constructor was given besides points and segments."""
        arguments: dict[str, Any] = self._options._asdict()
        if arguments.pop("labelled"):
            seeds, labels = self._given.regions, self._given.labels
            arguments["regions"] = np.column_stack((seeds, labels))
        return arguments | {"holes": self._given.holes}

    def validate(self) -> ConstrainedReport:
        """Prove that this is the canonical constrained triangulation, or name the culprits.

        Returns
        -------
        ConstrainedReport
            Truthy when all is right: triangles counter-clockwise and tiling the exact convex hull,
            each edge a subsegment or locally Delaunay, ties broken canonically, and the subsegments
            of each row a way from its one end to the other, straight where it has neither crossings
            nor added vertices.

        Notes
        -----
        Exact, in about the time of the triangulation. Removed triangles are checked, too.

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
        """The reference system of the geometries, as ``"EPSG:28992"`` or in WKT; None of arrays."""
        return self._options.crs

    def _with_crs(self, crs: str | None) -> Self:
        """The same, said to be in another reference system."""
        options = self._options._replace(crs=crs)
        return self._restored(self._points, self._given, self._made, options, self._stages)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        values = {"region": self.region}
        if self._given.origin.rings.any():
            values["polygon"] = self.polygon
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
            options.labelled,
            options.conforming,
            options.max_points,
        )
        crs = {} if self.crs is None else {"crs": np.array(self.crs)}
        return self._columns() | {"options": np.array(choices, dtype=np.int64)} | crs

    def _columns(self) -> dict[str, NDArray[Any]]:
        """What a file holds besides the options, by the names that it has there."""
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
        boundary, crossing, labelled, conforming, most = arrays.pop("options").tolist()
        crs = arrays.pop("crs", None)
        options = Options(
            boundary=_BOUNDARIES[boundary],
            crossing=_CROSSINGS[crossing],
            conforming=bool(conforming),
            max_points=most,
            method="auto",
            workers=None,
            labelled=bool(labelled),
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
    """Return what the caller gave besides points."""
    seeds = as_seeds(regions, name="regions", columns=3)
    return Given(
        segments=segments,
        origin=origin,
        holes=as_seeds(holes, name="holes").copy(),
        regions=seeds[:, :2].copy(),
        labels=_labels(seeds),
    )


def _budget(max_points: int | None) -> int:
    if max_points is None:
        return _MOST_ADDED
    return min(as_count(max_points, name="max_points"), 2**31 - 1)


def _own(array: Indices, given: ArrayLike) -> Indices:
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
            f"regions: {len(wrong)} of {len(seeds)} labels are no integers from 0 to 2**31 - 1; "
            f"rows {rows}"
        )
    return given.astype(np.int32)
