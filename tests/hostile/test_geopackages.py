"""GeoPackages and SQLite files are databases: their tables and views may call functions."""

from __future__ import annotations

import sqlite3
from contextlib import closing, suppress

import geopandas
import numpy as np
import pyogrio
import pytest
import rasterio
import shapely

from delone import FileFormatError
from delone.io import read_points

POINTS = np.array([(0.0, 0), (4, 0), (0, 3)])
FRAME = geopandas.GeoDataFrame({"a": [1, 2, 3]}, geometry=shapely.points(POINTS), crs="EPSG:28992")


@pytest.fixture
def package(tmp_path):
    path = tmp_path / "a.gpkg"
    FRAME.to_file(path, layer="a")
    return path


def execute(path, *statements):
    with closing(sqlite3.connect(path)) as base:
        base.execute("PRAGMA writable_schema = 1")
        for statement in statements:
            base.execute(statement)
        base.commit()


def view(select):
    return (
        f"CREATE VIEW v AS {select}",
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) "
        "VALUES ('v', 'features', 'v', 28992)",
        "INSERT INTO gpkg_geometry_columns VALUES ('v', 'geom', 'POINT', 28992, 0, 0)",
    )


def virtual_table(module, arguments):
    text = f"CREATE VIRTUAL TABLE v USING {module}({arguments})".replace("'", "''")
    return (
        "INSERT INTO sqlite_master (type, name, tbl_name, rootpage, sql) "
        f"VALUES ('table', 'v', 'v', 0, '{text}')",
        "INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) "
        "VALUES ('v', 'attributes', 'v', 28992)",
    )


@pytest.mark.parametrize("layer", [None, "a", "v"])
@pytest.mark.parametrize(
    ("module", "arguments"),
    [
        ("VirtualShape", "'{folder}/shape', 'UTF-8', 28992"),
        ("VirtualDbf", "'{folder}/shape.dbf', 'UTF-8'"),
        ("VirtualText", "'{folder}/secret.csv', 'UTF-8', 1, POINT, NONE, ','"),
        ("VirtualOGR", "'{folder}/secret.csv'"),
        ("VirtualGeoJSON", "'{folder}/a.geojson', 28992"),
        ("VirtualXL", "'{folder}/a.xls'"),
    ],
)
def test_virtual_tables(package, canary, layer, module, arguments):
    FRAME.to_file(canary.folder / "shape.shp")
    FRAME.to_file(canary.folder / "a.geojson")
    execute(package, *virtual_table(module, arguments.format(folder=canary.folder)))
    canary.watch()
    with pytest.raises(FileFormatError, match="table or view 'v'"):
        read_points(package, layer=layer)
    assert not canary.was_opened


@pytest.mark.parametrize(
    "expression",
    [
        "gdal_get_pixel_value('{folder}/a.tif', 1, 'pixel', 0, 0)",
        "gdal_get_pixel_value('/vsicurl/{url}/a.tif', 1, 'pixel', 0, 0)",
        "gdal_get_layer_pixel_value('{folder}/a.tif', 1, 'pixel', 0, 0)",
        "ogr_geocode('Paris', 'display_name', '{url}')",
        "BlobFromFile('{folder}/secret.csv')",
        "readfile('{folder}/secret.csv')",
        "XB_LoadXML('{url}')",
        "XB_Create(CAST('<a/>' AS BLOB), 0, '{url}')",
        "ST_AsText(ST_Transform(geom, 4326, NULL, '+init={folder}/secret.csv:1', 'EPSG:4326'))",
    ],
)
@pytest.mark.parametrize("layer", [None, "a", "v"])
def test_functions_in_views(package, canary, listener, expression, layer):
    options = {"driver": "GTiff", "width": 1, "height": 1, "count": 1, "dtype": "float64"}
    transform = rasterio.Affine(1, 0, 0, 0, -1, 0)
    with rasterio.open(canary.folder / "a.tif", "w", transform=transform, **options) as file:
        file.write(np.full((1, 1), 4242.0), 1)
    call = expression.format(folder=canary.folder, url=listener.url)
    execute(package, *view(f"SELECT fid, geom, {call} AS a FROM a"))
    canary.watch()
    with pytest.raises(FileFormatError, match="table or view 'v'"):
        read_points(package, layer=layer)
    assert not canary.was_opened
    assert listener.requests == []


@pytest.mark.parametrize("layer", [None, "a", "v"])
@pytest.mark.parametrize(
    "definition",
    [
        "CREATE VIRTUAL TABLE v USING VirtualOGR('{folder}/secret.csv')",
        "CREATE VIRTUAL TABLE v USING VirtualText('{folder}/secret.csv', 'UTF-8', 1)",
        "CREATE VIEW v AS SELECT ogc_fid, GEOMETRY, readfile('{folder}/secret.csv') AS a FROM a",
        "CREATE VIEW v AS SELECT * FROM a, ogr_layer_Extent('{folder}/secret.csv')",
    ],
)
def test_tables_of_sqlite_files(tmp_path, canary, definition, layer):
    path = tmp_path / "a.sqlite"
    FRAME.to_file(path, layer="a", driver="SQLite")
    assert read_points(path, attributes=["a"]).attributes["a"].tolist() == [1, 2, 3]
    text = definition.format(folder=canary.folder).replace("'", "''")
    kind = "view" if " VIEW " in definition else "table"
    execute(
        path,
        "INSERT INTO sqlite_master (type, name, tbl_name, rootpage, sql) "
        f"VALUES ('{kind}', 'v', 'v', 0, '{text}')",
        "INSERT INTO geometry_columns (f_table_name, f_geometry_column, geometry_type, "
        "coord_dimension, srid, geometry_format) VALUES ('v', 'GEOMETRY', 1, 2, 28992, 'WKB')",
    )
    canary.watch()
    with pytest.raises(FileFormatError, match="table or view 'v'"):
        read_points(path, layer=layer)
    assert not canary.was_opened


