"""Labels of contours: on their lines, along them, readable, and no more than asked for."""

from __future__ import annotations

import math

import numpy as np
import pytest

from delone import InputError
from delone.io import write_drawing
from delone.terrain import TIN

shapely = pytest.importorskip("shapely")
ezdxf = pytest.importorskip("ezdxf")


def hill(scale: float = 1.0, low: float = 0.0):
    rng = np.random.default_rng(8)
    xy = np.concatenate(([(0, 0), (100, 0), (100, 100), (0, 100)], rng.uniform(0, 100, (900, 2))))
    z = 30 * np.exp(-((xy - 45) ** 2).sum(axis=1) / 700) + xy[:, 1] / 20
    return TIN.from_points(np.column_stack((xy * scale + low, z))).contours(interval=1)


@pytest.mark.parametrize(
    "options", [{}, {"length": 5}, {"length": 3, "spacing": 40}, {"length": 30}]
)
def test_labels_are_on_their_lines_and_along_them(options):
    contours = hill()
    found = contours.labels(**options)
    lines = contours.to_shapely()
    assert (np.diff(found.line) >= 0).all() and len(found) > 10
    assert found.level.tolist() == contours.level[found.line].tolist()
    assert found.text == tuple(f"{level:g}" for level in found.level)
    assert ((found.angle > -90) & (found.angle <= 90)).all()
    labeled = set(found.line.tolist())
    for row, line in enumerate(lines):
        assert (row in labeled) == (line.length >= 2 * found.length)
    assert found.short == len(contours) - len(labeled)
    assert (found.short > 0) == (found.length == 30)
    for place, angle, row in zip(found.points, found.angle, found.line, strict=True):
        flat = shapely.force_2d(lines[row])
        at = flat.project(shapely.Point(place))
        assert flat.distance(shapely.Point(place)) < 1e-9
        half = found.length / 2
        assert half - 1e-6 <= at <= flat.length - half + 1e-6
        ends = [flat.interpolate(at + side * half) for side in (-1, 1)]
        way = math.degrees(math.atan2(ends[1].y - ends[0].y, ends[1].x - ends[0].x))
        assert abs((way - angle + 90) % 180 - 90) < 1e-6


def test_a_label_is_where_its_line_is_straightest():
    # A line that is straight only in its last third.
    steps = np.arange(41.0)
    zigzag = np.column_stack((steps, np.where(steps % 2, 1.0, 0.0)))
    line = np.concatenate((zigzag, [(80.0, 0.0)]))
    from delone.terrain.labeling import labels_of

    marked = np.array([False])
    found = labels_of(
        [line], np.array([7.5]), marked, index=False, length=8.0, spacing=None, crs=None
    )
    assert found.text == ("7.5",) and found.points[0, 0] > 44 and found.angle.tolist() == [0]
    # With a text in each of several parts, each has its own.
    found = labels_of(
        [line], np.array([7.5]), marked, index=False, length=4.0, spacing=16.0, crs=None
    )
    whole = 40 * math.sqrt(2) + 40
    assert len(found) == math.floor(whole / 16)


def test_spacing_and_index_contours():
    contours = hill()
    few, many = contours.labels(length=3), contours.labels(length=3, spacing=30)
    assert len(many) > len(few) and set(many.line.tolist()) == set(few.line.tolist())
    marked = contours.labels(length=3, index=True)
    assert marked.index.all() and set(marked.level % 5) == {0}
    table = few.to_geopandas(crs=28992)
    assert list(table.columns) == ["level", "index", "text", "angle", "line", "geometry"]
    assert table.crs.to_epsg() == 28992 and table["index"].tolist() == few.index.tolist()


def test_large_coordinates_and_scales_give_the_same_labels():
    one, other = hill().labels(length=4), hill(scale=4, low=2.0**20).labels(length=16)
    assert other.line.tolist() == one.line.tolist()
    assert other.angle == pytest.approx(one.angle, abs=1e-4)
    assert (other.points - 2.0**20) / 4 == pytest.approx(one.points, abs=1e-6)


def test_no_lines_and_options_out_of_range():
    none = TIN.from_points([(0, 0, 0), (4, 0, 0), (4, 4, 1), (0, 4, 1)]).contours([7])
    found = none.labels()
    assert len(found) == 0 and found.points.shape == (0, 2) and len(found.to_geopandas()) == 0
    assert repr(found) == "<Labels of contours: 0 labels, 0 lines too short>"
    for options in ({"length": 0}, {"length": math.inf}, {"spacing": 0}, {"spacing": math.nan}):
        with pytest.raises(InputError, match="length and spacing must be above 0"):
            hill().labels(**options)
    with pytest.raises(InputError, match="more than 1,000,000 labels"):
        hill().labels(length=1e-5, spacing=1e-5)


def test_labels_in_plots_and_drawings(tmp_path):
    pyplot = pytest.importorskip("matplotlib.pyplot")
    contours = hill()
    marked = contours.labels(index=True)
    ax = contours.plot(labels=True)
    ax.figure.canvas.draw()
    texts = ax.texts
    assert tuple(each.get_text() for each in texts) == marked.text
    assert [each.get_rotation() for each in texts] == pytest.approx(marked.angle % 360)
    assert len(contours.plot(labels=contours.labels(length=3)).texts) > len(marked)
    assert len(contours.plot().texts) == 0
    pyplot.close("all")
    path = tmp_path / "a.dxf"
    write_drawing(path, contours, text_height=1.5)
    found = ezdxf.readfile(path).modelspace().query('TEXT[layer=="CONTOURS_TEXT"]')
    wanted = contours.labels(length=6, index=True)
    assert tuple(each.dxf.text for each in found) == wanted.text
    assert [each.dxf.rotation for each in found] == wanted.angle.tolist()
    assert [tuple(each.dxf.align_point)[:2] for each in found] == [
        tuple(place) for place in wanted.points.tolist()
    ]
