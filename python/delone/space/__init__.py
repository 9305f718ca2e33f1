"""3-D triangulations: topology, geometry and quality of tetrahedra.

`topology` needs no coordinates, `geometry` measures, `quality` judges, `location` locates points,
and `dimension` is the table of these functions. `plane` triangulates 3-D points of one plane.
"""

from delone.space.plane import PlaneTriangulation

__all__ = ["PlaneTriangulation"]
