"""Processes and a Dask cluster on this machine, workers killed, a scheduler gone."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, datasets, distributed
from delone.distributed.run import executors
from delone.errors import DeloneError, FileFormatError, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

POINTS = datasets.gaussian_clusters(3000)


def test_processes_agree_with_memory(tmp_path: Path, canonical: Callable[[Any], Any]) -> None:
    tin = distributed.triangulate(POINTS, tmp_path / "tin", tile_points=800, executor="processes")
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(POINTS).simplices))


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The worker processes, as they start."""
    processes: list[Any] = []

    def start(*args: Any, **kwargs: Any) -> Any:
        processes.append(subprocess.Popen(*args, **kwargs))
        return processes[-1]

    monkeypatch.setattr("delone.distributed.run.worker.Popen", start)
    return processes


def test_a_process_that_dies_changes_nothing(
    started: list[Any], tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    def kill(progress: distributed.Progress) -> None:
        if progress.stage == "begin" and progress.done == 2:
            started[0].kill()

    tin = distributed.triangulate(
        POINTS, tmp_path / "tin", tile_points=300, executor="processes", progress=kill
    )
    assert started[0].returncode not in (None, 0)
    assert all(worker.returncode == 0 for worker in started[1:])
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(POINTS).simplices))


@pytest.mark.deep
def test_processes_that_die_on_and_on_are_an_error(started: list[Any], tmp_path: Path) -> None:
    def kill(progress: distributed.Progress) -> None:
        for worker in started if progress.stage == "begin" else []:
            worker.kill()

    with pytest.raises(DeloneError, match=r"died .* times in the stage 'begin'.*memory"):
        distributed.triangulate(
            POINTS, tmp_path / "tin", tile_points=100, executor="processes", progress=kill
        )
    tin = distributed.triangulate(POINTS, tmp_path / "tin", tile_points=100)
    assert tin.validate()


SCRIPT = """
import os, signal, sys
from delone import datasets, distributed

def tell(progress):
    if progress.stage == "begin" and sys.argv[2:]:
        os.kill(os.getpid(), signal.SIGKILL)

points = datasets.gaussian_clusters(3000)
tin = distributed.triangulate(
    points, sys.argv[1], tile_points=300, executor="processes", progress=tell
)
print(tin.ntiles, "tiles")
"""


def test_a_script_needs_no_guard(tmp_path: Path) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    of_file = [str(tmp_path / "script.py"), str(tmp_path / "one")]
    of_input = ["-", str(tmp_path / "two")]
    for arguments in (of_file, of_input):
        done = subprocess.run(
            [sys.executable, *arguments], input=SCRIPT, capture_output=True, text=True, check=False
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, "10 tiles\n", "")


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="the process is killed by a signal")
def test_processes_end_with_who_started_them(tmp_path: Path) -> None:
    # A pipe that all inherit ends when the last of them does.
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(tmp_path / "tin"), "kill"],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert done.returncode == -signal.SIGKILL
    assert done.stderr == ""


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    library = pytest.importorskip("distributed")
    import dask

    with (
        dask.config.set({"distributed.comm.timeouts.connect": "5s"}),
        library.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=True,
            dashboard_address=":0",
            host="127.0.0.1",
        ) as cluster,
    ):
        yield cluster


def test_a_killed_worker_changes_nothing(
    cluster: Any, tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    library = pytest.importorskip("distributed")
    killed: list[int] = []

    def kill(progress: distributed.Progress) -> None:
        if progress.stage == "begin" and progress.done == 1 and not killed:
            killed.append(client.submit(os.getpid, pure=False).result())
            os.kill(killed[0], signal.SIGKILL)

    with library.Client(cluster) as client:
        before = set(client.run(os.getpid).values())
        tin = distributed.triangulate(
            POINTS, tmp_path / "tin", tile_points=300, executor=client, progress=kill
        )
        client.wait_for_workers(2)
    assert killed and killed[0] in before
    assert tin.ntiles == 10
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(POINTS).simplices))
    assert tin.validate()


def test_errors_of_tasks_come_through(cluster: Any, tmp_path: Path) -> None:
    library = pytest.importorskip("distributed")
    with (
        library.Client(cluster) as client,
        pytest.raises(InputError, match="line of rows 0 and 49"),
    ):
        line = [(i, i) for i in range(50)]
        distributed.triangulate(np.array(line, float), tmp_path / "tin", executor=client)


def test_a_file_that_fails_leaves_nothing_behind(cluster: Any, tmp_path: Path) -> None:
    library = pytest.importorskip("distributed")
    import pyarrow
    import pyarrow.parquet

    for number in range(9):
        some = POINTS[300 * number : 300 * number + 300]
        kind: Any = ["rock"] * 300 if number == 2 else range(300)
        columns = {"x": some[:, 0], "y": some[:, 1], "kind": kind}
        pyarrow.parquet.write_table(pyarrow.table(columns), tmp_path / f"{number}.parquet")
    source = str(tmp_path / "*.parquet")
    with library.Client(cluster) as client:
        with pytest.raises(FileFormatError, match=r"2\.parquet: 'kind' is not one number per row"):
            distributed.triangulate(
                source, tmp_path / "tin", attributes=["kind"], executor=client, tile_points=300
            )
        assert not (tmp_path / "tin").exists()
        tin = distributed.triangulate(source, tmp_path / "tin", executor=client, tile_points=300)
    assert tin.npoints == 2700


def test_a_scheduler_that_goes_away_is_named(
    tmp_path: Path, canonical: Callable[[Any], Any]
) -> None:
    library = pytest.importorskip("distributed")
    cluster = library.LocalCluster(
        n_workers=1, threads_per_worker=1, dashboard_address=":0", host="127.0.0.1"
    )
    client = library.Client(cluster)

    def leave(progress: distributed.Progress) -> None:
        if progress.stage == "begin" and progress.done == 2:
            cluster.close()

    try:
        with pytest.raises(DeloneError, match="the Dask scheduler is gone"):
            distributed.triangulate(
                POINTS, tmp_path / "tin", tile_points=300, executor=client, progress=leave
            )
    finally:
        client.close()
    tin = distributed.triangulate(POINTS, tmp_path / "tin", tile_points=300)
    assert np.array_equal(canonical(tin.read_simplices()), canonical(Delaunay(POINTS).simplices))


@pytest.mark.parametrize("executor", ["threads", 2, None])
def test_other_executors_are_refused(executor: Any, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="executor must be"):
        distributed.triangulate(POINTS, tmp_path / "tin", executor=executor)


@pytest.mark.parametrize("missing", ["pyarrow", "distributed"])
def test_a_missing_extra_is_one_clear_line(missing: str, tmp_path: Path) -> None:
    code = f"""
import sys
sys.modules[{missing!r}] = None
from delone import distributed, MissingExtraError
from delone.distributed.run.dask import DaskExecutor
try:
    distributed.triangulate([(0, 0), (1, 0), (0, 1)], {str(tmp_path / "tin")!r})
    DaskExecutor(7)
except MissingExtraError as error:
    print(error.extra, str(error))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.count("\n") == 1
    assert f"needs {missing}" in done.stdout
    assert 'pip install "delone[dask]"' in done.stdout


def test_the_cores_of_this_process_are_used_and_no_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("delone._base.arrays._usable_cores", lambda: 3)
    assert executors.Processes().workers == executors.Serial().threads == 3
    assert executors.Processes(2).workers == 2
    with pytest.raises(InputError, match="workers must be"):
        executors.Processes(0)
