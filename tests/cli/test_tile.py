"""The commands ``tile`` and ``dem``."""

import json

import numpy as np
import pytest

from delone import Delaunay, distributed

pytest.importorskip("pyarrow")


def test_tiles_and_raster(survey, tmp_path, figures):
    said = figures("tile", survey, "-o", tmp_path / "tin", "--tile-points", 3000)
    assert (said["points"], said["duplicates"], said["tiles"]) == (10_000, 3, 4)
    tin = distributed.open(tmp_path / "tin")
    points = np.loadtxt(survey, delimiter=",", skiprows=1)
    assert tin.nsimplex == said["triangles"] == len(Delaunay(points[:, :2]).simplices)
    rasterio = pytest.importorskip("rasterio")
    said = figures("dem", tmp_path / "tin", "-r", "8", "-o", tmp_path / "dem.tif")
    assert said["outputs"] == [str(tmp_path / "dem.tif")]
    with rasterio.open(tmp_path / "dem.tif") as file:
        assert (file.width, file.height) == (128, 128)
        assert np.isfinite(file.read(1)).mean() > 0.95


def test_reports_are_for_people(survey, tmp_path, command):
    code, out, err = command("tile", survey, "-o", tmp_path / "tin", "--tile-points", 3000)
    assert (code, err) == (0, "")
    for word in ("tiles", "rounds", "foreign points", "peak memory", "10,000"):
        assert word in out
    code, out, err = command("dem", tmp_path / "tin", "-r", "8,16", "-o", tmp_path / "dem.tif")
    assert (code, err) == (0, "")
    assert "8.0 x 16.0" in out


def test_a_dry_run_does_nothing(survey, tmp_path, figures, command):
    said = figures("tile", survey, "-o", tmp_path / "tin", "--tile-points", 1000, "--dry-run")
    assert (said["points"], said["tiles"]) == (10_000, 10)
    assert said["worker_memory"] > 0 and said["disk"] > said["output"] > 0
    code, out, _ = command("tile", survey, "--dry-run")
    assert code == 0
    assert "required" in out
    assert not (tmp_path / "tin").exists()


def test_workers(survey, tmp_path, figures):
    said = figures("tile", survey, "-o", tmp_path / "tin", "--tile-points", 3000, "--workers", 2)
    assert said["tiles"] == 4


def test_a_scheduler(survey, tmp_path, figures, command):
    library = pytest.importorskip("distributed")
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": ":0"}
    with library.LocalCluster(protocol="tcp://", processes=False, **options) as cluster:
        said = figures(
            "tile", survey, "-o", tmp_path / "tin", "--scheduler", cluster.scheduler_address
        )
        assert said["tiles"] == 1


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ((), 2, "--output"),
        (("-o", "tin", "--workers", 0), 2, "--workers must be at least 1"),
        (("-o", "tin", "--nan", "keep"), 2, "nan must be"),
        (("-o", "tin", "--columns", "east,north"), 3, "east"),
        (("-o", "tin", "--classes", "ground"), 2, "--classes takes numbers"),
        (("-o", "tin", "--attributes", "gone"), 3, "gone"),
    ],
)
def test_wrong_arguments(survey, tmp_path, command, arguments, code, words):  # noqa: PLR0917
    arguments = [tmp_path / "tin" if word == "tin" else word for word in arguments]
    found, out, err = command("tile", survey, *arguments)
    assert (found, out) == (code, "")
    assert words in err
    assert err.count("\n") == 1
    assert not (tmp_path / "tin" / "manifest.json").exists()


def test_wrong_inputs_and_outputs(survey, tmp_path, command):
    code, _, err = command("tile", tmp_path / "gone.laz", "-o", tmp_path / "tin")
    assert (code, err.count("\n")) == (3, 1)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").touch()
    code, _, err = command("tile", survey, "-o", tmp_path / "full")
    assert code == 2
    assert "does not contain a run" in err
    code, _, err = command("dem", tmp_path / "full", "-r", "1", "-o", tmp_path / "dem.tif")
    assert code == 3
    assert "does not contain a tiled" in err
    code, _, err = command("dem", tmp_path / "full", "-r", "a", "-o", tmp_path / "dem.tif")
    assert code == 2


def test_progress_is_words():
    from delone.cli.tile import _words

    progress = distributed.Progress("proceed-0002", 3, 8, 64, 8, 3, 12_345, 2**30)
    said, more = _words(progress)
    assert said == "inserting, round 3"
    assert more == "64 tiles · 8 open · 12,345 foreign points · 1,024 MiB"


def test_json_is_json(survey, tmp_path, command):
    _, out, _ = command("tile", survey, "--dry-run", "--json")
    assert json.loads(out)["tasks"] > 0


def test_progress_has_room_in_eighty_columns(monkeypatch, capsys):
    from delone.cli.tile import _live

    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with _live(False) as tell:
        tell(distributed.Progress("deal", 123_456, 654_321))
        tell(distributed.Progress("proceed-0012", 12_345, 54_321, 54_321, 4_321, 12, 10**9, 2**37))
    err = capsys.readouterr().err
    for words in ("inserting, round 12", "12345/54321", "0:00:00"):
        assert words in err
    assert "54,321 tiles · 4,321 open · 1,000,000,000 foreign points · 131,072 MiB" in err
