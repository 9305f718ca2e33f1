"""The cells of a diagram in four to eight dimensions: their vertices, without measures.

The core computes the arrays. From 4-D on, the vertices of a ridge have no cyclic order, so they are
in ascending order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

from delone._base.arrays import as_workers
from delone._tiling.higher.dual import DiagramN, dual
from delone.delaunay import Delaunay
from delone.errors import InputError
from delone.voronoi.cells import Cells
from delone.voronoi.sites import refuse_periods

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = ["HigherCells", "of_mesh"]


def of_mesh(mesh: Delaunay) -> DiagramN:
    """Return the dual of a triangulation; duplicate rows do not have a cell."""
    arrays = mesh.points, mesh.simplices, mesh.neighbors, mesh.circumcenters
    return dual(*arrays, as_workers(mesh._workers))


@dataclass(frozen=True, eq=False, kw_only=True)
class HigherCells(Cells):
    """The cells of sites with four to eight coordinates."""

    dual: DiagramN
    clip: None = None

    @classmethod
    def made(
        cls,
        points: Floats,
        weights: Floats | None,
        *,
        clip: Any,
        fix: bool,
        periods: Any,
        workers: int | None,
    ) -> Self:
        """Return the cells of sites, given the arguments of `delone.Voronoi`."""
        if clip is not None:
            raise InputError("a clip is only available in 2-D and 3-D")
        if weights is not None:
            raise InputError("weights are only available in 2-D and 3-D")
        refuse_periods(periods)
        mesh = Delaunay(points, workers=workers, planar=True)
        arrays = of_mesh(mesh)
        duplicate, first = mesh._duplicates.T
        arrays.region[duplicate] = arrays.region[first]
        return cls(points=points, weights=None, mesh=mesh, dual=arrays, workers=workers)

    def saved_clip(self) -> dict[str, NDArray[Any]]:
        """Return an empty dictionary: a clip is only available in 2-D and 3-D."""
        return {}

    @classmethod
    def loaded_clip(cls, arrays: dict[str, NDArray[Any]]) -> Any:
        """Return None: a clip is only available in 2-D and 3-D."""
        return None

    @property
    def public_clip(self) -> None:
        """Always None."""
        return

    def ridge_rows(self) -> tuple[Indices, Indices]:
        """Return the vertices of each ridge, ascending, as compressed rows."""
        return self.dual.ridge_starts, self.dual.ridge_entries

    def region_rows(self) -> tuple[Indices, Indices]:
        """Return the vertices of each cell, ascending, as compressed rows."""
        return self.dual.region_starts, self.dual.region_vertices
