"""The class Overlaps: the areas that cells of two grids in the plane share."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone._base.arrays import as_choice, as_plain_array, as_workers
from delone._base.immutable import sealed
from delone._base.renames import renamed
from delone._tiling.complex import Stored
from delone.areal.cells import as_cells
from delone.areal.shared import OverlapReport, SharedAreas
from delone.areal.weights import METHODS, AreaWeights
from delone.errors import DtypeError, InputError, ShapeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Rows

__all__ = ["AreaWeights", "OverlapReport", "Overlaps"]

# Names of arrays in files that are not in files of overlaps on the sphere.
_ROWS = "source_reversed", "target_reversed"


@renamed(source_turned="source_reversed", target_turned="target_reversed")
class Overlaps(SharedAreas[AreaWeights], Stored):
    """The areas that cells of two layers in the plane share: the basis of areal interpolation.

    Parameters
    ----------
    source, target : GeoDataFrame, GeoSeries, sequence of geometries, triangulation or Voronoi
        The layers with known and with wanted values: shapely polygons and multipolygons (extra
        ``geo``), GeoJSON, or a list of rings of shape (k, 2); the triangles of a 2-D triangulation;
        or the cells of a 2-D `Voronoi` with a clip. Each geometry is a cell; missing and empty
        geometries are cells without area.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    indptr : ndarray of int64, shape (ntarget + 1,)
        Where the entries of each target cell start, and their number: compressed rows (CSR).
    indices : ndarray of int32, shape (k,)
        Source cells, ascending in each row.
    areas : ndarray of float64, shape (k,)
        Areas of the shared parts, in squared units of the coordinates.
    source_areas, target_areas : ndarray of float64
        Areas of the cells.
    source_reversed, target_reversed : ndarray of int64
        Cells with a clockwise outer ring, which count as if it were counterclockwise.

    Raises
    ------
    InputError
        A geometry is not a polygon, has a hole that is not inside its outer ring, or holes or parts
        that overlap; a cell is unbounded, coordinates are longitudes and latitudes, or the
        reference systems differ and pyproj cannot transform.
    CrossingSegmentsError
        Sides of a polygon cross, or a ring crosses itself where it touches itself.
    MissingExtraError
        The extra for geometries is not installed.
    MemoryError
        There is not enough memory for the result.

    Warns
    -----
    CRSWarning
        Only one of the layers has a reference system: both are assumed to have it.

    See Also
    --------
    delone.sphere.Overlaps : The same for longitudes and latitudes.

    Notes
    -----
    Exact orientation tests decide which cells share area. An infinitesimal move of the target
    breaks ties, so common corners and sides need no special treatment. An area is a sum over
    corners and crossings (Franklin, 1990) in double-double arithmetic relative to the smaller cell:
    it is accurate to its last bits, even for small cells far from the origin, and whatever the size
    of the other cell. No polygon is clipped. Parts below 1e-24 of the squared extent of the smaller
    cell cannot be distinguished from cells that only touch, and are not pairs.

    A ring may touch itself: at corners, in sides, and along sides that it passes in opposite
    directions. Exact signs decide whether it crosses itself there.

    Time is O(n log n + k) for cells with few corners. For pairs of polygons with many corners, it
    depends on the corners of one polygon near the box of the other.

    References
    ----------
    W. R. Franklin, "Calculating map overlay polygons' areas without explicitly calculating the
    polygons - implementation", 4th International Symposium on Spatial Data Handling (1990).

    Examples
    --------
    >>> from delone import Overlaps
    >>> districts = [[(0, 0), (2, 0), (2, 2), (0, 2)], [(2, 0), (4, 0), (4, 2), (2, 2)]]
    >>> zones = [[(1, 0), (3, 0), (3, 2), (1, 2)]]
    >>> overlaps = Overlaps(districts, zones)
    >>> overlaps
    <Overlaps of 2 source and 1 target cell: 2 pairs>
    >>> overlaps.areas.tolist()
    [2.0, 2.0]
    >>> overlaps.transfer({"people": [100, 60]}, {"people": "sum"})["people"].tolist()
    [80.0]
    """

    __slots__ = ("_areas", "_rows", "_shapes", "_sums", "_turned")

    _weights = AreaWeights
    _turned: tuple[Rows, Rows]

    def __init__(self, source: Any, target: Any, *, workers: int | None = None) -> None:
        threads = as_workers(workers)
        first = as_cells(source, name="source", crs=None, to="", workers=threads)
        second = as_cells(target, name="target", crs=first.crs, to="source", workers=threads)
        found = second.made.overlaps(first.made, threads)
        self._fill(
            (found.indptr, found.indices, found.areas),
            (first.areas, second.areas, found.second, found.first),
            (first.turned, second.turned),
            workers,
        )
        if (crs := first.crs or second.crs) is not None:
            object.__setattr__(self, "_system", crs)

    def _fill(self, *parts: Any) -> None:
        rows, sums, turned, workers = parts
        p, q = (sealed(x) for x in turned)
        shapes = (len(sums[0]),), (len(sums[1]),)
        self._hold_areas(rows, sums, shapes=shapes, turned=(p, q), workers=workers)

    def __reduce__(self) -> tuple[Any, ...]:
        return self._again, (self._rows, self._areas + self._sums, self._turned, self._workers)

    @classmethod
    def _stored_as(cls) -> str:
        return "Overlaps"

    def _saved(self) -> dict[str, NDArray[Any]]:
        return self._arrays() | dict(zip(_ROWS, self._turned, strict=True))

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        rows, sums, _ = cls._parts(arrays)
        p, q = (arrays[name] for name in _ROWS)
        return cls._again(rows, sums, (p, q), None)

    @property
    def source_reversed(self) -> Rows:
        """Source cells with a clockwise outer ring."""
        return self._turned[0]

    @property
    def target_reversed(self) -> Rows:
        """Target cells with a clockwise outer ring."""
        return self._turned[1]

    def transfer(
        self,
        data: Any,
        methods: Mapping[str, str],
        *,
        skipna: bool = False,
        min_fraction: float = 0.0,
    ) -> dict[str, NDArray[Any]]:
        """Return columns of the source on the target.

        Parameters
        ----------
        data : DataFrame, GeoDataFrame or mapping
            Columns with a value for each source cell.
        methods : mapping
            For each column to transfer, "sum", "normalized", "conservative" or "majority", as for
            `to_weights`. Text columns can be transferred by "majority" only.
        skipna : bool, optional
            Whether NaN and None are missing values, whose cells are ignored. By default NaN
            propagates to all target cells that share area with it; for "majority" it is a category.
        min_fraction : float, optional
            Target cells with values on a smaller fraction of their area are missing.

        Returns
        -------
        dict
            An array for each column, with a value for each target cell: NaN, or None in text
            columns, where no value is known. ``targets.assign(**result)`` adds them to a table.

        Raises
        ------
        InputError
            A column does not exist, a method is unknown, or a text column's is not "majority".
        ShapeError
            A column does not have one value for each source cell.
        DtypeError
            `methods` is not a mapping.

        See Also
        --------
        covered_target : How much of each target cell is covered.

        Examples
        --------
        >>> from delone import Overlaps
        >>> source = [[(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)] for k in range(3)]
        >>> target = [[(k, 0), (k + 2, 0), (k + 2, 1), (k, 1)] for k in (0, 2)]
        >>> data = {"people": [10, 20, 30], "use": ["field", "wood", "town"]}
        >>> found = Overlaps(source, target).transfer(data, {"people": "sum", "use": "majority"})
        >>> found["people"].tolist(), found["use"].tolist()
        ([30.0, 30.0], ['field', 'town'])
        """
        if not isinstance(methods, Mapping):
            raise DtypeError(f"methods must map columns to methods, got {type(methods).__name__}")
        if not isinstance(data, Mapping) and not hasattr(data, "columns"):
            raise DtypeError(
                f"data must be a table or a mapping of columns, got {type(data).__name__}"
            )
        found: dict[str, NDArray[Any]] = {}
        made: dict[str, AreaWeights] = {}
        for column, method in methods.items():
            if column not in data:
                raise InputError(f"data has no column {column!r:.60}")
            values = as_plain_array(data[column], f"column {column!r:.60}")
            kind = as_choice(method, METHODS, name="method")
            count = len(self.source_areas)
            if values.shape != (count,):
                raise ShapeError(
                    f"column {column!r:.60} must have one value for each of {count} source cells, "
                    f"got shape {values.shape}"
                )
            if kind not in made:
                made[kind] = self.to_weights(kind)
            options: dict[str, Any] = {"skipna": skipna, "min_fraction": min_fraction}
            # Integers have no NaN for cells without a value.
            numbers = _numbers(values)
            found[column] = (
                _of_text(made[kind], column, values, options)
                if numbers is None
                else made[kind].apply(numbers, **options)
            )
        return found


def _is_missing(item: Any) -> bool:
    """Return whether a value of a column is None, NaN, or one of pandas' missing values."""
    if isinstance(item, float):
        return math.isnan(item)
    return item is None or type(item).__name__ in {"NAType", "NaTType"}


