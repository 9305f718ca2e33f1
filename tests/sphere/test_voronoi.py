"""Voronoi diagrams of directions against brute force in integers, and known cells."""

from __future__ import annotations

import itertools
import pickle
import random

import numpy as np
import pytest

import delone
import directions as oracle
from delone import sphere

LATTICE = [v for v in itertools.product((-2, -1, 0, 1, 2), repeat=3) if any(v)]
AXES = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
CUBE = list(itertools.product((-1, 1), repeat=3))
RING = [v for v in LATTICE if v[2] == 0 and max(map(abs, v)) <= 1]
PHI = (1 + 5**0.5) / 2


def gauss(rng):
    return tuple(rng.gauss(0, 1) for _ in range(3))


def upper(v):
    return (*v[:2], abs(v[2]))


KINDS = {
    "lattice": lambda n, rng: rng.sample(LATTICE, n),
    "upper lattice": lambda n, rng: [upper(v) for v in rng.sample(LATTICE, n)],
    "ring and cap": lambda n, rng: RING + [(0, 0, 1)] + [upper(gauss(rng)) for _ in range(n % 3)],
    "part of a ring": lambda n, rng: [*RING[: n % 5 + 2], (1, 3, 5)],
    "cube": lambda n, rng: CUBE + rng.sample(AXES, n % 5),
    "scattered": lambda n, rng: [gauss(rng) for _ in range(n)],
    "hemisphere": lambda n, rng: [upper(gauss(rng)) for _ in range(n)],
    "parallel": lambda n, rng: [(x, y, 7) for x, y in rng.sample(OF_65, n)],
    "tight": lambda n, rng: (
        [(1.0 + 1e-15 * rng.randint(-9, 9), 0.0, 0.5) for _ in range(2)]
        + [(1.0, 1e-15 * rng.randint(-9, 9), 0.5 + 1e-15 * rng.randint(-9, 9)) for _ in range(n)]
    ),
}
# Integer points of a circle.
OF_65 = [(x, y) for x in range(-8, 9) for y in range(-8, 9) if x * x + y * y == 65]


def brute(vectors):
    """The sites around each vertex: those of each empty circle."""
    rows = sorted(set(oracle.firsts(vectors)))
    found = set()
    for triple in itertools.permutations(rows, 3):
        if triple[0] != min(triple):
            continue
        signs = {
            d: oracle.in_circle(*(vectors[v] for v in triple), vectors[d])
            for d in rows
            if d not in triple
        }
        if all(s <= 0 for s in signs.values()):
            found.add(frozenset(triple) | {d for d, s in signs.items() if s == 0})
    return found


def around(diagram):
    """The sites around each vertex, from the regions."""
    found = [set() for _ in diagram.vertices]
    for row, region in enumerate(diagram.point_region.tolist()):
        for vertex in diagram.regions[region]:
            found[vertex].add(int(diagram.duplicate_of[row]))
    return [frozenset(sites) for sites in found]


def check_arrays(diagram):
    """Ridges and regions have the same arcs; each vertex is equally far from its sites."""
    sites = [int(row) for row in np.unique(diagram.duplicate_of)]
    for v, rows in zip(diagram.vertices, around(diagram), strict=True):
        away = diagram.points[sorted(rows)] @ v
        assert np.ptp(away) < 1e-12
        assert (diagram.points @ v).max() < away[0] + 1e-12
    left = {row: [] for row in sites}
    pairs = diagram.ridge_points.tolist()
    for (a, b), (s, t) in zip(pairs, diagram.ridge_vertices.tolist(), strict=True):
        left[a].append((s, t))
        left[b].append((t, s))
    for row in sites:
        region = diagram.regions[diagram.point_region[row]]
        turned = [(s, t) for s, t in zip(region, region[1:] + region[:1], strict=True)]
        assert sorted(left[row]) == sorted(turned)
    assert len(diagram.vertices) - len(pairs) + len(sites) == 2
    assert diagram.cell_areas[sites].sum() == pytest.approx(4 * np.pi, rel=1e-9)


