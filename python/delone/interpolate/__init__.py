"""Interpolation of scattered data: exact at the sites, no NaN inside the hull, reusable weights.

Each interpolator is built once, from points or from a triangulation, and serves any number of
fields and queries. `grid` makes rasters, `cross_validate` tells how good a method is on the data at
hand.

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
    # It is made of scikit-learn's classes, which not every program has.
    if name == "DelaunayRegressor":
        from delone.interpolate.regressor import DelaunayRegressor

        return DelaunayRegressor
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
