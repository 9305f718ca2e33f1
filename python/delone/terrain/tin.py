"""The class TIN: a triangulated surface with a height at each vertex."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from delone._base.counting import counted
from delone._base.immutable import kept, made_by, sealed
from delone._base.renames import renamed
from delone._tiling.plane import topology
from delone.refine.validation import MeshValidation, validate
from delone.terrain import building, contouring, profiles, slopes, volumes
from delone.terrain.detail import Detailed
from delone.terrain.earthworks import Earthworks
from delone.terrain.measured import Measured
from delone.terrain.sources import Sources
from delone.terrain.surveyed import Surveyed

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone.interpolate.raster import Grid

__all__ = ["TIN"]


class _Sheet(NamedTuple):
    """What the core needs from a surface."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


@made_by("create a TIN with TIN.from_points, from_raster or from_file")
@renamed(volume="volume_to", gradient="gradients")
class TIN(Sources, Surveyed, Measured, Earthworks, Detailed):
    """A triangulated irregular network: a surface that is linear in each triangle.

    Create one with `from_points`, `from_raster` or `from_file`.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        Horizontal coordinates of the vertices, without repetition: points, then points of lines,
        then crossings of lines.
    z : ndarray of float64, shape (n,)
        Heights of the vertices.
    simplices : ndarray of int32, shape (m, 3)
        The triangles as rows of `points`, counter-clockwise as seen from above, without those
        outside the boundary, in holes, or removed because of `max_edge`.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle across the edge opposite each vertex; -1 outside.
    breaklines : ndarray of int32, shape (q, 2)
        The edges on lines: breaklines, boundary, holes, islands and shores of level polygons.
    soft : ndarray of bool, shape (q,)
        Which of these edges are on soft breaklines only.

    Notes
    -----
    The triangles are those of a `ConstrainedDelaunay` of points and lines: exact and canonical. A
    TIN is one surface in memory. For larger point sets, the tiles of ``delone tile`` also provide
    contours, profiles and volumes: see `delone.distributed.TiledDelaunay`.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> corners = [(0, 0, 0), (10, 0, 0), (10, 10, 10), (0, 10, 10)]
    >>> dike = [(0, 4, 8), (10, 4, 8)]
    >>> tin = TIN.from_points(corners, breaklines=[dike])
    >>> tin
    <TIN of 6 points: 4 triangles, heights 0 to 10>
    >>> float(tin.heights([5, 2]))
    4.0
    """

    __slots__ = ("_all_neighbors", "_all_simplices", "_kept")

    _ARRAYS: ClassVar[tuple[str, ...]] = (
        "points",
        "z",
        "all_simplices",
        "all_neighbors",
        "kept",
        "breaklines",
        "soft",
    )

    _all_neighbors: Indices
    _all_simplices: Indices
    _kept: Bools

    @classmethod
    def from_points(
        cls,
        xyz: Any,
        *,
        breaklines: Any = None,
        soft_breaklines: Any = None,
        boundary: Any = None,
        holes: Any = None,
        islands: Any = None,
        max_edge: float | None = None,
        voids: bool = False,
        duplicates: str = "raise",
        crossing: str = "raise",
        tolerance: float = 0.0,
        snap: float = 0.0,
        level: Any = None,
        crs: Any = None,
        units: str | None = None,
        planar: bool = False,
        workers: int | None = None,
    ) -> Self:
        """Triangulate points with heights, and lines.

        Parameters
        ----------
        xyz : array_like, shape (n, 3), or PointSet with heights
            The points. x and y must have the same unit of length; heights may have a different one,
            but should preferably have the same.
        breaklines, soft_breaklines : optional
            Lines that become edges, such as those of roads, dikes and water: shapely geometries,
            GeoDataFrames, a `delone.io.GeometrySet`, or arrays of shape (k, 2) or (k, 3).
            Lines without heights follow the surface of the points, and so do single points of a
            line whose height is NaN. Both kinds become edges; contours are not smoothed where they
            cross hard ones.
        boundary, holes : optional
            Polygons or rings: the surface ends at the boundary, or where the points end, and does
            not cover holes. Each polygon has its own holes, and several polygons form a union.
            Rings given as arrays or closed lines form one polygon by the even-odd rule.
        islands : optional
            Polygons or rings in holes or outside the boundary that belong to the surface.
        max_edge : float, optional
            Triangles are removed from the outside in, as long as their outer edge is longer than
            this and not on a line; by default, the surface covers the convex hull or the boundary.
        voids : bool, optional
            Remove all triangles with an edge longer than `max_edge` that is not on a line, even
            inside, such as across lakes.
        duplicates : {"raise", "min", "max", "mean"}, optional
            The height where points, or a point and a line, have different heights at one place.
        crossing : {"raise", "min", "max", "mean"}, optional
            The height where lines with different heights cross or touch.
        tolerance : float, optional
            Heights at one place that differ by at most this count as equal; by default, the limit
            is the slope of a line times the rounding error of its coordinates. Of equal heights,
            the most accurate is used, and of several such heights, the lowest.
        snap : float, optional
            Points that are closer than this to each other or to a line are merged. Points of lines
            are merged first, and ends of lines move onto lines that they nearly reach. Then other
            points move to points of lines, or become part of a line; of the rest, the first in the
            order of x and y is kept. Heights that meet at a place are treated as duplicates: see
            `duplicates`, `crossing` and `tolerance`. Boundary, holes and islands do not move.
            `adjustments` contains the number of moved points and the largest move.
        level : optional
            Polygons or rings, such as lakes, in which the surface is level. Each feature, or each
            ring given as an array, gets the common height of its points or, without heights, the
            lowest height of the surface along its shore. Points inside or on the shore are left out
            and counted in `adjustments`; `max_edge` removes nothing there.
        crs : optional
            Coordinate reference system, such as ``"EPSG:28992"``, an EPSG code or a pyproj.CRS; by
            default that of the data. Lines that declare another one are transformed (with pyproj).
        units : str, optional
            The unit of heights, such as ``"m"``, ``"ft"`` or ``"us-ft"``; by default that of the
            vertical axis of the reference system, if it has one.
        planar : bool, optional
            Whether longitudes and latitudes are intentional, without a warning.
        workers : int, optional
            Maximum number of threads, also of contours, bands and volumes; by default one per
            core. Results do not depend on it.

        Returns
        -------
        TIN
            The surface.

        Raises
        ------
        ConflictingValuesError
            Heights differ at a place, and the policy is ``"raise"``; the message lists places and
            heights, and ``error.rows`` rows of `points`. A vertical wall is such a conflict.
        CrossingSegmentsError
            The rings of a polygon cross themselves or each other.
        InputError
            A line without heights extends beyond the points, `crs` is not the reference system of
            the points, no triangle is left, a level polygon has several heights, no height, or a
            line with a different height inside, or an option is not one of its choices.
        BudgetExceededError
            `snap` is so large that millions of pairs of points are near each other.
        DegenerateInputError, NonFiniteError, ShapeError, DtypeError, MemoryError
            As for `delone.Delaunay`.

        Warns
        -----
        GeographicWarning, UnitsWarning, CRSWarning
            x and y are degrees or have a different unit from heights; or an unknown CRS is assumed
            to be the known one.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> points = [(0, 0, 0), (4, 0, 0), (4, 4, 4), (0, 4, 4)]
        >>> TIN.from_points(points, holes=[[(1, 1), (2, 1), (2, 2), (1, 2)]]).areas.sum()
        np.float64(15.0)
        """
        made = building.build(
            xyz,
            breaklines=breaklines,
            soft_breaklines=soft_breaklines,
            boundary=boundary,
            holes=holes,
            islands=islands,
            max_edge=max_edge,
            voids=voids,
            duplicates=duplicates,
            crossing=crossing,
            tolerance=tolerance,
            snap=snap,
            level=level,
            crs=crs,
            units=units,
            planar=planar,
            workers=workers,
            surface_of=partial(
                cls.from_points,
                duplicates=duplicates,
                tolerance=tolerance,
                planar=True,
                workers=workers,
            ),
        )
        return cls._built(made, workers)

    @classmethod
    def _built(cls, made: building.Built, workers: int | None) -> Self:
        return cls._from_arrays(
            {
                "points": made.points,
                "z": made.z,
                "all_simplices": made.simplices,
                "all_neighbors": made.neighbors,
                "kept": made.kept,
                "breaklines": made.segments,
                "soft": made.soft,
                "crs": np.array(made.crs or ""),
                "units": np.array(made.units or ""),
                "adjustments": np.array(
                    "" if made.adjustments is None else made.adjustments._text()
                ),
            },
            workers=workers,
        )

    def _fill(self, arrays: Any, stages: Any, workers: int | None) -> None:
        known = {name: arrays.get(name, np.array("")) for name in ("crs", "units", "adjustments")}
        plain = {name: arrays[name] for name in self._ARRAYS}
        kept, simplices, neighbors = (
            plain[name] for name in ("kept", "all_simplices", "all_neighbors")
        )
        if not kept.all():
            number = np.cumsum(kept, dtype=np.int32) - 1
            number = np.append(np.where(kept, number, -1), -1).astype(np.int32)
            simplices, neighbors = simplices[kept], number[neighbors[kept]]
        given = plain | {"simplices": simplices, "neighbors": neighbors} | known
        super()._fill(given, stages, workers)

    def _arrays(self) -> dict[str, NDArray[Any]]:
        known = {"crs": self._crs, "units": self._units, "adjustments": self._adjustments}
        return super()._arrays() | {name: text for name, text in known.items() if str(text)}

    def _described(self) -> str:
        low, high = slopes.extremes(self)
        return (
            f"{counted(self.npoints, 'point')}: {counted(self.nsimplex, 'triangle')}, "
            f"heights {low:.6g} to {high:.6g}"
        )

    def _left_out(self) -> Indices:
        return self._all_simplices[~self._kept]

    def _tiling(self) -> tuple[Indices, Indices]:
        return self._all_simplices, self._all_neighbors

    @property
    @kept
    def _number(self) -> Indices | None:
        if self._kept.all():
            return None
        number = np.cumsum(self._kept, dtype=np.int32) - 1
        return np.append(np.where(self._kept, number, -1), -1).astype(np.int32)

    def _sheet(self) -> _Sheet:
        return _Sheet(self._points, self._simplices, self._neighbors, self._z)

    @property
    @kept
    def gradients(self) -> Floats:
        """The change of height per unit in x and in y of each triangle, (m, 2)."""
        return sealed(slopes.gradient(self._points, self._z, self._simplices))

    @property
    @kept
    def normals(self) -> Floats:
        """Upward unit normals of the triangles, (m, 3)."""
        return sealed(slopes.normals(self.gradients))

    @property
    @kept
    def slope(self) -> Floats:
        """Slope of each triangle in degrees, (m,): 0 is level, 90 vertical."""
        return sealed(slopes.slope(self.gradients))

    @property
    @kept
    def aspect(self) -> Floats:
        """The direction in which each triangle faces, (m,): degrees clockwise from north.

        North is the direction of y. NaN where the triangle is level.
        """
        return sealed(slopes.aspect(self.gradients))

    def hillshade(
        self, *, azimuth: float = 315.0, altitude: float = 45.0, z_factor: float = 1.0
    ) -> Floats:
        """Compute the brightness of each triangle under a distant light.

        Parameters
        ----------
        azimuth : float, optional
            Direction of the light, in degrees clockwise from north.
        altitude : float, optional
            Angle of the light above the horizon, in degrees.
        z_factor : float, optional
            Factor for heights: exaggeration, or the unit of heights in units of the coordinates.

        Returns
        -------
        ndarray of float64, shape (m,)
            0 for triangles that face away from the light, 1 for those that face it.

        Raises
        ------
        InputError
            An angle is not finite, or `altitude` is not between 0 and 90.

        Notes
        -----
        The cosine of the angle between normal and light (Lambert), as in GDAL's ``gdaldem
        hillshade``, which scales it to 1 to 255. Shadows are not cast.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> TIN.from_points([(0, 0, 0), (1, 0, 0), (0, 1, 0)]).hillshade(altitude=90)
        array([1.])
        """
        return slopes.hillshade(self.gradients, azimuth, altitude, z_factor)

    def heights(self, xy: ArrayLike, *, tolerance: float = 0.0) -> Floats:
        """Return heights of the surface.

        Parameters
        ----------
        xy : array_like, shape (..., 2)
            Positions.
        tolerance : float, optional
            Positions outside that are at most this far away count as inside, as in
            `Delaunay.locate`.

        Returns
        -------
        ndarray of float64, shape (...)
            Heights: at vertices, exactly theirs; NaN outside, and where a coordinate is NaN.

        Raises
        ------
        ShapeError, DtypeError
            `xy` is not a real array of shape (..., 2).

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 1), (4, 0, 5), (0, 4, 9)])
        >>> tin.heights([(1, 1), (0, 4), (5, 5)])
        array([ 4.,  9., nan])
        """
        return slopes.heights(self, xy, tolerance)

    def contours(
        self,
        levels: ArrayLike | None = None,
        *,
        interval: float | None = None,
        base: float = 0.0,
        index: int = 5,
        smooth: int = 0,
        min_length: float = 0.0,
        min_area: float = 0.0,
        simplify: float = 0.0,
        max_points: int = contouring.MOST,
    ) -> contouring.Contours:
        """Compute contour lines.

        Parameters
        ----------
        levels : array_like, shape (k,), optional
            Heights of the contours.
        interval : float, optional
            Distance between levels, instead of `levels`: the levels are `base` plus all multiples
            of it within the heights of the surface, each the double nearest to the decimal number,
            so that three times 0.1 is 0.3.
        base : float, optional
            The level from which multiples of `interval` are counted.
        index : int, optional
            With an interval, every `index`-th multiple is marked as an index contour; 0 marks none.
        smooth : int, optional
            Number of corner-cutting rounds, at most 5; 0 keeps contours straight in each triangle.
            Smoothed lines do not cross: where they would, corners are kept.
        min_length : float, optional
            Lines shorter than this, in the unit of the points, are left out and counted.
        min_area : float, optional
            Closed lines that enclose less than this are left out and counted.
        simplify : float, optional
            Points of lines are left out and counted as long as each is within this distance of the
            line that remains, no line crosses another one, itself or the outline, and lines stay on
            the same side of each other.
        max_points : int, optional
            Maximum total number of points of all contours; each round of smoothing may double it.

        Returns
        -------
        Contours
            Lines that are closed or end at the outline, with higher ground to their left.

        Raises
        ------
        InputError
            Levels or another argument are out of range, or not exactly one of `levels` and
            `interval` is given.
        BudgetExceededError
            There would be more than `max_points` points; raised before they are computed.

        Notes
        -----
        A vertex is above a level if its height is at least the level, exactly. So lines are
        continuous, end only at the outline, and enclose those of the next level, even on plateaus
        and saddles. Loops without an area, around a vertex or ridge exactly at a level, are left
        out. Coordinates are rounded once; where lines would then cross, points are merged.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> found = tin.contours(interval=3)
        >>> found
        <Contours of 3 levels: 2 lines>
        >>> found.level.tolist(), found.coordinates(1).tolist()
        ([3.0, 6.0], [[0.0, 3.0], [3.0, 3.0], [4.0, 3.0]])
        """
        wanted, marked = contouring.levels_of(
            partial(slopes.extremes, self), levels, interval, base, index
        )
        finish = contouring.Finish.of(smooth, min_length, min_area, simplify)
        return contouring.lines(self, wanted, marked, max_points, finish)

    def bands(
        self,
        levels: ArrayLike | None = None,
        *,
        interval: float | None = None,
        base: float = 0.0,
        min_area: float = 0.0,
        simplify: float = 0.0,
        max_points: int = contouring.MOST,
    ) -> contouring.Bands:
        """Compute the areas between contours as polygons.

        Parameters
        ----------
        levels, interval, base, max_points
            As for `contours`.
        min_area : float, optional
            A polygon with a smaller area than this that fills a hole of another one is merged into
            it, with everything inside; holes of the surface are kept. Merged polygons are counted.
        simplify : float, optional
            Points of the borders between polygons are left out and counted as for `contours`, the
            same points in both polygons. The outline is unchanged.

        Returns
        -------
        Bands
            Valid polygons with holes that tile the surface, including the parts below the lowest
            level and above the highest one. Adjacent polygons share their vertices bit for bit.

        Raises
        ------
        InputError, BudgetExceededError
            As for `contours`.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.bands([4.0])
        <Bands of 2 ranges: 2 polygons>
        """
        wanted, _ = contouring.levels_of(partial(slopes.extremes, self), levels, interval, base, 1)
        return contouring.bands(self, wanted, min_area, simplify, max_points)

    def profile(self, line: Any) -> profiles.Profile:
        """Compute the heights along a line.

        Parameters
        ----------
        line : array_like, shape (k, 2), or shapely.LineString
            The line.

        Returns
        -------
        Profile
            Distances and heights at the points of the line and wherever it crosses an edge.

        Raises
        ------
        InputError
            `line` is not one line of at least two points.

        Warns
        -----
        UserWarning
            The line is outside the surface, so the profile has no points.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> found = tin.profile([(2, 1), (2, 4)])
        >>> found.distances.tolist(), found.z.tolist()
        ([0.0, 1.0, 3.0], [2.0, 4.0, 8.0])
        """
        return profiles.warn_of_no_points(profiles.profile(self, line))

    def drape(self, geometry: Any) -> Any:
        """Drape a geometry over the surface (extra ``geo``).

        Parameters
        ----------
        geometry : shapely geometry
            Points, lines, polygons, or collections of them.

        Returns
        -------
        shapely geometry
            The same geometry with heights, and with an additional point wherever it crosses an edge
            of the surface.

        Raises
        ------
        InputError
            A part of it is outside the surface; the message contains the first such point.
        MissingExtraError
            shapely is not installed.

        Examples
        --------
        >>> import shapely
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 8), (0, 4, 8)])
        >>> tin.drape(shapely.LineString([(2, 1), (2, 4)])).wkt
        'LINESTRING Z (2 1 2, 2 2 4, 2 4 8)'
        """
        return profiles.drape(self, geometry)

    def line_of_sight(
        self, a: ArrayLike, b: ArrayLike, *, height: float = 0.0, target: float = 0.0
    ) -> profiles.Sight:
        """Determine whether one point of the surface is visible from another.

        Parameters
        ----------
        a, b : array_like, shape (2,)
            The positions of the observer and of the target.
        height, target : float, optional
            Their heights above the surface.

        Returns
        -------
        Sight
            Truthy if no part of the surface is above the line of sight; otherwise it contains the
            first obstruction. The curvature of the Earth is ignored.

        Raises
        ------
        InputError
            A position is outside the surface.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)])
        >>> bool(tin.line_of_sight((0, 2), (4, 2), height=1))
        False
        >>> bool(tin.line_of_sight((0, 2), (4, 2), height=4, target=4))
        True
        """
        return profiles.sight(self, a, b, height, target)

    def volume_to(self, other: Any, *, region: Any = None) -> volumes.Volume:
        """Compute the volume between this surface and a plane or another surface.

        Parameters
        ----------
        other : float, triple of float, or TIN
            The surface to reach: a height, a plane (a, b, c) with the heights c + a x + b y, or
            another surface.
        region : optional
            Polygons or rings, as for `boundary` of `from_points`, to which the volume is limited.
            Arrays are closed automatically; other lines must be closed.

        Returns
        -------
        Volume
            Cut (this surface above `other`), fill (below) and their areas, where both are defined.

        Raises
        ------
        InputError
            The surfaces are in different reference systems, or their heights in different units;
            `other` is none of these; or `region` has points or open lines.
        LimitError
            Areas exceed the largest double, or both volumes do.

        Warns
        -----
        CRSWarning, UserWarning
            One reference system is unknown; or the surfaces have no area in common.

        See Also
        --------
        volumes_to : The same for each polygon of a layer.

        Notes
        -----
        The volume is the sum of prisms over the intersections of the triangles of both surfaces,
        split where the surfaces cross: correct up to rounding. The time is about linear in the
        number of intersections.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 2), (4, 0, 2), (4, 4, 2), (0, 4, 2)])
        >>> found = ground.volume_to(1.0, region=[[(0, 0), (2, 0), (2, 2), (0, 2)]])
        >>> found.cut, found.fill, found.area
        (4.0, 0.0, 4.0)
        """
        return volumes.volume(self, other, region)

    def raster(self, what: str = "height", **options: Any) -> Grid:
        """Sample the surface on a raster.

        Parameters
        ----------
        what : {"height", "slope", "aspect", "hillshade"}, optional
            The values: heights at the centers of cells, or the measure of the triangle there.
        **options
            ``resolution``, ``shape``, ``x``, ``y``, ``bounds``, ``tolerance`` and ``progress`` as
            for `delone.interpolate.grid`; for ``"hillshade"`` those of `hillshade`.

        Returns
        -------
        Grid
            Values, NaN outside the surface.

        Raises
        ------
        InputError
            `what` is not one of its choices; otherwise as for `delone.interpolate.grid`.
        MemoryError
            The raster does not fit into free memory.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> tin = TIN.from_points([(0, 0, 0), (4, 0, 4), (4, 4, 4), (0, 4, 0)])
        >>> tin.raster("slope", resolution=2).values
        array([[45., 45.],
               [45., 45.]])
        """
        return slopes.raster(self, what, options)

    def validate(self) -> MeshValidation:
        """Prove that the triangles are a canonical constrained Delaunay triangulation.

        Returns
        -------
        MeshValidation
            Truthy if there are no faults. Triangles outside the boundary are checked as well.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> bool(TIN.from_points([(0, 0, 1), (4, 0, 5), (0, 4, 9)]).validate())
        True
        """
        ends = self._all_simplices[:, [[1, 2], [2, 0], [0, 1]]]
        keys = topology.edge_keys(ends[..., 0], ends[..., 1], self.npoints)
        lines = topology.edge_keys(self._breaklines[:, 0], self._breaklines[:, 1], self.npoints)
        constrained = np.isin(keys, lines) | (self._all_neighbors < 0)
        return validate(self._points, self._all_simplices, self._all_neighbors, constrained)
