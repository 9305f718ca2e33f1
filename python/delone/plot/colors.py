"""Colors of values: a scale that covers most of them, light and shadow, and the color bar."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import InputError

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["add_bar", "as_cmap", "scale", "shaded", "show"]

_LAND = ("#3d6f78", "#7fae93", "#d9dfb4", "#f3e3b3", "#e0a868", "#b9664a", "#8a3b3b")
_WATER = ("#0b1f4b", "#143f7d", "#2266a3", "#4695c0", "#86c3d4", "#cfe9dc")


def as_cmap(cmap: Any) -> Any:
    """Return a matplotlib colormap by its name; None for None."""
    matplotlib = require("matplotlib", extra="plot", what="drawing")
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    if cmap is None or isinstance(cmap, colors.Colormap):
        return cmap
    if isinstance(cmap, str) and cmap in matplotlib.colormaps:
        return matplotlib.colormaps[cmap]
    raise InputError(
        "cmap must be a Colormap or a name in matplotlib.colormaps, such as 'viridis', or None; "
        f"got {cmap!r:.60}"
    )


def scale(values: Floats, cmap: Any) -> Any:
    """Return a color scale that covers all but the lowest and the highest percent of the values."""
    colors = require("matplotlib.colors", extra="plot", what="drawing")
    cm = require("matplotlib.cm", extra="plot", what="drawing")
    known = values[np.isfinite(values)]
    low, high = np.quantile(known, [0.01, 0.99]).tolist()
    if not low < high:
        low, high = float(known.min()), float(known.max())
    if not low < high:
        low, high = low - 0.5, high + 0.5
    if cmap is None:
        palette = _WATER if known.max() <= 0 and low < 0 else _LAND
        cmap = colors.LinearSegmentedColormap.from_list("heights", palette)
    return cm.ScalarMappable(norm=colors.Normalize(low, high), cmap=cmap)


def shaded(rgb: Floats, light: Floats) -> Floats:
    """Darken away from the sun, lighten toward it; flat ground hardly changes its color."""
    strength = (0.30 + 0.95 * light)[..., None]
    return np.clip(np.where(strength < 1, rgb * strength, 1 - (1 - rgb) / strength), 0, 1)


def show(ax: Any, rgba: Floats, extent: tuple[float, float, float, float]) -> None:
    """Draw colors, (rows, columns, 4), as an image with the first row lowest."""
    image = np.round(rgba * 255).astype(np.uint8)
    ax.imshow(image, extent=extent, origin="lower", interpolation="auto", zorder=0)


def add_bar(ax: Any, mapped: Any, values: Floats, label: str) -> None:
    """Add the color bar of a scale, with a pointed end if values lie beyond it."""
    below = np.nanmin(values) < mapped.norm.vmin
    above = np.nanmax(values) > mapped.norm.vmax
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}
    bar = ax.figure.colorbar(
        mapped,
        ax=ax,
        label=label,
        extend=extend[int(below), int(above)],
        shrink=0.75,
        pad=0.02,
        aspect=30,
    )
    bar.outline.set_visible(False)
