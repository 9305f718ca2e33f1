"""Points of COPC and other LAS files inside bounds: those that a mask of all would keep."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import FileFormatError, InputError
from delone.io import copc, las, read_points
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

laspy = pytest.importorskip("laspy")

# The record ``copc`` 1 begins behind the header and the head of a record.
INFO = 375 + 54


@pytest.fixture
def survey(tmp_path: Path, write_copc: Callable[..., Any]) -> Path:
    dice = np.random.default_rng(4)
    points = np.round(dice.random((4000, 2)) * 100, 3)
    points[:10, 0] = 25.5
    write_copc(tmp_path / "survey.copc.laz", points, np.round(dice.random(4000) * 9, 3))
    return tmp_path / "survey.copc.laz"


BOXES = [
    (0, 0, 100, 100),
    (25.5, 10, 40, 30),
    (49, 49, 51, 51),
    (60, 60, 99, 99),
    (25.5, 0, 25.5, 100),
]


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize("kind", ["copc", "laz", "las"])
def test_points_are_those_of_a_mask(survey: Path, box: Any, kind: str) -> None:
    whole = read_points(survey, attributes=["intensity"])
    path = survey
    if kind != "copc":
        path = survey.with_name(f"plain.{kind}")
        plain = laspy.LasData(laspy.LasHeader(version="1.4", point_format=6))
        plain.header.scales = np.full(3, 1e-3)
        (plain.x, plain.y), plain.z = whole.points.T, whole.z
        plain.write(path)
        whole = read_points(path, attributes=["intensity"])
    found = read_points(path, attributes=["intensity"], bounds=box)
    x, y = whole.points.T
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    assert inside.sum() > 0
    assert np.array_equal(found.points, whole.points[inside])
    assert whole.z is not None and np.array_equal(found.z, whole.z[inside])
    assert len(found.attributes["intensity"]) == inside.sum()


def test_only_nodes_that_meet_the_box_are_decoded(
    survey: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    decoded: list[int] = []
    original = las._from_chunks

    def counting(path: Path, header: Any, start: int, stop: int) -> Any:
        decoded.append(stop - start)
        return original(path, header, start, stop)

    monkeypatch.setattr(las, "_from_chunks", counting)
    read_points(survey, bounds=(60, 60, 90, 90))
    # The root, and one quadrant of four.
    assert len(decoded) == 2 and sum(decoded) < 2000
    decoded.clear()
    read_points(survey, bounds=(45, 60, 55, 90))
    assert len(decoded) == 3


def test_surfaces_of_a_part(survey: Path) -> None:
    tin = TIN.from_file(survey, bounds=(10, 10, 40, 40), duplicates="min")
    assert tin.min_bound.min() >= 10 and tin.max_bound.max() <= 40 and tin.npoints > 200
    with pytest.raises(FileFormatError, match=r"no points inside bounds=\(200.0, .* of class 7"):
        read_points(survey, bounds=(200, 0, 300, 1), classes=[7])
    with pytest.raises(FileFormatError, match="no points inside bounds"):
        read_points(survey, bounds=(200, 0, 300, 1))
    with pytest.raises(InputError, match="in this order"):
        read_points(survey, bounds=(3, 0, 1, 1))
    table = survey.with_name("table.csv")
    table.write_text("x,y,z\n0,0,0\n1,0,0\n0,1,0\n", encoding="utf-8")
    with pytest.raises(FileFormatError, match="bounds are for LAS, LAZ and EPT"):
        read_points(table, bounds=(0, 0, 1, 1))


def entries(path: Path) -> tuple[int, int]:
    start, length = struct.unpack_from("<2Q", path.read_bytes(), INFO + 40)
    return start, length


def patched(path: Path, at: int, data: bytes) -> None:
    content = bytearray(path.read_bytes())
    content[at : at + len(data)] = data
    path.write_bytes(content)


def test_an_octree_that_is_wrong_is_an_error(survey: Path) -> None:
    start, length = entries(survey)
    whole, box = survey.read_bytes(), (10, 10, 40, 40)
    for at, data, message in (
        (INFO + 40, struct.pack("<2Q", 1 << 60, length), "octree is not in the file"),
        (INFO + 48, struct.pack("<Q", length - 1), "octree is not in the file"),
        (INFO + 48, struct.pack("<Q", length - 32), "are not the 5 chunks"),
        (start + 16, struct.pack("<Q", 12345), "are not the 5 chunks"),
        (start + 28, struct.pack("<i", 0), "the 4 nodes of its octree with points"),
        (start, struct.pack("<i", 99), "at level 99"),
        (INFO + 24, struct.pack("<d", np.nan), "no center, or no size"),
        (start + 16, struct.pack("<Q2i", start, length, -1), "contains a page twice"),
    ):
        patched(survey, at, data)
        with pytest.raises(FileFormatError, match=message):
            read_points(survey, bounds=box)
        survey.write_bytes(whole)


def test_pages_of_an_octree_are_followed(survey: Path) -> None:
    """The root page has the root, and a page with all others."""
    start, length = entries(survey)
    content = survey.read_bytes()
    rest = content[start + 32 : start + length]
    at = len(content) + 32
    link = struct.pack("<4iQ2i", 1, 0, 0, 0, at, len(rest), -1)
    survey.write_bytes(content + link + rest)
    right = read_points(survey, bounds=(10, 10, 40, 40)).points
    patched(survey, start + 32, link)
    patched(survey, INFO + 48, struct.pack("<Q", 64))
    with laspy.open(survey) as file:
        assert copc.is_copc(file.header)
    assert np.array_equal(read_points(survey, bounds=(10, 10, 40, 40)).points, right)
