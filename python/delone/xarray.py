"""Interpolation of xarray objects (extra ``xarray``): ``import delone.xarray``.

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
"""

from __future__ import annotations

from delone.interpolate.accessor import (
    ArrayInterpolation,
    DatasetInterpolation,
    VariableWarning,
    VectorWarning,
)

__all__ = ["ArrayInterpolation", "DatasetInterpolation", "VariableWarning", "VectorWarning"]
