"""Periodic Delaunay triangulations, with a period in x, in y, or both.

The core triangulates the points, and copies of those near the ends of a period, with predicates
that are exact on the sums of coordinates and periods; of each class of translates it returns one
triangle.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._base.arrays import as_number, as_workers, require_finite
from delone._base.counting import counted
from delone._base.duplicates import first_rows
from delone._base.immutable import kept, own_copy, sealed
from delone._tiling import measures
from delone._tiling.complex import Complex
from delone._tiling.plane.dimension import PLANE
from delone.errors import DegenerateInputError, InputError, InternalError
from delone.regular import as_weights
from delone.regular_validation import PeriodicReport, validate_periodic

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone._base.types import Floats, Indices
    from delone._tiling.plane.quality import Quality
    from delone.exchange.parts import Parts

__all__ = ["PeriodicDelaunay"]

_LARGEST = sys.float_info.max


class PeriodicDelaunay(Complex):
    """The Delaunay triangulation of a periodic set of 2-D points; with weights, the regular one.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        The points of one period. In each periodic direction they must lie less than one period
        apart; where the period begins does not matter.
    periods : tuple of two floats or None
        ``(Lx, Ly)``: the distances after which the points repeat in x and in y. None for a
        direction without a period.
    weights : array_like, shape (n,), optional
        Weights, in squared units of the points, as for `RegularTriangulation`. All copies of a
        point have its weight.
    workers : int, optional
        Maximum number of threads; by default one per core. The result does not depend on it.

    Attributes
    ----------
    points : ndarray of float64, shape (n, 2)
        The coordinates.
    periods : tuple of two floats or None
        As given.
    weights : ndarray of float64, shape (n,), or None
        The weights.
    simplices : ndarray of int32, shape (m, 3)
        One triangle of each class of translates, as rows of `points`, counter-clockwise. If there
        are few points, a row may occur two or three times in one triangle.
    offsets : ndarray of int32, shape (m, 3, 2)
        The number of periods by which each corner is translated in x and y; 0 for the first corner.
    neighbors : ndarray of int32, shape (m, 3)
        The triangle opposite each corner (a translate of it); -1 outside, in a direction without a
        period.

    Raises
    ------
    InputError
        There is no period, a period is not positive and finite, or points are a period or more
        apart.
    DegenerateInputError
        There is no triangle: there are no points, or there is one period and all points lie on one
        line along it.
    NonFiniteError
        A coordinate or weight is NaN or infinite.
    ShapeError
        The numbers of weights and points differ.

    Notes
    -----
    Exact, like `Delaunay`: a copy is the exact sum of a coordinate and a period, which in general
    is not a double, and nothing is rounded before a decision. Ties are broken in the same way, so
    the set of triangles is unique and the same in all periods. With two periods there are 2 n
    triangles and 3 n edges for n distinct points (with weights, for n that are not hidden).

    First, the points are triangulated without copies; triangles whose circumcircles contain no
    copies are final. Only the points of the other triangles are triangulated with all their copies
    one period away, which are always sufficient. O(n log n) on typical inputs.

    References
    ----------
    N. P. Dolbilin and D. H. Huson, "Periodic Delone tilings", Periodica Mathematica Hungarica 34
    (1997).

    Examples
    --------
    >>> from delone import PeriodicDelaunay
    >>> mesh = PeriodicDelaunay([(0.25, 0.5)], (1, 1))
    >>> mesh
    <PeriodicDelaunay of 1 point: 2 triangles>
    >>> mesh.edges.tolist(), mesh.edge_offsets.tolist()
    ([[0, 0], [0, 0], [0, 0]], [[0, 1], [1, 0], [1, 1]])
    """

    __slots__ = ("_lengths", "_offsets", "_partners", "_weights")

    _ARRAYS = ("points", "simplices", "neighbors", "offsets", "partners", "weights", "lengths")

    # NaN for a direction without a period.
    _lengths: Floats
    _offsets: Indices
    _partners: Indices
    # Empty without weights.
    _weights: Floats

    def __init__(
        self,
        points: ArrayLike,
        periods: Sequence[float | None],
        *,
        weights: ArrayLike | None = None,
        workers: int | None = None,
    ) -> None:
        own = own_copy(points)
        require_finite(own)
        own_weights = None if weights is None else as_weights(weights, len(own))
        threads = as_workers(workers)
        lengths = as_periods(periods)
        _require_one_period(own, lengths)
        self._fill(_triangulated(own, own_weights, lengths, threads), {}, workers)
        self._refer(points)

    def _saved(self) -> dict[str, NDArray[Any]]:
        return {"points": self._points, "weights": self._weights, "periods": self._lengths}

    @classmethod
    def _loaded(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        lengths = [None if np.isnan(length) else length for length in arrays["periods"].tolist()]
        weights = arrays["weights"] if len(arrays["weights"]) else None
        return cls(arrays["points"], lengths, weights=weights)

    @property
    def periods(self) -> tuple[float | None, float | None]:
        """The periods in x and y; None in a direction without a period."""
        x, y = (None if np.isnan(length) else length for length in self._lengths.tolist())
        return x, y

    @property
    def weights(self) -> Floats | None:
        """The weights, (n,); None without weights."""
        return self._weights if len(self._weights) else None

    @property
    def offsets(self) -> Indices:
        """The periods by which each corner is translated, (m, 3, 2)."""
        return self._offsets

    @property
    def partners(self) -> Indices:
        """The other side of each edge, (m, 3): 3 t + k for that opposite corner k of triangle t."""
        return self._partners

    @property
    @kept
    def duplicate_of(self) -> Indices:
        """The vertex of each row, (n,): the first row with the same coordinates (and weight)."""
        return sealed(vertex_of(self.points, self.weights))

    @property
    @kept
    def hidden(self) -> Indices:
        """The rows that are neither vertices nor duplicates of vertices: none without weights."""
        seen = np.zeros(self.npoints, dtype=bool)
        seen[self.simplices] = True
        return sealed(np.flatnonzero(~seen[self.duplicate_of]).astype(np.int32))

    @property
    @kept
    def corners(self) -> Floats:
        """Rounded coordinates of the corners of triangles, (m, 3, 2).

        Infinite where a copy lies beyond the range of doubles.
        """
        with np.errstate(over="ignore"):
            found: Floats = self.points[self.simplices] + self.offsets * np.nan_to_num(
                self._lengths
            )
        return sealed(found)

    @property
    def edges(self) -> Indices:
        """One edge of each class, (k, 2): the smaller vertex first, rows ascending."""
        return self._edges[0]

    @property
    def edge_offsets(self) -> Indices:
        """The periods by which the second vertex of each edge is translated, (k, 2)."""
        return self._edges[1]

    @property
    @kept
    def _edges(self) -> tuple[Indices, Indices]:
        a, b, moved = _directed(self.simplices, self.offsets)
        turned = (a > b) | (
            (a == b) & ((moved[:, 0] < 0) | ((moved[:, 0] == 0) & (moved[:, 1] < 0)))
        )
        first, second = np.where(turned, b, a), np.where(turned, a, b)
        moved = np.where(turned[:, None], -moved, moved)
        rows = np.unique(np.column_stack((first, second, moved)), axis=0).astype(np.int32)
        return sealed(rows[:, :2].copy()), sealed(rows[:, 2:].copy())

    @property
    @kept
    def boundary(self) -> Indices:
        """The edges with a triangle on one side only, (h, 2); none with two periods."""
        return sealed(PLANE.boundary(self.simplices, self.neighbors))

    @property
    @kept
    def areas(self) -> Floats:
        """Areas of the triangles, (m,), in the square of the unit of the points."""
        return sealed(measures.sizes(*self._separate, self._workers))

    @kept
    def quality(self) -> Quality:
        """Measure the shapes of the triangles.

        Returns
        -------
        Quality
            Angles, areas and ratios of radii and edges.

        Examples
        --------
        >>> from delone import PeriodicDelaunay
        >>> PeriodicDelaunay([(0.25, 0.5)], (1, 1)).quality().largest_angle
        array([90., 90.])
        """
        found: Any = PLANE.quality(*self._separate, self._workers)
        return found  # type: ignore[no-any-return]

    def validate(self) -> PeriodicReport:
        """Prove that this is the canonical periodic triangulation, or list the faults.

        Returns
        -------
        PeriodicReport
            Truthy if there are no faults: triangles are counter-clockwise and cover the plane, or
            the strip, exactly once, neighbors and partners are mutual and fit the offsets, each
            edge is locally Delaunay (with weights, locally regular), ties are broken canonically,
            and each distinct point is a vertex or, with weights, above the triangle that contains
            it.

        Notes
        -----
        Exact on the sums of coordinates and periods. Linear in the number of triangles, after a
        sort of the points and with short walks to the hidden points.

        Examples
        --------
        >>> from delone import PeriodicDelaunay
        >>> mesh = PeriodicDelaunay([(0.25, 0.5), (0.5, 0.75)], (1, None))
        >>> print(mesh.validate())
        a canonical periodic triangulation
        """
        topology = self._simplices, self._offsets, self._neighbors, self._partners
        return validate_periodic(self._points, self.weights, self.periods, topology)

    @property
    def _separate(self) -> tuple[Floats, Indices]:
        """The triangles at their positions, with three points each."""
        return self.corners.reshape(-1, 2), _numbered(self.nsimplex)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        points, simplices = self._separate
        rows = {"row": self.simplices.ravel()}
        return Parts(points, simplices, of_points=rows, crs=self.crs)

    def _described(self) -> str:
        return f"{counted(self.npoints, 'point')}: {counted(self.nsimplex, 'triangle')}"


def as_periods(periods: Any) -> tuple[float | None, float | None]:
    """Return two periods, each None or positive and finite; an InputError if both are None."""
    try:
        x, y = (None if length is None else as_number(length, name="periods") for length in periods)
    except (TypeError, ValueError):
        raise InputError(
            f"periods must be two values, each a number or None, got {periods!r:.80}"
        ) from None
    given = [length for length in (x, y) if length is not None]
    if not given:
        raise InputError("periods has no number: pass a period in x or y, or use delone.Delaunay")
    if not all(0 < length < np.inf for length in given):
        raise InputError(f"periods must be positive and finite, got {periods!r:.80}")
    return x, y


def _lengths(periods: tuple[float | None, float | None]) -> Floats:
    return np.array([length or 0.0 for length in periods])


def _require_one_period(points: Floats, periods: tuple[float | None, float | None]) -> None:
    """Reject points that lie a period or more apart, decided exactly."""
    for k, length in enumerate(periods):
        if length is None or not len(points):
            continue
        low, high = int(points[:, k].argmin()), int(points[:, k].argmax())
        spread = Fraction(float(points[high, k])) - Fraction(float(points[low, k]))
        if spread >= Fraction(length):
            shown = repr(float(spread)) if spread <= _LARGEST else f"more than {_LARGEST!r}"
            raise InputError(
                f"rows {low} and {high} lie {shown} apart in {'xy'[k]}, not less "
                f"than the period {length!r:.40}: first move all points into one period, for "
                "example with numpy.mod"
            )


def vertex_of(points: Floats, weights: Floats | None) -> Indices:
    """Return for each row, (n, 2), the first one with the same coordinates and weight.

    Rows with a smaller weight than another one with the same coordinates remain separate.
    """
    stands_for = _standing(points, weights)
    if weights is not None:
        lighter = weights != weights[stands_for]
        stands_for[lighter] = np.flatnonzero(lighter)
    return stands_for.astype(np.int32)


def _standing(points: Floats, weights: Floats | None) -> NDArray[np.int64]:
    """The row that represents each: the heaviest with its coordinates, the first if several."""
    first = first_rows(points)
    if weights is None:
        return first
    order = np.lexsort((np.arange(len(first)), -weights, first))
    group, at = np.unique(first[order], return_index=True)
    heaviest = np.empty(len(first), dtype=np.int64)
    heaviest[group] = order[at]
    return heaviest[first]


def _triangulated(
    points: Floats,
    weights: Floats | None,
    periods: tuple[float | None, float | None],
    workers: int,
) -> dict[str, NDArray[Any]]:
    """One triangle of each class."""
    if not len(points):
        raise DegenerateInputError(
            "there are no points; at least one is needed", reason="too few points"
        )
    x, y = _lengths(periods).tolist()
    try:
        made = _core.periodic2(points, weights, (x, y), workers)
    except InternalError as error:
        error.points = points
        raise
    if not len(made.simplices):
        raise DegenerateInputError(
            "all points lie on one line along the period, so there is no triangle; `error.chain` "
            "contains the rows of those that are not hidden, in order",
            reason="collinear",
            chain=made.chain,
        )
    return {
        "points": points,
        "simplices": made.simplices,
        "neighbors": made.neighbors,
        "offsets": made.offsets.reshape(-1, 3, 2),
        "partners": made.partners,
        "weights": np.empty(0) if weights is None else weights,
        "lengths": np.array([np.nan if length is None else length for length in periods]),
    }


def _numbered(count: int) -> Indices:
    return np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def _directed(
    simplices: Indices, offsets: Indices
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """The edge opposite each corner, counter-clockwise: from, to, and the offset of the latter."""
    a, b = simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]]
    moved = offsets[:, [2, 0, 1]].astype(np.int64) - offsets[:, [1, 2, 0]]
    return a.reshape(-1).astype(np.int64), b.reshape(-1).astype(np.int64), moved.reshape(-1, 2)
