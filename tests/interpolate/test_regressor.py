"""The estimator of scikit-learn, by scikit-learn's own checks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from delone import datasets
from delone.errors import InputError
from delone.interpolate.methods import METHODS

checks = pytest.importorskip("sklearn.utils.estimator_checks")

from delone.interpolate import DelaunayRegressor  # noqa: E402


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("method", ["linear", "nearest", "sibson"])
def test_all_checks_of_estimators(method: str) -> None:
    """With two features chosen, since the checks come with one to ten."""
    found = checks.check_estimator(DelaunayRegressor(method, columns=(0, 1)), on_fail=None)
    assert len(found) > 40
    failed = [each["check_name"] for each in found if each["status"] == "failed"]
    assert failed == []


@pytest.mark.parametrize("method", sorted(METHODS))
def test_predicts_as_the_interpolator(method: str) -> None:
    points = datasets.uniform(200)
    target = np.column_stack((points @ (1, 2), points[:, 0]))
    model = DelaunayRegressor(method).fit(points, target)
    some = 0.2 + 0.6 * datasets.uniform(20, seed=1)
    np.testing.assert_array_equal(model.predict(some), model.interpolator_(some))
    assert model.score(points, target) == pytest.approx(1.0)


def test_other_features() -> None:
    points = datasets.uniform(50)
    wide = np.column_stack((np.zeros(50), points[:, 1], points[:, 0]))
    model = DelaunayRegressor(columns=(2, 1)).fit(wide, points[:, 0])
    np.testing.assert_allclose(model.predict(wide), points[:, 0])
    with pytest.raises(ValueError, match="choose two with columns"):
        DelaunayRegressor().fit(wide, points[:, 0])
    with pytest.raises(ValueError, match="not among 3"):
        DelaunayRegressor(columns=(0, 3)).fit(wide, points[:, 0])
    with pytest.raises(InputError, match="method"):
        DelaunayRegressor("kriging").fit(points, points[:, 0])
    with pytest.raises(ValueError, match="minimum of 3"):
        DelaunayRegressor().fit(points[:2], points[:2, 0])


@pytest.mark.parametrize("columns", [("a", "b"), (0,), 1, (0.0, 1.0)])
def test_columns_that_are_no_pair_of_integers(columns: Any) -> None:
    points = datasets.uniform(20)
    with pytest.raises(TypeError, match="columns must be two integers"):
        DelaunayRegressor(columns=columns).fit(points, points[:, 0])
