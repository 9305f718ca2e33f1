"""delone voronoi: sites and outline in, cells with attributes out."""

import geopandas
import numpy as np
import pytest
import shapely

OUTLINE = shapely.box(0, 0, 10, 6) - shapely.box(4, 2, 6, 4)


@pytest.fixture
def sites(tmp_path):
    points = np.random.default_rng(3).random((40, 2)) * [10, 6]
    frame = geopandas.GeoDataFrame(
        {"name": [f"site {i}" for i in range(40)], "size": np.arange(40.0) / 100},
        geometry=geopandas.points_from_xy(*points.T),
        crs="EPSG:4326",
    )
    frame.to_file(tmp_path / "sites.geojson", driver="GeoJSON", SIGNIFICANT_FIGURES=17)
    return tmp_path / "sites.geojson"


@pytest.fixture
def outline(tmp_path):
    frame = geopandas.GeoDataFrame(geometry=[OUTLINE], crs="EPSG:4326")
    frame.to_file(tmp_path / "outline.geojson", driver="GeoJSON")
    return tmp_path / "outline.geojson"


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".fgb", ".parquet"])
def test_cells_carry_the_attributes_of_their_sites(suffix, sites, outline, figures, tmp_path):
    path = tmp_path / f"cells{suffix}"
    found = figures("voronoi", sites, "--planar", "--clip", outline, "-o", path)
    assert found["sites"] == 40 and found["area"] == pytest.approx(56)
    assert found["outputs"] == [str(path)]
    read = geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file
    cells = read(path).sort_values("size").reset_index(drop=True)
    given = geopandas.read_file(sites)
    assert cells.crs == "EPSG:4326"
    assert cells["name"].tolist() == given["name"].tolist()
    assert shapely.area(cells.geometry.values).sum() == pytest.approx(56)
    inside = given.geometry.within(OUTLINE)
    assert cells.geometry[inside].covers(given.geometry[inside]).all()


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".fgb", ".parquet"])
def test_numbers_come_back_with_all_digits(suffix, figures, tmp_path):
    path = tmp_path / f"cells{suffix}"
    text = "x,y,w\n0.30000000000000004,0,0.19999999999999996\n4,0,1.0000000000000002\n0,3,1e-300\n"
    (tmp_path / "a.csv").write_text(text)
    figures("voronoi", tmp_path / "a.csv", "--attributes", "w", "--clip=-1,-1,5,4", "-o", path)
    cells = (geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file)(path)
    # FlatGeobuf has an order of its own.
    assert sorted(cells["w"].tolist()) == [1e-300, 0.19999999999999996, 1.0000000000000002]


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".fgb", ".parquet"])
def test_empty_cells_are_written(suffix, figures, tmp_path):
    # The third site is hidden by the first, the last one is far from the box.
    (tmp_path / "a.csv").write_text("x,y,w\n0,0,9\n4,0,0\n1,0,0\n90,90,0\n")
    path = tmp_path / f"cells{suffix}"
    figures("voronoi", tmp_path / "a.csv", "--clip=-2,-1,6,1", "--weights", "w", "-o", path)
    cells = (geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file)(path)
    assert cells["w"].tolist() == [9, 0, 0, 0]
    there = ~(cells.geometry.isna() | cells.geometry.is_empty)
    assert there.tolist() == [True, True, False, False]
    assert shapely.area(cells.geometry.values[there]).sum() == pytest.approx(16)


def test_boxes_and_weights(sites, figures, command):
    found = figures("voronoi", sites, "--planar", "--clip=-1,-1,11,7")
    assert found["area"] == 96
    heavy = figures("voronoi", sites, "--planar", "--clip=-1,-1,11,7", "--weights", "size")
    assert heavy["area"] == 96 and heavy["vertices"] <= found["vertices"]
    assert figures("voronoi", sites, "--planar")["area"] < 60
    code, out, _ = command("voronoi", sites)
    assert code == 0 and "ridges" in out


def test_text_files_carry_what_is_named(tmp_path, figures):
    (tmp_path / "a.csv").write_text("x,y,label\n0,0,5\n4,0,6\n0,4,7\n")
    path = tmp_path / "cells.gpkg"
    figures("voronoi", tmp_path / "a.csv", "--attributes", "label", "-o", path)
    assert geopandas.read_file(path)["label"].tolist() == [5, 6, 7]
    figures("voronoi", tmp_path / "a.csv", "-o", path)
    assert geopandas.read_file(path)["site"].tolist() == [0, 1, 2]


def test_what_is_wrong_is_said_in_one_line(sites, outline, command, tmp_path):
    bow = geopandas.GeoDataFrame(
        geometry=[shapely.Polygon([(0, 0), (9, 5), (9, 0), (0, 5)])], crs="EPSG:4326"
    )
    bow.to_file(tmp_path / "bow.geojson", driver="GeoJSON")
    code, _, err = command("voronoi", sites, "--clip", tmp_path / "bow.geojson")
    assert code == 3 and "Self-intersection[4.5 2.5]" in err
    assert command("voronoi", sites, "--clip", tmp_path / "bow.geojson", "--fix")[0] == 0
    code, _, err = command("voronoi", sites, "--clip", "nowhere.geojson")
    assert code == 3 and "nowhere.geojson" in err
    code, _, err = command("voronoi", sites, "--clip", sites)
    assert code == 3 and "polygons" in err
    other = geopandas.GeoDataFrame(geometry=[OUTLINE], crs="EPSG:28992")
    other.to_file(tmp_path / "other.gpkg")
    code, _, err = command("voronoi", sites, "--clip", tmp_path / "other.gpkg")
    assert code == 3 and "EPSG:28992" in err
    code, _, err = command("voronoi", sites, "-o", tmp_path / "cells.png")
    assert code == 2 and ".gpkg" in err
    assert command("voronoi", sites, "--clip", "0,0,0,1")[0] == 3
    assert not (tmp_path / "cells.png").exists()
