"""Sharp corners and other hard inputs: every run ends, and what is below the bound has a reason."""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import delone
from delone.testing import assert_mesh

THIRTY = Fraction(3, 4)


def loops(*rings: Any) -> tuple[np.ndarray, np.ndarray]:
    points = np.concatenate([np.asarray(ring, dtype=float) for ring in rings])
    ends = np.cumsum([0] + [len(ring) for ring in rings])
    segments = [
        (i, i + 1 if i + 1 < end else start)
        for start, end in pairwise(ends.tolist())
        for i in range(start, end)
    ]
    return points, np.array(segments)


def box(size: float = 10.0) -> np.ndarray:
    return np.array([(-size, -size), (size, -size), (size, size), (-size, size)])


def corner_in_a_box(degrees: float) -> tuple[np.ndarray, np.ndarray]:
    """Two segments that meet at a small angle, inside a square."""
    a = math.radians(degrees)
    points, segments = loops(box())
    more = [(0, 0), (5, 0), (5 * math.cos(a), 5 * math.sin(a))]
    return np.concatenate((points, more)), np.concatenate((segments, [(4, 5), (4, 6)]))


def fan(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Needles around one vertex, in a box."""
    points, segments = loops(box())
    angle = np.arange(count) * 2 * np.pi / count + 0.1
    tips = 5 * np.column_stack((np.cos(angle), np.sin(angle)))
    rays = [(4, 5 + i) for i in range(count)]
    return np.concatenate((points, [(0, 0)], tips)), np.concatenate((segments, rays))


def narrow_fan(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Thirty needles within thirty degrees, of different lengths."""
    points, segments = loops(box())
    angle = np.radians(np.arange(count))
    length = 3 + 4 * ((np.arange(count) * 7) % count) / count
    tips = np.column_stack((length * np.cos(angle), length * np.sin(angle)))
    rays = [(4, 5 + i) for i in range(count)]
    return np.concatenate((points, [(0, 0)], tips)), np.concatenate((segments, rays))


def spiral(turns: int = 4, count: int = 120) -> tuple[np.ndarray, np.ndarray]:
    t = np.linspace(1, turns, count) * 2 * np.pi
    inner = np.column_stack((t * np.cos(t), t * np.sin(t)))
    outer = 1.07 * inner[::-1]
    return loops(np.concatenate((inner, outer)))


def double_hexagon(gap: float) -> tuple[np.ndarray, np.ndarray]:
    angle = np.arange(6) * np.pi / 3
    unit = np.column_stack((np.cos(angle), np.sin(angle)))
    return loops(unit, unit * (1 - gap))


def letter_a() -> tuple[np.ndarray, np.ndarray]:
    outer = [(0, 0), (3, 8), (4, 8), (7, 0), (5.8, 0), (4.9, 2.4), (2.1, 2.4), (1.2, 0)]
    inner = [(2.55, 3.6), (4.45, 3.6), (3.5, 6.2)]
    return loops(outer, inner)


def parallel_lines(gap: float) -> tuple[np.ndarray, np.ndarray]:
    points, segments = loops(box(2.0))
    lines = [(-0.5, 0), (0.5, 0), (-0.5, gap), (0.5, gap)]
    return np.concatenate((points, lines)), np.concatenate((segments, [(4, 5), (6, 7)]))


CASES: dict[str, tuple[np.ndarray, np.ndarray]] = {
    "corner of 1 degree": corner_in_a_box(1),
    "corner of 0.001 degrees": corner_in_a_box(0.001),
    "corner of 20 degrees": corner_in_a_box(20),
    "corner of 59 degrees": corner_in_a_box(59),
    "fan of 30": fan(30),
    "narrow fan of 30": narrow_fan(30),
    "fan of 7": fan(7),
    "spiral": spiral(),
    "double hexagon": double_hexagon(0.1),
    "thin double hexagon": double_hexagon(1e-3),
    "letter": letter_a(),
    "needle": loops([(0, 0), (10, 0), (10, 1e-3)]),
    "two needles": loops([(0, 0), (10, 0.1), (10, 1), (0, 0.05), (-10, 1), (-10, 0.1)]),
    "comb": loops(
        [(x, y) for i in range(10) for x, y in ((i, 0.2 * (i % 2)), (i + 0.5, 5))]
        + [(10, -1), (0, -1)]
    ),
}


def judged(name: str, domain: tuple[np.ndarray, np.ndarray], **options: Any) -> delone.Mesh:
    mesh = delone.mesh(domain, max_points=300_000, **options)
    report = mesh.report
    assert not report.exhausted, name
    assert_mesh(mesh, *domain, squared_cosine=THIRTY, spoilt=report.below)
    # Each triangle below the bound is spoilt by a corner of the input, which its report names.
    assert set(report.cause.tolist()) <= {"corner"}, (name, str(report))
    assert (mesh.point_source[report.corner] >= 0).all()
    return mesh


@pytest.mark.parametrize("name", CASES)
def test_hard_inputs_end(name: str) -> None:
    mesh = judged(name, CASES[name])
    assert mesh.nsimplex < 40_000


@pytest.mark.parametrize("name", ["fan of 30", "letter", "corner of 1 degree", "double hexagon"])
def test_hard_inputs_end_with_small_areas(name: str) -> None:
    domain = CASES[name]
    area = float(np.ptp(domain[0], axis=0).prod()) / 3000
    mesh = judged(name, domain, max_area=area)
    assert mesh.areas.max() <= area


def test_angles_of_the_input_are_named() -> None:
    domain = corner_in_a_box(1)
    mesh = delone.mesh(domain)
    report = mesh.report
    assert set(mesh.point_source[report.corner].tolist()) == {4}
    # Between the two segments the angle is that of the input.
    assert report.smallest_angle == pytest.approx(1, abs=1e-6)
    # No other triangle has more than what the rule leaves: two angles of 90 - 1/2 degrees.
    assert report.largest_angle < 121


@pytest.mark.parametrize("gap", [1e-3, 1e-6, 1e-9, 1e-12])
def test_parallel_lines_end_or_are_left_as_a_needle(gap: float) -> None:
    """Angles between lines so near to each other need pieces as short as the gap."""
    mesh = delone.mesh(parallel_lines(gap), max_points=20_000)
    report = mesh.report
    assert_mesh(mesh, *parallel_lines(gap), spoilt=report.below)
    assert not report.exhausted
    if gap <= 1e-6:
        assert set(report.cause.tolist()) == {"needle"}
        assert len(report.needles) == 1
    else:
        assert report.ok


def test_short_parallel_lines() -> None:
    points, segments = loops(box(2.0))
    lines = np.array([(0, 0), (1e-11, 0), (0, 1e-12), (1e-11, 1e-12)])
    domain = np.concatenate((points, lines)), np.concatenate((segments, [(4, 5), (6, 7)]))
    mesh = judged("short", domain)
    assert mesh.report.ok


def test_neighbouring_doubles_end() -> None:
    """Where doubles are too coarse, triangles stay as they are."""
    step = math.ulp(1.0)
    ring = [(1, 1), (1 + 8 * step, 1), (1 + 8 * step, 1 + 3 * step), (1 + step, 1 + 5 * step)]
    mesh = delone.mesh(loops(ring), max_points=10_000)
    assert mesh.nsimplex >= 2
    assert not mesh.report.exhausted


@pytest.mark.parametrize("scale", [1e-150, 1e-8, 1e8, 1e150])
def test_scales_of_powers_of_two(scale: float) -> None:
    points, segments = letter_a()
    factor = 2.0 ** round(math.log2(scale))
    plain, scaled = delone.mesh((points, segments)), delone.mesh((points * factor, segments))
    assert set(scaled.report.cause.tolist()) <= {"corner"}
    assert_mesh(
        scaled, points * factor, segments, squared_cosine=THIRTY, spoilt=scaled.report.below
    )
    assert abs(scaled.npoints - plain.npoints) < 10


def test_random_segments_in_a_square() -> None:
    for seed in range(6):
        rng = np.random.default_rng(seed)
        points, segments = loops(box(1.0))
        starts = rng.uniform(-0.9, 0.9, (12, 2))
        ends = starts + rng.uniform(-0.3, 0.3, (12, 2)).clip(-0.95, 0.95)
        ends = ends.clip(-0.95, 0.95)
        more = np.column_stack((starts, ends)).reshape(-1, 2)
        pairs = np.arange(24).reshape(-1, 2) + 4
        domain = np.concatenate((points, more)), np.concatenate((segments, pairs))
        base = delone.ConstrainedDelaunay(*domain, crossing="split")
        mesh = delone.mesh(base, max_points=200_000)
        assert not mesh.report.exhausted
        assert set(mesh.report.cause.tolist()) <= {"corner"}
