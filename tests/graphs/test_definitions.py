"""Each graph against its definition, pair by pair in fractions, on inputs with many ties."""

from __future__ import annotations

from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np
import pytest

import proximity
from delone import Delaunay, graphs
from delone.errors import DegenerateInputError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

RANDOM = np.random.default_rng(5)


def circle(n: int) -> Floats:
    """Points of one circle with integer coordinates, and its center."""
    found = [(x, y) for x in range(-n, n + 1) for y in range(-n, n + 1) if x * x + y * y == n * n]
    return np.array([*found, (0, 0)], dtype=float)


def sphere(n: int) -> Floats:
    whole = range(-n, n + 1)
    return np.array([p for p in product(whole, repeat=3) if sum(x * x for x in p) == n * n], float)


def grid(*sizes: int) -> Floats:
    return np.array(list(product(*map(range, sizes))), dtype=float)


def hexagons(n: int) -> Floats:
    """A lattice whose rows are shifted: many equal distances."""
    return np.array([(2 * x + y % 2, 2 * y) for x, y in product(range(n), repeat=2)], dtype=float)


SETS: dict[str, Floats] = {
    "one": np.array([[3.0, 4.0]]),
    "two": np.array([[3.0, 4.0], [0.0, 0.0]]),
    "three": np.array([[0.0, 0], [2, 0], [1, 1]]),
    "one in 3-D": np.array([[3.0, 4.0, 5.0]]),
    "two in 3-D": np.array([[3.0, 4.0, 5.0], [0, 0, 0]]),
    "three in 3-D": np.array([[3.0, 4.0, 5.0], [0, 0, 0], [1, 0, 0]]),
    "line": np.array([(3 * x, 2 * x) for x in (5, 0, 1, 9, 2, 3)], dtype=float),
    "line in 3-D": np.array([(3 * x, 2 * x, -x) for x in (5, 0, 1, 9, 2, 3)], dtype=float),
    "grid": grid(5, 5),
    "flat grid": grid(2, 9),
    "hexagons": hexagons(5),
    "circle": circle(5),
    "large circle": circle(65)[:-1],
    "uniform": RANDOM.random((30, 2)),
    "clusters": np.concatenate(
        [RANDOM.normal(c, s, (9, 2)) for c, s in ((0, 1e-6), (1, 1e-3), (9, 1))]
    ),
    "small integers": np.unique(RANDOM.integers(0, 7, (30, 2)).astype(float), axis=0),
    "mixed exponents": np.ldexp(RANDOM.random((24, 2)) - 0.5, RANDOM.integers(-60, 60, (24, 2))),
    "wild exponents": np.ldexp(RANDOM.random((18, 2)) - 0.5, RANDOM.integers(-900, 900, (18, 2))),
    "subnormal": RANDOM.integers(0, 6, (15, 2)) * 5e-324,
    "huge": RANDOM.integers(-4, 5, (15, 2)) * 2.0**1021,
    "far away": grid(4, 4) / 8 + (5e6, 2e5),
    "almost a grid": grid(4, 4) + RANDOM.integers(-1, 2, (16, 2)) * 2.0**-50,
    "cubes": grid(3, 3, 3),
    "long cubes": grid(2, 2, 6),
    "octahedra": np.array([p for p in grid(3, 3, 3) if p.sum() % 2 == 0]),
    "sphere": sphere(3),
    "larger sphere": sphere(7),
    "uniform in 3-D": RANDOM.random((24, 3)),
    "small integers in 3-D": np.unique(RANDOM.integers(0, 4, (24, 3)).astype(float), axis=0),
    "plane": np.array([(x, y, 2 * x - y) for x, y in grid(4, 5)], dtype=float),
    "vertical plane": np.array([(x, x, y) for x, y in circle(5)], dtype=float),
    "mixed exponents in 3-D": np.ldexp(
        RANDOM.random((18, 3)) - 0.5, RANDOM.integers(-60, 60, (18, 3))
    ),
}
SETS = {name: np.unique(points, axis=0) for name, points in SETS.items()}
FLAT = [name for name, points in SETS.items() if points.shape[1] == 2]


def pairs(graph: graphs.Graph) -> set[tuple[int, int]]:
    """The edges, which must be in order and occur once."""
    assert graph.edges.dtype == np.int32
    rows = [tuple(row) for row in graph.edges.tolist()]
    assert rows == sorted(set(rows))
    assert graph.directed or all(i < j for i, j in rows)
    return set(rows)


