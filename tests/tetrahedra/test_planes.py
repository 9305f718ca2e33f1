"""Many triangles in one plane: flips in it bring those of the input back. Fractions judge."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from tiers import seeds

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from solids import Surface

Triangle = tuple[int, int, int]


def fan(count: int, _: np.random.Generator) -> list[Triangle]:
    """All diagonals from the first vertex."""
    return [(0, k, k + 1) for k in range(1, count - 1)]


def zigzag(count: int, _: np.random.Generator) -> list[Triangle]:
    """A strip of triangles from the first vertex to the opposite one."""
    low, high = 0, count - 1
    found = []
    while high - low > 1:
        if (high + low - count) % 2:
            found.append((low, low + 1, high))
            low += 1
        else:
            found.append((low, high - 1, high))
            high -= 1
    return found


def anyhow(count: int, rng: np.random.Generator) -> list[Triangle]:
    """A random triangulation of a convex polygon."""
    found, todo = [], [(0, count - 1)]
    while todo:
        i, j = todo.pop()
        if j - i > 1:
            k = int(rng.integers(i + 1, j))
            found.append((i, k, j))
            todo += [(i, k), (k, j)]
    return found


WAYS: dict[str, Callable[[int, np.random.Generator], list[Triangle]]] = {
    "fan": fan,
    "zigzag": zigzag,
    "random": anyhow,
}


def circle(count: int) -> list[tuple[float, float]]:
    angles = 2 * np.pi * np.arange(count) / count
    return list(zip(np.cos(angles).tolist(), np.sin(angles).tolist(), strict=True))


def parabola(count: int) -> list[tuple[float, float]]:
    """A convex outline of small integers: planes stay planes where it is tilted."""
    return [(-1.0, float(count**2)), *((float(k), float(k**2)) for k in range(count - 1))]


def prism(
    outline: Sequence[tuple[float, float]],
    ends: Sequence[Sequence[Triangle]],
    height: float = 1.0,
) -> Surface:
    """A convex outline extruded, with other triangles at each end."""
    count = len(outline)
    points = [(x, y, z) for z in (0.0, height) for x, y in outline]
    faces = [(a, c, b) for a, b, c in ends[0]]
    faces += [(a + count, b + count, c + count) for a, b, c in ends[1]]
    for k in range(count):
        j = (k + 1) % count
        faces += [(k, j, count + k), (j, count + j, count + k)]
    return np.array(points), np.array(faces)


def tilted(surface: Surface) -> Surface:
    """The same with planes that are no coordinate planes, exactly."""
    points, faces = surface
    x, y, z = points.T
    return np.column_stack((x + 2 * z, y - x, z - 4 * y)), faces


def plate(size: int, seed: int) -> Surface:
    """A plate of squares; flips at random lead its ends far from the Delaunay triangulation."""
    rng = np.random.default_rng(seed)
    grid = np.array([(x, y) for x in range(size + 1) for y in range(size + 1)], dtype=float)
    squares = [(x * (size + 1) + y) for x in range(size) for y in range(size)]
    made = [
        (k, k + size + 1, k + size + 2) if way else (k, k + size + 2, k + 1)
        for k in squares
        for way in (0, 1)
    ]
    ends = [flipped(grid, made, rng), flipped(grid, made, rng)]
    count = len(grid)
    rim = rim_of(made)
    points = [(x, y, z) for z in (0.0, 0.75) for x, y in grid.tolist()]
    faces = [(a, c, b) for a, b, c in ends[0]]
    faces += [(a + count, b + count, c + count) for a, b, c in ends[1]]
    for a, b in rim:
        faces += [(a, b, a + count), (b, b + count, a + count)]
    return np.array(points), np.array(faces)


def cubes(seed: int) -> Surface:
    """A union of random cubes, also with edges of four faces; flips in its planes at random."""
    rng = np.random.default_rng(seed)
    full = np.pad(rng.random(rng.integers(1, 5, 3)) < rng.choice([0.3, 0.6, 0.9]), 1)
    full[1, 1, 1] = True
    rows: dict[tuple[int, ...], int] = {}
    faces: list[Triangle] = []
    for cube in np.argwhere(full):
        for axis, step in ((axis, step) for axis in range(3) for step in (0, 1)):
            next_to = cube.copy()
            next_to[axis] += 2 * step - 1
            if full[tuple(next_to)]:
                continue
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = np.roll([step, u, v], axis) + cube
                corners.append(rows.setdefault(tuple(place.tolist()), len(rows)))
            a, b, c, d = corners if step else corners[::-1]
            faces += [(a, b, c), (a, c, d)] if rng.random() < 0.5 else [(a, b, d), (b, c, d)]
    points = np.array(list(rows), dtype=float)
    return points, np.array(flipped(points, faces, rng))


def rim_of(triangles: Sequence[Triangle]) -> list[tuple[int, int]]:
    """The edges of one triangle, in its direction."""
    edges = {edge for a, b, c in triangles for edge in ((a, b), (b, c), (c, a))}
    return sorted((a, b) for a, b in edges if (b, a) not in edges)


def flipped(grid: Any, triangles: Sequence[Triangle], rng: np.random.Generator) -> list[Triangle]:
    """Triangles after flips of edges at random; coordinates are small integers."""
    found = list(triangles)
    at = np.zeros((len(grid), 3), dtype=int)
    at[:, : np.shape(grid)[1]] = grid
    # The triangles at each edge.
    near: dict[frozenset[int], set[int]] = {}

    def change(t: int, face: Triangle) -> None:
        for old, edges in ((True, found[t]), (False, face)):
            for k in range(3):
                own = near.setdefault(frozenset((edges[k], edges[k - 2])), set())
                (own.discard if old else own.add)(t)
        found[t] = face

    def normal(a: int, b: int, c: int) -> Any:
        return np.cross(at[b] - at[a], at[c] - at[a])

    for t, face in enumerate(triangles):
        change(t, face)
    for _ in range(10 * len(found)):
        t, k = int(rng.integers(len(found))), int(rng.integers(3))
        a, b, c = found[t][k], found[t][k - 2], found[t][k - 1]
        back = near[frozenset((a, b))] - {t}
        if len(back) != 1:
            continue
        (u,) = back
        (d,) = set(found[u]) - {a, b}
        up = normal(a, b, c)
        one, other = (c, a, d), (d, b, c)
        flat = up @ (at[d] - at[a]) == 0 and not near.get(frozenset((c, d)))
        if flat and all(up @ normal(*face) > 0 for face in (found[u], one, other)):
            change(t, one)
            change(u, other)
    return found


def judge(mesh: delone.TetMesh, points: Any, faces: Any) -> None:
    """Judge in fractions: positive tetrahedra, all faces, and the volume that these enclose."""
    assert np.array_equal(mesh.points[: len(points)], points)
    uses = solids.triangles(mesh.simplices)
    assert set(uses.values()) <= {1, 2}
    assert {frozenset(face) for face in np.asarray(faces).tolist()} <= set(uses)
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(points, faces)
    assert mesh.validate(), str(mesh.validate())


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("turn", [False, True])
def test_ends_of_a_prism(way: str, turn: bool) -> None:
    rng = np.random.default_rng(1)
    count = 40
    ends = [WAYS[way](count, rng), WAYS[way](count, rng)]
    points, faces = prism(parabola(count), ends, 100.0)
    points, faces = tilted((points, faces)) if turn else (points, faces)
    mesh = delone.tetrahedralize(points, faces)
    judge(mesh, points, faces)
    report: Any = mesh.report
    assert report.missing_edges > count


@pytest.mark.parametrize("way", WAYS)
def test_effort_for_a_cylinder(way: str) -> None:
    # Flips that lead to each edge alone were 65,658 for 796 faces, and left 22 points.
    rng = np.random.default_rng(2)
    count = 120
    points, faces = prism(circle(count), [WAYS[way](count, rng), WAYS[way](count, rng)])
    mesh = delone.tetrahedralize(points, faces)
    judge(mesh, points, faces)
    report: Any = mesh.report
    assert report.flips < 10 * len(faces)
    assert mesh.nadded < 10


@pytest.mark.parametrize("seed", seeds(2, deep=20))
def test_a_plate(seed: int) -> None:
    points, faces = plate(6, seed)
    judge(delone.tetrahedralize(points, faces), points, faces)


@pytest.mark.parametrize("seed", seeds(4, deep=60))
@pytest.mark.parametrize("turn", [False, True])
def test_cubes(seed: int, turn: bool) -> None:
    points, faces = tilted(cubes(seed)) if turn else cubes(seed)
    mesh = delone.tetrahedralize(points, faces)
    judge(mesh, points, faces)
    report: Any = mesh.report
    assert report.flips < 10 * len(faces)


@pytest.mark.parametrize("seed", seeds(2, deep=20))
def test_walls_between_regions_keep_their_triangles(seed: int) -> None:
    # Both sides of the plane are filled, and edges of the wall are edges of other planes.
    rng = np.random.default_rng(seed)
    count = 24
    outline = parabola(count)
    middle = anyhow(count, rng)
    lower, low = prism(outline, [fan(count, rng), middle], 50.0)
    upper, high = prism(outline, [middle, zigzag(count, rng)], 70.0)
    # The middle once: without the top of the lower prism, and the bottom of the upper one.
    points = np.concatenate((lower, upper[count:] + np.array((0.0, 0.0, 50.0))))
    walls = np.concatenate((low[: count - 2], low[2 * (count - 2) :]))
    others = high[count - 2 :] + count
    wall = low[count - 2 : 2 * (count - 2)]
    faces = np.concatenate((walls, others, wall))
    mesh = delone.tetrahedralize(points, faces, inside="enclosed")
    outer = np.concatenate((walls, others))
    uses = solids.triangles(mesh.simplices)
    assert all(uses[frozenset(face)] == 2 for face in wall.tolist())
    assert all(uses[frozenset(face)] == 1 for face in outer.tolist())
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(points, outer)
    assert len(np.unique(mesh.region)) == 2


@pytest.mark.parametrize("seed", seeds(3, deep=40))
def test_a_sheet_inside(seed: int) -> None:
    # What is in the way of a flip may be on the other side, around the rim of the sheet.
    rng = np.random.default_rng(seed)
    size = 5
    grid = [(x, y) for x in range(size + 1) for y in range(size + 1)]
    made = [
        (k, k + size + 1, k + size + 2) if way else (k, k + size + 2, k + 1)
        for k in (x * (size + 1) + y for x in range(size) for y in range(size))
        for way in (0, 1)
    ]
    sheet = np.array(flipped(grid, made, rng))
    points, faces = solids.box((-1, -1, -1), (size + 1, size + 1, 1))
    inner = np.array([(x, y, 0.0) for x, y in grid])
    both = np.concatenate((faces, sheet + len(points)))
    mesh = delone.tetrahedralize(np.concatenate((points, inner)), both)
    uses = solids.triangles(mesh.simplices)
    assert all(uses[frozenset(face)] == 2 for face in (sheet + len(points)).tolist())
    assert solids.filled(mesh.points, mesh.simplices) == 2 * (size + 2) ** 2
    assert mesh.validate(), str(mesh.validate())


def test_the_order_of_rows_does_not_matter() -> None:
    points, faces = plate(5, 3)
    rng = np.random.default_rng(4)
    row = rng.permutation(len(points))
    others = np.argsort(row)[faces[rng.permutation(len(faces))]]
    first = delone.tetrahedralize(points, faces, workers=1)
    second = delone.tetrahedralize(points[row], others, workers=2)
    one, two = (
        sorted(sorted(map(tuple, mesh.points[corners].tolist())) for corners in mesh.simplices)
        for mesh in (first, second)
    )
    assert one == two
