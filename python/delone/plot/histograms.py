"""Histograms of the angles of triangles and tetrahedra."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.plot.axes import new_axes

if TYPE_CHECKING:
    from delone._base.types import Floats

__all__ = ["draw_angles", "draw_histograms"]

_BOUND = "#b3372f"


def draw_angles(
    smallest: Floats, largest: Floats, *, ax: Any = None, bound: float | None = None
) -> Any:
    """Draw the histogram of the smallest and the largest angles of triangles.

    Parameters
    ----------
    smallest, largest : ndarray of float64, shape (m,)
        Angles in degrees.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.
    bound : float, optional
        An angle to mark.

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
    >>> from delone.plot import draw_angles
    >>> draw_angles(np.array([45.0]), np.array([90.0])).get_xlabel()
    'angle in degrees'
    """
    ax = new_axes(ax)
    bins = np.arange(0, 181, 2)
    for angles, color, label in (
        (smallest, "#2f6f9f", "smallest angle"),
        (largest, "#d98f3d", "largest angle"),
    ):
        ax.hist(angles, bins=bins, color=color, alpha=0.85, label=label)
    if bound is not None:
        ax.axvline(bound, color=_BOUND, linewidth=1.2, linestyle="--", label=f"bound {bound:g}°")
    ax.set(xlabel="angle in degrees", ylabel="triangles", xlim=(0, 180), xticks=range(0, 181, 30))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False)
    return ax


def draw_histograms(
    bounds: Floats, counts: dict[str, Any], *, ax: Any = None, bound: float | None = None
) -> Any:
    """Draw histograms of smallest dihedral angles side by side, on a logarithmic scale.

    Parameters
    ----------
    bounds : ndarray of float64, shape (k + 1,)
        Bounds of the bins in degrees.
    counts : dict of ndarray of int64, shape (k,)
        Number of tetrahedra in each bin, by the label of the bars.
    ax : matplotlib Axes, optional
        Where to draw; by default on new axes.
    bound : float, optional
        An angle to mark.

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
    >>> from delone.plot import draw_histograms
    >>> counts = {"before": np.array([3, 1]), "after": np.array([0, 4])}
    >>> draw_histograms(np.array([0.0, 20, 40]), counts, bound=20).get_yscale()
    'log'
    """
    ax = new_axes(ax)
    wide = np.diff(bounds) / (len(counts) + 0.5)
    for k, (label, color) in enumerate(zip(counts, ("#d98f3d", "#2f6f9f"), strict=False)):
        left = bounds[:-1] + wide * (k + 0.25)
        ax.bar(left, counts[label], wide, align="edge", color=color, label=label)
    if bound is not None:
        ax.axvline(bound, color=_BOUND, linewidth=1.2, linestyle="--", label=f"goal {bound:g}°")
    ax.set(xlabel="smallest dihedral angle in degrees", ylabel="tetrahedra", yscale="log")
    # Space above the bars for the legend.
    most = max(int(np.max(each, initial=1)) for each in counts.values())
    ax.set(xlim=(bounds[0], bounds[-1]), ylim=(0.7, 5 * most))
    ax.spines[["top", "right"]].set_visible(False)
    ax.legend(frameon=False, ncols=len(counts) + 1, fontsize="small", loc="upper right")
    return ax
