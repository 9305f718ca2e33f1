"""Interpolation of scattered data: exact at the sites, no NaN inside the hull.

Each interpolator is built once, from points or from a triangulation, and evaluates any number of
fields and queries with reusable weights. `grid` makes rasters, and `cross_validate` measures how
well a method predicts the given data.

>>> from delone.interpolate import Linear
>>> Linear([(0, 0), (4, 0), (0, 4)], [1.0, 5.0, 9.0])([(1, 1), (4, 0)])
array([4., 5.])
"""

from __future__ import annotations

from typing import Any

from delone.interpolate.base import Interpolator
from delone.interpolate.clough_tocher import CloughTocher
from delone.interpolate.crossval import CrossValidation, cross_validate
from delone.interpolate.linear import Linear
from delone.interpolate.methods import interpolator
from delone.interpolate.natural import NaturalNeighbor
from delone.interpolate.nearest import Nearest
from delone.interpolate.raster import Grid, grid
from delone.interpolate.smooth import GradientWarning
from delone.interpolate.weights import Weights

__all__ = [
    "CloughTocher",
    "CrossValidation",
    "GradientWarning",
    "Grid",
    "Interpolator",
    "Linear",
    "NaturalNeighbor",
    "Nearest",
    "Weights",
    "cross_validate",
    "grid",
    "interpolator",
]


def __getattr__(name: str) -> Any:
    # It subclasses scikit-learn's classes, which are an optional dependency.
    if name == "DelaunayRegressor":
        from delone.interpolate.regressor import DelaunayRegressor

        return DelaunayRegressor
    raise AttributeError(f"module {__name__!r:.80} has no attribute {name!r:.80}")
