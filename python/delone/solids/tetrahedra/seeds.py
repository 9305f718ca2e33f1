"""Holes and regions by points in them, located exactly."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_plain_array, as_points, as_workers, require_finite, wrong_shape
from delone._base.counting import agreed, counted, listed
from delone._tiling.space.topology import FACES
from delone.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from delone._base.types import Bools, Floats, Indices

__all__ = ["Cells", "Tiling", "as_hole_seeds", "as_region_seeds", "located", "of_voids"]

_SHOWN = 10
# This many of the largest tetrahedra of a void are tried: rounding may move the center of a thin
# one.
_TRIED = 20


def as_hole_seeds(holes: ArrayLike | None) -> Floats:
    """Return seeds, (k, 3)."""
    return _as_rows(holes, "holes", (3,))


def as_region_seeds(regions: ArrayLike | None) -> tuple[Floats, Indices]:
    """Return seeds, (k, 3), and their labels: the fourth column, or the row."""
    rows = _as_rows(regions, "regions", (3, 4))
    if rows.shape[1] == 3:
        return rows, np.arange(len(rows), dtype=np.int32)
    labels = rows[:, 3]
    wrong = np.flatnonzero((labels != np.floor(labels)) | (labels < 0) | (labels >= 2**31))
    if len(wrong):
        raise InputError(
            f"regions: {counted(len(wrong), 'label')} (the fourth column) "
            f"{agreed(len(wrong), 'is not an integer', 'are not integers')} from 0 to 2**31 - 1; "
            f"{agreed(len(wrong), 'row', 'rows')} {listed(wrong, _SHOWN)}"
        )
    return np.ascontiguousarray(rows[:, :3]), labels.astype(np.int32)


def _as_rows(seeds: ArrayLike | None, name: str, columns: tuple[int, ...]) -> Floats:
    array = np.empty((0, 3)) if seeds is None else as_plain_array(seeds, name)
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 3))
    if array.ndim != 2 or array.shape[1] not in columns:
        wanted = " or ".join(f"(k, {n})" for n in columns)
        raise wrong_shape(name, wanted, array)
    # The conversion takes two or three columns.
    place = as_points(array[:, :3], ndim=3, name=name)
    require_finite(place, name=name)
    if array.shape[1] == 3:
        return place
    label = as_points(np.ascontiguousarray(array[:, 2:]), ndim=2, name=name)
    return np.column_stack((place, label[:, 1]))


class Tiling(NamedTuple):
    """All tetrahedra that faces enclose, and the faces."""

    points: Floats
    simplices: Indices
    neighbors: Indices
    faces: Indices


def located(
    tiling: Tiling, seeds: Floats, name: str, workers: int | None, *, kind: str = "seed"
) -> Indices:
    """Return the tetrahedron of each seed, which must be inside and not on a face."""
    if not len(seeds):
        return np.empty(0, dtype=np.int32)
    points, simplices, neighbors, faces = tiling
    found = _core.Locator3(points, simplices, neighbors).find(seeds, as_workers(workers))
    outside = np.flatnonzero(found < 0)
    if len(outside):
        raise InputError(
            f"{name}: {counted(len(outside), kind)} outside all that the faces enclose: "
            f"{agreed(len(outside), 'row', 'rows')} {listed(outside, _SHOWN)}"
        )
    on = np.flatnonzero(_on_surface(points, simplices[found], faces, seeds))
    if len(on):
        raise InputError(
            f"{name}: {counted(len(on), kind)} on a face of the surface: "
            f"{agreed(len(on), 'row', 'rows')} {listed(on, _SHOWN)}; move "
            f"{agreed(len(on), 'it', 'them')} inside"
        )
    return found


def _on_surface(points: Floats, corners: Indices, faces: Indices, places: Floats) -> Bools:
    """Return which places are on faces; each is in or on the tetrahedron of its corners.

    Faces are faces of tetrahedra. So a place inside a face, an edge or at a vertex of a tetrahedron
    is on a face if that face, edge or vertex is one of a face.
    """
    zero = np.empty((len(places), 4), dtype=bool)
    for k, face in enumerate(FACES):
        a, b, c = (points[corners[:, i]] for i in face)
        zero[:, k] = _core.orient3d(a, b, c, places) == 0
    on = np.zeros(len(places), dtype=bool)
    rows = np.flatnonzero(zero.any(axis=1))
    if not len(rows):
        return on
    ascending = {tuple(sorted(face)) for face in faces.tolist()}
    known: dict[int, set[tuple[int, ...]]] = {
        3: ascending,
        2: {pair for a, b, c in ascending for pair in ((a, b), (a, c), (b, c))},
        1: {(a,) for face in ascending for a in face},
    }
    for row in rows.tolist():
        # The place is in the interior of the simplex of the corners whose weights are not zero.
        simplex = tuple(sorted(corners[row][~zero[row]].tolist()))
        on[row] = simplex in known[len(simplex)]
    return on


class Cells(NamedTuple):
    """The cell of each tetrahedron, and the row of the face opposite each corner, or -1."""

    cell: Indices
    face: Indices


def of_voids(
    tiling: Tiling, cells: Cells, kept: Bools, there: Bools, workers: int | None
) -> Floats:
    """Return a point in each cell that is empty and that remaining faces enclose, (h, 3).

    `there` says which faces remain. A cell that is open to the outside, where faces do not remain,
    needs no seed.
    """
    cell = cells.cell
    empty = np.setdiff1d(np.unique(cell[~kept]), sorted(_opened(tiling, cells, kept, there)))
    if not len(empty):
        return np.empty((0, 3))
    rows = np.flatnonzero(np.isin(cell, empty))
    a, b, c, d = (tiling.points[column] for column in tiling.simplices[rows].T)
    size = np.abs(np.einsum("ij,ij->i", a - d, np.cross(b - d, c - d)))
    rows = rows[np.lexsort((-size, cell[rows]))]
    find = _core.Locator3(*tiling[:3]).find
    places = []
    for start, end in pairwise([*np.searchsorted(cell[rows], empty).tolist(), len(rows)]):
        tried = rows[start : min(end, start + _TRIED)]
        centers = tiling.points[tiling.simplices[tried]].mean(axis=1)
        found = find(centers, as_workers(workers))
        right = (found >= 0) & (cell[found] == cell[tried])
        right[right] = ~_on_surface(
            tiling.points, tiling.simplices[found[right]], tiling.faces, centers[right]
        )
        places += centers[np.flatnonzero(right)[:1]].tolist()
    return np.array(places).reshape(-1, 3)


def _opened(tiling: Tiling, cells: Cells, kept: Bools, there: Bools) -> set[int]:
    """Return the empty cells connected to the outside through faces that do not remain."""
    cell, face = cells
    gone = (face >= 0) & ~there[face] & ~kept[:, None]
    t, k = np.nonzero(gone)
    beyond = tiling.neighbors[t, k]
    other = np.where(beyond < 0, -1, cell[beyond])
    pairs = {frozenset(pair) for pair in zip(cell[t].tolist(), other.tolist(), strict=True)}
    reached = {-1}
    # Terminates: each round but the last reaches another cell.
    while more := {each for pair in pairs if pair & reached for each in pair} - reached:
        reached |= more
    return reached - {-1}
