"""Live triangulations under signals and limits of memory, in processes of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

# A triangulation with segments or without, edits that take long, and its state.
COMMON = """
import os, resource, signal, sys
import numpy as np
from delone import Dynamic

draw = np.random.default_rng(0)
ndim, count = {ndim}, {count}
live = Dynamic(draw.random((count, ndim)), workers=1)
if {segments}:
    at = np.argsort(live.points[:, 0]).reshape(-1, 2)[::10]
    live.insert_segments(at[np.abs(np.diff(live.points[at, 1], axis=1)[:, 0]) < 0.002])
    free = np.setdiff1d(live.handles, live.input_segments)
else:
    free = live.handles
# Below and above the share from which on everything is built again.
few, many = free[:: 8], free[: len(free) * 9 // 10]
edits = {{
    "insert few": lambda: live.insert(draw.random((len(few), ndim))),
    "insert many": lambda: live.insert(draw.random((2 * len(many), ndim))),
    "remove few": lambda: live.remove(few),
    "remove many": lambda: live.remove(many[::2]),
    "move few": lambda: live.move(few, live.points[few] + 1e-3),
    "move many": lambda: live.move(many, draw.random((len(many), ndim))),
}}

def state():
    arrays = live.handles, live.points, live.simplices
    if ndim == 2:
        arrays += (live.segment_handles, live.input_segments, live.segments)
    return [array.tobytes() for array in arrays]
"""

# Calls look for signals 50 ms after their start, so batches must take longer.
LONG = [(2, 800_000, False), (2, 400_000, True), (3, 80_000, False)]
SHORT = [(2, 30_000, False), (2, 30_000, True), (3, 4_000, False)]


def start(code: str, kind: tuple[int, int, bool]) -> subprocess.Popen[str]:
    ndim, count, segments = kind
    common = COMMON.format(ndim=ndim, count=count, segments=segments)
    return subprocess.Popen(
        [sys.executable, "-c", common + textwrap.dedent(code)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Memory that is freed goes back, so that less than before is refused.
        env=os.environ | {"MALLOC_MMAP_THRESHOLD_": "32768", "MALLOC_TRIM_THRESHOLD_": "0"},
    )


def interrupted(process: subprocess.Popen[str]) -> str:
    """Sends Ctrl-C until a line comes: one that arrives between two calls may be lost."""
    assert process.stdout is not None
    answered = threading.Event()

    def send() -> None:
        process.send_signal(signal.SIGINT)
        while not answered.wait(10):
            process.send_signal(signal.SIGINT)

    sender = threading.Thread(target=send)
    sender.start()
    line = process.stdout.readline()
    answered.set()
    sender.join()
    return line


def finish(process: subprocess.Popen[str]) -> str:
    try:
        out, err = process.communicate(timeout=240)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    assert process.returncode == 0, err
    return out


@pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")
@pytest.mark.parametrize("kind", LONG, ids=str)
@pytest.mark.sampled(1)
def test_ctrl_c_ends_a_batch_and_nothing_has_changed(kind: tuple[int, int, bool]) -> None:
    # Only an exception that leaves a call of the core shows that it heard the signal itself.
    process = start(
        """
        signal.signal(signal.SIGINT, signal.default_int_handler)
        before, first = state(), live.snapshot()
        live.changes()
        names = ("insert", "remove", "relocate")
        heard = False

        def watch(frame, event, function):
            global heard
            if event == "c_exception" and function.__name__ in names:
                heard = True

        for name, edit in edits.items():
            heard = False
            print(name, flush=True)
            while not heard:
                try:
                    sys.setprofile(watch)
                    while True:
                        edit()
                        live.restore(first)
                except KeyboardInterrupt:
                    sys.setprofile(None)
                if not heard:
                    live.restore(first)
                    live.changes()
                print("heard" if heard else "again", flush=True)
            changes = live.changes()
            right = state() == before and not len(changes.gone) and not len(changes.new)
            print("right" if right else "wrong", flush=True)
        """,
        kind,
    )
    assert process.stdout is not None
    told = []
    for _ in range(6):
        told.append(process.stdout.readline())
        for _ in range(30):
            time.sleep(0.03)
            line = interrupted(process)
            if line != "again\n":
                break
        told.append(line)
        told.append(process.stdout.readline())
        if told[-2:] != ["heard\n", "right\n"]:
            process.kill()
            break
    assert told[1::3] == ["heard\n"] * 6, (told, process.communicate()[1])
    assert told[2::3] == ["right\n"] * 6, told
    finish(process)


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.deep("3")
def test_refused_memory_for_a_rebuild_takes_back_what_was_done(ndim: int) -> None:
    # A vertex with most others around it goes by a rebuild, and comes last.
    process = start(
        """
        angle = draw.random(3_000) * 7
        rim = np.column_stack((np.cos(angle), np.sin(angle), np.zeros(3_000)))[:, :ndim]
        if ndim == 3:
            rim[:, 2] = draw.random(3_000)
            rim /= np.linalg.norm(rim, axis=1)[:, None]
        points = np.concatenate((live.points * 0.01 + 3, rim, np.zeros((1, ndim))))
        live = Dynamic(points, workers=1)
        gone = np.concatenate((live.handles[: len(live.handles) // 16], [len(live) - 1]))
        before = state()
        for megabytes in (0, 1, 2, 4, 8, 1000):
            child = os.fork()
            if child == 0:
                size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                limits = resource.getrlimit(resource.RLIMIT_AS)
                resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20, limits[1]))
                try:
                    live.remove(gone)
                except MemoryError:
                    resource.setrlimit(resource.RLIMIT_AS, limits)
                    os._exit(3 if state() == before and live.validate() else 4)
                resource.setrlimit(resource.RLIMIT_AS, limits)
                os._exit(0 if live.validate() else 5)
            print(os.waitpid(child, 0)[1] / 256)
        """,
        (ndim, 60_000, False),
    )
    lines = finish(process).splitlines()
    assert lines[-1] == "0.0"
    assert {*lines[:-1]} <= {"0.0", "3.0"}
    assert ndim == 3 or "3.0" in lines


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
@pytest.mark.parametrize("kind", SHORT, ids=str)
@pytest.mark.sampled(1)
def test_refused_memory_changes_nothing(kind: tuple[int, int, bool]) -> None:
    process = start(
        """
        before = state()
        for name, edit in edits.items():
            outcomes = set()
            for megabytes in (0, 1, 2, 4, 8, 16, 32, 64, 1000):
                child = os.fork()
                if child == 0:
                    size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                    limits = resource.getrlimit(resource.RLIMIT_AS)
                    resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20, limits[1]))
                    try:
                        edit()
                    except MemoryError:
                        resource.setrlimit(resource.RLIMIT_AS, limits)
                        os._exit(3 if state() == before else 4)
                    resource.setrlimit(resource.RLIMIT_AS, limits)
                    os._exit(0 if live.validate() else 5)
                outcomes.add(os.waitpid(child, 0)[1] / 256)
            print(*sorted(outcomes))
        """,
        kind,
    )
    lines = finish(process).splitlines()
    assert len(lines) == 6
    # Small batches may need no more than what is there.
    assert {*lines} <= {"0.0", "0.0 3.0"}
    assert lines.count("0.0 3.0") >= 2
