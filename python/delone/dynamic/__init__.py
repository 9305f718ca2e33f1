"""Live triangulations: points are inserted, removed and moved, and each state is canonical."""

from delone.dynamic.dynamic import Dynamic
from delone.dynamic.results import Changes, DynamicArrays, Snapshot
from delone.dynamic.validation import DynamicReport

__all__ = ["Changes", "Dynamic", "DynamicArrays", "DynamicReport", "Snapshot"]
