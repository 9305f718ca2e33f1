"""Quantized mesh: another library reads tiles within the stated errors, without cracks."""

import json
import struct

import numpy as np
import pyproj
import pytest

from delone import BudgetExceededError, InputError
from delone.interpolate import Linear
from delone.io import write_quantized_mesh
from delone.terrain import TIN

pytest.importorskip("quantized_mesh_encoder")
terrain = pytest.importorskip("quantized_mesh_tile.terrain")


def hill(size=100.0, seed=0, height=9.0, corner=(155_000, 463_000), **options):
    random = np.random.default_rng(seed)
    xy = random.random((1500, 2)) * size
    z = height * np.exp(-(((xy / size - 0.5) * 4) ** 2).sum(axis=1))
    options = {"crs": "EPSG:28992", "units": "m"} | options
    return TIN.from_points(np.column_stack((xy + corner, z + random.random(1500) / 5)), **options)


def bounds(zoom, x, y):
    width = 180 / 2**zoom
    return x * width - 180, y * width - 90, (x + 1) * width - 180, (y + 1) * width - 90


def read(folder, zoom, x, y, *, normals=False):
    """Return vertices, triangles and the tile, as another library reads them."""
    west, south, east, north = bounds(zoom, x, y)
    tile = terrain.TerrainTile(west=west, south=south, east=east, north=north)
    path = folder / str(zoom) / str(x) / f"{y}.terrain"
    with path.open("rb") as file:
        tile.fromBytesIO(file, hasLighting=normals)
        # Nothing is left over.
        assert file.read() == b""
    simplices = np.array(tile.indices, dtype=np.int64).reshape(-1, 3)
    return np.array(tile.getVerticesCoordinates()), simplices, tile


def judge(vertices, simplices, places):
    """Return the heights of a mesh at places, by a loop over triangles."""
    found = np.full(len(places), np.nan)
    for corners in vertices[simplices]:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
        x, y = places.T
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
        v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
        inside = np.minimum(np.minimum(u, v), 1 - u - v) >= -1e-9
        found[inside] = (u * az + v * bz + (1 - u - v) * cz)[inside]
    return found


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder, tin = tmp_path_factory.mktemp("globe") / "tiles", hill(height=30.0)
    return folder, tin, write_quantized_mesh(folder, tin, max_error=0.3)


def tiles_of(folder, zoom):
    runs = json.loads((folder / "layer.json").read_text("utf-8"))["available"][zoom]
    return [(x, run["startY"]) for run in runs for x in range(run["startX"], run["endX"] + 1)]


def test_each_level_is_within_its_error(written):
    folder, tin, errors = written
    to_degrees = pyproj.Transformer.from_crs("EPSG:28992", 4326, always_xy=True)
    degrees = np.column_stack(to_degrees.transform(*tin.points.T))
    assert errors[-1] <= 0.3 and len(errors) == 19
    for zoom in (0, 5, 14, 16, 18):
        found = np.full(tin.npoints, np.nan)
        for x, y in tiles_of(folder, zoom):
            vertices, simplices, _ = read(folder, zoom, x, y)
            west, south, east, north = bounds(zoom, x, y)
            lon, lat = degrees.T
            inside = (lon >= west) & (lon <= east) & (lat >= south) & (lat <= north)
            found[inside] = judge(vertices, simplices, degrees[inside])
        away = np.abs(found - tin.z)
        assert not np.isnan(away).any()
        assert away.max() == pytest.approx(errors[zoom], abs=1e-6)
        assert errors[zoom] <= 77067.34 / 2**zoom
    # A level is not finer than it has to be.
    assert errors[16] > 0.3


