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


def test_groups_of_med(tmp_path):
    path = tmp_path / "a.med"
    delone.io.write_mesh(path, MESH)
    found = meshio.read(path)
    groups = {}
    for i, block in enumerate(found.cells):
        for row, tag in zip(block.data.tolist(), found.cell_data["cell_tags"][i], strict=True):
            for name in found.cell_tags.get(int(tag), []):
                groups.setdefault(name, set()).add(tuple(sorted(row)))
    assert groups == expected_groups(MESH)


@pytest.mark.parametrize("order", [1, 2])
def test_sets_of_inp(order, tmp_path):
    """Elements of regions, nodes of markers; facets are no elements, which need a section."""
    path = tmp_path / "a.inp"
    delone.io.write_mesh(path, MESH, order=order)
    found = meshio.read(path)
    assert [block.type for block in found.cells] == [{1: "tetra", 2: "tetra10"}[order]]
    expected = expected_groups(MESH)
    for name, (rows,) in found.cell_sets.items():
        own = named([("", found.cells[0].data[rows, :4])])[""]
        assert own == expected.pop(name.replace("_", " "))
    facets = MESH.to_meshio(order=order).cells[1].data
    for name, nodes in found.point_sets.items():
        number = int(name.removeprefix("marker_"))
        assert sorted(nodes) == np.unique(facets[MESH.face_markers == number]).tolist()
        del expected[f"marker {number}"]
    assert not expected


def test_numbers_of_inp_have_20_characters(tmp_path):
    """Longer ones are an error in Abaqus and CalculiX; others are exact."""
    path = tmp_path / "a.inp"
    random = np.random.default_rng(0)
    points = random.normal(size=(40, 3)) * 10.0 ** random.integers(-12, 12, (40, 3))
    points[:5] = [(-1 / 3e-100, 2 / 3, 0.1), (1e300 / 3, 1e-300 / 7, 4), *np.eye(3)]
    mesh = delone.Delaunay(points)
    delone.io.write_mesh(path, mesh)
    lines = path.read_text().partition("*NODE\n")[2].partition("*")[0].splitlines()
    words = [line.split(", ") for line in lines]
    assert max(len(word) for row in words for word in row) == 20
    found = np.array([row[1:] for row in words], dtype=float)
    assert np.abs(found / np.where(points, points, 1) - (points != 0)).max() < 5e-13
    short = np.array([[len(repr(x)) <= 20 for x in row] for row in points.tolist()])
    assert short.any() and np.array_equal(found[short], points[short])


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


LABELS = np.arange(len(FACES)) // 2 - 3
LABELED = tetrahedralize(POINTS, FACES, face_markers=LABELS, regions=[(0.5, 0.5, 0.5, 0), SEEDS[1]])


def named(kinds):
    """Rows by their group as its name says, of (name, rows) pairs."""
    return {kind: set(map(tuple, np.sort(rows, axis=1).tolist())) for kind, rows in kinds}


def expected_groups(mesh):
    found = {}
    for kind, rows, values in (
        ("region", mesh.simplices, mesh.region),
        ("marker", mesh.input_faces, mesh.face_markers),
    ):
        found |= named((f"{kind} {own}", rows[values == own]) for own in np.unique(values).tolist())
    return found


@pytest.mark.parametrize("mesh", [MESH, LABELED], ids=["above 0", "also below"])
def test_groups_of_msh_4(mesh, tmp_path):
    path = tmp_path / "a.msh"
    delone.io.write_mesh(path, mesh, version="4.1")
    assert path.read_bytes().split(b"\n")[1] == b"4.1 1 8"
    found = meshio.read(path)
    assert np.array_equal(found.points, mesh.points)
    rows = {}
    names = {(int(tag), int(n)): name for name, (tag, n) in found.field_data.items()}
    assert min(tag for tag, _ in names) > 0
    for block, tags in zip(found.cells, found.cell_data["gmsh:physical"], strict=True):
        ndim = 3 if block.type == "tetra" else 2
        for tag in np.unique(tags).tolist():
            rows.setdefault(names[tag, ndim], []).append(block.data[tags == tag])
    assert named((name, np.concatenate(own)) for name, own in rows.items()) == expected_groups(mesh)
    if mesh is MESH:
        assert all(name.split()[1] == str(tag) for (tag, _), name in names.items())


