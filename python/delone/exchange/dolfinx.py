"""The arrays of which DOLFINx makes a mesh; no library is needed for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.parts import facet_segments, kind_of, parts_of
from delone.exchange.second import as_order, of_order

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given

__all__ = ["to_dolfinx_arrays"]


# The edges of a cell of second order as DOLFINx has them, each opposite to a corner or an edge, by
# their places in the order of VTK.
_EDGES = {6: (1, 2, 0), 10: (5, 4, 1, 3, 2, 0)}


def to_dolfinx_arrays(mesh: Given, *, order: int = 1) -> dict[str, NDArray[Any]]:
    """Return ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``, of triangles or tetrahedra.

    Beside them ``facets``, the segments that are edges of triangles or marked faces of tetrahedra,
    and regions and markers as ``cell_tags`` and ``facet_tags``, zero where there are none. Facets
    have corners alone in any order.
    """
    parts = parts_of(mesh)
    kind_of(parts, what="a mesh of DOLFINx", kinds=("triangles", "surface", "tetrahedra"))
    pairs, rows = facet_segments(parts)
    region = parts.of_simplices.get("region", np.zeros(len(parts.simplices)))
    marker = parts.of_segments.get("marker")
    tags = np.zeros(len(rows)) if marker is None else marker[rows]
    parts = of_order(parts._replace(segments=None, of_points={}), as_order(order))
    cells = parts.simplices.astype(np.int64)
    if parts.order == 2:
        corners = cells.shape[1] - len(_EDGES[cells.shape[1]])
        places = [corners + k for k in _EDGES[cells.shape[1]]]
        cells = cells[:, [*range(corners), *places]]
    return {
        "cells": cells,
        "x": parts.points.copy(),
        "cell_tags": region.astype(np.int32),
        "facets": pairs.astype(np.int64),
        "facet_tags": tags.astype(np.int32),
    }
