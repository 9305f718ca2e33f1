"""LAS and LAZ: exact coordinates, classes, reference systems, torn files, false counts."""

import contextlib
import struct

import laspy
import numpy as np
import pyproj
import pytest

from delone import FileFormatError
from delone.io import read_points
from delone.io.las import describe

N = 1000
COUNT_12, COUNT_14 = 107, 247  # where the header has the number of records


@pytest.fixture(params=[(".las", 1), (".laz", 1), (".las", 6), (".laz", 6)], ids=str)
def cloud(request, tmp_path):
    suffix, point_format = request.param
    header = laspy.LasHeader(
        point_format=point_format, version="1.4" if point_format > 5 else "1.2"
    )
    header.scales, header.offsets = [0.001, 0.01, 0.1], [84600.0, 447000.5, -3.0]
    las = laspy.LasData(header)
    rng = np.random.default_rng(1)
    for name in "XYZ":
        las[name] = rng.integers(-(2**30), 2**30, N)
    las.classification = rng.integers(1, 7, N)
    file = tmp_path / f"cloud{suffix}"
    las.write(file)
    return file, las


def test_coordinates_are_those_of_laspy(cloud, monkeypatch):
    monkeypatch.setattr("delone.io.las._BLOCK", 300)
    file, las = cloud
    survey = read_points(file, attributes=["classification"])
    assert np.array_equal(survey.points, np.column_stack((las.x, las.y)))
    assert np.array_equal(survey.z, las.z)
    assert np.array_equal(survey.attributes["classification"], las.classification)
    assert survey.crs is None


def test_what_the_header_says(cloud):
    file, las = cloud
    found = describe(file)
    names = found.pop("dimensions")
    assert found == {
        "las_version": "1.2" if las.header.point_format.id == 1 else "1.4",
        "point_format": las.header.point_format.id,
        "scales": [0.001, 0.01, 0.1],
    }
    assert names == list(las.point_format.dimension_names)
    assert names[:4] == ["X", "Y", "Z", "intensity"]
    assert ("overlap" in names) == (found["point_format"] == 6)


def test_classes(cloud):
    file, las = cloud
    keep = np.isin(np.asarray(las.classification), [2, 6])
    survey = read_points(file, classes=[2, 6], attributes=["intensity"])
    assert np.array_equal(survey.points[:, 0], np.asarray(las.x)[keep])
    assert len(survey.attributes["intensity"]) == keep.sum() == len(survey.z)
    with pytest.raises(FileFormatError, match="no points of class 9"):
        read_points(file, classes=[9])


def test_reference_system_is_kept(tmp_path):
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.add_crs(pyproj.CRS.from_epsg(28992))
    las = laspy.LasData(header)
    las.x = las.y = las.z = np.arange(5.0)
    las.write(tmp_path / "a.las")
    crs = read_points(tmp_path / "a.las").crs
    assert pyproj.CRS.from_user_input(crs).name == "Amersfoort / RD New"


@pytest.mark.parametrize("claim", [N + 60000, 2**31, 2**32 - 1])
def test_header_that_claims_more_records(cloud, claim):
    file, las = cloud
    raw = bytearray(file.read_bytes())
    if las.header.version.minor == 4:
        raw[COUNT_14 : COUNT_14 + 8] = struct.pack("<Q", claim * 1000)
    raw[COUNT_12 : COUNT_12 + 4] = struct.pack("<I", claim)
    file.write_bytes(raw)
    with pytest.raises(FileFormatError, match="truncated"):
        read_points(file)


@pytest.mark.parametrize("place", [96, 100, 243])
def test_header_that_claims_more_records_beside_the_points(cloud, place):
    file, las = cloud
    if place == 243 and las.header.version.minor < 4:
        return
    raw = bytearray(file.read_bytes())
    raw[place : place + 4] = struct.pack("<I", 2**32 - 7)
    file.write_bytes(raw)
    with pytest.raises(FileFormatError, match="no room for the records"):
        read_points(file)


def test_torn(cloud):
    file, _ = cloud
    whole = file.read_bytes()
    for share in (0.001, 0.01, 0.1, 0.5, 0.9, 0.999):
        file.write_bytes(whole[: int(len(whole) * share) or 1])
        with pytest.raises(FileFormatError):
            read_points(file)


def test_garbage(tmp_path, cloud):
    file, _ = cloud
    whole = file.read_bytes()
    start = 400
    for seed in range(5):
        noise = np.random.default_rng(seed).bytes(len(whole) - start)
        file.write_bytes(noise)
        with pytest.raises(FileFormatError):
            read_points(file)


def test_one_wrong_byte_in_a_compressed_file(cloud):
    """Whatever it hits: points or an error, but no abort, and no memory for false sizes."""
    file, _ = cloud
    whole = np.frombuffer(file.read_bytes(), dtype=np.uint8)
    rng = np.random.default_rng(0)
    for place in [*range(96, 500, 3), *rng.integers(500, len(whole), 100).tolist()]:
        torn = whole.copy()
        torn[place] ^= 0x80
        file.write_bytes(torn.tobytes())
        with contextlib.suppress(FileFormatError):
            assert len(read_points(file)) <= N + 2**16


