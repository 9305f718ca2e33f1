"""What a state of a live triangulation consists of, for pickles and files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from delone import _core
from delone.errors import FileFormatError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from delone._base.types import Floats

    Handles = NDArray[np.int64]

__all__ = ["State", "require_few_handles"]

# The number of handles that a file or a pickle may have, whatever its size, and for each point in
# it. Each takes 12 bytes.
_ALWAYS, _PER_POINT = 10_000_000, 64


class State(NamedTuple):
    """Points and segments with their handles: all that the core needs to restore the state."""

    points: Floats
    handles: Handles
    total: int  # the next handle of a point
    split: bool  # whether crossings of segments are split
    segments: Handles  # handles of segments, ascending
    ends: Handles  # (s, 2), handles of points
    segments_total: int  # the next handle of a segment
    added: Handles  # handles of the points where segments cross

    @classmethod
    def of(cls, core: _core.Live) -> State:
        """Return the state of a core that is not edited in the meantime."""
        handles, points = core.points()
        none = np.empty(0, dtype=np.int64)
        total = core.counts()[3]
        if core.ndim != 2:
            return cls(points, handles, total, False, none, none.reshape(0, 2), 0, none)
        own, (_, split) = core.segments(), core.constraints()
        return cls(points, handles, total, split, own.handles, own.ends, own.total, own.added)

    @classmethod
    def unpickled(cls, saved: Any) -> State:
        """Return the state in a pickle, checked like that of a file."""
        from delone._tiling.archive.checks import ContradictionError, check_live

        try:
            state = _of_kinds(saved)
            check_live(**state.arrays())
        except ContradictionError as error:
            raise InputError(f"the pickle is not one of a Dynamic, or damaged: {error}") from error
        return state.pickled()

    def pickled(self) -> State:
        """Return the state; reject one that does not fit into a pickle."""
        found, limit = self.total_of_handles(), self.most_handles()
        if found > limit:
            raise InputError(
                f"{found:,} handles have been assigned, for {len(self.points):,} points, and a "
                f"pickle accepts at most {limit:,}, since each needs 12 bytes: use save(path), and "
                f"load(path, max_handles={found})"
            )
        return self

    def total_of_handles(self) -> int:
        """Return how many handles of points or segments have been assigned, whichever is more."""
        return max(self.total, self.segments_total)

    def most_handles(self) -> int:
        """Return how many handles are plausible, given the points and segments."""
        return max(_ALWAYS, _PER_POINT * max(len(self.points), len(self.segments)))

    def opened(self, workers: int) -> _core.Live:
        """Return a core in this state."""
        # Crossings are restored with the segments, at the same positions and with the same handles.
        crossed = np.isin(self.handles, self.added)
        kept = ~crossed
        core = _core.Live(self.points[kept], self.handles[kept], self.total, workers)
        if core.ndim == 2:
            core.split_crossings(self.split)
            if len(self.segments) or self.segments_total:
                known, places = (self.segments, self.ends), (self.added, self.points[crossed])
                core.adopt_segments(known, self.segments_total, places, workers)
                if not np.array_equal(core.points()[0], self.handles):
                    raise InputError("its crossings are not those of its segments")
        return core

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return the contents of a file."""
        numbers = [self.total, self.split, self.segments_total]
        return {
            "points": self.points,
            "handles": self.handles,
            "numbers": np.array(numbers, dtype=np.int64),
            "segments": self.segments,
            "ends": self.ends,
            "added": self.added,
        }

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> State:
        """Return the state in a file, whose arrays have been checked."""
        total, split, segments_total = arrays["numbers"].tolist()
        return cls(
            arrays["points"],
            arrays["handles"],
            total,
            bool(split),
            arrays["segments"],
            arrays["ends"],
            segments_total,
            arrays["added"],
        )


def _of_kinds(saved: Any) -> State:
    """Return the parts of a pickle, each of the kind given in `State`."""
    from delone._tiling.archive.checks import require

    require(isinstance(saved, tuple) and len(saved) == len(State._fields), "a part is missing")
    state = State(*saved)
    for name, part, columns in (
        ("points", state.points, (2, 3)),
        ("handles", state.handles, None),
        ("segments", state.segments, None),
        ("ends", state.ends, (2,)),
        ("added", state.added, None),
    ):
        wanted = np.dtype(np.float64 if name == "points" else np.int64)
        right = isinstance(part, np.ndarray) and part.dtype == wanted
        if right and columns is not None:
            right = part.ndim == 2 and part.shape[1] in columns
        elif right:
            right = part.ndim == 1
        require(right, f"{name} is not an array of {wanted} of the right shape")
    for name, number in (("total", state.total), ("segments_total", state.segments_total)):
        require(type(number) is int and 0 <= number < 2**32 - 1, f"{name} is not a count")
    require(isinstance(state.split, bool), "split is not a flag")
    # The core reads arrays in C order.
    parts: list[Any] = [np.ascontiguousarray(x) if isinstance(x, np.ndarray) else x for x in state]
    return State(*parts)


def require_few_handles(path: Any, state: State, most: int | None) -> None:
    """Reject a file whose handles would take much more memory than its points."""
    limit = state.most_handles() if most is None else most
    found = state.total_of_handles()
    if found > limit:
        raise FileFormatError(
            f"{path} says that {found:,} handles have been assigned, for {len(state.points):,} "
            f"points: at most {limit:,} are accepted, since each needs 12 bytes; "
            f"max_handles={found} accepts them"
        )
