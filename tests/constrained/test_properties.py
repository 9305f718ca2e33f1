"""Laws of the constrained triangulation, on small lattices where ties and touches are everywhere.

Drawn are points of lattices from 3 x 3 to 6 x 6, duplicates among them, and segments between any
two of them, which overlap, repeat, run through points and have no length as it comes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from delone import (
    ConstrainedDelaunay,
    CrossingSegmentsError,
    DegenerateInputError,
    Delaunay,
    _core,
    datasets,
    reference,
)
from delone.testing import (
    assert_constrained_delaunay,
    assert_regions,
    same_triangles,
    triangle_set,
)

METHODS = _core.methods2()
SEEDS = st.integers(0, 2**32 - 1)


class Drawing(NamedTuple):
    """Points of a lattice and segments between them."""

    points: np.ndarray
    segments: np.ndarray


@st.composite
def drawings(draw: st.DrawFn) -> Drawing:
    side = draw(st.integers(3, 6))
    place = st.tuples(st.integers(0, side - 1), st.integers(0, side - 1))
    points = draw(st.lists(place, min_size=3, max_size=side * side))
    row = st.integers(0, len(points) - 1)
    segments = draw(st.lists(st.tuples(row, row), max_size=8))
    array = np.array(points, dtype=float)
    assume(not spans_no_area(array))
    return Drawing(array, np.array(segments, dtype=int).reshape(-1, 2))


def spans_no_area(points: np.ndarray) -> bool:
    try:
        Delaunay(points)
    except DegenerateInputError:
        return True
    return False


def triangulated(drawing: Drawing, **options: Any) -> ConstrainedDelaunay:
    """The triangulation; what crosses is split, and splits without an end are cut off."""
    options = {"max_points": 100_000} | options
    return ConstrainedDelaunay(*drawing, crossing="split", **options)


def uncrossed(drawing: Drawing) -> Drawing:
    """Without the later row of each pair that crosses."""
    segments = drawing.segments
    while True:
        try:
            ConstrainedDelaunay(drawing.points, segments)
        except CrossingSegmentsError as error:
            segments = np.delete(segments, error.pairs[0, 1], axis=0)
            continue
        return Drawing(drawing.points, segments)


def places(mesh: ConstrainedDelaunay) -> set[tuple[Any, ...]]:
    """Triangles by the coordinates of their corners, from the smallest on."""
    corners = (mesh.points + 0.0)[mesh.simplices].tolist()
    found = set()
    for triangle in corners:
        a, b, c = map(tuple, triangle)
        found.add(min((a, b, c), (b, c, a), (c, a, b)))
    return found


def pieces(mesh: ConstrainedDelaunay, rows: Any = None) -> dict[frozenset[Any], list[int]]:
    """Subsegments by their coordinates, with their sources; rows may have been renamed."""
    ends = list(map(tuple, (mesh.points + 0.0).tolist()))
    indptr, source = mesh.segment_source
    source = source if rows is None else np.asarray(rows)[source]
    return {
        frozenset(ends[v] for v in mesh.segments[i].tolist()): sorted(
            source[indptr[i] : indptr[i + 1]].tolist()
        )
        for i in range(len(mesh.segments))
    }


@given(drawings())
def test_split_drawings_exactly(drawing: Drawing) -> None:
    mesh = triangulated(drawing)
    assert np.array_equal(mesh.points[: len(drawing.points)], drawing.points)
    assert_constrained_delaunay(mesh, drawing.segments, split=True)
    assert_regions(mesh, mesh.region)
    report = mesh.validate()
    assert report, str(report)


@given(drawings())
def test_the_reference_says_the_same(drawing: Drawing) -> None:
    drawing = uncrossed(drawing)
    mesh = ConstrainedDelaunay(*drawing)
    wanted = reference.constrained_delaunay(drawing.points.tolist(), drawing.segments.tolist())
    assert_constrained_delaunay(mesh, drawing.segments)
    assert mesh.nadded == 0
    assert triangle_set(mesh.simplices) == set(wanted.triangles)
    indptr, source = mesh.segment_source
    found = {
        tuple(sorted(edge)): source[indptr[i] : indptr[i + 1]].tolist()
        for i, edge in enumerate(mesh.segments.tolist())
    }
    assert found == wanted.sources


# Rows 0 and 4 cross where a point is, and others cross elsewhere.
AT_A_POINT = Drawing(
    np.array([(10, 0), (7, 0), (4, 12), (8, 6), (7, 6), (1, 6), (0, 9)], dtype=float),
    np.array([(3, 5), (6, 1), (5, 0), (4, 0), (2, 0), (3, 0)]),
)
# Rows 1 and 2 overlap where row 0 crosses them; all three cross in one place.
OVERLAPPING = Drawing(
    np.array([(0, 1), (3, 1), (1, 0), (1, 4), (1, 3), (0, 4)], dtype=float),
    np.array([(0, 1), (2, 3), (4, 2)]),
)
STAR = Drawing(
    np.array([(0, 0), (3, 3), (0, 3), (3, 0), (0, 1), (3, 2)], dtype=float),
    np.array([(0, 1), (2, 3), (4, 5)]),
)


@example(AT_A_POINT)
@example(OVERLAPPING)
@example(STAR)
@given(drawings())
def test_crossings_are_those_of_the_reference(drawing: Drawing) -> None:
    try:
        reference.constrained_delaunay(drawing.points.tolist(), drawing.segments.tolist())
    except CrossingSegmentsError as error:
        with pytest.raises(CrossingSegmentsError) as caught:
            ConstrainedDelaunay(*drawing)
        assert caught.value.pairs.tolist() == error.pairs.tolist()
        assert caught.value.points.tolist() == error.points.tolist()
        reported = triangulated(drawing).report.crossings
        assert np.unique(reported[:, :2], axis=0).tolist() == error.pairs.tolist()
    else:
        mesh, split = ConstrainedDelaunay(*drawing), triangulated(drawing)
        assert np.array_equal(mesh.simplices, split.simplices)
        assert split.nadded == 0 and len(split.report.crossings) == 0


@given(drawings())
def test_a_crossing_is_a_vertex_of_both_rows(drawing: Drawing) -> None:
    mesh = triangulated(drawing)
    indptr, source = mesh.segment_source
    of_row: list[set[int]] = [set() for _ in drawing.segments]
    for i, (u, v) in enumerate(mesh.segments.tolist()):
        for row in source[indptr[i] : indptr[i + 1]].tolist():
            of_row[row] |= {u, v}
    for one, other, vertex in mesh.report.crossings.tolist():
        assert vertex in of_row[one] & of_row[other]
    for row, vertex in mesh.report.through.tolist():
        assert vertex in of_row[row] and vertex < len(drawing.points)


@given(drawings())
def test_subsegments_are_listed_in_order(drawing: Drawing) -> None:
    mesh = triangulated(drawing)
    indptr, source = mesh.segment_source
    row = np.arange(len(mesh.segments)).repeat(np.diff(indptr))
    # By the first row that covers each, and along it.
    first = source[indptr[:-1]]
    assert (np.diff(first) >= 0).all()
    assert mesh.segment_forward[indptr[:-1]].all()
    begins = mesh.points[mesh.segments[:, 0]]
    for i in np.flatnonzero(first[:-1] == first[1:]):
        start, end = mesh.points[drawing.segments[first[i]]]
        assert (begins[i + 1] - begins[i]) @ (end - start) > 0
    for i, given_row, forward in zip(row, source, mesh.segment_forward, strict=True):
        start, end = mesh.points[drawing.segments[given_row]]
        along = np.diff(mesh.points[mesh.segments[i]], axis=0)[0] @ (end - start)
        assert (along > 0) == forward


@given(drawings(), SEEDS)
def test_order_of_rows_does_not_show(drawing: Drawing, seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = triangulated(drawing)
    order = rng.permutation(len(drawing.points))
    moved = Drawing(drawing.points[order], np.argsort(order)[drawing.segments])
    other = triangulated(moved)
    assert places(other) == places(mesh)
    assert pieces(other) == pieces(mesh)


@given(drawings(), SEEDS)
def test_order_and_direction_of_segments_do_not_show(drawing: Drawing, seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = triangulated(drawing)
    order = rng.permutation(len(drawing.segments))
    turned = drawing.segments[order]
    back = rng.random(len(turned)) < 0.5
    turned[back] = turned[back, ::-1]
    other = triangulated(Drawing(drawing.points, turned))
    assert places(other) == places(mesh)
    assert pieces(other, order) == pieces(mesh)


@given(drawings(), st.integers(-900, 900))
def test_powers_of_two_scale_triangles(drawing: Drawing, power: int) -> None:
    mesh = triangulated(drawing)
    scaled = triangulated(Drawing(np.ldexp(drawing.points, power), drawing.segments))
    assert np.array_equal(scaled.points, np.ldexp(mesh.points, power))
    assert same_triangles(scaled.simplices, mesh.simplices)
    assert np.array_equal(scaled.segments, mesh.segments)


@given(drawings(), st.integers(-(2**52), 2**52), st.integers(-(2**52), 2**52))
def test_exact_translations_keep_triangles(drawing: Drawing, dx: int, dy: int) -> None:
    drawing = uncrossed(drawing)
    offset = np.array((dx, dy))
    moved = Drawing(drawing.points + offset, drawing.segments)
    assert np.array_equal(moved.points - offset, drawing.points)
    one, other = ConstrainedDelaunay(*drawing), ConstrainedDelaunay(*moved)
    assert same_triangles(one.simplices, other.simplices)
    assert np.array_equal(one.segments, other.segments)


@given(drawings(), st.integers(-(2**51), 2**51), st.integers(-(2**51), 2**51))
@example(
    Drawing(np.array([(0, 0), (5, 1), (0, 1), (5, 2.0)]), np.array([(0, 3), (1, 2)])), 2**51, 0
)
def test_crossings_far_from_home_are_split_exactly(drawing: Drawing, dx: int, dy: int) -> None:
    """Doubles there are 1/2 or 1 apart, so that a crossing falls upon whatever is near."""
    moved = Drawing(drawing.points + np.array((dx, dy)), drawing.segments)
    mesh = triangulated(moved)
    assert_constrained_delaunay(mesh, moved.segments, split=True)


@pytest.mark.parametrize("turned", [False, True])
def test_splitting_ends_where_one_axis_is_coarser(turned: bool) -> None:
    """Abscissas 1/2 apart, ordinates fine: what is bent may cross what is bent, over and over."""
    points = np.array([(0, 0), (11, 7), (7, 7), (7, 8), (2, 0)]) + np.array((2.0**51, 0))
    segments = np.array([(3, 4), (4, 2), (1, 0)])
    drawing = Drawing(points[:, ::-1] if turned else points, segments)
    mesh = triangulated(drawing, max_points=1000)
    assert_constrained_delaunay(mesh, segments, split=True)


@given(drawings())
def test_rows_that_repeat_change_nothing(drawing: Drawing) -> None:
    mesh = triangulated(drawing)
    twice = np.vstack((drawing.segments, drawing.segments[:, ::-1], [[0, 0]]))
    other = triangulated(Drawing(drawing.points, twice))
    assert places(other) == places(mesh)
    count = len(drawing.segments)
    wanted = {edge: rows + [row + count for row in rows] for edge, rows in pieces(mesh).items()}
    assert pieces(other) == wanted


@given(drawings())
def test_subsegments_as_segments_change_nothing(drawing: Drawing) -> None:
    mesh = triangulated(drawing)
    again = ConstrainedDelaunay(mesh.points, mesh.segments)
    assert same_triangles(again.simplices, mesh.simplices)
    assert again.nadded == 0
    assert sorted(again.segments.tolist()) == sorted(mesh.segments.tolist())


@given(drawings())
def test_no_segments_are_delaunay(drawing: Drawing) -> None:
    mesh = ConstrainedDelaunay(drawing.points, np.empty((0, 2), dtype=int))
    assert same_triangles(mesh.simplices, Delaunay(drawing.points).simplices)
    assert not mesh.constrained.any() and set(mesh.region.tolist()) == {0}


@given(
    drawings(),
    st.lists(st.tuples(st.integers(-2, 22), st.integers(-2, 22)), min_size=1, max_size=5),
)
def test_regions_and_holes_of_seeds(drawing: Drawing, seeds: list[tuple[int, int]]) -> None:
    # Quarters of the lattice: within triangles, on edges, on vertices and outside.
    places = np.array(seeds, dtype=float).reshape(-1, 2) / 4
    whole = triangulated(drawing)
    assert_regions(whole, triangulated(drawing, regions=places).region, seeds=places)
    numbered = np.column_stack((places, np.arange(len(places)) + 7))
    assert_regions(
        whole,
        triangulated(drawing, regions=numbered).region,
        seeds=places,
        seed_labels=np.arange(len(places)) + 7,
    )
    try:
        holed = triangulated(drawing, holes=places)
    except DegenerateInputError:
        return
    assert_constrained_delaunay(holed, drawing.segments, split=True, complete=False)
    label = triangulated(drawing, regions=places).region
    assert same_triangles(holed.simplices, whole.simplices[label < 0])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["integer_lattice", "collinear_lines", "duplicates", "spiral"])
def test_methods_and_workers_do_not_show(name: str, method: str) -> None:
    points = datasets.GENERATORS[name](400, seed=3)
    rows = np.random.default_rng(3).permutation(len(points))[:40]
    drawing = Drawing(points, rows.reshape(-1, 2))
    expected = triangulated(drawing)
    assert_constrained_delaunay(expected, drawing.segments, split=True)
    for workers in (1, 2, 5):
        mesh = triangulated(drawing, method=method, workers=workers)
        assert places(mesh) == places(expected)
        assert pieces(mesh) == pieces(expected)


def test_workers_do_not_show_in_many_blocks() -> None:
    points = datasets.gaussian_clusters(60_000)
    segments = np.random.default_rng(5).integers(0, len(points), (30, 2))
    expected = triangulated(Drawing(points, segments), workers=1)
    for workers in (None, 2, 5):
        mesh = triangulated(Drawing(points, segments), workers=workers)
        assert np.array_equal(mesh.points, expected.points)
        assert np.array_equal(mesh.simplices, expected.simplices)
        assert np.array_equal(mesh.constrained, expected.constrained)


@pytest.mark.parametrize("name", sorted(datasets.GENERATORS))
@pytest.mark.sampled(6)
def test_every_generator_exactly(name: str) -> None:
    points = datasets.GENERATORS[name](1500, seed=8)
    order = np.lexsort(points.T[::-1])[::3]
    zigzag = np.column_stack((order[:-1], order[1:]))
    mesh = ConstrainedDelaunay(points, zigzag)
    assert_constrained_delaunay(mesh, zigzag)
    rows = np.random.default_rng(8).integers(0, len(points), (40, 2))
    mesh = triangulated(Drawing(points, rows))
    assert_constrained_delaunay(mesh, rows, split=True)


def test_rows_led_around_bent_pieces_may_bend() -> None:
    """Row 2 is crossed and bends at vertex 2, across row 0, which no segment crosses."""
    e = 2.0**-52
    points = [(0, 1 - e / 2), (1 + e, e), (3, 1 + e), (2, 3), (1, 3), (3, 1)]
    mesh = ConstrainedDelaunay(points, [(3, 5), (0, 3), (5, 4)], crossing="split")
    assert mesh.validate().ok
    assert mesh.report.steiner.tolist() == [[0, 2], [2, 2]]
