"""Tables by pyarrow: Parquet, Arrow, Feather."""

from decimal import Decimal, localcontext

import numpy as np
import pyarrow as pa
import pyarrow.feather
import pyarrow.parquet
import pytest

from delone import FileFormatError
from delone.io import read_points

X, Y, Z = np.array([1.5, 2, 3]), np.array([0.1, 5, 6]), np.array([7, 8, 9])


def save(file, table):
    if file.suffix == ".parquet":
        pyarrow.parquet.write_table(table, file)
    elif file.suffix == ".feather":
        pyarrow.feather.write_feather(table, str(file))
    else:
        kind = pa.ipc.new_stream if "stream" in file.stem else pa.ipc.new_file
        with kind(str(file), table.schema) as writer:
            writer.write_table(table)


@pytest.mark.parametrize("name", ["a.parquet", "a.feather", "a.arrow", "stream.arrow"])
def test_tables(tmp_path, name):
    file = tmp_path / name
    table = {"id": ["a", "b", "c"], "lat": Y, "lon": X, "elev": Z, "q": [1, 2, 3]}
    save(file, pa.table(table))
    survey = read_points(file, attributes=["q", "id"])
    assert np.array_equal(survey.points, np.column_stack((X, Y)))
    assert np.array_equal(survey.z, Z)
    assert survey.attributes["q"].tolist() == [1, 2, 3]
    assert survey.attributes["id"].tolist() == ["a", "b", "c"]
    assert np.array_equal(read_points(file, columns=["q", "elev"]).points[:, 1], Z)
    with pytest.raises(FileFormatError, match="no column 'w'"):
        read_points(file, columns=["lat", "w"])


@pytest.mark.parametrize("name", ["a.parquet", "a.feather"])
def test_missing_values_are_nan(tmp_path, name):
    save(tmp_path / name, pa.table({"x": [1.0, None, 3.0], "y": [1.0, 2.0, 3.0]}))
    assert np.isnan(read_points(tmp_path / name).points[1, 0])


def test_integers_beyond_doubles_are_refused(tmp_path):
    save(tmp_path / "a.parquet", pa.table({"x": [2**53 + 1, 0], "y": [1, 2]}))
    with pytest.raises(FileFormatError, match=r"2\*\*53"):
        read_points(tmp_path / "a.parquet")


@pytest.mark.parametrize("name", ["a.parquet", "a.feather"])
@pytest.mark.parametrize("bits", [32, 64, 128, 256])
def test_decimals_are_the_doubles_that_their_digits_denote(tmp_path, name, bits):
    """A cast by pyarrow has every seventh of them beside the nearest double."""
    rng = np.random.default_rng(bits)
    digits = {32: 9, 64: 15, 128: 15, 256: 15}[bits]
    whole = rng.integers(-(10**digits), 10**digits, (500, 2)).tolist()
    texts = [[f"{Decimal(number).scaleb(-3)}" for number in row] for row in whole]
    kind = getattr(pa, f"decimal{bits}")(digits + 3 * (bits > 64), 3)
    x, y = (
        pa.array([Decimal(text) for text in column], kind) for column in zip(*texts, strict=True)
    )
    # In pieces, one of them empty, so that buffers begin in the middle.
    pieces = pa.chunked_array([y[:100], y[:0], y[100:]])
    table = pa.table({"x": x, "y": pieces})
    save(tmp_path / name, table)
    right = [[float(text) for text in row] for row in texts]
    assert read_points(tmp_path / name).points.tolist() == right


@pytest.mark.parametrize("scale", [-6, -1, 0, 1, 15, 21, 22, 23, 24, 25, 30, 38])
def test_decimals_of_every_power_of_ten(tmp_path, scale):
    """The powers up to 10^22 are doubles; of more than 15 digits those that come back are read."""
    rng = np.random.default_rng(scale + 6)
    digits = rng.integers(-(10**15), 10**15, 1500).tolist()
    digits += rng.integers(2**53, 10**17, 3000).tolist()
    values = [Decimal(number).scaleb(-scale) for number in digits]
    unit = Decimal(1).scaleb(-scale)
    with localcontext(prec=100):
        values = [v for v in values if Decimal(float(v)).quantize(unit) == v]
    assert len(values) > 1500
    column = pa.array(values, pa.decimal128(38, scale))
    save(tmp_path / "a.feather", pa.table({"x": column, "y": np.zeros(len(values))}))
    found = read_points(tmp_path / "a.feather").points[:, 0]
    assert found.tolist() == [float(str(v)) for v in values]


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        ("0.90071992547409921", pa.decimal128(17, 17)),
        ("9007199254740993", pa.decimal128(20, 0)),
        ("0.12345678901234567890123", pa.decimal128(38, 23)),
        ("1" * 60 + ".5", pa.decimal256(61, 1)),
    ],
)
def test_decimals_of_which_digits_would_be_lost_are_refused(tmp_path, value, kind):
    column = pa.array([Decimal(0), Decimal(value)], kind)
    save(tmp_path / "a.parquet", pa.table({"x": column, "y": [1, 2]}))
    with pytest.raises(
        FileFormatError, match=f"column 'x' has the value {value}, with more digits"
    ):
        read_points(tmp_path / "a.parquet")


def test_long_decimals_that_doubles_tell_apart_are_read(tmp_path):
    kinds = {
        "0.0625000000000001": pa.decimal128(16, 16),
        "-23456789012.34568": pa.decimal128(16, 5),
        "0.25": pa.decimal128(38, 25),
        "-9007199254740992": pa.decimal256(50, 0),
        "1234567890123456000000": pa.decimal128(20, -6),
    }
    for text, kind in kinds.items():
        column = pa.array([None, Decimal(text)], kind)
        save(tmp_path / "a.feather", pa.table({"x": column, "y": [1, 2]}))
        found = read_points(tmp_path / "a.feather").points
        assert np.isnan(found[0, 0]) and found[1, 0] == float(text)


def test_unnamed_columns(tmp_path):
    save(tmp_path / "a.parquet", pa.table({"a": X, "b": Y}))
    with pytest.raises(FileFormatError, match="which columns"):
        read_points(tmp_path / "a.parquet")


@pytest.mark.parametrize("name", ["a.parquet", "a.feather", "a.arrow"])
def test_torn_and_garbage(tmp_path, name):
    file = tmp_path / name
    save(file, pa.table({"x": np.random.default_rng(0).random(5000), "y": np.zeros(5000)}))
    whole = file.read_bytes()
    for content in (whole[:100], whole[: len(whole) // 2], np.random.default_rng(1).bytes(999)):
        file.write_bytes(content)
        with pytest.raises(FileFormatError):
            read_points(file)
