"""The command ``simplify``: figures, files, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from delone import distributed, io
from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")


@pytest.fixture
def hill(tmp_path):
    x, y = np.meshgrid(np.arange(21.0), np.arange(21.0))
    xyz = np.column_stack((x.ravel(), y.ravel(), 10 - np.hypot(x - 10, y - 10).ravel()))
    path = tmp_path / "the hill.csv"
    np.savetxt(path, xyz, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
    return path


def test_figures_and_files_are_those_of_the_surface(hill, figures):
    out = hill.with_name("small.ply")
    found = figures("simplify", hill, "--max-error", 0.5, "--prove", "-o", out)
    tin = TIN.from_file(hill)
    small = tin.simplify(max_error=0.5)
    assert (found["points"], found["triangles"]) == (small.npoints, small.nsimplex)
    assert (found["points_before"], found["triangles_before"]) == (441, 800)
    assert found["error"] == tin.simplification(max_error=0.5).errors[-1]
    mesh = io.read_mesh(out)
    assert len(mesh.simplices) == small.nsimplex
    assert {"simplify", "prove"} <= {row["name"] for row in found["stages"]}


def test_triangles_instead_of_an_error(hill, figures):
    found = figures("simplify", hill, "--max-triangles", 20)
    assert found["triangles"] <= 20 and found["error"] > 0.5


def test_lines_stay_unless_told(hill, figures):
    line = hill.with_name("line.gpkg")
    geopandas.GeoSeries([shapely.LineString([(1, 1, 4), (19, 9, 4)])]).to_file(line)
    lined = "simplify", hill, "--max-error", 5, "--breaklines", line, "--crossing", "max"
    kept = figures(*lined, "--duplicates", "max")
    free = figures(*lined, "--duplicates", "max", "--keep", "boundary")
    assert kept["triangles"] > free["triangles"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "give one of --max-error and --max-triangles"),
        (["--max-error", "1", "--max-triangles", "9"], "give one of --max-error"),
        (["--max-error", "1", "--keep", "lines"], "keep must be"),
        (["--max-error", "-1"], "at least 0 and finite, got -1"),
        (["--max-triangles", "1"], "below the 2 triangles"),
        (["--max-error", "1", "-o", "small.docx"], "docx"),
    ],
)
def test_what_cannot_be_is_refused(hill, command, options, message):
    code, _, err = command("simplify", hill, *options)
    assert code != 0 and message in err


def test_tiles_take_the_place_of_a_file(hill, command, figures):
    pytest.importorskip("pyarrow")
    folder = hill.with_name("the hill.tin")
    assert command("tile", hill, "-o", folder, "--tile-points", 100)[0] == 0
    out = hill.with_name("small.ply")
    found = figures("simplify", folder, "--max-error", 0.5, "--prove", "-o", out)
    small = distributed.open(folder).simplify(max_error=0.5)
    assert (found["points"], found["triangles"]) == (small.npoints, small.nsimplex)
    assert (found["points_before"], found["triangles_before"]) == (441, 800)
    assert 0.1 < found["error"] <= 0.5
    assert len(io.read_mesh(out).simplices) == small.nsimplex
    # Without a proof, the error is the bound.
    assert figures("simplify", folder, "--max-error", 0.5, "--keep", "hard")["error"] == 0.5
    found = figures("simplify", folder, "--max-triangles", 100)
    small = distributed.open(folder).simplify(max_triangles=100)
    assert found["triangles"] == small.nsimplex <= 100
    assert np.array_equal(
        distributed.open(folder).simplify(max_error=found["error"]).xyz, small.xyz
    )
    for options, message in (
        (["--max-triangles", 9], "triangles of cuts between tiles and hull"),
        (["--max-error", 1, "--keep", "lines"], "keep must be"),
    ):
        code, _, err = command("simplify", folder, *options)
        assert code != 0 and message in err
