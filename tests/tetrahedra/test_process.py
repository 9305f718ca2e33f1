"""Filling of surfaces under signals and limits, in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

# A ball of subdivided faces in a lattice of others: seconds of work in every stage.
SURFACE = """
import numpy as np
import delone

def sphere(count, seed=0):
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    hull = delone.ConvexHull(points)
    return hull.points * random.uniform(0.9, 1.0, (count, 1)), hull.simplices
"""


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", SURFACE + textwrap.dedent(code)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")
@pytest.mark.parametrize("boundary", ["faces", "surface"])
@pytest.mark.parametrize("stage", ["check", "recover", "select"])
@pytest.mark.sampled(2)
def test_a_signal_ends_each_stage(stage: str, boundary: str) -> None:
    out = run(
        f"""
        import signal

        class Stop(Exception):
            pass

        def stop(number, frame):
            raise Stop

        told = []

        def progress(stage, done):
            told.append(stage)
            if stage == {stage!r}:
                signal.setitimer(signal.ITIMER_REAL, 0.01)

        surface = sphere(30_000)
        signal.signal(signal.SIGALRM, stop)
        try:
            delone.tetrahedralize(*surface, boundary={boundary!r}, progress=progress, workers=1)
        except Stop:
            print(told[-1])
        """
    )
    assert out == f"{stage}\n"


@pytest.mark.skipif(sys.platform != "linux", reason="RLIMIT_AS is kept on Linux alone")
def test_memory_that_runs_out_on_the_way(tmp_path: Path) -> None:
    # Another process makes the surface, since what that frees would be enough for the tetrahedra.
    path = tmp_path / "surface.npz"
    run(f"np.savez({str(path)!r}, *sphere(12_000))")
    out = run(
        f"""
        import os, resource

        surface = tuple(np.load({str(path)!r}).values())
        delone.tetrahedralize(*sphere(20), workers=1)
        outcomes = set()
        for megabytes in (2, 4, 8, 12, 16, 400):
            child = os.fork()
            if child == 0:
                size = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
                resource.setrlimit(resource.RLIMIT_AS, (size + megabytes * 2**20,) * 2)
                try:
                    delone.tetrahedralize(*surface, workers=1)
                except MemoryError:
                    os._exit(3)
                os._exit(0)
            outcomes.add(os.waitpid(child, 0)[1])
        print(outcomes == {{0, 3 << 8}}, sorted(outcomes))
        """
    )
    assert out.startswith("True"), out
