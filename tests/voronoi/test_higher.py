"""Voronoi diagrams in four to eight dimensions, beside fractions and SciPy."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import Voronoi
from delone.compat import scipy as drop_in

SIZES = {4: 80, 5: 40, 6: 24, 7: 16, 8: 14}


def some(d: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((SIZES[d], d))


def grid(d: int, count: int) -> np.ndarray:
    return np.stack(np.meshgrid(*d * [range(count)]), axis=-1).reshape(-1, d).astype(float)


def eliminated(matrix: list[list[Fraction]]) -> tuple[list[list[Fraction]], list[int]]:
    """Rows in reduced form, and their pivots."""
    rows, pivots = [list(row) for row in matrix], []
    for k in range(len(rows[0]) if rows else 0):
        at = len(pivots)
        found = next((i for i in range(at, len(rows)) if rows[i][k]), None)
        if found is None:
            continue
        rows[at], rows[found] = rows[found], rows[at]
        rows[at] = [x / rows[at][k] for x in rows[at]]
        for i in range(len(rows)):
            if i != at:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[at], strict=True)]
        pivots.append(k)
    return rows, pivots


def rank(matrix: list[list[Fraction]]) -> int:
    return len(eliminated(matrix)[1])


def by_brute_force(points: Any) -> tuple[dict[frozenset[int], Any], dict[frozenset[int], Any]]:
    """Sites and centers of empty spheres; sites of ridges with their vertices, and -1 if open."""
    exact = [[Fraction(x) for x in point] for point in points.tolist()]
    d = len(exact[0])
    cells: dict[frozenset[int], Any] = {}
    for chosen in combinations(range(len(exact)), d + 1):
        matrix = [
            [*(2 * (x - y) for x, y in zip(exact[i], exact[chosen[0]], strict=True)),
             sum(x * x - y * y for x, y in zip(exact[i], exact[chosen[0]], strict=True))]
            for i in chosen[1:]
        ]  # fmt: skip
        rows, pivots = eliminated(matrix)
        if pivots != list(range(d)):
            continue
        center = [row[d] for row in rows]
        squares = [sum((x - c) ** 2 for x, c in zip(p, center, strict=True)) for p in exact]
        radius = squares[chosen[0]]
        if min(squares) == radius:
            cells[frozenset(i for i, s in enumerate(squares) if s == radius)] = center
    # Facets of the convex hull: outer normals, and the points on them.
    rays: dict[frozenset[int], Any] = {}
    for chosen in combinations(range(len(exact)), d):
        rows, pivots = eliminated(
            [[x - y for x, y in zip(exact[i], exact[chosen[0]], strict=True)] for i in chosen[1:]]
        )
        if len(pivots) < d - 1:
            continue
        free = next(k for k in range(d) if k not in pivots)
        normal = [Fraction(0)] * d
        normal[free] = Fraction(1)
        for row, k in zip(rows, pivots, strict=False):
            normal[k] = -row[free]
        heights = [
            sum(n * (x - y) for n, x, y in zip(normal, p, exact[chosen[0]], strict=True))
            for p in exact
        ]
        if min(heights) == 0 or max(heights) == 0:
            sign = 1 if max(heights) == 0 else -1
            flat = frozenset(i for i, h in enumerate(heights) if h == 0)
            rays[flat] = [sign * x for x in normal]
    ridges = {}
    for pair in map(frozenset, combinations(range(len(exact)), 2)):
        ends = [sites for sites in cells if pair <= sites]
        open_ = [ray for flat, ray in rays.items() if pair <= flat]
        if not ends:
            continue
        first = cells[ends[0]]
        spans = [[x - y for x, y in zip(cells[end], first, strict=True)] for end in ends[1:]]
        if rank(spans + open_) == d - 1:
            ridges[pair] = ({*ends}, bool(open_))
    return cells, ridges


@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("kind", ["lattice", "cube", "flat sides"])
@pytest.mark.sampled(9)
def test_the_diagram_is_that_of_fractions(seed: int, kind: str) -> None:
    rng = np.random.default_rng(seed)
    points = {
        "lattice": lambda: rng.integers(0, 3, (10, 4)),
        "cube": lambda: grid(4, 2)[rng.permutation(16)[:10]],
        "flat sides": lambda: np.vstack((grid(4, 2)[:7] * [1, 2, 1, 1], rng.random((3, 4)))),
    }[kind]()
    points = np.unique(points, axis=0).astype(float)
    if np.linalg.matrix_rank(points[1:] - points[0]) < 4:
        return
    points = points[rng.permutation(len(points))]
    cells, ridges = by_brute_force(points)
    diagram = Voronoi(points)
    assert {tuple(v) for v in diagram.vertices.round(12)} == {
        tuple(np.round([float(x) for x in center], 12)) for center in cells.values()
    }
    assert len(diagram.vertices) == len(cells)
    sites: dict[int, set[int]] = {}
    for site, region in enumerate(diagram.point_region.tolist()):
        for vertex in diagram.regions[region]:
            sites.setdefault(vertex, set()).add(site)
    assert {*map(frozenset, (s for v, s in sites.items() if v >= 0))} == {*cells}
    found = {}
    for pair, entries in zip(diagram.ridge_points.tolist(), diagram.ridge_vertices, strict=True):
        ends = {frozenset(sites[v]) for v in entries if v >= 0}
        assert entries == sorted(set(entries))
        found[frozenset(pair)] = (ends, -1 in entries)
    assert found == ridges
    hull = set(delone.Delaunay(points).hull.tolist())
    assert {i for i, r in enumerate(diagram.point_region) if -1 in diagram.regions[r]} == hull


@pytest.mark.parametrize("d", SIZES)
def test_in_general_position_it_is_that_of_scipy(d: int) -> None:
    spatial = pytest.importorskip("scipy.spatial")
    points = some(d)
    theirs = spatial.Voronoi(points)
    for ours in (Voronoi(points), drop_in.Voronoi(points)):
        distance, same = spatial.KDTree(ours.vertices).query(theirs.vertices)
        assert distance.max() < 1e-7
        assert sorted(same.tolist()) == list(range(len(ours.vertices)))
        names = [*same.tolist(), -1]
        mine = {
            frozenset(pair): {*entries}
            for pair, entries in zip(ours.ridge_points.tolist(), ours.ridge_vertices, strict=True)
        }
        for pair, entries in zip(theirs.ridge_points.tolist(), theirs.ridge_vertices, strict=True):
            assert mine.pop(frozenset(pair)) == {names[v] for v in entries}
        # Qhull leaves out what is open and has few vertices.
        assert all(-1 in entries and len(entries) < d for entries in mine.values())
        for i in range(len(points)):
            here = {*ours.regions[ours.point_region[i]]}
            assert here == {names[v] for v in theirs.regions[theirs.point_region[i]]}


@pytest.mark.parametrize(("d", "count"), [(4, 4), (5, 3), (6, 2), (8, 2)])
@pytest.mark.deep("8-2")
def test_a_grid_has_cubes_of_cells(d: int, count: int) -> None:
    diagram = Voronoi(grid(d, count) * np.arange(1, d + 1))
    assert len(diagram.vertices) == (count - 1) ** d
    assert len(diagram.ridge_points) == d * count ** (d - 1) * (count - 1)
    steps = np.abs(np.subtract(*diagram.points[diagram.ridge_points.T]))
    assert (np.count_nonzero(steps, axis=1) == 1).all()
    assert max(map(len, diagram.regions)) == (2**d if count > 3 else 2**d if count == 3 else 2)
    if count == 2:
        assert set(map(tuple, diagram.ridge_vertices)) == {(-1, 0)}


def test_points_that_miss_a_sphere_by_a_rounding_have_vertices_of_their_own() -> None:
    points = grid(4, 2)[:11]
    whole = Voronoi(points)
    assert len(whole.vertices) == 1
    points[5, 0] = np.nextafter(points[5, 0], 2)
    moved = Voronoi(points)
    assert len(moved.vertices) > 1
    # By fractions.
    cells, ridges = by_brute_force(points)
    assert len(moved.vertices) == len(cells)
    assert {*map(frozenset, moved.ridge_points.tolist())} == {*ridges}


def test_rows_in_another_order_and_scaled() -> None:
    points = np.random.default_rng(3).integers(0, 4, (70, 4)).astype(float)
    diagram = Voronoi(points)
    order = np.random.default_rng(4).permutation(70)
    for factor in (1.0, 2.0**300, 2.0**-300):
        other = Voronoi(points[order] * factor)
        assert len(other.vertices) == len(diagram.vertices)
        pairs = {frozenset(map(tuple, diagram.points[pair])) for pair in diagram.ridge_points}
        assert pairs == {
            frozenset(map(tuple, other.points[pair] / factor)) for pair in other.ridge_points
        }
        assert sorted(map(len, diagram.ridge_vertices)) == sorted(map(len, other.ridge_vertices))


def test_attributes_and_files(tmp_path: Path) -> None:
    points = np.vstack((some(5), some(5)[:2]))
    diagram = Voronoi(points)
    assert repr(diagram).startswith("<Voronoi of 42 points: ")
    assert diagram.ndim == 5 and diagram.clip is diagram.weights is diagram.periods is None
    assert diagram.duplicate_of[40:].tolist() == [0, 1]
    assert diagram.point_region[40] == diagram.point_region[0]
    assert len(diagram.hidden) == 0
    assert diagram.simplex_vertices.shape == (diagram.triangulation.nsimplex,)
    assert diagram.nearest(points).tolist() == diagram.duplicate_of.tolist()
    assert diagram.validate()
    pair, entries = next(iter(diagram.ridge_dict.items()))
    assert pair == tuple(diagram.ridge_points[0]) and entries == diagram.ridge_vertices[0]
    diagram.save(tmp_path / "diagram.npz")
    for other in (
        Voronoi.load(tmp_path / "diagram.npz"),
        pickle.loads(pickle.dumps(diagram)),
        copy.copy(diagram),
    ):
        np.testing.assert_array_equal(other.vertices, diagram.vertices)
        assert other.ridge_vertices == diagram.ridge_vertices
    for name in (
        "cell", "cell_areas", "cell_volumes", "cell_centroids", "neighbors", "plot", "polygons",
        "rays", "ridge_areas", "ridge_offsets", "thin_cells", "to_geopandas", "to_meshio",
        "to_pyvista",
    ):  # fmt: skip
        assert not hasattr(diagram, name), name
    with pytest.raises(AttributeError, match="cell_areas is only available in 2-D and 3-D"):
        _ = diagram.cell_areas


def test_what_is_refused() -> None:
    points = some(4)
    with pytest.raises(delone.InputError, match="clip"):
        Voronoi(points, clip="box")
    with pytest.raises(delone.InputError, match="weights"):
        Voronoi(points, weights=np.ones(len(points)))
    with pytest.raises(delone.InputError, match="periods"):
        Voronoi(points, periods=(1, 1))
    with pytest.raises(delone.ShapeError):
        Voronoi(np.ones((30, 9)))
    with pytest.raises(delone.DegenerateInputError):
        Voronoi(points * [1, 1, 1, 0])
    with pytest.raises(drop_in.DimensionError):
        drop_in.Voronoi(points, furthest_site=True)
    with pytest.raises(drop_in.QhullError):
        drop_in.Voronoi(points * [1, 1, 1, 0])
    with pytest.raises(drop_in.DimensionError):
        drop_in.Voronoi(np.ones((30, 9)))


def test_vertices_beyond_the_range_of_doubles_are_not_listed() -> None:
    points = np.vstack((np.zeros(4), np.eye(4) * 1e200, [[1e200, 1e200, 1e200, -1e-150]]))
    points[5] = [3e199, 3e199, 3.9e199, 1e199 * (1 - 2**-52)]
    diagram = Voronoi(points)
    assert np.isfinite(diagram.vertices).all()
    lost = diagram.simplex_vertices < 0
    assert lost.sum() == (~np.isfinite(diagram.triangulation.circumcenters).all(axis=1)).sum()
