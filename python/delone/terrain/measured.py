"""What is read off a surface in many places at once: volumes in polygons."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from delone.terrain import regions as regions_
from delone.triangulation import HullTiling

if TYPE_CHECKING:
    from delone.terrain.surface import Surface

__all__ = ["Measured"]


class Measured(HullTiling):
    """The ways to measure a surface in many places at once."""

    __slots__ = ()

    def volumes_to(self, other: Any, regions: Any) -> regions_.Volumes:
        """Compute the volumes between this surface and another one in each polygon of a layer.

        Parameters
        ----------
        other : float, triple of float, or TIN
            As for `volume_to`.
        regions : GeoDataFrame, GeometrySet, or sequence of polygons or rings
            A region for each row, feature or item: polygons and multipolygons of shapely, closed
            lines, GeoJSON, or arrays of shape (k, 2), each of which is a region of its own. A
            missing geometry is a row without an area. Regions may overlap.

        Returns
        -------
        Volumes
            Cut, fill, net and area of each region, and which share of it both surfaces cover.

        Raises
        ------
        InputError
            A feature is neither a polygon nor a closed line; the message has its row. Otherwise as
            for `volume_to`.

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
        region are intersected; finding them takes some milliseconds for a million.

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
