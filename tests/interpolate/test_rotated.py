"""A rotated grid is interpolated as well as a straight one, although its hull has slivers.

Sites along a side of a rotated grid lie on a line up to rounding only. Triangles there
that are a few units in the last place high join sites that are far apart.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay
from delone._tiling.plane import slivers
from delone.interpolate import CloughTocher, Linear, NaturalNeighbor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

SITES = np.stack(np.meshgrid(np.arange(31.0), np.arange(31.0)), axis=-1).reshape(-1, 2)
INSIDE = np.random.default_rng(0).uniform(0.001, 29.999, (4000, 2))
BEYOND = np.array([(15.0, -1.0), (-1.0, 15.0), (31.0, 15.0), (15.0, 31.0), (8.5, -2.0)])
ALONG = np.linspace(0.03, 29.98, 299)
SIDES = np.vstack([np.column_stack((ALONG, np.full(299, y))) for y in (0.0, 30.0)])
METHODS: list[tuple[Any, dict[str, str]]] = [
    (Linear, {}),
    (CloughTocher, {"gradients": "global"}),
    (CloughTocher, {"gradients": "local"}),
    (CloughTocher, {"gradients": "plane"}),
    (NaturalNeighbor, {"kind": "farin"}),
    (NaturalNeighbor, {"kind": "sibson1"}),
]


def waves(at: Floats) -> Floats:
    found: Floats = np.sin(at[:, 0] / 5) + np.cos(at[:, 1] / 4)
    return found


def rotated(points: Floats, degrees: float, offset: float = 0.0) -> Floats:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([(c, s), (-s, c)]) + offset


def slopes(at: Floats) -> Floats:
    found: Floats = np.column_stack((np.cos(at[:, 0] / 5) / 5, -np.sin(at[:, 1] / 4) / 4))
    return found


def worst(method: Any, options: dict[str, str], degrees: float, offset: float) -> dict[str, float]:
    """The largest errors inside, along the sides and beyond them, and those of gradients."""
    sites = rotated(SITES, degrees, offset)
    made = method(sites, waves(SITES), extrapolate="linear", **options)
    within = method(sites, waves(SITES), extrapolate="nan", **options)
    found = {}
    for name, queries in (("inside", INSIDE), ("sides", SIDES), ("beyond", BEYOND)):
        places = rotated(queries, degrees, offset)
        found[name] = np.abs(made(places) - waves(queries)).max()
        expected = rotated(slopes(queries), degrees)
        found[f"slopes {name}"] = np.abs(made.gradient(places) - expected).max()
    places = rotated(SIDES, degrees, offset)
    # Rounding takes a part of them out of the hull; all others have values, in slivers too.
    known = within.triangulation.find_simplex(places) >= 0
    assert known.mean() > 0.3
    gaps = np.abs(within(places) - waves(SIDES))
    assert np.array_equal(np.isfinite(gaps), known)
    found["values"] = gaps[known].max()
    gaps = np.abs(within.gradient(places) - rotated(slopes(SIDES), degrees))
    found["slopes"] = gaps[known].max()
    return found


@pytest.mark.parametrize("offset", [0.0, 5e6])
@pytest.mark.parametrize("degrees", [7, 25, 45, 118])
@pytest.mark.parametrize(("method", "options"), METHODS)
def test_errors_are_those_of_a_straight_grid(
    method: Any, options: dict[str, str], degrees: float, offset: float
) -> None:
    found, straight = (worst(method, options, *turn) for turn in ((degrees, offset), (0, 0)))
    # A component of a straight gradient is one of two of a rotated one.
    for name, value in found.items():
        assert value < 2 * straight[name] * (np.sqrt(2) if "slopes" in name else 1), name


def test_second_derivatives_along_the_sides_are_those_behind_them() -> None:
    for extrapolate in ("nan", "raise"):
        made = CloughTocher(
            rotated(SITES, 25), waves(SITES), gradients="local", extrapolate=extrapolate
        )
        found = made.hessian(rotated(SIDES, 25))
        known = np.isfinite(found).all(axis=(1, 2))
        assert known.mean() > 0.3
        assert np.abs(found[known]).max() < 0.5


@pytest.mark.parametrize("extrapolate", ["nearest", "linear"])
@pytest.mark.parametrize(("method", "options"), METHODS)
def test_tables_of_weights_say_the_same(
    method: Any, options: dict[str, str], extrapolate: str
) -> None:
    made = method(rotated(SITES, 25), waves(SITES), extrapolate=extrapolate, **options)
    queries = np.vstack((rotated(BEYOND, 25), rotated(INSIDE[:300], 25)))
    table = made.weights_at(queries)
    np.testing.assert_allclose(table.apply(waves(SITES)), made(queries), rtol=1e-11, atol=1e-11)


def test_the_sides_of_constraints_have_no_slivers_either() -> None:
    row = 31 * np.arange(31) + 15
    ridge = np.column_stack((row[:-1], row[1:]))
    values = np.abs(SITES[:, 0] - 15)
    made = {}
    for degrees in (0, 25):
        mesh = ConstrainedDelaunay(rotated(SITES, degrees), ridge)
        bent = CloughTocher(
            mesh, values, gradients="local", respect_constraints=True, extrapolate="linear"
        )
        for name, queries in (("inside", INSIDE), ("side", SIDES), ("beyond", BEYOND)):
            expected = np.abs(queries[:, 0] - 15)
            made[degrees, name] = np.abs(bent(rotated(queries, degrees)) - expected).max()
    assert made[25, "inside"] < 1e-9
    assert made[25, "side"] < 1e-9
    assert made[25, "beyond"] < max(1e-9, 2 * made[0, "beyond"])


@pytest.mark.parametrize("power", [-900, -300, 0, 300, 900])
def test_slivers_are_the_same_in_other_units(power: int) -> None:
    mesh = Delaunay(rotated(SITES, 25))
    found = slivers.at_outline(mesh.points, mesh.simplices, mesh.neighbors)
    assert 20 < found.sum() < 200
    # Without them, no site of a side is skipped.
    left, neighbors = slivers.without(mesh.simplices, mesh.neighbors, found)
    side = np.count_nonzero(neighbors < 0)
    assert side == 4 * 30 and len(left) == 2 * 30 * 30
    scaled = Delaunay(np.ldexp(mesh.points, power))
    again = slivers.at_outline(scaled.points, scaled.simplices, scaled.neighbors)
    # Triangles are in another order there.
    rows = [np.sort(m.simplices[f]).tolist() for m, f in ((mesh, found), (scaled, again))]
    assert sorted(rows[0]) == sorted(rows[1])


def test_data_that_are_all_slivers_are_kept() -> None:
    points = rotated(np.column_stack((np.arange(9.0), np.zeros(9))), 25)
    mesh = Delaunay(points)
    assert not slivers.at_outline(mesh.points, mesh.simplices, mesh.neighbors).any()
    assert np.isfinite(Linear(mesh, np.arange(9.0), extrapolate="linear")((3.0, 9.0)))


def test_slivers_with_a_short_side_at_the_outline_are_kept() -> None:
    points = [(1.0, 1.0), (1.0, 1 + 2.0**-52), (5.0, 1.0), (3.0, 5.0), (3.0, -5.0)]
    mesh = Delaunay(points)
    thin, straight, _ = slivers.shapes(mesh.points, mesh.simplices)
    assert np.sort(mesh.simplices[thin]).tolist() == [[0, 1, 2]]
    assert not straight.any()
    assert (mesh.neighbors[thin] < 0).any()
    assert not slivers.at_outline(mesh.points, mesh.simplices, mesh.neighbors).any()
