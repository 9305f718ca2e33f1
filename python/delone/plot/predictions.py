"""Predictions against the values that were predicted: the picture of a cross-validation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.extras import require

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["draw_predictions"]

_DOT, _LINE = "#2f6f9f", "#b3372f"


def draw_predictions(
    values: Floats, predicted: Floats, *, ax: Any = None, title: str | None = None
) -> Any:
    """Draw predictions over the values, with the line on which both are equal.

    Parameters
    ----------
    values, predicted : ndarray of float64, shape (n,)
        Values and what was predicted for them. Pairs that are not finite are left out.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.
    title : str, optional
        Title of the axes.

    Returns
    -------
    matplotlib Axes
        What was drawn on.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from delone.plot import draw_predictions
    >>> draw_predictions(np.array([1.0, 2.0]), np.array([1.1, np.nan])).get_xlabel()
    'value'
    """
    if ax is None:
        _, ax = require("matplotlib.pyplot", extra="plot", what="drawing").subplots()
    known = np.isfinite(values) & np.isfinite(predicted)
    x, y = values[known], predicted[known]
    # Smaller and fainter where there are many, so that dense parts can be told from thin ones.
    size = float(np.clip(120 / np.sqrt(max(len(x), 1)), 1.0, 5.0))
    look = {"color": _DOT, "markersize": size, "markeredgewidth": 0, "alpha": 0.2 + 0.12 * size}
    ax.plot(x, y, "o", **look)
    if len(x):
        ends = [min(x.min(), y.min()), max(x.max(), y.max())]
        ax.plot(ends, ends, color=_LINE, linewidth=1.0, zorder=3)
    ax.set(xlabel="value", ylabel="predicted from the others")
    ax.set_aspect("equal")
    ax.spines[["top", "right"]].set_visible(False)
    if title:
        ax.set_title(title, fontsize="medium")
    return ax
