"""Small surfaces: everything that a mesh promises, against fractions."""

from __future__ import annotations

import dataclasses
from collections import defaultdict
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids

if TYPE_CHECKING:
    from collections.abc import Callable

    from solids import Surface


def chazelle(gap: float = 0.25) -> Surface:
    """A box with two wedges, from above and below, whose edges nearly meet at right angles."""
    points = [(x, y, z) for x in (-2.0, 2) for y in (-2.0, 2) for z in (-2.0, 2)]
    # Above: the rims at x = -0.5 and 0.5, and the edge at x = 0.
    points += [(x, y, 2) for x in (-0.5, 0.5) for y in (-2, 2)] + [(0, -2, gap), (0, 2, gap)]
    points += [(x, y, -2) for y in (-0.5, 0.5) for x in (-2, 2)] + [(-2, 0, 0), (2, 0, 0)]
    polygons = [
        *((1, 8, 9, 3), (10, 5, 7, 11), (8, 12, 13, 9), (12, 10, 11, 13)),
        *((0, 4, 15, 14), (16, 17, 6, 2), (14, 15, 19, 18), (18, 19, 17, 16)),
    ]
    # Sides around the point of the edge, counter-clockwise as seen from outside.
    around = {
        12: (8, 1, 0, 4, 5, 10),
        13: (11, 7, 6, 2, 3, 9),
        18: (14, 0, 1, 3, 2, 16),
        19: (17, 6, 7, 5, 4, 15),
    }
    faces = [face for a, b, c, d in polygons for face in ((a, b, c), (a, c, d))]
    faces[8:16] = [(a, c, b) for a, b, c in faces[8:16]]
    for center, ring in around.items():
        faces += [(center, ring[k], ring[k + 1]) for k in range(5)]
    return np.array(points, dtype=float), np.array(faces)


def nested(*, reverse: bool) -> Surface:
    points, faces = solids.joined(
        solids.box((0, 0, 0), (3, 3, 3)), solids.box((1, 1, 1), (2, 2, 2))
    )
    if reverse:
        faces[12:] = faces[12:, ::-1]
    return points, faces


def sheet() -> Surface:
    """A cube with a rectangle inside, all around which there is room."""
    points, faces = solids.box((0, 0, 0), (4, 4, 4))
    wall = [(1, 1, 2), (3, 1, 2), (3, 3, 2.5), (1, 3, 2.5)]
    return np.concatenate((points, wall)), np.concatenate((faces, [(8, 9, 10), (8, 10, 11)]))


def cut() -> Surface:
    """A cube with a diagonal sheet from edge to edge."""
    points, faces = solids.box((0, 0, 0), (1, 1, 1))
    return points, np.concatenate((faces, [(0, 1, 6), (1, 7, 6)]))


def t_junction() -> Surface:
    """A box on a larger one: coplanar faces overlap, corners are inside faces."""
    return solids.joined(solids.box((0, 0, 0), (4, 4, 1)), solids.box((1, 1, 1), (2, 2, 3)))


def schoenhardt_in_box() -> Surface:
    return solids.joined(solids.box((-2, -2, -1), (2, 2, 2)), solids.schoenhardt())


SHAPES: dict[str, Callable[[], Surface]] = {
    "tetrahedron": lambda: (
        np.eye(4)[:, :3],
        np.array([(0, 1, 2), (1, 0, 3), (2, 1, 3), (0, 2, 3)]),
    ),
    "box": lambda: solids.box((0, 0, 0), (1, 2, 3)),
    "Schoenhardt": solids.schoenhardt,
    "tall Schoenhardt": lambda: solids.schoenhardt(height=1e6),
    "flat Schoenhardt": lambda: solids.schoenhardt(height=1e-6),
    "Schoenhardt in a box": schoenhardt_in_box,
    "torus": solids.torus,
    "Chazelle": chazelle,
    "narrow Chazelle": lambda: chazelle(1e-9),
    "nested": lambda: nested(reverse=False),
    "hollow": lambda: nested(reverse=True),
    "sheet": sheet,
    "cut": cut,
    "two boxes": lambda: solids.joined(
        solids.box((0, 0, 0), (1, 1, 1)), solids.box((1, 0, 0), (3, 1, 1))
    ),
    "T-junction": t_junction,
}


