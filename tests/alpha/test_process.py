"""Alpha complexes and concave hulls under signals and limits, in processes of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest


def start(code: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(code)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def finish(process: subprocess.Popen[str]) -> str:
    try:
        out, err = process.communicate(timeout=120)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    assert process.returncode == 0, err
    return out


@pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")
@pytest.mark.parametrize(
    ("ndim", "name", "call"),
    [
        (2, "alpha_flat", "delone.AlphaComplex(mesh, workers=1)"),
        (3, "alpha_solid3", "delone.AlphaComplex(mesh, workers=1)"),
        (2, "erode", "delone.concave_hull(mesh, ratio=0, holes=True)"),
    ],
)
def test_ctrl_c_ends_one_call(ndim: int, name: str, call: str) -> None:
    # Only an exception that leaves a call of the core shows that the signal came through.
    process = start(
        f"""
        import signal, sys
        import numpy as np
        import delone

        signal.signal(signal.SIGINT, signal.default_int_handler)
        mesh = delone.Delaunay(np.random.default_rng(0).random((200_000, {ndim})))
        interrupted = False

        def watch(frame, event, function):
            global interrupted
            if event == "c_exception" and function.__name__ == {name!r}:
                interrupted = True

        print("ready", flush=True)
        while not interrupted:
            try:
                sys.setprofile(watch)
                while True:
                    {call}
            except KeyboardInterrupt:
                sys.setprofile(None)
            print("stopped" if interrupted else "again", flush=True)
        """
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    for _ in range(50):
        if line not in ("ready\n", "again\n"):
            break
        time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        line = process.stdout.readline()
    if line != "stopped\n":
        process.kill()
    assert line == "stopped\n", process.communicate()[1]
    finish(process)


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
@pytest.mark.deep
def test_memory_that_runs_out_on_the_way() -> None:
    process = start(
        """
        import os, resource
        import numpy as np
        import delone
        made = [delone.Delaunay(np.random.default_rng(0).random((n, d)))
                for n, d in ((700_000, 2), (120_000, 3))]
        tasks = [
            lambda: delone.AlphaComplex(made[0]),
            lambda: delone.AlphaComplex(made[1]),
            lambda: delone.concave_hull(made[0], ratio=0, holes=True),
        ]
        for task in tasks:
            outcomes = set()
            for megabytes in (5, 10, 15, 25, 40, 400):
                child = os.fork()
                if child == 0:
                    size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                    resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20,) * 2)
                    try:
                        task()
                    except MemoryError:
                        os._exit(3)
                    os._exit(0)
                outcomes.add(os.waitpid(child, 0)[1])
            print(outcomes == {0, 3 << 8})
        """
    )
    assert finish(process).split() == ["True"] * 3
