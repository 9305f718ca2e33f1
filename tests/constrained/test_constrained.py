from __future__ import annotations

import copy
import itertools
import pickle
import threading
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import delone
from delone import ConstrainedDelaunay, Delaunay, _core
from delone.constrained import validation
from delone.errors import ShapeError

OUTER = [(0, 0), (6, 0), (6, 6), (0, 6)]
INNER = [(2, 2), (4, 2), (4, 4), (2, 4)]
RINGS = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
FRAME = (OUTER + INNER, RINGS)


@pytest.fixture
def frame() -> ConstrainedDelaunay:
    """A square with a square hole."""
    return ConstrainedDelaunay(*FRAME, holes=[(3, 3)])


def coordinates_of(mesh: Any) -> set[frozenset[tuple[float, float]]]:
    """The triangles as sets of coordinates, whatever the order of rows."""
    return {frozenset(map(tuple, t)) for t in mesh.points[mesh.simplices].tolist()}


# Small lattices have crossings at lattice points, overlaps and ties everywhere.
POINTS = st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=4, max_size=12)


@st.composite
def inputs(draw: st.DrawFn) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    points = [(0, 0), (5, 0), (0, 5), *draw(POINTS)]
    row = st.integers(0, len(points) - 1)
    return points, draw(st.lists(st.tuples(row, row), max_size=6))


class TestTriangles:
    def test_without_segments_it_is_delaunay(self) -> None:
        points = delone.datasets.integer_lattice(60)
        mesh, plain = ConstrainedDelaunay(points, []), Delaunay(points)
        assert coordinates_of(mesh) == coordinates_of(plain)
        assert mesh.validate()
        assert mesh.segments.shape == (0, 2)
        assert not mesh.constrained.any()
        assert not mesh.region.any()

    def test_a_segment_is_an_edge_that_delaunay_does_not_have(self) -> None:
        rhomb = [(0, 0), (3, -1), (6, 0), (3, 1)]
        assert [0, 2] not in Delaunay(rhomb).edges.tolist()
        mesh = ConstrainedDelaunay(rhomb, [(2, 0)])
        assert [0, 2] in mesh.edges.tolist()
        assert mesh.segments.tolist() == [[2, 0]]
        assert mesh.segment_forward.tolist() == [True]
        assert mesh.constrained.sum() == 2
        assert mesh.validate()

    def test_flags_are_those_of_subsegments(self, frame: ConstrainedDelaunay) -> None:
        t, k = np.nonzero(frame.constrained)
        ends = frame.simplices[t, (k + 1) % 3], frame.simplices[t, (k + 2) % 3]
        flagged = np.unique(np.sort(np.column_stack(ends), axis=1), axis=0)
        assert flagged.tolist() == sorted(map(sorted, frame.segments.tolist()))

    @given(inputs())
    def test_split_input_of_any_kind_is_valid(self, given_input: Any) -> None:
        points, segments = given_input
        mesh = ConstrainedDelaunay(points, segments, crossing="split")
        assert mesh.validate()
        assert mesh.points[: len(points)].tolist() == [list(map(float, p)) for p in points]
        assert mesh.nadded == mesh.npoints - len(points)
        area = sum(map(Fraction, mesh.areas.tolist()))
        assert area == sum(map(Fraction, Delaunay(points).areas.tolist())) or mesh.nadded

    @given(inputs(), st.randoms(use_true_random=False))
    def test_the_order_of_rows_does_not_matter(self, given_input: Any, random: Any) -> None:
        points, segments = given_input
        order = list(range(len(points)))
        random.shuffle(order)
        place = {old: new for new, old in enumerate(order)}
        shuffled = [(place[b], place[a]) for a, b in segments]
        random.shuffle(shuffled)
        mesh = ConstrainedDelaunay(points, segments, crossing="split")
        other = ConstrainedDelaunay([points[i] for i in order], shuffled, crossing="split")
        assert coordinates_of(mesh) == coordinates_of(other)

        def regions(m: ConstrainedDelaunay) -> dict[frozenset[Any], int]:
            corners = m.points[m.simplices].tolist()
            return {
                frozenset(map(tuple, t)): label
                for t, label in zip(corners, m.region.tolist(), strict=True)
            }

        assert regions(mesh) == regions(other)


