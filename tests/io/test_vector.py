"""Files of geometries: points in, triangles and edges out."""

import geopandas
import numpy as np
import pyogrio
import pytest
import shapely

from delone import Delaunay, FileFormatError
from delone.io import read_geometries, read_points, write_mesh

XY = np.array([(0.1, 0), (4, 0), (4, 3), (0, 3), (2, 1 / 3)])
Z = np.array([1.0, 2, 3, 4, 5])


def frame(points, **columns):
    return geopandas.GeoDataFrame(columns, geometry=points, crs="EPSG:28992")


@pytest.mark.parametrize("suffix", [".gpkg", ".shp", ".geojson", ".fgb", ".parquet"])
@pytest.mark.parametrize("deep", [False, True])
def test_points(tmp_path, suffix, deep):
    file = tmp_path / f"a{suffix}"
    points = shapely.points(np.column_stack((XY, Z)) if deep else XY)
    data = frame(points, depth=-Z, name=list("abcde"))
    if suffix == ".parquet":
        data.to_parquet(file)
    else:
        data.to_file(file, **({"COORDINATE_PRECISION": 17} if suffix == ".geojson" else {}))
    survey = read_points(file, attributes=["name"])
    assert np.allclose(np.sort(survey.points, axis=0), np.sort(XY, axis=0), rtol=1e-15, atol=0)
    assert (survey.z is None) if not deep else (sorted(survey.z.tolist()) == Z.tolist())
    assert sorted(survey.attributes["name"].tolist()) == list("abcde")
    assert survey.crs == "EPSG:28992"
    assert sorted(read_points(file, columns=["depth"]).z.tolist()) == sorted(-Z)


def test_multipoints(tmp_path):
    data = frame([shapely.multipoints(XY[:2]), shapely.multipoints(XY[2:])], z=[7.0, 8.0])
    data.to_file(tmp_path / "a.gpkg")
    survey = read_points(tmp_path / "a.gpkg", columns=["z"])
    assert np.array_equal(survey.points, XY)
    assert survey.z.tolist() == [7, 7, 8, 8, 8]


@pytest.mark.parametrize("other", [shapely.box(0, 0, 1, 1), shapely.Point(), None])
def test_what_is_no_point_is_refused(tmp_path, other):
    frame([*shapely.points(XY), other]).to_file(tmp_path / "a.gpkg")
    with pytest.raises(FileFormatError, match="feature 5"):
        read_points(tmp_path / "a.gpkg")


def test_layers(tmp_path):
    file = tmp_path / "a.gpkg"
    frame(shapely.points(XY)).to_file(file, layer="one")
    frame(shapely.points(XY[:3])).to_file(file, layer="two")
    with pytest.raises(FileFormatError, match=r"choose one \(--layer\): one, two"):
        read_points(file)
    assert len(read_points(file, layer="two")) == 3
    with pytest.raises(FileFormatError, match="no layer 'three'"):
        read_points(file, layer="three")


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".shp", ".parquet", ".fgb"])
def test_garbage_and_torn(tmp_path, suffix):
    file = tmp_path / f"a{suffix}"
    file.write_bytes(np.random.default_rng(1).bytes(2000))
    with pytest.raises(FileFormatError):
        read_points(file)
    points = shapely.points(np.random.default_rng(0).random((200, 2)))
    data = frame(points)
    data.to_parquet(file) if suffix == ".parquet" else data.to_file(file)
    whole = file.read_bytes()
    for share in (0.1, 0.5, 0.9):
        file.write_bytes(whole[: int(len(whole) * share)])
        with pytest.raises(FileFormatError):
            read_points(file)


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson"])
@pytest.mark.parametrize("edges", [False, True])
@pytest.mark.parametrize("deep", [False, True])
def test_mesh_as_geometries(tmp_path, monkeypatch, suffix, edges, deep):
    monkeypatch.setattr("delone.io.vector._PART", 3)
    mesh = Delaunay(XY)
    cells = mesh.edges if edges else mesh.simplices
    file = tmp_path / f"a{suffix}"
    weights = {"weight": np.arange(len(cells))}
    write_mesh(file, mesh, z=Z if deep else None, crs="EPSG:28992", edges=edges, attributes=weights)
    assert [name for name, _ in pyogrio.list_layers(file)] == ["edges" if edges else "triangles"]
    data = geopandas.read_file(file)
    assert data.crs == "EPSG:28992"
    corners = data[[f"v{k}" for k in range(cells.shape[1])]].to_numpy()
    assert np.array_equal(corners, cells)
    assert np.array_equal(data["weight"], weights["weight"])
    assert list(data.geometry.has_z) == [deep] * len(cells)
    for shape, cell in zip(data.geometry, cells, strict=True):
        drawn = shapely.get_coordinates(shape, include_z=deep)[: len(cell)]
        wanted = np.column_stack((XY, Z)) if deep else XY
        assert np.array_equal(drawn, wanted[cell])
    assert sorted(path.name for path in tmp_path.iterdir()) == [file.name]


def test_no_reference_system(tmp_path, recwarn):
    write_mesh(tmp_path / "a.gpkg", Delaunay(XY))
    assert geopandas.read_file(tmp_path / "a.gpkg").crs is None
    assert not [warning for warning in recwarn if "crs" in str(warning.message)]


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson"])
@pytest.mark.parametrize("crs", ["EPSG:99999999", "\0", "nonsense"])
def test_a_reference_system_that_nobody_knows(tmp_path, suffix, crs):
    with pytest.raises(FileFormatError, match="cannot store the reference system"):
        write_mesh(tmp_path / f"a{suffix}", Delaunay(XY), crs=crs)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson"])
def test_doubles_beside_short_decimals_come_back(tmp_path, suffix):
    """Their seventeen digits have a run of 0 or 9 near the end."""
    dice = np.random.default_rng(7)
    short = np.round(dice.random((200, 3)) * 10.0 ** dice.integers(0, 7, (200, 1)), 3)
    values = np.nextafter(short, np.where(dice.random(short.shape) < 0.5, -np.inf, np.inf))
    mesh, file = Delaunay(values[:, :2]), tmp_path / f"a{suffix}"
    weights = values.ravel()[: mesh.nsimplex]
    write_mesh(file, mesh, z=values[:, 2], attributes={"w": weights})
    data = geopandas.read_file(file)
    drawn = shapely.get_coordinates(data.geometry, include_z=True).reshape(-1, 4, 3)
    assert np.array_equal(drawn[:, :3], values[mesh.simplices])
    assert np.array_equal(data["w"], weights)


@pytest.mark.parametrize("suffix", ["geojson", "json", "geojson.gz"])
def test_a_ring_that_is_not_closed_is_named(tmp_path, suffix):
    import gzip
    import json

    good, bad = [[0, 0], [4, 0], [4, 3], [0, 0]], [[0, 0], [4, 0], [4, 3], [0, 3]]
    shapes = [
        {"type": "Polygon", "coordinates": [good]},
        {"type": "MultiPolygon", "coordinates": [[good], [good, bad]]},
    ]
    features = [{"type": "Feature", "properties": {}, "geometry": shape} for shape in shapes]
    text = json.dumps({"type": "FeatureCollection", "features": features}).encode()
    path = tmp_path / f"a.{suffix}"
    path.write_bytes(gzip.compress(text) if suffix.endswith("gz") else text)
    with pytest.raises(
        FileFormatError, match=r"feature 1 .* begins at \[0, 0\] and ends at \[0, 3\]"
    ):
        read_geometries(path)
