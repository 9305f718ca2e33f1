"""Triangles in one plane that are cut again: fractions judge what they cover."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import delone
import solids
from delone.solids.tetmesh.planes import differing

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from solids import Surface, Vector


def prism(outline: Sequence[tuple[float, float]], height: float = 1.0) -> Surface:
    """A star-shaped outline extruded, each end a fan of its first vertex, which sees all."""
    n = len(outline)
    points = [(x, y, z) for z in (0.0, height) for x, y in outline]
    faces = [face for k in range(1, n - 1) for face in ((0, k + 1, k), (n, n + k, n + k + 1))]
    for k in range(n):
        j = (k + 1) % n
        faces += [(k, j, n + k), (j, n + j, n + k)]
    return np.array(points), np.array(faces)


def disk(count: int) -> list[tuple[float, float]]:
    """A convex outline on a parabola and a line: no four vertices on a circle but by chance."""
    return [(-1.0, 3.0)] + [(k / count, (k / count) ** 2) for k in range(count + 1)]


def tilted(surface: Surface) -> Surface:
    """The same with planes that are no coordinate planes, exactly."""
    points, faces = surface
    x, y, z = points.T
    return np.column_stack((x + 2 * z, y - x, z - 4 * y)), faces


def turned(points: Any, row: Sequence[int]) -> Vector:
    a, b, c = (solids.exact(points)[i] for i in row)
    return solids.cross(solids.minus(b, a), solids.minus(c, a))


def judge(mesh: delone.TetMesh, points: Any, faces: Any) -> None:
    """Judge coverage, tetrahedra, and that flat parts are Delaunay, in fractions."""
    report: Any = mesh.report
    assert mesh.validate(), str(mesh.validate())
    assert np.array_equal(mesh.points[: len(points)], points)
    volume = solids.volume(points, faces)
    assert solids.filled(mesh.points, mesh.simplices) == volume
    assert solids.volume(mesh.points, mesh.input_faces) == volume
    own = {
        frozenset(face): source
        for face, source in zip(mesh.input_faces.tolist(), mesh.face_source.tolist(), strict=True)
    }
    cut = set(report.recut_source[:, 0].tolist())
    for row, face in enumerate(np.asarray(faces).tolist()):
        assert row in cut or own.get(frozenset(face)) == row
    for part in np.unique(report.recut_source[:, 1]).tolist():
        old = report.recut[report.recut_source[:, 1] == part].tolist()
        new = mesh.input_faces[mesh.face_source == part].tolist()
        normals = [turned(points, row) for row in old + new]
        for normal in normals:
            # Parallel, in the same direction, in the same plane.
            assert solids.cross(normal, normals[0]) == (0, 0, 0)
            assert solids.dot(normal, normals[0]) > 0
        places = solids.exact(points)
        assert len({solids.dot(normals[0], places[i]) for row in old + new for i in row}) == 1
        size = [solids.dot(normal, normals[0]) for normal in normals]
        assert sum(size[: len(old)], Fraction(0)) == sum(size[len(old) :], Fraction(0))
        for row in new:
            assert sum(contains(points, other, solids.center(points, row)) for other in old) >= 1
        flat_is_delaunay(points, new)


def contains(points: Any, face: Sequence[int], place: Vector) -> bool:
    a, b, c = (solids.exact(points)[i] for i in face)
    normal = turned(points, face)
    return all(
        solids.dot(solids.cross(solids.minus(q, p), solids.minus(place, p)), normal) >= 0
        for p, q in ((a, b), (b, c), (c, a))
    )


def flat_is_delaunay(points: Any, faces: list[list[int]]) -> None:
    """The two angles at each edge inside sum to at most a straight one."""
    places = solids.exact(points)
    normal = turned(points, faces[0])
    for one, other in combinations(faces, 2):
        common = sorted(set(one) & set(other))
        if len(common) != 2:
            continue
        product = []
        for row in (one, other):
            (apex,) = (places[i] for i in row if i not in common)
            p, q = (solids.minus(places[i], apex) for i in common)
            sine = abs(solids.dot(solids.cross(p, q), normal))
            product.append((solids.dot(p, q), sine))
        (cos_a, sin_a), (cos_b, sin_b) = product
        assert cos_a * sin_b + cos_b * sin_a >= 0


SURFACES = {
    "disk": lambda: prism(disk(8)),
    "tilted": lambda: tilted(prism(disk(8))),
    "high": lambda: prism(disk(8), 2.0**20),
    "L": lambda: prism([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)]),
    "two boxes": lambda: solids.joined(
        solids.box((0, 0, 0), (1, 3, 1)), solids.box((1, 0, 0), (3, 3, 1))
    ),
    "T-junction": lambda: solids.joined(
        solids.box((0, 0, 0), (4, 4, 1)), solids.box((1, 1, 1), (2, 2, 3))
    ),
}


@pytest.mark.parametrize("name", ["disk", "tilted", "high", "L"])
def test_plane_parts_are_cut_again(name: str) -> None:
    points, faces = SURFACES[name]()
    mesh = delone.tetrahedralize(points, faces, boundary="surface")
    judge(mesh, points, faces)
    report: Any = mesh.report
    assert not mesh.nadded
    if name != "L":
        assert len(report.recut) and not report


def test_each_triangle_is_kept_by_default() -> None:
    points, faces = SURFACES["disk"]()
    report: Any = delone.tetrahedralize(points, faces).report
    assert not len(report.recut) and report


@pytest.mark.parametrize("name", ["two boxes", "T-junction"])
def test_where_faces_touch(name: str) -> None:
    points, faces = SURFACES[name]()
    mesh = delone.tetrahedralize(points, faces, boundary="surface")
    kept = delone.tetrahedralize(points, faces)
    assert mesh.validate(), str(mesh.validate())
    found = solids.filled(mesh.points, mesh.simplices)
    assert found == solids.filled(kept.points, kept.simplices)
    assert len(np.unique(mesh.region)) == 2


def test_markers_and_edges_of_other_faces_stay() -> None:
    """A line between two markers, and one where a third face ends, are edges of the mesh."""
    points, faces = prism(disk(8))
    markers = np.where(np.arange(len(faces)) % 7 == 0, 5, 3)
    mesh = delone.tetrahedralize(points, faces, boundary="surface", face_markers=markers)
    judge(mesh, points, faces)
    assert np.array_equal(np.unique(mesh.face_markers), [3, 5])
    assert np.array_equal(mesh.face_markers, markers[mesh.face_source])

    def area(faces: Any, rows: Any) -> Fraction:
        ends = [row for row in np.asarray(faces)[rows].tolist() if len(set(points[row][:, 2])) == 1]
        return sum((abs(turned(points, row)[2]) for row in ends), Fraction(0))

    assert area(faces, markers == 5) == area(mesh.input_faces, mesh.face_markers == 5)
    # A wall along the first edge of the fan that is not on the outline.
    wall = np.concatenate((faces, [(0, 2, 10), (2, 12, 10)]))
    walled = delone.tetrahedralize(points, wall, boundary="surface")
    edges = {frozenset(edge) for edge in walled.edges.tolist()}
    assert {frozenset((0, 2)), frozenset((10, 12))} <= edges
    assert len(np.unique(walled.region)) == 2


@pytest.mark.parametrize("name", ["disk", "tilted", "L"])
def test_order_and_scale_do_not_matter(name: str) -> None:
    points, faces = SURFACES[name]()

    def shape(mesh: delone.TetMesh, scale: float = 1.0) -> Any:
        corners = mesh.points[mesh.input_faces] / scale
        return sorted(tuple(sorted(map(tuple, row))) for row in corners.tolist())

    wanted = shape(delone.tetrahedralize(points, faces, boundary="surface"))
    rng = np.random.default_rng(5)
    for scale in (1.0, 2.0**-800, 2.0**900):
        row, face = rng.permutation(len(points)), rng.permutation(len(faces))
        other = np.roll(np.argsort(row)[faces[face]], 1, axis=1)
        mesh = delone.tetrahedralize(points[row] * scale, other, boundary="surface", workers=2)
        assert shape(mesh, scale) == wanted
        assert mesh.validate()


@given(
    st.lists(st.tuples(st.integers(1, 40), st.integers(-9, 9)), min_size=2, max_size=12),
    st.booleans(),
)
@pytest.mark.deep
def test_random_fans(steps: list[tuple[int, int]], slanted: bool) -> None:
    """A function above a line, fanned from a place that sees it: far below."""
    x = np.cumsum([0] + [step for step, _ in steps]).tolist()
    outline = [
        (float(x[-1] + 1), -2000.0),
        *((float(u), float(v)) for u, (_, v) in zip(x[::-1], [*steps, (0, 0)], strict=True)),
    ]
    surface = prism([(u, v) for u, v in outline], 7.0)
    points, faces = tilted(surface) if slanted else surface
    check = delone.check_surface(points, faces)
    if check.ncrossing or check.volume <= 0:
        return
    judge(delone.tetrahedralize(points, faces, boundary="surface"), points, faces)


def test_the_judge_finds_what_is_not_covered() -> None:
    points = np.array([(0, 0, 0), (4, 0, 0), (4, 3, 0), (0, 3, 0), (2, 1, 0), (2, 1, 1)], float)
    square = np.array([(0, 1, 2), (0, 2, 3)])
    part = np.array([7, 7])
    good = np.array([(0, 1, 3), (1, 2, 3)])
    assert not len(differing(points, (square, part), (good, part)))
    for bad in (
        good[:1],
        good[:, ::-1],
        np.array([(0, 1, 3), (1, 2, 3), (0, 1, 3)]),
        # The center instead, lifted, and folded over the outline.
        np.array([(0, 1, 5), (1, 2, 5), (2, 3, 5), (3, 0, 5)]),
        np.array([(0, 1, 2), (0, 2, 4), (2, 3, 4)]),
    ):
        assert differing(points, (square, part), (bad, np.full(len(bad), 7))).tolist() == [7]
    inner = np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    assert not len(differing(points, (square, part), (inner, np.full(4, 7))))
    # A triangle of another part is no part of it.
    assert differing(points, (square, part), (good, np.array([7, 8]))).tolist() == [7]


def test_saved_and_loaded(tmp_path: Path) -> None:
    mesh = delone.tetrahedralize(*SURFACES["disk"](), boundary="surface")
    mesh.save(tmp_path / "mesh.npz")
    other = delone.TetMesh.load(tmp_path / "mesh.npz")
    assert np.array_equal(other.report.recut, mesh.report.recut)  # type: ignore[union-attr]
    assert bool(other.validate())
