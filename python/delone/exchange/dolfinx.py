"""The arrays of which DOLFINx makes a mesh; no library is needed for them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.exchange.parts import facet_segments, kind_of, parts_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given

__all__ = ["to_dolfinx_arrays"]


def to_dolfinx_arrays(mesh: Given) -> dict[str, NDArray[Any]]:
    """Return ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``, of triangles or tetrahedra.

    Beside them ``facets``, the segments that are edges of triangles or marked faces of tetrahedra,
    and regions and markers as ``cell_tags`` and ``facet_tags``, zero where there are none.
    """
    parts = parts_of(mesh)
    kind_of(parts, what="a mesh of DOLFINx", kinds=("triangles", "surface", "tetrahedra"))
    pairs, rows = facet_segments(parts)
    region = parts.of_simplices.get("region", np.zeros(len(parts.simplices)))
    marker = parts.of_segments.get("marker")
    tags = np.zeros(len(rows)) if marker is None else marker[rows]
    return {
        "cells": parts.simplices.astype(np.int64),
        "x": parts.points.copy(),
        "cell_tags": region.astype(np.int32),
        "facets": pairs.astype(np.int64),
        "facet_tags": tags.astype(np.int32),
    }
