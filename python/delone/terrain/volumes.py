"""Volumes between a surface and a plane or another surface."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_number, as_workers
from delone._base.georeference import caller_level, same_crs
from delone._base.immutable import ReadOnly, sealed
from delone._base.units import area_units, require_same_units, volume_units
from delone._tiling.plane.geometry import total
from delone.errors import InputError, LimitError
from delone.terrain.extent import inside_of_rings
from delone.terrain.lines import require_areas, rings_of

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone.terrain.lines import Ring
    from delone.terrain.surface import Sheet, Surface

__all__ = [
    "Region",
    "Volume",
    "goal_of",
    "plane_of",
    "refuse_overflow",
    "region_of",
    "volume",
    "wanted_region",
    "warn_of_nothing",
]


class Region(NamedTuple):
    """The triangles of a region or a part of a surface, in the form that the core needs."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    heights: Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class Volume(ReadOnly):
    """The volume between a surface and the one to reach.

    Parameters
    ----------
    cut, fill : float
        The volumes where the surface is above and below: what has to be removed and added.
    cut_area, fill_area : float
        The corresponding horizontal areas.
    area : float
        The area where both are defined, including where they are equal.
    of_triangles : ndarray of float64, shape (m, 5)
        The same five numbers for each triangle of the surface, for maps; for a surface in tiles,
        (k, 5), for each tile.
    units : str, optional
        The unit of heights. Volumes are in this unit times the unit of x and y squared.
    crs : str, optional
        Coordinate reference system.

    Examples
    --------
    >>> from delone.terrain import TIN
    >>> slope = TIN.from_points([(0, 0, 0), (4, 0, 4), (4, 2, 4), (0, 2, 0)])
    >>> slope.volume_to(2)
    <Volume: cut 4, fill 4, net 0, area 8>
    """

    cut: float
    fill: float
    cut_area: float
    fill_area: float
    area: float
    of_triangles: Floats
    units: str | None = None
    crs: str | None = None

    @property
    def volume_units(self) -> str | None:
        """The unit of volumes, such as m3, or "ft m2" for heights in feet; None if unknown."""
        return volume_units(self.crs, self.units)

    @property
    def area_units(self) -> str | None:
        """The unit of areas, such as m2; None if the reference system is unknown."""
        return area_units(self.crs)

    @property
    def net(self) -> float:
        """Fill minus cut: the volume to bring in or, if negative, to take away."""
        return self.fill - self.cut

    def __repr__(self) -> str:
        numbers = {name: getattr(self, name) for name in ("cut", "fill", "net", "area")}
        return "<Volume: " + ", ".join(f"{name} {n:.6g}" for name, n in numbers.items()) + ">"

    @property
    def mean_height(self) -> Floats:
        """The mean height to add in each triangle, negative for cut, (m,).

        NaN where a triangle has no part in the volume.
        """
        cut, fill, _, _, area = self.of_triangles.T
        with np.errstate(invalid="ignore", divide="ignore"):
            return sealed(np.where(area > 0, (fill - cut) / area, np.nan))


def volume(tin: Surface, other: Any, region: Any) -> Volume:
    """Return the volume between a surface and `other`."""
    surface, plane = goal_of(tin, other)
    found = _core.volumes2(
        tin._sheet(), surface, plane, wanted_region(region, tin.crs), as_workers(tin.workers)
    )
    of_triangles = np.column_stack(found)
    if not of_triangles[:, 4].any():
        warn_of_nothing(region)
    # Correctly rounded sums: independent of the order of the triangles.
    cut, fill, cut_area, fill_area, area = map(total, found)
    refuse_overflow(np.array(cut), np.array(fill))
    return Volume(
        cut=cut,
        fill=fill,
        cut_area=cut_area,
        fill_area=fill_area,
        area=area,
        of_triangles=of_triangles,
        units=tin.units,
        crs=tin.crs,
    )


def warn_of_nothing(region: Any) -> None:
    """Warn that a volume is 0 because nothing overlaps."""
    what = "region" if region is not None else "surface to be reached"
    warnings.warn(
        f"the surface and the {what} have no area in common: the volume is 0",
        UserWarning,
        stacklevel=caller_level(),
    )


def require_same_crs(one: str | None, other: str | None) -> None:
    """Raise an error if two surfaces are known to be in different reference systems."""
    if one and other and not same_crs(one, other):
        raise InputError(f"the surfaces are in {one:.60} and in {other:.60}: transform one of them")


def goal_of(tin: Surface, other: Any) -> tuple[Sheet | None, list[float]]:
    """Return the surface to reach, or None and a plane."""
    if hasattr(tin, "_sheet"):
        _require_area(tin._sheet().points, "this surface")
    if not hasattr(other, "_sheet"):
        return None, plane_of(other)
    require_same_crs(tin.crs, other.crs)
    require_same_units(tin.units, other.units, what="the surfaces")
    sheet: Sheet = other._sheet()
    _require_area(sheet.points, "the surface to reach")
    return sheet, [0.0, 0.0, 0.0]


def _require_area(points: Floats, whose: str) -> None:
    """Reject surfaces whose areas may exceed the largest double: nothing else would be right."""
    with np.errstate(over="ignore"):
        area = (points.max(axis=0) - points.min(axis=0)).prod()
    if not np.isfinite(area):
        raise _too_large(f"areas of {whose} exceed")


def refuse_overflow(cut: Floats, fill: Floats) -> None:
    """Reject volumes that are both beyond doubles: their difference would be NaN."""
    if (np.isinf(cut) & np.isinf(fill)).any():
        raise _too_large("cut and fill exceed")


def _too_large(what: str) -> LimitError:
    return LimitError(f"{what} the largest double: give coordinates in a larger unit")


def plane_of(other: Any) -> list[float]:
    """Return a plane by its slopes and its height at the origin."""
    try:
        numbers = [as_number(each, name="other") for each in other]
    except TypeError:
        numbers = [0.0, 0.0, as_number(other, name="other")]
    if len(numbers) != 3 or not np.isfinite(numbers).all():
        raise InputError(
            f"other must be a TIN, a height, or a plane (a, b, c), finite; got {other!r:.60}"
        )
    return numbers


def wanted_region(region: Any, crs: str | None) -> Region | None:
    """Return the triangles of a region, None for everything."""
    if region is None:
        return None
    require_areas(region, "region")
    rings = rings_of(region, name="region", crs=crs)
    if not rings:
        raise InputError("region has no polygon or ring")
    return region_of(rings)


def region_of(rings: list[Ring]) -> Region:
    """Return the triangles inside polygons."""
    mesh, within = inside_of_rings(rings)
    number = np.append(np.where(within, np.cumsum(within) - 1, -1), -1).astype(np.int32)
    return Region(
        mesh.points,
        mesh.simplices[within],
        number[mesh.neighbors[within]],
        np.zeros(mesh.npoints),
    )