def judge(mesh: delone.TetMesh, points: Any, faces: Any) -> None:
    """Judge a mesh in fractions alone: positive, conforming, with all faces, of the volume."""
    assert np.array_equal(mesh.points[: len(points)], points)
    assert mesh.npoints == len(points) + mesh.nadded
    uses = solids.triangles(mesh.simplices)
    walls = {frozenset(face) for face in mesh.input_faces.tolist()}
    assert len(walls) == len(mesh.input_faces)
    assert set(uses.values()) <= {1, 2}
    assert {face for face, count in uses.items() if count == 1} <= walls
    assert walls <= set(uses)
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(mesh.points, mesh.boundary)
    parts = defaultdict(list)
    for row, source in zip(mesh.input_faces.tolist(), mesh.face_source.tolist(), strict=True):
        parts[source].append(row)
    for source, rows in parts.items():
        # What earlier faces cover is theirs.
        if source not in mesh.report.subdivided:
            assert solids.covered(points, faces[source].tolist(), rows)
    assert mesh.validate(), str(mesh.validate())


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("inside", ["winding", "parity", "enclosed"])
@pytest.mark.deep("parity-torus", "winding-torus")
@pytest.mark.sampled(10)
def test_judged_in_fractions(name: str, inside: str) -> None:
    points, faces = SHAPES[name]()
    mesh = delone.tetrahedralize(points, faces, inside=inside)
    judge(mesh, points, faces)
    check = delone.check_surface(points, faces)
    if check.closed and check.oriented and inside != "enclosed":
        # Each tetrahedron is inside, and nothing inside is missing.
        for row in mesh.simplices.tolist():
            number = solids.inside_number(points, faces, solids.center(mesh.points, row))
            assert number % 2 if inside == "parity" else number


@pytest.mark.parametrize(
    ("name", "inside", "volume"),
    [
        ("nested", "winding", 27),
        ("nested", "parity", 26),
        ("nested", "enclosed", 27),
        ("hollow", "winding", 26),
        ("hollow", "parity", 26),
        ("hollow", "enclosed", 27),
        ("two boxes", "winding", 3),
        ("two boxes", "parity", 3),
        ("T-junction", "winding", 18),
        ("T-junction", "parity", 18),
        ("sheet", "winding", 64),
        ("cut", "parity", 1),
    ],
)
def test_rule(name: str, inside: str, volume: int) -> None:
    mesh = delone.tetrahedralize(*SHAPES[name](), inside=inside)
    assert solids.filled(mesh.points, mesh.simplices) == volume


def test_schoenhardt_needs_one_point() -> None:
    mesh = delone.tetrahedralize(*solids.schoenhardt())
    assert mesh.nadded == mesh.report.nadded == 1
    assert len(mesh.points) == 7
    assert bool(mesh.report)


def test_regions_are_numbered_cells() -> None:
    for name, count in (("nested", 2), ("cut", 2), ("two boxes", 2), ("sheet", 1), ("hollow", 1)):
        mesh = delone.tetrahedralize(*SHAPES[name]())
        assert np.array_equal(np.unique(mesh.region), np.arange(count)), name
        # Regions differ across input faces only.
        walls = {frozenset(face) for face in mesh.input_faces.tolist()}
        for t, k in zip(*np.nonzero(mesh.neighbors >= 0), strict=True):
            u = mesh.neighbors[t, k]
            if mesh.region[t] != mesh.region[u]:
                assert frozenset(np.delete(mesh.simplices[t], k).tolist()) in walls


def test_one_wall_between_two_boxes() -> None:
    """Given once, in either orientation."""
    points, faces = SHAPES["two boxes"]()
    check = delone.check_surface(points, faces)
    once = np.delete(faces, check.duplicate_faces[:, 0], axis=0)
    assert len(once) == len(faces) - 2
    for inside in ("winding", "parity"):
        for turned in (once, np.where(np.arange(len(once))[:, None] == 2, once[:, ::-1], once)):
            mesh = delone.tetrahedralize(points, turned, inside=inside)
            judge(mesh, points, turned)
            assert solids.filled(mesh.points, mesh.simplices) == 3
            assert np.array_equal(np.unique(mesh.region), [0, 1])


