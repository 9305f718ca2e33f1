"""A ring of coordinates is accepted wherever a polygon is, and means the same."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import datasets, sphere
from delone.errors import CrossingSegmentsError, InputError
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable

shapely = pytest.importorskip("shapely")
geopandas = pytest.importorskip("geopandas")

RING = [(0.0, 0), (4, 0), (4, 4), (1, 3)]
HOLE = [(2.0, 1), (3, 1), (3, 2)]
POINTS = 8 * datasets.uniform(80, seed=2) - 2
HEIGHTS = np.column_stack((POINTS, POINTS.sum(axis=1)))
SURFACE = TIN.from_points(HEIGHTS)
USES: dict[str, Callable[[Any], Any]] = {
    "mesh": lambda ring: delone.mesh(ring, max_area=1),
    "from_geometry": lambda ring: delone.from_geometry(ring, boundary="polygons"),
    "triangulate_polygon": delone.triangulate_polygon,
    "clip": lambda ring: delone.Voronoi(POINTS, clip=ring).cell_areas,
    "lloyd": lambda ring: delone.lloyd(POINTS, ring, max_iter=1).points,
    "boundary": lambda ring: TIN.from_points(HEIGHTS, boundary=ring),
    "region": lambda ring: [SURFACE.volume_to(0, region=ring).cut],
    "flatten": lambda ring: SURFACE.flatten(ring, 1.0),
}
GLOBES: dict[str, Callable[[Any], Any]] = {
    "sphere": sphere.from_geometry,
    "sphere clip": lambda ring: sphere.Voronoi(lonlat=POINTS, clip=ring).cell_areas,
}


def same(a: Any, b: Any) -> None:
    if hasattr(a, "simplices"):
        # `triangulate_polygon` keeps the rows of a ring that repeats its first point.
        assert np.array_equal(a.points[: len(b.points)], b.points)
        assert np.array_equal(a.simplices, b.simplices)
    else:
        assert np.array_equal(a, b)


@pytest.mark.parametrize("name", [*USES, *GLOBES])
def test_rings_are_polygons(name: str) -> None:
    use = (USES | GLOBES)[name]
    polygon = shapely.Polygon(RING)
    expected = use(polygon)
    for ring in (RING, tuple(RING), np.array(RING), [RING], [np.array(RING)], [*RING, RING[0]]):
        same(use(ring), expected)
    for other in ([polygon], polygon.__geo_interface__, geopandas.GeoSeries([polygon])):
        same(use(other), expected)


@pytest.mark.parametrize("name", USES)
def test_several_rings_are_one_polygon_by_the_even_odd_rule(name: str) -> None:
    expected = USES[name](shapely.Polygon(RING, [HOLE]))
    for rings in ([RING, HOLE], [np.array(RING), np.array(HOLE)], [HOLE, RING]):
        found = USES[name](rings)
        if hasattr(found, "areas"):
            assert found.areas.sum() == pytest.approx(expected.areas.sum(), rel=1e-12)
        elif not hasattr(found, "simplices"):
            assert found == pytest.approx(np.asarray(expected), rel=1e-12)


@pytest.mark.parametrize("name", GLOBES)
def test_on_the_sphere_holes_have_to_be_known(name: str) -> None:
    with pytest.raises(InputError, match=r"several rings of coordinates.*pass polygons"):
        GLOBES[name]([RING, HOLE])


def test_points_that_are_not_a_ring() -> None:
    with pytest.raises(CrossingSegmentsError):
        delone.mesh([(0, 0), (4, 4), (4, 0), (0, 4)])
    assert delone.mesh([(0, 0), (4, 4), (4, 0), (0, 4)], crossing="split").areas.sum() == 8
    with pytest.raises(InputError, match="points without segments"):
        delone.mesh([(0, 0), (1, 1)])
    with pytest.raises(InputError, match="points without segments"):
        delone.mesh([(0, 0, 1), (1, 1, 1), (2, 0, 1)])
    with pytest.raises(InputError, match="not a geometry"):
        delone.from_geometry([(0, 0), (1, 1)])
    with pytest.raises(InputError, match="the rings of clip cross or touch"):
        delone.Voronoi(POINTS, clip=[RING, [(3, 3), (9, 3), (9, 9)]])
    assert delone.Voronoi(POINTS, clip=[-2, -2, 6, 6]).cell_areas.sum() == pytest.approx(64)
    assert delone.Voronoi(POINTS, clip=np.array([-2, -2, 6, 6])).clip == (-2, -2, 6, 6)


def test_a_segment_list_stays_one() -> None:
    mesh = delone.mesh((RING, [(0, 1), (1, 2), (2, 3), (3, 0)]))
    same(mesh, delone.mesh(RING))