@pytest.mark.parametrize("kind", KINDS)
def test_vertices_are_the_empty_circles(kind):
    rng = random.Random(kind)
    found = 0
    for _ in range(12):
        vectors = KINDS[kind](rng.randint(4, 8), rng)
        whole = [oracle.whole(v) for v in vectors]
        if len(set(oracle.firsts(whole))) < 4:
            continue
        try:
            mesh = sphere.Delaunay(xyz=vectors)
        except delone.DegenerateInputError:
            continue
        found += 1
        diagram = sphere.Voronoi.from_delaunay(mesh)
        vertices = around(diagram)
        assert len(set(vertices)) == len(vertices) or len(vertices) == 2
        assert set(vertices) == brute(whole)
        if kind != "tight":
            check_arrays(diagram)
        # Another order of the rows.
        order = rng.sample(range(len(vectors)), len(vectors))
        again = sphere.Voronoi(xyz=[vectors[i] for i in order])
        firsts = [int(mesh.duplicate_of[i]) for i in order]
        assert {frozenset(firsts[v] for v in each) for each in around(again)} == set(vertices)
    assert found > 4


@pytest.mark.parametrize("half", [False, True])
def test_exact_symmetries_move_the_cells_along(half):
    rng = np.random.default_rng(3)
    vectors = rng.normal(size=(60, 3))
    if half:
        vectors[:, 0] = np.abs(vectors[:, 0])
    base = sphere.Voronoi(xyz=vectors)
    lengths = 2.0 ** rng.integers(-300, 300, size=60)[:, None]
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((-1.0, 1.0), repeat=3):
            moved = sphere.Voronoi(xyz=vectors[:, axes] * signs * lengths)
            assert set(around(moved)) == set(around(base))
            assert np.allclose(moved.cell_areas, base.cell_areas, rtol=1e-13, atol=0)


@pytest.mark.parametrize(
    ("vectors", "corners"),
    [
        ([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], 3),
        (AXES, 4),
        (CUBE, 3),
        ([np.roll((0, s, t * PHI), i) for s in (-1, 1) for t in (-1, 1) for i in range(3)], 5),
    ],
)
def test_cells_of_regular_solids(vectors, corners):
    diagram = sphere.Voronoi(xyz=np.array(vectors, dtype=float))
    assert {len(region) for region in diagram.regions} == {corners}
    assert diagram.cell_areas == pytest.approx(4 * np.pi / len(vectors), rel=1e-14)
    assert np.ptp(diagram.ridge_lengths) < 1e-14


def test_faces_of_the_cube_share_a_vertex_each():
    diagram = sphere.Voronoi(xyz=CUBE)
    assert sorted(diagram.vertices.round(15).tolist()) == sorted(map(list, AXES))
    assert len(diagram.ridge_points) == 12


def test_a_cell_beyond_a_hemisphere():
    # A ring around a pole, which the other pole sees from afar.
    turn = np.arange(50) * 2 * np.pi / 50
    ring = np.column_stack((np.cos(turn), np.sin(turn), np.full(50, 20.0)))
    diagram = sphere.Voronoi(xyz=np.vstack((ring, (0, 0, 1))), radius=2.0)
    cap = 2 * np.pi * (1 - np.cos(np.arctan2(1, 20) / 2)) * 4
    assert diagram.cell_areas[50] == pytest.approx(cap, rel=0.01)
    assert diagram.cell_areas[:50] == pytest.approx((16 * np.pi - diagram.cell_areas[50]) / 50)


def test_many_sites_in_one_hemisphere():
    rng = np.random.default_rng(4)
    turn = np.sort(rng.random(3000)) * 2 * np.pi
    ring = np.column_stack((np.cos(turn), np.sin(turn), 0.5 + 1e-9 * rng.random(3000)))
    for vectors in (ring, rng.normal(size=(3000, 3)) * (1, 1, 0) + (0, 0, 1)):
        diagram = sphere.Voronoi(xyz=vectors)
        assert len(diagram.vertices) == 2 * 3000 - 4
        assert diagram.cell_areas.sum() == pytest.approx(4 * np.pi, rel=1e-12)
        assert diagram.cell_areas.min() > 0
        away = np.einsum(
            "ij,ij->i", diagram.vertices[[r[0] for r in diagram.regions]], diagram.points
        )
        assert (
            away[:, None]
            > diagram.vertices[[r[0] for r in diagram.regions]] @ diagram.points[::7].T - 1e-9
        ).all()


