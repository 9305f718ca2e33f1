"""Constrained triangulations of polygons and other geometries, and the triangles inside a polygon.

`from_geometry` converts geometries to points and segments and passes them to `ConstrainedDelaunay`.
`triangulate_polygon` calls the core directly, because drawing programs call it for very many small
rings.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_flag, as_points, require_finite
from delone._base.duplicates import first_rows
from delone._base.georeference import as_known_crs, common_crs, is_geographic, warn_of_degrees
from delone.constrained import geodata
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.segmented import Origin
from delone.errors import InputError
from delone.exchange.parts import Parts

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Floats, Indices

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
    """Triangulate polygons, lines and points together.

    Parameters
    ----------
    geometries : geometry or iterable of geometries
        Shapely geometries, GeoDataFrames and GeoSeries, a `delone.io.GeometrySet`, objects with
        ``__geo_interface__``, mappings of that form (GeoJSON), and iterables of these, in any
        combination. Each row of a table and each feature of a collection is a geometry.
    holes, regions, conforming, max_points, method, workers : optional
        As for `ConstrainedDelaunay`.
    boundary : {"hull", "outline", "polygons"}, optional
        What is triangulated: as for `ConstrainedDelaunay`; or only the inside of polygons, without
        their holes.
    crossing : {"split", "raise"}, optional
        As for `ConstrainedDelaunay`, but by default crossings are split, because borders in real
        data do cross.
    crs : str, int or pyproj.CRS, optional
        The coordinate reference system; by default that of the geometries, if they have one. It is
        stored in ``mesh.crs`` and passed on by ``mesh.to_geopandas()``. Coordinates are not
        transformed.
    planar : bool, optional
        Treat longitudes and latitudes as coordinates of a plane; otherwise geometries in a
        geographic reference system cause a warning.

    Returns
    -------
    ConstrainedDelaunay
        The triangulation. Its points are the distinct coordinates in order of appearance. Its
        segments are the lines and the sides of all rings, including holes, in the same order;
        ``geometry_of_segment`` contains the geometry of each, and ``part_of_segment`` its ring or
        line.

    Raises
    ------
    InputError
        An item is not a geometry, the geometries are in different reference systems, or pyproj is
        installed and does not know `crs`.
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
    Open rings are closed. Missing and empty geometries are skipped, and third coordinates are
    dropped. Equal coordinates are one point, so adjacent polygons share vertices. Polygons need not
    be valid: by the even-odd rule, a point is inside if the rings of a geometry wind around it an
    odd number of times, and ``mesh.polygon_of_simplex`` contains the first geometry that contains
    each triangle. With ``boundary="outline"``, holes of polygons remain; with ``"polygons"``, they
    are removed.

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
    >>> delone.from_geometry([square, line], boundary="polygons").polygon_of_simplex.tolist()
    [0, 0, 0, 0]
    """
    parts, system = _read(geometries, crs, planar=planar)
    return _triangulated(
        parts,
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


def inside_of(geometries: Any, *, planar: bool, **options: Any) -> ConstrainedDelaunay:
    """Triangulate the inside of polygons or, if there are none, what closed lines enclose."""
    parts, system = _read(geometries, None, planar=planar)
    areas = bool((parts.kinds >= geodata.EXTERIOR).any())
    boundary = "polygons" if areas or not len(parts.kinds) else "outline"
    return _triangulated(
        parts,
        holes=None,
        regions=None,
        boundary=boundary,
        conforming=False,
        max_points=None,
        method="auto",
        crs=system,
        **options,
    )


def _read(geometries: Any, crs: Any, *, planar: bool) -> tuple[geodata.Parts, str | None]:
    """Return the parts of geometries and their reference system, after the checks of both."""
    parts = geodata.parts_of(geometries)
    geodata.require_finite_parts(parts)
    system = common_crs(geometries) if crs is None else as_known_crs(crs)
    by = system if system is not None and is_geographic(system) else None
    warn_of_degrees(None, parts.coordinates, planar=planar, name="geometries", by=by)
    return parts, system


def _triangulated(parts: geodata.Parts, **options: Any) -> ConstrainedDelaunay:
    points, vertex = _merged(parts.coordinates)
    ends, part = geodata.steps_of(parts)
    # Points have no segments, so they are not counted among the parts.
    number = np.cumsum(parts.kinds != geodata.POINTS) - 1
    origin = Origin(
        parts.geometries[part].astype(np.int32),
        parts.kinds[part] >= geodata.EXTERIOR,
        number[part].astype(np.int32),
    )
    return ConstrainedDelaunay._of_geometries(points, vertex[ends], origin, **options)


def _merged(coordinates: Floats) -> tuple[Floats, Indices]:
    """Return the distinct points in the order of their first rows, and the point of each row."""
    first = first_rows(coordinates)
    distinct = first == np.arange(len(first))
    number = np.cumsum(distinct) - 1
    return coordinates[distinct], number[first].astype(np.int32)


class PolygonTriangles(NamedTuple):
    """The triangles inside a polygon.

    Parameters
    ----------
    points : ndarray of float64, shape (n, 2)
        The points of all rings, one ring after another, then the points where sides cross.
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
        # NumPy does not pickle the writeable flag of arrays.
        return _read_only, (self.points, self.simplices)

    def to_geopandas(self, data: Any = None, *, crs: Any = None) -> Any:
        """Return the triangles as a table of polygons (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, with one row for each triangle. The geometry of a GeoDataFrame is
            replaced; its reference system and index are kept.
        crs : optional
            Coordinate reference system, anything that geopandas accepts.

        Returns
        -------
        geopandas.GeoDataFrame
            One row for each triangle: its vertices ``v0``, ``v1`` and ``v2`` and its polygon.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row for each triangle.

        Examples
        --------
        >>> import delone
        >>> frame = delone.triangulate_polygon([(0, 0), (4, 0), (4, 3)]).to_geopandas()
        >>> frame.area.tolist()
        [6.0]
        """
        from delone.exchange.geopandas import to_geopandas

        return to_geopandas(Parts(self.points, self.simplices), crs, data)


