"""Saving and loading, and every way in which a file can be wrong."""

from __future__ import annotations

import contextlib
import io
import os
import struct
import zipfile
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, FileFormatError, datasets

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture
def mesh() -> Delaunay:
    return Delaunay(datasets.duplicates(60))


@pytest.fixture
def path(mesh: Delaunay, tmp_path: Path) -> Path:
    path = tmp_path / "mesh.npz"
    mesh.save(path)
    return path


def test_what_is_saved_is_loaded(mesh: Delaunay, path: Path) -> None:
    loaded = Delaunay.load(path)
    for name in ("points", "simplices", "neighbors", "duplicate_of", "edges", "coplanar"):
        found = getattr(loaded, name)
        assert np.array_equal(found, getattr(mesh, name))
        assert found.dtype == getattr(mesh, name).dtype
        assert not found.flags.writeable
    assert loaded.stages == {}
    assert loaded.validate()
    assert np.array_equal(loaded.find_simplex(mesh.points), mesh.find_simplex(mesh.points))


def test_the_path_is_taken_as_it_is(mesh: Delaunay, tmp_path: Path) -> None:
    mesh.save(str(tmp_path / "plain"))
    assert [p.name for p in tmp_path.iterdir()] == ["plain"]
    assert Delaunay.load(str(tmp_path / "plain")).nsimplex == mesh.nsimplex


def test_the_same_mesh_gives_the_same_bytes(mesh: Delaunay, tmp_path: Path) -> None:
    for name in ("a", "b"):
        mesh.save(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_a_missing_file_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        Delaunay.load(tmp_path / "none.npz")
    with pytest.raises(OSError):
        Delaunay.load(tmp_path)


def test_a_failed_save_leaves_what_was_there(
    mesh: Delaunay, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = path.read_bytes()

    def full(file: io.BufferedWriter, **arrays: Any) -> None:
        file.write(b"half")
        raise OSError("no space left")

    monkeypatch.setattr(np, "savez", full)
    with pytest.raises(OSError, match="no space"):
        mesh.save(path)
    assert path.read_bytes() == before
    assert os.listdir(path.parent) == [path.name]


def test_every_truncation_is_noticed(path: Path) -> None:
    whole = path.read_bytes()
    for size in [*range(0, len(whole), 97), len(whole) - 1]:
        path.write_bytes(whole[:size])
        with pytest.raises(FileFormatError, match=r"mesh\.npz"):
            Delaunay.load(path)


def test_changed_bytes_are_noticed_or_harmless(mesh: Delaunay, path: Path) -> None:
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    for position in rng.choice(len(whole), 400, replace=False):
        torn = bytearray(whole)
        torn[position] ^= 1 << int(rng.integers(8))
        path.write_bytes(torn)
        try:
            loaded = Delaunay.load(path)
        except FileFormatError:
            continue
        # Zip headers have bytes that mean nothing here, dates for one.
        assert np.array_equal(loaded.simplices, mesh.simplices)
        assert np.array_equal(loaded.points, mesh.points)


@pytest.mark.parametrize(
    "content", [b"", b"PK\x05\x06" + bytes(18), b"x,y\n1,2\n", b"\x93NUMPY\x01\x00", bytes(1000)]
)
def test_other_files_are_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(FileFormatError):
        Delaunay.load(path)


def test_objects_are_never_unpickled(tmp_path: Path) -> None:
    path = tmp_path / "evil.npz"
    np.savez(path, format=np.array([print], dtype=object), allow_pickle=True)
    with pytest.raises(FileFormatError):
        Delaunay.load(path)


def rewrite(path: Path, **changes: Any) -> None:
    """Replace arrays of an archive; None takes one away."""
    with np.load(path) as archive:
        arrays = dict(archive)
    arrays.update(changes)
    np.savez(path, **{name: array for name, array in arrays.items() if array is not None})


def test_rewriting_alone_does_no_harm(path: Path) -> None:
    rewrite(path)
    assert Delaunay.load(path).validate()


@pytest.mark.parametrize("name", ["format", "version", "points", "simplices", "neighbors"])
def test_a_missing_array_is_named(name: str, path: Path) -> None:
    rewrite(path, **{name: None})
    with pytest.raises(FileFormatError, match=name):
        Delaunay.load(path)


def test_other_formats_and_versions_are_refused(path: Path) -> None:
    rewrite(path, version=np.array(2))
    with pytest.raises(FileFormatError, match="version"):
        Delaunay.load(path)
    rewrite(path, version=np.array(1), format=np.array("something"))
    with pytest.raises(FileFormatError, match="format"):
        Delaunay.load(path)


def moved(array: Any, index: tuple[int, ...], value: Any) -> Any:
    changed = array.copy()
    changed[index] = value
    return changed


CONTRADICTIONS: dict[str, Callable[[dict[str, Any]], dict[str, Any]]] = {
    "dtype": lambda a: {"points": a["points"].astype(np.float32)},
    "byte order": lambda a: {"simplices": a["simplices"].astype(">i4")},
    "columns": lambda a: {"simplices": a["simplices"][:, :2]},
    "axes": lambda a: {"points": a["points"].ravel()},
    "fortran": lambda a: {"points": np.asfortranarray(a["points"])},
    "nan": lambda a: {"points": moved(a["points"], (0, 0), np.nan)},
    "vertex too large": lambda a: {"simplices": moved(a["simplices"], (0, 0), 60)},
    "negative vertex": lambda a: {"simplices": moved(a["simplices"], (0, 0), -1)},
    "neighbour too large": lambda a: {"neighbors": moved(a["neighbors"], (0, 0), 10**6)},
    "neighbour below -1": lambda a: {"neighbors": moved(a["neighbors"], (0, 0), -2)},
    "neighbours not mutual": lambda a: {"neighbors": np.roll(a["neighbors"], 1, axis=1)},
    "no neighbours": lambda a: {"neighbors": np.full_like(a["neighbors"], -1)},
    "fewer neighbours": lambda a: {"neighbors": a["neighbors"][:-1]},
    "no triangles": lambda a: {"simplices": a["simplices"][:0], "neighbors": a["neighbors"][:0]},
    "clockwise": lambda a: {
        "simplices": a["simplices"][:, ::-1],
        "neighbors": a["neighbors"][:, ::-1],
    },
    "mirrored points": lambda a: {"points": -a["points"] * [1, -1]},
    "lost duplicates": lambda a: {"duplicates": a["duplicates"][:0]},
    "wrong duplicate": lambda a: {"duplicates": moved(a["duplicates"], (-1, 1), 0)},
    "duplicates in disorder": lambda a: {"duplicates": a["duplicates"][::-1].copy()},
    "one point more": lambda a: {"points": np.vstack((a["points"], [(9, 9)]))},
}


@pytest.mark.parametrize("name", CONTRADICTIONS)
def test_contradictions_are_refused(name: str, path: Path) -> None:
    with np.load(path) as archive:
        arrays = dict(archive)
    rewrite(path, **CONTRADICTIONS[name](arrays))
    with pytest.raises(FileFormatError):
        Delaunay.load(path)


def test_neighbours_of_inner_triangles_must_be_mutual(path: Path) -> None:
    with np.load(path) as archive:
        neighbors = archive["neighbors"]
    # The boundary stays what it is, only the way across inner edges is wrong.
    inner = np.flatnonzero((neighbors >= 0).all(axis=1))[0]
    rewrite(path, neighbors=moved(neighbors, (inner,), np.roll(neighbors[inner], 1)))
    with pytest.raises(FileFormatError, match="mutual"):
        Delaunay.load(path)


def test_a_torn_off_part_is_refused(tmp_path: Path) -> None:
    # Two triangulations in one archive: everything is mutual, but the boundary is two cycles.
    one = Delaunay([(0, 0), (1, 0), (0, 1)])
    points = np.concatenate((one.points, one.points + 5))
    path = tmp_path / "two.npz"
    one.save(path)
    rewrite(
        path,
        points=points,
        simplices=np.concatenate((one.simplices, one.simplices + 3)),
        neighbors=np.full((2, 3), -1, dtype=np.int32),
    )
    with pytest.raises(FileFormatError, match="cycle"):
        Delaunay.load(path)


def test_a_header_that_claims_more_than_there_is(path: Path) -> None:
    with zipfile.ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 2)}
    )
    members["points.npy"] = header.getvalue() + bytes(160)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    with pytest.raises(FileFormatError, match="points"):
        Delaunay.load(path)


