"""The base of Overlaps on the sphere and in the plane: areas that cells of two grids share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, Self, TypeVar

import numpy as np

from delone._base.arrays import as_choice
from delone._base.counting import counted
from delone._base.immutable import ReadOnly, kept, sealed
from delone.areal.paired import Paired, row_sums
from delone.areal.weights import METHODS, AreaWeights, as_mask

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Rows

__all__ = ["OverlapReport", "SharedAreas"]

# Fractions that differ from 0 or 1 by less come from rounded corners.
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
        Cells that share nothing, except empty ones.
    source_partly, target_partly : ndarray of int64
        Cells of which a part is not covered.
    source_repeatedly, target_repeatedly : ndarray of int64
        Cells that are covered more than once, because cells of the other grid overlap.
    source_empty, target_empty : ndarray of int64
        Cells without area, which share nothing.

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
    source_empty: Rows
    target_outside: Rows
    target_partly: Rows
    target_repeatedly: Rows
    target_empty: Rows

    def __repr__(self) -> str:
        parts = [counted(self.npairs, "pair")]
        ends = {
            "outside": "outside",
            "partly": "partly covered",
            "repeatedly": "covered repeatedly",
            "empty": "without area",
        }
        for side in ("source", "target"):
            for name, end in ends.items():
                if count := len(getattr(self, f"{side}_{name}")):
                    parts.append(f"{counted(count, f'{side} cell')} {end}")
        return f"<OverlapReport: {', '.join(parts)}>"


W = TypeVar("W", bound=AreaWeights)


class SharedAreas(Paired, Generic[W]):
    """The areas that cells of two grids share, and what follows from them."""

    __slots__ = ()

    # The class of weights.
    _weights: type[W]
    # The sums of the parts of source and target cells.
    _sums: tuple[Floats, Floats]

    def _hold_areas(self, rows: Iterable[Any], sums: Iterable[Any], **more: Any) -> None:
        """Store rows, areas and sums of source and target, and what a class adds."""
        a, b, c = (sealed(x) for x in rows)
        s, t, u, v = (sealed(x) for x in sums)
        self._hold(rows=(a, b, c), areas=(s, t), sums=(u, v), **more)

    def _fill(self, *parts: Any) -> None:
        """Store the parts that ``__reduce__`` returns."""
        raise NotImplementedError

    @classmethod
    def _again(cls, *parts: Any) -> Self:
        made = cls.__new__(cls)
        made._fill(*parts)
        return made

    def _arrays(self) -> dict[str, NDArray[Any]]:
        """Return the arrays of files."""
        found: dict[str, NDArray[Any]] = dict(zip(_ROWS, self._rows, strict=True))
        found |= zip(_SUMS, self._areas + self._sums, strict=True)
        for name, shape in zip(_SHAPES, self._shapes, strict=True):
            found[name] = np.array(shape, dtype=np.int64)
        return found

    @staticmethod
    def _parts(arrays: dict[str, NDArray[Any]]) -> tuple[Any, ...]:
        """Return rows, sums and shapes of the arrays of files."""
        a, b, c = (arrays[name] for name in _ROWS)
        s, t, u, v = (arrays[name] for name in _SUMS)
        source, target = (tuple(arrays[name].tolist()) for name in _SHAPES)
        return (a, b, c), (s, t, u, v), (source, target)

    def _described(self) -> str:
        sources, targets = len(self.source_areas), len(self.target_areas)
        cells = f"{sources} source and {counted(targets, 'target cell')}"
        return f"{cells}: {counted(len(self.areas), 'pair')}"

    @property
    def areas(self) -> Floats:
        """Areas of the shared parts, on the sphere in steradians, (k,)."""
        return self._rows[2]

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
            rows += [np.flatnonzero(x) for x in (outside, partly, more, np.isnan(share))]
        return OverlapReport(len(self.areas), *rows)

    def to_weights(
        self,
        method: str = "conservative",
        *,
        source_mask: ArrayLike | None = None,
        target_mask: ArrayLike | None = None,
    ) -> W:
        """Return the contribution of each source cell to each target cell.

        Parameters
        ----------
        method : {"conservative", "normalized", "sum", "majority"}, optional
            How values are combined:

            - "conservative": integrals over the target cell, divided by its area ("destarea" in map
              files). This preserves the sum of values times areas. A partly covered cell gets
              proportionally less.
            - "normalized": means over the covered part ("fracarea"). A constant remains constant.
            - "sum": amounts, such as numbers of inhabitants: each source cell distributes its value
              to target cells in proportion to the shared area.
            - "majority": categories: the value that covers most of the target cell.
        source_mask, target_mask : array_like of bool, optional
            True, or 1, for the cells to use, as in files; in the shape of fields or of cells. By
            default all.

        Returns
        -------
        AreaWeights, on the sphere Weights
            The weights, without the cells. Masked target cells have no entries.

        Raises
        ------
        InputError
            `method` is unknown.
        ShapeError, DtypeError
            A mask has a different shape, or is not boolean.

        Notes
        -----
        Use "conservative" for fluxes and densities, and "normalized" for states such as
        temperatures.

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

        In the plane:

        >>> from delone import Overlaps
        >>> left, right = [(0, 0), (2, 0), (2, 1), (0, 1)], [(2, 0), (4, 0), (4, 1), (2, 1)]
        >>> overlaps = Overlaps([left, right], [[(1, 0), (4, 0), (4, 1), (1, 1)]])
        >>> overlaps.to_weights("sum").apply([10.0, 6.0]).tolist()
        [11.0]
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
        return self._weights._of(
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
