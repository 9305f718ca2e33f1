"""Meshes to files and libraries of the field, and Triangle's files both ways."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import delone
from delone import FileFormatError
from delone.compat.triangle import triangulate
from delone.io import read_mesh, read_points, write_mesh
from delone.io.triangle import read_triangle

SQUARE = [(0.0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)]


@pytest.fixture(scope="module")
def mesh() -> delone.Mesh:
    return delone.mesh(SQUARE, max_area=0.05, segment_markers=[1, 2, 3, 4])


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".xdmf", ".inp", ".su2"])
def test_files_of_solvers(mesh: delone.Mesh, tmp_path: Path, suffix: str) -> None:
    meshio = pytest.importorskip("meshio")
    if suffix == ".xdmf":
        pytest.importorskip("h5py")
    file = tmp_path / f"mesh{suffix}"
    write_mesh(file, mesh)
    found = meshio.read(file)
    assert np.array_equal(found.points[:, :2], mesh.points)
    assert np.array_equal(found.cells_dict["triangle"], mesh.simplices)
    if suffix == ".inp":
        for marker in (1, 2, 3, 4):
            nodes = np.unique(mesh.segments[mesh.segment_markers == marker])
            assert np.array_equal(np.sort(found.point_sets[f"marker_{marker}"]), nodes)
        return
    lines = found.cells_dict["line"]
    assert {frozenset(pair) for pair in lines.tolist()} == {
        frozenset(pair) for pair in mesh.segments.tolist()
    }
    name = {".msh": "gmsh:physical", ".su2": "su2:tag"}.get(suffix, "marker")
    markers = np.concatenate(
        [d for b, d in zip(found.cells, found.cell_data[name], strict=True) if b.type == "line"]
    )
    found_of = {frozenset(p): m for p, m in zip(lines.tolist(), markers.tolist(), strict=True)}
    pairs = zip(mesh.segments.tolist(), mesh.segment_markers.tolist(), strict=True)
    assert found_of == {frozenset(pair): marker for pair, marker in pairs}


@pytest.mark.parametrize("suffix", [".ply", ".obj", ".stl", ".gpkg", ".geojson", ".png", ".svg"])
def test_files_of_triangulations(mesh: delone.Mesh, tmp_path: Path, suffix: str) -> None:
    for library in ("meshio", "geopandas", "matplotlib"):
        pytest.importorskip(library)
    write_mesh(tmp_path / f"mesh{suffix}", mesh)
    assert (tmp_path / f"mesh{suffix}").stat().st_size > 100


def test_a_file_of_its_own(mesh: delone.Mesh, tmp_path: Path) -> None:
    file = tmp_path / "mesh.npz"
    write_mesh(file, mesh, z=np.arange(mesh.npoints, dtype=float))
    found = read_mesh(file)
    assert np.array_equal(found.simplices, mesh.simplices)
    assert found.z is not None
    assert found.z[-1] == mesh.npoints - 1
    assert np.array_equal(delone.Mesh.load(file).segment_markers, mesh.segment_markers)


@pytest.mark.parametrize("suffix", [".msh", ".vtu"])
def test_what_is_written_is_read(mesh: delone.Mesh, tmp_path: Path, suffix: str) -> None:
    pytest.importorskip("meshio")
    file = tmp_path / f"mesh{suffix}"
    write_mesh(file, mesh)
    found = read_mesh(file)
    assert np.array_equal(found.points, mesh.points)
    assert np.array_equal(found.simplices, mesh.simplices)


def test_a_torn_file_of_gmsh(mesh: delone.Mesh, tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    file = tmp_path / "mesh.msh"
    write_mesh(file, mesh)
    whole = file.read_bytes()
    at = whole.index(b"$Nodes\n") + len(b"$Nodes\n")
    start = whole.index(b"\n", at) + 1
    for torn in (
        whole[:at] + b"99999999999\n" + whole[start:],
        whole[:start] + b"\xff\xff\xff\x7f" + whole[start + 4 :],
        whole[: start + 40],
        whole[:at],
    ):
        file.write_bytes(torn)
        with pytest.raises(FileFormatError):
            read_mesh(file)


def test_what_files_cannot_hold(mesh: delone.Mesh, tmp_path: Path) -> None:
    pytest.importorskip("meshio")
    with pytest.raises(FileFormatError):
        write_mesh(tmp_path / "mesh.npz", mesh, edges=True)
    with pytest.raises(FileFormatError):
        write_mesh(tmp_path / "mesh.su2", mesh, z=np.zeros(mesh.npoints))
    with pytest.raises(FileFormatError):
        write_mesh(tmp_path / "mesh.ele", mesh, edges=True)
    assert not list(tmp_path.iterdir())


def test_files_of_triangle(mesh: delone.Mesh, tmp_path: Path) -> None:
    for suffix in (".node", ".ele", ".poly"):
        write_mesh(tmp_path / f"mesh{suffix}", mesh)
    assert np.array_equal(read_points(tmp_path / "mesh.node").points, mesh.points)
    found = read_mesh(tmp_path / "mesh.ele")
    assert np.array_equal(found.points, mesh.points)
    assert np.array_equal(found.simplices, mesh.simplices)
    poly = read_triangle(tmp_path / "mesh.poly")
    assert np.array_equal(poly["segments"], mesh.segments)
    assert np.array_equal(poly["segment_markers"][:, 0], mesh.segment_markers)
    assert np.array_equal(poly["vertex_markers"][:, 0], mesh.point_markers)
    out = triangulate(poly, "p")
    assert len(out["triangles"]) == mesh.nsimplex


def test_a_poly_file_with_everything(tmp_path: Path) -> None:
    (tmp_path / "a.node").write_text(
        "# points from 1\n8 2 1 0\n1 0 0 5\n2 9 0 5\n3 9 9 5\n4 0 9 5\n"
        "5 3 3 6\n6 6 3 6\n7 6 6 6\n8 3 6 6\n"
    )
    (tmp_path / "a.poly").write_text(
        "0 2 0 0\n8 1\n1 1 2 7\n2 2 3 7\n3 3 4 7\n4 4 1 7\n5 5 6 8\n6 6 7 8\n7 7 8 8\n8 8 5 8\n"
        "1\n1 4 4\n1\n1 1 1 42 0.5\n"
    )
    found = read_triangle(tmp_path / "a.poly")
    out = triangulate(found, "pqaA")
    assert set(out["triangle_attributes"].ravel().tolist()) == {42.0}
    assert set(out["segment_markers"].ravel().tolist()) == {7, 8}
    assert set(out["vertex_attributes"].min(axis=0).tolist()) == {5.0}
    assert out["vertex_attributes"].max() == 6.0


@pytest.mark.parametrize(
    "text",
    ["", "3 2 0", "3 2 0 0 1 0 0", "1 3 0 0 1 0 0 0", "3 2 0 0 1 a b", "-1 2 0 0", "1.5 2 0 0"],
)
def test_torn_files_of_triangle(tmp_path: Path, text: str) -> None:
    file = tmp_path / "torn.node"
    file.write_text(text)
    with pytest.raises(FileFormatError):
        read_points(file)
    (tmp_path / "lone.ele").write_text("1 3 0\n0 0 1 2\n")
    with pytest.raises(FileNotFoundError):
        read_mesh(tmp_path / "lone.ele")


def test_libraries(mesh: delone.Mesh) -> None:
    arrays = mesh.to_dolfinx_arrays()
    assert np.array_equal(arrays["cells"], mesh.simplices)
    assert np.array_equal(arrays["facet_tags"], mesh.segment_markers)
    pytest.importorskip("matplotlib")
    assert np.array_equal(mesh.to_matplotlib().triangles, mesh.simplices)
    assert mesh.plot_quality().get_xlabel() == "angle in degrees"
    assert mesh.plot().get_aspect() == 1.0


def test_meshio() -> None:
    pytest.importorskip("meshio")
    halves = [(0.0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]
    sides = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
    mesh = delone.mesh(
        (halves, sides),
        max_area=0.05,
        segment_markers=[1, 2, 3, 4, 5, 6, 9],
        regions=[(0.5, 0.5, 3), (1.5, 0.5, 0)],
    )
    found = mesh.to_meshio()
    assert np.array_equal(found.points, np.column_stack((mesh.points, np.zeros(mesh.npoints))))
    assert [block.type for block in found.cells] == ["triangle", "line"]
    triangles, lines = (block.data for block in found.cells)
    assert np.array_equal(triangles, mesh.simplices)
    # What belongs to a cell is where that cell lies.
    at = found.points[triangles].mean(axis=1)
    region, none = found.cell_data["region"]
    assert np.array_equal(region, np.where(at[:, 0] < 1, 3, 0))
    assert (none == -1).all()
    at = found.points[lines].mean(axis=1)
    left, right, middle = at[:, 0] == 0, at[:, 0] == 2, at[:, 0] == 1
    low, up = at[:, 1] == 0, at[:, 0] < 1
    expected = np.select([left, right, middle, low & up, low, up], [6, 3, 9, 1, 2, 5], default=4)
    nothing, marker = found.cell_data["marker"]
    assert np.array_equal(marker, expected)
    assert (nothing == 0).all()
    assert np.array_equal(found.point_data["marker"], mesh.point_markers)
    # No tag of gmsh is 0, which stands for none there.
    for name in ("gmsh:physical", "gmsh:geometrical"):
        tags, of_lines = found.cell_data[name]
        assert np.array_equal(tags, np.where(region == 3, 4, 1))
        assert np.array_equal(of_lines, expected)


def test_scikit_fem(mesh: delone.Mesh) -> None:
    pytest.importorskip("skfem")
    found = mesh.to_skfem()
    assert found.nelements == mesh.nsimplex
    assert np.array_equal(found.p.T, mesh.points)
    for marker in (1, 2, 3, 4):
        facets = found.boundaries[f"marker {marker}"]
        ours = mesh.segments[mesh.segment_markers == marker]
        assert {frozenset(p) for p in found.facets[:, facets].T.tolist()} == {
            frozenset(p) for p in ours.tolist()
        }


def test_pyvista(mesh: delone.Mesh) -> None:
    pytest.importorskip("pyvista")
    found = mesh.to_pyvista()
    assert found.n_cells == mesh.nsimplex
    assert np.array_equal(found.regular_faces, mesh.simplices)
    assert np.array_equal(found.points[:, :2], mesh.points)
    assert np.array_equal(found.cell_data["region"], mesh.region)
    assert np.array_equal(found.point_data["marker"], mesh.point_markers)
    assert found.area == pytest.approx(mesh.areas.sum())
