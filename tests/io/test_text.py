"""Text: delimiters, headers, columns, compression, and files that are not what they seem."""

import bz2
import gzip
import lzma
import os
import sys

import numpy as np
import pytest

from delone import FileFormatError, InputError, NonFiniteError
from delone._base.arrays import require_finite
from delone.io import line_numbers, read_points

XY = [[4.25, 52.0], [4.5, 52.5], [-1e-3, 1e5]]
Z = [-3.0, 7.0, 0.1]
ROWS = [(*xy, z) for xy, z in zip(XY, Z, strict=True)]


def written(tmp_path, name, text, encoding="utf-8"):
    file = tmp_path / name
    file.write_bytes(text.encode(encoding))
    return file


def lines(delimiter, header=None, rows=ROWS):
    body = [delimiter.join(map(repr, row)) for row in rows]
    return "\n".join(([header] if header else []) + body) + "\n"


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", "  ", "|", ", "])
@pytest.mark.parametrize("named", [False, True])
def test_each_delimiter_with_and_without_header(tmp_path, delimiter, named):
    header = delimiter.join("xyz") if named else None
    survey = read_points(written(tmp_path, "a.csv", lines(delimiter, header)))
    assert survey.points.tolist() == XY
    assert survey.z.tolist() == Z


def test_every_double_comes_back(tmp_path):
    rng = np.random.default_rng(3)
    points = rng.random((2000, 2)) * 10.0 ** rng.integers(-300, 300, (2000, 2))
    survey = read_points(written(tmp_path, "a.xyz", lines(" ", rows=points.tolist())))
    assert np.array_equal(survey.points, points)
    assert survey.z is None


@pytest.mark.parametrize(
    ("header", "xy", "z"),
    [
        ("id,lat,lon,depth", [2, 1], 3),
        ("Easting [m],Northing [m],H,note", [0, 1], 2),
        ("height,X_COORD,Y_COORD,z", [1, 2], 3),
        ('"Longitude","Latitude","bathymetry_m","q"', [0, 1], 2),
        ("x,y,temperature,q", [0, 1], None),
        ("N,E,Elev (ft),q", [1, 0], 2),
    ],
)
def test_columns_are_recognised_by_their_words(tmp_path, header, xy, z):
    table = np.arange(12.0).reshape(3, 4)
    survey = read_points(written(tmp_path, "a.csv", lines(",", header, table.tolist())))
    assert survey.points.tolist() == table[:, xy].tolist()
    assert (survey.z is None) if z is None else (survey.z.tolist() == table[:, z].tolist())


def test_unknown_names_are_not_guessed(tmp_path):
    file = written(tmp_path, "a.csv", lines(",", "foo,bar,baz"))
    with pytest.raises(FileFormatError, match=r"--columns.*foo, bar, baz"):
        read_points(file)
    assert read_points(file, columns=["foo", "BAR"]).points.tolist() == XY
    assert read_points(file, columns=["0", 1, "baz"]).z.tolist() == Z
    with pytest.raises(FileFormatError, match=r"no column 'qux'"):
        read_points(file, columns=["foo", "qux"])


def test_attributes(tmp_path):
    survey = read_points(written(tmp_path, "a.csv", lines(",", "x,y,q")), attributes=["q"])
    assert survey.attributes["q"].tolist() == Z


def test_header_behind_a_comment_mark_and_comments_between(tmp_path):
    text = "# a survey\n# y x z\n\n1 2 3\n# pause\n4 5 6\n\n"
    survey = read_points(written(tmp_path, "a.txt", text))
    assert survey.points.tolist() == [[2.0, 1.0], [5.0, 4.0]]
    assert survey.z.tolist() == [3.0, 6.0]


