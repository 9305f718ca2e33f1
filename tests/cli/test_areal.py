"""delone areal: columns of one layer of polygons on another."""

import math

import geopandas
import numpy as np
import pandas
import pytest
import shapely

from delone import Overlaps


@pytest.fixture
def layers(tmp_path):
    """Districts with columns of each kind, and zones beyond their east."""
    boxes = [shapely.box(x, y, x + 2, y + 3) for y in (0, 3) for x in (0, 2, 4)]
    districts = geopandas.GeoDataFrame(
        {
            "people": [120, 60, 0, 30, 90, 600],
            "income": [30.0, 42.0, np.nan, 25.0, 31.0, 18.0],
            "use": ["field", "town", "town", "wood", None, "field"],
            "id": np.arange(6),
        },
        geometry=boxes,
        crs="EPSG:3035",
    )
    zones = geopandas.GeoDataFrame(
        {"id": ["a", "b", "c"], "people": [1, 2, 3]},
        geometry=[shapely.box(0, 0, 3, 6), shapely.box(3, 0, 9, 6), shapely.box(8, 8, 9, 9)],
        crs="EPSG:3035",
    )
    districts.to_file(tmp_path / "districts.gpkg")
    zones.to_file(tmp_path / "zones.gpkg")
    return tmp_path / "districts.gpkg", tmp_path / "zones.gpkg"


READ = {".gpkg": geopandas.read_file, ".parquet": geopandas.read_parquet, ".csv": pandas.read_csv}


@pytest.mark.parametrize("suffix", [".gpkg", ".parquet", ".csv"])
def test_columns_arrive(suffix, layers, command, tmp_path):
    path = tmp_path / f"out{suffix}"
    code, out, err = command(
        "areal", *layers, "--sum", "people", "--conservative", "income", "--majority", "use",
        "--skipna", "-o", path,
    )  # fmt: skip
    assert code == 0
    assert "the column 'people' of the target is 'target_people' in the output" in err
    assert "sum, total 900, of which 900 is on the target, 1 missing" in " ".join(out.split())
    found = READ[suffix](path)
    one, two = (geopandas.read_file(each) for each in layers)
    expected = Overlaps(one, two).transfer(
        one, {"people": "sum", "income": "conservative", "use": "majority"}, skipna=True
    )
    assert found["people"].tolist()[:2] == expected["people"].tolist()[:2] == [225, 675]
    assert math.isnan(found["people"][2])
    assert np.array_equal(found["income"], expected["income"], equal_nan=True)
    assert found["use"].tolist()[:2] == expected["use"].tolist()[:2]
    assert found["id"].tolist() == ["a", "b", "c"]
    assert found["target_people"].tolist() == [1, 2, 3]
    assert found["covered"].tolist() == [1, 0.5, 0]
    if suffix != ".csv":
        assert found.crs == "EPSG:3035"
        assert found.geometry.geom_equals(two.geometry).all()


def test_the_report(layers, figures):
    found = figures("areal", *layers, "--sum", "people", "--normalized", "income")
    assert found["source"] == {"cells": 6, "covered": 1.0, "outside": 0, "partly": 0,
                               "repeatedly": 0, "empty": 0}  # fmt: skip
    assert found["target"]["cells"] == 3
    assert found["target"]["covered"] == pytest.approx(36 / 55)
    assert (found["target"]["partly"], found["target"]["outside"]) == (1, 1)
    assert found["pairs"] == 8
    assert found["columns"] == [
        {"name": "people", "method": "sum", "missing": 1, "source_total": 900.0,
         "target_total": 900.0},
        # NaN spreads without --skipna.
        {"name": "income", "method": "normalized", "missing": 2},
    ]  # fmt: skip
    assert figures("areal", *layers)["columns"] == []
    least = figures("areal", *layers, "--sum", "people", "--min-fraction", "0.6")
    assert least["columns"][0]["missing"] == 2


