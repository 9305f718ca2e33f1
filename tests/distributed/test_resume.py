"""A run may end between any two changes of the file system; another one goes on from there."""

from __future__ import annotations

import errno
import os
import platform
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets, distributed
from delone.distributed.store import files
from delone.distributed.store.lock import LOCK, locked
from delone.errors import BusyError, InputError, NonFiniteError

if TYPE_CHECKING:
    from collections.abc import Callable

POINTS = datasets.integer_lattice(90, side=12)
SIZE = 45


class Crash(BaseException):
    """What no handler expects."""


def run(folder: Path, **options: Any) -> distributed.TiledDelaunay:
    return distributed.triangulate(POINTS, folder / "tin", tile_points=SIZE, **options)


@pytest.fixture(scope="module")
def steps() -> int:
    """How many steps a whole run has."""
    import tempfile

    count = 0

    def counted(what: str) -> None:
        nonlocal count
        count += 1

    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(files, "step", counted)
        run(Path(folder))
    assert count > 100
    return count


def crash_at(at: int, how: Callable[[], None]) -> Callable[[str], None]:
    left = at

    def step(what: str) -> None:
        nonlocal left
        # Other threads may be at work: they stop at their next step.
        if left <= 0:
            how()
        left -= 1

    return step


@pytest.mark.deep
def test_a_crash_between_any_two_changes_is_survived(
    steps: int, tmp_path: Path, canonical: Callable[[Any], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    right = canonical(Delaunay(POINTS).simplices)

    def stop() -> None:
        raise Crash

    for at in range(steps):
        folder = tmp_path / str(at)
        monkeypatch.setattr(files, "step", crash_at(at, stop))
        with pytest.raises(Crash):
            run(folder)
        monkeypatch.setattr(files, "step", lambda what: None)
        tin = run(folder)
        assert np.array_equal(canonical(tin.read_simplices()), right), at
        assert not (folder / "tin" / "work").exists()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are killed in forks")
def test_a_killed_process_leaves_what_can_be_gone_on_from(
    steps: int, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    right = canonical(Delaunay(POINTS).simplices)
    for at in range(3, steps, 7):
        folder = tmp_path / str(at)
        child = os.fork()
        if child == 0:
            files.step = crash_at(at, lambda: os.kill(os.getpid(), signal.SIGKILL))
            run(folder)
            os._exit(0)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL
        tin = run(folder)
        assert np.array_equal(canonical(tin.read_simplices()), right), at
        assert not list((folder / "tin").rglob(".*"))


def test_a_finished_tile_is_not_done_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[str] = []

    def stop_late(what: str) -> None:
        begun.append(what)
        if what == "before triangles/tile=000001.parquet":
            raise Crash

    monkeypatch.setattr(files, "step", stop_late)
    with pytest.raises(Crash):
        run(tmp_path)
    assert "before triangles/tile=000000.parquet" in begun
    begun.clear()
    monkeypatch.setattr(files, "step", begun.append)
    run(tmp_path)
    assert "before triangles/tile=000001.parquet" in begun
    assert "before triangles/tile=000000.parquet" not in begun
    begun.clear()
    run(tmp_path)
    assert not [what for what in begun if what.startswith("before tri")]


def test_a_full_disk_is_a_clean_stop(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, canonical: Callable[[Any], Any]
) -> None:
    def full(what: str) -> None:
        if what.startswith("before the renaming of vertices"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(files, "step", full)
    with pytest.raises(OSError, match="make room and run the same again") as caught:
        run(tmp_path)
    assert caught.value.errno == errno.ENOSPC
    assert not list((tmp_path / "tin").rglob(".*"))
    monkeypatch.setattr(files, "step", lambda what: None)
    right = canonical(Delaunay(POINTS).simplices)
    assert np.array_equal(canonical(run(tmp_path).read_simplices()), right)


def test_outputs_are_never_mixed(tmp_path: Path) -> None:
    run(tmp_path)
    assert run(tmp_path).npoints == len(POINTS)
    with pytest.raises(InputError, match="already contains a run"):
        run(tmp_path, resume=False)
    with pytest.raises(InputError, match=r"tile_points differ"):
        distributed.triangulate(POINTS, tmp_path / "tin", tile_points=SIZE + 1)
    with pytest.raises(InputError, match=r"source differ"):
        distributed.triangulate(POINTS + 1, tmp_path / "tin", tile_points=SIZE)
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.txt").write_text("years of work")
    with pytest.raises(InputError, match="does not contain a run"):
        distributed.triangulate(POINTS, other, tile_points=SIZE)
    assert (other / "thesis.txt").read_text() == "years of work"
    with pytest.raises(InputError, match="not a folder"):
        distributed.triangulate(POINTS, other / "thesis.txt", tile_points=SIZE)


def test_a_folder_named_work_of_somebody_else_is_left_alone(tmp_path: Path) -> None:
    theirs = tmp_path / "tin" / "work" / "thesis.txt"
    theirs.parent.mkdir(parents=True)
    theirs.write_text("years of work")
    with pytest.raises(InputError, match="does not contain a run"):
        run(tmp_path)
    assert theirs.read_text() == "years of work"
    assert [p.name for p in (tmp_path / "tin").iterdir()] == ["work"]


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() == 0, reason="root may write anywhere")
def test_what_is_finished_needs_no_writing(tmp_path: Path) -> None:
    run(tmp_path)
    (tmp_path / "tin").chmod(0o555)
    assert run(tmp_path).npoints == len(POINTS)
    (tmp_path / "tin").chmod(0o755)


def test_what_is_finished_is_not_locked(tmp_path: Path) -> None:
    run(tmp_path)
    with locked(tmp_path / "tin"):
        assert run(tmp_path).npoints == len(POINTS)
    with pytest.raises(InputError, match="differ"):
        run(tmp_path, nan="drop")


def test_a_mistake_does_not_hold_its_folder(tmp_path: Path) -> None:
    spoilt = np.concatenate([POINTS, [[np.nan, 0.0]]])
    with pytest.raises(NonFiniteError):
        distributed.triangulate(spoilt, tmp_path / "tin", tile_points=SIZE)
    assert not (tmp_path / "tin").exists()
    assert run(tmp_path).npoints == len(POINTS)
    # A folder that was there stays.
    (tmp_path / "mine").mkdir()
    with pytest.raises(NonFiniteError):
        distributed.triangulate(spoilt, tmp_path / "mine", tile_points=SIZE)
    assert not list((tmp_path / "mine").iterdir())


def test_two_runs_do_not_write_at_a_time(tmp_path: Path) -> None:
    with locked(tmp_path / "tin"), pytest.raises(BusyError, match="is being written") as caught:
        run(tmp_path)
    assert (caught.value.pid, caught.value.host) == (os.getpid(), platform.node())
    assert run(tmp_path).npoints == len(POINTS)
    assert not (tmp_path / "tin" / LOCK).exists()
    assert not (tmp_path / "tin" / "work").exists()


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="processes are killed by signals")
def test_a_lock_ends_with_its_process(tmp_path: Path) -> None:
    code = f"""
import pathlib, time
from delone.distributed.store.lock import locked
with locked(pathlib.Path({str(tmp_path / "tin")!r})):
    print("locked", flush=True)
    time.sleep(600)
"""
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as other:
        assert other.stdout is not None and other.stdout.readline() == b"locked\n"
        with pytest.raises(BusyError) as caught:
            run(tmp_path)
        assert caught.value.pid == other.pid
        other.kill()
    assert (tmp_path / "tin" / LOCK).exists()
    assert run(tmp_path).npoints == len(POINTS)
    assert not (tmp_path / "tin" / LOCK).exists()


def test_what_is_not_finished_cannot_be_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(what: str) -> None:
        if what.startswith("before manifest"):
            raise Crash

    monkeypatch.setattr(files, "step", stop)
    with pytest.raises(Crash):
        run(tmp_path)
    with pytest.raises(FileNotFoundError, match="not finished"):
        distributed.open(tmp_path / "tin")
    with pytest.raises(FileNotFoundError, match="no such folder"):
        distributed.open(tmp_path / "nowhere")
