"""The class Mesh: triangles of bounded angles that fill a domain, with what became of its segments.

A mesh holds its own triangles only. To change it is to make another: it is triangulated anew as a
`Domain`, where triangles outside come back, and goes through the core again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone.counting import counted
from delone.errors import DtypeError
from delone.exchange.parts import Parts
from delone.immutable import kept, sealed
from delone.plane import quality, topology
from delone.plane.triangulation import Triangulation
from delone.refine import domains
from delone.refine.domains import Counts, Domain, Lines
from delone.refine.handover import HandedOver
from delone.refine.report import reported

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from delone.refine.report import MeshReport

    Bools = NDArray[np.bool_]
    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Mesh"]


class Mesh(HandedOver, Triangulation):
    """A mesh of triangles, as `delone.mesh` makes it.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The vertices: those of the input that are used, in their order, then those that were added.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise.
    neighbors : ndarray of int32, shape (m, 3)
        ``neighbors[t, k]`` is the triangle across the edge opposite vertex k of triangle t; -1
        outside.
    segments : ndarray of int32, shape (q, 2)
        The edges into which the segments of the input were cut, those on hulls without a segment
        included.
    segment_source : tuple of ndarray
        The rows of the input that cover each of these, as compressed rows.
    point_source : ndarray of int32, shape (n,)
        The row of the input that each point is; -1 where it was added.
    region : ndarray of int32, shape (m,)
        The region of each triangle.
    report : MeshReport
        Points by cause, angles, and the triangles that the input spoils.

    Notes
    -----
    All arrays are read-only, and attributes cannot be set. Every point is a vertex of a triangle:
    what lies outside, or repeats another row, is left out. Each edge that is no segment is locally
    Delaunay, ties between cocircular points go by coordinates as in `Delaunay`.

    Examples
    --------
    >>> import delone
    >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    >>> mesh = delone.mesh(square, max_area=0.1)
    >>> bool(mesh.report), bool(mesh.areas.max() <= 0.1)
    (True, True)
    >>> float(mesh.areas.sum())
    1.0
    """

    __slots__ = (
        "_bound",
        "_counts",
        "_ends",
        "_forward",
        "_frozen",
        "_line_geometries",
        "_line_markers",
        "_on",
        "_point_markers",
        "_point_source",
        "_region",
        "_sides",
        "_source",
        "_start",
    )

    _bound: Floats
    _counts: NDArray[np.int64]
    _ends: Indices
    _forward: Bools
    _frozen: Bools
    _line_geometries: Indices
    _line_markers: Indices
    _on: Indices
    _point_markers: Indices
    _point_source: Indices
    _region: Indices
    _sides: Indices
    _source: Indices
    _start: NDArray[np.int64]

    def __init__(self, *given: Any, **options: Any) -> None:
        raise DtypeError("a Mesh is made by delone.mesh(domain), not by its class")

    @classmethod
    def _of(
        cls,
        domain: Domain,
        counts: Counts,
        min_angle: float,
        stages: dict[str, float],
        workers: int | None,
    ) -> Self:
        """Leave out what is outside, and the points that no triangle uses."""
        inside = np.flatnonzero(domain.labels >= 0)
        number = np.full(len(domain.labels) + 1, -1, dtype=np.int32)
        number[inside] = np.arange(len(inside), dtype=np.int32)
        used = np.zeros(len(domain.points), dtype=bool)
        used[domain.simplices[inside]] = True
        row = (np.cumsum(used) - 1).astype(np.int32)
        lines, line = _only_used(domain.lines, domain.sides[inside], row)
        arrays: dict[str, NDArray[Any]] = {
            "points": domain.points[used],
            "simplices": row[domain.simplices[inside]],
            "neighbors": number[domain.neighbors[inside]],
            "duplicates": np.empty((0, 2), dtype=np.int32),
            "region": domain.regions[domain.labels[inside]],
            "sides": line[domain.sides[inside]],
            "on": line[domain.on[used]],
            "point_source": domain.point_source[used],
            "point_markers": domain.point_markers[used],
            "ends": lines.ends,
            "start": lines.start,
            "source": lines.source,
            "forward": lines.forward,
            "frozen": lines.frozen,
            "line_markers": lines.markers,
            "line_geometries": lines.geometries,
            "bound": np.array([min_angle]),
            "counts": np.array([*counts], dtype=np.int64),
        }
        return cls._from_arrays(arrays, stages, workers)

    def _arrays(self) -> dict[str, NDArray[Any]]:
        names = (*Mesh.__slots__, "_points", "_simplices", "_neighbors", "_duplicates")
        return {name[1:]: getattr(self, name) for name in names}

    @property
    def _lines(self) -> Lines:
        return Lines(
            self._ends,
            self._start,
            self._source,
            self._forward,
            self._frozen,
            self._line_markers,
            self._line_geometries,
        )

    def _tiling(self) -> tuple[Indices, Indices]:
        return self._whole[0], self._whole[1]

    @property
    @kept
    def _number(self) -> Indices:
        return topology.rows_among(self._whole[0], self._simplices)

    @property
    @kept
    def _whole(self) -> tuple[Indices, Indices, Indices, Indices]:
        """Triangles of the whole hull: vertices, neighbours, regions by rows, lines."""
        edges, label = self._directed
        made, labels = domains.triangulated(
            self._points, self.segments, edges, label, self._workers
        )
        sides = domains.sides_at(
            made.simplices, made.constrained, (self.segments, self._segment_line)
        )
        return made.simplices, made.neighbors, labels, sides

    @property
    def _directed(self) -> tuple[Indices, Indices]:
        """The subsegments with a triangle to the left, and the rows of `_regions` there."""
        t, k = np.nonzero(self._sides >= 0)
        ends = self._simplices[t, (k + 1) % 3], self._simplices[t, (k + 2) % 3]
        label = np.searchsorted(self._regions, self._region[t]).astype(np.int32)
        return np.column_stack(ends), label

    @property
    @kept
    def _regions(self) -> Indices:
        return sealed(np.unique(self._region))

    def _domain(self) -> Domain:
        """Return the mesh as what the core takes."""
        simplices, neighbors, labels, sides = self._whole
        return Domain(
            points=self._points,
            point_source=self._point_source,
            point_markers=self._point_markers,
            on=self._on,
            simplices=simplices,
            neighbors=neighbors,
            labels=labels,
            regions=self._regions,
            sides=sides,
            lines=self._lines,
        )

    @property
    def region(self) -> Indices:
        """The region of each triangle, (m,).

        For seeds of regions their label, -1 without one; for geometries the number of the geometry;
        otherwise as in `ConstrainedDelaunay.region`.
        """
        return self._region

    @property
    def point_source(self) -> Indices:
        """The row of the input that each point is, (n,); -1 where it was added."""
        return self._point_source

    @property
    def point_markers(self) -> Indices:
        """The marker of each point, (n,): its own, or that of a segment that it lies on; else 0."""
        return self._point_markers

    @property
    def nadded(self) -> int:
        """Number of points that were added."""
        return int(np.count_nonzero(self._point_source < 0))

    @property
    def constrained(self) -> Bools:
        """Whether the edge opposite each vertex is part of a segment, (m, 3)."""
        return self._sides >= 0

    @property
    @kept
    def _ordered(self) -> tuple[Indices, Indices]:
        """The subsegments in order of their lines and along them, and their lines."""
        segments, line = domains.sides_of(self._simplices, self._neighbors, self._sides)
        first, last = (self._points[self._ends[line, i]] for i in (0, 1))
        step = last - first
        axis = (np.abs(step[:, 0]) < np.abs(step[:, 1])).astype(np.intp)
        row = np.arange(len(line))
        sign = np.where(step[row, axis] < 0, -1.0, 1.0)
        tail, head = (sign * self._points[segments[:, i]][row, axis] for i in (0, 1))
        turned = tail > head
        segments[turned] = segments[turned][:, ::-1]
        order = np.lexsort((np.minimum(tail, head), line))
        return sealed(np.ascontiguousarray(segments[order])), sealed(line[order])

    @property
    def segments(self) -> Indices:
        """The edges that are part of a segment, (q, 2), in the order of the input and along it.

        Each once, in the direction of the first row that covers it.
        """
        return self._ordered[0]

    @property
    def _segment_line(self) -> Indices:
        return self._ordered[1]

    @property
    @kept
    def segment_source(self) -> tuple[NDArray[np.int64], Indices]:
        """The rows of the input that cover `segments` as compressed rows (indptr, indices).

        ``segments[i]`` is part of the rows ``indices[indptr[i]:indptr[i + 1]]`` of the segments
        that were given; of none where it is an edge of a hull that no segment runs along.
        """
        line = self._segment_line
        counts = np.diff(self._start)[line]
        indptr = np.concatenate(([0], np.cumsum(counts)))
        offset = np.arange(indptr[-1]) - np.repeat(indptr[:-1], counts)
        return sealed(indptr), sealed(self._source[np.repeat(self._start[line], counts) + offset])

    @property
    def segment_markers(self) -> Indices:
        """The marker of each of `segments`, (q,): that of its row, 0 without one.

        Where geometries are meshed and no markers are given, each ring and line has its own: 1 for
        the first, 2 for the second, and so on.
        """
        return self._line_markers[self._segment_line]

    @property
    def geometry_of_segment(self) -> Indices:
        """The geometry that each of `segments` came from, (q,); -1 for those from arrays.

        Of a segment that several geometries share, the first one. `segment_markers` tells the rings
        of one geometry apart.
        """
        return self._line_geometries[self._segment_line]

    @property
    @kept
    def boundary_edges(self) -> Indices:
        """The edges with a triangle on one side only, (k, 2), the triangle to the left."""
        return sealed(topology.boundary_edges(self._simplices, self._neighbors))

    @property
    @kept
    def report(self) -> MeshReport:
        """Points by cause, angles reached, and the triangles that the input spoils."""
        return reported(
            self._points,
            self._simplices,
            self._sides,
            self._on,
            self._lines,
            min_angle=float(self._bound[0]),
            counts=self._counts,
            needles=self._needles,
        )

    def _needles(self) -> Indices:
        """Return the needle that each triangle is in, or -1."""
        simplices, needle = domains.needles_in(self._domain(), float(self._bound[0]))
        return needle[topology.rows_among(self._simplices, simplices)[:-1]]

    @property
    @kept
    def _inner(self) -> Bools:
        """Points that were added inside: neither on a line nor, as crossings are, its end."""
        found = (self._point_source < 0) & (self._on < 0)
        found[self._ends] = False
        return sealed(found)

    @property
    @kept
    def _below(self) -> NDArray[np.int64]:
        """Triangles below the bound."""
        return self.report.below

    def refine(
        self,
        marked: ArrayLike | None = None,
        *,
        ratio: float = 0.5,
        min_angle: float | None = None,
        max_area: Any = None,
        size: Any = None,
        max_points: int | None = None,
        progress: Callable[[int, float], object] | None = None,
    ) -> Mesh:
        """Make a mesh that is finer, where triangles are marked or everywhere.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles that are too large: a mask, or their numbers.
        ratio : float, optional
            A triangle of the finer mesh whose centre lies in a marked one has at most this share of
            its area. Those that reach into it from outside may be larger.
        min_angle : float, optional
            By default what the mesh was made with.
        max_area, size, max_points, progress : optional
            As for `delone.mesh`.

        Returns
        -------
        Mesh
            The finer mesh; its first points are those of this one. Without `marked` and sizes only
            angles are improved, where there is room to.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` names no triangles of the mesh, or `ratio` is not in (0, 1]; otherwise as for
            `delone.mesh`.
        BudgetExceededError
            As for `delone.mesh`.

        Notes
        -----
        Points, segments, markers and regions are inherited; the report counts all points added.
        Neighbours of marked triangles change as far as the bound of angles asks for it.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.1)
        >>> finer = mesh.refine(mesh.find_simplex([(0.1, 0.1)]))
        >>> finer.nsimplex > mesh.nsimplex, bool(finer.report)
        (True, True)
        """
        from delone.refine.adaptivity import finer

        return finer(
            self,
            marked,
            ratio=ratio,
            min_angle=min_angle,
            max_area=max_area,
            size=size,
            max_points=max_points,
            progress=progress,
        )

    def coarsen(self, marked: ArrayLike | None = None) -> Mesh:
        """Make a mesh that is coarser, where that is safe.

        Parameters
        ----------
        marked : array_like of bool, shape (m,), or of int, optional
            Triangles that may become larger; by default all.

        Returns
        -------
        Mesh
            A mesh without some of the points of these triangles. Points of the input and points on
            segments stay, and so does what is needed for the bound of angles. The mesh itself where
            no point can go.

        Raises
        ------
        InputError, ShapeError, DtypeError
            `marked` names no triangles of the mesh.

        Notes
        -----
        In one call no two neighbouring points go; call it again for more.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.001)
        >>> coarser = mesh.coarsen()
        >>> coarser.npoints < mesh.npoints, bool(coarser.report)
        (True, True)
        """
        from delone.refine.adaptivity import coarsened

        return coarsened(self, marked)

    def smooth(self, iterations: int = 1, method: str = "lloyd") -> Mesh:
        """Make a mesh whose free points are at better places.

        Parameters
        ----------
        iterations : int, optional
            How many rounds.
        method : {"lloyd", "odt", "laplace"}, optional
            Towards what a point moves: the centre of its Voronoi cell, as far as its triangles
            make it up; the mean of the circumcentres of its triangles, weighted by area, which is
            that of an optimal Delaunay triangulation; or the mean of its neighbours.

        Returns
        -------
        Mesh
            The mesh with moved points. Those of the input and on segments stay, and so do all of
            triangles that the input spoils.

        Raises
        ------
        InputError
            `iterations` is negative, or `method` none of the three.

        Notes
        -----
        The points are triangulated anew in each round, so the mesh is Delaunay. Where an angle
        would fall below the bound, points go back. Caps of areas are not looked at.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> mesh = delone.mesh(square, max_area=0.001)
        >>> better = mesh.smooth(5, "odt")
        >>> bool(better.quality().radius_ratio.mean() > mesh.quality().radius_ratio.mean())
        True
        """
        from delone.refine.smoothing import smoothed

        return smoothed(self, iterations, method)

    @kept
    def quality(self) -> quality.Quality:
        """Measure the triangles.

        Returns
        -------
        Quality
            Smallest and largest angles, areas, ratios of radii and of edges.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> delone.mesh(square).quality().largest_angle
        array([90., 90.])
        """
        return quality.measured(self._points, self._simplices, self._workers)

    def plot_quality(self, ax: Any = None) -> Any:
        """Draw the histogram of the angles, with the bound (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.

        Examples
        --------
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> ax = delone.mesh(square, max_area=0.01).plot_quality()
        """
        return self.quality().plot(ax, bound=float(self._bound[0]))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the mesh to an .npz file, whole or not at all.

        Parameters
        ----------
        path : str or path-like
            The file. No suffix is added.

        Raises
        ------
        OSError
            The file cannot be written, or is no regular file; what was there before is as it was.
        TypeError
            `path` is no path. File objects are refused.

        See Also
        --------
        load : The way back.
        delone.io.write_mesh : The files of other programs.

        Examples
        --------
        >>> import os, tempfile
        >>> import delone
        >>> square = [(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "square.npz")
        ...     delone.mesh(square).save(path)
        ...     delone.Mesh.load(path)
        <Mesh of 4 points (0 added): 2 triangles>
        """
        from delone import archive

        archive.write(path, self._arrays(), archive.MESH)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a mesh that `save` wrote.

        Parameters
        ----------
        path : str or path-like
            The file.

        Returns
        -------
        Mesh
            The mesh, with everything that it needs to be refined, coarsened or smoothed.

        Raises
        ------
        FileFormatError
            The file is torn or of another kind, or its arrays contradict each other.
        OSError
            The file cannot be read, or is no regular file.
        TypeError
            `path` is no path. File objects are refused.

        Notes
        -----
        Checked in linear time are shapes, dtypes, ranges, mutual neighbours, orientations, and that
        triangles agree on the segments and regions between them.

        Examples
        --------
        See `save`.
        """
        from delone import archive

        return cls._from_arrays(archive.read(path, archive.MESH), {}, None)

    def _parts(self) -> Parts:
        """What other libraries and files take."""
        return Parts(
            self._points,
            self._simplices,
            of_points={"marker": self._point_markers},
            of_simplices={"region": self._region},
            segments=self.segments,
            of_segments={"marker": self.segment_markers},
        )

    def __repr__(self) -> str:
        if not hasattr(self, "_points"):
            return "<Mesh of nothing yet>"
        points = f"{counted(self.npoints, 'point')} ({self.nadded} added)"
        return f"<Mesh of {points}: {counted(self.nsimplex, 'triangle')}>"


def _only_used(lines: Lines, sides: Indices, row: Indices) -> tuple[Lines, Indices]:
    """Keep the lines under edges, and say what each line is among them; the last entry is -1."""
    used = np.zeros(len(lines.ends) + 1, dtype=bool)
    used[sides] = True
    used = used[:-1]
    line = np.full(len(used) + 1, -1, dtype=np.int32)
    line[:-1][used] = np.arange(np.count_nonzero(used), dtype=np.int32)
    counts = np.diff(lines.start)
    covered = np.repeat(used, counts)
    start = np.concatenate(([0], np.cumsum(counts[used])))
    return Lines(
        row[lines.ends[used]],
        start.astype(np.int64),
        lines.source[covered],
        lines.forward[covered],
        lines.frozen[used],
        lines.markers[used],
        lines.geometries[used],
    ), line
