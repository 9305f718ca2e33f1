"""Holes of bands at the resolution of coordinates: each is in its polygon, which is exact here."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
import shapely

from delone import InternalError
from delone.terrain import TIN
from delone.terrain.holes import with_holes_inside
from delone.terrain.small import Rings


def coarse(seed, base, span, count=300):
    """A surface whose points are a few units in the last place apart."""
    random = np.random.default_rng(seed)
    xy = np.unique(base + random.integers(0, span, (count, 2)) * 2.0**-18, axis=0)
    return TIN.from_points(np.column_stack((xy, random.random(len(xy)) * 4)))


def lattice(seed):
    random = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(12.0), np.arange(12.0))
    z = random.integers(0, 5, x.shape)
    return TIN.from_points(np.column_stack((x.ravel(), y.ravel(), z.ravel())))


def polygons_of(found):
    """Return polygons as lists of rings of fractions."""
    rings = [
        [(Fraction(x), Fraction(y)) for x, y in found.points[a:b].tolist()]
        for a, b in pairwise(found.ring_starts.tolist())
    ]
    return [rings[a:b] for a, b in pairwise(found.polygon_starts.tolist())]


def is_inside(ring, x, y):
    """Whether a place is in a ring, by the sides below it; None if it is on one."""
    below = False
    for (ax, ay), (bx, by) in pairwise(ring):
        if (ax <= x) == (bx <= x):
            continue
        at = ay + (by - ay) * (x - ax) / (bx - ax)
        if at == y:
            return None
        below ^= at < y
    return below


def require_one_polygon_at_each_place(found, seed, count=40):
    """Each place is in at most one polygon, and in a hole only if inside its outer ring, too."""
    random = np.random.default_rng(seed)
    polygons = polygons_of(found)
    low, high = found.points.min(axis=0), found.points.max(axis=0)
    (left, bottom), (right, top) = (map(Fraction, each.tolist()) for each in (low, high))
    covered = 0
    for a, b in random.integers(1, 9973, (count, 2)).tolist():
        x, y = (
            left + (right - left) * Fraction(a, 9973),
            bottom + (top - bottom) * Fraction(b, 9973),
        )
        depths = []
        for outer, *holes in polygons:
            sides = [is_inside(ring, x, y) for ring in (outer, *holes)]
            assert None not in sides
            depths.append(sides[0] - sum(sides[1:]))
        assert set(depths) <= {0, 1}, depths
        assert sum(depths) <= 1
        covered += sum(depths)
    assert covered > count / 2


def moved(tin, **options):
    """Return bands, and how many holes the core has assigned to the wrong ring."""
    calls = []
    from delone.terrain import holes

    around = holes._around
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(holes, "_around", lambda *given: calls.append(1) or around(*given))
        return tin.bands(**options), len(calls)


@pytest.mark.parametrize("base, span", [(2.0**33, 64), (-(2.0**33), 64), (2.0**33, 32)])
def test_bands_at_the_resolution_of_coordinates_are_valid(base, span):
    total = 0
    for seed in range(4):
        tin = coarse(seed, base, span)
        found, count = moved(tin, interval=0.5)
        total += count
        require_one_polygon_at_each_place(found, seed)
        for options in ({}, {"simplify": 2.0**-15}, {"min_area": 2.0**-34}):
            polygons = tin.bands(interval=0.5, **options).to_shapely()
            assert shapely.is_valid(polygons).all()
    assert total > 0


def ring(*corners):
    return [*corners, corners[0]]


def box(left, bottom, size):
    return ring(
        (left, bottom), (left + size, bottom), (left + size, bottom + size), (left, bottom + size)
    )


def hole(left, bottom, size):
    return box(left, bottom, size)[::-1]


def rings_of(*polygons):
    every = [each for rings in polygons for each in rings]
    return Rings(
        np.array([point for each in every for point in each], dtype=float),
        np.cumsum([0, *map(len, every)]),
        np.cumsum([0, *map(len, polygons)]),
    )


def lists(found):
    rings = [found.points[a:b].tolist() for a, b in pairwise(found.rings.tolist())]
    return [rings[a:b] for a, b in pairwise(found.polygons.tolist())]


def as_lists(*polygons):
    return [[[list(map(float, point)) for point in each] for each in rings] for rings in polygons]


def test_holes_go_to_the_innermost_ring_around_them():
    # The third is inside a hole of the second. The core assigns all holes to the last of the band.
    outer = [box(0, 0, 4), box(4, 0, 20), box(8, 4, 8)]
    holes = [hole(1, 1, 1), hole(7, 3, 10), hole(9, 5, 2), hole(20, 1, 1), hole(12, 8, 2)]
    given = rings_of([outer[0]], [outer[1]], [outer[2], *holes])
    found = with_holes_inside(given, np.zeros(3, dtype=np.int64))
    assert lists(found) == as_lists(
        [outer[0], holes[0]], [outer[1], holes[1], holes[3]], [outer[2], holes[2], holes[4]]
    )
    # The second is inside the first, and the hole is inside both.
    outer = [box(0, 0, 20), box(2, 2, 9), box(30, 0, 4)]
    holes = [hole(3, 3, 1), hole(1, 1, 11)]
    found = with_holes_inside(rings_of([outer[0]], [outer[1]], [outer[2], *holes]), np.zeros(3))
    assert lists(found) == as_lists([outer[0], holes[1]], [outer[1], holes[0]], [outer[2]])
    # Polygons of other bands are not searched.
    corner = ring((0, 0), (4, 0), (0, 4))
    given = rings_of([box(3, 3, 1)], [corner], [outer[2], hole(3.25, 3.25, 0.5)])
    assert with_holes_inside(given, np.array([0, 1, 2])) is given
    given = rings_of([box(3, 3, 1)], [corner], [outer[2], hole(3.25, 3.25, 0.5), hole(2, 2, 2)])
    with pytest.raises(InternalError, match="in no polygon"):
        with_holes_inside(given, np.array([0, 1, 1]))


def test_holes_above_and_inside_a_comb():
    # One long side below, many short ones above.
    comb = ring((0, 0), (40, 0), *((x / 2, 2 + x % 2) for x in range(80, -1, -1)))
    above = box(-1, 4, 60)
    inside = [hole(x + 0.25, 0.5, 0.5) for x in range(40)]
    beyond = [hole(x + 0.25, 5, 0.5) for x in range(40)]
    found = with_holes_inside(rings_of([above], [comb, *inside, *beyond]), np.zeros(2))
    assert lists(found) == as_lists([above, *beyond], [comb, *inside])


def test_holes_that_touch_the_ring():
    square = box(0, 0, 4)
    inside = [
        ring((0, 0), (1, 2), (2, 1)),  # at its first vertex
        ring((4, 0), (3, 1), (3.5, 2)),  # at its last one
        ring((0, 3), (1, 4), (2, 3)),  # at the left side and the top
        ring((2.5, 4), (3, 4), (3, 3)),  # a side in common
    ]
    for each in inside:
        given = rings_of([box(-9, -9, 9)], [square, each])
        assert lists(with_holes_inside(given, np.zeros(2, dtype=np.int64))) == lists(given)
        beside = [(x, y - 4) for x, y in each]
        given = rings_of([box(0, -4, 4)], [square, beside])
        found = with_holes_inside(given, np.zeros(2, dtype=np.int64))
        assert lists(found) == as_lists([box(0, -4, 4), beside], [square])


def test_extremes_of_coordinates():
    for scale in (5e-324, 1e-310, 1e307):
        outer = [[[x * scale, y * scale] for x, y in box(0, k, 4)] for k in (0, -8)]
        inner = [[x * scale, y * scale] for x, y in hole(1, -7, 1)]
        found = with_holes_inside(rings_of([outer[1]], [outer[0], inner]), np.zeros(2, dtype=int))
        assert lists(found) == [[outer[1], inner], [outer[0]]]


def touched(found):
    """Return the places where two rings of the same polygon touch."""
    places = set()
    for rings in polygons_of(found):
        every = [place for each in rings for place in each[1:]]
        places |= {place for place in every if every.count(place) > 1}
    return places


def test_a_coverage_that_shapely_calls_invalid():
    # A hole that touches its outer ring at (4, 2), and a neighbor with a side of its own there.
    square = shapely.Polygon(
        ring((0, 0), (4, 0), (4, 2), (4, 4), (0, 4)), [ring((4, 2), (3, 1), (3, 3))]
    )
    neighbor = shapely.Polygon(ring((4, 2), (6, 3), (4, 4)))
    assert shapely.is_valid([square, neighbor]).all()
    assert square.intersection(neighbor).length == 2
    assert square.intersection(neighbor).area == 0
    assert not shapely.coverage_is_valid([square, neighbor])
    apart = shapely.Polygon(square.exterior, [ring((3.5, 2), (3, 1), (3, 3))])
    assert shapely.coverage_is_valid([apart, neighbor])


@pytest.mark.parametrize("seed", range(6))
def test_bands_of_lattices_tile_the_surface(seed):
    found = lattice(seed).bands(interval=1)
    require_one_polygon_at_each_place(found, seed)
    sides = [(a, b) for rings in polygons_of(found) for each in rings for a, b in pairwise(each)]
    assert len(set(sides)) == len(sides)
    # Sides of one polygon are along the outline of the square; others are shared bit for bit.
    single = {side for side in sides if side[::-1] not in set(sides)}
    for (ax, ay), (bx, by) in single:
        assert (ax == bx and ax in {0, 11}) or (ay == by and ay in {0, 11})
    # All that shapely reports is a side of the outline beside a hole that touches its outer ring.
    places = touched(found)
    for edges in shapely.coverage_invalid_edges(found.to_shapely()):
        for edge in shapely.get_parts(edges):
            ends = [(Fraction(x), Fraction(y)) for x, y in edge.coords]
            for a, b in pairwise(ends):
                assert {(a, b), (b, a)} & single
                assert {a, b} & places
