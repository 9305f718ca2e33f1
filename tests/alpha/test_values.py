"""Values of alpha complexes against fractions, GUDHI, and each other."""

from __future__ import annotations

import numpy as np
import pytest

import delone
from alpha_values import as_coordinates, ball, exact, lattice, listed, values

_RANDOM = np.random.default_rng(20)
_ANGLES = np.linspace(0, 2 * np.pi, 12, endpoint=False)
_SETS = {
    "random": _RANDOM.random((25, 2)),
    "lattice": lattice(5, 4),
    "circle": np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES))),
    "mixed": _RANDOM.random((12, 2)) * 2.0 ** _RANDOM.integers(-300, 300, (12, 1)),
    "tiny": _RANDOM.random((9, 2)) * 2.0**-530,
    "huge": _RANDOM.random((9, 2)) * 2.0**500,
    "far": 1e6 + _RANDOM.random((20, 2)),
    "thin": _RANDOM.random((15, 2)) * (1, 1e-9),
    "half": lattice(4, 3) + np.array((0.5, 1 / 3)),
    "collinear": np.column_stack((np.arange(6.0), 3 * np.arange(6.0))),
    "space": _RANDOM.random((14, 3)),
    "cubes": lattice(3, 3, 2),
    "space-mixed": _RANDOM.random((9, 3)) * 2.0 ** _RANDOM.integers(-90, 90, (9, 1)),
    "flat": np.column_stack((lattice(4, 3), lattice(4, 3).sum(axis=1))),
    "line": np.column_stack((np.arange(5.0), np.arange(5.0), -np.arange(5.0))),
    "sphere": np.array(
        [
            (x, y, z)
            for x in (-1, 0, 1)
            for y in (-1, 0, 1)
            for z in (-1, 0, 1)
            if abs(x) + abs(y) + abs(z) == 2
        ],
        dtype=float,
    ),
}


def _weights(points):
    """Return weights about as large as the squared distances."""
    spread = float(np.ptp(points, axis=0).max())
    return np.random.default_rng(4).random(len(points)) * (spread * 0.3) ** 2


@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
@pytest.mark.parametrize("name", _SETS)
def test_values_are_those_of_the_definition_rounded_once(name, weighted):
    points = _SETS[name]
    weights = _weights(points) if weighted else None
    complex = delone.AlphaComplex(points, weights)
    expected = values(points, complex.simplices_of(complex.dimension), weights)
    found = listed(complex)
    assert found.keys() == expected.keys()
    for face, value in expected.items():
        try:
            rounded = float(value)
        except OverflowError:
            rounded = np.inf
        assert found[face] == rounded, face


@pytest.mark.parametrize("n", [40, 300])
@pytest.mark.parametrize("ndim", [2, 3])
def test_no_face_exceeds_a_coface(ndim, n):
    points = np.random.default_rng(n).random((n, ndim)).round(2)
    for weights in (None, np.random.default_rng(1).random(n) * 0.01):
        found = listed(delone.AlphaComplex(points, weights))
        for face, value in found.items():
            for i in range(len(face)):
                rest = face[:i] + face[i + 1 :]
                assert not rest or found[rest] <= value


@pytest.mark.parametrize("name", ["random", "lattice", "circle", "space", "cubes", "flat", "line"])
@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
def test_rows_scales_and_workers_change_nothing(name, weighted):
    points = _SETS[name]
    weights = _weights(points) if weighted else None
    complex = delone.AlphaComplex(points, weights, workers=1)
    expected = as_coordinates(complex, listed(complex))
    shuffle = np.random.default_rng(3).permutation(len(points))
    moved = None if weights is None else weights[shuffle]
    other = delone.AlphaComplex(points[shuffle], moved, workers=3)
    assert as_coordinates(other, listed(other)) == expected
    assert len(other.order) == len(complex.order)
    for (k, i), (m, j) in zip(complex.order, other.order, strict=True):
        one, two = points[complex.simplices_of(k)[i]], other.points[other.simplices_of(m)[j]]
        assert sorted(one.tolist()) == sorted(two.tolist())
    for e in (-60, 9):
        scaled = delone.AlphaComplex(points * 2.0**e, None if weights is None else weights * 4.0**e)
        assert listed(scaled) == {f: v * 4.0**e for f, v in listed(complex).items()}


@pytest.mark.parametrize("ndim", [2, 3])
def test_many_tasks_are_as_one(ndim):
    # More simplices than in one task, of each kind; compared with those of parts of the space.
    points = np.random.default_rng(8).random((9000, ndim))
    one, many = (delone.AlphaComplex(points, workers=w) for w in (1, 3))
    for k in range(ndim + 1):
        assert np.array_equal(one.simplices_of(k), many.simplices_of(k))
        assert np.array_equal(one.values_of(k), many.values_of(k))
    at = exact(points)
    for k in range(1, ndim + 1):
        rows, values_ = one.simplices_of(k), one.values_of(k)
        for i in np.random.default_rng(k).choice(len(rows), 60, replace=False):
            _, square = ball([at[j] for j in rows[i]], [0] * (k + 1))
            assert values_[i] >= float(square)
            assert values_[i] == float(square) or k < ndim


