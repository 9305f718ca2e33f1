"""Meshes in files of their own, and every way in which such a file can be wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import FileFormatError

POINTS = np.array([(0.0, 0), (4, 0), (4, 3), (0, 3), (1, 1), (2, 1), (2, 2), (1, 2), (1.5, 1)])
SEGMENTS = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)])


@pytest.fixture(scope="module")
def mesh() -> delone.Mesh:
    frozen = np.arange(8) == 2
    return delone.mesh(
        (POINTS, SEGMENTS), max_area=0.1, segment_markers=np.arange(8), fixed=frozen, min_angle=25
    )


@pytest.fixture
def path(mesh: delone.Mesh, tmp_path: Path) -> Path:
    file = tmp_path / "mesh.npz"
    mesh.save(file)
    return file


def test_what_is_saved_is_loaded(mesh: delone.Mesh, path: Path) -> None:
    found = delone.Mesh.load(path)
    for name, array in mesh._arrays().items():
        assert np.array_equal(found._arrays()[name], array), name
        assert found._arrays()[name].dtype == array.dtype, name
    assert str(found.report) == str(mesh.report)
    for name in ("segments", "segment_markers", "point_source", "region", "boundary"):
        assert np.array_equal(getattr(found, name), getattr(mesh, name)), name
    with pytest.raises(ValueError, match="read-only"):
        found.points[0] = 1


def test_a_loaded_mesh_goes_on(mesh: delone.Mesh, path: Path) -> None:
    found = delone.Mesh.load(path)
    for change in (
        lambda m: m.refine([0, 5], ratio=0.1),
        lambda m: m.coarsen(),
        lambda m: m.smooth(2, "odt"),
    ):
        assert np.array_equal(change(found).points, change(mesh).points)


def test_other_kinds_are_refused(path: Path, tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="format"):
        delone.Delaunay.load(path)
    other = tmp_path / "other.npz"
    delone.Delaunay(POINTS).save(other)
    with pytest.raises(FileFormatError, match="format"):
        delone.Mesh.load(other)
    whole = path.read_bytes()
    for count in (0, 10, len(whole) // 2, len(whole) - 30):
        path.write_bytes(whole[:count])
        with pytest.raises(FileFormatError):
            delone.Mesh.load(path)


def changed(path: Path, name: str, change: Any) -> None:
    with np.load(path) as archive:
        arrays = dict(archive)
    arrays[name] = change(arrays[name].copy())
    np.savez(path, **arrays)


def put(*where: int, value: float) -> Any:
    def change(array: np.ndarray) -> np.ndarray:
        array[where] = value
        return array

    return change


WRONG: list[tuple[str, Any, str]] = [
    ("points", put(0, 0, value=np.nan), "finite"),
    ("points", put(0, 0, value=50.0), "counter-clockwise"),
    ("points", lambda p: np.vstack((p, [(9.0, 9)])), "entries"),
    ("simplices", put(0, 0, value=10**6), "simplices"),
    ("simplices", lambda s: s[:, ::-1].copy(), "mutual|counter"),
    ("neighbors", put(0, value=0), "mutual"),
    ("neighbors", put(0, value=-1), "mutual|line"),
    ("sides", put(0, value=-2), "sides"),
    ("sides", lambda s: np.full_like(s, -1), "on no line"),
    ("sides", lambda s: np.where(s < 0, 0, s)[:-1].copy(), "sides"),
    ("region", lambda r: np.arange(len(r), dtype=r.dtype), "region"),
    ("region", lambda r: r[1:].copy(), "region"),
    ("on", put(0, value=99), "on has"),
    ("ends", put(0, 0, value=-1), "ends"),
    ("start", put(1, value=-5), "order"),
    ("start", put(-1, value=1), "range|order"),
    ("source", put(0, value=-1), "source"),
    ("forward", lambda f: f[1:].copy(), "forward"),
    ("frozen", lambda f: f[1:].copy(), "frozen"),
    ("line_markers", lambda f: f[1:].copy(), "line_markers"),
    ("line_geometries", lambda f: f[1:].copy(), "line_geometries"),
    ("point_source", put(0, value=-7), "point_source"),
    ("point_markers", lambda f: f[1:].copy(), "point_markers"),
    ("bound", put(0, value=60.0), "angle"),
    ("bound", put(0, value=np.nan), "angle"),
    ("counts", put(0, value=-1), "counts"),
    ("duplicates", lambda d: np.zeros((1, 2), dtype=d.dtype), "duplicates"),
]


@pytest.mark.parametrize(("name", "change", "message"), WRONG)
def test_contradictions_are_refused(name: str, change: Any, message: str, path: Path) -> None:
    changed(path, name, change)
    with pytest.raises(FileFormatError, match=message):
        delone.Mesh.load(path)


def test_triangles_on_both_sides_of_a_line_are_neighbors(tmp_path: Path) -> None:
    halved = delone.mesh(
        ([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    )
    assert halved.neighbors.tolist().count([-1, -1, -1]) == 0
    file = tmp_path / "halved.npz"
    halved.save(file)
    changed(file, "neighbors", lambda n: np.full_like(n, -1))
    with pytest.raises(FileFormatError, match="mutual"):
        delone.Mesh.load(file)
