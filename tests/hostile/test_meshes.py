"""Files of meshes, tables and arrays that refer to others or would run something."""

from __future__ import annotations

import contextlib
import pickle
from pathlib import Path
from string import Template

import geopandas
import laspy
import numpy as np
import pyarrow
import pyarrow.parquet
import pytest
import shapely

import delone
from delone import FileFormatError, distributed
from delone.io import read_mesh, read_points, write_mesh

CORPUS = Path(__file__).parents[1] / "corpus" / "hostile"
POINTS = np.array([(0.0, 0), (4, 0), (0, 3), (4, 3)])


def filled(name, canary, listener):
    text = (CORPUS / name).read_text(encoding="utf-8")
    return Template(text).safe_substitute(file=canary.csv, url=listener.url)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
@pytest.mark.parametrize(
    "name", ["billion-laughs.vtu", "external-entity.vtu", "external-subset.vtu"]
)
def test_document_types_are_refused(tmp_path, canary, listener, name, encoding):
    text = filled(name, canary, listener).replace("utf-8", encoding)
    (tmp_path / "a.vtu").write_text(text, encoding=encoding)
    canary.watch()
    for read in (read_points, read_mesh):
        with pytest.raises(FileFormatError, match="DOCTYPE"):
            read(tmp_path / "a.vtu")
    assert not canary.was_opened
    assert listener.requests == []


@pytest.mark.parametrize("name", ["inclusion.vtu", "piece-elsewhere.vtu"])
def test_inclusions_are_refused(tmp_path, canary, listener, name):
    (tmp_path / "a.vtu").write_text(filled(name, canary, listener))
    canary.watch()
    for read in (read_points, read_mesh):
        with pytest.raises(FileFormatError):
            read(tmp_path / "a.vtu")
    assert not canary.was_opened
    assert listener.requests == []


@pytest.mark.parametrize("name", ["library.obj", "texture.ply"])
def test_materials_are_left_alone(tmp_path, canary, listener, name):
    path = tmp_path / name
    path.write_text(filled(name, canary, listener))
    canary.watch()
    assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]
    assert not canary.was_opened
    assert listener.requests == []


class Trap:
    """What leaves a file behind when it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


@pytest.mark.parametrize("name", ["a.npy", "a.npz", "mesh.npz"])
def test_nothing_is_unpickled(tmp_path, name):
    path, mark = tmp_path / name, tmp_path / "mark"
    trap = np.array([Trap(mark)], dtype=object)
    if name == "a.npy":
        np.save(path, trap, allow_pickle=True)
    elif name == "a.npz":
        np.savez(path, points=trap)
    else:
        np.savez(path, points=POINTS, simplices=trap, constrained=trap, format=trap)
    for read in (read_points, read_mesh, delone.Delaunay.load, distributed.triangulate):
        options = {"output": tmp_path / "tin"} if read is distributed.triangulate else {}
        with contextlib.suppress(delone.DeloneError):
            read(path, **options)
    path.write_bytes(pickle.dumps(Trap(mark)))
    for read in (read_points, read_mesh, delone.Delaunay.load):
        with pytest.raises(delone.DeloneError):
            read(path)
    assert not mark.exists()


@pytest.mark.parametrize("suffix", [".parquet", ".arrow", ".feather"])
def test_types_of_tables_are_not_unpickled(tmp_path, suffix):
    mark = tmp_path / "mark"
    metadata = {
        b"ARROW:extension:name": b"arrow.py_extension_type",
        b"ARROW:extension:metadata": pickle.dumps(Trap(mark)),
    }
    fields = [
        pyarrow.field(name, pyarrow.float64(), metadata=metadata if name == "x" else None)
        for name in "xy"
    ]
    table = pyarrow.table([POINTS[:, 0], POINTS[:, 1]], schema=pyarrow.schema(fields))
    path = tmp_path / f"a{suffix}"
    if suffix == ".parquet":
        pyarrow.parquet.write_table(table, path)
    else:
        with pyarrow.ipc.new_file(path, table.schema) as file:
            file.write(table)
    with contextlib.suppress(FileFormatError):
        assert np.array_equal(read_points(path).points, POINTS)
    assert not mark.exists()


def test_a_column_elsewhere_is_not_read(tmp_path, canary):
    # The metadata of Parquet has a path for each part of a column.
    table = pyarrow.table({"x": POINTS[:, 0], "y": POINTS[:, 1]})
    path, other = tmp_path / "a.parquet", canary.folder / "b.parquet"
    parts: list = []
    pyarrow.parquet.write_table(table, other, metadata_collector=parts)
    parts[0].set_file_path("elsewhere/b.parquet")
    parts[0].write_metadata_file(path)
    canary.watch()
    with pytest.raises(FileFormatError):
        read_points(path)
    assert not canary.was_opened


def test_waves_beside_are_not_read(tmp_path, canary):
    data = laspy.create(point_format=4, file_version="1.3")
    data.x, data.y, data.z = *POINTS.T, np.zeros(4)
    data.header.global_encoding.waveform_data_packets_external = True
    data.write(tmp_path / "a.las")
    (tmp_path / "a.wdp").symlink_to(canary.csv)
    canary.watch()
    assert len(read_points(tmp_path / "a.las")) == 4
    assert not canary.was_opened


def test_files_beside_other_files_are_left_alone(tmp_path, canary):
    # Only the parts of a Shapefile, .node files and journals are read.
    mesh = delone.Delaunay(POINTS)
    for suffix in (".geojson", ".gpkg", ".vtu", ".ply", ".obj", ".stl", ".msh", ".npz"):
        write_mesh(tmp_path / f"a{suffix}", mesh)
    frame = geopandas.GeoDataFrame(geometry=shapely.points(POINTS))
    for suffix in (".shp", ".fgb"):
        frame.to_file(tmp_path / f"a{suffix}")
    (tmp_path / "a.csv").write_text("x,y\n0,0\n4,0\n0,3\n")
    for suffix in (".vrt", ".aux.xml", ".csvt", ".gfs", ".xsd", ".mtl", ".qml", ".ovr", ".msk"):
        (tmp_path / f"a{suffix}").symlink_to(canary.csv)
        for own in (".csv", ".geojson", ".gpkg", ".vtu", ".shp", ".fgb"):
            (tmp_path / f"a{own}{suffix}").symlink_to(canary.csv)
    canary.watch()
    for suffix in (".vtu", ".ply", ".obj", ".stl", ".msh", ".npz"):
        assert read_mesh(tmp_path / f"a{suffix}").simplices.shape == (2, 3)
    for suffix, count in ((".geojson", 2), (".gpkg", 2), (".shp", 4), (".fgb", 4)):
        assert len(delone.io.read_geometries(tmp_path / f"a{suffix}")) == count
    assert len(read_points(tmp_path / "a.csv")) == 3
    assert not canary.was_opened
