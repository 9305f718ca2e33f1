"""The class Regridder: xarray datasets and arrays from one grid on the sphere to another."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_choice, as_flag, as_number
from delone._base.counting import counted
from delone._base.extras import require
from delone._base.georeference import caller_level
from delone._base.immutable import Immutable
from delone.areal.weights import METHODS
from delone.errors import DtypeError, InputError, ShapeError
from delone.sphere.formats import Choices
from delone.sphere.grid import Grid
from delone.sphere.overlaps import Overlaps
from delone.sphere.pointwise import POINTWISE, refuse_neighbors
from delone.sphere.targets import side_of
from delone.sphere.weights import Weights

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.sphere.targets import Side

__all__ = ["Regridder"]

# Attributes of fields that refer to the grid they were on.
_REFERRING = ("mesh", "location", "grid_mapping", "coordinates", "cell_measures")


class Regridder(Immutable):
    """Regrids xarray datasets and arrays (extra ``xarray``).

    Parameters
    ----------
    source : xarray.Dataset, xarray.DataArray, uxarray.Grid, Grid or str
        Where fields are: what `Grid.from_dataset` accepts, a grid, or its name: "1x1" in degrees of
        longitude and latitude, "healpix:64", "healpix:64:nested", "n80" and "o80" for Gaussian
        grids, full and octahedral.
    target : xarray.Dataset, xarray.DataArray, uxarray.Grid, Grid or str
        Where fields are wanted; like `source`.
    method : {"conservative", "normalized", "sum", "majority"} or str, optional
        As for `Overlaps.to_weights`; or for `Weights.between`: "linear", "bilinear", "sibson",
        "laplace", "nearest", "binned", "inverse_distance".
    order, limiter : optional
        As for `Overlaps.to_weights`: ``order=2`` gives source cells slopes.
    source_mask, target_mask : array_like of bool, optional
        True for the cells to use. By default the masks of the datasets, if they have any.
    dims : sequence of str, optional
        Dimensions of fields on the source, in the order of its shape. By default those of the
        dataset; for a `Grid`, the last dimensions of each field that have its shape.
    extrapolate, power, neighbors : optional
        As for `Weights.between`, for its methods.
    weights : Weights, str or path-like, optional
        Use these weights, or those in a map file, instead of computing them. They determine
        `method` and masks.
    coords, degrees, infer_bounds, cells, merge, workers
        As for `Grid.from_dataset`; `coords` and `cells` are those of the source.

    Attributes
    ----------
    source, target : Grid
        The grids.
    weights : Weights
        What each source cell contributes.
    source_dims : tuple or None
        Dimensions of fields on the source; None if they follow from the shape of each field.
    target_dims : tuple
        Dimensions of results on the target.

    Raises
    ------
    InputError, DirectionError, ShapeError, DtypeError
        As for `Grid.from_dataset` and `Overlaps.to_weights`; or `weights` have different sizes.
    MissingExtraError
        xarray is not installed.

    Notes
    -----
    Fields may be Dask arrays: other dimensions remain chunked, and are computed lazily. The weights
    are a single object in the task graph.

    See Also
    --------
    Overlaps : The areas that cells share.

    Examples
    --------
    >>> import numpy as np, xarray
    >>> from delone.xarray import Regridder
    >>> ds = xarray.Dataset(
    ...     {"rain": (("time", "lat", "lon"), np.ones((2, 180, 360), dtype=np.float32))},
    ...     coords={
    ...         "lon": ("lon", np.arange(0.5, 360), {"units": "degrees_east"}),
    ...         "lat": ("lat", np.arange(-89.5, 90), {"units": "degrees_north"}),
    ...     },
    ... )
    >>> regridder = Regridder(ds, "healpix:8", infer_bounds=True)
    >>> regridder
    <Regridder, conservative, 180 x 360 to 768>
    >>> found = regridder(ds)
    >>> found.rain.dims, found.rain.dtype.name, bool(np.allclose(found.rain, 1))
    (('time', 'cell'), 'float32', True)
    """

    __slots__ = ("_dims", "_sides", "_weights")

    _dims: tuple[Any, ...] | None
    _sides: tuple[Side, Side]
    _weights: Weights

    def __init__(
        self,
        source: Any,
        target: Any,
        *,
        method: str = "conservative",
        order: int = 1,
        limiter: bool = False,
        source_mask: ArrayLike | None = None,
        target_mask: ArrayLike | None = None,
        extrapolate: str = "nan",
        power: float = 2.0,
        neighbors: int | None = None,
        dims: Sequence[Any] | None = None,
        weights: Weights | str | os.PathLike[str] | None = None,
        coords: tuple[str, str] | None = None,
        degrees: bool | None = None,
        infer_bounds: bool = False,
        cells: str | None = None,
        merge: float = 1e-12,
        workers: int | None = None,
    ) -> None:
        require("xarray", extra="xarray", what="regridding datasets")
        as_choice(method, METHODS + POINTWISE, name="method")
        unit = None if degrees is None else as_flag(degrees, name="degrees")
        infer = as_flag(infer_bounds, name="infer_bounds")
        near = as_number(merge, name="merge")
        choices = Choices(None, None, None, unit, infer, None, near, workers)
        place = None if cells is None else as_choice(cells, ("nodes", "faces"), name="cells")
        if place is not None and isinstance(source, Grid | str):
            raise InputError("cells is for datasets: make the grid by Grid.from_dataset(cells=)")
        sides = (
            side_of(source, choices._replace(coords=coords, cells=place), "source"),
            side_of(target, choices, "target"),
        )
        grids = sides[0].grid, sides[1].grid
        if weights is None:
            masks = [
                grid.mask if mask is None else mask
                for grid, mask in zip(grids, (source_mask, target_mask), strict=True)
            ]
            given: dict[str, Any] = {"source_mask": masks[0], "target_mask": masks[1]}
            if method in POINTWISE:
                if order != 1 or limiter:
                    raise InputError(
                        f"order and limiter are for conservative and normalized, got {method!r:.60}"
                    )
                given |= {"extrapolate": extrapolate, "power": power, "neighbors": neighbors}
                weights = Weights.between(*grids, method, workers=workers, **given)
            else:
                refuse_neighbors(neighbors, method)
                shared = Overlaps(*grids, workers=workers)
                weights = shared.to_weights(method, order=order, limiter=limiter, **given)
        else:
            if isinstance(weights, str | os.PathLike):
                weights = Weights.from_netcdf(weights, source=grids[0], target=grids[1])
            _require_fit(weights, grids)
        own = sides[0].dims if dims is None else tuple(dims)
        if own is not None and len(own) != len(grids[0].grid_shape):
            raise ShapeError(f"dims must be those of {grids[0].grid_shape}, got {own}")
        self._hold(dims=own, sides=sides, weights=weights)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self)._again, (self._dims, self._sides, self._weights)

    @classmethod
    def _again(cls, dims: Any, sides: tuple[Side, Side], weights: Weights) -> Regridder:
        made = cls.__new__(cls)
        made._hold(dims=dims, sides=sides, weights=weights)
        return made

    def __repr__(self) -> str:
        parts = [self._weights.method]
        parts.append(
            " to ".join(" x ".join(map(str, side.grid.grid_shape)) for side in self._sides)
        )
        for name, side in zip(("source", "target"), self._sides, strict=True):
            if count := len(side.grid.report.masked):
                parts.append(f"{counted(count, f'{name} cell')} masked")
        return f"<Regridder, {', '.join(parts)}>"

    @property
    def source(self) -> Grid:
        """The grid where fields are."""
        return self._sides[0].grid

    @property
    def target(self) -> Grid:
        """The grid where they are wanted."""
        return self._sides[1].grid

    @property
    def weights(self) -> Weights:
        """The contribution of each source cell to each target cell."""
        return self._weights

    @property
    def source_dims(self) -> tuple[Any, ...] | None:
        """The dimensions of fields on the source; None if they follow from their shapes."""
        return self._dims

    @property
    def target_dims(self) -> tuple[Any, ...]:
        """The dimensions of results on the target."""
        dims = self._sides[1].dims
        assert dims is not None
        return dims

    def __call__(
        self, data: Any, *, skipna: bool = False, min_fraction: float = 0.0, fill: Any = None
    ) -> Any:
        """Return fields on the target.

        Parameters
        ----------
        data : xarray.Dataset or xarray.DataArray
            Fields on the source.
        skipna, min_fraction, fill
            As for `Weights.apply`.

        Returns
        -------
        xarray.Dataset or xarray.DataArray
            The dimensions of the source are replaced by those of the target, at the place of the
            first of them; names, attributes, other dimensions and float32 are unchanged. Variables
            of a dataset without dimensions of the source are unchanged. Variables that describe the
            source, such as bounds, are replaced by those that describe the target.

        Raises
        ------
        ShapeError
            A field does not have the shape of the source.
        DtypeError
            A variable is not numeric.
        InputError
            A field keeps a dimension that the target has, too; or as for `Weights.apply`.

        Warns
        -----
        delone.xarray.VariableWarning
            Variables have only some of the dimensions of the source, and are not in the result.
        """
        xarray = require("xarray", extra="xarray", what="regridding datasets")
        options = {"skipna": skipna, "min_fraction": min_fraction, "fill": fill}
        if isinstance(data, xarray.Dataset):
            if type(data) is not xarray.Dataset:
                # A uxarray array has its own grid, which is not that of the result.
                parts = [
                    {name: data.variables[name] for name in names}
                    for names in (data.data_vars, data.coords)
                ]
                data = xarray.Dataset(*parts, attrs=data.attrs)
            return self._of_dataset(data, options)
        if not isinstance(data, xarray.DataArray):
            raise DtypeError(f"data must be xarray objects, got {type(data).__name__}")
        dims = self._dims_of(data, data.name)
        gone = [name for name, part in data.coords.items() if set(part.dims) & set(dims)]
        return self._of_array(data.drop_vars(gone), dims, options)

    def _dims_of(self, array: Any, name: Any) -> tuple[Any, ...]:
        """Return the dimensions of a field that are those of the source."""
        shape = self.source.grid_shape
        if self._dims is None:
            if array.shape[len(array.shape) - len(shape) :] == shape:
                found: tuple[Any, ...] = array.dims[len(array.dims) - len(shape) :]
                return found
            raise ShapeError(
                f"{name!s:.60}: the last dimensions must have the shape {shape} of the source, got "
                f"{dict(array.sizes)}: name them with dims="
            )
        sizes = tuple(array.sizes.get(dim) for dim in self._dims)
        if sizes != shape:
            raise ShapeError(
                f"{name!s:.60} must have the dimensions {self._dims} of shape {shape}, got "
                f"{dict(array.sizes)}"
            )
        return self._dims

    def _of_array(self, array: Any, dims: tuple[Any, ...], options: dict[str, Any]) -> Any:
        """Return a field without coordinates of the source on the target."""
        xarray = require("xarray", extra="xarray", what="regridding datasets")
        target, on_target = self._sides[1], self.target_dims
        name = array.name
        if array.dtype.kind not in "iufb":
            raise DtypeError(f"variable {name!s:.60} is not numeric (dtype {array.dtype}): drop it")
        others = [dim for dim in array.dims if dim not in dims]
        both = set(others) & set(on_target)
        if both:
            raise InputError(
                f"{name!s:.60} and the target have the dimension {min(map(str, both))!r:.60}: "
                "rename one of them"
            )
        ordered = array.transpose(*others, *dims)
        kind = array.dtype
        if self._weights.method != "majority":
            kind = np.dtype(np.float32 if kind == np.float32 else np.float64)
        given = array.variable.chunks is not None
        options = options | {"count": len(dims), "shape": self.target.grid_shape}
        if given:
            data = self._chunked(ordered.data, dims, kind, options)
        else:
            data = _last(ordered.values, weights=self._weights, **options)
        # The former place of the first dimension of the source.
        first = min(array.dims.index(dim) for dim in dims)
        place = sum(dim not in dims for dim in array.dims[:first])
        attrs = {key: value for key, value in array.attrs.items() if key not in _REFERRING}
        found = xarray.DataArray(
            data,
            dims=(*others, *on_target),
            coords={**array.coords, **target.coords},
            name=name,
            attrs=attrs | target.attrs,
        )
        return found.transpose(*others[:place], *on_target, *others[place:])

    def _chunked(
        self, data: Any, dims: tuple[Any, ...], kind: np.dtype[Any], options: dict[str, Any]
    ) -> Any:
        """Return the lazy result of a Dask array, whose last axes are those of the source."""
        dask = require("dask", extra="dask", what="regridding Dask arrays")
        arrays = require("dask.array", extra="dask", what="regridding Dask arrays")
        shape = self.target.grid_shape
        whole = data.rechunk(dict.fromkeys(range(data.ndim - len(dims), data.ndim), -1))
        ins = ",".join(f"i{k}" for k in range(len(dims)))
        outs = ",".join(f"o{k}" for k in range(len(shape)))
        return arrays.apply_gufunc(
            _last,
            f"({ins})->({outs})",
            whole,
            output_sizes={f"o{k}": size for k, size in enumerate(shape)},
            output_dtypes=kind,
            # One object in the graph, instead of one in each task.
            weights=dask.delayed(self._weights, traverse=False),
            **options,
        )

    def _of_dataset(self, data: Any, options: dict[str, Any]) -> Any:
        """Return a dataset on the target."""
        dims = self._dims
        if dims is None:
            dims = self._dims_of_dataset(data)
        source, target = self._sides
        ours = {str(name) for name in source.describing}
        fields, partial, gone = [], [], []
        for name, part in data.variables.items():
            if str(name) in ours or (name in data.coords and set(part.dims) & set(dims)):
                gone.append(name)
            elif set(dims) <= set(part.dims):
                fields.append(name)
            elif set(dims) & set(part.dims):
                partial.append(name)
        # Bounds are dropped with their coordinates.
        bounds = {data[name].attrs.get("bounds") for name in gone}
        partial = [name for name in partial if name not in bounds]
        if partial:
            self._warn(data, partial, dims)
        plain = data.drop_vars([name for name in gone if name in data.coords])
        found = {}
        for name in fields:
            if name not in bounds:
                array = plain[name]
                self._dims_fit(array, name, dims)
                found[name] = self._of_array(array, dims, options)
        kept = data.drop_dims([dim for dim in dims if dim in data.dims]).drop_vars(
            [
                name
                for name in gone
                if name in data.variables and not set(data[name].dims) & set(dims)
            ]
        )
        result = kept.assign(found).assign_coords(target.coords)
        others = {
            name: value for name, value in target.others.items() if name not in result.variables
        }
        return result.assign(others)

    def _dims_of_dataset(self, data: Any) -> tuple[Any, ...]:
        """Return the last dimensions of a field that together have the shape of the source."""
        shape = self.source.grid_shape
        found: set[tuple[Any, ...]] = {
            part.dims[len(part.dims) - len(shape) :]
            for part in data.data_vars.values()
            if part.shape[len(part.shape) - len(shape) :] == shape
        }
        if len(found) != 1:
            many = "several" if found else "no"
            raise ShapeError(
                f"{many} last dimensions of fields have the shape {shape} of the source: name them "
                "with dims="
            )
        return found.pop()

    def _dims_fit(self, array: Any, name: Any, dims: tuple[Any, ...]) -> None:
        sizes = tuple(array.sizes[dim] for dim in dims)
        if sizes != self.source.grid_shape:
            raise ShapeError(
                f"{name!s:.60} must have the shape {self.source.grid_shape} along {dims}, got "
                f"{sizes}"
            )

    def _warn(self, data: Any, partial: list[Any], dims: tuple[Any, ...]) -> None:
        from delone.interpolate.accessor import VariableWarning

        listed = ", ".join(f"{name} ({', '.join(map(str, data[name].dims))})" for name in partial)
        warnings.warn(
            f"{listed:.160}: not in the result, because fields have the dimensions "
            f"{', '.join(map(str, dims))}; drop such variables, or expand them",
            VariableWarning,
            stacklevel=caller_level(),
        )


def _last(
    values: NDArray[Any], *, weights: Weights, count: int, shape: tuple[int, ...], **options: Any
) -> NDArray[Any]:
    """Regrid along the last axes."""
    lead = values.shape[: values.ndim - count]
    found = weights.apply(values.reshape(*lead, -1), **options)
    return found.reshape(lead + shape)


def _require_fit(weights: Weights, grids: tuple[Grid, Grid]) -> None:
    """Reject weights that belong to different grids."""
    if not isinstance(weights, Weights):
        raise DtypeError(f"weights must be sphere.Weights, got {type(weights).__name__}")
    weights._require_fit(grids)
