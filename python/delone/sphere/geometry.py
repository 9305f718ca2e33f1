"""Polygons, lines and points in longitudes and latitudes as arcs and directions."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_flag
from delone._base.duplicates import first_rows
from delone._base.georeference import as_degrees, common_crs
from delone.constrained import geodata
from delone.errors import DirectionError, InputError
from delone.sphere.constrained import WINDINGS, ConstrainedDelaunay, Given, most_added
from delone.sphere.coordinates import directions_of
from delone.sphere.sides import SIDES, Origin, divided, whole_sphere

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats

__all__ = ["from_geometry", "read"]


def from_geometry(
    geometries: Any,
    *,
    winding: str = "smaller",
    sides: str | None = None,
    crossing: str = "split",
    max_points: int | None = None,
    degrees: bool = True,
    workers: int | None = None,
) -> ConstrainedDelaunay:
    """Triangulate the sphere with polygons, lines and points in longitudes and latitudes.

    Parameters
    ----------
    geometries : geometry or iterable of geometries
        As for `delone.from_geometry`: shapely geometries, GeoDataFrames, GeoJSON-like mappings, or
        iterables of these. Each row of a table and each feature of a collection is a geometry.
        Longitudes come first. Projected coordinates are transformed (extra ``geo``); without a
        reference system, coordinates are treated as longitudes and latitudes.
    winding : {"smaller", "ccw", "cw"}, optional
        Which side of its outer rings is inside a polygon: the side that makes the geometry the
        smaller part of the sphere, whatever the direction of its rings (the default); the left one,
        because outer rings in GeoJSON (RFC 7946) run counter-clockwise; or the right one, as in
        shapefiles. The majority of the sides of its outer rings decides. A hemisphere is by default
        on the left, as with "ccw".
    sides : {"arc", "parallel"}, optional
        The line between two points: the arc of a great circle (the default, with a warning if one
        is longer than 30 degrees and not on a meridian), or a straight line on a map of longitudes
        and latitudes, such as a parallel, in pieces of at most one degree.
    crossing : {"split", "raise"}, optional
        As for `ConstrainedDelaunay`, but by default crossings are split, because borders in real
        data do cross.
    max_points : int, optional
        As for `ConstrainedDelaunay`.
    degrees : bool, optional
        Whether angles are in degrees (the default) or in radians.
    workers : int, optional
        Maximum number of threads; by default one per core.

    Returns
    -------
    ConstrainedDelaunay
        The triangulation. Its directions are the distinct coordinates in order of appearance, then
        crossings; its segments are the lines and the sides of all rings. ``geometry_of_segment`` is
        the geometry of each, and ``polygon_of_simplex`` the first geometry that contains each
        triangle, -1 at sea.

    Raises
    ------
    InputError
        An item is not a geometry, is the whole sphere, or has a side that goes once around along a
        parallel, which has no arc. Reading ``polygon_of_simplex`` also raises it, if the outer
        rings of a geometry have as many sides in one direction as in the other, and the direction
        matters.
    CrossingSegmentsError, BudgetExceededError, DirectionError, DegenerateInputError
        As for `ConstrainedDelaunay`.
    NonFiniteError
        A coordinate is NaN or infinite; the rows of the error are geometries.

    Warns
    -----
    LongitudeWarning
        Longitudes span more than one turn.
    PolygonWarning
        A side is longer than 30 degrees; or, when ``polygon_of_simplex`` is read, a geometry covers
        more than half of the sphere.

    Notes
    -----
    Sides of rings are arcs of great circles, unless ``sides`` selects straight lines on a map. A
    ring may surround a pole or cross the date line. Sides that occur twice in a geometry separate
    nothing, such as the cut along the date line from the coast of a polygon to the pole. By the
    even-odd rule, a point is inside if the rings of a geometry separate it from the outside an odd
    number of times, so the direction of inner rings does not matter.

    Examples
    --------
    >>> from delone import sphere
    >>> cap = [(0, 70), (90, 70), (180, 70), (-90, 70)]
    >>> island = [(175, -5), (-175, -5), (-175, 5), (175, 5)]
    >>> land = [{"type": "Polygon", "coordinates": [ring]} for ring in (cap, island)]
    >>> points = {"type": "MultiPoint", "coordinates": [(10, -70), (130, -70), (-110, -70)]}
    >>> mesh = sphere.from_geometry([*land, points])
    >>> [round(float(mesh.areas[mesh.polygon_of_simplex == k].sum()), 3) for k in (-1, 0, 1)]
    [12.287, 0.249, 0.03]
    """
    as_flag(degrees, name="degrees")
    most = most_added(crossing, max_points)
    vectors, given, whole = read(geometries, winding, degrees=degrees, workers=workers, sides=sides)
    if whole is not None:
        raise InputError(
            f"geometry {whole} is the whole sphere, which has no sides to triangulate: leave it out"
        )
    return ConstrainedDelaunay._of_geometries(vectors, given, most, degrees, workers)


def read(
    geometries: Any,
    winding: str,
    *,
    degrees: bool,
    workers: int | None,
    sides: str | None = None,
    name: str = "geometries",
) -> tuple[Floats, Given, int | None]:
    """Return the distinct coordinates of geometries as vectors, and their segments.

    The third item is the first geometry that is the whole sphere because its sides cancel out, or
    None.
    """
    as_choice(winding, WINDINGS, name="winding")
    if sides is not None:
        as_choice(sides, SIDES, name="sides")
    crs = common_crs(geometries)
    if crs is not None and not degrees:
        raise InputError(f"{name} have a reference system, so they are in degrees: degrees=True")
    if len(geodata.rings_of_numbers(geometries, name) or ()) > 1:
        raise InputError(
            f"{name} are several rings of coordinates, and which are holes of which is not known: "
            "pass polygons"
        )
    parts = geodata.parts_of(geometries, name=name)
    geodata.require_finite_parts(parts)
    parts = parts._replace(coordinates=as_degrees(parts.coordinates, crs, name=name))
    quarter = 90.0 if degrees else math.pi / 2
    parts = divided(parts, sides, quarter, name=name)
    first = first_rows(parts.coordinates)
    distinct = first == np.arange(len(first))
    vertex = (np.cumsum(distinct) - 1)[first].astype(np.int32)
    lonlat = parts.coordinates[distinct]
    try:
        vectors = directions_of(lonlat, None, degrees=degrees, workers=workers)
    except DirectionError as error:
        raise _placed(error, parts, np.flatnonzero(distinct), name) from None
    ends, part = geodata.steps_of(parts)
    kinds = parts.kinds[part]
    origin = Origin(
        parts.geometries[part].astype(np.int32),
        kinds >= geodata.EXTERIOR,
        kinds == geodata.EXTERIOR,
    )
    whole = whole_sphere(parts, vectors, vertex[ends], origin)
    return vectors, Given(vertex[ends], origin, winding, len(vectors)), whole


def _placed(
    error: DirectionError, parts: geodata.Parts, rows: NDArray[np.int64], name: str
) -> DirectionError:
    """Return an error about coordinates with the first geometry and place instead of rows."""
    row = int(rows[int(error.rows[0])])
    part = int(np.searchsorted(parts.starts, row, side="right")) - 1
    x, y = parts.coordinates[row].tolist()
    # Only the row numbers change, because those of the error are of an internal array.
    _, _, what = str(error).partition(" a ")
    kind, _, hint = what.partition(", first row")
    _, _, hint = hint.partition(": ")
    return DirectionError(
        f"{name}: geometry {int(parts.geometries[part])} has a {kind} at ({x:.10g}, {y:.10g}): "
        f"{hint}; project other coordinates to longitudes and latitudes first",
        rows=parts.geometries[[part]],
        count=error.count,
    )
