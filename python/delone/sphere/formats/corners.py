"""Conventions that list the corners of each cell: SCRIP, OASIS, GEOS-CS, and those of ICON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import wrong_shape
from delone.errors import InputError, ShapeError
from delone.sphere.formats.cells import Cells, flags_of
from delone.sphere.formats.variables import in_degrees, numbers, padded, places

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.sphere.formats.cells import Choices

    Variables = dict[str, Any]

__all__ = [
    "listed",
    "oasis_grids",
    "read_geos",
    "read_icon_corners",
    "read_oasis",
    "read_scrip",
    "scrip_names",
]


def listed(
    variables: Variables,
    names: tuple[str, str],
    arrays: tuple[NDArray[Any], NDArray[Any]],
    choices: Choices,
    *,
    fixed: bool | None = None,
) -> dict[str, Any]:
    """Return places and starts of corners, given as two arrays (n, k)."""
    degrees = [
        in_degrees(variables[name], axis, name, choices, fixed=fixed)
        for axis, name in enumerate(names)
    ]
    there, starts = padded(arrays[0], arrays[1], names)
    lon, lat = (array[there] for array in arrays)
    return {
        "nodes": places(lon, lat, (degrees[0], degrees[1]), names, choices),
        "starts": starts,
    }


def scrip_names(variables: Variables) -> tuple[str, str] | None:
    """Return the names of the corners of a SCRIP grid."""
    names = "grid_corner_lon", "grid_corner_lat"
    return names if set(names) <= set(variables) else None


def read_scrip(variables: Variables, choices: Choices) -> Cells:
    """Read a SCRIP grid."""
    names = "grid_corner_lon", "grid_corner_lat"
    lon, lat = (numbers(variables[name], name) for name in names)
    if lon.ndim != 2:
        raise wrong_shape(names[0], "(grid_size, grid_corners)", lon)
    count = len(lon)
    shape: tuple[int, ...] = (count,)
    dims = variables.get("grid_dims")
    if dims is not None:
        # The axis that varies fastest comes first.
        sizes = tuple(int(size) for size in np.ravel(dims.values)[::-1])
        if min(sizes, default=0) > 0 and int(np.prod(sizes, dtype=np.int64)) == count:
            shape = sizes
    rest: dict[str, Any] = {
        "format": "SCRIP",
        "dims": variables[names[0]].dims[:1] if len(shape) == 1 else (),
        "shape": shape,
        "mask": flags_of(variables.get("grid_imask"), count),
    }
    if choices.edges == "parallel":
        degrees = [
            in_degrees(variables[name], axis, name, choices) for axis, name in enumerate(names)
        ]
        x, y = (
            values if known else np.degrees(values)
            for values, known in zip((lon, lat), degrees, strict=True)
        )
        return Cells(**rest, **_boxes(x, y, shape))
    return Cells(**rest, **listed(variables, names, (lon, lat), choices))


def _boxes(lon: NDArray[Any], lat: NDArray[Any], shape: tuple[int, ...]) -> dict[str, Any]:
    """Return the edges of columns and rows, on which all corners must lie."""
    refusal = InputError(
        'edges="parallel" needs cells between meridians and parallels, in rows and columns, and '
        "the corners of this SCRIP grid are others"
    )
    if len(shape) != 2:
        raise refusal
    x, y = lon.reshape(*shape, -1), lat.reshape(*shape, -1)
    west, east = x.min(axis=2)[0], x.max(axis=2)[0]
    south, north = y.min(axis=2)[:, 0], y.max(axis=2)[:, 0]
    across = (x == west[:, None]) | (x == east[:, None])
    up = (y == south[:, None, None]) | (y == north[:, None, None])
    if not (across.all() and up.all()):
        raise refusal
    return {
        "columns": np.column_stack((west, east)),
        "rows": np.column_stack((south, north)),
    }


def oasis_grids(variables: Variables) -> list[str]:
    """Return the names of the OASIS grids."""
    names = [name[:-4] for name in variables if name.endswith(".clo")]
    return [name for name in names if f"{name}.cla" in variables]


def read_oasis(variables: Variables, choices: Choices) -> Cells:
    """Read one of the grids in an OASIS file; angles are in degrees."""
    known = oasis_grids(variables)
    name = choices.name
    if name is None and len(known) == 1:
        name = known[0]
    if name not in known:
        said = "give name=" if name is None else f"none is {name!r:.40}"
        raise InputError(f"the dataset has the grids {', '.join(known)} of OASIS: {said}")
    names = f"{name}.clo", f"{name}.cla"
    centers = variables.get(f"{name}.lon")
    arrays = []
    for each in names:
        # The axis of corners is the one that centers do not have, or else the first one.
        dims = variables[each].dims
        own = [k for k, dim in enumerate(dims) if centers is not None and dim not in centers.dims]
        array = numbers(variables[each], each)
        if array.ndim < 2:
            raise ShapeError(f"{each} must have an axis of corners, got shape {array.shape}")
        arrays.append(np.moveaxis(array, own[0] if len(own) == 1 else 0, -1))
    lon, lat = arrays
    shape = lon.shape[:-1]
    dims = tuple(d for d in variables[names[0]].dims if centers is None or d in centers.dims)
    flat = lon.reshape(-1, lon.shape[-1]), lat.reshape(-1, lat.shape[-1])
    return Cells(
        format="OASIS",
        dims=dims if centers is not None else dims[1:],
        shape=shape,
        mask=flags_of(variables.get(f"{name}.msk"), len(flat[0]), used=0),
        coords=None if centers is None else (f"{name}.lon", f"{name}.lat"),
        **listed(variables, names, flat, choices, fixed=True),
    )


def read_geos(variables: Variables, choices: Choices) -> Cells:
    """Read a GEOS cubed sphere: corners of faces, (6, j + 1, i + 1), in degrees."""
    names = "corner_lons", "corner_lats"
    lon, lat = (numbers(variables[name], name) for name in names)
    if lon.ndim != 3 or min(lon.shape[1:]) < 2:
        raise wrong_shape("corner_lons", "(6, j + 1, i + 1)", lon)
    degrees = [
        in_degrees(variables[name], axis, name, choices, fixed=True)
        for axis, name in enumerate(names)
    ]
    nodes = places(lon, lat, (degrees[0], degrees[1]), names, choices)
    at = np.arange(lon.size).reshape(lon.shape)
    around = at[:, :-1, :-1], at[:, :-1, 1:], at[:, 1:, 1:], at[:, 1:, :-1]
    shape = around[0].shape
    centers = variables.get("lons")
    fields = centers.dims if centers is not None and centers.shape == shape else ()
    return Cells(
        format="GEOS-CS",
        dims=fields,
        shape=shape,
        nodes=nodes,
        corners=np.stack(around, axis=-1).reshape(-1).astype(np.int64),
        starts=np.arange(around[0].size + 1, dtype=np.int64) * 4,
        coords=("lons", "lats") if fields and "lats" in variables else None,
    )


def read_icon_corners(variables: Variables, choices: Choices) -> Cells:
    """Read ICON cells by their corners, (cell, 3), in radians unless units say otherwise."""
    names = "clon_vertices", "clat_vertices"
    lon, lat = (numbers(variables[name], name) for name in names)
    if lon.ndim != 2:
        raise wrong_shape("clon_vertices", "(cell, 3)", lon)
    return Cells(
        format="ICON",
        dims=variables[names[0]].dims[:1],
        shape=lon.shape[:1],
        coords=("clon", "clat") if {"clon", "clat"} <= set(variables) else None,
        **listed(variables, names, (lon, lat), choices, fixed=False),
    )
