"""What a TIN keeps from its survey: heights, lines, reference system and units; its exports."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from delone._base.immutable import kept, sealed
from delone._tiling.plane.location import stretches
from delone._tiling.triangulation import HullTiling
from delone.terrain.adjustments import Adjustments

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Indices
    from delone._tiling.plane.location import Stretch
    from delone.exchange.parts import Parts

__all__ = ["Surveyed"]


class Surveyed(HullTiling):
    """A triangulation with heights, lines, a reference system and units."""

    __slots__ = ("_adjustments", "_breaklines", "_crs", "_soft", "_units", "_z")
    _SAVES_CRS = True

    _breaklines: Indices
    _adjustments: NDArray[np.str_]
    _crs: NDArray[np.str_]
    _soft: Bools
    _units: NDArray[np.str_]
    _z: Floats

    @property
    def z(self) -> Floats:
        """Heights of the vertices, (n,)."""
        return self._z

    @property
    @kept
    def xyz(self) -> Floats:
        """The vertices with their heights, (n, 3)."""
        return sealed(np.column_stack((self._points, self._z)))

    @property
    def breaklines(self) -> Indices:
        """The edges on lines, (q, 2), as rows of `points`."""
        return self._breaklines

    @property
    def soft(self) -> Bools:
        """Which of these edges are on soft breaklines only, (q,)."""
        return self._soft

    @property
    def crs(self) -> str | None:
        """Coordinate reference system, such as ``"EPSG:28992"`` or WKT; None if it is unknown."""
        return str(self._crs) or None

    @property
    def units(self) -> str | None:
        """The unit of heights, such as ``"m"``, ``"ft"`` or ``"us-ft"``; None if it is unknown."""
        return str(self._units) or None

    @property
    def adjustments(self) -> Adjustments | None:
        """What `snap` and `level` changed in the input; None if neither was given."""
        return Adjustments._of_text(str(self._adjustments)) if str(self._adjustments) else None

    def _stretches(self, a: Floats, b: Floats) -> list[Stretch]:
        """The triangles of the hull along a segment, divided into parts on and off the surface."""
        tiling = (self._points, *self._tiling())
        return stretches(self._whole_locator, tiling, self._number, a, b)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        return Parts(
            self._points,
            self._simplices,
            segments=self._breaklines if len(self._breaklines) else None,
            crs=self.crs,
        )

    def _raised_parts(self) -> Parts:
        return self._parts()._replace(points=self.xyz)
