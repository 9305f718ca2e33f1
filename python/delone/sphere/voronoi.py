"""The class Voronoi of directions: cells on the sphere, whole or clipped."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_workers
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.immutable import kept, sealed
from delone._base.numbers import as_positive
from delone.errors import DegenerateInputError, DtypeError
from delone.sphere.cells import Cells, cells_of
from delone.sphere.circle import cells_of_few, first_rows, nearest_of_few
from delone.sphere.clipping import (
    Whole,
    as_region,
    clipped,
    loaded_region,
    saved_region,
    sums,
    whole_rings,
)
from delone.sphere.coordinates import as_step, directions_of, lonlat_of, queries_of, units_of
from delone.sphere.delaunay import Delaunay
from delone.sphere.globe import OnGlobe
from delone.voronoi.results import Neighbors
from delone.voronoi.rows import as_lists, of_pairs

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone.sphere.clipping import Clipped, Region
    from delone.sphere.validation import SphereReport

    # The radius, and the clip.
    Options = tuple[float, Region | None]

__all__ = ["Voronoi"]


class Voronoi(OnGlobe):
    """The Voronoi diagram of directions: which site is nearest on a sphere.

    Parameters
    ----------
    lonlat : array_like, shape (n, 2), optional
        Longitudes and latitudes of the sites, in degrees unless `degrees` is false.
    xyz : array_like, shape (n, 3), optional
        Vectors from the center of the sphere. Their lengths do not matter: a vector represents
        exactly its direction. Give either this or `lonlat`.
    radius : float, optional
        Radius of the sphere, for areas and lengths; by default 1, so that areas are steradians. The
        mean radius of the Earth is 6371.0088 km.
    clip : geometry or iterable of geometries, optional
        The region to which cells are clipped: polygons in longitudes and latitudes, in the unit of
        `degrees`, with or without holes, as for `from_geometry`. Their sides are arcs of great
        circles; they may cross the date line and surround a pole. The region is their union.
        Projected coordinates are transformed (extra ``geo``).
    winding : {"smaller", "ccw", "cw"}, optional
        Which side of its outer rings is inside a polygon of `clip`: the side that makes a geometry
        the smaller part of the sphere (the default), the left one, as in GeoJSON (RFC 7946), or the
        right one, as in shapefiles. A hemisphere is by default on the left.
    sides : {"arc", "parallel"}, optional
        The lines between the corners of `clip`: arcs of great circles (the default, with a warning
        for long ones), or straight lines on a map, such as parallels; see `from_geometry`. A
        rectangle of all longitudes and latitudes is the whole sphere.
    degrees : bool, optional
        Whether `lonlat`, `clip`, and longitudes and latitudes of queries, are in degrees (the
        default) or in radians.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 3)
        The unit vectors of the sites, rounded.
    radius : float
        As given.
    vertices : ndarray of float64, shape (k, 3)
        The unit vectors of the vertices: of points equally far from three or more nearest sites.
    ridge_points : ndarray of int32, shape (r, 2)
        The two sites of each ridge, an arc of a great circle between two cells.
    ridge_vertices : ndarray of int32, shape (r, 2)
        Its two vertices.
    regions : list of list of int
        The vertices of each cell, counter-clockwise seen from outside.
    point_region : ndarray of int32, shape (n,)
        The cell of each site, as an index into `regions`. Sites with the same direction share a
        cell; without such duplicates, it is the row itself.

    Raises
    ------
    DegenerateInputError
        There is no site.
    InputError
        `radius` is not positive and finite, or `clip` is not made of polygons, has no area, or has
        outer rings that run in both directions.
    DirectionError
        A vector is zero, a latitude is beyond a pole, or a longitude exceeds three turns;
        ``error.rows`` has the first such rows. Or a side of `clip` has opposite ends.
    NonFiniteError, ShapeError, DtypeError, LimitError, MemoryError
        As for `delone.sphere.Delaunay`.

    Warns
    -----
    LongitudeWarning
        Longitudes span more than 360 degrees: two conventions seem to be mixed.
    PolygonWarning
        A side of `clip` is longer than 30 degrees, or a polygon covers more than half the sphere.

    Notes
    -----
    The diagram is the dual of the convex hull of the directions, with exact predicates: any number
    of sites on one circle share one vertex, and no ridge has length zero. Only coordinates of
    vertices and measures are rounded. If all sites lie in one hemisphere, the facets of the hull
    that face away from the center, which are not triangles of the triangulation, are vertices on
    the other side, more than 90 degrees from their sites. They are found by random insertion into
    the boundary of the triangulation (Chew, 1990) in expected linear time.

    Three sites, and any number of sites on one circle, have lunes as cells: all ridges lead from
    one vertex to the opposite one. Two sites have one hemisphere each, with two ridges, each half
    of its boundary; the cell of one site is the whole sphere, without vertices. `triangulation` is
    None for one or two sites, and for sites on a great circle.

    The area of a cell is the sum of the triangles between its site and its ridges, each from a
    formula without cancellation. So even the areas of slivers, and of cells of sites that are a
    nanometer apart on the Earth, have relative errors of about 1e-11. They sum to the whole sphere.
    Lunes are measured from rounded unit vectors.

    With a `clip`, areas, neighbors and `polygons` are those of the clipped cells; the attributes
    listed above remain those of the whole diagram. Ridges, between their rounded vertices, and the
    sides of the region are arcs of one `ConstrainedDelaunay` with split crossings. Each crossing
    takes about 20 microseconds, in addition to two triangulations of all arcs. A side may pass
    through a vertex or run along a ridge: parts of cells that are narrower than 2e-15 (13
    nanometers on the Earth) are attributed to rounding, and are merged into the adjacent cell. The
    areas of the clipped cells sum to that of the region.

    See Also
    --------
    delone.sphere.Delaunay : The dual.
    delone.Voronoi : Diagrams in the plane and in 3-D.
    delone.compat.scipy.SphericalVoronoi : The same diagram with SciPy's interface.

    References
    ----------
    L. P. Chew, "Building Voronoi diagrams for convex polygons in linear expected time", technical
    report PCS-TR90-147, Dartmouth College (1990).

    A. Van Oosterom and J. Strackee, "The solid angle of a plane triangle", IEEE Transactions on
    Biomedical Engineering 30 (1983).

    Examples
    --------
    >>> from delone import sphere
    >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
    >>> diagram = sphere.Voronoi(lonlat=sites)
    >>> diagram
    <Voronoi of 6 directions: 8 vertices, 12 ridges>
    >>> (diagram.cell_areas / 3.141592653589793).round(9)
    array([0.66666667, 0.66666667, 0.66666667, 0.66666667, 0.66666667,
           0.66666667])
    >>> len(diagram.regions[0]), abs(diagram.vertices_lonlat[diagram.regions[0]]).round(4)[0]
    (4, array([135.    ,  35.2644]))

    Clipped to the northern hemisphere:

    >>> equator = {"type": "Polygon", "coordinates": [[(0, 0), (90, 0), (180, 0), (270, 0)]]}
    >>> (sphere.Voronoi(lonlat=sites, clip=equator).cell_areas / 3.141592653589793).round(9)
    array([0.66666667, 0.33333333, 0.33333333, 0.33333333, 0.33333333,
           0.        ])

    On the Earth, in square kilometers:

    >>> stations = [(10, 50), (12, 48), (8, 47), (11, 52)]
    >>> sphere.Voronoi(lonlat=stations, radius=6371.0088).cell_areas.sum().round(-6)
    np.float64(510000000.0)
    """

    __slots__ = ("_cells", "_degrees", "_mesh", "_radius", "_region", "_vectors")

    _cells: Cells
    _degrees: bool
    _mesh: Delaunay | None
    _radius: float
    _region: Region | None
    _vectors: Floats

    def __init__(
        self,
        *,
        lonlat: ArrayLike | None = None,
        xyz: ArrayLike | None = None,
        radius: float = 1.0,
        clip: Any = None,
        winding: str = "smaller",
        sides: str | None = None,
        degrees: bool = True,
        workers: int | None = None,
    ) -> None:
        length = as_positive(radius, name="radius", finite=True)
        region = as_region(clip, winding, sides, degrees=degrees, workers=workers)
        vectors = directions_of(lonlat, xyz, degrees=degrees, workers=workers)
        self._fill(vectors, (length, region), degrees, workers)

    @classmethod
    def from_delaunay(
        cls,
        mesh: Delaunay,
        *,
        radius: float = 1.0,
        clip: Any = None,
        winding: str = "smaller",
        sides: str | None = None,
    ) -> Self:
        """Return the diagram of the points of a triangulation.

        Parameters
        ----------
        mesh : Delaunay
            A triangulation of directions.
        radius : float, optional
            Radius of the sphere.
        clip, winding, sides : optional
            As for `Voronoi`, in the unit of angles of the triangulation.

        Returns
        -------
        Voronoi
            The diagram, with the unit of angles and the number of threads of the triangulation.

        Raises
        ------
        DtypeError
            `mesh` is not a `delone.sphere.Delaunay`.
        InputError
            `radius` is not positive and finite, or as for the `clip` of `Voronoi`.

        Examples
        --------
        >>> from delone import sphere
        >>> mesh = sphere.Delaunay(lonlat=[(0, 0), (10, 0), (10, 10), (0, 10)])
        >>> sphere.Voronoi.from_delaunay(mesh)
        <Voronoi of 4 directions: 4 vertices, 6 ridges>
        """
        if not isinstance(mesh, Delaunay):
            raise DtypeError(f"mesh must be a sphere.Delaunay, got {type(mesh).__name__}")
        region = as_region(clip, winding, sides, degrees=mesh._degrees, workers=mesh.workers)
        made = cls.__new__(cls)
        made._hold_dual(mesh, (as_positive(radius, name="radius", finite=True), region))
        return made

    def _fill(self, vectors: Floats, options: Options, degrees: bool, workers: int | None) -> None:
        try:
            mesh = Delaunay._of_vectors(vectors, degrees, workers)
        except DegenerateInputError as error:
            if not len(error.chain):
                raise
            cells = cells_of_few(error.chain.astype(np.int32), vectors, units_of(vectors, workers))
        else:
            self._hold_dual(mesh, options)
            return
        self._put(cells, sealed(vectors), options, degrees=degrees, workers=workers)

    def _hold_dual(self, mesh: Delaunay, options: Options) -> None:
        common: dict[str, Any] = {"degrees": mesh._degrees, "workers": mesh.workers, "mesh": mesh}
        self._put(cells_of(mesh), mesh.vectors, options, **common)

    def _put(
        self,
        cells: Cells,
        vectors: Floats,
        options: Options,
        *,
        degrees: bool,
        workers: int | None,
        mesh: Delaunay | None = None,
    ) -> None:
        radius, region = options
        self._hold(
            cells=cells,
            degrees=degrees,
            mesh=mesh,
            radius=radius,
            region=region,
            vectors=vectors,
            workers=workers,
        )
        if region is not None:
            # Errors about the clip are those of the constructor.
            _ = self._left

    @classmethod
    def _again(
        cls, given: Delaunay | Floats, options: Options, degrees: bool, workers: int | None
    ) -> Self:
        made = cls.__new__(cls)
        if isinstance(given, Delaunay):
            made._hold_dual(given, options)
        else:
            made._fill(given, options, degrees, workers)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        given = self._vectors if self._mesh is None else self._mesh
        return self._again, (given, (self._radius, self._region), self._degrees, self._workers)

    @classmethod
    def _stored_as(cls) -> str:
        return "sphere.Voronoi"

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {
            "vectors": self._vectors,
            "radius": np.array([self._radius]),
            "degrees": np.array([self._degrees]),
        } | saved_region(self._region)

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        options = arrays["radius"].tolist()[0], loaded_region(arrays)
        made = cls.__new__(cls)
        made._fill(arrays["vectors"], options, bool(arrays["degrees"][0]), None)
        return made

    def _described(self) -> str:
        points = counted(self.npoints, "direction")
        if duplicates := int((self._cells.cell < 0).sum()):
            points += f" ({counted(duplicates, 'duplicate')})"
        parts = [counted(len(self.vertices), "vertex"), counted(len(self.ridge_points), "ridge")]
        if self._region is not None:
            parts.append("clipped")
        return f"{points}: {', '.join(parts)}"

    @property
    def triangulation(self) -> Delaunay | None:
        """The triangulation whose dual this is; None if all sites are on one great circle.

        One or two sites always are.
        """
        return self._mesh

    @property
    def radius(self) -> float:
        """The radius of the sphere."""
        return self._radius

    @property
    @kept
    def vertices(self) -> Floats:
        """The unit vectors of the vertices, rounded, (k, 3)."""
        return sealed(self._cells.vertices)

    @property
    @kept
    def vertices_lonlat(self) -> Floats:
        """Longitudes, -180 to 180, and latitudes of the vertices in degrees, rounded, (k, 2)."""
        return sealed(lonlat_of(self._cells.vertices))

    @property
    @kept
    def simplex_vertices(self) -> Indices:
        """The vertex of each triangle of `triangulation`, (m,)."""
        return sealed(self._cells.simplex_vertex)

    @property
    @kept
    def ridge_points(self) -> Indices:
        """The two sites of each ridge, (r, 2).

        The first lies to the left of the direction from the first of its `ridge_vertices` to the
        second, seen from outside.
        """
        return sealed(self._cells.sites)

    @property
    @kept
    def ridge_vertices(self) -> Indices:
        """The two vertices of each ridge, (r, 2)."""
        return sealed(self._cells.ends)

    @property
    @kept
    def ridge_lengths(self) -> Floats:
        """The lengths of the ridges, (r,): angles times the radius."""
        return sealed(self._spans[0] * self._radius)

    @property
    @kept
    def region_rows(self) -> tuple[Indices, Indices]:
        """`regions` as compressed rows (indptr, indices)."""
        return sealed(self._cells.starts), sealed(self._cells.entries)

    @property
    @kept
    def regions(self) -> list[list[int]]:
        """The vertices of each cell, counter-clockwise seen from outside."""
        return as_lists(*self.region_rows)

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The site of each row, (n,): the first row with the same direction."""
        if self._mesh is not None:
            return self._mesh.duplicate_of
        return sealed(first_rows(self._vectors, self._cells.cell))

    @property
    @kept
    def point_region(self) -> Indices:
        """The cell of each site, (n,), as an index of `regions`."""
        return sealed(self._cells.cell[self.duplicate_of])

    @property
    @kept
    def _spans(self) -> tuple[Floats, Floats]:
        return self._cells.spans(self._vectors, as_workers(self._workers))

    @property
    @kept
    def _left(self) -> Clipped | None:
        """The clipped cells; None without a clip."""
        if self._region is None:
            return None
        whole = Whole(self._cells, self._spans[0], self.points, self._nearest)
        return clipped(whole, self._region, self._workers)

    @property
    @kept
    def cell_areas(self) -> Floats:
        """The areas of the clipped cells, (n,), in steradians times the square of the radius.

        Rows with the same direction share one cell, and each has its area; 0 for an empty cell.
        Without a clip, the areas of the cells sum to 4 pi times the square of the radius.
        """
        if self._left is not None:
            found = self._left.areas(self.npoints)
        else:
            found = sums(self._cells.sites.ravel(), self._spans[1].ravel(), self.npoints)
            if not len(self.ridge_points):
                # One site has the whole sphere.
                found[self._cells.cell >= 0] = 4 * np.pi
        return sealed(found[self.duplicate_of] * self._radius**2)

    @property
    @kept
    def neighbors(self) -> Neighbors:
        """Sites whose clipped cells share a ridge, with its length, as compressed rows.

        A duplicate has no neighbors: those of its cell belong to the first row.
        """
        pairs, lengths = self.ridge_points.astype(np.int64), self.ridge_lengths
        if self._left is not None:
            pairs, angles = self._left.ridges()
            lengths = angles * self._radius
        elif len(pairs) == 2:
            # Two sites have two ridges, which are one circle.
            pairs, lengths = pairs[:1], lengths.sum(keepdims=True)
        indptr, indices, beside = of_pairs(pairs, lengths, self.npoints)
        return Neighbors(sealed(indptr), sealed(indices), sealed(beside))

    def polygons(self) -> list[list[list[Floats]]]:
        """Return the clipped cells as polygons in longitudes and latitudes.

        Returns
        -------
        list of list of list of ndarray of float64, shape (k, 2)
            For each row the parts of its cell; each part is a polygon, a list of rings: corners in
            degrees, with arcs of great circles between them, not closed. The part is to the left of
            its rings: outer rings are counter-clockwise seen from outside, and holes clockwise. If
            there are several, the ring with the smallest area to its left, the outer one, is first.
            An empty cell has no parts.

        Notes
        -----
        Without a clip, each cell is one ring, its region; if all sites are on one circle, so that
        ridges are half circles, the ring also contains their midpoints. The cell of one site, the
        whole sphere, is a part without rings. Longitudes are from -180 to 180; a ring that crosses
        the date line jumps there. Rows with the same direction have the same cell.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
        >>> square = {"type": "Polygon", "coordinates": [[(-9, -9), (9, -9), (9, 9), (-9, 9)]]}
        >>> cells = sphere.Voronoi(lonlat=sites, clip=square).polygons()
        >>> len(cells[0]), len(cells[1]), sorted(cells[1][0][0].round(6).tolist())
        (0, 1, [[-9.0, -9.0], [-9.0, 9.0], [9.0, -9.0], [9.0, 9.0]])
        """
        # Arcs of half a turn need their midpoints, which `_rings` adds.
        lunes = self._cells.middles is not None or not len(self.ridge_points)
        if self._left is not None or lunes:
            cells = self._rings() if self._left is None else self._left.polygons(self.npoints)
            found = [[[lonlat_of(ring) for ring in rings] for rings in parts] for parts in cells]
        else:
            corners = self.vertices_lonlat
            found = [[] for _ in range(self.npoints)]
            for row in np.flatnonzero(self._cells.cell >= 0).tolist():
                found[row] = [[corners[self.regions[self._cells.cell[row]]]]]
        return [found[row] for row in self.duplicate_of.tolist()]

    def to_geopandas(self, data: Any = None, *, crs: Any = None, step: float = 1.0) -> Any:
        """Convert the clipped cells to a GeoDataFrame (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each site. The cells replace the geometry of a
            GeoDataFrame.
        crs : any, optional
            Coordinate reference system of longitudes and latitudes, by default EPSG:4326.
        step : float, optional
            Maximum distance, in degrees, between the corners that represent arcs of great circles.

        Returns
        -------
        GeoDataFrame
            One row for each site, with the index of `data`: polygons or multipolygons in degrees,
            cut at 180 degrees and completed along the edge of the map if they contain a pole, as
            RFC 7946 recommends. An empty cell is an empty polygon; sites with the same direction
            have the same cell.

        Raises
        ------
        MissingExtraError
            geopandas is not installed.
        InputError
            `data` does not have one row for each site, or `step` is not positive.

        Notes
        -----
        Exact predicates decide whether an arc goes east or west, and whether a cell contains a
        pole. Coordinates are rounded.

        Examples
        --------
        >>> from delone import sphere
        >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
        >>> table = sphere.Voronoi(lonlat=sites).to_geopandas({"name": list("NabcdS")})
        >>> table.geometry.bounds.round(1).iloc[3].tolist(), table.geom_type[3]
        ([-180.0, -45.0, 180.0, 45.0], 'MultiPolygon')
        """
        from delone.exchange.geopandas import beside, shapely_or_say
        from delone.sphere.flat import flat_polygon

        width = as_step(step)
        shapely = shapely_or_say()
        left = self._left
        cells = self._rings() if left is None else left.polygons(self.npoints)
        shapes = np.full(self.npoints, shapely.Polygon(), dtype=object)
        for row in np.flatnonzero(self.duplicate_of == np.arange(self.npoints)).tolist():
            parts = [flat_polygon(rings, width) for rings in cells[row]]
            if parts:
                shapes[row] = parts[0] if len(parts) == 1 else shapely.union_all(parts)
        if hasattr(data, "geometry") and hasattr(data, "crs"):
            data = data.drop(columns=data.geometry.name)
            data = require("pandas", extra="geo", what="a table of cells").DataFrame(data)
        return beside(shapes[self.duplicate_of], data, "EPSG:4326" if crs is None else crs)

    def _rings(self) -> list[list[list[Floats]]]:
        """Return parts of whole cells as rings of unit vectors; a single site has no ring."""
        if not len(self.ridge_points):
            return [[[]] if cell >= 0 else [] for cell in self._cells.cell.tolist()]
        return whole_rings(self._cells, self._spans[0], self.points, self.regions)

    def _nearest(self, places: Floats) -> Indices:
        """Return the sites nearest to vectors, even if all sites are on one great circle."""
        if self._mesh is not None:
            return self._mesh._ask(places, self._mesh._locator.nearest)
        sites = np.flatnonzero(self._cells.cell >= 0).astype(np.int32)
        return nearest_of_few(sites, self._vectors, self.points, places)

    def nearest(self, xi: ArrayLike) -> Indices:
        """Find the sites whose cells contain directions, which are the nearest sites.

        Parameters
        ----------
        xi : array_like, shape (..., 2) or (..., 3)
            Longitudes and latitudes, in the unit of the constructor, or vectors of any length.

        Returns
        -------
        ndarray of int32, shape (...)
            The site whose cell contains each, the smallest row of several; -1 for NaN and vectors
            of length zero.

        Raises
        ------
        DirectionError
            A latitude is beyond a pole, or a longitude exceeds three turns.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2) or (..., 3).

        Notes
        -----
        Exact, see `delone.sphere.Delaunay.nearest`. Sites on one great circle, which have no
        triangulation, are compared with each query.

        Examples
        --------
        >>> from delone import sphere
        >>> diagram = sphere.Voronoi(lonlat=[(170, 0), (-170, 0), (180, 10), (180, -10)])
        >>> diagram.nearest([(175, 1), (-171, 1)])
        array([0, 1], dtype=int32)
        """
        if self._mesh is not None:
            return self._mesh.nearest(xi)
        queries = queries_of(xi, degrees=self._degrees, workers=self._workers)
        return self._nearest(queries.reshape(-1, 3)).reshape(queries.shape[:-1])

    def validate(self) -> SphereReport:
        """Prove that the underlying triangulation is correct.

        Returns
        -------
        SphereReport
            The report of `triangulation`, truthy if it is correct. If all sites are on one great
            circle, whose order is exact, the report is empty and therefore truthy.

        Examples
        --------
        >>> from delone import sphere
        >>> bool(sphere.Voronoi(lonlat=[(0, 0), (90, 0), (0, 90), (45, 45)]).validate())
        True
        """
        from delone.sphere.validation import SphereReport

        return SphereReport() if self._mesh is None else self._mesh.validate()

    def _draw(self, ax: Any, points: bool | None, options: dict[str, Any]) -> Any:
        from delone.sphere.picture import plot_diagram

        return plot_diagram(self, ax, points, options)
