"""Plots of the globe: which arcs are drawn, and which colors where."""

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from delone import InputError, ShapeError, datasets, sphere

OCTAHEDRON = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
FIVE = [(0, 50), (10, 52), (5, 45), (20, 48), (12, 40)]


@pytest.fixture(autouse=True)
def _close():
    yield
    plt.close("all")


def axes():
    return Figure().add_subplot()


def chords(ax):
    """The ends of all chords, (k, 2)."""
    found = [c for c in ax.collections if isinstance(c, LineCollection)]
    return np.concatenate([np.reshape(c.get_segments(), (-1, 2)) for c in found])


def test_edges_in_front_are_where_they_belong() -> None:
    ax = sphere.Delaunay(xyz=OCTAHEDRON).plot(axes(), view=(0, 0))
    ends = chords(ax)
    # Two great circles across the disk, and the limb.
    on_cross = np.abs(ends).min(axis=1) < 1e-12
    on_limb = np.abs(np.linalg.norm(ends, axis=1) - 1) < 1e-12
    assert (on_cross | on_limb).all() and on_cross.sum() > 100 and on_limb.sum() > 100
    turns = np.degrees(np.arctan2(*ends[on_limb].T))
    assert np.histogram(turns, bins=8, range=(-180, 180))[0].min() > 10


def test_ridges_are_at_equal_distances_from_their_sites() -> None:
    diagram = sphere.Voronoi(lonlat=FIVE)
    ends = chords(diagram.plot(axes(), view=(30, 90)))
    depth = np.sqrt(np.maximum(1 - (ends**2).sum(axis=1), 0))
    # Seen from above the pole, 30 degrees east is up from the left to the right.
    turn = np.radians(30)
    right = np.array((-np.sin(turn), np.cos(turn), 0))
    up = -np.array((np.cos(turn), np.sin(turn), 0))
    places = ends[:, :1] * right + ends[:, 1:] * up + depth[:, None] * (0, 0, 1)
    inner = places[depth > 0.1]
    near = np.sort(inner @ diagram.points.T, axis=1)
    assert len(inner) > 50
    assert np.abs(near[:, -1] - near[:, -2]).max() < 1e-9


@pytest.mark.parametrize("view", [(10, 45), (-170, -30), (7, 85)])
@pytest.mark.parametrize("sites", [FIVE, [(0, 0), (90, 0), (200, 0)]], ids=["five", "circle"])
def test_pixels_have_the_value_of_the_nearest_site(view, sites) -> None:
    diagram = sphere.Voronoi(lonlat=sites)
    values = np.arange(len(sites)) * 10.0
    ax = diagram.plot(axes(), values=values, view=view)
    image = ax.images[0].get_array()
    middle = image.shape[0] // 2
    # The pixels around the center are those of the view.
    lon, lat = np.radians(view)
    out = np.array((np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)))
    assert image[middle, middle] == values[(diagram.points @ out).argmax()]
    east = np.array((-np.sin(lon), np.cos(lon), 0))
    place = 0.8 * east + 0.6 * out
    right = image[middle, int(0.9 * image.shape[1])]
    assert right == values[(diagram.points @ place).argmax()]
    assert np.isnan(image.filled(np.nan)[0, 0])


def test_outside_of_a_hull_there_is_no_color() -> None:
    mesh = sphere.Delaunay(lonlat=[(-10, -10), (10, -10), (0, 10)])
    image = mesh.plot(axes(), values=[3.0], view=(0, 0)).images[0].get_array()
    colored = ~np.ma.getmaskarray(image)
    # A little more than the triangle of straight chords.
    flat = 2 * np.sin(np.radians(10)) ** 2 * np.cos(np.radians(10))
    assert flat < 4 * colored.mean() < 1.05 * flat
    assert set(image.compressed()) == {3.0}


def test_the_coast_is_seen_where_it_is() -> None:
    mesh = sphere.Delaunay(xyz=OCTAHEDRON)
    land = datasets.land()
    pacific = mesh.plot(axes(), view=(-140, -20), coast=land)
    africa = mesh.plot(axes(), view=(20, 10), coast=land)
    bare = mesh.plot(axes(), view=(20, 10))
    assert len(chords(bare)) < len(chords(pacific)) < len(chords(africa))


def test_bad_options_are_refused() -> None:
    mesh = sphere.Delaunay(xyz=OCTAHEDRON)
    with pytest.raises(ShapeError, match=r"\(8,\), got \(7,\)"):
        mesh.plot(axes(), values=np.zeros(7))
    for view in [(np.nan, 0), "north", (1, 2, 3)]:
        with pytest.raises(InputError, match="view"):
            mesh.plot(axes(), view=view)
