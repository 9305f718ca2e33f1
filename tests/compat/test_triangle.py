"""What the drop-in for the package ``triangle`` refuses, and how."""

from __future__ import annotations

import warnings
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np
import pytest

from delone import datasets, mesh
from delone.compat.triangle import convex_hull, delaunay, triangulate, voronoi
from delone.errors import (
    CrossingSegmentsError,
    DtypeError,
    InputError,
    NonFiniteError,
    ShapeError,
)
from tiers import seeds

SQUARE: dict[str, Any] = {"vertices": [(0, 0), (1, 0), (1, 1), (0, 1)]}


@pytest.mark.parametrize("tri", [None, 5, [(0, 0), (1, 0), (0, 1)]])
def test_what_is_no_mapping(tri: Any) -> None:
    with pytest.raises(DtypeError, match="tri must be a mapping"):
        triangulate(tri)


@pytest.mark.parametrize("opts", [None, 5, b"q"])
def test_switches_that_are_no_string(opts: Any) -> None:
    with pytest.raises(DtypeError, match="opts must be a string"):
        triangulate(SQUARE, opts)


def test_without_segments_nothing_is_enclosed() -> None:
    with pytest.raises(InputError, match="the segments form no closed ring"):
        triangulate(SQUARE, "p")
    assert len(triangulate(SQUARE, "pc")["triangles"]) == 2


@pytest.mark.parametrize("call", [delaunay, convex_hull, voronoi])
def test_points_are_of_the_plane(call: Any) -> None:
    with pytest.raises(ShapeError, match=r"pts must have shape \(n, 2\), got \(5, 3\)"):
        call(np.eye(5, 3))


# A hull with points so close to its sides that rounding takes them for points on these.
SHALLOW = [(0, 0), (1, -1e-9), (2, 0)]


@pytest.mark.parametrize("points", [SHALLOW, datasets.tilted_grid(900)])
def test_without_angles_and_areas_no_vertex_is_added(points: Any) -> None:
    assert len(triangulate({"vertices": points}, "")["vertices"]) == len(points)
    ring = np.column_stack((np.arange(3), (np.arange(3) + 1) % 3))
    out = triangulate({"vertices": SHALLOW, "segments": ring}, "p")
    assert len(out["vertices"]) == 3
    assert mesh((SHALLOW, ring), min_angle=0).nadded == 0


def test_an_area_alone_and_circles_still_add_vertices() -> None:
    assert len(triangulate({"vertices": SHALLOW}, "D")["vertices"]) > 3
    out = triangulate(SQUARE, "a0.01")
    assert len(out["vertices"]) > 40


def test_crossings_become_vertices() -> None:
    cross = SQUARE | {"segments": [(0, 2), (1, 3)]}
    assert triangulate(cross, "pc")["vertices"][4:].tolist() == [[0.5, 0.5]]


@pytest.mark.parametrize("areas", [[], [0.1], [0.1, 0.1, 0.1]])
def test_each_triangle_has_its_area(areas: list[float]) -> None:
    again = SQUARE | {"triangles": [(0, 1, 2), (0, 2, 3)], "triangle_max_area": areas}
    with pytest.raises(ShapeError, match="triangle_max_area must have 2 rows"):
        triangulate(again, "ra")


