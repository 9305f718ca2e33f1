"""3-D triangulations: topology, geometry and quality of tetrahedra.

`topology` needs no coordinates, `geometry` computes measures, `quality` assesses shapes, `location`
locates points, and `dimension` is the table of these functions. `plane` triangulates coplanar 3-D
points.
"""

from delone._tiling.space.plane import PlaneTriangulation

__all__ = ["PlaneTriangulation"]
