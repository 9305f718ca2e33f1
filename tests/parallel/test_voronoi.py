"""Diagrams with more sites, ridges and cells than one task of any loop takes.

A cell is that of the diagram of its site and its neighbours alone, which is far smaller than a
task: so single cells are compared with those, and all of them with sums.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import PeriodicDelaunay, Voronoi, datasets

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray


def sample(count: int, *sizes: int) -> list[int]:
    """Rows on either side of where tasks begin, the last one, and some between."""
    edges = [
        row for size in sizes for start in range(size, count, size) for row in (start - 1, start)
    ]
    return sorted({0, *edges, count - 1, *range(77, count, count // 50)})


def alone(diagram: Voronoi, row: int, **options: Any) -> Voronoi:
    """The diagram of a site, which comes first, and its neighbours."""
    around = diagram.neighbors
    near = around.indices[around.indptr[row] : around.indptr[row + 1]]
    return Voronoi(diagram.points[[row, *near.tolist()]], **options)


def cells(diagram: Voronoi) -> Iterator[NDArray[np.int32]]:
    """The vertices of each cell, site by site."""
    starts, entries = diagram.region_rows
    listed = [entries[a:b] for a, b in pairwise(starts.tolist())]
    return (listed[region] for region in diagram.point_region.tolist())


@pytest.fixture(scope="module")
def plane() -> Voronoi:
    return Voronoi(datasets.uniform(20_000, seed=1), clip=(0, 0, 1, 1), workers=3)


def test_ridges_of_the_plane(plane: Voronoi) -> None:
    """Ends are as far from one site as from the other, and in the order that is promised."""
    points, ends = plane.points, np.array(plane.ridge_vertices)
    a, b = (points[plane.ridge_points[:, k]] for k in (0, 1))
    assert len(ends) > 2 * (1 << 14)
    for k in (0, 1):
        there = ends[:, k] >= 0
        place = plane.vertices[ends[there, k]]
        distances = [np.hypot(*(place - sites[there]).T) for sites in (a, b)]
        np.testing.assert_allclose(*distances, rtol=1e-9, atol=1e-12)
    there = (ends >= 0).all(axis=1)
    (ux, uy), (vx, vy) = (b - a)[there].T, np.diff(plane.vertices[ends[there]], axis=1)[:, 0].T
    length = np.hypot(ux, uy) * np.hypot(vx, vy)
    assert (ux * vy - uy * vx > 0.99 * length - 1e-12).all()


def test_cells_of_the_plane(plane: Voronoi) -> None:
    """Counter-clockwise, and the vertices are those of the ridges around."""
    of_ridges: list[set[int]] = [set() for _ in range(plane.npoints)]
    for sites, ends in zip(plane.ridge_points.tolist(), plane.ridge_vertices, strict=True):
        for site in sites:
            of_ridges[site] |= set(ends)
    checked = 0
    for row, corners in enumerate(cells(plane)):
        assert {max(v, -1) for v in corners.tolist()} == {max(v, -1) for v in of_ridges[row]}
        if corners.min() >= 0:
            x, y = plane.vertices[corners].T
            (dx, dy), (ex, ey) = ((np.roll(x, -k) - x, np.roll(y, -k) - y) for k in (1, 2))
            assert (dx * ey - dy * ex > -1e-12).all()
            checked += 1
    assert checked > 19_000


def test_measures_of_the_plane(plane: Voronoi) -> None:
    assert plane.cell_areas.sum() == pytest.approx(1, rel=1e-12)
    moments = (plane.cell_areas[:, None] * plane.cell_centroids).sum(axis=0)
    np.testing.assert_allclose(moments, [0.5, 0.5], rtol=1e-12)
    for row in sample(plane.npoints, 1 << 12, 1 << 13):
        one = alone(plane, row, clip=(0, 0, 1, 1))
        assert plane.cell_areas[row] == pytest.approx(one.cell_areas[0], rel=1e-9)
        assert plane.cell_perimeters[row] == pytest.approx(one.cell_perimeters[0], rel=1e-9)
        np.testing.assert_allclose(plane.cell_centroids[row], one.cell_centroids[0], rtol=1e-12)


def test_many_ties() -> None:
    """Every four sites share a vertex."""
    side = 110
    sites = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    diagram = Voronoi(sites.astype(float), workers=3)
    assert diagram.triangulation is not None
    assert diagram.triangulation.nsimplex > 1 << 14
    assert len(diagram.vertices) == (side - 1) ** 2
    assert len(diagram.ridge_points) == 2 * side * (side - 1)
    assert np.isfinite(diagram.cell_areas).sum() == (side - 2) ** 2
    assert (diagram.cell_areas[np.isfinite(diagram.cell_areas)] == 1).all()


def test_many_sites_on_a_torus() -> None:
    """As in the middle of nine copies."""
    points = datasets.uniform(1500, seed=4)
    diagram = Voronoi(points, periods=(1.0, 1.0), workers=3)
    assert isinstance(diagram.triangulation, PeriodicDelaunay)
    assert diagram.triangulation.nsimplex > 2 * (1 << 10)
    copies = np.concatenate([points + np.array((x, y)) for x in (0, -1, 1) for y in (0, -1, 1)])
    wanted = Voronoi(copies)
    np.testing.assert_allclose(diagram.cell_areas, wanted.cell_areas[:1500], rtol=1e-8)
    np.testing.assert_allclose(diagram.cell_perimeters, wanted.cell_perimeters[:1500], rtol=1e-8)
    assert diagram.cell_areas.sum() == pytest.approx(1, rel=1e-12)


BOX = (0, 0, 0, 1, 1, 1)


@pytest.fixture(scope="module")
def space() -> Voronoi:
    return Voronoi(datasets.uniform(6000, seed=2, ndim=3), clip=BOX, workers=3)


def test_ridges_of_space(space: Voronoi) -> None:
    """There is one between any two sites that are neighbours in the triangulation."""
    mesh = space.triangulation
    assert mesh is not None
    assert mesh.nsimplex > 2 * (1 << 14)
    found = np.unique(np.sort(space.ridge_points, axis=1), axis=0)
    assert len(found) == len(space.ridge_points)
    assert np.array_equal(found, np.unique(np.sort(mesh.edges, axis=1), axis=0))
    for (a, b), ends in zip(space.ridge_points.tolist(), space.ridge_vertices, strict=True):
        corners = space.vertices[[v for v in ends if v >= 0]]
        distances = [np.sqrt(((corners - space.points[s]) ** 2).sum(axis=1)) for s in (a, b)]
        assert np.abs(distances[0] - distances[1]).max() < 1e-9 * distances[0].max()


def test_cells_of_space(space: Voronoi) -> None:
    """The vertices of each are those of its ridges, each once."""
    of_ridges: list[set[int]] = [set() for _ in range(space.npoints)]
    for sites, ends in zip(space.ridge_points.tolist(), space.ridge_vertices, strict=True):
        for site in sites:
            of_ridges[site] |= set(ends)
    for row, corners in enumerate(cells(space)):
        assert corners.tolist() == sorted(of_ridges[row])


def test_measures_of_space(space: Voronoi) -> None:
    assert space.cell_volumes.sum() == pytest.approx(1, rel=1e-12)
    moments = (space.cell_volumes[:, None] * space.cell_centroids).sum(axis=0)
    np.testing.assert_allclose(moments, [0.5] * 3, rtol=1e-11)
    for row in sample(space.npoints, 1 << 10, 1 << 12):
        one = alone(space, row, clip=BOX)
        assert space.cell_volumes[row] == pytest.approx(one.cell_volumes[0], rel=1e-9)
        assert space.cell_areas[row] == pytest.approx(one.cell_areas[0], rel=1e-9)
        np.testing.assert_allclose(space.cell_centroids[row], one.cell_centroids[0], rtol=1e-11)


def test_whole_cells_of_space() -> None:
    """Without a clip: what is bounded has the measures of its site and neighbours alone."""
    diagram = Voronoi(datasets.uniform(6000, seed=2, ndim=3), workers=3)
    assert (np.isfinite(diagram.cell_volumes[1 << 12 :])).sum() > 1000
    for row in sample(diagram.npoints, 1 << 10, 1 << 12):
        one = alone(diagram, row)
        assert diagram.cell_volumes[row] == pytest.approx(one.cell_volumes[0], rel=1e-8)
        if np.isfinite(one.cell_volumes[0]):
            place = diagram.cell_centroids[row]
            np.testing.assert_allclose(place, one.cell_centroids[0], rtol=1e-9, atol=1e-9)
    ridges = np.arange(0, len(diagram.ridge_points), 997)
    for ridge in ridges.tolist():
        ends = diagram.ridge_vertices[ridge]
        if min(ends) >= 0:
            corners = diagram.vertices[ends]
            spokes = corners[1:] - corners[0]
            area = np.sqrt((np.cross(spokes[:-1], spokes[1:]).sum(axis=0) ** 2).sum()) / 2
            assert diagram.ridge_areas[ridge] == pytest.approx(area, rel=1e-8)


def test_many_ties_of_space() -> None:
    """Every eight sites share a vertex, which each cell lists once."""
    side = 17
    axes = np.meshgrid(*[np.arange(side)] * 3, indexing="ij")
    diagram = Voronoi(np.stack(axes, axis=-1).reshape(-1, 3).astype(float), workers=3)
    assert diagram.npoints > 1 << 12
    assert len(diagram.vertices) == (side - 1) ** 3
    inner = np.all([(axis > 0) & (axis < side - 1) for axis in axes], axis=0).ravel()
    np.testing.assert_allclose(diagram.cell_volumes[inner], 1, rtol=1e-14)
    assert not np.isfinite(diagram.cell_volumes[~inner]).any()
    for row, corners in enumerate(cells(diagram)):
        assert len(set(corners.tolist())) == len(corners)
        assert not inner[row] or len(corners) == 8