def test_tiles_cover_their_boxes_and_meet(written):
    folder, _, errors = written
    for zoom in (0, 17, len(errors) - 1):
        sides = {}
        for x, y in tiles_of(folder, zoom):
            vertices, simplices, tile = read(folder, zoom, x, y)
            u, v = np.array(tile.u), np.array(tile.v)
            a, b, c = (np.column_stack((u, v))[corner] for corner in simplices.T)
            area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
            assert (area > 0).all() and area.sum() == 2 * 32767**2
            rows = tile.westI, tile.eastI, tile.southI, tile.northI
            on = u == 0, u == 32767, v == 0, v == 32767
            for name, found, right in zip("wesn", rows, on, strict=True):
                assert sorted(found) == np.flatnonzero(right).tolist()
                way = v if name in "we" else u
                side = sorted(zip(way[found].tolist(), vertices[found, 2].tolist(), strict=True))
                column, row = x + (name == "e"), y + (name == "n")
                sides.setdefault((name in "we", column, row), []).append(side)
        shared = [both for both in sides.values() if len(both) == 2]
        assert len(shared) >= 1
        # Bit for bit: what is between them has no crack.
        assert all(one == two for one, two in shared)


def test_the_description_names_all_files(written):
    folder, tin, errors = written
    document = json.loads((folder / "layer.json").read_text("utf-8"))
    assert (document["format"], document["scheme"]) == ("quantized-mesh-1.0", "tms")
    assert document["maxzoom"] == len(errors) - 1 == len(document["available"]) - 1
    named = {
        f"{zoom}/{x}/{y}.terrain" for zoom in range(len(errors)) for x, y in tiles_of(folder, zoom)
    }
    assert named == {path.relative_to(folder).as_posix() for path in folder.rglob("*.terrain")}
    assert {"0/0/0.terrain", "0/1/0.terrain"} <= named
    for zoom, x, y in (map(int, name[:-8].split("/")) for name in named):
        assert zoom == 0 or f"{zoom - 1}/{x // 2}/{y // 2}.terrain" in named
    west, south, east, north = document["bounds"]
    back = pyproj.Transformer.from_crs(4326, "EPSG:28992", always_xy=True)
    x, y = back.transform([west, east], [south, north])
    assert np.abs(np.array([x, y]).T - [tin.min_bound, tin.max_bound]).max() < 3


def test_headers_hold_what_they_bound(written):
    folder, _, errors = written
    zoom = len(errors) - 1
    for x, y in tiles_of(folder, zoom)[:4]:
        path = folder / str(zoom) / str(x) / f"{y}.terrain"
        values = struct.unpack("<3d2f4d3d", path.read_bytes()[:88])
        vertices, _, _ = read(folder, zoom, x, y)
        low, high = values[3:5]
        assert low <= vertices[:, 2].min() and vertices[:, 2].max() <= high
        to_space = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
        space = np.column_stack(to_space.transform(*vertices.T))
        away = np.linalg.norm(space - values[5:8], axis=1)
        assert away.max() <= values[8] * 1.001
        # Steps of height are a power of two in all tiles.
        assert np.log2((high - low) / 32767) % 1 == 0
    first = struct.unpack("<3d2f4d3d", (folder / "0/1/0.terrain").read_bytes()[:88])
    assert np.isfinite(first).all()


@pytest.mark.parametrize("south", [False, True])
def test_normals_are_read_and_equal_where_tiles_meet(tmp_path, south):
    where = {"crs": "EPSG:32719", "corner": (500_000, 6_300_000)} if south else {}
    tin, bare = hill(height=30.0, **where), tmp_path / "bare"
    errors = write_quantized_mesh(bare, tin, max_error=0.3)
    tmp_path /= "tiles"
    assert write_quantized_mesh(tmp_path, tin, max_error=0.3, normals=True) == errors
    document = json.loads((tmp_path / "layer.json").read_text("utf-8"))
    assert document.pop("extensions") == ["octvertexnormals"]
    assert document == json.loads((bare / "layer.json").read_text("utf-8"))
    to_space = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978", always_xy=True)
    for zoom in (0, 17, len(errors) - 1):
        sums, found = {}, {}
        for x, y in tiles_of(tmp_path, zoom):
            path = f"{zoom}/{x}/{y}.terrain"
            before = (bare / path).read_bytes()
            assert (tmp_path / path).read_bytes()[: len(before)] == before
            vertices, simplices, tile = read(tmp_path, zoom, x, y, normals=True)
            grid = np.column_stack((tile.u, tile.v)) + np.array((x, y)) * 32767
            keys = list(map(tuple, grid.tolist()))
            space = np.column_stack(to_space.transform(*vertices.T))
            for corners in simplices:
                a, b, c = space[corners]
                for corner in corners:
                    sums[keys[corner]] = sums.get(keys[corner], 0) + np.cross(b - a, c - a)
            assert len(tile.vLight) == len(vertices)
            for key, normal in zip(keys, tile.vLight, strict=True):
                found.setdefault(key, []).append(normal)
        assert all(len(set(map(tuple, same))) == 1 for same in found.values())
        if zoom:
            assert sum(len(same) > 1 for same in found.values()) > 3
        assert len(found) > 4
        for key, (normal, *_) in found.items():
            right = sums[key] / np.linalg.norm(sums[key])
            if key[1] in (0, 2**zoom * 32767):
                right = np.array((0, 0, np.sign(key[1] - 1)))
            # Two numbers of 8 bits.
            assert np.dot(normal, right) > np.cos(np.radians(1.5)), (zoom, key)


