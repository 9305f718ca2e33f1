"""Conventions with nodes and connectivity: UGRID, ESMF, MPAS, ICON, FESOM, Exodus, and uxarray."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import wrong_shape
from delone.errors import InputError, ShapeError
from delone.interpolate.places import is_angle
from delone.sphere.formats.cells import Cells, flags_of
from delone.sphere.formats.variables import (
    attribute,
    connected,
    in_degrees,
    numbers,
    places,
    ragged,
    refuse_projected,
    required,
)

if TYPE_CHECKING:
    from delone._base.types import Floats, Rows
    from delone.sphere.formats.cells import Choices

    Variables = dict[str, Any]

__all__ = [
    "read_esmf",
    "read_exodus",
    "read_fesom",
    "read_fesom_diagnostics",
    "read_icon",
    "read_mpas",
    "read_ugrid",
    "read_uxarray",
    "topologies",
]


def _nodes(
    variables: Variables, names: tuple[str, str], choices: Choices, *, fixed: bool | None = None
) -> Floats:
    """Return the vectors of nodes from their longitudes and latitudes."""
    degrees = [
        in_degrees(required(variables, name), axis, name, choices, fixed=fixed)
        for axis, name in enumerate(names)
    ]
    lon, lat = (numbers(variables[name], name) for name in names)
    return places(lon, lat, (degrees[0], degrees[1]), names, choices)


def _cells(
    convention: str, dims: tuple[Any, ...], nodes: Floats, cells: tuple[Rows, Rows], **more: Any
) -> Cells:
    """Return cells from corners, as rows of nodes, and starts; fields have one axis."""
    corners, starts = cells
    shape = (len(starts) - 1,)
    return Cells(convention, dims, shape, nodes=nodes, corners=corners, starts=starts, **more)


def topologies(variables: Variables) -> list[str]:
    """Return the names of the UGRID meshes that have faces."""
    return [
        name
        for name, part in variables.items()
        if part.attrs.get("cf_role") == "mesh_topology" and "face_node_connectivity" in part.attrs
    ]


def read_ugrid(variables: Variables, choices: Choices) -> Cells:
    """Read the faces of a UGRID mesh."""
    known = topologies(variables)
    name, location = choices.name, "face"
    if name is not None and name not in known and name in variables:
        location = str(variables[name].attrs.get("location", location))
        name = variables[name].attrs.get("mesh", name)
    if choices.cells is not None:
        location = choices.cells[:-1]
    if location not in {"face", "node"}:
        raise InputError(
            f"{choices.name!r:.60} has the location {location!r:.40}, not node or face: there are "
            "no cells around edges"
        )
    if name is None and len(known) == 1:
        name = known[0]
    if name not in known:
        said = "give name=" if name is None else f"none is {name!r:.40}"
        raise InputError(f"the dataset has the meshes {', '.join(known)} of UGRID: {said}")
    topology = variables[name].attrs
    nodes = str(topology.get("node_coordinates", "")).split()
    if len(nodes) != 2:
        raise InputError(f"{name}: node_coordinates must name two variables, got {nodes}")
    for each in nodes:
        if each not in variables:
            raise InputError(f"{name}: the dataset has no variable {each!r:.60}, its coordinate")
    # The longitude usually comes first, but attributes decide.
    if is_angle(variables[nodes[0]], 1) and is_angle(variables[nodes[1]], 0):
        nodes.reverse()
    elif not (is_angle(variables[nodes[0]], 0) and is_angle(variables[nodes[1]], 1)):
        refuse_projected({each: variables[each] for each in nodes})
        raise InputError(
            f"{name}: {nodes[0]} and {nodes[1]} say neither by standard_name nor by units which "
            "is the longitude and which is the latitude: set their units to degrees_east and "
            "degrees_north"
        )
    vectors = _nodes(variables, (nodes[0], nodes[1]), choices)
    faces = str(topology["face_node_connectivity"])
    if faces not in variables:
        raise InputError(f"{name}: the dataset has no variable {faces!r:.60}, its faces")
    table = variables[faces]
    along = topology.get("face_dimension")
    transposed = table.ndim == 2 and along == table.dims[1] != table.dims[0]
    cells = connected(
        table,
        faces,
        len(vectors),
        start=int(table.attrs.get("start_index", 0)),
        transposed=transposed,
    )
    if location == "node":
        return _at_nodes("UGRID", variables, (nodes[0], nodes[1]), vectors, cells)
    dims = (table.dims[1 if transposed else 0],)
    coords = _ordered(variables, str(topology.get("face_coordinates", "")).split())
    return _cells("UGRID", dims, vectors, cells, coords=coords)


def _at_nodes(
    convention: str,
    variables: Variables,
    names: tuple[str, str],
    nodes: Floats,
    faces: tuple[Rows, Rows],
) -> Cells:
    """Return the faces of a mesh whose fields are at nodes."""
    dims = variables[names[0]].dims
    return Cells(
        convention,
        dims,
        (len(nodes),),
        nodes=nodes,
        corners=faces[0],
        starts=faces[1],
        coords=names,
        location="node",
    )


def _present(variables: Variables, lon: str, lat: str) -> tuple[str, str] | None:
    """Return two names if both are variables, or None."""
    return (lon, lat) if {lon, lat} <= set(variables) else None


def _ordered(variables: Variables, names: list[str]) -> tuple[str, str] | None:
    """Return two names with the longitude first, or None."""
    if len(names) != 2 or not set(names) <= set(variables):
        return None
    for a, b in (names, names[::-1]):
        if is_angle(variables[a], 0) and is_angle(variables[b], 1):
            return a, b
    return None


def read_esmf(variables: Variables, choices: Choices) -> Cells:
    """Read a mesh in the ESMF format; node numbers start at 1."""
    given = variables["nodeCoords"]
    both = numbers(given, "nodeCoords")
    if both.ndim != 2 or both.shape[1] != 2:
        raise wrong_shape("nodeCoords", "(n, 2)", both)
    known = in_degrees(given, 0, "nodeCoords", choices)
    names = "nodeCoords[:, 0]", "nodeCoords[:, 1]"
    vectors = places(both[:, 0], both[:, 1], (known, known), names, choices)
    table = variables["elementConn"]
    start = int(table.attrs.get("start_index", 1))
    counts = variables.get("numElementConn")
    lengths = None if counts is None else numbers(counts, "numElementConn")
    options: dict[str, Any] = {"start": start, "counts": lengths}
    if table.ndim == 1 and counts is not None:
        cells = ragged(table, "elementConn", len(vectors), **options)
        dims = counts.dims
    else:
        cells = connected(table, "elementConn", len(vectors), **options)
        dims = table.dims[:1]
    mask = flags_of(variables.get("elementMask"), len(cells[1]) - 1)
    return _cells("ESMF", dims, vectors, cells, mask=mask)


def read_mpas(variables: Variables, choices: Choices, attributes: dict[str, Any]) -> Cells:
    """Read MPAS cells: numbers start at 1, and angles are in radians."""
    if str(attributes.get("on_a_sphere", "YES")).strip().upper() not in {"YES", "Y"}:
        raise InputError("the mesh of MPAS is planar (on_a_sphere is not YES)")
    axes = "xVertex", "yVertex", "zVertex"
    if set(axes) <= set(variables):
        vectors = np.column_stack([numbers(variables[name], name) for name in axes])
        vectors = vectors.astype(np.float64)
    else:
        vectors = _nodes(variables, ("lonVertex", "latVertex"), choices, fixed=False)
    table = variables["verticesOnCell"]
    counts = numbers(variables["nEdgesOnCell"], "nEdgesOnCell")
    cells = connected(table, "verticesOnCell", len(vectors), start=1, counts=counts)
    return _cells(
        "MPAS", table.dims[:1], vectors, cells, coords=_present(variables, "lonCell", "latCell")
    )


def read_icon(variables: Variables, choices: Choices) -> Cells:
    """Read ICON triangles: (3, cell), numbers from 1, angles in radians."""
    vectors = _nodes(variables, ("vlon", "vlat"), choices, fixed=False)
    table = variables["vertex_of_cell"]
    centers = variables.get("clon")
    along = None if centers is None or centers.ndim != 1 else centers.dims[0]
    if table.ndim != 2 or 3 not in table.shape:
        raise wrong_shape("vertex_of_cell", "(3, cell)", table)
    # The axis of cells is that of their centers; without centers, the order is (3, cell).
    transposed = table.dims[0] != along and table.shape[0] == 3
    cells = connected(table, "vertex_of_cell", len(vectors), start=1, transposed=transposed)
    dims = (table.dims[1 if transposed else 0],)
    return _cells("ICON", dims, vectors, cells, coords=_present(variables, "clon", "clat"))


def read_fesom(variables: Variables, choices: Choices) -> Cells:
    """Read a FESOM mesh: numbers from 1, angles in degrees; fields are at nodes."""
    names = "lon", "lat"
    vectors = _nodes(variables, names, choices, fixed=True)
    cells, dims = _three(variables, "triag_nodes", len(vectors))
    if choices.cells == "faces":
        return _cells("FESOM", dims, vectors, cells)
    return _at_nodes("FESOM", variables, names, vectors, cells)


def read_fesom_diagnostics(variables: Variables, choices: Choices) -> Cells:
    """Read FESOM's older mesh.diag.nc, without UGRID: nodes (2, n) in radians, elements (3, m)."""
    given = variables["nodes"]
    both = numbers(given, "nodes")
    if both.ndim != 2 or both.shape[0] != 2:
        raise wrong_shape("nodes", "(2, n)", both)
    known = in_degrees(given, 0, "nodes", choices, fixed=False)
    vectors = places(both[0], both[1], (known, known), ("nodes[0]", "nodes[1]"), choices)
    cells, dims = _three(variables, "elements", len(vectors))
    if choices.cells == "faces":
        return _cells("FESOM", dims, vectors, cells)
    made = _cells("FESOM", given.dims[1:], vectors, cells, location="node")
    return made._replace(shape=(len(vectors),))


