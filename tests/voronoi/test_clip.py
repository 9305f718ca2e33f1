"""Cells cut to boxes and outlines tile what they are cut to, exactly where that is promised."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from delone.datasets import tilted_grid, uniform
from delone.errors import InputError
from delone.voronoi import Voronoi
from rational import area, exact
from tiers import examples

shapely = pytest.importorskip("shapely")


def exact_sum(diagram: Voronoi) -> Fraction:
    sites = np.unique(diagram.duplicate_of)
    rings = [part[0] for site in sites for part in diagram.cell(int(site)).parts]
    return sum((area(exact(ring)) for ring in rings), Fraction(0))


def star(corners: int, inner: float = 0.3) -> Any:
    angle = np.linspace(0, 2 * np.pi, 2 * corners, endpoint=False)
    radius = np.where(np.arange(2 * corners) % 2, inner, 0.48)
    return shapely.Polygon(0.5 + radius[:, None] * np.column_stack((np.cos(angle), np.sin(angle))))


def comb() -> Any:
    """Teeth that cut cells into parts, and a hole."""
    teeth = [(0.05 * i, 0.9 if i % 2 else 0.3) for i in range(1, 20)]
    outer = shapely.Polygon([(0.0, 0.05), *teeth, (1.0, 0.05)])
    return outer - shapely.box(0.35, 0.12, 0.6, 0.2)


OUTLINES = {
    "star": star(9),
    "fine star": star(2000),
    "comb": comb(),
    "islands": shapely.MultiPolygon(
        [
            shapely.box(0.1, 0.1, 0.3, 0.3),
            shapely.box(0.95, 0.9, 1.4, 1.2),
            shapely.Point(0.6, 0.5).buffer(0.2),
        ]
    ),
    "far away": shapely.box(5, 5, 6, 6),
    "within one cell": shapely.Point(0.5, 0.5).buffer(1e-4),
}
SITES = {
    "uniform": uniform(300, seed=1),
    "tilted grid": tilted_grid(200),
    "circle": np.column_stack((np.cos(range(50)), np.sin(range(50)))) / 3 + 0.5,
    "one": np.array([(0.5, 0.5)]),
    "two": np.array([(0.25, 0.5), (0.75, 0.5)]),
    "line": np.column_stack((np.linspace(0, 1, 20), np.full(20, 0.4))),
}


@pytest.mark.parametrize("sites", SITES)
@pytest.mark.parametrize("outline", OUTLINES)
@pytest.mark.deep("fine star-line", "fine star-uniform")
@pytest.mark.sampled(11)
def test_cells_tile_the_outline(sites: str, outline: str) -> None:
    geometry = OUTLINES[outline]
    diagram = Voronoi(SITES[sites], clip=geometry)
    cells = diagram.polygons()
    size = geometry.area
    assert shapely.is_valid(cells).all()
    assert diagram.cell_areas.sum() == pytest.approx(size, rel=1e-11)
    assert diagram.cell_areas == pytest.approx(shapely.area(cells), rel=1e-9, abs=1e-12 * size)
    assert diagram.cell_perimeters == pytest.approx(shapely.length(cells), rel=1e-9)
    union = shapely.union_all(cells)
    assert union.symmetric_difference(geometry).area <= 1e-11 * size
    # Disjoint: what is counted twice would be missing from the union.
    assert union.area == pytest.approx(shapely.area(cells).sum(), rel=1e-11)


@pytest.mark.parametrize("outline", ["star", "comb", "islands"])
def test_cells_are_those_of_the_plain_way(outline: str) -> None:
    geometry, points = OUTLINES[outline], SITES["uniform"]
    whole = Voronoi(points, clip=(-3, -3, 4, 4)).polygons()
    plain = shapely.intersection(whole, geometry)
    cells = Voronoi(points, clip=geometry).polygons()
    assert shapely.area(shapely.symmetric_difference(plain, cells)).max() < 1e-14
    assert np.array_equal(shapely.is_empty(plain), shapely.is_empty(cells))


def test_cells_are_in_the_order_of_the_sites() -> None:
    points = SITES["uniform"]
    cells = Voronoi(points, clip="box").polygons()
    assert shapely.intersects_xy(cells, points).all()


def test_a_cell_may_have_several_parts_and_holes() -> None:
    outline = shapely.box(0, 0, 10, 4) - shapely.box(2, -1, 3, 5) - shapely.box(5, 1, 6, 2)
    diagram = Voronoi([(4, 2)], clip=outline)
    cell = diagram.cell(0)
    assert len(cell.parts) == 2
    assert sorted(len(part) for part in cell.parts) == [1, 2]
    assert cell.area == pytest.approx(40 - 4 - 1)
    assert cell.perimeter == pytest.approx(12 + 2 * (7 + 4) + 4)
    assert diagram.polygons()[0].geom_type == "MultiPolygon"
    total = sum(shapely.Polygon(rings[0], rings[1:]).area for rings in cell.parts)
    assert total == pytest.approx(cell.area)


@settings(max_examples=examples(40, deep=400), deadline=None)
@given(
    st.lists(st.tuples(st.integers(0, 7), st.integers(0, 7)), min_size=1, max_size=20),
    st.tuples(st.integers(-3, 6), st.integers(-3, 6), st.integers(1, 9), st.integers(1, 9)),
)
def test_in_a_box_exact_areas_sum_to_that_of_the_box(
    sites: list[tuple[int, int]], box: tuple[int, int, int, int]
) -> None:
    left, bottom, width, height = box
    diagram = Voronoi(sites, clip=(left, bottom, left + width, bottom + height))
    assert exact_sum(diagram) == width * height
    corners = np.concatenate([part[0] for i in range(len(sites)) for part in diagram.cell(i).parts])
    assert corners.min(axis=0).tolist() == [left, bottom]
    assert corners.max(axis=0).tolist() == [left + width, bottom + height]


@pytest.mark.parametrize(
    "points",
    [
        uniform(200, seed=2),
        tilted_grid(100),
        uniform(100, seed=3) * [1, 1e-12],
        uniform(100, seed=4) * 1e-8 + 1,
        np.column_stack((np.cos(range(300)), np.sin(range(300)))),
        np.ldexp(uniform(50, seed=5), 1000),
        np.array([*((i, 0.0) for i in range(16)), (7.5, 5e-324)]),
    ],
    ids=["uniform", "tilted", "flat", "cluster", "circle", "huge", "far vertices"],
)
def test_areas_sum_exactly_on_hard_sites_too(points: Any) -> None:
    low, high = points.min(axis=0), points.max(axis=0)
    for box in ([*low, *high], [-1, -1, 1, 1], [*(low - (high - low)), *(low + (high - low) / 3)]):
        diagram = Voronoi(points, clip=box)
        left, bottom, right, top = map(Fraction, map(float, box))
        assert exact_sum(diagram) == (right - left) * (top - bottom)
        assert (diagram.cell_areas >= 0).all()


def test_corners_on_a_side_of_the_box_are_where_both_sites_are_equally_near() -> None:
    points = uniform(200, seed=6)
    diagram = Voronoi(points, clip="box")
    low, high = points.min(axis=0), points.max(axis=0)
    for site in range(200):
        for ring in (part[0] for part in diagram.cell(site).parts):
            on_side = ((ring == low) | (ring == high)).sum(axis=1) == 1
            distance = np.hypot(*(ring[on_side][:, None] - points).T).T
            assert np.allclose(distance[:, site], distance.min(axis=1), rtol=1e-12)
            two = np.sort(distance, axis=1)[:, :2]
            assert np.allclose(two[:, 0], two[:, 1], rtol=1e-12)


def test_neighbors_count_what_is_left_of_their_edge() -> None:
    points = [(0, 0), (2, 0), (0, 2), (2, 2)]
    outline = shapely.box(-1, -1, 3, 3) - shapely.box(0.5, -2, 1.5, 0.5)
    _indptr, indices, lengths = Voronoi(points, clip=outline).neighbors
    assert indices.tolist() == [1, 2, 0, 3, 0, 3, 1, 2]
    # The notch takes half a unit of each of three edges, and all but half of the fourth.
    assert lengths.tolist() == pytest.approx([0.5, 2.0, 0.5, 2.0, 2.0, 2.0, 2.0, 2.0])
    far = Voronoi(points, clip=shapely.box(-1, -1, 0.5, 3)).neighbors
    assert far.indices.tolist() == [2, 0]
    assert far.sizes.tolist() == pytest.approx([1.5, 1.5])


def test_lengths_are_those_of_intersections() -> None:
    points, outline = SITES["uniform"], OUTLINES["comb"]
    diagram = Voronoi(points, clip=outline)
    cells = diagram.polygons()
    indptr, indices, lengths = diagram.neighbors
    for i in range(0, 300, 7):
        for j, length in zip(
            indices[indptr[i] : indptr[i + 1]], lengths[indptr[i] : indptr[i + 1]], strict=True
        ):
            near = shapely.set_precision(cells[[i, j]], 1e-10)
            common = shapely.intersection(*near).length
            assert length == pytest.approx(common, abs=1e-7)


def test_without_a_clip_unbounded_cells_have_no_polygon() -> None:
    cells = Voronoi([(0, 0), (4, 0), (4, 4), (0, 4), (2, 2)]).polygons()
    assert [cell is None for cell in cells] == [True] * 4 + [False]


def test_sites_outside_may_have_empty_cells() -> None:
    diagram = Voronoi([(0, 0), (1, 0), (50, 50)], clip=(-1, -1, 2, 1))
    assert diagram.cell_areas.tolist() == [3.0, 3.0, 0.0]
    assert diagram.polygons()[2].is_empty
    assert np.isnan(diagram.cell_centroids[2]).all()
    assert diagram.cell(2).parts == ()


@pytest.mark.parametrize(
    ("clip", "message"),
    [
        ("hull", "'box', four numbers or a polygon"),
        ((0, 0, 1), "four numbers"),
        ((0, 0, 0, 1), "no area"),
        ((1, 0, 0, 1), "xmin 1.0 must be below xmax 0.0"),
        ((0, 0, np.inf, 1), "finite"),
        (5, "four numbers"),
        (shapely.Point(0, 0), "got a Point"),
        (shapely.Polygon(), "no area"),
        (shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)]), r"Self-intersection\[1 1\]"),
        (shapely.Polygon([(0, 0), (np.inf, 2), (2, 0)]), "NaN or infinite"),
    ],
)
def test_what_is_no_clip_is_refused(clip: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Voronoi([(0, 0), (1, 1)], clip=clip)


def test_a_box_of_sites_on_an_axis_has_no_area() -> None:
    with pytest.raises(InputError, match="no area"):
        Voronoi([(0, 0), (1, 0)], clip="box")


def test_an_invalid_outline_can_be_repaired() -> None:
    bow = shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])
    diagram = Voronoi([(0, 1), (2, 1)], clip=bow, fix=True)
    assert diagram.cell_areas.tolist() == pytest.approx([1.0, 1.0])


def test_outlines_come_as_tables_and_mappings_too() -> None:
    geopandas = pytest.importorskip("geopandas")
    left, right = shapely.box(0, 0, 1, 1), shapely.box(1, 0, 2, 1)
    feature = {"type": "Feature", "properties": {}, "geometry": left.__geo_interface__}
    other = feature | {"geometry": right.__geo_interface__}
    collection = {"type": "FeatureCollection", "features": [feature, other]}
    table = geopandas.GeoDataFrame(geometry=[left, None, right])
    for clip, size in (
        (table, 2.0),
        (table.geometry, 2.0),
        (table.iloc[:1], 1.0),
        (feature, 1.0),
        (collection, 2.0),
        (left.__geo_interface__, 1.0),
    ):
        diagram = Voronoi([(0.5, 0.5), (1.5, 0.5)], clip=clip)
        assert diagram.cell_areas.sum() == pytest.approx(size)
    with pytest.raises(InputError, match="contain only polygons"):
        Voronoi([(0, 0)], clip=geopandas.GeoSeries([left, shapely.Point(0, 0)]))
    with pytest.raises(InputError, match="not a geometry"):
        Voronoi([(0, 0)], clip={"type": "Polygone"})


def test_a_table_carries_the_columns_of_the_sites() -> None:
    geopandas = pytest.importorskip("geopandas")
    points = uniform(10, seed=7)
    data = geopandas.GeoDataFrame(
        {"name": list("abcdefghij")},
        geometry=geopandas.points_from_xy(*points.T),
        crs="EPSG:4326",
        index=range(100, 110),
    )
    table = Voronoi(points, clip="box").to_geopandas(data)
    assert table.columns.tolist() == ["name", "geometry"]
    assert table.crs == data.crs and table.index.equals(data.index)
    assert table.geometry.covers(data.geometry).all()
    assert len(data.columns) == 2
    assert Voronoi(points, clip="box").to_geopandas(crs="EPSG:28992").crs.to_epsg() == 28992
    with pytest.raises(InputError, match="9 rows for 10 points"):
        Voronoi(points).to_geopandas(data.iloc[:9])


def test_a_diagram_can_be_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    points = uniform(30, seed=8)
    ax = Voronoi(points, clip=OUTLINES["comb"]).plot()
    assert len(ax.collections[0].get_paths()) == 30
    ax = Voronoi(points).plot(values=np.arange(30), points=False)
    assert len(ax.lines) == 0
    assert ax.collections[0].get_array().tolist() == list(range(30))
    with pytest.raises(InputError, match=r"values must have shape \(30,\)"):
        Voronoi(points).plot(values=[1, 2])
    Voronoi([(0, 0)]).plot()
