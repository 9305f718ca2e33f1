"""The class Overlaps: the areas that cells of two grids on the sphere share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._arrays import as_choice, as_workers
from delone.complex import Stored
from delone.counting import counted
from delone.errors import DtypeError
from delone.immutable import ReadOnly, kept, sealed
from delone.sphere.grid import Grid
from delone.sphere.paired import Paired, row_sums
from delone.sphere.weights import METHODS, Weights, as_mask

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._types import Floats, Rows

__all__ = ["OverlapReport", "Overlaps"]

# Shares that differ from 0 or 1 by less are roundings of corners.
_ROUNDING = 1e-9
# Names of arrays in files.
_ROWS = "indptr", "indices", "areas"
_SUMS = "source_areas", "target_areas", "source_sums", "target_sums"
_SHAPES = "source_shape", "target_shape"


@dataclass(frozen=True, repr=False, eq=False)
class OverlapReport(ReadOnly):
    """Which cells are covered by the other grid, within 1e-9 of their area.

    Attributes
    ----------
    npairs : int
        Number of pairs of cells that share area.
    source_outside, target_outside : ndarray of int64
        Cells that share nothing, without empty ones.
    source_partly, target_partly : ndarray of int64
        Cells of which a part is not covered.
    source_repeatedly, target_repeatedly : ndarray of int64
        Cells that are covered more than once, as cells of the other grid overlap.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> north = sphere.Grid.from_lonlat(np.arange(0, 361, 10), [-5, 30, 60, 90])
    >>> sphere.Overlaps(north, sphere.Grid.from_healpix(4)).report
    <OverlapReport: 500 pairs, 72 target cells outside, 32 target cells partly covered>
    """

    npairs: int
    source_outside: Rows
    source_partly: Rows
    source_repeatedly: Rows
    target_outside: Rows
    target_partly: Rows
    target_repeatedly: Rows

    def __repr__(self) -> str:
        parts = [counted(self.npairs, "pair")]
        ends = {
            "outside": "outside",
            "partly": "partly covered",
            "repeatedly": "covered repeatedly",
        }
        for side in ("source", "target"):
            for name, end in ends.items():
                if count := len(getattr(self, f"{side}_{name}")):
                    parts.append(f"{counted(count, f'{side} cell')} {end}")
        return f"<OverlapReport: {', '.join(parts)}>"


class Overlaps(Paired, Stored):
    """The areas that cells of two grids share: the basis of conservative regridding.

    Parameters
    ----------
    source, target : Grid
        Where fields are, and where they are wanted.
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
    Which cells share area is decided by exact signs, with infinitesimal moves in place of ties, so
    that common corners and sides, corners in sides and poles are like any other place. Each area
    is right to a few units in its last place and 1e-30 steradians; smaller parts cannot be told
    from cells that only touch, and are not pairs. So the sums over rows and columns are the areas
    of the cells wherever the other grid covers them. No polygon is clipped: an area is a sum over
    corners and crossings (Franklin, 1990), of which each term is an exact choice.

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

    _grids: tuple[Grid, Grid] | None
    # The sums of the parts of source and target cells.
    _sums: tuple[Floats, Floats]

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

    def _fill(
        self,
        rows: tuple[Rows, NDArray[np.int32], Floats],
        sums: tuple[Floats, Floats, Floats, Floats],
        shapes: tuple[tuple[int, ...], tuple[int, ...]],
        grids: tuple[Grid, Grid] | None,
        workers: int | None,
    ) -> None:
        a, b, c = (sealed(x) for x in rows)
        s, t, u, v = (sealed(x) for x in sums)
        self._hold(
            rows=(a, b, c), areas=(s, t), sums=(u, v), shapes=shapes, grids=grids, workers=workers
        )

    def __reduce__(self) -> tuple[Any, ...]:
        sums = self._areas + self._sums
        return self._again, (self._rows, sums, self._shapes, self._grids, self._workers)

    @classmethod
    def _again(cls, *parts: Any) -> Self:
        made = cls.__new__(cls)
        made._fill(*parts)
        return made

    @classmethod
    def _stored_as(cls) -> str:
        return "sphere.Overlaps"

    def _saved(self) -> dict[str, NDArray[Any]]:
        found: dict[str, NDArray[Any]] = dict(zip(_ROWS, self._rows, strict=True))
        found |= zip(_SUMS, self._areas + self._sums, strict=True)
        for name, shape in zip(_SHAPES, self._shapes, strict=True):
            found[name] = np.array(shape, dtype=np.int64)
        return found

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        a, b, c = (arrays[name] for name in _ROWS)
        s, t, u, v = (arrays[name] for name in _SUMS)
        source, target = (tuple(arrays[name].tolist()) for name in _SHAPES)
        return cls._again((a, b, c), (s, t, u, v), (source, target), None, None)

    def _described(self) -> str:
        cells = f"{len(self.source_areas)} source and {len(self.target_areas)} target cells"
        return f"{cells}: {counted(len(self.areas), 'pair')}"

    @property
    def areas(self) -> Floats:
        """Areas of the shared parts in steradians, (k,)."""
        return self._rows[2]

    @property
    def source(self) -> Grid | None:
        """The source; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[0]

    @property
    def target(self) -> Grid | None:
        """The target; None if this was loaded from a file, which has no grids."""
        return None if self._grids is None else self._grids[1]

    @property
    @kept
    def covered_source(self) -> Floats:
        """The fraction of each source cell that target cells cover; NaN for empty cells."""
        return sealed(_shares(self._sums[0], self._areas[0]))

    @property
    @kept
    def covered_target(self) -> Floats:
        """The fraction of each target cell that source cells cover; NaN for empty cells."""
        return sealed(_shares(self._sums[1], self._areas[1]))

    @property
    @kept
    def report(self) -> OverlapReport:
        """Which cells are covered by the other grid."""
        rows = []
        for share in (self.covered_source, self.covered_target):
            outside = share == 0
            partly = ~outside & (share < 1 - _ROUNDING)
            more = share > 1 + _ROUNDING
            rows += [np.flatnonzero(x) for x in (outside, partly, more)]
        return OverlapReport(len(self.areas), *rows)

    def to_weights(
        self,
        method: str = "conservative",
        *,
        source_mask: ArrayLike | None = None,
        target_mask: ArrayLike | None = None,
    ) -> Weights:
        """Return what each source cell contributes to each target cell.

        Parameters
        ----------
        method : {"conservative", "normalized", "sum", "majority"}, optional
            How values are combined:

            - "conservative": integrals over the target cell, divided by its area ("destarea"). The
              sum of values times areas is that of the source. A cell of which a part is not covered
              has as much less.
            - "normalized": means over the covered part ("fracarea"). A constant remains one.
            - "sum": amounts, such as numbers of inhabitants: each source cell gives its value to
              target cells by the share of its area.
            - "majority": categories: the value that covers most of the target cell.
        source_mask, target_mask : array_like of bool, optional
            True, or 1, for cells that take part, as in files; the shape of fields or of cells. By
            default all do.

        Returns
        -------
        Weights
            They hold no grid. Masked target cells have no entries.

        Raises
        ------
        InputError
            `method` is unknown.
        ShapeError, DtypeError
            A mask has another shape, or is not boolean.

        Notes
        -----
        Fluxes and densities want "conservative", states such as temperatures "normalized".

        Examples
        --------
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
        >>> overlaps.to_weights("normalized", source_mask=[0, 1, 0]).apply([[9, 6, 3]]).tolist()
        [[6.0, nan]]
        """
        kind = as_choice(method, METHODS, name="method")
        sources = as_mask(source_mask, self.source_shape, "source_mask")
        targets = as_mask(target_mask, self.target_shape, "target_mask")
        indptr, indices, areas = self._rows
        of_source, of_target = self._sums
        if sources is not None or targets is not None:
            row = np.repeat(np.arange(len(self.target_areas)), np.diff(indptr))
            kept = np.ones(len(areas), dtype=bool)
            if sources is not None:
                kept &= sources[indices]
            if targets is not None:
                kept &= targets[row]
            indices, areas, row = indices[kept], areas[kept], row[kept]
            counts = np.bincount(row, minlength=len(self.target_areas))
            indptr = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
            of_target = row_sums(indptr, areas)
            of_source = np.bincount(indices, areas, len(self.source_areas)).astype(np.float64)
        lengths = np.diff(indptr)
        if kind == "normalized":
            over = np.repeat(of_target, lengths)
        elif kind == "sum":
            over = self.source_areas[indices]
        else:
            over = np.repeat(self.target_areas, lengths)
        fractions = [
            np.nan_to_num(_shares(sums, whole))
            for sums, whole in ((of_source, self.source_areas), (of_target, self.target_areas))
        ]
        return Weights._of(
            kind,
            (indptr, indices, areas / over),
            (fractions[0], fractions[1]),
            (self.source_areas, self.target_areas),
            self._shapes,
        )


def _shares(sums: Floats, areas: Floats) -> Floats:
    """Return quotients, NaN for cells without area."""
    found = np.full(len(areas), np.nan)
    np.divide(sums, areas, out=found, where=areas > 0)
    return found