def test_decimal_comma(tmp_path):
    survey = read_points(written(tmp_path, "a.csv", "x;y;z\n1,5;2,25;3\n4;5,125;6\n"))
    assert survey.points.tolist() == [[1.5, 2.25], [4.0, 5.125]]


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_encodings_and_line_ends(tmp_path, encoding):
    text = "x,y,Höhe\r\n1,2,3\r\n4,5,6\r\n"
    survey = read_points(written(tmp_path, "a.csv", text, encoding))
    assert survey.points.tolist() == [[1.0, 2.0], [4.0, 5.0]]


@pytest.mark.parametrize(
    ("suffix", "compress"), [(".gz", gzip.compress), (".xz", lzma.compress), (".bz2", bz2.compress)]
)
def test_compressed(tmp_path, suffix, compress):
    whole = compress(lines(",", "x,y,z", ROWS * 5000).encode())
    file = tmp_path / f"a.csv{suffix}"
    file.write_bytes(whole)
    assert len(read_points(file)) == 15000
    file.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(FileFormatError, match="truncated"):
        read_points(file)
    file.write_bytes(b"x,y\n1,2\n")
    with pytest.raises(FileFormatError):
        read_points(file)


def test_many_blocks(tmp_path, monkeypatch):
    monkeypatch.setattr("delone.io.text._BLOCK", 7)
    table = np.arange(300.0).reshape(100, 3)
    text = lines(",", "x,y,z", table.tolist()).replace("\n", "\n#\n")
    assert read_points(written(tmp_path, "a.csv", text)).points.tolist() == table[:, :2].tolist()
    with pytest.raises(FileFormatError, match=r"line 203 \(row 100\), column y is 'b'"):
        read_points(written(tmp_path, "b.csv", text + "1,b,3\n"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x,y\n1,2\n3,four\n", r"line 3 \(row 1\), column y is 'four', not a number"),
        ("x,y\n1,2\n3,it's\n", r"line 3 \(row 1\), column y is \"it's\", not a number"),
        ("x,y\n1,2\n3,a\\b\n", r"line 3 \(row 1\), column y is 'a\\\\b', not a number"),
        ("x,y\n1,2\n3,\n", r"line 3 \(row 1\), column y is empty"),
        ("x,y,z\n1,2,3\n3,4,5\n6,7", r"line 4 \(row 2\) has only 2 columns: is the file truncated"),
        ("3\n1 2 3\n4 5 6\n", r"declares 3 points and contains 2"),
        ("hello\nworld\n", "not columns of numbers"),
        ("# nothing\n\n", "no rows"),
        ("x\n1\n2\n", "not columns of numbers"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, text, message):
    with pytest.raises(FileFormatError, match=message):
        read_points(written(tmp_path, "a.csv", text))


def test_garbage(tmp_path):
    file = tmp_path / "a.csv"
    for seed in range(20):
        file.write_bytes(np.random.default_rng(seed).bytes(3000))
        with pytest.raises(FileFormatError):
            read_points(file)


def test_line_with_the_number_of_points(tmp_path):
    survey = read_points(written(tmp_path, "a.pts", "2\n1 2 3 9\n4 5 6 9\n"))
    assert survey.z.tolist() == [3.0, 6.0]
    with pytest.raises(FileFormatError, match="truncated"):
        read_points(written(tmp_path, "a.pts", "1000000000000\n1 2 3 9\n4 5 6 9\n"))


def test_nan_rows_pass_and_can_be_named(tmp_path):
    survey = read_points(written(tmp_path, "a.csv", "x,y\n1,2\nnan,4\n5,inf\n"))
    with pytest.raises(NonFiniteError) as caught:
        require_finite(survey.points)
    assert caught.value.rows.tolist() == [1, 2]


@pytest.mark.parametrize(
    "text", ["x,y\n0,5,1,5\n2,5,3,0\n7,1,2,2\n", "x y\n0 1\n2 3 4\n5 6\n", "1,2\n3,4\n5,6,7\n"]
)
def test_rows_longer_than_the_first_are_not_cut(tmp_path, text):
    with pytest.raises(FileFormatError, match=r"line \d \(row \d\) has \d columns.* 2"):
        read_points(written(tmp_path, "a.csv", text))


def test_a_delimiter_at_the_end_of_rows_is_no_column(tmp_path):
    survey = read_points(written(tmp_path, "a.csv", "x,y\n0,1,\n2,3,\n4,5,\n"))
    assert survey.points.tolist() == [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]


@pytest.mark.parametrize("header", ["x,y,x", "X,y,x [m]", "lon,lat,lon", "x,y,z,z"])
def test_a_column_that_is_named_twice(tmp_path, header):
    row = ",".join("1234"[: header.count(",") + 1])
    file = written(tmp_path, "a.csv", f"{header}\n{row}\n")
    with pytest.raises(FileFormatError, match="2 are named"):
        read_points(file)
    assert read_points(file, columns=[0, 1]).points.tolist() == [[1, 2]]


def test_a_choice_that_fits_two_columns(tmp_path):
    file = written(tmp_path, "a.csv", "x,y,x\n1,2,3\n")
    with pytest.raises(FileFormatError, match="2 columns 'x'"):
        read_points(file, columns=["x", "y"])


@pytest.mark.skipif(sys.platform != "linux", reason="pipes of 64 KiB that open both ways")
def test_a_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / "a.csv")
    pipe = os.open(tmp_path / "a.csv", os.O_RDWR)
    try:
        os.write(pipe, b"1,2,3,4\n" * (1 << 13))  # full: whoever reads it does not wait
        with pytest.raises(FileFormatError, match="pipe or device"):
            read_points(tmp_path / "a.csv")
    finally:
        os.close(pipe)


PACKED = [(".gz", gzip.compress), (".xz", lzma.compress), (".bz2", bz2.compress)]


@pytest.mark.parametrize(("suffix", "compress"), PACKED)
def test_what_expands_beyond_measure(tmp_path, monkeypatch, suffix, compress):
    monkeypatch.setattr("delone._base.bounded._ALWAYS_TEXT", 1 << 20)
    rows = b"0 0\n" * (1 << 18)
    small = tmp_path / f"a.xyz{suffix}"
    small.write_bytes(compress(rows + b"1 0\n"))
    with pytest.raises(FileFormatError, match=r"a\.xyz\.\w+ is more than 200.*decompress it first"):
        read_points(small)
    # Decompressed, it is read; so is what expands as much and is small.
    (tmp_path / "a.xyz").write_bytes(rows[: 1 << 18])
    small.write_bytes(compress(rows[: 1 << 18]))
    assert len(read_points(small)) == len(read_points(tmp_path / "a.xyz")) == 1 << 16


@pytest.mark.parametrize(("suffix", "compress"), PACKED)
def test_what_expands_beyond_measure_as_geojson(tmp_path, monkeypatch, suffix, compress):
    monkeypatch.setattr("delone._base.bounded._ALWAYS_TEXT", 1 << 20)
    text = b'{"type": "Point", "coordinates": [1, 2' + b" " * (1 << 20) + b"]}"
    small = tmp_path / f"a.geojson{suffix}"
    small.write_bytes(compress(text))
    with pytest.raises(FileFormatError, match="decompress it first"):
        read_points(small)


@pytest.mark.parametrize("suffix", ["", ".gz"])
@pytest.mark.parametrize("before", ["", "x,y\n1,2\n"])
@pytest.mark.parametrize("end", ["", "\n", "\r"])
def test_one_line_that_does_not_end(tmp_path, monkeypatch, suffix, before, end):
    monkeypatch.setattr("delone.io.text._LONGEST_LINE", 1 << 16)
    text = before + "1," * (1 << 20) + end
    file = tmp_path / f"a.csv{suffix}"
    file.write_bytes(gzip.compress(text.encode()) if suffix else text.encode())
    with pytest.raises(FileFormatError, match="has a line of more than 65,536 bytes"):
        read_points(file)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_many_short_lines_are_no_long_one(tmp_path, monkeypatch, end):
    monkeypatch.setattr("delone.io.text._LONGEST_LINE", 1 << 16)
    file = tmp_path / "a.csv"
    file.write_bytes(f"1,2{end}".encode() * (1 << 16))
    assert len(read_points(file)) == 1 << 16


SCATTERED = "# a survey\n\nx,y,z\n0,0,1\n\n% pause\n4,nan,2\n  \n4,4,3\n// end\n0,4,4\n"


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_lines_of_rows(tmp_path, end, encoding):
    file = tmp_path / "a.csv"
    file.write_bytes(SCATTERED.replace("\n", end).encode(encoding))
    assert len(read_points(file)) == 4
    assert line_numbers(file, [0, 3, 1, 2, 2]) == [4, 11, 7, 9, 9]
    assert line_numbers(file, []) == []
    with pytest.raises(FileFormatError, match="has only 4 rows, and no row 4"):
        line_numbers(file, [4])


@pytest.mark.parametrize("head", ["", "3\n", "# x y z\n", "x y z\n"])
def test_lines_of_rows_below_each_kind_of_head(tmp_path, head):
    file = tmp_path / "a.xyz.gz"
    file.write_bytes(gzip.compress((head + "1 2 3\n4 5 6\n7 8 9\n").encode()))
    assert line_numbers(file, range(3)) == [n + head.count("\n") for n in (1, 2, 3)]
    with pytest.raises(InputError, match="rows"):
        line_numbers(file, [-1])


def test_only_text_has_lines(tmp_path):
    np.save(tmp_path / "a.npy", np.zeros((3, 2)))
    with pytest.raises(FileFormatError, match="not a text file"):
        line_numbers(tmp_path / "a.npy", [0])


PNEZD = (
    "1{0}5000.123{0}2000.5{0}100.2{0}EP\n2{0}5010.123{0}2010.5{0}101.2{0}TREE\n"
    "7{0}5020.1{0}2020.5{0}9.9{0}EP\n"
)


@pytest.mark.parametrize("mark", [",", " ", "\t", ";"])
def test_point_numbers_without_names_are_asked_for(tmp_path, mark):
    file = tmp_path / "a.txt"
    file.write_text(PNEZD.format(mark))
    with pytest.raises(FileFormatError, match=r"numbers of points \(1, 2, \.\.\.\).*2,1,3"):
        read_points(file)
    survey = read_points(file, columns=[2, 1, 3])
    assert survey.points[0].tolist() == [2000.5, 5000.123] and survey.z[2] == 9.9
    # Names, three columns, whole coordinates or numbers in any other order are no such case.
    for text in (
        "n,y,x,z,code\n" + PNEZD.format(","),
        "1,2.5,3.5\n2,3.5,4.5\n",
        "1,2,3,4\n2,3,4,5\n",
        "2,2.5,3.5,4.5\n1,3.5,4.5,5.5\n",
        "1.0,2.5,3.5,4.5\n2.0,3.5,4.5,5.5\n",
    ):
        file.write_text(text)
        assert len(read_points(file)) >= 2


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ('x,y\n"1,234.5",2\n3,4\n', "'1,234.5', not a number: remove the separators"),
        ("x;y\n1,234.5;2\n1,235;4\n", "'1,234.5', not a number: remove the separators"),
        ("x;y\n1 234,5;2\n1 235;4\n", "'1 234,5', not a number: remove the separators"),
        ('x,y\n"1,5","2,25"\n"3,5","4,25"\n', "'1,5', not a number: write decimals with a point"),
        ("x y\n0.5D+03 2\n1 2\n", "'0.5D[+]03', not a number: .* with E, 0.5E[+]03"),
        ("1 2\n3 -.25d2\n", "'-.25d2', not a number: .* with E, -.25E2"),
    ],
)
def test_numbers_of_other_programs_are_shown(tmp_path, text, what):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(FileFormatError, match=r"line \d+ .*" + what):
        read_points(tmp_path / "a.csv")
