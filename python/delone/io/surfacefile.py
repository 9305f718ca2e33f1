"""The surface in a file: points with heights, faces, lines and units, unchanged."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.counting import counted
from delone._base.extras import require
from delone._base.georeference import parsed
from delone.errors import FileFormatError
from delone.io.geometryset import GeometrySet
from delone.io.pointset import PointSet
from delone.io.systems import check_system

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["LeftOutWarning", "SurfaceFile"]

_SHOWN = 12


class LeftOutWarning(UserWarning):
    """A file contains items that were not read; the message counts them by kind."""


@dataclass(frozen=True, eq=False, kw_only=True)
class SurfaceFile:
    """The surface of a LandXML or DXF file, not triangulated.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 3)
        The points: easting (x), northing (y) and height.
    faces : ndarray of int32, shape (m, 3)
        The visible faces as rows of `points`; empty if the file has none.
    breaklines, soft_breaklines : tuple of ndarray of float64, shape (k, 3), optional
        The lines that must become edges; heights are NaN where the file has none.
    boundary, holes, islands : tuple of ndarray of float64, shape (k, 3), optional
        The rings where the surface ends; islands are parts of it in holes.
    units : str, optional
        The unit of heights, such as ``"m"``, ``"ft"`` or ``"us-ft"``; None if the file does not
        say.
    lengths : str, optional
        The unit of x and y.
    crs : str, optional
        Coordinate reference system, such as ``"EPSG:28992"``, or in WKT; None if the file has none.
    name : str, optional
        The name of the surface.
    source : str, optional
        The file.
    left_out : mapping of str to int, optional
        Counts of what was not read from the file, by kind: ``{"TEXT": 12, "hidden": 3}``.
    curves : int, optional
        The number of curves that were replaced by chords.
    quads : int, optional
        The number of faces with four corners that were split into two triangles, at the diagonal
        between the first and the third corner.

    Examples
    --------
    See `read_surface`.
    """

    points: Floats
    faces: Indices
    breaklines: tuple[Floats, ...] = ()
    soft_breaklines: tuple[Floats, ...] = ()
    boundary: tuple[Floats, ...] = ()
    holes: tuple[Floats, ...] = ()
    islands: tuple[Floats, ...] = ()
    units: str | None = None
    lengths: str | None = None
    crs: str | None = None
    name: str | None = None
    source: str = ""
    left_out: Mapping[str, int] = field(default_factory=lambda: MappingProxyType({}))
    curves: int = 0
    quads: int = 0

    def __post_init__(self) -> None:
        check_system(self.crs, self.source)

    def __repr__(self) -> str:
        lines = len(self.breaklines) + len(self.soft_breaklines)
        units = "unknown units" if self.units is None else f"heights in {self.units}"
        return (
            f"<SurfaceFile of {counted(len(self.points), 'point')}: "
            f"{counted(len(self.faces), 'face')}, {counted(lines, 'breakline')}, {units}"
            + (f", left out: {self._listed()}" if self.left_out else "")
            + ">"
        )

    def _listed(self) -> str:
        shown = [f"{count} {kind}" for kind, count in list(self.left_out.items())[:_SHOWN]]
        return ", ".join(shown) + (", ..." if len(self.left_out) > _SHOWN else "")

    def warn_left_out(self) -> None:
        """Warn about what was not read from the file.

        Warns
        -----
        LeftOutWarning
            Something is left out; the message counts it by kind.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.io import SurfaceFile
        >>> SurfaceFile(points=np.zeros((1, 3)), faces=np.zeros((0, 3), int)).warn_left_out()
        """
        if self.left_out:
            warnings.warn(
                f"{self.source}: left out: {self._listed()}", LeftOutWarning, stacklevel=3
            )

    def as_points(self) -> PointSet:
        """Return the points with their heights, and the vertices of lines that have heights.

        Returns
        -------
        PointSet
            The points, then those of breaklines if there are no faces.

        Raises
        ------
        FileFormatError
            There are none.

        Examples
        --------
        See `read_surface`.
        """
        found = self.points
        if not len(self.faces):
            lines = [
                line[~np.isnan(line[:, 2])] for line in (*self.breaklines, *self.soft_breaklines)
            ]
            found = np.concatenate((found, *lines))
        if not len(found):
            raise FileFormatError(f"{self.source} contains no points with heights")
        x_y, z = np.ascontiguousarray(found[:, :2]), found[:, 2].copy()
        return PointSet(points=x_y, z=z, crs=self.crs, source=self.source)

    def as_geometries(self, *, points: bool = False) -> GeometrySet:
        """Return breaklines as lines, rings as polygons (extra ``geo``).

        Parameters
        ----------
        points : bool, optional
            Whether the points come first, each as a separate geometry.

        Returns
        -------
        GeometrySet
            One geometry for each.

        Raises
        ------
        FileFormatError
            There are none.
        MissingExtraError
            shapely is not installed.

        Examples
        --------
        See `read_surface`.
        """
        shapely = require("shapely", extra="geo", what="geometries")
        lines = [*self.breaklines, *self.soft_breaklines]
        rings = [*self.boundary, *self.holes, *self.islands]
        if not lines and not rings:
            raise FileFormatError(f"{self.source} contains no lines")
        found = [*shapely.points(self.points)] if points and len(self.points) else []
        found += [shapely.linestrings(_known(line)) for line in lines]
        found += [shapely.polygons(_known(ring)) for ring in rings]
        geometries = np.empty(len(found), dtype=object)
        geometries[:] = found
        return GeometrySet(geometries=geometries, crs=self.crs, source=self.source)

    def require_order(self, order: str) -> None:
        """Reject swapped northings and eastings, if the reference system makes this evident.

        That is, if all points are outside the area of use, and would be inside if swapped.
        Without pyproj, nothing is evident. `order` is the order in which they were read.
        """
        bounds = _area(self.crs)
        if bounds is None or not len(self.points):
            return
        x, y = self.points[:, 0], self.points[:, 1]
        if not _inside(x, y, bounds).any() and _inside(y, x, bounds).all():
            other = "'enz'" if order == "nez" else "'nez'"
            raise FileFormatError(
                f"{self.source}: easting and northing are swapped: ({x[0]:.10g}, {y[0]:.10g}) is "
                f"outside the area of {self.crs!s:.60}, ({y[0]:.10g}, {x[0]:.10g}) inside. "
                f"Read it with order={other} (--easting-first for 'enz')"
            )


def _known(line: Floats) -> Any:
    """Return a line, without its heights if one is missing."""
    return line[:, :2] if np.isnan(line[:, 2]).any() else line


def _area(crs: str | None) -> tuple[float, float, float, float] | None:
    """Return the smallest and largest x and y in the area of use of a projected system."""
    system = None if crs is None else parsed(crs)
    if system is None or not system.is_projected or system.area_of_use is None:
        return None
    area = system.area_of_use
    pyproj = require("pyproj", extra="geo", what="reference systems")
    to_plane = pyproj.Transformer.from_crs(system.geodetic_crs, system, always_xy=True)
    bounds = to_plane.transform_bounds(area.west, area.south, area.east, area.north)
    return bounds if np.isfinite(bounds).all() else None


def _inside(x: Floats, y: Floats, bounds: tuple[float, float, float, float]) -> NDArray[np.bool_]:
    west, south, east, north = bounds
    wide, high = (east - west) / 4, (north - south) / 4
    found: NDArray[np.bool_] = (
        (x >= west - wide) & (x <= east + wide) & (y >= south - high) & (y <= north + high)
    )
    return found
