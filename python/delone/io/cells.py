"""What a constrained triangulation knows of its triangles and edges, as values for files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.refine.meshed import Mesh as QualityMesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.io.registry import Mesh

__all__ = ["cell_values"]


def cell_values(triangulation: Mesh, *, edges: bool) -> dict[str, NDArray[Any]]:
    """Return the values of triangles or edges that come with a triangulation.

    Parameters
    ----------
    triangulation : Delaunay or ConstrainedDelaunay
        The triangulation.
    edges : bool
        Whether edges are written in place of triangles.

    Returns
    -------
    dict of str to ndarray
        ``region`` of triangles, and ``polygon`` where some are inside of one; or ``segment``, 1 for
        edges that are part of one. Nothing for a `Delaunay`.

    Examples
    --------
    >>> from delone import ConstrainedDelaunay
    >>> from delone.io.cells import cell_values
    >>> square = ConstrainedDelaunay([(0, 0), (1, 0), (1, 1), (0, 1)], [(1, 3)])
    >>> cell_values(square, edges=False)
    {'region': array([0, 1], dtype=int32)}
    >>> square.edges[cell_values(square, edges=True)["segment"] == 1].tolist()
    [[1, 3]]
    """
    if not isinstance(triangulation, ConstrainedDelaunay | QualityMesh):
        return {}
    if not edges:
        values: dict[str, NDArray[Any]] = {"region": triangulation.region}
        if isinstance(triangulation, QualityMesh):
            return values
        if triangulation.polygon.max(initial=-1) >= 0:
            values["polygon"] = triangulation.polygon
        return values
    n = np.int64(triangulation.npoints)
    keys, wanted = (
        pairs.min(axis=1) * n + pairs.max(axis=1)
        for pairs in (triangulation.edges, triangulation.segments)
    )
    return {"segment": np.isin(keys, wanted).astype(np.int32)}
