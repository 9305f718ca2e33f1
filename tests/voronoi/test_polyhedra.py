"""Clips of space against Fractions: half-spaces, and the faces of cells cut beside twins."""

from __future__ import annotations

import itertools
import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from delone import ConvexHull, Delaunay, Voronoi
from delone.errors import InputError
from delone.voronoi.halfspaces import common_part
from delone.voronoi.polyhedra import as_polyhedron
from rational import Vector, cross, dot, exact, minus
from tiers import examples

CORPUS = Path(__file__).parent.parent / "corpus" / "space"

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


def corners_of(rows: list[Vector]) -> set[Vector]:
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


def free_directions(rows: list[Vector]) -> list[Vector]:
    """Directions in which what is common has no end, if it has points."""
    normals = [row[:3] for row in rows]
    axes = [tuple(Fraction(int(i == k)) for i in range(3)) for k in range(3)]
    both = [cross(p, q) for p, q in itertools.combinations(normals + axes, 2)]
    ways = [tuple(s * x for x in way) for way in both if any(way) for s in (1, -1)]
    return [way for way in ways if all(dot(n, way) <= 0 for n in normals)]


def flat(points: list[Vector]) -> bool:
    seen = [tuple(x - y for x, y in zip(p, points[0], strict=True)) for p in points]
    return all(dot(a, cross(b, c)) == 0 for a, b, c in itertools.combinations(seen, 3))


def exact_rows(halfspaces: Any) -> list[Vector]:
    return [tuple(map(Fraction, row)) for row in np.asarray(halfspaces, dtype=float).tolist()]


def check(halfspaces: Any) -> None:
    rows = exact_rows(halfspaces)
    corners = corners_of(rows)
    if free_directions(rows):
        with pytest.raises(InputError, match=r"unbounded|no point|flat"):
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
    rows: list[Vector], corners: list[Vector], faces: list[list[int]], numbers: list[int]
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


@settings(max_examples=examples(60, deep=600), deadline=None)
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
        ([*BOX[:5]], r"unbounded in the direction \(0, 0, -1\)"),
        (OPEN, r"unbounded in the direction"),
        (np.zeros((0, 4)), "unbounded"),
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


def corpus(name: str) -> Any:
    case = json.loads((CORPUS / f"{name}.json").read_text(encoding="utf-8"))
    return np.array(case["points"])


def bisector(p: Vector, q: Vector) -> Vector:
    """The half-space of the points that are not farther from p than from q."""
    way = tuple(2 * (y - x) for x, y in zip(p, q, strict=True))
    return *way, dot(p, p) - dot(q, q)


def exact_area(row: Vector, corners: set[Vector]) -> float:
    """The area of the face of a half-space, by its shadow along the largest of its normal."""
    normal = row[:3]
    axis = max(range(3), key=lambda k: abs(normal[k]))
    shadow = sorted(at[:axis] + at[axis + 1 :] for at in corners if dot(normal, at) + row[3] == 0)
    if len(shadow) < 3:
        return 0.0

    def chain(points: list[Vector]) -> list[Vector]:
        kept: list[Vector] = []
        for p in points:
            while len(kept) > 1 and turn(kept[-2], kept[-1], p) <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    around = chain(shadow) + chain(shadow[::-1])
    twice = sum(turn(around[0], p, q) for p, q in itertools.pairwise(around[1:]))
    size = float(dot(normal, normal) / normal[axis] ** 2) ** 0.5
    return float(twice / 2) * size


