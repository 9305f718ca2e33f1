"""delone cluster: points in, labels out."""

import geopandas
import numpy as np
import pytest

from delone import cluster


@pytest.fixture
def towns(tmp_path):
    random = np.random.default_rng(3)
    points = np.concatenate([random.normal(x, 0.4, (30, 2)) for x in (0, 4, 9)]).round(3)
    frame = geopandas.GeoDataFrame(geometry=geopandas.points_from_xy(*points.T), crs="EPSG:28992")
    folder = tmp_path / "a folder"
    folder.mkdir()
    frame.to_file(folder / "towns.gpkg", driver="GPKG")
    return folder / "towns.gpkg", points


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".fgb", ".parquet"])
def test_labels_are_columns(suffix, towns, figures):
    source, points = towns
    path = source.with_name(f"labels of towns{suffix}")
    found = figures("cluster", source, "--min-cluster-size", "8", "-o", path)
    model = cluster.HDBSCAN(8).fit(points)
    assert (found["points"], found["clusters"]) == (90, model.labels_.max() + 1)
    assert (found["method"], found["noise"]) == ("hdbscan", (model.labels_ < 0).sum())
    frame = (geopandas.read_parquet if suffix == ".parquet" else geopandas.read_file)(path)
    assert frame.crs == "EPSG:28992"
    rows = {(p.x, p.y): row for row, p in enumerate(frame.geometry)}
    order = [rows[x, y] for x, y in points]
    assert np.array_equal(frame["label"].to_numpy()[order], model.labels_)
    assert np.allclose(frame["probability"].to_numpy()[order], model.probabilities_)


@pytest.mark.parametrize(
    ("options", "labels"),
    [
        ([], lambda p: cluster.HDBSCAN().fit_predict(p)),
        (
            ["--min-samples", "3", "--selection", "leaf", "--epsilon", "0.3"],
            lambda p: cluster.HDBSCAN(
                min_samples=3, cluster_selection_method="leaf", cluster_selection_epsilon=0.3
            ).fit_predict(p),
        ),
        (
            ["--single-cluster", "--min-cluster-size", "60"],
            lambda p: cluster.HDBSCAN(60, allow_single_cluster=True).fit_predict(p),
        ),
        (
            ["--method", "dbscan", "--eps", "0.5", "--min-samples", "4"],
            lambda p: cluster.DBSCAN(0.5, min_samples=4).fit_predict(p),
        ),
        (
            ["--method", "single-linkage", "--height", "1"],
            lambda p: cluster.single_linkage(p).labels(height=1),
        ),
        (
            ["--method", "single-linkage", "--n-clusters", "4"],
            lambda p: cluster.single_linkage(p).labels(n_clusters=4),
        ),
    ],
)
def test_each_method(options, labels, towns, figures, tmp_path):
    source, points = towns
    found = figures("cluster", source, *options, "-o", tmp_path / "labels.csv")
    expected = labels(points)
    assert found["clusters"] == expected.max() + 1
    table = np.genfromtxt(tmp_path / "labels.csv", delimiter=",", names=True)
    assert np.array_equal(table["label"], expected)
    assert np.array_equal(np.column_stack((table["x"], table["y"])), points)
    sizes = np.bincount(expected[expected >= 0])
    assert (found["largest"], found["smallest"]) == (sizes.max(), sizes.min())


def test_points_in_space(survey, figures, command, tmp_path):
    path = tmp_path / "labels.csv"
    options = ("--method", "dbscan", "--eps", "40", "-o", path)
    flat = figures("cluster", survey, *options)
    assert path.read_text().startswith("x,y,z,label,core\n")
    solid = figures("cluster", survey, "--3d", *options)
    assert path.read_text().startswith("x,y,z,label,core\n")
    assert solid["noise"] > flat["noise"]
    code, out, err = command("cluster", survey, *options)
    assert (code, err) == (0, "")
    assert "largest cluster" in out


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--method", "dbscan"], "needs --eps"),
        (["--method", "dbscan", "--eps", "-1"], "at least 0"),
        (["--method", "single-linkage"], "needs --height or --n-clusters"),
        (["--method", "single-linkage", "--height", "1", "--n-clusters", "2"], "not both"),
        (["--eps", "3"], "is for --method dbscan"),
        (["--height", "3"], "is for --method single-linkage"),
        (["--min-cluster-size", "1"], "at least 2"),
        (["-o", "labels.vtu"], "labels can only be written"),
    ],
)
def test_wrong_options_are_refused(options, words, towns, command):
    code, out, err = command("cluster", towns[0], *options)
    assert (code, out) == (2, "")
    assert words in err


def test_a_missing_file_is_an_error_of_the_input(command, tmp_path):
    code, _, err = command("cluster", tmp_path / "no.csv", "-o", tmp_path / "labels.csv")
    assert code == 3
    assert "no.csv" in err
    assert not (tmp_path / "labels.csv").exists()
