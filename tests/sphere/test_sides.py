"""What polygons mean on the sphere: either direction of rings, long sides, all, half, meters."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from delone import sphere
from delone.errors import InputError

SITES = np.random.default_rng(1).normal(size=(50, 3))


def polygon(*ring: tuple[float, float]) -> dict[str, Any]:
    return {"type": "Polygon", "coordinates": [list(ring)]}


def box(west: float, south: float, east: float, north: float) -> dict[str, Any]:
    return polygon((west, south), (east, south), (east, north), (west, north))


def turned(given: dict[str, Any]) -> dict[str, Any]:
    return polygon(*given["coordinates"][0][::-1])


def area(clip: Any, **options: Any) -> float:
    return float(sphere.Voronoi(xyz=SITES, clip=clip, **options).cell_areas.sum())


def zone(west: float, south: float, east: float, north: float) -> float:
    """The area between two parallels and two meridians."""
    height = np.sin(np.radians(north)) - np.sin(np.radians(south))
    return float(np.radians(east - west) * height)


def test_either_direction_of_rings_is_the_smaller_side() -> None:
    country = box(0, 40, 20, 55)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert area(country) == pytest.approx(area(turned(country)), rel=1e-12)
        mesh = sphere.from_geometry([turned(country)])
        assert (
            set(mesh.polygon_of_simplex.tolist()) == {-1, 0} or mesh.polygon_of_simplex.max() == 0
        )
    for winding, given in (("ccw", turned(country)), ("cw", country)):
        with pytest.warns(
            sphere.PolygonWarning, match=r"1 geometry covers more than half .* 9"
        ) as w:
            large = area(given, winding=winding)
        assert [each.filename for each in w] == [__file__]
        assert large + area(country) == pytest.approx(4 * np.pi)


def test_long_sides_are_said_and_follow_parallels_on_request() -> None:
    given = box(-10, 35, 30, 60)
    with pytest.warns(sphere.PolygonWarning, match=r"clip: 1 side is longer .* \(-10.0, 35.0\)"):
        arcs = area(given)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert area(given, sides="arc") == arcs
        assert area(given, sides="parallel") == pytest.approx(zone(-10, 35, 30, 60), rel=1e-3)
        # Sides of more than half a turn.
        wide = area(box(-100, -30, 100, 30), sides="parallel")
        assert wide == pytest.approx(zone(-100, -30, 100, 30), rel=1e-3)
        # Meridians and the equator are arcs.
        area(box(0, 0, 90, 90))
    with pytest.raises(InputError, match="sides must be"):
        area(given, sides="straight")


@pytest.mark.parametrize("sides", [None, "arc", "parallel"])
@pytest.mark.parametrize("turn", [False, True])
def test_the_whole_globe_can_be_said(sides: str | None, turn: bool) -> None:
    globe = box(-180, -90, 180, 90)
    given = turned(globe) if turn else globe
    assert area(given, sides=sides) == pytest.approx(4 * np.pi)
    with pytest.raises(InputError, match="geometry 1 is the whole sphere"):
        sphere.from_geometry([box(0, 0, 9, 9), given], sides=sides)


def test_hemispheres_can_be_said() -> None:
    north = box(-180, 0, 180, 90)
    assert area(north, sides="parallel") == pytest.approx(2 * np.pi)
    with pytest.raises(
        InputError, match=r"1 side is a whole turn long, first from \(-180.0, 0.0\)"
    ):
        area(north)
    east = box(0, -90, 180, 90)
    cells = sphere.Voronoi(xyz=SITES, clip=east)
    assert cells.cell_areas.sum() == pytest.approx(2 * np.pi)
    # Of two halves the left one: sites in the west have less than their cells.
    west = sphere.Voronoi(xyz=SITES, clip=turned(east))
    np.testing.assert_allclose(
        cells.cell_areas + west.cell_areas, sphere.Voronoi(xyz=SITES).cell_areas, atol=1e-9
    )
    assert cells.cell_areas[cells.lonlat[:, 0] < 0].sum() < 1.5


def test_projected_polygons_are_transformed() -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    pytest.importorskip("pyproj")
    degrees = geopandas.GeoSeries([shapely.box(0, 40, 20, 55)], crs="EPSG:4326")
    meters = degrees.to_crs(3857)
    assert area(meters) == pytest.approx(area(degrees), rel=1e-9)
    mesh = sphere.from_geometry(meters)
    places = [(10, 50), (-10, 50)]
    np.testing.assert_allclose(np.abs(mesh.lonlat).max(axis=0), [20, 55], rtol=1e-9)
    assert mesh.find_simplex(places).tolist()[1] == -1
    with pytest.raises(InputError, match="so they are in degrees"):
        sphere.from_geometry(degrees, degrees=False)
    small = geopandas.GeoSeries([shapely.box(0, 0, 10, 10)], crs="EPSG:3857")
    assert area(small, radius=6371008.8) == pytest.approx(100, rel=0.02)


def test_projected_polygons_without_pyproj(monkeypatch: pytest.MonkeyPatch) -> None:
    class Meters(dict):  # type: ignore[type-arg]
        crs = "EPSG:3857"

    monkeypatch.setattr("delone._base.georeference._has_pyproj", lambda: False)
    with pytest.raises(InputError, match=r"clip: longitudes .* EPSG:3857 has others: transform"):
        area(Meters(box(0, 0, 10, 10)))
