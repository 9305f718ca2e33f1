"""A surveyor's day on lidar and the large-scale map of Delft, whose borders are breaklines."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import ConflictingValuesError, ConstrainedDelaunay, OutsideError, io
from delone.terrain import TIN

DELFT = Path(__file__).parents[3] / "shared" / "data" / "delft"
pytestmark = pytest.mark.skipif(not DELFT.exists(), reason="needs lidar and the map of Delft")

CROP = (84880.0, 447480.0, 84980.0, 447580.0)


@pytest.fixture(scope="module")
def ground():
    survey = io.read_points(DELFT / "ahn3_cropped_1.laz", classes=[2])
    return np.column_stack((survey.points, survey.z))


@pytest.fixture(scope="module")
def borders():
    """The borders of roads inside the crop, without heights."""
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    roads = geopandas.read_file(DELFT / "bgt_wegdeel.sqlite")
    lines = shapely.intersection(roads.boundary.values, shapely.box(*CROP))
    parts = shapely.get_parts(shapely.line_merge(lines[~shapely.is_empty(lines)]))
    return [line for line in shapely.get_parts(parts) if line.geom_type == "LineString"]


@pytest.fixture(scope="module")
def tin(ground, borders):
    return TIN.from_points(ground, breaklines=borders, crs="EPSG:28992", duplicates="mean")


def test_two_points_of_the_survey_contradict_each_other(ground):
    with pytest.raises(ConflictingValuesError, match=r"at 2 places: \(84837\.919, 447435\.335\)"):
        TIN.from_points(ground)


def test_borders_are_edges_at_the_height_of_the_ground(tin, ground, borders):
    assert len(borders) > 50 and len(tin.breaklines) > 5000
    edges = tin.points[tin.breaklines]
    total = np.hypot(*(edges[:, 1] - edges[:, 0]).T).sum()
    shapely = pytest.importorskip("shapely")
    joined = shapely.length(shapely.union_all(borders))
    assert total == pytest.approx(joined, rel=1e-6)
    surface = TIN.from_points(ground, duplicates="mean")
    middles = edges.mean(axis=1)
    assert np.abs(tin.heights(middles) - surface.heights(middles)).max() < 1e-6
    assert tin.validate()


def test_contours_of_the_site_are_simple_and_do_not_cross(tin):
    shapely = pytest.importorskip("shapely")
    contours = tin.contours(interval=0.25, smooth=1)
    lines = contours.to_shapely()
    assert shapely.is_simple(shapely.force_2d(lines)).all()
    # Crossings would be an error.
    row = np.delete(np.arange(len(contours.points) - 1), contours.starts[1:-1] - 1)
    ConstrainedDelaunay(contours.points, np.column_stack((row, row + 1)), planar=True)
    bands = tin.bands(interval=0.25).to_shapely()
    assert shapely.is_valid(bands).all()
    assert shapely.area(bands).sum() == pytest.approx(tin.areas.sum(), rel=1e-9)


def test_a_profile_is_the_surface(tin):
    line = [(CROP[0], CROP[1]), (CROP[2], CROP[3])]
    profile = tin.profile(line)
    assert len(profile) > 300 and not np.isnan(profile.z).any()
    assert np.abs(tin.heights(profile.points) - profile.z).max() < 1e-6
    assert profile.distances[-1] == pytest.approx(np.hypot(100, 100))


@pytest.mark.deep
def test_a_pad_has_the_volume_of_its_parts(tin):
    center = np.array([(CROP[0] + CROP[2]) / 2, (CROP[1] + CROP[3]) / 2])
    pad = center + np.array([(-12, -8), (10, -11), (13, 9), (-9, 12)])
    z = float(np.nanmean(tin.heights(pad)))
    design = tin.embank(pad, z, cut=1 / 2, fill=1 / 3)
    assert design.validate() and design.crs == tin.crs
    found = tin.volume_to(design)
    assert found.cut > 1 and found.fill > 1
    within = tin.volume_to(z, region=[pad])
    assert within.cut == pytest.approx(tin.volume_to(design, region=[pad]).cut, rel=1e-6)
    assert within.cut <= found.cut + 1e-6 and within.fill <= found.fill + 1e-6
    back = design.volume_to(tin)
    assert (back.cut, back.fill) == pytest.approx((found.fill, found.cut), rel=1e-9)
    # A sum over a raster of 10 cm.
    x = np.arange(-30, 30, 0.1) + 0.05
    nodes = center + np.stack(np.meshgrid(x, x), axis=-1)
    change = design.heights(nodes) - tin.heights(nodes)
    assert found.fill == pytest.approx(change[change > 0].sum() * 0.01, rel=0.01)
    assert found.cut == pytest.approx(-change[change < 0].sum() * 0.01, rel=0.01)
    with pytest.raises(OutsideError, match="leaves the surface"):
        tin.embank(pad - np.array([0, 50]), 60.0, slope=0.5)


def test_a_hillshade_of_the_site_is_written(tin, tmp_path):
    rasterio = pytest.importorskip("rasterio")
    path = tmp_path / "the shade.tif"
    shade = tin.raster("hillshade", resolution=0.5, bounds=CROP, z_factor=2)
    io.write_raster(path, shade, crs=tin.crs)
    with rasterio.open(path) as file:
        values = file.read(1)
        assert file.crs.to_epsg() == 28992 and values.shape == (200, 200)
    assert (values >= 0).all() and (values <= 1).all() and 0.5 < values.mean() < 0.9
