"""Constrained triangulations of segments, polygons and lines.

`delaunay` contains the class, `segmented` its state, `segments` the input report, `regions` and
`coverage` find regions and holes, `editing` applies changes, `validation` proves the result;
`polygons` and `geodata` read geometries.
"""

from delone.constrained.delaunay import ConstrainedDelaunay
from delone.constrained.editing import Editing
from delone.constrained.polygons import PolygonTriangles, from_geometry, triangulate_polygon
from delone.constrained.segments import SegmentReport
from delone.constrained.validation import ConstrainedReport

__all__ = [
    "ConstrainedDelaunay",
    "ConstrainedReport",
    "Editing",
    "PolygonTriangles",
    "SegmentReport",
    "from_geometry",
    "triangulate_polygon",
]
