"""What cannot be triangulated is refused by name; what can be handled is reported, not raised."""

from __future__ import annotations

import pickle
from collections import UserDict
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

import delone
import delone.areal
from delone import ConstrainedDelaunay, errors

SQUARE = [(0, 0), (6, 0), (6, 6), (0, 6)]


class TestSegments:
    @pytest.mark.parametrize("empty", [[], (), np.empty((0, 2)), np.empty((0, 2), dtype=np.int64)])
    def test_none_are_fine(self, empty: Any) -> None:
        mesh = ConstrainedDelaunay(SQUARE, empty)
        assert mesh.nsimplex == 2
        assert mesh.report

    def test_rows_out_of_range_are_named(self) -> None:
        with pytest.raises(
            errors.InputError, match=r"3 of 4 rows.*outside 0 to 3.*first: rows 0, 2, 3"
        ):
            ConstrainedDelaunay(SQUARE, [(0, 4), (0, 1), (-1, 2), (2**40, 0)])

    def test_only_ten_rows_are_named(self) -> None:
        with pytest.raises(errors.InputError, match=r"30 of 30 rows.*8, 9$"):
            ConstrainedDelaunay(SQUARE, [(9, 9)] * 30)

    @pytest.mark.parametrize("dtype", [float, bool, complex, str, object, np.float32])
    def test_what_does_not_hold_integers_is_refused(self, dtype: Any) -> None:
        with pytest.raises(errors.DtypeError, match="integers"):
            ConstrainedDelaunay(SQUARE, np.array([(0, 1)], dtype=int).astype(dtype))

    def test_masked_rows_are_refused(self) -> None:
        with pytest.raises(errors.DtypeError, match="masked"):
            ConstrainedDelaunay(SQUARE, np.ma.masked_array([(0, 1)], mask=[(True, False)]))

    @pytest.mark.parametrize("shape", [(2,), (3, 3), (1, 2, 2), (2, 1), (0, 3), ()])
    def test_other_shapes_are_refused(self, shape: Any) -> None:
        with pytest.raises(errors.ShapeError, match=r"\(s, 2\)"):
            ConstrainedDelaunay(SQUARE, np.zeros(shape, dtype=np.int32))

    def test_rows_of_unequal_length_are_refused(self) -> None:
        with pytest.raises(errors.ShapeError, match=r"length: row 0 has 2, row 1 has 1$"):
            ConstrainedDelaunay(SQUARE, [(0, 1), (1,)])

    @pytest.mark.parametrize("dtype", [np.int8, np.uint64, ">i8", np.int32])
    @pytest.mark.parametrize("order", ["C", "F"])
    def test_all_integers_in_all_layouts_are_welcome(self, dtype: Any, order: Any) -> None:
        mesh = ConstrainedDelaunay(SQUARE, np.array([(1, 3), (0, 1)], dtype=dtype, order=order))
        assert mesh.input_segments.tolist() == [[1, 3], [0, 1]]


class TestCrossings:
    STAR = ([(0, 3), (2, -3), (-3, 1), (3, 1), (-2, -3)], [(i, (i + 1) % 5) for i in range(5)])

    def test_all_pairs_are_named_with_their_places(self) -> None:
        with pytest.raises(errors.CrossingSegmentsError) as caught:
            ConstrainedDelaunay(*self.STAR)
        error = caught.value
        pairs = {frozenset(pair) for pair in error.pairs.tolist()}
        assert pairs == {frozenset(((i) % 5, (i + 2) % 5)) for i in range(5)}
        assert error.points.shape == (5, 2)
        by_pair = dict(zip(map(frozenset, error.pairs.tolist()), error.points, strict=True))
        assert by_pair[frozenset((2, 0))].tolist() == pytest.approx([2 / 3, 1])
        again = pickle.loads(pickle.dumps(error))
        assert again.pairs.tolist() == error.pairs.tolist()

    def test_a_point_at_the_crossing_makes_it_none(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (3, 3)], [(0, 2), (1, 3)])
        assert mesh.nadded == 0
        assert len(mesh.segments) == 4

    @pytest.mark.parametrize("most", [0, 4])
    def test_the_budget_is_kept(self, most: int) -> None:
        with pytest.raises(errors.BudgetExceededError) as caught:
            ConstrainedDelaunay(*self.STAR, crossing="split", max_points=most)
        assert caught.value.limit == most
        assert caught.value.found > most

    def test_the_budget_may_be_used_up(self) -> None:
        mesh = ConstrainedDelaunay(*self.STAR, crossing="split", max_points=5)
        assert mesh.nadded == 5
        assert mesh.validate()


