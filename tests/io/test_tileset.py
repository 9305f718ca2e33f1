"""3D Tiles: levels are where pyproj puts them on the globe, within the errors that are stated."""

import json

import numpy as np
import pyproj
import pytest

import delone
from delone import InputError
from delone.io import write_tileset
from delone.terrain import TIN

pyvista = pytest.importorskip("pyvista")


def hill(size=100.0, seed=0, **options):
    random = np.random.default_rng(seed)
    xy = random.random((1500, 2)) * size + (155_000, 463_000)
    z = 9 * np.exp(-(((xy - (155_000 + size / 2, 463_000 + size / 2)) / size * 4) ** 2).sum(axis=1))
    options = {"crs": "EPSG:28992", "units": "m"} | options
    return TIN.from_points(np.column_stack((xy, z + random.random(1500) / 5)), **options)


def in_space(path, matrix):
    """Return positions around the center of the earth, as VTK and the specification have them."""
    (block,) = [each for each in pyvista.read(path).recursive_iterator() if each is not None]
    x, up, back = np.asarray(block.points, dtype=float).T
    # glTF is y upward, tiles are z upward.
    local = np.column_stack((x, -back, up, np.ones(len(x))))
    return (local @ matrix.T)[:, :3], block.regular_faces


def levels_of(folder):
    document = json.loads((folder / "tileset.json").read_text(encoding="utf-8"))
    assert document["asset"]["version"] == "1.1"
    tile, found = document["root"], []
    matrix = np.array(tile["transform"]).reshape(4, 4).T
    while tile:
        assert tile["refine"] == "REPLACE"
        found.append(tile)
        (tile,) = tile.get("children", [None])
    return document, matrix, found


def to_globe(xyz, crs="EPSG:28992"):
    lon, lat = pyproj.Transformer.from_crs(crs, 4326, always_xy=True).transform(*xyz[:, :2].T)
    to_space = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    return np.column_stack(to_space.transform(lon, lat, xyz[:, 2]))


def test_levels_are_on_the_globe(tmp_path):
    tin = hill()
    errors = write_tileset(tmp_path / "tiles", tin, errors=[2, 0.5, 0.1])
    document, matrix, tiles = levels_of(tmp_path / "tiles")
    assert [tile["geometricError"] for tile in tiles] == list(errors)
    assert document["geometricError"] > errors[0] > errors[1] > errors[2]
    for tile, most, error in zip(tiles, (2, 0.5, 0.1), errors, strict=True):
        expected = tin.simplify(max_error=most)
        found, faces = in_space(tmp_path / "tiles" / tile["content"]["uri"], matrix)
        assert faces.tolist() == expected.simplices.tolist()
        right = to_globe(expected.xyz)
        # Of 100 m, 32 bits have 7.6 micrometers.
        assert np.linalg.norm(found - right, axis=1).max() < 2e-5
        assert most / 3 < error < most * 1.001
        box = np.array(tile["boundingVolume"]["box"]).reshape(4, 3)
        local = (to_globe(tin.xyz) - matrix[:3, 3]) @ matrix[:3, :3]
        assert (np.abs(local - box[0]) <= box[1:].diagonal() - error * 0.999).all()
        assert np.count_nonzero(box[1:]) == 3
    rotation = matrix[:3, :3]
    assert rotation @ rotation.T == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(rotation) == pytest.approx(1)


@pytest.mark.parametrize("size", [100.0, 60_000.0])
def test_the_error_is_that_of_all_points_in_space(tmp_path, size):
    tin = hill(size)
    (error,) = write_tileset(tmp_path, tin, errors=[1.0])
    _, matrix, (tile,) = levels_of(tmp_path)
    found, faces = in_space(tmp_path / tile["content"]["uri"], matrix)
    small = tin.simplify(max_error=1.0)
    place = small.locate(tin.points)
    inside = place.simplex >= 0
    assert inside.mean() > 0.99
    corners = found[faces[place.simplex[inside]]]
    there = (place.barycentric[inside][..., None] * corners).sum(axis=1)
    away = np.linalg.norm(there - to_globe(tin.xyz)[inside], axis=1)
    assert error == pytest.approx(away.max(), rel=1e-6)


def test_curvature_counts(tmp_path):
    # A level plane of 20 km: its two triangles are a meter deep in the earth, or float above it.
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(0, 20_001, 1000.0), np.arange(3) * 1e4))
    flat = np.column_stack((x + 150_000, y + 460_000, np.full(len(x), 7.0)))
    tin = TIN.from_points(flat, crs="EPSG:28992", units="m")
    (error,) = write_tileset(tmp_path, tin, errors=[0.0])
    assert tin.simplify(max_error=0.0).nsimplex < 40
    # The sagitta of a chord of 20 km at least, that of 28 km at most, besides what the map adds.
    assert 20_000**2 / 8 / 6.4e6 < error < 2 * 28_300**2 / 8 / 6.35e6


def test_feet_and_compound_systems(tmp_path):
    feet, meters = hill(units="ft"), hill()
    lifted = TIN.from_points(
        np.column_stack((feet.points, feet.z * 0.3048)), crs="EPSG:28992", units="m"
    )
    with pytest.warns(delone.UnitsWarning):
        hill(units="ft")
    write_tileset(tmp_path / "feet", feet, errors=[0.0])
    write_tileset(tmp_path / "meters", lifted, errors=[0.0])
    name = "level-0.glb"
    one, two = (
        in_space(tmp_path / each / name, levels_of(tmp_path / each)[1])[0]
        for each in ("feet", "meters")
    )
    assert np.abs(np.sort(one, axis=0) - np.sort(two, axis=0)).max() < 1e-4
    compound = TIN.from_points(meters.xyz, crs="EPSG:7415")
    write_tileset(tmp_path / "compound", compound, errors=[0.0])
    write_tileset(tmp_path / "flat", meters, errors=[0.0])
    assert (tmp_path / "compound" / name).read_bytes() == (tmp_path / "flat" / name).read_bytes()


@pytest.mark.parametrize(
    "errors", [[], [1, 2], [1, 1], [-1], [np.nan], [np.inf], 1.0, [[1.0]], ["a"], range(40, 0, -1)]
)
def test_bad_errors(tmp_path, errors):
    with pytest.raises(InputError, match="errors must be"):
        write_tileset(tmp_path / "tiles", hill(), errors=errors)
    assert not (tmp_path / "tiles").exists()


def test_unknown_places(tmp_path):
    with pytest.raises(InputError, match="reference system of the surface is unknown"):
        write_tileset(tmp_path / "tiles", hill(crs=None), errors=[0.0])
    # In this system, such coordinates are far beyond the globe.
    wrong = TIN.from_points(hill().xyz * (1e4, 1e4, 1), crs="EPSG:32631", units="m")
    with pytest.raises(InputError, match="has no place on the globe"):
        write_tileset(tmp_path / "tiles", wrong, errors=[0.0])
    assert not (tmp_path / "tiles").exists()


def test_tilesets_are_replaced_and_the_list_comes_last(tmp_path, monkeypatch):
    tin = hill()
    write_tileset(tmp_path, tin, errors=[1.0])
    before = (tmp_path / "tileset.json").read_text()

    def fail(*_):
        raise RuntimeError("no")

    monkeypatch.setattr("delone.io.tileset.write_local", fail)
    with pytest.raises(RuntimeError):
        write_tileset(tmp_path, tin, errors=[2.0])
    assert (tmp_path / "tileset.json").read_text() == before
