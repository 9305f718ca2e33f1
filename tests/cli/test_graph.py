"""delone graph: points in, edges out."""

import geopandas
import numpy as np
import pytest

from delone import graphs


@pytest.fixture
def towns(tmp_path):
    points = np.random.default_rng(3).random((60, 2)).round(3)
    frame = geopandas.GeoDataFrame(geometry=geopandas.points_from_xy(*points.T), crs="EPSG:28992")
    frame.to_file(tmp_path / "towns.gpkg", driver="GPKG")
    return tmp_path / "towns.gpkg", points


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".fgb", ".parquet"])
def test_edges_are_lines(suffix, towns, figures, tmp_path):
    source, points = towns
    path = tmp_path / f"edges{suffix}"
    found = figures("graph", source, "--kind", "gabriel", "-o", path)
    expected = graphs.gabriel(points)
    assert (found["points"], found["edges"]) == (60, expected.nedges)
    assert (found["kind"], found["components"], found["isolated"]) == ("Gabriel", 1, 0)
    assert found["length"] == pytest.approx(expected.lengths.sum())
    frame = (geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file)(path)
    frame = frame.sort_values(["v0", "v1"])
    assert frame.crs == "EPSG:28992"
    assert np.array_equal(frame[["v0", "v1"]].to_numpy(), expected.edges)
    assert frame["length"].tolist() == expected.lengths.tolist()
    assert np.allclose(frame.geometry.length, expected.lengths)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ([], graphs.delaunay_graph),
        (["--kind", "relative-neighborhood"], graphs.relative_neighborhood),
        (["--kind", "urquhart"], graphs.urquhart),
        (["--kind", "spanning-tree"], graphs.minimum_spanning_tree),
        (["--kind", "influence", "--boundary", "open"], graphs.sphere_of_influence),
        (["--kind", "nearest", "-k", "3"], lambda p: graphs.nearest_neighbors(p, 3)),
        (
            ["--kind", "beta", "--beta", "1.5", "--region", "circle", "--boundary", "open"],
            lambda p: graphs.beta_skeleton(p, 1.5, kind="circle", boundary="open"),
        ),
        (
            ["--kind", "spanning-tree", "--max-length", "0.1"],
            lambda p: graphs.minimum_spanning_tree(p).prune(max_length=0.1),
        ),
        (
            ["--kind", "gabriel", "--percentile", "90"],
            lambda p: graphs.gabriel(p).prune(percentile=90),
        ),
    ],
)
def test_each_kind(options, expected, towns, figures, tmp_path):
    source, points = towns
    found = figures("graph", source, *options, "-o", tmp_path / "a.csv", "-o", tmp_path / "a.npz")
    graph = expected(points)
    assert found["components"] == graph.ncomponents
    rows = np.loadtxt(tmp_path / "a.csv", delimiter=",", skiprows=1)
    assert np.array_equal(rows[:, :2], graph.edges)
    assert np.array_equal(rows[:, 2], graph.lengths)
    again = graphs.Graph.load(tmp_path / "a.npz")
    assert np.array_equal(again.edges, graph.edges)
    assert again.kind == graph.kind == found["kind"]


def test_points_in_space_and_duplicates(survey, figures, command):
    flat = figures("graph", survey, "--kind", "spanning-tree")
    solid = figures("graph", survey, "--3d", "--kind", "spanning-tree")
    assert flat["duplicates"] == solid["duplicates"] == 3
    assert flat["edges"] == solid["edges"] == 9996
    assert solid["length"] > flat["length"]
    code, out, err = command("graph", survey)
    assert (code, err) == (0, "")
    assert "duplicates" in out
    assert "components" in out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--kind", "beta"], "needs --beta"),
        (["--kind", "beta", "--beta", "2.5"], "from 1 to 2"),
        (["--kind", "nearest"], "needs -k"),
        (["--kind", "nearest", "-k", "60"], "from 1 to"),
        (["--kind", "gabriel", "-k", "3"], "is for --kind nearest"),
        (["--kind", "spanning-tree", "--boundary", "open"], "is for --kind gabriel"),
        (["--max-length", "1", "--percentile", "2"], "give one of them"),
        (["--percentile", "0"], "at most 100"),
        (["-o", "edges.vtu"], "edges can only be written"),
    ],
)
def test_wrong_options_are_refused(options, words, towns, command):
    code, out, err = command("graph", towns[0], *options)
    assert (code, out) == (2, "")
    assert words in err


def test_a_missing_file_is_an_error_of_the_input(command, tmp_path):
    code, _, err = command("graph", tmp_path / "no.csv", "-o", tmp_path / "edges.csv")
    assert code == 3
    assert "no.csv" in err
    assert not (tmp_path / "edges.csv").exists()
