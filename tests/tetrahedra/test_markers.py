"""Markers of faces arrive in the objects and files of solvers, each on its own triangle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.io import read_mesh, write_mesh
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

meshio = pytest.importorskip("meshio")
POINTS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
FACES = delone.ConvexHull(POINTS).simplices
# By sides of the cube: 1 and 2 at x, 0 elsewhere.
MARKERS = np.where(
    (POINTS[FACES][:, :, 0] == 0).all(axis=1),
    1,
    np.where((POINTS[FACES][:, :, 0] == 1).all(axis=1), 2, 0),
)
MESH = delone.tetrahedralize(POINTS, FACES, face_markers=MARKERS)


def sides(faces: Any) -> set[tuple[int, ...]]:
    return {tuple(sorted(face)) for face in np.asarray(faces).tolist()}


WANTED = {marker: sides(FACES[np.equal(MARKERS, marker)]) for marker in (0, 1, 2)}


def test_skfem() -> None:
    pytest.importorskip("skfem")
    made = MESH.to_skfem()
    assert set(made.boundaries) == {"marker 0", "marker 1", "marker 2"}
    for marker, wanted in WANTED.items():
        assert sides(made.facets[:, made.boundaries[f"marker {marker}"]].T) == wanted


def test_dolfinx() -> None:
    made = MESH.to_dolfinx_arrays()
    for marker, wanted in WANTED.items():
        assert sides(made["facets"][made["facet_tags"] == marker]) == wanted


@pytest.mark.parametrize("suffix", [".vtu", ".xdmf", ".msh", ".med", ".su2"])
def test_files(suffix: str, tmp_path: Path) -> None:
    if suffix in (".xdmf", ".med"):
        pytest.importorskip("h5py")
    path = tmp_path / f"a{suffix}"
    write_mesh(path, MESH)
    found = meshio.read(path)
    block = next(k for k, cells in enumerate(found.cells) if cells.type == "triangle")
    faces = found.cells[block].data
    for marker in (1, 2):
        if suffix in (".vtu", ".xdmf"):
            rows = found.cell_data["marker"][block] == marker
        elif suffix == ".msh":
            assert found.field_data[f"marker {marker}"].tolist() == [marker, 2]
            assert found.field_data["region 0"].tolist() == [1, 3]
            rows = found.cell_data["gmsh:physical"][block] == marker
        elif suffix == ".med":
            (tag,) = (n for n, names in found.cell_tags.items() if names == [f"marker {marker}"])
            rows = found.cell_data["cell_tags"][block] == tag
        else:
            rows = found.cell_data["su2:tag"][block] == marker
        assert sides(faces[rows]) == WANTED[marker]
    if suffix in (".vtu", ".msh"):
        assert read_mesh(path).simplices.tolist() == MESH.simplices.tolist()


def test_without_markers_there_are_tetrahedra_alone() -> None:
    plain = delone.tetrahedralize(POINTS, FACES)
    assert [cells.type for cells in plain.to_meshio().cells] == ["tetra"]
    assert plain.to_dolfinx_arrays()["facets"].shape == (0, 3)


def test_edges_of_a_mesh_with_markers(tmp_path: Path) -> None:
    write_mesh(tmp_path / "a.vtu", MESH, edges=True)
    assert len(meshio.read(tmp_path / "a.vtu").cells_dict["line"]) == len(MESH.edges)


def test_triangles_of_a_surface_have_heights() -> None:
    pytest.importorskip("geopandas")
    frame = TIN.from_points([(0, 0, 1), (4, 0, 5), (0, 4, 9)], crs="EPSG:28992").to_geopandas()
    ring = frame.geometry.iloc[0].exterior
    assert ring.has_z and sorted(set(ring.coords)) == [(0, 0, 1), (0, 4, 9), (4, 0, 5)]
    assert frame.crs == "EPSG:28992"
