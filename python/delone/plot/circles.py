"""The circles through the corners of triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import InputError

if TYPE_CHECKING:
    from delone._base.types import Floats
    from delone.plot.protocols import Triangles

__all__ = ["bounds_with_circles", "draw_circles", "require_few"]

_MOST_CIRCLES = 3000
_FEW_CIRCLES = 60  # few enough to show each circle completely, with its center
_CIRCLE = "#d98b2b"


def require_few(mesh: Triangles) -> None:
    """Reject more triangles than circles can be distinguished."""
    if mesh.nsimplex > _MOST_CIRCLES:
        raise InputError(
            f"the circles of {mesh.nsimplex} triangles would hide each other; "
            f"circumcircles is for up to {_MOST_CIRCLES}"
        )


def draw_circles(ax: Any, mesh: Triangles) -> None:
    """Draw the circles, and their centers if they are few."""
    collections = require("matplotlib.collections", extra="plot", what="drawing")
    centers, radii = _circles(mesh)
    circles = collections.EllipseCollection(
        2 * radii,
        2 * radii,
        np.zeros(len(radii)),
        units="xy",
        offsets=centers,
        transOffset=ax.transData,
        facecolors="none",
        edgecolors=_CIRCLE,
        linewidths=0.7,
        alpha=0.8,
        zorder=2,
    )
    ax.add_collection(circles, autolim=False)
    if len(centers) <= _FEW_CIRCLES:
        ax.plot(*centers.T, "+", color=_CIRCLE, markersize=5, scalex=False, scaley=False, zorder=2)


def bounds_with_circles(mesh: Triangles) -> tuple[Floats, Floats]:
    """Return the low and high limits that show the circles, while the points remain visible."""
    low, high = mesh.min_bound, mesh.max_bound
    centers, radii = _circles(mesh)
    # The circles of flat triangles are of any size.
    share = 1.0 if len(radii) <= _FEW_CIRCLES else 0.15
    limit = share * float((high - low).max())
    lowest = (centers - radii[:, None]).min(axis=0, initial=np.inf)
    highest = (centers + radii[:, None]).max(axis=0, initial=-np.inf)
    return (
        np.minimum(np.maximum(lowest, low - limit), low),
        np.maximum(np.minimum(highest, high + limit), high),
    )


def _circles(mesh: Triangles) -> tuple[Floats, Floats]:
    centers = mesh.circumcenters
    radii = np.hypot(*(centers - mesh.points[mesh.simplices[:, 0]]).T)
    drawn = np.isfinite(centers).all(axis=1) & np.isfinite(radii)
    return centers[drawn], radii[drawn]
