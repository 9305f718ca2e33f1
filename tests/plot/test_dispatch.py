"""One function plots every class; hulls, periodic triangulations and diagrams in 2-D."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import matplotlib

matplotlib.use("Agg")

import numpy as np
import pytest
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.figure import Figure

import delone
from delone import (
    ConstrainedDelaunay,
    ConvexHull,
    Delaunay,
    InputError,
    PeriodicDelaunay,
    RegularTriangulation,
    Voronoi,
    datasets,
)
from delone.plot import plot

POINTS = datasets.uniform(30)
SQUARE = {"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1), (0, 1)]]}


def axes() -> Any:
    return Figure().add_subplot()


def periods(ax: Any) -> list[Any]:
    """The sides of the period."""
    return [line.get_xydata().tolist() for line in ax.lines if line.get_gid() == "period"]


@pytest.mark.parametrize(
    ("mesh", "kind", "count"),
    [
        (Delaunay(POINTS), LineCollection, lambda mesh: len(mesh.edges)),
        (RegularTriangulation(POINTS, np.zeros(30)), LineCollection, lambda mesh: len(mesh.edges)),
        (ConstrainedDelaunay(POINTS, [(0, 1)]), PolyCollection, lambda mesh: mesh.nsimplex),
        (delone.mesh(SQUARE, max_area=0.1), PolyCollection, lambda mesh: mesh.nsimplex),
        (PeriodicDelaunay(POINTS, (1, 1)), PolyCollection, lambda mesh: mesh.nsimplex),
        (PeriodicDelaunay(POINTS, periods=(1, None)), PolyCollection, lambda mesh: mesh.nsimplex),
        (Voronoi(POINTS), PathCollection, lambda mesh: mesh.npoints),
        (Voronoi(POINTS, weights=np.zeros(30)), PathCollection, lambda mesh: mesh.npoints),
    ],
    ids=lambda value: type(value).__name__,
)
def test_each_class_is_drawn(mesh: Any, kind: type, count: Any) -> None:
    ax = axes()
    assert plot(mesh, ax) is ax
    (found,) = (each for each in ax.collections if type(each) is kind and each.get_paths())
    assert len(found.get_paths()) == count(mesh)
    assert ax.get_aspect() == 1.0


def test_a_hull_is_a_polygon_over_the_points() -> None:
    hull = ConvexHull(POINTS)
    ax = plot(hull, axes(), title="a hull")
    (outline,) = ax.patches
    assert outline.get_xy()[:-1].tolist() == POINTS[hull.vertices].tolist()
    (dots,) = ax.lines
    assert dots.get_xydata().tolist() == POINTS.tolist()
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert left < POINTS[:, 0].min() and right > POINTS[:, 0].max()
    assert low < POINTS[:, 1].min() and high > POINTS[:, 1].max()
    assert ax.get_title() == "a hull"
    assert not plot(hull, axes(), vertices=False).lines
    assert not plot(ConvexHull(datasets.uniform(2001)), axes()).lines


def test_triangles_of_one_period_and_its_box() -> None:
    points = POINTS * [3, 2] + [5, -7]
    mesh = PeriodicDelaunay(points, (3, 2))
    ax = plot(mesh, axes())
    corners = [path.vertices[:3] for path in ax.collections[0].get_paths()]
    assert np.array_equal(corners, mesh.corners)
    sides = np.array(periods(ax))
    assert len(sides) == 4
    low, high = sides.min(axis=(0, 1)), sides.max(axis=(0, 1))
    assert high - low == pytest.approx([3, 2])
    assert (low < points).all() and (points < high).all()
    left, right = ax.get_xlim()
    assert left < mesh.corners[..., 0].min() and right > mesh.corners[..., 0].max()
    assert not periods(plot(mesh, axes(), box=False))
    assert len(plot(mesh, axes(), box=False, vertices=False).lines) == 0


@pytest.mark.parametrize("axis", [0, 1])
def test_one_period_has_two_sides(axis: int) -> None:
    lengths = (2.0, None) if axis == 0 else (None, 2.0)
    mesh = PeriodicDelaunay(POINTS, lengths)
    first, second = np.array(periods(plot(mesh, axes())))
    assert (second - first)[:, axis] == pytest.approx([2, 2])
    assert (second - first)[:, 1 - axis] == pytest.approx([0, 0])
    extent = np.ptp(mesh.corners[..., 1 - axis])
    assert abs(first[1] - first[0])[1 - axis] == pytest.approx(extent)


def test_a_diagram_is_seen_as_far_as_its_clip() -> None:
    ax = plot(Voronoi(POINTS, clip=(0.2, 0.3, 0.8, 0.9)), axes())
    assert ax.get_xlim() + ax.get_ylim() == (0.2, 0.8, 0.3, 0.9)
    corners = np.concatenate([path.vertices for path in ax.collections[0].get_paths()])
    assert corners.min(axis=0).tolist() == [0.2, 0.3]
    assert corners.max(axis=0).tolist() == [0.8, 0.9]


def test_coordinates_that_overflow_are_refused() -> None:
    far = [(-1e308, -1e308), (1e308, -1e308), (0, 1.5e308)]
    with pytest.raises(InputError, match="power of two"):
        plot(ConvexHull(far), axes())
    with pytest.raises(InputError, match="power of two"):
        plot(PeriodicDelaunay([(0, 0), (1e307, 1e306)], (1e308, 1e308)), axes())


FAR = [(1e300, -1e300), (-1e300, 1e300), (1.7e308, 1.7e308), (-1.7e308, -1.7e308), (0, 0)]


@pytest.mark.parametrize(
    ("points", "options"),
    [
        (FAR, {}),
        (FAR, {"clip": "box"}),
        ([(0, 0), (1, 1)], {"clip": (-1e308, -1e308, 1e308, 1e308)}),
        ([(0, 0), (3e-310, 2e-310)], {}),
        ([(1e300, 1), (1e300, 2), (0, 2e300)], {"periods": (1e306, None)}),
    ],
)
@pytest.mark.filterwarnings("error")
def test_cells_out_of_range_are_refused_like_triangles(points: Any, options: Any) -> None:
    with pytest.raises(InputError, match="power of two") as caught:
        plot(Voronoi(points, **options), axes())
    assert "clip" not in str(caught.value)


@pytest.mark.parametrize("points", [[(1e17, 0)], [(1e17, 0), (1e17, 16)], [(0, 0)]])
def test_sites_on_a_line_far_away_have_a_window(points: Any) -> None:
    ax = plot(Voronoi(points), axes())
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert left < points[0][0] < right and low < points[0][1] < high
    ax.figure.canvas.draw()


PLOTTED = [
    Delaunay(POINTS),
    RegularTriangulation(POINTS, np.zeros(30)),
    ConstrainedDelaunay(POINTS, []),
    delone.mesh(SQUARE),
    PeriodicDelaunay(POINTS, (1, 1)),
    ConvexHull(POINTS),
    Voronoi(POINTS),
]


@pytest.mark.parametrize("mesh", PLOTTED, ids=lambda mesh: type(mesh).__name__)
@pytest.mark.parametrize("ax", [3, "ax", Figure(), object()], ids=lambda ax: type(ax).__name__)
def test_anything_but_axes_is_refused(mesh: Any, ax: Any) -> None:
    wanted = f"ax must be matplotlib axes.* got {type(ax).__name__}"
    with pytest.raises(InputError, match=wanted):
        mesh.plot(ax)


def test_histograms_and_rasters_refuse_other_axes() -> None:
    found = delone.interpolate.grid(POINTS, POINTS[:, 0], shape=(9, 9))
    mesh = delone.mesh(SQUARE)
    for draw in (mesh.plot_quality, mesh.quality().plot, found.plot):
        with pytest.raises(InputError, match="ax must be matplotlib axes"):
            draw(3)


@pytest.mark.parametrize("cmap", ["nope", 3, ["red", "blue"]])
def test_unknown_colormaps_are_refused(cmap: Any) -> None:
    values = POINTS[:, 0]
    for mesh, options in (
        (Delaunay(POINTS), {"z": values}),
        (Delaunay(POINTS), {}),
        (Voronoi(POINTS), {"values": values}),
        (delone.interpolate.grid(POINTS, values, shape=(9, 9)), {}),
    ):
        with pytest.raises(InputError, match="cmap must be a Colormap"):
            mesh.plot(axes(), cmap=cmap, **options)


def test_values_of_cells_are_numbers_one_for_each_site() -> None:
    for wrong in (POINTS[:3, 0], ["a"] * 30, POINTS):
        with pytest.raises(InputError, match=r"^values "):
            plot(Voronoi(POINTS), axes(), values=wrong)
    with pytest.raises(InputError, match="linewidth"):
        plot(Voronoi(POINTS), axes(), linewidth="thick")


def test_options_of_other_kinds_are_refused() -> None:
    for mesh in PLOTTED:
        with pytest.raises(InputError, match=r"foo is not an option .*; its options are "):
            plot(mesh, axes(), foo=1)
    for mesh in (Delaunay(POINTS), ConvexHull(POINTS), PeriodicDelaunay(POINTS, (1, 1))):
        with pytest.raises(InputError, match=r"cut is not an option .*; its options are .*title"):
            plot(mesh, axes(), cut="x")
    with pytest.raises(InputError, match="z is not an option"):
        plot(ConvexHull(POINTS), axes(), z=POINTS[:, 0])


def test_anything_else_is_refused() -> None:
    with pytest.raises(InputError, match=r"numpy\.ndarray cannot be drawn: draw delone\.Delaunay"):
        plot(POINTS)
    with pytest.raises(InputError, match="use its own plot"):
        plot(Delaunay(POINTS).quality())
    with pytest.raises(InputError, match="cannot be drawn"):
        plot(Delaunay)


def test_objects_of_other_packages_are_drawn_by_their_attributes() -> None:
    hull = ConvexHull(POINTS)
    names = ("points", "simplices", "vertices")
    like = SimpleNamespace(**{name: getattr(hull, name) for name in names})
    (outline,) = plot(like, axes()).patches
    assert outline.get_xy()[:-1].tolist() == POINTS[hull.vertices].tolist()
