"""Triangulations in tiles: more points than memory holds, on one machine or on a Dask cluster.

The union of the tiles is the Delaunay triangulation of all points, triangle for triangle: `tiles`
cuts the plane, `certify` and `merge` decide what is certain, `stages` are the tasks, `run` their
order. Pure functions of arrays decide; tasks read and write files; `executors` and `dask` spread
them.
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
