"""The command that classifies lidar points: what it writes, and what it leaves alone."""

import json

import laspy
import numpy as np
import pytest


@pytest.fixture
def lidar(tmp_path):
    """A level square with a house, a low error, points of noise and one that is withheld."""
    x, y = (each.ravel() for each in np.meshgrid(np.arange(40.0), np.arange(40.0)))
    z = np.where((abs(x - 20) < 6) & (abs(y - 20) < 6), 5.0, 0.0)
    z[3], z[5], z[7] = -4, -8, 60
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = [0.01] * 3, [0] * 3
    header.add_extra_dim(laspy.ExtraBytesParams("quality", "uint16"))
    file = laspy.LasData(header)
    file.x, file.y, file.z = x, y, z
    file.classification = np.where(z > 1, 6, 0)
    file.classification[0], file.classification[5], file.classification[7] = 17, 7, 18
    file.classification[np.flatnonzero(z == 5)[0]] = 2
    file.withheld[9] = 1
    file.intensity, file.quality = np.arange(len(x)), np.arange(len(x))
    path = tmp_path / "in.laz"
    file.write(path)
    return path


@pytest.mark.parametrize("suffix", ["las", "laz"])
def test_classes_are_written_and_nothing_else_changes(lidar, suffix, command, tmp_path):
    path = tmp_path / f"out.{suffix}"
    code, _, err = command("ground", lidar, "-o", path)
    assert code == 0, err
    before, after = laspy.read(lidar), laspy.read(path)
    classes, old = np.array(after.classification), np.array(before.classification)
    assert classes[[3, 5, 7, 9]].tolist() == [7, 7, 18, 0]
    house = np.array(before.z) == 5
    assert classes[np.flatnonzero(house)].tolist() == [1] + [6] * (house.sum() - 1)
    rest = ~house & ~np.isin(np.arange(1600), [3, 5, 7, 9])
    assert (classes[rest] == 2).all()
    for name in before.point_format.dimension_names:
        if name != "classification":
            assert (np.array(before[name]) == np.array(after[name])).all(), name
    assert (old != classes).sum() > 1000
    assert path.read_bytes()[:4] == b"LASF"


def test_figures(lidar, command):
    code, out, _ = command("ground", lidar, "--json", "--cell", "20")
    found = json.loads(out)
    assert code == 0
    assert found["points_left_alone"] == 3
    assert found["low_outliers"] == 1
    assert found["ground"] == 1600 - 121 - 4
    assert found["converged"] == "true"
    assert found["outputs"] == []


def test_mistakes(lidar, command, tmp_path):
    assert command("ground", lidar, "-o", tmp_path / "a.csv")[0] == 2
    assert command("ground", lidar, "-o", lidar)[0] != 0
    code, _, err = command("ground", lidar, "--angle", "95")
    assert code != 0 and "angle must be between" in err
    assert command("ground", tmp_path / "none.laz")[0] == 3
