"""The class Voronoi: the diagram of points in the plane as immutable arrays.

The core makes the arrays of the whole diagram (see `dual`); what follows from them, and what a clip
leaves of the cells, is computed on first use and kept.
"""

from __future__ import annotations

import inspect
import itertools
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone._arrays import as_flag, as_workers
from delone.counting import counted
from delone.exchange.geopandas import by_region, cells_to_geopandas
from delone.georeference import warn_of_degrees
from delone.immutable import Immutable, kept, own_copy, sealed
from delone.regular import as_weights
from delone.voronoi import clipping, dual, outline, sites, thin
from delone.voronoi.cells import Cell, Neighbors, Rays, as_site
from delone.voronoi.lists import compressed, gaps_once
from delone.voronoi.torus import PeriodicDual

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._core import Diagram2, Diagram3
    from delone.delaunay import Delaunay
    from delone.periodic import PeriodicDelaunay
    from delone.regular import RegularTriangulation
    from delone.voronoi.clipping import Clipped

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["Voronoi"]

_SPACE = 3


class Voronoi(Immutable):
    """The Voronoi diagram of points in the plane, whole or clipped; of points in space, likewise.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        The sites, finite, in any unit. They are copied and taken as the exact numbers which they
        denote. Of points of shape (n, 3) the diagram of space is made, which is described at
        `delone.voronoi.SpaceVoronoi`.
    clip : "box", sequence of 4 floats, or geometry, optional
        What to cut the cells to: the box of the sites; the box
        ``(xmin, ymin, xmax, ymax)``; or a polygon or multipolygon of shapely, with or without
        holes, also as a mapping of the form of GeoJSON, or the polygons of a table or series of
        geopandas together. Sites may lie outside.
    fix : bool, optional
        Whether to repair an invalid geometry (as ``shapely.make_valid`` does) instead of refusing
        it.
    weights : array_like, shape (n,), optional
        Weights of the sites, in the square of the unit of the points: then this is the power
        diagram, in which a place belongs to the site with the least ``|x - p|**2 - w``.
    periods : tuple of two floats or None, optional
        ``(Lx, Ly)``: the sites come again after these distances in x and in y, as for
        `PeriodicDelaunay`; None for a direction in which they do not. With two periods there is
        nothing to clip. With one, `clip` is ``"box"`` or a box that is infinite in the direction
        of the period, as ``(-inf, ymin, inf, ymax)``.
    workers : int, optional
        How many threads may work; by default one for each core. The answer is the same.
    planar : bool, optional
        As for `Delaunay`: longitudes and latitudes are meant as coordinates of a plane.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The sites.
    weights : ndarray of float64, shape (n,), or None
        Their weights.
    vertices : ndarray of float64, shape (k, 2)
        The vertices of the whole diagram.
    ridge_points : ndarray of int32, shape (r, 2)
        The two sites between which each ridge (an edge of cells) lies.
    ridge_vertices : ndarray of int32, shape (r, 2)
        The two vertices of each ridge; -1, which comes first, where it goes on for ever.
    regions : list of list of int
        For each cell its vertices, counter-clockwise, with -1 where it is open.
    point_region : ndarray of int32, shape (n,)
        The cell of each point, as an index of `regions`. Points with the same coordinates share
        their cell. -1 for a site that weights leave without a cell.
    furthest_site : bool
        False.
    npoints, ndim : int
        Number of points, and 2.

    Raises
    ------
    DegenerateInputError
        There is no point at all.
    NonFiniteError
        A coordinate is NaN or infinite; ``error.rows`` tells where.
    ShapeError, DtypeError
        `points` is no array of real points in the plane, or there are not as many weights.
    InputError
        `clip` has no area, is no polygon, or is invalid; the message says where. Or there are
        periods, and it is no box as above.
    LimitError
        There are periods, and a vertex lies beyond the range of doubles, or, with one period, the
        next copy of a site does.
    MissingExtraError
        `clip` is a geometry, and shapely is not installed.

    Warns
    -----
    ThinCellWarning
        When areas or polygons are asked for: cells are only a few units in the last place wide, so
        that rounding leaves nothing of their areas; ``warning.rows`` has their rows.

    Notes
    -----
    The diagram is the dual of the exact Delaunay triangulation (with weights, of the regular one),
    and all that is combinatorial in it is exact: sites on one circle share one vertex, whatever
    their number, and no ridge has length 0. One thing is rounded, the coordinates of vertices: each
    is within 4 units in the last place of the true one (:doc:`/mathematics/voronoi`). A vertex
    beyond the range of doubles is not listed; ridges that lead to it end in -1 and have a ray.

    Names and meanings are those of ``scipy.spatial.Voronoi``. What SciPy refuses is no exception
    here: one site has the whole plane for its cell, two have half-planes, and sites on one line
    have strips between two half-planes.

    With weights a cell need not hold its site, and a site may have no cell: it is *hidden*. Edges
    lie on radical axes instead of bisectors.

    With two periods all cells are bounded, and their areas sum to that of one period; with one,
    cells at the border of the strip are open. Each cell is given around its site, where that is:
    vertices are listed with all translates that some cell or ridge has, and `ridge_offsets` tells
    across which border of the period a neighbour lies.

    In a `clip`, areas, centroids, perimeters, neighbours and polygons are those of what is left of
    the cells; the attributes listed above remain those of the whole diagram. In a box the exact
    areas of the polygons sum to that of the box without any rounding.

    Arrays are read-only and attributes cannot be set; the attributes not listed above are computed
    on first use and kept. Time is that of the triangulation and O(n) for the rest; clipping to an
    outline costs O(s + c) more for its s segments, and the intersection of each of the c cells on
    it.

    See Also
    --------
    delone.Delaunay : The dual.
    delone.RegularTriangulation : The dual of power diagrams.
    delone.compat.scipy.Voronoi : SciPy's interface to the letter.

    References
    ----------
    G. Voronoï, "Nouvelles applications des paramètres continus à la théorie des formes
    quadratiques", Journal für die reine und angewandte Mathematik 134 (1908).

    Examples
    --------
    >>> from delone import Voronoi
    >>> diagram = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], clip=(-1, -1, 5, 5))
    >>> diagram
    <Voronoi diagram of 5 points: 4 vertices, 8 ridges, clipped to a box>
    >>> diagram.cell_areas.tolist(), diagram.cell_areas.sum()
    ([7.0, 7.0, 7.0, 7.0, 8.0], np.float64(36.0))
    >>> region = diagram.regions[diagram.point_region[4]]
    >>> sorted(diagram.vertices[region].tolist())
    [[0.0, 2.0], [2.0, 0.0], [2.0, 4.0], [4.0, 2.0]]
    """

    __slots__ = (
        "_clip",
        "_dual",
        "_mesh",
        "_periods",
        "_points",
        "_repeated",
        "_weights",
        "_workers",
    )

    _clip: outline.Clip | None
    _dual: Diagram2
    _mesh: Delaunay | RegularTriangulation | PeriodicDelaunay | None
    _periods: tuple[float | None, float | None] | None
    _points: Floats
    # The diagram and what belongs to it, where there are periods.
    _repeated: PeriodicDual | None
    _weights: Floats | None
    _workers: int

    def __new__(cls, points: ArrayLike | None = None, **options: Any) -> Voronoi:
        """Make a `SpaceVoronoi` where points have three coordinates."""
        if cls is Voronoi and _columns(points) == _SPACE:
            from delone.voronoi.space import SpaceVoronoi

            return object.__new__(SpaceVoronoi)
        return object.__new__(cls)

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
        if hasattr(self, "_points"):
            raise AttributeError("a Voronoi never changes: make another one")
        threads = as_workers(workers)
        repair = as_flag(fix, name="fix")
        own = own_copy(points)
        if periods is None:
            warn_of_degrees(points, own, planar=planar)
        heavy = None if weights is None else as_weights(weights, len(own))
        mesh: Any
        arrays: Diagram2 | PeriodicDual
        lengths = None
        if periods is None:
            mesh, arrays = sites.in_plane(own, heavy, threads)
        else:
            mesh, arrays, lengths = sites.repeated(own, heavy, periods, threads)
        where = outline.as_clip(clip, own, fix=repair, periods=lengths)
        self._fill(
            points=own,
            weights=heavy,
            mesh=mesh,
            dual=arrays,
            clip=where,
            periods=lengths,
            workers=threads,
        )

    # What the constructor takes is said by __init__, not by __new__.
    __signature__: ClassVar[inspect.Signature] = inspect.Signature(
        list(inspect.signature(__init__).parameters.values())[1:]
    )

    def _fill(
        self,
        *,
        dual: Diagram2 | Diagram3 | PeriodicDual,
        points: Floats,
        weights: Floats | None,
        **rest: Any,
    ) -> None:
        """Set everything there is; afterwards nothing can be set."""
        repeated = None
        if isinstance(dual, PeriodicDual):
            repeated = dual.sealed()
            dual = repeated.cells
        else:
            dual = type(dual)(*map(sealed, dual.arrays()))
        self._hold(
            points=sealed(points),
            weights=None if weights is None else sealed(weights),
            dual=dual,
            repeated=repeated,
            **rest,
        )

    @classmethod
    def _from_parts(cls, parts: dict[str, Any]) -> Voronoi:
        diagram = cls.__new__(cls)
        diagram._fill(**parts)
        return diagram

    def __reduce__(self) -> tuple[Any, ...]:
        names = ("points", "weights", "mesh", "clip", "periods", "workers")
        parts = {name: getattr(self, f"_{name}") for name in names}
        return self._from_parts, (parts | {"dual": self._repeated or self._dual},)

    @property
    def points(self) -> Floats:
        """The sites, (n, d), where d is `ndim`."""
        return self._points

    @property
    def weights(self) -> Floats | None:
        """The weights, (n,); None without."""
        return self._weights

    @property
    def clip(self) -> Any:
        """Where cells end: a box ``(xmin, ymin, xmax, ymax)``, a geometry, or None."""
        if self._clip is None:
            return None
        return self._clip.bounds if self._clip.outline is None else self._clip.outline

    @property
    def npoints(self) -> int:
        """Number of points, duplicates included."""
        return len(self._points)

    @property
    def ndim(self) -> int:
        """Number of coordinates, 2."""
        return 2

    @property
    def furthest_site(self) -> bool:
        """Whether cells belong to the furthest site; False."""
        return False

    @property
    def periods(self) -> tuple[float | None, float | None] | None:
        """The periods in x and y; None without."""
        return self._periods

    @property
    def triangulation(self) -> Delaunay | RegularTriangulation | PeriodicDelaunay | None:
        """The triangulation whose dual this is; None where all sites lie on one line."""
        return self._mesh

    @property
    def vertices(self) -> Floats:
        """The vertices of the whole diagram, (k, d)."""
        return self._dual.vertices

    @property
    def ridge_points(self) -> Indices:
        """The two sites of each ridge, (r, 2).

        The first lies to the left of the way from the first of its `ridge_vertices` to the second.
        """
        return self._dual.sites

    @property
    @kept
    def ridge_offsets(self) -> Indices:
        """By how many periods the second site of each ridge is moved, (r, 2), seen from the first.

        Zeros without periods. The vertices of a ridge lie where its first site sees them.
        """
        if self._repeated is not None:
            return self._repeated.moved
        return sealed(np.zeros((len(self.ridge_points), 2), dtype=np.int32))

    @property
    @kept
    def ridge_vertices(self) -> Indices:
        """The two vertices of each ridge, (r, 2); -1, which comes first, where it is open."""
        ends = self._dual.ends
        return ends if not len(self._dual.rays) else sealed(np.maximum(ends, -1))

    @property
    @kept
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """The two vertices of each ridge by the pair of its sites."""
        pairs = map(tuple, self.ridge_points.tolist())
        return dict(zip(pairs, self.ridge_vertices.tolist(), strict=True))

    @property
    @kept
    def regions(self) -> list[list[int]]:
        """For each cell its vertices, counter-clockwise, with -1 where it is open."""
        indptr, indices = (array.tolist() for array in self.region_vertices)
        lists = [indices[a:b] for a, b in itertools.pairwise(indptr)]
        if len(self._dual.rays):
            return [gaps_once(region) for region in lists]
        return lists

    @property
    def region_vertices(self) -> tuple[Indices, Indices]:
        """`regions` as compressed rows (indptr, indices), a -1 for each open end of a ridge."""
        return self._dual.region_starts, self._dual.region_vertices

    @property
    def point_region(self) -> Indices:
        """The cell of each point, (n,), as an index of `regions`."""
        return self._dual.region

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The site of each row, (n,): the first row with the same coordinates (and weight)."""
        found = np.arange(self.npoints, dtype=np.int32)
        has_cell = self.point_region >= 0
        found[has_cell] = self._dual.site[self.point_region[has_cell]]
        return sealed(found)

    @property
    @kept
    def hidden(self) -> Indices:
        """The rows that have no cell, ascending: none without weights."""
        return sealed(np.flatnonzero(self.point_region < 0).astype(np.int32))

    @property
    def triangle_vertices(self) -> Indices:
        """The vertex of each triangle of `triangulation`, (m,); -1 beyond the range of doubles."""
        return self._dual.simplex_vertex

    @property
    @kept
    def rays(self) -> Rays:
        """The ridges that go on for ever, with origins and directions.

        A ridge that lies beyond the range of doubles as a whole has no ray. Where only its ends do,
        it has two from one origin, like a line.
        """
        ends, directions = self._dual.ends, self._dual.rays
        ridge, which = np.nonzero(ends < 0)
        other = ends[ridge, 1 - which]
        line = np.flatnonzero(other < 0)
        a, b = self._ends_of(ridge[line])
        heavy = None if self._weights is None else self._weights[self.ridge_points[ridge[line]]]
        origin = np.empty((len(ridge), 2))
        origin[line] = dual.foot(a, b, heavy)
        origin[other >= 0] = self.vertices[other[other >= 0]]
        direction = directions[~ends[ridge, which]]
        there: NDArray[np.bool_] = np.all(np.isfinite(origin), axis=1)
        there[line] &= self._lies_between(origin[line], ends[ridge[line]])
        rows = sealed(ridge[there].astype(np.int32))
        return Rays(rows, sealed(origin[there]), sealed(direction[there]))

    def _lies_between(self, origin: Floats, ends: Indices) -> NDArray[np.bool_]:
        """Whether points of lines lie before the vertices beyond the range that end them."""
        found = np.ones(len(origin), dtype=bool)
        for end in ends.T:
            direction, place = self._dual.rays[~end], self._dual.beyond[~end]
            k = np.abs(direction).argmax(axis=1)[:, None]
            with np.errstate(over="ignore", invalid="ignore"):
                way = np.take_along_axis(direction, k, 1) * np.take_along_axis(place - origin, k, 1)
            found &= ~(way[:, 0] <= 0)
        return found

    def _ends_of(self, ridges: NDArray[Any]) -> tuple[Floats, Floats]:
        """Where the two sites of some ridges are, as the first one sees the second."""
        a, b = self._points[self.ridge_points[ridges]].swapaxes(0, 1)
        if self.periods is None:
            return a, b
        lengths = np.array([length or 0.0 for length in self.periods])
        return a, b + self.ridge_offsets[ridges] * lengths

    @property
    @kept
    def _clipped(self) -> Clipped:
        """What is left of the cells: all bounded ones where there is no clip."""
        found = clipping.cells(
            self._points,
            self._weights,
            self._repeated or self._dual,
            self._clip,
            periods=self._periods,
            workers=self._workers,
        )
        thin.tell(self._rows_of(self._thin(found)), "areas")
        return found

    def _thin(self, clipped: Clipped) -> NDArray[np.bool_]:
        """Which cells are too thin for their areas to be known."""
        # A cell without weights has its site, and something of what is around it.
        lost = np.flatnonzero((clipped.areas == 0) & (clipped.perimeters == 0))
        if self._weights is not None:
            lost = lost[:0]
        elif self._clip is not None and len(lost):
            lost = lost[self._clip.holds(self._points[self._dual.site[lost]])]
        found = thin.among(clipped.areas, clipped.perimeters, clipped.starts, clipped.corners)
        found[lost] = True
        return found

    def _rows_of(self, cells: NDArray[np.bool_]) -> Indices:
        """The rows whose cells are marked."""
        return np.flatnonzero(np.append(cells, False)[self.point_region]).astype(np.int32)

    @property
    @kept
    def thin_cells(self) -> Indices:
        """The rows whose cells within the clip are only a few units in the last place wide, (k,).

        Rounded corners tell nothing of the area of such a cell, which may be 0. A
        `ThinCellWarning` names the rows when areas, perimeters, centroids or polygons are asked
        for. Of cells that have weights, and nothing left within the clip, it is not known whether
        rounding has taken it.
        """
        return sealed(self._rows_of(self._thin(self._clipped)))

    @property
    @kept
    def cell_areas(self) -> Floats:
        """Areas of the cells within the clip, (n,), in the square of the unit of the points.

        Infinite for an unbounded cell, 0 for one of which nothing is left and for hidden sites.
        Rows with the same coordinates share one cell and have the same area each.
        """
        return sealed(np.append(self._clipped.areas, 0.0)[self.point_region])

    @property
    @kept
    def cell_perimeters(self) -> Floats:
        """Perimeters of the cells within the clip, (n,), in the unit of the points, holes included.

        Infinite for an unbounded cell, 0 for one of which nothing is left and for hidden sites.
        """
        return sealed(np.append(self._clipped.perimeters, 0.0)[self.point_region])

    @property
    @kept
    def cell_centroids(self) -> Floats:
        """Centroids of the cells within the clip, (n, 2); NaN for unbounded and empty ones."""
        nowhere = [[np.nan, np.nan]]
        return sealed(np.concatenate((self._clipped.centroids, nowhere))[self.point_region])

    @property
    @kept
    def neighbors(self) -> Neighbors:
        """Sites whose cells have an edge in common, with its length, as compressed rows.

        In a clip only what is left of an edge counts. A duplicate has no neighbours of its own:
        those of its cell are with the first row.
        """
        lengths = self._clipped.ridge_lengths()
        rows = np.flatnonzero(lengths > 0) if self._clip is not None else np.arange(len(lengths))
        pairs = self.ridge_points[rows].astype(np.int64)
        indptr, indices, beside = compressed(pairs, lengths[rows], self.npoints)
        return Neighbors(sealed(indptr), sealed(indices), sealed(beside))

    def cell(self, i: int) -> Cell:
        """Return the cell of a site.

        Parameters
        ----------
        i : int
            Row of the site.

        Returns
        -------
        Cell
            Its vertices, what is left of it within the clip, neighbours and measures.

        Raises
        ------
        IndexError
            There is no such row.

        Examples
        --------
        >>> from delone import Voronoi
        >>> cell = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1)).cell(0)
        >>> cell.area, cell.neighbors.tolist(), cell.lengths.tolist()
        (4.0, [1], [2.0])
        >>> [ring.tolist() for ring in cell.parts[0]]
        [[[-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0]]]
        """
        row = as_site(i)
        region, site = int(self.point_region[row]), int(self.duplicate_of[row])
        start, end = self._dual.region_starts[region : region + 2] if region >= 0 else (0, 0)
        entries = self._dual.region_vertices[start:end]
        bounded = region < 0 or (bool(len(entries)) and bool((entries >= 0).all()))
        if not bounded and len(entries):
            entries = np.roll(entries, -int(np.flatnonzero(entries < 0)[0]))
        indptr, indices, lengths = self.neighbors
        beside = slice(indptr[site], indptr[site + 1])
        return Cell(
            site=site,
            vertices=self.vertices[entries[entries >= 0]],
            bounded=bounded,
            parts=self._clipped.parts(region) if region >= 0 else (),
            neighbors=indices[beside],
            lengths=lengths[beside],
            area=float(self.cell_areas[row]),
            perimeter=float(self.cell_perimeters[row]),
            centroid=self.cell_centroids[row],
        )

    def polygons(self) -> NDArray[Any]:
        """Return what is left of the cells as geometries of shapely (extra ``geo``).

        Returns
        -------
        ndarray of object, shape (n,)
            For each point a polygon, or a multipolygon where the outline cuts a cell into parts; an
            empty polygon where nothing is left; None for an unbounded cell without a clip.

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
        return by_region(self._clipped.polygons(), self.point_region)

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Return the cells as a table of geopandas (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to carry, a row for each point. The geometry of a GeoDataFrame gives way to the
            cells, and its reference system is kept.
        crs : any, optional
            Reference system, as geopandas takes it.

        Returns
        -------
        GeoDataFrame
            A row for each point, in the order of the points and with the index of `data`.

        Raises
        ------
        MissingExtraError
            geopandas is not installed.
        InputError
            `data` has another number of rows.

        Examples
        --------
        >>> from delone import Voronoi
        >>> diagram = Voronoi([(0, 0), (2, 0)], clip=(-1, -1, 3, 1))
        >>> table = diagram.to_geopandas({"name": ["left", "right"]})
        >>> table.columns.tolist(), table.area.tolist()
        (['name', 'geometry'], [4.0, 4.0])
        """
        return cells_to_geopandas(self.polygons(), data, crs)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the diagram with matplotlib (extra ``plot``).

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Where to draw; by default on new axes.
        **options
            ``values``, array_like of float, shape (n,): cells are coloured by them; ``cmap``: the
            colours; ``colorbar``: False leaves the scale out; ``points``: whether sites are drawn,
            by default where there are few enough to be told apart; ``linewidth``: that of edges.

        Returns
        -------
        matplotlib Axes
            What was drawn on.

        Raises
        ------
        MissingExtraError
            matplotlib is not installed.
        InputError
            ``values`` has another length.

        Notes
        -----
        Without a clip the diagram is drawn as far as the box of the sites and a tenth more.

        Examples
        --------
        >>> from delone import Voronoi
        >>> ax = Voronoi([(0, 0), (2, 0), (1, 2)], clip="box").plot()
        >>> ax.get_aspect()
        1.0
        """
        from delone.plot import plot

        return plot(self, ax, **options)

    def __repr__(self) -> str:
        if not hasattr(self, "_clip"):  # the constructor failed, or has not run
            return "<Voronoi diagram of nothing yet>"
        where = "" if self._clip is None else f", clipped to {self._clip.name}"
        where += "" if self.periods is None else ", periodic"
        numbers = [counted(self.npoints, "point")]
        numbers.append(counted(len(self.vertices), "vertex"))
        numbers.append(counted(len(self.ridge_points), "ridge"))
        return f"<Voronoi diagram of {numbers[0]}: {', '.join(numbers[1:])}{where}>"


def _columns(points: ArrayLike | None) -> int:
    """How many coordinates points have; 0 where they are no table."""
    try:
        shape = np.shape(points) if points is not None else ()
    except ValueError:  # rows of different lengths, which the constructor refuses
        return 0
    return int(shape[1]) if len(shape) > 1 else 0
