"""Edges, boundary and sizes of the current state of a live triangulation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone import _core
from delone.delaunay import Delaunay
from delone.dynamic.present import Present

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["Measured"]


class Measured(Present):
    """What is computed from the current arrays, once after each edit."""

    __slots__ = ("_whole",)

    # The arrays of a state, and a mesh of them that keeps what is computed.
    _whole: tuple[_core.LiveArrays, Delaunay] | None

    def _mesh(self) -> Delaunay:
        """Return the current arrays as a mesh, which may not have a simplex."""
        made, whole = self._arrays(), self._whole
        if whole is None or whole[0] is not made:
            arrays: dict[str, NDArray[Any]] = {
                "points": made.points,
                "simplices": made.simplices,
                "neighbors": made.neighbors,
                "duplicates": made.duplicates,
            }
            whole = made, Delaunay._from_arrays(arrays, (), self._workers)
            self._whole = whole
        return whole[1]

    @property
    def boundary(self) -> Indices:
        """The facets with a simplex on one side only, (h, d), as rows of `points`.

        As in `Delaunay`; empty if there is no simplex, like everything below.
        """
        return self._mesh().boundary

    @property
    def edges(self) -> Indices:
        """Every edge once, (k, 2), as rows of `points`: the smaller row first, rows ascending."""
        return self._mesh().edges

    @property
    def convex_hull(self) -> Indices:
        """The facets of the convex hull, (h, d), as rows of `points`: the same as `boundary`."""
        return self._mesh().boundary

    @property
    def hull(self) -> NDArray[np.int64]:
        """The vertices on the convex hull, (h,), as rows of `points`.

        In 2-D, counter-clockwise from the lexicographically smallest point on; in 3-D, ascending.
        """
        mesh = self._mesh()
        return mesh.hull if mesh.nsimplex else mesh.boundary[:, 0].astype("int64")

    @property
    def circumcenters(self) -> Floats:
        """Centers of the circles or spheres through the corners of simplices, (m, d)."""
        return self._mesh().circumcenters

    @property
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points; 2-D only."""
        return self._mesh().areas

    @property
    def volumes(self) -> Floats:
        """Volumes of the tetrahedra, (m,), in the cube of the unit of the points; 3-D only."""
        return self._mesh().volumes

    def quality(self) -> Any:
        """Measure the shapes of the current simplices.

        Returns
        -------
        Quality or TetQuality
            As `Delaunay.quality`.

        Examples
        --------
        >>> from delone import Dynamic
        >>> Dynamic([(0, 0), (1, 0), (0, 1)]).quality().largest_angle
        array([90.])
        """
        return self._mesh().quality()
