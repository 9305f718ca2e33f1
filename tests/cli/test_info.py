"""delone info: what a file holds."""

import laspy
import numpy as np


def test_csv(survey, figures, command):
    found = figures("info", survey)
    assert found["points"] == 10000
    assert found["x"][0] < found["x"][1] < 1024
    assert found["z"] is not None
    assert found["not_finite"] == 0
    code, out, _ = command("info", survey)
    assert code == 0
    assert "10,000" in out


def test_nan_is_counted(tmp_path, figures):
    (tmp_path / "a.csv").write_text("1,2\nnan,3\n4,5\n")
    found = figures("info", tmp_path / "a.csv")
    assert found["not_finite"] == 1
    assert found["x"] == [1.0, 4.0]


def test_las(tmp_path, figures, command):
    las = laspy.LasData(laspy.LasHeader())
    las.x, las.y, las.z = np.arange(3.0), np.arange(3.0), np.arange(3.0)
    las.classification = [2, 2, 6]
    las.write(tmp_path / "a.laz")
    found = figures("info", tmp_path / "a.laz")
    assert found["classes"] == {"2": 2, "6": 1}
    assert found["point_format"] == las.header.point_format.id
    assert "2 ground: 2" in command("info", tmp_path / "a.laz")[1]


def test_points_in_space(tmp_path, figures, command):
    rows = [(0, 0, 0), (2, 4, 8), (1, 1, "nan"), (1, 3, 5)]
    (tmp_path / "a.xyz").write_text("\n".join(" ".join(map(str, row)) for row in rows))
    found = figures("info", "--3d", tmp_path / "a.xyz")
    assert (found["dimensions_of_points"], found["not_finite"]) == (3, 1)
    assert found["z"] == [0.0, 8.0]
    assert "0.0625 points per unit of volume" in command("info", "--3d", tmp_path / "a.xyz")[1]
    flat = figures("info", tmp_path / "a.xyz")
    assert (flat["dimensions_of_points"], flat["not_finite"]) == (2, 0)
    assert "0.5 points per unit of area" in command("info", tmp_path / "a.xyz")[1]
    (tmp_path / "b.csv").write_text("1,2\n3,4\n")
    assert command("info", "--3d", tmp_path / "b.csv")[0] != 0