def test_every_byte_of_the_directory_may_be_damaged(mesh: Delaunay, path: Path) -> None:
    whole = path.read_bytes()
    for at in range(len(whole) - 120, len(whole)):
        path.write_bytes(whole[:at] + b"\xff" + whole[at + 1 :])
        with contextlib.suppress(FileFormatError):
            assert np.array_equal(Delaunay.load(path).simplices, mesh.simplices)


def test_a_link_keeps_its_target_and_a_private_file_its_mode(
    mesh: Delaunay, tmp_path: Path
) -> None:
    real, link = tmp_path / "real.npz", tmp_path / "link.npz"
    real.touch(0o600)
    link.symlink_to(real)
    mesh.save(link)
    assert link.is_symlink()
    assert real.stat().st_mode & 0o777 == 0o600
    assert np.array_equal(Delaunay.load(real).simplices, mesh.simplices)


def test_only_regular_files_are_replaced(mesh: Delaunay, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.npz"
    os.mkfifo(pipe)
    with pytest.raises(OSError, match="not a regular file"):
        mesh.save(pipe)
    assert pipe.is_fifo()
    with pytest.raises(FileNotFoundError, match=r"nowhere"):
        mesh.save(tmp_path / "nowhere" / "mesh.npz")


@pytest.mark.parametrize("path", [None, 3, io.BytesIO(), b"mesh.npz"])
def test_what_is_no_path_is_a_type_error(mesh: Delaunay, path: Any) -> None:
    with pytest.raises(TypeError, match="path must be a string or a path-like object, got"):
        Delaunay.load(path)
    with pytest.raises(TypeError, match="path must be a string or a path-like object, got"):
        mesh.save(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are of POSIX")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.npz")
    with pytest.raises(OSError, match="not a regular file"):
        Delaunay.load(tmp_path / "pipe.npz")


def test_whatever_parsing_raises_is_a_format_error(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for error in (OSError(22, "Invalid argument"), OverflowError(), KeyError(), struct.error()):

        def fail(*_: object, error: Exception = error, **__: object) -> None:
            raise error

        with monkeypatch.context() as patch:
            patch.setattr(zipfile.ZipFile, "open", fail)
            with pytest.raises(FileFormatError, match=r"mesh\.npz"):
                Delaunay.load(path)
