"""Diagrams of one and two sites, and of sites on one great circle."""

from __future__ import annotations

import pickle
from fractions import Fraction
from math import gcd
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import sphere

ALL = 4 * np.pi
EQUATOR = {"type": "Polygon", "coordinates": [[(0, 0), (90, 0), (180, 0), (270, 0)]]}
TWO = [
    [(0, 20), (0, -20)],
    [(0, 90), (0, -90)],
    [(10, 0), (-170, 0)],
    [(5, 5), (5, 5 + 1e-9)],
    [(123, 45), (124, 46)],
]


def exact(vector: Any) -> tuple[int, ...]:
    """The smallest integers in a direction."""
    parts = [Fraction(x) for x in vector]
    scale = max(part.denominator for part in parts)
    integers = [int(part * scale) for part in parts]
    common = gcd(*integers)
    return tuple(x // common for x in integers)


def closer(a: tuple[int, ...], b: tuple[int, ...], query: tuple[int, ...]) -> bool:
    """Whether the direction a is closer to a query than b, by squares of cosines."""
    x, y = (sum(p * q for p, q in zip(each, query, strict=True)) for each in (a, b))
    return x * abs(x) * sum(p * p for p in b) > y * abs(y) * sum(p * p for p in a)


def nearest(vectors: np.ndarray, queries: np.ndarray) -> list[int]:
    """The nearest site to each query, the smallest row of several, by integers."""
    sites = [exact(vector) for vector in vectors.tolist()]
    found = []
    for query in (exact(each) for each in queries.tolist()):
        best = 0
        for row in range(1, len(sites)):
            if closer(sites[row], sites[best], query):
                best = row
        found.append(best)
    return found


def test_one_site_has_the_whole_sphere(tmp_path: Path) -> None:
    diagram = sphere.Voronoi(lonlat=[(5, 60), (5, 60)], radius=2)
    assert diagram.triangulation is None
    assert diagram.cell_areas == pytest.approx([4 * ALL, 4 * ALL])
    assert diagram.vertices.shape == (0, 3)
    assert diagram.ridge_points.shape == diagram.ridge_vertices.shape == (0, 2)
    assert diagram.regions == [[]]
    assert diagram.point_region.tolist() == diagram.duplicate_of.tolist() == [0, 0]
    assert diagram.neighbors.indices.tolist() == []
    assert diagram.nearest([(0, 0), (185, -60), (np.nan, 0)]).tolist() == [0, 0, -1]
    assert diagram.polygons() == [[[]], [[]]]
    assert diagram.validate()
    table = diagram.to_geopandas()
    assert table.area.tolist() == [360 * 180] * 2
    diagram.save(tmp_path / "a.npz")
    for again in (sphere.Voronoi.load(tmp_path / "a.npz"), pickle.loads(pickle.dumps(diagram))):
        assert again.cell_areas.tolist() == diagram.cell_areas.tolist()
    diagram.plot(values=[1, 1])


@pytest.mark.parametrize("lonlat", TWO, ids=str)
def test_two_sites_have_a_hemisphere_each(
    lonlat: list[tuple[float, float]], tmp_path: Path
) -> None:
    diagram = sphere.Voronoi(lonlat=[*lonlat, lonlat[0]])
    assert diagram.cell_areas == pytest.approx([ALL / 2] * 3)
    assert diagram.duplicate_of.tolist() == [0, 1, 0]
    assert len(diagram.vertices) == 2
    assert np.allclose(diagram.vertices[0], -diagram.vertices[1])
    assert np.allclose(np.linalg.norm(diagram.vertices, axis=1), 1)
    # Vertices, and the middles of ridges, are equally far from both sites.
    a, b = diagram.points[:2]
    (ring,), (other,) = (cell[0] for cell in diagram.polygons()[:2])
    assert len(ring) == len(other) == 4
    corners = sphere.Voronoi(lonlat=ring).points
    assert np.abs(corners @ a - corners @ b).max() < 1e-15
    # Each ring runs around its own site.
    inner = np.cross(corners, np.roll(corners, -1, axis=0))
    away = a - b if np.linalg.norm(a - b) > 1e-6 else (-1, 1)[lonlat[0] > lonlat[1]] * (b - a)
    assert (inner @ away > 0).all()
    assert diagram.neighbors.indices.tolist() == [1, 0]
    assert diagram.neighbors.sizes == pytest.approx([2 * np.pi] * 2)
    assert diagram.ridge_lengths == pytest.approx([np.pi, np.pi])
    assert diagram.validate()
    assert diagram.to_geopandas().area.sum() == pytest.approx(360 * 180 * 1.5, rel=0.25)
    diagram.save(tmp_path / "a.npz")
    again = sphere.Voronoi.load(tmp_path / "a.npz")
    assert np.array_equal(again.vertices, diagram.vertices)
    diagram.plot(values=[1, 2, 1])


def test_no_site_is_refused() -> None:
    with pytest.raises(delone.DegenerateInputError):
        sphere.Voronoi(lonlat=np.empty((0, 2)))


@pytest.mark.parametrize("sites", [[(0, 50)], [(0, 50), (0, -50)], [(0, 0), (0, 1e-9)]])
@pytest.mark.parametrize("half", [EQUATOR, None])
def test_few_sites_are_clipped(sites: list[tuple[float, float]], half: Any) -> None:
    # Half the sphere, whose rim is the border of two of the cells, or a square on it.
    square = {"type": "Polygon", "coordinates": [[(-9, -9), (9, -9), (9, 9), (-9, 9)]]}
    diagram = sphere.Voronoi(lonlat=sites, clip=half or square)
    mesh = sphere.from_geometry(square)
    total = ALL / 2 if half else mesh.areas[mesh.polygon_of_simplex >= 0].sum()
    assert diagram.cell_areas.sum() == pytest.approx(total, rel=1e-12)
    if len(sites) == 1:
        return
    if half:
        # The border crosses the equator at half the sum of the latitudes.
        wedge = 2 * np.radians((sites[0][1] + sites[1][1]) / 2)
        expected = [ALL / 2, 0] if sites[1][1] < 0 else [wedge, ALL / 2 - wedge]
        assert diagram.cell_areas == pytest.approx(expected, rel=1e-9)
    else:
        assert diagram.cell_areas == pytest.approx([total / 2] * 2, rel=1e-6)
        assert diagram.neighbors.indices.tolist() == [1, 0]
        assert diagram.neighbors.sizes == pytest.approx([np.radians(18)] * 2, rel=0.02)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("count", [1, 2, 3, 9])
def test_the_nearest_is_that_of_integers(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    if seed % 2:
        # On one great circle, exactly; some of them next to each other.
        vectors = np.column_stack((rng.integers(-9, 10, (count, 2)), np.zeros(count)))
        vectors[vectors[:, :2].any(axis=1) == 0, 0] = 1
        steps = np.arange(count // 2) * 2.0**-52
        vectors[: count // 2] = vectors[0] + np.outer(steps, (1, 0, 0))
    else:
        near = rng.normal(size=3)
        vectors = np.outer(np.ones(count), near)[:2] + [[0, 0, 0], [2.0**-51, 0, 0]][:count]
    diagram = sphere.Voronoi(xyz=vectors)
    assert diagram.triangulation is None
    queries = np.concatenate((rng.integers(-5, 6, (60, 3)), rng.normal(size=(30, 3)), vectors))
    queries = queries[queries.any(axis=1)].astype(float)
    queries *= 2.0 ** rng.integers(-500, 500, (len(queries), 1))
    assert diagram.nearest(queries).tolist() == nearest(vectors, queries)
    assert diagram.nearest(vectors).tolist() == diagram.duplicate_of.tolist()


def test_directions_that_differ_by_less_than_a_rounding_are_two() -> None:
    vectors = [(1, 0, 0), (1, 2.0**-60, 0), (-1, 3, 0), (2, 2.0**-59, 0), (2, 0, 0)]
    diagram = sphere.Voronoi(xyz=vectors)
    assert diagram.duplicate_of.tolist() == [0, 1, 2, 1, 0]
    # Between the first two the border is next to them, and the rest of the circle is shared.
    turn = np.arctan2(3, -1)
    expected = [2 * np.pi - turn, turn, np.pi * 2]
    assert diagram.cell_areas[:3] == pytest.approx(expected, rel=1e-12)
    assert diagram.cell_areas.sum() - diagram.cell_areas[3:].sum() == pytest.approx(ALL)


@pytest.mark.parametrize("width", [1e-3, 1e-9, 1e-15])
def test_clusters_on_a_circle_share_the_sphere(width: float) -> None:
    angles = np.array([0, 0.3, 1.0]) * width
    vectors = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(3)))
    diagram = sphere.Voronoi(xyz=vectors)
    middle = width / 2
    expected = [2 * np.pi - 0.7 * width, 2 * middle, 2 * np.pi - 0.3 * width]
    assert diagram.cell_areas == pytest.approx(expected, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize(
    "lonlat",
    [
        [(0, 0), (20, 0), (100, 0)],
        [(0, 0), (120, 0), (240, 0)],
        [(70, -40), (70, 10), (70, 50), (70, 90)],
        [(0, 60), (90, 60), (180, 60), (270, 60)],
        [(0, 0), (90, 0), (0, 90)],
    ],
    ids=str,
)
def test_lunes_have_the_middles_of_their_ridges_as_corners(
    lonlat: list[tuple[float, float]],
) -> None:
    diagram = sphere.Voronoi(lonlat=lonlat)
    assert len(diagram.vertices) == 2
    for row, (rings,) in enumerate(diagram.polygons()):
        corners = sphere.Voronoi(lonlat=rings[0]).points
        assert len(corners) == 4
        # Not an arc is half a circle or more, and fans from the site have the area of the cell.
        ahead = np.roll(corners, -1, axis=0)
        assert (np.linalg.norm(corners - ahead, axis=1) < 1.5).all()
        site = diagram.points[row]
        triple = np.cross(corners, ahead) @ site
        cosines = (corners @ site) + (ahead @ site) + np.einsum("ij,ij->i", corners, ahead)
        area = 2 * np.arctan2(triple, 1 + cosines).sum()
        assert area == pytest.approx(diagram.cell_areas[row])
        # Corners are equally far from the site and a neighbor, and no other site is nearer.
        cosines = corners @ diagram.points.T
        assert np.allclose(cosines.max(axis=1), cosines[:, row])
        assert ((cosines > cosines[:, [row]] - 1e-12).sum(axis=1) > 1).all()


def test_the_axis_of_close_sites_on_a_great_circle_is_exact() -> None:
    a, b = np.array([3.0, 5, 7]), np.array([2.0, -1, 4])
    for bits, turned in ((12, 1), (30, 1), (30, -1), (48, 1)):
        # Small multiples of powers of two: the vectors are on one circle, exactly.
        sites = [a, a + b * 2.0**-bits, a + turned * b * 2.0 ** (1 - bits)]
        diagram = sphere.Voronoi(xyz=np.array(sites))
        assert diagram.triangulation is None
        normal = np.cross(a, b) / np.linalg.norm(np.cross(a, b))
        assert np.abs(np.abs(diagram.vertices) - np.abs(normal)).max() < 4e-16
        # Seen from the first vertex, the cells are in order around it.
        assert diagram.cell_areas.sum() == pytest.approx(ALL)
        for row, ring in enumerate(diagram.regions):
            assert sorted(ring) == [0, 1], row
