"""GLB, read again by VTK and, byte by byte, by the rules of the format."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

import delone
from delone.errors import FileFormatError
from delone.io import write_mesh
from delone.terrain import TIN

pyvista = pytest.importorskip("pyvista")

LOW = np.array([155_000.25, 463_000.5, 7.0])


def hill(**options) -> TIN:
    rng = np.random.default_rng(5)
    xy = np.concatenate(([(0, 0), (100, 0), (100, 100), (0, 100)], rng.uniform(0, 100, (200, 2))))
    z = 30 * np.exp(-((xy - 50) ** 2).sum(axis=1) / 900)
    return TIN.from_points(np.column_stack((xy, z)) + LOW, **options)


def opened(path):
    """The document and the accessors of a file, checked by the rules of the format."""
    data = path.read_bytes()
    magic, version, size = struct.unpack_from("<4sII", data)
    assert (magic, version, size) == (b"glTF", 2, len(data))
    length, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A and length % 4 == 0
    document = json.loads(data[20 : 20 + length])
    count, kind = struct.unpack_from("<II", data, 20 + length)
    assert kind == 0x004E4942 and count == document["buffers"][0]["byteLength"]
    body = data[28 + length :]
    assert len(body) == count
    arrays = []
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        assert view["byteOffset"] % 4 == 0
        dtype = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        part = body[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        values = np.frombuffer(part, dtype).reshape(-1, width)
        assert len(values) == accessor["count"]
        arrays.append(values)
    return document, arrays


def test_vtk_reads_the_triangles(tmp_path):
    tin, path = hill(crs="EPSG:28992", units="m"), tmp_path / "a höhe.glb"
    write_mesh(path, tin)
    (block,) = [each for each in pyvista.read(path).recursive_iterator() if each is not None]
    document, _ = opened(path)
    origin = np.array(document["nodes"][0]["extras"]["origin"])
    assert document["nodes"][0]["extras"]["crs"] == "EPSG:28992"
    assert "scale" not in document["nodes"][0]
    x, up, back = np.asarray(block.points, dtype=float).T
    corners = np.column_stack((x, -back, up)) + origin
    xyz = np.column_stack((tin.points, tin.z))
    # Rows are those of the surface, in order: all of its points have triangles.
    assert np.abs(corners - xyz).max() < 100 * 2**-24
    assert block.regular_faces.tolist() == tin.simplices.tolist()
    normals = np.asarray(block.point_data["NORMAL"])
    assert np.hypot(*normals[:, [0, 2]].T) ** 2 + normals[:, 1] ** 2 == pytest.approx(
        np.ones(len(normals)), rel=1e-6
    )
    assert (normals[:, 1] > 0).all()


def test_the_normals_are_upward_and_weighted_by_area(tmp_path):
    points = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (8, 0, 3), (8, 4, 3)]
    tin, path = TIN.from_points(points), tmp_path / "a.glb"
    write_mesh(path, tin)
    document, (position, normal, _) = opened(path)
    accessor = document["accessors"][0]
    assert accessor["min"] == position.min(axis=0).tolist()
    assert accessor["max"] == position.max(axis=0).tolist()
    slope = np.array([-3, 4, 0]) / 5
    for row, (x, _, _) in enumerate(points):
        if x != 4:
            assert normal[row] == pytest.approx((0, 1, 0) if x == 0 else slope, abs=1e-6)
        else:
            triangles = [k for k, rows in enumerate(tin.simplices) if row in rows]
            whole = sum((tin.normals[k] * tin.areas[k] / tin.normals[k, 2]) for k in triangles)
            expected = whole / np.linalg.norm(whole)
            assert normal[row] == pytest.approx(expected[[0, 2, 1]] * (1, 1, -1), abs=1e-6)


def test_only_points_with_triangles_are_written(tmp_path):
    hole = [(155_040, 463_040), (155_060, 463_040), (155_060, 463_060), (155_040, 463_060)]
    tin, path = hill(holes=[hole]), tmp_path / "a.glb"
    write_mesh(path, tin)
    _, (position, _, rows) = opened(path)
    used = np.unique(tin.simplices)
    assert len(used) < tin.npoints and len(position) == len(used)
    assert used[rows.reshape(-1, 3)].tolist() == tin.simplices.tolist()


@pytest.mark.filterwarnings("ignore::delone.UnitsWarning")
def test_other_units_are_the_scale_of_the_node(tmp_path):
    path = tmp_path / "a.glb"
    write_mesh(path, hill(units="ft", crs="EPSG:2263"))
    foot, meters = 1200 / 3937, 0.3048
    assert opened(path)[0]["nodes"][0]["scale"] == [foot, meters, foot]
    write_mesh(path, hill(), crs="EPSG:2263")
    assert opened(path)[0]["nodes"][0]["scale"] == [foot, foot, foot]


def test_edges_surfaces_and_flat_meshes(tmp_path):
    path, tin = tmp_path / "a.glb", hill()
    write_mesh(path, tin, edges=True)
    document, (position, rows) = opened(path)
    assert document["meshes"][0]["primitives"][0]["mode"] == 1
    assert len(rows) == 2 * len(tin.edges) and len(position) == tin.npoints
    mesh = delone.Delaunay(tin.points)
    write_mesh(path, mesh)
    assert (opened(path)[1][0][:, 1] == 0).all()
    write_mesh(path, mesh, z=tin.z)
    assert np.ptp(opened(path)[1][0][:, 1]) == pytest.approx(np.ptp(tin.z), rel=1e-6)
    with pytest.raises(FileFormatError, match="cannot store attributes"):
        write_mesh(path, mesh, attributes={"a": tin.z})
    solid = delone.Delaunay(np.random.default_rng(1).random((20, 3)))
    with pytest.raises(FileFormatError, match="cannot store tetrahedra"):
        write_mesh(path, solid)
