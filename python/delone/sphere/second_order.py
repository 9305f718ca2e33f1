"""Second-order conservative weights: values of cells with gradients, and their limiter.

In each source cell, the field is a plane that has the mean of the cell at its centroid, so a target
cell gets the plane's value at the centroid of the part that they share (Jones, "First- and
second-order conservative remapping schemes for grids in spherical coordinates", Monthly Weather
Review 127, 1999). Slopes are fitted to the neighbors by least squares. The limiter is that of Barth
and Jespersen (AIAA paper 89-0366, 1989), for the means of the parts instead of the corners.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from delone._base.arrays import as_workers
from delone._base.immutable import sealed
from delone._tiling.plane.topology import vertex_neighbor_vertices
from delone.areal.paired import added
from delone.errors import DeloneError, InputError
from delone.sphere.coordinates import directions_of, units_of
from delone.sphere.delaunay import Delaunay
from delone.sphere.moments import moments_of_cells, moments_of_parts
from delone.sphere.weights import Weights

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats, Rows
    from delone.sphere.grid import Grid

__all__ = ["SecondOrderWeights", "second_order"]

# Cells count as whole if only rounding errors of corners are not covered.
_ROUNDING = 1e-9
# Neighbors on a line do not determine a slope across it.
_FLAT = 1e-9


class _Slopes(NamedTuple):
    """The terms that slopes add to first-order weights."""

    # For each first-order entry: the offset of its centroid from that of the cell, by weight.
    offsets: Floats
    # Neighbors of each source cell, and their contributions to its slope.
    starts: Rows
    neighbors: Rows
    slopes: Floats
    limited: bool


class SecondOrderWeights(Weights):
    """Second-order weights; see `Overlaps.to_weights`.

    Attributes
    ----------
    indptr, indices, values : ndarray
        The weights without a limiter, which depends on the field.
    limited : bool
        Whether slopes are limited so that there are no new extremes.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> source = sphere.Grid.from_healpix(8)
    >>> target = sphere.Grid.from_lonlat(np.arange(0, 361, 5), np.arange(-90, 91, 5))
    >>> sphere.Overlaps(source, target).to_weights("conservative", order=2, limiter=True).limited
    True
    """

    __slots__ = ("_first", "_slopes")

    _first: tuple[Rows, NDArray[np.int32], Floats]
    _slopes: _Slopes

    @classmethod
    def _with(cls, first: Weights, slopes: _Slopes) -> Self:
        """Return second-order weights from first-order weights."""
        held = [sealed(a) for a in slopes[:4]]
        slopes = _Slopes(held[0], held[1], held[2], held[3], slopes.limited)
        a, b, c = (sealed(x) for x in _expanded(first, slopes))
        made = cls.__new__(cls)
        made._hold(
            method=first._method,
            rows=(a, b, c),
            fractions=first._fractions,
            areas=first._areas,
            shapes=first._shapes,
            first=first._rows,
            slopes=slopes,
        )
        return made

    @classmethod
    def _again(cls, first: tuple[Any, ...], slopes: tuple[Any, ...]) -> Self:
        return cls._with(Weights._of(*first), _Slopes(*slopes))

    def __reduce__(self) -> tuple[Any, ...]:
        parts = self._method, self._first, self._fractions, self._areas, self._shapes
        return self._again, (parts, tuple(self._slopes))

    def __repr__(self) -> str:
        order = "second order, limited" if self.limited else "second order"
        return super().__repr__().replace(f", {self._method},", f", {self._method}, {order},", 1)

    @property
    def order(self) -> int:
        """2: source cells have slopes."""
        return 2

    @property
    def limited(self) -> bool:
        """Whether slopes are limited so that there are no new extremes."""
        return self._slopes.limited

    def _entries(self) -> tuple[Rows, NDArray[np.int32], Floats]:
        return self._first

    def _corrections(self, part: Floats) -> Floats:
        """Return what the slopes add to target cells, (fields, ntarget)."""
        indptr, indices, values = self._first
        offsets, starts, neighbors, slopes, limited = self._slopes
        row = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
        cell = np.repeat(np.arange(len(starts) - 1), np.diff(starts))
        away = offsets / values[:, None] if limited else offsets
        found = np.empty((len(part), len(indptr) - 1))
        for one, field in zip(found, part, strict=True):
            rise = field[neighbors] - field[cell]
            # Missing neighbors do not contribute to slopes.
            rise[~np.isfinite(rise)] = 0.0
            slope: Floats = np.stack(
                [np.bincount(cell, rise * slopes[:, k], len(field)) for k in range(3)], axis=1
            )
            if limited:
                ranges = [np.zeros(len(field)), np.zeros(len(field))]
                np.minimum.at(ranges[0], cell, rise)
                np.maximum.at(ranges[1], cell, rise)
                change = (away * slope[indices]).sum(axis=1)
                bound = np.where(change > 0, ranges[1][indices], ranges[0][indices])
                with np.errstate(divide="ignore", invalid="ignore"):
                    share = np.where(change == 0, 1.0, bound / change)
                least = np.ones(len(field))
                np.minimum.at(least, indices, share)
                slope = slope * least[:, None]
            one[:] = np.bincount(row, (offsets * slope[indices]).sum(axis=1), len(one))
        return found


def _expanded(first: Weights, slopes: _Slopes) -> tuple[Rows, NDArray[np.int32], Floats]:
    """Return the sum of first-order weights and slopes, as compressed rows."""
    indptr, indices, values = first._rows
    row = np.repeat(np.arange(len(indptr) - 1), np.diff(indptr))
    counts = np.diff(slopes.starts)[indices]
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    at = np.repeat(slopes.starts[indices], counts) + within
    more = (np.repeat(slopes.offsets, counts, axis=0) * slopes.slopes[at]).sum(axis=1)
    own = np.repeat(indices, counts)
    return added(
        np.concatenate((row, np.repeat(row, counts), np.repeat(row, counts))),
        np.concatenate((indices, slopes.neighbors[at], own)),
        np.concatenate((values, more, -more)),
        len(indptr) - 1,
    )


def second_order(
    first: Weights,
    grids: tuple[Grid, Grid],
    used: Bools | None,
    *,
    limited: bool,
    workers: int | None,
) -> SecondOrderWeights:
    """Return second-order weights from first-order weights between the same cells."""
    source, target = grids
    indptr, indices, values = first._rows
    row = np.repeat(np.arange(target.ncells), np.diff(indptr))
    cell = indices.astype(np.int64)
    centers = np.zeros((source.ncells, 3))
    there = np.isfinite(source.centers_lonlat).all(axis=1)
    lonlat = source.centers_lonlat[there]
    vectors = directions_of(lonlat, None, degrees=True, workers=workers, any_turns=True)
    centers[there] = units_of(vectors, workers)
    # The areas of the parts, from the weights.
    over = target.areas[row]
    if first.method == "normalized":
        over = over * first.fractions[row]
    areas = values * over
    parts = moments_of_parts(source, target, cell, row, centers[cell])
    parts *= _within(parts, areas, source.areas[cell])[:, None]
    sums = np.stack([np.bincount(cell, parts[:, k], source.ncells) for k in range(3)], axis=1)
    covered = np.bincount(cell, areas, source.ncells)
    # The moments of whole cells are sums over their parts, so that they cancel exactly.
    whole = np.abs(covered - source.areas) <= _ROUNDING * source.areas
    means = np.where(whole[:, None], sums, moments_of_cells(source, centers))
    weight = np.where(whole, covered, source.areas)
    means = np.divide(means, weight[:, None], out=np.zeros_like(means), where=weight[:, None] > 0)
    offsets = (parts - areas[:, None] * means[cell]) / over[:, None]
    kept = there & (source.areas > 0)
    if used is not None:
        kept &= used
    starts, neighbors, slopes = _fitted(centers + means, np.flatnonzero(kept), workers)
    return SecondOrderWeights._with(first, _Slopes(offsets, starts, neighbors, slopes, limited))


def _within(parts: Floats, areas: Floats, whole: Floats) -> Floats:
    """Return factors that keep the rounded centroids of slivers near their cells."""
    size = np.linalg.norm(parts, axis=1)
    # Only slivers: parts with less than a billionth of a cell.
    small = areas < 1e-9 * whole
    most = areas * np.sqrt(whole)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(small & (size > most), most / size, 1.0)


def _fitted(places: Floats, used: Rows, workers: int | None) -> tuple[Rows, Rows, Floats]:
    """Return neighbors of cells as compressed rows, and their contributions to the slope.

    Slopes fit the differences from the neighbors in the Delaunay triangulation of the centroids,
    by least squares with the inverse squares of distances.
    """
    try:
        mesh = Delaunay(xyz=places[used], workers=as_workers(workers))
    except DeloneError as error:
        raise InputError(
            f"order=2 needs source cells with neighbors ({error}): use order=1"
        ) from error
    starts, near = vertex_neighbor_vertices(mesh.edges, mesh.npoints)
    counts = np.zeros(len(places), dtype=np.int64)
    counts[used] = np.diff(starts)
    cell = np.repeat(used, np.diff(starts))
    neighbors = used[near]
    normal = places[cell] / np.linalg.norm(places[cell], axis=1, keepdims=True)
    # Two tangent directions at each cell.
    helper = np.eye(3)[np.abs(normal).argmin(axis=1)]
    east = np.cross(helper, normal)
    east /= np.linalg.norm(east, axis=1, keepdims=True)
    north = np.cross(normal, east)
    way = places[neighbors] - places[cell]
    x, y = (way * east).sum(axis=1), (way * north).sum(axis=1)
    weight = 1 / np.maximum(x * x + y * y, np.finfo(float).tiny)
    size = len(places)
    xx, xy, yy = (np.bincount(cell, weight * v, size)[cell] for v in (x * x, x * y, y * y))
    det = xx * yy - xy * xy
    trace = xx + yy
    good = det > _FLAT * trace**2
    det = np.where(good, det, 1.0)
    # If neighbors are on a line, only the slope along it.
    a = weight * np.where(good, (yy * x - xy * y) / det, (xx * x + xy * y) / trace**2)
    b = weight * np.where(good, (xx * y - xy * x) / det, (xy * x + yy * y) / trace**2)
    slopes = a[:, None] * east + b[:, None] * north
    indptr = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    return indptr, neighbors, slopes