@pytest.fixture(params=SETS)
def points(request: pytest.FixtureRequest) -> Floats:
    found: Floats = RANDOM.permutation(SETS[request.param])
    return found


@pytest.fixture(params=FLAT)
def flat(request: pytest.FixtureRequest) -> Floats:
    found: Floats = RANDOM.permutation(SETS[request.param])
    return found


@pytest.mark.parametrize("boundary", ["closed", "open"])
@pytest.mark.sampled(16)
def test_gabriel(points: Floats, boundary: str) -> None:
    expected = proximity.gabriel(proximity.exact(points), closed=boundary == "closed")
    assert pairs(graphs.gabriel(points, boundary=boundary)) == expected
    found = graphs.beta_skeleton(points, 1, boundary=boundary)
    assert pairs(found) == expected


@pytest.mark.sampled(11)
def test_relative_neighborhood(points: Floats) -> None:
    expected = proximity.relative_neighborhood(proximity.exact(points))
    assert pairs(graphs.relative_neighborhood(points)) == expected
    assert pairs(graphs.beta_skeleton(points, 2, boundary="open")) == expected


@pytest.mark.parametrize("boundary", ["closed", "open"])
@pytest.mark.parametrize("beta", [1 + 2**-52, 1.1, 1.25, 1.5, 2])
@pytest.mark.deep("larger sphere-*")
@pytest.mark.sampled(47)
def test_lunes(points: Floats, beta: float, boundary: str) -> None:
    expected = proximity.lunes(proximity.exact(points), beta, closed=boundary == "closed")
    assert pairs(graphs.beta_skeleton(points, beta, boundary=boundary)) == expected


@pytest.mark.parametrize("boundary", ["closed", "open"])
@pytest.mark.parametrize("beta", [1, 1 + 2**-52, 1.1, 1.25, 1.5, 2])
@pytest.mark.sampled(32)
def test_circles(flat: Floats, beta: float, boundary: str) -> None:
    expected = proximity.circles(proximity.exact(flat), beta, closed=boundary == "closed")
    found = graphs.beta_skeleton(flat, beta, kind="circle", boundary=boundary)
    assert pairs(found) == expected


def test_spanning_tree(points: Floats) -> None:
    found = graphs.minimum_spanning_tree(points)
    assert pairs(found) == proximity.spanning_tree(proximity.exact(points))
    assert found.ncomponents == 1
    assert found.nedges == len(points) - 1


def test_urquhart(flat: Floats) -> None:
    try:
        triangles = Delaunay(flat).simplices.tolist()
    except DegenerateInputError:
        expected = pairs(graphs.delaunay_graph(flat))
    else:
        expected = proximity.urquhart(proximity.exact(flat), triangles)
    assert pairs(graphs.urquhart(flat)) == expected


@pytest.mark.parametrize("k", [1, 2, 5, 11])
def test_nearest_neighbors(points: Floats, k: int) -> None:
    if k >= len(points):
        with pytest.raises(InputError, match="k"):
            graphs.nearest_neighbors(points, k)
        return
    expected = proximity.nearest(proximity.exact(points), k)
    directed = {(i, j) for i, near in enumerate(expected) for j in near}
    assert pairs(graphs.nearest_neighbors(points, k, directed=True)) == directed
    either = {(min(edge), max(edge)) for edge in directed}
    assert pairs(graphs.nearest_neighbors(points, k)) == either


@pytest.mark.parametrize("boundary", ["closed", "open"])
def test_sphere_of_influence(points: Floats, boundary: str) -> None:
    expected = proximity.influence(proximity.exact(points), closed=boundary == "closed")
    assert pairs(graphs.sphere_of_influence(points, boundary=boundary)) == expected


def test_delaunay_graph(points: Floats) -> None:
    found = pairs(graphs.delaunay_graph(points))
    try:
        assert found == {(i, j) for i, j in Delaunay(points).edges.tolist()}
    except DegenerateInputError as error:
        if error.plane is None:
            chain = error.chain.tolist()
            assert found == {(min(i, j), max(i, j)) for i, j in pairwise(chain)}
        else:
            sides = np.sort(error.plane.simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
            assert found == {(i, j) for i, j in sides.tolist()}
