"""Overlaps of polygons in the plane: areas against rational numbers, ties, what is refused."""

from __future__ import annotations

import pickle
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from delone import AreaWeights, Delaunay, Overlaps, Voronoi
from plane_overlaps import area, shared_area
from tiers import seeds

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


def boxes(xs: Floats, ys: Floats) -> list[Floats]:
    """The cells of a grid of edges, row by row."""
    return [
        np.array([(a, c), (b, c), (b, d), (a, d)]) for c, d in pairwise(ys) for a, b in pairwise(xs)
    ]


def star(rng: np.random.Generator, kind: int) -> Floats:
    """A ring around a place: on a lattice, near it by roundings, or anywhere."""
    count = int(rng.integers(3, 9))
    angles = np.sort(rng.uniform(0, 2 * np.pi, count))
    radii = rng.uniform(0.3, 2, count)
    ring = np.column_stack((np.cos(angles), np.sin(angles))) * radii[:, None]
    center = rng.integers(-2, 3, 2)
    if kind == 0:
        return ring + center + rng.uniform(-1, 1, 2)
    lattice = np.rint(ring * 2) / 2 + center
    if kind == 2:
        lattice += rng.choice([0, 2**-52, -(2**-52)], lattice.shape)
    return lattice


def simple(ring: Floats) -> bool:
    """Whether a ring can be a cell."""
    try:
        return len(Overlaps([ring], [ring]).report.source_empty) == 0
    except delone.InputError:
        return False


@pytest.mark.parametrize("seed", seeds(12, deep=200))
def test_areas_are_those_of_rational_numbers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rings = [star(rng, int(rng.integers(3))) for _ in range(24)]
    rings = [ring for ring in rings if simple(ring)]
    half = len(rings) // 2
    first, second = rings[:half], rings[half:]
    found = Overlaps(first, second).matrix.toarray()
    for j, q in enumerate(second):
        for i, p in enumerate(first):
            exact = float(shared_area([p], [q]))
            least = float(min(area([p]), area([q])))
            assert abs(found[j, i] - exact) <= 4e-16 * least + 1e-23, (p.tolist(), q.tolist())


@pytest.mark.parametrize("seed", seeds(6, deep=60))
def test_how_rings_are_written_changes_no_bit(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rings = [star(rng, int(rng.integers(3))) for _ in range(30)]
    rings = [ring for ring in rings if simple(ring)]
    half = len(rings) // 2
    first, second = rings[:half], rings[half:]
    known = Overlaps(first, second)
    turned = [np.roll(ring[::-1], int(rng.integers(9)), axis=0) for ring in first]
    repeated = [np.repeat(ring, rng.integers(1, 3, len(ring)), axis=0) for ring in second]
    again = Overlaps(turned, repeated)
    assert again.areas.tobytes() == known.areas.tobytes()
    # A power of two, other threads, other rows.
    scaled = Overlaps([8 * ring for ring in first], [8 * ring for ring in second], workers=3)
    assert (scaled.areas / 64).tobytes() == known.areas.tobytes()
    order = rng.permutation(half)
    mixed = Overlaps([first[k] for k in order], second)
    assert np.array_equal(mixed.matrix.toarray(), known.matrix.toarray()[:, order])


def test_tilings_cover_each_other() -> None:
    for offset in (0.0, 4e6):
        edges = np.arange(31) + offset
        other = np.linspace(edges[0], edges[-1], 18)
        overlaps = Overlaps(boxes(edges, edges), boxes(other, other))
        assert np.abs(overlaps.covered_source - 1).max() < 1e-15
        assert np.abs(overlaps.covered_target - 1).max() < 1e-15
        assert not len(overlaps.report.source_partly)


def test_nested_cells_have_the_pairs_of_theory() -> None:
    coarse = boxes(np.arange(0.0, 9, 2), np.arange(0.0, 9, 2))
    fine = boxes(np.arange(0.0, 9), np.arange(0.0, 9))
    assert len(Overlaps(coarse, fine).areas) == len(fine)
    same = Overlaps(fine, fine)
    assert np.array_equal(same.indices, np.arange(64))
    assert (same.areas == 1).all()


def test_triangulations_and_diagrams() -> None:
    rng = np.random.default_rng(7)
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=float)
    mesh = Delaunay(np.vstack((rng.random((300, 2)), corners)))
    overlaps = Overlaps(mesh, Delaunay(corners))
    assert np.abs(overlaps.covered_source - 1).max() < 1e-12
    assert np.abs(overlaps.covered_target - 1).max() < 1e-15
    pytest.importorskip("shapely")
    diagram = Voronoi(rng.random((50, 2)), clip=(0, 0, 1, 1))
    cells = Overlaps(diagram, mesh)
    assert np.abs(cells.covered_target - 1).max() < 1e-9
    with pytest.raises(delone.InputError, match=r"unbounded, first cell 0: .* clip="):
        Overlaps(Voronoi(corners), mesh)