class TestHolesAndOutline:
    def test_a_hole_is_removed_up_to_its_segments(self, frame: ConstrainedDelaunay) -> None:
        assert frame.areas.sum() == 32
        assert frame.neighbors.shape == frame.simplices.shape
        assert len(frame.boundary) == 8
        assert len(frame.convex_hull) == 4
        assert frame.hull.tolist() == [0, 1, 2, 3]

    def test_neighbours_are_mutual_around_the_hole(self, frame: ConstrainedDelaunay) -> None:
        assert _core.fault(frame.points, frame.simplices, frame.neighbors, 1) is None

    def test_the_outline_leaves_out_bays(self) -> None:
        points = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)]
        ring = [(i, (i + 1) % 5) for i in range(5)]
        hull = ConstrainedDelaunay(points, ring)
        outline = ConstrainedDelaunay(points, ring, boundary="outline")
        assert hull.areas.sum() == 16
        assert outline.areas.sum() == 10
        assert outline.validate()
        assert sorted(map(sorted, outline.boundary.tolist())) == sorted(map(sorted, ring))

    def test_an_open_line_has_no_inside(self) -> None:
        mesh = ConstrainedDelaunay(OUTER, [(0, 1), (1, 2)], boundary="outline")
        assert mesh.nsimplex == 0
        assert mesh.segments.tolist() == [[0, 1], [1, 2]]
        assert mesh.edges.shape == (0, 2)
        assert mesh.areas.shape == mesh.region.shape == (0,)
        assert mesh.vertex_to_simplex.tolist() == [-1] * 4
        assert mesh.find_simplex((1, 1)) == -1
        assert mesh.triangles_along((0, 1), (6, 2)).size == 0
        assert repr(mesh) == "<ConstrainedDelaunay of 4 points and 2 segments: 0 triangles>"

    def test_open_ends_of_an_outline_are_reported(self) -> None:
        points = [(0, 0), (100, 0), (100, 100), (50, 50), (0, 100)]
        sides = [(0, 4), (0, 1), (1, 2), (3, 4)]
        mesh = ConstrainedDelaunay(points, sides, boundary="outline")
        assert mesh.nsimplex == 0
        assert mesh.report.open_ends.tolist() == [2, 3]
        assert not mesh.report
        assert "2 ends of outlines are open, at vertices: 2, 3" in str(mesh.report)
        closed = ConstrainedDelaunay(points, [*sides, (2, 3)], boundary="outline")
        assert closed.report
        assert closed.report.open_ends.size == 0
        # On the hull, an open line is a breakline and leaves out nothing.
        assert ConstrainedDelaunay(points, sides).report

    def test_one_open_outline_beside_a_closed_one_is_reported(self) -> None:
        points = [(0, 0), (4, 0), (0, 4), (10, 0), (14, 0), (10, 4)]
        rings = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5)]
        report = ConstrainedDelaunay(points, rings, boundary="outline").report
        assert report.open_ends.tolist() == [3, 5]

    def test_a_breakline_that_ends_inside_the_outline_is_no_open_end(self) -> None:
        points = [*OUTER, (1, 1), (2, 2)]
        ring = [(i, (i + 1) % 4) for i in range(4)]
        mesh = ConstrainedDelaunay(points, [*ring, (4, 5)], boundary="outline")
        assert mesh.report
        assert mesh.report.open_ends.size == 0

    def test_an_island_in_a_lake_stays(self) -> None:
        island = [(2.5, 2.5), (3.5, 2.5), (3, 3.5)]
        shore = [(8, 9), (9, 10), (10, 8)]
        mesh = ConstrainedDelaunay([*FRAME[0], *island], RINGS + shore, holes=[(2.1, 2.1)])
        assert mesh.areas.sum() == 32 + 0.5
        assert set(mesh.region.tolist()) == {0, 1}


