"""The class AreaWeights: what source cells contribute to target cells, applied to fields."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_flag, as_plain_array, as_workers, wrong_shape
from delone._base.counting import agreed, counted
from delone._base.immutable import sealed
from delone._base.numbers import as_between
from delone._base.values import require_real
from delone.areal.paired import Paired, row_sums
from delone.errors import DtypeError, InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Bools, Floats, Rows

__all__ = ["METHODS", "OTHER", "AreaWeights", "as_mask"]

METHODS = ("conservative", "normalized", "sum", "majority")
# For files that do not say how their weights are normalized.
OTHER = "other"
# Fractions that differ by less are equal.
_ROUNDING = 1e-12
# Values of fields that are processed together.
_LOT = 1 << 22


class AreaWeights(Paired):
    """The contribution of each source cell to each target cell.

    Created by `Overlaps.to_weights`.

    Attributes
    ----------
    method : str
        "conservative", "normalized", "sum" or "majority", as for `Overlaps.to_weights`.
    indptr : ndarray of int64, shape (ntarget + 1,)
        Where the entries of each target cell start, and their number: compressed rows (CSR).
    indices : ndarray of int32, shape (k,)
        Source cells.
    values : ndarray of float64, shape (k,)
        The weights.
    fractions : ndarray of float64, shape (ntarget,)
        The fraction of each target cell that source cells cover, without those that are masked;
        0 for masked target cells.
    source_fractions : ndarray of float64, shape (nsource,)
        The same for source cells.
    source_areas, target_areas : ndarray of float64
        Areas of the cells.
    source_shape, target_shape : tuple of int
        Shapes of fields.

    Notes
    -----
    Weights contain arrays but no cells, so their pickles are small.

    See Also
    --------
    Overlaps.to_weights : Creates them.
    delone.sphere.Weights : The same on the sphere, with map files.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import Delaunay, Overlaps
    >>> points = np.random.default_rng(0).random((100, 2))
    >>> coarse = Delaunay([(0, 0), (1, 0), (1, 1), (0, 1)])
    >>> weights = Overlaps(Delaunay(points), coarse).to_weights("sum")
    >>> weights
    <AreaWeights, sum, 185 to 2: 209 entries>
    """

    __slots__ = ("_areas", "_fractions", "_method", "_rows", "_shapes")

    # Methods whose weights sum to one.
    _MEANS: ClassVar[frozenset[str]] = frozenset({"normalized"})

    _fractions: tuple[Floats, Floats]
    _method: str

    def __init__(self) -> None:
        raise InputError("create AreaWeights with Overlaps.to_weights")

    @classmethod
    def _of(
        cls,
        method: str,
        rows: tuple[Rows, NDArray[np.int32], Floats],
        fractions: tuple[Floats, Floats],
        areas: tuple[Floats, Floats],
        shapes: tuple[tuple[int, ...], tuple[int, ...]],
    ) -> Self:
        """Return weights of arrays; those of the source come first in each pair."""
        made = cls.__new__(cls)
        a, b, c = (sealed(x) for x in rows)
        s, t = (sealed(x) for x in fractions)
        u, v = (sealed(x) for x in areas)
        made._hold(method=method, rows=(a, b, c), fractions=(s, t), areas=(u, v), shapes=shapes)
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        return self._of, (self._method, self._rows, self._fractions, self._areas, self._shapes)

    def __repr__(self) -> str:
        source, target = (" x ".join(map(str, shape)) for shape in self._shapes)
        entries = len(self.values)
        return f"<{type(self).__name__}, {self._method}, {source} to {target}: {entries} entries>"

    @property
    def method(self) -> str:
        """How values are combined."""
        return self._method

    @property
    def values(self) -> Floats:
        """The weights, (k,)."""
        return self._rows[2]

    @property
    def fractions(self) -> Floats:
        """The fraction of each target cell that is covered, (ntarget,)."""
        return self._fractions[1]

    @property
    def source_fractions(self) -> Floats:
        """The fraction of each source cell that is covered, (nsource,)."""
        return self._fractions[0]

    def apply(
        self,
        values: ArrayLike,
        *,
        skipna: bool = False,
        min_fraction: float = 0.0,
        fill: Any = None,
    ) -> NDArray[Any]:
        """Return a field on the target.

        Parameters
        ----------
        values : array_like, shape (..., r, c) or (..., nsource)
            Real numbers, in the shape of the grid or as rows; leading axes, such as times and
            levels, remain.
        skipna : bool, optional
            Whether NaN means a missing value, whose cell is ignored. By default NaN propagates to
            all target cells that share area with it; for "majority" it is a category.
        min_fraction : float, optional
            Target cells in which a smaller fraction has values, by more than a rounding error of
            1e-12, are missing. By default, any fraction suffices.
        fill : number, optional
            The value of missing target cells, by default NaN. Needed for integers of "majority"
            where target cells are missing.

        Returns
        -------
        ndarray, shape (..., r, c) or (..., ntarget)
            float32 for float32, else float64; for "majority" the dtype of `values`. Cells without
            any value are missing, not 0.

        Raises
        ------
        ShapeError
            The last axes of `values` are not those of the source.
        DtypeError
            `values` are not numeric.
        InputError
            `min_fraction` is not from 0 to 1, or integers have missing cells and no `fill`.

        Notes
        -----
        "conservative" and "sum" treat missing values as masked cells: known amounts are conserved.
        "normalized" is the mean over the known values, so that a constant remains exactly constant.
        A changing mask, such as that of sea ice, needs no new weights.

        Examples
        --------
        >>> import numpy as np
        >>> from delone import sphere
        >>> source = sphere.Grid.from_lonlat([0, 1, 2], [0, 1])
        >>> target = sphere.Grid.from_lonlat([0, 2], [0, 1])
        >>> overlaps = sphere.Overlaps(source, target)
        >>> field = [np.nan, 8.0]
        >>> overlaps.to_weights("normalized").apply(field, skipna=True).round(9)
        array([[8.]])
        >>> overlaps.to_weights("conservative").apply(field, skipna=True).round(9)
        array([[4.]])
        >>> overlaps.to_weights("normalized").apply(field, skipna=True, min_fraction=0.6)
        array([[nan]])
        """
        least = as_between(min_fraction, 0, 1, name="min_fraction")
        skipna = as_flag(skipna, name="skipna")
        given, lead, shape = self._flat(values)
        found: NDArray[Any]
        if self._method == "majority":
            found, missing = self._majority(given, skipna, least)
        else:
            kind = np.float32 if given.dtype == np.float32 else np.float64
            found = np.empty((len(given), len(self.fractions)), dtype=kind)
            missing = np.empty(found.shape, dtype=bool)
            lot = max(1, _LOT // max(given.shape[1], 1))
            for first in range(0, len(given), lot):
                part = given[first : first + lot].astype(np.float64)
                found[first : first + lot], missing[first : first + lot] = self._mixed(
                    part, skipna, least
                )
        if missing.any():
            if fill is None and found.dtype.kind not in "f":
                count = int(missing.any(axis=0).sum())
                cells = f"{counted(count, 'target cell')} {agreed(count, 'has', 'have')}"
                raise InputError(f"{cells} no value, and integers have no NaN: give fill=")
            found[missing] = np.nan if fill is None else fill
        return found.reshape(lead + shape)

    def _flat(self, values: ArrayLike) -> tuple[NDArray[Any], tuple[int, ...], tuple[int, ...]]:
        """Return a field as (fields, nsource), its leading axes, and the shape of the result."""
        array = as_plain_array(values, "values")
        require_real(array, "values", kinds="iufb")
        count = len(self.source_fractions)
        source, target = self._shapes
        axes = len(source)
        if array.ndim >= axes and array.shape[array.ndim - axes :] == source:
            lead = array.shape[: array.ndim - axes]
        elif array.ndim and array.shape[-1] == count:
            lead, target = array.shape[:-1], (len(self.fractions),)
            if lead == () and len(self._shapes[1]) > 1:
                target = self._shapes[1]
        else:
            raise ShapeError(
                f"the last axes of values must be {source} or ({count},), got {array.shape}"
            )
        return array.reshape(-1, count), lead, target

    def _mixed(self, part: Floats, skipna: bool, least: float) -> tuple[Floats, Bools]:
        """Return sums of products, and which are missing.

        Sums are over differences from the smallest value of each field, so that a constant remains
        exactly constant.
        """
        share = np.broadcast_to(self.fractions, (len(part), len(self.fractions)))
        totals = np.broadcast_to(self._totals(), share.shape)
        none = np.isnan(part) if skipna else None
        if none is not None and none.any():
            there = np.where(none, 0.0, 1.0)
            totals = self._combined(self._entries()[2], there)
            share = self._combined(self._shares(), there)
        low = np.fmin.reduce(part, axis=1, initial=np.inf, keepdims=True)
        low = np.where(np.isfinite(low), low, 0.0)
        rest = part - low
        if none is not None:
            rest[none] = 0.0
        sums = self._combined(self._entries()[2], rest)
        more = self._corrections(part)
        if more is not None:
            sums += more
        missing = (share <= 0) | (share < least - _ROUNDING)
        if skipna and self._method in {*self._MEANS, OTHER}:
            with np.errstate(invalid="ignore", divide="ignore"):
                return low + sums / totals, missing
        return low * totals + sums, missing

    def _entries(self) -> tuple[Rows, NDArray[np.int32], Floats]:
        """Return the entries that are areas over areas."""
        return self._rows

    def _corrections(self, part: Floats) -> Floats | None:
        """Return what is added to sums of products with fields, (fields, ntarget)."""
        return None

    def _combined(self, weights: Floats, part: Floats) -> Floats:
        """Return sums of products with fields, (fields, ntarget)."""
        columns = np.ascontiguousarray(part.T)
        indptr, indices, _ = self._entries()
        return _core.combine2(indptr, indices, weights, columns, None, None, as_workers(None)).T

    def _totals(self) -> Floats:
        """Return the sum of the weights of each target cell."""
        if self._method in self._MEANS:
            return np.ones(len(self.fractions))
        if self._method == "conservative":
            return self.fractions
        return row_sums(self.indptr, self.values)

    def _shares(self) -> Floats:
        """Return the fraction of the target cell that each entry covers."""
        indptr, indices, values = self._entries()
        lengths = np.diff(indptr)
        if self._method == "normalized":
            return values * np.repeat(self.fractions, lengths)
        if self._method == "sum":
            with np.errstate(invalid="ignore", divide="ignore"):
                areas = values * self.source_areas[indices]
                return areas / np.repeat(self.target_areas, lengths)
        return values

    def _majority(
        self, given: NDArray[Any], skipna: bool, least: float
    ) -> tuple[NDArray[Any], Bools]:
        """Return the value that covers most of each target cell, or the smallest of several."""
        row = np.repeat(np.arange(len(self.fractions)), np.diff(self.indptr))
        found = np.zeros((len(given), len(self.fractions)), dtype=given.dtype)
        missing = np.ones(found.shape, dtype=bool)
        for one, none, field in zip(found, missing, given, strict=True):
            entries, covers, of = field[self.indices], self.values, row
            if skipna and entries.dtype.kind == "f":
                there = ~np.isnan(entries)
                entries, covers, of = entries[there], covers[there], of[there]
            order = np.lexsort((entries, of))
            entries, covers, of = entries[order], covers[order], of[order]
            if not len(of):
                continue
            # Runs of one value in one cell, and their sums.
            first = np.ones(len(of), dtype=bool)
            differ = entries[1:] != entries[:-1]
            if entries.dtype.kind == "f":
                # NaN counts as one category.
                differ &= ~(np.isnan(entries[1:]) & np.isnan(entries[:-1]))
            first[1:] = (of[1:] != of[:-1]) | differ
            starts = np.flatnonzero(first)
            sums = np.add.reduceat(covers, starts)
            cell, value = of[starts], entries[starts]
            best = np.lexsort((value, -sums, cell))
            top = best[np.concatenate(([True], cell[best][1:] != cell[best][:-1]))]
            one[cell[top]] = value[top]
            covered = np.bincount(of, covers, len(self.fractions))
            none[:] = (covered <= 0) | (covered < least - _ROUNDING)
        return found, missing


def as_mask(mask: ArrayLike | None, shape: tuple[int, ...], name: str) -> Bools | None:
    """Return which cells take part, (n,)."""
    if mask is None:
        return None
    array = as_plain_array(mask, name)
    if array.dtype.kind not in "biu":
        raise DtypeError(f"{name} must be boolean or 0 and 1, got {array.dtype}")
    count = int(np.prod(shape))
    if array.shape not in {shape, (count,)}:
        raise wrong_shape(name, f"{shape} or ({count},)", array)
    if array.dtype.kind != "b" and not np.isin(array, (0, 1)).all():
        raise InputError(f"{name} must be boolean or 0 and 1")
    return array.ravel().astype(bool)
