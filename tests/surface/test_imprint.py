"""Faces cut where they cross, overlap or touch: conforming, near their sources, for every order."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from rational import exact
from surfaces import box, brute_pairs, joined, sphere

AXES = np.array([(0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6)])


def volume(points: Any, faces: Any) -> Fraction:
    """Return six times the volume, exactly."""
    rows = exact(points)
    total = Fraction(0)
    for a, b, c in faces.tolist():
        (p, q, r), (s, t, u), (v, w, x) = rows[a], rows[b], rows[c]
        total += p * (t * x - u * w) - q * (s * x - u * v) + r * (s * w - t * v)
    return total


def distance(point: Any, corners: Any) -> float:
    """Return the distance from a triangle, by minimizing over its edges and its interior."""
    a, b, c = corners
    normal = np.cross(b - a, c - a)
    inside = all(
        np.dot(np.cross(q - p, point - p), normal) >= 0 for p, q in ((a, b), (b, c), (c, a))
    )
    if inside:
        return abs(np.dot(point - a, normal)) / math.sqrt(np.dot(normal, normal))
    found = []
    for p, q in ((a, b), (b, c), (c, a)):
        share = np.clip(np.dot(point - p, q - p) / np.dot(q - p, q - p), 0, 1)
        found.append(np.linalg.norm(point - p - share * (q - p)))
    return float(min(found))


def check(points: Any, faces: Any, cut: delone.ImprintedSurface) -> None:
    """Check that parts conform, cover their sources, and are near them."""
    distinct = np.unique(np.sort(cut.faces, axis=1), axis=0)
    assert brute_pairs(cut.points, distinct) == {}
    assert (cut.points[: len(points)] == points).all()
    assert (np.diff(cut.source) >= 0).all()
    assert cut.nadded == len(cut.points) - len(points)
    far = 0.0
    for part, row in zip(cut.faces, cut.source.tolist(), strict=True):
        corners = points[faces[row]]
        a, b, c = cut.points[part]
        own, given = (
            np.cross(b - a, c - a),
            np.cross(corners[1] - corners[0], corners[2] - corners[0]),
        )
        assert np.dot(own, given) > 0
        far = max(far, *(distance(cut.points[v], corners) for v in part))
    assert cut.largest_distance == pytest.approx(far, rel=1e-6, abs=4 * np.finfo(float).eps)
    areas = np.linalg.norm(
        np.cross(
            cut.points[cut.faces[:, 1]] - cut.points[cut.faces[:, 0]],
            cut.points[cut.faces[:, 2]] - cut.points[cut.faces[:, 0]],
        ),
        axis=1,
    )
    sums = np.bincount(cut.source, areas, minlength=len(faces))
    sides = points[faces]
    whole = np.linalg.norm(np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]), axis=1)
    assert np.allclose(sums, whole, rtol=1e-9, atol=1e-12)


def soup(seed: int) -> tuple[Any, Any]:
    rng = np.random.default_rng(seed)
    if seed % 2:
        return rng.random((24, 3)), np.arange(24).reshape(-1, 3)
    # On a lattice, most contacts are degenerate: common planes, edges on edges, vertices on edges.
    lattice = np.stack(np.meshgrid(*[np.arange(3.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    faces = rng.integers(0, 27, (12, 3))
    sides = lattice[faces]
    normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    return lattice, faces[(normals != 0).any(axis=1)]


@pytest.mark.parametrize("rotated", [False, True])
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.sampled(3)
def test_any_faces_are_cut_at_each_other(seed: int, rotated: bool) -> None:
    points, faces = soup(seed)
    if rotated:
        points = points @ AXES.T
    check(points, faces, delone.imprint_surface(points, faces))


@pytest.mark.parametrize("rotated", [False, True])
def test_bodies_keep_their_volumes_and_regions(rotated: bool) -> None:
    bodies = [
        box((0, 0, 0), (2, 2, 2)),
        box((0.25, 0.5, 2), (1, 1.5, 3)),
        box((1, 1, 1), (3, 3, 2.5)),
    ]
    points, faces = joined(*bodies)
    body = np.repeat(np.arange(3), [len(own) for _, own in bodies])
    points = np.asarray(points, dtype=float) @ (AXES.T if rotated else np.eye(3))
    faces = np.asarray(faces)
    cut = delone.imprint_surface(points, faces)
    check(points, faces, cut)
    for i in range(3):
        before = volume(points, faces[body == i])
        after = volume(cut.points, cut.faces[body[cut.source] == i])
        assert abs(before - after) <= (1e-13 if rotated else 0)
    mesh = delone.tetrahedralize(points, faces, imprint=True, face_markers=body)
    assert mesh.validate()
    volumes = sorted(float(mesh.volumes[mesh.region == r].sum()) for r in np.unique(mesh.region))
    # The overlap of the first and the third box is a region of its own.
    assert np.allclose(volumes, [0.75, 1.0, 5.0, 7.0])
    report = mesh.report
    assert isinstance(report, delone.RecoveryReport)
    assert report.imprint_distance == cut.largest_distance
    assert report.imprinted.tolist() == cut.source.tolist()
    assert (mesh.face_markers == body[report.imprinted[mesh.face_source]]).all()
    assert "faces cut at each other" in str(report)


def test_the_report_of_an_imprint_is_saved(tmp_path: Any) -> None:
    points, faces = joined(box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 3)))
    mesh = delone.tetrahedralize(np.asarray(points) @ AXES.T, faces, imprint=True)
    mesh.save(tmp_path / "mesh.npz")
    again = delone.TetMesh.load(tmp_path / "mesh.npz").report
    assert isinstance(again, delone.RecoveryReport)
    assert again.imprint_distance == mesh.report.imprint_distance > 0
    assert again.imprinted.tolist() == mesh.report.imprinted.tolist()


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_rows_and_threads_do_not_matter(seed: int) -> None:
    points, faces = soup(seed)
    points = points @ AXES.T
    rng = np.random.default_rng(seed)
    rows, order = rng.permutation(len(points)), rng.permutation(len(faces))
    place = np.argsort(rows)
    first = delone.imprint_surface(points, faces, workers=1)
    mixed = delone.imprint_surface(points[rows], np.roll(place[faces][order], 1, axis=1), workers=3)

    def parts(cut: delone.ImprintedSurface, source: Any) -> list[Any]:
        corners = [sorted(map(tuple, cut.points[face].tolist())) for face in cut.faces]
        return sorted(zip(source[cut.source].tolist(), corners, strict=True))

    assert parts(first, np.arange(len(faces))) == parts(mixed, order)


def test_spheres_that_cross_enclose_three_regions() -> None:
    points, faces = map(np.asarray, sphere(3))
    both = np.concatenate((points, points * 0.8 + (0.7, 0.2, 0.1)))
    cut = delone.imprint_surface(both, np.concatenate((faces, faces + len(points))))
    found = delone.check_surface(cut.points, cut.faces)
    assert found.npairs == 0 and found.nregions == 3 and found.closed and found.oriented
    assert cut.rounds == 1 and cut.largest_distance < 1e-15


@pytest.mark.parametrize("step", [2, 45, 100])
def test_bodies_that_do_not_fit_need_a_tolerance(step: int) -> None:
    """In files with few digits, contact faces cross each other at very small angles."""
    a, b = 0.01 * step, 0.02 * step + 0.3
    about_z = np.array([(math.cos(a), -math.sin(a), 0), (math.sin(a), math.cos(a), 0), (0, 0, 1)])
    about_x = np.array([(1, 0, 0), (0, math.cos(b), -math.sin(b)), (0, math.sin(b), math.cos(b))])
    bodies = [
        box((0, 0, 0), (2, 2, 2)),
        box((0.3, 0.7, 2), (1.1, 1.3, 3)),
        box((1, 0, 2), (3, 3, 2.5)),
    ]
    points, faces = joined(*bodies)
    points = np.round(np.asarray(points, dtype=float) @ (about_z @ about_x).T, 8)
    with pytest.raises(delone.CrossingFacesError, match="give a larger tolerance") as caught:
        delone.imprint_surface(points, faces)
    assert caught.value.pairs.shape == (caught.value.count, 2)
    assert 0 <= caught.value.pairs.min() <= caught.value.pairs.max() < len(faces)
    cut = delone.imprint_surface(points, faces, tolerance=1e-7)
    assert 1e-9 < cut.largest_distance < 1e-8
    found = delone.check_surface(cut.points, cut.faces)
    assert found.npairs == 0 and found.nregions == 4 and found.closed


def test_parts_of_closed_bodies_are_closed_or_an_error() -> None:
    """Where the tolerance is about the misfit, vertices are joined with edges and faces at will."""
    bodies = [
        box((0, 0, 0), (2, 2, 2)),
        box((0.3, 0.7, 2), (1.1, 1.3, 3)),
        box((1, 0, 2), (3, 3, 2.5)),
    ]
    points, faces = joined(*bodies)
    points = np.asarray(points, dtype=float) @ AXES.T
    refused = 0
    for seed in (0, 15, 77, 113):
        noise = np.random.default_rng(seed).uniform(-2e-3, 2e-3, points.shape)
        rounded = np.round(points + noise, 6)
        try:
            cut = delone.imprint_surface(rounded, faces, tolerance=3e-3)
        except delone.CrossingFacesError as error:
            refused += 1
            assert "without a partner" in str(error) or "still cross" in str(error)
        else:
            found = delone.check_surface(cut.points, cut.faces)
            assert found.closed and found.oriented and found.npairs == 0
    assert refused


def test_a_tolerance_closes_gaps_and_lists_what_it_joins() -> None:
    lower, upper = box((0, 0, 0), (1, 1, 1)), box((0.25, 0.25, 1 + 1e-7), (0.75, 0.75, 2))
    points, faces = joined(lower, upper)
    points, faces = np.asarray(points, dtype=float), np.asarray(faces)
    assert len(delone.imprint_surface(points, faces).faces) == 24
    cut = delone.imprint_surface(points, faces, tolerance=1e-6)
    assert delone.check_surface(cut.points, cut.faces).nregions == 2
    assert cut.largest_distance == pytest.approx(1e-7)
    assert cut.subdivided.tolist() == [2, 3] and len(cut.merged) == 0
    # A point near another one, and a face that is thinner than the tolerance.
    near = np.concatenate((points, [(1, 1, 1 + 1e-8), (0.5, 0.5, 0), (0.5, 0.6, 0), (0.5, 0.7, 0)]))
    more = np.concatenate((faces, [(16, 6, 5), (17, 18, 19)]))
    cut = delone.imprint_surface(near, more, tolerance=1e-6)
    assert cut.merged.tolist() == [[16, 7]] or cut.merged[0, 0] in (7, 16)
    assert cut.collapsed.tolist() == [25]
    assert "1 input face without a part" in str(cut)


def test_nothing_is_cut_where_nothing_is_near() -> None:
    points, faces = joined(box((0, 0, 0), (1, 1, 1)), box((2, 0, 0), (3, 1, 1)))
    cut = delone.imprint_surface(points, faces)
    assert cut.rounds == cut.nadded == 0 and cut.source.tolist() == list(range(24))

    def turned(rows: Any) -> list[Any]:
        return [np.roll(face, -int(np.argmin(face))).tolist() for face in np.asarray(rows)]

    assert turned(cut.faces) == turned(faces)
    empty = delone.imprint_surface(np.empty((0, 3)), np.empty((0, 3), dtype=int))
    assert len(empty.faces) == 0


@pytest.mark.parametrize("power", [-900, 900])
def test_a_power_of_two_scales_the_result(power: int) -> None:
    points, faces = soup(1)
    cut = delone.imprint_surface(points, faces)
    scaled = delone.imprint_surface(np.ldexp(points, power), faces)
    assert (scaled.faces == cut.faces).all()
    assert (scaled.points == np.ldexp(cut.points, power)).all()


@pytest.mark.parametrize("tolerance", [-1.0, math.nan, math.inf])
def test_a_tolerance_is_a_distance(tolerance: float) -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    with pytest.raises(delone.InputError, match="tolerance must be at least 0 and finite"):
        delone.imprint_surface(points, faces, tolerance=tolerance)


def test_a_tolerance_that_leaves_no_face_is_refused() -> None:
    points, faces = box((0, 0, 0), (3, 2, 1))
    with pytest.raises(delone.InputError, match=r"tolerance=50 leaves no face .* extends over 3"):
        delone.tetrahedralize(points, faces, imprint=True, tolerance=50)
    empty = delone.imprint_surface(points, faces[:0])
    assert len(empty.faces) == 0


def test_a_tolerance_needs_an_imprint() -> None:
    points, faces = box((0, 0, 0), (1, 1, 1))
    with pytest.raises(delone.InputError, match="tolerance is for imprint=True"):
        delone.tetrahedralize(points, faces, tolerance=1e-6)
    with pytest.raises(delone.DtypeError, match="imprint"):
        delone.tetrahedralize(points, faces, imprint="yes")  # type: ignore[arg-type]


@pytest.mark.parametrize("low", [-1, 0])
def test_the_line_along_which_faces_meet_is_kept_whole(low: int) -> None:
    """Points on both sides of it are nearer to each other than to its ends."""
    flat = [(-9, -8, 0), (9, -8, 0), (0, 9, 0)]
    # It crosses the first one, or lies on it.
    other = [(-3, 0, low), (3, 0, low), (0, -2 * low - 2, -2 * low)]
    needles = [
        [(x, y, -1), (x + 0.01, y, -1), (x, y, 1)] for x in (-0.5, 0.0, 0.5) for y in (-0.05, 0.05)
    ]
    points = np.array([flat, other, *needles]).reshape(-1, 3) @ AXES.T
    faces = np.arange(len(points)).reshape(-1, 3)
    cut = delone.imprint_surface(points, faces)
    check(points, faces, cut)
    assert cut.rounds == 1


def test_a_vertex_near_an_edge_of_a_face_with_a_common_vertex_is_on_it() -> None:
    """The other end of that edge is farther away than the tolerance."""
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (100, -0.05, 0), (50, -50, 0)]
    faces = [(0, 1, 2), (0, 4, 3)]
    cut = delone.imprint_surface(points, faces, tolerance=1e-3)
    assert cut.subdivided.tolist() == [1]
    assert cut.largest_distance == pytest.approx(0.0005, rel=1e-3)
    assert len(delone.imprint_surface(points, faces).faces) == 2


def test_lines_on_all_of_many_faces_are_kept_whole() -> None:
    flat, other = [(-9, -8, 0), (9, -8, 0), (0, 9, 0)], [(-3, 0, -1), (3, 0, -1), (0, 0, 2)]
    needles = [[(0.1, y, -1), (0.11, y, -1), (0.1, y, 1)] for y in (-0.05, 0.05)]
    one = np.array([flat, other, *needles]).reshape(-1, 3)
    many = np.concatenate(
        [one + np.array((20 * i, 20 * j, 0)) for i in range(20) for j in range(10)]
    )
    faces = np.arange(len(many)).reshape(-1, 3)
    cut = delone.imprint_surface(many, faces, workers=2)
    assert cut.rounds == 1 and len(cut.merged) == 0
    own = delone.imprint_surface(one, faces[:4])
    assert len(cut.faces) == 200 * len(own.faces) and cut.nadded == 200 * own.nadded
