"""Tiles as a surface: contours, profiles, volumes and rasters are those of one piece."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import datasets, distributed
from delone.distributed.read import contours as drawing
from delone.errors import BudgetExceededError, InputError
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

ARRAYS = ("points", "starts", "level", "index", "levels")


def survey() -> NDArray[np.float64]:
    """Soundings, without those that repeat a place."""
    baja = datasets.baja()
    points = np.column_stack([baja.points, baja.z])[::5]
    _, first = np.unique(points[:, :2], axis=0, return_index=True)
    return points[np.sort(first)]


def plateaus() -> NDArray[np.float64]:
    """A lattice with heights that are levels: plateaus, saddles, and lines through vertices."""
    grid = datasets.grid(900)
    return np.column_stack([grid, np.round(4 * np.sin(grid[:, 0] / 5) * np.cos(grid[:, 1] / 7))])


def ragged() -> NDArray[np.float64]:
    """Points along slanted sides, which are straight up to rounding: thin triangles at the hull."""
    dice = np.random.default_rng(3)
    way = np.sort(dice.random(300))
    corners = np.array([[0.1, 0.2], [9.7, 1.3], [11.1, 8.9], [1.7, 7.3]])
    sides = [
        a + way[:, None] * (b - a) for a, b in zip(corners, np.roll(corners, -1, 0), strict=True)
    ]
    inner = corners.mean(axis=0) + (dice.random((500, 2)) - 0.5) * 5
    points = np.concatenate([*sides, inner])
    z = np.sin(3 * points[:, 0]) + np.cos(5 * points[:, 1]) + dice.random(len(points))
    _, first = np.unique(points, axis=0, return_index=True)
    return np.column_stack([points, z])[np.sort(first)]


DATA = {"survey": (survey, 250.0), "plateaus": (plateaus, 0.5), "ragged": (ragged, 0.05)}


@pytest.fixture(scope="module", params=list(DATA))
def both(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[distributed.TiledDelaunay, TIN, float]:
    make, interval = DATA[request.param]
    points = make()
    folder = tmp_path_factory.mktemp(request.param) / "tin"
    tiles = distributed.triangulate(points, folder, tile_points=len(points) // 7)
    assert tiles.ntiles > 4
    return tiles, TIN.from_points(points), interval


def same(found: Any, right: Any) -> None:
    for name in ARRAYS:
        assert np.array_equal(getattr(found, name), getattr(right, name)), name
    assert (found.left_out, found.short, found.small) == (right.left_out, right.short, right.small)


@pytest.mark.parametrize("crossings", [1, 3000, 1 << 40])
def test_contours_are_those_of_one_piece(
    both: Any, crossings: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    tiles, tin, interval = both
    monkeypatch.setattr(drawing, "CROSSINGS", crossings)
    right = tin.contours(interval=interval)
    assert len(right) > 20
    same(tiles.contours(interval=interval), right)


def test_lines_are_finished_alike(both: Any) -> None:
    tiles, tin, interval = both
    for options in (
        {"smooth": 2},
        {"min_length": 0.5, "min_area": 0.01},
        {"simplify": 0.05, "index": 2, "base": 0.25},
    ):
        same(
            tiles.contours(interval=interval, **options), tin.contours(interval=interval, **options)
        )


@pytest.mark.parametrize("crossings", [1, 3000, 1 << 40])
def test_parts_are_all_lines(both: Any, monkeypatch: pytest.MonkeyPatch, crossings: int) -> None:
    tiles, _, interval = both
    monkeypatch.setattr(drawing, "CROSSINGS", crossings)
    how = {"interval": interval, "min_length": 0.5, "min_area": 0.01}
    whole = tiles.contours(**how)
    parts = list(tiles.contour_parts(**how))
    assert len(parts) == (1 if crossings > 3000 else len(parts)) and len(parts) >= 1
    assert crossings > 1 or len(parts) == len(whole.levels)
    for name in ("points", "level", "index"):
        assert np.array_equal(
            np.concatenate([getattr(each, name) for each in parts]), getattr(whole, name)
        )
    assert np.array_equal(
        np.concatenate([np.diff(each.starts) for each in parts]), np.diff(whole.starts)
    )
    assert all(np.array_equal(each.levels, whole.levels) for each in parts)
    for name in ("short", "small"):
        assert sum(getattr(each, name) for each in parts) == getattr(whole, name)
    assert [len(each) for each in tiles.contour_parts([])] == [0]
    with pytest.raises(InputError, match="interval"):
        tiles.contour_parts(interval=-1.0)


def test_levels_without_lines(both: Any) -> None:
    tiles, tin, _ = both
    for levels in ([1e9], [], [-1e9, 0.0, 1e9]):
        same(tiles.contours(levels), tin.contours(levels))


def test_thin_triangles_are_left_out_in_all_levels(
    both: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A triangle at the hull that has to go in one group of levels goes in all of them."""
    tiles, tin, interval = both
    monkeypatch.setattr(drawing, "CROSSINGS", 500)
    right = tin.contours(interval=interval / 3)
    found = tiles.contours(interval=interval / 3)
    same(found, right)


