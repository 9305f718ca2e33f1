"""Holes and parts of cells that nest, and those that do not, on the sphere and in the plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid

shapely = pytest.importorskip("shapely")
box, Polygon, MultiPolygon = shapely.box, shapely.Polygon, shapely.MultiPolygon

WRONG = "a hole that is not inside its outer ring, or holes or parts that overlap"


def quad(west: float, south: float, east: float, north: float) -> list[tuple[float, float]]:
    return [(west, south), (east, south), (east, north), (west, north)]


OUTER, HOLE = quad(0, 0, 10, 10), quad(2, 2, 8, 8)
FRAME = Polygon(OUTER, [HOLE])
# Areas in the plane. On the sphere, sides along parallels are arcs, but those here are common ones.
RIGHT = {
    "an island": (MultiPolygon([FRAME, box(4, 4, 6, 6)]), 68),
    "an island that fills the hole": (MultiPolygon([FRAME, box(2, 2, 8, 8)]), 100),
    "an island that touches": (MultiPolygon([FRAME, Polygon([(2, 2), (6, 3), (3, 6)])]), 71.5),
    "an island before its ring": (MultiPolygon([box(4, 4, 6, 6), FRAME]), 68),
    "an island with a lake": (MultiPolygon([FRAME, Polygon(HOLE, [quad(4, 4, 6, 6)])]), 96),
    "parts with a common side": (MultiPolygon([box(0, 0, 9, 9), box(9, 0, 18, 9)]), 162),
    "parts with a common corner": (MultiPolygon([box(0, 0, 9, 9), box(9, 9, 18, 18)]), 162),
    "a hole at a corner": (Polygon(OUTER, [[(0, 0), (4, 2), (2, 4)]]), 94),
    "a hole at a side": (Polygon(OUTER, [[(0, 2), (4, 2), (4, 4), (0, 4)]]), 92),
    "holes with a common side": (Polygon(OUTER, [quad(2, 2, 4, 4), quad(4, 2, 6, 4)]), 92),
    "a hole that is all": (Polygon(OUTER, [OUTER]), 0),
    "a part without area and its hole": (
        MultiPolygon(
            [Polygon([(20, 0), (26, 0), (22, 0)], [[(0, -20), (0, -26), (0, -22)]]), Polygon(OUTER)]
        ),
        100,
    ),
    "a hole without area": (Polygon(OUTER, [[(20, 0), (30, 0), (20, 0)]]), 100),
}
BAD = {
    "a part in a part": MultiPolygon([Polygon(OUTER), box(2, 2, 4, 4)]),
    "a part around a part": MultiPolygon([box(2, 2, 4, 4), Polygon(OUTER)]),
    "a part at a corner": MultiPolygon([Polygon(OUTER), Polygon([(0, 0), (4, 2), (2, 4)])]),
    "an island over its hole": MultiPolygon([FRAME, box(1, 1, 9, 9)]),
    "an island beside the hole": MultiPolygon([FRAME, box(0.5, 0.5, 1.5, 1.5)]),
    "a hole outside": Polygon(OUTER, [quad(20, 2, 28, 8)]),
    "a hole of another part": MultiPolygon(
        [Polygon(OUTER, [quad(22, 2, 28, 8)]), box(20, 0, 30, 10)]
    ),
    "a hole around its ring": Polygon(HOLE, [OUTER]),
    "a hole in a hole": Polygon(OUTER, [HOLE, quad(3, 3, 4, 4)]),
    "a hole around a hole": Polygon(OUTER, [quad(3, 3, 4, 4), HOLE]),
    "a hole of a part without area": MultiPolygon(
        [Polygon([(20, 0), (30, 0), (25, 0)], [quad(22, 2, 28, 8)]), Polygon(OUTER)]
    ),
    "a hole of a ring without area in another part": MultiPolygon(
        [Polygon(OUTER), Polygon([(2, -9), (8, -9), (4, -9)], [quad(2, 2, 8, 8)])]
    ),
    "a hole twice in a hole": Polygon(OUTER, [HOLE, quad(3, 3, 4, 4), quad(6, 6, 7, 7)]),
}  # fmt: skip


def wound(given: Any, winding: str | None) -> Any:
    return shapely.orient_polygons(given, exterior_cw=winding == "cw")


@pytest.mark.sampled(16)
@pytest.mark.parametrize("winding", [None, "smaller", "ccw", "cw"])
@pytest.mark.parametrize("name", RIGHT)
def test_rings_that_nest(name: str, winding: str | None) -> None:
    given, area = RIGHT[name]
    beside = box(40, 0, 50, 10)
    overlaps = delone.Overlaps([beside, given], [box(-50, -50, 50, 50)])
    assert overlaps.source_areas.tolist() == pytest.approx([100, area], rel=1e-14)
    cells = wound(np.array([beside, given]), winding)
    areas = Grid.from_polygons(cells, winding=winding).areas
    rings = [Grid.from_polygons(each, winding=winding).areas.sum() for each in cells]
    assert areas.tolist() == pytest.approx(rings, rel=1e-14)
    # Outer rings, less the holes, each of them alone.
    parts = shapely.get_parts(cells[1])
    outer = shapely.polygons(shapely.get_exterior_ring(parts))
    holes = [shapely.Polygon(ring) for part in parts for ring in part.interiors]
    expected = Grid.from_polygons(outer, winding="smaller").areas.sum()
    expected -= Grid.from_polygons([*holes, None, beside], winding="smaller").areas[:-1].sum()
    assert areas[1] == pytest.approx(expected, rel=1e-13, abs=1e-15)


@pytest.mark.sampled(16)
@pytest.mark.parametrize("winding", [None, "smaller", "ccw", "cw"])
@pytest.mark.parametrize("name", BAD)
def test_rings_that_do_not_nest(name: str, winding: str | None) -> None:
    given = BAD[name]
    cells = [box(40, 0, 50, 10), given, None, given]
    with pytest.raises(delone.InputError, match=rf"target: 2 polygons have {WRONG}, .* polygon 1:"):
        delone.Overlaps([box(0, 0, 9, 9)], cells)
    cells = [each if each is None else wound(each, winding) for each in cells]
    with pytest.raises(delone.DirectionError, match=rf"2 cells have {WRONG}, .* cell 1:") as caught:
        Grid.from_polygons(cells, winding=winding)
    assert caught.value.rows.tolist() == [1, 3]
    # What the message says helps.
    repaired = shapely.make_valid(given, method="structure", keep_collapsed=False)
    assert Grid.from_polygons([repaired, cells[0]]).validate()
    assert delone.Overlaps([repaired], [box(-50, -50, 50, 50)]).report.npairs <= 1


COAST = [(0, -65), (120, -65), (240, -65)]
ISLAND = quad(0, 0, 20, 20)


def ocean(*lakes: Any, islands: Any = (ISLAND,)) -> Any:
    return MultiPolygon([Polygon(COAST, islands), *lakes])


# Oceans, the holes in them and the closed rings of sides.
OCEANS = {
    "an island": (ocean(), 2, 2),
    "a lake": (ocean(box(5, 5, 10, 10)), 2, 3),
    "two lakes": (ocean(box(3, 3, 6, 6), box(10, 10, 15, 15)), 2, 4),
    "a lake whose sides are those of other lakes": (
        ocean(
            Polygon(quad(5, 5, 10, 10), [quad(6, 6, 7, 7)]),
            Polygon([(5, 5), (7, 1), (10, 5)]),
            Polygon([(10, 5), (15, 7), (10, 10)]),
            Polygon([(10, 10), (7, 15), (5, 10)]),
            Polygon([(5, 10), (1, 7), (5, 5)]),
        ),
        3,
        4,
    ),
    "a lake at a corner": (ocean(Polygon([(0, 0), (10, 2), (2, 10)])), 2, 3),
    "a lake at the coast": (ocean(Polygon([(0, 0), (20, 0), (10, 10)])), 2, 2),
    "a lake instead of an island": (ocean(Polygon(ISLAND)), 1, 1),
    "a lake with an island": (ocean(Polygon(quad(5, 5, 15, 15), [quad(7, 7, 9, 9)])), 3, 4),
    "an island at the coast": (ocean(islands=[[(0, -65), (120, -65), (60, -30)]]), 1, 1),
    "islands with a common side": (ocean(islands=[ISLAND, quad(20, 0, 40, 20)]), 2, 2),
    "islands that enclose a lagoon": (
        ocean(
            islands=[
                [(0, 0), (9, 0), (9, 5), (5, 5), (5, 9), (0, 9)],
                [(9, 5), (9, 9), (5, 9), (7, 7)],
            ]
        ),
        2,
        3,
    ),
}
BAD_OCEANS = {
    "a hole on the other side of the coast": ocean(islands=[quad(0, -89, 90, -80)]),
    "an island in an island": ocean(islands=[ISLAND, quad(5, 5, 10, 10)]),
    "an island at a corner of an island": ocean(islands=[ISLAND, [(0, 0), (10, 2), (2, 10)]]),
    "a lake in the ocean": ocean(box(50, 5, 60, 10)),
    "a lake around its island": ocean(box(-5, -5, 30, 30)),
    "a lake in a lake": ocean(box(5, 5, 10, 10), box(6, 6, 7, 7)),
    "a hole of the ocean in a lake": ocean(box(5, 5, 10, 10), islands=[ISLAND, quad(6, 6, 7, 7)]),
}


@pytest.mark.parametrize("winding", ["ccw", "cw"])
@pytest.mark.parametrize("name", OCEANS)
def test_oceans(name: str, winding: str) -> None:
    given, holes, rims = OCEANS[name]
    grid = Grid.from_polygons([wound_as_given(given, winding)], winding=winding)
    assert grid.report.large.tolist() == [0]
    faults = grid.validate()
    assert (faults.holes, len(faults.rims), faults.slivers) == (holes, rims, 0)


@pytest.mark.parametrize("winding", ["ccw", "cw"])
@pytest.mark.parametrize("name", BAD_OCEANS)
def test_oceans_whose_rings_do_not_nest(name: str, winding: str) -> None:
    given = wound_as_given(BAD_OCEANS[name], winding)
    with pytest.raises(delone.DirectionError, match=f"1 cell has {WRONG}, first cell 1") as caught:
        Grid.from_polygons([wound(box(30, -9, 40, 0), winding), given], winding=winding)
    assert caught.value.rows.tolist() == [1]


def wound_as_given(given: Any, winding: str) -> Any:
    """All outer rings in the other direction for "cw"."""
    return given if winding == "ccw" else given.reverse()


def test_a_part_in_another_one_far_from_the_rest() -> None:
    # No hemisphere contains the parts.
    far = box(180, 0, 190, 10)
    with pytest.raises(delone.DirectionError, match=f"1 cell has {WRONG}"):
        Grid.from_polygons([MultiPolygon([far, Polygon(OUTER), box(2, 2, 4, 4)])])
    grid = Grid.from_polygons([MultiPolygon([far, FRAME, box(4, 4, 6, 6)])])
    assert grid.report.large.tolist() == [0]


def test_parts_that_touch_but_for_rounding() -> None:
    # A corner of the second part is in a side of the first one, but for rounding, on either side.
    a, b = np.array([0.1, 0.2]), np.array([0.7, 1.1])
    for t in np.linspace(0.1, 0.9, 40):
        middle = a + t * (b - a)
        parts = MultiPolygon([Polygon([a, b, (2, 0)]), Polygon([a, middle, b, (-1, 1)])])
        assert delone.Overlaps([parts], [box(0, 0, 1, 1)]).report.npairs == 1
        hole = Polygon([a, b, (-1, 1)], [[a, middle, b, (0, 0.8)]])
        assert delone.Overlaps([hole], [box(-1, 0, 1, 2)]).report.npairs == 1
