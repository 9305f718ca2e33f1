"""Legacy VTK and Medit files: written by meshio, PyVista and delone, read by delone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import meshio
import numpy as np
import pytest
import pyvista

import delone
import solids
from delone.errors import FileFormatError
from delone.io import read_mesh, read_points, write_mesh

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

POINTS, FACES = solids.box((0, 0, 0), (4, 2, 1))
MARKERS = np.arange(len(FACES)) // 2 + 1
SURFACE = meshio.Mesh(POINTS, [("triangle", FACES)], cell_data={"marker": [MARKERS]})
MESH = delone.tetrahedralize(POINTS, FACES, face_markers=MARKERS)


def by_pyvista(path: Path, *, binary: bool) -> None:
    grid = pyvista.PolyData.from_regular_faces(POINTS, FACES)
    grid.cell_data["marker"] = MARKERS
    grid.point_data["height"] = POINTS[:, 2]
    grid.save(path, binary=binary)


def by_meshio(path: Path, *, binary: bool, version: str) -> None:
    meshio.write(path, SURFACE, file_format=version, binary=binary)


WRITERS: dict[str, Callable[[Path], Any]] = {
    "PolyData, binary": lambda path: by_pyvista(path, binary=True),
    "PolyData, text": lambda path: by_pyvista(path, binary=False),
    "4.2, binary": lambda path: by_meshio(path, binary=True, version="vtk42"),
    "4.2, text": lambda path: by_meshio(path, binary=False, version="vtk42"),
    "5.1, binary": lambda path: by_meshio(path, binary=True, version="vtk51"),
    "5.1, text": lambda path: by_meshio(path, binary=False, version="vtk51"),
}


@pytest.mark.parametrize("writer", WRITERS)
def test_a_surface_of_vtk(writer: str, tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    WRITERS[writer](path)
    found = read_mesh(path)
    assert found.z is not None
    assert np.array_equal(np.column_stack((found.points, found.z)), POINTS)
    assert np.array_equal(found.simplices, FACES)
    assert found.markers is not None
    assert np.array_equal(found.markers, MARKERS)
    mesh = delone.tetrahedralize(path)
    assert np.array_equal(mesh.face_markers[np.argsort(mesh.face_source)], MARKERS)


def test_values_of_points(tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    by_pyvista(path, binary=True)
    found = read_points(path, attributes=["height"])
    assert np.array_equal(found.attributes["height"], POINTS[:, 2])


def test_a_surface_of_medit(tmp_path: Path) -> None:
    path = tmp_path / "a.mesh"
    meshio.write(path, SURFACE)
    found = read_mesh(path)
    assert np.array_equal(found.simplices, FACES)
    assert found.markers is not None
    assert np.array_equal(found.markers, MARKERS)
    mesh = delone.tetrahedralize(path)
    assert np.array_equal(mesh.face_markers[np.argsort(mesh.face_source)], MARKERS)


def test_other_sections_and_comments_of_medit(tmp_path: Path) -> None:
    path = tmp_path / "a.mesh"
    path.write_text(
        "MeshVersionFormatted 2 # text\nDimension\n3\nVertices 3\n0 0 0 7\n1e0 0 0 7\n0 1 0 7\n"
        "Corners 1\n1\nRequiredVertices\n1\n2\nTriangles\n1\n1 2 3 -5\nNormals 1\n0 0 1\nEnd\n"
    )
    found = read_mesh(path)
    assert found.simplices.tolist() == [[0, 1, 2]]
    assert found.markers is not None
    assert found.markers.tolist() == [-5]


@pytest.mark.parametrize("suffix", [".vtk", ".mesh", ".msh"])
def test_tetrahedra_as_written(suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"a{suffix}"
    write_mesh(path, MESH)
    found = read_mesh(path)
    assert np.array_equal(found.points, MESH.points)
    assert np.array_equal(found.simplices, MESH.simplices)
    again = delone.tetrahedralize(MESH.points, MESH.boundary)
    write_mesh(path, again)
    assert np.array_equal(read_mesh(path).simplices, again.simplices)


def test_physical_groups_of_triangles(tmp_path: Path) -> None:
    path = tmp_path / "a.msh"
    tags = {"gmsh:physical": [MARKERS], "gmsh:geometrical": [MARKERS]}
    meshio.gmsh.write(path, meshio.Mesh(POINTS, [("triangle", FACES)], cell_data=tags), "2.2")
    mesh = delone.tetrahedralize(path)
    assert np.array_equal(mesh.face_markers[np.argsort(mesh.face_source)], MARKERS)


def test_polygons_of_vtk(tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    pyvista.Cube().clean().save(path)
    with pytest.raises(FileFormatError, match="quad"):
        read_mesh(path)
    assert len(read_mesh(path, polygons="split").simplices) == 12
    assert delone.tetrahedralize(path).volumes.sum() == pytest.approx(1)


def test_polygons_of_several_sizes(tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    head = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n"
    places = "0 0 0 1 0 0 1 1 0\n0 1 0 2 0 0\n"
    path.write_text(f"{head}{places}POLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n")
    assert read_mesh(path, polygons="split").simplices.shape == (3, 3)
    for wrong in ("3 0 1 2\n5 1 4 2 0 1", "4 0 1 2 3\n4 1 4 2", "-1 0 1 2 3\n3 1 4 2 0"):
        path.write_text(f"{head}{places}POLYGONS 2 9\n{wrong}\n")
        with pytest.raises(FileFormatError, match=r"corners|numbers"):
            read_mesh(path, polygons="split")


def test_markers_of_triangles_among_other_cells(tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    path.write_text(
        "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
        "0 0 0 1 0 0 1 1 0 0 1 0\nVERTICES 1 2\n1 3\nLINES 1 3\n2 0 2\nPOLYGONS 2 8\n"
        "3 0 1 2\n3 0 2 3\nCELL_DATA 4\nSCALARS marker int 1\nLOOKUP_TABLE default\n9 8 5 -6\n"
        "POINT_DATA 4\nVECTORS wind double\n0 0 nan\nnan 0 0 0 0 0 0 0 0\n"
    )
    found = read_mesh(path)
    assert found.simplices.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert found.markers is not None
    assert found.markers.tolist() == [5, -6]
    wind = read_points(path, attributes=["wind"]).attributes["wind"]
    assert np.isnan(wind).sum(axis=1).tolist() == [1, 1, 0, 0]


@pytest.mark.parametrize("writer", [*WRITERS, "Medit"])
def test_a_file_that_is_cut_short(writer: str, tmp_path: Path) -> None:
    path = tmp_path / ("a.mesh" if writer == "Medit" else "a.vtk")
    if writer == "Medit":
        meshio.write(path, SURFACE)
    else:
        WRITERS[writer](path)
    whole = path.read_bytes()
    for size in range(0, len(whole) - 1, 7):
        path.write_bytes(whole[:size])
        try:
            found = read_mesh(path)
        except FileFormatError as error:
            assert str(path) in str(error)
        else:
            # Only values, or what is no cell, are missing.
            assert writer != "Medit"
            assert np.array_equal(found.simplices, FACES)


@pytest.mark.parametrize(
    ("suffix", "text", "what"),
    [
        (".vtk", "# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_POINTS\n", "STRUCTURED"),
        (".vtk", "<VTKFile/>", "not a legacy"),
        (".vtk", "{head}POINTS 999999999999999 double\n0 0 0\n", "declares"),
        (".vtk", "{head}POINTS 1" + 30 * "0" + " double\n0 0 0\n", "digits"),
        (".vtk", "{head}POINTS 1 quadruple\n0 0 0\n", "quadruple"),
        (".vtk", "{head}POINTS one double\n0 0 0\n", "count"),
        (".vtk", "{head}POINTS 1 double\n0 0 0\nPOLYGONS 1 4\n3 0 0 7\n", "index|points|range"),
        (".vtk", "{head}POINTS 1 double\n0 0 0\nPOLYGONS 1 4\n3 0 0 .5\n", "integers"),
        (".mesh", "Vertices 1\n0 0 0 0\nEnd\n", "MeshVersionFormatted"),
        (".mesh", "MeshVersionFormatted 1\nDimension 3\nVertices 2\n0 0 0 0\nEnd\n", "declares"),
        (".mesh", "MeshVersionFormatted 1\nDimension 4\nVertices 0\nEnd\n", "Dimension"),
        (".mesh", "MeshVersionFormatted 1\nVertices 1\n0 0 0 0\n", "End"),
        (
            ".mesh",
            "MeshVersionFormatted 1\nDimension 3\nVertices 1\n0 0 0 0\nTriangles 1\n1 1 2 0\nEnd\n",
            "points",
        ),
    ],
)
def test_what_is_wrong_with_a_file(suffix: str, text: str, what: str, tmp_path: Path) -> None:
    head = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n"
    path = tmp_path / f"a{suffix}"
    path.write_text(text.replace("{head}", head))
    with pytest.raises(FileFormatError, match=what):
        read_mesh(path)


def test_heat_between_marked_faces() -> None:
    """scikit-fem finds the sides by their markers: the solution is linear, so it is exact."""
    fem = pytest.importorskip("skfem")
    from skfem.models.poisson import laplace

    sides = np.select(
        [(POINTS[FACES][:, :, 0] == x).all(axis=1) for x in (0, 4)], [1, 2], default=3
    )
    solid = delone.tetrahedralize(
        POINTS, FACES, face_markers=sides, extra_points=[(1, 1, 0.5), (3, 0.75, 0.25)]
    )
    basis = fem.Basis(solid.to_skfem(), fem.ElementTetP1())
    cold, hot = (basis.get_dofs(f"marker {k}") for k in (1, 2))
    values = basis.zeros()
    values[hot] = 1.0
    fixed = np.union1d(cold.all(), hot.all())
    heat = fem.solve(*fem.condense(laplace.assemble(basis), x=values, D=fixed))
    assert heat == pytest.approx(basis.doflocs[0] / 4, abs=1e-12)
    assert len(np.setdiff1d(np.arange(basis.N), fixed)) == 2
