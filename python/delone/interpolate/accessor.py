"""Interpolation and regridding of xarray objects (extra ``xarray``): ``import delone.xarray``.

The import registers ``.delone`` on DataArray and Dataset. Scattered points are one dimension with
two coordinates (``x(station)``, ``y(station)``), or several (curvilinear ``lon(j, i)``,
``lat(j, i)``). The weights of the target points are computed once and applied to each field along
every other dimension (time, level), chunk by chunk if the data are Dask arrays. The module `places`
determines what coordinates mean.

Longitudes and latitudes, known by their units, standard names or names, are interpolated on the
sphere by the methods that `delone.sphere` has; ``planar=True`` treats them as planar coordinates.
There, two variables may be the components of a vector; the module `components` finds them.
"""

from __future__ import annotations

import importlib
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.arrays import as_flag
from delone._base.georeference import caller_level, warn_of_degrees
from delone.errors import DtypeError, InputError, MissingExtraError
from delone.interpolate.base import as_max_distance
from delone.interpolate.components import is_component, lone_message, vector_pairs
from delone.interpolate.methods import interpolator
from delone.interpolate.places import (
    angles_unit,
    bounds_of,
    places_of,
    source_rows,
    target_points,
    unit_of,
)
from delone.interpolate.raster import raster_nodes, require_memory

try:
    import xarray
except ImportError as error:
    raise MissingExtraError(
        'delone.xarray needs xarray, which is not installed: pip install "delone[xarray]"',
        extra="xarray",
    ) from error

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Sequence

    from numpy.typing import NDArray

    from delone.interpolate.places import Places
    from delone.interpolate.weights import Weights

__all__ = ["ArrayInterpolation", "DatasetInterpolation", "VariableWarning", "VectorWarning"]


class VectorWarning(UserWarning):
    """A component of a vector is interpolated alone, as numbers, which is wrong near the poles.

    Examples
    --------
    >>> from delone.xarray import VectorWarning
    >>> issubclass(VectorWarning, UserWarning)
    True
    """