@pytest.mark.parametrize("precision", ["exact"])
@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
@pytest.mark.parametrize("ndim", [2, 3])
def test_gudhi_has_the_same(ndim, weighted, precision):
    gudhi = pytest.importorskip("gudhi")
    points = np.random.default_rng(ndim).random((300, ndim))
    weights = np.random.default_rng(5).random(300) * 0.01 if weighted else None
    complex = delone.AlphaComplex(points, weights)
    theirs = gudhi.AlphaComplex(points=points, precision=precision, weights=weights)
    made = theirs.create_simplex_tree()  # which the iterator does not keep
    expected = {tuple(sorted(s)): v for s, v in made.get_filtration()}
    found = listed(complex)
    assert found.keys() == expected.keys()
    keys = sorted(found)
    np.testing.assert_allclose(
        [found[key] for key in keys], [expected[key] for key in keys], rtol=1e-15
    )
    tree = complex.to_gudhi()
    assert {tuple(s): v for s, v in tree.get_filtration()} == found
    assert not tree.make_filtration_non_decreasing()


def test_order_and_spectrum():
    complex = delone.AlphaComplex(lattice(4, 3))
    at = [complex.values_of(k)[i] for k, i in complex.order]
    assert at == sorted(at)
    assert len(complex.order) == sum(len(complex.simplices_of(k)) for k in range(3))
    place = {}
    for n, (k, i) in enumerate(complex.order):
        face = frozenset(complex.simplices_of(k)[i].tolist())
        place[face] = n
        assert all(place[face - {v}] < n for v in face if len(face) > 1)
    assert complex.spectrum.tolist() == [0.0, 0.25, 0.5]


def test_points_that_span_less():
    empty = delone.AlphaComplex(np.empty((0, 2)))
    assert (empty.dimension, len(empty.simplices_of(0)), len(empty.order)) == (-1, 0, 0)
    for points in ([(1, 2)], [(1, 2)] * 4, [(1, 2, 3)]):
        single = delone.AlphaComplex(points)
        assert (single.dimension, single.simplices_of(0).tolist()) == (0, [[0]])
        assert single.spectrum.tolist() == [0.0]
        assert single.optimal() == 0
        assert single.shape(0).boundary.shape == (0, single.ndim)
    pair = delone.AlphaComplex([(0, 0), (0, 6)])
    assert (pair.values_of(1).tolist(), pair.optimal()) == ([9.0], 9.0)
    path = delone.AlphaComplex([(2, 2), (0, 0), (6, 6), (0, 0)])
    assert path.simplices_of(1).tolist() == [[0, 1], [0, 2]]
    assert path.shape(2).ncomponents == 2
    assert path.shape(2).betti == (2, 0)
    assert path.shape(8).area == 0
    heavy = delone.AlphaComplex([(0, 0), (1, 0), (2, 0)], [0, -5, 0])
    assert (heavy.simplices_of(0).tolist(), heavy.simplices_of(1).tolist()) == (
        [[0], [2]],
        [[0, 2]],
    )
    flat = delone.AlphaComplex([(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])
    assert (flat.dimension, flat.values_of(2).tolist()) == (2, [0.5, 0.5])
    heavy = delone.AlphaComplex([(0, 0, 0), (1, 1, 1), (2, 2, 2), (1, 1, 1)], [0, -9, 0, 0])
    assert heavy.simplices_of(1).tolist() == [[0, 3], [2, 3]]


def test_wrong_input():
    with pytest.raises(delone.NonFiniteError):
        delone.AlphaComplex([(0, np.nan)])
    with pytest.raises(delone.ShapeError, match=r"\(3,\)"):
        delone.AlphaComplex([(0, 0), (1, 0), (0, 1)], [1, 2])
    complex = delone.AlphaComplex([(0, 0), (1, 0), (0, 1)])
    for alpha in (np.nan, -1e-300):
        with pytest.raises(delone.InputError, match="at least 0"):
            complex.shape(alpha)
    assert len(delone.AlphaComplex([(0, 0)], [4]).shape(-4).simplices_of(0)) == 1
    with pytest.raises(delone.InputError, match="not NaN"):
        delone.AlphaComplex([(0, 0)], [4]).shape(np.nan)
    with pytest.raises(delone.InputError, match="from 0 to 2"):
        complex.simplices_of(3)
    with pytest.raises(delone.InputError, match="at least 1"):
        complex.optimal(0)
    with pytest.raises(delone.InputError, match="no points"):
        delone.AlphaComplex(np.empty((0, 3))).optimal()
    with pytest.raises(delone.InputError, match="2-D"):
        delone.AlphaComplex(np.zeros((1, 3)), periodic=(1, 1))


def test_a_triangulation_is_used_as_it_is(tmp_path):
    points = _SETS["random"]
    mesh = delone.Delaunay(points)
    assert listed(delone.AlphaComplex(mesh)) == listed(delone.AlphaComplex(points))
    weights = _weights(points)
    regular = delone.RegularTriangulation(points, weights)
    weighted = delone.AlphaComplex(points, weights)
    assert listed(delone.AlphaComplex(regular)) == listed(weighted)
    weighted.save(tmp_path / "complex.npz")
    assert listed(delone.AlphaComplex.load(tmp_path / "complex.npz")) == listed(weighted)
