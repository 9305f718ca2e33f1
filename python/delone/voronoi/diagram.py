"""The class Voronoi: diagrams in 2 to 8 dimensions as immutable arrays.

A diagram stores the cells of its dimension, `plane`, `space` or `higher`, which contain the arrays
of the core and have the same methods. What follows from them is computed on first use and kept.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_flag, as_queries, as_workers
from delone._base.counting import counted
from delone._base.georeference import crs_of, warn_of_degrees
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling.complex import Drawn, Stored
from delone._tiling.dimension import FLAT_OR_SOLID, only
from delone._tiling.higher.dimension import MOST
from delone.errors import InputError
from delone.regular import as_weights
from delone.validation import ValidationReport
from delone.voronoi import line, outline, thin
from delone.voronoi.higher import HigherCells
from delone.voronoi.plane import PlaneCells
from delone.voronoi.results import Neighbors, Rays, as_site
from delone.voronoi.rows import as_lists, of_pairs
from delone.voronoi.space import SpaceCells

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.delaunay import Delaunay
    from delone.periodic import PeriodicDelaunay
    from delone.regular import RegularTriangulation

__all__ = ["Voronoi"]

# By the number of coordinates.
_CELLS: dict[int, Any] = {2: PlaneCells, 3: SpaceCells} | dict.fromkeys(
    range(4, MOST + 1), HigherCells
)
# What to use instead of measures.
_WITHOUT = "cells with more coordinates have vertices and ridges, without measures"


class Voronoi(Stored, Drawn):
    """The Voronoi diagram of points with two to eight coordinates; can be clipped in 2-D and 3-D.

    Parameters
    ----------
    points : array_like, shape (n, d)
        The sites, finite, in any unit. They are copied, and results are exact for the given
        doubles. With more than three coordinates there is no clip, and there are no weights.
    clip : "box", sequence of floats, geometry or polyhedron, optional
        The region to which cells are clipped: ``"box"`` is the bounding box of the sites. Sites may
        lie outside it.

        In 2-D: a box ``(xmin, ymin, xmax, ymax)``; a shapely polygon or multipolygon, with or
        without holes, or a GeoJSON-like mapping; one or more rings of coordinates (k, 2), by the
        even-odd rule; or a GeoDataFrame, GeoSeries or `delone.io.GeometrySet`, for the union of its
        polygons. Its corners are transformed if it declares a reference system that differs from
        that of the points, with pyproj (extra ``geo``).

        In 3-D, a convex region: a box ``((xmin, ymin, zmin), (xmax, ymax, zmax))`` of shape (2, 3);
        half-spaces of shape (k, 4) with a bounded intersection, each ``(a, b, c, d)`` for ``a x + b
        y + c z + d <= 0``; or, for their convex hull, points of shape (k, 3) or an object with
        points and simplices such as a `ConvexHull`.
    fix : bool, optional
        Whether to repair an invalid geometry (as ``shapely.make_valid`` does) instead of rejecting
        it. A polyhedron is never invalid.
    weights : array_like, shape (n,), optional
        Weights of the sites, in squared units of the points. The diagram is then the power diagram,
        in which a location x belongs to the site p with the smallest ``|x - p|**2 - w``.
    periods : tuple of two floats or None, optional
        2-D only. ``(Lx, Ly)``: the sites repeat at these distances in x and in y, as for
        `PeriodicDelaunay`; None for a direction without a period. With two periods, `clip` must
        be None. With one, `clip` is ``"box"`` or a box that is infinite in the direction of
        the period, such as ``(-inf, ymin, inf, ymax)``.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane, without a warning.

    Attributes
    ----------
    points : ndarray of float64, shape (n, d)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    vertices : ndarray of float64, shape (k, d)
        The vertices of the whole diagram.
    ridge_points : ndarray of int32, shape (r, 2)
        The two sites of each ridge, an edge or face between two cells.
    ridge_vertices : list of list of int
        The vertices of each ridge. If the ridge is unbounded, the first is -1. In 3-D they are
        counter-clockwise as seen from the second site, in more dimensions ascending.
    regions : list of list of int
        The vertices of each cell, with -1 if it is unbounded: in 2-D counter-clockwise, in more
        dimensions ascending.
    point_region : ndarray of int32, shape (n,)
        The cell of each point, as an index into `regions`. Points with the same coordinates share a
        cell. -1 for a site that has no cell because of its weight.
    furthest_site : bool
        False.
    npoints, ndim : int
        Number of points and of coordinates.

    Raises
    ------
    DegenerateInputError
        There are no points. Or 3-D points lie in one plane, or there are fewer than four; the error
        is then that of `Delaunay` or `RegularTriangulation`: ``error.plane`` is the triangulation
        of the plane, and its ``circumcenters`` are the vertices of the diagram in this plane. Or
        points with more coordinates lie in a flat, as for `Delaunay`.
    NonFiniteError
        A coordinate or weight is NaN or infinite; ``error.rows`` lists the rows.
    ShapeError, DtypeError
        `points` is not a real array of shape (n, d) with d from 2 to 8, or the number of weights is
        different.
    InputError
        `clip` has no area or volume, is unbounded, is none of the above, or is invalid; the message
        says where. Or `periods` do not fit the points or the clip. Or there is one of these, or
        weights, and more than three coordinates.
    LimitError
        There are periods, and a vertex lies beyond the range of doubles; or, with one period, the
        next copy of a site does.
    MissingExtraError
        `clip` is a geometry, and shapely is not installed.

    Warns
    -----
    GeographicWarning
        The points are longitudes and latitudes; `delone.sphere` has diagrams of them.
    CRSWarning
        The reference system of the points or of `clip` is known, and that of the other is not.
    NearlyFlatWarning
        From 4-D on: the points lie in a flat except for rounding errors.
    ThinCellWarning
        When measures or polygons are computed: cells are only a few units in the last place wide,
        so rounding makes their areas or volumes meaningless; ``warning.rows`` contains their rows.

    Notes
    -----
    The diagram is the dual of the exact Delaunay triangulation (with weights, of the regular one),
    and its combinatorics are exact: any number of sites on one circle or sphere share one vertex,
    and no ridge has length or area 0. Only the coordinates of vertices are rounded: each is within
    4 units in the last place of the true one (:doc:`/mathematics/voronoi`). A vertex beyond the
    range of doubles is not listed; ridges that lead to it have -1 in its place.

    Names and meanings are those of ``scipy.spatial.Voronoi``. In 2-D, some input that SciPy rejects
    is accepted: the cell of a single site is the whole plane, the cells of two sites are
    half-planes, and those of sites on one line are strips between two half-planes.

    With weights a cell need not contain its site, and a site may have no cell: it is *hidden*.
    Edges lie on radical axes instead of bisectors.

    With two periods all cells are bounded, and their areas sum to that of one period; with one,
    cells at the border of the strip are unbounded. Each cell surrounds its site: all translates of
    vertices that a cell or ridge needs are listed, and `ridge_offsets` says across which border of
    the period a neighbor lies.

    With a `clip`, measures, centroids, neighbors and cells are those of the clipped cells; the
    attributes listed above remain those of the whole diagram. In a 2-D box the exact signed areas
    of the rings of `cell` sum to that of the box without any rounding. `polygons` contains these
    rings if they are valid. Rounded corners make a ring invalid only if the cell is a few units in
    the last place wide; it is then in `thin_cells`, unless its area is below the range of doubles.

    In 3-D, cells whose vertices all lie inside the clip are not changed. Each of the other cells is
    the clip polyhedron, cut by the planes of the neighbors one after another. An area or volume
    above the range of doubles is infinite; below the range, it is the smallest double. Clipped
    corners are accurate to about 1e-13 of the largest coordinate, also between sites that are close
    together, because exact arithmetic computes them where planes meet at a flat angle. The decision
    which corners exist uses rounded numbers: faces as small as rounding errors may be lost or
    added, and faces between sites that differ by a few units in the last place may be wrong. A cell
    contains the same corner twice if its surface would not be closed otherwise. Half-spaces are
    compared exactly, whatever their exponents, and the corners of their intersection are rounded
    once. This takes O(k^2) expected time for k half-spaces, about half a second for 300.

    With more than three coordinates a diagram has vertices, ridges and cells, but no measures,
    clip, rays or pictures. A ridge may have any number of vertices, including one and infinity. The
    number of vertices grows like that of simplices: call `delone.estimate` first.

    Without a clip, `plot` draws a 2-D diagram in the bounding box of the sites, enlarged by 10 %.
    In 3-D, it draws bounded and clipped cells, or the sites if there are none.

    Arrays are read-only and attributes cannot be set; attributes that are not listed above are
    computed on first use and kept. Time is that of the triangulation and O(n) for the rest;
    clipping to an outline adds O(s + c) for its s segments, and the intersection of each of the c
    cells on it.

    See Also
    --------
    delone.Delaunay : The dual.
    delone.RegularTriangulation : The dual of power diagrams.
    delone.compat.scipy.Voronoi : The same diagram with SciPy's interface.

    References
    ----------
    G. Voronoï, "Nouvelles applications des paramètres continus à la théorie des formes
    quadratiques", Journal für die reine und angewandte Mathematik 134 (1908).

    Examples
    --------
    >>> from delone import Voronoi
    >>> diagram = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], clip=(-1, -1, 5, 5))
    >>> diagram
    <Voronoi of 5 points: 4 vertices, 8 ridges, clipped to a box>
    >>> diagram.cell_areas.tolist(), diagram.cell_areas.sum()
    ([7.0, 7.0, 7.0, 7.0, 8.0], np.float64(36.0))
    >>> region = diagram.regions[diagram.point_region[4]]
    >>> sorted(diagram.vertices[region].tolist())
    [[0.0, 2.0], [2.0, 0.0], [2.0, 4.0], [4.0, 2.0]]
    >>> corners = [(x, y, z) for x in (0, 4) for y in (0, 4) for z in (0, 4)]
    >>> diagram = Voronoi([*corners, (2, 2, 2)], clip=((-1, -1, -1), (5, 5, 5)))
    >>> diagram
    <Voronoi of 9 points: 6 vertices, 20 ridges, clipped to a box>
    >>> diagram.cell_volumes[8].round(9), diagram.cell_volumes.sum().round(9)
    (np.float64(36.0), np.float64(216.0))
    >>> Voronoi([(x, y, z, t) for x in (0, 1) for y in (0, 2) for z in (0, 3) for t in (0, 4, 8)])
    <Voronoi of 24 points: 2 vertices, 52 ridges>
    """

    __slots__ = ("_cells",)

    _cells: PlaneCells | SpaceCells | HigherCells

    def __init__(
        self,
        points: ArrayLike,
        *,
        clip: Any = None,
        fix: bool = False,
        weights: ArrayLike | None = None,
        periods: tuple[float | None, float | None] | None = None,
        workers: int | None = None,
        planar: bool = False,
    ) -> None:
        if workers is not None:
            as_workers(workers)
        repair = as_flag(fix, name="fix")
        own = own_copy(points, ndim=None, most=MOST)
        if periods is None:
            warn_of_degrees(points, own, planar=planar)
        own_weights = None if weights is None else as_weights(weights, len(own))
        if own.shape[1] == 2:
            clip = outline.in_system(clip, crs_of(points))
        cells = _CELLS[own.shape[1]].made(
            own, own_weights, clip=clip, fix=repair, periods=periods, workers=workers
        )
        self._hold(cells=cells, workers=workers)
        self._refer(points)

    @classmethod
    def _from_cells(cls, cells: PlaneCells | SpaceCells | HigherCells, workers: int | None) -> Self:
        diagram = cls.__new__(cls)
        diagram._hold(cells=cells, workers=workers)
        return diagram

    def __reduce__(self) -> tuple[Any, ...]:
        return self._from_cells, (self._cells, self._workers)

    def _saved(self) -> dict[str, NDArray[Any]]:
        periods = () if self.periods is None else self.periods
        return {
            "points": self.points,
            "weights": np.empty(0) if self.weights is None else self.weights,
            "periods": np.array(
                [np.nan if each is None else each for each in periods], dtype=float
            ),
        } | self._cells.saved_clip()

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        points, weights = arrays["points"], arrays.get("weights", ())
        periods = arrays.get("periods", np.empty(0)).tolist()
        x_y = [None if np.isnan(each) else each for each in periods]
        options: dict[str, Any] = {"periods": tuple(x_y) or None}
        if len(weights):
            options["weights"] = weights
        clip = _CELLS[points.shape[1]].loaded_clip(arrays)
        return cls(points, clip=clip, planar=True, **options)

    @property
    def points(self) -> Floats:
        """The sites, (n, d), where d is `ndim`."""
        return self._cells.points

    @property
    def weights(self) -> Floats | None:
        """The weights, (n,); None without weights."""
        return self._cells.weights

    @property
    def clip(self) -> Any:
        """Where cells end; None without a clip.

        In 2-D, a box ``(xmin, ymin, xmax, ymax)`` or a shapely geometry; in 3-D, a
        `delone.voronoi.Polyhedron`.
        """
        return self._cells.public_clip

    @property
    def npoints(self) -> int:
        """Number of points, including duplicates."""
        return len(self.points)

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2 to 8."""
        return int(self.points.shape[1])

    @property
    def furthest_site(self) -> bool:
        """Whether cells belong to the furthest site; False."""
        return False

    @property
    def periods(self) -> tuple[float | None, float | None] | None:
        """The periods in x and y; None without periods."""
        return self._cells.periods

    @property
    def triangulation(self) -> Delaunay | RegularTriangulation | PeriodicDelaunay | None:
        """The triangulation that is dual to this diagram; None if all sites lie on one line."""
        return self._cells.mesh

    @property
    def vertices(self) -> Floats:
        """The vertices of the whole diagram, (k, d)."""
        return self._cells.dual.vertices

    @property
    def simplex_vertices(self) -> Indices:
        """The vertex of each simplex of `triangulation`, (m,); -1 beyond the range of doubles."""
        return self._cells.dual.simplex_vertex

    @property
    def ridge_points(self) -> Indices:
        """The two sites of each ridge, (r, 2).

        In 2-D the first lies to the left of the direction from the first of its `ridge_vertices`
        to the second.
        """
        return self._cells.dual.sites

    @property
    @kept
    def ridge_rows(self) -> tuple[Indices, Indices]:
        """`ridge_vertices` as compressed rows (indptr, indices)."""
        indptr, indices = self._cells.ridge_rows()
        return sealed(indptr), sealed(indices)

    @property
    @kept
    def ridge_vertices(self) -> list[list[int]]:
        """The vertices of each ridge; -1, which comes first, if it is unbounded.

        In 2-D, there are two; in 3-D, they are in order around the ridge, counter-clockwise as seen
        from its second site; in more dimensions, ascending.
        """
        return as_lists(*self.ridge_rows)

    @property
    @kept
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """The vertices of each ridge by the pair of its sites."""
        pairs = map(tuple, self.ridge_points.tolist())
        return dict(zip(pairs, self.ridge_vertices, strict=True))

    @property
    @only(2, "3-D diagrams have no periods")
    @kept
    def ridge_offsets(self) -> Indices:
        """The periods by which the second site of each ridge is translated, (r, 2); 2-D only.

        Relative to the first site, where the vertices of the ridge are. 0 without periods.
        """
        cells: Any = self._cells
        return sealed(cells.ridge_offsets())

    @property
    @kept
    def region_rows(self) -> tuple[Indices, Indices]:
        """`regions` as compressed rows (indptr, indices)."""
        indptr, indices = self._cells.region_rows()
        return sealed(indptr), sealed(indices)

    @property
    @kept
    def regions(self) -> list[list[int]]:
        """The vertices of each cell, with -1 if it is unbounded.

        In 2-D counter-clockwise, in more dimensions ascending.
        """
        return as_lists(*self.region_rows)

    @property
    def point_region(self) -> Indices:
        """The cell of each point, (n,), as an index of `regions`; -1 for a hidden site."""
        return self._cells.dual.region

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The site of each row, (n,): the first row with the same coordinates (and weight)."""
        found = np.arange(self.npoints, dtype=np.int32)
        has_cell = self.point_region >= 0
        found[has_cell] = self._cells.dual.site[self.point_region[has_cell]]
        return sealed(found)

    @property
    @kept
    def hidden(self) -> Indices:
        """The rows that have no cell, ascending: none without weights."""
        return sealed(np.flatnonzero(self.point_region < 0).astype(np.int32))

    @property
    @only(FLAT_OR_SOLID, "unbounded ridges have -1 among their `ridge_vertices`")
    @kept
    def rays(self) -> Rays:
        """The unbounded ridges, with their origins and directions.

        In 2-D, a ridge that lies entirely beyond the range of doubles has no ray. If only its ends
        lie beyond it, the ridge has two rays from one origin, like a line. In 3-D, an unbounded
        ridge has two rows: in the first, its boundary comes from infinity; in the second, it goes
        to infinity.
        """
        ridge, origin, direction = self._measured.rays()
        return Rays(sealed(ridge), sealed(origin), sealed(direction))

    @property
    @kept
    def _left(self) -> Any:
        """The clipped cells; without a clip, the whole cells."""
        found = self._measured.left
        thin.warn(self._rows_of(self._measured.thin()), self._measured.measure)
        return found

    def _rows_of(self, cells: NDArray[np.bool_]) -> Indices:
        """Return the rows whose cells are marked."""
        return np.flatnonzero(np.append(cells, False)[self.point_region]).astype(np.int32)

    def _by_row(self, measures: Floats, of_hidden: float = 0.0) -> Floats:
        """Return a measure of cells for each row."""
        fill = np.full((1, *measures.shape[1:]), of_hidden)
        return sealed(np.concatenate((measures, fill))[self.point_region])

    @property
    @only(FLAT_OR_SOLID, _WITHOUT)
    @kept
    def thin_cells(self) -> Indices:
        """The rows whose clipped cells are only a few units in the last place wide, (k,).

        Rounded corners do not determine the area or volume of such a cell, which may be 0. A
        `ThinCellWarning` names the rows when measures, polygons or faces are computed. If a cell
        with weights is empty within the clip, it is unknown whether rounding is the cause.
        """
        return sealed(self._rows_of(self._measured.thin()))

    @property
    @only(FLAT_OR_SOLID, _WITHOUT)
    @kept
    def cell_areas(self) -> Floats:
        """Areas of the clipped cells, in 3-D of their surfaces, (n,), in the square of the unit.

        Infinite for an unbounded cell, 0 for an empty cell and for hidden sites. Rows with the same
        coordinates share one cell, and each row gets its area.
        """
        return self._by_row(self._left.areas)

    @property
    @only(2, "3-D cells have `cell_areas`, those of their surfaces")
    @kept
    def cell_perimeters(self) -> Floats:
        """Perimeters of the clipped cells, (n,), including those of holes; 2-D only.

        Infinite for an unbounded cell, 0 for an empty cell and for hidden sites.
        """
        return self._by_row(self._left.perimeters)

    @property
    @only(3, "2-D cells have `cell_areas`")
    @kept
    def cell_volumes(self) -> Floats:
        """Volumes of the clipped cells, (n,), in the cube of the unit of the points; 3-D only.

        Infinite for an unbounded cell, 0 for an empty cell and for hidden sites.
        """
        return self._by_row(self._left.volumes)

    @property
    @only(FLAT_OR_SOLID, _WITHOUT)
    @kept
    def cell_centroids(self) -> Floats:
        """Centroids of the clipped cells, (n, d); NaN for unbounded and empty ones."""
        return self._by_row(self._left.centroids, np.nan)

    @property
    @only(3, "the lengths of 2-D ridges are in `neighbors`")
    @kept
    def ridge_areas(self) -> Floats:
        """Areas of the clipped ridges, (r,); infinite for unbounded ones; 3-D only."""
        return sealed(self._left.ridge_sizes())

    @property
    @only(FLAT_OR_SOLID, "`ridge_points` has the pairs of neighbors")
    @kept
    def neighbors(self) -> Neighbors:
        """Sites whose cells share an edge or face, with its length or area, as compressed rows.

        With a clip, only clipped edges and faces count. A duplicate has no neighbors: those of its
        cell belong to the first row.
        """
        sizes = self._left.ridge_sizes()
        rows = np.arange(len(sizes)) if self._cells.clip is None else np.flatnonzero(sizes > 0)
        pairs = self.ridge_points[rows].astype(np.int64)
        indptr, indices, beside = of_pairs(pairs, sizes[rows], self.npoints)
        return Neighbors(sealed(indptr), sealed(indices), sealed(beside))

    @only(FLAT_OR_SOLID, "`regions` and `point_region` have the vertices of cells")
    def cell(self, i: int) -> Any:
        """Return the cell of a site.

        Parameters
        ----------
        i : int
            Row of the site.

        Returns
        -------
        Cell or PolyhedralCell
            In 2-D or 3-D: its vertices, the clipped cell, its neighbors and measures.

        Raises
        ------
        IndexError
            There is no such row.

        Examples
        --------
        >>> from delone import Voronoi
        >>> cell = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1)).cell(0)
        >>> cell.area, cell.neighbors.tolist(), cell.sizes.tolist()
        (4.0, [1], [2.0])
        >>> [ring.tolist() for ring in cell.parts[0]]
        [[[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]]]
        >>> sites = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)]
        >>> cell = Voronoi(sites, clip=((0, 0, 0), (2, 2, 2))).cell(0)
        >>> cell.volume, cell.bounded, len(cell.faces)
        (8.0, False, 6)
        """
        row = as_site(i, self.npoints)
        region, site = int(self.point_region[row]), int(self.duplicate_of[row])
        indptr, indices, sizes = self.neighbors
        beside = slice(indptr[site], indptr[site + 1])
        return self._measured.cell(
            region,
            site=site,
            neighbors=indices[beside],
            sizes=sizes[beside],
            area=float(self.cell_areas[row]),
            centroid=self.cell_centroids[row],
        )

    def nearest(self, xi: ArrayLike) -> Indices:
        """Find the sites whose cells contain points, which are the nearest sites.

        Parameters
        ----------
        xi : array_like, shape (..., d)
            Points, inside or outside the clip.

        Returns
        -------
        ndarray of int32, shape (...)
            The site whose whole cell contains the point, the one with the smallest row if it lies
            between cells; -1 if a coordinate is NaN or infinite.

        Raises
        ------
        InputError
            The diagram has weights or periods.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., d).

        Notes
        -----
        Exact: a walk from vertex to vertex of the triangulation compares distances by predicates.
        If all sites lie on one line, they are searched along it.

        Examples
        --------
        >>> from delone import Voronoi
        >>> Voronoi([(0, 0), (4, 0), (4, 4), (0, 4)]).nearest([(1, 1), (9, 3), (2, 2)])
        array([0, 2, 0], dtype=int32)
        """
        if self.weights is not None or self.periods is not None:
            raise InputError("nearest is only available without weights and periods")
        queries = as_queries(xi, self.ndim, self.crs)
        if self.triangulation is None:
            return line.nearest(self.points, self._cells.dual.site, queries)
        mesh: Any = self.triangulation
        found: Indices = mesh.nearest(queries)
        return found

    def validate(self) -> ValidationReport:
        """Prove that the underlying triangulation is correct.

        Returns
        -------
        ValidationReport
            That of `triangulation`: truthy if it is correct. Empty, so truthy, if all sites lie on
            one line, whose order is exact.

        Examples
        --------
        >>> from delone import Voronoi
        >>> bool(Voronoi([(0, 0), (4, 0), (4, 4), (0, 4)]).validate())
        True
        """
        mesh: Any = self.triangulation
        report: ValidationReport = ValidationReport() if mesh is None else mesh.validate()
        return report

    @only(2, "`cell` has the faces of 3-D cells, `to_pyvista` the polyhedra")
    def polygons(self) -> NDArray[Any]:
        """Return the clipped cells as shapely geometries (extra ``geo``); 2-D only.

        Returns
        -------
        ndarray of object, shape (n,)
            For each point a polygon, or a multipolygon if the outline cuts a cell into parts; an
            empty polygon if nothing is left; None for an unbounded cell without a clip.

        Raises
        ------
        MissingExtraError
            shapely is not installed.

        Examples
        --------
        >>> from delone import Voronoi
        >>> left, right = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1)).polygons()
        >>> left.area, left.intersection(right).length
        (4.0, 2.0)
        """
        from delone.exchange.geopandas import by_region

        return by_region(self._left.polygons(), self.point_region)

    @only(2, "geopandas has no polyhedra")
    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Convert the cells to a geopandas table (extra ``geo``); 2-D only.

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each point. The cells replace the geometry of a
            GeoDataFrame, and its reference system is kept.
        crs : any, optional
            Coordinate reference system, anything that geopandas accepts; by default that of the
            points, or else of `data`.

        Returns
        -------
        GeoDataFrame
            One row for each point, in the order of the points and with the index of `data`.

        Raises
        ------
        MissingExtraError
            geopandas is not installed.
        InputError
            `data` does not have one row for each point.

        Examples
        --------
        >>> from delone import Voronoi
        >>> diagram = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1))
        >>> table = diagram.to_geopandas({"name": ["left", "right"]})
        >>> table.columns.tolist(), table.area.tolist()
        (['name', 'geometry'], [4.0, 4.0])
        """
        from delone.exchange.geopandas import beside

        own = self.crs if crs is None else crs
        return beside(self.polygons(), data, own)

    @only(FLAT_OR_SOLID, "PyVista has no cells of more dimensions")
    def to_pyvista(self) -> Any:
        """Convert the bounded or clipped cells to a PyVista mesh (extra ``pyvista``).

        Returns
        -------
        pyvista.PolyData or pyvista.UnstructuredGrid
            In 2-D polygons at z = 0, cells with holes as triangles; in 3-D polyhedra. Cell data
            ``"site"`` is the row of the site, ``"area"`` or ``"volume"`` the measure of its cell.

        Raises
        ------
        MissingExtraError
            PyVista is not installed.

        Examples
        --------
        >>> from delone import Voronoi
        >>> Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1)).to_pyvista().n_cells
        2
        >>> grid = [(x, y, z) for x in range(3) for y in range(3) for z in range(3)]
        >>> Voronoi(grid).to_pyvista().n_cells
        1
        """
        return self._with_measures.to_pyvista()

    @only(FLAT_OR_SOLID, "meshio has no cells of more dimensions; use `save`")
    def to_meshio(self) -> Any:
        """Convert the bounded or clipped cells to a meshio mesh (extra ``mesh``).

        Returns
        -------
        meshio.Mesh
            In 2-D polygons at z = 0, cells with holes as triangles; in 3-D polyhedra. There is one
            block for each number of corners, with the values of `to_pyvista`.

        Raises
        ------
        MissingExtraError
            meshio is not installed.

        Examples
        --------
        >>> from delone import Voronoi
        >>> mesh = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1)).to_meshio()
        >>> [(block.type, block.data.shape) for block in mesh.cells]
        [('polygon', (2, 4))]
        """
        return self._with_measures.to_meshio()

    @property
    def _with_measures(self) -> PlaneCells | SpaceCells:
        """The cells, after a warning about thin ones."""
        _ = self._left
        return self._measured

    @property
    def _measured(self) -> PlaneCells | SpaceCells:
        """The cells, in 2-D and 3-D."""
        cells: Any = self._cells
        return cells  # type: ignore[no-any-return]

    def _described(self) -> str:
        cells = self._cells
        parts = [counted(len(self.vertices), "vertex"), counted(len(self.ridge_points), "ridge")]
        if cells.clip is not None:
            parts.append(f"clipped to {cells.clip.name}")
        if cells.periods is not None:
            parts.append("periodic")
        return f"{counted(self.npoints, 'point')}: {', '.join(parts)}"
