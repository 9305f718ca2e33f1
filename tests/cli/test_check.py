"""delone check: proof, refutation with the culprits, and files that hold no mesh."""

import meshio
import numpy as np
import pytest

from delone import Delaunay
from delone.io import write_mesh
from delone.io.registry import mesh_suffixes

SQUARE = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.0)])
KITE = np.array([(0, 0, 0), (4, -1, 0), (8, 0, 0), (4, 1, 0.0)])


def save(file, points, triangles):
    meshio.Mesh(points, [("triangle", np.array(triangles, dtype=np.int32))]).write(file)
    return file


@pytest.mark.parametrize("suffix", [".npz", ".vtu", ".ply", ".obj", ".stl", ".msh"])
def test_what_delone_writes_passes(tmp_path, figures, suffix):
    points = np.random.default_rng(2).integers(0, 50, (800, 2))
    distinct = np.unique(points, axis=0).astype(float)
    file = tmp_path / f"a{suffix}"
    write_mesh(file, Delaunay(distinct), z=np.arange(len(distinct)))
    found = figures("check", file, "--canonical")
    assert found["ok"] and found["delaunay"] and found["canonical"]
    assert found["faults"] == {}


def test_help_names_every_suffix_that_is_read(command):
    code, out, _ = command("check", "--help")
    assert code == 0
    for suffix in mesh_suffixes():
        assert suffix in out


def test_duplicates_are_no_fault(tmp_path, command):
    write_mesh(tmp_path / "a.npz", Delaunay([(0, 0), (1, 0), (0, 0), (0, 1)]))
    assert command("check", tmp_path / "a.npz")[0] == 0


def test_another_choice_among_cocircular_points(tmp_path, command, figures):
    file = save(tmp_path / "a.vtu", SQUARE, [(0, 1, 3), (1, 2, 3)])
    code, out, _ = command("check", file)
    assert code == 0
    assert "not the canonical one" in out
    assert figures("check", file, "--canonical", code=1)["faults"]["ties"]["count"] == 1
    file = save(tmp_path / "b.vtu", SQUARE, [(0, 1, 2), (0, 2, 3)])
    assert command("check", file, "--canonical")[0] == 0


def test_an_edge_that_is_not_delaunay(tmp_path, command, figures):
    file = save(tmp_path / "a.ply", KITE, [(0, 1, 2), (0, 2, 3)])
    code, out, err = command("check", file)
    assert (code, err) == (1, "")
    assert "not a Delaunay triangulation" in out
    assert "0-1" in out
    assert "(8.0, 0.0)" in out
    found = figures("check", file, code=1)
    assert not found["delaunay"]
    assert found["faults"]["delaunay"]["first"] == [[0, 1]]
    assert command("check", save(file, KITE, [(0, 1, 3), (1, 2, 3)]))[0] == 0


@pytest.mark.parametrize(
    ("triangles", "fault"),
    [
        ([(0, 2, 1), (0, 3, 2)], "orientation"),
        ([(0, 1, 2)], "missing"),
        ([(0, 1, 2), (0, 1, 2), (0, 2, 3)], "edges"),
    ],
)
def test_other_faults(tmp_path, figures, triangles, fault):
    file = save(tmp_path / "a.vtu", SQUARE, triangles)
    assert fault in figures("check", file, code=1)["faults"]


def test_npz_with_wrong_neighbours_is_refuted_not_crashed(tmp_path, figures):
    simplices = np.array([(0, 1, 2), (0, 2, 3)], dtype=np.int32)
    neighbors = np.array([(-1, 0, -1), (-1, -1, 1)], dtype=np.int32)
    np.savez(tmp_path / "a.npz", points=SQUARE[:, :2], simplices=simplices, neighbors=neighbors)
    assert "neighbors" in figures("check", tmp_path / "a.npz", code=1)["faults"]
    np.savez(tmp_path / "b.npz", points=SQUARE[:, :2], simplices=simplices)
    assert figures("check", tmp_path / "b.npz")["ok"]


def test_files_without_a_mesh(tmp_path, command):
    (tmp_path / "a.csv").write_text("1,2\n")
    assert command("check", tmp_path / "a.csv")[0] == 3
    assert command("check", tmp_path / "a.npz")[0] == 3
    points = SQUARE.copy()
    points[1, 0] = np.nan
    code, _, err = command("check", save(tmp_path / "nan.vtu", points, [(0, 1, 2)]))
    assert code == 3
    assert "first: 1" in err