class VariableWarning(UserWarning):
    """Variables of a dataset are not in the result: they have only some dimensions of the points.

    Examples
    --------
    >>> from delone.xarray import VariableWarning
    >>> issubclass(VariableWarning, UserWarning)
    True
    """


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
    >>> import delone.xarray
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
        degrees: bool | None = None,
        missing: str = "raise",
        **options: Any,
    ) -> Any:
        """Interpolate to other points.

        Parameters
        ----------
        x, y : array_like or xarray.DataArray
            One-dimensional arrays are the nodes of a grid. DataArrays are points: they are
            broadcast against each other, and each entry is a point. Their attributes ``units`` are
            converted to those of the points.
        coords : pair of str, optional
            Names of the coordinates of the array; by default x and y, lon and lat, longitude and
            latitude, or easting and northing; or those whose standard names or units are those of
            longitude and latitude. If there are planar and geographic ones, names and units of
            DataArrays given as `x` and `y` decide.
        method : str, optional
            As in `interpolator`. On the sphere ``"linear"``, ``"nearest"``, ``"sibson"`` and
            ``"laplace"``; others are planar, with a warning.
        degrees : bool, optional
            Whether angles without units are degrees, those of targets and of ``max_distance``. By
            default they are degrees if the points are in degrees; if the points are in radians, the
            unit is required.
        missing : {"raise", "drop"}, optional
            Whether places whose coordinates are NaN, as in masked grids, raise an error or are left
            out with their values.
        **options
            Options of the interpolator: ``extrapolate``, ``respect_constraints``, ``workers``,
            ``planar`` and so on. NaN among the values propagates unless ``nan="raise"`` is given.
            With ``max_distance``, targets farther than this from the nearest point get NaN; on the
            sphere it is an angle.

        Returns
        -------
        xarray.DataArray
            The dimensions of the points are replaced by those of the targets, y before x; the name,
            the attributes, the floating-point type and the other dimensions are unchanged. The
            coordinates of targets have the attributes of those of the points.

        Raises
        ------
        InputError
            The coordinates are not found, or there are several; units of the targets are needed, or
            do not fit those of the points; ``nan="drop"`` is given, which would need a separate
            triangulation for each field; or `max_distance` is negative or NaN.
        NonFiniteError
            A coordinate of the points is NaN, and `missing` is "raise".

        Warns
        -----
        delone.sphere.LongitudeWarning
            Longitudes of the points span more than one turn. Points from 0 to 360 and targets from
            -180 to 180 cause no warning: they mean the same directions.
        delone.GeographicWarning
            The coordinates are longitudes and latitudes, and the method is planar.
        delone.xarray.VectorWarning
            On the sphere, the standard name is that of a component to the east or to the north,
            such as "eastward_wind": it needs the other one, in a Dataset.

        Examples
        --------
        Stations on both sides of the date line are on the sphere:

        >>> import xarray
        >>> import delone.xarray
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
        return _interp(self._array, x, y, _Choices(coords, method, degrees, missing, options))

    def grid(
        self,
        *,
        resolution: Any = None,
        shape: tuple[int, int] | None = None,
        bounds: Sequence[float] | None = None,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        degrees: bool | None = None,
        missing: str = "raise",
        **options: Any,
    ) -> Any:
        """Interpolate to a raster.

        Parameters
        ----------
        resolution, shape, bounds
            As in `delone.interpolate.grid`. On the sphere, cells end at multiples of the
            resolution, and the raster is the whole globe if the triangles cover it, all longitudes
            if they contain a pole, and otherwise the smallest box, which may cross the date line.
            So may `bounds`: then the left one exceeds the right one.
        coords, method, degrees, missing, **options
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
        >>> import delone.xarray
        >>> stations = xarray.DataArray(
        ...     [1.0, 5.0, 9.0],
        ...     dims="station",
        ...     coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
        ... )
        >>> stations.delone.grid(shape=(2, 2)).values
        array([[ 4.,  6.],
               [ 8., nan]])
        """
        raster = {"resolution": resolution, "shape": shape, "bounds": bounds}
        choices = _Choices(coords, method, degrees, missing, options)
        return _grid(self._array, raster, choices)

    def regrid(
        self,
        target: Any,
        *,
        method: str = "conservative",
        skipna: bool = False,
        min_fraction: float = 0.0,
        fill: Any = None,
        **options: Any,
    ) -> Any:
        """Regrid from the cells of one grid on the sphere to those of another.

        Parameters
        ----------
        target : xarray.Dataset, delone.sphere.Grid or str
            Where values are wanted: what `delone.sphere.Grid.from_dataset` accepts, a grid, or its
            name, such as "1x1" in degrees or "healpix:64".
        method : str, optional
            As for `delone.xarray.Regridder`.
        skipna, min_fraction, fill
            As for `delone.sphere.Weights.apply`.
        **options
            As for `delone.xarray.Regridder`. An array has no bounds unless they are coordinates:
            regrid the dataset, or give ``infer_bounds=True``.

        Returns
        -------
        xarray.DataArray
            The dimensions of cells are replaced by those of the target; the name, the attributes,
            the other dimensions and float32 are unchanged. Dask arrays are computed lazily.

        Raises
        ------
        InputError
            As for `delone.xarray.Regridder`.

        Examples
        --------
        >>> import numpy as np, xarray
        >>> import delone.xarray
        >>> field = xarray.DataArray(
        ...     np.ones((18, 36), dtype=np.float32),
        ...     coords=[
        ...         ("lat", np.arange(-85.0, 90, 10), {"units": "degrees_north"}),
        ...         ("lon", np.arange(5.0, 360, 10), {"units": "degrees_east"}),
        ...     ],
        ... )
        >>> found = field.delone.regrid("healpix:2", infer_bounds=True)
        >>> found.dims, found.dtype.name, bool(np.allclose(found, 1))
        (('cell',), 'float32', True)
        """
        made = _regridder(self._array, target, method=method, **options)
        return made(self._array, skipna=skipna, min_fraction=min_fraction, fill=fill)


@xarray.register_dataset_accessor("delone")
class DatasetInterpolation:
    """Interpolation of all variables of a dataset that have the points: ``dataset.delone``.

    Parameters
    ----------
    dataset : xarray.Dataset
        Values at scattered points. Variables without these dimensions are unchanged. The
        coordinates and their cell bounds are not in the result; nor are variables with only some of
        the dimensions, which cause a `VariableWarning`.

    Notes
    -----
    On the sphere, two variables whose standard names differ in "eastward" and "northward" are the
    components of vectors, and interpolated as such: see `delone.sphere.Linear.vectors_at`. Their
    dimensions and ``cell_methods`` must be the same; of several with one standard name, names such
    as u10 and v10 decide. With ``vectors=[("u", "v")]`` exactly these pairs are vectors, and with
    ``vectors=[]`` none. Where one of two components is NaN, both are treated as NaN.

    Examples
    --------
    >>> import xarray
    >>> import delone.xarray
    >>> stations = xarray.Dataset(
    ...     {"height": ("station", [1.0, 5.0, 9.0])},
    ...     coords={"x": ("station", [0.0, 4.0, 0.0]), "y": ("station", [0.0, 0.0, 4.0])},
    ... )
    >>> stations.delone.interp([1.0], [1.0]).height.values
    array([[4.]])

    A wind from Greenwich across the North Pole to the date line, at the pole as seen from two
    meridians:

    >>> stations = xarray.Dataset(
    ...     {"u": ("station", [0.0, 9.0, 0.0, -9.0]), "v": ("station", [9.0, 0.0, -9.0, 0.0])},
    ...     coords={
    ...         "lon": ("station", [0.0, 90.0, 180.0, -90.0]),
    ...         "lat": ("station", [80.0, 80.0, 80.0, 80.0]),
    ...     },
    ... )
    >>> found = stations.delone.interp([0.0, 90.0], [90.0], vectors=[("u", "v")])
    >>> (found.u.values.round(6) + 0.0).tolist(), (found.v.values.round(6) + 0.0).tolist()
    ([[0.0, 9.0]], [[9.0, 0.0]])
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
        degrees: bool | None = None,
        missing: str = "raise",
        vectors: Sequence[tuple[Hashable, Hashable]] | None = None,
        **options: Any,
    ) -> Any:
        """Interpolate to other points; see `ArrayInterpolation.interp`, and above for `vectors`."""
        choices = _Choices(coords, method, degrees, missing, options, vectors)
        return _interp(self._dataset, x, y, choices)

    def grid(
        self,
        *,
        resolution: Any = None,
        shape: tuple[int, int] | None = None,
        bounds: Sequence[float] | None = None,
        coords: Sequence[str] | None = None,
        method: str = "linear",
        degrees: bool | None = None,
        missing: str = "raise",
        vectors: Sequence[tuple[Hashable, Hashable]] | None = None,
        **options: Any,
    ) -> Any:
        """Interpolate to a raster; see `ArrayInterpolation.grid`, and above for `vectors`."""
        raster = {"resolution": resolution, "shape": shape, "bounds": bounds}
        choices = _Choices(coords, method, degrees, missing, options, vectors)
        return _grid(self._dataset, raster, choices)

    def regrid(
        self,
        target: Any,
        *,
        method: str = "conservative",
        skipna: bool = False,
        min_fraction: float = 0.0,
        fill: Any = None,
        **options: Any,
    ) -> Any:
        """Regrid all variables with the cells to another grid; see `ArrayInterpolation.regrid`."""
        made = _regridder(self._dataset, target, method=method, **options)
        return made(self._dataset, skipna=skipna, min_fraction=min_fraction, fill=fill)


