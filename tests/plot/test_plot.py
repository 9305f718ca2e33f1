"""2-D plots: what is drawn, at which size, and that it is not blank."""

import sys

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.figure import Figure
from PIL import Image

import delone
from delone import (
    ConvexHull,
    Delaunay,
    InputError,
    MissingExtraError,
    ShapeError,
    Voronoi,
    datasets,
)
from delone.interpolate import grid
from delone.io import write_mesh, write_raster
from delone.plot import plot, save_picture

FIVE = Delaunay([(0, 0), (4, 0), (4, 3), (0, 3), (2, 1)])


@pytest.fixture(autouse=True)
def _close():
    yield
    plt.close("all")


def axes(size=(6, 5), dpi=100):
    return Figure(figsize=size, dpi=dpi).add_subplot()


def kinds(ax, kind):
    return [each for each in ax.collections if type(each) is kind]


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_edges_hull_and_points():
    ax = plot(FIVE, axes())
    (edges,) = kinds(ax, LineCollection)
    assert np.array_equal(edges.get_segments(), FIVE.points[FIVE.edges])
    hull, dots = ax.lines
    assert np.array_equal(hull.get_xydata(), FIVE.points[[0, 1, 2, 3, 0]])
    assert len(dots.get_xydata()) == 5
    assert not ax.images
    assert ax.get_aspect() == 1.0
    assert len(plot(FIVE, axes(), hull=False, vertices=False).lines) == 0


def test_circles_pass_through_the_corners():
    ax = plot(FIVE, axes(), circumcircles=True)
    (circles,) = kinds(ax, EllipseCollection)
    assert np.array_equal(circles.get_offsets(), FIVE.circumcenters)
    assert sorted(circles.get_widths() / 2) == pytest.approx(
        sorted(np.hypot(*(FIVE.points[FIVE.simplices[:, 0]] - FIVE.circumcenters).T))
    )
    with pytest.raises(InputError, match="hide each other"):
        plot(Delaunay(datasets.uniform(5000)), axes(), circumcircles=True)


def test_colors_of_heights():
    z = np.array([0.0, 0, 10, 10, 5])
    ax = plot(FIVE, axes(), z=z)
    (facets,) = kinds(ax, PolyCollection)
    assert len({tuple(color) for color in facets.get_facecolors()}) >= 3
    assert len(ax.figure.axes) == 2
    assert len(plot(FIVE, axes(), z=z, colorbar=False).figure.axes) == 1
    plot(FIVE, axes(), z=np.full(5, 3.0))
    with pytest.raises(ShapeError):
        plot(FIVE, axes(), z=z[:3])
    with pytest.raises(InputError, match="finite z"):
        plot(FIVE, axes(), z=np.full(5, np.nan))


def test_new_axes_come_from_pyplot():
    assert FIVE.plot() is plt.gca()
    ax = axes()
    assert FIVE.plot(ax) is ax


def test_many_triangles_become_an_image():
    mesh = Delaunay(datasets.uniform(100_000))
    for z in (None, mesh.points[:, 0]):
        ax = plot(mesh, axes(), z=z)
        assert len(ax.images) == 1
        assert not kinds(ax, LineCollection) and not kinds(ax, PolyCollection)


def test_ticks_say_the_coordinates():
    mesh = Delaunay(datasets.utm_millimeters(200))
    figure = Figure(figsize=(6, 6))
    figure.set_layout_engine("constrained")
    ax = plot(mesh, figure.add_subplot())
    figure.savefig(sys.modules["os"].devnull, format="png")
    assert ax.yaxis.get_offset_text().get_text() == ""
    labels = [label.get_text() for label in ax.get_yticklabels()]
    assert any(label.startswith("5400") and len(label) >= 7 for label in labels)


@pytest.mark.parametrize("width", [0.01, 1, 100])
def test_size_follows_the_data(tmp_path, width):
    mesh = Delaunay(datasets.uniform(50) * [width, 1])
    save_picture(tmp_path / "a.png", mesh, size=4, dpi=50)
    image = pixels(tmp_path / "a.png")
    assert max(image.shape[:2]) == pytest.approx(200, abs=2)
    assert min(image.shape[:2]) >= 80
    assert image.std() > 5


