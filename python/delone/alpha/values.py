"""The simplices of an alpha complex and their values, for points of any span."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_index
from delone._base.duplicates import first_rows
from delone._base.immutable import sealed
from delone._tiling.dimension import FLAT_OR_SOLID
from delone._tiling.triangulation import require_whole
from delone.delaunay import Delaunay
from delone.errors import DegenerateInputError, InputError
from delone.periodic import PeriodicDelaunay, as_periods
from delone.regular import RegularTriangulation, as_weights, triangulated

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from delone._base.types import Floats, Indices

__all__ = [
    "Given",
    "Valued",
    "edge_slots",
    "known_mesh",
    "of_periodic",
    "of_points",
    "simplices_of",
]


@dataclass(frozen=True, eq=False)
class Valued:
    """Simplices of each dimension and their values; the neighbors of those of the highest."""

    simplices: tuple[Indices, ...]
    values: tuple[Floats, ...]
    neighbors: Indices
    # The periodic triangulation, and the edge opposite each corner of its triangles.
    periodic: PeriodicDelaunay | None = None


class Given(NamedTuple):
    """What a complex is computed from."""

    points: Floats
    weights: Floats | None
    periods: Sequence[float | None] | None

    def valued(self, workers: int) -> Valued:
        """Return the simplices and their values."""
        if self.periods is None:
            return of_points(self.points, self.weights, workers)
        d = self.points.shape[1]
        if d != 2:
            raise InputError(f"periodic complexes are only available in 2-D: points are {d}-D")
        periods = as_periods(self.periods)
        mesh = PeriodicDelaunay(self.points, periods, weights=self.weights, workers=workers)
        return of_periodic(mesh, workers)

    def saved(self) -> dict[str, NDArray[Any]]:
        """Return the arrays of a file."""
        weights = np.empty(0) if self.weights is None else self.weights
        found = {"points": self.points, "weights": weights}
        if self.points.shape[1] == 2:
            lengths = self.periods or ()
            found["periods"] = np.array([np.nan if each is None else each for each in lengths])
        return found

    @classmethod
    def loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """Return the contents of the arrays of a file."""
        points, weights = sealed(arrays["points"]), None
        if len(arrays["weights"]):
            weights = sealed(as_weights(arrays["weights"], len(points)))
        lengths = arrays.get("periods", np.empty(0)).tolist()
        return cls(
            points, weights, [None if math.isnan(each) else each for each in lengths] or None
        )


def of_points(points: Floats, weights: Floats | None, workers: int, mesh: Any = None) -> Valued:
    """Return the complex of finite points; `mesh` is their triangulation, if known."""
    if mesh is not None:
        return _of_simplices(points, weights, mesh.simplices, mesh.neighbors, workers)
    is_higher = points.shape[1] not in FLAT_OR_SOLID
    if not len(points) and not is_higher:
        return _of_chain(points, weights, np.empty(0, dtype=np.int32), workers)
    try:
        if weights is None:
            found: Any = Delaunay(points, workers=workers, planar=True)
            simplices, neighbors = found.simplices, found.neighbors
        else:
            arrays, chain = triangulated(points, weights, workers)
            simplices, neighbors = arrays["simplices"], arrays["neighbors"]
            if not len(simplices):
                return _of_chain(points, weights, chain, workers)
    except DegenerateInputError as error:
        if is_higher:
            raise
        plane = error.plane
        if plane is not None:
            return _of_simplices(points, weights, plane.simplices, plane.neighbors, workers)
        chain = np.asarray(error.chain, dtype=np.int32)
        if weights is not None:
            chain = _seen_on_line(points, weights, chain)
        return _of_chain(points, weights, chain, workers)
    return _of_simplices(points, weights, simplices, neighbors, workers)


def _seen_on_line(points: Floats, weights: Floats, chain: Indices) -> Indices:
    """Return the rows of a chain of collinear 3-D points that are not hidden, in order."""
    first = first_rows(points)
    # Of equal points, the heaviest; of equally heavy ones, the first.
    order = np.lexsort((np.arange(len(first)), -weights, first))
    at = np.unique(first[order], return_index=True)[1]
    heaviest = dict(zip(first[order][at].tolist(), order[at].tolist(), strict=True))
    rows = [heaviest[row] for row in first[chain].tolist()]
    exact = [[Fraction(float(x)) for x in points[row]] for row in rows]
    way = [q - p for p, q in zip(exact[0], exact[-1], strict=True)]
    along, heights = [], []
    for each, row in zip(exact, rows, strict=True):
        steps = [q - p for p, q in zip(exact[0], each, strict=True)]
        along.append(sum(x * y for x, y in zip(steps, way, strict=True)))
        heights.append(sum(x * x for x in steps) - Fraction(float(weights[row])))
    lower: list[int] = []
    for i in range(len(rows)):
        # The lower hull of the lifted points; one in the middle of an edge is hidden.
        while len(lower) > 1 and _is_above(along, heights, lower[-2], lower[-1], i):
            lower.pop()
        lower.append(i)
    return np.array([rows[i] for i in lower], dtype=np.int32)


def _is_above(along: list[Any], heights: list[Any], i: int, j: int, k: int) -> bool:
    """Tell whether lifted point j is not below the line through i and k."""
    run, rise = along[k] - along[i], heights[k] - heights[i]
    above: bool = (heights[j] - heights[i]) * run >= rise * (along[j] - along[i])
    return above


def _vertices(
    points: Floats, weights: Floats | None, edges: Indices, values: Floats, rows: Indices
) -> tuple[Indices, Floats]:
    if weights is None:
        return rows[:, None], np.zeros(len(rows))
    return rows[:, None], _core.alpha_vertices(points, weights, edges, values)[rows]


def _seen(points: Floats, simplices: Indices) -> Indices:
    seen = np.zeros(len(points), dtype=bool)
    seen[simplices] = True
    return np.flatnonzero(seen).astype(np.int32)


def _of_simplices(
    points: Floats, weights: Floats | None, simplices: Indices, neighbors: Indices, workers: int
) -> Valued:
    if points.shape[1] not in FLAT_OR_SOLID:
        return _of_higher(points, weights, simplices, neighbors, workers)
    given = points, weights, simplices, neighbors, workers
    upper: tuple[Indices, ...]
    upper_values: tuple[Floats, ...]
    if simplices.shape[1] == 4:
        tetrahedra, (faces, of_faces), (edges, of_edges) = _core.alpha_solid3(*given)
        upper, upper_values = (faces, simplices), (of_faces, tetrahedra)
    else:
        triangles, (edges, of_edges) = _core.alpha_flat(*given)
        upper, upper_values = (simplices,), (triangles,)
    rows, own = _vertices(points, weights, edges, of_edges, _seen(points, edges))
    return Valued((rows, edges, *upper), (own, of_edges, *upper_values), neighbors)


def _of_higher(
    points: Floats, weights: Floats | None, simplices: Indices, neighbors: Indices, workers: int
) -> Valued:
    own, below = _core.alpha_faces(points, weights, simplices, workers)
    faces, values = [rows for rows, _ in below], [found for _, found in below]
    return Valued((*faces, simplices), (*values, own), neighbors)


def _of_chain(points: Floats, weights: Floats | None, chain: Indices, workers: int) -> Valued:
    """Return a path along a line, a single point, or nothing."""
    edges = np.sort(np.column_stack((chain[:-1], chain[1:])), axis=1).astype(np.int32)
    edges = np.ascontiguousarray(edges[np.lexsort((edges[:, 1], edges[:, 0]))])
    values = _core.alpha_edges(points, weights, edges, workers)
    rows, own = _vertices(points, weights, edges, values, np.sort(chain).astype(np.int32))
    if not len(edges):
        return Valued((rows,), (own,), np.full((len(rows), 1), -1, dtype=np.int32))
    return Valued((rows, edges), (own, values), np.full((len(edges), 2), -1, dtype=np.int32))


def edge_slots(mesh: PeriodicDelaunay) -> NDArray[np.int64]:
    """Return a code 3 t + k, of its later triangle, for each edge of a periodic triangulation."""
    partners = mesh.partners.ravel()
    code = np.arange(partners.size)
    return code[partners < code]


def of_periodic(mesh: PeriodicDelaunay, workers: int) -> Valued:
    """Return the complex of a periodic triangulation: one simplex of each class of translates."""
    points, weights = mesh.points, mesh.weights
    x, y = (0.0 if length is None else length for length in mesh.periods)
    topology = mesh.simplices, mesh.offsets, mesh.partners
    triangles, by_corner, conflicts = _core.alpha_torus2(
        points, weights, (x, y), *topology, workers
    )
    slots = edge_slots(mesh)
    t, k = np.divmod(slots, 3)
    tail, head = mesh.simplices[t, (k + 1) % 3], mesh.simplices[t, (k + 2) % 3]
    values = by_corner[t, k]
    rows = _seen(points, mesh.simplices)
    own = np.zeros(len(points)) if weights is None else 0.0 - weights
    if weights is not None:
        least = np.full(len(points), np.inf)
        is_met = np.zeros(len(points), dtype=bool)
        for at, met in ((tail, conflicts[slots, 0]), (head, conflicts[slots, 1])):
            np.minimum.at(least, at, values)
            is_met[at[met != 0]] = True
        own = np.where(is_met, least, own)
    edges = np.column_stack((tail, head))
    return Valued(
        (rows[:, None], edges, mesh.simplices),
        (own[rows], values, triangles),
        mesh.neighbors,
        mesh,
    )


def simplices_of(valued: Valued, k: int, ndim: int) -> tuple[Indices, Floats]:
    """Return the simplices of one dimension, up to that of the points, and their values."""
    at = as_index(k, 0, ndim, name="k")
    if at < len(valued.simplices):
        return valued.simplices[at], valued.values[at]
    return sealed(np.empty((0, at + 1), dtype=np.int32)), sealed(np.empty(0))


def known_mesh(points: Any) -> Any:
    """Return a triangulation whose simplices are those of its points' complex, or None."""
    if not isinstance(points, Delaunay | RegularTriangulation):
        return None
    require_whole(points, "an alpha complex")
    return points
