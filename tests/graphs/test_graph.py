"""The class Graph: arrays, files, changes, duplicates, degenerate sets, errors and exports."""

from __future__ import annotations

import math
import pickle
import zipfile
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import datasets, graphs
from delone.errors import DtypeError, FileFormatError, InputError, NonFiniteError, ShapeError
from delone.graphs import Graph

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

MAKE: dict[str, Callable[[Any], Graph]] = {
    "delaunay": graphs.delaunay_graph,
    "gabriel": graphs.gabriel,
    "open gabriel": lambda points: graphs.gabriel(points, boundary="open"),
    "relative": graphs.relative_neighborhood,
    "lunes": lambda points: graphs.beta_skeleton(points, 1.5),
    "tree": graphs.minimum_spanning_tree,
    "influence": graphs.sphere_of_influence,
}
FLAT = {
    "urquhart": graphs.urquhart,
    "circles": lambda points: graphs.beta_skeleton(points, 1.5, kind="circle"),
}
POINTS = np.array([(0, 0), (3, 4), (3, 0), (8, 8), (3, 4)], dtype=float)


def same(one: Graph, other: Graph) -> bool:
    names = ("points", "edges", "duplicates")
    arrays = all(np.array_equal(getattr(one, name), getattr(other, name)) for name in names)
    return arrays and (one.directed, one.kind) == (other.directed, other.kind)


def test_edges_are_normalized() -> None:
    graph = Graph(POINTS, [(2, 1), (0, 1), (1, 2), (3, 0)], kind="roads")
    assert graph.edges.tolist() == [[0, 1], [0, 3], [1, 2]]
    assert graph.edges.dtype == np.int32
    assert repr(graph) == "<Graph of 5 points (1 duplicate): roads, 3 edges, 1 component>"
    assert graph.lengths.tolist() == [5, 128**0.5, 4]
    assert graph.squared_lengths.tolist() == [25, 128, 16]
    assert graph.degrees.tolist() == [2, 2, 1, 1, 0]
    assert graph.duplicates.tolist() == [[4, 1]]
    assert graph.duplicate_of.tolist() == [0, 1, 2, 3, 1]
    directed = Graph(POINTS, [(2, 1), (0, 1), (1, 2), (2, 1)], directed=True)
    assert directed.edges.tolist() == [[0, 1], [1, 2], [2, 1]]
    assert directed.degrees.tolist() == [1, 1, 1, 0, 0]
    assert (graph.npoints, graph.nedges, graph.ndim) == (5, 3, 2)