def test_a_sliver_beside_a_continent() -> None:
    """A long side counts as well as a short one: 1e9 m across, beside a square of a millimeter."""
    wide = np.array([(-5e8, -5e8), (5e8, 4.99e8), (-5e8, 5e8)])
    square = np.array([(0, 0), (1e-3, 0), (1e-3, 1e-3), (0, 1e-3)]) - 3e-4
    exact = float(shared_area([wide], [square]))
    for pair in ((wide, square), (square, wide)):
        assert Overlaps([pair[0]], [pair[1]]).areas[0] == pytest.approx(exact, rel=1e-15, abs=0)


def test_columns_of_a_table() -> None:
    pandas = pytest.importorskip("pandas")
    source = boxes(np.arange(0.0, 5), np.array([0.0, 1.0]))
    target = boxes(np.array([0.0, 2.0, 4.0, 6.0]), np.array([0.0, 1.0]))
    table = pandas.DataFrame(
        {
            "people": [1, 2, 3, 4],
            "known": pandas.array([1, None, 3, 5], dtype="Int64"),
            "use": ["b", "a", None, "c"],
        }
    )
    methods = {"people": "sum", "known": "normalized", "use": "majority"}
    found = Overlaps(source, target).transfer(table, methods, skipna=True)
    assert found["people"].tolist()[:2] == [3.0, 7.0]
    assert found["known"].tolist()[:2] == [1.0, 4.0]
    assert found["use"].tolist() == ["a", "c", None]
    assert np.isnan(found["people"][2])
    kept = Overlaps(source, target).transfer(table, methods)
    assert np.isnan(kept["known"][0])
    with pytest.raises(delone.InputError, match="must be 'majority', got 'sum'"):
        Overlaps(source, target).transfer(table, {"use": "sum"})
    with pytest.raises(delone.InputError, match="no column 'age'"):
        Overlaps(source, target).transfer(table, {"age": "sum"})
    with pytest.raises(delone.ShapeError, match="one value for each of 4 source cells"):
        Overlaps(source, target).transfer({"people": [1, 2]}, {"people": "sum"})


def test_missing_numbers_are_one_category() -> None:
    source = boxes(np.array([0.0, 3, 6, 10]), np.array([0.0, 1.0]))
    weights = Overlaps(source, boxes(np.array([0.0, 10]), np.array([0.0, 1.0]))).to_weights(
        "majority"
    )
    assert np.isnan(weights.apply([np.nan, np.nan, 7.0])[0])
    assert weights.apply([np.nan, np.nan, 7.0], skipna=True)[0] == 7


