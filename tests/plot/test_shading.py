"""Surfaces as pixels: planes are exact, light comes from the northwest."""

import numpy as np
import pytest

from delone import Delaunay, InputError, datasets
from delone.plot.raster import plot_difference, plot_raster
from delone.plot.shading import Raster, facet_light, point_density, rasterize, relief

pyplot = pytest.importorskip("matplotlib.pyplot")
pyplot.switch_backend("Agg")


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("draw", [plot_raster, plot_difference])
def test_values_up_to_a_limit_are_drawn(draw):
    x, y = np.arange(3.0), np.arange(2.0)
    values = np.array([[-1, 0, 1], [0.5, np.nan, 0.25]])
    figure = draw(values * 1e305, x, y).figure
    figure.canvas.draw()
    pyplot.close(figure)
    for largest in (1.01e305, 1.7e308):
        with pytest.raises(InputError, match="beyond 1e\\+305: divide all values"):
            draw(values * largest, x, y)


def plane(points):
    return 3 * points[..., 0] - 2 * points[..., 1] + 7


def centers(raster):
    left, _, bottom, _ = raster.extent
    rows, columns = raster.values.shape
    x = left + raster.cell * (np.arange(columns) + 0.5)
    y = bottom + raster.cell * (np.arange(rows) + 0.5)
    return np.stack(np.meshgrid(x, y), axis=-1)


@pytest.mark.parametrize("offset", [0.0, 5_400_000.0])
@pytest.mark.parametrize("block", [50, 1 << 20])
def test_a_plane_seen_through_few_points(monkeypatch, offset, block):
    monkeypatch.setattr("delone.plot.shading._BLOCK", block)
    points = datasets.uniform(200) + offset
    raster = rasterize(Delaunay(points), plane(points - offset), 40)
    wanted = plane(centers(raster) - offset)
    inside = np.isfinite(raster.values)
    assert 0.8 < inside.mean() < 1
    assert raster.values[inside] == pytest.approx(wanted[inside], abs=1e-7)
    assert raster.values.shape == (40, 40)


def test_outside_is_empty():
    triangle = Delaunay([(0, 0), (1, 0), (0, 1)])
    values = rasterize(triangle, np.zeros(3), 20).values
    assert np.isnan(values[15:, 15:]).all()
    assert np.isfinite(values[:5, :5]).all()


def test_a_crowded_pixel_is_the_mean():
    points = datasets.uniform(50_000)
    noise = np.random.default_rng(1).choice([-1.0, 1.0], len(points))
    raster = rasterize(Delaunay(points), noise, 20)
    assert np.abs(raster.values).max() < 0.5
    assert np.isfinite(raster.values).all()


def test_density():
    points = datasets.uniform(40_000)
    raster = point_density(Delaunay(points), 10)
    assert np.nansum(raster.values) * raster.cell**2 == pytest.approx(40_000)
    assert raster.values == pytest.approx(40_000, rel=0.2)


def test_light_comes_from_the_north_west():
    x, y = np.meshgrid(np.arange(20.0), np.arange(20.0))

    def brightness(heights):
        return relief(Raster(heights, 1.0, (0, 20, 0, 20)))[10, 10]

    towards, away = brightness(x - y), brightness(y - x)
    assert towards > 0.95
    assert away < 0.3
    assert brightness(0 * x) == pytest.approx(np.sqrt(0.5))
    mesh = Delaunay(datasets.uniform(50))
    assert (facet_light(mesh.points, mesh.points @ [1.0, -1.0], mesh.simplices) > 0.95).all()
    assert (facet_light(mesh.points, mesh.points @ [-1.0, 1.0], mesh.simplices) < 0.3).all()


@pytest.mark.parametrize("power", [0, 400, 600, 1000, 1023])
def test_huge_heights_have_the_same_relief(power: int) -> None:
    """No warning, either: pytest raises those of NumPy."""
    heights = np.random.default_rng(3).uniform(-1, 1, (12, 12))
    frame = (1.0, (0, 12, 0, 12))
    with np.errstate(over="raise"):
        found = relief(Raster(heights * 2.0**power, *frame))
    np.testing.assert_array_equal(found, relief(Raster(heights, *frame)))
    points = np.array([(0.0, 0), (1, 0), (1, 1), (0, 1)])
    corners, z = np.array([[0, 1, 2], [0, 2, 3]], dtype=np.int32), np.array([0.5, -0.9, 0.2, 0.9])
    with np.errstate(over="raise"):
        light = facet_light(points, z * 2.0**power, corners)
    np.testing.assert_array_equal(light, facet_light(points, z, corners))
