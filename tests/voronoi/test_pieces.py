"""Cells on an outline against Fractions: what is left of each, and the doubles of crossings."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from delone import Voronoi, lloyd
from rational import Vector, area, exact

shapely = pytest.importorskip("shapely")

ZERO = Fraction(0)


def within(ring: list[Vector], a: Vector, b: Vector) -> list[Vector]:
    """A convex ring cut to the left of the line from a to b."""
    found = []
    for p, q in pairwise([*ring, *ring[:1]]):
        at = [(b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]) for x in (p, q)]
        if at[0] >= 0:
            found.append(p)
        if at[0] * at[1] < 0:
            share = at[0] / (at[0] - at[1])
            found.append(tuple(x + share * (y - x) for x, y in zip(p, q, strict=True)))
    return found


def moments(ring: list[Vector]) -> tuple[Fraction, Fraction, Fraction]:
    """The area, and the integrals of x and y."""
    size = x = y = ZERO
    for p, q in pairwise([*ring, *ring[:1]]):
        part = p[0] * q[1] - p[1] * q[0]
        size, x, y = size + part / 2, x + part * (p[0] + q[0]) / 6, y + part * (p[1] + q[1]) / 6
    return size, x, y


def common(cell: list[Vector], outline: Any) -> tuple[Fraction, Fraction, Fraction]:
    """The moments of what a convex cell and an outline share, by triangles from one point."""
    total = (ZERO, ZERO, ZERO)
    o = cell[0]
    for part in shapely.get_parts(shapely.orient_polygons(outline)):
        for ring in shapely.get_rings(part):
            for a, b in pairwise(exact(shapely.get_coordinates(ring))):
                size = area([o, a, b])
                if size:
                    corners = [o, a, b] if size > 0 else [o, b, a]
                    left = cell
                    for p, q in pairwise([*corners, o]):
                        left = within(left, p, q)
                    sign = 1 if size > 0 else -1
                    parts = zip(total, moments(left), strict=True)
                    total = tuple(x + sign * y for x, y in parts)  # type: ignore[assignment]
    return total


def jagged(rng: np.random.Generator, corners: int) -> Any:
    angle = np.sort(rng.random(corners)) * 2 * np.pi
    radius = rng.uniform(0.15, 0.5, corners)
    return shapely.Polygon(0.5 + radius[:, None] * np.column_stack((np.cos(angle), np.sin(angle))))


def check(points: Any, outline: Any) -> Voronoi:
    """Measures are those of what boxed cells and the outline share; returns the diagram."""
    diagram = Voronoi(points, clip=outline)
    clipped = diagram._left
    size = outline.area
    for cell in range(len(clipped.areas)):
        ring = exact(clipped.corners[clipped.starts[cell] : clipped.starts[cell + 1]])
        whole, x, y = common(ring, outline) if len(ring) > 2 else (ZERO, ZERO, ZERO)
        assert clipped.areas[cell] == pytest.approx(float(whole), rel=1e-12, abs=1e-15 * size)
        if whole > size * 1e-6:
            place = [float(x / whole), float(y / whole)]
            assert clipped.centroids[cell] == pytest.approx(place, rel=1e-9)
    polygons = diagram.polygons()
    assert shapely.is_valid(polygons).all()
    assert shapely.area(polygons) == pytest.approx(diagram.cell_areas, rel=1e-9, abs=1e-15 * size)
    assert shapely.length(polygons) == pytest.approx(diagram.cell_perimeters, rel=1e-9)
    return diagram


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.sampled(3)
def test_what_is_left_of_cells_is_that_of_fractions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    outline = jagged(rng, 40) - shapely.Point(0.5, 0.5).buffer(0.1, quad_segs=3)
    diagram = check(rng.random((12, 2)), outline)
    # The core has cut them all.
    assert not len(diagram._left._doubtful)  # type: ignore[attr-defined]
    assert (diagram._left._side == 2).sum() > 5  # type: ignore[attr-defined]


@pytest.mark.parametrize("seed", range(6))
def test_corners_that_coincide_are_left_to_shapely(seed: int) -> None:
    """Cells and outlines of small integers: corners on edges, and edges on each other."""
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 5, (9, 2)) * 2.0
    outline = shapely.unary_union(
        [shapely.box(x, y, x + w, y + h) for x, y, w, h in rng.integers(1, 5, (4, 4)).tolist()]
    )
    diagram = check(points, outline)
    assert len(diagram._left._doubtful)  # type: ignore[attr-defined]
    assert diagram.cell_areas[np.unique(diagram.duplicate_of)].sum() == pytest.approx(outline.area)


def test_islands_and_ponds_within_one_cell() -> None:
    def ring(radius: float, x: float = 0.0) -> Any:
        return shapely.Point(x, 0.25).buffer(radius, quad_segs=4)

    # Land around a lake, with an island that has a pond; another island; land across the border.
    lake = ring(1.0, -2.0) - ring(0.75, -2.0)
    island = ring(0.5, -2.0) - ring(0.25, -2.0)
    other = ring(0.125, -3.5)
    across = ring(1.5, 1.0) - ring(0.3, 0.9) - ring(0.2, -0.1)
    outline = shapely.MultiPolygon([lake, island, other, across])
    assert outline.is_valid
    diagram = check([(-3.0, 0.0), (3.0, 0.0)], outline)
    assert not len(diagram._left._doubtful)  # type: ignore[attr-defined]
    left, right = diagram.polygons()
    holes = sorted(len(part.interiors) for part in left.geoms)
    assert holes == [0, 0, 1, 1]
    assert right.geom_type == "Polygon" and len(right.interiors) == 1
    assert left.area + right.area == pytest.approx(outline.area, rel=1e-14)


def test_a_hole_may_touch_the_outline_in_a_cell() -> None:
    shell = [(0, 0), (8, 0), (8, 8), (0, 8)]
    outline = shapely.Polygon(shell, [[(0, 3), (2, 2), (2, 4)], [(4, 1), (6, 2), (4, 3), (3, 2)]])
    check([(1.1, 3.2), (7.3, 3.1)], outline)
    check([(4.1, 4.3)], outline)


def test_crossings_are_the_doubles_nearest_to_the_true_ones() -> None:
    rng = np.random.default_rng(3)
    outline = jagged(rng, 12)
    diagram = Voronoi(rng.random((8, 2)), clip=outline)
    clipped = diagram._left
    segments = list(pairwise(exact(shapely.get_coordinates(outline))))
    known = {tuple(map(float, p)) for p, _ in segments}
    wanted = set()
    for cell in range(8):
        ring = exact(clipped.corners[clipped.starts[cell] : clipped.starts[cell + 1]])
        known |= {tuple(map(float, p)) for p in ring}
        for p, q in pairwise([*ring, ring[0]]):
            for a, b in segments:
                sides = [area([a, b, p]), area([a, b, q]), area([p, q, a]), area([p, q, b])]
                if sides[0] * sides[1] < 0 and sides[2] * sides[3] < 0:
                    share = sides[0] / (sides[0] - sides[1])
                    at = [x + share * (y - x) for x, y in zip(p, q, strict=True)]
                    wanted.add(tuple(map(float, at)))
    found = {tuple(p) for p in shapely.get_coordinates(diagram.polygons()).tolist()}
    assert wanted
    assert found - known == wanted


def test_ridges_within_an_outline_have_the_lengths_that_both_cells_see() -> None:
    rng = np.random.default_rng(4)
    diagram = Voronoi(rng.random((30, 2)), clip=jagged(rng, 60))
    indptr, indices, lengths = diagram.neighbors
    cells = diagram.polygons()
    total = 0.0
    for i in range(30):
        beside = slice(indptr[i], indptr[i + 1])
        for j, length in zip(indices[beside], lengths[beside], strict=True):
            shared = shapely.intersection(cells[i].boundary, cells[j].boundary).length
            assert length == pytest.approx(shared, abs=1e-12)
            total += length
    # All boundaries are the outline's and, twice, ridges.
    outline = diagram.clip
    assert diagram.cell_perimeters.sum() == pytest.approx(outline.length + total, rel=1e-12)


@pytest.mark.parametrize("outline", ["jagged", "aligned"])
def test_the_energy_in_an_outline_is_that_of_a_density_of_one(outline: str) -> None:
    rng = np.random.default_rng(5)
    domain = (
        jagged(rng, 30)
        if outline == "jagged"
        else shapely.box(0, 0, 1, 1) - shapely.box(0.25, 0.25, 0.5, 0.5)
    )
    points = rng.random((20, 2)) if outline == "jagged" else rng.integers(0, 8, (20, 2)) / 8
    plain = lloyd(points, domain, max_iter=4)
    weighed = lloyd(points, domain, max_iter=4, density=lambda places: np.ones(len(places)))
    assert plain.energies == pytest.approx(weighed.energies, rel=1e-12)
    assert plain.points == pytest.approx(weighed.points, abs=1e-12)