def _regridder(*args: Any, **options: Any) -> Any:
    # By its name: that package builds on this one.
    return importlib.import_module("delone.sphere.regridder").Regridder(*args, **options)


class _Choices(NamedTuple):
    """What the caller has chosen, except for the targets."""

    coords: Sequence[str] | None
    method: str
    degrees: bool | None
    missing: str
    options: dict[str, Any]
    vectors: Sequence[tuple[Hashable, Hashable]] | None = None


class _Sites(NamedTuple):
    """Places, and the interpolator of those that have coordinates."""

    places: Places
    # The places that are used; None for all.
    rows: NDArray[np.int64] | None
    points: NDArray[np.float64]
    made: Any
    # `delone.sphere.methods`; None in the plane.
    globe: Any
    limit: float | None
    degrees: bool | None

    @property
    def planar(self) -> bool:
        """Whether angles, if they are any, are planar coordinates."""
        return self.globe is None


def _sites(data: Any, targets: Sequence[Any], choices: _Choices) -> _Sites:
    """Find the coordinates and triangulate them."""
    options = dict(choices.options)
    limit = as_max_distance(options.pop("max_distance", None))
    planar = options.pop("planar", False)
    if options.get("nan") == "drop":
        raise InputError("nan='drop' needs a triangulation per field; fill or drop NaN first")
    options = {"nan": "propagate"} | options
    places = places_of(data, choices.coords, targets)
    if choices.degrees is not None:
        as_flag(choices.degrees, name="degrees")
    if choices.degrees is not None and places.by is None:
        raise InputError(
            f"degrees is for longitudes and latitudes, and {' and '.join(map(str, places.names))} "
            "are not known to be: name others with coords=, or set their attributes units"
        )
    points = places.points
    rows = source_rows(points, choices.missing)
    points = points if rows is None else points[rows]
    # By its name: that package builds on this one.
    globe = importlib.import_module("delone.sphere.methods")
    method = choices.method
    if planar is False and places.by and method in globe.METHODS and places.may_be_angles(points):
        in_degrees = not places.in_radians
        made = globe.interpolator(points, method=method, degrees=in_degrees, **options)
        if limit is not None:
            unit = angles_unit(places, choices.degrees, "the numbers of max_distance")
            limit *= _turns(unit == "degrees", in_degrees)
        return _Sites(places, rows, points, made, globe, limit, choices.degrees)
    warn_of_degrees(None, points, planar=planar, name="coordinates", by=places.by)
    made = interpolator(points, method=method, **options)
    return _Sites(places, rows, points, made, None, limit, choices.degrees)


