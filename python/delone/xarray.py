"""Interpolation and regridding of xarray objects (extra ``xarray``): ``import delone.xarray``.

The import registers ``.delone`` on DataArray and Dataset.

>>> import xarray
>>> import delone.xarray
>>> stations = xarray.DataArray(
...     [1.0, 3.0, 2.0],
...     dims="station",
...     coords={"lon": ("station", [175.0, -175.0, 180.0]), "lat": ("station", [0.0, 0.0, 8.0])},
... )
>>> stations.delone.interp([180.0], [0.0]).item()
2.0

``ds.delone.regrid(target)`` and `Regridder` regrid fields from one grid of cells on the sphere to
another.
"""

from __future__ import annotations

from delone.interpolate.accessor import (
    ArrayInterpolation,
    DatasetInterpolation,
    VariableWarning,
    VectorWarning,
)
from delone.sphere.regridder import Regridder

__all__ = [
    "ArrayInterpolation",
    "DatasetInterpolation",
    "Regridder",
    "VariableWarning",
    "VectorWarning",
]
