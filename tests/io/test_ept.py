"""Entwine Point Tiles: those of a writer that follows the specification, and hostile ones."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.lib.recfunctions import repack_fields

from delone import FileFormatError
from delone.cli import run
from delone.io import ept, las, read_geometries, read_points
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

laspy = pytest.importorskip("laspy")

Key = tuple[int, int, int, int]
# The edge of the root, and the level of nodes that keep all of their points.
SIDE, LAST = 128.0, 3
SCALE = 1 / 128
RECORD = [
    ("X", "i4"), ("Y", "i4"), ("Z", "i4"),
    ("Intensity", "u2"), ("Classification", "u1"), ("GpsTime", "f8"),
]  # fmt: skip
KINDS = {"i": "signed", "u": "unsigned", "f": "float"}


def name_of(key: Key) -> str:
    return "-".join(map(str, key))


def survey(seed: int = 0, count: int = 3000) -> NDArray[Any]:
    """Records whose coordinates are multiples of the scale, so that all formats keep them."""
    dice = np.random.default_rng(seed)
    found = np.zeros(count, dtype=RECORD)
    for axis, size in (("X", SIDE), ("Y", SIDE), ("Z", 20)):
        found[axis] = dice.integers(0, size / SCALE, count)
    found["Intensity"] = np.arange(count)
    found["Classification"] = dice.integers(1, 4, count)
    found["GpsTime"] = dice.random(count)
    # On borders of nodes far below the root, and on those of boxes.
    found["X"][-40:], found["Y"][-80:-40] = 64 / SCALE, 32 / SCALE
    return found


def coordinates(records: NDArray[Any]) -> NDArray[np.float64]:
    return np.column_stack([records[axis] * SCALE for axis in "XYZ"])


def octree(records: NDArray[Any]) -> dict[Key, NDArray[Any]]:
    """Return the points of each node: the first few of those that come to it stay."""
    found: dict[Key, NDArray[Any]] = {}

    def fill(key: Key, rows: NDArray[Any]) -> None:
        most = len(rows) if key[0] == LAST else 40
        found[key], rest = rows[:most], rows[most:]
        side = SIDE / 2 ** (key[0] + 1)
        below = (coordinates(rest) // side).astype(int)
        for place in np.unique(below, axis=0).tolist():
            fill((key[0] + 1, *place), rest[(below == place).all(axis=1)])

    fill((0, 0, 0, 0), records)
    return found


def write_node(path: Path, records: NDArray[Any], offset: float) -> None:
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.full(3, SCALE), np.array([offset, -offset, 0.0])
    data = laspy.LasData(header)
    data.x, data.y, data.z = (coordinates(records) + np.array([offset, -offset, 0])).T
    data.intensity = records["Intensity"]
    data.classification, data.gps_time = records["Classification"], records["GpsTime"]
    data.write(path)


def write(
    folder: Path,
    records: NDArray[Any],
    kind: str = "laszip",
    pages: int | None = None,
    offset: float = 0.0,
    **changes: Any,
) -> Path:
    """Write an octree; nodes of level `pages` have pages of their own. Returns the named file."""
    for name in ("ept-data", "ept-hierarchy"):
        (folder / name).mkdir(parents=True)
    nodes = octree(records)
    counts: dict[str, dict[str, int]] = {"0-0-0-0": {}}
    for key, some in nodes.items():
        page = "0-0-0-0"
        if pages is not None and key[0] >= pages:
            up = key[0] - pages
            page = name_of((pages, *(each >> up for each in key[1:])))
            if key[0] == pages:
                counts["0-0-0-0"][page] = -1
        counts.setdefault(page, {})[name_of(key)] = len(some)
        if kind == "laszip":
            write_node(folder / f"ept-data/{name_of(key)}.laz", some, offset)
        else:
            some.tofile(folder / f"ept-data/{name_of(key)}.bin")
    for page, content in counts.items():
        (folder / f"ept-hierarchy/{page}.json").write_text(json.dumps(content), encoding="utf-8")
    schema = []
    for name, (dtype, _) in records.dtype.fields.items():
        each = {"name": name, "type": KINDS[dtype.kind], "size": dtype.itemsize}
        shift = {"X": offset, "Y": -offset, "Z": 0}
        schema.append(each | ({"scale": SCALE, "offset": shift[name]} if name in "XYZ" else {}))
    content = {
        "bounds": [offset, -offset, 0, offset + SIDE, SIDE - offset, SIDE],
        "boundsConforming": [offset, -offset, 0, offset + SIDE, SIDE - offset, 20],
        "dataType": kind,
        "hierarchyType": "json",
        "points": len(records),
        "schema": schema,
        "span": 128,
        "srs": {"authority": "EPSG", "horizontal": "28992", "wkt": "PROJCS[]"},
        "version": "1.0.0",
    }
    file = folder / "ept.json"
    file.write_text(json.dumps(content | changes), encoding="utf-8")
    return file


def ordered(found: Any) -> NDArray[Any]:
    """Return points in the order of their numbers, which are their intensities."""
    table = np.column_stack((found.points, found.z))
    order = np.argsort(found.attributes["intensity"])
    return table[order]


@pytest.mark.parametrize("pages", [None, 1, 2])
@pytest.mark.parametrize("kind", ["laszip", "binary"])
def test_all_points_are_read(tmp_path: Path, kind: str, pages: int | None) -> None:
    records = survey()
    file = write(tmp_path / "tiles", records, kind, pages, offset=1000.0)
    found = read_points(file, attributes=["intensity", "classification", "gps_time"])
    assert np.array_equal(ordered(found), coordinates(records) + np.array([1000, -1000, 0]))
    order = found.attributes["intensity"]
    for name, column in (("classification", "Classification"), ("gps_time", "GpsTime")):
        assert np.array_equal(found.attributes[name], records[column][order])
    assert (found.crs, found.source) == ("EPSG:28992", str(file))
    # Nodes follow by level and position, their points as in the file.
    nodes = [some["Intensity"] for _, some in sorted(octree(records).items())]
    assert np.array_equal(order, np.concatenate(nodes))
    everything = read_points(file, attributes="all").attributes
    assert {"intensity", "classification", "gps_time"} <= set(everything)
    assert not {"X", "Y", "Z"} & set(everything)


BOXES = [
    (0, 0, 128, 128),
    (64, 10, 70, 30),
    (20, 32, 60, 32),
    (64, 0, 64, 128),
    (60, 60, 68, 68),
    (96.5, 96.5, 99, 120),
]


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("kind", ["laszip", "binary"])
def test_points_inside_of_bounds_are_those_of_a_mask(tmp_path: Path, kind: str, box: Any) -> None:
    records = survey()
    file = write(tmp_path / "tiles", records, kind, 1)
    x, y, _ = coordinates(records).T
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    assert inside.sum() > 1
    found = read_points(file, attributes=["intensity"], bounds=box)
    assert np.array_equal(ordered(found), coordinates(records[inside]))
    of_class = inside & np.isin(records["Classification"], [1, 3])
    found = read_points(file, attributes=["intensity"], bounds=box, classes=[1, 3])
    assert np.array_equal(ordered(found), coordinates(records[of_class]))


def test_coordinates_that_were_rounded_out_of_their_node(tmp_path: Path) -> None:
    """Nodes begin a quarter of the resolution to the right of the points at their border."""
    records = survey()
    bounds = [SCALE / 4, 0, 0, SCALE / 4 + SIDE, SIDE, SIDE]
    file = write(tmp_path / "tiles", records, "binary", 1, bounds=bounds)
    x = records["X"] * SCALE
    found = read_points(file, attributes=["intensity"], bounds=(63, 0, 64, SIDE))
    assert np.array_equal(ordered(found), coordinates(records[(x >= 63) & (x <= 64)]))
    assert (found.points[:, 0] == 64).sum() >= 40


@pytest.mark.parametrize("kind", ["laszip", "binary"])
def test_only_files_that_meet_the_bounds_are_opened(tmp_path: Path, kind: str) -> None:
    records = survey()
    file = write(tmp_path / "tiles", records, kind, 1)
    box = (96.5, 96.5, 99, 120)
    right = read_points(file, bounds=box)
    # What is elsewhere may be missing: three of the four quadrants, with their pages.
    kept = 0
    for path in [*file.parent.glob("ept-data/*"), *file.parent.glob("ept-hierarchy/*")]:
        level, x, y, _ = map(int, path.stem.split("-"))
        if level and not (x >> (level - 1) and y >> (level - 1)):
            path.unlink()
        else:
            kept += 1
    assert kept > 10
    assert np.array_equal(read_points(file, bounds=box).points, right.points)
    with pytest.raises(FileFormatError, match=r"there is no file ept-hierarchy/1-\d-\d-\d.json"):
        read_points(file)


def test_surfaces_and_commands(tmp_path: Path, capsys: Any) -> None:
    records = survey()
    file = write(tmp_path / "tiles", records, "binary")
    tin = TIN.from_file(file, bounds=(10, 10, 50, 50), duplicates="min")
    assert tin.npoints > 200 and tin.max_bound.max() <= 50 and tin.crs == "EPSG:28992"

    assert run(["info", str(file), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert (figures["points"], figures["ept_data"]) == (3000, "binary")
    assert figures["file_bytes"] == 3000 * records.dtype.itemsize
    assert sum(figures["classes"].values()) == 3000
    # Without classes, as in many octrees.
    columns = repack_fields(records[["X", "Y", "Z", "Intensity"]])
    bare = write(tmp_path / "bare", columns, "binary")
    assert run(["info", str(bare)]) == 0
    assert "nodes of type binary" in capsys.readouterr().out
    assert run(["info", str(tmp_path / "nowhere/ept.json")]) == 3
    lines = tmp_path / "lines.geojson"
    options = ["--interval", "2", "--window", "10,10,50,50", "--duplicates", "min"]
    assert run(["contours", str(file), *options, "-o", str(lines)]) == 0
    x0, y0, x1, y1 = read_geometries(lines).geometries[0].bounds
    assert min(x0, y0) >= 10 and max(x1, y1) <= 50


def test_reference_systems(tmp_path: Path) -> None:
    records = survey(count=50)
    wkt = 'COMPD_CS["a + b",LOCAL_CS["a"],LOCAL_CS["b"]]'
    two = {"authority": "EPSG", "horizontal": "28992", "vertical": "5709"}
    for k, (srs, expected) in enumerate((
        ({}, None),
        (None, None),
        ({"wkt": wkt}, wkt),
        (two, "EPSG:28992"),
        (two | {"wkt": wkt}, wkt),
        ({"authority": "../x", "horizontal": "1"}, None),
    )):  # fmt: skip
        file = write(tmp_path / str(k), records, "binary", srs=srs)
        assert read_points(file).crs == expected
    file = write(tmp_path / "bad", records, "binary", srs={"wkt": "+init=/etc/passwd:1"})
    with pytest.raises(FileFormatError, match="names a file or a URL"):
        read_points(file)


def test_refused_requests(tmp_path: Path) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary")
    for options, message in (
        ({"columns": ["X", "Y"]}, "columns cannot be chosen"),
        ({"bounds": (200, 200, 300, 300)}, r"no points inside bounds=\(200"),
        ({"classes": [7]}, "no points of class 7"),
        ({"attributes": ["red"]}, "has no dimension 'red'; it has X, Y, Z, classification"),
        ({"layer": "a"}, "have no layers"),
    ):
        with pytest.raises(FileFormatError, match=message):
            read_points(file, **options)
    with pytest.raises(FileFormatError, match="describes points, not geometries"):
        read_geometries(file)
    file = write(tmp_path / "packed", survey(count=300))
    with pytest.raises(FileFormatError, match="has no 'Reflectance'"):
        read_points(file, attributes=["Reflectance"])
    no_points = write(tmp_path / "none", survey(count=0), "binary")
    assert len(read_points(no_points)) == 0


ENDS = [(1 << 53, True), ((1 << 53) + 1, False), ((1 << 63) - 1, False), ((1 << 64) - 1, False)]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("value, fits", [*ENDS, (-(1 << 53), True), (-(1 << 63), False)])
def test_coordinates_that_doubles_would_round(tmp_path: Path, value: int, fits: bool) -> None:
    kind = "i8" if value < 1 << 63 else "u8"
    record = np.zeros(2, dtype=[(axis, kind) for axis in "XYZ"])
    record["Y"][1] = value
    file = write(tmp_path / "tiles", record, "binary")
    (file.parent / "ept-hierarchy/0-0-0-0.json").write_text('{"0-0-0-0": 2}', encoding="utf-8")
    record.tofile(file.parent / "ept-data/0-0-0-0.bin")
    if fits:
        assert read_points(file).points[1, 1] == value * SCALE
        return
    with pytest.raises(FileFormatError, match=r"beyond 2\*\*53"):
        read_points(file)


@pytest.mark.filterwarnings("error")
def test_coordinates_that_are_signaling_nans(tmp_path: Path) -> None:
    record = np.zeros(1, dtype=[(axis, "f4") for axis in "XYZ"])
    file = write(tmp_path / "tiles", record, "binary")
    quiet, signaling = 0x7FC00000, 0x7F800001
    np.array([0, quiet, signaling], dtype="<u4").tofile(file.parent / "ept-data/0-0-0-0.bin")
    found = read_points(file)
    assert np.isnan(found.points).tolist() == [[False, True]] and np.isnan(found.z).all()


CUBE = [0, 0, 0, 128, 128, 128]
X = {"name": "X", "type": "signed", "size": 4}
Y, Z = X | {"name": "Y"}, X | {"name": "Z"}


@pytest.mark.parametrize(
    "changes, message",
    [
        ({"dataType": "zstandard"}, "nodes of type 'zstandard' are not read"),
        ({"dataType": ["laszip"]}, "are not read"),
        ({"version": "2.0.0"}, "version '2.0.0'"),
        ({"version": None}, "version None"),
        ({"hierarchyType": "gzip"}, "a hierarchy of type 'gzip'"),
        ({"points": -1}, "declares -1 points"),
        ({"points": True}, "declares True points"),
        ({"points": 10**18}, "nodes have 300: give bounds"),
        ({"points": 10**30}, "is corrupt: it declares 10000"),
        ({"points": 299}, "declares 299 points, and its nodes have 300"),
        ({"bounds": CUBE[:5]}, "bounds"),
        ({"bounds": [0, 0, 0, 0, 128, 128]}, "bounds"),
        ({"bounds": [0, 0, 0, 10**400, 1, 1]}, "bounds"),
        ({"bounds": [-1.7e308, 0, 0, 1.7e308, 1, 1]}, "bounds"),
        ({"bounds": [*CUBE[:5], "128"]}, "bounds"),
        ({"schema": None}, "no schema"),
        ({"schema": [1]}, "no schema"),
        ({"schema": [X, Y]}, "no Z"),
        ({"schema": [X, X, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"size": 3}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"size": True}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"type": "float", "size": 2}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"type": ["float"]}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"scale": 0}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X | {"offset": 10**400}, Y, Z]}, "a dimension of its schema"),
        ({"schema": [X, Y, Z, X | {"name": "Red"}, X | {"name": "red"}]}, "a dimension twice"),
        ({"schema": [X, Y, Z]}, "and 40 points take 480"),
    ],
)
def test_a_description_that_is_wrong(tmp_path: Path, changes: Any, message: str) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary", **changes)
    with pytest.raises(FileFormatError, match=message):
        read_points(file)


@pytest.mark.parametrize(
    "text",
    ["", "{", "[]", "{}", "\xff", "[" * 100_000, '{"points": 9', '{"dataType": 1, "dataType": 2}'],
)  # fmt: skip
def test_a_description_that_is_not_json(tmp_path: Path, text: str) -> None:
    file = tmp_path / "ept.json"
    file.write_bytes(text.encode("latin-1"))
    with pytest.raises(FileFormatError):
        read_points(file)


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda page: page | {"0-0-0-0": -1}, "does not have its own node 0-0-0-0"),
        (lambda page: {k: n for k, n in page.items() if k != "0-0-0-0"}, "its own node"),
        (lambda page: page | {"0-0-0-0": -2}, "has -2 points"),
        (lambda page: page | {"0-0-0-0": 40.0}, "has 40.0 points"),
        (lambda page: page | {"0-0-0-0": True}, "has True points"),
        (lambda page: page | {"0-0-0-0": None}, "has None points"),
        (lambda page: page | {"0-0-0-0": 41}, "and 41 points take"),
        (lambda page: page | {"0-0-0-0": 10**18}, "points take"),
        # Python writes no numbers with more digits, such as the size of so many records.
        (lambda page: page | {"0-0-0-0": 10**4299}, "is corrupt: node 0-0-0-0 has 10000"),
        (lambda page: page | {"1-2-0-0": 1}, "'1-2-0-0' is not in the octree"),
        (lambda page: page | {"1-0-0--1": 1}, "is not in the octree"),
        (lambda page: page | {"01-0-0-0": 1}, "is not in the octree"),
        (lambda page: page | {"1-0-0-0-0": 1}, "is not in the octree"),
        (lambda page: page | {"99-0-0-0": 1}, "is not in the octree"),
        (lambda page: page | {"\u0661-0-0-0": 1}, "is not in the octree"),
        (lambda page: page | {"../../secret": 1}, "is not in the octree"),
        (lambda page: page | {"3-0-0-0": 1} | {"2-0-0-0": -1}, "3-0-0-0 without its parent"),
        (lambda page: page | {"5-0-0-0": 1}, "5-0-0-0 without its parent"),
        (lambda page: page | {"1-1-1-1": 1}, "there is no file ept-data/1-1-1-1.bin"),
        (lambda page: page | {"1-1-1-1": -1}, "there is no file ept-hierarchy/1-1-1-1.json"),
        (list, "no numbers of points by node"),
    ],
)
def test_a_page_that_is_wrong(tmp_path: Path, change: Any, message: str) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary")
    page = file.parent / "ept-hierarchy/0-0-0-0.json"
    page.write_text(json.dumps(change(json.loads(page.read_text()))), encoding="utf-8")
    with pytest.raises(FileFormatError, match=message):
        read_points(file, bounds=(0, 0, 128, 128))


def test_pages_that_lead_back(tmp_path: Path) -> None:
    file = write(tmp_path / "tiles", survey(), "binary", 1)
    page = next(iter(sorted(file.parent.glob("ept-hierarchy/1-*.json"))))
    original = json.loads(page.read_text())
    for change, message in (
        ({page.stem: -1}, "does not have its own node"),
        ({"0-0-0-0": -1}, "'0-0-0-0' is not in the octree below it"),
        ({"1-1-1-0": 3}, "'1-1-1-0' is not in the octree below it"),
        ({"2-3-3-0": 3}, "'2-3-3-0' is not in the octree below it"),
    ):
        page.write_text(json.dumps(original | change), encoding="utf-8")
        with pytest.raises(FileFormatError, match=message):
            read_points(file)
    page.write_text('{"1-0-0-0": 1, "1-0-0-0": 2}', encoding="utf-8")
    with pytest.raises(FileFormatError, match="has a name twice"):
        read_points(file)


def test_nodes_that_are_wrong(tmp_path: Path) -> None:
    file = write(tmp_path / "tiles", survey(count=300))
    first, *_, second = sorted(file.parent.glob("ept-data/*.laz"))
    content = first.read_bytes()
    for wrong, message in (
        (content[:-300], "truncated|corrupt"),
        (content[:100], "truncated|corrupt"),
        (b"", "is not a LAS file"),
        (second.read_bytes(), r"has \d+ points, and the octree says 40"),
    ):
        first.write_bytes(wrong)
        with pytest.raises(FileFormatError, match=message):
            read_points(file)
    # Another point format, so that a dimension is missing in one node only.
    las_file = laspy.read(second)
    laspy.convert(las_file, point_format_id=7).write(second)
    first.write_bytes(content)
    assert len(read_points(file, attributes=["intensity"])) == 300
    with pytest.raises(FileFormatError, match="its nodes have different dimensions"):
        read_points(file, attributes="all")


@pytest.mark.skipif(os.name == "nt", reason="links need rights on Windows")
@pytest.mark.parametrize("what", ["ept-data/0-0-0-0.bin", "ept-hierarchy/0-0-0-0.json", "ept-data"])
def test_links_are_not_followed(tmp_path: Path, what: str) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary")
    link = file.parent / what
    link.rename(tmp_path / "elsewhere")
    link.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(FileFormatError, match="is a link to another file, which is not followed"):
        read_points(file)
    # The file that the user names may be a link.
    link.unlink()
    (tmp_path / "elsewhere").rename(link)
    other = tmp_path / "other"
    other.mkdir()
    (other / "ept.json").symlink_to(file)
    assert len(read_points(other / "ept.json")) == 300


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes")
def test_a_pipe_is_no_node(tmp_path: Path) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary")
    node = file.parent / "ept-data/0-0-0-0.bin"
    node.unlink()
    os.mkfifo(node)
    with pytest.raises(FileFormatError, match="there is no file ept-data/0-0-0-0"):
        read_points(file)


def test_coordinates_are_doubles(tmp_path: Path) -> None:
    wide = [("X", "i8"), ("Y", "f4"), ("Z", "u1")]
    records = np.array([(2**53, 0.1, 255), (-5, 2.5, 0)], dtype=wide)
    folder = tmp_path / "tiles"
    schema = [
        {"name": "X", "type": "signed", "size": 8},
        {"name": "Y", "type": "float", "size": 4, "scale": 0.1, "offset": 7},
        {"name": "Z", "type": "unsigned", "size": 1, "scale": 0.01},
    ]
    content = {"version": "1.1.0", "dataType": "binary", "points": 2, "bounds": CUBE}
    for name in ("ept-data", "ept-hierarchy"):
        (folder / name).mkdir(parents=True)
    (folder / "ept.json").write_text(json.dumps(content | {"schema": schema}))
    (folder / "ept-hierarchy/0-0-0-0.json").write_text('{"0-0-0-0": 2}')
    records.tofile(folder / "ept-data/0-0-0-0.bin")
    found = read_points(folder / "ept.json")
    assert found.points.tolist() == [[2.0**53, float(np.float32(0.1)) * 0.1 + 7], [-5, 7.25]]
    assert found.z is not None and found.z.tolist() == [255 * 0.01, 0]
    records["X"][0] += 1
    records.tofile(folder / "ept-data/0-0-0-0.bin")
    with pytest.raises(FileFormatError, match=r"beyond 2\*\*53"):
        read_points(folder / "ept.json")


@pytest.mark.filterwarnings("error")
def test_other_dimensions_are_scaled(tmp_path: Path) -> None:
    records = survey(count=300)
    file = write(tmp_path / "tiles", records, "binary")
    content = json.loads(file.read_text(encoding="utf-8"))
    by_name = {each["name"]: each for each in content["schema"]}
    by_name["Intensity"] |= {"scale": 0.5, "offset": -3}
    by_name["Classification"] |= {"offset": 5}
    file.write_text(json.dumps(content), encoding="utf-8")
    found = read_points(file, attributes=["intensity", "classification", "gps_time"])
    order = np.argsort(found.attributes["intensity"])
    expected = np.arange(300) / 2 - 3
    assert found.attributes["intensity"][order].tolist() == expected.tolist()
    assert np.array_equal(found.attributes["classification"][order], records["Classification"] + 5)
    assert np.array_equal(found.attributes["gps_time"][order], records["GpsTime"])
    some = read_points(file, classes=[6])
    assert len(some) == np.count_nonzero(records["Classification"] == 1) > 0


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name, what", [("X", {}), ("Z", {}), ("Intensity", {"offset": 1})])
def test_scales_that_overflow(tmp_path: Path, name: str, what: dict[str, Any]) -> None:
    file = write(tmp_path / "tiles", survey(count=300), "binary")
    content = json.loads(file.read_text(encoding="utf-8"))
    for each in content["schema"]:
        if each["name"] == name:
            each.update({"scale": 1e308} | what)
    file.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(FileFormatError, match=f"has {name}=.* in record .* make infinite"):
        read_points(file, attributes=["intensity"])


def test_nothing_is_allocated_for_a_claim(tmp_path: Path, monkeypatch: Any) -> None:
    """A node that claims more points than its file has is rejected before they are read."""
    file = write(tmp_path / "tiles", survey(count=300))
    page = file.parent / "ept-hierarchy/0-0-0-0.json"
    page.write_text(json.dumps(json.loads(page.read_text()) | {"0-0-0-0": 10**12}))
    read: list[Any] = []
    monkeypatch.setattr(las, "_read", lambda *given: read.append(given))
    monkeypatch.setattr(ept.np, "fromfile", lambda *given, **_: read.append(given))
    with pytest.raises(FileFormatError, match="the octree says 1000000000000"):
        read_points(file, bounds=(0, 0, 128, 128))
    assert not read