def test_places_without_a_surface(tmp_path):
    tin = hill(height=5.0)
    write_quantized_mesh(tmp_path / "tiles", tin, max_error=2, outside=40.0)
    vertices, _, _ = read(tmp_path / "tiles", 0, 0, 0)
    assert vertices[:, 2].tolist() == [40] * 4
    tile = tiles_of(tmp_path / "tiles", 12)[0]
    vertices, _, _ = read(tmp_path / "tiles", 12, *tile)
    mesh = Linear(TIN.from_points(vertices).points, vertices[:, 2])
    west, south, *_ = bounds(12, *tile)
    assert mesh([(west, south)])[0] == 40


def test_heights_in_feet_are_written_in_meters(tmp_path):
    feet = hill(crs="EPSG:2992", units="ft", corner=(636_000, 850_000), size=3000, height=90.0)
    errors = write_quantized_mesh(tmp_path / "tiles", feet, max_error=2)
    zoom = len(errors) - 1
    highest = max(
        read(tmp_path / "tiles", zoom, x, y)[0][:, 2].max()
        for x, y in tiles_of(tmp_path / "tiles", zoom)
    )
    assert highest == pytest.approx(feet.z.max() * 0.3048, abs=2)


def test_what_cannot_be_is_refused(tmp_path):
    tin = hill()
    for bad in (0, -1, np.nan, np.inf):
        with pytest.raises(InputError, match="max_error must be a distance"):
            write_quantized_mesh(tmp_path / "tiles", tin, max_error=bad)
    with pytest.raises(InputError, match=r"the finest is 24: give at least 0\.0046"):
        write_quantized_mesh(tmp_path / "tiles", tin, max_error=1e-3)
    with pytest.raises(InputError, match="outside must be"):
        write_quantized_mesh(tmp_path / "tiles", tin, max_error=1, outside=np.nan)
    with pytest.raises(InputError, match="reference system of the surface is unknown"):
        write_quantized_mesh(tmp_path / "tiles", hill(crs=None), max_error=1)
    with pytest.raises(BudgetExceededError, match=r"level 2[0-9] would have .* tiles"):
        write_quantized_mesh(tmp_path / "tiles", hill(size=10_000), max_error=0.01)
    both = [(179.9, -17, 1), (-179.9, -17, 1), (-179.9, -16, 1), (179.9, -16, 1)]
    with pytest.raises(InputError, match="crosses the 180th meridian"):
        write_quantized_mesh(
            tmp_path / "tiles", TIN.from_points(both, crs="EPSG:4326", planar=True), max_error=10
        )
    wall = [(0, 0, 0), (0.0001, 0, 90), (0.0001, 9, 90), (0, 9, 0), (5, 5, 50)]
    steep = TIN.from_points(np.add(wall, (155_000, 463_000, 0)), crs="EPSG:28992", units="m")
    with pytest.raises(InputError, match="so steep that rounding"):
        write_quantized_mesh(tmp_path / "tiles", steep, max_error=0.3)
