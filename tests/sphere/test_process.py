"""Triangulations of directions under signals and limits, in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap

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
