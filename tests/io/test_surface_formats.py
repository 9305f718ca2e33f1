"""STL, OBJ, PLY and OFF as programs write them: words in headers, textures, colors, polygons."""

from __future__ import annotations

import struct

import numpy as np
import pytest

import delone
from delone import FileFormatError
from delone.io import read_mesh, read_points

PLACES = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], dtype="<f4")
FACES = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]


def stl(header, *, count=4, faces=FACES):
    body = b"".join(bytes(12) + PLACES[face].tobytes() + bytes(2) for face in faces)
    return header.ljust(80) + struct.pack("<I", count) + body


@pytest.mark.parametrize("header", [b"solid part", b"solid", b"  solid\nfacet", b"made by", b""])
def test_the_size_says_whether_stl_is_binary(tmp_path, header):
    path = tmp_path / "a.stl"
    path.write_bytes(stl(header))
    assert len(read_mesh(path).simplices) == 4
    assert delone.tetrahedralize(path).volumes.sum() == 1 / 6
    for wrong in (stl(header)[:-1], stl(header) + b" ", stl(header, count=5)):
        path.write_bytes(wrong)
        with pytest.raises(FileFormatError, match=r"cut short|truncated"):
            read_mesh(path)


def obj(vertices, more, faces):
    return "\n".join([*(f"v {x} {y} {z}" for x, y, z in vertices.tolist()), *more, *faces, ""])


@pytest.mark.parametrize(
    ("more", "corner"),
    [
        (["vt 0 0"], "{}/1"),
        (["vt 0 0"] * 9, "{}/9"),
        (["vn 0 0 1"], "{}//1"),
        (["vt 0 0 0", "vn 0 0 1", "vn 0 1 0"], "{}/1/2"),
        (["vp 0.5", "usemtl red", "mtllib a.mtl", "o part", "g a b", "s 1", "# f 1 2"], "{}"),
    ],
)
def test_obj_with_any_number_of_textures_and_normals(tmp_path, more, corner):
    lines = ["f " + " ".join(corner.format(row + 1) for row in face) for face in FACES]
    path = tmp_path / "a.obj"
    for text in (obj(PLACES, more, lines), obj(PLACES, [], [*more, *lines])):
        path.write_text(text)
        found = read_mesh(path)
        assert found.simplices.tolist() == FACES
        assert np.array_equal(np.column_stack((found.points, found.z)), PLACES)


def test_obj_with_colors_weights_and_long_lines(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0 1 0 0\nv 1 0 0 1\nv 0 1 \\\n 0\nl 1 2\np 1\nf 1 \\\n2 3\n")
    assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]
    for line, what in {
        "v 0 0 0 2": "the weight 2",
        "v 1": "a vertex with 1 numbers",
        "f 1 2": "a face with 2 corners",
        "f 1 2 0": "a corner with the number 0",
        "surf 0 1 0 1 1 2": "a surf",
        "v 1 2 x": "line 8",
    }.items():
        path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\n\n\n" + line + "\n")
        with pytest.raises(FileFormatError, match=what):
            read_mesh(path)


HEAD = "ply\nformat {form} 1.0\ncomment made here\nobj_info scan 7\n"
VERTEX = (
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property uchar red\nproperty double quality\n"
)
EXTRA = {
    "face": ("element face 4\nproperty list uchar int vertex_indices\n", [[f] for f in FACES]),
    "index": ("element face 4\nproperty list uchar uint vertex_index\n", [[f] for f in FACES]),
    "colors": (
        "element face 4\nproperty uchar red\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nproperty short group\n",
        [[9, f, [0.5] * (2 * k), -1] for k, f in enumerate(FACES)],
    ),
}
CODES = {"uchar": "B", "int": "i", "uint": "I", "float": "f", "double": "d", "short": "h"}


