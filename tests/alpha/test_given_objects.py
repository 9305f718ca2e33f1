"""Objects given to other classes are taken whole, or refused by name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import delone
from delone import graphs
from delone.alpha import values
from delone.errors import InputError

POINTS = np.random.default_rng(0).random((40, 2))
WEIGHTS = np.full(40, 0.001)
WEIGHTS[0] = 0.05
PERIODIC = delone.PeriodicDelaunay(POINTS, (1, 1))
REGULAR = delone.RegularTriangulation(POINTS, WEIGHTS)
GLOBE = delone.sphere.Delaunay(lonlat=(POINTS - 0.5) * [360, 180])
MESH = delone.mesh({"type": "Polygon", "coordinates": [[(0, 0), (1, 0), (1, 1)]]})


def equal(a: delone.AlphaComplex, b: delone.AlphaComplex) -> bool:
    if a.periods != b.periods or (a.weights is None) != (b.weights is None):
        return False
    same = a.weights is None or np.array_equal(a.weights, b.weights)
    return bool(same) and a.shape(np.inf).betti == b.shape(np.inf).betti


def test_alpha_complexes_keep_periods_and_weights() -> None:
    plain = delone.AlphaComplex(POINTS, periodic=(1, 1))
    assert equal(delone.AlphaComplex(PERIODIC), plain) and plain.periods == (1, 1)
    both = delone.AlphaComplex(POINTS, WEIGHTS, (1, 1))
    weighted = delone.PeriodicDelaunay(POINTS, (1, 1), weights=WEIGHTS)
    assert equal(delone.AlphaComplex(weighted), both) and both.weights is not None
    assert equal(delone.AlphaComplex(REGULAR, periodic=(1, 1)), both)
    with pytest.raises(InputError, match="has its own weights and periods"):
        delone.AlphaComplex(PERIODIC, WEIGHTS)
    with pytest.raises(InputError, match="has its own weights and periods"):
        delone.AlphaComplex(PERIODIC, periodic=(2, 2))


@pytest.mark.parametrize(
    ("make", "given", "message"),
    [
        (delone.concave_hull, PERIODIC, "lose the periods of a PeriodicDelaunay"),
        (delone.concave_hull, REGULAR, "lose the weights of a RegularTriangulation"),
        (delone.concave_hull, GLOBE, "a concave hull is not available on the sphere"),
        (delone.AlphaComplex, GLOBE, "an alpha complex is not available on the sphere"),
        (graphs.delaunay_graph, GLOBE, "a graph is not available on the sphere"),
        (delone.Dynamic, GLOBE, "not a Delaunay, of which only the points"),
        (delone.Dynamic, PERIODIC, "not a PeriodicDelaunay"),
        (delone.Dynamic, REGULAR, "not a RegularTriangulation"),
        (delone.Dynamic, delone.Voronoi(POINTS), "not a Voronoi"),
        (delone.Dynamic, MESH, "not a Mesh, of which"),
    ],
)
def test_what_would_be_lost_is_named(make: Any, given: Any, message: str) -> None:
    options = {"ratio": 0.5} if make is delone.concave_hull else {}
    with pytest.raises(InputError, match=message):
        make(given, **options)


def test_workers_of_alpha_complexes_are_heeded(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def counted(points: Any, **options: Any) -> Any:
        asked.append(options["workers"])
        return delone.Delaunay(points, **options)

    monkeypatch.setattr(values, "Delaunay", counted)
    values.of_points(POINTS, None, 3)
    assert asked == [3]
