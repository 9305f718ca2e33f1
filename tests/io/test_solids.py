"""OFF and the formats of TetGen: what is written is read, and broken files are refused."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone import FileFormatError, tetrahedralize
from delone.io import read_mesh, read_points, write_mesh

if TYPE_CHECKING:
    from pathlib import Path

POINTS, FACES = solids.schoenhardt()
MESH = tetrahedralize(POINTS, FACES, face_markers=np.arange(8) - 3, regions=[(0, 0, 0.5, 7)])
NODES = """# a cube
8 3 0 0
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0 0 1  # above
6 1 0 1
7 1 1 1
8 0 1 1
"""
SMESH = (
    NODES
    + """6 1
4 4 3 2 1 10
4 5 6 7 8 20
4 1 2 6 5 30
4 2 3 7 6 40
4 3 4 8
  7 50
4 4 1 5 8 60
0
1
1 0.5 0.5 0.5 3 -1
"""
)
# A cube whose top has a square hole, in which the wall of a square pit begins.
POLY = """16 3 0 0
0 0 0 0
1 4 0 0
2 4 4 0
3 0 4 0
4 0 0 4
5 4 0 4
6 4 4 4
7 0 4 4
8 1 1 4
9 3 1 4
10 3 3 4
11 1 3 4
12 1 1 2
13 3 1 2
14 3 3 2
15 1 3 2
11 1
2 1 5
4 4 5 6 7
4 8 9 10 11
1 2 2 4
1 0 1
4 3 2 1 0
1 0 2
4 0 1 5 4
1 0 2
4 1 2 6 5
1 0 2
4 2 3 7 6
1 0 2
4 3 0 4 7
1 0 3
4 12 13 14 15
1 0 3
4 8 12 13 9
1 0 3
4 9 13 14 10
1 0 3
4 10 14 15 11
1 0 3
4 11 15 12 8
0
0
"""


def stacked(found: Any) -> np.ndarray[Any, Any]:
    return np.column_stack((found.points, found.z))


@pytest.mark.parametrize("suffix", [".off", ".smesh", ".face"])
def test_surfaces_come_back(suffix: str, tmp_path: Path) -> None:
    hull = delone.ConvexHull(np.random.default_rng(2).normal(size=(30, 3)))
    write_mesh(tmp_path / f"a{suffix}", hull)
    write_mesh(tmp_path / "a.node", hull)
    found = read_mesh(tmp_path / f"a{suffix}")
    assert np.array_equal(stacked(found), hull.points)
    assert np.array_equal(found.simplices, hull.simplices)
    survey = read_points(tmp_path / "a.node")
    assert np.array_equal(np.column_stack((survey.points, survey.z)), hull.points)


def test_tetrahedra_come_back(tmp_path: Path) -> None:
    for suffix in (".node", ".ele", ".face", ".smesh"):
        write_mesh(tmp_path / f"a{suffix}", MESH)
    found = read_mesh(tmp_path / "a.ele")
    assert np.array_equal(found.points, MESH.points)
    assert np.array_equal(found.simplices, MESH.simplices)
    assert (tmp_path / "a.ele").read_text().splitlines()[1].endswith(" 7")
    for suffix in (".face", ".smesh"):
        surface = read_mesh(tmp_path / f"a{suffix}")
        assert np.array_equal(surface.simplices, MESH.input_faces)
        assert np.array_equal(surface.markers, MESH.face_markers)
    again = tetrahedralize(tmp_path / "a.smesh")
    assert np.array_equal(again.face_markers, MESH.face_markers)
    assert bool(again.validate())


def test_facets_with_more_corners(tmp_path: Path) -> None:
    (tmp_path / "cube.smesh").write_text(SMESH)
    found = read_mesh(tmp_path / "cube.smesh")
    assert len(found.simplices) == 12
    assert np.array_equal(np.unique(found.markers), [10, 20, 30, 40, 50, 60])
    assert found.regions.tolist() == [[0.5, 0.5, 0.5, 3]]
    mesh = tetrahedralize(tmp_path / "cube.smesh")
    assert {*mesh.region.tolist()} == {3}
    assert solids.filled(mesh.points, mesh.simplices) == 1
    # Seen from outside, as the polygons are.
    assert solids.volume(mesh.points, mesh.input_faces) == 1


def test_facets_with_holes(tmp_path: Path) -> None:
    (tmp_path / "pit.poly").write_text(POLY)
    found = read_mesh(tmp_path / "pit.poly")
    assert {*found.markers.tolist()} == {1, 2, 3, 5}
    assert (found.markers == 5).sum() == 8
    mesh = tetrahedralize(tmp_path / "pit.poly", inside="parity")
    assert solids.filled(mesh.points, mesh.simplices) == 64 - 8
    assert {*mesh.face_markers.tolist()} == {1, 2, 3, 5}


def test_points_in_the_file_next_to_it(tmp_path: Path) -> None:
    (tmp_path / "cube.node").write_text(NODES)
    (tmp_path / "cube.smesh").write_text("0 3 0 0\n" + SMESH.removeprefix(NODES))
    assert len(read_mesh(tmp_path / "cube.smesh").simplices) == 12
    (tmp_path / "cube.face").write_text("1 1\n1 1 2 3 -1 4 5\n")
    found = read_mesh(tmp_path / "cube.face")
    assert (found.simplices.tolist(), found.markers.tolist()) == ([[0, 1, 2]], [-1])
    (tmp_path / "cube.ele").write_text("1 10 0\n1 1 2 4 5 1 1 1 1 1 1\n")
    assert read_mesh(tmp_path / "cube.ele").simplices.tolist() == [[0, 1, 3, 4]]
    (tmp_path / "cube.node").unlink()
    for suffix in (".smesh", ".face", ".ele"):
        with pytest.raises(FileNotFoundError, match="needs it for its points"):
            read_mesh(tmp_path / f"cube{suffix}")


def test_off_with_colors_and_polygons(tmp_path: Path) -> None:
    text = "COFF # colored\n5 2 0\n" + "".join(
        f"{x} {y} {z} 255 0 0 255\n"
        for x, y, z in [(0, 0, 0), (2, 0, 0), (1, 0.5, 1e-3), (2, 2, 0), (0, 0, 1)]
    )
    (tmp_path / "a.off").write_text(text + "4 0 1 2 3 0.5 0.5 0.5\n3 0 1 4\n")
    found = read_mesh(tmp_path / "a.off")
    # The polygon is not convex: a fan from its first corner would turn a triangle over.
    assert sorted(map(sorted, found.simplices.tolist())) == [[0, 1, 2], [0, 1, 4], [0, 2, 3]]
    assert len(read_points(tmp_path / "a.off")) == 5
    (tmp_path / "b.off").write_text("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert read_mesh(tmp_path / "b.off").simplices.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("turn", [False, True])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_orientation_of_polygons(axis: int, turn: bool, tmp_path: Path) -> None:
    corners = np.insert(np.array([(0.0, 0), (2, 0), (2, 2), (0, 2)]), axis, 0.5, axis=1)
    polygon = [3, 2, 1, 0] if turn else [0, 1, 2, 3]
    lines = [" ".join(map(str, row)) for row in corners.tolist()]
    text = "\n".join(["OFF", "4 1 0", *lines, " ".join(map(str, (4, *polygon)))])
    (tmp_path / "a.off").write_text(text)
    places = corners[polygon]
    wanted = np.cross(places[1] - places[0], places[2] - places[0])
    for a, b, c in corners[read_mesh(tmp_path / "a.off").simplices]:
        assert np.dot(np.cross(b - a, c - a), wanted) > 0


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("a.off", "PFF\n3 1 0\n", "not an OFF file"),
        ("a.off", "OFF BINARY\n3 1 0\n", "other than numbers"),
        ("a.off", "# nothing\n", "not an OFF file"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "truncated"),
        ("a.off", "OFF\n999999999999 1 0\n0 0 0\n", "no counts"),
        ("a.off", "OFF\n2000000000 1 0\n0 0 0\n", "truncated"),
        ("a.off", "OFF\n-3 1 0\n0 0 0\n", "no counts"),
        ("a.off", "OFF\n3 1000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "truncated"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "points that do not exist"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 0.5\n", "points that do not exist"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "2 corners"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1000000000 0 1 2\n", "truncated"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 x\n3 0 1 2\n", "other than numbers"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "fewer than 3"),
        ("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "no triangles"),
        ("a.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n4 0 1 2 3\n", "cannot be triangulated"),
        ("a.off", "OFF\n4 1 0\n0 0 0\n2 0 0\n0 2 0\n2 2 0\n4 0 1 2 3\n", "cannot be triangulated"),
        ("a.smesh", NODES, "truncated"),
        ("a.smesh", NODES + "9 0\n3 1 2 3\n", "truncated"),
        ("a.smesh", NODES + "1 0\n3 1 2 9\n", "points that do not exist"),
        ("a.smesh", NODES + "1 0\n2 1 2\n", "2 corners"),
        ("a.smesh", NODES + "1 1\n3 1 2 3 0.5\n", "marker"),
        ("a.smesh", NODES + "1 0\n3 1 2 3\n5\n", "truncated"),
        ("a.smesh", NODES.replace("8 3", "8 4"), "4 coordinates"),
        ("a.smesh", NODES.replace("2 1 0 0", "7 1 0 0"), "not numbered consecutively"),
        ("a.smesh", NODES + "0 0\n0\n0\n", "no triangles"),
        ("a.poly", NODES + "1 0\n0 0\n", "0 polygons"),
        ("a.poly", NODES + "1 0\n1 -1\n3 1 2 3\n", "-1 holes"),
        ("a.poly", NODES + "1 0\n1 4\n3 1 2 3\n", "truncated"),
        ("a.poly", NODES.replace("8 3", "8 2") + "0\n", "2-D"),
    ],
)
def test_broken_files(name: str, text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(FileFormatError, match=words):
        read_mesh(tmp_path / name)


def test_files_that_are_no_text(tmp_path: Path) -> None:
    for suffix in (".off", ".smesh", ".poly", ".face", ".ele"):
        (tmp_path / f"a{suffix}").write_bytes(b"\xff\xfe\x00\x81" * 50)
        (tmp_path / "a.node").write_bytes(b"\xff\xfe\x00\x81" * 50)
        with pytest.raises(FileFormatError):
            read_mesh(tmp_path / f"a{suffix}")
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.off")


def test_what_a_format_has_no_place_for(tmp_path: Path) -> None:
    for suffix in (".off", ".smesh"):
        with pytest.raises(FileFormatError, match="attributes"):
            write_mesh(
                tmp_path / f"a{suffix}",
                delone.ConvexHull(POINTS),
                attributes={"a": np.zeros(6)},
            )
    with pytest.raises(FileFormatError, match="cannot store tetrahedra"):
        write_mesh(tmp_path / "a.off", MESH)
    with pytest.raises(FileFormatError, match="cannot be chosen"):
        (tmp_path / "b.off").write_text("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        read_points(tmp_path / "b.off", columns=[0, 1])


def test_regions_are_groups_of_med(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("h5py")
    both = solids.joined(solids.box((0, 0, 0), (4, 4, 4)), solids.box((1, 1, 1), (2, 2, 2)))
    for regions in (None, [(1.5, 1.25, 1.5, 7)]):
        mesh = tetrahedralize(*both, regions=regions)
        write_mesh(tmp_path / "a.med", mesh)
        found = meshio.read(tmp_path / "a.med")
        assert np.array_equal(found.points, mesh.points)
        # The first three corners of MED are seen from outside.
        assert np.array_equal(found.cells_dict["tetra"], mesh.simplices[:, [0, 2, 1, 3]])
        names = {-1: []} | {label: [f"region {label}"] for label in (0, 1, 7)}
        of_tag = {0: []} | found.cell_tags
        tags = found.cell_data["cell_tags"][0].tolist()
        assert [of_tag[tag] for tag in tags] == [names[label] for label in mesh.region.tolist()]
        assert len(set(tags)) == 2


def test_markers_are_groups_of_med(tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    pytest.importorskip("h5py")
    square = [(0.0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    mesh = delone.mesh(square, max_area=0.05, segment_markers=[1, 0, -3, 4])
    write_mesh(tmp_path / "a.med", mesh)
    found = meshio.read(tmp_path / "a.med")
    lines = found.cells_dict["line"]
    (at,) = (k for k, block in enumerate(found.cells) if block.type == "line")
    of_tag = {0: []} | found.cell_tags
    names = {
        frozenset(p): of_tag[t]
        for p, t in zip(lines.tolist(), found.cell_data["cell_tags"][at].tolist(), strict=True)
    }
    for pair, marker in zip(mesh.segments.tolist(), mesh.segment_markers.tolist(), strict=True):
        assert names[frozenset(pair)] == ([f"marker {marker}"] if marker else [])
