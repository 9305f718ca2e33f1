"""Regular triangulations in four to eight dimensions."""

from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from scipy.spatial import ConvexHull

import delone
from delone import Delaunay, RegularTriangulation


def as_sets(simplices: np.ndarray) -> set[tuple[int, ...]]:
    return set(map(tuple, np.sort(simplices, axis=1).tolist()))


@pytest.mark.parametrize("d", [4, 5, 6, 8])
def test_it_is_the_lower_hull_of_lifted_points(d: int) -> None:
    random = np.random.default_rng(d)
    points, weights = random.random((40, d)), 0.3 * random.random(40)
    mesh = RegularTriangulation(points, weights)
    lifted = np.column_stack((points, (points**2).sum(axis=1) - weights))
    hull = ConvexHull(lifted)
    lower = hull.simplices[hull.equations[:, d] < 0]
    assert as_sets(mesh.simplices) == as_sets(lower)
    assert np.array_equal(mesh.hidden, np.setdiff1d(np.arange(40), lower))
    assert mesh.validate().ok
    assert str(mesh.validate()) == "a canonical regular triangulation"
    moved = RegularTriangulation(points, weights + 2.0**10, workers=1)
    # A constant changes the rounding of weights, which here is too small to matter.
    assert as_sets(moved.simplices) == as_sets(mesh.simplices)


def test_equal_weights_make_the_delaunay_triangulation() -> None:
    random = np.random.default_rng(0)
    points = random.integers(0, 4, (90, 4)).astype(float)
    plain = Delaunay(points)
    mesh = RegularTriangulation(points, np.full(90, 7.0))
    assert as_sets(mesh.simplices) == as_sets(plain.simplices)
    assert np.array_equal(mesh.duplicate_of, plain.duplicate_of)
    order = random.permutation(90)
    again = RegularTriangulation(points[order], np.full(90, 7.0))
    found = np.sort(points[order][again.simplices].view("f8,f8,f8,f8")[..., 0], axis=1)
    right = np.sort(points[mesh.simplices].view("f8,f8,f8,f8")[..., 0], axis=1)
    assert np.array_equal(np.unique(found, axis=0), np.unique(right, axis=0))


def test_the_heaviest_row_stands_for_its_point() -> None:
    random = np.random.default_rng(5)
    points = np.vstack((random.random((20, 4)), random.random((1, 4))))
    points = np.vstack((points, points[:5]))
    weights = np.zeros(len(points))
    weights[21:24] = 1e-3
    mesh = RegularTriangulation(points, weights)
    used = np.unique(mesh.simplices)
    assert {21, 22, 23} <= set(used.tolist())
    assert not {0, 1, 2} & set(used.tolist())
    assert {3, 4} <= set(used.tolist())
    assert mesh.validate().ok
    assert {0, 1, 2} <= set(mesh.hidden.tolist())
    assert mesh.duplicate_of[24:].tolist() == [3, 4]


def test_faults_are_named() -> None:
    random = np.random.default_rng(2)
    points, weights = random.random((50, 4)), 0.4 * random.random(50)
    mesh = RegularTriangulation(points, weights)
    assert mesh.hidden.size
    from delone.regular_validation import validate_regular

    topology = (mesh.simplices, mesh.neighbors, mesh._duplicates)
    heavy = weights.copy()
    heavy[mesh.hidden[0]] += 5
    report = validate_regular(points, heavy, *topology)
    assert report.hidden.tolist() == [mesh.hidden[0]]
    assert "hidden point should be a vertex" in str(report)
    light = weights.copy()
    light[mesh.simplices[0, 0]] -= 5
    assert not validate_regular(points, light, *topology).ok


def test_saving_location_and_errors(tmp_path) -> None:
    random = np.random.default_rng(3)
    points, weights = random.random((60, 5)), 0.1 * random.random(60)
    mesh = RegularTriangulation(points, weights)
    mesh.save(tmp_path / "mesh.npz")
    again = RegularTriangulation.load(tmp_path / "mesh.npz")
    assert np.array_equal(again.simplices, mesh.simplices)
    queries = random.dirichlet(np.ones(60), 30) @ points
    found = mesh.locate(queries)
    assert (found.simplex >= 0).all()
    at = (found.barycentric[:, :, None] * points[mesh.simplices[found.simplex]]).sum(axis=1)
    assert at == pytest.approx(queries, abs=1e-12)
    near = np.linalg.norm(points[None] - queries[:, None], axis=2)
    near[:, mesh.hidden] = np.inf
    assert np.array_equal(mesh.nearest(queries), near.argmin(axis=1))
    with pytest.raises(delone.DegenerateInputError, match="flat of dimension 4"):
        RegularTriangulation(points * [1, 1, 1, 1, 0], weights)
    with pytest.raises(delone.ShapeError):
        RegularTriangulation(random.random((60, 9)), weights)
    assert np.array_equal(delone.AlphaComplex(mesh).simplices, mesh.simplices)


def solved(rows: list[list[Fraction]]) -> list[Fraction]:
    """The solution of linear equations, each with its right side."""
    size = len(rows)
    for k in range(size):
        pivot = next(r for r in range(k, size) if rows[r][k])
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for r in range(size):
            if r != k and rows[r][k]:
                rows[r] = [x - rows[r][k] * y for x, y in zip(rows[r], rows[k], strict=True)]
    return [row[-1] for row in rows]


def test_weights_are_the_squares_of_a_column_that_is_left_out() -> None:
    # Compositions: five parts that add up to six.
    parts = [c for c in itertools.product(range(5), repeat=5) if sum(c) == 6]
    points = np.random.default_rng(0).permutation(np.array(parts, dtype=float))[:45]
    mesh = RegularTriangulation(points[:, :4], -(points[:, 4] ** 2))
    assert not len(mesh.hidden)
    exact = [[Fraction(x) for x in row] for row in points.tolist()]
    squares = [sum(x * x for x in row) for row in exact]
    for corners in mesh.simplices.tolist():
        # The center of the sphere through the corners that is in the flat of the points.
        base = corners[0]
        rows = [[Fraction(1)] * 5 + [Fraction(6)]]
        for corner in corners[1:]:
            way = [2 * (x - y) for x, y in zip(exact[corner], exact[base], strict=True)]
            rows.append([*way, squares[corner] - squares[base]])
        center = solved(rows)
        away = [sum((x - y) ** 2 for x, y in zip(row, center, strict=True)) for row in exact]
        assert min(away) == away[base] == away[corners[-1]]
    # Without the weights distances are others, and so are the simplices.
    assert as_sets(Delaunay(points[:, :4]).simplices) != as_sets(mesh.simplices)
