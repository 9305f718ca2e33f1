"""Every function of `delone.exchange` on every kind of mesh, value by value."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
import pytest

import delone
from delone.exchange.dolfinx import to_dolfinx_arrays
from delone.exchange.geopandas import to_geopandas
from delone.exchange.matplotlib import to_matplotlib
from delone.exchange.meshio import TAGS, to_meshio
from delone.exchange.parts import Parts, boundary, boundary_segments, facet_segments, parts_of
from delone.exchange.polyhedra import polyhedra_to_pyvista
from delone.exchange.pyvista import to_pyvista
from delone.exchange.skfem import to_skfem

# Two squares side by side, the left one with a label and the side between them with a marker.
PLACES = np.array([(0.0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)])
SIDES = np.array([(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)])
MARKERS = np.array([11, 12, 13, 14, 15, 16, 99])


def two_squares() -> Parts:
    """Parts that are written by hand, each value with another number."""
    return Parts(
        PLACES,
        np.array([(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4)], dtype=np.int32),
        of_points={"height": np.arange(6) / 7},
        of_simplices={"region": np.array([3, 3, -1, -1]), "share": np.arange(4) / 3},
        segments=SIDES.astype(np.int32),
        of_segments={"marker": MARKERS, "length": np.arange(7) / 9},
        crs="EPSG:28992",
    )


def tetrahedra() -> Parts:
    mesh = delone.Delaunay(np.random.default_rng(1).random((30, 3)))
    values = {"region": np.arange(mesh.nsimplex) % 3, "size": mesh.volumes}
    return Parts(mesh.points, mesh.simplices, {"height": mesh.points[:, 2]}, values)


def surface() -> Parts:
    return delone.ConvexHull(np.random.default_rng(2).random((30, 3)))._parts()


def ring() -> Parts:
    return delone.ConvexHull(np.random.default_rng(3).random((30, 2)))._parts()


KINDS = {"triangle": two_squares, "tetra": tetrahedra, "surface": surface, "line": ring}


def in_space(points: Any) -> Any:
    return np.column_stack((points, np.zeros((len(points), 3 - points.shape[1]))))


@pytest.mark.parametrize("kind", KINDS)
def test_meshio(kind: str) -> None:
    pytest.importorskip("meshio")
    parts = KINDS[kind]()
    found = to_meshio(parts)
    assert np.array_equal(found.points, in_space(parts.points))
    first = found.cells[0]
    assert first.type == {"surface": "triangle"}.get(kind, kind)
    assert np.array_equal(first.data, parts.simplices)
    assert set(found.point_data) == set(parts.of_points)
    for name, values in parts.of_points.items():
        assert np.array_equal(found.point_data[name], values)
    for name, values in parts.of_simplices.items():
        assert np.array_equal(found.cell_data[name][0], values)
        assert found.cell_data[name][0].dtype == values.dtype
    if parts.segments is None:
        assert len(found.cells) == 1
        assert set(found.cell_data) == set(parts.of_simplices)


def test_segments_are_lines_of_meshio() -> None:
    pytest.importorskip("meshio")
    found = to_meshio(two_squares())
    assert [block.type for block in found.cells] == ["triangle", "line"]
    assert np.array_equal(found.cells[1].data, SIDES)
    data = {name: [block.tolist() for block in blocks] for name, blocks in found.cell_data.items()}
    assert data["region"] == [[3, 3, -1, -1], [-1] * 7]
    assert data["marker"] == [[0] * 4, MARKERS.tolist()]
    assert data["share"][0] == [0, 1 / 3, 2 / 3, 1]
    assert np.isnan(data["share"][1]).all()
    assert np.isnan(data["length"][0]).all()
    assert data["length"][1] == (np.arange(7) / 9).tolist()
    # The smallest region is tag 1.
    for tag in TAGS:
        assert data[tag] == [[5, 5, 1, 1], MARKERS.tolist()]


def test_without_markers_there_are_no_tags() -> None:
    pytest.importorskip("meshio")
    found = to_meshio(two_squares()._replace(of_segments={}))
    assert set(found.cell_data) == {"region", "share"}
    assert len(found.cells) == 2


def test_changes_do_not_reach_the_mesh() -> None:
    pytest.importorskip("meshio")
    pytest.importorskip("pyvista")
    mesh = delone.improve(delone.Delaunay(tetrahedra().points))
    first = mesh.points[0].copy()
    for found in (to_meshio(mesh), to_pyvista(mesh)):
        found.points[0] = 77
        found.cell_data["region"][0] = 5
    assert np.array_equal(mesh.points[0], first)
    assert (mesh.region == 0).all()


@pytest.mark.parametrize("kind", KINDS)
def test_pyvista(kind: str) -> None:
    pyvista = pytest.importorskip("pyvista")
    parts = KINDS[kind]()
    found = to_pyvista(parts)
    assert isinstance(found, pyvista.UnstructuredGrid if kind == "tetra" else pyvista.PolyData)
    assert np.array_equal(found.points, in_space(parts.points))
    if kind == "tetra":
        cells = found.cells_dict[10]
        # VTK's volumes have a sign.
        sizes = found.compute_cell_sizes(length=False, area=False)["Volume"]
        assert np.allclose(sizes, parts.of_simplices["size"], rtol=1e-9, atol=1e-15)
    elif kind == "line":
        cells = found.lines.reshape(-1, 3)[:, 1:]
    else:
        cells = found.regular_faces
    assert np.array_equal(cells, parts.simplices)
    for name, values in parts.of_simplices.items():
        assert np.array_equal(found.cell_data[name], values)
    for name, values in parts.of_points.items():
        assert np.array_equal(found.point_data[name], values)


def test_a_hull_in_pyvista_is_closed_and_seen_from_outside() -> None:
    pytest.importorskip("pyvista")
    hull = delone.ConvexHull(np.random.default_rng(2).random((30, 3)))
    found = to_pyvista(hull)
    assert found.clean().is_manifold
    assert found.volume == pytest.approx(hull.volume)


@pytest.mark.parametrize("kind", ["triangle", "tetra"])
def test_scikit_fem(kind: str) -> None:
    skfem = pytest.importorskip("skfem")
    parts = KINDS[kind]()
    found = to_skfem(parts)
    assert isinstance(found, skfem.MeshTri if kind == "triangle" else skfem.MeshTet)
    assert np.array_equal(found.p.T, parts.points)
    assert np.array_equal(found.t.T, parts.simplices)
    region = parts.of_simplices["region"]
    assert set(found.subdomains) == {f"region {value}" for value in region.tolist()}
    for value in np.unique(region):
        rows = found.subdomains[f"region {value}"]
        assert np.array_equal(np.sort(rows), np.flatnonzero(region == value))
    element = skfem.ElementTriP1() if kind == "triangle" else skfem.ElementTetP1()
    total = skfem.Functional(lambda w: 1 + 0 * w.x[0]).assemble(skfem.Basis(found, element))
    assert total == pytest.approx(2 if kind == "triangle" else parts.of_simplices["size"].sum())


def test_segments_are_boundaries_of_scikit_fem() -> None:
    pytest.importorskip("skfem")
    # The first segment is a diagonal of nothing: it is in a hole.
    loose = np.concatenate([[(0, 3)], SIDES]).astype(np.int32)
    marked = {"marker": np.concatenate([[7], MARKERS])}
    found = to_skfem(two_squares()._replace(segments=loose, of_segments=marked))
    assert set(found.boundaries) == {f"marker {value}" for value in MARKERS.tolist()}
    for pair, value in zip(SIDES.tolist(), MARKERS.tolist(), strict=True):
        (facet,) = found.boundaries[f"marker {value}"]
        assert sorted(found.facets[:, facet].tolist()) == sorted(pair)
    found = to_skfem(two_squares()._replace(segments=loose, of_segments={}))
    drawn = found.facets[:, found.boundaries["segments"]].T
    assert {frozenset(pair) for pair in drawn.tolist()} == {
        frozenset(pair) for pair in SIDES.tolist()
    }


def test_tags_and_named_boundaries_are_those_of_markers() -> None:
    pytest.importorskip("meshio")
    pytest.importorskip("skfem")
    square = [(0, 0), (6, 0), (6, 6), (0, 6)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    constrained, marked = delone.ConstrainedDelaunay(*square), delone.mesh(square)
    solid = delone.improve(delone.Delaunay(tetrahedra().points))
    for mesh in (constrained, marked, solid):
        tagged = mesh is marked
        assert set(TAGS).isdisjoint(mesh.to_meshio().cell_data) is not tagged
        wanted = {"marker 0"} if tagged else set() if mesh is solid else {"segments"}
        assert set(mesh.to_skfem().boundaries or {}) == wanted


@pytest.mark.parametrize("kind", ["triangle", "surface", "tetra"])
def test_dolfinx(kind: str) -> None:
    parts = KINDS[kind]()
    found = to_dolfinx_arrays(parts)
    assert list(found) == ["cells", "x", "cell_tags", "facets", "facet_tags"]
    assert np.array_equal(found["cells"], parts.simplices)
    assert np.array_equal(found["x"], parts.points)
    region = parts.of_simplices.get("region", np.zeros(len(parts.simplices)))
    assert np.array_equal(found["cell_tags"], region)
    if kind == "triangle":
        assert np.array_equal(found["facets"], SIDES)
        assert np.array_equal(found["facet_tags"], MARKERS)
    else:
        assert found["facets"].shape == (0, parts.simplices.shape[1] - 1)
        assert found["facet_tags"].shape == (0,)
    wanted = ["int64", "float64", "int32", "int64", "int32"]
    assert [array.dtype.name for array in found.values()] == wanted


def test_segments_in_a_hole_are_no_facets() -> None:
    square = [(0.0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (3, 1), (3, 3), (1, 3)]
    around = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (4, 6)]
    mesh = delone.ConstrainedDelaunay(square, around, holes=[(2.5, 1.5), (1.5, 2.5)])
    parts = mesh._parts()
    assert parts.segments is not None
    pairs, rows = facet_segments(parts)
    assert pairs.tolist() == [list(pair) for pair in around[:-1]]
    assert np.array_equal(parts.segments[rows], pairs)
    assert len(boundary_segments(parts)[0]) == len(mesh.boundary) == 8
    assert len(to_dolfinx_arrays(mesh)["facets"]) == 8


@pytest.mark.parametrize("ndim", [2, 3])
def test_boundary(ndim: int) -> None:
    mesh = delone.Delaunay(np.random.default_rng(4).random((50, ndim)))
    rows = boundary(mesh.simplices)

    def turned(facets: Any) -> set[tuple[int, ...]]:
        """Facets from their smallest corner on."""
        first = facets.argmin(axis=1)[:, None]
        order = (first + np.arange(ndim)) % ndim if ndim == 3 else np.arange(2)[None]
        return set(map(tuple, np.take_along_axis(facets, order + 0 * first, axis=1).tolist()))

    assert turned(rows) == turned(mesh.convex_hull)
    assert len(rows) == len(mesh.convex_hull)


def test_matplotlib() -> None:
    pytest.importorskip("matplotlib")
    found = to_matplotlib(two_squares())
    assert np.array_equal(found.triangles, two_squares().simplices)
    assert np.array_equal(np.column_stack((found.x, found.y)), PLACES)


@pytest.mark.parametrize("kind", ["triangle", "surface", "line"])
def test_geopandas(kind: str) -> None:
    pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    parts = KINDS[kind]()
    found = to_geopandas(parts)
    width = parts.simplices.shape[1]
    names = [f"v{k}" for k in range(width)]
    assert found.columns.tolist() == [*names, *parts.of_simplices, "geometry"]
    assert np.array_equal(found[names], parts.simplices)
    for name, values in parts.of_simplices.items():
        assert np.array_equal(found[name], values)
    drawn = shapely.get_coordinates(found.geometry, include_z=parts.points.shape[1] == 3)
    drawn = drawn.reshape(len(found), -1, parts.points.shape[1])
    assert np.array_equal(drawn[:, :width], parts.points[parts.simplices])
    assert (found.geom_type == ("LineString" if kind == "line" else "Polygon")).all()
    assert found.crs == parts.crs
    assert to_geopandas(parts, "EPSG:4326").crs == "EPSG:4326"


@pytest.mark.parametrize("kind", ["triangle", "line"])
def test_geometries_are_made_in_blocks(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between them Ctrl-C is heard."""
    pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    parts = KINDS[kind]()
    whole = to_geopandas(parts)
    name = "polygons" if kind == "triangle" else "linestrings"
    make, sizes = getattr(shapely, name), []

    def counted(corners: Any) -> Any:
        sizes.append(len(corners))
        return make(corners)

    monkeypatch.setattr(shapely, name, counted)
    monkeypatch.setattr(delone._base.blocks, "ROWS", 3)
    assert to_geopandas(parts).equals(whole)
    assert sum(sizes) == len(whole) > 3 >= max(sizes)


