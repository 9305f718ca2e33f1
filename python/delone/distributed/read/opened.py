"""A finished output, of which only the manifest is in memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_queries
from delone._base.georeference import as_crs
from delone._base.renames import renamed
from delone.distributed.read.dem import Shown, write_dem
from delone.distributed.read.proof import prove
from delone.distributed.read.surface import TiledSurface
from delone.distributed.read.tables import dask_frame, write_geoparquet
from delone.distributed.read.tile import Tile

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from delone import _core
    from delone._base.types import Floats, Rows
    from delone.distributed.read.proof import TiledReport

__all__ = ["TiledDelaunay", "open"]


def open(output: str | os.PathLike[str]) -> TiledDelaunay:
    """Open a tiled triangulation.

    Parameters
    ----------
    output : str or path-like
        The folder that `triangulate` wrote.

    Returns
    -------
    TiledDelaunay
        The triangulation, which reads tiles when they are needed.

    Raises
    ------
    FileNotFoundError
        There is no such folder, or the run is not finished.
    FileFormatError
        The manifest is truncated, of another kind, or has a wrong field; tile files are missing.

    Examples
    --------
    >>> import tempfile
    >>> from delone import datasets, distributed
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
    ...     distributed.open(folder + "/tin")
    <TiledDelaunay of 400 points: 722 triangles in 4 tiles>
    """
    return TiledDelaunay._at(output)


@renamed(simplices="read_simplices")
class TiledDelaunay(TiledSurface):
    """A tiled triangulation on disk, returned by `open`.

    Attributes
    ----------
    manifest : dict
        The contents of the manifest.
    npoints, nsimplex, ntiles : int
        Numbers of points (including duplicates), triangles and tiles.
    bounds : tuple of four floats
        Left, bottom, right and top of the points.
    crs : str or None
        Coordinate reference system.

    Notes
    -----
    Triangles are numbered tile by tile: those of tile 0 come first, then those of tile 1, and so
    on. Unless a method says otherwise, only one tile at a time is in memory. Methods that read
    tiles raise `FileFormatError` if files are missing or truncated.

    Examples
    --------
    >>> import tempfile
    >>> from delone import datasets, distributed
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
    ...     tin = distributed.open(folder + "/tin")
    >>> tin.npoints, tin.nsimplex, tin.ntiles, tin.bounds
    (400, 722, 4, (0.0, 0.0, 19.0, 19.0))
    """

    def __repr__(self) -> str:
        return (
            f"<TiledDelaunay of {self.npoints} points: {self.nsimplex} triangles in "
            f"{self.ntiles} tiles>"
        )

    def read_simplices(self) -> Rows:
        """Return all triangles, (m, 3), as rows of the source; they must fit into memory.

        Returns
        -------
        ndarray of int64, shape (m, 3)
            Counter-clockwise, in the order of their numbers.

        Notes
        -----
        Memory is 24 bytes per triangle, plus one tile.

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     tin.read_simplices().shape
        (722, 3)
        """
        found = np.empty((self.nsimplex, 3), dtype=np.int64)
        for tile in self.tiles():
            start, stop = self.starts[tile.number : tile.number + 2]
            found[start:stop] = tile.ids[tile.simplices]
        return found

    def _near(self, queries: Floats) -> Iterator[tuple[int, Rows]]:
        """The tiles whose triangles may contain queries, by number, with those queries."""
        for number, tile in enumerate(self.manifest["tiles"]):
            if tile["extent"] is not None:
                box = np.array(tile["extent"])
                with np.errstate(invalid="ignore"):
                    within = ((queries >= box[:2]) & (queries <= box[2:])).all(axis=1)
                rows = np.flatnonzero(within)
                if len(rows):
                    yield number, rows

    def find_simplex(self, xi: ArrayLike) -> Rows:
        """Find the triangles that contain points, reading only tiles that may contain them.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Points to locate. NaN and infinity are outside.

        Returns
        -------
        ndarray of int64, shape (...)
            The number of a triangle with the point inside or on its boundary, in the first tile
            that has one; -1 outside.

        Raises
        ------
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2).

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     _ = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     tin = distributed.open(folder + "/tin")
        ...     (tin.find_simplex([(3.2, 4.5), (-1, 0)]) >= 0).tolist()
        [True, False]
        """
        queries, shape = _queries(xi, self.crs)
        found = np.full(len(queries), -1, dtype=np.int64)
        for number, rows in self._near(queries):
            left = rows[found[rows] < 0]
            if len(left):
                here = self._locator(self.tile(number)).find(queries[left].copy(), 1)
                found[left[here >= 0]] = self.starts[number] + here[here >= 0]
        return found.reshape(shape)

    def interpolate(self, xi: ArrayLike, values: str = "z") -> Floats:
        """Interpolate linearly, reading only the tiles that may contain the points.

        Parameters
        ----------
        xi : array_like, shape (..., 2)
            Query points.
        values : str, optional
            The name of the attribute; by default heights.

        Returns
        -------
        ndarray of float64, shape (...)
            Values; NaN outside the hull.

        Raises
        ------
        InputError
            There is no such attribute.
        ShapeError, DtypeError
            `xi` is not a real array of shape (..., 2).

        Notes
        -----
        The triangles are those of the whole set, so there are no seams between tiles.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points.sum(axis=1)))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     tin.interpolate([(3.25, 4.5), (-1, 0)])
        array([7.75,  nan])
        """
        self._require(values)
        queries, shape = _queries(xi, self.crs)
        found = np.full(len(queries), np.nan)
        left = np.ones(len(queries), dtype=bool)
        for number, rows in self._near(queries):
            some = rows[left[rows]]
            if len(some):
                tile = self.tile(number)
                here, held = _linear(self._locator(tile), tile, queries[some], values)
                found[some[held]] = here[held]
                left[some[held]] = False
        return found.reshape(shape)

    def validate(self) -> TiledReport:
        """Check exactly, tile by tile, that the union is the Delaunay triangulation of all points.

        Returns
        -------
        TiledReport
            True if everything is correct; otherwise it names the tiles and their faults.

        Notes
        -----
        The check is exact and reads only the files, one tile at a time; it also compares the
        manifest with them.

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     bool(tin.validate())
        True
        """
        return prove(self)

    def to_dask_dataframe(self, table: str = "triangles") -> Any:
        """Return a Dask data frame with one partition for each tile.

        Parameters
        ----------
        table : str, optional
            ``"triangles"``: columns ``a``, ``b``, ``c`` with rows of the source; ``"vertices"``:
            the points, each once, by ``id``.

        Returns
        -------
        dask.dataframe.DataFrame
            A lazy data frame.

        Raises
        ------
        InputError
            There is no such table.
        MissingExtraError
            dask is not installed.

        Examples
        --------
        >>> import tempfile
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     frame = tin.to_dask_dataframe("vertices")
        ...     frame.npartitions, len(frame)
        (4, 400)
        """
        return dask_frame(self, table)

    def to_geoparquet(self, folder: str | os.PathLike[str]) -> None:
        """Write the triangles as polygons, one GeoParquet file for each tile.

        Parameters
        ----------
        folder : str or path-like
            A new folder.

        Raises
        ------
        InputError
            The folder already exists.
        MissingExtraError
            geopandas is not installed.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from delone import datasets, distributed
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(datasets.grid(400), folder + "/tin", tile_points=100)
        ...     tin.to_geoparquet(folder + "/polygons")
        ...     len(list(Path(folder, "polygons").iterdir()))
        4
        """
        write_geoparquet(self, folder)

    def to_raster(
        self,
        resolution: float | tuple[float, float],
        out: str | os.PathLike[str] = "dem.tif",
        values: str = "z",
        *,
        what: str = "value",
        azimuth: float = 315.0,
        altitude: float = 45.0,
        z_factor: float = 1.0,
        crs: Any = None,
    ) -> Path:
        """Interpolate linearly to a GeoTIFF, tile by tile, without seams.

        Parameters
        ----------
        resolution : float or pair of float
            Width and height of a cell, in the units of the points.
        out : str or path-like, optional
            The file; it is created atomically.
        values : str, optional
            The name of the attribute; by default heights.
        what : {"value", "slope", "aspect", "hillshade"}, optional
            What a cell contains: the interpolated value at its center, or a measure of the triangle
            there, as in `delone.terrain.TIN`.
        azimuth, altitude, z_factor : float, optional
            The light of ``"hillshade"``, as for `delone.terrain.TIN.hillshade`.
        crs : str, int or pyproj.CRS, optional
            The reference system of the coordinates, by default that of the source. Nothing is
            transformed.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            There is no such attribute, `resolution` is not above 0, `what` is not one of its
            choices, or the light is invalid.
        MissingExtraError
            rasterio is not installed.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points.sum(axis=1)))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     tin.to_raster(0.5, folder + "/dem.tif").name
        'dem.tif'
        """
        shown = Shown(what, azimuth, altitude, z_factor)
        return write_dem(self, resolution, out, values, as_crs(crs) or self.crs, shown)


def _queries(xi: ArrayLike, crs: str | None) -> tuple[Floats, tuple[int, ...]]:
    queries = as_queries(xi, 2, crs)
    return np.ascontiguousarray(queries.reshape(-1, 2)), queries.shape[:-1]


def _linear(
    locator: _core.Locator2, tile: Tile, queries: Floats, value: str
) -> tuple[Floats, NDArray[np.bool_]]:
    """Values of queries in a tile, and which of them lie in its triangles."""
    values = np.ascontiguousarray(tile.attributes[value], dtype=np.float64)
    some = np.ascontiguousarray(queries)
    found: Floats = locator.linear(values[:, None].copy(), some, 0, 1).reshape(-1)
    held = ~np.isnan(found)
    # Outside, or inside a triangle without a value at some corner.
    held[~held] = locator.find(some[~held], 1) >= 0
    return found, held
