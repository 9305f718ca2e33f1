"""Recognizes the convention of a dataset by its variables, and reads the cells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone.errors import InputError
from delone.interpolate.places import unit_of
from delone.sphere.formats import corners, meshes, structured
from delone.sphere.formats.variables import (
    in_degrees,
    numbers,
    refuse_projected,
    variables_of,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from delone._base.types import Floats
    from delone.sphere.formats.cells import Cells, Choices

    Variables = dict[str, Any]

__all__ = ["read_cells"]


class _Format(NamedTuple):
    """A convention: how it is recognized, and the function that reads it."""

    name: str
    wanted: str
    known: Callable[[Variables], Any]
    read: Callable[[Variables, Choices], Cells]


_TURN = 360.0
# Conventions that define the unit of centers: whether it is degrees.
_UNITS = {"MPAS": False, "ICON": False, "FESOM": True, "OASIS": True, "GEOS-CS": True}


def _has(*names: str) -> Callable[[Variables], bool]:
    return lambda variables: set(names) <= set(variables)


# Specific conventions come first, because many of them also have longitudes and latitudes.
_FORMATS = (
    _Format(
        "UGRID",
        "a variable with cf_role mesh_topology and face_node_connectivity",
        meshes.topologies,
        meshes.read_ugrid,
    ),
    _Format("SCRIP", "grid_corner_lon, grid_corner_lat", corners.scrip_names, corners.read_scrip),
    _Format("ESMF", "nodeCoords, elementConn", _has("nodeCoords", "elementConn"), meshes.read_esmf),
    _Format(
        "ICON",
        "vlon, vlat, vertex_of_cell",
        _has("vlon", "vlat", "vertex_of_cell"),
        meshes.read_icon,
    ),
    _Format(
        "ICON",
        "clon_vertices, clat_vertices",
        _has("clon_vertices", "clat_vertices"),
        corners.read_icon_corners,
    ),
    _Format(
        "GEOS-CS", "corner_lons, corner_lats", _has("corner_lons", "corner_lats"), corners.read_geos
    ),
    _Format("OASIS", "NAME.clo, NAME.cla", corners.oasis_grids, corners.read_oasis),
    _Format(
        "HEALPix",
        "a grid mapping named healpix",
        structured.healpix_mapping,
        structured.read_healpix,
    ),
)
_LAST = (
    _Format("FESOM", "lon, lat, triag_nodes", _has("lon", "lat", "triag_nodes"), meshes.read_fesom),
    _Format(
        "FESOM",
        "nodes, elements, nod_in_elem2D",
        _has("nodes", "elements", "nod_in_elem2D"),
        meshes.read_fesom_diagnostics,
    ),
    _Format(
        "Exodus",
        "connect1, and coord or coordx, coordy, coordz",
        lambda v: "connect1" in v and ("coord" in v or "coordx" in v),
        meshes.read_exodus,
    ),
)


def read_cells(given: Any, choices: Choices) -> Cells:
    """Return the cells of an xarray dataset, or of a uxarray grid."""
    found = _read(given, choices)
    if choices.cells is not None and found.format not in {"UGRID", "FESOM"}:
        raise InputError(
            f"cells={choices.cells!r:.20} is for UGRID and FESOM meshes, and this is {found.format}"
        )
    if found.coords is not None and found.columns is None:
        return found._replace(centers=_centers(variables_of(given), found, choices))
    return found


def _centers(variables: Variables, cells: Cells, choices: Choices) -> Floats | None:
    """Return the centers in a dataset in degrees; None if it does not state their unit."""
    assert cells.coords is not None
    columns = []
    for axis, name in enumerate(cells.coords):
        part = variables[name]
        if part.size != np.prod(cells.shape):
            return None
        known = unit_of(part, axis)
        if known is None and cells.format not in _UNITS and choices.degrees is None:
            return None
        values = numbers(part, name).astype(np.float64).ravel()
        degrees = in_degrees(part, axis, name, choices, fixed=_UNITS.get(cells.format))
        columns.append(values if degrees else np.degrees(values))
    if len(columns[0]) and np.ptp(columns[0]) > _TURN:
        # As in ocean grids, which begin at any longitude.
        columns[0] = (columns[0] + _TURN / 2) % _TURN - _TURN / 2
    # Latitudes beyond a pole by a rounding error are the pole.
    lonlat = np.column_stack((columns[0], np.clip(columns[1], -90, 90)))
    return lonlat if np.isfinite(lonlat).all() else None


def _read(given: Any, choices: Choices) -> Cells:
    """Return the cells by the convention of their variables."""
    grid = getattr(given, "uxgrid", given)
    if hasattr(grid, "face_node_connectivity") and hasattr(grid, "node_lon"):
        return meshes.read_uxarray(grid, choices)
    variables = variables_of(given)
    if choices.coords is not None:
        return structured.read_bounds(variables, choices)
    for each in _FORMATS:
        if each.known(variables):
            return each.read(variables, choices)
    if {"verticesOnCell", "nEdgesOnCell"} <= set(variables):
        return meshes.read_mpas(variables, choices, dict(given.attrs))
    for each in _LAST:
        # Bounds of cells around nodes take precedence over triangles between them.
        if each.known(variables) and (choices.cells or not _has_bounds(variables)):
            return each.read(variables, choices)
    if structured.centers(variables, choices) is not None:
        return structured.read_bounds(variables, choices)
    refuse_projected(variables)
    listed = "; ".join(f"{each.name} ({each.wanted})" for each in (*_FORMATS, *_LAST))
    raise InputError(
        f"the dataset has no grid: looked for {listed}; MPAS (verticesOnCell, nEdgesOnCell); and "
        "for longitudes and latitudes by standard_name, units, or the names lon and lat. Its "
        f"variables: {', '.join(variables) or 'none'}"[:900]
    )


def _has_bounds(variables: Variables) -> bool:
    """Return whether lon and lat have bounds."""
    return all(
        name in variables and structured.bounds_name(variables, name) is not None
        for name in ("lon", "lat")
    )
