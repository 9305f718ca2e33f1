"""2-D plots of triangulations with matplotlib (extra ``plot``).

Where triangles can be seen they are drawn; where they are smaller than a few pixels the surface (or
the density of points) is drawn as an image, so that a million points take a second and the picture
is no black square. Nothing here needs a display: `save_picture` draws without pyplot.

`mesh` draws on axes, `picture` into files; `cartography` has regions and segments, `shading` the
pixels and their light, `colours` the scales, `histograms` angles,
`predictions` the results of cross-validation.
"""

from delone.plot.histograms import draw_angles, draw_histograms
from delone.plot.mesh import plot
from delone.plot.picture import save_picture
from delone.plot.predictions import draw_predictions

__all__ = ["draw_angles", "draw_histograms", "draw_predictions", "plot", "save_picture"]
