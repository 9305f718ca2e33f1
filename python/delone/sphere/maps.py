"""Map files: weights in the layouts of ESMF, SCRIP and YAC."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.atomic import replacing
from delone._base.extras import require
from delone._base.files import reading_as
from delone.areal.paired import added, row_sums
from delone.errors import FileFormatError, InputError
from delone.sphere.coordinates import lonlat_of

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from delone._base.types import Bools, Floats
    from delone.sphere.grid import Grid

    Grids = tuple[Grid | None, Grid | None]

__all__ = ["read_map", "write_map"]

# How files name methods.
_NORMALIZATION = {"conservative": "destarea", "normalized": "fracarea", "sum": "none"}
_MAP = {
    "nearest": "Nearest neighbor remapping",
    "linear": "Bilinear remapping",
    "bilinear": "Bilinear remapping",
} | dict.fromkeys(("binned", "sibson", "laplace", "inverse_distance"), "Interpolation")
_ESMF = {
    "nearest": "Nearest source to destination",
    "binned": "Nearest destination to source",
    "linear": "Bilinear",
    "bilinear": "Bilinear",
} | dict.fromkeys(("sibson", "laplace", "inverse_distance"), "Interpolation")
# Sums of weights that differ by less than this agree.
_NEAR = 1e-9
# YAC's files use SCRIP's names, and some more.
_ROW = {"esmf": "row", "scrip": "dst_address", "yac": "dst_address"}
# The kind of sides, in files that contain the grids.
_EDGES = ("delone_source_edges", "delone_target_edges")
_SIDES = {"parallel": "meridians and parallels", "arc": "arcs of great circles"}
_COLUMN = {"esmf": "col", "scrip": "src_address", "yac": "src_address"}
# The length of the names of locations in YAC's files.
_LOCATION = 10


def _names(layout: str, side: int) -> dict[str, str]:
    """Return the names of the variables that describe the cells of one grid."""
    if layout == "esmf":
        a = "ab"[side]
        names = {
            "size": f"n_{a}",
            "corners": f"nv_{a}",
            "rank": ("src", "dst")[side] + "_grid_rank",
        }
        short = {"x": "xc", "y": "yc", "xs": "xv", "ys": "yv", "mask": "mask", "area": "area"}
        names |= {key: f"{name}_{a}" for key, name in short.items()}
        return names | {"frac": f"frac_{a}", "dims": ("src", "dst")[side] + "_grid_dims"}
    grid = ("src", "dst")[side] + "_grid"
    long = {
        "size": "size", "corners": "corners", "rank": "rank", "x": "center_lon", "y": "center_lat",
        "xs": "corner_lon", "ys": "corner_lat", "mask": "imask", "area": "area", "frac": "frac",
        "dims": "dims",
    }  # fmt: skip
    return {key: f"{grid}_{name}" for key, name in long.items()}


def write_map(
    weights: Any,
    path: str | os.PathLike[str],
    layout: str,
    grids: Grids,
    form: str,
    *,
    grid_names: tuple[str, str],
) -> None:
    """Write a `Weights`; see its `to_netcdf`."""
    if weights.method == "majority":
        raise InputError(
            "a map file cannot hold weights of the method majority, which are not sums"
        )
    if weights.limited:
        raise InputError(
            "a map file cannot hold limited slopes, which depend on the field: make weights "
            "without limiter=True"
        )
    netcdf = require("netCDF4", extra="xarray", what="writing NetCDF files")
    weights._require_fit(grids)
    with replacing(path) as temporary, netcdf.Dataset(temporary, "w", format=form) as file:
        _write_heads(file, weights, layout, grid_names)
        fractions = weights.source_fractions, weights.fractions
        sizes = weights.source_areas, weights.target_areas
        shapes = weights.source_shape, weights.target_shape
        for side in range(2):
            _write_cells(file, layout, side, (sizes[side], fractions[side], shapes[side]))
            grid = grids[side]
            if grid is not None:
                _write_places(file, _names(layout, side), grid)
                file.setncattr(_EDGES[side], grid.edges)
        links = "n_s" if layout == "esmf" else "num_links"
        file.createDimension(links, len(weights.values))
        file.createDimension("num_wgts", 1)
        rows = np.repeat(np.arange(len(weights.fractions)), np.diff(weights.indptr))
        for name, numbers in ((_ROW[layout], rows), (_COLUMN[layout], weights.indices)):
            variable = file.createVariable(name, "i4", (links,))
            variable.start_index = np.int32(1)
            variable[:] = numbers.astype(np.int32) + np.int32(1)
        if layout == "esmf":
            file.createVariable("S", "f8", (links,))[:] = weights.values
        else:
            shape = (links, "num_wgts")
            file.createVariable("remap_matrix", "f8", shape)[:] = weights.values[:, None]
        if layout == "yac":
            _write_locations(file, len(weights.values))


def _write_heads(file: Any, weights: Any, layout: str, grid_names: tuple[str, str]) -> None:
    """Write the attributes by which readers recognize a file."""
    esmf = layout == "esmf"
    # NCO looks for the name of ESMF's program in the title.
    file.title = (
        "delone: weights in the layout of ESMF Offline Regridding Weight Generator"
        if esmf
        else f"delone: weights in the layout of {layout.upper()}"
    )
    file.conventions = "NCAR-CSM" if esmf else "SCRIP"
    file.normalization = _NORMALIZATION.get(weights.method, "none")
    file.map_method = _MAP.get(weights.method, "Conservative remapping")
    if esmf:
        file.ESMF_regrid_method = _ESMF.get(
            weights.method, ("First", "Second")[weights.order - 1] + "-order Conservative"
        )
        file.domain_a = file.domain_b = file.grid_file_src = file.grid_file_dst = "not given"
    else:
        file.source_grid, file.dest_grid = grid_names
    if layout == "yac":
        file.version = "yac weight file 1.0"
        file.src_grid_name, file.dst_grid_name = grid_names
        file.contains_links, file.contains_fixed_dst = "TRUE", "FALSE"
    file.delone_method = weights.method
    file.delone_order = np.int32(weights.order)


def _write_cells(
    file: Any, layout: str, side: int, known: tuple[Floats, Floats, tuple[int, ...]]
) -> None:
    """Write what the weights contain about the cells of one grid."""
    names, (areas, fractions, shape) = _names(layout, side), known
    file.createDimension(names["size"], len(areas))
    file.createDimension(names["rank"], len(shape))
    # The axis that varies fastest comes first.
    file.createVariable(names["dims"], "i4", (names["rank"],))[:] = np.array(shape[::-1])
    area = file.createVariable(names["area"], "f8", (names["size"],))
    area.units = "square radians"
    area[:] = areas
    share = file.createVariable(names["frac"], "f8", (names["size"],))
    share.units = "unitless"
    share[:] = fractions
    mask = file.createVariable(names["mask"], "i4", (names["size"],))
    mask.units = "unitless"
    # Cells that are not covered are masked.
    mask[:] = (fractions > 0).astype(np.int32)


def _write_locations(file: Any, links: int) -> None:
    """Write that there is one source field, and that values belong to cells, as YAC requires."""
    file.createDimension("num_src_fields", 1)
    file.createDimension("max_loc_str_len", _LOCATION)
    numbers = file.createVariable("num_links_per_src_field", "i4", ("num_src_fields",))
    numbers[:] = np.array([links], dtype=np.int32)
    cells = np.zeros((1, _LOCATION), dtype="S1")
    cells[0, :4] = list("CELL")
    for name, dims in (("src_locations", ("num_src_fields",)), ("dst_location", ())):
        place = file.createVariable(name, "S1", (*dims, "max_loc_str_len"))
        place[:] = cells if dims else cells[0]


def _write_places(file: Any, names: dict[str, str], grid: Grid) -> None:
    """Write the centers and corners of cells; cells with fewer corners repeat the last one."""
    vectors, rings, cells = grid.rings
    # Files have one ring for each cell: the first.
    starts = rings[np.minimum(cells[:-1], len(rings) - 1)]
    ends = rings[np.minimum(cells[:-1] + 1, len(rings) - 1)]
    counts = np.maximum(ends - starts, 0)
    most = max(int(counts.max(initial=0)), 1)
    at = starts[:, None] + np.minimum(np.arange(most), np.maximum(counts - 1, 0)[:, None])
    places = lonlat_of(vectors)[np.minimum(at, len(vectors) - 1)] if len(vectors) else None
    file.createDimension(names["corners"], most)
    centers = grid.centers_lonlat
    for axis, (x, xs) in enumerate((("x", "xs"), ("y", "ys"))):
        center = file.createVariable(names[x], "f8", (names["size"],))
        center.units = "degrees"
        center[:] = centers[:, axis]
        corner = file.createVariable(names[xs], "f8", (names["size"], names["corners"]))
        corner.units = "degrees"
        if places is not None:
            corner[:] = places[..., axis]


def read_map(path: str | os.PathLike[str], grids: Grids) -> tuple[tuple[Any, ...], int]:
    """Return the parts of the weights in a file, and their order; see `Weights.from_netcdf`."""
    netcdf = require("netCDF4", extra="xarray", what="reading NetCDF files")
    with reading_as(path, "NetCDF"):
        file = netcdf.Dataset(path)
    with file:
        file.set_auto_mask(False)
        parts = _parts(file, str(path), grids)
        return parts, _order(file, parts[1][2])


def _parts(file: Any, path: str, grids: Grids) -> tuple[Any, ...]:
    """Return what `Weights` holds."""
    names = set(file.variables)
    layout = "esmf" if {"row", "col", "S"} <= names else "scrip"
    needed = {_ROW[layout], _COLUMN[layout], "S" if layout == "esmf" else "remap_matrix"}
    if not needed <= names:
        raise FileFormatError(
            f"{path} is not a map file: it has neither row, col and S nor src_address, "
            "dst_address and remap_matrix"
        )
    fixed = str(getattr(file, "contains_fixed_dst", "")).casefold() == "true"
    if fixed or len(file.dimensions.get("num_src_fields", ())) > 1:
        raise FileFormatError(
            f"{path} has fixed values or several source fields, which weights do not hold"
        )
    shapes, areas, fractions = [], [], []
    for side in range(2):
        found = _read_cells(file, _names(layout, side), path, grids[side], side)
        shapes.append(found[0])
        areas.append(found[1])
        fractions.append(found[2])
    rows = _numbers(file, _ROW[layout], len(areas[1]), path)
    columns = _numbers(file, _COLUMN[layout], len(areas[0]), path)
    values = np.asarray(file.variables["S" if layout == "esmf" else "remap_matrix"][:])
    if values.ndim > 1:
        if values.shape[1] > 1 and values[:, 1:].any():
            raise FileFormatError(f"{path} has weights of second order, which need gradients")
        values = values[:, 0]
    if not len(rows) == len(columns) == len(values):
        raise FileFormatError(f"{path} has rows, columns and weights of different numbers")
    values = values.astype(np.float64)
    method = _method(file)
    if method == "areas":
        method = "conservative"
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.where(areas[1][rows] > 0, values / areas[1][rows], 0.0)
    # Entries for the same pair are added.
    entries = added(rows, columns, values, len(areas[1]))
    counts = np.diff(entries[0])
    method, covered = _consistent(method, entries, fractions[1], counts > 0)
    share = np.ones(len(areas[0])) if fractions[0] is None else fractions[0]
    return method, entries, (share, covered), (areas[0], areas[1]), (shapes[0], shapes[1])


def _consistent(
    method: str, entries: tuple[Any, ...], given: Floats | None, there: Bools
) -> tuple[str, Floats]:
    """Return the method and the fractions of target cells that agree with the weights.

    Results are sums of weights times values, whatever else a file says: with "conservative",
    weights add up to the fractions, and with other means to one.
    """
    sums = row_sums(entries[0], entries[2])
    if method == "conservative":
        fits = given is not None and bool((np.abs(sums - given) <= _NEAR).all())
        return method, given if given is not None and fits else np.where(there, sums, 0.0)
    if method in {"normalized", *_MAP} and not (np.abs(sums[there] - 1) <= _NEAR).all():
        method = "other"
    # Without fractions, any cell with an entry has values.
    return method, there.astype(np.float64) if given is None else given


def _order(file: Any, values: Floats) -> int:
    """Return 2 if weights have slopes, because the file says so or because some are negative."""
    own = getattr(file, "delone_order", None)
    said = str(getattr(file, "ESMF_regrid_method", "")) + str(getattr(file, "map_method", ""))
    if own is not None:
        return 2 if int(np.ravel(own)[0]) == 2 else 1
    second = "second" in said.casefold() or "2nd" in said.casefold()
    return 2 if second or bool((values < -_NEAR).any()) else 1


def _method(file: Any) -> str:
    """Return the method of a file, "areas" if its weights are areas."""
    own = getattr(file, "delone_method", None)
    if own in _NORMALIZATION or own in _MAP:
        return str(own)
    said = str(getattr(file, "normalization", "")).strip().lower()
    if said == "none" and "row" not in file.variables:
        return "areas"
    known = {name: method for method, name in _NORMALIZATION.items() if name != "none"}
    return known.get(said, "other")


def _numbers(file: Any, name: str, count: int, path: str) -> NDArray[np.int64]:
    """Return cell numbers that start at 0."""
    variable = file.variables[name]
    start = getattr(variable, "start_index", getattr(variable, "first_index", 1))
    numbers = np.asarray(variable[:]).astype(np.int64) - int(start)
    wrong = (numbers < 0) | (numbers >= count)
    if wrong.any():
        at = int(np.flatnonzero(wrong)[0])
        raise FileFormatError(
            f"{path}: {name}[{at}] is {numbers[at] + int(start)}, outside {int(start)} to "
            f"{count - 1 + int(start)}"
        )
    return numbers


def _read_cells(
    file: Any, names: dict[str, str], path: str, grid: Grid | None, side: int
) -> tuple[tuple[int, ...], Floats, Floats | None]:
    """Return the shape, areas and covered fractions of the cells of one grid."""
    name = ("source", "target")[side]
    if names["size"] in file.dimensions:
        count = len(file.dimensions[names["size"]])
    elif grid is not None:
        count = grid.ncells
    else:
        raise FileFormatError(f"{path} has no dimension {names['size']}: give the grid, {name}=")
    if grid is not None and grid.ncells != count:
        raise InputError(f"{name} has {grid.ncells} cells, and {path} {count}")
    edges = getattr(file, _EDGES[side], None)
    if grid is not None and edges is not None and edges != grid.edges:
        raise InputError(
            f"the cells of {name} have {_SIDES[grid.edges]} as sides, and those of {path} "
            f"{_SIDES.get(edges, 'others')}"
        )
    shape = _shape(file, names, count) if grid is None else grid.grid_shape
    found = []
    for key in ("area", "frac"):
        variable = file.variables.get(names[key])
        found.append(None if variable is None else np.asarray(variable[:], dtype=np.float64))
    areas, fractions = found
    if areas is None and grid is not None:
        areas = grid.areas
    return shape, np.full(count, np.nan) if areas is None else areas, fractions


def _shape(file: Any, names: dict[str, str], count: int) -> tuple[int, ...]:
    """Return the shape of fields; files list the fastest dimension first.

    Some programs write two dimensions in the opposite order. The centers distinguish them: in rows
    and columns, latitudes are constant along one axis and longitudes along the other.
    """
    if names["dims"] not in file.variables:
        return (count,)
    dims = np.asarray(file.variables[names["dims"]][:]).ravel()
    if not (dims > 0).all() or int(np.prod(dims, dtype=np.int64)) != count:
        return (count,)
    shape = tuple(dims[::-1].tolist())
    x, y = (file.variables.get(names[key]) for key in ("x", "y"))
    if len(shape) == 2 and x is not None and y is not None:
        one, two = (np.asarray(part[:]).ravel() for part in (x, y))
        if len(one) == len(two) == count:
            orders = [each for each in (shape, shape[::-1]) if _in_rows(one, two, each)]
            return orders[0] if orders else shape
    return shape


def _in_rows(x: Floats, y: Floats, shape: tuple[int, ...]) -> bool:
    """Return whether centers are in rows and columns, along either axis."""
    one, two = x.reshape(shape), y.reshape(shape)
    across, down = one == one[:1], two == two[:, :1]
    back = one == one[:, :1], two == two[:1]
    return bool((across.all() and down.all()) or (back[0].all() and back[1].all()))