def _numbers(values: NDArray[Any]) -> NDArray[Any] | None:
    """Return a column as floating-point numbers; None for text and other objects."""
    if values.dtype.kind == "f":
        return values
    if values.dtype.kind in "iub":
        return values.astype(np.float64)
    items = values.tolist()
    if values.dtype.kind != "O" or not all(
        _is_missing(x) or isinstance(x, bool | int | float) for x in items
    ):
        return None
    return np.array([math.nan if _is_missing(x) else float(x) for x in items])


def _of_text(
    weights: AreaWeights, column: str, values: NDArray[Any], options: dict[str, Any]
) -> NDArray[Any]:
    """Return the categories that cover most of the target cells; None where there is none."""
    if weights.method != "majority":
        raise InputError(
            f"column {column!r:.60} is not numeric: its method must be 'majority', got "
            f"{weights.method!r:.60}"
        )
    items = values.tolist()
    missing = np.array([_is_missing(x) for x in items], dtype=np.bool_)
    names, codes = np.unique([str(x) for x in items], return_inverse=True)
    kinds = np.full(len(names), None, dtype=object)
    kinds[codes[~missing]] = values.astype(object)[~missing]
    numbers = codes.astype(np.float64)
    numbers[missing] = np.nan if options["skipna"] else len(names)
    best = weights.apply(numbers, **options)
    known = ~np.isnan(best)
    found = np.full(len(best), None, dtype=object)
    found[known] = np.array([*kinds, None], dtype=object)[best[known].astype(np.int64)]
    return found