def test_nothing_can_be_changed() -> None:
    own, rows = POINTS.copy(), np.array([(0, 1)])
    graph = Graph(own, rows)
    own[:], rows[:] = 7, 3
    assert graph.points[1].tolist() == [3, 4]
    assert graph.edges.tolist() == [[0, 1]]
    for name in ("points", "edges", "duplicates", "lengths", "squared_lengths", "degrees"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(graph, name)[...] = 0
    with pytest.raises(AttributeError):
        graph.edges = rows  # type: ignore[misc]


@pytest.mark.parametrize(
    ("points", "edges", "error", "words"),
    [
        (POINTS, [(0, 5)], InputError, "outside 0 to 4"),
        (POINTS, [(-1, 2)], InputError, "outside 0 to 4"),
        (POINTS, [(0, 1), (2, 2)], InputError, "rows 1 join"),
        (POINTS, [(0.0, 1.0)], DtypeError, "integers"),
        (POINTS, [(0, 1, 2)], ShapeError, "shape"),
        ([(0, 0, 0, 0)], [], ShapeError, "shape"),
        ([(0, np.nan), (1, 1)], [], NonFiniteError, "NaN"),
    ],
)
def test_what_is_refused(points: Any, edges: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        Graph(points, edges)


def test_arguments_state_their_ranges() -> None:
    points = datasets.uniform(20)
    for beta in (0.999, 2.0000001, float("nan"), -1):
        with pytest.raises(InputError, match="from 1 to 2"):
            graphs.beta_skeleton(points, beta)
    with pytest.raises(DtypeError, match="beta"):
        graphs.beta_skeleton(points, "1.5")  # type: ignore[arg-type]
    for k, words in ((0, "at least 1"), (-1, "at least 1"), (20, "from 1 to 19"), (21, "from 1")):
        with pytest.raises(InputError, match=words):
            graphs.nearest_neighbors(points, k)
    with pytest.raises(InputError, match="from 1 to 19"):
        graphs.nearest_neighbors(np.concatenate((points, points)), 20)
    with pytest.raises(InputError, match="2-D"):
        graphs.beta_skeleton(datasets.uniform(20, ndim=3), 1.5, kind="circle")
    with pytest.raises(InputError, match="2-D"):
        graphs.urquhart(delone.Delaunay(datasets.uniform(20, ndim=3)))
    with pytest.raises(ShapeError, match=r"\(n, 2\)"):
        graphs.urquhart(datasets.uniform(20, ndim=3))
    with pytest.raises(InputError, match="'closed', 'open'"):
        graphs.gabriel(points, boundary="half")
    with pytest.raises(InputError, match="periodic"):
        graphs.gabriel(delone.PeriodicDelaunay(points, (2, 2)))
    with pytest.raises(NonFiniteError):
        graphs.nearest_neighbors([(0, 0), (np.inf, 1)], 1)
    with pytest.raises(InputError, match="workers"):
        graphs.gabriel(points, workers=0)


def test_degrees_are_warned_of() -> None:
    survey = datasets.baja()
    for make in (graphs.minimum_spanning_tree, graphs.sphere_of_influence):
        with pytest.warns(delone.GeographicWarning):
            make(survey)
        make(survey, planar=True)


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("name", [*MAKE, *FLAT])
def test_few_and_equal_points_have_graphs(name: str, ndim: int) -> None:
    if name in FLAT and ndim == 3:
        return
    make = (MAKE | FLAT)[name]
    empty = make(np.empty((0, ndim)))
    assert (empty.nedges, empty.ncomponents) == (0, 0)
    one = make(np.ones((1, ndim)))
    assert (one.nedges, one.ncomponents) == (0, 1)
    equal = make(np.ones((4, ndim)))
    assert (equal.nedges, equal.ncomponents) == (0, 1)
    assert equal.duplicates.tolist() == [[1, 0], [2, 0], [3, 0]]
    two = make(np.array([[5.0] * ndim, [0.0] * ndim, [5.0] * ndim]))
    assert two.edges.tolist() == [[0, 1]]
    assert two.duplicates.tolist() == [[2, 0]]
    assert two.components().tolist() == [0, 0, 0]


@pytest.mark.parametrize("name", [*MAKE, *FLAT])
def test_duplicates_have_no_edges_and_change_none(name: str) -> None:
    make = (MAKE | FLAT)[name]
    points = np.random.default_rng(4).integers(0, 9, (60, 2)).astype(float)
    distinct, first = np.unique(points, axis=0, return_index=True)
    order = np.sort(first)
    found, expected = make(points), make(points[order])
    assert np.array_equal(found.edges, order[expected.edges])
    assert len(found.duplicates) == 60 - len(distinct) > 5
    assert (found.degrees[found.duplicates[:, 0]] == 0).all()
    again = np.array([i for i in range(60) if i not in order])
    assert np.array_equal(found.duplicates[:, 0], again)
    assert np.array_equal(points[found.duplicates[:, 1]], points[again])


def test_duplicates_can_be_joined() -> None:
    points = [(0, 0), (1, 0), (0, 0), (1, 0), (0, 0), (5, 5)]
    graph = Graph(points, [(0, 1), (1, 5)])
    star = graph.with_duplicates()
    assert star.edges.tolist() == [[0, 1], [0, 2], [0, 4], [1, 3], [1, 5]]
    assert star.ncomponents == 1
    found = {(i, j) for i, j in graph.with_duplicates("clique").edges.tolist()}
    zero, one = (0, 2, 4), (1, 3)
    expected = {(min(i, j), max(i, j)) for i in zero for j in one} | {(1, 5), (3, 5)}
    assert found == expected | {(0, 2), (0, 4), (2, 4), (1, 3)}
    directed = Graph(points, [(1, 0)], directed=True)
    assert directed.with_duplicates().edges.tolist() == sorted(
        [[1, 0], [0, 2], [2, 0], [0, 4], [4, 0], [1, 3], [3, 1]]
    )
    assert graph.subgraph([0, 1, 5]).with_duplicates() is not None
    with pytest.raises(InputError, match="star"):
        graph.with_duplicates("chain")


def test_pruning_is_exact() -> None:
    # Lengths just below, at and above 0.1, which is no double and whose square is rounded.
    ends = [np.nextafter(0.1, 0), 0.1, np.nextafter(0.1, 1)]
    points = [(0, 0), *((x, 0) for x in ends), (0.06, 0.08), (0.08, 0.06)]
    graph = Graph(points, [(0, i) for i in range(1, 6)])
    expected = [
        [0, i]
        for i, (x, y) in enumerate(points[1:], 1)
        if Fraction(x) ** 2 + Fraction(y) ** 2 <= Fraction(0.1) ** 2
    ]
    assert graph.prune(max_length=0.1).edges.tolist() == expected
    assert len(expected) in (2, 3, 4)
    assert graph.prune(max_length=float("inf")).nedges == 5
    assert graph.prune(max_length=0).nedges == 0
    tree = graphs.minimum_spanning_tree(datasets.uniform(1000))
    assert tree.prune(percentile=100).nedges == 999
    assert tree.prune(percentile=50).nedges == 500
    assert tree.prune(percentile=1e-9).nedges == 1
    assert tree.prune(percentile=95).ncomponents == 50
    grid = graphs.gabriel([(x, y) for x in range(5) for y in range(5)], boundary="open")
    assert grid.prune(percentile=1).nedges == 40
    assert grid.prune(percentile=56).nedges == len(grid.edges)
    assert Graph(POINTS, []).prune(percentile=5).nedges == 0
    for options in ({}, {"max_length": 1, "percentile": 2}):
        with pytest.raises(InputError, match="one of"):
            graph.prune(**options)
    for wrong in (-1, float("nan")):
        with pytest.raises(InputError, match="at least 0"):
            graph.prune(max_length=wrong)
    for wrong in (0, 100.1, float("nan")):
        with pytest.raises(InputError, match="above 0 and at most 100"):
            graph.prune(percentile=wrong)


def test_components_are_those_of_a_search() -> None:
    random = np.random.default_rng(8)
    points = random.integers(0, 40, (300, 2)).astype(float)
    tree = graphs.minimum_spanning_tree(points).prune(percentile=80)
    labels = tree.components()
    near: dict[int, set[int]] = {i: set() for i in range(300)}
    for i, j in np.concatenate((tree.edges, tree.duplicates)).tolist():
        near[i].add(j)
        near[j].add(i)
    found, count = [-1] * 300, 0
    for row in range(300):
        if found[row] >= 0:
            continue
        open_rows = [row]
        while open_rows:
            at = open_rows.pop()
            if found[at] < 0:
                found[at] = count
                open_rows.extend(near[at])
        count += 1
    assert labels.tolist() == found
    assert tree.ncomponents == count > 3


def test_subgraphs_keep_the_edges_between_their_points() -> None:
    points = datasets.uniform(200)
    graph = graphs.gabriel(points)
    rows = np.random.default_rng(1).permutation(200)[:90]
    found = graph.subgraph(rows)
    assert np.array_equal(found.points, points[rows])
    own = {(min(i, j), max(i, j)) for i, j in rows[found.edges].tolist()}
    inside = np.isin(graph.edges, rows).all(axis=1)
    assert own == {(i, j) for i, j in graph.edges[inside].tolist()}
    mask = np.isin(np.arange(200), rows)
    assert same(graph.subgraph(mask), graph.subgraph(np.sort(rows)))
    assert graph.subgraph([]).npoints == 0
    directed = graphs.nearest_neighbors(points, 3, directed=True).subgraph(rows)
    assert directed.directed
    for wrong, error in (
        ([200], InputError),
        ([-1], InputError),
        ([1, 1], InputError),
        ([0.5], DtypeError),
        ([[1]], ShapeError),
        ([True], ShapeError),
    ):
        with pytest.raises(error, match="rows"):
            graph.subgraph(wrong)


def test_subgraphs_give_the_edges_to_the_first_of_equal_points() -> None:
    graph = Graph([(0, 0), (1, 0), (0, 0), (2, 0)], [(0, 1), (1, 3)])
    found = graph.subgraph([2, 1])
    assert (found.edges.tolist(), found.duplicates.tolist()) == ([[0, 1]], [])
    found = graph.subgraph([2, 0, 1])
    assert (found.edges.tolist(), found.duplicates.tolist()) == ([[0, 2]], [[1, 0]])
    star = graph.with_duplicates().subgraph([2, 0, 1])
    assert star.edges.tolist() == [[0, 1], [0, 2]]


@pytest.mark.parametrize("ndim", [2, 3])
def test_files_and_pickles(ndim: int, tmp_path: Path) -> None:
    points = np.concatenate((datasets.uniform(50, ndim=ndim), datasets.uniform(3, ndim=ndim)))
    for graph in (
        graphs.gabriel(points, workers=2),
        graphs.nearest_neighbors(points, 3, directed=True),
        Graph(points, []),
    ):
        graph.save(tmp_path / "a.npz")
        assert same(Graph.load(tmp_path / "a.npz"), graph)
        again = pickle.loads(pickle.dumps(graph))
        assert same(again, graph)
        assert again.workers == graph.workers
        assert not again.points.flags.writeable


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("edges", [[0, 9]]),
        ("edges", [[-1, 2]]),
        ("edges", [[1, 0]]),
        ("edges", [[1, 1]]),
        ("edges", [[1, 2], [0, 1]]),
        ("edges", [[0, 1], [0, 1]]),
        ("duplicates", [[2, 0]]),
        ("duplicates", [[4, 7]]),
        ("directed", []),
        ("points", [(0, 0), (3, 4), (3, 0), (8, np.nan), (3, 4)]),
    ],
)
def test_wrong_files_are_refused(name: str, value: Any, tmp_path: Path) -> None:
    graph = Graph(POINTS, [(0, 1), (1, 2)])
    arrays = graph._saved()
    dtype, columns = arrays[name].dtype, arrays[name].shape[1:]
    arrays[name] = np.array(value, dtype=dtype).reshape(-1, *columns)
    header = {"format": np.array("delone.graphs.Graph 2-D"), "version": np.array(1)}
    np.savez(tmp_path / "a.npz", **header, **arrays)
    with pytest.raises(FileFormatError):
        Graph.load(tmp_path / "a.npz")
    with zipfile.ZipFile(tmp_path / "a.npz") as archive:
        assert f"{name}.npy" in archive.namelist()


