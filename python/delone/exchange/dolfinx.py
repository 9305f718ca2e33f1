"""The arrays from which DOLFINx creates a mesh; no library is needed for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.parts import facet_segments, kind_of, parts_of
from delone.exchange.second import as_order, of_order

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given

__all__ = ["to_dolfinx_arrays"]


# DOLFINx's order of the nodes of second-order elements, as positions in VTK's order: corners, then
# edges, each opposite a corner or an edge.
_NODES = {3: (0, 1, 2), 6: (0, 1, 2, 4, 5, 3), 10: (0, 1, 2, 3, 9, 8, 5, 7, 6, 4)}


def to_dolfinx_arrays(mesh: Given, *, order: int = 1) -> dict[str, NDArray[Any]]:
    """Return ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``, of triangles or tetrahedra.

    Also return ``facets``, the segments that are edges of triangles or marked faces of tetrahedra,
    and regions and markers as ``cell_tags`` and ``facet_tags``, zero where there are none. With
    ``order=2``, cells and facets have all their nodes, which ``distribute_entity_data`` needs.
    """
    parts = parts_of(mesh)
    kind_of(parts, what="a DOLFINx mesh", kinds=("triangles", "surface", "tetrahedra"))
    pairs, rows = facet_segments(parts)
    region = parts.of_simplices.get("region", np.zeros(len(parts.simplices)))
    marker = parts.of_segments.get("marker")
    tags = np.zeros(len(rows)) if marker is None else marker[rows]
    parts = of_order(parts._replace(segments=pairs, of_points={}), as_order(order))
    cells, facets = parts.simplices, parts.segments
    assert facets is not None
    if parts.order == 2:
        cells, facets = (each[:, _NODES[each.shape[1]]] for each in (cells, facets))
    return {
        "cells": cells.astype(np.int64),
        "x": parts.points.copy(),
        "cell_tags": region.astype(np.int32),
        "facets": facets.astype(np.int64),
        "facet_tags": tags.astype(np.int32),
    }
