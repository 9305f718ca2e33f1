"""Several fields with ``nan="drop"``: each from all sites that have its own values."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from delone import sphere
from delone.errors import DegenerateInputError, InputError
from delone.interpolate import Interpolator, cross_validate, grid, interpolator

RANDOM = np.random.default_rng(0)
POINTS = RANDOM.random((60, 2))
VECTORS = RANDOM.normal(size=(60, 3))
FIELDS = RANDOM.normal(size=(60, 2, 3))
for _k in range(4):
    FIELDS[RANDOM.integers(0, 60, 7), _k // 2, _k % 2] = np.nan
# Two fields have one pattern.
FIELDS[:, 1, 2] = np.where(np.isnan(FIELDS[:, 0, 0]), np.nan, FIELDS[:, 1, 2])

PLANAR = ["linear", "nearest", "sibson", "clough-tocher"]


def made(method: str, values: Any, **options: Any) -> Any:
    if method.startswith("sphere"):
        kind = {"sphere linear": sphere.Linear, "sphere nearest": sphere.Nearest}[method]
        return kind(VECTORS, values, nan="drop", **options)
    return interpolator(POINTS, values, method, nan="drop", **options)


@pytest.mark.parametrize("method", [*PLANAR, "sphere linear", "sphere nearest"])
@pytest.mark.parametrize("kind", ["real", "complex"])
def test_each_field_is_as_if_it_were_alone(method: str, kind: str) -> None:
    fields = FIELDS if kind == "real" else FIELDS + 1j * FIELDS[:, ::-1]
    queries = VECTORS[:20] if method.startswith("sphere") else POINTS[:20]
    both = made(method, fields)
    later = made(method, None)
    gradients = hasattr(both, "gradient") and method != "nearest"
    for each in (both, pickle.loads(pickle.dumps(both))):
        found = each(queries)
        assert found.shape == (20, 2, 3)
        limited = each(queries, max_distance=1e-3)
        for i, j in np.ndindex(2, 3):
            alone = made(method, fields[:, i, j])
            np.testing.assert_array_equal(found[:, i, j], alone(queries))
            np.testing.assert_array_equal(limited[:, i, j], alone(queries, max_distance=1e-3))
            if gradients:
                np.testing.assert_array_equal(
                    both.gradient(queries)[:, i, j], alone.gradient(queries)
                )
    np.testing.assert_array_equal(later(queries, values=fields), found)
    # A station's own value is its value.
    known = np.isfinite(fields[:20, 0, 1])
    np.testing.assert_allclose(found[known, 0, 1], fields[:20, 0, 1][known], atol=1e-12)


def test_one_triangulation_for_each_pattern(monkeypatch: pytest.MonkeyPatch) -> None:
    built: list[int] = []
    plain = Interpolator._triangulated

    def counted(self: Any) -> Any:
        mesh = plain(self)
        built.append(mesh.npoints)
        return mesh

    monkeypatch.setattr(Interpolator, "_triangulated", counted)
    linear = made("linear", None)
    linear(POINTS[:3], values=FIELDS)
    # All sites, and patterns: four with gaps, of which one is shared, and one without.
    assert len(built) == 5
    linear(POINTS[:3], values=FIELDS)
    linear(POINTS[:3], values=2 * FIELDS)
    assert len(built) == 5
    raster = grid(linear, FIELDS, shape=(9, 7))
    assert raster.values.shape == (7, 9, 2, 3) and len(built) == 5


def test_hessians_and_cross_validation() -> None:
    both = made("clough-tocher", FIELDS)
    found = both.hessian(POINTS[:5])
    validated = cross_validate(POINTS, FIELDS, nan="drop")
    assert found.shape == (5, 2, 3, 2, 2) and validated.predicted.shape == FIELDS.shape
    for i, j in np.ndindex(2, 3):
        alone = made("clough-tocher", FIELDS[:, i, j])
        np.testing.assert_array_equal(found[:, i, j], alone.hessian(POINTS[:5]))
        alone = cross_validate(POINTS, FIELDS[:, i, j], nan="drop")
        np.testing.assert_array_equal(validated.predicted[:, i, j], alone.predicted)


@pytest.mark.parametrize("method", ["linear", "sphere linear"])
def test_what_has_one_set_of_sites_is_refused(method: str) -> None:
    both = made(method, FIELDS)
    queries = VECTORS[:2] if method.startswith("sphere") else POINTS[:2]
    for ask in (both.weights_at, both.distance, lambda _: both.triangulation):
        with pytest.raises(InputError, match="removes different sites from 5 groups of fields"):
            ask(queries)
    assert "Linear on <Delaunay of 60" in repr(both)
    empty = FIELDS.copy()
    empty[:, 1, 0] = np.nan
    with pytest.raises(DegenerateInputError) as caught:
        made(method, empty)
    assert caught.value.__notes__ == ["of the fields among values, number 3"]
