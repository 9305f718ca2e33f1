"""Predictions against the predicted values: the plot of a cross-validation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.plot.axes import new_axes

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["draw_predictions"]

_DOT, _LINE = "#2f6f9f", "#b3372f"


def draw_predictions(
    values: Floats, predicted: Floats, *, ax: Any = None, title: str | None = None
) -> Any:
    """Plot predictions against values, with the line of equality.

    Parameters
    ----------
    values, predicted : ndarray of float64, shape (n,)
        Values and their predictions. Pairs that are not finite are left out.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.
    title : str, optional
        Title of the axes.

    Returns
    -------
    matplotlib Axes
        Where it is drawn.

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
    ax = new_axes(ax)
    known = np.isfinite(values) & np.isfinite(predicted)
    x, y = values[known], predicted[known]
    # Smaller and fainter if there are many, so that dense parts stand out.
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
