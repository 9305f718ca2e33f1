"""Tiles with a number of triangles: the stated step of the scale of errors, and no other one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import distributed
from delone.distributed.read import simplifying
from delone.distributed.read.fitting import fitting
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from numpy.typing import NDArray


def bumps(count: int = 1500, height: float = 1.0) -> NDArray[np.float64]:
    dice = np.random.default_rng(5)
    xy = dice.random((count, 2)) * 40
    z = np.sin(xy[:, 0] / 3) * np.cos(xy[:, 1] / 4) + dice.random(count) / 4
    return np.column_stack([xy, height * z])


@pytest.fixture(scope="module")
def tiles(tmp_path_factory: pytest.TempPathFactory) -> distributed.TiledDelaunay:
    return distributed.triangulate(bumps(), tmp_path_factory.mktemp("a") / "tin", tile_points=200)


def on_scale(error: float) -> bool:
    return error == 2.0 ** (round(8 * math.log2(error)) / 8)


@pytest.mark.parametrize("most", [80, 200, 700, 2000])
def test_one_step_finer_has_more_triangles(tiles: Any, most: int) -> None:
    tin, error = simplifying.simplify(tiles, (None, most), "breaklines", "z", "serial")
    assert on_scale(error)
    step = round(8 * math.log2(error))
    right, finer = (tiles.simplify(max_error=2.0 ** (k / 8)) for k in (step, step - 1))
    assert tin.nsimplex <= most < finer.nsimplex
    assert np.array_equal(tin.xyz, right.xyz) and np.array_equal(tin.simplices, right.simplices)
    assert np.array_equal(tiles.simplify(max_triangles=most).xyz, tin.xyz)
    assert all(simplifying.prove(tiles, tin, error))


def test_enough_for_all_points(tiles: Any) -> None:
    tin, error = simplifying.simplify(tiles, (None, 10**6), "breaklines", "z", "serial")
    assert error == 0
    assert np.array_equal(tin.xyz, tiles.simplify(max_error=0).xyz)
    assert set(map(tuple, bumps().tolist())) <= set(map(tuple, tin.xyz.tolist()))


def test_what_stays_is_the_same_for_tiles(tiles: Any) -> None:
    right = tiles.simplify(max_error=0.3)
    for keep in ("hard", "boundary"):
        assert np.array_equal(tiles.simplify(max_error=0.3, keep=keep).xyz, right.xyz)
    with pytest.raises(InputError, match="keep must be"):
        tiles.simplify(max_error=0.3, keep="lines")


def test_goals_that_cannot_be(tiles: Any, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"below the \d+ triangles of cuts between tiles and hull"):
        tiles.simplify(max_triangles=9)
    for goal in ({}, {"max_error": 1, "max_triangles": 900}):
        with pytest.raises(InputError, match="give one of max_error and max_triangles"):
            tiles.simplify(**goal)
    with pytest.raises(InputError, match="max_triangles must be"):
        tiles.simplify(max_triangles=0)
    level = distributed.triangulate(bumps(300, 0.0), tmp_path / "level", tile_points=100)
    found = level.simplify(max_triangles=100)
    assert found.nsimplex <= 100 < level.simplify(max_error=0).nsimplex
    with pytest.raises(InputError, match="max_triangles=3 is below"):
        level.simplify(max_triangles=3)


def counter(of: Callable[[float], int]) -> tuple[Any, list[float]]:
    """Return what counts triangles by a formula, and the errors that it was called with."""
    asked: list[float] = []

    def count(error: float, coarser: list[float]) -> NDArray[np.int64]:
        assert coarser[0] == error
        asked.append(error)
        # Of lines for this error, which are finer than those for larger ones.
        return np.array([of(each) + (of(error) - of(each)) // 50 for each in coarser])

    return count, asked


@pytest.mark.parametrize("power", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
@pytest.mark.parametrize("most", [30, 5000, 10**8])
def test_the_search_ends_soon(power: float, scale: float, most: int) -> None:
    def of(error: float) -> int:
        return min(2 * 10**9, 20 + int((scale / error) ** power)) if error else 2 * 10**9

    count, asked = counter(of)
    error = fitting(count, (-scale, scale), 10**9, most)
    assert of(error) <= most
    finer = error * 2.0 ** (-1 / 8)
    assert error == 0 or of(finer if finer >= math.ulp(scale) else 0.0) > most
    assert len(asked) <= 14 and len(set(asked)) == len(asked)


def test_a_curve_leads_to_the_error_at_once() -> None:
    for most in (200, 300, 500, 900):
        count, asked = counter(lambda error: 20 + int(100 / error**2))
        fitting(count, (0.0, 4.0), 10**9, most)
        # The first error, those that curves suggest, and one step finer.
        assert len(asked) <= 4


def test_counts_for_larger_errors_are_those_of_their_surfaces(tiles: Any) -> None:
    coarser = [0.05 * 1.1**k for k in range(40)]
    for number in range(tiles.ntiles):
        given = (str(tiles.path), "z", number, [], 0.05)
        levels = simplifying._levels(*given)
        assert levels is not None and (np.diff(levels.errors) > 0).any()
        right = [len(levels.surface(max_error=error).simplices) for error in coarser]
        assert simplifying._counts(*given, coarser).tolist() == right


def test_counts_that_go_up_and_down() -> None:
    def of(error: float) -> int:
        return 20 + int(3 / error * (1.5 if round(8 * math.log2(error)) % 2 else 1.0))

    for most in range(30, 300, 7):
        count, _ = counter(of)
        error = fitting(count, (0.0, 4.0), 10**9, most)
        assert of(error) <= most < of(2.0 ** ((round(8 * math.log2(error)) - 1) / 8))


def test_heights_that_are_the_least_doubles(tmp_path: Path) -> None:
    """Steps of the scale are errors of one or two such numbers, as are those of levels."""
    points = bumps(600)
    least = float(np.finfo(float).smallest_subnormal)
    points[:, 2] = np.random.default_rng(3).integers(0, 3, 600) * least
    tiles = distributed.triangulate(points, tmp_path / "least", tile_points=150)
    every = tiles.simplify(max_error=0).nsimplex
    for most in (100, every // 2, every - 1):
        found = tiles.simplify(max_triangles=most)
        assert found.nsimplex <= most
        assert all(simplifying.prove(tiles, found, 2 * least))
    assert all(simplifying.prove(tiles, tiles.simplify(max_error=least), least))


@pytest.mark.filterwarnings("error")
def test_heights_with_a_range_beyond_the_largest_double(tmp_path: Path) -> None:
    """Lines along cuts are as simple as those of the same heights in a smaller unit."""
    points = bumps(600)
    points[:, 2] *= 1.7 / np.abs(points[:, 2]).max() * np.random.default_rng(6).choice([-1, 1], 600)
    found = []
    for power in (1023, 100):
        given = np.column_stack((points[:, :2], np.ldexp(points[:, 2], power)))
        tiles = distributed.triangulate(given, tmp_path / str(power), tile_points=150)
        simple = tiles.simplify(max_error=math.ldexp(0.5, power))
        assert all(simplifying.prove(tiles, simple, math.ldexp(0.5, power)))
        found.append(simple)
    assert np.array_equal(found[0].points, found[1].points)
    assert np.array_equal(np.ldexp(found[0].z, -923), found[1].z)


def test_heights_at_the_end_of_doubles() -> None:
    huge = float(np.finfo(float).max)
    count, _ = counter(lambda error: 20 if error > 1e308 else 10**6)
    assert 1e308 < fitting(count, (-huge, huge), 10**6, 50) <= huge
