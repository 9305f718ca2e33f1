"""Files of the classes that are written by their parts alone, read back value by value."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone.io import read_mesh, write_mesh

meshio = pytest.importorskip("meshio")

# Sixteenths are exact in single precision, as binary STL has them.
FLAT = np.random.default_rng(1).integers(0, 16, (40, 2)) / 16
SOLID = np.random.default_rng(2).integers(0, 64, (40, 3)) / 16
SEPARATE = [".vtu", ".msh", ".xdmf", ".ply", ".obj", ".stl"]


def hull() -> delone.ConvexHull:
    return delone.ConvexHull(SOLID)


def periodic() -> delone.PeriodicDelaunay:
    return delone.PeriodicDelaunay(FLAT, (1, 1))


def regular() -> delone.RegularTriangulation:
    return delone.RegularTriangulation(FLAT, np.arange(40) / 1e3)


def regular_solid() -> delone.RegularTriangulation:
    return delone.RegularTriangulation(SOLID, np.arange(40) / 1e3)


def tetmesh() -> delone.TetMesh:
    return delone.improve(delone.Delaunay(SOLID))


def lifted(points: Any, z: Any = 0.0) -> Any:
    return points if points.shape[1] == 3 else np.column_stack((points, np.zeros(len(points)) + z))


def values_of(found: Any, name: str) -> Any:
    return np.concatenate([np.ravel(block) for block in found.cell_data[name]])


@pytest.mark.parametrize("make", [hull, periodic, regular])
@pytest.mark.parametrize("suffix", [*SEPARATE, ".inp"])
def test_triangles(make: Any, suffix: str, tmp_path: Path) -> None:
    if suffix == ".xdmf":
        pytest.importorskip("h5py")
    mesh, file = make(), tmp_path / f"a{suffix}"
    if make is periodic and suffix == ".inp":
        with pytest.raises(delone.FileFormatError, match="share no points"):
            write_mesh(file, mesh)
        return
    write_mesh(file, mesh)
    parts = mesh._parts()
    corners = lifted(parts.points)[parts.simplices]
    found = meshio.read(file)
    assert np.array_equal(lifted(found.points)[found.cells_dict["triangle"]], corners)
    if suffix != ".stl":
        assert np.array_equal(lifted(found.points), lifted(parts.points))
        assert np.array_equal(found.cells_dict["triangle"], parts.simplices)
    if suffix in (".vtu", ".msh", ".xdmf"):
        for name, values in parts.of_simplices.items():
            assert np.array_equal(values_of(found, name), values)
        for name, values in parts.of_points.items():
            assert np.array_equal(np.ravel(found.point_data[name]), values)
    if suffix in (".vtu", ".msh", ".ply", ".obj"):
        again = read_mesh(file)
        assert np.array_equal(np.column_stack((again.points, again.z)), lifted(parts.points))
        assert np.array_equal(again.simplices, parts.simplices)


@pytest.mark.parametrize("make", [tetmesh, regular_solid])
@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".xdmf", ".med", ".inp", ".su2"])
def test_tetrahedra(make: Any, suffix: str, tmp_path: Path) -> None:
    if suffix in (".xdmf", ".med"):
        pytest.importorskip("h5py")
    mesh, file = make(), tmp_path / f"a{suffix}"
    write_mesh(file, mesh)
    found = meshio.read(file)
    assert np.array_equal(found.points, mesh.points)
    order = [0, 2, 1, 3] if suffix == ".med" else [0, 1, 2, 3]
    assert np.array_equal(found.cells_dict["tetra"], mesh.simplices[:, order])
    if make is tetmesh and suffix in (".vtu", ".msh", ".xdmf"):
        assert np.array_equal(values_of(found, "region"), mesh.region)
        angles = mesh.quality().smallest_dihedral
        assert np.array_equal(values_of(found, "smallest_dihedral"), angles)


def test_the_boundary_of_tetrahedra_in_su2(tmp_path: Path) -> None:
    mesh, file = tetmesh(), tmp_path / "a.su2"
    write_mesh(file, mesh)
    found = meshio.read(file)
    assert np.array_equal(found.get_cells_type("tetra"), mesh.simplices)
    faces = found.get_cells_type("triangle")
    assert {frozenset(face) for face in faces.tolist()} == {
        frozenset(face) for face in mesh.boundary.tolist()
    }
    assert len(faces) == len(mesh.boundary)
    a, b, c = (mesh.points[faces[:, k]] for k in range(3))
    # The volume inside, if all faces are seen from outside.
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(mesh.volumes.sum())
    marker = np.concatenate(
        [
            tags
            for block, tags in zip(found.cells, found.cell_data["su2:tag"], strict=True)
            if block.type == "triangle"
        ]
    )
    assert (marker == 0).all()


def test_the_boundary_around_a_hole_in_su2(tmp_path: Path) -> None:
    """Not the edges of the hull: they are edges of no triangle here."""
    square = [(0.0, 0), (4, 0), (4, 4), (0, 4), (2, 1)]
    ring = [(0, 4), (4, 1), (1, 2), (2, 3), (3, 0)]
    mesh = delone.ConstrainedDelaunay(square, ring, boundary="outline")
    assert len(mesh.convex_hull) == 4
    write_mesh(tmp_path / "a.su2", mesh)
    lines = meshio.read(tmp_path / "a.su2").get_cells_type("line")
    assert {frozenset(pair) for pair in lines.tolist()} == {frozenset(pair) for pair in ring}


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson"])
def test_periodic_tables(suffix: str, tmp_path: Path) -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    mesh, file = periodic(), tmp_path / f"a{suffix}"
    weights = np.arange(mesh.nsimplex) / 3
    write_mesh(file, mesh, attributes={"w": weights})
    found = geopandas.read_file(file)
    drawn = shapely.get_coordinates(found.geometry).reshape(len(found), 4, 2)
    assert np.array_equal(drawn[:, :3], mesh.corners)
    assert np.array_equal(found["w"], weights)


def test_heights_and_values_of_periodic_points_are_those_of_their_rows(tmp_path: Path) -> None:
    mesh = periodic()
    z, weight = np.arange(40) / 3, np.arange(40) / 7
    write_mesh(tmp_path / "a.vtu", mesh, z=z, attributes={"weight": weight})
    found = meshio.read(tmp_path / "a.vtu")
    row = found.point_data["row"]
    assert np.array_equal(row.reshape(-1, 3), mesh.simplices)
    assert np.array_equal(found.points[:, 2], z[row])
    assert np.array_equal(found.point_data["z"], z[row])
    assert np.array_equal(found.point_data["weight"], weight[row])
    with pytest.raises(delone.ShapeError):
        write_mesh(tmp_path / "b.vtu", mesh, z=np.zeros(3 * mesh.nsimplex))


@pytest.mark.parametrize(
    ("make", "suffix", "why"),
    [
        (hull, ".su2", "surfaces"),
        (hull, ".gpkg", "surfaces"),
        (hull, ".ele", "surfaces"),
        (hull, ".svg", "surfaces"),
        (periodic, ".su2", "share no points"),
        (periodic, ".ele", "share no points"),
        (periodic, ".png", "share no points"),
        (tetmesh, ".stl", "tetrahedra"),
        (tetmesh, ".gpkg", "tetrahedra"),
        (tetmesh, ".ply", "tetrahedra"),
    ],
)
def test_what_a_format_has_no_place_for(make: Any, suffix: str, why: str, tmp_path: Path) -> None:
    with pytest.raises(delone.FileFormatError, match=why):
        write_mesh(tmp_path / f"a{suffix}", make())
    assert not list(tmp_path.iterdir())


def test_edges_that_are_not_written(tmp_path: Path) -> None:
    with pytest.raises(delone.FileFormatError, match="write its triangles"):
        write_mesh(tmp_path / "a.vtu", periodic(), edges=True)
    with pytest.raises(delone.FileFormatError, match="z must be None"):
        write_mesh(tmp_path / "a.vtu", hull(), z=np.zeros(40))
    assert not list(tmp_path.iterdir())


def test_a_hull_has_a_picture(tmp_path: Path) -> None:
    pytest.importorskip("pyvista")
    write_mesh(tmp_path / "a.png", hull())
    assert (tmp_path / "a.png").read_bytes()[1:4] == b"PNG"


def test_regions_of_constrained_triangles_in_xdmf(tmp_path: Path) -> None:
    pytest.importorskip("h5py")
    corners = [(0.0, 0), (1, 0), (1, 1), (0, 1)]
    mesh = delone.ConstrainedDelaunay(corners, [(1, 3)])
    write_mesh(tmp_path / "a.xdmf", mesh)
    found = meshio.read(tmp_path / "a.xdmf")
    assert values_of(found, "region").tolist() == mesh.region.tolist() == [0, 1]


class Duck:
    """A triangulation of another library: arrays, and the number of coordinates."""

    ndim = 2
    points = FLAT
    simplices = delone.Delaunay(FLAT).simplices


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".stl", ".su2", ".ele", ".gpkg"])
def test_triangulations_of_others(suffix: str, tmp_path: Path) -> None:
    pytest.importorskip("geopandas")
    write_mesh(tmp_path / f"a{suffix}", Duck())
    write_mesh(tmp_path / f"b{suffix}", delone.Delaunay(FLAT))
    if suffix != ".gpkg":  # which has the time in it
        assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()
