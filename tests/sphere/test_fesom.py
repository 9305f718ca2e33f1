"""Meshes of FESOM in text and NetCDF files: triangles, and the median dual around nodes."""

from __future__ import annotations

import pickle
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import sphere
from delone.sphere import Grid, Overlaps

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


def written(folder: Path, lonlat: NDArray[np.float64], triangles: NDArray[np.int64]) -> Path:
    rows = [f"{k + 1} {x!r} {y!r} 0" for k, (x, y) in enumerate(lonlat.tolist())]
    (folder / "nod2d.out").write_text("\n".join([str(len(rows)), *rows]))
    rows = [" ".join(map(str, row)) for row in (triangles + 1).tolist()]
    (folder / "elem2d.out").write_text("\n".join([str(len(rows)), *rows]))
    return folder


def mesh(count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    xyz = np.random.default_rng(3).normal(size=(count, 3))
    made = sphere.Delaunay(xyz=xyz)
    lon, lat = np.arctan2(xyz[:, 1], xyz[:, 0]), np.arctan2(xyz[:, 2], np.hypot(*xyz.T[:2]))
    return np.degrees(np.column_stack((lon, lat))), made.simplices.astype(np.int64)


@pytest.mark.parametrize("part", [False, True])
def test_cells_around_nodes_share_triangles_in_thirds(tmp_path: Path, part: bool) -> None:
    lonlat, triangles = mesh(400)
    # Some clockwise, and a sea with islands.
    triangles[::3] = triangles[::3, ::-1]
    if part:
        triangles = triangles[np.random.default_rng(1).random(len(triangles)) < 0.7]
    folder = written(tmp_path, lonlat, triangles)
    nodes, cells = Grid.from_fesom(folder), Grid.from_fesom(folder, "faces")
    assert nodes.ncells == 400
    assert cells.ncells == len(triangles)
    assert nodes.areas.sum() == pytest.approx(cells.areas.sum(), rel=1e-13)
    assert nodes.validate().overlapping.size == 0
    table = Overlaps(cells, nodes).matrix.toarray()
    for node in range(400):
        assert set(np.flatnonzero(table[node] > 1e-12)) == set(
            np.flatnonzero((triangles == node).any(axis=1))
        )
    # By plane geometry a third each; on the sphere nearly so, for small triangles.
    small = np.flatnonzero(cells.areas < 0.01)
    for t in small[:50]:
        shares = table[triangles[t], t] / cells.areas[t]
        assert np.allclose(shares, 1 / 3, rtol=0, atol=0.03)


def radians_of_nodes(file: Any, lonlat: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
    """The mesh.diag.nc of before UGRID."""
    for name, size in (("nod2", len(lonlat)), ("elem", len(triangles)), ("n2", 2), ("n3", 3)):
        file.createDimension(name, size)
    file.createVariable("nodes", "f8", ("n2", "nod2"))[:] = np.radians(lonlat).T
    file.createVariable("elements", "i4", ("n3", "elem"))[:] = triangles.T + 1
    file.createVariable("nod_in_elem2D", "i4", ("nod2",))[:] = 0


def ugrid(file: Any, lonlat: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
    """The mesh.diag.nc of today."""
    for name, size in (("nod2", len(lonlat)), ("elem", len(triangles)), ("n3", 3)):
        file.createDimension(name, size)
    mesh = file.createVariable("fesom_mesh", "i4", ())
    mesh.cf_role, mesh.topology_dimension = "mesh_topology", np.int32(2)
    mesh.node_coordinates, mesh.face_node_connectivity = "lon lat", "face_nodes"
    mesh.face_dimension = "elem"
    for name, column, unit in zip(("lon", "lat"), lonlat.T, ("east", "north"), strict=True):
        variable = file.createVariable(name, "f8", ("nod2",))
        variable.units = f"degrees_{unit}"
        variable[:] = column
    faces = file.createVariable("face_nodes", "i4", ("n3", "elem"))
    faces.start_index = np.int32(1)
    faces[:] = triangles.T + 1


def triag_nodes(file: Any, lonlat: NDArray[np.float64], triangles: NDArray[np.int64]) -> None:
    """The files for CDO, without bounds."""
    for name, size in (("ncells", len(lonlat)), ("ntriags", len(triangles)), ("three", 3)):
        file.createDimension(name, size)
    for name, column in zip(("lon", "lat"), lonlat.T, strict=True):
        file.createVariable(name, "f8", ("ncells",))[:] = column
    file.createVariable("triag_nodes", "i4", ("ntriags", "three"))[:] = triangles + 1


@pytest.mark.parametrize("write", [radians_of_nodes, ugrid, triag_nodes])
def test_netcdf_files(tmp_path: Path, write: Any) -> None:
    netcdf = pytest.importorskip("netCDF4")
    xarray = pytest.importorskip("xarray")
    from delone.xarray import Regridder

    lonlat, triangles = mesh(300)
    triangles[::3] = triangles[::3, ::-1]
    triangles = triangles[np.random.default_rng(1).random(len(triangles)) < 0.8]
    x, y, z = sphere.Delaunay(lonlat=lonlat).points.T
    field = 2 + x * y + z
    with netcdf.Dataset(tmp_path / "mesh.nc", "w") as file:
        write(file, lonlat, triangles)
        dim = "ncells" if write is triag_nodes else "nod2"
        sea = file.createVariable("temp", "f4", (dim,))
        sea.mesh, sea.location = "fesom_mesh", "node"
        sea[:] = field
    ds = xarray.open_dataset(tmp_path / "mesh.nc")
    text = written(tmp_path, lonlat, triangles)
    expected = {kind: Grid.from_fesom(text, kind) for kind in ("nodes", "faces")}
    for kind, other in expected.items():
        made = Grid.from_dataset(ds, cells=kind)
        assert made.grid_shape == other.grid_shape
        # Of radians, the last bits differ.
        assert np.allclose(made.areas, other.areas, rtol=1e-9, atol=1e-13)
    default = Grid.from_dataset(ds)
    assert default.ncells == (len(triangles) if write is ugrid else 300)
    assert Grid.from_dataset(ds, name="temp").ncells == 300 or write is not ugrid
    # Values at nodes, not at the middles of the cells around them.
    nodes = Grid.from_dataset(ds, cells="nodes")
    assert np.allclose(nodes.centers_lonlat, lonlat, rtol=0, atol=1e-12)
    assert np.array_equal(expected["nodes"].centers_lonlat, lonlat)
    regridder = Regridder(ds, "10x10", method="normalized", cells="nodes")
    found = regridder(ds)
    assert found.temp.dims == ("lat", "lon")
    wanted = Overlaps(expected["nodes"], regridder.target).to_weights("normalized").apply(field)
    assert np.allclose(found.temp.values, wanted, rtol=1e-5, equal_nan=True)
    assert not {"nodes", "elements", "triag_nodes", "face_nodes"} & set(found.variables)
    linear = sphere.Weights.between(nodes, nodes, "linear").apply(field)
    assert np.allclose(linear, field, rtol=0, atol=1e-12)
    again = pickle.loads(pickle.dumps(nodes))
    nodes.save(tmp_path / "grid.npz")
    for other in (again, Grid.load(tmp_path / "grid.npz")):
        assert np.array_equal(other.centers_lonlat, nodes.centers_lonlat)
        assert np.array_equal(other.areas, nodes.areas)


def test_nodes_of_quadrilaterals_and_targets() -> None:
    xarray = pytest.importorskip("xarray")
    from delone.xarray import Regridder

    lon, lat = np.meshgrid(np.arange(0.0, 41, 10), np.arange(-20.0, 21, 10))
    at = np.arange(25).reshape(5, 5)
    faces = np.stack((at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]), axis=2).reshape(-1, 4)
    ds = xarray.Dataset(
        {
            "mesh": ((), 0, {"cf_role": "mesh_topology", "node_coordinates": "x y",
                             "face_node_connectivity": "faces"}),
            "faces": (("face", "four"), faces),
            "x": ("node", lon.ravel(), {"units": "degrees_east"}),
            "y": ("node", lat.ravel(), {"units": "degrees_north"}),
            "v": ("edge", np.zeros(3), {"mesh": "mesh", "location": "edge"}),
        }
    )  # fmt: skip
    nodes, cells = Grid.from_dataset(ds, cells="nodes"), Grid.from_dataset(ds)
    assert nodes.areas.sum() == pytest.approx(cells.areas.sum(), rel=1e-13)
    shares = Overlaps(cells, nodes).matrix.toarray()
    # A quarter of each face at a corner; at the middle node, a quarter of four.
    assert set(np.flatnonzero(shares[12])) == {5, 6, 9, 10}
    assert np.allclose(shares[0, 0], cells.areas[0] / 4, rtol=0.05)
    with pytest.raises(delone.InputError, match="the location 'edge', not node or face"):
        Grid.from_dataset(ds, name="v")
    found = Regridder("10x10", nodes)
    assert found.target_dims == ("cell",)
    cf = xarray.Dataset(coords={"lon": ("lon", [0.0, 1], {"units": "degrees_east"}),
                                "lat": ("lat", [0.0, 1], {"units": "degrees_north"})})  # fmt: skip
    with pytest.raises(delone.InputError, match="UGRID and FESOM meshes, and this is CF"):
        Grid.from_dataset(cf, infer_bounds=True, cells="nodes")
    with pytest.raises(delone.InputError, match="cells must be"):
        Grid.from_dataset(ds, cells="edges")
    with pytest.raises(delone.InputError, match="cells is for datasets"):
        Regridder("10x10", "10x10", cells="nodes")


def test_nodes_where_parts_touch_have_several_rings() -> None:
    xarray = pytest.importorskip("xarray")
    lon = [0.0, 10, 10, 0, -10, -10, 0, 30]
    lat = [0.0, 0, 10, 10, 0, -10, -10, 30]
    # Two squares that share node 0 only; one clockwise, with a corner repeated as padding.
    faces = [[0, 1, 2, 3, 3], [0, 6, 5, 4, 0]]
    ds = xarray.Dataset(
        {
            "mesh": ((), 0, {"cf_role": "mesh_topology", "node_coordinates": "x y",
                             "face_node_connectivity": "faces"}),
            "faces": (("face", "most"), faces),
            "x": ("node", lon, {"units": "degrees_east"}),
            "y": ("node", lat, {"units": "degrees_north"}),
        }
    )  # fmt: skip
    nodes, cells = Grid.from_dataset(ds, cells="nodes"), Grid.from_dataset(ds)
    corners, rings, starts = nodes.rings
    assert np.diff(starts).tolist() == [2, 1, 1, 1, 1, 1, 1, 0]
    assert (np.diff(rings) == 4).all()
    assert len(corners) == 32
    assert nodes.areas.sum() == pytest.approx(cells.areas.sum(), rel=1e-14)
    assert nodes.report.empty.tolist() == [7]
    shares = Overlaps(cells, nodes).matrix.toarray()
    assert (shares[0] > 0.2 * cells.areas).all()


@pytest.mark.parametrize("corners", [3, 4])
def test_fields_at_nodes_are_interpolated_on_the_mesh_itself(corners: int) -> None:
    xarray = pytest.importorskip("xarray")
    rng = np.random.default_rng(corners)
    lon, lat = np.meshgrid(np.arange(0.0, 61, 10), np.arange(-30.0, 31, 10))
    lon, lat = (part + rng.uniform(-2, 2, part.shape) for part in (lon, lat))
    at = np.arange(49).reshape(7, 7)
    faces = np.stack((at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]), axis=2).reshape(-1, 4)
    if corners == 3:
        # One diagonal in all of them: many triangles are not Delaunay.
        faces = np.concatenate((faces[:, :3], faces[:, [0, 2, 3]]))
    ds = xarray.Dataset(
        {
            "mesh": ((), 0, {"cf_role": "mesh_topology", "node_coordinates": "x y",
                             "face_node_connectivity": "faces"}),
            "faces": (("face", "most"), faces),
            "x": ("node", lon.ravel(), {"units": "degrees_east"}),
            "y": ("node", lat.ravel(), {"units": "degrees_north"}),
        }
    )  # fmt: skip
    source = Grid.from_dataset(ds, cells="nodes")
    target = Grid.from_lonlat(np.arange(5, 56, 3), np.arange(-25, 26, 3))
    weights = sphere.Weights.between(source, target, "bilinear")
    assert (weights.fractions == 1).all()
    own = {frozenset(face) for face in faces.tolist()}
    rows = np.split(weights.indices, weights.indptr[1:-1])
    assert all(any(set(row.tolist()) <= face for face in own) for row in rows)
    places = sphere.Delaunay(lonlat=source.centers_lonlat).points
    middles = sphere.Delaunay(lonlat=target.centers_lonlat).points
    assert np.abs(np.cross(weights.matrix @ places, middles)).max() < 1e-13
    if corners == 3:
        linear = sphere.Weights.between(source, target, "linear")
        assert not np.array_equal(linear.indices, weights.indices)


def test_centers_are_those_of_datasets() -> None:
    xarray = pytest.importorskip("xarray")
    lon, lat = np.meshgrid(np.arange(0.0, 50, 10), np.arange(0.0, 50, 10))
    x, y = np.meshgrid(np.arange(4.0, 44, 10), np.arange(6.0, 46, 10))
    ds = xarray.Dataset(
        coords={
            "lon": (("j", "i"), x, {"units": "degrees_east"}),
            "lat": (("j", "i"), y, {"units": "degrees_north"}),
            "lon_b": (("jb", "ib"), lon),
            "lat_b": (("jb", "ib"), lat),
        }
    )
    source = Grid.from_dataset(ds)
    assert np.array_equal(source.centers_lonlat, np.column_stack((x.ravel(), y.ravel())))
    target = Grid.from_lonlat([13, 15], [15, 17])
    weights = sphere.Weights.between(source, target, "bilinear")
    assert (weights.indices.tolist(), weights.values.tolist()) == ([5], [1.0])
    # Longitudes of more than a turn, as of ocean grids, are no mistake.
    wide = ds.assign_coords(
        lon=(("j", "i"), x + np.array([0, 0, 0, 360]), {"units": "degrees_east"})
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for method in ("bilinear", "linear", "nearest", "binned"):
            other = sphere.Weights.between(Grid.from_dataset(wide), target, method)
            mine = sphere.Weights.between(source, target, method)
            assert np.allclose(other.matrix.toarray(), mine.matrix.toarray(), atol=1e-12)


def test_what_is_refused(tmp_path: Path) -> None:
    lonlat, triangles = mesh(20)
    folder = written(tmp_path, lonlat, np.concatenate((triangles, triangles[:3])))
    with pytest.raises(delone.InputError, match="cells 0 and 36 overlap"):
        Grid.from_fesom(folder)
    with pytest.raises(delone.InputError, match="cells must be"):
        Grid.from_fesom(folder, "edges")
    (folder / "elem2d.out").write_text("3\n1 2 3\n")
    with pytest.raises(delone.FileFormatError, match="must have 3 rows of 3 numbers"):
        Grid.from_fesom(folder)
    (folder / "elem2d.out").write_text("1\n1 2 30\n")
    with pytest.raises(delone.DeloneError, match=r"elem2d\.out"):
        Grid.from_fesom(folder)
    (folder / "nod2d.out").write_text("many\n")
    with pytest.raises(delone.FileFormatError, match=r"nod2d\.out must be a table"):
        Grid.from_fesom(folder)
