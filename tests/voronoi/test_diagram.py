"""The whole diagram against exact arithmetic: duality, vertices, nearest and degenerate sites."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone import Delaunay
from delone.datasets import tilted_grid, uniform
from delone.errors import DegenerateInputError, NonFiniteError, ShapeError
from delone.predicates import incircle
from delone.voronoi import Voronoi
from rational import ulps
from tiers import examples

Exact = tuple[Fraction, Fraction]


def exact_center(corners: Any) -> Exact:
    """The centre of the circle through three points, not rounded."""
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(x) for x in corner] for corner in corners.tolist())
    dx, dy, ex, ey = bx - ax, by - ay, cx - ax, cy - ay
    d, e = dx * dx + dy * dy, ex * ex + ey * ey
    twice = 2 * (dx * ey - dy * ex)
    return ax + (ey * d - dy * e) / twice, ay + (dx * e - ex * d) / twice


def lattice_points(draw_range: int) -> Any:
    coordinate = st.integers(0, draw_range)
    return st.lists(st.tuples(coordinate, coordinate), min_size=1, max_size=24)


@pytest.mark.parametrize("offset", [0.0, -0.5, 1e6])
@pytest.mark.parametrize("stretch", [1.0, 1e-9])
def test_vertices_are_within_four_units_in_the_last_place(offset: float, stretch: float) -> None:
    points = uniform(300, seed=1) * [1.0, stretch] + offset
    diagram = Voronoi(points)
    mesh = diagram.triangulation
    assert mesh is not None
    for corners, vertex in zip(mesh.simplices, diagram.simplex_vertices, strict=True):
        for found, exact in zip(
            diagram.vertices[vertex].tolist(), exact_center(points[corners]), strict=True
        ):
            assert ulps(found, exact) <= 4


def test_vertices_hang_neither_on_the_order_of_rows_nor_on_method_and_workers() -> None:
    points = np.concatenate((uniform(400, seed=2), tilted_grid(400)))
    diagram = Voronoi(points, workers=1)
    expected = sorted(map(tuple, diagram.vertices.tolist()))
    for seed in range(3):
        order = np.random.default_rng(seed).permutation(len(points))
        shuffled = Voronoi(points[order], workers=2)
        assert sorted(map(tuple, shuffled.vertices.tolist())) == expected
        pairs = {frozenset(pair) for pair in order[shuffled.ridge_points].tolist()}
        assert pairs == {frozenset(pair) for pair in diagram.ridge_points.tolist()}


@pytest.mark.parametrize("seed", range(4))
def test_each_ridge_is_the_dual_of_an_edge_and_each_vertex_of_triangles(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 12, (150, 2)) if seed % 2 else rng.random((150, 2))
    diagram = Voronoi(points)
    mesh = diagram.triangulation
    assert mesh is not None
    vertex = np.append(diagram.simplex_vertices, -1)
    ridges = {
        tuple(sorted(pair)): sorted(ends)
        for pair, ends in zip(diagram.ridge_points.tolist(), diagram.ridge_vertices, strict=True)
    }
    seen = 0
    for t, k in np.ndindex(mesh.simplices.shape):
        edge = tuple(sorted(int(v) for v in np.delete(mesh.simplices[t], k)))
        other = mesh.neighbors[t, k]
        if other >= 0:
            a, b, c = points[mesh.simplices[t]]
            apex = mesh.simplices[other][mesh.neighbors[other] == t]
            tied = incircle(a, b, c, points[apex[0]]) == 0
            # Edges within a cocircular polygon have no ridge, their triangles one vertex.
            assert tied == (vertex[t] == vertex[other])
            if tied:
                assert edge not in ridges
                continue
        assert ridges[edge] == sorted((int(vertex[t]), int(vertex[other])))
        seen += 1 if other < t else 0
    assert seen == len(ridges)
    assert set(range(len(diagram.vertices))) == set(diagram.simplex_vertices.tolist())


def test_the_first_site_of_a_ridge_lies_to_the_left_of_its_way() -> None:
    diagram = Voronoi(uniform(200, seed=3))
    a, b = diagram.points[diagram.ridge_points].swapaxes(0, 1)
    ends = np.array(diagram.ridge_vertices)
    inner = (ends >= 0).all(axis=1)
    assert (ends[~inner, 0] == -1).all()
    start, end = diagram.vertices[ends[inner]].swapaxes(0, 1)
    way, across = end - start, (a - b)[inner]
    assert (way[:, 0] * across[:, 1] - way[:, 1] * across[:, 0] > 0).all()


def test_the_dictionary_has_each_ridge_between_its_sites() -> None:
    diagram = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2), (2, 2)])
    ridges = diagram.ridge_dict
    assert list(ridges) == [tuple(pair) for pair in diagram.ridge_points.tolist()]
    found = {
        frozenset(pair): {tuple(diagram.vertices[v].tolist()) for v in ends if v >= 0}
        for pair, ends in ridges.items()
    }
    # The middle has a square, and the corners share a ray each from one of its corners.
    south, east, north, west = (2.0, 0.0), (4.0, 2.0), (2.0, 4.0), (0.0, 2.0)
    assert found == {
        frozenset((0, 4)): {south, west},
        frozenset((1, 4)): {south, east},
        frozenset((2, 4)): {north, east},
        frozenset((3, 4)): {north, west},
        frozenset((0, 1)): {south},
        frozenset((1, 2)): {east},
        frozenset((2, 3)): {north},
        frozenset((0, 3)): {west},
    }


@settings(max_examples=examples(30, deep=300), deadline=None)
@given(lattice_points(6))
def test_regions_are_the_cycles_of_their_ridges(sites: list[tuple[int, int]]) -> None:
    diagram = Voronoi(sites)
    by_site: dict[int, list[tuple[int, int]]] = {}
    for pair, ends in zip(diagram.ridge_points.tolist(), diagram.ridge_vertices, strict=True):
        by_site.setdefault(pair[0], []).append(tuple(ends))
        by_site.setdefault(pair[1], []).append(tuple(ends[::-1]))
    starts, vertices = diagram._cells.dual.region_starts, diagram._cells.dual.region_vertices
    for row in set(diagram.duplicate_of.tolist()):
        region = diagram.point_region[row]
        cycle = vertices[starts[region] : starts[region + 1]].tolist()
        steps = [(v, cycle[(i + 1) % len(cycle)]) for i, v in enumerate(cycle)]
        assert sorted(steps) == sorted(by_site.get(row, []))


@pytest.mark.parametrize("make", [uniform, tilted_grid])
def test_the_cell_of_a_random_query_is_that_of_its_nearest_site(make: Any) -> None:
    points = make(500)
    low, high = points.min(axis=0) - 1, points.max(axis=0) + 1
    diagram = Voronoi(points, clip=(*low, *high))
    queries = np.random.default_rng(5).random((300, 2)) * (high - low) + low
    nearest = ((queries[:, None] - points) ** 2).sum(axis=2).argmin(axis=1)
    for query, site in zip(queries, nearest, strict=True):
        ring = diagram.cell(int(site)).parts[0][0]
        along = np.roll(ring, -1, axis=0) - ring
        towards = query - ring
        turn = along[:, 0] * towards[:, 1] - along[:, 1] * towards[:, 0]
        assert (turn > -1e-12).all()


def test_the_diagram_is_that_of_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = uniform(1000, seed=6)
    ours, theirs = Voronoi(points), spatial.Voronoi(points)

    def cells(diagram: Any) -> list[set[tuple[float, ...]]]:
        corners = [tuple(v) for v in np.round(diagram.vertices, 6).tolist()] + [()]
        return [{corners[v] for v in diagram.regions[r]} for r in diagram.point_region]

    near = np.abs(theirs.vertices).max(axis=1) < 100
    assert np.allclose(
        sorted(theirs.vertices[near].tolist()),
        sorted(ours.vertices[np.abs(ours.vertices).max(axis=1) < 100].tolist()),
    )
    pairs = {frozenset(pair) for pair in ours.ridge_points.tolist()}
    assert pairs == {frozenset(pair) for pair in theirs.ridge_points.tolist()}
    inner = [i for i, r in enumerate(ours.point_region) if -1 not in ours.regions[r]]
    found, expected = cells(ours), cells(theirs)
    assert [len(found[i]) for i in inner] == [len(expected[i]) for i in inner]


def test_a_grid_has_one_vertex_for_each_square() -> None:
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(30.0)), axis=-1).reshape(-1, 2)
    diagram = Voronoi(grid)
    assert len(diagram.vertices) == 19 * 29
    assert len(diagram.ridge_points) == 19 * 30 + 20 * 29
    assert {tuple(v) for v in diagram.vertices.tolist()} == {
        (x + 0.5, y + 0.5) for x in range(19) for y in range(29)
    }
    bounded = [len(region) for region in diagram.regions if -1 not in region]
    assert bounded == [4] * (18 * 28)


def test_sites_on_one_circle_share_one_vertex() -> None:
    # Pythagorean points: exactly on the circle of radius 65.
    points = [(x, y) for x in range(-65, 66) for y in range(-65, 66) if x * x + y * y == 65 * 65]
    diagram = Voronoi(points)
    assert len(points) == 36
    assert diagram.vertices.tolist() == [[0.0, 0.0]]
    assert len(diagram.ridge_points) == 36
    assert all(sorted(region) == [-1, 0] for region in diagram.regions)


def test_rays_lead_away_from_the_other_sites() -> None:
    diagram = Voronoi(uniform(100, seed=7))
    ridge, origin, direction = diagram.rays
    assert len(ridge) == sum(ridge.count(-1) for ridge in diagram.ridge_vertices)
    assert np.allclose(np.hypot(*direction.T), 1)
    far = origin + 1e3 * direction
    distance = np.hypot(*(far[:, None] - diagram.points).T).T
    for row, pair in zip(distance, diagram.ridge_points[ridge].tolist(), strict=True):
        assert np.allclose(row[pair], row.min())


def test_duplicates_share_the_cell_of_their_first_row() -> None:
    points = [(0, 0), (4, 0), (0, 0), (0, 4), (4, 4), (4, 0), (-0.0, 0)]
    diagram = Voronoi(points, clip="box")
    assert diagram.duplicate_of.tolist() == [0, 1, 0, 3, 4, 1, 0]
    assert diagram.point_region[[2, 5, 6]].tolist() == diagram.point_region[[0, 1, 0]].tolist()
    assert diagram.cell_areas.tolist() == [4.0] * 7
    assert diagram.neighbors.indptr.tolist() == [0, 2, 4, 4, 6, 8, 8, 8]


@pytest.mark.parametrize("points", [[(3, 4)], [(3, 4), (3, 4)]])
def test_one_site_has_the_whole_plane(points: list[tuple[int, int]]) -> None:
    diagram = Voronoi(points)
    assert diagram.regions == [[]]
    assert diagram.cell_areas.tolist() == [np.inf] * len(points)
    assert len(diagram.ridge_points) == len(diagram.vertices) == 0
    assert diagram.triangulation is None
    assert not diagram.cell(0).bounded


def test_sites_on_a_line_have_strips_between_half_planes() -> None:
    points = [(4, 8), (0, 0), (1, 2), (0, 0), (2, 4)]
    diagram = Voronoi(points)
    assert diagram.ridge_points.tolist() == [[1, 2], [2, 4], [4, 0]]
    assert diagram.ridge_vertices == [[-1, -1]] * 3
    assert diagram.duplicate_of.tolist() == [0, 1, 2, 1, 4]
    ridge, origin, direction = diagram.rays
    assert ridge.tolist() == [0, 0, 1, 1, 2, 2]
    assert origin[::2].tolist() == [[0.5, 1.0], [1.5, 3.0], [3.0, 6.0]]
    assert np.allclose(direction[::2], -direction[1::2])
    assert np.allclose(direction @ [1, 2], 0)
    clipped = Voronoi(points, clip=(-10, -10, 10, 10))
    areas = clipped.cell_areas
    assert areas[[0, 1, 2, 4]].sum() == pytest.approx(400)
    # The lines x + 2 y = 2.5, 7.5 and 15 have 225, 275 and 350 - 2.5 * 5 / 2 of the box below them.
    assert areas.tolist() == pytest.approx([56.25, 225, 50, 225, 68.75], rel=1e-14)


def test_a_vertex_beyond_the_range_is_a_ray() -> None:
    tiny = 5e-324
    points = [(0, 0), (1, 0), (2, tiny), (1, -1)]
    diagram = Voronoi(points)
    assert np.isfinite(diagram.vertices).all()
    mesh = diagram.triangulation
    assert mesh is not None
    assert (diagram.simplex_vertices < 0).sum() == 1
    # Cells are still convex and tile a box.
    clipped = Voronoi(points, clip=(-3, -3, 5, 3))
    assert clipped.cell_areas.sum() == 48
    middle = clipped.cell(1)
    assert not middle.bounded
    assert middle.parts[0][0][:, 1].max() == 3
    # What is left of it in the box lies between the lines halfway to both neighbors.
    assert middle.parts[0][0][:, 0].min() == 0.5
    assert middle.parts[0][0][:, 0].max() == 1.5


@pytest.mark.parametrize("scale", [2.0**-1060, 2.0**-500, 2.0**1000])
def test_a_power_of_two_changes_nothing(scale: float) -> None:
    points = np.random.default_rng(8).integers(0, 2**10, (60, 2)).astype(float)
    plain, scaled = Voronoi(points), Voronoi(points * scale)
    pairs = [sorted(map(sorted, each.ridge_points.tolist())) for each in (plain, scaled)]
    assert pairs[0] == pairs[1]
    assert len(plain.vertices) == len(scaled.vertices)
    if scale > 2.0**-1000:
        expected = sorted((plain.vertices * scale).tolist())
        assert np.allclose(sorted(scaled.vertices.tolist()), expected, rtol=1e-15, atol=0)


def test_neighbors_have_the_lengths_of_common_edges() -> None:
    diagram = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)])
    indptr, indices, lengths = diagram.neighbors
    assert indptr.tolist() == [0, 3, 6, 9, 12, 16]
    assert indices[12:].tolist() == [0, 1, 2, 3]
    assert lengths[12:].tolist() == pytest.approx([np.sqrt(8)] * 4)
    assert lengths[:3].tolist() == pytest.approx([np.inf, np.inf, np.sqrt(8)])
    assert diagram.cell_areas.tolist() == [np.inf] * 4 + [8.0]
    assert diagram.cell_perimeters[4] == pytest.approx(4 * np.sqrt(8))
    assert diagram.cell_centroids[4].tolist() == [2.0, 2.0]
    assert np.isnan(diagram.cell_centroids[:4]).all()


def test_cells_are_bounded_or_between_two_rays() -> None:
    diagram = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)])
    inner, outer = diagram.cell(4), diagram.cell(0)
    assert inner.bounded and len(inner.vertices) == 4 and len(inner.parts) == 1
    assert not outer.bounded and outer.parts == ()
    assert outer.vertices.tolist() == [[2.0, 0.0], [0.0, 2.0]]
    assert diagram.cell(-1).site == 4
    for row in (5, -6, 10**30, -(10**5000)):
        with pytest.raises(IndexError, match="no such site: i must be a row, from 0 to 4"):
            diagram.cell(row)


def test_nothing_can_be_changed() -> None:
    diagram = Voronoi(uniform(20, seed=9))
    for name in ("points", "vertices", "ridge_points", "point_region", "simplex_vertices"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(diagram, name)[0] = 0
        with pytest.raises(AttributeError):
            setattr(diagram, name, None)
    with pytest.raises(AttributeError):
        diagram.__init__([(0, 0)])  # type: ignore[misc]
    assert copy.deepcopy(diagram) is diagram
    again = pickle.loads(pickle.dumps(diagram))
    assert np.array_equal(again.ridge_points, diagram.ridge_points)
    assert again.regions == diagram.regions


def test_bad_sites_are_refused_by_name() -> None:
    with pytest.raises(NonFiniteError) as caught:
        Voronoi([(0, 0), (1, np.nan), (2, 5)])
    assert caught.value.rows.tolist() == [1]
    with pytest.raises(ShapeError):
        Voronoi([tuple(range(9))])
    with pytest.raises(DegenerateInputError):
        Voronoi(np.empty((0, 2)))


def test_the_triangulation_is_the_dual() -> None:
    points = uniform(50, seed=10)
    mesh = Voronoi(points).triangulation
    assert mesh is not None
    assert np.array_equal(mesh.simplices, Delaunay(points).simplices)


def test_one_site_is_enough_and_none_is_said_to_be_too_few() -> None:
    assert len(Voronoi([(1, 2)]).point_region) == 1
    for options in ({}, {"weights": []}):
        with pytest.raises(DegenerateInputError, match="a diagram needs at least one"):
            Voronoi(np.empty((0, 2)), **options)
