"""Lines and polygons from files, their heights, and what is written of regions and segments."""

import bz2
import gzip
import lzma
import sys

import geopandas
import meshio
import numpy as np
import pandas as pd
import pytest
import shapely

from delone import (
    ConstrainedDelaunay,
    FileFormatError,
    InputError,
    MissingExtraError,
    from_geometry,
)
from delone.io import GeometrySet, read_geometries, read_points, write_mesh
from delone.io.registry import holds_geometries

SHAPES = [
    shapely.Polygon([(0, 0), (4, 0), (4, 3), (0, 3)], [[(1, 1), (2, 1), (2, 2)]]),
    shapely.LineString([(5, 0), (6, 3)]),
    shapely.Point(7, 7),
]


def frame(geometries, **columns):
    return geopandas.GeoDataFrame(columns, geometry=geometries, crs="EPSG:28992")


def save(data, file):
    if file.suffix == ".parquet":
        data.to_parquet(file)
    else:
        data.to_file(file, **({"driver": "SQLite"} if file.suffix == ".sqlite" else {}))


@pytest.mark.parametrize("suffix", [".gpkg", ".sqlite", ".geojson", ".parquet"])
def test_all_kinds(tmp_path, suffix):
    file = tmp_path / f"a{suffix}"
    data = frame(SHAPES, height=[1.5, 2.5, 3.5])
    save(data, file)
    found = read_geometries(file, columns=["height"])
    assert shapely.equals_exact(found.geometries, SHAPES).all()
    assert found.feature_heights.tolist() == [1.5, 2.5, 3.5]
    assert (found.crs, found.source, len(found)) == ("EPSG:28992", str(file), 3)
    assert not found.only_points and found.attributes == {}
    assert found.areas.tolist() == [SHAPES[0]]


@pytest.mark.parametrize("suffix", [".gpkg", ".sqlite", ".geojson", ".parquet"])
def test_further_columns(tmp_path, suffix):
    file = tmp_path / f"a{suffix}"
    data = frame(SHAPES, height=[1.5, 2.5, 3.5], name=["a", "b", "c"], number=[7, 8, 9])
    save(data, file)
    found = read_geometries(file, attributes="all").attributes
    assert {name: values.tolist() for name, values in found.items()} == {
        "height": [1.5, 2.5, 3.5],
        "name": ["a", "b", "c"],
        "number": [7, 8, 9],
    }
    found = read_geometries(file, columns=["height"], attributes=["name"])
    assert list(found.attributes) == ["name"] and found.feature_heights.tolist() == [1.5, 2.5, 3.5]
    with pytest.raises(FileFormatError, match="nothing"):
        read_geometries(file, attributes=["nothing"])
    with pytest.raises(InputError, match="'all' or names"):
        read_geometries(file, attributes="name")
    assert len(found.all_points()) == 5 + 4 + 2 + 1
    assert read_geometries(file).feature_heights is None
    with pytest.raises(FileFormatError, match="feature 0 is Polygon"):
        read_points(file)
    with pytest.raises(FileFormatError, match="no column 'depth'"):
        read_geometries(file, columns=["depth"])


def test_which_files_hold_geometries(tmp_path):
    frame(SHAPES).to_parquet(tmp_path / "a.parquet")
    pd.DataFrame({"x": [0.0], "y": [1.0]}).to_parquet(tmp_path / "b.parquet")
    (tmp_path / "c.geojson.gz").write_bytes(b"?")
    (tmp_path / "d.csv").write_bytes(b"?")
    (tmp_path / "e.parquet").write_bytes(b"?")
    assert holds_geometries(tmp_path / "a.parquet")
    assert not holds_geometries(tmp_path / "b.parquet")
    assert holds_geometries(tmp_path / "c.geojson.gz")
    assert not holds_geometries(tmp_path / "d.csv")
    with pytest.raises(FileFormatError):
        holds_geometries(tmp_path / "e.parquet")
    with pytest.raises(FileFormatError, match="table without geometries"):
        read_geometries(tmp_path / "b.parquet")
    with pytest.raises(FileFormatError, match=r"cannot read geometries from .*\.csv"):
        read_geometries(tmp_path / "d.csv")
    with pytest.raises(FileNotFoundError):
        read_geometries(tmp_path / "f.gpkg")


@pytest.mark.parametrize(
    ("suffix", "compress"), [(".gz", gzip.compress), (".xz", lzma.compress), (".bz2", bz2.compress)]
)
def test_compressed(tmp_path, suffix, compress):
    frame(SHAPES).to_file(tmp_path / "a.geojson")
    whole = compress((tmp_path / "a.geojson").read_bytes())
    file = tmp_path / f"a.geojson{suffix}"
    file.write_bytes(whole)
    assert shapely.equals_exact(read_geometries(file).geometries, SHAPES).all()
    with pytest.raises(FileFormatError, match="no layers"):
        read_geometries(file, layer="a")
    file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FileFormatError, match="truncated"):
        read_geometries(file)
    file.write_bytes((tmp_path / "a.geojson").read_bytes())
    with pytest.raises(FileFormatError, match="compressed"):
        read_geometries(file)


