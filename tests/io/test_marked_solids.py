"""Markers of faces and regions of tetrahedra in all formats that can carry them."""

import pickle

import meshio
import numpy as np
import pytest

import delone
import solids
from delone import tetrahedralize
from delone.cli import run
from delone.io import read_mesh

SHELLS = solids.joined(solids.box((0, 0, 0), (4, 4, 4)), solids.box((1, 1, 1), (2, 2, 2)))
SEEDS = [(0.5, 0.5, 0.5, 7), (1.5, 1.25, 1.5, 3)]
POINTS, FACES = SHELLS
MARKERS = np.arange(len(FACES)) // 2 + 1
MESH = tetrahedralize(POINTS, FACES, face_markers=MARKERS, regions=SEEDS)


def keyed(rows, values):
    return {tuple(sorted(row)): int(v) for row, v in zip(rows.tolist(), values, strict=True)}


REGIONS = keyed(MESH.simplices, MESH.region)
WALLS = keyed(MESH.input_faces, MESH.face_markers)


@pytest.mark.parametrize("suffix", [".vtk", ".mesh", ".vtu", ".xdmf", ".msh"])
def test_meshio_reads_markers_and_regions(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    delone.io.write_mesh(path, MESH)
    found = meshio.read(path)
    assert np.array_equal(found.points, MESH.points)
    tets, triangles = {}, {}
    for i, block in enumerate(found.cells):
        values = {name: each[i] for name, each in found.cell_data.items()}
        if suffix == ".mesh":
            region = marker = values["medit:ref"]
        elif suffix == ".msh":
            names = {(int(tag), int(n)): name for name, (tag, n) in found.field_data.items()}
            ndim = 3 if block.type == "tetra" else 2
            region = marker = [
                int(names[int(tag), ndim].split()[1]) for tag in values["gmsh:physical"]
            ]
        else:
            region, marker = values["region"], values["marker"]
        if block.type == "tetra":
            tets |= keyed(block.data, region)
        else:
            triangles |= keyed(block.data, marker)
    assert tets == REGIONS
    assert triangles == WALLS


@pytest.mark.parametrize("suffix", [".med", ".inp"])
def test_groups_of_markers_and_regions(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    delone.io.write_mesh(path, MESH)
    found = meshio.read(path)
    groups = {}
    if suffix == ".med":
        for i, block in enumerate(found.cells):
            for row, tag in zip(block.data.tolist(), found.cell_data["cell_tags"][i], strict=True):
                for name in found.cell_tags.get(int(tag), []):
                    groups.setdefault(name, set()).add(tuple(sorted(row)))
    else:
        for name, sets in found.cell_sets.items():
            for block, rows in zip(found.cells, sets, strict=True):
                if len(rows):
                    own = {tuple(sorted(row)) for row in block.data[rows].tolist()}
                    groups.setdefault(name.replace("_", " "), set()).update(own)
    expected = {}
    for kind, rows in (("region", REGIONS), ("marker", WALLS)):
        for row, value in rows.items():
            expected.setdefault(f"{kind} {value}", set()).add(row)
    assert groups == expected


# The manual of Abaqus: the nodes, from 1, of each side of C3D4 and CPS3.
ABAQUS = {
    4: {"S1": (1, 2, 3), "S2": (1, 4, 2), "S3": (2, 4, 3), "S4": (3, 4, 1)},
    3: {"S1": (1, 2), "S2": (2, 3), "S3": (3, 1)},
}


def surfaces(path, simplices):
    """The corners of the sides of each surface of an INP file, and how often each is named."""
    found = {}
    now = None
    for line in path.read_text().splitlines():
        if line.startswith("*"):
            head, _, name = line.partition("NAME=")
            now = found.setdefault(name, []) if head.startswith("*SURFACE,") else None
        elif now is not None:
            element, side = line.split(", ")
            corners = simplices[int(element) - 1].tolist()
            own = ABAQUS[len(corners)][side]
            now.append(tuple(sorted(corners[k - 1] for k in own)))
    return found


def test_surfaces_of_inp_are_sides_of_elements(tmp_path):
    path = tmp_path / "a.inp"
    delone.io.write_mesh(path, MESH)
    expected = {}
    for row, value in WALLS.items():
        expected.setdefault(f"surface_{value}", []).append(row)
    found = surfaces(path, MESH.simplices)
    assert {name: sorted(rows) for name, rows in found.items()} == {
        name: sorted(rows) for name, rows in expected.items()
    }
    # A wall is a side of the first element.
    wall = path.read_text().partition("NAME=surface_12\n")[2].partition("*")[0]
    numbers = [int(line.partition(",")[0]) for line in wall.splitlines()]
    first = [
        min(t for t, corners in enumerate(MESH.simplices.tolist()) if set(row) <= set(corners))
        for row in expected["surface_12"]
    ]
    assert sorted(numbers) == sorted(t + 1 for t in first)


def test_surfaces_of_inp_in_2d(tmp_path):
    path = tmp_path / "a.inp"
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    flat = delone.mesh(square, max_area=0.5, segment_markers=[4, 4, 0, 6])
    delone.io.write_mesh(path, flat)
    expected = {}
    for (a, b), value in zip(flat.segments.tolist(), flat.segment_markers.tolist(), strict=True):
        if value:
            expected.setdefault(f"surface_{value}", []).append((min(a, b), max(a, b)))
    found = surfaces(path, flat.simplices)
    assert {name: sorted(rows) for name, rows in found.items()} == {
        name: sorted(rows) for name, rows in expected.items()
    }
    assert sorted(found) == ["surface_4", "surface_6"]


@pytest.mark.parametrize("suffix", [".smesh", ".poly"])
def test_tetgen_files_have_region_seeds_and_markers(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    delone.io.write_mesh(path, MESH)
    found = read_mesh(path)
    assert keyed(found.simplices, found.markers) == WALLS
    assert sorted(found.regions[:, 3].tolist()) == [3, 7]
    again = tetrahedralize(path)
    for seed in SEEDS:
        at = int(again.find_simplex([seed[:3]])[0])
        assert again.region[at] == seed[3]
    for name in (".smesh", ".poly"):
        out = tmp_path / f"b{name}"
        assert run(["tetrahedralize", str(path), "-o", str(out), "--quiet"]) == 0
        assert keyed(read_mesh(out).simplices, read_mesh(out).markers) == WALLS
        assert sorted(read_mesh(out).regions[:, 3].tolist()) == [3, 7]


def test_holes_of_a_file_are_holes_on_the_command_line(tmp_path, capsys):
    path = tmp_path / "a.smesh"
    delone.io.write_mesh(path, MESH)
    lines = path.read_text().splitlines()
    at = len(lines) - 4
    assert lines[at : at + 2] == ["0", "2"]
    lines[at : at + 1] = ["1", "0 1.5 1.25 1.5"]
    lines[-3:] = ["1", next(line for line in lines[-2:] if line.endswith(" 7"))]
    path.write_text("\n".join(lines) + "\n")
    out = tmp_path / "a.vtu"
    assert run(["tetrahedralize", str(path), "-o", str(out), "--json"]) == 0
    text = capsys.readouterr().out
    assert '"file_holes": 1' in text and '"file_regions": 1' in text
    mesh = tetrahedralize(path)
    assert mesh.volumes.sum() == pytest.approx(63)
    assert meshio.read(out).cells_dict["tetra"].tolist() == mesh.simplices.tolist()


def test_parts_of_the_boundary_of_su2(tmp_path):
    path = tmp_path / "a.su2"
    delone.io.write_mesh(path, MESH)
    found = meshio.read(path)
    sides = {}
    for block, tags in zip(found.cells, found.cell_data["su2:tag"], strict=True):
        if block.type == "triangle":
            sides |= keyed(block.data, tags)
    # The walls inside are no boundary.
    outer = {row: value for row, value in WALLS.items() if value <= 6}
    assert sides == outer


VOIDS = {
    "a void": [(9, 0, False), (6, 3, True)],
    "a body in a void": [(9, 0, False), (7, 2, True), (5, 4, False)],
    "two voids": [(9, 0, False), (3, 1, True), (7, 5, True)],
    "two regions": [(9, 0, False), (6, 3, False)],
    "no void": [(9, 0, False)],
}


def nested(boxes):
    made = [solids.box((low,) * 3, (high,) * 3) for high, low, _ in boxes]
    made = [
        (points, np.asarray(faces)[:, ::-1] if inward else faces)
        for (points, faces), (_, _, inward) in zip(made, boxes, strict=True)
    ]
    return solids.joined(*made)


@pytest.mark.parametrize("suffix", [".smesh", ".poly"])
@pytest.mark.parametrize("name", VOIDS)
def test_voids_are_still_voids_in_files_of_tetgen(name, suffix, tmp_path):
    boxes = VOIDS[name]
    mesh = tetrahedralize(*nested(boxes))
    empty = name.count("void") and sum(inward for _, _, inward in boxes)
    assert len(mesh.holes) == empty
    assert (mesh.find_simplex(mesh.holes.reshape(-1, 3)) == -1).all()
    path = tmp_path / f"a{suffix}"
    delone.io.write_mesh(path, mesh)
    assert np.array_equal(read_mesh(path).holes.reshape(-1, 3), mesh.holes)
    again = tetrahedralize(path)
    assert again.volumes.sum() == pytest.approx(mesh.volumes.sum())
    assert np.array_equal(again.holes, mesh.holes)


def test_seeds_of_voids_remain(tmp_path):
    mesh = tetrahedralize(*nested(VOIDS["a body in a void"]))
    (place,) = mesh.holes.tolist()
    # In the shell between the second box and the body.
    assert all(2 < x < 7 for x in place) and not all(4 <= x <= 5 for x in place)
    mesh.save(tmp_path / "a.npz")
    for again in (
        pickle.loads(pickle.dumps(mesh)),
        delone.TetMesh.load(tmp_path / "a.npz"),
        delone.improve(mesh),
        delone.improve(mesh, boundary="surface"),
    ):
        assert again.holes.tolist() == [place]
    # What is emptied up to the outside has no faces around it.
    assert len(tetrahedralize(*nested(VOIDS["a body in a void"]), holes=[(1, 1, 1)]).holes) == 0
    # A hole that is asked for is one of them, whichever point was given.
    regions = tetrahedralize(*nested(VOIDS["two regions"]), holes=[(4, 4, 4)])
    assert len(regions.holes) == 1 and (np.abs(regions.holes - 4.5) < 1.5).all()
