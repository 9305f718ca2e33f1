"""Triangulations of directions under signals and limits, in processes of their own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time

import pytest


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


# Calls take several times the 50 ms between two looks at signals.
OVERLAPS = """
    import signal, sys
    import numpy as np
    from delone import Delaunay, Overlaps, sphere

    signal.signal(signal.SIGINT, signal.default_int_handler)
    if {target!r} == "plane":
        source, target = (Delaunay(np.random.default_rng(k).random((12_000, 2))) for k in (0, 1))
        room = Overlaps
    else:
        source, room = sphere.Grid.from_healpix(48), sphere.Overlaps
        if {target!r} == "healpix":
            target = sphere.Grid.from_healpix(47)
        else:
            target = sphere.Grid.from_lonlat(np.arange(361), np.arange(-90, 91))

    def arrays():
        found = room(source, target, workers={workers})
        return found.indptr, found.indices, found.areas

    known, heard = arrays(), False

    def watch(frame, event, function):
        global heard
        if event == "c_exception" and function.__name__ == "overlaps":
            heard = True

    while not heard:
        try:
            sys.setprofile(watch)
            print("ready", flush=True)
            while True:
                arrays()
        except KeyboardInterrupt:
            sys.setprofile(None)
    print("stopped", flush=True)
    # Nothing is broken: the next call is right, bit for bit.
    print(all(map(np.array_equal, arrays(), known)))
"""


@pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")
@pytest.mark.parametrize("workers", [1, 2])
def test_a_signal_ends_a_long_triangulation(workers: int) -> None:
    # So near to one great circle that integers of thousands of bits decide.
    out = run(
        f"""
        import signal
        import numpy as np
        from delone import sphere

        class Stop(Exception):
            pass

        def stop(number, frame):
            raise Stop

        random = np.random.default_rng(0)
        vectors = random.normal(size=(20_000, 3)) * (1.0, 1.0, 1e-290)
        signal.signal(signal.SIGALRM, stop)
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        try:
            sphere.Delaunay(xyz=vectors, workers={workers})
        except Stop:
            print("stopped")
        """
    )
    assert out == "stopped\n"


@pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")
@pytest.mark.parametrize("target", ["healpix", "lonlat", "plane"])
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.sampled(3)
def test_ctrl_c_ends_overlaps_and_leaves_grids_whole(target: str, workers: int) -> None:
    # The profiler hears of each call of the core. Only an exception that leaves one shows that the
    # signal came through from within: one that comes between two calls is tried again.
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(OVERLAPS.format(target=target, workers=workers))],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    line = process.stdout.readline()
    for attempt in range(50):
        if line != "ready\n":
            break
        # Later and later: a call of the core is not all that takes time.
        time.sleep(0.05 * (1 + attempt))
        process.send_signal(signal.SIGINT)
        line = process.stdout.readline()
    if line != "stopped\n":
        process.kill()
    out, err = process.communicate(timeout=240)
    assert (line, out) == ("stopped\n", "True\n"), err


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
def test_memory_that_runs_out_on_the_way() -> None:
    out = run(
        """
        import os, resource
        import numpy as np
        from delone import sphere

        vectors = np.random.default_rng(0).normal(size=(100_000, 3))
        sphere.Delaunay(xyz=vectors[:100])
        outcomes = set()
        for megabytes in (1, 3, 6, 10, 14, 18, 22, 400):
            child = os.fork()
            if child == 0:
                size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20,) * 2)
                try:
                    sphere.Delaunay(xyz=vectors, workers=1)
                except MemoryError:
                    os._exit(3)
                os._exit(0)
            outcomes.add(os.waitpid(child, 0)[1])
        print(outcomes == {0, 3 << 8})
        """
    )
    assert out == "True\n"
