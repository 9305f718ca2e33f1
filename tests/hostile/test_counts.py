"""Counts in headers, recursive views and links: all that would never end, or lead elsewhere."""

from __future__ import annotations

import base64
import bz2
import gzip
import lzma
import shutil
import sqlite3
import struct
import tracemalloc
import zlib
from contextlib import closing

import geopandas
import numpy as np
import pytest
import shapely

import delone
from delone import FileFormatError, distributed
from delone._base import bounded
from delone.io import read_mesh, read_points
from delone.io.gmsh import needed_sections
from delone.io.triangle import read_triangle

HUGE = 9_000_000_000_000
NODES = {
    "2.2": "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n",
    "4.0": "$Nodes\n1 3\n1 2 0 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n",
    "4.1": "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n",
}
ELEMENTS = {
    "2.2": "$Elements\n1\n1 2 2 0 1 1 2 3\n$EndElements\n",
    "4.0": "$Elements\n1 1\n1 2 2 1\n1 1 2 3\n$EndElements\n",
    "4.1": "$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n",
}
SECTIONS = {
    "strings": f'$NodeData\n{HUGE}\n"a"\n$EndNodeData\n',
    "strings of elements": f'$ElementData\n{HUGE}\n"a"\n$EndElementData\n',
    "reals": f'$NodeData\n1\n"a"\n{HUGE}\n$EndNodeData\n',
    "integers": f'$NodeData\n1\n"a"\n0\n{HUGE}\n$EndNodeData\n',
    "items": f'$NodeData\n1\n"a"\n0\n3\n0\n1\n{HUGE}\n1 5\n$EndNodeData\n',
    "names": f"$PhysicalNames\n{HUGE}\n$EndPhysicalNames\n",
    "periodic": f"$Periodic\n{HUGE}\n$EndPeriodic\n",
    "entities": f"$Entities\n{HUGE} 0 0 0\n$EndEntities\n",
    "spelled": f'$\u00a0NodeData\n{HUGE}\n"a"\n$EndNodeData\n',
}


def msh(version, *sections):
    return f"$MeshFormat\n{version} 0 8\n$EndMeshFormat\n" + "".join(sections)


def test_torn_entities_of_msh(tmp_path):
    """Counts and numbers of groups that are changed are an error, or other markers."""
    path = tmp_path / "a.msh"
    square = [(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0)]
    mesh = delone.mesh(square, max_area=2, segment_markers=[4, 4, 0, 6], regions=[(1, 1, 5)])
    delone.io.write_mesh(path, mesh, version="4.1")
    good = path.read_bytes()
    assert (read_mesh(path).markers == 5).all()
    start, end = good.index(b"$Entities\n") + 10, good.index(b"\n$EndEntities")
    refused = 0
    tracemalloc.start()
    for at in range(start, end, 4):
        for wrong in (b"\xff" * 4, b"\0\0\0\x7f", b"\1\0\0\0"):
            path.write_bytes(good[:at] + wrong + good[at + 4 :])
            try:
                assert len(read_mesh(path).markers) == mesh.nsimplex
            except FileFormatError:
                refused += 1
    assert tracemalloc.get_traced_memory()[1] < 1 << 26
    tracemalloc.stop()
    assert refused > 20
    for stop in range(start + 1, end, 7):
        path.write_bytes(good[:stop] + good[end:])
        with pytest.raises(FileFormatError):
            read_mesh(path)


@pytest.mark.parametrize("version", NODES)
@pytest.mark.parametrize("name", SECTIONS)
def test_sections_that_are_not_needed_are_left_out(tmp_path, version, name):
    path = tmp_path / "a.msh"
    parts = SECTIONS[name], NODES[version] + ELEMENTS[version]
    for sections in (parts, parts[::-1]):
        path.write_text(msh(version, *sections))
        if name == "entities" and version != "2.2":
            # They say which groups triangles are in.
            with pytest.raises(FileFormatError, match="declares more"):
                read_mesh(path)
        else:
            assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]
    if name in ("strings", "reals", "integers", "items", "spelled"):
        with pytest.raises(FileFormatError, match="declares"):
            read_points(path, attributes=["a"])
    else:
        with pytest.raises(FileFormatError, match="no values 'a'"):
            read_points(path, attributes=["a"])


@pytest.mark.parametrize("version", NODES)
def test_values_that_are_asked_for_are_read(tmp_path, version):
    data = '$NodeData\n1\n"{}"\n1\n0.0\n3\n0\n1\n3\n1 5\n2 6\n3 7\n$EndNodeData\n'
    path = tmp_path / "a.msh"
    path.write_text(
        msh(version, NODES[version], ELEMENTS[version], data.format("a"), data.format("b"))
    )
    assert read_points(path, attributes=["b"]).attributes["b"].tolist() == [5, 6, 7]
    with needed_sections(path, ["b"]) as part:
        assert '"a"' not in part.read_text()


