"""What a surface is: closed, oriented, manifold, its regions and volume, and bad input."""

from __future__ import annotations

import pickle
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from surfaces import box, joined, sphere, volume

TETRAHEDRON = (
    [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)],
)


def test_a_box_is_a_surface() -> None:
    check = delone.check_surface(*box((0, 0, 0), (1, 2, 3)))
    assert check and check.closed and check.oriented and check.manifold
    assert (check.volume, check.volume_sign, check.nedges) == (6, 1, 18)
    assert (check.ncomponents, check.nregions) == (1, 1)
    assert not len(check.dangling) and check.component.tolist() == [0] * 12
    check.raise_if_bad()


def test_an_inverted_box_has_a_negative_volume() -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    check = delone.check_surface(points, faces[:, ::-1])
    assert check and (check.volume, check.volume_sign) == (-1, -1)


def test_an_open_surface_names_its_boundary() -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    check = delone.check_surface(points, faces[1:])
    assert not check and not check.closed and check.nregions == 0 and np.isnan(check.volume)
    assert check.boundary.tolist() == [[0, 1], [0, 2], [1, 2]]
    assert len(check.dangling) == 11
    with pytest.raises(delone.OpenSurfaceError) as caught:
        check.raise_if_bad()
    assert caught.value.edges.tolist() == check.boundary.tolist()
    assert pickle.loads(pickle.dumps(caught.value)).edges.tolist() == check.boundary.tolist()


def test_a_turned_face_is_named_by_its_edges() -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    faces = faces.copy()
    faces[4] = faces[4][::-1]
    check = delone.check_surface(points, faces)
    assert check and check.closed and not check.oriented and check.manifold
    assert {frozenset(e) for e in check.misoriented_edges.tolist()} == {
        frozenset(e) for e in ((0, 1), (1, 4), (0, 4))
    }
    assert np.isnan(check.volume) and check.volume_sign == 0


def test_regions_of_walls_sheets_and_shells() -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    wall = np.concatenate((faces, [(1, 2, 4)]))
    # The face from 1 to 2 to 4 cuts off a corner of the box, at the vertex 0.
    check = delone.check_surface(points, wall)
    assert not check.ncrossing
    assert (check.nregions, len(check.nonmanifold_edges)) == (2, 3)
    assert not check.manifold and not check.oriented and check.closed
    sheet = np.concatenate((points, [(0.5, 0.5, 0.5)])), np.concatenate((faces, [(1, 2, 8)]))
    check = delone.check_surface(*sheet)
    assert check and (check.nregions, check.dangling.tolist()) == (1, [12])
    assert check.boundary.tolist() == [[1, 8], [2, 8]]
    nested = joined(box((0, 0, 0), (9, 9, 9)), *(box((k, k, k), (9 - k,) * 3) for k in (1, 2, 3)))
    check = delone.check_surface(*nested)
    assert (check.nregions, check.ncomponents) == (4, 4)
    assert check.component.tolist() == [k for k in range(4) for _ in range(12)]


def test_two_boxes_at_a_vertex_or_an_edge_are_not_manifold() -> None:
    corner = joined(box((0, 0, 0), (1, 1, 1)), box((1, 1, 1), (2, 2, 2)))
    check = delone.check_surface(*corner)
    assert check and check.nonmanifold_vertices.tolist() == [7] and check.ncomponents == 2
    assert check.duplicate_points.tolist() == [[8, 7]] and not len(check.nonmanifold_edges)
    assert check.nregions == 2
    edge = joined(box((0, 0, 0), (1, 1, 1)), box((1, 1, 0), (2, 2, 1)))
    check = delone.check_surface(*edge)
    assert check and check.nonmanifold_edges.tolist() == [[3, 7]] and check.ncomponents == 1
    assert check.nonmanifold_vertices.tolist() == [3, 7]
    assert check.nregions == 2 and check.oriented


@pytest.mark.parametrize("k", [3, 4, 5, 6, 9])
def test_sectors_around_an_edge_are_regions(k: int) -> None:
    # k half-planes around the z-axis, closed by a cap at each end and a wall outside.
    angle = 2 * np.pi * np.arange(k) / k
    rim = np.column_stack((np.cos(angle), np.sin(angle)))
    ends = [np.column_stack((rim, np.full(k, z))) for z in (0.0, 1.0)]
    points = np.concatenate(([(0, 0, 0), (0, 0, 1)], *ends))
    low, high = 2 + np.arange(k), 2 + k + np.arange(k)
    faces = []
    for i in range(k):
        a, b, c, d = low[i], low[(i + 1) % k], high[i], high[(i + 1) % k]
        faces += [(0, 1, a), (1, c, a), (0, a, b), (1, c, d), (a, b, c), (b, d, c)]
    rng = np.random.default_rng(k)
    faces = np.array([np.roll(f, rng.integers(3)) for f in rng.permutation(faces)])
    check = delone.check_surface(points, faces)
    assert check.npairs == 0 and check.nregions == k and not len(check.dangling)
    # Without one of the walls inside, two regions are one.
    first = next(f for f in faces.tolist() if set(f) >= {0, 1})
    spoke = (set(first) - {0, 1}).pop()
    gone = [set(f) in ({0, 1, spoke}, {1, spoke, spoke + k}) for f in faces.tolist()]
    assert sum(gone) == 2
    assert delone.check_surface(points, faces[~np.array(gone)]).nregions == k - 1


