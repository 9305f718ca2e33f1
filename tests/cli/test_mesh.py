"""The command that meshes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("typer")
pytest.importorskip("geopandas")

from delone.cli import run
from delone.io import read_mesh

LAKE = [[(0, 0), (400, 30), (700, 300), (500, 600), (200, 500), (-50, 300), (0, 0)],
        [(200, 200), (300, 220), (280, 300), (200, 200)]]  # fmt: skip


@pytest.fixture
def lake(tmp_path: Path) -> Path:
    file = tmp_path / "lake.geojson"
    file.write_text(json.dumps({"type": "Polygon", "coordinates": LAKE}))
    return file


def test_a_lake_becomes_a_mesh(
    lake: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("meshio")
    pytest.importorskip("matplotlib")
    out, picture = tmp_path / "lake.msh", tmp_path / "lake.png"
    options = ["--min-angle", "30", "--max-area", "400", "--json"]
    assert (
        run(
            [
                "mesh",
                str(lake),
                *options,
                "-o",
                str(out),
                "-o",
                str(picture),
                "-o",
                str(out.with_suffix(".vtu")),
            ]
        )
        == 0
    )
    figures = json.loads(capsys.readouterr().out)
    assert figures["mesh"]["smallest_angle"] >= 30
    assert not figures["mesh"]["exhausted"]
    found = read_mesh(out.with_suffix(".vtu"))
    assert len(found.simplices) == figures["triangles"]["count"]
    a, b, c = (found.points[found.simplices[:, k]] for k in range(3))
    u, v = b - a, c - a
    areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
    assert areas.max() <= 400
    assert np.isclose(areas.sum(), figures["area"])
    assert picture.read_bytes()[:4] == b"\x89PNG"


def test_the_report_is_for_people(lake: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["mesh", str(lake), "--size", "30", "--smooth", "2", "--freeze-boundary"]) == 0
    text = capsys.readouterr().out
    assert "requested at least 30" in text
    assert "0 on segments" in text


def test_what_cannot_be_is_said(lake: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["mesh", str(lake), "--min-angle", "60"]) == 2
    assert run(["mesh", str(lake), "--max-area", "1e-9"]) == 4
    assert "--max-points" in capsys.readouterr().err
    assert run(["mesh", str(lake), "-o", "lake.xyz"]) == 5


def test_the_report_names_what_it_says(lake: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["mesh", str(lake)]) == 0
    lines = capsys.readouterr().out.splitlines()
    column = lines[1].index("points") + len("peak memory  ")
    for line in lines[1 : lines.index("")]:
        assert line[column - 1] == " " and line[column] != " "


def test_speeds_are_those_of_what_was_worked_on(
    lake: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["mesh", str(lake), "--max-area", "40", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    speeds = {each["name"]: each["seconds"] * each["points_per_second"] for each in found["stages"]}
    assert speeds["read"] == pytest.approx(9, rel=0.05)
    assert speeds["refine"] == pytest.approx(found["points"], rel=0.05)
    assert found["points"] > 1000


def test_second_order(lake: Path, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    for order, name in ((1, "triangle"), (2, "triangle6")):
        out = tmp_path / "lake.vtu"
        assert run(["mesh", str(lake), "--order", str(order), "-o", str(out), "--quiet"]) == 0
        assert name in meshio.read(out).cells_dict
