"""Plots of constrained triangulations: segments bold, regions colored, holes white."""

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from PIL import Image

from delone import ConstrainedDelaunay, InputError
from delone.plot import cartography, plot, save_picture
from delone.plot.shading import facet_values, rasterize

OUTER = [(0, 0), (9, 0), (9, 6), (0, 6)]
INNER = [(2, 2), (4, 2), (4, 4), (2, 4)]
RING = np.array([(0, 1), (1, 2), (2, 3), (3, 0)])
RINGS = np.vstack((RING, RING + 4))


def axes(size=(6, 5), dpi=100):
    return Figure(figsize=size, dpi=dpi).add_subplot()


def kinds(ax, kind):
    return [each for each in ax.collections if type(each) is kind]


def drawn(ax):
    """The segments that were drawn, as a set of pairs of points."""
    found = set()
    for line in ax.lines:
        if line.get_gid() == "segments":
            xy = line.get_xydata()
            steps = np.stack((xy[:-1], xy[1:]), axis=1)
            steps = steps[~np.isnan(steps).any(axis=(1, 2))]
            found |= {frozenset(map(tuple, step)) for step in steps.tolist()}
    return found


def pairs(mesh, segments):
    return {frozenset(map(tuple, pair)) for pair in mesh.points[segments].tolist()}


def noisy(count):
    """Many points, a square with a square hole in it."""
    points = np.random.default_rng(3).random((count, 2)) * [9, 6]
    return np.vstack((OUTER, INNER, points))


def test_segments_are_bold_and_regions_colored():
    mesh = ConstrainedDelaunay(OUTER + INNER, RINGS)
    ax = plot(mesh, axes())
    assert drawn(ax) == pairs(mesh, mesh.segments)
    (facets,) = kinds(ax, PolyCollection)
    colors = [tuple(color) for color in facets.get_facecolors()]
    assert len(colors) == mesh.nsimplex
    assert len(set(colors)) == 2
    for label in range(2):
        assert len({c for c, r in zip(colors, mesh.region, strict=True) if r == label}) == 1
    (segments,) = (line for line in ax.lines if line.get_gid() == "segments")
    assert segments.get_linewidth() > 2 * facets.get_linewidths()[0]
    assert drawn(plot(mesh, axes(), segments=False)) == set()


def test_holes_and_the_outside_are_left_out():
    outer = [*OUTER, (20, 3)]
    mesh = ConstrainedDelaunay(outer + INNER, np.vstack((RING, RING + 5)), boundary="outline",
                               holes=[(3, 3)])  # fmt: skip
    ax = plot(mesh, axes())
    (facets,) = kinds(ax, PolyCollection)
    assert len(facets.get_paths()) == mesh.nsimplex < 10
    dots = ax.lines[-1].get_xydata()
    assert len(dots) == 8
    assert (dots[:, 0] <= 9).all()
    # All of the boundary is segments: nothing else marks it.
    assert [len(each.get_segments()) for each in kinds(ax, LineCollection)] == [0]


def test_segments_inside_of_holes_are_left_out():
    inside = [(2.5, 2.5), (3.5, 3.5)]
    mesh = ConstrainedDelaunay(OUTER + INNER + inside, [*RINGS, (8, 9)], holes=[(2.2, 3.8)])
    assert drawn(plot(mesh, axes())) == pairs(mesh, RINGS)


def test_the_hull_shows_where_it_is_no_segment():
    mesh = ConstrainedDelaunay([*OUTER, (12, 3)], RING)
    (hull,) = kinds(plot(mesh, axes()), LineCollection)
    found = {frozenset(map(tuple, step.tolist())) for step in hull.get_segments()}
    assert found == {frozenset([(9, 0), (12, 3)]), frozenset([(12, 3), (9, 6)])}
    assert not kinds(plot(mesh, axes(), hull=False), LineCollection)


def test_regions_at_one_segment_differ():
    random = np.random.default_rng(2)
    cuts = random.random((24, 2, 2)).reshape(-1, 2)
    mesh = ConstrainedDelaunay(cuts, np.arange(48).reshape(-1, 2), crossing="split")
    assert mesh.region.max() > 20
    color = cartography.color_of_regions(mesh)
    rows, corner = np.nonzero(mesh.neighbors >= 0)
    there = mesh.neighbors[rows, corner]
    across = mesh.region[rows] != mesh.region[there]
    assert across.any()
    assert (color[rows[across]] != color[there[across]]).all()
    assert (color[rows[~across]] == color[there[~across]]).all()


