"""The command and the workers: the same files, and the folder that they are started in."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from string import Template

import numpy as np
import pytest

from delone import distributed

VIRTUAL = Path(__file__).parents[1] / "corpus" / "hostile" / "virtual-dataset.txt"


def command(folder, *arguments):
    return subprocess.run(
        [sys.executable, "-m", "delone", *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("source", ["{file}", "/vsicurl/{url}/a.csv"])
@pytest.mark.parametrize(
    "arguments",
    [
        ("info", "evil.geojson"),
        ("triangulate", "evil.geojson", "-o", "out.gpkg"),
        ("mesh", "evil.geojson", "-o", "out.msh"),
        ("voronoi", "evil.geojson", "-o", "out.gpkg"),
        ("voronoi", "sites.csv", "--clip", "evil.geojson", "-o", "out.gpkg"),
        ("voronoi", "sites.csv", "--clip", "evil.vrt", "-o", "out.gpkg"),
        ("interpolate", "evil.geojson", "--value", "z", "--grid", "4x4", "-o", "out.csv"),
        ("tile", "evil.geojson", "-o", "out.tin"),
    ],
)
@pytest.mark.sampled(3)
def test_commands(tmp_path, canary, listener, arguments, source):
    source = source.format(file=canary.csv, url=listener.url)
    text = Template(VIRTUAL.read_text(encoding="utf-8")).substitute(source=source)
    for name in ("evil.geojson", "evil.vrt"):
        (tmp_path / name).write_text(text)
    (tmp_path / "sites.csv").write_text("x,y\n0,0\n4,0\n0,3\n4,4\n")
    canary.watch()
    done = command(tmp_path, *arguments)
    assert done.returncode == 3, done.stderr
    assert "Traceback" not in done.stderr
    assert not canary.was_opened
    assert listener.requests == []
    assert not list(tmp_path.glob("out.*"))


@pytest.mark.parametrize("module", ["pickle", "numpy", "delone", "struct"])
@pytest.mark.sampled(2)
def test_workers_import_nothing_from_the_working_folder(tmp_path, monkeypatch, module):
    mark = tmp_path / "mark"
    (tmp_path / f"{module}.py").write_text(f"open({str(mark)!r}, 'w').close()\nraise SystemExit")
    monkeypatch.chdir(tmp_path)
    points = np.random.default_rng(0).random((400, 2))
    tin = distributed.triangulate(points, tmp_path / "tin", tile_points=100, executor="processes")
    assert tin.validate()
    assert not mark.exists()