def test_other_formats_are_not_read_compressed(tmp_path):
    (tmp_path / "a.gpkg.gz").write_bytes(b"?")
    with pytest.raises(FileFormatError, match="GeoJSON can be read compressed"):
        read_geometries(tmp_path / "a.gpkg.gz")


def test_without_the_library(tmp_path, monkeypatch):
    frame(SHAPES).to_file(tmp_path / "a.gpkg")
    monkeypatch.setitem(sys.modules, "pyogrio", None)
    with pytest.raises(MissingExtraError, match=r"delone\[geo\]"):
        read_geometries(tmp_path / "a.gpkg")


def test_heights_of_shared_and_added_vertices():
    shapes = shapely.from_wkt(
        ["LINESTRING Z (0 0 10, 8 0 18)", "LINESTRING Z (0 0 99, 2 -4 5)", "LINESTRING (6 -2, 6 6)"]
    )
    lines = GeometrySet(geometries=np.array(shapes))
    mesh = from_geometry(lines.geometries)
    z = lines.z_of(mesh)
    assert mesh.points[5].tolist() == [6, 0]
    # The first of equal coordinates counts; without z there is NaN; the crossing lies on the first.
    assert np.array_equal(z, [10, 18, 5, np.nan, np.nan, 16], equal_nan=True)
    assert GeometrySet(geometries=np.array(SHAPES)).z_of(from_geometry(SHAPES)) is None


def test_collections_are_looked_into():
    deep = shapely.GeometryCollection([shapely.GeometryCollection([SHAPES[0]]), SHAPES[2]])
    found = GeometrySet(geometries=np.array([deep, None], dtype=object))
    assert not found.only_points
    assert found.areas.tolist() == [SHAPES[0]]
    assert GeometrySet(geometries=np.array([None, SHAPES[2]], dtype=object)).only_points


@pytest.fixture
def mesh():
    """Two regions, a hole, and a diagonal that is no segment."""
    corners = [
        (0, 0),
        (6, 0),
        (6, 6),
        (0, 6),
        (2, 2),
        (4, 2),
        (4, 4),
        (2, 4),
        (3, 0),
        (3, 2),
        (5, 1),
    ]
    rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (8, 9)]
    return ConstrainedDelaunay(corners, [*rings, (3, 7)], holes=[(3, 3)], boundary="outline")


@pytest.mark.parametrize("suffix", [".vtu", ".msh", ".gpkg", ".geojson"])
def test_regions_and_segments_are_written(tmp_path, mesh, suffix):
    assert len(set(mesh.region.tolist())) == 2
    file, edges = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    write_mesh(file, mesh, attributes={"area": mesh.areas})
    write_mesh(edges, mesh, edges=True)
    if suffix in (".vtu", ".msh"):
        data = meshio.read(file).cell_data
        region, area = data["region"][0], data["area"][0]
        segment = meshio.read(edges).cell_data["segment"][0]
    else:
        region, area = geopandas.read_file(file).region, geopandas.read_file(file)["area"]
        segment = geopandas.read_file(edges).segment
    assert np.array_equal(region, mesh.region)
    assert np.allclose(area, mesh.areas)
    wanted = {tuple(sorted(pair)) for pair in mesh.segments.tolist()}
    assert {tuple(e) for e in mesh.edges[np.asarray(segment) == 1].tolist()} == wanted


def test_the_polygon_of_each_triangle_is_written(tmp_path):
    mesh = from_geometry(SHAPES)
    write_mesh(tmp_path / "a.vtu", mesh)
    polygon = meshio.read(tmp_path / "a.vtu").cell_data["polygon"][0]
    assert np.array_equal(polygon, mesh.polygon_of_simplex)
    assert set(polygon.tolist()) == {-1, 0}
    assert mesh.areas[polygon == 0].sum() == SHAPES[0].area


def test_what_is_given_wins(tmp_path, mesh):
    own = np.arange(mesh.nsimplex) + 100
    write_mesh(tmp_path / "a.vtu", mesh, attributes={"region": own})
    assert np.array_equal(meshio.read(tmp_path / "a.vtu").cell_data["region"][0], own)


def test_as_many_triangles_as_points(tmp_path):
    square = ConstrainedDelaunay([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)], [])
    five = ConstrainedDelaunay([*square.points.tolist(), (2, 3)], [(0, 2)])
    assert five.npoints == five.nsimplex == 6
    write_mesh(tmp_path / "a.vtu", five)
    data = meshio.read(tmp_path / "a.vtu")
    assert np.array_equal(data.cell_data["region"][0], five.region)
    assert "region" not in data.point_data


def test_npz_keeps_the_object(tmp_path, mesh):
    file = tmp_path / "a.npz"
    write_mesh(file, mesh, z=np.arange(11), crs="EPSG:28992")
    again = ConstrainedDelaunay.load(file)
    assert np.array_equal(again.simplices, mesh.simplices)
    assert np.array_equal(again.region, mesh.region)
    assert read_points(file).z.tolist() == list(range(11))
    assert read_points(file).crs == "EPSG:28992"
    with pytest.raises(FileFormatError, match="'segments' is the name"):
        write_mesh(file, mesh, attributes={"segments": np.arange(11)})
