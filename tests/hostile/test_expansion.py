"""Files of arrays that expand without limit: rejected before memory is allocated for them."""

from __future__ import annotations

import struct
import tracemalloc
import zipfile
from typing import TYPE_CHECKING

import numpy as np
import pytest

import delone
from delone import FileFormatError
from delone._base import bounded
from delone.distributed.store.files import Store
from delone.io import read_mesh, read_points
from delone.terrain import TIN

if TYPE_CHECKING:
    from pathlib import Path

FLAT = np.array([(0.0, 0), (4, 0), (0, 3), (4, 3)])
SOLID = np.array([(0.0, 0, 0), (4, 0, 0), (0, 3, 0), (0, 0, 2), (4, 3, 2)])
ALWAYS = 1 << 20
LARGE = 16 * ALWAYS

SAVED = {
    "Delaunay 2-D": lambda: delone.Delaunay(FLAT),
    "Delaunay 3-D": lambda: delone.Delaunay(SOLID),
    "ConstrainedDelaunay": lambda: delone.ConstrainedDelaunay(FLAT, [(0, 1)]),
    "Mesh": lambda: delone.mesh(delone.ConstrainedDelaunay(FLAT, [(0, 1), (1, 3), (3, 2), (2, 0)])),
    "TIN": lambda: TIN.from_points(np.column_stack((FLAT, FLAT[:, 0]))),
    "TetMesh": lambda: delone.improve(delone.Delaunay(SOLID)),
    "RegularTriangulation": lambda: delone.RegularTriangulation(FLAT, FLAT[:, 0]),
    "PeriodicDelaunay": lambda: delone.PeriodicDelaunay(FLAT, (9, 9)),
    "Voronoi": lambda: delone.Voronoi(FLAT, clip="box"),
    "ConvexHull": lambda: delone.ConvexHull(FLAT),
    "Dynamic": lambda: delone.Dynamic(FLAT, [(0, 1)]),
}
READ = {
    "read_points": read_points,
    "read_mesh": read_mesh,
    "tile": lambda path: Store(path.parent).load_all(path.name),
    **dict.fromkeys(SAVED),
}


@pytest.fixture(autouse=True)
def _small_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bounded, "_ALWAYS", ALWAYS)


def zeros(columns: int) -> bytes:
    """An array of zeros as npy."""
    rows = LARGE // (8 * columns)
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", 118) + f"{head:<117}\n".encode() + bytes(LARGE)


def expanding(path: Path, made: delone.Delaunay, method: int = zipfile.ZIP_DEFLATED) -> None:
    """Save an object, and replace its points by many zeros."""
    made.save(path)
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    members["points.npy"] = zeros(made.points.shape[1])
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    assert path.stat().st_size < LARGE / 200


def refused(read, path: Path, match: str) -> None:
    tracemalloc.start()
    try:
        with pytest.raises(FileFormatError, match=match):
            read(path)
        assert tracemalloc.get_traced_memory()[1] < LARGE / 2
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("name", READ)
def test_what_expands_without_end(tmp_path: Path, name: str) -> None:
    made = SAVED.get(name, SAVED["Delaunay 2-D"])()
    path = tmp_path / "a.npz"
    expanding(path, made)
    refused(READ[name] or type(made).load, path, "more than 200 times larger")


@pytest.mark.parametrize("method", [zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
@pytest.mark.parametrize("read", [read_points, read_mesh, delone.Delaunay.load, READ["tile"]])
@pytest.mark.sampled(4)
def test_a_directory_that_lies(tmp_path: Path, read, method: int) -> None:
    path = tmp_path / "a.npz"
    expanding(path, SAVED["Delaunay 2-D"](), method)
    raw = bytearray(path.read_bytes())
    with zipfile.ZipFile(path) as archive:
        number = archive.namelist().index("points.npy")
    at = raw.index(b"PK\x01\x02")
    for _ in range(number):
        at = raw.index(b"PK\x01\x02", at + 4)
    raw[at + 24 : at + 28] = struct.pack("<I", 128 + 64)
    path.write_bytes(raw)
    refused(read, path, "declares|header says|stored or deflated|CRC")


def test_what_delone_saves_is_loaded(tmp_path: Path) -> None:
    # A lattice compresses far better than a survey, and `save` does not compress.
    x, y = np.meshgrid(np.arange(300.0), np.arange(300.0))
    mesh = delone.Delaunay(np.column_stack((x.ravel(), y.ravel())))
    mesh.save(tmp_path / "a.npz")
    assert np.array_equal(delone.Delaunay.load(tmp_path / "a.npz").simplices, mesh.simplices)
    np.savez_compressed(tmp_path / "b.npz", points=mesh.points, simplices=mesh.simplices)
    assert np.array_equal(read_mesh(tmp_path / "b.npz").simplices, mesh.simplices)


def test_members_count_together(tmp_path: Path) -> None:
    # Each may be as large as it is, all of them may not.
    path = tmp_path / "many.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for number in range(20):
            archive.writestr(f"points{number}.npy", bytes(ALWAYS - 1))
    assert path.stat().st_size * bounded.EXPANSION < 20 * ALWAYS
    with pytest.raises(FileFormatError, match="times larger when decompressed"):
        read_points(path)