def test_sparse_matrices() -> None:
    pytest.importorskip("scipy")
    graph = Graph([(0, 0), (3, 4), (3, 0), (0, 0)], [(1, 2), (0, 2), (0, 3)])
    found = graph.to_csr()
    assert found.shape == (4, 4)
    assert found.has_sorted_indices
    assert found.toarray().tolist() == [[0, 0, 3, 0], [0, 0, 4, 0], [3, 4, 0, 0], [0, 0, 0, 0]]
    assert found.nnz == 6
    assert graph.to_csr(weights="binary").toarray().sum() == 6
    directed = Graph(POINTS, [(2, 1)], directed=True).to_csr()
    assert directed.toarray().nonzero()[0].tolist() == [2]
    with pytest.raises(InputError, match="binary"):
        graph.to_csr(weights="unit")


def test_networkx() -> None:
    networkx = pytest.importorskip("networkx")
    graph = graphs.minimum_spanning_tree(np.concatenate((datasets.uniform(50), POINTS)))
    found = graph.to_networkx()
    assert sorted(map(sorted, found.edges)) == graph.edges.tolist()
    assert found.number_of_nodes() == 55
    assert found.nodes[3]["pos"] == tuple(graph.points[3].tolist())
    assert networkx.number_connected_components(graph.with_duplicates().to_networkx()) == 1
    assert found.size("length") == pytest.approx(graph.lengths.sum())
    # Algorithms read weight by default: paths by length, not by the number of edges.
    assert found.size("weight") == found.size("length")
    bent = Graph([(0, 0), (9, 0), (1, 1), (2, 0)], [(0, 1), (0, 2), (2, 3), (3, 1)]).to_networkx()
    assert networkx.minimum_spanning_tree(bent).size("weight") == pytest.approx(7 + 2 * 2**0.5)
    assert graphs.nearest_neighbors(graph, 2, directed=True).to_networkx().is_directed()


