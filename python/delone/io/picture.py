"""Pictures as one more format of files: PNG and SVG by `delone.plot` (extra ``plot``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.delaunay import Delaunay
from delone.errors import FileFormatError
from delone.extras import require

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike

    from delone.io.registry import Mesh

__all__ = ["require_libraries", "write_mesh"]

# With fewer triangles, light and shadow show the triangles rather than the terrain.
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
    """Draw a triangulation into a file; a picture shows edges and triangles alike."""
    if triangulation.ndim == 3:
        _draw_space(path, triangulation, attributes)
        return
    from delone.plot.picture import draw_picture

    if attributes:
        raise FileFormatError("a picture shows one value for each point: give it as z")
    # Heights are terrain, but on a quality mesh they are a field.
    terrain = isinstance(triangulation, Delaunay | ConstrainedDelaunay)
    lit = terrain and triangulation.nsimplex >= _MANY
    draw_picture(path, triangulation, z=z, crs=crs, shade=lit)


def _draw_space(
    path: Path, triangulation: Mesh, attributes: Mapping[str, ArrayLike] | None
) -> None:
    """Draw tetrahedra, those before a cut through the middle, in colours of their volumes."""
    from delone.scene import draw

    if attributes:
        raise FileFormatError("a picture of tetrahedra shows their volumes, and no attributes")
    mesh: Any = triangulation
    # pyvista tells formats by suffixes, and what replaces a file has one of its own.
    picture = path.with_name(path.name + ".png")
    # Triangulations of others have no volumes, and one colour.
    with np.errstate(divide="ignore"):
        size = np.log10(getattr(mesh, "volumes", 0.0))
    draw(picture, mesh, values=size if np.isfinite(size).all() else None, cut="x", bar=False)
    picture.replace(path)