def _three(
    variables: Variables, name: str, nodes: int
) -> tuple[tuple[Rows, Rows], tuple[Any, ...]]:
    """Return triangles from either order of axes, and their dimension."""
    table = variables[name]
    transposed = table.ndim == 2 and table.shape[0] == 3 and table.shape[1] != 3
    cells = connected(table, name, nodes, start=1, transposed=transposed)
    return cells, (table.dims[1 if transposed else 0],)


def read_exodus(variables: Variables, choices: Choices) -> Cells:
    """Read the elements of all blocks of an Exodus file; numbers start at 1."""
    vectors = _exodus_nodes(variables)
    blocks = sorted(
        (int(name[7:]), name)
        for name in variables
        if name.startswith("connect") and name[7:].isdigit()
    )
    corners, lengths = [], []
    for number, name in blocks:
        kinds = variables.get(f"edge_type{number}")
        if kinds is not None and np.any(kinds.values == 1) and choices.edges != "arc":
            raise InputError(
                f'edge_type{number} says that sides are parallels: give edges="arc" to take them '
                "as arcs of great circles, or make the grid by Grid.from_lonlat"
            )
        counts = variables.get(f"ebepecnt{number}")
        if counts is not None:
            flat, starts = ragged(
                variables[name], name, len(vectors), start=1, counts=numbers(counts, "ebepecnt")
            )
        else:
            # Here 0 is padding, and numbers start at 1.
            width = variables[name].shape[1]
            table = numbers(variables[name], name)
            flat, starts = connected(
                variables[name],
                name,
                len(vectors),
                start=1,
                counts=np.where(table > 0, np.arange(1, width + 1), 0).max(axis=1, initial=0),
            )
        corners.append(flat)
        lengths.append(np.diff(starts))
    every = np.concatenate(lengths)
    # Fields of several blocks are in several variables.
    dims = variables[blocks[0][1]].dims[:1] if len(blocks) == 1 else ()
    return Cells(
        format="Exodus",
        dims=dims,
        shape=(len(every),),
        nodes=vectors,
        corners=np.concatenate(corners),
        starts=np.concatenate(([0], np.cumsum(every))).astype(np.int64),
    )


