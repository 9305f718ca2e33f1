"""Plots of lines: contours on a map, and profiles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError
from delone.plot.axes import new_axes
from delone.plot.style import require_style, restyle

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["plot_labels", "plot_lines", "plot_profile", "plot_profiles", "plot_stations"]

# Stations that are labeled.
_LABELS = 30


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


def plot_labels(points: Floats, angles: Floats, texts: Sequence[str], axes: Any) -> None:
    """Write texts along lines, with a gap in the line below each."""
    for place, angle, text in zip(points, angles, texts, strict=True):
        axes.text(
            *place,
            text,
            rotation=angle,
            rotation_mode="anchor",
            transform_rotates_text=True,
            ha="center",
            va="center",
            fontsize=7,
            color="#6b4226",
            clip_on=True,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
        )


def plot_profile(distances: Floats, z: Floats, ax: Any = None, **style: Any) -> Any:
    """Plot heights over distances."""
    axes = new_axes(ax)
    _set(axes.plot(distances, z), style)
    axes.set(xlabel="distance", ylabel="height")
    return axes


def plot_profiles(
    distances: Floats, z: Floats, names: Sequence[str], ax: Any = None, **style: Any
) -> Any:
    """Plot the heights of several surfaces over distances, with a legend."""
    axes = plot_profile(distances, z, ax, **style)
    for line, name in zip(axes.lines[-len(names) :], names, strict=True):
        line.set_label(name)
    axes.legend()
    return axes


def plot_stations(
    ends: Floats, centers: Floats, stations: Floats, ax: Any = None, **style: Any
) -> Any:
    """Plot cross sections in plan, with their stations at the right ends."""
    axes = plot_lines(list(ends), np.full(len(ends), 0.8), ax, **style)
    axes.plot(*centers.T, color="0.5", linewidth=0.8, linestyle="--")
    step = -(-len(stations) // _LABELS)
    for (x, y), station in zip(ends[::step, 1], stations[::step], strict=True):
        axes.annotate(
            f"{station:.6g}", (x, y), fontsize=8, textcoords="offset points", xytext=(2, 2)
        )
    return axes


def _set(lines: Sequence[Any], style: dict[str, Any]) -> None:
    try:
        for line in lines:
            line.set(**style)
    except (AttributeError, TypeError, ValueError) as error:
        shown = ", ".join(f"{name}={value!r:.60}" for name, value in style.items())
        raise InputError(f"a line of matplotlib does not take {shown}: {error}") from error
