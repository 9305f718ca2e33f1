"""2-D and 3-D Voronoi diagrams, whole or clipped to an outline or polyhedron.

`diagram` has the class, `dual` the arrays of the core and of sites on one line, `cells` what a cell
is, `outline` where they end, `clipping` what that leaves of them, by `pieces` and `overlay`, and
`thin` which of them rounding has taken. `shapes` has geometries, tables and pictures, `centroidal`
Lloyd's method, `torus` periodic sets. Of space, `space` has the class, `bodies` what a cell is, and
`polyhedra` what cells are cut to.
"""

from delone.voronoi.bodies import SpaceCell, SpaceNeighbors
from delone.voronoi.cells import Cell, Neighbors, Rays
from delone.voronoi.centroidal import LloydResult, lloyd
from delone.voronoi.diagram import Voronoi
from delone.voronoi.space import SpaceVoronoi
from delone.voronoi.thin import ThinCellWarning

__all__ = [
    "Cell",
    "LloydResult",
    "Neighbors",
    "Rays",
    "SpaceCell",
    "SpaceNeighbors",
    "SpaceVoronoi",
    "ThinCellWarning",
    "Voronoi",
    "lloyd",
]
