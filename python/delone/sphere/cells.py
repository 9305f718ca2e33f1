"""The arrays of a Voronoi diagram on the sphere, from a triangulation or from one great circle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from delone import _core
from delone._base.arrays import as_workers

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices
    from delone.sphere.delaunay import Delaunay

__all__ = ["Cells", "cells_of", "lunes"]


@dataclass(frozen=True, eq=False, kw_only=True)
class Cells:
    """Vertices, ridges and cells; cells are in the order of the rows of their sites."""

    vertices: Floats
    # The sites to the left and right of each ridge, seen from its first vertex to its second.
    sites: Indices
    ends: Indices
    # The cell of each row; -1 for duplicates.
    cell: Indices
    starts: Indices
    entries: Indices
    # The edges that ridges cross, with the corners next to them, (r, 4); for lunes, measures.
    around: Indices | None
    measures: tuple[Floats, Floats] | None
    simplex_vertex: Indices
    # For lunes, the midpoint of each ridge as a unit vector, (r, 3).
    middles: Floats | None = None

    def spans(self, vectors: Floats, workers: int) -> tuple[Floats, Floats]:
        """Return the length of each ridge, and the areas from its two sites to it, (r, 2)."""
        if self.measures is not None:
            return self.measures
        assert self.around is not None
        found = _core.sphere_spans(vectors, self.around, workers)
        return found[:, 0].copy(), np.repeat(found[:, 1:], 2, axis=1)


def cells_of(mesh: Delaunay) -> Cells:
    """Return the cells of the vertices of a triangulation."""
    if mesh.npoints - len(mesh.duplicates) > 3:
        workers = as_workers(mesh.workers)
        cells = _dual_cells(mesh.vectors, mesh.simplices, mesh.neighbors, workers)
        if len(cells.vertices) > 1:
            return cells
    # All sites are on one circle.
    after = dict(mesh.boundary.tolist())
    chain = [int(mesh.boundary[0, 0])]
    while len(chain) < len(after):
        chain.append(after[chain[-1]])
    rows = np.array(chain, dtype=np.int32)
    return lunes(rows, mesh.points, mesh.circumcenters[0], mesh.nsimplex)


def _dual_cells(vectors: Floats, simplices: Indices, neighbors: Indices, workers: int) -> Cells:
    """Return the dual of a triangulation of at least four directions."""
    made = _core.sphere_dual(vectors, simplices, neighbors, True, workers)
    corners = made.simplices[made.facet]
    return Cells(
        vertices=_core.sphere_circumcenters(vectors, corners, workers),
        # A ridge crosses its edge from left to right, with the head of the edge on its left.
        sites=np.ascontiguousarray(made.around[:, 1::-1]),
        ends=made.ends,
        cell=made.cell,
        starts=made.starts,
        entries=made.vertices,
        around=made.around,
        measures=None,
        simplex_vertex=made.vertex[: len(simplices)],
    )


def lunes(chain: Indices, points: Floats, axis: Floats, simplices: int) -> Cells:
    """Return the cells of at least two sites on one circle: lunes from pole to pole.

    `chain` has the rows of the sites, counter-clockwise around the axis, a unit vector, for two
    sites the shorter way first, and `points` the unit vectors of all rows. The axis is vertex 0 and
    the opposite direction vertex 1. All `simplices` triangles are around vertex 0.
    """
    count = len(chain)
    after = np.roll(chain, -1)
    middles = _middles(points[chain], points[after], axis)
    before = np.roll(middles, 1, axis=0)
    # The angle of a lune at the poles is that between its bisectors.
    turns = np.arctan2(
        np.linalg.norm(np.cross(before, middles), axis=1), np.einsum("ij,ij->i", before, middles)
    )
    # Down from the axis, the next site is to the left. Each cell is counted at one of its ridges.
    sites = np.column_stack((after, chain)).astype(np.int32)
    cell = np.full(len(points), -1, dtype=np.int32)
    cell[np.sort(chain)] = np.arange(count)
    ends = np.tile(np.array([0, 1], dtype=np.int32), (count, 1))
    return Cells(
        vertices=np.stack((axis, -axis)),
        sites=sites,
        ends=ends,
        cell=cell,
        starts=np.arange(0, 2 * count + 1, 2, dtype=np.int32),
        # Down the western side and up the eastern one.
        entries=ends.ravel(),
        around=None,
        measures=(np.full(count, np.pi), np.column_stack((np.zeros(count), 2 * turns))),
        simplex_vertex=np.zeros(simplices, dtype=np.int32),
        middles=middles,
    )


def _middles(tails: Floats, heads: Floats, axis: Floats) -> Floats:
    """Return the unit vectors halfway from each site on a circle to the next one.

    They lie in the plane through the axis that is perpendicular to the chord. For close sites, the
    sum gives that plane, because their difference may consist only of rounding errors.
    """
    chords = heads - tails
    # Seen along the axis, from the middle of the circle.
    tails, heads = (_normal(each - np.outer(each @ axis, axis)) for each in (tails, heads))
    half = tails + heads
    close = np.einsum("ij,ij->i", tails, heads) > 0
    lengths = np.linalg.norm(heads - tails, axis=1)
    if close.all():
        # Steps of less than a quarter around the circle; or all sites are within a quarter, and the
        # longest step, back to the first of them, is the rest of the circle.
        longest = 1 if len(tails) == 2 else int(lengths.argmax())
        angles = 2 * np.arcsin(np.minimum(lengths / 2, 1))
        if len(tails) == 2 or angles.sum() - angles[longest] < np.pi:
            half[longest] *= -1
    return _normal(np.where(close[:, None], half, np.cross(chords, axis)))


def _normal(vectors: Floats) -> Floats:
    """Return vectors scaled to length 1; none may be zero."""
    found: Floats = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return found
