"""Alpha shapes: boundaries, polygons, components and holes, against independent counts."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
import shapely

import delone
from alpha_values import ball, lattice

_RING = np.array([(x, y) for x, y in product(range(-5, 6), repeat=2) if 8 < x * x + y * y < 27.0])
_SETS = {
    "random": np.random.default_rng(1).random((60, 2)),
    "lattice": lattice(5, 4),
    "ring": _RING.astype(float),
    "clusters": np.concatenate(
        [np.random.default_rng(k).normal(k * 4, 1, (25, 2)) for k in range(3)]
    ),
    "rounded": np.random.default_rng(6).random((80, 2)).round(1),
    "triangle": np.array([(0.0, 0), (4, 0), (0, 3)]),
}


@pytest.mark.parametrize("name", _SETS)
@pytest.mark.sampled(3)
def test_polygons_are_valid_for_every_alpha(name):
    complex = delone.AlphaComplex(_SETS[name])
    corners = complex.points[complex.simplices_of(2)]
    for alpha in (*complex.spectrum, np.inf):
        shape = complex.shape(alpha)
        polygons = shape.polygons()
        assert shapely.is_valid(polygons).all()
        assert len(polygons) == shape.nparts
        union = shapely.union_all(shapely.polygons(corners[shape.is_kept]))
        assert sum(shapely.area(polygons)) == pytest.approx(shape.area, rel=1e-12)
        assert union.area == pytest.approx(shape.area, rel=1e-9)
        if len(polygons):
            assert shapely.union_all(polygons).symmetric_difference(union).area < 1e-9
            assert sum(shapely.length(polygons)) == pytest.approx(shape.perimeter)
            rings = [ring for p in polygons for ring in (p.exterior, *p.interiors)]
            assert sum(len(ring.coords) - 1 for ring in rings) == len(shape.boundary)
            assert all(p.exterior.is_ccw for p in polygons)
            assert not any(ring.is_ccw for p in polygons for ring in p.interiors)
        holes = sum(len(p.interiors) for p in polygons)
        assert (holes == 0) == (shape.area == 0 or _rank(union) == 0)


def _rank(union):
    """Return the number of holes of a union of shapely."""
    return sum(len(p.interiors) for p in shapely.get_parts(union))


def test_touching_parts_and_pinched_rings():
    # Two triangles that touch in a point, and a ring closed by a point.
    bow = delone.AlphaComplex([(0, 0), (2, 1), (2, -1), (-2, 1), (-2, -1)]).shape(2)
    assert (bow.nparts, len(bow.polygons()), bow.is_manifold) == (2, 2, False)
    assert bow.polygons()[0].exterior.coords[0] == (-2, -1)
    points = _RING.astype(float)
    complex = delone.AlphaComplex(points)
    ring = complex.shape(0.5)
    assert [len(p.interiors) for p in ring.polygons()] == [1]
    assert ring.betti == (1, 1)


def test_polygons_are_sorted_and_have_their_own_holes():
    # The hole of the first part begins to the right of that of the second.
    below = lattice(11, 5)
    above = lattice(6, 5) + np.array((1, 10))
    parts = below[(below != (8, 2)).any(axis=1)], above[(above != (3, 12)).any(axis=1)]
    polygons = delone.AlphaComplex(np.concatenate(parts)).shape(0.5).polygons()
    assert [p.exterior.coords[0] for p in polygons] == [(0, 0), (1, 10)]
    assert [p.interiors[0].coords[0] for p in polygons] == [(7, 2), (2, 12)]
    # Two parts that begin at the same point, in any order of rows.
    points = np.array([(0, 0), (2, 1), (1, 2), (2, -1), (1, -2)])
    for seed in range(6):
        shuffled = points[np.random.default_rng(seed).permutation(5)]
        found = delone.AlphaComplex(shuffled).shape(1.5).polygons()
        assert [p.exterior.coords[:2] for p in found] == [
            [(0, 0), (1, -2)],
            [(0, 0), (2, 1)],
        ]


@pytest.mark.parametrize("name", _SETS)
def test_numbers_of_components_and_holes(name):
    complex = delone.AlphaComplex(_SETS[name])
    for alpha in complex.spectrum[::3]:
        shape = complex.shape(alpha)
        parts = _ncomponents(shape.simplices_of(0)[:, 0].tolist(), shape.simplices_of(1).tolist())
        sizes = [len(shape.simplices_of(k)) for k in range(3)]
        assert shape.euler_characteristic == sizes[0] - sizes[1] + sizes[2]
        assert shape.ncomponents == parts
        assert shape.betti == (parts, parts - shape.euler_characteristic)
    assert complex.shape(np.inf).betti == (1, 0)


def _ncomponents(vertices, edges):
    parts = {v: {v} for v in vertices}
    for a, b in edges:
        if parts[a] is not parts[b]:
            parts[a] |= parts[b]
            parts.update(dict.fromkeys(parts[a], parts[a]))
    return len({id(part) for part in parts.values()})


def test_voids_of_a_shell():
    # The corners of cubes on the surface of a larger one.
    grid = np.array(list(product(range(4), repeat=3)), dtype=float)
    surface = grid[((grid == 0) | (grid == 3)).any(axis=1)]
    complex = delone.AlphaComplex(surface)
    assert complex.shape(0).betti == (56, 0, 0)
    assert complex.shape(0.5).betti == (1, 0, 1)
    assert complex.shape(np.inf).betti == (1, 0, 0)
    whole = complex.shape(np.inf)
    assert (whole.volume, whole.area, whole.is_manifold) == (27.0, 54.0, True)
    # The hull has no gap without tetrahedra here: two layers of points around one.
    grid = np.array(list(product(range(6), repeat=3)), dtype=float)
    thick = delone.AlphaComplex(grid[((grid < 2) | (grid > 3)).any(axis=1)])
    assert thick.optimal(holes=True) == 0.75
    assert thick.optimal() == thick.values_of(3).max() > 0.75
    assert thick.shape(0.75).betti == (1, 0, 1)


@pytest.mark.parametrize("name", _SETS)
@pytest.mark.parametrize("holes", [False, True])
@pytest.mark.parametrize("components", [1, 2, 4])
def test_optimal_is_the_smallest_that_fits(name, components, holes):
    complex = delone.AlphaComplex(_SETS[name])
    corners = complex.points[complex.simplices_of(2)]

    def fits(alpha):
        is_kept = complex.values_of(2) <= alpha
        if len(np.unique(complex.simplices_of(2)[is_kept])) < len(complex.simplices_of(0)):
            return False
        shape = complex.shape(alpha)
        polygons = shape.polygons()
        whole = shapely.union_all(shapely.polygons(corners))
        rest = shapely.get_parts(whole.difference(shapely.union_all(polygons)))
        gaps = [p for p in rest if p.area > 1e-9 and p.intersection(whole.boundary).length < 1e-9]
        return len(polygons) <= components and (holes or not gaps)

    expected = next(alpha for alpha in np.unique(complex.values_of(2)) if fits(alpha))
    assert complex.optimal(components, holes=holes) == expected


def test_boundary_of_a_solid_is_closed():
    points = np.random.default_rng(2).random((200, 3))
    complex = delone.AlphaComplex(points)
    for alpha in np.quantile(complex.spectrum, [0.3, 0.6, 0.9, 1]):
        shape = complex.shape(alpha)
        faces = points[shape.boundary]
        # The divergence theorem, for faces that are counter-clockwise from outside.
        assert np.linalg.det(faces).sum() / 6 == pytest.approx(shape.volume)
        sides = shape.boundary[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        _, uses = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
        assert (uses % 2 == 0).all()
        if not (uses == 2).all():
            assert not shape.is_manifold
    assert complex.shape(np.inf).is_manifold


@pytest.mark.parametrize("weighted", [False, True])
@pytest.mark.parametrize("n", [1, 2, 7, 90])
@pytest.mark.deep("90-False", "90-True")
def test_complexes_on_the_torus(n, weighted):
    random = np.random.default_rng(n)
    points = (random.random((n, 2)) * 16).round(3 if n > 7 else 0) % 16
    points = np.unique(points, axis=0)
    weights = random.random(len(points)).round(2) * 4 if weighted else None
    complex = delone.AlphaComplex(points, weights, periodic=(16, 16))
    torus = complex.shape(np.inf)
    assert (torus.euler_characteristic, torus.betti) == (0, (1, 2, 1))
    assert torus.area == pytest.approx(256)
    assert len(torus.boundary) == 0
    mesh = delone.PeriodicDelaunay(points, (16, 16), weights=weights)
    heavy = [Fraction(0)] * len(points) if weights is None else list(map(Fraction, weights))
    copies = [
        ([Fraction(p[0]) + 16 * i, Fraction(p[1]) + 16 * j], w)
        for p, w in zip(points.tolist(), heavy, strict=True)
        for i, j in product((-3, -2, -1, 0, 1, 2, 3), repeat=2)
    ]
    for t, value in zip(range(len(mesh.simplices)), complex.values_of(2), strict=True):
        rows, moved = mesh.simplices[t], mesh.offsets[t]
        at = [
            [Fraction(points[r, k]) + 16 * int(o[k]) for k in range(2)]
            for r, o in zip(rows, moved, strict=True)
        ]
        assert value == float(ball(at, [heavy[r] for r in rows])[1])
    # Edges: own value if no copy is inside the ball, otherwise that of a triangle.
    for (a, b), moved, value in list(
        zip(complex.simplices_of(1), _moves(complex), complex.values_of(1), strict=True)
    )[:40]:
        ends = [
            [Fraction(points[a, k]) for k in range(2)],
            [Fraction(points[b, k]) + 16 * int(moved[k]) for k in range(2)],
        ]
        center, square = ball(ends, [heavy[a], heavy[b]])
        met = any(
            p not in ends and sum((x - y) ** 2 for x, y in zip(p, center, strict=True)) - w < square
            for p, w in copies
        )
        assert (value > float(square)) if met else (value == float(square))
    for (row,), value in zip(complex.simplices_of(0), complex.values_of(0), strict=True):
        center, square = ball([[Fraction(x) for x in points[row].tolist()]], [heavy[row]])
        met = any(
            p != center and sum((x - y) ** 2 for x, y in zip(p, center, strict=True)) - w < square
            for p, w in copies
        )
        assert (value > float(square)) if met else (value == float(square))
    with pytest.raises(delone.InputError, match="periodic"):
        torus.polygons()
    with pytest.raises(delone.InputError, match="periodic"):
        complex.to_gudhi()


def _moves(complex):
    """Return by how many periods the head of each edge of a periodic complex is moved."""
    mesh = complex._valued.periodic
    code = np.arange(mesh.partners.size)
    t, k = np.divmod(code[mesh.partners.ravel() < code], 3)
    return mesh.offsets[t, (k + 2) % 3] - mesh.offsets[t, (k + 1) % 3]


def test_a_strip_and_its_files(tmp_path):
    points = np.random.default_rng(0).random((20, 2))
    complex = delone.AlphaComplex(points, periodic=(1, None))
    assert complex.shape(np.inf).betti == (1, 1, 0)
    complex.save(tmp_path / "strip.npz")
    loaded = delone.AlphaComplex.load(tmp_path / "strip.npz")
    assert loaded.periods == (1.0, None)
    assert np.array_equal(loaded.values_of(1), complex.values_of(1))
    with pytest.raises(delone.DegenerateInputError):
        delone.AlphaComplex([(0, 0), (0.5, 0)], periodic=(1, None))
    with pytest.raises(delone.DegenerateInputError):
        delone.AlphaComplex(np.empty((0, 2)), periodic=(1, 1))


def test_without_an_outside_the_last_hole_is_filled_by_the_last_triangle():
    points = np.random.default_rng(5).random((60, 2))
    complex = delone.AlphaComplex(points, periodic=(1, 1))
    assert complex.optimal() == complex.values_of(2).max()
    assert complex.optimal(holes=True) < complex.optimal()