class TestWholeSegments:
    """Y: a triangle that only a vertex beside a segment would make smaller stays as it is."""

    # A strip that is far longer than wide: every vertex inside is close to both of its sides.
    STRIP: ClassVar[dict[str, Any]] = {"vertices": [(0, 0), (100, 0), (100, 1), (0, 1)],
             "segments": [(0, 1), (1, 2), (2, 3), (3, 0)]}  # fmt: skip

    @pytest.mark.parametrize("switch", ["Y", "YY"])
    def test_areas_yield_and_a_warning_counts_them(self, switch: str) -> None:
        with pytest.warns(UserWarning, match="switch Y forbids splitting segments") as caught:
            out = triangulate(self.STRIP, f"pq{switch}a0.5")
        a, b, c = out["vertices"][out["triangles"]].transpose(1, 0, 2)
        u, v = b - a, c - a
        areas = (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2
        large = int((areas > 0.5).sum())
        assert large > 0
        assert f"leaves {large} triangles larger than requested" in str(caught[0].message)
        assert len(out["segments"]) == 4
        assert len(out["triangles"]) < 20

    def test_areas_of_regions_and_of_triangles(self) -> None:
        regions = self.STRIP | {"regions": [(50, 0.5, 7, 0.5)]}
        with pytest.warns(UserWarning, match="larger than requested"):
            triangulate(regions, "pqYYa")
        halves = [(0, 1, 2), (0, 2, 3)]
        given = self.STRIP | {"triangles": halves, "triangle_max_area": [0.5, -1.0]}
        with pytest.warns(UserWarning, match="1 triangle larger than requested"):
            triangulate(given, "rYYa")

    def test_nothing_is_said_where_nothing_is_missed(self) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            triangulate(SQUARE, "Y")
            triangulate(SQUARE, "qYa2")
            triangulate(self.STRIP, "pqa0.5")
            triangulate(self.STRIP, "pYYa")


class TestRefinedAgain:
    """Switch r: triangles stay in the region between segments that they are in."""

    # A square around another one, whose ring no edge connects to the boundary.
    NESTED: ClassVar[dict[str, Any]] = {
        "vertices": [(0, 0), (9, 0), (9, 9), (0, 9), (3, 3), (6, 3), (6, 6), (3, 6)],
        "segments": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)],
        "regions": [(1, 1, 1, 0), (4, 4, 2, 0)],
    }

    @staticmethod
    def areas(out: dict[str, Any]) -> dict[float, Fraction]:
        """The exact area of the triangles of each attribute."""
        found: dict[float, Fraction] = {}
        corners = out["vertices"][out["triangles"]].tolist()
        for triangle, mark in zip(corners, out["triangle_attributes"].ravel(), strict=True):
            (ax, ay), (bx, by), (cx, cy) = [map(Fraction, each) for each in triangle]
            area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            assert area > 0
            found[float(mark)] = found.get(float(mark), Fraction(0)) + area / 2
        return found

    @pytest.mark.parametrize("opts", ["r", "rq", "rqa1", "ra0.5"])
    def test_a_ring_that_nothing_connects_to_the_boundary_stays(self, opts: str) -> None:
        given = triangulate(self.NESTED, "pA")
        out = triangulate(given, opts)
        assert {k: float(a) for k, a in self.areas(out).items()} == pytest.approx({1: 72, 2: 9})

    @pytest.mark.parametrize("shift", [0.0, 2.0**30])
    def test_regions_as_narrow_as_a_rounding_keep_their_attribute(self, shift: float) -> None:
        middle = (1 + shift, np.nextafter(1 / 3 + shift, np.inf))
        outer = [(0, 0), (3, 1), (3, -3), (-3, 3), (3, 3)]
        points = [(x + shift, y + shift) for x, y in outer] + [middle]
        lines = [(0, 1), (1, 5), (5, 0), (0, 2), (2, 1), (1, 4), (4, 3), (3, 0)]
        seeds = [(2 + shift, shift, 1, 0), (1 + shift, 2 + shift, 2, 0)]
        given = triangulate({"vertices": points, "segments": lines, "regions": seeds}, "pA")
        before = self.areas(given)
        assert sorted(before) == [0, 1, 2]
        assert 0 < before[0] < 1e-6
        assert self.areas(triangulate(given, "r")) == before

    @pytest.mark.parametrize("seed", seeds(5, deep=200))
    def test_any_order_of_triangles_and_corners(self, seed: int) -> None:
        given = triangulate(self.NESTED, "pqAa2")
        rng = np.random.default_rng(seed)
        order = rng.permutation(len(given["triangles"]))
        turned = [rng.permutation(row) for row in given["triangles"][order]]
        other = given | {"triangles": np.array(turned)}
        other["triangle_attributes"] = given["triangle_attributes"][order]
        one, two = (triangulate(each, "rqa0.7") for each in (given, other))
        assert np.array_equal(one["triangles"], two["triangles"])
        assert np.array_equal(one["triangle_attributes"], two["triangle_attributes"])

    def test_orientation_is_exact(self) -> None:
        # The rounded determinant of this triangle has the wrong sign or none.
        points = np.array([(0.5, 0.5), (12, 12), (24, 24.0)])
        points[0] += (2.0**-53, 3 * 2.0**-53)
        for corners in ([0, 1, 2], [0, 2, 1]):
            out = triangulate({"vertices": points, "triangles": [corners]}, "r")
            assert self.areas(out | {"triangle_attributes": np.zeros(1)})[0] > 0

    def test_equal_vertices_are_one(self) -> None:
        points = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0), (1, 1)]
        twice = {"vertices": points, "triangles": [(0, 1, 2), (4, 5, 3)], "segments": [(4, 5)]}
        marked = twice | {"triangle_attributes": [[5.0], [7.0]]}
        assert self.areas(triangulate(marked, "r")) == {5: Fraction(1, 2), 7: Fraction(1, 2)}

    def test_triangles_without_an_area_are_named(self) -> None:
        points = [*SQUARE["vertices"], (-1, -1), (-2, -2)]
        flat = {"vertices": points, "triangles": [(0, 1, 2), (0, 2, 3), (4, 5, 0)]}
        with pytest.raises(InputError, match=r"without an area cannot be refined: 2;"):
            triangulate(flat, "r")


