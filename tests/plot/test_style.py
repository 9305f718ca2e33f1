"""Line styles and colors of the caller reach matplotlib, in all classes that draw in 2-D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import datasets
from delone.graphs import Graph
from delone.plot.style import EDGES
from delone.terrain import TIN

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

plt = pytest.importorskip("matplotlib.pyplot")
POINTS = datasets.uniform(60, seed=3)
RING = [(0, 0), (4, 0), (4, 4), (0, 4)]
HILL = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (2, 2, 3)])
MAKE: dict[str, Callable[[], Any]] = {
    "Delaunay": lambda: delone.Delaunay(POINTS),
    "Delaunay, many": lambda: delone.Delaunay(datasets.uniform(30_000)),
    "ConstrainedDelaunay": lambda: delone.ConstrainedDelaunay(RING, [(0, 2)]),
    "Mesh": lambda: delone.mesh((RING, [(0, 1), (1, 2), (2, 3), (3, 0)]), max_area=1),
    "Regular": lambda: delone.RegularTriangulation(POINTS, POINTS[:, 0] / 9),
    "Periodic": lambda: delone.PeriodicDelaunay(POINTS, (2, 2)),
    "ConvexHull": lambda: delone.ConvexHull(POINTS),
    "AlphaShape": lambda: delone.AlphaComplex(POINTS).shape(0.01),
    "ConcaveHull": lambda: delone.concave_hull(POINTS, ratio=0.2),
    "Voronoi": lambda: delone.Voronoi(POINTS, clip="box"),
    "Graph": lambda: Graph(RING, [(0, 1), (1, 3)]),
    "TIN": lambda: HILL,
    "Dynamic": lambda: delone.Dynamic(POINTS),
    "Bands": lambda: HILL.bands(interval=1),
    "Contours": lambda: HILL.contours(interval=1),
}


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    plt.switch_backend("Agg")
    yield
    plt.close("all")


@pytest.mark.parametrize("name", list(MAKE))
def test_styles_reach_the_lines(name: str) -> None:
    made = MAKE[name]()
    ax = plt.figure().add_subplot()
    style = {"color": "#ff0080", "linewidth": 3.5, "linestyle": "--", "alpha": 0.5}
    assert made.plot(ax, **style) is ax
    lines = [each for each in ax.get_children() if each.get_gid() == EDGES]
    if name in ("Bands", "Contours"):
        lines = list(ax.collections)
    assert len(lines) == 1
    found = np.atleast_2d(lines[0].get_edgecolor())
    assert np.allclose(found, [1, 0, 128 / 255, 0.5])
    assert np.allclose(lines[0].get_linewidth(), 3.5)
    dashes = lines[0].get_linestyle()
    assert dashes == "--" or dashes[0][1]
    plt.gcf().canvas.draw()


@pytest.mark.parametrize("name", list(MAKE))
def test_what_is_no_option_is_refused(name: str) -> None:
    made = MAKE[name]()
    for wrong in ("colour", "transform", "offsets"):
        with pytest.raises(delone.InputError, match=f"{wrong} is not an option.*linewidth"):
            made.plot(**{wrong: "red"})
    with pytest.raises(delone.InputError, match="matplotlib does not take color='reddish'"):
        made.plot(color="reddish")


def test_solids_have_no_lines() -> None:
    pytest.importorskip("pyvista")
    solid = delone.Delaunay(datasets.uniform(20, ndim=3))
    with pytest.raises(delone.InputError, match="linestyle is not an option"):
        solid.plot(linestyle="--", off_screen=True)


def test_what_was_drawn_before_keeps_its_style() -> None:
    ax = plt.figure().add_subplot()
    delone.Delaunay(POINTS).plot(ax, color="red")
    delone.Voronoi(POINTS, clip="box").plot(ax, color="blue")
    first, second = (each for each in ax.get_children() if each.get_gid() == EDGES)
    assert np.allclose(first.get_edgecolor(), [1, 0, 0, 1])
    assert np.allclose(second.get_edgecolor(), [0, 0, 1, 1])


def test_edges_can_be_left_out_or_asked_for() -> None:
    def drawn(mesh: Any, **options: Any) -> int:
        ax = mesh.plot(plt.figure().add_subplot(), **options)
        return sum(each.get_gid() == EDGES for each in ax.get_children())

    few, many = delone.Delaunay(POINTS), delone.Delaunay(datasets.uniform(30_000))
    assert [drawn(few), drawn(few, edges=False), drawn(few, edges=True)] == [1, 0, 1]
    assert [drawn(many), drawn(many, edges=False), drawn(many, edges=True)] == [0, 0, 1]


def test_edges_of_an_alpha_shape_without_triangles() -> None:
    shape = delone.AlphaComplex([(0, 0), (4, 0), (0, 3), (9, 9)]).shape(4)
    assert shape.loose_edges.tolist() == [[0, 1], [0, 2]]
    (lines,) = (each for each in shape.plot().get_children() if each.get_gid() == EDGES)
    assert len(lines.get_segments()) == 2
    whole = delone.AlphaComplex(POINTS).shape(np.inf)
    assert len(whole.loose_edges) == 0


def test_bands_have_the_colors_of_their_heights() -> None:
    bands = HILL.bands(interval=1)
    ax = bands.plot(colorbar=False, title="hill")
    (drawn,) = ax.collections
    assert drawn.get_array().tolist() == bands.low.tolist()
    assert ax.get_title() == "hill"
    assert len(drawn.get_paths()) == len(bands)