@pytest.mark.parametrize("version", NODES)
@pytest.mark.parametrize("count", [4, 10**6, HUGE, -1])
def test_every_count_of_a_block_is_compared(tmp_path, version, count):
    path = tmp_path / "a.msh"
    texts = {"Nodes": NODES[version].split("\n"), "Elements": ELEMENTS[version].split("\n")}
    for name, lines in texts.items():
        # The counts are in the first line, and in that of the block.
        heads = lines[1:2] if version == "2.2" else lines[1:3]
        for k, line in enumerate(heads, 1):
            for place, word in enumerate(line.split()):
                if word != "3" and name == "Nodes" and k == 2:
                    continue
                words = [*line.split()[:place], str(count), *line.split()[place + 1 :]]
                wrong = [*lines[:k], " ".join(words), *lines[k + 1 :]]
                changed = texts | {name: wrong}
                path.write_text(msh(version, *("\n".join(each) for each in changed.values())))
                tracemalloc.start()
                try:
                    # Numbers of entities, and the least and largest of version 4.1, have no use.
                    assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]
                except FileFormatError:
                    pass
                finally:
                    peak = tracemalloc.get_traced_memory()[1]
                    tracemalloc.stop()
                assert peak < 1 << 24


def test_a_large_number_of_a_node(tmp_path):
    path = tmp_path / "a.msh"
    for version, nodes in NODES.items():
        text = nodes.replace("\n3\n0 0 0", f"\n{HUGE}\n0 0 0").replace(
            "\n3 0 1 0", f"\n{HUGE} 0 1 0"
        )
        assert text != nodes
        path.write_text(msh(version, text, ELEMENTS[version].replace("2 3\n", f"2 {HUGE}\n")))
        with pytest.raises(FileFormatError, match="renumber the nodes"):
            read_mesh(path)


def test_sections_behind_a_long_comment(tmp_path):
    # Headers were looked for in the first 64 KiB only.
    path = tmp_path / "a.msh"
    comment = "$Comments\n" + "x" * (1 << 17) + "\n$EndComments\n"
    nodes = NODES["4.1"].replace("1 3 1 3", f"1 {HUGE} 1 3")
    path.write_text(msh("4.1", comment, nodes, ELEMENTS["4.1"]))
    with pytest.raises(FileFormatError, match="declares"):
        read_mesh(path)


VTU = (
    '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" {file}>'
    '<UnstructuredGrid><Piece NumberOfPoints="3" NumberOfCells="1"><Points>{points}</Points><Cells>'
    '<DataArray type="Int64" Name="connectivity" format="ascii">0 1 2</DataArray>'
    '<DataArray type="Int64" Name="offsets" format="ascii">3</DataArray>'
    '<DataArray type="Int64" Name="types" format="ascii">{kind}</DataArray>{more}</Cells></Piece>'
    "</UnstructuredGrid>{end}</VTKFile>"
)
PLACES = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0)])
TEXT = (
    '<DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1 0</DataArray>'
)
INLINE = '<DataArray type="Float64" NumberOfComponents="3" format="binary">{}</DataArray>'
APPENDED = '<DataArray type="Float64" NumberOfComponents="3" format="appended" offset="{}"/>'


def packed(data, compress, *, blocks=1, size=None):
    """A compressed array with its header."""
    parts = [compress(data)] * blocks
    head = np.array([blocks, size or len(data), 0, *map(len, parts)], dtype="<u4").tobytes()
    return base64.b64encode(head) + base64.b64encode(b"".join(parts))


COMPRESSORS = {
    "vtkZLibDataCompressor": zlib.compress,
    "vtkLZMADataCompressor": lambda data: lzma.compress(data, preset=0),
}


@pytest.mark.parametrize("name", COMPRESSORS)
def test_compressed_arrays(tmp_path, monkeypatch, name):
    monkeypatch.setattr(bounded, "_ALWAYS", 1 << 20)
    path, compress = tmp_path / "a.vtu", COMPRESSORS[name]
    good = packed(PLACES.tobytes(), compress).decode()
    text = VTU.format(
        file=f'compressor="{name}"', points=INLINE.format("{}"), kind=5, more="", end=""
    )
    path.write_text(text.format(good))
    assert np.array_equal(read_points(path).points, PLACES[:, :2])
    bomb = bytes(1 << 23)
    # What is declared is too much; less is declared than there is; and the same many times.
    for wrong in (packed(bomb, compress), packed(bomb, compress, size=72)):
        path.write_text(text.format(wrong.decode()))
        tracemalloc.start()
        with pytest.raises(FileFormatError, match=r"far more|shorter"):
            read_points(path)
        assert tracemalloc.get_traced_memory()[1] < 1 << 22
        tracemalloc.stop()
    many = base64.b64encode(np.array([HUGE % 2**32, 72, 0], dtype="<u4").tobytes()).decode()
    path.write_text(text.format(many))
    with pytest.raises(FileFormatError, match="shorter"):
        read_points(path)


