from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import datasets, sphere

EXAMPLES = Path(__file__).parents[2] / "examples" / "data"


@pytest.mark.parametrize("load", [datasets.ahn3, datasets.baja], ids=lambda load: load.__name__)
def test_sample_is_consistent_and_read_only(load: object) -> None:
    sample = load()  # type: ignore[operator]
    n = len(sample.points)
    assert sample.points.shape == (n, 2) and sample.points.dtype == np.float64
    assert sample.points.flags.c_contiguous
    assert sample.z.shape == (n,) and sample.z.dtype == np.float64
    assert all(len(values) == n for values in sample.attributes.values())
    assert np.isfinite(sample.points).all() and np.isfinite(sample.z).all()
    assert sample.name and sample.credit and sample.crs.startswith("EPSG:")
    for array in (sample.points, sample.z, *sample.attributes.values()):
        assert not array.flags.writeable


def test_ahn3_is_as_described() -> None:
    sample = datasets.ahn3()
    assert len(sample.points) == 212_550
    assert len(np.unique(sample.points, axis=0)) == 212_550
    assert set(sample.attributes["classification"].tolist()) == {2, 6}
    np.testing.assert_array_equal(np.round(sample.points * 1000) / 1000, sample.points)


def test_ahn3_is_the_lidar_file_of_the_examples() -> None:
    laspy = pytest.importorskip("laspy")
    pytest.importorskip("lazrs")
    las = laspy.read(EXAMPLES / "ahn3_crop_100m.laz")
    sample = datasets.ahn3()
    stored = np.column_stack((las.X, las.Y, las.Z))
    found = np.round(np.column_stack((sample.points, sample.z)) * 1000)
    np.testing.assert_array_equal(found, stored)
    np.testing.assert_array_equal(sample.attributes["classification"], las.classification)


def test_baja_is_the_table_of_the_examples() -> None:
    table = np.loadtxt(EXAMPLES / "baja-bathymetry.csv.xz", delimiter=",", skiprows=1)
    sample = datasets.baja()
    np.testing.assert_array_equal(sample.points, table[:, :2])
    np.testing.assert_array_equal(sample.z, table[:, 2])
    assert len(np.unique(sample.points, axis=0)) == 80_983


def test_credits_travel_with_the_samples() -> None:
    credits = Path(datasets.ahn3.__code__.co_filename).with_name("CREDITS.md").read_text("utf-8")
    assert "AHN3" in credits and "Verde Developers" in credits
    assert "Natural Earth" in credits


def test_land_is_the_land_of_the_earth() -> None:
    polygons = datasets.land()["coordinates"]
    assert len(polygons) == 127
    area = 0.0
    for polygon in polygons:
        for k, ring in enumerate(polygon):
            corners = np.array(ring)
            assert (corners[0] == corners[-1]).all() and len(corners) > 3
            assert (np.abs(corners) <= (180, 90)).all()
            (x, y), (u, v) = corners[:-1].T, corners[1:].T
            assert ((x * v - u * y).sum() > 0) == (k == 0)
            # The area below each side between parallels: exact where sides are straight on a
            # cylindrical equal-area map.
            z, w = np.sin(np.radians(y)), np.sin(np.radians(v))
            area -= (np.radians(u - x) * (z + w) / 2).sum()
    # 149 of 510 million square kilometers.
    assert abs(area / (4 * np.pi) - 0.292) < 0.005


def test_land_is_triangulated_on_the_sphere() -> None:
    mesh = sphere.from_geometry(datasets.land())
    share = mesh.areas[mesh.polygon_of_simplex >= 0].sum() / mesh.areas.sum()
    assert abs(share - 0.29) < 0.01
