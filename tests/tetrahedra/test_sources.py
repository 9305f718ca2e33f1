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


@pytest.mark.parametrize("suffix", [".smesh", ".poly", ".face"])
def test_faces_of_tetgen_have_any_orientation(suffix: str, tmp_path: Path) -> None:
    turned = FACES.copy()
    turned[::2] = turned[::2, ::-1]
    node = f"{len(POINTS)} 3 0 0\n" + "".join(
        f"{k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(np.asarray(POINTS).tolist())
    )
    rows = [" ".join(map(str, face)) for face in turned.tolist()]
    if suffix == ".face":
        (tmp_path / "a.node").write_text(node)
        text = f"{len(rows)} 0\n" + "".join(f"{k} {row}\n" for k, row in enumerate(rows))
    else:
        lead = "3 " if suffix == ".smesh" else "1\n3 "
        text = f"{node}{len(rows)} 0\n" + "".join(f"{lead}{row}\n" for row in rows) + "0\n0\n"
    path = tmp_path / f"a{suffix}"
    path.write_text(text)
    whole = delone.tetrahedralize(POINTS, FACES).volumes.sum()
    assert np.isclose(delone.tetrahedralize(path).volumes.sum(), whole)
    with pytest.raises(delone.InputError, match="not oriented alike"):
        delone.tetrahedralize(path, inside="winding")


def test_extra_points_in_a_void() -> None:
    (points, faces), (inner, others) = (
        solids.box((a,) * 3, (b,) * 3) for a, b in ((0, 2), (0.5, 1.5))
    )
    faces, others = np.asarray(faces), np.asarray(others)
    both = np.concatenate((points, inner)), np.concatenate((faces, others[:, ::-1] + len(points)))
    mesh = delone.tetrahedralize(*both, extra_points=[(0.25, 1, 1)])
    assert 16 in mesh.simplices and solids.filled(mesh.points, mesh.simplices) == 7
    with pytest.raises(
        delone.InputError, match="extra_points: 1 point in a region that is left empty, row 1:"
    ):
        delone.tetrahedralize(*both, extra_points=[(0.25, 1, 1), (1, 1, 1)])
    with pytest.raises(delone.InputError, match="row 0:"):
        delone.tetrahedralize(
            *both, inside="enclosed", holes=[(1, 1, 1.1)], extra_points=[(1, 1, 1)]
        )