def test_libpysal() -> None:
    pytest.importorskip("libpysal")
    graph = graphs.gabriel([(0, 0), (1, 0), (9, 9)])
    found = graph.to_libpysal()
    assert found.n == 3
    assert found.cardinalities.tolist() == graph.degrees.tolist()
    alone = Graph([(0, 0), (1, 0), (9, 9)], [(0, 1)]).to_libpysal(weights="length")
    assert alone.isolates.tolist() == [2]
    assert alone[0].to_dict() == {1: 1.0}
    points = [(0, 0), (1, 0), (0, 0), (3, 0)]
    graph = graphs.minimum_spanning_tree(points)
    with pytest.raises(InputError, match="1 row of points repeat others: 2; choose"):
        graph.to_libpysal()
    clique = graph.to_libpysal(coincident="clique")
    assert clique[0].index.tolist() == [1, 2]
    assert clique[2].index.tolist() == [0, 1]
    drop = graph.to_libpysal(coincident="drop")
    assert drop.unique_ids.tolist() == [0, 1, 3]
    assert drop[1].index.tolist() == [0, 3]


def test_the_gabriel_graph_of_libpysal_on_scattered_points() -> None:
    libpysal = pytest.importorskip("libpysal.graph")
    points = datasets.uniform(300)
    other = libpysal.Graph.build_triangulation(points, method="gabriel")
    assert graphs.gabriel(points).to_libpysal().equals(other) or (
        sorted(other.adjacency.index.tolist())
        == sorted(graphs.gabriel(points).to_libpysal().adjacency.index.tolist())
    )


