"""Voronoi diagrams in 2 to 8 dimensions, clipped to an outline or polyhedron in 2-D and 3-D.

`diagram` contains the class, which stores the `cells` of its dimension: `plane`, `space` or
`higher`. `sites` contains their triangulation, `dual` and `torus` the arrays of 2-D diagrams,
`rows` lists of vertices, and `results` what is returned besides arrays. 2-D cells are cut to an
`outline` by `clipping`, with `pieces` and `overlay`, 3-D cells (`bodies`) to one of `polyhedra`;
`thin` finds the cells that rounding has emptied. `line` finds the nearest of collinear sites;
`centroidal` contains Lloyd's method.
"""

from delone.voronoi.centroidal import LloydResult, lloyd
from delone.voronoi.diagram import Voronoi
from delone.voronoi.polyhedra import Polyhedron
from delone.voronoi.results import Cell, Neighbors, PolyhedralCell, Rays
from delone.voronoi.thin import ThinCellWarning

__all__ = [
    "Cell",
    "LloydResult",
    "Neighbors",
    "PolyhedralCell",
    "Polyhedron",
    "Rays",
    "ThinCellWarning",
    "Voronoi",
    "lloyd",
]
