"""Columns of registers and trackers are recognized as longitudes and latitudes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

import delone
from delone.io import read_points

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    "names",
    [
        "gbifID,decimalLatitude,decimalLongitude",
        "event-id,location-lat,location-long",
        "tag,gps_latitude,gps_longitude",
        "tag,gps_lat,gps_lon",
    ],
)
def test_longitudes_come_first_whatever_their_column(names: str, tmp_path: Path) -> None:
    file = tmp_path / "sightings.csv"
    file.write_text(names + "\n1,52.5,4.5\n2,51.5,5.5\n3,53,6\n", encoding="utf-8")
    found = read_points(file)
    assert found.points.tolist() == [[4.5, 52.5], [5.5, 51.5], [6, 53]]
    with pytest.warns(delone.GeographicWarning):
        delone.Delaunay(found)