def test_levels_beside_each_other_see_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Points of two levels are united where rounding puts them on the wrong sides, in both.

    Lines are some twenty units in the last place apart here, and each level is drawn alone.
    """
    dice = np.random.default_rng(8)
    points = np.column_stack([2.0**20 + dice.random((600, 2)), dice.random(600)])
    monkeypatch.setattr(drawing, "CROSSINGS", 1)
    tiles = distributed.triangulate(points, tmp_path / "tin", tile_points=100)
    levels = 0.5 + 1e-7 * np.arange(6)
    same(tiles.contours(levels), TIN.from_points(points).contours(levels))


def test_a_line_outside_is_told(both: Any) -> None:
    with pytest.warns(UserWarning, match="outside the surface: the profile has no points"):
        assert len(both[0].profile([(1e9, 1e9), (2e9, 2e9)])) == 0


def test_a_limit_and_wrong_arguments(both: Any) -> None:
    tiles, _, interval = both
    with pytest.raises(BudgetExceededError, match="at least"):
        tiles.contours(interval=interval, max_points=10)
    with pytest.raises(InputError, match="has no 'depth'"):
        tiles.contours(interval=interval, values="depth")
    with pytest.raises(InputError, match="executor must be"):
        tiles.contours(interval=interval, executor="threads")
    with pytest.raises(InputError, match="either levels= or interval="):
        tiles.contours()


def test_profiles_are_those_of_one_piece(both: Any) -> None:
    tiles, tin, _ = both
    low, high = tin.points.min(axis=0), tin.points.max(axis=0)
    middle = (low + high) / 2
    lines = (
        [low, high],
        [low - 1, middle, high + 1],
        [(low[0], middle[1]), (high[0], middle[1]), low],
        tin.points[:2],
    )
    for line in lines:
        found, right = tiles.profile(line), tin.profile(line)
        for name in ("points", "distances", "z"):
            assert np.array_equal(getattr(found, name), getattr(right, name), equal_nan=True), name
    assert len(tiles.profile([high + 5, high + 6])) == 0


def test_volumes_are_those_of_one_piece(both: Any) -> None:
    tiles, tin, _ = both
    low, high = tin.points.min(axis=0), tin.points.max(axis=0)
    level = float(np.median(tin.z))
    a, b = low + (high - low) * 0.2, low + (high - low) * 0.7
    ring = [[a, (b[0], a[1]), b, (a[0], b[1])]]
    slope = TIN.from_points(
        [(*low, level - 1), (high[0], low[1], level), (*high, level + 1), (low[0], high[1], level)]
    )
    for other in (level, (0.1, 0.2, level), slope):
        for region in (None, ring):
            found, right = (each.volume_to(other, region=region) for each in (tiles, tin))
            for name in ("cut", "fill", "cut_area", "fill_area", "area"):
                assert getattr(found, name) == pytest.approx(getattr(right, name), rel=1e-9), name
            assert found.of_triangles.shape == (tiles.ntiles, 5)
            assert found.of_triangles[:, 0].sum() == pytest.approx(right.cut)


def test_volume_between_tiles(both: Any, tmp_path: Path) -> None:
    tiles, tin, _ = both
    raised = np.column_stack([tin.points, tin.z + 0.5])[::-1]
    other = distributed.triangulate(raised, tmp_path / "raised", tile_points=len(raised) // 4)
    found = tiles.volume_to(other)
    assert found.area == pytest.approx(tin.areas.sum(), rel=1e-9)
    assert found.fill == pytest.approx(0.5 * tin.areas.sum(), rel=1e-9)
    assert found.cut == pytest.approx(0.0, abs=1e-9 * found.fill)
    with pytest.warns(UserWarning, match="no area in common"):
        tiles.volume_to(0.0, region=[[(900, 900), (901, 900), (901, 901)]])


@pytest.mark.parametrize("what", ["slope", "aspect", "hillshade"])
def test_rasters_of_measures(both: Any, what: str, tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    tiles, tin, _ = both
    side = float((tin.max_bound - tin.min_bound).max() / 70.3)
    light = {"azimuth": 200.0, "altitude": 30.0} if what == "hillshade" else {}
    tiles.to_raster(side, tmp_path / "dem.tif", what=what, **light)
    right = tin.raster(what, resolution=side, **light)
    with rasterio.open(tmp_path / "dem.tif") as file:
        found = file.read(1)[::-1]
    # A center on an edge may belong to either of two triangles.
    assert np.array_equal(np.isnan(found), np.isnan(right.values)) or what == "aspect"
    agree = np.isclose(found, right.values, rtol=1e-5, equal_nan=True)
    assert agree.mean() > 0.98
    with pytest.raises(InputError, match="what must be"):
        tiles.to_raster(side, tmp_path / "dem.tif", what="roughness")


def test_contours_and_volumes_on_dask(both: Any) -> None:
    dask = pytest.importorskip("distributed")
    tiles, tin, interval = both
    with dask.Client(
        n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
    ) as client:
        same(tiles.contours(interval=interval, executor=client), tin.contours(interval=interval))
        found = tiles.volume_to(1.0, executor=client)
    assert found.cut == pytest.approx(tin.volume_to(1.0).cut)


def test_triangles_that_are_left_out_add_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each round leaves out more triangles; those of all rounds are left out in the next one."""
    states: list[Any] = []
    rounds = [([4, 7], [7]), ([4, 2], [2]), ([4], []), ([4], []), ([], [])]

    def lines(levels: Any, wanted: Any, files: Any, state: Any) -> drawing._Part:
        states.append(state)
        tangled, outer = rounds[len(states) - 1]
        return drawing._Part("a.npz", np.array(tangled, np.int64), np.array(outer, np.int64))

    monkeypatch.setattr(drawing, "_lines", lines)
    parts, dropped = drawing._untangled(np.array([1.0]), [((0, 1), ["0-0.npz"])], "serial")
    assert (parts, dropped.tolist()) == (["a.npz"], [2, 7])
    assert [state.dropped.tolist() for state in states] == [[], [7], [2, 7], [2, 7], [2, 7]]
    # Then points that are far apart are united, and at last triangles are collapsed.
    assert [state.far for state in states] == [False, False, False, True, True]
    assert [state.collapsed.tolist() for state in states] == [[], [], [], [], [4]]
