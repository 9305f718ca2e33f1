"""Four and more dimensions under signals and limits of memory, in processes of their own."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals and limits of POSIX")

COMMON = """
import resource, signal, time
import numpy as np
import delone
from delone.interpolate import Linear

random = np.random.default_rng(0)

class Stop(Exception):
    pass

def stop(number, frame):
    raise Stop

signal.signal(signal.SIGALRM, stop)

def limited(nbytes):
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + nbytes, resource.RLIM_INFINITY))
"""


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", COMMON + textwrap.dedent(code)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


# Points on the moment curve: every second one of a million sets of seven is a simplex, and each
# insertion changes thousands. Points on a sphere: each query is decided by integers.
LONG = {
    "triangulation": "lambda: delone.Delaunay(curve)",
    "regular": "lambda: delone.RegularTriangulation(curve, weights)",
    "hull": "lambda: delone.ConvexHull(np.column_stack((curve, (curve**2).sum(axis=1))))",
    "lazy": "lambda: lazy(inside)",
}


@pytest.mark.parametrize("kind", LONG)
@pytest.mark.sampled(1)
def test_a_signal_ends_the_work(kind: str) -> None:
    out = run(
        f"""
        curve = np.linspace(-1, 1, 160)[:, None] ** np.arange(1, 7)
        sphere = random.normal(size=(4000, 4))
        sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
        inside = 0.2 * random.random((5000, 4))
        weights = 1e-3 * random.random(len(curve))
        lazy = Linear(sphere, sphere[:, 0], method="lazy", workers=1)
        work = {LONG[kind]}
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        try:
            work()
        except Stop:
            print("stopped")
        signal.setitimer(signal.ITIMER_REAL, 0)
        print(lazy(inside[:3]).shape, delone.Delaunay(curve[:20]).validate().ok)
        """
    )
    assert out.splitlines() == ["stopped", "(3,) True"]


LARGE = {
    "triangulation": "lambda: delone.Delaunay(scattered)",
    "regular": "lambda: delone.RegularTriangulation(scattered, scattered[:, 0])",
    "hull": "lambda: delone.ConvexHull(many / np.linalg.norm(many, axis=1)[:, None])",
    "lazy": "lambda: Linear(many, values, method='lazy')",
}


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
@pytest.mark.parametrize("kind", LARGE)
@pytest.mark.sampled(1)
def test_memory_that_is_refused_is_an_error(kind: str) -> None:
    out = run(
        f"""
        scattered, many = random.random((30_000, 5)), random.random((400_000, 8))
        values = np.zeros(len(many))
        work = {LARGE[kind]}
        limited(1 << 26)
        try:
            work()
        except MemoryError:
            print("refused")
        print(delone.Delaunay(scattered[:50]).validate().ok)
        """
    )
    assert out.splitlines() == ["refused", "True"]
