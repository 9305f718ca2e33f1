"""Every hard input: sites come back bit for bit, inside there is a value, weights agree."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from delone import Delaunay
from delone.interpolate import GradientWarning, interpolator
from delone.interpolate.methods import METHODS

# Of the few large inputs a part does.
MOST = 1500


def places(mesh: Delaunay) -> Any:
    """Places inside: all sites, the middles of edges, and somewhere in each triangle."""
    u, v = mesh.edges.T
    halves = mesh.points[u] / 2 + mesh.points[v] / 2
    weights = np.random.default_rng(1).dirichlet((1, 1, 1), mesh.nsimplex)
    corners = mesh.points[mesh.simplices]
    within = (weights[..., None] * corners).sum(axis=1)
    queries = np.concatenate((mesh.points, halves, within))
    return queries[mesh.find_simplex(queries) >= 0]


@pytest.mark.parametrize("method", sorted(METHODS))
@pytest.mark.sampled(71)
def test_on_the_corpus(corpus_case: Any, method: str) -> None:
    mesh = Delaunay(corpus_case.points[:MOST])
    values = np.random.default_rng(2).random(mesh.npoints)[mesh.duplicate_of]
    queries = places(mesh)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GradientWarning)
        made = interpolator(mesh, values, method)
        found = made(queries)
        np.testing.assert_array_equal(made(mesh.points), values)
        assert np.isfinite(found).all()
        if method in ("linear", "nearest", "sibson", "laplace"):
            assert values.min() - 1e-12 <= found.min() and found.max() <= values.max() + 1e-12
        if method == "clough-tocher" and np.abs(mesh.points).max() > 1e150:
            # A plane takes the place of cubics that doubles do not hold, which no weights say.
            return
        if method == "clough-tocher" and np.abs(made.site_gradients()).max() > 1e12:
            # Triangles as thin as a rounding: what slopes add cancels to the last digit.
            return
        again = made.weights_at(queries) @ values
        scale = 1 + np.abs(found)
        np.testing.assert_allclose(again / scale, found / scale, atol=1e-9)
