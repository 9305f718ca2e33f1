"""Plots of lines: contours on a map, and profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.plot.axes import new_axes

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["plot_lines", "plot_profile"]


def plot_lines(lines: Sequence[Floats], widths: Floats, ax: Any = None, **options: Any) -> Any:
    """Plot lines, (k, 2) each, on a map."""
    axes = new_axes(ax)
    from matplotlib.collections import LineCollection

    style = {"colors": "#6b4226", "linewidths": widths} | options
    axes.add_collection(LineCollection(lines, **style), autolim=True)
    axes.autoscale_view()
    axes.set_aspect("equal")
    return axes


def plot_profile(distance: Floats, z: Floats, ax: Any = None, **options: Any) -> Any:
    """Plot heights over distances."""
    axes = new_axes(ax)
    axes.plot(distance, z, **options)
    axes.set(xlabel="distance", ylabel="height")
    return axes
