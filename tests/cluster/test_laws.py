"""Laws of all methods: rows, units and threads do not matter; interruption and lack of memory."""

from __future__ import annotations

import signal
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from clustered import LARGE, partition
from delone.cluster import DBSCAN, HDBSCAN, single_linkage

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Each method as a function of points, the unit of length, and the number of threads.
ALL: dict[str, Callable[[Floats, float, int], Any]] = {
    "hdbscan": lambda p, unit, w: HDBSCAN(8, workers=w).fit(p),
    "few samples": lambda p, unit, w: HDBSCAN(5, min_samples=1, workers=w).fit(p),
    "many samples": lambda p, unit, w: HDBSCAN(10, min_samples=40, workers=w).fit(p),
    "epsilon": lambda p, unit, w: HDBSCAN(
        4, cluster_selection_epsilon=unit / 16, cluster_selection_method="leaf", workers=w
    ).fit(p),
    "dbscan": lambda p, unit, w: DBSCAN(unit / 64, min_samples=4, workers=w).fit(p),
    "wide dbscan": lambda p, unit, w: DBSCAN(unit, min_samples=9, workers=w).fit(p),
}
CASES = [pytest.param(name, survey, id=f"{name}-{survey}") for name in ALL for survey in LARGE]


@pytest.mark.parametrize(("name", "survey"), CASES)
@pytest.mark.sampled(8)
def test_rows_units_and_threads_do_not_matter(name: str, survey: str) -> None:
    points = LARGE[survey]
    one = ALL[name](points, 1.0, 1)
    order = np.random.default_rng(1).permutation(len(points))
    unit = 2.0**-240
    # Reflected and transposed: no tie is broken by coordinates, but for the borders of DBSCAN.
    changed = points[order] * unit if "dbscan" in name else -points[order, ::-1] * unit
    other = ALL[name](np.ascontiguousarray(changed), unit, 3)
    back = np.empty_like(other.labels_)
    back[order] = other.labels_
    found = {frozenset(np.flatnonzero(back == k).tolist()) for k in range(back.max() + 1)}
    assert found == partition(one.labels_)
    if "dbscan" not in name:
        assert np.array_equal(one.probabilities_[order], other.probabilities_)
        rates = [np.sort(model.condensed_tree_["lambda_val"]) for model in (one, other)]
        assert np.array_equal(rates[0], rates[1] * unit)


@pytest.mark.parametrize(
    "call",
    [
        lambda p: HDBSCAN(5, min_samples=300).fit(p),
        lambda p: HDBSCAN(5, min_samples=2).fit(p),
        lambda p: DBSCAN(0.02, min_samples=2000).fit(p),
        lambda p: single_linkage(p).linkage,
    ],
    ids=["cores", "tree", "density", "linkage"],
)
def test_a_signal_is_heard(call: Callable[[Floats], Any]) -> None:
    points = np.random.default_rng(0).random((1_500_000, 2))

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    # Not SIGINT, which workers of pytest ignore.
    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, 0.15)
    try:
        with pytest.raises(KeyboardInterrupt):
            call(points)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="limits of memory")
@pytest.mark.parametrize("call", ["HDBSCAN(5)", "DBSCAN(0.01)"])
def test_refused_memory_is_an_error(call: str) -> None:
    program = (
        "import resource, numpy as np\n"
        "from delone.cluster import DBSCAN, HDBSCAN\n"
        "points = np.random.default_rng(0).random((2_000_000, 2))\n"
        f"{call}.set_params(workers=1).fit(points[:1000])\n"
        "held = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "limit = held + 60_000_000\n"
        "resource.setrlimit(resource.RLIMIT_AS, (limit, limit))\n"
        "try:\n"
        f"    {call}.set_params(workers=1).fit(points)\n"
        "except MemoryError:\n"
        "    print('refused')\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], check=False, capture_output=True, text=True
    )
    assert done.stdout == "refused\n", done.stderr
