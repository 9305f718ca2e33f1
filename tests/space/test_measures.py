"""Measures of tetrahedra beside rational ones: of slivers above all, and of ranges of all sizes."""

from __future__ import annotations

from decimal import Context, Decimal
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import Delaunay, improve
from delone._tiling.space.quality import EDGES, dihedral_angles, measured
from rational import cross, dot, minus

if TYPE_CHECKING:
    from numpy.typing import NDArray

E = 2.0**-52
# Each tetrahedron has lost all digits of some number, or its numbers are beyond the range.
SINGLE = {
    "volume lost": [
        (0.999999, -1e-6, -1e-6),
        (1.999999, 1e-6, 1),
        (1.000001, 2.000001, 1.000001),
        (1, 2.000001, 1),
    ],
    "volume wrong": [
        (1.000001, -1e-6, 2),
        (0, 1, 1.999999),
        (-1e-6, 2.000001, 1.999999),
        (1, 1, 2),
    ],
    "faces wrong": [
        (2 - E, 2, E),
        (1 - E / 2, 1, 1),
        (1 - E / 2, 1 - E / 2, 1 - E / 2),
        (1, 1, 1),
    ],
    "thin": [(0, 0, 0), (1, 0, 0), (0, 1e-200, 0), (0, 0, 1e-200)],
    "thin, and not by powers": [(0, 0, 0), (1e60, 0, 0), (0, 1.3717e-100, 0), (0, 0, 1.777e-100)],
    "subnormal": [(0, 0, 0), (5e-324, 0, 0), (0, 5e-324, 0), (0, 0, 1e-323)],
    "largest": [(-1.5e308, 0, 0), (1.5e308, 0, 1), (0, 1.5e308, 0), (0, 0, 1.5e308)],
    "twins far away": [(1e9, 1e9, 1e9), (1e9, 1e9, 1e9 + 1e-6), (0, 1, 0), (0, 0, 1)],
    "regular": [(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)],
}
CONTEXT = Context(prec=60, Emin=-99999, Emax=99999)


def root(square: Fraction) -> Decimal:
    quotient = CONTEXT.divide(Decimal(square.numerator), Decimal(square.denominator))
    return CONTEXT.sqrt(quotient)


def exact(corners: NDArray[np.float64]) -> dict[str, Any]:
    """The measures, each rounded but a few times at the end."""
    p = [[Fraction(x) for x in row] for row in corners.tolist()]
    size = abs(dot(minus(p[1], p[0]), cross(minus(p[2], p[0]), minus(p[3], p[0]))))
    angles = []
    for i, j in EDGES:
        k, m = (c for c in range(4) if c not in (i, j))
        axis = minus(p[j], p[i])
        ahead, other = (cross(axis, minus(p[c], p[i])) for c in (k, m))
        cosine = dot(ahead, other)
        sine = root(size**2 * dot(axis, axis))
        ratio = CONTEXT.divide(Decimal(abs(cosine.numerator)), Decimal(cosine.denominator))
        if sine < ratio:
            angle = np.arctan(float(CONTEXT.divide(sine, ratio)))
            angles.append(angle if cosine > 0 else np.pi - angle)
        else:
            tilt = np.arctan(float(CONTEXT.divide(ratio, sine)))
            angles.append(np.pi / 2 - (tilt if cosine > 0 else -tilt))
    squares = [dot(e, e) for e in (minus(p[j], p[i]) for i, j in EDGES)]
    faces = [cross(minus(p[b], p[a]), minus(p[c], p[a])) for a, b, c in combinations(range(4), 3)]
    around = sum((root(dot(n, n)) for n in faces), Decimal(0))
    # From the first corner the circumcentre is this vector over twice the determinant.
    u, v, w = (minus(p[k], p[0]) for k in (1, 2, 3))
    products = zip(cross(v, w), cross(w, u), cross(u, v), strict=True)
    center = [dot((dot(u, u), dot(v, v), dot(w, w)), row) for row in products]
    share = CONTEXT.divide(root(36 * size**4), CONTEXT.multiply(around, root(dot(center, center))))
    return {
        "angles": np.degrees(angles),
        "volume": size / 6,
        "edge_ratio": root(max(squares) / min(squares)),
        "radius_ratio": share,
    }


def rounded(number: Fraction | Decimal) -> float:
    try:
        return float(number)
    except OverflowError:
        return np.inf


def assert_right(points: NDArray[np.float64], simplices: NDArray[np.int32]) -> None:
    quality, angles = measured(points, simplices), dihedral_angles(points, simplices)
    for row, simplex in enumerate(simplices):
        right = exact(points[simplex])
        assert angles[row] == pytest.approx(right["angles"], rel=1e-13, abs=0)
        # What is left to 180 degrees is right as far as doubles can tell.
        assert quality.smallest_dihedral[row] == angles[row].min()
        assert quality.largest_dihedral[row] == angles[row].max()
        for name in ("volume", "edge_ratio", "radius_ratio"):
            expected = rounded(right[name])
            assert getattr(quality, name)[row] == pytest.approx(expected, rel=1e-13, abs=5e-324)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", SINGLE)
def test_single_tetrahedra(name: str) -> None:
    points = np.array(SINGLE[name], dtype=np.float64)
    mesh = Delaunay(points)
    for simplex in mesh.simplices:
        for turned in ([0, 1, 2, 3], [3, 2, 1, 0], [1, 0, 3, 2], [2, 3, 0, 1]):
            assert_right(points, simplex[None, turned])
    assert mesh.volumes == pytest.approx(mesh.quality().volume, rel=1e-13, abs=5e-324)


@pytest.mark.parametrize("exponent", range(6, 17, 2))
@pytest.mark.sampled(3)
def test_lattices_that_are_shaken(exponent: int) -> None:
    """Lattices shaken by little: some of their cubes hold slivers, nearly flat squares."""
    rng = np.random.default_rng(exponent)
    lattice = np.stack(np.meshgrid(*3 * [np.arange(4.0)], indexing="ij"), axis=-1).reshape(-1, 3)
    mesh = Delaunay(lattice + 10.0**-exponent * rng.uniform(-1, 1, lattice.shape))
    assert_right(mesh.points, mesh.simplices)


@pytest.mark.parametrize("scale", [2.0**-1000, 2.0**-300, 2.0**300, 2.0**1000])
def test_scale_changes_volumes_alone(scale: float) -> None:
    mesh = Delaunay(np.random.default_rng(1).random((40, 3)))
    given, scaled = (measured(mesh.points * s, mesh.simplices) for s in (1.0, scale))
    for name in ("smallest_dihedral", "largest_dihedral", "radius_ratio", "edge_ratio"):
        assert np.array_equal(getattr(given, name), getattr(scaled, name))


@pytest.mark.parametrize("name", SINGLE)
def test_the_report_has_the_same_numbers(name: str) -> None:
    mesh = Delaunay(np.array(SINGLE[name], dtype=np.float64))
    better = improve(mesh)
    report, before, after = better.report, mesh.quality(), better.quality()
    assert report.smallest_before == before.smallest_dihedral.min()
    assert report.largest_before == before.largest_dihedral.max()
    assert report.smallest_after == after.smallest_dihedral.min()
    assert report.largest_after == after.largest_dihedral.max()
    assert report.before.sum() == mesh.nsimplex
    assert report.after.sum() == better.nsimplex
    assert bool(report) == (report.smallest_after >= 20)
