"""Longitudes and latitudes with bounds, as in files with CF conventions, and HEALPix."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_text, as_workers
from delone.errors import DirectionError, DtypeError, InputError, ShapeError
from delone.interpolate.places import is_angle
from delone.sphere.boxes import as_boxes
from delone.sphere.coordinates import BEYOND, units_of
from delone.sphere.formats.cells import Cells
from delone.sphere.formats.corners import listed
from delone.sphere.formats.variables import attribute, in_degrees, numbers, places, required
from delone.sphere.healpix import healpix_corners
from delone.sphere.rings import as_bounds, voronoi
from delone.sphere.voronoi import Voronoi

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats
    from delone.sphere.formats.cells import Choices

    Variables = dict[str, Any]
    Pair = tuple[str, str]

__all__ = ["bounds_name", "centers", "healpix_mapping", "read_bounds", "read_healpix"]

_WORDS = ("longitude", "latitude")
_NAMES = (("lon", "lat"), ("longitude", "latitude"))
# Suffixes of the names of bounds, for coordinates without the attribute.
_ENDINGS = ("_bnds", "_bounds", "_vertices", "_b", "_corners")
_INFER = "give infer_bounds=True to place them halfway between centers"


def centers(variables: Variables, choices: Choices) -> Pair | None:
    """Return the names of the longitude and the latitude; None if there are none."""
    if choices.coords is not None:
        a, b = _pair(choices.coords)
        for name in (a, b):
            if name not in variables:
                raise InputError(f"the dataset has no variable {name!r:.60}, as coords= says")
        return a, b
    usable = dict(variables)
    for name, part in variables.items():
        # Bounds are not centers.
        usable.pop(str(attribute(part, "bounds")), None)
        for ending in _ENDINGS:
            usable.pop(f"{name}{ending}", None)
    if choices.name is not None:
        along = set(required(variables, choices.name).dims)
        usable = {n: p for n, p in usable.items() if p.ndim and set(p.dims) <= along}
    known = [[n for n, p in usable.items() if is_angle(p, axis)] for axis in (0, 1)]
    if max(map(len, known)) > 1:
        # If there are several, use those that are coordinates of their own axes.
        own = [[n for n in names if usable[n].dims == (n,)] for names in known]
        if not all(len(names) == 1 for names in own):
            found = ", ".join(name for names in known for name in names)
            raise InputError(
                f"the dataset has the longitudes and latitudes {found}: name two with coords=, or "
                "a variable with name="
            )
        known = own
    if all(known):
        return known[0][0], known[1][0]
    return next(((a, b) for a, b in _NAMES if {a, b} <= set(usable)), None)


def _pair(names: Any) -> Pair:
    """Return two names of variables."""
    if not isinstance(names, list | tuple) or len(names) != 2:
        raise DtypeError(f"coords must be two names of variables, got {names!r:.60}")
    a, b = (as_text(name, name="coords") for name in names)
    return a, b


def read_bounds(variables: Variables, choices: Choices) -> Cells:
    """Read cells by the bounds of longitudes and latitudes of centers."""
    names = centers(variables, choices)
    if names is None:
        raise InputError("the dataset has no longitudes and latitudes")
    lon, lat = (variables[name] for name in names)
    if lon.ndim == lat.ndim == 1 and lon.dims != lat.dims:
        return _read_product(variables, names, choices)
    if lon.dims != lat.dims or lon.ndim not in {1, 2}:
        raise ShapeError(
            f"{names[0]} has the dimensions {lon.dims}, and {names[1]} {lat.dims}: no cells follow"
        )
    return _read_listed(variables, names, choices)


def bounds_name(variables: Variables, name: str, *, required: bool = True) -> str | None:
    """Return the name of the bounds of a coordinate; if `required`, those it names must exist."""
    said = attribute(variables[name], "bounds")
    if said is not None and said not in variables and required:
        raise InputError(
            f"{name} has the bounds {said!r:.60}, which the dataset lacks: of an array give the "
            f"dataset, or {_INFER[5:]}"
        )
    if said is not None:
        return str(said) if said in variables else None
    return next((name + e for e in _ENDINGS if name + e in variables), None)


def _unit(variables: Variables, name: str, bounds: str | None, axis: int, choices: Choices) -> bool:
    """Return whether bounds are in degrees: by their own units, or by those of their coordinate."""
    if bounds is not None and "units" in variables[bounds].attrs:
        return in_degrees(variables[bounds], axis, bounds, choices)
    return in_degrees(variables[name], axis, name, choices)


def _read_product(variables: Variables, names: Pair, choices: Choices) -> Cells:
    """Read the cells between meridians and parallels."""
    edges: list[Floats] = []
    merged = 0
    for axis, name in enumerate(names):
        bounds = bounds_name(variables, name, required=not choices.infer)
        if bounds is None and not choices.infer:
            raise InputError(
                f"{name} has no bounds: no attribute names them, and there is no variable "
                f"{', '.join(name + e for e in _ENDINGS)}: {_INFER}, or use Grid.from_lonlat"
            )
        degrees = _unit(variables, name, bounds, axis, choices)
        if bounds is None:
            found = _halfway(numbers(variables[name], name), name, axis, degrees)
        else:
            found, moved = _met(numbers(variables[bounds], bounds), degrees, choices)
            merged += moved
        edges.append(found if degrees else np.degrees(found))
    dims = variables[names[1]].dims + variables[names[0]].dims
    shape = variables[names[1]].size, variables[names[0]].size
    cells = Cells("CF", dims, shape, edges[0], edges[1], merged=merged, coords=names)
    return _as_arcs(cells, choices) if choices.edges == "arc" else cells


def _halfway(values: NDArray[Any], name: str, axis: int, degrees: bool) -> Floats:
    """Return edges halfway between centers; the outer ones are as far out as the inner ones.

    Latitudes beyond a pole become the pole.
    """
    at = values.astype(np.float64)
    if len(at) < 2:
        raise InputError(f"{name} has one center only, from which no bounds follow")
    between = (at[1:] + at[:-1]) / 2
    found: Floats = np.concatenate(
        ([at[0] - (between[0] - at[0])], between, [at[-1] + (at[-1] - between[-1])])
    )
    pole = 90.0 if degrees else np.pi / 2
    return np.clip(found, -pole, pole) if axis else found


def _met(bounds: NDArray[Any], degrees: bool, choices: Choices) -> tuple[Floats, int]:
    """Make bounds that differ by rounding errors equal; return them, and how many were moved."""
    found = bounds.astype(np.float64)
    if bounds.ndim != 2 or bounds.shape[1] != 2 or len(bounds) < 2:
        return found, 0
    epsilon = np.finfo(bounds.dtype).eps if bounds.dtype.kind == "f" else 0.0
    merge = np.degrees(choices.merge) if degrees else choices.merge
    near = max(merge, 4 * epsilon * float(np.abs(found).max()))
    for a, b in ((1, 0), (0, 1)):
        gaps = found[1:, b] - found[:-1, a]
        if (np.abs(gaps) <= near).all():
            found[1:, b] = found[:-1, a]
            return found, int((gaps != 0).sum())
    return found, 0


def _as_arcs(cells: Cells, choices: Choices) -> Cells:
    """Return cells between meridians and parallels as quadrilaterals of great circles."""
    assert cells.columns is not None
    assert cells.rows is not None
    lon = as_bounds(cells.columns, name="lon", degrees=True)
    lat = as_bounds(cells.rows, name="lat", degrees=True)
    x, y = np.meshgrid(lon, lat)
    nodes = places(x, y, (True, True), ("lon", "lat"), choices)
    return cells._replace(columns=None, rows=None, nodes=nodes, **_quadrilaterals(x.shape))


def _quadrilaterals(shape: tuple[int, ...]) -> dict[str, Any]:
    """Return the numbers of the corners of the cells between (j + 1, i + 1) of them."""
    at = np.arange(shape[0] * shape[1], dtype=np.int64).reshape(shape)
    around = at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]
    corners = np.stack(around, axis=-1).reshape(-1)
    return {"corners": corners, "starts": np.arange(around[0].size + 1, dtype=np.int64) * 4}


def _read_listed(variables: Variables, names: Pair, choices: Choices) -> Cells:
    """Read cells whose centers have one or two dimensions in common."""
    own = variables[names[0]]
    rest: dict[str, Any] = {"format": "CF", "dims": own.dims, "shape": own.shape, "coords": names}
    bounds = [bounds_name(variables, n, required=not choices.infer) for n in names]
    if bounds[0] is None or bounds[1] is None:
        if choices.infer:
            inferred = _between if own.ndim == 2 else _nearest
            return Cells(**rest, **inferred(variables, names, choices))
        lacking = names[0] if bounds[0] is None else names[1]
        cure = _INFER if own.ndim == 2 else (
            "give infer_bounds=True to use the places nearest to each center as its cell"
        )  # fmt: skip
        raise InputError(
            f"{lacking} has no bounds: no attribute names them, and there is no variable "
            f"{', '.join(lacking + e for e in _ENDINGS)}: {cure}"
        )
    pair = bounds[0], bounds[1]
    arrays = [numbers(variables[name], name) for name in pair]
    if own.ndim == 2 and all(array.shape == tuple(n + 1 for n in own.shape) for array in arrays):
        degrees = [
            _unit(variables, name, bound, axis, choices)
            for axis, (name, bound) in enumerate(zip(names, pair, strict=True))
        ]
        nodes = places(arrays[0], arrays[1], (degrees[0], degrees[1]), pair, choices)
        return Cells(**rest, nodes=nodes, **_quadrilaterals(arrays[0].shape))
    flat = []
    for name, array in zip(pair, arrays, strict=True):
        given = variables[name].dims
        others = [k for k, dim in enumerate(given) if dim not in own.dims]
        if len(given) != own.ndim + 1 or len(others) != 1:
            raise ShapeError(
                f"{name} must have the dimensions {own.dims} and one of corners, got {given}"
            )
        order = [given.index(dim) for dim in own.dims] + others
        flat.append(array.transpose(order).reshape(-1, array.shape[others[0]]))
    if flat[0].shape[1] == flat[1].shape[1] == 2:
        found, near = _intervals(variables, names, pair, (flat[0], flat[1]), choices)
        if choices.edges != "arc":
            return Cells(**rest, boxes=found, near=near)
        west, east, south, north = found.T
        around = (west, east, east, west), (south, south, north, north)
        lon, lat = (np.stack(each, axis=1) for each in around)
        nodes = places(lon, lat, (True, True), names, choices)
        return Cells(**rest, nodes=nodes, starts=np.arange(len(found) + 1, dtype=np.int64) * 4)
    if flat[0].shape[1] < 3:
        raise ShapeError(f"{pair[0]} has {flat[0].shape[1]} corners for each cell, not 3 or more")
    # Bounds without units have those of their coordinate.
    known = {
        bound: variables[bound if "units" in variables[bound].attrs else name]
        for name, bound in zip(names, pair, strict=True)
    }
    return Cells(**rest, **listed(known, pair, (flat[0], flat[1]), choices))


def _intervals(
    variables: Variables,
    names: Pair,
    bounds: Pair,
    arrays: tuple[NDArray[Any], NDArray[Any]],
    choices: Choices,
) -> tuple[Floats, tuple[float, float]]:
    """Return west, east, south and north of cells in degrees, and distances to merge bounds."""
    near, found = [float(np.degrees(choices.merge))] * 2, []
    for axis, (name, bound, array) in enumerate(zip(names, bounds, arrays, strict=True)):
        values = array.astype(np.float64)
        if not _unit(variables, name, bound, axis, choices):
            values = np.degrees(values)
        if array.dtype.kind == "f":
            size = float(np.nanmax(np.abs(values), initial=0.0))
            near[axis] = max(near[axis], 4 * float(np.finfo(array.dtype).eps) * size)
        found.append(values)
    centers = numbers(variables[names[0]], names[0]).astype(np.float64).ravel()
    if not in_degrees(variables[names[0]], 0, names[0], choices):
        centers = np.degrees(centers)
    lat = _within_poles(found[1], bounds[1])
    return as_boxes(found[0], lat, centers, bounds), (near[0], near[1])


def _within_poles(lat: Floats, name: str) -> Floats:
    """Return latitudes in degrees with those beyond a pole by a rounding error set to the pole."""
    far = np.abs(lat) > 90 * BEYOND
    if far.any():
        row = int(np.flatnonzero(far.any(axis=1))[0])
        raise DirectionError(
            f"{name}: cell {row} reaches beyond a pole: are these the right units?", rows=[row]
        )
    found: Floats = np.clip(lat, -90.0, 90.0)
    return found


def _nearest(variables: Variables, names: Pair, choices: Choices) -> dict[str, Any]:
    """Return the corners of the Voronoi cells of centers."""
    degrees = [in_degrees(variables[name], axis, name, choices) for axis, name in enumerate(names)]
    lon, lat = (numbers(variables[name], name) for name in names)
    sites = places(lon, lat, (degrees[0], degrees[1]), names, choices)
    diagram = Voronoi(xyz=sites, workers=choices.workers)
    again = np.flatnonzero(diagram.duplicate_of != np.arange(len(sites)))
    if len(again):
        first, second = diagram.duplicate_of[again[0]], again[0]
        raise InputError(
            f"{names[0]}, {names[1]}: centers {first} and {second} are the same place, and have "
            "no cells of their own: leave one out"
        )
    if diagram.triangulation is None or not diagram.triangulation.covers_sphere:
        raise InputError(
            f"{names[0]}, {names[1]}: all centers are within a hemisphere, so the outer cells are "
            "unbounded: clip them, Grid.from_polygons(sphere.Voronoi(lonlat=..., "
            "clip=region).to_geopandas())"
        )
    nodes, starts = voronoi(diagram)
    return {"nodes": nodes, "starts": starts, "shared": True}


def _between(variables: Variables, names: Pair, choices: Choices) -> dict[str, Any]:
    """Return corners in the middle of four centers each; the outer ones mirror the inner ones."""
    degrees = [in_degrees(variables[name], axis, name, choices) for axis, name in enumerate(names)]
    lon, lat = (numbers(variables[name], name) for name in names)
    if min(lon.shape) < 2:
        raise InputError(f"{names[0]} has one row or column, from which no bounds follow")
    at = places(lon, lat, (degrees[0], degrees[1]), names, choices)
    at = units_of(at, choices.workers).reshape(*lon.shape, 3)
    for axis in (0, 1):
        first, last = (2 * at.take(a, axis) - at.take(b, axis) for a, b in ((0, 1), (-1, -2)))
        at = np.concatenate(
            (np.expand_dims(first, axis), at, np.expand_dims(last, axis)), axis=axis
        )
    nodes = at[:-1, :-1] + at[:-1, 1:] + at[1:, 1:] + at[1:, :-1]
    return {"nodes": nodes.reshape(-1, 3), **_quadrilaterals(nodes.shape[:2])}


def healpix_mapping(variables: Variables) -> str | None:
    """Return the name of the variable that describes the HEALPix grid."""
    for name, part in variables.items():
        if str(part.attrs.get("grid_mapping_name", "")).casefold() == "healpix":
            return name
    return None


def read_healpix(variables: Variables, choices: Choices) -> Cells:
    """Read HEALPix pixels: all, or those whose numbers a coordinate lists."""
    name = healpix_mapping(variables)
    assert name is not None
    attrs = variables[name].attrs
    if "healpix_nside" in attrs:
        nside = int(attrs["healpix_nside"])
    elif "refinement_level" in attrs:
        nside = 2 ** int(attrs["refinement_level"])
    else:
        raise InputError(f"{name} has neither the attribute healpix_nside nor refinement_level")
    said = str(attrs.get("healpix_order", attrs.get("indexing_scheme", ""))).casefold()
    order = {"nest": "nested", "nested": "nested", "ring": "ring"}.get(said)
    if order is None:
        raise InputError(
            f"{name}: healpix_order or indexing_scheme must be nested or ring, got {said!r:.40}"
        )
    corners = healpix_corners(nside, nested=order == "nested", workers=as_workers(choices.workers))
    count = len(corners)
    listed = [
        (key, part)
        for key, part in variables.items()
        if part.attrs.get("standard_name") == "healpix_index" and part.ndim == 1
    ]
    if listed:
        key, part = listed[0]
        pixels = numbers(part, key).astype(np.int64)
        if len(pixels) and not 0 <= pixels.min() <= pixels.max() < count:
            raise InputError(f"{key} has pixels out of range 0 to {count - 1}")
        corners, dims = corners[pixels], part.dims
    else:
        named = {dim for part in variables.values() for dim in part.dims}
        sizes = {
            dim: part.shape[part.dims.index(dim)]
            for part in variables.values()
            for dim in part.dims
        }
        dims = tuple(dim for dim in sorted(named, key=str) if sizes[dim] == count)[:1]
        if not dims:
            raise InputError(
                f"the dataset has no dimension of {count} pixels, as {name} says, and no "
                "coordinate with the standard name healpix_index"
            )
    return Cells(
        "HEALPix",
        dims,
        (len(corners),),
        nodes=corners.reshape(-1, 3),
        shared=True,
        starts=np.arange(len(corners) + 1, dtype=np.int64) * 4,
    )
