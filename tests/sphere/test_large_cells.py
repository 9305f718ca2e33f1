"""Cells beyond a hemisphere: on the larger side of their rings, or in parts far from each other."""

from __future__ import annotations

import pickle
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.sphere import Grid, Overlaps
from delone.sphere.chart import _arcs
from delone.sphere.sides import PolygonWarning

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

SPHERE = 4 * np.pi
BOXES = Grid.from_lonlat(np.arange(0, 361, 15), np.arange(-90, 91, 15))
# Around the north pole, over the Pacific, and a concave one; clockwise, and so with the rest of the
# sphere on their left.
RINGS = {
    "pole": [(0, 60), (270, 60), (180, 60), (90, 60)],
    "date line": [(170, -10), (170, 10), (-170, 10), (-170, -10)],
    "concave": [(0, 0), (0, 30), (5, 5), (40, 0)],
    # Its sides pass exactly through places that the triangulation adds.
    "through": [(-20, 0), (0, 20), (20, 0), (0, -20)],
    "wide": [(0, -80), (0, 80), (100, 80), (100, -80)],
}


def both(ring: list[tuple[float, float]], **options: Any) -> tuple[Grid, Grid]:
    return Grid.from_mesh(lonlat=[ring]), Grid.from_mesh(lonlat=[ring], **options)


@pytest.mark.parametrize("name", RINGS)
def test_a_cell_and_what_is_outside_of_it_are_the_sphere(name: str) -> None:
    inside, outside = both(RINGS[name], winding="ccw")
    assert inside.areas[0] < SPHERE / 2
    assert inside.areas[0] + outside.areas[0] == pytest.approx(SPHERE, rel=1e-14)
    assert outside.report.large.tolist() == [0]
    assert not len(outside.report.reversed)
    for grids in (BOXES, inside), (inside, BOXES), (BOXES, BOXES):
        assert Overlaps(*grids).matrix.sum() == pytest.approx(
            min(grid.areas.sum() for grid in grids), rel=1e-14
        )
    small = Overlaps(BOXES, inside).matrix.toarray()[0]
    large = Overlaps(BOXES, outside)
    assert np.allclose(small + large.matrix.toarray()[0], BOXES.areas, rtol=1e-14)
    assert np.allclose(large.covered_source + small / BOXES.areas, 1, rtol=1e-14)
    assert large.covered_target.tolist() == pytest.approx([1], rel=1e-14)
    turned = Overlaps(outside, BOXES).matrix.toarray()[:, 0]
    assert np.array_equal(turned, large.matrix.toarray()[0])
    # They only touch each other.
    assert Overlaps(inside, outside).matrix.sum() < 1e-15
    assert Overlaps(outside, outside).matrix.sum() == pytest.approx(outside.areas[0], rel=1e-14)


def test_the_side_that_is_said() -> None:
    ring = RINGS["concave"]
    inside, outside = both(ring, winding="ccw")
    for points, winding, expected in (
        (ring, "cw", inside), (ring, "smaller", inside), (ring[::-1], "ccw", inside),
        (ring[::-1], "cw", outside),
    ):  # fmt: skip
        found = Grid.from_mesh(lonlat=[points], winding=winding)
        assert found.areas == pytest.approx(expected.areas, rel=1e-14)
        assert len(found.report.large) == (expected is outside)


def test_corners_that_no_hemisphere_contains() -> None:
    # Like the seam of a tennis ball, with more than half of the sphere on the left.
    angle = np.radians(np.arange(0, 360, 10))
    ring = np.column_stack((np.degrees(angle), 20 + 50 * np.cos(2 * angle)))[::-1]
    with pytest.raises(delone.DirectionError, match=r"no hemisphere contains.*give winding="):
        Grid.from_mesh(lonlat=[ring])
    areas = {w: Grid.from_mesh(lonlat=[ring], winding=w).areas[0] for w in ("smaller", "ccw", "cw")}
    assert areas["smaller"] == areas["cw"] < SPHERE / 2
    assert areas["ccw"] + areas["cw"] == pytest.approx(SPHERE, rel=1e-14)
    # A hemisphere is on the left, whatever is smaller by rounding.
    equator = np.column_stack((np.arange(0, 360, 90), np.zeros(4)))
    for points, pole in ((equator, 90), (equator[::-1], -90)):
        half = Grid.from_mesh(lonlat=[points], winding="smaller")
        assert half.areas[0] == pytest.approx(SPHERE / 2, rel=1e-14)
        cap = Grid.from_lonlat([0, 360], [np.copysign(80, pole), pole])
        assert Overlaps(cap, half).covered_source[0] == pytest.approx(1, rel=1e-14)


