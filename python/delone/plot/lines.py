"""Plots of lines: contours on a map, and profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.errors import InputError
from delone.plot.axes import new_axes
from delone.plot.style import require_style, restyle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._types import Floats

__all__ = ["plot_lines", "plot_profile"]


def plot_lines(lines: Sequence[Floats], widths: Floats, ax: Any = None, **style: Any) -> Any:
    """Plot lines, (k, 2) each, on a map."""
    require_style(style, "contours", ("ax",))
    axes = new_axes(ax)
    from matplotlib.collections import LineCollection

    drawn = LineCollection(lines, colors="#6b4226", linewidths=widths)
    restyle([drawn], style)
    axes.add_collection(drawn, autolim=True)
    axes.autoscale_view()
    axes.set_aspect("equal")
    return axes


def plot_profile(distances: Floats, z: Floats, ax: Any = None, **style: Any) -> Any:
    """Plot heights over distances."""
    axes = new_axes(ax)
    (line,) = axes.plot(distances, z)
    try:
        line.set(**style)
    except (AttributeError, TypeError, ValueError) as error:
        shown = ", ".join(f"{name}={value!r:.60}" for name, value in style.items())
        raise InputError(f"a line of matplotlib does not take {shown}: {error}") from error
    axes.set(xlabel="distance", ylabel="height")
    return axes
