"""Points in space on the command line."""

import numpy as np
import pytest

from delone import Delaunay, datasets, improve
from delone.io import read_mesh, write_mesh


def cloud(n=60):
    return datasets.GENERATORS3["uniform"](n, seed=6)


def ply(path, points, faces=""):
    rows = "\n".join(" ".join(map(repr, row)) for row in points.tolist())
    head = f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    if faces:
        head += f"element face {faces.count(chr(10)) + 1}\n"
        head += "property list uchar int vertex_indices\n"
    path.write_text(f"{head}end_header\n{rows}\n{faces}\n")
    return path


def xyz(path, points):
    np.savetxt(path, points, fmt="%.17g")
    return path


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".npz"])
def test_a_cloud_becomes_tetrahedra(suffix, tmp_path, command, figures):
    points = cloud()
    source, target = ply(tmp_path / "cloud.ply", points), tmp_path / f"mesh{suffix}"
    found = figures("triangulate", source, "--3d", "-o", target)
    mesh = Delaunay(points)
    assert found["tetrahedra"] == {"count": mesh.nsimplex, "expected": mesh.nsimplex}
    assert found["volume"] == pytest.approx(mesh.volumes.sum())
    kept = read_mesh(target)
    assert (kept.points == points).all()
    assert (kept.simplices == mesh.simplices).all()
    code, out, err = command("check", "--canonical", target)
    assert (code, err) == (0, "")
    assert "tetrahedra" in out


def test_clouds_are_said_to_be_in_space(tmp_path, command):
    source = ply(tmp_path / "cloud.ply", cloud())
    code, out, err = command("triangulate", source)
    assert code == 0 and "tetrahedra" in out
    assert err == (
        f"delone: note: {source}: three columns: 3-D tetrahedra; --2d triangulates the surface\n"
    )
    for told in (["--3d"], ["--2d"], ["--quiet"]):
        assert command("triangulate", source, *told)[::2] == (0, "")


def test_heights_stay_heights_unless_space_is_wanted(tmp_path, command, figures):
    source = xyz(tmp_path / "survey.xyz", cloud())
    assert "triangles" in figures("triangulate", source)
    code, out, _ = command("triangulate", source, "--3d")
    assert code == 0
    assert "= n - edges + faces - 1" in out


def test_ply_files_with_faces_and_wishes_for_the_plane(tmp_path, figures):
    surface = ply(tmp_path / "surface.ply", cloud(4), faces="3 0 1 2\n3 1 2 3")
    assert "triangles" in figures("triangulate", surface)
    assert "tetrahedra" in figures("triangulate", surface, "--3d")
    assert "triangles" in figures("triangulate", ply(tmp_path / "a.ply", cloud(9)), "--2d")


@pytest.mark.parametrize("name", ["triangulate", "info"])
@pytest.mark.parametrize("told", [["--3d", "--2d"], ["--2d", "--3d"]])
def test_two_answers_are_refused(tmp_path, command, name, told):
    code, out, err = command(name, xyz(tmp_path / "a.xyz", cloud()), *told)
    assert (code, out) == (2, "")
    assert "--3d and --2d contradict each other" in err


def test_what_space_refuses(tmp_path, command):
    flat = xyz(tmp_path / "flat.xyz", cloud()[:, :2])
    code, _, err = command("triangulate", flat, "--3d")
    assert code == 2
    assert "three coordinates" in err
    solid = xyz(tmp_path / "solid.xyz", cloud())
    code, _, err = command("triangulate", solid, "--3d", "-o", tmp_path / "a.svg")
    assert code != 0
    assert "cannot store tetrahedra" in err
    plane = xyz(tmp_path / "plane.xyz", cloud() * (1, 1, 0))
    code, _, err = command("triangulate", plane, "--3d")
    assert code != 0
    assert "in one plane" in err
    assert command("triangulate", solid, "--3d", "--outline")[0] != 0