def turn(p: Vector, q: Vector, r: Vector) -> Fraction:
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def check_areas(points: Any, bounds: tuple[Any, Any], rel: float, **clip: Any) -> None:
    """The faces between cells in a box have the areas of rational arithmetic."""
    diagram = Voronoi(points, **(clip or {"clip": bounds}))
    low, high = (tuple(map(Fraction, row)) for row in bounds)
    sites = exact_rows(points)
    axes = [tuple(Fraction(int(i == k)) for i in range(3)) for k in range(3)]
    box = [(*axis, -top) for axis, top in zip(axes, high, strict=True)]
    box += [(*(-x for x in axis), under) for axis, under in zip(axes, low, strict=True)]
    for i, p in enumerate(sites):
        rows = [bisector(p, q) for j, q in enumerate(sites) if j != i]
        corners = corners_of([*box, *rows])
        others = [j for j in range(len(sites)) if j != i]
        exact = {j: exact_area(row, corners) for j, row in zip(others, rows, strict=True)}
        cell = diagram.cell(i)
        found = dict(zip(cell.neighbors.tolist(), cell.sizes.tolist(), strict=True))
        assert found == pytest.approx({j: a for j, a in exact.items() if a}, rel=rel)
        assert cell.area == pytest.approx(
            sum(exact.values()) + sum(exact_area(row, corners) for row in box), rel=rel
        )


UNIT = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-11, 1e-13, 1e-14, 1e-15])
def test_faces_beside_twins_have_their_areas(gap: float) -> None:
    twins = [(0.5 - gap, 0.5, 0.75), (0.5 + gap, 0.5 + gap / 3, 0.75)]
    points = np.array([(0.5, 0.5, 0.25), *twins, (0.5, 0.9, 0.2), (0.1, 0.4, 0.4)])
    check_areas(points, UNIT, 1e-12)
    assert gap != 1e-15 or np.array_equal(points, corpus("twins-across-a-face"))


