"""Measurements of several surfaces, or in many places at once: volumes, profiles, sections."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from delone._tiling.triangulation import HullTiling
from delone.terrain import regions as regions_
from delone.terrain import sections

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone.terrain.surface import Surface

__all__ = ["Measured"]


class Measured(HullTiling):
    """The ways to measure several surfaces, or one in many places at once."""

    __slots__ = ()

    def volumes_to(self, other: Any, regions: Any) -> regions_.Volumes:
        """Compute the volumes between this surface and another one in each polygon of a layer.

        Parameters
        ----------
        other : float, triple of float, or TIN
            As for `volume_to`.
        regions : GeoDataFrame, GeometrySet, or sequence of polygons or rings
            A region for each row, feature or item: shapely polygons and multipolygons, closed
            lines, GeoJSON, or arrays of shape (k, 2), each of which is a separate region. A missing
            geometry gives a row without an area. Regions may overlap.

        Returns
        -------
        Volumes
            Cut, fill, net and area of each region, and the share of it that both surfaces cover.

        Raises
        ------
        InputError
            A feature is neither a polygon nor a closed line; the message names its row. Otherwise
            as for `volume_to`.

        Warns
        -----
        CRSWarning, UserWarning
            One reference system is unknown; regions have no area in common with both surfaces.

        See Also
        --------
        volume_to : The same for the union of all polygons, and for the whole surface.

        Notes
        -----
        Up to rounding, each row is ``volume_to(other, region=polygon)``. Only the triangles near a
        region are intersected; finding them takes a few milliseconds for a million triangles.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 2), (4, 0, 2), (4, 4, 2), (0, 4, 2)])
        >>> plots = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(3, 3), (5, 3), (5, 5), (3, 5)]]
        >>> ground.volumes_to(1.0, plots).to_pandas()[["cut", "net", "area", "coverage"]]
           cut  net  area  coverage
        0  4.0 -4.0   4.0      1.00
        1  1.0 -1.0   1.0      0.25
        """
        return regions_.volumes(cast("Surface", self), other, regions)

    def profiles(
        self, line: Any, others: Any = None, *, name: str = "surface"
    ) -> sections.Profiles:
        """Compute the heights of this surface and of others along a line, at common distances.

        Parameters
        ----------
        line : array_like, shape (k, 2), or shapely.LineString
            The line.
        others : TIN, sequence of TIN, or dict of str to TIN, optional
            The other surfaces, such as a design, optionally by their names; default names are
            ``"other"``, or ``"other 1"`` and so on.
        name : str, optional
            The name of this surface.

        Returns
        -------
        Profiles
            The heights of all surfaces wherever one of them has an edge, so that each is linear in
            between: differences of columns are exact up to rounding.

        Raises
        ------
        InputError
            `line` is not one line of at least two points; surfaces are in different reference
            systems, or their heights in different units; or two have the same name.

        See Also
        --------
        profile : The same for one surface.
        cross_sections : Profiles across an alignment.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (8, 0, 0), (8, 8, 8), (0, 8, 8)])
        >>> design = TIN.from_points([(0, 0, 3), (8, 0, 3), (8, 4, 3), (0, 4, 3)])
        >>> ground.profiles([(1, 0), (1, 8)], {"design": design}, name="ground").to_pandas()
           distance  ground  design    x    y
        0       0.0     0.0     3.0  1.0  0.0
        1       0.5     0.5     3.0  1.0  0.5
        2       1.0     1.0     3.0  1.0  1.0
        3       4.0     4.0     3.0  1.0  4.0
        4       8.0     8.0     NaN  1.0  8.0
        """
        return sections.profiles(cast("Surface", self), line, others, name)

    def cross_sections(
        self,
        line: Any,
        *,
        interval: float | None = None,
        stations: ArrayLike | None = None,
        start: float = 0.0,
        left: float,
        right: float | None = None,
        others: Any = None,
        name: str = "surface",
    ) -> sections.CrossSections:
        """Compute profiles across an alignment.

        Parameters
        ----------
        line : array_like, shape (k, 2), or shapely.LineString
            The alignment.
        interval : float, optional
            The distance between stations, from the start of the alignment; there is always one at
            its end.
        stations : array_like, shape (k,), optional
            The stations, instead of an interval.
        start : float, optional
            The station of the start of the alignment.
        left, right : float
            How far sections extend to each side of the alignment, as seen in its direction; `right`
            is by default the same as `left`.
        others, name : optional
            Further surfaces, as for `profiles`.

        Returns
        -------
        CrossSections
            The profiles, from left to right.

        Raises
        ------
        InputError
            A station is outside the alignment, or a width or the interval is out of range;
            otherwise as for `profiles`.
        BudgetExceededError
            The interval gives more than 100,000 stations.

        Notes
        -----
        Sections are perpendicular to the alignment; at a corner, they bisect the angle.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 9), (0, 90, 9)])
        >>> road = [(20, 20), (80, 20)]
        >>> found = ground.cross_sections(road, interval=25, left=10, start=1000)
        >>> found.stations.tolist()
        [1000.0, 1025.0, 1050.0, 1060.0]
        >>> found.sections[0].z.ravel().round(9).tolist()
        [3.0, 2.0, 1.0]
        """
        return sections.cross_sections(
            cast("Surface", self), line, interval, stations, start, left, right, others, name
        )
