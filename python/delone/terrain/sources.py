"""Surfaces from sources other than points and lines: rasters, files, and the faces in files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from delone._base.arrays import as_flag
from delone._base.files import no_curves
from delone._tiling.triangulation import HullTiling
from delone.errors import InputError
from delone.terrain import building, simplifying, slopes
from delone.terrain import faces as faces_

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats, Rows

__all__ = ["Sources"]


class Sources(HullTiling):
    """The ways to make a surface from rasters and files."""

    __slots__ = ()

    @classmethod
    def _built(cls, made: building.Built, workers: int | None) -> Self:
        """Return a surface of these arrays."""
        raise NotImplementedError

    @classmethod
    def _of_points(cls, xyz: Any, crs: Any, options: dict[str, Any]) -> Self:
        made: Any = cls
        return made.from_points(xyz, crs=crs, **options)  # type: ignore[no-any-return]

    @classmethod
    def from_raster(
        cls,
        dem: Any,
        *,
        max_error: float | None = None,
        max_triangles: int | None = None,
        band: int | str | None = None,
        step: int = 1,
        bounds: Sequence[float] | None = None,
        nodata: float | None = None,
        crs: Any = None,
        **options: Any,
    ) -> Self:
        """Triangulate the cells of a raster of heights: all, or as few as an error bound allows.

        Parameters
        ----------
        dem : delone.interpolate.Grid, xarray.DataArray, str or path-like
            Heights at the centers of cells, or a file: GeoTIFF, ESRI ASCII grid or NetCDF. Cells
            without a value (NaN, or nodata in files) are left out. The two dimensions of a
            DataArray are recognized as x and y by the CF conventions, in either order, and its
            reference system is that of its grid mapping.
        max_error, max_triangles : optional
            As for `simplify`; the points that are left out are never triangulated, unless there are
            lines.
        band, step : optional
            For files: as for `delone.io.read_raster`.
        bounds : sequence of four float, optional
            Left, bottom, right and top: only cells whose centers are inside or on the border.
        nodata : float, optional
            The value of cells without a height, in addition to NaN and the one that a file
            declares; NaN if all values are heights.
        crs : optional
            As for `from_points`.
        **options
            Further options of `from_points`.

        Returns
        -------
        TIN
            The surface.

        Raises
        ------
        InputError
            `dem` is not a raster with one height in each cell; `band` or `step` is given, but `dem`
            is not a file; cells have a constant such as -9999 that is farther from all other
            heights than these are from each other, and `nodata` is not given; otherwise as for
            `from_points` and `simplify`.
        FileFormatError, MissingExtraError, OSError
            As for `delone.io.read_raster`.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.interpolate import Grid
        >>> from delone.terrain import TIN
        >>> x, y = np.arange(3.0), np.arange(4.0)
        >>> TIN.from_raster(Grid(np.add.outer(y, x), x, y))
        <TIN of 12 points: 12 triangles, heights 0 to 5>
        >>> TIN.from_raster(Grid(np.add.outer(y, x), x, y), max_error=0)
        <TIN of 4 points: 2 triangles, heights 0 to 5>
        """
        nodes: Any
        distinct, rim = True, None
        if isinstance(dem, str | os.PathLike):
            from delone.io import read_raster

            nodes = read_raster(dem, band=band, step=step, bounds=bounds, nodata=nodata)
        else:
            if band is not None or step != 1:
                raise InputError("band and step are for files of rasters: give a path, or a slice")
            nodes, distinct, declared, rim = _nodes_of(dem, bounds, nodata)
            crs = building.system_of(crs, declared)
        if max_error is None and max_triangles is None:
            return cls._of_points(nodes, crs, options)
        goal: dict[str, Any] = {"max_error": max_error, "max_triangles": max_triangles}
        if not distinct or options.keys() - {"units", "planar", "workers"}:
            surface: Any = cls._of_points(nodes, crs, options)
            return surface.simplify(**goal)  # type: ignore[no-any-return]
        bare = building.bare(
            nodes, crs=crs, units=options.get("units"), planar=options.get("planar", False)
        )
        ground = simplifying.ground_of_points(*bare, options.get("workers"), rim)
        found = simplifying.simplified(ground, cls._built, **goal)
        return found.surface(**goal)  # type: ignore[no-any-return]

    @classmethod
    def from_file(
        cls,
        path: Any,
        *,
        columns: Sequence[str | int] | None = None,
        layer: str | None = None,
        order: str | None = None,
        chord: float | None = None,
        bounds: Sequence[float] | None = None,
        **options: Any,
    ) -> Self:
        r"""Create a surface from a file: LandXML, DXF, or points in LAS, LAZ, EPT, CSV and others.

        Parameters
        ----------
        path : str or path-like
            The file, in any format that `delone.io.read_surface` or `delone.io.read_points` reads.
        columns : sequence of str or int, optional
            The columns of x, y and z; by default they are recognized by their names.
        layer, order : str, optional
            As for these functions: the name of a surface or layer, and ``"enz"`` for eastings
            first.
        chord : float, optional
            For curves in DXF, as for `delone.io.read_surface`.
        bounds : sequence of four float, optional
            The part of LAS, LAZ or EPT to read, as for `delone.io.read_points`.
        **options
            Options of `from_surface` for LandXML and DXF, else of `from_points`.

        Returns
        -------
        TIN
            The surface.

        Raises
        ------
        FileFormatError, MissingExtraError, OSError
            As for these functions; otherwise as for `from_surface` and `from_points`.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> from delone.terrain import TIN
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = Path(folder) / "survey.csv"
        ...     _ = path.write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
        ...     TIN.from_file(path)
        <TIN of 3 points: 1 triangle, heights 1 to 3>
        """
        from delone import io
        from delone.io.registry import holds_surface

        if holds_surface(path):
            if columns is not None:
                raise InputError(f"{path}: surfaces have x, y and z, and no columns")
            if bounds is not None:
                raise InputError(f"{path}: bounds are for LAS, LAZ and EPT")
            found = io.read_surface(path, layer=layer, order=order, chord=chord)
            return cls.from_surface(found, **options)
        if chord is not None:
            raise no_curves(path)
        if order is not None:
            raise InputError(f"{path}: order is for LandXML files; name the columns")
        survey = io.read_points(path, columns=columns, layer=layer, bounds=bounds)
        return cls._of_points(survey, options.pop("crs", None), options)

    @classmethod
    def from_surface(cls, surface: Any, *, faces: bool = True, **options: Any) -> Self:
        """Create a TIN from the surface in a file, with the triangles of the file.

        Parameters
        ----------
        surface : delone.io.SurfaceFile
            The result of `delone.io.read_surface`.
        faces : bool, optional
            Keep the faces, if there are any, as triangles. Otherwise, points and lines are
            triangulated.
        **options
            Options of `from_points`; those for lines and edges only if no faces are kept.

        Returns
        -------
        TIN
            The surface, with the units and the reference system of the file.

        Raises
        ------
        InputError
            Faces overlap; the message says where. Otherwise as for `from_points`.
        ConflictingValuesError
            Points with the same x and y have different heights: a vertical wall.

        Notes
        -----
        Vertices are the points of visible faces. Edges on breaklines become breaklines, and edges
        that a Delaunay triangulation would not contain become soft breaklines. Faces that have no
        area as seen from above are left out.

        Examples
        --------
        See `delone.io.read_surface`.
        """
        surface.warn_left_out()
        if as_flag(faces, name="faces") and len(surface.faces):
            return cls._built(faces_.build_faces(surface, options), options.get("workers"))
        options = faces_.with_lines(surface, options)
        system = options["crs"] = building.system_of(options.get("crs"), surface)
        options["units"] = building.settled_units(
            building.stated_units(options.get("units"), surface.units, surface.source),
            system,
            surface.lengths,
            surface.source,
        )
        return cls._of_points(surface.points, options.pop("crs", None), options)


class _Nodes(NamedTuple):
    """The nodes of a raster that have a height."""

    xyz: Floats
    distinct: bool
    crs: str | None
    # Among these are all corners of the hull; None if it is not known.
    rim: Rows | None


def _nodes_of(dem: Any, bounds: Any, nodata: Any) -> _Nodes:
    """Return the nodes of a raster that have a height."""
    from delone.io.dem import as_bounds
    from delone.io.netcdf import heights_of_array, is_array
    from delone.io.nodata import as_nodata, is_nodata, require_declared

    box, empty, crs = as_bounds(bounds), as_nodata(nodata), None
    if is_array(dem):
        values, x, y, crs = heights_of_array(dem, box, empty)
    else:
        values, x, y = slopes.cells_of(dem)
    values = np.asarray(values, dtype=np.float64)
    kept = ~(np.isnan(values) | is_nodata(values, empty))
    if box is not None:
        left, bottom, right, top = box
        inside = np.logical_and.outer((y >= bottom) & (y <= top), (x >= left) & (x <= right))
        if not inside.any():
            raise InputError(f"no node of the raster is inside bounds={box}")
        kept &= inside
    grid = np.empty((*values.shape, 3))
    grid[..., 0], grid[..., 1], grid[..., 2] = x, y[:, None], values
    found = grid.reshape(-1, 3) if kept.all() else grid[kept]
    if not is_array(dem):
        require_declared(found[:, 2], empty, "the raster", file=False)
    distinct = len(np.unique(x)) == len(x) and len(np.unique(y)) == len(y)
    steps = np.diff(x)
    if not ((steps > 0).all() or (steps < 0).all()):
        return _Nodes(found, distinct, crs, None)
    # The first and last node of each row of the raster.
    counts = kept.sum(axis=1)
    counts = counts[counts > 0]
    ends = np.cumsum(counts)
    return _Nodes(found, distinct, crs, np.unique(np.concatenate((ends - counts, ends - 1))))