@pytest.mark.parametrize("spacing", [1.0, 1e-3])
def test_areas_of_cells_at_any_spacing(spacing):
    # Near a point the sphere is as good as its plane, where cells have areas of their own.
    step = spacing / 6371e3
    i, j = np.meshgrid(np.arange(-4, 5), np.arange(-4, 5))
    grid = np.column_stack((np.ones(81), step * i.ravel(), step * j.ravel()))
    diagram = sphere.Voronoi(xyz=grid)
    inner = (np.abs(i) < 4).ravel() & (np.abs(j) < 4).ravel()
    assert diagram.cell_areas[inner] == pytest.approx(step**2, rel=1e-9)
    assert diagram.cell_areas.sum() == pytest.approx(4 * np.pi, rel=1e-12)


def test_three_sites_and_great_circles_have_lunes():
    diagram = sphere.Voronoi(xyz=[(1, 0, 0), (0, 1, 0), (0, 0, 1)])
    assert diagram.cell_areas == pytest.approx(4 * np.pi / 3)
    check_arrays(diagram)
    assert diagram.simplex_vertices.tolist() == [0]
    rng = random.Random(1)
    for lonlat in ([(0, 0), (20, 0), (100, 0)], [(70, b) for b in (-40, 10, 50, 90)]):
        rng.shuffle(lonlat)
        circle = sphere.Voronoi(lonlat=[*lonlat, lonlat[1]])
        assert circle.triangulation is None
        check_arrays(circle)
        assert circle.duplicate_of.tolist() == [*range(len(lonlat)), 1]
        assert circle.cell_areas[1] == circle.cell_areas[-1]
    areas = sphere.Voronoi(lonlat=[(0, 0), (20, 0), (100, 0)]).cell_areas
    assert np.degrees(areas) == pytest.approx([280, 100, 340])


def test_duplicates_share_a_cell():
    rng = np.random.default_rng(6)
    vectors = rng.normal(size=(40, 3))
    alone = sphere.Voronoi(xyz=vectors)
    diagram = sphere.Voronoi(xyz=np.vstack((vectors, 4 * vectors[5:9])))
    assert diagram.point_region.tolist() == [*range(40), 5, 6, 7, 8]
    assert np.allclose(diagram.cell_areas[:40], alone.cell_areas, rtol=1e-13)
    assert diagram.cell_areas[40:].tolist() == diagram.cell_areas[5:9].tolist()
    assert "4 duplicates" in repr(diagram)


def test_results_do_not_depend_on_the_number_of_threads():
    vectors = np.random.default_rng(7).normal(size=(20_000, 3))
    one, two = (sphere.Voronoi(xyz=vectors, workers=w) for w in (1, 2))
    for name in ("vertices", "ridge_points", "ridge_vertices", "cell_areas", "ridge_lengths"):
        assert np.array_equal(getattr(one, name), getattr(two, name))
    assert one.regions == two.regions
    indptr, indices, lengths = one.neighbors
    assert len(indices) == 2 * len(one.ridge_points)
    assert lengths.min() > 0
    assert np.array_equal(np.diff(indptr), np.diff(one.region_rows[0]))
    # Corners that are on no circle by chance: the areas of the dual triangles agree.
    mesh = one.triangulation
    assert len(one.simplex_vertices) == mesh.nsimplex
    assert np.allclose(one.vertices[one.simplex_vertices], mesh.circumcenters, atol=1e-15)


def test_pickles_and_arguments():
    for lonlat in ([(0, 0), (20, 0), (100, 0)], [(0, 0), (20, 0), (100, 0), (3, 60)]):
        diagram = sphere.Voronoi(lonlat=lonlat, radius=6371.0)
        again = pickle.loads(pickle.dumps(diagram))
        assert np.array_equal(again.cell_areas, diagram.cell_areas)
        assert again.regions == diagram.regions
    for radius in (0, -1, np.inf, np.nan):
        with pytest.raises(delone.InputError, match="radius"):
            sphere.Voronoi(lonlat=lonlat, radius=radius)
    with pytest.raises(delone.DtypeError, match="radius"):
        sphere.Voronoi(lonlat=lonlat, radius="one")
    with pytest.raises(delone.DtypeError, match=r"sphere\.Delaunay"):
        sphere.Voronoi.from_delaunay(delone.Delaunay([(0, 0), (1, 0), (0, 1)]))
    with pytest.raises(AttributeError):
        diagram.radius = 2.0
