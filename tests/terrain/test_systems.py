"""Lines and regions in another reference system than the surface."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from delone import CRSWarning, InputError, MissingExtraError
from delone.io import GeometrySet
from delone.terrain import TIN

geopandas = pytest.importorskip("geopandas")
shapely = pytest.importorskip("shapely")
pytestmark = pytest.mark.filterwarnings("error")

LOW = np.array([155_000.0, 463_000.0])
CORNERS = np.column_stack((LOW + np.array([(0, 0), (100, 0), (100, 100), (0, 100)]), np.ones(4)))
PIT = geopandas.GeoSeries([shapely.box(*(LOW + 10), *(LOW + 20))], crs=28992)
ROAD = geopandas.GeoSeries([shapely.LineString([LOW + 5, LOW + 90])], crs=28992)


def site(**options) -> TIN:
    return TIN.from_points(CORNERS, **{"crs": "EPSG:28992", "units": "m"} | options)


@pytest.mark.parametrize("crs", [28992, 4326, 3857])
def test_what_declares_another_system_is_transformed(crs):
    pit, road = PIT.to_crs(crs), ROAD.to_crs(crs)
    tin = site()
    assert tin.volume_to(0.0, region=pit).cut == pytest.approx(100, rel=1e-4)
    assert tin.volume_to(0.0, region=[pit, *CORNERS[:0]]).cut == pytest.approx(100, rel=1e-4)
    assert tin.profile(road).distances[-1] == pytest.approx(85 * np.sqrt(2), rel=1e-4)
    assert tin.flatten(pit, 0.0).heights(LOW + 15) == 0
    assert site(boundary=pit).areas.sum() == pytest.approx(100, rel=1e-4)
    assert site(holes=[pit]).areas.sum() == pytest.approx(9900, rel=1e-4)
    assert len(site(breaklines=road).breaklines) >= 1
    stored = GeometrySet(geometries=pit.to_numpy(), crs=str(pit.crs))
    assert tin.volume_to(0.0, region=stored).cut == pytest.approx(100, rel=1e-4)
    # The rings of arrays beside them are in the system of the surface.
    ring = LOW + np.array([(30, 30), (40, 30), (40, 40)])
    assert tin.volume_to(0.0, region=[pit, ring]).cut == pytest.approx(150, rel=1e-4)


def test_an_unknown_system_is_taken_as_the_other_one_and_said():
    unknown = GeometrySet(geometries=PIT.to_numpy())
    with pytest.warns(CRSWarning, match=r"of the surface is EPSG:28992; that of region is unknown"):
        assert site().volume_to(0.0, region=unknown).cut == pytest.approx(100)
    with pytest.warns(CRSWarning, match=r"of region is EPSG:28992; that of the surface is unknown"):
        assert site(crs=None).volume_to(0.0, region=PIT).cut == pytest.approx(100)
    with pytest.warns(CRSWarning, match=r"of lines is EPSG:28992; that of the points is unknown"):
        assert site(crs=None, boundary=PIT).crs == "EPSG:28992"
    # Arrays and bare geometries cannot declare one.
    assert site().volume_to(0.0, region=list(PIT)).cut == pytest.approx(100)


def test_what_cannot_be_transformed_is_named(monkeypatch):
    wrong = PIT.set_crs(4326, allow_override=True)
    with pytest.raises(InputError, match=r"region: \(155020, 463010\) has no place in EPSG:28992"):
        site().volume_to(0.0, region=wrong)
    tin, degrees = site(), PIT.to_crs(4326)
    monkeypatch.setitem(sys.modules, "pyproj", None)
    with pytest.raises(MissingExtraError, match="pyproj"):
        tin.volume_to(0.0, region=degrees)


def test_a_volume_of_nothing_is_said():
    tin = site()
    with pytest.warns(UserWarning, match="the region have no area in common"):
        assert tin.volume_to(0.0, region=shapely.box(0, 0, 1, 1)).area == 0
    far = TIN.from_points(CORNERS + np.array([1000, 0, 0]), crs="EPSG:28992", units="m")
    with pytest.warns(UserWarning, match="surface to be reached have no area in common"):
        assert tin.volume_to(far).net == 0