def _turns(degrees: bool, wanted: bool) -> float:
    """The factor that converts an angle from one unit, degrees or radians, to the other."""
    if degrees == wanted:
        return 1.0
    return float(np.degrees(1.0) if wanted else np.radians(1.0))


def _interp(data: Any, x: Any, y: Any, choices: _Choices) -> Any:
    targets = [part for part in (x, y) if isinstance(part, xarray.DataArray)]
    sites = _sites(data, targets if len(targets) == 2 else (), choices)
    return _interpolated(data, sites, _target(x, y, sites), choices.vectors)


def _grid(data: Any, raster: dict[str, Any], choices: _Choices) -> Any:
    sites = _sites(data, (), choices)
    points, unit = sites.points, None
    if sites.globe is not None:
        unit = "radians" if sites.degrees is False else "degrees"
        if raster["shape"] is None or raster["bounds"] is not None:
            unit = angles_unit(sites.places, sites.degrees, "the numbers of the raster")
        points = points * _turns(not sites.places.in_radians, unit == "degrees")
    if unit == "degrees":
        mesh = sites.made.triangulation
        nodes = sites.globe.globe_nodes(mesh, points, **raster)
    else:
        nodes = raster_nodes((points.min(axis=0), points.max(axis=0)), **raster)
    return _interpolated(data, sites, _nodes(nodes, sites, unit), choices.vectors)


def _target(x: Any, y: Any, sites: _Sites) -> tuple[Any, Any]:
    """Targets as two arrays of the same dimensions, with their coordinates attached."""
    if isinstance(x, xarray.DataArray) and isinstance(y, xarray.DataArray):
        # Rows before columns, as for nodes.
        up, across = xarray.broadcast(y, x)
        for axis, (name, given) in enumerate(zip(sites.places.names, (x, y), strict=True)):
            if name in across.coords or (name in across.dims and given.dims != (name,)):
                continue
            attrs = given.attrs or _described(sites, axis, None)
            across = across.assign_coords({name: (given.dims, given.data, attrs)})
        return across, up
    if any(np.ndim(axis) != 1 for axis in (x, y)):
        raise InputError(
            "x and y must both be DataArrays, or both one-dimensional arrays: nodes of a grid"
        )
    return _nodes((x, y), sites, None)


def _nodes(nodes: Sequence[Any], sites: _Sites, unit: str | None) -> tuple[Any, Any]:
    """Nodes of a grid as two arrays; in a given unit, or in the one that they declare."""
    parts = []
    for axis, (name, node) in enumerate(zip(sites.places.names, nodes, strict=True)):
        said = unit or unit_of(node, axis)
        attrs = getattr(node, "attrs", None) or _described(sites, axis, said)
        values = np.asarray(node, dtype=np.float64)
        part = xarray.DataArray(values, dims=name, coords={name: (name, values, attrs)})
        part.attrs = dict(attrs)
        parts.append(part)
    up, across = xarray.broadcast(parts[1], parts[0])
    return across, up