def ply(form, head, faces, *, edges=True):
    """A PLY file whose faces have the given fields: numbers, and lists."""
    vertices = [[*map(float, place), k, 0.1 * k] for k, place in enumerate(PLACES)]
    more = "element edge 1\nproperty int vertex1\nproperty int vertex2\n" if edges else ""
    text = HEAD.format(form=form) + VERTEX + more + head + "end_header\n"
    rows = [(VERTEX, vertices), *([(more, [[0, 1]])] if edges else []), (head, faces)]
    if form == "ascii":
        for _, items in rows:
            for item in items:
                flat = [[len(x), *x] if isinstance(x, list) else [x] for x in item]
                text += " ".join(str(number) for part in flat for number in part) + "\n"
        return text.encode()
    order, body = "<" if "little" in form else ">", b""
    for part, items in rows:
        kinds = [line.split() for line in part.splitlines() if line.startswith("property")]
        for item in items:
            for words, value in zip(kinds, item, strict=True):
                if words[1] == "list":
                    body += struct.pack(f"{order}{CODES[words[2]]}", len(value))
                    body += struct.pack(f"{order}{len(value)}{CODES[words[3]]}", *value)
                else:
                    body += struct.pack(f"{order}{CODES[words[1]]}", value)
    return text.encode() + body


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("name", EXTRA)
def test_ply_with_any_properties(tmp_path, form, name):
    head, faces = EXTRA[name]
    path = tmp_path / "a.ply"
    content = ply(form, head, faces)
    path.write_bytes(content)
    found = read_mesh(path)
    assert found.simplices.tolist() == FACES
    assert np.array_equal(np.column_stack((found.points, found.z)), PLACES)
    values = read_points(path, attributes=["red", "quality"]).attributes
    assert values["red"].tolist() == [0, 1, 2, 3]
    assert values["quality"].tolist() == [0.1 * k for k in range(4)]
    for wrong in (content[:-3], content + b"7"):
        path.write_bytes(wrong)
        with pytest.raises(FileFormatError):
            read_mesh(path)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_polygons_of_surfaces_become_triangles(tmp_path, form):
    # A pyramid over a square, which is one quad and four triangles, in each format.
    points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n"
    faces = ["4 0 3 2 1", "3 0 1 4", "3 1 2 4", "3 2 3 4", "3 3 0 4"]
    obj_faces = "\n".join(
        "f " + " ".join(str(int(n) + 1) for n in face.split()[1:]) for face in faces
    )
    (tmp_path / "a.obj").write_text("v " + points.strip().replace("\n", "\nv ") + "\n" + obj_faces)
    (tmp_path / "a.off").write_text("OFF\n5 5 0\n" + points + "\n".join(faces))
    head = (
        f"ply\nformat {form} 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
        "property float z\nelement face 5\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if form == "ascii":
        (tmp_path / "a.ply").write_text(head + points + "\n".join(faces))
    else:
        rows = [[int(n) for n in face.split()] for face in faces]
        body = np.array(points.split(), dtype="<f4").tobytes()
        body += b"".join(struct.pack(f"<B{row[0]}i", *row) for row in rows)
        (tmp_path / "a.ply").write_bytes(head.encode() + body)
    found = [read_mesh(tmp_path / f"a{suffix}") for suffix in (".obj", ".off", ".ply")]
    for mesh in found:
        assert mesh.simplices.tolist() == found[0].simplices.tolist()
        assert len(mesh.simplices) == 6
    assert delone.tetrahedralize(tmp_path / "a.ply").volumes.sum() == pytest.approx(1 / 3)
    for suffix in (".obj", ".ply"):
        with pytest.raises(FileFormatError, match='polygons="split"'):
            read_mesh(tmp_path / f"a{suffix}", polygons="raise")


@pytest.mark.parametrize("word", ["inf", "-inf", "nan", "1e400", "0.5", "-1", "9"])
def test_off_with_numbers_that_are_none(tmp_path, word):
    text = "OFF\n3 1 0\n{}0 0\n1 0 0\n0 1 0\n3 0 1 {}\n"
    path = tmp_path / "a.off"
    path.write_text(text.format("0 ", word))
    with pytest.raises(FileFormatError, match="do not exist"):
        read_mesh(path)
    if word in ("inf", "-inf", "nan", "1e400"):
        square = "OFF\n4 1 0\n{} 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
        path.write_text(square.format(word))
        with pytest.raises(FileFormatError, match="cannot be triangulated"):
            read_mesh(path)
