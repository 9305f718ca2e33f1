"""Proximity graphs: which points are neighbors, in 2-D and 3-D.

All functions take points, or a triangulation whose points are used, and return a `Graph`. Edges are
exact for the given doubles, and ties are decided as each function says.
"""

from delone.graphs.graph import Graph
from delone.graphs.neighbors import nearest_neighbors, sphere_of_influence
from delone.graphs.proximity import (
    beta_skeleton,
    delaunay_graph,
    gabriel,
    relative_neighborhood,
    urquhart,
)
from delone.graphs.spanning import minimum_spanning_tree

__all__ = [
    "Graph",
    "beta_skeleton",
    "delaunay_graph",
    "gabriel",
    "minimum_spanning_tree",
    "nearest_neighbors",
    "relative_neighborhood",
    "sphere_of_influence",
    "urquhart",
]
