"""Which variables of a dataset describe its grid, and which of them belong to results."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from delone.sphere.formats.structured import bounds_name, healpix_mapping

if TYPE_CHECKING:
    from delone.sphere.formats.cells import Cells

    Variables = dict[str, Any]

__all__ = ["describing", "kept_of_target"]

# Names of variables, by convention.
_NAMES = {
    "SCRIP": r"grid_.*",
    "ESMF": r"node(Coords|Count)|element(Conn|Area|Mask)|numElementConn|centerCoords",
    "MPAS": r".*On(Cell|Edge|Vertex)|(lat|lon|[xyz]|indexTo)(Cell|Edge|Vertex)(ID)?|"
    r"area(Cell|Triangle)|(dc|dv|angle|boundary)(Edge|Vertex)|n(Edges|Cells)On.*",
    "ICON": r"([ce]|v)(lon|lat)(_vertices)?|.*_of_.*|(cell|vertex|edge)_index",
    "GEOS-CS": r"corner_(lons|lats)|lons|lats|anchor|contacts|ncontact|orientation|cubed_sphere",
    "OASIS": r".*\.(lon|lat|clo|cla|srf|msk|ang)",
    "FESOM": r"lon|lat|triag_nodes|nodes|elements|edges|edge_tri|edge_cross_dxdy|"
    r"nod_in_elem2D(_num)?|(nod|elem)_(area|part)|gradient_(sca|vec)_[xy]",
    "Exodus": r"coord[xyz]?|coor_names|connect\d+|e(b|l)_.*|edge_type\d+|ebepecnt\d+|"
    r"global_id\d*|time_whole|info_records|qa_records",
}
# Attributes of a UGRID mesh that name variables.
_TOPOLOGY = re.compile(r".*_(connectivity|coordinates)")


def describing(variables: Variables, cells: Cells) -> set[str]:
    """Return the names of the variables that describe a grid."""
    found: set[str] = set()
    for name in cells.coords or ():
        found.add(str(name))
        bounds = variables[name].attrs.get("bounds", variables[name].encoding.get("bounds"))
        found.add(str(bounds))
        if (bounds := bounds_name(variables, name, required=False)) is not None:
            found.add(bounds)
    if cells.format in _NAMES:
        found |= {name for name in variables if re.fullmatch(_NAMES[cells.format], name)}
    if cells.format == "UGRID":
        for name, part in variables.items():
            if part.attrs.get("cf_role") == "mesh_topology":
                found.add(name)
                for key, value in part.attrs.items():
                    if _TOPOLOGY.fullmatch(key):
                        found |= set(str(value).split())
    mapping = healpix_mapping(variables) if cells.format == "HEALPix" else None
    if mapping is not None:
        found.add(mapping)
        found |= {
            name
            for name, part in variables.items()
            if part.attrs.get("standard_name") == "healpix_index"
        }
    return found & set(variables)


def kept_of_target(variables: Variables, cells: Cells) -> tuple[set[str], dict[str, str]]:
    """Return the variables of a target that belong in results, and the attributes for fields."""
    if cells.format == "HEALPix":
        mapping = healpix_mapping(variables)
        return describing(variables, cells), {"grid_mapping": str(mapping)}
    if cells.format == "UGRID":
        names = describing(variables, cells)
        meshes = [n for n in sorted(names) if variables[n].attrs.get("cf_role") == "mesh_topology"]
        # If there are several meshes, the one whose faces are the cells.
        for name in meshes:
            faces = str(variables[name].attrs.get("face_node_connectivity"))
            nodes = str(variables[name].attrs.get("node_coordinates")).split()
            if cells.location == "node" and set(nodes) == set(cells.coords or ()):
                return names, {"mesh": name, "location": "node"}
            if faces in variables and set(cells.dims) <= set(variables[faces].dims):
                return names, {"mesh": name, "location": "face"}
    return (describing(variables, cells) if cells.format == "CF" else set()), {}
