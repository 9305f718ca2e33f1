"""delone check --surface: surfaces that enclose a region, and those that do not."""

import meshio
import numpy as np
import pytest

import delone
from surfaces import box, joined


def save(file, surface):
    points, faces = surface
    meshio.Mesh(points, [("triangle", np.asarray(faces, dtype=np.int32))]).write(file)
    return file


@pytest.mark.parametrize("suffix", [".vtu", ".ply", ".obj", ".stl"])
def test_a_box_is_a_surface(tmp_path, command, figures, suffix):
    file = save(tmp_path / f"a{suffix}", box((0, 0, 0), (1, 2, 3)))
    code, out, err = command("check", "--surface", file)
    assert (code, err) == (0, "")
    assert "closed, oriented, manifold surface of 12 faces" in out
    found = figures("check", "--surface", file)
    assert (found["ok"], found["faces"], found["edges"], found["volume"]) == (True, 12, 18, 6.0)
    assert (found["components"], found["regions"], found["pairs"]["count"]) == (1, 1, 0)
    assert set(found["faults"]) <= {"duplicate_points"}


def test_faces_that_cross_are_named(tmp_path, command, figures):
    both = joined(box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 3)))
    file = save(tmp_path / "a.ply", both)
    code, out, _ = command("check", "--surface", file)
    assert code == 1 and "pairs of faces, crossing" in out
    found = figures("check", "--surface", file, code=1)
    check = delone.check_surface(*both)
    assert found["pairs"]["crossing"] == check.ncrossing
    assert found["pairs"]["first"][0]["faces"] == check.pairs[check.crossing][0].tolist()
    assert found["regions"] is None


def test_a_hole_is_named(tmp_path, figures):
    points, faces = box((0, 0, 0), (1, 1, 1))
    found = figures("check", "--surface", save(tmp_path / "a.ply", (points, faces[1:])), code=1)
    assert not found["closed"] and found["volume"] is None
    assert found["faults"]["boundary"] == {"count": 3, "first": [[0, 1], [0, 2], [1, 2]]}


def test_bad_input(tmp_path, command):
    file = save(tmp_path / "a.ply", box((0, 0, 0), (1, 1, 1)))
    assert command("check", "--surface", "--canonical", file)[0] == 2
    assert command("check", "--surface", tmp_path / "none.ply")[0] == 3
    points, faces = box((0, 0, 0), (1, 1, np.nan))
    code, _, err = command("check", "--surface", save(tmp_path / "nan.ply", (points, faces)))
    assert code == 4 and "NaN" in err
    mesh = delone.Delaunay(box((0, 0, 0), (1, 1, 1))[0])
    delone.io.write_mesh(tmp_path / "solid.vtu", mesh)
    code, _, err = command("check", "--surface", tmp_path / "solid.vtu")
    assert code == 2 and "not tetrahedra" in err
