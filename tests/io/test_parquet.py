"""Tables by pyarrow: Parquet, Arrow, Feather."""

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
