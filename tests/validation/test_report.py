from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, fields

import numpy as np
import pytest

from delone.testing import assert_delaunay
from delone.validation import ValidationReport, validate

CULPRITS = {
    "orientation": [4],
    "edges": [[1, 2], [2, 1]],
    "neighbors": [3, 5, 6, 7, 8, 9],
    "hull": [[0, 9]],
    "missing": [7],
    "repeats": [8, 9],
    "delaunay": [[10, 11]],
    "ties": [[12, 13]],
    "count": [20, 19],
}


def test_culprits_cover_all_fields() -> None:
    assert set(CULPRITS) == {each.name for each in fields(ValidationReport)}


def test_nothing_found_is_true() -> None:
    report = ValidationReport()
    assert report and report.ok
    assert report.edges.shape == (0, 2) and report.missing.shape == (0,)
    assert str(report) == "a canonical Delaunay triangulation"


@pytest.mark.parametrize("name", CULPRITS)
def test_any_culprit_is_false_and_is_named(name: str) -> None:
    report = ValidationReport(**{name: np.array(CULPRITS[name], dtype=np.int32)})
    assert not report and not report.ok
    lines = str(report).splitlines()
    assert len(lines) == 2 and lines[1].strip().startswith(f"{name}:")
    np.testing.assert_array_equal(getattr(report, name), CULPRITS[name])


def test_text_shows_the_first_few() -> None:
    text = str(ValidationReport(**{k: np.array(v) for k, v in CULPRITS.items()}))
    assert "6 triangles have wrong neighbors: 3, 5, 6, 7, 8, ..." in text
    assert "2 directed edges are used more than once: 1-2, 2-1" in text
    assert "1 pair of triangles is not locally Delaunay: 10-11" in text
    assert "19 triangles, 20 expected" in text


def test_is_immutable_and_pickles() -> None:
    given = np.array([1, 2])
    report = ValidationReport(missing=given)
    given[0] = 9
    assert report.missing.tolist() == [1, 2]
    with pytest.raises(ValueError, match="read-only"):
        report.missing[0] = 3
    with pytest.raises(FrozenInstanceError):
        report.missing = given  # type: ignore[misc]
    assert pickle.loads(pickle.dumps(report)).missing.tolist() == [1, 2]


def test_of_equal_points_the_first_is_the_vertex() -> None:
    points = [(0, 0), (1, 0), (0, 1), (-0.0, 0)]
    assert validate(points, [(0, 1, 2)])
    assert_delaunay(points, [(0, 1, 2)])
    report = validate(points, [(3, 1, 2)])
    assert not report
    assert report.repeats.tolist() == [3] and report.missing.size == 0
    with pytest.raises(AssertionError, match="an earlier row is equal"):
        assert_delaunay(points, [(3, 1, 2)])


@pytest.mark.parametrize("d", [2, 3, 4])
def test_points_that_are_no_vertices_are_ascending(d: int) -> None:
    corners = np.vstack((np.zeros(d), 4 * np.eye(d)))
    inside = np.random.default_rng(d).random((40, d))
    report = validate(np.vstack((corners, inside)), [range(d + 1)])
    assert report.missing.tolist() == list(range(d + 1, d + 41))
