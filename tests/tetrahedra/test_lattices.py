"""Unions of boxes on a lattice, where everything is coplanar, against the count of their cells."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import solids
from delone import check_surface, improve, tetrahedralize

if TYPE_CHECKING:
    from solids import Surface

    Cells = np.ndarray[Any, Any]


def voxels(seed: int) -> Cells:
    """The corners of random cells of a lattice, at least one."""
    rng = np.random.default_rng(seed)
    chosen = rng.random((3, 3, 3)) < rng.uniform(0.2, 0.9)
    chosen[1, 1, 1] |= not chosen.any()
    return np.argwhere(chosen)


def cubes(corners: Cells) -> Surface:
    return solids.joined(*(solids.box(low, low + 1.0) for low in corners))


def hull_of(corners: Cells) -> Surface:
    """The faces of cubes between a chosen cell and one that is not, with common points."""
    points, faces = cubes(corners)
    keep = np.ones(len(faces), dtype=bool)
    seen: dict[Any, int] = {}
    for row, face in enumerate(points[faces].tolist()):
        other = seen.setdefault(tuple(sorted(map(tuple, face))), row)
        if other != row:
            keep[[row, other]] = False
    return points, faces[keep]


def octree(seed: int) -> tuple[Surface, float]:
    """Cubes of two sizes next to each other, and their volume: many T-junctions and overlaps."""
    rng = np.random.default_rng(seed)
    parts, volume = [solids.box((0, 0, 0), (2, 2, 2))], 8.0
    for low in product((0, 2), repeat=3):
        kind = rng.integers(3)
        if kind == 0 and any(low):
            parts.append(solids.box(low, np.add(low, 2)))
            volume += 8
        elif kind == 1 and any(low):
            for step in product((0, 1), repeat=3):
                if rng.random() < 0.5:
                    parts.append(solids.box(np.add(low, step), np.add(low, step) + 1))
                    volume += 1
    return solids.joined(*parts), volume


@pytest.mark.parametrize("inside", ["winding", "parity", "enclosed"])
@pytest.mark.parametrize("seed", range(6))
def test_cubes_with_double_walls(seed: int, inside: str) -> None:
    corners = voxels(seed)
    mesh = tetrahedralize(*cubes(corners), inside=inside)
    full = len(corners)
    if inside == "enclosed":
        # Cavities of the lattice of 27 cells: the middle one alone can be enclosed.
        middle = (corners == 1).all(axis=1).any()
        around = (np.abs(corners - 1).sum(axis=1) == 1).sum()
        full += int(not middle and around == 6)
    assert solids.filled(mesh.points, mesh.simplices) == full
    assert mesh.region.max() + 1 == full
    assert bool(mesh.validate())


@pytest.mark.parametrize("seed", range(6))
def test_boundary_of_cubes(seed: int) -> None:
    """Edges of four faces, vertices of several fans."""
    corners = voxels(seed)
    points, faces = hull_of(corners)
    for rule in ("winding", "parity"):
        mesh = tetrahedralize(points, faces, inside=rule)
        assert solids.filled(mesh.points, mesh.simplices) == len(corners)
    rng = np.random.default_rng(seed)
    turned = np.where(rng.random(len(faces))[:, None] < 0.5, faces[:, ::-1], faces)
    mesh = tetrahedralize(points, turned, inside="parity")
    assert solids.filled(mesh.points, mesh.simplices) == len(corners)
    reversed_ = tetrahedralize(points, faces[:, ::-1])
    assert solids.filled(mesh.points, reversed_.simplices) == len(corners)


@pytest.mark.parametrize("inside", ["winding", "parity"])
@pytest.mark.parametrize("seed", range(8))
def test_cubes_of_two_sizes(seed: int, inside: str) -> None:
    (points, faces), volume = octree(seed)
    check = check_surface(points, faces)
    assert check
    mesh = tetrahedralize(points, faces, inside=inside, face_markers=np.arange(len(faces)))
    assert solids.filled(mesh.points, mesh.simplices) == volume
    assert bool(mesh.validate())
    assert np.array_equal(mesh.face_markers, mesh.face_source)
    # Each part is in its face: same plane, same orientation.
    for face, source in zip(mesh.input_faces, mesh.face_source, strict=True):
        a, b, c = points[faces[source]]
        d, e, f = mesh.points[face]
        one, other = np.cross(b - a, c - a), np.cross(e - d, f - d)
        assert np.dot(one, d - a) == 0
        assert np.dot(one, other) > 0
        assert not np.cross(one, other).any()


@pytest.mark.parametrize("seed", range(8))
def test_shell_in_a_box_that_touches_its_walls(seed: int) -> None:
    """A void that is flush with a wall: the faces there are opposite, and count as none."""
    rng = np.random.default_rng(seed)
    low = rng.integers(0, 2, 3)
    outer, (places, rows) = solids.box((0, 0, 0), (2, 2, 2)), solids.box(low, low + 1.0)
    points, faces = solids.joined(outer, (places, rows[:, ::-1]))
    mesh = tetrahedralize(points, faces)
    assert solids.filled(mesh.points, mesh.simplices) == 7
    parity = tetrahedralize(points, faces, inside="parity")
    assert solids.filled(parity.points, parity.simplices) == 7
    # With normals outward both are solid.
    both = tetrahedralize(*solids.joined(outer, (places, rows)))
    assert solids.filled(both.points, both.simplices) == 8


@pytest.mark.parametrize("seed", range(3))
def test_improved_meshes_keep_everything(seed: int) -> None:
    (points, faces), volume = octree(seed)
    rng = np.random.default_rng(seed)
    mesh = tetrahedralize(points, faces)
    inner = mesh.points[mesh.simplices].mean(axis=1)
    mesh = tetrahedralize(points, faces, extra_points=inner[rng.random(len(inner)) < 0.2])
    better = improve(mesh, min_angle=25)
    assert bool(better.validate()), str(better.validate())
    assert solids.filled(better.points, better.simplices) == volume
    assert np.array_equal(np.unique(better.region), np.unique(mesh.region))
