"""The class Overlaps: the areas that cells of two grids on the sphere share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Self

from delone._arrays import as_workers
from delone.areal.shared import OverlapReport, SharedAreas
from delone.complex import Stored
from delone.errors import DtypeError
from delone.sphere.grid import Grid
from delone.sphere.weights import Weights

if TYPE_CHECKING:
    from numpy.typing import NDArray


__all__ = ["OverlapReport", "Overlaps"]


class Overlaps(SharedAreas[Weights], Stored):
    """The areas that cells of two grids share: the basis of conservative regridding.

    Parameters
    ----------
    source, target : Grid
        The grids of the given and of the wanted fields.
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
        The system refuses the memory of the result.

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
    W. R. Franklin, "Calculating map overlay polygon' areas without explicitly calculating the
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
            if not isinstance(grid, Grid):
                raise DtypeError(f"{name} must be a sphere.Grid, got {type(grid).__name__}")
        found = target._made.overlaps(source._made, as_workers(workers))
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

    @property
    def source(self) -> Grid | None:
        """The source; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[0]

    @property
    def target(self) -> Grid | None:
        """The target; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[1]