def test_report_of_touching_faces() -> None:
    points, faces = t_junction()
    mesh = delone.tetrahedralize(points, faces)
    report = mesh.report
    assert isinstance(report, delone.RecoveryReport)
    check = delone.check_surface(points, faces)
    assert set(report.subdivided) | set(report.repeated) <= set(check.pairs.ravel())
    assert not report
    # The base of the small box is covered by the top of the large one.
    low = [
        i for i, face in enumerate(faces.tolist()) if i >= 12 and (points[face][:, 2] == 1).all()
    ]
    assert report.repeated.tolist() == low


def test_duplicates_are_merged_and_reported() -> None:
    points, faces = solids.torus()
    apart = points[faces].reshape(-1, 3)
    mesh = delone.tetrahedralize(apart, np.arange(len(apart)).reshape(-1, 3))
    assert len(mesh.report.duplicate_points) == len(apart) - len(points)
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(points, faces)
    for rule in ("winding", "parity"):
        repeated = delone.tetrahedralize(points, np.concatenate((faces, faces[:3])), inside=rule)
        assert repeated.report.repeated.tolist() == [80, 81, 82]
        assert solids.filled(repeated.points, repeated.simplices) == solids.volume(points, faces)


def test_faces_outside_are_left_out_and_reported() -> None:
    points, faces = solids.box((0, 0, 0), (1, 1, 1))
    points = np.concatenate((points, [(5, 5, 5), (6, 5, 5), (5, 6, 5)]))
    mesh = delone.tetrahedralize(points, np.concatenate((faces, [(8, 9, 10)])))
    assert mesh.report.outside.tolist() == [12]
    assert mesh.report.dangling.tolist() == [12]
    assert len(mesh.input_faces) == 12
    assert bool(mesh.validate())


@pytest.mark.parametrize("name", ["Schoenhardt", "torus", "T-junction", "two boxes", "sheet"])
def test_order_of_rows_does_not_matter(name: str) -> None:
    points, faces = SHAPES[name]()
    mesh = delone.tetrahedralize(points, faces)

    def shape(mesh: delone.TetMesh) -> Any:
        corners = mesh.points[mesh.simplices]
        return sorted(tuple(sorted(map(tuple, row))) for row in corners.tolist())

    rng = np.random.default_rng(3)
    for workers in (1, 3):
        row, face = rng.permutation(len(points)), rng.permutation(len(faces))
        place = np.argsort(row)
        turned = np.roll(place[faces[face]], 1, axis=1)
        other = delone.tetrahedralize(points[row], turned, workers=workers)
        assert shape(other) == shape(mesh)


@pytest.mark.parametrize("exponent", [-500, 500])
def test_powers_of_two_scale(exponent: int) -> None:
    points, faces = solids.torus()
    mesh = delone.tetrahedralize(points, faces)
    scaled = delone.tetrahedralize(points * 2.0**exponent, faces)
    assert np.array_equal(scaled.simplices, mesh.simplices)
    assert np.array_equal(scaled.points, mesh.points * 2.0**exponent)
    assert bool(scaled.validate())


def test_volume_differs_if_a_tetrahedron_is_missing() -> None:
    """The judge of these tests can fail."""
    mesh = delone.tetrahedralize(*solids.box((0, 0, 0), (1, 1, 1)))
    whole = solids.filled(mesh.points, mesh.simplices)
    assert whole == 1
    assert solids.filled(mesh.points, mesh.simplices[1:]) < whole
    assert isinstance(whole, Fraction)


@pytest.mark.parametrize(
    ("edges", "faces", "said"), [(2, 0, "2 edges and 0 faces"), (0, 1, "0 edges and 1 face")]
)
def test_the_report_says_what_was_missing(edges: int, faces: int, said: str) -> None:
    report = delone.tetrahedralize(*solids.torus()).report
    changed = dataclasses.replace(report, missing_edges=edges, missing_faces=faces)
    assert f"the Delaunay triangulation lacks {said}" in str(changed)
