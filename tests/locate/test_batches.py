"""Locations do not depend on the other queries of a call, nor on their order."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from delone import ConstrainedDelaunay, Delaunay

if TYPE_CHECKING:
    from delone._tiling.location import Location

CASE = Path(__file__).parents[1] / "corpus" / "corners-nearest-to-queries.json"


def assert_same(one: Location, other: Location) -> None:
    for each in fields(one):
        found, wanted = getattr(one, each.name), getattr(other, each.name)
        assert np.array_equal(found, wanted, equal_nan=found.dtype.kind == "f"), each.name


def test_a_query_whose_nearest_point_is_a_corner_of_the_hull() -> None:
    mesh = Delaunay(json.loads(CASE.read_text(encoding="utf-8"))["points"])
    assert_same(mesh.locate([(4, -2)]), mesh.locate([(0, -2), (4, -2)]).at(np.array([1])))


@pytest.mark.parametrize("ndim", [2, 3])
@pytest.mark.parametrize("seed", range(8))
def test_queries_alone_and_in_any_order(ndim: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    mesh = Delaunay(rng.integers(-4, 5, (30, ndim)).astype(float))
    queries = rng.integers(-9, 10, (60, ndim)).astype(float)
    whole = mesh.locate(queries)
    order = rng.permutation(60)
    assert_same(mesh.locate(queries[order]), whole.at(order))
    for i in range(60):
        assert_same(mesh.locate(queries[i : i + 1]), whole.at(np.array([i])))


def test_queries_beside_a_hole_and_a_bay() -> None:
    rng = np.random.default_rng(1)
    outer = [(0, 0), (8, 0), (8, 8), (4, 3), (0, 8)]
    inner = [(2, 1), (4, 1), (4, 2), (2, 2)]
    rings = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0), (5, 6), (6, 7), (7, 8), (8, 5)]
    mesh = ConstrainedDelaunay(outer + inner, rings, holes=[(3, 1.5)], boundary="outline")
    queries = rng.integers(-4, 25, (80, 2)) / 2
    whole = mesh.locate(queries)
    for i in range(80):
        assert_same(mesh.locate(queries[i : i + 1]), whole.at(np.array([i])))
