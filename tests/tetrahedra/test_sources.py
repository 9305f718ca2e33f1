"""Surfaces from files and from objects of other libraries."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
import solids

if TYPE_CHECKING:
    from pathlib import Path

POINTS, FACES = solids.torus()


def same(mesh: delone.TetMesh) -> bool:
    other = delone.tetrahedralize(POINTS, FACES)
    return bool(np.isclose(mesh.volumes.sum(), other.volumes.sum())) and bool(mesh.validate())


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply", ".vtu", ".msh"])
def test_files(suffix: str, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    path = tmp_path / f"torus{suffix}"
    # The suffix .msh has two formats.
    kind = {"file_format": "gmsh"} if suffix == ".msh" else {}
    meshio.Mesh(POINTS, [("triangle", FACES)]).write(path, **kind)
    mesh = delone.tetrahedralize(path)
    assert same(mesh)
    assert same(delone.tetrahedralize(str(path)))


@pytest.mark.parametrize("suffix", [".obj", ".vtu", ".ply"])
def test_files_with_polygons(suffix: str, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    points, _ = solids.box((0, 0, 0), (1, 2, 3))
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    cells = [("quad", np.array(quads[1:], dtype=np.int32))]
    cells.append(("triangle", np.array([(0, 1, 3), (0, 3, 2)], dtype=np.int32)))
    meshio.Mesh(points, cells).write(tmp_path / f"box{suffix}")
    with pytest.raises(delone.FileFormatError, match="quad"):
        delone.io.read_mesh(tmp_path / f"box{suffix}", polygons="raise")
    if suffix == ".vtu":
        with pytest.raises(delone.FileFormatError, match='polygons="split" divides them'):
            delone.io.read_mesh(tmp_path / f"box{suffix}")
    else:
        assert len(delone.io.read_mesh(tmp_path / f"box{suffix}").simplices) == 12
    mesh = delone.tetrahedralize(tmp_path / f"box{suffix}")
    assert len(mesh.input_faces) == 12
    assert solids.filled(mesh.points, mesh.simplices) == 6
    assert solids.volume(mesh.points, mesh.input_faces) == 6


def test_meshio() -> None:
    meshio = pytest.importorskip("meshio")
    assert same(delone.tetrahedralize(meshio.Mesh(POINTS, [("triangle", FACES)])))
    with pytest.raises(delone.InputError, match="quad cells"):
        delone.tetrahedralize(meshio.Mesh(POINTS, [("quad", FACES[:, [0, 1, 2, 0]])]))
    with pytest.raises(delone.InputError, match="no triangles"):
        delone.tetrahedralize(meshio.Mesh(POINTS, [("line", FACES[:, :2])]))


def test_pyvista() -> None:
    pyvista = pytest.importorskip("pyvista")
    flat = np.column_stack((np.full(len(FACES), 3), FACES)).ravel()
    assert same(delone.tetrahedralize(pyvista.PolyData(POINTS, flat)))
    with pytest.raises(delone.InputError, match="triangulate"):
        delone.tetrahedralize(pyvista.Cube().clean())
    grid = pyvista.PolyData(POINTS, flat).cast_to_unstructured_grid()
    assert same(delone.tetrahedralize(grid))
    assert same(
        delone.tetrahedralize(pyvista.UnstructuredGrid(grid.cells, [5] * len(FACES), POINTS))
    )
    solid = delone.tetrahedralize(POINTS, FACES).to_pyvista()
    for other in (solid, pyvista.Cube().clean().cast_to_unstructured_grid()):
        with pytest.raises(delone.InputError, match=r"extract_surface\(\)\.triangulate\(\)"):
            delone.tetrahedralize(other)
    with pytest.raises(delone.DtypeError, match="without faces"):
        delone.tetrahedralize(pyvista.ImageData(dimensions=(2, 2, 2)))


def test_names_of_trimesh() -> None:
    assert same(delone.tetrahedralize(SimpleNamespace(vertices=POINTS, faces=FACES)))


def test_surfaces_of_delone() -> None:
    hull = delone.ConvexHull(np.random.default_rng(1).normal(size=(50, 3)))
    mesh = delone.tetrahedralize(hull)
    assert np.isclose(mesh.volumes.sum(), hull.volume)
    with pytest.raises(delone.InputError, match="not this Delaunay"):
        delone.tetrahedralize(delone.Delaunay(hull.points))


def test_other_things() -> None:
    with pytest.raises(delone.DtypeError, match="without faces"):
        delone.tetrahedralize(POINTS)
    with pytest.raises(FileNotFoundError):
        delone.tetrahedralize("nowhere.stl")


def test_tetrahedra_are_no_surface(tmp_path: Path) -> None:
    delone.tetrahedralize(POINTS, FACES).save(tmp_path / "mesh.npz")
    with pytest.raises(delone.FileFormatError, match="not a surface"):
        delone.tetrahedralize(tmp_path / "mesh.npz")