class TestRegions:
    def test_components_are_numbered_by_place(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME)
        inside = mesh.region == 1
        assert mesh.areas[inside].sum() == 4
        assert mesh.areas[~inside].sum() == 32
        assert set(mesh.region.tolist()) == {0, 1}

    def test_labels_come_from_seeds(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, regions=[(3, 3, 17)])
        assert mesh.areas[mesh.region == 17].sum() == 4
        assert mesh.areas[mesh.region == -1].sum() == 32

    def test_seeds_without_labels_give_their_rows(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, regions=[(100, 0), (3, 3), (1, 1)])
        assert mesh.areas[mesh.region == 1].sum() == 4
        assert mesh.areas[mesh.region == 2].sum() == 32
        assert mesh.report.regions_outside.tolist() == [0]

    def test_an_empty_list_of_seeds_is_none(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, regions=[])
        assert mesh.region.tolist() == ConstrainedDelaunay(*FRAME).region.tolist()
        with mesh.edit() as edit:
            edit.insert_points([(1, 1)])
        assert set(edit.result.region.tolist()) == {0, 1}

    def test_the_first_seed_of_an_area_counts(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, regions=[(3, 3, 5), (2.5, 3, 6), (1, 1, 7)])
        assert set(mesh.region.tolist()) == {5, 7}
        assert mesh.report.regions_repeated.tolist() == [[1, 0]]

    def test_regions_agree_with_point_in_polygon(self) -> None:
        random = np.random.default_rng(5)
        angle = np.sort(random.uniform(0, 2 * np.pi, 40))
        ring = random.uniform(2, 5, 40)[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))
        points = np.concatenate((ring, random.uniform(-5, 5, (200, 2))))
        sides = np.column_stack((np.arange(40), (np.arange(40) + 1) % 40))
        mesh = ConstrainedDelaunay(points, sides, regions=[(0, 0, 1)])
        centre = mesh.points[mesh.simplices].mean(axis=1)
        a, b = ring, np.roll(ring, -1, axis=0)
        above = (a[:, 1] > centre[:, None, 1]) != (b[:, 1] > centre[:, None, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            share = (centre[:, None, 1] - a[:, 1]) / (b - a)[:, 1]
            right = a[:, 0] + share * (b - a)[:, 0] > centre[:, None, 0]
        inside = (above & right).sum(axis=1) % 2 == 1
        assert ((mesh.region == 1) == inside).all()


class TestReport:
    def test_plain_input_has_nothing_to_report(self, frame: ConstrainedDelaunay) -> None:
        assert frame.report
        assert frame.report.ok
        assert str(frame.report) == "nothing to report"

    def test_every_kind_is_named_by_row(self) -> None:
        points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (0, 0)]
        segments = [(0, 2), (4, 2), (2, 5), (1, 1), (1, 3), (5, 0)]
        report = ConstrainedDelaunay(points, segments).report
        assert not report
        assert report.duplicates.tolist() == [[5, 0]]
        assert report.zero.tolist() == [3, 5]
        assert report.repeated.tolist() == [[2, 0]]
        assert report.overlaps.tolist() == [[1, 0]]
        assert report.through.tolist() == [[0, 4], [2, 4], [4, 4]]
        assert report.crossings.shape == (0, 3)
        assert "2 rows of segments have zero length: 3, 5" in str(report)

    def test_crossings_are_named_with_their_vertices(self) -> None:
        mesh = ConstrainedDelaunay(OUTER, [(0, 2), (1, 3)], crossing="split")
        assert mesh.report.crossings.tolist() == [[0, 1, 4]]
        assert mesh.points[4].tolist() == [3, 3]
        assert mesh.nadded == 1
        assert len(mesh.segments) == 4
        assert (
            repr(mesh) == "<ConstrainedDelaunay of 5 points (1 added) and 2 segments: 4 triangles>"
        )

    def test_seeds_without_effect_are_named(self) -> None:
        mesh = ConstrainedDelaunay(
            *FRAME,
            holes=[(3, 3), (7, 7), (0, 3), (2, 2), (2, 3)],
            regions=[(1, 1), (3, 3), (2, 3), (-1, 0), (6, 6)],
        )
        report = mesh.report
        assert report.holes_outside.tolist() == [1]
        assert report.holes_on_segment.tolist() == [2, 3, 4]
        assert report.regions_outside.tolist() == [1, 3]
        assert report.regions_on_segment.tolist() == [2, 4]
        assert mesh.areas.sum() == 32
        assert set(mesh.region.tolist()) == {0}

    def test_arrays_are_read_only(self, frame: ConstrainedDelaunay) -> None:
        assert not frame.report.zero.flags.writeable
        assert not frame.report.through.flags.writeable

    def test_sources_list_all_rows(self) -> None:
        points = [(0, 0), (4, 0), (2, 0), (1, 3)]
        mesh = ConstrainedDelaunay(points, [(0, 1), (1, 0), (2, 1)])
        indptr, indices = mesh.segment_source
        rows = [indices[a:b].tolist() for a, b in itertools.pairwise(indptr)]
        assert mesh.segments.tolist() == [[0, 2], [2, 1]]
        assert rows == [[0, 1], [0, 1, 2]]
        assert mesh.segment_forward.tolist() == [True, False, True, False, True]
        assert mesh.geometry_of_segment.tolist() == [-1, -1, -1]


class TestConforming:
    def test_subsegments_become_edges_of_delaunay(self) -> None:
        points = [(0, 0), (12, 0), (3, 1), (9, -1), (6, 2), (0, 9), (12, -9)]
        mesh = ConstrainedDelaunay(points, [(0, 1)], conforming=True)
        assert mesh.nadded > 0
        assert mesh.validate()
        edges = {frozenset(edge) for edge in Delaunay(mesh.points).edges.tolist()}
        assert {frozenset(edge) for edge in mesh.segments.tolist()} <= edges
        assert mesh.report.steiner[:, 0].tolist() == [0] * mesh.nadded
        assert sorted(mesh.report.steiner[:, 1].tolist()) == list(range(7, mesh.npoints))
        assert "were added to the paths of segments" in str(mesh.report)

    def test_where_nothing_is_to_do_nothing_is_added(self) -> None:
        mesh = ConstrainedDelaunay(OUTER, [*RINGS[:4], (0, 2)], conforming=True)
        assert mesh.nadded == 0
        assert mesh.report

    def test_the_budget_holds_here_too(self) -> None:
        points = [(0, 0), (1000, 0), *((x, 0.001) for x in range(1, 1000))]
        with pytest.raises(delone.BudgetExceededError) as caught:
            ConstrainedDelaunay(points, [(0, 1)], conforming=True, max_points=10)
        assert caught.value.limit == 10
        assert caught.value.segments == (0,)
        assert caught.value.place is not None
        assert caught.value.place[1] == 0
        assert "most are on segment 0, the last one at (" in str(caught.value)

    def test_the_budget_names_the_corner(self) -> None:
        """Points between two segments that are almost one, and a third that needs nothing."""
        points = [(50, 50), (3, 3), (13, 3), (13, 3 + 1e-3), (60, 60)]
        points += [(x, 3 + 5e-5 * (x - 3)) for x in range(4, 13)]
        segments = [(0, 4), (1, 2), (3, 1)]
        with pytest.raises(delone.BudgetExceededError) as caught:
            ConstrainedDelaunay(points, segments, conforming=True, max_points=8)
        assert set(caught.value.segments) == {1, 2}
        assert caught.value.place == (3, 3)
        assert "the first two of which meet at (3, 3)" in str(caught.value)

    def test_an_edit_conforms_as_well(self) -> None:
        mesh = ConstrainedDelaunay([(0, 0), (12, 0), (6, 9), (6, -9)], [(0, 1)], conforming=True)
        with mesh.edit() as edit:
            edit.insert_points([(4, 0.5)])
        assert edit.result.nadded > mesh.nadded


class TestSearch:
    def test_points_in_holes_are_outside(self, frame: ConstrainedDelaunay) -> None:
        queries = [(3, 3), (1, 1), (7, 7), (np.nan, 0)]
        assert (frame.find_simplex(queries) >= 0).tolist() == [False, True, False, False]
        assert frame.find_simplex((3, 3)).shape == ()

    def test_the_rim_of_a_hole_is_inside(self, frame: ConstrainedDelaunay) -> None:
        rim = np.array([(2, 2), (4, 4), (2, 3), (3, 2), (4, 2.5), (3.25, 4)])
        found = frame.find_simplex(rim)
        assert (found >= 0).all()
        for t, query in zip(found, rim.tolist(), strict=True):
            triangles = frame.points[frame.simplices].tolist()
            assert holders(triangles, query)[0] == t

    def test_the_first_holder_is_found(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, holes=[(3, 3)], boundary="outline")
        queries = np.stack(np.meshgrid(range(7), range(7)), axis=-1)
        triangles = mesh.points[mesh.simplices].tolist()
        found = mesh.find_simplex(queries)
        assert found.shape == (7, 7)
        for query, t in zip(queries.reshape(-1, 2).tolist(), found.ravel().tolist(), strict=True):
            assert t == next(iter(holders(triangles, query)), -1)

    def test_ways_lead_through_holes(self, frame: ConstrainedDelaunay) -> None:
        whole = ConstrainedDelaunay(*FRAME)
        assert whole.walk((1, 3), (1.25, 3)).tolist() == [whole.find_simplex((1, 3))]
        way = whole.triangles_along((-1, 2.75), (7, 3.25))
        assert len(set(way.tolist())) == len(way) == 6
        short = frame.triangles_along((-1, 2.75), (7, 3.25))
        assert len(short) == 4
        centre = frame.points[frame.simplices[short]].mean(axis=1)[:, 0]
        assert (np.diff(centre) > 0).all()

    def test_crossed_segments_come_in_order(self, frame: ConstrainedDelaunay) -> None:
        rows = frame.segments_crossing((-1, 2.75), (7, 3.25))
        assert frame.segments[rows].tolist() == [[3, 0], [7, 4], [5, 6], [1, 2]]
        back = frame.segments_crossing((7, 3.25), (-1, 2.75))
        assert back.tolist() == rows.tolist()[::-1]

    def test_touching_is_not_crossing(self, frame: ConstrainedDelaunay) -> None:
        for a, b in (((1, 1), (5, 5)), ((0, 2), (6, 2)), ((0, 0), (6, 0)), ((1, 1), (1, 1))):
            rows = frame.segments_crossing(a, b)
            touched = frame.segments[rows].tolist()
            assert touched == [], (a, b)
        assert frame.segments_crossing((1, 3), (2, 3)).size == 0
        assert frame.segments_crossing((9, 9), (9, 8)).size == 0

    def test_crossings_agree_with_all_pairs(self) -> None:
        random = np.random.default_rng(3)
        points = random.integers(0, 20, (60, 2))
        segments = random.integers(0, 60, (25, 2))
        mesh = ConstrainedDelaunay(points, segments, crossing="split")
        exact = [tuple(map(Fraction, p)) for p in mesh.points.tolist()]
        for a, b in random.integers(-3, 23, (30, 2, 2)).tolist():
            wanted = {
                i
                for i, (u, v) in enumerate(mesh.segments.tolist())
                if turn(a, b, exact[u]) * turn(a, b, exact[v]) < 0
                and turn(exact[u], exact[v], a) * turn(exact[u], exact[v], b) < 0
            }
            found = mesh.segments_crossing(a, b).tolist()
            assert len(found) == len(set(found))
            assert set(found) == wanted


def turn(a: Any, b: Any, c: Any) -> int:
    d = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return (d > 0) - (d < 0)


def holders(triangles: Any, query: Any) -> list[int]:
    return [
        t
        for t, (a, b, c) in enumerate(triangles)
        if min(turn(a, b, query), turn(b, c, query), turn(c, a, query)) >= 0
    ]


class TestObject:
    def test_nothing_can_be_set(self, frame: ConstrainedDelaunay) -> None:
        for name in ("points", "segments", "region", "_made", "anything"):
            with pytest.raises(AttributeError):
                setattr(frame, name, None)
        with pytest.raises(AttributeError, match="never changes"):
            frame.__init__([(0, 0), (1, 0), (0, 1)], [])  # type: ignore[misc]

    def test_arrays_are_read_only_and_kept(self, frame: ConstrainedDelaunay) -> None:
        names = (
            *("points", "simplices", "neighbors", "constrained", "segments", "input_segments"),
            *("region", "boundary", "edges", "areas", "circumcenters", "transform"),
            *("segment_forward", "geometry_of_segment", "vertex_to_simplex", "duplicate_of"),
        )
        for name in names:
            array = getattr(frame, name)
            with pytest.raises(ValueError, match="WRITEABLE"):
                array.flags.writeable = True
            assert getattr(frame, name) is array
        assert not any(array.flags.writeable for array in frame.segment_source)

    def test_the_input_stays_the_callers(self) -> None:
        points, segments = np.array(FRAME[0], dtype=float), np.array(RINGS, dtype=np.int32)
        holes = np.array([(3.0, 3.0)])
        mesh = ConstrainedDelaunay(points, segments, holes=holes)
        for array in (points, segments, holes):
            array[:] = 0
        assert mesh.points.tolist() == [list(map(float, p)) for p in FRAME[0]]
        assert mesh.input_segments.tolist() == [list(row) for row in RINGS]
        assert mesh.validate()
        assert mesh.report

    @pytest.mark.parametrize("again", [lambda m: pickle.loads(pickle.dumps(m)), copy.deepcopy])
    def test_pickle_and_copy(self, frame: ConstrainedDelaunay, again: Any) -> None:
        same_in_all(again(frame), frame)

    def test_a_file_brings_it_back(self, tmp_path: Path) -> None:
        mesh = ConstrainedDelaunay(
            [*FRAME[0], (1, 1), (5, 5), (1, 5), (0, 0)],
            [*RINGS, (8, 9), (10, 1)],
            holes=[(2.1, 3)],
            regions=[(0.5, 0.5, 3), (9, 9, 1)],
            crossing="split",
            boundary="outline",
        )
        mesh.save(tmp_path / "mesh.npz")
        loaded = ConstrainedDelaunay.load(tmp_path / "mesh.npz")
        same_in_all(loaded, mesh)
        assert loaded.validate()
        with loaded.edit() as edit:
            edit.remove_segment(0)
        with mesh.edit() as other:
            other.remove_segment(0)
        same_in_all(edit.result, other.result)

    def test_files_of_the_other_kind_are_refused(self, tmp_path: Path) -> None:
        Delaunay(OUTER).save(tmp_path / "plain.npz")
        with pytest.raises(delone.FileFormatError, match="its format is"):
            ConstrainedDelaunay.load(tmp_path / "plain.npz")
        ConstrainedDelaunay(OUTER, []).save(tmp_path / "constrained.npz")
        with pytest.raises(delone.FileFormatError, match="its format is"):
            Delaunay.load(tmp_path / "constrained.npz")

    @pytest.mark.parametrize(
        ("name", "change", "match"),
        [
            ("constrained", lambda a: ~a, "edge flags"),
            ("segments", lambda a: a[[0] * len(a)], "repeated"),
            ("source", lambda a: a + 100, "index outside"),
            ("source_start", lambda a: a[:-1], "sources of segments"),
            ("forward", lambda a: a[:-1], "directions"),
            ("input", lambda a: a - 1, "index outside"),
            ("labels", lambda a: np.zeros(3, dtype=np.int32), "labels"),
            ("holes", lambda a: a * np.nan, "not finite"),
            ("options", lambda a: a + 7, "options"),
            ("neighbors", lambda a: a[::-1], "mutual"),
            ("geometries", lambda a: a[1:], "geometries"),
        ],
    )
    def test_contradictions_in_files_are_found(
        self, frame: ConstrainedDelaunay, tmp_path: Path, name: str, change: Any, match: str
    ) -> None:
        path = tmp_path / "mesh.npz"
        frame.save(path)
        with np.load(path) as archive:
            arrays = dict(archive)
        arrays[name] = change(arrays[name])
        np.savez(path, **arrays)
        with pytest.raises(delone.FileFormatError, match=match):
            ConstrainedDelaunay.load(path)

    def test_threads_may_share_one(self) -> None:
        mesh = ConstrainedDelaunay(*FRAME, regions=[(3, 3)])
        found: list[Any] = []
        threads = [threading.Thread(target=lambda: found.append(mesh.region)) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert all(array is mesh.region for array in found)

    def test_workers_and_methods_give_the_same(self) -> None:
        plain = ConstrainedDelaunay(*FRAME)
        for options in ({"workers": 1}, {"workers": 2}, {"method": "divide-and-conquer"}):
            assert coordinates_of(ConstrainedDelaunay(*FRAME, **options)) == coordinates_of(plain)

    def test_stages_are_named(self, frame: ConstrainedDelaunay) -> None:
        assert frame.stages
        assert all(seconds >= 0 for seconds in frame.stages.values())


def same_in_all(one: ConstrainedDelaunay, other: ConstrainedDelaunay) -> None:
    for name in (
        *("points", "simplices", "neighbors", "constrained", "segments", "input_segments"),
        *("region", "segment_forward", "geometry_of_segment", "edges", "duplicate_of"),
    ):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
    for mine, theirs in zip(one.segment_source, other.segment_source, strict=True):
        np.testing.assert_array_equal(mine, theirs)
    assert str(one.report) == str(other.report)


ARRAYS = (
    *("added", "simplices", "neighbors", "constrained", "duplicates", "segments"),
    *("source_start", "source", "forward", "zero", "through", "crossings"),
)


def replaced(made: _core.ConstrainedTriangulation, **changes: Any) -> Any:
    """The same result with other arrays."""
    arrays = dict(zip(ARRAYS, made.arrays(), strict=True))
    return _core.ConstrainedTriangulation(**(arrays | changes))


class TestResult:
    """The result of the core can be made of arrays, which are checked."""

    def test_it_has_the_arrays_that_it_is_made_of(self, frame: ConstrainedDelaunay) -> None:
        again = pickle.loads(pickle.dumps(frame._made))
        for name, array in zip(ARRAYS, frame._made.arrays(), strict=True):
            assert getattr(frame._made, name) is array
            assert np.array_equal(getattr(again, name), array)
            assert getattr(again, name).dtype == array.dtype

    def test_it_cannot_be_changed(self, frame: ConstrainedDelaunay) -> None:
        with pytest.raises(AttributeError):
            frame._made.simplices = frame.simplices  # type: ignore[misc]

    @pytest.mark.parametrize("name", ARRAYS)
    def test_other_shapes_are_refused(self, frame: ConstrainedDelaunay, name: str) -> None:
        array = getattr(frame._made, name)
        if array.ndim == 2:
            with pytest.raises(ShapeError, match=f"{name} has {array.shape[1] + 1} columns"):
                replaced(frame._made, **{name: np.zeros((1, array.shape[1] + 1), array.dtype)})
        with pytest.raises(TypeError):
            replaced(frame._made, **{name: array[None]})
        with pytest.raises(TypeError):
            replaced(frame._made, **{name: array.astype(np.float32)})

    @pytest.mark.parametrize("name", ["neighbors", "constrained", "segments", "forward"])
    def test_lengths_that_differ_are_refused(self, frame: ConstrainedDelaunay, name: str) -> None:
        with pytest.raises(ShapeError, match="differ in length"):
            replaced(frame._made, **{name: getattr(frame._made, name)[:-1]})


class TestValidation:
    """Each kind of damage is found, and nothing else is."""

    @pytest.mark.parametrize(
        ("name", "change", "culprit"),
        [
            ("constrained", lambda a: ~a, "flags"),
            ("segments", lambda a: np.concatenate((a, [[0, 6]])), "absent"),
            ("forward", lambda a: ~a, "uncovered"),
            ("input", lambda a: a[::-1], "uncovered"),
        ],
    )
    def test_damage_is_named(
        self, frame: ConstrainedDelaunay, name: str, change: Any, culprit: str
    ) -> None:
        made, ends = frame._made, frame.duplicate_of[frame.input_segments]
        changes = {}
        if name == "input":
            ends = change(ends)
        else:
            old = getattr(made, name)
            changes[name] = np.ascontiguousarray(change(old)).astype(old.dtype)
        if name == "segments":  # the new one belongs to row 0
            changes["source"] = np.append(made.source, 0).astype(np.int32)
            changes["forward"] = np.append(made.forward, True)
            changes["source_start"] = np.append(made.source_start, len(made.source) + 1)
        made = replaced(made, **changes)
        report = validation.validate(frame.points, made, ends)
        assert not report
        assert len(getattr(report, culprit))
        assert culprit in str(report)
        assert "constrained" in str(report)

    def test_an_edge_without_segment_must_be_locally_delaunay(self) -> None:
        rhomb = [(0, 0), (3, -1), (6, 0), (3, 1)]
        mesh = ConstrainedDelaunay(rhomb, [(0, 2)])
        nothing = np.empty((0, 2), dtype=np.int32)
        made = replaced(
            mesh._made,
            constrained=np.zeros((2, 3), dtype=bool),
            segments=nothing,
            source=np.empty(0, dtype=np.int32),
            forward=np.empty(0, dtype=bool),
            source_start=np.zeros(1, dtype=np.int64),
        )
        report = validation.validate(mesh.points, made, nothing)
        assert report.delaunay.tolist() == [[0, 1]]
        assert mesh.validate()

    def test_a_row_must_be_straight(self) -> None:
        mesh = ConstrainedDelaunay([(0, 0), (4, 0), (2, 1), (2, -4)], [(0, 2), (2, 1)])
        made = replaced(mesh._made, source=np.zeros(2, dtype=np.int32))
        ends = np.array([[0, 1], [2, 2]], dtype=np.int32)
        report = validation.validate(mesh.points, made, ends)
        assert report.bent.tolist() == [[0, 2]]
        assert report.uncovered.size == 0