def _described(sites: _Sites, axis: int, unit: str | None) -> dict[str, Any]:
    """Attributes of a coordinate of the result: those of the points, with the unit of targets."""
    part = sites.places.parts[axis]
    attrs = {name: value for name, value in part.attrs.items() if name != "bounds"}
    if sites.globe is not None:
        in_radians = sites.places.in_radians
        if unit is None:
            unit = angles_unit(sites.places, sites.degrees, "the targets")
        if unit != ("radians" if in_radians else "degrees"):
            attrs["units"] = ("degrees_east", "degrees_north")[axis]
            if unit == "radians":
                attrs["units"] = "radian"
    return attrs


def _interpolated(data: Any, sites: _Sites, target: tuple[Any, Any], vectors: Any) -> Any:
    """Interpolate the variables that have the points, and mask targets too far from them."""
    dims = sites.places.dims
    _require_memory(data, dims, target)
    lonlat, degrees = target_points(sites.places, target, sites.degrees, planar=sites.planar)
    queries = lonlat
    if sites.globe is not None:
        queries = sites.globe.directions(lonlat, degrees=degrees)
    near = None if sites.limit is None else sites.made.distance(queries) <= sites.limit
    geometry = _Geometry(sites.made.weights_at(queries), dims, target, near, sites.rows)
    # Coordinates of the points are not coordinates of the result.
    gone = [name for name, part in data.coords.items() if set(part.dims) & set(dims)]
    plain = data.drop_vars(gone)
    if not isinstance(plain, xarray.Dataset):
        if not sites.planar and is_component(plain):
            _warn_of_components([plain.name or "array"], alone=True)
        _require_free([(plain.name or "array", plain)], geometry)
        return _applied(plain, geometry)
    names, others = _variables(data, plain, sites)
    plain = plain.drop_vars(others)
    _require_free(plain.variables.items(), geometry)
    pairs = _pairs(plain, names, sites, vectors)
    paired = {name for pair in pairs for name in pair}
    found = {name: _applied(plain[name], geometry) for name in names if name not in paired}
    if pairs:
        table = sites.globe.vector_weights(sites.made, geometry.table, lonlat, degrees=degrees)
        for pair in pairs:
            both = _applied_to_pair([plain[name] for name in pair], table, geometry)
            found |= dict(zip(pair, both, strict=True))
    return plain.drop_vars(names).assign({name: found[name] for name in names})


def _pairs(plain: Any, names: list[Any], sites: _Sites, vectors: Any) -> list[tuple[Any, Any]]:
    """The pairs of variables that are vectors; warn about unpaired components."""
    if sites.planar:
        if vectors:
            raise InputError(
                "vectors= is for the sphere: these coordinates or this method are planar, where "
                "components are interpolated as they are"
            )
        return []
    pairs, lone = vector_pairs(plain, names, vectors)
    if lone:
        _warn_of_components(lone, alone=False)
    return pairs


def _warn_of_components(names: Iterable[Any], *, alone: bool) -> None:
    message = lone_message(names, alone=alone)
    warnings.warn(message, VectorWarning, stacklevel=caller_level())


def _require_free(parts: Iterable[tuple[Any, Any]], geometry: _Geometry) -> None:
    """Reject variables that keep a dimension that the targets also have."""
    targets = set(geometry.target[0].dims)
    for name, part in parts:
        both = targets & set(part.dims) - set(geometry.dims)
        if both:
            raise InputError(
                f"{name!r:.80} and the targets have the dimension {min(map(str, both))!r:.80}: "
                "drop or rename one of them"
            )


def _variables(data: Any, plain: Any, sites: _Sites) -> tuple[list[Any], list[Any]]:
    """The variables that are interpolated, and those that are not in the result.

    The latter are the coordinates, their cell bounds, and variables with only some dimensions.
    """
    dims = set(sites.places.dims)
    along = [data[name] for name in dims if name in data.variables]
    ours = bounds_of(data, [*sites.places.parts, *along]) | set(sites.places.names)
    some = [name for name, part in plain.data_vars.items() if dims & set(part.dims)]
    names = [name for name in some if name not in ours and dims <= set(plain[name].dims)]
    for name in names:
        kind = plain[name].dtype
        if kind.kind not in "iufc":
            raise DtypeError(f"variable {name!r:.80} is not numeric (dtype {kind}); drop it")
    others = [name for name in some if name not in names]
    partial = [name for name in others if name not in ours]
    if partial:
        listed = ", ".join(f"{name} ({', '.join(map(str, plain[name].dims))})" for name in partial)
        warnings.warn(
            f"{listed:.160}: not in the result, because the points have the dimensions "
            f"{', '.join(map(str, sites.places.dims))}; drop such variables, or expand them",
            VariableWarning,
            stacklevel=caller_level(),
        )
    return names, [name for name in {*others, *ours} if name in plain.variables]


