"""Temporary faces at free edges, so that faces that end inside a solid can be recovered.

A point can be moved off an edge only if the faces there divide its surroundings into sectors, so an
edge needs two faces or more. Each face with a free edge therefore becomes the base of a thin
tetrahedron, whose other three faces are temporary: the core recovers them like all others, and then
they are forgotten. Their apexes remain, as added points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._tiling.space.locking import cells
from delone.solids.surface import check_surface

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Indices
    from delone._core import RecoveredFaces

__all__ = ["Curtains", "free_faces"]

# Each round tries the other side of some faces, and every second one half of the height: until
# heights are below the rounding of coordinates.
_MOST_ROUNDS = 128
# The first height of an apex, as a part of the smallest altitude of its face.
_HEIGHT = 0.25


def free_faces(faces: Indices) -> Indices:
    """Return the rows of faces with an edge of no other face, ascending."""
    edges = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    _, of, count = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    free = (count[of.reshape(-1)] == 1).reshape(-1, 3).any(axis=1)
    return np.flatnonzero(free).astype(np.int32)


class Curtains(NamedTuple):
    """Temporary faces: three on each base, which join its edges to an apex."""

    # (k,): the faces that they are on.
    bases: Indices
    # (k, 3): coordinates; the rows of these points follow the given ones.
    apexes: Floats
    # (3 k, 3)
    faces: Indices

    @classmethod
    def on(
        cls, points: Floats, faces: Indices, bases: Indices, workers: int | None
    ) -> Curtains | None:
        """Return temporary faces on the faces `bases`, or None if doubles leave no room for them.

        They meet each other and all faces in common vertices and edges only, and contain no point.
        """
        corners = points[faces[bases]]
        center, normal, height = _frames(corners)
        side = np.ones(len(bases))
        for _ in range(_MOST_ROUNDS):
            made = cls._with(points, faces, bases, center + (side * height)[:, None] * normal)
            bad = made._touching(points, faces, workers) | made._covering(points, faces)
            if not bad.any():
                return made
            # First the other side at the same height, then half of it.
            height[bad & (side < 0)] /= 2
            side[bad] *= -1
        return None

    @classmethod
    def _with(cls, points: Floats, faces: Indices, bases: Indices, apexes: Floats) -> Curtains:
        rows = len(points) + np.arange(len(apexes), dtype=np.int32)
        edges = [(faces[bases, i], faces[bases, i - 2]) for i in range(3)]
        made = np.stack([np.column_stack((*edge, rows)) for edge in edges], axis=1)
        return cls(bases, apexes, made.reshape(-1, 3).astype(np.int32))

    def _touching(self, points: Floats, faces: Indices, workers: int | None) -> Bools:
        """Return which bases have a face that meets others elsewhere, or has no area."""
        everything = np.concatenate((points, self.apexes))
        check = check_surface(
            everything, np.concatenate((faces, self.faces)), limit=None, workers=workers
        )
        bad = np.zeros(len(self.apexes), dtype=bool)
        for rows in (check.pairs.ravel(), check.collinear, check.duplicate_faces.ravel()):
            bad[(rows[rows >= len(faces)] - len(faces)) // 3] = True
        same = check.duplicate_points.ravel()
        bad[same[same >= len(points)] - len(points)] = True
        return bad

    def _covering(self, points: Floats, faces: Indices) -> Bools:
        """Return which closed tetrahedra contain a point other than their corners, or are flat."""
        bad = np.zeros(len(self.bases), dtype=bool)
        for i, (base, apex) in enumerate(zip(faces[self.bases], self.apexes, strict=True)):
            corners = np.concatenate((points[base], apex[None]))
            near = (points >= corners.min(axis=0)) & (points <= corners.max(axis=0))
            rows = np.setdiff1d(np.flatnonzero(near.all(axis=1)), base)
            bad[i] = _is_met(corners, points[rows])
        return bad

    def given(self, rows: Indices, count: int) -> Indices:
        """Return the given faces, `count` of them, that these are or are on."""
        on = self.bases[np.maximum(rows - count, 0) // 3]
        return np.where(rows < count, rows, on)

    def removed(self, made: RecoveredFaces, count: int) -> tuple[Indices, Indices, Indices]:
        """Return tetrahedra, neighbors and walls without the temporary faces, from row `count` on.

        Tetrahedra that only temporary faces separate from the outside are left out.
        """
        walls = np.where(made.walls < count, made.walls, np.int32(-1))
        cell = cells(made.neighbors, walls >= 0)
        open_ones = ((made.neighbors < 0) & (walls < 0)).any(axis=1)
        outside = np.zeros(int(cell.max(initial=-1)) + 1, dtype=bool)
        outside[cell[open_ones]] = True
        kept = ~outside[cell]
        number = np.cumsum(kept, dtype=np.int32) - np.int32(1)
        number[~kept] = -1
        across = made.neighbors[kept]
        neighbors = np.where(across < 0, np.int32(-1), number[across])
        return made.tetrahedra[kept], neighbors, walls[kept]


def _frames(corners: Floats) -> tuple[Floats, Floats, Floats]:
    """Return centers, unit normals and first heights over triangles, (k, 3, 3).

    Only the places of apexes follow from these; whether they can stay is decided exactly. The
    corners are sorted, so that their order does not matter.
    """
    order = np.lexsort((corners[:, :, 2], corners[:, :, 1], corners[:, :, 0]), axis=-1)
    corners = np.take_along_axis(corners, order[:, :, None], axis=1)
    unit = np.abs(corners - corners[:, :1]).max(axis=(1, 2))[:, None, None]
    sides = (corners - corners[:, [1, 2, 0]]) / unit
    normal = np.cross(sides[:, 0], sides[:, 1])
    area = np.linalg.norm(normal, axis=1)
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = np.nan_to_num(normal / area[:, None])
    return corners.mean(axis=1), normal, _HEIGHT * area / longest * unit[:, 0, 0]


def _is_met(corners: Floats, points: Floats) -> bool:
    """Return whether a tetrahedron is flat or contains one of these points, exactly."""
    way = _core.orient3d(*(corner[None] for corner in corners))[0]
    if not way or not len(points):
        return not way
    inside = np.ones(len(points), dtype=bool)
    for k in range(4):
        four = [np.tile(corner, (len(points), 1)) for corner in corners]
        four[k] = points
        inside &= way * _core.orient3d(*four) >= 0
    return bool(inside.any())
