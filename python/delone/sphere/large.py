"""Cells that no hemisphere contains, as parts that the core can use.

Each cell of the core lies within a hemisphere. A larger one is the union of its parts: the outer
rings of a multipolygon, each with its holes; or, if the rings alone do not determine which side is
meant, triangles between the corners and a few added points. No corner moves, so parts meet exactly.
"""

from __future__ import annotations

import itertools
import warnings
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone._base.arrays import as_choice, as_workers
from delone._base.counting import agreed, counted
from delone._base.georeference import caller_level
from delone.errors import InputError
from delone.sphere.constrained import WINDINGS, ConstrainedDelaunay, Given
from delone.sphere.faults import CROSSING, EMPTY, LARGE, fault_error
from delone.sphere.land import Rings, first_polygon
from delone.sphere.nested import nested, refuse
from delone.sphere.sides import Origin, PolygonWarning

if TYPE_CHECKING:
    from delone._base.types import Bools, Floats, Rows

    Arrays = tuple[Floats, Rows, Rows, Bools]

__all__ = ["Parts", "overlaps_of", "tell_clockwise", "wound"]

# Points added to the corners, so that no triangle is nearly as large as a hemisphere.
_BETWEEN = np.array([v for v in itertools.product((-1.0, 0.0, 1.0), repeat=3) if any(v)])
# Each large cell is triangulated separately, so there is a limit.
_MOST = 1000
# Sums of rounded areas, in steradians, count as half of the sphere within this.
_HALF = 1e-9
# Smaller clockwise cells, in steradians, are hardly meant as the rest of the sphere. On the Earth
# these are 20 million square kilometers; the largest country has 17.
_BROAD = 0.5


class _Checked(NamedTuple):
    """The same as the core's CheckedCells, for cells in parts."""

    areas: Floats
    faults: Any
    turned: Bools
    concave: Bools
    repeated: int


class _Shared(NamedTuple):
    """The same as the core's SharedCells, for cells in parts."""

    indptr: Rows
    indices: Any
    areas: Floats
    first: Floats
    second: Floats


class _Part(NamedTuple):
    """The triangles of a cell, (k, 3, 3), their area, and whether its rings nest as they must."""

    triangles: Floats
    area: float
    nested: bool


class Parts:
    """Cells of which those that no hemisphere contains are the unions of their parts."""

    def __init__(self, arrays: Arrays, faults: Any) -> None:
        vectors, rings, cells, holes = arrays
        self.faults, self.large = faults, faults == LARGE
        number = np.repeat(np.arange(len(cells) - 1), np.diff(cells))
        begins = self.large[number] & ~holes
        begins[cells[:-1][np.diff(cells) > 0]] = True
        first = np.flatnonzero(begins)
        # The cell of each part.
        self.owner = number[first]
        starts = np.append(first, len(holes)).astype(np.int64)
        self.arrays = vectors, rings, starts, holes
        self.core = _core.CellGrid.polygons(*self.arrays)

    def check(self, crossing: bool, workers: int) -> _Checked:
        """Return the results for each cell."""
        found = self.core.check(crossing, workers)
        count = len(self.faults)
        faults = np.where(self.large, 0, self.faults)
        wrong = np.flatnonzero(found.faults > EMPTY)
        np.maximum.at(faults, self.owner[wrong], found.faults[wrong])
        areas = _sums(self.owner, found.areas, count)
        faults[self.large & (areas == 0) & (faults == 0)] = EMPTY
        turned, concave = np.zeros(count, dtype=bool), self.large.copy()
        turned[self.owner[found.turned]] = True
        concave[self.owner[found.concave]] = True
        return _Checked(areas, faults, turned, concave, found.repeated)


def _sums(rows: Rows, values: Floats, count: int) -> Floats:
    """Return the sum of the values of each row."""
    return np.bincount(rows, values, count).astype(np.float64)


