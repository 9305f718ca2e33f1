"""Interpolation of xarray objects (extra ``xarray``): ``import delone.interpolate.accessor``.

The import registers ``.delone`` on DataArray and Dataset. Scattered points are one dimension with
two coordinates (``x(station)``, ``y(station)``), or several (curvilinear ``lon(j, i)``,
``lat(j, i)``). The weights of the target points are computed once and applied to each field along
every other dimension (time, level), chunk by chunk if the data are Dask arrays.

Longitudes and latitudes, known by their units, standard names or names, are interpolated on the
sphere by the methods that `delone.sphere` has; ``planar=True`` takes them as planar coordinates.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.errors import DtypeError, InputError, MissingExtraError
from delone.georeference import may_be_degrees, names_degrees, warn_of_degrees
from delone.interpolate.base import as_max_distance
from delone.interpolate.methods import interpolator
from delone.interpolate.raster import raster_nodes, require_memory

try:
    import xarray
except ImportError as error:
    raise MissingExtraError(
        "delone.interpolate.accessor needs xarray, which is not installed: "
        'pip install "delone[xarray]"',
        extra="xarray",
    ) from error

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone.interpolate.weights import Weights

__all__ = ["ArrayInterpolation", "DatasetInterpolation"]

# Units of longitudes and latitudes, of the CF conventions and of models.
_DEGREES = tuple(
    {
        word + letter
        for word in ("degrees_", "degree_", "degrees", "degree")
        for letter in (*letters, *(name.casefold() for name in names))
    }
    for letters, names in (("e", ("east",)), ("n", ("north",)))
)
_RADIANS = {"rad", "radian", "radians"}
_NAMES = (("x", "y"), ("lon", "lat"), ("longitude", "latitude"), ("easting", "northing"))


@xarray.register_dataarray_accessor("delone")
class ArrayInterpolation:
    """Interpolation of one array: ``array.delone``.

    Parameters
    ----------
    array : xarray.DataArray
        Values at scattered points.

    Examples
    --------
    >>> import numpy as np, xarray
    >>> import delone.interpolate.accessor
    >>> stations = xarray.DataArray(
    ...     [1.0, 5.0, 9.0],
    ...     dims="station",
    ...     coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
    ...     attrs={"units": "m"},
    ... )
    >>> found = stations.delone.interp([0, 1], [0, 1, 2])
    >>> found.dims, found.attrs, found.values[:, 1].tolist()
    (('y', 'x'), {'units': 'm'}, [2.0, 4.0, 6.0])
    """

    def __init__(self, array: Any) -> None:
        self._array = array

    def interp(
        self,
        x: Any,
        y: Any,
        *,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        **options: Any,
    ) -> Any:
        """Interpolate to other points.

        Parameters
        ----------
        x, y : array_like or xarray.DataArray
            One-dimensional arrays are the nodes of a grid. DataArrays are points: they are
            broadcast against each other, and each entry is a point.
        coords : pair of str, optional
            Names of the coordinates of the array; by default x and y, lon and lat, longitude and
            latitude, or easting and northing; or those whose standard names or units are those of
            longitude and latitude.
        method : str, optional
            As in `interpolator`. On the sphere ``"linear"``, ``"nearest"``, ``"sibson"`` and
            ``"laplace"``; others are planar, with a warning.
        **options
            Options of the interpolator: ``extrapolate``, ``respect_constraints``, ``workers``,
            ``planar`` and so on. NaN among the values propagates unless ``nan="raise"`` is given.
            With ``max_distance``, targets farther than this from the nearest point get NaN; on the
            sphere it is an angle in the unit of the coordinates.

        Returns
        -------
        xarray.DataArray
            The dimensions of the points are replaced by those of the targets; the name, the
            attributes and the other dimensions are unchanged.

        Raises
        ------
        InputError
            The coordinates are not found; or ``nan="drop"`` is given, which would need a separate
            triangulation for each field; or `max_distance` is negative or NaN.

        Warns
        -----
        delone.sphere.LongitudeWarning
            Longitudes of the points are from 0 to 360 and those of the targets from -180 to 180, or
            the reverse. Both mean the same directions.
        delone.GeographicWarning
            The coordinates are longitudes and latitudes, and the method is planar.

        Examples
        --------
        Stations on both sides of the date line are on the sphere:

        >>> import xarray
        >>> import delone.interpolate.accessor
        >>> stations = xarray.DataArray(
        ...     [1.0, 3.0, 2.0],
        ...     dims="station",
        ...     coords={
        ...         "lon": ("station", [175.0, -175.0, 180.0], {"units": "degrees_east"}),
        ...         "lat": ("station", [0.0, 0.0, 8.0], {"units": "degrees_north"}),
        ...     },
        ... )
        >>> stations.delone.interp([-180.0], [0.0, 8.0]).values
        array([[2.],
               [2.]])
        """
        return _interpolated(
            self._array, _target(x, y, coords, self._array), coords, method, options
        )

    def grid(
        self,
        *,
        resolution: Any = None,
        shape: tuple[int, int] | None = None,
        bounds: Sequence[float] | None = None,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        **options: Any,
    ) -> Any:
        """Interpolate to a raster.

        Parameters
        ----------
        resolution, shape, bounds
            As in `delone.interpolate.grid`.
        coords, method, **options
            As in `interp`.

        Returns
        -------
        xarray.DataArray
            The dimensions of the points are replaced by y and x, or by the names of the
            coordinates.

        Raises
        ------
        InputError
            As for `interp`; or not exactly one of `resolution` and `shape` is given.

        Examples
        --------
        >>> import xarray
        >>> import delone.interpolate.accessor
        >>> stations = xarray.DataArray(
        ...     [1.0, 5.0, 9.0],
        ...     dims="station",
        ...     coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
        ... )
        >>> stations.delone.grid(shape=(2, 2)).values
        array([[ 4.,  6.],
               [ 8., nan]])
        """
        nodes = _raster(self._array, coords, resolution, shape, bounds)
        return self.interp(*nodes, coords=coords, method=method, **options)


@xarray.register_dataset_accessor("delone")
class DatasetInterpolation:
    """Interpolation of all variables of a dataset that have the points: ``dataset.delone``.

    Parameters
    ----------
    dataset : xarray.Dataset
        Values at scattered points. Variables without these dimensions stay as they are.

    Examples
    --------
    >>> import xarray
    >>> import delone.interpolate.accessor
    >>> stations = xarray.Dataset(
    ...     {"height": ("station", [1.0, 5.0, 9.0])},
    ...     coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
    ... )
    >>> stations.delone.interp([1.0], [1.0]).height.values
    array([[4.]])
    """

    def __init__(self, dataset: Any) -> None:
        self._dataset = dataset

    def interp(
        self,
        x: Any,
        y: Any,
        *,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        **options: Any,
    ) -> Any:
        """Interpolate to other points; see `ArrayInterpolation.interp`."""
        target = _target(x, y, coords, self._dataset)
        return _interpolated(self._dataset, target, coords, method, options)

    def grid(
        self,
        *,
        resolution: Any = None,
        shape: tuple[int, int] | None = None,
        bounds: Sequence[float] | None = None,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        **options: Any,
    ) -> Any:
        """Interpolate to a raster; see `ArrayInterpolation.grid`."""
        nodes = _raster(self._dataset, coords, resolution, shape, bounds)
        return self.interp(*nodes, coords=coords, method=method, **options)


def _coordinates(data: Any, coords: Sequence[str] | None) -> tuple[Any, Any]:
    """The two coordinates, broadcast against each other."""
    pairs = _NAMES if coords is None else (tuple(coords),)
    for pair in pairs:
        if len(pair) == 2 and all(name in data.coords for name in pair):
            return tuple(xarray.broadcast(*(data.coords[name] for name in pair)))
    if coords is None:
        found = [[part for part in data.coords.values() if _is_angle(part, k)] for k in (0, 1)]
        if all(len(parts) == 1 for parts in found):
            return tuple(xarray.broadcast(*(parts[0] for parts in found)))
    wanted = ", or ".join(" and ".join(map(str, pair)) for pair in pairs)
    raise InputError(f"found no coordinates {wanted}; name two with coords=")


def _target(x: Any, y: Any, coords: Sequence[str] | None, data: Any) -> tuple[Any, Any]:
    """Targets as two arrays of the same dimensions, with their coordinates attached."""
    if isinstance(x, xarray.DataArray) and isinstance(y, xarray.DataArray):
        return tuple(xarray.broadcast(x, y))
    nodes = [np.asarray(axis, dtype=np.float64) for axis in (x, y)]
    if any(axis.ndim != 1 for axis in nodes):
        raise InputError(
            "x and y must both be DataArrays, or both one-dimensional arrays: nodes of a grid"
        )
    names = [coordinate.name for coordinate in _coordinates(data, coords)]
    across, up = (
        xarray.DataArray(axis, dims=name, coords={name: axis})
        for axis, name in zip(nodes, names, strict=True)
    )
    up, across = xarray.broadcast(up, across)
    return across, up


def _raster(
    data: Any,
    coords: Sequence[str] | None,
    resolution: Any,
    shape: tuple[int, int] | None,
    bounds: Sequence[float] | None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    places = [np.asarray(part, dtype=np.float64) for part in _coordinates(data, coords)]
    low, high = ([float(reduce(part)) for part in places] for reduce in (np.nanmin, np.nanmax))
    return raster_nodes((low, high), resolution=resolution, shape=shape, bounds=bounds)


def _interpolated(
    data: Any,
    target: tuple[Any, Any],
    coords: Sequence[str] | None,
    method: str,
    options: dict[str, Any],
) -> Any:
    """Interpolate the variables that have the points, and mask targets too far from them."""
    limit = as_max_distance(options.pop("max_distance", None))
    if options.get("nan") == "drop":
        raise InputError("nan='drop' needs a triangulation per field; fill or drop NaN first")
    places = _coordinates(data, coords)
    _require_memory(data, places[0].dims, target)
    points = np.column_stack([np.ravel(part) for part in places]).astype(np.float64)
    planar = options.pop("planar", False)
    queries = np.stack([np.asarray(part, dtype=np.float64) for part in target], axis=-1)
    options = {"nan": "propagate"} | options
    by = _degrees(places)
    # By its name: that package builds on this one.
    sphere = importlib.import_module("delone.sphere.methods")
    if planar is False and by and method in sphere.METHODS and _may_be_angles(places, points):
        degrees = not _in_radians(places)
        sphere.warn_of_conventions(points[:, 0], queries[..., 0], degrees=degrees)
        made = sphere.interpolator(method, points, degrees=degrees, **options)
    else:
        warn_of_degrees(None, points, planar=planar, name="coordinates", by=by)
        made = interpolator(method, points, **options)
    near = None if limit is None else made.distance(queries) <= limit
    geometry = _Geometry(made.weights(queries), places[0].dims, target, near)
    # Coordinates of the points are not coordinates of the result.
    dims = geometry.dims
    gone = [name for name, part in data.coords.items() if set(part.dims) & set(dims)]
    plain = data.drop_vars(gone)
    if isinstance(plain, xarray.Dataset):
        names = [name for name, part in plain.data_vars.items() if set(dims) <= set(part.dims)]
        for name in names:
            if plain[name].dtype.kind not in "iufc":
                kind = plain[name].dtype
                raise DtypeError(f"variable {name!r} is not numeric (dtype {kind}); drop it")
        found = {name: _applied(plain[name], geometry) for name in names}
        return plain.drop_vars(names).assign(found)
    return _applied(plain, geometry)


class _Geometry(NamedTuple):
    """The data that all fields on the same points share."""

    table: Weights
    # The dimensions of the points.
    dims: tuple[Any, ...]
    target: tuple[Any, Any]
    # Whether each target is close enough to a site, in the shape of the targets; None if all are.
    near: NDArray[np.bool_] | None


def _is_angle(part: Any, axis: int) -> bool:
    """Whether the attributes of a coordinate say longitude (axis 0) or latitude (1)."""
    name = str(part.attrs.get("standard_name", "")).casefold()
    unit = str(part.attrs.get("units", "")).casefold()
    return name == ("longitude", "latitude")[axis] or unit in _DEGREES[axis]


def _degrees(places: tuple[Any, Any]) -> str | None:
    """Return what shows that the coordinates are longitudes and latitudes, or None."""
    if all(_is_angle(part, axis) for axis, part in enumerate(places)):
        found = [part.attrs.get("units") or part.attrs["standard_name"] for part in places]
        return f"units {', '.join(map(str, found))}"
    names = [str(part.name) for part in places]
    return f"coordinates {', '.join(names)}" if names_degrees(names) else None


def _in_radians(places: tuple[Any, Any]) -> bool:
    return all(str(part.attrs.get("units", "")).casefold() in _RADIANS for part in places)


def _may_be_angles(places: tuple[Any, Any], points: NDArray[np.float64]) -> bool:
    """Whether the values are in the range of angles, in the unit of the coordinates."""
    return may_be_degrees(np.degrees(points) if _in_radians(places) else points)


def _require_memory(data: Any, dims: tuple[Any, ...], target: tuple[Any, Any]) -> None:
    """Raise if the result would not fit into memory; Dask arrays are computed chunk by chunk."""
    parts = data.data_vars.values() if isinstance(data, xarray.Dataset) else [data]
    fields = 0
    for part in parts:
        if set(dims) <= set(part.dims) and part.chunks is None:
            size = part.dtype.itemsize // 8 if part.dtype.kind == "c" else 1
            fields += size * part.size // max(1, np.prod([part.sizes[dim] for dim in dims]))
    if fields:
        rows = target[0].shape[0] if target[0].ndim > 1 else 1
        require_memory(target[0].size // max(1, rows), rows, fields)


def _applied(array: Any, geometry: _Geometry) -> Any:
    table, dims, (across, _), near = geometry
    kind = np.complex128 if np.issubdtype(array.dtype, np.complexfloating) else np.float64
    found = xarray.apply_ufunc(
        _last_axes,
        array,
        kwargs={"table": table, "count": len(dims)},
        input_core_dims=[dims],
        output_core_dims=[across.dims],
        exclude_dims=set(dims),
        dask="parallelized",
        output_dtypes=[kind],
        dask_gufunc_kwargs={
            "output_sizes": dict(zip(across.dims, across.shape, strict=True)),
            "allow_rechunk": True,
        },
        keep_attrs=True,
    )
    if near is not None:
        found = found.where(xarray.DataArray(near, dims=across.dims))
    return found.assign_coords(across.coords)


def _last_axes(values: NDArray[Any], table: Weights, count: int) -> NDArray[Any]:
    """Interpolate along the last axes, which are the points; the other axes are fields."""
    leading = values.shape[: values.ndim - count]
    fields = np.moveaxis(values.reshape(*leading, -1), -1, 0)
    found = table.apply(fields)
    width = len(table.shape)
    order = (*range(width, found.ndim), *range(width))
    return np.ascontiguousarray(found.transpose(order))
