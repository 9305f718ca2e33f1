"""Plots as a file format: PNG and SVG by `delone.plot`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import FileFormatError
from delone.extras import require

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike

    from delone.io.registry import Mesh

__all__ = ["require_libraries", "write_mesh"]

# With fewer triangles, light and shadow show the triangles instead of the terrain.
_MANY = 2000


def require_libraries(suffix: str) -> None:
    """Import what drawing needs."""
    require("matplotlib.figure", extra="plot", what="drawing pictures")


def write_mesh(
    path: Path,
    triangulation: Mesh,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    edges: bool = False,
    attributes: Mapping[str, ArrayLike] | None = None,
) -> None:
    """Draw a triangulation into a file; a plot shows both edges and triangles."""
    if triangulation.ndim == 3:
        _draw_solid(path, triangulation, attributes)
        return
    from delone.plot.picture import draw_picture
    from delone.plot.protocols import is_quality_mesh

    if attributes:
        raise FileFormatError("a plot shows one value for each point: give it as z")
    # Heights are terrain, but on a quality mesh they are a field.
    lit = not is_quality_mesh(triangulation) and triangulation.nsimplex >= _MANY
    draw_picture(path, triangulation, z=z, crs=crs, shade=lit)


def _draw_solid(
    path: Path, triangulation: Mesh, attributes: Mapping[str, ArrayLike] | None
) -> None:
    """Draw the tetrahedra in front of a cut through the middle, in colors of their volumes."""
    from delone.plot import draw

    if attributes:
        raise FileFormatError("a plot of tetrahedra shows their volumes and no attributes")
    mesh: Any = triangulation
    # PyVista chooses the format by the suffix, which a temporary file does not have.
    picture = path.with_name(path.name + ".png")
    # Triangulations without volumes have a single color.
    with np.errstate(divide="ignore"):
        size = np.log10(getattr(mesh, "volumes", 0.0))
    draw(picture, mesh, values=size if np.isfinite(size).all() else None, cut="x", colorbar=False)
    picture.replace(path)
