"""3-D plots as image files and arrays, without a window."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from delone.errors import InputError
from delone.plot.dispatch import plot
from delone.plot.plotter import aim, quiet
from delone.plot.protocols import kind_of

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from delone.plot.protocols import Cells3, Simplices

__all__ = ["draw", "image"]

# Suffixes of the formats in which PyVista writes images.
_FORMATS = (".png", ".jpeg", ".jpg", ".bmp", ".tif", ".tiff")


def draw(path: str | os.PathLike[str], mesh: Simplices | Cells3, **options: Any) -> None:
    """Draw a 3-D plot to a file, without a window.

    Parameters
    ----------
    path : str or path-like
        The file: PNG, JPEG, BMP or TIFF by its suffix.
    mesh : Simplices or Cells3
        What to draw: anything in 3-D that `plot` draws.
    **options
        As for `plot`.

    Raises
    ------
    InputError
        As for `plot`; the object is 2-D; or the suffix is that of another format.
    MissingExtraError
        PyVista is not installed.

    See Also
    --------
    save_picture : The same for 2-D triangulations.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from delone import ConvexHull, datasets, plot
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder) / "hull.png"
    ...     plot.draw(file, ConvexHull(datasets.uniform(50, ndim=3)))
    ...     file.read_bytes()[1:4]
    b'PNG'
    """
    suffix = Path(path).suffix
    if suffix.lower() not in _FORMATS:
        raise InputError(f"path must end with {', '.join(_FORMATS)}; got {suffix!r:.80}")
    with _drawn(mesh, options) as plotter:
        plotter.screenshot(str(path))


def image(mesh: Simplices | Cells3, **options: Any) -> NDArray[np.uint8]:
    """Draw a 3-D plot to an array, without a window.

    Parameters
    ----------
    mesh : Simplices or Cells3
        What to draw: anything in 3-D that `plot` draws.
    **options
        As for `plot`.

    Returns
    -------
    ndarray of uint8, shape (height, width, 3)
        Red, green and blue, for matplotlib's ``imshow``, for example.

    Raises
    ------
    InputError
        As for `plot`, or the object is 2-D.
    MissingExtraError
        PyVista is not installed.

    Examples
    --------
    >>> from delone import ConvexHull, datasets, plot
    >>> plot.image(ConvexHull(datasets.uniform(50, ndim=3))).shape
    (760, 900, 3)
    """
    with _drawn(mesh, options) as plotter:
        picture: NDArray[np.uint8] = np.array(plotter.screenshot(return_img=True))
    return picture


@contextmanager
def _drawn(mesh: Any, options: dict[str, Any]) -> Iterator[Any]:
    """Draw on a plotter without a window, and finally close it."""
    if kind_of(mesh) in ("triangles", "hull", "periodic", "cells2"):
        raise InputError(f"this {type(mesh).__name__} is 2-D: delone.plot.plot draws it")
    with quiet():
        plotter = plot(mesh, off_screen=True, **options)
        try:
            aim(plotter)
            yield plotter
        finally:
            plotter.close()
