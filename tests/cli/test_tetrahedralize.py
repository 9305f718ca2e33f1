"""delone tetrahedralize: reports, files, options, and surfaces that cannot be filled."""

import meshio
import numpy as np
import pytest

import delone
import solids
from delone.io import read_mesh

CUBE = solids.box((0, 0, 0), (4, 4, 4))
SHELLS = solids.joined(CUBE, solids.box((1, 1, 1), (2, 2, 2)))


def save(path, points, faces):
    meshio.Mesh(points, [("triangle", faces.astype(np.int32))]).write(path)
    return path


def test_report_and_files(tmp_path, command):
    source = save(tmp_path / "part.stl", *solids.schoenhardt())
    code, out, err = command("tetrahedralize", source, "-o", tmp_path / "part.vtu")
    assert (code, err) == (0, "")
    for words in ("faces", "8", "7", "1 point added", "each input face is a face", "written"):
        assert words in out
    found = read_mesh(tmp_path / "part.vtu")
    wanted = delone.tetrahedralize(source)
    assert np.array_equal(found.simplices, wanted.simplices)
    assert np.array_equal(found.points, wanted.points)
    assert command("tetrahedralize", source, "--quiet")[:2] == (0, "")


def test_figures(tmp_path, figures):
    source = save(tmp_path / "shells.ply", *SHELLS)
    found = figures("tetrahedralize", source, "--region", "0.5,0.5,0.5,3", "--workers", "1")
    assert (found["faces"], found["added"], found["volume"]) == (24, 0, pytest.approx(64))
    assert set(found["regions"]) == {"-1", "3"}
    assert found["kept"]
    assert figures("tetrahedralize", source, "--hole", "1.5,1.25,1.5")["volume"] == pytest.approx(
        63
    )
    assert figures("tetrahedralize", source, "--inside", "parity")["volume"] == pytest.approx(63)


def test_bodies_that_overlap_are_cut_at_each_other(tmp_path, figures, command):
    source = save(tmp_path / "two.ply", *solids.joined(CUBE, solids.box((3, 3, 3), (5, 5, 5))))
    code, _, err = command("tetrahedralize", source)
    assert code != 0 and "cross" in err
    found = figures("tetrahedralize", source, "--imprint")
    assert len(found["regions"]) == 3 and found["volume"] == pytest.approx(64 + 8 - 1)
    assert found["imprint"]["parts"] > 24 and found["imprint"]["distance"] == 0
    assert "faces cut at each other" in found["report"]
    # A gap that is closed by the tolerance.
    apart = solids.joined(CUBE, solids.box((1, 1, 4.001), (2, 2, 5)))
    source = save(tmp_path / "apart.ply", *apart)
    assert figures("tetrahedralize", source, "--imprint")["imprint"]["distance"] == 0
    found = figures("tetrahedralize", source, "--imprint", "--tolerance", "0.01")
    assert found["imprint"]["distance"] == pytest.approx(0.001, rel=1e-3)
    code, _, err = command("tetrahedralize", source, "--tolerance", "0.01")
    assert code != 0 and "imprint" in err


def test_triangles_in_one_plane_are_cut_again(tmp_path, figures, command):
    corners = np.array([(-1, 3), *((k, k * k) for k in range(6))]) / 4
    points = np.concatenate([np.column_stack((corners, np.full(7, z))) for z in (0.0, 1)])
    # The ends are fans of their first corners.
    faces = [f for k in range(1, 6) for f in ((0, k + 1, k), (7, 7 + k, 8 + k))]
    faces += [
        f
        for k in range(7)
        for f in ((k, (k + 1) % 7, k + 7), ((k + 1) % 7, (k + 1) % 7 + 7, k + 7))
    ]
    source = save(tmp_path / "part.ply", points, np.array(faces))
    found = figures("tetrahedralize", source, "--boundary", "surface")
    assert not found["kept"] and found["recut"]["count"] > 0
    assert figures("tetrahedralize", source)["kept"]
    code, _, err = command("tetrahedralize", source, "--boundary", "edges")
    assert code == 2 and "surface" in err


def test_improved(tmp_path, figures):
    source = save(tmp_path / "part.ply", *solids.torus())
    found = figures("tetrahedralize", source, "--improve", "-o", tmp_path / "part.npz")
    gained = found["improvement"]["smallest_dihedral"]
    assert gained["after"] >= gained["before"]
    mesh = delone.TetMesh.load(tmp_path / "part.npz")
    assert len(mesh.input_faces) == found["faces"]
    assert bool(mesh.validate())


def test_touching_faces_are_listed(tmp_path, figures):
    both = solids.joined(CUBE, solids.box((1, 1, 4), (2, 2, 6)))
    found = figures("tetrahedralize", save(tmp_path / "part.ply", *both))
    assert not found["kept"]
    assert found["repeated"]["count"] == 2
    assert found["subdivided"]["count"] > 0


