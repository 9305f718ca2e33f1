"""What a grid says of itself, as text, as a picture and as a DataArray."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import datasets
from delone.errors import InputError
from delone.interpolate import Grid, cross_validate, grid
from delone.io import GeometrySet, MeshFile, PointSet

POINTS = datasets.uniform(200, seed=3)
FIELD = np.sin(5 * POINTS[:, 0]) + POINTS[:, 1]
RAMP = grid([(0, 0), (4, 0), (0, 4)], [0.0, 4.0, 4.0], shape=(400, 200))


def test_the_text_is_short() -> None:
    assert repr(RAMP) == "<Grid of 400 x 200 nodes, x 0 to 4, y 0 to 4: 0.015 to 3.995>"
    axis = np.arange(2.0)
    assert repr(Grid(np.full((2, 2), np.nan), axis, axis)).endswith(": no values>")
    assert repr(Grid(np.ones((2, 2, 3)), axis, axis)).startswith("<Grid of 2 x 2 x 3 nodes")
    assert repr(Grid(np.ones((2, 2), complex), axis, axis)).endswith(": complex values>")


def test_the_text_of_points_is_short() -> None:
    points = np.column_stack((np.arange(50_000.0), np.arange(50_000.0) - 7))
    assert (
        repr(PointSet(points=points)) == "<PointSet of 50000 points: x 0 to 49999, y -7 to 49992>"
    )
    full = PointSet(
        points=points[:1],
        z=np.array([np.nan]),
        attributes={"class": np.array([2]), "intensity": np.array([9])},
        crs="EPSG:28992",
    )
    expected = "x 0 to 0, y -7 to -7, z unknown, attributes class intensity, EPSG:28992"
    assert repr(full) == f"<PointSet of 1 point: {expected}>"
    assert repr(PointSet(points=np.empty((0, 2)))) == "<PointSet of 0 points>"
    assert len(repr(PointSet(points=points, crs="PROJCRS[" + 3000 * "x"))) < 150
    corners = np.zeros((50_000, 3), dtype=np.int32)
    found = repr(MeshFile(points=points, simplices=corners))
    assert found == "<MeshFile of 50000 points: 50000 triangles>"
    assert repr(datasets.baja()).startswith("<Sample ") and len(repr(datasets.baja())) < 150


def test_the_text_of_geometries_is_short() -> None:
    shapely = pytest.importorskip("shapely")
    shapes = np.array([shapely.Point(0, 0), shapely.box(0, 0, 1, 1), None, shapely.Point(1, 1)])
    expected = "<GeometrySet of 4 features: 2 Point, 1 Polygon, 1 no geometry>"
    assert repr(GeometrySet(geometries=shapes)) == expected


def test_an_array_of_xarray_has_the_nodes() -> None:
    xarray = pytest.importorskip("xarray")
    array = RAMP.to_xarray(name="height", crs="EPSG:28992")
    assert isinstance(array, xarray.DataArray)
    assert (array.dims, array.name, array.attrs) == (("y", "x"), "height", {"crs": "EPSG:28992"})
    np.testing.assert_array_equal(array.x, RAMP.x)
    np.testing.assert_array_equal(array.y, RAMP.y)
    np.testing.assert_array_equal(array.values, RAMP.values)
    assert array.sel(x=1, y=2, method="nearest").item() == pytest.approx(3, abs=0.03)
    several = grid(POINTS, np.column_stack((FIELD, FIELD)), shape=(5, 4)).to_xarray()
    assert several.sizes == {"y": 4, "x": 5, "value0": 2}


def test_a_picture_has_the_values() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    ax = Figure().add_subplot()
    assert RAMP.plot(ax, cmap="gray", title="ramp") is ax
    pixels = np.asarray(ax.images[0].get_array()).astype(int)
    assert pixels.shape == (200, 400, 4)
    np.testing.assert_array_equal(pixels[..., 3] > 0, np.isfinite(RAMP.values))
    lowest = pixels[0, :390, 0]
    assert (np.diff(lowest) >= 0).all() and np.ptp(lowest) > 200
    assert tuple(ax.images[0].get_extent()) == RAMP.extent
    for values in (np.ones((2, 2, 2)), np.ones((2, 2), complex)):
        with pytest.raises(InputError, match="one real value at each node"):
            Grid(values, np.arange(2.0), np.arange(2.0)).plot()


def test_a_picture_of_a_cross_validation_has_its_predictions() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.figure import Figure

    found = cross_validate(POINTS, FIELD, "linear")
    ax = found.plot(Figure().add_subplot())
    dots, line = ax.lines
    known = np.isfinite(found.predicted)
    assert 0 < known.sum() < 200
    np.testing.assert_array_equal(dots.get_xdata(), FIELD[known])
    np.testing.assert_array_equal(dots.get_ydata(), found.predicted[known])
    np.testing.assert_array_equal(line.get_xdata(), line.get_ydata())
    assert f"{found.rmse:.6g}" in ax.get_title()
    several: Any = cross_validate(POINTS, np.column_stack((FIELD, FIELD)), "linear")
    with pytest.raises(InputError, match="one real value at each point"):
        several.plot()