@pytest.mark.parametrize("order", ["LittleEndian", "BigEndian"])
@pytest.mark.parametrize("header", ["UInt32", "UInt64"])
@pytest.mark.parametrize("form", ["inline", "parts", "base64", "raw"])
def test_forms_of_arrays(tmp_path, order, header, form):
    sign = "<" if order == "LittleEndian" else ">"
    data = PLACES.astype(f"{sign}f8").tobytes()
    head = struct.pack(f"{sign}{'I' if header == 'UInt32' else 'Q'}", len(data))
    both = base64.b64encode(head + data)
    end = b""
    if form == "inline":
        points = INLINE.format(both.decode())
    elif form == "parts":
        points = INLINE.format((base64.b64encode(head) + base64.b64encode(data)).decode())
    else:
        points = APPENDED.format(0)
        end = b'<AppendedData encoding="%s">_%s</AppendedData>' % (
            form.encode(),
            both if form == "base64" else head + data,
        )
    file = f'byte_order="{order}" header_type="{header}"'
    text = VTU.format(file=file, points=points, kind=5, more="", end="\0").encode()
    path = tmp_path / "a.vtu"
    path.write_bytes(text.replace(b"\0", end, 1))
    assert read_mesh(path).simplices.tolist() == [[0, 1, 2]]
    assert np.array_equal(read_points(path).points, PLACES[:, :2])
    path.write_bytes(
        text.replace(b"\0", end[:-40] + end[-15:], 1) if end else path.read_bytes()[:-300]
    )
    with pytest.raises(FileFormatError):
        read_points(path)


@pytest.mark.parametrize("header", ["Int64", "Float64", ""])
def test_sizes_that_may_be_negative(tmp_path, header):
    # A block of -8 bytes, read as raw data, is followed by itself.
    end = b'<AppendedData encoding="raw">_' + struct.pack("<q", -8) + b"x" * 80 + b"</AppendedData>"
    text = VTU.format(
        file=f'header_type="{header}"', points=APPENDED.format(0), kind=5, more="", end="\0"
    )
    (tmp_path / "a.vtu").write_bytes(text.encode().replace(b"\0", end))
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.vtu")


def test_polyhedra_whose_faces_have_no_end(tmp_path):
    # Faces with -1 corners are followed by themselves, as often as their number says.
    more = (
        f'<DataArray type="Int64" Name="faces" format="ascii">{HUGE} -1</DataArray>'
        '<DataArray type="Int64" Name="faceoffsets" format="ascii">2</DataArray>'
    )
    text = VTU.format(file="", points=TEXT, kind=42, more=more, end="")
    (tmp_path / "a.vtu").write_text(text)
    assert len(read_points(tmp_path / "a.vtu")) == 3
    with pytest.raises(FileFormatError, match="polyhedron"):
        read_mesh(tmp_path / "a.vtu")


PLY = "ply\nformat {}\n{}element vertex {}\nproperty float x\nproperty float y\nend_header\n"


@pytest.mark.parametrize("form", ["ascii 1.0", "binary_little_endian 1.0"])
@pytest.mark.parametrize("count", [HUGE, "\uff19\uff19"])
@pytest.mark.parametrize("before", ["", "  ", "element edge 9000000000000\nproperty int a\n "])
def test_counts_of_ply(tmp_path, form, count, before):
    (tmp_path / "a.ply").write_bytes(PLY.format(form, before, count).encode() + b"0 1\n2 3\n" * 4)
    with pytest.raises(FileFormatError):
        read_points(tmp_path / "a.ply")


@pytest.fixture
def package(tmp_path):
    path = tmp_path / "a.gpkg"
    points = shapely.points([(0, 0), (4, 0), (0, 3)])
    geopandas.GeoDataFrame({"a": [1, 2, 3]}, geometry=points, crs="EPSG:28992").to_file(
        path, layer="a"
    )
    return path


def add_view(path, select):
    with closing(sqlite3.connect(path)) as base:
        base.execute(f"CREATE VIEW v AS {select}")
        base.execute(
            "INSERT INTO gpkg_contents (table_name, data_type, identifier, srs_id) "
            "VALUES ('v', 'features', 'v', 28992)"
        )
        base.execute("INSERT INTO gpkg_geometry_columns VALUES ('v', 'geom', 'POINT', 28992, 0, 0)")
        base.commit()


COUNTING = "WITH RECURSIVE r(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM r WHERE i < 1e12) "


