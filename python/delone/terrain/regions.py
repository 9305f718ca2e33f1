"""Volumes between surfaces in each polygon of a layer, as a table.

Each polygon is computed on the triangles whose boxes meet its own: others have no area in common
with it. So, up to rounding, the numbers are those of the polygon alone on the whole surfaces.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from delone import _core
from delone._base.arrays import as_workers
from delone._base.counting import agreed, counted
from delone._base.extras import require
from delone._base.georeference import caller_level
from delone._base.immutable import ReadOnly, sealed
from delone._base.units import area_units, volume_units
from delone._tiling.measures import sizes
from delone._tiling.plane.geometry import total
from delone.errors import DegenerateInputError
from delone.terrain.layer import Layer
from delone.terrain.lines import LOOSE, rings_by_feature
from delone.terrain.volumes import Region, goal_of, refuse_overflow, region_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.terrain.lines import Ring
    from delone.terrain.surface import Sheet, Surface

__all__ = ["Volumes", "volumes"]

# The number of rows that a warning names.
_NAMED = 10
# Fractions this close to 1 count as complete: areas are rounded.
_WHOLE = 1e-9
_COLUMNS = ("cut", "fill", "net", "area", "coverage", "cut_area", "fill_area", "region_area")


@dataclass(frozen=True, eq=False, kw_only=True)
class Volumes(ReadOnly, Layer):
    """The volumes between two surfaces in each polygon of a layer, one row for each.

    Parameters
    ----------
    cut, fill : ndarray of float64, shape (k,)
        The volumes where the surface is above and below the other one.
    cut_area, fill_area : ndarray of float64, shape (k,)
        The corresponding horizontal areas.
    area : ndarray of float64, shape (k,)
        The area of each polygon that both surfaces cover.
    region_area : ndarray of float64, shape (k,)
        The area of each polygon; 0 for features without a geometry or without an area.
    rings : tuple
        The rings of each polygon, in the reference system of the surface.
    units : str, optional
        The unit of heights. Volumes are in this unit times the unit of x and y squared.
    crs : str, optional
        Coordinate reference system.

    Notes
    -----
    The columns of `to_geopandas` are those of `to_pandas` and the geometry, the polygon.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> ground = TIN.from_points([(0, 0, 2), (4, 0, 2), (4, 4, 2), (0, 4, 2)])
    >>> plots = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(3, 3), (5, 3), (5, 5), (3, 5)]]
    >>> found = ground.volumes_to(1.0, plots)
    >>> found
    <Volumes of 2 regions: cut 5, fill 0, net -5, area 5; 1 not covered entirely>
    >>> found.cut.tolist(), found.coverage.tolist()
    ([4.0, 1.0], [1.0, 0.25])
    """

    cut: Floats
    fill: Floats
    cut_area: Floats
    fill_area: Floats
    area: Floats
    region_area: Floats
    rings: tuple[tuple[Ring, ...], ...]
    units: str | None = None
    crs: str | None = None

    _ELEMENTS: ClassVar[str] = "regions"

    def __len__(self) -> int:
        return len(self.cut)

    def __repr__(self) -> str:
        sums = {name: float(getattr(self, name).sum()) for name in _COLUMNS[:4]}
        text = ", ".join(f"{name} {number:.6g}" for name, number in sums.items())
        partial = int(self.partial.sum())
        beside = f"; {partial} not covered entirely" if partial else ""
        return f"<Volumes of {counted(len(self), 'region')}: {text}{beside}>"

    @property
    def volume_units(self) -> str | None:
        """The unit of volumes, such as m3, or "ft m2" for heights in feet; None if unknown."""
        return volume_units(self.crs, self.units)

    @property
    def area_units(self) -> str | None:
        """The unit of areas, such as m2; None if the reference system is unknown."""
        return area_units(self.crs)

    @property
    def net(self) -> Floats:
        """Fill minus cut of each polygon: the volume to bring in or, if negative, to take away."""
        return sealed(self.fill - self.cut)

    @property
    def coverage(self) -> Floats:
        """The share of the area of each polygon that both surfaces cover, from 0 to 1, (k,).

        NaN for features without an area.
        """
        with np.errstate(invalid="ignore", divide="ignore"):
            share = self.area / self.region_area
        return sealed(np.minimum(share, 1.0))

    @property
    def partial(self) -> Bools:
        """Which polygons are not entirely covered, up to a billionth of their area, (k,)."""
        return sealed(~(self.coverage >= 1 - _WHOLE))

    def to_pandas(self, data: Any = None) -> Any:
        """Return a table without geometries, such as for a spreadsheet (extra ``geo``).

        Parameters
        ----------
        data : DataFrame or mapping, optional
            Columns to include, such as the names of the polygons, with one row for each.

        Returns
        -------
        pandas.DataFrame
            One row for each polygon: ``cut``, ``fill``, ``net``, ``area``, ``coverage``,
            ``cut_area``, ``fill_area``, ``region_area``, and the columns of `data`.

        Raises
        ------
        MissingExtraError
            geopandas or shapely is not installed.
        InputError
            `data` does not have one row for each polygon, or has a column with one of these names.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 2), (4, 0, 2), (4, 4, 2), (0, 4, 2)])
        >>> plots = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(3, 3), (5, 3), (5, 5), (3, 5)]]
        >>> table = ground.volumes_to(1.0, plots).to_pandas({"name": ["pit", "heap"]})
        >>> table[["name", "cut", "coverage"]].values.tolist()
        [['pit', 4.0, 1.0], ['heap', 1.0, 0.25]]
        """
        from delone.exchange.geopandas import columns_beside

        return columns_beside(self._fields(), data, of="regions")

    def _geometries(self) -> NDArray[Any]:
        shapes = np.empty(len(self), dtype=object)
        for row, rings in enumerate(self.rings):
            shapes[row] = _geometry(rings)
        return shapes

    def _fields(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in _COLUMNS}


def _geometry(rings: tuple[Ring, ...]) -> Any:
    """Return the geometry of the rings of one feature; None without rings."""
    shapely = require("shapely", extra="geo", what="geometries")
    several: dict[int | None, list[NDArray[Any]]] = {}
    for ring in rings:
        several.setdefault(ring.polygon, []).append(ring.points[:, :2])
    # Rings that belong to no polygon follow the even-odd rule.
    loose = [shapely.Polygon(ring) for ring in several.pop(LOOSE, [])]
    made = [shapely.Polygon(outer, inner) for outer, *inner in several.values()]
    made += [reduce(shapely.symmetric_difference, loose)] if loose else []
    return None if not made else made[0] if len(made) == 1 else shapely.MultiPolygon(made)


def volumes(tin: Surface, other: Any, regions: Any) -> Volumes:
    """Return the volumes between a surface and `other` in each feature of a layer."""
    surface, plane = goal_of(tin, other)
    features = rings_by_feature(regions, name="regions", crs=tin.crs)
    parts = [_Parts(tin._sheet())] + ([] if surface is None else [_Parts(surface)])
    found = np.zeros((len(features), 6))
    for row, rings in enumerate(features):
        region = _region(rings)
        if region is None:
            continue
        found[row, 5] = total(np.abs(sizes(region.points, region.simplices)))
        low, high = region.points.min(axis=0), region.points.max(axis=0)
        some = [part.within(low, high) for part in parts]
        if all(len(each.simplices) for each in some):
            beside = None if surface is None else some[1]
            sums = _core.volumes2(some[0], beside, plane, region, as_workers(tin.workers))
            found[row, :5] = [total(column) for column in sums]
    _warn(np.flatnonzero(found[:, 4] == 0))
    cut, fill, cut_area, fill_area, area, whole = found.T.copy()
    refuse_overflow(cut, fill)
    return Volumes(
        cut=cut,
        fill=fill,
        cut_area=cut_area,
        fill_area=fill_area,
        area=area,
        region_area=whole,
        rings=tuple(map(tuple, features)),
        units=tin.units,
        crs=tin.crs,
    )


def _region(rings: list[Ring]) -> Region | None:
    """Return the triangles inside rings; None if there are none."""
    try:
        region = region_of(rings) if rings else None
    except DegenerateInputError:  # all corners are on one line
        return None
    return region if region is not None and len(region.simplices) else None


def _warn(without: Rows) -> None:
    if not len(without):
        return
    shown = ", ".join(map(str, without[:_NAMED].tolist()))
    more = ", ..." if len(without) > _NAMED else ""
    verb = agreed(len(without), "has", "have")
    warnings.warn(
        f"{counted(len(without), 'region')} {verb} no area in common with both surfaces, and a "
        f"volume of 0: {agreed(len(without), 'row', 'rows')} {shown}{more}",
        UserWarning,
        stacklevel=caller_level(),
    )


class _Parts:
    """A surface from which parts are selected."""

    def __init__(self, sheet: Sheet) -> None:
        self._sheet = sheet
        axes = [np.ascontiguousarray(column)[sheet.simplices] for column in sheet.points.T]
        self._low = [axis.min(axis=1) for axis in axes]
        self._high = [axis.max(axis=1) for axis in axes]
        self._number = np.full(len(sheet.simplices) + 1, -1, dtype=np.int32)

    def within(self, low: Floats, high: Floats) -> Sheet:
        """Return the triangles whose boxes meet a box, in the order of the surface."""
        meeting = np.ones(len(self._sheet.simplices), dtype=bool)
        for axis in range(2):
            meeting &= self._low[axis] <= high[axis]
            meeting &= self._high[axis] >= low[axis]
        if meeting.all():
            return self._sheet
        rows = np.flatnonzero(meeting)
        vertices, simplices = np.unique(self._sheet.simplices[rows], return_inverse=True)
        self._number[rows] = np.arange(len(rows), dtype=np.int32)
        neighbors = self._number[self._sheet.neighbors[rows]]
        self._number[rows] = -1
        return Region(
            np.ascontiguousarray(self._sheet.points[vertices]),
            simplices.reshape(-1, 3).astype(np.int32),
            neighbors,
            self._sheet.heights[vertices],
        )
