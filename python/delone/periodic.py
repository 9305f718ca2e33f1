"""Periodic Delaunay triangulations, with a period in x, in y, or both.

The core triangulates the points and copies of them around, with predicates that are exact on the
sums of coordinates and periods; here one triangle of each class of translates is kept, and
neighbors are found among them by their common edges.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from delone import _core
from delone._arrays import as_number, as_workers, require_finite
from delone.complex import Complex
from delone.counting import counted
from delone.duplicates import first_rows
from delone.errors import DegenerateInputError, InputError, InternalError, ShapeError
from delone.immutable import kept, own_copy, sealed
from delone.plane.dimension import PLANE
from delone.regular import as_weights
from delone.regular_validation import PeriodicReport, validate_periodic

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import Parts
    from delone.plane.quality import Quality

    Floats = NDArray[np.float64]
    Indices = NDArray[np.int32]

__all__ = ["PeriodicDelaunay"]

_LARGEST = sys.float_info.max
# Copies nearer than this many mean distances to the box of the points are tried first.
_HALO = 8.0
# Sets with fewer points than this take all copies at once.
_FEW = 64


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
        Weights, in the square of the unit of the points, as for `RegularTriangulation`. All copies
        of a point have its weight.
    workers : int, optional
        Maximum number of threads for measures; by default one per core. The triangulation itself
        uses one thread.

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
        There is no period, one is not positive and finite, or points lie a period or more apart.
    DegenerateInputError
        There is no triangle: there are no points, or there is one period and all points lie on one
        line along it.
    NonFiniteError
        A coordinate or weight is NaN or infinite.
    ShapeError
        There are not as many weights as points.

    Notes
    -----
    Exact, like `Delaunay`: a copy is the exact sum of a coordinate and a period, which in general
    is not a double, and nothing is rounded before a decision. Ties are broken in the same way, so
    that the set of triangles is unique, and the same in all periods. With two periods there are 2 n
    triangles and 3 n edges for n distinct points (with weights, for n that are not hidden).

    Copies one period away on all sides are sufficient for any points. If there are many points,
    only nearby copies are used at first; the circumcircles show whether these were too few. Time is
    that of inserting all of them, O(n log n) on typical inputs.

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
        if workers is not None:
            as_workers(workers)
        lengths = as_periods(periods)
        _require_one_period(own, lengths)
        self._fill(_triangulated(own, own_weights, lengths), {}, workers)

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
        """The weights, (n,); None without."""
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
        return sealed(PLANE.sizes(*self._separate, self._workers))

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
            and each distinct point is a vertex or, with weights, above the triangle that holds it.

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
        """The triangles at their places, with three points each."""
        return self.corners.reshape(-1, 2), _numbered(self.nsimplex)

    def _parts(self) -> Parts:
        from delone.exchange.parts import Parts

        points, simplices = self._separate
        return Parts(points, simplices, of_points={"row": self.simplices.ravel()})

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

    Rows that are lighter than another with the same coordinates stay by themselves.
    """
    stands_for = _standing(points, weights)
    if weights is not None:
        lighter = weights != weights[stands_for]
        stands_for[lighter] = np.flatnonzero(lighter)
    return stands_for.astype(np.int32)


def _standing(points: Floats, weights: Floats | None) -> NDArray[np.int64]:
    """The row that stands for each: the heaviest with its coordinates, the first of these."""
    first = first_rows(points)
    if weights is None:
        return first
    order = np.lexsort((np.arange(len(first)), -weights, first))
    group, at = np.unique(first[order], return_index=True)
    heaviest = np.empty(len(first), dtype=np.int64)
    heaviest[group] = order[at]
    return heaviest[first]


