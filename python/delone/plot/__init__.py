"""Plots of triangulations, meshes, hulls and diagrams: 2-D with matplotlib, 3-D with PyVista.

`plot` draws anything (extra ``plot``, and for 3-D extra ``pyvista``). Triangles are drawn if they
are large enough to see; if they are smaller than a few pixels, the surface (or the density of
points) is drawn as an image, so that a million points take a second. `save_picture`, `draw` and
`image` need no display.

The functions take any object that has the attributes listed in `protocols`.
"""

from delone.plot.dispatch import plot
from delone.plot.histograms import draw_angles, draw_histograms
from delone.plot.offscreen import draw, image
from delone.plot.picture import save_picture
from delone.plot.predictions import draw_predictions
from delone.plot.raster import plot_raster

__all__ = [
    "draw",
    "draw_angles",
    "draw_histograms",
    "draw_predictions",
    "image",
    "plot",
    "plot_raster",
    "save_picture",
]