def test_the_surface_is_where_it_belongs(tmp_path):
    mesh = Delaunay(datasets.uniform(60_000))
    save_picture(
        tmp_path / "a.png",
        mesh,
        z=mesh.points[:, 0],
        size=5,
        dpi=80,
        cmap="gray",
        shade=False,
        hull=False,
    )
    image = pixels(tmp_path / "a.png")[..., 0]
    row = image[image.shape[0] // 2]
    surface = row[100:260]
    assert surface[0] < 90
    assert surface[-1] > 160
    assert (np.diff(surface[::10]) > 0).all()


def surface_colors(ax):
    """The colors of the triangles, or of the pixels of an image, (k, 3)."""
    if ax.images:
        pixels = np.asarray(ax.images[0].get_array()) / 255
        return pixels[pixels[..., 3] == 1][::37, :3]
    return kinds(ax, PolyCollection)[0].get_facecolor()[:, :3]


@pytest.mark.parametrize("domain", ["points", "mesh"])
@pytest.mark.parametrize("count", [1500, 3000, 100_000])
@pytest.mark.sampled(3)
def test_colors_are_those_of_the_color_bar(domain, count):
    if domain == "points":
        mesh = Delaunay(datasets.uniform(count))
    else:
        square = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
        mesh = delone.mesh(square, max_area=1 / count)
    x, y = mesh.points.T
    z = np.sin(9 * x) * np.cos(7 * y)
    known = matplotlib.colormaps["viridis"](np.linspace(0, 1, 256))[:, :3]

    def furthest(**options):
        colors = surface_colors(plot(mesh, axes(), z=z, cmap="viridis", **options))
        assert len(colors) > 1000
        return np.abs(colors[:, None] - known).max(axis=2).min(axis=1).max()

    assert furthest() <= 0.5 / 255 + 1e-9
    assert furthest(shade=True) > 0.1
    many = mesh.nsimplex >= 2000
    assert (furthest(colorbar=False) > 0.1) == many


@pytest.mark.parametrize("name", ["heat", "depth"])
def test_rasters_in_files_are_shaded_where_they_are_terrain(tmp_path, name):
    points = datasets.uniform(500)
    x, y = points.T
    found = grid(points, np.sin(9 * x) * np.cos(7 * y), shape=(80, 80))
    bright = []
    for each in (name, "heat"):
        write_raster(tmp_path / "a.png", found, name=each)
        bright.append(pixels(tmp_path / "a.png")[200:-200, 200:-500])
    assert (bright[0] == bright[1]).all() == (name == "heat")


@pytest.mark.parametrize("suffix", [".png", ".svg"])
@pytest.mark.parametrize("count", [200, 30_000])
def test_files(tmp_path, suffix, count):
    mesh = Delaunay(datasets.uniform(count))
    file = tmp_path / f"a{suffix}"
    save_picture(file, mesh, z=np.sin(9 * mesh.points[:, 0]), crs="EPSG:28992", size=5, dpi=60)
    content = file.read_bytes()
    if suffix == ".png":
        assert len(np.unique(pixels(file).reshape(-1, 3), axis=0)) > 200
    else:
        assert b"<svg" in content and content.rstrip().endswith(b"</svg>")
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


@pytest.mark.parametrize("scale", [1e-300, 1e-9, 1e9, 1e150])
def test_odd_units(tmp_path, scale):
    mesh = Delaunay(datasets.uniform(300) * scale)
    save_picture(tmp_path / "a.png", mesh, z=mesh.points[:, 1], size=4, dpi=50)
    assert pixels(tmp_path / "a.png").std() > 5


def test_heights_with_holes(tmp_path):
    for count in (500, 50_000):
        mesh = Delaunay(datasets.uniform(count))
        z = mesh.points[:, 0].copy()
        z[::3] = np.nan
        save_picture(tmp_path / "a.png", mesh, z=z, size=4, dpi=50)
        assert pixels(tmp_path / "a.png").std() > 5


def test_without_matplotlib(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(MissingExtraError, match=r"delone\[plot\]"):
        FIVE.plot()
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(MissingExtraError):
        save_picture(tmp_path / "a.png", FIVE)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "points",
    [
        [(-1e308, -1e308), (1e308, -1e308), (0, 1.5e308)],
        [(0, 0), (5e-324, 0), (0, 5e-324)],
        [(1.7e308, 0), (0, 1e308), (1, 1)],
    ],
)
@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_what_no_picture_can_hold_is_refused(tmp_path, points, suffix):
    with pytest.raises(InputError, match="power of two"):
        save_picture(tmp_path / f"a.{suffix}", Delaunay(points))


def test_heights_of_which_nothing_shows_are_refused(tmp_path):
    with pytest.raises(InputError, match="row 2"):
        save_picture(tmp_path / "a.png", Delaunay([(0, 0), (1, 0), (0, 1)]), z=[1, 2, np.nan])


SPACE = datasets.uniform(20, ndim=3)


@pytest.mark.parametrize(
    ("other", "instead"),
    [
        (Delaunay(SPACE), "plot draws it with PyVista"),
        (ConvexHull(SPACE), "plot draws it with PyVista"),
        (ConvexHull(FIVE.points), "delone.plot.plot draws it"),
        (Voronoi(FIVE.points), "delone.plot.plot draws it"),
        (Voronoi(SPACE), "plot draws it with PyVista"),
        (FIVE.quality(), "own plot"),
        (FIVE.points, "draw delone.Delaunay"),
        (Delaunay, "2-D triangulation"),
    ],
)
def test_pictures_are_of_2d_triangulations(tmp_path, other, instead):
    with pytest.raises(InputError, match=instead):
        save_picture(tmp_path / "a.png", other)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.deep
def test_files_of_heights_are_shaded_and_fields_are_not(tmp_path):
    square = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}
    mesh = delone.mesh(square, max_area=1 / 3000)
    terrain = Delaunay(mesh.points)
    for each, lit in ((terrain, True), (mesh, False)):
        z = np.sin(9 * each.points[:, 0]) * np.cos(7 * each.points[:, 1])
        write_mesh(tmp_path / "a.png", each, z=z)
        pictures = [pixels(tmp_path / "a.png")]
        for shade in (True, False):
            save_picture(tmp_path / "b.png", each, z=z, shade=shade)
            pictures.append(pixels(tmp_path / "b.png"))
        assert (pictures[0] == pictures[1]).all() == lit
        assert (pictures[0] == pictures[2]).all() != lit


@pytest.mark.parametrize("name", ["a.xyz", "a"])
def test_files_of_unknown_formats_are_refused(tmp_path, name):
    with pytest.raises(InputError, match=r"path must end with .*\.png, .*\.svg"):
        save_picture(tmp_path / name, FIVE)
    assert not list(tmp_path.iterdir())
    save_picture(tmp_path / "a.PNG", FIVE, size=3, dpi=50)