class TestPoints:
    def test_nan_is_named_as_ever(self) -> None:
        with pytest.raises(errors.NonFiniteError) as caught:
            ConstrainedDelaunay([*SQUARE, (np.nan, 0)], [(0, 2)])
        assert caught.value.rows.tolist() == [4]

    def test_a_line_has_no_triangles(self) -> None:
        with pytest.raises(errors.DegenerateInputError) as caught:
            ConstrainedDelaunay([(0, 0), (2, 2), (1, 1)], [(0, 1)])
        assert caught.value.chain.tolist() == [0, 2, 1]

    def test_nothing_has_no_triangles(self) -> None:
        with pytest.raises(errors.DegenerateInputError):
            ConstrainedDelaunay(np.empty((0, 2)), [])

    def test_segments_without_points_are_out_of_range(self) -> None:
        with pytest.raises(errors.InputError, match="0 to -1"):
            ConstrainedDelaunay(np.empty((0, 2)), [(0, 0)])


class TestSeeds:
    @pytest.mark.parametrize("name", ["holes", "regions"])
    def test_nan_is_refused(self, name: str) -> None:
        with pytest.raises(errors.NonFiniteError, match=name) as caught:
            ConstrainedDelaunay(SQUARE, [], **{name: [(1, 1), (np.nan, 2), (np.inf, 0)]})
        assert caught.value.rows.tolist() == [1, 2]

    @pytest.mark.parametrize("name", ["holes", "regions"])
    def test_other_shapes_are_refused(self, name: str) -> None:
        for seeds in ((1, 1), [(1, 1, 1, 1)], [[(1, 1)]]):
            with pytest.raises(errors.ShapeError, match=name):
                ConstrainedDelaunay(SQUARE, [], **{name: seeds})

    def test_holes_have_no_labels(self) -> None:
        with pytest.raises(errors.ShapeError, match="holes"):
            ConstrainedDelaunay(SQUARE, [], holes=[(1, 1, 1)])

    @pytest.mark.parametrize("label", [-1, 0.5, 2**31])
    def test_labels_are_integers_of_at_least_0(self, label: float) -> None:
        with pytest.raises(errors.InputError, match=r"1 of 2 labels.*row 1$"):
            ConstrainedDelaunay(SQUARE, [], regions=[(1, 1, 2), (2, 1, label)])

    def test_outside_or_on_a_segment_is_reported(self) -> None:
        mesh = ConstrainedDelaunay(SQUARE, [(0, 2)], holes=[(9, 9), (1, 1), (0, 0)])
        assert mesh.nsimplex == 2
        assert mesh.report.holes_outside.tolist() == [0]
        assert mesh.report.holes_on_segment.tolist() == [1, 2]

    def test_a_seed_at_a_point_without_segment_counts(self) -> None:
        mesh = ConstrainedDelaunay([*SQUARE, (4, 2)], [(0, 2)], holes=[(4, 2)])
        assert mesh.areas.sum() == 18
        assert mesh.report


class TestOptions:
    @pytest.mark.parametrize("name", ["boundary", "crossing", "method"])
    def test_unknown_words_are_refused_with_the_known_ones(self, name: str) -> None:
        for word in ("no such", None, 3):
            with pytest.raises(errors.InputError, match=f"{name} must be one of '.*got"):
                ConstrainedDelaunay(SQUARE, [], **{name: word})

    @pytest.mark.parametrize("most", [-1, 1.5, "3", True])
    def test_max_vertices_is_a_count(self, most: Any) -> None:
        with pytest.raises(errors.InputError, match="max_points"):
            ConstrainedDelaunay(SQUARE, [], max_points=most)

    def test_workers_are_checked(self) -> None:
        with pytest.raises(errors.InputError, match="workers"):
            ConstrainedDelaunay(SQUARE, [], workers=0)


class TestQueries:
    @pytest.mark.parametrize("way", ["triangles_along", "segments_crossing"])
    def test_ends_are_finite_points(self, way: str) -> None:
        walk = getattr(delone.ConstrainedDelaunay(SQUARE, [(0, 2)]), way)
        with pytest.raises(errors.NonFiniteError, match="b"):
            walk((0, 0), (np.nan, 1))
        with pytest.raises(errors.ShapeError, match="a"):
            walk([(0, 0)], (1, 1))
        with pytest.raises(errors.ShapeError, match="a"):
            walk((0, 0, 0), (1, 1))

    def test_queries_are_points(self) -> None:
        with pytest.raises(errors.ShapeError, match="xi"):
            ConstrainedDelaunay(SQUARE, []).find_simplex((1, 2, 3))


@pytest.mark.parametrize("given", ["coast.geojson", Path("coast.geojson"), b"coast.geojson"])
def test_names_of_files_are_no_geometries(given: Any) -> None:
    for make in (delone.from_geometry, delone.mesh):
        with pytest.raises(
            errors.InputError, match=r"name of a file.*read_geometries\('coast.geojson'\)"
        ):
            make(given)
    with pytest.raises(errors.InputError, match=r"shapely\.from_wkt"):
        delone.from_geometry("POINT (0 0)")


