"""What reports say about one fault and about several, in the words of their class."""

from __future__ import annotations

import numpy as np
import pytest

from delone.constrained.validation import ConstrainedReport
from delone.dynamic.validation import DynamicReport
from delone.hull import HullReport
from delone.refine.validation import MeshValidation
from delone.regular_validation import PeriodicReport, RegularHigherReport, RegularSpaceReport
from delone.solids.tetmesh.validation import TetMeshReport
from delone.sphere.validation import ConstrainedSphereReport
from delone.validation import HigherReport, SpaceReport, ValidationReport


@pytest.mark.parametrize(
    ("report", "field", "one", "many"),
    [
        (ValidationReport, "ties", "pair of cocircular triangles is", "pairs of cocircular"),
        (SpaceReport, "hull", "boundary face is not", "boundary faces are not"),
        (SpaceReport, "facets", "oriented face is used", "oriented faces are used"),
        (HigherReport, "neighbors", "simplex has wrong", "simplices have wrong"),
        (RegularSpaceReport, "orientation", "tetrahedron is not positively", "tetrahedra are not"),
        (RegularSpaceReport, "ties", "pair of simplices on a tie", "pairs of simplices on ties"),
        (RegularHigherReport, "missing", "point is outside all simplices", "points are outside"),
        (PeriodicReport, "hull", "boundary edge is not on the boundary of", "boundary edges are"),
        (ConstrainedReport, "uncovered", "row of segments is not covered", "rows of segments are"),
        (DynamicReport, "uncovered", "segment is not covered", "segments are not covered"),
        (ConstrainedSphereReport, "bent", "vertex bends a row", "vertices bend rows"),
        (ConstrainedSphereReport, "repeats", "duplicate has a different", "duplicates have"),
        (MeshValidation, "hull", "boundary edge is not on a segment", "boundary edges are not on"),
        (TetMeshReport, "neighbors", "tetrahedron has wrong", "tetrahedra have wrong"),
        (TetMeshReport, "lost", "input face is not", "input faces are not"),
        (HullReport, "neighbors", "simplex has wrong", "simplices have wrong"),
    ],
)
def test_a_field_has_the_words_of_its_class(
    report: type[ValidationReport], field: str, one: str, many: str
) -> None:
    empty = getattr(report(), field)
    for count, sentence in ((1, one), (2, many)):
        found = report(**{field: np.ones((count, *empty.shape[1:]), dtype=int)})
        assert not found
        [_, line] = str(found).split("\n")
        assert line.startswith(f"  {field}: {count} {sentence}")


def test_fields_of_a_base_come_first() -> None:
    """Which readers of reports, such as those of JSON, may rely on."""
    names = list(ConstrainedSphereReport().__dict__)
    assert names[:3] == ["orientation", "edges", "neighbors"]
    assert names[-4:] == ["flags", "absent", "uncovered", "bent"]
