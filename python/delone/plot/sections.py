"""Drawings of cross sections, side by side on equal scales."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.arrays import as_least
from delone._base.extras import require
from delone.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from delone._base.types import Floats

__all__ = ["draw_sections"]

# The size of one section in inches.
_WIDTH, _HEIGHT = 3.2, 1.9
# Maximum number of sections in one figure: more are not readable, and their axes take minutes.
_MOST = 200


def draw_sections(
    stations: Floats, tables: Sequence[tuple[Floats, Floats]], names: Sequence[str], columns: int
) -> Any:
    """Draw heights over offsets for each station."""
    pyplot = require("matplotlib.pyplot", extra="plot", what="drawing")
    across = min(as_least(columns, 1, name="columns"), len(tables))
    if len(tables) > _MOST:
        raise InputError(
            f"{len(tables):,} sections do not fit into one figure, at most {_MOST}: choose fewer "
            "stations, or plot single sections with sections[k].plot()"
        )
    down = -(-len(tables) // across)
    figure, grid = pyplot.subplots(
        down,
        across,
        figsize=(_WIDTH * across, _HEIGHT * down + 0.4),
        sharex=True,
        sharey=True,
        squeeze=False,
        layout="constrained",
    )
    for ax, station, (offsets, z) in zip(grid.flat, stations, tables, strict=False):
        lines = ax.plot(offsets, z, linewidth=1.2)
        ax.axvline(0.0, color="0.7", linewidth=0.7, linestyle="--")
        ax.set_title(f"{station:.6g}", fontsize=9)
        ax.tick_params(labelsize=8)
    for ax in list(grid.flat)[len(tables) :]:
        ax.remove()
    if len(names) > 1:
        figure.legend(lines, names, loc="outside upper center", ncols=len(names), fontsize=9)
    figure.supxlabel("offset", fontsize=9)
    figure.supylabel("height", fontsize=9)
    return figure