class TestMasks:
    """A mask says that numbers do not count: geometry made of them would be wrong in silence."""

    RING = np.ma.masked_array(
        [(0.0, 0), (4, 0), (4, 4), (0, 4)], mask=[(False, False)] * 3 + [(True, True)]
    )
    PLAIN: Any = RING.data.tolist()
    SQUARES = (
        RING,
        [RING],
        {"type": "Polygon", "coordinates": [RING]},
        [{"type": "Polygon", "coordinates": [RING]}],
        {"type": "Polygon", "coordinates": RING[None]},
        {"type": "MultiPolygon", "coordinates": [[RING]]},
        {"type": "Polygon", "coordinates": [list(RING)]},
        {"type": "Polygon", "coordinates": [[*PLAIN[:3], (0.0, np.ma.masked)]]},
        {"type": "Feature", "geometry": {"type": "Polygon", "coordinates": [RING]}},
        {
            "type": "GeometryCollection",
            "geometries": [{"type": "Point", "coordinates": RING[3]}],
        },
    )

    @pytest.mark.parametrize("given", SQUARES, ids=range(len(SQUARES)))
    @pytest.mark.parametrize("take", [delone.from_geometry, delone.mesh])
    def test_in_geometries(self, given: Any, take: Any) -> None:
        with pytest.raises(errors.DtypeError, match="masked array"):
            take(given)

    def test_of_geometries(self) -> None:
        shapely = pytest.importorskip("shapely")
        boxes = np.ma.masked_array([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)], mask=[0, 1])
        for take in (delone.from_geometry, delone.mesh):
            with pytest.raises(errors.DtypeError, match="masked array"):
                take(boxes)

    @pytest.mark.parametrize("name", ["max_area", "min_angle", "max_points", "smooth"])
    def test_in_numbers(self, name: str) -> None:
        square = {"type": "Polygon", "coordinates": [self.PLAIN]}
        for value in (np.ma.masked, np.ma.masked_array(30, mask=True)):
            with pytest.raises(errors.DtypeError, match=name):
                delone.mesh(square, **{name: value})


RING = [[0, 0], [6, 0], [6, 6], [0]]


@pytest.mark.parametrize(
    ("kind", "coordinates", "row"),
    [
        ("Polygon", [RING], "row 3 is [0]"),
        ("MultiPolygon", [[RING]], "row 3 is [0]"),
        ("LineString", RING, "row 3 is [0]"),
        ("LineString", [[0, 0], [1, "a"]], "row 1 is [1, 'a']"),
        ("MultiLineString", [RING[::-1]], "row 0 is [0]"),
        ("Point", [0, [1]], "row 0 is [0, [1]]"),
    ],
)
def test_the_row_of_coordinates_that_are_no_pair_is_named(
    kind: str, coordinates: Any, row: str
) -> None:
    given = {"type": kind, "coordinates": coordinates}
    tin = [(0, 0, 0), (6, 0, 1), (6, 6, 2)]
    for call in (
        lambda: delone.from_geometry(given),
        lambda: delone.mesh(given),
        lambda: delone.Voronoi(SQUARE, clip=given),
        lambda: delone.terrain.TIN.from_points(tin, breaklines=given),
    ):
        with pytest.raises(errors.InputError) as caught:
            call()
        message = str(caught.value)
        assert message.removeprefix(f"breaklines: {given!r:.80} is not a geometry: ") == (
            f"the coordinates of a {kind} are not pairs of numbers: {row}"
        )


@pytest.mark.parametrize("wrap", [dict, MappingProxyType, UserDict])
def test_every_mapping_is_welcome_everywhere(wrap: Any) -> None:
    square = wrap({"type": "Polygon", "coordinates": [[*SQUARE, SQUARE[0]]]})
    line = wrap({"type": "LineString", "coordinates": [(1, 1), (3, 2)]})
    feature = wrap({"type": "Feature", "properties": {}, "geometry": square})
    layer = wrap({"type": "FeatureCollection", "features": [feature]})
    table = [(x, y, x) for x, y in SQUARE]
    for one in (square, feature, layer, [square], [feature]):
        assert delone.mesh(one).npoints == 4
        assert delone.from_geometry(one).npoints == 4
        assert delone.terrain.TIN.from_points(table, boundary=one).nsimplex == 2
    for one in (square, feature, layer, [square]):
        assert len(delone.Voronoi(SQUARE, clip=one).points) == 4
    cells = delone.areal.Overlaps(layer, [square])
    assert cells.areas.tolist() == [36]
    tin = delone.terrain.TIN.from_points(table, breaklines=line)
    assert tin.npoints == 6
    assert tin.profile(line).z.tolist() == pytest.approx([1, 3])
    assert tin.volume_to(0, region=square).area == 36