def test_wrong_tetrahedra_are_named(tmp_path, command):
    mesh = Delaunay(cloud())
    path = tmp_path / "mesh.npz"
    np.savez(path, points=mesh.points, simplices=mesh.simplices[:, [1, 0, 2, 3]])
    code, out, _ = command("check", path)
    assert code == 1
    assert "not positively oriented" in out


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_files_without_points_are_files(form, tmp_path, command):
    head = f"ply\nformat {form} 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
    path = tmp_path / "empty.ply"
    path.write_text(f"{head}property float z\nend_header\n")
    for option, noun in (((), "tetrahedron"), (("--2d",), "triangle")):
        code, _, err = command("triangulate", path, *option)
        assert (code, err.startswith(f"delone: 0 distinct points are too few for a {noun}")) == (
            4,
            True,
        )
    code, _, err = command("check", path)
    assert (code, err) == (3, f"delone: {path} contains no points\n")


def test_pictures_need_no_screen(tmp_path, monkeypatch, capfd):
    pytest.importorskip("pyvista")
    monkeypatch.delenv("DISPLAY", raising=False)
    write_mesh(tmp_path / "mesh.png", Delaunay(cloud()))
    assert capfd.readouterr() == ("", "")


def test_pictures(tmp_path):
    pytest.importorskip("pyvista")
    path = tmp_path / "mesh.png"
    write_mesh(path, Delaunay(cloud()))
    assert path.read_bytes().startswith(b"\x89PNG")


def test_slivers_are_removed_on_request(tmp_path, command, figures):
    points = cloud(300)
    source, target = ply(tmp_path / "cloud.ply", points), tmp_path / "mesh.vtu"
    found = figures("triangulate", source, "--improve", "--min-angle", "15", "-o", target)
    better = improve(Delaunay(points), min_angle=15)
    kept = read_mesh(target)
    assert (kept.points == better.points).all()
    assert (kept.simplices == better.simplices).all()
    gained = found["improvement"]
    assert gained["goal"] == 15
    assert gained["smallest_dihedral"]["before"] == better.report.smallest_before
    assert gained["smallest_dihedral"]["after"] == better.report.smallest_after
    assert sum(gained["below"].values()) == len(better.report.below)
    code, out, _ = command("triangulate", source, "--improve")
    assert code == 0
    assert "smallest dihedral" in out


def test_the_limit_on_passes_is_reported(tmp_path, command, figures):
    source = ply(tmp_path / "cloud.ply", cloud(300))
    found = figures("triangulate", source, "--improve", "--max-iter", "1")["improvement"]
    assert (found["passes"], found["exhausted"]) == (1, True)
    assert found["below"]["budget"] > 0
    out = command("triangulate", source, "--improve", "--max-iter", "1")[1]
    assert "the limit on passes (1); more may improve the result" in out
    code, _, err = command("triangulate", source, "--max-iter", "1")
    assert (code, "--improve" in err) == (2, True)


def test_points_are_added_on_request(tmp_path, command, figures):
    points = cloud(300)
    source, target = ply(tmp_path / "cloud.ply", points), tmp_path / "mesh.vtu"
    found = figures("triangulate", source, "--improve", "--max-points", "7", "-o", target)
    better = improve(Delaunay(points), max_points=7)
    assert 0 < found["improvement"]["points_added"] == better.nadded <= 7
    assert (read_mesh(target).points == better.points).all()
    assert figures("triangulate", source, "--improve")["improvement"]["points_added"] == 0
    assert "vertices added" in command("triangulate", source, "--improve")[1]
    assert command("triangulate", source, "--max-points", "7")[0] == 2


def test_only_tetrahedra_are_improved(tmp_path, command):
    source = xyz(tmp_path / "survey.xyz", cloud())
    code, _, err = command("triangulate", source, "--improve")
    assert (code, "--3d" in err) == (2, True)
    target = tmp_path / "mesh.npz"
    code, _, err = command("triangulate", source, "--3d", "--improve", "-o", target)
    assert (code, ".vtu" in err) == (2, True)
    assert not target.exists()
    assert command("triangulate", source, "--3d", "--improve", "--min-angle", "90")[0] != 0
    code, _, err = command("triangulate", source, "--3d", "--min-angle", "10")
    assert (code, "--improve" in err) == (2, True)
