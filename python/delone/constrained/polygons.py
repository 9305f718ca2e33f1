"""Polygons and other geometries: constrained triangulations of them, and the triangles inside.

`from_geometry` makes points and segments of whatever has coordinates and hands them to
`ConstrainedDelaunay`. `triangulate_polygon` goes to the core directly, because programs that draw
call it once for each of very many small rings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._arrays import as_choice, as_flag, as_points, require_finite
from delone.constrained import geodata
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.segmented import Origin
from delone.counting import agreed
from delone.duplicates import first_rows
from delone.errors import InputError, NonFiniteError
from delone.exchange.parts import Parts
from delone.georeference import as_crs, common_crs, is_geographic, warn_of_degrees

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]
    Rows = NDArray[np.int64]

__all__ = ["PolygonTriangles", "from_geometry", "triangulate_polygon"]

_RULES = ("even-odd", "nonzero")


def from_geometry(
    geometries: Any,
    *,
    holes: ArrayLike | None = None,
    regions: ArrayLike | None = None,
    boundary: str = "hull",
    crossing: str = "split",
    conforming: bool = False,
    max_points: int | None = None,
    method: str = "auto",
    workers: int | None = None,
    crs: Any = None,
    planar: bool = False,
) -> ConstrainedDelaunay:
    """Triangulate polygons, lines and points at once.

    Parameters
    ----------
    geometries : geometry or iterable of geometries
        Geometries of shapely, tables and series of geopandas, a `delone.io.GeometrySet`, objects
        with ``__geo_interface__``, mappings of that form (GeoJSON), and iterables of these, in any
        mixture. Rows of tables and features of collections are geometries each.
    holes, regions, conforming, max_points, method, workers : optional
        As for `ConstrainedDelaunay`.
    boundary : {"hull", "outline", "polygons"}, optional
        What is triangulated: as for `ConstrainedDelaunay`; or only what is inside of polygons,
        without their holes.
    crossing : {"split", "raise"}, optional
        As for `ConstrainedDelaunay`, but by default crossings are split: the boundaries of real
        data do cross.
    crs : str, int or pyproj.CRS, optional
        The reference system of the coordinates, by default that of the geometries where they have
        one. It is kept in ``mesh.crs`` and written by ``mesh.to_geopandas()``. Nothing is
        transformed.
    planar : bool, optional
        Whether longitudes and latitudes are meant as coordinates of a plane; otherwise geometries
        in a geographic reference system are warned of.

    Returns
    -------
    ConstrainedDelaunay
        The triangulation. Its points are the distinct coordinates in the order in which they come.
        Its segments are the lines and the sides of all rings, holes included, in this order; its
        ``geometry_of_segment`` has the geometry of each, and its ``part_of_segment`` the ring or
        line.

    Raises
    ------
    InputError
        Something is no geometry, or parts are in different reference systems.
    NonFiniteError
        A coordinate is NaN or infinite; the rows of the error are geometries.
    DegenerateInputError, CrossingSegmentsError, BudgetExceededError
        As for `ConstrainedDelaunay`.

    Warns
    -----
    GeographicWarning
        The geometries are in degrees; see `planar`.

    Notes
    -----
    Rings are closed where they are not. Missing and empty geometries are passed over, third
    coordinates left out. Points with equal coordinates are one, so that neighbours share vertices.
    Polygons need not be valid: inside is what the rings of a geometry wind around an odd number of
    times, and ``mesh.polygon`` has for each triangle the first geometry that has it inside. With
    ``boundary="outline"`` holes of polygons stay, with ``"polygons"`` they do not.

    Examples
    --------
    >>> import delone
    >>> ring = [(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]
    >>> square = {"type": "Polygon", "coordinates": [ring]}
    >>> line = {"type": "LineString", "coordinates": [(-1, 2), (5, 2)]}
    >>> mesh = delone.from_geometry([square, line])
    >>> mesh
    <ConstrainedDelaunay of 8 points (2 added) and 5 segments: 8 triangles>
    >>> mesh.geometry_of_segment.tolist()
    [0, 0, 0, 0, 1]
    >>> delone.from_geometry([square, line], boundary="polygons").polygon.tolist()
    [0, 0, 0, 0]
    """
    parts = geodata.parts_of(geometries)
    _require_finite(parts)
    system = common_crs(geometries) if crs is None else as_crs(crs)
    by = system if system is not None and is_geographic(system) else None
    warn_of_degrees(None, parts.coordinates, planar=planar, name="geometries", by=by)
    points, vertex = _merged(parts.coordinates)
    ends, part = _steps(parts)
    # Points have no segments, so they are not counted among the parts.
    number = np.cumsum(parts.kinds != geodata.POINTS) - 1
    origin = Origin(
        parts.geometries[part].astype(np.int32),
        parts.kinds[part] >= geodata.EXTERIOR,
        number[part].astype(np.int32),
    )
    return ConstrainedDelaunay._of_geometries(
        points,
        vertex[ends],
        origin,
        holes=holes,
        regions=regions,
        boundary=boundary,
        crossing=crossing,
        conforming=as_flag(conforming, name="conforming"),
        max_points=max_points,
        method=method,
        workers=workers,
        crs=system,
    )


def _require_finite(parts: geodata.Parts) -> None:
    wrong = ~np.isfinite(parts.coordinates).all(axis=1)
    if wrong.any():
        part = np.searchsorted(parts.starts, np.flatnonzero(wrong), side="right") - 1
        bad = np.unique(parts.geometries[part])
        first = ", ".join(map(str, bad[:10].tolist()))
        raise NonFiniteError(
            f"{len(bad)} {agreed(len(bad), 'geometry holds', 'geometries hold')} NaN or infinity; "
            f"first: {first}",
            rows=bad[:10],
            count=len(bad),
        )


def _merged(coordinates: Floats) -> tuple[Floats, Indices]:
    """Return the distinct points in the order of their first rows, and which each row is."""
    first = first_rows(coordinates)
    distinct = first == np.arange(len(first))
    number = np.cumsum(distinct) - 1
    return coordinates[distinct], number[first].astype(np.int32)


def _steps(parts: geodata.Parts) -> tuple[Rows, Rows]:
    """Return the segments of lines and rings as rows of coordinates, and the part of each."""
    counts = np.diff(parts.starts)
    part = np.repeat(np.arange(len(counts)), counts)
    tail = np.arange(len(part))
    head = tail + 1
    # The last row of a ring leads to its first, that of a line nowhere.
    head[parts.starts[1:] - 1] = parts.starts[:-1]
    ring = parts.kinds >= geodata.EXTERIOR
    leads = np.repeat(parts.kinds != geodata.POINTS, counts)
    last = parts.starts[1:] - 1
    leads[last[~ring]] = False
    # A ring of one point has no side.
    leads[last[ring & (counts == 1)]] = False
    return np.column_stack((tail, head))[leads], part[leads]


class PolygonTriangles(NamedTuple):
    """The triangles inside of a polygon.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The points of the rings one after the other, then those where sides cross.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise.

    Examples
    --------
    >>> import delone
    >>> points, simplices = delone.triangulate_polygon([(0, 0), (4, 0), (4, 3), (0, 3)])
    >>> simplices.shape
    (2, 3)
    """

    points: Floats
    simplices: Indices

    def __reduce__(self) -> tuple[Any, ...]:
        # NumPy does not pickle whether an array may be written to.
        return _read_only, (self.points, self.simplices)

    def to_geopandas(self, *, crs: Any = None) -> Any:
        """Return the triangles as a table of polygons (extra ``geo``).

        Parameters
        ----------
        crs : optional
            Reference system of the coordinates, anything that geopandas takes.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each triangle: its vertices ``v0``, ``v1`` and ``v2`` and its polygon.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.

        Examples
        --------
        >>> import delone
        >>> frame = delone.triangulate_polygon([(0, 0), (4, 0), (4, 3)]).to_geopandas()
        >>> frame.area.tolist()
        [6.0]
        """
        from delone.exchange.geopandas import to_geopandas

        return to_geopandas(Parts(self.points, self.simplices), crs)


def triangulate_polygon(polygon: Any, *, rule: str = "even-odd") -> PolygonTriangles:
    """Triangulate the inside of a polygon.

    Parameters
    ----------
    polygon : array_like of shape (n, 2), sequence of those, or geometry
        A ring, or the rings of a polygon in any order, closed whether they repeat their first point
        or not; a Polygon or MultiPolygon of shapely, an object with ``__geo_interface__``, or a
        mapping of that form.
    rule : {"even-odd", "nonzero"}, optional
        What is inside where rings cross or lie in each other: points around which the rings wind an
        odd number of times in sum, or points around which they wind at all.

    Returns
    -------
    PolygonTriangles
        Points and triangles. There are none for a polygon without inside.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError, InputError
        `polygon` has no rings, or no points in the plane.

    Notes
    -----
    The polygon need not be valid: rings may cross themselves and each other, overlap and touch, run
    back and forth. Where sides cross, a point is added, as in `ConstrainedDelaunay`. Triangles are
    those of the constrained Delaunay triangulation, exact and canonical.

    Rings of geometries are turned before they are counted, outer ones counter-clockwise and holes
    clockwise, because geometries do not say which way they run; arrays are taken as they are.

    Examples
    --------
    >>> import delone
    >>> star = [(0, 3), (2, -3), (-3, 1), (3, 1), (-2, -3)]
    >>> len(delone.triangulate_polygon(star).simplices)
    5
    >>> len(delone.triangulate_polygon(star, rule="nonzero").simplices)
    8
    """
    nonzero = as_choice(rule, _RULES, name="rule") == "nonzero"
    if type(polygon) is np.ndarray:
        ring = _core.ring2(polygon)
        if ring is not None:
            return PolygonTriangles._make(ring)
    points, starts = _rings(polygon, nonzero)
    added, simplices = _core.polygon2(points, starts, nonzero)
    if len(added):
        points = np.concatenate((points, added))
    return _read_only(points, simplices)


def _read_only(points: Floats, simplices: Indices) -> PolygonTriangles:
    points.flags.writeable = False
    simplices.flags.writeable = False
    return PolygonTriangles(points, simplices)


def _rings(polygon: Any, nonzero: bool) -> tuple[Floats, Indices]:
    """Return the points of all rings, and where each ring begins."""
    # Asked of the instance, `__geo_interface__` would take a whole geometry of shapely apart.
    if (
        isinstance(polygon, dict)
        or geodata.is_shapely(polygon)
        or hasattr(polygon, "__geo_interface__")
    ):
        return _rings_of_geometry(polygon, nonzero)
    rings = [as_points(ring, ndim=2, name="polygon") for ring in _listed(polygon)]
    counts = [len(ring) for ring in rings]
    starts = np.concatenate(([0], np.cumsum(counts))).astype(np.int32)
    return np.concatenate([np.empty((0, 2)), *rings]), starts


def _listed(polygon: Any) -> list[Any]:
    """Tell a ring from a sequence of rings by how deep its numbers are."""
    if isinstance(polygon, np.ndarray) and polygon.dtype != object:
        return [polygon] if polygon.ndim == 2 else list(polygon)
    if not hasattr(polygon, "__iter__") or isinstance(polygon, str | bytes):
        raise InputError(f"polygon is {polygon!r:.80}, neither rings nor a geometry")
    items = list(polygon)
    if not items:
        return []
    flat = hasattr(items[0], "__len__") and len(items[0]) and not hasattr(items[0][0], "__len__")
    return [items] if flat else [ring for ring in items if len(ring)]


def _rings_of_geometry(polygon: Any, nonzero: bool) -> tuple[Floats, Indices]:
    parts = geodata.parts_of(polygon, name="polygon")
    if (parts.kinds < geodata.EXTERIOR).any():
        raise InputError("polygon holds lines or points, which have no inside")
    points = parts.coordinates
    require_finite(points, name="polygon")
    if nonzero:
        for kind, start, end in zip(parts.kinds, parts.starts[:-1], parts.starts[1:], strict=True):
            ring = points[start:end]
            if _turns_left(ring) != (kind == geodata.EXTERIOR):
                points[start:end] = ring[::-1].copy()
    return points, parts.starts.astype(np.int32)


def _turns_left(ring: Floats) -> bool:
    """Tell which way a ring runs by its signed area; where that is nearly 0, any answer will do."""
    # Halves, and then shares of the longest side, so that nothing exceeds the range of doubles.
    edges = ring / 2 - ring[0] / 2
    x, y = (edges / (np.abs(edges).max() or 1.0)).T
    return bool(np.dot(x, np.roll(y, -1)) > np.dot(y, np.roll(x, -1)))