def world() -> Any:
    """The land of the world as one polygon with several parts, and the same as an ocean."""
    shapely = pytest.importorskip("shapely")
    lands = [shapely.Polygon(ring) for name, ring in RINGS.items() if name in {"pole", "concave"}]
    far = shapely.Polygon(
        [(200, -40), (230, -40), (230, 0)], [[(215, -35), (225, -35), (225, -28)]]
    )
    return shapely.MultiPolygon([*lands, far]), lands, far


def test_polygons_of_parts_and_oceans_with_islands() -> None:
    shapely = pytest.importorskip("shapely")
    land, lands, far = world()
    whole, parts = Grid.from_polygons([land, far]), Grid.from_polygons([*lands, far])
    # No hemisphere contains the land, but each of its parts, with the hole in one of them.
    assert whole.report.large.tolist() == [0]
    assert whole.areas[0] == pytest.approx(parts.areas.sum(), rel=1e-14)
    assert whole.areas[1] == parts.areas[2]
    assert np.allclose(
        Overlaps(BOXES, whole).matrix.toarray()[0],
        Overlaps(BOXES, parts).matrix.toarray().sum(axis=0),
        rtol=1e-14,
    )
    # An ocean: the outer ring is a coast, with the ocean on its left, and islands are holes.
    coast = RINGS["pole"]
    islands = [RINGS["concave"], far.exterior.coords[:-1]]
    # Shapely knows nothing of spheres: the inside of the first ring is what is given as such.
    ocean = shapely.Polygon(coast, islands)
    sea = Grid.from_polygons([ocean], winding="ccw")
    dry = Grid.from_polygons([lands[0], lands[1], shapely.Polygon(islands[1])])
    assert sea.areas[0] + dry.areas.sum() == pytest.approx(SPHERE, rel=1e-14)
    assert Overlaps(dry, sea).matrix.sum() < 1e-14


