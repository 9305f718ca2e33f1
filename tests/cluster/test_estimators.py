"""The interface of scikit-learn's estimators, and errors."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pandas as pd
import pytest
import sklearn.base
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils.validation import check_is_fitted

from delone import GeographicWarning
from delone.cluster import DBSCAN, HDBSCAN
from delone.errors import DtypeError, InputError, NonFiniteError, ShapeError

BOTH = [DBSCAN(0.2), HDBSCAN(10)]
POINTS = np.random.default_rng(0).normal(0, 1, (200, 2))


@pytest.mark.parametrize("model", BOTH, ids=repr)
def test_scikit_learn_can_handle_them(model: Any) -> None:
    twin = sklearn.base.clone(model)
    assert twin is not model
    assert twin.get_params() == model.get_params()
    assert sklearn.base.is_clusterer(model)
    with pytest.raises(sklearn.exceptions.NotFittedError):
        check_is_fitted(twin)
    pipeline = make_pipeline(StandardScaler(), twin)
    labels = pipeline.fit_predict(POINTS)
    scaled = StandardScaler().fit_transform(POINTS)
    assert np.array_equal(labels, model.fit_predict(scaled))
    assert np.array_equal(pipeline[-1].labels_, labels)
    pipeline.set_params(**{f"{type(model).__name__.lower()}__min_samples": 3})
    assert pipeline[-1].min_samples == 3
    assert str(pipeline)
    check_is_fitted(twin)
    again = pickle.loads(pickle.dumps(twin))
    assert np.array_equal(again.labels_, labels)


@pytest.mark.parametrize("model", BOTH, ids=repr)
def test_tables_are_points(model: Any) -> None:
    frame = pd.DataFrame(POINTS, columns=["x", "y"])
    model = sklearn.base.clone(model).fit(frame)
    assert model.feature_names_in_.tolist() == ["x", "y"]
    assert model.n_features_in_ == 2
    assert np.array_equal(model.labels_, model.fit(POINTS.tolist()).labels_)
    assert not hasattr(model, "feature_names_in_")


def test_options_are_shown_and_set() -> None:
    assert repr(HDBSCAN(7, min_samples=2)) == "HDBSCAN(min_cluster_size=7, min_samples=2)"
    assert repr(DBSCAN()) == "DBSCAN()"
    assert HDBSCAN().set_params(min_cluster_size=9).min_cluster_size == 9
    with pytest.raises(InputError, match="DBSCAN has no option radius; there are eps,"):
        DBSCAN().set_params(radius=3)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"min_cluster_size": 1}, InputError, "at least 2"),
        ({"min_cluster_size": 2.5}, DtypeError, "min_cluster_size"),
        ({"min_samples": 0}, InputError, "at least 1"),
        ({"max_cluster_size": 0}, InputError, "at least 1"),
        ({"cluster_selection_epsilon": -1}, InputError, "at least 0"),
        ({"cluster_selection_epsilon": np.nan}, InputError, "at least 0"),
        ({"cluster_selection_method": "best"}, InputError, "'eom', 'leaf'"),
        ({"allow_single_cluster": 1}, DtypeError, "True or False"),
        ({"metric": "haversine"}, InputError, "'haversine' is not available"),
        ({"metric": abs}, DtypeError, "metric"),
        ({"workers": 0}, InputError, "workers"),
    ],
    ids=str,
)
def test_options_of_hdbscan_are_checked(
    options: dict[str, Any], error: type[Exception], words: str
) -> None:
    model = HDBSCAN(**options)
    with pytest.raises(error, match=words):
        model.fit(POINTS)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"eps": -0.5}, InputError, "at least 0"),
        ({"eps": np.nan}, InputError, "at least 0"),
        ({"eps": "wide"}, DtypeError, "eps"),
        ({"min_samples": 0}, InputError, "at least 1"),
        ({"metric": "manhattan"}, InputError, "'manhattan' is not available"),
    ],
    ids=str,
)
def test_options_of_dbscan_are_checked(
    options: dict[str, Any], error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        DBSCAN(**options).fit(POINTS)


@pytest.mark.parametrize("model", BOTH, ids=repr)
def test_points_are_checked(model: Any) -> None:
    for d in (1, 4, 20):
        with pytest.raises(ShapeError, match="2 or 3 coordinates"):
            model.fit(np.zeros((30, d)))
    with pytest.raises(NonFiniteError) as caught:
        model.fit([(0, 0), (1, np.inf)])
    assert caught.value.rows.tolist() == [1]
    with pytest.raises(DtypeError):
        model.fit([("a", "b")])
    degrees = pd.DataFrame(POINTS, columns=["lon", "lat"])
    with pytest.warns(GeographicWarning):
        model.fit(degrees)


@pytest.mark.parametrize("columns", [0, 1, 9])
@pytest.mark.parametrize("model", BOTH, ids=repr)
def test_points_of_tables_are_points(model: Any, columns: int) -> None:
    geopandas = pytest.importorskip("geopandas")
    table = {f"a{k}": np.arange(len(POINTS)) for k in range(columns)}
    x, y = np.asarray(POINTS).T
    frame = geopandas.GeoDataFrame(table, geometry=geopandas.points_from_xy(x, y))
    expected = model.fit(frame.get_coordinates()).labels_
    for given in (frame, frame.geometry):
        assert np.array_equal(model.fit(given).labels_, expected)
    with pytest.raises(DtypeError, match=r"points\.get_coordinates\(\)\.to_numpy\(\)"):
        model.fit(frame.geometry.iloc[0])
    with pytest.raises(DtypeError, match="not points, the first in row 0, a Polygon"):
        model.fit(frame.buffer(1))


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("model", BOTH, ids=repr)
def test_degrees_may_be_declared_planar(model: Any) -> None:
    degrees = pd.DataFrame(POINTS, columns=["lon", "lat"])
    sklearn.base.clone(model).set_params(planar=True).fit(degrees)
