"""Each kind of damage to a right triangulation is caught, by the sentence that names it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from delone import datasets
from delone.errors import DtypeError, InputError, ShapeError
from delone.reference import bowyer_watson, incircle
from delone.testing import assert_delaunay, same_triangles, triangle_set

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
POINT_SETS = {
    "uniform": datasets.uniform(60, seed=4),
    "lattice": datasets.grid(36, seed=4),
    "mixed exponents": datasets.mixed_exponents(30, seed=4),
    "duplicates": datasets.duplicates(60, seed=4),
}


def neighbors_of(triangles: np.ndarray) -> np.ndarray:
    left = {}
    for t, row in enumerate(triangles.tolist()):
        for k in range(3):
            left[row[k - 2], row[k - 1]] = t
    return np.array(
        [[left.get((row[k - 1], row[k - 2]), -1) for k in range(3)] for row in triangles.tolist()]
    )


@pytest.fixture(params=POINT_SETS)
def points(request: pytest.FixtureRequest) -> np.ndarray:
    return POINT_SETS[request.param]


@pytest.fixture
def triangles(points: np.ndarray) -> np.ndarray:
    return np.array(bowyer_watson(points))


def quads(triangles: np.ndarray) -> list[tuple[int, int, int, int, int, int]]:
    """Inner edges: triangles t, s and vertices u, v, p, q with t = uvp and s = vuq."""
    neighbors = neighbors_of(triangles)
    found = []
    for t, row in enumerate(triangles.tolist()):
        for k in range(3):
            s = int(neighbors[t, k])
            if s > t:
                u, v, p = row[k - 2], row[k - 1], row[k]
                q = next(w for w in triangles[s].tolist() if w not in (u, v))
                found.append((t, s, u, v, p, q))
    return found


def flipped(triangles: np.ndarray, quad: tuple[int, int, int, int, int, int]) -> np.ndarray:
    t, s, u, v, p, q = quad
    after = triangles.copy()
    after[t], after[s] = (p, u, q), (q, v, p)
    return after


def test_right_ones_pass(points: np.ndarray, triangles: np.ndarray) -> None:
    assert_delaunay(points, triangles, neighbors=neighbors_of(triangles))
    assert_delaunay(points.tolist(), triangles.tolist())
    assert_delaunay(points, triangles[::-1, [1, 2, 0]].astype(np.uint32))
    assert_delaunay(points, triangles, canonical=False)


def test_an_independent_triangulation_of_many_points_passes() -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = datasets.uniform(10_000, seed=9)
    qhull = spatial.Delaunay(points)
    assert_delaunay(points, qhull.simplices, neighbors=qhull.neighbors)


def test_every_flip_is_caught(points: np.ndarray, triangles: np.ndarray) -> None:
    for quad in quads(triangles):
        _, _, u, v, p, q = quad
        with pytest.raises(AssertionError):
            assert_delaunay(points, flipped(triangles, quad))
        if incircle(points[u], points[v], points[p], points[q]) == 0:
            assert_delaunay(points, flipped(triangles, quad), canonical=False)


def test_a_flip_is_named_by_its_edge() -> None:
    points = np.array([[0, 0], [2, -1], [4, 0], [2, 1]], dtype=float)
    assert_delaunay(points, [(0, 1, 3), (1, 2, 3)])
    sentence = r"1 edge is not locally Delaunay:\n  edge 0 \(0.0, 0.0\), 2 \(4.0, 0.0\) between"
    with pytest.raises(AssertionError, match=sentence):
        assert_delaunay(points, [(0, 1, 2), (0, 2, 3)])


def test_a_tie_is_named_by_its_edge() -> None:
    with pytest.raises(AssertionError, match=r"1 edge is not canonical.*\n  edge 1 .*, 3 .*"):
        assert_delaunay(SQUARE, [(0, 1, 3), (1, 2, 3)])


def test_every_dropped_triangle_is_caught(points: np.ndarray, triangles: np.ndarray) -> None:
    for t in range(len(triangles)):
        with pytest.raises(AssertionError, match=r"boundary|not a vertex"):
            assert_delaunay(points, np.delete(triangles, t, axis=0))


def test_every_turned_triangle_is_caught(points: np.ndarray, triangles: np.ndarray) -> None:
    for t in range(len(triangles)):
        damaged = triangles.copy()
        damaged[t] = damaged[t, ::-1]
        with pytest.raises(AssertionError, match=f"not counter-clockwise:\n  triangle {t}:"):
            assert_delaunay(points, damaged)


def test_every_doubled_triangle_is_caught(points: np.ndarray, triangles: np.ndarray) -> None:
    for t in range(len(triangles)):
        with pytest.raises(AssertionError, match="more than once"):
            assert_delaunay(points, np.vstack((triangles, triangles[t, [1, 2, 0]])))


@pytest.mark.deep("mixed exponents")
def test_every_broken_neighbor_is_caught(points: np.ndarray, triangles: np.ndarray) -> None:
    right = neighbors_of(triangles)
    for t in range(len(triangles)):
        for k in range(3):
            damaged = right.copy()
            damaged[t, k] = -1 if right[t, k] >= 0 else (t + 1) % len(triangles)
            with pytest.raises(AssertionError, match=f"wrong neighbors:\n  triangle {t}:"):
                assert_delaunay(points, triangles, neighbors=damaged)
    with pytest.raises(AssertionError, match="wrong neighbors"):
        assert_delaunay(points, triangles, neighbors=right[:, [1, 2, 0]])


@pytest.mark.deep("mixed exponents")
def test_every_omitted_point_is_caught(points: np.ndarray) -> None:
    _, first = np.unique(points, axis=0, return_index=True)
    for row in np.sort(first).tolist():
        rest = np.delete(np.arange(len(points)), np.flatnonzero((points == points[row]).all(1)))
        omitting = rest[np.array(bowyer_watson(points[rest]))]
        with pytest.raises(AssertionError, match=rf"not a vertex of any triangle:\n  {row} \("):
            assert_delaunay(points, omitting)


def test_a_later_duplicate_as_vertex_is_caught() -> None:
    points = np.vstack((SQUARE, SQUARE[2]))
    assert_delaunay(points, [(0, 1, 2), (0, 2, 3)])
    sentence = r"1 row is used .*:\n  4 \(1.0, 1.0\) repeats row 2"
    with pytest.raises(AssertionError, match=sentence):
        assert_delaunay(points, [(0, 1, 4), (0, 4, 3)])
    with pytest.raises(AssertionError, match="repeats row 2"):
        assert_delaunay(points, [(0, 1, 2), (0, 4, 3)])


def test_negative_zero_is_a_duplicate_of_zero() -> None:
    points = np.vstack((SQUARE, [[-0.0, -0.0]]))
    assert_delaunay(points, [(0, 1, 2), (0, 2, 3)])
    with pytest.raises(AssertionError, match="repeats row 0"):
        assert_delaunay(points, [(4, 1, 2), (4, 2, 3)])


def test_a_collinear_hull_point_must_be_a_vertex_of_the_hull() -> None:
    points = np.array([[0, 0], [2, 0], [1, 1], [1, 0]], dtype=float)
    assert_delaunay(points, [(0, 3, 2), (3, 1, 2)])
    with pytest.raises(AssertionError, match="not a vertex of any triangle:\n  3"):
        assert_delaunay(points, [(0, 1, 2)])
    with pytest.raises(AssertionError, match="counter-clockwise"):
        assert_delaunay(points, [(0, 1, 2), (0, 3, 1)])


def test_a_missing_ear_at_the_hull_is_caught() -> None:
    points = np.array([[0, 0], [4, 0], [4, 4], [0, 4], [2, 1]], dtype=float)
    right = np.array(bowyer_watson(points))
    ear = [t for t in range(len(right)) if set(right[t].tolist()) == {0, 1, 4}]
    with pytest.raises(AssertionError, match="edges are on the boundary, but not on the convex"):
        assert_delaunay(points, np.delete(right, ear, axis=0))


def test_overlapping_sheets_are_caught() -> None:
    """Every edge is used once in a direction and is Delaunay, and the plane is covered twice."""
    ring = datasets.circle(5, seed=None)
    sheet = [(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 0, 5)]
    points = np.vstack((ring, [[0.0, 0.0]]))
    assert_delaunay(points, sheet)
    star = [(a, b, 5) for a, b in pairwise((0, 2, 4, 1, 3, 0))]
    with pytest.raises(AssertionError, match="boundary"):
        assert_delaunay(points, star)


@pytest.mark.parametrize(
    ("simplices", "words"),
    [
        ([(0, 1, 4)], r"outside the rows 0 to 3:\n  triangle 0: \[0, 1, 4\]"),
        ([(0, 1, 2), (0, 2, -1)], "triangle 1"),
        ([(0.0, 1.0, 2.0)], "integers"),
        ([(0, 1, 2, 3)], "shape"),
        ([0, 1, 2], "shape"),
        ([], "not a vertex"),
    ],
)
def test_indices_are_checked(simplices: list[object], words: str) -> None:
    with pytest.raises(AssertionError, match=words):
        assert_delaunay(SQUARE, simplices)


@pytest.mark.parametrize(
    ("neighbors", "words"),
    [
        ([[1.0, -1.0, -1.0], [-1.0, -1.0, 0.0]], "integers"),
        ([[-1, 1, -1]], "shape"),
        ([], "shape"),
    ],
)
def test_neighbors_are_checked(neighbors: list[object], words: str) -> None:
    with pytest.raises(AssertionError, match=words):
        assert_delaunay(SQUARE, [(0, 1, 2), (0, 2, 3)], neighbors=neighbors)


def test_points_without_area_have_no_triangles(
    degenerate_case: tuple[str, np.ndarray, str, str],
) -> None:
    points = degenerate_case[1]
    assert_delaunay(points, np.empty((0, 3), int), neighbors=np.empty((0, 3), int))
    if len(points) >= 3:
        with pytest.raises(AssertionError, match="no area"):
            assert_delaunay(points, [(0, 1, 2)])


def test_bad_points_are_input_errors() -> None:
    with pytest.raises(InputError, match="NaN"):
        assert_delaunay([[0, 0], [1, np.nan], [0, 1]], [(0, 1, 2)])
    with pytest.raises(InputError, match="shape"):
        assert_delaunay(np.zeros((5, 4)), [(0, 1, 2)])


def test_triangle_set_and_same_triangles() -> None:
    triangles = [(0, 1, 2), (0, 2, 3)]
    assert triangle_set(triangles) == {(0, 1, 2), (0, 2, 3)}
    assert triangle_set(np.empty((0, 3), int)) == set()
    assert same_triangles(triangles, np.array([(3, 0, 2), (2, 0, 1)]))
    assert not same_triangles(triangles, [(0, 1, 2), (0, 3, 2)])
    assert not same_triangles(triangles, [(0, 1, 2)])
    assert not same_triangles(triangles, [(0, 1, 2), (0, 2, 3), (0, 2, 3)])


@given(st.permutations(range(8)), st.lists(st.integers(0, 2), min_size=8, max_size=8))
def test_triangle_set_forgets_order_and_rotation(order: list[int], turns: list[int]) -> None:
    triangles = np.array(bowyer_watson(datasets.uniform(8, seed=1)))[:8]
    order = [k for k in order if k < len(triangles)]
    turned = [np.roll(triangles[k], turn) for k, turn in zip(order, turns, strict=False)]
    assert same_triangles(triangles, turned)


def test_same_triangles_counts_them() -> None:
    one, two = (0, 1, 2), (0, 2, 3)
    assert same_triangles([one, two, one], [one, one, two])
    assert not same_triangles([one, two, one], [one, two, two])
    assert same_triangles([], np.empty((0, 3), dtype=np.int32))


@pytest.mark.parametrize(
    ("simplices", "error"),
    [
        ([(0.0, 1.0, 2.0)], DtypeError),
        ([(True, False, True)], DtypeError),
        ([("0", "1", "2")], DtypeError),
        ([0, 1, 2], ShapeError),
        ([(0, 1), (2, 3), (4, 5)], ShapeError),
        ([(0, 1, 2), (3, 4)], ShapeError),
        (np.empty((0, 2)), ShapeError),
        (7, ShapeError),
    ],
)
def test_what_is_no_array_of_triangles_is_refused(
    simplices: object, error: type[InputError]
) -> None:
    with pytest.raises(error, match="simplices"):
        triangle_set(simplices)  # type: ignore[arg-type]
    with pytest.raises(error, match=r"^b "):
        same_triangles([(0, 1, 2)], simplices)  # type: ignore[arg-type]
