from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import ConstrainedDelaunay, errors

SQUARE = [(0, 0), (6, 0), (6, 6), (0, 6)]


def triangles(mesh: ConstrainedDelaunay) -> set[frozenset[tuple[float, float]]]:
    return {frozenset(map(tuple, t)) for t in mesh.points[mesh.simplices].tolist()}


def same(one: ConstrainedDelaunay, other: ConstrainedDelaunay) -> None:
    for name in ("points", "simplices", "neighbors", "constrained", "segments", "input_segments"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


class TestChanges:
    def test_a_block_without_changes_gives_the_same(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2)])
        with mesh.edit() as edit:
            pass
        same(edit.result, mesh)
        assert edit.result is not mesh

    def test_the_mesh_stays_as_it_is(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2)])
        with mesh.edit() as edit:
            edit.insert_points([(1, 2)])
            edit.remove_segment(0)
        same(mesh, ConstrainedDelaunay(SQUARE, [(0, 2)]))
        assert edit.result.npoints == 5

    def test_inserted_points_can_be_used_at_once(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [])
        with mesh.edit() as edit:
            a, b = edit.insert_points([(1, 1), (5, 4)])
            rows = edit.insert_segments([(a, b), (0, a)])
        assert rows.tolist() == [0, 1]
        same(edit.result, ConstrainedDelaunay([*SQUARE, (1, 1), (5, 4)], [(4, 5), (0, 4)]))

    def test_rows_tell_where_everything_went(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (3, 2), (1, 2)], [(0, 2), (5, 3), (0, 1)])
        with mesh.edit() as edit:
            edit.insert_points([(4, 1)])
            edit.remove_points([4])
            edit.insert_segment(5, 6)
            edit.remove_segments([0])
        assert edit.rows.points.tolist() == [0, 1, 2, 3, -1, 4, 5]
        assert edit.rows.segments.tolist() == [-1, 0, 1, 2]
        expected = ConstrainedDelaunay([*SQUARE, (1, 2), (4, 1)], [(4, 3), (0, 1), (4, 5)])
        same(edit.result, expected)

    def test_the_order_of_changes_does_not_matter(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (3, 2)], [(0, 4), (1, 3)])
        with mesh.edit() as one:
            one.remove_points(4)
            one.remove_segment(0)
        with mesh.edit() as other:
            other.remove_segment(0)
            other.remove_points(4)
        same(one.result, other.result)

    def test_segments_go_by_their_ends_in_either_direction(self) -> None:
        points = [*SQUARE, (0, 0)]
        mesh = ConstrainedDelaunay(points, [(0, 2), (2, 4), (1, 2)])
        with mesh.edit() as edit:
            edit.remove_segment(2, 0)
        assert edit.result.input_segments.tolist() == [[1, 2]]
        with mesh.edit() as edit:
            edit.remove_segments([(4, 2), (2, 1)])
        assert edit.result.input_segments.shape == (0, 2)

    def test_an_inserted_segment_may_be_removed_again(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [])
        with mesh.edit() as edit:
            edit.insert_segment(0, 2)
            edit.remove_segment(0, 2)
            edit.insert_segment(1, 3)
        assert edit.result.input_segments.tolist() == [[1, 3]]

    def test_a_duplicate_keeps_the_vertex(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (3, 2), (3, 2)], [(0, 5)])
        with mesh.edit() as edit:
            edit.remove_points([4])
        assert edit.result.npoints == 5
        assert edit.result.input_segments.tolist() == [[0, 4]]
        assert edit.result.report

    def test_crossings_come_and_go(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2), (1, 3)], crossing="split")
        with mesh.edit() as edit:
            (row,) = edit.insert_points([(5, 2)])
            edit.remove_segment(1)
        assert row == 5  # row 4 is the crossing
        assert edit.rows.points.tolist() == [0, 1, 2, 3, -1, 4]
        assert edit.result.nadded == 0
        assert edit.result.npoints == 5

    def test_options_and_seeds_stay(self) -> None:
        inner = [(2, 2), (4, 2), (4, 4), (2, 4)]
        rings = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
        mesh = ConstrainedDelaunay(
            [*SQUARE, *inner], rings, holes=[(3, 3)], regions=[(1, 1, 9)], boundary="outline"
        )
        with mesh.edit() as edit:
            edit.insert_points([(1, 3), (3, 3.5), (8, 8)])
        assert edit.result.areas.sum() == 32
        assert set(edit.result.region.tolist()) == {9}

    @given(
        st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=1, max_size=8),
        st.data(),
    )
    def test_removal_is_the_inverse_of_insertion(self, points: Any, data: Any) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (2, 3)], [(0, 2), (4, 1)], crossing="split")
        with mesh.edit() as there:
            rows = there.insert_points(points)
            ends = st.sampled_from([0, 1, 2, 3, 4, *rows.tolist()])
            segments = there.insert_segments(data.draw(st.lists(st.tuples(ends, ends), max_size=5)))
        assert there.result.validate()
        with there.result.edit() as back:
            back.remove_points(there.rows.points[rows])
            back.remove_segments(there.rows.segments[segments])
        same(back.result, mesh)


