"""What once broke something in space, and what could, with all that follows, by definition."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import delone
from delone import ConvexHull, Delaunay, Voronoi
from delone.interpolate import Linear
from delone.predicates import orient3d

CORPUS = sorted((Path(__file__).parents[1] / "corpus" / "space").glob("*.json"))
RNG = np.random.default_rng(11)
MORE = {
    "two planes of neighbouring doubles": np.column_stack(
        (RNG.integers(-40, 40, (300, 2)), np.where(RNG.random(300) < 0.5, 1.0, 1.0 + 2.0**-52))
    ),
    "all exponents": np.ldexp(RNG.random((40, 3)) - 0.5, RNG.integers(-1060, 1000, (40, 3))),
    "subnormal lattice": RNG.integers(-3, 4, (40, 3)) * 5e-324,
    "largest lattice": RNG.integers(-3, 4, (40, 3)) * 2.0**1021,
}


def points_of(path: Path) -> Any:
    return np.array(json.loads(path.read_text())["points"])


CASES = [pytest.param(points_of(path), id=path.stem) for path in CORPUS]
CASES += [pytest.param(points, id=name) for name, points in MORE.items()]


def corners(points: Any, simplex: Any) -> list[list[Fraction]]:
    return [[Fraction(x) for x in points[v].tolist()] for v in simplex]


def volume(points: Any, simplex: Any) -> Fraction:
    o, *ends = corners(points, simplex)
    a, b, c = ([x - y for x, y in zip(end, o, strict=True)] for end in ends)
    cross = [b[i - 2] * c[i - 1] - b[i - 1] * c[i - 2] for i in range(3)]
    return sum((x * y for x, y in zip(a, cross, strict=True)), Fraction(0)) / 6


@pytest.mark.parametrize("points", CASES)
@pytest.mark.filterwarnings("error")
def test_tetrahedra_fill_the_hull(points: Any) -> None:
    mesh, hull = Delaunay(points), ConvexHull(points)
    assert mesh.validate()
    for turned in (points[::-1], points[RNG.permutation(len(points))]):
        assert ConvexHull(turned).nsimplex == hull.nsimplex
    for simplex in hull.simplices:
        ends = (points[v][None] for v in simplex)
        assert (orient3d(*ends, points) <= 0).all()
    o = mesh.simplices[0, 0]
    cones = [(a, c, b, o) for a, b, c in hull.simplices]
    whole = sum(volume(points, cone) for cone in cones)
    assert whole == sum(volume(points, simplex) for simplex in mesh.simplices)


@pytest.mark.parametrize("points", CASES)
@pytest.mark.filterwarnings("error")
def test_what_follows_is_there(points: Any) -> None:
    mesh = Delaunay(points)
    quality = mesh.quality()
    assert (quality.edge_ratio >= 1).all()
    assert np.isfinite(quality.smallest_dihedral).all()
    for simplex, found in zip(mesh.simplices, quality.volume, strict=True):
        size = float(min(volume(points, simplex), Fraction(2) ** 1023))
        assert min(found, 2.0**1023) == pytest.approx(size, rel=1e-13, abs=5e-324)
    assert (mesh.locate(points).simplex >= 0).all()
    assert np.array_equal(mesh.nearest(points), mesh.duplicate_of)
    better = delone.improve(mesh)
    assert (better.find_simplex(better.points[np.unique(better.simplices)]) >= 0).all()
    values = np.arange(len(points)) * 1.0
    found = Linear(points, values, extrapolate="linear", duplicates="first")(points)
    assert np.array_equal(found, values[mesh.duplicate_of])


# Some of these sets have cells that rounding takes, which a warning says.
@pytest.mark.filterwarnings("ignore::delone.voronoi.ThinCellWarning")
@pytest.mark.parametrize("points", CASES)
@pytest.mark.filterwarnings("error")
def test_cells_in_the_box_fill_it(points: Any) -> None:
    low, high = points.min(axis=0), points.max(axis=0)
    sides = [Fraction(b) - Fraction(a) for a, b in zip(low.tolist(), high.tolist(), strict=True)]
    size = sides[0] * sides[1] * sides[2]
    coarse = np.spacing(np.abs(points).max(axis=0)) > 1e-9 * (high / 2 - low / 2)
    diagram = Voronoi(points, clip=(low, high))
    volumes = diagram.cell_volumes[np.unique(diagram.duplicate_of)]
    assert (volumes >= 0).all()
    if Fraction(1e-300) < size < Fraction(1e300) and not coarse.any():
        assert volumes.sum() == pytest.approx(float(size), rel=1e-9)