def test_geopandas() -> None:
    pytest.importorskip("geopandas")
    graph = graphs.gabriel(datasets.uniform(30))
    frame = graph.to_geopandas(crs="EPSG:28992")
    assert frame.crs == "EPSG:28992"
    assert np.array_equal(frame[["v0", "v1"]].to_numpy(), graph.edges)
    assert np.allclose(frame.geometry.length, graph.lengths)
    assert np.array_equal(frame["length"].to_numpy(), graph.lengths)
    solid = graphs.minimum_spanning_tree(datasets.uniform(9, ndim=3)).to_geopandas()
    assert solid.geometry.has_z.all()


def test_plots() -> None:
    mpl = pytest.importorskip("matplotlib")
    mpl.use("Agg")
    graph = graphs.gabriel(datasets.uniform(30))
    ax = graph.plot(title="Gabriel")
    assert len(ax.collections[0].get_segments()) == graph.nedges
    ax = graph.plot(values=graph.lengths, vertices=False)
    assert np.array_equal(ax.collections[0].get_array(), graph.lengths)
    assert Graph([(1, 1)], []).plot() is not None
    with pytest.raises(InputError, match="options are"):
        graph.plot(shrink=1)
    with pytest.raises(InputError, match="nothing to draw"):
        Graph(np.empty((0, 2)), []).plot()
    with pytest.raises(ShapeError, match="values"):
        graph.plot(values=[1, 2])


def test_plots_in_space() -> None:
    pytest.importorskip("pyvista")
    graph = graphs.gabriel(datasets.uniform(30, ndim=3))
    plotter = graph.plot(values=graph.lengths, off_screen=True)
    assert len(plotter.actors) >= 2
    assert Graph([(1, 1, 1)], []).plot(off_screen=True) is not None


def exactly_kept(graph: Graph, percentile: float) -> int:
    """How many edges are not longer than the one at the rank, by fractions."""
    points = [[Fraction(x) for x in row] for row in graph.points.tolist()]
    squared = [
        sum((a - b) ** 2 for a, b in zip(points[i], points[j], strict=True))
        for i, j in graph.edges.tolist()
    ]
    rank = max(math.ceil(Fraction(percentile) / 100 * len(squared)), 1)
    limit = sorted(squared)[rank - 1]
    return sum(each <= limit for each in squared)


@pytest.mark.parametrize("scale", [1.0, 2.0**-1060, 2.0**1022])
@pytest.mark.parametrize("ndim", [2, 3])
def test_percentiles_rank_exact_lengths(scale: float, ndim: int) -> None:
    for seed in range(20):
        angles = np.random.default_rng(seed).random(8) * 2 * np.pi
        rim = np.column_stack((np.cos(angles), np.sin(angles), 0 * angles))[:, :ndim]
        # Spokes of almost the same length; in the largest doubles, with differences beyond them.
        center = np.where(np.arange(ndim) == 0, -0.5 if scale > 1 else 0.0, 0.0)
        points = np.vstack([center, rim]) * scale
        graph = Graph(points, [(0, k) for k in range(1, 9)])
        for percentile in (12.5, 25, 50, 75, 100):
            kept = graph.prune(percentile=percentile)
            assert kept.nedges == exactly_kept(graph, percentile)
    step = 2.0**-52
    close = Graph([(0, 0), (1, 1), (1, 1 + step)], [(0, 1), (0, 2)])
    assert close.prune(percentile=50).edges.tolist() == [[0, 1]]