@pytest.mark.parametrize(
    "select",
    [
        COUNTING + "SELECT i AS fid, (SELECT geom FROM a) AS geom FROM r",
        COUNTING + "SELECT max(i) AS fid, (SELECT geom FROM a) AS geom FROM r",
        "SELECT 1 AS fid, geom FROM a, (SELECT 1 FROM " + ", ".join(["a"] * 1) + ") JOIN "
        + " JOIN ".join(f"a AS a{k}" for k in range(30)),
        "SELECT fid, zeroblob(900000000) AS geom FROM a",
        "SELECT fid, geom FROM a WHERE sqlite_version() = '3.0'",
        "SELECT fid, geom FROM a WHERE random() > 0",
    ],
)  # fmt: skip
@pytest.mark.parametrize("layer", ["a", "v"])
def test_views_without_end(package, monkeypatch, select, layer):
    monkeypatch.setattr(bounded, "_ALWAYS_TEXT", 1 << 18)
    monkeypatch.setattr(bounded, "EXPANSION", 1)
    assert len(read_points(package)) == 3
    add_view(package, select)
    with pytest.raises(FileFormatError, match="table or view 'v'"):
        read_points(package, layer=layer)


def test_bz2_is_decompressed_before_it_is_parsed(tmp_path, monkeypatch):
    monkeypatch.setattr(bounded, "_ALWAYS_TEXT", 1 << 16)
    path = tmp_path / "a.csv.bz2"
    path.write_bytes(bz2.compress(b"1,2\n" * (1 << 15)))
    monkeypatch.setattr("delone.io.text._layout", None)
    with pytest.raises(FileFormatError, match="more than 200 times"):
        read_points(path)


def link(path, target):
    path.unlink(missing_ok=True)
    try:
        path.symlink_to(target)
    except OSError:
        pytest.skip("links need a privilege")


@pytest.mark.parametrize("suffix", [".dbf", ".shx", ".prj", ".cpg"])
def test_companions_of_a_shapefile_that_are_links(tmp_path, canary, suffix):
    points = shapely.points([(0, 0), (4, 0), (0, 3)])
    frame = geopandas.GeoDataFrame({"a": [1, 2, 3]}, geometry=points, crs="EPSG:28992")
    (tmp_path / "real").mkdir()
    for folder in (tmp_path, tmp_path / "real"):
        frame.to_file(folder / "a.shp")
    link(tmp_path / f"a{suffix}", canary.csv)
    canary.watch()
    with pytest.raises(FileFormatError, match="is a link to another file"):
        read_points(tmp_path / "a.shp")
    assert not canary.was_opened
    # All are links to files beside each other: the file that was named is there.
    for file in (tmp_path / "real").iterdir():
        link(tmp_path / file.name, file)
    assert len(read_points(tmp_path / "a.shp", attributes=["a"])) == 3


@pytest.mark.parametrize("ending", ["-wal", "-shm", "-journal"])
def test_journals_that_are_links(package, canary, ending):
    link(package.with_name(f"a.gpkg{ending}"), canary.csv)
    canary.watch()
    with pytest.raises(FileFormatError, match="is a link to another file"):
        read_points(package)
    assert not canary.was_opened


@pytest.mark.parametrize("dimension", [2, 3])
def test_nodes_that_are_a_link(tmp_path, canary, dimension):
    other = canary.folder / "a.node"
    rows = {2: "3 2 0 0\n0 0 0\n1 1 0\n2 0 1\n", 3: "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n"}
    other.write_text(rows[dimension])
    corners = {2: "1 3 0\n0 0 1 2\n", 3: "1 4 0\n0 0 1 2 3\n"}
    (tmp_path / "a.ele").write_text(corners[dimension])
    link(tmp_path / "a.node", other)
    canary.watch()
    for read in (read_mesh, read_points, *([read_triangle] if dimension == 2 else [])):
        with pytest.raises(FileFormatError, match="is a link to another file"):
            read(tmp_path / "a.ele")
    assert not canary.was_opened


def test_tiles_that_are_links(tmp_path):
    folder, other = tmp_path / "tin", tmp_path / "other"
    distributed.triangulate(delone.datasets.uniform(60), folder, tile_points=50)
    shutil.copytree(folder, other)
    tile = sorted(folder.glob("**/*.parquet"))[0]
    link(tile, other / tile.relative_to(folder))
    with pytest.raises(FileFormatError, match="is a link to another folder"):
        distributed.open(folder).validate()
    # The folder itself may be a link.
    link(tmp_path / "again", other)
    assert distributed.open(tmp_path / "again").validate()


def test_a_gzip_of_geojson_that_expands(tmp_path, monkeypatch):
    monkeypatch.setattr(bounded, "_ALWAYS_TEXT", 1 << 20)
    (tmp_path / "a.geojson.gz").write_bytes(gzip.compress(b" " * (1 << 21)))
    with pytest.raises(FileFormatError, match="more than 200 times"):
        read_points(tmp_path / "a.geojson.gz")
