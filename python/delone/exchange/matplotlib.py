"""matplotlib triangulations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone._base.extras import require
from delone.exchange.parts import kind_of, parts_of

if TYPE_CHECKING:
    from delone.exchange.parts import Given

__all__ = ["to_matplotlib"]


def to_matplotlib(mesh: Given) -> Any:
    """Return the `matplotlib.tri.Triangulation` of triangles in 2-D."""
    tri = require("matplotlib.tri", extra="plot", what="to_matplotlib")
    parts = parts_of(mesh)
    kind_of(parts, what="a triangulation of matplotlib", kinds=("triangles",))
    return tri.Triangulation(*parts.points.T, triangles=parts.simplices)
