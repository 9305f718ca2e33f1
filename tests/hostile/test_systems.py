"""Reference systems that are files or addresses, in all formats that have some."""

from __future__ import annotations

import json
import sqlite3

import geopandas
import laspy
import numpy as np
import pyarrow.parquet
import pytest
import shapely

import delone
from delone import FileFormatError
from delone.interpolate import grid
from delone.io import GeometrySet, PointSet, read_geometries, read_points, write_mesh, write_raster
from delone.io.systems import names_a_source

POINTS = np.array([(0.0, 0), (4, 0), (0, 3)])
FRAME = geopandas.GeoDataFrame({"a": [1, 2, 3]}, geometry=shapely.points(POINTS), crs="EPSG:28992")
FEATURES = json.loads(FRAME.to_json())["features"]
WKT = 'GEOGCS["x",DATUM["x",SPHEROID["x",6378137,298]],PRIMEM["G",0],UNIT["degree",0.0174]{}]'


def hostile(canary, listener):
    """Reference systems that libraries would follow, by a word for each."""
    (canary.folder / "init").write_text("<1> +proj=longlat +datum=WGS84 <>\n")
    (canary.folder / "a.prj").write_text(WKT.format(""))
    path = canary.folder
    return {
        "init": f"+init={path}/init:1",
        "bare init": f"init={path}/init:1",
        "relative init": "+init=init:1",
        "grids": f"+proj=longlat +ellps=intl +nadgrids={path}/init +type=crs",
        "parameters in WKT": WKT.format(
            f',EXTENSION["PROJ4","+proj=longlat +nadgrids={path}/init"]'
        ),
        "grids in WKT": WKT.format(f',EXTENSION ( "PROJ4_GRIDS" , "{path}/init" )'),
        "init in WKT": WKT.format(f',extension["PROJ4","+init={path}/init:1"]'),
        "another quote": WKT.format(f",EXTENSION[“PROJ4”,“+init={path}/init:1”]"),
        "path": f"{path}/a.prj",
        "address": f"{listener.url}/system",
        "file": f"file://{path}/a.prj",
        "like opengis": f"{listener.url}/opengis.net/def/crs/EPSG/0/4326",
    }


WORDS = (
    "init", "bare init", "relative init", "grids", "parameters in WKT", "grids in WKT",
    "init in WKT", "another quote", "path", "address", "file", "like opengis",
)  # fmt: skip


@pytest.fixture(params=WORDS)
def system(request, canary, listener):
    made = hostile(canary, listener)[request.param]
    canary.watch()
    yield made
    assert not canary.was_opened
    assert listener.requests == []


def test_words_are_all_there(canary, listener):
    assert set(WORDS) == set(hostile(canary, listener))


@pytest.mark.parametrize(
    "system",
    [
        "EPSG:28992",
        "epsg:4326",
        "+init=epsg:28992",
        "OGC:CRS84",
        "ESRI:102100",
        "IAU_2015:49910",
        "urn:ogc:def:crs:OGC:1.3:CRS84",
        "urn:ogc:def:crs:EPSG::28992",
        "http://www.opengis.net/def/crs/EPSG/0/28992",
        "http://www.opengis.net/gml/srs/epsg.xml#28992",
        "Amersfoort / RD New",
        "WGS84",
        "",
        "+proj=utm +zone=31 +datum=WGS84 +type=crs",
        "+proj=merc +a=6378137 +b=6378137 +nadgrids=@null +wktext +no_defs",
        FRAME.crs.to_wkt(),
        FRAME.crs.to_wkt("WKT1_GDAL"),
        geopandas.GeoSeries([], crs="EPSG:3857").crs.to_wkt("WKT1_GDAL"),
        FRAME.crs.to_json(),
        FRAME.crs.to_json_dict(),
        geopandas.GeoSeries([], crs="EPSG:27572").crs.to_json_dict(),
        geopandas.GeoSeries([], crs="+proj=longlat +nadgrids=@null +ellps=intl").crs.to_json_dict(),
    ],
)
def test_usual_systems_name_nothing_else(system):
    assert not names_a_source(system)


