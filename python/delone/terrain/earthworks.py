"""Designs: a surface with level or sloping pads, embankments and cuttings."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self, cast

from delone._tiling.triangulation import HullTiling
from delone.terrain import reshaping

if TYPE_CHECKING:
    from delone.terrain.building import Built
    from delone.terrain.surface import Surface

__all__ = ["Earthworks"]


class Earthworks(HullTiling):
    """The ways to reshape a surface with heights."""

    __slots__ = ()

    @classmethod
    def _built(cls, made: Built, workers: int | None) -> Self:
        """Return a surface of these arrays."""
        raise NotImplementedError

    def flatten(self, polygon: Any, z: Any) -> Self:
        """Return a surface that is a plane inside a polygon.

        Parameters
        ----------
        polygon : array_like, shape (k, 2), list of rings, or shapely polygons
            Where the plane is. Each polygon has its own holes, and several polygons are a union;
            rings given as arrays follow the even-odd rule. Their heights are not used.
        z : float or triple of float
            The height, or a plane (a, b, c) with the heights c + a x + b y.

        Returns
        -------
        TIN
            The new surface, with the edges of the polygon as hard breaklines. Cut and fill are
            those of ``self.volume_to(new)``.

        Raises
        ------
        OutsideError
            The polygon extends beyond the surface; ``error.place`` is such a point.
        CrossingSegmentsError
            Rings of one polygon cross.
        NonFiniteError, InputError, DegenerateInputError
            A coordinate or height is NaN, infinite or beyond 1e100, or the polygon has no area.
        BudgetExceededError, MemoryError
            Edges cross at more than 4,000,000 places, or memory does not suffice.

        See Also
        --------
        embank : The same with side slopes.

        Notes
        -----
        A TIN has no vertical walls, so the step at the border is inclined. Vertices inside and on
        the polygon are removed, all others keep their heights, and new triangles connect them to
        the polygon. The new triangles lie inside the triangles that the polygon meets; all other
        triangles remain. Breaklines end at the polygon. The closer vertices are to the border, the
        steeper the step; for a defined slope, use `embank`.

        Time is roughly proportional to the number of triangles near the polygon, times its edges.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 1), (9, 0, 1), (9, 9, 1), (0, 9, 1)])
        >>> pond = ground.flatten([(3, 3), (6, 3), (6, 6), (3, 6)], 0.0)
        >>> pond.heights([(4, 4), (3, 5), (9, 9)])
        array([0., 0., 1.])
        """
        return self._built(reshaping.flattened(cast("Surface", self), polygon, z), self.workers)

    def embank(
        self,
        polygon: Any,
        z: Any,
        *,
        slope: float | None = None,
        cut: float | None = None,
        fill: float | None = None,
        corners: str = "round",
    ) -> Self:
        """Return a surface with a pad, and side slopes from its edge to the ground.

        Parameters
        ----------
        polygon : array_like, shape (k, 2), list of rings, or shapely polygons
            The pad, as for `flatten`. Its heights are not used.
        z : float or triple of float
            The height of the pad, or its plane (a, b, c) with the heights c + a x + b y.
        slope : float, optional
            Slope of cut and fill: the rise per unit of distance, such as 0.5 for 1 : 2.
        cut, fill : float, optional
            Slopes where the ground is above the pad, and where it is below; by default `slope`.
        corners : {"round", "miter"}, optional
            The shape around convex corners: a cone, made of planes with exactly that slope whose
            directions differ by at most 15 degrees; or the planes of both edges up to their
            intersection, with additional planes only where edges turn by more than 120 degrees. At
            reflex corners, slopes always meet in a valley (or ridge).

        Returns
        -------
        TIN
            The new surface. Its edges at the pad, where slopes meet, and where slopes meet the
            ground (the daylight line) are hard breaklines; the edges where triangles of the ground
            are cut are soft ones. Cut and fill are those of ``self.volume_to(new)``.

        Raises
        ------
        OutsideError
            The pad extends beyond the surface, or a side slope reaches the end of the surface
            without meeting the ground; ``error.place`` is such a point.
        CrossingSegmentsError
            Rings of one polygon cross.
        NonFiniteError, InputError, DegenerateInputError
            A coordinate or height is NaN, infinite or beyond 1e100, the polygon has no area, a
            slope is missing or not from 1e-6 to 1e6, or the pad itself is at least that steep.
        BudgetExceededError, MemoryError
            Edges cross at more than 4,000,000 places, or memory does not suffice.

        See Also
        --------
        flatten : The same without side slopes.

        Notes
        -----
        Where the ground at the edge of the pad is lower, a slope runs down until it meets the
        ground (fill); where it is higher, a slope runs up (cut). Where slopes of several edges
        overlap, the highest one counts in fill and the lowest one in cut. Ground that the slopes do
        not reach is unchanged, even where a slope, if extended, would pass above it. A hill in the
        way of a slope stays, and the slope continues behind it if it is connected around the hill.
        Where an edge of the pad is on the outline of the surface, there is no slope; a slope may
        run along the outline, but not across it.

        Up to rounding, the surface consists of the planes and the old triangles, and all triangles
        of the ground that the design does not touch remain. Differences in height that rounding can
        cause are ignored here; they may count in the areas of `volume_to`.

        Time is roughly proportional to the number of triangles near the pad, times its edges.

        Examples
        --------
        >>> from delone.terrain import TIN
        >>> ground = TIN.from_points([(0, 0, 0), (90, 0, 0), (90, 90, 0), (0, 90, 0)])
        >>> pad = [(30, 30), (60, 30), (60, 60), (30, 60)]
        >>> design = ground.embank(pad, 3.0, slope=0.5, corners="miter")
        >>> design.heights([(45, 45), (45, 28), (45, 10)]).tolist()
        [3.0, 2.0, 0.0]
        >>> ground.volume_to(design)
        <Volume: cut 0, fill 3924, net 3924, area 8100>
        """
        made = reshaping.embanked(cast("Surface", self), polygon, z, slope, cut, fill, corners)
        return self._built(made, self.workers)
