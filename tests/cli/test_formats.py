"""Contours in every format of layers, read again by GDAL; parts of files are replaced together."""

from __future__ import annotations

import json

import numpy as np
import pytest

from delone.io import write_mesh, write_raster
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


@pytest.fixture
def missing(tmp_path):
    """A file of features without geometries, one with some of them, and points with heights."""
    square = {"type": "Polygon", "coordinates": [[[3, 3], [6, 3], [6, 6], [3, 6], [3, 3]]]}
    empty = {"type": "LineString", "coordinates": []}
    for name, geometries in {"none": [None, None], "some": [None, square, empty]}.items():
        features = [
            {"type": "Feature", "properties": {"n": 1}, "geometry": each} for each in geometries
        ]
        text = json.dumps({"type": "FeatureCollection", "features": features})
        (tmp_path / f"{name}.geojson").write_text(text)
    points = np.random.default_rng(2).random((40, 3)) * 4
    points[:4, :2] = [(0, 0), (9, 0), (9, 9), (0, 9)]
    np.savetxt(tmp_path / "p.csv", points, delimiter=",", header="x,y,z", comments="")
    return tmp_path


@pytest.mark.parametrize(
    ("call", "code"),
    [
        ("contours p.csv --interval 1 --breaklines", 0),
        ("contours p.csv --interval 1 --soft-breaklines", 0),
        ("contours p.csv --interval 1 --boundary", 2),
        ("contours p.csv --interval 1 --level", 2),
        ("dem p.csv -r 1 -o a.tif --breaklines", 0),
        ("volume p.csv 1 --region", 2),
        ("volume p.csv 1 --regions", 0),
        ("profile p.csv", 2),
        ("terrain p.csv -o site --profile", 2),
        ("terrain p.csv -o site --contours 1 --breaklines", 0),
        ("voronoi p.csv --clip", 3),
        ("mesh", 4),
        ("areal --planar some.geojson", 0),
    ],
)
def test_features_without_a_geometry_are_noted(missing, command, monkeypatch, call, code):
    monkeypatch.chdir(missing)
    name, *others = call.split()
    found, _, err = command(name, *others, "none.geojson")
    assert found == code, err
    assert "note: none.geojson: 2 of 2 features have no geometry\n" in err
    # What is wrong is said in the words of the command.
    assert "GeometrySet" not in err and "geometry=" not in err
    found, _, err = command(name, *others, "some.geojson", "--quiet")
    assert "note: " not in err
    found, _, err = command(name, *others, "some.geojson")
    assert "note: some.geojson: 2 of 3 features have no geometry\n" in err


def test_points_without_a_geometry_are_refused(missing, command, monkeypatch):
    monkeypatch.chdir(missing)
    for call in ("triangulate", "hull", "graph", "info", "explore"):
        code, _, err = command(call, "none.geojson")
        assert code == 3
        assert err == (
            "delone: none.geojson: feature 0 has no geometry; points are required. 2 of 2 "
            "features are not points\n"
        )
    code, _, err = command("triangulate", "some.geojson", "--outline")
    assert code == 0
    assert "note: some.geojson: 2 of 3 features have no geometry\n" in err


