"""What is written to a file: the parts of a mesh, with the heights and values of the caller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone._base.values import as_values
from delone.errors import FileFormatError
from delone.exchange.parts import Parts, parts_of, with_third
from delone.exchange.second import middles, of_order
from delone.io.heights import split_attributes

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats
    from delone.exchange.parts import HasParts

__all__ = ["Content", "Wanted", "content", "require_finite_heights"]


class Wanted(NamedTuple):
    """What a file must contain besides a mesh, as passed to `write_mesh`."""

    z: ArrayLike | None = None
    crs: str | None = None
    edges: bool = False
    attributes: Mapping[str, ArrayLike] | None = None
    order: int = 1
    version: str | None = None

    def refuse(self, files: str, *names: str, use: str = ".vtu") -> None:
        """Raise an error if something is requested that these files cannot store."""
        for name in names:
            if getattr(self, name):
                raise FileFormatError(f"{files} cannot store {name}; use {use}")

    def require_heights(self, files: str, also: str = "") -> None:
        """Raise an error if there are no heights."""
        if self.z is None:
            raise FileFormatError(f"{files} need heights: give z, or write a TIN{also}")


def require_finite_heights(points: Floats, files: str) -> None:
    """Raise an error if a point has no height."""
    if not np.isfinite(points).all():
        raise FileFormatError(f"{files} need a finite height for each point")


class Content(NamedTuple):
    """The parts of a mesh, and the values that the caller adds."""

    own: Parts  # with the values that the mesh has
    heights: NDArray[np.float64] | None  # (n,), the third coordinate of points in 2-D
    of_points: Mapping[str, NDArray[Any]]  # the values that are given, as of_simplices
    of_simplices: Mapping[str, NDArray[Any]]
    order: int = 1
    of_nodes: Mapping[str, NDArray[Any]] = {}  # given values of all nodes of second order

    @property
    def given(self) -> bool:
        """Whether the caller added values."""
        return bool(self.of_points or self.of_simplices or self.of_nodes)

    def whole(self) -> Parts:
        """Return everything; the caller's values replace the mesh's own values of the same name.

        Segments without values are left out: they are among the edges of the mesh, and libraries do
        not read simplex values from some files with several kinds of cells.
        """
        found = self.own if self.own.of_segments else self.own._replace(segments=None)
        found = self._lifted(found)._replace(
            of_points={**found.of_points, **self.of_points},
            of_simplices={**found.of_simplices, **self.of_simplices},
        )
        return of_order(found, self.order, self.of_nodes)

    def bare(self) -> Parts:
        """Return points and simplices with only the caller's values."""
        return self._lifted(Parts(self.own.points, self.own.simplices))._replace(
            of_points=self.of_points, of_simplices=self.of_simplices
        )

    def _lifted(self, parts: Parts) -> Parts:
        if self.heights is None:
            return parts
        points = with_third(parts.points)
        points[:, 2] = self.heights
        return parts._replace(points=points)


def content(
    mesh: HasParts,
    *,
    z: ArrayLike | None = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
    order: int = 1,
) -> Content:
    """Return what is written to a file; with `edges`, edges instead of simplices.

    With ``order=2``, second-order simplices, with values at all nodes or only at points.

    These have ``segment``, 1 for parts of one, where the mesh has segments. Where a mesh has points
    of its own for each simplex, heights and values of points are those of their rows.
    """
    own = parts_of(mesh)
    if edges:
        own = _edges(own, mesh)
    npoints = len(mesh.points)
    given = {name: np.asarray(values) for name, values in (attributes or {}).items()}
    of_nodes, total = {}, None
    if order == 2:
        total = npoints + len(middles(own._replace(segments=None))[0])
        of_nodes = {name: given.pop(name) for name in list(given) if len(given[name]) == total}
    of_points, of_simplices = split_attributes(given, npoints, len(own.simplices), total)
    heights = as_values(z, npoints)
    row = own.of_points.get("row")
    if row is not None:
        of_points = {name: values[row] for name, values in of_points.items()}
        heights = None if heights is None else heights[row]
    return Content(own, heights, of_points, of_simplices, order, of_nodes)


def _edges(parts: Parts, mesh: Any) -> Parts:
    """The edges of a mesh instead of its simplices."""
    edges: NDArray[np.int32] = mesh.edges
    found = Parts(parts.points, edges)
    if parts.segments is None or parts.segments.shape[1] != edges.shape[1]:
        return found
    n = np.int64(len(parts.points))
    keys, wanted = (p.min(axis=1) * n + p.max(axis=1) for p in (edges, parts.segments))
    return found._replace(of_simplices={"segment": np.isin(keys, wanted).astype(np.int32)})
