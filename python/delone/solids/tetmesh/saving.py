"""The arrays of a file that hold the report of a TetMesh; what it does not have is empty."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.solids.tetmesh.recovery import RECOVERY_COUNTS, RECOVERY_ROWS, RecoveryReport
from delone.solids.tetmesh.refinement import REFINEMENT_COUNTS, REFINEMENT_FLOATS, RefinementReport
from delone.solids.tetmesh.report import CAUSES, COUNTS, ImproveReport

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Report = ImproveReport | RecoveryReport | RefinementReport
    Arrays = dict[str, NDArray[Any]]

__all__ = ["of_report", "recovery_of", "report_of"]

_ANGLES = ("min_angle", "smallest_before", "smallest_after", "largest_before", "largest_after")
_HISTOGRAMS = ("bounds", "before", "after", "weights", "below", "wall_edges")
_NO_COUNTS = np.empty(0, dtype=np.int64)
_NO_NUMBERS = np.empty(0)
# What a file contains for a missing report.
_UNIMPROVED: dict[str, NDArray[Any]] = {
    **dict.fromkeys(("angles", "surface_distance", "bounds", "weights"), _NO_NUMBERS),
    **dict.fromkeys(("counts", "before", "after", "below", "cause"), _NO_COUNTS),
    "wall_edges": np.empty((0, 2), dtype=np.int64),
}
_UNRECOVERED: dict[str, NDArray[Any]] = {
    "recovery": _NO_COUNTS,
    **dict.fromkeys(RECOVERY_ROWS, _NO_COUNTS),
    "duplicate_points": np.empty((0, 2), dtype=np.int64),
    "recut": np.empty((0, 3), dtype=np.int64),
    "recut_source": np.empty((0, 2), dtype=np.int64),
    "imprint_distance": _NO_NUMBERS,
}
_UNREFINED: dict[str, NDArray[Any]] = {
    "refinement": _NO_COUNTS,
    "refinement_bounds": _NO_NUMBERS,
    "too_large": _NO_COUNTS,
    "above_ratio": _NO_COUNTS,
}


def recovery_of(report: Report) -> RecoveryReport | None:
    """Return what is known about the recovery of faces, unless these were divided later."""
    if isinstance(report, RefinementReport):
        divided = report.on_segments or report.on_facets
        return None if divided else report.recovery
    return report if isinstance(report, RecoveryReport) else None


def of_report(report: Report) -> Arrays:
    """Return the arrays that hold a report."""
    if isinstance(report, RefinementReport):
        return _of_refinement(report)
    if isinstance(report, RecoveryReport):
        return _UNREFINED | _UNIMPROVED | _of_recovery(report)
    return _UNREFINED | _UNRECOVERED | _of_improvement(report)


def report_of(arrays: Arrays) -> Report:
    """Return the report that arrays hold."""
    if len(arrays["refinement"]):
        counts: dict[str, Any] = dict(
            zip(REFINEMENT_COUNTS, arrays["refinement"].tolist(), strict=True)
        )
        counts["exhausted"] = bool(counts["exhausted"])
        bounds = dict(zip(REFINEMENT_FLOATS, arrays["refinement_bounds"].tolist(), strict=True))
        return RefinementReport(
            **counts,
            **bounds,
            too_large=arrays["too_large"],
            above_ratio=arrays["above_ratio"],
            improvement=_improvement_of(arrays) if len(arrays["counts"]) else None,
            recovery=_recovery_of(arrays) if len(arrays["recovery"]) else None,
        )
    return _recovery_of(arrays) if len(arrays["recovery"]) else _improvement_of(arrays)


def _of_refinement(report: RefinementReport) -> Arrays:
    counts = [int(getattr(report, name)) for name in REFINEMENT_COUNTS]
    better, recovery = report.improvement, report.recovery
    return (
        (_UNIMPROVED if better is None else _of_improvement(better))
        | (_UNRECOVERED if recovery is None else _of_recovery(recovery))
        | {
            "refinement": np.array(counts, dtype=np.int64),
            "refinement_bounds": np.array([getattr(report, name) for name in REFINEMENT_FLOATS]),
            "too_large": report.too_large,
            "above_ratio": report.above_ratio,
        }
    )


def _of_improvement(report: ImproveReport) -> Arrays:
    return {
        "angles": np.array([getattr(report, name) for name in _ANGLES]),
        "surface_distance": np.array([report.surface_distance]),
        "counts": np.array([getattr(report, name) for name in COUNTS], dtype=np.int64),
        "cause": np.array([CAUSES.index(cause) for cause in report.cause], dtype=np.int64),
        **{name: getattr(report, name) for name in _HISTOGRAMS},
    }


def _improvement_of(arrays: Arrays) -> ImproveReport:
    counts: dict[str, Any] = dict(zip(COUNTS, arrays["counts"].tolist(), strict=True))
    counts["exhausted"] = bool(counts["exhausted"])
    angles: dict[str, Any] = dict(zip(_ANGLES, arrays["angles"].tolist(), strict=True))
    histograms: dict[str, Any] = {name: arrays[name] for name in _HISTOGRAMS}
    cause = np.array(CAUSES)[arrays["cause"]]
    distance = float(arrays["surface_distance"][0])
    return ImproveReport(**angles, **counts, **histograms, cause=cause, surface_distance=distance)


def _of_recovery(report: RecoveryReport) -> Arrays:
    counts = np.array([getattr(report, name) for name in RECOVERY_COUNTS], dtype=np.int64)
    rows = {name: getattr(report, name) for name in RECOVERY_ROWS}
    return {"recovery": counts, "imprint_distance": np.array([report.imprint_distance]), **rows}


def _recovery_of(arrays: Arrays) -> RecoveryReport:
    counts: dict[str, Any] = dict(zip(RECOVERY_COUNTS, arrays["recovery"].tolist(), strict=True))
    rows: dict[str, Any] = {name: arrays[name] for name in RECOVERY_ROWS}
    distance = float(arrays["imprint_distance"][0])
    return RecoveryReport(**counts, **rows, imprint_distance=distance)
