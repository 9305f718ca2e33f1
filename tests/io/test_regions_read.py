"""Regions of tetrahedra, faces and their markers, read back from the files that have them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
import solids
from delone import tetrahedralize
from delone.io import MeshFile, read_mesh, write_mesh

if TYPE_CHECKING:
    from pathlib import Path

meshio = pytest.importorskip("meshio")

POINTS, FACES = solids.joined(solids.box((0, 0, 0), (4, 4, 4)), solids.box((1, 1, 1), (2, 2, 2)))
SEEDS = [(0.5, 0.5, 0.5, 7), (1.5, 1.25, 1.5, 3)]
MARKERS = np.arange(len(FACES)) // 2 + 1
MESHES = {
    "marked": tetrahedralize(POINTS, FACES, face_markers=MARKERS, regions=SEEDS),
    # Numbers below 1 are none of Gmsh and Medit.
    "also below 1": tetrahedralize(
        POINTS, FACES, face_markers=MARKERS - 4, regions=[(*SEEDS[0][:3], 0), SEEDS[1]]
    ),
    "no markers": tetrahedralize(POINTS, FACES, regions=SEEDS),
    "one region": tetrahedralize(*solids.box((0, 0, 0), (1, 2, 3))),
}
FORMATS = [(".vtu", None), (".vtk", None), (".mesh", None), (".msh", "2.2"), (".msh", "4.1")]


def keyed(rows: np.ndarray, values: np.ndarray) -> dict[tuple[int, ...], int]:
    return {tuple(sorted(row)): int(v) for row, v in zip(rows.tolist(), values, strict=True)}


def require_same(found: MeshFile, mesh: delone.TetMesh) -> None:
    assert np.array_equal(found.points, mesh.points)
    assert found.region is not None and found.region.dtype == np.int32
    assert keyed(found.simplices, found.region) == keyed(mesh.simplices, mesh.region)
    if not mesh.face_markers.any():
        assert found.faces is None and found.face_markers is None
        return
    assert found.faces is not None and found.faces.dtype == np.int32
    assert found.face_markers is not None and found.face_markers.dtype == np.int32
    assert keyed(found.faces, found.face_markers) == keyed(mesh.input_faces, mesh.face_markers)
    assert found.markers is None and found.regions is None


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize(("suffix", "version"), FORMATS)
def test_they_come_back(suffix: str, version: str | None, name: str, tmp_path: Path) -> None:
    mesh, path = MESHES[name], tmp_path / f"a{suffix}"
    write_mesh(path, mesh, version=version)
    require_same(read_mesh(path), mesh)


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("version", ["2.2", "4.1"])
def test_regions_without_markers_are_groups_of_msh(
    version: str, order: int, tmp_path: Path
) -> None:
    """A program that reads groups finds the regions, and values of tetrahedra remain."""
    gmsh = pytest.importorskip("gmsh")
    mesh, path = MESHES["no markers"], tmp_path / "a.msh"
    values = np.arange(mesh.nsimplex) / 4
    write_mesh(path, mesh, version=version, order=order, attributes={"u": values})
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        found = {}
        for ndim, tag in gmsh.model.getPhysicalGroups():
            corners = [
                rows.reshape(-1, 4 if order == 1 else 10)[:, :4].astype(int) - 1
                for entity in gmsh.model.getEntitiesForPhysicalGroup(ndim, tag)
                for rows in gmsh.model.mesh.getElements(ndim, entity)[2]
            ]
            rows = np.concatenate(corners)
            found |= keyed(rows, np.full(len(rows), tag))
            assert gmsh.model.getPhysicalName(ndim, tag) == f"region {tag}"
        views = {
            gmsh.view.option.getString(view, "Name"): gmsh.view.getModelData(view, 0)
            for view in gmsh.view.getTags()
        }
        kind, elements, data, *_ = views["u"]
        places = {
            element: tuple(sorted(gmsh.model.mesh.getElement(element)[1][:4].astype(int) - 1))
            for element in elements
        }
    finally:
        gmsh.finalize()
    assert found == keyed(mesh.simplices, mesh.region)
    assert kind == "ElementData" and set(views) == {"u", "region", "smallest_dihedral"}
    own = {places[e]: value for e, (value,) in zip(elements, data, strict=True)}
    rows = map(tuple, np.sort(mesh.simplices, axis=1).tolist())
    assert own == dict(zip(rows, values.tolist(), strict=True))


@pytest.mark.parametrize("version", ["2.2", "4.1"])
@pytest.mark.parametrize("binary", [False, True])
def test_groups_of_gmsh(version: str, binary: bool, tmp_path: Path) -> None:
    """Volumes in a group, in one of the numbers of delone, and in none; faces beside them."""
    gmsh = pytest.importorskip("gmsh")
    mesh, path = MESHES["marked"], tmp_path / "a.msh"
    parts = [mesh.simplices[:5], mesh.simplices[5:9], mesh.simplices[9:]]
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.SaveAll", version == "4.1")
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
        gmsh.model.add("parts")
        gmsh.model.addDiscreteEntity(2, 1)
        for number, rows in enumerate(parts, 1):
            gmsh.model.addDiscreteEntity(3, number)
            if number == 1:
                n = mesh.npoints
                gmsh.model.mesh.addNodes(3, 1, range(1, n + 1), mesh.points.ravel())
            gmsh.model.mesh.addElementsByType(number, 4, [], rows.ravel() + 1)
        gmsh.model.mesh.addElementsByType(1, 2, [], mesh.input_faces[:6].ravel() + 1)
        gmsh.model.addPhysicalGroup(2, [1], 41, "skin")
        # The same number as that of the faces: groups of each dimension are their own.
        gmsh.model.addPhysicalGroup(3, [1], 41, "steel")
        gmsh.model.addPhysicalGroup(3, [2], 42, "region -5")
        if version == "2.2":
            gmsh.model.addPhysicalGroup(3, [3], 43)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    found = read_mesh(path)
    rest = 43 if version == "2.2" else 0
    expected = np.repeat([41, -5, rest], [len(rows) for rows in parts])
    assert keyed(found.simplices, found.region) == keyed(mesh.simplices, expected)
    assert keyed(found.faces, found.face_markers) == keyed(mesh.input_faces[:6], [41] * 6)


def test_a_tetmesh_in_npz(tmp_path: Path) -> None:
    mesh, path = MESHES["marked"], tmp_path / "a.npz"
    mesh.save(path)
    require_same(read_mesh(path), mesh)
    arrays = dict(np.load(path))
    for name in ("region", "face_markers"):
        for wrong in (arrays[name][1:], arrays[name].astype(float), arrays[name][:, None]):
            np.savez(path, **(arrays | {name: wrong}))
            with pytest.raises(delone.FileFormatError, match=rf"array '{name}' has .* integers"):
                read_mesh(path)
    np.savez(path, **(arrays | {"input_faces": arrays["input_faces"] + 1000}))
    with pytest.raises(delone.FileFormatError):
        read_mesh(path)
    # Without them, as in the file of a Delaunay.
    delone.Delaunay(mesh.points).save(path)
    found = read_mesh(path)
    assert found.region is None and found.faces is None and found.face_markers is None


def test_an_attribute_of_tetgen(tmp_path: Path) -> None:
    mesh = MESHES["marked"]
    for suffix in (".node", ".ele"):
        write_mesh(tmp_path / f"a{suffix}", mesh)
    found = read_mesh(tmp_path / "a.ele")
    assert keyed(found.simplices, found.region) == keyed(mesh.simplices, mesh.region)
    text = (tmp_path / "a.ele").read_text().splitlines()
    (tmp_path / "a.ele").write_text("\n".join([*text[:-1], text[-1] + ".5"]) + "\n")
    assert read_mesh(tmp_path / "a.ele").region is None
    plain = [" ".join(line.split()[:5]) for line in text[1:]]
    (tmp_path / "a.ele").write_text("\n".join([f"{len(plain)} 4 0", *plain]) + "\n")
    assert read_mesh(tmp_path / "a.ele").region is None


def mixed(path: Path, region: np.ndarray, marker: np.ndarray) -> None:
    """Faces before the tetrahedra, a point and a line among them."""
    mesh = MESHES["marked"]
    cells = [
        ("vertex", [[0]]),
        ("triangle", mesh.input_faces),
        ("tetra", mesh.simplices[:3]),
        ("line", [[0, 1]]),
        ("tetra", mesh.simplices[3:]),
    ]
    n, f = mesh.nsimplex, len(mesh.input_faces)
    sizes = np.cumsum([1, f, 3, 1])
    values = {
        "region": np.concatenate(([88], np.full(f, 88), region[:3], [88], region[3:])),
        "marker": np.concatenate(([99], marker, np.full(3, 99), [99], np.full(n - 3, 99))),
    }
    data = {name: np.split(each, sizes) for name, each in values.items()}
    meshio.Mesh(mesh.points, cells, cell_data=data).write(path)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_other_cells_are_passed_over(suffix: str, tmp_path: Path) -> None:
    mesh, path = MESHES["marked"], tmp_path / f"a{suffix}"
    mixed(path, mesh.region, mesh.face_markers)
    require_same(read_mesh(path), mesh)
    mixed(path, mesh.region + 0.5, mesh.face_markers)
    with pytest.raises(delone.FileFormatError, match=r"the region in row 0 is \d\.5, not"):
        read_mesh(path)
    mixed(path, mesh.region, mesh.face_markers + 0.5)
    with pytest.raises(delone.FileFormatError, match=r"the marker in row 0 is \d\.5, not"):
        read_mesh(path)


def test_pieces_of_vtu(tmp_path: Path) -> None:
    """Regions are those of all pieces, or none where one has none."""
    mesh, path = MESHES["marked"], tmp_path / "a.vtu"
    write_mesh(path, mesh)
    text = path.read_text()
    start, stop = text.index("<Piece"), text.index("</Piece>") + len("</Piece>")
    piece = text[start:stop]
    path.write_text(text[:start] + piece + "\n" + piece + text[stop:])
    found = read_mesh(path)
    both = np.concatenate((mesh.simplices, mesh.simplices + mesh.npoints))
    assert keyed(found.simplices, found.region) == keyed(both, np.tile(mesh.region, 2))
    faces = np.concatenate((mesh.input_faces, mesh.input_faces + mesh.npoints))
    assert keyed(found.faces, found.face_markers) == keyed(faces, np.tile(mesh.face_markers, 2))
    path.write_text(text[:start] + piece + "\n" + piece.replace('"region"', '"r"') + text[stop:])
    found = read_mesh(path)
    assert found.region is None and found.face_markers is not None


def test_triangles_of_a_solid_name_points_that_exist(tmp_path: Path) -> None:
    path = tmp_path / "a.vtk"
    meshio.Mesh(
        np.vstack((np.zeros(3), np.eye(3))), [("tetra", [[0, 1, 2, 3]]), ("triangle", [[0, 1, 4]])]
    ).write(path)
    with pytest.raises(delone.FileFormatError):
        read_mesh(path)


def test_several_sections_of_medit(tmp_path: Path) -> None:
    mesh, path = MESHES["marked"], tmp_path / "a.mesh"
    rows = [
        " ".join(map(str, (*row, number)))
        for row, number in zip((mesh.simplices + 1).tolist(), mesh.region.tolist(), strict=True)
    ]
    write_mesh(path, mesh)
    text = path.read_text()
    start, stop = text.index("Tetrahedra"), text.index("Triangles")
    assert start < stop
    halves = [f"Tetrahedra\n{len(own)}\n" + "\n".join(own) + "\n" for own in (rows[:7], rows[7:])]
    path.write_text(text[:start] + halves[0] + text[stop:].replace("End", halves[1] + "End"))
    require_same(read_mesh(path), mesh)
    path.write_text(
        path.read_text().replace(halves[1], halves[1].replace(rows[-1], rows[-1] + ".5"))
    )
    with pytest.raises(delone.FileFormatError, match="the region in row"):
        read_mesh(path)