def test_fields_and_files_and_pictures(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    shapely = pytest.importorskip("shapely")
    inside, outside = both(RINGS["date line"], winding="ccw")
    rings = np.array([RINGS["date line"][::-1], RINGS["date line"]], dtype=float)
    grid = Grid.from_mesh(lonlat=rings, winding="ccw")
    assert grid.report.large.tolist() == [1]
    assert repr(grid.report) == "<GridReport: 1 cell concave, 1 cell beyond a hemisphere>"
    assert grid.validate()
    assert grid.validate().covered == pytest.approx(1, rel=1e-14)
    weights = Overlaps(grid, BOXES).to_weights("conservative")
    assert np.allclose(weights.apply([3.0, 3.0]), 3, rtol=1e-14)
    means = Overlaps(BOXES, grid).to_weights("conservative")
    north = np.sin(np.radians(BOXES.centers_lonlat[:, 1]))
    assert np.allclose(means.apply(north), 0, atol=1e-14)
    # Slopes cancel over the triangles as over other cells.
    parts = [RINGS["pole"], RINGS["concave"], RINGS["date line"]]
    small = [shapely.Polygon(ring[::-1]) for ring in parts]
    rest = shapely.Polygon(parts[0], parts[1:])
    ocean = Grid.from_polygons([*small, rest], winding="ccw")
    assert ocean.areas.sum() == pytest.approx(SPHERE, rel=1e-14)
    field = np.array([1.0, 2, 3, 4])
    second = Overlaps(ocean, BOXES).to_weights("conservative", order=2)
    total = (second.apply(field).ravel() * BOXES.areas).sum()
    assert total == pytest.approx(ocean.areas @ field, rel=1e-12)
    grid.save(tmp_path / "grid.npz")
    for again in (Grid.load(tmp_path / "grid.npz"), pickle.loads(pickle.dumps(grid))):
        assert np.array_equal(again.areas, grid.areas)
        assert again.report.large.tolist() == [1]
    table = grid.to_geopandas()
    whole = shapely.box(-180, -90, 180, 90)
    assert table.geometry.union_all().symmetric_difference(whole).area < 1e-6
    assert table.geometry[0].intersection(table.geometry[1]).area < 1e-6
    axes = outside.plot(values=[1.0])
    assert len(outside.rings[0]) > 12
    assert axes.get_xlim() == (-180, 180)
    # The four sides alone are drawn, not those between its triangles.
    assert [sum(map(len, _arcs(each))) for each in (inside, outside)] == [4, 4]


def test_what_is_refused_and_warned_of() -> None:
    shapely = pytest.importorskip("shapely")
    ring = RINGS["concave"]
    with pytest.raises(delone.InputError, match="winding must be"):
        Grid.from_mesh(lonlat=[ring], winding="left")
    # The second crossing is at a place that the triangulation adds.
    for end in (290, 300):
        bow = [(0, 0), (100, 0), (200, 0), (end, 0), (150, 50), (300, -50)]
        with pytest.raises(delone.DirectionError, match=r"1 cell .* cross .* cell 1:") as caught:
            Grid.from_mesh(lonlat=[*ring, *bow], starts=[0, 4, 10], winding="smaller")
        assert caught.value.rows.tolist() == [1]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Grid.from_mesh(lonlat=[ring], winding="ccw")
    with pytest.warns(PolygonWarning, match="2 cells are larger than a hemisphere, so"):
        Grid.from_mesh(lonlat=[ring, RINGS["pole"]], winding="ccw")
    fine = Grid.from_healpix(10)
    corners = fine.rings[0].reshape(-1, 4, 3)
    with pytest.raises(delone.InputError, match="1200 cells are larger than a hemisphere with"):
        Grid.from_mesh(corners, winding="cw")
    expected = Grid.from_mesh(corners)
    assert np.array_equal(Grid.from_mesh(corners, winding="ccw").areas, expected.areas)
    # Both run westward, which has the pole on the right in the north, and on the left in the south.
    one = shapely.Polygon(RINGS["pole"])
    torn = shapely.MultiPolygon([one, shapely.affinity.translate(one, 45, -130)])
    with pytest.raises(delone.InputError, match=r"cell 0: outer rings .* run in both directions"):
        Grid.from_polygons([torn], winding="ccw")


CAP = [(0, 50), (270, 50), (180, 50), (90, 50)]
SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]


def test_a_clockwise_cell_that_may_be_the_rest_of_the_sphere_is_told() -> None:
    with pytest.warns(PolygonWarning, match=r"^1 large cell is clockwise, first cell 0, whose "):
        grid = Grid.from_mesh(lonlat=[CAP])
    assert grid.areas[0] < np.pi
    with pytest.warns(PolygonWarning, match="first cell 1, whose smaller side has"):
        Grid.from_mesh(lonlat=[SQUARE, CAP])
    shapely = pytest.importorskip("shapely")
    with pytest.warns(PolygonWarning, match="first cell 1, whose smaller side has"):
        Grid.from_polygons([shapely.box(0, 0, 10, 10), shapely.Polygon(CAP)])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    "cells",
    [
        [CAP, [(0, -50), (90, -50), (180, -50), (270, -50)]],
        [CAP[::-1]],
        [SQUARE[::-1]],
        [SQUARE, SQUARE[::-1]],
        [CAP[::-1], SQUARE[::-1]],
    ],
    ids=["all clockwise", "counterclockwise", "small", "small among others", "large among others"],
)
def test_other_clockwise_cells_are_only_counted(cells: Any) -> None:
    Grid.from_mesh(lonlat=cells)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("winding", ["smaller", "cw", "ccw"])
def test_no_side_is_in_doubt_with_winding(winding: str) -> None:
    Grid.from_mesh(lonlat=[CAP], winding=winding)


@pytest.mark.parametrize(("width", "told"), [(43, False), (44, True)])
def test_half_a_steradian_is_told(width: float, told: bool) -> None:
    box = [(0, 0), (0, 40), (width, 40), (width, 0)]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        area = Grid.from_mesh(lonlat=[box]).areas[0]
    assert abs(area - 0.5) < 0.01
    assert (len(caught) == 1) == (area > 0.5) == told
