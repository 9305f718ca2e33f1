"""Half-spaces as clips, against Fractions: whether they have volume and an end; their corners."""

from __future__ import annotations

import itertools
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from delone import Voronoi
from delone.errors import InputError
from delone.voronoi.halfspaces import common_part

Exact = tuple[Fraction, ...]

SITES = np.random.default_rng(0).random((6, 3))
BOX = [(1, 0, 0, -1), (-1, 0, 0, 0), (0, 1, 0, -1), (0, -1, 0, 0), (0, 0, 1, -1), (0, 0, -1, 0)]

TETRAHEDRON = [
    (-1, -1, 1, -1),
    (-1, -1, 0, 2),
    (-1, 0, 2, -1),
    (1, -2, 2, 0),
    (0, 0, -2, -1),
    (2, -1, 2, -1),
    (2, 1, 0, -1),
]
OPEN = [(0, 0, -1, -2), (-2, -2, -1, 0), (2, 2, 1, -2), (-1, 2, 0, -2), (-1, -2, -1, 1)]
ONE_POINT = [
    (1, 0, -1, 0),
    (-1, 1, -2, -1),
    (-1, 2, 0, -2),
    (2, 0, -1, 2),
    (0, 1, 1, 0),
    (1, 0, 1, -1),
    (0, -1, 2, 0),
    (1, -1, -1, -1),
]


def cross(p: Exact, q: Exact) -> Exact:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def dot(p: Any, q: Any) -> Fraction:
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


def corners_of(rows: list[Exact]) -> set[Exact]:
    """The points of what is common at which planes of three rows meet."""
    found = set()
    for a, b, c in itertools.combinations(rows, 3):
        parts = cross(b[:3], c[:3]), cross(c[:3], a[:3]), cross(a[:3], b[:3])
        det = dot(a[:3], parts[0])
        if det:
            upright = zip(*parts, strict=True)
            at = tuple(-dot((a[3], b[3], c[3]), part) / det for part in upright)
            if all(dot(row[:3], at) + row[3] <= 0 for row in rows):
                found.add(at)
    return found


def free_directions(rows: list[Exact]) -> list[Exact]:
    """Directions in which what is common has no end, if it has points."""
    normals = [row[:3] for row in rows]
    axes = [tuple(Fraction(int(i == k)) for i in range(3)) for k in range(3)]
    both = [cross(p, q) for p, q in itertools.combinations(normals + axes, 2)]
    ways = [tuple(s * x for x in way) for way in both if any(way) for s in (1, -1)]
    return [way for way in ways if all(dot(n, way) <= 0 for n in normals)]


def flat(points: list[Exact]) -> bool:
    seen = [tuple(x - y for x, y in zip(p, points[0], strict=True)) for p in points]
    return all(dot(a, cross(b, c)) == 0 for a, b, c in itertools.combinations(seen, 3))


def exact_rows(halfspaces: Any) -> list[Exact]:
    return [tuple(map(Fraction, row)) for row in np.asarray(halfspaces, dtype=float).tolist()]


def check(halfspaces: Any) -> None:
    rows = exact_rows(halfspaces)
    corners = corners_of(rows)
    if free_directions(rows):
        with pytest.raises(InputError, match=r"no end|no point|flat"):
            common_part(np.array(halfspaces, dtype=float))
    elif not corners:
        with pytest.raises(InputError, match="no point"):
            common_part(np.array(halfspaces, dtype=float))
    elif flat(sorted(corners)):
        with pytest.raises(InputError, match="no volume"):
            common_part(np.array(halfspaces, dtype=float))
    else:
        points, faces, numbers = common_part(np.array(halfspaces, dtype=float))
        exact = sorted(corners)
        assert points.tolist() == [[float(x) for x in at] for at in exact]
        check_faces(rows, exact, faces, numbers)


def check_faces(
    rows: list[Exact], corners: list[Exact], faces: list[list[int]], numbers: list[int]
) -> None:
    edges = [(u, v) for face in faces for u, v in zip(face, [*face[1:], face[0]], strict=True)]
    assert len(set(edges)) == len(edges)
    assert {(v, u) for u, v in edges} == set(edges)
    assert len(corners) - len(edges) // 2 + len(faces) == 2
    for face, number in zip(faces, numbers, strict=True):
        assert all(dot(rows[number][:3], corners[i]) + rows[number][3] == 0 for i in face)
        a, b, c = (corners[i] for i in face[:3])
        p, q = (tuple(y - x for x, y in zip(a, to, strict=True)) for to in (b, c))
        assert dot(rows[number][:3], cross(p, q)) > 0