@pytest.mark.parametrize(
    "system",
    [
        {"init": "elsewhere"},
        {"proj": "longlat", "nadgrids": "elsewhere"},
        {"type": "BoundCRS", "transformation": {"parameters": [{"value": "/somewhere"}]}},
        '{"init": "/somewhere"}',
        '{"init": ',
        "[" * 100000,
        "C:\\systems\\a.prj",
        "..\\a.prj",
        "~/a.prj",
        " /a.prj",
    ],
)
def test_other_forms_are_seen(system):
    assert names_a_source(system) or str(system).startswith("[")


def test_sets_refuse_them(system):
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        PointSet(points=POINTS, crs=system)
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        GeometrySet(geometries=shapely.points(POINTS), crs=system)


def _spelled(system):
    """Members of JSON that GDAL takes for a reference system."""
    name = {"type": "name", "properties": {"name": system}}
    plain = json.dumps(name)
    yield '"crs": ' + plain
    yield '"crs": ' + json.dumps({"type": "name", "properties": {"name": system, "more": 1}})
    yield '"crs": ' + json.dumps({"properties": {"name": system}, "type": "name"})
    yield '"crs" : {"type":"OGC","properties":{"urn":' + json.dumps(system) + "}}"
    yield '"\\u0063rs": ' + plain
    yield '"CRS": ' + plain.replace('"type"', '"TYPE"')
    yield '"crs": null, "crs": ' + plain
    for kind, key in (("link", "href"), ("url", "url"), ("LINK", "href")):
        yield '"crs": ' + json.dumps({"type": kind, "properties": {key: system, "url": system}})


@pytest.mark.parametrize("spelling", range(10))
@pytest.mark.parametrize("where", ["top", "geometry"])
def test_geojson(tmp_path, system, spelling, where):
    member = list(_spelled(system))[spelling]
    features = json.dumps(FEATURES)
    if where == "geometry":
        features = features.replace('"type": "Point"', f'"type": "Point", {member}')
        member = '"name": "a"'
    path = tmp_path / "a.geojson"
    path.write_text(f'{{"type": "FeatureCollection", {member}, "features": {features}}}')
    for read in (read_points, read_geometries):
        with pytest.raises(FileFormatError, match="reference system"):
            read(path)


@pytest.mark.parametrize(
    "member",
    [
        '"crs": null',
        '"crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::28992"}}',
        '"crs": {"properties": {"name": "urn:ogc:def:crs:EPSG::28992"}, "type": "name"}',
        '"note": "crs", "crs": {"type": "EPSG", "properties": {"code": 28992}}',
        '"\\u0063rs": {"type": "name", "properties": {"name": "EPSG:28992"}}',
    ],
)
def test_geojson_with_usual_systems_is_read(tmp_path, member):
    path = tmp_path / "a.geojson"
    text = f'{{"type": "FeatureCollection", {member}, "features": {json.dumps(FEATURES)}}}'
    path.write_text(text)
    survey = read_points(path)
    assert np.array_equal(survey.points, POINTS)
    assert survey.crs == ("EPSG:4326" if "null" in member else "EPSG:28992")
    path.write_text(text.replace('"properties": {"a"', '"properties": {"crs": "/a", "a"'))
    assert len(read_points(path, attributes=["crs"])) == 3


def test_geojson_that_is_not_strict_is_refused_with_systems(tmp_path, listener):
    path = tmp_path / "a.geojson"
    system = "{'type': 'link', 'properties': {'href': '" + listener.url + "'}}"
    path.write_text(
        f'{{"type": "FeatureCollection", "crs": {system}, "features": {json.dumps(FEATURES)}}}'
    )
    with pytest.raises(FileFormatError):
        read_points(path)
    assert listener.requests == []


def harmless_or_refused(path, system):
    """GDAL itself leaves out what it does not follow; what it keeps is refused."""
    try:
        found = read_points(path).crs
    except FileFormatError as error:
        assert "names a file or a URL" in str(error)
    else:
        assert found is None or "init" not in found


def test_shapefile(tmp_path, system):
    FRAME.to_file(tmp_path / "a.shp")
    (tmp_path / "a.prj").write_text(system)
    harmless_or_refused(tmp_path / "a.shp", system)