@pytest.mark.parametrize(
    ("suffix", "options"),
    [(".msh", {"version": "4.1"}), (".msh", {"version": "2.2"}), (".med", {})],
    ids=["4.1", "2.2", "med"],
)
@pytest.mark.parametrize("mesh", [MESH, LABELED], ids=["above 0", "also below"])
def test_gmsh_reads_groups(mesh, suffix, options, tmp_path):
    gmsh = pytest.importorskip("gmsh")
    path = tmp_path / f"a{suffix}"
    delone.io.write_mesh(path, mesh, **options)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        model = gmsh.model
        tags, places, _ = model.mesh.getNodes()
        assert np.array_equal(places.reshape(-1, 3)[np.argsort(tags)], mesh.points)
        found = {}
        for ndim, tag in model.getPhysicalGroups():
            rows = [
                corners.reshape(-1, ndim + 1).astype(int) - 1
                for entity in model.getEntitiesForPhysicalGroup(ndim, tag)
                for corners in model.mesh.getElements(ndim, entity)[2]
            ]
            found |= named([(model.getPhysicalName(ndim, tag), np.concatenate(rows))])
    finally:
        gmsh.finalize()
    expected = expected_groups(mesh)
    if options != {"version": "4.1"}:
        # Without a number there is no group there.
        expected.pop("marker 0", None)
    assert found == expected


def test_gmsh_reads_references_of_medit(tmp_path):
    gmsh = pytest.importorskip("gmsh")
    path = tmp_path / "a.mesh"
    delone.io.write_mesh(path, MESH)
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        found = {}
        for ndim, tag in gmsh.model.getEntities():
            (corners,) = gmsh.model.mesh.getElements(ndim, tag)[2]
            kind = {2: "marker", 3: "region"}[ndim]
            found |= named([(f"{kind} {tag}", corners.reshape(-1, ndim + 1).astype(int) - 1)])
    finally:
        gmsh.finalize()
    assert found == expected_groups(MESH)


@pytest.mark.parametrize("version", ["2.2", "4.1"])
@pytest.mark.parametrize("binary", [False, True])
def test_groups_of_surfaces_are_face_markers(version, binary, tmp_path):
    """A file of Gmsh, in which some entities are in a group, some in two, and some in none."""
    gmsh = pytest.importorskip("gmsh")
    path = tmp_path / "a.msh"
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        # In version 2.2, that would leave out all groups.
        gmsh.option.setNumber("Mesh.SaveAll", version == "4.1")
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("Mesh.MshFileVersion", float(version))
        gmsh.model.add("box")
        for face in range(12):
            gmsh.model.addDiscreteEntity(2, face + 1)
            if face == 0:
                gmsh.model.mesh.addNodes(2, 1, range(1, 9), POINTS[:8].ravel())
            gmsh.model.mesh.addElementsByType(face + 1, 2, [face + 1], FACES[face] + 1)
        gmsh.model.addPhysicalGroup(2, [1, 2, 3], 31, "low")
        gmsh.model.addPhysicalGroup(2, [4, 5], 32, "marker 7")
        if version == "4.1":
            gmsh.model.addPhysicalGroup(2, [5, 6], 33)
        else:
            gmsh.model.addPhysicalGroup(2, range(6, 13), 33)
        gmsh.write(str(path))
    finally:
        gmsh.finalize()
    expected = np.array([31, 31, 31, 7, 7, 33] + [0 if version == "4.1" else 33] * 6)
    found = read_mesh(path)
    assert keyed(found.simplices, found.markers) == keyed(FACES[:12], expected)
    mesh = tetrahedralize(path)
    assert keyed(mesh.input_faces, mesh.face_markers) == keyed(FACES[:12], expected)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".mesh", ".smesh", ".msh"])
