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
    """Return the arrays of which DOLFINx makes a mesh.

    Parameters
    ----------
    mesh : Parts, mesh of delone, or pair of points and simplices
        Triangles in 2-D or 3-D, or tetrahedra.

    Returns
    -------
    dict of ndarray
        ``cells`` and ``x`` for ``dolfinx.mesh.create_mesh``; ``cell_tags``, the regions, zero
        where there are none; ``facets``, the segments that are edges of triangles, and
        ``facet_tags``, their markers, zero where there are none. Tetrahedra have no segments: their
        ``facets`` have the shape (0, 3).

    Raises
    ------
    InputError
        The simplices are edges.

    Examples
    --------
    >>> from delone.exchange.dolfinx import to_dolfinx_arrays
    >>> arrays = to_dolfinx_arrays(([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]))
    >>> arrays["cells"].tolist(), arrays["facets"].shape
    ([[0, 1, 2]], (0, 2))
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
