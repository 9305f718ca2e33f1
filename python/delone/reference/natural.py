"""Natural neighbor weights from their definition: Voronoi cells, clipped in exact arithmetic.

The cell that a query would have in the Voronoi diagram is clipped from a square by half-planes, one
for each site; the area that a site loses to it is clipped from that cell by the half-planes of the
site. The fraction of the area lost is Sibson's weight (R. Sibson, "A vector identity for the
Dirichlet tessellation", 1980). The length of the edge between query and site, divided by their
distance, is Laplace's (N. H. Christ, R. Friedberg and T. D. Lee, "Weights of links and plaquettes
in a random lattice", 1982). Both are rational. Time is O(n²) for each query. For 3-D see
`natural_space`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from delone.errors import InputError
from delone.reference.exact import exact_point
from delone.reference.natural_space import area, clip, laplace_in_space

if TYPE_CHECKING:
    from collections.abc import Sequence

    Point = tuple[Fraction, Fraction]
    Polygon = list[Point]

__all__ = ["natural_weights"]


def natural_weights(
    points: Sequence[Sequence[Any]], query: Sequence[Any], *, kind: str = "sibson"
) -> dict[int, Fraction]:
    """Return the weights of the natural neighbors of a query.

    Parameters
    ----------
    points : sequence of points, shape (n, 2) or (n, 3)
        Distinct sites.
    query : sequence of two or three numbers
        A point strictly inside their convex hull.
    kind : {"sibson", "laplace"}, optional
        Fractions of area, or of length over distance; in 3-D ``"laplace"``: area over distance.

    Returns
    -------
    dict of int to Fraction
        Rows of the sites whose weight is above 0, ascending; the weights sum to 1.

    Raises
    ------
    InputError
        The query is not strictly inside the hull, so its cell is unbounded; or `kind` is unknown,
        or ``"sibson"`` in 3-D.

    Examples
    --------
    >>> from delone.reference import natural_weights
    >>> square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    >>> {row: str(weight) for row, weight in natural_weights(square, (1, 2)).items()}
    {0: '3/8', 1: '1/8', 2: '1/8', 3: '3/8'}
    """
    if kind not in ("sibson", "laplace"):
        raise InputError(f"kind must be 'sibson' or 'laplace', got {kind!r:.80}")
    if len(query) == 3:
        if kind != "laplace":
            raise InputError("kind='sibson' is only available in 2-D; in 3-D use kind='laplace'")
        return laplace_in_space(points, query)
    sites = [_fractions(point) for point in points]
    q = _fractions(query)
    if q in sites:
        return {sites.index(q): Fraction(1)}
    cell = _cell(sites, q)
    measure = _lost if kind == "sibson" else _shared
    parts = {row: measure(sites, row, q, cell) for row in range(len(sites))}
    total = sum(parts.values())
    return {row: part / total for row, part in parts.items() if part > 0}


def _fractions(point: Sequence[Any]) -> Point:
    x, y = exact_point(point)
    return Fraction(x), Fraction(y)


def _cell(sites: list[Point], q: Point) -> Polygon:
    """The Voronoi cell of the query among the sites."""
    spread = max(abs(x - q[0]) + abs(y - q[1]) for x, y in sites)
    size = 4 * spread
    # A bounded cell fits into some square; grow the square until the cell does not change.
    for _ in range(64):
        square = _clipped([(q[0] + i * size, q[1] + j * size) for i, j in _CORNERS], sites, q)
        if all(max(abs(x - q[0]), abs(y - q[1])) < size for x, y in square):
            return square
        size *= 1024
    raise InputError("the query is not strictly inside the convex hull of the points")


_CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def _clipped(polygon: Polygon, others: list[Point], to: Point) -> Polygon:
    """The part of a convex polygon that is nearer to a point than to others."""
    for other in others:
        if other != to:
            polygon = clip(polygon, [_nearer(corner, to, other) for corner in polygon])
    return polygon


def _nearer(corner: Point, near: Point, far: Point) -> Fraction:
    """The squared distance to the second point minus that to the first."""
    return _squared(corner, far) - _squared(corner, near)


def _squared(a: Point, b: Point) -> Fraction:
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


def _lost(sites: list[Point], row: int, q: Point, cell: Polygon) -> Fraction:
    """The area that a site loses to the query."""
    return area(_clipped(cell, sites, sites[row]))


def _shared(sites: list[Point], row: int, q: Point, cell: Polygon) -> Fraction:
    """The length of the edge between the cells of a site and the query, over their distance."""
    site = sites[row]
    on_edge = [corner for corner in cell if _nearer(corner, q, site) == 0]
    # The edge is perpendicular to the vector from query to site; so is this one, equally long.
    turned = (q[1] - site[1], site[0] - q[0])
    places = [x * turned[0] + y * turned[1] for x, y in on_edge]
    if len(places) < 2:
        return Fraction(0)
    return (max(places) - min(places)) / _squared(q, site)
