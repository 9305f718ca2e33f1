"""Ground points: synthetic surveys whose ground is known, and lidar that has been classified."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from delone import GeographicWarning
from delone.datasets import ahn3
from delone.errors import InputError
from delone.io import PointSet, read_points
from delone.terrain import ground

DELFT = Path(__file__).parents[3] / "shared" / "data" / "delft" / "ahn3_cropped_1.laz"


def town(seed=1, slope=0.08, count=20_000):
    """Rolling ground of 120 m x 120 m, six flat roofs, trees, and noise of 2 cm."""
    random = np.random.default_rng(seed)
    xy = random.random((count, 2)) * 120
    x, y = xy.T
    z = slope * x + 1.5 * np.sin(x / 15) * np.cos(y / 18) + random.normal(0, 0.02, count)
    truth = np.ones(count, dtype=bool)
    for cx, cy in ((20, 20), (60, 25), (95, 30), (25, 80), (65, 85), (100, 95)):
        roof = (abs(x - cx) < 6) & (abs(y - cy) < 5)
        z[roof] = slope * cx + 7 + random.normal(0, 0.02, roof.sum())
        truth &= ~roof
    tree = truth & (random.random(count) < 0.15)
    z[tree] += random.uniform(1.5, 12, tree.sum())
    return np.column_stack((xy, z)), truth & ~tree


@pytest.mark.parametrize(("slope", "least"), [(0.0, 0.97), (0.08, 0.97), (0.25, 0.88)])
def test_roofs_and_trees_are_not_ground(slope, least):
    xyz, truth = town(slope=slope)
    found = ground(xyz)
    other = found.compare(truth)
    assert found.converged or slope > 0.1
    assert other.kappa > least
    assert other.type_1 < 0.05
    assert other.type_2 < 0.02
    assert not found.outliers.any()


def test_order_of_points_changes_nothing():
    xyz, _ = town(count=5000)
    order = np.random.default_rng(2).permutation(len(xyz))
    first, second = ground(xyz), ground(xyz[order])
    assert (first.mask[order] == second.mask).all()
    assert first.added == second.added


def test_low_outliers_are_left_out():
    xyz, truth = town(slope=0.0)
    rows = np.flatnonzero(truth)[[10, 500, 4000]]
    xyz[rows, 2] -= (5, 30, 9)
    found = ground(xyz)
    assert np.flatnonzero(found.outliers).tolist() == sorted(rows)
    assert not found.mask[rows].any()
    truth[rows] = False
    assert found.compare(truth).kappa > 0.97
    # Six points are a pit, and no error.
    xyz[np.flatnonzero(truth)[:6]] = (60, 60, -20) + np.arange(18).reshape(6, 3) / 100
    assert not ground(xyz).outliers[np.flatnonzero(truth)[:6]].any()


def test_gaps_decide_what_is_low():
    xyz, truth = town(slope=0.0)
    row = np.flatnonzero(truth)[123]
    xyz[row, 2] = xyz[:, 2].min() - 3
    assert ground(xyz, low=2.5).outliers[row]
    assert not ground(xyz, low=5).outliers.any()


def test_mirror_images_and_angles_climb_dikes():
    x, y = (each.ravel() for each in np.meshgrid(np.arange(0, 60, 0.5), np.arange(0, 60, 0.5)))
    x, y = x + 0.01 * np.sin(7 * y), y + 0.01 * np.cos(5 * x)
    dike = np.column_stack((x, y, np.clip((32 - abs(x - 30)) / 3 - 8, 0, 2.6)))
    above = dike[:, 2] > 0.01
    without, found, steep = (
        ground(dike, cell=25, **each).mask[above].mean()
        for each in ({"mirror": False}, {}, {"angle": 25})
    )
    assert without < found < steep
    assert steep > 0.95


def test_angle_distance_and_thickness():
    x, y = (each.ravel() for each in np.meshgrid(np.arange(41.0), np.arange(41.0)))
    z = np.where((x == 20) & (y == 20), 0.9, 0.0)
    xyz = np.column_stack((x, y, z))
    stone = np.flatnonzero(z)[0]
    assert not ground(xyz).mask[stone]
    assert ground(xyz, thickness=0.95).mask[stone]
    assert ground(xyz, angle=80).mask[stone]
    assert not ground(xyz, angle=80, distance=0.5).mask[stone]
    assert ground(xyz).mask.sum() == len(z) - 1
    # Cells narrower than a roof take it for ground.
    house = np.column_stack((x, y, np.where((abs(x - 20) < 9) & (abs(y - 20) < 9), 6.0, 0.0)))
    assert not ground(house, cell=25).mask[house[:, 2] > 0].any()
    assert ground(house, cell=5).mask[house[:, 2] > 0].all()


def test_passes_are_limited():
    xyz, _ = town(count=5000)
    found = ground(xyz, max_iter=2, thickness=0)
    assert len(found.added) == 2 and not found.converged
    assert "not converged" in repr(found)
    assert found.mask.sum() >= found.seeds + sum(found.added)


def test_feet_are_feet():
    xyz, _ = town(count=5000)
    meters = PointSet(points=xyz[:, :2] + 5e5, z=xyz[:, 2], crs="EPSG:32610")
    feet = PointSet(points=meters.points / 0.3048, z=xyz[:, 2] / 0.3048, crs="EPSG:2994")
    assert (ground(meters).mask == ground(feet).mask).mean() > 0.999
    assert not (ground(meters).mask == ground(feet, crs=None, cell=20.0).mask).all()


def test_few_points_and_duplicates():
    assert ground([(0, 0, 1)]).mask.tolist() == [True]
    assert ground([(0, 0, 1), (0, 0, 1), (0, 0, 9)]).mask.tolist() == [True, True, False]
    line = np.column_stack((np.arange(50.0), np.arange(50.0), np.zeros(50)))
    assert ground(line).mask.all()
    with pytest.raises(InputError, match="no points"):
        ground(np.empty((0, 3)))


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"cell": 0}, "cell must be above 0 and finite"), ({"cell": 1e-12}, "too small"),
        ({"angle": 90}, "between 0 and 90"), ({"distance": np.inf}, "distance"),
        ({"thickness": -1}, "at least 0"), ({"max_iter": 0}, "max_iter"), ({"low": 0}, "low"),
        ({"edge": np.nan}, "edge"),
    ],
)  # fmt: skip
def test_parameters_that_are_none(option, message):
    with pytest.raises(InputError, match=message):
        ground([(0, 0, 1), (5, 0, 1), (5, 5, 1)], **option)


def test_degrees_are_told():
    points = PointSet(points=np.array([(4.0, 52.0), (4.1, 52.0)]), z=np.zeros(2), crs="EPSG:4326")
    with pytest.warns(GeographicWarning):
        ground(points)


def test_comparisons():
    xyz = [(0, 0, 0), (1, 0, 0), (0, 1, 5), (1, 1, 5)]
    found = ground(xyz)
    assert found.mask.tolist() == [True, True, False, False]
    other = found.compare(np.array([True, False, True, False]))
    assert (other.kappa, other.type_1, other.type_2) == (0, 0.5, 0.5)
    assert found.compare(found.mask).kappa == 1
    third = found.compare(np.array([True, False, False, False]))
    assert third.kappa == pytest.approx(0.5)
    assert np.isnan(third.type_1) == np.False_ and third.type_2 == pytest.approx(1 / 3)
    with pytest.raises(InputError, match="classes == 2"):
        found.compare(np.array([2, 2, 1, 1]))


def test_lidar_of_the_samples():
    survey = ahn3()
    found = ground(survey)
    other = found.compare(survey.attributes["classification"] == 2)
    assert other.kappa > 0.97
    assert other.type_1 < 0.02
    assert other.type_2 < 0.001


@pytest.mark.deep
@pytest.mark.skipif(not DELFT.exists(), reason="needs lidar of Delft")
def test_lidar_with_trees_water_and_houses():
    survey = read_points(DELFT, attributes=["classification"])
    found = ground(survey, crs="EPSG:28992")
    other = found.compare(np.isin(survey.attributes["classification"], (2, 9)))
    assert other.kappa > 0.96
    assert other.type_1 < 0.04
    assert other.type_2 < 0.01
