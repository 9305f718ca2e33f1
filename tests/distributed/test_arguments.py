"""What is no argument of tiles is refused by name and type, before anything is written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import datasets, distributed
from delone.errors import DtypeError, InputError, ShapeError

if TYPE_CHECKING:
    from pathlib import Path

POINTS = np.column_stack([datasets.uniform(60), np.arange(60.0)])


@pytest.mark.parametrize(
    ("name", "value", "kind"),
    [
        ("tile_points", "x", DtypeError),
        ("tile_points", 2.5, DtypeError),
        ("tile_points", None, DtypeError),
        ("tile_points", True, DtypeError),
        ("executor", 5, InputError),
        ("executor", None, InputError),
        ("executor", ["serial"], InputError),
        ("executor", "threads", InputError),
        ("executor", np.zeros(3), InputError),
        ("resume", "no", DtypeError),
        ("resume", 1, DtypeError),
        ("resume", None, DtypeError),
        ("columns", 3, DtypeError),
        ("columns", "xy", DtypeError),
        ("columns", [1.5, 2], DtypeError),
        ("columns", [-1, 2], InputError),
        ("columns", ["x", "x"], InputError),
        ("classes", 2, DtypeError),
        ("classes", "2", DtypeError),
        ("classes", [2.5], DtypeError),
        ("classes", [-1], InputError),
        ("classes", [300], InputError),
        ("classes", [], InputError),
        ("attributes", 3, DtypeError),
        ("attributes", None, DtypeError),
        ("attributes", "intensity", DtypeError),
        ("attributes", [3], DtypeError),
        ("attributes", ["a", "a"], InputError),
        ("attributes", ["x"], InputError),
        ("attributes", ["owned"], InputError),
        ("nan", 3, InputError),
        ("nan", None, InputError),
        ("nan", ["raise"], InputError),
        ("progress", 3, DtypeError),
        ("progress", "bar", DtypeError),
    ],
)
def test_arguments_of_triangulate(name: str, value: Any, kind: Any, tmp_path: Path) -> None:
    with pytest.raises(kind, match="class" if name == "classes" else name):
        distributed.triangulate(POINTS, tmp_path / "tin", **{name: value})
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("output", [None, 5, b"tin", ["tin"]])
def test_outputs_that_are_no_path(output: Any) -> None:
    with pytest.raises(DtypeError, match="output must be"):
        distributed.triangulate(POINTS, output)
    with pytest.raises(DtypeError, match="output must be"):
        distributed.open(output)


@pytest.mark.parametrize(
    "source",
    [None, 5, {}, [], {"a.las"}, b"a.las", [1, 2, 3], ["a.las", 5], [[1, 2], [3]],
     np.zeros((4, 2, 2)), np.zeros((4, 4)), POINTS.astype(complex), POINTS.astype(str),
     np.ma.masked_array(POINTS, POINTS > 0.5), [[2**53 + 1, 0, 0]] * 3, POINTS > 0.5],
)  # fmt: skip
def test_sources_that_are_neither_files_nor_points(source: Any, tmp_path: Path) -> None:
    with pytest.raises((ShapeError, DtypeError)):
        distributed.triangulate(source, tmp_path / "tin")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("source", "options"),
    [
        (True, {}),
        (-5, {}),
        (1 << 70, {}),
        (1000, {"workers": 0}),
        (1000, {"workers": "two"}),
        (1000, {"tile_points": 2}),
        (1000, {"attributes": 3}),
        (1.5, {}),
    ],
)
def test_arguments_of_plan(source: Any, options: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        distributed.plan(source, **options)


def test_a_name_with_a_null_character(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="output contains a null character"):
        distributed.triangulate(POINTS, str(tmp_path / "a\0b"))


def test_a_plan_of_a_number_of_numpy() -> None:
    assert distributed.plan(np.int64(10**7)) == distributed.plan(10**7)


def test_arguments_of_what_is_read_back(tmp_path: Path) -> None:
    tin = distributed.triangulate(POINTS, tmp_path / "tin", tile_points=30)
    for number in ("x", 1.5, None, True):
        with pytest.raises(DtypeError, match="number"):
            tin.tile(number)  # type: ignore[arg-type]
    for value in (5, None, ["z"], "depth"):
        with pytest.raises(InputError, match="it has z"):
            tin.interpolate([0.5, 0.5], values=value)  # type: ignore[arg-type]
    for table in (5, None, ["triangles"], "edges"):
        with pytest.raises(InputError, match="table must be"):
            tin.to_dask_dataframe(table)  # type: ignore[arg-type]
    for path in (5, None, b"dem.tif"):
        with pytest.raises(DtypeError, match="out must be"):
            tin.to_raster(0.1, path)  # type: ignore[arg-type]
        with pytest.raises(DtypeError, match="folder must be"):
            tin.to_geoparquet(path)  # type: ignore[arg-type]
    for cell in ("x", None, -1, 0, float("nan"), [1, 2, 3], True):
        with pytest.raises(InputError, match="resolution"):
            tin.to_raster(cell, tmp_path / "dem.tif")  # type: ignore[arg-type]
    for asked in ("x", None, [1, 2, 3], [[1j, 2]]):
        with pytest.raises(InputError, match="xi"):
            tin.find_simplex(asked)  # type: ignore[arg-type]
    assert [p.name for p in tmp_path.iterdir()] == ["tin"]


def test_an_output_that_is_a_link_to_nothing(tmp_path: Path) -> None:
    link = tmp_path / "tin"
    link.symlink_to(tmp_path / "gone", target_is_directory=True)
    with pytest.raises(InputError, match="which does not exist: create that folder"):
        distributed.triangulate(POINTS, link, tile_points=50)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["tin"]
    (tmp_path / "gone").mkdir()
    assert distributed.triangulate(POINTS, link, tile_points=50).validate()
