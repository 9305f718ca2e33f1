"""The cells of a 3-D diagram: convex polyhedra, whole or clipped.

The arrays of the core: ridge r has the sites ``sites[r]`` and the entries
``ridge_entries[ridge_starts[r]:ridge_starts[r + 1]]``, counter-clockwise as seen from the second
site: a vertex, or ``~i`` for ray i with direction ``rays[i]``, with which an unbounded ridge begins
and ends. Cell c has the site ``site[c]``, its vertices as rows of ``region_starts`` and
``region_vertices`` (ascending, -1 first if it is unbounded), and its ridges as rows of
``region_ridge_starts`` and ``region_ridges``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone.exchange.polyhedra import polyhedra_to_meshio, polyhedra_to_pyvista
from delone.voronoi import polyhedra, sites
from delone.voronoi.bodies import Bodies, Body
from delone.voronoi.cells import Cells
from delone.voronoi.results import PolyhedralCell, Rays
from delone.voronoi.rows import from_the_gap
from delone.voronoi.sites import refuse_periods

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone._core import Diagram3

    Arrays = dict[str, NDArray[Any]]

__all__ = ["SpaceCells"]

# If a surface has less area, the volume may be below the range of doubles.
_SMALL = 2.0**-600


@dataclass(frozen=True, eq=False, kw_only=True)
class SpaceCells(Cells):
    """The cells of 3-D sites."""

    dual: Diagram3
    clip: polyhedra.Polyhedron | None

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
        """Return the cells of sites, for the arguments of `delone.Voronoi`."""
        refuse_periods(periods)
        mesh, arrays = sites.in_space(points, weights, workers)
        where = polyhedra.as_polyhedron(clip, points)
        return cls(
            points=points, weights=weights, mesh=mesh, dual=arrays, clip=where, workers=workers
        )

    def saved_clip(self) -> Arrays:
        """Return the clip as arrays of a file: a box, or a polyhedron."""
        return polyhedra.saved(self.clip)

    @classmethod
    def loaded_clip(cls, arrays: Arrays) -> Any:
        """Return the clip of the arrays that `saved_clip` has returned."""
        return polyhedra.loaded(arrays)

    @property
    def public_clip(self) -> polyhedra.Polyhedron | None:
        """The polyhedron, or None."""
        return self.clip

    def ridge_rows(self) -> tuple[Indices, Indices]:
        """Return the vertices around each ridge as compressed rows."""
        return from_the_gap(self.dual.ridge_starts, self.dual.ridge_entries)

    def region_rows(self) -> tuple[Indices, Indices]:
        """Return the vertices of each cell, ascending, as compressed rows."""
        return self.dual.region_starts, self.dual.region_vertices

    def rays(self) -> Rays:
        """The unbounded ridges, two rows for each, whose directions point outward.

        In the first row, the boundary of the ridge comes from infinity; in the second, it goes to
        infinity.
        """
        starts, entries = self.dual.ridge_starts.astype(np.int64), self.dual.ridge_entries
        first, last = starts[:-1], starts[1:] - 1
        ridge = np.flatnonzero(entries[first] < 0)
        at = np.stack((first[ridge], last[ridge]), axis=1)
        beside = at + np.array([1, -1])
        there = (entries[at] < 0) & (entries[beside] >= 0)
        rows = np.broadcast_to(ridge[:, None], at.shape)[there].astype(np.int32)
        origin = self.dual.vertices[entries[beside[there]]]
        return Rays(rows, origin, self.dual.rays[~entries[at[there]]])

    @cached_property
    def left(self) -> Bodies:
        """The clipped cells; without a clip, the bounded ones."""
        return Bodies(self.points, self.weights, self.dual, self.clip, self._threads)

    # The measures that are meaningless for thin cells.
    measure = "volumes"

    def thin(self) -> NDArray[np.bool_]:
        """Return which cells are too thin to have a meaningful volume."""
        areas = self.left.areas
        # Volumes below the range of doubles are 0 without being thin.
        return self._lost((self.left.volumes == 0) & ~((areas > 0) & (areas < _SMALL)))

    def cell(self, region: int, *, site: int, **common: Any) -> PolyhedralCell:
        """Return one cell; -1 is the empty one of a hidden site."""
        body = self.left.body(region)
        pairs = self.dual.sites[np.maximum(body.ridges, 0)].reshape(-1, 2)
        beyond = np.where(body.ridges >= 0, np.where(pairs[:, 0] == site, *pairs[:, ::-1].T), -1)
        start = self.dual.region_starts[region]
        return PolyhedralCell(
            site=site,
            bounded=region < 0 or bool(self.dual.region_vertices[start] >= 0),
            vertices=body.vertices,
            faces=body.faces,
            beyond=beyond.astype(np.int32),
            volume=float(self.left.volumes[region]) if region >= 0 else 0.0,
            **common,
        )

    def to_pyvista(self) -> Any:
        """Return the bounded or clipped cells as PyVista polyhedra."""
        return polyhedra_to_pyvista(*self._bodies())

    def to_meshio(self) -> Any:
        """Return the bounded or clipped cells as meshio polyhedra."""
        return polyhedra_to_meshio(*self._bodies())

    def _bodies(self) -> tuple[list[Body], Arrays]:
        """Return the cells that have faces, with the site and the volume of each."""
        shapes = {cell: self.left.body(cell) for cell in np.argsort(self.dual.site).tolist()}
        found = {cell: body for cell, body in shapes.items() if body.faces}
        rows = np.array(list(found), dtype=np.int64)
        return list(found.values()), {
            "site": self.dual.site[rows],
            "volume": self.left.volumes[rows],
        }
