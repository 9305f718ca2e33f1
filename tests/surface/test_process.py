"""Checks of surfaces under signals and limits, in processes of their own."""

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
def test_a_signal_ends_the_search_for_pairs(workers: int) -> None:
    # Faces around one vertex: all boxes meet, and a whole search takes minutes.
    out = run(
        f"""
        import signal
        import numpy as np
        import delone

        class Stop(Exception):
            pass

        def stop(number, frame):
            raise Stop

        random = np.random.default_rng(0)
        points = np.concatenate(([(0, 0, 0)], random.normal(size=(120_000, 3))))
        faces = np.column_stack((np.zeros(60_000), np.arange(1, 120_001).reshape(-1, 2)))
        signal.signal(signal.SIGALRM, stop)
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        try:
            delone.check_surface(points, faces.astype(int), workers={workers})
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
        import delone

        n = 300
        i, j = (a.ravel() for a in np.meshgrid(*2 * [np.arange(n - 1)], indexing="ij"))
        a, b, c, d = i * n + j, (i + 1) * n + j, i * n + j + 1, (i + 1) * n + j + 1
        faces = np.concatenate((np.stack((a, b, c), 1), np.stack((b, d, c), 1)))
        x, y = np.divmod(np.arange(n * n), n)
        points = np.column_stack((x, y, x * y % 7)).astype(float)
        delone.check_surface(points[:9], [(0, 1, 2)])
        outcomes = set()
        for megabytes in (4, 8, 12, 16, 24, 400):
            child = os.fork()
            if child == 0:
                size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20,) * 2)
                try:
                    delone.check_surface(points, faces, workers=1)
                except MemoryError:
                    os._exit(3)
                os._exit(0)
            outcomes.add(os.waitpid(child, 0)[1])
        print(outcomes == {0, 3 << 8})
        """
    )
    assert out == "True\n"