def test_databases_have_their_own_suffix(package, tmp_path):
    package.rename(tmp_path / "b.sqlite")
    FRAME.to_file(tmp_path / "c.sqlite", driver="SQLite")
    (tmp_path / "c.sqlite").rename(tmp_path / "c.gpkg")
    for name in ("b.sqlite", "c.gpkg"):
        with pytest.raises(FileFormatError, match="it does not begin like one"):
            read_points(tmp_path / name)


def test_functions_in_columns(package, canary):
    call = f"BlobFromFile(''{canary.csv}'')"
    execute(
        package,
        "UPDATE sqlite_master SET sql = substr(sql, 1, length(sql) - 1) || "
        f"', more TEXT GENERATED ALWAYS AS ({call}) VIRTUAL)' WHERE name = 'a'",
    )
    canary.watch()
    with pytest.raises(FileFormatError):
        read_points(package)
    assert not canary.was_opened


def test_plain_views_are_read(package):
    execute(package, *view("SELECT fid, geom, abs(-a) + round(1.5) AS a FROM a WHERE a > 1"))
    survey = read_points(package, layer="v", attributes=["a"])
    assert np.array_equal(survey.points, POINTS[1:])
    assert survey.attributes["a"].astype(float).tolist() == [4, 5]


def test_computed_columns_are_read(package):
    execute(package, "ALTER TABLE a ADD COLUMN twice REAL GENERATED ALWAYS AS (2 * a) VIRTUAL")
    assert read_points(package, attributes=["twice"]).attributes["twice"].tolist() == [2, 4, 6]


@pytest.mark.parametrize("application", [0, 0x4D504258])
def test_other_databases_are_refused(package, application):
    execute(package, f"PRAGMA application_id = {application}")
    with pytest.raises(FileFormatError, match=r"not a \.gpkg file"):
        read_points(package)


def test_a_journal_beside_is_no_way_out(package, canary):
    # A journal may name another one, which SQLite would look for and remove.
    name = bytes(canary.csv)
    whole = package.read_bytes()
    pages = len(whole) // 4096
    head = b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7" + (0).to_bytes(4) + bytes(4) + pages.to_bytes(4)
    head += (512).to_bytes(4) + (4096).to_bytes(4)
    tail = (262145).to_bytes(4) + name + len(name).to_bytes(4)
    tail += (sum(name) % 2**32).to_bytes(4) + b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7"
    package.with_name("a.gpkg-journal").write_bytes(head.ljust(512, b"\0") + tail)
    canary.watch()
    with suppress(FileFormatError):
        assert len(read_points(package)) == 3
    assert not canary.was_opened
    assert canary.csv.exists()
    assert package.read_bytes() == whole


@pytest.mark.parametrize(
    "note",
    [
        "<Metadata domain='OVERVIEWS'><MDI key='OVERVIEW_FILE'>{file}</MDI></Metadata>",
        "<Metadata domain='xml:a'><a href='{url}'/></Metadata>",
        "<SRS>+init={file}:1</SRS>",
        "<SRS>{url}</SRS>",
    ],
)
def test_notes_of_gdal_are_not_followed(package, canary, listener, note):
    notes = package.with_name("a.gpkg.aux.xml")
    text = note.format(file=canary.csv, url=listener.url)
    notes.write_text(f"<PAMDataset>{text}</PAMDataset>")
    canary.watch()
    assert np.array_equal(read_points(package).points, POINTS)
    assert not canary.was_opened
    assert listener.requests == []


def test_notes_of_gdal_are_not_read(package, canary):
    package.with_name("a.gpkg.aux.xml").symlink_to(canary.csv)
    triggers = "SELECT name FROM sqlite_master WHERE type = 'trigger'"
    with closing(sqlite3.connect(package)) as base:
        base.execute("PRAGMA journal_mode = WAL")
        # Triggers call functions that only programs for GeoPackage have.
        for (name,) in base.execute(triggers).fetchall():
            base.execute(f'DROP TRIGGER "{name}"')
        base.execute("UPDATE a SET a = a + 10")
        base.commit()
        canary.watch()
        found = read_points(package, attributes=["a"]).attributes["a"]
    assert found.tolist() == [11, 12, 13]
    assert not canary.was_opened


@pytest.mark.parametrize("suffix", [".gpkg", ".sqlite"])
def test_databases_without_geometries_say_so(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    if suffix == ".gpkg":
        pyogrio.write_dataframe(FRAME.drop(columns="geometry"), path, layer="t")
    else:
        execute(path, "CREATE TABLE t (a)", "INSERT INTO t VALUES (1)")
    for layer in (None, "t"):
        with pytest.raises(FileFormatError, match="has no column of geometries"):
            read_points(path, layer=layer)
    if suffix == ".sqlite":
        path.unlink()
        execute(path, "CREATE TABLE t (a)", "DROP TABLE t")
        with pytest.raises(FileFormatError, match="contains no layers"):
            read_points(path)