def test_tables_and_their_reference_systems() -> None:
    geopandas = pytest.importorskip("geopandas")
    shapely = pytest.importorskip("shapely")
    pytest.importorskip("pyproj")
    hole = shapely.Polygon([(0, 0), (9, 0), (9, 9), (0, 9)], [[(3, 3), (6, 3), (6, 6), (3, 6)]])
    parts = shapely.MultiPolygon([shapely.box(20, 0, 21, 1), shapely.box(30, 0, 32, 1)])
    shapes = geopandas.GeoSeries([hole, parts, None, shapely.Polygon()], crs=28992)
    overlaps = Overlaps(shapes, geopandas.GeoSeries([shapely.box(2, 2, 25, 7)], crs=28992))
    assert overlaps.crs == "EPSG:28992"
    assert overlaps.source_areas.tolist() == [72, 3, 0, 0]
    assert overlaps.matrix.toarray().tolist() == [[26, 0, 0, 0]]
    assert overlaps.report.source_empty.tolist() == [2, 3]
    assert overlaps.report.source_outside.tolist() == [1]
    degrees = shapes.to_crs(4326)
    with pytest.raises(delone.InputError, match=r"longitudes and latitudes.*sphere.Overlaps"):
        Overlaps(degrees, shapes)
    with pytest.raises(delone.InputError, match=r"longitudes and latitudes.*sphere.Overlaps"):
        Overlaps(shapes, degrees)
    utm = Overlaps(shapes.translate(1e5, 4.5e5), shapes.translate(1e5, 4.5e5).to_crs(32631))
    assert np.diag(utm.matrix.toarray()[:2, :2]) == pytest.approx([72, 3], rel=1e-3)
    with pytest.warns(delone.CRSWarning, match="assumed to be the same"):
        Overlaps(shapes, geopandas.GeoSeries([hole]))


def test_ways_to_write_layers() -> None:
    ring = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]
    square = {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}
    empty = {"type": "Polygon", "coordinates": []}
    features = [{"type": "Feature", "properties": {}, "geometry": g} for g in (square, empty)]
    collection = {"type": "FeatureCollection", "features": features}
    for layer in (ring, [ring], np.array(ring), np.array([ring]), square, [square], collection):
        overlaps = Overlaps(layer, [np.array(ring) + 1])
        assert overlaps.areas.tolist() == [1]
        assert len(overlaps.source_areas) == (2 if layer is collection else 1)
    for nothing in ([], np.zeros((0, 4, 2))):
        assert Overlaps(nothing, [ring]).covered_target.tolist() == [0]


def test_what_is_refused() -> None:
    square = [[(0, 0), (1, 0), (1, 1), (0, 1)]]
    bow = [[(0, 0), (1, 1), (1, 0), (0, 1)]]
    twice = [[(0, 0), (1, 0), (0, 1), (0, 0), (1, 0), (0, 1)]]
    for wrong in (bow, twice):
        with pytest.raises(delone.CrossingSegmentsError, match="1 polygon has sides that cross"):
            Overlaps(square, wrong)
    with pytest.raises(delone.DtypeError, match="source must be polygons"):
        Overlaps("square", square)
    with pytest.raises(delone.NonFiniteError):
        Overlaps(square, [[(0, 0), (np.nan, 0), (1, 1)]])
    with pytest.raises(delone.InputError, match="beyond the range of doubles"):
        Overlaps(square, np.array([[(0, 0), (1e200, 0), (1e200, 1e200)]]))
    with pytest.raises(delone.InputError, match=r"sphere\.Overlaps"):
        Overlaps(delone.sphere.Delaunay(lonlat=[(0, 0), (90, 0), (0, 90), (180, -40)]), square)
    with pytest.raises(delone.InputError, match="3-D"):
        Overlaps(Delaunay(np.random.default_rng(0).random((9, 3))), square)
    with pytest.raises(delone.InputError, match="create AreaWeights with"):
        AreaWeights()


def test_files_and_pickles(tmp_path: Path) -> None:
    clockwise = [np.array([(0, 0), (0, 2), (2, 2), (2, 0)])]
    overlaps = Overlaps(clockwise, boxes(np.arange(0.0, 4), np.arange(0.0, 4)))
    assert overlaps.source_reversed.tolist() == [0]
    overlaps.save(tmp_path / "shared.npz")
    for again in (Overlaps.load(tmp_path / "shared.npz"), pickle.loads(pickle.dumps(overlaps))):
        assert repr(again) == repr(overlaps)
        for name in ("indptr", "indices", "areas", "source_reversed", "covered_target"):
            assert getattr(again, name).tobytes() == getattr(overlaps, name).tobytes()
    weights: Any = pickle.loads(pickle.dumps(overlaps.to_weights("sum")))
    assert np.nansum(weights.apply([9.0])) == pytest.approx(9.0)
    with pytest.raises(delone.FileFormatError):
        delone.sphere.Overlaps.load(tmp_path / "shared.npz")