class _Geometry(NamedTuple):
    """The data that all fields on the same points share."""

    table: Weights
    # The dimensions of the points.
    dims: tuple[Any, ...]
    target: tuple[Any, Any]
    # Whether each target is close enough to a site, in the shape of the targets; None if all are.
    near: NDArray[np.bool_] | None
    # The points that have coordinates; None for all.
    rows: NDArray[np.int64] | None


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
    kwargs = {"table": geometry.table, "rows": geometry.rows}
    return _computed(_last_axes, [array], geometry, kwargs)


def _applied_to_pair(pair: list[Any], table: Any, geometry: _Geometry) -> list[Any]:
    """Interpolate the components of vectors by the table for vectors."""
    kwargs = {"table": table, "rows": geometry.rows}
    found = _computed(_last_axes_of_pair, pair, geometry, kwargs)
    for part, array in zip(found, pair, strict=True):
        part.attrs = dict(array.attrs)
    kept = [[dim for dim in array.dims if dim not in geometry.dims] for array in pair]
    target = geometry.target[0].dims
    return [
        part.transpose(*dims, *target).rename(array.name)
        for part, dims, array in zip(found, kept, pair, strict=True)
    ]


def _computed(
    function: Callable[..., Any], arrays: list[Any], geometry: _Geometry, kwargs: dict[str, Any]
) -> Any:
    """Apply a function of the last axes, which are the points, to arrays; as many results."""
    dims, (across, _), near = geometry.dims, geometry.target, geometry.near
    # Computed in doubles, and stored in the type of the fields; integers become doubles.
    kinds = [part.dtype if part.dtype.kind in "fc" else np.dtype(np.float64) for part in arrays]
    if any(kind.kind == "c" for kind in kinds):
        kinds = [np.result_type(kind, np.complex64) for kind in kinds]
    found = xarray.apply_ufunc(
        function,
        *arrays,
        kwargs={"count": len(dims), "kinds": kinds, **kwargs},
        input_core_dims=[dims] * len(arrays),
        output_core_dims=[across.dims] * len(arrays),
        exclude_dims=set(dims),
        dask="parallelized",
        output_dtypes=kinds,
        dask_gufunc_kwargs={
            "output_sizes": dict(zip(across.dims, across.shape, strict=True)),
            "allow_rechunk": True,
        },
        keep_attrs=True,
    )
    every = list(found) if len(arrays) > 1 else [found]
    if near is not None:
        every = [part.where(xarray.DataArray(near, dims=across.dims)) for part in every]
    every = [part.assign_coords(across.coords) for part in every]
    return every if len(arrays) > 1 else every[0]


def _last_axes(
    values: NDArray[Any],
    *,
    table: Weights,
    count: int,
    rows: NDArray[np.int64] | None,
    kinds: Sequence[np.dtype[Any]],
) -> NDArray[Any]:
    """Interpolate along the last axes, which are the points; the other axes are fields."""
    fields = _points_first(values, count)
    found = table.apply(fields if rows is None else fields[rows])
    return _points_last(found, len(table.query_shape), kinds[0])


def _last_axes_of_pair(
    east: NDArray[Any],
    north: NDArray[Any],
    *,
    table: Any,
    count: int,
    rows: NDArray[np.int64] | None,
    kinds: Sequence[np.dtype[Any]],
) -> tuple[NDArray[Any], ...]:
    """Interpolate two components along the last axes, which are the points."""
    pair = np.stack([_points_first(part, count) for part in (east, north)], axis=1)
    found = table.apply(pair if rows is None else pair[rows])
    width = len(table.table.query_shape)
    parts = np.moveaxis(found, width, 0)
    return tuple(_points_last(part, width, kind) for part, kind in zip(parts, kinds, strict=True))


def _points_first(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Values with the points, the last axes, as the first axis."""
    leading = values.shape[: values.ndim - count]
    return np.moveaxis(values.reshape(*leading, -1), -1, 0)


def _points_last(found: NDArray[Any], width: int, kind: np.dtype[Any]) -> NDArray[Any]:
    """Results with the axes of the targets, the first ones, at the end."""
    order = (*range(width, found.ndim), *range(width))
    return np.ascontiguousarray(found.transpose(order), dtype=kind)
