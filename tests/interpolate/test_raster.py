"""Rasters, and what huge ones get."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np
import pytest

from delone import Delaunay, datasets
from delone.errors import DtypeError, InputError, ShapeError
from delone.interpolate import Linear, grid
from delone.interpolate import raster as module

SQUARE = [(0, 0), (4, 0), (4, 2), (0, 2)]
VALUES = [0.0, 4.0, 6.0, 2.0]


def test_nodes_are_centres_of_cells() -> None:
    found = grid(SQUARE, VALUES, resolution=1)
    assert found.x.tolist() == [0.5, 1.5, 2.5, 3.5] and found.y.tolist() == [0.5, 1.5]
    assert found.values.tolist() == [[1, 2, 3, 4], [2, 3, 4, 5]]
    assert found.extent == (0, 4, 0, 2) and found.cell_size == (1, 1)
    assert grid(SQUARE, VALUES, shape=(4, 2)).x.tolist() == found.x.tolist()
    assert grid(SQUARE, VALUES, resolution=(2, 0.5)).values.shape == (4, 2)
    # No whole number of cells: one more, and no more than that for a rounding error.
    assert len(grid(SQUARE, VALUES, resolution=3).x) == 2
    assert len(grid(SQUARE, VALUES, bounds=(0, 0, 0.3, 0.3), resolution=0.1).x) == 3
    assert grid(SQUARE, VALUES, bounds=(1, 1, 3, 2), shape=(2, 1)).values.tolist() == [[3, 4]]
    assert grid(SQUARE, VALUES, x=[0, 4], y=[0, 2]).values.tolist() == [[0, 4], [2, 6]]


def test_blocks_do_not_show(monkeypatch: pytest.MonkeyPatch) -> None:
    points = datasets.uniform(200)
    values = np.column_stack((points[:, 0], points[:, 1])) * (1 + 2j)
    whole = grid(points, values, shape=(31, 17), method="sibson")
    told: list[float] = []
    monkeypatch.setattr(module, "_BLOCK", 70)
    parts = grid(points, values, shape=(31, 17), method="sibson", progress=told.append)
    np.testing.assert_array_equal(parts.values, whole.values)
    assert whole.values.shape == (17, 31, 2) and whole.values.dtype == np.complex128
    assert told == sorted(told) and told[-1] == 1.0 and len(told) == 9


def test_from_triangulations_and_interpolators() -> None:
    mesh = Delaunay(SQUARE)
    expected = grid(SQUARE, VALUES, resolution=1).values
    np.testing.assert_array_equal(grid(mesh, VALUES, resolution=1).values, expected)
    made = Linear(mesh, VALUES)
    np.testing.assert_array_equal(grid(made, resolution=1).values, expected)
    np.testing.assert_array_equal(
        grid(made, np.array(VALUES) * 2, resolution=1).values, 2 * expected
    )
    with pytest.raises(InputError, match="an existing interpolator"):
        grid(made, resolution=1, method="sibson")


def test_huge_rasters_are_refused_before_anything_is_computed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Linear, "_derived", lambda *_: pytest.fail("it was computed"))
    with pytest.raises(MemoryError, match=r"10,000,000 x 10,000,000 cells needs 800,000\.0 GB"):
        grid(SQUARE, VALUES, shape=(10**7, 10**7))
    with pytest.raises(MemoryError, match="choose larger cells"):
        grid(SQUARE, VALUES, resolution=1e-9)
    monkeypatch.setattr(module, "free_memory", lambda: (1 << 26) + 8 * 99)
    with pytest.raises(MemoryError):
        grid(SQUARE, VALUES, shape=(10, 10))


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"resolution": 1, "shape": (2, 2)},
        {"resolution": 0},
        {"resolution": np.nan},
        {"resolution": 1e-320},
        {"shape": (0, 3)},
        {"shape": (1, 2, 3)},
        {"shape": (1.5, 2)},
        {"x": [0, 1]},
        {"x": [0, 1], "y": [1, 0]},
        {"x": [0, 1], "y": [0, np.nan]},
        {"x": [0, 1], "y": [0, 1], "resolution": 1},
        {"resolution": 1, "bounds": (0, 0, 0, 1)},
        {"resolution": 1, "bounds": (0, 0, 1)},
        {"resolution": 1, "method": "spline"},
    ],
)
def test_bad_rasters_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        grid(SQUARE, VALUES, **options)


def test_nodes_have_one_axis() -> None:
    with pytest.raises(ShapeError, match="x must"):
        grid(SQUARE, VALUES, x=[[0, 1]], y=[0])


@pytest.mark.parametrize(
    "options",
    [
        {"resolution": "1"},
        {"resolution": True},
        {"resolution": (1, "2")},
        {"resolution": 1, "bounds": (0, 0, "a", 1)},
        {"shape": (2.5, 1)},
        {"x": ["a"], "y": [1]},
        {"x": [True], "y": [1]},
    ],
)
def test_what_is_no_number(options: dict[str, Any]) -> None:
    with pytest.raises(DtypeError):
        grid(SQUARE, VALUES, **options)


@pytest.mark.parametrize(
    "options",
    [
        {"resolution": (1, 2, 3)},
        {"resolution": [[1, 2]]},
        {"shape": 5},
        {"shape": "22"},
        {"shape": (1, 2, 3)},
        {"resolution": 1, "bounds": 5},
        {"resolution": 1, "bounds": (0, 1)},
    ],
)
def test_wrong_numbers_of_numbers(options: dict[str, Any]) -> None:
    with pytest.raises(ShapeError):
        grid(SQUARE, VALUES, **options)


def test_a_box_wider_than_any_double() -> None:
    corners = 1.7e308 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    found = grid(corners, [0.0, 1, 2, 1], shape=(4, 2))
    np.testing.assert_allclose(found.x / 1.7e308, [-0.75, -0.25, 0.25, 0.75])
    np.testing.assert_allclose(
        found.values, [[0.375, 0.625, 0.875, 1.125], [0.875, 1.125, 1.375, 1.625]]
    )
    assert np.isfinite(found.cell_size).all() and np.isfinite(found.extent).all()
    again = grid(corners, [0.0, 1, 2, 1], resolution=(0.85e308, 1.7e308))
    np.testing.assert_array_equal(again.x, found.x)
    with pytest.raises(InputError, match="range of doubles"):
        grid(corners, [0.0, 1, 2, 1], resolution=1.5e308)


def test_sites_in_space_have_no_raster() -> None:
    with pytest.raises(InputError, match="in 2-D"):
        grid(datasets.uniform(20, ndim=3), np.arange(20.0), resolution=0.5)


RAGGED: Any = [[1, 2], [3]]
MASKED: Any = np.ma.masked_array([1.0, 2.0], mask=[False, True])


@pytest.mark.parametrize(
    "options",
    [
        {"shape": RAGGED},
        {"resolution": RAGGED},
        {"resolution": 1, "bounds": RAGGED},
        {"resolution": 1, "bounds": [1, 2, [3, 4], 5]},
        {"x": RAGGED, "y": [0, 1]},
        {"x": [0, 1], "y": RAGGED},
        {"shape": MASKED},
        {"resolution": MASKED},
        {"x": MASKED, "y": [0, 1]},
        {"shape": {2, 3}},
        {"shape": {2: 3, 4: 5}},
    ],
)
def test_what_is_no_list_of_numbers(options: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        grid(SQUARE, VALUES, **options)


@pytest.mark.parametrize(
    "options",
    [
        {"resolution": 1e-300},
        {"resolution": 1, "bounds": (0, 0, 1e308, 1e308)},
        {"shape": (10**400, 3)},
        {"shape": (2**40, 2**40)},
    ],
)
@pytest.mark.parametrize("free", [None, 1 << 30])
def test_more_cells_than_any_memory_has(
    options: dict[str, Any], free: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "free_memory", lambda: free)
    with pytest.raises(MemoryError, match="choose larger cells") as caught:
        grid(SQUARE, VALUES, **options)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize("shift", [0.0, 85_000.0, 5.4e6])
@pytest.mark.parametrize("resolution", [0.01, 0.05, 0.1, 0.25])
def test_rasters_at_large_offsets_have_no_extra_row_and_decimal_nodes(shift, resolution):
    for cells in (1, 7, 29, 59):
        high = shift + cells * resolution
        corners = [(shift, shift), (high, shift), (high, high), (shift, high)]
        found = grid(corners, [0.0, 1, 1, 0], resolution=resolution)
        assert found.values.shape == (cells, cells)
        start, step = Decimal(repr(shift)), Decimal(repr(resolution))
        want = [float(start + step * (2 * k + 1) / 2) for k in range(cells)]
        assert found.x.tolist() == want and found.y.tolist() == want
        if cells > 1:
            assert found.cell_size == (resolution, resolution)
            end = float(start + step * cells)
            assert found.extent == (shift, end, shift, end)


def test_a_point_beyond_the_last_cell_has_a_cell():
    found = grid([(0, 0), (1.001, 0), (0, 1)], [0.0, 1, 2], resolution=0.1)
    assert found.values.shape == (10, 11)