@pytest.mark.parametrize("methods", [None, [], 3, "sum"])
def test_methods_that_are_not_a_mapping(methods: Any) -> None:
    square = [[(0, 0), (1, 0), (1, 1), (0, 1)]]
    with pytest.raises(delone.DtypeError, match="methods must map columns to methods"):
        Overlaps(square, square).transfer({"a": [1]}, methods)


def test_a_closed_line_is_not_a_polygon() -> None:
    shapely = pytest.importorskip("shapely")
    ring = shapely.LinearRing([(0, 0), (1, 0), (1, 1)])
    with pytest.raises(delone.InputError, match=r"^source: geometry 1 is not a polygon"):
        Overlaps([shapely.box(0, 0, 1, 1), ring], [shapely.box(0, 0, 1, 1)])


@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize("axis", [0, 1])
def test_large_coordinates_of_any_sign_and_axis_are_refused(sign: int, axis: int) -> None:
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], dtype=np.float64)
    square[2, axis] = sign * 2.0**501
    with pytest.raises(delone.InputError, match="beyond the range of doubles"):
        Overlaps([square], [square])


def test_a_layer_may_be_flat() -> None:
    flat = np.array([(0, 0), (1, 0), (1, 2.0**-510), (0, 2.0**-510)])
    for layer in (flat, flat[:, ::-1]):
        assert Overlaps([layer], [layer]).report.source_empty.tolist() == [0]


def test_a_small_cell_at_a_concave_one_that_is_much_larger() -> None:
    """Terms are measured from near the small cell, not from the far ends of long sides."""
    s, far, x, y = 5.826450433232822e-13, 34908416.0, 34903040.0, 69816832.0
    small = [(-9.813414948212085e-6, s), (s, s), (s, -1.4210854715202004e-14)]
    # What is between two lines from the origin, and a spike.
    large = [(far, far), (far, 1e-26), (far, far), (x, y), (0, 0)]
    expected = s * s * (1 - x / y) / 2
    for found in (delone.Overlaps([small], [large]), delone.Overlaps([large], [small])):
        assert found.areas.tolist() == pytest.approx([expected], rel=1e-13)


@pytest.mark.parametrize("power", [0, 9, 10, 11, 20, 50, 100, 230])
@pytest.mark.parametrize("at", ["corner", "lattice", "side"])
def test_cells_of_very_different_size(at: str, power: int) -> None:
    """Errors do not grow with the length of sides, wherever those start."""
    rng = np.random.default_rng(power)
    for _ in range(12):
        small, large = _around(rng), _around(rng)
        place = (large[0] + large[1]) / 2 if at == "side" else large[1]
        large = (large - place) * 2.0**power + rng.uniform(-0.5, 0.5, 2)
        if at == "lattice":
            small, large[1] = np.rint(small * 2) / 2, np.rint(large[1] * 2) / 2
        if not (simple(small) and simple(large)):
            continue
        exact = float(shared_area([small], [large]))
        for found in (Overlaps([small], [large]), Overlaps([large], [small])):
            assert abs(found.areas.sum() - exact) <= 4e-16 * exact + 1e-23


def _around(rng: np.random.Generator) -> Floats:
    """A concave ring of extent 1 around the origin."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 8))))
    radii = rng.uniform(0.2, 2, len(angles))
    return np.column_stack((np.cos(angles), np.sin(angles))) * radii[:, None]


def test_a_corner_of_a_large_cell_in_a_small_one() -> None:
    """A long side that starts in the small cell counts from its start."""
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    for far in (1e3, 1e6, 1e9):
        large = np.array([(0.6, 0.7), (-far, -0.8 * far), (-0.2 * far, -0.2 * far), (far, -far)])
        exact = float(shared_area([large], [square]))
        for found in (Overlaps([large], [square]), Overlaps([square], [large])):
            assert found.areas.tolist() == pytest.approx([exact], rel=1e-15)
