"""Contours written to GeoPackages from arrays, compared with what geopandas writes."""

from __future__ import annotations

import sqlite3
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone.cli.tables import write_table
from delone.cli.terrain import write_contours
from delone.errors import BudgetExceededError
from delone.io import lines
from delone.terrain import TIN

pyogrio = pytest.importorskip("pyogrio")
pytest.importorskip("geopandas")
pytest.importorskip("pyarrow")

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from delone.terrain import Contours

SYSTEMS = [
    None,
    "EPSG:28992",
    "EPSG:28992+5709",
    "+proj=lcc +lat_1=43 +lat_2=45 +lat_0=41 +lon_0=-120 +units=ft",
]


def contours(seed: int, *, crs: str | None = None, **how: Any) -> Contours:
    """Return contours of random points."""
    points = np.random.default_rng(seed).random((600, 3)) * [100, 100, 10]
    return TIN.from_points(points, crs=crs).contours(**(how or {"interval": 0.7}))


def content(path: Path) -> dict[str, list[Any]]:
    """Return all tables of a GeoPackage, without the time of writing, and the schema."""
    with sqlite3.connect(path) as file:
        schema = list(file.execute("select name, sql from sqlite_master order by name"))
        names = [name for name, sql in schema if (sql or "").startswith("CREATE TABLE")]
        # The order of the nodes of an index does not matter.
        names = [name for name in names if not name.startswith("rtree_")]
        found = {name: list(file.execute(f'select * from "{name}"')) for name in names}
    found["gpkg_contents"] = [(*row[:4], *row[5:]) for row in found["gpkg_contents"]]
    return found | {"schema": schema}


@pytest.mark.parametrize("crs", SYSTEMS)
def test_same_as_geopandas(tmp_path: Path, crs: str | None) -> None:
    drawn = contours(3, crs=crs)
    write_contours(tmp_path / "new.gpkg", [drawn], "contours")
    write_table(drawn.to_geopandas(), tmp_path / "old.gpkg", layer="contours")
    new = content(tmp_path / "new.gpkg")
    assert new == content(tmp_path / "old.gpkg")
    assert len(new["contours"]) == len(drawn) > 100


@pytest.mark.parametrize("block", [1, 2, 7, 100, 10_000])
def test_blocks_do_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, block: int) -> None:
    drawn = contours(4)
    write_contours(tmp_path / "whole.gpkg", [drawn], "contours")
    monkeypatch.setattr(lines, "_BLOCK", block)
    write_contours(tmp_path / "blocks.gpkg", [drawn], "contours")
    assert content(tmp_path / "blocks.gpkg") == content(tmp_path / "whole.gpkg")


def test_parts_are_one_layer(tmp_path: Path) -> None:
    levels = [[1.0, 2.0], [3.0], [], [4.5]]
    parts = [contours(5, levels=some) for some in levels]
    write_contours(tmp_path / "parts.gpkg", parts, "contours")
    write_contours(tmp_path / "whole.gpkg", [contours(5, levels=[1.0, 2.0, 3.0, 4.5])], "contours")
    assert content(tmp_path / "parts.gpkg") == content(tmp_path / "whole.gpkg")


def test_no_lines(tmp_path: Path) -> None:
    write_contours(tmp_path / "none.gpkg", [contours(6, levels=[99.0])], "contours")
    facts = pyogrio.read_info(tmp_path / "none.gpkg")
    assert (facts["features"], facts["geometry_type"]) == (0, "LineString Z")


@pytest.mark.parametrize("error", [BudgetExceededError("too many"), KeyboardInterrupt()])
def test_errors_of_parts_remain(tmp_path: Path, error: BaseException) -> None:
    def parts() -> Iterator[Contours]:
        yield contours(7)
        raise error

    with pytest.raises(type(error)) as caught:
        write_contours(tmp_path / "lines.gpkg", parts(), "contours")
    assert caught.value is error


def test_settings_of_gdal_are_restored(tmp_path: Path) -> None:
    name = "OGR_SQLITE_SYNCHRONOUS"
    pyogrio.set_gdal_config_options({name: "FULL"})
    try:
        write_contours(tmp_path / "lines.gpkg", [contours(8)], "contours")
        assert pyogrio.get_gdal_config_option(name) == "FULL"
    finally:
        pyogrio.set_gdal_config_options({name: None})