def overlaps_of(one: Any, other: Any, workers: int) -> Any:
    """Return the areas that cells of two grids share, whether in parts or not."""
    parts = [each if isinstance(each, Parts) else None for each in (one, other)]
    cores = [made.core if made else each for made, each in zip(parts, (one, other), strict=True)]
    found = cores[0].overlaps(cores[1], workers)
    if not any(parts):
        return found
    counts = len(found.first), len(found.second)
    owners = [
        part.owner if part else np.arange(count) for part, count in zip(parts, counts, strict=True)
    ]
    sizes = [len(part.faults) if part else count for part, count in zip(parts, counts, strict=True)]
    row = owners[0][np.repeat(np.arange(counts[0]), np.diff(found.indptr))]
    keys, at = np.unique(row * sizes[1] + owners[1][found.indices], return_inverse=True)
    covered = [
        _sums(owner, sums, size)
        for owner, sums, size in zip(owners, (found.first, found.second), sizes, strict=True)
    ]
    per_row = np.bincount(keys // sizes[1], minlength=sizes[0])
    return _Shared(
        np.concatenate(([0], np.cumsum(per_row))).astype(found.indptr.dtype),
        (keys % sizes[1]).astype(found.indices.dtype),
        _sums(at, found.areas, len(keys)),
        covered[0],
        covered[1],
    )


def wound(arrays: Arrays, winding: str, workers: int | None) -> tuple[Arrays, Rows]:
    """Return cells on the side of their outer rings that `winding` selects.

    Those that no hemisphere contains become triangles, and are returned, too.
    """
    as_choice(winding, WINDINGS, name="winding")
    vectors, rings, cells, holes = arrays
    threads = as_workers(workers)
    large = _core.CellGrid.polygons(*arrays).check(False, threads).faults == LARGE
    if winding != "smaller":
        count = len(rings) - 1
        alone = np.arange(count + 1, dtype=np.int64), np.zeros(count, dtype=np.bool_)
        each = _core.CellGrid.polygons(vectors, rings, *alone).check(False, threads)
        # Outer rings with the larger part of the sphere on the chosen side.
        against = (each.turned == (winding == "ccw")) & (each.faults != EMPTY) & ~holes
        number = np.repeat(np.arange(len(cells) - 1), np.diff(cells))
        large[number[against]] = True
    rows = np.flatnonzero(large)
    if len(rows) > _MOST:
        raise InputError(
            f"{len(rows)} cells are larger than a hemisphere with winding={winding!r:.20}, first "
            f'cell {rows[0]}: do rings run the other way? winding="smaller" takes the smaller side'
        )
    if len(rows):
        # A mesh does not tell whether a ring crosses itself where it touches itself.
        faults = _core.CellGrid.polygons(*arrays).check(True, threads).faults
        if len(crossed := rows[faults[rows] == CROSSING]):
            raise fault_error(CROSSING, crossed)
    parts = {row: _triangles(arrays, row, winding, workers) for row in rows.tolist()}
    beyond = [row for row, part in parts.items() if part.area > 2 * np.pi + _HALF]
    if len(beyond) > 1:
        warnings.warn(
            f"{len(beyond)} cells are larger than a hemisphere, so they overlap, first cells "
            f"{beyond[0]} and {beyond[1]}: do their rings run the other way? "
            'winding="smaller" takes the smaller side',
            PolygonWarning,
            stacklevel=caller_level(),
        )
    # Rings that cancel out have no triangles, and remain an error.
    found = {row: part.triangles for row, part in parts.items() if len(part.triangles)}
    refuse(np.array([row for row in found if not parts[row].nested], dtype=np.int64))
    return _replaced(arrays, found), np.array(list(found), dtype=np.int64)


def tell_clockwise(turned: Bools, areas: Floats) -> None:
    """Warn of large cells that are clockwise, unless all are, so that their rest may be meant."""
    broad, used = np.flatnonzero(turned & (areas > _BROAD)), turned[areas > 0]
    if not len(broad) or (used.all() and len(used) > 1):
        return
    share = 100 * float(areas[broad[0]]) / (4 * np.pi)
    warnings.warn(
        f"{counted(len(broad), 'large cell')} {agreed(len(broad), 'is', 'are')} clockwise, first "
        f"cell {broad[0]}, whose smaller side has {share:.3g} % of the sphere and is taken: give "
        'winding="smaller" if it is meant, and "ccw" if the rest of the sphere is',
        PolygonWarning,
        stacklevel=caller_level(),
    )


def _triangles(arrays: Arrays, row: int, winding: str, workers: int | None) -> _Part:
    """Return the triangles of a cell."""
    vectors, rings, cells, holes = arrays
    own = range(int(cells[row]), int(cells[row + 1]))
    ends, outer = [], []
    corners = vectors[rings[own.start] : rings[own.stop]]
    for ring in own:
        at = np.arange(rings[ring], rings[ring + 1]) - rings[own.start]
        ends.append(np.column_stack((at, np.roll(at, -1))))
        outer.append(np.full(len(at), not holes[ring]))
    segments = np.concatenate(ends)
    sides = np.ones(len(segments), dtype=bool)
    origin = Origin(np.zeros(len(segments), dtype=np.int32), sides, np.concatenate(outer))
    places = np.concatenate((corners, _BETWEEN))
    given = Given(segments.astype(np.int32), origin, winding, len(places))
    try:
        mesh = ConstrainedDelaunay._of_geometries(places, given, None, True, workers)
        ordered = Rings(origin, mesh.duplicate_of[segments], winding)
        inside = first_polygon(mesh._made, mesh.areas, mesh._component, ordered, warn=False)
    except InputError as error:
        raise InputError(f"cell {row}: {error}") from None
    of_side = np.repeat(np.arange(len(own)), np.diff(rings[own.start : own.stop + 1]))
    right = nested(mesh, inside == 0, of_side.astype(np.int32), holes[own.start : own.stop])
    chosen = inside[mesh._component] == 0
    return _Part(mesh.vectors[mesh.simplices[chosen]], float(mesh.areas[chosen].sum()), right)


def _replaced(arrays: Arrays, given: dict[int, Floats]) -> Arrays:
    """Return cells, some of which have triangles instead of their rings."""
    vectors, rings, cells, holes = arrays
    if not given:
        return arrays
    places, sizes, counts, hollow = [], [], [], []
    last = 0
    # The cells between those that are replaced remain unchanged.
    for row in [*given, len(cells) - 1]:
        a, b = int(cells[last]), int(cells[row])
        places.append(vectors[rings[a] : rings[b]])
        sizes.append(np.diff(rings[a : b + 1]))
        counts.append(np.diff(cells[last : row + 1]))
        hollow.append(holes[a:b])
        if row in given:
            triangles = given[row]
            places.append(triangles.reshape(-1, 3))
            sizes.append(np.full(len(triangles), 3))
            counts.append(np.array([len(triangles)]))
            hollow.append(np.zeros(len(triangles), dtype=bool))
        last = row + 1
    lengths, numbers = np.concatenate(sizes), np.concatenate(counts)
    return (
        np.concatenate(places),
        np.concatenate(([0], np.cumsum(lengths))).astype(np.int64),
        np.concatenate(([0], np.cumsum(numbers))).astype(np.int64),
        np.concatenate(hollow),
    )