@pytest.mark.parametrize("arguments", [("--sum", "people"), ("--majority", "use")])
def test_maps(arguments, layers, figures, tmp_path):
    for suffix in (".png", ".svg"):
        path = tmp_path / f"map{suffix}"
        assert figures("areal", *layers, *arguments, "-o", path)["outputs"] == [str(path)]
        assert path.stat().st_size > 5000


def test_reference_systems(layers, command, figures, tmp_path):
    one, two = layers
    # Of two projected systems, the target is transformed.
    zones = geopandas.read_file(two)
    moved = tmp_path / "moved.gpkg"
    zones.to_crs("EPSG:3034").to_file(moved)
    found = figures("areal", one, moved, "--sum", "people", "-q", "-o", tmp_path / "out.gpkg")
    assert found["columns"][0]["target_total"] == pytest.approx(900, rel=0.01)
    assert geopandas.read_file(tmp_path / "out.gpkg").crs == "EPSG:3034"
    # Longitudes and latitudes need an equal-area system, or the wish to do without.
    degrees = [tmp_path / "one.geojson", tmp_path / "two.geojson"]
    for source, path in zip(layers, degrees, strict=True):
        geopandas.read_file(source).set_crs("EPSG:4326", allow_override=True).to_file(path)
    code, _, err = command("areal", *degrees, "--sum", "people")
    assert code == 2
    assert "give --project with an equal-area system, such as EPSG:6933, or --planar" in err
    assert "note" not in err
    flat = figures("areal", *degrees, "--planar", "--sum", "people")
    assert flat["columns"][0]["target_total"] == pytest.approx(900, rel=1e-12)
    equal = figures(
        "areal",
        *degrees,
        "--project",
        "EPSG:6933",
        "--sum",
        "people",
        "-q",
        "-o",
        tmp_path / "o.geojson",
    )
    assert equal["columns"][0]["target_total"] == pytest.approx(900, rel=1e-9)
    assert geopandas.read_file(tmp_path / "o.geojson").crs == "EPSG:4326"
    code, _, err = command("areal", one, degrees[1], "--planar")
    assert (code, "--planar needs layers in one reference system" in err) == (2, True)
    # A file without one is in that of the other, of which a note tells.
    bare = tmp_path / "bare.gpkg"
    zones.set_crs(None, allow_override=True).to_file(bare)
    code, _, err = command("areal", one, bare, "--sum", "people")
    assert code == 0
    assert "note" in err
    code, _, err = command("areal", one, bare, "--project", "EPSG:6933")
    assert (code, "give --crs or --target-crs" in err) == (2, True)
    given = figures("areal", one, bare, "--target-crs", "EPSG:3035", "--sum", "people")
    assert given["columns"][0]["target_total"] == pytest.approx(900, rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("--sum", "age"), 2, "no column 'age'; its columns: people, income, use, id"),
        (("--sum", "use"), 2, "not numeric"),
        (("--sum", "people", "--majority", "people"), 2, "has two methods: sum and majority"),
        (("--sum", "people", "--min-fraction", "2"), 2, "--min-fraction must be from 0 to 1"),
        (("--sum", "covered"), 2, "the output has a column covered"),
        (("-o", "map.png"), 2, "a map needs a column"),
        (("-o", "out.tif"), 2, "polygons can only be written to"),
        (("--crs", "EPSG:0"), 2, "not a reference system"),
        (("--target-layer", "none"), 3, "none"),
    ],
)
def test_what_is_refused(arguments, code, message, layers, command):
    found, out, err = command("areal", *layers, *arguments)
    assert (found, out) == (code, "")
    assert message in err


def test_polygons_that_cross_and_inputs_that_are_outputs(layers, command, tmp_path):
    one, two = layers
    bow = tmp_path / "bow.gpkg"
    crossing = shapely.Polygon([(0, 0), (4, 4), (4, 0), (0, 4)])
    geopandas.GeoDataFrame(geometry=[crossing], crs="EPSG:3035").to_file(bow)
    code, _, err = command("areal", one, bow)
    assert code == 4
    assert "target: 1 polygon has sides that cross" in err
    code, _, err = command("areal", one, two, "-o", two)
    assert (code, "would replace the input" in err) == (2, True)
