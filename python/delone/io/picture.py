"""Pictures as one more format of files: PNG and SVG by `delone.plot` (extra ``plot``)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from delone.errors import FileFormatError
from delone.io.extras import require

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike

    from delone.io.registry import Mesh

__all__ = ["require_libraries", "write_mesh"]


def require_libraries() -> None:
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
    from delone.plot import draw_picture

    if attributes:
        raise FileFormatError("a picture shows one value for each point: give it as z")
    draw_picture(path, triangulation, z=z, crs=crs)
