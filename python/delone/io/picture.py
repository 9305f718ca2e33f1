"""Plots as a file format: PNG and SVG with `delone.plot` (extra ``plot``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.extras import require
from delone.errors import FileFormatError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from delone.exchange.parts import HasParts
    from delone.io.content import Wanted

__all__ = ["require_libraries", "write_mesh"]

# With fewer triangles, shading shows the triangles rather than the terrain.
_MANY = 2000


def require_libraries(suffix: str) -> None:
    """Import the plotting library."""
    require("matplotlib.figure", extra="plot", what="plotting")


def write_mesh(path: Path, triangulation: HasParts, wanted: Wanted) -> None:
    """Draw a triangulation into a file; a plot shows both edges and triangles."""
    if triangulation.points.shape[1] == 3:
        _draw_solid(path, triangulation, wanted.attributes)
        return
    from delone.plot.picture import draw_picture
    from delone.plot.protocols import is_quality_mesh

    if wanted.attributes:
        raise FileFormatError("a plot shows one value for each point: give it as z")
    mesh: Any = triangulation
    # Heights are terrain, but on a quality mesh they are a field.
    lit = not is_quality_mesh(mesh) and len(mesh.simplices) >= _MANY
    draw_picture(path, mesh, z=wanted.z, crs=wanted.crs, shade=lit)


def _draw_solid(
    path: Path, triangulation: HasParts, attributes: Mapping[str, ArrayLike] | None
) -> None:
    """Draw a surface, or the tetrahedra in front of a cut.

    Those inside a given surface have the colors of their regions, others those of their volumes.
    """
    from delone.plot import draw

    if attributes:
        raise FileFormatError("a plot of tetrahedra shows regions or volumes and no attributes")
    mesh: Any = triangulation
    # PyVista chooses the format by the suffix, which a temporary file does not have.
    picture = path.with_name(path.name + ".png")
    cut = "x" if mesh.simplices.shape[1] == 4 else "none"
    draw(picture, mesh, values=_values(mesh), cut=cut, colorbar=False)
    picture.replace(path)


def _values(mesh: Any) -> NDArray[Any] | None:
    """Return what the colors of simplices show; None for a single color."""
    if len(getattr(mesh, "input_faces", ())):
        return mesh.region if len(np.unique(mesh.region)) > 1 else None
    # Surfaces and triangulations without volumes have a single color.
    with np.errstate(divide="ignore"):
        size = np.log10(getattr(mesh, "volumes", 0.0))
    return size if np.isfinite(size).all() else None