def test_segments_through_vertices_of_given_triangles() -> None:
    """Diagonals pass through the center, a corner of all triangles; half of one is given again."""
    square = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
    given = {
        "vertices": square,
        "triangles": [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
        "segments": [(0, 2), (0, 4), (3, 1)],
        "segment_markers": [5, 6, 7],
    }
    made = triangulate(given, "rpqa0.1")
    ends = np.asarray(made["vertices"])[made["segments"]]
    marker = np.ravel(made["segment_markers"])
    rising = (ends[:, :, 0] == ends[:, :, 1]).all(axis=1)
    falling = (ends.sum(axis=2) == 2).all(axis=1)
    assert rising.sum() > 2 and falling.sum() > 2
    assert set(marker[rising]) == {5} and set(marker[falling]) == {7}
    assert not set(marker[~rising & ~falling]) & {5, 6, 7}


def test_no_triangles_are_nothing_to_refine() -> None:
    square = {"vertices": [(0, 0), (4, 0), (4, 4), (0, 4)], "triangles": np.zeros((0, 3), int)}
    with pytest.raises(InputError, match="triangles has no rows"):
        triangulate(square, "rqa1")


def test_errors_of_given_triangles_have_the_words_of_triangle() -> None:
    square: dict[str, Any] = {"vertices": [(0, 0), (4, 0), (4, 4), (0, 4)]}
    for triangles, kind, what in (
        ([(0, 1, 2), (0, 2, 9)], InputError,
         "triangles: row 1 is [0, 2, 9], outside the range 0 to 3"),
        ([(0, 1, 2), (0, 1, 3)], CrossingSegmentsError,
         "triangles overlap, or segments cross their outline, first at (2.0, 2.0)"),
        ([(0, 1), (0, 2)], ShapeError, "triangles must have shape (m, 3), got (2, 2)"),
        ([(0, 1, 2), (0, 2)], ShapeError,
         "triangles has rows of unequal length: row 0 has 3, row 1 has 2"),
    ):  # fmt: skip
        with pytest.raises(kind) as caught:
            triangulate(square | {"triangles": triangles}, "r")
        assert str(caught.value) == what


def test_maximum_areas_that_are_no_numbers_are_named() -> None:
    made = triangulate({"vertices": [(0, 0), (4, 0), (4, 4), (0, 4)]})
    with pytest.raises(NonFiniteError, match="triangle_max_area is NaN in 1") as caught:
        triangulate(made | {"triangle_max_area": [[1.0], [np.nan]]}, "ra")
    assert (caught.value.rows.tolist(), caught.value.count) == ([1], 1)
    with pytest.raises(DtypeError, match="triangle_max_area must hold real numbers"):
        triangulate(made | {"triangle_max_area": ["x", "y"]}, "ra")
    with pytest.raises(ShapeError, match="row 0 is a single value, row 1 has 2"):
        triangulate(made | {"triangle_max_area": [1, [2, 3]]}, "ra")
    # As in Triangle, what is not above 0 is no limit; nor is infinity.
    free = triangulate(made | {"triangle_max_area": [[-1.0], [np.inf]]}, "ra")
    assert len(free["triangles"]) == 2
