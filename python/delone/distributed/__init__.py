"""Tiled triangulation: more points than fit into memory, on one machine or on a Dask cluster.

The union of the tiles is the Delaunay triangulation of all points, triangle for triangle. The pure
functions of arrays in `pure` make all decisions: `tiles` partitions the plane, `certify` and
`merge` decide which triangles are certain. The tasks in `stages` read and write files, `run` orders
them, and `executors` and `dask` distribute them.
"""

from delone.distributed.api import plan, triangulate
from delone.distributed.read.opened import TiledDelaunay, open
from delone.distributed.read.proof import TiledReport
from delone.distributed.read.tile import Tile
from delone.distributed.run.costs import Plan
from delone.distributed.run.run import Progress

__all__ = [
    "Plan",
    "Progress",
    "Tile",
    "TiledDelaunay",
    "TiledReport",
    "open",
    "plan",
    "triangulate",
]
