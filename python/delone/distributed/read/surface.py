"""A tiled triangulation as a surface that need not fit into memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.distributed.read import contours, simplifying, volumes
from delone.distributed.read.folder import TileFolder
from delone.terrain.contouring import MOST, Finish
from delone.terrain.profiles import warn_of_no_points

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from delone.terrain import TIN, Contours, Profile, Volume

__all__ = ["TiledSurface"]


class TiledSurface(TileFolder):
    """What a `TiledDelaunay` with heights has in common with a `delone.terrain.TIN`.

    Where points coincide, the height is that of the first one.
    """

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
        max_points: int = MOST,
        values: str = "z",
        executor: Any = "serial",
    ) -> Contours:
        """Compute the same contour lines as a `delone.terrain.TIN` of all points.

        Parameters
        ----------
        levels, interval, base, index, smooth, min_length, min_area, simplify, max_points
            As for `delone.terrain.TIN.contours`.
        values : str, optional
            The name of the attribute; by default heights.
        executor : {"serial"} or dask.distributed.Client, optional
            Where lines are drawn: in this process, or on a Dask cluster whose machines can access
            the folder.

        Returns
        -------
        Contours
            Lines that are closed or end at the hull, with higher ground to their left.

        Raises
        ------
        InputError
            There is no such attribute; `executor` is neither; otherwise as for
            `delone.terrain.TIN.contours`.
        BudgetExceededError
            There would be more than `max_points` points; raised before they are computed.

        Notes
        -----
        The lines must fit into memory. In addition, memory is needed for one tile and for the
        triangles that a group of levels crosses, about a quarter of a gigabyte, or more if one
        level crosses more than a million triangles. Triangles and lines of each group are kept in
        temporary files until all lines are drawn.

        Where rounded lines would cross, their points are merged, and which one of several points
        remains depends on the order of the triangles. So if levels are so close that lines are only
        a few units in the last place apart, coordinates may differ from those of a TIN by the
        distance that points are moved there: up to 2,250 such units in tests.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points.sum(axis=1)))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     tin.contours(interval=10)
        <Contours of 4 levels: 3 lines>
        """
        finish = Finish.of(smooth, min_length, min_area, simplify)
        given = levels, interval, base, index
        return contours.contours(self, given, finish, max_points, values, executor)

    def contour_parts(
        self,
        levels: ArrayLike | None = None,
        *,
        interval: float | None = None,
        base: float = 0.0,
        index: int = 5,
        min_length: float = 0.0,
        min_area: float = 0.0,
        max_points: int = MOST,
        values: str = "z",
        executor: Any = "serial",
    ) -> Iterator[Contours]:
        """Yield contour lines that need not all fit into memory, a few levels at a time.

        Parameters
        ----------
        levels, interval, base, index, min_length, min_area, max_points, values, executor
            As for `contours`.

        Yields
        ------
        Contours
            The lines of some levels, in the order of the levels; the `levels` of each contain all
            levels.

        Raises
        ------
        InputError, BudgetExceededError
            As for `contours`.

        See Also
        --------
        contours : All lines together, optionally smoothed and simplified, which needs all levels.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points.sum(axis=1)))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     sum(len(part) for part in tin.contour_parts(interval=10))
        3
        """
        finish = Finish.of(0, min_length, min_area, 0.0)
        given = levels, interval, base, index
        return contours.parts(self, given, finish, max_points, values, executor)

    def profile(self, line: Any, *, values: str = "z") -> Profile:
        """Compute the heights along a line, reading only the tiles along it.

        Parameters
        ----------
        line : array_like, shape (k, 2), or geometry
            As for `delone.terrain.TIN.profile`.
        values : str, optional
            The name of the attribute; by default heights.

        Returns
        -------
        Profile
            Heights at the ends of the line and wherever it crosses an edge.

        Raises
        ------
        InputError
            There is no such attribute, or `line` is not one line.

        Warns
        -----
        UserWarning
            The line is outside the surface, so the profile has no points.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points.sum(axis=1)))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     tin.profile([(0, 0.5), (19, 0.5)]).z[[0, -1]].tolist()
        [0.5, 19.5]
        """
        return warn_of_no_points(volumes.profile(self, line, values))

    def volume_to(
        self,
        other: Any,
        *,
        region: Any = None,
        values: str = "z",
        executor: Any = "serial",
    ) -> Volume:
        """Compute the volumes to cut and to fill, tile by tile.

        Parameters
        ----------
        other : TiledDelaunay, TIN, float, or (a, b, c)
            The surface to reach: other tiles, a surface in memory, a height, or the plane
            z = a x + b y + c.
        region : optional
            Polygons or rings to which the volume is limited, as for `delone.terrain.TIN.volume_to`.
        values : str, optional
            The name of the attribute; by default heights. For `other`, heights are always used.
        executor : {"serial"} or dask.distributed.Client, optional
            As for `contours`.

        Returns
        -------
        Volume
            Volumes and areas, whose sums are rounded once. `of_triangles` has a row for each tile.

        Raises
        ------
        InputError
            There is no such attribute, the reference systems differ, or `executor` is neither.
        LimitError
            Areas exceed the largest double, or both volumes do.

        Warns
        -----
        UserWarning
            The surfaces, or surface and region, have no area in common.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(400)
        >>> slope = np.column_stack((points, points[:, 0]))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(slope, folder + "/tin", tile_points=100)
        ...     tin.volume_to(0)
        <Volume: cut 3429.5, fill 0, net -3429.5, area 361>
        """
        return volumes.volume(self, other, region, values, executor)

    def simplify(
        self,
        *,
        max_error: float | None = None,
        max_triangles: int | None = None,
        keep: str = "breaklines",
        values: str = "z",
        executor: Any = "serial",
    ) -> TIN:
        """Return a surface with fewer points, within an error bound at all points of the tiles.

        Parameters
        ----------
        max_error : float, optional
            The largest vertical distance of a point from the new surface.
        max_triangles : int, optional
            The maximum number of triangles of the surface, instead of an error. The error is then
            chosen from a scale with eight steps for each factor of two, ``2 ** (k / 8)``, so that
            the surface would have more triangles with the next smaller error of the scale.
        keep : {"breaklines", "hard", "boundary"}, optional
            As for `delone.terrain.TIN.simplify`. Tiles have no breaklines, so all choices give the
            same surface.
        values : str, optional
            The name of the attribute; by default heights.
        executor : {"serial"} or dask.distributed.Client, optional
            As for `contours`.

        Returns
        -------
        TIN
            The surface, which must fit into memory. Edges along the cuts between tiles are soft
            breaklines.

        Raises
        ------
        InputError
            Not exactly one of `max_error` and `max_triangles` is given, `max_error` is negative or
            not finite, `max_triangles` is below the number of triangles that lines and hull require
            whatever the error, there is no such attribute, one of its values is NaN or infinite, or
            `keep` or `executor` is not one of its choices.

        See Also
        --------
        delone.terrain.TIN.simplify : The same for a surface in memory, without cuts.

        Notes
        -----
        Along the cuts between tiles, the profile of the surface is simplified first, to half of the
        error. The tiles on both sides of a cut get the same line, so there are no cracks. Then each
        tile is simplified as by `delone.terrain.TIN.simplify`, and the lines around it remain
        edges. The bound holds exactly at all points, including those on cuts; where points
        coincide, at the first of them. Where a cut crosses an edge of the surface, its line may
        have a point that is not a point of the survey; the height of such a point is rounded.

        For `max_triangles`, tiles are simplified several times to find the error, often four to
        eight times. Memory is that of one tile and of the result. Because of the lines, the
        result has more triangles than a surface that is simplified in one piece. It depends on the
        tiles, but not on the executor.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> from delone import datasets, distributed
        >>> points = datasets.grid(2500)
        >>> bowl = np.column_stack((points, ((points - 25) ** 2).sum(axis=1) / 25))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     tin = distributed.triangulate(bowl, folder + "/tin", tile_points=700)
        ...     tin.simplify(max_error=1)
        <TIN of 86 points: 138 triangles, heights 0 to 50>
        """
        goal = max_error, max_triangles
        return simplifying.simplify(self, goal, keep, values, executor)[0]
