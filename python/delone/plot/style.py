"""Line styles and colors of callers, which become properties of matplotlib's artists."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.extras import require
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

__all__ = ["EDGES", "require_style", "restyle"]

# What the artists of edges or cells are marked with.
EDGES = "edges"
# Properties that position an artist, or that a drawing uses itself.
_RESERVED = {
    "animated",
    "array",
    "axes",
    "clip_box",
    "clip_on",
    "clip_path",
    "figure",
    "gid",
    "norm",
    "offset_transform",
    "offsets",
    "paths",
    "rasterized",
    "transform",
    "url",
    "urls",
}


def require_style(style: Mapping[str, Any], what: str, known: Iterable[str]) -> None:
    """Reject what is neither one of the `known` options nor a property of lines."""
    if not style:
        return
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    for name in style:
        if name in _RESERVED or not hasattr(collections.LineCollection, f"set_{name}"):
            raise InputError(
                f"{name} is not an option of plotting {what}; its options are "
                f"{', '.join(known)}, and properties of matplotlib's lines such as color, "
                "linewidth, linestyle, alpha and zorder"
            )


def restyle(artists: Iterable[Any], style: Mapping[str, Any]) -> None:
    """Give artists properties of lines; the color of a polygon is that of its edge."""
    if not style:
        return
    line = require("matplotlib.collections", extra="plot", what="drawing").LineCollection
    for artist in artists:
        own = dict(style)
        if "color" in own and not isinstance(artist, line):
            own["edgecolor"] = own.pop("color")
        try:
            artist.set(**own)
        except (AttributeError, TypeError, ValueError) as error:
            shown = ", ".join(f"{name}={value!r:.60}" for name, value in style.items())
            raise InputError(f"matplotlib does not take {shown}: {error}") from error
