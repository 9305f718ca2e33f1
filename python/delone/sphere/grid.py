"""The class Grid: cells on the sphere, for regridding."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_number, as_text, as_workers
from delone.errors import InputError
from delone.sphere import rings as rings_of
from delone.sphere.boxes import rows_of
from delone.sphere.coordinates import directions_of, lonlat_of
from delone.sphere.fesom import median_dual, read_text
from delone.sphere.formats import Choices, read_cells
from delone.sphere.gaussian import gaussian_bounds
from delone.sphere.grid_cells import GridCells
from delone.sphere.healpix import healpix_corners
from delone.sphere.large import tell_clockwise, wound
from delone.sphere.nested import require_nested
from delone.sphere.rings import as_bounds, as_corners, as_starts, merged_corners

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.formats import Cells
    from delone.sphere.voronoi import Voronoi

__all__ = ["Grid"]


class Grid(GridCells):
    """Cells on the sphere: the grid of a model, a map or a set of polygons.

    Make one with a class method:

    - `from_dataset`: the grid of a model in an xarray dataset, by its convention
    - `from_lonlat`: between meridians and parallels, by bounds
    - `from_curvilinear`: quadrilaterals, by two-dimensional arrays of corners
    - `from_mesh`: any polygons, by their corners
    - `from_polygons`: shapely geometries and GeoDataFrames
    - `from_voronoi`: the cells of a `delone.sphere.Voronoi` diagram
    - `from_healpix`: HEALPix pixels
    - `from_gaussian`: a Gaussian grid, full or reduced
    - `from_fesom`: a FESOM mesh in text files

    Attributes
    ----------
    ncells : int
        Number of cells.
    shape : tuple of int
        Shape of fields on the grid: (rows, columns) for cells in rows and columns, else (ncells,).
        Cells are numbered in row-major order.
    areas : ndarray of float64, shape (ncells,)
        Areas in steradians.
    edges : {"parallel", "arc"}
        The kind of sides: meridians and parallels, or arcs of great circles.
    mask : ndarray of bool, shape (ncells,), or None
        The cells to use, if a dataset specifies them: for `Overlaps.to_weights`.
    centers_lonlat : ndarray of float64, shape (ncells, 2)
        Longitudes and latitudes where fields are interpolated from and to: those of a dataset,
        sites, or nodes; otherwise halfway between bounds or the mean direction of the corners.
    bounds : pair of ndarray of float64, or None
        Edges between columns and between rows, in degrees, of cells between meridians and parallels
        in rows and columns.
    report : GridReport
        Which corners were changed, and which cells are special.

    Notes
    -----
    Polygons may be concave, have holes and several parts, repeat corners, have corners on the sides
    of others, run clockwise, and lie at or around a pole. Each part must be within a hemisphere;
    `from_mesh` and `from_polygons` also accept larger ones if `winding` says which side of their
    corners is meant. The start, direction and repeated corners of a ring, and the order of bounds,
    do not change a single bit of the results. Areas are accurate to a few units in their last
    place, even for cells of centimeters.

    See Also
    --------
    delone.sphere.Overlaps : The areas that cells of two grids share.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> grid = sphere.Grid.from_lonlat(np.arange(0, 361, 1), np.arange(-90, 91, 1))
    >>> grid
    <Grid of 64800 cells (180 x 360), parallels>
    >>> bool(np.isclose(grid.areas.sum(), 4 * np.pi, rtol=1e-14))
    True
    """

    __slots__ = ()

    def __init__(self) -> None:
        raise InputError(
            "make a Grid with a class method: Grid.from_dataset, from_lonlat, from_curvilinear, "
            "from_mesh, from_polygons, from_voronoi, from_healpix, from_gaussian or from_fesom"
        )

    @classmethod
    def from_dataset(
        cls,
        ds: Any,
        *,
        name: str | None = None,
        coords: tuple[str, str] | None = None,
        edges: str | None = None,
        degrees: bool | None = None,
        infer_bounds: bool = False,
        cells: str | None = None,
        merge: float = 1e-12,
        workers: int | None = None,
    ) -> Self:
        """Return the grid of a model, by the convention of its dataset.

        Parameters
        ----------
        ds : xarray.Dataset, xarray.DataArray or uxarray.Grid
            With longitudes, latitudes and bounds of the CF conventions, or a mesh in the convention
            of UGRID, SCRIP, ESMF, MPAS, ICON, FESOM, Exodus, OASIS, GEOS-CS or HEALPix. For
            uxarray, also objects with ``uxgrid``.
        name : str, optional
            Selects one of several grids: a UGRID mesh, an OASIS grid, or a variable with values.
        coords : pair of str, optional
            Names of the longitude and the latitude of centers, where there are several.
        edges : {"parallel", "arc"}, optional
            The kind of sides. By default "parallel" for CF rows and columns and for lists of pairs
            of bounds, and otherwise "arc". SCRIP grids can also have "parallel".
        degrees : bool, optional
            Whether angles without an attribute ``units`` are in degrees. By default they raise an
            error, unless the convention fixes their unit.
        infer_bounds : bool, optional
            Whether to infer missing bounds from centers; see Notes.
        cells : {"nodes", "faces"}, optional
            For UGRID and FESOM meshes: where fields are. Around nodes, a cell has its corners in
            the middle of faces and edges: the median dual. By default nodes for FESOM, and
            otherwise faces, or the ``location`` of the variable `name`.
        merge : float, optional
            Corners closer than this, in radians, are merged; 0 merges none.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            The grid. Its shape is that of fields, and `mask` is that of the dataset.

        Raises
        ------
        InputError
            No grid is found, or several; bounds or units are missing; a node is out of range; or
            the grid has no nodes for `cells`.
        DirectionError, ShapeError, DtypeError, NonFiniteError
            As for `from_curvilinear`.

        Notes
        -----
        Node numbers start where the dataset or its convention says. Padding after the corners of a
        cell is ignored; cells without corners are empty.

        Cells in one list, such as those of a reduced grid, have the corners in their bounds. If
        bounds have two entries, cells lie between meridians and parallels. Two meridians have two
        intervals between them; the cell is in the one that contains its center.

        Bounds are inferred as follows. In rows and columns, they are halfway between neighbors, and
        the outer bounds are as far from their center as the inner ones; latitudes beyond a pole
        become the pole. In two dimensions, corners are in the middle of four centers, and the outer
        ones are mirrored. For centers in one list, the cells are those of the Voronoi diagram,
        which cover the whole sphere.

        Bounds of neighboring columns or rows that differ by rounding in their dtype are merged.

        Examples
        --------
        >>> import numpy as np, xarray
        >>> from delone import sphere
        >>> ds = xarray.Dataset(
        ...     coords={
        ...         "lon": ("lon", np.arange(0.5, 360), {"units": "degrees_east"}),
        ...         "lat": ("lat", np.arange(-89.5, 90), {"units": "degrees_north"}),
        ...     }
        ... )
        >>> sphere.Grid.from_dataset(ds, infer_bounds=True)
        <Grid of 64800 cells (180 x 360), parallels>
        """
        near = _as_merge(merge)
        kind = None if edges is None else as_choice(edges, ("parallel", "arc"), name="edges")
        unit = None if degrees is None else as_flag(degrees, name="degrees")
        infer = as_flag(infer_bounds, name="infer_bounds")
        place = None if cells is None else as_choice(cells, ("nodes", "faces"), name="cells")
        own = None if name is None else as_text(name, name="name")
        choices = Choices(own, coords, kind, unit, infer, place, near, workers)
        return cls._of_cells(read_cells(ds, choices), near, workers)

    @classmethod
    def _of_cells(cls, cells: Cells, merge: float, workers: int | None) -> Self:
        """Return the grid from the result of a reader."""
        if cells.columns is not None and cells.rows is not None:
            columns = as_bounds(cells.columns, name="lon", degrees=True)
            rows = as_bounds(cells.rows, name="lat", degrees=True)
            return cls._product(columns, rows, cells.merged, workers, cells.mask)
        if cells.boxes is not None:
            arrays, merged = rows_of(cells.boxes, cells.near)
            return cls._of(
                "parallel", arrays, cells.shape, merged, workers, mask=cells.mask,
                centers=cells.centers,
            )  # fmt: skip
        assert cells.nodes is not None
        assert cells.starts is not None
        if cells.location == "node":
            return cls._around_nodes(cells, workers)
        vectors, merged = merged_corners(cells.nodes, 0.0 if cells.shared else merge)
        if cells.corners is not None:
            vectors = vectors[cells.corners]
        arrays = _alone(vectors, cells.starts)
        merged += cells.merged
        centers = cells.centers
        return cls._of(
            "arc", arrays, cells.shape, merged, workers, mask=cells.mask, centers=centers
        )

    @classmethod
    def _around_nodes(cls, cells: Cells, workers: int | None) -> Self:
        """Return the median dual of a mesh, whose own cells must be usable."""
        assert cells.nodes is not None
        assert cells.starts is not None
        assert cells.corners is not None
        count = len(cells.starts) - 1
        faces = cls._of("arc", _alone(cells.nodes[cells.corners], cells.starts), (count,), 0, None)
        arrays = median_dual(cells.nodes, cells.corners, cells.starts, faces.report)
        centers = lonlat_of(cells.nodes) if cells.centers is None else cells.centers
        return cls._of("arc", arrays, cells.shape, 0, workers, mask=cells.mask, centers=centers)

    @classmethod
    def from_lonlat(
        cls, lon: ArrayLike, lat: ArrayLike, *, degrees: bool = True, workers: int | None = None
    ) -> Self:
        """Return the cells between meridians and parallels.

        Parameters
        ----------
        lon, lat : array_like, shape (n + 1,) or (n, 2)
            Bounds of columns and rows: the edges between them, or both bounds of each, as in files
            with CF conventions. In either direction; neighbors must share their bound. Latitudes
            that are beyond a pole by rounding become the pole.
        degrees : bool, optional
            Whether bounds are in degrees (the default) or in radians.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Its shape is (rows, columns).

        Raises
        ------
        InputError
            Bounds are not monotonic, leave gaps, or span more than 360 degrees.
        ShapeError, DtypeError, NonFiniteError
            A bound is not a number, or an array has the wrong shape.

        Examples
        --------
        >>> from delone import sphere
        >>> sphere.Grid.from_lonlat([0, 120, 240, 360], [(90, 0), (0, -90)])
        <Grid of 6 cells (2 x 3), parallels>
        """
        columns = as_bounds(lon, name="lon", degrees=degrees)
        rows = as_bounds(lat, name="lat", degrees=degrees)
        return cls._product(columns, rows, 0, workers)

    @classmethod
    def _product(
        cls,
        columns: Floats,
        rows: Floats,
        merged: int,
        workers: int | None,
        mask: Bools | None = None,
    ) -> Self:
        """Return the cells between edges of columns and of rows."""
        arrays = rings_of.rows(rows, [columns] * (len(rows) - 1))
        shape = len(rows) - 1, len(columns) - 1
        bounds = columns, rows
        return cls._of("parallel", arrays, shape, merged, workers, bounds=bounds, mask=mask)

    @classmethod
    def from_gaussian(
        cls, n: int, points: str | Sequence[int] | None = None, *, workers: int | None = None
    ) -> Self:
        """Return the cells of a Gaussian grid.

        Parameters
        ----------
        n : int
            Number of parallels between a pole and the equator: 80 for N80.
        points : "octahedral" or sequence of int, optional
            For a reduced grid, the number of cells in each row from north to south; "octahedral"
            has 20 in the row at a pole and 4 more in each row toward the equator. By default 4 n in
            all rows.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Rows from north to south, each from longitude 0 eastward.

        Raises
        ------
        InputError
            `n` is below 1 or above 8192, or `points` does not have a positive number for each of
            the 2 n rows.

        Notes
        -----
        Rows are centered at the roots of the Legendre polynomial of degree 2 n. Their bounds make
        their areas proportional to the weights of Gaussian quadrature. Columns are centered at
        multiples of 360 degrees over their number.

        Examples
        --------
        >>> from delone import sphere
        >>> sphere.Grid.from_gaussian(80)
        <Grid of 51200 cells (160 x 320), parallels>
        >>> sphere.Grid.from_gaussian(80, "octahedral")
        <Grid of 28480 cells, parallels>
        """
        rows, columns = gaussian_bounds(n, points)
        if points is None:
            return cls._product(columns[0], rows, 0, workers)
        arrays = rings_of.rows(rows, columns)
        return cls._of("parallel", arrays, (arrays[-1],), 0, workers)

    @classmethod
    def from_curvilinear(
        cls,
        lon: ArrayLike,
        lat: ArrayLike,
        *,
        merge: float = 1e-12,
        degrees: bool = True,
        workers: int | None = None,
    ) -> Self:
        """Return quadrilaterals by two-dimensional arrays of their corners.

        Parameters
        ----------
        lon, lat : array_like, shape (rows + 1, columns + 1) or (rows, columns, k)
            Longitudes and latitudes of corners: those between the cells, or the k corners of each,
            in order around it, as bounds in files with CF conventions.
        merge : float, optional
            Corners closer than this, in radians, are merged, because files repeat corners with
            different last bits; 0 merges none.
        degrees : bool, optional
            Whether corners are in degrees (the default) or in radians.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Its shape is (rows, columns); sides are arcs of great circles.

        Raises
        ------
        DirectionError
            A cell has a side with opposite ends, has sides that cross or are repeated, or is not
            within a hemisphere; ``error.rows`` has the first such cells.
        ShapeError, DtypeError, NonFiniteError
            Arrays have other shapes, or a corner is not a number.

        Examples
        --------
        >>> import numpy as np
        >>> from delone import sphere
        >>> lon, lat = np.meshgrid([0, 10, 20], [0, 5, 10, 15])
        >>> sphere.Grid.from_curvilinear(lon + lat, lat)
        <Grid of 6 cells (3 x 2), arcs of great circles>
        """
        places, corners, shape = as_corners(lon, lat, degrees=degrees, workers=workers)
        places, merged = merged_corners(places, _as_merge(merge))
        starts = np.arange(len(corners) + 1, dtype=np.int64) * corners.shape[1]
        return cls._of("arc", _alone(places[corners.ravel()], starts), shape, merged, workers)

    @classmethod
    def from_mesh(
        cls,
        xyz: ArrayLike | None = None,
        starts: ArrayLike | None = None,
        *,
        lonlat: ArrayLike | None = None,
        winding: str | None = None,
        merge: float = 1e-12,
        degrees: bool = True,
        workers: int | None = None,
    ) -> Self:
        """Return polygons by their corners.

        Parameters
        ----------
        xyz : array_like, shape (k, 3) or (n, c, 3), optional
            Corners as vectors of any length, cell by cell and in order around each.
        starts : array_like, shape (n + 1,), optional
            Where the corners of each cell start, and their number. Not needed if each cell has c
            corners.
        lonlat : array_like, shape (k, 2) or (n, c, 2), optional
            Longitudes and latitudes instead of `xyz`.
        winding : {"smaller", "ccw", "cw"}, optional
            Which side of its corners a cell is on: the smaller side; the left, which is inside
            counterclockwise corners; or the right. By default, it is the smaller side, with a
            warning where that is doubtful, and corners that are not within a hemisphere raise an
            error. Cells beyond a hemisphere are divided into triangles.
        merge, degrees, workers
            As for `from_curvilinear`.

        Returns
        -------
        Grid
            Sides are arcs of great circles.

        Raises
        ------
        DirectionError
            As for `from_curvilinear`, or a vector is zero.
        InputError
            `winding` is unknown, or makes more than 1,000 cells larger than a hemisphere.
        ShapeError, DtypeError, NonFiniteError
            Arrays have other shapes, or a corner is not a number.

        Warns
        -----
        PolygonWarning
            With `winding`, several cells are larger than a hemisphere, so they overlap. Without it,
            a cell above 0.5 steradians, 20 million square kilometers on the Earth, is clockwise,
            and it is the only cell, or others are not clockwise: the rest of the sphere may be
            meant.

        Examples
        --------
        The cells of triangles, from rows of an array of positions:

        >>> import numpy as np
        >>> from delone import sphere
        >>> places = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0)])
        >>> grid = sphere.Grid.from_mesh(places[[(0, 1, 2), (1, 3, 2)]])
        >>> (grid.areas / np.pi).tolist()
        [0.5, 0.5]

        Everything outside a cap around the north pole, clockwise around it:

        >>> ring = [(0, 60), (270, 60), (180, 60), (90, 60)]
        >>> grid = sphere.Grid.from_mesh(lonlat=[ring], winding="ccw")
        >>> grid, round(float(grid.areas[0] / (4 * np.pi)), 3)
        (<Grid of 1 cell, arcs of great circles>, 0.954)
        """
        vectors, where = as_starts(xyz, lonlat, starts, degrees=degrees, workers=workers)
        shape = (len(where) - 1,)
        return cls._polygons(vectors, where, shape, merge, workers, winding=winding)

    @classmethod
    def from_polygons(
        cls,
        geometries: Any,
        *,
        winding: str | None = None,
        merge: float = 1e-12,
        degrees: bool = True,
        workers: int | None = None,
    ) -> Self:
        """Return the cells of polygons in longitudes and latitudes (extra ``geo``).

        Parameters
        ----------
        geometries : geometry, iterable of geometries, GeoSeries or GeoDataFrame
            Shapely polygons, multipolygons and collections of these, or rings of longitudes and
            latitudes of shape (k, 2), one cell each; None and empty geometries are empty cells.
            Geographic reference systems only.
        winding : {"smaller", "ccw", "cw"}, optional
            As for `from_mesh`, but for outer rings: "ccw" for GeoJSON, "cw" for shapefiles. The
            majority of their sides decides.
        merge, degrees, workers
            As for `from_curvilinear`.

        Returns
        -------
        Grid
            Sides are arcs of great circles. Shapely determines which rings are holes, whatever
            their direction.

        Raises
        ------
        InputError
            A geometry is not a polygon, or its reference system is projected; `winding` is unknown,
            or the outer rings of a geometry run in both directions.
        ShapeError
            A ring has fewer than 3 corners, or corners that are not two numbers.
        DirectionError
            As for `from_curvilinear`; or a hole is not inside its outer ring, or holes or parts of
            a geometry overlap. A part inside a hole of another part is valid.
        MissingExtraError
            shapely is not installed.

        Warns
        -----
        PolygonWarning
            As for `from_mesh`.

        Notes
        -----
        Polygons that are cut at 180 degrees fit together there. A polygon that is completed along
        the edge of the map, with corners at latitude 90, is treated as a polygon around the pole,
        if its other corners are less than 180 degrees of longitude apart. A box of 360 degrees has
        no corners between its ends, which are the same point; its area is 0, and
        ``report.empty`` lists it: insert corners along the parallel.
        Parts of a geometry may have common corners and sides. Their sides cross if the corners are
        rounded differently and `merge` is 0.

        Examples
        --------
        >>> from shapely import box
        >>> from delone import sphere
        >>> sphere.Grid.from_polygons([box(0, 0, 10, 10), box(170, -5, 190, 5)])
        <Grid of 2 cells, arcs of great circles>
        """
        given = rings_of.geometries(geometries, degrees=degrees, workers=workers)
        vectors, merged = merged_corners(given.vectors, _as_merge(merge))
        arrays = (vectors, given.rings, given.cells, given.holes)
        return cls._wound(arrays, (len(given.cells) - 1,), merged, winding, workers)

    @classmethod
    def from_voronoi(cls, diagram: Voronoi, *, workers: int | None = None) -> Self:
        """Return the cells of a Voronoi diagram, one for each of its sites.

        Parameters
        ----------
        diagram : delone.sphere.Voronoi
            The diagram, without a clip. Sites with the same direction have the same cell.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Sides are arcs of great circles between the rounded vertices. Centers are the sites.

        Raises
        ------
        InputError
            The diagram is clipped: make the grid from `Voronoi.to_geopandas`.
        DirectionError
            A cell is larger than a hemisphere, as happens with few sites.

        Examples
        --------
        >>> import numpy as np
        >>> from delone import sphere
        >>> sites = [(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)]
        >>> grid = sphere.Grid.from_voronoi(sphere.Voronoi(lonlat=sites))
        >>> (grid.areas / np.pi).round(9)
        array([0.66666667, 0.66666667, 0.66666667, 0.66666667, 0.66666667,
               0.66666667])
        """
        vectors, starts = rings_of.voronoi(diagram)
        arrays = _alone(vectors, starts)
        sites = lonlat_of(diagram.vectors)
        return cls._of("arc", arrays, (len(starts) - 1,), 0, workers, centers=sites)

    @classmethod
    def from_healpix(cls, nside: int, order: str = "ring", *, workers: int | None = None) -> Self:
        """Return HEALPix pixels.

        Parameters
        ----------
        nside : int
            Pixels along a side of a base pixel; there are 12 nside^2 pixels. A power of two for
            "nested".
        order : {"ring", "nested"}, optional
            How pixels are numbered.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Quadrilaterals. The true sides of pixels are not arcs of great circles. Here, arcs
            replace them, so the areas of pixels differ slightly.

        Raises
        ------
        InputError
            `nside` is below 1, above 2^13, or not a power of two for "nested".

        Notes
        -----
        Corners follow from integers, so that pixels share them exactly (K. M. Górski et al.,
        "HEALPix", The Astrophysical Journal 622, 2005).

        Examples
        --------
        >>> from delone import sphere
        >>> sphere.Grid.from_healpix(64, "nested")
        <Grid of 49152 cells, arcs of great circles>
        """
        kind = as_choice(order, ("ring", "nested"), name="order")
        vectors = healpix_corners(nside, nested=kind == "nested", workers=as_workers(workers))
        starts = np.arange(len(vectors) + 1, dtype=np.int64) * 4
        return cls._polygons(vectors.reshape(-1, 3), starts, (len(vectors),), 0.0, workers)

    @classmethod
    def from_fesom(
        cls, folder: str | os.PathLike[str], cells: str = "nodes", *, workers: int | None = None
    ) -> Self:
        r"""Return the cells of a FESOM mesh from its text files.

        Parameters
        ----------
        folder : str or path-like
            Contains ``nod2d.out`` and ``elem2d.out``, with longitudes and latitudes in degrees.
        cells : {"nodes", "faces"}, optional
            What fields belong to: nodes or triangles. Around nodes, a cell has its corners in the
            middle of triangles and edges: the median dual.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Grid
            Sides are arcs of great circles. Nodes without triangles are empty cells.

        Raises
        ------
        FileFormatError
            A file is not a table with the declared number of rows.
        InputError
            `cells` is unknown, or triangles overlap.
        DirectionError
            As for `from_curvilinear`.

        Notes
        -----
        FESOM computes with angles in a plane around each triangle, so FESOM's own areas differ by
        an amount proportional to the square of the triangle size. Coordinates of a rotated mesh are
        used unchanged.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from delone import sphere
        >>> nodes = "4\n1 0 0 1\n2 2 0 1\n3 2 2 1\n4 0 2 1\n"
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     _ = (Path(folder) / "nod2d.out").write_text(nodes)
        ...     _ = (Path(folder) / "elem2d.out").write_text("2\n1 2 3\n1 3 4\n")
        ...     print(sphere.Grid.from_fesom(folder))
        <Grid of 4 cells, arcs of great circles>
        """
        kind = as_choice(cells, ("nodes", "faces"), name="cells")
        lonlat, triangles = read_text(folder)
        made = cls.from_mesh(lonlat=lonlat[triangles], merge=0.0, workers=workers)
        if kind == "faces":
            return made
        vectors = directions_of(lonlat, None, degrees=True, workers=workers, any_turns=True)
        starts = np.arange(len(triangles) + 1, dtype=np.int64) * 3
        arrays = median_dual(vectors, triangles.ravel(), starts, made.report)
        return cls._of("arc", arrays, (len(lonlat),), 0, workers, centers=lonlat)

    @classmethod
    def _polygons(
        cls,
        vectors: Floats,
        starts: Rows,
        shape: tuple[int, ...],
        merge: float,
        workers: int | None,
        *,
        winding: str | None = None,
    ) -> Self:
        """Return the grid of cells of one ring each."""
        vectors, merged = merged_corners(vectors, _as_merge(merge))
        return cls._wound(_alone(vectors, starts), shape, merged, winding, workers)

    @classmethod
    def _wound(
        cls,
        arrays: tuple[Any, ...],
        shape: tuple[int, ...],
        merged: int,
        winding: str | None,
        workers: int | None,
    ) -> Self:
        """Return the grid of polygons on the side of their corners that `winding` selects."""
        given, divided = arrays, np.zeros(0, dtype=np.int64)
        if winding is not None:
            arrays, divided = wound(arrays, winding, workers)
        made = cls._of("arc", arrays, shape, merged, workers)
        require_nested(given, divided, workers)
        if winding is None:
            tell_clockwise(made._checked.turned, made.areas)
        return made


def _alone(vectors: Floats, starts: Rows) -> tuple[Any, ...]:
    """Return the arrays for the core, for cells of one ring each."""
    count = len(starts) - 1
    cells = np.arange(count + 1, dtype=np.int64)
    return vectors, starts, cells, np.zeros(count, dtype=np.bool_)


def _as_merge(merge: float) -> float:
    """Return the distance within which corners become one."""
    value = as_number(merge, name="merge")
    if not 0 <= value < 0.1:
        raise InputError(f"merge must be from 0 to 0.1 radians, got {value!r:.60}")
    return value
