"""The class Weights: what source cells contribute to target cells, for use on fields."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from delone._base.arrays import as_choice, as_least
from delone._base.numbers import as_positive
from delone.areal.paired import added
from delone.areal.weights import AreaWeights, as_mask
from delone.errors import InputError
from delone.sphere.grid_cells import require_grid
from delone.sphere.pointwise import POINTWISE, pointwise, refuse_neighbors

if TYPE_CHECKING:
    import os

    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats
    from delone.sphere.grid import Grid

__all__ = ["SlopedWeights", "Weights"]


class Weights(AreaWeights):
    """The contribution of each source cell to each target cell.

    Made by `Overlaps.to_weights`, by `between` for interpolation between centers, or by
    `from_netcdf` from another program's map file.

    Attributes
    ----------
    method : str
        "conservative", "normalized", "sum" or "majority", as for `Overlaps.to_weights`; a method of
        `between`; "other" if a file does not name one.
    indptr : ndarray of int64, shape (ntarget + 1,)
        Where the entries of each target cell start, and their number: compressed rows (CSR).
    indices : ndarray of int32, shape (k,)
        Source cells.
    values : ndarray of float64, shape (k,)
        The weights.
    fractions : ndarray of float64, shape (ntarget,)
        The fraction of each target cell that unmasked source cells cover; 0 for masked target
        cells.
    source_fractions : ndarray of float64, shape (nsource,)
        The same for source cells.
    source_areas, target_areas : ndarray of float64
        Areas of the cells in steradians.
    source_shape, target_shape : tuple of int
        Shapes of fields.
    order : int
        2 if source cells have slopes, else 1.
    limited : bool
        Whether slopes are limited. Then `values` are the weights without a limiter, which depends
        on the field.

    Notes
    -----
    Weights contain arrays but no grids, so their pickles are small.

    See Also
    --------
    Overlaps.to_weights : Makes them.

    Examples
    --------
    >>> import numpy as np
    >>> from delone import sphere
    >>> source = sphere.Grid.from_lonlat(np.arange(0, 361, 1), np.arange(-90, 91, 1))
    >>> target = sphere.Grid.from_healpix(8)
    >>> weights = sphere.Overlaps(source, target).to_weights("conservative")
    >>> weights
    <Weights, conservative, 180 x 360 to 768: 84128 entries>
    >>> field = np.cos(np.radians(source.centers_lonlat[:, 1])).reshape(source.grid_shape)
    >>> coarse = weights.apply(field)
    >>> totals = (field.ravel() * source.areas).sum(), (coarse * target.areas).sum()
    >>> bool(np.isclose(*totals, rtol=1e-14))
    True
    """

    __slots__ = ()

    _MEANS: ClassVar[frozenset[str]] = frozenset({"normalized", *POINTWISE})

    def __init__(self) -> None:
        raise InputError("make Weights by Overlaps.to_weights, Weights.between or .from_netcdf")

    @property
    def order(self) -> int:
        """2 if source cells have slopes, else 1."""
        return 1

    @property
    def limited(self) -> bool:
        """Whether slopes are limited, so that there are no new extremes."""
        return False

    @classmethod
    def between(
        cls,
        source: Grid,
        target: Grid,
        method: str = "linear",
        *,
        source_mask: ArrayLike | None = None,
        target_mask: ArrayLike | None = None,
        extrapolate: str = "nan",
        power: float = 2.0,
        neighbors: int | None = None,
        workers: int | None = None,
    ) -> Self:
        """Return weights of an interpolation between the centers of cells.

        Parameters
        ----------
        source, target : Grid
            The grids of the given fields and of the result.
        method : {"linear", "bilinear", "sibson", "laplace", "nearest", "binned", \
"inverse_distance"}, optional
            How values at centers are combined:

            - "linear": in the triangles between centers
            - "bilinear": between centers in rows and columns, or between the centers of four cells
              that meet at a corner; toward a pole, to the mean of the last row
            - "sibson", "laplace": natural neighbors
            - "nearest": the value of the nearest center
            - "binned": the mean of the source cells whose centers are nearest to that of the target
              cell, if there are any
            - "inverse_distance": the nearest center and its neighbors in the Delaunay
              triangulation, or the nearest `neighbors`, weighted by the inverse of the distance to
              the power of `power`
        source_mask, target_mask : array_like of bool, optional
            True, or 1, for the cells to use.
        extrapolate : {"nan", "nearest"}, optional
            The values of target cells outside the centers.
        power : float, optional
            For "inverse_distance": the exponent.
        neighbors : int, optional
            For "inverse_distance": the number of nearest centers to use, together with all others
            at the same distance as the last of them, up to 90 degrees away. By default, the nearest
            center and its Delaunay neighbors.
        workers : int, optional
            Maximum number of threads; by default one per core.

        Returns
        -------
        Weights
            Weights that sum to 1 for each target cell with a value. They do not preserve integrals;
            those of `Overlaps.to_weights` do.

        Raises
        ------
        InputError
            An option is unknown, `power` or `neighbors` is not positive, `neighbors` is given for a
            different method, or the source of "bilinear" has cells without common corners.
        ShapeError, DtypeError
            A mask has the wrong shape, or is not boolean.

        Notes
        -----
        For "bilinear", a source with great circles as sides consists of the polygons between the
        centers of the cells around each corner. In a quadrilateral, the weighted mean of the
        centers, as vectors, points to the target; Newton's method finds its coordinates in at most
        30 steps. If it does not, and in concave quadrilaterals, weights are linear in the triangles
        on both sides of a diagonal inside. Weights in triangles are linear, and a corner of more
        than four cells has the mean of their values. Exact signs decide which polygon contains a
        target; at a center, its cell has the weight 1. Outside the polygons, and in those whose
        sides cross, there is no value. This takes about 10 microseconds per cell.

        See Also
        --------
        Overlaps.to_weights : Weights by the areas that cells share.

        Examples
        --------
        >>> from delone import sphere
        >>> source = sphere.Grid.from_lonlat([0, 2, 4, 6], [0, 2, 4])
        >>> target = sphere.Grid.from_lonlat([1, 3], [1, 3])
        >>> field = [[0.0, 4.0, 8.0], [2.0, 6.0, 10.0]]
        >>> for method in ("bilinear", "nearest", "binned"):
        ...     weights = sphere.Weights.between(source, target, method)
        ...     print(method, weights.apply(field).round(9).tolist())
        bilinear [[3.0]]
        nearest [[2.0]]
        binned [[5.0]]
        """
        require_grid(source, "source")
        require_grid(target, "target")
        kind = as_choice(method, POINTWISE, name="method")
        beyond = as_choice(extrapolate, ("nan", "nearest"), name="extrapolate")
        exponent = as_positive(power, name="power", finite=True)
        most = None if neighbors is None else as_least(neighbors, 1, name="neighbors")
        refuse_neighbors(most, kind)
        used = (
            as_mask(source_mask, source.grid_shape, "source_mask"),
            as_mask(target_mask, target.grid_shape, "target_mask"),
        )
        found = pointwise(
            source,
            target,
            kind,
            used,
            extrapolate=beyond,
            power=exponent,
            neighbors=most,
            workers=workers,
        )
        indptr, indices, values = added(found.rows, found.columns, found.values, target.ncells)
        counts = np.diff(indptr)
        there = np.bincount(indices, minlength=source.ncells) > 0
        return cls._of(
            kind,
            (indptr, indices, values),
            (there.astype(np.float64), (counts > 0).astype(np.float64)),
            (source.areas, target.areas),
            (source.grid_shape, target.grid_shape),
        )

    def to_netcdf(
        self,
        path: str | os.PathLike[str],
        *,
        layout: str = "esmf",
        source: Grid | None = None,
        target: Grid | None = None,
        grid_names: tuple[str, str] = ("source", "target"),
        format: str = "NETCDF4",
    ) -> None:
        """Write a map file for ESMF's tools, xESMF, uxarray, NCO, CDO or YAC (extra ``xarray``).

        Parameters
        ----------
        path : str or path-like
            The file; written atomically.
        layout : {"esmf", "scrip", "yac"}, optional
            The names of dimensions and variables: those of ESMF, of SCRIP and CDO, or of YAC.
        source, target : Grid, optional
            The grids, whose centers and corners are then also written. NCO and CDO need them.
        grid_names : (str, str), optional
            The names of the grids in the file. YAC rejects a file unless its own grids have these
            names.
        format : {"NETCDF4", "NETCDF3_64BIT_DATA"}, optional
            NetCDF-4, or CDF-5.

        Raises
        ------
        InputError
            `layout` or `format` is unknown, the weights are limited or those of "majority", or a
            grid has the wrong number of cells.
        MissingExtraError
            netCDF4 is not installed.
        OutputError
            The file cannot be written.

        Notes
        -----
        Cells are numbered from 1, and an attribute ``start_index`` says so. ``normalization`` is
        "destarea" for "conservative", "fracarea" for "normalized" and "none" for "sum".

        Examples
        --------
        See `from_netcdf`.
        """
        from delone.sphere.maps import write_map

        kind = as_choice(layout, ("esmf", "scrip", "yac"), name="layout")
        form = as_choice(format, ("NETCDF4", "NETCDF3_64BIT_DATA"), name="format")
        write_map(self, path, kind, (source, target), form, grid_names=grid_names)

    @classmethod
    def from_netcdf(
        cls,
        path: str | os.PathLike[str],
        *,
        source: Grid | None = None,
        target: Grid | None = None,
    ) -> Weights:
        """Read a map file written by ESMF, TempestRemap, SCRIP, CDO or YAC (extra ``xarray``).

        Parameters
        ----------
        path : str or path-like
            The file.
        source, target : Grid, optional
            The grids. Files that do not say how many cells these have, such as some written by YAC,
            need them. Fields then have the shapes of the grids.

        Returns
        -------
        Weights
            `method` follows from the attribute ``normalization``; "other" without one.

        Raises
        ------
        FileFormatError
            The file is not a map, does not contain the numbers of cells, a cell's number is out of
            range, or it has second-order weights with gradients.
        InputError
            A grid does not have the number of cells or the kind of sides that the file states.
        MissingExtraError
            netCDF4 is not installed.

        Notes
        -----
        Cells are numbered from 1 unless ``start_index`` or ``first_index`` says otherwise; the
        numbers themselves are never used to guess. Several entries for one pair are added. SCRIP
        weights with the normalization "none" are areas, and become "conservative". Results are
        always sums of the weights times the values: fractions that a file lacks, or that contradict
        the sums of weights, are replaced by the sums. If a file lists its dimensions in a different
        order from ESMF, the centers show which one varies fastest.

        Second-order weights, and those with negative entries, have `order` 2: they are not areas,
        and with ``skipna=True``, missing values raise an error.

        Examples
        --------
        >>> import os, tempfile
        >>> from delone import sphere
        >>> source = sphere.Grid.from_healpix(2)
        >>> target = sphere.Grid.from_lonlat([0, 180, 360], [-90, 90])
        >>> weights = sphere.Overlaps(source, target).to_weights("conservative")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "map.nc")
        ...     weights.to_netcdf(path, source=source, target=target)
        ...     sphere.Weights.from_netcdf(path)
        <Weights, conservative, 48 to 1 x 2: 52 entries>
        """
        from delone.sphere.maps import read_map

        parts, order = read_map(path, (source, target))
        if order == 1:
            return cls._of(*parts)
        return SlopedWeights._of(*parts)

    def _require_fit(self, grids: tuple[Grid | None, Grid | None]) -> None:
        """Reject a source or target whose number of cells is not that of the weights."""
        counts = len(self.source_fractions), len(self.fractions)
        for name, grid, count in zip(("source", "target"), grids, counts, strict=True):
            if grid is not None:
                require_grid(grid, name)
            if grid is not None and grid.ncells != count:
                raise InputError(f"{name} has {grid.ncells} cells, but the weights are for {count}")


class SlopedWeights(Weights):
    """Second-order weights from a map file, which does not distinguish areas from slopes.

    Examples
    --------
    >>> import os, tempfile
    >>> from delone import sphere
    >>> source, target = sphere.Grid.from_healpix(2), sphere.Grid.from_lonlat([0, 90], [0, 90])
    >>> weights = sphere.Overlaps(source, target).to_weights("conservative", order=2)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "map.nc")
    ...     weights.to_netcdf(path)
    ...     sphere.Weights.from_netcdf(path).order
    2
    """

    __slots__ = ()

    @property
    def order(self) -> int:
        """2: some entries are slopes."""
        return 2

    def __repr__(self) -> str:
        return super().__repr__().replace(f", {self._method},", f", {self._method}, order 2,", 1)

    def _mixed(self, part: Floats, skipna: bool, least: float) -> tuple[Floats, Bools]:
        if skipna and np.isnan(part).any():
            raise InputError(
                "weights of second order in a map file do not tell areas from slopes, so missing "
                "values cannot be left out: use the weights of Overlaps.to_weights(order=2) "
                "themselves, or a map of first order"
            )
        return super()._mixed(part, skipna, least)
