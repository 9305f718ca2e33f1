"""2-D triangulations in PNG and SVG files; no display is needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from delone._base.atomic import replacing
from delone._base.extras import require
from delone._base.values import as_values
from delone.errors import InputError
from delone.plot.axes import axis_names, figure_size
from delone.plot.protocols import has, is_quality_mesh
from delone.plot.triangles import plot, require_drawable, require_flat

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from numpy.typing import ArrayLike

    from delone.plot.protocols import Triangles

__all__ = ["draw_picture", "save_picture"]


def save_picture(
    path: str | os.PathLike[str],
    mesh: Triangles,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    title: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
    **options: Any,
) -> None:
    """Draw a 2-D triangulation to a PNG or SVG file, atomically.

    Parameters
    ----------
    path : str or path-like
        The file.
    mesh : Triangles
        What to draw: a `Delaunay`, `RegularTriangulation`, `ConstrainedDelaunay` or `Mesh`.
    z : array_like of float, shape (n,), optional
        Heights: triangles are colored by them.
    crs : str, optional
        Coordinate reference system, which names the axes if pyproj is installed.
    title : str, optional
        By default the numbers of points and triangles.
    size : float, optional
        Longer side of the image in inches.
    dpi : int, optional
        Pixels per inch.
    **options
        As for `plot`.

    Raises
    ------
    MissingExtraError
        matplotlib is not installed.
    InputError
        As for `plot`, or matplotlib does not write files with this suffix.
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
        draw_picture(beside, mesh, z=z, crs=crs, title=title, size=size, dpi=dpi, **options)


def draw_picture(
    path: Path,
    mesh: Triangles,
    *,
    z: ArrayLike | None = None,
    crs: str | None = None,
    title: str | None = None,
    size: float = 10.0,
    dpi: int = 160,
    **options: Any,
) -> None:
    """Draw directly into the file; `save_picture` uses a temporary file."""
    _require_format(path.suffix)
    figure_module = require("matplotlib.figure", extra="plot", what="drawing")
    require_flat(mesh)
    require_drawable(mesh, as_values(z, mesh.npoints))
    across, up = (mesh.max_bound - mesh.min_bound).tolist()
    width, height = figure_size(across, up, size, with_bar=z is not None)
    if is_quality_mesh(mesh):
        figure = figure_module.Figure(figsize=(width, height + 2.5), dpi=dpi, layout="constrained")
        ax, below = figure.subplots(2, 1, height_ratios=(height, 2.5))
        cast("Any", mesh).plot_quality(below)
    else:
        figure = figure_module.Figure(figsize=(width, height), dpi=dpi, layout="constrained")
        ax = figure.add_subplot()
    plot(mesh, ax, z=z, title=title or _numbers(mesh), **options)
    xlabel, ylabel = axis_names(crs)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    figure.savefig(path, dpi=dpi, facecolor="white")


def _require_format(suffix: str) -> None:
    """Reject the suffix of a file if matplotlib does not write its format."""
    bases = require("matplotlib.backend_bases", extra="plot", what="drawing")
    known = bases.FigureCanvasBase.get_supported_filetypes()
    if suffix[1:].lower() not in known:
        raise InputError(f"path must end with .{', .'.join(sorted(known))}; got {suffix!r:.80}")


def _numbers(mesh: Triangles) -> str:
    numbers = f"{mesh.npoints:,} points, {mesh.nsimplex:,} triangles"
    if has(mesh, "input_segments"):
        numbers += f", {len(cast('Any', mesh).input_segments):,} segments"
    return numbers