def test_geopackage(tmp_path, system):
    path = tmp_path / "a.gpkg"
    FRAME.to_file(path)
    base = sqlite3.connect(path)
    base.execute(
        "UPDATE gpkg_spatial_ref_sys SET definition = ?, organization = 'NONE', "
        "organization_coordsys_id = 99999 WHERE srs_id = 28992",
        (system,),
    )
    base.commit()
    base.close()
    harmless_or_refused(path, system)


def test_flatgeobuf(tmp_path, system):
    own = "+proj=laea +lat_0=1.2345 +lon_0=2.345 +datum=WGS84"
    geopandas.GeoDataFrame(geometry=shapely.points(POINTS), crs=own).to_file(tmp_path / "a.fgb")
    whole = (tmp_path / "a.fgb").read_bytes()
    start = whole.index(b"PROJC")
    length = int.from_bytes(whole[start - 4 : start], "little")
    text = system.encode()
    assert len(text) <= length
    wrong = whole[:start] + text.ljust(length) + whole[start + length :]
    (tmp_path / "a.fgb").write_bytes(wrong)
    harmless_or_refused(tmp_path / "a.fgb", system)


def test_geoparquet(tmp_path, system):
    path = tmp_path / "a.parquet"
    FRAME.to_parquet(path)
    table = pyarrow.parquet.read_table(path)
    facts = json.loads(table.schema.metadata[b"geo"])
    for found in (system, {"init": system}):
        facts["columns"]["geometry"]["crs"] = found
        other = table.replace_schema_metadata({b"geo": json.dumps(facts).encode()})
        pyarrow.parquet.write_table(other, path)
        for read in (read_points, read_geometries):
            with pytest.raises(FileFormatError, match="names a file or a URL"):
                read(path)


def test_npz(tmp_path, system):
    np.savez(tmp_path / "a.npz", points=POINTS, crs=np.array(system))
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        read_points(tmp_path / "a.npz")


def test_las(tmp_path, system):
    data = laspy.create(point_format=6, file_version="1.4")
    data.x, data.y, data.z = *POINTS.T, np.zeros(3)
    data.header.global_encoding.wkt = True
    data.header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(system))
    data.write(tmp_path / "a.las")
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        read_points(tmp_path / "a.las")


def test_manifest(tmp_path, system):
    from delone import distributed

    folder = tmp_path / "tin"
    distributed.triangulate(delone.datasets.grid(100), folder, tile_points=50)
    manifest = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps(manifest | {"crs": system}))
    with pytest.raises(FileFormatError, match="crs is"):
        distributed.open(folder)


@pytest.mark.parametrize("suffix", [".gpkg", ".geojson", ".tif"])
def test_nothing_is_opened_for_a_file_to_be_written(tmp_path, system, suffix):
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        if suffix == ".tif":
            write_raster(tmp_path / "a.tif", _ramp(), crs=system)
        else:
            write_mesh(tmp_path / f"a{suffix}", delone.Delaunay(POINTS), crs=system)
    assert not (tmp_path / f"a{suffix}").exists()


def _ramp():
    return grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], resolution=1)


def test_a_name_is_no_file_to_geotiff(tmp_path, monkeypatch, canary):
    # GDAL would open a file of this name in the working folder.
    (canary.folder / "a.prj").write_text(WKT.format(""))
    monkeypatch.chdir(canary.folder)
    canary.watch()
    with pytest.raises(FileFormatError, match="an authority and a code"):
        write_raster(tmp_path / "a.tif", _ramp(), crs="a.prj")
    assert not canary.was_opened


@pytest.mark.parametrize("crs", ["EPSG:28992", "+proj=utm +zone=31", FRAME.crs.to_wkt(), None])
def test_usual_systems_are_written(tmp_path, crs):
    write_raster(tmp_path / "a.tif", _ramp(), crs=crs)
    write_mesh(tmp_path / "a.gpkg", delone.Delaunay(POINTS), crs=crs)
    assert (read_geometries(tmp_path / "a.gpkg").crs is None) == (crs is None)
