"""Numbers in headers that cannot be: they are errors of the file, whatever their size."""

import re
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from delone import Delaunay, FileFormatError
from delone.io import read_mesh, read_points, write_mesh
from delone.io.triangle import read_triangle

MANY = "9" * 5000
NO_COUNTS = ["inf", "-inf", "1e400", "nan", "-1", "1.5", "1e18", "1e300", "9" * 30, MANY]
NODES = "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n"
TRIANGLE = {
    "count of nodes": (".node", "{} 2 0 0\n1 0 0\n2 1 0\n3 0 1\n"),
    "dimension": (".node", "3 {} 0 0\n1 0 0\n2 1 0\n3 0 1\n"),
    "attributes": (".node", "3 2 {} 0\n1 0 0\n2 1 0\n3 0 1\n"),
    "first node": (".node", "3 2 0 0\n{} 0 0\n2 1 0\n3 0 1\n"),
    "later node": (".node", "3 2 0 0\n1 0 0\n2 1 0\n{} 0 1\n"),
    "marker of a node": (".node", "3 2 0 1\n1 0 0 {}\n2 1 0 0\n3 0 1 0\n"),
    "count of triangles": (".ele", "{} 3 0\n1 1 2 3\n"),
    "corners": (".ele", "1 {} 0\n1 1 2 3\n"),
    "corner": (".ele", "1 3 0\n1 1 2 {}\n"),
    "count of points": (".poly", "{} 2 0 0\n1 1\n1 1 2 0\n0\n"),
    "count of segments": (".poly", NODES + "{} 1\n1 1 2 0\n0\n"),
    "end of a segment": (".poly", NODES + "1 1\n1 1 {} 0\n0\n"),
    "marker of a segment": (".poly", NODES + "1 1\n1 1 2 {}\n0\n"),
    "count of holes": (".poly", NODES + "1 1\n1 1 2 0\n{}\n"),
    "count of regions": (".poly", NODES + "1 1\n1 1 2 0\n0\n{}\n"),
}


@pytest.mark.parametrize("place", TRIANGLE)
@pytest.mark.parametrize("number", NO_COUNTS, ids=lambda number: number[:6])
def test_numbers_of_triangle(tmp_path: Path, place: str, number: str) -> None:
    suffix, text = TRIANGLE[place]
    (tmp_path / "a.node").write_text(NODES)
    file = tmp_path / f"a{suffix}"
    file.write_text(text.format(number))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        if number == "-1" and place.startswith("marker"):
            name = "vertex_markers" if suffix == ".node" else "segment_markers"
            assert -1 in read_triangle(file)[name]
            return
        with pytest.raises(FileFormatError, match=re.escape(str(tmp_path))):
            read_triangle(file)


def test_good_numbers_of_triangle(tmp_path: Path) -> None:
    (tmp_path / "a.node").write_text(NODES)
    (tmp_path / "a.ele").write_text("1 3 0\n1 1 2 3\n")
    assert read_mesh(tmp_path / "a.ele").simplices.tolist() == [[0, 1, 2]]


PLY = (
    "ply\nformat ascii 1.0\nelement vertex {vertices}\nproperty double x\nproperty double y\n"
    "property double z\nelement face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n{face}\n"
)
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {}\n"
MSH = (
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n"
    "$Elements\n1\n1 2 2 0 0 1 2 {corner}\n$EndElements\n"
)
TWENTY = "9" * 20


@pytest.mark.parametrize(
    ("suffix", "text"),
    [
        (".ply", PLY.format(vertices=MANY, faces=1, face="3 0 1 2")),
        (".ply", PLY.format(vertices=TWENTY, faces=1, face="3 0 1 2")),
        (".ply", PLY.format(vertices=3, faces=MANY, face="3 0 1 2")),
        (".ply", PLY.format(vertices=3, faces=1, face=f"3 0 1 {TWENTY}")),
        (".ply", PLY.format(vertices=3, faces=1, face=f"{MANY} 0 1 2")),
        *[(".obj", OBJ.format(sign + many)) for sign in ("", "-") for many in (MANY, TWENTY)],
        (".msh", MSH.format(nodes=MANY, corner=3)),
        (".msh", MSH.format(nodes=TWENTY, corner=3)),
        (".msh", MSH.format(nodes=3, corner=MANY)),
        (".msh", MSH.format(nodes=3, corner=TWENTY)),
    ],
    ids=lambda text: text[:4],
)
def test_numbers_of_meshes(tmp_path: Path, suffix: str, text: str) -> None:
    file = tmp_path / f"a{suffix}"
    file.write_text(text)
    for read in (read_mesh, read_points) if TWENTY not in text else (read_mesh,):
        with pytest.raises(FileFormatError, match=re.escape(str(file))) as caught:
            read(file)
        assert len(str(caught.value)) < 400


@pytest.mark.parametrize("name", ["NumberOfPoints", "NumberOfCells", "NumberOfComponents"])
def test_numbers_of_vtu(tmp_path: Path, name: str) -> None:
    file = tmp_path / "a.vtu"
    write_mesh(file, Delaunay([(0, 0), (4, 0), (0, 4)]))
    file.write_text(re.sub(rf'{name}="\d+"', f'{name}="{MANY}"', file.read_text()))
    with pytest.raises(FileFormatError, match=re.escape(str(file))):
        read_mesh(file)


def _columns(file: Path) -> object:
    return read_points(file, columns=[MANY, "1"])


@pytest.mark.parametrize(
    ("text", "read"),
    [(f"{MANY}\n1 2 3\n4 5 6\n", read_points), ("1 2 3\n4 5 6\n", _columns)],
    ids=["count of points", "number of a column"],
)
def test_numbers_of_text(tmp_path: Path, text: str, read: Callable[[Path], object]) -> None:
    file = tmp_path / "a.xyz"
    file.write_text(text)
    with pytest.raises(FileFormatError, match=re.escape(str(file))) as caught:
        read(file)
    assert len(str(caught.value)) < 400