@pytest.mark.parametrize("seed", range(4))
def test_faces_beside_random_twins_in_boxes_half_spaces_and_hulls(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.random((4, 3))
    points = np.concatenate(
        (points, points[:2] + rng.choice((-1, 1), (2, 3)) * 10.0 ** -(8 + seed))
    )
    check_areas(points, UNIT, 1e-11)
    check_areas(points, UNIT, 1e-11, clip=BOX)
    corners = np.array(list(itertools.product((0.0, 1.0), repeat=3)))
    check_areas(points, UNIT, 1e-11, clip=corners)


def test_cells_of_a_shaken_lattice_are_closed_in_a_clip() -> None:
    points = corpus("lattice-shaken-by-roundings")
    diagram = Voronoi(points, clip="box")
    for i in range(len(points)):
        cell = diagram.cell(i)
        faces = [face.tolist() for face in cell.faces]
        edges = [(u, v) for face in faces for u, v in zip(face, face[1:] + face[:1], strict=True)]
        assert len(set(edges)) == len(edges)
        assert {(v, u) for u, v in edges} == set(edges)
        assert len(cell.vertices) - len(edges) // 2 + len(faces) == 2


def test_a_cell_of_which_nothing_is_left_has_an_area_of_plain_zero() -> None:
    diagram = Voronoi(np.random.default_rng(2).random((60, 3)), clip=((0, 0, 0), (0.2, 0.2, 0.2)))
    nothing = diagram.cell_areas == 0
    assert nothing.any()
    assert not np.signbit(diagram.cell_areas[nothing]).any()


CUBE = np.array(list(itertools.product((0.0, 1.0), repeat=3)))


def shape(points: Any, clip: Any) -> list[Any]:
    """Corners of each cell, and what is beyond each face with the face's corners; rounded."""
    diagram = Voronoi(points, clip=clip)
    found = []
    for i in range(len(points)):
        cell = diagram.cell(i)
        at = [tuple(round(x, 12) for x in row) for row in cell.vertices.tolist()]
        assert len(set(at)) == len(at)
        faces = [sorted(at[v] for v in face.tolist()) for face in cell.faces]
        found.append((set(at), sorted(zip(cell.beyond.tolist(), faces, strict=True))))
    return found


@pytest.mark.parametrize("turned", [False, True])
def test_facets_of_a_hull_are_whole(turned: bool) -> None:
    """The cells of a cube are the same as box, half-spaces, corners, lattice and hull."""
    points = [(0.2, 0.2, 0.3), (0.7, 0.3, 0.2), (0.4, 0.8, 0.6), (0.6, 0.6, 0.9), (0.1, 0.5, 0.8)]
    lattice = np.array(list(itertools.product((0.0, 0.5, 1.0), repeat=3)))
    if turned:
        lattice = lattice[::-1]
    box = shape(points, CUBE[[0, -1]])
    assert (len(box[0][0]), len(box[0][1])) == (10, 7)
    for clip in (BOX, CUBE, lattice, ConvexHull(CUBE), ConvexHull(lattice), Delaunay(lattice)):
        assert shape(points, clip) == box


def exact_cells(points: list[Vector], rows: list[Vector]) -> list[list[set[Vector]]]:
    """The corners of the faces of each cell within half-spaces, but for faces of no area."""
    found = []
    for p in points:
        walls = [bisector(p, q) for q in points if q != p] + rows
        corners = corners_of(walls)
        faces = [{at for at in corners if dot(row[:3], at) + row[3] == 0} for row in walls]
        found.append([face for face in faces if len(face) > 2])
    return found


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.sampled(3)
def test_faces_of_a_hull_are_those_of_fractions(seed: int) -> None:
    """Polytopes of small integers, whose facets have many corners, and points in their middle."""
    rng = np.random.default_rng(seed)
    corners = rng.integers(-2, 3, (30, 3)).astype(float)
    sites = exact(rng.integers(-16, 17, (5, 3)) / 16)
    hull = ConvexHull(corners)
    rows = []
    for facet in hull.facets:
        a, b, c = (exact(hull.points)[v] for v in facet[:3])
        normal = cross(minus(b, a), minus(c, a))
        rows.append((*normal, -dot(normal, a)))
    cells = exact_cells(sites, rows)
    for clip in (corners, hull, hull.points[hull.vertices][::-1]):
        diagram = Voronoi(np.array(sites, dtype=float), clip=clip)
        for i, faces in enumerate(cells):
            cell = diagram.cell(i)
            assert len(cell.vertices) == len(set().union(*faces))
            assert sorted(map(len, cell.faces)) == sorted(map(len, faces))
            wanted = np.array(sorted(set().union(*faces)), dtype=float)
            far = np.abs(wanted[:, None] - cell.vertices).max(axis=2).min(axis=1)
            assert (far < 1e-12).all()


@pytest.mark.parametrize("scale", [1.0, 2.0**-700])
def test_no_corner_of_a_hull_is_outside_of_its_planes(scale: float) -> None:
    """Corners on a sphere, on a cone and on a lattice."""
    rng = np.random.default_rng(7)
    ball = rng.normal(size=(700, 3))
    ball /= np.linalg.norm(ball, axis=1)[:, None]
    way = np.arange(300) * np.pi / 150
    cone = np.column_stack((np.cos(way), np.sin(way), np.zeros(300)))
    lattice = np.array(list(itertools.product(range(5), repeat=3))) * 0.1
    for points in (ball + 10, np.concatenate((cone, [(0, 0, 3)])), lattice):
        body = as_polyhedron(points * scale, points * scale)
        assert body is not None
        products = np.einsum("ik,jk->ij", body.planes[:, :3], body.points)
        farthest = products.max(axis=1)
        rounding = 2.0**-50 * (np.abs(body.planes[:, :3]) @ np.abs(body.points).max(axis=0))
        assert (np.abs(farthest - body.planes[:, 3]) <= rounding).all()


@pytest.mark.deep
def test_half_spaces_around_a_ball_have_the_corners_of_fractions() -> None:
    rng = np.random.default_rng(11)
    normals = rng.normal(size=(400, 3))
    halfspaces = np.column_stack((normals, -np.linalg.norm(normals, axis=1)))
    points, faces, rows = common_part(halfspaces)
    assert len(points) - sum(map(len, faces)) // 2 + len(faces) == 2
    assert [tuple(p) for p in points.tolist()] == sorted(map(tuple, points.tolist()))
    planes = [tuple(map(Fraction, row)) for row in halfspaces.tolist()]
    on: dict[int, list[int]] = {}
    for face, row in zip(faces, rows, strict=True):
        for corner in face:
            on.setdefault(corner, []).append(row)
    for corner, beside in on.items():
        (at,) = corners_of([planes[row] for row in beside])
        assert points[corner].tolist() == [float(x) for x in at]
        assert all(dot(row[:3], at) + row[3] <= 0 for row in planes)
