"""The plotters of 3-D plots."""

from __future__ import annotations

from typing import Any

from delone._arrays import as_optional_flag
from delone.errors import InputError
from delone.extras import require

__all__ = ["aim", "new_plotter", "quiet"]

_SIZE = (900, 760)


def new_plotter(ax: Any, *, off_screen: bool | None) -> Any:
    """Return the given plotter; for None, a new one."""
    pyvista = require("pyvista", extra="pyvista", what="drawing in 3-D")
    hidden = as_optional_flag(off_screen, name="off_screen")
    if ax is not None:
        if hidden is not None:
            raise InputError("off_screen is for a new plotter: give it to that of ax")
        return ax
    plotter = pyvista.Plotter(off_screen=hidden, window_size=list(_SIZE))
    plotter.set_background("white")
    return plotter


def quiet() -> Any:
    """Return a context in which VTK does not warn that there is no screen."""
    return require("pyvista", extra="pyvista", what="drawing in 3-D").vtk_verbosity("error")


def aim(plotter: Any) -> None:
    """Turn the camera away from the axes, so that no face is seen edge on."""
    plotter.camera_position = "xz"
    plotter.camera.azimuth, plotter.camera.elevation = 40, 20
    plotter.reset_camera()
    plotter.camera.zoom(1.25)
