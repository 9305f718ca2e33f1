"""Regions so narrow that no double sees all faces around a point that is needed."""

from __future__ import annotations

import json
from collections import Counter
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import delone

if TYPE_CHECKING:
    from numpy.typing import NDArray

BARS = json.loads(
    (Path(__file__).parent / "files" / "narrow-bars.json").read_text(encoding="utf-8")
)


def volume(points: NDArray[np.float64], corners: NDArray[Any]) -> Fraction:
    """Six times the sum of the volumes of tetrahedra, each of which must be positive."""
    total = Fraction(0)
    for four in corners.tolist():
        a, b, c, d = ([Fraction(x) for x in points[v].tolist()] for v in four)
        p, q, r = ([x - y for x, y in zip(each, a, strict=True)] for each in (b, c, d))
        det = (
            p[0] * (q[1] * r[2] - q[2] * r[1])
            - p[1] * (q[0] * r[2] - q[2] * r[0])
            + p[2] * (q[0] * r[1] - q[1] * r[0])
        )
        assert det != 0
        total += abs(det)
    return total


def inside(points: NDArray[np.float64], faces: NDArray[Any]) -> Fraction:
    """Six times the volume that oriented faces enclose."""
    total = Fraction(0)
    for three in faces.tolist():
        p, q, r = ([Fraction(x) for x in points[v].tolist()] for v in three)
        total += (
            p[0] * (q[1] * r[2] - q[2] * r[1])
            - p[1] * (q[0] * r[2] - q[2] * r[0])
            + p[2] * (q[0] * r[1] - q[1] * r[0])
        )
    return abs(total)


def check(points: NDArray[np.float64], faces: NDArray[Any]) -> None:
    mesh = delone.tetrahedralize(points, faces)
    assert np.array_equal(mesh.points[: len(points)], points)
    assert volume(mesh.points, mesh.simplices) == inside(points, faces)
    ascending = np.sort(mesh.simplices, axis=1).tolist()
    triangles = Counter(each for four in ascending for each in combinations(four, 3))
    outer = sorted(each for each, count in triangles.items() if count == 1)
    assert outer == sorted(tuple(sorted(each)) for each in faces.tolist())


@pytest.mark.parametrize("number", range(len(BARS)))
@pytest.mark.parametrize("power", [0, -40, 300])
def test_bars_of_a_model(number: int, power: int) -> None:
    points = np.array(BARS[number]["points"]) * 2.0**power
    check(points, np.array(BARS[number]["faces"]))


def test_the_order_of_rows_does_not_matter() -> None:
    points, faces = np.array(BARS[0]["points"]), np.array(BARS[0]["faces"])
    rng = np.random.default_rng(3)
    counts = set()
    for _ in range(4):
        order = rng.permutation(len(points))
        place = np.argsort(order)
        moved = np.roll(place[faces[rng.permutation(len(faces))]], int(rng.integers(3)), axis=1)
        check(points[order], moved)
        counts.add(delone.tetrahedralize(points[order], moved).nsimplex)
    assert len(counts) == 1


def prism(seed: int, twist: float, length: float) -> tuple[NDArray[np.float64], NDArray[Any]]:
    """A prism twisted by almost 60 degrees, whose reflex edges almost meet in the middle."""
    rng = np.random.default_rng(seed)
    angles = np.arange(3) * 2 * np.pi / 3 + rng.uniform(0, 6)
    bottom = np.column_stack((np.cos(angles), np.sin(angles), np.zeros(3)))
    angles -= twist
    top = np.column_stack((np.cos(angles), np.sin(angles), np.full(3, length)))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn[:, 0] *= np.linalg.det(turn)
    faces = [(0, 2, 1), (3, 4, 5)]
    for i in range(3):
        j = (i + 1) % 3
        faces += [(i, j, 3 + i), (j, 3 + j, 3 + i)]
    return np.vstack((bottom, top)) @ turn.T + rng.uniform(-2e4, 2e4, 3), np.array(faces)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("length", [30.0, 300.0])
def test_prisms_with_a_gap_of_few_doubles(seed: int, length: float) -> None:
    points, faces = prism(seed, np.pi / 3 - 1e-12, length)
    report = delone.check_surface(points, faces)
    if len(report.pairs):
        # Rounded so that its edges cross: valid input only.
        with pytest.raises(delone.CrossingFacesError):
            delone.tetrahedralize(points, faces)
        return
    try:
        check(points, faces)
    except delone.CrowdedFacesError as error:
        assert set(error.faces.tolist()) <= set(range(len(faces)))
        assert length == 30
