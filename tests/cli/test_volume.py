"""The command ``volume``: a row for each polygon of a layer, and units."""

from __future__ import annotations

import csv
import math

import numpy as np
import pytest

from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")

LOW = np.array([155_000.0, 463_000.0])
CORNERS = ((0, 0), 1), ((100, 0), 1), ((100, 100), 3), ((0, 100), 3)
POINTS = [(*(LOW + at), z) for at, z in CORNERS]


@pytest.fixture
def folder(tmp_path):
    path = tmp_path / "the höhe of it"
    path.mkdir()
    np.savetxt(path / "a b.csv", POINTS, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    geopandas.GeoDataFrame(
        {"name": ["north", "söuth", "nowhere"], "area": [1, 2, 3]},
        geometry=[shapely.box(*(LOW + a), *(LOW + b)) for a, b in ((20, 40), (90, 110))] + [None],
        crs=28992,
    ).to_file(path / "the lots.gpkg", layer="lots")
    return path


@pytest.mark.parametrize("suffix", [".csv", ".gpkg", ".geojson", ".fgb", ".parquet"])
def test_a_row_for_each_polygon(folder, command, suffix):
    out = folder / f"a table{suffix}"
    code, shown, notes = command(
        *("volume", folder / "a b.csv", 2, "--regions", folder / "the lots.gpkg", "-o", out),
        *("--crs", "EPSG:28992", "--units", "m"),
    )
    assert code == 0 and "the column 'area' of the layer is 'layer_area' in the table" in notes
    assert "1 region has no area in common with both surfaces, and a volume of 0: row 2" in notes
    assert "region söuth                  cut 90 m3, fill 0 m3" in shown
    assert "area 100 m2, 0.25 covered" in shown and "region nowhere" in shown
    ground = TIN.from_points(POINTS)
    lots = geopandas.read_file(folder / "the lots.gpkg")
    with pytest.warns(UserWarning, match="row 2"):
        found = ground.volumes_to(2.0, lots.geometry.tolist())
    if suffix == ".csv":
        rows = list(csv.DictReader(out.open(encoding="utf-8")))
        assert [float(row["cut"]) for row in rows] == found.cut.tolist()
        assert [row["name"] for row in rows] == ["north", "söuth", "nowhere"]
        assert [row["coverage"] for row in rows] == ["1.0", "0.25", ""]
        return
    read = geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file
    table = read(out)
    order = table.sort_values("layer_area")
    assert order.crs.to_epsg() == 28992 and order["name"].tolist() == lots["name"].tolist()
    assert order.net.tolist() == found.net.tolist()
    assert order.geometry.area.fillna(0).round(6).tolist() == [400, 400, 0]


def test_figures_have_units_and_each_row(folder, figures, command):
    call = ("volume", folder / "a b.csv", 2)
    code, shown, _ = command(*call)
    assert code == 0 and "cut            2500\n" in shown
    assert "unknown units  of heights: --units, of x and y: --crs" in shown
    code, shown, _ = command(*call, "--crs", "EPSG:28992", "--units", "ft")
    assert "cut          2500 ft m2\n" in shown and "area         10000 m2\n" in shown
    found = figures(*call, "--crs", "EPSG:7415")
    assert (found["volume_units"], found["area_units"]) == ("m3", "m2")
    assert found["cut"] == pytest.approx(2500, rel=1e-12)
    lots = folder / "one.gpkg"
    boxes = [shapely.box(*(LOW + 20), *(LOW + 40)), shapely.box(*(LOW + 90), *(LOW + 110))]
    geopandas.GeoSeries(boxes).to_file(lots)
    found = figures(*call, "--regions", lots)
    assert [row["coverage"] for row in found["rows"]] == [1, 0.25]
    assert found["regions"] == 2 and found["regions_not_covered_entirely"] == 1
    assert found["cut"] == math.fsum(row["cut"] for row in found["rows"]) > 0
    assert found["volume_units"] is None


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("-o", "x.csv"), "need --regions"),
        (("--regions-layer", "lots"), "need --regions"),
        (("--regions", "the lots.gpkg", "--region", "the lots.gpkg"), "give one"),
        (("--regions", "the lots.gpkg", "-o", "x.txt"), "only be written to .csv .gpkg"),
        (("--regions", "the lots.gpkg", "-o", "the lots.gpkg"), "would replace the input"),
        (("--regions", "the lots.gpkg", "--regions-layer", "x"), "has no layer 'x'"),
        (
            ("--regions", "the lots.gpkg", "--units", "furlong"),
            "units must be a unit of length (mm, cm",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(folder, command, monkeypatch, options, words):
    monkeypatch.chdir(folder)
    code, _, message = command("volume", "a b.csv", 2, *options)
    assert code != 0 and words in message


def test_lines_are_refused_with_their_feature(folder, command):
    lines = folder / "roads.geojson"
    shapes = [shapely.box(0, 0, 1, 1), shapely.LineString([(0, 0), (9, 9)])]
    geopandas.GeoSeries(shapes).to_file(lines)
    code, _, message = command("volume", folder / "a b.csv", 2, "--regions", lines)
    assert code != 0 and "regions, feature 1 is not a polygon but contains a LineString" in message


@pytest.mark.parametrize("suffix", [".csv", ".gpkg"])
def test_regions_without_columns(folder, figures, suffix):
    lot = shapely.box(*(LOW + 20), *(LOW + 40))
    geopandas.GeoDataFrame(geometry=[lot], crs=28992).to_file(folder / "plain.gpkg")
    call = ("volume", folder / "a b.csv", 2, "--crs", "EPSG:28992")
    figures(*call, "--regions", folder / "plain.gpkg", "-o", folder / f"v{suffix}")
    table = geopandas.read_file(folder / f"v{suffix}")
    assert len(table) == 1 and float(table["area"].iloc[0]) == pytest.approx(400)


@pytest.mark.parametrize("suffix", [".csv", ".npy"])
def test_rows_of_the_other_surface_name_its_file(folder, command, suffix):
    twice = np.array([(0.0, 0, 1), (1, 0, 2), (0, 1, 3), (0, 0, 9)])
    other = folder / f"other{suffix}"
    if suffix == ".npy":
        np.save(other, twice)
    else:
        np.savetxt(other, twice, delimiter=",", header="x,y,z", comments="")
    code, _, message = command("volume", folder / "a b.csv", other)
    assert code == 4 and "different heights at 1 place" in message
    assert str(other) in message and "a b.csv" not in message
    assert ("lines 5, 2 of" in message) == (suffix == ".csv")
