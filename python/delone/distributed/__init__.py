"""Triangulations in tiles: more points than memory holds, on one machine or on a Dask cluster.

The union of the tiles is the Delaunay triangulation of all points, triangle for triangle: `tiles`
cuts the plane, `certify` and `merge` decide what is certain, `stages` are the tasks, `run` their
order. Pure functions of arrays decide; tasks read and write files; `executors` and `dask` spread
them.
"""

from delone.distributed.api import plan, triangulate
from delone.distributed.costs import Plan
from delone.distributed.opened import TiledDelaunay, open
from delone.distributed.proof import TiledReport
from delone.distributed.run import Progress
from delone.distributed.tile import Tile

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
