"""Longitudes and latitudes as vectors, against sines by integers."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

import directions as oracle
from delone import _core, sphere
from delone.errors import DirectionError

BITS = 300
ONE = 1 << BITS


@cache
def pi():
    """Machin's formula."""

    def inverse(n):
        total = term = ONE // n
        k = 1
        while term:
            term //= -n * n
            k += 2
            total += term // k
        return total

    return 4 * (4 * inverse(5) - inverse(239))


def sine_cosine(angle):
    """Sine and cosine of a fixed-point angle, by their series after eight halvings."""
    x = angle % (2 * pi()) >> 8
    sine, cosine, term, k = 0, ONE, ONE, 0
    while term:
        k += 1
        term = term * x // ONE // k
        if k % 2:
            sine += term if k % 4 == 1 else -term
        else:
            cosine += term if k % 4 == 0 else -term
    for _ in range(8):
        sine, cosine = 2 * sine * cosine // ONE, (cosine * cosine - sine * sine) // ONE
    return sine, cosine


def fixed(angle, *, degrees):
    exact = Fraction(angle)
    if degrees:
        return int(exact * pi() / 180)
    return int(exact * ONE)


def vectors(lonlat, *, degrees=True):
    return _core.sphere_directions(np.array(lonlat, dtype=float).reshape(-1, 2), degrees, 1)


def samples(degrees):
    rng = np.random.default_rng(1)
    quarter = 90.0 if degrees else math.pi / 2
    near = [quarter * k + x for k in range(-8, 9) for x in (1e-15, -1e-13, 1e-9, -1e-5, 1e-3)]
    small = [10.0**-k * s for k in (3, 17, 60, 150, 280, 307, 320) for s in (1, -7.7)]
    return [
        *rng.uniform(-12 * quarter, 12 * quarter, 400).tolist(),
        *rng.uniform(-quarter, quarter, 200).tolist(),
        *near,
        *small,
        *((1.0 * np.arange(-400, 401)).tolist() if degrees else []),
    ]


def off(value, exact, unit=ONE):
    """The error of a double in units of its last place; `exact` in units of 1 / unit."""
    step = Fraction(math.ulp(float(Fraction(exact, unit)) or 5e-324))
    return float(abs(Fraction(value) - Fraction(exact, unit)) / step)


@pytest.mark.parametrize("degrees", [True, False])
def test_sines_and_cosines_are_within_half_a_unit(degrees):
    angles = [x for x in samples(degrees) if abs(x) > 1e-60]
    worst = 0.0
    found = vectors([(x, 0) for x in angles], degrees=degrees)
    for x, (c, s, z) in zip(angles, found.tolist(), strict=True):
        assert z == 0
        for value, exact in zip((s, c), sine_cosine(fixed(x, degrees=degrees)), strict=True):
            if abs(exact) < 1 << 40:
                assert value == 0.0
            elif not degrees and value == 0.0:
                # The double nearest to a multiple of a right angle counts as one.
                assert abs(exact) < ONE >> 50
            elif abs(exact) > 1 << 100:
                worst = max(worst, off(value, exact))
    assert 0.4 < worst < 0.5001


@pytest.mark.parametrize("degrees", [True, False])
def test_tangents_are_within_a_unit(degrees):
    quarter = 90.0 if degrees else math.pi / 2
    angles = [x for x in samples(degrees) if 1e-60 < abs(x) < quarter]
    worst = 0.0
    for x, (_, _, z) in zip(
        angles, vectors([(0, x) for x in angles], degrees=degrees), strict=True
    ):
        sine, cosine = sine_cosine(fixed(x, degrees=degrees))
        worst = max(worst, off(z, sine, cosine))
    assert 0.3 < worst < 1.01


def test_small_angles_down_to_subnormals():
    for x in (1e-70, 3.3e-200, 2e-300, 1e-306, 4e-308, 7e-310, 5e-324):
        (_, s, _), (_, _, t) = vectors([(x, 0), (0, x)]).tolist()
        exact = Fraction(x) * Fraction(pi(), 180 * ONE)
        step = Fraction(math.ulp(float(exact) or 5e-324))
        assert abs(Fraction(s) - exact) / step < 1.01
        assert s == t
        (_, s, _), (_, _, t) = vectors([(x, 0), (0, x)], degrees=False).tolist()
        assert s == t == x


