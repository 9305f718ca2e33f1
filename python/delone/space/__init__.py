"""3-D triangulations: topology, geometry and quality of tetrahedra.

`topology` needs no coordinates, `geometry` measures, `quality` judges, `location` finds points,
`plane` triangulates points of one plane in space, and `spatial` is the base of `delone.Delaunay`
that puts them to use.
"""

from delone.space.location import SpaceLocation
from delone.space.plane import PlaneTriangulation

__all__ = ["PlaneTriangulation", "SpaceLocation"]
