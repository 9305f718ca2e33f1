"""Levels of detail: a surface with fewer points, up to an error."""

from __future__ import annotations

from typing import TYPE_CHECKING, Self, cast

from delone._tiling.triangulation import HullTiling
from delone.terrain import simplifying

if TYPE_CHECKING:
    from delone.terrain.building import Built
    from delone.terrain.surface import Surface

__all__ = ["Detailed"]


class Detailed(HullTiling):
    """The ways to leave out points of a surface."""

    __slots__ = ()

    @classmethod
    def _built(cls, made: Built, workers: int | None) -> Self:
        """Return a surface of these arrays."""
        raise NotImplementedError

    def simplify(
        self,
        *,
        max_error: float | None = None,
        max_triangles: int | None = None,
        keep: str = "breaklines",
    ) -> Self:
        """Return a surface with fewer points, within an error bound at all points of this one.

        Parameters
        ----------
        max_error : float, optional
            The largest vertical distance of a point of this surface from the new one.
        max_triangles : int, optional
            Instead, the maximum number of triangles: the level with the smallest error is returned.
        keep : {"breaklines", "hard", "boundary"}, optional
            The edges that are kept: those on all lines, on hard breaklines and the outline, or on
            the outline alone. Where the outline is the convex hull, only its corners are kept.

        Returns
        -------
        TIN
            The surface: some of the points, with their heights, and the edges that are kept.

        Raises
        ------
        InputError
            Not exactly one of `max_error` and `max_triangles` is given, it is out of range, or the
            edges that are kept require more than `max_triangles`.
        MemoryError
            There is not enough memory.

        See Also
        --------
        simplification : All levels of detail at once.

        Notes
        -----
        Greedy insertion [1]_: starting with the edges that are kept, the point farthest from the
        surface is inserted until none is too far from it. The bound holds exactly for the given
        numbers, at all points, including those on removed edges; it is proven as points are
        inserted, and again by `Simplification.validate`. Between points, the distance from this
        surface may be larger.

        Triangles are constrained Delaunay. The result does not depend on the order of points. About
        O(n log n) for n points of terrain.

        References
        ----------
        .. [1] M. Garland and P. S. Heckbert, "Fast polygonal approximation of terrains and height
           fields", Carnegie Mellon University, CMU-CS-95-181, 1995.

        Examples
        --------
        >>> import numpy as np
        >>> from delone.terrain import TIN
        >>> x, y = np.meshgrid(np.arange(33.0), np.arange(33.0))
        >>> hill = np.column_stack((x.ravel(), y.ravel(), 20 - np.hypot(x - 16, y - 16).ravel()))
        >>> tin = TIN.from_points(hill)
        >>> tin.simplify(max_error=0.5)
        <TIN of 34 points: 50 triangles, heights -2.62742 to 20>
        """
        found = self.simplification(max_error=max_error, max_triangles=max_triangles, keep=keep)
        surface: Self = found.surface(max_error=max_error, max_triangles=max_triangles)
        return surface

    def simplification(
        self,
        *,
        max_error: float | None = None,
        max_triangles: int | None = None,
        keep: str = "breaklines",
    ) -> simplifying.Simplification:
        """Compute all levels of detail, from the coarsest one to an error or a number of triangles.

        Parameters
        ----------
        max_error, max_triangles, keep
            As for `simplify`; levels end there.

        Returns
        -------
        Simplification
            The order in which points are inserted, and the error of each level.

        Raises
        ------
        InputError, MemoryError
            As for `simplify`.

        Examples
        --------
        See `Simplification`.
        """
        ground = simplifying.ground_of(cast("Surface", self), keep)
        return simplifying.simplified(ground, self._built, max_error, max_triangles)
