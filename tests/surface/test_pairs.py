"""Pairs of faces that cross or touch, against brute force in fractions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone
from surfaces import box, brute_pairs, joined, sphere

if TYPE_CHECKING:
    from collections.abc import Iterator


def soups() -> Iterator[tuple[str, Any, Any]]:
    """Triangles on small lattices, where nearly everything is degenerate, and nearby."""
    for seed in range(40):
        rng = np.random.default_rng(seed)
        shape = [(3, 3, 3), (4, 4, 1), (5, 2, 2), (6, 6, 2)][seed % 4]
        lattice = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
        points = lattice.reshape(-1, 3).astype(float)
        faces = rng.integers(0, len(points), (24, 3))
        yield f"lattice-{seed}", points, faces
        tilt = rng.integers(-3, 4, (3, 3)) / 8 + np.eye(3)
        yield f"tilted-{seed}", points @ tilt, faces
        # Thirds round: what was coplanar is so by a hair, or not.
        yield f"rounded-{seed}", points / 3 @ tilt, faces


def found(check: delone.SurfaceCheck) -> dict[tuple[int, int], tuple[str, bool]]:
    rows = zip(check.pairs.tolist(), check.kinds.tolist(), check.crossing.tolist(), strict=True)
    return {(i, j): (kind, crossing) for (i, j), kind, crossing in rows}


@pytest.mark.parametrize(("points", "faces"), [pytest.param(*s[1:], id=s[0]) for s in soups()])
@pytest.mark.sampled(18)
def test_pairs_are_those_of_brute_force(points: Any, faces: Any) -> None:
    check = delone.check_surface(points, faces)
    assert found(check) == brute_pairs(points, faces)
    assert sum(check.counts.values()) == len(check.pairs)
    assert check.ncrossing == check.crossing.sum()


@pytest.mark.parametrize("seed", range(6))
def test_pairs_do_not_depend_on_order_scale_or_workers(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = rng.integers(0, 4, (40, 3)).astype(float)
    faces = rng.integers(0, 40, (60, 3))
    first = delone.check_surface(points, faces, workers=1)
    for scale in (2.0**-1060, 2.0**1000, 0.25):
        scaled = delone.check_surface(points * scale, faces, workers=3)
        assert found(scaled) == found(first)
    rows, order = rng.permutation(40), rng.permutation(60)
    moved = np.argsort(rows)
    turned = np.stack([np.roll(f, rng.integers(3)) for f in moved[faces][order]])
    mixed = delone.check_surface(points[rows], turned)
    renamed = {
        (min(order[i], order[j]), max(order[i], order[j])): kind
        for (i, j), kind in found(mixed).items()
    }
    # Of faces that repeat others, the first row is kept.
    twins = {row: min(row, other) for row, other in mixed.duplicate_faces[:, :2].tolist()}
    if not twins:
        assert renamed == found(first)
    assert mixed.counts == first.counts


def test_pairs_in_every_part_of_a_large_surface_are_found() -> None:
    points, faces = sphere(6)
    needles = np.arange(0, len(points), 97)
    tips = np.concatenate((points[needles] * 0.5, points[needles] * 1.5 + [0, 0, 1e-3]))
    k, n = len(needles), len(points)
    thin = np.stack((n + np.arange(k), n + k + np.arange(k), np.roll(n + np.arange(k), 1)), axis=1)
    both = np.concatenate((points, tips)), np.concatenate((faces, thin))
    one, two = (delone.check_surface(*both, workers=w) for w in (1, 4))
    assert found(one) == found(two)
    pierced = np.unique(one.pairs[one.pairs[:, 1] >= len(faces), 1])
    assert len(pierced) == k
    assert delone.check_surface(points, faces).npairs == 0


def test_the_limit_keeps_the_first_pairs_that_cross() -> None:
    surface = joined(*(box((i, i, i), (i + 2, i + 2, i + 2)) for i in range(12)))
    whole = delone.check_surface(*surface)
    few = delone.check_surface(*surface, limit=7)
    assert few.counts == whole.counts and few.ncrossing == whole.ncrossing > 7
    assert few.pairs.tolist() == whole.pairs[whole.crossing][:7].tolist()
    assert len(delone.check_surface(*surface, limit=None).pairs) == whole.npairs
    assert len(delone.check_surface(*surface, limit=0).pairs) == 0


def test_kinds_of_boxes() -> None:
    apart = delone.check_surface(*joined(box((0, 0, 0), (1, 1, 1)), box((2, 0, 0), (3, 1, 1))))
    assert apart.npairs == 0 and apart.nregions == 2 and apart.volume == 2
    inside = delone.check_surface(*joined(box((0, 0, 0), (3, 3, 3)), box((1, 1, 1), (2, 2, 2))))
    assert inside.npairs == 0 and inside.nregions == 2
    crossing = delone.check_surface(*joined(box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 3))))
    assert not crossing and crossing.ncrossing and crossing.nregions is None
    with pytest.raises(delone.CrossingFacesError) as caught:
        crossing.raise_if_bad()
    assert caught.value.count == crossing.ncrossing == len(caught.value.pairs)
    assert caught.value.kinds.tolist() == crossing.kinds[crossing.crossing].tolist()