def test_polyhedra() -> None:
    pytest.importorskip("pyvista")
    sites = np.random.default_rng(5).random((6, 3))
    diagram = delone.Voronoi(sites, clip=((0, 0, 0), (1, 1, 1)))
    cells = [diagram.cell(i) for i in range(6)]
    found = polyhedra_to_pyvista(iter(cells))
    assert (found.celltypes == 42).all()
    start = 0
    for i, cell in enumerate(cells):
        own = found.get_cell(i)
        places = np.asarray(own.points)
        assert {tuple(p) for p in places.tolist()} == {tuple(p) for p in cell.vertices.tolist()}
        faces = [np.asarray(face.points).tolist() for face in own.faces]
        assert faces == [cell.vertices[face].tolist() for face in cell.faces]
        end = start + len(cell.vertices)
        assert np.array_equal(found.points[start:end], cell.vertices)
        start = end
    assert polyhedra_to_pyvista([]).n_cells == 0


def test_arrays_alone_are_enough() -> None:
    pytest.importorskip("meshio")
    given = PLACES.tolist(), [(0, 1, 4), (0, 4, 5)]
    assert np.array_equal(to_meshio(given).cells_dict["triangle"], given[1])
    raised = [(x, y, 1.0) for x, y in given[0]], given[1]
    assert np.array_equal(to_meshio(raised).points, raised[0])
    assert np.array_equal(to_dolfinx_arrays(given)["cell_tags"], [0, 0])
    assert parts_of(delone.triangulate_polygon(PLACES)).simplices.shape == (4, 3)


