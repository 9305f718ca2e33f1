"""The contents of a file of geometries: points, lines and areas."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from delone._base.counting import agreed, counted
from delone._base.extras import require
from delone._base.renames import renamed
from delone._base.values import as_values
from delone.errors import FileFormatError
from delone.io.pointset import PointSet
from delone.io.systems import check_system

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["GeometrySet"]

_POINTS = (0, 4)  # shapely's type numbers of Point and MultiPoint
_LINES = (1, 2, 5)  # LineString, LinearRing and MultiLineString
_AREAS = (3, 6)  # Polygon and MultiPolygon
_COLLECTION = 7


class HasSegments(Protocol):
    """A triangulation that stores the segments it was made from."""

    @property
    def points(self) -> Floats:
        """The coordinates, those of added vertices last."""

    @property
    def npoints(self) -> int:
        """Number of points."""

    @property
    def nadded(self) -> int:
        """Number of added vertices."""

    @property
    def segments(self) -> Indices:
        """The subsegments."""

    @property
    def input_segments(self) -> Indices:
        """The segments that were given."""

    @property
    def segment_source(self) -> tuple[NDArray[np.int64], Indices]:
        """The rows that cover subsegments as compressed rows (indptr, indices)."""


@renamed(coordinates="all_points", heights="feature_heights")
@dataclass(frozen=True, eq=False, kw_only=True)
class GeometrySet:
    """The geometries of a file, one for each feature.

    Parameters
    ----------
    geometries : ndarray of shapely geometries, shape (g,)
        None for a feature without a geometry.
    feature_heights : ndarray of float64, shape (g,), optional
        The height of each feature, from a column; None if the heights are those of the coordinates,
        if any.
    crs : str, optional
        Coordinate reference system, such as ``"EPSG:28992"``, or in WKT; None if the file has none.
    source : str, optional
        The file.
    attributes : dict of str to ndarray, optional
        Further columns of the file, with a value for each feature.

    Examples
    --------
    >>> import numpy as np, shapely
    >>> from delone.io import GeometrySet
    >>> square = np.array([shapely.box(0, 0, 1, 1)])
    >>> coast = GeometrySet(geometries=square)
    >>> len(coast), coast.only_points
    (1, False)
    """

    geometries: NDArray[Any]
    feature_heights: Floats | None = None
    crs: str | None = None
    source: str = ""
    attributes: dict[str, NDArray[Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        check_system(self.crs, self.source)

    def __len__(self) -> int:
        return len(self.geometries)

    def __repr__(self) -> str:
        names = [getattr(each, "geom_type", "no geometry") for each in self.geometries.tolist()]
        kinds = ", ".join(f"{count} {name}" for name, count in Counter(names).items())
        return f"<GeometrySet of {counted(len(self), 'feature')}" + (
            f": {kinds}>" if kinds else ">"
        )

    @property
    def only_points(self) -> bool:
        """Whether the geometries contain no lines and no areas."""
        kinds = _shapely().get_type_id(_parts(self.geometries))
        return not bool(np.isin(kinds, _LINES + _AREAS).any())

    @property
    def areas(self) -> NDArray[Any]:
        """The polygons among the geometries, with MultiPolygons split into parts."""
        shapely = _shapely()
        parts = _parts(self.geometries)
        areas = parts[np.isin(shapely.get_type_id(parts), _AREAS)]
        polygons: NDArray[Any] = shapely.get_parts(areas)
        full: NDArray[Any] = polygons[~shapely.is_empty(polygons)]
        return full

    def as_points(self) -> PointSet:
        """Return the points; those of a MultiPoint are consecutive.

        Returns
        -------
        PointSet
            The points, without attributes.

        Raises
        ------
        FileFormatError
            A geometry is missing, empty or not a point.

        Examples
        --------
        >>> import numpy as np, shapely
        >>> from delone.io import GeometrySet
        >>> wells = np.array([shapely.Point(1, 2), shapely.MultiPoint([(3, 4), (5, 6)])])
        >>> GeometrySet(geometries=wells).as_points().points.tolist()
        [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]]
        """
        shapely = _shapely()
        kinds = shapely.get_type_id(self.geometries)
        other = ~np.isin(kinds, _POINTS) | shapely.is_empty(self.geometries)
        if other.any():
            row = int(np.flatnonzero(other)[0])
            kind = getattr(self.geometries[row], "geom_type", None)
            empty = "an empty " if kinds[row] in _POINTS else ""
            what = "has no geometry" if kind is None else f"is {empty}{kind}"
            raise FileFormatError(
                f"{self.source}: feature {row} {what}; points are required. "
                f"{int(other.sum())} of {counted(len(other), 'feature')} "
                f"{agreed(int(other.sum()), 'is', 'are')} not points"
            )
        return self.all_points()

    def all_points(self) -> PointSet:
        """Return all coordinates, those of lines and rings included.

        Returns
        -------
        PointSet
            In the order of the features; a closed ring repeats its first point.

        Examples
        --------
        >>> import numpy as np, shapely
        >>> from delone.io import GeometrySet
        >>> square = GeometrySet(geometries=np.array([shapely.box(0, 0, 1, 1)]))
        >>> len(square.all_points())
        5
        """
        points, z = self._coordinates()
        return PointSet(points=points, z=z, crs=self.crs, source=self.source)

    def z_of(self, mesh: HasSegments) -> Floats | None:
        """Return the heights of the vertices of a triangulation of these geometries.

        Parameters
        ----------
        mesh : ConstrainedDelaunay
            The result of `delone.from_geometry` for the geometries.

        Returns
        -------
        ndarray of float64, shape (n,), or None
            The height of the first coordinate pair at each point; the height of an added vertex is
            interpolated between the ends of the first segment that it lies on. None if there are no
            heights.

        Examples
        --------
        >>> import delone, numpy as np, shapely
        >>> lines = ["LINESTRING Z (0 0 1, 4 4 3)", "LINESTRING Z (0 4 9, 4 0 9)"]
        >>> valley = delone.io.GeometrySet(geometries=shapely.from_wkt(lines))
        >>> valley.z_of(delone.from_geometry(valley.geometries))
        array([1., 3., 9., 9., 2.])
        """
        coordinates, known = self._coordinates()
        if known is None:
            return None
        own = mesh.points[: mesh.npoints - mesh.nadded]
        x, y = np.concatenate((own, coordinates)).T
        # A point sorts before the coordinates equal to it, followed by the first of them.
        order = np.lexsort((y, x))
        at = np.flatnonzero(order < len(own))
        z = np.full(mesh.npoints, np.nan)
        z[order[at]] = known[order[at + 1] - len(own)]
        _interpolate_added(mesh, z)
        return z

    def _coordinates(self) -> tuple[Floats, Floats | None]:
        shapely = _shapely()
        coordinates, feature = shapely.get_coordinates(
            self.geometries, include_z=True, return_index=True
        )
        z: Any = coordinates[:, 2]
        if self.feature_heights is not None:
            z = self.feature_heights[feature]
        elif not shapely.has_z(self.geometries).any():
            z = None
        return np.ascontiguousarray(coordinates[:, :2]), as_values(z, len(coordinates))


def _shapely() -> Any:
    return require("shapely", extra="geo", what="reading geometries")


def _parts(geometries: NDArray[Any]) -> NDArray[Any]:
    """Split collections into parts."""
    shapely = _shapely()
    while (shapely.get_type_id(geometries) == _COLLECTION).any():
        geometries = shapely.get_parts(geometries)
    return geometries


def _interpolate_added(mesh: HasSegments, z: Floats) -> None:
    """Give added vertices heights between those of the ends of a row that they lie on."""
    start, source = mesh.segment_source
    row = np.tile(source[start[:-1]], 2)
    vertex = mesh.segments.T.ravel()
    added = vertex >= mesh.npoints - mesh.nadded
    vertex, first = np.unique(vertex[added], return_index=True)
    a, b = mesh.input_segments[row[added][first]].T
    whole, part = mesh.points[b] - mesh.points[a], mesh.points[vertex] - mesh.points[a]
    share = np.hypot(*part.T) / np.hypot(*whole.T)
    z[vertex] = (1 - share) * z[a] + share * z[b]
