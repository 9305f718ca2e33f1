"""Alpha complexes in four and more dimensions, against fractions, the cube, and each other."""

from __future__ import annotations

from itertools import combinations, pairwise
from math import comb

import numpy as np
import pytest

import delone
from alpha_values import as_coordinates, lattice, listed, values

_RANDOM = np.random.default_rng(31)


def _near_sphere(n, d):
    points = _RANDOM.standard_normal((n, d))
    return points / np.linalg.norm(points, axis=1)[:, None]


_BOX = lattice(2, 2, 2, 2)
_SETS = {
    "random-4": _RANDOM.random((11, 4)),
    "random-5": _RANDOM.random((9, 5)),
    "random-6": _RANDOM.random((9, 6)),
    "grid-4": lattice(2, 2, 3, 2),
    "grid-5": lattice(2, 2, 2, 2, 2)[:20],
    "sphere-4": _near_sphere(11, 4),
    "cross-4": np.vstack((np.eye(4), -np.eye(4), np.zeros((1, 4)))),
    "cross-8": np.vstack((np.eye(8), -np.ones((1, 8)), np.full((1, 8), 0.25))),
    "mixed-4": _RANDOM.random((9, 4)) * 2.0 ** _RANDOM.integers(-90, 90, (9, 1)),
    "tiny-4": _RANDOM.random((8, 4)) * 2.0**-530,
    "huge-4": _RANDOM.random((8, 4)) * 2.0**500,
    "far-4": 1e6 + _RANDOM.random((10, 4)),
    "thin-4": _RANDOM.random((9, 4)) * (1, 1, 1, 1e-7),
    "thirds-4": lattice(2, 3, 2, 2) / 3.0,
    # Nearly a grid: differences are rounded, or are not; a double does not see the difference.
    "rounded-4": np.where(_BOX > 0, _BOX, _RANDOM.integers(-3, 4, _BOX.shape) * 2.0**-70),
    "exact-4": np.where(_BOX > 0, _BOX, _RANDOM.integers(-3, 4, _BOX.shape) * 2.0**-50),
}


def _weights(points):
    """Return weights about as large as the squared distances."""
    spread = float(np.ptp(points, axis=0).max())
    return np.random.default_rng(4).random(len(points)) * (spread * 0.4) ** 2


def _faces(simplices):
    return {
        face
        for simplex in simplices.tolist()
        for size in range(1, len(simplex) + 1)
        for face in combinations(sorted(simplex), size)
    }


@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
@pytest.mark.parametrize("name", _SETS)
def test_values_are_those_of_the_definition_rounded_once(name, weighted):
    points = _SETS[name]
    weights = _weights(points) if weighted else None
    complex = delone.AlphaComplex(points, weights)
    expected = values(points, complex.simplices, weights)
    found = listed(complex)
    assert found.keys() == expected.keys() == _faces(complex.simplices)
    for face, value in expected.items():
        try:
            rounded = float(value)
        except OverflowError:
            rounded = np.inf
        assert found[face] == rounded, face
    own = [value for face, value in found.items() if len(face) == 1]
    assert len({*own}) > 1 if weighted else not any(own)


@pytest.mark.parametrize("d", [4, 5, 6])
def test_a_cube_has_the_diagonals_of_its_faces(d):
    complex = delone.AlphaComplex(lattice(*[2] * d))
    # Each simplex is a path from corner to corner; a face with j of the axes has j / 4.
    for k in range(1, d + 1):
        corners = complex.points[complex.simplices_of(k)]
        axes = np.ptp(corners, axis=1).sum(axis=1)
        np.testing.assert_array_equal(complex.values_of(k), axes / 4)
    assert len(complex.simplices_of(1)) == sum(comb(d, j) * 2 ** (d - j) for j in range(1, d + 1))
    assert complex.spectrum.tolist() == [j / 4 for j in range(d + 1)]


