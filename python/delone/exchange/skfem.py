"""scikit-fem meshes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.exchange.parts import facet_segments, kind_of, parts_of
from delone.exchange.second import as_order, middles, of_order

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone.exchange.parts import Given, Parts

__all__ = ["to_skfem"]


def to_skfem(mesh: Given, *, order: int = 1) -> Any:
    """Return a `skfem.MeshTri` of triangles in 2-D or a `skfem.MeshTet`, of first or second order.

    Subdomains are ``"region 0"`` and so on if simplices have a ``region``. Boundaries are segments
    or marked faces: ``"marker 0"`` and so on if these have a ``marker``, otherwise ``"segments"``.
    """
    skfem = require("skfem", extra="fem", what="to_skfem")
    parts = parts_of(mesh)
    kinds = ("triangles", "tetrahedra")
    kind = kind_of(parts, what="a scikit-fem mesh", kinds=kinds)
    make = skfem.MeshTri if kind == "triangles" else skfem.MeshTet
    found = make(
        np.ascontiguousarray(parts.points.T),
        np.ascontiguousarray(parts.simplices.T.astype(np.int64)),
    )
    if as_order(order) == 2:
        found = _second(skfem, found, parts)
    region = parts.of_simplices.get("region")
    if region is not None:
        found = found.with_subdomains(_groups(region, np.arange(len(region)), "region"))
    if parts.segments is not None:
        found = found.with_boundaries(_boundaries(parts, found.facets))
    return found


def _second(skfem: Any, mesh: Any, parts: Parts) -> Any:
    """Return a mesh of second order with the same nodes as for meshio and others.

    scikit-fem numbers nodes as degrees of freedom: points, then edges, in its own order.
    """
    triangles = parts.simplices.shape[1] == 3
    made = (skfem.MeshTri2 if triangles else skfem.MeshTet2).from_mesh(mesh)
    edges, _ = middles(parts._replace(segments=None))
    whole = of_order(parts._replace(of_points={}, segments=None), 2).points
    rows = _facets(edges.T, np.asarray(mesh.facets if triangles else mesh.edges).T)
    # Points after the last corner are not vertices in scikit-fem.
    corners = parts.points[: mesh.nvertices]
    places = np.concatenate((corners, whole[len(parts.points) :][rows]))
    made.doflocs = np.ascontiguousarray(places.T)
    return made


def _boundaries(parts: Parts, facets: NDArray[Any]) -> dict[str, NDArray[np.int64]]:
    """The facets that are segments, by the markers of these."""
    pairs, rows = facet_segments(parts)
    numbers = _facets(facets, pairs)
    marker = parts.of_segments.get("marker")
    return {"segments": numbers} if marker is None else _groups(marker[rows], numbers, "marker")


def _groups(
    values: NDArray[Any], numbers: NDArray[np.int64], name: str
) -> dict[str, NDArray[np.int64]]:
    """The indices of each value."""
    return {f"{name} {value}": numbers[values == value] for value in np.unique(values).tolist()}


def _facets(facets: NDArray[Any], pairs: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the number of the facet that each pair or triple of points is."""
    both = np.sort(np.concatenate((np.asarray(facets).T, pairs)), axis=1)
    _, key = np.unique(both, axis=0, return_inverse=True)
    count = facets.shape[1]
    number = np.zeros(len(both), dtype=np.int64)
    number[key[:count]] = np.arange(count)
    return number[key[count:]]
