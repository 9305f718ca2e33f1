"""Live triangulations: points are inserted, removed and moved, and each state is canonical."""

from delone.dynamic.dynamic import Dynamic
from delone.dynamic.results import Changes, Snapshot

__all__ = ["Changes", "Dynamic", "Snapshot"]
