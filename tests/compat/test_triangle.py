"""What the drop-in for the package ``triangle`` refuses, and how."""

from __future__ import annotations

import warnings
from typing import Any, ClassVar

import numpy as np
import pytest

from delone import datasets, mesh
from delone.compat.triangle import convex_hull, delaunay, triangulate, voronoi
from delone.errors import DtypeError, InputError, ShapeError

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