def _exodus_nodes(variables: Variables) -> Floats:
    """Return the nodes of an Exodus file, which are vectors."""
    if "coord" in variables:
        found = numbers(variables["coord"], "coord").T
    else:
        names = "coordx", "coordy", "coordz"
        missing = [name for name in names if name not in variables]
        if missing:
            raise InputError(f"Exodus: the dataset has no variable {missing[0]}")
        found = np.column_stack([numbers(variables[name], name) for name in names])
    if found.ndim != 2 or found.shape[1] != 3:
        raise ShapeError(f"Exodus: nodes must have three coordinates, got shape {found.shape}")
    # The core reads rows, and files have columns.
    return np.ascontiguousarray(found, dtype=np.float64)


def read_uxarray(given: Any, choices: Choices) -> Cells:
    """Read a uxarray grid by its attributes; its longitudes are in degrees."""
    table = given.face_node_connectivity
    lon, lat = given.node_lon, given.node_lat
    variables = {"node_lon": lon, "node_lat": lat}
    vectors = _nodes(variables, ("node_lon", "node_lat"), choices, fixed=True)
    start = attribute(table, "start_index")
    cells = connected(
        table, "face_node_connectivity", len(vectors), start=0 if start is None else int(start)
    )
    return _cells("uxarray", ("n_face",), vectors, cells)
