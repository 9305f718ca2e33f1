"""Commands that write the points of a file again keep all their columns."""

import csv

import geopandas
import laspy
import numpy as np
import pyarrow.parquet
import pytest

from delone.io import read_points

DBSCAN = ("--method", "dbscan", "--eps", "2", "--min-samples", "2")
TEXT = """lon,id,lat,depth,name,size,empty
4.25,007,52,-3,"Smith, J",1.5,
4.5,012,52.5,-7,De "Kade",,
5,100,53,-8,plain,3,
"""


@pytest.fixture
def wells(tmp_path):
    path = tmp_path / "wells.csv"
    path.write_text(TEXT.replace('De "Kade"', '"De ""Kade"""'))
    return path


def test_words_and_numbers_of_text(wells):
    survey = read_points(wells, attributes="all")
    found = {name: values.tolist() for name, values in survey.attributes.items()}
    assert found["id"] == ["007", "012", "100"]
    assert found["name"] == ["Smith, J", 'De "Kade"', "plain"]
    assert found["empty"] == ["", "", ""]
    assert np.array_equal(found["size"], [1.5, np.nan, 3], equal_nan=True)
    assert list(found) == ["id", "name", "size", "empty"]


def test_decimal_commas_are_those_of_numbers_only(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("x;y;h;who\n1,5;2;3,25;a,b\n2;2,5;4;c\n")
    survey = read_points(path, columns=["x", "y"], attributes="all")
    assert survey.attributes["h"].tolist() == [3.25, 4]
    assert survey.attributes["who"].tolist() == ["a,b", "c"]


def test_names_that_repeat_get_numbers(tmp_path, command):
    path, out = tmp_path / "a.csv", tmp_path / "out.csv"
    path.write_text("x,y,a,a\n0,0,1,2\n1,0,3,4\n0,1,5,6\n")
    with pytest.warns(UserWarning, match="read as a_2, a_3"):
        assert list(read_points(path, attributes="all").attributes) == ["a_2", "a_3"]
    code, _, err = command("cluster", path, *DBSCAN, "-o", out)
    assert code == 0
    assert "2 columns without a name of its own" in err
    assert out.read_text().splitlines()[0] == "x,y,a_2,a_3,label,core"


def test_another_word_for_attributes_is_refused(wells):
    with pytest.raises(ValueError, match="'all' or names"):
        read_points(wells, attributes="name")


@pytest.mark.parametrize("suffix", [".csv", ".gpkg", ".geojson", ".fgb", ".parquet"])
def test_clusters_keep_all_columns(suffix, wells, figures, tmp_path):
    out = tmp_path / f"out{suffix}"
    found = figures("cluster", wells, *DBSCAN, "--planar", "-o", out)
    assert found["columns"] == ["id", "name", "size", "empty"]
    assert found["renamed"] == {}
    if suffix == ".csv":
        with out.open(newline="") as file:
            rows = list(csv.DictReader(file))
        assert list(rows[0])[:3] == ["lon", "lat", "depth"]
        assert [float(row["depth"]) for row in rows] == [-3, -7, -8]
    else:
        frame = (geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file)(out)
        assert frame.geometry.get_coordinates(include_z=True)["z"].tolist().count(-7) == 1
        rows = sorted(frame.to_dict("records"), key=lambda row: str(row["id"]))
    assert [row["id"] for row in rows] == ["007", "012", "100"]
    assert [row["name"] for row in rows] == ["Smith, J", 'De "Kade"', "plain"]
    assert {int(row["label"]) for row in rows} == {0}


def test_columns_with_the_names_of_results_are_renamed_and_told(tmp_path, command):
    path = tmp_path / "a.csv"
    path.write_text("x,y,label,FID,core,Core\n0,0,a,1,x,p\n1,0,b,2,y,q\n0,1,c,9,z,r\n")
    code, _, err = command("cluster", path, *DBSCAN, "-o", tmp_path / "a.gpkg")
    assert code == 0
    assert "'label' as 'input_label'" in err
    frame = geopandas.read_file(tmp_path / "a.gpkg")
    assert sorted(frame["input_label"]) == ["a", "b", "c"]
    assert sorted(frame["input_FID"]) == [1, 2, 9]
    assert set(frame["label"]) == {0}
    names = {name.casefold() for name in frame.columns}
    assert len(names) == len(frame.columns) == 7


def test_features_of_layers_keep_all_columns(tmp_path, figures):
    frame = geopandas.GeoDataFrame(
        {
            "word": ["a", None, "c"],
            "when": np.array(["2026-01-01", "2026-01-02", "2026-01-03"], dtype="M8[ms]"),
            "yes": [True, False, True],
            "big": [2**60 + 1, 2, 3],
        },
        geometry=geopandas.points_from_xy([0, 1, 0], [0, 0, 1]),
        crs="EPSG:28992",
    )
    frame.to_file(tmp_path / "in.gpkg")
    found = figures(
        "cluster", tmp_path / "in.gpkg", *DBSCAN, "-o", tmp_path / "o.gpkg", "-o",
        tmp_path / "o.csv",
    )  # fmt: skip
    assert found["columns"] == ["word", "when", "yes", "big"]
    again = geopandas.read_file(tmp_path / "o.gpkg")
    assert again.crs == "EPSG:28992"
    for name in ("yes", "big"):
        assert again[name].tolist() == frame[name].tolist()
    assert again["when"].dt.day.tolist() == [1, 2, 3]
    assert again["word"].isna().tolist() == [False, True, False]
    assert str(2**60 + 1) in (tmp_path / "o.csv").read_text()


def test_records_of_lidar_and_tables_keep_all_columns(tmp_path, figures):
    cloud = laspy.create(point_format=3, file_version="1.2")
    cloud.x, cloud.y, cloud.z = [0, 1, 0], [0, 0, 1], [5, 6, 7]
    cloud.intensity, cloud.red = [1, 2, 3], [7, 8, 9]
    cloud.add_extra_dim(laspy.ExtraBytesParams("normal", "3f4"))
    cloud["normal"] = np.arange(9).reshape(3, 3)
    cloud.write(tmp_path / "a.las")
    found = figures("cluster", tmp_path / "a.las", *DBSCAN, "-o", tmp_path / "o.parquet")
    assert {"intensity", "red", "return_number", "normal_0"} <= set(found["columns"])
    table = pyarrow.parquet.read_table(tmp_path / "o.parquet")
    assert table["red"].to_pylist() == [7, 8, 9]
    assert table["normal_2"].to_pylist() == [2, 5, 8]
    survey = read_points(tmp_path / "o.parquet", attributes="all")
    assert survey.attributes["intensity"].tolist() == [1, 2, 3]


def test_arrays_of_npz_with_a_value_per_row(tmp_path):
    points = np.eye(3)
    np.savez(tmp_path / "a.npz", points=points, mass=[1, 2, 3], other=[1, 2])
    assert list(read_points(tmp_path / "a.npz", attributes="all").attributes) == ["mass"]
    np.save(tmp_path / "a.npy", np.arange(15.0).reshape(3, 5))
    found = read_points(tmp_path / "a.npy", attributes="all").attributes
    assert {name: values.tolist() for name, values in found.items()} == {
        "3": [3, 8, 13],
        "4": [4, 9, 14],
    }


def test_attributes_and_markers_of_node_files(tmp_path):
    (tmp_path / "a.node").write_text("3 2 1 1\n1 0 0 5 7\n2 1 0 6 8\n3 0 1 7 9\n")
    found = read_points(tmp_path / "a.node", attributes="all").attributes
    assert found["attribute_0"].tolist() == [5, 6, 7]
    assert found["marker"].tolist() == [7, 8, 9]


def test_graphs_have_nodes_with_all_columns(wells, command, tmp_path):
    out, nodes = tmp_path / "out.gpkg", tmp_path / "nodes.csv"
    code, _, err = command("graph", wells, "--planar", "-o", out, "--nodes", nodes)
    assert (code, err) == (0, "")
    edges = geopandas.read_file(out, layer="edges")
    table = geopandas.read_file(out, layer="nodes").set_index("row")
    assert table.loc[0, "name"] == "Smith, J"
    for _, edge in edges.iterrows():
        ends = [(table.geometry[edge[v]].x, table.geometry[edge[v]].y) for v in ("v0", "v1")]
        assert sorted(ends) == sorted(point[:2] for point in edge.geometry.coords)
    with nodes.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["row"], row["id"]) for row in rows] == [("0", "007"), ("1", "012"), ("2", "100")]


def test_columns_that_no_file_has_are_told(wells, command, tmp_path):
    code, _, err = command("graph", wells, "--planar", "-o", tmp_path / "out.csv")
    assert code == 0
    assert "has 4 further columns, which edges do not have" in err
    code, _, err = command("graph", wells, "-o", wells.with_name("n.csv"), "--nodes", "n.vtu")
    assert code == 2