class TestRefusals:
    def test_a_point_in_use_stays_and_the_rows_are_named(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (3, 2)], [(0, 1), (4, 2)])
        edit = mesh.edit()
        with pytest.raises(errors.InputError, match=r"1 segment .*row 1 \(4-2\)"), edit:
            edit.remove_points([4])
        with pytest.raises(errors.DeloneError, match="no result"):
            edit.result  # noqa: B018

    def test_added_vertices_are_no_input(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2), (1, 3)], crossing="split")
        edit = mesh.edit()
        for change in (
            lambda: edit.remove_points([4]),
            lambda: edit.insert_segment(0, 4),
        ):
            with pytest.raises(errors.InputError, match="points 4 were added"):
                change()

    @pytest.mark.parametrize(
        ("change", "error", "match"),
        [
            (lambda e: e.remove_points([9]), errors.InputError, "rows of points.*0 to 3, got 9"),
            (lambda e: e.remove_points([-1]), errors.InputError, "-1"),
            (lambda e: e.remove_points([0.0]), errors.DtypeError, "float64"),
            (lambda e: e.remove_points([True]), errors.DtypeError, "bool"),
            (lambda e: e.remove_points([[[0]]]), errors.ShapeError, "shape"),
            (lambda e: e.remove_segments([1]), errors.InputError, "rows of segments"),
            (lambda e: e.remove_segment(0, 1), errors.InputError, "no segment joins.*0-1"),
            (lambda e: e.remove_segment(1.5), errors.DtypeError, "integer"),
            (lambda e: e.insert_segment(0, 4), errors.InputError, "outside 0 to 3"),
            (lambda e: e.insert_segment(True, 0), errors.DtypeError, "integer"),
            (lambda e: e.insert_segments([(0.0, 1.0)]), errors.DtypeError, "integers"),
            (lambda e: e.insert_points([(np.nan, 0)]), errors.NonFiniteError, "NaN"),
            (lambda e: e.insert_points([(1, 2, 3)]), errors.ShapeError, "shape"),
        ],
    )
    def test_bad_changes_are_refused_at_once(self, change: Any, error: Any, match: str) -> None:
        with ConstrainedDelaunay(SQUARE, [(0, 2)]).edit() as edit:
            with pytest.raises(error, match=match):
                change(edit)
            edit.insert_points([(2, 1)])
        assert edit.result.npoints == 5

    def test_an_error_in_the_block_leaves_no_result(self) -> None:
        with pytest.raises(KeyError), ConstrainedDelaunay(SQUARE, []).edit() as edit:
            raise KeyError
        with pytest.raises(errors.DeloneError, match="no result"):
            edit.result  # noqa: B018
        with pytest.raises(errors.DeloneError, match="no rows"):
            edit.rows  # noqa: B018

    def test_a_block_ends_once(self) -> None:
        edit = ConstrainedDelaunay(SQUARE, []).edit()
        with edit:
            pass
        with pytest.raises(errors.DeloneError, match="has ended"):
            edit.insert_points([(1, 1)])
        with pytest.raises(errors.DeloneError, match="has ended"), edit:
            pass

    def test_crossings_of_the_result_are_refused(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2)])
        with pytest.raises(errors.CrossingSegmentsError), mesh.edit() as edit:
            edit.insert_segment(1, 3)