def test_faults_of_rows() -> None:
    points = [*TETRAHEDRON[0], (2, 0, 0), (0, 0, 0)]
    faces = [*TETRAHEDRON[1], (0, 1, 4), (1, 1, 2), (0, 5, 2), (1, 0, 2), (5, 1, 3)]
    check = delone.check_surface(points, faces)
    assert check.collinear.tolist() == [4]
    assert check.repeated_vertices.tolist() == [5, 6]
    assert check.duplicate_faces.tolist() == [[7, 0], [8, 1]]
    assert check.duplicate_points.tolist() == [[5, 0]]
    assert check.component.tolist() == [0, 0, 0, 0, -1, -1, -1, 0, 0]
    for text in ("collinear corners: 4", "repeated vertex: 5, 6", "repeat others: 7, 8"):
        assert text in str(check)


@pytest.mark.parametrize("scale", [1.0, 2.0**-1022, 2.0**-340, 2.0**330])
def test_the_volume_is_rounded_correctly(scale: float) -> None:
    rng = np.random.default_rng(1)
    points, faces = sphere(2)
    points = (points * rng.uniform(0.5, 1.0, (len(points), 1)) + [1e8, -3, 0.1]) * scale
    check = delone.check_surface(points, faces)
    exact = volume(points, faces)
    assert check.volume == float(exact)
    assert check.volume_sign == (exact > 0) - (exact < 0) == 1


def test_a_volume_of_zero_is_exact() -> None:
    # Two tetrahedra, one turned: their volumes cancel, up to one ulp of a coordinate or not.
    points = np.array([*TETRAHEDRON[0]], dtype=float) / 3
    apart, turned = points + np.array([5, 0, 0]), np.array(TETRAHEDRON[1])[:, ::-1]
    both = joined((points, TETRAHEDRON[1]), (apart, turned))
    check = delone.check_surface(*both)
    exact = volume(*both)
    assert check.volume_sign == (exact > Fraction(0)) - (exact < 0)
    assert check.volume == float(exact)
    turned = joined((points, TETRAHEDRON[1]), (points + np.array([4, 0, 0]), TETRAHEDRON[1]))
    assert delone.check_surface(*turned).volume_sign == 1


def test_empty_and_flat_surfaces() -> None:
    none = delone.check_surface(np.empty((0, 3)), np.empty((0, 3), dtype=int))
    assert not none and not none.closed and none.nregions == 0
    with pytest.raises(delone.InputError, match="no faces"):
        none.raise_if_bad()
    flat = delone.check_surface([(0, 0, 1), (1, 0, 1), (0, 1, 1)], [(0, 1, 2)])
    with pytest.raises(delone.DegenerateInputError, match="one plane"):
        flat.raise_if_bad()


@pytest.mark.parametrize(
    ("points", "faces", "error"),
    [
        ([(0, 0, np.nan), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], delone.NonFiniteError),
        ([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)], delone.ShapeError),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 3)], delone.InputError),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1)], delone.ShapeError),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0.5, 1, 2)], delone.DtypeError),
    ],
)
def test_bad_input(points: Any, faces: Any, error: type[Exception]) -> None:
    for function in (delone.check_surface, delone.resolve_touches):
        with pytest.raises(error):
            function(points, faces)


def test_the_result_never_changes() -> None:
    check = delone.check_surface(*TETRAHEDRON)
    with pytest.raises(AttributeError):
        check.volume = 1.0  # type: ignore[misc]
    with pytest.raises(ValueError, match="read-only"):
        check.component[0] = 1
    again = pickle.loads(pickle.dumps(check))
    assert str(again) == str(check) and not again.component.flags.writeable


@pytest.mark.parametrize(
    ("faces", "flat"),
    [
        ([(0, 1, 2), (0, 1, 2)], True),
        ([(0, 1, 3)], True),
        ([(0, 1, 3), (0, 1, 2)], True),
        ([(0, 1, 3), (0, 1, 2), (0, 1, 4)], False),
    ],
)
def test_faces_that_repeat_or_have_no_area_are_flat(faces: Any, flat: bool) -> None:
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (2, 0, 0), (0, 0, 1)]
    assert delone.check_surface(points, faces).flat is flat