def test_markers_of_surfaces_come_back(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    if suffix == ".smesh":
        delone.io.write_mesh(path, MESH)
    else:
        name = {".mesh": "medit:ref", ".msh": "gmsh:physical"}.get(suffix, "marker")
        cells = [("vertex", [[0], [3]]), ("triangle", FACES[:5]), ("triangle", FACES[5:])]
        values = {name: [np.array([99, 99]), MARKERS[:5], MARKERS[5:]]}
        if suffix == ".msh":
            cells, values[name] = cells[1:], values[name][1:]
            values["gmsh:geometrical"] = values[name]
        module = {".msh": meshio.gmsh, ".vtu": meshio.vtu, ".vtk": meshio.vtk}.get(suffix)
        own = meshio.Mesh(POINTS, cells, cell_data=values)
        if suffix == ".msh":
            module.write(path, own, "2.2")
        elif suffix == ".mesh":
            meshio.medit.write(
                path, meshio.Mesh(POINTS, cells[1:], cell_data={name: values[name][1:]})
            )
        else:
            module.write(path, own)
    found = read_mesh(path)
    assert keyed(found.simplices, found.markers) == keyed(FACES, MARKERS)


def test_markers_of_objects(tmp_path):
    pyvista = pytest.importorskip("pyvista")
    cells = [("vertex", [[0]]), ("triangle", FACES[:5]), ("triangle", FACES[5:])]
    values = {"marker": [np.array([9]), MARKERS[:5], MARKERS[5:]]}
    tags = {"gmsh:physical": values["marker"]}
    surface = pyvista.PolyData.from_regular_faces(POINTS, FACES)
    surface.cell_data["marker"] = MARKERS.astype(float)
    both = pyvista.PolyData(POINTS, faces=surface.faces, lines=[2, 0, 3], verts=[1, 0])
    both.cell_data["marker"] = np.concatenate(([77, 78], MARKERS))
    grid = surface.cast_to_unstructured_grid()
    for given in (
        meshio.Mesh(POINTS, cells, cell_data=values),
        meshio.Mesh(POINTS, cells, cell_data=tags),
        surface,
        both,
        grid,
    ):
        mesh = tetrahedralize(given)
        assert keyed(mesh.input_faces, mesh.face_markers) == WALLS
        assert (tetrahedralize(given, face_markers=MARKERS * 0).face_markers == 0).all()
    surface.cell_data["marker"] = MARKERS + 0.5
    with pytest.raises(delone.DtypeError, match="face_markers must hold integers"):
        tetrahedralize(surface)


def test_versions_are_those_of_msh(tmp_path):
    with pytest.raises(delone.FileFormatError, match=r"\.vtu files have no version"):
        delone.io.write_mesh(tmp_path / "a.vtu", MESH, version="4.1")
    with pytest.raises(delone.InputError, match=r"version must be one of '2\.2', '4\.1'"):
        delone.io.write_mesh(tmp_path / "a.msh", MESH, version="3")
    plain = tetrahedralize(POINTS, FACES)
    for version in ("2.2", "4.1"):
        delone.io.write_mesh(tmp_path / "a.msh", plain, version=version)
        assert (tmp_path / "a.msh").read_bytes().split(b"\n")[1].startswith(version.encode())
        found = read_mesh(tmp_path / "a.msh").simplices
        # Version 4.1 has one group after the other.
        order = np.argsort(plain.region, kind="stable") if version == "4.1" else slice(None)
        assert np.array_equal(found, plain.simplices[order])


@pytest.mark.parametrize("version", ["2.2", "4.1"])
def test_heights_and_markers_of_triangles_in_msh(version, tmp_path):
    path = tmp_path / "a.msh"
    flat = delone.mesh([(0, 0), (2, 0), (2, 2), (0, 2)], max_area=0.5, segment_markers=[4, 4, 0, 6])
    values = np.arange(flat.npoints) / 8
    delone.io.write_mesh(path, flat, z=values, attributes={"u": 2 * values}, version=version)
    found = delone.io.read_points(path, attributes=["u"])
    assert np.array_equal(found.points, flat.points) and np.array_equal(found.z, values)
    assert np.array_equal(found.attributes["u"], 2 * values)
    assert np.array_equal(np.sort(read_mesh(path).simplices), np.sort(flat.simplices))


QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4)])
TOP = np.array([(1, 5, 7), (1, 7, 3)])


@pytest.mark.parametrize("suffix", [".vtu", ".vtk", ".mesh", ".msh"])
def test_markers_of_polygons_that_are_divided(suffix, tmp_path):
    path = tmp_path / f"a{suffix}"
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    name = {".mesh": "medit:ref", ".msh": "gmsh:physical"}.get(suffix, "marker")
    values = {name: [np.arange(5) + 11, np.array([16, 17])]}
    if suffix == ".msh":
        values["gmsh:geometrical"] = values[name]
    given = meshio.Mesh(corners, [("quad", QUADS), ("triangle", TOP)], cell_data=values)
    if suffix == ".msh":
        meshio.gmsh.write(path, given, "2.2")
    else:
        given.write(path)
    mesh = tetrahedralize(path)
    assert mesh.volumes.sum() == pytest.approx(1)
    expected = {11: 2, 12: 2, 13: 2, 14: 2, 15: 2, 16: 1, 17: 1}
    assert dict(zip(*np.unique(mesh.face_markers, return_counts=True), strict=True)) == expected
    for number, quad in enumerate(QUADS.tolist(), 11):
        rows = mesh.input_faces[mesh.face_markers == number]
        places = {tuple(place) for place in mesh.points[rows].reshape(-1, 3).tolist()}
        assert places == {tuple(place) for place in corners[quad].tolist()}
