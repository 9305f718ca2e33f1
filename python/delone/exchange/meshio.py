"""meshio meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.exchange.parts import kind_of, parts_of, with_third
from delone.exchange.second import as_order, of_order

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given, Parts

__all__ = ["TAGS", "region_tags", "to_meshio"]

# Names of cells by kind and order, and of facets by the kind that they bound.
_CELLS = {
    "edges": ("line", "line3"),
    "triangles": ("triangle", "triangle6"),
    "surface": ("triangle", "triangle6"),
    "tetrahedra": ("tetra", "tetra10"),
}
_FACETS = {"triangles": "edges", "surface": "edges", "tetrahedra": "triangles"}
# The names by which programs that read MSH files identify parts of a mesh.
TAGS = ("gmsh:physical", "gmsh:geometrical")


def to_meshio(mesh: Given, *, order: int = 1) -> Any:
    """Return a `meshio.Mesh` in 3-D; segments, or marked faces, are a second block of cells.

    This block has the type ``line`` or ``triangle``; with ``order=2``, ``line3`` or ``triangle6``.
    If only simplices have a value, segments get -1 (integers) or NaN; if only segments have one,
    simplices get 0 or NaN. With a ``marker``, it and regions, from 1 on, are Gmsh tags.
    """
    meshio = require("meshio", extra="mesh", what="to_meshio")
    parts = parts_of(mesh)
    kind = kind_of(parts, what="a meshio mesh")
    parts = of_order(parts, as_order(order))
    cells = [(_CELLS[kind][parts.order - 1], parts.simplices)]
    if parts.segments is not None:
        cells.append((_CELLS[_FACETS[kind]][parts.order - 1], parts.segments))
    return meshio.Mesh(
        with_third(parts.points),
        cells,
        point_data={name: np.array(values) for name, values in parts.of_points.items()},
        cell_data=_values(parts) | _tags(parts),
    )


def _values(parts: Parts) -> dict[str, list[NDArray[Any]]]:
    """The values of simplices and of segments, block by block."""
    if parts.segments is None:
        return {name: [np.array(values)] for name, values in parts.of_simplices.items()}
    found = {}
    for name in dict.fromkeys((*parts.of_simplices, *parts.of_segments)):
        first, second = parts.of_simplices.get(name), parts.of_segments.get(name)
        if first is None:
            first = _missing(parts.of_segments[name], len(parts.simplices), 0)
        if second is None:
            second = _missing(first, len(parts.segments), -1)
        found[name] = [np.array(first), np.array(second)]
    return found


def _missing(like: NDArray[Any], count: int, integer: int) -> NDArray[Any]:
    """What represents a missing value: an integer for signed integers, otherwise NaN."""
    if like.dtype.kind == "i":
        return np.full(count, integer, dtype=like.dtype)
    return np.full(count, np.nan)


def _tags(parts: Parts) -> dict[str, list[NDArray[Any]]]:
    """Regions and markers as in Gmsh, where 0 means no part of the mesh."""
    if parts.segments is None or "marker" not in parts.of_segments:
        return {}
    none = np.zeros(len(parts.simplices), dtype=np.int32)
    region = region_tags(parts.of_simplices.get("region", none))
    marker = parts.of_segments["marker"].astype(np.int64)
    # Gmsh does not allow negative numbers: they follow the largest one.
    below = np.unique(marker[marker < 0])
    numbers = max(0, marker.max(initial=0)) + 1 + np.arange(len(below))
    marker[marker < 0] = numbers[np.searchsorted(below, marker[marker < 0])]
    tags = [region, marker.astype(np.int32)]
    return {name: [tag.copy() for tag in tags] for name in TAGS}


def region_tags(region: NDArray[Any]) -> NDArray[np.int32]:
    """Return the numbers of regions as in Gmsh, from 1 on."""
    found = np.asarray(region).astype(np.int64)
    if found.min(initial=1) < 1:
        found += 1 - found.min(initial=1)
    return found.astype(np.int32)
