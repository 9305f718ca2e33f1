"""A signal that arrives when the core has finished an edit, and nothing else has happened."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Dynamic, datasets

if TYPE_CHECKING:
    from collections.abc import Callable


EDITS: dict[str, Callable[[Dynamic, Any], Any]] = {
    "insert": lambda live, _: live.insert([(0.5, 0.25), (0.125, 0.75)]),
    "remove": lambda live, _: live.remove(live.handles[4:6]),
    "remove_with_segments": lambda live, _: live.remove([2], segments="remove"),
    "relocate": lambda live, _: live.move([5], [(0.9, 0.9)]),
    "insert_segments": lambda live, _: live.insert_segments([(0, 1)]),
    "remove_segments": lambda live, _: live.remove_segments([0]),
    "restore": lambda live, other: live.restore(other),
}


@pytest.mark.parametrize("name", EDITS)
def test_a_signal_after_the_core_has_finished_leaves_no_old_arrays(name: str) -> None:
    live = Dynamic(datasets.uniform(30, seed=4), [(2, 3)])
    other = live.snapshot()
    if name == "restore":
        live.insert([(0.3, 0.3)])
    before = live.points.copy(), live.segment_handles.copy()

    def interrupt(_frame: Any, event: str, called: Any) -> None:
        # As a signal that arrives between the core and the next line of Python.
        if event == "c_return" and called.__name__ == name:
            raise KeyboardInterrupt

    sys.setprofile(interrupt)
    try:
        with pytest.raises(KeyboardInterrupt):
            EDITS[name](live, other)
    finally:
        sys.setprofile(None)
    fresh = live.__copy__()
    assert len(live) == len(live.points) and live.nsimplex == len(live.simplices)
    assert np.array_equal(live.points, fresh.points)
    assert np.array_equal(live.simplices, fresh.simplices)
    assert np.array_equal(live.segments, fresh.segments)
    changed = not np.array_equal(live.points, before[0])
    assert changed or not np.array_equal(live.segment_handles, before[1])
    if name == "insert":
        assert live.points[-2:].tolist() == [[0.5, 0.25], [0.125, 0.75]]
