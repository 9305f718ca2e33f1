"""Faces that end inside a solid, where points at their free edges must be moved off them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
import solids
from delone import tetrahedralize
from delone.solids.tetrahedra.curtains import Curtains, free_faces

if TYPE_CHECKING:
    from delone._base.types import Floats, Indices

WIDE = solids.box((0, 0, 0), (4, 4, 4))


def sheet(random: np.random.Generator, middle: Any = (2, 2, 2)) -> tuple[Floats, Indices]:
    """Return a polygon in a random plane, as a fan of triangles."""
    turned = np.linalg.qr(random.normal(size=(3, 3)))[0]
    angles = np.linspace(0, 2 * np.pi, random.integers(4, 8), endpoint=False) + random.uniform()
    ring = middle + 0.6 * (
        np.cos(angles)[:, None] * turned[0] + np.sin(angles)[:, None] * turned[1]
    )
    return ring, np.array([(0, i, i + 1) for i in range(1, len(ring) - 1)])


def near(random: np.random.Generator, ring: Floats, count: int = 60) -> Floats:
    """Return points near the corners of a sheet, whose tetrahedra reach through its edges."""
    out = ring - ring.mean(axis=0)
    return np.concatenate(
        [
            ring
            + out * random.uniform(-0.2, 0.2, (len(ring), 1))
            + random.normal(0, 0.08, ring.shape)
            for _ in range(count)
        ]
    )


def with_sheet(random: np.random.Generator) -> tuple[Floats, Indices, Floats]:
    points, faces = WIDE
    ring, fan = sheet(random)
    return (
        np.concatenate((points, ring)),
        np.concatenate((faces, fan + len(points))),
        near(random, ring),
    )


def shape(mesh: delone.TetMesh) -> Any:
    corners = mesh.points[mesh.simplices]
    return sorted(tuple(sorted(map(tuple, row))) for row in corners.tolist())


@pytest.mark.parametrize("seed", range(12))
def test_sheets_among_points(seed: int) -> None:
    points, faces, extra = with_sheet(np.random.default_rng(seed))
    mesh = tetrahedralize(points, faces, extra_points=extra)
    assert bool(mesh.validate())
    assert sorted(map(sorted, mesh.input_faces.tolist())) == sorted(map(sorted, faces.tolist()))
    assert mesh.report.dangling.tolist() == list(range(12, len(faces)))
    assert not mesh.region.any()
    assert solids.filled(mesh.points, mesh.simplices) == solids.volume(*WIDE)
    # The given points come first, then the extra ones, then those that were added.
    count = len(points) + len(extra)
    assert len(mesh.points) == count + mesh.nadded and mesh.report.nadded == mesh.nadded
    assert (mesh.points[:count] == np.concatenate((points, extra))).all()


def test_temporary_faces_are_needed() -> None:
    """Most of these sheets cannot be recovered without."""
    added = 0
    for seed in range(12):
        points, faces, extra = with_sheet(np.random.default_rng(seed))
        added += tetrahedralize(points, faces, extra_points=extra).nadded > 0
    assert added >= 6


def test_order_scale_and_workers_change_nothing() -> None:
    random = np.random.default_rng(1)
    points, faces, extra = with_sheet(random)
    mesh = tetrahedralize(points, faces, extra_points=extra, workers=1)
    assert mesh.nadded
    # The faces of the sheet are turned and rotated, too.
    order, turn = random.permutation(len(points)), random.permutation(len(faces))
    other = np.argsort(order)[faces].astype(np.int32)
    other[12:] = other[12:, [2, 1, 0]]
    again = tetrahedralize(
        points[order], other[turn], extra_points=random.permutation(extra), workers=3
    )
    assert shape(again) == shape(mesh)
    larger = tetrahedralize(points * 2.0**20, faces, extra_points=extra * 2.0**20)
    assert (larger.points == mesh.points * 2.0**20).all()
    assert (larger.simplices == mesh.simplices).all()


def test_sheets_through_a_wall() -> None:
    """What is outside is left out, together with the temporary faces there."""
    needed = 0
    for seed in range(6):
        random = np.random.default_rng(seed)
        ring, fan = sheet(random, (4, 2, 2))
        points, faces = np.concatenate((WIDE[0], ring)), np.concatenate((WIDE[1], fan + 8))
        extra = near(random, ring)
        extra = extra[(extra[:, 0] < 3.99)]
        mesh = tetrahedralize(points, faces, imprint=True, extra_points=extra)
        assert bool(mesh.validate())
        assert len(mesh.report.outside) and len(mesh.report.dangling)
        assert (mesh.points[np.unique(mesh.simplices), 0] <= 4).all()
        assert mesh.quality().volume.sum() == pytest.approx(64, rel=1e-12)
        needed += mesh.nadded > 0
    assert needed


@pytest.mark.parametrize("angle", [1e-1, 1e-4, 1e-8, 1e-12])
def test_sheets_with_small_angles_between_them(angle: float) -> None:
    outer = [(2, 2 + np.cos(k * angle), 2 + np.sin(k * angle)) for k in range(4)]
    points = np.concatenate((WIDE[0], [(1, 2, 2), (3, 2, 2)], outer))
    faces = np.concatenate((WIDE[1], [(8, 9, 10 + k) for k in range(4)]))
    needed = 0
    for seed in range(4):
        extra = near(np.random.default_rng(seed), points[8:])
        mesh = tetrahedralize(points, faces, extra_points=extra)
        assert bool(mesh.validate())
        assert len(mesh.input_faces) == len(faces)
        assert solids.filled(mesh.points, mesh.simplices) == solids.volume(*WIDE)
        needed += mesh.nadded > 0
    assert needed


def test_apexes_avoid_points() -> None:
    """A point at the place of an apex, on the way to it, or in between is not covered."""
    points = np.concatenate((WIDE[0], [(1, 1, 2), (3, 1, 2), (2, 3, 2)]))
    faces = np.concatenate((WIDE[1], [(8, 9, 10)])).astype(np.int32)
    bases = free_faces(faces)
    assert bases.tolist() == [12]
    first = Curtains.on(points, faces, bases, 1)
    assert first is not None
    apex = first.apexes[0]
    for part in (0.0, 0.5, 0.999):
        inner = apex + part * (points[8:].mean(axis=0) - apex)
        every = np.concatenate((points, [inner, inner * [1, 1, -1] + [0, 0, 4]]))
        other = Curtains.on(every, faces, bases, 1)
        assert other is not None
        assert abs(other.apexes[0, 2] - 2) < abs(inner[2] - 2)


def test_temporary_faces_stand_for_their_bases() -> None:
    """Errors name given faces; three temporary ones are on each base."""
    corner = np.eye(3, 3, dtype=np.int32)
    curtains = Curtains(np.array([4, 9], dtype=np.int32), np.zeros((2, 3)), np.tile(corner, (2, 1)))
    rows = np.arange(8, 18, dtype=np.int32)
    assert curtains.given(rows, 12).tolist() == [8, 9, 10, 11, 4, 4, 4, 9, 9, 9]


def test_rounds_end_where_there_is_no_room(monkeypatch: pytest.MonkeyPatch) -> None:
    # Walls one unit in the last place above and below.
    points, faces = solids.box((0, 0, 1 - 2.0**-53), (4, 4, 1 + 2.0**-52))
    points = np.concatenate((points, [(1, 1, 1), (3, 1, 1), (2, 3, 1)]))
    rows = np.concatenate((faces, [(8, 9, 10)])).astype(np.int32)
    assert Curtains.on(points, rows, free_faces(rows), 1) is None
    monkeypatch.setattr(Curtains, "on", lambda *args: None)
    given, rows, extra = with_sheet(np.random.default_rng(1))
    with pytest.raises(delone.DanglingFacesError) as caught:
        tetrahedralize(given, rows, extra_points=extra)
    assert set(caught.value.faces.tolist()) <= set(range(12, len(rows)))


def test_the_limit_includes_apexes() -> None:
    """One sheet needs points, and each of many others would get an apex, too."""
    points, faces, extra = with_sheet(np.random.default_rng(1))
    corner = np.array([(0.1, 0.1, 0.1), (0.2, 0.1, 0.1), (0.1, 0.2, 0.1)])
    others = (corner + np.linspace(0, 3.5, 200)[:, None, None] * (0, 0, 1)).reshape(-1, 3)
    rows = len(points) + np.arange(len(others)).reshape(-1, 3)
    points, faces = np.concatenate((points, others)), np.concatenate((faces, rows))
    free = len(free_faces(faces.astype(np.int32)))
    with pytest.raises(delone.BudgetExceededError, match="faces that end inside") as caught:
        tetrahedralize(points, faces, extra_points=extra, max_points=free - 1)
    assert (caught.value.limit, caught.value.found) == (free - 1, free)
    mesh = tetrahedralize(points, faces, extra_points=extra)
    assert bool(mesh.validate()) and mesh.nadded >= free


@pytest.mark.parametrize("limit", [80, 100])
def test_limits_are_those_of_the_caller(limit: int) -> None:
    """The core gets what the apexes leave."""
    points, faces, extra = with_sheet(np.random.default_rng(0))
    with pytest.raises(delone.BudgetExceededError, match=f"max_points={limit}; bound") as caught:
        tetrahedralize(points, faces, extra_points=extra, max_points=limit)
    assert (caught.value.limit, caught.value.found) == (limit, limit + 1)


def test_regions_stay_apart() -> None:
    """A wall divides the box; the cells of its two sides remain two regions."""
    random = np.random.default_rng(1)
    points, faces, extra = with_sheet(random)
    wall = [(-1, -1, 3.5), (5, -1, 3.5), (5, 5, 3.5), (-1, 5, 3.5)]
    rows = len(points) + np.array([(0, 1, 2), (0, 2, 3)])
    mesh = tetrahedralize(
        np.concatenate((points, wall)),
        np.concatenate((faces, rows)),
        imprint=True,
        extra_points=extra,
    )
    assert mesh.nadded and bool(mesh.validate())
    volumes = [mesh.quality().volume[mesh.region == r].sum() for r in range(2)]
    assert sorted(volumes) == pytest.approx([8, 56], rel=1e-12)
    assert set(mesh.region.tolist()) == {0, 1}


def test_sheets_stay_in_refinement_and_improvement() -> None:
    points, faces, extra = with_sheet(np.random.default_rng(1))
    mesh = tetrahedralize(points, faces, extra_points=extra)
    assert mesh.nadded
    better = delone.improve(mesh, max_points=200)
    finer = tetrahedralize(points, faces, extra_points=extra, boundary="surface", size=0.8)
    for made in (better, finer):
        assert bool(made.validate())
        assert len(np.unique(made.face_source)) == len(faces)
    assert finer.report.recovery.dangling.tolist() == list(range(12, len(faces)))