@pytest.mark.parametrize(
    ("call", "advice"),
    [
        ("contours two.gpkg --interval 1", "choose one (--layer): a, b"),
        ("contours p.csv --interval 1 --breaklines two.gpkg", "only one can be read: a, b"),
        ("contours p.csv --interval 1 --boundary two.gpkg", "only one can be read: a, b"),
        ("contours p.csv --interval 1 --level two.gpkg", "only one can be read: a, b"),
        ("profile p.csv two.gpkg", "only one can be read: a, b"),
        ("profile p.csv none.geojson --other two.gpkg", "choose one (--other-layer): a, b"),
        ("terrain p.csv -o site --profile two.gpkg", "only one can be read: a, b"),
        ("volume p.csv two.gpkg", "choose one (--other-layer): a, b"),
        ("volume p.csv 1 --region two.gpkg", "only one can be read: a, b"),
        ("volume p.csv 1 --regions two.gpkg", "choose one (--regions-layer): a, b"),
        ("voronoi p.csv --clip two.gpkg", "only one can be read: a, b"),
        ("voronoi two.gpkg", "choose one (--layer): a, b"),
        ("areal two.gpkg some.geojson", "choose one (--layer): a, b"),
        ("areal some.geojson two.gpkg", "choose one (--target-layer): a, b"),
        ("mesh two.gpkg", "choose one (--layer): a, b"),
        ("triangulate two.gpkg", "choose one (--layer): a, b"),
        ("tile two.gpkg -o tiles", "only one can be read: a, b"),
        ("difference two.tif 1", "two.tif has 2 bands: choose one with --layer, from 1"),
        ("difference two.tif two.tif --layer 1", None),
        ("contours two.tif --interval 1", "two.tif has 2 bands: choose one with --layer, from 1"),
    ],
)
def test_layers_are_chosen_by_options_that_exist(missing, command, monkeypatch, call, advice):
    monkeypatch.chdir(missing)
    table = geopandas.GeoDataFrame(geometry=[shapely.box(0, 0, 4, 4)], crs="EPSG:28992")
    for layer in "ab":
        table.to_file("two.gpkg", layer=layer)
    rasterio = pytest.importorskip("rasterio")
    size = {"width": 3, "height": 3, "count": 2, "dtype": "float64"}
    transform = rasterio.transform.from_origin(0, 3, 1, 1)
    with rasterio.open("two.tif", "w", driver="GTiff", transform=transform, **size) as file:
        file.write(np.random.default_rng(0).random((2, 3, 3)))
    code, _, err = command(*call.split())
    if advice is None:
        assert (code, err) == (0, "")
    else:
        assert (code, err.strip().endswith(advice)) == (3, True), err


def test_a_bad_outline_is_repaired_by_an_option(missing, command, monkeypatch):
    monkeypatch.chdir(missing)
    bow = {"type": "Polygon", "coordinates": [[[0, 0], [9, 9], [9, 0], [0, 9], [0, 0]]]}
    (missing / "fix=True.geojson").write_text(json.dumps(bow))
    code, _, err = command("voronoi", "p.csv", "--clip", "fix=True.geojson", "--planar")
    assert (code, err.endswith("; repair it, or pass --fix\n")) == (3, True), err
    assert "fix=True.geojson: " in err


@pytest.mark.parametrize(
    ("call", "what"),
    [
        ("contours p.csv --interval 1 --retriangulate", "--retriangulate is for LandXML and DXF"),
        ("contours p.csv --interval 1 --easting-first", "--easting-first is for LandXML files"),
        ("dem p.csv -r 1 -o a.tif --easting-first", "--easting-first is for LandXML files"),
        ("volume p.csv 1 --retriangulate", "--retriangulate is for LandXML and DXF"),
        ("contours p.csv --interval 1 --step 2", "--step is for rasters"),
        ("contours p.csv --interval 1 --window 0,0,1,1", "--window is for rasters and lidar"),
        ("contours p.xml --interval 1 --crossing min", "--crossing changes nothing"),
        ("contours p.xml --interval 1 --crossing maybe", "--crossing must be one of"),
        ("difference p.tif 1 --snap 1", "--snap is for surfaces, and 1 is a height"),
        ("difference p.tif 1 --surface", "--surface is for rasters, and this is a height"),
        ("difference p.tif p.csv --surface", "--surface is for rasters, and this is a surface"),
        ("difference p.tif p.tif --max-edge 1", "and p.tif is a raster: give --surface as well"),
        ("difference p.tif p.tif --breaklines some.geojson", "--breaklines is for surfaces"),
        ("difference p.tif p.tif --surface --easting-first", "--easting-first is for LandXML"),
        ("crossval p.csv --seed 3", "--seed is for random --folds"),
        ("crossval p.csv --method linear --gradients global", "--gradients is for clough-tocher"),
        ("voronoi p.csv --clip box --fix", "--fix is for outlines in files, not for --clip box"),
        ("voronoi p.csv --clip 0,0,1,1 --fix", "--fix is for outlines in files"),
        ("triangulate p.csv --edges", "--edges is for the files of --output"),
        ("sphere p.csv --edges", "--edges is for the files of --output"),
    ],
)
def test_options_without_effect_are_refused(missing, command, monkeypatch, call, what):
    monkeypatch.chdir(missing)
    points = np.loadtxt("p.csv", delimiter=",", skiprows=1)
    tin = TIN.from_points(points, units="m")
    write_mesh("p.xml", tin)
    write_raster("p.tif", tin.raster(resolution=1))
    before = sorted(path.name for path in missing.iterdir())
    code, _, err = command(*call.split())
    assert (code, what in err) == (2, True), err
    assert sorted(path.name for path in missing.iterdir()) == before
