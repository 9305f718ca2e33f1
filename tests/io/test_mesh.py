"""Mesh files: exact there and back, false headers, cells that are no triangles."""

import meshio
import numpy as np
import pytest

from delone import Delaunay, FileFormatError, ShapeError
from delone.io import read_mesh, read_points, write_mesh

SUFFIXES = [".vtu", ".ply", ".obj", ".stl", ".msh"]
POINTS = np.random.default_rng(5).random((300, 2)) + np.array([500_000, 5_400_000])
Z = np.random.default_rng(6).random(300)


@pytest.fixture(scope="module")
def mesh():
    return Delaunay(POINTS)


def as_set(points, z, simplices):
    """The triangles by coordinates: STL has no vertex numbers."""
    space = np.column_stack((points, z))
    return {frozenset(map(tuple, corners)) for corners in space[simplices].tolist()}


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("deep", [False, True])
def test_there_and_back(tmp_path, mesh, suffix, deep):
    file = tmp_path / f"a{suffix}"
    write_mesh(file, mesh, z=Z if deep else None)
    again = read_mesh(file)
    z = Z if deep else np.zeros(300)
    assert as_set(again.points, again.z, again.simplices) == as_set(POINTS, z, mesh.simplices)
    if suffix != ".stl":
        assert np.array_equal(again.simplices, mesh.simplices)
        survey = read_points(file)
        assert np.array_equal(survey.points, POINTS)
        assert np.array_equal(survey.z, z)


def test_stl_is_binary_where_single_precision_is_exact(tmp_path):
    write_mesh(tmp_path / "a.stl", Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)]))
    assert (tmp_path / "a.stl").stat().st_size == 84 + 4 * 50
    assert len(read_mesh(tmp_path / "a.stl").simplices) == 4


def test_attributes(tmp_path, mesh):
    area = {"area": mesh.areas, "weight": Z}
    write_mesh(tmp_path / "a.vtu", mesh, attributes=area)
    data = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(data.cell_data["area"][0], mesh.areas)
    assert np.array_equal(data.point_data["weight"], Z)
    assert np.array_equal(
        read_points(tmp_path / "a.vtu", attributes=["weight"]).attributes["weight"], Z
    )
    with pytest.raises(FileFormatError, match="cannot store attributes"):
        write_mesh(tmp_path / "a.stl", mesh, attributes=area)
    with pytest.raises(ShapeError, match="matches neither"):
        write_mesh(tmp_path / "b.vtu", mesh, attributes={"a": np.zeros(7)})
    with pytest.raises(ShapeError, match=r"\(300,\)"):
        write_mesh(tmp_path / "b.vtu", mesh, z=np.zeros(7))
    assert not (tmp_path / "b.vtu").exists()


def test_edges(tmp_path, mesh):
    for suffix in (".vtu", ".msh"):
        write_mesh(tmp_path / f"a{suffix}", mesh, edges=True)
        data = meshio.read(tmp_path / f"a{suffix}")
        assert np.array_equal(data.get_cells_type("line"), mesh.edges)
        with pytest.raises(FileFormatError, match="no triangles"):
            read_mesh(tmp_path / f"a{suffix}")
    with pytest.raises(FileFormatError, match="cannot store edges"):
        write_mesh(tmp_path / "a.ply", mesh, edges=True)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_garbage(tmp_path, suffix, capsys):
    file = tmp_path / f"a{suffix}"
    for seed in range(5):
        file.write_bytes(np.random.default_rng(seed).bytes(2000))
        with pytest.raises(FileFormatError):
            read_mesh(file)
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("suffix", [".vtu", ".ply", ".stl", ".msh"])
def test_torn(tmp_path, mesh, suffix):
    file = tmp_path / f"a{suffix}"
    write_mesh(file, mesh)
    whole = file.read_bytes()
    for share in (0.05, 0.5, 0.9):
        file.write_bytes(whole[: int(len(whole) * share)])
        with pytest.raises(FileFormatError):
            read_mesh(file)


@pytest.mark.parametrize(
    ("suffix", "dimension", "end"),
    [
        (".vtu", 2, b">"),
        (".vtu", 3, b">"),
        (".stl", 2, b"endsolid"),
        (".msh", 2, b"$End"),
        (".msh", 3, b"$End"),
    ],
)
@pytest.mark.sampled(3)
def test_meshes_are_refused_wherever_they_are_cut(tmp_path, suffix, dimension, end):
    file = tmp_path / f"a{suffix}"
    points = np.random.default_rng(7).random((8, dimension))
    write_mesh(file, Delaunay(points))
    whole = file.read_bytes()
    for size in range(whole.rindex(end)):
        file.write_bytes(whole[:size])
        with pytest.raises(FileFormatError):
            read_mesh(file)


@pytest.mark.parametrize("form", ["binary_little_endian", "ascii"])
def test_a_ply_file_is_refused_wherever_it_is_cut(tmp_path, form):
    file = tmp_path / "a.ply"
    points = np.random.default_rng(7).integers(0, 9, (12, 3)).astype(np.float64)
    cells = [("triangle", np.arange(12).reshape(4, 3))]
    for faces in ([], cells):
        meshio.write(file, meshio.Mesh(points, faces), "ply", binary=form != "ascii")
        whole = file.read_bytes()
        assert form.encode() in whole
        assert len(meshio.read(file).points) == 12
        # In the last number of a text nothing tells that there are digits to come.
        for size in range(len(whole) if form != "ascii" else whole.rstrip().rindex(b" ")):
            file.write_bytes(whole[:size])
            with pytest.raises(FileFormatError):
                (read_mesh if faces else read_points)(file)


@pytest.mark.parametrize("count", [10**7, 10**12, 10**18, 10**25])
def test_counts_that_are_false(tmp_path, count):
    text = {
        ".ply": f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
        "property double x\nproperty double y\nproperty double z\nend_header\n",
        ".vtu": '<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{count}" NumberOfCells="1"/></UnstructuredGrid></VTKFile>',
        ".msh": f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {count} 1 {count}\n",
    }
    for suffix, header in text.items():
        file = tmp_path / f"a{suffix}"
        file.write_text(header)
        with pytest.raises(FileFormatError, match=r"declares|truncated"):
            read_mesh(file)
    (tmp_path / "a.stl").write_bytes(bytes(80) + min(count, 2**32 - 1).to_bytes(4, "little"))
    with pytest.raises(FileFormatError, match=r"declares"):
        read_mesh(tmp_path / "a.stl")


def test_other_cells_are_refused(tmp_path):
    square = meshio.Mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [("quad", [[0, 1, 2, 3]])])
    square.write(tmp_path / "a.vtu")
    with pytest.raises(FileFormatError, match="quad"):
        read_mesh(tmp_path / "a.vtu")


def test_index_out_of_range(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n")
    with pytest.raises(FileFormatError, match="outside the range"):
        read_mesh(tmp_path / "a.obj")


def test_obj_counts_back_from_the_last_vertex(tmp_path):
    text = (
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
        "v 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nf -3/-1 -1/-1 -2/-1\nf 2//1 4//1 3//1\n"
    )
    (tmp_path / "a.obj").write_text(text)
    assert read_mesh(tmp_path / "a.obj").simplices.tolist() == [[0, 1, 2], [1, 3, 2], [1, 3, 2]]
    (tmp_path / "a.obj").write_text(text.replace("-3 -2 -1", "-4 -2 -1"))
    with pytest.raises(FileFormatError, match="line 4 has a corner with the number -4"):
        read_mesh(tmp_path / "a.obj")
