"""The code of the README is run, with small data in place of those that it takes for granted."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from delone import datasets

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
LIDAR = ROOT / "examples" / "data" / "ahn3_crop_100m.laz"
SHORE = [(0.0, 0.0), (900.0, 100.0), (1100.0, 700.0), (300.0, 900.0)]
ISLAND = [(400.0, 300.0), (600.0, 300.0), (500.0, 450.0)]


def blocks(language: str) -> list[str]:
    return [text for kind, text in BLOCK.findall(TEXT) if kind == language]


def polygon(*rings: list[tuple[float, float]]) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": [[*ring, ring[0]] for ring in rings]}


def names() -> dict[str, Any]:
    """What the blocks of Python use without defining it."""
    sites = 800 * datasets.uniform(50) + 50
    return {
        "polygons_and_lines": [
            polygon(SHORE, ISLAND),
            {"type": "LineString", "coordinates": [(-50, 200), (1200, 500)]},
        ],
        "lake": polygon(SHORE),
        "marked": [0, 1],
        "cloud": datasets.uniform(200, ndim=3),
        "sites": sites,
        "soundings": datasets.uniform(200),
        "depths": np.arange(200.0),
        "stations": [360.0, 180.0] * (datasets.uniform(50) - 0.5),
        "temperature": np.arange(50.0),
        "grid": np.array([[180.0, 0.0], [0.0, 90.0]]),
    }


@pytest.mark.parametrize("number", range(len(blocks("python"))))
def test_python_runs(number: int) -> None:
    pytest.importorskip("skfem")
    pytest.importorskip("meshio")
    exec(compile(blocks("python")[number], f"README.md, block {number}", "exec"), names())


def commands() -> list[str]:
    lines = [line for text in blocks("sh") for line in text.splitlines()]
    return [line for line in lines if line.startswith("delone ")]


def test_code_is_found() -> None:
    assert len(blocks("python")) >= 4
    assert {line.split()[1] for line in commands()} >= {"triangulate", "tile", "dem", "check"}


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files that the commands read."""
    monkeypatch.chdir(tmp_path)
    for name in ("coast", "lake"):
        Path(f"{name}.geojson").write_text(
            json.dumps({"type": "Feature", "properties": {}, "geometry": polygon(SHORE)})
        )
    for name in ("autzen", "survey"):
        shutil.copy(LIDAR, f"{name}.laz")
    return tmp_path


def test_commands_run(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the order of the page: the later ones read what the earlier ones wrote."""
    for extra in ("typer", "laspy", "meshio", "matplotlib", "rasterio", "dask"):
        pytest.importorskip(extra)
    from delone.cli import run

    inline = re.findall(r"`(delone [a-z]+ [^`]* -o [^`]+)`", TEXT)
    assert inline
    for line in (*commands(), *inline):
        code = run(shlex.split(line, comments=True)[1:])
        assert code == 0, (line, capsys.readouterr().err)
        for name in re.findall(r"-o (\S+)", line):
            assert (files / name).exists(), line
