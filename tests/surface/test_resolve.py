"""Subdivision of faces where they touch: conforming, covering the same, from the same vertices."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import delone
from rational import exact
from surfaces import box, brute_pairs, joined, normal, sphere

TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


def soup(seed: int) -> tuple[Any, Any]:
    """Triangles on a lattice that touch in many ways, without those that cross."""
    rng = np.random.default_rng(seed)
    shape = [(3, 3, 2), (5, 5, 1), (4, 3, 2)][seed % 3]
    lattice = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    points = lattice.reshape(-1, 3) @ (np.eye(3) + rng.integers(-2, 3, (3, 3)) / 4)
    kept: list[Any] = []
    for face in rng.integers(0, len(points), (40, 3)):
        found = brute_pairs(points, [*kept, face])
        if not any(crossing for _, crossing in found.values()):
            kept.append(face)
    return points, np.array(kept)


@pytest.mark.parametrize("seed", range(15))
@pytest.mark.sampled(3)
def test_parts_conform_and_cover_their_sources(seed: int) -> None:
    points, faces = soup(seed)
    parts, source = delone.resolve_touches(points, faces)
    assert brute_pairs(points, parts) == {}
    assert len({frozenset(part) for part in parts.tolist()}) == len(parts)
    assert (np.diff(source) >= 0).all()
    normals = [normal([exact(points)[v] for v in face]) for face in faces.tolist()]
    rows = exact(points)
    covered: Counter[int] = Counter()
    for part, row in zip(parts.tolist(), source.tolist(), strict=True):
        own = normal([rows[v] for v in part])
        # Parallel, and in the same direction: a positive multiple.
        k = next(k for k in range(3) if normals[row][k])
        share = own[k] / normals[row][k]
        assert share > 0 and own == tuple(share * x for x in normals[row])
        covered[row] += share
    alone = set(range(len(faces))) - set(np.unique(delone.check_surface(points, faces).pairs))
    for row in alone & set(covered):
        assert covered[row] == 1
    # What overlaps is there once: every source is covered by parts of rows up to its own.
    assert all(0 < share <= Fraction(1) for share in covered.values())
    again, same = delone.resolve_touches(points, parts)
    assert again.tolist() == parts.tolist() and same.tolist() == list(range(len(parts)))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.sampled(3)
def test_the_parts_do_not_depend_on_order_or_workers(seed: int) -> None:
    points, faces = soup(seed)
    rng = np.random.default_rng(seed)
    rows, order = rng.permutation(len(points)), rng.permutation(len(faces))
    moved = np.argsort(rows)

    def shapes(points: Any, parts: Any) -> set[frozenset[tuple[float, ...]]]:
        return {frozenset(map(tuple, points[part].tolist())) for part in parts}

    first, _ = delone.resolve_touches(points, faces, workers=1)
    mixed, _ = delone.resolve_touches(points[rows], moved[faces][order], workers=3)
    assert shapes(points, first) == shapes(points[rows], mixed)


def test_a_t_junction_is_closed() -> None:
    points, faces = box((0, 0, 0), (2, 2, 2))
    points = np.concatenate((points, [[1.0, 0, 0]]))
    # One of the two triangles at the edge from 0 to 1 has the vertex in the middle.
    split = np.concatenate(
        (faces[faces.tolist().index([0, 1, 4]) != np.arange(12)], [(0, 8, 4), (8, 1, 4)])
    )
    check = delone.check_surface(points, split)
    assert check.counts["vertex on edge"] == check.npairs == 2
    assert check and check.closed and check.manifold and check.volume == 8
    parts, source = delone.resolve_touches(points, split)
    assert len(parts) == 14 and Counter(source.tolist()).most_common(1)[0][1] == 2
    # A triangle with collinear corners in the gap changes nothing.
    gap = np.concatenate((split, [(0, 8, 1)]))
    check = delone.check_surface(points, gap)
    assert check.collinear.tolist() == [13] and check and check.component[13] == -1
    assert delone.resolve_touches(points, gap)[0].tolist() == parts.tolist()


def test_shared_walls_and_duplicates_remain_once() -> None:
    two = joined(box((0, 0, 0), (1, 1, 1)), box((1, 0, 0), (2, 1, 1)))
    check = delone.check_surface(*two)
    assert len(check.duplicate_points) == 4
    assert check.npairs == 0 and check.duplicate_faces[:, 1].tolist() == [10, 11]
    assert (check.nregions, check.volume, check.oriented) == (2, 2, True)
    parts, _ = delone.resolve_touches(*two)
    assert brute_pairs(two[0], parts) == {}


def test_overlapping_walls_are_there_once() -> None:
    # Four boxes of one size on a larger one, around its center: all corners are vertices.
    points, faces = box((0, 0, 0), (2, 2, 1))
    top = np.array([(1.0, 1, 1)])
    lid = [(4, 5, 8), (5, 7, 8), (7, 6, 8), (6, 4, 8)]
    sides = [face for face in faces.tolist() if not set(face) <= {4, 5, 6, 7}]
    spire = [(1, 1, 1), (2, 2, 1), (1, 2, 1), (1, 2, 3)], TETRAHEDRON
    both = joined((np.concatenate((points, top)), [*sides, *lid]), spire)
    check = delone.check_surface(*both)
    assert not check.ncrossing and check.counts["coplanar overlap"] + check.counts["folded"]
    assert check and (check.nregions, check.volume, check.oriented) == (2, 4 + 1 / 3, True)
    parts, _ = delone.resolve_touches(*both)
    assert brute_pairs(both[0], parts) == {}


def test_faces_that_cross_are_refused() -> None:
    both = joined(box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 3)))
    with pytest.raises(delone.CrossingFacesError) as caught:
        delone.resolve_touches(*both)
    check = delone.check_surface(*both)
    assert caught.value.pairs.tolist() == check.pairs[check.crossing].tolist()


def test_many_vertices_on_one_face() -> None:
    points, faces = sphere(3)
    # All vertices of one row of needles stand on one large triangle below.
    rng = np.random.default_rng(5)
    feet = np.column_stack((rng.integers(1, 40, (900, 2)), np.zeros(900))).astype(float)
    tops = feet + np.array([0, 0, 1.0])
    sides = tops + np.array([0.25, 0, 0])
    corners = np.array([(-100.0, -100, 0), (300, -100, 0), (-100, 300, 0)])
    points = np.concatenate((corners, feet, tops, sides))
    rows = np.unique(feet, axis=0, return_index=True)[1]
    faces = np.concatenate(([(0, 1, 2)], np.stack((rows + 3, rows + 903, rows + 1803), axis=1)))
    parts, source = delone.resolve_touches(points, faces)
    floor = parts[source == 0]
    assert len(floor) == 2 * len(rows) + 1 and set(floor.ravel()) == {0, 1, 2, *(rows + 3)}
    assert not delone.check_surface(points, parts).npairs
