"""What the view gets of each class, and what moving a point does to it."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np
import pytest

import delone
from delone import (
    ConstrainedDelaunay,
    CrossingSegmentsError,
    DegenerateInputError,
    Delaunay,
    InputError,
    NonFiniteError,
    PeriodicDelaunay,
    RegularTriangulation,
    ShapeError,
    Voronoi,
)
from delone.explorer.state import Exploration

RNG = np.random.default_rng(5)
POINTS = RNG.random((40, 2))
WEIGHTS = 0.01 * RNG.random(40)
SQUARE = [(0, 0), (6, 0), (6, 6), (0, 6), (2, 2), (4, 2), (4, 4), (2, 4), (1, 3)]
RINGS = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
KINDS = {"i4": np.dtype("<i4"), "f8": np.dtype("<f8")}

MADE = {
    "Delaunay": Delaunay,
    "RegularTriangulation": lambda p: RegularTriangulation(p, WEIGHTS),
    "PeriodicDelaunay": lambda p: PeriodicDelaunay(p, (1.5, 2)),
    "PeriodicDelaunay in x": lambda p: PeriodicDelaunay(p, (1.5, None), weights=WEIGHTS),
    "Voronoi": Voronoi,
    "Voronoi with weights": lambda p: Voronoi(p, weights=WEIGHTS),
    "clipped Voronoi": lambda p: Voronoi(p, clip=(-1, -1, 2, 2)),
    "periodic Voronoi": lambda p: Voronoi(p, periods=(1.5, 2)),
    "ConstrainedDelaunay": lambda p: ConstrainedDelaunay(
        p, [(0, 1), (2, 3), (4, 5)], crossing="split", conforming=True
    ),
}


def read(block: bytes) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """The header and the arrays of a packed scene, as the view reads them."""
    (length,) = struct.unpack_from("<I", block)
    header = json.loads(block[4 : 4 + length])
    assert (4 + length) % 8 == 0
    arrays = {
        name: np.frombuffer(block, KINDS[each["kind"]], each["length"], 4 + length + each["start"])
        for name, each in header.pop("arrays").items()
    }
    return header, arrays


def same(a: Any, b: Any) -> bool:
    """Whether two objects of a class hold the same arrays."""
    first, second = a._saved(), b._saved()
    return type(a) is type(b) and all(
        np.array_equal(first[name], second[name], equal_nan=first[name].dtype.kind == "f")
        for name in first
    )


def test_a_scene_holds_the_triangles_and_their_measures() -> None:
    mesh = Delaunay(POINTS)
    header, arrays = read(Exploration(mesh, values=POINTS[:, 1], quality="area").packed())
    assert header["label"] == f"Delaunay of 40 points: {mesh.nsimplex} triangles"
    assert (header["movable"], header["qualityName"]) == (40, "area")
    assert np.array_equal(arrays["points"].reshape(-1, 2), mesh.points)
    assert np.array_equal(arrays["triangles"].reshape(-1, 3), mesh.simplices)
    assert np.array_equal(arrays["quality"], mesh.areas)
    assert np.array_equal(arrays["values"], POINTS[:, 1])
    assert "constrained" not in arrays
    assert "rows" not in arrays


@pytest.mark.parametrize("weights", [None, WEIGHTS], ids=["Voronoi", "power diagram"])
def test_edges_of_cells_are_as_far_from_both_sites(weights: Any) -> None:
    mesh = Delaunay(POINTS) if weights is None else RegularTriangulation(POINTS, weights)
    _, arrays = read(Exploration(mesh).packed())
    edges = arrays["dual"].reshape(-1, 2, 2)
    assert len(edges) == len(mesh.edges)
    away = ((edges[:, :, None] - POINTS) ** 2).sum(axis=3)
    power = np.sort(away - (0 if weights is None else weights), axis=2)
    scale = away.max(axis=2)
    # Of each end, rays included, the two least powers are equal.
    assert (np.abs(power[:, :, 1] - power[:, :, 0]) <= 1e-9 * scale).all()


def test_cells_of_a_clipped_diagram_end_at_the_clip() -> None:
    diagram = Voronoi(POINTS, clip=(-1, -1, 2, 2))
    _, arrays = read(Exploration(diagram).packed())
    edges = arrays["dual"].reshape(-1, 2, 2)
    assert edges.min() == -1
    assert edges.max() == 2
    lengths = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1)
    assert lengths.sum() == pytest.approx(diagram.cell_perimeters.sum())


def test_copies_of_a_periodic_set_come_after_the_points() -> None:
    mesh = PeriodicDelaunay(POINTS, (1.5, 2))
    header, arrays = read(Exploration(mesh, values=np.arange(40)).packed())
    points, rows = arrays["points"].reshape(-1, 2), arrays["rows"]
    assert np.array_equal(points[:40], POINTS)
    assert np.array_equal(rows[:40], np.arange(40))
    assert np.array_equal(arrays["values"], rows)
    assert header["movable"] == 40
    triangles = arrays["triangles"].reshape(-1, 3)
    assert np.array_equal(points[triangles], mesh.corners)
    assert np.array_equal(rows[triangles], mesh.simplices)
    moved = (points - POINTS[rows]) / (1.5, 2)
    assert np.allclose(moved, np.round(moved))
    assert len(np.unique(np.column_stack((rows, np.round(moved))), axis=0)) == len(points)


def test_segments_are_sent() -> None:
    mesh = ConstrainedDelaunay(SQUARE, RINGS, holes=[(3, 3)])
    _, arrays = read(Exploration(mesh).packed())
    assert np.array_equal(arrays["constrained"].reshape(-1, 2), mesh.segments)
    assert "dual" not in arrays


@pytest.mark.parametrize("name", MADE)
def test_a_moved_point_gives_what_its_coordinates_give(name: str) -> None:
    make = MADE[name]
    state = Exploration(make(POINTS))
    moved = POINTS.copy()
    for row, place in ((7, (0.25, 0.75)), (39, (0.5, 0.125)), (7, (0.5, 0.5))):
        moved[row] = place
        block = state.move(row, *place)
        assert same(state.mesh, make(moved))
        assert block == state.packed()


def test_options_and_values_stay_when_a_point_moves() -> None:
    options = {"holes": [(3, 3)], "regions": [(0.5, 0.5, 7)], "boundary": "outline"}
    mesh = ConstrainedDelaunay(SQUARE, RINGS, crossing="split", **options)
    state = Exploration(mesh, values=np.arange(9.0))
    # The corner of the hole crosses the outline: two vertices are added.
    block = state.move(5, 7, 2.5)
    places = [*SQUARE[:5], (7, 2.5), *SQUARE[6:]]
    assert same(state.mesh, ConstrainedDelaunay(places, RINGS, crossing="split", **options))
    header, arrays = read(block)
    assert header["movable"] == 9
    assert state.mesh.nadded == 2
    assert np.array_equal(arrays["values"], [*range(9), np.nan, np.nan], equal_nan=True)
    with pytest.raises(InputError, match="point 9"):
        state.move(9, 1, 1)
    header, arrays = read(state.move(5, 4, 2))
    assert same(state.mesh, mesh)
    assert np.array_equal(arrays["values"], np.arange(9.0))


def test_a_point_that_cannot_be_there_changes_nothing() -> None:
    state = Exploration(ConstrainedDelaunay(SQUARE, RINGS))
    before, block = state.mesh, state.packed()
    with pytest.raises(CrossingSegmentsError):
        state.move(5, 7, 2.5)
    flat = Exploration([(0, 0), (1, 0), (0, 1)])
    with pytest.raises(DegenerateInputError):
        flat.move(2, 2, 0)
    assert state.mesh is before
    assert state.packed() == block
    assert flat.mesh.points[2].tolist() == [0, 1]


@pytest.mark.parametrize(
    ("asked", "error", "text"),
    [
        ((True, 0, 0), InputError, "number"),
        (("1", 0, 0), InputError, "number"),
        ((1.0, 0, 0), InputError, "number"),
        ((-1, 0, 0), InputError, "point -1"),
        ((40, 0, 0), InputError, "point 40"),
        ((1, "0", 0), InputError, "coordinates"),
        ((1, 0, None), InputError, "coordinates"),
        ((1, 0, float("nan")), NonFiniteError, "NaN"),
        ((1, float("inf"), 0), NonFiniteError, "infinite"),
        ((1, 10**400, 0), NonFiniteError, "infinite"),
    ],
)
def test_odd_moves_are_refused(asked: Any, error: type[Exception], text: str) -> None:
    state = Exploration(POINTS)
    with pytest.raises(error, match=text):
        state.move(*asked)
    assert np.array_equal(state.mesh.points, POINTS)


def test_numbers_of_numpy_move_points() -> None:
    state = Exploration(POINTS)
    state.move(np.int64(3), np.float32(0.5), np.int32(1))
    assert state.mesh.points[3].tolist() == [0.5, 1]


def test_points_of_a_quality_mesh_do_not_move() -> None:
    state = Exploration(delone.mesh((SQUARE[:4], RINGS[:4]), max_area=4))
    assert state.movable == 0
    with pytest.raises(InputError, match="cannot be moved"):
        state.move(0, 1, 1)


@pytest.mark.parametrize(
    ("given", "error", "text"),
    [
        (Delaunay(RNG.random((9, 3))), InputError, "3-D"),
        (Voronoi(RNG.random((9, 3))), InputError, "3-D"),
        (RNG.random((9, 3)), ShapeError, "3-D"),
        (delone.ConvexHull(POINTS), InputError, "ConvexHull"),
        (RNG.random(9), ShapeError, "shape"),
        ("mesh.csv", delone.DtypeError, "strings"),
    ],
)
def test_other_things_are_refused(given: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        Exploration(given)


def test_options_are_checked() -> None:
    with pytest.raises(InputError, match="quality"):
        Exploration(POINTS, quality="beauty")
    with pytest.raises(ShapeError, match="values"):
        Exploration(POINTS, values=[1, 2])