def triangulate_polygon(polygon: Any, *, rule: str = "even-odd") -> PolygonTriangles:
    """Triangulate the inside of a polygon.

    Parameters
    ----------
    polygon : array_like of shape (n, 2), sequence of those, or geometry
        A ring, or the rings of a polygon in any order; rings need not repeat their first point. Or
        a shapely Polygon or MultiPolygon, an object with ``__geo_interface__``, or a mapping of
        that form.
    rule : {"even-odd", "nonzero"}, optional
        The inside, if rings cross or are nested: points with an odd winding number, or points with
        a nonzero winding number, summed over the rings.

    Returns
    -------
    PolygonTriangles
        Points and triangles. A polygon without an inside has no triangles.

    Raises
    ------
    NonFiniteError
        A coordinate is NaN or infinite.
    ShapeError, DtypeError, InputError
        `polygon` has no rings, or its points are not 2-D.

    Notes
    -----
    The polygon need not be valid: rings may cross themselves and each other, overlap, touch, or run
    back and forth. Where sides cross, a point is added, as in `ConstrainedDelaunay`. The triangles
    are those of the constrained Delaunay triangulation, exact and canonical.

    Rings of geometries are first oriented, outer rings counter-clockwise and holes clockwise,
    because the orientation of rings in geometries has no meaning; arrays are not reoriented.

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
    """Return the points of all rings, and the start of each ring."""
    # With shapely geometries, `hasattr` would evaluate `__geo_interface__`, a full conversion.
    if (
        isinstance(polygon, Mapping)
        or geodata.is_shapely(polygon)
        or hasattr(polygon, "__geo_interface__")
        or (
            isinstance(polygon, list | tuple)
            and len(polygon)
            and all(geodata.is_shapely(each) or isinstance(each, Mapping) for each in polygon)
        )
    ):
        return _rings_of_geometry(polygon, nonzero)
    rings = [as_points(ring, ndim=2, name="polygon") for ring in _listed(polygon)]
    counts = [len(ring) for ring in rings]
    starts = np.concatenate(([0], np.cumsum(counts))).astype(np.int32)
    return np.concatenate([np.empty((0, 2)), *rings]), starts


def _listed(polygon: Any) -> list[Any]:
    """Return the rings of a ring or a sequence of rings, distinguished by nesting depth."""
    if isinstance(polygon, np.ndarray) and polygon.dtype != object:
        return [polygon] if polygon.ndim == 2 else list(polygon)
    if not hasattr(polygon, "__iter__") or isinstance(polygon, str | bytes):
        raise InputError(f"polygon must be rings or a geometry, got {polygon!r:.80}")
    items = list(polygon)
    if not items:
        return []
    flat = hasattr(items[0], "__len__") and len(items[0]) and not hasattr(items[0][0], "__len__")
    return [items] if flat else [ring for ring in items if len(ring)]


def _rings_of_geometry(polygon: Any, nonzero: bool) -> tuple[Floats, Indices]:
    parts = geodata.parts_of(polygon, name="polygon")
    if (parts.kinds < geodata.EXTERIOR).any():
        raise InputError("polygon contains lines or points, which have no inside")
    points = parts.coordinates
    require_finite(points, name="polygon")
    if nonzero:
        for kind, start, end in zip(parts.kinds, parts.starts[:-1], parts.starts[1:], strict=True):
            ring = points[start:end]
            if _turns_left(ring) != (kind == geodata.EXTERIOR):
                points[start:end] = ring[::-1].copy()
    return points, parts.starts.astype(np.int32)


def _turns_left(ring: Floats) -> bool:
    """Return whether the signed area of a ring is positive, exactly; False for one of 0."""
    # Halved, then divided by the longest coordinate difference, so that nothing overflows.
    edges = ring / 2 - ring[0] / 2
    x, y = (edges / (np.abs(edges).max() or 1.0)).T
    left, right = x * np.roll(y, -1), y * np.roll(x, -1)
    twice = float(left.sum() - right.sum())
    # Differences, quotients, products and sums are rounded once each, and none of them exceeds 1.
    if abs(twice) > 2.0**-50 * len(ring) * (len(ring) + 4):
        return twice > 0
    exact = [(Fraction(p), Fraction(q)) for p, q in ring.tolist()]
    after = exact[1:] + exact[:1]
    return sum(p[0] * q[1] - q[0] * p[1] for p, q in zip(exact, after, strict=True)) > 0
