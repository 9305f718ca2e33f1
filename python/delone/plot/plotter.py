"""The plotters of 3-D plots."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from delone._base.arrays import as_optional_flag
from delone._base.extras import require
from delone.errors import DtypeError, InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["add_points", "aim", "as_pyvista_cmap", "new_plotter", "quiet"]

_SIZE = (900, 760)
_POINT = "#08306b"


def new_plotter(ax: Any, *, off_screen: bool | None) -> Any:
    """Return the given plotter; for None, a new one."""
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    hidden = as_optional_flag(off_screen, name="off_screen")
    if ax is not None:
        if hidden is not None:
            raise InputError("off_screen is for a new plotter: give it to that of ax")
        if not isinstance(ax, pyvista.BasePlotter):
            raise DtypeError(
                f"ax must be a PyVista plotter for a 3-D plot, or None; got {type(ax).__name__}"
            )
        return ax
    plotter = pyvista.Plotter(off_screen=hidden, window_size=list(_SIZE))
    plotter.set_background("white")
    return plotter


def as_pyvista_cmap(cmap: Any) -> Any:
    """Return a colormap for PyVista; names are those of matplotlib or another library."""
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    if cmap is None or isinstance(cmap, pyvista.LookupTable):
        return cmap
    known = require("pyvista.plotting.colors", extra="pyvista", what="drawing in 3-D")
    try:
        return known.get_cmap_safe(cmap)
    except (ValueError, TypeError, ImportError) as error:
        raise InputError(
            "cmap must be a Colormap, a list of colors or the name of a colormap, such as "
            f"'viridis', got {cmap!r:.60}"
        ) from error


def add_points(plotter: Any, points: NDArray[np.float64]) -> None:
    """Draw points as small balls."""
    plotter.add_points(np.array(points), color=_POINT, point_size=6, render_points_as_spheres=True)


def quiet() -> Any:
    """Return a context in which VTK does not warn that there is no screen."""
    return require("pyvista", extra="pyvista", what="drawing in 3-D").vtk_verbosity("error")


def aim(plotter: Any) -> None:
    """Turn the camera away from the axes, so that no face is seen edge-on."""
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 40, 20
    plotter.reset_camera()
    plotter.camera.zoom(1.25)
