"""Triangulations of directions: geographic points, and other points on a sphere.

>>> from delone import sphere
>>> sphere.Delaunay(lonlat=[(0, 90), (0, 0), (90, 0), (180, 0), (270, 0), (0, -90)])
<Delaunay of 6 directions: 8 triangles, the whole sphere>

A vector of any length represents exactly its direction. Planar methods for longitudes and latitudes
give wrong results at the date line and near the poles; here, these need no special treatment.
"""

from __future__ import annotations

from delone.sphere.constrained import ConstrainedDelaunay
from delone.sphere.coordinates import LongitudeWarning
from delone.sphere.delaunay import Delaunay
from delone.sphere.geometry import from_geometry
from delone.sphere.grid import Grid
from delone.sphere.grid_report import GridFaults, GridReport
from delone.sphere.interpolation import Linear, NaturalNeighbor, Nearest
from delone.sphere.overlaps import OverlapReport, Overlaps
from delone.sphere.sides import PolygonWarning
from delone.sphere.voronoi import Voronoi
from delone.sphere.weights import Weights

__all__ = [
    "ConstrainedDelaunay",
    "Delaunay",
    "Grid",
    "GridFaults",
    "GridReport",
    "Linear",
    "LongitudeWarning",
    "NaturalNeighbor",
    "Nearest",
    "OverlapReport",
    "Overlaps",
    "PolygonWarning",
    "Voronoi",
    "Weights",
    "from_geometry",
]
