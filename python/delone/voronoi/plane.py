"""The cells of a 2-D diagram: polygons between rays, whole or clipped.

`dual` describes the arrays of the diagram, `torus` those of a periodic one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone.exchange.geopandas import shapely_or_say
from delone.exchange.polygons import polygons_to_meshio, polygons_to_pyvista
from delone.voronoi import clipping, dual, outline, sites, thin
from delone.voronoi.cells import Cells
from delone.voronoi.results import Cell, Rays
from delone.voronoi.rows import one_gap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices
    from delone._core import Diagram2
    from delone.voronoi.clipping import Clipped
    from delone.voronoi.torus import PeriodicDual

    Arrays = dict[str, NDArray[Any]]

__all__ = ["PlaneCells"]


@dataclass(frozen=True, eq=False, kw_only=True)
class PlaneCells(Cells):
    """The cells of 2-D sites; `dual` is the part without periods of `repeated`."""

    dual: Diagram2
    clip: outline.Clip | None
    repeated: PeriodicDual | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.repeated is not None:
            self._put("repeated", self.repeated.sealed(self.dual))

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
        found: dict[str, Any] = {"points": points, "weights": weights, "workers": workers}
        lengths = None
        if periods is None:
            found["mesh"], found["dual"] = sites.in_plane(points, weights, workers)
        else:
            found["mesh"], repeated, lengths = sites.repeated(points, weights, periods, workers)
            found |= {"dual": repeated.cells, "repeated": repeated, "periods": lengths}
        where = outline.as_clip(clip, points, fix=fix, periods=lengths)
        return cls(clip=where, **found)

    def saved_clip(self) -> Arrays:
        """Return the clip as arrays of a file: a box, or an outline as WKB."""
        box, wkb = np.empty(0), b""
        if self.clip is not None and self.clip.outline is None:
            box = np.array(self.clip.bounds)
        elif self.clip is not None:
            wkb = shapely_or_say().to_wkb(self.clip.outline, output_dimension=2, byte_order=1)
        return {"box": box, "outline": np.frombuffer(wkb, dtype=np.uint8)}

    @classmethod
    def loaded_clip(cls, arrays: Arrays) -> Any:
        """Return the clip of the arrays that `saved_clip` has returned."""
        if len(arrays["outline"]):
            return outline.of_wkb(arrays["outline"].tobytes())
        return tuple(arrays["box"].tolist()) or None

    @property
    def public_clip(self) -> Any:
        """The box, the geometry, or None."""
        if self.clip is None:
            return None
        return self.clip.bounds if self.clip.outline is None else self.clip.outline

    def ridge_rows(self) -> tuple[Indices, Indices]:
        """Return the two vertices of each ridge as compressed rows."""
        ends = self.dual.ends
        starts = np.arange(0, 2 * len(ends) + 1, 2, dtype=np.int32)
        return starts, (ends if not len(self.dual.rays) else np.maximum(ends, -1)).reshape(-1)

    def region_rows(self) -> tuple[Indices, Indices]:
        """Return the vertices of each cell, counter-clockwise, as compressed rows."""
        return one_gap(self.dual.region_starts, self.dual.region_vertices)

    def ridge_offsets(self) -> Indices:
        """Return the number of periods by which the second site of each ridge is moved."""
        if self.repeated is not None:
            return self.repeated.moved
        return np.zeros((len(self.dual.sites), 2), dtype=np.int32)

    def rays(self) -> Rays:
        """Return the unbounded ridges; a line has two rays from one origin."""
        ends, directions = self.dual.ends, self.dual.rays
        ridge, which = np.nonzero(ends < 0)
        other = ends[ridge, 1 - which]
        line = np.flatnonzero(other < 0)
        a, b = self._sites_of(ridge[line])
        weights = None if self.weights is None else self.weights[self.dual.sites[ridge[line]]]
        origin = np.empty((len(ridge), 2))
        origin[line] = dual.foot(a, b, weights)
        origin[other >= 0] = self.dual.vertices[other[other >= 0]]
        direction = directions[~ends[ridge, which]]
        there: NDArray[np.bool_] = np.all(np.isfinite(origin), axis=1)
        there[line] &= self._lies_between(origin[line], ends[ridge[line]])
        return Rays(ridge[there].astype(np.int32), origin[there], direction[there])

    def _lies_between(self, origin: Floats, ends: Indices) -> NDArray[np.bool_]:
        """Return which points of lines lie before the vertices beyond the range that end them."""
        found = np.ones(len(origin), dtype=bool)
        for end in ends.T:
            direction, place = self.dual.rays[~end], self.dual.beyond[~end]
            k = np.abs(direction).argmax(axis=1)[:, None]
            with np.errstate(over="ignore", invalid="ignore"):
                steps = np.take_along_axis(place - origin, k, 1)[:, 0]
                ahead = np.take_along_axis(direction, k, 1)[:, 0] * steps
            found &= ~(ahead <= 0)
        return found

    def _sites_of(self, ridges: NDArray[Any]) -> tuple[Floats, Floats]:
        """Return the coordinates of the two sites of some ridges, as seen from the first site."""
        a, b = self.points[self.dual.sites[ridges]].swapaxes(0, 1)
        if self.periods is None:
            return a, b
        lengths = np.array([length or 0.0 for length in self.periods])
        return a, b + self.ridge_offsets()[ridges] * lengths

    @cached_property
    def left(self) -> Clipped:
        """The clipped cells; without a clip, the bounded ones."""
        return clipping.cells(
            self.points,
            self.weights,
            self.repeated or self.dual,
            self.clip,
            periods=self.periods,
            workers=self._threads,
        )

    # The measures that are meaningless for thin cells.
    measure = "areas"

    def thin(self) -> NDArray[np.bool_]:
        """Return which cells are too thin to have a meaningful area."""
        left = self.left
        found = self._lost((left.areas == 0) & (left.perimeters == 0))
        return found | thin.among(left.areas, left.perimeters, left.starts, left.corners)

    def cell(self, region: int, **common: Any) -> Cell:
        """Return one cell; -1 is the empty one of a hidden site."""
        start, end = self.dual.region_starts[region : region + 2] if region >= 0 else (0, 0)
        entries = self.dual.region_vertices[start:end]
        bounded = region < 0 or (bool(len(entries)) and bool((entries >= 0).all()))
        if not bounded and len(entries):
            entries = np.roll(entries, -int(np.flatnonzero(entries < 0)[0]))
        return Cell(
            vertices=self.dual.vertices[entries[entries >= 0]],
            bounded=bounded,
            parts=self.left.parts(region) if region >= 0 else (),
            perimeter=float(self.left.perimeters[region]) if region >= 0 else 0.0,
            **common,
        )

    def to_pyvista(self) -> Any:
        """Return the bounded or clipped cells as PyVista polygons."""
        starts, corners, values = self._polygons()
        return polygons_to_pyvista(starts, corners, values)

    def to_meshio(self) -> Any:
        """Return the bounded or clipped cells as meshio polygons."""
        starts, corners, values = self._polygons()
        return polygons_to_meshio(starts, corners, values)

    def _polygons(self) -> tuple[Indices, Floats, Arrays]:
        """Return polygons without holes, with the site and the area of the cell of each."""
        starts, corners, cell = self.left.simple()
        return starts, corners, {"site": self.dual.site[cell], "area": self.left.areas[cell]}