@pytest.mark.parametrize(
    ("given", "error"),
    [
        (5, delone.DtypeError),
        ((PLACES, [(0, 1, 6)]), delone.InputError),
        ((PLACES, [(0, 1)]), delone.InputError),
        ((PLACES, [(0, 1, 2, 3)]), delone.InputError),
        ((PLACES[:, :1], [(0, 1, 2)]), delone.InputError),
    ],
)
def test_what_is_no_mesh_is_refused(given: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        to_dolfinx_arrays(given)


@pytest.mark.parametrize(
    ("make", "kind"),
    [
        (to_skfem, "surface"),
        (to_skfem, "line"),
        (to_matplotlib, "surface"),
        (to_matplotlib, "tetra"),
        (to_geopandas, "tetra"),
        (to_dolfinx_arrays, "line"),
    ],
)
def test_kinds_that_a_library_does_not_have(make: Any, kind: str) -> None:
    for library in ("skfem", "matplotlib", "geopandas"):
        pytest.importorskip(library)
    with pytest.raises(delone.InputError, match=r"cannot be made of .*(surface|tetra|edges)"):
        make(KINDS[kind]())


@pytest.mark.parametrize(
    ("make", "library", "extra"),
    [
        (to_meshio, "meshio", "mesh"),
        (to_pyvista, "pyvista", "pyvista"),
        (to_skfem, "skfem", "fem"),
        (to_matplotlib, "matplotlib.tri", "plot"),
        (to_geopandas, "geopandas", "geo"),
        (to_geopandas, "shapely", "geo"),
        (polyhedra_to_pyvista, "pyvista", "pyvista"),
    ],
)
def test_missing_libraries(
    make: Any, library: str, extra: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(delone.MissingExtraError) as caught:
        make(two_squares())
    assert caught.value.extra == extra
