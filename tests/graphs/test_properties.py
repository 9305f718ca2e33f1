"""Laws of all graphs: inclusions, independence of rows, units and threads; and larger sets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import datasets, graphs

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Every graph by its name, and whether it is only available in 2-D.
ALL: dict[str, tuple[Callable[..., graphs.Graph], dict[str, Any], bool]] = {
    "delaunay": (graphs.delaunay_graph, {}, False),
    "gabriel": (graphs.gabriel, {}, False),
    "open gabriel": (graphs.gabriel, {"boundary": "open"}, False),
    "relative": (graphs.relative_neighborhood, {}, False),
    "urquhart": (graphs.urquhart, {}, True),
    "lunes": (graphs.beta_skeleton, {"beta": 1.3}, False),
    "circles": (graphs.beta_skeleton, {"beta": 1.3, "kind": "circle"}, True),
    "tree": (graphs.minimum_spanning_tree, {}, False),
    "nearest": (graphs.nearest_neighbors, {"k": 5}, False),
    "directed": (graphs.nearest_neighbors, {"k": 3, "directed": True}, False),
    "influence": (graphs.sphere_of_influence, {}, False),
}

# Those without ties that are broken by coordinates, which a reflection reverses.
REFLECTED = {"gabriel", "open gabriel", "relative", "lunes", "circles", "influence"}


def surveys() -> dict[str, Floats]:
    random = np.random.default_rng(11)
    lattice = np.stack(np.meshgrid(np.arange(40.0), np.arange(40.0)), axis=-1).reshape(-1, 2)
    cells = np.stack(np.meshgrid(*[np.arange(9.0)] * 3), axis=-1).reshape(-1, 3)
    clusters = [random.normal(random.random(2), s, (700, 2)) for s in (1e-7, 1e-4, 0.1, 1)]
    return {
        "uniform": random.random((20_000, 2)),
        "lattice": lattice,
        "rounded": np.unique(random.random((4000, 2)).round(2), axis=0),
        "clusters": np.concatenate(clusters),
        "line": np.column_stack((np.arange(500.0), 3 * np.arange(500.0))),
        "uniform in 3-D": random.random((10_000, 3)),
        "cells": cells,
        "rounded in 3-D": np.unique(random.random((3000, 3)).round(1), axis=0),
        "plane": np.column_stack((lattice, lattice.sum(axis=1))),
    }


SURVEYS = surveys()
CASES = [
    pytest.param(name, survey, id=f"{name}-{survey}")
    for name, (_, _, flat) in ALL.items()
    for survey, points in SURVEYS.items()
    if points.shape[1] == 2 or not flat
]


def edges(name: str, points: Floats, **options: Any) -> NDArray[np.int32]:
    make, own, _ = ALL[name]
    return make(points, **own, **options).edges


def by_points(points: Floats, found: NDArray[np.int32], *, directed: bool) -> Any:
    """Edges by the lexicographic numbers of their points."""
    number = np.empty(len(points), dtype=np.int64)
    number[np.lexsort(points.T[::-1])] = np.arange(len(points))
    ends = number[found] if directed else np.sort(number[found], axis=1)
    return ends[np.lexsort(ends.T[::-1])].tolist()


@pytest.mark.parametrize(("name", "survey"), CASES)
@pytest.mark.sampled(14)
def test_the_order_of_rows_does_not_matter(name: str, survey: str) -> None:
    points, directed = SURVEYS[survey], name == "directed"
    expected = by_points(points, edges(name, points), directed=directed)
    assert expected
    mixed = np.random.default_rng(2).permutation(points)
    assert by_points(mixed, edges(name, mixed), directed=directed) == expected


@pytest.mark.parametrize(("name", "survey"), CASES)
@pytest.mark.deep(
    "gabriel-uniform in 3-D",
    "lunes-uniform in 3-D",
    "open gabriel-uniform in 3-D",
    "relative-uniform in 3-D",
)
@pytest.mark.sampled(13)
def test_units_and_threads_do_not_matter(name: str, survey: str) -> None:
    points = SURVEYS[survey]
    expected = edges(name, points, workers=1)
    for workers in (2, 5):
        assert np.array_equal(edges(name, points, workers=workers), expected)
    assert np.array_equal(edges(name, points * 2.0**-300), expected)
    if name in REFLECTED:
        assert np.array_equal(edges(name, -points * 2.0**40), expected)


@pytest.mark.parametrize("survey", SURVEYS)
@pytest.mark.deep("uniform", "uniform in 3-D")
def test_each_graph_is_inside_the_next(survey: str) -> None:
    points = SURVEYS[survey]

    def rows(name: str) -> set[tuple[int, int]]:
        return {(i, j) for i, j in edges(name, points).tolist()}

    relative, delaunay = rows("relative"), rows("delaunay")
    assert rows("tree") <= relative <= rows("lunes") <= rows("gabriel") <= delaunay
    assert rows("gabriel") <= rows("open gabriel")
    if points.shape[1] == 2:
        assert relative <= rows("urquhart") <= delaunay
        assert rows("circles") <= rows("gabriel")
    assert {(min(edge), max(edge)) for edge in rows("directed")} <= rows("nearest")


@pytest.mark.parametrize("survey", SURVEYS)
@pytest.mark.deep("uniform", "uniform in 3-D")
def test_the_beta_skeletons_shrink(survey: str) -> None:
    points = SURVEYS[survey]
    for kind in ("lune", "circle") if points.shape[1] == 2 else ("lune",):
        last = None
        for beta in (1, 1.2, 1.6, 2):
            for boundary in ("open", "closed"):
                found = graphs.beta_skeleton(points, beta, kind=kind, boundary=boundary)
                own = {(i, j) for i, j in found.edges.tolist()}
                assert last is None or own <= last
                last = own


def test_a_grid_has_the_edges_of_both_definitions() -> None:
    grid = [(x, y) for x in range(30) for y in range(30)]
    assert graphs.gabriel(grid).nedges == 1740
    assert graphs.gabriel(grid, boundary="open").nedges == 3422
    assert graphs.gabriel(np.add(grid, (5e6, 2e5))).nedges == 1740


def test_nearest_neighbors_are_those_of_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    for points in (SURVEYS["uniform"], SURVEYS["uniform in 3-D"], SURVEYS["clusters"]):
        _, near = spatial.cKDTree(points).query(points, 8)
        found = graphs.nearest_neighbors(points, 7, directed=True).edges[:, 1].reshape(-1, 7)
        assert np.array_equal(np.sort(near[:, 1:], axis=1), found)


def test_spheres_of_influence_are_those_of_scipy() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    for points in (SURVEYS["uniform"], SURVEYS["uniform in 3-D"], SURVEYS["clusters"]):
        tree = spatial.cKDTree(points)
        radius = tree.query(points, 2)[0][:, 1]
        if points is SURVEYS["clusters"]:
            near = np.stack(np.triu_indices(len(points), 1), axis=-1)
        else:
            near = tree.query_pairs(2 * radius.max(), output_type="ndarray")
        length = np.linalg.norm(points[near[:, 0]] - points[near[:, 1]], axis=1)
        expected = near[length <= radius[near].sum(axis=1)]
        expected = expected[np.lexsort(expected.T[::-1])]
        assert np.array_equal(graphs.sphere_of_influence(points).edges, expected)


def test_the_spanning_tree_is_as_short_as_that_of_scipy() -> None:
    csgraph = pytest.importorskip("scipy.sparse.csgraph")
    for points in (SURVEYS["uniform"], SURVEYS["uniform in 3-D"], SURVEYS["lattice"]):
        own = graphs.minimum_spanning_tree(points)
        other = csgraph.minimum_spanning_tree(graphs.delaunay_graph(points).to_csr())
        assert own.nedges == len(points) - 1
        assert own.lengths.sum() == pytest.approx(other.sum(), rel=1e-12)


def test_relative_neighbors_have_an_empty_lune() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = SURVEYS["uniform"]
    found = {(i, j) for i, j in graphs.relative_neighborhood(points).edges.tolist()}
    tree = spatial.cKDTree(points)
    for i, j in graphs.gabriel(points).edges.tolist():
        length = np.linalg.norm(points[i] - points[j])
        around = points[tree.query_ball_point((points[i] + points[j]) / 2, length)]
        far = np.maximum(*(np.linalg.norm(around - points[k], axis=1) for k in (i, j)))
        # The ends themselves are as far as the length.
        assert ((far < length * (1 - 1e-12)).sum() == 0) == ((i, j) in found)


def test_a_triangulation_gives_the_graph_of_its_points() -> None:
    import delone

    points = datasets.uniform(500)
    for mesh in (
        delone.Delaunay(points),
        delone.RegularTriangulation(points, points[:, 0]),
        delone.ConstrainedDelaunay(points, [(0, 1)]),
        delone.ConvexHull(points),
    ):
        for name, (make, options, _) in ALL.items():
            found = make(mesh, **options)
            assert np.array_equal(found.points, mesh.points)
            assert np.array_equal(found.edges, edges(name, mesh.points)), name
    solid = delone.Delaunay(datasets.uniform(300, ndim=3))
    assert np.array_equal(graphs.gabriel(solid).edges, graphs.gabriel(solid.points).edges)
