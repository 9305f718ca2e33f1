"""Measures of tetrahedra, beside what is known of them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from delone import ConvexHull, Delaunay, improve
from delone._tiling.space.quality import dihedral_angles, measured
from delone.errors import DtypeError, InputError

REGULAR = np.array([(1.0, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
CORNER = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
ONE = np.array([(0, 1, 2, 3)], dtype=np.int32)
SWAPPED = np.array([(0, 2, 1, 3)], dtype=np.int32)


@pytest.mark.parametrize("scale", [1.0, 2.0**-340, 2.0**330, 3.0])
def test_the_regular_one_is_best(scale: float) -> None:
    quality = measured(REGULAR * scale, SWAPPED)
    best = np.degrees(np.arccos(1 / 3))
    assert quality.smallest_dihedral[0] == pytest.approx(best, rel=1e-14)
    assert quality.largest_dihedral[0] == pytest.approx(best, rel=1e-14)
    assert quality.radius_ratio[0] == pytest.approx(1, rel=1e-14)
    assert quality.edge_ratio[0] == pytest.approx(1, rel=1e-14)
    assert quality.volume[0] == pytest.approx(8 / 3 * scale**3, rel=1e-14)


def test_the_corner_of_a_cube() -> None:
    quality = measured(CORNER, ONE)
    assert quality.smallest_dihedral[0] == pytest.approx(np.degrees(np.arctan(np.sqrt(2))))
    assert quality.largest_dihedral[0] == 90
    assert quality.volume[0] == pytest.approx(1 / 6)
    inner, outer = 1 / (3 + np.sqrt(3)), np.sqrt(3) / 2
    assert quality.radius_ratio[0] == pytest.approx(3 * inner / outer)
    assert quality.edge_ratio[0] == pytest.approx(np.sqrt(2))


@pytest.mark.parametrize("height", [1e-3, 1e-8, 1e-14])
def test_slivers_have_angles_that_are_right(height: float) -> None:
    sliver = np.array([(0, 0, 0), (1, 0, height), (1, 1, 0), (0, 1, height)])
    quality = measured(sliver, ONE)
    # The faces have the normals (-h, h, 1), (-h, -h, 1), (h, -h, 1) and (h, h, 1). The cosine
    # between two is 1 / (1 + 2 h^2) across a side, and (1 - 2 h^2) times that across a diagonal.
    small = 2 * np.degrees(np.arctan(height / np.sqrt(1 + height**2)))
    large = 180 - 2 * np.degrees(np.arctan(np.sqrt(2) * height))
    assert quality.smallest_dihedral[0] == pytest.approx(small, rel=1e-12)
    assert quality.largest_dihedral[0] == pytest.approx(large, rel=1e-14)
    # Equal faces: the center of both spheres is that of the corners.
    inner, outer = height / 2 / np.sqrt(1 + 2 * height**2), np.sqrt(2 + height**2) / 2
    assert quality.radius_ratio[0] == pytest.approx(3 * inner / outer, rel=1e-12)
    assert quality.edge_ratio[0] == pytest.approx(np.sqrt(2 / (1 + height**2)), rel=1e-14)
    assert quality.volume[0] == pytest.approx(float(Fraction(height) / 3), rel=1e-14)


def test_six_angles_of_random_tetrahedra() -> None:
    rng = np.random.default_rng(3)
    points = rng.random((400, 3))
    simplices = np.arange(400, dtype=np.int32).reshape(-1, 4)
    corners = points[simplices]
    wrong = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    simplices[wrong] = simplices[wrong][:, [1, 0, 2, 3]]
    angles = dihedral_angles(points, simplices)
    for v, found in zip(points[simplices], angles, strict=True):
        pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
        for (i, j), angle in zip(pairs, found, strict=True):
            axis = (v[j] - v[i]) / np.linalg.norm(v[j] - v[i])
            u, w = (v[k] - v[i] for k in range(4) if k not in (i, j))
            u, w = (x - axis * (x @ axis) for x in (u, w))
            cosine = u @ w / np.linalg.norm(u) / np.linalg.norm(w)
            assert angle == pytest.approx(np.degrees(np.arccos(cosine)), abs=1e-5)


def test_the_summary_and_the_histogram_count_all() -> None:
    quality = measured(np.concatenate((CORNER, REGULAR)), np.array([(0, 1, 2, 3), (4, 6, 5, 7)]))
    counts, bounds = quality.histogram()
    assert counts.sum() == 2
    assert bounds[0] == 0
    assert bounds[-1] >= 70.53
    assert quality.summary()["volume"]["max"] == pytest.approx(8 / 3)
    assert str(quality).startswith("2 tetrahedra")
    with pytest.raises(ValueError, match="read-only"):
        quality.volume[0] = 1


@pytest.mark.parametrize("width", [0, -1, 1e-300, 1e-7, 180.5, np.inf, np.nan, "a", None, True])
def test_classes_have_a_width(width: Any) -> None:
    quality = measured(CORNER, ONE)
    with pytest.raises(
        InputError if isinstance(width, int | float) and width is not True else DtypeError,
        match="width",
    ):
        quality.histogram(width)


def test_classes_hold_all_whatever_their_width() -> None:
    quality = measured(REGULAR, SWAPPED)
    best = float(quality.smallest_dihedral[0])
    for width in (0.001, 5, 180, best, best / 3, np.nextafter(best, 0)):
        counts, bounds = quality.histogram(width)
        assert counts.sum() == 1
        assert len(bounds) == len(counts) + 1


def test_what_has_no_tetrahedra_is_refused() -> None:
    hull = ConvexHull(np.random.default_rng(0).random((20, 3)))
    with pytest.raises(DtypeError, match="ConvexHull"):
        improve(hull)


def test_a_summary_with_ratios_beyond_the_range_has_no_nan() -> None:
    """One edge is so short that the ratio of a tetrahedron overflows; others are plain."""
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1e-320), (1, 1, 1), (2, 3, 5)]
    quality = Delaunay(points).quality()
    assert np.isinf(quality.edge_ratio).any()
    assert np.isfinite(quality.edge_ratio).any()
    summary = quality.summary()
    for measure in summary.values():
        assert not any(np.isnan(value) for value in measure.values())
    assert summary["edge_ratio"]["max"] == summary["edge_ratio"]["p99"] == np.inf
    assert "nan" not in str(quality)
