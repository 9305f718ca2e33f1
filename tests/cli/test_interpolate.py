"""delone interpolate and delone crossval."""

import numpy as np
import pytest

from delone.io import read_points


@pytest.fixture
def soundings(tmp_path):
    points = np.random.default_rng(1).random((300, 2))
    depth = 2 * points[:, 0] - points[:, 1]
    file = tmp_path / "soundings.csv"
    table = np.column_stack((points, depth, np.arange(300)))
    np.savetxt(file, table, delimiter=",", header="x,y,depth,id", comments="", fmt="%.17g")
    return file


def test_to_files(tmp_path, soundings, figures):
    pytest.importorskip("rasterio")
    outputs = [tmp_path / name for name in ("a.tif", "a.csv")]
    options = [option for path in outputs for option in ("-o", path)]
    found = figures(
        "interpolate",
        soundings,
        "--value",
        "depth",
        "--method",
        "sibson",
        "--grid",
        "50x40",
        *options,
    )
    assert (found["columns"], found["rows"], found["points"]) == (50, 40, 300)
    assert found["outputs"] == [str(path) for path in outputs]
    assert [path for path in outputs if not path.is_file()] == []
    raster = read_points(outputs[1], columns=["x", "y", "depth"])
    assert len(raster) == 2000 - found["without_value"]
    x, y = raster.points.T
    np.testing.assert_allclose(raster.z, 2 * x - y, atol=1e-12)


@pytest.mark.parametrize("method", ["linear", "nearest", "clough-tocher", "farin"])
def test_methods_and_the_report(soundings, command, method):
    code, out, err = command(
        "interpolate",
        soundings,
        "--method",
        method,
        "--resolution",
        "0.1",
        "--extrapolate",
        "nearest",
        "--bounds",
        "0,0,1,2",
    )
    assert (code, err) == (0, "")
    assert "10 x 20 = 200 cells" in out and method in out and "0 cells, outside" in out


def test_cells_far_from_all_points_have_no_value(tmp_path, soundings, figures, command):
    output = tmp_path / "near.csv"
    near = figures(
        "interpolate", soundings, "--grid", "50x40", "--max-distance", "0.03", "-o", output
    )
    whole = figures("interpolate", soundings, "--grid", "50x40")
    assert near["max_distance"] == 0.03 and whole["max_distance"] is None
    assert near["without_value"] > whole["without_value"] + 100
    cells = read_points(output).points
    sites = read_points(soundings).points
    steps = cells[:, None] - sites
    assert np.sqrt((steps**2).sum(axis=2)).min(axis=1).max() <= 0.03
    code, out, _ = command("interpolate", soundings, "--grid", "9x9", "--max-distance", "0.03")
    assert code == 0 and "or farther than 0.03 from any point" in out
    code, _, err = command("interpolate", soundings, "--grid", "9x9", "--max-distance", "-1")
    assert code == 2 and "--max-distance must be at least 0" in err


def test_cells_that_are_outside_by_less_than_a_tolerance_have_values(tmp_path, figures, command):
    corners = tmp_path / "corners.csv"
    corners.write_text("x,y,z\n0,0,1\n4,0,1\n0,4,1\n")
    where = ("interpolate", corners, "--method", "linear", "--grid", "4x4")
    assert figures(*where)["without_value"] == 6
    # The centers beyond the slanted side are .71, 1.4 and 2.1 away from it.
    assert figures(*where, "--tolerance", "1.5")["without_value"] == 1
    code, _, err = command(*where, "--tolerance", "-1")
    assert code == 2 and "tolerance must be at least 0" in err


def test_crossval(soundings, figures, command):
    found = figures("crossval", soundings, "--method", "nearest,sibson,farin")
    assert list(found["methods"]) == ["nearest", "sibson", "farin"]
    assert found["methods"]["sibson"]["rmse"] < 1e-12 < found["methods"]["nearest"]["rmse"]
    code, out, _ = command("crossval", soundings, "--folds", "5", "--value", "id")
    assert code == 0 and "one of 5 parts" in out and "rmse" in out


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ((), 2, "--grid"),
        (("--grid", "9x9", "--resolution", "1"), 2, "--grid"),
        (("--grid", "9"), 2, "columns and rows"),
        (("--grid", "axb"), 2, "numbers"),
        (("--resolution", "1,2,3"), 2, "one or two"),
        (("--resolution", "-1"), 2, "above 0"),
        (("--grid", "9x9", "--bounds", "1,2"), 2, "bounds"),
        (("--grid", "9x9", "--method", "kriging"), 2, "method must be"),
        (("--grid", "9x9", "--gradients", "local"), 2, "--gradients is for"),
        (("--grid", "9x9", "--value", "height"), 3, "height"),
        (("--grid", "9x9", "-o", "a.asc"), 5, "known are"),
        (("--grid", "9000000x9000000"), 7, "GB"),
        (("--grid", "9x9", "--bounds", "0,0,9,9", "--extrapolate", "raise"), 2, "outside"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(soundings, command, arguments, code, words):
    found, out, err = command("interpolate", soundings, *arguments)
    assert (found, out) == (code, "")
    assert words in err and err.count("\n") == 1


def test_without_values(tmp_path, command):
    file = tmp_path / "a.csv"
    file.write_text("x,y\n0,0\n1,0\n0,1\n")
    code, _, err = command("interpolate", file, "--grid", "3x3")
    assert code == 2 and "--value" in err


def test_faults_of_the_data_have_their_code_and_the_words_of_the_command(tmp_path, command):
    twice, holed = tmp_path / "twice.csv", tmp_path / "holed.csv"
    twice.write_text("x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,0,2.5\n")
    holed.write_text("x,y,z\n0,0,1\n1,0,2\n0,1,3\n1,1,nan\n")
    for name in (("interpolate", "--grid", "2x2"), ("crossval",)):
        code, _, err = command(name[0], twice, *name[1:])
        assert code == 4 and "rows 3 and 1; choose --duplicates mean, first, last, min, max" in err
        code, _, err = command(name[0], holed, *name[1:])
        assert code == 4 and "first: 3; choose --nan drop or --nan propagate" in err
        assert err.partition("; line")[0].count("3") == 1


def test_speeds_are_those_of_what_was_worked_on(soundings, figures):
    found = figures("interpolate", soundings, "--value", "depth", "--grid", "200x100")
    for stage in found["stages"]:
        worked = stage["seconds"] * stage["points_per_second"]
        right = 20_000 if stage["name"] == "interpolate" else 300
        assert worked == pytest.approx(right, rel=0.05)


@pytest.mark.parametrize(
    "given", [["sibson,nearest"], ["sibson", "nearest"], ["sibson", "nearest,sibson"]]
)
def test_all_methods_that_are_named_are_compared(soundings, figures, given):
    options = [part for names in given for part in ("--method", names)]
    found = figures("crossval", soundings, "--folds", "3", *options)
    assert list(found["methods"]) == ["sibson", "nearest"]
    plain = figures("crossval", soundings, "--folds", "3", "--method", "nearest")
    assert found["methods"]["nearest"] == plain["methods"]["nearest"]


def test_methods_that_there_are_not(soundings, command):
    code, _, err = command("crossval", soundings, "--method", "linear", "--method", "kriging")
    assert code == 2 and "must be one of 'linear'" in err and "kriging" in err