def test_whole_and_half_turns_are_exact():
    root = math.sqrt(0.5)
    found = vectors([(0, 0), (90, 0), (180, 0), (270, 0), (-180, 0), (360, 0), (45, 45), (30, -45)])
    assert found.tolist() == [
        [1, 0, 0],
        [0, 1, 0],
        [-1, 0, 0],
        [0, -1, 0],
        [-1, 0, 0],
        [1, 0, 0],
        [root, root, 1],
        [math.sqrt(0.75), 0.5, -1],
    ]
    assert not np.signbit(found[found == 0]).any()


def test_poles_and_the_date_line_have_one_direction():
    for degrees, half in ((True, 180.0), (False, math.pi)):
        poles = vectors([(x, half / 2) for x in (0, 1, -2.5)], degrees=degrees)
        assert poles.tolist() == [[0, 0, 1]] * 3
        line = vectors([(half, 0.5), (-half, 0.5)], degrees=degrees)
        assert np.array_equal(line[0], line[1])
        assert line[0, :2].tolist() == [-1, 0]
    # In radians the doubles nearest to multiples of a right angle count as these.
    turns = vectors([(k * math.pi / 2, 0) for k in range(-4, 5)], degrees=False)
    assert np.array_equal(turns, vectors([(k * 90, 0) for k in range(-4, 5)]))
    assert vectors([(0, np.nextafter(90, 0))])[0, 2] > 1e15


def test_mirror_images_have_the_same_bits():
    rng = np.random.default_rng(2)
    # Multiples of 2^-40, so that sums and differences with whole degrees are exact.
    for t in [*(np.round(rng.uniform(0, 45, 500) * 2**40) / 2**40), 45 - 2.0**-40, 45.0]:
        turned = vectors([(x, 10) for x in (t, -t, 180 - t, 180 + t, 90 - t, t + 360, t - 720)])
        c, s = turned[0, :2].tolist()
        want = [(c, s), (c, -s), (-c, s), (-c, -s), (s, c), (c, s), (c, s)]
        assert [tuple(v) for v in turned[:, :2].tolist()] == want
        up, down = vectors([(5, t), (5, -t)])[:, 2]
        assert up == -down


def test_points_of_a_meridian_are_on_one_great_circle():
    rng = np.random.default_rng(3)
    for lon in rng.uniform(-180, 180, 50):
        lats = rng.uniform(-90, 90, 3)
        opposite = math.fmod(lon + 180, 360)
        if Fraction(opposite) - Fraction(lon) not in {180, -180}:
            opposite = lon
        rows = vectors([*((lon, lat) for lat in lats), (opposite, lats[0]), (0, 90)])
        a, b, c, d, pole = (oracle.whole(v) for v in rows.tolist())
        assert oracle.det(a, b, c) == oracle.det(a, b, d) == oracle.det(a, b, pole) == 0


@pytest.mark.parametrize("workers", [1, 3])
def test_long_arrays_are_converted_to_their_end(workers):
    # Longer than what one thread takes at a time, several times over.
    rng = np.random.default_rng(4)
    angles = rng.uniform(-90, 90, (70_000, 2))
    found = _core.sphere_directions(angles, True, workers)
    units = _core.sphere_units(found, workers)
    for start in range(0, len(angles), 5_000):
        part = slice(start, start + 5_000)
        piece = _core.sphere_directions(angles[part], True, 1)
        assert np.array_equal(piece, found[part])
        assert np.array_equal(_core.sphere_units(piece, 1), units[part])


@pytest.mark.parametrize("kind", [np.float32, np.float16])
def test_short_floats_mean_quarter_turns(kind: type) -> None:
    quarter = np.pi / 2
    angles = np.array(
        [(0, quarter), (np.pi, 0), (-np.pi, 0), (quarter, 0), (4, 0), (0, -quarter)], kind
    )
    mesh = sphere.Delaunay(lonlat=angles, degrees=False)
    assert mesh.vectors[[0, -1]][:, :2].tolist() == [[0, 0]] * 2 and mesh.duplicates[
        0
    ].tolist() == [2, 1]
    assert mesh.nearest(np.array([(0, quarter)], kind)).tolist() == [0]
    if kind is np.float32:  # which is larger than the double
        with pytest.raises(DirectionError, match="beyond a pole"):
            sphere.Delaunay(lonlat=angles.astype(np.float64), degrees=False)
    beyond = np.nextafter(angles, kind(9))
    with pytest.raises(DirectionError, match="beyond a pole"):
        sphere.Delaunay(lonlat=beyond, degrees=False)