def test_no_label_is_gray():
    mesh = ConstrainedDelaunay(OUTER + INNER, RINGS, regions=[(3, 3, 7)])
    assert set(cartography.color_of_regions(mesh)[mesh.region == -1]) == {-1}
    (facets,) = kinds(plot(mesh, axes()), PolyCollection)
    colors = np.asarray(facets.get_facecolors())
    assert np.allclose(colors[mesh.region == -1], to_rgba("#f1f1f1"))


@pytest.mark.parametrize("deep", [False, True])
def test_many_triangles_become_an_image_with_a_white_hole(tmp_path, deep):
    points = noisy(40_000)
    mesh = ConstrainedDelaunay(points, RINGS, holes=[(3, 3)], crossing="split")
    z = mesh.points[:, 0] if deep else None
    ax = plot(mesh, axes(), z=z)
    assert len(ax.images) == 1
    assert not kinds(ax, PolyCollection)
    image = ax.images[0]
    left, right, bottom, top = image.get_extent()
    alpha = np.asarray(image.get_array())[..., 3]
    y, x = ((np.arange(n) + 0.5) / n for n in alpha.shape)
    x, y = np.meshgrid(left + x * (right - left), bottom + y * (top - bottom))
    hole = (x > 2.05) & (x < 3.95) & (y > 2.05) & (y < 3.95)
    ring = (x > 0.1) & (x < 8.9) & (y > 0.1) & (y < 5.9)
    ring &= (x < 1.95) | (x > 4.05) | (y < 1.95) | (y > 4.05)
    assert (alpha[hole] == 0).all()
    assert (alpha[ring] == 255).all()
    assert len(drawn(ax)) == len(mesh.segments) - np.count_nonzero(
        (mesh.points[mesh.segments] > 2.01).all(axis=(1, 2))
        & (mesh.points[mesh.segments] < 3.99).all(axis=(1, 2))
    )
    save_picture(tmp_path / "a.png", mesh, z=z, size=4, dpi=60)
    assert np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).std() > 5


def test_pixels_have_the_region_of_their_center():
    mesh = ConstrainedDelaunay(OUTER + INNER, RINGS)
    raster = facet_values(mesh, mesh.region, 90)
    inner = raster.values[20:40, 20:40]
    assert len(np.unique(inner)) == 1
    assert np.count_nonzero(raster.values == inner[0, 0]) == 400
    assert not np.isnan(raster.values).any()


def test_crowded_pixels_of_a_hole_are_empty():
    mesh = ConstrainedDelaunay(noisy(40_000), RINGS, holes=[(3, 3)], crossing="split")
    values = rasterize(mesh, mesh.points[:, 0], 90).values
    assert np.isnan(values[21:39, 21:39]).all()
    assert np.isfinite(values[1:-1, 1:19]).all()


def test_heights_color_triangles_and_segments_stay(tmp_path):
    mesh = ConstrainedDelaunay(OUTER + INNER, RINGS)
    ax = plot(mesh, axes(), z=np.arange(8.0))
    assert drawn(ax) == pairs(mesh, mesh.segments)
    (facets,) = kinds(ax, PolyCollection)
    assert len({tuple(color) for color in facets.get_facecolors()}) > 3
    with pytest.raises(InputError, match="hide each other"):
        plot(ConstrainedDelaunay(noisy(5000), []), axes(), circumcircles=True)


def test_very_many_segments(tmp_path):
    turn = np.linspace(0, 2 * np.pi, 60_000, endpoint=False)
    points = np.column_stack((np.cos(turn), np.sin(turn)))
    rows = np.arange(len(turn))
    mesh = ConstrainedDelaunay(points, np.column_stack((rows, np.roll(rows, -1))))
    ax = plot(mesh, axes())
    assert len(drawn(ax)) == 60_000
    save_picture(tmp_path / "a.png", mesh, size=4, dpi=60)


def test_no_triangle_at_all(tmp_path):
    mesh = ConstrainedDelaunay(OUTER, [], boundary="outline")
    assert mesh.nsimplex == 0
    save_picture(tmp_path / "a.png", mesh, size=4, dpi=60)
    save_picture(tmp_path / "b.png", mesh, z=np.arange(4), size=4, dpi=60)


def test_each_triangle_has_its_pixels():
    mesh = ConstrainedDelaunay(OUTER + INNER, RINGS)
    values = 1.0 + np.arange(mesh.npoints)
    raster = rasterize(mesh, values, 60)
    rows, columns = np.indices(raster.values.shape)
    x = raster.extent[0] + (columns + 0.5) * raster.cell
    y = raster.extent[2] + (rows + 0.5) * raster.cell
    at = mesh.find_simplex(np.column_stack((x.ravel(), y.ravel()))).reshape(rows.shape)
    for triangle in range(mesh.nsimplex):
        assert (at == triangle).any()
        assert np.isfinite(raster.values[at == triangle]).all(), triangle
    assert np.isnan(raster.values[at < 0]).all()