def test_surfaces_that_cannot_be_filled(tmp_path, command):
    points, faces = CUBE
    source = save(tmp_path / "open.ply", points, faces[1:])
    code, _, err = command("tetrahedralize", source, "-o", tmp_path / "open.vtu")
    assert code == 4
    assert f"{source}: the surface encloses nothing: 3 edges have only one face" in err
    assert "error." not in err
    assert not (tmp_path / "open.vtu").exists()
    crossing = solids.joined(CUBE, solids.box((3, 3, 3), (5, 5, 5)))
    code, _, err = command("tetrahedralize", save(tmp_path / "crossing.ply", *crossing))
    assert code == 4
    assert "cross" in err
    code, _, err = command(
        "tetrahedralize", save(tmp_path / "a.ply", *solids.schoenhardt()), "--max-points", "0"
    )
    assert code == 4


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--hole", "1,2"), "--hole takes 3 numbers with commas, got '1,2'"),
        (("--hole", "1,2,nan"), "--hole takes 3 numbers"),
        (("--region", "1,2,3"), "--region takes 4 numbers"),
        (("--region", "1,2,3,x"), "--region takes 4 numbers"),
        (("--hole", "9,9,9"), "--hole: 1 seed outside"),
        (("--inside", "odd"), "inside must be one of"),
        (("-o", "a.svg"), "cannot store tetrahedra"),
        (("-o", "a.su2", "--order", "2"), ".su2 files cannot store second-order elements"),
        (("-o", "a.vtu", "--order", "3"), "order must be 1 or 2"),
    ],
)
def test_options(tmp_path, command, options, words):
    code, _, err = command("tetrahedralize", save(tmp_path / "cube.ply", *CUBE), *options)
    assert code in (2, 5)
    assert words in err


def test_other_files(tmp_path, command):
    assert command("tetrahedralize", tmp_path / "none.stl")[0] == 3
    delone.Delaunay(CUBE[0]).save(tmp_path / "solid.npz")
    code, _, err = command("tetrahedralize", tmp_path / "solid.npz")
    assert code == 2
    assert "not tetrahedra" in err
    source = save(tmp_path / "cube.ply", *CUBE)
    code, _, err = command("tetrahedralize", source, "-o", source)
    assert code == 2
    assert "would replace the input" in err


def test_second_order(tmp_path, command):
    meshio = pytest.importorskip("meshio")
    source = save(tmp_path / "cube.ply", *CUBE)
    files = [tmp_path / name for name in ("a.vtu", "a.inp", "a.png")]
    outputs = [word for file in files for word in ("-o", file)]
    assert command("tetrahedralize", source, "--order", "2", *outputs, "--quiet")[0] == 0
    wanted = delone.tetrahedralize(source).to_meshio(order=2)
    for file in files[:2]:
        found = meshio.read(file)
        assert np.array_equal(found.points, wanted.points)
        assert np.array_equal(found.cells_dict["tetra10"], wanted.cells_dict["tetra10"])
    assert files[2].exists()


def test_sizes_and_shapes(tmp_path, command, figures):
    source = save(tmp_path / "cube.ply", *CUBE)
    found = figures(
        "tetrahedralize", source, "--boundary", "surface", "--size", "0.8", "-o", tmp_path / "a.vtu"
    )
    refinement = found["refinement"]
    assert refinement["too_large"]["count"] == 0
    assert refinement["largest_size_ratio"] <= 1
    assert found["improvement"]["goal"] == 20
    assert found["tetrahedra"] > 100
    volume = found["volume"]
    bounded = figures("tetrahedralize", source, "--boundary", "surface", "--max-volume", "0.1")
    assert bounded["tetrahedra"] >= volume / 0.1
    options = ("--radius-edge", "1.5", "--min-angle", "10")
    shaped = figures("tetrahedralize", source, *options)
    assert (shaped["refinement"]["radius_edge"], shaped["improvement"]["goal"]) == (1.5, 10)
    code, out, _ = command("tetrahedralize", source, "--boundary", "surface", "--size", "0.8")
    assert code == 0
    assert "larger than the size" in out and "none" in out
    code, _, err = command("tetrahedralize", source, "--size", "-1")
    assert code == 2 and "size must be above 0" in err
    code, _, err = command("tetrahedralize", source, "--radius-edge", "0.5")
    assert code == 2 and "--radius-edge must be at least 1, got 0.5" in err
    code, _, err = command(
        "tetrahedralize", source, "--boundary", "surface", "--size", "0.001", "--max-points", "99"
    )
    assert code == 4 and "more than --max-points" in err
