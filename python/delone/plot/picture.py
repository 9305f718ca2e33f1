"""Triangulations in files of PNG and SVG; nothing here needs a display."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from delone.atomic import replacing
from delone.constrained.delaunay import ConstrainedDelaunay
from delone.extras import require
from delone.io.heights import as_values
from delone.plot.mesh import plot, require_drawable, require_flat
from delone.refine.meshed import Mesh as QualityMesh

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from numpy.typing import ArrayLike

    from delone.plot.mesh import Mesh

__all__ = ["axis_names", "draw_picture", "save_picture"]


def save_picture(
    path: str | os.PathLike[str],
    triangulation: Mesh,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    title: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
    **options: Any,
) -> None:
    """Draw a triangulation into a PNG or SVG file, whole or not at all.

    Parameters
    ----------
    path : str or path-like
        The file.
    triangulation : Delaunay, RegularTriangulation, ConstrainedDelaunay or Mesh, in the plane
        What to draw.
    z : array_like of float, shape (n,), optional
        Heights: triangles are coloured by them.
    crs : str, optional
        Coordinate reference system, which names the axes where pyproj is installed.
    title : str, optional
        By default the numbers of points and triangles.
    size : float, optional
        Longer side of the picture in inches.
    dpi : int, optional
        Pixels per inch.
    **options
        As in `plot`.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    InputError
        As in `plot`.
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import Delaunay
    >>> from delone.plot import save_picture
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "mesh.png"
    ...     save_picture(file, Delaunay([(0, 0), (4, 0), (4, 3)]))
    ...     file.read_bytes()[1:4]
    b'PNG'
    """
    with replacing(path) as beside:
        draw_picture(
            beside, triangulation, z=z, crs=crs, title=title, size=size, dpi=dpi, **options
        )


def draw_picture(
    path: Path,
    triangulation: Mesh,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    title: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
    **options: Any,
) -> None:
    """Draw into the file itself; `save_picture` is the same by way of a temporary file."""
    figure_module = require("matplotlib.figure", extra="plot", what="drawing")
    require_flat(triangulation)
    require_drawable(triangulation, as_values(z, triangulation.npoints))
    width, height = _figure_size(triangulation, size, with_bar=z is not None)
    if isinstance(triangulation, QualityMesh):
        figure = figure_module.Figure(figsize=(width, height + 2.5), dpi=dpi, layout="constrained")
        ax, below = figure.subplots(2, 1, height_ratios=(height, 2.5))
        triangulation.plot_quality(below)
    else:
        figure = figure_module.Figure(figsize=(width, height), dpi=dpi, layout="constrained")
        ax = figure.add_subplot()
    plot(triangulation, ax, z=z, title=title or _numbers(triangulation), **options)
    xlabel, ylabel = axis_names(crs)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    figure.savefig(path, dpi=dpi, facecolor="white")


def _numbers(triangulation: Mesh) -> str:
    numbers = f"{triangulation.npoints:,} points, {triangulation.nsimplex:,} triangles"
    if isinstance(triangulation, ConstrainedDelaunay):
        numbers += f", {len(triangulation.input_segments):,} segments"
    return numbers


def _figure_size(triangulation: Mesh, size: float, *, with_bar: bool) -> tuple[float, float]:
    """Return width and height such that the data fill them, labels and colour bar beside."""
    width, height = (triangulation.max_bound - triangulation.min_bound).tolist()
    ratio = min(max(width / height, 0.4), 2.5)
    beside, above = (1.9 if with_bar else 0.9), 0.9
    inner = size - max(beside, above)
    if ratio >= 1:
        return inner + beside, inner / ratio + above
    return inner * ratio + beside, inner + above


def axis_names(crs: str | None) -> tuple[str, str]:
    """Return what the axes are called in a reference system, with the unit."""
    names = {"east": "x", "north": "y"}
    if crs is None:
        return names["east"], names["north"]
    try:
        import pyproj

        axes = pyproj.CRS.from_user_input(crs).axis_info
    except Exception:  # a label is not worth an error
        return names["east"], names["north"]
    for axis in axes:
        if axis.direction in names:
            names[axis.direction] = f"{axis.name} ({axis.unit_name})"
    return names["east"], names["north"]