@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
@pytest.mark.parametrize(("n", "d"), [(400, 4), (60, 5), (25, 6)])
def test_rows_scales_and_workers_change_nothing(n, d, weighted):
    points = np.random.default_rng(n).random((n, d)).round(3)
    weights = _weights(points) / 50 if weighted else None
    complex = delone.AlphaComplex(points, weights, workers=1)
    found = listed(complex)
    for face, value in found.items():
        for i in range(len(face)):
            rest = face[:i] + face[i + 1 :]
            assert not rest or found[rest] <= value
    # Euler's characteristic of a ball.
    counts = [len(complex.simplices_of(k)) for k in range(d + 1)]
    assert sum((-1) ** k * count for k, count in enumerate(counts)) == 1
    for k in range(d):
        rows = complex.simplices_of(k).tolist()
        assert all(one < other for one, other in pairwise(rows))
        assert all(row == sorted(row) for row in rows)
    shuffle = np.random.default_rng(3).permutation(n)
    moved = None if weights is None else weights[shuffle]
    other = delone.AlphaComplex(points[shuffle], moved, workers=3)
    assert as_coordinates(other, listed(other)) == as_coordinates(complex, found)
    scaled = delone.AlphaComplex(points * 0.5**9, None if weights is None else weights * 0.25**9)
    assert listed(scaled) == {face: value * 0.25**9 for face, value in found.items()}


def test_triangulations_files_and_attributes(tmp_path):
    points = np.random.default_rng(2).random((40, 4))
    weights = _weights(points) / 20
    for mesh, given in (
        (delone.Delaunay(points), None),
        (delone.RegularTriangulation(points, weights), weights),
    ):
        complex, plain = delone.AlphaComplex(mesh), delone.AlphaComplex(points, given)
        assert listed(complex) == listed(plain)
        assert np.array_equal(complex.simplices, mesh.simplices)
        assert complex.ndim == complex.dimension == 4
        complex.save(tmp_path / "complex.npz")
        assert listed(delone.AlphaComplex.load(tmp_path / "complex.npz")) == listed(plain)
        at = [complex.values_of(k)[i] for k, i in complex.order]
        assert at == sorted(at) and len(at) == len(listed(plain))
        # All simplices of the triangulation, for a convex shape without holes.
        assert complex.optimal() in complex.values_of(4)
        assert not hasattr(complex, "shape")
        with pytest.raises(AttributeError, match="only available in 2-D and 3-D"):
            complex.shape(1.0)
    assert repr(plain).startswith("<AlphaComplex of 40 points: ")
    assert "4-simplices>" in repr(plain)
    one = delone.AlphaComplex(np.vstack((np.zeros(4), np.eye(4))))
    assert repr(one) == (
        "<AlphaComplex of 5 points: 5 vertices, 10 edges, 10 triangles, 5 tetrahedra, 1 4-simplex>"
    )


def test_what_is_refused():
    flat = np.column_stack((_RANDOM.random((9, 3)), np.zeros(9)))
    for points in (flat, flat[:1], np.empty((0, 4))):
        for weights in (None, np.zeros(len(points))):
            with pytest.raises(delone.errors.DegenerateInputError):
                delone.AlphaComplex(points, weights)
    with pytest.raises(delone.errors.ShapeError):
        delone.AlphaComplex(_RANDOM.random((12, 9)))
    with pytest.raises(delone.errors.InputError, match="points are 4-D"):
        delone.AlphaComplex(_RANDOM.random((9, 4)), periodic=(1, 1))
    with pytest.raises(delone.errors.InputError, match="from 0 to 4"):
        delone.AlphaComplex(_RANDOM.random((9, 4))).values_of(5)


@pytest.mark.parametrize("weighted", [False, True], ids=["plain", "weighted"])
def test_gudhi_has_the_same(weighted):
    gudhi = pytest.importorskip("gudhi")
    points = np.random.default_rng(4).random((60, 4))
    weights = _weights(points) / 20 if weighted else None
    complex = delone.AlphaComplex(points, weights)
    theirs = gudhi.AlphaComplex(points=points, precision="exact", weights=weights)
    made = theirs.create_simplex_tree()  # which the iterator does not keep
    expected = {tuple(sorted(s)): v for s, v in made.get_filtration()}
    found = listed(complex)
    assert found.keys() == expected.keys()
    keys = sorted(found)
    np.testing.assert_allclose(
        [found[key] for key in keys], [expected[key] for key in keys], rtol=1e-14
    )
    tree = complex.to_gudhi()
    assert {tuple(s): v for s, v in tree.get_filtration()} == found
    assert not tree.make_filtration_non_decreasing()
