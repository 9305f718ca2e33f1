"""Corners of the interface where an answer was once wrong, each with its reason."""

from __future__ import annotations

import numpy as np
import pytest

import delone
from delone import BudgetExceededError, ConstrainedDelaunay
from delone.testing import assert_constrained_delaunay


@pytest.mark.parametrize("segments", [[], [(0, 0)]])
def test_a_conforming_mesh_without_subsegments_has_a_report(segments: list) -> None:
    mesh = ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], segments, conforming=True)
    assert len(mesh.report.overlaps) == 0


@pytest.mark.parametrize("segments", [[], [(0, 0)]])
def test_a_conforming_mesh_without_subsegments_can_be_loaded(segments: list, tmp_path) -> None:
    """Its sources once began twice, so that no file of it could be read."""
    mesh = ConstrainedDelaunay([(0, 0), (1, 0), (0, 1)], segments, conforming=True)
    assert mesh.segment_source[0].tolist() == [0]
    mesh.save(tmp_path / "mesh.npz")
    assert ConstrainedDelaunay.load(tmp_path / "mesh.npz").validate()


def test_a_cut_that_is_rounded_to_a_point_is_reported() -> None:
    """The middle of the row is rounded to the other point, which is not exactly on it."""
    points = [(500000.004, 5400000.002), (500000.003, 5400000.001), (500000.002, 5400000.0)]
    mesh = ConstrainedDelaunay(points, [(0, 2)], conforming=True)
    assert mesh.segments.tolist() == [[0, 1], [1, 2]]
    assert mesh.report.steiner.tolist() == [[0, 1]]
    assert mesh.validate()


@pytest.mark.parametrize("lines", [3, 40])
def test_pairs_that_cross_in_one_point_are_one_vertex(lines: int) -> None:
    a = np.arange(lines) + 1.0
    points = np.concatenate((np.c_[a, lines + 1 - a], np.c_[-a, a - lines - 1]))
    segments = np.c_[np.arange(lines), np.arange(lines) + lines]
    mesh = ConstrainedDelaunay(points, segments, crossing="split", max_points=1)
    assert mesh.nadded == 1
    assert len(mesh.report.crossings) == lines * (lines - 1) // 2
    with pytest.raises(BudgetExceededError) as error:
        ConstrainedDelaunay(points, segments, crossing="split", max_points=0)
    assert (error.value.limit, error.value.found) == (0, 1)


def test_subsegments_of_a_nearly_vertical_row_follow_each_other() -> None:
    """Neighbours on the row share an abscissa, and its ordinates rise while its abscissas fall."""
    points, segments = [(0.1 + 0.2, 0.0), (0.3, 1.0)], [(0, 1)]
    for i in range(6):
        points += [(0.0, i / 6 + 0.05), (1.0, i / 6 + 0.06)]
        segments.append((len(points) - 2, len(points) - 1))
    mesh = ConstrainedDelaunay(points, segments, crossing="split")
    assert_constrained_delaunay(mesh, segments, split=True)
    row = mesh.segments[:7]
    assert row[0, 0] == 0
    assert row[-1, 1] == 1
    assert (row[1:, 0] == row[:-1, 1]).all()


def test_a_way_along_a_hole_meets_what_is_beside_it() -> None:
    points = [(0, 0), (6, 0), (6, 6), (0, 6), (2, 2), (4, 2), (4, 4), (2, 4)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    mesh = ConstrainedDelaunay(points, segments, holes=[(3, 3)])
    right, left = mesh.triangles_along((2, 2), (4, 2)), mesh.triangles_along((4, 2), (2, 2))
    assert right.tolist() == left.tolist()
    assert len(right) == 1
    assert mesh.triangles_along((2, 3), (2, 3)).tolist() == [mesh.find_simplex((2, 3))]
    assert mesh.triangles_along((3, 3), (3, 3)).tolist() == []


def test_missing_members_of_a_collection_are_passed_over() -> None:
    triangle = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (0, 1)]]}
    collection = {"type": "GeometryCollection", "geometries": [None, triangle]}
    assert len(delone.from_geometry(collection).simplices) == 1


def test_too_many_crossings_end_before_memory_does() -> None:
    rng = np.random.default_rng(0)
    points = rng.random((8000, 2))
    segments = np.arange(8000).reshape(-1, 2)
    for crossing in ("raise", "split"):
        with pytest.raises(BudgetExceededError, match="crossing"):
            ConstrainedDelaunay(points, segments, crossing=crossing, max_points=10)
