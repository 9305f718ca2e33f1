"""Elements of second order: a node in the middle of each edge, once, in the order of each library.

The orders are those of the manuals: VTK, Gmsh, Abaqus, TetGen, Triangle, DOLFINx (UFC).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone.exchange.dolfinx import to_dolfinx_arrays
from delone.exchange.parts import Parts
from delone.io import read_mesh, read_points, write_mesh
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

meshio = pytest.importorskip("meshio")

VTK: dict[int, tuple[tuple[int, int], ...]] = {
    2: ((0, 1),),
    3: ((0, 1), (1, 2), (0, 2)),
    4: ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)),
}
UFC = {3: ((1, 2), (0, 2), (0, 1)), 4: ((2, 3), (1, 3), (1, 2), (0, 3), (0, 2), (0, 1))}
TETGEN = ((2, 3), (0, 3), (0, 1), (1, 2), (1, 3), (0, 2))
TRIANGLE = ((1, 2), (0, 2), (0, 1))

SHELLS = solids.joined(solids.box((0, 0, 0), (4, 4, 4)), solids.box((1, 1, 1), (2, 2, 2)))
SEEDS = [(0.5, 0.5, 0.5, 7), (1.5, 1.25, 1.5, 3)]
INSIDE = np.random.default_rng(5).uniform(0.2, 3.8, (60, 3))
SOLID = delone.improve(
    delone.tetrahedralize(
        *SHELLS,
        face_markers=np.arange(24) // 2 + 1,
        regions=SEEDS,
        extra_points=INSIDE[~((INSIDE > 0.8) & (INSIDE < 2.2)).all(axis=1)],
    )
)
FLAT = delone.mesh([(0, 0), (2, 0), (2, 2), (0, 2)], max_area=0.5, segment_markers=[4, 5, 0, 6])
# The last rows are vertices of nothing.
WITH_DUPLICATES = delone.Delaunay([*INSIDE.tolist(), INSIDE[0].tolist(), INSIDE[7].tolist()])
HULL = delone.ConvexHull(INSIDE)
MESHES = {"solid": SOLID, "flat": FLAT, "duplicates": WITH_DUPLICATES, "hull": HULL}


def lifted(points: Any) -> Any:
    return points if points.shape[1] == 3 else np.column_stack((points, np.zeros(len(points))))


def nodes_of(mesh: Any) -> Any:
    """The points, and then the middle of each edge."""
    edges = np.unique(
        np.concatenate([np.sort(mesh.simplices[:, pair]) for pair in VTK[len(mesh.simplices[0])]]),
        axis=0,
    )
    points = lifted(mesh.points)
    return np.concatenate((points, (points[edges[:, 0]] + points[edges[:, 1]]) / 2))


def check_cells(points: Any, cells: Any, table: Any, corners: Any = None) -> None:
    """Each further node is in the middle of its edge; the corners are those given."""
    width = cells.shape[1] - len(table)
    if corners is not None:
        assert np.array_equal(cells[:, :width], corners)
    for k, (a, b) in enumerate(table):
        middle = (points[cells[:, a]] + points[cells[:, b]]) / 2
        assert np.array_equal(points[cells[:, width + k]], middle)


@pytest.mark.parametrize("name", MESHES)
def test_meshio(name: str) -> None:
    mesh = MESHES[name]
    found = mesh.to_meshio(order=2)
    assert np.array_equal(found.points, nodes_of(mesh))
    if hasattr(mesh, "edges"):
        middles = lifted(mesh.points)[mesh.edges].mean(axis=1)
        assert np.array_equal(found.points[len(mesh.points) :], middles)
    check_cells(found.points, found.cells[0].data, VTK[mesh.simplices.shape[1]], mesh.simplices)
    plain = mesh.to_meshio()
    assert [block.type for block in plain.cells] == [
        {"triangle6": "triangle", "tetra10": "tetra", "line3": "line"}[block.type]
        for block in found.cells
    ]
    if len(found.cells) > 1:
        facets = plain.cells[1].data
        check_cells(found.points, found.cells[1].data, VTK[facets.shape[1]], facets)
        # Nodes of facets are nodes of elements.
        assert np.isin(found.cells[1].data, found.cells[0].data).all()
    for key, values in plain.cell_data.items():
        for one, other in zip(values, found.cell_data[key], strict=True):
            np.testing.assert_array_equal(one, other)


def test_nodes_of_shared_faces_are_the_same() -> None:
    cells = SOLID.to_meshio(order=2).cells[0].data
    nodes: dict[tuple[int, ...], set[frozenset[int]]] = {}
    for row in cells.tolist():
        for k in range(4):
            corners = [c for c in range(4) if c != k]
            face = tuple(sorted(row[c] for c in corners))
            middle = [4 + e for e, pair in enumerate(VTK[4]) if k not in pair]
            nodes.setdefault(face, set()).add(frozenset(row[m] for m in middle))
    assert all(len(each) == 1 for each in nodes.values())
    assert len(np.unique(cells)) == len(SOLID.edges) + len(np.unique(SOLID.simplices))


def test_markers_of_middles() -> None:
    found = FLAT.to_meshio(order=2)
    marker = found.point_data["marker"]
    assert np.array_equal(marker[: FLAT.npoints], FLAT.point_markers)
    expected = {
        tuple(sorted(pair)): m
        for pair, m in zip(FLAT.segments.tolist(), FLAT.segment_markers.tolist(), strict=True)
    }
    assert marker[FLAT.npoints :].tolist() == [
        expected.get(tuple(pair), 0) for pair in FLAT.edges.tolist()
    ]


def test_segments_that_are_edges_of_no_triangle() -> None:
    ring = [(0, 0), (6, 0), (6, 6), (0, 6), (2, 2), (4, 2), (4, 4), (2, 4), (3, 3), (3, 3.5)]
    pairs = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (8, 9)]
    # The segment in the hole is between the first points, and its middle the last node.
    ring, pairs = ring[::-1], [(9 - a, 9 - b) for a, b in pairs]
    mesh = delone.ConstrainedDelaunay(ring, pairs, holes=[(2.5, 2.25)], boundary="outline")
    found = mesh.to_meshio(order=2)
    check_cells(found.points, found.cells[0].data, VTK[3], mesh.simplices)
    check_cells(found.points, found.cells[1].data, VTK[2], np.array(pairs))
    assert found.points[-1].tolist() == [3, 3.25, 0]


@pytest.mark.parametrize("name", MESHES)
def test_pyvista(name: str) -> None:
    pytest.importorskip("pyvista")
    mesh = MESHES[name]
    found = mesh.to_pyvista(order=2)
    assert np.array_equal(found.points, nodes_of(mesh))
    kind = {3: 22, 4: 24}[mesh.simplices.shape[1]]
    check_cells(found.points, found.cells_dict[kind], VTK[mesh.simplices.shape[1]], mesh.simplices)
    sizes = found.compute_cell_sizes()["Volume" if kind == 24 else "Area"]
    plain = mesh.to_pyvista().compute_cell_sizes()["Volume" if kind == 24 else "Area"]
    assert sizes == pytest.approx(plain)
    if name == "solid":
        assert np.array_equal(found.cell_data["region"], mesh.region)


@pytest.mark.parametrize("name", ["solid", "flat", "duplicates"])
def test_scikit_fem(name: str) -> None:
    """The solution of second order is exact, on meshes of both orders, node by node."""
    skfem = pytest.importorskip("skfem")
    from skfem.models.poisson import laplace

    mesh = MESHES[name]
    ndim = mesh.ndim
    found, plain = mesh.to_skfem(order=2), mesh.to_skfem()
    assert type(found).__name__ == {2: "MeshTri2", 3: "MeshTet2"}[ndim]
    used = np.unique(mesh.simplices).max() + 1
    nodes = nodes_of(mesh)[:, :ndim]
    nodes = np.concatenate((nodes[:used], nodes[len(mesh.points) :]))
    assert np.array_equal(found.doflocs.T, nodes)
    assert np.array_equal(found.facets, plain.facets)
    assert (found.boundaries or {}).keys() == (plain.boundaries or {}).keys()
    for key, facets in (plain.boundaries or {}).items():
        assert np.array_equal(found.boundaries[key], facets)
    for key, cells in (plain.subdomains or {}).items():
        assert np.array_equal(found.subdomains[key], cells)
    element = {2: skfem.ElementTriP2, 3: skfem.ElementTetP2}[ndim]()
    exact = (nodes**2).sum(axis=1) + nodes[:, 0] * nodes[:, 1] - 3 * nodes[:, 1]
    one = skfem.LinearForm(lambda v, w: -2.0 * ndim * v)
    measure = skfem.Functional(lambda w: 1.0 + 0 * w.x[0])
    for each in (found, plain):
        basis = skfem.Basis(each, element)
        size = mesh.volumes.sum() if ndim == 3 else mesh.areas.sum()
        assert measure.assemble(basis) == pytest.approx(size)
        given = basis.get_dofs().flatten()
        x = np.zeros(basis.N)
        x[given] = exact[given]
        solved = skfem.solve(
            *skfem.condense(laplace.assemble(basis), one.assemble(basis), x=x, D=given)
        )
        assert solved == pytest.approx(exact, abs=1e-8)


@pytest.mark.parametrize("name", MESHES)
def test_dolfinx(name: str) -> None:
    mesh = MESHES[name]
    found = to_dolfinx_arrays(mesh, order=2)
    assert np.array_equal(lifted(found["x"]), nodes_of(mesh))
    check_cells(found["x"], found["cells"], UFC[mesh.simplices.shape[1]], mesh.simplices)
    plain = to_dolfinx_arrays(mesh)
    for key in ("facet_tags", "cell_tags"):
        assert np.array_equal(found[key], plain[key])
    width = plain["facets"].shape[1]
    table = UFC[3] if width == 3 else VTK[2]
    check_cells(found["x"], found["facets"], table, plain["facets"])
    assert np.isin(found["facets"], found["cells"]).all()


def test_edges_of_graphs() -> None:
    graph = delone.graphs.gabriel(INSIDE)
    found = graph.to_meshio(order=2)
    assert [block.type for block in found.cells] == ["line3"]
    check_cells(found.points, found.cells[0].data, VTK[2], graph.edges)
    pytest.importorskip("pyvista")
    assert set(graph.to_pyvista(order=2).celltypes) == {21}


def test_the_largest_and_smallest_coordinates() -> None:
    big, small = 1.7e308, 5e-324
    parts = Parts(np.array([(big, small), (big / 2, 3 * small), (-big, 0)]), np.array([(0, 1, 2)]))
    found = to_dolfinx_arrays(parts, order=2)["x"]
    assert found[3:].tolist() == [[0.75 * big, 2 * small], [0, 0], [-0.25 * big, 2 * small]]


def values(mesh: Any) -> dict[str, Any]:
    total = len(nodes_of(mesh))
    return {
        "of_points": np.arange(len(mesh.points)) / 4,
        "of_nodes": np.arange(total) / 8,
        "of_cells": np.arange(len(mesh.simplices)) * 1.0,
    }


FILES: list[tuple[str, dict[str, Any]]] = [
    (".vtu", {}),
    (".vtk", {}),
    (".xdmf", {}),
    (".msh", {"version": "2.2"}),
    (".msh", {"version": "4.1"}),
    (".med", {}),
    (".inp", {}),
]
# The nodes of tetrahedra of MED, whose first three corners are turned.
MED = {"tetra10": [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]}


@pytest.mark.parametrize(("suffix", "options"), FILES, ids=str)
@pytest.mark.parametrize("name", MESHES)
def test_files(name: str, suffix: str, options: Any, tmp_path: Path) -> None:
    mesh, path = MESHES[name], tmp_path / f"a{suffix}"
    given = values(mesh)
    marked = name in ("solid", "flat")
    if suffix in (".med", ".inp"):
        given = {}
    elif suffix == ".msh" and marked:
        del given["of_cells"]
    write_mesh(path, mesh, order=2, attributes=given, **options)
    expected = mesh.to_meshio(order=2)
    if suffix == ".xdmf":
        # meshio reads no mixed cells of second order; VTK does.
        reader = pytest.importorskip("vtkmodules.vtkIOXdmf2").vtkXdmfReader()
        reader.SetFileName(str(path))
        reader.Update()
        pyvista = pytest.importorskip("pyvista")
        found = pyvista.to_meshio(pyvista.wrap(reader.GetOutputDataObject(0)))
    else:
        found = meshio.read(path)
    assert np.array_equal(lifted(found.points), expected.points)
    # Facets are no elements in INP.
    for block in expected.cells[: 1 if suffix == ".inp" else 2]:
        rows = block.data
        if suffix == ".med":
            rows = rows[:, MED.get(block.type, slice(None))]
        ours = found.cells_dict[block.type]
        if suffix == ".msh":  # by groups
            ours, rows = ours[np.lexsort(ours.T)], rows[np.lexsort(rows.T)]
        assert np.array_equal(ours, rows)
    if "of_nodes" in given:
        assert np.array_equal(np.ravel(found.point_data["of_nodes"]), given["of_nodes"])
        of_points = np.ravel(found.point_data["of_points"])
        assert np.array_equal(of_points[: len(mesh.points)], given["of_points"])
        if hasattr(mesh, "edges"):
            means = given["of_points"][mesh.edges].mean(axis=1)
            assert np.array_equal(of_points[len(mesh.points) :], means)
    if "of_cells" in given:
        cells = np.concatenate([np.ravel(each) for each in found.cell_data["of_cells"]])
        assert np.array_equal(cells[: len(mesh.simplices)], given["of_cells"])


@pytest.mark.parametrize(("suffix", "options"), [FILES[3], FILES[4], FILES[5]], ids=str)
@pytest.mark.parametrize("order", [1, 2])
def test_gmsh(order: int, suffix: str, options: Any, tmp_path: Path) -> None:
    """Gmsh computes positive Jacobians and the volumes of regions and areas of groups."""
    gmsh = pytest.importorskip("gmsh")
    path = tmp_path / f"a{suffix}"
    write_mesh(path, SOLID, order=order, **options)
    sizes = {}
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        model = gmsh.model
        for ndim, tag in model.getPhysicalGroups():
            total = 0.0
            for entity in model.getEntitiesForPhysicalGroup(ndim, tag):
                for kind in model.mesh.getElementTypes(ndim, entity):
                    at, weights = model.mesh.getIntegrationPoints(kind, "Gauss4")
                    _, found, _ = model.mesh.getJacobians(kind, at, entity)
                    assert found.min() > 0
                    total += float((found.reshape(-1, len(weights)) * weights).sum())
            sizes[model.getPhysicalName(ndim, tag)] = total
    finally:
        gmsh.finalize()
    assert sizes.pop("region 7") == pytest.approx(63)
    assert sizes.pop("region 3") == pytest.approx(1)
    assert sizes == pytest.approx({f"marker {k}": 16 if k <= 6 else 1 for k in range(1, 13)})


def test_vtk_reads_markers_of_legacy_files(tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    write_mesh(tmp_path / "a.vtk", SOLID)
    found = pyvista.read(tmp_path / "a.vtk")
    assert found.cell_data["region"][: SOLID.nsimplex].tolist() == SOLID.region.tolist()
    assert found.cell_data["marker"][SOLID.nsimplex :].tolist() == SOLID.face_markers.tolist()


@pytest.mark.parametrize(
    ("name", "types"),
    [
        ("solid", {1: ["C3D4"], 2: ["C3D10"]}),
        ("flat", {1: ["CPS3"], 2: ["CPE6"]}),
        ("hull", {1: ["S3"], 2: ["STRI65"]}),
    ],
)
def test_types_and_surfaces_of_inp(name: str, types: Any, tmp_path: Path) -> None:
    texts = []
    for order in (1, 2):
        path = tmp_path / "a.inp"
        write_mesh(path, MESHES[name], order=order)
        text = path.read_text()
        found = [line.partition("=")[2] for line in text.splitlines() if "TYPE=" in line]
        assert [each for each in found if "NAME" not in each] == types[order]
        texts.append(text.partition("*SURFACE")[2])
    assert texts[0] == texts[1]
    assert bool(texts[0]) == (name != "hull")


@pytest.mark.parametrize(("mesh", "table"), [(SOLID, TETGEN), (FLAT, TRIANGLE)], ids=str)
def test_files_of_tetgen_and_triangle(mesh: Any, table: Any, tmp_path: Path) -> None:
    for suffix in (".node", ".ele"):
        write_mesh(tmp_path / f"a{suffix}", mesh, order=2)
    nodes = read_points(tmp_path / "a.node")
    places = nodes.points if nodes.z is None else np.column_stack((nodes.points, nodes.z))
    assert np.array_equal(lifted(places), nodes_of(mesh))
    lines = (tmp_path / "a.ele").read_text().splitlines()
    width = mesh.simplices.shape[1] + len(table)
    assert lines[0] == f"{len(mesh.simplices)} {width} 1"
    rows = np.array([line.split() for line in lines[1:]], dtype=int)
    check_cells(places, rows[:, 1:-1], table, mesh.simplices)
    assert np.array_equal(rows[:, -1], mesh.region)
    # Corners are read, and nodes of edges are points.
    assert np.array_equal(read_mesh(tmp_path / "a.ele").simplices, mesh.simplices)


def test_heights(tmp_path: Path) -> None:
    tin = TIN.from_points([(0, 0, 1), (4, 0, 2), (0, 4, 4), (4, 4, 9)])
    for found in (tin.to_meshio(order=2), tin.to_pyvista(order=2)):
        assert np.array_equal(found.points[:4], tin.xyz)
        assert np.array_equal(found.points[4:], tin.xyz[tin.edges].mean(axis=1))
    write_mesh(tmp_path / "a.vtu", FLAT, z=FLAT.points[:, 0], order=2)
    again = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(again.points[:, 2], again.points[:, 0])
    assert np.array_equal(again.point_data["z"], again.points[:, 0])
    write_mesh(tmp_path / "a.node", FLAT, z=FLAT.points[:, 0], order=2)
    rows = np.loadtxt(tmp_path / "a.node", skiprows=1)
    assert np.array_equal(rows[:, 3], rows[:, 1])


def test_orders_that_do_not_exist(tmp_path: Path) -> None:
    for order in (0, 3, "2", True, 2.0, None):
        with pytest.raises(delone.InputError, match="order must be 1 or 2"):
            SOLID.to_meshio(order=order)
        with pytest.raises(delone.InputError, match="order must be 1 or 2"):
            write_mesh(tmp_path / "a.vtu", SOLID, order=order)
    for suffix in (".su2", ".mesh", ".npz", ".smesh", ".face"):
        with pytest.raises(
            delone.FileFormatError, match=rf"\{suffix} files cannot store second-order elements"
        ):
            write_mesh(tmp_path / f"a{suffix}", SOLID, order=2)
    with pytest.raises(delone.FileFormatError, match="edges cannot store second-order"):
        write_mesh(tmp_path / "a.vtu", SOLID, edges=True, order=2)
    separate = delone.PeriodicDelaunay(np.random.default_rng(0).random((20, 2)), (1, 1))
    with pytest.raises(delone.InputError, match="share no points"):
        separate.to_meshio(order=2)
    write_mesh(tmp_path / "a.vtu", FLAT, order=2)
    with pytest.raises(delone.FileFormatError, match="second order"):
        read_mesh(tmp_path / "a.vtu")
    with pytest.raises(delone.ShapeError, match="nodes"):
        write_mesh(tmp_path / "a.vtu", SOLID, order=2, attributes={"a": np.zeros(3)})
