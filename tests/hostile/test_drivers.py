"""Files of geometries that GDAL alone would take for something else."""

from __future__ import annotations

import bz2
import gzip
import json
import lzma
import shutil
from pathlib import Path
from string import Template

import geopandas
import numpy as np
import pyogrio
import pytest
import shapely

from delone import FileFormatError
from delone.io import read_geometries, read_points

CORPUS = Path(__file__).parents[1] / "corpus" / "hostile"
SUFFIXES = (".geojson", ".json", ".gpkg", ".sqlite", ".shp", ".fgb")
PACKED = {".gz": gzip.compress, ".xz": lzma.compress, ".bz2": bz2.compress}
POINTS = shapely.points([(0, 0), (4, 0), (0, 3)])
FRAME = geopandas.GeoDataFrame({"depth": [1.0, 2, 3]}, geometry=POINTS, crs="EPSG:28992")


DRIVERS = {
    ".gpkg": "GPKG",
    ".sqlite": "SQLite",
    ".fgb": "FlatGeobuf",
    ".shp": "ESRI Shapefile",
}
NAMES = ("virtual-dataset", "pipeline", "service", "schema", "link")


def hostile(name, source):
    """A file of the corpus that refers to `source`."""
    text = (CORPUS / f"{name}.txt").read_text(encoding="utf-8")
    return Template(text).substitute(source=source)


def refused(path, canary, listener):
    """Refused by both readers, and nothing else was opened."""
    canary.watch()
    for read in (read_points, read_geometries):
        with pytest.raises(FileFormatError):
            read(path)
    assert not canary.was_opened
    assert listener.requests == []


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("name", NAMES[:2])
def test_another_file_is_not_read(tmp_path, canary, listener, suffix, name):
    path = tmp_path / f"evil{suffix}"
    path.write_text(hostile(name, canary.csv))
    refused(path, canary, listener)


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("name", NAMES)
def test_no_server_is_asked(tmp_path, canary, listener, suffix, name):
    path = tmp_path / f"evil{suffix}"
    source = f"/vsicurl/{listener.url}/a.csv" if name in NAMES[:2] else listener.url
    path.write_text(hostile(name, source))
    refused(path, canary, listener)


@pytest.mark.parametrize("packing", PACKED)
@pytest.mark.parametrize("name", NAMES[:2])
def test_what_is_compressed_is_no_exception(tmp_path, canary, listener, packing, name):
    path = tmp_path / f"evil.geojson{packing}"
    path.write_bytes(PACKED[packing](hostile(name, canary.csv).encode()))
    refused(path, canary, listener)


def test_json_with_a_virtual_dataset_in_it_is_json(tmp_path, canary, listener):
    # GDAL looks for the root element anywhere in the first kilobyte.
    features = json.loads(FRAME.to_json())["features"]
    text = {
        "type": "FeatureCollection",
        "name": hostile("virtual-dataset", canary.csv),
        "features": features,
    }
    path = tmp_path / "evil.geojson"
    path.write_text(json.dumps(text))
    (tmp_path / "evil.geojson.gz").write_bytes(gzip.compress(path.read_bytes()))
    canary.watch()
    for name in ("evil.geojson", "evil.geojson.gz"):
        assert np.array_equal(read_points(tmp_path / name).points, [(0, 0), (4, 0), (0, 3)])
    assert not canary.was_opened
    assert listener.requests == []


@pytest.mark.parametrize("version", [0, 1])
def test_the_first_bytes_alone_make_no_flatgeobuf(tmp_path, canary, listener, version):
    path = tmp_path / "evil.fgb"
    path.write_bytes(
        b"fgb\x03fgb" + bytes([version]) + hostile("virtual-dataset", canary.csv).encode()
    )
    refused(path, canary, listener)


@pytest.mark.parametrize("suffix", [".gpkg", ".sqlite", ".shp", ".fgb"])
def test_other_formats_under_a_suffix_are_refused(tmp_path, suffix):
    FRAME.to_file(tmp_path / "whole.geojson")
    shutil.copy(tmp_path / "whole.geojson", tmp_path / f"other{suffix}")
    with pytest.raises(FileFormatError, match=f"not a {suffix} file"):
        read_points(tmp_path / f"other{suffix}")


@pytest.mark.parametrize("kind", ["topojson", "esri", "features", "lines"])
def test_json_of_other_kinds_is_refused(tmp_path, kind):
    feature = {"type": "Feature", "properties": {}, "geometry": None}
    texts = {
        "topojson": '{"type": "Topology", "objects": {}, "arcs": []}',
        "esri": '{"geometryType": "esriGeometryPoint", "fields": [], "features": []}',
        "features": json.dumps([feature]),
        "lines": f"{json.dumps(feature)}\n{json.dumps(feature)}\n",
    }
    path = tmp_path / "other.json"
    path.write_text(texts[kind])
    with pytest.raises(FileFormatError):
        read_points(path)


@pytest.mark.parametrize("name", ["a!b", "a;b", "a?b", "a#b", "http:b", " a", "a b", "a%20b", "é"])
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_names_are_names_of_files(tmp_path, monkeypatch, name, suffix):
    # A library may take parts of a name for an archive, a query or an address.
    FRAME.to_file(tmp_path / f"plain{suffix}", driver=DRIVERS.get(suffix, "GeoJSON"))
    for file in list(tmp_path.glob("plain.*")):
        shutil.copy(file, tmp_path / f"{name}{file.suffix}")
    monkeypatch.chdir(tmp_path)
    for path in (tmp_path / f"{name}{suffix}", f"{name}{suffix}", f"/{tmp_path}/{name}{suffix}"):
        try:
            found = read_points(path)
        except FileFormatError as error:
            assert suffix not in (".json", ".geojson")
            assert "rename" in str(error)
        else:
            assert len(found) == 3


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_folder_that_looks_like_an_address(tmp_path, monkeypatch, listener, suffix):
    host = listener.url.removeprefix("http://")
    (tmp_path / "http:" / host).mkdir(parents=True)
    FRAME.to_file(
        tmp_path / "http:" / host / f"a{suffix}",
        driver=DRIVERS.get(suffix, "GeoJSON"),
    )
    monkeypatch.chdir(tmp_path)
    assert len(read_points(f"http:/{host}/a{suffix}")) == 3
    assert listener.requests == []


def test_drivers_that_are_checked_are_there():
    # The names that reading compares with are those of GDAL.
    from delone.io.gdal import DRIVERS

    assert set(DRIVERS.values()) <= set(pyogrio.list_drivers(read=True))
    assert set(DRIVERS) == set(SUFFIXES)
