"""The axes of 2-D plots: limits, ticks, names, and dots for points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = [
    "axis_names",
    "draw_dots",
    "figure_size",
    "frame",
    "new_axes",
    "pixels",
    "require_bounds",
    "require_values",
    "thin",
]

_DRAWABLE = 1e-305, 1e305  # matplotlib scales and pads by factors of up to 100
_MOST_DOTS = 2000
_DOT = "#17324d"


def new_axes(ax: Any) -> Any:
    """Return the given axes; for None, those of a new pyplot figure."""
    if ax is None:
        _, ax = require("matplotlib.pyplot", extra="plot", what="drawing").subplots()
    elif not isinstance(ax, require("matplotlib.axes", extra="plot", what="drawing").Axes):
        raise DtypeError(
            "ax must be matplotlib axes, such as plt.gca() or figure.add_subplot(), or None; "
            f"got {type(ax).__name__}"
        )
    return ax


def require_bounds(low: Floats, high: Floats) -> None:
    """Reject coordinates for which the transforms of matplotlib overflow."""
    far = max(np.abs(low).max(), np.abs(high).max())
    # Halves, since the extent itself may overflow.
    near = (high / 2 - low / 2).max()
    if far > _DRAWABLE[1] or near < _DRAWABLE[0]:
        raise InputError(
            "a plot cannot show coordinates beyond 1e305 or an extent below 1e-305; "
            "multiply all coordinates by a power of two first, which changes no triangle or cell"
        )


def require_values(values: Floats) -> None:
    """Reject values whose range overflows in the color scales of matplotlib; NaN is ignored."""
    if np.nanmax(np.abs(values), initial=0) > _DRAWABLE[1]:
        raise InputError(
            f"a plot cannot show values beyond {_DRAWABLE[1]:g}: divide all values by a power of "
            "two first"
        )


def pixels(ax: Any, low: Floats, high: Floats) -> tuple[int, int]:
    """Return the number of pixels that the data will have across and up."""
    box = ax.get_window_extent()
    width, height = (high - low).tolist()
    scale = min(box.width / width, box.height / height)
    return max(1, round(width * scale)), max(1, round(height * scale))


def figure_size(width: float, height: float, size: float, *, with_bar: bool) -> tuple[float, float]:
    """Return width and height that the data fill, with room for labels and a color bar."""
    ratio = min(max(width / height, 0.4), 2.5)
    beside, above = (1.9 if with_bar else 0.9), 0.9
    inner = size - max(beside, above)
    if ratio >= 1:
        return inner + beside, inner / ratio + above
    return inner * ratio + beside, inner + above


def thin(count: int, most: float = 1.0) -> float:
    """Return the width of the edges of triangles or cells: smaller the more there are."""
    return float(np.clip(30 / np.sqrt(max(count, 1)), 0.15, most))


def draw_dots(ax: Any, points: Floats, wanted: bool | None, *, count: int | None = None) -> None:
    """Draw points; with None, only if they (or `count`) are few enough to be distinguishable."""
    if wanted or (wanted is None and (len(points) if count is None else count) <= _MOST_DOTS):
        size = float(np.clip(60 / np.sqrt(max(len(points), 1)), 0.8, 5.0))
        ax.plot(*points.T, "o", color=_DOT, markersize=size, markeredgewidth=0, zorder=4)


def frame(ax: Any, low: Floats, high: Floats, title: str | None, *, margin: float) -> None:
    """Set limits, `margin` wider in the unit of the data, and ticks of the plain coordinates."""
    ticker = require("matplotlib.ticker", extra="plot", what="drawing")
    ax.set_xlim(low[0] - margin, high[0] + margin)
    ax.set_ylim(low[1] - margin, high[1] + margin)
    ax.set_aspect("equal")
    largest = float(np.abs((low, high)).max())
    plain = largest == 0 or 1e-4 < largest < 1e9
    across, up = pixels(ax, low, high)
    # A label needs about an inch across, so that long coordinates do not overlap.
    for axis, size, inches in ((ax.xaxis, across, 1.0), (ax.yaxis, up, 0.5)):
        bins = int(np.clip(size / ax.figure.dpi / inches, 1, 7))
        axis.set_major_locator(ticker.MaxNLocator(nbins=bins, steps=[1, 2, 5, 10]))
        formatter = ticker.ScalarFormatter(useOffset=False)
        formatter.set_scientific(not plain)
        axis.set_major_formatter(formatter)
    if title:
        ax.set_title(title, fontsize="medium")


def axis_names(crs: str | None) -> tuple[str, str]:
    """Return the names of the axes of a reference system, with the unit."""
    names = {"east": "x", "north": "y"}
    if crs is None:
        return names["east"], names["north"]
    try:
        import pyproj

        axes = pyproj.CRS.from_user_input(crs).axis_info
    except Exception:  # a missing label is not worth an error
        return names["east"], names["north"]
    for axis in axes:
        if axis.direction in names:
            names[axis.direction] = f"{axis.name} ({axis.unit_name})"
    return names["east"], names["north"]
