"""Voronoi diagrams of points in the plane, whole or cut to an outline.

`diagram` has the class, `dual` the arrays of the core and of sites on one line, `cells` what a cell
is, `clipping` boxes and outlines, `shapes` geometries, tables and pictures, `centroidal` Lloyd's
method, `torus` periodic sets.
"""

from delone.voronoi.cells import Cell, Neighbors, Rays
from delone.voronoi.centroidal import LloydResult, lloyd
from delone.voronoi.diagram import Voronoi

__all__ = ["Cell", "LloydResult", "Neighbors", "Rays", "Voronoi", "lloyd"]
