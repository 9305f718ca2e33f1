"""Numbers in ranges, marks and files that cannot be read: what is accepted, and what is said."""

from __future__ import annotations

import math

import pytest

from delone._base import files, numbers, values
from delone.errors import DtypeError, FileFormatError, InputError

INF = math.inf


def test_ends_of_ranges() -> None:
    assert numbers.as_share(1, name="a") == 1 and numbers.as_share(100, name="a", most=100) == 100
    assert numbers.as_positive(INF, name="a") == numbers.as_nonnegative(INF, name="a") == INF
    assert numbers.as_nonnegative(0, name="a") == 0 == numbers.as_between(0, 0, 1, name="a")
    for call in (
        lambda: numbers.as_share(0, name="a"),
        lambda: numbers.as_share(1.5, name="a"),
        lambda: numbers.as_positive(0, name="a"),
        lambda: numbers.as_positive(INF, name="a", finite=True),
        lambda: numbers.as_nonnegative(-1e-300, name="a"),
        lambda: numbers.as_between(math.nan, 0, 1, name="a"),
        lambda: numbers.as_finite(-INF, name="a"),
    ):
        with pytest.raises(InputError, match=r"^a must be .*, got "):
            call()


def test_marks() -> None:
    assert values.as_marks([2, 0], 3, name="a", of="points").tolist() == [True, False, True]
    for wrong, named in (([-1], -1), ([0, 3], 3)):
        with pytest.raises(InputError, match=f"rows of points, from 0 to 2, got {named}"):
            values.as_marks(wrong, 3, name="a", of="points")
    with pytest.raises(DtypeError, match="a mask or rows of points"):
        values.as_marks([0.5], 3, name="a", of="points")


def test_errors_of_libraries() -> None:
    for own in (MemoryError, FileNotFoundError, PermissionError, InputError):
        with pytest.raises(own), files.reading_as("a.nc", "NetCDF"):
            raise own
    said = r"a\.nc is truncated or not a NetCDF file: why$"
    with pytest.raises(FileFormatError, match=said), files.reading_as("a.nc", "NetCDF"):
        raise RuntimeError("why\nand more")
