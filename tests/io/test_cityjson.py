"""CityJSON: coordinates within half of the scale, triangles that keep their side, the system."""

import json

import numpy as np
import pytest

import delone
from delone import FileFormatError
from delone.io import write_mesh
from delone.predicates import orient2d
from delone.terrain import TIN


def hill(seed=0, count=500, **options):
    random = np.random.default_rng(seed)
    xy = random.random((count, 2)) * 100 + (155_000, 463_000)
    return TIN.from_points(np.column_stack((xy, random.random(count) * 9 - 3)), **options)


def opened(path):
    """Return the document, coordinates and triangles, as the specification has them."""
    document = json.loads(path.read_text(encoding="utf-8"))
    assert (document["type"], document["version"]) == ("CityJSON", "2.0")
    (found,) = document["CityObjects"].values()
    assert found["type"] == "TINRelief"
    (geometry,) = found["geometry"]
    assert (geometry["type"], geometry["lod"]) == ("CompositeSurface", "1")
    assert all(len(surface) == 1 for surface in geometry["boundaries"])
    rows = np.array([surface[0] for surface in geometry["boundaries"]])
    whole = np.array(document["vertices"])
    assert whole.dtype == np.int64
    assert sorted(np.unique(rows)) == list(range(len(whole)))
    transform = document["transform"]
    points = whole * np.array(transform["scale"]) + transform["translate"]
    return document, points, rows


def test_coordinates_are_within_half_of_the_scale(tmp_path):
    tin, path = hill(crs="EPSG:7415", units="m"), tmp_path / "a höhe.city.json"
    write_mesh(path, tin)
    document, points, rows = opened(path)
    assert np.array_equal(rows, tin.simplices)
    scale = document["transform"]["scale"][0]
    assert scale in (1e-3, 1e-4, 1e-5)
    assert np.abs(points - tin.xyz).max() <= scale / 2 + 1e-9
    reference = document["metadata"]["referenceSystem"]
    assert reference == "https://www.opengis.net/def/crs/EPSG/0/7415"
    extent = document["metadata"]["geographicalExtent"]
    assert extent == [*tin.xyz.min(axis=0).tolist(), *tin.xyz.max(axis=0).tolist()]


def test_millimeters_are_kept_exactly(tmp_path):
    random = np.random.default_rng(2)
    whole = random.integers(0, 10**6, (400, 3))
    tin = TIN.from_points(whole / 1000)
    write_mesh(tmp_path / "a.json", tin)
    document, points, rows = opened(tmp_path / "a.json")
    assert document["transform"]["scale"] == [0.001] * 3
    translate = np.array(document["transform"]["translate"])
    assert np.array_equal(document["vertices"] + np.rint(translate * 1000), np.rint(tin.xyz * 1000))
    assert "referenceSystem" not in document["metadata"]
    assert len(points) == tin.npoints
    assert len(rows) == tin.nsimplex


def test_the_scale_is_as_fine_as_thin_triangles_need(tmp_path):
    points = [(0, 0, 0), (10, 0, 1), (5, 2e-6, 2), (5, 9, 3)]
    tin = TIN.from_points(points)
    write_mesh(tmp_path / "a.json", tin)
    document, _, rows = opened(tmp_path / "a.json")
    assert document["transform"]["scale"] == [1e-6] * 3
    corners = np.array(document["vertices"])[rows][..., :2].astype(float)
    assert (orient2d(*corners.transpose(1, 0, 2)) > 0).all()
    thin = TIN.from_points([(0, 0, 0), (10, 0, 1), (5, 2e-40, 2), (5, 9, 3)])
    with pytest.raises(FileFormatError, match="so thin"):
        write_mesh(tmp_path / "b.json", thin)
    assert not (tmp_path / "b.json").exists()


def test_only_points_with_triangles_are_written(tmp_path):
    hole = [(155_040, 463_040), (155_060, 463_040), (155_060, 463_060), (155_040, 463_060)]
    tin = hill(holes=[hole])
    write_mesh(tmp_path / "a.json", tin)
    _, points, rows = opened(tmp_path / "a.json")
    used = np.unique(tin.simplices)
    assert len(points) == len(used) < tin.npoints
    assert np.array_equal(used[rows], tin.simplices)


def test_blocks_of_long_lists_are_joined(tmp_path, monkeypatch):
    monkeypatch.setattr("delone.io.cityjson._BLOCK", 7)
    tin = hill()
    write_mesh(tmp_path / "a.json", tin)
    assert np.array_equal(opened(tmp_path / "a.json")[2], tin.simplices)


def test_what_it_cannot_store(tmp_path):
    path, tin = tmp_path / "a.json", hill()
    mesh = delone.Delaunay(tin.points)
    with pytest.raises(FileFormatError, match="need heights"):
        write_mesh(path, mesh)
    write_mesh(path, mesh, z=tin.z)
    assert len(opened(path)[2]) == mesh.nsimplex
    with pytest.raises(FileFormatError, match="cannot store edges"):
        write_mesh(path, tin, edges=True)
    with pytest.raises(FileFormatError, match="cannot store attributes"):
        write_mesh(path, mesh, z=tin.z, attributes={"a": tin.z})
    with pytest.raises(FileFormatError, match="finite height"):
        write_mesh(path, mesh, z=np.where(np.arange(len(tin.z)) == 3, np.nan, tin.z))
    solid = delone.Delaunay(np.random.default_rng(1).random((20, 3)))
    with pytest.raises(FileFormatError, match="cannot store tetrahedra"):
        write_mesh(path, solid)
