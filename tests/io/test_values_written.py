"""Every number of a file that is written, cell by cell and edge by edge, for every class.

Files are read by another library where there is one, else by their text; never by what wrote them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone.compat.scipy import Delaunay as DropIn
from delone.io import output_suffixes, write_mesh

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

meshio = pytest.importorskip("meshio")

POINTS = np.random.default_rng(5).random((40, 2)) * [3, 1 / 3] + [100, 1e-3]
SOLID = np.random.default_rng(6).random((20, 3)) / 3
# A square in two parts; the segments have markers that tell which is which, and no order.
CORNERS = [(0.0, 0), (1, 0), (1, 1), (0, 1), (0.375, 0), (0.375, 1)]
SEGMENTS = [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)]
MARKERS = [7, 3, 11, 2, 13, 5, 17]


def quality_mesh() -> delone.Mesh:
    return delone.mesh((CORNERS, SEGMENTS), max_area=0.05, segment_markers=MARKERS)


def constrained() -> delone.ConstrainedDelaunay:
    return delone.ConstrainedDelaunay(CORNERS, SEGMENTS)


PLANE = {
    "Delaunay": lambda: delone.Delaunay(POINTS),
    "duplicates": lambda: delone.Delaunay(np.concatenate([POINTS, POINTS[:3]])),
    "ConstrainedDelaunay": constrained,
    "Mesh": quality_mesh,
    "RegularTriangulation": lambda: delone.RegularTriangulation(POINTS, np.arange(40) / 1e4),
    "drop-in": lambda: DropIn(POINTS),
}
SPACE = {
    "Delaunay": lambda: delone.Delaunay(SOLID),
    "TetMesh": lambda: delone.improve(delone.Delaunay(SOLID)),
}
PICTURES = {".png", ".svg"}
MESHIO = [".vtu", ".msh", ".xdmf", ".inp", ".ply", ".obj", ".vtk", ".mesh"]


def heights(mesh: Any) -> np.ndarray[Any, Any]:
    return np.linspace(-1, 1 / 3, len(mesh.points))


def by_edge(pairs: Any, values: Any) -> dict[frozenset[int], int]:
    """The value of each edge, whichever way it goes."""
    found = {frozenset(p): int(v) for p, v in zip(np.asarray(pairs).tolist(), values, strict=True)}
    assert len(found) == len(pairs)
    return found


def of_kind(found: Any, name: str, kind: str) -> Any:
    """The values of cells of one kind."""
    return np.concatenate(
        [
            np.asarray(values)
            for block, values in zip(found.cells, found.cell_data[name], strict=True)
            if block.type == kind
        ]
    )


def test_every_format_is_looked_at() -> None:
    others = {".su2", ".med", ".node", ".ele", ".poly", ".gpkg", ".geojson", ".npz", ".stl"}
    surfaces = {".xml", ".landxml"}  # in tests/terrain
    surfaces |= {".off", ".smesh", ".face"}  # in test_solids
    surfaces |= {".glb", ".json"}  # in test_gltf and test_cityjson
    assert {*MESHIO, *others, *surfaces, *PICTURES} == set(output_suffixes())


@pytest.mark.parametrize("deep", [False, True])
@pytest.mark.parametrize("name", PLANE)
@pytest.mark.parametrize("suffix", MESHIO)
def test_by_meshio(suffix: str, name: str, deep: bool, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / f"a{suffix}"
    z = heights(mesh) if deep else None
    write_mesh(file, mesh, z=z)
    found = meshio.read(file)
    # Numbers of INP have 20 characters.
    close = {"rtol": 1e-14 if suffix == ".inp" else 0}
    np.testing.assert_allclose(found.points[:, :2], mesh.points, **close)
    if deep or found.points.shape[1] == 3:
        np.testing.assert_allclose(found.points[:, 2], heights(mesh) * deep, **close)
    assert np.array_equal(found.get_cells_type("triangle"), mesh.simplices)
    lines = found.get_cells_type("line")
    if not isinstance(mesh, delone.Mesh) or suffix in {".ply", ".obj"}:
        assert len(lines) == 0
        if suffix in {".vtu", ".msh"} and name == "ConstrainedDelaunay":
            assert np.array_equal(of_kind(found, "region", "triangle"), mesh.region)
        return
    assert len(set(mesh.region.tolist())) == 2
    if suffix == ".inp":
        assert len(lines) == 0
        return
    edges = by_edge(mesh.segments, mesh.segment_markers)
    assert set(edges.values()) == set(MARKERS)
    if suffix == ".mesh":
        assert by_edge(lines, of_kind(found, "medit:ref", "line")) == edges
        return
    if suffix == ".msh":
        for tag in ("gmsh:physical", "gmsh:geometrical"):
            assert by_edge(lines, of_kind(found, tag, "line")) == edges
            assert np.array_equal(of_kind(found, tag, "triangle"), mesh.region + 1)
        return
    assert by_edge(lines, of_kind(found, "marker", "line")) == edges
    assert np.array_equal(of_kind(found, "region", "triangle"), mesh.region)
    assert (of_kind(found, "marker", "triangle") == 0).all()
    assert (of_kind(found, "region", "line") == -1).all()
    if suffix == ".vtu":
        assert np.array_equal(found.point_data["marker"], mesh.point_markers)


@pytest.mark.parametrize("name", PLANE)
def test_vtu_by_vtk(name: str, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    mesh, file = PLANE[name](), tmp_path / "a.vtu"
    write_mesh(file, mesh, z=heights(mesh), attributes={"w": np.arange(len(mesh.points)) / 3})
    found = pyvista.read(file)
    assert np.array_equal(found.points, np.column_stack((mesh.points, heights(mesh))))
    assert np.array_equal(found.cells_dict[5], mesh.simplices)
    assert np.array_equal(found.point_data["z"], heights(mesh))
    assert np.array_equal(found.point_data["w"], np.arange(len(mesh.points)) / 3)
    if isinstance(mesh, delone.Mesh):
        kinds = found.celltypes
        marks = np.asarray(found.cell_data["marker"])
        edges = by_edge(mesh.segments, mesh.segment_markers)
        assert by_edge(found.cells_dict[3], marks[kinds == 3]) == edges
        assert np.array_equal(np.asarray(found.cell_data["region"])[kinds == 5], mesh.region)


@pytest.mark.parametrize("suffix", [".vtu", ".xdmf"])
@pytest.mark.parametrize("name", PLANE)
def test_attributes_of_points_and_triangles(name: str, suffix: str, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / f"a{suffix}"
    given = {"p": np.arange(len(mesh.points)) / 3, "t": np.arange(len(mesh.simplices)) / 7}
    write_mesh(file, mesh, attributes=given)
    found = meshio.read(file)
    assert np.array_equal(found.point_data["p"], given["p"])
    assert np.array_equal(of_kind(found, "t", "triangle"), given["t"])
    if len(found.cells) > 1:
        assert np.isnan(of_kind(found, "t", "line")).all()


@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
@pytest.mark.parametrize("name", ["Delaunay", "ConstrainedDelaunay", "Mesh"])
def test_edges_by_meshio(name: str, suffix: str, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / f"a{suffix}"
    write_mesh(file, mesh, edges=True)
    found = meshio.read(file)
    assert np.array_equal(found.get_cells_type("line"), mesh.edges)
    if name != "Delaunay":
        flags = by_edge(mesh.edges, of_kind(found, "segment", "line"))
        parts = {frozenset(pair) for pair in mesh.segments.tolist()}
        assert {edge for edge, flag in flags.items() if flag} == parts
        assert set(flags.values()) == {0, 1}


def single(points: Any) -> bool:
    return bool((points.astype(np.float32) == points).all())


@pytest.mark.parametrize("name", PLANE)
def test_stl_triangle_by_triangle(name: str, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / "a.stl"
    write_mesh(file, mesh, z=heights(mesh))
    found = meshio.read(file)
    drawn = found.points[found.get_cells_type("triangle")]
    assert np.array_equal(drawn, np.column_stack((mesh.points, heights(mesh)))[mesh.simplices])
    content = file.read_bytes()
    if content.startswith(b"solid"):
        words = [line.split()[1:] for line in content.decode().splitlines() if "vertex" in line]
        assert np.array_equal(np.array(words, float).reshape(-1, 3, 3), drawn)


def numbers(file: Path) -> Iterator[list[float]]:
    """The rows of a text file."""
    return ([float(word) for word in line.split()] for line in file.read_text().splitlines())


@pytest.mark.parametrize("name", PLANE)
def test_su2_by_its_text(name: str, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / "a.su2"
    write_mesh(file, mesh)
    lines = iter(file.read_text().splitlines())
    m, n = len(mesh.simplices), len(mesh.points)
    assert [next(lines), next(lines)] == ["NDIME= 2", f"NELEM= {m}"]
    rows = [[int(word) for word in next(lines).split()] for _ in range(m)]
    assert rows == [[5, *s, t] for t, s in enumerate(mesh.simplices.tolist())]
    assert next(lines) == f"NPOIN= {n}"
    rows = [next(lines).split() for _ in range(n)]
    assert [[float(x), float(y), int(i)] for x, y, i in rows] == [
        [*p, i] for i, p in enumerate(mesh.points.tolist())
    ]
    found: dict[frozenset[int], int] = {}
    for _ in range(int(next(lines).removeprefix("NMARK= "))):
        marker = int(next(lines).removeprefix("MARKER_TAG= "))
        assert marker not in found.values()
        for _ in range(int(next(lines).removeprefix("MARKER_ELEMS= "))):
            kind, u, v = (int(word) for word in next(lines).split())
            assert kind == 3
            assert frozenset((u, v)) not in found
            found[frozenset((u, v))] = marker
    assert list(lines) == []
    if isinstance(mesh, delone.Mesh):
        every = by_edge(mesh.segments, mesh.segment_markers)
        rim = {frozenset(pair) for pair in mesh.boundary.tolist()}
        assert found == {edge: marker for edge, marker in every.items() if edge in rim}
        assert set(found.values()) == set(MARKERS) - {17}
    else:
        assert found == by_edge(mesh.convex_hull, [0] * len(mesh.convex_hull))


def test_su2_leaves_out_segments_that_are_not_of_the_boundary(tmp_path: Path) -> None:
    """Also where a part of the boundary has their marker."""
    mesh = delone.mesh((CORNERS, SEGMENTS), segment_markers=[7, 3, 11, 2, 13, 5, 7])
    write_mesh(tmp_path / "a.su2", mesh)
    lines = (tmp_path / "a.su2").read_text().splitlines()
    start = lines.index("MARKER_TAG= 7") + 1
    count = int(lines[start].removeprefix("MARKER_ELEMS= "))
    pairs = [line.split()[1:] for line in lines[start + 1 : start + 1 + count]]
    rim = {frozenset(pair) for pair in mesh.boundary.tolist()}
    marked = by_edge(mesh.segments, mesh.segment_markers)
    wanted = {edge for edge, marker in marked.items() if marker == 7 and edge in rim}
    assert {frozenset(map(int, pair)) for pair in pairs} == wanted
    assert len(pairs) == len(wanted) < sum(marker == 7 for marker in marked.values())


@pytest.mark.parametrize("deep", [False, True])
@pytest.mark.parametrize("name", PLANE)
def test_files_of_triangle_by_their_text(name: str, deep: bool, tmp_path: Path) -> None:
    mesh = PLANE[name]()
    z = heights(mesh) if deep else None
    n, m = len(mesh.points), len(mesh.simplices)
    for suffix in (".node", ".ele", ".poly"):
        write_mesh(tmp_path / f"a{suffix}", mesh, z=z)
    marked = isinstance(mesh, delone.Mesh)
    columns = [np.arange(n), *mesh.points.T]
    columns += [heights(mesh)] if deep else []
    columns += [mesh.point_markers] if marked else []
    nodes = [[n, 2, int(deep), int(marked)], *np.column_stack(columns).tolist()]
    assert list(numbers(tmp_path / "a.node")) == nodes
    columns = [np.arange(m), mesh.simplices]
    columns += [mesh.region] if marked else []
    wanted = [[m, 3, int(marked)], *np.column_stack(columns).tolist()]
    assert list(numbers(tmp_path / "a.ele")) == wanted
    poly = list(numbers(tmp_path / "a.poly"))
    assert poly[: n + 1] == nodes
    pairs = getattr(mesh, "segments", mesh.convex_hull)
    markers = mesh.segment_markers if marked else [0] * len(pairs)
    assert poly[n + 1] == [len(pairs), 1]
    rows = np.array(poly[n + 2 : n + 2 + len(pairs)], dtype=int)
    assert rows[:, 0].tolist() == list(range(len(pairs)))
    assert by_edge(rows[:, 1:3], rows[:, 3]) == by_edge(pairs, markers)
    assert poly[n + 2 + len(pairs) :] == [[0]]


@pytest.mark.parametrize("deep", [False, True])
@pytest.mark.parametrize("name", PLANE)
@pytest.mark.parametrize("suffix", [".gpkg", ".geojson"])
def test_geometries_row_by_row(suffix: str, name: str, deep: bool, tmp_path: Path) -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    mesh, file = PLANE[name](), tmp_path / f"a{suffix}"
    weights = np.arange(len(mesh.simplices)) / 3
    write_mesh(file, mesh, z=heights(mesh) if deep else None, attributes={"w": weights})
    found = geopandas.read_file(file)
    assert np.array_equal(found[["v0", "v1", "v2"]].to_numpy(), mesh.simplices)
    assert np.array_equal(found["w"], weights)
    drawn = shapely.get_coordinates(found.geometry, include_z=deep).reshape(len(found), 4, -1)
    places = np.column_stack((mesh.points, heights(mesh))) if deep else mesh.points
    assert np.array_equal(drawn[:, :3], places[mesh.simplices])
    assert np.array_equal(drawn[:, 3], drawn[:, 0])
    if isinstance(mesh, delone.ConstrainedDelaunay | delone.Mesh):
        assert np.array_equal(found["region"], mesh.region)
        write_mesh(file, mesh, edges=True)
        found = geopandas.read_file(file)
        flags = by_edge(found[["v0", "v1"]].to_numpy(), found["segment"])
        assert len(flags) == len(mesh.edges)
        assert {edge for edge, flag in flags.items() if flag} == {
            frozenset(pair) for pair in mesh.segments.tolist()
        }


@pytest.mark.parametrize("name", ["Delaunay", "duplicates", "ConstrainedDelaunay", "Mesh"])
def test_npz_by_numpy(name: str, tmp_path: Path) -> None:
    mesh, file = PLANE[name](), tmp_path / "a.npz"
    write_mesh(file, mesh, z=heights(mesh))
    with np.load(file) as found:
        assert np.array_equal(found["points"], mesh.points)
        assert np.array_equal(found["simplices"], mesh.simplices)
        assert np.array_equal(found["neighbors"], mesh.neighbors)
        assert np.array_equal(found["z"], heights(mesh))
        if name == "Mesh":
            assert by_edge(found["ends"], found["line_markers"]) == by_edge(SEGMENTS, MARKERS)
            assert np.array_equal(found["point_markers"], mesh.point_markers)
            assert np.array_equal(found["region"], mesh.region)
        if name == "ConstrainedDelaunay":
            assert by_edge(found["segments"], [0] * 7) == by_edge(mesh.segments, [0] * 7)
    if name == "Mesh":
        again = delone.Mesh.load(file)
        edges = by_edge(mesh.segments, mesh.segment_markers)
        assert by_edge(again.segments, again.segment_markers) == edges


@pytest.mark.parametrize("edges", [False, True])
@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
@pytest.mark.parametrize("name", SPACE)
def test_space_by_meshio(name: str, suffix: str, edges: bool, tmp_path: Path) -> None:
    mesh, file = SPACE[name](), tmp_path / f"a{suffix}"
    kind, cells = ("line", mesh.edges) if edges else ("tetra", mesh.simplices)
    weights = np.arange(len(cells)) / 3
    write_mesh(file, mesh, edges=edges, attributes={"w": weights})
    found = meshio.read(file)
    assert np.array_equal(found.points, mesh.points)
    assert np.array_equal(found.get_cells_type(kind), cells)
    assert np.array_equal(of_kind(found, "w", kind), weights)
    if isinstance(mesh, delone.TetMesh) and not edges:
        assert np.array_equal(of_kind(found, "region", kind), mesh.region)
        angles = mesh.quality().smallest_dihedral
        assert np.array_equal(of_kind(found, "smallest_dihedral", kind), angles)