numbers = st.integers(-2, 2)


@settings(max_examples=300, deadline=None)
@given(st.lists(st.tuples(numbers, numbers, numbers, numbers), min_size=1, max_size=8))
@example(TETRAHEDRON)
@example(OPEN)
@example(ONE_POINT)
@example([*BOX, *BOX[:2], (2, 0, 0, -2), (1, 1, 0, -2)])
@example([(1, 0, 0, 0), (-1, 0, 0, 0)])
def test_half_spaces_are_judged_as_by_fractions(halfspaces: list[tuple[int, ...]]) -> None:
    kept = [row for row in halfspaces if any(row[:3])]
    if kept:
        check(kept)


@pytest.mark.parametrize("seed", range(12))
def test_random_half_spaces_and_those_of_any_exponents(seed: int) -> None:
    rng = np.random.default_rng(seed)
    halfspaces = np.hstack((rng.normal(size=(8, 3)), -rng.random((8, 1))))
    if seed % 3 == 1:
        halfspaces *= 10.0 ** rng.uniform(-200, 200, (8, 1))
    if seed % 3 == 2:
        halfspaces = np.concatenate((halfspaces[:3], BOX))
    check(halfspaces)


@pytest.mark.parametrize(
    ("halfspaces", "message"),
    [
        ([*BOX[:5]], r"no end in the direction \(0, 0, -1\)"),
        (OPEN, r"no end in the direction"),
        (np.zeros((0, 4)), "no end"),
        (ONE_POINT, "no volume in common: it is flat"),
        ([*BOX, (1, 0, 0, 0)], "flat"),
        ([*BOX, (1, 0, 0, 5e-324)], "no point"),
        ([*BOX[1:], (1e-300, 0, 0, -1e300)], "beyond the range"),
        ([*BOX, (-1e300, 0, 0, 1e300), (1, 1, 0, -1 - 5e-17)], "flat"),
        ([*BOX, (-1, -1, 0, 2)], "flat"),
        ([], r"shape \(0,\)"),
        ([[1, 2], [3]], "clip must be"),
    ],
)
def test_what_is_no_clip_is_refused_by_its_reason(halfspaces: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Voronoi(SITES, clip=halfspaces)


def test_corners_that_differ_by_less_than_doubles_can_tell() -> None:
    # x + y + z / 2^60 >= 2 leaves (1, 1, 0), (1, 1, 1), and two corners 2^-60 beside that.
    thin = [*BOX, (-1, -1, -(2.0**-60), 2)]
    assert len(common_part(np.array(thin))[0]) == 4
    with pytest.raises(InputError, match="rounded to doubles"):
        Voronoi(SITES, clip=thin)


def test_a_slab_of_one_unit_in_the_last_place() -> None:
    diagram = Voronoi(SITES, clip=[*BOX, (-1, 0, 0, 1 - 2.0**-53)])
    assert diagram.cell_volumes.sum() == pytest.approx(2.0**-53, rel=1e-12)


def test_a_tetrahedron_beside_planes_that_touch_it() -> None:
    diagram = Voronoi(SITES, clip=TETRAHEDRON)
    assert diagram.cell_volumes.sum() == pytest.approx(1 / 12, rel=1e-14)
    assert diagram.clip is not None
    assert diagram.clip.points.tolist() == [
        [-2, 4, -0.5],
        [-2, 5, -0.5],
        [-1, 3, -0.5],
        [-1, 3, 0],
    ]


def test_the_order_of_half_spaces_changes_no_corner() -> None:
    rng = np.random.default_rng(1)
    normals = rng.normal(size=(60, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    halfspaces = np.column_stack((normals, -np.ones(60)))
    points, faces, rows = common_part(halfspaces)
    order = rng.permutation(60)
    again, turned, back = common_part(halfspaces[order])
    assert np.array_equal(points, again)
    named = dict(zip(rows, faces, strict=True))
    assert {int(order[row]): face for row, face in zip(back, turned, strict=True)} == named
    assert len(points) - sum(map(len, faces)) // 2 + len(faces) == 2


def test_many_planes_through_one_point() -> None:
    way = np.arange(40) * np.pi / 20
    sides = np.column_stack((np.cos(way), np.sin(way), np.ones(40), np.full(40, -1.0)))
    points, faces, rows = common_part(np.concatenate((sides, [(0, 0, -1, 0)])))
    assert sorted(map(len, faces)) == [3] * 40 + [40]
    assert rows == list(range(41))
    assert [0.0, 0.0, 1.0] in points.tolist()