def _triangulated(
    points: Floats, weights: Floats | None, periods: tuple[float | None, float | None]
) -> dict[str, NDArray[Any]]:
    """One triangle of each class."""
    rows = np.unique(_standing(points, weights)).astype(np.int32)
    lengths = _lengths(periods)
    if not len(rows):
        raise DegenerateInputError(
            "there are no points; at least one is needed", reason="too few points"
        )
    found = None
    if None not in periods and len(rows) > _FEW:
        found = _with_halo(points, weights, rows, lengths)
    if found is None:
        found = _copied(points, weights, lengths, _copies(rows, periods))
    simplices, offsets, chain = found
    if not len(simplices):
        raise DegenerateInputError(
            "all points lie on one line along the period, so there is no triangle; `error.chain` "
            "has the rows of those that are not hidden, in order",
            reason="collinear",
            chain=chain,
        )
    partners = _partners(simplices, offsets, len(points), whole=None not in periods)
    return {
        "points": points,
        "simplices": simplices,
        "neighbors": np.where(partners < 0, -1, partners // 3).astype(np.int32),
        "offsets": offsets,
        "partners": partners,
        "weights": np.empty(0) if weights is None else weights,
        "lengths": np.array([np.nan if length is None else length for length in periods]),
    }


def _copies(rows: Indices, periods: tuple[float | None, float | None]) -> Indices:
    """The points and all their copies one period away."""
    steps = [[0] if length is None else [-1, 0, 1] for length in periods]
    moves = np.array([(x, y) for x in steps[0] for y in steps[1]], dtype=np.int32)
    return np.column_stack((np.repeat(rows, len(moves)), np.tile(moves, (len(rows), 1))))


def _with_halo(
    points: Floats, weights: Floats | None, rows: Indices, lengths: Floats
) -> tuple[Indices, Indices, Indices] | None:
    """The triangles by way of those copies that lie near, or None where these are too few."""
    low = points[rows].min(axis=0)
    width = _HALO * float(np.sqrt(lengths[0] / len(rows)) * np.sqrt(lengths[1]))
    if not 0 < width < lengths.min() / 2:
        return None
    copies = _copies(rows, (1.0, 1.0))
    with np.errstate(over="ignore"):
        at = points[copies[:, 0]] + copies[:, 1:] * lengths
        near = ((at >= low - width) & (at <= low + lengths + width)).all(axis=1)
    if not np.isfinite(at).all():
        return None
    found = _copied(points, weights, lengths, np.ascontiguousarray(copies[near]))
    simplices, offsets, _ = found
    if len(simplices) != 2 * len(rows if weights is None else np.unique(simplices)):
        return None
    # A circle within the box of the copies that were taken has been tested against all others.
    circles = _circles(points, weights, lengths, simplices, offsets)
    if circles is None:
        return None
    center, radius = circles
    # The triangle may stand for a translate whose circle is the one that was tested.
    reach = radius[:, None] + np.abs(offsets).max(axis=1) * lengths * 2.0**-40
    inside = (center - reach > low - width) & (center + reach < low + lengths + width)
    return found if inside.all() else None


def _circles(
    points: Floats, weights: Floats | None, lengths: Floats, simplices: Indices, offsets: Indices
) -> tuple[Floats, Floats] | None:
    """Circles, a little larger, outside of which no site has to do with a triangle.

    None where a center lies beyond the range of doubles.
    """
    corners = points[simplices] + offsets * lengths
    if weights is None:
        from delone.plane import geometry

        center = geometry.circumcenters(corners.reshape(-1, 2), _numbered(len(simplices)))
        return center, np.hypot(*(center - corners[:, 0]).T) * (1 + 2.0**-40)
    copies = np.ascontiguousarray(np.dstack((simplices, offsets)).reshape(-1, 3), dtype=np.int32)
    x, y = lengths.tolist()
    try:
        center, _ = _core.periodic_centers2(points, weights, (x, y), copies, copies, 1)
    except ShapeError:
        return None
    # The heaviest of all sites comes below a plane from furthest away.
    heavier = weights.max() - weights[simplices[:, 0]]
    away = np.hypot(*(center - corners[:, 0]).T) * (1 + 2.0**-40)
    return center, np.hypot(away, np.sqrt(heavier)) * (1 + 2.0**-40)


def _numbered(count: int) -> Indices:
    return np.arange(3 * count, dtype=np.int32).reshape(-1, 3)


def _copied(
    points: Floats, weights: Floats | None, lengths: Floats, copies: Indices
) -> tuple[Indices, Indices, Indices]:
    """The triangles of copies, one of each class that has a corner among the points.

    And the rows that are not hidden in their order, where all copies lie on one line.
    """
    x, y = lengths.tolist()
    try:
        made = _core.periodic2(points, weights, (x, y), copies)
    except InternalError as error:
        error.points = points
        raise
    row, moved, chain = made.rows, made.moved, made.chain
    simplices, offsets = row[made.simplices], moved[made.simplices]
    # Of each triangle the corner with the smallest row stands first; where a row comes more than
    # once, the one moved least in lexicographic order.
    keys = (simplices.astype(np.int64) * 3 + (offsets[..., 0] + 1)) * 3 + (offsets[..., 1] + 1)
    first = keys.argmin(axis=1)
    order = (first[:, None] + np.arange(3)) % 3
    simplices = np.take_along_axis(simplices, order, axis=1)
    offsets = np.take_along_axis(offsets, order[..., None], axis=1)
    # That corner is not moved in exactly one of the translates.
    kept = (offsets[:, 0] == 0).all(axis=1)
    own = chain[(moved[chain] == 0).all(axis=1)]
    return np.ascontiguousarray(simplices[kept]), np.ascontiguousarray(offsets[kept]), row[own]


def _directed(
    simplices: Indices, offsets: Indices
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """The edge opposite each corner, counter-clockwise: from, to, and by how much that is moved."""
    a, b = simplices[:, [1, 2, 0]], simplices[:, [2, 0, 1]]
    moved = offsets[:, [2, 0, 1]].astype(np.int64) - offsets[:, [1, 2, 0]]
    return a.reshape(-1).astype(np.int64), b.reshape(-1).astype(np.int64), moved.reshape(-1, 2)


def _partners(simplices: Indices, offsets: Indices, npoints: int, *, whole: bool) -> Indices:
    """For the edge opposite corner k of each triangle t the one that is its reverse, as 3 t + k."""
    a, b, moved = _directed(simplices, offsets)

    def keys(a: Any, b: Any, moved: Any) -> NDArray[np.int64]:
        # Corners are moved by -2 to 2 against each other.
        found: NDArray[np.int64] = ((a * npoints + b) * 5 + moved[:, 0] + 2) * 5 + moved[:, 1] + 2
        return found

    here, there = keys(a, b, moved), keys(b, a, -moved)
    order = np.argsort(here)
    place = np.minimum(np.searchsorted(here, there, sorter=order), len(here) - 1)
    partner = order[place]
    met = here[partner] == there
    if (np.diff(here[order]) == 0).any() or (whole and not met.all()):
        raise InternalError("edges of a periodic triangulation do not pair up")
    return np.where(met, partner, -1).astype(np.int32).reshape(-1, 3)
