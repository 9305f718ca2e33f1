"""The class Overlaps: the areas that cells of two grids on the sphere share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from delone._base.arrays import as_choice, as_flag, as_workers
from delone._tiling.complex import Stored
from delone.areal.shared import OverlapReport, SharedAreas
from delone.areal.weights import as_mask
from delone.errors import InputError
from delone.sphere.grid import Grid
from delone.sphere.grid_cells import require_grid
from delone.sphere.large import overlaps_of
from delone.sphere.weights import Weights

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


__all__ = ["OverlapReport", "Overlaps"]


class Overlaps(SharedAreas[Weights], Stored):
    """The areas that cells of two grids share: the basis of conservative regridding.

    Parameters
    ----------
    source, target : Grid
        The grids of the given fields and of the results.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    indptr : ndarray of int64, shape (ntarget + 1,)
        Where the entries of each target cell start, and their number: compressed rows (CSR).
    indices : ndarray of int32, shape (k,)
        Source cells, ascending in each row.
    areas : ndarray of float64, shape (k,)
        Areas of the shared parts in steradians.
    source_areas, target_areas : ndarray of float64
        Areas of the cells.
    source_shape, target_shape : tuple of int
        Shapes of fields on the grids.

    Raises
    ------
    DtypeError
        An argument is not a `Grid`.
    MemoryError
        There is not enough memory for the result.

    Notes
    -----
    Exact signs decide which cells share area. Infinitesimal moves break ties, so common corners and
    sides, corners on sides, and poles need no special treatment. Each area is accurate to a few
    units in its last place and 1e-30 steradians; smaller parts cannot be distinguished from cells
    that only touch, and are not pairs. So the sums over rows and columns are the areas of the cells
    wherever the other grid covers them. No polygon is clipped: an area is a sum over corners and
    crossings (Franklin, 1990), whose terms are selected exactly.

    A part between a parallel and its chord is integrated with an error of 1e-16 of the cube of its
    width in radians.

    See Also
    --------
    Grid : The cells.

    References
    ----------
    W. R. Franklin, "Calculating map overlay polygons' areas without explicitly calculating the
    polygons - implementation", 4th International Symposium on Spatial Data Handling (1990).

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> source = sphere.Grid.from_healpix(16)
    >>> target = sphere.Grid.from_lonlat(np.arange(0, 361, 5), np.arange(-90, 91, 5))
    >>> overlaps = sphere.Overlaps(source, target)
    >>> overlaps
    <Overlaps of 3072 source and 2592 target cells: 12752 pairs>
    >>> bool(np.allclose(overlaps.covered_target, 1, rtol=0, atol=1e-14))
    True
    """

    __slots__ = ("_areas", "_grids", "_rows", "_shapes", "_sums")

    _weights = Weights
    _grids: tuple[Grid, Grid] | None

    def __init__(self, source: Grid, target: Grid, *, workers: int | None = None) -> None:
        for name, grid in (("source", source), ("target", target)):
            require_grid(grid, name)
        found = overlaps_of(target._made, source._made, as_workers(workers))
        self._fill(
            (found.indptr, found.indices, found.areas),
            (source.areas, target.areas, found.second, found.first),
            (source.grid_shape, target.grid_shape),
            (source, target),
            workers,
        )

    def _fill(self, *parts: Any) -> None:
        rows, sums, shapes, grids, workers = parts
        self._hold_areas(rows, sums, shapes=shapes, grids=grids, workers=workers)

    def __reduce__(self) -> tuple[Any, ...]:
        sums = self._areas + self._sums
        return self._again, (self._rows, sums, self._shapes, self._grids, self._workers)

    @classmethod
    def _stored_as(cls) -> str:
        return "sphere.Overlaps"

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._arrays()

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        return cls._again(*cls._parts(arrays), None, None)

    def to_weights(
        self,
        method: str = "conservative",
        *,
        source_mask: ArrayLike | None = None,
        target_mask: ArrayLike | None = None,
        order: int = 1,
        limiter: bool = False,
    ) -> Weights:
        """Return the contribution of each source cell to each target cell.

        Parameters
        ----------
        method : {"conservative", "normalized", "sum", "majority"}, optional
            How values are combined:

            - "conservative": integrals over the target cell, divided by its area ("destarea" in map
              files). This preserves the sum of values times areas. A partly covered cell gets
              proportionally less.
            - "normalized": means over the covered part ("fracarea"). A constant stays constant.
            - "sum": amounts, such as numbers of inhabitants: each source cell divides its value
              among target cells in proportion to shared area.
            - "majority": categories: the value that covers most of the target cell.
        source_mask, target_mask : array_like of bool, optional
            True, or 1, for the cells to use, as in files; in the shape of fields or of cells. By
            default all.
        order : {1, 2}, optional
            1 treats source cells as constant. 2 gives them slopes, for "conservative" and
            "normalized": errors for smooth fields decrease with the square of the cell size.
        limiter : bool, optional
            For ``order=2``, whether slopes are limited so that results are within the range of the
            source cells and their neighbors. By default results can exceed it a little near jumps.

        Returns
        -------
        Weights
            The weights, without the cells. Masked target cells have no entries.

        Raises
        ------
        InputError
            `method` or `order` is unknown; ``order=2`` is used with a different method, with areas
            loaded from a file, or with a single source cell; or `limiter` with ``order=1``.
        ShapeError, DtypeError
            A mask has a different shape, or is not boolean.

        Notes
        -----
        Use "conservative" for fluxes and densities, and "normalized" for states such as
        temperatures.

        With ``order=2``, a source cell has the slope that fits its neighbors in the Delaunay
        triangulation of the centroids of the source cells, by least squares. Target cells get the
        mean of that plane over the part that they share. Slopes cancel over a source cell, so the
        sum of values times areas is preserved as with ``order=1``, even with the limiter. A partly
        covered source cell contributes the integral of its plane over the covered part. Masked or
        missing neighbors do not contribute to slopes. Computing the moments of the parts takes
        about 30 microseconds per pair.

        Examples
        --------
        >>> import numpy as np
        >>> from delone import sphere
        >>> source = sphere.Grid.from_lonlat([0, 1, 2, 3], [0, 1])
        >>> target = sphere.Grid.from_lonlat([0, 2, 4], [0, 1])
        >>> overlaps = sphere.Overlaps(source, target)
        >>> for method in ("conservative", "normalized", "sum", "majority"):
        ...     weights = overlaps.to_weights(method)
        ...     print(method, weights.apply([[6.0, 6.0, 3.0]]).round(9).tolist())
        conservative [[6.0, 1.5]]
        normalized [[6.0, 3.0]]
        sum [[12.0, 3.0]]
        majority [[6.0, 3.0]]

        Second order:

        >>> coarse = sphere.Grid.from_healpix(8)
        >>> fine = sphere.Grid.from_lonlat(np.arange(0, 361, 5), np.arange(-90, 91, 5))
        >>> overlaps = sphere.Overlaps(coarse, fine)
        >>> field = np.sin(np.radians(coarse.centers_lonlat[:, 1]))
        >>> wanted = np.sin(np.radians(fine.centers_lonlat[:, 1])).reshape(36, 72)
        >>> for order in (1, 2):
        ...     found = overlaps.to_weights(order=order).apply(field)
        ...     print(order, bool(abs(found - wanted).max() < 0.01))
        1 False
        2 True
        """
        degree = as_choice(str(order), ("1", "2"), name="order")
        limited = as_flag(limiter, name="limiter")
        first = super().to_weights(method, source_mask=source_mask, target_mask=target_mask)
        if degree == "1":
            if limited:
                raise InputError("limiter is for order=2: with order=1 there are no slopes")
            return first
        if method not in {"conservative", "normalized"}:
            raise InputError(f"order=2 is for conservative and normalized, got {method!r:.60}")
        if self._grids is None:
            raise InputError("order=2 needs the grids, which files do not have: make new Overlaps")
        from delone.sphere.second_order import second_order

        used = as_mask(source_mask, self.source_shape, "source_mask")
        return second_order(first, self._grids, used, limited=limited, workers=self._workers)

    @property
    def source(self) -> Grid | None:
        """The source; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[0]

    @property
    def target(self) -> Grid | None:
        """The target; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[1]