def test_unknown_attribute_and_columns(cloud):
    file, _ = cloud
    with pytest.raises(FileFormatError, match="has no 'colour'"):
        read_points(file, attributes=["colour"])
    with pytest.raises(FileFormatError, match="cannot be chosen"):
        read_points(file, columns=["x", "y"])


@pytest.mark.parametrize("count", [0, 1, N - 1])
def test_header_that_claims_fewer_records(cloud, count):
    file, _ = cloud
    if file.suffix == ".laz":
        # The chunks do not say how many points the last one has; none at all is told apart.
        count = 0
    whole = bytearray(file.read_bytes())
    struct.pack_into("<I", whole, COUNT_12, count)
    struct.pack_into("<Q", whole, COUNT_14, count) if whole[25] == 4 else None
    file.write_bytes(whole)
    with pytest.raises(FileFormatError, match=rf"declares {count} points and contains 1"):
        read_points(file)


@pytest.mark.parametrize("minor", [3, 4])
def test_a_header_stamped_with_a_later_version(tmp_path, cloud, minor):
    file, _ = cloud
    whole = bytearray(file.read_bytes())
    if whole[25] == 4:
        assert len(read_points(file)) == N
        return
    whole[25] = minor
    file.write_bytes(whole)
    with pytest.raises(FileFormatError, match=rf"says LAS 1\.{minor} and has 227 bytes"):
        read_points(file)
    # With more room for a header, the counts do not agree.
    struct.pack_into("<H", whole, 94, 375)
    file.write_bytes(whole)
    with pytest.raises(FileFormatError):
        read_points(file)


def test_a_header_stamped_with_an_earlier_version(cloud):
    file, _ = cloud
    whole = bytearray(file.read_bytes())
    whole[25] = 2
    file.write_bytes(whole)
    with contextlib.suppress(FileFormatError):
        assert len(read_points(file)) == N


def test_two_counts_that_differ(cloud):
    file, _ = cloud
    whole = bytearray(file.read_bytes())
    # A file of version 1.2 has one count, which then differs from its records.
    where = "in one field" if whole[25] == 4 else "and contains"
    struct.pack_into("<I", whole, COUNT_12, N - 1 if whole[25] == 4 else 0)
    file.write_bytes(whole)
    announced = N - 1 if whole[25] == 4 else 0
    with pytest.raises(FileFormatError, match=f"declares {announced} points {where}"):
        read_points(file)


@pytest.mark.parametrize("count", [0, 3])
def test_records_behind_the_points_are_no_points(tmp_path, count):
    las = laspy.LasData(laspy.LasHeader(point_format=6, version="1.4"))
    las.x = las.y = las.z = np.arange(float(count))
    las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("me", 1, "long", b"x" * 1000)])
    las.write(tmp_path / "a.las")
    assert len(read_points(tmp_path / "a.las")) == count


def with_more_extra_bytes(path, more):
    """Write a file whose record of extra bytes is longer by some bytes than what it needs."""
    cloud = laspy.create(point_format=3, file_version="1.2")
    cloud.x, cloud.y, cloud.z = [0, 1, 0], [0, 0, 1], [5, 6, 7]
    cloud.add_extra_dim(laspy.ExtraBytesParams("h", "f8"))
    cloud["h"] = [1, 2, 3]
    cloud.write(path)
    content = bytearray(path.read_bytes())
    head, start = struct.unpack_from("<H", content, 94)[0], struct.unpack_from("<I", content, 96)[0]
    length = struct.unpack_from("<H", content, head + 20)[0]
    record = content[head + 54 : head + 54 + length]
    extra = more(record)
    struct.pack_into("<H", content, head + 20, length + len(extra))
    struct.pack_into("<I", content, 96, start + len(extra))
    content[head + 54 + length : head + 54 + length] = extra
    path.write_bytes(content)
    return path


def test_a_record_of_extra_bytes_that_is_too_long(tmp_path):
    path = with_more_extra_bytes(tmp_path / "a.las", lambda record: bytes(10))
    assert read_points(path).z.tolist() == [5, 6, 7]
    with pytest.raises(FileFormatError, match=r"has 202 bytes, not a multiple of 192.*ExtraBytes"):
        read_points(path, attributes=["h"])
    raw = read_points(path, attributes="all").attributes["ExtraBytes"]
    assert np.ascontiguousarray(raw).view("<f8").ravel().tolist() == [1, 2, 3]


def test_a_record_that_describes_more_extra_bytes_than_points_have(tmp_path):
    path = with_more_extra_bytes(
        tmp_path / "a.las", lambda record: record[:4] + b"second".ljust(32, b"\0") + record[36:]
    )
    with pytest.raises(FileFormatError, match=r"points of 50 bytes, but points have 42: remove"):
        read_points(path)
