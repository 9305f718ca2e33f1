"""Contours in every format of layers, read again by GDAL; parts of files are replaced together."""

from __future__ import annotations

import numpy as np
import pytest

from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")
pytest.importorskip("ezdxf")

LOW = np.array([155_000.0, 463_000.0, 0.0])
POINTS = np.array([(0, 0, 1), (100, 0, 1), (100, 100, 4.3), (0, 100, 4.3), (50, 40, 9)]) + LOW
CALL = ("contours", "a b.csv", "--interval", 1, "--crs", "EPSG:28992")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    path = tmp_path / "the höhe of it"
    path.mkdir()
    monkeypatch.chdir(path)
    np.savetxt("a b.csv", POINTS, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    return path


@pytest.mark.parametrize(
    "suffix", [".gpkg", ".geojson", ".fgb", ".shp", ".kml", ".sqlite", ".mif", ".parquet"]
)
@pytest.mark.parametrize("bands", [False, True])
def test_layers_are_read_again(folder, figures, suffix, bands):
    # Capital letters: the suffix decides in any case.
    out = folder / ("the Layer" + (suffix.upper() if suffix == ".kml" else suffix))
    found = figures(*CALL, *(["--bands"] if bands else []), "-o", out)
    tin = TIN.from_points(POINTS)
    made = (tin.bands if bands else tin.contours)(interval=1)
    wanted = made.to_geopandas(crs=28992)
    table = geopandas.read_parquet(out) if suffix == ".parquet" else geopandas.read_file(out)
    assert len(table) == len(wanted) == found["polygons" if bands else "lines"]
    column = "low" if bands else "level"
    assert sorted(table[column]) == sorted(wanted[column])
    if suffix == ".kml":
        assert table.crs.to_epsg() == 4326
        table = table.to_crs(28992)
    close = 0.01 if suffix == ".kml" else 1e-6
    for value in wanted[column].unique():
        one, other = (each[each[column] == value].union_all() for each in (table, wanted))
        assert shapely.hausdorff_distance(one, other) < close
    assert not [name for name in folder.iterdir() if name.name.startswith(".")]


def test_a_drawing_of_contours(folder, figures, command):
    ezdxf = pytest.importorskip("ezdxf")
    found = figures(*CALL, "-o", "a.dxf", "-o", "a.gpkg")
    lines = ezdxf.readfile("a.dxf").modelspace().query("POLYLINE")
    assert len(lines) == found["lines"] == len(geopandas.read_file("a.gpkg"))
    code, _, message = command(*CALL, "--bands", "-o", "b.dxf")
    assert code != 0 and "drawings contain contours, not the areas between" in message
    code, _, message = command(*CALL, "-o", "b.txt")
    assert code != 0 and "can only be written to .dxf .gpkg" in message


def test_labels_of_contours(folder, figures, command):
    call = (*CALL, "--label-length", 3)
    found = figures(*call, "--labels", "the labels.gpkg", "-o", "a.gpkg")
    table = geopandas.read_file("the labels.gpkg")
    assert len(table) == found["labels"] > 0 and table.crs.to_epsg() == 28992
    assert found["outputs"] == ["a.gpkg", "the labels.gpkg"]
    assert found["labels"] + found["lines_too_short_for_a_label"] == found["lines"]
    lines = geopandas.read_file("a.gpkg").union_all()
    assert shapely.distance(lines, table.geometry.values).max() < 1e-6
    for options, words in (
        ((), "--label-length needs --labels"),
        (("--labels", "b.gpkg", "--bands"), "--labels is for lines"),
        (("--index", 5, "--bands"), "--index is for lines"),
        (("--index", 0, "--bands"), "--index is for lines"),
        (("--labels", "b.txt"), "can only be written to"),
        (("--labels", "a b.csv"), "would replace the input"),
    ):
        code, _, message = command(*call, *options)
        assert code != 0 and words in message
    levels = [*CALL[:2], "--levels", 10]
    for options, words in (
        (("--base", 3), "--base is for --interval, not for --levels"),
        (("--index", 2), "--index is for --interval"),
    ):
        code, _, message = command(*levels, *options, "-o", "c.shp")
        assert code == 2 and words in message
    for length in ("-5", "0", "nan", "inf"):
        code, _, message = command(
            *CALL, "--label-length", length, "--labels", "c.gpkg", "-o", "c.shp"
        )
        assert code == 2 and "--label-length must be above 0 and finite" in message
        assert not (folder / "c.shp").exists()


def test_parts_of_a_shapefile_are_replaced_together(folder, figures, command):
    out = folder / "lines.shp"
    figures(*CALL, "-o", out)
    for stale in (".qix", ".sbn", ".sbx"):
        out.with_suffix(stale).write_text("an index of other lines")
    out.with_suffix(".txt").write_text("notes")
    assert out.with_suffix(".prj").exists()
    figures("contours", "a b.csv", "--interval", 4, "-o", out)
    assert sorted(each.suffix for each in folder.glob("lines.*")) == [
        ".cpg",
        ".dbf",
        ".shp",
        ".shx",
        ".txt",
    ]
    table = geopandas.read_file(out)
    assert table.crs is None and table.level.tolist() == [4.0, 8.0]
    before = {each.name: each.read_bytes() for each in folder.iterdir()}
    # A file that cannot be written leaves all others as they were.
    code, _, message = command("contours", "a b.csv", "--interval", 1, "-o", out, "-o", "a.kml")
    assert code != 0 and "KML has longitudes and latitudes" in message
    assert {each.name: each.read_bytes() for each in folder.iterdir()} == before


def test_long_names_of_columns_are_shortened_with_a_note(folder, command):
    boxes = [shapely.box(155_010, 463_010, 155_040, 463_040)]
    lots = {"name_of_the_lot_a": ["x"], "name_of_the_lot_b": ["y"]}
    geopandas.GeoDataFrame(lots, geometry=boxes, crs=28992).to_file("lots.gpkg")
    code, _, notes = command(
        *("volume", "a b.csv", 2, "--crs", "EPSG:28992", "--regions", "lots.gpkg"),
        *("-o", "v.shp"),
    )
    assert code == 0 and "the column 'region_area' is written as 'region_are'" in notes
    table = geopandas.read_file("v.shp")
    assert table[["name_of_th", "name_of_t2"]].values.tolist() == [["x", "y"]]
